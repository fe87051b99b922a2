/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_min.h>
#include <gsl/gsl_multimin.h>
#include <gsl/gsl_sf_gamma.h>
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "stat/descriptive_stats.h"
#include "stat/fit.h"

static const double EULER = 0.57721566490153286061, LN2 = 0.69314718055994530942;

/* Cost outside the support and the range of parameters: finite, as GSL requires, and above the cost per
 * value of every sample. */
static const double NO_COST = 1e30;

/* A minimum is flat: its abscissa is known only to the square root of the rounding, 1e-8. */
static const double ABSCISSA_TOLERANCE = 1e-8;

/* Below this shape the likelihood has no regular maximum, see fit.h. */
static const double SHAPE_LEAST = -0.5;

const char *fl_fit_method_name(int method)
{
    static const char *const name[FL_FIT_METHODS] = {"mle", "lmoments", "moments"};
    return name[method];
}

int fl_fit_work_make(fl_fit_work *w, int32_t cap, fl_err *err)
{
    *w = (fl_fit_work){.cap = cap};
    gsl_set_error_handler_off(); /* it would abort without memory; failures are reported here */
    w->z = fl_alloc(cap, sizeof *w->z, err);
    if (!w->z) return -1;
    w->line = gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent);
    w->plane = gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, 2);
    if (w->line && w->plane) return 0;
    fl_fit_work_free(w);
    return fl_fail(err, FL_SYSTEM, "out of memory");
}

void fl_fit_work_free(fl_fit_work *w)
{
    free(w->z);
    if (w->line) gsl_min_fminimizer_free(w->line);
    if (w->plane) gsl_multimin_fminimizer_free(w->plane);
    *w = (fl_fit_work){0};
}

/* --- along a line --------------------------------------------------------------------------------------- */

/* Abscissa of a minimum of f in the open interval lo .. hi, downhill from x: bracketing, then Brent's method.
 * Next to lo or hi when f falls all the way there; NAN when there is no minimum. */
static double minimise_from(fl_fit_work *w, gsl_function *f, double x, double step, double lo, double hi)
{
    enum { STRIDES = 200, ROUNDS = 100 };
    const double grow = 1.6;
    double a = x, b, fa = GSL_FN_EVAL(f, a), fb, c = 0.0, fc = 0.0;
    int k;
    b = x + step < hi ? x + step : 0.5 * (x + hi);
    fb = GSL_FN_EVAL(f, b);
    if (fb > fa) {
        const double t = a, ft = fa;
        a = b;
        fa = fb;
        b = t;
        fb = ft;
    }
    for (k = 0; k < STRIDES; k++) {
        c = b + grow * (b - a);
        if (c >= hi) c = 0.5 * (b + hi);
        if (c <= lo) c = 0.5 * (b + lo);
        fc = GSL_FN_EVAL(f, c);
        if (!(fc < fb)) break;
        a = b;
        fa = fb;
        b = c;
        fb = fc;
    }
    if (!(fb < 0.5 * NO_COST)) return NAN;
    /* f falls as far as the end of the interval: the minimum is there. */
    if (k == STRIDES)
        return fmin(fabs(b - lo), fabs(hi - b)) < ABSCISSA_TOLERANCE * (hi - lo) ? b : (double)NAN;
    if (!(fb < fa && fb < fc)) return b; /* flat to rounding */
    if (gsl_min_fminimizer_set_with_values(w->line, f, b, fb, fmin(a, c), a < c ? fa : fc, fmax(a, c),
                                           a < c ? fc : fa))
        return b;
    for (k = 0; k < ROUNDS; k++) {
        if (gsl_min_fminimizer_iterate(w->line)) break;
        if (gsl_min_test_interval(gsl_min_fminimizer_x_lower(w->line), gsl_min_fminimizer_x_upper(w->line),
                                  ABSCISSA_TOLERANCE, ABSCISSA_TOLERANCE) == GSL_SUCCESS)
            break;
    }
    return gsl_min_fminimizer_x_minimum(w->line);
}

/* The root of a monotone function between lo and hi by bisection, which cannot fail; NAN where its signs do
 * not differ. */
static double find_root(double (*f)(double, const void *), const void *p, double lo, double hi)
{
    const int rising = f(lo, p) < f(hi, p);
    if ((f(lo, p) < 0.0) == (f(hi, p) < 0.0)) return NAN;
    for (int k = 0; k < 200 && hi - lo > 1e-15 * fmax(fabs(lo), fabs(hi)); k++) {
        const double x = 0.5 * (lo + hi);
        if ((f(x, p) < 0.0) == rising) lo = x;
        else hi = x;
    }
    return 0.5 * (lo + hi);
}

/* --- likelihood ----------------------------------------------------------------------------------------- */

/* Maximum-likelihood Gumbel distribution of z[n], not all equal: returns the location, sets the scale b.
 * Newton's method: the function b - mean + weighted mean rises with slope 1 + variance/b^2.  A step is
 * limited so that b stays at 0.1 of its value or more. */
static double fit_gumbel(int32_t n, const double *z, double *scale)
{
    double low = z[0], sum = 0.0, squares = 0.0, b, e0 = 0.0;
    for (int32_t k = 0; k < n; k++) {
        sum += z[k];
        if (z[k] < low) low = z[k];
    }
    const double mean = sum / n;
    for (int32_t k = 0; k < n; k++) squares += (z[k] - mean) * (z[k] - mean);
    b = sqrt(6.0 * squares / n) / PI;
    for (int round = 0; round < 100; round++) {
        double e1 = 0.0, e2 = 0.0;
        e0 = 0.0;
        for (int32_t k = 0; k < n; k++) {
            const double y = z[k] - low, e = exp(-y / b);
            e0 += e;
            e1 += y * e;
            e2 += y * y * e;
        }
        e1 /= e0;
        const double step = (mean - low - e1 - b) / (1.0 + (e2 / e0 - e1 * e1) / (b * b));
        if (fabs(step) < 1e-14 * b) break;
        b = b + step > 0.1 * b ? b + step : 0.1 * b;
    }
    *scale = b;
    return low - b * log(e0 / n);
}

typedef struct {
    int32_t n;
    const double *x;
    double c, s; /* centre and scale that make x of the order of 1 */
    double *z;
    double location, scale, shape; /* of the last theta, for x in those units */
} profile;

static double gev_profile(double theta, void *data)
{
    profile *p = data;
    double m, b, slope = 0.0, sum = 0.0;
    for (int32_t k = 0; k < p->n; k++) {
        p->z[k] = fl_dist_reduced_variate(theta, (p->x[k] - p->c) / p->s);
        if (!isfinite(p->z[k])) return NO_COST;
        slope += p->z[k];
    }
    m = fit_gumbel(p->n, p->z, &b);
    p->shape = theta * b;
    p->scale = b * exp(theta * m);
    p->location = fl_dist_from_reduced_variate(theta, m);
    if (!(p->shape > SHAPE_LEAST) || !isfinite(p->scale)) return NO_COST;
    for (int32_t k = 0; k < p->n; k++) sum += (p->z[k] - m) / b + exp(-(p->z[k] - m) / b);
    return (sum + theta * slope) / p->n + log(b);
}

static double gpd_profile(double theta, void *data)
{
    profile *p = data;
    double sum = 0.0;
    for (int32_t k = 0; k < p->n; k++) sum += fl_dist_reduced_variate(theta, (p->x[k] - p->c) / p->s);
    p->scale = sum / p->n;
    p->shape = theta * p->scale;
    if (!isfinite(sum) || !(p->shape > SHAPE_LEAST)) return NO_COST;
    return log(p->scale) + p->shape;
}

typedef struct {
    fl_dist d;
    int32_t n;
    const double *x;
    double tail, q, unit; /* unit of the scale */
} level;

static double cost_of(level *c)
{
    const double l = c->d.scale > 0.0 && isfinite(c->d.scale) && isfinite(c->d.location)
                         ? fl_fit_log_likelihood(&c->d, c->n, c->x) / c->n
                         : -INFINITY;
    return l > -NO_COST ? -l : NO_COST; /* also for a nan */
}

/* Cost of the distribution whose upper end is exp(u) of the range of the sample above its largest value. */
static double cost_at_end(double u, void *data)
{
    level *c = data;
    fl_dist *d = &c->d;
    const double end = c->q + c->unit * exp(u), k = -1.0 / d->shape;
    double sum = 0.0, s = end - d->location;
    if (d->kind == FL_GEV) {
        for (int32_t j = 0; j < c->n; j++) sum += pow(end - c->x[j], k) / c->n;
        s = pow(sum, 1.0 / k);
        d->location = end - s;
    }
    d->scale = -d->shape * s;
    return cost_of(c);
}

/* The most likely distribution of the smallest shape. */
static int fit_smallest_shape(fl_dist *d, int kind, int32_t n, const double *x, double location,
                              fl_fit_work *w)
{
    const double lo = fmin(x[0], x[n - 1]), hi = fmax(x[0], x[n - 1]);
    level c = {.n = n, .x = x, .q = hi, .unit = hi - lo};
    gsl_function f = {cost_at_end, &c};
    c.d = (fl_dist){.kind = kind, .location = location, .shape = SHAPE_LEAST};
    const double u = minimise_from(w, &f, -3.0, 0.5, -30.0, 10.0);
    if (!isfinite(u) || !(cost_at_end(u, &c) < NO_COST)) return 0;
    *d = c.d;
    return 1;
}

static int fit_by_profile(fl_dist *d, int32_t n, const double *x, double location, fl_fit_work *w)
{
    const int gev = d->kind == FL_GEV;
    const double lo = fmin(x[0], x[n - 1]), hi = fmax(x[0], x[n - 1]);
    profile p = {.n = n, .x = x, .z = w->z, .c = location};
    gsl_function f = {gev ? gev_profile : gpd_profile, &p};
    fl_dist start;
    double theta = 0.0;
    p.s = hi - lo;
    if (gev) {
        p.c = 0.0;
        for (int32_t k = 0; k < n; k++) p.c += x[k] / n;
    }
    /* For theta between these limits every x is inside the support. */
    const double least = -p.s / (hi - p.c), most = gev ? p.s / (p.c - lo) : 1e6;
    if (fl_fit(&start, d->kind, FL_FIT_L_MOMENTS, n, x, location, w))
        theta = start.shape / (start.scale + start.shape * (p.c - start.location)) * p.s;
    if (!(theta > 0.95 * least)) theta = 0.95 * least;
    if (!(theta < 0.95 * most)) theta = 0.95 * most;
    /* An L-moment fit may lie where the likelihood is unbounded; the search then starts from an exponential
     * tail. */
    if (!(GSL_FN_EVAL(&f, theta) < NO_COST)) theta = 0.0;
    theta = minimise_from(w, &f, theta, 0.1, least, most);
    if (!isfinite(theta) || !(GSL_FN_EVAL(&f, theta) < NO_COST) || p.shape < SHAPE_LEAST + 1e-3)
        return fit_smallest_shape(d, d->kind, n, x, location, w);
    /* Equal values at the lower end of a GEV make its likelihood unbounded there: not a maximum. */
    if (theta > (1.0 - 1e-6) * most) return 0;
    d->location = p.c + p.s * p.location;
    d->scale = p.s * p.scale;
    d->shape = p.shape;
    return d->scale > 0.0;
}

static int fit_by_likelihood(fl_dist *d, int32_t n, const double *x, double location, fl_fit_work *w)
{
    double mean = 0.0, squares = 0.0;
    switch (d->kind) {
    case FL_GUMBEL: d->location = fit_gumbel(n, x, &d->scale); return 1;
    case FL_WEIBULL:
        for (int32_t k = 0; k < n; k++) w->z[k] = -log(x[k]);
        d->scale = exp(-fit_gumbel(n, w->z, &mean));
        d->shape = 1.0 / mean;
        return 1;
    case FL_LOGNORMAL:
        for (int32_t k = 0; k < n; k++) mean += log(x[k]) / n;
        for (int32_t k = 0; k < n; k++) squares += (log(x[k]) - mean) * (log(x[k]) - mean);
        d->scale = exp(mean);
        d->shape = sqrt(squares / n);
        return 1;
    default: return fit_by_profile(d, n, x, location, w);
    }
}

/* --- L-moments and moments ------------------------------------------------------------------------------ */

void fl_fit_l_moments(int32_t n, const double *x, double l[3])
{
    const int down = x[0] > x[n - 1];
    double b0 = 0.0, b1 = 0.0, b2 = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const double v = x[down ? n - 1 - k : k];
        b0 += v / n;
        b1 += v / n * k / (n - 1.0);
        b2 += v / n * k / (n - 1.0) * (k - 1.0) / (n - 2.0);
    }
    l[0] = b0;
    l[1] = 2.0 * b1 - b0;
    l[2] = (6.0 * b2 - 6.0 * b1 + b0) / l[1];
}

/* t3 of a GEV, 2 (1 - 3^shape) / (1 - 2^shape) - 3: rises from -1 to 1 for shapes up to 1. */
static double gev_t3(double shape, const void *want)
{
    const double q = fabs(shape) < 1e-12 ? log(3.0) / LN2 : expm1(shape * log(3.0)) / expm1(shape * LN2);
    return 2.0 * q - 3.0 - *(const double *)want;
}

/* Skewness of a GEV, from its moments G(r) = Gamma(1 - r shape).  They cancel to the third order near shape
 * 0; there gev_skew() interpolates the values at +-h, +-2h by a cubic. */
static double gev_skew_direct(double shape)
{
    const double a = tgamma(1.0 - shape), b = tgamma(1.0 - 2.0 * shape), c = tgamma(1.0 - 3.0 * shape);
    return (shape > 0.0 ? 1.0 : -1.0) * (c - 3.0 * a * b + 2.0 * a * a * a) / pow(b - a * a, 1.5);
}

static double gev_skew(double shape, const void *want)
{
    const double h = 3e-3, t = shape / h;
    if (fabs(t) >= 1.0) return gev_skew_direct(shape) - *(const double *)want;
    const double m2 = gev_skew_direct(-2.0 * h), m1 = gev_skew_direct(-h), p1 = gev_skew_direct(h),
                 p2 = gev_skew_direct(2.0 * h);
    return m2 * (t + 1.0) * (t - 1.0) * (t - 2.0) / -12.0 + m1 * (t + 2.0) * (t - 1.0) * (t - 2.0) / 6.0 +
           p1 * (t + 2.0) * (t + 1.0) * (t - 2.0) / -6.0 + p2 * (t + 2.0) * (t + 1.0) * (t - 1.0) / 12.0 -
           *(const double *)want;
}

/* (coefficient of variation)^2 of a Weibull distribution of shape e^u, minus the one of the sample: falls
 * with u. */
static double weibull_cv(double u, const void *want)
{
    const double q = exp(-u);
    return gsl_sf_lngamma(1.0 + 2.0 * q) - 2.0 * gsl_sf_lngamma(1.0 + q) - log1p(*(const double *)want);
}

static int fit_by_l_moments(fl_dist *d, int32_t n, const double *x, double location)
{
    double l[3];
    fl_fit_l_moments(n, x, l);
    if (!(l[1] > 0.0)) return 0;
    switch (d->kind) {
    case FL_WEIBULL:
        d->shape = -LN2 / log1p(-l[1] / l[0]);
        d->scale = l[0] / tgamma(1.0 + 1.0 / d->shape);
        break;
    case FL_GUMBEL:
        d->scale = l[1] / LN2;
        d->location = l[0] - EULER * d->scale;
        break;
    case FL_LOGNORMAL: /* l2 = l1 erf(shape / 2) */
        d->shape = sqrt(2.0) * gsl_cdf_ugaussian_Pinv(0.5 * (1.0 + l[1] / l[0]));
        d->scale = l[0] * exp(-0.5 * d->shape * d->shape);
        break;
    case FL_GEV:
        d->shape = find_root(gev_t3, &l[2], -60.0, 0.9999);
        if (fabs(d->shape) < 1e-9) {
            d->scale = l[1] / LN2;
            d->location = l[0] - EULER * d->scale;
        } else {
            const double g = tgamma(1.0 - d->shape);
            d->scale = l[1] * d->shape / (g * expm1(d->shape * LN2));
            d->location = l[0] - d->scale * (g - 1.0) / d->shape;
        }
        break;
    default: d->shape = 2.0 - (l[0] - location) / l[1]; d->scale = (l[0] - location) * (1.0 - d->shape);
    }
    return 1;
}

static int fit_by_moments(fl_dist *d, int32_t n, const double *x, double location)
{
    fl_descriptive_stats m;
    fl_compute_moments(n, x, NULL, &m);
    const double s = m.std_sample, cv = s * s / (m.mean * m.mean), y = m.mean - location;
    double g;
    switch (d->kind) {
    case FL_WEIBULL:
        d->shape = exp(find_root(weibull_cv, &cv, -4.0, 12.0));
        d->scale = m.mean / tgamma(1.0 + 1.0 / d->shape);
        break;
    case FL_GUMBEL:
        d->scale = s * sqrt(6.0) / PI;
        d->location = m.mean - EULER * d->scale;
        break;
    case FL_LOGNORMAL:
        d->shape = sqrt(log1p(cv));
        d->scale = m.mean * exp(-0.5 * d->shape * d->shape);
        break;
    case FL_GEV:
        d->shape = find_root(gev_skew, &m.skew, -5.0, 0.333);
        if (fabs(d->shape) < 1e-6) {
            d->scale = s * sqrt(6.0) / PI;
            d->location = m.mean - EULER * d->scale;
        } else {
            g = tgamma(1.0 - d->shape);
            d->scale = s * fabs(d->shape) / sqrt(tgamma(1.0 - 2.0 * d->shape) - g * g);
            d->location = m.mean - d->scale * (g - 1.0) / d->shape;
        }
        break;
    default: d->shape = 0.5 * (1.0 - y * y / (s * s)); d->scale = y * (1.0 - d->shape);
    }
    return 1;
}

/* --- fit and goodness ----------------------------------------------------------------------------------- */

int fl_fit(fl_dist *d, int kind, int method, int32_t n, const double *x, double location, fl_fit_work *w)
{
    int ok;
    *d = (fl_dist){.kind = kind, .location = kind == FL_GPD ? location : 0.0};
    if (n < 1 + fl_dist_parameter_count(kind) || x[0] == x[n - 1]) return 0;
    if ((kind == FL_WEIBULL || kind == FL_LOGNORMAL) && !(fmin(x[0], x[n - 1]) > 0.0)) return 0;
    if (kind == FL_GPD && !(fmin(x[0], x[n - 1]) > location)) return 0;
    if (method == FL_FIT_LIKELIHOOD) ok = fit_by_likelihood(d, n, x, location, w);
    else if (method == FL_FIT_L_MOMENTS) ok = fit_by_l_moments(d, n, x, location);
    else ok = fit_by_moments(d, n, x, location);
    if (ok && method == FL_FIT_LIKELIHOOD && !isfinite(fl_fit_log_likelihood(d, n, x))) return 0;
    return ok && isfinite(d->location) && isfinite(d->scale) && isfinite(d->shape) && d->scale > 0.0;
}

double fl_fit_log_likelihood(const fl_dist *d, int32_t n, const double *x)
{
    double sum = 0.0;
    for (int32_t k = 0; k < n; k++) sum += fl_dist_log_density(d, x[k]);
    return sum;
}

double fl_fit_aic(const fl_dist *d, double log_likelihood)
{
    return 2.0 * fl_dist_parameter_count(d->kind) - 2.0 * log_likelihood;
}

double fl_fit_kolmogorov(const fl_dist *d, int32_t n, const double *x)
{
    const int down = x[0] > x[n - 1];
    double most = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const double F = fl_dist_cdf(d, x[down ? n - 1 - k : k]);
        most = fmax(most, fmax((k + 1.0) / n - F, F - (double)k / n));
    }
    return most;
}

double fl_fit_anderson(const fl_dist *d, int32_t n, const double *x)
{
    const int down = x[0] > x[n - 1];
    double sum = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const double low = fl_dist_cdf(d, x[down ? n - 1 - k : k]),
                     high = fl_dist_survival(d, x[down ? k : n - 1 - k]);
        sum += (2.0 * k + 1.0) * (log(low) + log(high));
    }
    return -n - sum / n;
}

/* --- with a given level --------------------------------------------------------------------------------- */

/* Cost along the constraint.  u is ln of the free parameter, or the shape of a GPD; the other parameter
 * follows from the level. */
static double cost_on_line(double u, void *data)
{
    level *c = data;
    fl_dist *d = &c->d;
    switch (d->kind) {
    case FL_WEIBULL:
        d->shape = exp(u);
        d->scale = c->q / pow(-log(c->tail), exp(-u));
        break;
    case FL_LOGNORMAL:
        d->shape = exp(u);
        d->scale = c->q / exp(d->shape * gsl_cdf_ugaussian_Qinv(c->tail));
        break;
    case FL_GUMBEL:
        d->scale = c->unit * exp(u);
        d->location = c->q + d->scale * log(-log1p(-c->tail));
        break;
    default: d->shape = u; d->scale = (c->q - d->location) / fl_dist_from_reduced_variate(u, -log(c->tail));
    }
    return cost_of(c);
}

static double cost_in_plane(const gsl_vector *u, void *data)
{
    level *c = data;
    c->d.scale = c->unit * exp(gsl_vector_get(u, 0));
    c->d.shape = gsl_vector_get(u, 1);
    c->d.location = c->q - c->d.scale * fl_dist_from_reduced_variate(c->d.shape, -log(-log1p(-c->tail)));
    return c->d.shape > SHAPE_LEAST ? cost_of(c) : NO_COST;
}

/* The shape for which a GEV of given location and scale has the level is the root of level_excess(). */
typedef struct {
    double w, z;
} level_target;

static double level_excess(double shape, const void *data)
{
    const level_target *a = data;
    return fl_dist_from_reduced_variate(shape, a->w) - a->z;
}

/* Largest log-likelihood of a GEV with the given level, by a simplex in scale and shape.  The simplex starts
 * with the location and scale of the best fit and the shape that gives the level, because the middle of the
 * sample hardly determines the level.  The scale grows until all values are inside the support.  The search
 * restarts from its result, because a simplex may collapse. */
static double minimise_in_plane(level *c, const fl_dist *start, fl_fit_work *w)
{
    const level_target a = {-log(-log1p(-c->tail)), (c->q - start->location) / start->scale};
    const double shape = find_root(level_excess, &a, SHAPE_LEAST + 0.01, 10.0);
    double at[2] = {0.0, isfinite(shape) ? shape : start->shape}, step[2] = {0.1, 0.1};
    gsl_vector_view u = gsl_vector_view_array(at, 2), s = gsl_vector_view_array(step, 2);
    gsl_multimin_function f = {cost_in_plane, 2, c};
    double least = NO_COST;
    for (int k = 0; k < 60 && !(cost_in_plane(&u.vector, c) < NO_COST); k++) {
        at[0] += 0.1;
        at[1] *= 0.9;
    }
    for (int round = 0; round < 5; round++) {
        const double before = least;
        if (gsl_multimin_fminimizer_set(w->plane, &f, &u.vector, &s.vector)) break;
        for (int k = 0; k < 2000; k++) {
            if (gsl_multimin_fminimizer_iterate(w->plane)) break;
            if (gsl_multimin_test_size(gsl_multimin_fminimizer_size(w->plane), 1e-5) == GSL_SUCCESS) break;
        }
        gsl_vector_memcpy(&u.vector, gsl_multimin_fminimizer_x(w->plane));
        least = cost_in_plane(&u.vector, c);
        if (round && before - least < 1e-7) break; /* log-likelihood per value */
    }
    return least < NO_COST ? -least * c->n : -INFINITY;
}

double fl_fit_constrained(const fl_dist *start, int32_t n, const double *x, double tail, double q,
                          fl_fit_work *w, fl_dist *found)
{
    level c = {.d = *start, .n = n, .x = x, .tail = tail, .q = q, .unit = start->scale};
    gsl_function f = {cost_on_line, &c};
    double best;
    if (start->kind == FL_GEV) {
        best = minimise_in_plane(&c, start, w);
    } else {
        double u = start->kind == FL_GUMBEL ? 0.0 : log(start->shape), lo = -700.0, hi = 700.0;
        if (start->kind == FL_GPD) {
            u = start->shape;
            lo = SHAPE_LEAST;
            hi = 50.0;
            /* The largest value must be inside the support, which grows with the shape. */
            for (int k = 0; k < 60 && !(cost_on_line(u, &c) < NO_COST); k++) u += 0.1;
        }
        u = minimise_from(w, &f, u, 0.02, lo, hi);
        const double least = isfinite(u) ? cost_on_line(u, &c) : NO_COST;
        best = least < NO_COST ? -least * n : -INFINITY;
    }
    if (found) *found = c.d;
    return best;
}
