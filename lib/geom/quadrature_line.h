/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quadrature_line.h -- integrals of s^(9/2) along straight lines on which s is linear, four lines at a time.
 *
 * If the root of s varies from p to q, Gauss node z has the root r = p + (q - p) z and lies at z (r + p)/(q +
 * p) of the length.  In z the integrand s^(9/2) dt is a polynomial of degree 10. */
#ifndef FL_GEOM_QUADRATURE_LINE_H
#define FL_GEOM_QUADRATURE_LINE_H
#include "base/simd.h"
#include "geom/quadrature_rules.h"

/* Divided by 2 l/(p + q), l the length: integrals of s^(5/2), s^(7/2) and s^(9/2), and of s^(7/2) times t and
 * t^2, where t is the fraction of the length times p + q. */
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
