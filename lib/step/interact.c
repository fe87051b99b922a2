/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/mem.h"
#include "bound/shell.h"
#include "law/damping.h"
#include "law/manual.h"
#include "law/normal.h"
#include "narrow/nearest.h"
#include "step/interact.h"

/* A pair that is not touching asks for its true distance only within this multiple of its reach: beyond, the
 * bound by the old direction lets it sleep for long enough. */
#define NEARLY 1.02

/* Where the two stand to one another.  Everything is computed relative to B, so that nothing depends on
 * where the world's origin is: o and M take A's frame to B's, off is the world vector from A's centre to
 * B's. */
typedef struct {
    fl_mat3 M;
    fl_vec3 o, off;
} relative;

static relative relate(const fl_bodies *b, int32_t i, int32_t j)
{
    const fl_mat3 *A = &b->R[i], *B = &b->R[j];
    relative r;
    r.off = v3_sub(b->x[j], b->x[i]);
    r.o = v3_neg(m3_tmul(*B, r.off));
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
            r.M.m[k][l] = B->m[0][k] * A->m[0][l] + B->m[1][k] * A->m[1][l] + B->m[2][k] * A->m[2][l];
    return r;
}

static const fl_piece *piece_of(const fl_world *w, int32_t j)
{
    return j < w->n ? NULL : &w->structure.piece[j - w->n];
}

/* --- where they touch -------------------------------------------------------------------------- */

/* One point against anything with a closed form: the whole contact is one place. */
static int point_places(fl_places *s, const fl_poly *b, const fl_piece *piece, fl_vec3 x, double ra, double R,
                        double *distance)
{
    fl_nearest q;
    if (piece && piece->kind == FL_PIECE_CONE) q = fl_nearest_cone(piece->r0, piece->r1, piece->h, x);
    else q = fl_nearest_poly(b, x);
    *distance = q.d;
    s->n = 0;
    return q.d < R ? fl_places_vertex(s, 0, x, q.n, R - q.d, ra) : 0;
}

static int plane_places(fl_places *s, int32_t nv, double ra, double *distance)
{
    s->n = 0;
    *distance = INFINITY;
    for (int32_t v = 0; v < nv; v++) {
        if (s->va[v].z < *distance) *distance = s->va[v].z;
        if (s->va[v].z < ra && fl_places_vertex(s, v, s->va[v], v3(0, 0, 1), ra - s->va[v].z, ra)) return -1;
    }
    return 0;
}

/* Width of the gap that the planes across n leave between the cores: a lower bound of their distance. */
static double gap_along(const fl_vec3 *va, int32_t na, const fl_poly *b, fl_vec3 n)
{
    double low = INFINITY, high = -INFINITY;
    for (int32_t v = 0; v < na; v++) {
        const double h = v3_dot(n, va[v]);
        low = h < low ? h : low;
    }
    for (int32_t v = 0; v < b->nv; v++) {
        const double h = v3_dot(n, b->v[v]);
        high = h > high ? h : high;
    }
    return low - high;
}

/* Normals of A in B's frame, for the rare case of overlapping cores; the scratch of places holds its
 * vertices. */
static int penetration(fl_world *w, const fl_poly *a, const fl_poly *b, const fl_places *s, fl_mat3 M,
                       fl_overlap *deep)
{
    fl_err lost = {0};
    fl_vec3 *n = fl_alloc(a->nf, sizeof *n, &lost);
    if (!n) return -1;
    for (int32_t f = 0; f < a->nf; f++) n[f] = m3_mul(M, a->n[f]);
    const fl_solid A = {a, s->va, n, 0.0}, B = {b, b->v, b->n, 0.0};
    fl_deep_count count = {0};
    fl_deep(&A, &B, &count, deep);
    free(n);
#pragma omp critical(fl_deep_statistics)
    {
        w->deep_count.asked += count.asked;
        w->deep_count.none += count.none;
        w->deep_count.poor += count.poor;
        w->deep_count.capped += count.capped;
        w->deep_pairs++;
    }
    return 0;
}

/* Direction between the cores in B's frame, p->axis, and a lower bound of their distance (negative:
 * penetration).  The direction of the last look serves while it still separates them by `enough`. */
static int separate(fl_world *w, fl_pair *p, const fl_poly *a, const fl_poly *b, const fl_places *s,
                    fl_mat3 M, double enough, fl_overlap *deep, double *distance)
{
    *distance = gap_along(s->va, a->nv, b, p->axis);
    *deep = (fl_overlap){0};
    p->deep = 0;
    if (p->has_axis && *distance > enough) return 0;
    fl_gap gap;
    fl_gjk((fl_core){s->va, a->nv}, (fl_core){b->v, b->nv}, &p->cache, &gap);
    if (!gap.overlap) {
        p->axis = gap.n;
        p->has_axis = 1;
        *distance = gap.d;
        return 0;
    }
    if (penetration(w, a, b, s, M, deep)) return -1;
    p->axis = deep->n;
    p->has_axis = 1;
    p->deep = 1;
    *distance = -deep->depth;
    return 0;
}

/* Edges of overlapping cores hold the depth D twice in their distance (places.h): the force of that,
 *     sum k w s^n 2 = k w_D (R + D)^n,
 * along the direction of the depth, through the deepest point.  Its energy is that of the edges.  first: key
 * of edges. */
static int add_depth(fl_places *s, int64_t first, int64_t key, const fl_overlap *deep, double n, double R,
                     double ra)
{
    double sum = 0.0;
    for (int32_t k = 0; k < s->n; k++)
        if (s->place[k].key >= first)
            sum += 2.0 * s->place[k].weight * fl_normal_power(s->place[k].overlap, n);
    if (sum == 0.0) return 0;
    if (fl_places_vertex(s, key, deep->pa, deep->n, R + deep->depth, ra)) return -1;
    fl_place *last = &s->place[s->n - 1];
    last->weight = sum / fl_normal_power(last->overlap, n);
    last->store = 0.0;
    return 0;
}

/* Fill s with the places of the pair; *distance is a lower bound of the distance of the cores. */
static int find_places(fl_world *w, fl_pair *p, fl_places *s, fl_shell_near *near, const relative *r,
                       double *distance)
{
    const fl_bodies *b = &w->b;
    const fl_poly *A = &b->core[p->i], *B = &b->core[p->j];
    const fl_piece *piece = piece_of(w, p->j);
    const double ra = b->radius[p->i], rb = b->radius[p->j], R = ra + rb;
    s->n = 0;
    if (A->nv == 1 && (!piece || piece->kind == FL_PIECE_CONE || piece->kind == FL_PIECE_SOLID))
        return point_places(s, B, piece, r->o, ra, R, distance);
    if (B->nv == 1 && !piece) { /* the point is B: look from A, then turn the place round */
        if (point_places(s, A, NULL, v3_neg(m3_tmul(r->M, r->o)), rb, R, distance)) return -1;
        if (s->n) {
            const fl_vec3 n = v3_neg(m3_mul(r->M, s->place[0].n));
            const double overlap = s->place[0].overlap;
            s->n = 0;
            return fl_places_vertex(s, 0, v3_scale(R - overlap, n), n, overlap, ra);
        }
        return 0;
    }
    if (fl_places_enter(s, A, r->M, r->o)) return -1;
    if (piece && piece->kind == FL_PIECE_PLANE) return plane_places(s, A->nv, ra, distance);
    if (piece && piece->kind == FL_PIECE_SHELL)
        return fl_shell_places(s, near, A, piece, r->M, r->o, ra, ra + w->skin, distance);
    const int core_law = p->law->kind == FL_LAW_CORE;
    fl_overlap deep;
    /* A direction that separates the cores at all is enough to find the places of a touching pair; one that
     * sleeps wants its distance. */
    if (separate(w, p, A, B, s, r->M, core_law ? INFINITY : p->n ? 0.0 : NEARLY * R, &deep, distance))
        return -1;
    if (*distance >= R) return 0;
    if (core_law) {
        fl_gap gap;
        if (p->deep) {
            const double overlap = R - *distance;
            fl_vec3 x = v3(0, 0, 0);
            double low = INFINITY;
            for (int32_t v = 0; v < A->nv; v++) {
                const double h = v3_dot(p->axis, s->va[v]);
                if (h < low) low = h, x = s->va[v];
            }
            return fl_places_vertex(s, 0, x, p->axis, overlap, ra);
        }
        fl_gjk((fl_core){s->va, A->nv}, (fl_core){B->v, B->nv}, &p->cache, &gap);
        return fl_places_vertex(s, 0, gap.pa, gap.n, R - gap.d, ra);
    }
    if (fl_places_find(s, A, B, r->M, r->o, ra, rb, p->axis, deep.depth)) return -1;
    const int64_t edges = (int64_t)A->nv + B->nv;
    if (p->deep && add_depth(s, edges, edges + (int64_t)A->ne * B->ne, &deep, p->exponent, R, ra)) return -1;
    if (s->n == 0 && *distance < R) { /* the old direction was only a bound: ask for the distance */
        p->has_axis = 0;
        return separate(w, p, A, B, s, r->M, INFINITY, &deep, distance);
    }
    return 0;
}

/* --- the forces of it -------------------------------------------------------------------------- */

static int remember(fl_world *w, fl_pair *p, int32_t thread, int32_t n)
{
    fl_err lost = {0};
    if (fl_grow(&p->memory, &p->cap, n, sizeof *p->memory, &lost)) return -1;
    memcpy(p->memory, w->fresh[thread], (size_t)n * sizeof *p->memory);
    p->n = n;
    return 0;
}

static void add_wrench(fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj, fl_vec3 force, fl_vec3 ai, fl_vec3 aj)
{
    *f = v3_add(*f, force);
    *ti = v3_add(*ti, v3_cross(ai, force));
    *tj = v3_sub(*tj, v3_cross(aj, force));
}

static double compliance(const fl_bodies *b, int32_t i, fl_vec3 a, fl_vec3 n)
{
    const fl_vec3 t = v3_cross(a, n);
    return b->invm[i] == 0.0 ? 0.0 : b->invm[i] + v3_dot(t, fl_body_turn(b, i, t));
}

/* What one place does, whatever law its elastic force and stiffness came from. */
typedef struct {
    double elastic, normal; /* F without and with damping [N] */
    double slope;           /* dF/ds [N/m]                    */
    double grip;            /* tangential damping [N s/m]     */
} place_force;

static void apply(fl_world *w, fl_pair *p, fl_memory *m, const fl_memory *old, const place_force *pf,
                  fl_vec3 n, fl_vec3 ai, fl_vec3 aj, fl_vec3 u, double dt, int survey)
{
    const fl_bodies *b = &w->b;
    const fl_touching *law = p->law;
    add_wrench(&p->f, &p->ti, &p->tj, v3_scale(pf->normal, n), ai, aj);
    add_wrench(&p->fd, &p->di, &p->dj, v3_scale(pf->normal - pf->elastic, n), ai, aj);
    m->slip = old ? old->slip : (fl_slip){0};
    if (law->friction > 0.0 && law->tangential > 0.0) {
        const double twist = 0.5 * v3_dot(v3_add(b->w[p->i], b->w[p->j]), n);
        const fl_vec3 t = fl_tangent_force(&m->slip, n, u, twist, dt, law->tangential * pf->slope, pf->grip,
                                           law->friction * pf->normal);
        add_wrench(&p->f, &p->ti, &p->tj, t, ai, aj);
        add_wrench(&p->fs, &p->si, &p->sj, t, ai, aj);
        p->spring += fl_tangent_energy(&m->slip);
    }
    if (survey) {
        p->stiff_i += pf->slope * compliance(b, p->i, ai, n);
        p->stiff_j += pf->slope * compliance(b, p->j, aj, n);
    }
}

static fl_vec3 approach(const fl_bodies *b, const fl_pair *p, fl_vec3 ai, fl_vec3 aj)
{
    return v3_sub(fl_body_velocity(b, p->i, ai), fl_body_velocity(b, p->j, aj));
}

/* Forces of the places in s, by the potential.  Damping is the same factor for all places of a pair,
 *     chi = D / max(v_touch, sqrt(2 W / M)),
 * where v_touch is the largest approach speed of this touch and sqrt(2 W/M) the speed that the stored energy
 * W amounts to: in an impact it stays below v_touch, so restitution is that of D; in a contact that was
 * never an impact it keeps the damping ratio below D/2. */
static void force_places(fl_world *w, fl_pair *p, fl_places *s, int32_t thread, const relative *r, double dt,
                         int survey)
{
    const fl_bodies *b = &w->b;
    const fl_mat3 R = b->R[p->j];
    fl_memory *fresh = w->fresh[thread];
    double energy = 0.0, fastest = 0.0;
    for (int32_t k = 0; k < s->n; k++) {
        fl_place *q = &s->place[k];
        q->n = m3_mul(R, q->n); /* from here on in world axes, relative to B's centre */
        q->p = m3_mul(R, q->p);
        energy += p->k * q->weight * q->store * fl_normal_phi(q->overlap, p->exponent);
        const double u = -v3_dot(q->n, approach(b, p, v3_add(q->p, r->off), q->p));
        if (u > fastest) fastest = u;
        if (q->overlap > p->overlap) p->overlap = q->overlap;
    }
    p->touch = p->n && p->touch > fastest ? p->touch : fastest;
    const double stored = sqrt(2.0 * energy / p->mass), speed = p->touch > stored ? p->touch : stored;
    const double chi = speed > 0.0 ? p->law->chi / speed : 0.0;
    p->energy = energy;
    for (int32_t k = 0, old = 0; k < s->n; k++) {
        const fl_place *q = &s->place[k];
        const fl_vec3 aj = q->p, ai = v3_add(q->p, r->off), u = approach(b, p, ai, aj);
        const double kw = p->k * q->weight;
        place_force pf;
        while (old < p->n && p->memory[old].key < q->key) old++;
        pf.elastic = kw * fl_normal_power(q->overlap, p->exponent);
        pf.normal = fl_normal_damped(pf.elastic, chi, -v3_dot(q->n, u));
        pf.slope = kw * fl_normal_slope(q->overlap, p->exponent);
        pf.grip = p->law->tangential * chi * pf.elastic;
        fresh[k].key = q->key;
        apply(w, p, &fresh[k], old < p->n && p->memory[old].key == q->key ? &p->memory[old] : NULL, &pf, q->n,
              ai, aj, u, dt, survey);
        if (q->couple.x != 0.0 || q->couple.y != 0.0 || q->couple.z != 0.0) {
            const fl_vec3 c = v3_scale(p->k * fl_normal_phi(q->overlap, p->exponent), m3_mul(R, q->couple));
            p->ti = v3_add(p->ti, c);
            p->tj = v3_sub(p->tj, c);
        }
    }
}

/* The manual's law: one contact, by the kind of the closest features. */
static int force_manual(fl_world *w, fl_pair *p, fl_places *s, int32_t thread, const relative *r, double dt,
                        int survey, double *distance)
{
    const fl_bodies *b = &w->b;
    const fl_touching *law = p->law;
    const fl_poly *A = &b->core[p->i], *B = &b->core[p->j];
    const double ra = b->radius[p->i], rb = b->radius[p->j];
    fl_err lost = {0};
    if (fl_places_enter(s, A, r->M, r->o)) return -1;
    fl_vec3 *n = fl_alloc(A->nf, sizeof *n, &lost);
    if (!n) return -1;
    for (int32_t f = 0; f < A->nf; f++) n[f] = m3_mul(r->M, A->n[f]);
    const fl_solid a = {A, s->va, n, ra}, bb = {B, B->v, B->n, rb};
    fl_contact c;
    fl_contact_find(&a, &bb, p->mode, &p->cache, NULL, &c);
    free(n);
    *distance = c.d;
    if (c.gap >= 0.0) {
        p->mode = FL_MODE_NONE;
        p->n = 0;
        return 0;
    }
    const double overlap = -c.gap;
    const fl_manual_contact mc = {.touch = (fl_touch)(c.mode - FL_VV),
                                  .length = c.length,
                                  .area = c.area,
                                  .sine = c.sine,
                                  .r_low = c.low_b ? rb : ra,
                                  .r_high = c.low_b ? ra : rb,
                                  .edge = c.edge};
    double exponent, k = fl_manual_stiffness(&mc, law->modulus, overlap, law->kind == FL_LAW_MANUAL_SI,
                                             law->literal18, &exponent);
    k = law->stiffness > 0.0 ? law->stiffness : law->softening * k;
    const fl_vec3 nw = m3_mul(b->R[p->j], c.n), aj = m3_mul(b->R[p->j], c.p), ai = v3_add(aj, r->off);
    const fl_vec3 u = approach(b, p, ai, aj);
    const double closing = -v3_dot(nw, u);
    const double mass = law->literal2 && b->invm[p->j] > 0.0 ? b->m[p->i] + b->m[p->j] : p->mass;
    place_force pf;
    pf.elastic = k * fl_normal_power(overlap, exponent);
    pf.normal = pf.elastic + fl_manual_damping(k, exponent, overlap, mass, law->zeta, law->alpha, closing);
    if (pf.normal < 0.0) pf.normal = 0.0;
    pf.slope = k * fl_normal_slope(overlap, exponent);
    pf.grip = 0.0;
    p->overlap = overlap;
    p->energy = k * fl_normal_phi(overlap, exponent);
    p->mode = c.mode;
    w->fresh[thread][0].key = 0;
    apply(w, p, w->fresh[thread], p->n ? p->memory : NULL, &pf, nw, ai, aj, u, dt, survey);
    p->energy += p->spring;
    return remember(w, p, thread, 1);
}

void fl_interact(fl_world *w, fl_pair *p, int32_t thread, double dt, int survey)
{
    const fl_bodies *b = &w->b;
    const double path = b->odometer[p->i] + b->odometer[p->j];
    if (p->n == 0 && path < p->asleep) return;
    const double R = b->radius[p->i] + b->radius[p->j];
    const relative r = relate(b, p->i, p->j);
    fl_places *s = &w->scratch[thread];
    double distance = 0.0;
    p->f = p->ti = p->tj = p->fd = p->di = p->dj = p->fs = p->si = p->sj = v3(0, 0, 0);
    p->energy = p->spring = p->overlap = p->stiff_i = p->stiff_j = 0.0;
    const fl_piece *piece = piece_of(w, p->j);
    const int manual = (p->law->kind == FL_LAW_MANUAL || p->law->kind == FL_LAW_MANUAL_SI) &&
                       (!piece || piece->kind == FL_PIECE_SOLID || piece->kind == FL_PIECE_CONE);
    if (manual) {
        if (force_manual(w, p, s, thread, &r, dt, survey, &distance)) goto failed;
        if (p->n) return;
    } else {
        fl_err lost = {0};
        if (find_places(w, p, s, &w->near_shell[thread], &r, &distance)) goto failed;
        if (fl_grow(&w->fresh[thread], &w->fresh_cap[thread], s->n, sizeof **w->fresh, &lost)) goto failed;
        if (s->n) {
            force_places(w, p, s, thread, &r, dt, survey);
            p->energy += p->spring;
            if (remember(w, p, thread, s->n)) goto failed;
            return;
        }
    }
    p->n = 0;
    p->touch = 0.0;
    p->asleep = path + (distance > R ? distance - R : 0.0) * (1.0 - 1e-9);
    return;
failed:
#pragma omp atomic write
    w->failed = 1;
}

int fl_interact_probe(fl_world *w, int32_t i, int32_t j, double reach, fl_contact *out)
{
    const fl_bodies *b = &w->b;
    const fl_poly *A = &b->core[i], *B = &b->core[j];
    const relative r = relate(b, i, j);
    const fl_piece *piece = piece_of(w, j);
    fl_places *s = &w->scratch[0];
    fl_err lost = {0};
    if (piece && piece->kind == FL_PIECE_SHELL) return 0;
    if (fl_places_enter(s, A, r.M, r.o)) return 0;
    if (piece && (piece->kind == FL_PIECE_PLANE || (piece->kind == FL_PIECE_CONE && A->nv == 1))) {
        double d;
        s->n = 0;
        const double ra = b->radius[i];
        if (piece->kind == FL_PIECE_PLANE) {
            int32_t low = 0;
            for (int32_t v = 1; v < A->nv; v++)
                if (s->va[v].z < s->va[low].z) low = v;
            d = s->va[low].z;
            *out = (fl_contact){.mode = FL_VF, .d = d, .gap = d - ra, .n = v3(0, 0, 1)};
            out->p = v3_madd(s->va[low], -ra - 0.5 * out->gap, out->n);
        } else {
            const fl_nearest q = fl_nearest_cone(piece->r0, piece->r1, piece->h, r.o);
            *out = (fl_contact){.mode = FL_VF, .d = q.d, .gap = q.d - ra, .n = q.n};
            out->p = v3_madd(r.o, -ra - 0.5 * out->gap, q.n);
        }
    } else {
        fl_vec3 *n = fl_alloc(A->nf, sizeof *n, &lost);
        if (!n) return 0;
        for (int32_t f = 0; f < A->nf; f++) n[f] = m3_mul(r.M, A->n[f]);
        const fl_solid a = {A, s->va, n, b->radius[i]}, bb = {B, B->v, B->n, b->radius[j]};
        fl_contact_find(&a, &bb, FL_MODE_NONE, NULL, NULL, out);
        free(n);
    }
    out->n = m3_mul(b->R[j], out->n);
    out->p = v3_add(b->x[j], m3_mul(b->R[j], out->p));
    return out->gap < reach;
}
