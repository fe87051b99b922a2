/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/disc_setup.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "contact/bond_image.h"
#include "contact/bond_stiffness.h"
#include "contact/disc_list.h"
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

/* Class of a bond of i and j, apart at its start. */
static fl_disc_class class_of(const fl_world *w, int32_t i, int32_t j, double apart)
{
    const fl_scene_bond *s = &w->scene->bond;
    const fl_bodies *b = &w->b;
    const fl_scene_material *A = &w->scene->material[w->material[i]],
                            *B = &w->scene->material[w->material[j]];
    const double ri = b->radius[i], rj = b->radius[j],
                 E = s->young > 0.0 ? s->young : 2.0 / (1.0 / A->young + 1.0 / B->young),
                 nu = s->poisson >= 0.0 ? s->poisson : 0.5 * (A->poisson + B->poisson),
                 m = b->m[i] * b->m[j] / (b->m[i] + b->m[j]);
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

/* Fills bond k of two ids, with the image of j, `length` long at its start. */
static int set_disc(fl_world *w, int32_t k, const fl_disc_birth *d, fl_err *err)
{
    fl_disc_list *s = &w->discs;
    const fl_disc_class c = class_of(w, d->i, d->j, d->length);
    const int32_t which = find_class(s, &c, err);
    if (which < 0) return -1;
    s->at.i[k] = d->i, s->at.j[k] = d->j;
    s->at.which[k] = (uint16_t)which;
    s->at.is_whole[k] = 1;
    if (s->at.scatter) s->at.scatter[k] = scatter_of(&w->scene->bond, w->id[d->i], w->id[d->j]);
    if (!s->image) return 0;
    for (int e = 0; e < 3; e++) s->image[3 * k + e] = d->image[e];
    s->shift[k] = fl_periodic_cell_offset(&w->cell, v3(d->image[0], d->image[1], d->image[2]));
    return 0;
}

static int add_disc(fl_world *w, const fl_ice_field_bond *d, fl_err *err)
{
    const fl_vec3 cells = fl_bond_image_of(w, d->i, d->j, d->x);
    const fl_disc_birth birth = {.i = d->i,
                                 .j = d->j,
                                 .length = v3_norm(field_separation(w, d)),
                                 .image = {(int32_t)cells.x, (int32_t)cells.y, (int32_t)cells.z}};
    if (!(birth.length > 0.0))
        return fl_fail(err, FL_INPUT, "%s: the bond of body %d and %d has no length: their centres coincide",
                       w->scene->ice.file, w->id[d->i], w->id[d->j]);
    if (set_disc(w, w->discs.n, &birth, err)) return -1;
    w->discs.n++;
    return 0;
}

/* The bonds of each body. */
static int index_discs(fl_world *w, fl_err *err)
{
    fl_disc_list *s = &w->discs;
    free(s->first_i), free(s->first_j), free(s->of);
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

/* Springs of bond k, none for a fixed body: bond_stiffness.h. */
static int32_t add_springs(const fl_world *w, int32_t k, int end, double share, fl_stiffness *out)
{
    const fl_disc_list *s = &w->discs;
    const fl_disc_class *c = &s->classes[s->at.which[k]];
    const int32_t body = end == 0 ? s->at.i[k] : s->at.j[k];
    const fl_vec3 d = fl_disc_list_separation(w, k), n = v3_unit(d), none = v3(0, 0, 0);
    const fl_vec3 r = v3_scale(end == 0 ? c->share : c->share - 1.0, d), e = v3_normal_to(n),
                  f = v3_cross(n, e);
    const double ks = c->shear_ratio * c->kn, r2 = c->radius * c->radius;
    if (w->b.fixed_dof[body] == ALL_FIXED) return body;
    fl_stiffness_add_force(out, &w->b, body, share * c->kn, n, none);
    fl_stiffness_add_tangential(out, &w->b, body, share * ks, n, r);
    fl_stiffness_add_force(out, &w->b, body, share * 0.25 * r2 * c->kn, none, e);
    fl_stiffness_add_force(out, &w->b, body, share * 0.25 * r2 * c->kn, none, f);
    fl_stiffness_add_force(out, &w->b, body, share * 0.5 * r2 * ks, none, n);
    return body;
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
    if (index_discs(w, err) || fl_bond_stiffness_bound(w, s->n, add_springs, &s->omega2, &s->max_omega2, err))
        return -1;
    for (int64_t k = 0; k < 2 * (int64_t)s->n; k++) s->largest_omega2 = fmax(s->largest_omega2, s->omega2[k]);
    for (int32_t i = 0; i < w->n; i++) s->largest_max_omega2 = fmax(s->largest_max_omega2, s->max_omega2[i]);
    return 0;
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

/* --- bonds that come and go -------------------------------------------------------------------- */

/* A bond of the list to be made: the old one at `from`, or a new one (-1). */
typedef struct {
    fl_disc_birth birth;
    int32_t from;
} next_disc;

static int compare_next(const void *a, const void *b)
{
    const fl_disc_birth *p = &((const next_disc *)a)->birth, *q = &((const next_disc *)b)->birth;
    if (p->i != q->i) return p->i < q->i ? -1 : 1;
    if (p->j != q->j) return p->j < q->j ? -1 : 1;
    for (int e = 0; e < 3; e++)
        if (p->image[e] != q->image[e]) return p->image[e] < q->image[e] ? -1 : 1;
    return 0;
}

/* Makes all arrays of n bonds anew: memory and forces of the old ones stay with them. */
static int replace_discs(fl_world *w, const next_disc *next, int32_t n, fl_err *err)
{
    fl_disc_list old = w->discs, *s = &w->discs;
    int rc = 0;
    *s = (fl_disc_list){.law = old.law,
                        .classes = old.classes,
                        .n_class = old.n_class,
                        .class_cap = old.class_cap,
                        .largest_omega2 = old.largest_omega2,
                        .largest_max_omega2 = old.largest_max_omega2,
                        .past = old.past,
                        .is_renewed = 1};
    old.classes = NULL;
    s->omega2 = fl_alloc(2 * (int64_t)n, sizeof *s->omega2, err);
    s->max_omega2 = fl_alloc(w->n, sizeof *s->max_omega2, err);
    if (!s->omega2 || !s->max_omega2 || alloc_arrays(w, n, err)) rc = -1;
    for (int32_t k = 0; k < n && rc == 0; k++) {
        const int32_t from = next[k].from;
        rc = set_disc(w, k, &next[k].birth, err);
        if (rc || from < 0) continue;
        const fl_disc_memory m = fl_disc_list_memory(&old, from);
        s->has_ended[k] = old.has_ended[from];
        fl_disc_list_set_memory(s, k, &m);
        s->at.out[k] = old.at.out[from];
        s->pending[k] = old.pending[from];
        s->ended += s->has_ended[k] == FL_DISC_JUST_ENDED;
    }
    /* one bound for all: a place has had other spheres, whose bonds lay otherwise */
    for (int64_t k = 0; k < 2 * (int64_t)n && rc == 0; k++) s->omega2[k] = s->largest_omega2;
    for (int32_t i = 0; i < w->n && rc == 0; i++) s->max_omega2[i] = s->largest_max_omega2;
    s->n = rc ? 0 : n;
    fl_disc_list_free(&old);
    return rc || index_discs(w, err) ? -1 : 0;
}

fl_disc_birth fl_disc_list_birth(const fl_disc_list *s, int32_t k)
{
    fl_disc_birth d = {.i = s->at.i[k], .j = s->at.j[k], .length = s->classes[s->at.which[k]].length};
    for (int e = 0; e < 3 && s->image; e++) d.image[e] = s->image[3 * k + e];
    return d;
}

/* Keeps the sums of bond k, which is removed. */
static void remember_disc(fl_disc_list *s, int32_t k)
{
    const fl_disc_memory m = fl_disc_list_memory(s, k);
    const fl_disc_class *c = &s->classes[s->at.which[k]];
    fl_disc_past *p = &s->past;
    const int broken = fl_disc_is_broken(c, m.lambda);
    p->broken += broken, p->left += !broken;
    if (broken) p->area += PI * c->radius * c->radius;
    p->dissipated += m.dissipated, p->damped += m.damped, p->friction_loss += m.friction_loss;
}

int fl_disc_list_renew(fl_world *w, const fl_disc_birth *birth, int32_t births, fl_err *err)
{
    fl_disc_list *s = &w->discs;
    next_disc *next = fl_alloc((int64_t)s->n + births, sizeof *next, err);
    int32_t n = 0;
    if (!next) return -1;
    for (int32_t k = 0; k < s->n; k++) {
        if (fl_body_absent(w, s->at.i[k]) || fl_body_absent(w, s->at.j[k])) remember_disc(s, k);
        else next[n++] = (next_disc){fl_disc_list_birth(s, k), k};
    }
    for (int32_t k = 0; k < births; k++) next[n++] = (next_disc){birth[k], -1};
    qsort(next, (size_t)n, sizeof *next, compare_next);
    const int rc = replace_discs(w, next, n, err);
    free(next);
    return rc;
}

int fl_disc_list_restore(fl_world *w, const fl_disc_birth *birth, int32_t n, fl_err *err)
{
    next_disc *next = fl_alloc(n, sizeof *next, err);
    if (!next) return -1;
    for (int32_t k = 0; k < n; k++) next[k] = (next_disc){birth[k], -1};
    const int rc = replace_discs(w, next, n, err);
    free(next);
    return rc;
}
