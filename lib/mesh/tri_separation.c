/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "mesh/tri_separation.h"

/* Relative rounding error of a sum of products of differences.  Each term has up to eight roundings of 2^-53;
 * the bound is twice that share of the sum of absolute values. */
static const double ROUNDING = 16.0 * 0x1p-53;
/* Below this, products may have lost digits to underflow. */
static const double UNDERFLOW_LIMIT = 1e-280;

static fl_vec3 abs_of(fl_vec3 a) { return v3(fabs(a.x), fabs(a.y), fabs(a.z)); }

/* a x b with absolute values of all products */
static fl_vec3 cross_abs(fl_vec3 a, fl_vec3 b)
{
    a = abs_of(a);
    b = abs_of(b);
    return v3(a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x);
}

void fl_tri_load(const fl_part *p, int32_t t, fl_tri_data *c)
{
    c->t = t;
    c->has_normal = 0;
    c->v = p->t[t].v;
    for (int k = 0; k < 3; k++) c->x[k] = p->v[c->v[k]];
}

static void compute_normal(fl_tri_data *c)
{
    const fl_vec3 a = v3_sub(c->x[1], c->x[0]), b = v3_sub(c->x[2], c->x[0]);
    if (c->has_normal) return;
    c->n = v3_cross(a, b);
    c->n_abs = cross_abs(a, b);
    c->has_normal = 1;
}

/* Side of the plane of c on which x lies: 1, -1, or 0 where rounding may decide. */
static int side_of_plane(const fl_tri_data *c, fl_vec3 x)
{
    const fl_vec3 d = v3_sub(x, c->x[0]);
    const double at = v3_dot(c->n, d), error = ROUNDING * v3_dot(c->n_abs, abs_of(d)) + UNDERFLOW_LIMIT;
    return at > error ? 1 : at < -error ? -1 : 0;
}

/* True if all corners of b but those with index k and l lie on one side of the plane of a. */
static int in_half_space(fl_tri_data *a, const fl_tri_data *b, int k, int l)
{
    int sum = 0, n = 0;
    compute_normal(a);
    for (int i = 0; i < 3; i++) {
        if (i == k || i == l) continue;
        sum += side_of_plane(a, b->x[i]);
        n++;
    }
    return sum == n || sum == -n;
}

/* Lowest and highest value that g . (x - o) may have over the corners of c but k. */
static void range_of_corners(const fl_tri_data *c, int k, fl_vec3 g, fl_vec3 o, double *lo, double *hi)
{
    const fl_vec3 size = abs_of(g);
    *lo = INFINITY;
    *hi = -INFINITY;
    for (int i = 0; i < 3; i++) {
        if (i == k) continue;
        const fl_vec3 d = v3_sub(c->x[i], o);
        const double at = v3_dot(g, d), error = ROUNDING * v3_dot(size, abs_of(d)) + UNDERFLOW_LIMIT;
        *lo = at - error < *lo ? at - error : *lo;
        *hi = at + error > *hi ? at + error : *hi;
    }
}

/* For triangles without a common corner: true if a plane through an edge of a, normal to a, separates b from
 * a.  The normal of a is set by in_half_space(). */
static int edge_plane_separates(const fl_tri_data *a, const fl_tri_data *b)
{
    for (int i = 0; i < 3; i++) {
        const fl_vec3 o = a->x[i], g = v3_cross(v3_sub(a->x[(i + 1) % 3], o), a->n);
        double a_lo, a_hi, b_lo, b_hi;
        range_of_corners(a, i, g, o, &a_lo, &a_hi);
        range_of_corners(b, -1, g, o, &b_lo, &b_hi);
        if (b_lo > fmax(a_hi, 0.0) || b_hi < fmin(a_lo, 0.0)) return 1;
    }
    return 0;
}

/* True if g . d is certainly above zero. */
static int is_positive(fl_vec3 g, fl_vec3 size, fl_vec3 d)
{
    return v3_dot(g, d) > ROUNDING * v3_dot(size, abs_of(d)) + UNDERFLOW_LIMIT;
}

/* True if the plane through a common corner with normal g has b1 and b2 in front and a1 and a2 behind. */
static int corner_plane_separates(fl_vec3 g, fl_vec3 a1, fl_vec3 a2, fl_vec3 b1, fl_vec3 b2)
{
    const fl_vec3 size = abs_of(g), back = v3_neg(g);
    return is_positive(g, size, b1) && is_positive(g, size, b2) && is_positive(back, size, a1) &&
           is_positive(back, size, a2);
}

static const int NEXT[3] = {1, 2, 0};

/* For triangles with corner i of a and j of b in common: true if a plane through it separates them.
 * Candidate normals join the midpoints of the opposite edges, and the bisectors of the two corners. */
static int separated_at_corner(const fl_tri_data *a, int i, const fl_tri_data *b, int j)
{
    const fl_vec3 o = a->x[i];
    const fl_vec3 a1 = v3_sub(a->x[NEXT[i]], o), a2 = v3_sub(a->x[NEXT[NEXT[i]]], o);
    const fl_vec3 b1 = v3_sub(b->x[NEXT[j]], o), b2 = v3_sub(b->x[NEXT[NEXT[j]]], o);
    if (corner_plane_separates(v3_sub(v3_add(b1, b2), v3_add(a1, a2)), a1, a2, b1, b2)) return 1;
    const fl_vec3 to_a = v3_unit(v3_add(v3_unit(a1), v3_unit(a2)));
    const fl_vec3 to_b = v3_unit(v3_add(v3_unit(b1), v3_unit(b2)));
    return corner_plane_separates(v3_sub(to_b, to_a), a1, a2, b1, b2);
}

/* For triangles that share all but corner i of a and j of b: true if they bend by less than 90 degrees. */
static int bends_gently(const fl_tri_data *a, int i, const fl_tri_data *b, int j)
{
    const fl_vec3 o = a->x[(i + 1) % 3], e = v3_sub(a->x[(i + 2) % 3], o);
    const fl_vec3 p = v3_sub(a->x[i], o), q = v3_sub(b->x[j], o);
    const double at = v3_dot(v3_cross(e, p), v3_cross(e, q));
    return at < -(2.0 * ROUNDING * v3_dot(cross_abs(e, p), cross_abs(e, q)) + UNDERFLOW_LIMIT);
}

int fl_tri_separated(fl_tri_data *a, fl_tri_data *b)
{
    int i[3] = {0}, j[3] = {0}, n = 0;
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
            if (a->v[k] != b->v[l]) continue;
            if (n == 3) return 0; /* a repeated corner */
            i[n] = k;
            j[n++] = l;
        }
    if (n == 2 && (i[0] == i[1] || j[0] == j[1])) return 0;
    switch (n) {
    case 0:
        return in_half_space(a, b, -1, -1) || in_half_space(b, a, -1, -1) || edge_plane_separates(a, b) ||
               edge_plane_separates(b, a);
    case 1:
        return separated_at_corner(a, i[0], b, j[0]) || in_half_space(a, b, j[0], -1) ||
               in_half_space(b, a, i[0], -1);
    case 2: return bends_gently(a, 3 - i[0] - i[1], b, 3 - j[0] - j[1]) || in_half_space(a, b, j[0], j[1]);
    default: return 0;
    }
}

/* --- groups of triangles -------------------------------------------------------------------------------- */

/* Sum of the normals: the normal of a nearly flat group; for a sector of a cone it points away from the rest.
 */
static fl_vec3 sum_normals(const fl_part *p, const int32_t *t, int n)
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
static void range_of_group(const fl_part *p, const int32_t *t, int n, fl_vec3 g, fl_vec3 o, double *lo,
                           double *hi)
{
    const fl_vec3 size = abs_of(g);
    *lo = INFINITY;
    *hi = -INFINITY;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) {
            const fl_vec3 d = v3_sub(p->v[p->t[t[i]].v[k]], o);
            const double at = v3_dot(g, d), error = ROUNDING * v3_dot(size, abs_of(d)) + UNDERFLOW_LIMIT;
            *lo = at - error < *lo ? at - error : *lo;
            *hi = at + error > *hi ? at + error : *hi;
        }
}

int fl_tri_groups_separated(const fl_part *p, const int32_t *a, int na, const int32_t *b, int nb)
{
    const fl_vec3 o = p->v[p->t[a[0]].v[0]], g[2] = {sum_normals(p, a, na), sum_normals(p, b, nb)};
    for (int k = 0; k < 2; k++) {
        double a_lo, a_hi, b_lo, b_hi;
        range_of_group(p, a, na, g[k], o, &a_lo, &a_hi);
        range_of_group(p, b, nb, g[k], o, &b_lo, &b_hi);
        if (a_lo > b_hi || b_lo > a_hi) return 1;
    }
    return 0;
}
