/* SPDX-License-Identifier: GPL-3.0-or-later */
/* disc_setup.h -- which discs a world has: those of the ice field, and those that come and go with spheres of
 * a sheet without end. */
#ifndef FL_CONTACT_DISC_SETUP_H
#define FL_CONTACT_DISC_SETUP_H
#include "scene/ice_field.h"
#include "world/world.h"

/* True if the bond of the field is a disc: of two spheres that touch or are apart, not one that overlaps by
 * more than FL_DISC_OVERLAP of the sum of their radii, whose contact would begin with a force. */
#define FL_DISC_OVERLAP 1e-3
int fl_disc_list_includes(const fl_world *w, const fl_ice_field_bond *d);

/* Makes the discs of the field, body k of the field being body k, in its pose of the field.  -1 with
 * FL_SYSTEM, or FL_INPUT for a bond without length. */
int fl_disc_list_make(fl_world *w, const fl_ice_field *field, fl_err *err);
void fl_disc_list_free(fl_disc_list *s);

/* Removes the bonds of bodies that have left, whose sums go to `past`, and adds new ones without load between
 * bodies that are present.  The bound of omega^2 of all bonds is from then on that of the stiffest of the
 * field: spheres that come in are like those of the field.  -1 with FL_SYSTEM. */
int fl_disc_list_renew(fl_world *w, const fl_disc_birth *birth, int32_t births, fl_err *err);

/* Bond k as it was made; and the list of a checkpoint, in its order, without memory: i < j, ascending. */
fl_disc_birth fl_disc_list_birth(const fl_disc_list *s, int32_t k);
int fl_disc_list_restore(fl_world *w, const fl_disc_birth *birth, int32_t n, fl_err *err);

#endif
