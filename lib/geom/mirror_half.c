/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geom/mirror_half.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"

static double coordinate(fl_vec3 x, int axis) { return axis == 0 ? x.x : axis == 1 ? x.y : x.z; }

static fl_vec3 image_of(fl_vec3 x, int axis)
{
    return v3(axis == 0 ? -x.x : x.x, axis == 1 ? -x.y : x.y, axis == 2 ? -x.z : x.z);
}

/* Range of the coordinate over triangle t, or over the axis of cone t - nt. */
static void range_of(const fl_part *p, int32_t t, int axis, double *lo, double *hi)
{
    *lo = INFINITY, *hi = -INFINITY;
    if (t >= p->nt) {
        const fl_cone *c = &p->cone[t - p->nt];
        *lo = fmin(coordinate(c->p0, axis), coordinate(c->p1, axis));
        *hi = fmax(coordinate(c->p0, axis), coordinate(c->p1, axis));
        return;
    }
    for (int k = 0; k < 3; k++) {
        const double x = coordinate(p->v[p->t[t].v[k]], axis);
        *lo = fmin(*lo, x), *hi = fmax(*hi, x);
    }
}

int fl_part_mirror_half(fl_part *p, int axis, double tol, int32_t *crosses, fl_err *err)
{
    const int32_t nv = p->nv, nt = p->nt, nc = p->nc;
    double lo, hi, least = 0.0, most = 0.0;
    *crosses = -1;
    for (int32_t t = 0; t < nt + nc; t++) {
        range_of(p, t, axis, &lo, &hi);
        least = fmin(least, lo), most = fmax(most, hi);
        if (least < -tol && most > tol) {
            *crosses = t;
            return 0;
        }
    }
    int32_t *twin = fl_alloc(nv, sizeof *twin, err);
    int rc = twin ? 0 : -1;
    for (int32_t v = 0; rc == 0 && v < nv; v++) {
        twin[v] = v;
        if (fabs(coordinate(p->v[v], axis)) <= tol) continue;
        twin[v] = p->nv;
        rc = fl_surface_vertex(p, image_of(p->v[v], axis), err);
    }
    for (int32_t t = 0; rc == 0 && t < nt; t++) {
        range_of(p, t, axis, &lo, &hi);
        if (fmax(fabs(lo), fabs(hi)) <= tol) continue;
        rc = fl_surface_triangle(p, twin[p->t[t].v[0]], twin[p->t[t].v[2]], twin[p->t[t].v[1]], err);
    }
    for (int32_t c = 0; rc == 0 && c < nc; c++) {
        fl_cone k = p->cone[c];
        if (fmax(fabs(coordinate(k.p0, axis)), fabs(coordinate(k.p1, axis))) <= tol) continue;
        k.p0 = image_of(k.p0, axis), k.p1 = image_of(k.p1, axis);
        rc = fl_surface_cone(p, k, err);
    }
    free(twin);
    return rc;
}
