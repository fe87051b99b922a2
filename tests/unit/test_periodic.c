/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "support/near.h"
#include "base/array.h"
#include "ice/faces.h"
#include "ice/floes.h"
#include "ice/periodic.h"

static const fl_vec2 LO = {-4.0, -3.0}, HI = {4.0, 3.0};

static void make_cells(fl_power_cells *c, int32_t n, uint64_t seed, const int periodic[2])
{
    fl_vec2 site[300];
    fl_err err = {0};
    assert_true(n <= 300);
    fl_random_sites(n, seed, LO, HI, site);
    assert_int_equal(fl_periodic_cells(c, n, site, LO, HI, periodic, &err), 0);
    assert_int_equal(c->n, n);
}

/* k x k copies of polygons. */
static fl_floes tile_copies(int32_t n, const int32_t *first, const fl_vec2 *v, int kx, int ky)
{
    fl_floes t = {0};
    fl_err err = {0};
    t.first = fl_alloc((int64_t)n * kx * ky + 1, sizeof *t.first, &err);
    t.outer = fl_alloc((int64_t)first[n] * kx * ky, sizeof *t.outer, &err);
    assert_true(t.first && t.outer);
    for (int y = 0; y < ky; y++)
        for (int x = 0; x < kx; x++)
            for (int32_t i = 0; i < n; i++) {
                const int32_t at = t.first[t.n], m = first[i + 1] - first[i];
                for (int32_t k = 0; k < m; k++)
                    t.outer[at + k] = (fl_vec2){v[first[i] + k].x + 8.0 * x, v[first[i] + k].y + 6.0 * y};
                t.first[++t.n] = at + m;
            }
    return t;
}

/* The cells have the area of the field. In m x m copies all sides are shared but those around the whole, and
 * the length of sides without a partner is m times that of one copy, along x and along y. */
static void copies_fit_without_a_seam(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 30; seed++) {
        const int periodic[2] = {seed % 3 != 1, seed % 3 != 2};
        const int32_t n = 1 + (int32_t)(seed * seed / 4);
        double area = 0.0, open[4];
        fl_power_cells c = {0};
        fl_err err = {0};
        make_cells(&c, n, seed, periodic);
        for (int32_t i = 0; i < n; i++)
            area += fl_polygon_area(c.first[i + 1] - c.first[i], c.v + c.first[i]);
        assert_near(area, 48.0, 1e-13);
        for (int k = 1; k < 4; k++) {
            fl_floes t = tile_copies(n, c.first, c.v, periodic[0] ? k : 1, periodic[1] ? k : 1);
            fl_faces f = {0};
            assert_int_equal(fl_faces_find(&f, &t, &err), 0);
            assert_true(f.max_overlap <= f.tolerance);
            open[k] = f.perimeter - 2.0 * f.total_length;
            fl_faces_free(&f);
            fl_floes_free(&t);
        }
        assert_near_of(open[3] - open[2], open[2] - open[1], 1e-7, open[3]);
        fl_power_cells_free(&c);
    }
}

/* A side and its partner refer to each other. */
static void neighbours_are_mutual(void **state)
{
    (void)state;
    const int both[2] = {1, 1}, none[2] = {0, 0};
    fl_power_cells c = {0}, d = {0};
    fl_vec2 site[80];
    fl_err err = {0};
    make_cells(&c, 80, 5, both);
    for (int32_t i = 0; i < 80; i++)
        for (int32_t k = c.first[i]; k < c.first[i + 1]; k++) {
            const int32_t j = c.side[k].tag;
            int back = 0;
            assert_in_range(j, 0, 79);
            for (int32_t m = c.first[j]; m < c.first[j + 1]; m++) back |= c.side[m].tag == i;
            assert_true(back);
        }
    fl_power_cells_free(&c);
    make_cells(&c, 80, 5, none); /* without a period they are the plain cells, bit for bit */
    fl_random_sites(80, 5, LO, HI, site);
    assert_int_equal(fl_power_cells_build(&d, 80, site, LO, HI, &err), 0);
    assert_memory_equal(c.first, d.first, 81 * sizeof *c.first);
    assert_memory_equal(c.v, d.v, (size_t)c.first[80] * sizeof *c.v);
    fl_power_cells_free(&c);
    fl_power_cells_free(&d);
}

static void points_are_wrapped_into_the_cell(void **state)
{
    (void)state;
    const int x[2] = {1, 0}, both[2] = {1, 1};
    fl_vec2 p = fl_periodic_wrap((fl_vec2){5.0, 4.0}, LO, HI, x);
    assert_true(p.x == -3.0 && p.y == 4.0);
    p = fl_periodic_wrap((fl_vec2){-12.5, 3.0}, LO, HI, both);
    assert_true(p.x == 3.5 && p.y == -3.0);
    p = fl_periodic_wrap((fl_vec2){nextafter(-4.0, -5.0), 0.0}, LO, HI, both);
    assert_true(p.x >= -4.0 && p.x < 4.0);
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    const int both[2] = {1, 1};
    fl_vec2 site[10];
    int rc = -1;
    fl_random_sites(10, 1, LO, HI, site);
    for (long k = 0; rc; k++) {
        fl_power_cells c = {0};
        fl_err err = {0};
        fl_alloc_fail_after(k);
        rc = fl_periodic_cells(&c, 10, site, LO, HI, both, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
        if (rc) assert_null(c.first);
        fl_power_cells_free(&c);
        assert_true(k < 1000);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copies_fit_without_a_seam), cmocka_unit_test(neighbours_are_mutual),
        cmocka_unit_test(points_are_wrapped_into_the_cell), cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
