/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/pi.h"
#include "support/near.h"
#include "ice/sizes.h"
#include "ice/sizes_law.h"
#include "ice/sizes_read.h"

enum { N = 1000 };

/* n areas have the given mean, ascend, and are as close to the law as n of them can be. */
static void expect_law(const fl_sizes *s, double mean)
{
    static double a[N];
    for (int32_t n = 1; n <= N; n = n < 8 ? n + 1 : n * 5) {
        double sum = 0.0;
        fl_sizes_areas(s, n, mean, a);
        for (int32_t k = 0; k < n; k++) {
            assert_true(a[k] > 0.0 && (k == 0 || a[k] >= a[k - 1]));
            sum += a[k];
        }
        assert_near(sum, n * mean, 1e-12);
        assert_true(fl_sizes_ks_distance(s, mean, n, a) <= 1.0 / n + 1e-12);
    }
}

static void areas_follow_the_law(void **state)
{
    (void)state;
    static const double beta[] = {-1.0, 0.5, 1.0, 1.0 + 1e-14, 1.87, 2.0, 3.0, 3.0 - 1e-14, 4.5};
    expect_law(&(fl_sizes){.kind = FL_SIZES_EQUAL}, 3.0);
    for (double cv = 0.01; cv < 5.0; cv *= 3.0)
        expect_law(&(fl_sizes){.kind = FL_SIZES_LOGNORMAL, .mean = 10.0, .cv = cv}, 7.0);
    for (double k = 0.4; k < 20.0; k *= 2.0) expect_law(&(fl_sizes){.kind = FL_SIZES_WEIBULL, .k = k}, 1e-3);
    for (size_t k = 0; k < sizeof beta / sizeof *beta; k++)
        expect_law(&(fl_sizes){.kind = FL_SIZES_POWER, .beta = beta[k], .dmin = 0.5, .dmax = 50.0}, 20.0);
}

/* Closed forms: the mean area of n(D) ~ D^-3 on [1, 10] is (pi/4) ln 10 / (1/2 (1 - 1/100)); the exponential
 * law is the Weibull law of shape 1; half of the diameters of n(D) ~ D^-1 lie below the geometric middle. */
static void known_values(void **state)
{
    (void)state;
    const fl_sizes cubic = {.kind = FL_SIZES_POWER, .beta = 3.0, .dmin = 1.0, .dmax = 10.0};
    const fl_sizes flat = {.kind = FL_SIZES_POWER, .beta = 1.0, .dmin = 1.0, .dmax = 100.0};
    const fl_sizes exponential = {.kind = FL_SIZES_WEIBULL, .k = 1.0};
    const fl_sizes lognormal = {.kind = FL_SIZES_LOGNORMAL, .mean = 4.0, .cv = sqrt(exp(1.0) - 1.0)};
    assert_near(fl_sizes_mean(&cubic), 0.25 * PI * log(10.0) / 0.495, 1e-14);
    assert_near(fl_sizes_cdf(&cubic, fl_sizes_mean(&cubic), PI), (1.0 - 0.25) / (1.0 - 0.01), 1e-13);
    assert_near(fl_sizes_cdf(&flat, fl_sizes_mean(&flat), 25.0 * PI), 0.5, 1e-13);
    assert_near(fl_sizes_cdf(&exponential, 2.0, 2.0), 1.0 - exp(-1.0), 1e-14);
    /* the median is the mean over sqrt(1 + cv^2) */
    assert_near(fl_sizes_cdf(&lognormal, 4.0, 4.0 * exp(-0.5)), 0.5, 1e-14);
}

static void the_distance_detects_deviations(void **state)
{
    (void)state;
    const fl_sizes s = {.kind = FL_SIZES_WEIBULL, .k = 1.0};
    const fl_sizes equal = {.kind = FL_SIZES_EQUAL};
    static double a[N];
    double worst = 0.0;
    for (int32_t k = 0; k < N; k++) a[k] = -2.0 * log1p(-(k + 0.5) / N); /* twice the size */
    for (double x = 0.0; x < 5.0; x += 1e-4) worst = fmax(worst, exp(-0.5 * x) - exp(-x));
    assert_near_of(fl_sizes_ks_distance(&s, 1.0, N, a), worst, 1.0, 1.5 / N);
    for (int32_t k = 0; k < 4; k++) a[k] = k < 3 ? 1.0 + 1e-6 * k : 1.1;
    assert_near(fl_sizes_ks_distance(&equal, 1.0, 4, a), 0.25, 1e-12);
}

static void size_lists_are_read(void **state)
{
    (void)state;
    static const char areas[] = "# of an image\n3\n1 # small\n\n2\n", d[] = "d[m]\n2\n";
    fl_sizes s = {0};
    fl_err err = {0};
    double a[3];
    assert_int_equal(fl_sizes_read(&s, test_file("areas", areas, strlen(areas)), &err), 0);
    assert_int_equal(s.n, 3);
    assert_near(fl_sizes_mean(&s), 2.0, 1e-15);
    fl_sizes_areas(&s, 3, 4.0, a);
    assert_near(a[0], 2.0, 1e-15);
    assert_near(a[2], 6.0, 1e-15);
    expect_law(&s, 5.0);
    fl_sizes_free(&s);
    assert_int_equal(fl_sizes_read(&s, test_file("d", d, strlen(d)), &err), 0);
    assert_near(s.area[0], PI, 1e-15);
    fl_sizes_free(&s);
}

static void bad_lists_are_reported(void **state)
{
    (void)state;
    static const char *const bad[][2] = {
        {"", ": the file ends without a size, one a row is expected"},
        {"1\n-2\n", ":2: size -2 found"},
        {"1\nd[m]\n", ":2: "},
        {"1 2\n", ":1: "},
        {"area[m2]\n", "without a size"},
        {"1e13\n", ":1: size 1e+13 found"},
        {"area[m2] count\n1 0\n", ":2: count 0 found"},
        {"area[m2] count\n1\n", ":2: "},
        {"x[m] y[m]\n\n", "a polygon is expected"},
        {"x[m] y[m]\n0 0\n1 0\n0 0\n\n", ":2: a polygon of 2 different corners"},
        {"x[m] y[m]\n\n0 0\n4 4\n4 0\n0 4\n", ":3: the polygon of 4 corners crosses"},
        {"x[m] y[m]\n0 0\n1e10 0\n", ":3: corner (1e+10, 0) found"}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        fl_sizes s = {0};
        fl_err err = {0};
        assert_int_equal(fl_sizes_read(&s, test_file("bad", bad[k][0], strlen(bad[k][0])), &err), -1);
        assert_int_equal(err.code, FL_INPUT);
        if (!strstr(err.text, bad[k][1])) fail_msg("case %zu says %s", k, err.text);
        assert_null(s.area);
    }
}

/* A table of sizes and counts equals the list with each size repeated. */
static void tables_equal_lists(void **state)
{
    (void)state;
    static const char table[] = "area[m2] count\n5 2\n1 3\n", list[] = "1\n1\n1\n5\n5\n";
    fl_sizes t = {0}, l = {0};
    fl_err err = {0};
    double a[N], b[N];
    assert_int_equal(fl_sizes_read(&t, test_file("table", table, strlen(table)), &err), 0);
    assert_int_equal(fl_sizes_read(&l, test_file("list", list, strlen(list)), &err), 0);
    assert_near(fl_sizes_mean(&t), 13.0 / 5.0, 1e-15);
    for (int32_t n = 1; n <= N; n = n < 8 ? n + 1 : n * 5) {
        fl_sizes_areas(&t, n, 7.0, a);
        fl_sizes_areas(&l, n, 7.0, b);
        for (int32_t k = 0; k < n; k++) assert_near(a[k], b[k], 1e-12);
        assert_near_of(fl_sizes_ks_distance(&t, 7.0, n, a), fl_sizes_ks_distance(&l, 7.0, n, b), 1e-12, 1.0);
    }
    for (double x = 0.5; x < 6.0; x += 0.25)
        assert_near_of(fl_sizes_cdf(&t, 2.6, x), fl_sizes_cdf(&l, 2.6, x), 1e-15, 1.0);
    expect_law(&t, 5.0);
    fl_sizes_free(&t);
    fl_sizes_free(&l);
}

/* The areas of polygons of either orientation, closed or not, far from the origin. */
static void polygons_are_read_as_areas(void **state)
{
    (void)state;
    static const char text[] = "x[m] y[m]\n0 0\n4 0\n4 3\n\n\n1e6 1e6\n1e6 1000002\n# a remark\n"
                               "1000002 1000002\n1000002 1e6\n1e6 1e6\n>\n0 0\n4 0\n4 4\n2 1\n0 4";
    fl_sizes s = {0};
    fl_err err = {0};
    assert_int_equal(fl_sizes_read(&s, test_file("polygons", text, strlen(text)), &err), 0);
    assert_int_equal(s.n, 3);
    assert_near(s.area[0], 4.0, 1e-12);
    assert_near(s.area[1], 6.0, 1e-15);
    assert_near(s.area[2], 10.0, 1e-15);
    fl_sizes_free(&s);
}

/* Four names of one law: n(D) ~ D^-3.5. */
static void laws_of_one_exponent_have_many_names(void **state)
{
    (void)state;
    static const char *const same[] = {"power:3.5,2,50,number,density", "power:2.5,2,50",
                                       "power:2.5,2,50,number,cumulative", "power:1.5,2,50,area,density",
                                       "power:0.5,2,50,area,cumulative"};
    char name[FL_SIZES_LAW_LEN], again[FL_SIZES_LAW_LEN];
    fl_sizes s, t;
    fl_err err = {0};
    for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
        assert_int_equal(fl_sizes_parse(&s, name, same[k], &err), 0);
        assert_int_equal(s.kind, FL_SIZES_POWER);
        assert_near(s.beta, 3.5, 1e-15);
        assert_true(s.dmin == 2.0 && s.dmax == 50.0);
        assert_int_equal(fl_sizes_parse(&t, again, name, &err), 0);
        assert_string_equal(name, again);
        assert_near(t.beta, 3.5, 1e-15);
    }
    assert_int_equal(fl_sizes_parse(&s, name, same[1], &err), 0);
    assert_string_equal(name, same[2]);
    assert_int_equal(fl_sizes_parse(&s, name, "weibull:0.70", &err), 0);
    assert_string_equal(name, "weibull:0.7");
    assert_int_equal(fl_sizes_parse(&s, name, "lognormal:2", &err), 0);
    assert_true(s.kind == FL_SIZES_LOGNORMAL && s.cv == 2.0);
}

static void bad_laws_are_reported(void **state)
{
    (void)state;
    static const char *const bad[] = {"equal:1",
                                      "lognormal",
                                      "lognormal:",
                                      "lognormal:0",
                                      "lognormal:1,2",
                                      "weibull:-1",
                                      "weibull:nan",
                                      "power:1,2",
                                      "power:1,2,1",
                                      "power:1,0,1",
                                      "power:1,1,1",
                                      "power:30,1,2",
                                      "power:1,1,2,number",
                                      "power:1,1,2,numbers,density",
                                      "power:1,1,2,area,densities",
                                      "power:1,1,2,area,density,",
                                      "power:1,,2",
                                      "gamma:2"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        fl_sizes s = {.cv = -7.0};
        char name[FL_SIZES_LAW_LEN] = "untouched";
        fl_err err = {0};
        assert_int_equal(fl_sizes_parse(&s, name, bad[k], &err), -1);
        assert_int_equal(err.code, FL_USAGE);
        assert_non_null(strstr(err.text, "is expected"));
        assert_string_equal(name, "untouched");
        assert_true(s.cv == -7.0);
    }
    assert_true(fl_sizes_is_law("weibull:x") && fl_sizes_is_law("power"));
    assert_false(fl_sizes_is_law("powers") || fl_sizes_is_law("./power:1") || fl_sizes_is_law(""));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(areas_follow_the_law),
        cmocka_unit_test(known_values),
        cmocka_unit_test(the_distance_detects_deviations),
        cmocka_unit_test(size_lists_are_read),
        cmocka_unit_test(bad_lists_are_reported),
        cmocka_unit_test(tables_equal_lists),
        cmocka_unit_test(polygons_are_read_as_areas),
        cmocka_unit_test(laws_of_one_exponent_have_many_names),
        cmocka_unit_test(bad_laws_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
