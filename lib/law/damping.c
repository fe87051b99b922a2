/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/pi.h"
#include "law/damping.h"

/* Largest damping ratio of a contact at rest: a larger one would only shorten the step. */
#define RATIO 2.5

static double clamp_restitution(double e) { return e < FL_MIN_RESTITUTION ? FL_MIN_RESTITUTION : e; }

/* Root of f in (lo, hi), where f changes sign once from - to +: bisection to the last bit. */
static double find_root(double (*f)(double, double), double e, double lo, double hi)
{
    for (int k = 0; k < 200; k++) {
        const double mid = 0.5 * (lo + hi);
        if (mid <= lo || mid >= hi) break;
        if (f(mid, e) < 0.0) lo = mid;
        else hi = mid;
    }
    return 0.5 * (lo + hi);
}

static double impact_residual(double D, double e) { return log1p(D) - log1p(-e * D) - D * (1.0 + e); }

double fl_damping_hunt_crossley(double e)
{
    e = clamp_restitution(e);
    if (e >= 1.0) return 0.0;
    /* Near 0 the function is -(1 - e^2) D^2/2 + (1 + e^3) D^3/3: negative up to about D0, the root lies
     * beyond. */
    const double D0 = 1.5 * (1.0 - e * e) / (1.0 + e * e * e);
    return find_root(impact_residual, e, 0.5 * D0, (1.0 - 1e-16) / e);
}

double fl_damping_stored_speed(double D)
{
    if (D < 1e-4)
        return 1.0 - D / 3.0; /* the difference has lost half its digits; the next term is D^2 7/36 */
    return sqrt(2.0 * (D - log1p(D))) / D;
}

double fl_damping_slow_factor(double D)
{
    const double impact = 0.5 * D * fl_damping_stored_speed(D), ratio = impact > RATIO ? impact : RATIO;
    return 0.5 * D > ratio ? 0.5 * D / ratio : 1.0;
}

double fl_damping_stable_share(double z) { return sqrt(1.0 + z * z) - z; }

double fl_hunt_crossley_stable_share(double D, double times)
{
    enum { SAMPLES = 64 }; /* of the impact; the minimum is flat: within 1e-3 */
    const double more = sqrt(times);
    double least = fl_damping_stable_share(0.5 * D / fl_damping_slow_factor(D) * more);
    for (int k = 0; k <= SAMPLES && D > 0.0; k++) {
        const double u = (double)k / SAMPLES, K = 1.0 + D * u;
        const double s2 = 2.0 * ((1.0 - u) - log((1.0 + D) / K) / D) / D,
                     C = D * sqrt(s2 > 0.0 ? s2 : 0.0) * more;
        const double dt = 0.5 * (sqrt(C * C + 4.0 * K) - C) / K;
        least = dt < least ? dt : least;
    }
    return least;
}

double fl_damping_linear_restitution(double zeta)
{
    if (zeta < 1.0) {
        const double s = sqrt(1.0 - zeta * zeta);
        if (zeta <= 0.0) return 1.0;
        return exp(-zeta / s * (PI - atan2(2.0 * zeta * s, 1.0 - 2.0 * zeta * zeta)));
    }
    if (zeta == 1.0) return exp(-2.0);
    const double q = sqrt(zeta * zeta - 1.0);
    return pow((zeta - q) / (zeta + q), zeta / q);
}

static double linear_residual(double zeta, double e) { return e - fl_damping_linear_restitution(zeta); }

double fl_damping_linear(double e)
{
    e = clamp_restitution(e);
    return e >= 1.0 ? 0.0 : find_root(linear_residual, e, 0.0, 100.0);
}

double fl_damping_tsuji(double e)
{
    static const double h[10] = {-6.918798, -16.41105, 146.8049,  -796.4559, 2928.711,
                                 -7206.864, 11494.29,  -11342.18, 6276.757,  -1489.915};
    double p = 0.0;
    e = clamp_restitution(e);
    if (e >= 1.0) return 0.0;
    for (int k = 9; k >= 0; k--) p = e * (h[k] + p);
    const double g2 = 1.0 / (1.0 - (1.0 + e) * (1.0 + e) * exp(p)) - 1.0;
    return g2 > 0.0 ? sqrt(6.0 * g2) : 0.0;
}
