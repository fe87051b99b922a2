/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/fast_math.h"
#include "bond/joint_law.h"

/* Largest share of tau_m/k_s in a step, and most such steps. */
static const double STEP = 0.02;
enum { STEPS_MAX = 2000 };
/* Stress at which an exponent of 1 begins, where a power law has no zero [Pa]. */
static const double FIRST_STRESS = 1.0;
static const double RATIO_MAX = 0.75;
static const double QUARTER_TURN = 1.5707; /* phi_m stays below 90 degrees */

static double power_of(double x, double e)
{
    return e == 0.0 ? 1.0 : e == 1.0 ? x : x > 0.0 ? fl_pow(x, e) : 0.0;
}

/* Stress above which k_n is at its largest value. */
static double capped_from(const fl_joint_material *m)
{
    const double e = m->normal_exponent;
    if (e == 0.0 || !(m->kn_most < INFINITY)) return INFINITY;
    const double ratio = m->kn_most / m->kn;
    return e == 1.0 ? ratio : fl_pow(ratio, 1.0 / e);
}

static double power_closure(const fl_joint_material *m, double sigma)
{
    const double e = m->normal_exponent;
    if (e == 1.0) return fl_log(sigma / FIRST_STRESS) / m->kn;
    return power_of(sigma, 1.0 - e) / ((1.0 - e) * m->kn);
}

double fl_joint_closure(const fl_joint_material *m, double sigma)
{
    const double cap = capped_from(m), least = m->normal_exponent == 1.0 ? FIRST_STRESS : 0.0;
    if (!(sigma > least)) return 0.0;
    if (sigma <= cap) return power_closure(m, sigma);
    return power_closure(m, cap) + (sigma - cap) / m->kn_most;
}

double fl_joint_closing_stress(const fl_joint_material *m, double u, double *stored)
{
    const double e = m->normal_exponent, cap = capped_from(m),
                 at = cap < INFINITY ? power_closure(m, cap) : INFINITY, low = u < at ? u : at;
    double sigma, energy;
    *stored = 0.0;
    if (!(u > 0.0)) return 0.0;
    if (e == 1.0) {
        sigma = FIRST_STRESS * fl_exp(m->kn * low);
        energy = (sigma - FIRST_STRESS) / m->kn;
    } else {
        const double x = (1.0 - e) * m->kn * low;
        sigma = e == 0.0 ? x : fl_pow(x, 1.0 / (1.0 - e));
        energy = sigma * low * (1.0 - e) / (2.0 - e);
    }
    if (u > at) {
        const double more = u - at;
        energy += sigma * more + 0.5 * m->kn_most * more * more;
        sigma += m->kn_most * more;
    }
    *stored = energy;
    return sigma;
}

static double strength_of(const fl_joint_point *p, double sigma)
{
    double c, s;
    fl_cos_sin(p->angle < QUARTER_TURN ? p->angle : QUARTER_TURN, &c, &s);
    return sigma * s / c;
}

static double yield_factor(double tau, double strength, double ratio)
{
    const double F = (1.0 - tau / strength) / (1.0 - ratio);
    return F < 1.0 ? F : 1.0;
}

/* Slip by du along the direction of tau, in one step of the mid-point rule; returns tau. */
static double slip_once(const fl_joint_material *m, fl_joint_point *p, double sigma, double ks, double tau,
                        double du)
{
    const double F = yield_factor(tau, strength_of(p, sigma), p->ratio);
    fl_joint_point mid = *p;
    mid.angle -= 0.5 * (p->angle - m->angle) * (1.0 - F) * du / m->roughness;
    const double half = tau + 0.5 * F * ks * du, G = yield_factor(half, strength_of(&mid, sigma), p->ratio);
    p->angle -= (mid.angle - m->angle) * (1.0 - G) * du / m->roughness;
    p->slip += (1.0 - G) * du;
    return tau + G * ks * du;
}

fl_joint_point_result fl_joint_yielding_step(const fl_joint_material *m, fl_joint_point *p, double s_n,
                                             const double ds[2])
{
    fl_joint_point_result out = {0};
    double closed;
    const double sigma = fl_joint_closing_stress(m, p->offset - s_n, &closed),
                 du = sqrt(ds[0] * ds[0] + ds[1] * ds[1]);
    p->sigma = sigma;
    if (!(sigma > 0.0)) {
        p->open = p->failed = 1;
        p->tau[0] = p->tau[1] = p->ratio = p->way[0] = p->way[1] = 0.0;
        return out;
    }
    p->open = 0;
    const double full = m->ks * power_of(sigma, m->shear_exponent),
                 ks = full < m->ks_most ? full : m->ks_most;
    if (du > 0.0) {
        const double e[2] = {ds[0] / du, ds[1] / du};
        double along = p->tau[0] * e[0] + p->tau[1] * e[1];
        const double strength = strength_of(p, sigma), before = along;
        if (e[0] * p->way[0] + e[1] * p->way[1] < 0.0) {
            const double r = along / strength;
            p->ratio = r < RATIO_MAX ? r : RATIO_MAX;
        }
        p->way[0] = e[0], p->way[1] = e[1];
        const double steps = ceil(du * ks / (STEP * strength));
        const int n = steps < STEPS_MAX ? (int)steps : STEPS_MAX;
        for (int k = 0; k < n; k++) along = slip_once(m, p, sigma, ks, along, du / n);
        const double old2 = p->tau[0] * p->tau[0] + p->tau[1] * p->tau[1];
        p->tau[0] += (along - before) * e[0], p->tau[1] += (along - before) * e[1];
        out.friction =
            0.5 * (before + along) * du - 0.5 * (p->tau[0] * p->tau[0] + p->tau[1] * p->tau[1] - old2) / ks;
        out.slips = fabs(along - before) < 0.5 * ks * du;
    }
    out.stored = closed + 0.5 * (p->tau[0] * p->tau[0] + p->tau[1] * p->tau[1]) / ks;
    return out;
}
