/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/array.h"
#include "base/pi.h"
#include "stat/uniform_step.h"
#include "support/near.h"

static fl_err err;

static int read_text(fl_series *s, const char *data, double after)
{
    static const char *const column[] = {"fx"};
    const fl_record_selection selection = {
        .signal = column, .signals = 1, .from = -INFINITY, .to = INFINITY, .after_first_load = after};
    err = (fl_err){0};
    return fl_series_read(s, test_file("evenly", data, strlen(data)), &selection, &err);
}

/* Rows of 1, 2 and 1 s with 3, 6 and -3 in steps of 1.5 s: 4 and 6, and then 1 s remains. */
static void resampling_by_hand(void **state)
{
    fl_series s;
    fl_resampling_loss loss[2];
    (void)state;
    assert_int_equal(read_text(&s, "#loads 1\nt part fx[N]\n1 a 3\n3 a 6\n4 a -3\n", 0.0), 0);
    assert_int_equal(fl_resample_uniform(&s, 1.5, loss, &err), 0);
    assert_int_equal(s.n, 2);
    assert_near(s.edge[2], 3.0, 0.0);
    assert_near(s.t[0], 1.5, 0.0);
    assert_near(s.x[0][0], 4.0, 1e-15);
    assert_near(s.x[0][1], 6.0, 1e-15);
    assert_near(s.x[1][0], 4.0, 1e-15);
    assert_near(loss[0].largest, 2.0, 1e-15);
    assert_near(loss[0].rms, sqrt((1.0 * 1.0 + 0.5 * 4.0) / 3.0), 1e-15);
    fl_series_free(&s);
    /* A sample represents the times closest to it, and a step its middle. */
    assert_int_equal(read_text(&s, "#energy 1\nt fx\n0 1\n1 3\n2 5\n", 0.0), 0);
    assert_int_equal(fl_resample_uniform(&s, 0.5, loss, &err), 0);
    assert_int_equal(s.n, 6);
    assert_near(s.t[0], -0.25, 1e-15);
    assert_near(s.x[0][3], 3.0, 1e-15);
    assert_near(loss[0].rms, 0.0, 0.0);
    fl_series_free(&s);
}

/* A sine loses A^2 / 2 (1 - (sin(a) / a)^2), a = pi f h, of its mean square, and no mean. */
static void a_sine_has_the_known_loss(void **state)
{
    enum { N = 24000 };
    char *data = malloc(N * 48);
    int n = sprintf(data, "#loads 1\nt part fx[N]\n");
    const double w = 2.0 * PI * 0.25;
    (void)state;
    for (int k = 1; k <= N; k++) {
        const double t = 0.005 * k;
        n += sprintf(data + n, "%.17g a %.17g\n", t, 5.0 + (cos(w * (t - 0.005)) - cos(w * t)) / (w * 0.005));
    }
    for (double h = 0.1; h < 2.1; h *= 2.0) {
        fl_series s;
        fl_resampling_loss loss[2];
        double mean = 0.0, square = 0.0;
        const double a = 0.5 * w * h, expected = 0.5 * (1.0 - pow(sin(a) / a, 2.0));
        assert_int_equal(read_text(&s, data, 0.0), 0);
        double before = 0.0;
        for (int32_t k = 0; k < s.n; k++) before += s.x[0][k] * s.x[0][k] / s.n;
        assert_int_equal(fl_resample_uniform(&s, h, loss, &err), 0);
        assert_near(s.edge[s.n], 120.0, 1e-12);
        for (int32_t k = 0; k < s.n; k++) {
            mean += s.x[0][k] / s.n;
            square += s.x[0][k] * s.x[0][k] / s.n;
        }
        assert_near(mean, 5.0, 1e-12);
        assert_near_of(loss[0].rms * loss[0].rms, expected, 1e-4, 0.5);
        assert_near_of(loss[0].rms * loss[0].rms, before - square, 1e-10, 25.0);
        fl_series_free(&s);
    }
    free(data);
}

static void the_front_can_be_left_out(void **state)
{
    static const char data[] = "#loads 1\nt part fx[N]\n1 a 0\n2 a 0\n3 a 5\n4 a 0\n5 a 1\n6 a 2\n";
    fl_series s;
    char expected[400];
    (void)state;
    assert_int_equal(read_text(&s, data, 2.0), 0);
    assert_near(s.edge[0], 4.0, 0.0); /* the row from 2 to 3 s is the first with a load */
    assert_int_equal(s.n, 2);
    fl_series_free(&s);
    assert_int_equal(read_text(&s, data, 4.5), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_int_equal(read_text(&s, "#loads 1\nt part fx[N]\n1 a 0\n2 a 0\n", 1.0), -1);
    snprintf(expected, sizeof expected, "%s: every load is 0, there is no first load", test_path("evenly"));
    assert_string_equal(err.text, expected);
}

static void limits_and_allocation_failure(void **state)
{
    static const char data[] = "#loads 1\nt part fx[N]\n1 a 3\n2 a 4\n3 a 5\n";
    fl_series s;
    (void)state;
    assert_int_equal(read_text(&s, data, 0.0), 0);
    assert_int_equal(fl_resample_uniform(&s, 3.5, NULL, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text, "steps of 3.5 s in a record of 3 s, expected 1 to 268435455 steps");
    assert_int_equal(fl_resample_uniform(&s, 1e-12, NULL, &err), -1);
    for (long n = 0;; n++) {
        err = (fl_err){0};
        fl_alloc_fail_after(n);
        const int rc = fl_resample_uniform(&s, 0.5, NULL, &err);
        fl_alloc_fail_after(-1);
        if (rc == 0) break;
        assert_int_equal(err.code, FL_SYSTEM);
        assert_int_equal(s.n, 3); /* unchanged */
        assert_near(s.x[0][1], 4.0, 0.0);
    }
    assert_int_equal(s.n, 6);
    fl_series_free(&s);
}

static int remove_files(void **state)
{
    (void)state;
    unlink(test_path("evenly"));
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(resampling_by_hand), cmocka_unit_test(a_sine_has_the_known_loss),
        cmocka_unit_test(the_front_can_be_left_out), cmocka_unit_test(limits_and_allocation_failure)};
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
