/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strip.h -- crushing that depends on speed: elements of ice in front of a wall, which creep, load and break.
 *
 * An element has a depth e of the wall in its ice, less creep (below 0: a gap), and a delayed strain u [m]:
 *     z = max(0, e - u),       pressure k z,       k = R p/delta
 *     e' = w - v_t (z/delta)^n,                    w  closing speed of wall and ice
 *     u' = (z/kappa - u)/tau
 *     z >= delta: the element breaks, u = 0, e = -r, r uniform in (0, (R - 2) delta)
 *
 *   p      mean pressure of fast crushing [Pa]; R p is the pressure at which an element breaks
 *   delta  deflection at which it breaks [m]
 *   v_t    speed up to which ice creeps and does not break [m/s]
 *   n      exponent of creep, 1 or 3
 *   kappa  stiffness of the delayed part over that of the spring; 0: no delayed part
 *   tau    its time [s]
 *
 * For w much above v_t the mean pressure is p (1 + b/w),
 *     b = v_t (1 + n/(n + 2) - 2/R)/(n + 1) + (2/3 - 1/R) delta/(kappa tau),
 * it falls with speed, and so a structure can vibrate by itself: fl_strip_negative_damping().
 *
 * A step of dt, h = dt/2, is the trapezoidal rule (order 2, stable); a break is placed within the step, so
 * that its time has no bias. For one element the work of the mean force is
 *     k (z0 + z1)/2 dq = d(k z^2/2 + k kappa u^2/2) + creep + delayed part,   the last two at least 0,
 * exactly; at a break both stores are lost.
 *
 * Limits: dq <= delta/5 a step, else breaks are too few; no temperature, no rubble.
 * Source: Hendrikse & Metrikine, Mar. Struct. 41 (2015) 129; Hendrikse & Nord, Mar. Struct. 65 (2019) 336. */
#ifndef FL_FAILURE_STRIP_H
#define FL_FAILURE_STRIP_H
#include <stdint.h>
#include "base/rng.h"

typedef struct {
    double peak_ratio; /* R */
    double delta, transition_speed;
    int32_t creep_exponent;
    double kappa, tau;
    uint64_t seed;
} fl_strip_law;

typedef struct {
    double e, u;   /* [m] */
    int32_t count; /* breaks so far */
} fl_strip_element;

/* Factors of a step of dt. */
typedef struct {
    const fl_strip_law *law;
    double h, over_delta, creep; /* creep: v_t h */
    double g, keep, a; /* 1/(1 + h/tau), 1 - h/tau, 1/(kappa tau); 1, 1 and 0 without delayed part */
    double gap;        /* largest r [m] */
} fl_strip_step;

fl_strip_step fl_strip_step_of(const fl_strip_law *law, double dt);

static inline double fl_strip_deflection(const fl_strip_element *s)
{
    return s->e > s->u ? s->e - s->u : 0.0;
}

/* The gap of an element after its breaks so far; entity: that of (floe, region, sector, count) [m]. */
double fl_strip_gap(const fl_strip_law *law, int64_t entity);

/* What an element is, for its random numbers. */
typedef struct {
    int32_t floe, region, sector;
} fl_strip_id;

/* Breaks the element, whose wall is `rest` further on. */
void fl_strip_break(const fl_strip_law *law, fl_strip_element *s, double rest, fl_strip_id id);

/* h v_t (z/delta)^n. */
static inline double fl_strip_creep(const fl_strip_step *t, double z)
{
    const double x = z * t->over_delta;
    return t->creep * (t->law->creep_exponent == 1 ? x : x * x * x);
}

/* z at the end, the root of z (1 + h a g) + h c(z) = rhs. */
static inline double fl_strip_root(const fl_strip_step *t, double z, double rhs)
{
    const double line = 1.0 + t->h * t->a * t->g;
    if (!(rhs > 0.0)) return 0.0;
    if (t->law->creep_exponent == 1) return rhs / (line + t->creep * t->over_delta);
    for (int pass = 0; pass < 2; pass++) {
        const double x = z * t->over_delta;
        z -= (z * line + t->creep * x * x * x - rhs) / (line + 3.0 * t->creep * t->over_delta * x * x);
    }
    return z;
}

/* Advances an element by a step in which the wall closes by dq [m].  Returns the number of its breaks. */
static inline int32_t fl_strip_advance(const fl_strip_step *t, fl_strip_element *s, double dq, fl_strip_id id)
{
    const double z0 = fl_strip_deflection(s);
    if (z0 == 0.0 && s->u == 0.0 && s->e + dq <= 0.0) { /* a gap */
        s->e += dq;
        return 0;
    }
    const double c0 = fl_strip_creep(t, z0), old = s->u * t->keep;
    const double rhs = s->e + dq - c0 - t->g * (old + t->h * t->a * z0), z1 = fl_strip_root(t, z0, rhs);
    if (z1 >= t->law->delta) {
        const int32_t before = s->count;
        fl_strip_break(t->law, s, dq * (1.0 - (t->law->delta - z0) / (z1 - z0)), id);
        return s->count - before;
    }
    s->u = t->g * (old + t->h * t->a * (z0 + z1));
    s->e += dq - (c0 + fl_strip_creep(t, z1));
    return 0;
}

/* Energy of the element over k [m2]. */
static inline double fl_strip_store(const fl_strip_law *law, const fl_strip_element *s)
{
    const double z = fl_strip_deflection(s);
    return 0.5 * (z * z + law->kappa * s->u * s->u);
}

/* b of a flat wall; pi/2 times that on a round one [m/s]. */
double fl_strip_negative_damping(const fl_strip_law *law);

/* Speed below which a mode is unstable under the mean force F of fast crushing, sqrt(F b/(2 zeta omega m))
 * [m/s]; INFINITY without damping. */
double fl_strip_lock_in_speed(double F, double b, double ratio, double omega, double mass);

/* Strength along the drift: max(0.1, 1 + s y), y of variance 1 at nodes a quarter of the correlation length
 * apart, with correlation exp(-1/4) from node to node, linear in between. */
typedef struct {
    int64_t node;  /* the last one passed; -1: none */
    double y0, y1; /* at node, and at the next */
} fl_strip_strength;

/* Factor after the ice has moved by `way` [m] in all. */
double fl_strip_strength_at(fl_strip_strength *s, const fl_strip_law *law, double scatter, double length,
                            double way, int32_t floe, int32_t region);

#endif
