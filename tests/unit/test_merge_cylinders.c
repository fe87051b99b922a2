/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/array.h"
#include "mesh/merge_cylinders.h"
#include "support/near.h"

static const double TWO_PI = 6.283185307179586477;
static fl_err err;
static fl_part p;
static fl_merged_cylinders did;

static int free_part(void **state)
{
    (void)state;
    fl_part_free(&p);
    did = (fl_merged_cylinders){0};
    return 0;
}

static void add_cone(fl_vec3 a, double ra, fl_vec3 b, double rb)
{
    if (fl_surface_cone(&p, (fl_cone){a, b, ra, rb}, &err)) fail_msg("%s", err.text);
}

static void merge_cylinders(void)
{
    if (fl_part_merge_cylinders(&p, &did, &err)) fail_msg("%s", err.text);
}

static double volume(void)
{
    double sum = 0.0;
    for (int32_t k = 0; k < p.nc; k++) {
        const fl_cone *c = &p.cone[k];
        sum += v3_norm(v3_sub(c->p1, c->p0)) * (c->r0 * c->r0 + c->r0 * c->r1 + c->r1 * c->r1);
    }
    return sum;
}

static void swap_cones(int32_t a, int32_t b)
{
    const fl_cone keep = p.cone[a];
    p.cone[a] = p.cone[b];
    p.cone[b] = keep;
}

/* Segments of a leg from (1, 2, -3) along d, with radii that fall from r with the slope s. */
static void add_leg(int n, fl_vec3 d, double r, double s)
{
    const fl_vec3 o = v3(1, 2, -3);
    for (int k = 0; k < n; k++) {
        const fl_vec3 a = v3_madd(o, k * k + k, d), b = v3_madd(o, k * k + 3 * k + 2, d);
        const double ra = r - s * (k * k + k), rb = r - s * (k * k + 3 * k + 2);
        if (k % 3) add_cone(b, rb, a, ra); /* in both directions */
        else add_cone(a, ra, b, rb);
    }
}

static void segments_of_a_leg_become_one(void **state)
{
    static const double slope[] = {0.0, 0.001, -0.01};
    for (int i = 0; i < 3; i++)
        for (int n = 2; n < 12; n++) {
            double had;
            add_leg(n, v3(0, 0.25, 1.5), 2.0, slope[i]);
            for (int k = n - 1; k > 0; k--) swap_cones(k, 5 * k % (k + 1));
            had = volume();
            merge_cylinders();
            assert_int_equal(p.nc, 1);
            assert_int_equal(did.merged, n);
            assert_int_equal(did.remaining, 1);
            assert_near(volume(), had, 1e-14);
            assert_true(did.max_error < 1e-13);
            free_part(state);
        }
}

static void discontinuous_segments_stay(void **state)
{
    const fl_vec3 a = v3(0, 0, 0), b = v3(0, 0, 2), c = v3(0, 0, 5), d = v3(1, 0, 5), e = v3(0, 1, 5);
    add_cone(a, 1, b, 1); /* another radius, another slope, a bend, a brace, a gap */
    add_cone(b, 1.1, c, 1.1);
    merge_cylinders();
    assert_int_equal(p.nc, 2);
    free_part(state);
    add_cone(a, 1, b, 1);
    add_cone(b, 1, c, 0.5);
    merge_cylinders();
    assert_int_equal(p.nc, 2);
    free_part(state);
    add_cone(a, 0, b, 1); /* tip to tip is a change of slope, too */
    add_cone(b, 1, c, 0);
    add_cone(d, 1, v3(1, 0, 8), 0);
    add_cone(v3(1, 0, 8), 0, v3(1, 0, 11), 1);
    merge_cylinders();
    assert_int_equal(p.nc, 4);
    free_part(state);
    add_cone(b, 1, c, 1);
    add_cone(c, 1, d, 1);
    add_cone(c, 1, e, 1);
    merge_cylinders();
    assert_int_equal(p.nc, 3);
    add_cone(a, 1, b, 1); /* and now one continues, next to braces */
    merge_cylinders();
    assert_int_equal(p.nc, 3);
    assert_int_equal(did.merged, 2);
    add_cone(b, 1, c, 1); /* a duplicate: neither is a continuation */
    add_cone(c, 1, v3(0, 0, 9), 1);
    merge_cylinders();
    assert_int_equal(p.nc, 5);
    free_part(state);
    merge_cylinders();
    add_cone(a, 1, b, 1);
    add_cone(v3(0, 0, 2.001), 1, c, 1);
    merge_cylinders();
    assert_int_equal(p.nc, 2);
    assert_int_equal(did.merged, 0);
}

/* An arc of a large circle: as few pieces as stay within the tolerance, with unchanged ends. */
static void arcs_become_chords(void **state)
{
    enum { N = 400 };
    double tol, had;
    for (int k = 0; k < N; k++) {
        const double s = 1e-4 * k, t = 1e-4 * (k + 1);
        add_cone(v3(1000 * sin(s), 0, 1000 * cos(s)), 0.5, v3(1000 * sin(t), 0, 1000 * cos(t)), 0.5);
    }
    had = volume();
    merge_cylinders();
    tol = 1e-6 * 41.0;
    /* the sagitta of m steps of 1e-4 at 1000 m is (m 1e-4)^2 1000 / 8: m = 6 fits, 4 do after halving */
    assert_true(p.nc >= N / 6 && p.nc < N / 2);
    assert_true(did.max_error > 0.0 && did.max_error <= tol);
    assert_near(volume(), had, 1e-6);
    for (int32_t k = 0; k + 1 < p.nc; k++)
        assert_near(v3_norm(v3_sub(p.cone[k].p1, p.cone[k + 1].p0)), 0.0, 0.0);
    free_part(state);
    for (int k = 0; k < 8000; k++) { /* a closed ring */
        const double s = TWO_PI * k / 8000, t = TWO_PI * ((k + 1) % 8000) / 8000;
        add_cone(v3(cos(s), sin(s), 0), 0.1, v3(cos(t), sin(t), 0), 0.1);
    }
    merge_cylinders();
    assert_int_equal(p.nc, 8000);
}

static void coincident_segments_stay(void **state)
{
    (void)state;
    for (int k = 0; k < 100; k++) add_cone(v3(0, 0, 0), 1, v3(cos(0.1 * k), sin(0.1 * k), k % 7 - 3), 1);
    merge_cylinders();
    assert_int_equal(p.nc, 100);
}

static void allocation_failure_is_reported(void **state)
{
    int rc = -1;
    (void)state;
    add_leg(5, v3(0, 0, 1), 1.0, 0.0);
    for (long fail = 0; rc; fail++) {
        err = (fl_err){0};
        assert_int_equal(p.nc, 5);
        fl_alloc_fail_after(fail);
        rc = fl_part_merge_cylinders(&p, &did, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
    }
    assert_int_equal(p.nc, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(segments_of_a_leg_become_one, free_part),
        cmocka_unit_test_teardown(discontinuous_segments_stay, free_part),
        cmocka_unit_test_teardown(arcs_become_chords, free_part),
        cmocka_unit_test_teardown(coincident_segments_stay, free_part),
        cmocka_unit_test_teardown(allocation_failure_is_reported, free_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
