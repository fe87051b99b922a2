/* SPDX-License-Identifier: GPL-3.0-or-later */
/* simd.h -- SIMD registers of four doubles.
 *
 * The compiler splits fl_simd into the registers of the machine.  Every lane does IEEE 754 arithmetic by
 * itself, and -ffp-contract=off keeps products and sums apart, so the bits are the same for any width. */
#ifndef FL_BASE_SIMD_H
#define FL_BASE_SIMD_H
#include <stdint.h>
#include <stdlib.h>

#ifdef __CUDACC__ /* a thread of a card is one lane: functions by value, no registers of four */
#define FL_SIMD_INLINE static inline
#else

enum { FL_SIMD_WIDTH = 4 };

/* Alignment as for single doubles. */
typedef double fl_simd __attribute__((vector_size(FL_SIMD_WIDTH * sizeof(double)), aligned(8), may_alias));
typedef int64_t fl_simd_mask
    __attribute__((vector_size(FL_SIMD_WIDTH * sizeof(int64_t)), aligned(8), may_alias));

typedef double fl_simd2 __attribute__((vector_size(2 * sizeof(double)), aligned(8), may_alias));

/* A function compiled for several widths; the loader selects one for the machine. */
/* clang 14 does not export the name of such a function. */
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&    \
    !defined(__SANITIZE_THREAD__)
#if __GNUC__ < 12
#define FL_SIMD_VERSIONS __attribute__((target_clones("avx512f", "avx2", "default")))
#define FL_SIMD4_VERSIONS __attribute__((target_clones("avx2", "default"))) /* for code in four lanes */
#else /* mask registers, and twice as many vector registers */
#define FL_SIMD_VERSIONS __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#define FL_SIMD4_VERSIONS FL_SIMD_VERSIONS
#endif
#else
#define FL_SIMD_VERSIONS
#define FL_SIMD4_VERSIONS
#endif

/* Part of a function of several versions, compiled in each at its width. */
#define FL_SIMD_INLINE __attribute__((always_inline)) static inline

/* Four doubles from a on, to read or to write. */
#define FL_SIMD_LOAD(a) (*(const fl_simd *)(const void *)(a))
#define FL_SIMD_STORE(a) (*(fl_simd *)(void *)(a))

/* The same number in all lanes. */
#define FL_SIMD_SPLAT(x) ((fl_simd){(x), (x), (x), (x)})

/* Before a loop over lanes or a few registers, which then need not be in memory. */
#ifdef __clang__
#define FL_SIMD_UNROLL _Pragma("unroll")
#else
#define FL_SIMD_UNROLL _Pragma("GCC unroll 8")
#endif

/* By lanes: a where m, else 0; a where m, else b.  Macros, since a function with arguments in registers that
 * the machine may lack has no fixed calling convention. */
#define FL_SIMD_MASKED(m, a) ((fl_simd)((m) & (fl_simd_mask)(a)))
#define FL_SIMD_SELECT(m, a, b) ((fl_simd)(((m) & (fl_simd_mask)(a)) | (~(m) & (fl_simd_mask)(b))))

/* By lanes: maximum, minimum, absolute value; mask of the lanes below n. */
#define FL_SIMD_MAX(a, b) FL_SIMD_SELECT((a) > (b), a, b)
#define FL_SIMD_MIN(a, b) FL_SIMD_SELECT((a) < (b), a, b)
#define FL_SIMD_ABS(a) ((fl_simd)((fl_simd_mask)(a)&INT64_MAX))
#define FL_SIMD_MASK_BELOW(n) ((fl_simd_mask){0, 1, 2, 3} < (int64_t)(n))

/* True if any lane is set. */
FL_SIMD_INLINE int fl_simd_any(const fl_simd_mask *m) { return ((*m)[0] | (*m)[1] | (*m)[2] | (*m)[3]) != 0; }

/* Transposes four registers, the rows of a 4 x 4 matrix. */
FL_SIMD_INLINE void fl_simd_transpose(fl_simd r[FL_SIMD_WIDTH])
{
    const fl_simd a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6),
                  b = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7),
                  c = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6),
                  d = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
    r[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    r[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    r[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    r[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

/* Four consecutive vectors of three from a on: their x, y and z. */
FL_SIMD_INLINE void fl_simd_from_triples(fl_simd v[3], const void *a)
{
    const double *at = (const double *)a;
    const fl_simd p = FL_SIMD_LOAD(at), q = FL_SIMD_LOAD(at + 4), r = FL_SIMD_LOAD(at + 8);
    const fl_simd xy = __builtin_shufflevector(p, q, 0, 1, 6, 7),
                  zx = __builtin_shufflevector(p, r, 2, 3, 4, 5),
                  yz = __builtin_shufflevector(q, r, 0, 1, 6, 7);
    v[0] = __builtin_shufflevector(xy, zx, 0, 5, 2, 7);
    v[1] = __builtin_shufflevector(xy, yz, 1, 4, 3, 6);
    v[2] = __builtin_shufflevector(zx, yz, 0, 5, 2, 7);
}

/* The inverse. */
FL_SIMD_INLINE void fl_simd_to_triples(void *a, const fl_simd v[3])
{
    double *at = (double *)a;
    const fl_simd xy = __builtin_shufflevector(v[0], v[1], 0, 4, 2, 6),
                  zx = __builtin_shufflevector(v[2], v[0], 0, 5, 2, 7),
                  yz = __builtin_shufflevector(v[1], v[2], 1, 5, 3, 7);
    FL_SIMD_STORE(at) = __builtin_shufflevector(xy, zx, 0, 1, 4, 5);
    FL_SIMD_STORE(at + 4) = __builtin_shufflevector(yz, xy, 0, 1, 6, 7);
    FL_SIMD_STORE(at + 8) = __builtin_shufflevector(zx, yz, 2, 3, 6, 7);
}

/* Sum of the lanes: (0 + 2) + (1 + 3). */
FL_SIMD_INLINE double fl_simd_sum(const fl_simd *a)
{
    typedef double half
        __attribute__((vector_size(FL_SIMD_WIDTH / 2 * sizeof(double)), aligned(8), may_alias));
    const half sum = __builtin_shufflevector(*a, *a, 0, 1) + __builtin_shufflevector(*a, *a, 2, 3);
    return sum[0] + sum[1];
}

#endif
#endif
