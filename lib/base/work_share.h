/* SPDX-License-Identifier: GPL-3.0-or-later */
/* work_share.h -- a loop that threads share out: each has a run of it, of which it takes blocks from the front,
 * and when that is used up, from the runs of others.  So those that have little to do, or a processor to
 * themselves, help the others out, and from one loop to the next most stays with the thread that has it in
 * its cache. */
#ifndef FL_BASE_WORK_SHARE_H
#define FL_BASE_WORK_SHARE_H
#include <stdint.h>

/* What is left of a run; a line of the cache for each. */
typedef struct {
    _Alignas(64) int32_t next;
    int32_t end;
} fl_work_share;

/* Before the threads begin: [0, n) in equal runs. */
static inline void fl_work_share_split(fl_work_share *s, int threads, int32_t n)
{
    for (int t = 0; t < threads; t++)
        s[t] =
            (fl_work_share){(int32_t)((int64_t)n * t / threads), (int32_t)((int64_t)n * (t + 1) / threads)};
}

/* The begin of a block of a run, which is then taken; there is none when it is not below s->end. */
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
