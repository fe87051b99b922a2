/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/array.h"
#include "base/text.h"
#include "base/tool.h"
#include "support/near.h"

static fl_err err;

static void open_text(fl_text *t, const char *data)
{
    err = (fl_err){0};
    const char *path = test_file("text", data, strlen(data));
    assert_int_equal(fl_text_open(t, path, &err), 0);
}

static void close_text(fl_text *t)
{
    unlink(fl_in_name(t->in));
    fl_text_close(t);
    assert_null(t->line);
    assert_int_equal(t->line_number, 0);
    fl_text_close(t); /* a zeroed text too */
}

/* err is "<path>:LINE: SAYS"; LINE 0 means "<path>: SAYS". */
static void expect_message(int line, const char *message)
{
    char expected[1200];
    if (line) snprintf(expected, sizeof expected, "%s:%d: %s", test_path("text"), line, message);
    else snprintf(expected, sizeof expected, "%s: %s", test_path("text"), message);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text, expected);
}

static void lines_may_have_any_end(void **state)
{
    static const char *const data[] = {"a\nb\n\nc\n", "a\nb\n\nc", "a\r\nb\r\n\r\nc\r\n", "a\r\nb\n\nc\r"};
    static const char *const line[] = {"a", "b", "", "c"};
    (void)state;
    for (size_t k = 0; k < sizeof data / sizeof *data; k++) {
        fl_text t;
        open_text(&t, data[k]);
        for (int i = 0; i < 4; i++) {
            assert_int_equal(fl_text_line(&t, &err), 1);
            assert_string_equal(t.line, line[i]);
            assert_int_equal(t.len, (int)strlen(line[i]));
            assert_int_equal(t.line_number, i + 1);
        }
        for (int i = 0; i < 2; i++) {
            assert_int_equal(fl_text_line(&t, &err), 0);
            assert_int_equal(t.line_number, 4);
        }
        close_text(&t);
    }
}

static void an_empty_file(void **state)
{
    fl_text t;
    (void)state;
    open_text(&t, "");
    assert_int_equal(fl_text_line(&t, &err), 0);
    assert_int_equal(fl_text_row(&t, &err), 0);
    close_text(&t);
    open_text(&t, "");
    assert_int_equal(fl_text_magic(&t, "g-polys", 1, &err), -1);
    expect_message(0, "empty, a g-polys file is expected");
    close_text(&t);
}

/* Lines of up to 1 MiB span the chunks of the reader; one byte more is refused. */
static void long_lines(void **state)
{
    fl_text t;
    char *data = malloc(FL_TEXT_LINE_MAX + 10);
    (void)state;
    assert_non_null(data);
    for (int over = 0; over < 2; over++) {
        memset(data, 'x', FL_TEXT_LINE_MAX + 2);
        memcpy(data, "a\n", 2);
        strcpy(data + 2 + FL_TEXT_LINE_MAX + over, "\nz\n");
        if (over) data[2 + FL_TEXT_LINE_MAX] = 'x';
        open_text(&t, data);
        assert_int_equal(fl_text_line(&t, &err), 1);
        if (over) {
            assert_int_equal(fl_text_line(&t, &err), -1);
            expect_message(2, "line is longer than 1 MiB");
        } else {
            assert_int_equal(fl_text_line(&t, &err), 1);
            assert_int_equal(t.len, FL_TEXT_LINE_MAX);
            assert_int_equal(fl_text_line(&t, &err), 1);
            assert_string_equal(t.line, "z");
        }
        close_text(&t);
    }
    free(data);
}

static void a_zero_byte_is_refused(void **state)
{
    fl_text t;
    (void)state;
    err = (fl_err){0};
    const char *path = test_file("text", "ab\ncd\0ef\n", 9);
    assert_int_equal(fl_text_open(&t, path, &err), 0);
    assert_int_equal(fl_text_line(&t, &err), 1);
    assert_int_equal(fl_text_line(&t, &err), -1);
    expect_message(2, "a zero byte: this is not a text file");
    close_text(&t);
}

static void kind_and_version(void **state)
{
    fl_text t;
    (void)state;
    static const char *const good[] = {"#loads 2\n", "#loads 2", "#loads   1  \nx", "#loads 2\r\n"};
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        open_text(&t, good[k]);
        assert_int_equal(fl_text_magic(&t, "loads", 2, &err), 0);
        assert_true(t.version == 1 || t.version == 2);
        assert_string_equal(t.kind, "loads");
        close_text(&t);
        open_text(&t, good[k]);
        assert_int_equal(fl_text_magic(&t, NULL, 2, &err), 0); /* any kind */
        close_text(&t);
    }
    static const struct {
        const char *data, *message;
    } bad[] = {
        {"#loads 3\n", "loads version 3 is newer than this program, which reads up to 2"},
        {"#state 1\n", "this is a state file, a loads file is expected"},
        {"hello\n", "\"hello\" does not open a loads file, \"#loads 2\" is expected"},
        {"#loads\n", "\"#loads\" does not open a loads file, \"#loads 2\" is expected"},
        {"#loads 0\n", "\"#loads 0\" does not open a loads file, \"#loads 2\" is expected"},
        {"#loads -1\n", "\"#loads -1\" does not open a loads file, \"#loads 2\" is expected"},
        {"#loads 1 2\n", "\"#loads 1 2\" does not open a loads file, \"#loads 2\" is expected"},
        {"#loads 4294967297\n", "\"#loads 4294967297\" does not open a loads file, \"#loads 2\" is expected"},
        {"\033[2J\001\r#loads 1\n",
         "\"?[2J??#loads 1\" does not open a loads file, \"#loads 2\" is expected"},
        {"#loads 1.5\n", "\"#loads 1.5\" does not open a loads file, \"#loads 2\" is expected"},
        {"\n#loads 1\n", "\"\" does not open a loads file, \"#loads 2\" is expected"},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        open_text(&t, bad[k].data);
        assert_int_equal(fl_text_magic(&t, "loads", 2, &err), -1);
        expect_message(1, bad[k].message);
        close_text(&t);
    }
}

static void rows_and_history(void **state)
{
    fl_text t;
    (void)state;
    open_text(&t,
              "#loads 1\n#by one 1 --seed 7\n#by two 2\n\n# a remark\n  a\t b   c # the rest\n \t \nd#e f\n");
    assert_int_equal(fl_text_magic(&t, "loads", 1, &err), 0);
    assert_int_equal(fl_text_row(&t, &err), 1);
    assert_string_equal(t.history, "#by one 1 --seed 7\n#by two 2\n");
    assert_int_equal(t.n, 3);
    assert_int_equal(t.line_number, 6);
    assert_string_equal(t.field[0], "a");
    assert_string_equal(t.field[1], "b");
    assert_string_equal(t.field[2], "c");
    assert_int_equal(fl_text_row(&t, &err), 1);
    assert_int_equal(t.line_number, 8);
    assert_int_equal(t.n, 2); /* a mark within a word is part of it */
    assert_string_equal(t.field[0], "d#e");
    assert_int_equal(fl_text_row(&t, &err), 0);
    close_text(&t);
}

static void fields_and_their_errors(void **state)
{
    fl_text t;
    const char *w = NULL;
    double x = 0.0;
    int32_t i = 0;
    (void)state;
    open_text(&t, "poly 1.5 3\nv nan 0\nv 1\nf 9\nf 1 2\n");
    assert_int_equal(fl_text_row(&t, &err), 1);
    assert_int_equal(fl_text_word(&t, "record", &w, &err), 0);
    assert_string_equal(w, "poly");
    assert_int_equal(fl_text_f64(&t, "radius", &x, &err), 0);
    assert_true(x == 1.5);
    assert_int_equal(fl_text_i32(&t, "count", 0, 3, &i, &err), 0);
    assert_int_equal(i, 3);
    assert_int_equal(fl_text_no_more(&t, &err), 0);

    assert_int_equal(fl_text_row(&t, &err), 1);
    assert_int_equal(fl_text_word(&t, "record", &w, &err), 0);
    assert_int_equal(fl_text_f64(&t, "x", &x, &err), -1);
    expect_message(2, "x is \"nan\", a finite number is expected");
    assert_true(x == 1.5);

    err = (fl_err){0};
    assert_int_equal(fl_text_row(&t, &err), 1);
    t.next = 2;
    assert_int_equal(fl_text_f64(&t, "y", &x, &err), -1);
    expect_message(3, "y is missing after 2 fields");

    err = (fl_err){0};
    assert_int_equal(fl_text_row(&t, &err), 1);
    t.next = 1;
    assert_int_equal(fl_text_i32(&t, "index", 0, 8, &i, &err), -1);
    expect_message(4, "index is \"9\", a whole number from 0 to 8 is expected");

    err = (fl_err){0};
    assert_int_equal(fl_text_row(&t, &err), 1);
    t.next = 2;
    assert_int_equal(fl_text_no_more(&t, &err), -1);
    expect_message(5, "\"2\" was not expected after 2 fields");
    close_text(&t);
}

/* A row of 50000 fields: the list of fields grows, the words stay in place. */
static void many_fields(void **state)
{
    fl_text t;
    char *data = malloc(100001);
    (void)state;
    assert_non_null(data);
    for (int k = 0; k < 50000; k++) {
        data[2 * k] = (char)('a' + k % 26);
        data[2 * k + 1] = ' ';
    }
    data[100000] = '\0';
    open_text(&t, data);
    assert_int_equal(fl_text_row(&t, &err), 1);
    assert_int_equal(t.n, 50000);
    for (int k = 0; k < 50000; k++) assert_true(t.field[k][0] == 'a' + k % 26 && t.field[k][1] == '\0');
    close_text(&t);
    free(data);
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    for (long k = 0;; k++) {
        fl_text t = {0};
        const char *data = "#loads 1\n#by one 1\n1 2 3 4 5 6 7 8 9\n#by two 2, and something longer\n2 3\n";
        const char *path = test_file("text", data, strlen(data));
        int rc = -1;
        err = (fl_err){0};
        fl_alloc_fail_after(k);
        if (fl_text_open(&t, path, &err) == 0 && fl_text_magic(&t, "loads", 1, &err) == 0)
            while ((rc = fl_text_row(&t, &err)) > 0) continue;
        const long refused = fl_alloc_refused();
        fl_alloc_fail_after(-1);
        assert_int_equal(rc, refused ? -1 : 0);
        assert_int_equal(err.code, refused ? FL_SYSTEM : 0);
        fl_text_close(&t);
        unlink(path);
        if (!refused) break;
        assert_true(k < 100);
    }
}

static void nearest_word(void **state)
{
    static const char *const list[] = {"duration", "gravity", "dt", "safety"};
    (void)state;
    assert_string_equal(fl_text_nearest("duratoin", list, 4), "duration");
    assert_string_equal(fl_text_nearest("DURATION", list, 4), "duration");
    assert_string_equal(fl_text_nearest("gravty", list, 4), "gravity");
    assert_string_equal(fl_text_nearest("d", list, 4), "dt");
    assert_string_equal(fl_text_nearest("ration", list, 4),
                        "duration"); /* dt and safety are fewer edits away */
    assert_string_equal(fl_text_nearest("SAFE", list, 4), "safety");
    assert_non_null(fl_text_nearest("", list, 4));
    assert_null(fl_text_nearest("x", list, 0));
    char longer[500];
    memset(longer, 'x', sizeof longer - 1);
    longer[sizeof longer - 1] = '\0';
    assert_non_null(fl_text_nearest(longer, list, 4));
}

static void history_line(void **state)
{
    fl_history_line by;
    char longer[3 * FL_HISTORY_LINE_MAX], read[3000];
    (void)state;
    fl_history_line_start(&by, "dem-solve");
    fl_history_line_add(&by, "--seed %d", 7);
    fl_history_line_add(&by, "%s", "two\nlines\tand a tab");
    assert_string_equal(by.text, "#by dem-solve " FL_VERSION " --seed 7 two lines and a tab");
    memset(longer, 'x', sizeof longer - 1);
    longer[sizeof longer - 1] = '\0';
    for (int k = 0; k < 3; k++) fl_history_line_add(&by, "%s", longer);
    assert_true(strlen(by.text) < FL_HISTORY_LINE_MAX && by.len == (int)strlen(by.text));

    fl_history_line_start(&by, "two");
    FILE *f = fopen(test_path("by"), "w+");
    assert_non_null(f);
    fl_write_file_header(f, "loads", 3, "#by one 0\n", &by);
    fl_write_file_header(f, "loads", 3, NULL, &by);
    rewind(f);
    read[fread(read, 1, sizeof read - 1, f)] = '\0';
    assert_string_equal(read,
                        "#loads 3\n#by one 0\n#by two " FL_VERSION "\n#loads 3\n#by two " FL_VERSION "\n");
    fclose(f);
    unlink(test_path("by"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lines_may_have_any_end),
                                       cmocka_unit_test(an_empty_file),
                                       cmocka_unit_test(long_lines),
                                       cmocka_unit_test(a_zero_byte_is_refused),
                                       cmocka_unit_test(kind_and_version),
                                       cmocka_unit_test(rows_and_history),
                                       cmocka_unit_test(many_fields),
                                       cmocka_unit_test(fields_and_their_errors),
                                       cmocka_unit_test(allocation_failure_is_reported),
                                       cmocka_unit_test(nearest_word),
                                       cmocka_unit_test(history_line)};
    return cmocka_run_group_tests_name("text", tests, NULL, NULL);
}
