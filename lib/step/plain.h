/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plain.h -- the end of a step for bodies on which nothing acts but weight and the spheres that they meet:
 * the bits of the way that all others go, several at a time. */
#ifndef FL_STEP_PLAIN_H
#define FL_STEP_PLAIN_H
#include "step/world.h"

/* Whether bodies [from, to) are all such: plain (integrate.h), there, dry, not driven, and with no pair near
 * but spheres. */
int fl_plain_group(const fl_world *w, int32_t from, int32_t to);

/* Forces from w->balls.sum, the kick by h = dt/2, and the works of the step (works.h) of such bodies, at most
 * FL_BALLS_GROUP; what fl_step() else does with them one by one.  Returns the sum of the forces of contacts.
 */
fl_vec3 fl_plain_end(fl_world *w, int32_t from, int32_t to, double h);

#endif
