/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "stat/series.h"

/* --- rows ----------------------------------------------------------------------------------------------- */

static int copy_names(fl_series *s, const fl_record *r, fl_err *err)
{
    memcpy(s->kind, r->kind, strlen(r->kind) + 1);
    s->signal = fl_alloc(r->signals, sizeof *s->signal, err);
    s->unit = s->signal ? fl_alloc(r->signals, sizeof *s->unit, err) : NULL;
    s->part = s->unit ? fl_alloc(r->parts, sizeof *s->part, err) : NULL;
    s->x = s->part ? fl_alloc((int64_t)r->parts * r->signals, sizeof *s->x, err) : NULL;
    if (!s->x) return -1;
    for (int32_t k = 0; k < r->signals; k++) {
        s->signals = k + 1;
        s->signal[k] = fl_alloc_text(r->signal[k], err);
        s->unit[k] = s->signal[k] ? fl_alloc_text(r->unit[k], err) : NULL;
        if (!s->unit[k]) return -1;
    }
    for (int32_t p = 0; p < r->parts; p++) {
        s->parts = p + 1;
        s->part[p] = fl_alloc_text(r->part[p], err);
        if (!s->part[p]) return -1;
    }
    return 0;
}

static int grow_series(fl_series *s, const fl_record *r, int32_t *cap, fl_err *err)
{
    const int64_t want = (int64_t)s->n + 2; /* there is one edge more than rows */
    int32_t next = *cap;
    for (int64_t k = 0; k < (int64_t)r->parts * r->signals; k++) {
        next = *cap;
        if (r->defined[k] && fl_grow(&s->x[k], &next, want, sizeof **s->x, err)) return -1;
    }
    next = *cap;
    if (fl_grow(&s->t, &next, want, sizeof *s->t, err)) return -1;
    next = *cap;
    if (fl_grow(&s->edge, &next, want, sizeof *s->edge, err)) return -1;
    *cap = next;
    return 0;
}

static int add_row(fl_series *s, const fl_record *r, int32_t *cap, fl_err *err)
{
    if (s->n + 1 >= *cap && grow_series(s, r, cap, err)) return -1;
    for (int64_t k = 0; k < (int64_t)r->parts * r->signals; k++)
        if (r->defined[k]) s->x[k][s->n] = r->x[k];
    s->t[s->n] = r->t;
    s->edge[s->n] = r->edge[0];
    s->edge[++s->n] = r->edge[1];
    return 0;
}

/* --- the cut -------------------------------------------------------------------------------------------- */

/* Times in the table are decimal: an edge may differ from the cut by rounding.  This fraction of the mean
 * interval is far above rounding and far below any intended interval. */
static const double CUT_SLACK = 1e-6;

/* The start of the first row with a non-zero signal; INFINITY where there is none. */
static double first_load_time(const fl_series *s)
{
    const int64_t pairs = (int64_t)s->parts * s->signals;
    for (int32_t k = 0; k < s->n; k++)
        for (int64_t j = 0; j < pairs; j++)
            if (s->x[j] && s->x[j][k] != 0.0) return s->edge[k];
    return INFINITY;
}

static int apply_cut(fl_series *s, const fl_record_selection *selection, const char *name, fl_err *err)
{
    const double first = s->edge[0], end = s->edge[s->n], slack = CUT_SLACK * (end - first) / s->n;
    const double to = fmin(selection->to, end);
    double from = fmax(selection->from, selection->last > 0.0 ? to - selection->last : first);
    if (selection->after_first_load > 0.0)
        from = fmax(from, first_load_time(s) + selection->after_first_load);
    if (from == INFINITY) return fl_fail(err, FL_INPUT, "%s: every load is 0, there is no first load", name);
    int32_t a = 0, b = s->n;
    while (a < b && s->edge[a] < from - slack) a++;
    while (b > a && s->edge[b] > to + slack) b--;
    if (a == b && from >= to)
        return fl_fail(err, FL_INPUT, "%s: the cut leaves no row, the record is from %.10g s to %.10g s",
                       name, first, end);
    if (a == b)
        return fl_fail(err, FL_INPUT,
                       "%s: no row lies between %.10g s and %.10g s, the record is from %.10g s to %.10g s",
                       name, from, to, first, end);
    s->n = b - a;
    memmove(s->t, s->t + a, (size_t)s->n * sizeof *s->t);
    memmove(s->edge, s->edge + a, ((size_t)s->n + 1) * sizeof *s->edge);
    for (int64_t k = 0; k < (int64_t)s->parts * s->signals; k++)
        if (s->x[k]) memmove(s->x[k], s->x[k] + a, (size_t)s->n * sizeof *s->x[k]);
    return 0;
}

/* --- series --------------------------------------------------------------------------------------------- */

int fl_series_read(fl_series *s, const char *path, const fl_record_selection *selection, fl_err *err)
{
    fl_record r = {0};
    int32_t cap = 0;
    int more, rc = -1;
    *s = (fl_series){0};
    if (fl_record_open(&r, path, selection, err)) goto done;
    while ((more = fl_record_next(&r, err)) > 0)
        if ((s->n == 0 && copy_names(s, &r, err)) || add_row(s, &r, &cap, err)) goto done;
    if (more < 0) goto done;
    if (fl_record_history(&r)) {
        s->history = fl_alloc_text(fl_record_history(&r), err);
        if (!s->history) goto done;
    }
    if (fl_record_run_lines(&r)) {
        s->run_lines = fl_alloc_text(fl_record_run_lines(&r), err);
        if (!s->run_lines) goto done;
    }
    s->end = fl_record_end(&r, s->why);
    s->has_motion = r.has_motion;
    rc = apply_cut(s, selection, fl_record_name(&r), err);
done:
    fl_record_close(&r);
    if (rc) fl_series_free(s);
    return rc;
}

void fl_series_drop_first(fl_series *s, int32_t rows)
{
    const size_t left = (size_t)(s->n - rows);
    for (int64_t k = 0; k < (int64_t)s->parts * s->signals; k++)
        if (s->x[k]) memmove(s->x[k], s->x[k] + rows, left * sizeof **s->x);
    memmove(s->t, s->t + rows, left * sizeof *s->t);
    memmove(s->edge, s->edge + rows, (left + 1) * sizeof *s->edge);
    s->n -= rows;
}

void fl_series_free(fl_series *s)
{
    for (int64_t k = 0; s->x && k < (int64_t)s->parts * s->signals; k++) free(s->x[k]);
    for (int32_t p = 0; p < s->parts; p++) free(s->part[p]);
    for (int32_t k = 0; k < s->signals; k++) {
        free(s->signal[k]);
        free(s->unit[k]);
    }
    free(s->x);
    free(s->part);
    free(s->signal);
    free(s->unit);
    free(s->edge);
    free(s->t);
    free(s->history);
    free(s->run_lines);
    *s = (fl_series){0};
}
