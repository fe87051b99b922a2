/* SPDX-License-Identifier: GPL-3.0-or-later */
/* balls.h -- pairs of spheres in a step, those with walls (leans.h) among them; how they are kept is told in
 * ball.h, their forces in law/sphere.h. */
#ifndef FL_STEP_BALLS_H
#define FL_STEP_BALLS_H
#include "world/world.h"

/* Rows for those of w->near that are such, spheres that are no farther apart than the skin; image() tells
 * which image of j is meant.  What a row of before remembers goes over.
 *   others  out: how many of w->near are not such
 * -1 with FL_SYSTEM. */
typedef void fl_ball_image(const fl_world *w, int64_t k, int32_t i, int32_t j, int32_t image[3]);
int fl_balls_list(fl_world *w, fl_ball_image *image, int64_t *others, fl_err *err);

/* A row behind all others, for those who put together a world from what they read: i and then j do not fall;
 * fl_balls_index() afterwards.  Walls have no image.  roll: read where w->rolls.  -1 with FL_SYSTEM. */
int fl_balls_push(fl_world *w, int32_t i, int32_t j, const int32_t image[3], int hit, const fl_ball_row *row,
                  const fl_roll *roll, fl_err *err);

/* End the rows of bodies that are away, and renew the sums of the others.  -1 with FL_SYSTEM. */
int fl_balls_drop(fl_world *w, fl_err *err);

/* Offsets, slots and sums of the rows at hand, from the forces that they hold.  -1 with FL_SYSTEM. */
int fl_balls_index(fl_world *w, fl_err *err);

/* Behind the last body of chunk a. */
static inline int32_t fl_balls_last(const fl_balls *s, int32_t a)
{
    const int32_t end = (a + 1) * FL_BALLS_CHUNK;
    return end < s->bodies ? end : s->bodies;
}

/* D of row c, of the image that is meant, most often the one in the same cell. */
static inline fl_vec3 fl_balls_between(const fl_world *w, int32_t c)
{
    const fl_balls *s = &w->balls;
    const fl_vec3 d = v3_sub(w->b.x[s->i[c]], w->b.x[s->j[c]]);
    const int32_t *e = s->image ? &s->image[3 * c] : NULL;
    return e && (e[0] | e[1] | e[2]) ? v3_sub(d, fl_cell_way(&w->cell, v3(e[0], e[1], e[2]))) : d;
}

/* --- their books ------------------------------------------------------------------------------- */

/* Sum of bounds of omega^2 of the contacts of body k, at the last survey [1/s2]. */
double fl_balls_stiff(const fl_world *w, int32_t k);

/* Force and torque on body k, added to f and t. */
static inline void fl_balls_force(const fl_world *w, int32_t k, fl_vec3 *f, fl_vec3 *t)
{
    const fl_ball_sum *s = &w->balls.sum[k];
    *f = v3_add(*f, v3_add(v3_add(s->elastic, s->damping), s->friction));
    *t = v3_add(*t, s->torque);
}

/* Elastic energy of all rows, that of their springs of friction with it, and that of the springs alone [J].
 */
void fl_balls_energy(const fl_world *w, double *elastic, double *spring);

/* Sum of |F| [N], touching rows, and the largest overlap over the sum of the radii with whose it is (-1:
 * nobody's) of the last touch. */
typedef struct {
    double force, worst;
    int64_t touching;
    int32_t i, j;
} fl_ball_count;
fl_ball_count fl_balls_count(const fl_world *w);

/* How many rows there are. */
static inline int32_t fl_balls_rows(const fl_world *w) { return w->balls.n + w->balls.leans; }

/* All rows by (i, j, image), from {0} on: what comes next, of two spheres, or of a sphere and a wall ~c; none
 * are left after fl_balls_rows() of them. */
typedef struct {
    int32_t row, lean;
} fl_ball_walk;
int32_t fl_ball_next(const fl_world *w, fl_ball_walk *at);

/* All near pairs, those of spheres in their place, by (i, j, image): from {.w = w} on, NULL at the end.  What
 * is returned holds until the next. */
typedef struct {
    const fl_world *w;
    int32_t pair;
    fl_ball_walk rows;
    fl_pair made;
} fl_pair_walk;
const fl_pair *fl_pair_next(fl_pair_walk *at);

/* Memory of rows, sums and slots [B]. */
double fl_balls_bytes(const fl_world *w);

void fl_balls_free(fl_balls *s);

#endif
