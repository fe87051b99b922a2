/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <omp.h>
#include <string.h>
#include "support/near.h"
#include "base/array.h"
#include "ice/power_cells.h"

enum { N = 500 };

static const fl_vec2 LO = {-3.0, 1.0}, HI = {5.0, 4.0};

static void sites_do_not_depend_on_their_number(void **state)
{
    (void)state;
    fl_vec2 few[10], many[N];
    fl_random_sites(10, test_seed(), LO, HI, few);
    fl_random_sites(N, test_seed(), LO, HI, many);
    assert_memory_equal(few, many, sizeof few);
    for (int32_t i = 0; i < N; i++)
        assert_true(many[i].x >= LO.x && many[i].x < HI.x && many[i].y >= LO.y && many[i].y < HI.y);
}

static int32_t side_count(const fl_power_cells *c, int32_t i) { return c->first[i + 1] - c->first[i]; }

/* The cells fill the rectangle; each side is the reversed side of a neighbour, or a wall; the site is
 * inside. */
static void cells_tile_the_rectangle(void **state)
{
    (void)state;
    for (int s = 0; s < test_times(20); s++) {
        fl_vec2 site[N];
        fl_power_cells c = {0};
        fl_err err = {0};
        double area = 0.0;
        fl_random_sites(N, test_seed() + (uint64_t)s, LO, HI, site);
        assert_int_equal(fl_power_cells_build(&c, N, site, LO, HI, &err), 0);
        for (int32_t i = 0; i < N; i++) {
            area += fl_polygon_area(side_count(&c, i), c.v + c.first[i]);
            for (int32_t k = c.first[i]; k < c.first[i + 1]; k++) {
                const int32_t j = c.side[k].tag;
                int32_t partners = 0;
                assert_true(fl_polygon_side_distance(c.side[k], site[i]) <= 0.0);
                if (j < 0) continue;
                for (int32_t m = c.first[j]; m < c.first[j + 1]; m++)
                    partners += c.side[m].tag == i && c.side[m].nx == -c.side[k].nx &&
                                c.side[m].ny == -c.side[k].ny && c.side[m].c == -c.side[k].c;
                assert_int_equal(partners, 1);
            }
        }
        assert_near(area, (HI.x - LO.x) * (HI.y - LO.y), 1e-13);
        fl_power_cells_free(&c);
    }
}

/* Four cells meet in each inner corner of a lattice; the side between diagonal neighbours is empty, or of the
 * length of rounding. */
static void a_lattice_gives_squares(void **state)
{
    (void)state;
    fl_vec2 site[100], to[100];
    fl_power_cells c = {0};
    fl_err err = {0};
    for (int32_t i = 0; i < 100; i++) site[i] = (fl_vec2){i % 10 + 0.5, i / 10 + 0.5};
    assert_int_equal(fl_power_cells_build(&c, 100, site, (fl_vec2){0, 0}, (fl_vec2){10, 10}, &err), 0);
    for (int32_t i = 0; i < 100; i++) {
        const fl_vec2 *v = c.v + c.first[i];
        const int32_t n = side_count(&c, i);
        int sides = 0;
        for (int32_t k = 0; k < n; k++) {
            const double l = hypot(v[(k + 1) % n].x - v[k].x, v[(k + 1) % n].y - v[k].y);
            sides += l > 0.5;
            assert_true(l > 0.5 || l < 1e-14);
        }
        assert_int_equal(sides, 4);
        assert_near(fl_polygon_area(n, v), 1.0, 1e-14);
    }
    fl_power_cells_centroids(&c, to);
    for (int32_t i = 0; i < 100; i++) {
        assert_near(to[i].x, site[i].x, 1e-14);
        assert_near(to[i].y, site[i].y, 1e-14);
    }
    fl_power_cells_free(&c);
}

static void one_site_and_sites_on_a_line(void **state)
{
    (void)state;
    const fl_vec2 site[3] = {{1.0, 2.0}, {3.0, 2.0}, {-2.0, 2.0}};
    fl_power_cells c = {0};
    fl_err err = {0};
    assert_int_equal(fl_power_cells_build(&c, 1, site, LO, HI, &err), 0);
    assert_true(fl_polygon_area(4, c.v) == 24.0);
    fl_power_cells_free(&c);
    assert_int_equal(fl_power_cells_build(&c, 3, site, LO, HI, &err), 0);
    assert_near(fl_polygon_area(side_count(&c, 0), c.v + c.first[0]), 7.5, 1e-15);
    assert_near(fl_polygon_area(side_count(&c, 1), c.v + c.first[1]), 9.0, 1e-15);
    assert_near(fl_polygon_area(side_count(&c, 2), c.v + c.first[2]), 7.5, 1e-15);
    fl_power_cells_free(&c);
}

static void threads_do_not_change_the_cells(void **state)
{
    (void)state;
    fl_vec2 site[N];
    fl_power_cells a = {0}, b = {0};
    fl_err err = {0};
    const int threads = omp_get_max_threads();
    fl_random_sites(N, test_seed(), LO, HI, site);
    omp_set_num_threads(1);
    assert_int_equal(fl_power_cells_build(&a, N, site, LO, HI, &err), 0);
    omp_set_num_threads(3);
    assert_int_equal(fl_power_cells_build(&b, N, site, LO, HI, &err), 0);
    omp_set_num_threads(threads);
    assert_memory_equal(a.first, b.first, (N + 1) * sizeof *a.first);
    assert_memory_equal(a.v, b.v, (size_t)a.first[N] * sizeof *a.v);
    fl_power_cells_free(&a);
    fl_power_cells_free(&b);
}

static void faults_are_reported(void **state)
{
    (void)state;
    const fl_vec2 site[2] = {{1.0, 2.0}, {1.0, 2.0}};
    fl_power_cells c = {0};
    fl_err err = {0};
    int rc = -1;
    assert_int_equal(fl_power_cells_build(&c, 2, site, LO, HI, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    for (long k = 0; rc; k++) {
        err = (fl_err){0};
        fl_alloc_fail_after(k);
        rc = fl_power_cells_build(&c, 1, site, LO, HI, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
        assert_int_equal(c.n, rc ? 0 : 1);
        assert_true(k < 100);
    }
    fl_power_cells_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sites_do_not_depend_on_their_number),
                                       cmocka_unit_test(cells_tile_the_rectangle),
                                       cmocka_unit_test(a_lattice_gives_squares),
                                       cmocka_unit_test(one_site_and_sites_on_a_line),
                                       cmocka_unit_test(threads_do_not_change_the_cells),
                                       cmocka_unit_test(faults_are_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
