/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geom/dd.h"
#include "geom/moments.h"

static const double PI = 3.141592653589793238;

/* About o: volume, area, first moments, and xx yy zz xy yz zx of the second. */
struct sums {
    fl_vec3 o;
    fl_dd volume, area, first[3], second[6];
};

static void add(fl_dd *sum, double x) { *sum = dd_add(*sum, dd_of(x)); }

static void add3(fl_dd sum[3], double s, fl_vec3 x)
{
    add(&sum[0], s * x.x);
    add(&sum[1], s * x.y);
    add(&sum[2], s * x.z);
}

static void add_triangle(struct sums *s, fl_vec3 p, fl_vec3 q, fl_vec3 r)
{
    const fl_vec3 a = v3_sub(p, s->o), b = v3_sub(q, s->o), c = v3_sub(r, s->o);
    const fl_vec3 n = v3_cross(v3_sub(q, p), v3_sub(r, p)), m = v3_add(a, v3_add(b, c));
    const double d = v3_dot(a, n), k = d / 120.0;
    add(&s->volume, d / 6.0);
    add(&s->area, 0.5 * v3_norm(n));
    add3(s->first, d / 24.0, m);
    add(&s->second[0], k * (a.x * a.x + b.x * b.x + c.x * c.x + m.x * m.x));
    add(&s->second[1], k * (a.y * a.y + b.y * b.y + c.y * c.y + m.y * m.y));
    add(&s->second[2], k * (a.z * a.z + b.z * b.z + c.z * c.z + m.z * m.z));
    add(&s->second[3], k * (a.x * a.y + b.x * b.y + c.x * c.y + m.x * m.y));
    add(&s->second[4], k * (a.y * a.z + b.y * b.z + c.y * c.z + m.y * m.z));
    add(&s->second[5], k * (a.z * a.x + b.z * b.x + c.z * c.x + m.z * m.x));
}

/* About its middle p0, with the axis u: along = int z^2 dV, across = int y^2 dV, and V z_C. */
static void add_cone(struct sums *s, const fl_cone *c)
{
    const fl_vec3 p = v3_sub(c->p0, s->o), axis = v3_sub(c->p1, c->p0), u = v3_unit(axis);
    const double h = v3_norm(axis), r = c->r0, q = c->r1;
    const double volume = PI * h / 3.0 * (r * r + r * q + q * q);
    const double first = PI * h * h / 12.0 * (r * r + 2.0 * r * q + 3.0 * q * q);
    const double along = PI * h * h * h / 30.0 * (r * r + 3.0 * r * q + 6.0 * q * q);
    const double across =
        PI * h / 20.0 * (r * r * r * r + r * r * r * q + r * r * q * q + r * q * q * q + q * q * q * q);
    const double pk[3] = {p.x, p.y, p.z}, uk[3] = {u.x, u.y, u.z};
    add(&s->volume, volume);
    add(&s->area, PI * (r + q) * hypot(h, r - q) + PI * r * r + PI * q * q);
    add3(s->first, volume, p);
    add3(s->first, first, u);
    for (int k = 0; k < 6; k++) {
        const int i = k % 3, j = k < 3 ? i : (i + 1) % 3;
        add(&s->second[k], (along - across) * uk[i] * uk[j] + (i == j ? across : 0.0));
        add(&s->second[k], first * (uk[i] * pk[j] + pk[i] * uk[j]) + volume * pk[i] * pk[j]);
    }
}

fl_moments fl_moments_of(const fl_part *p, int32_t n)
{
    const fl_surface all = {.n = n, .part = (fl_part *)p};
    const fl_aabb box = fl_surface_aabb(&all);
    struct sums s = {0};
    fl_moments m = {0};
    fl_vec3 c = {0};
    double k[6], trace;
    if (!(box.lo.x <= box.hi.x)) return m;
    s.o = v3_scale(0.5, v3_add(box.lo, box.hi));
    for (int32_t i = 0; i < n; i++) {
        for (int32_t t = 0; t < p[i].nt; t++) {
            const int32_t *v = p[i].t[t].v;
            add_triangle(&s, p[i].v[v[0]], p[i].v[v[1]], p[i].v[v[2]]);
        }
        for (int32_t j = 0; j < p[i].nc; j++) add_cone(&s, &p[i].cone[j]);
    }
    m.volume = s.volume.h;
    m.area = s.area.h;
    if (m.volume != 0.0) c = v3_scale(1.0 / m.volume, v3(s.first[0].h, s.first[1].h, s.first[2].h));
    m.centroid = v3_add(s.o, c);
    for (int i = 0; i < 3; i++) {
        const double x[3] = {c.x, c.y, c.z};
        k[i] = s.second[i].h - m.volume * x[i] * x[i];
        k[3 + i] = s.second[3 + i].h - m.volume * x[i] * x[(i + 1) % 3];
    }
    trace = k[0] + k[1] + k[2];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        m.inertia.m[i][i] = trace - k[i];
        m.inertia.m[i][j] = m.inertia.m[j][i] = -k[3 + i];
    }
    return m;
}
