/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_response.h -- effective mass and compliance of a pair of bodies at a contact: velocity per impulse. */
#ifndef FL_CONTACT_PAIR_RESPONSE_H
#define FL_CONTACT_PAIR_RESPONSE_H
#include "base/simd.h"
#include "body/integrate.h"
#include "world/world.h"

/* Inverse mass and inertia of both bodies. */
typedef struct {
    fl_mobility i, j;
} fl_pair_mobility;

static inline fl_pair_mobility fl_pair_mobility_of(const fl_world *w, const fl_pair *p)
{
    return (fl_pair_mobility){fl_body_mobility(&w->b, p->i), fl_body_mobility(&w->b, p->j)};
}

/* Effective mass M of a contact with the force f on i and the torques ti and tj about the centres [kg].
 *
 * For two free bodies without added mass it is the reduced mass.  Else, summed over both bodies,
 *     1/M = (f.M^-1 f + 1/4 t.I^-1 t)/f^2.
 * A contact at a point turns the bodies with all of its arm, a face prevents it.  With half of the arm M lies
 * between that of a point and four times that.
 *   e  only read where fl_pair_has_reduced_mass() is false */
double fl_pair_mass(const fl_world *w, const fl_pair *p, const fl_pair_mobility *e, fl_vec3 f, fl_vec3 ti,
                    fl_vec3 tj);

/* Velocity along the force per impulse along it, with the rotation of both bodies [1/kg]: 1/M with all of the
 * torques.  The force is taken as at least half of the sum of the pressures. */
double fl_pair_compliance(const fl_pair_mobility *e, fl_vec3 f, fl_vec3 ti, fl_vec3 tj, double pressure);

/* Relative velocity of the points ai and aj of both bodies per impulse there, world axes [1/kg]; and relative
 * spin about n per angular impulse about n [1/kg m2]. */
fl_sym3 fl_pair_compliance_matrix(const fl_pair_mobility *e, fl_vec3 ai, fl_vec3 aj);
double fl_pair_turn_compliance(const fl_pair_mobility *e, fl_vec3 n);

/* Correction of the relative velocity of A against B where the two rotate together [m/s].
 *
 * Velocities are those of the middle of a step, arms those of its end.  Without slip they give
 *     v_A - v_B + w x off = dt/2 w x (w x off),     off from A's centre to B's,
 * instead of 0, and friction would creep.  0 where one of them does not rotate, and for spheres, whose
 * contact point does not rotate with them. */
FL_SIMD_INLINE fl_vec3 fl_rotation_lag(fl_vec3 wi, fl_vec3 wj, fl_vec3 off, double dt)
{
    return v3_scale(-0.25 * dt, v3_add(v3_cross(wi, v3_cross(wj, off)), v3_cross(wj, v3_cross(wi, off))));
}

static inline fl_vec3 fl_pair_rotation_lag(const fl_bodies *b, const fl_pair *p, fl_vec3 off, double dt)
{
    if (b->is_isotropic[p->i] || b->is_isotropic[p->j]) return v3(0, 0, 0);
    return fl_rotation_lag(b->w[p->i], b->w[p->j], off, dt);
}

/* True if M is the reduced mass for every force. */
static inline int fl_pair_has_reduced_mass(const fl_world *w, const fl_pair *p)
{
    return !w->b.added_mass && !w->b.heave_mass && !fl_body_fixed_translations(&w->b, p->i) &&
           !fl_body_fixed_translations(&w->b, p->j);
}

/* True if both bodies move and rotate freely. */
static inline int fl_pair_is_free(const fl_world *w, const fl_pair *p)
{
    return fl_pair_has_reduced_mass(w, p) && !w->b.fixed_dof[p->i] && (p->j >= w->n || !w->b.fixed_dof[p->j]);
}

#endif
