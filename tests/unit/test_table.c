/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/table.h"
#include "support/near.h"

static fl_err err;

static int open_table(fl_table *t, const char *kind, const char *data)
{
    err = (fl_err){0};
    return fl_table_open(t, test_file("table", data, strlen(data)), kind, 1, &err);
}

/* err is "<path>:LINE: SAYS"; LINE 0 means "<path>: SAYS". */
static void expect_message(int line, const char *message)
{
    char expected[1200];
    if (line) snprintf(expected, sizeof expected, "%s:%d: %s", test_path("table"), line, message);
    else snprintf(expected, sizeof expected, "%s: %s", test_path("table"), message);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text, expected);
}

static void columns_and_rows(void **state)
{
    fl_table t;
    double x = 0.0;
    int32_t col = -1;
    (void)state;
    assert_int_equal(
        open_table(&t, "loads",
                   "#loads 1\r\n#by dem-solve 0.1.0 a.scene\r\n# remark\r\n#start 2.5\r\n\r\n"
                   "t[s]\tpart\tmx[N.m]\tcontacts\r\n3\ttower\t-1.5e3\t7\r\n# between\r\n4 deck 2 8"),
        0);
    assert_int_equal(t.n, 4);
    assert_string_equal(t.name[0], "t");
    assert_string_equal(t.unit[0], "s");
    assert_string_equal(t.name[2], "mx");
    assert_string_equal(t.unit[2], "N.m");
    assert_string_equal(t.unit[3], "");
    assert_int_equal(t.has_start, 1);
    assert_near(t.start, 2.5, 0.0);
    assert_string_equal(t.text.history, "#by dem-solve 0.1.0 a.scene\n");
    assert_int_equal(fl_table_column(&t, "mx"), 2);
    assert_int_equal(fl_table_column(&t, "mx[N.m]"), 2);
    assert_int_equal(fl_table_column(&t, "mx[N]"), -1);
    assert_int_equal(fl_table_column(&t, "m"), -1);
    assert_int_equal(fl_table_column(&t, ""), -1);
    assert_int_equal(fl_table_require(&t, "contacts", &col, &err), 0);
    assert_int_equal(col, 3);
    assert_int_equal(fl_table_row(&t, &err), 1);
    assert_string_equal(fl_table_word(&t, 1), "tower");
    assert_int_equal(fl_table_f64(&t, 2, &x, &err), 0);
    assert_near(x, -1500.0, 0.0);
    assert_string_equal(t.name[2], "mx"); /* the names outlive the row that gave them */
    assert_int_equal(fl_table_row(&t, &err), 1);
    assert_int_equal(fl_table_f64(&t, 1, &x, &err), -1);
    expect_message(9, "part is \"deck\", a finite number is expected");
    err = (fl_err){0};
    assert_int_equal(fl_table_require(&t, "contact", &col, &err), -1);
    expect_message(9, "no column contact in this loads table, the nearest is contacts");
    assert_int_equal(fl_table_row(&t, &err), 0);
    fl_table_close(&t);
    assert_null(t.name);
    fl_table_close(&t);
}

static void tables_of_any_kind(void **state)
{
    fl_table t;
    (void)state;
    assert_int_equal(open_table(&t, NULL, "#energy 1\nt[s] kinetic[J]\n"), 0);
    assert_string_equal(t.text.kind, "energy");
    assert_int_equal(t.has_start, 0);
    assert_int_equal(fl_table_row(&t, &err), 0);
    fl_table_close(&t);
}

static void errors_are_reported(void **state)
{
    static const struct {
        const char *data;
        int line;
        const char *message;
    } bad[] = {
        {"", 0, "empty, a loads file is expected"},
        {"#state 1\nt\n", 1, "this is a state file, a loads file is expected"},
        {"#loads 2\nt\n", 1, "loads version 2 is newer than this program, which reads up to 1"},
        {"#loads 1\n#by x\n", 2, "the loads table ends here, a row of column names is expected"},
        {"#loads 1\nt[s] fx[N] t\n", 2, "column t appears twice"},
        {"#loads 1\nt[s] [N]\n", 2, "a column has a unit and no name"},
        {"#loads 1\n#start soon\nt\n", 2, "start is \"soon\", a finite number is expected"},
        {"#loads 1\n#start\tnan\nt\n", 2, "start is \"nan\", a finite number is expected"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        fl_table t;
        assert_int_equal(open_table(&t, "loads", bad[k].data), -1);
        expect_message(bad[k].line, bad[k].message);
        assert_null(t.name);
    }
}

static void fields_must_match_columns(void **state)
{
    fl_table t;
    (void)state;
    assert_int_equal(open_table(&t, "loads", "#loads 1\nt part fx\n1 a 2\n2 a\n"), 0);
    assert_int_equal(fl_table_row(&t, &err), 1);
    assert_int_equal(fl_table_row(&t, &err), -1);
    expect_message(4, "2 fields, 3 are expected as there are columns");
    fl_table_close(&t);
}

static void too_many_columns_are_refused(void **state)
{
    fl_table t;
    char *data = malloc(100000);
    int n;
    (void)state;
    assert_non_null(data);
    n = sprintf(data, "#loads 1\n");
    for (int k = 0; k <= FL_TABLE_COLUMNS_MAX; k++) n += sprintf(data + n, "c%d ", k);
    assert_int_equal(open_table(&t, "loads", data), -1);
    expect_message(2, "4097 columns, at most 4096 were expected");
    free(data);
}

static int remove_files(void **state)
{
    (void)state;
    unlink(test_path("table"));
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_and_rows), cmocka_unit_test(tables_of_any_kind),
        cmocka_unit_test(errors_are_reported), cmocka_unit_test(fields_must_match_columns),
        cmocka_unit_test(too_many_columns_are_refused)};
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
