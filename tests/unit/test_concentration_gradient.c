/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "support/near.h"
#include "base/array.h"
#include "ice/certificate.h"
#include "ice/floes.h"
#include "ice/concentration_gradient.h"

static const fl_vec2 LO = {-25.0, -20.0}, HI = {25.0, 20.0};

static int read_text(fl_concentration_gradient *g, double angle, const char *text, fl_err *err)
{
    *err = (fl_err){0};
    return fl_concentration_read(g, angle, test_file("grade", text, strlen(text)), err);
}

static void a_line_and_a_table_agree(void **state)
{
    (void)state;
    fl_concentration_gradient a = {0}, b = {0};
    fl_err err = {0};
    assert_int_equal(fl_concentration_linear(&a, 0.0, 0.2, 0.9, LO, HI, &err), 0);
    assert_int_equal(read_text(&b, 0.0, "s[m] c\n-25 0.2\n# between\n0 0.55\n25 0.9\n", &err), 0);
    for (double x = -30.0; x <= 30.0; x += 0.7)
        assert_near(fl_concentration_at(&a, (fl_vec2){x, 3.0}), fl_concentration_at(&b, (fl_vec2){x, -8.0}),
                    1e-14);
    assert_true(fl_concentration_at(&b, (fl_vec2){-99.0, 0.0}) == 0.2 &&
                fl_concentration_at(&b, (fl_vec2){99.0, 0.0}) == 0.9);
    fl_concentration_free(&a);
    fl_concentration_free(&b);
    /* in another direction it runs from one corner of the box to the opposite one */
    assert_int_equal(fl_concentration_linear(&a, acos(-1.0) / 4.0, 0.1, 0.5, LO, HI, &err), 0);
    assert_near(fl_concentration_at(&a, LO), 0.1, 1e-14);
    assert_near(fl_concentration_at(&a, HI), 0.5, 1e-14);
    assert_near(fl_concentration_at(&a, (fl_vec2){3.0, -3.0}), 0.3, 1e-14);
    fl_concentration_free(&a);
}

static void invalid_tables_are_reported(void **state)
{
    (void)state;
    static const char *const text[] = {"",          "s[m] c\n",       "0 0\n",          "0 1\n",
                                       "0 nan\n",   "0 0.5\n0 0.6\n", "1 0.5\n0 0.6\n", "0\n",
                                       "0 0.5 1\n", "1e10 0.5\n",     "x y\n"};
    for (size_t k = 0; k < sizeof text / sizeof *text; k++) {
        fl_concentration_gradient g = {0};
        fl_err err;
        assert_int_equal(read_text(&g, 0.0, text[k], &err), -1);
        assert_int_equal(err.code, FL_INPUT);
        assert_null(g.s);
    }
}

/* Each floe covers its share to rounding, and all floes together cover the requested area, fixed floes
 * included. */
static void floes_cover_their_share(void **state)
{
    (void)state;
    for (int k = 0; k < 12; k++) {
        const int32_t n = 50 + 20 * k;
        fl_vec2 site[300];
        double part[300], area[300], expected = 0.0, off = 1.0, radius = 0.05 * (k % 3);
        fl_concentration_gradient g = {0};
        fl_power_cells c = {0};
        fl_floes a = {0};
        fl_certificate cert;
        fl_err err = {0};
        fl_random_sites(n, (uint64_t)k, LO, HI, site);
        assert_int_equal(fl_power_cells_build(&c, n, site, LO, HI, &err), 0);
        for (int s = 0; s < 2 + k % 2; s++) {
            fl_power_cells_centroids(&c, site);
            fl_power_cells_free(&c);
            assert_int_equal(fl_power_cells_build(&c, n, site, LO, HI, &err), 0);
        }
        fl_power_cells_areas(&c, area);
        assert_int_equal(fl_concentration_linear(&g, 0.3 * k, k % 4 ? 0.1 : 0.02, 0.9, LO, HI, &err), 0);
        fl_power_cells_centroids(&c, site);
        for (int32_t i = 0; i < n; i++) {
            part[i] = fl_concentration_at(&g, site[i]);
            expected += part[i] * area[i];
        }
        assert_int_equal(fl_floes_make_graded(&a, &c, part, radius, (fl_vec2){0, 0}, &off, &err), 0);
        assert_int_equal(fl_certificate_make(&cert, &a, &err), 0);
        assert_int_equal(cert.overlaps, 0);
        assert_near(cert.total_area, expected, 1e-12);
        if (a.limited == 0) assert_true(off < 1e-12);
        assert_true(off < 0.05);
        fl_floes_free(&a);
        fl_power_cells_free(&c);
        fl_concentration_free(&g);
    }
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    fl_vec2 site[10];
    double part[10];
    fl_power_cells c = {0};
    fl_err err = {0};
    int rc = -1;
    fl_random_sites(10, 1, LO, HI, site);
    for (int32_t i = 0; i < 10; i++) part[i] = 0.5;
    assert_int_equal(fl_power_cells_build(&c, 10, site, LO, HI, &err), 0);
    for (long k = 0; rc; k++) {
        fl_floes a = {0};
        double off;
        err = (fl_err){0};
        fl_alloc_fail_after(k);
        rc = fl_floes_make_graded(&a, &c, part, 0.05, (fl_vec2){0, 0}, &off, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
        if (rc) assert_null(a.first);
        fl_floes_free(&a);
        assert_true(k < 1000);
    }
    for (int32_t i = 0; i < 10; i++) part[i] = 0.9999999;
    fl_floes a = {0};
    double off;
    assert_int_equal(fl_floes_make_graded(&a, &c, part, 0.5, (fl_vec2){0, 0}, &off, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    fl_power_cells_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_and_a_table_agree), cmocka_unit_test(invalid_tables_are_reported),
        cmocka_unit_test(floes_cover_their_share), cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
