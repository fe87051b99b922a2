/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "support/near.h"
#include "base/pi.h"
#include "base/rng.h"
#include "pack/pack_passage.h"

static void make_region(fl_pack_region *r, const char *in, int dim, const char *text)
{
    fl_err err = {0};
    const int rc = fl_region_make(r, text ? test_file(in, text, strlen(text)) : in, dim, "", &err);
    if (rc) printf("%s\n", err.text);
    assert_int_equal(rc, 0);
}

static void boxes_cylinders_and_spheres_have_their_volumes(void **state)
{
    (void)state;
    fl_pack_region r;
    make_region(&r, "box:0,0,0,2,3,4", 3, NULL);
    assert_near(r.volume, 24.0, 1e-15);
    assert_near(fl_region_distance(&r, v3(0.3, 1, 2), INFINITY), 0.3, 1e-15);
    assert_near(fl_region_distance(&r, v3(-0.1, 1, 2), INFINITY), -0.1, 1e-15);
    assert_near(r.inradius, 1.0, 1e-15);
    fl_region_free(&r);
    make_region(&r, "cylinder:2,0,5,1,1", 3, NULL);
    assert_near(r.volume, 20.0 * PI, 1e-15);
    assert_near(fl_region_distance(&r, v3(1, 2.5, 2), INFINITY), 0.5, 1e-14);
    assert_near(fl_region_distance(&r, v3(1, 1, 4.9), INFINITY), 0.1, 1e-14);
    fl_region_free(&r);
    make_region(&r, "sphere:3,0,0,1", 3, NULL);
    assert_near(r.volume, 36.0 * PI, 1e-15);
    assert_near(fl_region_distance(&r, v3(0, 0, 3), INFINITY), 1.0, 1e-15);
    fl_region_free(&r);
}

/* An L: its reflex corner is touched once, its walls by their feet. */
static void a_reflex_corner_is_one_contact(void **state)
{
    (void)state;
    fl_pack_region r;
    fl_region_contact c[FL_REGION_CONTACTS];
    make_region(&r, "ell", 2, "0 0\n4 0\n4 2\n2 2\n2 4\n0 4\n");
    assert_near(r.volume, 12.0, 1e-15);
    assert_int_equal(fl_region_contacts(&r, v3(1.7, 1.6, 0), 0.6, c), 1);
    assert_near(c[0].gap, 0.5, 1e-14);
    assert_near(c[0].n.x, -0.6, 1e-14);
    assert_near(c[0].n.y, -0.8, 1e-14);
    /* a convex corner: both walls */
    assert_int_equal(fl_region_contacts(&r, v3(0.2, 0.3, 0), 0.5, c), 2);
    assert_near(c[0].gap + c[1].gap, 0.5, 1e-14);
    /* beyond a wall: one contact, the way back */
    assert_int_equal(fl_region_contacts(&r, v3(3, 2.1, 0), 0.5, c), 1);
    assert_near(c[0].gap, -0.1, 1e-13);
    assert_near(c[0].n.y, -1.0, 1e-14);
    /* beyond it by more than the reach */
    assert_int_equal(fl_region_contacts(&r, v3(3, 2.1, 0), 0.05, c), 0);
    assert_int_equal(fl_region_way_back(&r, v3(3, 2.1, 0), 0.5, c), 1);
    assert_near(c[0].gap, -0.1, 1e-13);
    assert_int_equal(fl_region_way_back(&r, v3(3, 2.1, 0), 0.05, c), 0);
    assert_int_equal(fl_region_way_back(&r, v3(3, 1.9, 0), 0.5, c), 0);
    /* beyond the reflex corner, in the solid */
    assert_near(fl_region_distance(&r, v3(2.3, 2.2, 0), INFINITY), -0.2, 1e-13);
    assert_near(fl_region_distance(&r, v3(-3, -4, 0), INFINITY), -5.0, 1e-13);
    fl_region_free(&r);
}

/* A cube with a notch, as triangles: distance by sampling of its boundary. */
static void a_surface_has_its_distance_and_sign(void **state)
{
    (void)state;
    static const char CUBE[] = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n"
                               "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\n"
                               "f 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";
    fl_pack_region r, box;
    make_region(&r, "cube", 3, CUBE);
    make_region(&box, "box:0,0,0,2,2,2", 3, NULL);
    assert_near(r.volume, 8.0, 1e-14);
    assert_near(r.inradius, 1.0, 2e-2);
    fl_rng g = fl_rng_of(1, 0, FL_RNG_TEST);
    for (int k = 0; k < 500; k++) {
        const fl_vec3 x = v3(fl_rng_in(&g, -1, 3), fl_rng_in(&g, -1, 3), fl_rng_in(&g, -1, 3));
        const double dx = fmax(fmax(-x.x, x.x - 2.0), 0.0), dy = fmax(fmax(-x.y, x.y - 2.0), 0.0),
                     dz = fmax(fmax(-x.z, x.z - 2.0), 0.0), out = sqrt(dx * dx + dy * dy + dz * dz);
        const double expected = out > 0.0 ? -out : fl_region_distance(&box, x, INFINITY);
        assert_near(fl_region_distance(&r, x, INFINITY), expected, 1e-12);
    }
    fl_region_free(&r);
    fl_region_free(&box);
}

static void helper_walls_are_named(void **state)
{
    (void)state;
    fl_pack_region r;
    fl_err err = {0};
    make_region(&r, "box:0,0,0,2,3,4", 3, NULL);
    assert_int_equal(fl_region_set_helpers(&r, "x+,z-", &err), 0);
    assert_int_equal(r.wall[1].helper + r.wall[4].helper, 2);
    assert_int_equal(r.wall[0].helper, 0);
    assert_int_equal(fl_region_set_helpers(&r, "top", &err), -1);
    assert_int_equal(err.code, FL_USAGE);
    fl_region_free(&r);
}

static void periods_wrap(void **state)
{
    (void)state;
    fl_pack_region r;
    fl_err err = {0};
    assert_int_equal(fl_region_make(&r, "box:-1,0,0,1,3,4", 3, "xz", &err), 0);
    assert_int_equal(r.walls, 2);
    const fl_vec3 d = fl_region_wrap(&r, v3(1.5, 2.9, -3.9));
    assert_near(d.x, -0.5, 1e-15);
    assert_near(d.y, 2.9, 1e-15);
    assert_near(d.z, 0.1, 1e-14);
    const fl_vec3 x = fl_region_wrap_point(&r, v3(1.25, 5, 4.5));
    assert_near(x.x, -0.75, 1e-15);
    assert_near(x.y, 5.0, 1e-15);
    assert_near(x.z, 0.5, 1e-15);
    fl_region_free(&r);
}

/* Two rooms of 4 m, joined by a neck of 0.4 m, by one of 1.1 m, or not at all. */
static void a_passage_is_found_where_a_body_does_not_pass(void **state)
{
    (void)state;
    static const char *const NECK[] = {
        "0 0\n4 0\n4 1.8\n5 1.8\n5 0\n9 0\n9 4\n5 4\n5 2.2\n4 2.2\n4 4\n0 4\n",
        "0 0\n4 0\n4 1.45\n5 1.45\n5 0\n9 0\n9 4\n5 4\n5 2.55\n4 2.55\n4 4\n0 4\n", "0 0\n9 0\n9 4\n"};
    for (int k = 0; k < 3; k++) {
        fl_pack_region r;
        fl_passage p;
        fl_err err = {0};
        make_region(&r, "neck", 2, NECK[k]);
        assert_int_equal(fl_passage_find(&p, &r, 0.5, &err), 0);
        assert_int_equal(p.found, k == 0);
        if (k == 0) {
            assert_near_of(p.width, 0.4, 0.2, 1.0);
            assert_near_of(p.at.x, 4.5, 0.6, 1.0);
            assert_near_of(p.at.y, 2.0, 0.3, 1.0);
        }
        fl_region_free(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_cylinders_and_spheres_have_their_volumes),
        cmocka_unit_test(a_reflex_corner_is_one_contact),
        cmocka_unit_test(a_surface_has_its_distance_and_sign),
        cmocka_unit_test(helper_walls_are_named),
        cmocka_unit_test(periods_wrap),
        cmocka_unit_test(a_passage_is_found_where_a_body_does_not_pass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
