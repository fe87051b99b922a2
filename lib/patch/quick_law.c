/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/simd.h"
#include "patch/quick_law.h"
#include <stdlib.h>
#include "patch/quick_crossing.h"
#include "patch/quick_faces.h"
#include "patch/quick_points.h"

FL_SIMD_INLINE fl_vec3 vector_at(const fl_quick_total *t, int row)
{
    return v3(t->a[row], t->a[row + 1], t->a[row + 2]);
}

FL_SIMD_INLINE fl_vec3 centre_sum(const fl_quick_total *t)
{
    return v3(t->a[FL_QUICK_EX], t->a[FL_QUICK_EY], t->a[FL_QUICK_EZ]);
}

/* The result of direction 0 and the crossings, without lengths of direction 1. */
FL_SIMD_INLINE void set_sums(fl_quick_sums *to, const fl_quick_total *t)
{
    const double *a = t->a;
    *to = (fl_quick_sums){.u = a[FL_QUICK_U],
                          .ddu = a[FL_QUICK_DDU],
                          .reach = a[FL_QUICK_REACH],
                          .gradient = {vector_at(t, FL_QUICK_F), vector_at(t, FL_QUICK_M)},
                          .pressure = a[FL_QUICK_E],
                          .direction = vector_at(t, FL_QUICK_DIRECTION),
                          .moment = centre_sum(t),
                          .second = {a[FL_QUICK_XX], a[FL_QUICK_XY], a[FL_QUICK_XZ], a[FL_QUICK_YY],
                                     a[FL_QUICK_YZ], a[FL_QUICK_ZZ]}};
}

/* Adds the sums of direction 1, found in the frame of A with B as the own core. */
FL_SIMD_INLINE void add_from_a(fl_quick_sums *to, const fl_quick_total *t, const fl_mat3 *M, fl_vec3 o)
{
    const double *a = t->a;
    const fl_vec3 f = v3_neg(m3_mul(*M, vector_at(t, FL_QUICK_F))),
                  m = v3_neg(m3_mul(*M, vector_at(t, FL_QUICK_M)));
    const fl_vec3 c = m3_mul(*M, centre_sum(t));
    const double e = a[FL_QUICK_E];
    to->u += a[FL_QUICK_U], to->ddu += a[FL_QUICK_DDU], to->reach += a[FL_QUICK_REACH], to->pressure += e;
    to->gradient.f = v3_add(to->gradient.f, f);
    to->gradient.m = v3_add(v3_add(to->gradient.m, m), v3_cross(o, f));
    to->direction = v3_sub(to->direction, m3_mul(*M, vector_at(t, FL_QUICK_DIRECTION)));
    to->moment = v3_madd(v3_add(to->moment, c), e, o);
    const fl_sym3 x = s3_rotated((fl_sym3){a[FL_QUICK_XX], a[FL_QUICK_XY], a[FL_QUICK_XZ], a[FL_QUICK_YY],
                                           a[FL_QUICK_YZ], a[FL_QUICK_ZZ]},
                                 m3_col(*M, 0), m3_col(*M, 1), m3_col(*M, 2));
    to->second = s3_add(to->second, x);
    to->second =
        s3_add(to->second, (fl_sym3){2.0 * c.x * o.x + e * o.x * o.x, c.x * o.y + c.y * o.x + e * o.x * o.y,
                                     c.x * o.z + c.z * o.x + e * o.x * o.z, 2.0 * c.y * o.y + e * o.y * o.y,
                                     c.y * o.z + c.z * o.y + e * o.y * o.z, 2.0 * c.z * o.z + e * o.z * o.z});
}

/* Adds the derivatives of the shift D n of A, as patch_points.c has them: with the force G over dW/dU and a
 * point of direction m, the overlap changes by dD - m.(dx + n dD + D dn). */
static void add_penetration(fl_quick_sums *q, const fl_penetration *deep)
{
    const fl_vec3 n = deep->n, G = q->gradient.f, shift = v3_scale(-deep->depth, n);
    const double along = q->reach - v3_dot(G, n);
    if (deep->turns_with <= 0) q->gradient.m = v3_add(q->gradient.m, v3_cross(shift, G));
    q->gradient = fl_wrench_madd(q->gradient, along, (fl_wrench){n, v3_cross(deep->pa, n)});
    if (deep->turns_with == 0) {
        const fl_vec3 c = v3_cross(deep->ea, deep->eb), across = v3_madd(G, -v3_dot(G, n), n);
        const double sign = v3_dot(c, n) > 0.0 ? 1.0 : -1.0;
        q->gradient.m = v3_madd(q->gradient.m, sign * deep->depth / v3_norm(c),
                                v3_cross(deep->ea, v3_cross(deep->eb, across)));
    }
}

FL_SIMD_VERSIONS int fl_quick_evaluate(fl_quick_scratch *w, const fl_quick_shape *a, const fl_quick_shape *b,
                                       double ra, double rb, fl_mat3 M, fl_vec3 o, const fl_penetration *deep,
                                       const fl_quick_list *l, fl_quick_sums *sums)
{
    const double R = ra + rb, reach = R + deep->depth;
    const fl_vec3 at = v3_madd(o, deep->depth, deep->n);
    const fl_mat3 N = {{{M.m[0][0], M.m[1][0], M.m[2][0]},
                        {M.m[0][1], M.m[1][1], M.m[2][1]},
                        {M.m[0][2], M.m[1][2], M.m[2][2]}}};
    const fl_quick_direction direction[2] = {
        {a, b, M, at, ra, fl_quick_feature_radius(ra, rb), R, reach, l, 0},
        {b, a, N, v3_neg(m3_mul(N, at)), rb, fl_quick_feature_radius(rb, ra), R, reach, l, FL_QUICK_KINDS}};
    fl_quick_total total[2] = {0};
    double overlap = 0.0;
    for (int k = 0; k < 2; k++) {
        const fl_quick_support *support;
        int32_t n;
        if (fl_quick_add_faces(w, &direction[k], &total[k], &support, &n, &overlap) ||
            fl_quick_add_points(w, &direction[k], support, n, &total[k], &overlap))
            return -1;
    }
    fl_quick_add_crossings(&direction[0], direction[1].rho, deep->n, &total[0], &overlap);
    set_sums(sums, &total[0]);
    add_from_a(sums, &total[1], &M, at);
    sums->overlap = overlap;
    if (v3_norm2(deep->n) > 0.0) add_penetration(sums, deep);
    return 0;
}
