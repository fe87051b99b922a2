/* SPDX-License-Identifier: GPL-3.0-or-later */
/* merge_cylinders.h -- cylinders and cones that go straight on become one. */
#ifndef FL_MESH_MERGE_CYLINDERS_H
#define FL_MESH_MERGE_CYLINDERS_H
#include "geom/surface.h"

typedef struct {
    int32_t merged;    /* cones that were joined to others */
    int32_t remaining; /* cones that they became */
    double
        max_error; /* [m] no end that is gone lies farther from the axis of its cone, nor is its radius more
                      different from the radius there */
} fl_merged_cylinders;

/* A leg of finite elements is many cylinders on one axis.  As one it is the same solid, without the discs
 * inside, and ice meets it far from its ends wherever it meets it.  Two cones go on from each other where an
 * end of one lies exactly in the place of an end of the other, with the same radius, direction and slope, and
 * no third one does; what other lines end there does not matter.  A run of them becomes one cone where no end
 * within strays more than 1e-6 of the diagonal of the box of all cones (the tolerance of welding) from it,
 * and is divided at the end that strays most where one does.
 *   p     its cones are replaced; a cone that nothing goes on from stays as it is
 *   did   counts are added to
 * Returns 0, or -1 with FL_SYSTEM and p as it was. */
int fl_part_merge_cylinders(fl_part *p, fl_merged_cylinders *did, fl_err *err);

#endif
