/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/rng.h"
#include "support/near.h"

static void expect_words(fl_rng g, const uint32_t *word)
{
    for (int k = 0; k < 2; k++)
        assert_true(fl_rng_u64(&g) == ((uint64_t)word[2 * k] << 32 | word[2 * k + 1]));
}

/* The known answers of Philox4x32-10 distributed with Random123 (Salmon et al. 2011). */
static void philox_known_answers(void **state)
{
    static const uint32_t zero[] = {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8};
    static const uint32_t ones[] = {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd};
    static const uint32_t pi[] = {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1};
    const uint32_t m = 0xffffffff;
    (void)state;
    expect_words(fl_rng_of(0, 0, 0), zero);
    expect_words((fl_rng){.key = {m, m}, .ctr = {m, m, m, m}}, ones);
    expect_words(
        (fl_rng){.key = {0xa4093822, 0x299f31d0}, .ctr = {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}},
        pi);
}

/* Seed, entity and purpose each start their own sequence; equal values of the three start the same one. */
static void streams_differ(void **state)
{
    (void)state;
    fl_rng a = fl_rng_of(7, 1, FL_RNG_SITE);
    const uint64_t first = fl_rng_u64(&a);
    fl_rng other[] = {fl_rng_of(8, 1, FL_RNG_SITE),  fl_rng_of(7 + (UINT64_C(1) << 32), 1, FL_RNG_SITE),
                      fl_rng_of(7, 2, FL_RNG_SITE),  fl_rng_of(7, 1 + (INT64_C(1) << 32), FL_RNG_SITE),
                      fl_rng_of(7, -1, FL_RNG_SITE), fl_rng_of(7, 1, FL_RNG_SIZE)};
    for (size_t k = 0; k < sizeof other / sizeof *other; k++) assert_true(fl_rng_u64(&other[k]) != first);
    a = fl_rng_of(7, 1, FL_RNG_SITE);
    assert_true(fl_rng_u64(&a) == first);
    for (int k = 0; k < 100; k++) assert_true(fl_rng_u64(&a) != first);
}

/* Mean, variance and correlation of neighbours of n numbers. Their standard errors for uniforms are 1/sqrt(12
 * n), 1/sqrt(180 n), 1/(12 sqrt n); five of them are allowed: exceeded once in 1.7 million seeds. */
static void uniform_moments(void **state)
{
    enum { N = 200000 };
    double s = 0.0, s2 = 0.0, correlation = 0.0, last = 0.5, smallest = 1.0, largest = 0.0;
    fl_rng g = fl_rng_of(test_seed(), 0, FL_RNG_TEST);
    (void)state;
    for (int k = 0; k < N; k++) {
        const double x = fl_rng_unit(&g);
        assert_true(x >= 0.0 && x < 1.0 && floor(x * 0x1p53) == x * 0x1p53);
        s += x - 0.5;
        s2 += (x - 0.5) * (x - 0.5);
        correlation += (x - 0.5) * (last - 0.5);
        last = x;
        smallest = fmin(smallest, x);
        largest = fmax(largest, x);
    }
    assert_near_of(s / N, 0.0, 5.0, 1.0 / sqrt(12.0 * N));
    assert_near_of(s2 / N, 1.0 / 12.0, 5.0, 1.0 / sqrt(180.0 * N));
    assert_near_of(correlation / N, 0.0, 5.0, 1.0 / (12.0 * sqrt(N)));
    assert_true(smallest < 20.0 / N && largest > 1.0 - 20.0 / N);
    for (int k = 0; k < 1000; k++) {
        const double x = fl_rng_in(&g, -3.0, 5.0);
        assert_true(x >= -3.0 && x <= 5.0);
    }
}

/* Moments 1 to 4 of the normal are 0, 1, 0, 3, with standard errors sqrt(1, 2, 15, 96)/sqrt n. */
static void normal_moments(void **state)
{
    enum { N = 200000 };
    static const double mean[] = {0.0, 1.0, 0.0, 3.0}, var[] = {1.0, 2.0, 15.0, 96.0};
    double m[4] = {0};
    fl_rng g = fl_rng_of(test_seed(), 1, FL_RNG_TEST);
    (void)state;
    for (int k = 0; k < N; k++) {
        const double x = fl_rng_normal(&g);
        double p = 1.0;
        for (int i = 0; i < 4; i++) m[i] += p *= x;
    }
    for (int i = 0; i < 4; i++) assert_near_of(m[i] / N, mean[i], 5.0, sqrt(var[i] / N));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(philox_known_answers),
                                       cmocka_unit_test(streams_differ), cmocka_unit_test(uniform_moments),
                                       cmocka_unit_test(normal_moments)};
    return cmocka_run_group_tests_name("rng", tests, NULL, NULL);
}
