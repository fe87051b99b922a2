/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include "support/near.h"
#include "base/array.h"
#include "base/string_table.h"

static void words_are_numbered_in_order_of_appearance(void **state)
{
    (void)state;
    fl_string_table s = {0};
    fl_err err = {0};
    assert_int_equal(fl_string_table_find(&s, "ice"), -1);
    assert_int_equal(fl_string_table_add(&s, "ice", &err), 0);
    assert_int_equal(fl_string_table_add(&s, "steel", &err), 1);
    assert_int_equal(fl_string_table_add(&s, "ice", &err), 0);
    assert_int_equal(fl_string_table_add(&s, "", &err), 2);
    assert_int_equal(fl_string_table_find(&s, "steel"), 1);
    assert_int_equal(fl_string_table_find(&s, "stee"), -1);
    assert_int_equal(s.n, 3);
    assert_string_equal(s.name[1], "steel");
    fl_string_table_free(&s);
    assert_int_equal(s.n, 0);
}

static void many_words_keep_their_indices(void **state)
{
    (void)state;
    fl_string_table s = {0};
    fl_err err = {0};
    char word[16];
    for (int k = 0; k < 100000; k++) {
        snprintf(word, sizeof word, "n%d", k);
        assert_int_equal(fl_string_table_add(&s, word, &err), k);
    }
    for (int k = 0; k < 100000; k += 7) {
        snprintf(word, sizeof word, "n%d", k);
        assert_int_equal(fl_string_table_find(&s, word), k);
    }
    fl_string_table_free(&s);
}

static void a_failed_add_keeps_the_table(void **state)
{
    (void)state;
    for (long k = 0; k < 4; k++) {
        fl_string_table s = {0};
        fl_err err = {0};
        fl_alloc_fail_after(k);
        const int32_t got = fl_string_table_add(&s, "ice", &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(got, k < 3 ? -1 : 0);
        assert_int_equal(err.code, k < 3 ? FL_SYSTEM : 0);
        assert_int_equal(s.n, k < 3 ? 0 : 1);
        err = (fl_err){0};
        assert_int_equal(fl_string_table_add(&s, "ice", &err), 0);
        fl_string_table_free(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(words_are_numbered_in_order_of_appearance),
                                       cmocka_unit_test(many_words_keep_their_indices),
                                       cmocka_unit_test(a_failed_add_keeps_the_table)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
