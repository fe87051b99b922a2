/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _DEFAULT_SOURCE /* madvise */
#include <string.h>
#include <sys/mman.h>
#include "base/array.h"

static long fail_after = -1, refusals;

void fl_alloc_fail_after(long n)
{
    fail_after = n;
    refusals = 0;
}

long fl_alloc_refused(void) { return refusals; }

static int refuse_allocation(void)
{
    if (fail_after < 0) return 0;
    if (fail_after > 0) {
        fail_after--;
        return 0;
    }
    refusals++;
    return 1;
}

/* Blocks as large as several huge pages are placed in huge pages where the system has them.  With 100 000
 * spheres the neighbour search then takes a third less time; a step takes the same.  Blocks are not aligned
 * to huge pages: arrays that are traversed together would compete for the same cache lines. */
enum { PAGE = 4096, LARGE = 2 * (1 << 21) };

static void *allocate_aligned(size_t bytes)
{
    char *const p = aligned_alloc(64, bytes);
#ifdef MADV_HUGEPAGE
    if (p && bytes >= LARGE) {
        char *const from = p + (PAGE - (uintptr_t)p % PAGE) % PAGE;
        (void)madvise(from, (size_t)(p + bytes - from) / PAGE * PAGE, MADV_HUGEPAGE); /* advice only */
    }
#endif
    return p;
}

void *fl_alloc(int64_t n, size_t size, fl_err *err)
{
    size_t bytes;
    void *p = NULL;
    if (n < 0 || __builtin_mul_overflow((size_t)n, size, &bytes) || bytes > SIZE_MAX - 64) {
        fl_fail(err, FL_SYSTEM, "out of memory: %lld elements of %zu bytes", (long long)n, size);
        return NULL;
    }
    bytes = (bytes + 63) / 64 * 64 + (bytes == 0 ? 64 : 0);
    if (!refuse_allocation()) p = allocate_aligned(bytes);
    if (p) memset(p, 0, bytes);
    else fl_fail(err, FL_SYSTEM, "out of memory: %zu bytes", bytes);
    return p;
}

char *fl_alloc_text(const char *text, fl_err *err)
{
    const size_t bytes = strlen(text) + 1;
    char *copy = fl_alloc((int64_t)bytes, 1, err);
    return copy ? memcpy(copy, text, bytes) : NULL;
}

int fl_grow(void *array, int32_t *cap, int64_t want, size_t size, fl_err *err)
{
    void *old, *fresh;
    int64_t n = *cap;
    size_t bytes;
    if (want <= n) return 0;
    n = n < 8 ? 8 : 2 * n;
    if (n < want) n = want;
    if (n > INT32_MAX || __builtin_mul_overflow((size_t)n, size, &bytes))
        return fl_fail(err, FL_SYSTEM, "out of memory: %lld elements of %zu bytes", (long long)n, size);
    memcpy(&old, array, sizeof old); /* array is the address of a T *, for any T */
    fresh = refuse_allocation() ? NULL : realloc(old, bytes);
    if (!fresh) return fl_fail(err, FL_SYSTEM, "out of memory: %zu bytes", bytes);
    memcpy(array, &fresh, sizeof fresh);
    *cap = (int32_t)n;
    return 0;
}

int fl_grow_quiet(void *array, int32_t *cap, int64_t want, size_t size)
{
    fl_err lost = {0};
    return fl_grow(array, cap, want, size, &lost);
}
