/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stat/stationary.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include "stat/integral_time.h"

/* Probability that a normal number is above 2. */
static const double BEYOND_TWO = 0.02275;

/* Normal point of 0.5 %. */
#define TREND_POINT 2.58

/* Means that differ by less than this share of the larger one are the same to a designer. */
#define SAME_MEAN 0.1

enum { MOST_BLOCKS = 20, LEAST_BLOCKS = 10 };

static double mean_of_rows(int32_t n, const double *x)
{
    double sum = 0.0;
    for (int32_t k = 0; k < n; k++) sum += x[k];
    return sum / n;
}

/* One half: its mean, independent values, and squared standard error. */
static int measure_half(int32_t n, const double *x, double span, double *mean, double *independent,
                        double *error2, fl_err *err)
{
    fl_record_mean m;
    double square = 0.0;
    *mean = mean_of_rows(n, x);
    for (int32_t k = 0; k < n; k++) square += (x[k] - *mean) * (x[k] - *mean) / n;
    if (fl_record_mean_make(&m, n, x, span, *mean, sqrt(square), 0, err)) return -1;
    *independent = m.n;
    *error2 = square / m.n;
    return 0;
}

/* z_B of the means of blocks. */
static double trend_of_blocks(int32_t n, const double *x, int32_t blocks)
{
    double mean[MOST_BLOCKS];
    int32_t later = 0;
    for (int32_t k = 0; k < blocks; k++) {
        const int32_t from = (int32_t)((int64_t)n * k / blocks),
                      to = (int32_t)((int64_t)n * (k + 1) / blocks);
        mean[k] = mean_of_rows(to - from, x + from);
        for (int32_t j = 0; j < k; j++) later += (mean[k] > mean[j]) - (mean[k] < mean[j]);
    }
    const double b = blocks, sign = (later > 0) - (later < 0);
    return (later - sign) / sqrt(b * (b - 1.0) * (2.0 * b + 5.0) / 18.0);
}

int fl_stationarity_make(fl_stationarity *s, int32_t n, const double *x, double span, fl_err *err)
{
    const int32_t half = n / 2;
    double error2[2];
    *s = (fl_stationarity){0};
    if (half < 2) return 0;
    for (int k = 0; k < 2; k++)
        if (measure_half(half, k ? x + n - half : x, span * half / n, &s->mean[k], &s->n[k], &error2[k], err))
            return -1;
    const double error = sqrt(error2[0] + error2[1]), step = s->mean[1] - s->mean[0];
    const double most = fmax(fabs(s->mean[0]), fabs(s->mean[1])), values = s->n[0] + s->n[1];
    const int32_t blocks = (int32_t)fmin(MOST_BLOCKS, fmin(n, values));
    s->apart = error > 0.0 ? step / error : 0.0;
    if (blocks >= LEAST_BLOCKS) s->trend = trend_of_blocks(n, x, blocks);
    s->judged = fmin(s->n[0], s->n[1]) >= FL_STATIONARY_LEAST;
    if (!s->judged || !(fabs(step) > SAME_MEAN * most)) return 0;
    s->moves = fabs(s->apart) > gsl_cdf_tdist_Qinv(BEYOND_TWO, values - 2.0) || fabs(s->trend) > TREND_POINT;
    return 0;
}
