/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/array.h"
#include "mesh/merge_cylinders.h"
#include "support/near.h"

static const double TWO_PI = 6.283185307179586477;
static fl_err err;
static fl_part p;
static fl_merged_cylinders did;

static int end(void **state)
{
    (void)state;
    fl_part_free(&p);
    did = (fl_merged_cylinders){0};
    return 0;
}

static void line(fl_vec3 a, double ra, fl_vec3 b, double rb)
{
    if (fl_surface_cone(&p, (fl_cone){a, b, ra, rb}, &err)) fail_msg("%s", err.text);
}

static void straighten(void)
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

static void swap(int32_t a, int32_t b)
{
    const fl_cone keep = p.cone[a];
    p.cone[a] = p.cone[b];
    p.cone[b] = keep;
}

/* Points of a leg from (1, 2, -3) along d, and radii that fall from r with the slope s. */
static void leg(int n, fl_vec3 d, double r, double s)
{
    const fl_vec3 o = v3(1, 2, -3);
    for (int k = 0; k < n; k++) {
        const fl_vec3 a = v3_madd(o, k * k + k, d), b = v3_madd(o, k * k + 3 * k + 2, d);
        const double ra = r - s * (k * k + k), rb = r - s * (k * k + 3 * k + 2);
        if (k % 3) line(b, rb, a, ra); /* this way and that */
        else line(a, ra, b, rb);
    }
}

static void legs_become_one(void **state)
{
    static const double slope[] = {0.0, 0.001, -0.01};
    for (int i = 0; i < 3; i++)
        for (int n = 2; n < 12; n++) {
            double had;
            leg(n, v3(0, 0.25, 1.5), 2.0, slope[i]);
            for (int k = n - 1; k > 0; k--) swap(k, 5 * k % (k + 1));
            had = volume();
            straighten();
            assert_int_equal(p.nc, 1);
            assert_int_equal(did.merged, n);
            assert_int_equal(did.remaining, 1);
            assert_near(volume(), had, 1e-14);
            assert_true(did.max_error < 1e-13);
            end(state);
        }
}

static void what_does_not_go_on_stays(void **state)
{
    const fl_vec3 a = v3(0, 0, 0), b = v3(0, 0, 2), c = v3(0, 0, 5), d = v3(1, 0, 5), e = v3(0, 1, 5);
    line(a, 1, b, 1); /* another radius, another slope, a bend, a brace, a gap */
    line(b, 1.1, c, 1.1);
    straighten();
    assert_int_equal(p.nc, 2);
    end(state);
    line(a, 1, b, 1);
    line(b, 1, c, 0.5);
    straighten();
    assert_int_equal(p.nc, 2);
    end(state);
    line(a, 0, b, 1); /* tip to tip is a bend in slope, too */
    line(b, 1, c, 0);
    line(d, 1, v3(1, 0, 8), 0);
    line(v3(1, 0, 8), 0, v3(1, 0, 11), 1);
    straighten();
    assert_int_equal(p.nc, 4);
    end(state);
    line(b, 1, c, 1);
    line(c, 1, d, 1);
    line(c, 1, e, 1);
    straighten();
    assert_int_equal(p.nc, 3);
    line(a, 1, b, 1); /* and now one goes on, beside braces */
    straighten();
    assert_int_equal(p.nc, 3);
    assert_int_equal(did.merged, 2);
    line(b, 1, c, 1); /* a double: none is the one that goes on */
    line(c, 1, v3(0, 0, 9), 1);
    straighten();
    assert_int_equal(p.nc, 5);
    end(state);
    straighten();
    line(a, 1, b, 1);
    line(v3(0, 0, 2.001), 1, c, 1);
    straighten();
    assert_int_equal(p.nc, 2);
    assert_int_equal(did.merged, 0);
}

/* An arc of a wide circle: as many pieces as keep within the tolerance, and no end has moved by more. */
static void arcs_are_divided(void **state)
{
    enum { N = 400 };
    double tol, had;
    for (int k = 0; k < N; k++) {
        const double s = 1e-4 * k, t = 1e-4 * (k + 1);
        line(v3(1000 * sin(s), 0, 1000 * cos(s)), 0.5, v3(1000 * sin(t), 0, 1000 * cos(t)), 0.5);
    }
    had = volume();
    straighten();
    tol = 1e-6 * 41.0;
    /* the sagitta of m steps of 1e-4 at 1000 m is (m 1e-4)^2 1000 / 8: m = 6 fits, 4 do after halving */
    assert_true(p.nc >= N / 6 && p.nc < N / 2);
    assert_true(did.max_error > 0.0 && did.max_error <= tol);
    assert_near(volume(), had, 1e-6);
    for (int32_t k = 0; k + 1 < p.nc; k++)
        assert_near(v3_norm(v3_sub(p.cone[k].p1, p.cone[k + 1].p0)), 0.0, 0.0);
    end(state);
    for (int k = 0; k < 8000; k++) { /* a ring without a beginning */
        const double s = TWO_PI * k / 8000, t = TWO_PI * ((k + 1) % 8000) / 8000;
        line(v3(cos(s), sin(s), 0), 0.1, v3(cos(t), sin(t), 0), 0.1);
    }
    straighten();
    assert_int_equal(p.nc, 8000);
}

static void many_lines_in_one_place_are_left(void **state)
{
    (void)state;
    for (int k = 0; k < 100; k++) line(v3(0, 0, 0), 1, v3(cos(0.1 * k), sin(0.1 * k), k % 7 - 3), 1);
    straighten();
    assert_int_equal(p.nc, 100);
}

static void without_memory_it_says_so(void **state)
{
    int rc = -1;
    (void)state;
    leg(5, v3(0, 0, 1), 1.0, 0.0);
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
        cmocka_unit_test_teardown(legs_become_one, end),
        cmocka_unit_test_teardown(what_does_not_go_on_stays, end),
        cmocka_unit_test_teardown(arcs_are_divided, end),
        cmocka_unit_test_teardown(many_lines_in_one_place_are_left, end),
        cmocka_unit_test_teardown(without_memory_it_says_so, end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
