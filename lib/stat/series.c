/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/mem.h"
#include "base/num.h"
#include "base/table.h"
#include "stat/series.h"

enum { RAW_MAX = 64, SIGNAL_MAX = RAW_MAX / 3 };

/* A signal is the Euclidean length of one to three columns; of one column it is the column itself. */
typedef struct {
    int raw[3], n; /* indices into the columns that are read */
    int adds;      /* the sum over the parts means something */
} formula;

typedef struct {
    char *name;
    int keep;
    int32_t n, cap; /* n rows were seen; cap counts numbers of x */
    double *x;      /* [n * raws] */
} raw_part;

typedef struct {
    fl_table table;
    int32_t time, key;          /* columns; key < 0 when rows are not told apart */
    int32_t col[RAW_MAX], raws; /* columns that are read */
    int adds[RAW_MAX];
    formula form[SIGNAL_MAX];
    const char *name[SIGNAL_MAX], *unit[SIGNAL_MAX];
    int32_t signals;
    raw_part *part;
    int32_t parts, part_cap;
    int32_t *by_name; /* parts in the order of their names, once the first time is complete */
    double *t;
    int32_t n, t_cap; /* complete times */
    int32_t seen;     /* rows at the time being read */
    double now;
} reader;

static void reader_free(reader *r)
{
    for (int32_t p = 0; p < r->parts; p++) {
        free(r->part[p].name);
        free(r->part[p].x);
    }
    free(r->part);
    free(r->by_name);
    free(r->t);
    fl_table_close(&r->table);
}

static char *copy_text(const char *text, fl_err *err)
{
    const size_t bytes = strlen(text) + 1;
    char *copy = fl_alloc((int64_t)bytes, 1, err);
    return copy ? memcpy(copy, text, bytes) : NULL;
}

/* --- which columns -------------------------------------------------------------------------------------- */

static int adds_up(const char *name)
{
    static const char *const list[] = {"fx", "fy", "fz", "mx", "my", "mz", "contacts"};
    for (size_t k = 0; k < sizeof list / sizeof *list; k++)
        if (strcmp(name, list[k]) == 0) return 1;
    return 0;
}

static int want_column(reader *r, const char *name, int *raw, fl_err *err)
{
    int32_t col;
    if (fl_table_find(&r->table, name, &col, err)) return -1;
    for (*raw = 0; *raw < r->raws; ++*raw)
        if (r->col[*raw] == col) return 0;
    r->adds[r->raws] = strcmp(r->table.text.kind, "loads") == 0 && adds_up(r->table.name[col]);
    r->col[r->raws++] = col;
    return 0;
}

static int want_signal(reader *r, const char *name, fl_err *err)
{
    static const char *const axis[] = {"fx", "fy", "fz"};
    formula *f = &r->form[r->signals];
    const char *of[3] = {name, NULL, NULL};
    if (r->signals == SIGNAL_MAX)
        return fl_fail(err, FL_USAGE, "more than %d signals were asked for at once", SIGNAL_MAX);
    f->n = 1;
    if (fl_table_column(&r->table, name) < 0 && (strcmp(name, "fh") == 0 || strcmp(name, "f") == 0)) {
        f->n = name[1] == 'h' ? 2 : 3;
        memcpy(of, axis, sizeof of);
    }
    f->adds = 1;
    for (int k = 0; k < f->n; k++) {
        if (want_column(r, of[k], &f->raw[k], err)) return -1;
        f->adds &= r->adds[f->raw[k]];
    }
    const int32_t first = r->col[f->raw[0]];
    r->name[r->signals] = f->n == 1 ? r->table.name[first] : name;
    r->unit[r->signals] = r->table.unit[first];
    for (int32_t k = 0; k < r->signals; k++)
        if (strcmp(r->name[k], r->name[r->signals]) == 0) return 0; /* asked for twice: once is enough */
    r->signals++;
    return 0;
}

static int want_all(reader *r, const fl_series_ask *ask, fl_err *err)
{
    static const char *const usual[] = {"fx", "fy", "fz", "fh"};
    const int loads = strcmp(r->table.text.kind, "loads") == 0;
    const char *const *list = ask->signals ? ask->signal : usual;
    const int32_t n = ask->signals ? ask->signals : (int32_t)(sizeof usual / sizeof *usual);
    if (!loads && !ask->signals)
        return fl_fail(err, FL_USAGE, "%s: a column of this %s table must be chosen, it is not loads",
                       fl_in_name(r->table.text.in), r->table.text.kind);
    if (fl_table_find(&r->table, "t", &r->time, err)) return -1;
    if (loads && fl_table_find(&r->table, "part", &r->key, err)) return -1;
    if (!loads) r->key = fl_table_column(&r->table, "part");
    if (!loads && r->key < 0) r->key = fl_table_column(&r->table, "body");
    for (int32_t k = 0; k < n; k++)
        if (want_signal(r, list[k], err)) return -1;
    if (ask->part && strcmp(ask->part, "total") == 0) {
        for (int32_t k = 0; k < r->signals; k++)
            if (!r->form[k].adds)
                return fl_fail(err, FL_USAGE, "%s has no total: its sum over the parts means nothing",
                               r->name[k]);
    }
    return 0;
}

/* --- rows ----------------------------------------------------------------------------------------------- */

static int add_part(reader *r, const char *name, const fl_series_ask *ask, fl_err *err)
{
    raw_part *p;
    if (fl_grow(&r->part, &r->part_cap, r->parts + 1, sizeof *r->part, err)) return -1;
    p = &r->part[r->parts];
    *p = (raw_part){.name = copy_text(name, err)};
    if (!p->name) return -1;
    p->keep = !ask->part || strcmp(ask->part, "total") == 0 || strcmp(ask->part, name) == 0;
    return r->parts++;
}

static _Thread_local const raw_part *sorting; /* qsort hands its comparison no argument */

static int compare_parts(const void *a, const void *b)
{
    return strcmp(sorting[*(const int32_t *)a].name, sorting[*(const int32_t *)b].name);
}

/* The first time is complete: its rows are the list of parts. */
static int freeze_parts(reader *r, fl_err *err)
{
    r->by_name = fl_alloc(r->parts, sizeof *r->by_name, err);
    if (!r->by_name) return -1;
    for (int32_t p = 0; p < r->parts; p++) r->by_name[p] = p;
    sorting = r->part;
    qsort(r->by_name, (size_t)r->parts, sizeof *r->by_name, compare_parts);
    for (int32_t p = 1; p < r->parts; p++) {
        const char *name = r->part[r->by_name[p]].name;
        if (strcmp(name, r->part[r->by_name[p - 1]].name) == 0)
            return fl_fail(err, FL_INPUT, "%s: %.60s has two rows at %.10g s", fl_in_name(r->table.text.in),
                           name, r->now);
    }
    return 0;
}

static int32_t find_part(const reader *r, const char *name)
{
    int32_t lo = 0, hi = r->parts - 1;
    if (r->seen < r->parts && strcmp(r->part[r->seen].name, name) == 0) return r->seen; /* the usual order */
    while (lo <= hi) {
        const int32_t k = lo + (hi - lo) / 2;
        const int c = strcmp(name, r->part[r->by_name[k]].name);
        if (c == 0) return r->by_name[k];
        if (c < 0) hi = k - 1;
        else lo = k + 1;
    }
    return -1;
}

/* All rows of one time have been read. */
static int close_time(reader *r, fl_err *err)
{
    if (r->seen == 0) return 0;
    if (!r->by_name && freeze_parts(r, err)) return -1;
    for (int32_t p = 0; r->seen < r->parts && p < r->parts; p++)
        if (r->part[p].n == r->n)
            return fl_text_fail(&r->table.text, err, "%.60s has no row at %.10g s", r->part[p].name, r->now);
    if (fl_grow(&r->t, &r->t_cap, r->n + 1, sizeof *r->t, err)) return -1;
    r->t[r->n++] = r->now;
    r->seen = 0;
    return 0;
}

static int take_values(reader *r, raw_part *p, fl_err *err)
{
    if (p->keep && fl_grow(&p->x, &p->cap, ((int64_t)p->n + 1) * r->raws, sizeof *p->x, err)) return -1;
    for (int32_t k = 0; p->keep && k < r->raws; k++) {
        double *x = &p->x[(int64_t)p->n * r->raws + k];
        if (fl_table_f64(&r->table, r->col[k], x, err)) return -1;
        if (fabs(*x) > FL_SERIES_LARGEST)
            return fl_text_fail(&r->table.text, err, "%.60s is %g, at most %g was expected",
                                r->table.name[r->col[k]], *x, FL_SERIES_LARGEST);
    }
    p->n++;
    return 0;
}

static int take_row(reader *r, const fl_series_ask *ask, fl_err *err)
{
    const char *name = r->key < 0 ? "-" : fl_table_word(&r->table, r->key);
    double t;
    int32_t p;
    if (fl_table_f64(&r->table, r->time, &t, err)) return -1;
    if (fabs(t) > FL_SERIES_LARGEST) return fl_text_fail(&r->table.text, err, "time %g s is out of reach", t);
    if (r->seen && (r->key < 0 || t != r->now) && close_time(r, err)) return -1;
    const double before = r->n ? r->t[r->n - 1] : r->table.start;
    if (r->seen == 0 && (r->n || strcmp(r->table.text.kind, "loads") == 0) && !(t > before))
        return fl_text_fail(&r->table.text, err, "time %.15g s does not follow %.15g s%s", t, before,
                            r->n ? "" : ", where the record starts");
    r->now = t;
    p = r->by_name ? find_part(r, name) : add_part(r, name, ask, err);
    if (p < 0)
        return fl_text_fail(&r->table.text, err, "%.60s was not there at %.10g s", name, r->t ? r->t[0] : t);
    if (r->part[p].n > r->n)
        return fl_text_fail(&r->table.text, err, "%.60s has two rows at %.10g s", name, t);
    r->seen++;
    return take_values(r, &r->part[p], err);
}

/* --- from rows to signals ------------------------------------------------------------------------------- */

static int make_edges(fl_series *s, const reader *r, fl_err *err)
{
    s->edge = fl_alloc((int64_t)s->n + 1, sizeof *s->edge, err);
    if (!s->edge) return -1;
    if (strcmp(s->kind, "loads") == 0) {
        s->edge[0] = r->table.start;
        memcpy(s->edge + 1, s->t, (size_t)s->n * sizeof *s->edge);
        return 0;
    }
    for (int32_t k = 1; k < s->n; k++) s->edge[k] = s->t[k - 1] + 0.5 * (s->t[k] - s->t[k - 1]);
    /* One sample alone has no neighbours; any length will do, as it is the only weight. */
    s->edge[0] = s->n > 1 ? s->t[0] - (s->edge[1] - s->t[0]) : s->t[0] - 0.5;
    s->edge[s->n] = s->n > 1 ? s->t[s->n - 1] + (s->t[s->n - 1] - s->edge[s->n - 1]) : s->t[0] + 0.5;
    return 0;
}

static double length3(const double *raw, const formula *f)
{
    if (f->n == 1) return raw[f->raw[0]];
    const double h = hypot(raw[f->raw[0]], raw[f->raw[1]]);
    return f->n == 2 ? h : hypot(h, raw[f->raw[2]]);
}

static int make_part(fl_series *s, const reader *r, const raw_part *p, fl_err *err)
{
    double **to = s->x + (int64_t)s->parts * s->signals;
    s->part[s->parts] = copy_text(p->name, err);
    if (!s->part[s->parts++]) return -1;
    for (int32_t k = 0; k < r->signals; k++) {
        double *x = fl_alloc(s->n, sizeof *x, err);
        if (!x) return -1;
        to[k] = x;
        for (int32_t i = 0; i < s->n; i++) x[i] = length3(p->x + (int64_t)i * r->raws, &r->form[k]);
    }
    return 0;
}

/* The sum over the parts, in the order of the file, so that it has one value. */
static int make_total(fl_series *s, const reader *r, fl_err *err)
{
    double **to = s->x + (int64_t)s->parts * s->signals;
    s->part[s->parts] = copy_text("total", err);
    if (!s->part[s->parts++]) return -1;
    for (int32_t k = 0; k < r->signals; k++) {
        double *x, sum[RAW_MAX];
        if (!r->form[k].adds) continue;
        x = fl_alloc(s->n, sizeof *x, err);
        if (!x) return -1;
        to[k] = x;
        for (int32_t i = 0; i < s->n; i++) {
            memset(sum, 0, sizeof sum);
            for (int32_t p = 0; p < r->parts; p++)
                for (int32_t c = 0; c < r->raws; c++) sum[c] += r->part[p].x[(int64_t)i * r->raws + c];
            x[i] = length3(sum, &r->form[k]);
        }
    }
    return 0;
}

static int make_signals(fl_series *s, const reader *r, const fl_series_ask *ask, fl_err *err)
{
    const int only_total = ask->part && strcmp(ask->part, "total") == 0;
    int total = 0;
    for (int32_t k = 0; k < r->signals; k++) total |= r->form[k].adds;
    total = total && (!ask->part || only_total);
    s->signal = fl_alloc(r->signals, sizeof *s->signal, err);
    s->unit = s->signal ? fl_alloc(r->signals, sizeof *s->unit, err) : NULL;
    s->part = s->unit ? fl_alloc((int64_t)r->parts + 1, sizeof *s->part, err) : NULL;
    s->x = s->part ? fl_alloc(((int64_t)r->parts + 1) * r->signals, sizeof *s->x, err) : NULL;
    if (!s->x) return -1;
    for (int32_t k = 0; k < r->signals; k++) {
        s->signals = k + 1;
        s->signal[k] = copy_text(r->name[k], err);
        s->unit[k] = s->signal[k] ? copy_text(r->unit[k], err) : NULL;
        if (!s->unit[k]) return -1;
    }
    for (int32_t p = 0; p < r->parts; p++) {
        /* A structure of one part called total is its own sum. */
        if (total && r->parts > 1 && strcmp(r->part[p].name, "total") == 0)
            return fl_fail(err, FL_INPUT, "%s: a part is called total, the name of the sum over the parts",
                           fl_in_name(r->table.text.in));
        if (only_total || !r->part[p].keep || (total && strcmp(r->part[p].name, "total") == 0)) continue;
        if (make_part(s, r, &r->part[p], err)) return -1;
    }
    return total ? make_total(s, r, err) : 0;
}

/* --- the cut -------------------------------------------------------------------------------------------- */

/* Times in the table are decimal: an edge may miss the cut by its rounding.  A millionth of the mean interval
 * is far above that and far below any interval that is meant. */
static const double CUT_SLACK = 1e-6;

static int cut(fl_series *s, const fl_series_ask *ask, const char *name, fl_err *err)
{
    const double first = s->edge[0], end = s->edge[s->n], slack = CUT_SLACK * (end - first) / s->n;
    const double to = fmin(ask->to, end), from = fmax(ask->from, ask->last > 0.0 ? to - ask->last : first);
    int32_t a = 0, b = s->n;
    while (a < b && s->edge[a] < from - slack) a++;
    while (b > a && s->edge[b] > to + slack) b--;
    if (a == b && from >= to)
        return fl_fail(err, FL_INPUT, "%s: nothing is left by the cut, the record is from %.10g s to %.10g s",
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

/* --- all of it ------------------------------------------------------------------------------------------ */

static int check_part(const reader *r, const fl_series_ask *ask, fl_err *err)
{
    const char **names;
    if (!ask->part || strcmp(ask->part, "total") == 0 || find_part(r, ask->part) >= 0) return 0;
    names = fl_alloc(r->parts, sizeof *names, err);
    if (!names) return -1;
    for (int32_t p = 0; p < r->parts; p++) names[p] = r->part[p].name;
    fl_fail(err, FL_INPUT, "%s: no part %.60s, the nearest is %.60s", fl_in_name(r->table.text.in), ask->part,
            fl_text_nearest(ask->part, names, r->parts));
    free(names);
    return -1;
}

int fl_series_read(fl_series *s, const char *path, const fl_series_ask *ask, fl_err *err)
{
    reader r = {.key = -1};
    int more, rc = -1;
    *s = (fl_series){0};
    if (fl_table_open(&r.table, path, NULL, 1, err) || want_all(&r, ask, err)) goto done;
    while ((more = fl_table_row(&r.table, err)) > 0)
        if (take_row(&r, ask, err)) goto done;
    if (more < 0 || close_time(&r, err)) goto done;
    if (r.n == 0) {
        fl_text_fail(&r.table.text, err, "the %s table ends here without a row", r.table.text.kind);
        goto done;
    }
    if (check_part(&r, ask, err)) goto done;
    memcpy(s->kind, r.table.text.kind, sizeof s->kind);
    s->n = r.n;
    s->t = r.t;
    r.t = NULL;
    s->history = r.table.text.history;
    r.table.text.history = NULL;
    if (make_edges(s, &r, err) || make_signals(s, &r, ask, err)) goto done;
    rc = cut(s, ask, fl_in_name(r.table.text.in), err);
done:
    reader_free(&r);
    if (rc) fl_series_free(s);
    return rc;
}

int32_t fl_series_part(const fl_series *s, const char *name)
{
    for (int32_t p = 0; p < s->parts; p++)
        if (strcmp(s->part[p], name) == 0) return p;
    return -1;
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
    *s = (fl_series){0};
}
