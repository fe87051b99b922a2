/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/array.h"
#include "law/damping.h"
#include "law/manual.h"
#include "law/material.h"
#include "law/normal.h"
#include "patch/force_sum.h"
#include "contact/bond_list.h"
#include "contact/pair_force.h"
#include "contact/velocity_predictor.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "contact/panel_load.h"
#include "contact/rolling_pair.h"
#include "contact/pair_geometry.h"
#include "patch/stiffness_bound.h"
#include "contact/surrogate_batch.h"

/* Overlaps below that much of the coordinates they come from are rounding, and have no stiffness. */
#define ROUNDING 3e-14

#define INLINE static inline __attribute__((always_inline)) /* vectors by value go through memory */

/* Whether looks at contacts that are told ask in this step how stiff they are: one step in four, in no rhythm
 * that looks might have. */
static int asks(const fl_world *w) { return (uint32_t)w->step * UINT32_C(2654435761) >> 30 == 0; }

INLINE void add_wrench(fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj, fl_vec3 force, fl_vec3 ai, fl_vec3 aj)
{
    *f = v3_add(*f, force);
    *ti = v3_add(*ti, v3_cross(ai, force));
    *tj = v3_sub(*tj, v3_cross(aj, force));
}

/* A force and its moment about a point, in the frame of B and times scale; the point is ai from A's centre
 * and aj from B's, in world axes. */
INLINE void add_sum(fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj, const fl_wrench *w, double scale, const fl_mat3 *R,
                    fl_vec3 ai, fl_vec3 aj)
{
    const fl_vec3 moment = v3_scale(scale, m3_mul(*R, w->m));
    add_wrench(f, ti, tj, v3_scale(scale, m3_mul(*R, w->f)), ai, aj);
    *ti = v3_add(*ti, moment);
    *tj = v3_sub(*tj, moment);
}

INLINE fl_vec3 approach(const fl_bodies *b, const fl_pair *p, fl_vec3 ai, fl_vec3 aj)
{
    return v3_sub(fl_body_point_velocity(b, p->i, ai), fl_body_point_velocity(b, p->j, aj));
}

/* How A moves: in the mean of the step that is approach() and fl_pair_rotation_lag(); at its end by a lead more. */
typedef struct {
    fl_predictor_step of;
    fl_vec3 lag; /* [m/s] */
    fl_predicted_velocity by;
    fl_previous_force was;
} ahead;

static ahead ahead_of(const fl_world *w, const fl_pair *p, const fl_relative_pose *r, double dt)
{
    const fl_vec3 lag = fl_pair_rotation_lag(&w->b, p, r->off, dt);
    return (ahead){fl_predictor_step_of(w, dt), lag, fl_predicted_velocity_of(w, p, lag),
                   fl_previous_force_of(p)};
}

/* By how much faster A approaches at the end than at c, as foreseen; the rest as in fl_predict_approach(). */
static double nearer(const ahead *a, double c, double elastic, double C, double yields)
{
    return fl_predict_approach(c, elastic, C, yields, a->by.contact_count, a->of, a->was) - c;
}

INLINE fl_vec3 went(const fl_bodies *b, const fl_pair *p, const ahead *a, fl_vec3 ai, fl_vec3 aj)
{
    return v3_add(approach(b, p, ai, aj), a->lag);
}

INLINE fl_vec3 next(const fl_bodies *b, const fl_pair *p, const ahead *a, fl_vec3 ai, fl_vec3 aj)
{
    return v3_add(went(b, p, a, ai, aj), fl_predicted_velocity_at(&a->by, ai, aj));
}

/* The pressure of a contact, summed up: what friction needs. */
typedef struct {
    double normal;     /* sum of F with damping                                     [N] */
    double elastic;    /* and without                                               [N] */
    fl_vec3 direction; /* sum of F n                                                [N] */
    fl_vec3 at;        /* a place, relative to B's centre                           [m] */
    fl_vec3 moment;    /* sum of F (p - at)                                       [N m] */
    double spread;     /* sum of F |p - at|^2; B's centre may be a thousand kilometres away [N m^2] */
    double slope;      /* dF/ds                                                   [N/m] */
    int walls;         /* sums of walls, each of which rubs by itself */
} pressure;

/* arm: of the place, from q->at. */
static void press(pressure *q, double elastic, double normal, fl_vec3 n, fl_vec3 arm)
{
    q->elastic += elastic;
    q->normal += normal;
    q->direction = v3_madd(q->direction, normal, n);
    q->moment = v3_madd(q->moment, normal, arm);
    q->spread += normal * v3_norm2(arm);
}

/* How both part there, as in fl_friction_contact. */
typedef struct {
    fl_sym3 ease;
    double turns;
} parting;

/* Friction at the centre of the pressure. */
static void rub(fl_world *w, fl_pair *p, const pressure *q, double chi, const parting *part,
                const fl_relative_pose *r, const ahead *a)
{
    const fl_bodies *b = &w->b;
    const fl_pair_law *law = p->law;
    if (!(law->friction > 0.0 && law->tangential_ratio > 0.0 && q->normal > 0.0)) {
        p->springs = (fl_friction_springs){0};
        return;
    }
    const fl_vec3 mean = v3_scale(1.0 / q->normal, q->moment), aj = v3_add(q->at, mean),
                  ai = v3_add(aj, r->off);
    const double arm2 = q->spread / q->normal - v3_norm2(mean);
    const fl_friction_contact c = {.n = v3_unit(q->direction),
                                   .k = law->tangential_ratio * q->slope,
                                   .g = law->tangential_ratio * chi * q->elastic,
                                   .limit = law->friction * (q->walls ? q->normal : v3_norm(q->direction)),
                                   .arm = arm2 > 0.0 ? sqrt(arm2) : 0.0,
                                   .compliance = part->ease,
                                   .turn_compliance = part->turns,
                                   .contact_count = a->by.contact_count};
    const double wi = v3_dot(b->w[p->i], c.n), wj = v3_dot(b->w[p->j], c.n),
                 turned = v3_dot(a->by.wi, c.n) - v3_dot(a->by.wj, c.n);
    const fl_vec3 v = went(b, p, a, ai, aj);
    const fl_friction_motion by = {v,
                                   v3_add(v, fl_predicted_velocity_at(&a->by, ai, aj)),
                                   wi - wj,
                                   wi - wj + turned,
                                   0.5 * (wi + wj),
                                   a->was.friction_damping,
                                   fl_previous_damping_moment(a->was, c.n, ai, aj),
                                   a->of.half_step,
                                   a->of.at_start};
    const fl_friction_result t = fl_tangent_step(p->springs, c, by, a->of.dt);
    const fl_vec3 m = v3_scale(t.moment, c.n);
    p->springs = t.springs;
    add_wrench(&p->force_friction, &p->torque_i_friction, &p->torque_j_friction, t.force, ai, aj);
    p->torque_i_friction = v3_add(p->torque_i_friction, m);
    p->torque_j_friction = v3_sub(p->torque_j_friction, m);
    p->force = v3_add(p->force, p->force_friction);
    p->torque_i = v3_add(p->torque_i, p->torque_i_friction);
    p->torque_j = v3_add(p->torque_j, p->torque_j_friction);
    p->spring_energy = fl_tangent_energy(p->springs);
}

/* 1/I of thing k for a turn to which it yields the most [1/kg m2]. */
static double most_turned(const fl_world *w, int32_t k)
{
    const int held = FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ;
    if (k >= w->n || (w->b.fixed_dof[k] & held) == held) return 0.0;
    return fmax(w->b.invI[k].x, fmax(w->b.invI[k].y, w->b.invI[k].z));
}

/* What keeps a sphere from rolling, if anything does: a moment on either.  -1 when memory runs out. */
static int roll(fl_world *w, fl_pair *p, const pressure *q, double chi, const ahead *a)
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
                                 .inv_mass = arm * arm * (most_turned(w, p->i) + most_turned(w, p->j)),
                                 .contact_count = a->by.contact_count};
    const fl_rolling_motion by = {turns, v3_madd(turns, arm, v3_sub(a->by.wi, a->by.wj)),
                                  v3_scale(0.5, v3_add(wi, wj))};
    p->rolling->arm = arm;
    *p->rolling = fl_rolling_step(*p->rolling, c, by, a->of.dt, a->of.half_step, a->of.at_start);
    const fl_vec3 m = fl_rolling_moment(p->rolling);
    p->torque_i_friction = v3_add(p->torque_i_friction, m),
    p->torque_j_friction = v3_sub(p->torque_j_friction, m);
    p->torque_i = v3_add(p->torque_i, m), p->torque_j = v3_sub(p->torque_j, m);
    p->spring_energy += fl_rolling_energy(*p->rolling);
    return 0;
}

/* What the springs of friction add, where they stick, and the bounds of it all. */
static void stiffen(const fl_world *w, fl_pair *p, const pressure *q, const fl_relative_pose *r,
                    fl_stiffness *si, fl_stiffness *sj)
{
    const fl_bodies *b = &w->b;
    if (p->springs.k > 0.0) {
        const fl_vec3 n = v3_unit(q->direction), aj = v3_madd(q->at, 1.0 / q->normal, q->moment);
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

/* The same of a contact whose places push along n at the point of the pressure alone. */
static void stiffen_one(const fl_world *w, fl_pair *p, const pressure *q, fl_vec3 n,
                        const fl_relative_pose *r)
{
    fl_stiffness si = {0}, sj = {0};
    fl_stiffness_add_force(&si, &w->b, p->i, q->slope, n, v3_cross(v3_add(q->at, r->off), n));
    fl_stiffness_add_force(&sj, &w->b, p->j, q->slope, n, v3_cross(q->at, n));
    stiffen(w, p, q, r, &si, &sj);
}

/* Damping is the same factor for all places of a pair,
 *     chi = D / max(v_touch, c sqrt(2 W / M)),
 * where v_touch is the largest approach speed of this touch, now the given one, and sqrt(2 W/M) the speed
 * that the stored energy W amounts to, with c of fl_damping_slow_factor(): in an impact it stays below v_touch, so
 * restitution is that of D; in a contact that was never an impact the damping ratio stays below D/(2 c). */
static double damping_factor(fl_pair *p, double now, double mass)
{
    p->max_approach_speed = p->touching && p->max_approach_speed > now ? p->max_approach_speed : now;
    return fl_damping_chi(p->law->impact_damping, p->law->slow_damping_factor, p->max_approach_speed,
                          p->energy, mass);
}

/* A place of a round thing in world axes. */
typedef struct {
    fl_vec3 n, ai, aj; /* ai, aj: from the centres of A and B    */
    double part;       /* phi'(s), with the sign of the place    */
} spot;

static spot spot_of(const fl_pair *p, const fl_patch_point *q, const fl_relative_pose *r)
{
    spot t = {.n = m3_mul(r->R, q->n), .aj = m3_mul(r->R, q->p)};
    t.ai = v3_add(t.aj, r->off);
    t.part = q->du * fl_normal_power(q->overlap, p->exponent);
    return t;
}

/* The same of places that push along their normals; passes take nothing off. */
static void stiffen_points(const fl_world *w, fl_pair *p, const fl_patch_points *s, const pressure *all,
                           const fl_relative_pose *r)
{
    fl_stiffness si = {0}, sj = {0};
    for (int32_t c = 0; c < s->n; c++) {
        const fl_patch_point *q = &s->point[c];
        const spot t = spot_of(p, q, r);
        const double slope = p->k * fl_normal_slope(q->overlap, p->exponent);
        if (q->du < 0.0) continue;
        fl_stiffness_add_force(&si, &w->b, p->i, slope, t.n, v3_cross(t.ai, t.n));
        fl_stiffness_add_force(&sj, &w->b, p->j, slope, t.n, v3_cross(t.aj, t.n));
    }
    stiffen(w, p, all, r, &si, &sj);
}

/* The speed of approach along n [m/s]. */
static double closing_of(const fl_bodies *b, const fl_pair *p, const ahead *a, const spot *t)
{
    return -v3_dot(t->n, next(b, p, a, t->ai, t->aj));
}

/* The places of a round thing or of `core`: W = k sum of phi(s), most often of one.  Of several places, or
 * one that may be another than a step ago, it is not known what each did then: they are damped by the speed
 * half a step ago.  -1 when memory runs out. */
static int force_points(fl_world *w, fl_pair *p, const fl_patch_points *s, const fl_relative_pose *r,
                        const ahead *by, int survey)
{
    const fl_bodies *b = &w->b;
    const int one = s->n == 1 && p->law->law->end_speed;
    const ahead late = {.of = by->of, .lag = by->lag, .by = {.contact_count = 1.0}}, *const a =
                                                                                         one ? by : &late;
    const double k = p->k;
    const spot first = spot_of(p, &s->point[0], r);
    fl_vec3 way = first.n, turn_i = v3_cross(first.ai, first.n), turn_j = v3_cross(first.aj, first.n);
    double sum = first.part, less = 1.0;
    p->overlap = s->point[0].overlap;
    p->energy = k * fl_normal_phi(p->overlap, p->exponent);
    if (s->n > 1) { /* of the force of all, which is less than that of each by itself */
        way = v3_scale(sum, way), turn_i = v3_scale(sum, turn_i), turn_j = v3_scale(sum, turn_j);
        for (int32_t c = 1; c < s->n; c++) {
            const fl_patch_point *q = &s->point[c];
            const spot t = spot_of(p, q, r);
            sum += t.part;
            way = v3_madd(way, t.part, t.n);
            turn_i = v3_madd(turn_i, t.part, v3_cross(t.ai, t.n));
            turn_j = v3_madd(turn_j, t.part, v3_cross(t.aj, t.n));
            p->energy += q->du * k * fl_normal_phi(q->overlap, p->exponent);
            p->overlap = fmax(p->overlap, q->overlap);
        }
        less = v3_norm2(way) / (sum * sum);
    }
    fl_pair_mobility ease;
    if (one || !fl_pair_has_reduced_mass(w, p)) ease = fl_pair_mobility_of(w, p);
    const double mass = less > 0.0 ? fl_pair_mass(w, p, &ease, way, turn_i, turn_j) / less : INFINITY;
    const double begins = closing_of(b, p, a, &first);
    double closing = begins;
    for (int32_t c = 1; c < s->n; c++) {
        const spot t = spot_of(p, &s->point[c], r);
        if (s->point[c].du > 0.0) closing = fmax(closing, closing_of(b, p, a, &t));
    }
    const double chi = damping_factor(p, closing > 0.0 ? closing : 0.0, mass), push = k * first.part,
                 more = one ? nearer(a, begins, push, chi * push,
                                     fl_pair_compliance(&ease, way, turn_i, turn_j, 1.0))
                            : 0.0;
    pressure all = {.at = first.aj, .walls = s->n > 1};
    for (int32_t c = 0; c < s->n; c++) {
        const fl_patch_point *q = &s->point[c];
        const spot t = c ? spot_of(p, q, r) : first;
        const double elastic = k * t.part, slope = k * q->du * fl_normal_slope(q->overlap, p->exponent),
                     comes = c ? closing_of(b, p, a, &t) : begins,
                     normal = q->du * fl_normal_damped_force(fabs(elastic), chi, comes + more);
        add_wrench(&p->force, &p->torque_i, &p->torque_j, v3_scale(normal, t.n), t.ai, t.aj);
        add_wrench(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping,
                   v3_scale(normal - elastic, t.n), t.ai, t.aj);
        press(&all, elastic, normal, t.n, v3_sub(t.aj, first.aj));
        all.slope += slope;
    }
    parting part = {.turns = 0.0};
    if (one && chi > 0.0 && p->law->friction > 0.0)
        part.ease = fl_pair_compliance_matrix(&ease, first.ai, first.aj);
    rub(w, p, &all, chi, &part, r, a);
    if (roll(w, p, &all, chi, a)) return -1;
    if (survey) stiffen_points(w, p, s, &all, r);
    p->energy += p->spring_energy;
    if (fl_panels_need_points(w, p)) fl_panels_record_points(w, p, s, p->k, chi);
    return p->touching = 1;
}

/* How stiff the springs of its places make a contact; the root in W bends down, W'' = scale (U'' - U'^2/2U).
 * ai, aj: the first place from the centres. */
static void survey_patch(const fl_world *w, const fl_pair *p, const fl_spring_sums *q, fl_mat3 R, fl_vec3 ai,
                         fl_vec3 aj, double scale, double U, fl_stiffness *si, fl_stiffness *sj)
{
    const fl_bodies *b = &w->b;
    const double half = 0.5 / (scale * U);
    *si = *sj = (fl_stiffness){0};
    fl_stiffness_add_springs(si, b, p->i, scale, q, R, ai);
    fl_stiffness_add_springs(sj, b, p->j, scale, q, R, aj);
    fl_stiffness_add_force(si, b, p->i, -half, p->force, p->torque_i);
    fl_stiffness_add_force(sj, b, p->j, -half, p->force, p->torque_j);
}

/* The damping of p with what shakes the bodies held back, its force being the elastic one so far; presses:
 * sum of its pressures. */
static void steady(fl_pair *p, double presses, double chi, const fl_relative_pose *r, const ahead *a)
{
    const fl_wrench to = fl_stabilised_damping(
        fl_wrench_about_middle(p->force, p->torque_i, p->torque_j),
        fl_wrench_about_middle(p->force_damping, p->torque_i_damping, p->torque_j_damping), presses,
        2.0 * a->of.half_step * chi * presses / p->mass, a->by.contact_count, a->was, a->of.at_start);
    const fl_vec3 half = v3_scale(0.5, v3_cross(r->off, to.f));
    p->force_damping = to.f, p->torque_i_damping = v3_add(half, to.m),
    p->torque_j_damping = v3_sub(half, to.m);
}

/* What damping and friction add to the elastic force of `patch`.  q: of places, times scale; it is about aj
 * from B's centre; slope: dF/ds. */
static pressure bear(fl_world *w, fl_pair *p, const fl_force_sum *q, double scale, double slope, double chi,
                     const parting *part, const fl_relative_pose *r, fl_vec3 aj, const ahead *a)
{
    const fl_mat3 *R = &r->R;
    add_sum(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping, &q->damping, scale, R,
            v3_add(aj, r->off), aj);
    steady(p, scale * q->pressure, chi, r, a);
    p->force = v3_add(p->force, p->force_damping);
    p->torque_i = v3_add(p->torque_i, p->torque_i_damping);
    p->torque_j = v3_add(p->torque_j, p->torque_j_damping);
    const pressure all = {.normal = scale * q->damped_pressure,
                          .elastic = scale * q->pressure,
                          .direction = v3_scale(scale, m3_mul(*R, q->direction)),
                          .at = aj,
                          .moment = v3_scale(scale, m3_mul(*R, q->damped_moment)),
                          .spread = scale * q->damped_spread,
                          .slope = slope};
    rub(w, p, &all, chi, part, r, a);
    return all;
}

/* After a look.  t: what was told for this pose, or NULL. */
static int renew(fl_world *w, fl_pair *p, int32_t thread, const fl_surrogate_value *t,
                 const fl_exact_contact *seen)
{
    fl_surrogate_count *count = &w->surrogate_counts[thread];
    const int near = t && fl_surrogate_in_double_range(p->surrogate, t);
    fl_err lost = {0};
    if (!p->surrogate && !(p->surrogate = fl_alloc(1, sizeof *p->surrogate, &lost))) return -1;
    if (p->cores_overlap || p->radius_factor != 1.0) {
        p->surrogate->valid = 0;
        return 0;
    }
    const double off = fl_surrogate_update(p->surrogate, t, seen, p->law->surrogate_tolerance);
    if (!near) return 0;
    count->checks++;
    count->misses += off > p->law->surrogate_tolerance;
    count->worst_error = off > count->worst_error ? off : count->worst_error;
    return 0;
}

/* --- what is found by a look ------------------------------------------------------------------- */

/* What turning adds: x, y, z torques of unit forces, in a frame where the inverse moments are invI. */
static fl_sym3 turning(fl_sym3 K, fl_vec3 invI, fl_vec3 x, fl_vec3 y, fl_vec3 z)
{
    return s3_add(K, s3_products(x, y, z, v3_mul(invI, x), v3_mul(invI, y), v3_mul(invI, z)));
}

/* How both part, who are free: yields, ease and turns, from how A stands to B alone; q is about `at`.  A
 * push is taken for half of the sum of the pressures at least. */
static void find_ease(const fl_bodies *b, const fl_pair *p, const fl_force_sum *q, fl_vec3 at,
                      fl_exact_contact *seen)
{
    const fl_mat3 *M = seen->M;
    const fl_vec3 f = q->gradient.f, m = q->gradient.m, n = v3_unit(f), none = v3(0, 0, 0),
                  aj = v3_madd(at, 1.0 / q->pressure, q->pressure_moment), ai = v3_sub(aj, seen->o),
                  ei = b->invI[p->i], ej = p->j < b->n ? b->invI[p->j] : none;
    const fl_vec3 mi = m3_tmul(*M, v3_add(v3_cross(v3_sub(at, seen->o), f), m)),
                  mj = v3_add(v3_cross(at, f), m), ni = m3_tmul(*M, n);
    const double each = 1.0 / p->mass, f2 = fmax(v3_norm2(f), 0.25 * q->pressure * q->pressure),
                 turns = v3_dot(v3_mul(ei, mi), mi) + v3_dot(v3_mul(ej, mj), mj);
    seen->inv_mass = each + turns / f2;
    seen->turn_compliance = v3_dot(v3_mul(ei, ni), ni) + v3_dot(v3_mul(ej, n), n);
    const fl_vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    const fl_sym3 alone = s3_isotropic(each),
                  turned = turning(alone, ei, m3_tmul(*M, v3_cross(ai, x)), m3_tmul(*M, v3_cross(ai, y)),
                                   m3_tmul(*M, v3_cross(ai, z)));
    seen->compliance = turning(turned, ej, v3_cross(aj, x), v3_cross(aj, y), v3_cross(aj, z));
}

/* W = k sqrt(U) of the places summed up in q, which gets their couple. */
static void seen_of(const fl_world *w, const fl_pair *p, const fl_patch_points *s, const fl_relative_pose *r,
                    fl_force_sum *q, fl_exact_contact *seen)
{
    const double energy = p->k * sqrt(q->u), scale = 0.5 * energy / q->u;
    q->gradient.m = v3_add(q->gradient.m, s->couple);
    *seen = (fl_exact_contact){.M = &r->M,
                               .o = r->o,
                               .points = s,
                               .sums = q,
                               .scale = scale,
                               .energy = energy,
                               .slope = scale * (q->ddu - 0.5 * q->pressure * q->pressure / q->u)};
    find_ease(&w->b, p, q, s->point[0].p, seen);
}

/* How far A may go until another wall of a surface that is not convex may bear, after a look.  -1 when memory
 * runs out. */
static int find_room(fl_world *w, const fl_pair *p, int32_t thread, fl_exact_contact *seen)
{
    const fl_piece *piece = fl_world_piece(w, p->j);
    const double ra = w->b.radius[p->i];
    seen->radius_a = w->b.bounding_radius[p->i];
    seen->radii = ra + w->b.radius[p->j];
    seen->free_path = INFINITY;
    seen->b_is_plane = piece && piece->kind == FL_PIECE_PLANE;
    if (piece && piece->kind == FL_PIECE_MESH)
        seen->free_path = fl_mesh_contact_free_travel(&w->mesh_near[thread], seen->points->va,
                                                      &w->b.core[p->i], piece, ra, seen->sums->overlap,
                                                      fl_surrogate_max_change(p->law->surrogate_tolerance));
    return seen->free_path < 0.0 ? -1 : 0;
}

/* The places of `patch`: W = k sqrt(U), each with its share of dW/dU; t as in renew().  1 when they touch, 0
 * when nothing does, -1 when memory runs out. */
static int force_patch(fl_world *w, fl_pair *p, int32_t thread, const fl_surrogate_value *t,
                       const fl_relative_pose *r, const ahead *a, int survey)
{
    const fl_bodies *b = &w->b;
    const fl_mat3 R = r->R;
    fl_patch_points *s = &w->scratch[thread];
    const int carried = p->law->surrogate_tolerance > 0.0 && !fl_panels_need_points(w, p);
    if (s->n == 0) return 0;
    const fl_vec3 at = s->point[0].p, aj = m3_mul(R, at), ai = v3_add(aj, r->off);
    fl_force_sum q;
    if (fl_force_sum_elastic(s, &q)) return -1;
    if (!(q.u > 0.0 && q.overlap > ROUNDING * (v3_norm(r->o) + b->bounding_radius[p->i]))) return 0;
    fl_exact_contact seen;
    seen_of(w, p, s, r, &q, &seen);
    p->overlap = q.overlap;
    p->energy = seen.energy;
    add_sum(&p->force, &p->torque_i, &p->torque_j, &q.gradient, seen.scale, &R, ai, aj);
    const fl_vec3 elastic = p->force;
    parting part;
    double yields = seen.inv_mass, mass = p->mass;
    if (!fl_pair_is_free(w, p)) {
        const fl_pair_mobility ease = fl_pair_mobility_of(w, p);
        const fl_vec3 middle = m3_mul(R, v3_scale(1.0 / q.pressure, q.pressure_moment));
        mass = fl_pair_mass(w, p, &ease, elastic, p->torque_i, p->torque_j);
        part.ease = fl_pair_compliance_matrix(&ease, v3_add(ai, middle), v3_add(aj, middle));
        part.turns = fl_pair_turn_compliance(&ease, v3_unit(elastic));
        yields = fl_pair_compliance(&ease, elastic, p->torque_i, p->torque_j, seen.scale * q.pressure);
    } else {
        part.ease = s3_rotated(seen.compliance, m3_col(R, 0), m3_col(R, 1), m3_col(R, 2));
        part.turns = seen.turn_compliance;
    }
    const fl_vec3 spin = v3_add(v3_sub(b->w[p->i], b->w[p->j]), v3_sub(a->by.wi, a->by.wj));
    const fl_vec3 v = m3_tmul(R, next(b, p, a, ai, aj)), turn = m3_tmul(R, spin);
    if (fl_force_sum_motion(s, v, turn, &q)) return -1;
    const double chi = damping_factor(p, q.du > 0.0 ? q.du_approach / q.du : 0.0, mass);
    const double size = v3_norm(elastic),
                 more = fl_predictor_share(size, seen.scale * q.pressure) *
                        nearer(a, q.pressure_rate / q.pressure, size, chi * size, yields);
    fl_force_sum_damping(s, chi, more, &q);
    fl_stiffness si, sj;
    fl_spring_sums springs;
    if (survey || carried) fl_force_sum_springs(s, &springs);
    survey |= carried && (!t || asks(w));
    if (survey) survey_patch(w, p, &springs, R, ai, aj, seen.scale, q.u, &si, &sj);
    if (t && fl_surrogate_in_double_range(p->surrogate, t) && fabs(seen.slope - t->slope) < 0.5 * t->slope)
        fl_tangent_rescale(&p->springs, seen.slope / t->slope, seen.slope < p->surrogate->slope);
    const pressure all = bear(w, p, &q, seen.scale, seen.slope, chi, &part, r, aj, a);
    if (survey) stiffen(w, p, &all, r, &si, &sj);
    if (carried) {
        const double speed = v3_dot(v3_unit(elastic), approach(b, p, ai, aj));
        seen.springs = &springs;
        seen.v = v, seen.spin = turn, seen.impact_damping = chi, seen.speed_offset = more;
        /* the force that the energy of the motion would give, W growing as the square of it */
        seen.motion_force = sqrt(1.0 + 0.5 * mass * speed * speed / p->energy);
        seen.stiffness_i = p->omega2_i, seen.stiffness_j = p->omega2_j;
        if (find_room(w, p, thread, &seen) || renew(w, p, thread, t, &seen)) return -1;
    }
    p->energy += p->spring_energy;
    if (fl_panels_need_points(w, p)) {
        for (int32_t k = 0; k < s->n; k++)
            s->point[k].approach_speed = fl_force_sum_approach_speed(s, k) + more;
        fl_panels_record_points(w, p, s, seen.scale, chi);
    }
    return p->touching = 1;
}

/* An elastic wall: force, moment and energy of Winkler's foundation under the part of A behind the wall, and
 * a dashpot at the centre of the pressure, which never pulls the body back into the wall.  The closing speed
 * of a point does not change along the normal, so the centre may stand behind the wall. */
static int force_bed(fl_world *w, fl_pair *p, const fl_relative_pose *r, const ahead *a, int survey,
                     double *distance)
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
    const double foreseen = -v3_dot(n, next(b, p, a, ai, aj)),
                 yields = fl_pair_compliance(&ease, n, v3_cross(ai, n), v3_cross(aj, n), 1.0),
                 closing = foreseen + nearer(a, foreseen, elastic, damping, yields);
    double normal = elastic + damping * closing;
    if (normal < 0.0) normal = 0.0;
    pressure all = {.slope = w->elastic_walls.stiffness * wet.waterplane_area, .at = aj};
    add_wrench(&p->force, &p->torque_i, &p->torque_j, v3_scale(normal, n), ai, aj);
    add_wrench(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping, v3_scale(normal - elastic, n),
               ai, aj);
    press(&all, elastic, normal, n, v3(0, 0, 0));
    rub(w, p, &all, 0.0, &(parting){0}, r, a);
    if (roll(w, p, &all, 0.0, a)) return -1;
    if (survey) { /* the waterplane behind the wall turns with the body: as stiff as at its farthest point */
        fl_stiffness si = {0}, sj = {0};
        fl_stiffness_add_force(&si, b, i, all.slope, n, v3_cross(ai, n));
        stiffen(w, p, &all, r, &si, &sj);
    }
    p->energy += p->spring_energy;
    return p->touching = 1;
}

/* The manual's law: one contact, by the kind of the closest features. */
static int force_manual(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r, const ahead *a,
                        int survey, double *distance)
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
    const fl_vec3 u = went(b, p, a, ai, aj); /* without a lead: as the manual has it */
    const double closing = -v3_dot(nw, u);
    fl_pair_mobility ease;
    if (!fl_pair_has_reduced_mass(w, p)) ease = fl_pair_mobility_of(w, p);
    const double mass = law->literal2 && b->invm[p->j] > 0.0
                            ? b->m[p->i] + b->m[p->j]
                            : fl_pair_mass(w, p, &ease, nw, v3_cross(ai, nw), v3_cross(aj, nw));
    const double elastic = k * fl_normal_power(overlap, exponent);
    double normal = elastic + fl_manual_damping(k, exponent, overlap, mass, law->zeta, law->alpha, closing);
    if (normal < 0.0) normal = 0.0;
    const double slope = k * fl_normal_slope(overlap, exponent);
    pressure all = {.slope = slope, .at = aj};
    p->overlap = overlap;
    p->energy = k * fl_normal_phi(overlap, exponent);
    p->mode = c.mode;
    add_wrench(&p->force, &p->torque_i, &p->torque_j, v3_scale(normal, nw), ai, aj);
    add_wrench(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping, v3_scale(normal - elastic, nw),
               ai, aj);
    press(&all, elastic, normal, nw, v3(0, 0, 0));
    rub(w, p, &all, 0.0, &(parting){0}, r, a);
    if (survey) stiffen_one(w, p, &all, nw, r);
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

void fl_pair_evaluate_exact(fl_world *w, fl_pair *p, int32_t thread, const fl_surrogate_value *t, double dt,
                            int survey)
{
    const fl_bodies *b = &w->b;
    const double R = b->radius[p->i] + b->radius[p->j];
    const int first = p->bond && p->radius_factor == 0.0 && p->touching == 0; /* look since its bond ended */
    const fl_relative_pose r = fl_relative_pose_of(w, p);
    const ahead a = ahead_of(w, p, &r, dt);
    fl_patch_points *s = &w->scratch[thread];
    double distance = 0.0;
    p->force = p->torque_i = p->torque_j = p->force_damping = p->torque_i_damping = p->torque_j_damping =
        p->force_friction = p->torque_i_friction = p->torque_j_friction = v3(0, 0, 0);
    p->energy = p->spring_energy = p->overlap = p->omega2_i = p->omega2_j = 0.0;
    const fl_piece *piece = fl_world_piece(w, p->j);
    if (piece && piece->elastic) {
        const int touch = force_bed(w, p, &r, &a, survey, &distance);
        if (touch < 0) goto failed;
        if (touch) return;
        distance += R; /* what sleeps is told by the distance of the cores */
    } else if (p->points == FL_POINTS_FEATURES) {
        if (force_manual(w, p, thread, &r, &a, survey, &distance)) goto failed;
        if (p->touching) goto touches;
    } else {
        if (fl_pair_find_points(w, p, thread, &r, &distance)) goto failed;
        const int touch = p->points == FL_POINTS_PATCH ? force_patch(w, p, thread, t, &r, &a, survey)
                          : s->n                       ? force_points(w, p, s, &r, &a, survey)
                                                       : 0;
        if (touch < 0) goto failed;
        if (touch) goto touches;
    }
    p->springs = (fl_friction_springs){0};
    if (p->rolling) *p->rolling = (fl_rolling_spring){.k = 0.0};
    p->touching = 0;
    p->max_approach_speed = 0.0;
    if (p->surrogate) p->surrogate->valid = 0;
    if (p->bond && p->radius_factor < 1.0) fl_bond_list_restore_radii(w, p, R, distance);
    fl_pair_set_free_travel(w, p, distance, R);
    return;
touches:
    if (first) fl_bond_list_first_contact(w, p);
    return;
failed:
#pragma omp atomic write
    w->failed = 1;
}

int fl_pair_rebuild_surrogate(fl_world *w, fl_pair *p, const fl_mat3 *M, fl_vec3 o)
{
    const fl_relative_pose r = {.M = *M, .o = o};
    fl_patch_points *s = &w->scratch[0];
    double distance = 0.0;
    fl_force_sum q;
    if (fl_pair_find_points(w, p, 0, &r, &distance)) return -1;
    if (s->n == 0) return 0;
    if (fl_force_sum_elastic(s, &q)) return -1;
    if (!(q.u > 0.0)) return 0;
    fl_exact_contact seen;
    seen_of(w, p, s, &r, &q, &seen);
    fl_spring_sums springs;
    fl_force_sum_springs(s, &springs);
    seen.springs = &springs;
    if (find_room(w, p, 0, &seen)) return -1;
    fl_surrogate_set(p->surrogate, &seen);
    return 0;
}
