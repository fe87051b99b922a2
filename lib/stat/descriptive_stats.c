/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "stat/descriptive_stats.h"

/* The mean is rounded to half a unit in the last place, and so are the deviations from it: std <= 4 eps
 * max|x| cannot be distinguished from 0. */
static const double ROUNDING = 4.0 * DBL_EPSILON;

void fl_compute_moments(int32_t n, const double *x, const double *w, fl_descriptive_stats *d)
{
    const double one = 1.0;
    const size_t step = w ? 1 : 0, count = (size_t)n; /* stride 0 repeats the one weight */
    double squares = 0.0, large;
    *d = (fl_descriptive_stats){
        .n = n, .min = x[0], .max = x[0], .skew = NAN, .kurtosis = NAN, .std_sample = NAN};
    if (!w) w = &one;
    for (int32_t k = 0; k < n; k++) {
        const double wk = w[(size_t)k * step];
        d->time += wk;
        squares += wk * wk;
        if (x[k] < d->min) d->min = x[d->at_min = k];
        if (x[k] > d->max) d->max = x[d->at_max = k];
    }
    large = fmax(fabs(d->min), fabs(d->max));
    d->mean = gsl_stats_wmean(w, step, x, 1, count);
    d->std = sqrt(gsl_stats_wvariance_with_fixed_mean(w, step, x, 1, count, d->mean));
    if (!(d->std > ROUNDING * large)) d->std = 0.0;
    if (n > 1) d->std_sample = d->std / sqrt(1.0 - squares / (d->time * d->time));
    if (d->std > 0.0) {
        d->skew = gsl_stats_wskew_m_sd(w, step, x, 1, count, d->mean, d->std);
        d->kurtosis = gsl_stats_wkurtosis_m_sd(w, step, x, 1, count, d->mean, d->std);
    }
}

typedef struct {
    double x, w;
} weighted_value;

static int compare_values(const void *a, const void *b)
{
    const weighted_value *p = a, *q = b;
    if (p->x != q->x) return p->x < q->x ? -1 : 1;
    return (p->w > q->w) - (p->w < q->w); /* a defined order of equal values */
}

int fl_compute_quantiles(int32_t n, const double *x, const double *w, int32_t m, const double *p, double *q,
                         fl_err *err)
{
    weighted_value *s = fl_alloc(n, sizeof *s, err);
    double *middle = s ? fl_alloc(n, sizeof *middle, err) : NULL, sum = 0.0;
    if (!middle) {
        free(s);
        return -1;
    }
    for (int32_t k = 0; k < n; k++) s[k] = (weighted_value){x[k], w ? w[k] : 1.0};
    qsort(s, (size_t)n, sizeof *s, compare_values);
    for (int32_t k = 0; k < n; k++) {
        middle[k] = sum + 0.5 * s[k].w;
        sum += s[k].w;
    }
    for (int32_t j = 0; j < m; j++) {
        const double want = middle[0] + p[j] * (middle[n - 1] - middle[0]);
        int32_t lo = 0, hi = n - 1; /* middle[lo] <= want <= middle[hi] */
        while (hi - lo > 1) {
            const int32_t k = lo + (hi - lo) / 2;
            if (middle[k] <= want) lo = k;
            else hi = k;
        }
        const double f = middle[hi] > middle[lo] ? (want - middle[lo]) / (middle[hi] - middle[lo]) : 0.0;
        /* p = 1 is the largest value, for any rounding of its position. */
        q[j] = p[j] >= 1.0 ? s[n - 1].x : s[lo].x + f * (s[hi].x - s[lo].x);
    }
    free(s);
    free(middle);
    return 0;
}

double fl_mean_of_highest(int32_t n, const double *descending, double share)
{
    const double want = fmin(fmax(share * n, 1.0), n);
    double sum = 0.0;
    for (int32_t k = 0; k < want; k++) sum += fmin(want - k, 1.0) * descending[k];
    return sum / want;
}
