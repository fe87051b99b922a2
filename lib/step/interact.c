/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/mem.h"
#include "base/wide.h"
#include "bound/shell.h"
#include "law/damping.h"
#include "law/manual.h"
#include "law/normal.h"
#include "narrow/frustum.h"
#include "narrow/nearest.h"
#include "step/bearing.h"
#include "step/frozen.h"
#include "step/interact.h"
#include "step/pairing.h"
#include "step/stiff.h"
#include "step/press.h"
#include "step/told.h"

/* A pair that is not touching asks for its true distance only within this multiple of its reach: beyond, the
 * bound by the old direction lets it sleep for long enough.  One that hovers nearer than that is awake in
 * nearly every step: it asks in one of so many, and else believes the bound that it does not touch. */
#define NEARLY 1.02
enum { HOVERS = 8 };

/* A number without the rhythm that steps and pairs may have. */
static uint32_t mixed(int64_t step, int32_t k)
{
    return ((uint32_t)step * UINT32_C(2654435761) + (uint32_t)k * UINT32_C(0x9e3779b1)) >> 16;
}

static double believed(const fl_world *w, int32_t i, int32_t j)
{
    return mixed(w->step, i + j) % HOVERS ? 1.0 : NEARLY;
}

/* Farther apart than this multiple of its reach, a pair forgets which of its features may touch: a contact
 * that chatters opens by less, and one that comes back later is listed anew for as much as four looks. */
#define FAR 1.003

/* Whether looks at contacts that are told ask in this step how stiff they are: one step in four, in no rhythm
 * that looks might have. */
static int asks(const fl_world *w) { return (uint32_t)w->step * UINT32_C(2654435761) >> 30 == 0; }

/* Where the two stand to one another.  Everything is computed relative to B, so that nothing depends on
 * where the world's origin is: o and M take A's frame to B's, R B's to the world's, off is the world vector
 * from A's centre to B's. */
typedef struct {
    fl_mat3 M, R;
    fl_vec3 o, off;
} relative;

/* How far cores that are so far apart may go before they can touch. */
static double sleep_for(double distance, double R)
{
    return distance > R ? (distance - R) * (1.0 - 1e-9) : 0.0;
}

/* M is left out where A is a point: nothing of it turns. */
static relative relate(const fl_world *w, const fl_pair *p)
{
    const fl_bodies *b = &w->b;
    const int32_t i = p->i, j = p->j;
    relative r;
    const fl_mat3 *B = &r.R;
    r.R = fl_body_axes(b, j);
    r.off = fl_world_way(w, i, j, p->image);
    r.o = v3_neg(m3_tmul(*B, r.off));
    if (b->core[i].nv == 1) {
        r.M = (fl_mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        return r;
    }
    const fl_mat3 A = fl_body_axes(b, i);
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
            r.M.m[k][l] = B->m[0][k] * A.m[0][l] + B->m[1][k] * A.m[1][l] + B->m[2][k] * A.m[2][l];
    return r;
}

static const fl_piece *piece_of(const fl_world *w, int32_t j)
{
    return j < w->n ? NULL : &w->structure.piece[j - w->n];
}

/* --- where they touch -------------------------------------------------------------------------- */

/* One point against anything with a closed form. */
static int point_places(fl_places *s, const fl_poly *b, const fl_piece *piece, fl_vec3 x, double ra, double R,
                        double *distance)
{
    fl_nearest q;
    if (piece && piece->kind == FL_PIECE_PLANE) q = (fl_nearest){.d = x.z, .n = v3(0, 0, 1)};
    else if (piece && piece->kind == FL_PIECE_CONE) q = fl_nearest_cone(piece->r0, piece->r1, piece->h, x);
    else if (b->nv == 1) q = fl_nearest_point(b->v[0], x);
    else q = fl_nearest_poly(b, x);
    *distance = q.d;
    return q.d < R ? fl_places_point(s, x, q.n, R - q.d, ra) : 0;
}

/* The point of A that is lowest over the plane, for `core`. */
static int lowest_place(fl_places *s, int32_t nv, double ra, double *distance)
{
    fl_vec3 x = v3(0, 0, INFINITY);
    for (int32_t v = 0; v < nv; v++)
        if (s->va[v].z < x.z) x = s->va[v];
    *distance = x.z;
    return x.z < ra ? fl_places_point(s, x, v3(0, 0, 1), ra - x.z, ra) : 0;
}

/* The least n.v of m points. */
FL_WIDE_VERSIONS static double lowest(const fl_vec3 *v, int32_t m, fl_vec3 n)
{
    fl_wide least = {INFINITY, INFINITY, INFINITY, INFINITY};
    double low = INFINITY;
    int32_t k = 0;
    for (; k + FL_LANES <= m; k += FL_LANES) {
        fl_wide x[3];
        fl_wide_from_triples(x, &v[k]);
        const fl_wide h = n.x * x[0] + n.y * x[1] + n.z * x[2];
        least = FL_WIDE_CHOOSE(h < least, h, least);
    }
    for (; k < m; k++) {
        const double h = n.x * v[k].x + n.y * v[k].y + n.z * v[k].z;
        low = h < low ? h : low;
    }
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) low = least[l] < low ? least[l] : low;
    return low;
}

/* Width of the gap that the planes across n leave between the cores: a lower bound of their distance. */
static double gap_along(const fl_vec3 *va, int32_t na, const fl_poly *b, fl_vec3 n)
{
    return lowest(va, na, n) + lowest(b->v, b->nv, v3_neg(n));
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
 * penetration).  The direction of the last look serves while it still separates them by `enough`; otherwise
 * gap has the nearest points, where it is not NULL. */
static int separate(fl_world *w, fl_pair *p, const fl_poly *a, const fl_poly *b, const fl_places *s,
                    fl_mat3 M, double enough, fl_overlap *deep, fl_gap *gap, double *distance)
{
    *distance = gap_along(s->va, a->nv, b, p->axis);
    *deep = (fl_overlap){0};
    p->deep = 0;
    if (p->has_axis && *distance > enough) return 0;
    const fl_core A = {s->va, a->nv, a}, B = {b->v, b->nv, b};
    fl_gap exact;
    if (!gap) {
        fl_vec3 n;
        if (fl_gjk_direction(A, B, &p->cache, &n) && (*distance = gap_along(s->va, a->nv, b, n)) > 0.0) {
            p->axis = n;
            p->has_axis = 1;
            return 0;
        }
        gap = &exact;
    }
    fl_gjk(A, B, &p->cache, gap);
    if (!gap->overlap) {
        p->axis = gap->n;
        p->has_axis = 1;
        *distance = gap->d;
        return 0;
    }
    if (penetration(w, a, b, s, M, deep)) return -1;
    p->axis = deep->n;
    p->has_axis = 1;
    p->deep = 1;
    *distance = -deep->depth;
    return 0;
}

/* How much of U on a cone is that of the cone itself, the rest being that of its polygon, and its
 * derivatives: after the height z of the centre of A, and after a turn of A. */
typedef struct {
    double cone, slope; /* [1/m] */
    fl_vec3 turn;       /* [1/rad] */
} part_of_cone;

/* How far A reaches along the axis of the cone from its centre, at most, and what that changes by as A turns:
 * the ellipsoid around the box of A along its own axes, sqrt(3 sum (a.d)^2), which bends smoothly. */
static double reach_along(const fl_poly *a, const fl_mat3 *M, fl_vec3 *turn)
{
    fl_vec3 box = v3(0, 0, 0);
    for (int32_t v = 0; v < a->nv; v++)
        box = v3(fmax(box.x, fabs(a->v[v].x)), fmax(box.y, fabs(a->v[v].y)), fmax(box.z, fabs(a->v[v].z)));
    const fl_vec3 d = v3_mul(box, v3(M->m[2][0], M->m[2][1], M->m[2][2]));
    const double e = sqrt(3.0 * v3_norm2(d));
    const fl_vec3 g = m3_mul(*M, v3_scale(e > 0.0 ? 3.0 / e : 0.0, v3_mul(box, d)));
    *turn = v3_cross(g, v3(0, 0, 1));
    return e;
}

/* All where the ends are farther from the centre of A than twice its reach and R together, none where they
 * are nearer than once. */
static part_of_cone share_of_cone(const fl_piece *piece, const fl_poly *a, const relative *r, double R)
{
    fl_vec3 turn;
    const double z = r->o.z, size = reach_along(a, &r->M, &turn) + R;
    double share[2], along[2], by_size[2];
    for (int end = 0; end < 2; end++) {
        const double t = (end ? piece->h - z : z) / size - 1.0, u = t <= 0.0 ? 0.0 : t >= 1.0 ? 1.0 : t;
        const double bend = 30.0 * u * u * (1.0 - u) * (1.0 - u) / size;
        share[end] = u * u * u * (10.0 + u * (6.0 * u - 15.0));
        along[end] = end ? -bend : bend;
        by_size[end] = -bend * (t + 1.0);
    }
    return (part_of_cone){share[0] * share[1], along[0] * share[1] + share[0] * along[1],
                          v3_scale(by_size[0] * share[1] + share[0] * by_size[1], turn)};
}

/* Add the places on the cone itself.  Its polygon tells a direction that separates the two, the cone how far;
 * what overlaps it is looked at every time. */
static int cone_places(fl_pair *p, fl_places *s, const fl_poly *a, const fl_poly *b, const fl_piece *piece,
                       double ra, double *distance)
{
    const fl_frustum cone = {piece->r0, piece->r1, piece->h};
    p->deep = 0;
    for (int again = 0; again < 2; again++) {
        double low = INFINITY;
        for (int32_t v = 0; v < a->nv; v++) low = fmin(low, v3_dot(p->axis, s->va[v]));
        *distance = p->has_axis ? low - fl_frustum_reach(&cone, p->axis) : -INFINITY;
        if (again || (p->has_axis && *distance > (p->n ? 0.0 : NEARLY * ra))) break;
        fl_gap gap;
        fl_gjk((fl_core){s->va, a->nv, a}, (fl_core){b->v, b->nv, b}, &p->cache, &gap);
        p->has_axis = !gap.overlap;
        p->deep = gap.overlap;
        if (p->has_axis) p->axis = gap.n;
    }
    return *distance < ra ? fl_frustum_places(s, a, &cone, ra) : 0;
}

/* U = (1 - share) of the first n places + share of the others; where the share changes a force along the
 * axis, and a couple. */
static int blend(fl_places *s, int32_t n, fl_vec3 couple, const part_of_cone *of, fl_vec3 centre)
{
    double u[2] = {0};
    for (int32_t k = 0; k < s->n; k++) {
        fl_place *q = &s->place[k];
        const double part = k < n ? 1.0 - of->cone : of->cone;
        u[k >= n] += q->u;
        q->u *= part, q->du *= part, q->ddu *= part;
    }
    const double more = u[1] - u[0], du = -of->slope * more;
    s->couple = v3_add(v3_scale(1.0 - of->cone, couple), v3_scale(of->cone, s->couple));
    s->couple = v3_madd(s->couple, -more, of->turn);
    if (du == 0.0) return 0;
    return fl_places_add(s, (fl_place){.du = fabs(du), .n = v3(0, 0, du > 0.0 ? 1.0 : -1.0), .p = centre});
}

/* The list of a pair, which only pairs that come within reach have.  NULL when memory runs out. */
static fl_matches *matches_of(fl_pair *p)
{
    if (!p->matches) {
        fl_err lost = {0};
        p->matches = fl_alloc(1, sizeof *p->matches, &lost);
    }
    return p->matches;
}

/* The places of two convex cores in B's frame, A's entered. */
static int convex_places(fl_world *w, fl_pair *p, fl_places *s, const relative *r, double *distance)
{
    const fl_bodies *b = &w->b;
    const fl_poly *A = &b->core[p->i], *B = &b->core[p->j];
    const double ra = p->keep * b->radius[p->i], rb = p->keep * b->radius[p->j], R = ra + rb;
    const int core_law = p->law->kind == FL_LAW_CORE;
    fl_overlap deep;
    fl_gap gap;
    /* A direction that separates the cores at all is enough to find the places of a touching pair; one that
     * sleeps wants its distance. */
    if (separate(w, p, A, B, s, r->M,
                 core_law ? INFINITY
                 : p->n   ? 0.0
                          : believed(w, p->i, p->j) * R,
                 &deep, core_law ? &gap : NULL, distance))
        return -1;
    if (*distance >= R) return 0;
    if (core_law) {
        if (p->deep) {
            const double overlap = R - *distance;
            fl_vec3 x = v3(0, 0, 0);
            double low = INFINITY;
            for (int32_t v = 0; v < A->nv; v++) {
                const double h = v3_dot(p->axis, s->va[v]);
                if (h < low) low = h, x = s->va[v];
            }
            return fl_places_point(s, x, p->axis, overlap, ra);
        }
        return fl_places_point(s, gap.pa, gap.n, R - gap.d, ra);
    }
    fl_matches *const l = matches_of(p);
    if (!l || fl_places_find(s, A, B, ra, rb, p->axis, &deep, l)) return -1;
    if (s->n == 0 && *distance < R) { /* the old direction was only a bound: ask for the distance */
        p->has_axis = 0;
        return separate(w, p, A, B, s, r->M, INFINITY, &deep, NULL, distance);
    }
    return 0;
}

/* Fill s with the places of the pair; *distance is a lower bound of the distance of the cores. */
static int find_places(fl_world *w, fl_pair *p, fl_places *s, fl_shell_near *near, const relative *r,
                       double *distance)
{
    const fl_bodies *b = &w->b;
    const fl_poly *A = &b->core[p->i], *B = &b->core[p->j];
    const fl_piece *piece = piece_of(w, p->j);
    const double ra = p->keep * b->radius[p->i], rb = p->keep * b->radius[p->j], R = ra + rb;
    s->n = 0;
    if (A->nv == 1 && (!piece || piece->kind != FL_PIECE_SHELL))
        return point_places(s, B, piece, r->o, ra, R, distance);
    if (B->nv == 1 && !piece) { /* the point is B: look from A, then turn the place round */
        if (point_places(s, A, NULL, v3_neg(m3_tmul(r->M, r->o)), rb, R, distance)) return -1;
        if (s->n) {
            const fl_vec3 n = v3_neg(m3_mul(r->M, s->place[0].n));
            const double overlap = s->place[0].overlap;
            s->n = 0;
            return fl_places_point(s, v3_scale(R - overlap, n), n, overlap, ra);
        }
        return 0;
    }
    if (p->n && p->exponent == 0.0 && (!piece || piece->kind == FL_PIECE_SOLID) && p->matches &&
        p->matches->clear && fl_matches_hold(p->matches, &r->M, r->o)) {
        if (fl_places_known(s, A, B, ra, rb, r->M, r->o, p->matches)) return -1;
        p->deep = 0;
        if (s->n) return 0;
    }
    if (fl_places_enter(s, A, r->M, r->o)) return -1;
    if (piece && piece->kind == FL_PIECE_PLANE)
        return p->exponent > 0.0 ? lowest_place(s, A->nv, ra, distance) : fl_places_plane(s, A, ra, distance);
    if (piece && piece->kind == FL_PIECE_SHELL)
        return matches_of(p) ? fl_shell_places(s, near, A, piece, ra, ra + w->skin, p->exponent > 0.0,
                                               p->matches, distance)
                             : -1;
    double farther = INFINITY;
    part_of_cone of = {0};
    if (piece && piece->kind == FL_PIECE_CONE && p->exponent == 0.0) of = share_of_cone(piece, A, r, ra);
    if (of.cone < 1.0 && convex_places(w, p, s, r, distance)) return -1;
    if (of.cone == 0.0) return 0;
    const int32_t n = s->n;
    const int deep = p->deep;
    const fl_vec3 couple = n ? s->couple : v3(0, 0, 0);
    s->couple = v3(0, 0, 0);
    if (cone_places(p, s, A, B, piece, ra, &farther)) return -1;
    p->deep |= of.cone < 1.0 ? deep : 0;
    *distance = of.cone < 1.0 ? fmin(*distance, farther) : farther;
    return of.cone < 1.0 ? blend(s, n, couple, &of, r->o) : 0;
}

/* --- the forces of it -------------------------------------------------------------------------- */

static void add_wrench(fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj, fl_vec3 force, fl_vec3 ai, fl_vec3 aj)
{
    *f = v3_add(*f, force);
    *ti = v3_add(*ti, v3_cross(ai, force));
    *tj = v3_sub(*tj, v3_cross(aj, force));
}

/* A force and its moment about a point, in the frame of B and times scale; the point is ai from A's centre
 * and aj from B's, in world axes. */
static void add_sum(fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj, const fl_wrench *w, double scale, const fl_mat3 *R,
                    fl_vec3 ai, fl_vec3 aj)
{
    const fl_vec3 moment = v3_scale(scale, m3_mul(*R, w->m));
    add_wrench(f, ti, tj, v3_scale(scale, m3_mul(*R, w->f)), ai, aj);
    *ti = v3_add(*ti, moment);
    *tj = v3_sub(*tj, moment);
}

static fl_vec3 approach(const fl_bodies *b, const fl_pair *p, fl_vec3 ai, fl_vec3 aj)
{
    return v3_sub(fl_body_velocity(b, p->i, ai), fl_body_velocity(b, p->j, aj));
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

/* Friction at the centre of the pressure. */
static void rub(fl_world *w, fl_pair *p, const pressure *q, double chi, const relative *r, double dt)
{
    const fl_bodies *b = &w->b;
    const fl_touching *law = p->law;
    if (!(law->friction > 0.0 && law->tangential > 0.0 && q->normal > 0.0)) {
        p->slip = (fl_slip){0};
        return;
    }
    const fl_vec3 mean = v3_scale(1.0 / q->normal, q->moment), aj = v3_add(q->at, mean),
                  ai = v3_add(aj, r->off);
    const double arm2 = q->spread / q->normal - v3_norm2(mean);
    const fl_rubbing c = {.n = v3_unit(q->direction),
                          .k = law->tangential * q->slope,
                          .g = law->tangential * chi * q->elastic,
                          .limit = law->friction * v3_norm(q->direction),
                          .arm = arm2 > 0.0 ? sqrt(arm2) : 0.0};
    const double wi = v3_dot(b->w[p->i], c.n), wj = v3_dot(b->w[p->j], c.n);
    double moment;
    const fl_vec3 t =
        fl_tangent_force(&p->slip, &c, approach(b, p, ai, aj), wi - wj, 0.5 * (wi + wj), dt, &moment);
    const fl_vec3 m = v3_scale(moment, c.n);
    add_wrench(&p->fs, &p->si, &p->sj, t, ai, aj);
    p->si = v3_add(p->si, m);
    p->sj = v3_sub(p->sj, m);
    p->f = v3_add(p->f, p->fs);
    p->ti = v3_add(p->ti, p->si);
    p->tj = v3_add(p->tj, p->sj);
    p->spring = fl_tangent_energy(&p->slip);
}

/* What the springs of friction add, where they stick, and the bounds of it all. */
static void stiffen(const fl_world *w, fl_pair *p, const pressure *q, const relative *r, fl_stiff *si,
                    fl_stiff *sj)
{
    const fl_bodies *b = &w->b;
    if (p->slip.k > 0.0) {
        const fl_vec3 n = v3_unit(q->direction), aj = v3_madd(q->at, 1.0 / q->normal, q->moment);
        const fl_vec3 ai = v3_add(aj, r->off), none = v3(0, 0, 0);
        fl_stiff_across(si, b, p->i, p->slip.k, n, ai);
        fl_stiff_across(sj, b, p->j, p->slip.k, n, aj);
        fl_stiff_add(si, b, p->i, p->slip.k_turn, none, n);
        fl_stiff_add(sj, b, p->j, p->slip.k_turn, none, n);
    }
    p->stiff_i = fl_stiff_bound(si);
    p->stiff_j = fl_stiff_bound(sj);
}

/* The same of a contact whose places push along n at the point of the pressure alone. */
static void stiffen_one(const fl_world *w, fl_pair *p, const pressure *q, fl_vec3 n, const relative *r)
{
    fl_stiff si = {0}, sj = {0};
    fl_stiff_add(&si, &w->b, p->i, q->slope, n, v3_cross(v3_add(q->at, r->off), n));
    fl_stiff_add(&sj, &w->b, p->j, q->slope, n, v3_cross(q->at, n));
    stiffen(w, p, q, r, &si, &sj);
}

/* Damping is the same factor for all places of a pair,
 *     chi = D / max(v_touch, c sqrt(2 W / M)),
 * where v_touch is the largest approach speed of this touch, now the given one, and sqrt(2 W/M) the speed
 * that the stored energy W amounts to, with c of fl_damping_rest(): in an impact it stays below v_touch, so
 * restitution is that of D; in a contact that was never an impact the damping ratio stays below D/(2 c). */
static double damping_factor(fl_pair *p, double now)
{
    p->touch = p->n && p->touch > now ? p->touch : now;
    return fl_damping_chi(p->law->chi, p->law->rest, p->touch, p->energy, p->mass);
}

/* The one place of a round thing or of `core`: W = k phi(s). */
static int force_one(fl_world *w, fl_pair *p, const fl_places *s, const relative *r, double dt, int survey)
{
    const fl_bodies *b = &w->b;
    const fl_place *q = &s->place[0];
    const fl_vec3 n = m3_mul(r->R, q->n), aj = m3_mul(r->R, q->p), ai = v3_add(aj, r->off);
    const double closing = -v3_dot(n, approach(b, p, ai, aj)),
                 slope = p->k * fl_normal_slope(q->overlap, p->exponent);
    p->overlap = q->overlap;
    p->energy = p->k * fl_normal_phi(q->overlap, p->exponent);
    const double chi = damping_factor(p, closing > 0.0 ? closing : 0.0);
    const double elastic = p->k * fl_normal_power(q->overlap, p->exponent);
    const double normal = fl_normal_damped(elastic, chi, closing);
    add_wrench(&p->f, &p->ti, &p->tj, v3_scale(normal, n), ai, aj);
    add_wrench(&p->fd, &p->di, &p->dj, v3_scale(normal - elastic, n), ai, aj);
    pressure all = {.slope = slope, .at = aj};
    press(&all, elastic, normal, n, v3(0, 0, 0));
    rub(w, p, &all, chi, r, dt);
    if (survey) stiffen_one(w, p, &all, n, r);
    p->energy += p->spring;
    if (fl_press_wants(w, p)) fl_press_note(w, p, s, p->k, chi);
    return p->n = 1;
}

/* How stiff the springs of its places make a contact; the root in W bends down, W'' = scale (U'' - U'^2/2U).
 * ai, aj: the first place from the centres. */
static void survey_patch(const fl_world *w, const fl_pair *p, const fl_springs *q, fl_mat3 R, fl_vec3 ai,
                         fl_vec3 aj, double scale, double U, fl_stiff *si, fl_stiff *sj)
{
    const fl_bodies *b = &w->b;
    const double half = 0.5 / (scale * U);
    *si = *sj = (fl_stiff){0};
    fl_stiff_springs(si, b, p->i, scale, q, R, ai);
    fl_stiff_springs(sj, b, p->j, scale, q, R, aj);
    fl_stiff_add(si, b, p->i, -half, p->f, p->ti);
    fl_stiff_add(sj, b, p->j, -half, p->f, p->tj);
}

/* What damping and friction add to the elastic force of `patch`.  q: of places, times scale; it is about aj
 * from B's centre; slope: dF/ds. */
static pressure bear(fl_world *w, fl_pair *p, const fl_bearing *q, double scale, double slope, double chi,
                     const relative *r, fl_vec3 aj, double dt)
{
    const fl_mat3 *R = &r->R;
    add_sum(&p->fd, &p->di, &p->dj, &q->damping, scale, R, v3_add(aj, r->off), aj);
    p->f = v3_add(p->f, p->fd);
    p->ti = v3_add(p->ti, p->di);
    p->tj = v3_add(p->tj, p->dj);
    const pressure all = {.normal = scale * q->normal,
                          .elastic = scale * q->elastic,
                          .direction = v3_scale(scale, m3_mul(*R, q->direction)),
                          .at = aj,
                          .moment = v3_scale(scale, m3_mul(*R, q->moment)),
                          .spread = scale * q->spread,
                          .slope = slope};
    rub(w, p, &all, chi, r, dt);
    return all;
}

/* After a look.  t: what was told for this pose, or NULL. */
static int renew(fl_world *w, fl_pair *p, int32_t thread, const fl_told *t, const fl_seen *seen)
{
    fl_surrogate_count *count = &w->told[thread];
    const int near = t && fl_surrogate_nearly(p->surrogate, t);
    fl_err lost = {0};
    if (!p->surrogate && !(p->surrogate = fl_alloc(1, sizeof *p->surrogate, &lost))) return -1;
    if (p->deep || p->keep != 1.0) {
        p->surrogate->live = 0;
        return 0;
    }
    const double off = fl_surrogate_look(p->surrogate, t, seen, p->law->surrogate);
    if (off < 0.0) return -1;
    if (!near) return 0;
    count->looked++;
    count->off += off > p->law->surrogate;
    count->worst = off > count->worst ? off : count->worst;
    return 0;
}

/* --- what is found by a look ------------------------------------------------------------------- */

/* W = k sqrt(U) of the places summed up in q, which gets their couple. */
static fl_seen seen_of(const fl_pair *p, const fl_places *s, const relative *r, fl_bearing *q)
{
    const double energy = p->k * sqrt(q->u), scale = 0.5 * energy / q->u;
    q->gradient.m = v3_add(q->gradient.m, s->couple);
    return (fl_seen){.M = &r->M,
                     .o = r->o,
                     .places = s,
                     .q = q,
                     .scale = scale,
                     .energy = energy,
                     .slope = scale * (q->ddu - 0.5 * q->elastic * q->elastic / q->u)};
}

/* The places of `patch`: W = k sqrt(U), each with its share of dW/dU; t as in renew().  1 when they touch, 0
 * when nothing does, -1 when memory runs out. */
static int force_patch(fl_world *w, fl_pair *p, int32_t thread, const fl_told *t, const relative *r,
                       double dt, int survey)
{
    const fl_bodies *b = &w->b;
    const fl_mat3 R = r->R;
    fl_places *s = &w->scratch[thread];
    const int carried = p->law->surrogate > 0.0 && !fl_press_wants(w, p);
    if (s->n == 0) return 0;
    const fl_vec3 at = s->place[0].p, aj = m3_mul(R, at), ai = v3_add(aj, r->off);
    fl_bearing q;
    if (fl_bearing_sum(s, m3_tmul(R, approach(b, p, ai, aj)), m3_tmul(R, v3_sub(b->w[p->i], b->w[p->j])), &q))
        return -1;
    if (!(q.u > 0.0)) return 0;
    fl_seen seen = seen_of(p, s, r, &q);
    p->overlap = q.overlap;
    p->energy = seen.energy;
    const double chi = damping_factor(p, q.pressed > 0.0 ? q.met / q.pressed : 0.0);
    fl_bearing_damp(s, chi, &q);
    add_sum(&p->f, &p->ti, &p->tj, &q.gradient, seen.scale, &R, ai, aj);
    const fl_vec3 elastic = p->f;
    fl_stiff si, sj;
    fl_springs springs;
    if (survey || carried) fl_bearing_springs(s, &springs);
    survey |= carried && (!t || asks(w));
    if (survey) survey_patch(w, p, &springs, R, ai, aj, seen.scale, q.u, &si, &sj);
    if (t && fl_surrogate_nearly(p->surrogate, t) && fabs(seen.slope - t->slope) < 0.5 * t->slope)
        fl_tangent_remeasured(&p->slip, seen.slope / t->slope);
    const pressure all = bear(w, p, &q, seen.scale, seen.slope, chi, r, aj, dt);
    if (survey) stiffen(w, p, &all, r, &si, &sj);
    if (carried) {
        const double speed = v3_dot(v3_unit(elastic), approach(b, p, ai, aj));
        seen.springs = &springs;
        seen.radii = b->radius[p->i] + b->radius[p->j];
        /* the force that the energy of the motion would give, W growing as the square of it */
        seen.toward = sqrt(1.0 + 0.5 * p->mass * speed * speed / p->energy);
        seen.stiff_i = p->stiff_i, seen.stiff_j = p->stiff_j;
        if (renew(w, p, thread, t, &seen)) return -1;
    }
    p->energy += p->spring;
    if (fl_press_wants(w, p)) {
        for (int32_t k = 0; k < s->n; k++) s->place[k].closing = fl_bearing_closing(s, k);
        fl_press_note(w, p, s, seen.scale, chi);
    }
    return p->n = 1;
}

/* An elastic wall: force, moment and energy of Winkler's foundation under the part of A behind the wall, and
 * a dashpot at the centre of the pressure, which never pulls the body back into the wall.  The closing speed
 * of a point does not change along the normal, so the centre may stand behind the wall. */
static int force_bed(fl_world *w, fl_pair *p, const relative *r, double dt, int survey, double *distance)
{
    const fl_bodies *b = &w->b;
    const int32_t i = p->i;
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_vec3 n = m3_col(r->R, 2), up = m3_tmul(R, n);
    const double level = v3_dot(n, r->off); /* of the wall over the centre of A */
    const fl_hull *hull = &w->bed.hull[i];
    double low = INFINITY;
    for (int32_t v = 0; v < hull->p->nv; v++) low = fmin(low, v3_dot(up, hull->p->v[v]));
    *distance = low - level - hull->radius;
    if (*distance >= 0.0) return 0;
    fl_wet wet;
    fl_vec3 force, moment;
    fl_buoyancy(hull, up, level, &wet);
    if (wet.volume <= 0.0) return 0;
    p->energy = fl_buoyancy_force(&wet, up, level, w->bed.stiffness, &force, &moment);
    const fl_vec3 ai = m3_mul(R, wet.centre), aj = v3_sub(ai, r->off);
    const double closing = -v3_dot(n, approach(b, p, ai, aj)), elastic = w->bed.stiffness * wet.volume;
    double normal = elastic + w->bed.damping * wet.waterplane * closing;
    if (normal < 0.0) normal = 0.0;
    pressure all = {.slope = w->bed.stiffness * wet.waterplane, .at = aj};
    add_wrench(&p->f, &p->ti, &p->tj, v3_scale(normal, n), ai, aj);
    add_wrench(&p->fd, &p->di, &p->dj, v3_scale(normal - elastic, n), ai, aj);
    press(&all, elastic, normal, n, v3(0, 0, 0));
    rub(w, p, &all, 0.0, r, dt);
    if (survey) { /* the waterplane behind the wall turns with the body: as stiff as at its farthest point */
        fl_stiff si = {0}, sj = {0};
        fl_stiff_add(&si, b, i, all.slope, n, v3_cross(ai, n));
        stiffen(w, p, &all, r, &si, &sj);
    }
    p->energy += p->spring;
    return p->n = 1;
}

/* The manual's law: one contact, by the kind of the closest features. */
static int force_manual(fl_world *w, fl_pair *p, fl_places *s, const relative *r, double dt, int survey,
                        double *distance)
{
    const fl_bodies *b = &w->b;
    const fl_touching *law = p->law;
    const fl_poly *A = &b->core[p->i], *B = &b->core[p->j];
    const double ra = p->keep * b->radius[p->i], rb = p->keep * b->radius[p->j];
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
    const fl_vec3 nw = m3_mul(r->R, c.n), aj = m3_mul(r->R, c.p), ai = v3_add(aj, r->off);
    const fl_vec3 u = approach(b, p, ai, aj);
    const double closing = -v3_dot(nw, u);
    const double mass = law->literal2 && b->invm[p->j] > 0.0 ? b->m[p->i] + b->m[p->j] : p->mass;
    const double elastic = k * fl_normal_power(overlap, exponent);
    double normal = elastic + fl_manual_damping(k, exponent, overlap, mass, law->zeta, law->alpha, closing);
    if (normal < 0.0) normal = 0.0;
    const double slope = k * fl_normal_slope(overlap, exponent);
    pressure all = {.slope = slope, .at = aj};
    p->overlap = overlap;
    p->energy = k * fl_normal_phi(overlap, exponent);
    p->mode = c.mode;
    add_wrench(&p->f, &p->ti, &p->tj, v3_scale(normal, nw), ai, aj);
    add_wrench(&p->fd, &p->di, &p->dj, v3_scale(normal - elastic, nw), ai, aj);
    press(&all, elastic, normal, nw, v3(0, 0, 0));
    rub(w, p, &all, 0.0, r, dt);
    if (survey) stiffen_one(w, p, &all, nw, r);
    p->energy += p->spring;
    if (fl_press_wants(w, p)) fl_press_note_one(w, p, c.p, c.n, c.area);
    p->n = 1;
    return 0;
}

int fl_interact_apart(const fl_world *w, fl_near *q)
{
    const fl_bodies *b = &w->b;
    const int32_t i = q->i, j = q->j;
    const fl_poly *A = &b->core[i], *B = &b->core[j];
    const fl_piece *piece = piece_of(w, j);
    const double R = b->radius[i] + b->radius[j];
    fl_pair *const p = q->full; /* it has let go a moment ago */
    if ((p ? p->n || p->bond || !p->has_axis : !q->has_axis) || A->nv == 1 || B->nv == 1 ||
        (piece && piece->kind != FL_PIECE_SOLID) || fl_pairing_law(w, i, j)->kind != FL_LAW_PATCH)
        return 0;
    const fl_vec3 axis = p ? p->axis : v3(q->axis[0], q->axis[1], q->axis[2]),
                  n = m3_mul(fl_body_axes(b, j), axis);
    const double apart = -v3_dot(n, fl_world_way(w, i, j, q->image)),
                 distance = lowest(A->v, A->nv, m3_tmul(fl_body_axes(b, i), n)) + apart +
                            lowest(B->v, B->nv, v3_neg(axis));
    if (!(distance > believed(w, i, j) * R)) return 0;
    q->deep = 0;
    q->asleep = b->odometer[i] + b->odometer[j] + sleep_for(distance, R);
    if (!p) return 1;
    p->deep = 0;
    p->asleep = q->asleep;
    if (distance > FAR * R) fl_pair_end(p);
    return 1;
}

void fl_interact(fl_world *w, fl_pair *p, int32_t thread, double dt, int survey)
{
    const int known = fl_told_of(w, p);
    uint8_t done = 0;
    fl_told t;
    if (known) fl_told_touch(w, &p, 1, dt, survey, &done, &t);
    if (done) w->told[thread].told++;
    else fl_interact_look(w, p, thread, known ? &t : NULL, dt, survey);
}

void fl_interact_look(fl_world *w, fl_pair *p, int32_t thread, const fl_told *t, double dt, int survey)
{
    const fl_bodies *b = &w->b;
    const double path = b->odometer[p->i] + b->odometer[p->j];
    const double R = b->radius[p->i] + b->radius[p->j];
    const int first = p->bond && p->keep == 0.0 && p->n == 0; /* look since its bond ended */
    const relative r = relate(w, p);
    fl_places *s = &w->scratch[thread];
    double distance = 0.0;
    p->f = p->ti = p->tj = p->fd = p->di = p->dj = p->fs = p->si = p->sj = v3(0, 0, 0);
    p->energy = p->spring = p->overlap = p->stiff_i = p->stiff_j = 0.0;
    const fl_piece *piece = piece_of(w, p->j);
    const int manual = (p->law->kind == FL_LAW_MANUAL || p->law->kind == FL_LAW_MANUAL_SI) &&
                       (!piece || piece->kind == FL_PIECE_SOLID || piece->kind == FL_PIECE_CONE);
    if (piece && piece->elastic) {
        if (force_bed(w, p, &r, dt, survey, &distance)) return;
        distance += R; /* what sleeps is told by the distance of the cores */
    } else if (manual) {
        if (force_manual(w, p, s, &r, dt, survey, &distance)) goto failed;
        if (p->n) goto touches;
    } else {
        if (find_places(w, p, s, &w->near_shell[thread], &r, &distance)) goto failed;
        const int touch = p->exponent == 0.0 ? force_patch(w, p, thread, t, &r, dt, survey)
                                             : s->n && force_one(w, p, s, &r, dt, survey);
        if (touch < 0) goto failed;
        if (touch) goto touches;
    }
    p->slip = (fl_slip){0};
    p->n = 0;
    p->touch = 0.0;
    if (p->surrogate) p->surrogate->live = 0;
    if (p->bond && p->keep < 1.0) fl_frozen_return(w, p, R, distance);
    if (distance > FAR * R) fl_pair_end(p);
    p->asleep = path + sleep_for(distance, R);
    return;
touches:
    if (first) fl_frozen_meet(w, p);
    return;
failed:
#pragma omp atomic write
    w->failed = 1;
}

int fl_interact_again(fl_world *w, fl_pair *p, const fl_mat3 *M, fl_vec3 o)
{
    const relative r = {.M = *M, .o = o};
    fl_places *s = &w->scratch[0];
    double distance = 0.0;
    fl_bearing q;
    if (find_places(w, p, s, &w->near_shell[0], &r, &distance)) return -1;
    if (s->n == 0) return 0;
    if (fl_bearing_sum(s, v3(0, 0, 0), v3(0, 0, 0), &q)) return -1;
    if (!(q.u > 0.0)) return 0;
    fl_seen seen = seen_of(p, s, &r, &q);
    fl_springs springs;
    fl_bearing_springs(s, &springs);
    seen.springs = &springs;
    return fl_surrogate_fill(p->surrogate, &seen);
}

int fl_interact_probe(fl_world *w, const fl_pair *p, double reach, fl_contact *out)
{
    const fl_bodies *b = &w->b;
    const int32_t i = p->i, j = p->j;
    const fl_poly *A = &b->core[i], *B = &b->core[j];
    const relative r = relate(w, p);
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
    out->n = m3_mul(r.R, out->n);
    /* b->x[j] where j is no image: the bits of a scene without a cell */
    out->p = v3_add(w->cell.wraps ? v3_add(b->x[i], r.off) : b->x[j], m3_mul(r.R, out->p));
    out->p = fl_cell_inside(&w->cell, out->p);
    return out->gap < reach;
}
