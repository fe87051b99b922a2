/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact_force.h -- forces of sphere contacts and their sums over bodies.
 *
 * Bodies are divided into chunks by number (world/sphere_contacts.h).  The steps are, in this order:
 *     fl_sphere_states_update()   for all bodies, in any split among threads
 *     fl_sphere_chunk_evaluate()  for all chunks, in any split
 *     fl_sphere_sums_collect()    once for each body */
#ifndef FL_SPHERE_CONTACT_FORCE_H
#define FL_SPHERE_CONTACT_FORCE_H
#include "world/world.h"

/* Copies pose, velocity and predicted change of bodies [from, to) to w->spheres.state, where contacts read
 * them.  It is due whenever these have changed, before an evaluation; in a step of 2h [s] after its first
 * half, while the bodies have the forces of its start. */
void fl_sphere_states_update(fl_world *w, int32_t from, int32_t to, double h);

/* The same for a block of FL_BODY_BLOCK bodies; without the copies where no listed contact needs them. */
void fl_sphere_block_update(fl_world *w, int32_t from, int32_t to, double h);

/* Evaluates the contacts of chunk a over a step of dt [s]; survey: also bounds of omega^2.  dt < 0:
 * recomputes the sums from the stored forces.  Any thread may take any chunk. */
void fl_sphere_chunk_evaluate(fl_world *w, int32_t a, double dt, int survey);

/* Adds to the sums of bodies [from, to) the forces by contacts of other chunks, after all chunks are
 * evaluated. */
void fl_sphere_sums_collect(fl_world *w, int32_t from, int32_t to);

/* First chunk of share t of `parts` shares of about equal work; for t = parts the number of chunks. */
int32_t fl_sphere_chunk_share(const fl_world *w, int t, int parts);

#endif
