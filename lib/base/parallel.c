/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/parallel.h"

enum { BLOCK = 1024 };

/* Sums eight blocks side by side: a single sum would wait for each addition. */
static double sum_eight_blocks(const double *x, double total)
{
    double part[8] = {0};
    for (int64_t k = 0; k < BLOCK; k++)
#pragma GCC unroll 8
        for (int64_t b = 0; b < 8; b++) part[b] += x[b * BLOCK + k];
    for (int b = 0; b < 8; b++) total += part[b];
    return total;
}

double fl_parallel_sum(const double *x, int64_t n)
{
    double total = 0.0;
    int64_t at = 0;
    for (; at + 8 * BLOCK <= n; at += 8 * BLOCK) total = sum_eight_blocks(&x[at], total);
    for (int64_t b = at; b < n; b += BLOCK) {
        const int64_t end = b + BLOCK < n ? b + BLOCK : n;
        double part = 0.0;
#pragma GCC unroll 8
        for (int64_t k = b; k < end; k++) part += x[k];
        total += part;
    }
    return total;
}

void fl_parallel_limit_spin(char **argv)
{
    if (getenv("GOMP_SPINCOUNT") || getenv("OMP_WAIT_POLICY")) return;
    if (setenv("GOMP_SPINCOUNT", "500", 1) == 0) execv("/proc/self/exe", argv);
}

uint64_t fl_hash(uint64_t h, const void *data, int64_t bytes)
{
    const unsigned char *p = data;
    for (; bytes > 0; p += 8, bytes -= 8) {
        uint64_t word = 0;
        memcpy(&word, p, bytes < 8 ? (size_t)bytes : 8);
        h = (h ^ word) * UINT64_C(0x100000001b3);
        h ^= h >> 29; /* FNV mixes upward only; the shift carries high bits down */
    }
    return h;
}
