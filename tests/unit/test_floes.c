/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <omp.h>
#include <string.h>
#include "support/near.h"
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "geom/clip.h"
#include "geom/mass.h"
#include "ice/certificate.h"
#include "ice/floe_gaps.h"
#include "ice/floes.h"

static const fl_vec2 LO = {-25.0, -20.0}, HI = {25.0, 20.0};
#define AREA 2000.0

static void make_cells(fl_power_cells *c, int32_t n, uint64_t seed, int smooth)
{
    fl_vec2 site[1000];
    fl_err err = {0};
    assert_true(n <= 1000);
    fl_random_sites(n, seed, LO, HI, site);
    assert_int_equal(fl_power_cells_build(c, n, site, LO, HI, &err), 0);
    for (int k = 0; k < smooth; k++) {
        fl_power_cells_centroids(c, site);
        fl_power_cells_free(c);
        assert_int_equal(fl_power_cells_build(c, n, site, LO, HI, &err), 0);
    }
}

/* Conditions of every field: the requested area, measured by summation; the outer polygon is the offset of
 * the core and stays in its cell by half the inset of the floe; no overlap. */
static void check_field(const fl_power_cells *c, const fl_floes *a, double concentration, double radius)
{
    fl_certificate cert;
    fl_err err = {0};
    double sum = 0.0;
    for (int32_t i = 0; i < a->n; i++) {
        const int32_t n = a->first[i + 1] - a->first[i];
        const fl_vec2 *core = a->core + a->first[i], *outer = a->outer + a->first[i];
        assert_in_range(n, 3, 30);
        sum += fl_polygon_area(n, outer);
        for (int32_t k = 0; k < n; k++) {
            const fl_vec2 p = core[k], q = core[(k + 1) % n], r = core[(k + 2) % n], o = outer[k];
            const double e = hypot(q.x - p.x, q.y - p.y);
            assert_true((q.x - p.x) * (r.y - q.y) - (q.y - p.y) * (r.x - q.x) > 0.0);
            assert_near_of((q.x - p.x) * (o.y - p.y) - (q.y - p.y) * (o.x - p.x), -radius * e, 1e-12, e);
            for (int32_t f = c->first[i]; f < c->first[i + 1]; f++)
                assert_true(fl_polygon_side_distance(c->side[f], outer[k]) < 0.0);
        }
    }
    assert_near(sum, concentration * AREA, 1e-12);
    assert_int_equal(fl_certificate_make(&cert, a, &err), 0);
    assert_int_equal(cert.overlaps, 0);
    assert_near(cert.total_area, sum, 1e-14);
    assert_true(cert.min_gap > 0.0);
}

/* Distance from floe i to the nearest side of its cell. */
static double nearest_side(const fl_power_cells *c, const fl_floes *a, int32_t i)
{
    double least = INFINITY;
    for (int32_t f = c->first[i]; f < c->first[i + 1]; f++)
        for (int32_t k = a->first[i]; k < a->first[i + 1]; k++)
            least = fmin(least, -fl_polygon_side_distance(c->side[f], a->outer[k]));
    return least;
}

/* Even gaps are twice the inset; pushed, each floe touches a side of its cell, none overlaps, areas stay, and
 * about one in five touches another. */
static void pushed_floes_touch_here_and_there(void **state)
{
    const fl_vec2 none = {0.0, 0.0};
    fl_power_cells c = {0};
    fl_floes a = {0}, same = {0};
    fl_floe_gaps even, pushed;
    fl_err err = {0};
    (void)state;
    make_cells(&c, 600, 5, 2);
    assert_int_equal(fl_floes_make(&a, &c, 0.6, 0.05, none, &err), 0);
    assert_int_equal(fl_floe_gaps_measure(&even, &a, &c, none, &err), 0);
    assert_near(even.median, 2.0 * a.inset, 1e-9);
    assert_true(even.touching == 0.0);
    fl_floes_push(&a, &c, none, 9);
    check_field(&c, &a, 0.6, 0.05);
    assert_int_equal(fl_floe_gaps_measure(&pushed, &a, &c, none, &err), 0);
    for (int32_t i = 0; i < a.n; i++) assert_true(nearest_side(&c, &a, i) < 2e-5 * a.inset);
    assert_true(pushed.touching > 0.1 && pushed.touching < 0.3);
    assert_true(pushed.q90 > 1.5 * even.median && pushed.q90 < 2.0 * even.median);
    assert_int_equal(fl_floes_make(&same, &c, 0.6, 0.05, none, &err), 0);
    fl_floes_push(&same, &c, none, 9);
    assert_memory_equal(same.core, a.core, (size_t)a.first[a.n] * sizeof *a.core);
    fl_floes_free(&same);
    fl_floes_free(&a);
    fl_power_cells_free(&c);
}

static void concentration_is_reached_without_overlap(void **state)
{
    (void)state;
    static const double requested[] = {0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95};
    for (int s = 0; s < test_times(30); s++) {
        const double radius[3] = {0.0, 0.05, 0.12};
        fl_power_cells c = {0};
        make_cells(&c, 120, test_seed() + (uint64_t)s, s % 4);
        for (int k = 0; k < 8; k++) {
            fl_floes a = {0};
            fl_err err = {0};
            if (fl_floes_make(&a, &c, requested[k], radius[s % 3], (fl_vec2){0, 0}, &err))
                fail_msg("seed %d concentration %g: %s", s, requested[k], err.text);
            assert_int_equal(a.n, 120);
            check_field(&c, &a, requested[k], radius[s % 3]);
            fl_floes_free(&a);
        }
        fl_power_cells_free(&c);
    }
}

/* The solver takes mass and buoyancy from the core's faces moved outward: these volumes must equal the
 * requested ice. */
static void the_solver_sees_the_requested_ice(void **state)
{
    (void)state;
    const double thickness = 0.6, radius = 0.1;
    fl_power_cells c = {0};
    fl_floes a = {0};
    fl_err err = {0};
    double volume = 0.0;
    make_cells(&c, 300, test_seed(), 1);
    assert_int_equal(fl_floes_make(&a, &c, 0.9, radius, (fl_vec2){0, 0}, &err), 0);
    for (int32_t i = 0; i < a.n; i++) {
        const int32_t n = a.first[i + 1] - a.first[i];
        fl_vec3 xy[30];
        fl_poly core = {0}, sharp = {0};
        fl_mass m;
        for (int32_t k = 0; k < n; k++) xy[k] = v3(a.core[a.first[i] + k].x, a.core[a.first[i] + k].y, 0.0);
        assert_int_equal(fl_poly_prism(&core, n, xy, radius - 0.5, thickness - radius - 0.5, &err), 0);
        assert_int_equal(fl_poly_offset(&sharp, &core, radius, &err), 0);
        assert_int_equal(sharp.nv, core.nv);
        assert_int_equal(fl_mass_of(&m, &sharp, 0.0, &err), 0);
        volume += m.volume;
        fl_poly_free(&core);
        fl_poly_free(&sharp);
    }
    assert_near(volume, 0.9 * AREA * thickness, 1e-11);
    fl_floes_free(&a);
    fl_power_cells_free(&c);
}

/* Dense fields of coarse floes: nearly every short side requires a decision. */
static void dense_and_coarse_fields_converge(void **state)
{
    (void)state;
    int made = 0;
    for (int s = 0; s < test_times(40); s++) {
        fl_rng g = fl_rng_of(test_seed(), s, FL_RNG_TEST);
        const double concentration = 1.0 - pow(10.0, fl_rng_in(&g, -3.0, -0.5)),
                     radius = fl_rng_in(&g, 0.0, 0.3);
        fl_power_cells c = {0};
        fl_floes a = {0};
        fl_err err = {0};
        make_cells(&c, 200, test_seed() + (uint64_t)s, 3);
        if (fl_floes_make(&a, &c, concentration, radius, (fl_vec2){0, 0}, &err) == 0) {
            check_field(&c, &a, concentration, radius);
            made++;
        } else {
            assert_int_equal(err.code,
                             FL_INPUT); /* the radius removes more at the corners than there is open water */
        }
        fl_floes_free(&a);
        fl_power_cells_free(&c);
    }
    assert_true(made > test_times(40) / 2);
}

/* One cell of 50 x 40: (50 - 2 d)(40 - 2 d) = c 2000. */
static void one_floe_is_a_rectangle(void **state)
{
    (void)state;
    fl_power_cells c = {0};
    fl_floes a = {0};
    fl_certificate cert;
    fl_err err = {0};
    make_cells(&c, 1, 1, 0);
    assert_int_equal(fl_floes_make(&a, &c, 0.3, 1.5, (fl_vec2){100.0, 0.0}, &err), 0);
    assert_near(a.inset, (180.0 - sqrt(180.0 * 180.0 - 16.0 * (1.0 - 0.3) * AREA)) / 8.0, 1e-14);
    assert_int_equal(fl_certificate_make(&cert, &a, &err), 0);
    assert_near(cert.total_area, 600.0, 1e-13);
    assert_true(isinf(cert.min_gap));
    assert_int_equal(cert.min_gap_pair[0], -1);
    assert_near(cert.min_side, 40.0 - 2.0 * (a.inset + 1.5), 1e-13);
    assert_near(cert.min_angle, 0.5 * PI, 1e-14);
    assert_true(a.core[0].x > 75.0);
    fl_floes_free(&a);
    fl_power_cells_free(&c);
}

static void expect_refusal(const fl_power_cells *c, double concentration, double radius, const char *why)
{
    fl_floes a = {0};
    fl_err err = {0};
    assert_int_equal(fl_floes_make(&a, c, concentration, radius, (fl_vec2){0, 0}, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_int_equal(a.n, 0);
    if (!strstr(err.text, why)) fail_msg("\"%s\" where \"%s\" is expected", err.text, why);
}

static void impossible_requests_are_refused(void **state)
{
    (void)state;
    fl_vec2 site[4] = {{-10, 0}, {10, 0}, {0.3, 0.0}, {0.0, 15.0}};
    fl_power_cells c = {0};
    fl_err err = {0};
    make_cells(&c, 100, 1, 2);
    expect_refusal(&c, 0.5, 5.0, "too little for a core inside a dilation radius of 5 m");
    expect_refusal(&c, 0.01, 0.5, "of the area at least, 0.01 is requested");
    expect_refusal(&c, 1.0 - 1e-7, 0.5, "of the area at most, 0.9999999 is requested");
    fl_power_cells_free(&c);
    assert_int_equal(fl_power_cells_build(&c, 3, site, LO, HI, &err), 0);
    expect_refusal(&c, 0.5, 5.2, "the cell of floe 2 has an inscribed radius");
    fl_power_cells_free(&c);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    fl_power_cells c = {0};
    fl_floes a[3] = {{0}};
    const int threads = omp_get_max_threads(), use[3] = {1, 2, 5};
    make_cells(&c, 700, test_seed(), 1);
    for (int k = 0; k < 3; k++) {
        fl_err err = {0};
        omp_set_num_threads(use[k]);
        assert_int_equal(fl_floes_make(&a[k], &c, 0.85, 0.07, (fl_vec2){0, 0}, &err), 0);
        assert_memory_equal(a[k].first, a[0].first, 701 * sizeof *a[0].first);
        assert_memory_equal(a[k].core, a[0].core, (size_t)a[0].first[700] * sizeof *a[0].core);
    }
    omp_set_num_threads(threads);
    for (int k = 0; k < 3; k++) fl_floes_free(&a[k]);
    fl_power_cells_free(&c);
}

static void removing_floes_keeps_the_others(void **state)
{
    (void)state;
    fl_power_cells c = {0};
    fl_floes a = {0}, b = {0};
    fl_err err = {0};
    char gone[50] = {0};
    int32_t name[50], at = 0;
    make_cells(&c, 50, 3, 2);
    assert_int_equal(fl_floes_make(&a, &c, 0.5, 0.1, (fl_vec2){0, 0}, &err), 0);
    assert_int_equal(fl_floes_make(&b, &c, 0.5, 0.1, (fl_vec2){0, 0}, &err), 0);
    for (int32_t i = 0; i < 50; i++) {
        name[i] = i;
        gone[i] = i == 0 || i == 7 || i == 8 || i == 49;
    }
    fl_floes_remove(&b, gone, name);
    assert_int_equal(b.n, 46);
    for (int32_t i = 0; i < 50; i++) {
        const size_t n = (size_t)(a.first[i + 1] - a.first[i]);
        if (gone[i]) continue;
        assert_int_equal(name[at], i);
        assert_int_equal(b.first[at + 1] - b.first[at], n);
        assert_memory_equal(b.core + b.first[at], a.core + a.first[i], n * sizeof *a.core);
        assert_memory_equal(b.outer + b.first[at], a.outer + a.first[i], n * sizeof *a.outer);
        at++;
    }
    fl_floes_free(&a);
    fl_floes_free(&b);
    fl_power_cells_free(&c);
}

/* Squares of side 1 in a row with `gap` between them; the last one is lower by `by`. */
static void make_squares(fl_floes *a, int32_t n, double gap, double by)
{
    fl_err err = {0};
    *a = (fl_floes){.n = n, .inset = 1e-3};
    a->first = fl_alloc(n + 1, sizeof *a->first, &err);
    a->core = fl_alloc(4 * n, sizeof *a->core, &err);
    a->outer = fl_alloc(4 * n, sizeof *a->outer, &err);
    for (int32_t i = 0; i < n; i++) {
        const double x = i * (1.0 + gap), y = i + 1 < n ? 0.0 : -by;
        const fl_vec2 v[4] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
        a->first[i + 1] = 4 * (i + 1);
        for (int k = 0; k < 4; k++) a->core[4 * i + k] = a->outer[4 * i + k] = v[k];
    }
}

static void the_certificate_measures_gaps_and_overlaps(void **state)
{
    (void)state;
    const double gap[] = {0.5, 1e-9, 0.0, -1e-9, -0.2};
    for (int k = 0; k < 5; k++) {
        fl_floes a;
        fl_certificate c;
        fl_err err = {0};
        make_squares(&a, 10, gap[k], 0.0);
        assert_int_equal(fl_certificate_make(&c, &a, &err), 0);
        assert_int_equal(c.overlaps, gap[k] > 0.0 ? 0 : 9);
        assert_near_of(c.min_gap, gap[k] > 0.0 ? gap[k] : 0.0, 1e-14, 1.0);
        assert_near(c.total_area, 10.0, 1e-14);
        assert_near_of(c.cv, 0.0, 1e-13, 1.0);
        assert_int_equal(c.min_gap_pair[1], c.min_gap_pair[0] + 1);
        fl_floes_free(&a);
    }
    fl_floes a; /* far apart: the search must widen; corner to corner 3 and 4 */
    fl_certificate c;
    fl_err err = {0};
    make_squares(&a, 2, 3.0, 5.0);
    assert_int_equal(fl_certificate_make(&c, &a, &err), 0);
    assert_near(c.min_gap, 5.0, 1e-15);
    fl_floes_free(&a);
}

/* A corner on the line of its neighbours, two coincident corners, a clockwise polygon and a self-crossing one
 * are each detected; a sound one is not. */
static void the_certificate_detects_invalid_polygons(void **state)
{
    (void)state;
    for (int k = 0; k < 5; k++) {
        fl_floes a;
        fl_certificate c;
        fl_err err = {0};
        make_squares(&a, 10, 0.5, 0.0);
        fl_vec2 *v = (k & 1 ? a.core : a.outer) + 4 * 7;
        const fl_vec2 was[4] = {v[0], v[1], v[2], v[3]};
        /* halves are exact: v[1], v[2] and v[3] lie on one line */
        if (k == 0) v[2] = (fl_vec2){was[2].x - 0.5, was[2].y - 0.5};
        if (k == 1) v[2] = v[1];
        if (k == 2)
            for (int e = 0; e < 4; e++) v[e] = was[3 - e];
        if (k == 3)
            for (int e = 0; e < 4; e++) v[e] = was[2 * e % 4 + e / 2];
        assert_int_equal(fl_certificate_make(&c, &a, &err), 0);
        assert_int_equal(c.nonconvex, k < 4);
        fl_floes_free(&a);
    }
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    fl_power_cells c = {0};
    int rc = -1;
    make_cells(&c, 30, 1, 2);
    for (long k = 0; rc; k++) {
        fl_floes a = {0};
        fl_certificate cert;
        fl_err err = {0};
        fl_alloc_fail_after(k);
        rc = fl_floes_make(&a, &c, 0.8, 0.05, (fl_vec2){0, 0}, &err);
        if (rc == 0) rc = fl_certificate_make(&cert, &a, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
        fl_floes_free(&a);
        assert_true(k < 1000);
    }
    fl_power_cells_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pushed_floes_touch_here_and_there),
                                       cmocka_unit_test(concentration_is_reached_without_overlap),
                                       cmocka_unit_test(the_solver_sees_the_requested_ice),
                                       cmocka_unit_test(dense_and_coarse_fields_converge),
                                       cmocka_unit_test(one_floe_is_a_rectangle),
                                       cmocka_unit_test(impossible_requests_are_refused),
                                       cmocka_unit_test(threads_change_nothing),
                                       cmocka_unit_test(removing_floes_keeps_the_others),
                                       cmocka_unit_test(the_certificate_measures_gaps_and_overlaps),
                                       cmocka_unit_test(the_certificate_detects_invalid_polygons),
                                       cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
