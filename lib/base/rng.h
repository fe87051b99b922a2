/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rng.h -- counter-based random numbers: a function of (seed, entity, purpose).  The order of use is free,
 * and a further entity does not change the numbers of the others.
 * Source: Philox4x32-10, Salmon, Moraes, Dror & Shaw, SC11 (2011). */
#ifndef FL_BASE_RNG_H
#define FL_BASE_RNG_H
#include <stdint.h>

enum fl_rng_purpose {
    FL_RNG_TEST,
    FL_RNG_SITE,
    FL_RNG_SIZE,
    FL_RNG_THICKNESS,
    FL_RNG_VELOCITY,
    FL_RNG_WAVE,
    FL_RNG_BOOTSTRAP,
    FL_RNG_LAYER,
    FL_RNG_OFFSET,
    FL_RNG_STRENGTH,
    FL_RNG_WAVE_DIRECTION,
    FL_RNG_SCATTER,
    FL_RNG_ORIENTATION,
    FL_RNG_STRIP_GAP,
    FL_RNG_STRIP_STRENGTH,
    FL_RNG_JOINT_PLANE,
    FL_RNG_PERSISTENCE,
    FL_RNG_GAP
};

typedef struct {
    uint32_t key[2], ctr[4], out[4];
    int left; /* unused words of out */
} fl_rng;

/* The entity of two ids. */
static inline int64_t fl_rng_entity(int32_t i, int32_t j)
{
    return (int64_t)((uint64_t)(uint32_t)i << 32 | (uint32_t)j);
}

/* The entity of four ids: a hash, so that two sets share one with a chance of 2^-64 a pair (SplitMix64). */
static inline int64_t fl_rng_entity4(int32_t i, int32_t j, int32_t k, int32_t l)
{
    uint64_t x = (uint64_t)fl_rng_entity(i, j) + UINT64_C(0x9e3779b97f4a7c15);
    for (int pass = 0; pass < 2; pass++) {
        x = (x ^ x >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
        x = (x ^ x >> 27) * UINT64_C(0x94d049bb133111eb);
        x ^= x >> 31;
        if (pass == 0) x += (uint64_t)fl_rng_entity(k, l);
    }
    return (int64_t)x;
}

fl_rng fl_rng_of(uint64_t seed, int64_t entity, uint32_t purpose);
uint64_t fl_rng_u64(fl_rng *g);
double fl_rng_unit(fl_rng *g);                     /* uniform in [0, 1), a multiple of 2^-53 */
double fl_rng_in(fl_rng *g, double lo, double hi); /* uniform in [lo, hi) */
double fl_rng_normal(fl_rng *g);                   /* mean 0, standard deviation 1; polar method */

#endif
