/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/mem.h"
#include "bond/several.h"
#include "bond/shared.h"
#include "geom/clip.h"
#include "step/frozen.h"
#include "step/stiff.h"
#include "world/access.h"

/* Centres nearer than this of the size of their face, along its normal, have no length between them. */
#define FLAT 1e-6

/* All six directions. */
enum { HELD = 63 };

/* --- which there are --------------------------------------------------------------------------- */

static fl_vec3 way_of(const fl_world *w, int32_t k)
{
    const int32_t *image = &w->frozen.image[3 * k];
    return w->cell.wraps ? fl_cell_way(&w->cell, v3(image[0], image[1], image[2])) : v3(0, 0, 0);
}

static double nearest(double apart, double length) { return length > 0.0 ? round(apart / length) : 0.0; }

/* How many lengths of the cell x is from body i. */
static fl_vec3 cells_to(const fl_world *w, int32_t i, fl_vec3 x)
{
    const fl_vec3 L = w->cell.length, off = v3_sub(x, w->b.x[i]);
    if (!w->cell.wraps) return v3(0, 0, 0);
    return v3(nearest(off.x, L.x), nearest(off.y, L.y), nearest(off.z, L.z));
}

/* The sharp shape of body k of the field; left empty for what is round. */
static int sharp(const fl_field *field, int32_t k, fl_poly *out, fl_err *err)
{
    fl_err why = {0};
    if (field->core[k].nf == 0) return 0;
    const int bad = field->radius[k] > 0.0 ? fl_poly_offset(out, &field->core[k], field->radius[k], &why)
                                           : fl_poly_copy(out, &field->core[k], &why);
    if (!bad || why.code != FL_SYSTEM) return 0; /* a shape that has none has no face in common either */
    *err = why;
    return -1;
}

static double weaker(double limit, double length) { return length > limit ? sqrt(limit / length) : 1.0; }

/* The law of bond c of length l, and reduced mass m. */
static void law_of(const fl_world *w, fl_bond *c, double l, double m)
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
    c->tension = s->normal_strength;
    c->cohesion = s->shear_strength;
    c->friction = s->friction;
    c->energy[0] = s->energy;
    c->energy[1] = s->shear_energy >= 0.0 ? s->shear_energy : s->energy;
    c->mixing = s->mixing;
    if (s->softening == FL_SOFTENING_STRETCH) c->stretch = s->stretch;
    if (s->softening == FL_SOFTENING_WEAKEN) {
        c->tension *= weaker(fl_bond_limit(E, c->energy[0], c->tension), l);
        c->cohesion *= weaker(fl_bond_limit(G, c->energy[1], c->cohesion), l);
    }
    c->damping = 2.0 * s->damping / sqrt(c->kn * c->area / m);
}

/* Bond k from a record; shape[] are the sharp shapes of the field. */
static int make_bond(fl_world *w, int32_t k, const fl_field *field, const fl_poly *shape, fl_err *err)
{
    const fl_field_bond *d = &field->bond[k];
    const fl_bodies *b = &w->b;
    const int32_t i = d->i, j = d->j;
    fl_bond *c = &w->frozen.bond[k];
    fl_shared face;
    const fl_vec3 ci = cells_to(w, i, d->x), cells = v3_sub(cells_to(w, j, d->x), ci);
    w->frozen.image[3 * k] = (int32_t)cells.x;
    w->frozen.image[3 * k + 1] = (int32_t)cells.y;
    w->frozen.image[3 * k + 2] = (int32_t)cells.z;
    const fl_vec3 way = way_of(w, k), x = v3_sub(d->x, fl_cell_way(&w->cell, ci));
    const fl_vec3 off = v3_sub(v3_add(b->x[j], way), b->x[i]);
    *c = (fl_bond){.i = i, .j = j, .area = d->area};
    const int found =
        shape[i].nf && shape[j].nf ? fl_shared_find(&shape[i], &shape[j], way, x, &face, err) : 0;
    if (found < 0) return -1;
    if (!found && v3_norm2(off) > 0.0) fl_shared_disc(d->area, x, v3_unit(off), &face);
    const double l = found || v3_norm2(off) > 0.0 ? v3_dot(face.n, off) : 0.0;
    if (!(l > FLAT * sqrt(d->area)))
        return fl_fail(err, FL_INPUT,
                       "%s: the bond of body %d and %d has no length: their centres are %g m apart "
                       "across it",
                       w->scene->ice.file, w->id[i], w->id[j], l);
    law_of(w, c, l, b->m[i] * b->m[j] / (b->m[i] + b->m[j]));
    fl_bond_place(c, b, way, face.x, face.n, face.a, face.b);
    return 0;
}

static int make_all(fl_world *w, const fl_field *field, fl_err *err)
{
    fl_poly *shape = fl_alloc(field->n, sizeof *shape, err);
    int rc = shape ? 0 : -1;
    for (int32_t k = 0; k < field->bonds && rc == 0; k++) {
        const int32_t of[2] = {field->bond[k].i, field->bond[k].j};
        for (int e = 0; e < 2 && rc == 0; e++)
            if (shape[of[e]].nv == 0) rc = sharp(field, of[e], &shape[of[e]], err);
        if (rc == 0) rc = make_bond(w, k, field, shape, err);
    }
    for (int32_t k = 0; shape && k < field->n; k++) fl_poly_free(&shape[k]);
    free(shape);
    return rc;
}

/* The bonds of each body, in their order. */
static int index_bonds(fl_world *w, fl_err *err)
{
    fl_frozen *s = &w->frozen;
    s->first = fl_alloc((int64_t)w->n + 1, sizeof *s->first, err);
    s->of = fl_alloc(2 * (int64_t)s->n, sizeof *s->of, err);
    if (!s->first || !s->of) return -1;
    for (int32_t k = 0; k < s->n; k++) s->first[s->bond[k].i + 1]++, s->first[s->bond[k].j + 1]++;
    for (int32_t i = 0; i < w->n; i++) s->first[i + 1] += s->first[i];
    /* filled from the front, each offset ends where the next begins; then all go back by one */
    for (int32_t k = 0; k < s->n; k++) {
        s->of[s->first[s->bond[k].i]++] = k;
        s->of[s->first[s->bond[k].j]++] = k;
    }
    for (int32_t i = w->n; i > 0; i--) s->first[i] = s->first[i - 1];
    s->first[0] = 0;
    return 0;
}

/* The springs of bond c, for one of its bodies; none for one that nothing moves. */
static void stiffen(const fl_world *w, const fl_bond *c, int is_i, double share, fl_stiff *out)
{
    const fl_bodies *b = &w->b;
    const int32_t k = is_i ? c->i : c->j;
    const fl_mat3 R = fl_body_axes(b, k);
    const fl_vec3 n = m3_mul(R, is_i ? c->ni : c->nj);
    if (b->hold[k] == HELD) return;
    for (int at = 0; at < FL_BOND_POINTS; at++) {
        double xi, eta;
        const double wa = share * fl_bond_point_at(at, &xi, &eta) * c->area;
        const fl_vec3 p = v3_madd(v3_madd(is_i ? c->pi : c->pj, xi, is_i ? c->ai : c->aj), eta,
                                  is_i ? c->bi : c->bj),
                      r = m3_mul(R, p);
        fl_stiff_add(out, b, k, wa * c->kn, n, v3_cross(r, n));
        fl_stiff_across(out, b, k, wa * c->ks, n, r);
    }
}

/* Shares of omega^2 as step.c has them for contacts: K + sqrt(K K') of the two bodies' own. */
static int measure(fl_world *w, fl_err *err)
{
    fl_frozen *s = &w->frozen;
    fl_stiff *all = fl_alloc(w->n, sizeof *all, err);
    s->stiff = fl_alloc(2 * (int64_t)s->n, sizeof *s->stiff, err);
    s->most = fl_alloc(w->n, sizeof *s->most, err);
    if (!all || !s->stiff || !s->most) {
        free(all);
        return -1;
    }
    for (int32_t k = 0; k < s->n; k++) {
        const fl_bond *c = &s->bond[k];
        double own[2];
        for (int e = 0; e < 2; e++) {
            fl_stiff K = {0};
            stiffen(w, c, e == 0, 1.0, &K);
            own[e] = fl_stiff_bound(&K);
        }
        for (int e = 0; e < 2; e++) {
            s->stiff[2 * k + e] = own[e] + sqrt(own[0] * own[1]);
            if (own[e] > 0.0) stiffen(w, c, e == 0, s->stiff[2 * k + e] / own[e], &all[e ? c->j : c->i]);
        }
    }
    for (int32_t i = 0; i < w->n; i++) s->most[i] = fl_stiff_bound(&all[i]);
    free(all);
    return 0;
}

int fl_frozen_make(fl_world *w, const fl_field *field, fl_err *err)
{
    fl_frozen *s = &w->frozen;
    if (!w->scene->bond.head.present || !w->scene->bond.on) return 0;
    if (field->bonds == 0)
        return fl_fail(err, FL_INPUT,
                       "%s: no bond in it, and [bond] is on: a field of voronoi-ice --bonded was wanted",
                       w->scene->ice.file);
    s->bond = fl_alloc(field->bonds, sizeof *s->bond, err);
    s->image = fl_alloc(3 * (int64_t)field->bonds, sizeof *s->image, err);
    s->keep = fl_alloc(field->bonds, sizeof *s->keep, err);
    if (!s->bond || !s->image || !s->keep || make_all(w, field, err)) return -1;
    s->n = field->bonds;
    for (int32_t k = 0; k < s->n; k++) {
        const int32_t of[2] = {s->bond[k].i, s->bond[k].j};
        for (int e = 0; e < 2; e++) w->b.ball[of[e]] = 0;
    }
    return index_bonds(w, err) || measure(w, err) ? -1 : 0;
}

void fl_frozen_free(fl_frozen *s)
{
    free(s->bond), free(s->image), free(s->keep), free(s->stiff), free(s->most), free(s->first), free(s->of);
    *s = (fl_frozen){0};
}

/* --- the pairs they leave ---------------------------------------------------------------------- */

int32_t fl_frozen_find(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    const fl_frozen *s = &w->frozen;
    if (i >= w->n || j >= w->n) return -1;
    for (int64_t c = s->first[i]; c < s->first[i + 1]; c++) {
        const int32_t k = s->of[c];
        if (s->bond[k].j == j && s->bond[k].i == i && memcmp(&s->image[3 * k], image, 3 * sizeof *image) == 0)
            return k;
    }
    return -1;
}

void fl_frozen_enter(const fl_world *w, fl_pair *p)
{
    const int32_t k = w->frozen.n ? fl_frozen_find(w, p->i, p->j, p->image) : -1;
    if (k < 0) return;
    p->bond = k + 1;
    p->keep = w->frozen.keep[k];
}

void fl_frozen_return(fl_world *w, fl_pair *p, double R, double distance)
{
    const double keep = R > 0.0 ? distance / R : 1.0;
    if (keep > p->keep) {
        p->keep = keep < 1.0 ? keep : 1.0;
        if (p->matches) p->matches->shift2 = 0.0; /* what is listed knows the radii */
    }
    w->frozen.keep[p->bond - 1] = p->keep;
}

void fl_frozen_meet(fl_world *w, fl_pair *p) { w->frozen.bond[p->bond - 1].spent -= p->energy; }

/* --- in a step --------------------------------------------------------------------------------- */

static void touch_one(fl_world *w, int32_t k)
{
    fl_bond *c = &w->frozen.bond[k];
    if (c->state == FL_BOND_ENDED || !fl_bond_force(c, &w->b, way_of(w, k))) return;
#pragma omp atomic write
    w->frozen.ended = 1;
}

/* Those that are whole, side by side. */
static void touch_whole(fl_world *w, const int32_t *at, int n)
{
    fl_bond *c[FL_ABREAST] = {0};
    fl_vec3 way[FL_ABREAST] = {0};
    uint8_t done[FL_ABREAST];
    if (n == 0) return;
    for (int k = 0; k < n; k++) c[k] = &w->frozen.bond[at[k]], way[k] = way_of(w, at[k]);
    fl_bond_several(c, way, n, &w->b, done);
    for (int k = 0; k < n; k++)
        if (!done[k]) touch_one(w, at[k]);
}

void fl_frozen_touch(fl_world *w, int32_t from, int32_t to)
{
    int32_t whole[FL_ABREAST];
    int n = 0;
    for (int32_t k = from; k < to; k++) {
        const fl_bond *c = &w->frozen.bond[k];
        if (k + FL_ABREAST < w->frozen.n) fl_fetch(c + FL_ABREAST, offsetof(fl_bond, fs));
        if (c->state == FL_BOND_WHOLE && c->worn == 0.0) whole[n++] = k;
        else touch_one(w, k);
        if (n == FL_ABREAST) touch_whole(w, whole, n), n = 0;
    }
    touch_whole(w, whole, n);
}

static void add_sink(fl_sink *sink, const fl_bond *c, int is_i)
{
    const double sign = is_i ? 1.0 : -1.0;
    if (c->damping == 0.0 && c->state == FL_BOND_WHOLE) return;
    sink->n++;
    sink->damping = v3_madd(sink->damping, sign, c->fd);
    sink->damping_turn = v3_add(sink->damping_turn, is_i ? c->di : c->dj);
    sink->friction = v3_madd(sink->friction, sign, c->fs);
    sink->friction_turn = v3_add(sink->friction_turn, is_i ? c->si : c->sj);
}

void fl_frozen_press(const fl_world *w, int32_t k, fl_vec3 *f, fl_vec3 *t, fl_sink *sink)
{
    const fl_frozen *s = &w->frozen;
    for (int64_t at = s->first[k]; at < s->first[k + 1]; at++) {
        const fl_bond *c = &s->bond[s->of[at]];
        if (c->state == FL_BOND_ENDED) continue;
        *f = v3_madd(*f, c->i == k ? 1.0 : -1.0, c->f);
        *t = v3_add(*t, c->i == k ? c->ti : c->tj);
        add_sink(sink, c, c->i == k);
    }
}

void fl_frozen_sink(const fl_world *w, int32_t k, fl_sink *sink)
{
    const fl_frozen *s = &w->frozen;
    for (int64_t at = s->first[k]; at < s->first[k + 1]; at++) {
        const fl_bond *c = &s->bond[s->of[at]];
        if (c->state != FL_BOND_ENDED) add_sink(sink, c, c->i == k);
    }
}

double fl_frozen_most(const fl_world *w, int32_t k) { return fl_frozen_at(w, k) ? w->frozen.most[k] : 0.0; }

double fl_frozen_now(const fl_world *w, int32_t k)
{
    const fl_frozen *s = &w->frozen;
    double sum = 0.0;
    if (!fl_frozen_at(w, k)) return 0.0;
    for (int64_t at = s->first[k]; at < s->first[k + 1]; at++) {
        const fl_bond *c = &s->bond[s->of[at]];
        if (c->state != FL_BOND_ENDED) sum += s->stiff[2 * s->of[at] + (c->i != k)];
    }
    return sum < s->most[k] ? sum : s->most[k];
}

void fl_frozen_drop(fl_world *w)
{
    for (int32_t k = 0; k < w->frozen.n; k++) {
        fl_bond *c = &w->frozen.bond[k];
        if (c->state == FL_BOND_ENDED || !(fl_world_away(w, c->i) || fl_world_away(w, c->j))) continue;
        const double spent = c->spent;
        fl_bond_end(c); /* what it held goes with the floe */
        c->spent = spent;
    }
}

void fl_frozen_look(fl_world *w)
{
    for (int32_t k = 0; k < w->frozen.n; k++) fl_bond_look(&w->frozen.bond[k], &w->b, way_of(w, k));
}

fl_bond_load fl_frozen_load(const fl_world *w, int32_t k)
{
    fl_bond_load out = fl_bond_loaded(&w->frozen.bond[k], &w->b, way_of(w, k));
    out.x = fl_cell_inside(&w->cell, out.x);
    return out;
}

fl_frozen_books fl_frozen_ledger(const fl_world *w)
{
    fl_frozen_books sum = {0};
    for (int32_t k = 0; k < w->frozen.n; k++) {
        const fl_bond *c = &w->frozen.bond[k];
        sum.store += c->store + c->spring;
        sum.spring += c->spring;
        sum.spent += c->spent;
        sum.handed += c->handed;
    }
    return sum;
}

fl_frozen_count fl_frozen_counted(const fl_world *w)
{
    fl_frozen_count n = {0};
    double area = 0.0;
    for (int32_t k = 0; k < w->frozen.n; k++) {
        const fl_bond *c = &w->frozen.bond[k];
        const double takes = fl_bond_energy(c);
        n.state[c->state]++;
        if (isfinite(takes)) n.energy += takes * c->area, area += c->area;
        if (c->state >= FL_BOND_BROKEN) n.area += c->area;
        if (isfinite(takes) && c->energy[0] > 0.0 && takes > c->energy[0] * (1.0 + 1e-9)) n.coarse++;
        n.longest = fmax(n.longest, c->length);
        if (isinf(c->tension)) continue; /* it breaks in shear alone */
        const double limit = fl_bond_limit(c->kn * c->length, c->energy[0], c->tension);
        if (n.limit == 0.0 || limit < n.limit) n.limit = limit;
    }
    if (area > 0.0) n.energy /= area;
    return n;
}
