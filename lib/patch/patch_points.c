/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/patch_points.h"
#include <math.h>
#include "base/array.h"
#include "patch/edge_integral.h"
#include "patch/face_integral.h"
#include "patch/feature_pairs.h"
#include "patch/plane_distances.h"

int fl_patch_points_transform(fl_patch_points *w, const fl_poly *a, fl_mat3 M, fl_vec3 o)
{
    if (fl_patch_points_reserve_core(w, a)) return -1;
    w->M = M, w->o = o;
    for (int32_t v = 0; v < a->nv; v++) w->va[v] = v3_add(m3_mul(M, a->v[v]), o);
    for (int32_t f = 0; f < a->nf; f++) w->na[f] = m3_mul(M, a->n[f]);
    return 0;
}

/* Lists the features of a core with a point below `limit` along n. */
static int find_features_below(fl_feature_set *r, const fl_patch_core *a, fl_vec3 n, double limit)
{
    const fl_poly *p = a->p;
    r->vertices = r->edges = r->faces = 0;
    if (fl_reserve(&r->vertex, &r->vertex_cap, p->nv, sizeof *r->vertex) ||
        fl_reserve(&r->edge, &r->edge_cap, p->ne, sizeof *r->edge) ||
        fl_reserve(&r->face, &r->face_cap, p->nf, sizeof *r->face))
        return -1;
    for (int32_t v = 0; v < p->nv; v++)
        if (v3_dot(n, a->v[v]) < limit) r->vertex[r->vertices++] = v;
    for (int32_t e = 0; e < p->ne; e++)
        if (v3_dot(n, a->v[p->edge[e].a]) < limit || v3_dot(n, a->v[p->edge[e].b]) < limit)
            r->edge[r->edges++] = e;
    for (int32_t f = 0; f < p->nf; f++) {
        int near = 0;
        for (int32_t k = p->first[f]; k < p->first[f + 1] && !near; k++)
            near = v3_dot(n, a->v[p->loop[k]]) < limit;
        if (near) r->face[r->faces++] = f;
    }
    return 0;
}

static int build_feature_pairs(fl_patch_points *w, const fl_patch_core *A, const fl_patch_core *B, double R,
                               fl_vec3 n, int deep, fl_feature_pairs *l)
{
    const double margin = deep ? 0.0 : fl_feature_pairs_margin(l, R);
    double low = INFINITY, high = -INFINITY;
    for (int32_t v = 0; v < A->p->nv; v++) low = fmin(low, v3_dot(n, A->v[v]));
    for (int32_t v = 0; v < B->p->nv; v++) high = fmax(high, v3_dot(n, B->v[v]));
    if (find_features_below(&w->near_a, A, n, high + R + margin) ||
        find_features_below(&w->near_b, B, v3_neg(n), R + margin - low) ||
        fl_feature_pairs_build(l, w, A, &w->near_a, B, &w->near_b, R, 0.0, margin))
        return -1;
    l->separated = !deep && low - high > margin;
    return 0;
}

/* Adds the derivatives of the shift D n of A to the gradient of U, D the penetration.  The overlap at a point
 * of direction m changes by
 *     ds = dD - m.(dx + n dD + D dn)
 * and that of a rim force by the second part only.
 * - The terms with dD are a force along n at the deepest point.
 * - A normal n of a face turns with its body.  The points then lie on the lines through the points of that
 *   body before the shift.
 * - A normal n across two edges turns with both bodies.  It is treated as turning with B; what remains is a
 *   couple,
 *     D G.dn' = D/|c| w.(ea x (eb x G')),   c = ea x eb,   G = sum of du m,   G' = G - n (n.G),
 * with w the rotation of A against B. */
static int add_penetration_terms(fl_patch_points *w, const fl_penetration *deep, double R)
{
    const fl_vec3 n = deep->n;
    double sum = 0.0;
    fl_vec3 G = {0};
    for (int32_t k = 0; k < w->n; k++) {
        fl_patch_point *q = &w->point[k];
        if (deep->turns_with <= 0) q->p = v3_madd(q->p, -deep->depth, n);
        sum += q->du * ((q->u > 0.0 ? 1.0 : 0.0) - v3_dot(q->n, n));
        G = v3_madd(G, q->du, q->n);
    }
    if (fl_patch_points_add(w, (fl_patch_point){.overlap = R, .du = sum, .n = n, .p = deep->pa})) return -1;
    if (deep->turns_with != 0) return 0;
    const fl_vec3 c = v3_cross(deep->ea, deep->eb), across = v3_madd(G, -v3_dot(G, n), n);
    const double sign = v3_dot(c, n) > 0.0 ? 1.0 : -1.0;
    const fl_vec3 couple =
        v3_scale(sign * deep->depth / v3_norm(c), v3_cross(deep->ea, v3_cross(deep->eb, across)));
    w->couple = v3_add(w->couple, couple);
    return 0;
}

int fl_patch_points_find(fl_patch_points *w, const fl_poly *a, const fl_poly *b, double ra, double rb,
                         fl_vec3 n, const fl_penetration *deep, fl_feature_pairs *l)
{
    const double depth = deep->depth, R = ra + rb + depth, rim = FL_PATCH_RIM_WIDTH * (ra + rb);
    const fl_vec3 out = v3_scale(depth, n);
    const fl_patch_core A = {a, w->va, w->na, ra, 1.0}, B = {b, b->v, b->n, rb, -1.0};
    w->n = 0;
    w->couple = v3(0, 0, 0);
    const fl_vec3 o = w->o;
    if (depth > 0.0) {
        for (int32_t v = 0; v < a->nv; v++) w->va[v] = v3_add(w->va[v], out);
        w->o = v3_add(o, out);
    }
    if ((depth > 0.0 || !fl_feature_pairs_valid(l, &w->M, w->o)) &&
        build_feature_pairs(w, &A, &B, R, n, depth > 0.0, l))
        return -1;
    if (fl_feature_pairs_evaluate(w, l, &A, &B, R, 0.0, rim, rim)) return -1;
    if (v3_norm2(deep->n) == 0.0) return 0; /* the cores do not overlap */
    l->max_shift2 = 0.0;                    /* not valid for the shifted core */
    w->o = o;
    for (int32_t v = 0; v < a->nv; v++) w->va[v] = v3_sub(w->va[v], out);
    return add_penetration_terms(w, deep, R);
}

int fl_patch_points_find_listed(fl_patch_points *w, const fl_poly *a, const fl_poly *b, double ra, double rb,
                                fl_mat3 M, fl_vec3 o, const fl_feature_pairs *l)
{
    const double rim = FL_PATCH_RIM_WIDTH * (ra + rb);
    if (fl_feature_pairs_transform(w, l, a, M, o)) return -1;
    const fl_patch_core A = {a, w->va, w->na, ra, 1.0}, B = {b, b->v, b->n, rb, -1.0};
    w->n = 0;
    w->couple = v3(0, 0, 0);
    return fl_feature_pairs_evaluate(w, l, &A, &B, ra + rb, 0.0, rim, rim);
}

int fl_patch_points_on_plane(fl_patch_points *w, const fl_poly *a, double ra, double *distance)
{
    const fl_patch_core A = {a, w->va, w->na, ra, 1.0};
    w->n = 0;
    w->couple = v3(0, 0, 0);
    *distance = INFINITY;
    for (int32_t v = 0; v < a->nv; v++) *distance = fmin(*distance, w->va[v].z);
    if (*distance >= ra) return 0;
    for (int32_t v = 0; v < a->nv; v++)
        if (w->va[v].z < ra && fl_patch_points_add_vertex(w, &A, 0.0, v, v3(0, 0, 1), ra - w->va[v].z))
            return -1;
    if (fl_edge_integral_begin(w)) return -1;
    for (int32_t e = 0; e < a->ne; e++)
        if ((w->va[a->edge[e].a].z < ra || w->va[a->edge[e].b].z < ra) && fl_edge_queue_over_plane(w, &A, e))
            return -1;
    if (fl_edge_integral_finish(w, ra)) return -1;
    for (int32_t f = 0; f < a->nf; f++)
        if (fl_face_integral_over_plane(w, &A, f, ra)) return -1;
    return 0;
}

void fl_patch_points_free(fl_patch_points *w)
{
    fl_feature_set_free(&w->near_a), fl_feature_set_free(&w->near_b);
    for (int k = 0; k < 2; k++) free(w->distances[k].h), free(w->distances[k].x);
    free(w->va), free(w->na), free(w->point), free(w->polygon), free(w->point_lanes), free(w->area_motion),
        free(w->feature);
    fl_feature_draft_free(w->draft);
    fl_edge_integral_free(w->edges);
    *w = (fl_patch_points){0};
}
