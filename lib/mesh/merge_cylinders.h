/* SPDX-License-Identifier: GPL-3.0-or-later */
/* merge_cylinders.h -- merges cylinders and cones that continue each other into one. */
#ifndef FL_MESH_MERGE_CYLINDERS_H
#define FL_MESH_MERGE_CYLINDERS_H
#include "geom/surface.h"

typedef struct {
    int32_t merged;    /* cones that were merged */
    int32_t remaining; /* cones that they became */
    double max_error; /* [m] largest deviation of a removed end from its cone, across the axis or in radius */
} fl_merged_cylinders;

/* A leg of a finite element model is many cylinders on one axis.  One cylinder is the same solid without the
 * discs inside, and it has ends only where the leg has them.  Two cones continue each other if an end of one
 * coincides exactly with an end of the other, with the same radius, direction and slope, and no third cone
 * does so there.  Other lines may end at that point.
 * A run of such cones becomes one cone if no inner end deviates from it by more than 1e-6 of the diagonal of
 * the box of all cones (the tolerance of welding).  Otherwise the run is split at the end that deviates most.
 *   p     its cones are replaced; a cone without a continuation is unchanged
 *   did   counts are added
 * Returns 0, or -1 with FL_SYSTEM and p unchanged. */
int fl_part_merge_cylinders(fl_part *p, fl_merged_cylinders *did, fl_err *err);

#endif
