/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inflow_bonds.h -- bonds of spheres that come in with a sheet without end (world/inflow_state.h).
 *
 * In the endless sheet floe k of copy m is bonded to floe l of the same copy where the field has a bond, and
 * to floe l of copy m - 1 where the two touch, one pitch apart: |x_k - p - x_l| = r_k + r_l.  A sphere comes
 * in where the sheet would have it, while all spheres ahead that it touches are guided or have just been
 * released, so bonds begin without load.  A partner that is elsewhere, or has left, gets no bond: there the
 * sheet has a crack.
 *
 * Spheres of such a sheet are guided in all six degrees of freedom: it is clamped where it comes in. */
#ifndef FL_SIM_INFLOW_BONDS_H
#define FL_SIM_INFLOW_BONDS_H
#include "world/world.h"

/* Finds the partners of each floe; after the discs and the inflow have been made.  Nothing without discs or
 * without inflow.  -1 with FL_INPUT (faces are bonded, not all copies would join, or the sheet is driven at
 * another speed) or FL_SYSTEM. */
int fl_inflow_bonds_make(fl_world *w, fl_err *err);
void fl_inflow_bonds_free(fl_inflow_join *t);

/* True if thing k is a sphere that the sphere in place i, a copy of floe `floe`, will be bonded to. */
int fl_inflow_bonds_joins(const fl_world *w, int32_t i, int32_t floe, int32_t k);

/* Notes the bonds of the sphere in place i, which has come in. */
int fl_inflow_bonds_admit(fl_world *w, int32_t i, fl_err *err);

/* Removes the bonds of spheres that have left, before their places are taken; adds those noted. */
int fl_inflow_bonds_renew(fl_world *w, fl_err *err);

/* The latest copies, after a checkpoint has been read. */
void fl_inflow_bonds_refresh(fl_world *w);

#endif
