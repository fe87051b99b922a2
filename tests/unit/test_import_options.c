/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "mesh/import_options.h"
#include "support/near.h"

static void names_match_patterns(void **state)
{
    (void)state;
    static const struct {
        const char *pattern, *name;
        int like;
    } row[] = {
        {"leg", "leg", 1},
        {"leg", "LEG", 1},
        {"LEG", "leg", 1},
        {"leg", "legs", 0},
        {"leg", "le", 0},
        {"", "", 1},
        {"", "a", 0},
        {"*", "", 1},
        {"*", "anything", 1},
        {"leg*", "leg", 1},
        {"leg*", "leg_12", 1},
        {"*leg", "left leg", 1},
        {"*leg", "legs", 0},
        {"l?g", "lag", 1},
        {"l?g", "lg", 0},
        {"?", "", 0},
        {"a*b*c", "a--b--c", 1},
        {"a*b*c", "a--c--b", 0},
        {"a*b*c", "abbbcbc", 1},
        {"**", "x", 1},
        {"*a", "aaab", 0},
        {"*ab", "aaab", 1},
        {"my_set", "My Set", 1},
        {"my set", "my_set", 0},
        {"\xbd\xe1*", "\xbd\xe1\xb9\xb9", 1}, /* GBK: bytes are bytes */
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++)
        if (fl_pattern_matches(row[k].pattern, row[k].name) != row[k].like)
            fail_msg("\"%s\" and \"%s\"", row[k].pattern, row[k].name);
}

/* A pattern for which a backtracking matcher runs for years. */
static void many_stars_are_fast(void **state)
{
    (void)state;
    char pattern[200], name[2001];
    for (int k = 0; k < 99; k++) memcpy(pattern + 2 * k, "*a", 2);
    strcpy(pattern + 198, "b");
    memset(name, 'a', 2000);
    name[2000] = '\0';
    assert_false(fl_pattern_matches(pattern, name));
}

static void options_record_what_they_matched(void **state)
{
    (void)state;
    const char *const pattern[] = {"leg*", "deck", "nothing"};
    char matches[3] = {0};
    fl_string_table seen = {0};
    fl_err err = {0};
    fl_import_options w = {.pattern = pattern, .patterns = 3, .matched = matches, .available = &seen};
    assert_int_equal(fl_import_selects(&w, "leg 1", &err), 1);
    assert_int_equal(fl_import_selects(&w, "hull", &err), 0);
    assert_int_equal(fl_import_selects(&w, "DECK", &err), 1);
    assert_true(matches[0] && matches[1] && !matches[2]);
    assert_int_equal(seen.n, 3);
    assert_string_equal(seen.name[1], "hull");
    assert_true(fl_import_by_name(&w));
    w.patterns = 0;
    assert_int_equal(fl_import_selects(&w, "hull", &err), 1);
    assert_false(fl_import_by_name(&w));
    assert_int_equal(fl_import_selects(NULL, "hull", &err), 1);
    assert_false(fl_import_by_name(NULL));
    fl_string_table_free(&seen);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_match_patterns),
        cmocka_unit_test(many_stars_are_fast),
        cmocka_unit_test(options_record_what_they_matched),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
