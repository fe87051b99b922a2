/* SPDX-License-Identifier: GPL-3.0-or-later */
/* work_share.h -- loops with work stealing.  Each thread owns a range of the loop and takes
 * blocks from its front; when it is used up, it takes blocks from the ranges of others.  Threads with little
 * work help the others, and from loop to loop most elements stay with the thread that has them in its
 * cache. */
#ifndef FL_BASE_WORK_SHARE_H
#define FL_BASE_WORK_SHARE_H
#include <stdint.h>

/* The rest of a range, on a cache line of its own. */
typedef struct {
    _Alignas(64) int32_t next;
    int32_t end;
} fl_work_share;

/* Splits [0, n) into equal ranges.  Call before the threads start. */
static inline void fl_work_share_split(fl_work_share *s, int threads, int32_t n)
{
    for (int t = 0; t < threads; t++)
        s[t] =
            (fl_work_share){(int32_t)((int64_t)n * t / threads), (int32_t)((int64_t)n * (t + 1) / threads)};
}

/* Takes a block of a range and returns its start.  There is none if the start is not below s->end. */
static inline int32_t fl_work_share_take(fl_work_share *s, int32_t block)
{
    int32_t at;
#pragma omp atomic capture
    {
        at = s->next;
        s->next += block;
    }
    return at;
}

#endif
