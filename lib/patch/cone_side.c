/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/simd.h"
#include "geom/quadrature_rules.h"
#include "patch/cone_side.h"

_Static_assert(FL_LINE10_PADDED % FL_SIMD_WIDTH == 0, "full registers");

FL_SIMD_VERSIONS void fl_cone_side_sum_row(const fl_cone_side_row *p, fl_cone_side_row_sums *out)
{
    const fl_simd zero = {0};
    const double h2 = p->h2, s0 = p->s0, nr = p->nr, c0 = p->c0, ck = p->ck, lo = p->lo, by = p->hi - p->lo;
    const double per = p->area * by;
    fl_simd u = zero, du = zero, ddu = zero, ds = zero, dy = zero, dyy = zero, dq = zero, dqy = zero,
            k0 = zero, kq = zero, kqy = zero, ky = zero, kyy = zero, kyyy = zero, most = zero;
    for (int at = 0; at < FL_LINE10_PADDED; at += FL_SIMD_WIDTH) {
        const fl_simd y = lo + by * FL_SIMD_LOAD(FL_LINE10_NODE + at), rho2 = h2 + y * y;
        fl_simd rho;
        for (int l = 0; l < FL_SIMD_WIDTH; l++) rho[l] = sqrt(rho2[l]);
        const fl_simd q = FL_SIMD_MASKED(rho > 0.0, 1.0 / rho), way = s0 - nr * rho, cosine = c0 - ck * q;
        const fl_simd turn = 4.0 * cosine * cosine - 3.0;
        const fl_simd_mask in = (way > 0.0) & (cosine > 0.0) & (turn > 0.0);
        const fl_simd s = FL_SIMD_MASKED(in, way), s2 = s * s,
                      area = per * FL_SIMD_LOAD(FL_LINE10_WEIGHT + at);
        const fl_simd m2 = area * turn * turn * s2, d = 4.0 * m2 * s,
                      k = area * 16.0 * cosine * turn * s2 * s2;
        const fl_simd d1 = d * y, dp = d * q, kp = k * q, k1 = kp * q * q * y, k2 = k1 * y;
        u += m2 * s2, du += d, ddu += 12.0 * m2, ds += d * s;
        dy += d1, dyy += d1 * y, dq += dp, dqy += dp * y;
        k0 += k, kq += kp, kqy += kp * y, ky += k1, kyy += k2, kyyy += k2 * y;
        most = FL_SIMD_SELECT(s > most, s, most);
    }
    *out = (fl_cone_side_row_sums){
        fl_simd_sum(&u),   fl_simd_sum(&du), fl_simd_sum(&ddu), fl_simd_sum(&ds),   fl_simd_sum(&dy),
        fl_simd_sum(&dyy), fl_simd_sum(&dq), fl_simd_sum(&dqy), fl_simd_sum(&k0),   fl_simd_sum(&kq),
        fl_simd_sum(&kqy), fl_simd_sum(&ky), fl_simd_sum(&kyy), fl_simd_sum(&kyyy), 0.0};
    for (int l = 0; l < FL_SIMD_WIDTH; l++) out->most = most[l] > out->most ? most[l] : out->most;
}

FL_SIMD_VERSIONS void fl_cone_side_sum_edge(const fl_cone_side_edge *p, fl_cone_side_edge_sums *out)
{
    const fl_simd zero = {0};
    const double c1 = p->c[0], c2 = p->c[1], c3 = p->c[2], per = p->factor * p->width;
    fl_simd u = zero, du = zero, ddu = zero, ds = zero, dt = zero, dtt = zero, dq = zero, dqt = zero,
            dqtt = zero, most = zero;
    for (int at = 0; at < FL_LINE10_PADDED; at += FL_SIMD_WIDTH) {
        const fl_simd v = FL_SIMD_LOAD(FL_LINE10_NODE + at), slope = c1 + v * (2.0 * c2 + v * (3.0 * c3));
        const fl_simd t = p->from + p->width * (v * (c1 + v * (c2 + v * c3)));
        const fl_simd rho2 = p->a + t * (2.0 * p->b + t * p->g);
        fl_simd rho, root;
        for (int l = 0; l < FL_SIMD_WIDTH; l++) rho[l] = sqrt(rho2[l]);
        const fl_simd way = p->s0 + p->s1 * t - p->nr * rho;
        const fl_simd s = FL_SIMD_MASKED(way > 0.0, way), r = t - p->middle;
        for (int l = 0; l < FL_SIMD_WIDTH; l++) root[l] = sqrt(s[l]);
        const fl_simd g = per * FL_SIMD_LOAD(FL_LINE10_WEIGHT + at) * slope * (root * s * s), d = 4.5 * g * s;
        const fl_simd q = FL_SIMD_MASKED(rho > 0.0, d / rho);
        u += g * s * s, du += d, ddu += 15.75 * g, ds += d * s, dt += d * r, dtt += d * r * r;
        dq += q, dqt += q * r, dqtt += q * r * r;
        most = FL_SIMD_SELECT(s > most, s, most);
    }
    *out = (fl_cone_side_edge_sums){
        fl_simd_sum(&u),   fl_simd_sum(&du), fl_simd_sum(&ddu), fl_simd_sum(&ds),   fl_simd_sum(&dt),
        fl_simd_sum(&dtt), fl_simd_sum(&dq), fl_simd_sum(&dqt), fl_simd_sum(&dqtt), 0.0};
    for (int l = 0; l < FL_SIMD_WIDTH; l++) out->most = most[l] > out->most ? most[l] : out->most;
}
