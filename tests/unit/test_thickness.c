/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "support/near.h"
#include "base/array.h"
#include "ice/thickness.h"

enum { N = 20000 };

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double draw_sample(const fl_thickness *t, uint64_t seed, double min_thickness, double *h, double *mean,
                          double *cv)
{
    double sum = 0.0, square = 0.0;
    for (int32_t i = 0; i < N; i++) {
        int32_t again;
        h[i] = fl_thickness_draw(t, seed, i, min_thickness, &again);
        assert_true(h[i] > min_thickness);
        sum += h[i];
        square += h[i] * h[i];
    }
    *mean = sum / N;
    *cv = sqrt(square / N - *mean * *mean) / *mean;
    qsort(h, N, sizeof *h, ascending);
    return fl_thickness_ks_distance(t, min_thickness, N, h);
}

/* Kolmogorov's distance of N numbers exceeds 1.95 / sqrt(N) once in a thousand times: 0.0138. */
static void numbers_follow_their_law(void **state)
{
    (void)state;
    static double h[N];
    double mean, cv;
    fl_thickness t = {0};
    fl_err err = {0};
    assert_int_equal(fl_thickness_parse(&t, "uniform:0.5,1.5", &err), 0);
    assert_true(draw_sample(&t, 1, 0.0, h, &mean, &cv) < 1.95 / sqrt(N));
    assert_near(mean, 1.0, 0.01);
    assert_near(cv, 1.0 / sqrt(12.0), 0.02);
    assert_true(draw_sample(&t, 1, 0.9, h, &mean, &cv) < 1.95 / sqrt(N)); /* those above 0.9 */
    assert_near(mean, 1.2, 0.01);
    assert_int_equal(fl_thickness_parse(&t, "lognormal:0.7,0.5", &err), 0);
    assert_true(draw_sample(&t, 2, 0.0, h, &mean, &cv) < 1.95 / sqrt(N));
    assert_near(mean, 0.7, 0.015);
    assert_near(cv, 0.5, 0.04);
    assert_true(draw_sample(&t, 2, 0.4, h, &mean, &cv) < 1.95 / sqrt(N));
    assert_int_equal(fl_thickness_read(&t, test_file("h", "h[m] count\n0.8 3\n0.2 1\n0.8 1\n", 29), &err), 0);
    assert_int_equal(t.n, 2);
    assert_true(draw_sample(&t, 3, 0.0, h, &mean, &cv) < 1.95 / sqrt(N));
    assert_near(mean, 0.68, 0.01);
    assert_true(fl_thickness_cdf(&t, 0.0, 0.2) == 0.2 && fl_thickness_cdf(&t, 0.0, 0.1999) == 0.0);
    assert_true(fl_thickness_cdf(&t, 0.2, 0.5) == 0.0 && fl_thickness_cdf(&t, 0.2, 0.8) == 1.0);
    fl_thickness_free(&t);
}

/* The number of a floe depends on the seed and the id alone; one below the minimum is drawn again. */
static void numbers_depend_on_the_floe_alone(void **state)
{
    (void)state;
    fl_thickness t = {0};
    fl_err err = {0};
    int32_t again, drawn = 0;
    assert_int_equal(fl_thickness_parse(&t, "lognormal:0.7,0.5", &err), 0);
    for (int32_t i = 0; i < 200; i++) {
        const double a = fl_thickness_draw(&t, 7, i, 0.0, &again),
                     b = fl_thickness_draw(&t, 7, i, 0.5, &again);
        assert_true(a == fl_thickness_draw(&t, 7, i, 0.0, &again));
        assert_true(again == 0);
        if (a > 0.5) assert_true(a == b);
        fl_thickness_draw(&t, 7, i, 0.5, &again);
        assert_true((again > 0) == (a <= 0.5));
        drawn += again;
    }
    assert_true(drawn > 10);
    assert_true(fl_thickness_draw(&t, 7, 1, 1e5, &again) == 0.0);
    assert_int_equal(fl_thickness_parse(&t, "0.25", &err), 0);
    assert_true(fl_thickness_draw(&t, 7, 1, 0.0, &again) == 0.25 &&
                fl_thickness_draw(&t, 7, 1, 0.3, &again) == 0.0);
}

static void invalid_laws_are_reported(void **state)
{
    (void)state;
    static const char *const usage[] = {
        "0",           "-1",           "1e9",           "uniform:1",     "uniform:2,1",
        "uniform:0,1", "uniform:1,1",  "lognormal:1,0", "lognormal:1,a", "lognormal:",
        "weibull:2",   "uniform:1,2,3"};
    static const char *const file[] = {"",        "h[m]\n",   "0\n",         "a\n",  "1 0\n",
                                       "1 2 3\n", "1 2\n3\n", "h[m]\n1 2\n", "1e9\n"};
    fl_thickness t = {0};
    for (size_t k = 0; k < sizeof usage / sizeof *usage; k++) {
        fl_err err = {0};
        assert_int_equal(fl_thickness_parse(&t, usage[k], &err), -1);
        assert_int_equal(err.code, FL_USAGE);
    }
    for (size_t k = 0; k < sizeof file / sizeof *file; k++) {
        fl_err err = {0};
        assert_int_equal(fl_thickness_parse(&t, test_file("h", file[k], strlen(file[k])), &err), -1);
        assert_int_equal(err.code, FL_INPUT);
        assert_null(t.h);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_follow_their_law),
                                       cmocka_unit_test(numbers_depend_on_the_floe_alone),
                                       cmocka_unit_test(invalid_laws_are_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
