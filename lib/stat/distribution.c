/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <gsl/gsl_cdf.h>
#include <math.h>
#include "stat/distribution.h"

/* Below this shape the reduced variate equals z to rounding for every z of a load.  The test avoids a
 * quotient of two numbers near the smallest double. */
static const double SMALL_SHAPE = 1e-100;

static const double HALF_LN_2PI = 0.91893853320467274178;

const char *fl_dist_name(int kind)
{
    static const char *const name[FL_DISTS] = {"weibull", "gumbel", "lognormal", "gev", "gpd"};
    return name[kind];
}

int fl_dist_parameter_count(int kind) { return kind == FL_GEV ? 3 : 2; }

double fl_dist_reduced_variate(double shape, double z)
{
    if (fabs(shape) < SMALL_SHAPE) return z;
    return shape * z > -1.0 ? log1p(shape * z) / shape : shape > 0.0 ? -INFINITY : INFINITY;
}

double fl_dist_from_reduced_variate(double shape, double w)
{
    return fabs(shape) < SMALL_SHAPE ? w : expm1(shape * w) / shape;
}

double fl_dist_cdf(const fl_dist *d, double x)
{
    const double z = (x - d->location) / d->scale;
    switch (d->kind) {
    case FL_WEIBULL: return z > 0.0 ? -expm1(-pow(z, d->shape)) : 0.0;
    case FL_LOGNORMAL: return z > 0.0 ? gsl_cdf_ugaussian_P(log(z) / d->shape) : 0.0;
    case FL_GPD: return z > 0.0 ? -expm1(-fl_dist_reduced_variate(d->shape, z)) : 0.0;
    default: return exp(-exp(-fl_dist_reduced_variate(d->shape, z)));
    }
}

double fl_dist_survival(const fl_dist *d, double x)
{
    const double z = (x - d->location) / d->scale;
    switch (d->kind) {
    case FL_WEIBULL: return z > 0.0 ? exp(-pow(z, d->shape)) : 1.0;
    case FL_LOGNORMAL: return z > 0.0 ? gsl_cdf_ugaussian_Q(log(z) / d->shape) : 1.0;
    case FL_GPD: return z > 0.0 ? exp(-fl_dist_reduced_variate(d->shape, z)) : 1.0;
    default: return -expm1(-exp(-fl_dist_reduced_variate(d->shape, z)));
    }
}

double fl_dist_log_density(const fl_dist *d, double x)
{
    const double z = (x - d->location) / d->scale;
    double w;
    switch (d->kind) {
    case FL_WEIBULL:
        if (!(z > 0.0)) return -INFINITY;
        return log(d->shape / d->scale) + (d->shape - 1.0) * log(z) - pow(z, d->shape);
    case FL_LOGNORMAL:
        if (!(z > 0.0)) return -INFINITY;
        w = log(z) / d->shape;
        return -HALF_LN_2PI - log(d->shape) - log(x) - 0.5 * w * w;
    case FL_GPD:
        w = fl_dist_reduced_variate(d->shape, z);
        return z < 0.0 || !isfinite(w) ? -INFINITY : -log(d->scale) - (1.0 + d->shape) * w;
    default:
        w = fl_dist_reduced_variate(d->shape, z);
        return isfinite(w) ? -log(d->scale) - (1.0 + d->shape) * w - exp(-w) : -INFINITY;
    }
}

double fl_dist_upper_quantile(const fl_dist *d, double tail)
{
    switch (d->kind) {
    case FL_WEIBULL: return d->scale * pow(-log(tail), 1.0 / d->shape);
    case FL_LOGNORMAL: return d->scale * exp(d->shape * gsl_cdf_ugaussian_Qinv(tail));
    case FL_GPD: return d->location + d->scale * fl_dist_from_reduced_variate(d->shape, -log(tail));
    default: return d->location + d->scale * fl_dist_from_reduced_variate(d->shape, -log(-log1p(-tail)));
    }
}
