/* SPDX-License-Identifier: GPL-3.0-or-later */
/* velocity_predictor.h -- how a contact will move at the end of the step it is in.
 *
 * Forces are found where the step ends, but speeds are known of its middle.  What the first half of it has
 * changed, by forces and by drag, the second will change as well, but for what forces change by from step to
 * step: so far the speeds of the end are ahead of those of the middle, to order 2.  Only who was pressed at
 * the begin of the step is asked for: fl_world.lead; of others a contact that begins feels nothing yet. */
#ifndef FL_CONTACT_VELOCITY_PREDICTOR_H
#define FL_CONTACT_VELOCITY_PREDICTOR_H
#include "law/damping.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "world/access.h"

typedef struct {
    fl_vec3 v;            /* of A's centre against B's, more than fl_pair_rotation_lag() has of it [m/s]; */
    fl_vec3 wi, wj;       /* of the spins of both                                       [rad/s] */
    double contact_count; /* so many contacts are damped by what yields here, fl_effective_contact_count() */
} fl_predicted_velocity;

/* A force on A and its moment about the middle between both centres, from the torques ti and tj about these:
 * that on B is the opposite, so it does not matter who is A. */
FL_SIMD_INLINE fl_wrench fl_wrench_about_middle(fl_vec3 f, fl_vec3 ti, fl_vec3 tj)
{
    return (fl_wrench){f, v3_scale(0.5, v3_sub(ti, tj))};
}

/* What the contact did in the step before: nothing, where it did not touch.  World axes. */
typedef struct {
    fl_wrench elastic, damping; /* of what presses              */
    fl_wrench friction;         /* friction                     */
    fl_vec3 friction_damping;   /* of that what springs do not [N]   */
    double spring_moment;       /* moment of the spring        [N m] */
} fl_previous_force;

/* all, damping and rubbed: as fl_pair has them, about the middle. */
FL_SIMD_INLINE fl_previous_force fl_previous_force_from(fl_wrench all, fl_wrench damping, fl_wrench rubbed,
                                                        fl_friction_springs slip)
{
    return (fl_previous_force){.elastic = fl_wrench_madd(fl_wrench_madd(all, -1.0, damping), -1.0, rubbed),
                               .damping = damping,
                               .friction = rubbed,
                               .friction_damping = v3_sub(rubbed.f, slip.force),
                               .spring_moment = slip.moment};
}

static inline fl_previous_force fl_previous_force_of(const fl_pair *p)
{
    return fl_previous_force_from(
        fl_wrench_about_middle(p->force, p->torque_i, p->torque_j),
        fl_wrench_about_middle(p->force_damping, p->torque_i_damping, p->torque_j_damping),
        fl_wrench_about_middle(p->force_friction, p->torque_i_friction, p->torque_j_friction), p->springs);
}

/* A step over dt, and half of the one that damping is held back for: the first that comes where dt = 0, as
 * time begins and bodies may touch that move [s].  begins: as in fl_damping_end_speed(). */
typedef struct {
    double dt, half_step, at_start;
} fl_predictor_step;

static inline fl_predictor_step fl_predictor_step_of(const fl_world *w, double dt)
{
    return dt > 0.0 ? (fl_predictor_step){dt, 0.5 * dt, 0.0} : (fl_predictor_step){dt, 0.5 * w->dt, 1.0};
}

/* fl_damping_end_speed() of a contact that approaches at c, as foreseen; elastic: size of that force now, C its
 * damping, yields: fl_pair_compliance().  Sizes, since the force turns with the contact. */
FL_SIMD_INLINE double fl_predict_approach(double c, double elastic, double C, double yields, double pressed,
                                          fl_predictor_step by, fl_previous_force was)
{
    const double had = v3_norm(was.elastic.f),
                 damped = had > 0.0 ? v3_dot(was.elastic.f, was.damping.f) / had : 0.0;
    const double known = 1.0 - by.at_start;
    return fl_damping_end_speed(c, C, by.half_step * yields, pressed, known * (elastic - had), known * damped,
                                by.at_start);
}

/* Where the pressures of a contact stand against each other, in a slot, its force is less than their sum,
 * presses, and what it changes by tells little of them: so much of fl_predict_approach() counts.  1 down to half
 * of the sum. */
FL_SIMD_INLINE double fl_predictor_share(double elastic, double presses)
{
    const double part = 4.0 * elastic * elastic, all = presses * presses;
    return part < all ? part / all : 1.0;
}

/* fl_damping_end_speed() knows of the push along the force alone.  All else of damping, by which the bodies
 * shake, goes by the motion foreseen, held back as that of many contacts is: as if it moved twice as easily
 * as the mass.  presses: sum of the pressures, y = C dt/M of them, twice what fl_damping_implicit_weight() has;
 * begins: as in fl_damping_end_speed(). */
FL_SIMD_INLINE fl_wrench fl_stabilised_damping(fl_wrench elastic, fl_wrench damping, double presses, double y,
                                               double pressed, fl_previous_force was, double begins)
{
    const fl_wrench off = fl_wrench_madd(was.damping, -1.0, damping);
    const double f2 = v3_norm2(elastic.f), least = 0.25 * presses * presses, size2 = f2 > least ? f2 : least,
                 push = size2 > 0.0 ? v3_dot(elastic.f, off.f) / size2 : 0.0;
    const double holds = (fl_damping_implicit_weight(y, pressed, 2.0 * pressed) - begins) * y,
                 to = holds / (1.0 + holds);
    return fl_wrench_madd(damping, to, fl_wrench_madd(off, -push, elastic));
}

/* Moment about n of friction that was no spring's, at the arms ai and aj. */
FL_SIMD_INLINE double fl_previous_damping_moment(fl_previous_force was, fl_vec3 n, fl_vec3 ai, fl_vec3 aj)
{
    const fl_vec3 arm = v3_scale(0.5, v3_add(ai, aj));
    return v3_dot(n, v3_sub(was.friction.m, v3_cross(arm, was.friction.f))) - was.spring_moment;
}

/* Contacts of thing k in the step before, of which n are no rows (sphere_contacts.h).  Rows count for one each; among
 * themselves they go by all_round() of contact_force.c. */
static inline int32_t fl_previous_contact_count(const fl_world *w, int32_t k, int32_t n)
{
    return w->spheres.bodies && k < w->n ? n + w->spheres.previous_contact_count[k] : n;
}

/* fl_body_inverse_mass() of thing k.  A part of the structure that turns alone has no mass: it is taken to yield
 * as the other, by y. */
static inline double fl_predictor_inverse_mass(const fl_world *w, int32_t k, double y)
{
    if (k < w->n) return fl_body_inverse_mass(&w->b, k);
    if (!fl_piece_is_free(w, k)) return 0.0;
    const double mass = w->moving.movers.motion[w->moving.mover_of_piece[k - w->n]].mass;
    return mass > 0.0 ? 1.0 / mass : y;
}

/* lag: fl_pair_rotation_lag() of the step [m/s]. */
static inline fl_predicted_velocity fl_predicted_velocity_of(const fl_world *w, const fl_pair *p, fl_vec3 lag)
{
    const int32_t ni = fl_sums_before(w, p->i)->contacts, nj = fl_sums_before(w, p->j)->contacts;
    const int32_t mi = fl_previous_contact_count(w, p->i, ni), mj = fl_previous_contact_count(w, p->j, nj);
    const double yi = fl_predictor_inverse_mass(w, p->i, 0.0), yj = fl_predictor_inverse_mass(w, p->j, yi),
                 n = fl_effective_contact_count(mi > 1 ? (mi - 1) * yi : 0.0, mj > 1 ? (mj - 1) * yj : 0.0,
                                                yi + yj);
    const fl_velocity_change none = {{0, 0, 0}, {0, 0, 0}};
    const fl_velocity_change i = ni ? *fl_predicted_change(w, p->i) : none,
                             j = nj ? *fl_predicted_change(w, p->j) : none;
    return (fl_predicted_velocity){v3_sub(v3_sub(i.v, j.v), lag), i.w, j.w, n};
}

/* Of A's velocity against B at the arms ai and aj. */
static inline fl_vec3 fl_predicted_velocity_at(const fl_predicted_velocity *l, fl_vec3 ai, fl_vec3 aj)
{
    return v3_add(l->v, v3_sub(v3_cross(l->wi, ai), v3_cross(l->wj, aj)));
}

#endif
