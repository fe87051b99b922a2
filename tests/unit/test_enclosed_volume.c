/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Volumes by lines and winding numbers, against those of boxes. */
#include <math.h>
#include "base/rng.h"
#include "geom/enclosed_volume.h"
#include "geom/facet.h"
#include "geom/inner_walls.h"
#include "geom/mesh_patch.h"
#include "geom/weld.h"
#include "support/near.h"

static fl_err err;

static void add_box(fl_part *p, fl_vec3 lo, fl_vec3 hi, int inward)
{
    const int32_t first = p->nt;
    fl_facet_box(p, lo, hi, &err);
    for (int32_t t = first; inward && t < p->nt; t++) {
        const int32_t keep = p->t[t].v[1];
        p->t[t].v[1] = p->t[t].v[2];
        p->t[t].v[2] = keep;
    }
}

static void winding_numbers_count_the_bodies_about_a_point(void **state)
{
    fl_part p = {0};
    (void)state;
    add_box(&p, v3(0, 0, 0), v3(3, 3, 3), 0);
    add_box(&p, v3(1, 1, 1), v3(2, 2, 2), 1);
    add_box(&p, v3(2, 2, 2), v3(5, 5, 5), 0);
    assert_near(fl_part_winding(&p, v3(0.3, 0.4, 0.5)), 1.0, 1e-13);
    assert_true(fabs(fl_part_winding(&p, v3(1.5, 1.4, 1.3))) < 1e-13);
    assert_near(fl_part_winding(&p, v3(2.5, 2.6, 2.7)), 2.0, 1e-13);
    assert_true(fabs(fl_part_winding(&p, v3(-1, 0.2, 0.3))) < 1e-13);
    fl_part_free(&p);
}

/* Two boxes that overlap, a cavity in one of them, and a small one far off: 8 + 8 - 1 - 0.125 + 1e-6. */
static void volumes_count_overlaps_once(void **state)
{
    fl_part source = {0}, result = {0};
    fl_volume_check c;
    int32_t body[48], group[48];
    (void)state;
    add_box(&source, v3(0, 0, 0), v3(2, 2, 2), 0);
    add_box(&source, v3(1, 1, 1), v3(3, 3, 3), 0);
    add_box(&source, v3(0.25, 0.25, 0.25), v3(0.75, 0.75, 0.75), 0);
    add_box(&source, v3(3.5, 0.1, 0.1), v3(3.51, 0.11, 0.11), 0);
    for (int k = 0; k < 48; k++) {
        body[k] = k / 12;
        group[k] = k / 12 == 1 ? 0 : k / 12;
    }
    /* a result of the right volume: the second box without the corner that is in the first, in three boxes */
    add_box(&result, v3(0, 0, 0), v3(2, 2, 2), 0);
    add_box(&result, v3(0.25, 0.25, 0.25), v3(0.75, 0.75, 0.75), 1);
    add_box(&result, v3(2, 1, 1), v3(3, 3, 3), 0);
    add_box(&result, v3(1, 2, 1), v3(2, 3, 3), 0);
    add_box(&result, v3(1, 1, 2), v3(2, 2, 3), 0);
    add_box(&result, v3(3.5, 0.1, 0.1), v3(3.51, 0.11, 0.11), 0);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(fl_check_volume(&source, body, group, &result, &c, &err), 0);
        assert_near(c.source, 14.875 + 1e-6, 0.02);
        if (k == 0) {
            assert_near(c.result, c.source, 1e-9);
            assert_int_equal(c.bodies, 0);
        }
        if (k == 1) assert_int_equal(c.bodies, 1); /* which weighs nothing in the volume */
        if (k == 2) assert_near(c.source - c.result, 1.0, 0.02);
        if (k == 3) assert_near(c.source - c.result, 3.0, 0.05);
        result.nt -= 12;
    }
    fl_part_free(&source);
    fl_part_free(&result);
}

/* Random boxes of a grid, with faces and edges that coincide, far from the origin: a sum over cells. */
static void volumes_are_those_of_cells(void **state)
{
    (void)state;
    for (int trial = 0; trial < 20; trial++) {
        fl_rng g = fl_rng_of(7, trial, FL_RNG_TEST);
        const fl_vec3 far = v3(500012.25, 6000020.75, 0);
        fl_part p = {0};
        fl_volume_check c;
        int32_t body[48], group[48] = {0};
        int cell[4][4][4] = {{{0}}}, full = 0;
        for (int k = 0; k < 4; k++) {
            int lo[3], hi[3];
            for (int i = 0; i < 3; i++) {
                lo[i] = (int)fl_rng_in(&g, 0.0, 4.0) % 4;
                hi[i] = lo[i] + 1 + (int)fl_rng_in(&g, 0.0, 4.0 - lo[i]) % (4 - lo[i]);
            }
            add_box(&p, v3_add(far, v3(lo[0], lo[1], lo[2])), v3_add(far, v3(hi[0], hi[1], hi[2])), k % 2);
            for (int t = 0; t < 12; t++) body[12 * k + t] = k;
            for (int x = lo[0]; x < hi[0]; x++)
                for (int y = lo[1]; y < hi[1]; y++)
                    for (int z = lo[2]; z < hi[2]; z++) cell[x][y][z] = 1;
        }
        for (int k = 0; k < 64; k++) full += cell[k / 16][k / 4 % 4][k % 4];
        assert_int_equal(fl_check_volume(&p, body, group, &p, &c, &err), 0);
        assert_near(c.source, full, 0.02);
        fl_part_free(&p);
    }
}

/* Two boxes that touch, a box with a cavity that a third fills, and a plate beside them, with copies. */
static void walls_between_bodies_go(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        fl_part p = {0};
        fl_weld w;
        fl_mesh_quality q;
        int32_t gone, same, plates;
        add_box(&p, v3(0, 0, 0), v3(4, 4, 4), 0);
        if (k == 0) add_box(&p, v3(4, 0, 0), v3(5, 4, 4), 0);
        if (k == 1) {
            add_box(&p, v3(1, 1, 1), v3(2, 2, 2), 1);
            add_box(&p, v3(1, 1, 1), v3(2, 2, 2), 0);
        }
        if (k == 2) add_box(&p, v3(0, 0, 0), v3(4, 4, 4), 0);
        if (k == 3) {
            fl_surface_vertex(&p, v3(9, 0, 0), &err);
            fl_surface_vertex(&p, v3(9, 1, 0), &err);
            fl_surface_vertex(&p, v3(9, 0, 1), &err);
            fl_surface_triangle(&p, p.nv - 3, p.nv - 2, p.nv - 1, &err);
            fl_surface_triangle(&p, p.nv - 3, p.nv - 1, p.nv - 2, &err);
        }
        assert_int_equal(fl_part_weld(&p, 0.0, &w, &err), 0);
        assert_int_equal(fl_part_drop_contact_walls(&p, &gone, &same, &err), 0);
        assert_int_equal(fl_part_drop_sheets(&p, &plates, &err), 0);
        assert_int_equal(gone, k == 0 ? 4 : k == 1 ? 24 : 0);
        assert_int_equal(same, k == 2 ? 12 : 0);
        assert_int_equal(plates, k == 3 ? 2 : 0);
        assert_int_equal(fl_part_measure(&p, &q, &err), 0);
        assert_true(q.closed && q.branched == 0);
        assert_near(q.volume, k == 0 ? 80.0 : 64.0, 1e-12);
        fl_part_free(&p);
    }
    /* a body turned inside out upon itself, and not in another one, is left */
    fl_part p = {0};
    fl_weld w;
    int32_t gone, same;
    add_box(&p, v3(0, 0, 0), v3(1, 1, 1), 0);
    add_box(&p, v3(0, 0, 0), v3(1, 1, 1), 1);
    add_box(&p, v3(3, 0, 0), v3(4, 1, 1), 0);
    assert_int_equal(fl_part_weld(&p, 0.0, &w, &err), 0);
    assert_int_equal(fl_part_drop_contact_walls(&p, &gone, &same, &err), 0);
    assert_int_equal(gone + same, 0);
    fl_part_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(winding_numbers_count_the_bodies_about_a_point),
        cmocka_unit_test(volumes_count_overlaps_once),
        cmocka_unit_test(volumes_are_those_of_cells),
        cmocka_unit_test(walls_between_bodies_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
