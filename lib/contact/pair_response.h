/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_response.h -- effective mass and compliance of a pair at a contact. */
#ifndef FL_CONTACT_PAIR_RESPONSE_H
#define FL_CONTACT_PAIR_RESPONSE_H
#include "base/simd.h"
#include "body/integrate.h"
#include "world/world.h"

/* How both of a pair yield to impulses. */
typedef struct {
    fl_mobility i, j;
} fl_pair_mobility;

static inline fl_pair_mobility fl_pair_mobility_of(const fl_world *w, const fl_pair *p)
{
    return (fl_pair_mobility){fl_body_mobility(&w->b, p->i), fl_body_mobility(&w->b, p->j)};
}

/* The mass M that meets in a contact with the force f on i and the torques ti and tj about the centres [kg]:
 * the reduced mass of two that are free and move no water with them.  Else
 *     1/M = (f.M^-1 f + 1/4 t.I^-1 t)/f^2 of both:
 * a point turns the bodies by all of its arm, a face keeps them from it, and with half of the arm M is never
 * less than that of a point, nor more than four times as much.  e: needed where it is not
 * fl_pair_has_reduced_mass(). */
double fl_pair_mass(const fl_world *w, const fl_pair *p, const fl_pair_mobility *e, fl_vec3 f, fl_vec3 ti,
                    fl_vec3 tj);

/* The velocity at which they part for each impulse of that force, along it, as their turning adds to it
 * [1/kg]: 1/M with all of the torques.  It is taken for half of the sum of the pressures at least. */
double fl_pair_compliance(const fl_pair_mobility *e, fl_vec3 f, fl_vec3 ti, fl_vec3 tj, double presses);

/* How the points ai and aj of both part for an impulse there, world axes, and the bodies about n for one
 * about n [1/kg m2]. */
fl_sym3 fl_pair_compliance_matrix(const fl_pair_mobility *e, fl_vec3 ai, fl_vec3 aj);
double fl_pair_turn_compliance(const fl_pair_mobility *e, fl_vec3 n);

/* What the velocity of A against B is off by where the two turn together: v and w are those of the middle of
 * a step, arms those of its end, and with them
 *     v_A - v_B + w x off = dt/2 w x (w x off),     off from A's centre to B's,
 * where nothing slips; friction would creep.  Nothing where one of them does not turn; and where a ball
 * touches, that is no part of it that turns along. */
FL_SIMD_INLINE fl_vec3 fl_rotation_lag(fl_vec3 wi, fl_vec3 wj, fl_vec3 off, double dt)
{
    return v3_scale(-0.25 * dt, v3_add(v3_cross(wi, v3_cross(wj, off)), v3_cross(wj, v3_cross(wi, off))));
}

static inline fl_vec3 fl_pair_rotation_lag(const fl_bodies *b, const fl_pair *p, fl_vec3 off, double dt)
{
    if (b->is_isotropic[p->i] || b->is_isotropic[p->j]) return v3(0, 0, 0);
    return fl_rotation_lag(b->w[p->i], b->w[p->j], off, dt);
}

/* Whether it is the reduced mass, whatever the force. */
static inline int fl_pair_has_reduced_mass(const fl_world *w, const fl_pair *p)
{
    return !w->b.added_mass && !fl_body_fixed_translations(&w->b, p->i) &&
           !fl_body_fixed_translations(&w->b, p->j);
}

/* Whether they move and turn as masses and moments have it. */
static inline int fl_pair_is_free(const fl_world *w, const fl_pair *p)
{
    return fl_pair_has_reduced_mass(w, p) && !w->b.fixed_dof[p->i] && (p->j >= w->n || !w->b.fixed_dof[p->j]);
}

#endif
