/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include "support/near.h"
#include "base/array.h"
#include "base/rng.h"
#include "broad/pairs.h"

static fl_aabb random_box(fl_rng *g, double side, double lo, double hi)
{
    fl_vec3 c, h;
    c.x = fl_rng_in(g, -side, side), c.y = fl_rng_in(g, -side, side), c.z = fl_rng_in(g, -side, side);
    h.x = pow(10.0, fl_rng_in(g, lo, hi)), h.y = pow(10.0, fl_rng_in(g, lo, hi));
    h.z = pow(10.0, fl_rng_in(g, lo, hi));
    return (fl_aabb){v3_sub(c, h), v3_add(c, h)};
}

/* n moving boxes, then `held` fixed ones, then `wide` half-spaces. */
static fl_aabb *make_boxes(fl_rng *g, int32_t n, int32_t fixed, int32_t wide)
{
    fl_aabb *box = calloc((size_t)(n + fixed + wide) + 1, sizeof *box);
    assert_non_null(box);
    for (int32_t k = 0; k < n + fixed; k++) box[k] = random_box(g, 10.0, -4.0, k % 50 == 0 ? 2.0 : 0.3);
    for (int32_t k = n + fixed; k < n + fixed + wide; k++) {
        box[k] = (fl_aabb){v3(-INFINITY, -INFINITY, -INFINITY), v3(INFINITY, INFINITY, INFINITY)};
        if (k % 2) box[k].hi.x = -5.0;
        else box[k].lo.z = 5.0;
    }
    return box;
}

/* All pairs (i, j), i < n, i < j, whose boxes meet, in order. */
static void compare_with_brute_force(const fl_pairs *p, const fl_aabb *box, int32_t n, int32_t total)
{
    int64_t at = 0;
    for (int32_t i = 0; i < n; i++) {
        assert_true(p->first[i] == at);
        for (int32_t j = i + 1; j < total; j++) {
            if (!aabb_overlap(box[i], box[j])) continue;
            assert_true(at < p->first[n]);
            assert_int_equal(p->partner[at], j);
            at++;
        }
    }
    assert_true(p->first[n] == at);
}

static void pairs_are_those_of_brute_force(void **state)
{
    fl_pairs p = {0};
    (void)state;
    for (long c = 0; c < test_times(30); c++) {
        fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
        fl_err err = {0};
        const int32_t n = (int32_t)fl_rng_in(&g, 0, 300), fixed = (int32_t)fl_rng_in(&g, 0, 40),
                      wide = (int32_t)fl_rng_in(&g, 0, 6);
        fl_aabb *box = make_boxes(&g, n, fixed, wide);
        assert_int_equal(fl_pairs_find(&p, box, n, n + fixed + wide, wide, &err),
                         0); /* the lists are used again */
        compare_with_brute_force(&p, box, n, n + fixed + wide);
        free(box);
    }
    fl_pairs_free(&p);
    fl_pairs_free(&p);
}

/* Cleared lists are found again, with the same memory and without it. */
static void cleared_pairs_are_found_again(void **state)
{
    (void)state;
    fl_rng g = fl_rng_of(test_seed(), 7, FL_RNG_TEST);
    fl_aabb *box = make_boxes(&g, 200, 10, 1);
    uint8_t away[200] = {[3] = 1, [150] = 1};
    fl_pairs p = {.period = v3(40, 0, 0), .absent = away};
    fl_err err = {0};
    assert_int_equal(fl_pairs_find(&p, box, 200, 211, 1, &err), 0);
    const int64_t n = p.first[200];
    int32_t *partner = malloc((size_t)n * sizeof *partner);
    assert_non_null(partner);
    memcpy(partner, p.partner, (size_t)n * sizeof *partner);
    fl_pairs_clear(&p);
    fl_pairs_clear(&p);
    assert_true(!p.first && !p.partner && !p.image && !p.tree.node && p.absent == away);
    assert_near(p.period.x, 40.0, 0.0);
    assert_int_equal(fl_pairs_find(&p, box, 200, 211, 1, &err), 0);
    assert_true(p.first[200] == n);
    assert_memory_equal(p.partner, partner, (size_t)n * sizeof *partner);
    fl_pairs_free(&p);
    assert_null(p.absent);
    free(partner), free(box);
}

static void lists_do_not_depend_on_the_threads(void **state)
{
    const int32_t n = 1500, fixed = 20, wide = 2;
    const int threads[] = {1, 2, 3, 8};
    fl_rng g = fl_rng_of(test_seed(), 1, FL_RNG_TEST);
    fl_aabb *box = make_boxes(&g, n, fixed, wide);
    fl_pairs one = {0};
    const int before = omp_get_max_threads();
    (void)state;
    for (int k = 0; k < 4; k++) {
        fl_pairs p = {0};
        fl_err err = {0};
        omp_set_num_threads(threads[k]);
        assert_int_equal(fl_pairs_find(&p, box, n, n + fixed + wide, wide, &err), 0);
        if (k == 0) {
            compare_with_brute_force(&p, box, n, n + fixed + wide);
            one = p;
            continue;
        }
        assert_memory_equal(p.first, one.first, ((size_t)n + 1) * sizeof *p.first);
        assert_memory_equal(p.partner, one.partner, (size_t)one.first[n] * sizeof *p.partner);
        fl_pairs_free(&p);
    }
    omp_set_num_threads(before);
    fl_pairs_free(&one);
    free(box);
}

/* A large body and thousands of bodies a million times smaller in one domain: no known pair is missed
 * (H09). */
static void no_pair_is_missed_at_a_size_ratio_of_a_million(void **state)
{
    enum { PAIRS = 2000 };
    const int32_t n = 2 * PAIRS + 1;
    fl_aabb *box = calloc((size_t)n, sizeof *box);
    fl_rng g = fl_rng_of(test_seed(), 2, FL_RNG_TEST);
    fl_pairs p = {0};
    fl_err err = {0};
    (void)state;
    assert_non_null(box);
    box[0] = (fl_aabb){v3(-100, -100, -100), v3(100, 100, 100)};
    for (int32_t k = 1; k < n; k += 2) { /* on its six faces, in pairs that overlap by a tenth */
        fl_vec3 c = v3(fl_rng_in(&g, -99, 99), fl_rng_in(&g, -99, 99), 100.0);
        if (k % 3 == 1) c = v3(c.y, -c.z, c.x);
        if (k % 3 == 2) c = v3(c.z, c.x, c.y);
        box[k] = aabb_grow((fl_aabb){c, c}, 1e-4);
        c.x += 1.8e-4;
        box[k + 1] = aabb_grow((fl_aabb){c, c}, 1e-4);
    }
    assert_int_equal(fl_pairs_find(&p, box, n, n, 0, &err), 0);
    for (int32_t k = 1; k < n; k += 2) {
        int big = 0, small = 0;
        for (int64_t c = p.first[0]; c < p.first[1]; c++) big += p.partner[c] == k;
        for (int64_t c = p.first[k]; c < p.first[k + 1]; c++) small += p.partner[c] == k + 1;
        assert_int_equal(big, 1);
        assert_int_equal(small, 1);
    }
    compare_with_brute_force(&p, box, n, n);
    fl_pairs_free(&p);
    free(box);
}

static void allocation_failure_is_reported(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 3, FL_RNG_TEST);
    fl_aabb *box = make_boxes(&g, 200, 5, 1);
    int done = 0;
    (void)state;
    for (int64_t after = 0; !done && after < 100; after++) {
        fl_pairs p = {0};
        fl_err err = {0};
        fl_alloc_fail_after(after);
        const int rc = fl_pairs_find(&p, box, 200, 206, 1, &err);
        const int64_t refused = fl_alloc_refused();
        fl_alloc_fail_after(-1);
        done = rc == 0;
        assert_int_equal(done, refused == 0);
        if (!done) assert_int_equal(err.code, FL_SYSTEM);
        fl_pairs_free(&p);
    }
    assert_true(done);
    free(box);
}

/* The same with periodic images: every pair of images in reach, by brute force over more images than can
 * touch. */
static void periodic_images_are_found(void **state)
{
    fl_pairs p = {0};
    (void)state;
    for (long c = 0; c < test_times(30); c++) {
        fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
        fl_err err = {0};
        const int32_t n = (int32_t)fl_rng_in(&g, 0, 100), fixed = (int32_t)fl_rng_in(&g, 0, 10),
                      total = n + fixed;
        const int32_t which = (int32_t)fl_rng_in(&g, 1, 8);
        int64_t at = 0;
        p.period = v3(which & 1 ? 20.0 : 0, which & 2 ? 23.0 : 0, which & 4 ? 21.0 : 0);
        fl_aabb *box = calloc((size_t)total + 1, sizeof *box);
        assert_non_null(box);
        for (int32_t k = 0; k < total; k++) box[k] = random_box(&g, 10.0, -4.0, 0.5);
        assert_int_equal(fl_pairs_find(&p, box, n, total, 0, &err), 0);
        for (int32_t i = 0; i < n; i++) {
            for (int32_t j = i + 1; j < total; j++) {
                for (int e = 0; e < 125; e++) {
                    const int x = e / 25 - 2, y = e / 5 % 5 - 2, z = e % 5 - 2;
                    const fl_vec3 way = v3(x * p.period.x, y * p.period.y, z * p.period.z);
                    const fl_aabb q = {v3_sub(box[i].lo, way), v3_sub(box[i].hi, way)};
                    if ((!(which & 1) && x) || (!(which & 2) && y) || (!(which & 4) && z)) continue;
                    if (!aabb_overlap(q, box[j])) continue;
                    assert_true(at < p.first[i + 1]);
                    assert_int_equal(p.partner[at], j);
                    assert_int_equal(fl_pairs_image_shift(p.image[at], 0), x);
                    assert_int_equal(fl_pairs_image_shift(p.image[at], 1), y);
                    assert_int_equal(fl_pairs_image_shift(p.image[at], 2), z);
                    at++;
                }
            }
            assert_true(p.first[i + 1] == at);
        }
        free(box);
    }
    fl_pairs_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_are_those_of_brute_force),
        cmocka_unit_test(periodic_images_are_found),
        cmocka_unit_test(cleared_pairs_are_found_again),
        cmocka_unit_test(lists_do_not_depend_on_the_threads),
        cmocka_unit_test(no_pair_is_missed_at_a_size_ratio_of_a_million),
        cmocka_unit_test(allocation_failure_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
