/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/gjk.h"
#include <float.h>
#include "geom/dd.h"

/* Lengths below are relative to the extent E of the cores: the sum of the largest distances of a vertex of
 * each from its first. */

/* Where stage 1 hands over to pairs of doubles.  The nearest point v of a simplex of size E carries a
 * rounding of a few 2^-53 E, so its direction one of a few 2^-53 E / d: at 1e-4 E about 1e-12 rad, which
 * is what the header promises. */
#define D_FINE 1e-4

/* How far beyond a supporting plane a vertex may seem to lie: the dot product of a unit vector and a
 * difference has an error of at most 3 units of 2^-53, on either core, and two are compared. */
#define SUPPORT_ROUNDING (8.0 * DBL_EPSILON)

/* Who belongs to a supporting plane in stage 3.  A hundred times the rounding that stage 1 may leave in n at
 * d = D_FINE, so that the true nearest feature is always among them. */
#define PLANE_BAND 1e-10

/* Vertices of a supporting plane nearer to each other than this are told apart in pairs of doubles: a
 * rounding of 2^-53 E across an edge this short turns the plane by 1e-13. */
#define EDGE_FINE 1e-3

/* |v| below this is a touch: 2^-90, some bits above the rounding of a difference of pairs of doubles. */
#define TOUCH 8.1e-28

/* A direction found in doubles is taken when no vertex lies beyond its planes by more than this: the
 * direction of a vertex and an edge a hundred times as near as the end of the edge is far, the worst that
 * is left to doubles, has an error of 4 * 2^-53 * 100. */
#define PROOF 5e-14

enum { DOUBLE_STEPS = 64, FINE_STEPS = 4096, PLANE_MAX = 64 };

typedef struct {
    int32_t n, a[4], b[4];
    fl_vec3 w[4]; /* v_a[a[k]] - v_b[b[k]] */
} simplex;

typedef struct {
    int32_t n, a[4], b[4];
    fl_ddv w[4];
} fine_simplex;

static double extent(fl_core c)
{
    double r2 = 0.0;
    for (int32_t i = 1; i < c.n; i++) {
        const double s = v3_norm2(v3_sub(c.v[i], c.v[0]));
        r2 = s > r2 ? s : r2;
    }
    return sqrt(r2);
}

/* The vertex lowest along dir, the first of equals; *low is its height above vertex 0.  Differences come
 * first, so that far from the origin nothing is lost. */
static int32_t lowest(fl_core c, fl_vec3 dir, double *low)
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

/* ---- Stage 1: doubles -------------------------------------------------------------------------------- */

typedef struct {
    double d2;
    fl_vec3 v;
    int32_t n, k[3]; /* the points that carry v */
} nearest;

static void try_point(const fl_vec3 *w, int32_t i, nearest *best)
{
    const double d2 = v3_norm2(w[i]);
    if (d2 < best->d2) *best = (nearest){d2, w[i], 1, {i, 0, 0}};
}

static void try_segment(const fl_vec3 *w, int32_t i, int32_t j, nearest *best)
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
        if (d2 < best->d2) *best = (nearest){d2, v, 2, {i, j, 0}};
    }
}

static void try_triangle(const fl_vec3 *w, int32_t i, int32_t j, int32_t k, nearest *best)
{
    const fl_vec3 ab = v3_sub(w[j], w[i]), ac = v3_sub(w[k], w[i]), m = v3_cross(ab, ac);
    const double mm = v3_norm2(m);
    /* Without area the signs below are noise; the sides decide. */
    if (mm <= 1e-20 * v3_norm2(ab) * v3_norm2(ac)) {
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
        if (d2 < best->d2) *best = (nearest){d2, v, 3, {i, j, k}};
        return;
    }
    if (wi <= 0.0) try_segment(w, j, k, best);
    if (wj <= 0.0) try_segment(w, k, i, best);
    if (wk <= 0.0) try_segment(w, i, j, best);
}

/* Nearest point of the simplex to the origin; the simplex shrinks to the points that carry it.  Returns 1
 * when the origin seems to be inside. */
static int reduce(simplex *s, nearest *best)
{
    static const int32_t face[4][4] = {{0, 1, 2, 3}, {0, 3, 1, 2}, {0, 2, 3, 1}, {1, 3, 2, 0}};
    const fl_vec3 *w = s->w;
    *best = (nearest){.d2 = INFINITY};
    if (s->n == 1) {
        try_point(w, 0, best);
    } else if (s->n == 2) {
        try_segment(w, 0, 1, best);
    } else if (s->n == 3) {
        try_triangle(w, 0, 1, 2, best);
    } else {
        const fl_vec3 e1 = v3_sub(w[1], w[0]), e2 = v3_sub(w[2], w[0]), e3 = v3_sub(w[3], w[0]);
        const double det = v3_dot(e1, v3_cross(e2, e3));
        const int flat = det * det <= 1e-20 * v3_norm2(e1) * v3_norm2(e2) * v3_norm2(e3);
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
    simplex t = {.n = best->n};
    for (int32_t k = 0; k < t.n; k++) {
        t.a[k] = s->a[best->k[k]];
        t.b[k] = s->b[best->k[k]];
        t.w[k] = w[best->k[k]];
    }
    *s = t;
    return 0;
}

static void push(simplex *s, fl_core a, fl_core b, int32_t i, int32_t j)
{
    s->a[s->n] = i;
    s->b[s->n] = j;
    s->w[s->n++] = v3_sub(a.v[i], b.v[j]);
}

static int has(int32_t n, const int32_t *a, const int32_t *b, int32_t i, int32_t j)
{
    for (int32_t k = 0; k < n; k++)
        if (a[k] == i && b[k] == j) return 1;
    return 0;
}

static void start(simplex *s, fl_core a, fl_core b, const fl_gjk_cache *cache)
{
    s->n = 0;
    for (int32_t k = 0; cache && k < cache->n && k < 4; k++) {
        const int32_t i = cache->a[k], j = cache->b[k];
        if (i < 0 || i >= a.n || j < 0 || j >= b.n) {
            s->n = 0;
            break;
        }
        if (!has(s->n, s->a, s->b, i, j)) push(s, a, b, i, j);
    }
    if (s->n == 0) push(s, a, b, 0, 0);
}

enum verdict { APART, DOUBTFUL };

/* From the simplex s to the nearest point *v in doubles.  DOUBTFUL when it cannot be told: the cores may
 * meet, or are so near that the rounding would turn v, or there was no end. */
static enum verdict descend(fl_core a, fl_core b, double size, simplex *s, fl_vec3 *v, int32_t *steps)
{
    nearest now;
    if (reduce(s, &now)) {
        /* A stale start may be a flat or a wrong tetrahedron: no proof.  Begin again. */
        start(s, a, b, 0);
        reduce(s, &now);
    }
    for (int step = 0; step < DOUBLE_STEPS; step++) {
        const double d = sqrt(now.d2);
        *v = now.v;
        if (!(d > D_FINE * size)) return DOUBTFUL;
        const fl_vec3 n = v3_scale(1.0 / d, now.v);
        double la, lb;
        const int32_t i = lowest(a, n, &la), j = lowest(b, v3_neg(n), &lb);
        ++*steps;
        /* How far the new pair of vertices lies below a pair that carries v. */
        const double below =
            v3_dot(n, v3_sub(a.v[s->a[0]], a.v[0])) - la - v3_dot(n, v3_sub(b.v[s->b[0]], b.v[0])) - lb;
        if (below <= SUPPORT_ROUNDING * size || has(s->n, s->a, s->b, i, j)) return APART;
        simplex t = *s;
        push(&t, a, b, i, j);
        nearest next;
        if (reduce(&t, &next)) return DOUBTFUL;
        if (!(next.d2 < now.d2)) return APART; /* what is left to gain is rounding; stage 3 sees to it */
        *s = t;
        now = next;
    }
    return DOUBTFUL;
}

/* ---- Stage 2: pairs of doubles ------------------------------------------------------------------------ */

typedef struct {
    fl_dd d2;
    fl_ddv v;
    int32_t n, k[4];
    double share[4]; /* v = sum of share[i] w[k[i]], shares sum to 1 */
} fine_nearest;

/* Points without a length, an area or a volume are left to their parts: the square of 1e-29, the rounding
 * of a product of pairs of doubles with a margin. */
#define FINE_FLAT 1e-58

/* The point c->v of the affine hull of the points c->k[0 .. c->n) nearest to the origin, if it lies
 * inside them. */
static int fine_project(const fine_simplex *s, fine_nearest *c)
{
    const fl_ddv p = s->w[c->k[0]];
    c->share[0] = 1.0;
    c->v = p;
    if (c->n == 1) return 1;
    const fl_ddv q = s->w[c->k[1]], e = ddv_sub(q, p);
    const fl_dd ee = ddv_dot(e, e);
    if (c->n == 2) {
        const fl_dd t = dd_neg(ddv_dot(p, e));
        if (!(ee.h > 0.0) || !(t.h > 0.0) || !(dd_cmp(t, ee) < 0.0)) return 0;
        const fl_dd x = dd_div(t, ee);
        c->v = ddv_madd(p, x, e);
        c->share[0] = 1.0 - x.h;
        c->share[1] = x.h;
        return 1;
    }
    const fl_ddv r = s->w[c->k[2]], g = ddv_sub(r, p), m = ddv_cross(e, g);
    const double gg = ddv_dot(g, g).h;
    if (c->n == 3) {
        const fl_dd mm = ddv_dot(m, m);
        if (!(mm.h > FINE_FLAT * ee.h * gg)) return 0;
        const double x[3] = {ddv_dot(m, ddv_cross(q, r)).h, ddv_dot(m, ddv_cross(r, p)).h,
                             ddv_dot(m, ddv_cross(p, q)).h};
        if (!(x[0] > 0.0 && x[1] > 0.0 && x[2] > 0.0)) return 0;
        for (int32_t k = 0; k < 3; k++) c->share[k] = x[k] / mm.h;
        c->v = ddv_scale(dd_div(ddv_dot(m, p), mm), m);
        return 1;
    }
    const fl_ddv t = s->w[c->k[3]], h = ddv_sub(t, p);
    const double det = ddv_dot(m, h).h;
    if (!(det * det > FINE_FLAT * ee.h * gg * ddv_dot(h, h).h)) return 0;
    /* Volumes of the four tetrahedra that the origin makes with the faces, over that of the whole. */
    const double x[4] = {ddv_dot(q, ddv_cross(r, t)).h / det, -ddv_dot(p, ddv_cross(r, t)).h / det,
                         ddv_dot(p, ddv_cross(q, t)).h / det, -ddv_dot(p, ddv_cross(q, r)).h / det};
    for (int32_t k = 0; k < 4; k++) {
        if (x[k] < 0.0) return 0;
        c->share[k] = x[k];
    }
    c->v = (fl_ddv){dd_of(0.0), dd_of(0.0), dd_of(0.0)};
    return 1;
}

/* Tries every part of the simplex, so that no test of a sign can lose the nearest one. */
static void fine_reduce(fine_simplex *s, fine_nearest *best)
{
    *best = (fine_nearest){.d2 = {INFINITY, 0.0}};
    for (int32_t set = 1; set < 1 << s->n; set++) {
        fine_nearest c = {.n = 0};
        for (int32_t k = 0; k < s->n; k++)
            if (set >> k & 1) c.k[c.n++] = k;
        if (!fine_project(s, &c)) continue;
        c.d2 = ddv_dot(c.v, c.v);
        if (best->n == 0 || dd_cmp(c.d2, best->d2) < 0.0) *best = c;
    }
    fine_simplex t = {.n = best->n};
    for (int32_t k = 0; k < t.n; k++) {
        t.a[k] = s->a[best->k[k]];
        t.b[k] = s->b[best->k[k]];
        t.w[k] = s->w[best->k[k]];
    }
    *s = t;
}

/* As lowest(), the ties of the doubles decided in pairs. */
static int32_t fine_lowest(fl_core c, fl_ddv n, double size)
{
    double low;
    int32_t at = lowest(c, ddv_round(n), &low);
    const double border = low + SUPPORT_ROUNDING * size;
    fl_dd best = ddv_dot(n, ddv_diff(c.v[at], c.v[0]));
    for (int32_t i = 0; i < c.n; i++) {
        if (i == at || v3_dot(ddv_round(n), v3_sub(c.v[i], c.v[0])) > border) continue;
        const fl_dd s = ddv_dot(n, ddv_diff(c.v[i], c.v[0]));
        if (dd_cmp(s, best) < 0.0) {
            best = s;
            at = i;
        }
    }
    return at;
}

/* The same descent in pairs of doubles, into d, n, pa, pb and overlap of *out.  Returns out->overlap. */
static int fine_descend(fl_core a, fl_core b, double size, simplex *s, fl_gap *out)
{
    fine_simplex f = {.n = s->n};
    fine_nearest now;
    const double whole = size > 0.0 ? size : v3_norm(v3_sub(a.v[0], b.v[0]));
    for (int32_t k = 0; k < s->n; k++) {
        f.a[k] = s->a[k];
        f.b[k] = s->b[k];
        f.w[k] = ddv_diff(a.v[f.a[k]], b.v[f.b[k]]);
    }
    fine_reduce(&f, &now);
    for (int step = 0; step < FINE_STEPS; step++) {
        const double len = sqrt(now.d2.h > 0.0 ? now.d2.h : 0.0);
        if (!(len > TOUCH * whole)) {
            out->overlap = 1;
            break;
        }
        const fl_ddv dir = ddv_scale(dd_div(dd_of(1.0), dd_of(len)), now.v);
        const int32_t i = fine_lowest(a, dir, size),
                      j = fine_lowest(b, (fl_ddv){dd_neg(dir.x), dd_neg(dir.y), dd_neg(dir.z)}, size);
        out->iterations++;
        if (has(f.n, f.a, f.b, i, j)) break;
        const fl_ddv w = ddv_diff(a.v[i], b.v[j]);
        if (!(ddv_dot(dir, ddv_sub(f.w[0], w)).h > 0.0)) break;
        fine_simplex t = f;
        t.a[t.n] = i;
        t.b[t.n] = j;
        t.w[t.n++] = w;
        fine_nearest next;
        fine_reduce(&t, &next);
        if (!(dd_cmp(next.d2, now.d2) < 0.0)) break;
        f = t;
        now = next;
    }
    out->d = out->overlap ? 0.0 : sqrt(now.d2.h);
    out->n = out->overlap ? v3(0, 0, 0) : v3_unit(v3_scale(1.0 / out->d, ddv_round(now.v)));
    out->pa = a.v[f.a[0]];
    out->pb = b.v[f.b[0]];
    for (int32_t k = 1; k < f.n; k++) {
        out->pa = v3_madd(out->pa, now.share[k], v3_sub(a.v[f.a[k]], a.v[f.a[0]]));
        out->pb = v3_madd(out->pb, now.share[k], v3_sub(b.v[f.b[k]], b.v[f.b[0]]));
    }
    s->n = f.n;
    for (int32_t k = 0; k < f.n; k++) {
        s->a[k] = f.a[k];
        s->b[k] = f.b[k];
        s->w[k] = ddv_round(f.w[k]);
    }
    return out->overlap;
}

/* ---- Stage 3: the nearest features, from their vertices alone ------------------------------------------ */

typedef struct {
    int32_t n, i[3];
    fl_vec3 v[3];
} feature;

typedef struct {
    fl_core a, b;
    feature fa, fb; /* at most a triangle of each */
    int fine;
    double ok;    /* a slack that is rounding */
    double slack; /* of *out; infinite while there is none */
    fl_gap *out;
} search;

/* A pair of points pa, pb with direction n is the nearest one when no vertex of a lies below pa and none
 * of b above pb along n.  What is missing is linear in the error of n, where the distance is only
 * quadratic: so the candidates compete by it. */
static void offer(search *s, int32_t ka, const int32_t *at_a, int32_t kb, const int32_t *at_b, double d,
                  fl_vec3 n, fl_vec3 pa, fl_vec3 pb)
{
    double sa = 0.0, sb = 0.0;
    if (!(d > 0.0) || !isfinite(d)) return;
    for (int32_t k = 0; k < s->fa.n; k++) {
        const double t = v3_dot(n, v3_sub(s->fa.v[at_a[0]], s->fa.v[k]));
        sa = t > sa ? t : sa;
    }
    for (int32_t k = 0; k < s->fb.n; k++) {
        const double t = v3_dot(n, v3_sub(s->fb.v[k], s->fb.v[at_b[0]]));
        sb = t > sb ? t : sb;
    }
    if (!(sa + sb < s->slack)) return;
    s->slack = sa + sb;
    fl_gap *g = s->out;
    g->d = d;
    g->n = n;
    g->pa = pa;
    g->pb = pb;
    g->na = ka;
    g->nb = kb;
    for (int32_t k = 0; k < 3; k++) {
        g->ia[k] = k < ka ? s->fa.i[at_a[k]] : 0;
        g->ib[k] = k < kb ? s->fb.i[at_b[k]] : 0;
    }
}

static void offer_points(search *s, int32_t i, int32_t j)
{
    const fl_vec3 p = s->fa.v[i], q = s->fb.v[j];
    const fl_ddv w = ddv_diff(p, q); /* exact; scaled by its largest part, so that nothing underflows */
    const fl_vec3 r = ddv_round(w);
    const double m = fmax(fabs(r.x), fmax(fabs(r.y), fabs(r.z)));
    if (!(m > 0.0)) return;
    const double d = m * v3_norm(v3_scale(1.0 / m, r));
    offer(s, 1, &i, 1, &j, d, v3_unit(v3_scale(1.0 / m, r)), p, q);
}

/* The vertex p against the edge from e0 to e1; swapped says that the vertex is b's. */
static void offer_edge(search *s, int32_t i, const int32_t *e, int swapped)
{
    const fl_vec3 p = swapped ? s->fb.v[i] : s->fa.v[i];
    fl_vec3 e0 = swapped ? s->fa.v[e[0]] : s->fb.v[e[0]], e1 = swapped ? s->fa.v[e[1]] : s->fb.v[e[1]];
    /* From the nearer end the offset is the smaller part of the difference that it is taken from. */
    if (v3_norm2(v3_sub(p, e1)) < v3_norm2(v3_sub(p, e0))) {
        const fl_vec3 swap = e0;
        e0 = e1;
        e1 = swap;
    }
    const fl_vec3 u = v3_sub(p, e0), l = v3_sub(e1, e0);
    const double ll = v3_norm2(l);
    if (!(ll > 0.0)) return;
    double t = v3_dot(u, l) / ll, d;
    fl_vec3 w = v3_madd(u, -t, l), n;
    if (s->fine || v3_norm2(w) < 1e-4 * v3_norm2(u)) {
        const fl_ddv uu = ddv_diff(p, e0), le = ddv_diff(e1, e0);
        const fl_dd tt = dd_div(ddv_dot(uu, le), ddv_dot(le, le));
        t = tt.h;
        w = ddv_round(ddv_madd(uu, dd_neg(tt), le));
    }
    if (!(t > 0.0 && t < 1.0)) return;
    d = v3_norm(w);
    if (!(d > 0.0)) return;
    n = v3_unit(v3_scale(1.0 / d, w));
    const fl_vec3 foot = v3_madd(e0, t, l);
    if (swapped) offer(s, 2, e, 1, &i, d, v3_neg(n), foot, p);
    else offer(s, 1, &i, 2, e, d, n, p, foot);
}

/* The unit vector across p - q and r - o, turned to where x - y points, and the height |x - y| along it;
 * in pairs of doubles where it would lose digits.  Returns 0 where there is none. */
static int across(fl_vec3 p, fl_vec3 q, fl_vec3 r, fl_vec3 o, fl_vec3 x, fl_vec3 y, int fine, fl_vec3 *n,
                  double *h)
{
    const fl_vec3 e = v3_sub(p, q), g = v3_sub(r, o);
    fl_vec3 m = v3_cross(e, g);
    const int sharp = v3_norm2(m) > 1e-4 * v3_norm2(e) * v3_norm2(g);
    if (!fine && sharp) {
        *n = v3_unit(m);
        *h = v3_dot(*n, v3_sub(x, y));
    } else {
        const fl_ddv mm = ddv_cross(ddv_diff(p, q), ddv_diff(r, o));
        m = ddv_round(mm);
        const double len = v3_norm(m);
        if (!(len > 0.0)) return 0;
        *n = v3_scale(1.0 / len, m);
        *h = ddv_dot(mm, ddv_diff(x, y)).h / len;
    }
    if (*h < 0.0) {
        *h = -*h;
        *n = v3_neg(*n);
    }
    return *h > 0.0;
}

/* The vertex p against the triangle of the other core. */
static void offer_triangle(search *s, int32_t i, int swapped)
{
    static const int32_t all[3] = {0, 1, 2};
    const fl_vec3 p = swapped ? s->fb.v[i] : s->fa.v[i];
    const fl_vec3 *t = swapped ? s->fa.v : s->fb.v;
    fl_vec3 n;
    double h;
    if (!across(t[1], t[0], t[2], t[0], p, t[0], s->fine, &n, &h)) return;
    const double turn = v3_dot(n, v3_cross(v3_sub(t[1], t[0]), v3_sub(t[2], t[0]))) < 0.0 ? -1.0 : 1.0;
    for (int32_t k = 0; k < 3; k++) {
        const fl_vec3 q = t[k], r = t[(k + 1) % 3];
        if (!(turn * v3_dot(n, v3_cross(v3_sub(r, q), v3_sub(p, q))) > 0.0)) return;
    }
    const fl_vec3 foot = v3_madd(p, -h, n);
    if (swapped) offer(s, 3, all, 1, &i, h, v3_neg(n), foot, p);
    else offer(s, 1, &i, 3, all, h, n, p, foot);
}

static void offer_edges(search *s, const int32_t *ea, const int32_t *eb)
{
    const fl_vec3 a0 = s->fa.v[ea[0]], a1 = s->fa.v[ea[1]], b0 = s->fb.v[eb[0]], b1 = s->fb.v[eb[1]];
    const fl_vec3 la = v3_sub(a1, a0), lb = v3_sub(b1, b0), w = v3_sub(a0, b0);
    fl_vec3 n;
    double h;
    if (!across(a1, a0, b1, b0, a0, b0, s->fine, &n, &h)) return;
    /* The lines come nearest at a0 + x la and b0 + y lb; |la x lb| = n.(la x lb), signed. */
    const double m = v3_dot(n, v3_cross(la, lb)), x = v3_dot(n, v3_cross(lb, w)) / m,
                 y = v3_dot(n, v3_cross(la, w)) / m;
    if (!(x > 0.0 && x < 1.0 && y > 0.0 && y < 1.0)) return;
    offer(s, 2, ea, 2, eb, h, n, v3_madd(a0, x, la), v3_madd(b0, y, lb));
}

static const int32_t side[3][2] = {{0, 1}, {0, 2}, {1, 2}};

/* The nearest points of two features of at most three vertices each: every pair of their parts, those of
 * higher dimension first, until one leaves nothing to gain. */
static void compare_parts(search *s)
{
    const int32_t na = s->fa.n, nb = s->fb.n, ea = na == 3 ? 3 : na - 1, eb = nb == 3 ? 3 : nb - 1;
    s->slack = INFINITY;
    if (nb == 3)
        for (int32_t i = 0; i < na && s->slack > s->ok; i++) offer_triangle(s, i, 0);
    if (na == 3)
        for (int32_t i = 0; i < nb && s->slack > s->ok; i++) offer_triangle(s, i, 1);
    for (int32_t e = 0; e < ea; e++)
        for (int32_t f = 0; f < eb && s->slack > s->ok; f++) offer_edges(s, side[e], side[f]);
    for (int32_t i = 0; i < na; i++)
        for (int32_t f = 0; f < eb && s->slack > s->ok; f++) offer_edge(s, i, side[f], 0);
    for (int32_t i = 0; i < nb; i++)
        for (int32_t e = 0; e < ea && s->slack > s->ok; e++) offer_edge(s, i, side[e], 1);
    for (int32_t i = 0; i < na; i++)
        for (int32_t j = 0; j < nb && s->slack > s->ok; j++) offer_points(s, i, j);
}

/* The vertices of c within band of its lowest along n, ascending, at most PLANE_MAX; more are not counted:
 * returns PLANE_MAX + 1 then. */
static int32_t plane_of(fl_core c, fl_vec3 n, double band, int32_t *at)
{
    double low;
    int32_t k = 0;
    lowest(c, n, &low);
    for (int32_t i = 0; i < c.n; i++)
        if (v3_dot(n, v3_sub(c.v[i], c.v[0])) <= low + band) {
            if (k == PLANE_MAX) return PLANE_MAX + 1;
            at[k++] = i;
        }
    return k;
}

static int crowded(fl_core c, double size, int32_t k, const int32_t *at)
{
    const double near2 = EDGE_FINE * EDGE_FINE * size * size;
    for (int32_t i = 0; i < k; i++)
        for (int32_t j = 0; j < i; j++)
            if (v3_norm2(v3_sub(c.v[at[i]], c.v[at[j]])) < near2) return 1;
    return 0;
}

static feature feature_of(fl_core c, int32_t k, const int32_t *at)
{
    feature f = {.n = 0};
    int32_t i[4];
    for (int32_t p = 0; p < k; p++) { /* sorted, each once */
        int32_t q = f.n;
        while (q > 0 && i[q - 1] > at[p]) q--;
        if (q > 0 && i[q - 1] == at[p]) continue;
        for (int32_t r = f.n; r > q; r--) i[r] = i[r - 1];
        i[q] = at[p];
        f.n++;
    }
    for (int32_t p = 0; p < f.n; p++) {
        f.i[p] = i[p];
        f.v[p] = c.v[i[p]];
    }
    return f;
}

typedef struct {
    fl_core a, b;
    double ea, eb, size;
} pair;

/* Stage 3 for the direction n.  Returns 0 when the answer stands, -1 when it needs pairs of doubles. */
static int settle(const pair *p, fl_vec3 n, int fine, fl_gap *out)
{
    int32_t at[PLANE_MAX], bt[PLANE_MAX];
    fl_vec3 va[PLANE_MAX], vb[PLANE_MAX];
    const double band = PLANE_BAND * p->size;
    int32_t ka = plane_of(p->a, n, band, at), kb = plane_of(p->b, v3_neg(n), band, bt);
    fl_core a = p->a, b = p->b;
    const int whole = ka > PLANE_MAX || kb > PLANE_MAX; /* a fixed start on the whole cores instead */
    if (!whole) {
        if (!fine && (crowded(p->a, p->ea, ka, at) || crowded(p->b, p->eb, kb, bt))) return -1;
        for (int32_t k = 0; k < ka; k++) va[k] = p->a.v[at[k]];
        for (int32_t k = 0; k < kb; k++) vb[k] = p->b.v[bt[k]];
        a = (fl_core){va, ka};
        b = (fl_core){vb, kb};
    }
    int32_t pick_a[4] = {0, 1, 2, 3}, pick_b[4] = {0, 1, 2, 3}, na = a.n, nb = b.n;
    if (a.n + b.n > 4 || a.n > 3 || b.n > 3) {
        simplex s;
        start(&s, a, b, 0);
        if (fine) {
            if (fine_descend(a, b, p->size, &s, out)) return -1;
        } else {
            fl_vec3 v;
            if (descend(a, b, p->size, &s, &v, &out->iterations) != APART) return -1;
        }
        na = nb = s.n;
        for (int32_t k = 0; k < s.n; k++) {
            pick_a[k] = s.a[k];
            pick_b[k] = s.b[k];
        }
    }
    search q = {.a = p->a, .b = p->b, .fine = fine, .out = out};
    q.fa = feature_of(a, na, pick_a);
    q.fb = feature_of(b, nb, pick_b);
    if (!whole) {
        for (int32_t k = 0; k < q.fa.n; k++) q.fa.i[k] = at[q.fa.i[k]];
        for (int32_t k = 0; k < q.fb.n; k++) q.fb.i[k] = bt[q.fb.i[k]];
    }
    q.ok = 4.0 * DBL_EPSILON * p->size;
    compare_parts(&q);
    if (q.slack == INFINITY) return -1;
    if (fine) return 0;
    /* The proof: along the final direction no vertex at all lies beyond the two planes. */
    double la, lb;
    lowest(p->a, out->n, &la);
    lowest(p->b, v3_neg(out->n), &lb);
    const double beyond = v3_dot(out->n, v3_sub(p->a.v[out->ia[0]], p->a.v[0])) - la -
                          v3_dot(out->n, v3_sub(p->b.v[out->ib[0]], p->b.v[0])) - lb;
    return beyond <= PROOF * p->size ? 0 : -1;
}

void fl_gjk(fl_core a, fl_core b, fl_gjk_cache *cache, fl_gap *out)
{
    pair p = {a, b, extent(a), extent(b), 0.0};
    simplex s;
    fl_vec3 v;
    p.size = p.ea + p.eb;
    *out = (fl_gap){0};
    start(&s, a, b, cache);
    if (descend(a, b, p.size, &s, &v, &out->iterations) != APART || settle(&p, v3_unit(v), 0, out)) {
        *out = (fl_gap){.iterations = out->iterations};
        if (!fine_descend(a, b, p.size, &s, out)) {
            /* Doubles first here too, wherever they might do: which road was taken must not show in the bits.
             * Should the parts of the nearest features all degenerate, the descent's own answer is kept. */
            const fl_gap own = *out;
            if ((!(own.d > D_FINE * p.size) || settle(&p, own.n, 0, out)) && settle(&p, own.n, 1, out)) {
                *out = own;
                out->overlap = 0;
            }
        }
    }
    if (cache) {
        cache->n = s.n;
        for (int32_t k = 0; k < s.n; k++) {
            cache->a[k] = s.a[k];
            cache->b[k] = s.b[k];
        }
    }
}
