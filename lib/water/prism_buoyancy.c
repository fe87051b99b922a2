/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "water/prism_buoyancy.h"

#define PRISM_TOL 1e-12 /* of the size, and of a radian: the rounding of coordinates and normals */

/* Length of the edges along e if every vertex ends exactly one and all run from one plane normal to e to
 * another; else 0. *low: e.x of the lower plane. */
static double long_edge_length(const fl_poly *p, fl_vec3 e, double *low)
{
    const double same = PRISM_TOL * p->size;
    double length = 0.0;
    int32_t n = 0;
    *low = INFINITY;
    for (int32_t v = 0; v < p->nv; v++) *low = fmin(*low, v3_dot(e, p->v[v]));
    for (int32_t k = 0; k < p->ne; k++) {
        const fl_vec3 u = v3_sub(p->v[p->edge[k].b], p->v[p->edge[k].a]);
        const double along = fabs(v3_dot(e, u));
        if (along <= same) continue; /* an edge of a cap */
        if (v3_norm(v3_cross(e, u)) > same) return 0.0;
        if (n++ == 0) length = along;
        if (fabs(along - length) > same) return 0.0;
    }
    for (int32_t v = 0; v < p->nv; v++) {
        const double up = v3_dot(e, p->v[v]) - *low;
        if (up > same && fabs(up - length) > same) return 0.0;
    }
    return 2 * n == p->nv ? length : 0.0;
}

/* The face with normal e; -1 if there is none, or several. */
static int32_t find_cap(const fl_poly *p, fl_vec3 e)
{
    int32_t found = -1;
    for (int32_t f = 0; f < p->nf; f++) {
        if (v3_norm(v3_sub(p->n[f], e)) > PRISM_TOL) continue;
        if (found >= 0) return -1;
        found = f;
    }
    return found;
}

/* Sets the cross-section from cap f. */
static void set_section(fl_prism *q, const fl_poly *p, int32_t f)
{
    const int32_t *loop = p->loop + p->first[f], n = p->first[f + 1] - p->first[f];
    const fl_vec3 hub = p->v[loop[0]], b = v3_cross(q->e, q->a);
    double area = 0.0, ma = 0.0, mb = 0.0, length = 0.0, la = 0.0, lb = 0.0;
    for (int way = 0; way < 2; way++) { /* first the centroid, then the moments about it */
        const double oa = way ? ma : 0.0, ob = way ? mb : 0.0;
        double a2 = 0.0, sa = 0.0, sb = 0.0;
        q->jaa = q->jab = q->jbb = q->far2 = length = la = lb = 0.0;
        for (int32_t k = 0; k < n; k++) {
            const fl_vec3 u = v3_sub(p->v[loop[k]], hub), v = v3_sub(p->v[loop[k + 1 < n ? k + 1 : 0]], hub);
            const double xa = v3_dot(q->a, u) - oa, xb = v3_dot(b, u) - ob;
            const double ya = v3_dot(q->a, v) - oa, yb = v3_dot(b, v) - ob;
            const double twice = xa * yb - xb * ya, side = v3_norm(v3_sub(v, u));
            a2 += twice;
            sa += twice * (xa + ya) / 3.0;
            sb += twice * (xb + yb) / 3.0;
            q->jaa += twice * (xa * xa + xa * ya + ya * ya) / 12.0;
            q->jbb += twice * (xb * xb + xb * yb + yb * yb) / 12.0;
            q->jab += twice * (2.0 * (xa * xb + ya * yb) + xa * yb + xb * ya) / 24.0;
            q->far2 = fmax(q->far2, xa * xa + xb * xb);
            length += side;
            la += 0.5 * side * (xa + ya);
            lb += 0.5 * side * (xb + yb);
        }
        area = 0.5 * a2;
        if (way == 0) ma = sa / a2, mb = sb / a2;
    }
    q->area = area;
    q->perimeter = length;
    q->ga = la / length, q->gb = lb / length;
    q->o = v3_madd(v3_madd(hub, ma, q->a), mb, b);
    q->o = v3_madd(q->o, -v3_dot(q->e, q->o), q->e);
}

void fl_prism_of(fl_prism *out, const fl_poly *p)
{
    double best = INFINITY;
    *out = (fl_prism){0};
    if (p->nf < 5 || p->nv % 2) return;
    for (int32_t k = p->neighbour_first[0]; k < p->neighbour_first[1]; k++) {
        const fl_vec3 e = v3_unit(v3_sub(p->v[p->neighbour[k]], p->v[0]));
        double low;
        const double length = long_edge_length(p, e, &low);
        const int32_t top = find_cap(p, e), bottom = find_cap(p, v3_neg(e));
        if (!(length > 0.0) || length >= best || top < 0 || bottom < 0) continue;
        best = length;
        *out = (fl_prism){.e = p->n[top], .z0 = low, .z1 = low + length};
        const fl_vec3 x = fabs(e.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0);
        out->a = v3_unit(v3_cross(out->e, x));
        set_section(out, p, top);
    }
}

int fl_prism_submerged(const fl_prism *p, fl_vec3 up, double level, fl_submerged *wet)
{
    double ue = v3_dot(up, p->e), z0 = p->z0, z1 = p->z1, sign = 1.0;
    if (ue < 0.0) ue = -ue, sign = -1.0, z0 = -p->z1, z1 = -p->z0; /* upside down: seen along -e */
    if (!(ue > FL_PRISM_MIN_UPRIGHT)) return 0;
    const fl_vec3 b = v3_cross(p->e, p->a);
    const double per_ue = 1.0 / ue, sa = -per_ue * v3_dot(up, p->a), sb = -per_ue * v3_dot(up, b);
    const double zw = per_ue * (level - v3_dot(up, p->o)), wet0 = zw - z0, dry0 = z1 - zw;
    const double least = wet0 < dry0 ? wet0 : dry0;
    if (!(least > 0.0) || !(least * least > (sa * sa + sb * sb) * p->far2)) return 0;
    const double ja = p->jaa * sa + p->jab * sb, jb = p->jab * sa + p->jbb * sb;
    const double volume = p->area * wet0, per = 1.0 / volume;
    const double mz = 0.5 * (p->area * wet0 * (zw + z0) + sa * ja + sb * jb);
    wet->volume = volume;
    wet->centre = v3_madd(v3_madd(v3_madd(p->o, per * ja, p->a), per * jb, b), sign * per * mz, p->e);
    wet->wetted_area = p->area + p->perimeter * (wet0 + sa * p->ga + sb * p->gb);
    wet->waterplane_area = per_ue * p->area;
    return 1;
}
