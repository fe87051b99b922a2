/* SPDX-License-Identifier: GPL-3.0-or-later */
/* wide.h -- four doubles at a time.
 *
 * The compiler splits fl_wide into what the machine has.  Every lane does the arithmetic of IEEE 754 by
 * itself and -ffp-contract=off keeps products and sums apart, so that the bits are the same for any width. */
#ifndef FL_BASE_WIDE_H
#define FL_BASE_WIDE_H
#include <stdint.h>
#include <stdlib.h>

enum { FL_LANES = 4 };

/* Wherever doubles lie. */
typedef double fl_wide __attribute__((vector_size(FL_LANES * sizeof(double)), aligned(8), may_alias));
typedef int64_t fl_wide_mask __attribute__((vector_size(FL_LANES * sizeof(int64_t)), aligned(8), may_alias));

/* A function compiled for several widths, of which the loader takes the one that fits the machine. */
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) &&                           \
    !defined(__SANITIZE_THREAD__)
#define FL_WIDE_VERSIONS __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define FL_WIDE_VERSIONS
#endif

/* By lanes: a where m, else 0;  a where m, else b.  Macros, since a function that takes a register which the
 * machine may lack has no fixed calling convention. */
#define FL_WIDE_WHERE(m, a) ((fl_wide)((m) & (fl_wide_mask)(a)))
#define FL_WIDE_CHOOSE(m, a, b) ((fl_wide)(((m) & (fl_wide_mask)(a)) | (~(m) & (fl_wide_mask)(b))))

/* Sum of the lanes, in their order. */
static inline double fl_wide_sum(const fl_wide *a)
{
    double sum = 0.0;
    for (int k = 0; k < FL_LANES; k++) sum += (*a)[k];
    return sum;
}

#endif
