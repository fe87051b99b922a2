/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_force.h -- the forces of one pair of things, where they touch. */
#ifndef FL_CONTACT_PAIR_FORCE_H
#define FL_CONTACT_PAIR_FORCE_H
#include "world/world.h"

/* Evaluate pair p at the positions and velocities of the bodies: its wrenches, energies and memory.
 *   thread   whose scratch to use
 *   dt       the step just drifted, over which places have slipped [s]; 0 at the start
 *   survey   also compute stiff_i, stiff_j
 * Of those that are too far apart to touch since they were last looked at, fl_next_check_pending(), nothing needs to
 * be asked.  A pair that runs out of memory sets w->failed. */
void fl_pair_evaluate(fl_world *w, fl_pair *p, int32_t thread, double dt, int survey);

/* The same by a look; t: what was told for this pose, or NULL. */
void fl_pair_evaluate_exact(fl_world *w, fl_pair *p, int32_t thread, const fl_surrogate_value *t, double dt,
                            int survey);

/* Look again at a pair with a surrogate as it stood when it was looked at last, M and o taking i to j, and
 * tell its surrogate what is found; what it has learnt is there already.  -1 when memory runs out. */
int fl_pair_rebuild_surrogate(fl_world *w, fl_pair *p, const fl_mat3 *M, fl_vec3 o);

#endif
