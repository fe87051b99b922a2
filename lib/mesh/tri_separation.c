/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "mesh/tri_separation.h"

/* A sum of products of differences, each formed with up to eight roundings of 2^-53: twice that of the sum of
 * their sizes is more than what they can lose. */
static const double BLUR = 16.0 * 0x1p-53;
/* Below this, products may have lost digits for want of smaller numbers. */
static const double TINY = 1e-280;

static fl_vec3 sizes(fl_vec3 a) { return v3(fabs(a.x), fabs(a.y), fabs(a.z)); }

/* a x b with every product taken by its size */
static fl_vec3 cross_sizes(fl_vec3 a, fl_vec3 b)
{
    a = sizes(a);
    b = sizes(b);
    return v3(a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x);
}

void fl_tri_load(const fl_part *p, int32_t t, fl_tri_data *c)
{
    c->t = t;
    c->has_normal = 0;
    c->v = p->t[t].v;
    for (int k = 0; k < 3; k++) c->x[k] = p->v[c->v[k]];
}

static void raise_normal(fl_tri_data *c)
{
    const fl_vec3 a = v3_sub(c->x[1], c->x[0]), b = v3_sub(c->x[2], c->x[0]);
    if (c->has_normal) return;
    c->n = v3_cross(a, b);
    c->n_abs = cross_sizes(a, b);
    c->has_normal = 1;
}

/* On which side of the plane of c lies x: 1, -1, or 0 where rounding may decide. */
static int side(const fl_tri_data *c, fl_vec3 x)
{
    const fl_vec3 d = v3_sub(x, c->x[0]);
    const double at = v3_dot(c->n, d), blur = BLUR * v3_dot(c->n_abs, sizes(d)) + TINY;
    return at > blur ? 1 : at < -blur ? -1 : 0;
}

/* Do the corners of b but those with the index k and l lie on one side of the plane of a? */
static int beside(fl_tri_data *a, const fl_tri_data *b, int k, int l)
{
    int sum = 0, n = 0;
    raise_normal(a);
    for (int i = 0; i < 3; i++) {
        if (i == k || i == l) continue;
        sum += side(a, b->x[i]);
        n++;
    }
    return sum == n || sum == -n;
}

/* Lowest and highest value that g . (x - o) may have over the corners of c but k. */
static void reach(const fl_tri_data *c, int k, fl_vec3 g, fl_vec3 o, double *lo, double *hi)
{
    const fl_vec3 size = sizes(g);
    *lo = INFINITY;
    *hi = -INFINITY;
    for (int i = 0; i < 3; i++) {
        if (i == k) continue;
        const fl_vec3 d = v3_sub(c->x[i], o);
        const double at = v3_dot(g, d), blur = BLUR * v3_dot(size, sizes(d)) + TINY;
        *lo = at - blur < *lo ? at - blur : *lo;
        *hi = at + blur > *hi ? at + blur : *hi;
    }
}

/* Without a corner in common: does a plane on an edge of a, upright on it, have b behind it?  The normal of a
 * is known from beside(). */
static int fenced(const fl_tri_data *a, const fl_tri_data *b)
{
    for (int i = 0; i < 3; i++) {
        const fl_vec3 o = a->x[i], g = v3_cross(v3_sub(a->x[(i + 1) % 3], o), a->n);
        double a_lo, a_hi, b_lo, b_hi;
        reach(a, i, g, o, &a_lo, &a_hi);
        reach(b, -1, g, o, &b_lo, &b_hi);
        if (b_lo > fmax(a_hi, 0.0) || b_hi < fmin(a_lo, 0.0)) return 1;
    }
    return 0;
}

/* Is g . d above zero for certain? */
static int ahead(fl_vec3 g, fl_vec3 size, fl_vec3 d)
{
    return v3_dot(g, d) > BLUR * v3_dot(size, sizes(d)) + TINY;
}

/* Does the plane through a common corner at right angles to g have b1 and b2 before it and a1 and a2 behind?
 */
static int parts(fl_vec3 g, fl_vec3 a1, fl_vec3 a2, fl_vec3 b1, fl_vec3 b2)
{
    const fl_vec3 size = sizes(g), back = v3_neg(g);
    return ahead(g, size, b1) && ahead(g, size, b2) && ahead(back, size, a1) && ahead(back, size, a2);
}

static const int NEXT[3] = {1, 2, 0};

/* With corner i of a and j of b in common: is there a plane through it between the two?  Tried are those
 * across the way from the middle of the one to that of the other, and from its direction to that. */
static int parted(const fl_tri_data *a, int i, const fl_tri_data *b, int j)
{
    const fl_vec3 o = a->x[i];
    const fl_vec3 a1 = v3_sub(a->x[NEXT[i]], o), a2 = v3_sub(a->x[NEXT[NEXT[i]]], o);
    const fl_vec3 b1 = v3_sub(b->x[NEXT[j]], o), b2 = v3_sub(b->x[NEXT[NEXT[j]]], o);
    if (parts(v3_sub(v3_add(b1, b2), v3_add(a1, a2)), a1, a2, b1, b2)) return 1;
    const fl_vec3 to_a = v3_unit(v3_add(v3_unit(a1), v3_unit(a2)));
    const fl_vec3 to_b = v3_unit(v3_add(v3_unit(b1), v3_unit(b2)));
    return parts(v3_sub(to_b, to_a), a1, a2, b1, b2);
}

/* With all but corner i of a and j of b in common: do they bend by less than a right angle? */
static int gentle(const fl_tri_data *a, int i, const fl_tri_data *b, int j)
{
    const fl_vec3 o = a->x[(i + 1) % 3], e = v3_sub(a->x[(i + 2) % 3], o);
    const fl_vec3 p = v3_sub(a->x[i], o), q = v3_sub(b->x[j], o);
    const double at = v3_dot(v3_cross(e, p), v3_cross(e, q));
    return at < -(2.0 * BLUR * v3_dot(cross_sizes(e, p), cross_sizes(e, q)) + TINY);
}

int fl_tri_separated(fl_tri_data *a, fl_tri_data *b)
{
    int i[3] = {0}, j[3] = {0}, n = 0;
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
            if (a->v[k] != b->v[l]) continue;
            if (n == 3) return 0; /* a corner that comes twice */
            i[n] = k;
            j[n++] = l;
        }
    if (n == 2 && (i[0] == i[1] || j[0] == j[1])) return 0;
    switch (n) {
    case 0: return beside(a, b, -1, -1) || beside(b, a, -1, -1) || fenced(a, b) || fenced(b, a);
    case 1: return parted(a, i[0], b, j[0]) || beside(a, b, j[0], -1) || beside(b, a, i[0], -1);
    case 2: return gentle(a, 3 - i[0] - i[1], b, 3 - j[0] - j[1]) || beside(a, b, j[0], j[1]);
    default: return 0;
    }
}

/* --- bundles -------------------------------------------------------------------------------------------- */

/* Sum of the normals: of what is nearly one plane, across it; of a sector of a cone, away from the rest. */
static fl_vec3 across(const fl_part *p, const int32_t *t, int n)
{
    fl_vec3 g = {0};
    for (int i = 0; i < n; i++) {
        const int32_t *v = p->t[t[i]].v;
        const fl_vec3 o = p->v[v[0]];
        g = v3_add(g, v3_cross(v3_sub(p->v[v[1]], o), v3_sub(p->v[v[2]], o)));
    }
    return g;
}

/* Lowest and highest value that g . (x - o) may have over the corners of the triangles. */
static void reach_of(const fl_part *p, const int32_t *t, int n, fl_vec3 g, fl_vec3 o, double *lo, double *hi)
{
    const fl_vec3 size = sizes(g);
    *lo = INFINITY;
    *hi = -INFINITY;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) {
            const fl_vec3 d = v3_sub(p->v[p->t[t[i]].v[k]], o);
            const double at = v3_dot(g, d), blur = BLUR * v3_dot(size, sizes(d)) + TINY;
            *lo = at - blur < *lo ? at - blur : *lo;
            *hi = at + blur > *hi ? at + blur : *hi;
        }
}

int fl_tri_groups_separated(const fl_part *p, const int32_t *a, int na, const int32_t *b, int nb)
{
    const fl_vec3 o = p->v[p->t[a[0]].v[0]], g[2] = {across(p, a, na), across(p, b, nb)};
    for (int k = 0; k < 2; k++) {
        double a_lo, a_hi, b_lo, b_hi;
        reach_of(p, a, na, g[k], o, &a_lo, &a_hi);
        reach_of(p, b, nb, g[k], o, &b_lo, &b_hi);
        if (a_lo > b_hi || b_lo > a_hi) return 1;
    }
    return 0;
}
