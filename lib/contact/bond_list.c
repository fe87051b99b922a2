/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "bond/bond_batch.h"
#include "bond/common_face.h"
#include "contact/bond_image.h"
#include "contact/bond_list.h"
#include "contact/bond_stiffness.h"
#include "contact/disc_setup.h"
#include "contact/joint_list.h"
#include "geom/clip.h"
#include "world/access.h"

/* Least length of a bond over the size of its face. */
#define MIN_LENGTH 1e-6

/* All six degrees of freedom fixed. */
enum { ALL_FIXED = 63 };

/* --- set-up ------------------------------------------------------------------------------------ */

/* Offset of the image of j [m]. */
static fl_vec3 image_offset(const fl_world *w, int32_t k)
{
    const int32_t *image = &w->bonds.image[3 * k];
    return w->cell.periodic ? fl_periodic_cell_offset(&w->cell, v3(image[0], image[1], image[2]))
                            : v3(0, 0, 0);
}

/* The sharp shape of body k of the field; empty if its core has no faces. */
static int make_sharp_shape(const fl_ice_field *field, int32_t k, fl_poly *out, fl_err *err)
{
    fl_err why = {0};
    if (field->core[k].nf == 0) return 0;
    const int bad = field->radius[k] > 0.0 ? fl_poly_offset(out, &field->core[k], field->radius[k], &why)
                                           : fl_poly_copy(out, &field->core[k], &why);
    if (!bad || why.code != FL_SYSTEM) return 0; /* without a sharp shape it has no common face */
    *err = why;
    return -1;
}

/* Factor of a strength that keeps a bond longer than the limit from snapping back. */
static double strength_factor(double limit, double length)
{
    return length > limit ? sqrt(limit / length) : 1.0;
}

/* Sets the law of bond c of the length l and the reduced mass m. */
static void set_law(const fl_world *w, fl_bond *c, double l, double m)
{
    const fl_scene_bond *s = &w->scene->bond;
    const fl_scene_material *A = &w->scene->material[w->material[c->i]],
                            *B = &w->scene->material[w->material[c->j]];
    const double E = s->young > 0.0 ? s->young : 2.0 / (1.0 / A->young + 1.0 / B->young),
                 nu = s->poisson >= 0.0 ? s->poisson : 0.5 * (A->poisson + B->poisson),
                 G = 0.5 * E / (1.0 + nu);
    c->length = l;
    c->kn = E / l;
    c->ks = G / l;
    c->tensile_strength = s->normal_strength;
    c->cohesion = s->shear_strength;
    c->friction = s->friction;
    c->internal_friction = s->internal_friction >= 0.0 ? s->internal_friction : s->friction;
    c->fracture_energy[0] = s->energy;
    c->fracture_energy[1] = s->shear_energy >= 0.0 ? s->shear_energy : s->energy;
    c->mixed_mode_exponent = s->mixing;
    if (s->softening == FL_SOFTENING_STRETCH) c->min_ductility = s->stretch;
    if (s->softening == FL_SOFTENING_WEAKEN) {
        c->tensile_strength *=
            strength_factor(fl_bond_max_length(E, c->fracture_energy[0], c->tensile_strength), l);
        c->cohesion *= strength_factor(fl_bond_max_length(G, c->fracture_energy[1], c->cohesion), l);
    }
    c->damping = 2.0 * s->damping / sqrt(c->kn * c->area / m);
}

/* Makes bond k from the record d; shape[]: the sharp shapes of the field. */
static int make_bond(fl_world *w, int32_t k, const fl_ice_field_bond *d, const fl_poly *shape, fl_err *err)
{
    const fl_bodies *b = &w->b;
    const int32_t i = d->i, j = d->j;
    fl_bond *c = &w->bonds.bond[k];
    fl_common_face face;
    const fl_vec3 ci = fl_bond_cells_between(w, i, d->x),
                  cells = v3_sub(fl_bond_cells_between(w, j, d->x), ci);
    w->bonds.image[3 * k] = (int32_t)cells.x;
    w->bonds.image[3 * k + 1] = (int32_t)cells.y;
    w->bonds.image[3 * k + 2] = (int32_t)cells.z;
    const fl_vec3 offset = image_offset(w, k), x = v3_sub(d->x, fl_periodic_cell_offset(&w->cell, ci));
    const fl_vec3 off = v3_sub(v3_add(b->x[j], offset), b->x[i]);
    *c = (fl_bond){.i = i, .j = j, .area = d->area};
    const int found =
        shape[i].nf && shape[j].nf ? fl_common_face_find(&shape[i], &shape[j], offset, x, &face, err) : 0;
    if (found < 0) return -1;
    if (!found && v3_norm2(off) > 0.0) fl_common_face_disc(d->area, x, v3_unit(off), &face);
    const double l = found || v3_norm2(off) > 0.0 ? v3_dot(face.n, off) : 0.0;
    if (!(l > MIN_LENGTH * sqrt(d->area)))
        return fl_fail(err, FL_INPUT,
                       "%s: the bond of body %d and %d has no length: their centres are %g m apart "
                       "across it",
                       w->scene->ice.file, w->id[i], w->id[j], l);
    set_law(w, c, l, b->m[i] * b->m[j] / (b->m[i] + b->m[j]));
    fl_bond_set_face(c, b, offset, face.x, face.n, face.a, face.b);
    return 0;
}

static int make_all(fl_world *w, const fl_ice_field *field, fl_err *err)
{
    fl_poly *shape = fl_alloc(field->n, sizeof *shape, err);
    int rc = shape ? 0 : -1;
    for (int32_t k = 0, face = 0; k < field->bonds && rc == 0; k++) {
        const int32_t of[2] = {field->bond[k].i, field->bond[k].j};
        if (fl_disc_list_includes(w, &field->bond[k])) continue;
        for (int e = 0; e < 2 && rc == 0; e++)
            if (shape[of[e]].nv == 0) rc = make_sharp_shape(field, of[e], &shape[of[e]], err);
        if (rc == 0) rc = make_bond(w, face++, &field->bond[k], shape, err);
    }
    for (int32_t k = 0; shape && k < field->n; k++) fl_poly_free(&shape[k]);
    free(shape);
    return rc;
}

/* The bonds of each body, in their order. */
static int index_bonds(fl_world *w, fl_err *err)
{
    fl_bond_list *s = &w->bonds;
    s->first = fl_alloc((int64_t)w->n + 1, sizeof *s->first, err);
    s->of = fl_alloc(2 * (int64_t)s->n, sizeof *s->of, err);
    if (!s->first || !s->of) return -1;
    for (int32_t k = 0; k < s->n; k++) s->first[s->bond[k].i + 1]++, s->first[s->bond[k].j + 1]++;
    for (int32_t i = 0; i < w->n; i++) s->first[i + 1] += s->first[i];
    /* filling moves each offset to the start of the next; then all move back by one */
    for (int32_t k = 0; k < s->n; k++) {
        s->of[s->first[s->bond[k].i]++] = k;
        s->of[s->first[s->bond[k].j]++] = k;
    }
    for (int32_t i = w->n; i > 0; i--) s->first[i] = s->first[i - 1];
    s->first[0] = 0;
    return 0;
}

/* Springs of a bond, none for a fixed body: bond_stiffness.h. */
static int32_t add_springs(const fl_world *w, int32_t bond, int end, double share, fl_stiffness *out)
{
    const fl_bodies *b = &w->b;
    const fl_bond *c = &w->bonds.bond[bond];
    const int is_i = end == 0;
    const int32_t k = is_i ? c->i : c->j;
    const fl_mat3 R = fl_body_axes(b, k);
    const fl_vec3 n = m3_mul(R, is_i ? c->ni : c->nj);
    const int32_t other = is_i ? c->j : c->i;
    /* light nodes on the other side: no bound by the reduced mass */
    const double stiffer = w->zones.block_of && w->zones.block_of[other] >= 0 ? 2.0 : 1.0,
                 area = stiffer * fl_joint_list_most_area(w, bond);
    if (b->fixed_dof[k] == ALL_FIXED) return k;
    for (int at = 0; at < FL_BOND_POINTS; at++) {
        double xi, eta;
        const double wa = share * fl_bond_quadrature_point(at, &xi, &eta) * area;
        const fl_vec3 p = v3_madd(v3_madd(is_i ? c->pi : c->pj, xi, is_i ? c->ai : c->aj), eta,
                                  is_i ? c->bi : c->bj),
                      r = m3_mul(R, p);
        fl_stiffness_add_force(out, b, k, wa * c->kn, n, v3_cross(r, n));
        fl_stiffness_add_tangential(out, b, k, wa * c->ks, n, r);
    }
    return k;
}

/* Bonded faces that [bond] makes; -1. */
static int32_t count_faces(fl_world *w, const fl_ice_field *field, fl_err *err)
{
    if (!w->scene->bond.head.present || !w->scene->bond.on) return 0;
    if (field->bonds == 0)
        return fl_fail(err, FL_INPUT,
                       "%s: no bond in it, and [bond] is on: a field of voronoi-ice --bonded is expected",
                       w->scene->ice.file);
    if (fl_disc_list_make(w, field, err)) return -1;
    return field->bonds - w->discs.n;
}

int fl_bond_list_make(fl_world *w, const fl_ice_field *field, fl_err *err)
{
    fl_bond_list *s = &w->bonds;
    const int32_t faces = count_faces(w, field, err), n = faces + fl_joint_list_count(w, field);
    if (faces < 0) return -1;
    if (n == 0) return 0;
    s->bond = fl_alloc(n, sizeof *s->bond, err);
    s->image = fl_alloc(3 * (int64_t)n, sizeof *s->image, err);
    s->radius_factor = fl_alloc(n, sizeof *s->radius_factor, err);
    if (!s->bond || !s->image || !s->radius_factor || (faces && make_all(w, field, err))) return -1;
    s->faces = faces;
    if (n > faces && fl_joint_list_make(w, field, err)) return -1;
    s->n = n;
    for (int32_t k = 0; k < s->n; k++) {
        const int32_t of[2] = {s->bond[k].i, s->bond[k].j};
        for (int e = 0; e < 2; e++) w->b.is_isotropic[of[e]] = 0;
    }
    return index_bonds(w, err) ||
                   fl_bond_stiffness_bound(w, s->n, add_springs, &s->omega2, &s->max_omega2, err)
               ? -1
               : 0;
}

void fl_bond_list_free(fl_bond_list *s)
{
    free(s->bond), free(s->image), free(s->radius_factor), free(s->omega2), free(s->max_omega2),
        free(s->first), free(s->of);
    fl_joint_list_free(s);
    *s = (fl_bond_list){0};
}

/* --- pairs of ended bonds ---------------------------------------------------------------------- */

int32_t fl_bond_list_find(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    const fl_bond_list *s = &w->bonds;
    if (i >= w->n || j >= w->n || !s->n) return -1;
    for (int64_t c = s->first[i]; c < s->first[i + 1]; c++) {
        const int32_t k = s->of[c];
        if (s->bond[k].j == j && s->bond[k].i == i && memcmp(&s->image[3 * k], image, 3 * sizeof *image) == 0)
            return k;
    }
    return -1;
}

void fl_bond_list_init_pair(const fl_world *w, fl_pair *p)
{
    const int32_t k = w->bonds.n ? fl_bond_list_find(w, p->i, p->j, p->image) : -1;
    if (k < 0) return;
    p->bond = k + 1;
    p->radius_factor = w->bonds.radius_factor[k];
}

void fl_bond_list_restore_radii(fl_world *w, fl_pair *p, double R, double distance)
{
    const double factor = R > 0.0 ? distance / R : 1.0;
    if (factor > p->radius_factor) {
        p->radius_factor = factor < 1.0 ? factor : 1.0;
        if (p->feature_pairs)
            fl_feature_pairs_forget(p->feature_pairs); /* the listed features depend on the radii */
        if (p->quick_list) p->quick_list->max_shift2 = 0.0;
    }
    w->bonds.radius_factor[p->bond - 1] = p->radius_factor;
}

void fl_bond_list_first_contact(fl_world *w, fl_pair *p)
{
    w->bonds.bond[p->bond - 1].dissipated -= p->energy;
}

/* --- in a step --------------------------------------------------------------------------------- */

static void evaluate_bond(fl_world *w, int32_t k)
{
    fl_bond *c = &w->bonds.bond[k];
    if (c->state == FL_BOND_ENDED) return;
    if (!(fl_joint_of_bond(&w->bonds, k) ? fl_joint_list_force(w, k, image_offset(w, k))
                                         : fl_bond_force(c, &w->b, image_offset(w, k))))
        return;
#pragma omp atomic write
    w->bonds.ended = 1;
}

/* Evaluates n intact bonds in a batch. */
static void evaluate_intact(fl_world *w, const int32_t *at, int n)
{
    fl_bond *c[FL_LANE_COUNT] = {0};
    fl_vec3 offset[FL_LANE_COUNT] = {0};
    uint8_t done[FL_LANE_COUNT];
    if (n == 0) return;
    for (int k = 0; k < n; k++) c[k] = &w->bonds.bond[at[k]], offset[k] = image_offset(w, at[k]);
    fl_bond_batch_force(c, offset, n, &w->b, done);
    for (int k = 0; k < n; k++)
        if (!done[k]) evaluate_bond(w, at[k]);
}

void fl_bond_list_evaluate(fl_world *w, int32_t from, int32_t to)
{
    int32_t intact[FL_LANE_COUNT];
    int n = 0;
    for (int32_t k = from; k < to; k++) {
        const fl_bond *c = &w->bonds.bond[k];
        if (k + FL_LANE_COUNT < w->bonds.n) fl_prefetch(c + FL_LANE_COUNT, offsetof(fl_bond, force_friction));
        if (c->state == FL_BOND_INTACT && c->wear == 0.0 && !fl_joint_of_bond(&w->bonds, k)) intact[n++] = k;
        else evaluate_bond(w, k);
        if (n == FL_LANE_COUNT) evaluate_intact(w, intact, n), n = 0;
    }
    evaluate_intact(w, intact, n);
}

static void add_sums(fl_contact_sum *sums, const fl_bond *c, int is_i)
{
    const double sign = is_i ? 1.0 : -1.0;
    if (c->damping == 0.0 && c->state == FL_BOND_INTACT) return;
    sums->contacts++;
    sums->damping = v3_madd(sums->damping, sign, c->force_damping);
    sums->damping_torque = v3_add(sums->damping_torque, is_i ? c->torque_i_damping : c->torque_j_damping);
    sums->friction = v3_madd(sums->friction, sign, c->force_friction);
    sums->friction_torque = v3_add(sums->friction_torque, is_i ? c->torque_i_friction : c->torque_j_friction);
}

void fl_bond_list_add_forces(const fl_world *w, int32_t k, fl_vec3 *f, fl_vec3 *t, fl_contact_sum *sums)
{
    const fl_bond_list *s = &w->bonds;
    fl_disc_list_add_forces(w, k, f, t);
    if (!fl_body_has_faces(w, k)) return;
    for (int64_t at = s->first[k]; at < s->first[k + 1]; at++) {
        const fl_bond *c = &s->bond[s->of[at]];
        if (c->state == FL_BOND_ENDED) continue;
        *f = v3_madd(*f, c->i == k ? 1.0 : -1.0, c->force);
        *t = v3_add(*t, c->i == k ? c->torque_i : c->torque_j);
        add_sums(sums, c, c->i == k);
    }
}

void fl_bond_list_add_sums(const fl_world *w, int32_t k, fl_contact_sum *sums)
{
    const fl_bond_list *s = &w->bonds;
    if (!fl_body_has_faces(w, k)) return;
    for (int64_t at = s->first[k]; at < s->first[k + 1]; at++) {
        const fl_bond *c = &s->bond[s->of[at]];
        if (c->state != FL_BOND_ENDED) add_sums(sums, c, c->i == k);
    }
}

double fl_bond_list_max_omega2(const fl_world *w, int32_t k)
{
    return (fl_body_has_faces(w, k) ? w->bonds.max_omega2[k] : 0.0) + fl_disc_list_max_omega2(w, k);
}

double fl_bond_list_omega2(const fl_world *w, int32_t k)
{
    const fl_bond_list *s = &w->bonds;
    double sum = 0.0;
    if (!fl_body_has_faces(w, k)) return fl_disc_list_omega2(w, k);
    for (int64_t at = s->first[k]; at < s->first[k + 1]; at++) {
        const fl_bond *c = &s->bond[s->of[at]];
        if (c->state != FL_BOND_ENDED) sum += s->omega2[2 * s->of[at] + (c->i != k)];
    }
    return (sum < s->max_omega2[k] ? sum : s->max_omega2[k]) + fl_disc_list_omega2(w, k);
}

void fl_bond_list_end_absent(fl_world *w)
{
    fl_disc_list_end_absent(w);
    for (int32_t k = 0; k < w->bonds.n; k++) {
        fl_bond *c = &w->bonds.bond[k];
        if (c->state == FL_BOND_ENDED || !(fl_body_absent(w, c->i) || fl_body_absent(w, c->j))) continue;
        const double spent = c->dissipated;
        fl_bond_end(c); /* its stored energy leaves with the floe */
        c->dissipated = spent;
    }
}

void fl_bond_list_refresh(fl_world *w)
{
    for (int32_t k = 0; k < w->bonds.n; k++)
        fl_bond_update_separation(&w->bonds.bond[k], &w->b, image_offset(w, k));
}

fl_bond_load fl_bond_list_load(const fl_world *w, int32_t k)
{
    fl_bond_load out = fl_bond_section_load(&w->bonds.bond[k], &w->b, image_offset(w, k));
    out.x = fl_periodic_cell_wrap(&w->cell, out.x);
    return out;
}

fl_bond_energies fl_bond_list_energies(const fl_world *w)
{
    fl_bond_energies sum = {0};
    for (int32_t k = 0; k < w->bonds.n; k++) {
        const fl_bond *c = &w->bonds.bond[k];
        sum.store += c->elastic_energy + c->friction_spring_energy;
        sum.spring += c->friction_spring_energy;
        sum.dissipated += c->dissipated;
        sum.transferred += c->given_to_friction;
    }
    const fl_disc_energies discs = fl_disc_list_energies(w);
    sum.store += discs.store, sum.dissipated += discs.dissipated;
    sum.damped = discs.damped, sum.friction_loss = discs.friction_loss + fl_joint_list_friction_loss(w);
    return sum;
}

/* Adds the discs. */
static void count_discs(const fl_world *w, fl_bond_counts *n, double *area)
{
    const fl_disc_list *s = &w->discs;
    const double G = w->scene->bond.energy;
    n->state[FL_BOND_ENDED] += s->past.broken, n->left += s->past.left;
    n->area += s->past.area;
    for (int32_t k = 0; k < s->n; k++) {
        const fl_disc_class *c = &s->classes[s->at.which[k]];
        const double A = PI * c->radius * c->radius, T = c->weakening * s->law.tension,
                     peak = 0.5 * T * T * A / c->kn, fracture = fmax(c->ductility, 1.0) * peak;
        const enum fl_bond_state state = s->has_ended[k]     ? FL_BOND_ENDED
                                         : s->at.is_whole[k] ? FL_BOND_INTACT
                                                             : FL_BOND_DAMAGED;
        if (state == FL_BOND_ENDED && !fl_disc_is_broken(c, s->at.lambda[k])) n->left++;
        else n->state[state]++;
        if (state == FL_BOND_ENDED && fl_disc_is_broken(c, s->at.lambda[k])) n->area += A;
        n->longest = fmax(n->longest, c->length);
        if (!isfinite(fracture)) continue;
        n->energy += fracture * A, *area += A;
        if (G > 0.0 && fracture > G * (1.0 + 1e-9)) n->coarse++;
        const double limit = fl_bond_max_length(c->kn * c->length / A, G, T);
        if (n->limit == 0.0 || limit < n->limit) n->limit = limit;
    }
}

fl_bond_counts fl_bond_list_counts(const fl_world *w)
{
    fl_bond_counts n = {0};
    double area = 0.0;
    count_discs(w, &n, &area);
    for (int32_t k = 0; k < w->bonds.faces; k++) {
        const fl_bond *c = &w->bonds.bond[k];
        const double fracture = fl_bond_fracture_energy(c);
        n.state[c->state]++;
        if (isfinite(fracture)) n.energy += fracture * c->area, area += c->area;
        if (c->state >= FL_BOND_BROKEN) n.area += c->area;
        if (isfinite(fracture) && c->fracture_energy[0] > 0.0 &&
            fracture > c->fracture_energy[0] * (1.0 + 1e-9))
            n.coarse++;
        n.longest = fmax(n.longest, c->length);
        if (isinf(c->tensile_strength)) continue; /* it breaks only in shear */
        const double limit =
            fl_bond_max_length(c->kn * c->length, c->fracture_energy[0], c->tensile_strength);
        if (n.limit == 0.0 || limit < n.limit) n.limit = limit;
    }
    if (area > 0.0) n.energy /= area;
    return n;
}
