/* SPDX-License-Identifier: GPL-3.0-or-later */
/* group_state.h -- what a step accumulates for a group of bodies. */
#ifndef FL_WORLD_GROUP_STATE_H
#define FL_WORLD_GROUP_STATE_H
#include <stdint.h>
#include "geom/vec3.h"

/* What a step tells of a group of bodies, FL_BALLS_GROUP in a row. */
typedef struct {
    fl_vec3 pushed;        /* sum of the forces of contacts [N]                      */
    double damped, rubbed; /* taken out by damping and friction in the step [J] */
    int32_t lost;          /* the first that has a number which is not finite, or -1 */
    double moved[2];       /* the longest ways since the last search, after the first half of a step [m] */
} fl_group;

#endif
