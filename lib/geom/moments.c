/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/pi.h"
#include "base/simd.h"
#include "geom/dd.h"
#include "geom/moments.h"

/* Volume, area, first moments, second moments xx yy zz xy yz zx, in 106 bits; one more fills the lanes. */
enum { VOLUME, AREA, FIRST, SECOND = FIRST + 3, TERMS = 12 };

struct moment_sums {
    fl_vec3 o;                 /* reference point */
    double h[TERMS], l[TERMS]; /* high and low parts, as in fl_dd */
};

/* Adds a term to each sum, as dd_add() with dd_of(x). */
static inline void add_terms(double *restrict h, double *restrict l, const double *restrict x)
{
#pragma omp simd
    for (int k = 0; k < TERMS; k++) {
        const fl_dd s = dd_two_sum(h[k], x[k]), u = dd_fast_two_sum(s.h, s.l + l[k]);
        h[k] = u.h;
        l[k] = u.l;
    }
}

FL_SIMD_VERSIONS static void add_triangles(struct moment_sums *to, const fl_part *part)
{
    struct moment_sums s = *to;
    for (int32_t t = 0; t < part->nt; t++) {
        const int32_t *v = part->t[t].v;
        const fl_vec3 p = part->v[v[0]], q = part->v[v[1]], r = part->v[v[2]];
        const fl_vec3 a = v3_sub(p, s.o), b = v3_sub(q, s.o), c = v3_sub(r, s.o);
        const fl_vec3 n = v3_cross(v3_sub(q, p), v3_sub(r, p)), m = v3_add(a, v3_add(b, c));
        const double d = v3_dot(a, n), e = d / 24.0, k = d / 120.0;
        const double x[TERMS] = {[VOLUME] = d / 6.0,
                                 [AREA] = 0.5 * v3_norm(n),
                                 [FIRST] = e * m.x,
                                 [FIRST + 1] = e * m.y,
                                 [FIRST + 2] = e * m.z,
                                 [SECOND] = k * (a.x * a.x + b.x * b.x + c.x * c.x + m.x * m.x),
                                 [SECOND + 1] = k * (a.y * a.y + b.y * b.y + c.y * c.y + m.y * m.y),
                                 [SECOND + 2] = k * (a.z * a.z + b.z * b.z + c.z * c.z + m.z * m.z),
                                 [SECOND + 3] = k * (a.x * a.y + b.x * b.y + c.x * c.y + m.x * m.y),
                                 [SECOND + 4] = k * (a.y * a.z + b.y * b.z + c.y * c.z + m.y * m.z),
                                 [SECOND + 5] = k * (a.z * a.x + b.z * b.x + c.z * c.x + m.z * m.x)};
        add_terms(s.h, s.l, x);
    }
    *to = s;
}

/* About p0, the centre of the first disc, axis u: along = int z^2 dV, across = int y^2 dV, first = V z_C. */
static void add_cone(struct moment_sums *s, const fl_cone *c)
{
    const fl_vec3 p = v3_sub(c->p0, s->o), axis = v3_sub(c->p1, c->p0), u = v3_unit(axis);
    const double h = v3_norm(axis), r = c->r0, q = c->r1;
    const double volume = PI * h / 3.0 * (r * r + r * q + q * q);
    const double first = PI * h * h / 12.0 * (r * r + 2.0 * r * q + 3.0 * q * q);
    const double along = PI * h * h * h / 30.0 * (r * r + 3.0 * r * q + 6.0 * q * q);
    const double across =
        PI * h / 20.0 * (r * r * r * r + r * r * r * q + r * r * q * q + r * q * q * q + q * q * q * q);
    const double pk[3] = {p.x, p.y, p.z}, uk[3] = {u.x, u.y, u.z};
    /* two terms for each first and second moment: along the axis, and from the position of p0 */
    double x[2][TERMS] = {{[VOLUME] = volume,
                           [AREA] = PI * (r + q) * hypot(h, r - q) + PI * r * r + PI * q * q,
                           [FIRST] = volume * p.x,
                           [FIRST + 1] = volume * p.y,
                           [FIRST + 2] = volume * p.z},
                          {[FIRST] = first * u.x, [FIRST + 1] = first * u.y, [FIRST + 2] = first * u.z}};
    for (int k = 0; k < 6; k++) {
        const int i = k % 3, j = k < 3 ? i : (i + 1) % 3;
        x[0][SECOND + k] = (along - across) * uk[i] * uk[j] + (i == j ? across : 0.0);
        x[1][SECOND + k] = first * (uk[i] * pk[j] + pk[i] * uk[j]) + volume * pk[i] * pk[j];
    }
    add_terms(s->h, s->l, x[0]);
    add_terms(s->h, s->l, x[1]);
}

fl_moments fl_moments_of(const fl_part *p, int32_t n)
{
    const fl_surface all = {.n = n, .part = (fl_part *)p};
    const fl_aabb box = fl_surface_aabb(&all);
    struct moment_sums s = {0};
    fl_moments m = {0};
    fl_vec3 c = {0};
    double k[6], trace;
    if (!(box.lo.x <= box.hi.x)) return m;
    s.o = v3_scale(0.5, v3_add(box.lo, box.hi));
    for (int32_t i = 0; i < n; i++) {
        add_triangles(&s, &p[i]);
        for (int32_t j = 0; j < p[i].nc; j++) add_cone(&s, &p[i].cone[j]);
    }
    m.volume = s.h[VOLUME];
    m.area = s.h[AREA];
    if (m.volume != 0.0) c = v3_scale(1.0 / m.volume, v3(s.h[FIRST], s.h[FIRST + 1], s.h[FIRST + 2]));
    m.centroid = v3_add(s.o, c);
    for (int i = 0; i < 3; i++) {
        const double x[3] = {c.x, c.y, c.z};
        k[i] = s.h[SECOND + i] - m.volume * x[i] * x[i];
        k[3 + i] = s.h[SECOND + 3 + i] - m.volume * x[i] * x[(i + 1) % 3];
    }
    trace = k[0] + k[1] + k[2];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        m.inertia.m[i][i] = trace - k[i];
        m.inertia.m[i][j] = m.inertia.m[j][i] = -k[3 + i];
    }
    return m;
}
