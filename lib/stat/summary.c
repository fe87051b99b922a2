/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "stat/peaks.h"
#include "stat/summary.h"

int fl_multiset_add(fl_multiset *v, double x, int64_t count, fl_err *err)
{
    if (v->n && v->v[v->n - 1].x == x) {
        v->v[v->n - 1].count += count;
        return 0;
    }
    if (fl_grow(&v->v, &v->cap, (int64_t)v->n + 1, sizeof *v->v, err)) return -1;
    v->v[v->n++] = (fl_multiset_entry){x, count};
    return 0;
}

static int compare_entries(const void *a, const void *b)
{
    const fl_multiset_entry *p = a, *q = b;
    return (p->x > q->x) - (p->x < q->x);
}

void fl_multiset_sort(fl_multiset *v)
{
    int32_t n = 0;
    if (v->n) qsort(v->v, (size_t)v->n, sizeof *v->v, compare_entries);
    for (int32_t k = 0; k < v->n; k++) {
        if (n && v->v[n - 1].x == v->v[k].x) v->v[n - 1].count += v->v[k].count;
        else v->v[n++] = v->v[k];
    }
    v->n = n;
}

int64_t fl_multiset_size(const fl_multiset *v)
{
    int64_t n = 0;
    for (int32_t k = 0; k < v->n; k++) n += v->v[k].count;
    return n;
}

static int add_values(fl_multiset *v, const fl_multiset *other, fl_err *err)
{
    for (int32_t k = 0; k < other->n; k++)
        if (fl_multiset_add(v, other->v[k].x, other->v[k].count, err)) return -1;
    return 0;
}

/* --- signals -------------------------------------------------------------------------------------------- */

/* Components of force in their usual order, then the others in alphabetical order. */
static int compare_signals(const char *a, const char *b)
{
    static const char *const known[] = {"fx", "fy", "fz", "fh", "f", "mx", "my", "mz", "mh"};
    enum { KNOWN = sizeof known / sizeof *known };
    int i = 0, j = 0;
    while (i < KNOWN && strcmp(a, known[i]) != 0) i++;
    while (j < KNOWN && strcmp(b, known[j]) != 0) j++;
    return i != j ? i - j : strcmp(a, b);
}

static int compare_parts(const char *a, const char *b)
{
    const int ta = strcmp(a, "total") == 0, tb = strcmp(b, "total") == 0;
    return ta != tb ? ta - tb : strcmp(a, b);
}

static void clear_signal(fl_summary_signal *s)
{
    char *const part = s->part, *const signal = s->signal, *const unit = s->unit;
    for (int k = 0; k < 5; k++) fl_exact_free(&s->sum[k]);
    fl_exact_free(&s->peak_sum);
    fl_log_histogram_free(&s->level);
    fl_log_histogram_free(&s->peak);
    fl_log_histogram_free(&s->cycle);
    free(s->block.v);
    for (int k = 0; k < FL_RUN_VALUES; k++) free(s->run[k].v);
    *s = (fl_summary_signal){.part = part, .signal = signal, .unit = unit};
}

static void free_signal(fl_summary_signal *s)
{
    clear_signal(s);
    free(s->part);
    free(s->signal);
    free(s->unit);
    *s = (fl_summary_signal){0};
}

fl_summary_signal *fl_summary_get_signal(fl_summary *s, const char *part, const char *signal,
                                         const char *unit, const char *name, fl_err *err)
{
    int32_t lo = 0, hi = s->n; /* entries before lo sort earlier, entries from hi on do not */
    while (lo < hi) {
        const int32_t k = lo + (hi - lo) / 2;
        const int c = compare_parts(s->entry[k].part, part);
        if (c < 0 || (c == 0 && compare_signals(s->entry[k].signal, signal) < 0)) lo = k + 1;
        else hi = k;
    }
    if (lo < s->n && strcmp(s->entry[lo].part, part) == 0 && strcmp(s->entry[lo].signal, signal) == 0) {
        if (strcmp(s->entry[lo].unit, unit) == 0) return &s->entry[lo];
        fl_fail(err, FL_INPUT, "%s: %.60s of %.60s is in \"%.20s\", in another run it was in \"%.20s\"", name,
                signal, part, unit, s->entry[lo].unit);
        return NULL;
    }
    fl_summary_signal new = {.part = fl_alloc_text(part, err)};
    new.signal = new.part ? fl_alloc_text(signal, err) : NULL;
    new.unit = new.signal ? fl_alloc_text(unit, err) : NULL;
    if (!new.unit || fl_grow(&s->entry, &s->cap, (int64_t)s->n + 1, sizeof *s->entry, err)) {
        free_signal(&new);
        return NULL;
    }
    memmove(s->entry + lo + 1, s->entry + lo, (size_t)(s->n - lo) * sizeof *s->entry);
    s->entry[lo] = new;
    s->n++;
    return &s->entry[lo];
}

static int merge_signal(fl_summary_signal *s, const fl_summary_signal *t, fl_err *err)
{
    const int first = s->rows == 0;
    if (first || t->from < s->from) s->from = t->from;
    if (first || t->to > s->to) s->to = t->to;
    if (first || t->min < s->min || (t->min == s->min && t->t_min < s->t_min)) {
        s->min = t->min;
        s->t_min = t->t_min;
    }
    if (first || t->max > s->max || (t->max == s->max && t->t_max < s->t_max)) {
        s->max = t->max;
        s->t_max = t->t_max;
    }
    s->rows += t->rows;
    s->peaks += t->peaks;
    for (int k = 0; k < 5; k++)
        if (fl_exact_merge(&s->sum[k], &t->sum[k], err)) return -1;
    for (int k = 0; k < FL_RUN_VALUES; k++)
        if (add_values(&s->run[k], &t->run[k], err)) return -1;
    if (fl_exact_merge(&s->peak_sum, &t->peak_sum, err) ||
        fl_log_histogram_merge(&s->level, &t->level, err) ||
        fl_log_histogram_merge(&s->peak, &t->peak, err) || fl_log_histogram_merge(&s->cycle, &t->cycle, err))
        return -1;
    return add_values(&s->block, &t->block, err);
}

int fl_summary_copy_signal(fl_summary_signal *to, const fl_summary_signal *from, fl_err *err)
{
    clear_signal(to);
    return merge_signal(to, from, err);
}

/* --- history -------------------------------------------------------------------------------------------- */

/* The end of the chain that begins at text: behind the line of a summary, or behind all lines. */
static const char *chain_end(const char *text)
{
    while (*text) {
        const char *line = text, *end = strchr(line, '\n');
        text = end ? end + 1 : line + strlen(line);
        const char *mark = strstr(line, " --summary");
        if (mark && mark < text) break;
    }
    return text;
}

/* Insert one chain into the sorted chains unless it is present. */
static int insert_chain(fl_summary *s, const char *chain, size_t len, fl_err *err)
{
    const char *at = s->history ? s->history : "";
    while (*at) {
        const char *end = chain_end(at);
        const size_t n = (size_t)(end - at), less = n < len ? n : len;
        const int c = memcmp(at, chain, less);
        if (c == 0 && n == len) return 0;
        if (c > 0 || (c == 0 && n > len)) break;
        at = end;
    }
    const size_t before = s->history ? (size_t)(at - s->history) : 0, after = strlen(at);
    char *all = fl_alloc((int64_t)(before + len + after) + 1, 1, err);
    if (!all) return -1;
    if (before) memcpy(all, s->history, before);
    memcpy(all + before, chain, len);
    memcpy(all + before + len, at, after);
    free(s->history);
    s->history = all;
    return 0;
}

int fl_summary_add_history(fl_summary *s, const char *lines, fl_err *err)
{
    while (lines && *lines) {
        const char *end = chain_end(lines);
        if (insert_chain(s, lines, (size_t)(end - lines), err)) return -1;
        lines = end;
    }
    return 0;
}

/* --- merge ---------------------------------------------------------------------------------------------- */

static int check_settings(const fl_summary_settings *a, const fl_summary_settings *b, const char *name,
                          fl_err *err)
{
    static const char what[] = "%s: its %s %g, that of the other runs %g: they do not add up";
    if (a->separation != b->separation)
        return fl_fail(err, FL_INPUT, what, name, "separation of peaks is", b->separation, a->separation);
    if (a->threshold != b->threshold)
        return fl_fail(err, FL_INPUT, what, name, "threshold of peaks is", b->threshold, a->threshold);
    if (a->side != b->side)
        return fl_fail(err, FL_INPUT,
                       "%s: its peaks are those of %s, those of the other runs of %s: they do not add up",
                       name, fl_peak_side_name(b->side), fl_peak_side_name(a->side));
    if (a->block != b->block)
        return fl_fail(err, FL_INPUT, what, name, "length of blocks is", b->block, a->block);
    if (a->rule != b->rule || a->residue != b->residue)
        return fl_fail(err, FL_INPUT,
                       "%s: its cycles are counted by another rule than those of the other runs", name);
    return 0;
}

int fl_summary_merge(fl_summary *s, const fl_summary *other, const char *name, fl_err *err)
{
    if (other->n == 0) return 0;
    if (s->n == 0) s->settings = other->settings;
    if (check_settings(&s->settings, &other->settings, name, err)) return -1;
    for (int32_t k = 0; k < other->n; k++) {
        const fl_summary_signal *t = &other->entry[k];
        fl_summary_signal *to = fl_summary_get_signal(s, t->part, t->signal, t->unit, name, err);
        if (!to || merge_signal(to, t, err)) return -1;
    }
    return fl_summary_add_history(s, other->history, err);
}

void fl_summary_moments(const fl_summary_signal *s, double out[4]) { fl_exact_moments(s->sum, out); }

void fl_summary_free(fl_summary *s)
{
    for (int32_t k = 0; k < s->n; k++) free_signal(&s->entry[k]);
    free(s->entry);
    free(s->history);
    *s = (fl_summary){0};
}
