/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>
#include "mesh/deck_lines.h"
#include "support/near.h"

static void reals_of_every_kind(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double x;
    } row[] = {{"1.5", 1.5},         {"-.5", -0.5},     {"5.", 5.0},
               {"1.5-3", 0.0015},    {"7.+2", 700.0},   {"-1.25+10", -1.25e10},
               {"1.D0", 1.0},        {"2.5d-2", 0.025}, {"1.0E-001", 0.1},
               {"1.0E+003", 1000.0}, {"+3", 3.0},       {"-7-1", -0.7},
               {"1e3", 1000.0},      {"0.", 0.0}};
    static const char *const bad[] = {
        "",        "-",     "1.5--3",
        "1.5E",    "1.5E+", "1 2",
        "nan",     "inf",   "0x10",
        "1.5-3-3", "1e400", "E5",
        "1.5-3E2", "abc",   "1000000000000000000000000000000000000000000000000000000000000000-1"};
    double x;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        if (fl_deck_real(row[k].text, &x)) fail_msg("\"%s\" was refused", row[k].text);
        assert_near(x, row[k].x, 0.0);
    }
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        if (fl_deck_real(bad[k], &x) == 0) fail_msg("\"%s\" was read as %g", bad[k], x);
}

static void whole_numbers_and_blanks(void **state)
{
    (void)state;
    static const char *const bad[] = {"", "-", "1.", "1e3", "1234567890123456789", "1 ", "12a"};
    char text[] = " \t a b \f";
    int64_t n;
    assert_int_equal(fl_deck_integer("-12", &n), 0);
    assert_true(n == -12);
    assert_int_equal(fl_deck_integer("+123456789012345678", &n), 0);
    assert_true(n == INT64_C(123456789012345678));
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) assert_int_equal(fl_deck_integer(bad[k], &n), -1);
    assert_string_equal(fl_deck_trim(text), "a b");
    assert_string_equal(fl_deck_trim((char[]){""}), "");
}

static fl_err err;
static fl_elements e;
static fl_bytes b;
static fl_deck d;

static void open_lines(const char *text)
{
    const char *path = test_file("a.inp", text, strlen(text));
    err = (fl_err){0};
    assert_int_equal(fl_bytes_open(&b, path, &err) || fl_bytes_read_all(&b, &err), 0);
    assert_int_equal(fl_elements_start(&e, path, &err), 0);
    fl_deck_start(&d, &e, &b);
}

static int close_lines(void **state)
{
    (void)state;
    fl_deck_free(&d);
    fl_elements_free(&e);
    fl_bytes_free(&b);
    return 0;
}

static void lines_end_in_every_way(void **state)
{
    (void)state;
    static const char *const line[] = {"one", "two  2", "", "four", "", "six"};
    open_lines("one \r\ntwo  2\t\n\nfour\r\rsix");
    for (int k = 0; k < 6; k++) {
        assert_int_equal(fl_deck_line(&d, &err), 1);
        assert_string_equal(d.line, line[k]);
        assert_int_equal(e.line, k + 1);
        if (k != 3) continue;
        fl_deck_unread(&d);
        assert_int_equal(fl_deck_line(&d, &err), 1);
        assert_string_equal(d.line, "four");
        assert_int_equal(e.line, 4);
    }
    assert_int_equal(fl_deck_line(&d, &err), 0);
    assert_int_equal(fl_deck_line(&d, &err), 0);
}

static void included_lines_are_inserted(void **state)
{
    (void)state;
    const char *name = strrchr(test_file("b.inp", "inner\n", 6), '/') + 1;
    char included[200];
    snprintf(included, sizeof included, "%s", name);
    open_lines("before\nafter\n");
    assert_int_equal(fl_deck_line(&d, &err), 1);
    assert_int_equal(fl_deck_include(&d, included, &err), 0);
    assert_int_equal(fl_deck_line(&d, &err), 1);
    assert_string_equal(d.line, "inner");
    assert_int_equal(e.line, 1);
    assert_non_null(strstr(e.files.name[e.file], "b.inp"));
    assert_int_equal(fl_deck_line(&d, &err), 1);
    assert_string_equal(d.line, "after");
    assert_int_equal(e.line, 2);
    assert_int_equal(fl_deck_include(&d, "missing.inp", &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_non_null(strstr(err.text, "a.inp:2: the file included here cannot be read: "));
    err = (fl_err){0};
    assert_int_equal(fl_deck_include(&d, strrchr(test_path("a.inp"), '/') + 1, &err), -1);
    assert_non_null(strstr(err.text, "is included in itself"));
    err = (fl_err){0};
    assert_int_equal(fl_deck_include(&d, "", &err), -1);
    err = (fl_err){0};
    assert_int_equal(fl_deck_include(&d, "-", &err), -1);
}

/* Two files that include one another under changing names, and one that includes itself endlessly. */
static void endless_inclusion_is_refused(void **state)
{
    (void)state;
    char name[300] = "", included[100];
    int rc = 0;
    snprintf(included, sizeof included, "%s", strrchr(test_file("b.inp", "inner\n", 6), '/') + 1);
    open_lines("line\n");
    assert_int_equal(fl_deck_line(&d, &err), 1);
    for (int k = 0; k < 17 && rc == 0; k++) {
        snprintf(name + strlen(name), sizeof name - strlen(name), "./");
        char whole[500];
        snprintf(whole, sizeof whole, "%s%s", name, included);
        rc = fl_deck_include(&d, whole, &err);
        assert_int_equal(rc, k < FL_DECK_DEPTH ? 0 : -1);
    }
    assert_non_null(strstr(err.text, "more than 16 files deep"));
}

static void zero_bytes_are_refused(void **state)
{
    (void)state;
    const char *path = test_file("a.inp", "ab\0cd\n", 6);
    err = (fl_err){0};
    assert_int_equal(fl_bytes_open(&b, path, &err) || fl_bytes_read_all(&b, &err), 0);
    assert_int_equal(fl_elements_start(&e, path, &err), 0);
    fl_deck_start(&d, &e, &b);
    assert_int_equal(fl_deck_line(&d, &err), -1);
    assert_non_null(strstr(err.text, "a.inp:1: a zero byte"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reals_of_every_kind),
        cmocka_unit_test(whole_numbers_and_blanks),
        cmocka_unit_test_teardown(lines_end_in_every_way, close_lines),
        cmocka_unit_test_teardown(included_lines_are_inserted, close_lines),
        cmocka_unit_test_teardown(endless_inclusion_is_refused, close_lines),
        cmocka_unit_test_teardown(zero_bytes_are_refused, close_lines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
