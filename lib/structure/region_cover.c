/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "structure/region_cover.h"
#include "geom/polygon.h"

int fl_region_is_flat(const fl_part *p, fl_vec3 n, double c, double tol)
{
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 0; k < 3; k++)
            if (fabs(v3_dot(n, p->v[p->t[t].v[k]]) - c) > tol) return 0;
    return 1;
}

/* A corner in the plane, and its vertex. */
typedef struct {
    fl_vec2 at;
    int32_t v;
} corner;

static int compare_position(const void *x, const void *y)
{
    const corner *p = x, *q = y;
    if (p->at.x != q->at.x) return p->at.x < q->at.x ? -1 : 1;
    if (p->at.y != q->at.y) return p->at.y < q->at.y ? -1 : 1;
    return (p->v > q->v) - (p->v < q->v);
}

/* Twice the signed area of a b c: positive if c is to the left of a b. */
static double left_of(fl_vec2 a, fl_vec2 b, fl_vec2 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Convex hull of sorted corners, counter-clockwise, into out, which has room for twice as many: what
 * overflows is no hull.
 * Source: Andrew, Inf. Process. Lett. 9 (1979) 216. */
static int32_t hull_of(int32_t n, const corner *c, corner *out)
{
    int32_t m = 0;
    for (int turn = 0; turn < 2; turn++) {
        const int32_t start = m;
        for (int32_t k = 0; k < n; k++) {
            const corner *at = &c[turn ? n - 1 - k : k];
            while (m >= start + 2 && !(left_of(out[m - 2].at, out[m - 1].at, at->at) > 0.0)) m--;
            out[m++] = *at;
        }
        m--; /* the upper chain begins with it */
    }
    return m;
}

/* A triangle: its vertices in ascending order, the side that it faces (1: along n) and its area. */
typedef struct {
    int32_t v[3], up;
    double area;
} flat_triangle;

static int compare_vertices(const void *x, const void *y)
{
    const flat_triangle *p = x, *q = y;
    if (p->up != q->up) return p->up - q->up;
    for (int k = 0; k < 3; k++)
        if (p->v[k] != q->v[k]) return p->v[k] < q->v[k] ? -1 : 1;
    return 0;
}

static void order_pair(int32_t *a, int32_t *b)
{
    const int32_t was = *a;
    if (was > *b) *a = *b, *b = was;
}

static flat_triangle triangle_of(const fl_part *p, const fl_tri *t, fl_vec3 n)
{
    const fl_vec3 a = p->v[t->v[0]], cross = v3_cross(v3_sub(p->v[t->v[1]], a), v3_sub(p->v[t->v[2]], a));
    flat_triangle f = {{t->v[0], t->v[1], t->v[2]}, v3_dot(cross, n) > 0.0, 0.5 * v3_norm(cross)};
    order_pair(&f.v[0], &f.v[1]), order_pair(&f.v[1], &f.v[2]), order_pair(&f.v[0], &f.v[1]);
    return f;
}

/* Areas covered by the triangles that face down and up, each triangle once. */
static void areas_of(const fl_part *p, fl_vec3 n, flat_triangle *all, double area[2])
{
    area[0] = area[1] = 0.0;
    for (int32_t t = 0; t < p->nt; t++) all[t] = triangle_of(p, &p->t[t], n);
    qsort(all, (size_t)p->nt, sizeof *all, compare_vertices);
    for (int32_t t = 0; t < p->nt; t++)
        if (t == 0 || compare_vertices(&all[t - 1], &all[t]) != 0) area[all[t].up] += all[t].area;
}

int fl_region_covers_hull(const fl_part *p, fl_vec3 n, double tol, int32_t *loop, int32_t *count, fl_err *err)
{
    const fl_vec3 x = v3_normal_to(n), y = v3_cross(n, x), from = p->v[p->t[0].v[0]];
    corner *all = fl_alloc(p->nv, sizeof *all, err),
           *rim = fl_alloc(2 * (int64_t)p->nv + 1, sizeof *rim, err);
    fl_vec2 *at = fl_alloc(2 * (int64_t)p->nv + 1, sizeof *at, err);
    flat_triangle *faces = fl_alloc(p->nt, sizeof *faces, err);
    uint8_t *used = fl_alloc(p->nv, 1, err);
    int found = -1;
    if (all && rim && at && faces && used) {
        int32_t m = 0, kept = 0;
        for (int32_t k = 0; k < 3 * p->nt; k++) used[p->t[k / 3].v[k % 3]] = 1;
        for (int32_t v = 0; v < p->nv; v++) {
            const fl_vec3 d = v3_sub(p->v[v], from);
            if (used[v]) all[m++] = (corner){{v3_dot(d, x), v3_dot(d, y)}, v};
        }
        qsort(all, (size_t)m, sizeof *all, compare_position);
        for (int32_t k = 0; k < m; k++) /* of vertices at one position the first */
            if (k == 0 || all[k].at.x != all[kept - 1].at.x || all[k].at.y != all[kept - 1].at.y)
                all[kept++] = all[k];
        *count = hull_of(kept, all, rim);
        if (*count > kept) *count = 0; /* overflow */
        for (int32_t k = 0; k < *count; k++) at[k] = rim[k].at, loop[k] = rim[k].v;
        double area[2];
        const double whole = fl_polygon_area(*count, at), off = tol * fl_polygon_perimeter(*count, at);
        areas_of(p, n, faces, area);
        found = *count > 2;
        for (int side = 0; side < 2; side++) found &= area[side] == 0.0 || fabs(area[side] - whole) <= off;
    }
    free(all), free(rim), free(at), free(faces), free(used);
    return found;
}
