/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <omp.h>
#include <string.h>
#include "support/near.h"
#include "base/array.h"
#include "base/rng.h"
#include "geom/clip.h"
#include "ice/blocks.h"

/* A triangular prism (a ridge sail) and a box. */
static void make_region(fl_poly *p, int kind)
{
    const fl_vec3 tri[3] = {{-2, 0, 0}, {3, 0, 0}, {0, 2, 0}};
    fl_err err = {0};
    if (kind) assert_int_equal(fl_poly_prism(p, 3, tri, -1.0, 4.0, &err), 0);
    else assert_int_equal(fl_poly_box(p, (fl_vec3){2, 1.5, 1}, &err), 0);
}

/* Cells fill the region: each point lies in the cell of its nearest site. */
static void cells_are_those_of_the_nearest_site(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        const int32_t n = 1 + 9 * k;
        fl_poly r = {0};
        fl_blocks b = {0};
        fl_err err = {0};
        fl_aabb box;
        make_region(&r, k % 2);
        box = fl_poly_aabb(&r);
        assert_int_equal(fl_blocks_cells(&b, &r, n, (uint64_t)k, 1000, k % 3, &err), 0);
        assert_near(b.cells_volume, b.region_volume, 1e-11);
        assert_near(b.region_volume, k % 2 ? 25.0 : 24.0, 1e-14);
        for (int t = 0; t < 300; t++) {
            fl_rng g = fl_rng_of(test_seed(), t, FL_RNG_TEST);
            const fl_vec3 x = {fl_rng_in(&g, box.lo.x, box.hi.x), fl_rng_in(&g, box.lo.y, box.hi.y),
                               fl_rng_in(&g, box.lo.z, box.hi.z)};
            int32_t near = 0;
            int in = 1;
            for (int32_t i = 1; i < n; i++)
                if (v3_norm2(v3_sub(b.site[i], x)) < v3_norm2(v3_sub(b.site[near], x))) near = i;
            for (int32_t f = 0; f < r.nf; f++) in &= v3_dot(r.n[f], x) <= r.c[f];
            if (!in) continue;
            for (int32_t f = 0; f < b.cell[near].nf; f++)
                assert_true(v3_dot(b.cell[near].n[f], x) <= b.cell[near].c[f] + 1e-9);
        }
        fl_blocks_free(&b);
        fl_poly_free(&r);
    }
}

/* Blocks have the requested volume, stay inside their cells with their outer shapes, and do not overlap. */
static void blocks_fill_their_part_and_stay_apart(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        const double solid = 0.35 + 0.08 * k, radius = 0.01 * (k % 3);
        fl_poly r = {0};
        fl_blocks b = {0};
        fl_err err = {0};
        int64_t pairs = -1;
        double sum = 0.0;
        make_region(&r, k % 2);
        assert_int_equal(fl_blocks_cells(&b, &r, 40, (uint64_t)k, 0, 1, &err), 0);
        assert_int_equal(fl_blocks_shrink(&b, solid, radius, &err), 0);
        assert_near(b.solid_volume, solid * b.region_volume, 1e-9);
        assert_int_equal(fl_blocks_overlaps(&b, radius, &pairs, &err), 0);
        assert_int_equal(pairs, 0);
        for (int32_t i = 0; i < b.n; i++) {
            fl_poly outer = {0};
            if (b.core[i].nv == 0) continue;
            if (radius > 0.0) assert_int_equal(fl_poly_offset(&outer, &b.core[i], radius, &err), 0);
            else assert_int_equal(fl_poly_copy(&outer, &b.core[i], &err), 0);
            sum += fl_blocks_volume(&outer);
            for (int32_t f = 0; f < b.cell[i].nf; f++)
                for (int32_t v = 0; v < outer.nv; v++)
                    assert_true(v3_dot(b.cell[i].n[f], outer.v[v]) <=
                                b.cell[i].c[f] - FL_BLOCKS_CLEARANCE * b.inset + 1e-11);
            fl_poly_free(&outer);
        }
        assert_near(sum, b.solid_volume, 1e-12);
        assert_true(b.blockless <= 6);
        fl_blocks_free(&b);
        fl_poly_free(&r);
    }
}

static void an_impossible_fill_is_reported(void **state)
{
    (void)state;
    fl_poly r = {0};
    fl_blocks b = {0};
    fl_err err = {0};
    make_region(&r, 0);
    assert_int_equal(fl_blocks_cells(&b, &r, 100, 1, 0, 0, &err), 0);
    assert_int_equal(fl_blocks_shrink(&b, 0.9, 0.2, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    fl_blocks_free(&b);
    fl_poly_free(&r);
}

/* A slab one cell high, whose cells vanish together: the fill that is still possible is reached, and no core
 * degenerates to a sheet. A larger fill is refused. */
static void a_core_thinner_than_its_radius_is_reported(void **state)
{
    (void)state;
    const fl_vec3 rim[4] = {{0, 0, 0}, {20, 0, 0}, {20, 20, 0}, {0, 20, 0}};
    int refused = 0, made = 0;
    for (double solid = 0.02; solid < 0.4; solid += 0.02) {
        fl_poly r = {0};
        fl_blocks b = {0};
        fl_err err = {0};
        assert_int_equal(fl_poly_prism(&r, 4, rim, 0, 0.4, &err), 0);
        assert_int_equal(fl_blocks_cells(&b, &r, 40, 1, 0, 1, &err), 0);
        const int rc = fl_blocks_shrink(&b, solid, 0.05, &err);
        if (rc) assert_int_equal(err.code, FL_INPUT);
        if (rc) assert_true(made == 0 && strstr(err.text, "vanish") != NULL);
        refused += rc != 0;
        made += rc == 0;
        for (int32_t i = 0; rc == 0 && i < b.n; i++)
            for (int32_t f = 0; f < b.core[i].nf; f++) {
                double low = INFINITY;
                for (int32_t v = 0; v < b.core[i].nv; v++)
                    low = fmin(low, v3_dot(b.core[i].n[f], b.core[i].v[v]));
                assert_true(b.core[i].c[f] - low >= 5e-4);
            }
        fl_blocks_free(&b);
        fl_poly_free(&r);
    }
    assert_true(refused > 0 && made > 0);
}

/* One more block leaves the sites of the other blocks unchanged. */
static void sites_are_counted(void **state)
{
    (void)state;
    fl_poly r = {0};
    fl_blocks a = {0}, b = {0};
    fl_err err = {0};
    make_region(&r, 1);
    assert_int_equal(fl_blocks_cells(&a, &r, 20, 3, 5, 0, &err), 0);
    assert_int_equal(fl_blocks_cells(&b, &r, 21, 3, 5, 0, &err), 0);
    for (int32_t i = 0; i < 20; i++) assert_memory_equal(&a.site[i], &b.site[i], sizeof *a.site);
    fl_blocks_free(&a);
    fl_blocks_free(&b);
    fl_poly_free(&r);
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    fl_poly r = {0};
    int rc = -1;
    make_region(&r, 0);
    for (long k = 0; rc; k += 1 + k / 16) {
        fl_blocks b = {0};
        fl_err err = {0};
        int64_t pairs;
        fl_alloc_fail_after(k);
        rc = fl_blocks_cells(&b, &r, 3, 1, 0, 1, &err) || fl_blocks_shrink(&b, 0.5, 0.02, &err) ||
             fl_blocks_overlaps(&b, 0.02, &pairs, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
        fl_blocks_free(&b);
        assert_true(k < 1000000);
    }
    fl_poly_free(&r);
}

int main(void)
{
    omp_set_num_threads(2);
    const struct CMUnitTest tests[] = {cmocka_unit_test(cells_are_those_of_the_nearest_site),
                                       cmocka_unit_test(blocks_fill_their_part_and_stay_apart),
                                       cmocka_unit_test(an_impossible_fill_is_reported),
                                       cmocka_unit_test(a_core_thinner_than_its_radius_is_reported),
                                       cmocka_unit_test(sites_are_counted),
                                       cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
