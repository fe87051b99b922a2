/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>
#include "support/near.h"
#include "base/array.h"
#include "scene/ice_field.h"
#include "scene/ice_field_order.h"

#define CUBE_V "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
#define CUBE_F "f 4 3 2 1 0\nf 4 4 5 6 7\nf 4 0 1 5 4\nf 4 1 2 6 5\nf 4 2 3 7 6\nf 4 3 0 4 7\n"

static int read_text(fl_ice_field *a, const char *text, fl_err *err)
{
    *err = (fl_err){0};
    return fl_ice_field_read(a, test_file("field.dat", text, strlen(text)), err);
}

static void a_field_is_read_whole(void **state)
{
    (void)state;
    static const char text[] =
        "#g-polys 1\n#by someone 2 --seed 3\n# spheres, capsules, cubes\n"
        "poly 7 0.5 1 0 material=ice\r\nv 1 2 3\n"
        "vel 1 0 0 0 0 -2\n"
        "poly 3 0.25 2 0 group=far material=steel\nv 0 0 0\nv 0 0 2   # the other end\n\n"
        "poly 5 0 8 6 material=ice\n" CUBE_V CUBE_F;
    fl_ice_field a = {0};
    fl_err err;
    assert_int_equal(read_text(&a, text, &err), 0);
    assert_int_equal(a.n, 3);
    assert_int_equal(a.id[0], 7);
    assert_int_equal(a.id[2], 5);
    assert_int_equal(a.record_line[1], 7);
    assert_string_equal(a.materials.name[a.material[0]], "ice");
    assert_string_equal(a.materials.name[a.material[1]], "steel");
    assert_int_equal(a.material[2], a.material[0]);
    assert_int_equal(a.group[0], -1);
    assert_string_equal(a.groups.name[a.group[1]], "far");
    assert_true(a.radius[0] == 0.5 && a.radius[1] == 0.25 && a.radius[2] == 0.0);
    assert_true(a.velocity[0].x == 1.0 && a.spin[0].z == -2.0 && a.velocity[1].x == 0.0);
    assert_int_equal(a.core[0].nv, 1);
    assert_int_equal(a.core[1].nv, 2);
    assert_int_equal(a.core[2].nf, 6);
    assert_true(a.core[1].v[1].z == 2.0);
    assert_string_equal(a.history, "#by someone 2 --seed 3\n");
    fl_ice_field_free(&a);
}

static char *write_field(const fl_ice_field *a, char *buf, size_t capacity)
{
    fl_history_line by;
    FILE *f = fmemopen(buf, capacity, "w");
    assert_non_null(f);
    fl_history_line_start(&by, "test");
    fl_ice_field_write(f, a, &by);
    fclose(f);
    return buf;
}

static void a_written_field_reads_back(void **state)
{
    (void)state;
    static const char text[] = "#g-polys 1\n#by a 1\npoly 7 0.1 1 0\nv 0.1 1e-300 -3.3333333333333335\n"
                               "vel 0 0 0 1e-200 0 0\npoly 0 1e-3 8 6 material=ice group=g\n" CUBE_V CUBE_F;
    static char once[4000], twice[4000];
    fl_ice_field a = {0}, b = {0};
    fl_err err;
    assert_int_equal(read_text(&a, text, &err), 0);
    assert_int_equal(read_text(&b, write_field(&a, once, sizeof once), &err), 0);
    assert_true(b.core[0].v[0].x == 0.1 && b.core[0].v[0].y == 1e-300 && b.spin[0].x == 1e-200);
    assert_string_equal(b.history, "#by a 1\n#by test " FL_VERSION "\n");
    write_field(&b, twice, sizeof twice); /* its history has one line more, the bodies are the same */
    assert_string_equal(strstr(once, "\npoly"), strstr(twice, "\npoly"));
    fl_ice_field_free(&a);
    fl_ice_field_free(&b);
}

static void expect_refusal(const char *text, const char *where_and_why)
{
    fl_ice_field a = {0};
    fl_err err;
    char head[700];
    assert_int_equal(read_text(&a, text, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_int_equal(a.n, 0);
    assert_null(a.id);
    snprintf(head, sizeof head, "%s:%s", test_path("field.dat"), where_and_why);
    if (strncmp(err.text, head, strlen(head)) != 0)
        fail_msg("\"%s\" where \"%s\" is expected", err.text, head);
}

static void faults_are_reported_with_their_line(void **state)
{
    (void)state;
    expect_refusal("", " empty, a g-polys file is expected");
    expect_refusal("#g_struct 1\n", "1: this is a g_struct file, a g-polys file is expected");
    expect_refusal("#g-polys 4\n", "1: g-polys version 4 is newer than this program, which reads up to 3");
    expect_refusal("#g-polys 1\n\n", "2: the file ends without a body, a poly record is expected");
    expect_refusal("#g-polys 1\nv 0 0 0\n", "2: v found before the first poly");
    expect_refusal("#g-polys 1\nploy 1 1 1 0\n", "2: unknown record \"ploy\", the nearest is \"poly\"");
    expect_refusal("#g-polys 1\npoly 1 1 1\n", "2: number of faces is missing after 4 fields");
    expect_refusal("#g-polys 1\npoly -1 1 1 0\nv 0 0 0\n",
                   "2: id is \"-1\", a whole number from 0 to 2147483647 is expected");
    expect_refusal("#g-polys 1\npoly 1 nan 1 0\nv 0 0 0\n",
                   "2: radius is \"nan\", a finite number is expected");
    expect_refusal("#g-polys 1\npoly 1 -0.1 1 0\nv 0 0 0\n",
                   "2: body 1 has radius -0.1 m, 0 to 1e+09 m is expected");
    expect_refusal("#g-polys 1\npoly 1 0 1 0\nv 0 0 0\n",
                   "2: body 1 is a point of radius 0 and has no volume, a radius above 0 is expected");
    expect_refusal("#g-polys 1\npoly 1 0 2 0\nv 0 0 0\nv 1 0 0\n", "2: body 1 is a segment of radius 0");
    expect_refusal("#g-polys 1\npoly 1 0 4 2\n", "2: body 1 is a flat polygon of radius 0");
    expect_refusal("#g-polys 1\npoly 1 1 2 1\n", "2: body 1 has 2 vertices and 1 faces, no face is expected");
    expect_refusal("#g-polys 1\npoly 1 1 4 0\n",
                   "2: body 1 has 4 vertices and 0 faces, faces that close it are expected");
    expect_refusal("#g-polys 1\npoly 1 1 0 0\n",
                   "2: number of vertices is \"0\", a whole number from 1 to 2147483646 is expected");
    expect_refusal("#g-polys 1\npoly 1 1 1 0 colour=red\n",
                   "2: unknown key \"colour\", the nearest is \"group\"");
    expect_refusal("#g-polys 1\npoly 1 1 1 0 material=\n", "2: \"material=\" found, key=value is expected");
    expect_refusal("#g-polys 1\npoly 1 1 1 0 ice\n", "2: \"ice\" found, key=value is expected");
    expect_refusal("#g-polys 1\npoly 1 1 1 0 group=a group=a\n", "2: group is given twice");
    expect_refusal("#g-polys 1\npoly 1 1 1 0\nv 0 0\n", "3: z is missing after 3 fields");
    expect_refusal("#g-polys 1\npoly 1 1 1 0\nv 0 0 0 0\n", "3: \"0\" was not expected after 4 fields");
    expect_refusal("#g-polys 1\npoly 1 1 1 0\nv 0 inf 0\n", "3: y is \"inf\", a finite number is expected");
    expect_refusal("#g-polys 1\npoly 1 1 1 0\nv 0 2e9 0\n",
                   "3: vertex (0, 2e+09, 0) m is farther than 1e+09 m");
    expect_refusal("#g-polys 1\npoly 1 1 1 0\nv 0 0 0\nv 0 0 0\n",
                   "4: body 1 has its 1 vertices, another one follows");
    expect_refusal("#g-polys 1\npoly 1 1 1 0\nv 0 0 0\nf 3 0 0 0\n",
                   "4: body 1 has its 0 faces, another one follows");
    expect_refusal("#g-polys 1\npoly 9 1 2000000000 6\nv 0 0 0\n",
                   "2: body 9 announces 2000000000 vertices and 6 faces, 1 and 0 follow");
    expect_refusal("#g-polys 1\npoly 9 1 2 0\nv 0 0 0\npoly 1 1 1 0\n",
                   "2: body 9 announces 2 vertices and 0 faces, 1 and 0 follow");
    expect_refusal("#g-polys 1\npoly 9 1 2 0\nvel 0 0 0 0 0 0\n",
                   "3: vel comes before the last vertex and face of body 9");
    expect_refusal("#g-polys 1\npoly 9 1 1 0\nv 0 0 0\nvel 0 0 0 0 0 0\nvel 0 0 0 0 0 0\n",
                   "5: body 9 has two vel records");
    expect_refusal("#g-polys 1\npoly 9 1 1 0\nv 0 0 0\nvel 0 0 0 0 0\n", "4: wz is missing after 6 fields");
    expect_refusal("#g-polys 1\npoly 9 1 8 6\nf 3 0 1 2\n",
                   "3: body 9 announces 8 vertices, a face follows after 0");
    expect_refusal("#g-polys 1\npoly 9 1 8 6\n" CUBE_V "f 4 0 1 2 8\n",
                   "11: vertex of the face is \"8\", a whole number from 0 to 7 is expected");
    expect_refusal("#g-polys 1\npoly 9 1 8 6\n" CUBE_V "f 2 0 1\n",
                   "11: number of corners is \"2\", a whole number from 3 to 8 is expected");
    expect_refusal("#g-polys 1\npoly 9 1 8 6\n" CUBE_V "f 4 0 1 2\n",
                   "11: vertex of the face is missing after 5 fields");
    expect_refusal("#g-polys 1\npoly 4 1 1 0\nv 0 0 0\npoly 2 1 1 0\nv 0 0 0\npoly 4 1 1 0\nv 0 0 0\n"
                   "poly 2 1 1 0\nv 0 0 0\n",
                   "6: body 4 is already on line 2, another id is expected");
}

/* An invalid core is reported with the line of its poly record and the id. */
#define BALLS "poly 7 0.5 1 0\nv 0 0 0\npoly 3 0.5 1 0\nv 1 0 0\npoly 5 0.5 1 0\nv 2 0 0\n"

static void bonds_are_read_sorted_and_written(void **state)
{
    (void)state;
    static char once[4000];
    fl_ice_field a = {0}, b = {0};
    fl_err err;
    assert_int_equal(
        read_text(&a, "#g-polys 2\n" BALLS "bond 5 3 0.25 0.5 1.5 0 0\nbond 3 7 2 1 0.5 -1 3\n", &err), 0);
    assert_int_equal(a.bonds, 2);
    assert_true(a.bond[0].i == 0 && a.bond[0].j == 1 && a.bond[1].i == 1 && a.bond[1].j == 2);
    assert_true(a.bond[0].area == 2.0 && a.bond[0].length == 1.0);
    assert_true(a.bond[0].x.x == 0.5 && a.bond[0].x.y == -1.0 && a.bond[0].x.z == 3.0);
    write_field(&a, once, sizeof once);
    assert_non_null(strstr(once, "#g-polys 2\n"));
    assert_non_null(strstr(once, "\nbond 7 3 2 1 0.5 -1 3\nbond 3 5 0.25 0.5 1.5 0 0\n"));
    assert_int_equal(read_text(&b, once, &err), 0);
    assert_int_equal(b.bonds, 2);
    b.bonds = 0; /* without bonds the file is one that older readers accept */
    assert_non_null(strstr(write_field(&b, once, sizeof once), "#g-polys 1\n"));
    fl_ice_field_free(&a);
    fl_ice_field_free(&b);
}

static void invalid_bonds_are_reported_with_their_line(void **state)
{
    (void)state;
    expect_refusal("#g-polys 1\n" BALLS "bond 3 5 1 1 0 0 0\n",
                   "8: a bond is of g-polys 2, the file says g-polys 1");
    expect_refusal("#g-polys 2\n" BALLS "bond 3 3 1 1 0 0 0\n",
                   "8: body 3 is bonded to itself, two bodies are expected");
    expect_refusal("#g-polys 2\n" BALLS "bond 3 4 1 1 0 0 0\n",
                   "8: the bond names body 4, which is not in the file");
    expect_refusal("#g-polys 2\n" BALLS "bond 3 5 1 1 0 0 0\nbond 5 3 1 1 0 0 0\n",
                   "9: bodies 3 and 5 are bonded on line 8 already");
    expect_refusal("#g-polys 2\n" BALLS "bond 3 5 0 1 0 0 0\n",
                   "8: the bond has area 0 m2 and length 1 m, more than 0 is expected");
    expect_refusal("#g-polys 2\n" BALLS "bond 3 5 1 -1 0 0 0\n", "8: the bond has area 1 m2 and length -1 m");
    expect_refusal("#g-polys 2\n" BALLS "bond 3 5 1 1 0 0\n", "8: z is missing after 7 fields");
    expect_refusal("#g-polys 2\n" BALLS "bond 3 5 1 1 0 2e9 0\n",
                   "8: centroid (0, 2e+09, 0) m is farther than");
    expect_refusal("#g-polys 2\n" BALLS "bond 3 5 1 1 0 0 0\nv 0 0 0\n", "9: v found behind a bond");
    expect_refusal("#g-polys 2\npoly 1 1 1 0\nbond 1 2 1 1 0 0 0\n",
                   "2: body 1 announces 1 vertices and 0 faces, 0 and 0 follow");
}

static void invalid_cores_are_reported_with_their_id(void **state)
{
    (void)state;
    expect_refusal("#g-polys 1\n\npoly 12 1 8 6\n" CUBE_V
                   "f 4 0 1 2 3\nf 4 4 5 6 7\nf 4 0 1 5 4\nf 4 1 2 6 5\nf 4 2 3 7 6\nf 4 3 0 4 7\n",
                   "3: body 12: ");
    expect_refusal("#g-polys 1\npoly 12 1 8 5\n" CUBE_V
                   "f 4 3 2 1 0\nf 4 4 5 6 7\nf 4 0 1 5 4\nf 4 1 2 6 5\nf 4 2 3 7 6\n",
                   "2: body 12: ");
    /* a cube whose upper face has a dent: vertex 8 lies inside */
    expect_refusal("#g-polys 1\npoly 12 1 9 9\n" CUBE_V "v 0.5 0.5 0.5\n"
                   "f 4 3 2 1 0\nf 4 0 1 5 4\nf 4 1 2 6 5\nf 4 2 3 7 6\nf 4 3 0 4 7\n"
                   "f 3 4 5 8\nf 3 5 6 8\nf 3 6 7 8\nf 3 7 4 8\n",
                   "2: body 12: ");
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    static const char text[] = "#g-polys 2\n#by a 1\npoly 0 1e-3 8 6 material=ice group=g\n" CUBE_V CUBE_F
                               "poly 1 1 1 0\nv 9 9 9\nbond 0 1 1 1 2 2 2\n";
    int rc = -1;
    for (long k = 0; rc; k++) {
        fl_ice_field a = {0};
        fl_err err = {0};
        const char *path = test_file("field.dat", text, sizeof text - 1);
        fl_alloc_fail_after(k);
        rc = fl_ice_field_read(&a, path, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
        assert_int_equal(a.n, rc ? 0 : 2);
        fl_ice_field_free(&a);
        assert_true(k < 1000);
    }
}

/* Spheres on a line, listed and numbered in two ways, with a bond between the first and the third along x. */
static void the_order_depends_only_on_the_bodies(void **state)
{
    static const char *const text[2] = {
        "#g-polys 2\npoly 1 0.5 1 0 material=ice\nv 2 0 0\npoly 2 0.25 1 0 group=far material=steel\nv 0 0 "
        "0\n"
        "vel 1 2 3 4 5 6\npoly 3 0.5 1 0\nv 1 0 0\npoly 4 0.25 1 0\nv 1 0 0\nbond 1 2 0.1 0.2 1 0 0\n",
        "#g-polys 2\npoly 9 0.25 1 0\nv 1 0 0\npoly 8 0.5 1 0\nv 1 0 0\npoly 7 0.25 1 0 group=far "
        "material=steel\n"
        "v 0 0 0\nvel 1 2 3 4 5 6\npoly 6 0.5 1 0 material=ice\nv 2 0 0\nbond 6 7 0.1 0.2 1 0 0\n"};
    static const int32_t id[2][4] = {{2, 4, 3, 1}, {7, 9, 8, 6}}, was[2][4] = {{3, 0, 2, 1}, {1, 2, 0, 3}};
    (void)state;
    for (int k = 0; k < 2; k++) {
        fl_ice_field a = {0};
        fl_err err;
        int32_t at[4];
        assert_int_equal(read_text(&a, text[k], &err), 0);
        assert_int_equal(fl_ice_field_order(&a, at, &err), 0);
        for (int i = 0; i < 4; i++) {
            assert_int_equal(a.id[i], id[k][i]);
            assert_int_equal(at[i], was[k][i]);
        }
        assert_true(a.radius[0] == 0.25 && a.radius[1] == 0.25 && a.radius[2] == 0.5 && a.radius[3] == 0.5);
        assert_true(a.core[0].v[0].x == 0.0 && a.core[3].v[0].x == 2.0);
        assert_true(a.velocity[0].y == 2.0 && a.spin[0].z == 6.0 && a.velocity[1].y == 0.0);
        assert_string_equal(a.groups.name[a.group[0]], "far");
        assert_string_equal(a.materials.name[a.material[3]], "ice");
        assert_int_equal(a.material[1], -1);
        assert_int_equal(a.bond[0].i, 0);
        assert_int_equal(a.bond[0].j, 3);
        fl_ice_field_free(&a);
    }
}

/* A large field: the same order for every input order, and most neighbours within a few hundred positions. */
static void a_large_field_follows_the_hilbert_curve(void **state)
{
    enum { SIDE = 80, N = SIDE * SIDE };
    static int32_t position[2][N + 1], at[N];
    (void)state;
    for (int k = 0; k < 2; k++) {
        fl_ice_field a = {0};
        fl_err err = {0};
        for (int32_t i = 0; i < N; i++) {
            const int32_t c = k ? N - 1 - i : i;
            const fl_vec3 x = v3(c % SIDE, c / SIDE, 0.1 * (c % 3));
            fl_poly p = {0};
            assert_int_equal(fl_poly_make(&p, 1, &x, 0, NULL, NULL, &err), 0);
            assert_int_equal(fl_ice_field_add(&a, c + 1, 0.5, &p, NULL, NULL, v3(0, 0, 0), v3(0, 0, 0), &err),
                             0);
        }
        assert_int_equal(fl_ice_field_order(&a, at, &err), 0);
        for (int32_t i = 0; i < N; i++) position[k][a.id[i]] = i;
        fl_ice_field_free(&a);
    }
    assert_memory_equal(position[0], position[1], sizeof position[0]);
    int32_t near = 0;
    for (int32_t c = 0; c + SIDE < N; c++) near += abs(position[0][c + 1 + SIDE] - position[0][c + 1]) < 256;
    assert_true(near > 0.85 * N);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_field_is_read_whole),
                                       cmocka_unit_test(the_order_depends_only_on_the_bodies),
                                       cmocka_unit_test(a_large_field_follows_the_hilbert_curve),
                                       cmocka_unit_test(a_written_field_reads_back),
                                       cmocka_unit_test(faults_are_reported_with_their_line),
                                       cmocka_unit_test(bonds_are_read_sorted_and_written),
                                       cmocka_unit_test(invalid_bonds_are_reported_with_their_line),
                                       cmocka_unit_test(invalid_cores_are_reported_with_their_id),
                                       cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
