/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/crushing.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/fast_math.h"
#include "contact/pair_kinematics.h"
#include "contact/pair_law.h"
#include "failure/area_vector.h"
#include "world/access.h"

/* Bounds of the local exponent m: 2 is a face, 3 an edge, 4 a corner. */
#define LEAST_EXPONENT 1.5
#define MOST_EXPONENT 6.0
/* An edge is flattened from this share of y on, where it stores more than a flat by this share. */
#define FLATTENED 0.1
#define SAME_ENERGY 0.01
/* Share of the stiffness of a flat below which W/F^2 shows that the contact has become a face. */
#define SOFTER 0.67
/* Cosine of the angle of motion and force from which on the area that faces the motion counts. */
#define GLANCING 0.2
/* A of a worn contact is computed anew above this share of y. */
#define RECHECKED 0.5
/* Least area that crushes, over the square of the radius. */
#define LEAST_AREA 0.01
/* Largest t of a contact that does not yield: it makes the contact stiffer by 1 + t^2. */
#define MOST_LEAN 1.0
/* A dent counts for a contact whose normal is within 45 degrees of it. */
#define SAME_SIDE 0.7

fl_relative_pose fl_crushing_pose(const fl_pair *p, const fl_relative_pose *r)
{
    fl_relative_pose q = *r;
    const fl_vec3 d = m3_mul(r->M, p->crush->offset);
    q.o = v3_add(r->o, d);
    q.off = v3_sub(r->off, m3_mul(r->R, d));
    return q;
}

static fl_crush *record_of(fl_pair *p)
{
    fl_err lost = {0};
    if (!p->crush && (p->crush = fl_alloc(1, sizeof *p->crush, &lost)))
        *p->crush = (fl_crush){.stiffening = 1.0};
    return p->crush;
}

int fl_crushing_adopt(fl_world *w, fl_pair *p, fl_vec3 centre, fl_vec3 gradient, const fl_relative_pose *r)
{
    const fl_floe_dents *d = w->crushing.dents[p->i];
    if (!d) return 0;
    const fl_vec3 x = m3_tmul(r->M, v3_sub(centre, r->o)), n = v3_unit(m3_tmul(r->M, gradient));
    const fl_dent *best = NULL;
    double deepest = 0.0;
    for (int32_t k = 0; k < d->n; k++) {
        const fl_dent *t = &d->dent[k];
        const double deep = v3_dot(t->offset, n);
        const fl_vec3 way = v3_sub(x, t->x), aside = v3_madd(way, -v3_dot(way, n), n);
        if (deep > deepest && deep > SAME_SIDE * v3_norm(t->offset) && v3_norm(aside) <= t->half_width)
            best = t, deepest = deep;
    }
    fl_crush *const c = record_of(p);
    if (!c) return -1;
    if (!best) return 0;
    c->offset = best->offset;
    c->stiffening = best->stiffening;
    p->k = c->stiffening * fl_pair_stiffness(w, p->i, p->j).k;
    return 1;
}

/* Area below which a contact does not crush [m2]: it would get the stiffness of an ever smaller flat. */
static double least_area(const fl_bodies *b, const fl_pair *p)
{
    return LEAST_AREA * b->radius[p->i] * b->radius[p->i];
}

/* S of what faces the motion of A in the pose r, or n, the direction of the force, where A moves across
 * it; in the frame of B. */
static fl_vec3 area_of(const fl_world *w, const fl_pair *p, const fl_relative_pose *r, fl_vec3 centre,
                       fl_vec3 n)
{
    const fl_bodies *b = &w->b;
    const fl_mat3 one = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    fl_half_spaces a, other;
    fl_half_spaces_of(&a, &b->core[p->i], b->radius[p->i], &r->M, r->o);
    if (p->j < w->n) {
        fl_half_spaces_of(&other, &b->core[p->j], b->radius[p->j], &one, v3(0, 0, 0));
        return v3_scale(fabs(v3_dot(n, fl_area_vector_of_body(&a, &other, n))), n);
    }
    const fl_piece *piece = fl_world_piece(w, p->j);
    const fl_vec3 aj = m3_mul(r->R, centre), v = fl_pair_relative_velocity(b, p, v3_add(aj, r->off), aj),
                  back = v3_neg(m3_tmul(r->R, v));
    const double size = v3_norm(back);
    if (v3_dot(n, back) > GLANCING * size) {
        const fl_vec3 S = fl_area_vector_of_piece(&a, piece, v3_scale(1.0 / size, back));
        if (v3_dot(n, S) > least_area(b, p)) return S;
    }
    return fl_area_vector_of_piece(&a, piece, n);
}

/* c of the law, without g. */
static double law_stiffness(const fl_world *w, const fl_pair *p)
{
    return fl_pair_stiffness(w, p->i, p->j).k;
}

/* t of a contact that has yielded, bounded; in the frame of A. */
static fl_vec3 lean_of(const fl_relative_pose *r, fl_vec3 S, double A, fl_vec3 way)
{
    const fl_vec3 t = v3_scale(1.0 / A, v3_madd(S, -A, way));
    const double size = v3_norm(t);
    return m3_tmul(r->M, size > MOST_LEAN ? v3_scale(MOST_LEAN / size, t) : t);
}

void fl_crushing_slide(const fl_world *w, fl_pair *p, const fl_relative_pose *r, double dt)
{
    fl_crush *const c = p->crush;
    if (!p->touching) c->lean = v3(0, 0, 0);
    if (!(dt > 0.0 && v3_norm2(c->lean) > 0.0)) return;
    const fl_mat3 R = fl_body_axes(&w->b, p->i);
    const fl_vec3 ai = m3_mul(R, c->centre), v = fl_pair_relative_velocity(&w->b, p, ai, v3_sub(ai, r->off));
    c->offset = v3_madd(c->offset, dt * v3_dot(m3_mul(R, c->lean), v), c->normal);
}

int fl_crushing_yield(fl_world *w, fl_pair *p, const fl_relative_pose *r, fl_vec3 gradient, fl_vec3 centre,
                      fl_exact_contact *exact, double *limit, fl_vec3 *aside)
{
    const fl_crushing_state *const s = &w->crushing;
    double F = exact->scale * v3_norm(gradient), W = exact->energy;
    fl_crush *c = p->crush;
    const fl_vec3 way = v3_unit(gradient), n = m3_tmul(r->M, way);
    if (!p->touching) p->nominal_area = p->crush_checked = 0.0;
    double A = p->nominal_area, y = A > 0.0 ? A * fl_crushing_pressure(&s->law, A) : 0.0;
    *limit = INFINITY;
    *aside = v3(0, 0, 0);
    if (c) {
        const double turned = v3_dot(c->offset, n);
        if (turned < 0.0) c->offset = v3_madd(c->offset, -turned, n);
        c->centre = m3_tmul(r->M, v3_sub(centre, r->o));
        c->normal = n;
        *aside = v3_scale(F, m3_mul(r->M, c->lean));
    }
    if (c && c->stiffening > 1.0 && A > 0.0 && 4.0 * W * law_stiffness(w, p) * sqrt(A) < SOFTER * F * F) {
        /* a flat that has turned to a face of the floe is no stiffer than that */
        p->nominal_area = A = fmax(A, v3_dot(way, area_of(w, p, r, centre, way)));
        const double base = law_stiffness(w, p), part = 4.0 * W * base * sqrt(A) / (F * F),
                     g = fmax(c->stiffening * part, 1.0), less = g / c->stiffening;
        if (less < 1.0) {
            c->stiffening = g;
            p->k = g * base;
            F *= less, W *= less;
            *aside = v3_scale(less, *aside);
            exact->scale *= less, exact->energy = W, exact->slope *= less;
        }
        y = A * fl_crushing_pressure(&s->law, A);
    }
    if (y > 0.0) *limit = y;
    const int grows = !(y > 0.0) || F > y || F > p->crush_checked;
    if (!grows && !(c && F > RECHECKED * y)) return 0;
    const fl_vec3 S = area_of(w, p, r, centre, way);
    A = v3_dot(way, S);
    if (!(A > least_area(&w->b, p))) return 0;
    *limit = y = A * fl_crushing_pressure(&s->law, v3_norm(S));
    p->nominal_area = A;
    if (c) {
        /* F (n + t) is not above p |S| */
        const double most = v3_norm(v3_scale(1.0 / A, v3_madd(S, -A, way))), size = v3_norm(c->lean);
        if (size > most) c->lean = v3_scale(most / size, c->lean);
        *aside = v3_scale(F, m3_mul(r->M, c->lean));
    }
    if (!grows && !(F > y)) return 0;
    if (!(F > FLATTENED * y)) {
        p->crush_checked = FLATTENED * y;
        return 0;
    }
    const double base = law_stiffness(w, p), to = fmin(F, y), flat = 2.0 * base * sqrt(A);
    if (!(F > y) && !(W > (1.0 + SAME_ENERGY) * 0.5 * F * F / flat)) {
        p->crush_checked = F;
        return 0;
    }
    if (!(c = record_of(p))) return -1;
    const double curve = W * exact->slope / (F * F),
                 m = fmin(fmax(curve < 1.0 ? 1.0 / (1.0 - curve) : MOST_EXPONENT, LEAST_EXPONENT),
                          MOST_EXPONENT),
                 shrunk = fl_pow(to / F, 1.0 / (m - 1.0)),
                 W1 = fmin(W * shrunk * (to / F), 0.5 * to * to / flat), ratio = (W1 / W) * (F / to);
    if (ratio < shrunk) {
        c->stiffening *= (to / F) / fl_pow(ratio, m - 1.0);
        p->k = c->stiffening * base;
    }
    const double deeper = m * W / F * (1.0 - ratio);
    c->offset = v3_madd(c->offset, deeper, n);
    c->centre = m3_tmul(r->M, v3_sub(centre, r->o));
    p->nominal_area = A;
    p->crush_checked = to;
    c->volume += A * deeper;
    c->unsaved = 1;
    if (F > y) {
        c->yielded_step = w->step, c->force = y;
        *aside = v3_scale(y / A, v3_madd(S, -A, way));
        c->lean = lean_of(r, S, A, way), c->normal = n;
    }
    exact->scale *= to / F;
    exact->energy = W1;
    exact->slope = (m - 1.0) / m * to * to / W1;
    return F > y;
}

fl_elastic_wrench fl_elastic_wrench_of(const fl_pair *p)
{
    return (fl_elastic_wrench){v3_sub(v3_sub(p->force, p->force_damping), p->force_friction),
                               v3_sub(v3_sub(p->torque_i, p->torque_i_damping), p->torque_i_friction),
                               v3_sub(v3_sub(p->torque_j, p->torque_j_damping), p->torque_j_friction),
                               p->energy - p->spring_energy};
}

void fl_crushing_store_work(const fl_world *w, fl_pair *p, const fl_elastic_wrench *before, double dt)
{
    const fl_bodies *b = &w->b;
    fl_crush *const c = p->crush;
    const fl_elastic_wrench now = p->touching ? fl_elastic_wrench_of(p) : (fl_elastic_wrench){.energy = 0.0};
    const double power = v3_dot(v3_add(before->force, now.force), v3_sub(b->v[p->i], b->v[p->j])) +
                         v3_dot(v3_add(before->torque_i, now.torque_i), b->w[p->i]) +
                         v3_dot(v3_add(before->torque_j, now.torque_j), b->w[p->j]);
    c->work = dt > 0.0 ? -0.5 * dt * power - (now.energy - before->energy) : 0.0;
    c->work_step = w->step;
    c->booked = 0;
}

void fl_crushing_release(const fl_world *w, fl_pair *p)
{
    free(p->crush);
    p->crush = NULL;
    p->k = fl_pair_stiffness(w, p->i, p->j).k;
}

/* Moves D of a contact that has ended into its floe. */
static int keep_dent(fl_world *w, const fl_crush *c, double area, int32_t i, fl_err *err)
{
    fl_floe_dents **const of = &w->crushing.dents[i];
    if (!*of && !(*of = fl_alloc(1, sizeof **of, err))) return -1;
    fl_floe_dents *const d = *of;
    const fl_vec3 n = v3_unit(c->offset);
    const double size = v3_norm(c->offset);
    int32_t at = d->n, shallowest = 0;
    for (int32_t k = 0; k < d->n; k++) {
        const fl_vec3 way = v3_sub(c->centre, d->dent[k].x), aside = v3_madd(way, -v3_dot(way, n), n);
        if (v3_dot(d->dent[k].offset, n) > SAME_SIDE * v3_norm(d->dent[k].offset) &&
            v3_norm(aside) <= 0.5 * d->dent[k].half_width)
            at = k;
        if (v3_norm2(d->dent[k].offset) < v3_norm2(d->dent[shallowest].offset)) shallowest = k;
    }
    if (at == FL_DENTS) {
        w->crushing.dents_dropped++;
        if (v3_norm(d->dent[shallowest].offset) > size) return 0;
        at = shallowest;
    } else if (at == d->n) {
        d->n++;
    }
    d->dent[at] = (fl_dent){c->centre, c->offset, fmax(sqrt(area), w->b.radius[i]), c->stiffening};
    return 0;
}

static int book_pair(fl_world *w, int32_t k, fl_err *err)
{
    fl_pair *const p = w->pair[k].contact;
    if (!p || !p->crush) return 0;
    fl_crush *const c = p->crush;
    if (c->work_step == w->step && !c->booked) {
        w->ledger.crushing += c->work;
        c->booked = 1;
    }
    if (c->yielded_step == w->step) {
        w->crushing.contact_steps++;
        if (c->force > w->crushing.peak) w->crushing.peak = c->force;
    }
    w->crushing.volume += c->volume;
    c->volume = 0.0;
    if (p->touching || !c->unsaved) return 0;
    c->unsaved = 0;
    return w->crushing.wear ? keep_dent(w, c, p->nominal_area, p->i, err) : 0;
}

int fl_crushing_book(fl_world *w, fl_err *err)
{
    if (w->crushing.of == FL_CRUSHING_ALL) {
        for (int32_t k = 0; k < w->n_pair; k++)
            if (book_pair(w, k, err)) return -1;
        return 0;
    }
    for (int32_t j = w->n; j < w->n + w->pieces; j++)
        for (int64_t c = w->first_pair_of_body[j]; c < w->first_pair_of_body[j + 1]; c++)
            if (book_pair(w, w->pairs_of_body[c], err)) return -1;
    return 0;
}

int32_t fl_crushing_pierced_by(const fl_world *w, int32_t i)
{
    const fl_bodies *b = &w->b;
    if (b->core[i].nf == 0) return -1;
    for (int32_t j = w->n; j < w->n + w->pieces; j++) {
        fl_pair p = {.i = i, .j = j};
        fl_half_spaces a;
        const fl_vec3 way = v3_sub(b->x[j], b->x[i]), L = w->cell.length; /* to the nearest image */
        p.image[0] = -(int32_t)fl_periodic_cell_index(way.x, -0.5 * L.x, L.x);
        p.image[1] = -(int32_t)fl_periodic_cell_index(way.y, -0.5 * L.y, L.y);
        p.image[2] = -(int32_t)fl_periodic_cell_index(way.z, -0.5 * L.z, L.z);
        if (v3_norm(fl_separation(w, i, j, p.image)) >
            b->bounding_radius[i] + b->radius[i] + b->bounding_radius[j])
            continue;
        const fl_relative_pose r = fl_relative_pose_of(w, &p);
        fl_half_spaces_of(&a, &b->core[i], b->radius[i], &r.M, r.o);
        /* a floe is thinnest across its axis of the largest inertia */
        if (fl_area_is_closed(&a, fl_world_piece(w, j), m3_mul(r.M, v3(0, 0, 1)))) return j - w->n;
    }
    return -1;
}

void fl_crushing_forget(fl_world *w, int32_t i)
{
    if (!w->crushing.dents) return;
    free(w->crushing.dents[i]);
    w->crushing.dents[i] = NULL;
}

int fl_crushing_make(fl_world *w, fl_err *err)
{
    const fl_scene_failure *s = &w->scene->failure;
    if (!s->head.present || s->crushing == FL_CRUSHING_NONE || s->crushing_law != FL_CRUSHING_PLAIN) return 0;
    w->crushing = (fl_crushing_state){.of = s->crushing, .wear = s->wear, .law = fl_pressure_area_of(s)};
    w->crushing.dents = fl_alloc(w->n, sizeof *w->crushing.dents, err);
    return w->crushing.dents ? 0 : -1;
}

void fl_crushing_free(fl_world *w)
{
    for (int32_t i = 0; w->crushing.dents && i < w->n; i++) free(w->crushing.dents[i]);
    free(w->crushing.dents);
    w->crushing = (fl_crushing_state){0};
}
