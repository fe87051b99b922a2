/* SPDX-License-Identifier: GPL-3.0-or-later */
/* free_batch.h -- end of a step for free spheres, several at a time: bodies with no other loads than weight
 * and contacts of spheres and walls.  The bits are those of the general path. */
#ifndef FL_SPHERE_FREE_BATCH_H
#define FL_SPHERE_FREE_BATCH_H
#include "world/world.h"

/* True if body k < n is a free sphere: fl_body_is_free_isotropic(), in the domain, without water, not
 * driven, in a world without bonded spheres, without pairs in w->pair, and without such contacts at the start of the step. */
int fl_is_free_sphere(const fl_world *w, int32_t k);

/* Energy dissipated by damping and friction of each body in the step [J]. */
typedef struct {
    double damping[FL_BODY_BLOCK], friction[FL_BODY_BLOCK];
} fl_free_batch_work;

/* Sets forces from w->spheres.sum, kicks by h = dt/2 [s] and computes the work of the step
 * (energy_ledger.h) for free spheres [from, to), at most a block.  Returns true if all of their numbers are
 * finite. */
int fl_free_batch_end_step(fl_world *w, int32_t from, int32_t to, double h, fl_free_batch_work *works);

#endif
