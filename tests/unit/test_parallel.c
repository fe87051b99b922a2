/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include <omp.h>
#include "base/parallel.h"
#include "base/rng.h"
#include "support/near.h"

enum { N = 100000 };

static void sums_have_the_defined_order(void **state)
{
    const double x[] = {1.0, 2.0, 4.0};
    (void)state;
    assert_true(fl_parallel_sum(x, 0) == 0.0);
    assert_true(fl_parallel_sum(x, 1) == 1.0);
    assert_true(fl_parallel_sum(x, 3) == 7.0);
}

/* The order of summation is set by the data: the bits are those of the definition, for lengths around the
 * block size and any number of threads. */
static void sums_do_not_depend_on_the_threads(void **state)
{
    static double x[N];
    static const int64_t length[] = {1, 1023, 1024, 1025, 2048, 5000, N};
    fl_rng g = fl_rng_of(test_seed(), 0, FL_RNG_TEST);
    (void)state;
    for (int k = 0; k < N; k++) x[k] = fl_rng_normal(&g) * pow(10.0, fl_rng_in(&g, -8.0, 8.0));
    for (size_t i = 0; i < sizeof length / sizeof *length; i++) {
        double total = 0.0;
        for (int64_t b = 0; b < length[i]; b += 1024) {
            double part = 0.0;
            for (int64_t k = b; k < b + 1024 && k < length[i]; k++) part += x[k];
            total += part;
        }
        for (int threads = 1; threads <= 8; threads++) {
            omp_set_num_threads(threads);
            const double sum = fl_parallel_sum(x, length[i]);
            assert_memory_equal(&sum, &total, sizeof sum);
        }
    }
}

/* A change of the last bit, of the first, one byte more, another order: each gives another hash. */
static void hash_sees_every_bit(void **state)
{
    unsigned char buf[67];
    (void)state;
    for (size_t k = 0; k < sizeof buf; k++) buf[k] = (unsigned char)(7 * k);
    const uint64_t h = fl_hash(FL_HASH_START, buf, sizeof buf);
    assert_true(h == fl_hash(FL_HASH_START, buf, sizeof buf));
    assert_true(h != fl_hash(FL_HASH_START, buf, sizeof buf - 1));
    for (size_t bit = 0; bit < 8 * sizeof buf; bit++) {
        buf[bit / 8] = (unsigned char)(buf[bit / 8] ^ 1u << bit % 8);
        assert_true(h != fl_hash(FL_HASH_START, buf, sizeof buf));
        buf[bit / 8] = (unsigned char)(buf[bit / 8] ^ 1u << bit % 8);
    }
    assert_true(fl_hash(fl_hash(FL_HASH_START, "aaaaaaaa", 8), "bbbbbbbb", 8) !=
                fl_hash(fl_hash(FL_HASH_START, "bbbbbbbb", 8), "aaaaaaaa", 8));
    /* whole words in pieces hash as one block */
    assert_true(fl_hash(fl_hash(FL_HASH_START, buf, 16), buf + 16, 24) == fl_hash(FL_HASH_START, buf, 40));
    assert_true(fl_hash(FL_HASH_START, buf, 0) == FL_HASH_START);
}

/* Doubles differ in their high bits; both halves of the hash must depend on them. */
static void hash_mixes_both_halves(void **state)
{
    uint64_t low = 0, high = 0;
    (void)state;
    for (int k = 0; k < 64; k++) {
        double x[2] = {1.0, 2.0};
        uint64_t bits;
        memcpy(&bits, &x[0], sizeof bits);
        bits ^= UINT64_C(1) << k;
        memcpy(&x[0], &bits, sizeof bits);
        const double plain[2] = {1.0, 2.0};
        const uint64_t d = fl_hash(FL_HASH_START, x, sizeof x) ^ fl_hash(FL_HASH_START, plain, sizeof plain);
        assert_true(d != 0);
        low += (uint32_t)d != 0;
        high += (uint32_t)(d >> 32) != 0;
    }
    assert_true(low == 64 && high == 64);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_have_the_defined_order), cmocka_unit_test(sums_do_not_depend_on_the_threads),
        cmocka_unit_test(hash_sees_every_bit), cmocka_unit_test(hash_mixes_both_halves)};
    return cmocka_run_group_tests_name("parallel", tests, NULL, NULL);
}
