/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/pi.h"
#include "stat/butterworth.h"
#include "support/near.h"

enum { N = 2000 };

/* Order 4, 5 Hz of 100 Hz: the coefficients and gains of scipy 1.10. */
static void known_coefficients(void **state)
{
    static const double a[] = {1.0, -3.18063855, 3.86119435, -2.11215536, 0.43826514};
    static const double binomial[] = {1.0, 4.0, 6.0, 4.0, 1.0};
    fl_err err = {0};
    fl_butterworth f;
    double fb[5], fa[5];
    (void)state;
    assert_int_equal(fl_butterworth_low(&f, 4, 5.0, 100.0, &err), 0);
    assert_int_equal(f.n, 2);
    fl_butterworth_polynomials(&f, fb, fa);
    for (int k = 0; k < 5; k++) {
        assert_near(fa[k], a[k], 1e-8);
        assert_near(fb[k], 4.166e-4 * binomial[k], 1e-4);
    }
    assert_near(fl_butterworth_gain(&f, 1.0), 0.9999988, 1e-7);
    assert_near(fl_butterworth_gain(&f, 5.0), sqrt(0.5), 1e-13);
    assert_near(fl_butterworth_gain(&f, 10.0), 0.0563709, 1e-6);
    assert_near(fl_butterworth_gain(&f, 20.0), 0.0022584, 1e-4);
}

/* Every order has the gain of the closed form at every frequency, one at zero and half the power at fc. */
static void gain_is_the_closed_form(void **state)
{
    (void)state;
    for (int order = 1; order <= FL_BUTTERWORTH_ORDER_MAX; order++) {
        for (double fc = 0.01; fc < 0.5; fc += 0.03) {
            fl_err err = {0};
            fl_butterworth f;
            assert_int_equal(fl_butterworth_low(&f, order, fc, 1.0, &err), 0);
            assert_int_equal(f.n, (order + 1) / 2);
            assert_near(fl_butterworth_gain(&f, 0.0), 1.0, 1e-12);
            for (double freq = 0.005; freq < 0.49; freq += 0.011) {
                const double r = tan(PI * freq) / tan(PI * fc), g = 1.0 / sqrt(1.0 + pow(r, 2.0 * order));
                if (g > 1e-8) assert_near(fl_butterworth_gain(&f, freq), g, 1e-9);
            }
        }
    }
}

/* The mean survives also where the poles lie within 1e-5 of z = 1. */
static void mean_survives_a_very_low_cut(void **state)
{
    fl_err err = {0};
    fl_butterworth f;
    (void)state;
    assert_int_equal(fl_butterworth_low(&f, 4, 1e-6, 1.0, &err), 0);
    for (int k = 0; k < f.n; k++) {
        const fl_biquad s = f.s[k];
        assert_near((s.b0 + s.b1 + s.b2) / (1.0 + s.a1 + s.a2), 1.0, 1e-15);
    }
}

/* A sine inside the pass band comes out with the squared gain and no phase shift. */
static void zero_phase_has_the_squared_gain(void **state)
{
    double x[N], y[N];
    (void)state;
    for (int order = 1; order <= 8; order++) {
        fl_err err = {0};
        fl_butterworth f;
        assert_int_equal(fl_butterworth_low(&f, order, 5.0, 100.0, &err), 0);
        for (int k = 0; k < N; k++) x[k] = 3.0 + sin(2.0 * PI * 4.0 * k / 100.0);
        assert_int_equal(fl_butterworth_zero_phase(&f, N, x, y, &err), 0);
        const double g = fl_butterworth_gain(&f, 4.0);
        for (int k = 800; k < 1200; k++) assert_near_of(y[k], 3.0 + g * g * (x[k] - 3.0), 1e-9, 1.0);
    }
}

static void constants_and_lines_pass(void **state)
{
    double x[N], y[N];
    fl_err err = {0};
    fl_butterworth f;
    (void)state;
    assert_int_equal(fl_butterworth_low(&f, 5, 2.0, 100.0, &err), 0);
    for (int k = 0; k < N; k++) x[k] = 1e6;
    assert_int_equal(fl_butterworth_zero_phase(&f, N, x, y, &err), 0);
    for (int k = 0; k < N; k++) assert_near(y[k], 1e6, 1e-12);
    /* The odd reflection continues a line as a line. Only the start of the pad, decayed long before,
     * differs. */
    for (int k = 0; k < N; k++) x[k] = -5.0 + 0.25 * k;
    assert_int_equal(fl_butterworth_zero_phase(&f, N, x, y, &err), 0);
    for (int k = 0; k < N; k++) assert_near_of(y[k], x[k], 1e-6, 500.0);
    /* in place gives the same */
    assert_int_equal(fl_butterworth_zero_phase(&f, N, x, x, &err), 0);
    assert_memory_equal(x, y, sizeof x);
}

/* Forward and backward: the filtered reverse of a record is the reverse of the filtered record. */
static void ends_are_treated_alike(void **state)
{
    double x[N], back[N], y[N];
    fl_err err = {0};
    fl_butterworth f;
    (void)state;
    assert_int_equal(fl_butterworth_low(&f, 4, 3.0, 100.0, &err), 0);
    for (int k = 0; k < N; k++) x[k] = sin(0.001 * k * k) + (k > 700);
    for (int k = 0; k < N; k++) back[k] = x[N - 1 - k];
    assert_int_equal(fl_butterworth_zero_phase(&f, N, x, y, &err), 0);
    assert_int_equal(fl_butterworth_zero_phase(&f, N, back, back, &err), 0);
    for (int k = 0; k < N; k++) assert_near_of(back[k], y[N - 1 - k], 1e-5, 1.0);
}

/* High and band pass have the closed-form gain for every order, and none at zero frequency. */
static void high_and_band_have_the_closed_gain(void **state)
{
    (void)state;
    for (int order = 1; order <= FL_BUTTERWORTH_ORDER_MAX; order++) {
        for (double fc = 0.01; fc < 0.45; fc += 0.04) {
            const double f2 = fc + 0.03, K1 = tan(PI * fc), K2 = tan(PI * f2), W = sqrt(K1 * K2), B = K2 - K1;
            fl_err err = {0};
            fl_butterworth high, band;
            assert_int_equal(fl_butterworth_high(&high, order, fc, 1.0, &err), 0);
            assert_int_equal(high.n, (order + 1) / 2);
            assert_near(fl_butterworth_gain(&high, 0.0), 0.0, 0.0);
            assert_near(fl_butterworth_gain(&high, fc), sqrt(0.5), 1e-10);
            assert_int_equal(fl_butterworth_band(&band, order, fc, f2, 1.0, &err), 0);
            assert_int_equal(band.n, order);
            assert_near(fl_butterworth_gain(&band, 0.0), 0.0, 0.0);
            assert_near(fl_butterworth_gain(&band, fc), sqrt(0.5), 1e-9);
            assert_near(fl_butterworth_gain(&band, f2), sqrt(0.5), 1e-9);
            for (double freq = 0.005; freq < 0.49; freq += 0.011) {
                const double t = tan(PI * freq), h = 1.0 / sqrt(1.0 + pow(K1 / t, 2.0 * order));
                const double b = 1.0 / sqrt(1.0 + pow((W * W - t * t) / (B * t), 2.0 * order));
                if (h > 1e-8) assert_near(fl_butterworth_gain(&high, freq), h, 1e-9);
                if (b > 1e-8) assert_near(fl_butterworth_gain(&band, freq), b, 1e-8);
            }
        }
    }
}

/* Constantinides 1970: a band pass is the low pass of the cut f2 - f1 with
 * z^-1 -> -z^-1 (z^-1 - c) / (1 - c z^-1),
 * so that both have the same b0 and, but for the sign, the same last a; the numerator is (1 - z^-2)^N. */
static void a_band_pass_is_a_transformed_low_pass(void **state)
{
    (void)state;
    for (int order = 1; order <= 6; order++) {
        fl_err err = {0};
        fl_butterworth low, band;
        double lb[7], la[7], bb[13], ba[13], binomial = 1.0;
        assert_int_equal(fl_butterworth_low(&low, order, 5.0, 100.0, &err), 0);
        assert_int_equal(fl_butterworth_band(&band, order, 5.0, 10.0, 100.0, &err), 0);
        assert_int_equal(band.degree, 2 * order);
        fl_butterworth_polynomials(&low, lb, la);
        fl_butterworth_polynomials(&band, bb, ba);
        assert_near(ba[2 * order], (order % 2 ? -1.0 : 1.0) * la[order], 1e-12);
        for (int k = 0; k <= order; k++) {
            assert_near_of(bb[2 * k], (k % 2 ? -1.0 : 1.0) * binomial * lb[0], 1e-12, lb[0]);
            if (k < order) assert_near_of(bb[2 * k + 1], 0.0, 1e-14, lb[0]);
            binomial = binomial * (order - k) / (k + 1.0);
        }
    }
}

/* A constant and a straight line leave nothing; a sine inside the band comes out with the squared gain. */
static void drift_is_removed(void **state)
{
    double x[N], y[N];
    fl_err err = {0};
    fl_butterworth f[2];
    (void)state;
    for (int order = 1; order <= 5; order++) {
        assert_int_equal(fl_butterworth_high(&f[0], order, 2.0, 100.0, &err), 0);
        assert_int_equal(fl_butterworth_band(&f[1], order, 2.0, 8.0, 100.0, &err), 0);
        for (int j = 0; j < 2; j++) {
            for (int k = 0; k < N; k++) x[k] = 1e6;
            assert_int_equal(fl_butterworth_zero_phase(&f[j], N, x, y, &err), 0);
            for (int k = 0; k < N; k++) assert_near_of(y[k], 0.0, 1e-9, 1e6);
            for (int k = 0; k < N; k++) x[k] = 500.0 - 0.25 * k + 3.0 * sin(2.0 * PI * 4.0 * k / 100.0);
            assert_int_equal(fl_butterworth_zero_phase(&f[j], N, x, y, &err), 0);
            const double g = fl_butterworth_gain(&f[j], 4.0);
            for (int k = 800; k < 1200; k++)
                assert_near_of(y[k], 3.0 * g * g * sin(2.0 * PI * 4.0 * k / 100.0), 1e-5, 3.0);
        }
    }
}

/* The pad is long enough: an impulse has decayed at its end. */
static void impulses_decay_within_the_pad(void **state)
{
    enum { LONG = 20000 };
    static double x[LONG], y[LONG];
    (void)state;
    for (int order = 1; order <= 8; order++) {
        for (int kind = 0; kind < 4; kind++) {
            fl_err err = {0};
            fl_butterworth f;
            const int rc = kind == 0   ? fl_butterworth_low(&f, order, 2.0, 100.0, &err)
                           : kind == 1 ? fl_butterworth_high(&f, order, 2.0, 100.0, &err)
                           : kind == 2 ? fl_butterworth_band(&f, order, 2.0, 30.0, 100.0, &err)
                                       : fl_butterworth_band(&f, order, 10.0, 12.0, 100.0, &err);
            assert_int_equal(rc, 0);
            for (int k = 0; k < LONG; k++) x[k] = k == LONG / 2;
            assert_int_equal(fl_butterworth_zero_phase(&f, LONG, x, y, &err), 0);
            double worst = 0.0, top = 0.0;
            const int pad = (int)fl_butterworth_pad(&f);
            for (int k = 0; k < LONG; k++) {
                top = fmax(top, fabs(y[k]));
                if (abs(k - LONG / 2) > pad) worst = fmax(worst, fabs(y[k]));
            }
            assert_true(worst < 1e-4 * top);
        }
    }
}

static void invalid_limits_are_reported(void **state)
{
    fl_err err = {0};
    fl_butterworth f;
    double x[300] = {0};
    (void)state;
    assert_int_equal(fl_butterworth_low(&f, 4, 50.0, 100.0, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text,
                        "filter at 50 Hz, expected more than 0 and less than 50 Hz, half the sampling rate");
    err = (fl_err){0};
    assert_int_equal(fl_butterworth_low(&f, 21, 5.0, 100.0, &err), -1);
    assert_string_equal(err.text, "filter of order 21, expected 1 to 20");
    err = (fl_err){0};
    assert_int_equal(fl_butterworth_low(&f, 4, NAN, 100.0, &err), -1);
    err = (fl_err){0};
    assert_int_equal(fl_butterworth_low(&f, 4, 5.0, 100.0, &err), 0);
    assert_near(fl_butterworth_pad(&f), 240.0, 0.0);
    assert_int_equal(fl_butterworth_zero_phase(&f, 240, x, x, &err), -1);
    assert_string_equal(
        err.text,
        "the record of 240 rows is too short for a filter of order 4 at 5 Hz, which needs more than 240");
    err = (fl_err){0};
    assert_int_equal(fl_butterworth_zero_phase(&f, 241, x, x, &err), 0);
    err = (fl_err){0};
    assert_int_equal(fl_butterworth_band(&f, 4, 5.0, 5.0, 100.0, &err), -1);
    assert_string_equal(err.text, "filter from 5 Hz to 5 Hz, expected the second above the first");
    err = (fl_err){0};
    assert_int_equal(fl_butterworth_band(&f, 4, 5.0, 50.0, 100.0, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_int_equal(fl_butterworth_high(&f, 4, 0.0, 100.0, &err), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(known_coefficients),
                                       cmocka_unit_test(gain_is_the_closed_form),
                                       cmocka_unit_test(mean_survives_a_very_low_cut),
                                       cmocka_unit_test(zero_phase_has_the_squared_gain),
                                       cmocka_unit_test(constants_and_lines_pass),
                                       cmocka_unit_test(ends_are_treated_alike),
                                       cmocka_unit_test(high_and_band_have_the_closed_gain),
                                       cmocka_unit_test(a_band_pass_is_a_transformed_low_pass),
                                       cmocka_unit_test(drift_is_removed),
                                       cmocka_unit_test(impulses_decay_within_the_pad),
                                       cmocka_unit_test(invalid_limits_are_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
