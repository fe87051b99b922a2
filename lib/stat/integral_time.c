/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stat/integral_time.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include "base/array.h"

enum { GROUPS = 8192 };

/* Of a 95 % interval. */
static const double TAIL = 0.025;

/* Sum of the correlations of y[n], of mean 0, from lag 1 to the first that is not above 0. */
static double sum_correlations(int32_t n, const double *y)
{
    double square = 0.0, sum = 0.0;
    for (int32_t k = 0; k < n; k++) square += y[k] * y[k];
    for (int32_t lag = 1; square > 0.0 && lag < n / 2; lag++) {
        double c = 0.0;
        for (int32_t k = lag; k < n; k++) c += y[k] * y[k - lag];
        if (!(c > 0.0)) break;
        sum += c / square;
    }
    return sum;
}

double fl_interval_end(double mean, double reach)
{
    return reach < fabs(mean) ? mean - copysign(reach, mean) : mean * exp(-reach / fabs(mean));
}

int fl_record_mean_make(fl_record_mean *m, int32_t n, const double *x, double span, double mean, double std,
                        int one_sign, fl_err *err)
{
    const int32_t size = (n + GROUPS - 1) / GROUPS, groups = n / size;
    double *y = fl_alloc(groups, sizeof *y, err);
    if (!y) return -1;
    for (int32_t k = 0; k < groups; k++) {
        double sum = 0.0;
        for (int32_t j = 0; j < size; j++) sum += x[k * size + j] - mean;
        y[k] = sum / size;
    }
    m->tau = std > 0.0 ? span / groups * (0.5 + sum_correlations(groups, y)) : 0.0;
    free(y);
    m->n = m->tau > 0.0 ? fmax(1.0, fmin(n, span / (2.0 * m->tau))) : n;
    const double reach = gsl_cdf_tdist_Qinv(TAIL, fmax(1.0, m->n - 1.0)) * std / sqrt(m->n);
    m->low = mean - reach;
    m->high = mean + reach;
    if (one_sign && mean > 0.0) m->low = fl_interval_end(mean, reach);
    if (one_sign && mean < 0.0) m->high = fl_interval_end(mean, reach);
    return 0;
}
