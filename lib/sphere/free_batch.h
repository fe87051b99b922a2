/* SPDX-License-Identifier: GPL-3.0-or-later */
/* free_batch.h -- the end of a step for bodies on which nothing acts but weight, walls and the spheres they meet:
 * the bits of the way that all others go, several at a time. */
#ifndef FL_SPHERE_FREE_BATCH_H
#define FL_SPHERE_FREE_BATCH_H
#include "world/world.h"

/* Whether body k < n is such: plain (integrate.h), there, dry, not driven, and with none near but what it has
 * rows with (sphere_contacts.h), nor pressed by others when the step began. */
int fl_is_free_sphere(const fl_world *w, int32_t k);

/* What damping and friction take out of each in the step [J]. */
typedef struct {
    double damping[FL_BODY_BLOCK], friction[FL_BODY_BLOCK];
} fl_free_batch_work;

/* Forces from w->balls.sum, the kick by h = dt/2, and the works of the step (energy_ledger.h), of such bodies, a
 * group at the most.  Returns whether all of their numbers are finite. */
int fl_free_batch_end_step(fl_world *w, int32_t from, int32_t to, double h, fl_free_batch_work *works);

#endif
