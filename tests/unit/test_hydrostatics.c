/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/near.h"
#include <string.h>
#include "structure/hydrostatics.h"
#include "support/small_world.h"

static void a_box_at_any_position(void **state)
{
    lab l;
    fl_hydrostatics f = {0};
    fl_err err = {0};
    double K[6][6] = {{0}};
    (void)state;
    lab_start(&l);
    lab_wall(&l, v3(1, 2, -3), v3(5, 8, 2), 3); /* 4 by 6, draft 2.5 at level -0.5 */
    const fl_vec3 G = v3(2, 4, -1);
    assert_int_equal(fl_hydrostatics_add(&f, &l.surface.part[0], -0.5, G, &err), 0);
    assert_int_equal(fl_hydrostatics_finish(&f, -0.5, G, &err), 0);
    assert_near(f.volume, 4 * 6 * 2.5, 1e-14);
    assert_near(f.area, 24, 1e-14);
    assert_near(f.buoyancy_centre.x, 1, 1e-14);
    assert_near(f.buoyancy_centre.y, 1, 1e-14);
    assert_near(f.buoyancy_centre.z, -1.75 + 1, 1e-13);
    assert_near(f.x, 24, 1e-13);
    assert_near(f.yy, 4 * 216.0 / 12 + 24, 1e-13);
    assert_near(f.xy, 24, 1e-13);
    fl_hydrostatics_stiffness(&f, 1e4, K);
    assert_near(K[2][2], 24e4, 1e-14);
    assert_near(K[3][3], 1e4 * (72 + 24 + 60 * -0.75), 1e-12);
    assert_near(K[4][4], 1e4 * (32 + 24 + 60 * -0.75), 1e-12);
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++) assert_near(K[r][c], K[c][r], 0);
    assert_near(K[2][3], 24e4, 1e-13);
    assert_near(K[2][4], -24e4, 1e-13);
    assert_near(K[3][4], -24e4, 1e-13);
    lab_free(&l);
}

static void an_l_shape_with_water_through_its_vertices(void **state)
{
    /* not convex, and the water plane passes through a row of vertices */
    const fl_vec3 L[6] = {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
    lab l;
    fl_err err = {0};
    (void)state;
    lab_start(&l);
    lab_prism(&l, 6, L, -2, 0);
    for (int k = 0; k < 3; k++) {
        const double level = k == 0 ? 0.0 : k == 1 ? 1e-12 : -1e-12;
        fl_hydrostatics f = {0};
        assert_int_equal(fl_hydrostatics_add(&f, &l.surface.part[0], level, v3(0, 0, 0), &err), 0);
        assert_int_equal(fl_hydrostatics_finish(&f, level, v3(0, 0, 0), &err), 0);
        assert_near(f.volume, 12, 1e-11);
        if (k != 1) assert_near(f.area, 6, 1e-11); /* a submerged body has no waterplane section */
        else assert_near_of(f.area, 0, 1e-11, 1.0);
    }
    lab_free(&l);
}

static void a_body_that_cannot_float_is_reported(void **state)
{
    lab l;
    fl_err err = {0};
    fl_hydrostatics f = {0};
    (void)state;
    lab_start(&l);
    lab_wall(&l, v3(0, 0, 0), v3(1, 1, 1), 1);
    lab_cone(&l, (fl_cone){v3(0, 0, 0), v3(0, 0, 1), 1, 1});
    assert_int_equal(fl_hydrostatics_add(&f, &l.surface.part[1], 0, v3(0, 0, 0), &err), -1);
    assert_non_null(strstr(err.text, "a cone has no mesh"));
    err = (fl_err){0};
    assert_int_equal(fl_hydrostatics_add(&f, &l.surface.part[0], -1, v3(0, 0, 0), &err), 0);
    assert_int_equal(fl_hydrostatics_finish(&f, -1, v3(0, 0, 0), &err), -1);
    assert_non_null(strstr(err.text, "the mesh displaces 0 m3"));
    err = (fl_err){0};
    l.surface.part[0].nt--;
    assert_int_equal(fl_hydrostatics_add(&f, &l.surface.part[0], 0.5, v3(0, 0, 0), &err), -1);
    assert_non_null(strstr(err.text, "its triangles do not close"));
    lab_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_box_at_any_position),
                                       cmocka_unit_test(an_l_shape_with_water_through_its_vertices),
                                       cmocka_unit_test(a_body_that_cannot_float_is_reported)};
    return cmocka_run_group_tests_name("hydrostatics", tests, NULL, NULL);
}
