/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/simd.h"
#include "patch/stiffness_bound.h"

typedef double rows6[6][8];

FL_SIMD4_VERSIONS static void add_outer_product(rows6 a, double k, fl_vec3 f, fl_vec3 t)
{
    const double g[6] = {f.x, f.y, f.z, t.x, t.y, t.z};
    const fl_simd low = {f.x, f.y, f.z, t.x}, high = {t.y, t.z, 0.0, 0.0};
    for (int r = 0; r < 6; r++) {
        const double s = k * g[r];
        FL_SIMD_STORE(&a[r][0]) += s * low;
        FL_SIMD_STORE(&a[r][4]) += s * high;
    }
}

void fl_stiffness_add_force(fl_stiffness *s, const fl_bodies *b, int32_t i, double k, fl_vec3 f, fl_vec3 t)
{
    if (b->invm[i] == 0.0) return;
    const fl_vec3 u = m3_tmul(fl_body_axes(b, i), t), I = b->I[i];
    add_outer_product(s->a, k, v3_scale(sqrt(b->invm[i]), f),
                      v3(u.x / sqrt(I.x), u.y / sqrt(I.y), u.z / sqrt(I.z)));
}

typedef double square3[3][4]; /* rows; the last number is 0 */

/* out = x y + more; out is neither of them. */
FL_SIMD_INLINE void multiply_add(square3 out, const double (*x)[4], const double (*y)[4],
                                 const double (*more)[4])
{
    FL_SIMD_UNROLL
    for (int r = 0; r < 3; r++) {
        fl_simd row =
            x[r][0] * FL_SIMD_LOAD(y[0]) + x[r][1] * FL_SIMD_LOAD(y[1]) + x[r][2] * FL_SIMD_LOAD(y[2]);
        if (more) row += FL_SIMD_LOAD(more[r]);
        FL_SIMD_STORE(out[r]) = row;
    }
}

FL_SIMD_INLINE void transpose3(square3 out, const double (*x)[4])
{
    fl_simd r[4] = {FL_SIMD_LOAD(x[0]), FL_SIMD_LOAD(x[1]), FL_SIMD_LOAD(x[2]), {0}};
    fl_simd_transpose(r);
    for (int k = 0; k < 3; k++) FL_SIMD_STORE(out[k]) = r[k];
}

/* Adds springs.  The torque of a spring about the centre of the body is t = r x n + a x n = r x n + A n.  Mt:
 * M^-1/2 of the torques, from the axes of the springs to those of the body. */
FL_SIMD4_VERSIONS static void add_springs(rows6 K, double scale, double light, const fl_spring_sums *q,
                                          const square3 A, const square3 Rt, const square3 Mt)
{
    square3 At, M, R, D, Dt, E, one, two;
    transpose3(At, A);
    transpose3(M, Mt);
    transpose3(R, Rt);
    multiply_add(D, A, q->linear, q->coupling); /* sum of k t n^T */
    transpose3(Dt, (const double(*)[4])D);
    multiply_add(one, q->coupling, (const double(*)[4])At, q->angular);
    multiply_add(E, A, (const double(*)[4])Dt, (const double(*)[4])one); /* sum of k t t^T */
    multiply_add(one, (const double(*)[4])M, (const double(*)[4])E, NULL);
    multiply_add(E, (const double(*)[4])one, Mt, NULL);
    multiply_add(one, (const double(*)[4])M, (const double(*)[4])D, NULL);
    multiply_add(D, (const double(*)[4])one, Rt, NULL);
    transpose3(Dt, (const double(*)[4])D);
    multiply_add(one, (const double(*)[4])R, q->linear, NULL);
    multiply_add(two, (const double(*)[4])one, Rt, NULL);
    const double mixing = scale * light, moving = mixing * light;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            K[r][c] += moving * two[r][c];
            K[r][3 + c] += mixing * Dt[r][c];
            K[3 + r][c] += mixing * D[r][c];
            K[3 + r][3 + c] += scale * E[r][c];
        }
}

void fl_stiffness_add_springs(fl_stiffness *s, const fl_bodies *b, int32_t i, double scale,
                              const fl_spring_sums *q, fl_mat3 R, fl_vec3 a)
{
    if (b->invm[i] == 0.0) return;
    const fl_vec3 I = b->I[i], o = m3_tmul(R, a);
    const double by[3] = {1.0 / sqrt(I.x), 1.0 / sqrt(I.y), 1.0 / sqrt(I.z)};
    const fl_mat3 own_axes = fl_body_axes(b, i);
    const square3 A = {{0.0, -o.z, o.y}, {o.z, 0.0, -o.x}, {-o.y, o.x, 0.0}};
    square3 Rt = {{0}}, own = {{0}}, Mt;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) Rt[r][c] = R.m[c][r], own[r][c] = own_axes.m[r][c] * by[c];
    multiply_add(Mt, (const double(*)[4])Rt, (const double(*)[4])own, NULL);
    add_springs(s->a, scale, sqrt(b->invm[i]), q, A, (const double(*)[4])Rt, (const double(*)[4])Mt);
}

void fl_stiffness_add_tangential(fl_stiffness *s, const fl_bodies *b, int32_t i, double k, fl_vec3 n,
                                 fl_vec3 r)
{
    const fl_vec3 e = v3_normal_to(n), d = v3_cross(n, e);
    fl_stiffness_add_force(s, b, i, k, e, v3_cross(r, e));
    fl_stiffness_add_force(s, b, i, k, d, v3_cross(r, d));
}

FL_SIMD_INLINE void square_matrix(rows6 out, const double (*a)[8])
{
    for (int r = 0; r < 6; r++) {
        fl_simd low = {0.0, 0.0, 0.0, 0.0}, high = low;
        for (int k = 0; k < 6; k++) {
            low += a[r][k] * FL_SIMD_LOAD(&a[k][0]);
            high += a[r][k] * FL_SIMD_LOAD(&a[k][4]);
        }
        FL_SIMD_STORE(&out[r][0]) = low;
        FL_SIMD_STORE(&out[r][4]) = high;
    }
}

/* Frobenius norm of (a / size)^4; the division keeps it in the range of a double. */
FL_SIMD4_VERSIONS static double norm_of_power4(const double (*a)[8], double size)
{
    rows6 one, two, four;
    double sum = 0.0;
    for (int r = 0; r < 6; r++) {
        FL_SIMD_STORE(&one[r][0]) = FL_SIMD_LOAD(&a[r][0]) / size;
        FL_SIMD_STORE(&one[r][4]) = FL_SIMD_LOAD(&a[r][4]) / size;
    }
    square_matrix(two, (const double(*)[8])one);
    square_matrix(four, (const double(*)[8])two);
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++) sum += four[r][c] * four[r][c];
    return sqrt(sum);
}

double fl_stiffness_bound(const fl_stiffness *s)
{
    double size = 0.0;
    for (int r = 0; r < 6; r++) size = fmax(size, fabs(s->a[r][r]));
    return size > 0.0 ? size * sqrt(sqrt(norm_of_power4(s->a, size))) : 0.0;
}
