/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plain.h -- the end of a step for bodies on which nothing acts but weight and the spheres that they meet:
 * the bits of the way that all others go, several at a time. */
#ifndef FL_STEP_PLAIN_H
#define FL_STEP_PLAIN_H
#include "step/world.h"

/* Whether body k < n is such: plain (integrate.h), there, awake, dry, not driven, and with no pair near but
 * spheres. */
int fl_plain_is(const fl_world *w, int32_t k);

/* What presses on bodies of a group besides, counted from its first: has is -1 where something does and 0
 * elsewhere, where f and t are not looked at. */
typedef struct {
    int64_t has[FL_BALLS_GROUP];
    fl_vec3 f[FL_BALLS_GROUP], t[FL_BALLS_GROUP]; /* [N], [N m] */
} fl_plain_press;

/* What damping and friction take out of each in the step [J]. */
typedef struct {
    double damped[FL_BALLS_GROUP], rubbed[FL_BALLS_GROUP];
} fl_plain_works;

/* Forces from w->balls.sum, and from more where that is not NULL, the kick by h = dt/2, and the works of the
 * step (works.h) but for those of more, of such bodies, no more than a group.
 * Returns whether all of their numbers are finite. */
int fl_plain_end(fl_world *w, int32_t from, int32_t to, double h, const fl_plain_press *more,
                 fl_plain_works *works);

#endif
