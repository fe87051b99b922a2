/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "stat/peaks.h"

const char *fl_peak_side_name(int side)
{
    static const char *const name[FL_PEAK_SIDES] = {"max", "min", "abs"};
    return name[side];
}

static int push_row(fl_peaks *p, int32_t at, fl_err *err)
{
    if (fl_grow(&p->row, &p->cap, (int64_t)p->n + 1, sizeof *p->row, err)) return -1;
    p->row[p->n++] = at;
    return 0;
}

int fl_peaks_rayleigh(int32_t n, const double *x, double ratio, double threshold, fl_peaks *p, fl_err *err)
{
    int32_t held = -1;     /* the last maximum, which a larger neighbour may replace */
    double low = INFINITY; /* the smallest value since then */
    p->n = 0;
    for (int32_t k = 1, end; k < n; k = end) {
        for (end = k + 1; end < n && x[end] == x[k]; end++) {}
        if (x[k] < low) low = x[k];
        if (end == n || !(x[k - 1] < x[k] && x[end] < x[k]) || !(x[k] > threshold)) continue;
        if (held >= 0 && low < ratio * fmin(x[held], x[k])) {
            if (push_row(p, held, err)) return -1;
        } else if (held >= 0 && x[k] <= x[held]) {
            continue; /* low stays: the smallest value since the held maximum */
        }
        /* The peak before is separate from the held one, hence also from this one, which is larger. */
        held = k;
        low = INFINITY;
    }
    return held < 0 ? 0 : push_row(p, held, err);
}

void fl_peaks_free(fl_peaks *p)
{
    free(p->row);
    *p = (fl_peaks){0};
}
