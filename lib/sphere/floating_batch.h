/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floating_batch.h -- both halves of a step for the spheres of a bonded sheet in still water, a block at a
 * time: drag, kick and drift; then weight, buoyancy, contacts, bonds, kick and drag.  The operations of each
 * sphere are those of the general path, so its bits do not depend on which path it takes. */
#ifndef FL_SPHERE_FLOATING_BATCH_H
#define FL_SPHERE_FLOATING_BATCH_H
#include "world/world.h"

/* True if the batch may be used in this run: bonded spheres, water of a uniform current with the drag of the
 * whole body, no waves, wind or other forces of the table, no sleep, no outflow. */
int fl_floating_batch_applies(const fl_world *w);

/* Returns the end of the run of such spheres from k on, k if it is none: without contacts in w->pair in the
 * step before, and in this one if `second`, where those with fixed degrees of freedom touch no sphere. */
int32_t fl_floating_run_end(const fl_world *w, int32_t k, int32_t to, int second);

/* First half of a step of 2 h for [from, to), at most FL_BODY_BLOCK. */
void fl_floating_batch_begin(fl_world *w, int32_t from, int32_t to, double h);

/* Second half; the caller adds contact_force[k - from], the force of contacts and bonds, and the works to the
 * sums of the block.  Sphere sums are collected before.  The changes by the kicks are set only for a sphere
 * that touches another one, in this step or in the one before. */
typedef struct {
    fl_vec3 contact_force[FL_BODY_BLOCK], first_dv[FL_BODY_BLOCK], first_dw[FL_BODY_BLOCK],
        second_dv[FL_BODY_BLOCK], second_dw[FL_BODY_BLOCK]; /* changes by the two kicks */
} fl_floating_result;
void fl_floating_batch_end(fl_world *w, int32_t from, int32_t to, double h, fl_floating_result *out);

#endif
