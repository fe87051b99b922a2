/* SPDX-License-Identifier: GPL-3.0-or-later */
/* leans.h -- spheres that lean on rigid walls of the boundary: rows as those of two spheres, ball.h, with the
 * wall in place of the second.  To law/sphere.h a wall that stands still is a sphere of no radius at the foot
 * of the centre x_i, D = z n with the height z of the centre over the wall and its normal n. */
#ifndef FL_STEP_LEANS_H
#define FL_STEP_LEANS_H
#include "world/world.h"

/* Rows for those of w->near that are such, n of them; what a row of before remembers goes over.  -1 with
 * FL_SYSTEM. */
int fl_leans_list(fl_world *w, int64_t n, fl_err *err);

/* A row behind all others, roll being read where w->rolls; fl_leans_index() afterwards.  -1 with
 * FL_SYSTEM. */
int fl_leans_push(fl_world *w, int32_t i, int32_t j, int hit, const fl_ball_row *row, const fl_roll *roll,
                  fl_err *err);

/* End the rows of bodies that are away; whether there were any. */
int fl_leans_drop(fl_world *w);

/* Which are of which chunk. */
void fl_leans_index(fl_balls *s);

/* Those of chunk a over a step of dt [s], dt < 0: placed again, by what they hold; into the sums, the tally
 * and, for a survey, the stiffness of the chunk. */
void fl_leans_touch(fl_world *w, int32_t a, double dt, int survey);

/* Add what those that lean on wall j do to it. */
void fl_leans_press(const fl_world *w, int32_t j, fl_vec3 *f, fl_vec3 *t);

/* Elastic energy of those of chunk a, that of their springs of friction with it, and that of the springs
 * alone, added [J]. */
void fl_leans_energy(const fl_world *w, int32_t a, double *all, double *springs);

/* Row c as a pair like all others, with its forces of the last touch. */
void fl_leans_pair(const fl_world *w, int32_t c, fl_pair *p);

#endif
