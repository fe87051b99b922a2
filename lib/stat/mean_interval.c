/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <gsl/gsl_cdf.h>
#include <math.h>
#include "stat/integral_time.h"
#include "stat/mean_interval.h"

static const double TAIL = 0.025;

/* Below this skewness of T the first two terms suffice: the next one is smaller than rounding. */
static const double SMALL_SKEWNESS = 1e-8;

/* The T with ((1 + a T / 3)^3 - 1) / a + a / 6 = y. */
static double solve_for_t(double a, double y)
{
    if (fabs(a) < SMALL_SKEWNESS) return y - a / 6.0 - a * y * y / 3.0;
    return 3.0 / a * (cbrt(1.0 + a * (y - a / 6.0)) - 1.0);
}

fl_mean_interval fl_mean_interval_of_sign(fl_mean_interval e, int sign)
{
    if (sign > 0 && e.mean > 0.0 && !(e.low > 0.0)) e.low = fl_interval_end(e.mean, e.mean - e.low);
    if (sign < 0 && e.mean < 0.0 && !(e.high < 0.0)) e.high = fl_interval_end(e.mean, e.high - e.mean);
    return e;
}

double fl_runs_for(double std, double mean, double share)
{
    const double z = gsl_cdf_ugaussian_Qinv(TAIL);
    return ceil(pow(z * std / (share * mean), 2.0) + 2.0);
}

fl_mean_interval fl_mean_interval_of(int32_t n, const double *x)
{
    fl_mean_interval e = {0.0, NAN, NAN, NAN};
    double squares = 0.0, cubes = 0.0;
    for (int32_t k = 0; k < n; k++) e.mean += x[k] / n;
    if (n < 2) return e;
    for (int32_t k = 0; k < n; k++) squares += (x[k] - e.mean) * (x[k] - e.mean);
    e.std = sqrt(squares / (n - 1));
    const double t = gsl_cdf_tdist_Qinv(TAIL, n - 1), unit = e.std / sqrt(n);
    e.low = e.mean - t * unit;
    e.high = e.mean + t * unit;
    if (n < 3 || !(e.std > 0.0)) return e;
    for (int32_t k = 0; k < n; k++) cubes += pow((x[k] - e.mean) / e.std, 3.0);
    /* G = n sum z^3 / ((n - 1) (n - 2)), z in units of std */
    const double a = n * cubes / ((n - 1.0) * (n - 2.0)) / sqrt(n);
    e.low = fmin(e.low, e.mean - solve_for_t(a, t) * unit);
    e.high = fmax(e.high, e.mean - solve_for_t(a, -t) * unit);
    return e;
}
