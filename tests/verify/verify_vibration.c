/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ice-induced vibration: crushing that depends on speed, one element to an oscillator, and a drift that
 * turns. verify_lock_in.c has lock-in by speed, a monopile and floes that stop.
 *
 * Expected values of IV1 are closed forms: for n = 1 without a delayed part t = -ln(1 - v_t/w) delta/v_t to
 * break, else quadrature of one cycle. Those of IV2 to IV10 are of an independent program for the same model,
 * with the numbers of runs given there; tolerances are its errors. Forces are over F0, the mean of fast
 * crushing; +- are 95 % limits of the mean of the runs. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "failure/strip.h"
#include "sim/energy_balance.h"
#include "sim/moving_structure.h"
#include "sim/snapshot.h"
#include "support/strip_runs.h"

static const fl_strip_law B = {2.5, 5e-3, 10e-3, 3, 0.2, 2.0, 1}, A = {2.5, 5e-3, 10e-3, 1, 0.0, 1.0, 1};

/* --- IV1: one element --------------------------------------------------------------------------------------
 * */

/* Period and mean pressure over k z, R 2, closing at w. */
static void one_element(fl_strip_law law, double w, double dt, double *period, double *mean)
{
    law.peak_ratio = 2.0;
    const fl_strip_step step = fl_strip_step_of(&law, dt);
    fl_strip_element s = {0};
    double first = -1.0, last = 0.0, sum = 0.0, before = 0.0;
    int cycles = 0;
    for (int64_t k = 1; cycles <= 200; k++) {
        const int breaks = fl_strip_advance(&step, &s, w * dt, (fl_strip_id){0, 0, 0});
        const double now = fl_strip_deflection(&s);
        if (breaks && first >= 0.0) sum += 0.5 * (before + law.delta) * (dt - s.e / w) + 0.5 * now * s.e / w;
        else if (first >= 0.0) sum += 0.5 * (before + now) * dt;
        before = now;
        if (!breaks) continue;
        last = (double)k * dt - s.e / w;
        if (first < 0.0) first = last, sum = 0.5 * now * s.e / w;
        cycles++;
    }
    *period = (last - first) / (cycles - 1);
    *mean =
        2.0 * sum / (law.delta * (last - first)); /* R = 2, and at the end the same part of a cycle is open */
}

static void elements(void)
{
    static const double DT[3] = {10e-3, 5e-3, 2.5e-3};
    double T, F, error[2][3];
    for (int k = 0; k < 3; k++) {
        one_element(A, 0.02, DT[k], &T, &F);
        error[0][k] = fabs(T - 0.5 * log(2.0));
        one_element(B, 0.02, DT[k], &T, &F);
        error[1][k] = fabs(T - 0.797427);
    }
    one_element(A, 0.02, 1e-4, &T, &F);
    verify_row("IV1", "linear creep: time of a cycle [s]", T, 0.5 * log(2.0), 1e-7, VERIFY_REL);
    verify_row("IV1", "  mean over that of fast crushing", F, 1.11461, 1e-5, VERIFY_REL);
    verify_order("IV1", "  error of the time", DT, error[0], 3, 2.0, 0.1);
    one_element(B, 0.02, 1e-4, &T, &F);
    verify_row("IV1", "cubic creep, delayed part: time of a cycle [s]", T, 0.797427, 1e-6, VERIFY_REL);
    verify_row("IV1", "  mean", F, 1.50490, 1e-5, VERIFY_REL);
    verify_row("IV1", "  time at 10 ms [s]", 0.797427 + error[1][0], 0.797427, 1e-4, VERIFY_REL);
}

/* --- IV4: elements that are moved ------------------------------------------------------------------------
 * */

/* Work of the force on a harmonic motion of velocity beta v cos(omega t), as a dashpot c times v/F0. */
static double damping_of_motion(double beta, double v, int n, int cycles)
{
    const double omega = 4.0 * PI, dt = 1e-3, steps = 500.0;
    const fl_strip_step step = fl_strip_step_of(&B, dt);
    fl_strip_element *s = calloc((size_t)n, sizeof *s);
    double work = 0.0;
    if (!s) exit(1);
    for (int k = 0; k < n; k++) s[k].e = -fl_strip_gap(&B, fl_rng_entity4(0, 0, k, 0));
    for (int c = 0; c < cycles; c++)
        for (int j = 0; j < (int)steps; j++) {
            const double t0 = dt * j, way = beta * v / omega * (sin(omega * (t0 + dt)) - sin(omega * t0));
            for (int k = 0; k < n; k++) {
                const double before = fl_strip_deflection(&s[k]);
                fl_strip_advance(&step, &s[k], v * dt - way, (fl_strip_id){0, 0, k});
                if (c >= cycles / 4) work += 0.5 * (before + fl_strip_deflection(&s[k])) * way;
            }
        }
    free(s);
    const double mean = work * B.peak_ratio / B.delta / n / (cycles - cycles / 4) / (steps * dt);
    return -mean / (0.5 * beta * beta * v); /* mean power of -c x'^2 over F0, times v */
}

static void moved(void)
{
    static const double beta[6] = {0.2, 0.5, 0.8, 1.0, 1.1, 1.2},
                        expected[6] = {-0.115, -0.165, -0.234, -0.108, -0.045, 0.014};
    char what[80];
    for (int k = 0; k < 6; k++) {
        if (verify_quick() && k % 2 == 0) continue;
        snprintf(what, sizeof what, "moved at 2 Hz, v .07, beta %g: c v/F0", beta[k]);
        verify_row("IV4", what, damping_of_motion(beta[k], 0.07, verify_quick() ? 400 : 2000, 24),
                   expected[k], 0.01, VERIFY_ABS);
    }
}

/* --- IV2, IV3: rigid structures ---------------------------------------------------------------------------
 * */

static void rigid_wall(int linear)
{
    static const double w[] = {0.0025, 0.005, 0.012, 0.02, 0.03, 0.05, 0.2},
                        mean[2][7] = {{1.5749, 1.9843, 2.0678, 1.7444, 1.2855, 1.1352, 1.0281},
                                      {0.6250, 1.2500, 1.4376, 1.1804, 1.1068, 1.0591, 1.0137}},
                        std[] = {0, 0, 0, 0.182, 0.191, 0.187, 0.184};
    const int runs = verify_quick() ? 1 : 10;
    /* one run has 10 times the variance of ten */
    const double wide = sqrt(10.0 / runs);
    char what[80];
    for (int k = 0; k < 7; k++) {
        /* elements keep their common phase for long near v_t */
        const double since = w[k] < 0.04 ? 60.0 : 20.0, length = verify_quick()
                                                                     ? fmin(400.0 * 5e-3 / w[k], 100.0)
                                                                 : w[k] < 0.04 ? 320.0
                                                                               : 60.0;
        strip_values f = {0}, deviation = {0};
        if (verify_quick() && (k == 0 || k == 2 || k == 4 || (linear && k != 1))) continue;
        for (int seed = 1; seed <= runs; seed++) {
            strip_record s = {0};
            lab l;
            strip_start(&l, w[k], seed, 0);
            if (linear) {
                lab_set(&l, "failure.creep_exponent=1");
                lab_set(&l, "failure.delayed_stiffness=none");
            }
            lab_make(&l, w[k] > 0.1 ? 5e-4 : 2e-3);
            strip_run_until(&l, since + length, since, &s);
            strip_values_add(&f, s.f / s.n);
            strip_values_add(&deviation, strip_deviation(s.n, s.f, s.ff));
            lab_free(&l);
        }
        snprintf(what, sizeof what, "rigid wall%s, w %g: mean force", linear ? ", linear creep" : "", w[k]);
        strip_row("IV2", what, &f, mean[linear][k], 0.003 * wide, VERIFY_REL);
        if (!linear && std[k] > 0.0)
            strip_row("IV2", "  deviation", &deviation, std[k], 0.03 * wide, VERIFY_REL);
    }
}

/* Elements alone: those of a ring of n sectors round a pile, as ice moves by (vx, vy) against it, each moved
 * by itself and, where `passes`, with ice passed on along the wall. */
typedef struct {
    int n, passes;
    fl_strip_law law;
    fl_strip_element s[128];
    double c[128], sn[128], slid_x, slid_y;
} lone_ring;

static void start_ring(lone_ring *q, int n, int seed, int passes)
{
    *q = (lone_ring){.n = n, .passes = passes, .law = B};
    q->law.seed = (uint64_t)seed;
    for (int k = 0; k < n; k++) {
        /* as the sectors of the world lie: one faces x, half of the odd number of a half ring on each side */
        const double angle = 2.0 * PI * k / n;
        q->c[k] = cos(angle), q->sn[k] = sin(angle);
        q->s[k].e = -fl_strip_gap(&q->law, fl_rng_entity4(0, 0, k, 0));
    }
}

static void pass_on(lone_ring *q)
{
    const double width = 2.0 * PI * 5.0 / q->n;
    fl_strip_element old[128];
    if (hypot(q->slid_x, q->slid_y) < 0.01 * width) return;
    for (int k = 0; k < q->n; k++) old[k] = q->s[k];
    for (int k = 0; k < q->n; k++) {
        const double slid = -q->slid_x * q->sn[k] + q->slid_y * q->c[k], part = fmin(1.0, fabs(slid) / width);
        const fl_strip_element *from = &old[slid > 0.0 ? (k + q->n - 1) % q->n : (k + 1) % q->n];
        q->s[k].e -= part * (old[k].e - from->e);
        q->s[k].u -= part * (old[k].u - from->u);
    }
    q->slid_x = q->slid_y = 0.0;
}

/* Force on the pile over F0. */
static void step_ring(lone_ring *q, double vx, double vy, double dt, double *fx, double *fy)
{
    const fl_strip_step step = fl_strip_step_of(&q->law, dt);
    q->slid_x += vx * dt, q->slid_y += vy * dt;
    if (q->passes) pass_on(q);
    *fx = *fy = 0.0;
    for (int k = 0; k < q->n; k++) {
        fl_strip_advance(&step, &q->s[k], -(vx * q->c[k] + vy * q->sn[k]) * dt, (fl_strip_id){0, 0, k});
        const double f = B.peak_ratio * fl_strip_deflection(&q->s[k]) / B.delta * PI / q->n;
        *fx -= f * q->c[k], *fy -= f * q->sn[k];
    }
}

/* Deviation across the drift of such elements alone. */
static double deviation_alone(double v, int seed, int passes, double dt, double t)
{
    lone_ring q;
    double n = 0.0, sum = 0.0, square = 0.0, fx, fy;
    start_ring(&q, 62, seed, passes);
    for (int64_t k = 1; (double)k * dt < t; k++) {
        step_ring(&q, v, 0.0, dt, &fx, &fy);
        if ((double)k * dt > 10.0) n++, sum += fy, square += fy * fy;
    }
    return strip_deviation(n, sum, square);
}

/* Means, and deviations: of fast ice .163 along and across the drift, the square root of (2 R/3 - 1) pi^2/8
 * over 31. At .3 m/s the sectors aside close at 15 mm/s, next to v_t: they creep, and ice that is passed on
 * evens them out, so that less is left across. */
static void rigid_ring(void)
{
    static const double v[] = {0.05, 0.1, 0.2, 0.3, 1.0}, mean[] = {1.267, 1.112, 1.050, 0, 0};
    const int runs = verify_quick() ? 1 : 4;
    char what[80];
    for (int k = 0; k < 5; k++) {
        const double dt = v[k] < 0.5 ? 1e-3 : 5e-4, t = 10.0 + (verify_quick() ? fmax(4.0 / v[k], 13.0)
                                                                : v[k] < 0.5   ? 36.0 / v[k]
                                                                               : 60.0);
        strip_values f = {0}, along = {0}, across = {0}, alone = {0}, still = {0};
        if (verify_quick() && k != 1 && k != 4) continue;
        for (int seed = 1; seed <= runs; seed++) {
            strip_record s = {0};
            lab l;
            strip_start(&l, v[k], seed, 62);
            lab_make(&l, dt);
            strip_run_until(&l, t, 10.0, &s);
            lab_free(&l);
            strip_values_add(&f, s.f / s.n);
            strip_values_add(&along, strip_deviation(s.n, s.f, s.ff));
            strip_values_add(&across, strip_deviation(s.n, s.g, s.gg));
            if (k != 3) continue;
            strip_values_add(&alone, deviation_alone(v[k], seed, 1, dt, t));
            strip_values_add(&still, deviation_alone(v[k], seed, 0, dt, t));
        }
        snprintf(what, sizeof what, "rigid pile, 31 sectors on the front, v %g: mean force", v[k]);
        if (mean[k] > 0.0) strip_row("IV3", what, &f, mean[k], 0.01, VERIFY_REL);
        if (k < 3) continue;
        snprintf(what, sizeof what, "rigid pile, v %g: deviation along", v[k]);
        strip_row("IV3", what, &along, 0.163, 0.05, VERIFY_REL);
        if (k == 4) strip_row("IV3", "  across", &across, 0.163, 0.05, VERIFY_REL);
        if (k == 4) continue;
        strip_row("IV3", "  across: elements alone, ice passed on", &across, alone.sum / alone.n, 0.02,
                  VERIFY_REL);
        verify_note("  elements alone where ice stays: %.4f; fast ice: 0.163", still.sum / still.n);
    }
}

/* --- IV5, IV10: the oscillator ----------------------------------------------------------------------------
 * */

/* One run from rest, with records from `since` to `t`. */
static strip_record oscillator_run(double v, int seed, double since, double t, double scatter)
{
    strip_record s = {0};
    lab l;
    strip_start(&l, v, seed, 0);
    strip_add_oscillator(&l);
    if (scatter > 0.0) lab_setf(&l, "failure.scatter=%g", scatter);
    lab_make(&l, 1e-3);
    strip_run_until(&l, t, since, &s);
    fl_energy_update(&l.w);
    if (seed == 1)
        verify_below("IV5", "residual of the ledger over the throughput",
                     fabs(l.w.ledger.residual) / l.w.ledger.throughput, 1e-7);
    lab_free(&l);
    return s;
}

static void oscillator(void)
{
    static const struct {
        double v, f, std, x, beta;
    } IT[] = {{0.005, 1.984, 0, 0, 0},           {0.012, 1.876, 0.665, 3.34, 2.18},
              {0.02, 1.541, 0.767, 3.77, 2.40},  {0.03, 1.280, 0.616, 3.35, 1.70},
              {0.05, 1.140, 0.322, 3.02, 1.10},  {0.07, 1.102, 0.326, 4.30, 1.088},
              {0.09, 1.094, 0.263, 5.29, 1.035}, {0.2, 1.028, 0.184, 0.35, 0.03}};
    char what[80];
    for (size_t k = 0; k < sizeof IT / sizeof *IT; k++) {
        const int runs = verify_quick() ? 1 : 20;
        strip_values f = {0}, deviation = {0}, x = {0}, beta = {0};
        if (verify_quick() && k != 2 && k != 5) continue;
        for (int seed = 1; seed <= runs; seed++) {
            const strip_record s = oscillator_run(IT[k].v, seed, 40.0, 120.0, 0.0);
            strip_values_add(&f, s.f / s.n);
            strip_values_add(&deviation, strip_deviation(s.n, s.f, s.ff));
            strip_values_add(&x, 1e3 * strip_deviation(s.n, s.x, s.xx));
            strip_values_add(&beta, strip_beta(&s, IT[k].v));
        }
        snprintf(what, sizeof what, "oscillator, v %g: mean force", IT[k].v);
        strip_row("IV5", what, &f, IT[k].f, 0.003, VERIFY_REL);
        if (IT[k].std == 0.0) continue;
        strip_row("IV5", "  deviation of the force", &deviation, IT[k].std, 0.05, VERIFY_REL);
        /* beta and deviation of .03 and .35 mm are printed with one and two digits: half a unit of the last
         * */
        const double coarse = IT[k].beta < 0.1 ? 0.2 : 0.05;
        strip_row("IV5", "  deviation of x [mm]", &x, IT[k].x, coarse, VERIFY_REL);
        strip_row("IV5", "  beta", &beta, IT[k].beta, coarse, VERIFY_REL);
    }
}

static void scatter(void)
{
    const int runs = verify_quick() ? 1 : 8;
    strip_values f = {0}, x = {0}, beta = {0};
    for (int seed = 1; seed <= runs; seed++) {
        const strip_record s = oscillator_run(0.2, seed, 20.0, 120.0, 0.25);
        strip_values_add(&f, strip_deviation(s.n, s.f, s.ff));
        strip_values_add(&x, 1e3 * strip_deviation(s.n, s.x, s.xx));
        if (verify_quick()) continue;
        const strip_record locked = oscillator_run(0.07, seed, 40.0, 120.0, 0.25);
        strip_values_add(&beta, strip_beta(&locked, 0.07));
    }
    strip_row("IV10", "scatter .25, v .2: deviation of the force", &f, 0.310, 0.05, VERIFY_REL);
    strip_row("IV10", "  of x [mm]", &x, 2.2, 0.15, VERIFY_REL);
    if (!verify_quick()) strip_row("IV10", "  v .07: beta", &beta, 1.08, 0.05, VERIFY_REL);
}

/* --- IV9: a drift that turns
 * ---------------------------------------------------------------------------------- */

/* What is left of the load along the drift before, 2.45 m after it turned, where ice is not passed on. */
static double load_left_where_ice_stays(int seed)
{
    const double v = 0.1, dt = 2e-3;
    double fx, fy, sum = 0.0, n = 0.0;
    lone_ring q;
    start_ring(&q, 126, seed, 0);
    for (int64_t k = 1; (double)k * v * dt < 3.49; k++) {
        const int turned = (double)k * v * dt > 1.0;
        step_ring(&q, turned ? 0.0 : v, turned ? v : 0.0, dt, &fx, &fy);
        if ((double)k * v * dt > 3.41) n++, sum += fx;
    }
    return sum / n;
}

static void turning(void)
{
    static const double way[5] = {0.05, 0.25, 0.65, 1.05, 2.45}, fx[5] = {0.64, 0.63, 0.56, 0.46, 0.18},
                        fy[5] = {0.61, 0.74, 0.90, 1.00, 1.11};
    const double v = 0.1;
    const int runs = verify_quick() ? 1 : 6;
    strip_values along[5] = {{0}}, across[5] = {{0}}, stays = {0};
    char what[80];
    for (int seed = 1; seed <= runs; seed++) {
        double sum[5][3] = {{0}};
        lab l;
        strip_start(&l, v, seed, 126);
        lab_make(&l, 2e-3);
        lab_run(&l, (int64_t)(1.0 / v / l.w.dt + 0.5));
        l.w.b.v[0] = v3(0, v, 0);
        for (double d = 0.0; d < 2.6; d += v * l.w.dt) {
            if (lab_run(&l, 1)) exit(1);
            for (int k = 0; k < 5; k++) /* the mean about that way */
                if (fabs(d - way[k]) < 0.04)
                    sum[k][0]++, sum[k][1] += l.w.part_force[0].x, sum[k][2] += l.w.part_force[0].y;
        }
        for (int k = 0; k < 5; k++) {
            strip_values_add(&across[k], sum[k][1] / sum[k][0] / STRIP_F0);
            strip_values_add(&along[k], sum[k][2] / sum[k][0] / STRIP_F0);
        }
        strip_values_add(&stays, load_left_where_ice_stays(seed));
        lab_free(&l);
    }
    for (int k = 0; k < 5; k++) {
        snprintf(what, sizeof what, "drift turned by 90 deg, %g m on: force along", way[k]);
        strip_row("IV9", what, &along[k], fy[k], 0.08, VERIFY_REL);
        strip_row("IV9", "  across, along the drift before", &across[k], fx[k], 0.08, VERIFY_REL);
    }
    strip_row("IV9", "  the last for elements alone, ice not passed on", &stays, 0.31, 0.08, VERIFY_REL);
}

/* --- IV11: threads, stop and go on
 * ---------------------------------------------------------------------------------- */

/* Three piles that move together in two modes, a turning floe in front of each, with scatter. */
static void start_three(lab *l, int threads)
{
    lab_start(l);
    lab_set(l, "failure.crushing=structure");
    lab_set(l, "failure.crushing_law=rate");
    lab_set(l, "failure.pressure=100 kPa");
    lab_set(l, "failure.scatter=0.3");
    lab_setf(l, "run.threads=%d", threads);
    lab_set(l, "mode low.frequency=1");
    lab_set(l, "mode low.mass=120e3");
    lab_set(l, "mode low.direction=xy");
    lab_set(l, "mode high.frequency=4");
    lab_set(l, "mode high.mass=9e3");
    for (int k = 0; k < 3; k++) {
        lab_cone(l, (fl_cone){v3(0, 20 * k, -2), v3(0, 20 * k, 2), 1, 1});
        lab_box(l, v3(-8.9, 20 * k + 0.4, 0), v3(8, 7, 0.25), 0.05, q_one(), v3(0.4, 0, 0), v3(0, 0, 0.05));
    }
    lab_make(l, 5e-4);
}

static void go_on_from(lab *l, fl_world *w)
{
    char *bytes = NULL;
    size_t n = 0;
    fl_err err = {0};
    fl_text in = {0};
    FILE *f = open_memstream(&bytes, &n);
    if (!f) exit(1);
    fl_snapshot_write(f, w);
    if (fclose(f) || fl_text_open_bytes(&in, "snapshot", bytes, (int64_t)n, &err) ||
        fl_snapshot_read(&l->w, &in, &err)) {
        fprintf(stderr, "%s\n", err.text);
        exit(1);
    }
    fl_text_close(&in);
    free(bytes);
}

static void same_bits(void)
{
    lab one, four, later;
    start_three(&one, 1);
    start_three(&four, 4);
    start_three(&later, 2);
    if (lab_run(&one, 1700)) exit(1);
    go_on_from(&later, &one.w);
    if (lab_run(&one, 2300) || lab_run(&later, 2300) || lab_run(&four, 4000)) exit(1);
    verify_true("IV11", "elements have broken", one.w.strips.part_breaks[0] > 50);
    verify_true("IV11", "1 and 4 threads: the same bits", fl_state_hash(&one.w) == fl_state_hash(&four.w));
    verify_true("IV11", "stop and go on: the same bits", fl_state_hash(&one.w) == fl_state_hash(&later.w));
    lab_free(&one);
    lab_free(&four);
    lab_free(&later);
}

int main(void)
{
    verify_begin("ice-induced vibration");
    elements();
    rigid_wall(0);
    rigid_wall(1);
    rigid_ring();
    moved();
    oscillator();
    turning();
    scatter();
    same_bits();
    return verify_end();
}
