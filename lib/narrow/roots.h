/* SPDX-License-Identifier: GPL-3.0-or-later */
/* roots.h -- int s^(9/2) along straight lines on which s is linear, four lines at a time.
 *
 * Where the root of s goes from p to q, node z of a rule of Gauss has the root r = p + (q - p) z, at
 * z (r + p)/(q + p) of the length: in z the integrand s^(9/2) dt is a polynomial of degree 10. */
#ifndef FL_NARROW_ROOTS_H
#define FL_NARROW_ROOTS_H
#include "base/wide.h"
#include "narrow/rules.h"

/* Over 2/(p + q) of the length: of s^(5/2), s^(7/2) and s^(9/2); and of s^(7/2) times t and t^2, with t the
 * share of the length times p + q. */
typedef struct {
    fl_wide ddu, du, u, first, second;
} fl_roots;

FL_WIDE_PART void fl_roots_sum(const fl_wide *p, const fl_wide *q, fl_roots *out)
{
    const fl_wide way = *q - *p, zero = {0};
    fl_wide ddu = zero, du = zero, u = zero, first = zero, second = zero;
    for (int k = 0; k < FL_LINE_NODES; k++) {
        const double z = FL_LINE_NODE[k];
        const fl_wide r = *p + way * z, far = z * (r + *p), s = r * r;
        const fl_wide c = FL_LINE_WEIGHT[k] * (s * s * s), f = c * s, ff = f * far;
        ddu += c, du += f, u += f * s, first += ff, second += ff * far;
    }
    *out = (fl_roots){ddu, du, u, first, second};
}

#endif
