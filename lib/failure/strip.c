/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure/strip.h"
#include <math.h>
#include "base/pi.h"

fl_strip_step fl_strip_step_of(const fl_strip_law *law, double dt)
{
    fl_strip_step t = {.law = law,
                       .h = 0.5 * dt,
                       .over_delta = 1.0 / law->delta,
                       .creep = 0.5 * dt * law->transition_speed,
                       .g = 1.0,
                       .keep = 1.0,
                       .gap = (law->peak_ratio - 2.0) * law->delta};
    if (law->kappa > 0.0) {
        t.g = 1.0 / (1.0 + t.h / law->tau);
        t.keep = 1.0 - t.h / law->tau;
        t.a = 1.0 / (law->kappa * law->tau);
    }
    return t;
}

double fl_strip_gap(const fl_strip_law *law, int64_t entity)
{
    fl_rng g = fl_rng_of(law->seed, entity, FL_RNG_STRIP_GAP);
    return (law->peak_ratio - 2.0) * law->delta * fl_rng_unit(&g);
}

void fl_strip_break(const fl_strip_law *law, fl_strip_element *s, double rest, fl_strip_id id)
{
    s->u = 0.0;
    s->e = rest;
    do {
        s->count++;
        s->e -= fl_strip_gap(law, fl_rng_entity4(id.floe, id.region, id.sector, s->count));
        if (s->e >= law->delta) s->e -= law->delta;
        else break;
    } while (1);
}

double fl_strip_negative_damping(const fl_strip_law *law)
{
    const double n = law->creep_exponent, R = law->peak_ratio,
                 delayed =
                     law->kappa > 0.0 ? (2.0 / 3.0 - 1.0 / R) * law->delta / (law->kappa * law->tau) : 0.0;
    return law->transition_speed * (1.0 + n / (n + 2.0) - 2.0 / R) / (n + 1.0) + delayed;
}

double fl_strip_lock_in_speed(double F, double b, double ratio, double omega, double mass)
{
    return ratio > 0.0 ? sqrt(F * b / (2.0 * ratio * omega * mass)) : INFINITY;
}

/* exp(-1/4) and sqrt(1 - exp(-1/2)). */
#define NODE_CORRELATION 0.7788007830714049
#define NODE_NOISE 0.6272713450233213

/* Sum of four uniforms, mean 0 and variance 1. */
static double nearly_normal(const fl_strip_law *law, int32_t floe, int32_t region, int64_t node)
{
    fl_rng g =
        fl_rng_of(law->seed, fl_rng_entity4(floe, region, (int32_t)(node >> 31), (int32_t)(node & INT32_MAX)),
                  FL_RNG_STRIP_STRENGTH);
    double sum = -2.0;
    for (int k = 0; k < 4; k++) sum += fl_rng_unit(&g);
    return sqrt(3.0) * sum;
}

double fl_strip_strength_at(fl_strip_strength *s, const fl_strip_law *law, double scatter, double length,
                            double way, int32_t floe, int32_t region)
{
    const double at = way / (0.25 * length), node = floor(at);
    if (s->node < 0) {
        s->node = 0;
        s->y0 = nearly_normal(law, floe, region, 0);
        s->y1 = NODE_CORRELATION * s->y0 + NODE_NOISE * nearly_normal(law, floe, region, 1);
    }
    while ((double)s->node < node) {
        s->node++;
        s->y0 = s->y1;
        s->y1 = NODE_CORRELATION * s->y0 + NODE_NOISE * nearly_normal(law, floe, region, s->node + 1);
    }
    const double part = at - (double)s->node, factor = 1.0 + scatter * (s->y0 + part * (s->y1 - s->y0));
    return factor > 0.1 ? factor : 0.1;
}
