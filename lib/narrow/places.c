/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/mem.h"
#include "base/pi.h"
#include "narrow/areas.h"
#include "narrow/matches.h"
#include "narrow/strips.h"

int fl_places_size(fl_places *w, const fl_poly *a)
{
    return fl_room(&w->va, &w->va_cap, a->nv, sizeof *w->va) ||
                   fl_room(&w->na, &w->na_cap, a->nf, sizeof *w->na)
               ? -1
               : 0;
}

int fl_places_enter(fl_places *w, const fl_poly *a, fl_mat3 M, fl_vec3 o)
{
    if (fl_places_size(w, a)) return -1;
    w->M = M, w->o = o;
    for (int32_t v = 0; v < a->nv; v++) w->va[v] = v3_add(m3_mul(M, a->v[v]), o);
    for (int32_t f = 0; f < a->nf; f++) w->na[f] = m3_mul(M, a->n[f]);
    return 0;
}

int fl_places_room(fl_places *w)
{
    return fl_room(&w->place, &w->place_cap, (int64_t)w->n + 1, sizeof *w->place);
}

int fl_places_vertex(fl_places *w, const fl_side *own, double other, int32_t v, fl_vec3 n, double overlap)
{
    const double sharp = fl_poly_corner(own->p, v) * FL_PLACE_SHARP_CORNER, s2 = overlap * overlap;
    const double k = (sharp < 1.0 ? sharp : 1.0) * FL_PLACE_ROUND * (0.4 * PI) * fl_place_rho(own->r, other);
    if (!(k > 0.0)) return 0;
    fl_place *const to = fl_places_next(w);
    if (!to) return -1;
    const fl_vec3 across = v3_scale(own->side, n);
    *to = (fl_place){.overlap = overlap,
                     .u = k * s2 * s2 * overlap,
                     .du = 5.0 * k * s2 * s2,
                     .ddu = 20.0 * k * s2 * overlap,
                     .n = across,
                     .across = across,
                     .p = v3_madd(own->v[v], 0.5 * overlap - own->r, n)};
    return 0;
}

int fl_places_point(fl_places *w, fl_vec3 x, fl_vec3 n, double overlap, double ra)
{
    return fl_places_add(
        w, (fl_place){
               .overlap = overlap, .du = 1.0, .n = n, .across = n, .p = v3_madd(x, 0.5 * overlap - ra, n)});
}

/* The features of a core with a point below `limit` along n. */
static int in_reach(fl_reach *r, const fl_side *a, fl_vec3 n, double limit)
{
    const fl_poly *p = a->p;
    r->vertices = r->edges = r->faces = 0;
    if (fl_room(&r->vertex, &r->vertex_cap, p->nv, sizeof *r->vertex) ||
        fl_room(&r->edge, &r->edge_cap, p->ne, sizeof *r->edge) ||
        fl_room(&r->face, &r->face_cap, p->nf, sizeof *r->face))
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

void fl_reach_free(fl_reach *r)
{
    free(r->vertex), free(r->edge), free(r->face);
    *r = (fl_reach){0};
}

static int list_matches(fl_places *w, const fl_side *A, const fl_side *B, double R, fl_vec3 n, int deep,
                        fl_matches *l)
{
    const double margin = deep ? 0.0 : fl_matches_margin(l, R);
    double low = INFINITY, high = -INFINITY;
    for (int32_t v = 0; v < A->p->nv; v++) low = fmin(low, v3_dot(n, A->v[v]));
    for (int32_t v = 0; v < B->p->nv; v++) high = fmax(high, v3_dot(n, B->v[v]));
    if (in_reach(&w->of_a, A, n, high + R + margin) || in_reach(&w->of_b, B, v3_neg(n), R + margin - low) ||
        fl_matches_list(l, w, A, &w->of_a, B, &w->of_b, R, 0.0, margin))
        return -1;
    l->clear = !deep && low - high > margin;
    return 0;
}

/* What the shift by D n adds to the gradient of U.  A place of direction m changes by
 *     ds = dD - m.(dx + n dD + D dn)
 * and a rim by its last part: the terms with dD are a force along n at the deepest point.  A normal that is a
 * face's turns with its body, so that the places lie on the lines through that body's points where they are.
 * One of two edges turns with both: taken as B's, with
 *     D G.dn' = D/|c| w.(ea x (eb x G')),   c = ea x eb, G = sum of du m, G' = G - n (n.G), w of A against B,
 * left over, a couple. */
static int add_depth(fl_places *w, const fl_overlap *deep, double R)
{
    const fl_vec3 n = deep->n;
    double sum = 0.0;
    fl_vec3 G = {0};
    for (int32_t k = 0; k < w->n; k++) {
        fl_place *q = &w->place[k];
        if (deep->of <= 0) q->p = v3_madd(q->p, -deep->depth, n);
        sum += q->du * ((q->u > 0.0 ? 1.0 : 0.0) - v3_dot(q->n, n));
        G = v3_madd(G, q->du, q->n);
    }
    if (fl_places_add(w, (fl_place){.overlap = R, .du = sum, .n = n, .p = deep->pa})) return -1;
    if (deep->of != 0) return 0;
    const fl_vec3 c = v3_cross(deep->ea, deep->eb), across = v3_madd(G, -v3_dot(G, n), n);
    const double sign = v3_dot(c, n) > 0.0 ? 1.0 : -1.0;
    const fl_vec3 couple =
        v3_scale(sign * deep->depth / v3_norm(c), v3_cross(deep->ea, v3_cross(deep->eb, across)));
    w->couple = v3_add(w->couple, couple);
    return 0;
}

int fl_places_find(fl_places *w, const fl_poly *a, const fl_poly *b, double ra, double rb, fl_vec3 n,
                   const fl_overlap *deep, fl_matches *l)
{
    const double depth = deep->depth, R = ra + rb + depth, rim = FL_PLACE_RIM * (ra + rb);
    const fl_vec3 out = v3_scale(depth, n);
    const fl_side A = {a, w->va, w->na, ra, 1.0}, B = {b, b->v, b->n, rb, -1.0};
    w->n = 0;
    w->couple = v3(0, 0, 0);
    const fl_vec3 o = w->o;
    if (depth > 0.0) {
        for (int32_t v = 0; v < a->nv; v++) w->va[v] = v3_add(w->va[v], out);
        w->o = v3_add(o, out);
    }
    if ((depth > 0.0 || !fl_matches_hold(l, &w->M, w->o)) && list_matches(w, &A, &B, R, n, depth > 0.0, l))
        return -1;
    if (fl_matches_places(w, l, &A, &B, R, 0.0, rim, rim)) return -1;
    if (v3_norm2(deep->n) == 0.0) return 0; /* the cores do not meet */
    l->shift2 = 0.0;                        /* of cores that were moved */
    w->o = o;
    for (int32_t v = 0; v < a->nv; v++) w->va[v] = v3_sub(w->va[v], out);
    return add_depth(w, deep, R);
}

int fl_places_known(fl_places *w, const fl_poly *a, const fl_poly *b, double ra, double rb, fl_mat3 M,
                    fl_vec3 o, const fl_matches *l)
{
    const double rim = FL_PLACE_RIM * (ra + rb);
    if (fl_matches_enter(w, l, a, M, o)) return -1;
    const fl_side A = {a, w->va, w->na, ra, 1.0}, B = {b, b->v, b->n, rb, -1.0};
    w->n = 0;
    w->couple = v3(0, 0, 0);
    return fl_matches_places(w, l, &A, &B, ra + rb, 0.0, rim, rim);
}

int fl_places_plane(fl_places *w, const fl_poly *a, double ra, double *distance)
{
    const fl_side A = {a, w->va, w->na, ra, 1.0};
    w->n = 0;
    w->couple = v3(0, 0, 0);
    *distance = INFINITY;
    for (int32_t v = 0; v < a->nv; v++) *distance = fmin(*distance, w->va[v].z);
    if (*distance >= ra) return 0;
    for (int32_t v = 0; v < a->nv; v++)
        if (w->va[v].z < ra && fl_places_vertex(w, &A, 0.0, v, v3(0, 0, 1), ra - w->va[v].z)) return -1;
    if (fl_strips_begin(w)) return -1;
    for (int32_t e = 0; e < a->ne; e++)
        if ((w->va[a->edge[e].a].z < ra || w->va[a->edge[e].b].z < ra) && fl_strips_plane(w, &A, e))
            return -1;
    if (fl_strips_places(w, ra)) return -1;
    for (int32_t f = 0; f < a->nf; f++)
        if (fl_areas_plane(w, &A, f, ra)) return -1;
    return 0;
}

void fl_places_free(fl_places *w)
{
    fl_reach_free(&w->of_a), fl_reach_free(&w->of_b);
    for (int k = 0; k < 2; k++) free(w->sheet[k].h), free(w->sheet[k].x);
    free(w->va), free(w->na), free(w->place), free(w->cut), free(w->lane), free(w->tilt), free(w->share);
    fl_draft_free(w->draft);
    fl_strips_free(w->strips);
    *w = (fl_places){0};
}
