/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "base/simd.h"
#include "contact/cone_blend.h"
#include "contact/pair_geometry.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "narrow/closest_point.h"
#include "patch/cone.h"
#include "structure/mesh_contact.h"
#include "world/access.h"

/* A pair that does not touch computes its exact distance only within this multiple of the sum of its radii.
 * Beyond, the bound by the old direction gives enough free travel.  A pair that stays nearer is due in nearly
 * every step: it computes the distance in one step of EXACT_EVERY and else relies on the bound. */
#define NEARLY 1.02
enum { EXACT_EVERY = 8 };

/* A hash of step and pair, so that the choice follows no period of either. */
static uint32_t hash_of(int64_t step, int32_t k)
{
    return ((uint32_t)step * UINT32_C(2654435761) + (uint32_t)k * UINT32_C(0x9e3779b1)) >> 16;
}

/* Multiple of the sum of the radii beyond which the bound suffices. */
static double bound_factor(const fl_world *w, int32_t i, int32_t j)
{
    return hash_of(w->step, i + j) % EXACT_EVERY ? 1.0 : NEARLY;
}

FL_SIMD_VERSIONS fl_relative_pose fl_relative_pose_of(const fl_world *w, const fl_pair *p)
{
    const fl_bodies *b = &w->b;
    const int32_t i = p->i, j = p->j;
    fl_relative_pose r;
    const fl_mat3 *B = &r.R;
    r.R = fl_body_axes(b, j);
    r.off = fl_separation(w, i, j, p->image);
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

/* --- contact points ---------------------------------------------------------------------------- */

/* The contact point of a point x with a plane, a cone, a point or a convex polyhedron. */
static int find_point_of_sphere(fl_patch_points *s, const fl_poly *b, const fl_piece *piece, fl_vec3 x,
                                double ra, double R, double *distance)
{
    fl_closest_point q;
    if (piece && piece->kind == FL_PIECE_PLANE) q = (fl_closest_point){.d = x.z, .n = v3(0, 0, 1)};
    else if (piece && piece->kind == FL_PIECE_CONE) q = fl_closest_on_cone(piece->r0, piece->r1, piece->h, x);
    else if (b->nv == 1) q = fl_closest_of_point(b->v[0], x);
    else q = fl_closest_on_poly(b, x);
    *distance = q.d;
    return q.d < R ? fl_patch_points_add_plain(s, x, q.n, R - q.d, ra) : 0;
}

/* The lowest vertex of A over a plane, for springs at the closest point. */
static int find_lowest_point(fl_patch_points *s, int32_t nv, double ra, double *distance)
{
    fl_vec3 x = v3(0, 0, INFINITY);
    for (int32_t v = 0; v < nv; v++)
        if (s->va[v].z < x.z) x = s->va[v];
    *distance = x.z;
    return x.z < ra ? fl_patch_points_add_plain(s, x, v3(0, 0, 1), ra - x.z, ra) : 0;
}

/* The smallest n.v of m points. */
FL_SIMD_VERSIONS static double min_projection(const fl_vec3 *v, int32_t m, fl_vec3 n)
{
    fl_simd least = {INFINITY, INFINITY, INFINITY, INFINITY};
    double low = INFINITY;
    int32_t k = 0;
    for (; k + FL_SIMD_WIDTH <= m; k += FL_SIMD_WIDTH) {
        fl_simd x[3];
        fl_simd_from_triples(x, &v[k]);
        const fl_simd h = n.x * x[0] + n.y * x[1] + n.z * x[2];
        least = FL_SIMD_SELECT(h < least, h, least);
    }
    for (; k < m; k++) {
        const double h = n.x * v[k].x + n.y * v[k].y + n.z * v[k].z;
        low = h < low ? h : low;
    }
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) low = least[l] < low ? least[l] : low;
    return low;
}

/* Width of the gap that the planes across n leave between the cores: a lower bound of their distance. */
static double gap_along(const fl_vec3 *va, int32_t na, const fl_poly *b, fl_vec3 n)
{
    return min_projection(va, na, n) + min_projection(b->v, b->nv, v3_neg(n));
}

/* Face normals of A in B's frame; the caller frees them.  NULL when memory runs out. */
static fl_vec3 *rotate_normals(const fl_poly *a, const fl_mat3 *M)
{
    fl_err lost = {0};
    fl_vec3 *n = fl_alloc(a->nf, sizeof *n, &lost);
    for (int32_t f = 0; n && f < a->nf; f++) n[f] = m3_mul(*M, a->n[f]);
    return n;
}

/* Penetration of overlapping cores, which is rare; s holds the vertices of A. */
static int find_penetration(fl_world *w, const fl_pair *p, const fl_poly *a, const fl_poly *b,
                            const fl_patch_points *s, fl_mat3 M, fl_penetration *deep)
{
    fl_vec3 *const n = rotate_normals(a, &M);
    if (!n) return -1;
    const fl_solid A = {a, s->va, n, 0.0}, B = {b, b->v, b->n, 0.0};
    fl_penetration_count count = {0};
    fl_penetration_find(&A, &B, &count, deep);
    free(n);
    if (p->crush) return 0; /* worn away there (contact/crushing.h): no overlap of what is left */
#pragma omp critical(fl_deep_statistics)
    {
        w->penetration_count.queries += count.queries;
        w->penetration_count.no_answer += count.no_answer;
        w->penetration_count.rejected += count.rejected;
        w->penetration_count.capped += count.capped;
        w->overlapping_cores++;
    }
    return 0;
}

/* Direction between the cores in B's frame, p->axis, and a lower bound of their distance (negative:
 * penetration).  The direction of the last evaluation is kept while it separates them by more than `enough`.
 * Otherwise gap, unless NULL, receives the closest points. */
static int find_separation(fl_world *w, fl_pair *p, const fl_poly *a, const fl_poly *b,
                           const fl_patch_points *s, fl_mat3 M, double enough, fl_penetration *deep,
                           fl_gap *gap, double *distance)
{
    *distance = gap_along(s->va, a->nv, b, p->axis);
    *deep = (fl_penetration){0};
    p->cores_overlap = 0;
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
    if (find_penetration(w, p, a, b, s, M, deep)) return -1;
    p->axis = deep->n;
    p->has_axis = 1;
    p->cores_overlap = 1;
    *distance = -deep->depth;
    return 0;
}

/* Adds the contact points with the exact cone.  Its polyhedron gives a separating direction, the cone the
 * distance along it.  An overlapping pair is computed anew every time. */
static int add_cone_points(fl_pair *p, fl_patch_points *s, const fl_poly *a, const fl_poly *b,
                           const fl_piece *piece, double ra, double *distance)
{
    const fl_truncated_cone cone = {piece->r0, piece->r1, piece->h};
    p->cores_overlap = 0;
    for (int again = 0; again < 2; again++) {
        double low = INFINITY;
        for (int32_t v = 0; v < a->nv; v++) low = fmin(low, v3_dot(p->axis, s->va[v]));
        *distance = p->has_axis ? low - fl_cone_support(&cone, p->axis) : -INFINITY;
        if (again || (p->has_axis && *distance > (p->touching ? 0.0 : NEARLY * ra))) break;
        fl_gap gap;
        fl_gjk((fl_core){s->va, a->nv, a}, (fl_core){b->v, b->nv, b}, &p->cache, &gap);
        p->has_axis = !gap.overlap;
        p->cores_overlap = gap.overlap;
        if (p->has_axis) p->axis = gap.n;
    }
    return *distance < ra ? fl_cone_evaluate(s, a, &cone, ra) : 0;
}

/* The feature pairs of p, allocated once the pair comes within reach.  NULL when memory runs out. */
static fl_feature_pairs *feature_pairs_of(fl_pair *p)
{
    if (!p->feature_pairs) {
        fl_err lost = {0};
        p->feature_pairs = fl_alloc(1, sizeof *p->feature_pairs, &lost);
    }
    return p->feature_pairs;
}

/* Contact points of two convex cores in B's frame; the vertices of A are in s. */
static int find_convex_points(fl_world *w, fl_pair *p, fl_patch_points *s, const fl_relative_pose *r,
                              double *distance)
{
    const fl_bodies *b = &w->b;
    const fl_poly *A = &b->core[p->i], *B = &b->core[p->j];
    const double ra = p->radius_factor * b->radius[p->i], rb = p->radius_factor * b->radius[p->j],
                 R = ra + rb;
    const int nearest = p->points == FL_POINTS_NEAREST;
    fl_penetration deep;
    fl_gap gap;
    /* A touching pair needs only a direction that separates the cores; one that does not touch needs its
     * distance. */
    if (find_separation(w, p, A, B, s, r->M,
                        nearest       ? INFINITY
                        : p->touching ? 0.0
                                      : bound_factor(w, p->i, p->j) * R,
                        &deep, nearest ? &gap : NULL, distance))
        return -1;
    if (*distance >= R) return 0;
    if (nearest) {
        if (p->cores_overlap) {
            const double overlap = R - *distance;
            fl_vec3 x = v3(0, 0, 0);
            double low = INFINITY;
            for (int32_t v = 0; v < A->nv; v++) {
                const double h = v3_dot(p->axis, s->va[v]);
                if (h < low) low = h, x = s->va[v];
            }
            return fl_patch_points_add_plain(s, x, p->axis, overlap, ra);
        }
        return fl_patch_points_add_plain(s, gap.pa, gap.n, R - gap.d, ra);
    }
    fl_feature_pairs *const l = feature_pairs_of(p);
    if (!l || fl_patch_points_find(s, A, B, ra, rb, p->axis, &deep, l)) return -1;
    if (s->n == 0 && *distance < R) { /* the old direction gave only a bound: compute the distance */
        p->has_axis = 0;
        return find_separation(w, p, A, B, s, r->M, INFINITY, &deep, NULL, distance);
    }
    return 0;
}

int fl_pair_find_points(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r, double *distance)
{
    fl_patch_points *const s = &w->scratch[thread];
    const fl_bodies *b = &w->b;
    const fl_poly *A = &b->core[p->i], *B = &b->core[p->j];
    const fl_piece *piece = fl_world_piece(w, p->j);
    const double ra = p->radius_factor * b->radius[p->i], rb = p->radius_factor * b->radius[p->j],
                 R = ra + rb;
    s->n = 0;
    if (A->nv == 1 && (!piece || piece->kind != FL_PIECE_MESH))
        return find_point_of_sphere(s, B, piece, r->o, ra, R, distance);
    if (B->nv == 1 && !piece) { /* the point is B: compute from A, then swap */
        if (find_point_of_sphere(s, A, NULL, v3_neg(m3_tmul(r->M, r->o)), rb, R, distance)) return -1;
        if (s->n) {
            const fl_vec3 n = v3_neg(m3_mul(r->M, s->point[0].n));
            const double overlap = s->point[0].overlap;
            s->n = 0;
            return fl_patch_points_add_plain(s, v3_scale(R - overlap, n), n, overlap, ra);
        }
        return 0;
    }
    if (p->touching && p->points == FL_POINTS_PATCH && (!piece || piece->kind == FL_PIECE_SOLID) &&
        p->feature_pairs && p->feature_pairs->separated &&
        fl_feature_pairs_valid(p->feature_pairs, &r->M, r->o)) {
        if (fl_patch_points_find_listed(s, A, B, ra, rb, r->M, r->o, p->feature_pairs)) return -1;
        p->cores_overlap = 0;
        if (s->n) return 0;
    }
    if (fl_patch_points_transform(s, A, r->M, r->o)) return -1;
    if (piece && piece->kind == FL_PIECE_PLANE)
        return p->points == FL_POINTS_NEAREST ? find_lowest_point(s, A->nv, ra, distance)
                                              : fl_patch_points_on_plane(s, A, ra, distance);
    if (piece && piece->kind == FL_PIECE_MESH && A->nv == 1 && p->points == FL_POINTS_NEAREST)
        return feature_pairs_of(p)
                   ? fl_mesh_contact_sphere(s, &w->mesh_near[thread], piece, ra, p->feature_pairs, distance)
                   : -1;
    if (piece && piece->kind == FL_PIECE_MESH && piece->cones && A->nv > 1)
        return feature_pairs_of(p) ? fl_joined_find_points(s, &w->mesh_near[thread], A, piece, &r->M, r->o,
                                                           b->bounding_radius[p->i], ra, ra + w->skin,
                                                           p->feature_pairs, distance)
                                   : -1;
    if (piece && piece->kind == FL_PIECE_MESH)
        return feature_pairs_of(p) ? fl_mesh_contact_points(s, &w->mesh_near[thread], A, piece, ra,
                                                            ra + w->skin, p->feature_pairs, distance)
                                   : -1;
    double farther = INFINITY;
    fl_cone_blend of = {0};
    if (piece && piece->kind == FL_PIECE_CONE && p->points == FL_POINTS_PATCH)
        of = fl_cone_blend_of(piece, A, &r->M, r->o, ra);
    if (of.weight < 1.0 && find_convex_points(w, p, s, r, distance)) return -1;
    if (of.weight == 0.0) return 0;
    const int32_t n = s->n;
    const int deep = p->cores_overlap;
    const fl_vec3 couple = n ? s->couple : v3(0, 0, 0);
    s->couple = v3(0, 0, 0);
    if (add_cone_points(p, s, A, B, piece, ra, &farther)) return -1;
    p->cores_overlap |= of.weight < 1.0 ? deep : 0;
    *distance = of.weight < 1.0 ? fmin(*distance, farther) : farther;
    return of.weight < 1.0 ? fl_cone_blend_points(s, 0, n, couple, &of, r->o) : 0;
}

int fl_pair_find_quick(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r, double *distance,
                       fl_quick_sums *sums)
{
    const fl_bodies *b = &w->b;
    const fl_poly *A = &b->core[p->i], *B = &b->core[p->j];
    const fl_quick_shape *a = &w->quick_shape[p->i], *c = &w->quick_shape[p->j];
    const double ra = p->radius_factor * b->radius[p->i], rb = p->radius_factor * b->radius[p->j],
                 R = ra + rb;
    fl_patch_points *const s = &w->scratch[thread];
    fl_quick_scratch *const own = &w->quick_scratch[thread];
    fl_penetration deep = {.depth = 0.0};
    fl_err lost = {0};
    if (p->touching && p->quick_list && p->quick_list->separated &&
        fl_quick_list_valid(p->quick_list, &r->M, r->o)) {
        if (fl_quick_evaluate(own, a, c, ra, rb, r->M, r->o, &deep, p->quick_list, sums)) return -1;
        p->cores_overlap = 0;
        if (sums->u > 0.0) return 0;
    }
    *sums = (fl_quick_sums){.u = 0.0};
    if (fl_patch_points_transform(s, A, r->M, r->o)) return -1;
    const double enough = p->touching ? 0.0 : bound_factor(w, p->i, p->j) * R;
    if (find_separation(w, p, A, B, s, r->M, enough, &deep, NULL, distance)) return -1;
    if (*distance >= R) return 0;
    if (!p->quick_list && !(p->quick_list = fl_alloc(1, sizeof *p->quick_list, &lost))) return -1;
    fl_quick_list *const l = p->quick_list;
    const double margin = p->cores_overlap ? 0.0 : fl_quick_list_margin(l, R);
    if (p->cores_overlap || !fl_quick_list_valid(l, &r->M, r->o)) {
        if (fl_quick_list_build(l, a, c, ra, rb, R + deep.depth, r->M, v3_madd(r->o, deep.depth, deep.n),
                                margin))
            return -1;
        l->separated = !p->cores_overlap && *distance > margin;
    }
    if (fl_quick_evaluate(own, a, c, ra, rb, r->M, r->o, &deep, l, sums)) return -1;
    if (p->cores_overlap) l->max_shift2 = 0.0; /* not valid for the shifted core */
    if (sums->u == 0.0) {                      /* the old direction gave only a bound: compute the distance */
        p->has_axis = 0;
        return find_separation(w, p, A, B, s, r->M, INFINITY, &deep, NULL, distance);
    }
    return 0;
}

/* The contact of features of two dilated cores; s holds the vertices of A. */
static int find_feature_contact(const fl_patch_points *s, const fl_poly *A, const fl_poly *B, double ra,
                                double rb, const fl_mat3 *M, fl_mode before, fl_gjk_cache *cache,
                                fl_contact *out)
{
    fl_vec3 *const n = rotate_normals(A, M);
    if (!n) return -1;
    const fl_solid a = {A, s->va, n, ra}, b = {B, B->v, B->n, rb};
    fl_contact_find(&a, &b, before, cache, NULL, out);
    free(n);
    return 0;
}

int fl_pair_find_contact(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r, fl_contact *out)
{
    const fl_bodies *b = &w->b;
    const fl_poly *A = &b->core[p->i], *B = &b->core[p->j];
    fl_patch_points *const s = &w->scratch[thread];
    if (fl_patch_points_transform(s, A, r->M, r->o)) return -1;
    return find_feature_contact(s, A, B, p->radius_factor * b->radius[p->i],
                                p->radius_factor * b->radius[p->j], &r->M, p->mode, &p->cache, out);
}

/* --- free travel ----------------------------------------------------------------------------- */

/* Beyond this multiple of the sum of its radii a pair releases its feature pairs.  A chattering contact
 * opens by less.  Listing the features anew costs as much as four evaluations. */
#define FAR 1.003

/* Sum of the odometers at which cores at this distance may touch. */
static double free_travel_of(const fl_world *w, int32_t i, int32_t j, double distance, double R)
{
    return w->b.odometer[i] + w->b.odometer[j] + (distance > R ? (distance - R) * (1.0 - 1e-9) : 0.0);
}

void fl_pair_set_free_travel(const fl_world *w, fl_pair *p, double distance, double R)
{
    p->free_travel = free_travel_of(w, p->i, p->j, distance, R);
    if (distance > FAR * R) fl_pair_free(p);
}

void fl_neighbour_pair_set_distance(const fl_world *w, fl_neighbour_pair *q, double distance)
{
    const double R = w->b.radius[q->i] + w->b.radius[q->j];
    q->cores_overlap = 0;
    q->free_travel = free_travel_of(w, q->i, q->j, distance, R);
    if (!q->contact) return;
    q->contact->cores_overlap = 0;
    fl_pair_set_free_travel(w, q->contact, distance, R);
}

/* The smallest n.v over the core of body i, from its centre, world axes. */
static double min_extent_of(const fl_world *w, int32_t i, fl_vec3 n)
{
    const fl_poly *A = &w->b.core[i];
    return min_projection(A->v, A->nv, m3_tmul(fl_body_axes(&w->b, i), n));
}

int fl_pair_still_apart(const fl_world *w, fl_neighbour_pair *q)
{
    const fl_bodies *b = &w->b;
    const int32_t i = q->i, j = q->j;
    const fl_poly *B = &b->core[j];
    const fl_piece *piece = fl_world_piece(w, j);
    const int wall = piece && piece->kind == FL_PIECE_PLANE && !piece->elastic;
    const double R = b->radius[i] + b->radius[j];
    fl_pair *const p = q->contact; /* set if the contact has just opened */
    if ((p && (p->touching || p->bond || p->crush)) || b->core[i].nv == 1 ||
        fl_pair_law_of(w, i, j)->law->points != FL_POINTS_PATCH)
        return 0;
    if (!wall && (!(p ? p->has_axis : q->has_axis) || B->nv == 1 || (piece && piece->kind != FL_PIECE_SOLID)))
        return 0;
    const fl_mat3 axes = fl_body_axes(b, j);
    const fl_vec3 axis = wall ? v3(0, 0, 1)
                         : p  ? p->axis
                              : v3(q->axis[0], q->axis[1], q->axis[2]),
                  n = wall ? m3_col(axes, 2) : m3_mul(axes, axis);
    const double apart = -v3_dot(n, fl_separation(w, i, j, q->image)),
                 distance = min_extent_of(w, i, n) + apart +
                            (wall ? 0.0 : min_projection(B->v, B->nv, v3_neg(axis)));
    if (!(distance > (wall ? 1.0 : bound_factor(w, i, j)) * R))
        return 0; /* of a wall the distance is exact */
    fl_neighbour_pair_set_distance(w, q, distance);
    return 1;
}

/* The deepest contact point on a mesh, or the nearest point: in the frame of B. */
static int probe_mesh(fl_world *w, const fl_pair *p, const fl_relative_pose *r, double reach, fl_contact *out)
{
    const double ra = p->radius_factor * w->b.radius[p->i];
    fl_patch_points *s = &w->scratch[0];
    fl_pair own = *p; /* p keeps its feature pairs */
    double distance, deepest = -INFINITY;
    fl_gap gap;
    own.feature_pairs = NULL;
    const int rc = fl_pair_find_points(w, &own, 0, r, &distance);
    if (own.feature_pairs) fl_mesh_under_face_free_pairs(own.feature_pairs);
    free(own.feature_pairs);
    if (rc) return 0;
    *out = (fl_contact){.mode = FL_MODE_NONE};
    for (int32_t k = 0; k < s->n; k++) {
        const fl_patch_point *q = &s->point[k];
        if (q->overlap <= deepest) continue;
        deepest = q->overlap;
        *out = (fl_contact){.d = ra - deepest, .gap = -deepest, .n = q->unit_normal, .p = q->p};
    }
    if (s->n) return 1;
    if (fl_mesh_contact_gap(&w->mesh_near[0], s->va, &w->b.core[p->i], fl_world_piece(w, p->j), ra + reach,
                            &gap) <= 0)
        return 0;
    *out = (fl_contact){.d = gap.d, .gap = gap.d - ra, .n = gap.n};
    out->p = v3_madd(gap.pb, 0.5 * out->gap, gap.n);
    return 1;
}

int fl_pair_probe(fl_world *w, const fl_pair *p, double reach, fl_contact *out)
{
    const fl_bodies *b = &w->b;
    const int32_t i = p->i, j = p->j;
    const fl_poly *A = &b->core[i], *B = &b->core[j];
    const fl_relative_pose r = fl_relative_pose_of(w, p);
    const fl_piece *piece = fl_world_piece(w, j);
    fl_patch_points *s = &w->scratch[0];
    if (fl_patch_points_transform(s, A, r.M, r.o)) return 0;
    if (piece && piece->kind == FL_PIECE_MESH) {
        if (!probe_mesh(w, p, &r, reach, out)) return 0;
    } else if (piece && (piece->kind == FL_PIECE_PLANE || (piece->kind == FL_PIECE_CONE && A->nv == 1))) {
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
            const fl_closest_point q = fl_closest_on_cone(piece->r0, piece->r1, piece->h, r.o);
            *out = (fl_contact){.mode = FL_VF, .d = q.d, .gap = q.d - ra, .n = q.n};
            out->p = v3_madd(r.o, -ra - 0.5 * out->gap, q.n);
        }
    } else {
        if (find_feature_contact(s, A, B, b->radius[i], b->radius[j], &r.M, FL_MODE_NONE, NULL, out))
            return 0;
    }
    out->n = m3_mul(r.R, out->n);
    /* b->x[j] without a cell: the same bits as with j in its own image */
    out->p = v3_add(w->cell.periodic ? v3_add(b->x[i], r.off) : b->x[j], m3_mul(r.R, out->p));
    out->p = fl_periodic_cell_wrap(&w->cell, out->p);
    return out->gap < reach;
}
