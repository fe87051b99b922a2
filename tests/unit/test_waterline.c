/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/pi.h"
#include "base/rng.h"
#include "stat/panels.h"
#include "stat/waterline.h"
#include "support/near.h"

static fl_waterline make_waterline(const char *text)
{
    fl_waterline w;
    fl_err err = {0};
    assert_int_equal(fl_waterline_make(&w, text, &err), 0);
    return w;
}

static void circle_runs_counter_clockwise(void **state)
{
    const fl_waterline w = make_waterline("circle:2,-1,3");
    double x, y;
    (void)state;
    assert_near(w.length, 6.0 * PI, 1e-15);
    assert_near(fl_waterline_nearest(&w, 12.0, -1.0), 0.0, 1e-15);
    assert_near(fl_waterline_nearest(&w, 2.0, 0.0), 1.5 * PI, 1e-14);
    assert_near(fl_waterline_nearest(&w, 2.0, -9.0), 4.5 * PI, 1e-14);
    assert_near(fl_waterline_nearest(&w, 2.0, -1.0), 0.0, 1e-15);
    fl_waterline_point(&w, 3.0 * PI, &x, &y);
    assert_near(x, -1.0, 1e-14);
    assert_near(y, -1.0, 1e-14);
}

/* Two sides of a wall with a corner at (4, 0). */
static void chain_takes_the_nearest_point(void **state)
{
    const fl_waterline w = make_waterline("0,0:4,0:4,3");
    double x, y;
    (void)state;
    assert_near(w.length, 7.0, 1e-15);
    assert_near(fl_waterline_nearest(&w, 1.5, -2.0), 1.5, 1e-15);
    assert_near(fl_waterline_nearest(&w, 9.0, 2.0), 6.0, 1e-15);
    assert_near(fl_waterline_nearest(&w, -5.0, -5.0), 0.0, 1e-15);
    assert_near(fl_waterline_nearest(&w, 9.0, 99.0), 7.0, 1e-15);
    assert_near(fl_waterline_nearest(&w, 5.0, -1.0), 4.0, 1e-15); /* beyond the corner */
    fl_waterline_point(&w, 5.0, &x, &y);
    assert_near(x, 4.0, 1e-15);
    assert_near(y, 1.0, 1e-15);
}

/* A point of the line is found at its own position. */
static void points_of_the_line_are_found_again(void **state)
{
    static const char *const text[] = {"circle:-1e3,5,0.1", "0,0:1,0:1,1:0,1:0,0", "-5,2:7,3.5:8,-1"};
    (void)state;
    for (int trial = 0; trial < test_times(300); trial++) {
        fl_rng g = fl_rng_of(test_seed(), trial, FL_RNG_TEST);
        const fl_waterline w = make_waterline(text[trial % 3]);
        const double s = fl_rng_in(&g, 0.001, 0.999) * w.length;
        double x, y;
        fl_waterline_point(&w, s, &x, &y);
        assert_near_of(fl_waterline_nearest(&w, x, y), s, 1e-9, w.length);
    }
}

static void invalid_waterlines_are_refused(void **state)
{
    static const char *const text[] = {
        "",         "circle:",  "circle:1,2", "circle:1,2,0", "circle:1,2,-3", "circle:1,2,3,4",
        "0,0",      "0,0:",     "0,0:0,0",    "0,0:1",        "0,0,1,1",       "0,0:1,x",
        "0,0::1,1", ":0,0:1,1", "0,0:1e99,0", "nan,0:1,1",    "circle:a,b,c",  "circle:0,0,1:"};
    (void)state;
    for (size_t k = 0; k < sizeof text / sizeof *text; k++) {
        fl_waterline w;
        fl_err err = {0};
        if (fl_waterline_make(&w, text[k], &err) == 0) print_error("accepted: \"%s\"\n", text[k]);
        assert_int_equal(err.code, FL_USAGE);
    }
}

static void panel_tables_are_read(void **state)
{
    static const char text[] =
        "#panels 1\n#start 1\nt[s] panel x[m] y[m] z[m] area[m2] fx[N] fy[N] fz[N]\n"
        "3 a 1 2 3 0.5 10 0 0\n3 b 1 3 3 0.25 0 4 3\n4 a 1 2 3 0.5 20 0 0\n4 b 1 3 3 0.25 0 0 0\n";
    fl_panels p = {0};
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_panels_open(&p, test_file("two.panels", text, strlen(text)), &err), 0);
    assert_int_equal(fl_panels_next(&p, &err), 1);
    assert_int_equal(p.n, 2);
    assert_near(p.edge[0], 1.0, 0.0);
    assert_near(p.edge[1], 3.0, 0.0);
    assert_near(p.panel[1].area, 0.25, 0.0);
    assert_near(v3_norm(p.panel[1].force), 5.0, 1e-15);
    assert_int_equal(fl_panels_next(&p, &err), 1);
    assert_near(p.panel[0].force.x, 20.0, 0.0);
    assert_near(p.edge[0], 3.0, 0.0);
    assert_int_equal(fl_panels_next(&p, &err), 0);
    fl_panels_close(&p);
}

static void bad_panels_are_refused(void **state)
{
    static const char *const rows[] = {
        "",
        "1 a 0 0 0 0 1 0 0\n",
        "1 a 0 0 0 1 1 0 0\n1 b 0 0 0 1 1 0 0\n2 b 0 0 0 1 1 0 0\n",
        "1 a 0 0 0 1 1 0 0\n1 b 0 0 0 1 1 0 0\n2 a 0 0 0 1 1 0 0\n3 a 0 0 0 1 1 0 0\n",
        "1 a 0 0 0 1 1 0 0\n2 a 0 0 0 1 1 0 0\n2 a 0 0 0 1 1 0 0\n",
        "0 a 0 0 0 1 1 0 0\n"};
    static const char *const said[] = {"has no rows",
                                       "expected above 0",
                                       "panel b comes here, expected a",
                                       "panel b has no row at 2 s",
                                       "expected a later time",
                                       "time 0 s does not follow 0 s"};
    (void)state;
    for (int k = 0; k < 6; k++) {
        char text[500];
        fl_panels p = {0};
        fl_err err = {0};
        int more = 1;
        snprintf(text, sizeof text, "#panels 1\nt[s] panel x[m] y[m] z[m] area[m2] fx[N] fy[N] fz[N]\n%s",
                 rows[k]);
        assert_int_equal(fl_panels_open(&p, test_file("bad.panels", text, strlen(text)), &err), 0);
        while (more > 0) more = fl_panels_next(&p, &err);
        assert_int_equal(more, -1);
        assert_int_equal(err.code, FL_INPUT);
        if (!strstr(err.text, said[k])) print_error("%s\n", err.text);
        assert_non_null(strstr(err.text, said[k]));
        fl_panels_close(&p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(circle_runs_counter_clockwise),
                                       cmocka_unit_test(chain_takes_the_nearest_point),
                                       cmocka_unit_test(points_of_the_line_are_found_again),
                                       cmocka_unit_test(invalid_waterlines_are_refused),
                                       cmocka_unit_test(panel_tables_are_read),
                                       cmocka_unit_test(bad_panels_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
