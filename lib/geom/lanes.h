/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lanes.h -- eight objects side by side, one row for each of their numbers, so that loops over them use the
 * full width of the machine. */
#ifndef FL_GEOM_LANES_H
#define FL_GEOM_LANES_H
#include "base/simd.h"
#include "geom/rows3.h"

enum { FL_LANE_COUNT = 8 };

typedef struct {
    double a[FL_LANE_COUNT];
} fl_lane;

static inline fl_vec3 fl_lane3(const fl_lane *a, int k) { return v3(a[0].a[k], a[1].a[k], a[2].a[k]); }
static inline void fl_lane3_set(fl_lane *a, int k, fl_vec3 v)
{
    a[0].a[k] = v.x, a[1].a[k] = v.y, a[2].a[k] = v.z;
}

/* The axes of object k by its quaternion, as q_matrix(). */
FL_SIMD_INLINE fl_rows3 fl_lane_axes(const fl_lane *q, int k)
{
    const double w = q[0].a[k], x = q[1].a[k], y = q[2].a[k], z = q[3].a[k];
    return (fl_rows3){v3(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
                      v3(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
                      v3(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))};
}

/* The consecutive doubles of an object. */
static inline const double *fl_lane_column(const void *at) { return at; }

/* Loads the numbers of eight objects, of[FL_LANE_COUNT], into rows, a multiple of four. */
FL_SIMD_INLINE void fl_lanes_load(fl_lane *row, const double *const *of, int rows)
{
    for (int k = 0; k < FL_LANE_COUNT; k += FL_SIMD_WIDTH)
        for (int c = 0; c < rows; c += FL_SIMD_WIDTH) {
            fl_simd r[FL_SIMD_WIDTH] = {FL_SIMD_LOAD(of[k] + c), FL_SIMD_LOAD(of[k + 1] + c),
                                        FL_SIMD_LOAD(of[k + 2] + c), FL_SIMD_LOAD(of[k + 3] + c)};
            fl_simd_transpose(r);
            FL_SIMD_UNROLL
            for (int l = 0; l < FL_SIMD_WIDTH; l++) FL_SIMD_STORE(&row[c + l].a[k]) = r[l];
        }
}

/* Stores four rows to the columns of the four objects from k on. */
FL_SIMD_INLINE void fl_lanes_store(double *const *to, const fl_lane *row, int k)
{
    fl_simd r[FL_SIMD_WIDTH] = {FL_SIMD_LOAD(&row[0].a[k]), FL_SIMD_LOAD(&row[1].a[k]),
                                FL_SIMD_LOAD(&row[2].a[k]), FL_SIMD_LOAD(&row[3].a[k])};
    fl_simd_transpose(r);
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) FL_SIMD_STORE(to[l]) = r[l];
}

#endif
