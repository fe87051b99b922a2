/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_step.c -- what a step costs, beside what it is worth: a frictionless elastic gas of square floes
 * between walls, by law and by fraction of the critical step.  Energy must stay, so its drift is the error.
 * Times are of this machine now; compare rows of one run only. */
#include <time.h>
#include "support/lab.h"

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* One row; 1 when the run came to its end and, for a law that has a potential, kept its energy. */
static int row(const char *law, int potential, double safety)
{
    lab l;
    lab_gas(&l, law, safety);
    const double begun = now(), energy = lab_energy(&l);
    const int64_t steps = (int64_t)(4.0 / l.w.dt);
    const int ended = lab_run(&l, steps) == 0;
    const double drift = lab_energy(&l) / energy - 1.0;
    const double spent = now() - begun, touches = (double)l.w.touching_steps;
    printf("%-10s %8.3f %10.3g %12.0f %15.0f %15.2g %14.3g %12.2g\n", law, safety, l.w.dt,
           1e9 * spent / (double)steps / l.w.n, touches > 0 ? 1e9 * spent / touches : 0.0,
           (double)l.w.touching_steps / (double)steps, drift, l.w.worst_overlap);
    lab_free(&l);
    return ended && isfinite(drift) && (!potential || fabs(drift) < 1e-3);
}

int main(void)
{
    static const double SAFETY[] = {0.4, 0.2, 0.1, 0.05};
    static const char *const LAW[] = {"patch", "core", "manual-si", "manual"};
    printf("gas of 196 floes, elastic, no friction, 4 s, one thread\n");
    printf("%-10s %8s %10s %12s %15s %15s %14s %12s\n", "law", "safety", "dt[s]", "ns/body-step",
           "ns/contact-step", "contacts", "energy drift", "overlap/2R");
    int good = 0, bad = 0;
    for (size_t k = 0; k < 4; k++) {
        for (size_t s = 0; s < 4; s++) {
            if (row(LAW[k], k < 2, SAFETY[s])) good++;
            else bad++;
        }
    }
    printf("%d passed, %d failed\n", good, bad);
    return bad > 0;
}
