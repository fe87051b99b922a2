/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Spectra by Welch's method against scipy 1.10, published windows, and processes of known spectrum. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "stat/power_spectrum.h"
#include "support/verify.h"

static fl_power_spectrum spectrum;

static int estimate_spectrum(int32_t n, const double *x, double fs, int32_t length, int taper)
{
    fl_err err = {0};
    fl_power_spectrum_free(&spectrum);
    return fl_power_spectrum_make(&spectrum, n, x, fs, length, taper, &err) == 0;
}

static double normal_number(fl_rng *g)
{
    const double u = 1.0 - fl_rng_unit(g), v = fl_rng_unit(g);
    return sqrt(-2.0 * log(u)) * cos(2.0 * PI * v);
}

static void sine_spectrum(void)
{
    enum { N = 8000 };
    static double x[N];
    /* Harris 1978, table I, with all its digits. */
    static const double bins[FL_TAPERS] = {1.50, 1.36, 1.73, 1.0};
    static const char *const name[FL_TAPERS] = {"hann", "hamming", "blackman", "none"};
    for (int k = 0; k < N; k++) x[k] = 2.0 * sin(2.0 * PI * 10.0 * k / 100.0);
    verify_true("W01", "2 sin(2 pi 10 t), 100 Hz, Hann 1000, half overlap",
                estimate_spectrum(N, x, 100.0, 1000, FL_TAPER_HANN));
    verify_row("W01", "peak of the spectrum [1/Hz]", spectrum.psd[100], 13.3333, 1e-5, VERIFY_REL);
    verify_row("W01", "its frequency [Hz]", fl_power_spectrum_dominant(&spectrum, NULL), 10.0, 1e-9,
               VERIFY_ABS);
    verify_row("W02", "integral of the spectrum, A^2 / 2", fl_power_spectrum_variance(&spectrum), 2.0, 1e-12,
               VERIFY_REL);
    for (int taper = 0; taper < FL_TAPERS; taper++) {
        char what[80];
        const int ok = estimate_spectrum(N, x, 100.0, 1000, taper);
        snprintf(what, sizeof what, "noise bandwidth of %s [df]", name[taper]);
        verify_row("W03", what, ok ? spectrum.enbw / spectrum.df : (double)NAN, bins[taper], 0.005,
                   VERIFY_ABS);
        verify_row("W04", "integral of the spectrum, A^2 / 2", fl_power_spectrum_variance(&spectrum), 2.0,
                   1e-12, VERIFY_REL);
    }
}

/* A sine between two frequencies is located to a fraction of the bin width. */
static void sine_between_bins(void)
{
    enum { N = 4000, L = 400 };
    static double x[N];
    for (int taper = 0; taper < FL_TAPERS; taper++) {
        double worst = 0.0;
        for (int j = 0; j <= 20; j++) {
            const double f = (10.0 + j / 20.0) / L;
            for (int k = 0; k < N; k++) x[k] = sin(2.0 * PI * f * k + 0.3);
            worst = estimate_spectrum(N, x, 1.0, L, taper)
                        ? fmax(worst, fabs(fl_power_spectrum_dominant(&spectrum, NULL) - f) / spectrum.df)
                        : NAN;
        }
        verify_below("W05", "dominant frequency of a sine between two bins [df]", worst,
                     taper == FL_TAPER_NONE ? 0.2 : 0.02);
    }
}

/* x_k = a x_(k-1) + e_k has P = 2 / (fs |1 - a exp(-2 pi i f / fs)|^2) for normal e of variance 1. */
static void autoregressive_process(void)
{
    enum { L = 256 };
    const int32_t runs = verify_quick() ? 40 : 400, n = 4096;
    const double a = 0.7;
    fl_err err = {0};
    double *x = fl_alloc(n, sizeof *x, &err), held = 0.0, all = 0.0, below = 0.0, ratio = 0.0, power = 0.0;
    int ok = x != NULL;
    for (int run = 0; run < runs && ok; run++) {
        fl_rng g = fl_rng_of(2, run, FL_RNG_TEST);
        double y = normal_number(&g) / sqrt(1.0 - a * a);
        for (int32_t k = 0; k < n; k++) x[k] = y = a * y + normal_number(&g);
        ok = estimate_spectrum(n, x, 1.0, L, FL_TAPER_HANN);
        for (int32_t k = 8; ok && k < spectrum.n - 1; k += 4) { /* far apart, hence independent */
            const double w = 2.0 * PI * k / L;
            const double want = 2.0 / (1.0 - 2.0 * a * cos(w) + a * a);
            double low, high;
            fl_power_spectrum_interval(&spectrum, k, &low, &high);
            held += low <= want && want <= high;
            below += high < want;
            ratio += spectrum.psd[k] / want;
            all += 1.0;
        }
        power += fl_power_spectrum_variance(&spectrum) / runs;
    }
    verify_true("W10", "spectra of an autoregressive process", ok);
    /* Five standard errors: for P over its closed form sqrt(2 / nu) each, for a share sqrt(p (1 - p)); and
     * 1e-3 for the smoothing by the window. */
    verify_row("W10", "spectrum over its closed form", ratio / all, 1.0,
               5.0 * sqrt(2.0 / spectrum.dof / all) + 1e-3, VERIFY_ABS);
    verify_row("W11", "coverage of the 95 % interval", held / all, 0.95, verify_quick() ? 0.02 : 0.01,
               VERIFY_ABS);
    verify_row("W11", "share of intervals that are too low", below / all, 0.025,
               verify_quick() ? 0.015 : 0.007, VERIFY_ABS);
    /* The variance of an estimate of the power is 4 int P^2 / (n dt) over f > 0, here 2 (1 + a^2) /
     * ((1 - a^2)^3 n). */
    verify_row("W12", "power, 1 / (1 - a^2)", power, 1.0 / (1.0 - a * a),
               5.0 * sqrt(2.0 * (1.0 + a * a) / pow(1.0 - a * a, 3.0) / ((double)n * runs)), VERIFY_ABS);
    free(x);
}

/* Unfiltered white noise crosses its mean upward once in four rows.  Its spectrum is flat up to fs / 2, for
 * which Rice gives fs / (2 sqrt 3). */
static void mean_crossings(void)
{
    enum { N = 65536 };
    static double x[N];
    fl_rng g = fl_rng_of(3, 0, FL_RNG_TEST);
    for (int k = 0; k < N; k++) x[k] = normal_number(&g);
    const int ok = estimate_spectrum(N, x, 2.0, 512, FL_TAPER_HANN);
    verify_row("W13", "crossings of white noise, fs / (2 sqrt 3) [Hz]",
               ok ? fl_power_spectrum_crossing_rate(&spectrum) : (double)NAN, 1.0 / sqrt(3.0), 0.01,
               VERIFY_REL);
}

int main(void)
{
    verify_begin("spectra");
    sine_spectrum();
    sine_between_bins();
    autoregressive_process();
    mean_crossings();
    fl_power_spectrum_free(&spectrum);
    return verify_end();
}
