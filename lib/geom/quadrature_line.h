/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quadrature_line.h -- int s^(9/2) along straight lines on which s is linear, four lines at a time.
 *
 * Where the root of s goes from p to q, node z of a Gauss rule has the root r = p + (q - p) z, at the
 * fraction z (r + p)/(q + p) of the length.  Over z the integrand s^(9/2) dt is a polynomial of degree 10, so
 * the rule is exact. */
#ifndef FL_GEOM_QUADRATURE_LINE_H
#define FL_GEOM_QUADRATURE_LINE_H
#include "base/simd.h"
#include "geom/quadrature_rules.h"

/* Integrals over the length, times (p + q)/2: of s^(5/2), s^(7/2) and s^(9/2); of s^(7/2) times t and t^2, t
 * being the fraction of the length times p + q. */
typedef struct {
    fl_simd ddu, du, u, first, second;
} fl_line_integrals;

FL_SIMD_INLINE void fl_line_integrate(const fl_simd *p, const fl_simd *q, fl_line_integrals *out)
{
    const fl_simd way = *q - *p, zero = {0};
    fl_simd ddu = zero, du = zero, u = zero, first = zero, second = zero;
    for (int k = 0; k < FL_LINE_NODES; k++) {
        const double z = FL_LINE_NODE[k];
        const fl_simd r = *p + way * z, far = z * (r + *p), s = r * r;
        const fl_simd c = FL_LINE_WEIGHT[k] * (s * s * s), f = c * s, ff = f * far;
        ddu += c, du += f, u += f * s, first += ff, second += ff * far;
    }
    *out = (fl_line_integrals){ddu, du, u, first, second};
}

#endif
