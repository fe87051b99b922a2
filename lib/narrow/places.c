/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/mem.h"
#include "narrow/nearest.h"
#include "narrow/places.h"

int fl_places_enter(fl_places *w, const fl_poly *a, fl_mat3 M, fl_vec3 o)
{
    fl_err lost = {0};
    if (fl_grow(&w->va, &w->va_cap, a->nv, sizeof *w->va, &lost)) return -1;
    for (int32_t v = 0; v < a->nv; v++) w->va[v] = v3_add(m3_mul(M, a->v[v]), o);
    return 0;
}

static int add(fl_places *w, fl_place place)
{
    fl_err lost = {0};
    if (fl_grow(&w->place, &w->place_cap, w->n + 1, sizeof *w->place, &lost)) return -1;
    w->place[w->n++] = place;
    return 0;
}

/* The place between the core points x - d n (of B) and x (of A): overlap s = ra + rb - d, its middle lies
 * ra - s/2 below x. */
static fl_place place_at(int64_t key, fl_vec3 x, fl_vec3 n, double overlap, double ra)
{
    return (fl_place){key, overlap, 1.0, 1.0, n, v3_madd(x, 0.5 * overlap - ra, n), v3(0, 0, 0)};
}

static int edges_of_interest(int32_t **list, int32_t *cap, const fl_poly *p, const fl_vec3 *v, fl_vec3 n,
                             double sign, double limit, fl_aabb reach)
{
    fl_err lost = {0};
    int32_t k = 0;
    if (fl_grow(list, cap, p->ne, sizeof **list, &lost)) return -1;
    for (int32_t e = 0; e < p->ne; e++) {
        const fl_vec3 a = v[p->edge[e].a], b = v[p->edge[e].b];
        const double ha = sign * v3_dot(n, a), hb = sign * v3_dot(n, b);
        if ((ha < hb ? ha : hb) >= limit) continue;
        if (aabb_meet(aabb_add((fl_aabb){a, a}, b), reach)) (*list)[k++] = e;
    }
    return k;
}

int fl_places_vertex(fl_places *w, int64_t key, fl_vec3 x, fl_vec3 n, double overlap, double ra)
{
    return add(w, place_at(key, x, n, overlap, ra));
}

/* The term of edges a0 a1 of A and b0 b1 of B, if it counts. */
int fl_places_edges(fl_places *w, int64_t key, fl_vec3 a0, fl_vec3 a1, fl_vec3 b0, fl_vec3 b1, double ra,
                    double rb, double depth)
{
    const double R = ra + rb + 2.0 * depth;
    double s, t;
    double d2 = fl_nearest_segments(a0, a1, b0, b1, &s, &t);
    if (d2 >= R * R) return 0;
    const fl_vec3 ua = v3_sub(a1, a0), ub = v3_sub(b1, b0), x = v3_cross(ua, ub);
    const double la2 = v3_norm2(ua), lb2 = v3_norm2(ub), c = v3_norm2(x) / (la2 * lb2);
    if (c == 0.0) return 0;
    const fl_vec3 pa = v3_madd(a0, s, ua), pb = v3_madd(b0, t, ub);
    const int inner = s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0;
    const double d = sqrt(d2);
    fl_vec3 n = v3_sub(pa, pb);
    if (inner) { /* the common perpendicular: keeps its direction down to d = 0 */
        const fl_vec3 along = v3_unit(x);
        n = v3_dot(along, n) < 0.0 ? v3_neg(along) : along;
    } else if (d > 0.0) {
        n = v3_scale(1.0 / d, n);
    } else {
        return 0; /* an end point on the other edge: that vertex has a place of its own */
    }
    fl_place place = place_at(key, pa, n, R - d, ra);
    place.weight = FL_PLACE_EDGE;
    if (c < FL_PLACE_PARALLEL) {
        const double y = c / FL_PLACE_PARALLEL, dm = 2.0 * (1.0 - y) / FL_PLACE_PARALLEL,
                     cosine = v3_dot(ua, ub);
        place.weight = FL_PLACE_EDGE * (2.0 - y) * y;
        /* dc/dtheta of A is -2 (e.e')(e x e'); the torque is minus the gradient */
        place.couple = v3_scale(FL_PLACE_EDGE * dm * 2.0 * cosine / (la2 * lb2), x);
    }
    return add(w, place);
}

int fl_places_find(fl_places *w, const fl_poly *a, const fl_poly *b, fl_mat3 M, fl_vec3 o, double ra,
                   double rb, fl_vec3 n, double depth)
{
    const double R = ra + rb, Re = R + 2.0 * depth;
    double low = INFINITY, high = -INFINITY;
    fl_aabb box_a = aabb_empty(), box_b = aabb_empty();
    w->n = 0;
    for (int32_t v = 0; v < a->nv; v++) {
        const double h = v3_dot(n, w->va[v]);
        low = h < low ? h : low;
        box_a = aabb_add(box_a, w->va[v]);
    }
    for (int32_t v = 0; v < b->nv; v++) {
        const double h = v3_dot(n, b->v[v]);
        high = h > high ? h : high;
        box_b = aabb_add(box_b, b->v[v]);
    }
    /* d(v, B) >= n.v - high and d(v, A) >= low - n.v: beyond R of these planes nothing counts */
    box_a = aabb_grow(box_a, R);
    box_b = aabb_grow(box_b, R);
    for (int32_t v = 0; v < a->nv; v++) {
        if (v3_dot(n, w->va[v]) >= high + R || !aabb_meet((fl_aabb){w->va[v], w->va[v]}, box_b)) continue;
        const fl_nearest q = fl_nearest_poly(b, w->va[v]);
        if (q.d < R && fl_places_vertex(w, v, w->va[v], q.n, R - q.d, ra)) return -1;
    }
    for (int32_t v = 0; v < b->nv; v++) {
        if (v3_dot(n, b->v[v]) <= low - R || !aabb_meet((fl_aabb){b->v[v], b->v[v]}, box_a)) continue;
        const fl_nearest q = fl_nearest_poly(a, m3_tmul(M, v3_sub(b->v[v], o)));
        if (q.d >= R) continue;
        /* q.n leaves A; the place's normal leaves B.  From b's vertex the nearest point of A is at +d n. */
        const fl_vec3 m = v3_neg(m3_mul(M, q.n));
        if (fl_places_vertex(w, (int64_t)a->nv + v, v3_madd(b->v[v], q.d, m), m, R - q.d, ra)) return -1;
    }
    box_a = aabb_grow(box_a, Re - R);
    box_b = aabb_grow(box_b, Re - R);
    const int na = edges_of_interest(&w->ea, &w->ea_cap, a, w->va, n, 1.0, high + Re, box_b);
    const int nb = edges_of_interest(&w->eb, &w->eb_cap, b, b->v, n, -1.0, Re - low, box_a);
    if (na < 0 || nb < 0) return -1;
    for (int32_t i = 0; i < na; i++) {
        const fl_vec3 a0 = w->va[a->edge[w->ea[i]].a], a1 = w->va[a->edge[w->ea[i]].b];
        const fl_aabb box = aabb_grow(aabb_add((fl_aabb){a0, a0}, a1), Re);
        for (int32_t j = 0; j < nb; j++) {
            const fl_vec3 b0 = b->v[b->edge[w->eb[j]].a], b1 = b->v[b->edge[w->eb[j]].b];
            if (!aabb_meet(box, aabb_add((fl_aabb){b0, b0}, b1))) continue;
            const int64_t key = (int64_t)a->nv + b->nv + (int64_t)w->ea[i] * b->ne + w->eb[j];
            if (fl_places_edges(w, key, a0, a1, b0, b1, ra, rb, depth)) return -1;
        }
    }
    return 0;
}

void fl_places_free(fl_places *w)
{
    free(w->va), free(w->ea), free(w->eb), free(w->place);
    *w = (fl_places){0};
}
