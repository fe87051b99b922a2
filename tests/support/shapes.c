/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include "base/array.h"
#include "geom/clip.h"
#include "support/shapes.h"

static void check_result(int rc, const fl_err *err, const char *what)
{
    if (rc == 0) return;
    fprintf(stderr, "%s: %s\n", what, err->text);
    exit(1);
}

fl_vec3 shape_direction(fl_rng *g)
{
    fl_vec3 v;
    do v = v3(fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g));
    while (v3_norm(v) < 1e-3);
    return v3_unit(v);
}

fl_quat shape_rotation(fl_rng *g)
{
    fl_quat q;
    do q = (fl_quat){fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g)};
    while (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z < 1e-3);
    return q_unit(q);
}

void shape_move(fl_poly *p, fl_quat q, fl_vec3 d)
{
    /* to_frame computes transpose(axes) (x - o): axes = transpose(R) and o = -transpose(R) d */
    const fl_mat3 axes = q_matrix(q_conj(q));
    fl_poly_to_frame(p, v3_neg(m3_mul(axes, d)), axes);
}

void shape_copy_moved(fl_poly *to, const fl_poly *from, double s, fl_quat q, fl_vec3 d)
{
    fl_err err = {0};
    fl_vec3 *v = fl_alloc(from->nv, sizeof *v, &err);
    const fl_mat3 r = q_matrix(q);
    if (!v) check_result(-1, &err, "copy");
    for (int32_t k = 0; k < from->nv; k++) v[k] = v3_madd(d, s, m3_mul(r, from->v[k]));
    check_result(fl_poly_make(to, from->nv, v, from->nf, from->first, from->loop, &err), &err, "copy");
    free(v);
}

void shape_random_box(fl_poly *p, fl_rng *g, double lo, double hi)
{
    fl_err err = {0};
    const double x = fl_rng_in(g, lo, hi), y = fl_rng_in(g, lo, hi), z = fl_rng_in(g, lo, hi);
    check_result(fl_poly_box(p, v3(pow(10.0, x), pow(10.0, y), pow(10.0, z)), &err), &err, "random box");
}

void shape_random_prism(fl_poly *p, fl_rng *g)
{
    fl_err err = {0};
    fl_vec3 xy[8];
    const int n = 3 + (int)fl_rng_in(g, 0.0, 6.0);
    const double a = fl_rng_in(g, 0.5, 2.0), b = a * fl_rng_in(g, 0.4, 1.0),
                 h = a * pow(10.0, fl_rng_in(g, -1.7, 0.0));
    const double start = fl_rng_in(g, 0.0, 6.28);
    for (int k = 0; k < n; k++) {
        const double t = start + 6.283185307179586 * (k + fl_rng_in(g, 0.0, 0.8)) / n;
        xy[k] = v3(a * cos(t), b * sin(t), 0.0);
    }
    check_result(fl_poly_prism(p, n, xy, -0.5 * h, 0.5 * h, &err), &err, "random prism");
}

/* Cuts while the planes give valid bodies; a cut that leaves a face too narrow is omitted. */
static void cut_corners(fl_poly *p, fl_rng *g, fl_vec3 half, int cuts)
{
    for (int k = 0; k < cuts; k++) {
        fl_err err = {0};
        const fl_vec3 n = shape_direction(g);
        const double reach = fabs(n.x) * half.x + fabs(n.y) * half.y + fabs(n.z) * half.z;
        const double c = reach * fl_rng_in(g, 0.3, 1.0);
        if (fl_poly_cut(p, n, c, &err) && err.code != FL_NUMERIC) check_result(-1, &err, "random cut");
    }
}

void shape_random_polytope(fl_poly *p, fl_rng *g, int cuts)
{
    fl_err err = {0};
    const fl_vec3 h = v3(fl_rng_in(g, 0.5, 2.0), fl_rng_in(g, 0.5, 2.0), fl_rng_in(g, 0.5, 2.0));
    check_result(fl_poly_box(p, h, &err), &err, "random polytope");
    cut_corners(p, g, h, cuts);
}

void shape_random_sliver(fl_poly *p, fl_rng *g)
{
    fl_err err = {0};
    const double thin = pow(10.0, fl_rng_in(g, -3.0, -1.0));
    const fl_vec3 h = fl_rng_unit(g) < 0.5 ? v3(1.0, fl_rng_in(g, 0.5, 1.0), thin) : v3(1.0, thin, thin);
    check_result(fl_poly_box(p, h, &err), &err, "random sliver");
    cut_corners(p, g, h, 2);
}

void shape_random(fl_poly *p, fl_rng *g)
{
    const double u = fl_rng_unit(g);
    if (u < 0.2) shape_random_box(p, g, -0.5, 0.5);
    else if (u < 0.5) shape_random_prism(p, g);
    else if (u < 0.85) shape_random_polytope(p, g, 1 + (int)fl_rng_in(g, 0.0, 12.0));
    else shape_random_sliver(p, g);
}

void shape_regular(fl_poly *p, int faces, double r)
{
    static const fl_vec3 tetra[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    static const fl_vec3 octa[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    static const double gold = 1.618033988749895;
    const fl_vec3 icosa[12] = {{0, 1, gold}, {0, -1, gold}, {0, 1, -gold}, {0, -1, -gold},
                               {1, gold, 0}, {-1, gold, 0}, {1, -gold, 0}, {-1, -gold, 0},
                               {gold, 0, 1}, {gold, 0, -1}, {-gold, 0, 1}, {-gold, 0, -1}};
    const int32_t n = faces == 4 ? 4 : faces == 8 ? 6 : 12;
    const fl_vec3 *from = faces == 4 ? tetra : faces == 8 ? octa : icosa;
    fl_vec3 v[12];
    int32_t first[21] = {0}, loop[60], nf = 0;
    fl_err err = {0};
    for (int32_t k = 0; k < n; k++) v[k] = v3_scale(r, v3_unit(from[k]));
    /* A triple is a face if all vertices lie on one side of it. */
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < n; j++)
            for (int32_t k = 0; k < n; k++) {
                if (i > j || i > k || i == j || j == k || i == k) continue;
                const fl_vec3 m = v3_cross(v3_sub(v[j], v[i]), v3_sub(v[k], v[i]));
                int out = 0;
                for (int32_t l = 0; l < n; l++) out += v3_dot(m, v3_sub(v[l], v[i])) > 1e-9 * r * r * r;
                if (out || v3_dot(m, v[i]) < 1e-9 * r * r * r) continue;
                loop[3 * nf] = i;
                loop[3 * nf + 1] = j;
                loop[3 * nf + 2] = k;
                nf++;
                first[nf] = 3 * nf;
            }
    check_result(nf == faces ? 0 : -1, &err, "regular body");
    check_result(fl_poly_make(p, n, v, nf, first, loop, &err), &err, "regular body");
}
