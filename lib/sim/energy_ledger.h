/* SPDX-License-Identifier: GPL-3.0-or-later */
/* energy_ledger.h -- the works of a step: damping, friction, prescribed motions.
 *
 * Kick, drift, kick has the velocity v = (x1 - x-1)/2dt at the ends of steps, which is x' + dt^2 x'''/6.
 * So the sum of dt F.v misses the work of a force F that follows the motion by (omega dt)^2/6 of it,
 * always with the same sign.  With the accelerations a at both ends (0, 1) of a step, which are known,
 * the work is
 *     W = dt/2 (F0.v0 + F1.v1) + dt^2/12 (F1.a0 - F0.a1) - dt^2/6 (F1.a1 - F0.a0),
 * and the same for torques: of order 4 from the begin of a contact to its end.  During a contact a term
 * -dt^2/12 (F1'.v1 - F0'.v0) is missing, which vanishes when the contact ends. Source: Euler-Maclaurin
 * sum of F.x' and, by parts, of F.x'''. */
#ifndef FL_SIM_ENERGY_LEDGER_H
#define FL_SIM_ENERGY_LEDGER_H
#include "world/access.h"

typedef struct {
    double damping, friction, drive; /* [J] */
} fl_work;

/* Allocate the contact sums of all things, empty.  -1 with FL_SYSTEM. */
int fl_contact_sums_make(fl_world *w, fl_err *err);
void fl_contact_sums_free(fl_world *w);

/* Give a slot of w->contact_sums to every thing that touches, by w->body_touches, or to all.  The sums
 * are then undefined until they are computed, unless all have a slot.  w->failed if memory runs out. */
void fl_contact_sums_assign(fl_world *w);

/* Compute the contact sum of thing k over its touching pairs, in their order, and its bonds. */
void fl_contact_sums_recompute(fl_world *w, int32_t k);

/* Before a step: the sums become those of the step before, also for spheres.  For pieces that move freely the
 * velocity change of the first kick is stored. */
void fl_ledger_begin_step(fl_world *w);

/* Works of damping and friction on thing k in the step that has ended.
 *   first, back  velocity changes by the first and by the last kick of the step
 * Without contacts at its begin neither is read, and `first` may be NULL; of a sphere both are always
 * read. */
fl_work fl_work_of_step(const fl_world *w, int32_t k, const fl_velocity_change *first,
                        const fl_velocity_change *back);

/* Add the works of all blocks and of the moving structure to the ledger, with those of the half kick to
 * come. */
void fl_ledger_book_step(fl_world *w);

/* The part of the booked works that is still to come: dt/2 F1.v1 and the last term above.  Booked works less
 * these are the works done until now. */
fl_work fl_work_ahead(const fl_world *w);

/* Adds the part of thing k to it, but for the drive. */
void fl_work_ahead_add(const fl_world *w, int32_t k, fl_work *sum);

#endif
