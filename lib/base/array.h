/* SPDX-License-Identifier: GPL-3.0-or-later */
/* array.h -- arrays that may fail to grow.  Everything returned is freed with free(). */
#ifndef FL_BASE_ARRAY_H
#define FL_BASE_ARRAY_H
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/err.h"

/* Zeroed memory for n elements of the given size, aligned to 64 bytes.  n = 0 gives a valid pointer.
 * Returns NULL with FL_SYSTEM in err when there is none. */
void *fl_alloc(int64_t n, size_t size, fl_err *err);

/* A copy of a text.  NULL with FL_SYSTEM in err when there is no memory. */
char *fl_alloc_text(const char *text, fl_err *err);

/* Make room for at least want elements in the array *(T **)array of capacity *cap; the capacity at
 * least doubles, new elements are not initialised.  The array is untouched on failure.
 * Returns 0, or -1 with FL_SYSTEM in err. */
int fl_grow(void *array, int32_t *cap, int64_t want, size_t size, fl_err *err);

/* The same without a sentence, for what is asked again and again and mostly has room. */
int fl_grow_quiet(void *array, int32_t *cap, int64_t want, size_t size);
static inline int fl_reserve(void *array, int32_t *cap, int64_t want, size_t size)
{
    return want <= *cap ? 0 : fl_grow_quiet(array, cap, want, size);
}

/* For tests: let the n-th allocation from now, and all after it, fail; n < 0 switches this off. */
void fl_alloc_fail_after(long n);
/* How many allocations failed that way since the last call of it. */
long fl_alloc_refused(void);

/* Send for n bytes from a on, which may as well not be there: they are on their way while other things are
 * done. */
static inline void fl_prefetch(const void *a, size_t n)
{
    enum { LINE = 64 };
    for (size_t at = 0; at < n; at += LINE) __builtin_prefetch((const char *)a + at);
}

#endif
