/* SPDX-License-Identifier: GPL-3.0-or-later */
/* clocks.h -- clocks of this process [s]. */
#ifndef DEM_SOLVE_CLOCKS_H
#define DEM_SOLVE_CLOCKS_H
#include <time.h>

/* Monotonic wall clock. */
static inline double wall_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Processor time of all threads. */
static inline double cpu_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
