/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plain.h -- the end of a step for bodies on which nothing acts but weight, walls and the spheres they meet:
 * the bits of the way that all others go, several at a time. */
#ifndef FL_STEP_PLAIN_H
#define FL_STEP_PLAIN_H
#include "world/world.h"

/* Whether body k < n is such: plain (integrate.h), there, dry, not driven, and with none near but what it has
 * rows with (ball.h), nor pressed by others when the step began. */
int fl_plain_is(const fl_world *w, int32_t k);

/* What damping and friction take out of each in the step [J]. */
typedef struct {
    double damped[FL_BALLS_GROUP], rubbed[FL_BALLS_GROUP];
} fl_plain_works;

/* Forces from w->balls.sum, the kick by h = dt/2, and the works of the step (works.h), of such bodies, a
 * group at the most.  Returns whether all of their numbers are finite. */
int fl_plain_end(fl_world *w, int32_t from, int32_t to, double h, fl_plain_works *works);

#endif
