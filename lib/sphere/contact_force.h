/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact_force.h -- forces of sphere contacts. */
#ifndef FL_SPHERE_CONTACT_FORCE_H
#define FL_SPHERE_CONTACT_FORCE_H
#include "world/world.h"

/* Let rows see where bodies [from, to) are and how they move: whenever that has changed, before a touch; in
 * a step of 2h [s] whose first half is over, the forces being those of its begin. */
void fl_sphere_states_update(fl_world *w, int32_t from, int32_t to, double h);

/* The rows of chunk a, by what they see of bodies, over a step of dt [s]; survey: also bounds of omega^2.
 * dt < 0: nothing moves and nothing is evaluated, the sums are made again from what the rows hold.  Any
 * thread may take any chunk; when all are done fl_sphere_sums_collect() gives the bodies [from, to) the rest of
 * their sums, once. */
void fl_sphere_chunk_evaluate(fl_world *w, int32_t a, double dt, int survey);

void fl_sphere_sums_collect(fl_world *w, int32_t from, int32_t to);

/* The first chunk of part t of `parts`, of about equal work; of t = parts that behind the last. */
int32_t fl_sphere_chunk_share(const fl_world *w, int t, int parts);

#endif
