/* SPDX-License-Identifier: GPL-3.0-or-later */
/* oscillator.h -- what a load does to a structure that sways in one mode.
 *
 *     m x'' + c x' + k x = F(t),  w^2 = k / m,  z = c / (2 m w)
 * is solved for the response u = k x in the unit of the load, the load that would give x if it stood still:
 *     u'' + 2 z w u' + w^2 u = w^2 F(t).
 * F is constant over each interval of the record; at its ends the acceleration jumps with it.
 *
 * Steps are those of Newmark with beta = 1/4, gamma = 1/2 (the acceleration is its mean over the step):
 *     u1 = u0 + h v0 + h^2/4 (a0 + a1),  v1 = v0 + h/2 (a0 + a1),
 *     a1 = (w^2 (F - u0 - h v0 - h^2/4 a0) - 2 z w (v0 + h/2 a0)) / (1 + z w h + w^2 h^2/4).
 * They are stable for any h, lose no amplitude, and make the period longer by (w h / 2) / atan(w h / 2), a
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

/* One step of length h [s] under a constant load; s->a is that at the start of the step under this load, see
 * fl_oscillator_set_acceleration(). */
void fl_oscillator_step(const fl_oscillator *o, double h, double load, fl_oscillator_state *s);

/* Set the acceleration to what the load leaves: where a step begins under a load that has changed. */
void fl_oscillator_set_acceleration(const fl_oscillator *o, double load, fl_oscillator_state *s);

typedef struct {
    double largest, t_largest;   /* max |u| within the steps, and when */
    double largest_acceleration; /* max |u''| at their ends, with u'' on either side of a jump of the load */
    double mean, std;            /* of u over time, at the ends of the steps */
    double step;                 /* the longest [s] */
    double error;                /* of largest, over largest; see fl_oscillator_solve() */
} fl_response;

/* The response to x[k] over edge[k] .. edge[k + 1], k = 0 .. n - 1, from rest in the place where x[0] holds
 * it. Each interval takes the least number of steps with `steps` or more to a period, times `times`. at[n]
 * out: the state at the end of each interval, under the load of it; may be NULL Cannot fail. */
void fl_oscillator_integrate(const fl_oscillator *o, int32_t n, const double *edge, const double *x,
                             double steps, int32_t times, fl_response *r, fl_oscillator_state *at);

/* The same with as many steps as it takes: they are halved until the largest response changes by less than
 * 3 FL_OSCILLATOR_TOLERANCE of itself, which is three times the error that is left by a method of second order;
 * that error is told, also where FL_OSCILLATOR_MAX_HALVINGS were not enough.
 * 0, or -1 with FL_INPUT in err when the first solution would already take more than FL_OSCILLATOR_MAX_STEPS
 * steps. */
#define FL_OSCILLATOR_TOLERANCE 1e-4
#define FL_OSCILLATOR_MAX_STEPS 1e8
enum { FL_OSCILLATOR_MAX_HALVINGS = 6 };
int fl_oscillator_solve(const fl_oscillator *o, int32_t n, const double *edge, const double *x,
                        fl_response *r, fl_oscillator_state *at, fl_err *err);

/* Is a load of this dominant frequency near the natural one, |f - fn| < FL_LOCK_IN_RANGE fn?  Then the motion may
 * take hold of the breaking of the ice, which a load that was found on a structure at rest does not know of.
 * 0 for a frequency that is NAN.  Source: the range that is usual in practice, as ISO 19906 A.8.2.6 asks to
 * look for frequency lock-in near a natural frequency. */
#define FL_LOCK_IN_RANGE 0.1
int fl_oscillator_near_frequency(const fl_oscillator *o, double frequency);

#endif
