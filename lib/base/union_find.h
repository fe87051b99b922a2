/* SPDX-License-Identifier: GPL-3.0-or-later */
/* union_find.h -- disjoint sets of 0 .. n - 1.  The root of a set is its lowest element. */
#ifndef FL_BASE_UNION_FIND_H
#define FL_BASE_UNION_FIND_H
#include "base/array.h"

/* Makes n sets of one element.  Returns the parents up[n], or NULL with FL_SYSTEM. */
static inline int32_t *fl_union_find_make(int64_t n, fl_err *err)
{
    int32_t *up = fl_alloc(n, sizeof *up, err);
    for (int64_t k = 0; up && k < n; k++) up[k] = (int32_t)k;
    return up;
}

static inline int32_t fl_union_find_root(int32_t *up, int32_t k)
{
    while (up[k] != k) k = up[k] = up[up[k]];
    return k;
}

static inline void fl_union_find_join(int32_t *up, int32_t a, int32_t b)
{
    a = fl_union_find_root(up, a), b = fl_union_find_root(up, b);
    if (a < b) up[b] = a;
    else up[a] = b;
}

#endif
