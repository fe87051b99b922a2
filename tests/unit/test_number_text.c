/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/number_text.h"
#include "base/rng.h"
#include "support/near.h"

static void shortest_text(void **state)
{
    static const struct {
        double x;
        const char *text;
    } known[] = {{0.0, "0"},
                 {-0.0, "0"},
                 {1.0, "1"},
                 {-1.5, "-1.5"},
                 {0.1, "0.1"},
                 {0.3, "0.3"},
                 {0.1 + 0.2, "0.30000000000000004"},
                 {1.0 / 3.0, "0.3333333333333333"},
                 {1e22, "1e+22"},
                 {100000.0, "100000"},
                 {6.02214076e23, "6.02214076e+23"},
                 {5e-324, "4.94065645841247e-324"}};
    char buf[FL_NUMBER_LEN];
    (void)state;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        assert_string_equal(fl_number_text(known[k].x, buf), known[k].text);
    /* 16 digits of the largest double round up beyond it and read as infinity: 17 are needed. */
    assert_string_equal(fl_number_text(1.7976931348623157e308, buf), "1.7976931348623157e+308");
}

/* Doubles of every magnitude, by random bits. */
static void text_reads_back(void **state)
{
    (void)state;
    const long n = test_times(200000);
    for (long k = 0; k < n; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const uint64_t bits = fl_rng_u64(&g);
        double x, y = 0.0;
        char buf[FL_NUMBER_LEN];
        memcpy(&x, &bits, sizeof x);
        if (!isfinite(x)) continue;
        fl_number_text(x, buf);
        assert_true(strlen(buf) < FL_NUMBER_LEN);
        if (fl_number_f64(buf, &y) || memcmp(&x, &y, sizeof x) != 0) {
            print_error("seed %llu case %ld: %a prints as %s\n", (unsigned long long)test_seed(), k, x, buf);
            fail();
        }
    }
}

/* The text equals the shortest text of the C library that reads back. */
static void compare_with_library(double x)
{
    char buf[FL_NUMBER_LEN], library_text[FL_NUMBER_LEN];
    if (!isfinite(x) || x == 0.0) return;
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(library_text, sizeof library_text, "%.*g", digits, x);
        if (strtod(library_text, NULL) == x) break;
    }
    assert_string_equal(fl_number_text(x, buf), library_text);
}

/* Random bits, coordinates, thousandths, integers, decimals of every length and size; every power of ten and
 * of two with its neighbours; exact halves of the last digit. */
static void text_equals_that_of_the_library(void **state)
{
    (void)state;
    const long n = test_times(20000);
    for (long k = 0; k < n; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const uint64_t bits = fl_rng_u64(&g);
        char text[40];
        double x;
        memcpy(&x, &bits, sizeof x);
        compare_with_library(x);
        snprintf(text, sizeof text, "%.*e", (int)(fl_rng_u64(&g) % 18), x);
        compare_with_library(strtod(text, NULL));
        compare_with_library(fl_rng_in(&g, -1e3, 1e3));
        compare_with_library(round(fl_rng_in(&g, -1e6, 1e6)) / 1000.0);
        for (double size = 1e-6; size < 1e9; size *= 10.0)
            compare_with_library(
                (double)(float)fl_rng_in(&g, -size, size)); /* the last digit is often a half */
        compare_with_library((double)(fl_rng_u64(&g) >> fl_rng_u64(&g) % 64));
        compare_with_library(ldexp((double)(fl_rng_u64(&g) % 1000000), (int)(fl_rng_u64(&g) % 160) - 80));
    }
    for (int e = -330; e <= 308; e++)
        for (int d = 1; d < 100; d++) {
            char text[40];
            snprintf(text, sizeof text, "%de%d", d, e);
            const double x = strtod(text, NULL);
            compare_with_library(x);
            compare_with_library(-nextafter(x, 0.0));
            compare_with_library(nextafter(x, INFINITY));
        }
    for (int e = -1074; e < 1024; e++)
        for (int m = 1; m < 8; m += 2) {
            compare_with_library(ldexp(m, e));
            compare_with_library(nextafter(ldexp(m, e), 0.0));
            compare_with_library(nextafter(ldexp(m, e), INFINITY));
        }
}

static void non_finite_numbers_as_text(void **state)
{
    char buf[FL_NUMBER_LEN];
    (void)state;
    assert_non_null(strstr(fl_number_text(NAN, buf), "nan"));
    assert_string_equal(fl_number_text(INFINITY, buf), "inf");
    assert_string_equal(fl_number_text(-INFINITY, buf), "-inf");
}

static void reads_doubles(void **state)
{
    static const struct {
        const char *s;
        double x;
    } good[] = {{"0", 0},
                {"-0", 0},
                {"+1", 1},
                {"1.", 1},
                {".5", 0.5},
                {"1e3", 1000},
                {"1E+3", 1000},
                {"-2.5e-3", -0.0025},
                {"4.9e-324", 5e-324},
                {"007", 7},
                {"1e-400", 0},
                {"1.7976931348623157e308", 1.7976931348623157e308}};
    static const char *const bad[] = {"",      " 1",    "1 ",  "nan", "inf", "-inf",  "infinity", "0x10",
                                      "1e309", "1e",    "e1",  ".",   "-",   "--1",   "1.2.3",    "1,5",
                                      "1d3",   "1e5.0", "1\n", "12a", "+-1", "1_000", "NaN(1)"};
    (void)state;
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        double x = 99;
        if (fl_number_f64(good[k].s, &x)) fail_msg("\"%s\" was refused", good[k].s);
        assert_true(x == good[k].x);
    }
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        double x = 99;
        if (fl_number_f64(bad[k], &x) != -1) fail_msg("\"%s\" was accepted for %g", bad[k], x);
        assert_true(x == 99); /* unchanged */
    }
}

static void reads_integers(void **state)
{
    int32_t x = 99;
    static const char *const bad[] = {"",   "1.0", "1e3", "2147483648", "-2147483649", "99999999999999999999",
                                      " 1", "1 ",  "0x1", "-",          "+",           "1-",
                                      "--1"};
    (void)state;
    assert_int_equal(fl_number_i32("2147483647", INT32_MIN, INT32_MAX, &x), 0);
    assert_int_equal(x, INT32_MAX);
    assert_int_equal(fl_number_i32("-2147483648", INT32_MIN, INT32_MAX, &x), 0);
    assert_int_equal(x, INT32_MIN);
    assert_int_equal(fl_number_i32("+7", 0, 7, &x), 0);
    assert_int_equal(x, 7);
    assert_int_equal(fl_number_i32("8", 0, 7, &x), -1);
    assert_int_equal(fl_number_i32("-1", 0, 7, &x), -1);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        if (fl_number_i32(bad[k], INT32_MIN, INT32_MAX, &x) != -1)
            fail_msg("\"%s\" was accepted for %d", bad[k], x);
    assert_int_equal(x, 7);
}

static void reads_seeds(void **state)
{
    uint64_t x = 99;
    static const char *const bad[] = {"", "-1", "+1", "18446744073709551616", "1.0", " 1", "1 ", "0x1"};
    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        if (fl_number_u64(bad[k], &x) != -1) fail_msg("\"%s\" was accepted", bad[k]);
    assert_true(x == 99);
    assert_int_equal(fl_number_u64("18446744073709551615", &x), 0);
    assert_true(x == UINT64_MAX);
    assert_int_equal(fl_number_u64("0", &x), 0);
    assert_true(x == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(shortest_text),
                                       cmocka_unit_test(text_reads_back),
                                       cmocka_unit_test(non_finite_numbers_as_text),
                                       cmocka_unit_test(reads_doubles),
                                       cmocka_unit_test(reads_integers),
                                       cmocka_unit_test(reads_seeds),
                                       cmocka_unit_test(text_equals_that_of_the_library)};
    return cmocka_run_group_tests_name("number_text", tests, NULL, NULL);
}
