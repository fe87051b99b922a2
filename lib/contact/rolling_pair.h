/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rolling_pair.h -- rolling resistance of spheres (law/rolling.h) in a step: between spheres and on walls,
 * in batches, and helpers for a sphere on any other body.  Nothing is called where no law has it,
 * w->has_rolling. */
#ifndef FL_CONTACT_ROLLING_PAIR_H
#define FL_CONTACT_ROLLING_PAIR_H
#include "law/sphere_batch.h"
#include "world/world.h"

/* A sphere contact of i and j, -1 for a wall, with its rolling spring. */
typedef struct {
    const fl_pair_law *law;
    fl_rolling_spring *roll;
    int32_t i, j;
} fl_rolling_contact;

/* Adds the rolling moments of the first m contacts of the batch to its torques, after
 * fl_sphere_batch_evaluate() over a step of dt [s], or for dt < 0 after fl_sphere_batch_restore(). */
void fl_rolling_evaluate(const fl_world *w, fl_sphere_batch *batch, const fl_rolling_contact *contact,
                         int32_t m, double dt);

/* Moment per angle of a spring [N m]. */
static inline double fl_rolling_turn_stiffness(const fl_rolling_spring *r) { return r->k * r->arm * r->arm; }

/* Moment of a spring on i [N m]; 0 for NULL. */
static inline fl_vec3 fl_rolling_moment(const fl_rolling_spring *r)
{
    return r ? v3_scale(r->arm, r->total) : v3(0, 0, 0);
}

/* Radius of body k if its core is a point, else 0 [m].  Such a sphere need not be isotropic (body.h), with
 * bonds or in water. */
static inline double fl_rolling_radius(const fl_world *w, int32_t k)
{
    return k < w->n && w->b.core[k].nv == 1 ? w->b.radius[k] : 0.0;
}

/* True if pair p has rolling resistance: it has a sphere, and its law has mu_r. */
static inline int fl_pair_has_rolling(const fl_world *w, const fl_pair *p)
{
    return p->law->rolling > 0.0 && (fl_rolling_radius(w, p->i) > 0.0 || fl_rolling_radius(w, p->j) > 0.0);
}

#endif
