/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/near.h"
#include <stdio.h>
#include <string.h>
#include "law/contact_law.h"

/* The choices of contact.law are the names of the rows in their order, and the meaning names each. */
static void choices_are_the_rows(void **state)
{
    (void)state;
    char names[256] = "";
    for (int32_t k = 0; k < fl_contact_law_count; k++) {
        const size_t n = strlen(names);
        snprintf(names + n, sizeof names - n, "%s%s", k ? "|" : "", fl_contact_laws[k].name);
        assert_non_null(strstr(fl_contact_law_meaning, fl_contact_laws[k].name));
    }
    assert_string_equal(names, fl_contact_law_choices);
}

static void a_law_uses_its_keys(void **state)
{
    (void)state;
    for (int32_t k = 0; k < fl_contact_law_count; k++) {
        const fl_contact_law *law = &fl_contact_laws[k];
        assert_int_equal(fl_contact_law_uses(law, "exponent"), law->points == FL_POINTS_NEAREST);
        assert_int_equal(fl_contact_law_uses(law, "surrogate"), law->points == FL_POINTS_PATCH);
        assert_int_equal(fl_contact_law_uses(law, "manual_eq2"), law->points == FL_POINTS_FEATURES);
        assert_int_equal(fl_contact_law_uses(law, "friction"), 0);
    }
}

/* Damping never lengthens the stable step, and more of it shortens it. */
static void damping_shortens_the_step(void **state)
{
    (void)state;
    for (int32_t k = 0; k < fl_contact_law_count; k++) {
        const fl_contact_law *law = &fl_contact_laws[k];
        const double none = fl_contact_law_stable_share(law, 0.0, 0.0, 0.0),
                     some = fl_contact_law_stable_share(law, 1.0, 0.5, 0.5);
        assert_near(none, 1.0, 1e-15);
        assert_true(some > 0.0 && some < 1.0);
        assert_true(fl_contact_law_scaled_share(law, 1.0, some, 1.0) == some);
        assert_true(fl_contact_law_scaled_share(law, 1.0, some, 2.0) < some);
    }
}

int main(void)
{
    const struct CMUnitTest test[] = {
        cmocka_unit_test(choices_are_the_rows),
        cmocka_unit_test(a_law_uses_its_keys),
        cmocka_unit_test(damping_shortens_the_step),
    };
    return cmocka_run_group_tests(test, NULL, NULL);
}
