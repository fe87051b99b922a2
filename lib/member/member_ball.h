/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_ball.h -- a ball of a chain of members, and its rotation in a step. */
#ifndef FL_MEMBER_MEMBER_BALL_H
#define FL_MEMBER_MEMBER_BALL_H
#include <stdint.h>
#include "geom/quat.h"

/* The order of the numbers is that of the loads of member_lanes.c. */
typedef struct {
    fl_vec3 x0, d, v, w;
    fl_quat q;
    double over_m, over_i; /* 1/m, 1/I; 0: the ball has no such freedom */
    int fixed;             /* freedoms that are held, bits */
    int32_t load;          /* number of its load, -1: none */
} fl_member_ball;

/* The forces that the contacts of a ball exert on its load. */
typedef struct {
    fl_vec3 f, m; /* internal force and moment, what the ball exerts on its load */
} fl_member_resist;

/* The parts of a vector along freedoms that are free; held: x y z in the lowest three bits. */
static inline fl_vec3 fl_member_free_part(fl_vec3 a, int held)
{
    return held == 0 ? a : v3(held & 1 ? 0.0 : a.x, held & 2 ? 0.0 : a.y, held & 4 ? 0.0 : a.z);
}

/* q <- exp(dt w) q.  What rounding adds to its length is taken away to first order. */
static inline void fl_member_ball_turn(fl_member_ball *a, double dt)
{
    const fl_quat q = q_mul(q_of_vector(v3_scale(dt, a->w)), a->q);
    const double k = 1.5 - 0.5 * (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    a->q = (fl_quat){k * q.w, k * q.x, k * q.y, k * q.z};
}

#endif
