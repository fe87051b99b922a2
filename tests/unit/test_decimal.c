/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/decimal.h"
#include "base/rng.h"
#include "support/near.h"

enum { TEXT = 2000 };

/* The same bits and the same end as strtod(), for a text that begins with a number. */
static void compare_with_strtod(const char *text, long k)
{
    char *end;
    const double expected = strtod(text, &end);
    double x = 99.0;
    const char *stop = fl_decimal_read(text, &x);
    if (stop == end && memcmp(&x, &expected, sizeof x) == 0) return;
    print_error("seed %llu case %ld: \"%s\" reads as %a, %a is expected\n", (unsigned long long)test_seed(),
                k, text, x, expected);
    fail();
}

static void known_texts(void **state)
{
    /* Ties, ends of the range, subnormals, long digit strings, and known hard cases. */
    static const char *const text[] = {
        "0",
        "-0",
        "+0.0e-999",
        "1",
        "9007199254740992",
        "9007199254740993",
        "9007199254740993.0000000000000000000000000000000000000001",
        "9007199254740992.5",
        "9007199254740991.5",
        "9007199254740994.999999999999999999999999999999",
        "18446744073709551615",
        "18446744073709551616",
        "99999999999999999999999999999999999999999999",
        "1e22",
        "1e23",
        "8.5e22",
        "1e-22",
        "1e-23",
        "3.5e-24",
        "4.9e-324",
        "2.4703282292062327e-324",
        "2.4703282292062328e-324",
        "2.2250738585072014e-308",
        "2.2250738585072011e-308",
        "2.225073858507201e-308",
        "1.7976931348623157e308",
        "1.7976931348623158e308",
        "1.7976931348623159e308",
        "1e309",
        "-1e400",
        "1e-400",
        "1e99999999999999999999",
        "1e-99999999999999999999",
        "0e99999999999999999999",
        "0.000000000000000000000000000000000000000000000000000000000000001234567890123",
        "123456789012345678901234567890e-30",
        "6.631236846766476e-316",
        "7.2057594037927933e16",
        "0.1",
        ".5",
        "5.",
        "5.e3",
        "1.e",
        "2e+",
        "2e-x",
        "3.25abc",
        "1.5.5",
        "1e5.5",
        "-12\t13"};
    (void)state;
    for (size_t k = 0; k < sizeof text / sizeof *text; k++) compare_with_strtod(text[k], (long)k);
}

static void text_without_a_number(void **state)
{
    static const char *const text[] = {"", ".", "-", "+", "+.", "e5", ".e5", "--1", "inf", "nan", " 1", "x"};
    double x = 99.0;
    (void)state;
    for (size_t k = 0; k < sizeof text / sizeof *text; k++) assert_null(fl_decimal_read(text[k], &x));
    assert_true(x == 99.0);
    /* strtod() accepts more of these than a decimal number. */
    assert_string_equal(fl_decimal_read("0x10", &x), "x10");
    assert_true(x == 0.0);
}

/* Doubles of all magnitudes, with the digits needed, and with fewer and more. */
static void printed_doubles_read_back(void **state)
{
    char text[TEXT];
    (void)state;
    for (long k = 0; k < test_times(100000); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const uint64_t bits = fl_rng_u64(&g);
        double x;
        memcpy(&x, &bits, sizeof x);
        if (!isfinite(x)) continue;
        snprintf(text, sizeof text, "%.*g", 1 + (int)(fl_rng_u64(&g) % 22), x);
        compare_with_strtod(text, k);
        snprintf(text, sizeof text, "%.*f", (int)(fl_rng_u64(&g) % 20), fl_rng_in(&g, -1e7, 1e7));
        compare_with_strtod(text, k);
    }
}

/* Random digits, with a point and an exponent at random. */
static void random_digits(void **state)
{
    char text[TEXT];
    (void)state;
    for (long k = 0; k < test_times(100000); k++) {
        fl_rng g = fl_rng_of(test_seed() + 1, k, FL_RNG_TEST);
        const int n = 1 + (int)(fl_rng_u64(&g) % (k % 10 ? 25 : 400)), point = (int)(fl_rng_u64(&g) % 30);
        const int same = k % 7 == 0; /* long runs of zeros and nines are the hard cases of rounding */
        int len = 0;
        for (int i = 0; i < n; i++) {
            if (i == point) text[len++] = '.';
            text[len++] = (char)('0' + (same && i > 2 ? 9 * (i < n / 2) : (int)(fl_rng_u64(&g) % 10)));
        }
        if (k % 3) snprintf(text + len, sizeof text - (size_t)len, "e%d", (int)(fl_rng_u64(&g) % 700) - 370);
        else text[len] = '\0';
        compare_with_strtod(text, k);
    }
}

/* The point halfway between two doubles: in full, one digit shorter, and one digit more to either side. */
static void halfway_cases(void **state)
{
    char text[TEXT];
    (void)state;
    for (long k = 0; k < test_times(4000); k++) {
        fl_rng g = fl_rng_of(test_seed() + 2, k, FL_RNG_TEST);
        const double x =
            ldexp(1.0 + fl_rng_unit(&g), (int)(fl_rng_u64(&g) % (k % 2 ? 130 : 2040)) - (k % 2 ? 60 : 1020));
        const double up = nextafter(x, INFINITY);
        if (!isfinite(up)) continue;
        const long double middle = 0.5L * ((long double)x + (long double)up); /* 54 bits, which fit */
        snprintf(text, sizeof text, "%.*Le", 1100, middle);
        char *e = strchr(text, 'e'), exponent[16], *last = e;
        snprintf(exponent, sizeof exponent, "%s", e);
        while (last[-1] == '0') last--;
        const char *const more[] = {"", "0000000000000000000000000000", "00000000000000000000001", "1"};
        for (int i = 0; i < 4; i++) {
            sprintf(last, "%s%s", more[i], exponent);
            compare_with_strtod(text, k);
        }
        if (last[-1] == '.') continue;
        last[-1]--; /* the last digit is not zero: just below the tie */
        sprintf(last, "9999%s", exponent);
        compare_with_strtod(text, k);
        const int keep = 17 + (int)(fl_rng_u64(&g) % 6);
        if (last - text > keep) {
            sprintf(text + keep, "%s", exponent);
            compare_with_strtod(text, k);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(known_texts), cmocka_unit_test(text_without_a_number),
                                       cmocka_unit_test(printed_doubles_read_back),
                                       cmocka_unit_test(random_digits), cmocka_unit_test(halfway_cases)};
    return cmocka_run_group_tests_name("decimal", tests, NULL, NULL);
}
