/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/array.h"
#include "mesh/id_map.h"
#include "support/near.h"

static void ids_are_indexed_in_order_of_appearance(void **state)
{
    (void)state;
    fl_id_map s = {0};
    fl_err err = {0};
    assert_int_equal(fl_id_map_find(&s, 0, 7), -1);
    assert_int_equal(fl_id_map_add(&s, 0, 7, &err), 0);
    assert_int_equal(fl_id_map_add(&s, 1, 7, &err), 1);
    assert_int_equal(fl_id_map_add(&s, 0, 7, &err), 0);
    assert_int_equal(fl_id_map_add(&s, -1, -7, &err), 2);
    assert_int_equal(fl_id_map_add(&s, 0, INT64_MAX, &err), 3);
    assert_int_equal(fl_id_map_find(&s, 1, 7), 1);
    assert_int_equal(fl_id_map_find(&s, 2, 7), -1);
    assert_int_equal(s.n, 4);
    assert_true(s.id[3] == INT64_MAX && s.scope[1] == 1);
    fl_id_map_free(&s);
    assert_int_equal(s.n, 0);
}

/* The same numbers in several scopes, dense, in steps of a power of two, and negative: all stay distinct. */
static void many_ids_keep_their_indices(void **state)
{
    (void)state;
    fl_id_map s = {0};
    fl_err err = {0};
    int32_t n = 0;
    for (int32_t scope = 0; scope < 3; scope++)
        for (int64_t k = 0; k < 30000; k++)
            assert_int_equal(fl_id_map_add(&s, scope, scope == 2 ? -k * 65536 - 1 : k, &err), n++);
    for (int64_t k = 0; k < 30000; k += 11) {
        assert_int_equal(fl_id_map_find(&s, 0, k), k);
        assert_int_equal(fl_id_map_find(&s, 1, k), 30000 + k);
        assert_int_equal(fl_id_map_find(&s, 2, -k * 65536 - 1), 60000 + k);
        assert_int_equal(fl_id_map_find(&s, 2, k), -1);
    }
    fl_id_map_free(&s);
}

/* Ascending with gaps over several scopes, then one out of order, then all again: indices never change. */
static void any_order_gives_the_same_indices(void **state)
{
    (void)state;
    fl_id_map s = {0};
    fl_err err = {0};
    for (int64_t k = 0; k < 3000; k++)
        assert_int_equal(fl_id_map_add(&s, (int32_t)(k / 1000), k * k % 1000 + k * 1000, &err), k);
    assert_int_equal(s.slots, 0);
    for (int64_t k = 0; k < 3000; k += 7) {
        const int64_t j = k * 1237 % 3000;
        assert_int_equal(fl_id_map_find(&s, (int32_t)(j / 1000), j * j % 1000 + j * 1000), j);
        assert_int_equal(fl_id_map_find(&s, (int32_t)(j / 1000) + 1, j * j % 1000 + j * 1000), -1);
        assert_int_equal(fl_id_map_add(&s, (int32_t)(j / 1000), j * j % 1000 + j * 1000, &err), j);
    }
    assert_int_equal(s.slots, 0);
    assert_int_equal(fl_id_map_find(&s, 0, INT64_MIN), -1);
    assert_int_equal(fl_id_map_find(&s, 5, INT64_MAX), -1);
    assert_int_equal(fl_id_map_add(&s, 1, -5, &err), 3000);
    assert_true(s.slots > 4500);
    for (int64_t k = 2999; k >= 0; k--)
        assert_int_equal(fl_id_map_add(&s, (int32_t)(k / 1000), k * k % 1000 + k * 1000, &err), k);
    assert_int_equal(s.n, 3001);
    fl_id_map_free(&s);
}

static void a_failed_allocation_adds_nothing(void **state)
{
    (void)state;
    for (long fail = 0;; fail++) {
        fl_id_map s = {0};
        fl_err err = {0};
        fl_alloc_fail_after(fail);
        int32_t k = fl_id_map_add(&s, 0, 5, &err);
        if (k == 0) k = fl_id_map_add(&s, 0, 4, &err); /* out of order: this one is hashed */
        fl_alloc_fail_after(-1);
        if (k < 0) {
            assert_int_equal(err.code, FL_SYSTEM);
            assert_true(s.n < 2);
            assert_int_equal(fl_id_map_find(&s, 0, 4), -1);
            assert_int_equal(fl_id_map_find(&s, 0, 5), s.n - 1);
        }
        fl_id_map_free(&s);
        if (k >= 0) break;
        assert_true(fail < 10);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ids_are_indexed_in_order_of_appearance),
        cmocka_unit_test(many_ids_keep_their_indices),
        cmocka_unit_test(any_order_gives_the_same_indices),
        cmocka_unit_test(a_failed_allocation_adds_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
