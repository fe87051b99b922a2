/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_memory.c -- memory of a floe with its pairs, by kind, while a field of floes at 80 % is stirred
 * until they touch everywhere: dry, and in water.  "allocated" is the total of the allocator, so nothing is
 * left out; the input is not included.  Further columns: pairs and contacts per floe, the largest overlap,
 * and a hash of the final state.  `search+` is the additional memory during a search.  Fails if a floe with
 * its pairs takes more than 2 048 bytes.
 *
 *     bench_memory [FLOES]     default 2000 */
#include <malloc.h>
#include <stdlib.h>
#include "sim/energy_balance.h"
#include "sim/memory_use.h"
#include "support/stirring_flow.h"
#include "world/access.h"

#define STIRRED 1.0 /* [m/s] */
#define END 1.0     /* [s] */
#define MOST 2048.0 /* largest allowed number of bytes of a floe with its pairs, at any time */

enum { SAMPLES = 4 };

static double memory(void)
{
    const struct mallinfo2 m = mallinfo2();
    return (double)m.uordblks + (double)m.hblkhd;
}

static int print_row(int32_t n, int water)
{
    lab l;
    stirring_flow_start(&l, n, STIRRED);
    if (water) lab_set(&l, "run.gravity=9.81"), lab_set(&l, "water.current=0.5 0 0");
    const double before = memory();
    lab_make(&l, 0.0);
    int bad = 0;
    for (int k = 0; k <= SAMPLES && !bad; k++) {
        const int64_t to = (int64_t)(END * k / SAMPLES / l.w.dt), touched = l.w.contact_steps;
        const int64_t steps = to - l.w.step;
        bad = lab_run(&l, steps);
        const fl_memory_use b = fl_memory_use_of(&l.w);
        const double all = memory() - before, sum = fl_memory_use_sum(&b);
        printf("%-6s %6d %6.2f %7.0f %7.0f %7.0f %7.0f %7.0f %7.0f %7.0f %10.0f %7.0f %6.2f %8.2f %9.1e "
               "%016llx\n",
               water ? "water" : "dry", n, fl_world_time(&l.w), b.bodies / n, b.shapes / n, b.water / n,
               b.search / n, b.pairs / n, b.feature_pairs / n, sum / n, all / n, b.search_peak / n,
               (double)l.w.n_pair / n,
               steps ? (double)(l.w.contact_steps - touched) / (double)steps / n : 0.0, l.w.max_overlap,
               (unsigned long long)fl_state_hash(&l.w));
        bad |= sum > MOST * n;
        bad |= !(all > 0.98 * sum && all < 1.25 * sum); /* small free blocks were counted before */
    }
    lab_free(&l);
    return bad;
}

int main(int argc, char **argv)
{
    const int32_t n = argc > 1 ? atoi(argv[1]) : 2000;
    int good = 0, bad = 0;
    if (n < 100) return 1;
    setvbuf(stdout, NULL, _IOLBF, 0);
    printf("bytes per floe: arrays of bodies, cores, water, search, near pairs, feature pairs\n");
    printf("%-6s %6s %6s %7s %7s %7s %7s %7s %7s %7s %10s %7s %6s %8s %9s\n", "", "floes", "t[s]", "bodies",
           "shapes", "water", "search", "pairs", "lists", "all", "allocated", "search+", "near", "touching",
           "overlap/2R");
    for (int water = 0; water < 2; water++) {
        if (print_row(n, water)) bad++;
        else good++;
    }
    printf("%d passed, %d failed\n", good, bad);
    return bad > 0;
}
