/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/rng.h"
#include "base/text.h"
#include "ice/thickness.h"

/* Bounds of thicknesses and counts [m, 1]. */
#define SMALLEST 1e-6
#define LARGEST 1e6

enum { TRIES = 1000 };

/* --- reading -------------------------------------------------------------------------------------------- */

static int parse_two(const char *text, double *a, double *b)
{
    char word[64];
    const char *comma = strchr(text, ',');
    const size_t len = comma ? (size_t)(comma - text) : sizeof word;
    if (len >= sizeof word) return -1;
    memcpy(word, text, len);
    word[len] = '\0';
    return fl_number_f64(word, a) || fl_number_f64(comma + 1, b) ? -1 : 0;
}

static int is_in_range(double h) { return h >= SMALLEST && h <= LARGEST; }

int fl_thickness_parse(fl_thickness *out, const char *text, fl_err *err)
{
    fl_thickness t = {0};
    if (fl_number_f64(text, &t.a) == 0) {
        if (!is_in_range(t.a))
            return fl_fail(err, FL_USAGE, "a thickness of %g m found, one from %g to %g is expected", t.a,
                           SMALLEST, LARGEST);
    } else if (strncmp(text, "uniform:", 8) == 0) {
        t.kind = FL_THICKNESS_UNIFORM;
        if (parse_two(text + 8, &t.a, &t.b) || !is_in_range(t.a) || !is_in_range(t.b) || !(t.a < t.b))
            return fl_fail(err, FL_USAGE, "\"%.60s\" found, uniform:A,B with A below B is expected", text);
    } else if (strncmp(text, "lognormal:", 10) == 0) {
        t.kind = FL_THICKNESS_LOGNORMAL;
        if (parse_two(text + 10, &t.a, &t.b) || !is_in_range(t.a) || !(t.b > 0.0 && t.b <= 100.0))
            return fl_fail(err, FL_USAGE, "\"%.60s\" found, lognormal:MEAN,CV with both above 0 is expected",
                           text);
    } else if (strcspn(text, ":") < strcspn(text, "/")) {
        return fl_fail(err, FL_USAGE,
                       "\"%.60s\" found, a length, uniform:A,B, lognormal:MEAN,CV or a file is expected",
                       text);
    } else {
        return fl_thickness_read(out, text, err);
    }
    *out = t;
    return 0;
}

struct row {
    double h, count;
};

static int by_thickness(const void *a, const void *b)
{
    const struct row *x = a, *y = b;
    if (x->h != y->h) return (x->h > y->h) - (x->h < y->h);
    return (x->count > y->count) - (x->count < y->count);
}

static int read_positive(fl_text *in, const char *what, double *x, fl_err *err)
{
    if (fl_text_f64(in, what, x, err)) return -1;
    if (is_in_range(*x)) return 0;
    return fl_text_fail(in, err, "%s %g found, one from %g to %g is expected", what, *x, SMALLEST, LARGEST);
}

static int read_rows(fl_text *in, struct row **row, int32_t *n, fl_err *err)
{
    int32_t cap = 0, rows = 0;
    int more, counted = -1;
    while ((more = fl_text_row(in, err)) > 0) {
        struct row r = {0.0, 1.0};
        if (rows++ == 0 && strcmp(in->field[0], "h[m]") == 0 &&
            (in->n == 1 || (in->n == 2 && strcmp(in->field[1], "count") == 0))) {
            counted = in->n == 2;
            continue;
        }
        if (counted < 0) counted = in->n > 1;
        if (read_positive(in, "thickness", &r.h, err) ||
            (counted && read_positive(in, "count", &r.count, err)) || fl_text_no_more(in, err) ||
            fl_grow(row, &cap, (int64_t)*n + 1, sizeof **row, err))
            return -1;
        (*row)[(*n)++] = r;
    }
    if (more < 0) return -1;
    return *n ? 0 : fl_text_fail(in, err, "the file ends without a thickness, one a row is expected");
}

int fl_thickness_read(fl_thickness *out, const char *path, fl_err *err)
{
    fl_thickness t = {.kind = FL_THICKNESS_TABLE};
    fl_text in = {0};
    struct row *row = NULL;
    int32_t n = 0;
    int rc = -1;
    if (fl_text_open(&in, path, err) || read_rows(&in, &row, &n, err)) goto done;
    t.h = fl_alloc(n, sizeof *t.h, err);
    t.p = fl_alloc((int64_t)n + 1, sizeof *t.p, err);
    if (!t.h || !t.p) goto done;
    qsort(row, (size_t)n, sizeof *row, by_thickness);
    for (int32_t k = 0; k < n; k++) {
        if (t.n == 0 || row[k].h > t.h[t.n - 1]) {
            t.h[t.n] = row[k].h;
            t.p[t.n + 1] = t.p[t.n];
            t.n++;
        }
        t.p[t.n] += row[k].count;
    }
    for (int32_t k = 0; k < t.n; k++) t.p[k] /= t.p[t.n];
    t.p[t.n] = 1.0;
    *out = t;
    t = (fl_thickness){0};
    rc = 0;
done:
    fl_thickness_free(&t);
    free(row);
    fl_text_close(&in);
    return rc;
}

/* --- the law -------------------------------------------------------------------------------------------- */

/* Mean m and standard deviation s of ln h:  exp(m + s^2/2) = mean,  exp(s^2) - 1 = cv^2. */
static void log_moments(const fl_thickness *t, double *m, double *s)
{
    *s = sqrt(log1p(t->b * t->b));
    *m = log(t->a) - 0.5 * *s * *s;
}

static double draw_one(const fl_thickness *t, fl_rng *g)
{
    double m, s;
    if (t->kind == FL_THICKNESS_UNIFORM) return fl_rng_in(g, t->a, t->b);
    if (t->kind == FL_THICKNESS_LOGNORMAL) {
        log_moments(t, &m, &s);
        return exp(m + s * fl_rng_normal(g));
    }
    if (t->kind == FL_THICKNESS_TABLE) {
        const double u = fl_rng_unit(g);
        int32_t lo = 0, hi = t->n;
        while (hi - lo > 1) {
            const int32_t mid = lo + (hi - lo) / 2;
            if (t->p[mid] <= u) lo = mid;
            else hi = mid;
        }
        return t->h[lo];
    }
    return t->a;
}

double fl_thickness_draw(const fl_thickness *t, uint64_t seed, int32_t id, double least, int32_t *again)
{
    fl_rng g = fl_rng_of(seed, id, FL_RNG_THICKNESS);
    for (*again = 0; *again < TRIES; ++*again) {
        const double h = draw_one(t, &g);
        if (h > least) return h;
        if (t->kind == FL_THICKNESS_CONSTANT) break;
    }
    return 0.0;
}

/* Cumulative distribution of the whole law; `with`: h itself counts, which matters where the law has
 * jumps. */
static double cdf_of(const fl_thickness *t, double h, int with)
{
    double m, s;
    if (t->kind == FL_THICKNESS_UNIFORM) return fmin(1.0, fmax(0.0, (h - t->a) / (t->b - t->a)));
    if (t->kind == FL_THICKNESS_LOGNORMAL) {
        if (!(h > 0.0)) return 0.0;
        log_moments(t, &m, &s);
        return 0.5 * erfc((m - log(h)) / (s * sqrt(2.0)));
    }
    if (t->kind == FL_THICKNESS_TABLE) {
        int32_t k = 0, hi = t->n; /* number of thicknesses below h, or not above it */
        while (k < hi) {
            const int32_t mid = k + (hi - k) / 2;
            if (t->h[mid] < h || (with && t->h[mid] == h)) k = mid + 1;
            else hi = mid;
        }
        return t->p[k];
    }
    return h > t->a || (with && h == t->a) ? 1.0 : 0.0;
}

static double conditional_cdf(const fl_thickness *t, double least, double h, int with)
{
    const double none = cdf_of(t, least, 1);
    return h <= least || !(none < 1.0) ? 0.0 : (cdf_of(t, h, with) - none) / (1.0 - none);
}

double fl_thickness_cdf(const fl_thickness *t, double least, double h)
{
    return conditional_cdf(t, least, h, 1);
}

double fl_thickness_ks_distance(const fl_thickness *t, double least, int32_t n, const double *h)
{
    double worst = 0.0;
    for (int32_t from = 0, to; from < n; from = to) {
        for (to = from + 1; to < n && h[to] == h[from]; to++) {}
        worst = fmax(worst, fabs((double)from / n - conditional_cdf(t, least, h[from], 0)));
        worst = fmax(worst, fabs((double)to / n - conditional_cdf(t, least, h[from], 1)));
    }
    return worst;
}

void fl_thickness_free(fl_thickness *t)
{
    free(t->h);
    free(t->p);
    *t = (fl_thickness){0};
}
