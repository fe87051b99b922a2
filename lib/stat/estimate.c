/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <gsl/gsl_cdf.h>
#include <math.h>
#include "stat/estimate.h"

static const double TAIL = 0.025;

fl_estimate fl_estimate_mean(int32_t n, const double *x)
{
    fl_estimate e = {0.0, NAN, NAN};
    double squares = 0.0;
    for (int32_t k = 0; k < n; k++) e.mean += x[k] / n;
    for (int32_t k = 0; k < n; k++) squares += (x[k] - e.mean) * (x[k] - e.mean);
    if (n < 2) return e;
    e.std = sqrt(squares / (n - 1));
    e.half = e.std * gsl_cdf_tdist_Qinv(TAIL, n - 1) / sqrt(n);
    return e;
}
