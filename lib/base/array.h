/* SPDX-License-Identifier: GPL-3.0-or-later */
/* array.h -- allocation and growing arrays, with errors reported.  All memory is freed with free(). */
#ifndef FL_BASE_ARRAY_H
#define FL_BASE_ARRAY_H
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/err.h"

/* Zeroed memory for n elements of the given size, aligned to 64 bytes.  n = 0 gives a valid pointer.
 * Returns NULL with FL_SYSTEM if memory runs out. */
void *fl_alloc(int64_t n, size_t size, fl_err *err);

/* A copy of a text.  NULL with FL_SYSTEM if memory runs out. */
char *fl_alloc_text(const char *text, fl_err *err);

/* Grows the array *(T **)array of capacity *cap to at least `want` elements.  The capacity at least doubles;
 * new elements are not initialised.  The array is untouched on failure.
 * Returns 0, or -1 with FL_SYSTEM. */
int fl_grow(void *array, int32_t *cap, int64_t want, size_t size, fl_err *err);

/* Same without a message, inlined for the common case that the array is large enough. */
int fl_grow_quiet(void *array, int32_t *cap, int64_t want, size_t size);
static inline int fl_reserve(void *array, int32_t *cap, int64_t want, size_t size)
{
    return want <= *cap ? 0 : fl_grow_quiet(array, cap, want, size);
}

/* For tests: the n-th allocation from now and all later ones fail; n < 0 switches this off. */
void fl_alloc_fail_after(long n);
/* Number of allocations refused since the last call of fl_alloc_fail_after(). */
long fl_alloc_refused(void);

/* Prefetches n bytes from a on.  The address may be invalid. */
static inline void fl_prefetch(const void *a, size_t n)
{
    enum { LINE = 64 };
    for (size_t at = 0; at < n; at += LINE) __builtin_prefetch((const char *)a + at);
}

#endif
