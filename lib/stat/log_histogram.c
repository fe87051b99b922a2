/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "stat/log_histogram.h"

/* The leading bits of a double are sign, 11 bits of exponent and the bits that divide an octave into
 * classes. */
enum { OCTAVE_BITS = 7, DROP = 52 - OCTAVE_BITS, FIRST_CAP = 64 };

fl_fixed_time fl_fixed_time_of(double t)
{
    const double whole = floor(t);
    return (fl_fixed_time){(uint64_t)whole, (uint64_t)ldexp(t - whole, 64)};
}

double fl_fixed_time_seconds(fl_fixed_time t) { return (double)t.seconds + ldexp((double)t.part, -64); }

fl_fixed_time fl_fixed_time_add(fl_fixed_time a, fl_fixed_time b)
{
    const uint64_t part = a.part + b.part;
    return (fl_fixed_time){a.seconds + b.seconds + (part < a.part), part};
}

int32_t fl_log_bin_key(double x)
{
    uint64_t bits;
    const double size = fabs(x);
    memcpy(&bits, &size, sizeof bits);
    const int32_t k = (int32_t)(bits >> DROP);
    return x < 0.0 ? -k : k; /* the class of 0 has no sign */
}

/* The k-th limit, counted outward from 0. */
static double class_limit(int32_t k)
{
    const uint64_t bits = (uint64_t)k << DROP;
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

double fl_log_bin_lower(int32_t key) { return key > 0 ? class_limit(key) : -class_limit(1 - key); }

double fl_log_bin_upper(int32_t key) { return key < 0 ? -class_limit(-key) : class_limit(key + 1); }

/* The slot of a class, or the empty slot for it.  Neighbouring classes are used together, so their slots may
 * be adjacent; the factor spreads the octaves. */
static fl_log_bin *find_slot(const fl_log_histogram *c, int32_t key)
{
    const uint32_t mask = (uint32_t)c->cap - 1;
    uint32_t at = (uint32_t)key * UINT32_C(2654435769);
    at = (at >> 15 ^ at) & mask;
    while (c->slot[at].n && c->slot[at].key != key) at = (at + 1) & mask;
    return &c->slot[at];
}

static int grow_table(fl_log_histogram *c, fl_err *err)
{
    fl_log_histogram next = {.cap = c->cap ? 2 * c->cap : FIRST_CAP};
    next.slot = fl_alloc(next.cap, sizeof *next.slot, err);
    if (!next.slot) return -1;
    for (int32_t k = 0; k < c->cap; k++)
        if (c->slot[k].n) *find_slot(&next, c->slot[k].key) = c->slot[k];
    next.n = c->n;
    free(c->slot);
    *c = next;
    return 0;
}

int fl_log_histogram_add(fl_log_histogram *c, int32_t key, int64_t n, fl_fixed_time time, fl_err *err)
{
    if (2 * c->n >= c->cap && grow_table(c, err)) return -1;
    fl_log_bin *s = find_slot(c, key);
    if (s->n == 0) {
        s->key = key;
        c->n++;
    }
    s->n += n;
    s->time = fl_fixed_time_add(s->time, time);
    return 0;
}

int fl_log_histogram_merge(fl_log_histogram *c, const fl_log_histogram *other, fl_err *err)
{
    for (int32_t k = 0; k < other->cap; k++) {
        const fl_log_bin *s = &other->slot[k];
        if (s->n && fl_log_histogram_add(c, s->key, s->n, s->time, err)) return -1;
    }
    return 0;
}

static int compare_keys(const void *a, const void *b)
{
    const fl_log_bin *p = a, *q = b;
    return (p->key > q->key) - (p->key < q->key);
}

int fl_log_histogram_sort(const fl_log_histogram *c, fl_log_bin **sorted, fl_err *err)
{
    int32_t n = 0;
    *sorted = fl_alloc(c->n, sizeof **sorted, err);
    if (!*sorted) return -1;
    for (int32_t k = 0; k < c->cap; k++)
        if (c->slot[k].n) (*sorted)[n++] = c->slot[k];
    qsort(*sorted, (size_t)n, sizeof **sorted, compare_keys);
    return 0;
}

static double value_in_class(int32_t key, double f, double lo, double hi)
{
    const double a = fl_log_bin_lower(key), b = fl_log_bin_upper(key);
    if (key == 0) return fmin(fmax(0.0, lo), hi);
    return fmin(fmax(a + f * (b - a), lo), hi);
}

double fl_log_histogram_quantile(int32_t n, const fl_log_bin *sorted, double p, double lo, double hi)
{
    double total = 0.0, before = 0.0;
    for (int32_t k = 0; k < n; k++) total += fl_fixed_time_seconds(sorted[k].time);
    if (p <= 0.0) return lo;
    if (p >= 1.0) return hi;
    for (int32_t k = 0; k < n; k++) {
        const double time = fl_fixed_time_seconds(sorted[k].time);
        if (before + time >= p * total && time > 0.0)
            return value_in_class(sorted[k].key, (p * total - before) / time, lo, hi);
        before += time;
    }
    return hi;
}

double fl_log_histogram_mean_highest(int32_t n, const fl_log_bin *sorted, double share, double lo, double hi)
{
    double all = 0.0, sum = 0.0;
    for (int32_t k = 0; k < n; k++) all += (double)sorted[k].n;
    const double want = fmin(fmax(share * all, 1.0), all);
    double left = want;
    for (int32_t k = n - 1; k >= 0 && left > 0.0; k--) {
        const double take = fmin(left, (double)sorted[k].n);
        sum += take * value_in_class(sorted[k].key, 0.5, lo, hi);
        left -= take;
    }
    return sum / want;
}

void fl_log_histogram_free(fl_log_histogram *c)
{
    free(c->slot);
    *c = (fl_log_histogram){0};
}
