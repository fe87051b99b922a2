/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/oracle.h"
#include <float.h>
#include <math.h>

typedef struct {
    real x, y, z;
} rv;

static rv diff(fl_vec3 a, fl_vec3 b) { return (rv){(real)a.x - b.x, (real)a.y - b.y, (real)a.z - b.z}; }
static rv sub(rv a, rv b) { return (rv){a.x - b.x, a.y - b.y, a.z - b.z}; }
static real dot(rv a, rv b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static rv cross(rv a, rv b)
{
    return (rv){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/* a b - c d, each product's rounding given back (Kahan): right to 2 units in the last place. */
static real product_difference(real a, real b, real c, real d)
{
    const real w = c * d;
    return fmal(a, b, -w) - fmal(c, d, -w);
}
/* The same cross product where the vectors are so nearly parallel that the plain one would lose digits. */
static rv cross_of(rv a, rv b)
{
    const rv m = cross(a, b);
    if (dot(m, m) > 1e-6L * dot(a, a) * dot(b, b)) return m;
    return (rv){product_difference(a.y, b.z, a.z, b.y), product_difference(a.z, b.x, a.x, b.z),
                product_difference(a.x, b.y, a.y, b.x)};
}
static rv scale(real s, rv a) { return (rv){s * a.x, s * a.y, s * a.z}; }
/* a + s b with one rounding a component: what is left of a stays right to its last place */
static rv madd(rv a, real s, rv b) { return (rv){fmal(s, b.x, a.x), fmal(s, b.y, a.y), fmal(s, b.z, a.z)}; }
static real norm(rv a) { return sqrtl(dot(a, a)); }

static real room(const fl_solid *a, const fl_solid *b, rv n)
{
    const fl_vec3 o = a->v[0];
    real lo = INFINITY, hi = -INFINITY;
    for (int32_t i = 0; i < a->p->nv; i++) lo = fminl(lo, dot(n, diff(a->v[i], o)));
    for (int32_t j = 0; j < b->p->nv; j++) hi = fmaxl(hi, dot(n, diff(b->v[j], o)));
    return lo - hi;
}

real oracle_room(const fl_solid *a, const fl_solid *b, fl_vec3 n) { return room(a, b, (rv){n.x, n.y, n.z}); }

typedef struct {
    const fl_solid *a, *b;
    int pass; /* 0 looks for the least distance, 1 for the direction among the nearest */
    int thorough;
    real least2, near2, best_room, best_slack, unsure, off;
    rv n;
    int found;
} hunt;

/* w = from b to a, of squared length d2 */
static int wanted(hunt *h, real d2)
{
    if (h->pass == 0) {
        if (d2 < h->least2) h->least2 = d2;
        return 0;
    }
    return d2 <= h->near2;
}

/* A pair of points at the distance d along n.  Of the nearest it is the one that its planes leave no more
 * room than d: what is missing is linear in the error of n, while distances and rooms differ by its
 * square. */
static void direction(hunt *h, rv n, real d, real unsure)
{
    const real r = room(h->a, h->b, n);
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

static void points(hunt *h, fl_vec3 p, fl_vec3 q)
{
    const rv w = diff(p, q);
    if (wanted(h, dot(w, w)) && dot(w, w) > 0) direction(h, scale(1 / norm(w), w), norm(w), LDBL_EPSILON);
}

/* vertex p, edge q r; sign +1 when p is a's */
static void vertex_edge(hunt *h, fl_vec3 p, fl_vec3 q, fl_vec3 r, real sign)
{
    rv u = diff(p, q), e = diff(r, q);
    if (dot(diff(p, r), diff(p, r)) < dot(u, u)) { /* from the nearer end */
        u = diff(p, r);
        e = diff(q, r);
    }
    const real ee = dot(e, e), t = ee > 0 ? dot(u, e) / ee : 0;
    if (!(t > 0 && t < 1)) return;
    rv w = sub(u, scale(t, e));
    if (!wanted(h, dot(w, w))) return;
    w = madd(u, -t, e);
    w = madd(w, -dot(w, e) / ee, e);
    w = madd(w, -dot(w, e) / ee, e);
    if (dot(w, w) > 0) direction(h, scale(sign / norm(w), w), norm(w), 8 * LDBL_EPSILON);
}

static void vertex_triangle(hunt *h, fl_vec3 p, fl_vec3 q, fl_vec3 r, fl_vec3 s, real sign)
{
    const rv e = diff(r, q), g = diff(s, q), u = diff(p, q), m = cross_of(e, g);
    const real mm = dot(m, m);
    if (!(mm > 0)) return;
    const real t = dot(m, u), x = dot(m, cross(u, g)) / mm, y = dot(m, cross(e, u)) / mm;
    if (!(x > 0 && y > 0 && x + y < 1) || !wanted(h, t * t / mm) || t == 0) return;
    direction(h, scale((t > 0 ? sign : -sign) / sqrtl(mm), m), fabsl(t) / sqrtl(mm), 8 * LDBL_EPSILON);
}

static void edge_edge(hunt *h, fl_vec3 p, fl_vec3 q, fl_vec3 r, fl_vec3 s)
{
    const rv e = diff(q, p), g = diff(s, r), w = diff(p, r), m = cross_of(e, g);
    const real mm = dot(m, m);
    if (!(mm > 0)) return;
    const real x = dot(m, cross(g, w)) / mm, y = dot(m, cross(e, w)) / mm, t = dot(m, w);
    if (!(x > 0 && x < 1 && y > 0 && y < 1) || !wanted(h, t * t / mm) || t == 0) return;
    direction(h, scale((t > 0 ? 1 : -1) / sqrtl(mm), m), fabsl(t) / sqrtl(mm), 8 * LDBL_EPSILON);
}

/* Faces are flat only to rounding, and the hull of their vertices need not contain the fan of triangles
 * that a face is cut into first, nor have the listed edges alone.  A thorough search takes all triangles
 * and all chords of every face. */
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

enum { TRIANGLES = 1000, EDGES = 2000 }; /* of a face, and of a body, thoroughly: enough for 16 corners */

static void all_pairs(hunt *h)
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
            for (int32_t j = 0; j < b->p->nv && side == 0; j++) points(h, a->v[i], b->v[j]);
        }
    }
    for (int e = 0; e < ne[0]; e++)
        for (int f = 0; f < ne[1]; f++)
            edge_edge(h, h->a->v[edge[0][e][0]], h->a->v[edge[0][e][1]], h->b->v[edge[1][f][0]],
                      h->b->v[edge[1][f][1]]);
}

/* The width of the overlap along the line of m, both ways; keeps the least. */
static void width(const fl_solid *a, const fl_solid *b, rv m, oracle_gap *out)
{
    const real len = norm(m);
    if (!(len > 0)) return;
    for (int way = -1; way <= 1; way += 2) {
        const rv n = scale((real)way / len, m);
        const real w = room(a, b, n);
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

/* What counts as nearest: distances are right to a few 1e-19 of the size. */
static real near2_of(real least2, real size)
{
    const real d = sqrtl(least2) * (1 + 1e-9L) + 1e-17L * size;
    return d * d;
}

void oracle_distance(const fl_solid *a, const fl_solid *b, oracle_gap *out)
{
    const real size = (real)a->p->size + b->p->size;
    for (int thorough = 0; thorough < 2; thorough++) {
        hunt h = {.a = a, .b = b, .least2 = INFINITY, .thorough = thorough};
        all_pairs(&h);
        h.pass = 1;
        h.near2 = near2_of(h.least2, size);
        all_pairs(&h);
        *out = (oracle_gap){.d = sqrtl(h.least2), .n = {h.n.x, h.n.y, h.n.z}, .unsure = h.unsure};
        if (h.found && h.best_room > 0 && h.best_room > out->d - 1e-15L * (size + out->d)) return;
        /* Far from parting them: no question of flatness. */
        if (!thorough && !(h.found && h.best_room > -1e-7L * size)) break;
    }
    depth(a, b, 0, out);
    if (out->d > -1e-7L * size) depth(a, b, 1, out);
    if (out->d == -INFINITY) out->d = 0; /* on one line: any direction across it parts them */
}

real oracle_off(const fl_solid *a, const fl_solid *b, const oracle_gap *o, fl_vec3 n)
{
    const real size = (real)a->p->size + b->p->size;
    hunt h = {.a = a, .b = b, .pass = 2, .thorough = 1, .least2 = o->d * o->d, .off = INFINITY};
    h.best_slack = 4 * 1.1102230246251565e-16L * size;
    h.near2 = near2_of(h.least2, size);
    h.n = (rv){n.x, n.y, n.z};
    all_pairs(&h);
    return h.off;
}
