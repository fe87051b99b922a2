/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_waves.c -- cost of the waves on a floe beside the error of the force: water.wave_error against the
 * evaluation in each step, for seas of different periods and numbers of trains; one thread, tables included.
 *
 *     bench_waves [FLOES [STEPS]]     10 000 floes of 6 to 20 m by 0.8 m, 300 steps of 5 ms
 *
 * us: processor time of a floe-step in all, without contacts; "each step" is measured on 64 of the floes.
 * error: rms over 64 floes of the difference of the two forces at the same pose, over rho g A Hs/4. ledger:
 * residual over the throughput. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "base/pi.h"
#include "base/rng.h"
#include "sim/energy_balance.h"
#include "support/small_world.h"

#define G 9.81

static double processor_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

typedef struct {
    double Hs, Tp;
    int trains;
    const char *error, *more;
} sea_case;

enum { SAMPLE = 64 };

/* Floes on a square grid, apart. */
static void make_sea(lab *l, const sea_case *c, const char *error, int32_t n, double level)
{
    const int32_t side = (int32_t)ceil(sqrt(n));
    lab_start(l);
    lab_set(l, "run.gravity=9.81");
    if (c->trains) {
        lab_set(l, "water.wave=jonswap");
        lab_setf(l, "water.components=%d", c->trains);
        lab_setf(l, "water.height=%g", c->Hs);
        lab_setf(l, "water.period=%g", c->Tp);
        lab_setf(l, "water.wave_error=%s", error);
        if (c->more) lab_set(l, c->more);
    } else lab_setf(l, "water.level=%g", level);
    for (int32_t k = 0; k < n; k++) {
        fl_rng g = fl_rng_of(7, k, FL_RNG_TEST);
        const double a = 0.5 * fl_rng_in(&g, 6, 20), b = a * fl_rng_in(&g, 0.6, 1.0);
        lab_box(l, v3(28.0 * (k % side), 28.0 * (k / side), 0.4 - 0.8 * 900 / 1025), v3(a, b, 0.4), 0.1,
                q_about_axis(2, fl_rng_in(&g, 0, PI)), v3(0, 0, 0), v3(0, 0, 0));
    }
    lab_make(l, 5e-3);
}

/* rms of the difference of the forces of two worlds at the poses of the first. */
static double force_error(lab *a, lab *b, double Hs)
{
    double off = 0.0;
    b->w.sea.time = a->w.sea.time;
    for (int32_t k = 0; k < b->w.n; k++) {
        b->w.b.x[k] = a->w.b.x[k], b->w.b.q[k] = a->w.b.q[k];
        b->w.b.v[k] = a->w.b.v[k], b->w.b.w[k] = a->w.b.w[k];
        b->w.b.f[k] = b->w.b.t[k] = v3(0, 0, 0);
        fl_environment_force(&b->w.sea, &b->w.b, k);
        const fl_hull *h = &a->w.sea.hull[k];
        const double e = v3_norm(v3_sub(a->w.sea.water_force[k], b->w.sea.water_force[k])) /
                         (1025 * G * h->prism.area * 0.25 * Hs);
        off += e * e / b->w.n;
    }
    return sqrt(off);
}

static int print_row(const sea_case *c, int32_t n, int64_t steps)
{
    lab l, few, fine;
    make_sea(&l, c, c->error, n, 0.0);
    const double start = processor_time();
    const int bad = lab_run(&l, steps);
    const double cost = 1e6 * (processor_time() - start) / (double)steps / n;
    fl_energy_update(&l.w);
    const double ledger = fabs(l.w.ledger.residual) / l.w.ledger.throughput;
    if (!c->trains) {
        printf("%-6s %4s %7s %6s %8.2f\n", "calm", "", "", "", cost);
        lab_free(&l);
        return bad != 0;
    }
    int64_t points = 0;
    for (int32_t k = 0; k < n; k++) points += l.w.sea.nodes[k].n;
    double each = NAN, error = NAN, off = NAN;
    if (!c->more) {
        make_sea(&few, c, "none", n < SAMPLE ? n : SAMPLE, 0.0);
        make_sea(&fine, c, "0.0003", n < SAMPLE ? n : SAMPLE, 0.0);
        error = force_error(&l, &fine, c->Hs);
        off = force_error(&fine, &few, c->Hs);
        lab_free(&fine);
        const double begun = processor_time();
        lab_run(&few, 10);
        each = 1e6 * (processor_time() - begun) / 10 / few.w.n;
        lab_free(&few);
    }
    printf("%-6g %4g %7d %6s %8.2f %10.1f %9.1f %10.2g %10.2g %10.2g   %s\n", c->Tp, c->Hs, c->trains,
           c->error, cost, each, (double)points / n, error, off, ledger, c->more ? c->more : "");
    lab_free(&l);
    return bad != 0 || (!c->more && !(error < 0.05));
}

int main(int argc, char **argv)
{
    static const sea_case CASE[] = {{0, 0, 0, NULL, NULL},
                                    {1, 8, 100, "0.003", NULL},
                                    {1, 6, 10, "0.003", NULL},
                                    {1, 6, 100, "0.003", NULL},
                                    {1, 6, 1000, "0.003", NULL},
                                    {1, 4, 100, "0.01", NULL},
                                    {1, 4, 100, "0.003", NULL},
                                    {0.2, 6, 100, "0.003", NULL},
                                    {0.2, 6, 100, "0.0003", NULL},
                                    {1, 6, 100, "0.01", NULL},
                                    {1, 6, 100, "0.003", "water.drag=facet"},
                                    {1, 6, 100, "0.01", "water.spread=2"}};
    const int32_t n = argc > 1 ? atoi(argv[1]) : 10000;
    const int64_t steps = argc > 2 ? atoi(argv[2]) : 300;
    int bad = 0;
    setvbuf(stdout, NULL, _IOLBF, 0);
    printf("waves on %d floes of 6 to 20 m, %lld steps of 5 ms, one thread\n", n, (long long)steps);
    printf("%-6s %4s %7s %6s %8s %10s %9s %10s %10s %10s\n", "Tp[s]", "Hs", "trains", "e", "us", "each step",
           "points", "error", "each step", "ledger");
    for (size_t k = 0; k < sizeof CASE / sizeof *CASE; k++) bad += print_row(&CASE[k], n, steps);
    printf("%d passed, %d failed\n", (int)(sizeof CASE / sizeof *CASE) - bad, bad);
    return bad > 0;
}
