/* SPDX-License-Identifier: GPL-3.0-or-later */
/* push_state.h -- what pushes the ice with a limited force, or a wall that moves (sim/ice_push.h). */
#ifndef FL_WORLD_PUSH_STATE_H
#define FL_WORLD_PUSH_STATE_H
#include <stdint.h>

enum fl_push_of { FL_PUSH_NONE, FL_PUSH_ROW, FL_PUSH_WALL, FL_PUSH_INFLOW };

typedef struct {
    int32_t of;   /* enum fl_push_of; NONE: nothing else here is set */
    int32_t wall; /* thing that moves, -1 */
    int32_t axis; /* 0 x, 1 y */
    double sign;  /* +1: it pushes to larger coordinates */
    double speed; /* wanted, along sign [m/s] */
    double width; /* of what pushes [m] */
    double limit; /* largest push [N]; INFINITY: none */
    double mass;  /* [kg] */
    /* state; along sign */
    double velocity; /* [m/s] */
    double back;     /* force of the ice on what pushes, now [N] */
    double force;    /* push now [N] */
    double way;      /* since the start [m] */
    double impulse;  /* of the push [N s] */
    double limited;  /* time at the limit [s] */
    double work;     /* of the push [J] */
} fl_push;

#endif
