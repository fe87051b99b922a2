/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "mesh/read_mesh.h"
#include "mesh/write_vtp.h"
#include "support/mesh.h"
#include "support/model.h"
#include "support/near.h"

static fl_err err;
static char note[FL_MESH_NOTE];
static fl_surface s;

static int read_bytes(const char *data, size_t n)
{
    fl_surface_free(&s);
    err = (fl_err){0};
    return fl_mesh_read(&s, test_file("grid.vtx", data, n), NULL, note, &err);
}

static void expect_refusal(const char *text, const char *why)
{
    assert_int_equal(read_bytes(text, strlen(text)), -1);
    assert_int_equal(err.code, FL_INPUT);
    if (!strstr(err.text, why)) fail_msg("\"%s\" says nothing of \"%s\"", err.text, why);
}

/* The file of --to vtp is read back with the names of its parts. */
static void a_written_file_is_read_back(void **state)
{
    static model m;
    fl_surface body = {0};
    char *text = NULL;
    size_t n = 0;
    FILE *f = open_memstream(&text, &n);
    (void)state;
    model_make(&m, FL_HEX8);
    model_surface(&m, &body);
    assert_int_equal(fl_vtp_write(f, &body, &err), 0);
    assert_int_equal(fclose(f), 0);
    if (read_bytes(text, n)) fail_msg("%s", err.text);
    assert_true(mesh_sound(&s));
    assert_true(model_same(&s, &body));
    /* and a truncated file is refused */
    for (size_t k = 60; k + 40 < n; k += 97)
        if (read_bytes(text, k) == 0) fail_msg("%zu of %zu bytes were read", k, n);
    fl_surface_free(&body);
    free(text);
}

#define HEAD "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\">\n"
#define POINTS "<Points><DataArray type=\"Float32\" format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points>\n"
#define POLYS(c, o)                                                                                          \
    "<Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" c "</DataArray>\n"            \
    "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">" o "</DataArray></Polys>\n"
#define TAIL "</Piece></PolyData></VTKFile>\n"

static void pieces_keep_their_own_points(void **state)
{
    static const char text[] = HEAD
        "<PolyData><Piece>" POINTS POLYS("0 1 2", "3") "</Piece>\n<Piece>" POINTS POLYS("2 1 0", "3") TAIL;
    (void)state;
    assert_int_equal(read_bytes(text, sizeof text - 1), 0);
    assert_int_equal(s.part[0].nt, 2);
    assert_int_equal(s.part[0].nv, 6);
}

static void bad_files_are_reported_with_their_line(void **state)
{
    (void)state;
    expect_refusal("<?xml version=\"1.0\"?>\n<svg></svg>\n", ":2: <svg> was found, <VTKFile> is expected");
    expect_refusal("<VTKFile type=\"ImageData\"></VTKFile>", "of type \"ImageData\"");
    expect_refusal("<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"></VTKFile>",
                   "with zlib or not packed");
    expect_refusal(HEAD "<PolyData><Piece>" POINTS, "before </VTKFile>");
    expect_refusal(HEAD "<PolyData><Piece>" POINTS POLYS("0 1 3", "3") TAIL,
                   "cell 0 refers to point 3, 0 to 2");
    expect_refusal(HEAD "<PolyData><Piece>" POINTS POLYS("0 1 2", "4") TAIL, "corners up to place 4");
    expect_refusal(HEAD "<PolyData><Piece>" POINTS POLYS("0 1 x", "3") TAIL,
                   ":3: \"x\" was found, a number is expected");
    expect_refusal(
        HEAD
        "<PolyData><Piece><Points><DataArray type=\"Float32\" format=\"ascii\">0 1 inf</DataArray></Points>",
        "before </VTKFile>");
    expect_refusal(HEAD "<PolyData><Piece><Points><DataArray type=\"Float32\" "
                        "format=\"binary\">AAAA</DataArray></Points>" TAIL,
                   "the data end too early");
    expect_refusal(HEAD "<PolyData><Piece><Points><DataArray type=\"Float32\" "
                        "format=\"binary\">A*AA</DataArray></Points>" TAIL,
                   "none of base64");
    expect_refusal(HEAD "<PolyData><Piece><Points><DataArray type=\"Float32\" format=\"appended\" "
                        "offset=\"0\"/></Points>" TAIL,
                   "where nothing is");
    expect_refusal(
        HEAD
        "<PolyData><Piece><Points><DataArray type=\"Float16\" format=\"ascii\">0</DataArray></Points>" TAIL,
        "of type \"Float16\"");
    expect_refusal(HEAD "<PolyData></PolyData></VTKFile>", "no triangles");
}

static void free_all(void **state)
{
    (void)state;
    fl_surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_written_file_is_read_back),
        cmocka_unit_test(pieces_keep_their_own_points),
        cmocka_unit_test(bad_files_are_reported_with_their_line),
        cmocka_unit_test(free_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
