/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geom/dilate.h"
#include "base/pi.h"

/* sum_e l_e t_e */
static double edge_sum(const fl_poly *p)
{
    double s = 0.0;
    for (int32_t e = 0; e < p->ne; e++)
        s += v3_norm(v3_sub(p->v[p->edge[e].b], p->v[p->edge[e].a])) * fl_poly_compute_bend(p, e);
    return s;
}

double fl_dilate_volume(const fl_poly *p, double r)
{
    double v = 0.0, a = 0.0;
    for (int32_t f = 0; f < p->nf; f++) {
        const fl_vec3 s = fl_poly_face_area_vector(p, f);
        /* Heights are measured from vertex 0, since the origin may be far away; a flat body has no volume. */
        v += v3_dot(s, v3_sub(p->v[p->loop[p->first[f]]], p->v[0])) / 3.0;
        a += v3_norm(s);
    }
    if (p->nf == 2) v = 0.0;
    return v + r * (a + r * (0.5 * edge_sum(p) + r * (4.0 / 3.0) * PI));
}

double fl_dilate_area(const fl_poly *p, double r)
{
    double a = 0.0;
    for (int32_t f = 0; f < p->nf; f++) a += v3_norm(fl_poly_face_area_vector(p, f));
    return a + r * (edge_sum(p) + 4.0 * PI * r);
}
