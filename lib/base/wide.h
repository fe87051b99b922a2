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

typedef double fl_two __attribute__((vector_size(2 * sizeof(double)), aligned(8), may_alias));

/* A function compiled for several widths, of which the loader takes the one that fits the machine. */
/* clang 14 leaves such a function without its name to the linker. */
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&    \
    !defined(__SANITIZE_THREAD__)
#if __GNUC__ < 12
#define FL_WIDE_VERSIONS __attribute__((target_clones("avx512f", "avx2", "default")))
#define FL_FOUR_VERSIONS __attribute__((target_clones("avx2", "default"))) /* where fl_wide is the width */
#else /* registers of masks, and twice as many of four numbers */
#define FL_WIDE_VERSIONS __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#define FL_FOUR_VERSIONS FL_WIDE_VERSIONS
#endif
#else
#define FL_WIDE_VERSIONS
#define FL_FOUR_VERSIONS
#endif

/* Part of a function of several versions, in each as wide as that is. */
#define FL_WIDE_PART __attribute__((always_inline)) static inline

/* Four doubles from a on, to read or to write. */
#define FL_FOUR(a) (*(const fl_wide *)(const void *)(a))
#define FL_FOUR_INTO(a) (*(fl_wide *)(void *)(a))

/* The same number in all lanes. */
#define FL_WIDE_ALL(x) ((fl_wide){(x), (x), (x), (x)})

/* Before a loop over lanes, or over a few registers, which then need not lie in memory. */
#ifdef __clang__
#define FL_WIDE_UNROLL _Pragma("unroll")
#else
#define FL_WIDE_UNROLL _Pragma("GCC unroll 8")
#endif

/* By lanes: a where m, else 0;  a where m, else b.  Macros, since a function that takes a register which the
 * machine may lack has no fixed calling convention. */
#define FL_WIDE_WHERE(m, a) ((fl_wide)((m) & (fl_wide_mask)(a)))
#define FL_WIDE_CHOOSE(m, a, b) ((fl_wide)(((m) & (fl_wide_mask)(a)) | (~(m) & (fl_wide_mask)(b))))

/* By lanes: the larger, the smaller, the size; and the lanes that are before n. */
#define FL_WIDE_LARGER(a, b) FL_WIDE_CHOOSE((a) > (b), a, b)
#define FL_WIDE_SMALLER(a, b) FL_WIDE_CHOOSE((a) < (b), a, b)
#define FL_WIDE_SIZE(a) ((fl_wide)((fl_wide_mask)(a)&INT64_MAX))
#define FL_WIDE_BEFORE(n) ((fl_wide_mask){0, 1, 2, 3} < (int64_t)(n))

/* Whether any lane is set. */
FL_WIDE_PART int fl_wide_any(const fl_wide_mask *m) { return ((*m)[0] | (*m)[1] | (*m)[2] | (*m)[3]) != 0; }

/* Four registers that are the rows of a matrix become its columns. */
FL_WIDE_PART void fl_wide_transpose(fl_wide r[FL_LANES])
{
    const fl_wide a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6),
                  b = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7),
                  c = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6),
                  d = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
    r[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    r[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    r[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    r[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

/* Four vectors of three that follow each other from a on: their x, y and z. */
FL_WIDE_PART void fl_wide_from_triples(fl_wide v[3], const void *a)
{
    const double *at = (const double *)a;
    const fl_wide p = FL_FOUR(at), q = FL_FOUR(at + 4), r = FL_FOUR(at + 8);
    const fl_wide xy = __builtin_shufflevector(p, q, 0, 1, 6, 7),
                  zx = __builtin_shufflevector(p, r, 2, 3, 4, 5),
                  yz = __builtin_shufflevector(q, r, 0, 1, 6, 7);
    v[0] = __builtin_shufflevector(xy, zx, 0, 5, 2, 7);
    v[1] = __builtin_shufflevector(xy, yz, 1, 4, 3, 6);
    v[2] = __builtin_shufflevector(zx, yz, 0, 5, 2, 7);
}

/* And back. */
FL_WIDE_PART void fl_wide_to_triples(void *a, const fl_wide v[3])
{
    double *at = (double *)a;
    const fl_wide xy = __builtin_shufflevector(v[0], v[1], 0, 4, 2, 6),
                  zx = __builtin_shufflevector(v[2], v[0], 0, 5, 2, 7),
                  yz = __builtin_shufflevector(v[1], v[2], 1, 5, 3, 7);
    FL_FOUR_INTO(at) = __builtin_shufflevector(xy, zx, 0, 1, 4, 5);
    FL_FOUR_INTO(at + 4) = __builtin_shufflevector(yz, xy, 0, 1, 6, 7);
    FL_FOUR_INTO(at + 8) = __builtin_shufflevector(zx, yz, 2, 3, 6, 7);
}

/* Sum of the lanes: (0 + 2) + (1 + 3). */
FL_WIDE_PART double fl_wide_sum(const fl_wide *a)
{
    typedef double half __attribute__((vector_size(FL_LANES / 2 * sizeof(double)), aligned(8), may_alias));
    const half sum = __builtin_shufflevector(*a, *a, 0, 1) + __builtin_shufflevector(*a, *a, 2, 3);
    return sum[0] + sum[1];
}

#endif
