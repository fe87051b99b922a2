/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/pair_damping.h"
#include "contact/pair_friction.h"
#include "contact/pair_stiffness.h"
#include "contact/panel_load.h"
#include "contact/point_force.h"
#include "contact/point_kernel.h"
#include "law/manual.h"
#include "law/normal.h"

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

/* Bounds omega^2 of points that push along their normals; points of negative weight take nothing off. */
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
    fl_pair_bound_stiffness(w, p, all, r, &si, &sj);
}

/* Predicted approach speed along n [m/s]. */
static double approach_speed_of(const fl_bodies *b, const fl_pair *p, const fl_pair_prediction *a,
                                const world_point *t)
{
    return -v3_dot(t->n, fl_pair_end_velocity(b, p, a, t->ai, t->aj));
}

/* A body of a pair, of which ease moves. */
static fl_point_body point_body(const fl_bodies *b, int32_t k, fl_vec3 change_v, fl_vec3 change_w,
                                const fl_mobility *ease)
{
    return (fl_point_body){b->v[k], b->w[k], change_v, change_w, ease->linear, ease->angular};
}

static fl_point_contact point_contact(const fl_world *w, const fl_pair *p, const fl_patch_point *q,
                                      const fl_relative_pose *r, const fl_pair_prediction *by)
{
    const fl_bodies *b = &w->b;
    const fl_pair_mobility ease = fl_pair_mobility_of(w, p);
    const fl_vec3 n = m3_mul(r->R, q->n), aj = m3_mul(r->R, q->p);
    return (fl_point_contact){
        .n = n,
        .ai = v3_add(aj, r->off),
        .aj = aj,
        .overlap = q->overlap,
        .i = point_body(b, p->i, by->change.vi, by->change.wi, &ease.i),
        .j = point_body(b, p->j, by->change.vj, by->change.wj, &ease.j),
        .lag = by->lag,
        .reduced_mass = p->mass,
        .contact_count = by->change.contact_count,
        .dt = by->step.dt,
        .half_step = by->step.half_step,
        .at_start = by->step.at_start,
        .step = (double)w->step,
        .step_size = w->dt,
        .is_reduced = fl_pair_has_reduced_mass(w, p),
        .sustains = fl_pair_is_on_facets(w, p),
        .law = {p->k, p->exponent, p->law->friction, p->law->tangential_ratio, p->law->impact_damping,
                p->law->slow_damping_factor},
    };
}

fl_point_memory fl_pair_memory(const fl_pair *p)
{
    return (fl_point_memory){
        p->springs,        p->sustained_spin,      p->sustained_spin_rate, p->max_approach_speed,
        p->sustained_load, p->sustained_load_rate, p->sustained_step};
}

fl_point_forces fl_pair_forces(const fl_pair *p)
{
    return (fl_point_forces){p->force,          p->torque_i,          p->torque_j,
                             p->force_damping,  p->torque_i_damping,  p->torque_j_damping,
                             p->force_friction, p->torque_i_friction, p->torque_j_friction,
                             p->energy,         p->spring_energy,     p->overlap};
}

void fl_pair_set_point(fl_pair *p, const fl_point_memory *m, const fl_point_forces *f)
{
    p->springs = m->springs;
    p->sustained_spin = m->sustained_spin, p->sustained_spin_rate = m->sustained_spin_rate;
    p->max_approach_speed = m->max_approach_speed;
    p->sustained_load = m->sustained_load, p->sustained_load_rate = m->sustained_load_rate;
    p->sustained_step = m->sustained_step;
    p->force = f->force, p->torque_i = f->torque_i, p->torque_j = f->torque_j;
    p->force_damping = f->force_damping;
    p->torque_i_damping = f->torque_i_damping, p->torque_j_damping = f->torque_j_damping;
    p->force_friction = f->force_friction;
    p->torque_i_friction = f->torque_i_friction, p->torque_j_friction = f->torque_j_friction;
    p->energy = f->energy, p->spring_energy = f->spring_energy, p->overlap = f->overlap;
}

void fl_pair_bound_single_point(const fl_world *w, fl_pair *p, fl_vec3 n, fl_vec3 aj, fl_vec3 off,
                                double normal)
{
    fl_stiffness si = {0}, sj = {0};
    const fl_patch_result all = {.direction = v3_madd(v3(0, 0, 0), normal, n), .centre = aj};
    const fl_relative_pose r = {.off = off};
    const double slope = p->k * fl_normal_slope(p->overlap, p->exponent);
    fl_stiffness_add_force(&si, &w->b, p->i, slope, n, v3_cross(v3_add(aj, off), n));
    fl_stiffness_add_force(&sj, &w->b, p->j, slope, n, v3_cross(aj, n));
    fl_pair_bound_stiffness(w, p, &all, &r, &si, &sj);
}

/* A single point, damped by the speed predicted for the end of the step. */
static int evaluate_one_point(fl_world *w, fl_pair *p, const fl_patch_points *s, const fl_relative_pose *r,
                              const fl_pair_prediction *by, int survey)
{
    const fl_point_contact c = point_contact(w, p, &s->point[0], r, by);
    const fl_point_before before = {by->before.elastic.f, by->before.damping.f, by->before.friction_damping,
                                    by->before.friction_damping_moment};
    fl_point_memory m = fl_pair_memory(p);
    fl_point_forces f;
    const fl_point_normal q = fl_point_evaluate(&c, p->touching, before, &m, &f);
    fl_pair_set_point(p, &m, &f);
    const fl_patch_result all = {.elastic = q.elastic,
                                 .normal = q.normal,
                                 .direction = q.direction,
                                 .load = q.load,
                                 .slope = q.slope,
                                 .centre = c.aj};
    if (w->breaking.on) p->load_point = c.ai;
    if (fl_pair_add_rolling(w, p, &all, q.chi, by)) return -1;
    if (survey) fl_pair_bound_single_point(w, p, c.n, c.aj, r->off, q.normal);
    p->energy += p->spring_energy;
    if (fl_panels_need_points(w, p)) fl_panels_record_points(w, p, s, p->k, q.chi);
    return p->touching = 1;
}

int fl_pair_evaluate_points(fl_world *w, fl_pair *p, const fl_patch_points *s, const fl_relative_pose *r,
                            const fl_pair_prediction *by, int survey)
{
    const fl_bodies *b = &w->b;
    if (s->n == 1 && p->law->law->end_speed) return evaluate_one_point(w, p, s, r, by, survey);
    const fl_pair_prediction unpredicted = {.step = by->step,
                                            .lag = by->lag,
                                            .change = {.contact_count = 1.0}},
                             *const a = &unpredicted;
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
    if (!fl_pair_has_reduced_mass(w, p)) ease = fl_pair_mobility_of(w, p);
    const double mass = less > 0.0 ? fl_pair_mass(w, p, &ease, way, turn_i, turn_j) / less : INFINITY;
    const double first_approach = approach_speed_of(b, p, a, &first);
    double approach = first_approach, mean = 0.0, sustained = 0.0;
    if (fl_pair_is_on_facets(w, p)) { /* a sphere: its spin does not matter, and its core is its centre */
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
        const fl_vec3 n = v3_unit(way), u = fl_pair_end_velocity(b, p, a, v3(0, 0, 0), v3_neg(r->off));
        sustained = fl_pair_sustained_share(w, p, load, stiff, mass, v3_madd(u, -v3_dot(u, n), n),
                                            v3(0, 0, 0), fmax(square / sum - mean * mean, 0.0));
    }
    for (int32_t c = 1; c < s->n; c++) {
        const world_point t = world_point_of(p, &s->point[c], r);
        if (s->point[c].du > 0.0) approach = fmax(approach, approach_speed_of(b, p, a, &t));
    }
    const double chi = fl_pair_damping_factor(p, approach > 0.0 ? approach : 0.0, mass);
    fl_point_sum sums = {.result.centre = first.aj};
    for (int32_t c = 0; c < s->n; c++) {
        const fl_patch_point *q = &s->point[c];
        const world_point t = c ? world_point_of(p, q, r) : first;
        const double elastic = k * t.weight, slope = k * q->du * fl_normal_slope(q->overlap, p->exponent),
                     own = c ? approach_speed_of(b, p, a, &t) : first_approach,
                     comes = s->n > 1 ? own + sustained * (mean - own) : own,
                     normal = q->du * fl_normal_damped_force(fabs(elastic), chi, comes);
        fl_add_wrench(&p->force, &p->torque_i, &p->torque_j, v3_scale(normal, t.n), t.ai, t.aj);
        fl_add_wrench(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping,
                      v3_scale(normal - elastic, t.n), t.ai, t.aj);
        fl_point_sum_add(&sums, elastic, normal, t.n, v3_sub(t.aj, first.aj));
        sums.result.slope += slope;
    }
    const fl_patch_result all = fl_point_sum_result(&sums, s->n);
    fl_pair_add_friction(w, p, &all, chi, &(fl_contact_compliance){.turn = 0.0}, r, a);
    if (fl_pair_add_rolling(w, p, &all, chi, a)) return -1;
    if (survey) bound_stiffness_of_points(w, p, s, &all, r);
    p->energy += p->spring_energy;
    if (fl_panels_need_points(w, p)) fl_panels_record_points(w, p, s, p->k, chi);
    return p->touching = 1;
}

int fl_pair_evaluate_features(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r,
                              const fl_pair_prediction *a, int survey, double *distance)
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
    const fl_vec3 u =
        fl_pair_mean_velocity(b, p, a, ai, aj); /* without fl_pair_prediction, as in the manual */
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
    fl_point_sum sums = {.result = {.slope = slope, .centre = aj}};
    p->overlap = overlap;
    p->energy = k * fl_normal_phi(overlap, exponent);
    p->mode = c.mode;
    fl_add_wrench(&p->force, &p->torque_i, &p->torque_j, v3_scale(normal, nw), ai, aj);
    fl_add_wrench(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping,
                  v3_scale(normal - elastic, nw), ai, aj);
    fl_point_sum_add(&sums, elastic, normal, nw, v3(0, 0, 0));
    const fl_patch_result all = fl_point_sum_result(&sums, 1);
    fl_pair_add_friction(w, p, &all, 0.0, &(fl_contact_compliance){0}, r, a);
    if (survey) fl_pair_bound_point_stiffness(w, p, &all, nw, r);
    p->energy += p->spring_energy;
    if (fl_panels_need_points(w, p)) fl_panels_record_point(w, p, c.p, c.n, c.area);
    p->touching = 1;
    return 0;
}
