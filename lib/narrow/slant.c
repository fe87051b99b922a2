/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/wide.h"
#include "narrow/rules.h"
#include "narrow/slant.h"

_Static_assert(FL_LONG_ROOM % FL_LANES == 0, "full registers");

FL_WIDE_VERSIONS void fl_slant_row_sum(const fl_slant_row *p, fl_slant_row_sums *out)
{
    const fl_wide zero = {0};
    const double h2 = p->h2, s0 = p->s0, nr = p->nr, c0 = p->c0, ck = p->ck, lo = p->lo, by = p->hi - p->lo;
    const double per = p->area * by;
    fl_wide u = zero, du = zero, ddu = zero, ds = zero, dy = zero, dyy = zero, dq = zero, dqy = zero,
            k0 = zero, kq = zero, kqy = zero, ky = zero, kyy = zero, kyyy = zero, most = zero;
    for (int at = 0; at < FL_LONG_ROOM; at += FL_LANES) {
        const fl_wide y = lo + by * FL_FOUR(FL_LONG_NODE + at), rho2 = h2 + y * y;
        fl_wide rho;
        for (int l = 0; l < FL_LANES; l++) rho[l] = sqrt(rho2[l]);
        const fl_wide q = FL_WIDE_WHERE(rho > 0.0, 1.0 / rho), way = s0 - nr * rho, cosine = c0 - ck * q;
        const fl_wide turn = 4.0 * cosine * cosine - 3.0;
        const fl_wide_mask in = (way > 0.0) & (cosine > 0.0) & (turn > 0.0);
        const fl_wide s = FL_WIDE_WHERE(in, way), s2 = s * s, area = per * FL_FOUR(FL_LONG_WEIGHT + at);
        const fl_wide m2 = area * turn * turn * s2, d = 4.0 * m2 * s,
                      k = area * 16.0 * cosine * turn * s2 * s2;
        const fl_wide d1 = d * y, dp = d * q, kp = k * q, k1 = kp * q * q * y, k2 = k1 * y;
        u += m2 * s2, du += d, ddu += 12.0 * m2, ds += d * s;
        dy += d1, dyy += d1 * y, dq += dp, dqy += dp * y;
        k0 += k, kq += kp, kqy += kp * y, ky += k1, kyy += k2, kyyy += k2 * y;
        most = FL_WIDE_CHOOSE(s > most, s, most);
    }
    *out = (fl_slant_row_sums){
        fl_wide_sum(&u),   fl_wide_sum(&du), fl_wide_sum(&ddu), fl_wide_sum(&ds),   fl_wide_sum(&dy),
        fl_wide_sum(&dyy), fl_wide_sum(&dq), fl_wide_sum(&dqy), fl_wide_sum(&k0),   fl_wide_sum(&kq),
        fl_wide_sum(&kqy), fl_wide_sum(&ky), fl_wide_sum(&kyy), fl_wide_sum(&kyyy), 0.0};
    for (int l = 0; l < FL_LANES; l++) out->most = most[l] > out->most ? most[l] : out->most;
}

FL_WIDE_VERSIONS void fl_slant_edge_sum(const fl_slant_edge *p, fl_slant_edge_sums *out)
{
    const fl_wide zero = {0};
    const double c1 = p->c[0], c2 = p->c[1], c3 = p->c[2], per = p->factor * p->width;
    fl_wide u = zero, du = zero, ddu = zero, ds = zero, dt = zero, dtt = zero, dq = zero, dqt = zero,
            dqtt = zero, most = zero;
    for (int at = 0; at < FL_LONG_ROOM; at += FL_LANES) {
        const fl_wide v = FL_FOUR(FL_LONG_NODE + at), slope = c1 + v * (2.0 * c2 + v * (3.0 * c3));
        const fl_wide t = p->from + p->width * (v * (c1 + v * (c2 + v * c3)));
        const fl_wide rho2 = p->a + t * (2.0 * p->b + t * p->g);
        fl_wide rho, root;
        for (int l = 0; l < FL_LANES; l++) rho[l] = sqrt(rho2[l]);
        const fl_wide way = p->s0 + p->s1 * t - p->nr * rho;
        const fl_wide s = FL_WIDE_WHERE(way > 0.0, way), r = t - p->middle;
        for (int l = 0; l < FL_LANES; l++) root[l] = sqrt(s[l]);
        const fl_wide g = per * FL_FOUR(FL_LONG_WEIGHT + at) * slope * (root * s * s), d = 4.5 * g * s;
        const fl_wide q = FL_WIDE_WHERE(rho > 0.0, d / rho);
        u += g * s * s, du += d, ddu += 15.75 * g, ds += d * s, dt += d * r, dtt += d * r * r;
        dq += q, dqt += q * r, dqtt += q * r * r;
        most = FL_WIDE_CHOOSE(s > most, s, most);
    }
    *out = (fl_slant_edge_sums){
        fl_wide_sum(&u),   fl_wide_sum(&du), fl_wide_sum(&ddu), fl_wide_sum(&ds),   fl_wide_sum(&dt),
        fl_wide_sum(&dtt), fl_wide_sum(&dq), fl_wide_sum(&dqt), fl_wide_sum(&dqtt), 0.0};
    for (int l = 0; l < FL_LANES; l++) out->most = most[l] > out->most ? most[l] : out->most;
}
