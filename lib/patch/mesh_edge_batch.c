/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/mesh_edge_batch.h"
#include <math.h>
#include "base/array.h"
#include "geom/simd3.h"
#include "patch/edge_integral.h"

/* Edges of A over triangles, of A over edges, of B over edges. */
enum { OVER_FACE, OVER_EDGE, EDGE_OVER, KINDS };
enum { PLANES = 4 };

/* A plane as g.x - c with the feature on the positive side, and its fl_plane_tie_offset(). */
enum { GX, GY, GZ, C, OFFSET, NUMBERS };

struct fl_mesh_edge_four {
    double plane[PLANES][NUMBERS][FL_SIMD_WIDTH]; /* the last is that of the triangle */
    double from[3][FL_SIMD_WIDTH],
        to[3][FL_SIMD_WIDTH]; /* the edge of B: both ends, or start and unit vector */
    double factor[FL_SIMD_WIDTH], each[FL_SIMD_WIDTH]; /* of the own edge; 1/length of the other */
    int32_t end[2][FL_SIMD_WIDTH];                     /* of the edge of A */
    int32_t kind, n;
};

/* --- the list ------------------------------------------------------------------------------------------ */

static int batch_kind(int32_t head, int32_t sides)
{
    const int kind = fl_feature_row_kind(head), direction = fl_feature_row_direction(head);
    if (kind == FL_PAIR_EDGE_EDGE && sides <= PLANES) return direction == 0 ? OVER_EDGE : EDGE_OVER;
    return kind == FL_PAIR_EDGE_FACE && direction == 0 && sides == 3 ? OVER_FACE : KINDS;
}

/* An unused plane has g = 0 and the distance 1. */
static void set_plane(fl_mesh_edge_four *h, int32_t lane, int32_t k, const fl_core_plane *p, double sign)
{
    const fl_core_plane none = {{0.0, 0.0, 0.0}, -1.0}, *of = p ? p : &none;
    const double offset = fl_plane_tie_offset(of->g);
    const double all[NUMBERS] = {of->g.x, of->g.y, of->g.z, of->c, offset};
    for (int i = 0; i < NUMBERS; i++) h->plane[k][i][lane] = sign * all[i];
}

static void set_vector(double to[3][FL_SIMD_WIDTH], int32_t lane, fl_vec3 x)
{
    to[0][lane] = x.x, to[1][lane] = x.y, to[2][lane] = x.z;
}

static void set_pair(fl_mesh_edge_four *h, int32_t lane, const fl_feature_pairs *l, int32_t at,
                     const fl_patch_core *A, const fl_patch_core *B)
{
    const void *integers = fl_feature_pairs_integers(l);
    const int width = l->width;
    const int32_t head = fl_feature_integer(integers, width, at), n = fl_feature_row_sides(head),
                  direction = fl_feature_row_direction(head);
    const int32_t own = fl_feature_integer(integers, width, at + FL_ROW_OWN),
                  other = fl_feature_integer(integers, width, at + FL_ROW_OTHER);
    const int32_t last = at + fl_feature_row_fixed(fl_feature_row_kind(head));
    const fl_core_plane *cut = fl_feature_pairs_planes(l, direction);
    for (int32_t k = 0; k < PLANES; k++) {
        const int32_t side = k < n ? fl_feature_integer(integers, width, last + k) : 0;
        set_plane(h, lane, k, k < n ? &cut[side >> 1] : NULL, side & 1 ? -1.0 : 1.0);
    }
    const fl_edge a = A->p->edge[direction == 0 ? own : other];
    h->end[0][lane] = a.a, h->end[1][lane] = a.b;
    h->factor[lane] = fl_feature_pairs_numbers(l)[fl_feature_integer(integers, width, at + FL_ROW_FACTOR)];
    const int32_t more = fl_feature_integer(integers, width, last - 1);
    h->each[lane] = 0.0;
    if (h->kind == OVER_FACE) {
        set_plane(h, lane, PLANES - 1, &cut[more], 1.0);
        return;
    }
    const fl_edge b = B->p->edge[direction == 0 ? other : own];
    const fl_vec3 from = B->v[b.a], to = B->v[b.b];
    h->each[lane] = 1.0 / fl_feature_pairs_numbers(l)[more];
    set_vector(h->from, lane, from);
    set_vector(h->to, lane, h->kind == EDGE_OVER ? to : v3_scale(h->each[lane], v3_sub(to, from)));
}

int fl_mesh_edge_batch_list(fl_mesh_edge_batch *h, const fl_feature_pairs *l, const int32_t *row,
                            const fl_patch_core *A, const fl_patch_core *B, uint8_t *taken, uint8_t mark)
{
    const void *integers = fl_feature_pairs_integers(l);
    fl_err lost = {0};
    h->n = 0;
    for (int kind = 0; kind < KINDS; kind++) {
        int32_t lane = 0;
        for (int32_t k = 0; k < l->n; k++) {
            const int32_t head = fl_feature_integer(integers, l->width, row[k]);
            if (taken[k] || batch_kind(head, fl_feature_row_sides(head)) != kind) continue;
            if (lane == 0) {
                if (fl_grow(&h->four, &h->cap, (int64_t)h->n + 1, sizeof *h->four, &lost)) return -1;
                h->four[h->n++].kind = kind;
            }
            fl_mesh_edge_four *const four = &h->four[h->n - 1];
            for (int32_t i = lane; i < FL_SIMD_WIDTH; i++) set_pair(four, i, l, row[k], A, B);
            four->n = ++lane;
            lane %= FL_SIMD_WIDTH;
            taken[k] = mark;
        }
    }
    return 0;
}

void fl_mesh_edge_batch_free(fl_mesh_edge_batch *h)
{
    free(h->four);
    *h = (fl_mesh_edge_batch){0};
}

/* --- evaluation ----------------------------------------------------------------------------------------- */

FL_SIMD_INLINE void load_vertices(const fl_vec3 *x, const int32_t v[FL_SIMD_WIDTH], fl_simd3 *out)
{
    const fl_vec3 *const a = &x[v[0]], *const b = &x[v[1]], *const c = &x[v[2]], *const d = &x[v[3]];
    *out = (fl_simd3){{a->x, b->x, c->x, d->x}, {a->y, b->y, c->y, d->y}, {a->z, b->z, c->z, d->z}};
}

/* Points of B in the frame of A, with the operations of plane_distances.c. */
FL_SIMD_INLINE void to_frame_of_a(const fl_patch_points *w, fl_simd3 *x)
{
    const double(*m)[3] = w->M.m;
    const fl_simd3 r = {x->x - w->o.x, x->y - w->o.y, x->z - w->o.z};
    *x = (fl_simd3){m[0][0] * r.x + m[1][0] * r.y + m[2][0] * r.z,
                    m[0][1] * r.x + m[1][1] * r.y + m[2][1] * r.z,
                    m[0][2] * r.x + m[1][2] * r.y + m[2][2] * r.z};
}

/* The remaining part of the edge. */
typedef struct {
    fl_simd lo, hi;
    fl_simd_mask some;
} edge_part;

FL_SIMD_INLINE void clip_edge(edge_part *t, const fl_simd *h0, const fl_simd *h1)
{
    const fl_simd_mask in0 = *h0 >= 0.0, in1 = *h1 >= 0.0;
    const fl_simd at = *h0 / (*h0 - *h1);
    t->some &= in0 | in1;
    t->lo = FL_SIMD_SELECT(~in0 & in1 & (at > t->lo), at, t->lo);
    t->hi = FL_SIMD_SELECT(in0 & ~in1 & (at < t->hi), at, t->hi);
}

FL_SIMD_INLINE void plane_distance(const fl_mesh_edge_four *four, int k, const fl_simd3 *x, fl_simd *h)
{
    const double(*p)[FL_SIMD_WIDTH] = four->plane[k];
    *h = (FL_SIMD_LOAD(p[GX]) * x->x + FL_SIMD_LOAD(p[GY]) * x->y + FL_SIMD_LOAD(p[GZ]) * x->z -
          FL_SIMD_LOAD(p[C])) +
         FL_SIMD_LOAD(p[OFFSET]);
}

FL_SIMD_INLINE void clip_by_planes(const fl_mesh_edge_four *four, int planes, const fl_simd3 *x0,
                                   const fl_simd3 *x1, edge_part *t)
{
    const fl_simd zero = {0};
    *t = (edge_part){zero, 1.0 + zero, ~(fl_simd_mask){0}};
    FL_SIMD_UNROLL
    for (int k = 0; k < PLANES; k++) {
        fl_simd h0, h1;
        if (k == planes) break;
        plane_distance(four, k, x0, &h0), plane_distance(four, k, x1, &h1);
        clip_edge(t, &h0, &h1);
    }
}

/* Stores the part t of edges from x0 to x1; empty lanes get no part. */
FL_SIMD_INLINE void store_edges(const fl_mesh_edge_four *four, const fl_patch_core *own, const fl_simd3 *x0,
                                const fl_simd3 *x1, const edge_part *t, fl_edge_lanes *out)
{
    const fl_simd zero = {0};
    const fl_simd3 u = FL_SIMD3_SUB(*x1, *x0);
    fl_simd_mask there = t->some;
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) there[l] = l < four->n ? there[l] : 0;
    FL_SIMD3_STORE(out->x, *x0), FL_SIMD3_STORE(out->u, u);
    FL_SIMD_STORE(out->lo) = t->lo, FL_SIMD_STORE(out->hi) = FL_SIMD_SELECT(there, t->hi, t->lo);
    FL_SIMD_STORE(out->factor) = FL_SIMD_LOAD(four->factor);
    FL_SIMD_STORE(out->r) = own->r + zero, FL_SIMD_STORE(out->side) = own->side + zero;
}

FL_SIMD_VERSIONS static void prepare_over_faces(const fl_mesh_edge_four *four, const fl_patch_core *A,
                                                double depth_tol, fl_edge_face_lanes *out)
{
    fl_simd3 x0, x1;
    edge_part t;
    fl_simd h0, h1;
    load_vertices(A->v, four->end[0], &x0), load_vertices(A->v, four->end[1], &x1);
    clip_by_planes(four, PLANES - 1, &x0, &x1, &t);
    plane_distance(four, PLANES - 1, &x0, &h0), plane_distance(four, PLANES - 1, &x1, &h1);
    const fl_simd up0 = h0 + depth_tol, up1 = h1 + depth_tol;
    clip_edge(&t, &up0, &up1);
    store_edges(four, A, &x0, &x1, &t, &out->of);
    const fl_simd3 n = FL_SIMD3_LOAD(four->plane[PLANES - 1]);
    FL_SIMD3_STORE(out->n, n);
    FL_SIMD_STORE(out->h0) = h0, FL_SIMD_STORE(out->h1) = h1;
}

FL_SIMD_VERSIONS static void prepare_over_edges(const fl_mesh_edge_four *four, const fl_patch_points *w,
                                                const fl_patch_core *A, const fl_patch_core *B,
                                                fl_edge_point_lanes *out)
{
    const fl_simd zero = {0};
    const int from_a = four->kind == OVER_EDGE;
    const double small = FL_SAME_POINT_TOL * (from_a ? B : A)->p->size;
    fl_simd3 a0, a1, x0, x1, c, e;
    edge_part t;
    const fl_simd3 b0 = FL_SIMD3_LOAD(four->from), b1 = FL_SIMD3_LOAD(four->to);
    load_vertices(A->v, four->end[0], &a0), load_vertices(A->v, four->end[1], &a1);
    if (from_a) {
        x0 = a0, x1 = a1, c = b0, e = b1;
        clip_by_planes(four, PLANES, &x0, &x1, &t);
    } else {
        const fl_simd each = FL_SIMD_LOAD(four->each);
        const fl_simd3 direction = FL_SIMD3_SUB(a1, a0);
        fl_simd3 y0 = b0, y1 = b1;
        to_frame_of_a(w, &y0), to_frame_of_a(w, &y1);
        clip_by_planes(four, PLANES, &y0, &y1, &t);
        x0 = b0, x1 = b1, c = a0, e = (fl_simd3){each * direction.x, each * direction.y, each * direction.z};
    }
    store_edges(four, from_a ? A : B, &x0, &x1, &t, &out->of);
    FL_SIMD3_STORE(out->c, c), FL_SIMD3_STORE(out->e, e);
    FL_SIMD_STORE(out->small) = small + zero;
}

int fl_mesh_edge_batch_evaluate(const fl_mesh_edge_batch *h, fl_patch_points *w, const fl_patch_core *A,
                                const fl_patch_core *B, double R, double prism_depth)
{
    const double depth_tol = prism_depth + FL_SAME_POINT_TOL * B->p->size;
    for (int32_t k = 0; k < h->n; k++) {
        const fl_mesh_edge_four *four = &h->four[k];
        if (four->kind == OVER_FACE) {
            fl_edge_face_lanes q;
            prepare_over_faces(four, A, depth_tol, &q);
            if (fl_edge_integral_over_faces(w, &q, 1, R)) return -1;
        } else {
            fl_edge_point_lanes q;
            prepare_over_edges(four, w, A, B, &q);
            if (fl_edge_integral_over_points(w, &q, 1, R)) return -1;
        }
    }
    return 0;
}
