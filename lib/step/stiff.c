/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/wide.h"
#include "step/stiff.h"

typedef double rows[6][8];

FL_FOUR_VERSIONS static void add(rows a, double k, fl_vec3 f, fl_vec3 t)
{
    const double g[6] = {f.x, f.y, f.z, t.x, t.y, t.z};
    const fl_wide low = {f.x, f.y, f.z, t.x}, high = {t.y, t.z, 0.0, 0.0};
    for (int r = 0; r < 6; r++) {
        const double s = k * g[r];
        FL_FOUR_INTO(&a[r][0]) += s * low;
        FL_FOUR_INTO(&a[r][4]) += s * high;
    }
}

void fl_stiff_add(fl_stiff *s, const fl_bodies *b, int32_t i, double k, fl_vec3 f, fl_vec3 t)
{
    if (b->invm[i] == 0.0) return;
    const fl_vec3 u = m3_tmul(b->R[i], t), I = b->I[i];
    add(s->a, k, v3_scale(sqrt(b->invm[i]), f), v3(u.x / sqrt(I.x), u.y / sqrt(I.y), u.z / sqrt(I.z)));
}

void fl_stiff_across(fl_stiff *s, const fl_bodies *b, int32_t i, double k, fl_vec3 n, fl_vec3 r)
{
    const fl_vec3 e = v3_normal_to(n), d = v3_cross(n, e);
    fl_stiff_add(s, b, i, k, e, v3_cross(r, e));
    fl_stiff_add(s, b, i, k, d, v3_cross(r, d));
}

FL_WIDE_PART void square(rows out, const double (*a)[8])
{
    for (int r = 0; r < 6; r++) {
        fl_wide low = {0.0, 0.0, 0.0, 0.0}, high = low;
        for (int k = 0; k < 6; k++) {
            low += a[r][k] * FL_FOUR(&a[k][0]);
            high += a[r][k] * FL_FOUR(&a[k][4]);
        }
        FL_FOUR_INTO(&out[r][0]) = low;
        FL_FOUR_INTO(&out[r][4]) = high;
    }
}

/* Frobenius' norm of the fourth power of a over size, which must not leave the range. */
FL_FOUR_VERSIONS static double norm4(const double (*a)[8], double size)
{
    rows one, two, four;
    double sum = 0.0;
    for (int r = 0; r < 6; r++) {
        FL_FOUR_INTO(&one[r][0]) = FL_FOUR(&a[r][0]) / size;
        FL_FOUR_INTO(&one[r][4]) = FL_FOUR(&a[r][4]) / size;
    }
    square(two, (const double(*)[8])one);
    square(four, (const double(*)[8])two);
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++) sum += four[r][c] * four[r][c];
    return sqrt(sum);
}

double fl_stiff_bound(const fl_stiff *s)
{
    double size = 0.0;
    for (int r = 0; r < 6; r++) size = fmax(size, fabs(s->a[r][r]));
    return size > 0.0 ? size * sqrt(sqrt(norm4(s->a, size))) : 0.0;
}
