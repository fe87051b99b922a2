/* SPDX-License-Identifier: GPL-3.0-or-later */
/* relaxation.h -- damping that brings a mechanical system to rest, for static answers by time steps.
 *
 * The step of a freedom with mass m, force f and velocity v, of which the next displacement is dt v:
 *     v <- c1 v + c2 dt f/m,    c1 = (1 - c/2)/(1 + c/2),    c2 = 1/(1 + c/2)
 * The first step from rest takes half of c2, since velocities stand half a step after positions.  Without
 * that the steps of kinetic damping, which often begins from rest, are unstable at 0.7 of the largest step
 * of the free motion.
 *
 *   kinetic   c = 0; all velocities become 0 whenever the kinetic energy falls.  Needs no setting; does not
 *             settle where the iteration has complex eigenvalues, as the arc length near a snap-back.
 *   adaptive  c = 2 a dt sqrt(u.dF / u.M u), u the last displacement and dF the change of the internal force
 *             over it: a times the critical damping of the frequency that the motion has, at most 1/2,
 *             smoothed 0.98 : 0.02 (Underwood, Dynamic relaxation, 1983).  a = 0.7.
 *   viscous   c constant.
 *
 * FIRE, for a minimum of an energy E(x) whose freedoms are free of each other (packings): masses m, force f,
 *     P = f.v;  P > 0 for more than 5 steps: dt <- min(1.1 dt, dt_most), a <- 0.99 a
 *               P <= 0: x <- x - dt v / 2, v <- 0, dt <- max(dt / 2, dt_least), a <- 0.1
 *     v <- v + dt f/m,   v <- (1 - a) v + a |v|/|f| f/m,   x <- x + dt v,
 * with |v|^2 = sum v.v m and |f|^2 = sum f.f/m.  Settles faster than the others from far away, and needs no
 * frequency; it does not follow the motion.  Sources: Bitzek et al., Phys. Rev. Lett. 97 (2006) 170201;
 * Guenole et al., Comput. Mater. Sci. 175 (2020) 109584 (the half step back).
 *
 * Masses are fictitious: any that keep every frequency below 2/dt lead to the same rest. */
#ifndef FL_BODY_RELAXATION_H
#define FL_BODY_RELAXATION_H
#include <stdint.h>

enum fl_relaxation_kind { FL_RELAXATION_KINETIC, FL_RELAXATION_ADAPTIVE, FL_RELAXATION_VISCOUS };

typedef struct {
    enum fl_relaxation_kind kind;
    double c;       /* of the next step */
    double kinetic; /* energy after the last step, 0 after velocities were set to 0 */
    int fresh;      /* no step was made since the start: adaptive damping has no estimate */
    int rests;      /* velocities are 0 */
} fl_relaxation;

/* Of a system at rest.  c is used by FL_RELAXATION_VISCOUS alone, 0 < c < 2. */
fl_relaxation fl_relaxation_start(enum fl_relaxation_kind kind, double c);

static inline double fl_relaxation_c1(const fl_relaxation *r)
{
    return (1.0 - 0.5 * r->c) / (1.0 + 0.5 * r->c);
}
static inline double fl_relaxation_c2(const fl_relaxation *r)
{
    return (r->rests ? 0.5 : 1.0) / (1.0 + 0.5 * r->c);
}

/* Before a step: damping from the last one.
 *   work   u.dF, of all freedoms
 *   inertia  u.M u
 *   dt     step */
void fl_relaxation_adapt(fl_relaxation *r, double work, double inertia, double dt);

/* After every step, with the kinetic energy it ended with: 1 when all velocities have to become 0. */
int fl_relaxation_peak(fl_relaxation *r, double kinetic);

typedef struct {
    double dt, dt_most, dt_least, mix; /* mix: a */
    int32_t downhill;                  /* steps since the last reversal */
} fl_fire;

/* What a step does to the velocities: v <- keep v + push dt f/m before x <- x + dt v.  back > 0: first
 * x <- x - back v, and keep is 0. */
typedef struct {
    double dt, keep, push, back;
} fl_fire_step;

/* Of a system at rest.  dt_most: below 2 over the largest frequency. */
fl_fire fl_fire_start(double dt_most);

/* The next step.
 *   power    sum f.v
 *   force2   sum f.f/m
 *   speed2   sum v.v m */
fl_fire_step fl_fire_next(fl_fire *r, double power, double force2, double speed2);

#endif
