/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stddef.h>
#include "base/pi.h"
#include "geom/mass.h"

/* Second moments are sums of some tens of terms of the size of the trace, each accurate to DBL_EPSILON /
 * 2. */
static const double OFF_TOL = 1e-15;
/* Eigenvalues this close, relative to the trace, differ by rounding only.  They count as equal, so that a
 * square body keeps its axes. */
static const double TIE_TOL = 1e-14;

/* Moments about the working origin: int dV, int x dV, int x x^T dV. */
struct moment_sums {
    double v;
    fl_vec3 x;
    fl_mat3 xx;
};

static void add_outer(fl_mat3 *m, double s, fl_vec3 a, fl_vec3 b)
{
    const double u[3] = {a.x, a.y, a.z}, w[3] = {b.x, b.y, b.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) m->m[i][j] += s * u[i] * w[j];
}

static void add_symmetric(fl_mat3 *m, double s, fl_vec3 a, fl_vec3 b)
{
    add_outer(m, s, a, b);
    add_outer(m, s, b, a);
}

/* Adds face f, split into fan triangles: the tetrahedra from the working origin o and the slab of thickness
 * r.  For a simplex with corners x_k and volume v in d dimensions
 *     int x x^T = v / ((d+1)(d+2)) (sum_k x_k x_k^T + s s^T),   s = sum_k x_k */
static void add_face(struct moment_sums *t, const fl_poly *p, int32_t f, fl_vec3 o, double r)
{
    const int32_t *at = p->loop + p->first[f], m = p->first[f + 1] - p->first[f];
    const fl_vec3 n = p->n[f], a = v3_sub(p->v[at[0]], o);
    fl_vec3 b = v3_sub(p->v[at[1]], o), ax = {0};
    double area = 0.0;
    for (int32_t k = 2; k < m; k++) {
        const fl_vec3 c = v3_sub(p->v[at[k]], o), s = v3_add(v3_add(a, b), c);
        const fl_vec3 w = v3_cross(v3_sub(b, a), v3_sub(c, a));
        const double v = p->nf > 2 ? v3_dot(a, w) / 6.0 : 0.0, tri = 0.5 * v3_dot(n, w);
        const double ss = v / 20.0 + r * tri / 12.0;
        t->v += v;
        t->x = v3_madd(t->x, v / 4.0, s);
        add_outer(&t->xx, ss, a, a);
        add_outer(&t->xx, ss, b, b);
        add_outer(&t->xx, ss, c, c);
        add_outer(&t->xx, ss, s, s);
        area += tri;
        ax = v3_madd(ax, tri / 3.0, s);
        b = c;
    }
    t->v += r * area;
    t->x = v3_add(t->x, v3_madd(v3_scale(r, ax), 0.5 * r * r * area, n));
    add_symmetric(&t->xx, 0.5 * r * r, ax, n);
    add_outer(&t->xx, r * r * r * area / 3.0, n, n);
}

/* Adds the sector of angle t along edge e, and the edge's part of the spherical sectors at its ends (all but
 * the terms of the solid angle). */
static void add_edge(struct moment_sums *s, const fl_poly *p, int32_t e, fl_vec3 o, double r)
{
    const fl_edge g = p->edge[e];
    const fl_vec3 a = v3_sub(p->v[g.a], o), b = v3_sub(p->v[g.b], o), mid = v3_scale(0.5, v3_add(a, b));
    const double len = v3_norm(v3_sub(b, a)), t = fl_poly_compute_bend(p, e), r3 = r * r * r / 3.0,
                 r4 = r * r * r * r / 4.0;
    const fl_vec3 d = v3_scale(1.0 / len, v3_sub(b, a));
    const int round = g.left < 0; /* a segment: the full turn, without a middle direction */
    const fl_vec3 l = round ? v3_normal_to(d) : p->n[g.left];
    /* The left normal turns into the right one about d; h is halfway. */
    const fl_vec3 h = v3_unit(v3_madd(v3_scale(cos(0.5 * t), l), sin(0.5 * t), v3_cross(d, l))),
                  w = v3_cross(d, h);
    const fl_vec3 q = v3_scale(round ? 0.0 : 2.0 * sin(0.5 * t), h);
    const double sine = round ? 0.0 : sin(t), area = 0.5 * t * r * r;

    s->v += len * area;
    s->x = v3_add(s->x, v3_madd(v3_scale(len * area, mid), len * r3, q));
    add_outer(&s->xx, len * area, mid, mid);
    add_outer(&s->xx, len * len * len * area / 12.0, d, d);
    add_symmetric(&s->xx, len * r3, mid, q);
    add_outer(&s->xx, len * r4 * 0.5 * (t + sine), h, h);
    add_outer(&s->xx, len * r4 * 0.5 * (t - sine), w, w);

    for (int end = 0; end < 2; end++) {
        const fl_vec3 x = end ? b : a, out = end ? v3_neg(d) : d;
        const fl_vec3 u = v3_scale(-0.5 * t * r4, out);
        s->x = v3_add(s->x, u);
        add_symmetric(&s->xx, 1.0, x, u);
        add_symmetric(&s->xx, -r * r4 * (4.0 / 5.0) / 6.0, out, q);
    }
}

/* Adds the terms of solid angle omega at vertex x. */
static void add_solid_angle(struct moment_sums *s, fl_vec3 x, double omega, double r)
{
    const double v = omega * r * r * r / 3.0;
    s->v += v;
    s->x = v3_madd(s->x, v, x);
    add_outer(&s->xx, v, x, x);
    for (int k = 0; k < 3; k++) s->xx.m[k][k] += omega * r * r * r * r * r / 15.0;
}

static struct moment_sums sum_body(const fl_poly *p, fl_vec3 o, double r)
{
    struct moment_sums s = {0};
    for (int32_t f = 0; f < p->nf; f++) add_face(&s, p, f, o, r);
    if (!(r > 0.0)) return s;
    for (int32_t e = 0; e < p->ne; e++) add_edge(&s, p, e, o, r);
    /* A vertex starts with 2 pi (4 pi if it is the only one); the angles of its faces are subtracted one by
     * one. */
    for (int32_t v = 0; v < p->nv; v++)
        add_solid_angle(&s, v3_sub(p->v[v], o), p->nv == 1 ? 4.0 * PI : 2.0 * PI, r);
    for (int32_t f = 0; f < p->nf; f++)
        for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) {
            const int32_t last = p->first[f + 1] - 1;
            const fl_vec3 x = p->v[p->loop[k]], a = v3_sub(p->v[p->loop[k < last ? k + 1 : p->first[f]]], x),
                          b = v3_sub(p->v[p->loop[k > p->first[f] ? k - 1 : last]], x);
            add_solid_angle(&s, v3_sub(x, o), -atan2(v3_norm(v3_cross(a, b)), v3_dot(a, b)), r);
        }
    return s;
}

int fl_mass_of(fl_mass *m, const fl_poly *p, double r, fl_err *err)
{
    fl_vec3 o = {0};
    struct moment_sums s = {0};
    double value[3];
    if (!(r > 0.0) && p->nf < 4) return fl_fail(err, FL_INPUT, "a body without volume has no mass");
    for (int32_t v = 0; v < p->nv; v++) o = v3_add(o, v3_sub(p->v[v], p->v[0]));
    o = v3_madd(p->v[0], 1.0 / p->nv, o);
    /* First about the mean vertex, to find the centroid, then about the centroid: subtracting V d d^T at the
     * end would cost a slender body its small moments. */
    s = sum_body(p, o, r);
    o = v3_madd(o, 1.0 / s.v, s.x);
    s = sum_body(p, o, r);
    fl_mass out = {.volume = s.v, .centre = v3_madd(o, 1.0 / s.v, s.x)};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) out.second.m[i][j] = 0.5 * (s.xx.m[i][j] + s.xx.m[j][i]);
    fl_mass_principal(&out.second, value, &out.axes);
    if (value[2] < 0.0) value[2] = 0.0; /* rounding hides the thickness: a lamina */
    out.inertia = v3(value[1] + value[2], value[0] + value[2], value[0] + value[1]);
    if (!(s.v > 0.0 && value[1] > 0.0 && isfinite(out.inertia.z)))
        return fl_fail(err, FL_INPUT, "a body of volume %g m^3 has no usable moments of inertia", s.v);
    *m = out;
    return 0;
}

void fl_mass_principal(const fl_mat3 *in, double value[3], fl_mat3 *axes)
{
    double a[3][3], u[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double trace = fabs(in->m[0][0]) + fabs(in->m[1][1]) + fabs(in->m[2][2]);
    const double off = OFF_TOL * trace, tie = TIE_TOL * trace;
    int order[3] = {0, 1, 2}, done = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) a[i][j] = in->m[i][j];
    /* Convergence is quadratic: five or six sweeps suffice.  The bound stops NaN only. */
    for (int sweep = 0; sweep < 50 && !done; sweep++) {
        done = 1;
        for (int i = 0; i < 2; i++)
            for (int j = i + 1; j < 3; j++) {
                if (fabs(a[i][j]) <= off) continue;
                const double q = (a[j][j] - a[i][i]) / (2.0 * a[i][j]);
                const double t = (q < 0.0 ? -1.0 : 1.0) / (fabs(q) + sqrt(q * q + 1.0));
                const double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
                const int k = 3 - i - j;
                const double aki = a[k][i], akj = a[k][j];
                a[i][i] -= t * a[i][j];
                a[j][j] += t * a[i][j];
                a[i][j] = a[j][i] = 0.0;
                a[k][i] = a[i][k] = c * aki - s * akj;
                a[k][j] = a[j][k] = s * aki + c * akj;
                for (int l = 0; l < 3; l++) {
                    const double ui = u[l][i], uj = u[l][j];
                    u[l][i] = c * ui - s * uj;
                    u[l][j] = s * ui + c * uj;
                }
                done = 0;
            }
    }
    for (int i = 0; i < 2; i++) /* stable sort of three elements by descending value */
        for (int j = 0; j < 2 - i; j++)
            if (a[order[j]][order[j]] < a[order[j + 1]][order[j + 1]] - tie) {
                const int swap = order[j];
                order[j] = order[j + 1];
                order[j + 1] = swap;
            }
    fl_vec3 e[3];
    for (int k = 0; k < 2; k++) {
        const int o = order[k];
        e[k] = v3(u[0][o], u[1][o], u[2][o]);
        const double x = fabs(e[k].x), y = fabs(e[k].y), z = fabs(e[k].z);
        const double lead = x >= y && x >= z ? e[k].x : y >= z ? e[k].y : e[k].z;
        if (lead < 0.0) e[k] = v3_neg(e[k]);
    }
    e[0] = v3_unit(e[0]);
    e[1] = v3_unit(v3_madd(e[1], -v3_dot(e[0], e[1]), e[0]));
    e[2] = v3_cross(e[0], e[1]);
    for (int k = 0; k < 3; k++) {
        value[k] = a[order[k]][order[k]];
        if (k > 0 && value[k] > value[k - 1]) value[k] = value[k - 1]; /* tied: by at most `tie` */
        axes->m[0][k] = e[k].x;
        axes->m[1][k] = e[k].y;
        axes->m[2][k] = e[k].z;
    }
}
