/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/table.h"
#include "stat/record.h"
#include "stat/row_filter.h"

enum { RAW_MAX = 64, SIGNAL_MAX = RAW_MAX / 3 };

enum formula_kind { LENGTH, RESISTANCE, MOMENT, OVERTURNING };
enum { FORMULA_COLUMNS = 5 };

/* A signal is the Euclidean length of one to three columns; of one column it is the column itself.  The
 * resistance is minus the component of a horizontal force along a horizontal velocity, of four columns.  A
 * moment about another point, M - p x F, has the columns of one component; the overturning moment is the
 * length of its horizontal part. */
typedef struct {
    enum formula_kind kind;
    int raw[FORMULA_COLUMNS], n; /* indices into the columns that are read */
    int axis;                    /* of a moment: 0 x, 1 y, 2 z */
    int adds;                    /* the sum over the parts is meaningful */
} formula;

typedef struct {
    char *name;
    int keep;
    int64_t n; /* times with a row of this part */
} raw_part;

struct fl_record_reader {
    fl_table table;
    fl_record_selection selection;
    int loads;
    int32_t time, key;          /* columns; key < 0 when no column distinguishes rows */
    int32_t col[RAW_MAX], raws; /* columns that are read */
    int adds[RAW_MAX];
    fl_row_filter where;
    formula form[SIGNAL_MAX];
    const char *name[SIGNAL_MAX], *unit[SIGNAL_MAX];
    int32_t signals;
    raw_part *part;
    double *raw; /* [parts * raws] of the time being read */
    int32_t parts, part_cap, raw_cap;
    int32_t *by_name;   /* parts sorted by name, once the first time is complete */
    int32_t *shown;     /* [n_shown] reported parts, -1 for the total */
    const char **label; /* [n_shown] their names */
    unsigned char *has;
    int32_t n_shown;
    int64_t n;         /* complete times */
    int32_t seen;      /* rows at the time being read */
    double now, first; /* the time being read, and the first of all */
    int pending;       /* the row in the table belongs to the next time; 2: the table has ended */
    /* The last time read and, while its interval is not known yet, the one before. */
    double *x[2], t[2], before;
    int waiting;
};

/* --- columns -------------------------------------------------------------------------------------------- */

const char *fl_reduction_name(int reduction)
{
    static const char *const name[FL_REDUCTIONS] = {"", "sum", "mean", "min", "max", "count"};
    return name[reduction];
}

static int is_additive(const char *name)
{
    static const char *const list[] = {"fx",          "fy",          "fz",         "mx",
                                       "my",          "mz",          "contacts",   "fx_platform",
                                       "fy_platform", "mx_platform", "my_platform"};
    for (size_t k = 0; k < sizeof list / sizeof *list; k++)
        if (strcmp(name, list[k]) == 0) return 1;
    return 0;
}

static int add_column(fl_record_reader *r, const char *name, int *raw, fl_err *err)
{
    int32_t col;
    if (fl_table_require(&r->table, name, &col, err)) return -1;
    for (*raw = 0; *raw < r->raws; ++*raw)
        if (r->col[*raw] == col) return 0;
    r->adds[r->raws] = r->loads && !r->selection.reduction && is_additive(r->table.name[col]);
    r->col[r->raws++] = col;
    return 0;
}

static int add_signal(fl_record_reader *r, const fl_record_selection *selection, const char *name,
                      fl_err *err)
{
    static const char *const axis[] = {"fx", "fy", "fz"}, *const turn[] = {"mx", "my", "mz"},
                             *const over[] = {"mx", "my", "fx", "fy", "fz"};
    formula *f = &r->form[r->signals];
    const char *of[FORMULA_COLUMNS] = {name};
    if (r->signals == SIGNAL_MAX)
        return fl_fail(err, FL_USAGE, "at most %d signals can be selected", SIGNAL_MAX);
    *f = (formula){.n = 1};
    for (int k = 0; k < 3 && selection->about && r->loads; k++)
        if (strcmp(name, turn[k]) == 0) {
            *f = (formula){.kind = MOMENT, .n = 3, .axis = k};
            of[1] = axis[(k + 1) % 3], of[2] = axis[(k + 2) % 3];
        }
    if (fl_table_column(&r->table, name) < 0 && strcmp(name, "mh") == 0) {
        *f = (formula){.kind = OVERTURNING, .n = FORMULA_COLUMNS};
        memcpy(of, over, sizeof over);
    }
    if (fl_table_column(&r->table, name) < 0 && (strcmp(name, "fh") == 0 || strcmp(name, "f") == 0)) {
        f->n = name[1] == 'h' ? 2 : 3;
        memcpy(of, axis, sizeof axis);
    }
    if (fl_table_column(&r->table, name) < 0 && strcmp(name, "resistance") == 0) {
        f->n = 4;
        f->kind = RESISTANCE;
        of[0] = "fx", of[1] = "fy", of[2] = "vx", of[3] = "vy";
    }
    f->adds = 1;
    for (int k = 0; k < f->n; k++) {
        if (add_column(r, of[k], &f->raw[k], err)) return -1;
        f->adds &= r->adds[f->raw[k]];
    }
    const int32_t first = r->col[f->raw[0]];
    r->name[r->signals] = f->n == 1 || f->kind == MOMENT ? r->table.name[first] : name;
    r->unit[r->signals] = selection->reduction == FL_REDUCE_COUNT ? "" : r->table.unit[first];
    for (int32_t k = 0; k < r->signals; k++)
        if (strcmp(r->name[k], r->name[r->signals]) == 0) return 0; /* a repeated signal counts once */
    r->signals++;
    return 0;
}

static int add_signals(fl_record_reader *r, const fl_record_selection *selection, fl_err *err)
{
    static const char *const usual[] = {"fx", "fy", "fz", "fh"};
    const int loads = r->loads;
    const char *const *list = selection->signals ? selection->signal : usual;
    const int32_t n = selection->signals ? selection->signals : (int32_t)(sizeof usual / sizeof *usual);
    if (!loads && !selection->signals)
        return fl_fail(err, FL_USAGE, "%s: a column of this %s table must be chosen, it is not loads",
                       fl_in_name(r->table.text.in), r->table.text.kind);
    if (fl_table_require(&r->table, "t", &r->time, err)) return -1;
    if (fl_row_filter_make(&r->where, &r->table, selection->where, selection->wheres, err)) return -1;
    if (selection->reduction) r->key = -1;
    else if (loads && fl_table_require(&r->table, "part", &r->key, err)) return -1;
    if (!loads && !selection->reduction) r->key = fl_table_column(&r->table, "part");
    if (!loads && !selection->reduction && r->key < 0) r->key = fl_table_column(&r->table, "body");
    for (int32_t k = 0; k < n; k++)
        if (add_signal(r, selection, list[k], err)) return -1;
    if (selection->part && strcmp(selection->part, "total") == 0) {
        for (int32_t k = 0; k < r->signals; k++)
            if (!r->form[k].adds)
                return fl_fail(err, FL_USAGE, "%s has no total: its sum over the parts is meaningless",
                               r->name[k]);
    }
    return 0;
}

/* --- rows ----------------------------------------------------------------------------------------------- */

static int32_t add_part(fl_record_reader *r, const char *name, fl_err *err)
{
    const char *const only = r->selection.part;
    raw_part *p;
    if (fl_grow(&r->part, &r->part_cap, (int64_t)r->parts + 1, sizeof *r->part, err) ||
        fl_grow(&r->raw, &r->raw_cap, ((int64_t)r->parts + 1) * r->raws, sizeof *r->raw, err))
        return -1;
    p = &r->part[r->parts];
    *p = (raw_part){.name = fl_alloc_text(name, err)};
    if (!p->name) return -1;
    p->keep = !only || strcmp(only, "total") == 0 || strcmp(only, name) == 0;
    return r->parts++;
}

static _Thread_local const raw_part *parts_to_sort; /* qsort passes no context to its comparison */

static int compare_parts(const void *a, const void *b)
{
    return strcmp(parts_to_sort[*(const int32_t *)a].name, parts_to_sort[*(const int32_t *)b].name);
}

static int32_t find_part(const fl_record_reader *r, const char *name)
{
    int32_t lo = 0, hi = r->parts - 1;
    if (r->seen < r->parts && strcmp(r->part[r->seen].name, name) == 0)
        return r->seen; /* rows in the usual order */
    while (lo <= hi) {
        const int32_t k = lo + (hi - lo) / 2;
        const int c = strcmp(name, r->part[r->by_name[k]].name);
        if (c == 0) return r->by_name[k];
        if (c < 0) hi = k - 1;
        else lo = k + 1;
    }
    return -1;
}

static int check_part(const fl_record_reader *r, fl_err *err)
{
    const char **names, *const want = r->selection.part;
    if (!want || strcmp(want, "total") == 0 || find_part(r, want) >= 0) return 0;
    names = fl_alloc(r->parts, sizeof *names, err);
    if (!names) return -1;
    for (int32_t p = 0; p < r->parts; p++) names[p] = r->part[p].name;
    fl_fail(err, FL_INPUT, "%s: no part %.60s, the nearest is %.60s", fl_in_name(r->table.text.in), want,
            fl_text_nearest(want, names, r->parts));
    free(names);
    return -1;
}

/* Choose the reported parts, and whether their total is one. */
static int choose_parts(fl_record_reader *r, fl_err *err)
{
    const int only_total = r->selection.part && strcmp(r->selection.part, "total") == 0;
    int total = 0;
    for (int32_t k = 0; k < r->signals; k++) total |= r->form[k].adds;
    total = total && (!r->selection.part || only_total);
    r->shown = fl_alloc((int64_t)r->parts + 1, sizeof *r->shown, err);
    r->label = r->shown ? fl_alloc((int64_t)r->parts + 1, sizeof *r->label, err) : NULL;
    if (!r->label) return -1;
    for (int32_t p = 0; p < r->parts; p++) {
        const int is_total = total && strcmp(r->part[p].name, "total") == 0;
        /* A structure of one part named total is its own sum. */
        if (is_total && r->parts > 1)
            return fl_fail(err, FL_INPUT, "%s: a part is called total, the name of the sum over the parts",
                           fl_in_name(r->table.text.in));
        if (only_total || !r->part[p].keep || is_total) continue;
        r->label[r->n_shown] = r->part[p].name;
        r->shown[r->n_shown++] = p;
    }
    if (total) {
        r->label[r->n_shown] = "total";
        r->shown[r->n_shown++] = -1;
    }
    const int64_t n = (int64_t)r->n_shown * r->signals;
    r->has = fl_alloc(n, 1, err);
    r->x[0] = r->has ? fl_alloc(n, sizeof(double), err) : NULL;
    r->x[1] = r->x[0] ? fl_alloc(n, sizeof(double), err) : NULL;
    if (!r->x[1]) return -1;
    for (int64_t k = 0; k < n; k++)
        r->has[k] = (unsigned char)(r->shown[k / r->signals] >= 0 || r->form[k % r->signals].adds);
    return 0;
}

/* The first time is complete: its rows define the parts. */
static int fix_parts(fl_record_reader *r, fl_err *err)
{
    r->by_name = fl_alloc(r->parts, sizeof *r->by_name, err);
    if (!r->by_name) return -1;
    for (int32_t p = 0; p < r->parts; p++) r->by_name[p] = p;
    parts_to_sort = r->part;
    qsort(r->by_name, (size_t)r->parts, sizeof *r->by_name, compare_parts);
    for (int32_t p = 1; p < r->parts; p++) {
        const char *name = r->part[r->by_name[p]].name;
        if (strcmp(name, r->part[r->by_name[p - 1]].name) == 0)
            return fl_fail(err, FL_INPUT, "%s: %.60s has two rows at %.10g s", fl_in_name(r->table.text.in),
                           name, r->now);
    }
    return check_part(r, err) ? -1 : choose_parts(r, err);
}

/* Component k of M - p x F; m of M, a and b of F, along the axes after k. */
static double moment_about(const double *p, int k, double m, double a, double b)
{
    return p ? m - (p[(k + 1) % 3] * b - p[(k + 2) % 3] * a) : m;
}

static double evaluate_formula(const double *raw, const formula *f, const double *about)
{
    double c[FORMULA_COLUMNS] = {0};
    for (int k = 0; k < f->n; k++) c[k] = raw[f->raw[k]];
    if (f->kind == MOMENT) return moment_about(about, f->axis, c[0], c[1], c[2]);
    if (f->kind == OVERTURNING)
        return hypot(moment_about(about, 0, c[0], c[3], c[4]), moment_about(about, 1, c[1], c[4], c[2]));
    if (f->n == 1) return c[0];
    const double h = hypot(c[0], c[1]);
    if (f->kind == RESISTANCE) {
        const double v = hypot(c[2], c[3]);
        return v > 0.0 ? -(c[0] * c[2] + c[1] * c[3]) / v : 0.0;
    }
    return f->n == 2 ? h : hypot(h, c[2]);
}

/* All rows of one time have been read: compute signals from columns.  The total is summed in the order in
 * which the parts first appeared, so its rounding does not depend on the order of later rows. */
static int close_time(fl_record_reader *r, fl_err *err)
{
    if (!r->by_name && fix_parts(r, err)) return -1;
    if (r->selection.reduction == FL_REDUCE_MEAN)
        for (int32_t c = 0; c < r->raws; c++) r->raw[c] /= r->seen;
    for (int32_t p = 0; r->seen < r->parts && p < r->parts; p++)
        if (r->part[p].n == r->n)
            return fl_text_fail(&r->table.text, err, "%.60s has no row at %.10g s", r->part[p].name, r->now);
    double *x = r->x[!r->waiting], sum[RAW_MAX];
    for (int32_t k = 0; k < r->n_shown; k++) {
        const double *raw = sum;
        if (r->shown[k] >= 0) {
            raw = r->raw + (int64_t)r->shown[k] * r->raws;
        } else {
            memset(sum, 0, sizeof sum);
            for (int32_t p = 0; p < r->parts; p++)
                for (int32_t c = 0; c < r->raws; c++) sum[c] += r->raw[(int64_t)p * r->raws + c];
        }
        for (int32_t s = 0; s < r->signals; s++)
            *x++ = evaluate_formula(raw, &r->form[s], r->selection.about);
    }
    r->t[!r->waiting] = r->now;
    r->n++;
    r->seen = 0;
    return 0;
}

/* Combine x with the earlier rows of this time. */
static void combine_value(int reduction, int first, double x, double *sum)
{
    if (reduction == FL_REDUCE_COUNT) x = 1.0;
    if (first || reduction == FL_REDUCE_NONE) *sum = x;
    else if (reduction == FL_REDUCE_MIN) *sum = fmin(*sum, x);
    else if (reduction == FL_REDUCE_MAX) *sum = fmax(*sum, x);
    else *sum += x;
}

static int read_values(fl_record_reader *r, int32_t part, fl_err *err)
{
    raw_part *p = &r->part[part];
    double *sum = r->raw + (int64_t)part * r->raws, x;
    for (int32_t k = 0; p->keep && k < r->raws; k++, sum++) {
        if (fl_table_f64(&r->table, r->col[k], &x, err)) return -1;
        if (fabs(x) > FL_RECORD_LARGEST_VALUE)
            return fl_text_fail(&r->table.text, err, "%.60s is %g, expected at most %g",
                                r->table.name[r->col[k]], x, FL_RECORD_LARGEST_VALUE);
        combine_value(r->selection.reduction, r->seen == 1, x, sum);
    }
    if (p->n == r->n) p->n++;
    return 0;
}

static int fail_unknown_part(const fl_record_reader *r, const char *name, fl_err *err)
{
    return fl_text_fail(&r->table.text, err, "%.60s was not there at %.10g s", name, r->first);
}

/* Read the row in the table, or leave it pending when it belongs to the next time. */
static int read_row(fl_record_reader *r, fl_err *err)
{
    const char *name = r->key < 0 ? "-" : fl_table_word(&r->table, r->key);
    double t;
    int32_t p;
    if (fl_table_f64(&r->table, r->time, &t, err)) return -1;
    if (fabs(t) > FL_RECORD_LARGEST_VALUE)
        return fl_text_fail(&r->table.text, err, "time %g s is out of range", t);
    r->pending = r->seen && t != r->now;
    if (r->pending) return 0;
    if (r->seen == 0 && (r->n || r->loads)) {
        const double before = r->n ? r->now : r->table.start;
        /* A complete time has a further row: of a known part, or of a new one. */
        if (r->n && r->key >= 0 && t == before)
            return find_part(r, name) < 0
                       ? fail_unknown_part(r, name, err)
                       : fl_text_fail(&r->table.text, err, "%.60s has two rows at %.10g s", name, t);
        if (r->n && r->key < 0 && !r->selection.reduction && t == before)
            return fl_text_fail(&r->table.text, err,
                                "several rows at %.10g s, and no column part or body tells them apart", t);
        if (!(t > before))
            return fl_text_fail(&r->table.text, err, "time %.15g s does not follow %.15g s%s", t, before,
                                r->n ? "" : ", where the record starts");
    }
    if (r->n == 0 && r->seen == 0) r->first = t;
    r->now = t;
    if (r->selection.reduction && r->parts) p = 0;
    else p = r->by_name ? find_part(r, name) : add_part(r, name, err);
    if (p < 0 && !r->by_name) return -1;
    if (p < 0) return fail_unknown_part(r, name, err);
    if (r->part[p].n > r->n && !r->selection.reduction)
        return fl_text_fail(&r->table.text, err, "%.60s has two rows at %.10g s", name, t);
    r->seen++;
    return read_values(r, p, err);
}

/* Read until a time is complete: 1, 0 at the end, -1.  The first time is complete when another begins; later
 * ones with the row of the last missing part. */
static int read_time(fl_record_reader *r, fl_err *err)
{
    for (;;) {
        if (r->pending != 1) {
            const int more = r->pending ? 0 : fl_table_row(&r->table, err);
            if (more < 0) return -1;
            if (more == 0) {
                r->pending = 2;
                if (r->seen) return close_time(r, err) ? -1 : 1;
                if (r->n) return 0;
                return fl_text_fail(&r->table.text, err, "the %s table ends here without a row%s",
                                    r->table.text.kind,
                                    r->selection.wheres ? " that meets the conditions" : "");
            }
        }
        if (r->pending == 0 && !fl_row_filter_matches(&r->where, &r->table)) continue;
        if (read_row(r, err)) return -1;
        if (r->pending || (!r->selection.reduction && (r->key < 0 || (r->by_name && r->seen == r->parts))))
            return close_time(r, err) ? -1 : 1;
    }
}

/* --- reader --------------------------------------------------------------------------------------------- */

int fl_record_open(fl_record *r, const char *path, const fl_record_selection *selection, fl_err *err)
{
    *r = (fl_record){0};
    fl_record_reader *own = r->reader = fl_alloc(1, sizeof *own, err);
    if (!own) return -1;
    own->key = -1;
    own->selection = *selection;
    int rc = fl_table_open(&own->table, path, NULL, 1, err);
    if (rc == 0 && strcmp(own->table.text.kind, "summary") == 0)
        rc = fl_fail(err, FL_INPUT, "%s: this is a summary of runs, expected a record",
                     fl_in_name(own->table.text.in));
    own->loads = rc == 0 && strcmp(own->table.text.kind, "loads") == 0;
    if (rc == 0) rc = add_signals(own, selection, err);
    if (rc) {
        fl_record_close(r);
        return -1;
    }
    r->kind = own->table.text.kind;
    fl_in_follow(own->table.text.in, selection->patience);
    own->before = own->table.start;
    r->signals = own->signals;
    r->signal = own->name;
    r->unit = own->unit;
    r->has_motion = fl_table_column(&own->table, "vx") >= 0;
    return 0;
}

static void publish_time(fl_record *r, int which)
{
    fl_record_reader *own = r->reader;
    r->parts = own->n_shown;
    r->part = own->label;
    r->defined = own->has;
    r->x = own->x[which];
    r->t = own->t[which];
    r->n++;
}

int fl_record_next(fl_record *r, fl_err *err)
{
    fl_record_reader *own = r->reader;
    int more;
    if (own->loads) {
        own->waiting = 0;
        more = read_time(own, err);
        if (more <= 0) return more;
        publish_time(r, 1);
        r->edge[0] = own->before;
        r->edge[1] = own->before = r->t;
        return 1;
    }
    /* A sample needs its neighbours: one time is read ahead into the other buffer. */
    if (r->n == 0) {
        own->waiting = 1;
        more = read_time(own, err);
        if (more <= 0) return more;
    } else if (own->waiting < 0) {
        return 0;
    }
    const int here = !own->waiting;
    own->waiting = here;
    more = read_time(own, err);
    if (more < 0) return -1;
    publish_time(r, here);
    const double t = r->t, next = own->t[!here], middle = t + 0.5 * (next - t);
    /* A single sample has no neighbours.  Its length is the only weight, so any length above rounding will
     * do. */
    if (r->n == 1) own->before = more ? t - (middle - t) : t - fmax(0.5, fabs(t) * DBL_EPSILON);
    r->edge[0] = own->before;
    r->edge[1] = own->before = more ? middle : t + (t - r->edge[0]);
    if (!more) own->waiting = -1;
    return 1;
}

const char *fl_record_history(const fl_record *r) { return r->reader->table.text.history; }

const char *fl_record_run_lines(const fl_record *r) { return r->reader->table.text.run_lines; }

/* 1 if one of the lines begins with that word. */
static int has_line(const char *lines, const char *word)
{
    for (const char *p = lines; p && *p; p = strchr(p, '\n') + 1)
        if (strncmp(p, word, strlen(word)) == 0) return 1;
    return 0;
}

enum fl_run_end fl_record_end(const fl_record *r, char why[FL_RUN_END_TEXT])
{
    static const char STOPPED[] = "#stopped ";
    const char *lines = fl_record_run_lines(r);
    why[0] = '\0';
    for (const char *p = fl_record_history(r); p && *p; p = strchr(p, '\n') + 1) {
        if (strncmp(p, STOPPED, strlen(STOPPED)) != 0) continue;
        p += strlen(STOPPED);
        snprintf(why, FL_RUN_END_TEXT, "%.*s", (int)strcspn(p, "\n"), p);
        return FL_RUN_STOPPED;
    }
    return r->reader->loads && has_line(lines, "#set ") && !has_line(lines, "#report steps ") ? FL_RUN_OPEN
                                                                                              : FL_RUN_ENDED;
}

const char *fl_record_name(const fl_record *r) { return fl_in_name(r->reader->table.text.in); }

void fl_record_close(fl_record *r)
{
    fl_record_reader *own = r->reader;
    if (own) {
        for (int32_t p = 0; p < own->parts; p++) free(own->part[p].name);
        free(own->part);
        free(own->raw);
        free(own->by_name);
        free(own->shown);
        free(own->label);
        free(own->has);
        free(own->x[0]);
        free(own->x[1]);
        fl_table_close(&own->table);
    }
    free(own);
    *r = (fl_record){0};
}
