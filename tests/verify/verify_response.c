/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The response of an oscillator by Newmark's method against closed forms. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "stat/oscillator.h"
#include "support/verify.h"

/* The period grows by (w h / 2) / atan(w h / 2); the amplitude does not change. */
static void free_vibration(void)
{
    static const double part[] = {0.01, 0.02, 0.05, 0.1, 0.2},
                        want[] = {1.000329, 1.001315, 1.008171, 1.032075, 1.120033};
    const fl_oscillator o = {.frequency = 1.0};
    const double w = 2.0 * PI;
    const int32_t steps = verify_quick() ? 10000 : 1000000;
    for (int j = 0; j < 5; j++) {
        double angle = 0.0;
        char what[80];
        fl_oscillator_state s = {.u = 1.0};
        fl_oscillator_set_acceleration(&o, 0.0, &s);
        for (int32_t k = 0; k < steps; k++) {
            const fl_oscillator_state from = s;
            fl_oscillator_step(&o, part[j], 0.0, &s);
            angle += atan2(from.v * s.u - from.u * s.v, from.u * s.u * w + from.v * s.v / w);
        }
        snprintf(what, sizeof what, "period ratio at a step of %g T", part[j]);
        verify_row("R01", what, part[j] * w * steps / angle, want[j], 6e-7, VERIFY_REL);
        verify_row("R02", "amplitude after the last step", hypot(s.u, s.v / w), 1.0, 1e-9, VERIFY_ABS);
    }
}

/* A load that is suddenly constant: overshoot 1 + exp(-z pi / sqrt(1 - z^2)), 1.854468 for 5 %. */
static void sudden_load(void)
{
    enum { LEVELS = 5 };
    const fl_oscillator o = {0.4, 0.05};
    const double edge[] = {0.0, 1.0, 4.0}, x[] = {0.0, 1.0},
                 want = 1.0 + exp(-0.05 * PI / sqrt(1.0 - 0.0025));
    double h[LEVELS], error[LEVELS];
    fl_response r;
    fl_err err = {0};
    for (int j = 0; j < LEVELS; j++) {
        fl_oscillator_integrate(&o, 2, edge, x, 10.0, 1 << j, &r, NULL);
        h[j] = r.step;
        error[j] = fabs(r.largest - want);
    }
    verify_order("R10", "sudden load, 5 % damping: overshoot", h, error, LEVELS, 2.0, 0.1);
    const int failed = fl_oscillator_solve(&o, 2, edge, x, &r, NULL, &err);
    verify_row("R11", "overshoot, steps halved until it stands", failed ? (double)NAN : r.largest, 1.854468,
               FL_OSCILLATOR_TOLERANCE, VERIFY_REL);
    verify_row("R11", "the reported error", r.error, fabs(r.largest - want) / want, 1e-5, VERIFY_ABS);
}

/* A rectangular pulse of length d on an undamped oscillator: 2 sin(pi d / T) below T/2, 2 above. */
static void rectangular_pulse(void)
{
    static const double d[] = {0.02, 0.1, 0.25, 0.4, 0.6, 1.5};
    const fl_oscillator o = {1.0, 0.0};
    for (int j = 0; j < 6; j++) {
        const double edge[] = {0.0, 0.5, 0.5 + d[j], 4.0}, x[] = {0.0, 1.0, 0.0};
        const double want = d[j] < 0.5 ? 2.0 * sin(PI * d[j]) : 2.0;
        char what[80];
        fl_response r;
        fl_err err = {0};
        const int failed = fl_oscillator_solve(&o, 3, edge, x, &r, NULL, &err);
        snprintf(what, sizeof what, "pulse of %g T: amplification", d[j]);
        verify_row("R20", what, failed ? (double)NAN : r.largest, want, 2.0 * FL_OSCILLATOR_TOLERANCE,
                   VERIFY_REL);
    }
}

/* The load sin(2 pi f t), as means over rows of T / 64 to T / 512, in the steady state:
 *     1 / sqrt((1 - q^2)^2 + (2 z q)^2), q = f / fn. */
static void harmonic_load(void)
{
    enum { LEVELS = 4, CYCLES = 120 };
    static const double ratio[] = {0.5, 0.95, 1.0, 2.0};
    const fl_oscillator o = {1.0, 0.05};
    for (int i = 0; i < 4; i++) {
        const double q = ratio[i], want = 1.0 / hypot(1.0 - q * q, 2.0 * 0.05 * q);
        double h[LEVELS], error[LEVELS];
        char what[80];
        for (int level = 0; level < LEVELS; level++) {
            const int32_t rows = 64 << level, n = CYCLES * rows, half = n / 2;
            fl_err err = {0};
            double *x = fl_alloc(2 * (int64_t)n + 1, sizeof *x, &err), *edge = x + n, largest = 0.0;
            fl_oscillator_state *at = fl_alloc(n, sizeof *at, &err);
            fl_response r;
            if (!x || !at) {
                verify_true("R30", "memory", 0);
                return;
            }
            for (int32_t k = 0; k <= n; k++) edge[k] = k / (q * rows);
            for (int32_t k = 0; k < n; k++)
                x[k] = (cos(2.0 * PI * k / rows) - cos(2.0 * PI * (k + 1) / rows)) * rows / (2.0 * PI);
            fl_oscillator_integrate(&o, n, edge, x, 1.0, 1, &r, at);
            /* The amplitude of the steady half, by projection on the frequency of the load. */
            double in = 0.0, out = 0.0;
            for (int32_t k = half; k < n; k++) {
                in += at[k].u * cos(2.0 * PI * (k + 1) / rows) * 2.0 / half;
                out += at[k].u * sin(2.0 * PI * (k + 1) / rows) * 2.0 / half;
            }
            largest = hypot(in, out);
            h[level] = 1.0 / rows;
            error[level] = fabs(largest - want);
            if (level == LEVELS - 1) {
                snprintf(what, sizeof what, "harmonic load at %g fn, 512 rows a period", q);
                verify_row("R30", what, largest, want, 1e-3, VERIFY_REL);
            }
            free(x);
            free(at);
        }
        /* At resonance the amplitude hardly depends on the natural frequency, so the period error of the
         * method appears as its square. */
        verify_order("R31", "its error against the length of a row", h, error, LEVELS, q == 1.0 ? 4.0 : 2.0,
                     0.15);
    }
}

/* White noise of the one-sided density S: variance pi fn S / (4 z), with F constant over rows of h so that
 * S = 2 h var F far below 1 / h. */
static void white_noise(void)
{
    const int32_t n = verify_quick() ? 200000 : 2000000;
    const double step = 0.02;
    const fl_oscillator o = {1.0, 0.05};
    fl_err err = {0};
    double *x = fl_alloc(2 * (int64_t)n + 1, sizeof *x, &err), *edge = x + n;
    fl_rng g = fl_rng_of(4, 0, FL_RNG_TEST);
    fl_response r;
    if (!x) {
        verify_true("R40", "memory", 0);
        return;
    }
    for (int32_t k = 0; k <= n; k++) edge[k] = step * k;
    for (int32_t k = 0; k < n; k++) x[k] = fl_rng_in(&g, -sqrt(3.0), sqrt(3.0)); /* variance 1 */
    fl_oscillator_integrate(&o, n, edge, x, 50.0, 2, &r, NULL);
    /* The variance of the estimate of a variance s^2 over a time D is s^4 / (2 pi z fn D). */
    const double want = PI * 1.0 * 2.0 * step / (4.0 * 0.05);
    verify_row("R40", "white noise: variance of the response", r.std * r.std, want,
               5.0 / sqrt(2.0 * PI * 0.05 * step * n), VERIFY_REL);
    free(x);
}

int main(void)
{
    verify_begin("response of an oscillator");
    free_vibration();
    sudden_load();
    rectangular_pulse();
    harmonic_load();
    white_noise();
    return verify_end();
}
