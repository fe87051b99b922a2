/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/gjk_double.h"
#include <math.h>

enum { MAX_STEPS = 64 };

/* Depth of a dent over the lowest vertex, over the size of the body: the tolerance of fl_poly_make(), with a
 * margin for what adds up over some faces. */
#define DENT_TOL 4e-9

/* A triangle or tetrahedron is flat where the squared product of its edges is below this, over their squared
 * lengths: sine 1e-10.  Its signs are products of three edges with a rounding of some 2^-52, a millionth of
 * it. */
#define FLAT_TOL 1e-20

double fl_core_extent(fl_core c)
{
    if (c.p) return c.p->size;
    double r2 = 0.0;
    for (int32_t i = 1; i < c.n; i++) {
        const double s = v3_norm2(v3_sub(c.v[i], c.v[0]));
        r2 = s > r2 ? s : r2;
    }
    return sqrt(r2);
}

int32_t fl_core_support(fl_core c, fl_vec3 dir, double *low)
{
    int32_t at = 0;
    double best = 0.0;
    for (int32_t i = 1; i < c.n; i++) {
        const double s = v3_dot(dir, v3_sub(c.v[i], c.v[0]));
        if (s < best) {
            best = s;
            at = i;
        }
    }
    *low = best;
    return at;
}

static double height_of(fl_core c, fl_vec3 dir, int32_t i) { return v3_dot(dir, v3_sub(c.v[i], c.v[0])); }

static int has_edges(fl_core c) { return c.p && c.p->neighbour && c.n > FL_CORE_SMALL; }

int32_t fl_core_hill_climb(fl_core c, fl_vec3 dir, int32_t from, double *low)
{
    if (!has_edges(c)) return fl_core_support(c, dir, low);
    int32_t at = from, before;
    double best = height_of(c, dir, at);
    do {
        before = at;
        for (int32_t k = c.p->neighbour_first[before]; k < c.p->neighbour_first[before + 1]; k++) {
            const double h = height_of(c, dir, c.p->neighbour[k]);
            if (h < best) {
                best = h;
                at = c.p->neighbour[k];
            }
        }
    } while (at != before);
    *low = best;
    return at;
}

/* As fl_core_support(), storing the heights. */
static int32_t support_with_heights(fl_core c, fl_vec3 dir, int32_t from, fl_support_heights *h)
{
    if (c.n > FL_CORE_SMALL) return fl_core_hill_climb(c, dir, from, &h->low);
    int32_t at = 0;
    double best = h->of[0] = 0.0;
    for (int32_t i = 1; i < c.n; i++) {
        const double s = h->of[i] = v3_dot(dir, v3_sub(c.v[i], c.v[0]));
        if (s < best) {
            best = s;
            at = i;
        }
    }
    h->low = best;
    return at;
}

static int is_listed(int32_t n, const int32_t *at, int32_t i)
{
    for (int32_t k = 0; k < n; k++)
        if (at[k] == i) return 1;
    return 0;
}

/* The vertices connected with the lowest one and below low + reach, in any order; *low falls if one of them
 * is lower than the vertex that hill climbing found.  FL_CORE_SMALL + 1 for too many. */
static int32_t connected_band(fl_core c, fl_vec3 dir, int32_t from, double reach, int32_t *at, double *h,
                              double *low, double *outside)
{
    int32_t n = 0;
    at[n] = fl_core_hill_climb(c, dir, from, low);
    h[n++] = *low;
    *outside = INFINITY;
    for (int32_t i = 0; i < n; i++)
        for (int32_t k = c.p->neighbour_first[at[i]]; k < c.p->neighbour_first[at[i] + 1]; k++) {
            const int32_t v = c.p->neighbour[k];
            const double t = height_of(c, dir, v);
            if (t > *low + reach) {
                *outside = t < *outside ? t : *outside;
                continue;
            }
            if (is_listed(n, at, v)) continue;
            if (n == FL_CORE_SMALL) return FL_CORE_SMALL + 1;
            *low = t < *low ? t : *low;
            at[n] = v;
            h[n++] = t;
        }
    return n;
}

/* fl_core_support_band() for a core with known edges. */
static int32_t band_by_edges(fl_core c, fl_vec3 dir, int32_t from, double band, int32_t *at, double *above,
                             double *clear)
{
    int32_t found[FL_CORE_SMALL], k = 0;
    double high[FL_CORE_SMALL], low, outside;
    const double dent = DENT_TOL * c.p->size;
    const int32_t n =
        connected_band(c, dir, from, dent > 2.0 * band ? dent : 2.0 * band, found, high, &low, &outside);
    if (n > FL_CORE_SMALL) return n;
    const double border = low + band;
    double inside = low;
    for (int32_t i = 0; i < n; i++) {
        if (high[i] > border) {
            outside = high[i] < outside ? high[i] : outside;
            continue;
        }
        inside = high[i] > inside ? high[i] : inside;
        int32_t j = k++;
        for (; j > 0 && at[j - 1] > found[i]; j--) {
            at[j] = at[j - 1];
            above[j] = above[j - 1];
        }
        at[j] = found[i];
        above[j] = high[i] - low;
    }
    *clear = outside - border < border - inside ? outside - border : border - inside;
    return k;
}

int32_t fl_core_support_band(fl_core c, fl_vec3 dir, const fl_support_heights *h, int32_t from, double band,
                             int32_t *at, double *above, double *clear)
{
    if (has_edges(c)) return band_by_edges(c, dir, from, band, at, above, clear);
    const int few = c.n <= FL_CORE_SMALL;
    fl_support_heights own;
    if (few && !h) {
        support_with_heights(c, dir, 0, &own);
        h = &own;
    }
    double low, inside, outside = INFINITY;
    if (few) low = h->low;
    else fl_core_support(c, dir, &low);
    const double border = low + band;
    inside = low;
    int32_t k = 0;
    for (int32_t i = 0; i < c.n; i++) {
        const double t = few ? h->of[i] : height_of(c, dir, i);
        if (t > border) {
            outside = t < outside ? t : outside;
            continue;
        }
        if (k == FL_CORE_SMALL) return FL_CORE_SMALL + 1;
        inside = t > inside ? t : inside;
        at[k] = i;
        above[k++] = t - low;
    }
    *clear = outside - border < border - inside ? outside - border : border - inside;
    return k;
}

typedef struct {
    double d2;
    fl_vec3 v;
    int32_t n, k[3]; /* vertex differences that carry v */
} closest;

static void try_point(const fl_vec3 *w, int32_t i, closest *best)
{
    const double d2 = v3_norm2(w[i]);
    if (d2 < best->d2) *best = (closest){d2, w[i], 1, {i, 0, 0}};
}

static void try_segment(const fl_vec3 *w, int32_t i, int32_t j, closest *best)
{
    const fl_vec3 e = v3_sub(w[j], w[i]);
    const double ee = v3_norm2(e), t = -v3_dot(w[i], e);
    if (!(t > 0.0) || !(ee > 0.0)) {
        try_point(w, i, best);
    } else if (t >= ee) {
        try_point(w, j, best);
    } else {
        const fl_vec3 v = v3_madd(w[i], t / ee, e);
        const double d2 = v3_norm2(v);
        if (d2 < best->d2) *best = (closest){d2, v, 2, {i, j, 0}};
    }
}

static void try_triangle(const fl_vec3 *w, int32_t i, int32_t j, int32_t k, closest *best)
{
    const fl_vec3 ab = v3_sub(w[j], w[i]), ac = v3_sub(w[k], w[i]), m = v3_cross(ab, ac);
    const double mm = v3_norm2(m);
    /* Without area the signs below are noise: use the sides. */
    if (mm <= FLAT_TOL * v3_norm2(ab) * v3_norm2(ac)) {
        try_segment(w, i, j, best);
        try_segment(w, j, k, best);
        try_segment(w, k, i, best);
        return;
    }
    const double wi = v3_dot(m, v3_cross(w[j], w[k])), wj = v3_dot(m, v3_cross(w[k], w[i])),
                 wk = v3_dot(m, v3_cross(w[i], w[j]));
    if (wi > 0.0 && wj > 0.0 && wk > 0.0) {
        const fl_vec3 v = v3_scale(v3_dot(m, w[i]) / mm, m);
        const double d2 = v3_norm2(v);
        if (d2 < best->d2) *best = (closest){d2, v, 3, {i, j, k}};
        return;
    }
    if (wi <= 0.0) try_segment(w, j, k, best);
    if (wj <= 0.0) try_segment(w, k, i, best);
    if (wk <= 0.0) try_segment(w, i, j, best);
}

/* Point of the simplex closest to the origin; the simplex shrinks to the vertex differences that carry it.
 * Returns 1 when the origin seems to be inside. */
static int reduce_simplex(fl_simplex *s, closest *best)
{
    static const int32_t face[4][4] = {{0, 1, 2, 3}, {0, 3, 1, 2}, {0, 2, 3, 1}, {1, 3, 2, 0}};
    const fl_vec3 *w = s->w;
    *best = (closest){.d2 = INFINITY};
    if (s->n == 1) {
        try_point(w, 0, best);
    } else if (s->n == 2) {
        try_segment(w, 0, 1, best);
    } else if (s->n == 3) {
        try_triangle(w, 0, 1, 2, best);
    } else {
        const fl_vec3 e1 = v3_sub(w[1], w[0]), e2 = v3_sub(w[2], w[0]), e3 = v3_sub(w[3], w[0]);
        const double det = v3_dot(e1, v3_cross(e2, e3));
        const int flat = det * det <= FLAT_TOL * v3_norm2(e1) * v3_norm2(e2) * v3_norm2(e3);
        int outside = 0;
        for (int32_t f = 0; f < 4; f++) {
            const fl_vec3 p = w[face[f][0]];
            const fl_vec3 m = v3_cross(v3_sub(w[face[f][1]], p), v3_sub(w[face[f][2]], p));
            const double o = -v3_dot(m, p), q = v3_dot(m, v3_sub(w[face[f][3]], p));
            if (flat || o * q <= 0.0) {
                outside = 1;
                try_triangle(w, face[f][0], face[f][1], face[f][2], best);
            }
        }
        if (!outside) return 1;
    }
    fl_simplex t = {.n = best->n};
    for (int32_t k = 0; k < t.n; k++) {
        t.a[k] = s->a[best->k[k]];
        t.b[k] = s->b[best->k[k]];
        t.w[k] = w[best->k[k]];
    }
    *s = t;
    return 0;
}

static void append_pair(fl_simplex *s, fl_core a, fl_core b, int32_t i, int32_t j)
{
    s->a[s->n] = i;
    s->b[s->n] = j;
    s->w[s->n++] = v3_sub(a.v[i], b.v[j]);
}

int fl_simplex_has(int32_t n, const int32_t *a, const int32_t *b, int32_t i, int32_t j)
{
    for (int32_t k = 0; k < n; k++)
        if (a[k] == i && b[k] == j) return 1;
    return 0;
}

void fl_simplex_start(fl_simplex *s, fl_core a, fl_core b, const fl_gjk_cache *cache)
{
    s->n = 0;
    for (int32_t k = 0; cache && k < cache->n && k < 4; k++) {
        const int32_t i = cache->a[k], j = cache->b[k];
        if (i < 0 || i >= a.n || j < 0 || j >= b.n) {
            s->n = 0;
            break;
        }
        if (!fl_simplex_has(s->n, s->a, s->b, i, j)) append_pair(s, a, b, i, j);
    }
    if (s->n == 0) append_pair(s, a, b, 0, 0);
}

int fl_gjk_double(fl_core a, fl_core b, double size, fl_simplex *s, fl_vec3 *n, fl_support_heights *h,
                  int32_t *steps)
{
    closest now;
    int32_t i = s->a[0], j = s->b[0];
    if (reduce_simplex(s, &now)) {
        /* A stale start may be a flat or wrong tetrahedron, no proof of overlap: start again. */
        fl_simplex_start(s, a, b, 0);
        reduce_simplex(s, &now);
    }
    for (int step = 0; step < MAX_STEPS; step++) {
        const double d = sqrt(now.d2);
        if (!(d > FL_GJK_DD_BELOW * size)) return 0;
        *n = v3_scale(1.0 / d, now.v);
        i = support_with_heights(a, *n, i, &h[0]);
        j = support_with_heights(b, v3_neg(*n), j, &h[1]);
        ++*steps;
        /* how far the new vertex pair lies below a pair that carries v */
        const double below = v3_dot(*n, v3_sub(a.v[s->a[0]], a.v[0])) - h[0].low -
                             v3_dot(*n, v3_sub(b.v[s->b[0]], b.v[0])) - h[1].low;
        if (below <= FL_SUPPORT_ROUNDING * size || fl_simplex_has(s->n, s->a, s->b, i, j)) return 1;
        fl_simplex t = *s;
        append_pair(&t, a, b, i, j);
        closest next;
        if (reduce_simplex(&t, &next)) return 0;
        if (!(next.d2 < now.d2)) return 1; /* the remaining gain is rounding; stage 3 handles it */
        *s = t;
        now = next;
    }
    return 0;
}
