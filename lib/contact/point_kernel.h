/* SPDX-License-Identifier: GPL-3.0-or-later */
/* point_kernel.h -- the contact of bodies A and B at one point, by value, for point_force.c and devices.
 *
 *     N = k s^n (1 + chi c) >= 0,   friction by law/tangent.h,   c: approach speed predicted for the end of
 *                                                                the step (contact/velocity_predictor.h)
 *
 * The point is at ai from A's centre and at aj from B's, world axes [m]; n points from B to A.  Forces act on
 * A, and minus them on B; torques are about the two centres.  No call but sqrt. */
#ifndef FL_CONTACT_POINT_KERNEL_H
#define FL_CONTACT_POINT_KERNEL_H
#include "geom/mat3.h"
#include "law/normal.h"
#include "law/tangent.h"

/* What a contact remembers from step to step; see fl_pair. */
typedef struct {
    fl_friction_springs springs;
    fl_vec3 sustained_spin, sustained_spin_rate;
    double max_approach_speed, sustained_load, sustained_load_rate, sustained_step;
} fl_point_memory;

/* Forces of an evaluation. */
typedef struct {
    fl_vec3 force, torque_i, torque_j;
    fl_vec3 force_damping, torque_i_damping, torque_j_damping;
    fl_vec3 force_friction, torque_i_friction, torque_j_friction;
    double energy, spring_energy, overlap;
} fl_point_forces;

typedef struct {
    fl_vec3 v, w, change_v, change_w; /* of the middle of the step, and their predicted changes */
    fl_sym3 linear, angular;          /* inverse mass and inertia, 0 for what no force moves */
} fl_point_body;

typedef struct {
    double k, exponent, friction, tangential_ratio, impact_damping, slow_factor;
} fl_point_law;

typedef struct {
    fl_vec3 n, ai, aj;
    double overlap;
    fl_point_body i, j;
    fl_vec3 lag;                    /* correction of the relative velocity, fl_rotation_lag() [m/s] */
    double reduced_mass;            /* [kg] */
    double contact_count;           /* contacts that damp the two */
    double dt, half_step, at_start; /* of the evaluation, fl_predictor_step */
    double step, step_size;         /* number and size of the step */
    int is_reduced, sustains;       /* M is the reduced mass; the other is a piece of several faces */
    fl_point_law law;
} fl_point_contact;

/* Forces of the step before, 0 if the two did not touch. */
typedef struct {
    fl_vec3 elastic, damping, friction_damping;
    double friction_damping_moment;
} fl_point_before;

/* What friction, rolling and bounds of the step read besides. */
typedef struct {
    fl_vec3 direction; /* sum of N n */
    double elastic, normal, load, slope, chi;
} fl_point_normal;

static inline double fl_point_mobility_along(const fl_point_body *e, fl_vec3 along, fl_vec3 moment)
{
    return v3_dot(along, s3_mul(e->linear, along)) + v3_dot(moment, s3_mul(e->angular, moment));
}

/* Velocity of the point at `arm` from the centre per impulse there. */
static inline fl_sym3 fl_point_compliance(const fl_point_body *e, fl_vec3 arm)
{
    const fl_vec3 x = v3(0, arm.z, -arm.y), y = v3(-arm.z, 0, arm.x), z = v3(arm.y, -arm.x, 0);
    return s3_add(e->linear,
                  s3_products(x, y, z, s3_mul(e->angular, x), s3_mul(e->angular, y), s3_mul(e->angular, z)));
}

/* Mean relative velocity, and its predicted change. */
static inline fl_vec3 fl_point_velocity(const fl_point_contact *c)
{
    return v3_add(v3_sub(v3_add(c->i.v, v3_cross(c->i.w, c->ai)), v3_add(c->j.v, v3_cross(c->j.w, c->aj))),
                  c->lag);
}

static inline fl_vec3 fl_point_velocity_change(const fl_point_contact *c)
{
    return v3_add(v3_sub(v3_sub(c->i.change_v, c->j.change_v), c->lag),
                  v3_sub(v3_cross(c->i.change_w, c->ai), v3_cross(c->j.change_w, c->aj)));
}

/* fl_pair_mass() of the force n at the point. */
static inline double fl_point_mass(const fl_point_contact *c, fl_vec3 ti, fl_vec3 tj)
{
    if (c->is_reduced) return c->reduced_mass;
    const double compliance = fl_point_mobility_along(&c->i, c->n, v3_scale(0.5, ti)) +
                              fl_point_mobility_along(&c->j, c->n, v3_scale(0.5, tj)),
                 mass = v3_norm2(c->n) / compliance;
    return mass - mass == 0.0 ? mass : c->reduced_mass; /* nothing moves */
}

/* The low pass of a sustained load, which acts where there are several points. */
static inline void fl_point_sustain(fl_point_memory *m, const fl_point_contact *c, int touched, double load,
                                    double slope, double mass)
{
    const double omega2 = slope > 0.0 && mass < INFINITY ? slope / mass : 0.0,
                 dt = touched ? (c->step - m->sustained_step) * c->step_size : 0.0;
    const fl_low_pass pass = fl_damping_low_pass(dt, omega2);
    const fl_vec3 w0 = m->sustained_spin, g0 = m->sustained_spin_rate;
    const double load_now = fl_low_pass_after(&pass, m->sustained_load, m->sustained_load_rate, load, dt);
    const fl_vec3 spin =
        v3(fl_low_pass_after(&pass, w0.x, g0.x, 0.0, dt), fl_low_pass_after(&pass, w0.y, g0.y, 0.0, dt),
           fl_low_pass_after(&pass, w0.z, g0.z, 0.0, dt));
    m->sustained_load = load_now;
    m->sustained_load_rate = pass.rate * (load - load_now);
    m->sustained_spin = spin;
    m->sustained_spin_rate = v3_scale(pass.rate, v3_sub(v3(0, 0, 0), spin));
    m->sustained_step = c->step;
}

static inline void fl_point_add_force(fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj, fl_vec3 force, fl_vec3 ai,
                                      fl_vec3 aj)
{
    *f = v3_add(*f, force);
    *ti = v3_add(*ti, v3_cross(ai, force));
    *tj = v3_sub(*tj, v3_cross(aj, force));
}

/* Adds friction at the point, as fl_pair_add_friction(). */
static inline void fl_point_add_friction(fl_point_forces *p, fl_point_memory *m, const fl_point_contact *c,
                                         const fl_point_normal *q, const fl_point_before *before)
{
    const fl_vec3 none = v3(0, 0, 0);
    if (!(c->law.friction > 0.0 && c->law.tangential_ratio > 0.0 && q->normal > 0.0)) {
        m->springs.force = m->springs.damping = none;
        m->springs.k = m->springs.moment = m->springs.k_turn = m->springs.energy = 0.0;
        m->springs.damping_moment = 0.0;
        return;
    }
    fl_friction_contact at;
    at.n = v3_unit(q->direction);
    at.k = c->law.tangential_ratio * q->slope;
    at.g = c->law.tangential_ratio * q->chi * q->elastic;
    at.limit = c->law.friction * q->load;
    at.arm = 0.0, at.elongation = none, at.turn_compliance = 0.0;
    at.compliance.xx = at.compliance.yy = at.compliance.zz = 0.0;
    at.compliance.xy = at.compliance.xz = at.compliance.yz = 0.0;
    if (q->chi > 0.0)
        at.compliance = s3_add(fl_point_compliance(&c->i, c->ai), fl_point_compliance(&c->j, c->aj));
    at.contact_count = c->contact_count;
    const double wi = v3_dot(c->i.w, at.n), wj = v3_dot(c->j.w, at.n),
                 turned = v3_dot(c->i.change_w, at.n) - v3_dot(c->j.change_w, at.n);
    fl_friction_motion by;
    by.v = fl_point_velocity(c);
    by.v_end = v3_add(by.v, fl_point_velocity_change(c));
    by.spin = wi - wj, by.spin_end = wi - wj + turned, by.mean_spin = 0.5 * (wi + wj);
    by.previous_damping = before->friction_damping;
    by.previous_damping_moment = before->friction_damping_moment;
    by.half_step = c->half_step, by.at_start = c->at_start;
    const fl_friction_result t = fl_tangent_step_of(m->springs, at, by, c->dt, 1);
    const fl_vec3 moment = v3_scale(t.moment, at.n);
    m->springs = t.springs;
    fl_point_add_force(&p->force_friction, &p->torque_i_friction, &p->torque_j_friction, t.force, c->ai,
                       c->aj);
    p->torque_i_friction = v3_add(p->torque_i_friction, moment);
    p->torque_j_friction = v3_sub(p->torque_j_friction, moment);
    p->force = v3_add(p->force, p->force_friction);
    p->torque_i = v3_add(p->torque_i, p->torque_i_friction);
    p->torque_j = v3_add(p->torque_j, p->torque_j_friction);
    p->spring_energy = m->springs.energy;
}

static inline fl_point_before fl_point_before_of(const fl_point_forces *p, const fl_point_memory *m)
{
    fl_point_before b;
    b.elastic = v3_madd(v3_madd(p->force, -1.0, p->force_damping), -1.0, p->force_friction);
    b.damping = p->force_damping, b.friction_damping = m->springs.damping;
    b.friction_damping_moment = m->springs.damping_moment;
    return b;
}

/* Evaluates the contact; touched: it touched in the step before.  spring_energy is not yet in energy, since
 * rolling resistance may follow. */
static inline fl_point_normal fl_point_evaluate(const fl_point_contact *c, int touched,
                                                fl_point_before before, fl_point_memory *m,
                                                fl_point_forces *p)
{
    const fl_vec3 none = v3(0, 0, 0), n = c->n;
    const double k = c->law.k;
    fl_point_normal q;
    p->force = p->torque_i = p->torque_j = p->force_damping = p->torque_i_damping = p->torque_j_damping =
        p->force_friction = p->torque_i_friction = p->torque_j_friction = none;
    p->spring_energy = 0.0;
    p->overlap = c->overlap;
    p->energy = k * fl_normal_phi(c->overlap, c->law.exponent);
    /* effective mass, damping factor */
    const fl_vec3 ti = v3_cross(c->ai, n), tj = v3_cross(c->aj, n);
    const double power = fl_normal_power(c->overlap, c->law.exponent), mass = fl_point_mass(c, ti, tj),
                 comes = -v3_dot(n, v3_add(fl_point_velocity(c), fl_point_velocity_change(c)));
    q.slope = k * fl_normal_slope(c->overlap, c->law.exponent);
    if (c->sustains) fl_point_sustain(m, c, touched, k * power, q.slope, mass);
    const double now = comes > 0.0 ? comes : 0.0;
    m->max_approach_speed = touched && m->max_approach_speed > now ? m->max_approach_speed : now;
    q.chi = fl_damping_chi(c->law.impact_damping, c->law.slow_factor, m->max_approach_speed, p->energy, mass);
    /* approach speed at the end of the step */
    q.elastic = k * power;
    const double f2 = v3_norm2(n), size = v3_norm(before.elastic), known = 1.0 - c->at_start,
                 damped = size > 0.0 ? v3_dot(before.elastic, before.damping) / size : 0.0,
                 all = f2 > 0.25 ? f2 : 0.25,
                 compliance =
                     (fl_point_mobility_along(&c->i, n, ti) + fl_point_mobility_along(&c->j, n, tj)) / all;
    const double more =
        fl_damping_end_speed(comes, q.chi * q.elastic, c->half_step * compliance, c->contact_count,
                             known * (q.elastic - size), known * damped, c->at_start) -
        comes;
    q.normal = fl_normal_damped_force(q.elastic, q.chi, comes + more);
    q.direction = v3_madd(none, q.normal, n);
    q.load = v3_norm(q.direction);
    fl_point_add_force(&p->force, &p->torque_i, &p->torque_j, v3_scale(q.normal, n), c->ai, c->aj);
    fl_point_add_force(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping,
                       v3_scale(q.normal - q.elastic, n), c->ai, c->aj);
    fl_point_add_friction(p, m, c, &q, &before);
    return q;
}

#endif
