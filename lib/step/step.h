/* SPDX-License-Identifier: GPL-3.0-or-later */
/* step.h -- one time step. */
#ifndef FL_STEP_STEP_H
#define FL_STEP_STEP_H
#include "step/world.h"

/* Forces at the start: neighbours, contacts, surroundings, and the reference of the ledger.  w->dt must be
 * set. -1 with FL_SYSTEM, or FL_NUMERIC when something is not finite. */
int fl_step_start(fl_world *w, fl_err *err);

/* From time t to t + dt:
 *     drag h, kick h, drift dt, forces, kick h, drag h,     h = dt/2.
 * Contacts see the velocities in the middle of the step, and foresee those of its end (lead.h): order 2, but
 * for damping of bonds, of balls in grooves and by other laws than `patch`, which is of order 1 in its own
 * share.  Works are booked by works.h.  -1 with FL_SYSTEM, or FL_NUMERIC when a number is not finite, the
 * step is above the critical one, or overlaps past FL_OVERLAP_HALF make energy (the residual is more than 1 %
 * of the throughput and of what contacts store): body and step are named. */
int fl_step(fl_world *w, fl_err *err);

/* From here on, steps of dt; t is what the clock shows now, fl_world_time() but for its rounding. [s] */
void fl_step_resize(fl_world *w, double dt, double t);

/* Force and torque on thing k into b.f[k], b.t[k]: weight, water, then its pairs in the order of the list,
 * whichever thread takes it. */
void fl_step_gather(fl_world *w, int32_t k);

/* Parts of a step, of floe k alone: drag s/2, kick s/2, drift s; force and torque of weight, water and
 * springs; those of its pairs besides (1 when it touches anything, with what damping and friction do in
 * sink[k]); a kick of h. */
void fl_step_out(fl_world *w, int32_t k, double s);
void fl_step_soft(fl_world *w, int32_t k);
int fl_step_press(fl_world *w, int32_t k);
void fl_step_kick(fl_world *w, int32_t k, double h);

/* Stores, sinks and residual now, into w->ledger. */
void fl_step_ledger(fl_world *w);

/* The same; -1 with FL_NUMERIC where the residual is not a number, or, once an overlap was past half of the
 * radii, tells that energy is being made. */
int fl_step_balance(fl_world *w, fl_err *err);

/* The residual over the throughput, both as in w->ledger.  Where that is more than FL_STEP_USABLE, up to
 * which dem-solve(1) calls loads usable, but no more than the rounding of what is stored, as of floes at
 * rest, 0.  Infinite or no number where the energies are, or where nothing has gone through yet. */
#define FL_STEP_USABLE 1e-2
double fl_step_off(const fl_world *w);

/* What is stored, of any sign [J]. */
double fl_step_stored(const fl_world *w);

/* Whether energy was made or lost: more than FL_STEP_USABLE of the throughput and of what contacts store. */
int fl_step_unbalanced(const fl_world *w);

/* Hash of positions, orientations, velocities and angular momenta of all floes, and of what of the structure
 * moves by itself. */
uint64_t fl_step_hash(const fl_world *w);

#endif
