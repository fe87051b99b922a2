/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "contact/bond_list.h"
#include "contact/crushing.h"
#include "contact/pair_force.h"
#include "contact/pair_geometry.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "contact/pair_surrogate.h"
#include "contact/panel_load.h"
#include "contact/rolling_pair.h"
#include "contact/strip_contact.h"
#include "contact/surrogate_batch.h"
#include "contact/velocity_predictor.h"
#include "law/damping.h"
#include "law/manual.h"
#include "law/material.h"
#include "law/normal.h"
#include "patch/force_sum.h"
#include "patch/patch_law.h"
#include "patch/patch_result.h"
#include "patch/stiffness_bound.h"

/* An overlap below this fraction of the coordinates it results from is rounding error. */
#define ROUNDING 3e-14
/* A contact that begins deeper than this multiple of the motion in the step is sudden: speeds are those of
 * now, and a predicted rotation is longer than its chord. */
#define SUDDEN 2.0

#define INLINE static inline __attribute__((always_inline)) /* vectors by value go through memory */

/* True in one step of four, by a hash: exact evaluations of contacts with a surrogate then compute stiffness
 * bounds.  A fixed period could coincide with that of the evaluations. */
static int stiffness_is_due(const fl_world *w) { return (uint32_t)w->step * UINT32_C(2654435761) >> 30 == 0; }

INLINE void add_wrench(fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj, fl_vec3 force, fl_vec3 ai, fl_vec3 aj)
{
    *f = v3_add(*f, force);
    *ti = v3_add(*ti, v3_cross(ai, force));
    *tj = v3_sub(*tj, v3_cross(aj, force));
}

/* Adds a force and its moment about a point, in the frame of B, times scale.  The point is at ai from A's
 * centre and at aj from B's, world axes. */
INLINE void add_scaled_wrench(fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj, const fl_wrench *w, double scale,
                              const fl_mat3 *R, fl_vec3 ai, fl_vec3 aj)
{
    const fl_vec3 moment = v3_scale(scale, m3_mul(*R, w->m));
    add_wrench(f, ti, tj, v3_scale(scale, m3_mul(*R, w->f)), ai, aj);
    *ti = v3_add(*ti, moment);
    *tj = v3_sub(*tj, moment);
}

INLINE fl_vec3 relative_velocity(const fl_bodies *b, const fl_pair *p, fl_vec3 ai, fl_vec3 aj)
{
    return v3_sub(fl_body_point_velocity(b, p->i, ai), fl_body_point_velocity(b, p->j, aj));
}

/* Input of the velocity predictor.  The mean velocity of A against B in the step is relative_velocity()
 * plus the lag; at the end of the step the predicted change is added. */
typedef struct {
    fl_predictor_step step;
    fl_vec3 lag; /* fl_pair_rotation_lag() [m/s] */
    fl_predicted_change_of_pair change;
    fl_previous_force before;
} prediction;

static prediction prediction_of(const fl_world *w, const fl_pair *p, const fl_relative_pose *r, double dt)
{
    const fl_vec3 lag = fl_pair_rotation_lag(&w->b, p, r->off, dt);
    return (prediction){fl_predictor_step_of(w, dt), lag, fl_predict_change_of_pair(w, p, lag),
                        fl_previous_force_of(p)};
}

/* Correction of the predicted approach speed c; the arguments are those of fl_predict_approach(). */
static double approach_correction(const prediction *a, double c, double elastic, double C, double compliance)
{
    return fl_predict_approach(c, elastic, C, compliance, a->change.contact_count, a->step, a->before) - c;
}

INLINE fl_vec3 mean_velocity(const fl_bodies *b, const fl_pair *p, const prediction *a, fl_vec3 ai,
                             fl_vec3 aj)
{
    return v3_add(relative_velocity(b, p, ai, aj), a->lag);
}

INLINE fl_vec3 end_velocity(const fl_bodies *b, const fl_pair *p, const prediction *a, fl_vec3 ai, fl_vec3 aj)
{
    return v3_add(mean_velocity(b, p, a, ai, aj), fl_predicted_change_at(&a->change, ai, aj));
}

/* Sums over contact points, of which the result of a law of points is made. */
typedef struct {
    fl_patch_result result; /* centre: a contact point */
    fl_vec3 moment;         /* sum of F (p - centre)                            [N m] */
    fl_sym3 second;         /* sum of F (p - centre) (p - centre)^T            [N m2] */
} point_sum;

/* Adds a contact point at `arm` from the first one. */
static void add_pressure(point_sum *s, double elastic, double normal, fl_vec3 n, fl_vec3 arm)
{
    fl_patch_result *const q = &s->result;
    q->elastic += elastic;
    q->normal += normal;
    q->direction = v3_madd(q->direction, normal, n);
    const fl_vec3 a = v3_scale(normal, arm);
    s->moment = v3_add(s->moment, a);
    s->second = s3_add(
        s->second, (fl_sym3){a.x * arm.x, a.x * arm.y, a.x * arm.z, a.y * arm.y, a.y * arm.z, a.z * arm.z});
}

/* The result of n points. */
static fl_patch_result result_of_points(const point_sum *s, int32_t n)
{
    fl_patch_result q = s->result;
    q.load = n > 1 ? q.normal : v3_norm(q.direction);
    if (!(q.normal > 0.0)) return q;
    q.centre = v3_add(q.centre, v3_scale(1.0 / q.normal, s->moment));
    if (n > 1) q.shape = fl_pressure_shape_about(q.normal, s->moment, s->second, v3_unit(q.direction));
    return q;
}

/* Compliance at the contact, as in fl_friction_contact. */
typedef struct {
    fl_sym3 matrix;
    double turn;
} contact_compliance;

/* Adds friction at the centre of pressure. */
static void add_friction(fl_world *w, fl_pair *p, const fl_patch_result *q, double chi,
                         const contact_compliance *at, const fl_relative_pose *r, const prediction *a)
{
    const fl_bodies *b = &w->b;
    const fl_pair_law *law = p->law;
    if (w->breaking.on) p->load_point = v3_add(q->centre, r->off);
    if (!(law->friction > 0.0 && law->tangential_ratio > 0.0 && q->normal > 0.0)) {
        p->springs = (fl_friction_springs){0};
        return;
    }
    const fl_vec3 aj = q->centre, ai = v3_add(aj, r->off);
    const fl_friction_contact c = {.n = v3_unit(q->direction),
                                   .k = law->tangential_ratio * q->slope,
                                   .g = law->tangential_ratio * chi * q->elastic,
                                   .limit = law->friction * q->load,
                                   .arm = q->shape.arm,
                                   .elongation = q->shape.elongation,
                                   .compliance = at->matrix,
                                   .turn_compliance = at->turn,
                                   .contact_count = a->change.contact_count};
    const double wi = v3_dot(b->w[p->i], c.n), wj = v3_dot(b->w[p->j], c.n),
                 turned = v3_dot(a->change.wi, c.n) - v3_dot(a->change.wj, c.n);
    const fl_vec3 v = mean_velocity(b, p, a, ai, aj);
    const fl_friction_motion by = {v,
                                   v3_add(v, fl_predicted_change_at(&a->change, ai, aj)),
                                   wi - wj,
                                   wi - wj + turned,
                                   0.5 * (wi + wj),
                                   a->before.friction_damping,
                                   a->before.friction_damping_moment,
                                   a->step.half_step,
                                   a->step.at_start};
    const fl_friction_result t = fl_tangent_step_of(p->springs, c, by, a->step.dt, 1);
    const fl_vec3 m = v3_scale(t.moment, c.n);
    p->springs = t.springs;
    add_wrench(&p->force_friction, &p->torque_i_friction, &p->torque_j_friction, t.force, ai, aj);
    p->torque_i_friction = v3_add(p->torque_i_friction, m);
    p->torque_j_friction = v3_sub(p->torque_j_friction, m);
    p->force = v3_add(p->force, p->force_friction);
    p->torque_i = v3_add(p->torque_i, p->torque_i_friction);
    p->torque_j = v3_add(p->torque_j, p->torque_j_friction);
    p->spring_energy = p->springs.energy;
}

/* Largest 1/I of body k, 0 if it cannot rotate [1/kg m2]. */
static double max_inverse_inertia(const fl_world *w, int32_t k)
{
    const int held = FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ;
    if (k >= w->n || (w->b.fixed_dof[k] & held) == held) return 0.0;
    return fmax(w->b.invI[k].x, fmax(w->b.invI[k].y, w->b.invI[k].z));
}

/* Adds the rolling resistance of a sphere, a moment on both, if its law has one.  -1 when memory runs out. */
static int add_rolling(fl_world *w, fl_pair *p, const fl_patch_result *q, double chi, const prediction *a)
{
    const fl_bodies *b = &w->b;
    fl_err lost = {0};
    if (!w->has_rolling || !fl_pair_has_rolling(w, p)) return 0;
    const double arm = fl_material_radius(fl_rolling_radius(w, p->i), fl_rolling_radius(w, p->j)),
                 mu = p->law->rolling, part = fl_rolling_stiffness_ratio(mu);
    if (!p->rolling && !(p->rolling = fl_alloc(1, sizeof *p->rolling, &lost))) return -1;
    const fl_vec3 wi = b->w[p->i], wj = b->w[p->j], turns = v3_scale(arm, v3_sub(wi, wj));
    const fl_tangent_spring c = {.k = part * q->slope,
                                 .g = part * chi * q->elastic,
                                 .limit = mu * fmax(q->normal, 0.0),
                                 .inv_mass = arm * arm *
                                             (max_inverse_inertia(w, p->i) + max_inverse_inertia(w, p->j)),
                                 .contact_count = a->change.contact_count};
    const fl_rolling_motion by = {turns, v3_madd(turns, arm, v3_sub(a->change.wi, a->change.wj)),
                                  v3_scale(0.5, v3_add(wi, wj))};
    p->rolling->arm = arm;
    *p->rolling = fl_rolling_step(*p->rolling, c, by, a->step.dt, a->step.half_step, a->step.at_start);
    const fl_vec3 m = fl_rolling_moment(p->rolling);
    p->torque_i_friction = v3_add(p->torque_i_friction, m),
    p->torque_j_friction = v3_sub(p->torque_j_friction, m);
    p->torque_i = v3_add(p->torque_i, m), p->torque_j = v3_sub(p->torque_j, m);
    p->spring_energy += fl_rolling_energy(*p->rolling);
    return 0;
}

/* Adds the springs of friction and rolling to the stiffness and bounds omega^2. */
static void bound_stiffness(const fl_world *w, fl_pair *p, const fl_patch_result *q,
                            const fl_relative_pose *r, fl_stiffness *si, fl_stiffness *sj)
{
    const fl_bodies *b = &w->b;
    if (p->springs.k > 0.0) {
        const fl_vec3 n = v3_unit(q->direction), aj = q->centre;
        const fl_vec3 ai = v3_add(aj, r->off), none = v3(0, 0, 0);
        fl_stiffness_add_tangential(si, b, p->i, p->springs.k, n, ai);
        fl_stiffness_add_tangential(sj, b, p->j, p->springs.k, n, aj);
        fl_stiffness_add_force(si, b, p->i, p->springs.k_turn, none, n);
        fl_stiffness_add_force(sj, b, p->j, p->springs.k_turn, none, n);
    }
    for (int axis = 0; axis < 3 && p->rolling; axis++) {
        const fl_vec3 e = v3(axis == 0, axis == 1, axis == 2), none = v3(0, 0, 0);
        fl_stiffness_add_force(si, b, p->i, fl_rolling_turn_stiffness(p->rolling), none, e);
        fl_stiffness_add_force(sj, b, p->j, fl_rolling_turn_stiffness(p->rolling), none, e);
    }
    p->omega2_i = fl_stiffness_bound(si);
    p->omega2_j = fl_stiffness_bound(sj);
}

/* The same for a contact that pushes along n at one point. */
static void bound_stiffness_of_point(const fl_world *w, fl_pair *p, const fl_patch_result *q, fl_vec3 n,
                                     const fl_relative_pose *r)
{
    fl_stiffness si = {0}, sj = {0};
    fl_stiffness_add_force(&si, &w->b, p->i, q->slope, n, v3_cross(v3_add(q->centre, r->off), n));
    fl_stiffness_add_force(&sj, &w->b, p->j, q->slope, n, v3_cross(q->centre, n));
    bound_stiffness(w, p, q, r, &si, &sj);
}

/* Damping factor of all points of a pair,
 *     chi = D / max(v_touch, c sqrt(2 W / M)),
 * with v_touch the largest approach speed of this contact, `now` the present one, and sqrt(2 W/M) the speed
 * of the stored energy W, c of fl_damping_slow_factor().  In an impact v_touch is the larger one and D sets
 * the restitution.  In a contact that began without an impact the damping ratio stays below D/(2 c). */
static double damping_factor(fl_pair *p, double now, double mass)
{
    p->max_approach_speed = p->touching && p->max_approach_speed > now ? p->max_approach_speed : now;
    return fl_damping_chi(p->law->impact_damping, p->law->slow_damping_factor, p->max_approach_speed,
                          p->energy, mass);
}

/* True if the other body is a piece of the structure that may have several faces, which bodies pass. */
static int is_on_facets(const fl_world *w, const fl_pair *p)
{
    const fl_piece *piece = fl_world_piece(w, p->j);
    return piece && piece->kind != FL_PIECE_PLANE;
}

/* lambda of law/damping.h; updates the sustained load and spin.
 *   load, slope, mass   sum of the pressures, its stiffness, effective mass
 *   u, spin             sliding speed of the cores and spin, both across the normal
 *   sigma2              variance of the approach speeds */
static double sustained_share(const fl_world *w, fl_pair *p, double load, double slope, double mass,
                              fl_vec3 u, fl_vec3 spin, double sigma2)
{
    const double now = (double)w->step, omega2 = slope > 0.0 && mass < INFINITY ? slope / mass : 0.0,
                 dt = p->touching ? (now - p->sustained_step) * w->dt : 0.0;
    const fl_low_pass pass = fl_damping_low_pass(dt, omega2);
    const fl_vec3 w0 = p->sustained_spin, g0 = p->sustained_spin_rate;
    const double load_now = fl_low_pass_after(&pass, p->sustained_load, p->sustained_load_rate, load, dt);
    const fl_vec3 spin_now =
        v3(fl_low_pass_after(&pass, w0.x, g0.x, spin.x, dt), fl_low_pass_after(&pass, w0.y, g0.y, spin.y, dt),
           fl_low_pass_after(&pass, w0.z, g0.z, spin.z, dt));
    p->sustained_load = load_now;
    p->sustained_load_rate = pass.rate * (load - load_now);
    p->sustained_spin = spin_now;
    p->sustained_spin_rate = v3_scale(pass.rate, v3_sub(spin, spin_now));
    p->sustained_step = now;
    return fl_damping_sustained_share(load_now, load) * fl_damping_passing_share(v3_norm2(u), sigma2) *
           fl_damping_steady_share(v3_dot(spin, spin_now), v3_norm2(spin), v3_norm2(spin_now));
}

/* A contact point in world axes. */
typedef struct {
    fl_vec3 n, ai, aj; /* normal; from the centres of A and B */
    double weight;     /* phi'(s), with the sign of the point */
} world_point;

static world_point world_point_of(const fl_pair *p, const fl_patch_point *q, const fl_relative_pose *r)
{
    world_point t = {.n = m3_mul(r->R, q->n), .aj = m3_mul(r->R, q->p)};
    t.ai = v3_add(t.aj, r->off);
    t.weight = q->du * fl_normal_power(q->overlap, p->exponent);
    return t;
}

/* The same for points that push along their normals; points of negative weight take nothing off. */
static void bound_stiffness_of_points(const fl_world *w, fl_pair *p, const fl_patch_points *s,
                                      const fl_patch_result *all, const fl_relative_pose *r)
{
    fl_stiffness si = {0}, sj = {0};
    for (int32_t c = 0; c < s->n; c++) {
        const fl_patch_point *q = &s->point[c];
        const world_point t = world_point_of(p, q, r);
        const double slope = p->k * fl_normal_slope(q->overlap, p->exponent);
        if (q->du < 0.0) continue;
        fl_stiffness_add_force(&si, &w->b, p->i, slope, t.n, v3_cross(t.ai, t.n));
        fl_stiffness_add_force(&sj, &w->b, p->j, slope, t.n, v3_cross(t.aj, t.n));
    }
    bound_stiffness(w, p, all, r, &si, &sj);
}

/* Predicted approach speed along n [m/s]. */
static double approach_speed_of(const fl_bodies *b, const fl_pair *p, const prediction *a,
                                const world_point *t)
{
    return -v3_dot(t->n, end_velocity(b, p, a, t->ai, t->aj));
}

/* Evaluates springs at closest points: W = k sum of phi(s), mostly of one point.  The previous force of a
 * point is known only of a single point that is the same as a step ago.  Other points are damped by the
 * speed of half a step ago.  1 when they touch, -1 when memory runs out. */
static int evaluate_points(fl_world *w, fl_pair *p, const fl_patch_points *s, const fl_relative_pose *r,
                           const prediction *by, int survey)
{
    const fl_bodies *b = &w->b;
    const int one = s->n == 1 && p->law->law->end_speed;
    const prediction unpredicted = {.step = by->step, .lag = by->lag, .change = {.contact_count = 1.0}},
                     *const a = one ? by : &unpredicted;
    const double k = p->k;
    const world_point first = world_point_of(p, &s->point[0], r);
    fl_vec3 way = first.n, turn_i = v3_cross(first.ai, first.n), turn_j = v3_cross(first.aj, first.n);
    double sum = first.weight, less = 1.0;
    p->overlap = s->point[0].overlap;
    p->energy = k * fl_normal_phi(p->overlap, p->exponent);
    if (s->n > 1) { /* the force of all is less than the sum of its parts */
        way = v3_scale(sum, way), turn_i = v3_scale(sum, turn_i), turn_j = v3_scale(sum, turn_j);
        for (int32_t c = 1; c < s->n; c++) {
            const fl_patch_point *q = &s->point[c];
            const world_point t = world_point_of(p, q, r);
            sum += t.weight;
            way = v3_madd(way, t.weight, t.n);
            turn_i = v3_madd(turn_i, t.weight, v3_cross(t.ai, t.n));
            turn_j = v3_madd(turn_j, t.weight, v3_cross(t.aj, t.n));
            p->energy += q->du * k * fl_normal_phi(q->overlap, p->exponent);
            p->overlap = fmax(p->overlap, q->overlap);
        }
        less = v3_norm2(way) / (sum * sum);
    }
    fl_pair_mobility ease;
    if (one || !fl_pair_has_reduced_mass(w, p)) ease = fl_pair_mobility_of(w, p);
    const double mass = less > 0.0 ? fl_pair_mass(w, p, &ease, way, turn_i, turn_j) / less : INFINITY;
    const double first_approach = approach_speed_of(b, p, a, &first);
    double approach = first_approach, mean = 0.0, sustained = 0.0;
    if (is_on_facets(w, p)) { /* a sphere: its spin does not matter, and its core is its centre */
        double load = 0.0, stiff = 0.0, square = 0.0;
        for (int32_t c = 0; c < s->n; c++) {
            const fl_patch_point *q = &s->point[c];
            const world_point t = c ? world_point_of(p, q, r) : first;
            const double comes = c ? approach_speed_of(b, p, a, &t) : first_approach;
            mean += t.weight * comes, square += t.weight * comes * comes;
            load += k * t.weight;
            stiff += k * q->du * fl_normal_slope(q->overlap, p->exponent);
        }
        mean /= sum;
        const fl_vec3 n = v3_unit(way), u = end_velocity(b, p, a, v3(0, 0, 0), v3_neg(r->off));
        sustained = sustained_share(w, p, load, stiff, mass, v3_madd(u, -v3_dot(u, n), n), v3(0, 0, 0),
                                    fmax(square / sum - mean * mean, 0.0));
    }
    for (int32_t c = 1; c < s->n; c++) {
        const world_point t = world_point_of(p, &s->point[c], r);
        if (s->point[c].du > 0.0) approach = fmax(approach, approach_speed_of(b, p, a, &t));
    }
    const double chi = damping_factor(p, approach > 0.0 ? approach : 0.0, mass), push = k * first.weight,
                 more = one ? approach_correction(a, first_approach, push, chi * push,
                                                  fl_pair_compliance(&ease, way, turn_i, turn_j, 1.0))
                            : 0.0;
    point_sum sums = {.result.centre = first.aj};
    for (int32_t c = 0; c < s->n; c++) {
        const fl_patch_point *q = &s->point[c];
        const world_point t = c ? world_point_of(p, q, r) : first;
        const double elastic = k * t.weight, slope = k * q->du * fl_normal_slope(q->overlap, p->exponent),
                     own = c ? approach_speed_of(b, p, a, &t) : first_approach,
                     comes = s->n > 1 ? own + sustained * (mean - own) : own,
                     normal = q->du * fl_normal_damped_force(fabs(elastic), chi, comes + more);
        add_wrench(&p->force, &p->torque_i, &p->torque_j, v3_scale(normal, t.n), t.ai, t.aj);
        add_wrench(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping,
                   v3_scale(normal - elastic, t.n), t.ai, t.aj);
        add_pressure(&sums, elastic, normal, t.n, v3_sub(t.aj, first.aj));
        sums.result.slope += slope;
    }
    const fl_patch_result all = result_of_points(&sums, s->n);
    contact_compliance at_contact = {.turn = 0.0};
    if (one && chi > 0.0 && p->law->friction > 0.0)
        at_contact.matrix = fl_pair_compliance_matrix(&ease, first.ai, first.aj);
    add_friction(w, p, &all, chi, &at_contact, r, a);
    if (add_rolling(w, p, &all, chi, a)) return -1;
    if (survey) bound_stiffness_of_points(w, p, s, &all, r);
    p->energy += p->spring_energy;
    if (fl_panels_need_points(w, p)) fl_panels_record_points(w, p, s, p->k, chi);
    return p->touching = 1;
}

/* Stiffness of a patch: W'' = scale (U'' - U'^2/2U), of which the springs of the points are the first term.
 * ai, aj: the first point from the centres. */
static void add_patch_stiffness(const fl_world *w, const fl_pair *p, const fl_spring_sums *q, fl_mat3 R,
                                fl_vec3 ai, fl_vec3 aj, double scale, double U, fl_stiffness *si,
                                fl_stiffness *sj)
{
    const fl_bodies *b = &w->b;
    const double half = 0.5 / (scale * U);
    *si = *sj = (fl_stiffness){0};
    fl_stiffness_add_springs(si, b, p->i, scale, q, R, ai);
    fl_stiffness_add_springs(sj, b, p->j, scale, q, R, aj);
    fl_stiffness_add_force(si, b, p->i, -half, p->force, p->torque_i);
    fl_stiffness_add_force(sj, b, p->j, -half, p->force, p->torque_j);
}

/* Replaces the damping of p by fl_stabilised_damping(), while its force is still the elastic one.
 * pressure: sum of the pressures. */
static void stabilise_damping(fl_pair *p, double total_pressure, double chi, const fl_relative_pose *r,
                              const prediction *a)
{
    const fl_wrench to = fl_stabilised_damping(
        fl_wrench_about_middle(p->force, p->torque_i, p->torque_j),
        fl_wrench_about_middle(p->force_damping, p->torque_i_damping, p->torque_j_damping), total_pressure,
        2.0 * a->step.half_step * chi * total_pressure / p->mass, a->change.contact_count, a->before,
        a->step.at_start);
    const fl_vec3 half = v3_scale(0.5, v3_cross(r->off, to.f));
    p->force_damping = to.f, p->torque_i_damping = v3_add(half, to.m),
    p->torque_j_damping = v3_sub(half, to.m);
}

/* Adds damping and friction to the elastic force of a patch.  q: sums over the points, to be multiplied by
 * scale, about the point at aj from B's centre; slope: dF/ds. */
static fl_patch_result add_damping_and_friction(fl_world *w, fl_pair *p, const fl_force_sum *q, double scale,
                                                double slope, double chi, const contact_compliance *at,
                                                const fl_relative_pose *r, fl_vec3 aj, const prediction *a)
{
    const fl_mat3 *R = &r->R;
    add_scaled_wrench(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping, &q->damping, scale, R,
                      v3_add(aj, r->off), aj);
    stabilise_damping(p, scale * q->pressure, chi, r, a);
    p->force = v3_add(p->force, p->force_damping);
    p->torque_i = v3_add(p->torque_i, p->torque_i_damping);
    p->torque_j = v3_add(p->torque_j, p->torque_j_damping);
    const fl_patch_result all = fl_patch_result_of(q, p->energy, scale, slope, R, aj);
    add_friction(w, p, &all, chi, at, r, a);
    return all;
}

/* lambda of a patch.  elastic: the force; spin: relative spin, world axes. */
static double sustained_share_of_patch(const fl_world *w, fl_pair *p, const fl_patch_points *s,
                                       const fl_force_sum *q, const fl_exact_contact *exact, fl_vec3 elastic,
                                       const fl_relative_pose *r, const prediction *a, fl_vec3 spin,
                                       double mass)
{
    const fl_bodies *b = &w->b;
    if (!(q->pressure > 0.0)) return 0.0;
    const double each = 1.0 / q->pressure, mean = each * q->pressure_rate;
    const fl_vec3 n = v3_unit(elastic), aj = m3_mul(r->R, v3_madd(s->point[0].p, each, q->pressure_moment)),
                  core = end_velocity(b, p, a,
                                      v3_madd(v3_add(aj, r->off), p->radius_factor * b->radius[p->i], n),
                                      v3_madd(aj, -p->radius_factor * b->radius[p->j], n));
    return sustained_share(w, p, exact->scale * q->pressure, exact->slope, mass,
                           v3_madd(core, -v3_dot(core, n), n), v3_madd(spin, -v3_dot(spin, n), n),
                           fmax(each * fl_force_sum_square(s) - mean * mean, 0.0));
}

/* --- exact evaluation -------------------------------------------------------------------------- */

/* Evaluates a patch, W = k sqrt(U), each point with its share of dW/dU; t as in fl_pair_update_surrogate().
 * 1 when they touch, 0 when they do not, -1 when memory runs out. */
static int evaluate_patch(fl_world *w, fl_pair *p, int32_t thread, const fl_surrogate_value *t,
                          const fl_relative_pose *r, const prediction *a, int survey)
{
    const fl_bodies *b = &w->b;
    const fl_mat3 R = r->R;
    fl_patch_points *s = &w->scratch[thread];
    const int crushes = fl_pair_crushes(w, p),
              has_surrogate = p->law->surrogate_tolerance > 0.0 && !fl_panels_need_points(w, p) && !crushes;
    if (s->n == 0) return 0;
    const fl_vec3 at = s->point[0].p, aj = m3_mul(R, at), ai = v3_add(aj, r->off);
    fl_force_sum q;
    if (fl_force_sum_elastic(s, &q)) return -1;
    if (!(q.u > 0.0 && q.overlap > ROUNDING * (v3_norm(r->o) + b->bounding_radius[p->i]))) return 0;
    fl_exact_contact exact;
    fl_exact_contact_find(w, p, s, r, &q, &exact);
    double limit = INFINITY, stiffer = 1.0;
    int yields = 0;
    if (crushes) {
        const double scale = exact.scale, slope = exact.slope;
        yields =
            fl_crushing_yield(w, p, r, &q, v3_madd(at, 1.0 / q.pressure, q.pressure_moment), &exact, &limit);
        if (yields < 0) return -1;
        stiffer = exact.slope != slope ? fmax((exact.slope / slope) * (scale / exact.scale), 1.0) : 1.0;
    }
    p->overlap = q.overlap;
    p->energy = exact.energy;
    add_scaled_wrench(&p->force, &p->torque_i, &p->torque_j, &q.gradient, exact.scale, &R, ai, aj);
    const fl_vec3 elastic = p->force;
    contact_compliance at_contact;
    double compliance = exact.inv_mass, mass = p->mass;
    if (!fl_pair_is_free(w, p)) {
        const fl_pair_mobility ease = fl_pair_mobility_of(w, p);
        const fl_vec3 middle = m3_mul(R, v3_scale(1.0 / q.pressure, q.pressure_moment));
        mass = fl_pair_mass(w, p, &ease, elastic, p->torque_i, p->torque_j);
        at_contact.matrix = fl_pair_compliance_matrix(&ease, v3_add(ai, middle), v3_add(aj, middle));
        at_contact.turn = fl_pair_turn_compliance(&ease, v3_unit(elastic));
        compliance = fl_pair_compliance(&ease, elastic, p->torque_i, p->torque_j, exact.scale * q.pressure);
    } else {
        at_contact.matrix = s3_rotated(exact.compliance, m3_col(R, 0), m3_col(R, 1), m3_col(R, 2));
        at_contact.turn = exact.turn_compliance;
    }
    const fl_vec3 spin = v3_add(v3_sub(b->w[p->i], b->w[p->j]), v3_sub(a->change.wi, a->change.wj));
    const fl_vec3 v = m3_tmul(R, end_velocity(b, p, a, ai, aj)), turn = m3_tmul(R, spin);
    if (fl_force_sum_motion(s, v, turn, &q)) return -1;
    const double damping = damping_factor(p, q.du > 0.0 ? q.du_approach / q.du : 0.0, mass),
                 coming = q.pressure_rate / q.pressure, room = limit / v3_norm(elastic) - 1.0,
                 chi = yields                    ? 0.0
                       : coming * damping > room ? fmax(room, 0.0) / coming
                                                 : damping;
    const double sustained =
        is_on_facets(w, p) ? sustained_share_of_patch(w, p, s, &q, &exact, elastic, r, a, spin, mass) : 0.0;
    const double size = v3_norm(elastic),
                 more = fl_predictor_share(size, exact.scale * q.pressure) *
                        approach_correction(a, q.pressure_rate / q.pressure, size, chi * size, compliance);
    const double whole = fl_damping_whole_approach(
        q.pressure_rate / q.pressure, -(v3_dot(q.gradient.f, v) + v3_dot(q.gradient.m, turn)) / q.pressure);
    fl_force_sum_damping(s, chi, more, sustained, whole, &q);
    fl_stiffness si, sj;
    fl_spring_sums point_springs;
    if (survey || has_surrogate) fl_force_sum_springs(s, &point_springs);
    survey |= has_surrogate && (!t || stiffness_is_due(w));
    if (survey) add_patch_stiffness(w, p, &point_springs, R, ai, aj, stiffer * exact.scale, q.u, &si, &sj);
    if (t && fl_surrogate_in_double_range(p->surrogate, t) && fabs(exact.slope - t->slope) < 0.5 * t->slope)
        fl_tangent_rescale(&p->springs, exact.slope / t->slope, exact.slope < p->surrogate->slope);
    const fl_patch_result all =
        add_damping_and_friction(w, p, &q, exact.scale, exact.slope, chi, &at_contact, r, aj, a);
    if (survey) bound_stiffness(w, p, &all, r, &si, &sj);
    if (has_surrogate) {
        const double speed = v3_dot(v3_unit(elastic), relative_velocity(b, p, ai, aj));
        fl_pressure_moments pressing;
        fl_force_sum_pressure(s, &pressing);
        exact.springs = &point_springs, exact.pressing = &pressing;
        exact.v = v, exact.spin = turn, exact.impact_damping = chi, exact.speed_offset = more;
        /* the force at the energy of the motion, since W grows as its square */
        exact.motion_force = sqrt(1.0 + 0.5 * mass * speed * speed / p->energy);
        exact.stiffness_i = p->omega2_i, exact.stiffness_j = p->omega2_j;
        if (fl_exact_contact_free_path(w, p, thread, &exact) ||
            fl_pair_update_surrogate(w, p, thread, t, &exact))
            return -1;
    }
    p->energy += p->spring_energy;
    if (fl_panels_need_points(w, p)) {
        for (int32_t k = 0; k < s->n; k++)
            s->point[k].approach_speed =
                (1.0 - sustained) * fl_force_sum_approach_speed(s, k) + (sustained * whole + more);
        fl_panels_record_points(w, p, s, exact.scale, chi);
    }
    return p->touching = 1;
}

/* Damping of the law `quick`: a wrench on A about the midpoint of the centres, world axes.
 *
 *     D = chi F (c e + (dE/dt - (e.dE/dt) e)/K),    e = E/F
 *
 *   E, F    elastic wrench, and the size of its force
 *   c       approach speed along the force at the centre of pressure, at the end of the step
 *   dE/dt   rate of the wrench in the step since `before`, as seen by axes that turn with the mean of both
 *   bodies K       dF/ds
 * A speed along the force is damped as in Hunt and Crossley's law; what turns or moves the pressure, as
 * rocking does, is damped by the same coefficient chi F, which a point or area of the contact has.  The
 * second part is held below the moment and force that the pressure can have.
 *   arm   radius of the pressure [m] */
static fl_wrench change_damping(const fl_pair *p, const prediction *a, fl_wrench before, fl_vec3 spin,
                                double chi, double c, double slope, double arm)
{
    const fl_wrench E = fl_wrench_about_middle(p->force, p->torque_i, p->torque_j);
    const double size = v3_norm(E.f), lowest = -1.0 / chi, speed = c > lowest ? c : lowest;
    fl_wrench damping = {v3_scale(chi * speed, E.f), v3_scale(chi * speed, E.m)};
    if (!(a->step.dt > 0.0 && slope > 0.0 && v3_norm2(before.f) > 0.0)) return damping;
    const double dt = a->step.dt;
    fl_wrench rate = {v3_sub(v3_sub(E.f, before.f), v3_scale(dt, v3_cross(spin, before.f))),
                      v3_sub(v3_sub(E.m, before.m), v3_scale(dt, v3_cross(spin, before.m)))};
    rate = fl_wrench_madd(rate, -v3_dot(E.f, rate.f) / (size * size), E);
    /* force over the load, moment over the load and its arm */
    const double by = chi * size / (slope * dt), load = size * (1.0 + chi * speed),
                 much = by * (v3_norm(rate.f) + (arm > 0.0 ? v3_norm(rate.m) / arm : 0.0)),
                 part = much > load ? load / much : 1.0;
    return fl_wrench_madd(damping, by * part, rate);
}

/* The springs, as s^2 over an area, spread farther than the pressure, as s^3: where a face is tilted by 7/5.
 * With that the bound came out 5 % below the highest frequency of a heap (S05 of verify_step).  Neither
 * follows from the terms: of 2000 poses of two boxes the bound is 1.5 to 1.6 times the largest omega^2 found
 * by differences (median), but 0.27 at least, for the weights of edges and crossings change within a small
 * part of R. */
#define QUICK_SPREAD 1.4
#define QUICK_MARGIN 1.2

/* Springs that bound those of the terms. */
static fl_spring_sums bounding_springs(const fl_quick_sums *q, const fl_sym3 *second)
{
    fl_spring_sums at = fl_quick_springs(q, second, QUICK_MARGIN * q->ddu);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) at.angular[r][c] *= QUICK_SPREAD;
    return at;
}

/* The elastic wrench of the step before, about the midpoint.  By a surrogate it has an error, nearly that of
 * the value t for the present pose, which is no rate: it is taken off. */
static fl_wrench wrench_before(const fl_pair *p, const prediction *a, const fl_surrogate_value *t,
                               const fl_relative_pose *r)
{
    if (!t || !p->surrogate->used || !fl_surrogate_in_double_range(p->surrogate, t)) return a->before.elastic;
    const fl_wrench now = fl_wrench_about_middle(p->force, p->torque_i, p->torque_j);
    const fl_vec3 f = m3_mul(r->R, t->gradient.f), at = v3_madd(m3_mul(r->R, t->point), 0.5, r->off);
    const fl_wrench value = {f, v3_add(v3_cross(at, f), m3_mul(r->R, t->gradient.m))};
    return fl_wrench_madd(fl_wrench_madd(a->before.elastic, 1.0, now), -1.0, value);
}

/* Builds the surrogate of a pair of the law `quick`; size, mass: of the elastic force.  -1 when memory runs
 * out. */
static int update_quick_surrogate(fl_world *w, fl_pair *p, int32_t thread, const fl_quick_sums *q,
                                  const fl_surrogate_value *t, const fl_relative_pose *r, fl_vec3 n,
                                  double mass)
{
    fl_quick_exact rest;
    fl_exact_contact exact;
    fl_exact_contact_of_quick(w, p, r, q, &rest, &exact);
    const fl_vec3 aj = m3_mul(r->R, exact.first), ai = v3_add(aj, r->off);
    const double speed = v3_dot(n, relative_velocity(&w->b, p, ai, aj));
    /* the force at the energy of the motion, since W grows as its square */
    exact.motion_force = sqrt(1.0 + 0.5 * mass * speed * speed / exact.energy);
    exact.stiffness_i = p->omega2_i, exact.stiffness_j = p->omega2_j;
    return fl_exact_contact_free_path(w, p, thread, &exact) ||
                   fl_pair_update_surrogate(w, p, thread, t, &exact)
               ? -1
               : 0;
}

/* Evaluates the law `quick`, W = k sqrt(U); t as in fl_pair_update_surrogate().  1 when they touch, 0 when
 * they do not, -1 when memory runs out. */
static int evaluate_quick(fl_world *w, fl_pair *p, int32_t thread, const fl_quick_sums *q,
                          const fl_surrogate_value *t, const fl_relative_pose *r, const prediction *a,
                          int survey)
{
    const int has_surrogate = p->law->surrogate_tolerance > 0.0 && !fl_panels_need_points(w, p);
    const fl_bodies *b = &w->b;
    const fl_mat3 R = r->R;
    const fl_vec3 none = v3(0, 0, 0);
    if (!(q->u > 0.0 && q->overlap > ROUNDING * (v3_norm(r->o) + b->bounding_radius[p->i]))) return 0;
    const double energy = p->k * sqrt(q->u), scale = 0.5 * energy / q->u, each = 1.0 / q->pressure,
                 slope = scale * (q->ddu - 0.5 * q->pressure * q->pressure / q->u);
    const fl_vec3 centre = v3_scale(each, q->moment), aj = m3_mul(R, centre), ai = v3_add(aj, r->off);
    const fl_sym3 second = fl_quick_second_moments(q);
    const double spread = second.xx + second.yy + second.zz, arm = spread > 0.0 ? sqrt(spread) : 0.0;
    p->overlap = q->overlap;
    p->energy = energy;
    add_scaled_wrench(&p->force, &p->torque_i, &p->torque_j, &q->gradient, scale, &R, r->off, none);
    const fl_vec3 elastic = p->force, n = v3_unit(elastic);
    const fl_pair_mobility ease = fl_pair_mobility_of(w, p);
    const double pressed = scale * q->pressure, size = v3_norm(elastic),
                 mass = fl_pair_mass(w, p, &ease, elastic, p->torque_i, p->torque_j),
                 compliance = fl_pair_compliance(&ease, elastic, p->torque_i, p->torque_j, pressed),
                 predicted = -v3_dot(n, end_velocity(b, p, a, ai, aj)),
                 chi = damping_factor(p, predicted > 0.0 ? predicted : 0.0, mass);
    contact_compliance at_contact = {.turn = 0.0};
    double damped = 1.0;
    if (chi > 0.0) {
        const double more = fl_predictor_share(size, pressed) *
                            approach_correction(a, predicted, size, chi * size, compliance);
        const fl_vec3 spin = v3_scale(0.5, v3_add(b->w[p->i], b->w[p->j])), off = v3_scale(0.5, r->off);
        const fl_wrench D =
            change_damping(p, a, wrench_before(p, a, t, r), spin, chi, predicted + more, slope, arm);
        p->force_damping = D.f;
        p->torque_i_damping = v3_add(v3_cross(off, D.f), D.m);
        p->torque_j_damping = v3_sub(v3_cross(off, D.f), D.m);
        stabilise_damping(p, pressed, chi, r, a);
        damped = fmax(0.0, 1.0 + chi * (predicted + more));
        if (p->law->friction > 0.0) {
            at_contact.matrix = fl_pair_compliance_matrix(&ease, ai, aj);
            at_contact.turn = fl_pair_turn_compliance(&ease, n);
        }
    }
    p->force = v3_add(p->force, p->force_damping);
    p->torque_i = v3_add(p->torque_i, p->torque_i_damping);
    p->torque_j = v3_add(p->torque_j, p->torque_j_damping);
    const fl_vec3 normal = v3_unit(q->direction);
    fl_patch_result all = {.energy = energy,
                           .force = elastic,
                           .elastic = pressed,
                           .normal = damped * pressed,
                           .direction = v3_scale(damped * scale, m3_mul(R, q->direction)),
                           .centre = aj,
                           .shape = fl_pressure_shape_of(second, normal),
                           .slope = slope};
    all.load = v3_norm(all.direction);
    all.couple = v3_sub(v3_scale(scale, m3_mul(R, q->gradient.m)), v3_cross(aj, elastic));
    all.shape.elongation = m3_mul(R, all.shape.elongation);
    if (t && fl_surrogate_in_double_range(p->surrogate, t) && fabs(slope - t->slope) < 0.5 * t->slope)
        fl_tangent_rescale(&p->springs, slope / t->slope, slope < p->surrogate->slope);
    add_friction(w, p, &all, chi, &at_contact, r, a);
    survey |= has_surrogate && (!t || stiffness_is_due(w));
    if (survey) {
        const fl_spring_sums at = bounding_springs(q, &second);
        fl_stiffness si, sj;
        const fl_vec3 force = p->force, ti = p->torque_i, tj = p->torque_j;
        p->force = elastic;
        p->torque_i = v3_sub(v3_sub(ti, p->torque_i_damping), p->torque_i_friction);
        p->torque_j = v3_sub(v3_sub(tj, p->torque_j_damping), p->torque_j_friction);
        add_patch_stiffness(w, p, &at, R, ai, aj, scale, q->u, &si, &sj);
        p->force = force, p->torque_i = ti, p->torque_j = tj;
        bound_stiffness(w, p, &all, r, &si, &sj);
    }
    if (has_surrogate && update_quick_surrogate(w, p, thread, q, t, r, n, mass)) return -1;
    p->energy += p->spring_energy;
    return p->touching = 1;
}

/* Evaluates an elastic wall: force, moment and energy of Winkler's foundation under the part of A behind
 * the wall, and a dashpot at the centre of pressure, which never pulls.  The approach speed is the same
 * along the normal, so the centre may lie behind the wall. */
static int evaluate_elastic_wall(fl_world *w, fl_pair *p, const fl_relative_pose *r, const prediction *a,
                                 int survey, double *distance)
{
    const fl_bodies *b = &w->b;
    const int32_t i = p->i;
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_vec3 n = m3_col(r->R, 2), up = m3_tmul(R, n);
    const double level = v3_dot(n, r->off); /* of the wall over the centre of A */
    const fl_hull *hull = &w->elastic_walls.hull[i];
    double low = INFINITY;
    for (int32_t v = 0; v < hull->shape->nv; v++) low = fmin(low, v3_dot(up, hull->shape->v[v]));
    *distance = low - level - hull->radius;
    if (*distance >= 0.0) return 0;
    fl_submerged wet;
    fl_vec3 force, moment;
    fl_hull_submerged(hull, up, level, &wet);
    if (wet.volume <= 0.0) return 0;
    p->energy = fl_buoyancy_force(&wet, up, level, w->elastic_walls.stiffness, &force, &moment);
    const fl_vec3 ai = m3_mul(R, wet.centre), aj = v3_sub(ai, r->off);
    const double damping = w->elastic_walls.damping * wet.waterplane_area,
                 elastic = w->elastic_walls.stiffness * wet.volume;
    const fl_pair_mobility ease = fl_pair_mobility_of(w, p);
    const double predicted = -v3_dot(n, end_velocity(b, p, a, ai, aj)),
                 compliance = fl_pair_compliance(&ease, n, v3_cross(ai, n), v3_cross(aj, n), 1.0),
                 approach = predicted + approach_correction(a, predicted, elastic, damping, compliance);
    double normal = elastic + damping * approach;
    if (normal < 0.0) normal = 0.0;
    point_sum sums = {.result = {.slope = w->elastic_walls.stiffness * wet.waterplane_area, .centre = aj}};
    add_wrench(&p->force, &p->torque_i, &p->torque_j, v3_scale(normal, n), ai, aj);
    add_wrench(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping, v3_scale(normal - elastic, n),
               ai, aj);
    add_pressure(&sums, elastic, normal, n, v3(0, 0, 0));
    const fl_patch_result all = result_of_points(&sums, 1);
    add_friction(w, p, &all, 0.0, &(contact_compliance){0}, r, a);
    if (add_rolling(w, p, &all, 0.0, a)) return -1;
    if (survey) { /* the section rotates with the body: take its farthest point */
        fl_stiffness si = {0}, sj = {0};
        fl_stiffness_add_force(&si, b, i, all.slope, n, v3_cross(ai, n));
        bound_stiffness(w, p, &all, r, &si, &sj);
    }
    p->energy += p->spring_energy;
    return p->touching = 1;
}

/* Evaluates ice that crushes by its speed; *distance is set where the two do not touch. */
static int evaluate_strip(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r,
                          const prediction *a, double dt, int survey, double *distance)
{
    const double store = p->strip ? p->strip->store : 0.0, work = p->strip ? p->strip->work : 0.0;
    const fl_mat3 R = r->R;
    const fl_piece *piece = fl_world_piece(w, p->j);
    fl_strip_result q;
    if (fl_strip_contact_advance(w, p, r, dt, survey, &q)) return -1;
    p->touching = q.touches || store > 0.0 || work != 0.0; /* until its last work is booked */
    if (!p->touching) {
        free(p->strip);
        p->strip = NULL;
        return fl_pair_find_points(w, p, thread, r, distance) ? -1 : 0;
    }
    const fl_vec3 none = v3(0, 0, 0);
    p->overlap = q.max_depth;
    p->energy = p->strip->store;
    add_scaled_wrench(&p->force, &p->torque_i, &p->torque_j, &q.force, 1.0, &R, r->off, none);
    fl_patch_result all = {.energy = p->energy,
                           .force = p->force,
                           .elastic = q.normal,
                           .normal = q.normal,
                           .direction = p->force,
                           .load = v3_norm(p->force),
                           .centre = m3_mul(R, q.centre),
                           .slope = q.slope};
    if (piece->several_parts) p->load_part = fl_load_part_at(w, p->j, v3_add(w->b.x[p->j], all.centre));
    if (q.normal > 0.0 && all.load > 0.0) add_friction(w, p, &all, 0.0, &(contact_compliance){0}, r, a);
    else p->springs = (fl_friction_springs){0};
    if (survey) {
        fl_stiffness si = {0}, sj = {0};
        fl_stiffness_add_springs(&si, &w->b, p->i, 1.0, &q.springs, R, r->off);
        fl_stiffness_add_springs(&sj, &w->b, p->j, 1.0, &q.springs, R, none);
        if (!(q.normal > 0.0)) all.direction = v3(1, 0, 0);
        bound_stiffness(w, p, &all, r, &si, &sj);
    }
    p->energy += p->spring_energy;
    if (q.normal > 0.0 && fl_panels_need_points(w, p))
        fl_panels_record_point(w, p, q.centre, v3_unit(q.force.f), q.slope / p->strip->k);
    return 1;
}

/* Evaluates the laws of the manual: one contact, by the kind of the closest features. */
static int evaluate_features(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r,
                             const prediction *a, int survey, double *distance)
{
    const fl_bodies *b = &w->b;
    const fl_pair_law *law = p->law;
    const double ra = p->radius_factor * b->radius[p->i], rb = p->radius_factor * b->radius[p->j];
    fl_contact c;
    if (fl_pair_find_contact(w, p, thread, r, &c)) return -1;
    *distance = c.d;
    if (c.gap >= 0.0) {
        p->mode = FL_MODE_NONE;
        p->touching = 0;
        return 0;
    }
    const double overlap = -c.gap;
    const fl_piece *piece = fl_world_piece(w, p->j);
    if (piece && piece->several_parts)
        p->load_part = fl_load_part_at(w, p->j, v3_add(b->x[p->j], m3_mul(r->R, c.p)));
    const fl_manual_contact mc = {.kind = (fl_manual_kind)(c.mode - FL_VV),
                                  .length = c.length,
                                  .area = c.area,
                                  .sine = c.sine,
                                  .r_low = c.lower_is_b ? rb : ra,
                                  .r_high = c.lower_is_b ? ra : rb,
                                  .edge = c.edge};
    double exponent,
        k = fl_manual_stiffness(&mc, law->modulus, overlap, law->law->si, law->literal18, &exponent);
    k = law->stiffness > 0.0 ? law->stiffness : law->stiffness_factor * k;
    const fl_vec3 nw = m3_mul(r->R, c.n), aj = m3_mul(r->R, c.p), ai = v3_add(aj, r->off);
    const fl_vec3 u = mean_velocity(b, p, a, ai, aj); /* without prediction, as in the manual */
    const double approach = -v3_dot(nw, u);
    fl_pair_mobility ease;
    if (!fl_pair_has_reduced_mass(w, p)) ease = fl_pair_mobility_of(w, p);
    const double mass = law->literal2 && b->invm[p->j] > 0.0
                            ? b->m[p->i] + b->m[p->j]
                            : fl_pair_mass(w, p, &ease, nw, v3_cross(ai, nw), v3_cross(aj, nw));
    const double elastic = k * fl_normal_power(overlap, exponent);
    double normal = elastic + fl_manual_damping(k, exponent, overlap, mass, law->zeta, law->alpha, approach);
    if (normal < 0.0) normal = 0.0;
    const double slope = k * fl_normal_slope(overlap, exponent);
    point_sum sums = {.result = {.slope = slope, .centre = aj}};
    p->overlap = overlap;
    p->energy = k * fl_normal_phi(overlap, exponent);
    p->mode = c.mode;
    add_wrench(&p->force, &p->torque_i, &p->torque_j, v3_scale(normal, nw), ai, aj);
    add_wrench(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping, v3_scale(normal - elastic, nw),
               ai, aj);
    add_pressure(&sums, elastic, normal, nw, v3(0, 0, 0));
    const fl_patch_result all = result_of_points(&sums, 1);
    add_friction(w, p, &all, 0.0, &(contact_compliance){0}, r, a);
    if (survey) bound_stiffness_of_point(w, p, &all, nw, r);
    p->energy += p->spring_energy;
    if (fl_panels_need_points(w, p)) fl_panels_record_point(w, p, c.p, c.n, c.area);
    p->touching = 1;
    return 0;
}

void fl_pair_evaluate(fl_world *w, fl_pair *p, int32_t thread, double dt, int survey)
{
    const int known = fl_surrogate_applies(w, p);
    uint8_t done = 0;
    fl_surrogate_value t;
    if (known) fl_surrogate_batch_evaluate(w, &p, 1, dt, survey, &done, &t);
    if (done) w->surrogate_counts[thread].hits++;
    else fl_pair_evaluate_exact(w, p, thread, known ? &t : NULL, dt, survey);
}

/* Farthest that any point of body k can have moved in this step. */
static double step_motion(const fl_bodies *b, int32_t k, double reach, double dt)
{
    return dt * (v3_norm(b->v[k]) + v3_norm(b->w[k]) * reach);
}

/* Records a contact that begins deeper than the bodies moved in the step, but for the rim of faces, which may
 * be so much deeper, and for rounding. */
static void check_beginning(fl_world *w, const fl_pair *p, const fl_relative_pose *r, double dt)
{
    const fl_bodies *b = &w->b;
    const double rho = b->bounding_radius[p->i], apart = v3_norm(r->off) + rho,
                 moved = step_motion(b, p->i, rho, dt) + step_motion(b, p->j, apart, dt),
                 radii = b->radius[p->i] + b->radius[p->j];
    if (w->step == 0 || dt == 0.0 || p->bond || p->overlap <= SUDDEN * moved + FL_PATCH_RIM_WIDTH * radii)
        return;
#pragma omp critical(fl_sudden_contacts)
    {
        fl_sudden_contacts *const s = &w->sudden;
        if (s->n++ == 0 || (s->step == w->step && (p->i < s->i || (p->i == s->i && p->j < s->j))))
            s->step = w->step, s->i = p->i, s->j = p->j, s->overlap = p->overlap, s->moved = moved,
            s->time = fl_world_time(w);
    }
}

/* Finds the contact points with what is crushed taken off. */
static int find_worn_points(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r,
                            double *distance)
{
    fl_relative_pose worn = p->crush ? fl_crushing_pose(p, r) : *r;
    if (fl_pair_find_points(w, p, thread, &worn, distance)) return -1;
    if (p->crush || !fl_pair_crushes(w, p) || w->scratch[thread].n == 0) return 0;
    const int worn_here = fl_crushing_adopt(w, p, &w->scratch[thread], r);
    if (worn_here <= 0) return worn_here;
    worn = fl_crushing_pose(p, r);
    return fl_pair_find_points(w, p, thread, &worn, distance);
}

/* A pair with a record of crushing does not touch: releases the record once the whole floes are apart.  Until
 * then the pair is due in each step. */
static int release_worn(fl_world *w, fl_pair *p, int32_t thread, const fl_elastic_wrench *before, double dt,
                        const fl_relative_pose *r, double *distance)
{
    const double R = w->b.radius[p->i] + w->b.radius[p->j], worn = *distance;
    fl_crushing_store_work(w, p, before, dt);
    *distance = R;
    if (p->crush->unsaved || before->energy > 0.0) return 0;
    if (worn - v3_norm(p->crush->offset) > R) {
        *distance = worn - v3_norm(p->crush->offset);
    } else {
        double whole;
        if (fl_pair_find_points(w, p, thread, r, &whole)) return -1;
        if (w->scratch[thread].n) return 0;
        *distance = whole;
    }
    fl_crushing_release(w, p);
    return 0;
}

void fl_pair_evaluate_exact(fl_world *w, fl_pair *p, int32_t thread, const fl_surrogate_value *t, double dt,
                            int survey)
{
    const fl_bodies *b = &w->b;
    const double R = b->radius[p->i] + b->radius[p->j];
    const int first =
        p->bond && p->radius_factor == 0.0 && p->touching == 0; /* evaluation since its bond ended */
    const int begins = !p->touching, crushes = fl_pair_crushes(w, p);
    const fl_elastic_wrench before =
        crushes && p->touching ? fl_elastic_wrench_of(p) : (fl_elastic_wrench){.energy = 0.0};
    const fl_relative_pose r = fl_relative_pose_of(w, p);
    const prediction a = prediction_of(w, p, &r, dt);
    fl_patch_points *s = &w->scratch[thread];
    double distance = 0.0;
    p->force = p->torque_i = p->torque_j = p->force_damping = p->torque_i_damping = p->torque_j_damping =
        p->force_friction = p->torque_i_friction = p->torque_j_friction = v3(0, 0, 0);
    p->energy = p->spring_energy = p->overlap = p->omega2_i = p->omega2_j = 0.0;
    const fl_piece *piece = fl_world_piece(w, p->j);
    if (piece && piece->elastic) {
        const int touch = evaluate_elastic_wall(w, p, &r, &a, survey, &distance);
        if (touch < 0) goto failed;
        if (touch) return;
        distance += R; /* free travel is computed from the distance of the cores */
    } else if (fl_pair_has_strip(w, p->j)) {
        const int touch = evaluate_strip(w, p, thread, &r, &a, dt, survey, &distance);
        if (touch < 0) goto failed;
        if (touch) return;
    } else if (p->points == FL_POINTS_FEATURES) {
        if (evaluate_features(w, p, thread, &r, &a, survey, &distance)) goto failed;
        if (p->touching) goto touches;
    } else if (fl_pair_is_quick(w, p) && !crushes) {
        fl_quick_sums sums;
        if (fl_pair_find_quick(w, p, thread, &r, &distance, &sums)) goto failed;
        const int touch = evaluate_quick(w, p, thread, &sums, t, &r, &a, survey);
        if (touch < 0) goto failed;
        if (touch) goto touches;
    } else {
        const int shared = piece && piece->several_parts;
        s->keep_features = w->panel_load.panels || shared;
        if (find_worn_points(w, p, thread, &r, &distance)) goto failed;
        if (shared && s->n) fl_load_find_part(w, p, s);
        const int touch = p->points == FL_POINTS_PATCH ? evaluate_patch(w, p, thread, t, &r, &a, survey)
                          : s->n                       ? evaluate_points(w, p, s, &r, &a, survey)
                                                       : 0;
        if (touch < 0) goto failed;
        if (touch) goto touches;
    }
    p->springs = (fl_friction_springs){0};
    if (p->rolling) *p->rolling = (fl_rolling_spring){.k = 0.0};
    p->touching = 0;
    if (p->crush && release_worn(w, p, thread, &before, dt, &r, &distance)) goto failed;
    p->max_approach_speed = 0.0;
    p->sustained_load = p->sustained_load_rate = p->sustained_step = 0.0;
    p->sustained_spin = p->sustained_spin_rate = v3(0, 0, 0);
    if (p->surrogate) p->surrogate->valid = 0;
    if (p->bond && p->radius_factor < 1.0) fl_bond_list_restore_radii(w, p, R, distance);
    fl_pair_set_free_travel(w, p, distance, R);
    return;
touches:
    if (p->crush) fl_crushing_store_work(w, p, &before, dt);
    if (begins) check_beginning(w, p, &r, dt);
    if (first) fl_bond_list_first_contact(w, p);
    return;
failed:
#pragma omp atomic write
    w->failed = 1;
}
