/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/arc_length.h"
#include <math.h>

int fl_arc_root(double bb, double ab, double cc, double db, double x0, double *x)
{
    const double disc = ab * ab - bb * cc;
    if (!(disc >= 0.0) || !(bb > 0.0)) return 1;
    const double q = -(ab + copysign(sqrt(disc), ab));
    const double u = q / bb, v = q != 0.0 ? cc / q : 0.0;
    const double less = u < v ? u : v, more = u < v ? v : u;
    *x = db > 0.0 ? more : db < 0.0 ? less : fabs(less - x0) < fabs(more - x0) ? less : more;
    return 0;
}

double fl_arc_polynomial(int n, const double *s, const double *y, double at)
{
    double sum = 0.0;
    for (int k = 0; k < n; k++) {
        double t = y[k];
        for (int m = 0; m < n; m++)
            if (m != k) t *= (at - s[m]) / (s[k] - s[m]);
        sum += t;
    }
    return sum;
}

/* Slope at s of the parabola through three points. */
static double parabola_slope(const double s[3], const double y[3], double at)
{
    const double a = (y[1] - y[0]) / (s[1] - s[0]), b = (y[2] - y[1]) / (s[2] - s[1]);
    return a + (b - a) / (s[2] - s[0]) * (2.0 * at - s[0] - s[1]);
}

double fl_arc_parabola(const double s[3], const double y[3], double *at)
{
    const double a = (y[1] - y[0]) / (s[1] - s[0]), b = (y[2] - y[1]) / (s[2] - s[1]);
    const double curve = (b - a) / (s[2] - s[0]);
    *at = curve != 0.0 ? 0.5 * (s[0] + s[1] - a / curve) : s[1];
    return fl_arc_polynomial(3, s, y, *at);
}

double fl_arc_cubic(const double s[4], const double y[4], double *at)
{
    fl_arc_parabola(s + 1, y + 1, at);
    /* y = p + c (x - s1)(x - s2)(x - s3), p the parabola of the last three. */
    const double c =
        (y[0] - fl_arc_polynomial(3, s + 1, y + 1, s[0])) / ((s[0] - s[1]) * (s[0] - s[2]) * (s[0] - s[3]));
    for (int k = 0; k < 20; k++) {
        const double u = *at - s[1], v = *at - s[2], w = *at - s[3];
        const double slope = parabola_slope(s + 1, y + 1, *at) + c * (u * v + v * w + w * u);
        const double a = (y[2] - y[1]) / (s[2] - s[1]), b = (y[3] - y[2]) / (s[3] - s[2]);
        const double bend = 2.0 * (b - a) / (s[3] - s[1]) + 2.0 * c * (u + v + w);
        if (bend == 0.0) break;
        *at -= slope / bend;
    }
    return fl_arc_polynomial(4, s, y, *at);
}

double fl_arc_work(const double s[3], const double x[3], const double y[3])
{
    /* Simpson's rule is exact: the integrand is a cubic. */
    const double mid = 0.5 * (s[1] + s[2]), h = s[2] - s[1];
    return h / 6.0 *
           (x[1] * parabola_slope(s, y, s[1]) +
            4.0 * fl_arc_polynomial(3, s, x, mid) * parabola_slope(s, y, mid) +
            x[2] * parabola_slope(s, y, s[2]));
}
