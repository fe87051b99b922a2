/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>
#include "mesh/fixed_columns.h"
#include "support/near.h"

static void formats_give_columns(void **state)
{
    fl_columns f;
    (void)state;
    assert_int_equal(fl_columns_parse(&f, "(3i9,6e21.13e3)"), 0);
    assert_int_equal(f.n, 9);
    assert_int_equal(f.integers, 3);
    assert_int_equal(f.start[3], 27);
    assert_int_equal(f.width[8], 21);
    assert_int_equal(fl_columns_parse(&f, "  (i7, 2x, A9,i3)"), 0);
    assert_int_equal(f.n, 3);
    assert_int_equal(f.integers, 1);
    assert_int_equal(f.start[1], 9);
    assert_int_equal(f.start[2], 18);
    static const char *const bad[] = {"",      "3i9",    "(",      "()",     "(i)",
                                      "(i0)",  "(65i1)", "(0i9)",  "(1i80)", "(99x,i2)",
                                      "(3q9)", "(3i9",   "(3i9,,", "(i9;)",  "(99999999999999999999i3)"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        if (fl_columns_parse(&f, bad[k]) == 0) fail_msg("\"%s\" was accepted", bad[k]);
}

static int integer_in(const char *row, int width, int64_t *x)
{
    const fl_columns f = {.n = 2, .start = {0, width}, .width = {width, 5}, .integers = 2};
    return fl_columns_integer(&f, 0, row, (int32_t)strlen(row), x);
}

static int real_in(const char *text, int width, double *x)
{
    const fl_columns f = {.n = 2, .start = {0, width}, .width = {width, 5}};
    char row[100];
    snprintf(row, sizeof row, "%s", text);
    const int rc = fl_columns_real(&f, 0, row, (int32_t)strlen(row), x);
    assert_string_equal(row, text); /* the row is unchanged afterwards */
    return rc;
}

/* A field ends at its column, not where the number could continue. */
static void numbers_touch_and_rows_are_short(void **state)
{
    int64_t n;
    double x;
    (void)state;
    assert_int_equal(integer_in("   12345678", 7, &n), 0);
    assert_int_equal(n, 1234);
    assert_int_equal(integer_in("  -7", 9, &n), 0);
    assert_int_equal(n, -7);
    assert_int_equal(integer_in("+7 \t 99", 5, &n), 0);
    assert_int_equal(n, 7);
    assert_int_equal(integer_in("     99", 5, &n), 0);
    assert_int_equal(n, 0);
    assert_int_equal(integer_in("", 5, &n), 0);
    assert_int_equal(n, 0);
    assert_int_equal(integer_in("999999999999999999", 18, &n), 0);
    assert_true(n == INT64_C(999999999999999999));
    assert_int_equal(integer_in("1000000000000000000", 19, &n), -1);
    assert_int_equal(integer_in("1 2", 3, &n), -1);
    assert_int_equal(integer_in("1.5", 3, &n), -1);
    assert_int_equal(integer_in("-", 3, &n), -1);
    assert_int_equal(real_in("0.0E+00-5.0E-01", 7, &x), 0);
    assert_true(x == 0.0);
    assert_int_equal(real_in("1.2500001.3", 8, &x), 0);
    assert_true(x == 1.25);
    assert_int_equal(real_in(" -1.5E-001", 20, &x), 0);
    assert_true(x == -0.15);
    assert_int_equal(real_in(" 1.5-3 ", 9, &x), 0);
    assert_true(x == 0.0015);
    assert_int_equal(real_in(" 2.D+01  9", 9, &x), 0);
    assert_true(x == 20.0);
    assert_int_equal(real_in("    12", 4, &x), 0);
    assert_true(x == 0.0);
    assert_int_equal(real_in("1.0 2.0", 7, &x), -1);
    assert_int_equal(real_in("nan", 7, &x), -1);
    assert_int_equal(real_in("1e999", 7, &x), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formats_give_columns),
        cmocka_unit_test(numbers_touch_and_rows_are_short),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
