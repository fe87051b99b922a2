/* SPDX-License-Identifier: GPL-3.0-or-later */
/* oscillator.h -- response of a damped oscillator, one mode of a structure, to a load record.
 *
 *     m x'' + c x' + k x = F(t),  w^2 = k / m,  z = c / (2 m w)
 * is solved for the response u = k x, the static load that gives the same x [unit of the load]:
 *     u'' + 2 z w u' + w^2 u = w^2 F(t).
 * F is constant over each interval of the record; at its ends the acceleration jumps with it.
 *
 * Steps are those of Newmark with beta = 1/4, gamma = 1/2 (the acceleration is its mean over the step):
 *     u1 = u0 + h v0 + h^2/4 (a0 + a1),  v1 = v0 + h/2 (a0 + a1),
 *     a1 = (w^2 (F - u0 - h v0 - h^2/4 a0) - 2 z w (v0 + h/2 a0)) / (1 + z w h + w^2 h^2/4).
 * They are stable for any h, have no amplitude error, and lengthen the period by (w h / 2) / atan(w h / 2), a
 * second-order error.  Source: Newmark 1959, J. Eng. Mech. Div. ASCE 85:67; Chopra, Dynamics of Structures
 * (2012), ch. 5. */
#ifndef FL_STAT_OSCILLATOR_H
#define FL_STAT_OSCILLATOR_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    double frequency; /* w / (2 pi), > 0 [Hz] */
    double damping;   /* z, >= 0; 1 is critical */
} fl_oscillator;

/* Response, its rate and its second derivative [unit, unit/s, unit/s^2]. */
typedef struct {
    double u, v, a;
} fl_oscillator_state;

/* One step of length h [s] under a constant load.  s->a is the acceleration at the start of the step under
 * this load, see fl_oscillator_set_acceleration(). */
void fl_oscillator_step(const fl_oscillator *o, double h, double load, fl_oscillator_state *s);

/* Compute the acceleration under a load: needed where a step begins with a changed load. */
void fl_oscillator_set_acceleration(const fl_oscillator *o, double load, fl_oscillator_state *s);

typedef struct {
    double largest, t_largest; /* max |u|, within steps too, and its time */
    double
        largest_acceleration; /* max |u''| at the ends of the steps, on either side of a jump of the load */
    double mean, std;         /* of u over time, at the ends of the steps */
    double step;              /* longest step [s] */
    double error;             /* relative error of largest; see fl_oscillator_solve() */
} fl_response;

/* The response to x[k] over edge[k] .. edge[k + 1], k = 0 .. n - 1, from rest in static equilibrium with
 * x[0]. Each interval takes the least number of steps with `steps` or more per period, times `times`.
 *   at[n]   out: the state at the end of each interval, under its load; may be NULL
 * Cannot fail. */
void fl_oscillator_integrate(const fl_oscillator *o, int32_t n, const double *edge, const double *x,
                             double steps, int32_t times, fl_response *r, fl_oscillator_state *at);

/* The same with automatic steps: they are halved until the largest response changes by less than 3
 * FL_OSCILLATOR_TOLERANCE of itself.  For a second-order method this is three times the remaining error,
 * which r->error returns, also where FL_OSCILLATOR_MAX_HALVINGS were not enough. 0, or -1 with FL_INPUT in
 * err when the first solution would need more than FL_OSCILLATOR_MAX_STEPS steps. */
#define FL_OSCILLATOR_TOLERANCE 1e-4
#define FL_OSCILLATOR_MAX_STEPS 1e8
enum { FL_OSCILLATOR_MAX_HALVINGS = 6 };
int fl_oscillator_solve(const fl_oscillator *o, int32_t n, const double *edge, const double *x,
                        fl_response *r, fl_oscillator_state *at, fl_err *err);

/* True if the dominant frequency of a load is near the natural one, |f - fn| < FL_LOCK_IN_RANGE fn.
 * Frequency lock-in of ice failure and motion is then possible, and a load computed on a structure at rest
 * does not contain it.  0 for a frequency NAN.  Source: the range that is usual in practice, as ISO 19906
 * A.8.2.6 requires a check for frequency lock-in near a natural frequency. */
#define FL_LOCK_IN_RANGE 0.1
int fl_oscillator_near_frequency(const fl_oscillator *o, double frequency);

#endif
