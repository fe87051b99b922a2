/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "stat/contact_events.h"
#include "stat/record.h"

/* Normals are printed with all digits: a larger deviation from length 1 means the vector is not a normal. */
static const double NORMAL_TOLERANCE = 1e-6;

enum { T, J, NX, NY, NZ, PX, PY, PZ, LENGTH, AREA, FN, FSX, FSY, FSZ, COLUMNS };
static const char *const NAME[COLUMNS] = {"t",  "j",      "nx",   "ny", "nz",  "px",  "py",
                                          "pz", "length", "area", "fn", "fsx", "fsy", "fsz"};

int fl_contact_events_open(fl_contact_events *h, const char *path, const fl_contact_selection *selection,
                           fl_err *err)
{
    *h = (fl_contact_events){.selection = *selection};
    if (fl_table_open(&h->table, path, "contacts", 1, err)) return -1;
    for (int k = 0; k < COLUMNS; k++)
        if (fl_table_require(&h->table, NAME[k], &h->col[k], err)) return -1;
    return fl_row_filter_make(&h->filter, &h->table, selection->where, selection->wheres, err);
}

/* Add the contact of this row if it is one of the selected parts of the structure. */
static int read_contact(fl_contact_events *h, fl_err *err)
{
    double x[COLUMNS], across;
    for (int k = J; k < COLUMNS; k++)
        if (fl_table_f64_bounded(&h->table, h->col[k], FL_RECORD_LARGEST_VALUE, &x[k], err)) return -1;
    if (!(x[J] < 0.0) || x[J] < INT32_MIN || x[J] != floor(x[J])) return 0;
    if (h->selection.part && x[J] != h->selection.part) return 0;
    if (!fl_row_filter_matches(&h->filter, &h->table)) return 0;
    fl_contact_event c = {.part = (int32_t)x[J],
                          .p = v3(x[PX], x[PY], x[PZ]),
                          .n = v3(x[NX], x[NY], x[NZ]),
                          .length = x[LENGTH],
                          .area = x[AREA],
                          .normal_force = x[FN]};
    across = v3_norm(c.n);
    if (!(fabs(across - 1.0) <= NORMAL_TOLERANCE))
        return fl_text_fail(&h->table.text, err, "the normal has the length %g, expected 1", across);
    if (c.length < 0.0 || c.area < 0.0)
        return fl_text_fail(&h->table.text, err, "length and area are %g m and %g m2, expected not below 0",
                            c.length, c.area);
    c.force = v3_neg(v3_add(v3_scale(c.normal_force, c.n), v3(x[FSX], x[FSY], x[FSZ])));
    if (fl_grow(&h->event, &h->cap, (int64_t)h->n + 1, sizeof *h->event, err)) return -1;
    h->event[h->n++] = c;
    return 0;
}

int fl_contact_events_next(fl_contact_events *h, fl_err *err)
{
    int open = 0; /* rows of a time have been read */
    h->n = 0;
    for (;;) {
        double t;
        if (!h->pending) {
            const int more = fl_table_row(&h->table, err);
            if (more < 0) return -1;
            if (more == 0) break;
        }
        h->pending = 0;
        if (fl_table_f64_bounded(&h->table, h->col[T], FL_RECORD_LARGEST_VALUE, &t, err)) return -1;
        if (open && t > h->t) {
            h->pending = 1;
            return 1;
        }
        if (h->times && t < h->time[h->times - 1])
            return fl_text_fail(&h->table.text, err, "time %.10g s comes after %.10g s", t,
                                h->time[h->times - 1]);
        if (t < h->selection.from || t > h->selection.to) continue;
        if (!open) {
            if (fl_grow(&h->time, &h->time_cap, (int64_t)h->times + 1, sizeof *h->time, err)) return -1;
            h->time[h->times++] = h->t = t;
            open = 1;
        }
        if (read_contact(h, err)) return -1;
    }
    if (h->times) return open;
    return fl_fail(err, FL_INPUT, "%s: no row lies between the selected times", fl_in_name(h->table.text.in));
}

static int compare_rising(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int fl_contact_events_span(const fl_contact_events *h, int64_t *times, double *step, fl_err *err)
{
    const int32_t n = h->times - 1;
    *times = h->times;
    *step = 0.0;
    if (n < 1) return 0;
    double *apart = fl_alloc(n, sizeof *apart, err);
    if (!apart) return -1;
    for (int32_t k = 0; k < n; k++) apart[k] = h->time[k + 1] - h->time[k];
    qsort(apart, (size_t)n, sizeof *apart, compare_rising);
    *step = apart[n / 2];
    free(apart);
    const double lo = isfinite(h->selection.from) ? h->selection.from : h->time[0],
                 hi = isfinite(h->selection.to) ? h->selection.to : h->time[n],
                 all = floor((hi - lo) / *step + 1.5);
    if (all > (double)*times && all < 9e15) *times = (int64_t)all;
    return 0;
}

void fl_contact_events_close(fl_contact_events *h)
{
    fl_table_close(&h->table);
    free(h->event);
    free(h->time);
    *h = (fl_contact_events){0};
}
