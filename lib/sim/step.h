/* SPDX-License-Identifier: GPL-3.0-or-later */
/* step.h -- one time step. */
#ifndef FL_SIM_STEP_H
#define FL_SIM_STEP_H
#include "world/world.h"

/* Forces at the start: neighbours, contacts, surroundings, and the reference of the ledger.  w->dt must be
 * set. -1 with FL_SYSTEM, or FL_NUMERIC when something is not finite. */
int fl_step_start(fl_world *w, fl_err *err);

/* From time t to t + dt:
 *     drag h, kick h, drift dt, forces, kick h, drag h,     h = dt/2.
 * Contacts see the velocities in the middle of the step, and foresee those of its end (velocity_predictor.h): order 2, but
 * for damping of bonds, of balls in grooves and by other laws than `patch`, which is of order 1 in its own
 * share.  Works are booked by energy_ledger.h.  -1 with FL_SYSTEM, or FL_NUMERIC when a number is not finite, the
 * step is above the critical one, or overlaps past FL_DEEP_OVERLAP make energy (the residual is more than 1 %
 * of the throughput and of what contacts store): body and step are named. */
int fl_step(fl_world *w, fl_err *err);

/* From here on, steps of dt; t is what the clock shows now, fl_world_time() but for its rounding. [s] */
void fl_step_set_size(fl_world *w, double dt, double t);

#endif
