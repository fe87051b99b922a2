/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/disc_list.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "contact/bond_image.h"
#include "contact/pair_law.h"
#include "law/normal.h"
#include "patch/stiffness_bound.h"
#include "world/access.h"

/* All six degrees of freedom fixed. */
enum { ALL_FIXED = 63 };

/* Lengths that differ by less than this fraction are equal: a lattice then has one class. */
#define SAME_LENGTH 1e-9

/* Number of classes that are compared before a new one is made. */
enum { CLASSES_TRIED = 16 };

/* Least scatter of a strength: a normal law has a tail below 0. */
#define LEAST_SCATTER 0.1

/* --- set-up ------------------------------------------------------------------------------------ */

static fl_vec3 field_separation(const fl_world *w, const fl_ice_field_bond *d)
{
    return v3_add(v3_sub(w->b.x[d->j], w->b.x[d->i]),
                  fl_periodic_cell_offset(&w->cell, fl_bond_image_of(w, d->i, d->j, d->x)));
}

int fl_disc_list_includes(const fl_world *w, const fl_ice_field_bond *d)
{
    const fl_bodies *b = &w->b;
    return b->core[d->i].nv == 1 && b->core[d->j].nv == 1 &&
           v3_norm(field_separation(w, d)) >= (1.0 - FL_DISC_OVERLAP) * (b->radius[d->i] + b->radius[d->j]);
}

/* Ductility f of a bond of the length l, and the factor of its strengths. */
static void set_ductility(const fl_scene_bond *s, double E, fl_disc_class *c)
{
    const double T = s->normal_strength, C = s->shear_strength, ks = c->shear_ratio * E,
                 peak = isfinite(T)   ? 0.5 * T * T * c->length / E
                        : isfinite(C) ? 0.5 * C * C * c->length / ks
                                      : INFINITY;
    c->weakening = 1.0;
    c->ductility = s->energy / peak;
    if (s->softening == FL_SOFTENING_STRETCH && c->ductility < s->stretch) c->ductility = s->stretch;
    if (s->softening == FL_SOFTENING_WEAKEN && c->ductility < 1.0)
        c->weakening = sqrt(c->ductility), c->ductility = 1.0;
}

static fl_disc_class class_of(const fl_world *w, const fl_ice_field_bond *d)
{
    const fl_scene_bond *s = &w->scene->bond;
    const fl_bodies *b = &w->b;
    const fl_scene_material *A = &w->scene->material[w->material[d->i]],
                            *B = &w->scene->material[w->material[d->j]];
    const double ri = b->radius[d->i], rj = b->radius[d->j], apart = v3_norm(field_separation(w, d)),
                 E = s->young > 0.0 ? s->young : 2.0 / (1.0 / A->young + 1.0 / B->young),
                 nu = s->poisson >= 0.0 ? s->poisson : 0.5 * (A->poisson + B->poisson),
                 m = b->m[d->i] * b->m[d->j] / (b->m[d->i] + b->m[d->j]);
    fl_disc_class c = {.length = fabs(apart - (ri + rj)) < SAME_LENGTH * apart ? ri + rj : apart,
                       .shear_ratio = 0.5 / (1.0 + nu),
                       .radius = s->radius_factor * (ri < rj ? ri : rj),
                       .share = ri / (ri + rj)};
    c.kn = E * PI * c.radius * c.radius / c.length;
    c.damping = 2.0 * s->damping / sqrt(c.kn / m);
    set_ductility(s, E, &c);
    return c;
}

/* Number of the class, which is added if it is new. */
static int32_t find_class(fl_disc_list *s, const fl_disc_class *c, fl_err *err)
{
    for (int32_t k = s->n_class - 1; k >= 0 && k >= s->n_class - CLASSES_TRIED; k--)
        if (memcmp(&s->classes[k], c, sizeof *c) == 0) return k;
    if (s->n_class > UINT16_MAX)
        return fl_fail(err, FL_INPUT, "bonds of spheres of more than %d sizes: fewer are expected",
                       UINT16_MAX);
    if (fl_grow(&s->classes, &s->class_cap, (int64_t)s->n_class + 1, sizeof *s->classes, err)) return -1;
    s->classes[s->n_class] = *c;
    return s->n_class++;
}

/* Strength over the mean of the bond of two ids. */
static double scatter_of(const fl_scene_bond *s, int32_t i, int32_t j)
{
    fl_rng g = fl_rng_of((uint64_t)s->seed, fl_rng_entity(i, j), FL_RNG_STRENGTH);
    return fmax(1.0 + s->scatter * fl_rng_normal(&g), LEAST_SCATTER);
}

static int alloc_arrays(fl_world *w, int64_t n, fl_err *err)
{
    fl_disc_list *s = &w->discs;
    fl_disc_arrays *a = &s->at;
    const int64_t full = (n + FL_LANE_COUNT - 1) / FL_LANE_COUNT * FL_LANE_COUNT;
    double **const reals[] = {&a->S[0], &a->S[1],   &a->S[2],       &a->M[0],          &a->M[1],
                              &a->M[2], &a->lambda, &a->dissipated, &a->friction_loss, &s->pending};
    double **const dampers[] = {&a->damping_force[0],
                                &a->damping_force[1],
                                &a->damping_force[2],
                                &a->damping_couple[0],
                                &a->damping_couple[1],
                                &a->damping_couple[2],
                                &a->damped};
    for (size_t k = 0; k < sizeof reals / sizeof *reals; k++)
        if (!(*reals[k] = fl_alloc(full, sizeof **reals[k], err))) return -1;
    for (size_t k = 0; k < sizeof dampers / sizeof *dampers && w->scene->bond.damping > 0.0; k++)
        if (!(*dampers[k] = fl_alloc(full, sizeof **dampers[k], err))) return -1;
    a->i = fl_alloc(full, sizeof *a->i, err), a->j = fl_alloc(full, sizeof *a->j, err);
    a->which = fl_alloc(full, sizeof *a->which, err);
    a->is_whole = fl_alloc(full, sizeof *a->is_whole, err);
    a->out = fl_alloc(full, sizeof *a->out, err);
    s->has_ended = fl_alloc(full, sizeof *s->has_ended, err);
    s->force_sum = fl_alloc(n / FL_DISC_RUN + 1, sizeof *s->force_sum, err);
    if (!a->i || !a->j || !a->which || !a->is_whole || !a->out || !s->has_ended || !s->force_sum) return -1;
    if (w->scene->bond.scatter > 0.0 && !(a->scatter = fl_alloc(full, sizeof *a->scatter, err))) return -1;
    if (!w->cell.periodic) return 0;
    s->shift = fl_alloc(full, sizeof *s->shift, err);
    s->image = fl_alloc(3 * full, sizeof *s->image, err);
    return s->shift && s->image ? 0 : -1;
}

static int add_disc(fl_world *w, const fl_ice_field_bond *d, fl_err *err)
{
    fl_disc_list *s = &w->discs;
    const int32_t k = s->n;
    const fl_disc_class c = class_of(w, d);
    if (!(c.length > 0.0))
        return fl_fail(err, FL_INPUT, "%s: the bond of body %d and %d has no length: their centres coincide",
                       w->scene->ice.file, w->id[d->i], w->id[d->j]);
    const int32_t which = find_class(s, &c, err);
    if (which < 0) return -1;
    s->at.i[k] = d->i, s->at.j[k] = d->j;
    s->at.which[k] = (uint16_t)which;
    s->at.is_whole[k] = 1;
    if (s->at.scatter) s->at.scatter[k] = scatter_of(&w->scene->bond, w->id[d->i], w->id[d->j]);
    if (s->image) {
        const fl_vec3 cells = fl_bond_image_of(w, d->i, d->j, d->x);
        s->shift[k] = fl_periodic_cell_offset(&w->cell, cells);
        s->image[3 * k] = (int32_t)cells.x, s->image[3 * k + 1] = (int32_t)cells.y;
        s->image[3 * k + 2] = (int32_t)cells.z;
    }
    s->n++;
    return 0;
}

/* The bonds of each body. */
static int index_discs(fl_world *w, fl_err *err)
{
    fl_disc_list *s = &w->discs;
    s->first_i = fl_alloc((int64_t)w->n + 2, sizeof *s->first_i, err);
    s->first_j = fl_alloc((int64_t)w->n + 2, sizeof *s->first_j, err);
    s->of = fl_alloc(s->n, sizeof *s->of, err);
    if (!s->first_i || !s->first_j || !s->of) return -1;
    for (int32_t k = 0; k < s->n; k++) s->first_i[s->at.i[k] + 1]++, s->first_j[s->at.j[k] + 1]++;
    for (int32_t i = 0; i < w->n; i++) s->first_i[i + 1] += s->first_i[i], s->first_j[i + 1] += s->first_j[i];
    /* filling moves each offset to the start of the next; then all move back by one */
    for (int32_t k = 0; k < s->n; k++) s->of[s->first_j[s->at.j[k]]++] = k;
    for (int32_t i = w->n; i > 0; i--) s->first_j[i] = s->first_j[i - 1];
    s->first_j[0] = 0;
    return 0;
}

/* Adds the springs of bond k to the stiffness of one of its bodies, unless that is fixed. */
static void add_stiffness(const fl_world *w, int32_t k, int is_i, double share, fl_stiffness *out)
{
    const fl_disc_list *s = &w->discs;
    const fl_disc_class *c = &s->classes[s->at.which[k]];
    const int32_t body = is_i ? s->at.i[k] : s->at.j[k];
    const fl_vec3 d = fl_disc_list_separation(w, k), n = v3_unit(d), none = v3(0, 0, 0);
    const fl_vec3 r = v3_scale(is_i ? c->share : c->share - 1.0, d), e = v3_normal_to(n), f = v3_cross(n, e);
    const double ks = c->shear_ratio * c->kn, r2 = c->radius * c->radius;
    if (w->b.fixed_dof[body] == ALL_FIXED) return;
    fl_stiffness_add_force(out, &w->b, body, share * c->kn, n, none);
    fl_stiffness_add_tangential(out, &w->b, body, share * ks, n, r);
    fl_stiffness_add_force(out, &w->b, body, share * 0.25 * r2 * c->kn, none, e);
    fl_stiffness_add_force(out, &w->b, body, share * 0.25 * r2 * c->kn, none, f);
    fl_stiffness_add_force(out, &w->b, body, share * 0.5 * r2 * ks, none, n);
}

/* Shares of omega^2 as for contacts: K + sqrt(K K') of the two bodies' own bounds. */
static int bound_stiffness(fl_world *w, fl_err *err)
{
    fl_disc_list *s = &w->discs;
    fl_stiffness *all = fl_alloc(w->n, sizeof *all, err);
    s->omega2 = fl_alloc(2 * (int64_t)s->n, sizeof *s->omega2, err);
    s->max_omega2 = fl_alloc(w->n, sizeof *s->max_omega2, err);
    if (!all || !s->omega2 || !s->max_omega2) {
        free(all);
        return -1;
    }
    for (int32_t k = 0; k < s->n; k++) {
        double own[2];
        for (int e = 0; e < 2; e++) {
            fl_stiffness K = {0};
            add_stiffness(w, k, e == 0, 1.0, &K);
            own[e] = fl_stiffness_bound(&K);
        }
        for (int e = 0; e < 2; e++) {
            s->omega2[2 * k + e] = own[e] + sqrt(own[0] * own[1]);
            if (own[e] > 0.0)
                add_stiffness(w, k, e == 0, s->omega2[2 * k + e] / own[e], &all[e ? s->at.j[k] : s->at.i[k]]);
        }
    }
    for (int32_t i = 0; i < w->n; i++) s->max_omega2[i] = fl_stiffness_bound(&all[i]);
    free(all);
    return 0;
}

int fl_disc_list_make(fl_world *w, const fl_ice_field *field, fl_err *err)
{
    const fl_scene_bond *b = &w->scene->bond;
    fl_disc_list *s = &w->discs;
    int64_t n = 0;
    if (!b->head.present || !b->on) return 0;
    for (int32_t k = 0; k < field->bonds; k++) n += fl_disc_list_includes(w, &field->bond[k]);
    if (n == 0) return 0;
    s->law = (fl_disc_law){.tension = b->normal_strength,
                           .cohesion = b->shear_strength,
                           .internal_friction = b->internal_friction >= 0.0 ? b->internal_friction : 0.0,
                           .friction = b->friction,
                           .moment_factor = b->moment_factor};
    if (alloc_arrays(w, n, err)) return -1;
    for (int32_t k = 0; k < field->bonds; k++)
        if (fl_disc_list_includes(w, &field->bond[k]) && add_disc(w, &field->bond[k], err)) return -1;
    return index_discs(w, err) || bound_stiffness(w, err) ? -1 : 0;
}

void fl_disc_list_free(fl_disc_list *s)
{
    fl_disc_arrays *a = &s->at;
    for (int e = 0; e < 3; e++)
        free(a->S[e]), free(a->M[e]), free(a->damping_force[e]), free(a->damping_couple[e]);
    free(a->damped), free(a->scatter), free(a->lambda), free(a->dissipated), free(a->friction_loss);
    free(a->i), free(a->j), free(a->is_whole), free(a->which), free(a->out);
    free(s->classes), free(s->shift), free(s->image), free(s->has_ended), free(s->pending), free(s->omega2);
    free(s->max_omega2), free(s->first_i), free(s->first_j), free(s->of), free(s->force_sum);
    *s = (fl_disc_list){0};
}

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

void fl_disc_list_evaluate(fl_world *w, int32_t from, int32_t to, double dt)
{
    fl_disc_list *s = &w->discs;
    double sum = 0.0;
    for (int32_t k = from; k < to; k += FL_LANE_COUNT) {
        uint8_t done[FL_LANE_COUNT];
        sum += fl_disc_batch_force(&s->at, k, &s->law, s->classes, &w->b, s->shift ? s->shift + k : NULL, dt,
                                   done);
        for (int32_t l = 0; l < FL_LANE_COUNT && k + l < to; l++) {
            if (done[l]) continue;
            if (s->has_ended[k + l]) s->at.out[k + l] = (fl_disc_wrench){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
            else sum += evaluate_disc(w, k + l, dt);
        }
    }
    s->force_sum[from / FL_DISC_RUN] = sum;
}

void fl_disc_list_add_forces(const fl_world *w, int32_t k, fl_vec3 *f, fl_vec3 *t)
{
    const fl_disc_list *s = &w->discs;
    if (!s->n || k >= w->n) return;
    fl_vec3 F = *f, T = *t;
    for (int64_t at = s->first_i[k]; at < s->first_i[k + 1]; at++) {
        const fl_disc_wrench *q = &s->at.out[at];
        F = v3_add(F, q->force), T = v3_add(T, q->couple_i);
    }
    for (int64_t at = s->first_j[k]; at < s->first_j[k + 1]; at++) {
        const fl_disc_wrench *q = &s->at.out[s->of[at]];
        F = v3_sub(F, q->force), T = v3_add(T, q->couple_j);
    }
    *f = F, *t = T;
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

void fl_disc_list_end_absent(fl_world *w)
{
    fl_disc_list *s = &w->discs;
    for (int32_t k = 0; k < s->n; k++) {
        if (s->has_ended[k] || !(fl_body_absent(w, s->at.i[k]) || fl_body_absent(w, s->at.j[k]))) continue;
        s->has_ended[k] = FL_DISC_ENDED; /* its stored energy leaves with the sphere */
        s->at.is_whole[k] = 0;
        s->at.out[k] = (fl_disc_wrench){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    }
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
    fl_disc_energies sum = {0};
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
