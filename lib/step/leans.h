/* SPDX-License-Identifier: GPL-3.0-or-later */
/* leans.h -- spheres that lean on walls of the boundary, many at a time by law/sphere.h.
 *
 * They are pairs like all others; only their forces are found together.  To the law a wall that stands still
 * is a sphere of no radius at the foot of the centre x_i, D = z n with the height z of the centre over the
 * wall. */
#ifndef FL_STEP_LEANS_H
#define FL_STEP_LEANS_H
#include "law/sphere.h"
#include "step/world.h"

/* Pairs of w->pair in work.  */
typedef struct {
    fl_spheres at;
    fl_pair *pair[FL_SPHERES_MOST];
    int32_t n;
} fl_leans;

/* Whether pair c is a sphere that touched a rigid wall at the last look and touches it now, its centre before
 * the wall: then it is added to q, which has room.  All others are for fl_near_awake(). */
int fl_leans_add(const fl_world *w, fl_leans *q, int32_t c);

/* Forces, torques, energies and, for a survey, stiffness of those of q, as fl_interact() over a step of dt
 * [s] leaves them behind in their pairs; q is empty then. */
void fl_leans_touch(const fl_world *w, fl_leans *q, double dt, int survey);

#endif
