/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/table.h"
#include "stat/peaks.h"
#include "stat/rainflow.h"
#include "stat/summary_file.h"

static const char *const SUM[] = {"time", "sum1", "sum2", "sum3", "sum4"};
static const char *const RUN[FL_RUN_VALUES] = {"run_mean", "run_std", "run_min", "run_max"};
enum { PART, SIGNAL, UNIT, ITEM, FROM, TO, COUNT, VALUE, EXACT, COLUMNS };
static const char *const COLUMN[COLUMNS] = {"part", "signal", "unit",  "item", "from",
                                            "to",   "count",  "value", "exact"};

/* --- writing -------------------------------------------------------------------------------------------- */

typedef struct {
    FILE *f;
    const fl_summary_signal *s; /* NULL for the settings */
} writer;

/* part, signal, unit, item; then from, to, count and value; NAN is printed as -. */
static void write_item(const writer *w, const char *item, double from, double to, double count, double value)
{
    const double x[] = {from, to, count, value};
    char buf[FL_NUMBER_LEN];
    if (w->s)
        fprintf(w->f, "%s\t%s\t%s\t%s", w->s->part, w->s->signal, w->s->unit[0] ? w->s->unit : "-", item);
    else fprintf(w->f, "-\t-\t-\t%s", item);
    for (int k = 0; k < 4; k++) fprintf(w->f, "\t%s", isnan(x[k]) ? "-" : fl_number_text(x[k], buf));
    putc('\t', w->f);
}

static void write_exact(const writer *w, const char *item, double from, double to, double count,
                        const fl_exact_sum *sum)
{
    write_item(w, item, from, to, count, fl_exact_value(sum));
    fl_exact_print(w->f, sum);
    putc('\n', w->f);
}

static int write_classes(const writer *w, const char *item, const fl_log_histogram *c, double unit, int timed,
                         fl_err *err)
{
    fl_log_bin *sorted;
    if (fl_log_histogram_sort(c, &sorted, err)) return -1;
    for (int32_t k = 0; k < c->n; k++) {
        const fl_log_bin *s = &sorted[k];
        write_item(w, item, fl_log_bin_lower(s->key), fl_log_bin_upper(s->key), unit * (double)s->n,
                   timed ? fl_fixed_time_seconds(s->time) : NAN);
        if (timed)
            fprintf(w->f, "%llu:%016llx\n", (unsigned long long)s->time.seconds,
                    (unsigned long long)s->time.part);
        else fputs("-\n", w->f);
    }
    free(sorted);
    return 0;
}

static void write_values(const writer *w, const char *item, const fl_multiset *v)
{
    for (int32_t k = 0; k < v->n; k++) {
        write_item(w, item, NAN, NAN, (double)v->v[k].count, v->v[k].x);
        fputs("-\n", w->f);
    }
}

int fl_summary_write(FILE *f, fl_summary *s, fl_err *err)
{
    writer w = {.f = f};
    fprintf(f, "#summary 1\n%s", s->history ? s->history : "");
    for (int k = 0; k < COLUMNS; k++) fprintf(f, "%s%c", COLUMN[k], k + 1 < COLUMNS ? '\t' : '\n');
    write_item(&w, "separation", NAN, NAN, NAN, s->settings.separation);
    fputs("-\n", f);
    write_item(&w, "threshold", NAN, NAN, NAN, s->settings.threshold);
    fputs("-\n", f);
    if (s->settings.side) {
        write_item(&w, "peaks", NAN, NAN, NAN, NAN);
        fprintf(f, "%s\n", fl_peak_side_name(s->settings.side));
    }
    write_item(&w, "block_length", NAN, NAN, NAN, s->settings.block);
    fputs("-\n", f);
    write_item(&w, "rule", NAN, NAN, NAN, NAN);
    fprintf(f, "%s\n", fl_rainflow_rule_name(s->settings.rule));
    write_item(&w, "residue", NAN, NAN, NAN, NAN);
    fprintf(f, "%s\n", fl_residue_name(s->settings.residue));
    for (int32_t i = 0; i < s->n; i++) {
        fl_summary_signal *t = &s->entry[i];
        w.s = t;
        fl_multiset_sort(&t->block);
        for (int k = 0; k < FL_RUN_VALUES; k++) fl_multiset_sort(&t->run[k]);
        write_exact(&w, SUM[0], t->from, t->to, (double)t->rows, &t->sum[0]);
        for (int k = 1; k < 5; k++) write_exact(&w, SUM[k], NAN, NAN, NAN, &t->sum[k]);
        write_item(&w, "min", t->t_min, t->t_min, NAN, t->min);
        fputs("-\n", f);
        write_item(&w, "max", t->t_max, t->t_max, NAN, t->max);
        fputs("-\n", f);
        write_exact(&w, "peaks", NAN, NAN, (double)t->peaks, &t->peak_sum);
        for (int k = 0; k < FL_RUN_VALUES; k++) write_values(&w, RUN[k], &t->run[k]);
        write_values(&w, "block", &t->block);
        if (write_classes(&w, "level", &t->level, 1.0, 1, err) ||
            write_classes(&w, "peak", &t->peak, 1.0, 0, err) ||
            write_classes(&w, "cycle", &t->cycle, 0.5, 0, err))
            return -1;
    }
    return 0;
}

/* --- reading -------------------------------------------------------------------------------------------- */

enum { SEPARATION = 1, THRESHOLD = 2, BLOCK_LENGTH = 4, RULE = 8, RESIDUE = 16, SETTINGS = 31 };

typedef struct {
    fl_table t;
    int32_t col[COLUMNS];
    fl_summary s;
    int settings;            /* bits of the settings read so far */
    fl_summary_signal *last; /* the signal of the row before */
    int items;               /* its items so far: time 1, sum1 2, ... sum4 16, min 32, max 64, peaks 128 */
} reader;

enum { MIN = 32, MAX = 64, PEAKS = 128, ITEMS = 255 };

static const char *word_of(const reader *r, int column) { return fl_table_word(&r->t, r->col[column]); }

static int read_number(reader *r, int column, double *x, fl_err *err)
{
    if (fl_table_f64(&r->t, r->col[column], x, err)) return -1;
    /* No bound: sums of fourth powers may be any double.  Only the exact sums are used. */
    return 0;
}

static int read_bounded(reader *r, int column, double *x, fl_err *err)
{
    if (read_number(r, column, x, err)) return -1;
    if (fabs(*x) <= 1e100) return 0;
    return fl_text_fail(&r->t.text, err, "%s is %g, expected at most 1e+100", COLUMN[column], *x);
}

/* Read a whole number of units, at least lo, small enough for a double to be exact. */
static int read_count(reader *r, double unit, int64_t lo, int64_t *n, fl_err *err)
{
    double x;
    if (read_number(r, COUNT, &x, err)) return -1;
    x /= unit;
    if (x >= (double)lo && x <= 0x1p53 && x == floor(x)) {
        *n = (int64_t)x;
        return 0;
    }
    return fl_text_fail(&r->t.text, err, "count is \"%.40s\", expected a whole number of %s, at least %g",
                        word_of(r, COUNT), unit < 1.0 ? "halves" : "rows", unit * (double)lo);
}

static int read_choice(reader *r, const char *(*name)(int), int n, int *k, fl_err *err)
{
    for (*k = 0; *k < n; ++*k)
        if (strcmp(word_of(r, EXACT), name(*k)) == 0) return 0;
    return fl_text_fail(&r->t.text, err, "%s is \"%.40s\", which is not known", word_of(r, ITEM),
                        word_of(r, EXACT));
}

static int read_setting(reader *r, fl_err *err)
{
    static const char *const name[] = {"separation", "threshold", "block_length", "rule", "residue", "peaks"};
    double *const to[] = {&r->s.settings.separation, &r->s.settings.threshold, &r->s.settings.block};
    int k = 0, rc;
    while (k < 6 && strcmp(word_of(r, ITEM), name[k]) != 0) k++;
    if (k == 6)
        return fl_text_fail(&r->t.text, err, "unknown setting %.60s, the nearest is %s", word_of(r, ITEM),
                            fl_text_nearest(word_of(r, ITEM), name, 6));
    if (r->settings & 1 << k || r->last)
        return fl_text_fail(&r->t.text, err, "%s is given twice, or below the first signal", name[k]);
    r->settings |= 1 << k;
    if (k == 3) return read_choice(r, fl_rainflow_rule_name, FL_RAINFLOW_RULES, &r->s.settings.rule, err);
    if (k == 4) return read_choice(r, fl_residue_name, FL_RESIDUES, &r->s.settings.residue, err);
    if (k == 5) return read_choice(r, fl_peak_side_name, FL_PEAK_SIDES, &r->s.settings.side, err);
    rc = read_bounded(r, VALUE, to[k], err);
    if (rc == 0 && !(*to[k] >= 0.0)) rc = fl_text_fail(&r->t.text, err, "%s is below 0", name[k]);
    return rc;
}

static int read_exact(reader *r, fl_exact_sum *sum, fl_err *err)
{
    fl_err why = {0};
    double value;
    if (read_number(r, VALUE, &value, err)) return -1;
    if (fl_exact_read(sum, word_of(r, EXACT), &why))
        return why.code == FL_INPUT ? fl_text_fail(&r->t.text, err, "%s", why.text)
                                    : fl_fail(err, why.code, "%s", why.text);
    if (fl_exact_value(sum) == value) return 0;
    return fl_text_fail(&r->t.text, err, "value is %g, the exact sum beside it %g", value,
                        fl_exact_value(sum));
}

static int read_time(reader *r, fl_fixed_time *time, fl_err *err)
{
    const char *text = word_of(r, EXACT), *colon = strchr(text, ':');
    char digits[32];
    uint64_t part = 0;
    const size_t n = colon ? (size_t)(colon - text) : sizeof digits;
    if (n < sizeof digits && strlen(colon) == 17 && strspn(colon + 1, "0123456789abcdef") == 16) {
        memcpy(digits, text, n);
        digits[n] = '\0';
        for (const char *p = colon + 1; *p; p++)
            part = part << 4 | (uint64_t)(*p <= '9' ? *p - '0' : *p - 'a' + 10);
        *time = (fl_fixed_time){0, part};
        if (fl_number_u64(digits, &time->seconds) == 0 && time->seconds < UINT64_C(1) << 62) return 0;
    }
    return fl_text_fail(&r->t.text, err,
                        "exact is \"%.40s\", expected a time SECONDS:PART of 16 hexadecimal digits", text);
}

static int read_class(reader *r, fl_log_histogram *c, double unit, int timed, fl_err *err)
{
    double from, to;
    fl_fixed_time time = {0, 0};
    int64_t n;
    if (read_bounded(r, FROM, &from, err) || read_bounded(r, TO, &to, err) || read_count(r, unit, 1, &n, err))
        return -1;
    const int32_t key = fl_log_bin_key(0.5 * from + 0.5 * to);
    if (fl_log_bin_lower(key) != from || fl_log_bin_upper(key) != to)
        return fl_text_fail(&r->t.text, err, "%.40s to %.40s is not a class of %s", word_of(r, FROM),
                            word_of(r, TO), word_of(r, ITEM));
    if (timed && read_time(r, &time, err)) return -1;
    return fl_log_histogram_add(c, key, n, time, err);
}

static int read_values(reader *r, fl_multiset *v, fl_err *err)
{
    double x;
    int64_t n;
    if (read_bounded(r, VALUE, &x, err) || read_count(r, 1.0, 1, &n, err)) return -1;
    return fl_multiset_add(v, x, n, err);
}

static int check_once(reader *r, int bit, fl_err *err)
{
    if (r->items & bit)
        return fl_text_fail(&r->t.text, err, "%s of %.60s is given twice", word_of(r, ITEM),
                            word_of(r, SIGNAL));
    r->items |= bit;
    return 0;
}

static int read_item(reader *r, fl_summary_signal *s, fl_err *err)
{
    const char *item = word_of(r, ITEM);
    for (int k = 0; k < 5; k++) {
        if (strcmp(item, SUM[k]) != 0) continue;
        if (check_once(r, 1 << k, err)) return -1;
        if (k == 0 && (read_bounded(r, FROM, &s->from, err) || read_bounded(r, TO, &s->to, err) ||
                       read_count(r, 1.0, 1, &s->rows, err)))
            return -1;
        return read_exact(r, &s->sum[k], err);
    }
    for (int k = 0; k < FL_RUN_VALUES; k++)
        if (strcmp(item, RUN[k]) == 0) return read_values(r, &s->run[k], err);
    if (strcmp(item, "block") == 0) return read_values(r, &s->block, err);
    if (strcmp(item, "level") == 0) return read_class(r, &s->level, 1.0, 1, err);
    if (strcmp(item, "peak") == 0) return read_class(r, &s->peak, 1.0, 0, err);
    if (strcmp(item, "cycle") == 0) return read_class(r, &s->cycle, 0.5, 0, err);
    if (strcmp(item, "min") == 0)
        return check_once(r, MIN, err) || read_bounded(r, FROM, &s->t_min, err) ||
                       read_bounded(r, VALUE, &s->min, err)
                   ? -1
                   : 0;
    if (strcmp(item, "max") == 0)
        return check_once(r, MAX, err) || read_bounded(r, FROM, &s->t_max, err) ||
                       read_bounded(r, VALUE, &s->max, err)
                   ? -1
                   : 0;
    if (strcmp(item, "peaks") == 0)
        return check_once(r, PEAKS, err) || read_count(r, 1.0, 0, &s->peaks, err)
                   ? -1
                   : read_exact(r, &s->peak_sum, err);
    return fl_text_fail(&r->t.text, err, "a summary has no item %.60s", item);
}

static int64_t count_values(const fl_log_histogram *c)
{
    int64_t n = 0;
    for (int32_t k = 0; k < c->cap; k++) n += c->slot[k].n;
    return n;
}

/* The rows of a signal are complete: check that they are consistent. */
static int check_signal(const reader *r, fl_err *err)
{
    const fl_summary_signal *s = r->last;
    const fl_text *t = &r->t.text;
    if (!s) return 0;
    if (r->items != ITEMS)
        return fl_text_fail(t, err,
                            "%.60s of %.60s is not complete, expected time, sum1 to sum4, min, max and peaks",
                            s->signal, s->part);
    if (!(s->from < s->to) || !(fl_exact_value(&s->sum[0]) > 0.0) || !(s->min <= s->max))
        return fl_text_fail(t, err, "%.60s of %.60s has no extent: from %g to %g s, from %g to %g", s->signal,
                            s->part, s->from, s->to, s->min, s->max);
    if (count_values(&s->level) != s->rows || count_values(&s->peak) != s->peaks)
        return fl_text_fail(t, err,
                            "%.60s of %.60s has %lld rows and %lld peaks, its classes hold other numbers",
                            s->signal, s->part, (long long)s->rows, (long long)s->peaks);
    for (int k = 0; k < FL_RUN_VALUES; k++) {
        const int64_t n = fl_multiset_size(&s->run[k]), runs = fl_multiset_size(&s->run[0]);
        if (n == 0 || n != runs)
            return fl_text_fail(t, err, "%.60s of %.60s has %lld values %s, of %lld runs", s->signal, s->part,
                                (long long)n, RUN[k], (long long)runs);
    }
    return 0;
}

static int read_row(reader *r, fl_err *err)
{
    const char *part = word_of(r, PART), *signal = word_of(r, SIGNAL), *unit = word_of(r, UNIT);
    if (strcmp(part, "-") == 0 && strcmp(signal, "-") == 0) return read_setting(r, err);
    if ((r->settings & SETTINGS) != SETTINGS)
        return fl_text_fail(&r->t.text, err,
                            "expected separation, threshold, block_length, rule and residue first");
    if (!r->last || strcmp(r->last->part, part) != 0 || strcmp(r->last->signal, signal) != 0) {
        const int32_t before = r->s.n;
        if (check_signal(r, err)) return -1;
        r->last = fl_summary_get_signal(&r->s, part, signal, strcmp(unit, "-") ? unit : "",
                                        fl_in_name(r->t.text.in), err);
        if (!r->last) return -1;
        if (r->s.n == before)
            return fl_text_fail(&r->t.text, err, "rows of %.60s of %.60s are not contiguous", signal, part);
        r->items = 0;
    }
    return read_item(r, r->last, err);
}

int fl_summary_read(fl_summary *s, const char *path, fl_err *err)
{
    reader r = {0};
    int more, rc = -1;
    if (fl_table_open(&r.t, path, "summary", 1, err)) goto done;
    for (int k = 0; k < COLUMNS; k++)
        if (fl_table_require(&r.t, COLUMN[k], &r.col[k], err)) goto done;
    while ((more = fl_table_row(&r.t, err)) > 0)
        if (read_row(&r, err)) goto done;
    if (more < 0 || check_signal(&r, err)) goto done;
    if (!r.last) {
        fl_text_fail(&r.t.text, err, "the summary ends here without a signal");
        goto done;
    }
    if (fl_summary_add_history(&r.s, r.t.text.history, err)) goto done;
    rc = fl_summary_merge(s, &r.s, fl_in_name(r.t.text.in), err);
done:
    fl_table_close(&r.t);
    fl_summary_free(&r.s);
    return rc;
}
