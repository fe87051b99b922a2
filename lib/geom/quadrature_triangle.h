/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quadrature_triangle.h -- means over a triangle of powers of a linear function s, four triangles at a time.
 *
 * With the values a, b, c of s at the corners and the barycentric coordinates l_a, l_b, l_c,
 *     mean s^k         = 2 k!/(k+2)! h_k(a, b, c)
 *     mean s^k l_a     = 2 k!/(k+3)! h_k(a, b, c, a)
 *     mean s^k l_a l_b = 2 k!/(k+4)! h_k(a, b, c, a, b)
 * where h_k is the complete symmetric polynomial of degree k, h_k(.., b) = h_k(..) + b h_(k-1)(.., b).
 * Nothing is subtracted, so no digits are lost. */
#ifndef FL_GEOM_QUADRATURE_TRIANGLE_H
#define FL_GEOM_QUADRATURE_TRIANGLE_H
#include "base/simd.h"

/* Means of s^2, s^3 and s^4; 60 times those of s^3 with one barycentric coordinate, 420 times those with two.
 */
typedef struct {
    fl_simd s2, s3, s4, a, b, c, ab, ac, bc;
} fl_triangle_means;

FL_SIMD_INLINE void fl_triangle_means_of(const fl_simd *s0, const fl_simd *s1, const fl_simd *s2,
                                         fl_triangle_means *out)
{
    const fl_simd a = *s0, b = *s1, c = *s2, a2 = a * a;
    const fl_simd e1 = a + b, e2 = a2 + b * e1, e3 = a2 * a + b * e2, e4 = a2 * a2 + b * e3;
    const fl_simd h1 = e1 + c, h2 = e2 + c * h1, h3 = e3 + c * h2, h4 = e4 + c * h3;
    const fl_simd a1 = h1 + a, a_2 = h2 + a * a1, b1 = h1 + b, b_2 = h2 + b * b1;
    out->s2 = h2 * (1.0 / 6.0), out->s3 = h3 * 0.1, out->s4 = h4 * (1.0 / 15.0);
    out->a = h3 + a * a_2, out->b = h3 + b * b_2, out->c = h3 + c * (h2 + c * (h1 + c));
    out->ab = out->a + b * (a_2 + b * (a1 + b)), out->ac = out->a + c * (a_2 + c * (a1 + c));
    out->bc = out->b + c * (b_2 + c * (b1 + c));
}

/* Means of s^3 times x, y, xx, xy and yy. */
typedef struct {
    fl_simd x, y, xx, xy, yy;
} fl_triangle_moments;

/* p, q, r: x and y of the corners.  Second moments are sum w_i x_i^2 - sum w_ij (x_i - x_j)^2, w_i the sum of
 * all w_ij. */
FL_SIMD_INLINE void fl_triangle_moments_of(const fl_triangle_means *k, const fl_simd *p, const fl_simd *q,
                                           const fl_simd *r, fl_triangle_moments *out)
{
    const double one = 1.0 / 60.0, two = 1.0 / 420.0;
    const fl_simd ax = k->a * p[0], bx = k->b * q[0], cx = k->c * r[0], ay = k->a * p[1], by = k->b * q[1],
                  cy = k->c * r[1];
    const fl_simd Dx = p[0] - q[0], Ex = p[0] - r[0], Fx = q[0] - r[0], Dy = p[1] - q[1], Ey = p[1] - r[1],
                  Fy = q[1] - r[1];
    const fl_simd abx = k->ab * Dx, acx = k->ac * Ex, bcx = k->bc * Fx;
    out->x = one * (ax + bx + cx), out->y = one * (ay + by + cy);
    out->xx = one * (ax * p[0] + bx * q[0] + cx * r[0]) - two * (abx * Dx + acx * Ex + bcx * Fx);
    out->xy = one * (ax * p[1] + bx * q[1] + cx * r[1]) - two * (abx * Dy + acx * Ey + bcx * Fy);
    out->yy = one * (ay * p[1] + by * q[1] + cy * r[1]) -
              two * (k->ab * Dy * Dy + k->ac * Ey * Ey + k->bc * Fy * Fy);
}

#endif
