/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/pi.h"
#include "base/rng.h"
#include "geom/facet.h"
#include "geom/moments.h"
#include "geom/mesh_patch.h"
#include "geom/affine.h"
#include "support/near.h"

static fl_err err;

static fl_part box(double a, double b, double c, fl_vec3 at)
{
    fl_part p = {0};
    assert_int_equal(fl_facet_box(&p, at, v3_add(at, v3(a, b, c)), &err), 0);
    return p;
}

/* A box of sides a, b, c at any position: volume V, surface area A, and about the centroid V (b^2 + c^2) /
 * 12. */
static void a_box_has_its_closed_form(void **state)
{
    (void)state;
    for (int far = 0; far < 3; far++) {
        const fl_vec3 at = v3_scale(far ? 1e3 * pow(1024.0, far) : 0.0, v3(1, -3, 2));
        fl_part p = box(2, 3, 5, at);
        const fl_moments m = fl_moments_of(&p, 1);
        assert_near(m.volume, 30.0, 1e-15);
        assert_near(m.area, 62.0, 1e-15);
        assert_near_of(m.centroid.x, at.x + 1.0, 1e-15, 1.0 + fabs(at.x));
        assert_near(m.inertia.m[0][0], 30.0 * (9 + 25) / 12.0, 1e-14);
        assert_near(m.inertia.m[1][1], 30.0 * (4 + 25) / 12.0, 1e-14);
        assert_near(m.inertia.m[2][2], 30.0 * (4 + 9) / 12.0, 1e-14);
        for (int i = 0; i < 3; i++) assert_near_of(m.inertia.m[i][(i + 1) % 3], 0.0, 1e-14, 30.0);
        fl_part_free(&p);
    }
}

/* A cylinder: V = pi r^2 h, along the axis V r^2 / 2, across V (3 r^2 + h^2) / 12. A cone of the same size: V
 * / 3, 3 V r^2 / 10, and V (3 r^2 / 20 + 3 h^2 / 80). A truncated cone is the difference of two cones. */
static void round_solids_have_their_closed_forms(void **state)
{
    const double r = 1.5, h = 4.0, v = PI * r * r * h;
    fl_part p = {0};
    fl_moments m, tip, whole;
    (void)state;
    fl_surface_cone(&p, (fl_cone){v3(7, -2, 1), v3(7 + h, -2, 1), r, r}, &err);
    m = fl_moments_of(&p, 1);
    assert_near(m.volume, v, 1e-15);
    assert_near(m.area, 2 * PI * r * (r + h), 1e-15);
    assert_near(m.centroid.x, 7 + h / 2, 1e-15);
    assert_near(m.inertia.m[0][0], v * r * r / 2, 1e-14);
    assert_near(m.inertia.m[1][1], v * (3 * r * r + h * h) / 12, 1e-14);
    p.cone[0].r1 = 0.0;
    m = fl_moments_of(&p, 1);
    assert_near(m.volume, v / 3, 1e-15);
    assert_near(m.centroid.x, 7 + h / 4, 1e-15);
    assert_near(m.inertia.m[0][0], v / 3 * 0.3 * r * r, 1e-14);
    assert_near(m.inertia.m[2][2], v / 3 * (0.15 * r * r + 3 * h * h / 80), 1e-14);
    whole = m;
    p.cone[0].p0.x += h / 2;
    p.cone[0].r0 = r / 2;
    tip = fl_moments_of(&p, 1);
    p.cone[0] = (fl_cone){v3(7, -2, 1), v3(7 + h / 2, -2, 1), r, r / 2};
    m = fl_moments_of(&p, 1);
    assert_near(m.volume, whole.volume - tip.volume, 1e-14);
    assert_near(m.inertia.m[0][0], whole.inertia.m[0][0] - tip.inertia.m[0][0], 1e-14);
    fl_part_free(&p);
}

static void quarter_turns_are_exact(void **state)
{
    (void)state;
    for (int k = -8; k <= 8; k++) {
        const fl_mat3 r = fl_affine_rotation(v3(0, 0, 2.5), 90.0 * k);
        const double c[4] = {1, 0, -1, 0};
        const int j = ((k % 4) + 4) % 4;
        assert_true(r.m[0][0] == c[j] && r.m[1][1] == c[j] && r.m[2][2] == 1.0);
        assert_true(r.m[1][0] == c[(j + 3) % 4] && r.m[0][1] == -c[(j + 3) % 4]);
        assert_true(r.m[0][2] == 0.0 && r.m[2][1] == 0.0);
    }
    const fl_vec3 y = m3_mul(fl_affine_rotation(v3(1, 0, 0), 30.0), v3(0, 1, 0));
    assert_near(y.y, sqrt(0.75), 1e-15);
    assert_near(y.z, 0.5, 1e-15);
}

/* For every map, V scales by s^3, A by s^2, and J by s^5 with the rotation. Normals stay outward. Triangles
 * and cones behave alike. */
static void maps_scale_volume_area_and_inertia(void **state)
{
    (void)state;
    for (long k = 0; k < test_times(200); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const fl_vec3 axis = v3(fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1));
        fl_part p = box(fl_rng_in(&g, 1, 9), fl_rng_in(&g, 1, 9), fl_rng_in(&g, 1, 9), axis);
        fl_affine m = {fl_affine_rotation(axis, fl_rng_in(&g, -720, 720)), pow(10.0, fl_rng_in(&g, -3, 3)),
                       v3_scale(0.0, axis)};
        const fl_mat3 mirror = {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        m.t = v3_scale(3.0 * m.s, axis); /* at larger offsets the coordinates themselves lose digits */
        fl_moments was, is;
        fl_mesh_quality q;
        if (k % 2) m.q = fl_affine_matrix_product(&m.q, &mirror);
        if (k % 3 == 0) fl_surface_cone(&p, (fl_cone){v3(0, 1, 2), v3(3, 1, 0), 2.0, 1.0}, &err);
        was = fl_moments_of(&p, 1);
        fl_part_map(&p, &m);
        is = fl_moments_of(&p, 1);
        assert_int_equal(fl_part_measure(&p, &q, &err), 0);
        assert_int_equal(q.inverted, 0);
        assert_near(is.volume, was.volume * pow(m.s, 3), 1e-14);
        assert_near(is.area, was.area * pow(m.s, 2), 1e-14);
        const fl_vec3 c = v3_madd(m.t, m.s, m3_mul(m.q, was.centroid));
        assert_near_of(v3_norm(v3_sub(is.centroid, c)), 0.0, 1e-14, 30.0 + 30.0 * m.s);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                double turned = 0.0;
                for (int a = 0; a < 3; a++)
                    for (int b = 0; b < 3; b++) turned += m.q.m[i][a] * was.inertia.m[a][b] * m.q.m[j][b];
                assert_near_of(is.inertia.m[i][j], turned * pow(m.s, 5), 1e-12,
                               pow(m.s, 5) * (was.inertia.m[0][0] + was.inertia.m[1][1]));
            }
        fl_part_free(&p);
    }
}

static void an_empty_part_has_no_moments(void **state)
{
    const fl_part p = {0};
    (void)state;
    assert_true(fl_moments_of(&p, 1).volume == 0.0 && fl_moments_of(&p, 0).area == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_has_its_closed_form), cmocka_unit_test(round_solids_have_their_closed_forms),
        cmocka_unit_test(quarter_turns_are_exact), cmocka_unit_test(maps_scale_volume_area_and_inertia),
        cmocka_unit_test(an_empty_part_has_no_moments)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
