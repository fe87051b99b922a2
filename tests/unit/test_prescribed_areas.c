/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include "support/near.h"
#include "base/array.h"
#include "ice/prescribed_areas.h"
#include "ice/sizes.h"

enum { N = 400 };

static const fl_vec2 HEXAGON[] = {{10, 0}, {5, 9}, {-5, 9}, {-10, 0}, {-5, -9}, {5, -9}};
static const fl_outline RECTANGLE = {.lo = {-20, -5}, .hi = {20, 5}};
static const fl_outline POLYGON = {.lo = {-10, -9}, .hi = {10, 9}, .n = 6, .v = HEXAGON};

/* Diameters of 1:100 in random order that add up to part of the outline. */
static void make_sizes(int32_t n, const fl_outline *in, double part, double *area)
{
    const fl_sizes s = {.kind = FL_SIZES_POWER, .beta = 2.8, .dmin = 1.0, .dmax = 100.0};
    double ascending[N];
    fl_sizes_areas(&s, n, part * fl_outline_area(in) / n, ascending);
    for (int32_t i = 0; i < n; i++) area[i] = ascending[(int64_t)i * 7 % n];
}

static void discs_are_separate(void **state)
{
    (void)state;
    static double area[N], w[N];
    static fl_vec2 site[N];
    fl_err err = {0};
    make_sizes(N, &POLYGON, 1.0, area);
    assert_int_equal(fl_prescribed_areas_sites(N, test_seed(), area, &POLYGON, site, w, &err), 0);
    for (int32_t i = 0; i < N; i++) {
        assert_true(w[i] > 0.0 && w[i] <= FL_SITE_DISC_COVER * area[i] / 3.14159 &&
                    fl_outline_contains(&POLYGON, site[i], sqrt(w[i])));
        for (int32_t j = 0; j < i; j++)
            assert_true(hypot(site[i].x - site[j].x, site[i].y - site[j].y) > sqrt(w[i]) + sqrt(w[j]));
    }
}

static void cells_get_their_areas(void **state)
{
    (void)state;
    for (int s = 0; s < test_times(3); s++) {
        static double area[N], w[N], got[N];
        static fl_vec2 site[N];
        const fl_outline *in = s % 2 ? &RECTANGLE : &POLYGON;
        fl_power_cells c = {0};
        fl_err err = {0};
        double sum = 0.0;
        make_sizes(N, in, 1.0, area);
        assert_int_equal(fl_prescribed_areas_sites(N, test_seed() + (uint64_t)s, area, in, site, w, &err), 0);
        assert_int_equal(fl_prescribed_areas_solve(&c, N, site, w, area, in, 1e-9, &err), 0);
        fl_power_cells_areas(&c, got);
        for (int32_t i = 0; i < N; i++) {
            assert_near(got[i], area[i], 1e-9);
            sum += got[i];
            for (int32_t k = c.first[i]; k < c.first[i + 1]; k++) /* the wall of equal power */
                if (c.side[k].tag >= 0) {
                    const int32_t j = c.side[k].tag;
                    const fl_vec2 p = c.v[k];
                    const double a = hypot(p.x - site[i].x, p.y - site[i].y);
                    const double b = hypot(p.x - site[j].x, p.y - site[j].y);
                    assert_near_of(a * a - w[i], b * b - w[j], 1e-11, 400.0);
                }
        }
        assert_near(sum, fl_outline_area(in), 1e-13);
        fl_power_cells_free(&c);
    }
}

/* Cells of given areas in one call: they are right, fill the outline, and no smoothing makes them empty. */
static void cells_in_one_call(void **state)
{
    (void)state;
    for (int smooth = 0; smooth < 4; smooth += 3) {
        static double area[N], got[N];
        fl_power_cells c = {0};
        fl_err err = {0};
        double sum = 0.0;
        make_sizes(N, &POLYGON, 1.0, area);
        assert_int_equal(fl_prescribed_areas_cells(&c, N, test_seed(), area, &POLYGON, smooth, &err), 0);
        fl_power_cells_areas(&c, got);
        for (int32_t i = 0; i < N; i++) {
            assert_near(got[i], area[i], 1e-8);
            sum += got[i];
        }
        assert_near(sum, fl_outline_area(&POLYGON), 1e-13);
        fl_power_cells_free(&c);
    }
}

/* Two sites in a square: the weights place the wall where the smaller cell has a fifth. */
static void two_cells(void **state)
{
    (void)state;
    const fl_outline square = {.lo = {0, 0}, .hi = {1, 1}};
    const fl_vec2 site[] = {{0.25, 0.5}, {0.75, 0.5}};
    const double area[] = {0.2, 0.8};
    double w[] = {0.0, 0.0};
    fl_power_cells c = {0};
    fl_err err = {0};
    assert_int_equal(fl_prescribed_areas_solve(&c, 2, site, w, area, &square, 1e-12, &err), 0);
    /* x at equal power: 2 (0.5) x = 0.75^2 - 0.25^2 + w0 - w1 */
    assert_near(w[1] - w[0], 0.3, 1e-12);
    fl_power_cells_free(&c);
    w[1] = 10.0; /* the first cell is empty */
    assert_int_equal(fl_prescribed_areas_solve(&c, 2, site, w, area, &square, 1e-12, &err), 1);
    assert_null(c.first);
    assert_int_equal(err.code, 0);
}

static void floes_get_their_areas(void **state)
{
    (void)state;
    static double area[N];
    fl_power_cells c[2] = {{0}};
    fl_floes a[2] = {{0}};
    double off[2] = {0}, sum = 0.0;
    fl_err err = {0};
    make_sizes(N, &RECTANGLE, 0.8, area);
    for (int k = 0; k < 2; k++) {
        omp_set_num_threads(1 + 2 * k);
        assert_int_equal(fl_prescribed_areas_floes(&c[k], &a[k], N, test_seed(), area, &RECTANGLE, 2, 0.8,
                                                   0.001, (fl_vec2){100, 0}, &off[k], &err),
                         0);
    }
    assert_int_equal(a[0].n, N);
    for (int32_t i = 0; i < N; i++) {
        const double got = fl_polygon_area(a[0].first[i + 1] - a[0].first[i], a[0].outer + a[0].first[i]);
        assert_near(got, area[i], off[0] + 1e-12);
        sum += got;
    }
    assert_true(off[0] < 0.02);
    assert_near(sum, 320.0, 1e-12);
    assert_true(off[0] == off[1]);
    assert_memory_equal(a[0].first, a[1].first, sizeof(int32_t) * (N + 1));
    assert_memory_equal(a[0].core, a[1].core, sizeof(fl_vec2) * (size_t)a[0].first[N]);
    for (int k = 0; k < 2; k++) {
        fl_power_cells_free(&c[k]);
        fl_floes_free(&a[k]);
    }
}

static void failures_are_reported(void **state)
{
    (void)state;
    static double area[N];
    fl_power_cells c = {0};
    fl_floes a = {0};
    double off;
    fl_err err = {0};
    int rc = -1;
    make_sizes(N, &RECTANGLE, 0.8, area);
    assert_int_equal(fl_prescribed_areas_floes(&c, &a, N, test_seed(), area, &RECTANGLE, 0, 0.8, 0.5,
                                               (fl_vec2){0, 0}, &off, &err),
                     -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_non_null(strstr(err.text, "has no room for a dilation radius of 0.5 m"));
    for (long k = 0; rc; k++) {
        err = (fl_err){0};
        fl_alloc_fail_after(k);
        rc = fl_prescribed_areas_floes(&c, &a, 5, test_seed(), (double[]){60, 60, 60, 60, 80}, &RECTANGLE, 1,
                                       0.8, 0.01, (fl_vec2){0, 0}, &off, &err);
        fl_alloc_fail_after(-1);
        if (rc) {
            assert_int_equal(err.code, FL_SYSTEM);
            assert_null(c.first);
            assert_null(a.first);
        }
    }
    fl_power_cells_free(&c);
    fl_floes_free(&a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(discs_are_separate),    cmocka_unit_test(cells_get_their_areas),
        cmocka_unit_test(cells_in_one_call),     cmocka_unit_test(two_cells),
        cmocka_unit_test(floes_get_their_areas), cmocka_unit_test(failures_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
