/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/hems.h"
#include <math.h>
#include "base/mem.h"
#include "geom/wide3.h"
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
    if (kind == FL_MATCH_EDGE_EDGE && sides <= PLANES) return way == 0 ? OVER_EDGE : EDGE_OVER;
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

FL_WIDE_PART void look_up(const fl_vec3 *x, const int32_t v[FL_LANES], fl_wide3 *out)
{
    const fl_vec3 *const a = &x[v[0]], *const b = &x[v[1]], *const c = &x[v[2]], *const d = &x[v[3]];
    *out = (fl_wide3){{a->x, b->x, c->x, d->x}, {a->y, b->y, c->y, d->y}, {a->z, b->z, c->z, d->z}};
}

/* Points of B in the frame of A, as meet.c has them. */
FL_WIDE_PART void turn_back(const fl_places *w, fl_wide3 *x)
{
    const double(*m)[3] = w->M.m;
    const fl_wide3 r = {x->x - w->o.x, x->y - w->o.y, x->z - w->o.z};
    *x = (fl_wide3){m[0][0] * r.x + m[1][0] * r.y + m[2][0] * r.z,
                    m[0][1] * r.x + m[1][1] * r.y + m[2][1] * r.z,
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

FL_WIDE_PART void height(const fl_hem *four, int k, const fl_wide3 *x, fl_wide *h)
{
    const double(*p)[FL_LANES] = four->plane[k];
    *h = (FL_FOUR(p[GX]) * x->x + FL_FOUR(p[GY]) * x->y + FL_FOUR(p[GZ]) * x->z - FL_FOUR(p[C])) +
         FL_FOUR(p[HAIR]);
}

FL_WIDE_PART void keep_beyond(const fl_hem *four, int planes, const fl_wide3 *x0, const fl_wide3 *x1, part *t)
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

/* Of edges from x0 to x1 the part t; one that is not there has none. */
FL_WIDE_PART void leave(const fl_hem *four, const fl_side *own, const fl_wide3 *x0, const fl_wide3 *x1,
                        const part *t, fl_strip_edges *out)
{
    const fl_wide zero = {0};
    const fl_wide3 u = FL_WIDE3_SUB(*x1, *x0);
    fl_wide_mask there = t->some;
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) there[l] = l < four->n ? there[l] : 0;
    FL_WIDE3_INTO(out->x, *x0), FL_WIDE3_INTO(out->u, u);
    FL_FOUR_INTO(out->lo) = t->lo, FL_FOUR_INTO(out->hi) = FL_WIDE_CHOOSE(there, t->hi, t->lo);
    FL_FOUR_INTO(out->factor) = FL_FOUR(four->factor);
    FL_FOUR_INTO(out->r) = own->r + zero, FL_FOUR_INTO(out->side) = own->side + zero;
}

FL_WIDE_VERSIONS static void over_faces(const fl_hem *four, const fl_side *A, double below,
                                        fl_strip_faces *out)
{
    fl_wide3 x0, x1;
    part t;
    fl_wide h0, h1;
    look_up(A->v, four->end[0], &x0), look_up(A->v, four->end[1], &x1);
    keep_beyond(four, PLANES - 1, &x0, &x1, &t);
    height(four, PLANES - 1, &x0, &h0), height(four, PLANES - 1, &x1, &h1);
    const fl_wide up0 = h0 + below, up1 = h1 + below;
    keep(&t, &up0, &up1);
    leave(four, A, &x0, &x1, &t, &out->of);
    const fl_wide3 n = FL_WIDE3(four->plane[PLANES - 1]);
    FL_WIDE3_INTO(out->n, n);
    FL_FOUR_INTO(out->h0) = h0, FL_FOUR_INTO(out->h1) = h1;
}

FL_WIDE_VERSIONS static void over_edges(const fl_hem *four, const fl_places *w, const fl_side *A,
                                        const fl_side *B, fl_strip_points *out)
{
    const fl_wide zero = {0};
    const int from_a = four->kind == OVER_EDGE;
    const double small = FL_SPAN_SAME * (from_a ? B : A)->p->size;
    fl_wide3 a0, a1, x0, x1, c, e;
    part t;
    const fl_wide3 b0 = FL_WIDE3(four->from), b1 = FL_WIDE3(four->to);
    look_up(A->v, four->end[0], &a0), look_up(A->v, four->end[1], &a1);
    if (from_a) {
        x0 = a0, x1 = a1, c = b0, e = b1;
        keep_beyond(four, PLANES, &x0, &x1, &t);
    } else {
        const fl_wide each = FL_FOUR(four->each);
        const fl_wide3 way = FL_WIDE3_SUB(a1, a0);
        fl_wide3 y0 = b0, y1 = b1;
        turn_back(w, &y0), turn_back(w, &y1);
        keep_beyond(four, PLANES, &y0, &y1, &t);
        x0 = b0, x1 = b1, c = a0, e = (fl_wide3){each * way.x, each * way.y, each * way.z};
    }
    leave(four, from_a ? A : B, &x0, &x1, &t, &out->of);
    FL_WIDE3_INTO(out->c, c), FL_WIDE3_INTO(out->e, e);
    FL_FOUR_INTO(out->small) = small + zero;
}

int fl_hems_places(const fl_hems *h, fl_places *w, const fl_side *A, const fl_side *B, double R,
                   double behind)
{
    const double below = behind + FL_SPAN_SAME * B->p->size;
    for (int32_t k = 0; k < h->n; k++) {
        const fl_hem *four = &h->four[k];
        if (four->kind == OVER_FACE) {
            fl_strip_faces q;
            over_faces(four, A, below, &q);
            if (fl_strips_of_faces(w, &q, 1, R)) return -1;
        } else {
            fl_strip_points q;
            over_edges(four, w, A, B, &q);
            if (fl_strips_of_points(w, &q, 1, R)) return -1;
        }
    }
    return 0;
}
