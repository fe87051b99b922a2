/* SPDX-License-Identifier: GPL-3.0-or-later */
/* parallel.h -- sums and hashes whose bits do not depend on the number of threads. */
#ifndef FL_BASE_PARALLEL_H
#define FL_BASE_PARALLEL_H
#include <stdint.h>

/* Sum of x[0 .. n): blocks of 1024 in ascending order, then the block sums in order. */
double fl_parallel_sum(const double *x, int64_t n);

/* Limits the time that threads spin at the end of a parallel loop to a few microseconds.  GNU OpenMP spins
 * for milliseconds, which makes two threads tens of times slower than one on a busy machine (200 bodies, four
 * other busy processes: 14.4 s against 0.35 s).  The OpenMP library reads its environment before main(), so
 * the program restarts itself with GOMP_SPINCOUNT set.  Nothing happens if GOMP_SPINCOUNT or OMP_WAIT_POLICY
 * is set, or if the restart fails.  Call first in main(). */
void fl_parallel_limit_spin(char **argv);

/* 64-bit FNV-1a over bytes, eight at a time.  Start from FL_HASH_START and chain. */
#define FL_HASH_START UINT64_C(0xcbf29ce484222325)
uint64_t fl_hash(uint64_t h, const void *data, int64_t bytes);

#endif
