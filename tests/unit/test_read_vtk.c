/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>
#include "mesh/read_mesh.h"
#include "support/mesh.h"
#include "support/near.h"

static fl_err err;
static char note[FL_MESH_NOTE];
static fl_surface s;

static int read_text(const char *text)
{
    fl_surface_free(&s);
    err = (fl_err){0};
    return fl_mesh_read(&s, test_file("grid", text, strlen(text)), NULL, note, &err);
}

static void expect_read(const char *text)
{
    if (read_text(text)) fail_msg("%s", err.text);
    assert_true(mesh_sound(&s));
}

static void expect_refusal(const char *text, const char *why)
{
    assert_int_equal(read_text(text), -1);
    assert_int_equal(err.code, FL_INPUT);
    if (!strstr(err.text, why)) fail_msg("\"%s\" says nothing of \"%s\"", err.text, why);
}

static double volume(const fl_part *p)
{
    double sum = 0.0;
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t *c = p->t[t].v;
        sum += v3_dot(p->v[c[0]], v3_cross(p->v[c[1]], p->v[c[2]])) / 6.0;
    }
    return sum;
}

#define HEAD "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET "
#define CUBE "POINTS 8 float\n0 0 0 2 0 0 2 1 0 0 1 0\n0 0 3 2 0 3 2 1 3 0 1 3\n"

/* Cells of POLYDATA are numbered vertices, lines, polygons, strips, whatever their order in the file. */
static void cell_data_follow_the_order_of_kinds(void **state)
{
    (void)state;
    expect_read(HEAD "POLYDATA\n" CUBE
                     "TRIANGLE_STRIPS 1 6\n5 0 1 3 2 6\nPOLYGONS 2 11\n4 4 5 6 7\n5 0 1 5 6 7\n"
                     "VERTICES 1 2\n1 0\nCELL_DATA 4\nSCALARS other float\nLOOKUP_TABLE default\n1 nan 3 4\n"
                     "FIELD more 2\nmaterial 1 4 int\n9 9 9 9\nPART 1 4 int\n5 6 6 7\n");
    assert_int_equal(s.n, 2);
    assert_string_equal(s.part[0].name, "PART_6");
    assert_int_equal(s.part[0].nt, 5);
    assert_string_equal(s.part[1].name, "PART_7");
    assert_int_equal(s.part[1].nt, 3);
    assert_non_null(strstr(note, "vertex 1"));
}

static void cells_of_all_kinds_have_a_surface(void **state)
{
    (void)state;
    expect_read(HEAD "UNSTRUCTURED_GRID\n" CUBE
                     "CELLS 1 9\n8 0 1 3 2 4 5 7 6\nCELL_TYPES 1\n11\n"); /* a voxel */
    assert_int_equal(s.part[0].nt, 12);
    assert_near(volume(&s.part[0]), 6.0, 1e-15);
    expect_read(HEAD "UNSTRUCTURED_GRID\n" CUBE
                     "CELLS 2 10\n4 0 1 3 2\n4 4 5 7 6\nCELL_TYPES 2\n8\n8\n"); /* pixels */
    assert_int_equal(s.part[0].nt, 4);
    expect_read(HEAD "UNSTRUCTURED_GRID\n" CUBE
                     "CELLS 2 13\n8 0 1 2 3 4 5 6 7\n3 0 1 2\nCELL_TYPES 2\n72\n69\n");
    assert_non_null(strstr(note, "2 cells of higher order"));
}

/* A polyhedron and a pyramid that share faces: the box remains. */
static void shared_faces_of_polyhedra_vanish(void **state)
{
    (void)state;
    expect_read(
        HEAD "UNSTRUCTURED_GRID\nPOINTS 9 double\n0 0 0 2 0 0 2 1 0 0 1 0 0 0 3 2 0 3 2 1 3 0 1 3 1 .5 1.5\n"
             "CELLS 2 49\n5 4 5 6 7 8\n"
             "42 9 4 0 3 2 1 4 0 1 5 4 4 1 2 6 5 4 2 3 7 6 4 3 0 4 7 3 4 5 8 3 5 6 8 3 6 7 8 3 7 4 8\n"
             "CELL_TYPES 2\n14 42\n");
    assert_int_equal(s.part[0].nt, 12);
    assert_near(volume(&s.part[0]), 6.0, 1e-15);
}

static void bad_files_are_reported_with_their_line(void **state)
{
    (void)state;
    expect_refusal(HEAD "STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n",
                   ":4: a data set of kind \"STRUCTURED_POINTS\"");
    expect_refusal("# vtk DataFile Version 3.0\nt\nTEXT\n", "ASCII or BINARY is expected");
    expect_refusal("# vtk DataFile Version 3.0\n", "inside its head");
    expect_refusal(HEAD "POLYDATA\nPOINTS 3 float\n0 0 0 1 0\n", "the file ends inside the data");
    expect_refusal(HEAD "POLYDATA\nPOINTS 2000000000 float\n0 0 0 1 0\n", "the file ends inside the data");
    expect_refusal(HEAD "POLYDATA\nPOINTS 1 float\n0 0 x\n", ":6: \"x\" was found, a number is expected");
    expect_refusal(HEAD "POLYDATA\nPOINTS 1 float\n0 0 1e999\n", "finite coordinates");
    expect_refusal(HEAD "POLYDATA\nPOINTS 1 colour\n", "points of type");
    expect_refusal(HEAD "POLYDATA\n" CUBE "POLYGONS 1 4\n3 0 1 8\n", "cell 0 refers to point 8, 0 to 7");
    expect_refusal(HEAD "POLYDATA\n" CUBE "POLYGONS 1 4\n4 0 1 2\n", "does not fit");
    expect_refusal(HEAD "POLYDATA\n" CUBE "POLYGONS 1 4\n2 0 1 2\n", "1 numbers are left");
    expect_refusal(HEAD "POLYDATA\n" CUBE "CELLS 1 4\n3 0 1 2\n", "do not belong");
    expect_refusal(HEAD "UNSTRUCTURED_GRID\n" CUBE "CELLS 1 4\n3 0 1 2\n", "1 cells have 0 types");
    expect_refusal(HEAD "UNSTRUCTURED_GRID\n" CUBE "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n10\n",
                   "of type 10 has 3 nodes, 4 are expected");
    expect_refusal(HEAD "UNSTRUCTURED_GRID\n" CUBE "CELLS 1 5\n4 1 9 0 1\nCELL_TYPES 1\n42\n",
                   "a number of corners");
    expect_refusal(HEAD "POLYDATA\n" CUBE "ANYTHING 1\n", "\"ANYTHING\" has no place");
    expect_refusal(HEAD "POLYDATA\n" CUBE
                        "POLYGONS 2 3\nOFFSETS vtktypeint64\n1 3\nCONNECTIVITY vtktypeint64\n0 1 2\n",
                   "the first offset is 1");
    expect_refusal(HEAD "POLYDATA\n" CUBE, "no triangles");
}

static void free_all(void **state)
{
    (void)state;
    fl_surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cell_data_follow_the_order_of_kinds),
        cmocka_unit_test(cells_of_all_kinds_have_a_surface),
        cmocka_unit_test(shared_faces_of_polyhedra_vanish),
        cmocka_unit_test(bad_files_are_reported_with_their_line),
        cmocka_unit_test(free_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
