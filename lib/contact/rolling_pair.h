/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rolling_pair.h -- what keeps spheres from rolling (law/rolling.h), in a step: rows of spheres and of walls, and a
 * sphere on all else.  Where no law asks for it nothing of this is there: w->rolls. */
#ifndef FL_CONTACT_ROLLING_PAIR_H
#define FL_CONTACT_ROLLING_PAIR_H
#include "law/sphere_batch.h"
#include "world/world.h"

/* A row of i and j, which is -1 for a wall, and what it remembers. */
typedef struct {
    const fl_pair_law *law;
    fl_rolling_spring *roll;
    int32_t i, j;
} fl_rolling_contact;

/* The first m contacts of at, which have met (law/sphere_batch.h) over a step of dt [s], or, dt < 0, been placed:
 * their moments come to the torques. */
void fl_rolling_evaluate(const fl_world *w, fl_sphere_batch *at, const fl_rolling_contact *row, int32_t m,
                         double dt);

/* How stiff one is for a turn of a body [N m]. */
static inline double fl_rolling_turn_stiffness(const fl_rolling_spring *r) { return r->k * r->arm * r->arm; }

/* The moment of one on i [N m]; 0 for NULL. */
static inline fl_vec3 fl_rolling_moment(const fl_rolling_spring *r)
{
    return r ? v3_scale(r->arm, r->total) : v3(0, 0, 0);
}

/* The radius of thing k where it is a sphere, also one that bonds or water keep from being a ball (body.h);
 * 0: it is none [m]. */
static inline double fl_rolling_radius(const fl_world *w, int32_t k)
{
    return k < w->n && w->b.core[k].nv == 1 ? w->b.radius[k] : 0.0;
}

/* Whether pair p is of a sphere that something keeps from rolling. */
static inline int fl_pair_has_rolling(const fl_world *w, const fl_pair *p)
{
    return p->law->rolling > 0.0 && (fl_rolling_radius(w, p->i) > 0.0 || fl_rolling_radius(w, p->j) > 0.0);
}

#endif
