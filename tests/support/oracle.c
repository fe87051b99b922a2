/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/oracle.h"
#include <float.h>
#include <math.h>

typedef struct {
    real x, y, z;
} real_vec3;

static real_vec3 diff(fl_vec3 a, fl_vec3 b)
{
    return (real_vec3){(real)a.x - b.x, (real)a.y - b.y, (real)a.z - b.z};
}
static real_vec3 sub(real_vec3 a, real_vec3 b) { return (real_vec3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static real dot(real_vec3 a, real_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static real_vec3 cross(real_vec3 a, real_vec3 b)
{
    return (real_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/* a b - c d with compensated products (Kahan): error of at most 2 units in the last place. */
static real product_difference(real a, real b, real c, real d)
{
    const real w = c * d;
    return fmal(a, b, -w) - fmal(c, d, -w);
}
/* The same cross product for nearly parallel vectors, for which the plain one would lose digits. */
static real_vec3 cross_of(real_vec3 a, real_vec3 b)
{
    const real_vec3 m = cross(a, b);
    if (dot(m, m) > 1e-6L * dot(a, a) * dot(b, b)) return m;
    return (real_vec3){product_difference(a.y, b.z, a.z, b.y), product_difference(a.z, b.x, a.x, b.z),
                       product_difference(a.x, b.y, a.y, b.x)};
}
static real_vec3 scale(real s, real_vec3 a) { return (real_vec3){s * a.x, s * a.y, s * a.z}; }
/* a + s b with one rounding per component */
static real_vec3 madd(real_vec3 a, real s, real_vec3 b)
{
    return (real_vec3){fmal(s, b.x, a.x), fmal(s, b.y, a.y), fmal(s, b.z, a.z)};
}
static real norm(real_vec3 a) { return sqrtl(dot(a, a)); }

static real gap_between_planes(const fl_solid *a, const fl_solid *b, real_vec3 n)
{
    const fl_vec3 o = a->v[0];
    real lo = INFINITY, hi = -INFINITY;
    for (int32_t i = 0; i < a->p->nv; i++) lo = fminl(lo, dot(n, diff(a->v[i], o)));
    for (int32_t j = 0; j < b->p->nv; j++) hi = fmaxl(hi, dot(n, diff(b->v[j], o)));
    return lo - hi;
}

real oracle_room(const fl_solid *a, const fl_solid *b, fl_vec3 n)
{
    return gap_between_planes(a, b, (real_vec3){n.x, n.y, n.z});
}

typedef struct {
    const fl_solid *a, *b;
    int pass; /* search: 0 least distance, 1 direction of the nearest pairs, 2 direction closest to n */
    int thorough;
    real least2, near2, best_room, best_slack, unsure, off;
    real_vec3 n;
    int found;
} feature_search;

/* w = from b to a, of squared length d2 */
static int is_candidate(feature_search *h, real d2)
{
    if (h->pass == 0) {
        if (d2 < h->least2) h->least2 = d2;
        return 0;
    }
    return d2 <= h->near2;
}

/* A pair of points at the distance d along n.  Among the nearest pairs it is the one whose gap between
 * planes is closest to d: the difference is linear in the error of n, while distances and gaps differ by
 * its square. */
static void compare_direction(feature_search *h, real_vec3 n, real d, real unsure)
{
    const real r = gap_between_planes(h->a, h->b, n);
    if (h->pass == 2) {
        const real off = norm(sub(n, h->n));
        if (fabsl(d - r) <= h->best_slack && off < h->off) h->off = off;
        return;
    }
    if (h->found && !(fabsl(d - r) < h->best_slack)) return;
    h->found = 1;
    h->best_slack = fabsl(d - r);
    h->best_room = r;
    h->n = n;
    h->unsure = unsure;
}

static void point_pair(feature_search *h, fl_vec3 p, fl_vec3 q)
{
    const real_vec3 w = diff(p, q);
    if (is_candidate(h, dot(w, w)) && dot(w, w) > 0)
        compare_direction(h, scale(1 / norm(w), w), norm(w), LDBL_EPSILON);
}

/* vertex p, edge q r; sign +1 when p is a's */
static void vertex_edge(feature_search *h, fl_vec3 p, fl_vec3 q, fl_vec3 r, real sign)
{
    real_vec3 u = diff(p, q), e = diff(r, q);
    if (dot(diff(p, r), diff(p, r)) < dot(u, u)) { /* from the nearer end */
        u = diff(p, r);
        e = diff(q, r);
    }
    const real ee = dot(e, e), t = ee > 0 ? dot(u, e) / ee : 0;
    if (!(t > 0 && t < 1)) return;
    real_vec3 w = sub(u, scale(t, e));
    if (!is_candidate(h, dot(w, w))) return;
    w = madd(u, -t, e);
    w = madd(w, -dot(w, e) / ee, e);
    w = madd(w, -dot(w, e) / ee, e);
    if (dot(w, w) > 0) compare_direction(h, scale(sign / norm(w), w), norm(w), 8 * LDBL_EPSILON);
}

static void vertex_triangle(feature_search *h, fl_vec3 p, fl_vec3 q, fl_vec3 r, fl_vec3 s, real sign)
{
    const real_vec3 e = diff(r, q), g = diff(s, q), u = diff(p, q), m = cross_of(e, g);
    const real mm = dot(m, m);
    if (!(mm > 0)) return;
    const real t = dot(m, u), x = dot(m, cross(u, g)) / mm, y = dot(m, cross(e, u)) / mm;
    if (!(x > 0 && y > 0 && x + y < 1) || !is_candidate(h, t * t / mm) || t == 0) return;
    compare_direction(h, scale((t > 0 ? sign : -sign) / sqrtl(mm), m), fabsl(t) / sqrtl(mm),
                      8 * LDBL_EPSILON);
}

static void edge_edge(feature_search *h, fl_vec3 p, fl_vec3 q, fl_vec3 r, fl_vec3 s)
{
    const real_vec3 e = diff(q, p), g = diff(s, r), w = diff(p, r), m = cross_of(e, g);
    const real mm = dot(m, m);
    if (!(mm > 0)) return;
    const real x = dot(m, cross(g, w)) / mm, y = dot(m, cross(e, w)) / mm, t = dot(m, w);
    if (!(x > 0 && x < 1 && y > 0 && y < 1) || !is_candidate(h, t * t / mm) || t == 0) return;
    compare_direction(h, scale((t > 0 ? 1 : -1) / sqrtl(mm), m), fabsl(t) / sqrtl(mm), 8 * LDBL_EPSILON);
}

/* Faces are flat only up to rounding.  The hull of their vertices may differ from the fan of triangles, and
 * have other edges than those listed.  A thorough search uses all triangles and all chords of every face. */
static int triangles(const fl_poly *p, int32_t f, int thorough, int32_t (*out)[3])
{
    const int32_t *l = p->loop + p->first[f], n = p->first[f + 1] - p->first[f];
    int count = 0;
    for (int32_t i = 0; i < (thorough ? n - 2 : 1); i++)
        for (int32_t j = i + 1; j + 1 < n; j++)
            for (int32_t k = j + 1; k < (thorough ? n : j + 2); k++) {
                out[count][0] = l[i];
                out[count][1] = l[j];
                out[count++][2] = l[k];
            }
    return count;
}

static int edges(const fl_poly *p, int thorough, int32_t (*out)[2])
{
    int count = 0;
    for (int32_t e = 0; e < p->ne; e++) {
        out[count][0] = p->edge[e].a;
        out[count++][1] = p->edge[e].b;
    }
    for (int32_t f = 0; f < p->nf && thorough; f++)
        for (int32_t i = p->first[f]; i < p->first[f + 1]; i++)
            for (int32_t j = i + 2; j < p->first[f + 1]; j++) {
                out[count][0] = p->loop[i];
                out[count++][1] = p->loop[j];
            }
    return count;
}

enum {
    TRIANGLES = 1000,
    EDGES = 2000
}; /* of a face, and of a body, in a thorough search: enough for 16 corners */

static void all_pairs(feature_search *h)
{
    int32_t tri[TRIANGLES][3], edge[2][EDGES][2];
    int ne[2];
    for (int side = 0; side < 2; side++) ne[side] = edges((side ? h->b : h->a)->p, h->thorough, edge[side]);
    for (int side = 0; side < 2; side++) {
        const fl_solid *a = side ? h->b : h->a, *b = side ? h->a : h->b;
        const real sign = side ? -1 : 1;
        for (int32_t f = 0; f < b->p->nf; f++) {
            const int n = triangles(b->p, f, h->thorough, tri);
            for (int32_t i = 0; i < a->p->nv; i++)
                for (int t = 0; t < n; t++)
                    vertex_triangle(h, a->v[i], b->v[tri[t][0]], b->v[tri[t][1]], b->v[tri[t][2]], sign);
        }
        for (int32_t i = 0; i < a->p->nv; i++) {
            for (int e = 0; e < ne[!side]; e++)
                vertex_edge(h, a->v[i], b->v[edge[!side][e][0]], b->v[edge[!side][e][1]], sign);
            for (int32_t j = 0; j < b->p->nv && side == 0; j++) point_pair(h, a->v[i], b->v[j]);
        }
    }
    for (int e = 0; e < ne[0]; e++)
        for (int f = 0; f < ne[1]; f++)
            edge_edge(h, h->a->v[edge[0][e][0]], h->a->v[edge[0][e][1]], h->b->v[edge[1][f][0]],
                      h->b->v[edge[1][f][1]]);
}

/* Width of the overlap along m, in both directions; keeps the least. */
static void width(const fl_solid *a, const fl_solid *b, real_vec3 m, oracle_gap *out)
{
    const real len = norm(m);
    if (!(len > 0)) return;
    for (int way = -1; way <= 1; way += 2) {
        const real_vec3 n = scale((real)way / len, m);
        const real w = gap_between_planes(a, b, n);
        if (w > out->d) {
            out->d = w;
            out->n[0] = n.x;
            out->n[1] = n.y;
            out->n[2] = n.z;
        }
    }
}

static void depth(const fl_solid *a, const fl_solid *b, int thorough, oracle_gap *out)
{
    int32_t tri[TRIANGLES][3], edge[2][EDGES][2];
    out->d = -INFINITY;
    for (int side = 0; side < 2; side++) {
        const fl_solid *s = side ? b : a;
        for (int32_t f = 0; f < s->p->nf; f++) {
            const int n = triangles(s->p, f, thorough, tri);
            for (int t = 0; t < n; t++)
                width(
                    a, b,
                    cross_of(diff(s->v[tri[t][1]], s->v[tri[t][0]]), diff(s->v[tri[t][2]], s->v[tri[t][0]])),
                    out);
        }
    }
    const int na = edges(a->p, thorough, edge[0]), nb = edges(b->p, thorough, edge[1]);
    for (int e = 0; e < na; e++)
        for (int f = 0; f < nb; f++)
            width(a, b,
                  cross_of(diff(a->v[edge[0][e][1]], a->v[edge[0][e][0]]),
                           diff(b->v[edge[1][f][1]], b->v[edge[1][f][0]])),
                  out);
}

/* Bound of the nearest pairs: distances have errors of a few 1e-19 of the size. */
static real near2_of(real least2, real size)
{
    const real d = sqrtl(least2) * (1 + 1e-9L) + 1e-17L * size;
    return d * d;
}

void oracle_distance(const fl_solid *a, const fl_solid *b, oracle_gap *out)
{
    const real size = (real)a->p->size + b->p->size;
    for (int thorough = 0; thorough < 2; thorough++) {
        feature_search h = {.a = a, .b = b, .least2 = INFINITY, .thorough = thorough};
        all_pairs(&h);
        h.pass = 1;
        h.near2 = near2_of(h.least2, size);
        all_pairs(&h);
        *out = (oracle_gap){.d = sqrtl(h.least2), .n = {h.n.x, h.n.y, h.n.z}, .unsure = h.unsure};
        if (h.found && h.best_room > 0 && h.best_room > out->d - 1e-15L * (size + out->d)) return;
        /* Clearly separated, so that flatness of faces does not matter. */
        if (!thorough && !(h.found && h.best_room > -1e-7L * size)) break;
    }
    depth(a, b, 0, out);
    if (out->d > -1e-7L * size) depth(a, b, 1, out);
    if (out->d == -INFINITY) out->d = 0; /* on one line: any direction across it separates them */
}

real oracle_off(const fl_solid *a, const fl_solid *b, const oracle_gap *o, fl_vec3 n)
{
    const real size = (real)a->p->size + b->p->size;
    feature_search h = {.a = a, .b = b, .pass = 2, .thorough = 1, .least2 = o->d * o->d, .off = INFINITY};
    h.best_slack = 4 * 1.1102230246251565e-16L * size;
    h.near2 = near2_of(h.least2, size);
    h.n = (real_vec3){n.x, n.y, n.z};
    all_pairs(&h);
    return h.off;
}
