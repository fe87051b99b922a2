/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "stat/power_spectrum.h"
#include "support/near.h"

enum { N = 1000 };

static fl_power_spectrum make_spectrum(int32_t n, const double *x, double fs, int32_t length, int taper)
{
    fl_err err = {0};
    fl_power_spectrum s;
    assert_int_equal(fl_power_spectrum_make(&s, n, x, fs, length, taper, &err), 0);
    return s;
}

/* 2 sin(2 pi 10 t) at 100 Hz in Hann windows of 1000: reference values of scipy 1.10. */
static void a_sine_has_the_spectrum_of_scipy(void **state)
{
    double x[4 * N];
    (void)state;
    for (int k = 0; k < 4 * N; k++) x[k] = 2.0 * sin(2.0 * PI * 10.0 * k / 100.0);
    fl_power_spectrum s = make_spectrum(4 * N, x, 100.0, N, FL_TAPER_HANN);
    assert_int_equal(s.segments, 7);
    assert_int_equal(s.n, 501);
    assert_near(s.psd[100], 13.3333, 1e-5);
    assert_near(fl_power_spectrum_variance(&s), 2.0, 1e-12);
    assert_near(s.enbw / s.df, 1.5, 1e-12);
    int32_t at;
    assert_near(fl_power_spectrum_dominant(&s, &at), 10.0, 1e-12);
    assert_int_equal(at, 100);
    assert_near(fl_power_spectrum_share(&s, at), 1.0, 1e-12);
    /* the lobe has a quarter on either side: sqrt(f^2 + df^2 / 3) */
    assert_near(fl_power_spectrum_crossing_rate(&s), sqrt(100.0 + 0.01 / 3.0), 1e-12);
    fl_power_spectrum_free(&s);
    assert_null(s.psd);
}

/* One segment without a window is the periodogram, for any length. */
static void one_segment_is_the_periodogram(void **state)
{
    static const int32_t length[] = {4, 5, 7, 12, 97, 128};
    (void)state;
    for (size_t j = 0; j < sizeof length / sizeof *length; j++) {
        const int32_t L = length[j];
        fl_rng g = fl_rng_of(test_seed(), L, FL_RNG_TEST);
        double x[128], mean = 0.0;
        for (int k = 0; k < L; k++) mean += (x[k] = fl_rng_in(&g, -1.0, 3.0)) / L;
        fl_power_spectrum s = make_spectrum(L, x, 2.0, L, FL_TAPER_NONE);
        assert_int_equal(s.segments, 1);
        assert_near(s.dof, 2.0, 0.0);
        for (int32_t k = 1; k < s.n; k++) {
            double re = 0.0, im = 0.0;
            for (int i = 0; i < L; i++) {
                re += (x[i] - mean) * cos(2.0 * PI * k * i / L);
                im -= (x[i] - mean) * sin(2.0 * PI * k * i / L);
            }
            assert_near_of(s.psd[k], (2 * k == L ? 1.0 : 2.0) * (re * re + im * im) / (2.0 * L), 1e-12, 1.0);
        }
        fl_power_spectrum_free(&s);
    }
}

/* The power is the weighted square of the transformed values: Parseval, for each window and any length. */
static void power_equals_that_of_the_segments(void **state)
{
    (void)state;
    for (int taper = 0; taper < FL_TAPERS; taper++) {
        for (int32_t L = 4; L < 200; L += 13) {
            double x[N], mean = 0.0, top = 0.0, below = 0.0;
            fl_rng g = fl_rng_of(test_seed(), L, FL_RNG_TEST);
            for (int k = 0; k < N; k++) mean += (x[k] = 5.0 + fl_rng_in(&g, -1.0, 1.0)) / N;
            fl_power_spectrum s = make_spectrum(N, x, 8.0, L, taper);
            for (int j = 0; j < s.segments; j++) {
                for (int i = 0; i < L; i++) {
                    const double u = 2.0 * PI * i / L;
                    const double w = taper == FL_TAPER_HANN       ? 0.5 * (1.0 - cos(u))
                                     : taper == FL_TAPER_HAMMING  ? 0.54 - 0.46 * cos(u)
                                     : taper == FL_TAPER_BLACKMAN ? 0.42 - 0.5 * cos(u) + 0.08 * cos(2.0 * u)
                                                                  : 1.0;
                    const double y = w * (x[j * s.step + i] - mean);
                    top += y * y;
                    below += w * w;
                }
            }
            assert_near(fl_power_spectrum_variance(&s), top / below, 1e-11);
            fl_power_spectrum_free(&s);
        }
    }
}

static void segment_lengths_suit_the_transform(void **state)
{
    (void)state;
    assert_int_equal(fl_spectrum_segment_length(3), 3);
    assert_int_equal(fl_spectrum_segment_length(17), 17);
    assert_int_equal(fl_spectrum_segment_length(18), 4);
    assert_int_equal(fl_spectrum_segment_length(4500), 1000);
    for (int32_t n = 18; n < 100000; n += 37) {
        const int32_t L = fl_spectrum_segment_length(n);
        int32_t rest = L;
        assert_int_equal(L % 2, 0);
        for (int p = 2; p <= 5; p += p == 2 ? 1 : 2)
            while (rest % p == 0) rest /= p;
        assert_int_equal(rest, 1);
        assert_true(9 * (int64_t)L <= 2 * (int64_t)n);
        assert_true(27 * (int64_t)L >
                    4 * (int64_t)n); /* such products are never further apart than a ratio of 6 to 4 */
    }
    assert_true(fl_spectrum_segment_length(INT32_MAX) > 400000000);
}

static void records_without_a_frequency(void **state)
{
    double x[64], low, high;
    int32_t at;
    (void)state;
    for (int k = 0; k < 64; k++) x[k] = 7.0;
    fl_power_spectrum s = make_spectrum(64, x, 1.0, 16, FL_TAPER_HANN);
    assert_near(fl_power_spectrum_variance(&s), 0.0, 0.0);
    assert_true(isnan(fl_power_spectrum_dominant(&s, &at)));
    assert_int_equal(at, -1);
    assert_true(isnan(fl_power_spectrum_crossing_rate(&s)));
    fl_power_spectrum_free(&s);
    /* A slope has fewer than two periods, for every setting. */
    for (int k = 0; k < 64; k++) x[k] = k;
    s = make_spectrum(64, x, 1.0, 64, FL_TAPER_HANN);
    assert_true(isnan(fl_power_spectrum_dominant(&s, NULL)));
    fl_power_spectrum_interval(&s, 0, &low, &high);
    assert_true(low >= 0.0 && low <= s.psd[0] && s.psd[0] <= high);
    fl_power_spectrum_free(&s);
}

static void invalid_limits_are_reported(void **state)
{
    double x[64] = {0};
    fl_err err = {0};
    fl_power_spectrum s;
    (void)state;
    assert_int_equal(fl_power_spectrum_make(&s, 64, x, 1.0, 65, FL_TAPER_HANN, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text, "a segment of 65 rows, expected 4 to all 64 of the record");
    err = (fl_err){0};
    assert_int_equal(fl_power_spectrum_make(&s, 3, x, 1.0, 3, FL_TAPER_HANN, &err), -1);
    for (long n = 0;; n++) {
        err = (fl_err){0};
        fl_alloc_fail_after(n);
        const int rc = fl_power_spectrum_make(&s, 64, x, 1.0, 16, FL_TAPER_HANN, &err);
        fl_alloc_fail_after(-1);
        fl_power_spectrum_free(&s);
        if (rc == 0) break;
        assert_int_equal(err.code, FL_SYSTEM);
    }
    assert_string_equal(fl_taper_name(FL_TAPER_BLACKMAN), "blackman");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_sine_has_the_spectrum_of_scipy),
                                       cmocka_unit_test(one_segment_is_the_periodogram),
                                       cmocka_unit_test(power_equals_that_of_the_segments),
                                       cmocka_unit_test(segment_lengths_suit_the_transform),
                                       cmocka_unit_test(records_without_a_frequency),
                                       cmocka_unit_test(invalid_limits_are_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
