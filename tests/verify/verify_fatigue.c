/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Load cycles and fatigue: the example of ASTM E1049, and closed forms. */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/rng.h"
#include "stat/rainflow.h"
#include "support/verify.h"

static fl_rainflow rainflow;

static int count_cycles(int rule, int residue, int32_t n, const double *x)
{
    fl_err err = {0};
    return fl_rainflow_count(&rainflow, rule, residue, n, x, &err) == 0;
}

static double cycles_of(double range)
{
    double sum = 0.0;
    for (int32_t k = 0; k < rainflow.cycles; k++)
        if (rainflow.cycle[k].range == range) sum += rainflow.cycle[k].count;
    return sum;
}

static double damage(const fl_sn_curve *sn)
{
    double sum = 0.0;
    for (int32_t k = 0; k < rainflow.cycles; k++)
        sum += fl_sn_damage(sn, rainflow.cycle[k].range, rainflow.cycle[k].count);
    return sum;
}

/* ASTM E1049-85, figure 6: the load history and the table beneath it. */
static void astm_example(void)
{
    static const double x[] = {-2, 1, -3, 5, -1, 3, -4, 4, -2};
    static const double range[] = {3, 4, 6, 8, 9}, want[] = {0.5, 1.5, 0.5, 1.0, 0.5};
    static const double m[] = {3, 4, 5}, sum[] = {1094, 8449, 67838};
    static const char *const rule[] = {"ASTM E1049, range 3 4 6 8 9: cycles",
                                       "ISO four points, half residue: cycles"};
    for (int k = 0; k < FL_RAINFLOW_RULES; k++) {
        verify_true("F01", "the cycles of ASTM E1049 figure 6 are counted",
                    count_cycles(k, FL_RESIDUE_HALF, 9, x));
        for (int j = 0; j < 5; j++) verify_row("F01", rule[k], cycles_of(range[j]), want[j], 0.0, VERIFY_ABS);
        for (int j = 0; j < 3; j++)
            verify_row("F02", "Miner sum of n S^m, m = 3 4 5", damage(&(fl_sn_curve){.m = m[j], .a = 1.0}),
                       sum[j], 1e-14, VERIFY_REL);
        verify_row("F03", "equivalent range, m = 3, (1094 / 4)^(1/3)",
                   fl_rainflow_equivalent(rainflow.cycles, rainflow.cycle, 3.0), cbrt(273.5), 1e-14,
                   VERIFY_REL);
    }
    verify_true("F04", "and repeated for ever",
                count_cycles(FL_RAINFLOW_FOUR_POINT, FL_RESIDUE_REPEAT, 9, x));
    /* By hand: 5 -4 4 -3 5 encloses 3 -1 and 1 -2. */
    verify_row("F04", "repeated: sum of n S^3 of ranges 9 7 4 3", damage(&(fl_sn_curve){.m = 3.0, .a = 1.0}),
               729.0 + 343.0 + 64.0 + 27.0, 1e-14, VERIFY_REL);
}

/* Narrow band: the amplitudes follow Rayleigh's law, and the sum of n (2 r)^m is n (2 sqrt(2) s)^m Gamma(1
 * + m/2).  The amplitudes are its quantiles at (k + 1/2) / n, rising, so that each range is the sum of two
 * neighbours. */
static void narrow_band(void)
{
    enum { LEVELS = 4 };
    static const double m[] = {3.0, 5.0};
    for (int j = 0; j < 2; j++) {
        double h[LEVELS], error[LEVELS];
        for (int level = 0; level < LEVELS; level++) {
            const int32_t n = 100 << (2 * level);
            fl_err err = {0};
            double *x = fl_alloc(2 * (int64_t)n, sizeof *x, &err);
            for (int32_t k = 0; x && k < n; k++) {
                x[2 * k] = sqrt(-2.0 * log(1.0 - (k + 0.5) / n));
                x[2 * k + 1] = -x[2 * k];
            }
            const int ok = x && count_cycles(FL_RAINFLOW_ASTM, FL_RESIDUE_HALF, 2 * n, x);
            const double want = pow(2.0 * sqrt(2.0), m[j]) * tgamma(1.0 + 0.5 * m[j]);
            const double miss = ok ? fabs(damage(&(fl_sn_curve){.m = m[j], .a = 1.0}) / n / want - 1.0) : NAN;
            if (level == LEVELS - 1)
                verify_below("F10", "narrow band: damage of 6400 amplitudes", miss, 0.01);
            h[level] = 1.0 / n;
            error[level] = miss / pow(log(n), 0.5 * m[j]);
            free(x);
        }
        /* The last of n equal shares of the tail has values of (2 ln n)^(m/2), and its midpoint misses a
         * part of them: the error is (ln n)^(m/2) / n up to slower terms. */
        verify_order("F11", "narrow band: error over (ln n)^(m/2) against 1/n", h, error, LEVELS, 1.0, 0.15);
    }
}

/* A periodic load has no beginning: wherever the record is cut, the damage is the same. */
static void cyclic_record(void)
{
    enum { N = 400 };
    double x[2 * N], first = 0.0, worst = 0.0;
    fl_rng g = fl_rng_of(1, 0, FL_RNG_TEST);
    const fl_sn_curve sn = {.m = 3.0, .a = 1e3, .m2 = 5.0, .knee = 8.0};
    int ok = 1;
    for (int k = 0; k < N; k++) x[k] = x[k + N] = floor(fl_rng_in(&g, 0.0, 64.0));
    for (int k = 0; k < N && ok; k++) {
        ok = count_cycles(FL_RAINFLOW_FOUR_POINT, FL_RESIDUE_REPEAT, N, x + k);
        if (k == 0) first = damage(&sn);
        worst = fmax(worst, fabs(damage(&sn) / first - 1.0));
    }
    verify_true("F20", "400 cuts of one period are counted", ok);
    verify_below("F20", "repeated residue: damage against the cut", worst, 1e-13);
}

/* Constant amplitude: n cycles of range S do damage n / N(S) on both sides of a knee; N is continuous. */
static void constant_amplitude(void)
{
    /* EN 1993-1-9, category 71: 2e6 cycles at 71 MPa, slopes 3 and 5, knee at 5e6, cut-off at 1e8 cycles. */
    const double knee = 71.0 * cbrt(2.0 / 5.0), cut_off = knee * pow(5e6 / 1e8, 0.2);
    const fl_sn_curve sn = {.m = 3.0, .a = 2e6 * pow(71.0, 3.0), .m2 = 5.0, .knee = knee};
    verify_row("F30", "EN 1993-1-9 category 71: knee [MPa], 52", knee, 52.0, 0.01, VERIFY_REL);
    verify_row("F30", "EN 1993-1-9 category 71: cut-off [MPa], 29", cut_off, 29.0, 0.015, VERIFY_REL);
    verify_row("F31", "damage of 2e6 cycles of 71 MPa", fl_sn_damage(&sn, 71.0, 2e6), 1.0, 1e-14, VERIFY_REL);
    verify_row("F31", "damage of 5e6 cycles at the knee", fl_sn_damage(&sn, knee, 5e6), 1.0, 1e-13,
               VERIFY_REL);
    verify_row("F31", "damage of 1e8 cycles at the cut-off", fl_sn_damage(&sn, cut_off, 1e8), 1.0, 1e-13,
               VERIFY_REL);
}

int main(void)
{
    verify_begin("fatigue");
    astm_example();
    narrow_band();
    cyclic_record();
    constant_amplitude();
    fl_rainflow_free(&rainflow);
    return verify_end();
}
