/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/rng.h"
#include "stat/return_level.h"

static const double CONFIDENCE = 0.95;

/* Tolerance of the ends of an interval, relative to its half width: far below the uncertainty of a sample. */
static const double END_TOLERANCE = 1e-4;

typedef struct {
    const fl_dist *best;
    int32_t n;
    const double *x;
    double most, tail; /* log-likelihood of best */
    fl_fit_work *w;
} likelihood_ratio;

static double ratio_at(const likelihood_ratio *p, double q)
{
    const double l = fl_fit_constrained(p->best, p->n, p->x, p->tail, q, p->w, NULL);
    return l > -INFINITY ? fmax(0.0, 2.0 * (p->most - l)) : INFINITY;
}

/* The point where W crosses the limit on one side of the level.  sqrt(W) is nearly linear.  Strides
 * extrapolate it to slightly beyond the limit until the root is bracketed; secants then refine it.  Every
 * third step bisects, which ensures convergence for any W. */
static double interval_end(const likelihood_ratio *p, double level, double first, double cut)
{
    enum { STRIDES = 100, STEPS = 200 };
    const double want = sqrt(cut), beyond = 1.1, least = 1.2, most = 3.0;
    double in = level, out = level + first, at_in = 0.0, at_out = 0.0;
    int k;
    for (k = 0; k < STRIDES; k++) {
        at_out = sqrt(ratio_at(p, out));
        if (!(at_out <= want)) break;
        const double grow = at_out > 0.0 ? beyond * want / at_out : most;
        in = out;
        at_in = at_out;
        out = level + fmin(fmax(grow, least), most) * (out - level);
    }
    if (k == STRIDES || !isfinite(out)) return NAN;
    for (k = 1; k < STEPS && fabs(out - in) > END_TOLERANCE * fabs(out - level); k++) {
        const int secant = isfinite(at_out) && k % 3;
        const double mid = in + (out - in) * (secant ? (want - at_in) / (at_out - at_in) : 0.5);
        if (mid == in || mid == out) break;
        const double at = sqrt(ratio_at(p, mid));
        if (fabs(at - want) <= END_TOLERANCE * want) return mid;
        if (at <= want) {
            in = mid;
            at_in = at;
        } else {
            out = mid;
            at_out = at;
        }
    }
    return 0.5 * (in + out);
}

/* The limit of W for n values and a distribution with p free parameters. */
static double ratio_limit(int32_t n, int p)
{
    const double t = gsl_cdf_tdist_Qinv(0.5 * (1.0 - CONFIDENCE), n - p);
    return n * log1p(t * t / (n - p));
}

static void compute_interval(const likelihood_ratio *p, double level, double cut, double ends[2])
{
    const double step = 0.3 * p->best->scale / sqrt(p->n);
    ends[0] = ends[1] = NAN;
    if (!isfinite(cut) || !isfinite(level)) return;
    ends[0] = interval_end(p, level, -step, cut);
    ends[1] = interval_end(p, level, step, cut);
}

static int compare_rising(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void draw_sample(const fl_dist *d, int32_t n, double *x, fl_rng *g)
{
    /* Never 0 or 1: there the quantile may be infinite. */
    for (int32_t k = 0; k < n; k++)
        x[k] = fl_dist_upper_quantile(d, fmin(fl_rng_unit(g) + 0x1p-54, 1.0 - 0x1p-53));
    qsort(x, (size_t)n, sizeof *x, compare_rising);
}

/* The limits of W for the m levels from the resamples, cut[m]; ratios[m * resamples] and y[n] are scratch. */
static void resample_limits(const fl_dist *best, int32_t n, int32_t m, const fl_return_level *r,
                            fl_goodness_of_fit *g, int32_t resamples, fl_rng *rng, fl_fit_work *w,
                            double *ratios, double *y, double *cut)
{
    int32_t done = 0, far_k = 0, far_a = 0;
    for (int32_t b = 0; b < resamples; b++) {
        fl_dist d;
        draw_sample(best, n, y, rng);
        if (!fl_fit(&d, best->kind, FL_FIT_LIKELIHOOD, n, y, best->location, w)) continue;
        far_k += fl_fit_kolmogorov(&d, n, y) >= g->kolmogorov;
        far_a += fl_fit_anderson(&d, n, y) >= g->anderson;
        const likelihood_ratio p = {&d, n, y, fl_fit_log_likelihood(&d, n, y), 0.0, w};
        for (int32_t j = 0; j < m; j++) {
            likelihood_ratio pj = p;
            pj.tail = r[j].tail;
            ratios[(int64_t)j * resamples + done] = ratio_at(&pj, r[j].level);
        }
        done++;
    }
    const int enough = resamples > 0 && done >= 0.9 * resamples;
    g->p_kolmogorov = enough ? (far_k + 1.0) / (done + 1.0) : NAN;
    g->p_anderson = enough ? (far_a + 1.0) / (done + 1.0) : NAN;
    for (int32_t j = 0; j < m; j++) {
        /* A further value exceeds the k-th smallest of B with probability 1 - k / (B + 1). */
        const int32_t k = (int32_t)ceil(CONFIDENCE * (done + 1.0) - 1e-9) - 1;
        double *of = ratios + (int64_t)j * resamples;
        cut[j] = NAN;
        if (!enough || k >= done) continue;
        qsort(of, (size_t)done, sizeof *of, compare_rising);
        cut[j] = of[k];
    }
}

int fl_compute_return_levels(const fl_dist *best, int32_t n, const double *x, int32_t m, fl_return_level *r,
                             fl_goodness_of_fit *g, int32_t resamples, uint64_t seed, int64_t entity,
                             fl_fit_work *w, fl_err *err)
{
    fl_rng rng = fl_rng_of(seed, entity, FL_RNG_BOOTSTRAP);
    double *ratios = fl_alloc((int64_t)m * resamples, sizeof *ratios, err);
    double *y = ratios ? fl_alloc((int64_t)n + m, sizeof *y, err) : NULL;
    fl_goodness_of_fit own;
    if (!y) {
        free(ratios);
        return -1;
    }
    if (!g) g = &own;
    *g = (fl_goodness_of_fit){fl_fit_kolmogorov(best, n, x), fl_fit_anderson(best, n, x), NAN, NAN};
    const double least = ratio_limit(n, fl_dist_parameter_count(best->kind));
    for (int32_t j = 0; j < m; j++) r[j].level = fl_dist_upper_quantile(best, r[j].tail);
    resample_limits(best, n, m, r, g, resamples, &rng, w, ratios, y, y + n);
    for (int32_t j = 0; j < m; j++) {
        const likelihood_ratio p = {best, n, x, fl_fit_log_likelihood(best, n, x), r[j].tail, w};
        /* Resamples that end at the smallest shape have too small a likelihood ratio, see return_level.h. */
        const int bound = best->kind == FL_GEV || best->kind == FL_GPD;
        const double cut = bound && y[n + j] < least ? least : y[n + j];
        compute_interval(&p, r[j].level, least, r[j].profile);
        compute_interval(&p, r[j].level, cut, r[j].bootstrap);
    }
    free(ratios);
    free(y);
    return 0;
}
