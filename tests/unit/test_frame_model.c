/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "mesh/frame_model.h"

static double relative(double x, double is) { return fabs(x - is) / fabs(is); }

/* Area and second moments about the centroid by small squares; y goes up, z across. */
typedef struct {
    double a, iy, iz;
} moments;

typedef int in_section(double y, double z);

static moments count_squares(in_section *in, double h, double b)
{
    enum { N = 600 };
    const double dy = h / N, dz = b / N, da = dy * dz;
    double a = 0.0, sy = 0.0, yy = 0.0, zz = 0.0;
    for (int r = 0; r < N; r++)
        for (int c = 0; c < N; c++) {
            const double y = (r + 0.5) * dy, z = (c + 0.5) * dz - 0.5 * b;
            if (!in(y, z)) continue;
            a += da;
            sy += da * y;
            yy += da * y * y;
            zz += da * z * z;
        }
    return (moments){a, zz, yy - sy * sy / a};
}

static int in_box(double y, double z) { return y < 20 || y > 280 || z < -90 || z > 90; }

static int in_i(double y, double z) { return y < 15 ? fabs(z) < 100 : y > 288 ? fabs(z) < 60 : fabs(z) < 5; }

static void boxes_and_i_have_their_moments(void **state)
{
    (void)state;
    const fl_frame_section box = fl_frame_section_box(200, 300, 20, 10),
                           i = fl_frame_section_i(300, 200, 120, 10, 15, 12);
    const moments b = count_squares(in_box, 300, 200), m = count_squares(in_i, 300, 200);
    assert_true(relative(box.a, b.a) < 5e-3 && relative(box.iy, b.iy) < 5e-3 &&
                relative(box.iz, b.iz) < 5e-3);
    assert_true(relative(i.a, m.a) < 5e-3 && relative(i.iy, m.iy) < 1e-2 && relative(i.iz, m.iz) < 5e-3);
    /* Bredt: a square box of wall t about a square of side c has J = t c3. */
    assert_true(relative(fl_frame_section_box(100, 100, 4, 4).j, 4.0 * 96.0 * 96.0 * 96.0) < 1e-12);
    const fl_frame_section rod = fl_frame_section_rod(3.0);
    assert_true(rod.form == FL_FRAME_PIPE && rod.size[0] == 6.0 && rod.size[1] == 3.0);
}

static void what_is_left_is_counted_by_name(void **state)
{
    (void)state;
    fl_frame_model f = {0};
    fl_err err = {0};
    for (int k = 0; k < 3; k++) fl_frame_count_skipped(&f, "CELAS%d", 2);
    fl_frame_count_skipped(&f, "GRAV");
    assert_int_equal(f.skipped_name.n, 2);
    assert_string_equal(f.skipped_name.name[0], "CELAS2");
    assert_true(f.skipped[0] == 3 && f.skipped[1] == 1 && !f.failed);
    /* A node, a material and a section are the same when asked for again, and what they hold stays. */
    const int32_t n = fl_frame_node_of(&f, 0, 7, &err);
    f.node[n].mass = 5.0;
    assert_true(fl_frame_node_of(&f, 1, 7, &err) != n && fl_frame_node_of(&f, 0, 7, &err) == n);
    assert_true(f.node[n].mass == 5.0);
    const int32_t s = fl_frame_section_of(&f, "p1", &err);
    assert_true(f.section[s].form == FL_FRAME_NONE && f.section[s].material == -1);
    assert_true(fl_frame_section_of(&f, "p1", &err) == s && fl_frame_material_of(&f, "p1", &err) == 0);
    fl_frame_model_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(boxes_and_i_have_their_moments),
                                       cmocka_unit_test(what_is_left_is_counted_by_name)};
    return cmocka_run_group_tests_name("frame_model", tests, NULL, NULL);
}
