/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "block/closed_surface.h"
#include "base/array.h"
#include "base/pi.h"
#include "geom/edges.h"
#include "geom/facet.h"

double fl_closed_surface_volume(const fl_part *p)
{
    double sum = 0.0;
    if (p->nv == 0) return 0.0;
    const fl_vec3 o = p->v[0];
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t *v = p->t[t].v;
        sum += v3_dot(v3_sub(p->v[v[0]], o), v3_cross(v3_sub(p->v[v[1]], o), v3_sub(p->v[v[2]], o))) / 6.0;
    }
    return sum;
}

int fl_closed_surface_check(const fl_part *p, fl_err *err)
{
    fl_edges e = {0};
    int64_t open = 0;
    fl_vec3 a = v3(0, 0, 0), b = a;
    if (p->nc)
        return fl_fail(err, FL_INPUT, "part %s has cones, a surface of triangles is expected", p->name);
    if (fl_edges_make(&e, p, err)) return -1;
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t k = e.first[v], to; k < e.first[v + 1]; k = to) {
            int ups = 0;
            to = fl_edge_end(&e, v, k);
            for (int64_t s = k; s < to; s++) ups += e.side[s].up ? 1 : -1;
            if (to - k == 2 && ups == 0) continue;
            if (!open++) a = p->v[v], b = p->v[e.side[k].hi];
        }
    fl_edges_free(&e);
    if (open)
        return fl_fail(
            err, FL_INPUT,
            "the surface is not closed: %lld edges have not two triangles, the first from (%.6g, %.6g, "
            "%.6g) to (%.6g, %.6g, %.6g): struct-import mends it",
            (long long)open, a.x, a.y, a.z, b.x, b.y, b.z);
    if (!(fl_closed_surface_volume(p) > 0.0))
        return fl_fail(err, FL_INPUT, "the surface encloses no volume, or faces inward");
    return 0;
}

int fl_closed_surface_contains(const fl_part *p, fl_vec3 x)
{
    double sum = 0.0;
    for (int32_t t = 0; t < p->nt; t++) {
        const fl_vec3 a = v3_sub(p->v[p->t[t].v[0]], x), b = v3_sub(p->v[p->t[t].v[1]], x),
                      c = v3_sub(p->v[p->t[t].v[2]], x);
        const double la = v3_norm(a), lb = v3_norm(b), lc = v3_norm(c);
        sum += 2.0 * atan2(v3_dot(a, v3_cross(b, c)),
                           la * lb * lc + v3_dot(a, b) * lc + v3_dot(b, c) * la + v3_dot(c, a) * lb);
    }
    return sum > 2.0 * PI;
}

int fl_closed_surface_prism(fl_part *p, int32_t n, const double (*xy)[2], double z0, double z1, fl_err *err)
{
    const int32_t from = p->nv;
    int32_t *loop = fl_alloc(n, sizeof *loop, err);
    int rc = -1;
    if (!loop) return -1;
    for (int32_t k = 0; k < 2 * n; k++)
        if (fl_surface_vertex(p, v3(xy[k % n][0], xy[k % n][1], k < n ? z0 : z1), err)) goto done;
    for (int32_t k = 0; k < n; k++) {
        const int32_t a = from + k, b = from + (k + 1) % n;
        if (fl_surface_triangle(p, a, b, b + n, err) || fl_surface_triangle(p, a, b + n, a + n, err))
            goto done;
    }
    for (int32_t k = 0; k < n; k++) loop[k] = from + n - 1 - k;
    if (fl_facet_polygon(p, n, loop, err)) goto done;
    for (int32_t k = 0; k < n; k++) loop[k] = from + n + k;
    rc = fl_facet_polygon(p, n, loop, err);
done:
    free(loop);
    return rc;
}
