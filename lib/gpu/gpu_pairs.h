/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gpu_pairs.h -- spheres near the structure, held and driven ones on a device: which they are, their contacts
 * with cones and convex solids up and down, for gpu_world.c. */
#ifndef FL_GPU_GPU_PAIRS_H
#define FL_GPU_GPU_PAIRS_H
#include "gpu/gpu_memory.h"
#include "world/world.h"

/* FL_GPU_OWN if the device moves body k until the next search, FL_GPU_GUEST if the CPU does, FL_GPU_EMPTY if
 * there is none; all pairs have been evaluated.  Bodies are asked for in their order, and faces of meshes are
 * listed on the way; g->tiles and g->listed are 0 before.  -1 when memory runs out. */
int fl_gpu_body_kind(struct fl_gpu_world *g, fl_world *w, int32_t k, fl_err *err);

/* Lists own bodies that are near the structure, held or driven, and their pairs; copies them up. */
int fl_gpu_put_near(struct fl_gpu_world *g, fl_world *w, fl_err *err);

/* The drift of guided bodies of the device, whose velocity along the sheet is constant, so that the CPU knows
 * when they are let go; and what is fixed of body k now. */
void fl_gpu_drift_guided(const struct fl_gpu_world *g, fl_world *w);
int fl_gpu_set_hold(struct fl_gpu_world *g, const fl_world *w, int32_t k, fl_err *err);

/* Before each evaluation: the pairs of the device are none of the CPU's; pieces that move are copied. */
int fl_gpu_begin_pairs(struct fl_gpu_world *g, fl_world *w, fl_err *err);

/* After it: results of those that touch, into their pairs.  touching: how many; survey: with bounds. */
int fl_gpu_take_pairs(struct fl_gpu_world *g, fl_world *w, int32_t touching, int survey, fl_err *err);

/* Brings pairs and sums of contacts up to date, with what the first half of a step has stored. */
int fl_gpu_get_near(struct fl_gpu_world *g, fl_world *w, fl_err *err);

void fl_gpu_near_free(struct fl_gpu_world *g);

#endif
