/* SPDX-License-Identifier: GPL-3.0-or-later */
/* par.h -- sums and hashes whose bits do not depend on the number of threads. */
#ifndef FL_BASE_PAR_H
#define FL_BASE_PAR_H
#include <stdint.h>

/* Sum of x[0 .. n): blocks of 1024 in ascending order, then the blocks in order. */
double fl_par_sum(const double *x, int64_t n);

/* 64-bit FNV-1a over bytes, eight at a time; start from FL_HASH_START and chain. */
#define FL_HASH_START UINT64_C(0xcbf29ce484222325)
uint64_t fl_hash(uint64_t h, const void *data, int64_t bytes);

#endif
