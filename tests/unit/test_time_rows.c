/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables beside a picture: rows by time, words, the load curve. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "support/near.h"
#include "view/time_rows.h"

static fl_err err;
static char path[64];

static void write_text(const char *text)
{
    FILE *f = fopen(path, "w");
    fputs(text, f);
    fclose(f);
}

static void rows_are_found_by_time(void **state)
{
    (void)state;
    static const char *const name[2] = {"body", "damage"}, *const word[] = {"whole", "broken", NULL};
    static const char *const with_word[2] = {"body", "state"};
    fl_time_rows r = {0};
    int64_t a, b;
    write_text("#any "
               "1\nt[s]\tbody\tstate\tdamage[1]\n0\t1\twhole\t0\n0\t2\tbroken\t1\n0.5\t1\tbroken\t0."
               "75\n2\t1\tbroken\t1\n");
    assert_int_equal(fl_time_rows_read(&r, path, NULL, name, 2, -1, NULL, &err), 0);
    assert_int_equal(r.rows, 4);
    assert_int_equal(r.times, 3);
    assert_string_equal(r.unit[1], "1");
    const double t[6] = {-1, 0, 0.4, 0.5, 1.9, 9};
    const int64_t first[6] = {0, 0, 0, 2, 2, 3}, last[6] = {2, 2, 2, 3, 3, 4};
    for (int k = 0; k < 6; k++) {
        fl_time_rows_at(&r, t[k], &a, &b);
        assert_int_equal(a, first[k]);
        assert_int_equal(b, last[k]);
    }
    assert_near(r.x[5], 0.75, 0);
    fl_time_rows_free(&r);
    assert_int_equal(fl_time_rows_read(&r, path, NULL, with_word, 2, 1, word, &err), 0);
    assert_near(r.x[1], 0, 0);
    assert_near(r.x[3], 1, 0);
    fl_time_rows_free(&r);
}

static void refused(const char *text, const char *sentence)
{
    static const char *const name[1] = {"body"};
    fl_time_rows r = {0};
    fl_err e = {0};
    write_text(text);
    assert_int_equal(fl_time_rows_read(&r, path, NULL, name, 1, -1, NULL, &e), -1);
    if (!strstr(e.text, sentence)) fail_msg("\"%s\" lacks \"%s\"", e.text, sentence);
    fl_time_rows_free(&r);
}

static void what_is_wrong_has_file_and_line(void **state)
{
    (void)state;
    refused("#any 1\nt[s]\tbodies\n0\t1\n", "body");
    refused("#any 1\nt[s]\tbody\n1\t1\n0\t1\n", ":4: time 0 s does not follow 1 s");
    refused("#any 1\nt[s]\tbody\n1\tx\n", ":3:");
}

/* Without a time all rows are of any time. */
static void a_table_without_time_is_of_all(void **state)
{
    (void)state;
    static const char *const name[2] = {"body", "age"};
    fl_time_rows r = {0};
    int64_t a, b;
    write_text("#any 1\nbody\tage\n1\t10\n2\t20\n");
    assert_int_equal(fl_time_rows_read(&r, path, NULL, name, 2, -1, NULL, &err), 0);
    fl_time_rows_at(&r, 7.0, &a, &b);
    assert_int_equal(a, 0);
    assert_int_equal(b, 2);
    fl_time_rows_free(&r);
}

static void the_load_curve_sums_parts(void **state)
{
    (void)state;
    fl_load_curve c = {0};
    fl_err e = {0};
    write_text("#loads 1\nt[s]\tpart\tfx[N]\tfy[N]\n1\ta\t3\t0\n1\tb\t0\t4\n2\ta\t-1\t0\n2\tb\t2\t0\n");
    assert_int_equal(fl_load_curve_read(&c, path, "fx", NULL, &err), 0);
    assert_int_equal(c.n, 2);
    assert_near(c.y[0], 3, 0);
    assert_near(c.y[1], 1, 0);
    fl_load_curve_free(&c);
    assert_int_equal(fl_load_curve_read(&c, path, "fh", NULL, &err), 0);
    assert_near(c.y[0], 5, 1e-15);
    fl_load_curve_free(&c);
    assert_int_equal(fl_load_curve_read(&c, path, "fy", "b", &err), 0);
    assert_near(c.y[0], 4, 0);
    fl_load_curve_free(&c);
    assert_int_equal(fl_load_curve_read(&c, path, "fx", "leg", &e), -1);
    assert_non_null(strstr(e.text, "there is no part leg"));
    fl_load_curve_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_found_by_time),
        cmocka_unit_test(what_is_wrong_has_file_and_line),
        cmocka_unit_test(a_table_without_time_is_of_all),
        cmocka_unit_test(the_load_curve_sums_parts),
    };
    strcpy(path, "/tmp/floe-rows.XXXXXX");
    close(mkstemp(path));
    const int rc = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(path);
    return rc;
}
