/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "stat/rainflow_matrix.h"

static double class_edge(double lo, double hi, int32_t n, int32_t k)
{
    return k == n ? hi : lo + (hi - lo) * ((double)k / n);
}

/* The class by its limits as printed: a quotient alone may be off by one at a limit. */
static int32_t class_of(double lo, double hi, int32_t n, double x)
{
    if (!(hi > lo)) return 0;
    int32_t k = (int32_t)((x - lo) / (hi - lo) * n);
    if (k > n - 1) k = n - 1;
    while (k > 0 && x < class_edge(lo, hi, n, k)) k--;
    while (k + 1 < n && x >= class_edge(lo, hi, n, k + 1)) k++;
    return k;
}

static int compare_cells(const void *a, const void *b)
{
    const fl_rainflow_matrix_cell *p = a, *q = b;
    return p->range != q->range ? (p->range > q->range) - (p->range < q->range)
                                : (p->mean > q->mean) - (p->mean < q->mean);
}

int fl_rainflow_matrix_make(fl_rainflow_matrix *m, int32_t n, double largest, double lo, double hi,
                            int32_t count, const fl_cycle *cycle, fl_err *err)
{
    *m = (fl_rainflow_matrix){.n = n, .largest = largest, .lo = lo, .hi = hi};
    m->cell = fl_alloc(count, sizeof *m->cell, err);
    if (!m->cell) return -1;
    for (int32_t k = 0; k < count; k++)
        m->cell[k] = (fl_rainflow_matrix_cell){class_of(0.0, largest, n, cycle[k].range),
                                               class_of(lo, hi, n, cycle[k].mean), cycle[k].count};
    qsort(m->cell, (size_t)count, sizeof *m->cell, compare_cells);
    for (int32_t k = 0; k < count; k++) {
        if (m->cells && compare_cells(&m->cell[m->cells - 1], &m->cell[k]) == 0)
            m->cell[m->cells - 1].cycles += m->cell[k].cycles;
        else m->cell[m->cells++] = m->cell[k];
    }
    return 0;
}

double fl_rainflow_matrix_range(const fl_rainflow_matrix *m, int32_t k)
{
    return class_edge(0.0, m->largest, m->n, k);
}
double fl_rainflow_matrix_mean(const fl_rainflow_matrix *m, int32_t k)
{
    return class_edge(m->lo, m->hi, m->n, k);
}

void fl_rainflow_matrix_free(fl_rainflow_matrix *m)
{
    free(m->cell);
    *m = (fl_rainflow_matrix){0};
}
