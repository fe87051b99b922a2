/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact_sums.h -- sums of damping and friction over the contacts of a body. */
#ifndef FL_WORLD_CONTACT_SUMS_H
#define FL_WORLD_CONTACT_SUMS_H
#include "world/pair.h"

/* What damping and friction of its contacts do to a thing: forces and torques about its centre, world axes.
 */
typedef struct {
    fl_vec3 damping, damping_turn, friction, friction_turn;
    int32_t n; /* with 0 all is 0 */
} fl_sink;

/* Those of all that are pressed.  A body has the sink at[place[k]]; at[0] is of all that nothing presses on,
 * and stays 0.  Few touch at a time: only they have one of their own, but where faces are frozen together or
 * somebody sleeps; then place[k] = k + 1.  What rows do to spheres is in their own sums, ball.h. */
typedef struct {
    int32_t *place; /* [total] */
    fl_sink *at;    /* [cap] */
    int32_t cap;
    int all; /* every body has one */
} fl_sinks;

/* How its velocities change in a kick. */
typedef struct {
    fl_vec3 v, w;
} fl_gain;

/* Add what damping and friction of pair p do to one of its two. */
static inline void fl_works_add(fl_sink *s, const fl_pair *p, int is_i)
{
    const double sign = is_i ? 1.0 : -1.0;
    s->n++;
    s->damping = v3_madd(s->damping, sign, p->fd);
    s->damping_turn = v3_add(s->damping_turn, is_i ? p->di : p->dj);
    s->friction = v3_madd(s->friction, sign, p->fs);
    s->friction_turn = v3_add(s->friction_turn, is_i ? p->si : p->sj);
}

#endif
