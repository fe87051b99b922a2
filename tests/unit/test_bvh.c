/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "support/near.h"
#include "base/array.h"
#include "base/rng.h"
#include "broad/bvh.h"

static int ascending(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* A box about a point of the cube [-side, side]^3 whose half sides are 10^u, u in [lo, hi]. */
static fl_aabb random_box(fl_rng *g, double side, double lo, double hi)
{
    fl_vec3 c, h;
    c.x = fl_rng_in(g, -side, side), c.y = fl_rng_in(g, -side, side), c.z = fl_rng_in(g, -side, side);
    h.x = pow(10.0, fl_rng_in(g, lo, hi)), h.y = pow(10.0, fl_rng_in(g, lo, hi));
    h.z = pow(10.0, fl_rng_in(g, lo, hi));
    return (fl_aabb){v3_sub(c, h), v3_add(c, h)};
}

/* The query finds the boxes that a test of every box finds, each once. */
static void compare_with_brute_force(const fl_bvh *t, const fl_aabb *box, int32_t n, fl_aabb q)
{
    int32_t *out = malloc(((size_t)n + 1) * sizeof *out);
    assert_non_null(out);
    const int32_t found = fl_bvh_query(t, box, q, out, n + 1);
    assert_true(found >= 0 && found <= n);
    assert_int_equal(fl_bvh_meets(t, box, q), found > 0);
    qsort(out, (size_t)found, sizeof *out, ascending);
    int32_t at = 0;
    for (int32_t k = 0; k < n; k++) {
        if (!aabb_overlap(box[k], q)) continue;
        assert_true(at < found);
        assert_int_equal(out[at], k);
        at++;
    }
    assert_int_equal(at, found);
    free(out);
}

/* A walk from a point visits every box within a distance once. With a distance that shrinks to the closest
 * box found, it visits the nearest box. */
static void check_walk(const fl_bvh *t, const fl_aabb *box, int32_t n, fl_vec3 x, double within)
{
    int32_t *times = calloc((size_t)n + 1, sizeof *times), visits = 0;
    double nearest = INFINITY, found = INFINITY;
    assert_non_null(times);
    fl_bvh_walk at = fl_bvh_walk_from(t, box, x);
    for (int32_t k; (k = fl_bvh_walk_next(&at, within)) >= 0;) times[k]++;
    for (int32_t k = 0; k < n; k++) {
        const double d2 = aabb_distance2(box[k], x);
        assert_int_equal(times[k], d2 <= within * within);
        nearest = fmin(nearest, d2);
    }
    at = fl_bvh_walk_from(t, box, x);
    for (int32_t k; (k = fl_bvh_walk_next(&at, found)) >= 0; visits++)
        found = fmin(found, sqrt(aabb_distance2(box[k], x)));
    assert_true(n == 0 ? visits == 0 : found == sqrt(nearest));
    free(times);
}

/* Random boxes and their tree. */
typedef struct {
    fl_rng g;
    int32_t n;
    fl_aabb *box;
    fl_bvh tree;
} box_tree;

static box_tree make_random_tree(int64_t seed)
{
    box_tree w = {.g = fl_rng_of(test_seed(), seed, FL_RNG_TEST)};
    fl_err err = {0};
    w.n = (int32_t)fl_rng_in(&w.g, 0.0, 400.0);
    w.box = calloc((size_t)w.n + 1, sizeof *w.box);
    assert_non_null(w.box);
    for (int32_t k = 0; k < w.n; k++) w.box[k] = random_box(&w.g, 10.0, -2.0, 0.5);
    assert_int_equal(fl_bvh_build(&w.tree, w.box, w.n, &err), 0);
    return w;
}

static void free_tree(box_tree *w)
{
    fl_bvh_free(&w->tree);
    free(w->box);
}

static void walks_visit_every_near_box(void **state)
{
    (void)state;
    for (long c = 0; c < test_times(40); c++) {
        box_tree w = make_random_tree(1000 + c);
        for (int k = 0; k < 20; k++) {
            const fl_aabb about = random_box(&w.g, 14.0, -3.0, 1.0);
            check_walk(&w.tree, w.box, w.n, about.lo, k % 2 ? fl_rng_in(&w.g, 0.0, 8.0) : INFINITY);
        }
        free_tree(&w);
    }
}

static void queries_find_what_brute_force_finds(void **state)
{
    (void)state;
    for (long c = 0; c < test_times(40); c++) {
        box_tree w = make_random_tree(c);
        for (int32_t k = 0; k < w.n; k++) compare_with_brute_force(&w.tree, w.box, w.n, w.box[k]);
        for (int k = 0; k < 20; k++)
            compare_with_brute_force(&w.tree, w.box, w.n, random_box(&w.g, 12.0, -3.0, 1.0));
        compare_with_brute_force(&w.tree, w.box, w.n, (fl_aabb){v3(-1e9, -1e9, -1e9), v3(1e9, 1e9, 1e9)});
        compare_with_brute_force(&w.tree, w.box, w.n, aabb_empty());
        free_tree(&w);
    }
}

/* Sizes from 1e-4 to 1e2 m in one domain (H09): no pair is missed, and the tree stays linear in n. */
static void size_ratio_of_a_million(void **state)
{
    enum { N = 3000 };
    fl_aabb *box = calloc(N, sizeof *box);
    fl_bvh t = {0};
    fl_err err = {0};
    fl_rng g = fl_rng_of(test_seed(), 1, FL_RNG_TEST);
    (void)state;
    assert_non_null(box);
    for (int k = 0; k < N; k++)
        box[k] = k % 300 == 0 ? random_box(&g, 100.0, 1.9, 2.0) : random_box(&g, 100.0, -4.0, -3.9);
    for (int k = 1; k < N; k += 3) { /* small boxes that barely touch, so that a pair can be missed */
        if (k % 300 == 299) continue;
        const fl_vec3 side = v3_sub(box[k].hi, box[k].lo);
        box[k + 1] = (fl_aabb){v3(box[k].hi.x, box[k].lo.y, box[k].lo.z),
                               v3_add(v3(box[k].hi.x, box[k].lo.y, box[k].lo.z), side)};
    }
    assert_int_equal(fl_bvh_build(&t, box, N, &err), 0);
    assert_true(t.nodes <= 2 * N + 1);
    for (int k = 0; k < N; k++) compare_with_brute_force(&t, box, N, box[k]);
    fl_bvh_free(&t);
    free(box);
}

static void equal_boxes_and_few(void **state)
{
    fl_aabb box[100];
    fl_bvh t = {0};
    fl_err err = {0};
    (void)state;
    for (int k = 0; k < 100; k++) box[k] = (fl_aabb){v3(1, 2, 3), v3(4, 5, 6)};
    for (int32_t n = 0; n <= 100; n = n < 12 ? n + 1 : n + 22) {
        assert_int_equal(fl_bvh_build(&t, box, n, &err), 0); /* rebuilt in the same tree */
        compare_with_brute_force(&t, box, n, (fl_aabb){v3(4, 5, 6), v3(7, 7, 7)}); /* touching boxes count */
        compare_with_brute_force(&t, box, n, (fl_aabb){v3(4.1, 5, 6), v3(7, 7, 7)});
    }
    fl_bvh_free(&t);
    fl_bvh_free(&t); /* a zeroed tree */
}

static void a_short_output_reports_the_size_needed(void **state)
{
    fl_aabb box[50];
    fl_bvh t = {0};
    fl_err err = {0};
    int32_t out[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
    (void)state;
    for (int k = 0; k < 50; k++) box[k] = (fl_aabb){v3(k, 0, 0), v3(k + 1, 1, 1)};
    assert_int_equal(fl_bvh_build(&t, box, 50, &err), 0);
    assert_int_equal(fl_bvh_query(&t, box, (fl_aabb){v3(0, 0, 0), v3(50, 1, 1)}, out, 5), 50);
    for (int k = 0; k < 5; k++) assert_true(out[k] >= 0);
    for (int k = 5; k < 8; k++) assert_int_equal(out[k], -1);
    assert_int_equal(fl_bvh_query(&t, box, (fl_aabb){v3(0, 0, 0), v3(50, 1, 1)}, NULL, 0), 50);
    fl_bvh_free(&t);
}

static void allocation_failure_is_reported(void **state)
{
    fl_aabb box[50];
    (void)state;
    for (int k = 0; k < 50; k++) box[k] = (fl_aabb){v3(k, 0, 0), v3(k + 1, 1, 1)};
    for (int64_t after = 0; after < 2; after++) {
        fl_bvh t = {0};
        fl_err err = {0};
        fl_alloc_fail_after(after);
        const int rc = fl_bvh_build(&t, box, 50, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(rc, -1);
        assert_int_equal(err.code, FL_SYSTEM);
        fl_bvh_free(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(queries_find_what_brute_force_finds),
        cmocka_unit_test(size_ratio_of_a_million),
        cmocka_unit_test(equal_boxes_and_few),
        cmocka_unit_test(a_short_output_reports_the_size_needed),
        cmocka_unit_test(allocation_failure_is_reported),
        cmocka_unit_test(walks_visit_every_near_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
