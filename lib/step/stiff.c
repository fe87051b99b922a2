/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "step/stiff.h"

void fl_stiff_add(fl_stiff *s, const fl_bodies *b, int32_t i, double k, fl_vec3 f, fl_vec3 t)
{
    if (b->invm[i] == 0.0) return;
    const double root = sqrt(b->invm[i]);
    const fl_vec3 u = m3_tmul(b->R[i], t), I = b->I[i];
    const double g[6] = {root * f.x,      root * f.y,      root * f.z,
                         u.x / sqrt(I.x), u.y / sqrt(I.y), u.z / sqrt(I.z)};
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++) s->a[r][c] += k * g[r] * g[c];
}

void fl_stiff_across(fl_stiff *s, const fl_bodies *b, int32_t i, double k, fl_vec3 n, fl_vec3 r)
{
    const fl_vec3 e = v3_normal_to(n), d = v3_cross(n, e);
    fl_stiff_add(s, b, i, k, e, v3_cross(r, e));
    fl_stiff_add(s, b, i, k, d, v3_cross(r, d));
}

static double squared(double a[6][6], double out[6][6])
{
    double sum = 0.0;
    for (int r = 0; r < 6; r++) {
        for (int c = 0; c < 6; c++) {
            double x = 0.0;
            for (int k = 0; k < 6; k++) x += a[r][k] * a[k][c];
            out[r][c] = x;
            sum += x * x;
        }
    }
    return sqrt(sum);
}

double fl_stiff_bound(const fl_stiff *s)
{
    double size = 0.0, a[6][6], a2[6][6], a4[6][6];
    for (int r = 0; r < 6; r++) size = fmax(size, fabs(s->a[r][r]));
    if (!(size > 0.0)) return 0.0;
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++)
            a[r][c] = s->a[r][c] / size; /* its fourth power must not leave the range */
    squared(a, a2);
    return size * sqrt(sqrt(squared(a2, a4)));
}
