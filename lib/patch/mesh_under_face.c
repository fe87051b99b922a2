/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/mesh_under_face.h"
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "patch/mesh_edge_batch.h"
#include "patch/mesh_under_face_clip.h"
#include "patch/edge_integral.h"
#include "patch/mesh_under_face_sum.h"
#include "patch/patch_law.h"

/* A feature of B under F.  Corners of faces and ends of edges are indices into the group's vertices. */
typedef fl_under_face_facet mesh_facet;
typedef fl_under_face_edge mesh_edge;
typedef fl_under_face_corner mesh_corner;

/* The features of B under one face F: where each kind begins. */
typedef struct {
    int32_t F, facet, edge, point, vertex, four, end;
} face_group;

enum { OF_EDGE_BATCH = 3 };

struct fl_mesh_under_face {
    face_group *group; /* [groups + 1] */
    mesh_facet *facet;
    mesh_edge *edge;
    mesh_corner *point;
    int32_t *corner;
    fl_under_face_facet_four *four; /* the facets by fours */
    int32_t *facet_corner;          /* indices of their corners */
    int32_t *end;                   /* indices of the ends of edges, by fours */
    int32_t *vertex;                /* of B, ascending in each group; padded there to full registers */
    double *x;                      /* their coordinates, by fours: x, y, z */
    int32_t *row;                   /* [pairs] where each row begins in the list */
    /* [pairs] 1 + direction where the pair is listed here, OF_EDGE_BATCH where it is in the batch, else 0 */
    uint8_t *state;
    fl_mesh_edge_batch edge_batch;
    int32_t *others; /* where the rows of all other pairs begin */
    int32_t *cut[2]; /* planes that the other pairs use, for each direction */
    int32_t planes[2], plane_cap[2], state_cap, other, others_cap;
    int32_t row_cap, groups, group_cap, facet_cap, edge_cap, point_cap, corners, corner_cap, vertex_cap,
        x_cap;
    int32_t fours, four_cap, facet_corners, facet_corner_cap, ends, end_cap;
};

/* A pair of F and a feature of B. */
typedef struct {
    int32_t F, kind, own, direction, pair; /* kind 0: a face, 1: an edge, 2: a vertex; own: feature of B */
    double factor;                         /* of an edge */
} pair_key;

static int compare_keys(const void *x, const void *y)
{
    const pair_key *p = x, *q = y;
    if (p->F != q->F) return p->F < q->F ? -1 : 1;
    if (p->kind != q->kind) return p->kind < q->kind ? -1 : 1;
    if (p->own != q->own) return p->own < q->own ? -1 : 1;
    return p->direction - q->direction;
}

static int compare_numbers(const void *x, const void *y)
{
    const int32_t a = *(const int32_t *)x, b = *(const int32_t *)y;
    return (a > b) - (a < b);
}

/* Index of v in an ascending list. */
static int32_t index_of(const int32_t *list, int32_t n, int32_t v)
{
    int32_t low = 0;
    while (n > 1) {
        const int32_t half = n / 2;
        if (list[low + half] <= v) low += half;
        n -= half;
    }
    return low;
}

/* True if face f of B reaches over three sides of face F of A as long as the list is valid: it would always
 * be left to face_integral.h. */
static int spans_three_sides(const fl_feature_pairs *l, const fl_patch_core *A, int32_t F,
                             const fl_patch_core *B, int32_t f)
{
    const int32_t *loop = A->p->loop + A->p->first[F], n = A->p->first[F + 1] - A->p->first[F];
    const int32_t *corner = B->p->loop + B->p->first[f], m = B->p->first[f + 1] - B->p->first[f];
    int over = 0;
    for (int32_t c = 0, a = loop[n - 1]; c < n && over < 3; a = loop[c++]) {
        const fl_vec3 in = v3_cross(A->n[F], v3_sub(A->v[loop[c]], A->v[a]));
        const double least = -l->margin * v3_norm(in);
        int32_t k = 0;
        while (k < m && v3_dot(in, v3_sub(B->v[corner[k]], A->v[a])) >= least) k++;
        over += k < m;
    }
    return over == 3;
}

/* Makes the keys of the pairs of faces, edges and corners of B with faces of A.  row: where each pair begins.
 */
static int32_t make_keys(const fl_feature_pairs *l, const fl_patch_core *A, const fl_patch_core *B,
                         int32_t *row, pair_key *out)
{
    int32_t n = 0;
    const void *integers = fl_feature_pairs_integers(l);
    int32_t at = fl_feature_pairs_first_row(l);
    for (int32_t k = 0; k < l->n; k++, at = fl_feature_row_next(integers, l->width, at)) {
        const int32_t head = fl_feature_integer(integers, l->width, at),
                      direction = fl_feature_row_direction(head);
        const int32_t own = fl_feature_integer(integers, l->width, at + FL_ROW_OWN);
        const int32_t other = fl_feature_integer(integers, l->width, at + FL_ROW_OTHER);
        const int kind = fl_feature_row_kind(head);
        row[k] = at;
        if (kind == FL_PAIR_FACE_FACE) {
            const pair_key f =
                direction == 0 ? (pair_key){own, 0, other, 0, k, 0.0} : (pair_key){other, 0, own, 1, k, 0.0};
            if (!spans_three_sides(l, A, f.F, B, f.own)) out[n++] = f;
        } else if (direction == 1 && kind == FL_PAIR_VERTEX_FACE)
            out[n++] = (pair_key){other, 2, own, 1, k, 0.0};
        else if (direction == 1 && kind == FL_PAIR_EDGE_FACE) {
            const int32_t factor = fl_feature_integer(integers, l->width, at + FL_ROW_FACTOR);
            out[n++] = (pair_key){other, 1, own, 1, k, fl_feature_pairs_numbers(l)[factor]};
        }
    }
    return n;
}

/* Lists the planes that the other pairs use. */
static int list_planes(fl_mesh_under_face *o, const fl_feature_pairs *l)
{
    const void *integers = fl_feature_pairs_integers(l);
    fl_err lost = {0};
    uint8_t *used = fl_alloc((int64_t)l->planes[0] + l->planes[1] + 1, sizeof *used, &lost);
    int rc = used ? 0 : -1;
    for (int direction = 0; direction < 2 && rc == 0; direction++)
        rc = fl_grow(&o->cut[direction], &o->plane_cap[direction], (int64_t)l->planes[direction] + 1,
                     sizeof(int32_t), &lost);
    for (int32_t k = 0; k < l->n && rc == 0; k++) {
        const int32_t head = fl_feature_integer(integers, l->width, o->row[k]),
                      direction = fl_feature_row_direction(head);
        const int kind = fl_feature_row_kind(head);
        const int plane =
            kind == FL_PAIR_VERTEX_FACE || kind == FL_PAIR_EDGE_FACE || kind == FL_PAIR_FACE_FACE;
        const int32_t from = o->row[k] + fl_feature_row_fixed(kind);
        if (o->state[k]) continue;
        for (int32_t c = -plane; c < fl_feature_row_sides(head); c++) {
            /* the plane of the face is the last of the fixed integers */
            const int32_t at = fl_feature_integer(integers, l->width, from + c);
            used[(direction ? l->planes[0] : 0) + (c < 0 ? at : at >> 1)] = 1;
        }
    }
    for (int direction = 0; direction < 2 && rc == 0; direction++) {
        o->planes[direction] = 0;
        for (int32_t k = 0; k < l->planes[direction]; k++)
            if (used[(direction ? l->planes[0] : 0) + k]) o->cut[direction][o->planes[direction]++] = k;
    }
    free(used);
    return rc;
}

/* Vertex, ends of the edge, or corners of the face of a key. */
static int32_t vertices_of_key(const fl_poly *p, const pair_key *k, int32_t *out)
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
    fl_mesh_under_face *o;
    const fl_feature_pairs *l;
    const fl_patch_core *A, *B;
    int32_t facets, edges, points, vertices;
} group_builder;

/* Lists the vertices of the keys of one face F, each once. */
static int list_vertices(group_builder *s, const pair_key *k, int32_t n)
{
    fl_mesh_under_face *o = s->o;
    const fl_poly *p = s->B->p;
    int64_t room = 0;
    for (int32_t c = 0; c < n; c++) room += k[c].kind == 0 ? p->first[k[c].own + 1] - p->first[k[c].own] : 2;
    if (fl_reserve(&o->vertex, &o->vertex_cap, s->vertices + room + FL_SIMD_WIDTH, sizeof *o->vertex))
        return -1;
    int32_t *list = o->vertex + s->vertices, m = 0, kept = 0;
    for (int32_t c = 0; c < n; c++) m += vertices_of_key(p, &k[c], list + m);
    qsort(list, (size_t)m, sizeof *list, compare_numbers);
    for (int32_t c = 0; c < m; c++)
        if (kept == 0 || list[c] != list[kept - 1]) list[kept++] = list[c];
    while (kept % FL_SIMD_WIDTH) list[kept] = list[kept - 1], kept++;
    if (fl_reserve(&o->x, &o->x_cap, 3 * ((int64_t)s->vertices + kept), sizeof *o->x)) return -1;
    for (int32_t c = 0; c < kept; c++) {
        double *x = o->x + 3 * (int64_t)(s->vertices + c / FL_SIMD_WIDTH * FL_SIMD_WIDTH) + c % FL_SIMD_WIDTH;
        const fl_vec3 v = s->B->v[list[c]];
        x[0] = v.x, x[FL_SIMD_WIDTH] = v.y, x[2 * FL_SIMD_WIDTH] = v.z;
    }
    s->vertices += kept;
    return 0;
}

static int list_facet(group_builder *s, const pair_key *k, const int32_t *list, int32_t n)
{
    fl_mesh_under_face *o = s->o;
    const fl_poly *p = s->B->p;
    const int32_t corners = p->first[k->own + 1] - p->first[k->own];
    if (fl_reserve(&o->facet, &o->facet_cap, (int64_t)s->facets + 1, sizeof *o->facet) ||
        fl_reserve(&o->corner, &o->corner_cap, (int64_t)o->corners + corners, sizeof *o->corner))
        return -1;
    mesh_facet *t = &o->facet[s->facets++];
    *t = (mesh_facet){k->own, o->corners, corners, {-1, -1}};
    t->pair[k->direction] = k->pair;
    for (int32_t c = 0; c < corners; c++)
        o->corner[o->corners++] = index_of(list, n, p->loop[p->first[k->own] + c]);
    return 0;
}

/* Groups the facets and edges of one face F by fours. */
static int list_fours(group_builder *s, const face_group *from)
{
    fl_mesh_under_face *o = s->o;
    for (int32_t c = from->facet; c < s->facets; c += FL_SIMD_WIDTH) {
        const mesh_facet *t[FL_SIMD_WIDTH];
        int32_t most = 0;
        for (int l = 0; l < FL_SIMD_WIDTH; l++) {
            t[l] = &o->facet[c + l < s->facets ? c + l : c];
            most = t[l]->n > most ? t[l]->n : most;
        }
        if (fl_reserve(&o->four, &o->four_cap, (int64_t)o->fours + 1, sizeof *o->four) ||
            fl_reserve(&o->facet_corner, &o->facet_corner_cap,
                       o->facet_corners + FL_SIMD_WIDTH * (int64_t)most, sizeof *o->facet_corner))
            return -1;
        fl_under_face_facet_four *const four = &o->four[o->fours++];
        four->first = o->facet_corners, four->most = most;
        for (int l = 0; l < FL_SIMD_WIDTH; l++) {
            const fl_vec3 n = s->B->n[t[l]->f];
            four->n[0][l] = n.x, four->n[1][l] = n.y, four->n[2][l] = n.z;
        }
        for (int32_t k = 0; k < most; k++)
            for (int l = 0; l < FL_SIMD_WIDTH; l++)
                o->facet_corner[o->facet_corners++] = o->corner[t[l]->first + (k < t[l]->n ? k : 0)];
    }
    for (int32_t c = from->edge; c < s->edges; c += FL_SIMD_WIDTH) {
        if (fl_reserve(&o->end, &o->end_cap, (int64_t)o->ends + 2 * FL_SIMD_WIDTH, sizeof *o->end)) return -1;
        for (int direction = 0; direction < 2; direction++)
            for (int l = 0; l < FL_SIMD_WIDTH; l++)
                o->end[o->ends++] = o->edge[c + l < s->edges ? c + l : c].v[direction];
    }
    return 0;
}

/* Lists the features under one face F: keys k[0 .. n). */
static int list_group(group_builder *s, const pair_key *k, int32_t n)
{
    fl_mesh_under_face *o = s->o;
    const fl_poly *p = s->B->p;
    const int32_t from = s->vertices;
    if (fl_reserve(&o->group, &o->group_cap, (int64_t)o->groups + 2, sizeof *o->group)) return -1;
    o->group[o->groups++] = (face_group){k->F, s->facets, s->edges, s->points, from, o->fours, o->ends};
    if (list_vertices(s, k, n)) return -1;
    const int32_t *list = o->vertex + from, all = s->vertices - from;
    for (int32_t c = 0; c < n; c++) {
        if (k[c].kind == 0) {
            if (c > 0 && k[c - 1].kind == 0 && k[c - 1].own == k[c].own)
                o->facet[s->facets - 1].pair[k[c].direction] = k[c].pair;
            else if (list_facet(s, &k[c], list, all)) return -1;
        } else if (k[c].kind == 1) {
            if (fl_reserve(&o->edge, &o->edge_cap, (int64_t)s->edges + 1, sizeof *o->edge)) return -1;
            const fl_edge e = p->edge[k[c].own];
            o->edge[s->edges++] =
                (mesh_edge){{index_of(list, all, e.a), index_of(list, all, e.b)}, k[c].pair, k[c].factor};
        } else {
            if (fl_reserve(&o->point, &o->point_cap, (int64_t)s->points + 1, sizeof *o->point)) return -1;
            const double weight = fmax(fl_poly_corner_angle(p, k[c].own) * FL_PATCH_CORNER_WEIGHT, 0.0);
            o->point[s->points++] = (mesh_corner){index_of(list, all, k[c].own), k[c].pair,
                                                  (weight < 1.0 ? weight : 1.0) * FL_PATCH_ROUND_FACTOR *
                                                      (0.4 * PI) * fl_patch_feature_radius(s->B->r, s->A->r)};
        }
    }
    if (list_fours(s, &o->group[o->groups - 1])) return -1;
    o->group[o->groups] = (face_group){-1, s->facets, s->edges, s->points, s->vertices, o->fours, o->ends};
    return 0;
}

int fl_mesh_under_face_list(fl_feature_pairs *l, const fl_patch_core *A, const fl_patch_core *B)
{
    fl_err lost = {0};
    if (!l->under_face) l->under_face = fl_alloc(1, sizeof *l->under_face, &lost);
    fl_mesh_under_face *const o = l->under_face;
    pair_key *k = fl_alloc(l->n, sizeof *k, &lost);
    int rc = o && k && !fl_grow(&o->row, &o->row_cap, l->n, sizeof *o->row, &lost) &&
                     !fl_grow(&o->state, &o->state_cap, l->n, sizeof *o->state, &lost) &&
                     !fl_grow(&o->others, &o->others_cap, l->n, sizeof *o->others, &lost)
                 ? 0
                 : -1;
    if (rc == 0) {
        group_builder s = {.o = o, .l = l, .A = A, .B = B};
        const int32_t n = make_keys(l, A, B, o->row, k);
        for (int32_t c = 0; c < l->n; c++) o->state[c] = 0;
        for (int32_t c = 0; c < n; c++) o->state[k[c].pair] = (uint8_t)(1 + k[c].direction);
        o->groups = o->corners = o->other = o->fours = o->facet_corners = o->ends = 0;
        rc = fl_mesh_edge_batch_list(&o->edge_batch, l, o->row, A, B, o->state, OF_EDGE_BATCH);
        for (int32_t c = 0; c < l->n; c++)
            if (!o->state[c]) o->others[o->other++] = o->row[c];
        if (n > 1) qsort(k, (size_t)n, sizeof *k, compare_keys);
        for (int32_t from = 0, to; from < n && rc == 0; from = to) {
            for (to = from + 1; to < n && k[to].F == k[from].F; to++) {}
            rc = list_group(&s, k + from, to - from);
        }
        if (rc == 0) rc = list_planes(o, l);
    }
    free(k);
    return rc;
}

/* --- evaluation ----------------------------------------------------------------------------------------- */

typedef struct {
    fl_patch_points *w;
    const fl_patch_core *A, *B;
    const fl_mesh_under_face *o;
    fl_mesh_under_face_work *room;
    int32_t pairs; /* listed */
    int open;      /* room->skipped is in use */
    fl_under_face g;
    fl_under_face_sums sum;
    fl_under_face_side_force pull;
    fl_under_face_sorted face;
    double most; /* the largest s */
} evaluation;

/* Leaves a pair to the caller. */
static void skip_pair(evaluation *q, int32_t pair)
{
    if (pair < 0) return;
    if (!q->open) memset(q->room->skipped, 0, (size_t)q->pairs);
    q->open = 1;
    q->room->skipped[pair] = 1;
}

/* Centre and second moments of a sum: three points at x + a cos, y + b cos + c sin have the same. */
typedef struct {
    double f, x, y, s, a, b, c;
} sum_spread;

static sum_spread spread_of_sums(const fl_under_face_sums *t)
{
    sum_spread q = {.f = fl_simd_sum(&t->f)};
    if (!(q.f > 0.0)) return q;
    q.x = fl_simd_sum(&t->x) / q.f, q.y = fl_simd_sum(&t->y) / q.f, q.s = fl_simd_sum(&t->s) / q.f;
    const double xx = fl_simd_sum(&t->xx) / q.f - q.x * q.x, xy = fl_simd_sum(&t->xy) / q.f - q.x * q.y;
    const double yy = fl_simd_sum(&t->yy) / q.f - q.y * q.y;
    q.a = xx > 0.0 ? sqrt(2.0 * xx) : 0.0;
    q.b = q.a > 0.0 ? 2.0 * xy / q.a : 0.0;
    const double c2 = 2.0 * yy - q.b * q.b;
    q.c = c2 > 0.0 ? sqrt(c2) : 0.0;
    return q;
}

static fl_vec3 vector_in_plane(const fl_under_face *g, double x, double y)
{
    return v3_madd(v3_scale(x, g->x), y, g->y);
}

/* Adds the contribution of one feature, where w->keep_features is set. */
static int add_feature(const evaluation *q, const fl_under_face_sums *t, int32_t n)
{
    fl_patch_points *w = q->w;
    const fl_under_face *g = &q->g;
    const sum_spread e = spread_of_sums(t);
    if (!(e.f > 0.0)) return 0;
    if (fl_reserve(&w->feature, &w->feature_cap, (int64_t)w->features + 1, sizeof *w->feature)) return -1;
    fl_patch_feature *share = &w->feature[w->features++];
    *share = (fl_patch_feature){.first_point = w->n,
                                .n = n,
                                .p = v3_add(v3_madd(g->o, g->R - e.s, g->n), vector_in_plane(g, e.x, e.y)),
                                .force = e.f};
    if (n == 3) share->e1 = vector_in_plane(g, e.a, e.b), share->e2 = vector_in_plane(g, 0.0, e.c);
    else if (n == 2) /* along a line e.c is 0, or e.a and e.b are */
        share->e1 = v3_scale(sqrt(0.5), vector_in_plane(g, e.a, e.a > 0.0 ? e.b : e.c));
    return 0;
}

/* Add the contribution of each feature separately, where w->keep_features is set. */
static int add_faces(const evaluation *q, const mesh_facet *facets)
{
    const fl_under_face_sorted *f = &q->face;
    for (int32_t k = 0; k < f->wholes + f->cuts; k++) {
        const int whole = k < f->wholes;
        const fl_under_face_cut cut =
            whole ? (fl_under_face_cut){.facet = f->whole[k]} : f->cut[k - f->wholes];
        fl_under_face_sums own = {.u = {0}};
        fl_under_face_side_force none = {0};
        double most = 0.0;
        fl_under_face_sum_clipped(&q->g, facets, q->o->corner, q->B->n, &cut, 1, &own, &none, &most);
        if (add_feature(q, &own, whole ? 1 : 3)) return -1;
    }
    return 0;
}

static int add_edges(const evaluation *q, int32_t pieces)
{
    for (int32_t k = 0; k < pieces; k++) {
        double most = 0.0;
        fl_under_face_sums own = {.u = {0}};
        fl_under_face_sum_edges(&q->g, &q->room->edge_part[k], 1, &own, &most);
        if (add_feature(q, &own, 2)) return -1;
    }
    return 0;
}

static int add_corners(const evaluation *q, const mesh_corner *p, const int32_t *list, int32_t n)
{
    for (int32_t k = 0; k < n; k++) {
        double most = 0.0;
        fl_under_face_sums own = {.u = {0}};
        fl_under_face_sum_corners(&q->g, p, &list[k], 1, &own, &most);
        if (add_feature(q, &own, 1)) return -1;
    }
    return 0;
}

/* Three points with the force, the moment and the spread of the sum, as those of face_integral.h; and the
 * force that moves with the sides. */
static int make_points(evaluation *q)
{
    static const double COS[3] = {1.0, -0.5, -0.5}, SIN[3] = {0.0, 0.86602540378443865, -0.86602540378443865};
    const fl_under_face *g = &q->g;
    const fl_under_face_sums *t = &q->sum;
    const sum_spread e = spread_of_sums(t);
    const double du = fl_simd_sum(&t->du);
    if (!(e.f > 0.0)) return 0;
    const fl_vec3 across = v3_neg(g->n), middle = v3_madd(g->o, g->R - 0.5 * e.s, g->n);
    for (int k = 0; k < 3; k++) {
        const double x = e.x + e.a * COS[k], y = e.y + e.b * COS[k] + e.c * SIN[k];
        if (fl_patch_points_add(q->w, (fl_patch_point){.group_size = 3,
                                                       .overlap = q->most,
                                                       .u = fl_simd_sum(&t->u) / 3.0,
                                                       .du = du / 3.0,
                                                       .ddu = fl_simd_sum(&t->ddu) / 3.0,
                                                       .n = v3_scale(e.f / du, across),
                                                       .unit_normal = across,
                                                       .p = v3_add(middle, vector_in_plane(g, x, y))}))
            return -1;
    }
    q->w->couple = v3_madd(q->w->couple, fl_simd_sum(&t->couple[0]), g->x);
    q->w->couple = v3_madd(q->w->couple, fl_simd_sum(&t->couple[1]), g->y);
    const fl_vec3 pull = v3_madd(vector_in_plane(g, q->pull.f.x, q->pull.f.y), q->pull.f.z, g->n);
    const double size = v3_norm(pull);
    if (!(size > 0.0)) return 0;
    q->w->couple =
        v3_add(q->w->couple, v3_madd(vector_in_plane(g, q->pull.m.x, q->pull.m.y), q->pull.m.z, g->n));
    return fl_patch_points_add(q->w,
                               (fl_patch_point){.du = size, .n = v3_scale(1.0 / size, pull), .p = g->o});
}

/* The widest rim, `rim` at most, that leaves each side of a polygon half its length, as in face_integral.c.
 */
static double rim_width(const fl_under_face_side *s, const double *length, int32_t n, double rim)
{
    double last = 0.0, first = 0.0;
    for (int32_t c = 0; c <= n; c++) {
        const fl_under_face_side u = s[c < n ? c : 0], v = s[c > 0 ? c - 1 : n - 1];
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

/* Sets up the plane of F, its sides and the vertices under it.  room: five numbers a side; for each vertex
 * four and as many as there are sides, rounded up to full registers. */
static void set_up_face(fl_under_face *g, const fl_patch_core *A, int32_t F, const double *x,
                        int32_t vertices, double rim, double *room)
{
    const fl_poly *p = A->p;
    const int32_t *loop = p->loop + p->first[F], n = p->first[F + 1] - p->first[F];
    fl_under_face_side *side = (fl_under_face_side *)(void *)room;
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
        side[c] = (fl_under_face_side){v3_dot(g->x, a), v3_dot(g->y, a), -over * ey, over * ex};
    }
    g->side = side;
    g->sides = n;
    g->vertices = vertices;
    g->rim = rim_width(side, length, n, rim);
    g->vertex = (fl_under_face_vertex *)(void *)(length + n);
    g->within = (double *)(void *)(g->vertex + vertices);
    fl_under_face_project(g, x);
}

/* Sum faces, edges and corners under F.  -1 when memory runs out. */
static int sum_faces(evaluation *q, const mesh_facet *t, const fl_under_face_facet_four *four, int32_t n)
{
    const fl_mesh_under_face *o = q->o;
    fl_under_face_sorted *f = &q->face;
    uint8_t *const is = q->room->status;
    if (fl_under_face_sort(&q->g, t, four, o->facet_corner, n, f, is))
        for (int32_t k = 0; k < n; k++)
            if (is[k] & FL_UNDER_FACE_SKIPPED) skip_pair(q, t[k].pair[0]), skip_pair(q, t[k].pair[1]);
    q->most = f->most;
    if (f->wholes) fl_under_face_sum_whole(&q->g, t, o->corner, q->B->n, f->whole, f->wholes, &q->sum);
    if (f->cuts)
        fl_under_face_sum_clipped(&q->g, t, o->corner, q->B->n, f->cut, f->cuts, &q->sum, &q->pull, &q->most);
    return q->w->keep_features ? add_faces(q, t) : 0;
}

static int sum_edges(evaluation *q, const mesh_edge *e, const int32_t *end, int32_t n)
{
    int32_t pieces = 0;
    uint8_t *const is = q->room->status;
    if (fl_under_face_sort_edges(&q->g, e, end, n, q->room->edge_part, &pieces, is))
        for (int32_t k = 0; k < n; k++)
            if (is[k] & FL_UNDER_FACE_SKIPPED) skip_pair(q, e[k].pair);
    if (pieces) fl_under_face_sum_edges(&q->g, q->room->edge_part, pieces, &q->sum, &q->most);
    return q->w->keep_features ? add_edges(q, pieces) : 0;
}

static int sum_corners(evaluation *q, const mesh_corner *p, int32_t n)
{
    const fl_under_face *g = &q->g;
    const double near = FL_UNDER_FACE_EDGE_TOL * g->rim;
    int32_t *const list = q->room->list, some = 0;
    for (int32_t k = 0; k < n; k++) {
        const fl_under_face_vertex v = g->vertex[p[k].v];
        if (!(fabs(v.clear) > near && v.h >= 0.0)) skip_pair(q, p[k].pair);
        else if (v.clear > 0.0 && v.h < g->R) list[some++] = k;
    }
    if (some) fl_under_face_sum_corners(g, p, list, some, &q->sum, &q->most);
    return q->w->keep_features ? add_corners(q, p, list, some) : 0;
}

/* Evaluates the features of one group. */
static int evaluate_group(evaluation *q, const face_group *from)
{
    const face_group *to = from + 1;
    const fl_mesh_under_face *o = q->o;
    return sum_faces(q, o->facet + from->facet, o->four + from->four, to->facet - from->facet) ||
                   sum_edges(q, o->edge + from->edge, o->end + from->end, to->edge - from->edge) ||
                   sum_corners(q, o->point + from->point, to->point - from->point)
               ? -1
               : make_points(q);
}

/* Selects the rows that are left to the caller, in their order. */
static void select_remaining(const evaluation *q, int32_t n, fl_row_selection *c)
{
    const fl_mesh_under_face *o = q->o;
    *c = (fl_row_selection){.row_start = o->others,
                            .plane = {o->cut[0], o->cut[1]},
                            .n = o->other,
                            .planes = {o->planes[0], o->planes[1]}};
    if (!q->open) return;
    c->row_start = q->room->remaining, c->n = 0;
    for (int32_t k = 0; k < n; k++) {
        if (o->state[k] && !q->room->skipped[k]) continue;
        q->room->remaining[c->n++] = o->row[k];
        if (o->state[k]) c->plane[o->state[k] - 1] = NULL; /* a skipped pair needs more planes */
    }
}

int fl_mesh_under_face_evaluate(fl_patch_points *w, const fl_feature_pairs *l, fl_mesh_under_face_work *room,
                                const fl_patch_core *A, const fl_patch_core *B, double R, double prism_depth,
                                double rim, fl_feature_pairs *rest)
{
    const fl_mesh_under_face *o = l->under_face;
    *rest = *l;
    if (!o || (o->groups == 0 && o->edge_batch.n == 0)) return 0;
    if (fl_reserve(&room->skipped, &room->skipped_cap, l->n, sizeof *room->skipped) ||
        fl_reserve(&room->remaining, &room->remaining_cap, l->n, sizeof *room->remaining))
        return -1;
    evaluation q = {.w = w, .A = A, .B = B, .o = o, .room = room, .pairs = l->n};
    for (int32_t k = 0; k < o->groups; k++) {
        const face_group *from = &o->group[k], *to = from + 1;
        const int32_t vertices = to->vertex - from->vertex, facets = to->facet - from->facet,
                      edges = to->edge - from->edge, points = to->point - from->point;
        const int64_t sides = A->p->first[from->F + 1] - A->p->first[from->F];
        const int64_t within = (sides + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH;
        if (fl_reserve(&room->number, &room->number_cap, 5 * sides + (4 + within) * vertices,
                       sizeof *room->number) ||
            fl_reserve(&room->status, &room->status_cap, facets > edges ? facets : edges,
                       sizeof *room->status) ||
            fl_reserve(&room->list, &room->list_cap, facets > points ? facets : points, sizeof *room->list) ||
            fl_reserve(&room->cut_face, &room->cut_face_cap, facets, sizeof *room->cut_face) ||
            fl_reserve(&room->edge_part, &room->edge_part_cap, edges, sizeof *room->edge_part))
            return -1;
        q.g = (fl_under_face){.R = R};
        q.sum = (fl_under_face_sums){.u = {0}};
        q.pull = (fl_under_face_side_force){0};
        q.face = (fl_under_face_sorted){.whole = room->list, .cut = room->cut_face};
        set_up_face(&q.g, A, from->F, o->x + 3 * (int64_t)from->vertex, vertices, rim, room->number);
        if (evaluate_group(&q, from)) return -1;
    }
    select_remaining(&q, l->n, &room->selection);
    rest->selection = &room->selection;
    return fl_mesh_edge_batch_evaluate(&o->edge_batch, w, A, B, R, prism_depth);
}

void fl_mesh_under_face_free(fl_mesh_under_face *o)
{
    if (!o) return;
    fl_mesh_edge_batch_free(&o->edge_batch);
    free(o->group), free(o->facet), free(o->edge), free(o->point), free(o->corner), free(o->vertex),
        free(o->x), free(o->row), free(o->state), free(o->others), free(o->four), free(o->facet_corner),
        free(o->end), free(o->cut[0]), free(o->cut[1]);
    free(o);
}

void fl_mesh_under_face_free_pairs(fl_feature_pairs *l)
{
    for (int32_t k = 0; k < l->parts; k++) fl_mesh_under_face_free_pairs(&l->part[k]);
    fl_mesh_under_face_free(l->under_face);
    fl_feature_pairs_free(l);
}

void fl_mesh_under_face_work_free(fl_mesh_under_face_work *room)
{
    free(room->number), free(room->status), free(room->skipped), free(room->remaining), free(room->list),
        free(room->edge_part), free(room->cut_face);
    *room = (fl_mesh_under_face_work){0};
}
