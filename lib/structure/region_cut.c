/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "structure/region_cut.h"
#include <string.h>
#include "base/array.h"
#include "narrow/closest_point.h"
#include "narrow/gjk.h"
#include "structure/mesh_contact.h"

/* Sine of the angle between two planes below which they are one plane, if the corners are within tol. */
#define SAME_PLANE 1e-3

typedef enum { OPEN_SURFACE, PLATE, SOLID } body_kind;

/* A body: its faces in the frame of the surface, and a tree over their boxes. */
typedef struct {
    const fl_piece *piece;
    body_kind kind;
    fl_aabb all;
    fl_aabb *box; /* [n] */
    fl_bvh tree;
    int32_t first, n; /* its polygons */
} body;

static body_kind kind_of(const fl_piece *p)
{
    if (p->kind == FL_PIECE_MESH) return p->mesh.closed ? SOLID : OPEN_SURFACE;
    return p->core.nf == 2 ? PLATE : SOLID;
}

static fl_vec3 in_piece(const fl_piece *p, fl_vec3 x) { return q_rotate(q_conj(p->q), v3_sub(x, p->x)); }

int fl_piece_contains(const fl_piece *p, fl_vec3 x)
{
    const fl_vec3 at = in_piece(p, x);
    if (kind_of(p) != SOLID) return 0;
    return p->kind == FL_PIECE_MESH ? fl_mesh_contact_contains(p, at)
                                    : fl_closest_on_poly(&p->core, at).d < 0.0;
}

static fl_aabb box_of_points(const fl_vec3 *v, int32_t n)
{
    fl_aabb box = aabb_empty();
    for (int32_t k = 0; k < n; k++) box = aabb_add(box, v[k]);
    return box;
}

static fl_vec3 mean_of(const fl_vec3 *v, int32_t n)
{
    fl_vec3 sum = v3(0, 0, 0);
    for (int32_t k = 0; k < n; k++) sum = v3_add(sum, v3_sub(v[k], v[0]));
    return v3_madd(v[0], 1.0 / n, sum);
}

/* --- polygons ----------------------------------------------------------------------------------- */

static int add_polygon(fl_region_surface *s, const fl_vec3 *v, int32_t n, const fl_region_polygon *like,
                       fl_err *err)
{
    if (fl_grow(&s->polygon, &s->cap, (int64_t)s->n + 1, sizeof *s->polygon, err) ||
        fl_grow(&s->v, &s->v_cap, (int64_t)s->nv + n, sizeof *s->v, err))
        return -1;
    memmove(s->v + s->nv, v, (size_t)n * sizeof *v);
    s->polygon[s->n] = *like;
    s->polygon[s->n].first = s->nv, s->polygon[s->n++].n = n;
    s->nv += n;
    return 0;
}

static int add_body(fl_region_surface *s, body *b, const fl_piece *p, int32_t index, fl_err *err)
{
    const fl_poly *core = &p->core;
    fl_vec3 *v = NULL;
    int32_t cap = 0, rc = 0;
    *b = (body){.piece = p, .kind = kind_of(p), .first = s->n};
    b->n = b->kind == PLATE ? 1 : core->nf;
    for (int32_t f = 0; f < b->n && rc == 0; f++) {
        const int32_t from = core->first[f], m = core->first[f + 1] - from;
        const fl_region_polygon like = {.normal = q_rotate(p->q, core->n[f]),
                                        .body = index,
                                        .two_sided = b->kind == PLATE,
                                        .on_cone =
                                            p->kind == FL_PIECE_CONE && f >= (p->r0 > 0.0) + (p->r1 > 0.0)};
        if ((rc = fl_grow(&v, &cap, m, sizeof *v, err)) != 0) break;
        for (int32_t k = 0; k < m; k++)
            v[k] = v3_add(v3_sub(p->x, s->origin), q_rotate(p->q, core->v[core->loop[from + k]]));
        rc = add_polygon(s, v, m, &like, err);
    }
    free(v);
    b->box = rc ? NULL : fl_alloc(b->n, sizeof *b->box, err);
    if (!b->box) return -1;
    b->all = aabb_empty();
    for (int32_t f = 0; f < b->n; f++) {
        const fl_region_polygon *q = &s->polygon[b->first + f];
        b->box[f] = box_of_points(s->v + q->first, q->n);
        b->all = aabb_join(b->all, b->box[f]);
    }
    s->open |= b->kind == OPEN_SURFACE;
    return fl_bvh_build(&b->tree, b->box, b->n, err);
}

/* Fragments of one polygon; each is a run of v. */
typedef struct {
    struct fragment {
        int32_t first, n;
    } * at;
    fl_vec3 *v;
    int32_t n, cap, nv, v_cap;
    int32_t *list, list_cap; /* faces of another body near it */
    double *height;
    int32_t height_cap;
} fragments;

static void fragments_free(fragments *w) { free(w->at), free(w->v), free(w->list), free(w->height); }

/* Appends the part of fragment k on the side of the plane where sign * height >= 0. */
static int append_side(fragments *w, int32_t k, double sign, fl_err *err)
{
    const int32_t n = w->at[k].n, from = w->at[k].first;
    if (fl_grow(&w->at, &w->cap, (int64_t)w->n + 1, sizeof *w->at, err) ||
        fl_grow(&w->v, &w->v_cap, (int64_t)w->nv + 2 * n, sizeof *w->v, err))
        return -1;
    w->at[w->n].first = w->nv;
    for (int32_t c = 0; c < n; c++) {
        const int32_t d = c + 1 < n ? c + 1 : 0;
        const double h = sign * w->height[c], g = sign * w->height[d];
        if (h >= 0.0) w->v[w->nv++] = w->v[from + c];
        if ((h > 0.0 && g < 0.0) ||
            (h < 0.0 && g > 0.0)) /* from the lower end: both sides get the same point */
            w->v[w->nv++] = h < g ? v3_lerp(w->v[from + c], w->v[from + d], h / (h - g))
                                  : v3_lerp(w->v[from + d], w->v[from + c], g / (g - h));
    }
    w->at[w->n].n = w->nv - w->at[w->n].first;
    w->n++;
    return 0;
}

/* Heights of fragment k over a plane through o; those within tol count as 0.  Sets low and high. */
static int find_heights(fragments *w, int32_t k, fl_vec3 n, fl_vec3 o, double tol, double *low, double *high,
                        fl_err *err)
{
    if (fl_grow(&w->height, &w->height_cap, w->at[k].n, sizeof *w->height, err)) return -1;
    *low = INFINITY, *high = -INFINITY;
    for (int32_t c = 0; c < w->at[k].n; c++) {
        const double h = v3_dot(n, v3_sub(w->v[w->at[k].first + c], o));
        w->height[c] = fabs(h) <= tol ? 0.0 : h;
        *low = fmin(*low, w->height[c]), *high = fmax(*high, w->height[c]);
    }
    return 0;
}

/* Cuts fragment k along the plane if it has corners on both sides: the part above takes its place, the other
 * one comes last. */
static int split_fragment(fragments *w, int32_t k, fl_vec3 n, fl_vec3 o, double tol, fl_err *err)
{
    double low, high;
    if (find_heights(w, k, n, o, tol, &low, &high, err)) return -1;
    if (!(low < 0.0 && high > 0.0)) return 0;
    if (append_side(w, k, 1.0, err) || append_side(w, k, -1.0, err)) return -1;
    w->at[k] = w->at[w->n - 2];
    w->at[w->n - 2] = w->at[w->n - 1];
    w->n--;
    return 0;
}

/* Inward normal of side c of a polygon, in its plane. */
static fl_vec3 inward(const fl_vec3 *v, int32_t n, int32_t c, fl_vec3 normal)
{
    return v3_unit(v3_cross(normal, v3_sub(v[c + 1 < n ? c + 1 : 0], v[c])));
}

/* True if some side of polygon a has all of b beyond it, within tol. */
static int is_separated(const fl_vec3 *a, int32_t na, fl_vec3 normal, const fl_vec3 *b, int32_t nb,
                        double tol)
{
    for (int32_t c = 0; c < na; c++) {
        const fl_vec3 in = inward(a, na, c, normal);
        int32_t k = 0;
        while (k < nb && v3_dot(in, v3_sub(b[k], a[c])) <= tol) k++;
        if (k == nb) return 1;
    }
    return 0;
}

/* Length of the part of the line in which fragment k meets the plane of q that lies on q, within tol. */
static double length_on_face(const fragments *w, int32_t k, const fl_vec3 *q, int32_t n, fl_vec3 normal,
                             double tol)
{
    const fl_vec3 *v = w->v + w->at[k].first;
    fl_vec3 end[2] = {v3(0, 0, 0), v3(0, 0, 0)};
    int found = 0;
    for (int32_t c = 0; c < w->at[k].n && found < 2; c++) {
        const int32_t d = c + 1 < w->at[k].n ? c + 1 : 0;
        const double h = w->height[c], g = w->height[d];
        if (h == 0.0) end[found++] = v[c];
        else if ((h < 0.0 && g > 0.0) || (h > 0.0 && g < 0.0))
            end[found++] = v3_lerp(v[c], v[d], h / (h - g));
    }
    if (found < 2) return 0.0;
    double t[2] = {0.0, 1.0};
    for (int32_t c = 0; c < n; c++) {
        const fl_vec3 in = inward(q, n, c, normal);
        const double a = v3_dot(in, v3_sub(end[0], q[c])) + tol, b = v3_dot(in, v3_sub(end[1], q[c])) + tol;
        if (a < 0.0 && b < 0.0) return 0.0;
        if (a < 0.0) t[0] = fmax(t[0], a / (a - b));
        if (b < 0.0) t[1] = fmin(t[1], a / (a - b));
    }
    return (t[1] - t[0]) * v3_norm(v3_sub(end[1], end[0]));
}

/* True if the fragment lies in the plane of q; its heights are known. */
static int is_coplanar(double low, double high, fl_vec3 n, fl_vec3 m)
{
    return low == 0.0 && high == 0.0 && v3_norm(v3_cross(n, m)) < SAME_PLANE;
}

/* Cuts all fragments of a polygon with this normal along face q of another body. */
static int cut_by_face(fragments *w, fl_vec3 normal, const fl_vec3 *v, const fl_region_polygon *q, double tol,
                       fl_err *err)
{
    const fl_vec3 *at = v + q->first;
    for (int32_t k = 0, n = w->n; k < n; k++) {
        double low, high;
        if (find_heights(w, k, q->normal, at[0], tol, &low, &high, err)) return -1;
        if (is_coplanar(low, high, normal, q->normal)) {
            if (is_separated(at, q->n, q->normal, w->v + w->at[k].first, w->at[k].n, tol) ||
                is_separated(w->v + w->at[k].first, w->at[k].n, normal, at, q->n, tol))
                continue;
            for (int32_t c = 0; c < q->n; c++)
                if (split_fragment(w, k, inward(at, q->n, c, q->normal), at[c], tol, err)) return -1;
        } else if (low < 0.0 && high > 0.0 && length_on_face(w, k, at, q->n, q->normal, tol) > 3.0 * tol) {
            if (split_fragment(w, k, q->normal, at[0], tol, err)) return -1;
        }
    }
    return 0;
}

/* True if x, in the plane of q, lies on it. */
static int is_on_face(const fl_vec3 *q, const fl_region_polygon *p, fl_vec3 x)
{
    for (int32_t c = 0; c < p->n; c++)
        if (v3_dot(inward(q, p->n, c, p->normal), v3_sub(x, q[c])) < 0.0) return 0;
    return 1;
}

/* True if a fragment of body a is dropped where one of body b lies in the same place. */
static int is_hidden_by(const body *a, const body *b, int a_first, int same_way)
{
    if (a->kind == SOLID && b->kind == SOLID) return same_way ? !a_first : 1;
    if (a->kind == PLATE && b->kind == PLATE) return !a_first;
    if (a->kind == OPEN_SURFACE && b->kind == OPEN_SURFACE) return same_way && !a_first;
    return a->kind < b->kind;
}

/* True if body b leaves the fragment in the surface.  list[0 .. near): faces of b near it. */
static int is_kept(const fl_region_surface *s, const fragments *w, int32_t k, fl_vec3 normal, const body *a,
                   const body *b, int32_t near, int a_first)
{
    const fl_vec3 *v = w->v + w->at[k].first, middle = mean_of(v, w->at[k].n);
    for (int32_t c = 0; c < near; c++) {
        const fl_region_polygon *q = &s->polygon[b->first + w->list[c]];
        const fl_vec3 *at = s->v + q->first;
        if (v3_norm(v3_cross(normal, q->normal)) >= SAME_PLANE) continue;
        if (fabs(v3_dot(q->normal, v3_sub(middle, at[0]))) > s->tol || !is_on_face(at, q, middle)) continue;
        return !is_hidden_by(a, b, a_first, v3_dot(normal, q->normal) > 0.0);
    }
    return !fl_piece_contains(b->piece, v3_add(middle, s->origin));
}

static int find_near_faces(fragments *w, const body *b, fl_aabb box, int32_t *n, fl_err *err)
{
    *n = fl_bvh_query(&b->tree, b->box, box, w->list, w->list_cap);
    if (*n <= w->list_cap) return 0;
    if (fl_grow(&w->list, &w->list_cap, *n, sizeof *w->list, err)) return -1;
    *n = fl_bvh_query(&b->tree, b->box, box, w->list, w->list_cap);
    return 0;
}

static int compare_int(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* Cuts polygon p of body a along the bodies, and adds what stays to `to`. */
static int cut_polygon(fl_region_surface *to, const fl_region_surface *s, int32_t p, const body *all,
                       int32_t bodies, fragments *w, fl_err *err)
{
    const fl_region_polygon q = s->polygon[p];
    const fl_aabb box = aabb_grow(box_of_points(s->v + q.first, q.n), s->tol);
    w->n = w->nv = 0;
    if (fl_grow(&w->at, &w->cap, 1, sizeof *w->at, err) || fl_grow(&w->v, &w->v_cap, q.n, sizeof *w->v, err))
        return -1;
    memcpy(w->v, s->v + q.first, (size_t)q.n * sizeof *w->v);
    w->at[w->n++] = (struct fragment){0, q.n};
    w->nv = q.n;
    for (int32_t b = 0; b < bodies; b++) {
        int32_t near;
        if (b == q.body || !aabb_overlap(box, all[b].all)) continue;
        if (find_near_faces(w, &all[b], box, &near, err)) return -1;
        if (near > 1) qsort(w->list, (size_t)near, sizeof *w->list, compare_int);
        for (int32_t c = 0; c < near; c++)
            if (cut_by_face(w, q.normal, s->v, &s->polygon[all[b].first + w->list[c]], s->tol, err))
                return -1;
        for (int32_t k = 0; k < w->n;) {
            if (is_kept(s, w, k, q.normal, &all[q.body], &all[b], near, q.body < b)) k++;
            else w->at[k] = w->at[--w->n];
        }
    }
    for (int32_t k = 0; k < w->n; k++)
        if (w->at[k].n > 2 && add_polygon(to, w->v + w->at[k].first, w->at[k].n, &q, err)) return -1;
    return 0;
}

int fl_region_cut(fl_region_surface *s, int32_t n, const fl_piece *const *piece, double tol, fl_err *err)
{
    fl_region_surface whole = {.tol = tol, .origin = piece[0]->x};
    fragments w = {0};
    body *all = fl_alloc(n, sizeof *all, err);
    int rc = all ? 0 : -1;
    for (int32_t b = 0; b < n && rc == 0; b++) rc = add_body(&whole, &all[b], piece[b], b, err);
    *s = (fl_region_surface){.tol = tol, .origin = whole.origin, .open = whole.open};
    for (int32_t p = 0; p < whole.n && rc == 0; p++) rc = cut_polygon(s, &whole, p, all, n, &w, err);
    for (int32_t b = 0; all && b < n; b++) free(all[b].box), fl_bvh_free(&all[b].tree);
    free(all);
    fragments_free(&w);
    fl_region_surface_free(&whole);
    if (rc) fl_region_surface_free(s);
    return rc;
}

void fl_region_surface_free(fl_region_surface *s)
{
    free(s->polygon), free(s->v);
    *s = (fl_region_surface){0};
}

/* --- touch -------------------------------------------------------------------------------------- */

/* A point of the surface of a piece, in the pose of the file. */
static fl_vec3 point_of(const fl_piece *p)
{
    return v3_add(p->x, q_rotate(p->q, p->core.v[p->core.loop[0]]));
}

int fl_pieces_touch(const fl_piece *a, const fl_piece *b, double tol, fl_err *err)
{
    fl_region_surface s = {.tol = tol, .origin = a->x};
    body of[2] = {{0}, {0}};
    fragments w = {0};
    int touch = -1;
    if (add_body(&s, &of[0], a, 0, err) || add_body(&s, &of[1], b, 1, err)) goto done;
    touch = 0;
    for (int32_t f = 0; f < of[0].n && !touch && aabb_overlap(aabb_grow(of[0].all, tol), of[1].all); f++) {
        const fl_region_polygon *p = &s.polygon[f];
        int32_t near;
        if (!aabb_overlap(aabb_grow(of[0].box[f], tol), of[1].all)) continue;
        if (find_near_faces(&w, &of[1], aabb_grow(of[0].box[f], tol), &near, err)) touch = -1;
        for (int32_t c = 0; c < near && !touch; c++) {
            const fl_region_polygon *q = &s.polygon[of[1].first + w.list[c]];
            fl_gjk_cache cold = {0};
            fl_gap gap;
            fl_gjk((fl_core){s.v + p->first, p->n, NULL}, (fl_core){s.v + q->first, q->n, NULL}, &cold, &gap);
            touch = gap.overlap || gap.d <= tol;
        }
    }
    if (!touch) touch = fl_piece_contains(a, point_of(b)) || fl_piece_contains(b, point_of(a));
done:
    for (int k = 0; k < 2; k++) free(of[k].box), fl_bvh_free(&of[k].tree);
    fragments_free(&w);
    fl_region_surface_free(&s);
    return touch;
}
