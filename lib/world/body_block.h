/* SPDX-License-Identifier: GPL-3.0-or-later */
/* body_block.h -- results of a step for one block of FL_BODY_BLOCK consecutive bodies. */
#ifndef FL_WORLD_BODY_BLOCK_H
#define FL_WORLD_BODY_BLOCK_H
#include <stdint.h>
#include "geom/vec3.h"

typedef struct {
    fl_vec3 contact_force;              /* sum of the contact forces on its bodies [N] */
    double damping_work, friction_work; /* energy taken out by damping and friction in the step [J] */
    int32_t not_finite;                 /* first body with a number that is not finite, or -1 */
    double largest_moves[2];            /* two largest paths since the last neighbour search, by odometer,
                                         * after the first half of a step [m] */
} fl_body_block;

/* Update the two largest values, largest[0] >= largest[1], with x. */
static inline void fl_update_two_largest(double largest[2], double x)
{
    if (x > largest[0]) largest[1] = largest[0], largest[0] = x;
    else if (x > largest[1]) largest[1] = x;
}

#endif
