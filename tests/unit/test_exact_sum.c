/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/rng.h"
#include "stat/descriptive_stats.h"
#include "stat/exact_sum.h"
#include "support/near.h"

static fl_err err;

static void add_term(fl_exact_sum *s, double x) { assert_int_equal(fl_exact_add(s, x, &err), 0); }

static const char *text_of(const fl_exact_sum *s)
{
    static char text[4000];
    FILE *f = fmemopen(text, sizeof text, "w");
    assert_non_null(f);
    fl_exact_print(f, s);
    fclose(f);
    return text;
}

static void known_sums(void **state)
{
    fl_exact_sum s = {0};
    (void)state;
    assert_true(fl_exact_value(&s) == 0.0);
    assert_string_equal(text_of(&s), "0");
    add_term(&s, 1e100);
    add_term(&s, 1.0);
    add_term(&s, -1e100);
    assert_true(fl_exact_value(&s) == 1.0);
    assert_string_equal(text_of(&s), "0x1p0");
    add_term(&s, 4.9e-324);
    /* 2^1074 + 1 of the smallest: 1074 = 4 * 268 + 2 */
    assert_int_equal(strlen(text_of(&s)), strlen("0x") + 269 + strlen("p-1074"));
    assert_int_equal(strspn(text_of(&s) + 3, "0"), 267);
    assert_string_equal(text_of(&s) + 270, "1p-1074");
    assert_true(fl_exact_value(&s) == 1.0);
    add_term(&s, -1.0);
    assert_true(fl_exact_value(&s) == 4.9e-324);
    add_term(&s, -4.9e-324);
    assert_string_equal(text_of(&s), "0");
    /* Ties round to even, and a much smaller bit decides them. */
    add_term(&s, 1.0);
    add_term(&s, DBL_EPSILON / 2);
    assert_true(fl_exact_value(&s) == 1.0);
    add_term(&s, 1e-300);
    assert_true(fl_exact_value(&s) == 1.0 + DBL_EPSILON);
    add_term(&s, -2e-300);
    assert_true(fl_exact_value(&s) == 1.0);
    fl_exact_free(&s);
    for (int k = 0; k < 3; k++) add_term(&s, DBL_MAX);
    assert_true(isinf(fl_exact_value(&s)));
    for (int k = 0; k < 2; k++) add_term(&s, -DBL_MAX);
    assert_true(fl_exact_value(&s) == DBL_MAX);
    fl_exact_free(&s);
    assert_null(s.word);
    fl_exact_free(&s);
}

/* Any order, any split, and a round trip through text give the same sum, 0 if each term has its opposite. */
static void order_is_free(void **state)
{
    enum { N = 200, PILES = 5 };
    (void)state;
    for (long k = 0; k < test_times(200); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const double wide = fl_rng_in(&g, 0.0, 300.0);
        double x[N];
        char first[4000] = "";
        for (int i = 0; i < N; i++) {
            x[i] = fl_rng_normal(&g) * pow(10.0, fl_rng_in(&g, -wide, wide));
            if (i >= N / 2 && k % 2) x[i] = -x[i - N / 2];
        }
        for (int again = 0; again < 4; again++) {
            fl_exact_sum pile[PILES] = {{0}}, all = {0};
            for (int i = N - 1; i > 0 && again; i--) {
                const int j = (int)fl_rng_in(&g, 0.0, i + 1.0);
                const double swap = x[i];
                x[i] = x[j];
                x[j] = swap;
            }
            for (int i = 0; i < N; i++) add_term(&pile[(int)fl_rng_in(&g, 0.0, PILES)], x[i]);
            for (int i = 0; i < PILES; i++) {
                const int j = (i + again) % PILES;
                if (again == 2) assert_int_equal(fl_exact_read(&all, text_of(&pile[j]), &err), 0);
                else assert_int_equal(fl_exact_merge(&all, &pile[j], &err), 0);
            }
            if (again == 0) strcpy(first, text_of(&all));
            if (strcmp(text_of(&all), first) != 0) {
                print_error("seed %llu case %ld\n", (unsigned long long)test_seed(), k);
                fail();
            }
            if (k % 2) assert_string_equal(first, "0");
            for (int i = 0; i < PILES; i++) fl_exact_free(&pile[i]);
            fl_exact_free(&all);
        }
    }
}

/* Sums of few terms of similar size fit into long double. */
static void nearest_value(void **state)
{
    (void)state;
    for (long k = 0; k < test_times(20000); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const double a = ldexp(fl_rng_in(&g, -1.0, 1.0), (int)fl_rng_in(&g, -5.0, 5.0)),
                     b = ldexp(fl_rng_in(&g, -1.0, 1.0), (int)fl_rng_in(&g, -5.0, 5.0));
        fl_exact_sum s = {0};
        add_term(&s, a);
        add_term(&s, b);
        /* The rounded sum of two doubles is the nearest double. */
        assert_true(fl_exact_value(&s) == a + b);
        fl_exact_free(&s);
    }
}

static void compute_moments(int32_t n, const double *x, const double *w, double out[4])
{
    fl_exact_sum s[5] = {{0}};
    for (int32_t k = 0; k < n; k++) assert_int_equal(fl_exact_add_powers(s, w ? w[k] : 1.0, x[k], &err), 0);
    fl_exact_moments(s, out);
    for (int k = 0; k < 5; k++) fl_exact_free(&s[k]);
}

static void moments_are_exact(void **state)
{
    enum { N = 500 };
    double x[N] = {0}, w[N], out[4];
    (void)state;
    compute_moments(0, x, NULL, out);
    for (int k = 0; k < 4; k++) assert_true(isnan(out[k]));
    /* 0 and 1, weighted three to one: p = 1/4 */
    compute_moments(2, (double[]){0.0, 1.0}, (double[]){3.0, 1.0}, out);
    assert_near(out[0], 0.25, 0.0);
    assert_near(out[1], sqrt(3.0) / 4.0, 1e-16);
    assert_near(out[2], 2.0 / sqrt(3.0), 4e-16);
    assert_near(out[3], -2.0 / 3.0, 1e-15);
    /* A small spread on a large mean, where sums of powers in doubles lose all digits. */
    compute_moments(4, (double[]){1e15 + 1, 1e15 - 1, 1e15 + 1, 1e15 - 1}, NULL, out);
    assert_true(out[0] == 1e15 && out[1] == 1.0 && out[2] == 0.0 && out[3] == -2.0);
    compute_moments(3, (double[]){0.1, 0.1, 0.1}, (double[]){0.1, 0.3, 0.7}, out);
    assert_true(out[0] == 0.1 && out[1] == 0.0 && isnan(out[2]) && isnan(out[3]));
    /* The ends of the allowed range. */
    compute_moments(2, (double[]){1e100, -1e100}, (double[]){1e100, 1e100}, out);
    assert_true(out[0] == 0.0 && out[2] == 0.0 && out[3] == -2.0);
    assert_near(out[1], 1e100, DBL_EPSILON);
    compute_moments(2, (double[]){4.9e-324, -4.9e-324}, (double[]){4.9e-324, 4.9e-324}, out);
    assert_true(out[0] == 0.0 && out[1] == 4.9e-324 && out[3] == -2.0);
    for (long k = 0; k < test_times(50); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_descriptive_stats d;
        for (int i = 0; i < N; i++) {
            x[i] = exp(fl_rng_normal(&g)) * (i % 3 ? 1.0 : -2.0);
            w[i] = fl_rng_in(&g, 0.1, 0.2);
        }
        fl_compute_moments(N, x, w, &d);
        compute_moments(N, x, w, out);
        assert_near_of(out[0], d.mean, 1e-14, d.std);
        assert_near(out[1], d.std, 1e-14);
        assert_near_of(out[2], d.skew, 1e-13, 1.0 + fabs(d.skew));
        assert_near_of(out[3], d.kurtosis, 1e-13, 3.0 + fabs(d.kurtosis));
    }
}

static void malformed_text_is_refused(void **state)
{
    static const char *const bad[] = {"",         "1",     "0x",      "0x1",     "0x1p",   "0x2p0",
                                      "0x01p0",   "0xGp0", "x1p0",    "--0x1p0", "0x1p0 ", "0x1p-5377",
                                      "0x1p1735", "0xFp0", "0x1p1e3", "-0",      "0x1.8p0"};
    fl_exact_sum s = {0};
    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        err = (fl_err){0};
        if (fl_exact_read(&s, bad[k], &err) != -1) fail_msg("\"%s\" was accepted", bad[k]);
        assert_int_equal(err.code, FL_INPUT);
    }
    err = (fl_err){0};
    assert_int_equal(fl_exact_read(&s, "-0x123456789abcdef0123456789abcdefp-60", &err), 0);
    assert_string_equal(text_of(&s), "-0x123456789abcdef0123456789abcdefp-60");
    fl_exact_free(&s);
    char *many = malloc(5000);
    memset(many, 'f', 4999);
    memcpy(many, "0x", 2);
    strcpy(many + 4990, "p0");
    assert_int_equal(fl_exact_read(&s, many, &err), -1);
    free(many);
    fl_exact_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(known_sums), cmocka_unit_test(order_is_free),
                                       cmocka_unit_test(nearest_value), cmocka_unit_test(moments_are_exact),
                                       cmocka_unit_test(malformed_text_is_refused)};
    return cmocka_run_group_tests_name("exact_sum", tests, NULL, NULL);
}
