/* SPDX-License-Identifier: GPL-3.0-or-later */
/* domain_kernel.h -- whether a body has left the domain, by value, for the CPU and devices. */
#ifndef FL_BODY_DOMAIN_KERNEL_H
#define FL_BODY_DOMAIN_KERNEL_H
#include "base/simd.h"
#include "geom/vec3.h"

/* 1 if a body at x that reaches r from its centre is wholly beyond one of the bounds lo, hi, which are
 * infinite where bodies stay. */
FL_SIMD_INLINE int fl_is_beyond(fl_vec3 lo, fl_vec3 hi, fl_vec3 x, double r)
{
    return x.x + r < lo.x || x.x - r > hi.x || x.y + r < lo.y || x.y - r > hi.y || x.z + r < lo.z ||
           x.z - r > hi.z;
}

#endif
