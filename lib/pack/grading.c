/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack/grading.h"
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/table.h"

enum { BODIES_MAX = 1 << 27 };

/* Largest and smallest sizes [m], as coordinates of g-polys(5). */
static const double SIZE_MOST = 1e9, SIZE_LEAST = 1e-9;

/* --- integrals of powers ------------------------------------------------------------------------ */

/* int_a^b x^(p - 1) dx, 0 < a <= b. */
static double power_integral(double p, double a, double b)
{
    return p == 0.0 ? log(b / a) : (pow(b, p) - pow(a, p)) / p;
}

/* x at which the integral from a is the fraction u of that to b. */
static double power_inverse(double p, double a, double b, double u)
{
    if (p == 0.0) return a * pow(b / a, u);
    return a * pow(1.0 + u * (pow(b / a, p) - 1.0), 1.0 / p);
}

/* Number of bodies of a piece per v and solid volume. */
static double piece_number(const fl_grading_piece *p, int dim)
{
    if (p->lo == p->hi) return p->share / pow(p->lo, dim);
    return p->share * power_integral(p->m - dim, p->lo, p->hi) / power_integral(p->m, p->lo, p->hi);
}

/* Part of the piece up to d, of an integral with the exponent p. */
static double piece_part(const fl_grading_piece *q, double p, double d)
{
    if (d >= q->hi) return 1.0;
    if (d < q->lo || q->lo == q->hi) return 0.0;
    return power_integral(p, q->lo, d) / power_integral(p, q->lo, q->hi);
}

double fl_grading_number(const fl_grading *g, int dim)
{
    double sum = 0.0;
    for (int32_t k = 0; k < g->pieces; k++) sum += piece_number(&g->piece[k], dim);
    for (int32_t k = 0; k < g->n; k++) sum += pow(g->size[k], dim);
    return g->n ? g->n / sum : sum;
}

double fl_grading_mass(const fl_grading *g, int dim, double d)
{
    double sum = 0.0, all = 0.0;
    for (int32_t k = 0; k < g->pieces; k++)
        sum += g->piece[k].share * piece_part(&g->piece[k], g->piece[k].m, d);
    for (int32_t k = 0; k < g->n; k++) {
        const double v = pow(g->size[k], dim);
        all += v;
        if (g->size[k] <= d) sum += v;
    }
    return g->n ? sum / all : sum;
}

double fl_grading_count(const fl_grading *g, int dim, double d)
{
    double sum = 0.0;
    if (g->n) {
        for (int32_t k = 0; k < g->n; k++) sum += g->size[k] <= d;
        return sum / g->n;
    }
    for (int32_t k = 0; k < g->pieces; k++)
        sum += piece_number(&g->piece[k], dim) * piece_part(&g->piece[k], g->piece[k].m - dim, d);
    return sum / fl_grading_number(g, dim);
}

double fl_grading_quantile(const fl_grading *g, int dim, double u)
{
    double left = u * fl_grading_number(g, dim);
    for (int32_t k = 0; k < g->pieces; k++) {
        const fl_grading_piece *p = &g->piece[k];
        const double n = piece_number(p, dim);
        if (left <= n) return power_inverse(p->m - dim, p->lo, p->hi, left / n);
        left -= n;
    }
    return fl_grading_most(g);
}

double fl_grading_least(const fl_grading *g)
{
    double d = INFINITY;
    for (int32_t k = 0; k < g->pieces; k++)
        if (g->piece[k].share > 0.0) d = fmin(d, g->piece[k].lo);
    for (int32_t k = 0; k < g->n; k++) d = fmin(d, g->size[k]);
    return d;
}

double fl_grading_most(const fl_grading *g)
{
    double d = 0.0;
    for (int32_t k = 0; k < g->pieces; k++)
        if (g->piece[k].share > 0.0) d = fmax(d, g->piece[k].hi);
    for (int32_t k = 0; k < g->n; k++) d = fmax(d, g->size[k]);
    return d;
}

/* --- the draw ----------------------------------------------------------------------------------- */

static int by_falling_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* Appends n sizes of piece p, stratified.  Returns the sum of d^D. */
static double draw_piece(const fl_grading_piece *p, int dim, double *size, int32_t n)
{
    double sum = 0.0;
    for (int32_t k = 0; k < n; k++) {
        size[k] = power_inverse(p->m - dim, p->lo, p->hi, (k + 0.5) / n);
        sum += pow(size[k], dim);
    }
    return sum;
}

static int draw_curve(const fl_grading *g, int dim, double volume, double **size, int32_t *n, int32_t *empty,
                      fl_err *err)
{
    double carried = 0.0;
    int32_t cap = 0, last = 0;
    *n = *empty = 0;
    for (int32_t k = g->pieces - 1; k >= 0; k--) {
        const fl_grading_piece *p = &g->piece[k];
        const double want = volume * p->share + carried, each = p->share / piece_number(p, dim);
        if (!(p->share > 0.0)) continue;
        const double count = floor(want / each + 0.5);
        if (count > BODIES_MAX - *n)
            return fl_fail(err, FL_INPUT, "the grading needs %.3g bodies, %d at most are expected", count,
                           BODIES_MAX);
        if (count < 1.0) {
            carried = want;
            ++*empty;
            continue;
        }
        if (fl_grow(size, &cap, *n + (int64_t)count, sizeof **size, err)) return -1;
        last = *n;
        *n += (int32_t)count;
        carried = want - draw_piece(p, dim, *size + last, *n - last);
    }
    if (*n == 0)
        return fl_fail(err, FL_INPUT, "the solid volume is less than half a body of %g m",
                       fl_grading_least(g));
    /* The finest piece takes the rest. */
    double sum = 0.0;
    for (int32_t k = last; k < *n; k++) sum += pow((*size)[k], dim);
    const double scale = pow(fmax((sum + carried) / sum, 0.01), 1.0 / dim);
    for (int32_t k = last; k < *n; k++) (*size)[k] *= scale;
    return 0;
}

int fl_grading_draw(const fl_grading *g, int dim, double v, double volume, int32_t number, double **size,
                    int32_t *n, int32_t *empty, fl_err *err)
{
    *size = NULL;
    *n = *empty = 0;
    if (g->n || number > 0) {
        *n = g->n ? g->n : number;
        if (!(*size = fl_alloc(*n, sizeof **size, err))) return -1;
        for (int32_t k = 0; k < *n; k++)
            (*size)[k] = g->n ? g->size[k] : fl_grading_quantile(g, dim, (k + 0.5) / *n);
    } else if (draw_curve(g, dim, volume / v, size, n, empty, err)) {
        free(*size);
        *size = NULL;
        return -1;
    }
    qsort(*size, (size_t)*n, sizeof **size, by_falling_size);
    return 0;
}

/* --- laws --------------------------------------------------------------------------------------- */

static int add_piece(fl_grading *g, double lo, double hi, double share, double m, fl_err *err)
{
    if (fl_grow(&g->piece, &g->piece_cap, (int64_t)g->pieces + 1, sizeof *g->piece, err)) return -1;
    g->piece[g->pieces++] = (fl_grading_piece){lo, hi, share, m};
    return 0;
}

/* Numbers divided by commas; *word: a word after them, or NULL. */
static int split_numbers(const char *text, double *x, int most, char word[16])
{
    int n = 0;
    word[0] = '\0';
    while (*text) {
        char field[64];
        const size_t len = strcspn(text, ",");
        if (len == 0 || len >= sizeof field) return -1;
        memcpy(field, text, len);
        field[len] = '\0';
        if (n < most && fl_number_f64(field, &x[n]) == 0) n++;
        else if (text[len] == '\0' && len < 16 && n > 0) memcpy(word, field, len + 1);
        else return -1;
        text += len;
        if (*text == ',' && *++text == '\0') return -1;
    }
    return n;
}

static int is_size(double d) { return d >= SIZE_LEAST && d <= SIZE_MOST; }

int fl_grading_law(fl_grading *g, const char *text, int dim, fl_err *err)
{
    static const struct {
        const char *name;
        int numbers;
        const char *expected;
    } LAW[] = {{"uniform:", 2, "uniform:A,B or uniform:A,B,number with 0 < A < B"},
               {"fuller:", 3, "fuller:N,A,B with N above 0 and 0 < A < B"},
               {"single:", 1, "single:D with D above 0"}};
    for (int k = 0; k < 3; k++) {
        double x[3] = {0};
        char word[16];
        const size_t len = strlen(LAW[k].name);
        if (strncmp(text, LAW[k].name, len) != 0) continue;
        const int n = split_numbers(text + len, x, 3, word), by_number = strcmp(word, "number") == 0;
        const double *d = &x[k == 1];
        const int good = n == LAW[k].numbers &&
                         (!word[0] || (k == 0 && (by_number || !strcmp(word, "mass")))) && is_size(d[0]) &&
                         (k == 2 || (is_size(d[1]) && d[0] < d[1])) &&
                         (k != 1 || (x[0] > 0.0 && x[0] <= 10.0));
        if (!good)
            return fl_fail(err, FL_USAGE, "--grading is \"%.60s\", expected %s, sizes in m", text,
                           LAW[k].expected);
        const double m = k == 1 ? x[0] : by_number ? dim + 1.0 : 1.0;
        return add_piece(g, d[0], k == 2 ? d[0] : d[1], 1.0, m, err) ? -1 : 1;
    }
    return 0;
}

/* --- files -------------------------------------------------------------------------------------- */

static int read_size(const fl_table *t, int32_t column, double *d, fl_err *err)
{
    if (fl_table_f64(t, column, d, err)) return -1;
    if (is_size(*d)) return 0;
    return fl_text_fail(&t->text, err, "size %g m found, %g to %g m are expected", *d, SIZE_LEAST, SIZE_MOST);
}

static int read_list(fl_grading *g, fl_table *t, int32_t column, fl_err *err)
{
    int more;
    while ((more = fl_table_row(t, err)) > 0) {
        if (g->n == BODIES_MAX) return fl_text_fail(&t->text, err, "more than %d sizes", BODIES_MAX);
        if (fl_grow(&g->size, &g->size_cap, (int64_t)g->n + 1, sizeof *g->size, err) ||
            read_size(t, column, &g->size[g->n], err))
            return -1;
        g->n++;
    }
    if (more < 0) return -1;
    return g->n ? 0 : fl_text_fail(&t->text, err, "the file ends without a size, one is expected");
}

static int read_curve(fl_grading *g, fl_table *t, int32_t column, int32_t passing, int linear, fl_err *err)
{
    const double all = strcmp(t->unit[passing], "%") == 0 ? 100.0 : 1.0;
    double last = 0.0, before = 0.0, d, p;
    int more, rows = 0;
    while ((more = fl_table_row(t, err)) > 0) {
        if (read_size(t, column, &d, err) || fl_table_f64(t, passing, &p, err)) return -1;
        p /= all;
        if (!(p >= 0.0 && p <= 1.0))
            return fl_text_fail(&t->text, err, "passing %g found, 0 to %g is expected", p * all, all);
        if (rows && !(d > last))
            return fl_text_fail(&t->text, err, "sieve %g m does not follow %g m, rising sizes are expected",
                                d, last);
        if (rows && p < before)
            return fl_text_fail(&t->text, err, "passing decreases from %g to %g, a rising curve is expected",
                                before * all, p * all);
        if (!rows && p > 0.0)
            return fl_text_fail(
                &t->text, err, "%g passes the first sieve, 0 is expected: the curve begins at the least size",
                p * all);
        if (rows++ && p > before && add_piece(g, last, d, p - before, linear ? 1.0 : 0.0, err)) return -1;
        last = d;
        before = p;
    }
    if (more < 0) return -1;
    if (rows < 2) return fl_text_fail(&t->text, err, "%d sieves found, two at least are expected", rows);
    if (fabs(before - 1.0) > 1e-9)
        return fl_text_fail(&t->text, err, "the curve ends at %g, %g is expected", before * all, all);
    return 0;
}

int fl_grading_read(fl_grading *g, const char *path, int linear, fl_err *err)
{
    fl_table t = {0};
    int32_t column, passing;
    int rc = fl_table_open(&t, path, "grading", 1, err);
    if (rc == 0) rc = fl_table_require(&t, "d", &column, err);
    if (rc == 0) {
        passing = fl_table_column(&t, "passing");
        rc = passing < 0 ? read_list(g, &t, column, err) : read_curve(g, &t, column, passing, linear, err);
    }
    if (rc) fl_grading_free(g);
    fl_table_close(&t);
    return rc;
}

void fl_grading_free(fl_grading *g)
{
    free(g->piece), free(g->size);
    *g = (fl_grading){0};
}
