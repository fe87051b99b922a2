/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ice-induced vibration: the range of speeds in which a structure locks in, upwards and downwards, a monopile
 * of several modes, and floes of finite mass that stop.
 *
 * Expected values are of an independent program for the model of verify_vibration.c, with the numbers of runs
 * given there; +- are 95 % limits of the mean of the runs. Forces are over F0, the mean of fast crushing. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "sim/moving_structure.h"
#include "support/strip_runs.h"

/* --- IV6: which speeds lock in ----------------------------------------------------------------------------
 * */

/* Puts the structure to its deflection under the mean force, at the speed `start`; its elements stand at
 * their first gaps. */
static void put_to_deflection(lab *l, double start)
{
    fl_modal_dof *m = &l->w.moving.movers.motion[0].mode[0];
    m->q = STRIP_F0 * 1.05 / (m->mass * m->omega * m->omega);
    m->v = start;
}

/* Runs that are locked in. */
static int locked(double v, double start, int runs)
{
    int n = 0;
    for (int seed = 1; seed <= runs; seed++) {
        strip_record s = {0};
        lab l;
        strip_start(&l, v, seed, 0);
        strip_add_oscillator(&l);
        lab_make(&l, 1e-3);
        put_to_deflection(&l, start);
        strip_run_until(&l, 100.0, 60.0, &s);
        lab_free(&l);
        n += strip_beta(&s, v) > 0.5;
    }
    return n;
}

#define RAMP_FROM 0.02
#define RAMP_TO 0.25
#define RAMP_TIME 460.0
#define RAMP_WINDOW 5.0 /* [s] in which the speed changes by 2.5 mm/s */

/* The speed rises or falls in RAMP_TIME: the highest of a window that is locked in. */
static double fastest_lock_in(int falls, int seed)
{
    double fastest = 0.0;
    lab l;
    strip_start(&l, falls ? RAMP_TO : RAMP_FROM, seed, 0);
    strip_add_oscillator(&l);
    lab_make(&l, 1e-3);
    if (falls) put_to_deflection(&l, 0.0);
    for (double t = 0.0; t < RAMP_TIME - 0.5 * RAMP_WINDOW; t += RAMP_WINDOW) {
        strip_record s = {0};
        double v = 0.0;
        while (fl_world_time(&l.w) < t + RAMP_WINDOW - 0.5 * l.w.dt) {
            const double part = fl_world_time(&l.w) / RAMP_TIME;
            v = RAMP_FROM + (RAMP_TO - RAMP_FROM) * (falls ? 1.0 - part : part);
            l.w.b.v[0].x = v;
            if (lab_run(&l, 1)) exit(1);
            strip_record_add(&s, &l.w);
        }
        if (strip_beta(&s, v) > 0.5) fastest = fmax(fastest, v);
    }
    lab_free(&l);
    return fastest;
}

static void hysteresis(void)
{
    const int runs = 3;
    strip_values up = {0}, down = {0};
    if (verify_quick()) {
        verify_row("IV6", "v .12 from rest: locked in, of 1", locked(0.12, 0.0, 1), 0.0, 0.0, VERIFY_ABS);
        verify_row("IV6", "v .12 in motion: locked in, of 1", locked(0.12, 0.12, 1), 1.0, 0.0, VERIFY_ABS);
        return;
    }
    verify_row("IV6", "v .10 from rest: locked in, of 10", locked(0.10, 0.0, 10), 10.0, 0.0, VERIFY_ABS);
    verify_row("IV6", "v .10 in motion", locked(0.10, 0.10, 10), 10.0, 0.0, VERIFY_ABS);
    verify_row("IV6", "v .12 from rest", locked(0.12, 0.0, 10), 0.0, 0.0, VERIFY_ABS);
    verify_row("IV6", "v .12 in motion", locked(0.12, 0.12, 10), 10.0, 0.0, VERIFY_ABS);
    verify_row("IV6", "v .15 from rest", locked(0.15, 0.0, 10), 0.0, 0.0, VERIFY_ABS);
    /* 3 of 10: binomial, standard deviation 1.45 */
    verify_row("IV6", "v .15 in motion", locked(0.15, 0.15, 10), 3.0, 4.4, VERIFY_ABS);
    verify_row("IV6", "v .17 from rest", locked(0.17, 0.0, 10), 0.0, 0.0, VERIFY_ABS);
    verify_row("IV6", "v .17 in motion", locked(0.17, 0.17, 10), 0.0, 0.0, VERIFY_ABS);
    for (int seed = 1; seed <= runs; seed++) {
        strip_values_add(&up, fastest_lock_in(0, seed));
        strip_values_add(&down, fastest_lock_in(1, seed));
    }
    /* three standard deviations of one run */
    strip_row("IV6", "speed that rises: lock-in ends [m/s]", &up, 0.194, 3.0 * 0.012, VERIFY_ABS);
    strip_row("IV6", "speed that falls: lock-in begins [m/s]", &down, 0.0955, 3.0 * 0.0033, VERIFY_ABS);
}

/* --- IV7: the monopile -------------------------------------------------------------------------------------
 * */

#define PILE_F0 3e6 /* [N] */

/* beta of each mode of the IEA 15 MW monopile, of its lowest `modes`, and the mean force. */
static double pile_run(int modes, int ring, double v, double ratio, int seed, double beta[4])
{
    static const double f[4] = {0.1776, 0.9812, 2.199, 4.357}, m[4] = {1538300e3, 52440e3, 9594e3, 2799e3};
    double n = 0.0, q[4] = {0}, qq[4] = {0}, force = 0.0;
    lab l;
    strip_start(&l, v, seed, ring);
    lab_setf(&l, "failure.pressure=%.17g", PILE_F0 / 5.0);
    for (int k = 0; k < modes; k++) {
        lab_setf(&l, "mode m%d.frequency=%.17g", k + 1, f[k]);
        lab_setf(&l, "mode m%d.mass=%.17g", k + 1, m[k]);
        lab_setf(&l, "mode m%d.damping_ratio=%.17g", k + 1, ratio);
    }
    lab_make(&l, 1e-3);
    while (fl_world_time(&l.w) < (verify_quick() ? 90.0 : 300.0)) {
        if (lab_run(&l, 1)) exit(1);
        if (fl_world_time(&l.w) < (verify_quick() ? 50.0 : 100.0)) continue;
        n++, force += l.w.part_force[0].x / PILE_F0;
        for (int k = 0; k < modes; k++) {
            const double speed = l.w.moving.movers.motion[0].mode[k].v;
            q[k] += speed, qq[k] += speed * speed;
        }
    }
    lab_free(&l);
    for (int k = 0; k < modes; k++) beta[k] = sqrt(2.0) * strip_deviation(n, q[k], qq[k]) / v;
    return force / n;
}

/* Expected beta; tolerance 0: only printed. */
typedef struct {
    int modes, ring;
    double v, mean, beta[4], tol[4];
} pile_case;

static void pile_rows(const pile_case *c, int runs)
{
    strip_values beta[4] = {{0}}, mean = {0};
    char what[100];
    for (int seed = 1; seed <= runs; seed++) {
        double one[4];
        strip_values_add(&mean, pile_run(c->modes, c->ring, c->v, 0.01, seed, one));
        for (int k = 0; k < c->modes; k++) strip_values_add(&beta[k], one[k]);
    }
    snprintf(what, sizeof what, "%s, %d modes, v %g: mean force", c->ring ? "pile" : "wall", c->modes, c->v);
    strip_row("IV7", what, &mean, c->mean, 0.01, VERIFY_REL);
    for (int k = 0; k < c->modes; k++) {
        snprintf(what, sizeof what, "  beta of mode %d", k + 1);
        if (c->tol[k] > 0.0) strip_row("IV7", what, &beta[k], c->beta[k], c->tol[k], VERIFY_REL);
        else if (c->tol[k] < 0.0) verify_below("IV7", what, beta[k].sum / beta[k].n, c->beta[k]);
        else
            verify_note("  beta of mode %d: %.4f, %.3g of the other program", k + 1, beta[k].sum / beta[k].n,
                        c->beta[k]);
    }
}

static void monopile(void)
{
    /* the leading mode to 5 %, at .03 m/s, where two share the motion, to 20 % */
    static const pile_case IT[] = {{3, 0, 0.02, 1.374, {0.79, 0.41, 1.35}, {0, 0, 0.05}},
                                   {3, 0, 0.03, 1.260, {0.04, 0.95, 0.9}, {0, 0.2, 0.2}},
                                   {3, 0, 0.05, 1.136, {0.005, 0.03, 1.218}, {0, 0, 0.05}},
                                   {3, 0, 0.08, 1.113, {0.006, 0.03, 1.087}, {0, 0, 0.05}},
                                   {3, 0, 0.2, 1.028, {0.02, 0.02, 0.02}, {-1, -1, -1}},
                                   {4, 62, 0.05, 1.192, {0.005, 0.03, 1.272, 0.755}, {0, 0, 0.05, 0}},
                                   {4, 62, 0.08, 1.140, {0.004, 0.036, 0.21, 1.06}, {0, 0, 0, 0.05}},
                                   {4, 62, 0.12, 1.111, {0.003, 0.02, 0.06, 1.036}, {0, 0, 0, 0.05}},
                                   {4, 62, 0.2, 1.048, {0.07, 0.07, 0.07, 0.07}, {-1, -1, -1, -1}}};
    strip_values at[2] = {{0}};
    for (size_t k = 0; k < sizeof IT / sizeof *IT; k++)
        if (!verify_quick() || k == 3) pile_rows(&IT[k], verify_quick() ? 1 : 8);
    if (verify_quick()) return;
    for (int seed = 1; seed <= 8; seed++)
        for (int k = 0; k < 2; k++) {
            double beta[4];
            pile_run(4, 62, k ? 0.12 : 0.08, 0.03, seed, beta);
            strip_values_add(&at[k], fmax(fmax(beta[0], beta[1]), fmax(beta[2], beta[3])));
        }
    verify_true("IV7", "pile, damping ratio .03: lock-in at .08, 8 runs", at[0].sum / at[0].n > 0.5);
    verify_true("IV7", "  none at .12", at[1].sum / at[1].n < 0.5);
    verify_note("  largest beta of a mode: %.3f, %.3f", at[0].sum / at[0].n, at[1].sum / at[1].n);
}

/* --- IV8: floes that stop ----------------------------------------------------------------------------------
 * */

typedef struct {
    double way, time, back;      /* [m], [s], speed of the rebound [m/s] */
    double calm, locked, strong; /* [s] with beta below .5, up to 1.4, above, in windows of 1 s */
    double most;                 /* largest beta */
} floe_stop;

static void start_free_floe(lab *l, int oscillates, int seed)
{
    const double mass = oscillates ? 5e8 : 1e8, v = oscillates ? 0.25 : 0.3;
    strip_start(l, v, seed, 0);
    lab_set(l, "boundary.drive_width=none");
    lab_set(l, "boundary.drive_edge=auto");
    lab_set(l, "boundary.drive_fixed=x y rz");
    lab_set(l, "boundary.drive=0");
    const double r = 0.05, a = 120.0 + 2.0 * STRIP_FRONT - 2.0 * r, b = 60.0 - 2.0 * r, c = 0.5 - 2.0 * r,
                 volume = a * b * c + 2.0 * r * (a * b + b * c + c * a) + PI * r * r * (a + b + c) +
                          4.0 / 3.0 * PI * r * r * r;
    lab_setf(l, "material ice.density=%.17g", mass / volume);
    if (oscillates) strip_add_oscillator(l);
    lab_make(l, 1e-3);
}

static floe_stop stop_floe(int oscillates, int seed)
{
    floe_stop q = {0};
    lab l;
    start_free_floe(&l, oscillates, seed);
    const double start = l.w.b.x[0].x;
    for (int second = 0; second < 200 && fl_world_time(&l.w) < q.time + 6.0; second++) {
        strip_record s = {0};
        double speed = 0.0;
        for (int k = 0; k < 1000; k++) {
            if (lab_run(&l, 1)) exit(1);
            const double x = l.w.b.x[0].x - start;
            if (x > q.way) q.way = x, q.time = fl_world_time(&l.w);
            q.back = fmax(q.back, -l.w.b.v[0].x);
            speed += 1e-3 * l.w.b.v[0].x;
            strip_record_add(&s, &l.w);
        }
        if (q.time < fl_world_time(&l.w) - 0.5 * l.w.dt) break; /* it has stopped in this window */
        if (!oscillates) continue;
        const double beta = strip_beta(&s, speed);
        *(beta < 0.5 ? &q.calm : beta < 1.4 ? &q.locked : &q.strong) += 1.0;
        q.most = fmax(q.most, beta);
    }
    for (int k = 0; k < 6000; k++) { /* the rebound */
        if (lab_run(&l, 1)) exit(1);
        q.back = fmax(q.back, -l.w.b.v[0].x);
    }
    lab_free(&l);
    return q;
}

static void stopping(void)
{
    const int runs = verify_quick() ? 1 : 10;
    strip_values way = {0}, time = {0}, back = {0}, calm = {0}, within = {0}, strong = {0}, most = {0};
    for (int seed = 1; seed <= runs; seed++) {
        const floe_stop q = stop_floe(0, seed);
        strip_values_add(&way, q.way), strip_values_add(&time, q.time), strip_values_add(&back, q.back);
    }
    strip_row("IV8", "floe of 1e8 kg at .3 m/s on a rigid wall: way [m]", &way, 2.168, 0.005, VERIFY_REL);
    strip_row("IV8", "  time [s]", &time, 13.74, 0.005, VERIFY_REL);
    /* half a unit of the last of its two digits, and the limits of ten runs here */
    strip_row("IV8", "  speed of the rebound [m/s]", &back, 6.6e-3, 0.105e-3, VERIFY_ABS);
    if (verify_quick()) return;
    way = time = (strip_values){0};
    for (int seed = 1; seed <= runs; seed++) {
        const floe_stop q = stop_floe(1, seed);
        strip_values_add(&way, q.way), strip_values_add(&time, q.time), strip_values_add(&most, q.most);
        strip_values_add(&calm, q.calm), strip_values_add(&within, q.locked),
            strip_values_add(&strong, q.strong);
    }
    strip_row("IV8b", "floe of 5e8 kg at .25 m/s on the oscillator: way [m]", &way, 7.456, 0.01, VERIFY_REL);
    strip_row("IV8b", "  time [s]", &time, 56.2, 0.01, VERIFY_REL);
    strip_row("IV8b", "  seconds with beta below .5", &calm, 42.8, 0.1, VERIFY_REL);
    strip_row("IV8b", "  to 1.4", &within, 10.2, 0.1, VERIFY_REL);
    strip_row("IV8b", "  above", &strong, 2.6, 0.1, VERIFY_REL);
    strip_row("IV8b", "  largest", &most, 2.43, 0.1, VERIFY_REL);
}

int main(void)
{
    verify_begin("lock-in, and floes that stop");
    stopping();
    hysteresis();
    monopile();
    return verify_end();
}
