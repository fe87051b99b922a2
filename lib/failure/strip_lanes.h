/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strip_lanes.h -- four elements of failure/strip.h at a time, with the bits of fl_strip_advance(). */
#ifndef FL_FAILURE_STRIP_LANES_H
#define FL_FAILURE_STRIP_LANES_H
#include "base/simd.h"
#include "failure/strip.h"

/* z = max(0, e - u). */
FL_SIMD_INLINE void fl_strip_lanes_deflection(const fl_simd *e, const fl_simd *u, fl_simd *z)
{
    *z = FL_SIMD_MASKED(*e > *u, *e - *u);
}

FL_SIMD_INLINE void fl_strip_lanes_creep(const fl_strip_step *t, const fl_simd *z, fl_simd *creep)
{
    const fl_simd x = *z * t->over_delta;
    if (t->law->creep_exponent == 1) *creep = t->creep * x;
    else *creep = t->creep * (x * x * x);
}

/* From z to the root of z (1 + h a g) + h c(z) = rhs. */
FL_SIMD_INLINE void fl_strip_lanes_root(const fl_strip_step *t, const fl_simd *rhs, fl_simd *z)
{
    const double line = 1.0 + t->h * t->a * t->g;
    if (t->law->creep_exponent == 1) {
        *z = *rhs / (line + t->creep * t->over_delta);
    } else {
        const double steep = 3.0 * t->creep * t->over_delta;
        FL_SIMD_UNROLL
        for (int pass = 0; pass < 2; pass++) {
            const fl_simd x = *z * t->over_delta;
            *z -= (*z * line + t->creep * x * x * x - *rhs) / (line + steep * x * x);
        }
    }
    *z = FL_SIMD_MASKED(*rhs > 0.0, *z);
}

/* Advances the lanes of `in` by dq, but for those that break, which stay and are returned in *breaks with the
 * way of the wall after the break in *rest: fl_strip_break() is theirs. */
FL_SIMD_INLINE void fl_strip_lanes_advance(const fl_strip_step *t, const fl_simd_mask *in, const fl_simd *dq,
                                           fl_simd *e, fl_simd *u, fl_simd_mask *breaks, fl_simd *rest)
{
    fl_simd z0, c0, c1;
    fl_strip_lanes_deflection(e, u, &z0);
    fl_strip_lanes_creep(t, &z0, &c0);
    const fl_simd old = *u * t->keep, rhs = *e + *dq - c0 - t->g * (old + t->h * t->a * z0);
    fl_simd z1 = z0;
    fl_strip_lanes_root(t, &rhs, &z1);
    fl_strip_lanes_creep(t, &z1, &c1);
    *breaks = *in & (z1 >= t->law->delta);
    *rest = *dq * (1.0 - (t->law->delta - z0) / (z1 - z0));
    const fl_simd_mask go = *in & ~*breaks;
    *u = FL_SIMD_SELECT(go, t->g * (old + t->h * t->a * (z0 + z1)), *u);
    *e = FL_SIMD_SELECT(go, *e + (*dq - (c0 + c1)), *e);
}

#endif
