/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ridge.h -- ice in blocks: --rubble in place of floes, and --ridge between them. */
#ifndef VORONOI_ICE_RIDGE_H
#define VORONOI_ICE_RIDGE_H
#include "ice/blocks.h"
#include "scene/ice_field.h"
#include "certificate_table.h"
#include "options.h"

/* Sail and keel of every ridge, in this order. */
struct pile {
    int n;
    fl_blocks part[2 * RIDGE_MAX];
    int64_t overlaps;
};

/* Make the blocks of the ridges, if there are any.  0, or -1 with FL_INPUT, FL_NUMERIC or FL_SYSTEM. */
int pile_make(struct pile *p, const struct options *o, fl_err *err);

/* Add them to a field; they are numbered from the highest id on.  Returns 0, or -1 with FL_INPUT (no ids are
 * left) or FL_SYSTEM. */
int pile_add(const struct pile *p, const struct options *o, fl_ice_field *out, fl_err *err);

void pile_certify(const struct pile *p, const struct options *o, struct certify *t);

void pile_free(struct pile *p); /* accepts a zeroed struct, leaves one */

/* --rubble: fill the field with blocks, write it and its certificate.  0, or -1 with err. */
int rubble_run(struct options *o, fl_err *err);

#endif
