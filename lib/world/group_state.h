/* SPDX-License-Identifier: GPL-3.0-or-later */
/* group_state.h -- what a step accumulates for a group of bodies. */
#ifndef FL_WORLD_GROUP_STATE_H
#define FL_WORLD_GROUP_STATE_H
#include <stdint.h>
#include "geom/vec3.h"

/* What a step tells of a group of bodies, FL_BODY_BLOCK in a row. */
typedef struct {
    fl_vec3 contact_force;              /* sum of the forces of contacts [N]                      */
    double damping_work, friction_work; /* taken out by damping and friction in the step [J] */
    int32_t not_finite;                 /* the first that has a number which is not finite, or -1 */
    double largest_moves[2]; /* the longest ways since the last search, after the first half of a step [m] */
} fl_body_block;

/* The two longest ways so far, and another. */
static inline void fl_update_two_largest(double first[2], double moved)
{
    if (moved > first[0]) first[1] = first[0], first[0] = moved;
    else if (moved > first[1]) first[1] = moved;
}

#endif
