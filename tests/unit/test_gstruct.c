/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "mesh/gstruct.h"
#include "support/mesh.h"
#include "support/near.h"

#define HEAD "#g_struct 1\npart 0 a\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"

static const char *file(const char *text) { return test_file("g", text, strlen(text)); }

static void a_file_is_read_as_documented(void **state)
{
    static const char text[] = "#g_struct 1\n#by hand\n"
                               "part 4 leg # the first\n"
                               "v 0 0 0\nv 1e0 0 0\r\n\nv 0 1 -.5\nt 0 1 2\n"
                               "cone 0 0 -5 1.5  0 0 5 0\n"
                               "part 2 brace\ncone 1 2 3 .25 4 5 6 .25";
    fl_surface s = {0};
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_gstruct_read(&s, file(text), &err), 0);
    assert_int_equal(s.n, 2);
    assert_string_equal(s.history, "#by hand\n");
    assert_string_equal(s.part[0].name, "leg");
    assert_int_equal(s.part[0].id, 4);
    assert_int_equal(s.part[0].nv, 3);
    assert_int_equal(s.part[0].nt, 1);
    assert_int_equal(s.part[0].nc, 1);
    assert_near(s.part[0].v[2].z, -0.5, 0);
    assert_near(s.part[0].cone[0].r0, 1.5, 0);
    assert_near(s.part[0].cone[0].r1, 0.0, 0);
    assert_string_equal(s.part[1].name, "brace");
    assert_near(s.part[1].cone[0].p1.z, 6.0, 0);
    assert_int_equal(mesh_sound(&s), 1);
    fl_surface_free(&s);
    unlink(test_path("g"));
}

static void a_round_trip_keeps_the_bytes(void **state)
{
    fl_surface s = {0}, again = {0};
    fl_err err = {0};
    fl_history_line by;
    char *text = NULL, *second = NULL;
    size_t n = 0, m = 0;
    FILE *f;
    (void)state;
    fl_surface_add(&s, "third part", 10, &err);
    fl_surface_vertex(&s.part[0], v3(1.0 / 3.0, 0.1, 1e-300), &err);
    fl_surface_vertex(&s.part[0], v3(-1e300, 0x1.fffffffffffffp-1, 2), &err);
    fl_surface_vertex(&s.part[0], v3(4503599627370497.5, 0, 0), &err);
    fl_surface_triangle(&s.part[0], 2, 0, 1, &err);
    fl_surface_add(&s, "", 0, &err);
    fl_surface_cone(&s.part[1], (fl_cone){v3(0.1, 0.2, 0.3), v3(1.1, 2.2, 3.3), 0.7, 0}, &err);
    fl_history_line_start(&by, "test");
    f = open_memstream(&text, &n);
    fl_gstruct_write(f, &s, &by);
    fclose(f);
    assert_int_equal(fl_gstruct_read(&again, test_file("g", text, n), &err), 0);
    assert_int_equal(mesh_same(&s, &again), 1);
    assert_string_equal(again.history, "#by test " FL_VERSION "\n");
    fl_history_line_start(&by, "second");
    f = open_memstream(&second, &m);
    fl_gstruct_write(f, &again, &by); /* the history grows by a line, the rest is the same bytes */
    fclose(f);
    assert_non_null(strstr(second, "#g_struct 1\n#by test " FL_VERSION "\n#by second " FL_VERSION
                                   "\npart 0 third_part\n"));
    assert_string_equal(strstr(second, "part 0"), strstr(text, "part 0"));
    free(text);
    free(second);
    fl_surface_free(&s);
    fl_surface_free(&again);
    unlink(test_path("g"));
}

static void each_fault_has_its_message(void **state)
{
    static const struct {
        const char *text, *message; /* after the name of the file */
    } fault[] = {
        {"", ": empty, a g_struct file is expected"},
        {"hello\n", ":1: \"hello\" does not open a g_struct file, \"#g_struct 1\" is expected"},
        {"#g-polys 1\n", ":1: this is a g-polys file, a g_struct file is expected"},
        {"#g_struct 2\n", ":1: g_struct version 2 is newer than this program, which reads up to 1"},
        {"#g_struct 1\n", ": no part, at least one with triangles or cones is expected"},
        {"#g_struct 1\nv 0 0 0\n", ":2: \"v\" stands before the first part"},
        {"#g_struct 1\npart 0 a\npart 1 b\n", ":2: part \"a\" has neither triangles nor cones"},
        {HEAD, ":2: part \"a\" has neither triangles nor cones"},
        {HEAD "t 0 1 3\n", ":6: triangle 0 refers to vertex 3, but part \"a\" has 3 so far"},
        {HEAD "t 0 1 -1\n", ":6: vertex index is \"-1\", a whole number from 0 to 2147483647 is expected"},
        {HEAD "t 0 1 1\n", ":6: triangle 0 1 1 repeats a vertex"},
        {HEAD "t 0 1\n", ":6: vertex index is missing after 3 fields"},
        {HEAD "t 0 1 2 0\n", ":6: \"0\" was not expected after 4 fields"},
        {HEAD "v 0 nan 0\n", ":6: y is \"nan\", a finite number is expected"},
        {HEAD "v 0 0 1e999\n", ":6: z is \"1e999\", a finite number is expected"},
        {HEAD "cone 0 0 0 -1 0 0 1 1\n", ":6: cone radius -1 is negative"},
        {HEAD "cone 0 0 0 0 0 0 1 0\n", ":6: both radii of the cone are 0"},
        {HEAD "cone 1 2 3 1 1 2 3 1\n", ":6: the cone has no length"},
        {HEAD "cone 0 0 0 1 0 0 1\n", ":6: second radius is missing after 8 fields"},
        {HEAD "vertex 0 0 0\n", ":6: unknown record \"vertex\", the nearest is \"part\""},
        {HEAD "coney 0 0 0\n", ":6: unknown record \"coney\", the nearest is \"cone\""},
        {HEAD "t 0 1 2\npart 0 b\n", ":7: part id 0 is used a second time"},
        {HEAD "t 0 1 2\npart 1 a\n", ":7: part name \"a\" is used a second time"},
        {HEAD "t 0 1 2\npart 1 total\n",
         ":7: a part is called total, as loads call the sum over the parts: another name is expected"},
        {HEAD "t 0 1 2\npart 1\n", ":7: part name is missing after 2 fields"},
        {HEAD "t 0 1 2\npart x a\n", ":7: part id is \"x\", a whole number from 0 to 999999999 is expected"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof fault / sizeof fault[0]; k++) {
        fl_surface s = {0};
        fl_err err = {0};
        const char *path = file(fault[k].text);
        assert_int_equal(fl_gstruct_read(&s, path, &err), -1);
        assert_int_equal(err.code, FL_INPUT);
        assert_int_equal(strncmp(err.text, path, strlen(path)), 0);
        assert_string_equal(err.text + strlen(path), fault[k].message);
        assert_null(s.part);
    }
    unlink(test_path("g"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_file_is_read_as_documented),
                                       cmocka_unit_test(a_round_trip_keeps_the_bytes),
                                       cmocka_unit_test(each_fault_has_its_message)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
