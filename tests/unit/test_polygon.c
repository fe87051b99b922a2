/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "support/near.h"
#include "base/pi.h"
#include "base/rng.h"
#include "geom/polygon.h"

enum { MANY = 64 };

static double half_tan_sum(int32_t n, const fl_polygon_side *side)
{
    double sum = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const fl_polygon_side a = side[k], b = side[(k + 1) % n];
        sum += tan(0.5 * atan2(fl_polygon_side_sin(a, b), fl_polygon_side_cos(a, b)));
    }
    return sum;
}

/* A rectangle cut by random lines that leave its centre. */
static int32_t random_polygon(fl_rng *g, fl_vec2 *v, fl_polygon_side *side)
{
    int32_t n = 4;
    fl_polygon_rectangle((fl_vec2){-1.0, -1.0}, (fl_vec2){1.0, 1.0}, v, side);
    for (int k = 0; k < 12; k++) {
        const double t = fl_rng_in(g, 0.0, 2.0 * PI);
        n = fl_polygon_cut(n, v, side, (fl_polygon_side){cos(t), sin(t), fl_rng_in(g, 0.3, 1.3), k});
    }
    return n;
}

static void area_and_centroid_of_a_far_triangle(void **state)
{
    (void)state;
    const fl_vec2 v[3] = {{1e6, 1e6}, {1e6 + 3.0, 1e6}, {1e6, 1e6 + 6.0}};
    const fl_vec2 c = fl_polygon_centroid(3, v);
    assert_true(fl_polygon_area(3, v) == 9.0);
    assert_near(c.x, 1e6 + 1.0, 1e-15);
    assert_near(c.y, 1e6 + 2.0, 1e-15);
    assert_near(fl_polygon_perimeter(3, v), 9.0 + sqrt(45.0), 1e-15);
}

static void cuts_through_corners_leave_no_empty_side(void **state)
{
    (void)state;
    fl_vec2 v[6];
    fl_polygon_side side[6];
    const double r = sqrt(0.5);
    fl_polygon_rectangle((fl_vec2){0.0, 0.0}, (fl_vec2){2.0, 2.0}, v, side);
    assert_int_equal(fl_polygon_cut(4, v, side, (fl_polygon_side){1.0, 0.0, 2.0, 9}), 4); /* along a side */
    assert_int_equal(fl_polygon_cut(4, v, side, (fl_polygon_side){r, r, 2.0 * r * 1.5 + r, 9}),
                     4);                                                               /* touches (2, 2) */
    assert_int_equal(fl_polygon_cut(4, v, side, (fl_polygon_side){r, -r, 0.0, 9}), 3); /* the diagonal */
    assert_true(fl_polygon_area(3, v) == 2.0);
    assert_int_equal(fl_polygon_cut(3, v, side, (fl_polygon_side){0.0, -1.0, -2.0, 9}),
                     0); /* touches one corner */
    fl_polygon_rectangle((fl_vec2){0.0, 0.0}, (fl_vec2){2.0, 2.0}, v, side);
    assert_int_equal(fl_polygon_cut(4, v, side, (fl_polygon_side){1.0, 0.0, -0.5, 9}), 0);
}

/* Each side's corners lie on its line, and the two parts of a cut add up. */
static void two_halves_add_up(void **state)
{
    (void)state;
    for (int i = 0; i < test_times(2000); i++) {
        fl_rng g = fl_rng_of(test_seed(), i, FL_RNG_TEST);
        fl_vec2 v[MANY], w[MANY];
        fl_polygon_side a[MANY], b[MANY];
        int32_t n = random_polygon(&g, v, a), m = n;
        const double all = fl_polygon_area(n, v), t = fl_rng_in(&g, 0.0, 2.0 * PI),
                     c = fl_rng_in(&g, -0.3, 0.3);
        for (int32_t k = 0; k < n; k++) {
            w[k] = v[k];
            b[k] = a[k];
        }
        n = fl_polygon_cut(n, v, a, (fl_polygon_side){cos(t), sin(t), c, 50});
        m = fl_polygon_cut(m, w, b, (fl_polygon_side){-cos(t), -sin(t), -c, 51});
        assert_near_of(fl_polygon_area(n, v) + fl_polygon_area(m, w), all, 4e-15, 4.0);
        for (int32_t k = 0; k < n; k++) {
            assert_near_of(fl_polygon_side_distance(a[k], v[k]), 0.0, 4e-15, 1.0);
            assert_near_of(fl_polygon_side_distance(a[k], v[(k + 1) % n]), 0.0, 4e-15, 1.0);
        }
    }
}

struct shape {
    int32_t n;
    fl_vec2 v[MANY];
    fl_polygon_side side[MANY];
};

/* Until the first side vanishes, A(d) = A - P d + d^2 sum tan(turn / 2). */
static void small_insets_follow_their_law(void **state)
{
    (void)state;
    int whole = 0;
    for (int i = 0; i < test_times(2000); i++) {
        fl_rng g = fl_rng_of(test_seed(), i, FL_RNG_TEST);
        struct shape s;
        double depth;
        const double d = 1e-3;
        s.n = random_polygon(&g, s.v, s.side);
        const int32_t n = s.n;
        const double area = fl_polygon_area(n, s.v), outline = fl_polygon_perimeter(n, s.v),
                     t = half_tan_sum(n, s.side);
        s.n = fl_polygon_inset(n, s.v, s.side, d, &depth);
        if (s.n < n) continue;
        whole++;
        assert_near_of(fl_polygon_area(n, s.v), area - outline * d + d * d * t, 1e-14, 4.0);
    }
    assert_true(whole > test_times(2000) / 4);
}

/* Insets in steps drop the same sides as one inset, and end at the inscribed circle, which no side cuts and
 * which touches three sides, or two opposite ones. */
static void insets_add_up(void **state)
{
    (void)state;
    for (int i = 0; i < test_times(1000); i++) {
        fl_rng g = fl_rng_of(test_seed(), i, FL_RNG_TEST);
        struct shape first, step, once;
        double depth = 0.0, inradius;
        first.n = random_polygon(&g, first.v, first.side);
        once = first;
        assert_int_equal(fl_polygon_inset(once.n, once.v, once.side, INFINITY, &inradius), 0);
        step = first;
        for (int k = 1; step.n; k++) {
            const double d = 0.037 * k;
            once = first;
            once.n = fl_polygon_inset(once.n, once.v, once.side, d, &depth);
            fl_polygon_corners(step.n, step.side, 0.0, step.v);
            step.n = fl_polygon_inset(step.n, step.v, step.side, d, &depth);
            assert_int_equal(step.n, once.n);
            assert_int_equal(step.n == 0, d > inradius);
            for (int32_t e = 0; e < step.n; e++) {
                assert_int_equal(step.side[e].tag, once.side[e].tag);
                assert_near_of(step.v[e].x, once.v[e].x, 1e-12, 1.0);
                assert_near_of(step.v[e].y, once.v[e].y, 1e-12, 1.0);
            }
            assert_true(first.n < MANY && k < 100);
        }
        assert_near(depth, inradius, 1e-12);
        once = first; /* just before the end, the remaining polygon lies about the centre of the circle */
        once.n = fl_polygon_inset(once.n, once.v, once.side, inradius * (1.0 - 1e-9), &depth);
        assert_true(once.n >= 3);
        for (int32_t e = 0; e < first.n; e++)
            assert_true(fl_polygon_side_distance(first.side[e], once.v[0]) <= -inradius * (1.0 - 2e-9));
    }
}

static void inscribed_circles_are_known(void **state)
{
    (void)state;
    fl_vec2 v[MANY];
    fl_polygon_side side[MANY];
    double depth;
    int32_t n = 4;
    fl_polygon_rectangle((fl_vec2){-3.0, 5.0}, (fl_vec2){4.0, 7.0}, v, side);
    assert_int_equal(fl_polygon_inset(4, v, side, INFINITY, &depth), 0);
    assert_near(depth, 1.0, 1e-15);
    fl_polygon_rectangle((fl_vec2){0.0, 0.0}, (fl_vec2){3.0, 4.0}, v,
                         side); /* the 3-4-5 triangle: radius 1 */
    n = fl_polygon_cut(4, v, side, (fl_polygon_side){0.8, 0.6, 2.4, 9});
    assert_int_equal(n, 3);
    assert_int_equal(fl_polygon_inset(n, v, side, 2.0, &depth), 0);
    assert_near(depth, 1.0, 1e-15);
    fl_polygon_rectangle((fl_vec2){0.0, 0.0}, (fl_vec2){3.0, 4.0}, v, side);
    n = fl_polygon_cut(4, v, side, (fl_polygon_side){0.8, 0.6, 2.4, 9});
    assert_int_equal(fl_polygon_inset(n, v, side, 0.5, &depth), 3);
    assert_near(fl_polygon_area(3, v), 1.5, 1e-15); /* a quarter of 6 */
    assert_true(depth == 0.5);
}

/* A square with one corner cut by a side of length e: at angles of 45 degrees it loses 2 d tan(22.5). */
static void a_short_side_vanishes_at_its_own_inset(void **state)
{
    (void)state;
    const double r = sqrt(0.5), e = 0.1, goes = e / (2.0 * tan(PI / 8.0));
    for (int k = 0; k < 2; k++) {
        fl_vec2 v[6];
        fl_polygon_side side[6];
        double depth;
        const double d = goes * (k ? 1.0 + 1e-9 : 1.0 - 1e-9);
        fl_polygon_rectangle((fl_vec2){-1.0, -1.0}, (fl_vec2){1.0, 1.0}, v, side);
        assert_int_equal(fl_polygon_cut(4, v, side, (fl_polygon_side){r, r, sqrt(2.0) - 0.5 * e, 9}), 5);
        assert_int_equal(fl_polygon_inset(5, v, side, d, &depth), k ? 4 : 5);
    }
}

static void outset_undoes_inset(void **state)
{
    (void)state;
    for (int i = 0; i < test_times(1000); i++) {
        fl_rng g = fl_rng_of(test_seed(), i, FL_RNG_TEST);
        fl_vec2 v[MANY], w[MANY];
        fl_polygon_side a[MANY];
        double depth;
        const double d = fl_rng_in(&g, 0.0, 0.2);
        const int32_t n = fl_polygon_inset(random_polygon(&g, v, a), v, a, d, &depth);
        fl_polygon_outset(n, v, d, w);
        fl_polygon_corners(n, a, 0.0, v);
        assert_near_of(fl_polygon_area(n, w), fl_polygon_area(n, v), 1e-9,
                       4.0); /* directions of short sides are less accurate */
    }
}

static void distances_of_squares(void **state)
{
    (void)state;
    const fl_vec2 a[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, b[4] = {{4, 5}, {6, 5}, {6, 7}, {4, 7}},
                  c[4] = {{1, 0}, {2, 0}, {2, 1}, {1, 1}}, d[4] = {{0.9, 0.9}, {2, 0.9}, {2, 2}, {0.9, 2}};
    assert_near(fl_polygon_distance(4, a, 4, b), 5.0, 1e-15);
    assert_true(fl_polygon_is_apart(4, a, 4, b));
    assert_false(fl_polygon_is_apart(4, a, 4, c)); /* they touch */
    assert_false(fl_polygon_is_apart(4, a, 4, d));
    assert_true(fl_polygon_point_distance(4, a, (fl_vec2){0.5, 0.5}) == 0.0);
    assert_near(fl_polygon_point_distance(4, a, (fl_vec2){4.0, 5.0}), 5.0, 1e-15);
    assert_near(fl_polygon_point_distance(4, a, (fl_vec2){0.5, -2.0}), 2.0, 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(area_and_centroid_of_a_far_triangle),
                                       cmocka_unit_test(cuts_through_corners_leave_no_empty_side),
                                       cmocka_unit_test(two_halves_add_up),
                                       cmocka_unit_test(small_insets_follow_their_law),
                                       cmocka_unit_test(insets_add_up),
                                       cmocka_unit_test(inscribed_circles_are_known),
                                       cmocka_unit_test(a_short_side_vanishes_at_its_own_inset),
                                       cmocka_unit_test(outset_undoes_inset),
                                       cmocka_unit_test(distances_of_squares)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
