/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/footing.h"
#include <math.h>
#include <string.h>
#include "base/mem.h"
#include "base/wide.h"
#include "narrow/rules.h"
#include "narrow/strips.h"

#define PI 3.14159265358979323846

/* A feature of B under F; corners of faces and ends of edges are numbers of the footing's vertices. */
typedef struct {
    int32_t f, first, n; /* the face, its corners in corner[first .. first + n) */
    int32_t match[2];    /* F over f, f over F; -1 where it is not listed */
} tile;
typedef struct {
    int32_t v[2], match;
    double factor;
} strip;
typedef struct {
    int32_t v, match;
    double factor;
} point;

/* Where each of a face's features begin. */
typedef struct {
    int32_t F, tile, strip, point, vertex;
} foot;

struct fl_footing {
    foot *foot; /* [feet + 1] */
    tile *tile;
    strip *strip;
    point *point;
    int32_t *corner;
    int32_t *vertex; /* of B, ascending in each foot; padded there to full registers */
    double *x;       /* their coordinates: x, y and z of a register's worth, and so on */
    int32_t *row;    /* [matches] where each begins in the list */
    int32_t row_cap, feet, foot_cap, tile_cap, strip_cap, point_cap, corners, corner_cap, vertex_cap, x_cap;
};

/* A match under F. */
typedef struct {
    int32_t F, kind, own, way, match; /* kind 0: a face, 1: an edge, 2: a vertex; own: of B */
    double factor;                    /* of an edge */
} key;

static int key_order(const void *x, const void *y)
{
    const key *p = x, *q = y;
    if (p->F != q->F) return p->F < q->F ? -1 : 1;
    if (p->kind != q->kind) return p->kind < q->kind ? -1 : 1;
    if (p->own != q->own) return p->own < q->own ? -1 : 1;
    return p->way - q->way;
}

static int number_order(const void *x, const void *y)
{
    const int32_t a = *(const int32_t *)x, b = *(const int32_t *)y;
    return (a > b) - (a < b);
}

/* Place of v in the ascending list. */
static int32_t place_of(const int32_t *list, int32_t n, int32_t v)
{
    int32_t low = 0;
    while (n > 1) {
        const int32_t half = n / 2;
        if (list[low + half] <= v) low += half;
        n -= half;
    }
    return low;
}

/* The matches of faces, edges and corners of B with faces of A, by those faces; row: where each match
 * begins. */
static int32_t keys_of(const fl_matches *l, int32_t *row, key *out)
{
    int32_t n = 0;
    const void *whole = fl_matches_whole(l);
    int32_t at = fl_matches_begin(l);
    for (int32_t k = 0; k < l->n; k++, at = fl_match_next(whole, l->wide, at)) {
        const int32_t head = fl_matches_get(whole, l->wide, at), way = fl_match_way(head);
        const int32_t own = fl_matches_get(whole, l->wide, at + FL_MATCH_OWN);
        const int32_t other = fl_matches_get(whole, l->wide, at + FL_MATCH_OTHER);
        const int kind = fl_match_kind_of(head);
        row[k] = at;
        if (kind == FL_MATCH_FACE_FACE)
            out[n++] = way == 0 ? (key){own, 0, other, 0, k, 0.0} : (key){other, 0, own, 1, k, 0.0};
        else if (way == 1 && kind == FL_MATCH_VERTEX_FACE) out[n++] = (key){other, 2, own, 1, k, 0.0};
        else if (way == 1 && kind == FL_MATCH_EDGE_FACE) {
            const int32_t factor = fl_matches_get(whole, l->wide, at + FL_MATCH_FACTOR);
            out[n++] = (key){other, 1, own, 1, k, fl_matches_numbers(l)[factor]};
        }
    }
    return n;
}

/* Ends of an edge, a vertex, or the corners of a face. */
static int32_t vertices_of(const fl_poly *p, const key *k, int32_t *out)
{
    if (k->kind == 2) {
        out[0] = k->own;
        return 1;
    }
    if (k->kind == 1) {
        out[0] = p->edge[k->own].a, out[1] = p->edge[k->own].b;
        return 2;
    }
    const int32_t n = p->first[k->own + 1] - p->first[k->own];
    for (int32_t c = 0; c < n; c++) out[c] = p->loop[p->first[k->own] + c];
    return n;
}

typedef struct {
    fl_footing *o;
    const fl_matches *l;
    const fl_side *A, *B;
    int32_t tiles, strips, points, vertices;
} lister;

/* The vertices of the keys of one face, each once. */
static int list_vertices(lister *s, const key *k, int32_t n)
{
    fl_footing *o = s->o;
    const fl_poly *p = s->B->p;
    int64_t room = 0;
    fl_err lost = {0};
    for (int32_t c = 0; c < n; c++) room += k[c].kind == 0 ? p->first[k[c].own + 1] - p->first[k[c].own] : 2;
    if (fl_grow(&o->vertex, &o->vertex_cap, s->vertices + room + FL_LANES, sizeof *o->vertex, &lost))
        return -1;
    int32_t *list = o->vertex + s->vertices, m = 0, kept = 0;
    for (int32_t c = 0; c < n; c++) m += vertices_of(p, &k[c], list + m);
    qsort(list, (size_t)m, sizeof *list, number_order);
    for (int32_t c = 0; c < m; c++)
        if (kept == 0 || list[c] != list[kept - 1]) list[kept++] = list[c];
    while (kept % FL_LANES) list[kept] = list[kept - 1], kept++;
    if (fl_grow(&o->x, &o->x_cap, 3 * ((int64_t)s->vertices + kept), sizeof *o->x, &lost)) return -1;
    for (int32_t c = 0; c < kept; c++) {
        double *x = o->x + 3 * (int64_t)(s->vertices + c / FL_LANES * FL_LANES) + c % FL_LANES;
        const fl_vec3 v = s->B->v[list[c]];
        x[0] = v.x, x[FL_LANES] = v.y, x[2 * FL_LANES] = v.z;
    }
    s->vertices += kept;
    return 0;
}

static int list_tile(lister *s, const key *k, const int32_t *list, int32_t n)
{
    fl_footing *o = s->o;
    const fl_poly *p = s->B->p;
    const int32_t corners = p->first[k->own + 1] - p->first[k->own];
    fl_err lost = {0};
    if (fl_grow(&o->tile, &o->tile_cap, (int64_t)s->tiles + 1, sizeof *o->tile, &lost) ||
        fl_grow(&o->corner, &o->corner_cap, (int64_t)o->corners + corners, sizeof *o->corner, &lost))
        return -1;
    tile *t = &o->tile[s->tiles++];
    *t = (tile){k->own, o->corners, corners, {-1, -1}};
    t->match[k->way] = k->match;
    for (int32_t c = 0; c < corners; c++)
        o->corner[o->corners++] = place_of(list, n, p->loop[p->first[k->own] + c]);
    return 0;
}

/* One face of A: keys k[0 .. n). */
static int list_foot(lister *s, const key *k, int32_t n)
{
    fl_footing *o = s->o;
    const fl_poly *p = s->B->p;
    const int32_t from = s->vertices;
    fl_err lost = {0};
    if (fl_grow(&o->foot, &o->foot_cap, (int64_t)o->feet + 2, sizeof *o->foot, &lost)) return -1;
    o->foot[o->feet++] = (foot){k->F, s->tiles, s->strips, s->points, from};
    if (list_vertices(s, k, n)) return -1;
    const int32_t *list = o->vertex + from, all = s->vertices - from;
    for (int32_t c = 0; c < n; c++) {
        if (k[c].kind == 0) {
            if (c > 0 && k[c - 1].kind == 0 && k[c - 1].own == k[c].own)
                o->tile[s->tiles - 1].match[k[c].way] = k[c].match;
            else if (list_tile(s, &k[c], list, all)) return -1;
        } else if (k[c].kind == 1) {
            if (fl_grow(&o->strip, &o->strip_cap, (int64_t)s->strips + 1, sizeof *o->strip, &lost)) return -1;
            const fl_edge e = p->edge[k[c].own];
            o->strip[s->strips++] =
                (strip){{place_of(list, all, e.a), place_of(list, all, e.b)}, k[c].match, k[c].factor};
        } else {
            if (fl_grow(&o->point, &o->point_cap, (int64_t)s->points + 1, sizeof *o->point, &lost)) return -1;
            const double sharp = fmax(p->defect[k[c].own] * FL_PLACE_SHARP_CORNER, 0.0);
            o->point[s->points++] = (point){place_of(list, all, k[c].own), k[c].match,
                                            (sharp < 1.0 ? sharp : 1.0) * FL_PLACE_ROUND * (0.4 * PI) *
                                                fl_place_rho(s->B->r, s->A->r)};
        }
    }
    o->foot[o->feet] = (foot){-1, s->tiles, s->strips, s->points, s->vertices};
    return 0;
}

int fl_footing_list(fl_matches *l, const fl_side *A, const fl_side *B)
{
    fl_err lost = {0};
    if (!l->footing) l->footing = fl_alloc(1, sizeof *l->footing, &lost);
    key *k = fl_alloc(l->n, sizeof *k, &lost);
    int rc = l->footing && k && !fl_grow(&l->footing->row, &l->footing->row_cap, l->n, sizeof(int32_t), &lost)
                 ? 0
                 : -1;
    if (rc == 0) {
        lister s = {.o = l->footing, .l = l, .A = A, .B = B};
        const int32_t n = keys_of(l, l->footing->row, k);
        l->footing->feet = l->footing->corners = 0;
        if (n > 1) qsort(k, (size_t)n, sizeof *k, key_order);
        for (int32_t from = 0, to; from < n && rc == 0; from = to) {
            for (to = from + 1; to < n && k[to].F == k[from].F; to++) {}
            rc = list_foot(&s, k + from, to - from);
        }
    }
    free(k);
    return rc;
}

/* --- what lies under F now -------------------------------------------------------------------------------
 */

/* Of the width of the rim of F: what is nearer to a side than that is not told to be on one side of it. */
#define HAIR 1e-6
/* The same where the neighbour of F asks by itself, edges and corners: an edge that crosses a side between
 * two ends so far off it is cut by both within 1e-11 of its length in the same place. */
#define NEAR 1e-3

/* A side of F in its plane: a point and the inward unit normal. */
typedef struct {
    double x, y, nx, ny;
} side;

/* F: its plane, axes in it, and what is known of the vertices of the footing. */
typedef struct {
    fl_vec3 o, x, y, n;
    const side *sides;
    int32_t n_side;
    double rim;                /* width of the fading rim [m] */
    double *X, *Y, *h, *clear; /* [vertices] in the plane, above it, and from the nearest side of F [m] */
} ground;

FL_WIDE_VERSIONS static void survey(const ground *g, const double *x, int32_t vertices)
{
    for (int32_t v = 0; v < vertices; v += FL_LANES) {
        const double *at = x + 3 * (int64_t)v;
        const fl_wide rx = *(const fl_wide *)at - g->o.x, ry = *(const fl_wide *)(at + FL_LANES) - g->o.y;
        const fl_wide rz = *(const fl_wide *)(at + 2 * FL_LANES) - g->o.z;
        const fl_wide X = g->x.x * rx + g->x.y * ry + g->x.z * rz,
                      Y = g->y.x * rx + g->y.y * ry + g->y.z * rz;
        fl_wide clear = INFINITY + 0.0 * X;
        for (int32_t c = 0; c < g->n_side; c++) {
            const side s = g->sides[c];
            const fl_wide d = s.nx * (X - s.x) + s.ny * (Y - s.y);
            clear = FL_WIDE_CHOOSE(d < clear, d, clear);
        }
        *(fl_wide *)(g->X + v) = X;
        *(fl_wide *)(g->Y + v) = Y;
        *(fl_wide *)(g->h + v) = g->n.x * rx + g->n.y * ry + g->n.z * rz;
        *(fl_wide *)(g->clear + v) = clear;
    }
}

/* Triangles, or pieces of edges, until there are enough to fill a register.  Of a triangle the corners, of a
 * piece the first end, the way to the other, and the roots of s at both. */
typedef struct {
    fl_wide x[3], y[3], s[3];
    fl_wide share;      /* area times m; of an edge its factor over the sum of the roots */
    fl_wide gain;       /* force over du: 1, or 1/c */
    fl_wide a[2], b[2]; /* the couple is a u + b du, along x and y */
    int n;
} batch;

/* Sums of u, du and its derivative; of f = gain du and f times s and the places; and the couple. */
typedef struct {
    fl_wide u, du, ddu, f, s, x, y, xx, xy, yy, couple[2];
} sums;

/* Over triangles, for each of their area: of s^4, s^3, s^2, and of f = k s^3 times 1, x, y, xx, xy, yy. */
typedef struct {
    fl_wide u, du, ddu, f, x, y, xx, xy, yy;
} means;

/* The corners are c, the middle c[0] + c[1] + c[2] over 3, and node k of a triple with share a of two corners
 * and 1 - 2 a of the third at a (c[0] + c[1] + c[2]) + (1 - 3 a) c[k]. */
#define TRIPLE(a, sum, c) ((a) * (sum) + (1.0 - 3.0 * (a)) * (c))

#define ADD_MEAN(t, weight, S, K, X, Y)                                                                      \
    do {                                                                                                     \
        const fl_wide p2_ = (weight) * ((S) * (S)), p3_ = p2_ * (S), f_ = (K)*p3_, fx_ = f_ * (X),           \
                      fy_ = f_ * (Y);                                                                        \
        (t).ddu += p2_, (t).du += p3_, (t).u += p3_ * (S);                                                   \
        (t).f += f_, (t).x += fx_, (t).y += fy_;                                                             \
        (t).xx += fx_ * (X), (t).xy += fx_ * (Y), (t).yy += fy_ * (Y);                                       \
    } while (0)

/* Both ways at once: means of each, f of their sum. */
#define ADD_BOTH(p, q, weight, S, Z, K, L, X, Y)                                                             \
    do {                                                                                                     \
        const fl_wide p2_ = (weight) * ((S) * (S)), p3_ = p2_ * (S), q2_ = (weight) * ((Z) * (Z)),           \
                      q3_ = q2_ * (Z), f_ = (K)*p3_ + (L)*q3_, fx_ = f_ * (X), fy_ = f_ * (Y);               \
        (p).ddu += p2_, (p).du += p3_, (p).u += p3_ * (S);                                                   \
        (q).ddu += q2_, (q).du += q3_, (q).u += q3_ * (Z);                                                   \
        (p).f += f_, (p).x += fx_, (p).y += fy_;                                                             \
        (p).xx += fx_ * (X), (p).xy += fx_ * (Y), (p).yy += fy_ * (Y);                                       \
    } while (0)

static const double TRIPLE_SHARE[2] = {FL_TRIANGLE_A, FL_TRIANGLE_B};

FL_WIDE_VERSIONS static void take_triangles(batch *b, sums *q)
{
    for (int k = b->n; k < FL_LANES; k++) b->share[k] = 0.0;
    const fl_wide zero = {0}, *const x = b->x, *const y = b->y, *const s = b->s, gain = b->gain,
                  share = b->share;
    const fl_wide sx = x[0] + x[1] + x[2], sy = y[0] + y[1] + y[2], ss = s[0] + s[1] + s[2];
    const fl_wide mx = sx * (1.0 / 3.0), my = sy * (1.0 / 3.0), ms = ss * (1.0 / 3.0),
                  k3 = 4.0 * share * gain;
    means t = {zero, zero, zero, zero, zero, zero, zero, zero, zero};
    ADD_MEAN(t, FL_TRIANGLE_WEIGHT[0], ms, k3, mx, my);
    for (int c = 0; c < 2; c++) {
        const double a = TRIPLE_SHARE[c], w = FL_TRIANGLE_WEIGHT[1 + 3 * c];
        FL_WIDE_UNROLL
        for (int k = 0; k < 3; k++)
            ADD_MEAN(t, w, TRIPLE(a, ss, s[k]), k3, TRIPLE(a, sx, x[k]), TRIPLE(a, sy, y[k]));
    }
    const fl_wide u = share * t.u, du = 4.0 * share * t.du;
    q->u += u, q->du += du, q->ddu += 12.0 * share * t.ddu;
    q->f += t.f, q->s += 4.0 * gain * u, q->x += t.x, q->y += t.y, q->xx += t.xx, q->xy += t.xy,
        q->yy += t.yy;
    for (int k = 0; k < 2; k++) q->couple[k] += b->a[k] * u + b->b[k] * du;
    b->n = 0;
}

/* Numbers of four vertices: of corner c of each. */
#define FOUR_OF(a, v, c) ((fl_wide){(a)[(v)[0][c]], (a)[(v)[1][c]], (a)[(v)[2][c]], (a)[(v)[3][c]]})

/* Triangles, faces of B wholly under F and s > 0 both ways; list: their numbers. */
typedef struct {
    const int32_t *list;
    const tile *tile;
    const int32_t *corner;
    const fl_vec3 *n; /* normals of B */
    int32_t count;
    double R;
} tiling;

FL_WIDE_VERSIONS static void take_tiling(const ground *g, const tiling *o, sums *q)
{
    const double R = o->R;
    const fl_wide zero = {0};
    sums all = *q;
    for (int32_t from = 0; from < o->count; from += FL_LANES) {
        const int32_t *at[FL_LANES];
        const tile *t[FL_LANES];
        for (int l = 0; l < FL_LANES; l++) {
            t[l] = &o->tile[o->list[from + l < o->count ? from + l : from]];
            at[l] = o->corner + t[l]->first;
        }
        const fl_wide x0 = FOUR_OF(g->X, at, 0), x1 = FOUR_OF(g->X, at, 1), x2 = FOUR_OF(g->X, at, 2);
        const fl_wide y0 = FOUR_OF(g->Y, at, 0), y1 = FOUR_OF(g->Y, at, 1), y2 = FOUR_OF(g->Y, at, 2);
        const fl_wide h0 = FOUR_OF(g->h, at, 0), h1 = FOUR_OF(g->h, at, 1), h2 = FOUR_OF(g->h, at, 2);
        const fl_vec3 *const n0 = &o->n[t[0]->f], *const n1 = &o->n[t[1]->f], *const n2 = &o->n[t[2]->f],
                             *const n3 = &o->n[t[3]->f];
        const fl_wide nx = {n0->x, n1->x, n2->x, n3->x};
        const fl_wide ny = {n0->y, n1->y, n2->y, n3->y};
        const fl_wide nz = {n0->z, n1->z, n2->z, n3->z};
        const fl_wide c = -(g->n.x * nx + g->n.y * ny + g->n.z * nz), over = 1.0 / c;
        /* n_F x n_f along x and y */
        const fl_wide ax = -(g->y.x * nx + g->y.y * ny + g->y.z * nz),
                      ay = g->x.x * nx + g->x.y * ny + g->x.z * nz;
        const fl_wide root = 4.0 * c * c - 3.0, dm = 8.0 * c * root;
        fl_wide area = 0.5 * ((x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0));
        area = FL_WIDE_CHOOSE(area < 0.0, -area, area);
        for (int l = 0; l < FL_LANES; l++)
            if (from + l >= o->count) area[l] = 0.0;
        const fl_wide m = 0.5 * root * root, share = area * m, share_f = share * over;
        const fl_wide k3 = 4.0 * share, k3_f = 4.0 * share_f * over;
        const fl_wide s0 = R - h0, s1 = R - h1, s2 = R - h2, z0 = R - over * h0, z1 = R - over * h1,
                      z2 = R - over * h2;
        const fl_wide sx = x0 + x1 + x2, sy = y0 + y1 + y2, ss = s0 + s1 + s2, sz = z0 + z1 + z2;
        means p = {zero, zero, zero, zero, zero, zero, zero, zero, zero}, r = p;
        const fl_wide mx = sx * (1.0 / 3.0), my = sy * (1.0 / 3.0), ms = ss * (1.0 / 3.0),
                      mz = sz * (1.0 / 3.0);
        ADD_BOTH(p, r, FL_TRIANGLE_WEIGHT[0], ms, mz, k3, k3_f, mx, my);
        for (int i = 0; i < 2; i++) {
            const double a = TRIPLE_SHARE[i], w = FL_TRIANGLE_WEIGHT[1 + 3 * i];
            ADD_BOTH(p, r, w, TRIPLE(a, ss, s0), TRIPLE(a, sz, z0), k3, k3_f, TRIPLE(a, sx, x0),
                     TRIPLE(a, sy, y0));
            ADD_BOTH(p, r, w, TRIPLE(a, ss, s1), TRIPLE(a, sz, z1), k3, k3_f, TRIPLE(a, sx, x1),
                     TRIPLE(a, sy, y1));
            ADD_BOTH(p, r, w, TRIPLE(a, ss, s2), TRIPLE(a, sz, z2), k3, k3_f, TRIPLE(a, sx, x2),
                     TRIPLE(a, sy, y2));
        }
        const fl_wide u = share * p.u, v = share_f * r.u, du = 4.0 * share * p.du, dv = 4.0 * share_f * r.du;
        all.u += u + v, all.du += du + dv, all.ddu += 12.0 * (share * p.ddu + share_f * r.ddu);
        all.f += p.f, all.s += 4.0 * (u + over * v);
        all.x += p.x, all.y += p.y, all.xx += p.xx, all.xy += p.xy, all.yy += p.yy;
        /* over m: (dm + m/c) u; (dm - 4 m/c) v + (m R/c) dv */
        const fl_wide part = dm / m, turn = (part + over) * u + (part - 4.0 * over) * v + R * over * dv;
        all.couple[0] += ax * turn, all.couple[1] += ay * turn;
    }
    *q = all;
}

#define ADD_NODE(q, U, DU, DDU, F, S, X, Y)                                                                  \
    do {                                                                                                     \
        const fl_wide fx_ = (F) * (X), fy_ = (F) * (Y);                                                      \
        (q)->u += (U);                                                                                       \
        (q)->du += (DU);                                                                                     \
        (q)->ddu += (DDU);                                                                                   \
        (q)->f += (F);                                                                                       \
        (q)->s += (F) * (S);                                                                                 \
        (q)->x += fx_;                                                                                       \
        (q)->y += fy_;                                                                                       \
        (q)->xx += fx_ * (X);                                                                                \
        (q)->xy += fx_ * (Y);                                                                                \
        (q)->yy += fy_ * (Y);                                                                                \
    } while (0)

/* Node z of a piece where the root of s goes from p to q has the root r = p + (q - p) z at z (r + p)/(q + p)
 * of its length, as in strips.c. */
FL_WIDE_VERSIONS static void take_pieces(batch *b, sums *out)
{
    sums all = *out, *const q = &all;
    for (int k = b->n; k < FL_LANES; k++) b->share[k] = 0.0, b->s[0][k] = b->s[1][k] = 1.0;
    const fl_wide p = b->s[0], way = b->s[1] - p, over = 1.0 / (p + b->s[1]);
    for (int k = 0; k < FL_LINE_NODES; k++) {
        const double z = FL_LINE_NODE[k];
        const fl_wide r = p + way * z, at = z * (r + p) * over, s = r * r;
        const fl_wide c = FL_LINE_WEIGHT[k] * b->share * over * s * s * s, pull = 4.5 * c * s;
        ADD_NODE(q, c * s * s, pull, 15.75 * c, pull, s, b->x[0] + at * b->x[1], b->y[0] + at * b->y[1]);
    }
    *out = all;
    b->n = 0;
}

/* Edges of B within F and s > 0 at both ends, of which `list` has the numbers. */
typedef struct {
    const int32_t *list;
    const strip *strip;
    int32_t count;
    double R;
} lattice;

FL_WIDE_VERSIONS static void take_lattice(const ground *g, const lattice *o, sums *out)
{
    sums all = *out, *const q = &all;
    for (int32_t from = 0; from < o->count; from += FL_LANES) {
        const strip *e[FL_LANES];
        const int32_t *at[FL_LANES];
        for (int l = 0; l < FL_LANES; l++) {
            e[l] = &o->strip[o->list[from + l < o->count ? from + l : from]];
            at[l] = e[l]->v;
        }
        const fl_wide x0 = FOUR_OF(g->X, at, 0), x1 = FOUR_OF(g->X, at, 1);
        const fl_wide y0 = FOUR_OF(g->Y, at, 0), y1 = FOUR_OF(g->Y, at, 1);
        const fl_wide h0 = FOUR_OF(g->h, at, 0), h1 = FOUR_OF(g->h, at, 1);
        fl_wide factor = {e[0]->factor, e[1]->factor, e[2]->factor, e[3]->factor};
        for (int l = 0; l < FL_LANES; l++)
            if (from + l >= o->count) factor[l] = 0.0;
        fl_wide p = o->R - h0, r1 = o->R - h1;
        for (int l = 0; l < FL_LANES; l++) p[l] = sqrt(p[l]);
        for (int l = 0; l < FL_LANES; l++) r1[l] = sqrt(r1[l]);
        const fl_wide way = r1 - p, over = 1.0 / (p + r1), share = 2.0 * factor * over, dx = x1 - x0,
                      dy = y1 - y0;
        for (int k = 0; k < FL_LINE_NODES; k++) {
            const double z = FL_LINE_NODE[k];
            const fl_wide r = p + way * z, far = z * (r + p) * over, s = r * r;
            const fl_wide c = FL_LINE_WEIGHT[k] * share * s * s * s, pull = 4.5 * c * s;
            ADD_NODE(q, c * s * s, pull, 15.75 * c, pull, s, x0 + far * dx, y0 + far * dy);
        }
    }
    *out = all;
}

/* Triangles in the rim of F, where a share w of them counts that falls to 0 on the side with the inward
 * normal (mx, my). */
typedef struct {
    fl_wide x[3], y[3], s[3], w[3];
    fl_wide share, mx, my, a[2];
    int n;
} band;

/* Force on A of what moves with the sides of F, and its moment about the origin of the ground, along its x, y
 * and n. */
typedef struct {
    fl_vec3 f, m;
} pulls;

/* Moving a side by dx adds s^4 dx/rim at each point in the rim: there, at the height R - s. */
FL_WIDE_VERSIONS static void take_band(band *b, double R, double rim, sums *q, pulls *pull)
{
    fl_wide u = 0.0 * b->x[0], p = u, px = u, py = u, ps = u;
    for (int k = b->n; k < FL_LANES; k++) b->share[k] = 0.0;
    for (int k = 0; k < FL_TRIANGLE_NODES; k++) {
        const double b0 = FL_TRIANGLE_NODE[k][0], b1 = FL_TRIANGLE_NODE[k][1], b2 = FL_TRIANGLE_NODE[k][2];
        const fl_wide x = b0 * b->x[0] + b1 * b->x[1] + b2 * b->x[2];
        const fl_wide y = b0 * b->y[0] + b1 * b->y[1] + b2 * b->y[2];
        const fl_wide s = b0 * b->s[0] + b1 * b->s[1] + b2 * b->s[2];
        const fl_wide w = b0 * b->w[0] + b1 * b->w[1] + b2 * b->w[2];
        const fl_wide part = FL_TRIANGLE_WEIGHT[k] * b->share * s * s, all = part * s * s, part_w = part * w,
                      f = 4.0 * part_w * s;
        ADD_NODE(q, all * w, f, 12.0 * part_w, f, s, x, y);
        u += all * w;
        p += all;
        px += all * x;
        py += all * y;
        ps += all * s;
    }
    for (int k = 0; k < 2; k++) q->couple[k] += b->a[k] * u;
    const double each = 1.0 / rim;
    const fl_wide mx = each * b->mx, my = each * b->my, ph = R * p - ps;
    const fl_wide fx = mx * p, fy = my * p, tx = ph * my, ty = ph * mx, tz = px * my - py * mx;
    pull->f = v3_add(pull->f, v3(fl_wide_sum(&fx), fl_wide_sum(&fy), 0.0));
    pull->m = v3_add(pull->m, v3(-fl_wide_sum(&tx), fl_wide_sum(&ty), fl_wide_sum(&tz)));
    b->n = 0;
}

typedef struct {
    double x, y, s;
} corner;

/* What is common to the triangles of one face, one way. */
typedef struct {
    double share, gain, a[2], b[2];
} kind;

static void add_triangle(batch *b, sums *q, const kind *k, corner u, corner v, corner w)
{
    const double area = 0.5 * fabs((v.x - u.x) * (w.y - u.y) - (v.y - u.y) * (w.x - u.x));
    const corner t[3] = {u, v, w};
    const int n = b->n++;
    for (int c = 0; c < 3; c++) b->x[c][n] = t[c].x, b->y[c][n] = t[c].y, b->s[c][n] = t[c].s;
    b->share[n] = area * k->share;
    b->gain[n] = k->gain;
    for (int c = 0; c < 2; c++) b->a[c][n] = k->a[c], b->b[c][n] = k->b[c];
    if (n + 1 == FL_LANES) take_triangles(b, q);
}

static corner between(corner in, corner out)
{
    const double t = in.s / (in.s - out.s);
    return (corner){in.x + t * (out.x - in.x), in.y + t * (out.y - in.y), 0.0};
}

/* What of the triangle has s > 0. */
static void add_above(batch *b, sums *q, const kind *k, corner u, corner v, corner w)
{
    const int n = (u.s > 0.0) + (v.s > 0.0) + (w.s > 0.0);
    if (n == 0) return;
    if (n == 3) {
        add_triangle(b, q, k, u, v, w);
        return;
    }
    while (n == 1 ? !(u.s > 0.0) : u.s > 0.0) { /* the odd one first */
        const corner c = u;
        u = v, v = w, w = c;
    }
    if (n == 1) {
        add_triangle(b, q, k, u, between(u, v), between(u, w));
        return;
    }
    const corner uv = between(v, u), uw = between(w, u);
    add_triangle(b, q, k, uv, v, w);
    add_triangle(b, q, k, uv, w, uw);
}

typedef struct {
    fl_places *w;
    const fl_side *A, *B;
    const fl_footing *o;
    uint8_t *skip;
    ground g;
    double R, most;
    batch triangles, pieces;
    band bands;
    sums sum;
    pulls pull;
    int32_t *whole, *wholes; /* tiles and strips that need no cut */
    int32_t n_whole, n_wholes;
} work;

/* Where a sum bears and how it spreads: three places at x + a cos, y + b cos + c sin have its moments. */
typedef struct {
    double f, x, y, s, a, b, c;
} spread;

static spread spread_of(const sums *t)
{
    spread q = {.f = fl_wide_sum(&t->f)};
    if (!(q.f > 0.0)) return q;
    q.x = fl_wide_sum(&t->x) / q.f, q.y = fl_wide_sum(&t->y) / q.f, q.s = fl_wide_sum(&t->s) / q.f;
    const double xx = fl_wide_sum(&t->xx) / q.f - q.x * q.x, xy = fl_wide_sum(&t->xy) / q.f - q.x * q.y;
    const double yy = fl_wide_sum(&t->yy) / q.f - q.y * q.y;
    q.a = xx > 0.0 ? sqrt(2.0 * xx) : 0.0;
    q.b = q.a > 0.0 ? 2.0 * xy / q.a : 0.0;
    const double c2 = 2.0 * yy - q.b * q.b;
    q.c = c2 > 0.0 ? sqrt(c2) : 0.0;
    return q;
}

static fl_vec3 in_plane(const ground *g, double x, double y) { return v3_madd(v3_scale(x, g->x), y, g->y); }

/* What a feature by itself has given, where somebody asks. */
static int add_share(const work *q, const sums *t, int32_t n)
{
    fl_places *w = q->w;
    const ground *g = &q->g;
    const spread e = spread_of(t);
    fl_err lost = {0};
    if (!(e.f > 0.0)) return 0;
    if (fl_grow(&w->share, &w->share_cap, (int64_t)w->shares + 1, sizeof *w->share, &lost)) return -1;
    fl_share *share = &w->share[w->shares++];
    *share = (fl_share){.place = w->n,
                        .n = n,
                        .p = v3_add(v3_madd(g->o, q->R - e.s, g->n), in_plane(g, e.x, e.y)),
                        .force = e.f};
    if (n == 3) share->e1 = in_plane(g, e.a, e.b), share->e2 = in_plane(g, 0.0, e.c);
    else if (n == 2) /* along a line e.c is 0, or e.a and e.b are */
        share->e1 = v3_scale(sqrt(0.5), in_plane(g, e.a, e.a > 0.0 ? e.b : e.c));
    return 0;
}

/* Face f both ways: F over it, and it over F. */
static void pour(const work *q, const tile *t, const kind way[2], batch *b, sums *sum)
{
    const ground *g = &q->g;
    const int32_t *at = q->o->corner + t->first;
    for (int k = 0; k < 2; k++) {
        const double by = way[k].gain; /* 1/c, and 1 */
        corner first = {0}, last = {0};
        for (int32_t v = 0; v < t->n; v++) {
            const corner x = {g->X[at[v]], g->Y[at[v]], q->R - by * g->h[at[v]]};
            if (v == 0) first = x;
            else if (v > 1) add_above(b, sum, &way[k], first, last, x);
            last = x;
        }
    }
}

/* --- faces over a side of F --- */

/* A convex piece of a face as F sees it.  d: how far within a side of F. */
typedef struct {
    double x, y, s, d;
} spot;

enum { PIECE = 16, TILE = PIECE - 4 }; /* corners of a piece, and of a face that is cut: each cut adds one */

static spot part_way(const spot *a, const spot *b, double t)
{
    return (spot){a->x + t * (b->x - a->x), a->y + t * (b->y - a->y), a->s + t * (b->s - a->s),
                  a->d + t * (b->d - a->d)};
}

/* What has s >= 0. */
static int wet(const spot *p, int n, spot *out)
{
    int m = 0;
    for (int k = 0; k < n; k++) {
        const spot *a = &p[k], *b = &p[k + 1 < n ? k + 1 : 0];
        if (a->s >= 0.0) out[m++] = *a;
        if ((a->s >= 0.0) == (b->s >= 0.0)) continue;
        out[m] = part_way(a, b, a->s / (a->s - b->s));
        out[m++].s = 0.0;
    }
    return m;
}

/* What has d >= level, and what has not unless `out` is NULL; *cut: where in `in` the cut begins, -1: none.
 */
static int part_at(const spot *p, int n, double level, spot *in, spot *out, int *left, int *cut)
{
    int m = 0, l = 0;
    *cut = -1;
    for (int k = 0; k < n; k++) {
        const spot *a = &p[k], *b = &p[k + 1 < n ? k + 1 : 0];
        const double da = a->d - level, db = b->d - level;
        if (da >= 0.0) in[m++] = *a;
        else if (out) out[l++] = *a;
        if ((da >= 0.0) == (db >= 0.0)) continue;
        spot at = part_way(a, b, da / (da - db));
        at.d = level;
        if (da >= 0.0) *cut = m;
        in[m++] = at;
        if (out) out[l++] = at;
    }
    if (left) *left = l;
    return m;
}

static corner seen(const spot *p) { return (corner){p->x, p->y, p->s}; }

static void pour_fan(const spot *p, int n, const kind *way, batch *b, sums *sum)
{
    for (int k = 2; k < n; k++) add_triangle(b, sum, way, seen(&p[0]), seen(&p[k - 1]), seen(&p[k]));
}

/* Where sums go. */
typedef struct {
    batch *b;
    band *r;
    sums *sum;
    pulls *pull;
} basin;

static void pour_band(const work *q, const spot *p, int n, const kind *way, const side *m, const basin *to)
{
    band *const r = to->r;
    const double each = 1.0 / q->g.rim;
    for (int k = 2; k < n; k++) {
        const spot *t[3] = {&p[0], &p[k - 1], &p[k]};
        const int l = r->n++;
        for (int c = 0; c < 3; c++)
            r->x[c][l] = t[c]->x, r->y[c][l] = t[c]->y, r->s[c][l] = t[c]->s, r->w[c][l] = each * t[c]->d;
        r->share[l] =
            0.5 * way->share *
            fabs((t[1]->x - t[0]->x) * (t[2]->y - t[0]->y) - (t[1]->y - t[0]->y) * (t[2]->x - t[0]->x));
        r->mx[l] = m->nx, r->my[l] = m->ny;
        for (int c = 0; c < 2; c++) r->a[c][l] = way->a[c];
        if (l + 1 == FL_LANES) take_band(r, q->R, q->g.rim, to->sum, to->pull);
    }
}

/* A face f as it is seen from F: its normal there, and what its parts count for both ways. */
typedef struct {
    double nx, ny, c;
    kind way[2]; /* F over f, f over F */
} facet;

/* The side of F ends the part of F over f, along the line from a to b: s^4 for each length that it moves out
 * across n_f, where it is, (nx, ny) t from what is below it on f. */
static void pour_end(const work *q, const facet *f, const side *m, const spot *a, const spot *b, pulls *pull)
{
    const double over = 1.0 / f->c, slope = (f->nx * m->nx + f->ny * m->ny) * over;
    const double gx = m->nx + slope * over * f->nx, gy = m->ny + slope * over * f->ny;
    const double dx = b->x - a->x, dy = b->y - a->y, s = a->s, z = b->s, s2 = s * s;
    const double all = f->way[0].share * sqrt((dx * dx + dy * dy) / (gx * gx + gy * gy)) * (1.0 / 30.0);
    const double p = 6.0 * all * (s2 * s2 + z * (s2 * s + z * (s2 + z * (s + z)))),
                 far = all * (s2 * s2 + z * (2.0 * s2 * s + z * (3.0 * s2 + z * (4.0 * s + 5.0 * z))));
    const double x0 = a->x + (q->R - s) * f->nx, y0 = a->y + (q->R - s) * f->ny;
    const double rx = p * x0 + far * (dx - (z - s) * f->nx), ry = p * y0 + far * (dy - (z - s) * f->ny);
    pull->f = v3_add(pull->f, v3(p * m->nx, p * m->ny, p * slope));
    pull->m = v3_add(pull->m, v3(ry * slope, -rx * slope, rx * m->ny - ry * m->nx));
}

/* The piece p of f, s > 0, over side m of F, d being distances from it. */
static double pour_over_side(const work *q, const facet *f, const side *m, const spot *p, int n,
                             const basin *to)
{
    spot in[PIECE], out[PIECE], deep[PIECE];
    const double over = 1.0 / f->c, slope = (f->nx * m->nx + f->ny * m->ny) * over;
    int inside, outside, cut;
    double most = 0.0;
    /* f over F */
    inside = part_at(p, n, 0.0, in, NULL, NULL, &cut);
    for (int k = 0; k < inside; k++) most = in[k].s > most ? in[k].s : most;
    inside = part_at(in, inside, q->g.rim, deep, out, &outside, &cut);
    pour_fan(deep, inside, &f->way[1], to->b, to->sum);
    pour_band(q, out, outside, &f->way[1], m, to);
    /* F over f: d of what of F is above it along n_f */
    for (int k = 0; k < n; k++) {
        const double t = (q->R - p[k].s) * over;
        deep[k] = (spot){p[k].x, p[k].y, q->R - t, p[k].d + slope * (q->R - p[k].s)};
    }
    inside = part_at(deep, n, 0.0, in, NULL, NULL, &cut);
    if (cut >= 0) {
        spot a = in[cut], b = in[cut + 1 < inside ? cut + 1 : 0];
        if (a.s < 0.0 && b.s > 0.0) a = part_way(&a, &b, a.s / (a.s - b.s)), a.s = 0.0;
        else if (b.s < 0.0 && a.s > 0.0) b = part_way(&b, &a, b.s / (b.s - a.s)), b.s = 0.0;
        if (a.s > 0.0 || b.s > 0.0) pour_end(q, f, m, &a, &b, to->pull);
    }
    for (int k = 0; k < inside; k++) {
        if (in[k].s >= 0.0) {
            most = in[k].s > most ? in[k].s : most;
            continue;
        }
        inside = wet(in, inside, deep);
        pour_fan(deep, inside, &f->way[0], to->b, to->sum);
        return most;
    }
    pour_fan(in, inside, &f->way[0], to->b, to->sum);
    return most;
}

/* The piece p of f, s > 0, and the only side of F that it is over: 1; 0: there are more, or one that it
 * touches within a hair; -1: it is beyond a side. */
static int side_of(const ground *g, const facet *f, const spot *p, int n, double R, int32_t *only)
{
    const double over = 1.0 / f->c, hair = HAIR * g->rim;
    *only = -1;
    int found = 1;
    for (int32_t c = 0; c < g->n_side; c++) {
        const side m = g->sides[c];
        const double slope = (f->nx * m.nx + f->ny * m.ny) * over;
        double least = INFINITY, most = -INFINITY;
        int touches = 0;
        for (int k = 0; k < n; k++) {
            const double d = m.nx * (p[k].x - m.x) + m.ny * (p[k].y - m.y), e = d + slope * (R - p[k].s);
            const double inner = d - g->rim, lower = inner < e ? inner : e, upper = d > e ? d : e;
            least = lower < least ? lower : least;
            most = upper > most ? upper : most;
            touches |= fabs(e) < hair;
        }
        if (most <= -hair) return -1;
        if (least >= hair) continue;
        if (*only >= 0 || touches) found = 0;
        *only = c;
    }
    return found;
}

/* Face f of B over F, or both where it is over the one side of F; 0 when it is not, -1 when memory runs out.
 */
static int under(work *q, const tile *t)
{
    const ground *g = &q->g;
    const int32_t *at = q->o->corner + t->first;
    const fl_vec3 nf = q->B->n[t->f];
    const double c = -v3_dot(g->n, nf), root = 4.0 * c * c - 3.0;
    double clear = INFINITY, low = INFINITY, high = 0.0;
    for (int32_t k = 0; k < t->n; k++) {
        clear = g->clear[at[k]] < clear ? g->clear[at[k]] : clear;
        low = g->h[at[k]] < low ? g->h[at[k]] : low;
        high = g->h[at[k]] > high ? g->h[at[k]] : high;
    }
    if (low < 0.0) return 0;
    if (!(c > 0.0 && root > 0.0) || low >= q->R) return 1; /* nothing */
    const double m = 0.5 * root * root, dm = 8.0 * c * root, over = 1.0 / c;
    const fl_vec3 turn = v3_cross(g->n, nf);
    const double tx = v3_dot(turn, g->x) / m, ty = v3_dot(turn, g->y) / m;
    const double a0 = dm - 4.0 * m * over, b0 = m * q->R * over, a1 = dm + m * over;
    /* areas are those seen along n_F, and f has 1/c of them */
    const facet f = {
        v3_dot(nf, g->x),
        v3_dot(nf, g->y),
        c,
        {{m * over, over, {a0 * tx, a0 * ty}, {b0 * tx, b0 * ty}}, {m, 1.0, {a1 * tx, a1 * ty}, {0, 0}}}};
    const double in = clear - g->rim;
    if (in > 0.0 && c * c * in * in > (1.0 - c * c) * q->R * q->R) {
        if (q->R - low > q->most) q->most = q->R - low;
        if (t->n == 3 && over * high < q->R) q->whole[q->n_whole++] = (int32_t)(t - q->o->tile);
        else pour(q, t, f.way, &q->triangles, &q->sum);
        if (!q->w->apart) return 1;
        batch b = {.n = 0};
        sums own = {.u = {0}};
        pour(q, t, f.way, &b, &own);
        if (b.n) take_triangles(&b, &own);
        return add_share(q, &own, t->n == 3 ? 1 : 3) ? -1 : 1;
    }
    spot all[PIECE], dry[PIECE], *p = all;
    int n = t->n, deep = 1;
    int32_t only;
    if (n > TILE) return 0;
    for (int k = 0; k < n; k++) {
        all[k] = (spot){g->X[at[k]], g->Y[at[k]], q->R - g->h[at[k]], 0.0};
        deep &= all[k].s > 0.0;
    }
    if (!deep) n = wet(all, n, dry), p = dry;
    const int one = side_of(g, &f, p, n, q->R, &only);
    if (one <= 0) return one < 0;
    if (only < 0) only = 0;
    const side *m1 = &g->sides[only];
    for (int k = 0; k < n; k++) p[k].d = m1->nx * (p[k].x - m1->x) + m1->ny * (p[k].y - m1->y);
    const basin to = {&q->triangles, &q->bands, &q->sum, &q->pull};
    const double most = pour_over_side(q, &f, m1, p, n, &to);
    if (most > q->most) q->most = most;
    if (!q->w->apart) return 1;
    batch b = {.n = 0};
    band r = {.n = 0};
    sums own = {.u = {0}};
    pulls none = {0};
    const basin apart = {&b, &r, &own, &none};
    pour_over_side(q, &f, m1, p, n, &apart);
    if (b.n) take_triangles(&b, &own);
    if (r.n) take_band(&r, q->R, g->rim, &own, &none);
    return add_share(q, &own, 3) ? -1 : 1;
}

/* The part [lo, hi] of an edge. */
static void pour_strip(const work *q, const strip *e, fl_span t, double si, double sj, batch *b, sums *sum)
{
    const ground *g = &q->g;
    const int32_t i = e->v[0], j = e->v[1];
    const double dx = g->X[j] - g->X[i], dy = g->Y[j] - g->Y[i];
    const double lo = si + t.lo * (sj - si), hi = si + t.hi * (sj - si);
    const int n = b->n++;
    b->x[0][n] = g->X[i] + t.lo * dx, b->y[0][n] = g->Y[i] + t.lo * dy;
    b->x[1][n] = (t.hi - t.lo) * dx, b->y[1][n] = (t.hi - t.lo) * dy;
    b->s[0][n] = lo > 0.0 ? sqrt(lo) : 0.0;
    b->s[1][n] = hi > 0.0 ? sqrt(hi) : 0.0;
    b->share[n] = e->factor * 2.0 * (t.hi - t.lo);
    if (n + 1 == FL_LANES) take_pieces(b, sum);
}

/* Leave of t what is within the sides of F: 1; 0: nothing; -1: a side is too near an end to tell. */
static int within_sides(const ground *g, int32_t i, int32_t j, fl_span *t)
{
    const double near = NEAR * g->rim;
    int some = 1;
    if (g->clear[i] > near && g->clear[j] > near) return 1;
    for (int32_t c = 0; c < g->n_side; c++) {
        const side m = g->sides[c];
        const double a = m.nx * (g->X[i] - m.x) + m.ny * (g->Y[i] - m.y),
                     b = m.nx * (g->X[j] - m.x) + m.ny * (g->Y[j] - m.y);
        if (fabs(a) < near || fabs(b) < near) return -1;
        some = some && fl_span_keep(t, a, b);
    }
    return some;
}

static int strip_under(work *q, const strip *e)
{
    const ground *g = &q->g;
    const int32_t i = e->v[0], j = e->v[1];
    if (!(g->h[i] >= 0.0 && g->h[j] >= 0.0)) return 0;
    const double si = q->R - g->h[i], sj = q->R - g->h[j];
    if (!(si > 0.0 || sj > 0.0)) return 1;
    const double near = NEAR * g->rim;
    const int whole = g->clear[i] > near && g->clear[j] > near && si > 0.0 && sj > 0.0;
    if (whole && !q->w->apart) {
        q->wholes[q->n_wholes++] = (int32_t)(e - q->o->strip);
        return 1;
    }
    fl_span t = {si > 0.0 ? 0.0 : si / (si - sj), sj > 0.0 ? 1.0 : si / (si - sj)};
    const int in = within_sides(g, i, j, &t);
    if (in <= 0) return in == 0;
    if (!(si + t.lo * (sj - si) > 0.0 || si + t.hi * (sj - si) > 0.0)) return 1;
    if (whole) q->wholes[q->n_wholes++] = (int32_t)(e - q->o->strip);
    else pour_strip(q, e, t, si, sj, &q->pieces, &q->sum);
    if (!q->w->apart) return 1;
    batch b = {.n = 0};
    sums own = {.u = {0}};
    pour_strip(q, e, t, si, sj, &b, &own);
    take_pieces(&b, &own);
    return add_share(q, &own, 2) ? -1 : 1;
}

/* Into the first lane. */
static void pour_point(const work *q, const point *p, double s, sums *sum)
{
    const double x = q->g.X[p->v], y = q->g.Y[p->v], s3 = p->factor * s * s * s, f = 5.0 * s3 * s;
    sum->u[0] += s3 * s * s;
    sum->du[0] += f;
    sum->ddu[0] += 20.0 * s3;
    sum->f[0] += f;
    sum->s[0] += f * s;
    sum->x[0] += f * x, sum->y[0] += f * y;
    sum->xx[0] += f * x * x, sum->xy[0] += f * x * y, sum->yy[0] += f * y * y;
}

static int point_under(work *q, const point *p)
{
    const ground *g = &q->g;
    const double s = q->R - g->h[p->v];
    if (!(fabs(g->clear[p->v]) > NEAR * g->rim && g->h[p->v] >= 0.0)) return 0;
    if (!(g->clear[p->v] > 0.0 && s > 0.0)) return 1;
    pour_point(q, p, s, &q->sum);
    if (!q->w->apart) return 1;
    sums own = {.u = {0}};
    pour_point(q, p, s, &own);
    return add_share(q, &own, 1) ? -1 : 1;
}

/* Three places with the force, the moment and the spread of all: those of areas.h. */
static int put(work *q)
{
    static const double COS[3] = {1.0, -0.5, -0.5}, SIN[3] = {0.0, 0.86602540378443865, -0.86602540378443865};
    const ground *g = &q->g;
    const sums *t = &q->sum;
    const tiling floor = {q->whole, q->o->tile, q->o->corner, q->B->n, q->n_whole, q->R};
    const lattice lines = {q->wholes, q->o->strip, q->n_wholes, q->R};
    take_tiling(g, &floor, &q->sum);
    take_lattice(g, &lines, &q->sum);
    if (q->triangles.n) take_triangles(&q->triangles, &q->sum);
    if (q->pieces.n) take_pieces(&q->pieces, &q->sum);
    if (q->bands.n) take_band(&q->bands, q->R, g->rim, &q->sum, &q->pull);
    const spread e = spread_of(t);
    const double du = fl_wide_sum(&t->du);
    if (!(e.f > 0.0)) return 0;
    const fl_vec3 across = v3_neg(g->n), middle = v3_madd(g->o, q->R - 0.5 * e.s, g->n);
    for (int k = 0; k < 3; k++) {
        const double x = e.x + e.a * COS[k], y = e.y + e.b * COS[k] + e.c * SIN[k];
        if (fl_places_add(q->w, (fl_place){.stands = 3,
                                           .overlap = q->most,
                                           .u = fl_wide_sum(&t->u) / 3.0,
                                           .du = du / 3.0,
                                           .ddu = fl_wide_sum(&t->ddu) / 3.0,
                                           .n = v3_scale(e.f / du, across),
                                           .across = across,
                                           .p = v3_add(middle, in_plane(g, x, y))}))
            return -1;
    }
    q->w->couple = v3_madd(q->w->couple, fl_wide_sum(&t->couple[0]), g->x);
    q->w->couple = v3_madd(q->w->couple, fl_wide_sum(&t->couple[1]), g->y);
    const fl_vec3 pull = v3_madd(in_plane(g, q->pull.f.x, q->pull.f.y), q->pull.f.z, g->n);
    const double size = v3_norm(pull);
    if (!(size > 0.0)) return 0;
    q->w->couple = v3_add(q->w->couple, v3_madd(in_plane(g, q->pull.m.x, q->pull.m.y), q->pull.m.z, g->n));
    return fl_places_add(q->w, (fl_place){.du = size, .n = v3_scale(1.0 / size, pull), .p = g->o});
}

/* Of the rims of a polygon the widest that leaves each side half its length, rim at most: as in areas.c. */
static double rim_within(const side *s, const double *length, int32_t n, double rim)
{
    double last = 0.0, first = 0.0;
    for (int32_t c = 0; c <= n; c++) {
        const side u = s[c < n ? c : 0], v = s[c > 0 ? c - 1 : n - 1];
        const double turn = fabs(v.nx * u.ny - v.ny * u.nx) / (1.0 + (v.nx * u.nx + v.ny * u.ny));
        if (c == 0) first = turn;
        else {
            const double most = 0.5 * length[c - 1] / (last + (c < n ? turn : first));
            rim = rim < most ? rim : most;
        }
        last = turn;
    }
    return rim;
}

/* The plane of F, its sides and the vertices under it.  room: for the sides, their lengths and four numbers a
 * vertex. */
static void lay_ground(ground *g, const fl_side *A, int32_t F, const double *x, int32_t vertices, double rim,
                       double *room)
{
    const fl_poly *p = A->p;
    const int32_t *loop = p->loop + p->first[F], n = p->first[F + 1] - p->first[F];
    side *sides = (side *)(void *)room;
    double *length = room + 4 * (int64_t)n;
    g->n = A->n[F];
    g->o = A->v[loop[0]];
    g->x = v3_unit(v3_sub(A->v[loop[1]], g->o));
    g->y = v3_cross(g->n, g->x);
    for (int32_t c = 0; c < n; c++) {
        const fl_vec3 a = v3_sub(A->v[loop[c]], g->o),
                      e = v3_sub(A->v[loop[c + 1 < n ? c + 1 : 0]], A->v[loop[c]]);
        const double ex = v3_dot(g->x, e), ey = v3_dot(g->y, e), far = sqrt(ex * ex + ey * ey),
                     over = 1.0 / far;
        length[c] = far;
        sides[c] = (side){v3_dot(g->x, a), v3_dot(g->y, a), -over * ey, over * ex};
    }
    g->sides = sides;
    g->n_side = n;
    g->rim = rim_within(sides, length, n, rim);
    g->X = length + n;
    g->Y = g->X + vertices;
    g->h = g->Y + vertices;
    g->clear = g->h + vertices;
    survey(g, x, vertices);
}

static void mark(uint8_t *skip, int32_t match)
{
    if (match >= 0) skip[match] = 1;
}

int fl_footing_places(fl_places *w, const fl_matches *l, fl_footing_work *room, const fl_side *A,
                      const fl_side *B, double R, double rim, fl_matches *rest)
{
    const fl_footing *o = l->footing;
    fl_err lost = {0};
    *rest = *l;
    if (!o || o->feet == 0) return 0;
    if (fl_grow(&room->skip, &room->skip_cap, l->n, sizeof *room->skip, &lost) ||
        fl_grow(&room->left, &room->left_cap, l->n, sizeof *room->left, &lost))
        return -1;
    memset(room->skip, 0, (size_t)l->n);
    for (int32_t k = 0; k < o->feet; k++) {
        const foot *from = &o->foot[k], *to = from + 1;
        const int32_t vertices = to->vertex - from->vertex;
        const int64_t sides = A->p->first[from->F + 1] - A->p->first[from->F];
        if (fl_grow(&room->number, &room->number_cap, 5 * sides + 4 * vertices, sizeof *room->number, &lost))
            return -1;
        const int32_t tiles = to->tile - from->tile, strips = to->strip - from->strip;
        if (fl_grow(&room->whole, &room->whole_cap, (int64_t)tiles + strips, sizeof *room->whole, &lost))
            return -1;
        work q = {.w = w,
                  .A = A,
                  .B = B,
                  .o = o,
                  .skip = room->skip,
                  .R = R,
                  .whole = room->whole,
                  .wholes = room->whole + tiles};
        lay_ground(&q.g, A, from->F, o->x + 3 * (int64_t)from->vertex, vertices, rim, room->number);
        for (int32_t c = from->tile; c < to->tile; c++) {
            const int is = under(&q, &o->tile[c]);
            for (int way = 0; way < 2 && is > 0; way++) mark(q.skip, o->tile[c].match[way]);
            if (is < 0) return -1;
        }
        for (int32_t c = from->strip; c < to->strip; c++) {
            const int is = strip_under(&q, &o->strip[c]);
            if (is > 0) mark(q.skip, o->strip[c].match);
            if (is < 0) return -1;
        }
        for (int32_t c = from->point; c < to->point; c++) {
            const int is = point_under(&q, &o->point[c]);
            if (is > 0) mark(q.skip, o->point[c].match);
            if (is < 0) return -1;
        }
        if (put(&q)) return -1;
    }
    rest->choice = room->left;
    rest->chosen = 0;
    for (int32_t k = 0; k < l->n; k++)
        if (!room->skip[k]) room->left[rest->chosen++] = o->row[k];
    return 0;
}

void fl_footing_free(fl_footing *o)
{
    if (!o) return;
    free(o->foot), free(o->tile), free(o->strip), free(o->point), free(o->corner), free(o->vertex),
        free(o->x), free(o->row);
    free(o);
}

void fl_footing_work_free(fl_footing_work *room)
{
    free(room->number), free(room->skip), free(room->left), free(room->whole);
    *room = (fl_footing_work){0};
}
