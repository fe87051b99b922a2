/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "stat/moving_mean.h"

/* A window of the length of the record may exceed it by rounding. */
static const double SLACK = 1e-9;

/* The integral of x - mean from edge[0] to t; *k is the interval of the previous t and advances. */
static double integral_to(int32_t n, const double *edge, const double *x, const double *sum, double mean,
                          double t, int32_t *k)
{
    while (*k + 1 < n && edge[*k + 1] <= t) ++*k;
    return sum[*k] + (x[*k] - mean) * (t - edge[*k]);
}

int fl_moving_mean(int32_t n, const double *edge, const double *x, double T, double *y, fl_err *err)
{
    const double span = edge[n] - edge[0];
    double mean = 0.0, lost = 0.0, least = x[0], most = x[0];
    int32_t a = 0, b = 0;
    if (!(T > 0.0) || !(T <= span * (1.0 + SLACK)))
        return fl_fail(err, FL_INPUT,
                       "a moving mean over %g s, expected more than 0 and at most the %g s of the record", T,
                       span);
    double *sum = fl_alloc((int64_t)n + 1, sizeof *sum, err);
    if (!sum) return -1;
    /* Without the mean the integral returns to 0 at the end, and its rounding is that of the deviations. */
    for (int32_t k = 0; k < n; k++) {
        least = fmin(least, x[k]);
        most = fmax(most, x[k]);
    }
    for (int32_t k = 0; k < n; k++) mean += (x[k] - mean) * (edge[k + 1] - edge[k]) / (edge[k + 1] - edge[0]);
    /* Kahan summation: the rounding of a long sum must not appear in its differences. */
    for (int32_t k = 0; k < n; k++) {
        const double term = (x[k] - mean) * (edge[k + 1] - edge[k]) - lost, next = sum[k] + term;
        lost = (next - sum[k]) - term;
        sum[k + 1] = next;
    }
    for (int32_t k = 0; k < n; k++) {
        const double c = edge[k] + 0.5 * (edge[k + 1] - edge[k]);
        const double from = fmax(edge[0], c - 0.5 * T), to = fmin(edge[n], c + 0.5 * T);
        const double lower = integral_to(n, edge, x, sum, mean, from, &a),
                     upper = integral_to(n, edge, x, sum, mean, to, &b);
        /* A mean lies between the values; rounding must not change the sign of a load. */
        y[k] = fmax(least, fmin(most, mean + (upper - lower) / (to - from)));
    }
    free(sum);
    return 0;
}
