/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ridge.h -- pressure ridges (--ridge): sail and keel of ice blocks between the floes of a field. */
#ifndef VORONOI_ICE_RIDGE_H
#define VORONOI_ICE_RIDGE_H
#include "ice/blocks.h"
#include "certificate_table.h"
#include "recipe.h"

/* Sail and keel of each ridge, in this order. */
struct ridges {
    int n; /* parts */
    fl_blocks part[2 * RIDGE_MAX];
    int64_t overlaps; /* pairs of blocks that overlap */
};

/* Make the blocks of all ridges.  Returns 0, or -1 with FL_INPUT, FL_NUMERIC or FL_SYSTEM. */
int ridges_make(struct ridges *p, const struct recipe *o, fl_err *err);

/* Append the blocks to a field; their ids follow the highest id.  Returns 0, or -1 with FL_INPUT (ids are
 * exhausted) or FL_SYSTEM. */
int ridges_add(const struct ridges *p, const struct recipe *o, fl_ice_field *out, fl_err *err);

/* Add the rows of the ridges to the certificate. */
void ridges_certify(const struct ridges *p, const struct recipe *o, struct certificate_table *t);

void ridges_free(struct ridges *p); /* accepts a zeroed struct, leaves a zeroed one */

#endif
