/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_force.h -- force, torques, energy and memory of a pair of bodies that touch. */
#ifndef FL_CONTACT_PAIR_FORCE_H
#define FL_CONTACT_PAIR_FORCE_H
#include "world/world.h"

/* Evaluates pair p at the present positions and velocities, by its surrogate if that applies.  A pair that
 * cannot touch yet, !fl_pair_may_touch(), need not be evaluated.
 *   thread   index of the scratch memory to use
 *   dt       the step whose drift is done, in which the contact has slipped [s]; 0 at the start
 *   survey   also compute omega2_i and omega2_j
 * Sets w->failed when memory runs out. */
void fl_pair_evaluate(fl_world *w, fl_pair *p, int32_t thread, double dt, int survey);

/* The same without the surrogate.  t: value of the surrogate for this pose, or NULL. */
void fl_pair_evaluate_exact(fl_world *w, fl_pair *p, int32_t thread, const fl_surrogate_value *t, double dt,
                            int survey);

/* Records contact p, which begins, if it is deeper than the bodies have moved in the step, `moved` [m], but
 * for the rim of faces, which may be so much deeper, and for rounding. */
void fl_pair_note_beginning(fl_world *w, const fl_pair *p, double moved);

#endif
