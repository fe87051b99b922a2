/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "support/near.h"

static void aligned_and_zero(void **state)
{
    fl_err err = {0};
    (void)state;
    for (int64_t n = 0; n < 300; n += 7) {
        unsigned char *p = fl_alloc(n, 3, &err);
        assert_non_null(p);
        assert_true((uintptr_t)p % 64 == 0);
        for (int64_t k = 0; k < 3 * n; k++) assert_int_equal(p[k], 0);
        memset(p, 1, (size_t)(3 * n)); /* the whole array is usable */
        free(p);
    }
    assert_int_equal(err.code, 0);
}

static void refuses_sizes_that_overflow(void **state)
{
    static const struct {
        int64_t n;
        size_t size;
    } bad[] = {{-1, 8}, {INT64_MAX, 8}, {INT64_MAX, SIZE_MAX}, {1, SIZE_MAX}, {2, SIZE_MAX / 2}};
    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        fl_err err = {0};
        assert_null(fl_alloc(bad[k].n, bad[k].size, &err));
        assert_int_equal(err.code, FL_SYSTEM);
        assert_non_null(strstr(err.text, "out of memory"));
    }
}

static void growth_keeps_the_contents(void **state)
{
    double *a = NULL;
    int32_t cap = 0, moves = 0;
    fl_err err = {0};
    (void)state;
    for (int32_t n = 0; n < 100000; n++) {
        const int32_t before = cap;
        assert_int_equal(fl_grow(&a, &cap, n + 1, sizeof *a, &err), 0);
        moves += cap != before;
        assert_true(cap > n && (cap == before || cap >= 2 * before));
        a[n] = n;
    }
    assert_true(moves < 20); /* doubling: 8 2^14 > 100000 */
    for (int32_t n = 0; n < 100000; n++) assert_true(a[n] == n);
    assert_int_equal(fl_grow(&a, &cap, 5, sizeof *a, &err), 0); /* the capacity never shrinks */
    assert_true(cap >= 100000);
    free(a);
}

static void growth_that_fails_changes_nothing(void **state)
{
    int32_t *a = NULL, cap = 0;
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_grow(&a, &cap, 3, sizeof *a, &err), 0);
    a[2] = 42;
    int32_t *const was = a;
    const int32_t cap_was = cap;
    assert_int_equal(fl_grow(&a, &cap, (int64_t)INT32_MAX + 1, sizeof *a, &err), -1);
    assert_int_equal(err.code, FL_SYSTEM);
    err = (fl_err){0};
    fl_alloc_fail_after(0);
    assert_int_equal(fl_grow(&a, &cap, 1000, sizeof *a, &err), -1);
    fl_alloc_fail_after(-1);
    assert_int_equal(err.code, FL_SYSTEM);
    assert_ptr_equal(a, was);
    assert_int_equal(cap, cap_was);
    assert_int_equal(a[2], 42);
    free(a);
}

static void fails_from_the_nth_on(void **state)
{
    (void)state;
    for (long n = 0; n < 5; n++) {
        fl_alloc_fail_after(n);
        for (long k = 0; k < 8; k++) {
            fl_err err = {0};
            void *p = fl_alloc(1, 1, &err);
            assert_int_equal(p != NULL, k < n);
            free(p);
        }
        assert_int_equal(fl_alloc_refused(), 8 - n);
    }
    fl_alloc_fail_after(-1);
    assert_int_equal(fl_alloc_refused(), 0);
    fl_err err = {0};
    void *p = fl_alloc(1, 1, &err);
    assert_non_null(p);
    free(p);
}

static void the_first_failure_is_reported(void **state)
{
    fl_err err = {0};
    char longer[1000];
    (void)state;
    memset(longer, 'x', sizeof longer - 1);
    longer[sizeof longer - 1] = '\0';
    assert_int_equal(fl_fail(&err, FL_INPUT, "line %d", 4), -1);
    assert_int_equal(fl_fail(&err, FL_SYSTEM, "later"), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text, "line 4");
    err = (fl_err){0};
    fl_fail(&err, FL_INPUT, "%s", longer);
    assert_int_equal(strlen(err.text), sizeof err.text - 1); /* truncated, not overrun */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(aligned_and_zero),          cmocka_unit_test(refuses_sizes_that_overflow),
        cmocka_unit_test(growth_keeps_the_contents), cmocka_unit_test(growth_that_fails_changes_nothing),
        cmocka_unit_test(fails_from_the_nth_on),     cmocka_unit_test(the_first_failure_is_reported)};
    return cmocka_run_group_tests_name("array", tests, NULL, NULL);
}
