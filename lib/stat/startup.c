/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stat/startup.h"
#include <math.h>
#include "stat/integral_time.h"
#include "stat/stationary.h"

enum {
    BLOCKS = 200,
    LEAST_ROWS = 100 /* a shorter record has no block means */
};

/* z from which the start differs from the rest. */
#define DIFFERS 4.0

static double mean_between(const double *x, int32_t from, int32_t to)
{
    double sum = 0.0;
    for (int32_t k = from; k < to; k++) sum += x[k];
    return sum / (to - from);
}

/* First row of block k. */
static int32_t block_start(int32_t n, int32_t blocks, int32_t k)
{
    return (int32_t)((int64_t)n * k / blocks);
}

/* d of the smallest e. */
static int32_t best_cut(int32_t blocks, const double *y)
{
    double smallest = INFINITY;
    int32_t best = 0;
    for (int32_t d = 0; d < blocks - 1; d++) {
        const double mean = mean_between(y, d, blocks), left = blocks - d;
        double square = 0.0;
        for (int32_t k = d; k < blocks; k++) square += (y[k] - mean) * (y[k] - mean);
        if (square / (left * left) < smallest) smallest = square / (left * left), best = d;
    }
    return best;
}

int fl_startup_find(fl_startup *s, int32_t n, const double *x, double span, fl_err *err)
{
    double y[BLOCKS], square = 0.0;
    const int32_t blocks = n < BLOCKS ? n : BLOCKS;
    fl_stationarity rest;
    fl_record_mean m;
    *s = (fl_startup){0};
    if (n < LEAST_ROWS) return 0;
    for (int32_t k = 0; k < blocks; k++)
        y[k] = mean_between(x, block_start(n, blocks, k), block_start(n, blocks, k + 1));
    const int32_t d = best_cut(blocks, y), from = block_start(n, blocks, d), left = n - from;
    if (d == 0 || 2 * d >= blocks) return 0;
    const double start = mean_between(x, 0, from), mean = mean_between(x, from, n);
    for (int32_t k = from; k < n; k++) square += (x[k] - mean) * (x[k] - mean) / left;
    const double span_left = span * left / n, std = sqrt(square);
    if (fl_stationarity_make(&rest, left, x + from, span_left, err) ||
        fl_record_mean_make(&m, left, x + from, span_left, mean, std, 0, err))
        return -1;
    const double error = std * sqrt(2.0 * m.tau * (1.0 / (span - span_left) + 1.0 / span_left)),
                 apart = fabs(start - mean) / error;
    if (!rest.judged || rest.moves || !(apart > DIFFERS)) return 0;
    *s = (fl_startup){from, {start, mean}, apart};
    return 0;
}
