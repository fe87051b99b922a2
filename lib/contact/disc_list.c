/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/disc_list.h"
#include <assert.h>
#include <string.h>
#include "contact/pair_law.h"
#include "law/normal.h"
#include "world/access.h"

int32_t fl_disc_list_find(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    const fl_disc_list *s = &w->discs;
    if (i >= w->n || j >= w->n || !s->n) return -1;
    for (int64_t k = s->first_i[i]; k < s->first_i[i + 1]; k++)
        if (s->at.j[k] == j && (!s->image || memcmp(&s->image[3 * k], image, 3 * sizeof *image) == 0))
            return (int32_t)k;
    return -1;
}

/* --- memory ------------------------------------------------------------------------------------ */

static fl_vec3 vector_of(double *const *a, int32_t k) { return v3(a[0][k], a[1][k], a[2][k]); }

static void set_vector(double *const *a, int32_t k, fl_vec3 v)
{
    a[0][k] = v.x, a[1][k] = v.y, a[2][k] = v.z;
}

fl_disc_memory fl_disc_list_memory(const fl_disc_list *s, int32_t k)
{
    const fl_disc_arrays *a = &s->at;
    fl_disc_memory m = {.S = vector_of(a->S, k),
                        .M = vector_of(a->M, k),
                        .lambda = a->lambda[k],
                        .dissipated = a->dissipated[k],
                        .friction_loss = a->friction_loss[k]};
    if (!a->damped) return m;
    m.damping_force = vector_of(a->damping_force, k), m.damping_couple = vector_of(a->damping_couple, k);
    m.damped = a->damped[k];
    return m;
}

void fl_disc_list_set_memory(fl_disc_list *s, int32_t k, const fl_disc_memory *m)
{
    fl_disc_arrays *a = &s->at;
    set_vector(a->S, k, m->S), set_vector(a->M, k, m->M);
    a->lambda[k] = m->lambda, a->dissipated[k] = m->dissipated, a->friction_loss[k] = m->friction_loss;
    a->is_whole[k] = !s->has_ended[k] && fl_disc_integrity(&s->classes[a->which[k]], m->lambda) == 1.0;
    if (!a->damped) return;
    set_vector(a->damping_force, k, m->damping_force), set_vector(a->damping_couple, k, m->damping_couple);
    a->damped[k] = m->damped;
}

fl_vec3 fl_disc_list_separation(const fl_world *w, int32_t k)
{
    const fl_disc_list *s = &w->discs;
    const fl_vec3 d = v3_sub(w->b.x[s->at.j[k]], w->b.x[s->at.i[k]]);
    return s->shift ? v3_add(d, s->shift[k]) : d;
}

/* --- in a step --------------------------------------------------------------------------------- */

/* Energy along the normal of the contact that takes over.  What its spring of friction begins with is in the
 * books of friction: they count the work of the whole friction force, less what springs hold. */
static double contact_energy(const fl_world *w, int32_t i, int32_t j, double overlap)
{
    const fl_pair_spring p = fl_pair_stiffness(w, i, j);
    return overlap > 0.0 ? p.k * fl_normal_phi(overlap, p.exponent) : 0.0;
}

/* Ends bond k, whose friction holds S. */
static void end_disc(fl_world *w, int32_t k, const fl_disc_class *c, fl_disc_memory *m, fl_vec3 d, fl_vec3 S)
{
    fl_disc_list *s = &w->discs;
    const int32_t i = s->at.i[k], j = s->at.j[k];
    const double overlap = w->b.radius[i] + w->b.radius[j] - v3_norm(d);
    s->pending[k] = contact_energy(w, i, j, overlap);
    m->dissipated += fl_disc_energy(c, m, d) - s->pending[k];
    m->S = S, m->M = m->damping_force = m->damping_couple = v3(0, 0, 0);
    s->has_ended[k] = FL_DISC_JUST_ENDED;
#pragma omp atomic
    s->ended++;
}

/* Evaluates bond k alone; returns |F|. */
static double evaluate_disc(fl_world *w, int32_t k, double dt)
{
    fl_disc_list *s = &w->discs;
    const fl_bodies *b = &w->b;
    const int32_t i = s->at.i[k], j = s->at.j[k];
    const fl_disc_class *c = &s->classes[s->at.which[k]];
    const fl_disc_pose at = {fl_disc_list_separation(w, k), b->v[i], b->v[j], b->w[i], b->w[j]};
    fl_disc_memory m = fl_disc_list_memory(s, k);
    const fl_disc_wrench f = fl_disc_force(&s->law, c, s->at.scatter ? s->at.scatter[k] : 1.0, &at, dt, &m);
    s->at.out[k] = f;
    if (fl_disc_is_broken(c, m.lambda)) {
        const fl_vec3 e = v3_unit(at.d);
        end_disc(w, k, c, &m, at.d, v3_madd(f.force, -v3_dot(f.force, e), e));
    }
    fl_disc_list_set_memory(s, k, &m);
    return v3_norm(f.force);
}

static_assert((int)FL_DISC_RUN <= (int)FL_DISC_BATCH, "a run is a batch");

void fl_disc_list_evaluate(fl_world *w, int32_t from, int32_t to, double dt)
{
    fl_disc_list *s = &w->discs;
    fl_disc_batch_result r;
    const int32_t n = to - from;
    double sum = 0.0;
    const int left =
        fl_disc_batch_force(&s->at, from, (n + FL_LANE_COUNT - 1) / FL_LANE_COUNT * FL_LANE_COUNT, &s->law,
                            s->classes, &w->b, s->shift ? s->shift + from : NULL, dt, &r);
    for (int32_t k = 0; k < n; k += FL_LANE_COUNT) {
        double own = 0.0;
        for (int32_t l = 0; l < FL_LANE_COUNT; l++) own += r.size[k + l];
        sum += own;
        for (int32_t l = k; left && l < k + FL_LANE_COUNT && l < n; l++) {
            if (r.done[l]) continue;
            if (s->has_ended[from + l])
                s->at.out[from + l] = (fl_disc_wrench){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
            else sum += evaluate_disc(w, from + l, dt);
        }
    }
    s->force_sum[from / FL_DISC_RUN] = sum;
}

/* A wrench has F, T_i and T_j, one behind another: loads of four numbers from 0 and 4 on add F and T_i to a
 * body i, from 0 and 5 on F and T_j to a body j. */
static_assert(sizeof(fl_disc_wrench) == 9 * sizeof(double), "consecutive doubles");

FL_SIMD4_VERSIONS static void add_wrenches(const fl_disc_list *restrict s, int32_t from, int32_t to,
                                           fl_vec3 *restrict f, fl_vec3 *restrict t)
{
    for (int32_t k = from; k < to; k++, f++, t++) {
        fl_simd F = {f->x, f->y, f->z, t->x}, T = {t->y, t->z, 0.0, 0.0};
        for (int64_t at = s->first_i[k]; at < s->first_i[k + 1]; at++) {
            const double *const q = (const double *)(const void *)&s->at.out[at];
            F += FL_SIMD_LOAD(q), T += FL_SIMD_LOAD(q + 4);
        }
        T = (fl_simd){0.0, F[3], T[0], T[1]};
        for (int64_t at = s->first_j[k]; at < s->first_j[k + 1]; at++) {
            const double *const q = (const double *)(const void *)&s->at.out[s->of[at]];
            F -= FL_SIMD_LOAD(q), T += FL_SIMD_LOAD(q + 5);
        }
        *f = v3(F[0], F[1], F[2]), *t = v3(T[1], T[2], T[3]);
    }
}

void fl_disc_list_add_forces_of(const fl_world *w, int32_t from, int32_t to, fl_vec3 *f, fl_vec3 *t)
{
    if (w->discs.n) add_wrenches(&w->discs, from, to, f, t);
}

void fl_disc_list_add_forces(const fl_world *w, int32_t k, fl_vec3 *f, fl_vec3 *t)
{
    if (k < w->n) fl_disc_list_add_forces_of(w, k, k + 1, f, t);
}

void fl_disc_list_init_contact(const fl_world *w, int32_t i, int32_t j, const int32_t image[3],
                               fl_sphere_contact *c)
{
    const fl_disc_list *s = &w->discs;
    if (!s->ended) return;
    const int32_t k = fl_disc_list_find(w, i, j, image);
    if (k < 0 || s->has_ended[k] != FL_DISC_JUST_ENDED) return;
    const fl_pair_spring p = fl_pair_stiffness(w, i, j);
    const double overlap = w->b.radius[i] + w->b.radius[j] - v3_norm(fl_disc_list_separation(w, k)),
                 kt = overlap > 0.0 ? fl_pair_law_of(w, i, j)->tangential_ratio * p.k *
                                          fl_normal_slope(overlap, p.exponent)
                                    : 0.0;
    if (!(kt > 0.0)) return;
    c->spring_force = c->friction_force = vector_of(s->at.S, k);
    c->spring_stiffness = kt;
}

void fl_disc_list_forget_ended(fl_world *w)
{
    fl_disc_list *s = &w->discs;
    for (int32_t k = 0; k < s->n && s->ended; k++) {
        if (s->has_ended[k] != FL_DISC_JUST_ENDED) continue;
        s->has_ended[k] = FL_DISC_ENDED;
        s->pending[k] = 0.0;
        s->ended--;
    }
}

double fl_disc_list_max_omega2(const fl_world *w, int32_t k)
{
    return w->discs.n ? w->discs.max_omega2[k] : 0.0;
}

double fl_disc_list_omega2(const fl_world *w, int32_t k)
{
    const fl_disc_list *s = &w->discs;
    double sum = 0.0;
    if (!s->n) return 0.0;
    for (int64_t at = s->first_i[k]; at < s->first_i[k + 1]; at++)
        if (!s->has_ended[at]) sum += s->omega2[2 * at];
    for (int64_t at = s->first_j[k]; at < s->first_j[k + 1]; at++)
        if (!s->has_ended[s->of[at]]) sum += s->omega2[2 * s->of[at] + 1];
    return sum < s->max_omega2[k] ? sum : s->max_omega2[k];
}

void fl_disc_list_end_leaving(fl_world *w, int32_t k)
{
    fl_disc_list *s = &w->discs;
    if (s->has_ended[k] == FL_DISC_JUST_ENDED) s->pending[k] = 0.0, s->ended--; /* no contact follows it */
    s->has_ended[k] = FL_DISC_ENDED;
    s->at.is_whole[k] = 0;
    s->at.out[k] = (fl_disc_wrench){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
}

void fl_disc_list_end_absent(fl_world *w)
{
    const fl_disc_list *s = &w->discs;
    for (int32_t k = 0; k < s->n; k++)
        if (s->has_ended[k] != FL_DISC_ENDED &&
            (fl_body_absent(w, s->at.i[k]) || fl_body_absent(w, s->at.j[k])))
            fl_disc_list_end_leaving(w, k);
}

fl_disc_load fl_disc_list_load(const fl_world *w, int32_t k)
{
    const fl_disc_list *s = &w->discs;
    const fl_disc_memory m = fl_disc_list_memory(s, k);
    fl_disc_load out =
        fl_disc_section_load(&s->law, &s->classes[s->at.which[k]], &m, fl_disc_list_separation(w, k));
    if (s->has_ended[k]) out.tension = out.shear = out.moment = 0.0;
    out.x = fl_periodic_cell_wrap(&w->cell, v3_add(w->b.x[s->at.i[k]], out.x));
    return out;
}

fl_disc_energies fl_disc_list_energies(const fl_world *w)
{
    const fl_disc_list *s = &w->discs;
    fl_disc_energies sum = {
        .dissipated = s->past.dissipated, .damped = s->past.damped, .friction_loss = s->past.friction_loss};
    for (int32_t k = 0; k < s->n; k++) {
        const fl_disc_memory m = fl_disc_list_memory(s, k);
        sum.store += s->has_ended[k]
                         ? s->pending[k]
                         : fl_disc_energy(&s->classes[s->at.which[k]], &m, fl_disc_list_separation(w, k));
        sum.dissipated += m.dissipated, sum.damped += m.damped, sum.friction_loss += m.friction_loss;
    }
    return sum;
}

double fl_disc_list_force_sum(const fl_world *w)
{
    double sum = 0.0;
    for (int32_t k = 0; k * FL_DISC_RUN < w->discs.n; k++) sum += w->discs.force_sum[k];
    return sum;
}

double fl_disc_list_bytes(const fl_world *w)
{
    const fl_disc_list *s = &w->discs;
    const double real = sizeof(double), bond = 12 * real + 3 * sizeof(int32_t) + sizeof(uint16_t) + 2 +
                                               sizeof(fl_disc_wrench) + (s->at.damped ? 7 * real : 0.0) +
                                               (s->at.scatter ? real : 0.0) +
                                               (s->image ? sizeof(fl_vec3) + 3 * sizeof(int32_t) : 0.0);
    return s->n ? s->n * bond + w->n * (2.0 * sizeof(int64_t) + real) : 0.0;
}
