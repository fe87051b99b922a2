/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_pair.h -- which pairs are contacts of spheres, and such a contact as a pair like all others. */
#ifndef FL_SPHERE_SPHERE_PAIR_H
#define FL_SPHERE_SPHERE_PAIR_H
#include "world/world.h"

/* Which pairs have rows of their own (world/sphere_contacts.h), by `patch` or `core`: two spheres, that is bodies alike in
 * all directions, or one and a rigid wall of the boundary.  All others are pairs of w->pair. */
enum fl_sphere_kind { FL_SPHERE_NONE, FL_SPHERE_SPHERE, FL_SPHERE_WALL };

/* i < n, j < total. */
enum fl_sphere_kind fl_sphere_pair_kind(const fl_world *w, int32_t i, int32_t j);

/* So many more rows and walls touch body i; any thread may say so. */
static inline void fl_balls_turn(fl_balls *s, int32_t i, int32_t by)
{
#pragma omp atomic
    s->touching[i] += by;
}

/* Of a sphere's row the energy of the springs of friction, with that against rolling, if any [J]. */
static inline double fl_ball_spring(const fl_ball_row *r, const fl_roll *roll)
{
    return (r->stiff > 0.0 ? 0.5 * v3_norm2(r->slip) / r->stiff : 0.0) +
           (roll ? fl_rolling_energy(*roll) : 0.0);
}

/* A row of i and j as a pair like all others, at that overlap along n, from j to i: all but its image, and
 * what it does to j. */
void fl_ball_pair(const fl_world *w, int32_t i, int32_t j, const fl_ball_row *r, const fl_roll *roll, int hit,
                  fl_vec3 n, double over, fl_pair *p);

#endif
