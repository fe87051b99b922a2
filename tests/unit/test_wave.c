/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/near.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "support/shapes.h"
#include "water/froude_krylov.h"

static double pressure_head(const fl_waves *w, double s, double z, double t)
{
    double P = 0.0;
    for (int32_t j = 0; j < w->n; j++) {
        const fl_wave_train *q = &w->train[j];
        const double kd = q->k * w->depth, C = kd < 300 ? cosh(q->k * z + kd) / cosh(kd) : exp(q->k * z);
        P += q->a * C * cos(q->k * s - q->omega * t + q->phase);
    }
    return P;
}

/* Bodies of any size and position: the number of cells is within the stated bound, and cells equal the
 * sum. */
static void cells_cover_a_body(void **state)
{
    (void)state;
    for (int k = 0; k < 60; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_waves w = {0};
        fl_err err = {0};
        fl_wave_field a;
        const double depth = k % 3 ? INFINITY : 30.0, reach = pow(10, fl_rng_in(&g, -1, 1.5));
        assert_int_equal(
            fl_waves_jonswap(&w, 1.0, fl_rng_in(&g, 2.5, 9.0), 3.3, 30, (uint64_t)k, 40, depth, 9.81, &err),
            0);
        const int32_t capacity = fl_wave_field_cells(&w, reach + w.four_sigma);
        fl_wave_expansion *cell = fl_alloc(capacity, sizeof *cell, &err);
        assert_non_null(cell);
        const double s0 = fl_rng_in(&g, -300, 300), z0 = fl_rng_in(&g, -25, 1), t = fl_rng_in(&g, 0, 1e4);
        fl_wave_field_fill(&w, s0 - reach, s0 + reach, z0 - reach - w.four_sigma, z0 + reach + w.four_sigma,
                           t, cell, &a);
        assert_true(a.columns * (1 + a.rows) <= capacity);
        for (int j = 0; j < 50; j++) {
            const double s = s0 + fl_rng_in(&g, -reach, reach);
            const double z = fmax(fmin(z0 + fl_rng_in(&g, -reach, reach), 0.0), -w.depth);
            assert_near_of(fl_wave_field_elevation(&a, s, NULL), pressure_head(&w, s, 0.0, t), 1e-4, 1.0);
            assert_near_of(fl_wave_pressure(fl_wave_field_cell(&a, s, z), s, z), pressure_head(&w, s, z, t),
                           1e-4, 1.0);
        }
        free(cell);
        fl_waves_free(&w);
    }
}

/* A box far under water feels the acceleration of the wave there, one above it nothing. */
static void deep_and_dry_bodies(void **state)
{
    (void)state;
    fl_waves w = {0};
    fl_err err = {0};
    fl_poly p;
    fl_hull h;
    fl_hull_panels tiles = {0};
    fl_water_load load;
    fl_wave_field a;
    assert_int_equal(fl_waves_airy(&w, 2.0, 6.0, 0.0, INFINITY, 9.81, &err), 0);
    fl_wave_expansion *cell = fl_alloc(fl_wave_field_cells(&w, 20.0), sizeof *cell, &err);
    assert_non_null(cell);
    assert_int_equal(fl_poly_box(&p, v3(0.3, 0.4, 0.2), &err), 0);
    assert_int_equal(fl_hull_make(&h, &p, 0.0, &err), 0);
    assert_int_equal(fl_hull_panels_make(&tiles, &h, &w, &err), 0);
    for (int k = 0; k < 20; k++) {
        const double z = k < 10 ? -3.0 : 4.0, s = 5.0 * k, kk = w.train[0].k;
        const fl_hull_pose at = {.up = v3(0, 0, 1), .along = v3(1, 0, 0), .s = s, .z = z};
        fl_wave_field_fill(&w, s - 0.3, s + 0.3, z - 0.2 - w.four_sigma, z + 0.2 + w.four_sigma, 7.0, cell,
                           &a);
        fl_froude_krylov_solid(&tiles, &h, &w, &a, &at, 1000 * 9.81, &load);
        if (k >= 10) {
            assert_true(load.volume == 0.0 && load.wetted == 0.0 && v3_norm(load.force) == 0.0);
            continue;
        }
        const double eta = fl_wave_field_elevation(&a, s, NULL), zeta = z - eta;
        const double psi = kk * s - w.train[0].omega * 7.0, m = 1000 * h.volume;
        assert_near(load.volume, h.volume, 1e-9);
        assert_near(load.wetted, h.surface_area, 1e-12);
        assert_near_of(load.centre.z, 0.0, 1e-9, 1.0);
        /* stretching makes the column under a crest longer: a share of the slope and of the height k a */
        assert_near_of(load.force.x, m * 9.81 * kk * exp(kk * zeta) * sin(psi), 0.2, m * 9.81 * kk);
        assert_near_of(load.force.z - m * 9.81, -m * 9.81 * kk * exp(kk * zeta) * cos(psi), 0.2,
                       m * 9.81 * kk);
    }
    free(cell);
    fl_hull_panels_free(&tiles);
    fl_hull_free(&h);
    fl_poly_free(&p);
    fl_waves_free(&w);
}

static void seas_are_made_from_their_seed(void **state)
{
    (void)state;
    fl_waves a = {0}, b = {0}, c = {0};
    fl_err err = {0};
    double sum = 0.0;
    assert_int_equal(fl_waves_jonswap(&a, 3, 9, 2, 50, 4, 0, INFINITY, 9.81, &err), 0);
    assert_int_equal(fl_waves_jonswap(&b, 3, 9, 2, 50, 4, 0, INFINITY, 9.81, &err), 0);
    assert_int_equal(fl_waves_jonswap(&c, 3, 9, 2, 50, 5, 0, INFINITY, 9.81, &err), 0);
    assert_memory_equal(a.train, b.train, 50 * sizeof *a.train);
    assert_true(a.train[7].phase != c.train[7].phase && a.train[7].omega != c.train[7].omega);
    for (int32_t j = 0; j < 50; j++) {
        sum += 0.5 * a.train[j].a * a.train[j].a;
        if (j) assert_true(a.train[j].k > a.train[j - 1].k);
    }
    assert_near(4 * sqrt(sum), 3.0, 1e-14);
    double breaking;
    assert_near(fl_wave_steepness(1.0, 2.0, INFINITY, 9.81, &breaking), 2 * PI / (9.81 * 4), 1e-12);
    assert_near(breaking, 0.142, 1e-15);
    fl_waves_free(&a), fl_waves_free(&b), fl_waves_free(&c);
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    for (long k = 0; k < 3; k++) {
        fl_waves w = {0};
        fl_err err = {0};
        fl_alloc_fail_after(k);
        const int rc = fl_waves_jonswap(&w, 3, 9, 2, 50, 4, 0, INFINITY, 9.81, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(rc, k < 2 ? -1 : 0);
        if (rc) assert_int_equal(err.code, FL_SYSTEM);
        fl_waves_free(&w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_cover_a_body), cmocka_unit_test(deep_and_dry_bodies),
        cmocka_unit_test(seas_are_made_from_their_seed), cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests_name("wave", tests, NULL, NULL);
}
