/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "structure/hydrostatics.h"

/* Adds the triangle a b c, all z <= 0. The rule is exact for polynomials of degree 3: weights 3/60 at the
 * corners, 8/60 at the mid-sides, 27/60 at the centroid. */
static void add_triangle(fl_hydrostatics *f, fl_vec3 a, fl_vec3 b, fl_vec3 c)
{
    const fl_vec3 e = v3_sub(b, a), g = v3_sub(c, a);
    const double nz = 0.5 * (e.x * g.y - e.y * g.x);
    const fl_vec3 p[7] = {a,
                          b,
                          c,
                          v3_scale(0.5, v3_add(a, b)),
                          v3_scale(0.5, v3_add(b, c)),
                          v3_scale(0.5, v3_add(c, a)),
                          v3_scale(1.0 / 3.0, v3_add(a, v3_add(b, c)))};
    static const double WEIGHT[7] = {3.0 / 60, 3.0 / 60, 3.0 / 60, 8.0 / 60, 8.0 / 60, 8.0 / 60, 27.0 / 60};
    for (int k = 0; k < 7; k++) {
        const double w = WEIGHT[k] * nz, x = p[k].x, y = p[k].y, z = p[k].z;
        f->volume += w * z;
        f->buoyancy_centre = v3_madd(f->buoyancy_centre, w, v3(x * z, y * z, 0.5 * z * z));
        f->area -= w;
        f->x -= w * x;
        f->y -= w * y;
        f->xx -= w * x * x;
        f->yy -= w * y * y;
        f->xy -= w * x * y;
    }
}

/* The point of a b at z = 0, the same from either end. */
static fl_vec3 waterplane_crossing(fl_vec3 a, fl_vec3 b)
{
    const fl_vec3 low = a.z < b.z ? a : b, high = a.z < b.z ? b : a;
    fl_vec3 x = v3_madd(low, -low.z / (high.z - low.z), v3_sub(high, low));
    x.z = 0.0;
    return x;
}

static void add_cut(fl_hydrostatics *f, const fl_vec3 v[3])
{
    fl_vec3 wet[4];
    int n = 0;
    if (v[0].z >= 0.0 && v[1].z >= 0.0 && v[2].z >= 0.0) return; /* dry, or part of the water plane */
    for (int k = 0; k < 3; k++) {
        const fl_vec3 a = v[k], b = v[(k + 1) % 3];
        if (a.z <= 0.0) wet[n++] = a;
        if ((a.z < 0.0 && b.z > 0.0) || (a.z > 0.0 && b.z < 0.0)) wet[n++] = waterplane_crossing(a, b);
    }
    for (int k = 2; k < n; k++) add_triangle(f, wet[0], wet[k - 1], wet[k]);
}

typedef struct {
    int32_t a, b, sense; /* a < b; +1 from a to b */
} directed_edge;

static int compare_edges(const void *x, const void *y)
{
    const directed_edge *p = x, *q = y;
    if (p->a != q->a) return p->a < q->a ? -1 : 1;
    return (p->b > q->b) - (p->b < q->b);
}

/* Returns 1 if every edge is run both ways equally often, 0 if not, -1 with FL_SYSTEM. */
static int is_closed(const fl_part *p, fl_err *err)
{
    const int32_t n = 3 * p->nt;
    directed_edge *e = fl_alloc(n, sizeof *e, err);
    int closed = 1;
    if (!e) return -1;
    for (int32_t k = 0; k < n; k++) {
        const int32_t a = p->t[k / 3].v[k % 3], b = p->t[k / 3].v[(k + 1) % 3];
        e[k] = a < b ? (directed_edge){a, b, 1} : (directed_edge){b, a, -1};
    }
    qsort(e, (size_t)n, sizeof *e, compare_edges);
    for (int32_t k = 0, end; k < n && closed; k = end) {
        int32_t sum = 0;
        for (end = k; end < n && e[end].a == e[k].a && e[end].b == e[k].b; end++) sum += e[end].sense;
        closed = sum == 0;
    }
    free(e);
    return closed;
}

int fl_hydrostatics_add(fl_hydrostatics *f, const fl_part *p, double level, fl_vec3 reference, fl_err *err)
{
    if (p->nc)
        return fl_fail(err, FL_INPUT,
                       "part %s: a cone has no mesh; struct-import --facets makes one, or give the stiffness",
                       p->name);
    const int closed = is_closed(p, err);
    if (closed < 0) return -1;
    if (!closed)
        return fl_fail(
            err, FL_INPUT,
            "part %s: its triangles do not close, expected a closed mesh for its hydrostatic stiffness",
            p->name);
    for (int32_t t = 0; t < p->nt; t++) {
        fl_vec3 v[3];
        for (int k = 0; k < 3; k++) {
            const fl_vec3 x = p->v[p->t[t].v[k]];
            v[k] = v3(x.x - reference.x, x.y - reference.y, x.z - level);
        }
        add_cut(f, v);
    }
    return 0;
}

int fl_hydrostatics_finish(fl_hydrostatics *f, double level, fl_vec3 reference, fl_err *err)
{
    if (!(f->volume > 0.0))
        return fl_fail(err, FL_INPUT,
                       "the mesh displaces %g m3, expected more than 0; z of the water is %g m", f->volume,
                       level);
    f->buoyancy_centre = v3_scale(1.0 / f->volume, f->buoyancy_centre);
    f->buoyancy_centre.z += level - reference.z;
    return 0;
}

void fl_hydrostatics_stiffness(const fl_hydrostatics *f, double weight, double K[6][6])
{
    const double righting = f->volume * f->buoyancy_centre.z;
    K[2][2] += weight * f->area;
    K[3][3] += weight * (f->yy + righting);
    K[4][4] += weight * (f->xx + righting);
    K[2][3] += weight * f->y, K[3][2] += weight * f->y;
    K[2][4] -= weight * f->x, K[4][2] -= weight * f->x;
    K[3][4] -= weight * f->xy, K[4][3] -= weight * f->xy;
}
