/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/pi.h"
#include "ice/sheet_strength.h"
#include "ice/slab_fill.h"
#include "ice/sphere_packing.h"
#include "support/near.h"

/* phi of each packing is that of its infinite lattice, in any direction of the rows, whatever its edges. */
static void packings_fill_as_their_lattices_do(void **state)
{
    static const struct {
        enum fl_packing_kind kind;
        int32_t layers;
        double spacing, phi;
    } IT[] = {{FL_PACKING_HCP, 3, 0.816496580927726, 0.740480489693061},
              {FL_PACKING_HCP, 2, 0.816496580927726, 0.740480489693061},
              {FL_PACKING_HEX, 2, 1.0, 0.604599788078073},
              {FL_PACKING_SQUARE, 2, 1.0, PI / 6.0},
              {FL_PACKING_HCP, 1, 1.0, 0.604599788078073}};
    (void)state;
    for (size_t k = 0; k < sizeof IT / sizeof *IT; k++)
        for (int across = 0; across < 2; across++) {
            const double D = 0.2;
            fl_sphere_packing a;
            fl_err err = {0};
            double phi = 0.0;
            assert_int_equal(fl_sphere_packing_make(&a, IT[k].kind, D, IT[k].layers, (fl_vec2){0, 0},
                                                    (fl_vec2){2.1, 1.7}, &err),
                             0);
            for (int32_t i = 0; i < a.n && across; i++) a.x[i] = v3(a.x[i].y, a.x[i].x, a.x[i].z);
            assert_int_equal(fl_slab_fill(a.n, a.x, 0.5 * D, IT[k].layers * IT[k].spacing * D, &phi, &err),
                             0);
            assert_near(phi, IT[k].phi, 1e-12);
            fl_sphere_packing_free(&a);
        }
}

static void other_slabs_are_refused(void **state)
{
    const fl_vec3 x[3] = {{0, 0, 0}, {0.2, 0, 0}, {0.1, 0.173, 0}};
    fl_err err = {0};
    double phi = 7.0;
    (void)state;
    assert_int_equal(fl_slab_fill(3, x, 0.1, 2.0, &phi, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_non_null(strstr(err.text, "would fill"));
    assert_true(phi == 7.0);
}

/* More layers than measured have the ratios of the thickest sample; square is the same both ways. */
static void sheets_have_measured_ratios(void **state)
{
    const fl_sheet_strength three = fl_sheet_strength_of(FL_PACKING_HCP, 3, 1),
                            six = fl_sheet_strength_of(FL_PACKING_HCP, 6, 1),
                            square = fl_sheet_strength_of(FL_PACKING_SQUARE, 3, 0),
                            turned = fl_sheet_strength_of(FL_PACKING_SQUARE, 3, 1);
    (void)state;
    assert_true(three.flexural == six.flexural && three.flexural > 1.0 && three.young > 1.0);
    assert_true(square.compressive == turned.compressive && square.flexural == turned.flexural);
    for (int kind = FL_PACKING_HCP; kind <= FL_PACKING_SQUARE; kind++)
        for (int32_t layers = 1; layers <= 4; layers++) {
            const fl_sheet_strength a = fl_sheet_strength_of((enum fl_packing_kind)kind, layers, 0);
            assert_true(kind == FL_PACKING_SQUARE ? a.compressive == 0.0 : a.compressive > a.flexural);
            assert_true(a.flexural > 0.3 && a.young > 0.2);
            assert_true(a.flexural_spread < 0.3 && a.compressive_spread < 0.3);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(packings_fill_as_their_lattices_do),
                                       cmocka_unit_test(other_slabs_are_refused),
                                       cmocka_unit_test(sheets_have_measured_ratios)};
    return cmocka_run_group_tests_name("slab_fill", tests, NULL, NULL);
}
