/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "support/near.h"
#include "base/array.h"
#include "base/rng.h"
#include "shim/cgal_voronoi.h"

enum { N = 40 };

static void neighbours_of(int32_t n, const fl_vec2 *site, int32_t *first, int32_t **near)
{
    int32_t name[N];
    fl_err err = {0};
    for (int32_t i = 0; i < n; i++) name[i] = i;
    assert_int_equal(fl_cgal_neighbours(n, site, name, first, near, &err), 0);
}

/* Sites in another order with their old names have the same neighbours in the same order. */
static void neighbours_are_ordered_by_site_names(void **state)
{
    (void)state;
    fl_vec2 site[N], other[N];
    int32_t first[N + 1], *near = NULL, first_of[N + 1], *near_of = NULL, name[N];
    fl_err err = {0};
    for (int32_t i = 0; i < N; i++) {
        fl_rng g = fl_rng_of(test_seed(), i, FL_RNG_TEST);
        site[i] = (fl_vec2){fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1)};
    }
    for (int32_t k = 0; k < N; k++) {
        name[k] = (7 * k + 3) % N; /* 7 and 40 have no common factor */
        other[k] = site[name[k]];
    }
    neighbours_of(N, site, first, &near);
    assert_int_equal(fl_cgal_neighbours(N, other, name, first_of, &near_of, &err), 0);
    for (int32_t k = 0; k < N; k++) {
        const int32_t i = name[k], n = first[i + 1] - first[i];
        assert_int_equal(first_of[k + 1] - first_of[k], n);
        for (int32_t e = 0; e < n; e++) assert_int_equal(name[near_of[first_of[k] + e]], near[first[i] + e]);
    }
    free(near);
    free(near_of);
}

static void few_sites_and_sites_on_a_line(void **state)
{
    (void)state;
    const fl_vec2 line[4] = {{0, 0}, {3, 3}, {1, 1}, {2, 2}};
    int32_t first[5], *near = NULL;
    neighbours_of(1, line, first, &near);
    assert_int_equal(first[1], 0);
    free(near);
    neighbours_of(2, line, first, &near);
    assert_int_equal(first[2], 2);
    assert_int_equal(near[0], 1);
    free(near);
    neighbours_of(4, line, first, &near); /* 0 - 2 - 3 - 1 */
    assert_int_equal(first[4], 6);
    assert_int_equal(near[first[0]], 2);
    assert_int_equal(near[first[1]], 3);
    assert_int_equal(near[first[2]], 0);
    assert_int_equal(near[first[2] + 1], 3);
    free(near);
}

/* Two cells are neighbours if some point is nearest to both. Delaunay pairs have a circle through both sites
 * and no site inside; here every third site is tested, n^3. */
static void neighbours_are_those_with_an_empty_circle(void **state)
{
    (void)state;
    for (int c = 0; c < test_times(20); c++) {
        fl_vec2 site[N];
        char found[N][N] = {{0}};
        int32_t first[N + 1], *near = NULL, pairs = 0;
        for (int32_t i = 0; i < N; i++) {
            fl_rng g = fl_rng_of(test_seed(), c * N + i, FL_RNG_TEST);
            site[i] = (fl_vec2){fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1)};
        }
        neighbours_of(N, site, first, &near);
        for (int32_t i = 0; i < N; i++)
            for (int32_t k = first[i]; k < first[i + 1]; k++) {
                assert_true(k == first[i] || near[k - 1] < near[k]);
                found[i][near[k]] = 1;
            }
        free(near);
        for (int32_t i = 0; i < N; i++) {
            for (int32_t j = i + 1; j < N; j++) {
                /* centre = mid + t normal; every other site bounds t from one side */
                const double dx = site[j].x - site[i].x, dy = site[j].y - site[i].y,
                             mx = site[i].x + 0.5 * dx, my = site[i].y + 0.5 * dy,
                             r2 = 0.25 * (dx * dx + dy * dy);
                double lo = -INFINITY, hi = INFINITY;
                for (int32_t k = 0; k < N; k++) {
                    const double px = site[k].x - mx, py = site[k].y - my, s = -px * dy + py * dx;
                    const double t = (px * px + py * py - r2) / (2.0 * s);
                    if (k == i || k == j) continue;
                    if (s > 0.0 && t < hi) hi = t;
                    if (s < 0.0 && t > lo) lo = t;
                }
                assert_int_equal(found[i][j], lo < hi);
                assert_int_equal(found[j][i], lo < hi);
                pairs += lo < hi;
            }
        }
        assert_int_equal(first[N], 2 * pairs);
    }
}

static void two_sites_at_one_point_are_named(void **state)
{
    (void)state;
    const fl_vec2 site[4] = {{0, 0}, {1, 0}, {0, 1}, {1, 0}};
    const int32_t name[4] = {0, 1, 2, 3}, other[4] = {3, 2, 1, 0};
    int32_t first[5], *near = NULL;
    fl_err err = {0};
    assert_int_equal(fl_cgal_neighbours(4, site, name, first, &near, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text, "sites 1 and 3 are the same point (1, 0)");
    assert_null(near);
    err = (fl_err){0};
    assert_int_equal(fl_cgal_neighbours(4, site, other, first, &near, &err), -1);
    assert_string_equal(err.text, "sites 0 and 2 are the same point (1, 0)");
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    const fl_vec2 site[3] = {{0, 0}, {1, 0}, {0, 1}};
    const int32_t name[3] = {0, 1, 2};
    int32_t first[4], *near = NULL;
    fl_err err = {0};
    fl_alloc_fail_after(0);
    assert_int_equal(fl_cgal_neighbours(3, site, name, first, &near, &err), -1);
    fl_alloc_fail_after(-1);
    assert_int_equal(err.code, FL_SYSTEM);
    assert_null(near);
}

/* Points of a line in steps of one ulp, for which the determinant in doubles gives all three signs. */
static void orientation_is_exact(void **state)
{
    (void)state;
    const fl_vec2 b = {12.0, 12.0}, c = {24.0, 24.0};
    int wrong = 0;
    for (int i = 0; i < 64; i++) {
        for (int j = 0; j < 64; j++) {
            const fl_vec2 a = {0.5 + ldexp(i, -53), 0.5 + ldexp(j, -53)};
            const double det = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
            const int left = (j > i) - (j < i); /* of the diagonal */
            assert_int_equal(fl_cgal_orientation(b, c, a), left);
            wrong += (det > 0.0) - (det < 0.0) != left;
        }
    }
    assert_true(wrong > 100); /* otherwise this test checks nothing */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(neighbours_are_ordered_by_site_names),
                                       cmocka_unit_test(few_sites_and_sites_on_a_line),
                                       cmocka_unit_test(neighbours_are_those_with_an_empty_circle),
                                       cmocka_unit_test(two_sites_at_one_point_are_named),
                                       cmocka_unit_test(allocation_failure_is_reported),
                                       cmocka_unit_test(orientation_is_exact)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
