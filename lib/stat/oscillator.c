/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/pi.h"
#include "stat/oscillator.h"

/* Steps per period in the first solution: the error of the period is then 0.1 %. */
static const double FIRST_STEPS = 32.0;

void fl_oscillator_set_acceleration(const fl_oscillator *o, double load, fl_oscillator_state *s)
{
    const double w = 2.0 * PI * o->frequency;
    s->a = w * w * (load - s->u) - 2.0 * o->damping * w * s->v;
}

void fl_oscillator_step(const fl_oscillator *o, double h, double load, fl_oscillator_state *s)
{
    const double w = 2.0 * PI * o->frequency, z = o->damping;
    const double u = s->u + h * s->v + 0.25 * h * h * s->a, v = s->v + 0.5 * h * s->a;
    const double a = (w * w * (load - u) - 2.0 * z * w * v) / (1.0 + z * w * h + 0.25 * w * w * h * h);
    s->u = u + 0.25 * h * h * a;
    s->v = v + 0.5 * h * a;
    s->a = a;
}

static void update_largest(fl_response *r, double u, double t)
{
    if (!(fabs(u) > r->largest)) return;
    r->largest = fabs(u);
    r->t_largest = t;
}

/* Within a step the acceleration is constant, so the response has its extreme at h v0 / (v0 - v1). */
static void update_largest_in_step(fl_response *r, const fl_oscillator_state *from,
                                   const fl_oscillator_state *to, double t, double h)
{
    if (from->v * to->v < 0.0) {
        const double part = from->v / (from->v - to->v);
        update_largest(r, from->u + 0.5 * part * h * from->v, t + part * h);
    }
    update_largest(r, to->u, t + h);
    r->largest_acceleration = fmax(r->largest_acceleration, fmax(fabs(from->a), fabs(to->a)));
}

/* West's update of mean and variance, weighted with the step; std holds the sum of squares until the end. */
static void update_moments(fl_response *r, double u, double t, double h)
{
    const double far = u - r->mean;
    r->mean += far * h / t;
    r->std += h * far * (u - r->mean);
}

static double steps_of(const fl_oscillator *o, double length, double steps)
{
    return fmax(1.0, ceil(length * o->frequency * steps));
}

void fl_oscillator_integrate(const fl_oscillator *o, int32_t n, const double *edge, const double *x,
                             double steps, int32_t times, fl_response *r, fl_oscillator_state *at)
{
    fl_oscillator_state s = {.u = x[0]};
    *r = (fl_response){.error = NAN};
    update_largest(r, s.u, edge[0]);
    for (int32_t k = 0; k < n; k++) {
        const double length = edge[k + 1] - edge[k];
        const int64_t m = (int64_t)steps_of(o, length, steps) * times;
        const double h = length / (double)m;
        r->step = fmax(r->step, h);
        fl_oscillator_set_acceleration(o, x[k], &s);
        for (int64_t j = 0; j < m; j++) {
            const fl_oscillator_state from = s;
            fl_oscillator_step(o, h, x[k], &s);
            update_largest_in_step(r, &from, &s, edge[k] + h * (double)j, h);
            update_moments(r, s.u, edge[k] - edge[0] + h * (double)(j + 1), h);
        }
        if (at) at[k] = s;
    }
    r->std = sqrt(r->std / (edge[n] - edge[0]));
}

int fl_oscillator_solve(const fl_oscillator *o, int32_t n, const double *edge, const double *x,
                        fl_response *r, fl_oscillator_state *at, fl_err *err)
{
    double steps = 0.0, before;
    for (int32_t k = 0; k < n; k++) steps += steps_of(o, edge[k + 1] - edge[k], FIRST_STEPS);
    if (!(steps <= FL_OSCILLATOR_MAX_STEPS))
        return fl_fail(err, FL_INPUT,
                       "an oscillator of %g Hz needs %.3g steps for the record of %g s, expected at most %g",
                       o->frequency, steps, edge[n] - edge[0], FL_OSCILLATOR_MAX_STEPS);
    fl_oscillator_integrate(o, n, edge, x, FIRST_STEPS, 1, r, at);
    for (int k = 1; k <= FL_OSCILLATOR_MAX_HALVINGS; k++) {
        before = r->largest;
        fl_oscillator_integrate(o, n, edge, x, FIRST_STEPS, 1 << k, r, at);
        r->error = r->largest > 0.0 ? fabs(r->largest - before) / 3.0 / r->largest : 0.0;
        if (r->error <= FL_OSCILLATOR_TOLERANCE) break;
    }
    return 0;
}

int fl_oscillator_near_frequency(const fl_oscillator *o, double frequency)
{
    return fabs(frequency - o->frequency) < FL_LOCK_IN_RANGE * o->frequency;
}
