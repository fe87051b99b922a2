/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "table_overview.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "stat/integral_time.h"
#include "table_fits.h"

/* A factor to kN, kN.m or kPa, and the unit; other units as they are. */
static double factor_of(const char *unit, char text[64])
{
    const int force = strcmp(unit, "N") == 0 || strcmp(unit, "N.m") == 0 || strcmp(unit, "Pa") == 0;
    snprintf(text, 64, "%s%.60s", force ? "k" : "", unit[0] ? unit : "-");
    return force ? 1e-3 : 1.0;
}

/* Below this part of the largest magnitude of a signal, its sixth digit, a value is printed as 0: a smallest
 * force of -4 mN beside a largest of 165 kN is no side on which the load acts. */
static const double ROUNDING = 1e-6;

static double without_rounding(double x, double largest) { return fabs(x) < ROUNDING * largest ? 0.0 : x; }

static void write_six(FILE *f, double x)
{
    if (isfinite(x)) fprintf(f, "\t%.6g", x == 0.0 ? 0.0 : x);
    else fputs("\t-", f);
}

/* The view with the peaks of its negative.  0, or -1 with FL_SYSTEM; y and peaks are to be freed either
 * way. */
static int turn_view(fl_signal_view *turned, const fl_signal_view *v, const struct options *o, double **y,
                     fl_err *err)
{
    *turned = *v;
    turned->peaks = (fl_peaks){0};
    *y = fl_alloc(v->n, sizeof **y, err);
    if (!*y) return -1;
    for (int32_t k = 0; k < v->n; k++) (*y)[k] = -v->x[k];
    turned->y = *y;
    return fl_peaks_rayleigh(v->n, *y, o->separation, fmax(0.0, o->threshold), &turned->peaks, err);
}

/* The level on the side of the larger magnitude, unless --peaks says which; in the sign of the signal. */
static int make_level(best_level *b, const fl_signal_view *v, const struct options *o, double period,
                      int negative, fl_err *err)
{
    fl_signal_view turned = {0};
    double *y = NULL;
    const int turns = negative && !o->peaks;
    const int rc = turns ? turn_view(&turned, v, o, &y, err) || best_level_make(b, &turned, o, period, err)
                         : best_level_make(b, v, o, period, err);
    if (turns) fl_peaks_free(&turned.peaks);
    free(y);
    if (turns || o->peaks == FL_PEAK_MIN) *b = (best_level){b->n, b->law, -b->level, -b->high, -b->low};
    return rc ? -1 : 0;
}

int overview_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                  int32_t signal, int w, fl_err *err)
{
    const int is_sum_of_one = r->series->parts == 2 && part == 1 && strcmp(r->series->part[1], "total") == 0;
    const fl_signal_view *v = find_view(r, part, signal, w);
    const fl_descriptive_stats *d = &v->stats;
    const double span = v->edge[v->n] - v->edge[0], period = o->returns ? o->period[0] : span;
    const double largest = fmax(-d->min, d->max);
    const double min = without_rounding(d->min, largest), max = without_rounding(d->max, largest);
    const int one_sign = min >= 0.0 || max <= 0.0, negative = -min > max;
    char unit[64];
    const double k = factor_of(r->series->unit[signal], unit), p = negative ? 0.05 : 0.95;
    double q;
    fl_record_mean m;
    best_level b;
    if (is_sum_of_one) return 0;
    double *const weight = fl_alloc(v->n, sizeof *weight, err);
    if (!weight) return -1;
    for (int32_t i = 0; i < v->n; i++) weight[i] = v->edge[i + 1] - v->edge[i];
    const int bad = fl_record_mean_make(&m, v->n, v->x, span, d->mean, d->std, one_sign, err) ||
                    fl_compute_quantiles(v->n, v->x, weight, 1, &p, &q, err) ||
                    make_level(&b, v, o, period, negative, err);
    free(weight);
    if (bad) return -1;
    fprintf(f, "%s\t%s\t%s\t%s", r->series->part[part], r->series->signal[signal], unit, view_name(w));
    const double x[] = {d->mean, m.low, m.high, d->std, min, max, largest, q};
    for (size_t i = 0; i < sizeof x / sizeof *x; i++) write_six(f, k * without_rounding(x[i], largest));
    fprintf(f, "\t%d", b.n);
    write_six(f, period);
    fprintf(f, "\t%s", b.law ? b.law : "-");
    write_six(f, k * b.level);
    write_six(f, k * b.low);
    write_six(f, k * b.high);
    write_six(f, m.tau);
    fprintf(f, "\t%.4g\n", m.n);
    return 0;
}
