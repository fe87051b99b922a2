/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <gsl/gsl_histogram.h>
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "stat/histogram.h"

int fl_histogram_make(fl_histogram *h, int32_t n, double lo, double hi, fl_err *err)
{
    *h = (fl_histogram){.n = n};
    h->range = fl_alloc((int64_t)n + 1, sizeof *h->range, err);
    h->bin = h->range ? fl_alloc(n, sizeof *h->bin, err) : NULL;
    if (!h->bin) {
        fl_histogram_free(h);
        return -1;
    }
    if (!(hi > lo)) {
        const double half = 0.5e-3 * (lo != 0.0 ? fabs(lo) : 1.0);
        lo -= half;
        hi = lo + 2.0 * half;
    }
    for (int32_t k = 0; k <= n; k++) {
        const double f = (double)k / n;
        h->range[k] = (1.0 - f) * lo + f * hi;
    }
    return 0;
}

void fl_histogram_add(fl_histogram *h, double x, double weight)
{
    gsl_histogram g = {.n = (size_t)h->n, .range = h->range, .bin = h->bin};
    if (x == h->range[h->n]) h->bin[h->n - 1] += weight;
    else
        (void)gsl_histogram_accumulate(&g, x, weight); /* outside: GSL returns an error and changes nothing */
}

void fl_histogram_free(fl_histogram *h)
{
    free(h->range);
    free(h->bin);
    *h = (fl_histogram){0};
}
