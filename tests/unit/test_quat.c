/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <string.h>
#include "base/pi.h"
#include "base/rng.h"
#include "geom/quat.h"
#include "support/near.h"

#define EPS DBL_EPSILON

static fl_vec3 random_vector(fl_rng *g, double size)
{
    const double x = fl_rng_normal(g), y = fl_rng_normal(g), z = fl_rng_normal(g);
    return v3_scale(size, v3_unit(v3(x, y, z)));
}

static fl_quat random_rotation(fl_rng *g)
{
    const double w = fl_rng_normal(g), x = fl_rng_normal(g), y = fl_rng_normal(g), z = fl_rng_normal(g);
    return q_unit((fl_quat){w, x, y, z});
}

static void expect_vector(fl_vec3 a, fl_vec3 b, double tol)
{
    const double size = fmax(v3_norm(b), 1e-300);
    assert_near_of(a.x, b.x, tol, size);
    assert_near_of(a.y, b.y, tol, size);
    assert_near_of(a.z, b.z, tol, size);
}

/* Quarter and third turns have exact matrices: no rounding is allowed. */
static void quarter_and_third_turns_are_exact(void **state)
{
    (void)state;
    const fl_vec3 v = v3(1.0, 20.0, 300.0);
    const fl_quat half_x = {0, 1, 0, 0}, third = {0.5, 0.5, 0.5, 0.5};
    const fl_vec3 a = q_rotate(q_one(), v), b = q_rotate(half_x, v), c = q_rotate(third, v),
                  d = q_rotate(q_mul(third, third), v), e = m3_tmul(q_matrix(third), v);
    assert_true(a.x == 1 && a.y == 20 && a.z == 300);
    assert_true(b.x == 1 && b.y == -20 && b.z == -300);
    assert_true(c.x == 300 && c.y == 1 && c.z == 20); /* x to y to z to x */
    assert_true(d.x == 20 && d.y == 300 && d.z == 1);
    assert_true(e.x == 20 && e.y == 300 && e.z == 1);
    const fl_quat one = q_of_vector(v3(0, 0, 0));
    assert_true(one.w == 1 && one.x == 0 && one.y == 0 && one.z == 0);
}

/* Right-handed: +90 degrees about z takes x to y. */
static void handedness(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        fl_vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        expect_vector(q_rotate(q_about_axis(k, PI / 2), axis[(k + 1) % 3]), axis[(k + 2) % 3], 4 * EPS);
        expect_vector(q_rotate(q_of_vector(v3_scale(PI / 2, axis[k])), axis[(k + 1) % 3]), axis[(k + 2) % 3],
                      4 * EPS);
    }
}

/* Against the C library in long double, over the range of rotations of a step and far beyond. The header
 * promises 2e-16 up to half a radian and slow growth beyond. */
static void half_angles(void **state)
{
    (void)state;
    const long n = test_times(100000);
    double worst_small = 0.0, worst = 0.0;
    for (long k = 0; k < n; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const double a = pow(10.0, fl_rng_in(&g, -12.0, 1.0));
        for (int i = 0; i < 3; i++) {
            const fl_quat q = q_about_axis(i, a);
            const double s = i == 0 ? q.x : i == 1 ? q.y : q.z;
            const double miss = (double)fmaxl(fabsl(cosl(0.5L * a) - q.w), fabsl(sinl(0.5L * a) - s));
            if (a <= 0.5) worst_small = fmax(worst_small, miss);
            worst = fmax(worst, miss);
            /* small angles keep their relative precision */
            if (a < 1e-3) assert_near(s, (double)sinl(0.5L * a), 4 * EPS);
        }
        const fl_vec3 r = random_vector(&g, a);
        const fl_quat q = q_of_vector(r);
        assert_near_of(sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z), 1.0, 4e-15, 1.0);
        assert_near_of(q.x * r.y - q.y * r.x, 0.0, 4 * EPS, a);
    }
    if (worst_small > 2e-16 || worst > 2e-15) fail_msg("worst error %.3g, %.3g to 1/2", worst, worst_small);
}

static void products_compose(void **state)
{
    (void)state;
    const long n = test_times(20000);
    for (long k = 0; k < n; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const fl_quat a = random_rotation(&g), b = random_rotation(&g);
        const fl_vec3 v = random_vector(&g, pow(10.0, fl_rng_in(&g, -6.0, 6.0)));
        expect_vector(q_rotate(q_mul(a, b), v), q_rotate(a, q_rotate(b, v)), 16 * EPS);
        expect_vector(m3_tmul(q_matrix(a), q_rotate(a, v)), v, 16 * EPS);
        expect_vector(q_rotate(q_conj(a), v), m3_tmul(q_matrix(a), v), 8 * EPS);
        assert_near(v3_norm(q_rotate(a, v)), v3_norm(v), 16 * EPS);
        const fl_vec3 w = random_vector(&g, 1.0); /* rotation preserves the cross product: no mirror */
        expect_vector(v3_cross(q_rotate(a, v3_unit(v)), q_rotate(a, w)), q_rotate(a, v3_cross(v3_unit(v), w)),
                      1e-12);
    }
}

/* Matrix and back, also where a component is nearly or exactly zero: all four branches. */
static void matrix_and_back(void **state)
{
    (void)state;
    const long n = test_times(20000);
    for (long k = 0; k < n; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        double c[4];
        for (int i = 0; i < 4; i++)
            c[i] = fl_rng_normal(&g) * (fl_rng_unit(&g) < 0.3 ? pow(10.0, fl_rng_in(&g, -20.0, 0.0)) : 1.0) *
                   (fl_rng_unit(&g) < 0.2 ? 0.0 : 1.0);
        if (c[0] == 0 && c[1] == 0 && c[2] == 0 && c[3] == 0) continue;
        const fl_quat q = q_unit((fl_quat){c[0], c[1], c[2], c[3]}), p = q_of_matrix(q_matrix(q));
        const double dot = q.w * p.w + q.x * p.x + q.y * p.y + q.z * p.z, sign = dot < 0 ? -1.0 : 1.0;
        /* the same rotation with either sign */
        assert_near_of(sign * p.w, q.w, 8 * EPS, 1.0);
        assert_near_of(sign * p.x, q.x, 8 * EPS, 1.0);
        assert_near_of(sign * p.y, q.y, 8 * EPS, 1.0);
        assert_near_of(sign * p.z, q.z, 8 * EPS, 1.0);
        assert_near(p.w * p.w + p.x * p.x + p.y * p.y + p.z * p.z, 1.0, 4 * EPS);
    }
}

static void rotation_vectors(void **state)
{
    (void)state;
    const fl_vec3 zero = v3_unit(v3(0, 0, 0)), c = v3_cross(v3(1, 2, 3), v3(4, 5, 6)),
                  half = v3_lerp(v3(0, 2, 4), v3(2, 4, 8), 0.5);
    assert_true(zero.x == 0 && zero.y == 0 && zero.z == 0);
    assert_true(c.x == -3 && c.y == 6 && c.z == -3);
    assert_true(half.x == 1 && half.y == 3 && half.z == 6);
    for (long k = 0; k < 1000; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const fl_vec3 n = random_vector(&g, 1.0), t = v3_normal_to(n);
        assert_near(v3_norm(t), 1.0, 4 * EPS);
        assert_near_of(v3_dot(n, t), 0.0, 4 * EPS, 1.0);
    }
    const fl_vec3 axis[] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3; k++) assert_true(v3_dot(axis[k], v3_normal_to(axis[k])) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(quarter_and_third_turns_are_exact),
                                       cmocka_unit_test(handedness),
                                       cmocka_unit_test(half_angles),
                                       cmocka_unit_test(products_compose),
                                       cmocka_unit_test(matrix_and_back),
                                       cmocka_unit_test(rotation_vectors)};
    return cmocka_run_group_tests_name("quat", tests, NULL, NULL);
}
