/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/near.h"
#include <math.h>
#include "base/pi.h"
#include "ice/drift_bounds.h"

static void joins_what_overlaps_or_is_near(void **state)
{
    fl_obstacle a[] = {{9.0, 10.5}, {0.0, 1.0}, {0.5, 2.0}, {6.0, 7.0}, {1.0, 1.5}};
    fl_obstacle b[] = {{0.0, 5.0}, {1.0, 2.0}};
    double width;
    (void)state;
    assert_int_equal(fl_join_intervals(5, a, 0.0, &width), 3);
    assert_near(width, 4.5, 1e-15);
    assert_true(a[0].lo == 0.0 && a[0].hi == 2.0 && a[2].lo == 9.0);
    assert_int_equal(fl_join_intervals(3, a, 3.0, &width), 2);
    assert_near(width, 2.0 + 4.5, 1e-15);
    assert_int_equal(fl_join_intervals(2, b, 0.0, &width), 1);
    assert_near(width, 5.0, 1e-15);
    assert_int_equal(fl_join_intervals(0, b, 0.0, &width), 0);
    assert_true(width == 0.0);
}

/* At the width that is needed the ice beside the structure is at the concentration of a jam: 2.4 D at 0.5,
 * 17 D at 0.8. */
static void width_and_jam_agree(void **state)
{
    (void)state;
    for (double c = 0.05; c < 0.85; c += 0.1) {
        const double w = fl_width_needed(c, 3.0);
        assert_near(fl_concentration_beside(c, w, 3.0), FL_JAM_CONCENTRATION, 1e-12);
    }
    assert_near(fl_width_needed(0.5, 1.0), 2.43, 2e-3);
    assert_near(fl_width_needed(0.8, 1.0), 17.0, 1e-9);
    assert_true(isinf(fl_width_needed(0.85, 1.0)) && isinf(fl_concentration_beside(0.1, 2.0, 2.0)));
    assert_true(fl_concentration_beside(0.4, INFINITY, 20.0) == 0.4);
}

/* Ice-scenes(7): 240 x 80 m of 7/10 ice in 0.7 m/s; a leg of 1.5 m in floes of 6 m; 356 t at 0.5 m/s. */
static void loads_of_the_page(void **state)
{
    (void)state;
    assert_near(fl_drag_of_held_ice(1025.0, 0.005, 0.7, 0.7 * 240.0 * 80.0), 16.9e3, 2e-3);
    assert_near(fl_momentum_load(0.3, 900.0 * 0.4 * 0.5, 0.7, 1.5 + 6.0), 860.0, 1e-3);
    assert_near(fl_floe_impulse(0.3, 356.4e3, 0.5, 0.0, 8.1), 231.66e3, 1e-4);
    assert_near(fl_floe_impulse(0.3, 356.4e3, 0.5, 5.0, sqrt(200.0 / 3.0)), 231.66e3 / 1.375, 1e-4);
}

/* Ice-scenes(7): L 120, B 20, T 7.5, L_p 55, A_wf 500, bow angles 40 and 25 degrees. */
static void brash_of_the_ice_class_rules(void **state)
{
    static const double thickness[] = {0.6, 0.8, 1.0}, load[] = {252e3, 333e3, 420e3};
    const double rad = PI / 180.0, psi = atan(tan(40.0 * rad) / sin(25.0 * rad)) / rad,
                 q = fmin(20.0, fmax(5.0, pow(120.0 * 7.5 / 400.0, 3.0)));
    const double cm = fmax(0.45, 0.15 * cos(40.0 * rad) + sin(psi * rad) * sin(25.0 * rad)),
                 cp = fmax(0.0, 0.047 * psi - 2.115);
    (void)state;
    for (int k = 0; k < 3; k++) {
        assert_near(fl_brash_load(thickness[k], 20.0, cm, cp, 55.0, q, 500.0 / 120.0), load[k], 2e-3);
        assert_true(fl_brash_load(thickness[k], 20.0, 0.45, 0.0, 0.0, 0.0, 0.0) < load[k]);
    }
    assert_near(fl_brash_load(0.74 * 0.74, 1.0, 0.5, 2.0, 3.0, 5.0, 0.1),
                845.0 * 0.5 * 1.5476 * 1.5476 * 3.0 + 126.0 + 412.5, 1e-12); /* H_F = 1 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(joins_what_overlaps_or_is_near),
        cmocka_unit_test(width_and_jam_agree),
        cmocka_unit_test(loads_of_the_page),
        cmocka_unit_test(brash_of_the_ice_class_rules),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
