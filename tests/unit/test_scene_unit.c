/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Units of a scene: those of the table, products of prefixes and symbols, and what is refused. */
#include "support/near.h"
#include <stdio.h>
#include <string.h>
#include "base/pi.h"
#include "scene/scene_unit.h"
#include "scene/unit_product.h"

static void products_have_the_size_of_their_factors(void **state)
{
    static const struct row {
        enum fl_unit_kind kind;
        const char *word;
        double si;
    } rows[] = {
        {FL_UNIT_ROTATIONAL_STIFFNESS, "N.m", 1.0},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "kN.m", 1e3},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "MN.m", 1e6},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "GN.m", 1e9},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "kNm", 1e3},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "MNm/rad", 1e6},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "kN*m/rad", 1e3},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "kN\xC2\xB7m", 1e3},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "kN.m/deg", 1e3 * 180.0 / PI},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "MN.m/deg", 1e6 * 180.0 / PI},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "kN.mm/rad", 1.0},
        {FL_UNIT_ROTATIONAL_DAMPING, "kN.m.s/rad", 1e3},
        {FL_UNIT_ROTATIONAL_DAMPING, "MNms", 1e6},
        {FL_UNIT_ROTATIONAL_DAMPING, "kN.m.s/deg", 1e3 * 180.0 / PI},
        {FL_UNIT_STIFFNESS, "kN/m", 1e3},
        {FL_UNIT_STIFFNESS, "kN/mm", 1e6},
        {FL_UNIT_STIFFNESS, "N/mm", 1e3},
        {FL_UNIT_STIFFNESS, "kN/cm", 1e5},
        {FL_UNIT_DAMPING, "kNs/m", 1e3},
        {FL_UNIT_DAMPING, "GN.s/m", 1e9},
        {FL_UNIT_DAMPING, "t/s", 1e3},
        {FL_UNIT_STRESS, "kN/m2", 1e3},
        {FL_UNIT_STRESS, "MN/m2", 1e6},
        {FL_UNIT_STRESS, "MN/m^2", 1e6},
        {FL_UNIT_STRESS, "kN/mm2", 1e9},
        {FL_UNIT_STRESS, "N/cm2", 1e4},
        {FL_UNIT_STRESS, "kN/m\xC2\xB2", 1e3},
        {FL_UNIT_FOUNDATION, "MN/m^3", 1e6},
        {FL_UNIT_FOUNDATION, "kN/m\xC2\xB3", 1e3},
        {FL_UNIT_FOUNDATION, "kPa/m", 1e3},
        {FL_UNIT_AREA_DAMPING, "kN.s/m^3", 1e3},
        {FL_UNIT_AREA_DAMPING, "kPa.s/m", 1e3},
        {FL_UNIT_CONTACT_STIFFNESS, "kN/mm", 1e6},
        {FL_UNIT_CONTACT_STIFFNESS, "MN/m^1.5", 1e6},
        {FL_UNIT_DENSITY, "t/m3", 1e3},
        {FL_UNIT_DENSITY, "Mg/m3", 1e3},
        {FL_UNIT_DENSITY, "g/m3", 1e-3},
        {FL_UNIT_MASS, "t", 1e3},
        {FL_UNIT_MASS, "kt", 1e6},
        {FL_UNIT_INERTIA, "kt.m2", 1e6},
        {FL_UNIT_INERTIA, "t.m\xC2\xB2", 1e3},
        {FL_UNIT_SPEED, "m/min", 1.0 / 60.0},
        {FL_UNIT_SPEED, "dm/s", 0.1},
        {FL_UNIT_ACCELERATION, "mm/s2", 1e-3},
        {FL_UNIT_ANGLE, "mrad", 0.18 / PI},
        {FL_UNIT_ANGULAR_VELOCITY, "deg/min", PI / 180.0 / 60.0},
        {FL_UNIT_FREQUENCY, "kHz", 1e3},
        {FL_UNIT_TOUGHNESS, "MN/m^1.5", 1e6},
        {FL_UNIT_SURFACE_ENERGY, "kN/m", 1e3},
    };
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        double x = 1.0;
        if (fl_unit_convert(rows[k].kind, rows[k].word, &x)) fail_msg("%s is refused", rows[k].word);
        if (!(x > rows[k].si * (1.0 - 4e-16) && x < rows[k].si * (1.0 + 4e-16)))
            fail_msg("%s is %.17g, not %.17g", rows[k].word, x, rows[k].si);
    }
}

static void what_has_two_meanings_or_other_dimensions_is_refused(void **state)
{
    static const struct row {
        enum fl_unit_kind kind;
        const char *word;
    } rows[] = {
        {FL_UNIT_ROTATIONAL_STIFFNESS, "kN"},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "kN.m.s"},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "kN.m."},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "kN..m"},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "/rad"},
        {FL_UNIT_ROTATIONAL_STIFFNESS, "Mn.m"},
        {FL_UNIT_DAMPING, "kN/m.s"},
        {FL_UNIT_STRESS, "mPa"},
        {FL_UNIT_STRESS, "kN/m"},
        {FL_UNIT_STRESS, "kN/m0"},
        {FL_UNIT_STRESS, "kN/m^"},
        {FL_UNIT_MASS, "mt"},
        {FL_UNIT_SPEED, "kt"},
        {FL_UNIT_ANGULAR_VELOCITY, "Hz"},
        {FL_UNIT_FREQUENCY, "rad/s"},
        {FL_UNIT_ONE, "m/m"},
        {FL_UNIT_TOUGHNESS, "MPa.mm^0.5"},
        {FL_UNIT_LENGTH, "Mm"},
        {FL_UNIT_LENGTH, "m.h9.h9/h9/h9"},
        {FL_UNIT_LENGTH, "m.km9.km9/km9/km9"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        double x = 1.0;
        if (!fl_unit_convert(rows[k].kind, rows[k].word, &x)) fail_msg("%s is read as %g", rows[k].word, x);
    }
}

/* A word of the table that is a product has the size that the table says. */
static void the_table_agrees_with_products(void **state)
{
    int products = 0;
    (void)state;
    for (int kind = FL_UNIT_ONE; kind <= FL_UNIT_TOUGHNESS; kind++) {
        char list[200], *save = NULL;
        fl_unit_product of, si;
        fl_unit_list((enum fl_unit_kind)kind, list, sizeof list);
        for (char *word = strtok_r(list, " ", &save); word; word = strtok_r(NULL, " ", &save)) {
            double x = 3.0;
            assert_int_equal(fl_unit_convert((enum fl_unit_kind)kind, word, &x), 0);
            if (fl_unit_product_read(word, &of) ||
                fl_unit_product_read(fl_unit_si((enum fl_unit_kind)kind), &si))
                continue;
            if (!fl_unit_product_same_dimensions(&of, &si)) continue; /* N.m for N.m/rad, N/m^1.5 */
            assert_near(fl_unit_product_convert(&of, &si, 3.0), x, 1e-15);
            products++;
        }
    }
    assert_true(products > 70);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(products_have_the_size_of_their_factors),
        cmocka_unit_test(what_has_two_meanings_or_other_dimensions_is_refused),
        cmocka_unit_test(the_table_agrees_with_products),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
