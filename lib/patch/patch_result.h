/* SPDX-License-Identifier: GPL-3.0-or-later */
/* patch_result.h -- the result of a contact law that friction reads: the load of a contact, its centre and
 * its distribution.
 *
 *     N = sum f,   x_c = sum f x / N,   Theta = sum e t t^T / sum e,   t = (x - x_e) x n
 *
 *   f, e   pressure at a point of the contact with damping, never tension, and without [N]
 *   x, n   the point [m] and the unit normal of the contact, sum f n(x) over its length
 *   x_e    centre of the pressures e [m]
 *   Theta  second moments of the pressure e across n [m2], as the root mean square distance rho and the
 *          elongation e of law/tangent.h,
 *          Theta = rho^2 ((1 - e^2)/2 (1 - n n^T) + e e^T)
 *
 * A law with faces fills all of it: `patch` by fl_patch_result_of() from its sums, a surrogate lane by lane
 * in contact/surrogate_batch.c from the shape of the last exact evaluation, turned with the force.  A law of
 * points has rho = 0 unless several points carry. */
#ifndef FL_PATCH_PATCH_RESULT_H
#define FL_PATCH_PATCH_RESULT_H
#include "geom/sym3.h"
#include "patch/force_sum.h"

/* rho and e of Theta. */
typedef struct {
    double arm;         /* rho [m] */
    fl_vec3 elongation; /* e, across n */
} fl_pressure_shape;

/* World axes; points are relative to the centre of B. */
typedef struct {
    double energy;           /* W                                                          [J] */
    fl_vec3 force, couple;   /* elastic, on A; the moment is about `centre`       [N], [N m] */
    double elastic;          /* sum of the pressures without damping                       [N] */
    double normal;           /* N                                                          [N] */
    fl_vec3 direction;       /* sum of f n                                                 [N] */
    double load;             /* limits friction: |direction|, but N where each wall has its own [N] */
    fl_vec3 centre;          /* x_c                                                        [m] */
    fl_pressure_shape shape; /* Theta */
    double slope;            /* dF/ds, stiffness along the force                         [N/m] */
} fl_patch_result;

/* rho and e of the second moments C = sum f r r^T / N about the centre [m2], across the unit normal n.  Theta
 * is C turned by a right angle about n. */
static inline fl_pressure_shape fl_pressure_shape_of(fl_sym3 C, fl_vec3 n)
{
    /* x and y across n: Duff et al., J. Comput. Graph. Tech. 6 (2017) 1 */
    const double sign = n.z < 0.0 ? -1.0 : 1.0, d = -1.0 / (sign + n.z), e = n.x * n.y * d;
    const fl_vec3 x = v3(1.0 + sign * n.x * n.x * d, sign * e, -sign * n.x),
                  y = v3(e, sign + n.y * n.y * d, -n.y), Cx = s3_mul(C, x);
    const double xx = v3_dot(x, Cx), yy = v3_dot(y, s3_mul(C, y)), xy = v3_dot(y, Cx), T = xx + yy;
    if (!(T > 0.0)) return (fl_pressure_shape){0.0, {0.0, 0.0, 0.0}};
    const double each = 1.0 / T, a = each * (yy - xx), b = -2.0 * each * xy, p = sqrt(a * a + b * b),
                 part = p > 1.0 ? 0.5 / p : 0.5, along = sqrt(part * (p + fabs(a))),
                 aside = along > 0.0 ? part * b / along : 0.0;
    const double ex = a > 0.0 ? along : aside, ey = a > 0.0 ? aside : along;
    return (fl_pressure_shape){sqrt(T), v3_madd(v3_scale(ex, x), ey, y)};
}

/* Shape of moments of pressures about a point: sum of f, of f r and of f r r^T; n as above. */
static inline fl_pressure_shape fl_pressure_shape_about(double sum, fl_vec3 first, fl_sym3 second, fl_vec3 n)
{
    const double each = 1.0 / sum;
    const fl_vec3 c = v3_scale(each, first);
    return fl_pressure_shape_of((fl_sym3){each * second.xx - c.x * c.x, each * second.xy - c.x * c.y,
                                          each * second.xz - c.x * c.z, each * second.yy - c.y * c.y,
                                          each * second.yz - c.y * c.z, each * second.zz - c.z * c.z},
                                n);
}

/* Result of a patch, W = energy, from its sums q after fl_force_sum_damping().
 *   scale   dW/dU
 *   slope   dF/ds [N/m]
 *   R       rotation from the frame of B to the world's
 *   at      the first point from the centre of B, world axes [m] */
static inline fl_patch_result fl_patch_result_of(const fl_force_sum *q, double energy, double scale,
                                                 double slope, const fl_mat3 *R, fl_vec3 at)
{
    fl_patch_result r = {.energy = energy,
                         .force = v3_scale(scale, m3_mul(*R, q->gradient.f)),
                         .elastic = scale * q->pressure,
                         .normal = scale * q->damped_pressure,
                         .direction = v3_scale(scale, m3_mul(*R, q->direction)),
                         .centre = at,
                         .slope = slope};
    r.load = v3_norm(r.direction);
    if (!(q->damped_pressure > 0.0)) return r;
    const fl_vec3 mean = m3_mul(*R, v3_scale(1.0 / q->damped_pressure, q->damped_moment));
    r.centre = v3_add(at, mean);
    r.couple = v3_sub(v3_scale(scale, m3_mul(*R, q->gradient.m)), v3_cross(mean, r.force));
    r.shape = fl_pressure_shape_about(q->pressure, q->pressure_moment, q->second, v3_unit(q->direction));
    r.shape.elongation = m3_mul(*R, r.shape.elongation);
    return r;
}

#endif
