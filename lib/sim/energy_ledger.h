/* SPDX-License-Identifier: GPL-3.0-or-later */
/* energy_ledger.h -- what damping and friction take out, and what moves as it is told puts in.
 *
 * With v = (x1 - x-1)/2dt, as kick, drift, kick has it at the ends of steps, x' = v - dt^2 x'''/6, and the
 * sum of dt F.v misses the work of a force F that follows the motion by (omega dt)^2/6 of it, always to the
 * same side.  From the accelerations a at both ends of a step (0, 1), which are known, the work of it is
 *     W = dt/2 (F0.v0 + F1.v1) + dt^2/12 (F1.a0 - F0.a1) - dt^2/6 (F1.a1 - F0.a0),
 * and the same of torques: of order 4 from the begin of a contact to its end.  In between a term
 * -dt^2/12 (F1'.v1 - F0'.v0) is left out, which is gone when the contact is.  Derived from Euler and
 * Maclaurin's sum of F.x' and, by parts, of F.x'''. */
#ifndef FL_SIM_ENERGY_LEDGER_H
#define FL_SIM_ENERGY_LEDGER_H
#include "world/access.h"

typedef struct {
    double damping, friction, drive; /* [J] */
} fl_work;

/* Arrays for total things, with nothing in them.  -1 with FL_SYSTEM. */
int fl_contact_sums_make(fl_world *w, fl_err *err);
void fl_contact_sums_free(fl_world *w);

/* A sink for each that is of a pair that touches now, w->live; w->failed when memory runs out.  What was in
 * those of now has lost all sense where not all have one. */
void fl_contact_sums_assign(fl_world *w);

/* Sum up what damping and friction do to thing k, over its touching pairs in their order, into its sink. */
void fl_contact_sums_recompute(fl_world *w, int32_t k);

/* Before a step: sink becomes was, so it is with the sums of spheres, and the gains of pieces of a structure
 * that moves by itself are what the first kick will give them. */
void fl_ledger_begin_step(fl_world *w);

/* The works of the step that has ended in thing k: sink acts now and was at its begin, `first` is what its
 * first kick changed, `back` its last, velocities are those of now.  Where nothing pressed at the begin
 * neither is read, and `first` may be NULL; but of spheres both always are, for the sums of their rows. */
fl_work fl_work_of_step(const fl_world *w, int32_t k, const fl_velocity_change *first,
                        const fl_velocity_change *back);

/* Those of all groups and of what of the structure moves into the ledger, with the half kick that lies ahead.
 */
void fl_ledger_book_step(fl_world *w);

/* What of the booked lies ahead: dt/2 F1.v1, and the last term above for what comes after [J].  Booked less
 * this is what has been done. */
fl_work fl_work_ahead(const fl_world *w);

#endif
