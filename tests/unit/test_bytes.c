/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "mesh/read_mesh.h"
#include "support/mesh.h"
#include "support/near.h"

static fl_err err;
static fl_bytes b;

static int skip_text(void **state)
{
    (void)state;
    fl_bytes_set_window(0);
    fl_bytes_free(&b);
    return 0;
}

static void open_with(const char *text, size_t n, int32_t window)
{
    fl_bytes_free(&b);
    err = (fl_err){0};
    fl_bytes_set_window(window);
    if (fl_bytes_open(&b, test_file("text", text, n), &err)) fail_msg("%s", err.text);
}

/* Rows do not depend on the size of the window: all line ends, continued lines, a byte order mark, no line
 * end at the end. */
static void rows_do_not_depend_on_the_window(void **state)
{
    (void)state;
    static const char text[] = "\xef\xbb\xbf"
                               "a b\r\n# no\r\n\r\nc \\\r\nd\\\n e\n\r\rf\rg \\\\ h\n#\n"
                               "a_word_that_is_longer_than_the_window_is i\nlast";
    static const char expected[] =
        "1:a,b 6:c,d,e 9:f 10:g,\\\\,h 12:a_word_that_is_longer_than_the_window_is,i 13:last ";
    for (int32_t window = 3; window < 120; window++) {
        char got[400] = "";
        int more;
        open_with(text, sizeof text - 1, window);
        b.comment = '#';
        while ((more = fl_bytes_row(&b, &err)) > 0) {
            sprintf(got + strlen(got), "%d:", b.line);
            for (int32_t k = 0; k < b.words; k++)
                sprintf(got + strlen(got), "%s%s", b.field[k], k + 1 < b.words ? "," : " ");
        }
        assert_int_equal(more, 0);
        assert_string_equal(got, expected);
    }
}

static void lines_and_bytes_do_not_depend_on_the_window(void **state)
{
    (void)state;
    static const char text[] = "one\r\ntwo \r\r\nthree\n\n12345678";
    for (int32_t window = 1; window < 40; window++) {
        static const char *const expected[] = {"one", "two ", "", "three", ""};
        const unsigned char *p;
        open_with(text, sizeof text - 1, window);
        for (int k = 0; k < 5; k++) {
            char *line;
            int32_t len;
            assert_int_equal(fl_bytes_line(&b, &line, &len, &err), 1);
            assert_string_equal(line, expected[k]);
            assert_int_equal(len, strlen(expected[k]));
        }
        for (int k = 0; k < 4; k++) {
            assert_int_equal(fl_bytes_read(&b, 2, &p, &err), 1);
            assert_int_equal(p[0], '1' + 2 * k);
            assert_int_equal(p[1], '2' + 2 * k);
        }
        assert_int_equal(fl_bytes_read(&b, 1, &p, &err), 0);
        assert_int_equal(b.offset + b.pos, sizeof text - 1);
    }
}

/* Numbers, marks and bytes that are read ahead without being consumed. */
static void numbers_and_marks_do_not_depend_on_the_window(void **state)
{
    (void)state;
    static const char text[] =
        "  1.5\t-2e3\r\n\n 3 nan 0.0000000000000000000000000000000000000000000000000000000000000"
        "0000000000000000000000000000000000000000000000000000000000000000000000000007\n"
        "$E\n$EndXY\n x$EndX\n\001\002$EndX\n$EndX \nrest 7";
    static const double expected[] = {1.5, -2000.0, 3.0};
    for (int32_t window = 1; window < 300; window += 1 + window / 40) {
        const char *p;
        char *line;
        int32_t len;
        double x;
        open_with(text, sizeof text - 1, window);
        b.line = 1;
        for (int k = 0; k < 3; k++) {
            assert_int_equal(fl_bytes_real(&b, 0, &x, &err), 1);
            assert_true(x == expected[k]);
        }
        assert_int_equal(b.line, 3);
        assert_int_equal(fl_bytes_real(&b, 1, &x, &err), 1); /* any byte */
        assert_true(x == 0.0);
        assert_int_equal(fl_bytes_real(&b, 0, &x, &err), 1);
        assert_near(x, 7e-137, 0.0);
        assert_int_equal(fl_bytes_seek(&b, "$EndX", &err), 1);
        assert_int_equal(b.line, 8);
        assert_int_equal(fl_bytes_peek(&b, 10, &p, &err), 10);
        assert_memory_equal(p, "$EndX \nres", 10);
        assert_int_equal(fl_bytes_line(&b, &line, &len, &err), 1);
        assert_string_equal(line, "$EndX ");
        assert_int_equal(fl_bytes_peek(&b, 10, &p, &err), 6);
        assert_int_equal(fl_bytes_skip(&b, 5, &err), 1);
        assert_int_equal(fl_bytes_offset(&b), sizeof text - 2);
        assert_int_equal(fl_bytes_skip(&b, 2, &err), 0);
        assert_int_equal(fl_bytes_seek(&b, "$EndX", &err), 0);
        assert_int_equal(fl_bytes_real(&b, 0, &x, &err), 0);
        open_with("1 zwei", 6, window);
        assert_int_equal(fl_bytes_real(&b, 0, &x, &err), 1);
        assert_int_equal(fl_bytes_real(&b, 0, &x, &err), -1);
        assert_non_null(strstr(err.text, "\"zwei\" was found, a number is expected"));
        open_with("1\0", 2, window);
        assert_int_equal(fl_bytes_real(&b, 1, &x, &err), -1);
    }
}

/* A mesh reader's result does not depend on the window either. */
static int check_mesh_with_window(const char *path, int32_t window)
{
    fl_surface whole = {0}, part = {0};
    char note[FL_MESH_NOTE];
    int same = -1;
    err = (fl_err){0};
    fl_bytes_set_window(0);
    if (fl_mesh_read(&whole, path, NULL, note, &err) == 0) {
        fl_bytes_set_window(window);
        /* a small head may be too short to identify the format */
        if (fl_mesh_read(&part, path, NULL, note, &err) == 0) same = mesh_same(&whole, &part);
    }
    fl_surface_free(&whole);
    fl_surface_free(&part);
    return same;
}

static void meshes_do_not_depend_on_the_window(void **state)
{
    (void)state;
    static const char *const kind[] = {"stl", "obj",     "off", "ply", "inp",    "cdb",
                                       "bdf", "gstruct", "msh", "vtk", "vtk_xml"};
    for (size_t k = 0; k < sizeof kind / sizeof *kind; k++) {
        char folder[100], path[400];
        const struct dirent *e;
        int same = 0;
        snprintf(folder, sizeof folder, "tests/fuzz/%s", kind[k]);
        DIR *d = opendir(folder);
        assert_non_null(d);
        while ((e = readdir(d)) != NULL) {
            snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
            for (int32_t window = 100; e->d_name[0] == 'g' && window < 3000; window += window / 3) {
                const int how = check_mesh_with_window(path, window);
                if (how == 0) fail_msg("%s differs through a window of %d bytes", path, window);
                same += how > 0;
            }
        }
        closedir(d);
        assert_true(same > 10);
    }
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    char *line;
    int32_t len;
    int rc = -1;
    for (long fail = 0; rc; fail++) {
        fl_bytes_free(&b);
        err = (fl_err){0};
        fl_bytes_set_window(4);
        fl_alloc_fail_after(fail);
        rc = fl_bytes_open(&b, test_file("text", "a\nbcdefghijklmnopqrst\n", 22), &err);
        for (int k = 0; rc == 0 && k < 2; k++) rc = fl_bytes_line(&b, &line, &len, &err) < 0;
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
        assert_true(fail < 50);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(rows_do_not_depend_on_the_window, skip_text),
        cmocka_unit_test_teardown(lines_and_bytes_do_not_depend_on_the_window, skip_text),
        cmocka_unit_test_teardown(numbers_and_marks_do_not_depend_on_the_window, skip_text),
        cmocka_unit_test_teardown(meshes_do_not_depend_on_the_window, skip_text),
        cmocka_unit_test_teardown(allocation_failure_is_reported, skip_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
