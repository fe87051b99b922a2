/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/mesh_under_face_clip.h"
#include <math.h>
#include "geom/quadrature_triangle.h"
#include "geom/quadrature_rules.h"

/* A corner of a triangle: x, y, s and D, which decides what of the triangle counts.  For a vertex h instead
 * of s. */
typedef fl_simd node;
enum { X, Y, H, S = H, D };

/* What of a queued triangle counts.
 *     ALL                       all of it
 *     IN, OUT                   the part with D >= 0; it holds the first corner only, or the two others
 *     IN_AT_SIDE, OUT_AT_SIDE   the same, the border D = 0 being a side of F: adds a side force
 *     RIM_STRIP                 the part 0 <= D <= rim, with the weight D/rim; both lines pass between the
 *                               first corner and the others: adds a side force
 *     FADING                    all of it with the weight D/rim: adds a side force */
enum { ALL, IN, OUT, IN_AT_SIDE, OUT_AT_SIDE, RIM_STRIP, FADING, QUEUES };

/* Most that one triangle adds to a queue.  F below: 2 triangles with s > 0, 3 of each over one of two sides,
 * 4 of each of those where both borders of the rim cut them.  F above: one of each.  A long queue leaves few
 * SIMD registers partly empty. */
enum { MAX_FROM_ONE = 2 * 3 * 4 + 2 * 3, QUEUE_SIZE = 14 * FL_SIMD_WIDTH };

/* kind: factor of the area seen from F, force over du, couple over u and over du along (turn[0], turn[1]).
 * turn[2], turn[3]: inward normal of the side. */
typedef struct {
    node corner[3], kind, turn;
} clip_triangle;

typedef struct {
    clip_triangle of[QUEUE_SIZE];
    int n;
} triangle_queue;

/* appended: entries since the queues were last summed */
typedef struct {
    triangle_queue of[QUEUES];
    int appended;
} triangle_queues;

/* Side forces and their moments, by lanes. */
typedef struct {
    fl_simd f[3], m[3];
} side_forces;

/* Sums over triangles: of s^4, s^3 and s^2; of s^3 times x, y, xx, xy, yy; of s^4 times 1, x, y, s without
 * the weight D/rim. */
typedef struct {
    fl_simd u, du, ddu, x, y, xx, xy, yy, p, px, py, ps;
} triangle_sums;

#define ADD_NODE(t, weight, S_, X_, Y_)                                                                      \
    do {                                                                                                     \
        const fl_simd p2_ = (weight) * ((S_) * (S_)), p3_ = p2_ * (S_), fx_ = p3_ * (X_), fy_ = p3_ * (Y_);  \
        (t)->ddu += p2_, (t)->du += p3_, (t)->u += p3_ * (S_);                                               \
        (t)->x += fx_, (t)->y += fy_;                                                                        \
        (t)->xx += fx_ * (X_), (t)->xy += fx_ * (Y_), (t)->yy += fy_ * (Y_);                                 \
    } while (0)

#define AREA(a, b, c) (0.5 * (((b)[X] - (a)[X]) * ((c)[Y] - (a)[Y]) - ((b)[Y] - (a)[Y]) * ((c)[X] - (a)[X])))

FL_SIMD_INLINE void add_full(triangle_sums *t, const fl_simd *p, const fl_simd *q, const fl_simd *r)
{
    const fl_simd turned = AREA(p, q, r), area = FL_SIMD_ABS(turned);
    fl_triangle_means k;
    fl_triangle_moments m;
    fl_triangle_means_of(&p[S], &q[S], &r[S], &k);
    fl_triangle_moments_of(&k, p, q, r, &m);
    t->ddu += area * k.s2, t->du += area * k.s3, t->u += area * k.s4;
    t->x += area * m.x, t->y += area * m.y, t->xx += area * m.xx, t->xy += area * m.xy, t->yy += area * m.yy;
}

/* Adds triangles with a weight that is linear, its values at the corners in share[]. */
FL_SIMD_INLINE void add_fading(triangle_sums *t, const fl_simd *a, const fl_simd *b, const fl_simd *c,
                               const fl_simd share[3])
{
    const fl_simd turned = AREA(a, b, c), area = FL_SIMD_ABS(turned);
    for (int k = 0; k < FL_TRIANGLE_NODES; k++) {
        const double b0 = FL_TRIANGLE_NODE[k][0], b1 = FL_TRIANGLE_NODE[k][1], b2 = FL_TRIANGLE_NODE[k][2];
        const fl_simd x = b0 * a[X] + b1 * b[X] + b2 * c[X], y = b0 * a[Y] + b1 * b[Y] + b2 * c[Y];
        const fl_simd s = b0 * a[S] + b1 * b[S] + b2 * c[S], w = FL_TRIANGLE_WEIGHT[k] * area;
        const fl_simd v = w * (b0 * share[0] + b1 * share[1] + b2 * share[2]), all = w * ((s * s) * (s * s));
        ADD_NODE(t, v, s, x, y);
        t->p += all, t->px += all * x, t->py += all * y, t->ps += all * s;
    }
}

/* x, y and s at the fraction `at` from a to b. */
FL_SIMD_INLINE void interpolate_corner(const fl_simd *a, const fl_simd *b, const fl_simd *at, fl_simd out[3])
{
    FL_SIMD_UNROLL
    for (int i = 0; i < 3; i++) out[i] = a[i] + *at * (b[i] - a[i]);
}

/* Adds the border of F over f along a side, from a to b: s^4 for each length that the side moves out across
 * n_f, at the point n_f h/c from the one below it on f. */
FL_SIMD_INLINE void add_side_border(const fl_under_face *g, const fl_simd *kind, const fl_simd *turn,
                                    const fl_simd *a, const fl_simd *b, side_forces *q)
{
    const fl_simd over = kind[1], nx = turn[1], ny = -turn[0], mx = turn[2], my = turn[3];
    const fl_simd slope = (nx * mx + ny * my) * over, gx = mx + slope * over * nx,
                  gy = my + slope * over * ny;
    const fl_simd dx = b[X] - a[X], dy = b[Y] - a[Y], s = a[S], z = b[S], s2 = s * s;
    fl_simd length = (dx * dx + dy * dy) / (gx * gx + gy * gy);
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) length[l] = sqrt(length[l]);
    const fl_simd all = kind[0] * length * (1.0 / 30.0);
    const fl_simd p = 6.0 * all * (s2 * s2 + z * (s2 * s + z * (s2 + z * (s + z)))),
                  far = all * (s2 * s2 + z * (2.0 * s2 * s + z * (3.0 * s2 + z * (4.0 * s + 5.0 * z))));
    const fl_simd x0 = a[X] + (g->R - s) * nx, y0 = a[Y] + (g->R - s) * ny;
    const fl_simd rx = p * x0 + far * (dx - (z - s) * nx), ry = p * y0 + far * (dy - (z - s) * ny);
    q->f[0] += p * mx, q->f[1] += p * my, q->f[2] += p * slope;
    q->m[0] += ry * slope, q->m[1] -= rx * slope, q->m[2] += rx * my - ry * mx;
}

/* *top rises to the largest s. */
#define RAISE_MAX(top, a) (*(top) = FL_SIMD_MAX((a)[S], *(top)))

/* Integrates four triangles of a queue, from `at` on; lanes beyond n count nothing.  The side force of a
 * weight d/rim is s^4/rim for each area, at the height R - s. */
FL_SIMD_INLINE void sum_four(const triangle_queue *b, int at, int what, const fl_under_face *g,
                             fl_under_face_sums *q, side_forces *pull, fl_simd *top)
{
    const fl_simd zero = {0}, one = 1.0 + zero;
    fl_simd c0[FL_SIMD_WIDTH], c1[FL_SIMD_WIDTH], c2[FL_SIMD_WIDTH], kind[FL_SIMD_WIDTH], turn[FL_SIMD_WIDTH];
    triangle_sums t = {zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) {
        const clip_triangle *e = &b->of[at + l < b->n ? at + l : at];
        c0[l] = e->corner[0], c1[l] = e->corner[1], c2[l] = e->corner[2], kind[l] = e->kind,
        turn[l] = e->turn;
    }
    fl_simd_transpose(c0), fl_simd_transpose(c1), fl_simd_transpose(c2);
    fl_simd_transpose(kind), fl_simd_transpose(turn);
    kind[0] = FL_SIMD_MASKED(FL_SIMD_MASK_BELOW(b->n - at), kind[0]);
    if (what == ALL || what == FADING) {
        RAISE_MAX(top, c0), RAISE_MAX(top, c1), RAISE_MAX(top, c2);
        if (what == ALL) add_full(&t, c0, c1, c2);
        else {
            const double each = 1.0 / g->rim;
            add_fading(&t, c0, c1, c2, (const fl_simd[3]){each * c0[D], each * c1[D], each * c2[D]});
        }
    } else {
        const fl_simd one1 = 1.0 / (c0[D] - c1[D]), one2 = 1.0 / (c0[D] - c2[D]);
        const fl_simd t1 = c0[D] * one1, t2 = c0[D] * one2;
        fl_simd p[3], r[3];
        interpolate_corner(c0, c1, &t1, p), interpolate_corner(c0, c2, &t2, r);
        RAISE_MAX(top, p), RAISE_MAX(top, r);
        if (what == RIM_STRIP) {
            const fl_simd in = c0[D] - g->rim, t3 = in * one1, t4 = in * one2;
            fl_simd v[3], w[3];
            interpolate_corner(c0, c1, &t3, v), interpolate_corner(c0, c2, &t4, w);
            RAISE_MAX(top, v), RAISE_MAX(top, w);
            add_fading(&t, p, v, w, (const fl_simd[3]){zero, one, one});
            add_fading(&t, p, w, r, (const fl_simd[3]){zero, one, zero});
        } else if (what == IN || what == IN_AT_SIDE) {
            RAISE_MAX(top, c0);
            add_full(&t, c0, p, r);
        } else {
            RAISE_MAX(top, c1), RAISE_MAX(top, c2);
            add_full(&t, p, c1, c2);
            add_full(&t, p, c2, r);
        }
        if (what == IN_AT_SIDE || what == OUT_AT_SIDE) add_side_border(g, kind, turn, p, r, pull);
    }
    const fl_simd share = kind[0], gain = kind[1], force = 4.0 * share * gain, u = share * t.u,
                  du = 4.0 * share * t.du;
    q->u += u, q->du += du, q->ddu += 12.0 * share * t.ddu;
    q->f += force * t.du, q->s += 4.0 * gain * u, q->x += force * t.x, q->y += force * t.y;
    q->xx += force * t.xx, q->xy += force * t.xy, q->yy += force * t.yy;
    const fl_simd couple = kind[2] * u + kind[3] * du;
    q->couple[0] += turn[0] * couple, q->couple[1] += turn[1] * couple;
    if (what != RIM_STRIP && what != FADING) return;
    const double each = 1.0 / g->rim;
    const fl_simd nx = each * share * turn[2], ny = each * share * turn[3], ph = g->R * t.p - t.ps;
    pull->f[0] += nx * t.p, pull->f[1] += ny * t.p;
    pull->m[0] -= ph * ny, pull->m[1] += ph * nx, pull->m[2] += t.px * ny - t.py * nx;
}

/* Integrates a queue four by four; with `last` set to its end, else the rest is moved to the front. */
FL_SIMD_INLINE void sum_queue(triangle_queue *b, int what, int last, const fl_under_face *g,
                              fl_under_face_sums *q, side_forces *pull, fl_simd *top)
{
    int i = 0;
    for (; i + FL_SIMD_WIDTH <= b->n || (last && i < b->n); i += FL_SIMD_WIDTH)
        sum_four(b, i, what, g, q, pull, top);
    if (i == 0) return;
    b->n = b->n > i ? b->n - i : 0;
    for (int l = 0; l < b->n; l++) b->of[l] = b->of[i + l];
}

/* Face f seen from F: its normal in the plane of F, and 1/c. */
typedef struct {
    node kind[2], turn; /* F over f, f over F */
    double nx, ny, over;
} facet_geometry;

FL_SIMD_INLINE void append_triangle(triangle_queues *to, int what, const node *c0, const node *c1,
                                    const node *c2, const node *kind, const node *turn)
{
    triangle_queue *const b = &to->of[what];
    clip_triangle *e = &b->of[b->n++];
    to->appended++;
    e->corner[0] = *c0, e->corner[1] = *c1, e->corner[2] = *c2, e->kind = *kind, e->turn = *turn;
}

/* Bit k is set where number k of three is not negative.  ODD: the number whose sign differs from the two
 * others. */
FL_SIMD_INLINE int sign_bits(double a, double b, double c)
{
    return (a >= 0.0) | (b >= 0.0) << 1 | (c >= 0.0) << 2;
}
static const int8_t ODD[8] = {0, 0, 1, 2, 2, 1, 0, 0}, NEXT[5] = {0, 1, 2, 0, 1};
#define ONLY_ONE(which) ((which) == 1 || (which) == 2 || (which) == 4)

/* Splits triangle p along the line where g = 0: parts with g >= 0 into `in`, the others into `out` unless
 * that is NULL; at most two triangles each. */
FL_SIMD_INLINE void split_triangle(const node p[3], const double g[3], node (*in)[3], int *inside,
                                   node (*out)[3], int *outside)
{
    const int which = sign_bits(g[0], g[1], g[2]), i = ODD[which], j = NEXT[i + 1], k = NEXT[i + 2];
    *inside = *outside = 0;
    if (which == 0 || which == 7) {
        node(*to)[3] = which ? in : out;
        if (to) to[0][0] = p[0], to[0][1] = p[1], to[0][2] = p[2];
        *(which ? inside : outside) = 1;
        return;
    }
    const node a = p[i], b = p[j], c = p[k];
    const node v = a + g[i] / (g[i] - g[j]) * (b - a), w = a + g[i] / (g[i] - g[k]) * (c - a);
    const int only = ONLY_ONE(which);
    node(*one)[3] = only ? in : out, (*two)[3] = only ? out : in;
    *(only ? inside : outside) = 1, *(only ? outside : inside) = 2;
    if (one) one[0][0] = a, one[0][1] = v, one[0][2] = w;
    if (two) two[0][0] = v, two[0][1] = b, two[0][2] = c, two[1][0] = v, two[1][1] = c, two[1][2] = w;
}

/* Appends the part D >= 0 of a triangle of f with s >= 0; its weight is D/rim where D < rim. */
FL_SIMD_INLINE void append_fading(const fl_under_face *g, const node p[3], const node *kind, const node *turn,
                                  triangle_queues *to)
{
    const double rim = g->rim, d[3] = {p[0][D], p[1][D], p[2][D]},
                 e[3] = {d[0] - rim, d[1] - rim, d[2] - rim};
    const int which = sign_bits(d[0], d[1], d[2]), deep = sign_bits(e[0], e[1], e[2]);
    if (which == 0) return;
    if (deep == 7) {
        append_triangle(to, ALL, &p[0], &p[1], &p[2], kind, turn);
        return;
    }
    if (which == deep) { /* both lines pass between the same corners */
        const int i = ODD[which], j = NEXT[i + 1], k = NEXT[i + 2];
        const node less = {0.0, 0.0, 0.0, rim}, a = p[i] - less, b = p[j] - less, c = p[k] - less;
        append_triangle(to, ONLY_ONE(which) ? IN : OUT, &a, &b, &c, kind, turn);
        append_triangle(to, RIM_STRIP, &p[i], &p[j], &p[k], kind, turn);
        return;
    }
    node over[2][3], in[2][3], out[2][3];
    int n, none, inside, outside;
    split_triangle(p, d, over, &n, NULL, &none);
    for (int m = 0; m < n; m++) {
        const node *r = over[m];
        split_triangle(r, (const double[3]){r[0][D] - rim, r[1][D] - rim, r[2][D] - rim}, in, &inside, out,
                       &outside);
        for (int k = 0; k < inside; k++)
            append_triangle(to, ALL, &in[k][0], &in[k][1], &in[k][2], kind, turn);
        for (int k = 0; k < outside; k++)
            append_triangle(to, FADING, &out[k][0], &out[k][1], &out[k][2], kind, turn);
    }
}

/* Appends the part D >= 0; of F over f, D = 0 is a side of F when is_side is set. */
FL_SIMD_INLINE void append_clipped(const node p[3], int is_side, const node *kind, const node *turn,
                                   triangle_queues *to)
{
    const int which = sign_bits(p[0][D], p[1][D], p[2][D]), i = ODD[which], j = NEXT[i + 1], k = NEXT[i + 2];
    if (which == 0) return;
    append_triangle(to, which == 7 ? ALL : (ONLY_ONE(which) ? IN : OUT) + (is_side ? IN_AT_SIDE - IN : 0),
                    &p[i], &p[j], &p[k], kind, turn);
}

/* Clips triangle p of f for one of the two integrals; D: distance within the first of the sides.
 *     below   1: f over F, 0: F over f */
FL_SIMD_INLINE void clip_one_way(const fl_under_face *g, const facet_geometry *f, int below,
                                 const fl_under_face_side *const m[2], int sides, const node p[3],
                                 triangle_queues *to)
{
    const node *kind = &f->kind[below];
    node overlapping[2][3];
    int n, none;
    split_triangle(p, (const double[3]){p[0][S], p[1][S], p[2][S]}, overlapping, &n, NULL, &none);
    for (int i = 0; i < n; i++) {
        if (sides == 1) {
            node turn = f->turn;
            turn[2] = m[0]->nx, turn[3] = m[0]->ny;
            if (below) append_fading(g, overlapping[i], kind, &turn, to);
            else append_clipped(overlapping[i], 1, kind, &turn, to);
            continue;
        }
        /* over two sides it is split where both are equally far, and each part lies over one side */
        node part[2][2][3];
        int parts[2];
        double e[3], far[3];
        for (int k = 0; k < 3; k++) {
            const node x = overlapping[i][k];
            far[k] = m[1]->nx * (x[X] - m[1]->x) + m[1]->ny * (x[Y] - m[1]->y);
            if (!below) far[k] += (f->nx * m[1]->nx + f->ny * m[1]->ny) * (g->R - x[S]);
            e[k] = far[k] - x[D];
        }
        split_triangle(overlapping[i], e, part[0], &parts[0], part[1], &parts[1]);
        for (int side = 0; side < 2; side++) {
            node turn = f->turn;
            turn[2] = m[side]->nx, turn[3] = m[side]->ny;
            for (int k = 0; k < parts[side]; k++) {
                node *const r = part[side][k];
                for (int v = 0; v < 3 && side; v++) {
                    r[v][D] = m[1]->nx * (r[v][X] - m[1]->x) + m[1]->ny * (r[v][Y] - m[1]->y);
                    if (!below) r[v][D] += (f->nx * m[1]->nx + f->ny * m[1]->ny) * (g->R - r[v][S]);
                }
                if (below) append_fading(g, r, kind, &turn, to);
                else append_clipped(r, 1, kind, &turn, to);
            }
        }
    }
}

/* Clips a facet triangle for both integrals. */
FL_SIMD_INLINE void clip_facet(const fl_under_face *g, const facet_geometry *f, const fl_under_face_cut *c,
                               const int32_t v[3], triangle_queues *to)
{
    const fl_under_face_side *const m[2] = {&g->side[c->sides ? c->side[0] : 0],
                                            &g->side[c->sides == 2 ? c->side[1] : 0]};
    const node below = {1.0, 1.0, -1.0, 0.0}, above = {1.0, 1.0, -f->over, 0.0};
    node p[3], q[3];
    if (c->sides == 0) { /* only s clips it */
        const node up = {0.0, 0.0, g->R, g->R};
        FL_SIMD_UNROLL
        for (int i = 0; i < 3; i++) {
            const node a = FL_SIMD_LOAD(&g->vertex[v[i]]), x = __builtin_shufflevector(a, a, X, Y, H, H);
            p[i] = x * __builtin_shufflevector(below, below, X, Y, H, H) + up;
            q[i] = x * __builtin_shufflevector(above, above, X, Y, H, H) + up;
        }
        append_clipped(p, 0, &f->kind[1], &f->turn, to);
        append_clipped(q, 0, &f->kind[0], &f->turn, to);
        return;
    }
    const double *const d = fl_under_face_inset(g, c->side[0], 0);
    const double slope = (f->nx * m[0]->nx + f->ny * m[0]->ny) * f->over;
    FL_SIMD_UNROLL
    for (int i = 0; i < 3; i++) {
        const node a = FL_SIMD_LOAD(&g->vertex[v[i]]);
        const double in = d[FL_SIMD_WIDTH * v[i]];
        p[i] = a * below + (node){0.0, 0.0, g->R, in};
        q[i] = a * above + (node){0.0, 0.0, g->R, in + slope * g->vertex[v[i]].h};
    }
    clip_one_way(g, f, 1, m, c->sides, p, to);
    clip_one_way(g, f, 0, m, c->sides, q, to);
}

FL_SIMD_VERSIONS void fl_under_face_sum_clipped(const fl_under_face *g, const fl_under_face_facet *facet,
                                                const int32_t *corner, const fl_vec3 *normal,
                                                const fl_under_face_cut *list, int32_t count,
                                                fl_under_face_sums *sum, fl_under_face_side_force *pull,
                                                double *most)
{
    triangle_queues to;
    const fl_simd zero = {0};
    fl_under_face_sums all = *sum;
    side_forces q = {{zero, zero, zero}, {zero, zero, zero}};
    fl_simd top = *most + zero;
    for (int k = 0; k < QUEUES; k++) to.of[k].n = 0;
    to.appended = 0;
    for (int32_t k = 0; k <= count; k++) {
        const int last = k == count;
        const fl_under_face_facet *t = &facet[list[last ? 0 : k].facet];
        const int32_t *at = corner + t->first, n = last ? 3 : t->n;
        facet_geometry f = {.over = 1.0};
        if (!last) {
            const fl_vec3 nf = normal[t->f];
            const double c = -v3_dot(g->n, nf), root = 4.0 * c * c - 3.0, over = 1.0 / c;
            const double m = 0.5 * root * root, part_m = 16.0 * c / root;
            f.nx = v3_dot(nf, g->x), f.ny = v3_dot(nf, g->y), f.over = over;
            f.kind[0] = (node){m * over, over, part_m - 4.0 * over, g->R * over};
            f.kind[1] = (node){m, 1.0, part_m + over, 0.0};
            f.turn = (node){-f.ny, f.nx, 0.0, 0.0}; /* n_F x n_f */
        }
        for (int32_t e = 2; e < n; e++) {
            if (!last) clip_facet(g, &f, &list[k], (const int32_t[3]){at[0], at[e - 1], at[e]}, &to);
            if (!last && to.appended <= QUEUE_SIZE - FL_SIMD_WIDTH - MAX_FROM_ONE) continue;
            to.appended = 0;
            sum_queue(&to.of[ALL], ALL, last, g, &all, &q, &top);
            sum_queue(&to.of[IN], IN, last, g, &all, &q, &top);
            sum_queue(&to.of[OUT], OUT, last, g, &all, &q, &top);
            sum_queue(&to.of[IN_AT_SIDE], IN_AT_SIDE, last, g, &all, &q, &top);
            sum_queue(&to.of[OUT_AT_SIDE], OUT_AT_SIDE, last, g, &all, &q, &top);
            sum_queue(&to.of[RIM_STRIP], RIM_STRIP, last, g, &all, &q, &top);
            sum_queue(&to.of[FADING], FADING, last, g, &all, &q, &top);
        }
    }
    *sum = all;
    pull->f = v3_add(pull->f, v3(fl_simd_sum(&q.f[0]), fl_simd_sum(&q.f[1]), fl_simd_sum(&q.f[2])));
    pull->m = v3_add(pull->m, v3(fl_simd_sum(&q.m[0]), fl_simd_sum(&q.m[1]), fl_simd_sum(&q.m[2])));
    for (int l = 0; l < FL_SIMD_WIDTH; l++) *most = top[l] > *most ? top[l] : *most;
}
