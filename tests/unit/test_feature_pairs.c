/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A list of feature pairs covers a chosen margin of motion. The pairs it omits change no bit of the
 * result. */
#include <math.h>
#include <string.h>
#include "base/pi.h"
#include "base/rng.h"
#include "patch/feature_pairs.h"
#include "patch/patch_points.h"
#include "narrow/overlap.h"
#include "support/near.h"
#include "support/shapes.h"

#define RADIUS 0.05
#define R (2.0 * RADIUS)

static uint64_t hash_double(uint64_t sum, double x)
{
    uint64_t b;
    memcpy(&b, &x, sizeof b);
    return (sum ^ b) * 0x100000001b3u;
}

/* Hash of the patch points of a, at x with rotation q, over b. */
static uint64_t hash_points(fl_patch_points *w, const fl_poly *a, const fl_poly *b, fl_quat q, fl_vec3 x,
                            fl_feature_pairs *l)
{
    const fl_penetration separate = {0};
    uint64_t sum = 0;
    assert_int_equal(fl_patch_points_transform(w, a, q_matrix(q), x), 0);
    assert_int_equal(fl_patch_points_find(w, a, b, RADIUS, RADIUS, v3(1, 0, 0), &separate, l), 0);
    for (int32_t k = 0; k < w->n; k++) {
        const fl_patch_point *p = &w->point[k];
        sum = hash_double(hash_double(hash_double(hash_double(sum, p->u), p->du), p->p.x), p->n.y);
    }
    return sum;
}

/* Two boxes side by side, one of which slides and turns, slowly at first; and two long boxes, whose ends move
 * much farther than the contact. */
static void omitted_pairs_change_no_bit(void **state)
{
    (void)state;
    for (int far = 0; far < 2; far++) {
        fl_patch_points w = {0};
        fl_poly a = {0}, b = {0};
        fl_feature_pairs kept = {0};
        fl_err err = {0};
        int lists = 0, points = 0;
        assert_int_equal(fl_poly_box(&a, v3(0.5, far ? 1.2 : 0.6, 0.2), &err) ||
                             fl_poly_box(&b, v3(0.5, far ? 30.0 : 0.7, 0.25), &err),
                         0);
        double y = -1.0;
        for (int k = 0; k < 400; k++) {
            const fl_vec3 x = v3(1.0 + 0.9 * R + 0.005 * sin(0.1 * k), y,
                                 far ? 0.3 * cos(0.005 * k) : 0.01 * cos(0.05 * k));
            const fl_quat q = q_of_vector(
                v3((far ? 2e-3 : 1e-3) * sin(0.3 * k), 1e-3 * cos(0.2 * k), 2e-3 * sin(0.02 * k)));
            fl_feature_pairs fresh = {0};
            y += 2e-5 * k;
            const uint64_t once = hash_points(&w, &a, &b, q, x, &fresh);
            assert_true(hash_points(&w, &a, &b, q, x, &kept) == once);
            fl_feature_pairs_free(&fresh);
            lists += kept.uses == 1;
            points += w.n;
        }
        assert_in_range(lists, 10, 200);
        assert_true(points > 4000);
        fl_feature_pairs_free(&kept);
        fl_patch_points_free(&w);
        fl_poly_free(&a), fl_poly_free(&b);
    }
}

/* A feature over the middle of a face needs only the face's plane: no side of the face can be close. */
static void distant_sides_are_not_listed(void **state)
{
    (void)state;
    const fl_penetration separate = {0};
    fl_patch_points w = {0};
    fl_poly a = {0}, b = {0};
    fl_feature_pairs l = {0};
    fl_err err = {0};
    assert_int_equal(fl_poly_box(&a, v3(0.5, 0.6, 0.2), &err) || fl_poly_box(&b, v3(3, 3, 0.3), &err), 0);
    const fl_vec3 x = v3(0.1, 0.2, 0.5 + 0.9 * R);
    assert_int_equal(fl_patch_points_transform(&w, &a, q_matrix(q_of_vector(v3(1e-3, 0, 0.3))), x), 0);
    assert_int_equal(fl_patch_points_find(&w, &a, &b, RADIUS, RADIUS, v3(0, 0, 1), &separate, &l), 0);
    assert_true(w.n > 10 && l.n > 8);
    assert_int_equal(l.planes[0], 1);
    fl_feature_pairs_free(&l);
    fl_patch_points_free(&w);
    fl_poly_free(&a), fl_poly_free(&b);
}

/* At a steady motion v between evaluations a list lasts margin/(2 v) of them, half of the margin being for
 * rotations. The margin tends to sqrt(4 R 2 v), between its bounds. */
static void the_margin_follows_the_motion(void **state)
{
    (void)state;
    static const double SPEED[] = {1e-6, 1e-5, 1e-4, 5e-4, 2e-3, 0.05}; /* relative to R */
    fl_patch_points w = {0};
    fl_poly a = {0}, b = {0};
    fl_err err = {0};
    assert_int_equal(fl_poly_box(&a, v3(0.5, 0.5, 0.2), &err) || fl_poly_box(&b, v3(0.5, 9.0, 0.2), &err), 0);
    for (size_t s = 0; s < sizeof SPEED / sizeof *SPEED; s++) {
        const double v = SPEED[s] * R, best = fmin(fmax(sqrt(8.0 * R * v), 0.01 * R), 0.3 * R);
        fl_feature_pairs l = {0};
        double margin = 0.0;
        int found = 0;
        assert_true(fl_feature_pairs_margin(&l, R) > 0.0);
        for (int lists = 0, k = 0; lists < 8 && k < 100000; k++) {
            const double y = v * k - 4.0;
            hash_points(&w, &a, &b, (fl_quat){1, 0, 0, 0}, v3(1.0 + 0.9 * R, y, 0), &l);
            lists += l.uses == 1;
            margin = l.margin, found = w.n;
            if (v * k > 8.0) break;
        }
        assert_true(found > 0);
        assert_true(margin > 0.7 * best && margin < 1.4 * best);
        fl_feature_pairs_free(&l);
    }
    fl_patch_points_free(&w);
    fl_poly_free(&a), fl_poly_free(&b);
}

/* Sum of u. */
static double sum_of_u(const fl_patch_points *w)
{
    double sum = 0.0;
    for (int32_t k = 0; k < w->n; k++) sum += w->point[k].u;
    return sum;
}

/* A box on the cap of a prism with many corners, whose indices need 32 bits: the sum equals that on a prism
 * of four corners. */
static void many_corners_match_few_corners(void **state)
{
    (void)state;
    enum { MANY = 4200 };
    static fl_vec3 xy[MANY];
    const fl_vec3 square[4] = {{2, -2, 0}, {2, 2, 0}, {-2, 2, 0}, {-2, -2, 0}};
    const fl_quat q = q_of_vector(v3(1e-3, -2e-3, 0.7));
    fl_patch_points w = {0};
    fl_poly a = {0}, few = {0}, many = {0};
    fl_feature_pairs l = {0}, m = {0};
    fl_err err = {0};
    for (int k = 0; k < MANY; k++) {
        const double t = 2.0 * PI * k / MANY;
        xy[k] = v3(2.0 * cos(t), 2.0 * sin(t), 0);
    }
    assert_int_equal(fl_poly_box(&a, v3(0.5, 0.6, 0.2), &err) ||
                         fl_poly_prism(&few, 4, square, -1, 0, &err) ||
                         fl_poly_prism(&many, MANY, xy, -1, 0, &err),
                     0);
    const fl_vec3 x = v3(0.1, 0.2, 0.2 + 0.9 * R), up = v3(0, 0, 1);
    const fl_penetration separate = {0};
    assert_int_equal(fl_patch_points_transform(&w, &a, q_matrix(q), x), 0);
    assert_int_equal(fl_patch_points_find(&w, &a, &few, RADIUS, RADIUS, up, &separate, &l), 0);
    const double u = sum_of_u(&w);
    const int32_t points = w.n;
    assert_int_equal(fl_patch_points_find(&w, &a, &many, RADIUS, RADIUS, up, &separate, &m), 0);
    assert_true(u > 0.0 && !l.width && m.width);
    assert_near(sum_of_u(&w), u, 1e-12);
    assert_int_equal(w.n, points);
    assert_true(fl_feature_pairs_bytes(&l) < 3000.0);
    fl_feature_pairs_free(&l), fl_feature_pairs_free(&m);
    fl_patch_points_free(&w);
    fl_poly_free(&a), fl_poly_free(&few), fl_poly_free(&many);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(omitted_pairs_change_no_bit), cmocka_unit_test(distant_sides_are_not_listed),
        cmocka_unit_test(the_margin_follows_the_motion), cmocka_unit_test(many_corners_match_few_corners)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
