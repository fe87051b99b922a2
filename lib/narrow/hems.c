/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/hems.h"
#include <math.h>
#include "base/mem.h"
#include "narrow/roots.h"
#include "narrow/strips.h"

/* Edges of A over triangles, of A over edges, and of B over edges. */
enum { OVER_FACE, OVER_EDGE, EDGE_OVER, KINDS };
enum { PLANES = 4 };

/* A plane as it is asked about, above it; and its hair (meet.c). */
enum { GX, GY, GZ, C, HAIR, NUMBERS };

struct fl_hem {
    double plane[PLANES][NUMBERS][FL_LANES];   /* the last is that of the triangle */
    double from[3][FL_LANES], to[3][FL_LANES]; /* the edge of B: its ends, or its first and its direction */
    double factor[FL_LANES], each[FL_LANES];   /* of the own edge; 1/length of the other */
    int32_t end[2][FL_LANES];                  /* of the edge of A */
    int32_t kind, n;
};

/* --- the list ------------------------------------------------------------------------------------------ */

static int kind_of(int32_t head, int32_t sides)
{
    const int kind = fl_match_kind_of(head), way = fl_match_way(head);
    if (kind == FL_MATCH_EDGE_EDGE) return way == 0 ? OVER_EDGE : EDGE_OVER;
    return kind == FL_MATCH_EDGE_FACE && way == 0 && sides == 3 ? OVER_FACE : KINDS;
}

/* What asks for nothing has g = 0 and is always above. */
static void put_plane(fl_hem *h, int32_t lane, int32_t k, const fl_cut *p, double sign)
{
    const fl_cut none = {{0.0, 0.0, 0.0}, -1.0}, *of = p ? p : &none;
    const double hair = 1e-300 * (0.5772156649 * of->g.x + 0.4342944819 * of->g.y + 0.6931471806 * of->g.z);
    const double all[NUMBERS] = {of->g.x, of->g.y, of->g.z, of->c, hair};
    for (int i = 0; i < NUMBERS; i++) h->plane[k][i][lane] = sign * all[i];
}

static void put_vector(double to[3][FL_LANES], int32_t lane, fl_vec3 x)
{
    to[0][lane] = x.x, to[1][lane] = x.y, to[2][lane] = x.z;
}

static void put_match(fl_hem *h, int32_t lane, const fl_matches *l, int32_t at, const fl_side *A,
                      const fl_side *B)
{
    const void *whole = fl_matches_whole(l);
    const int wide = l->wide;
    const int32_t head = fl_matches_get(whole, wide, at), n = fl_match_sides(head), way = fl_match_way(head);
    const int32_t own = fl_matches_get(whole, wide, at + FL_MATCH_OWN),
                  other = fl_matches_get(whole, wide, at + FL_MATCH_OTHER);
    const int32_t last = at + fl_match_fixed(fl_match_kind_of(head));
    const fl_cut *cut = fl_matches_cuts(l, way);
    for (int32_t k = 0; k < PLANES; k++) {
        const int32_t side = k < n ? fl_matches_get(whole, wide, last + k) : 0;
        put_plane(h, lane, k, k < n ? &cut[side >> 1] : NULL, side & 1 ? -1.0 : 1.0);
    }
    const fl_edge a = A->p->edge[way == 0 ? own : other];
    h->end[0][lane] = a.a, h->end[1][lane] = a.b;
    h->factor[lane] = fl_matches_numbers(l)[fl_matches_get(whole, wide, at + FL_MATCH_FACTOR)];
    const int32_t more = fl_matches_get(whole, wide, last - 1);
    h->each[lane] = 0.0;
    if (h->kind == OVER_FACE) {
        put_plane(h, lane, PLANES - 1, &cut[more], 1.0);
        return;
    }
    const fl_edge b = B->p->edge[way == 0 ? other : own];
    const fl_vec3 from = B->v[b.a], to = B->v[b.b];
    h->each[lane] = 1.0 / fl_matches_numbers(l)[more];
    put_vector(h->from, lane, from);
    put_vector(h->to, lane, h->kind == EDGE_OVER ? to : v3_scale(h->each[lane], v3_sub(to, from)));
}

int fl_hems_list(fl_hems *h, const fl_matches *l, const int32_t *row, const fl_side *A, const fl_side *B,
                 uint8_t *taken, uint8_t mark)
{
    const void *whole = fl_matches_whole(l);
    fl_err lost = {0};
    h->n = 0;
    for (int kind = 0; kind < KINDS; kind++) {
        int32_t lane = 0;
        for (int32_t k = 0; k < l->n; k++) {
            const int32_t head = fl_matches_get(whole, l->wide, row[k]);
            if (taken[k] || kind_of(head, fl_match_sides(head)) != kind) continue;
            if (lane == 0) {
                if (fl_grow(&h->four, &h->cap, (int64_t)h->n + 1, sizeof *h->four, &lost)) return -1;
                h->four[h->n++].kind = kind;
            }
            fl_hem *const four = &h->four[h->n - 1];
            for (int32_t i = lane; i < FL_LANES; i++) put_match(four, i, l, row[k], A, B);
            four->n = ++lane;
            lane %= FL_LANES;
            taken[k] = mark;
        }
    }
    return 0;
}

void fl_hems_free(fl_hems *h)
{
    free(h->four);
    *h = (fl_hems){0};
}

/* --- where they are ------------------------------------------------------------------------------------ */

typedef struct {
    fl_wide x, y, z;
} point;

#define POINT(a) ((point){FL_FOUR((a)[0]), FL_FOUR((a)[1]), FL_FOUR((a)[2])})
#define LESS(a, b) ((point){(a).x - (b).x, (a).y - (b).y, (a).z - (b).z})
#define MORE(a, s, b) ((point){(a).x + (s) * (b).x, (a).y + (s) * (b).y, (a).z + (s) * (b).z})
#define DOT(a, b) ((a).x * (b).x + (a).y * (b).y + (a).z * (b).z)
#define LARGER(a, b) FL_WIDE_CHOOSE((a) > (b), a, b)

FL_WIDE_PART void look_up(const fl_vec3 *x, const int32_t v[FL_LANES], point *out)
{
    const fl_vec3 *const a = &x[v[0]], *const b = &x[v[1]], *const c = &x[v[2]], *const d = &x[v[3]];
    *out = (point){{a->x, b->x, c->x, d->x}, {a->y, b->y, c->y, d->y}, {a->z, b->z, c->z, d->z}};
}

/* Points of B in the frame of A, as meet.c has them. */
FL_WIDE_PART void turn_back(const fl_places *w, point *x)
{
    const double(*m)[3] = w->M.m;
    const point r = {x->x - w->o.x, x->y - w->o.y, x->z - w->o.z};
    *x = (point){m[0][0] * r.x + m[1][0] * r.y + m[2][0] * r.z, m[0][1] * r.x + m[1][1] * r.y + m[2][1] * r.z,
                 m[0][2] * r.x + m[1][2] * r.y + m[2][2] * r.z};
}

/* The part of the edge that is left. */
typedef struct {
    fl_wide lo, hi;
    fl_wide_mask some;
} part;

FL_WIDE_PART void keep(part *t, const fl_wide *h0, const fl_wide *h1)
{
    const fl_wide_mask in0 = *h0 >= 0.0, in1 = *h1 >= 0.0;
    const fl_wide at = *h0 / (*h0 - *h1);
    t->some &= in0 | in1;
    t->lo = FL_WIDE_CHOOSE(~in0 & in1 & (at > t->lo), at, t->lo);
    t->hi = FL_WIDE_CHOOSE(in0 & ~in1 & (at < t->hi), at, t->hi);
}

FL_WIDE_PART void height(const fl_hem *four, int k, const point *x, fl_wide *h)
{
    const double(*p)[FL_LANES] = four->plane[k];
    *h = (FL_FOUR(p[GX]) * x->x + FL_FOUR(p[GY]) * x->y + FL_FOUR(p[GZ]) * x->z - FL_FOUR(p[C])) +
         FL_FOUR(p[HAIR]);
}

FL_WIDE_PART void keep_beyond(const fl_hem *four, int planes, const point *x0, const point *x1, part *t)
{
    const fl_wide zero = {0};
    *t = (part){zero, 1.0 + zero, ~(fl_wide_mask){0}};
    FL_WIDE_UNROLL
    for (int k = 0; k < PLANES; k++) {
        fl_wide h0, h1;
        if (k == planes) break;
        height(four, k, x0, &h0), height(four, k, x1, &h1);
        keep(t, &h0, &h1);
    }
}

/* Of each, what its two places have: shares of U, and of each place its overlap and its point. */
typedef struct {
    double u[FL_LANES], du[FL_LANES], ddu[FL_LANES];
    double s[2][FL_LANES], p[2][3][FL_LANES];
    int64_t some[FL_LANES];
} pairs_of_places;

/* As fl_strips_over_face(). */
FL_WIDE_VERSIONS static void over_faces(const fl_hem *four, const fl_side *A, double R, double below,
                                        pairs_of_places *out)
{
    const fl_wide zero = {0};
    point x0, x1;
    part t;
    fl_wide h0, h1;
    look_up(A->v, four->end[0], &x0), look_up(A->v, four->end[1], &x1);
    keep_beyond(four, PLANES - 1, &x0, &x1, &t);
    height(four, PLANES - 1, &x0, &h0), height(four, PLANES - 1, &x1, &h1);
    const fl_wide up0 = h0 + below, up1 = h1 + below, s0 = R - h0, s1 = R - h1, dh = h1 - h0;
    keep(&t, &up0, &up1);
    keep(&t, &s0, &s1);
    const fl_wide from = R - h0 - t.lo * dh, to = R - h0 - t.hi * dh;
    fl_wide p = LARGER(from, zero), q = LARGER(to, zero);
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) p[l] = sqrt(p[l]);
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) q[l] = sqrt(q[l]);
    fl_roots sum;
    fl_roots_sum(&p, &q, &sum);
    const fl_wide both = p + q, over = 1.0 / both, dt = t.hi - t.lo,
                  share = FL_FOUR(four->factor) * dt * over, each = over / sum.du;
    const fl_wide mean = each * sum.first, square = each * over * sum.second - mean * mean;
    fl_wide spread = LARGER(square, zero);
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) spread[l] = sqrt(spread[l]);
    const fl_wide_mask some = t.some & (t.lo < t.hi) & (both > 0.0) & (sum.u > 0.0);
    const double(*plane)[FL_LANES] = four->plane[PLANES - 1];
    const point u = LESS(x1, x0), n = POINT(plane);
    FL_FOUR_INTO(out->u) = share * sum.u;
    FL_FOUR_INTO(out->du) = 4.5 * share * sum.du;
    FL_FOUR_INTO(out->ddu) = 15.75 * share * sum.ddu;
    FL_WIDE_UNROLL
    for (int k = 0; k < 2; k++) {
        const fl_wide at = t.lo + dt * (k ? mean + spread : mean - spread), s = R - h0 - at * dh;
        const fl_wide up = 0.5 * s - A->r;
        const point x = MORE(x0, at, u), y = MORE(x, up, n);
        FL_FOUR_INTO(out->s[k]) = s;
        FL_FOUR_INTO(out->p[k][0]) = y.x, FL_FOUR_INTO(out->p[k][1]) = y.y, FL_FOUR_INTO(out->p[k][2]) = y.z;
    }
    *(fl_wide_mask *)(void *)out->some = some;
}

static int faces(const fl_hem *four, fl_places *w, const fl_side *A, double R, double below)
{
    pairs_of_places q;
    over_faces(four, A, R, below, &q);
    for (int32_t l = 0; l < four->n; l++) {
        if (!q.some[l]) continue;
        const double(*g)[FL_LANES] = four->plane[PLANES - 1];
        const fl_vec3 n = {g[GX][l], g[GY][l], g[GZ][l]};
        for (int k = 0; k < 2; k++)
            if (fl_places_add(w, (fl_place){.stands = 2,
                                            .overlap = q.s[k][l],
                                            .u = q.u[l],
                                            .du = q.du[l],
                                            .ddu = q.ddu[l],
                                            .n = n,
                                            .across = n,
                                            .p = {q.p[k][0][l], q.p[k][1][l], q.p[k][2][l]}}))
                return -1;
    }
    return 0;
}

/* What is left of edges over edges: fl_strip_foot, by lanes. */
typedef struct {
    double lo[FL_LANES], hi[FL_LANES], m[FL_LANES], tau[FL_LANES], slope[FL_LANES], uu[FL_LANES],
        least2[FL_LANES];
    double q[3][FL_LANES], u[3][FL_LANES], c[3][FL_LANES], e[3][FL_LANES];
    int64_t some[FL_LANES];
} feet;

/* As fl_strips_over_point(), up to where the edge is nearest. */
FL_WIDE_VERSIONS static void over_edges(const fl_hem *four, const fl_places *w, const fl_side *A, double R,
                                        feet *out)
{
    point a0, a1, x0, x1, c, e;
    part t;
    const point b0 = POINT(four->from), b1 = POINT(four->to);
    look_up(A->v, four->end[0], &a0), look_up(A->v, four->end[1], &a1);
    if (four->kind == OVER_EDGE) {
        x0 = a0, x1 = a1, c = b0, e = b1;
        keep_beyond(four, PLANES, &x0, &x1, &t);
    } else {
        const fl_wide each = FL_FOUR(four->each);
        const point way = LESS(a1, a0);
        point y0 = b0, y1 = b1;
        turn_back(w, &y0), turn_back(w, &y1);
        keep_beyond(four, PLANES, &y0, &y1, &t);
        x0 = b0, x1 = b1, c = a0, e = (point){each * way.x, each * way.y, each * way.z};
    }
    const point q0 = LESS(x0, c), u0 = LESS(x1, x0);
    const fl_wide tau = DOT(q0, e), slope = DOT(u0, e), back = -tau, down = -slope;
    const point q1 = MORE(q0, back, e), u = MORE(u0, down, e);
    const fl_wide uu = DOT(u, u), foot = -DOT(q1, u) / uu, m = FL_WIDE_WHERE(uu > 0.0, foot);
    const point q = MORE(q1, m, u);
    const fl_wide least2 = DOT(q, q);
    *(fl_wide_mask *)(void *)out->some = t.some & (t.lo < t.hi) & (R * R - least2 > 0.0);
    FL_FOUR_INTO(out->lo) = t.lo - m, FL_FOUR_INTO(out->hi) = t.hi - m, FL_FOUR_INTO(out->m) = m;
    FL_FOUR_INTO(out->tau) = tau, FL_FOUR_INTO(out->slope) = slope;
    FL_FOUR_INTO(out->uu) = uu, FL_FOUR_INTO(out->least2) = least2;
    FL_FOUR_INTO(out->q[0]) = q.x, FL_FOUR_INTO(out->q[1]) = q.y, FL_FOUR_INTO(out->q[2]) = q.z;
    FL_FOUR_INTO(out->u[0]) = u.x, FL_FOUR_INTO(out->u[1]) = u.y, FL_FOUR_INTO(out->u[2]) = u.z;
    FL_FOUR_INTO(out->c[0]) = c.x, FL_FOUR_INTO(out->c[1]) = c.y, FL_FOUR_INTO(out->c[2]) = c.z;
    FL_FOUR_INTO(out->e[0]) = e.x, FL_FOUR_INTO(out->e[1]) = e.y, FL_FOUR_INTO(out->e[2]) = e.z;
}

#define LANE(a, l) v3((a)[0][l], (a)[1][l], (a)[2][l])

static int edges(const fl_hem *four, fl_places *w, const fl_side *A, const fl_side *B, double R)
{
    const int from_a = four->kind == OVER_EDGE;
    const double small = FL_SPAN_SAME * (from_a ? B : A)->p->size;
    feet f;
    over_edges(four, w, A, R, &f);
    for (int32_t l = 0; l < four->n; l++) {
        if (!f.some[l]) continue;
        const fl_strip_foot foot = {{f.lo[l], f.hi[l]}, f.m[l],       f.tau[l],    f.slope[l], f.uu[l],
                                    f.least2[l],        LANE(f.q, l), LANE(f.u, l)};
        const fl_vec3 c = LANE(f.c, l), e = LANE(f.e, l);
        if (fl_strips_at_foot(&(fl_line){.w = w, .own = from_a ? A : B, .factor = four->factor[l], .R = R},
                              &foot, c, &e, small))
            return -1;
    }
    return 0;
}

int fl_hems_places(const fl_hems *h, fl_places *w, const fl_side *A, const fl_side *B, double R,
                   double behind)
{
    const double below = behind + FL_SPAN_SAME * B->p->size;
    for (int32_t k = 0; k < h->n; k++) {
        const fl_hem *four = &h->four[k];
        if (four->kind == OVER_FACE ? faces(four, w, A, R, below) : edges(four, w, A, B, R)) return -1;
    }
    return 0;
}
