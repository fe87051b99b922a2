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
 * Masses are fictitious: any that keep every frequency below 2/dt lead to the same rest. */
#ifndef FL_BODY_RELAXATION_H
#define FL_BODY_RELAXATION_H

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

#endif
