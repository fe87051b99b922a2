/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/rng.h"

fl_rng fl_rng_of(uint64_t seed, int64_t entity, uint32_t purpose)
{
    const uint64_t e = (uint64_t)entity;
    return (fl_rng){.key = {(uint32_t)seed, (uint32_t)(seed >> 32)},
                    .ctr = {0, purpose, (uint32_t)e, (uint32_t)(e >> 32)}};
}

static void next_block(fl_rng *g)
{
    uint32_t c[4] = {g->ctr[0], g->ctr[1], g->ctr[2], g->ctr[3]}, k0 = g->key[0], k1 = g->key[1];
    for (int round = 0; round < 10; round++) {
        const uint64_t p0 = (uint64_t)0xD2511F53u * c[0], p1 = (uint64_t)0xCD9E8D57u * c[2];
        const uint32_t t1 = c[1], t3 = c[3];
        c[0] = (uint32_t)(p1 >> 32) ^ t1 ^ k0;
        c[1] = (uint32_t)p1;
        c[2] = (uint32_t)(p0 >> 32) ^ t3 ^ k1;
        c[3] = (uint32_t)p0;
        k0 += 0x9E3779B9u;
        k1 += 0xBB67AE85u;
    }
    for (int k = 0; k < 4; k++) g->out[k] = c[k];
    g->ctr[0]++;
    g->left = 4;
}

static uint32_t next_word(fl_rng *g)
{
    if (g->left == 0) next_block(g);
    return g->out[4 - g->left--];
}

uint64_t fl_rng_u64(fl_rng *g)
{
    const uint64_t hi = next_word(g);
    return hi << 32 | next_word(g);
}

double fl_rng_unit(fl_rng *g) { return (double)(fl_rng_u64(g) >> 11) * 0x1p-53; }

double fl_rng_in(fl_rng *g, double lo, double hi) { return lo + (hi - lo) * fl_rng_unit(g); }

double fl_rng_normal(fl_rng *g)
{
    double x, y, s;
    do {
        x = fl_rng_in(g, -1.0, 1.0);
        y = fl_rng_in(g, -1.0, 1.0);
        s = x * x + y * y;
    } while (s >= 1.0 || s == 0.0);
    return x * sqrt(-2.0 * log(s) / s);
}
