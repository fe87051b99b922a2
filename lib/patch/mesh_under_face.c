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

/* A feature of B under F; corners of faces and ends of edges are numbers of the footing's vertices. */
typedef fl_under_face_facet tile;
typedef fl_under_face_edge strip;
typedef fl_under_face_corner point;

/* Where each of a face's features begin. */
typedef struct {
    int32_t F, tile, strip, point, vertex, four, end;
} foot;

enum { OF_HEMS = 3 };

struct fl_mesh_under_face {
    foot *foot; /* [feet + 1] */
    tile *tile;
    strip *strip;
    point *point;
    int32_t *corner;
    fl_under_face_facet_four *four; /* the tiles by fours; */
    int32_t *of_four;               /* numbers of their corners, and */
    int32_t *end;                   /* of the ends of strips, by fours */
    int32_t *vertex;                /* of B, ascending in each foot; padded there to full registers */
    double *x;                      /* their coordinates: x, y and z of a register's worth, and so on */
    int32_t *row;                   /* [matches] where each begins in the list */
    uint8_t *mine; /* [matches] 1 + its way where the footing has it, OF_HEMS where they do, else 0 */
    fl_mesh_edge_batch hems;
    int32_t *others; /* where the rows begin that it has not */
    int32_t *cut[2]; /* numbers of the planes that the others ask about, of each way */
    int32_t cuts[2], cut_cap[2], mine_cap, other, others_cap;
    int32_t row_cap, feet, foot_cap, tile_cap, strip_cap, point_cap, corners, corner_cap, vertex_cap, x_cap;
    int32_t fours, four_cap, of_fours, of_four_cap, ends, end_cap;
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

/* Face f of B reaches over three sides of face F of A, and will as long as the list is good: under() would
 * not take it. */
static int spans(const fl_feature_pairs *l, const fl_patch_core *A, int32_t F, const fl_patch_core *B,
                 int32_t f)
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

/* The matches of faces, edges and corners of B with faces of A, by those faces; row: where each match
 * begins. */
static int32_t keys_of(const fl_feature_pairs *l, const fl_patch_core *A, const fl_patch_core *B,
                       int32_t *row, key *out)
{
    int32_t n = 0;
    const void *whole = fl_feature_pairs_integers(l);
    int32_t at = fl_feature_pairs_first_row(l);
    for (int32_t k = 0; k < l->n; k++, at = fl_feature_row_next(whole, l->width, at)) {
        const int32_t head = fl_feature_integer(whole, l->width, at), way = fl_feature_row_direction(head);
        const int32_t own = fl_feature_integer(whole, l->width, at + FL_ROW_OWN);
        const int32_t other = fl_feature_integer(whole, l->width, at + FL_ROW_OTHER);
        const int kind = fl_feature_row_kind(head);
        row[k] = at;
        if (kind == FL_PAIR_FACE_FACE) {
            const key f = way == 0 ? (key){own, 0, other, 0, k, 0.0} : (key){other, 0, own, 1, k, 0.0};
            if (!spans(l, A, f.F, B, f.own)) out[n++] = f;
        } else if (way == 1 && kind == FL_PAIR_VERTEX_FACE) out[n++] = (key){other, 2, own, 1, k, 0.0};
        else if (way == 1 && kind == FL_PAIR_EDGE_FACE) {
            const int32_t factor = fl_feature_integer(whole, l->width, at + FL_ROW_FACTOR);
            out[n++] = (key){other, 1, own, 1, k, fl_feature_pairs_numbers(l)[factor]};
        }
    }
    return n;
}

/* The planes that matches ask about which are not of the footing. */
static int list_cuts(fl_mesh_under_face *o, const fl_feature_pairs *l)
{
    const void *whole = fl_feature_pairs_integers(l);
    fl_err lost = {0};
    uint8_t *asked = fl_alloc((int64_t)l->planes[0] + l->planes[1] + 1, sizeof *asked, &lost);
    int rc = asked ? 0 : -1;
    for (int way = 0; way < 2 && rc == 0; way++)
        rc = fl_grow(&o->cut[way], &o->cut_cap[way], (int64_t)l->planes[way] + 1, sizeof(int32_t), &lost);
    for (int32_t k = 0; k < l->n && rc == 0; k++) {
        const int32_t head = fl_feature_integer(whole, l->width, o->row[k]),
                      way = fl_feature_row_direction(head);
        const int kind = fl_feature_row_kind(head);
        const int plane =
            kind == FL_PAIR_VERTEX_FACE || kind == FL_PAIR_EDGE_FACE || kind == FL_PAIR_FACE_FACE;
        const int32_t from = o->row[k] + fl_feature_row_fixed(kind);
        if (o->mine[k]) continue;
        for (int32_t c = -plane; c < fl_feature_row_sides(head); c++) {
            /* the plane of the face is the last of the fixed numbers */
            const int32_t at = fl_feature_integer(whole, l->width, from + c);
            asked[(way ? l->planes[0] : 0) + (c < 0 ? at : at >> 1)] = 1;
        }
    }
    for (int way = 0; way < 2 && rc == 0; way++) {
        o->cuts[way] = 0;
        for (int32_t k = 0; k < l->planes[way]; k++)
            if (asked[(way ? l->planes[0] : 0) + k]) o->cut[way][o->cuts[way]++] = k;
    }
    free(asked);
    return rc;
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
    fl_mesh_under_face *o;
    const fl_feature_pairs *l;
    const fl_patch_core *A, *B;
    int32_t tiles, strips, points, vertices;
} lister;

/* The vertices of the keys of one face, each once. */
static int list_vertices(lister *s, const key *k, int32_t n)
{
    fl_mesh_under_face *o = s->o;
    const fl_poly *p = s->B->p;
    int64_t room = 0;
    for (int32_t c = 0; c < n; c++) room += k[c].kind == 0 ? p->first[k[c].own + 1] - p->first[k[c].own] : 2;
    if (fl_reserve(&o->vertex, &o->vertex_cap, s->vertices + room + FL_SIMD_WIDTH, sizeof *o->vertex))
        return -1;
    int32_t *list = o->vertex + s->vertices, m = 0, kept = 0;
    for (int32_t c = 0; c < n; c++) m += vertices_of(p, &k[c], list + m);
    qsort(list, (size_t)m, sizeof *list, number_order);
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

static int list_tile(lister *s, const key *k, const int32_t *list, int32_t n)
{
    fl_mesh_under_face *o = s->o;
    const fl_poly *p = s->B->p;
    const int32_t corners = p->first[k->own + 1] - p->first[k->own];
    if (fl_reserve(&o->tile, &o->tile_cap, (int64_t)s->tiles + 1, sizeof *o->tile) ||
        fl_reserve(&o->corner, &o->corner_cap, (int64_t)o->corners + corners, sizeof *o->corner))
        return -1;
    tile *t = &o->tile[s->tiles++];
    *t = (tile){k->own, o->corners, corners, {-1, -1}};
    t->match[k->way] = k->match;
    for (int32_t c = 0; c < corners; c++)
        o->corner[o->corners++] = place_of(list, n, p->loop[p->first[k->own] + c]);
    return 0;
}

/* Tiles and strips from here on, by fours. */
static int list_fours(lister *s, const foot *from)
{
    fl_mesh_under_face *o = s->o;
    for (int32_t c = from->tile; c < s->tiles; c += FL_SIMD_WIDTH) {
        const tile *t[FL_SIMD_WIDTH];
        int32_t most = 0;
        for (int l = 0; l < FL_SIMD_WIDTH; l++) {
            t[l] = &o->tile[c + l < s->tiles ? c + l : c];
            most = t[l]->n > most ? t[l]->n : most;
        }
        if (fl_reserve(&o->four, &o->four_cap, (int64_t)o->fours + 1, sizeof *o->four) ||
            fl_reserve(&o->of_four, &o->of_four_cap, o->of_fours + FL_SIMD_WIDTH * (int64_t)most,
                       sizeof *o->of_four))
            return -1;
        fl_under_face_facet_four *const four = &o->four[o->fours++];
        four->first = o->of_fours, four->most = most;
        for (int l = 0; l < FL_SIMD_WIDTH; l++) {
            const fl_vec3 n = s->B->n[t[l]->f];
            four->n[0][l] = n.x, four->n[1][l] = n.y, four->n[2][l] = n.z;
        }
        for (int32_t k = 0; k < most; k++)
            for (int l = 0; l < FL_SIMD_WIDTH; l++)
                o->of_four[o->of_fours++] = o->corner[t[l]->first + (k < t[l]->n ? k : 0)];
    }
    for (int32_t c = from->strip; c < s->strips; c += FL_SIMD_WIDTH) {
        if (fl_reserve(&o->end, &o->end_cap, (int64_t)o->ends + 2 * FL_SIMD_WIDTH, sizeof *o->end)) return -1;
        for (int way = 0; way < 2; way++)
            for (int l = 0; l < FL_SIMD_WIDTH; l++)
                o->end[o->ends++] = o->strip[c + l < s->strips ? c + l : c].v[way];
    }
    return 0;
}

/* One face of A: keys k[0 .. n). */
static int list_foot(lister *s, const key *k, int32_t n)
{
    fl_mesh_under_face *o = s->o;
    const fl_poly *p = s->B->p;
    const int32_t from = s->vertices;
    if (fl_reserve(&o->foot, &o->foot_cap, (int64_t)o->feet + 2, sizeof *o->foot)) return -1;
    o->foot[o->feet++] = (foot){k->F, s->tiles, s->strips, s->points, from, o->fours, o->ends};
    if (list_vertices(s, k, n)) return -1;
    const int32_t *list = o->vertex + from, all = s->vertices - from;
    for (int32_t c = 0; c < n; c++) {
        if (k[c].kind == 0) {
            if (c > 0 && k[c - 1].kind == 0 && k[c - 1].own == k[c].own)
                o->tile[s->tiles - 1].match[k[c].way] = k[c].match;
            else if (list_tile(s, &k[c], list, all)) return -1;
        } else if (k[c].kind == 1) {
            if (fl_reserve(&o->strip, &o->strip_cap, (int64_t)s->strips + 1, sizeof *o->strip)) return -1;
            const fl_edge e = p->edge[k[c].own];
            o->strip[s->strips++] =
                (strip){{place_of(list, all, e.a), place_of(list, all, e.b)}, k[c].match, k[c].factor};
        } else {
            if (fl_reserve(&o->point, &o->point_cap, (int64_t)s->points + 1, sizeof *o->point)) return -1;
            const double sharp = fmax(fl_poly_corner_angle(p, k[c].own) * FL_PATCH_CORNER_WEIGHT, 0.0);
            o->point[s->points++] = (point){place_of(list, all, k[c].own), k[c].match,
                                            (sharp < 1.0 ? sharp : 1.0) * FL_PATCH_ROUND_FACTOR * (0.4 * PI) *
                                                fl_patch_feature_radius(s->B->r, s->A->r)};
        }
    }
    if (list_fours(s, &o->foot[o->feet - 1])) return -1;
    o->foot[o->feet] = (foot){-1, s->tiles, s->strips, s->points, s->vertices, o->fours, o->ends};
    return 0;
}

int fl_mesh_under_face_list(fl_feature_pairs *l, const fl_patch_core *A, const fl_patch_core *B)
{
    fl_err lost = {0};
    if (!l->under_face) l->under_face = fl_alloc(1, sizeof *l->under_face, &lost);
    fl_mesh_under_face *const o = l->under_face;
    key *k = fl_alloc(l->n, sizeof *k, &lost);
    int rc = o && k && !fl_grow(&o->row, &o->row_cap, l->n, sizeof *o->row, &lost) &&
                     !fl_grow(&o->mine, &o->mine_cap, l->n, sizeof *o->mine, &lost) &&
                     !fl_grow(&o->others, &o->others_cap, l->n, sizeof *o->others, &lost)
                 ? 0
                 : -1;
    if (rc == 0) {
        lister s = {.o = o, .l = l, .A = A, .B = B};
        const int32_t n = keys_of(l, A, B, o->row, k);
        for (int32_t c = 0; c < l->n; c++) o->mine[c] = 0;
        for (int32_t c = 0; c < n; c++) o->mine[k[c].match] = (uint8_t)(1 + k[c].way);
        o->feet = o->corners = o->other = o->fours = o->of_fours = o->ends = 0;
        rc = fl_mesh_edge_batch_list(&o->hems, l, o->row, A, B, o->mine, OF_HEMS);
        for (int32_t c = 0; c < l->n; c++)
            if (!o->mine[c]) o->others[o->other++] = o->row[c];
        if (n > 1) qsort(k, (size_t)n, sizeof *k, key_order);
        for (int32_t from = 0, to; from < n && rc == 0; from = to) {
            for (to = from + 1; to < n && k[to].F == k[from].F; to++) {}
            rc = list_foot(&s, k + from, to - from);
        }
        if (rc == 0) rc = list_cuts(o, l);
    }
    free(k);
    return rc;
}

/* --- what lies under F now -------------------------------------------------------------------------------
 */

typedef struct {
    fl_patch_points *w;
    const fl_patch_core *A, *B;
    const fl_mesh_under_face *o;
    fl_mesh_under_face_work *room;
    int32_t matches; /* listed */
    int open;        /* room->open is laid, for one of those is left */
    fl_under_face g;
    fl_under_face_sums sum;
    fl_under_face_side_force pull;
    fl_under_face_sorted face;
    double most; /* the largest s */
} work;

/* A match that the footing has is to be told by others. */
static void leave(work *q, int32_t match)
{
    if (match < 0) return;
    if (!q->open) memset(q->room->covered, 0, (size_t)q->matches);
    q->open = 1;
    q->room->covered[match] = 1;
}

/* Where a sum bears and how it spreads: three places at x + a cos, y + b cos + c sin have its moments. */
typedef struct {
    double f, x, y, s, a, b, c;
} spread;

static spread spread_of(const fl_under_face_sums *t)
{
    spread q = {.f = fl_simd_sum(&t->f)};
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

static fl_vec3 in_plane(const fl_under_face *g, double x, double y)
{
    return v3_madd(v3_scale(x, g->x), y, g->y);
}

/* What a feature by itself has given, where somebody asks. */
static int add_share(const work *q, const fl_under_face_sums *t, int32_t n)
{
    fl_patch_points *w = q->w;
    const fl_under_face *g = &q->g;
    const spread e = spread_of(t);
    if (!(e.f > 0.0)) return 0;
    if (fl_reserve(&w->feature, &w->feature_cap, (int64_t)w->features + 1, sizeof *w->feature)) return -1;
    fl_patch_feature *share = &w->feature[w->features++];
    *share = (fl_patch_feature){.first_point = w->n,
                                .n = n,
                                .p = v3_add(v3_madd(g->o, g->R - e.s, g->n), in_plane(g, e.x, e.y)),
                                .force = e.f};
    if (n == 3) share->e1 = in_plane(g, e.a, e.b), share->e2 = in_plane(g, 0.0, e.c);
    else if (n == 2) /* along a line e.c is 0, or e.a and e.b are */
        share->e1 = v3_scale(sqrt(0.5), in_plane(g, e.a, e.a > 0.0 ? e.b : e.c));
    return 0;
}

/* What each feature by itself has given, where somebody asks: faces, edges, corners. */
static int faces_apart(const work *q, const tile *tiles)
{
    const fl_under_face_sorted *f = &q->face;
    for (int32_t k = 0; k < f->wholes + f->cuts; k++) {
        const int whole = k < f->wholes;
        const fl_under_face_cut cut =
            whole ? (fl_under_face_cut){.tile = f->whole[k]} : f->cut[k - f->wholes];
        fl_under_face_sums own = {.u = {0}};
        fl_under_face_side_force none = {0};
        double most = 0.0;
        fl_under_face_sum_clipped(&q->g, tiles, q->o->corner, q->B->n, &cut, 1, &own, &none, &most);
        if (add_share(q, &own, whole ? 1 : 3)) return -1;
    }
    return 0;
}

static int edges_apart(const work *q, int32_t pieces)
{
    for (int32_t k = 0; k < pieces; k++) {
        double most = 0.0;
        fl_under_face_sums own = {.u = {0}};
        fl_under_face_sum_edges(&q->g, &q->room->edge_part[k], 1, &own, &most);
        if (add_share(q, &own, 2)) return -1;
    }
    return 0;
}

static int corners_apart(const work *q, const point *p, const int32_t *list, int32_t n)
{
    for (int32_t k = 0; k < n; k++) {
        double most = 0.0;
        fl_under_face_sums own = {.u = {0}};
        fl_under_face_sum_corners(&q->g, p, &list[k], 1, &own, &most);
        if (add_share(q, &own, 1)) return -1;
    }
    return 0;
}

/* Three places with the force, the moment and the spread of all: those of face_integral.h; and what pulls at
 * the sides. */
static int put(work *q)
{
    static const double COS[3] = {1.0, -0.5, -0.5}, SIN[3] = {0.0, 0.86602540378443865, -0.86602540378443865};
    const fl_under_face *g = &q->g;
    const fl_under_face_sums *t = &q->sum;
    const spread e = spread_of(t);
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
                                                       .p = v3_add(middle, in_plane(g, x, y))}))
            return -1;
    }
    q->w->couple = v3_madd(q->w->couple, fl_simd_sum(&t->couple[0]), g->x);
    q->w->couple = v3_madd(q->w->couple, fl_simd_sum(&t->couple[1]), g->y);
    const fl_vec3 pull = v3_madd(in_plane(g, q->pull.f.x, q->pull.f.y), q->pull.f.z, g->n);
    const double size = v3_norm(pull);
    if (!(size > 0.0)) return 0;
    q->w->couple = v3_add(q->w->couple, v3_madd(in_plane(g, q->pull.m.x, q->pull.m.y), q->pull.m.z, g->n));
    return fl_patch_points_add(q->w,
                               (fl_patch_point){.du = size, .n = v3_scale(1.0 / size, pull), .p = g->o});
}

/* Of the rims of a polygon the widest that leaves each side half its length, rim at most: as in
 * face_integral.c. */
static double rim_within(const fl_under_face_side *s, const double *length, int32_t n, double rim)
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

/* The plane of F, its sides and the vertices under it.  room: five numbers for each side, and for each vertex
 * four and as many as there are sides, in full registers. */
static void lay_ground(fl_under_face *g, const fl_patch_core *A, int32_t F, const double *x, int32_t vertices,
                       double rim, double *room)
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
    g->rim = rim_within(side, length, n, rim);
    g->vertex = (fl_under_face_vertex *)(void *)(length + n);
    g->within = (double *)(void *)(g->vertex + vertices);
    fl_under_face_project(g, x);
}

/* Faces under F, edges and corners: their sums.  -1 when memory runs out. */
static int faces_under(work *q, const tile *t, const fl_under_face_facet_four *four, int32_t n)
{
    const fl_mesh_under_face *o = q->o;
    fl_under_face_sorted *f = &q->face;
    uint8_t *const is = q->room->status;
    if (fl_under_face_sort(&q->g, t, four, o->of_four, n, f, is))
        for (int32_t k = 0; k < n; k++)
            if (is[k] & FL_UNDER_FACE_SKIPPED) leave(q, t[k].match[0]), leave(q, t[k].match[1]);
    q->most = f->most;
    if (f->wholes) fl_under_face_sum_whole(&q->g, t, o->corner, q->B->n, f->whole, f->wholes, &q->sum);
    if (f->cuts)
        fl_under_face_sum_clipped(&q->g, t, o->corner, q->B->n, f->cut, f->cuts, &q->sum, &q->pull, &q->most);
    return q->w->keep_features ? faces_apart(q, t) : 0;
}

static int edges_under(work *q, const strip *e, const int32_t *end, int32_t n)
{
    int32_t pieces = 0;
    uint8_t *const is = q->room->status;
    if (fl_under_face_sort_edges(&q->g, e, end, n, q->room->edge_part, &pieces, is))
        for (int32_t k = 0; k < n; k++)
            if (is[k] & FL_UNDER_FACE_SKIPPED) leave(q, e[k].match);
    if (pieces) fl_under_face_sum_edges(&q->g, q->room->edge_part, pieces, &q->sum, &q->most);
    return q->w->keep_features ? edges_apart(q, pieces) : 0;
}

static int corners_under(work *q, const point *p, int32_t n)
{
    const fl_under_face *g = &q->g;
    const double near = FL_UNDER_FACE_EDGE_TOL * g->rim;
    int32_t *const list = q->room->list, some = 0;
    for (int32_t k = 0; k < n; k++) {
        const fl_under_face_vertex v = g->vertex[p[k].v];
        if (!(fabs(v.clear) > near && v.h >= 0.0)) leave(q, p[k].match);
        else if (v.clear > 0.0 && v.h < g->R) list[some++] = k;
    }
    if (some) fl_under_face_sum_corners(g, p, list, some, &q->sum, &q->most);
    return q->w->keep_features ? corners_apart(q, p, list, some) : 0;
}

/* What lies under a face: everything from `from` to the next. */
static int foot_places(work *q, const foot *from)
{
    const foot *to = from + 1;
    const fl_mesh_under_face *o = q->o;
    return faces_under(q, o->tile + from->tile, o->four + from->four, to->tile - from->tile) ||
                   edges_under(q, o->strip + from->strip, o->end + from->end, to->strip - from->strip) ||
                   corners_under(q, o->point + from->point, to->point - from->point)
               ? -1
               : put(q);
}

/* The matches that are left, in their order. */
static void choose(const work *q, int32_t n, fl_row_selection *c)
{
    const fl_mesh_under_face *o = q->o;
    *c = (fl_row_selection){.row_start = o->others,
                            .plane = {o->cut[0], o->cut[1]},
                            .n = o->other,
                            .planes = {o->cuts[0], o->cuts[1]}};
    if (!q->open) return;
    c->row_start = q->room->remaining, c->n = 0;
    for (int32_t k = 0; k < n; k++) {
        if (o->mine[k] && !q->room->covered[k]) continue;
        q->room->remaining[c->n++] = o->row[k];
        if (o->mine[k]) c->plane[o->mine[k] - 1] = NULL; /* that asks about more */
    }
}

int fl_mesh_under_face_evaluate(fl_patch_points *w, const fl_feature_pairs *l, fl_mesh_under_face_work *room,
                                const fl_patch_core *A, const fl_patch_core *B, double R, double behind,
                                double rim, fl_feature_pairs *rest)
{
    const fl_mesh_under_face *o = l->under_face;
    *rest = *l;
    if (!o || (o->feet == 0 && o->hems.n == 0)) return 0;
    if (fl_reserve(&room->covered, &room->covered_cap, l->n, sizeof *room->covered) ||
        fl_reserve(&room->remaining, &room->remaining_cap, l->n, sizeof *room->remaining))
        return -1;
    work q = {.w = w, .A = A, .B = B, .o = o, .room = room, .matches = l->n};
    for (int32_t k = 0; k < o->feet; k++) {
        const foot *from = &o->foot[k], *to = from + 1;
        const int32_t vertices = to->vertex - from->vertex, tiles = to->tile - from->tile,
                      strips = to->strip - from->strip, points = to->point - from->point;
        const int64_t sides = A->p->first[from->F + 1] - A->p->first[from->F];
        const int64_t within = (sides + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH;
        if (fl_reserve(&room->number, &room->number_cap, 5 * sides + (4 + within) * vertices,
                       sizeof *room->number) ||
            fl_reserve(&room->status, &room->status_cap, tiles > strips ? tiles : strips,
                       sizeof *room->status) ||
            fl_reserve(&room->list, &room->list_cap, tiles > points ? tiles : points, sizeof *room->list) ||
            fl_reserve(&room->cut_face, &room->cut_face_cap, tiles, sizeof *room->cut_face) ||
            fl_reserve(&room->edge_part, &room->edge_part_cap, strips, sizeof *room->edge_part))
            return -1;
        q.g = (fl_under_face){.R = R};
        q.sum = (fl_under_face_sums){.u = {0}};
        q.pull = (fl_under_face_side_force){0};
        q.face = (fl_under_face_sorted){.whole = room->list, .cut = room->cut_face};
        lay_ground(&q.g, A, from->F, o->x + 3 * (int64_t)from->vertex, vertices, rim, room->number);
        if (foot_places(&q, from)) return -1;
    }
    choose(&q, l->n, &room->selection);
    rest->selection = &room->selection;
    return fl_mesh_edge_batch_evaluate(&o->hems, w, A, B, R, behind);
}

void fl_mesh_under_face_free(fl_mesh_under_face *o)
{
    if (!o) return;
    fl_mesh_edge_batch_free(&o->hems);
    free(o->foot), free(o->tile), free(o->strip), free(o->point), free(o->corner), free(o->vertex),
        free(o->x), free(o->row), free(o->mine), free(o->others), free(o->four), free(o->of_four),
        free(o->end), free(o->cut[0]), free(o->cut[1]);
    free(o);
}

void fl_mesh_under_face_free_pairs(fl_feature_pairs *l)
{
    fl_mesh_under_face_free(l->under_face);
    fl_feature_pairs_free(l);
}

void fl_mesh_under_face_work_free(fl_mesh_under_face_work *room)
{
    free(room->number), free(room->status), free(room->covered), free(room->remaining), free(room->list),
        free(room->edge_part), free(room->cut_face);
    *room = (fl_mesh_under_face_work){0};
}
