/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "contact/bond_list.h"
#include "contact/crushing.h"
#include "contact/pair_force.h"
#include "contact/pair_friction.h"
#include "contact/pair_geometry.h"
#include "contact/pair_response.h"
#include "contact/pair_stiffness.h"
#include "contact/panel_load.h"
#include "contact/patch_force.h"
#include "contact/point_force.h"
#include "contact/quick_force.h"
#include "contact/strip_contact.h"
#include "contact/strip_dent.h"
#include "contact/surrogate_batch.h"
#include "patch/patch_law.h"

/* A contact that begins deeper than this multiple of the motion in the step is sudden: speeds are those of
 * now, and a predicted rotation is longer than its chord. */
#define SUDDEN 2.0

/* Evaluates an elastic wall: force, moment and energy of Winkler's foundation under the part of A behind
 * the wall, and a dashpot at the centre of pressure, which never pulls.  The approach speed is the same
 * along the normal, so the centre may lie behind the wall. */
static int evaluate_elastic_wall(fl_world *w, fl_pair *p, const fl_relative_pose *r,
                                 const fl_pair_prediction *a, int survey, double *distance)
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
    const double predicted = -v3_dot(n, fl_pair_end_velocity(b, p, a, ai, aj)),
                 compliance = fl_pair_compliance(&ease, n, v3_cross(ai, n), v3_cross(aj, n), 1.0),
                 approach =
                     predicted + fl_pair_approach_correction(a, predicted, elastic, damping, compliance);
    double normal = elastic + damping * approach;
    if (normal < 0.0) normal = 0.0;
    fl_point_sum sums = {.result = {.slope = w->elastic_walls.stiffness * wet.waterplane_area, .centre = aj}};
    fl_add_wrench(&p->force, &p->torque_i, &p->torque_j, v3_scale(normal, n), ai, aj);
    fl_add_wrench(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping,
                  v3_scale(normal - elastic, n), ai, aj);
    fl_point_sum_add(&sums, elastic, normal, n, v3(0, 0, 0));
    const fl_patch_result all = fl_point_sum_result(&sums, 1);
    fl_pair_add_friction(w, p, &all, 0.0, &(fl_contact_compliance){0}, r, a);
    if (fl_pair_add_rolling(w, p, &all, 0.0, a)) return -1;
    if (survey) { /* the section rotates with the body: take its farthest point */
        fl_stiffness si = {0}, sj = {0};
        fl_stiffness_add_force(&si, b, i, all.slope, n, v3_cross(ai, n));
        fl_pair_bound_stiffness(w, p, &all, r, &si, &sj);
    }
    p->energy += p->spring_energy;
    return p->touching = 1;
}

/* Evaluates ice that crushes by its speed; *distance is set where the two do not touch. */
static int evaluate_strip(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r,
                          const fl_pair_prediction *a, double dt, int survey, double *distance)
{
    const double store = p->strip ? p->strip->store : 0.0, work = p->strip ? p->strip->work : 0.0;
    const fl_mat3 R = r->R;
    const fl_piece *piece = fl_world_piece(w, p->j);
    fl_strip_result q;
    if (fl_strip_contact_advance(w, p, r, dt, survey, &q)) return -1;
    /* until its last work is booked, and its dent kept */
    p->touching = q.touches || store > 0.0 || work != 0.0 || fl_strip_has_left(p->strip);
    if (!p->touching) {
        free(p->strip);
        p->strip = NULL;
        return fl_pair_find_points(w, p, thread, r, distance) ? -1 : 0;
    }
    const fl_vec3 none = v3(0, 0, 0);
    p->overlap = q.max_depth;
    p->energy = p->strip->store;
    fl_add_scaled_wrench(&p->force, &p->torque_i, &p->torque_j, &q.force, 1.0, &R, r->off, none);
    fl_patch_result all = {.energy = p->energy,
                           .force = p->force,
                           .elastic = q.normal,
                           .normal = q.normal,
                           .direction = p->force,
                           .load = v3_norm(p->force),
                           .centre = m3_mul(R, q.centre),
                           .slope = q.slope};
    if (piece->several_parts) p->load_part = fl_load_part_at(w, p->j, v3_add(w->b.x[p->j], all.centre));
    if (q.normal > 0.0 && all.load > 0.0)
        fl_pair_add_friction(w, p, &all, 0.0, &(fl_contact_compliance){0}, r, a);
    else p->springs = (fl_friction_springs){0};
    if (survey) {
        fl_stiffness si = {0}, sj = {0};
        fl_stiffness_add_springs(&si, &w->b, p->i, 1.0, &q.springs, R, r->off);
        fl_stiffness_add_springs(&sj, &w->b, p->j, 1.0, &q.springs, R, none);
        if (!(q.normal > 0.0)) all.direction = v3(1, 0, 0);
        fl_pair_bound_stiffness(w, p, &all, r, &si, &sj);
    }
    p->energy += p->spring_energy;
    if (q.normal > 0.0 && fl_panels_need_points(w, p))
        fl_panels_record_point(w, p, q.centre, v3_unit(q.force.f), q.slope / p->strip->k);
    return 1;
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

void fl_pair_note_beginning(fl_world *w, const fl_pair *p, double moved)
{
    const double radii = w->b.radius[p->i] + w->b.radius[p->j];
    if (w->step == 0 || p->bond || p->overlap <= SUDDEN * moved + FL_PATCH_RIM_WIDTH * radii) return;
#pragma omp critical(fl_sudden_contacts)
    {
        fl_sudden_contacts *const s = &w->sudden;
        if (s->n++ == 0 || (s->step == w->step && (p->i < s->i || (p->i == s->i && p->j < s->j))))
            s->step = w->step, s->i = p->i, s->j = p->j, s->overlap = p->overlap, s->moved = moved,
            s->time = fl_world_time(w);
    }
}

static void check_beginning(fl_world *w, const fl_pair *p, const fl_relative_pose *r, double dt)
{
    const fl_bodies *b = &w->b;
    const double rho = b->bounding_radius[p->i], apart = v3_norm(r->off) + rho,
                 moved = step_motion(b, p->i, rho, dt) + step_motion(b, p->j, apart, dt);
    if (dt != 0.0) fl_pair_note_beginning(w, p, moved);
}

/* Finds the contact points with what is crushed taken off. */
static int find_worn_points(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r,
                            double *distance)
{
    fl_relative_pose worn = p->crush ? fl_crushing_pose(p, r) : *r;
    if (fl_pair_find_points(w, p, thread, &worn, distance)) return -1;
    if (p->crush || !fl_pair_crushes(w, p) || w->scratch[thread].n == 0) return 0;
    fl_force_sum q;
    if (!w->crushing.dents[p->i]) return 0;
    if (fl_force_sum_elastic(&w->scratch[thread], &q)) return -1;
    if (!(q.pressure > 0.0)) return 0;
    const fl_vec3 centre = v3_madd(w->scratch[thread].point[0].p, 1.0 / q.pressure, q.pressure_moment);
    const int worn_here = fl_crushing_adopt(w, p, centre, q.gradient.f, r);
    if (worn_here <= 0) return worn_here;
    worn = fl_crushing_pose(p, r);
    return fl_pair_find_points(w, p, thread, &worn, distance);
}

/* The terms of the law `quick` with what is crushed taken off. */
static int find_worn_quick(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r,
                           double *distance, fl_quick_sums *sums)
{
    fl_relative_pose worn = p->crush ? fl_crushing_pose(p, r) : *r;
    if (fl_pair_find_quick(w, p, thread, &worn, distance, sums)) return -1;
    if (p->crush || !fl_pair_crushes(w, p) || !(sums->pressure > 0.0)) return 0;
    const int worn_here =
        fl_crushing_adopt(w, p, v3_scale(1.0 / sums->pressure, sums->moment), sums->gradient.f, r);
    if (worn_here <= 0) return worn_here;
    worn = fl_crushing_pose(p, r);
    return fl_pair_find_quick(w, p, thread, &worn, distance, sums);
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
    const fl_pair_prediction a = fl_pair_prediction_of(w, p, &r, dt);
    if (p->crush) fl_crushing_slide(w, p, &r, dt);
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
        if (fl_pair_evaluate_features(w, p, thread, &r, &a, survey, &distance)) goto failed;
        if (p->touching) goto touches;
    } else if (fl_pair_is_quick(w, p)) {
        fl_quick_sums sums;
        if (find_worn_quick(w, p, thread, &r, &distance, &sums)) goto failed;
        const int touch = fl_pair_evaluate_quick(w, p, thread, &sums, t, &r, &a, survey);
        if (touch < 0) goto failed;
        if (touch) goto touches;
    } else {
        const int shared = piece && piece->several_parts;
        s->keep_features = w->panel_load.panels || shared;
        if (find_worn_points(w, p, thread, &r, &distance)) goto failed;
        if (shared && s->n) fl_load_find_part(w, p, s);
        const int touch = p->points == FL_POINTS_PATCH
                              ? fl_pair_evaluate_patch(w, p, thread, t, &r, &a, survey)
                          : s->n ? fl_pair_evaluate_points(w, p, s, &r, &a, survey)
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
