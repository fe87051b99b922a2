/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "support/near.h"
#include "ice/sphere_packing.h"

static fl_sphere_packing make_packing(enum fl_packing_kind kind, double d, int32_t layers, double wide,
                                      double deep)
{
    fl_sphere_packing a = {0};
    fl_err err = {0};
    assert_int_equal(fl_sphere_packing_make(&a, kind, d, layers, (fl_vec2){-1.0, 2.0},
                                            (fl_vec2){wide - 1.0, deep + 2.0}, &err),
                     0);
    return a;
}

/* Two published fields, to a sphere; the counts are those of the rows that fit. */
static void published_fields_are_reproduced(void **state)
{
    (void)state;
    fl_sphere_packing a = make_packing(FL_PACKING_HCP, 0.094, 3, 20.0, 15.0);
    assert_int_equal(a.n, 117024);
    assert_int_equal(a.columns, 212);
    assert_int_equal(a.rows, 184);
    fl_sphere_packing_free(&a);
    a = make_packing(FL_PACKING_HEX, 0.25, 2, 100.0, 90.0);
    assert_int_equal(a.n, 332000);
    assert_int_equal(a.columns, 400);
    assert_int_equal(a.rows, 415);
    fl_sphere_packing_free(&a);
}

/* All pairs by brute force: the listed pairs touch, no other pair is closer than sqrt(2) D times 0.99 (the
 * next shell of all three lattices), and no pair overlaps. */
static void pairs_are_those_that_touch(void **state)
{
    (void)state;
    static const enum fl_packing_kind kinds[3] = {FL_PACKING_HCP, FL_PACKING_HEX, FL_PACKING_SQUARE};
    for (int m = 0; m < 3; m++)
        for (int32_t layers = 1; layers <= 4; layers++) {
            const double d = 0.3;
            fl_sphere_packing a = make_packing(kinds[m], d, layers, 1.6, 1.9);
            int32_t k = 0;
            for (int32_t i = 0; i < a.n; i++)
                for (int32_t j = i + 1; j < a.n; j++) {
                    const double far = v3_norm(v3_sub(a.x[i], a.x[j]));
                    if (k < a.pairs && a.pair[k][0] == i && a.pair[k][1] == j) {
                        assert_near(far, d, 1e-12);
                        k++;
                    } else {
                        assert_true(far > 0.99 * sqrt(2.0) * d);
                    }
                }
            assert_int_equal(k, a.pairs);
            fl_sphere_packing_free(&a);
        }
}

/* Number of neighbours of an inner sphere. */
static void the_coordination_number_is_that_of_the_lattice(void **state)
{
    (void)state;
    static const struct {
        enum fl_packing_kind kind;
        int32_t expected;
    } of[3] = {{FL_PACKING_HCP, 12}, {FL_PACKING_HEX, 8}, {FL_PACKING_SQUARE, 6}};
    for (int m = 0; m < 3; m++) {
        fl_sphere_packing a = make_packing(of[m].kind, 1.0, 5, 9.0, 9.0);
        const int32_t middle = (2 * a.rows + a.rows / 2) * a.columns + a.columns / 2;
        int32_t have = 0;
        for (int32_t k = 0; k < a.pairs; k++) have += a.pair[k][0] == middle || a.pair[k][1] == middle;
        assert_int_equal(have, of[m].expected);
        fl_sphere_packing_free(&a);
    }
}

static void the_sheet_is_centred_and_fits_its_box(void **state)
{
    (void)state;
    const double d = 0.25;
    fl_sphere_packing a = make_packing(FL_PACKING_HCP, d, 3, 5.0, 4.0);
    double lo[2] = {1e9, 1e9}, hi[2] = {-1e9, -1e9};
    for (int32_t i = 0; i < a.n; i++) {
        lo[0] = fmin(lo[0], a.x[i].x);
        hi[0] = fmax(hi[0], a.x[i].x);
        lo[1] = fmin(lo[1], a.x[i].y);
        hi[1] = fmax(hi[1], a.x[i].y);
    }
    assert_near_of(0.5 * (lo[0] + hi[0]), 1.5, 1e-13, 5.0);
    assert_near_of(0.5 * (lo[1] + hi[1]), 4.0, 1e-13, 5.0);
    assert_true(hi[0] - lo[0] + d <= 5.0 + 0.5 * d + 1e-12);
    assert_true(hi[1] - lo[1] + d <= 4.0 + 0.5 * d + 1e-12);
    assert_near(a.x[a.n - 1].z, 0.5 * d + 2.0 * d * sqrt(2.0 / 3.0), 1e-15);
    fl_sphere_packing_free(&a);
}

/* One layer floats at its centre with half its volume submerged; other volumes follow Archimedes, by the sum
 * of the caps. */
static void drafts_displace_the_given_volume(void **state)
{
    (void)state;
    fl_sphere_packing a = make_packing(FL_PACKING_SQUARE, 2.0, 1, 4.0, 4.0);
    assert_near(fl_sphere_packing_draft(&a, 0.5), 1.0, 1e-15);
    fl_sphere_packing_free(&a);
    a = make_packing(FL_PACKING_HCP, 0.094, 3, 2.0, 2.0);
    for (int k = 1; k < 20; k++) {
        const double t = fl_sphere_packing_draft(&a, 0.05 * k), r = 0.047;
        double under = 0.0;
        for (int32_t i = 0; i < a.n; i++) under += fl_spherical_cap_volume(r, t - (a.x[i].z - r));
        assert_near(under / (a.n * fl_spherical_cap_volume(r, 1.0)), 0.05 * k, 1e-13);
    }
    fl_sphere_packing_free(&a);
}

static void a_packing_that_does_not_fit_is_reported(void **state)
{
    (void)state;
    fl_sphere_packing a = {0};
    fl_err err = {0};
    assert_int_equal(
        fl_sphere_packing_make(&a, FL_PACKING_HCP, 2.0, 1, (fl_vec2){0, 0}, (fl_vec2){1, 5}, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    err = (fl_err){0};
    assert_int_equal(
        fl_sphere_packing_make(&a, FL_PACKING_SQUARE, 2.0, 1, (fl_vec2){0, 0}, (fl_vec2){5, 1}, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    err = (fl_err){0};
    assert_int_equal(
        fl_sphere_packing_make(&a, FL_PACKING_HCP, 1e-6, 9, (fl_vec2){0, 0}, (fl_vec2){1e6, 1e6}, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_null(a.x);
    a = make_packing(FL_PACKING_SQUARE, 0.1, 1, 0.3, 0.7); /* 0.3 / 0.1 is below 3 in doubles */
    assert_int_equal(a.columns, 3);
    assert_int_equal(a.rows, 7);
    fl_sphere_packing_free(&a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(published_fields_are_reproduced),
                                       cmocka_unit_test(pairs_are_those_that_touch),
                                       cmocka_unit_test(the_coordination_number_is_that_of_the_lattice),
                                       cmocka_unit_test(the_sheet_is_centred_and_fits_its_box),
                                       cmocka_unit_test(drafts_displace_the_given_volume),
                                       cmocka_unit_test(a_packing_that_does_not_fit_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
