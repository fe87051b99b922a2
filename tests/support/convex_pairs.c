/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/convex_pairs.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/pi.h"
#include "base/rng.h"
#include "geom/quat.h"

enum { CORNERS = 12 };

static double log_in(fl_rng *g, double lo, double hi) { return pow(10.0, fl_rng_in(g, lo, hi)); }
static int below(fl_rng *g, int n) { return (int)(fl_rng_unit(g) * n); }

static fl_vec3 random_direction(fl_rng *g)
{
    const double z = fl_rng_in(g, -1.0, 1.0), a = fl_rng_in(g, 0.0, 2.0 * PI), s = sqrt(1.0 - z * z);
    return v3(s * cos(a), s * sin(a), z);
}

static fl_mat3 random_rotation(fl_rng *g)
{
    const fl_quat q = {fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g)};
    return q_matrix(q_unit(q));
}

static int make(fl_poly *p, int32_t nv, const fl_vec3 *v, int32_t nf, const int32_t *first,
                const int32_t *loop)
{
    fl_err err = {0};
    if (fl_poly_make(p, nv, v, nf, first, loop, &err) == 0) return 0;
    fprintf(stderr, "shape of a test pair refused: %s\n", err.text);
    return -1;
}

/* Two copies of a ring of n corners, joined: prisms, frusta, boxes. */
static int make_prism(fl_poly *p, int32_t n, const fl_vec3 *low, const fl_vec3 *high)
{
    fl_vec3 v[2 * CORNERS];
    int32_t first[CORNERS + 3], loop[6 * CORNERS], k = 0;
    first[0] = 0;
    for (int32_t i = 0; i < n; i++) {
        v[i] = low[i];
        v[n + i] = high[i];
        loop[k++] = n - 1 - i;
    }
    first[1] = k;
    for (int32_t i = 0; i < n; i++) loop[k++] = n + i;
    first[2] = k;
    for (int32_t i = 0; i < n; i++) {
        const int32_t j = (i + 1) % n;
        const int32_t q[4] = {i, j, n + j, n + i};
        memcpy(loop + k, q, sizeof q);
        k += 4;
        first[3 + i] = k;
    }
    return make(p, 2 * n, v, n + 2, first, loop);
}

/* Corners of a convex polygon on an ellipse of half axes a, b; near > 0: the last corner lies that close to
 * the one before. */
static void ring(fl_rng *g, int32_t n, double a, double b, double near, fl_vec3 *out)
{
    double at = fl_rng_in(g, 0.0, 2.0 * PI);
    for (int32_t i = 0; i < n; i++) {
        out[i] = v3(a * cos(at), b * sin(at), 0.0);
        at += 2.0 * PI / n * fl_rng_in(g, 0.5, 1.0);
        if (near > 0.0 && i == n - 2) at = atan2(out[i].y / b, out[i].x / a) + near;
    }
}

static int make_prism_over(fl_poly *p, int32_t n, const fl_vec3 *base, double h, double scale, fl_vec3 lean)
{
    fl_vec3 low[CORNERS], high[CORNERS];
    for (int32_t i = 0; i < n; i++) {
        low[i] = v3_sub(base[i], v3(0, 0, h / 2));
        high[i] = v3_add(v3_scale(scale, base[i]), v3_add(lean, v3(0, 0, h / 2)));
    }
    return make_prism(p, n, low, high);
}

static int make_box(fl_poly *p, double x, double y, double z)
{
    fl_err err = {0};
    return fl_poly_box(p, v3(x / 2, y / 2, z / 2), &err);
}

static int make_flat(fl_poly *p, int32_t n, const fl_vec3 *base)
{
    int32_t first[3] = {0, n, 2 * n}, loop[2 * CORNERS];
    for (int32_t i = 0; i < n; i++) {
        loop[i] = i;
        loop[n + i] = n - 1 - i;
    }
    return make(p, n, base, 2, first, loop);
}

static int make_double_pyramid(fl_poly *p, double x, double y, double z)
{
    const fl_vec3 v[6] = {{x, 0, 0}, {0, y, 0}, {-x, 0, 0}, {0, -y, 0}, {0, 0, z}, {0, 0, -z}};
    int32_t first[9], loop[24], k = 0;
    first[0] = 0;
    for (int32_t i = 0; i < 4; i++) {
        const int32_t j = (i + 1) % 4, up[3] = {i, j, 4}, down[3] = {j, i, 5};
        memcpy(loop + k, up, sizeof up);
        memcpy(loop + k + 3, down, sizeof down);
        first[2 * i + 1] = k + 3;
        first[2 * i + 2] = k += 6;
    }
    return make(p, 6, v, 8, first, loop);
}

static int make_tetrahedron(fl_poly *p, fl_rng *g)
{
    static const int32_t first[5] = {0, 3, 6, 9, 12}, loop[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    const double s = log_in(g, -1.0, 0.0);
    const fl_vec3 v[4] = {{0, 0, 0},
                          {1, 0, 0},
                          {fl_rng_in(g, -1.0, 1.0), fl_rng_in(g, 0.3, 1.0), 0},
                          {fl_rng_in(g, -1.0, 1.0), fl_rng_in(g, -1.0, 1.0), s}};
    return make(p, 4, v, 4, first, loop);
}

static int ordinary_shape(fl_poly *p, fl_rng *g)
{
    const double x = log_in(g, -1.0, 0.0), y = log_in(g, -1.0, 0.0), z = log_in(g, -1.0, 0.0);
    const int32_t n = 3 + below(g, 6);
    fl_vec3 base[CORNERS];
    ring(g, n, x, y, 0.0, base);
    switch (below(g, 12)) {
    case 0: return make(p, 1, &(fl_vec3){0, 0, 0}, 0, (int32_t[]){0}, (int32_t[]){0});
    case 1: return make(p, 2, (fl_vec3[]){{0, 0, 0}, {x, y, z}}, 0, (int32_t[]){0}, (int32_t[]){0});
    case 2: return make_flat(p, n, base);
    case 3:
    case 4: return make_tetrahedron(p, g);
    case 5: return make_double_pyramid(p, x, y, z);
    case 6:
    case 7: return make_box(p, x, y, z);
    case 8: return make_prism_over(p, n, base, z, fl_rng_in(g, 0.3, 1.0), v3(x * fl_rng_unit(g), 0, 0));
    default: return make_prism_over(p, n, base, z, 1.0, v3(0, 0, 0));
    }
}

static int hostile_shape(fl_poly *p, fl_rng *g, double near)
{
    const double x = 1 + below(g, 4), y = 1 + below(g, 4), z = 1 + below(g, 2), thin = log_in(g, -3.0, -2.0);
    fl_vec3 base[CORNERS];
    switch (below(g, 9)) {
    case 0:
    case 1: return make_box(p, 2 * x, 2 * y, 2 * z);
    case 2: return make_box(p, 4, 4, 0.04);
    case 3: return make_box(p, 4 * thin, 4 * thin, 4);
    case 4: { /* an octagon on the lattice */
        const fl_vec3 o[8] = {{2, 1, 0},   {1, 2, 0},   {-1, 2, 0}, {-2, 1, 0},
                              {-2, -1, 0}, {-1, -2, 0}, {1, -2, 0}, {2, -1, 0}};
        return make_prism_over(p, 8, o, z, 1.0, v3(0, 0, 0));
    }
    case 5: { /* a triangle on the lattice */
        const fl_vec3 o[3] = {{0, 0, 0}, {2 * x, 0, 0}, {0, 2 * y, 0}};
        return below(g, 2) ? make_flat(p, 3, o) : make_prism_over(p, 3, o, z, 1.0, v3(0, 0, 0));
    }
    case 6: return make_double_pyramid(p, x, y, z);
    case 7: return make(p, 2, (fl_vec3[]){{0, 0, 0}, {2 * x, 0, 0}}, 0, (int32_t[]){0}, (int32_t[]){0});
    default: {
        const int32_t n = 4 + below(g, 4);
        ring(g, n, 2.0, 2.0, near, base);
        return make_prism_over(p, n, base, 1.0, 1.0, v3(0, 0, 0));
    }
    }
}

/* All quadrilaterals are flat. */
int pair_ellipsoid(fl_poly *p, int32_t rings, int32_t around, fl_vec3 axis)
{
    const int32_t nv = rings * around + 2, nf = (rings + 1) * around, nl = 4 * nf;
    fl_vec3 *v = malloc((size_t)nv * sizeof *v);
    int32_t *first = malloc((size_t)(nf + 1 + nl) * sizeof *first), *loop = first + nf + 1, k = 0, f = 0;
    int rc = -1;
    if (!v || !first) goto done;
    v[0] = v3(0, 0, -axis.z);
    v[nv - 1] = v3(0, 0, axis.z);
    for (int32_t r = 0; r < rings; r++)
        for (int32_t i = 0; i < around; i++) {
            const double up = PI * (r + 1) / (rings + 1), at = 2.0 * PI * i / around;
            v[1 + r * around + i] =
                v3(axis.x * sin(up) * cos(at), axis.y * sin(up) * sin(at), -axis.z * cos(up));
        }
    first[0] = 0;
    for (int32_t r = 0; r <= rings; r++)
        for (int32_t i = 0; i < around; i++) {
            const int32_t j = (i + 1) % around, low = 1 + (r - 1) * around, high = 1 + r * around;
            if (r == 0) {
                const int32_t t[3] = {0, high + j, high + i};
                memcpy(loop + k, t, sizeof t);
            } else if (r == rings) {
                const int32_t t[3] = {low + i, low + j, nv - 1};
                memcpy(loop + k, t, sizeof t);
            } else {
                const int32_t q[4] = {low + i, low + j, high + j, high + i};
                memcpy(loop + k, q, sizeof q);
            }
            k += r == 0 || r == rings ? 3 : 4;
            first[++f] = k;
        }
    rc = make(p, nv, v, nf, first, loop);
done:
    free(v);
    free(first);
    return rc;
}

static int make_column(fl_poly *p, int32_t n, fl_vec3 axis)
{
    fl_err err = {0};
    fl_vec3 *xy = malloc((size_t)n * sizeof *xy);
    if (!xy) return -1;
    for (int32_t i = 0; i < n; i++)
        xy[i] = v3(axis.x * cos(2.0 * PI * i / n), axis.y * sin(2.0 * PI * i / n), 0);
    const int rc = fl_poly_prism(p, n, xy, -axis.z, axis.z, &err);
    if (rc) fprintf(stderr, "shape of a test pair refused: %s\n", err.text);
    free(xy);
    return rc;
}

/* About 4 to 10 000 vertices, uniform in the logarithm. */
static int large_shape(fl_poly *p, fl_rng *g)
{
    const double n = log_in(g, 0.7, 4.0), thin = below(g, 3) ? 1.0 : 0.01;
    const fl_vec3 axis = v3(thin * log_in(g, -0.5, 0.0), log_in(g, -0.5, 0.0), log_in(g, -0.5, 0.0));
    if (below(g, 3) == 0) return make_column(p, (int32_t)fmax(3.0, 0.5 * n), v3(axis.z, axis.y, axis.x));
    const int32_t around = (int32_t)fmax(3.0, sqrt(n) * fl_rng_in(g, 0.7, 1.4));
    return pair_ellipsoid(p, (int32_t)fmax(1.0, (n - 2.0) / around), around, axis);
}

void pair_place(pair_case *q, int k, fl_vec3 o, fl_mat3 r)
{
    const fl_poly *p = &q->p[k];
    for (int32_t i = 0; i < p->nv; i++) q->v[k][i] = v3_add(o, m3_mul(r, p->v[i]));
    for (int32_t f = 0; f < p->nf; f++) q->n[k][f] = m3_mul(r, p->n[f]);
    *(k ? &q->b : &q->a) = (fl_solid){p, q->v[k], q->n[k], 0.0};
}

/* Shifts both bodies so that b lies at the gap g below a along n: min over a of n.x - max over b of n.y =
 * g. */
static void set_gap(pair_case *q, fl_vec3 n, double g)
{
    double la = INFINITY, hb = -INFINITY;
    for (int32_t i = 0; i < q->p[0].nv; i++) la = fmin(la, v3_dot(n, q->v[0][i]));
    for (int32_t j = 0; j < q->p[1].nv; j++) hb = fmax(hb, v3_dot(n, q->v[1][j]));
    for (int32_t j = 0; j < q->p[1].nv; j++) q->v[1][j] = v3_madd(q->v[1][j], la - hb - g, n);
}

static double shortest_edge(const fl_poly *p)
{
    double s = p->size;
    for (int32_t e = 0; e < p->ne; e++) s = fmin(s, v3_norm(v3_sub(p->v[p->edge[e].a], p->v[p->edge[e].b])));
    return p->size > 0.0 ? s / p->size : 1.0;
}

/* Memory for the world vertices and normals of the two shapes. */
static int allocate_world_arrays(pair_case *q)
{
    for (int k = 0; k < 2; k++) {
        q->v[k] = malloc(((size_t)q->p[k].nv + 1) * sizeof *q->v[k]);
        q->n[k] = malloc(((size_t)q->p[k].nf + 1) * sizeof *q->n[k]);
        if (!q->v[k] || !q->n[k]) return -1;
    }
    q->size = q->p[0].size + q->p[1].size;
    if (!(q->size > 0.0)) q->size = 1.0;
    q->sharp = fmin(shortest_edge(&q->p[0]), shortest_edge(&q->p[1]));
    return 0;
}

static int ordinary(pair_case *q, fl_rng *g, int deep)
{
    if (ordinary_shape(&q->p[0], g) || ordinary_shape(&q->p[1], g) || allocate_world_arrays(q)) return -1;
    pair_place(q, 0, v3(0, 0, 0), random_rotation(g));
    pair_place(q, 1, v3_scale((deep ? 0.2 * fl_rng_unit(g) : 0.3) * q->size, random_direction(g)),
               random_rotation(g));
    if (deep) return 0;
    fl_vec3 n = random_direction(g);
    if (q->p[0].nf && below(g, 2)) n = q->n[0][below(g, q->p[0].nf)];
    const int what = below(g, 5);
    double gap = q->size * log_in(g, -9.0, what == 0 ? 3.0 : 0.0);
    if (what == 1) gap = -0.3 * gap;
    set_gap(q, n, gap);
    return 0;
}

static int large(pair_case *q, fl_rng *g)
{
    if (large_shape(&q->p[0], g) || large_shape(&q->p[1], g) || allocate_world_arrays(q)) return -1;
    const fl_mat3 one = q_matrix(q_one());
    const int flush = below(g, 4) == 0, far = below(g, 6) == 0;
    pair_place(q, 0, v3(0, 0, 0), flush ? one : random_rotation(g));
    pair_place(q, 1, v3_scale(0.3 * q->size, random_direction(g)), flush ? one : random_rotation(g));
    fl_vec3 n = flush ? v3(0, 0, 1) : random_direction(g);
    if (!flush && below(g, 2)) n = q->n[0][below(g, q->p[0].nf)];
    const double gap = q->size * log_in(g, -9.0, below(g, 5) ? 0.0 : 3.0);
    set_gap(q, n, below(g, 8) ? gap : -0.3 * gap);
    const fl_vec3 away = v3_scale(1e6 * q->size, random_direction(g));
    for (int k = 0; k < 2 && far; k++)
        for (int32_t i = 0; i < q->p[k].nv; i++) q->v[k][i] = v3_add(q->v[k][i], away);
    return 0;
}

static int hostile(pair_case *q, fl_rng *g)
{
    const double near = log_in(g, -8.5, -2.0);
    if (hostile_shape(&q->p[0], g, near)) return -1;
    const int same = below(g, 8) == 0;
    fl_err err = {0};
    if (same ? fl_poly_copy(&q->p[1], &q->p[0], &err) : hostile_shape(&q->p[1], g, near)) return -1;
    if (allocate_world_arrays(q)) return -1;
    const fl_mat3 one = q_matrix(q_one());
    fl_mat3 turn = one, tilt = one;
    if (below(g, 3) == 0) turn = random_rotation(g);
    if (below(g, 2)) {
        const int axis = below(g, 3);
        const double angle = log_in(g, -16.0, -3.0);
        const fl_quat t =
            below(g, 2) ? q_about_axis(axis, angle) : q_of_vector(v3_scale(angle, random_direction(g)));
        tilt = q_matrix(q_mul(t, q_about_axis(below(g, 3), 0.0)));
    }
    /* A shift on the lattice, so that edges and vertices coincide or are aligned. */
    const fl_vec3 shift = v3(below(g, 9) - 4, below(g, 9) - 4, below(g, 9) - 4);
    pair_place(q, 0, v3(0, 0, 0), turn);
    for (int k = 0; k < 2; k++) { /* b: tilt, shift on the lattice of a, then the common turn */
        if (k == 0) continue;
        for (int32_t i = 0; i < q->p[1].nv; i++)
            q->v[1][i] = m3_mul(turn, v3_add(shift, m3_mul(tilt, q->p[1].v[i])));
        for (int32_t f = 0; f < q->p[1].nf; f++) q->n[1][f] = m3_mul(turn, m3_mul(tilt, q->p[1].n[f]));
        q->b = (fl_solid){&q->p[1], q->v[1], q->n[1], 0.0};
    }
    const int what = below(g, 6);
    if (what < 4) {
        fl_vec3 n = m3_col(turn, below(g, 3));
        if (what == 3 && q->p[0].nf) n = q->n[0][below(g, q->p[0].nf)];
        const int how = below(g, 6);
        const double gap = how == 0   ? 0.0
                           : how == 1 ? -q->size * log_in(g, -9.0, -1.0)
                           : how == 2 ? ldexp(1.0, -below(g, 40))
                                      : q->size * log_in(g, -9.0, 1.0);
        set_gap(q, n, gap);
    }
    if (below(g, 6) == 0) {
        const fl_vec3 far = v3_scale(1e6, random_direction(g));
        for (int k = 0; k < 2; k++)
            for (int32_t i = 0; i < q->p[k].nv; i++) q->v[k][i] = v3_add(q->v[k][i], far);
    }
    return 0;
}

int pair_take(pair_case *q, fl_poly a, fl_poly b)
{
    *q = (pair_case){.p = {a, b}};
    if (allocate_world_arrays(q)) {
        pair_free(q);
        return -1;
    }
    for (int k = 0; k < 2; k++) pair_place(q, k, v3(0, 0, 0), q_matrix(q_one()));
    return 0;
}

int pair_make(pair_case *q, uint64_t seed, int64_t k, enum pair_kind kind)
{
    fl_rng g = fl_rng_of(seed, 3 * k + kind, FL_RNG_TEST);
    *q = (pair_case){0};
    const int rc = kind == PAIR_LARGE     ? large(q, &g)
                   : kind == PAIR_HOSTILE ? hostile(q, &g)
                                          : ordinary(q, &g, kind == PAIR_DEEP);
    if (rc) pair_free(q);
    return rc;
}

void pair_free(pair_case *q)
{
    for (int k = 0; k < 2; k++) {
        fl_poly_free(&q->p[k]);
        free(q->v[k]);
        free(q->n[k]);
    }
    *q = (pair_case){0};
}
