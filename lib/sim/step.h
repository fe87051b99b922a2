/* SPDX-License-Identifier: GPL-3.0-or-later */
/* step.h -- one time step of a world.
 *
 * From time t to t + dt, with h = dt/2:
 *     drag h, kick h, drift dt, forces, kick h, drag h        (velocity Verlet, drag split off).
 * Contacts use the mean velocities of the step and predict those of its end (contact/velocity_predictor.h),
 * so the method is of order 2.  Of order 1 in their own share are: the damping of bonds, of spheres in
 * concave edges, and of contact laws other than `patch`.  The works are booked by energy_ledger.h. */
#ifndef FL_SIM_STEP_H
#define FL_SIM_STEP_H
#include "world/world.h"

/* Compute the neighbour list and all forces at the start, and the reference of the energy ledger.  w->dt must
 * be set.  -1 with FL_SYSTEM, or FL_NUMERIC when a number is not finite. */
int fl_step_start(fl_world *w, fl_err *err);

/* Advance w by one step. -1 with FL_SYSTEM, or with FL_NUMERIC, which names body and step, if
 *     a number is not finite,
 *     the step is above the critical step, or
 *     an overlap above FL_DEEP_OVERLAP creates energy: the residual is more than 1 % of the throughput plus
 *         the energy stored in contacts. */
int fl_step(fl_world *w, fl_err *err);

/* Use steps of dt from now on.  t: the time now without the rounding of fl_world_time() [s]. */
void fl_step_set_size(fl_world *w, double dt, double t);

#endif
