/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/profile_matrix.h"
#include <stdlib.h>
#include "base/array.h"

int fl_profile_begin(fl_profile *p, int32_t n, fl_err *err)
{
    *p = (fl_profile){.n = n};
    p->low = fl_alloc(n, sizeof *p->low, err);
    p->start = fl_alloc((int64_t)n + 1, sizeof *p->start, err);
    p->diagonal = fl_alloc(n, sizeof *p->diagonal, err);
    for (int32_t i = 0; i < n && !err->code; i++) p->low[i] = i;
    return err->code ? -1 : 0;
}

void fl_profile_free(fl_profile *p)
{
    free(p->low);
    free(p->start);
    free(p->k);
    free(p->diagonal);
    *p = (fl_profile){0};
}

void fl_profile_join(fl_profile *p, int count, const int32_t *which)
{
    int32_t least = p->n;
    for (int d = 0; d < count; d++)
        if (which[d] >= 0 && which[d] < least) least = which[d];
    for (int d = 0; d < count; d++)
        if (which[d] >= 0 && least < p->low[which[d]]) p->low[which[d]] = least;
}

int fl_profile_allocate(fl_profile *p, int64_t most, fl_err *err)
{
    for (int32_t i = 0; i < p->n; i++) p->start[i + 1] = p->start[i] + i - p->low[i] + 1;
    if (p->start[p->n] > most) return 1;
    p->k = fl_alloc(p->start[p->n], sizeof *p->k, err);
    return p->k ? 0 : -1;
}

void fl_profile_add_form(fl_profile *p, int count, const int32_t *which, const double *g, double stiff)
{
    for (int r = 0; r < count; r++)
        for (int c = 0; c < count; c++) {
            const int32_t i = which[r], j = which[c];
            if (i >= 0 && j >= 0 && j <= i) fl_profile_row(p, i)[j] += stiff * g[r] * g[c];
        }
}

int fl_profile_factor_row(fl_profile *p, int32_t i, double pivot)
{
    double *a = fl_profile_row(p, i);
    p->diagonal[i] = a[i];
    for (int32_t j = p->low[i]; j < i; j++) { /* a[j] becomes L_ij D_j */
        const double *l = fl_profile_row(p, j);
        double sum = a[j];
        for (int32_t c = p->low[i] > p->low[j] ? p->low[i] : p->low[j]; c < j; c++) sum -= a[c] * l[c];
        a[j] = sum;
    }
    double left = a[i];
    for (int32_t j = p->low[i]; j < i; j++) {
        const double scaled = a[j] / fl_profile_row(p, j)[j];
        left -= a[j] * scaled;
        a[j] = scaled;
    }
    a[i] = left;
    return left > pivot * p->diagonal[i];
}

void fl_profile_hold(fl_profile *p, int32_t i)
{
    fl_profile_row(p, i)[i] = p->diagonal[i] > 0.0 ? p->diagonal[i] : 1.0;
}

void fl_profile_solve(const fl_profile *p, double *x)
{
    for (int32_t i = 0; i < p->n; i++) {
        const double *l = fl_profile_row(p, i);
        double sum = x[i];
        for (int32_t j = p->low[i]; j < i; j++) sum -= l[j] * x[j];
        x[i] = sum;
    }
    for (int32_t i = 0; i < p->n; i++) x[i] /= fl_profile_row(p, i)[i];
    for (int32_t i = p->n - 1; i >= 0; i--) {
        const double *l = fl_profile_row(p, i);
        for (int32_t j = p->low[i]; j < i; j++) x[j] -= l[j] * x[i];
    }
}
