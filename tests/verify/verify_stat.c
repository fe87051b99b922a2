/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Load statistics against scipy 1.10 and closed forms. */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "stat/butterworth.h"
#include "stat/descriptive_stats.h"
#include "stat/extreme.h"
#include "stat/moving_mean.h"
#include "stat/peaks.h"
#include "stat/resample.h"
#include "support/verify.h"

static void describe_sample(void)
{
    static const double x[] = {52.1, 60.3, 47.8, 71.5, 66.2, 58.4,  83.7, 49.9, 55.0, 91.2,
                               62.6, 77.3, 68.8, 45.2, 59.7, 102.4, 73.1, 64.5, 53.6, 80.9};
    fl_descriptive_stats d;
    fl_compute_moments(20, x, NULL, &d);
    verify_row("L01", "mean of the sample of 20", d.mean, 66.21, 1e-12, VERIFY_REL);
    verify_row("L02", "standard deviation s(n-1)", d.std_sample, 15.123105, 1e-7, VERIFY_REL);
    verify_row("L03", "standard deviation s(n)", d.std, 14.740180, 1e-7, VERIFY_REL);
    verify_row("L04", "skewness g1", d.skew, 0.722765, 1e-6, VERIFY_REL);
    verify_row("L05", "exceedance of the largest of 20", fl_plotting_position(1, 20), 1.0 / 21.0, 1e-15,
               VERIFY_REL);
}

static void butterworth_filter(void)
{
    static const double want_a[] = {1.0, -3.18063855, 3.86119435, -2.11215536, 0.43826514};
    static const double want_b[] = {1.0, 4.0, 6.0, 4.0, 1.0};
    static const double freq[] = {1.0, 5.0, 10.0, 20.0},
                        gain[] = {0.9999988, 0.7071068, 0.0563709, 0.0022584};
    fl_err err = {0};
    fl_butterworth f;
    double b[5], a[5];
    if (fl_butterworth_low(&f, 4, 5.0, 100.0, &err)) {
        verify_true("L10", "filter of order 4 at 5 Hz of 100 Hz is designed", 0);
        return;
    }
    fl_butterworth_polynomials(&f, b, a);
    for (int k = 0; k < 5; k++)
        verify_row("L10", "Butterworth a, order 4, 5 Hz of 100 Hz", a[k], want_a[k], 1e-8, VERIFY_REL);
    for (int k = 0; k < 5; k++)
        verify_row("L11", "Butterworth b", b[k], 4.166e-4 * want_b[k], 1e-4, VERIFY_REL);
    for (int k = 0; k < 4; k++)
        verify_row("L12", "gain at 1, 5, 10, 20 Hz", fl_butterworth_gain(&f, freq[k]), gain[k], 5e-8,
                   VERIFY_ABS);
}

/* Measured response to a sine against the square of the gain of one pass; and its phase. */
static void zero_phase(void)
{
    enum { N = 4000 };
    static double x[N], y[N];
    static const double freq[] = {1.0, 4.0, 5.0, 10.0};
    for (int j = 0; j < 4; j++) {
        fl_err err = {0};
        fl_butterworth f;
        double in = 0.0, out = 0.0, side = 0.0;
        for (int k = 0; k < N; k++) x[k] = sin(2.0 * PI * freq[j] * k / 100.0);
        if (fl_butterworth_low(&f, 4, 5.0, 100.0, &err) || fl_butterworth_zero_phase(&f, N, x, y, &err)) {
            verify_true("L13", "zero-phase filter runs", 0);
            return;
        }
        for (int k = 1000; k < 3000; k++) { /* a whole number of periods, far from the ends */
            in += x[k] * x[k];
            out += x[k] * y[k];
            side += cos(2.0 * PI * freq[j] * k / 100.0) * y[k];
        }
        verify_row("L13", "zero-phase gain at 1, 4, 5, 10 Hz", out / in,
                   pow(fl_butterworth_gain(&f, freq[j]), 2), 1e-10, VERIFY_ABS);
        verify_row("L14", "its phase [rad]", atan2(side, out), 0.0, 1e-9, VERIFY_ABS);
    }
}

/* High pass, band pass and moving mean, measured on sines, against their closed forms. */
static void other_filters(void)
{
    enum { N = 8000, FROM = 3000, TO = 5000 };
    static double x[N], y[N], edge[N + 1];
    static const double freq[] = {0.5, 1.0, 2.0, 4.0, 8.0, 10.0};
    for (int k = 0; k <= N; k++) edge[k] = 0.01 * k;
    for (int j = 0; j < 6; j++) {
        const double t = tan(PI * freq[j] / 100.0), K1 = tan(PI * 2.0 / 100.0), K2 = tan(PI * 8.0 / 100.0);
        const double want[] = {1.0 / (1.0 + pow(K1 / t, 8.0)),
                               1.0 / (1.0 + pow((K1 * K2 - t * t) / ((K2 - K1) * t), 8.0)),
                               sin(PI * freq[j] * 0.31) / (31.0 * sin(PI * freq[j] * 0.01))};
        static const char *const what[] = {"high pass from 2 Hz at 0.5 1 2 4 8 10 Hz: gain",
                                           "band pass 2 to 8 Hz: gain", "moving mean over 0.31 s: gain"};
        for (int k = 0; k < N; k++) x[k] = sin(2.0 * PI * freq[j] * k / 100.0);
        for (int kind = 0; kind < 3; kind++) {
            fl_err err = {0};
            fl_butterworth f;
            double in = 0.0, out = 0.0;
            int rc;
            if (kind == 2) rc = fl_moving_mean(N, edge, x, 0.31, y, &err);
            else
                rc = (kind ? fl_butterworth_band(&f, 4, 2.0, 8.0, 100.0, &err)
                           : fl_butterworth_high(&f, 4, 2.0, 100.0, &err)) ||
                     fl_butterworth_zero_phase(&f, N, x, y, &err);
            for (int k = FROM; k < TO; k++) {
                in += x[k] * x[k];
                out += x[k] * y[k];
            }
            verify_row("L15", what[kind], rc ? (double)NAN : out / in, want[kind], 1e-9, VERIFY_ABS);
        }
    }
}

/* Quantiles, significant value and peak separation where the answer is known. */
static void exponential_sample(void)
{
    const int32_t n = verify_quick() ? 20000 : 400000;
    fl_err err = {0};
    double *x = fl_alloc(n, sizeof *x, &err), *down = fl_alloc(n, sizeof *down, &err), q[3];
    int32_t *rank = fl_alloc(n, sizeof *rank, &err);
    const double p[] = {0.5, 0.9, 0.99};
    fl_rng g = fl_rng_of(1, 0, FL_RNG_TEST);
    int ok = x && down && rank;
    for (int32_t k = 0; ok && k < n; k++) x[k] = -log(1.0 - fl_rng_unit(&g)); /* exponential, mean 1 */
    ok = ok && !fl_compute_quantiles(n, x, NULL, 3, p, q, &err) && !fl_rank_descending(n, x, rank, &err);
    verify_true("L20", "an exponential sample is described", ok);
    if (ok) {
        fl_descriptive_stats d;
        fl_compute_moments(n, x, NULL, &d);
        for (int32_t k = 0; k < n; k++) down[k] = x[rank[k]];
        /* Five standard errors: of a quantile sqrt(p (1 - p) / n) / f(q), with f(q) = 1 - p; of the mean of
         * the highest share a, whose excess over its lower end has mean and deviation 1, sqrt((2 - a) / (a
         * n)); of the shape numbers sqrt(72 / n) and sqrt(8064 / n), by linearising them in the sample
         * moments with the central moments 1, 2, 9, 44, 265, 1854, 14833 of the exponential law. */
        for (int j = 0; j < 3; j++)
            verify_row("L20", "exponential quantile 0.5, 0.9, 0.99", q[j], -log(1.0 - p[j]),
                       5.0 * sqrt(p[j] / (1.0 - p[j]) / n), VERIFY_ABS);
        verify_row("L21", "its highest third, 1 + ln 3", fl_mean_of_highest(n, down, 1.0 / 3.0),
                   1.0 + log(3.0), 5.0 * sqrt(5.0 / n), VERIFY_ABS);
        verify_row("L22", "its highest tenth, 1 + ln 10", fl_mean_of_highest(n, down, 0.1), 1.0 + log(10.0),
                   5.0 * sqrt(19.0 / n), VERIFY_ABS);
        verify_row("L23", "its skewness", d.skew, 2.0, 5.0 * sqrt(72.0 / n), VERIFY_ABS);
        verify_row("L24", "its excess kurtosis", d.kurtosis, 6.0, 5.0 * sqrt(8064.0 / n), VERIFY_ABS);
    }
    free(x);
    free(down);
    free(rank);
}

/* 100 s of |sin(2 pi t / T)| has one separate peak per half period. */
static void separate_peaks(void)
{
    enum { N = 10000 };
    static double x[N];
    fl_peaks p = {0};
    fl_err err = {0};
    for (int k = 0; k < N; k++)
        x[k] = fabs(sin(2.0 * PI * (0.01 * k + 0.005) / 8.0)) * (1.0 + 0.1 * cos(20.0 * PI * 0.01 * k));
    const int failed = fl_peaks_rayleigh(N, x, 0.5, 0.0, &p, &err);
    verify_row("L30", "separate peaks of |sin| with a 10 Hz ripple", failed ? (double)NAN : (double)p.n, 25.0,
               0.0, VERIFY_ABS);
    fl_peaks_free(&p);
}

/* Resampling keeps the impulse for any intervals. */
static void impulse_of_resampling(void)
{
    enum { N = 900, M = 331 };
    static double edge[N + 1], x[N], even[M + 1], y[M];
    double before = 0.0, after = 0.0;
    for (int k = 0; k < N; k++) {
        edge[k + 1] = edge[k] + (k % 7 ? 0.01 : 0.05);
        x[k] = exp(sin(edge[k + 1])) * (k % 50 ? 1.0 : 40.0);
        before += x[k] * (edge[k + 1] - edge[k]);
    }
    fl_resample_means(N, edge, x, M, even, y);
    for (int j = 0; j < M; j++) after += y[j] * (even[j + 1] - even[j]);
    verify_row("L31", "impulse after resampling 900 to 331 intervals", after, before, 1e-13, VERIFY_REL);
}

int main(void)
{
    verify_begin("load statistics");
    describe_sample();
    butterworth_filter();
    zero_phase();
    other_filters();
    exponential_sample();
    separate_peaks();
    impulse_of_resampling();
    return verify_end();
}
