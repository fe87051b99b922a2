/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/pi.h"
#include "support/near.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "structure/prescribed_track.h"

static fl_track read_track(const char *text, int cubic)
{
    fl_track tr = {0};
    fl_err err = {0};
    if (fl_track_read(&tr, test_file("track", text, strlen(text)), cubic, &err)) fail_msg("%s", err.text);
    return tr;
}

static void a_cubic_is_kept(void **state)
{
    /* x = 1 + t + t^2 and rz = -2 t^2 at unequal rows: parabolas are reproduced, at the ends and beyond */
    static const double T[5] = {0, 0.5, 2, 3, 3.5};
    char text[1000];
    int at = snprintf(text, sizeof text, "#track 1\nrz[deg] t[s] what x[m]\n");
    (void)state;
    for (int k = 0; k < 5; k++)
        at += snprintf(text + at, sizeof text - (size_t)at, "%.17g %g 7 %.17g\n", -2 * T[k] * T[k], T[k],
                       1 + T[k] + T[k] * T[k]);
    fl_track tr = read_track(text, 1);
    for (double t = 0.0; t <= 3.5; t += 0.05) {
        fl_pose6 x, v, a;
        fl_track_evaluate(&tr, t, &x, &v, &a);
        assert_near(x.x.x, 1 + t + t * t, 1e-14);
        assert_near(v.x.x, 1 + 2 * t, 1e-13);
        assert_near(a.x.x, 2.0, 1e-12);
        assert_near_of(x.r.z, -2 * t * t * PI / 180, 1e-14, 1.0);
        assert_near(x.x.y, 0, 0);
    }
    fl_pose6 x, v, a;
    fl_track_evaluate(&tr, 5.5, &x, &v, &a); /* continues at its last velocity */
    assert_near(x.x.x, 1 + 3.5 + 3.5 * 3.5 + 2.0 * 8.0, 1e-13);
    assert_near(v.x.x, 8.0, 1e-13);
    assert_near(a.x.x, 0, 0);
    fl_track_evaluate(&tr, -1.0, &x, &v, &a);
    assert_near_of(x.x.x, 0.0, 1e-13, 1.0);
    fl_track_free(&tr);
}

static void velocity_and_acceleration_are_continuous_at_rows(void **state)
{
    fl_track tr = read_track("#track 1\nt x\n0 0\n1 2\n1.5 -1\n4 3\n5 0\n", 1);
    (void)state;
    for (int k = 1; k < 4; k++) {
        fl_pose6 x0, v0, a0, x1, v1, a1;
        fl_track_evaluate(&tr, tr.t[k] - 1e-9, &x0, &v0, &a0);
        fl_track_evaluate(&tr, tr.t[k], &x1, &v1, &a1);
        assert_near(x1.x.x, tr.value[k].x.x, 1e-14);
        assert_near_of(x0.x.x, x1.x.x, 1e-7, 1.0);
        assert_near_of(v0.x.x, v1.x.x, 1e-6, 1.0);
        assert_near_of(a0.x.x, a1.x.x, 1e-6, 1.0);
    }
    fl_track_free(&tr);
}

static void straight_pairs_and_single_rows(void **state)
{
    fl_pose6 x, v, a;
    (void)state;
    fl_track tr = read_track("#track 1\nt y\n0 0\n2 4\n3 4\n", 0);
    fl_track_evaluate(&tr, 1.0, &x, &v, &a);
    assert_near(x.x.y, 2.0, 1e-15);
    assert_near(v.x.y, 2.0, 1e-15);
    fl_track_evaluate(&tr, 2.0, &x, &v, &a);
    assert_near(v.x.y, 0, 0);
    fl_track_free(&tr);
    tr = read_track("#track 1\nt y\n0 1\n2 4\n", 1); /* two rows are a line */
    fl_track_evaluate(&tr, 0.5, &x, &v, &a);
    assert_near(x.x.y, 1.75, 1e-15);
    assert_near(a.x.y, 0, 0);
    fl_track_free(&tr);
    tr = read_track("#track 1\nt y rx\n0 1 90\n", 1); /* one is a pose */
    fl_track_evaluate(&tr, 100.0, &x, &v, &a);
    assert_near(x.x.y, 1.0, 0);
    assert_near(x.r.x, PI / 2, 1e-15);
    assert_near(v.x.y, 0, 0);
    fl_track_free(&tr);
}

static void invalid_tracks_are_refused(void **state)
{
    static const struct {
        const char *text, *message;
    } wrong[] = {{"#track 1\nt x\n0 1\n0 2\n", ":4: time 0 s does not follow 0 s"},
                 {"#track 1\nt x\n0 1\n1 1e20\n", ":4: x is 1e+20, at most 1e+15 is expected"},
                 {"#track 1\nt x\n", "this track has no rows"},
                 {"#track 1\nx y\n1 2\n", "t"},
                 {"#track 1\n\nt[s] x[mm]\n0 1\n", ":3: column x has the unit \"mm\", expected m"},
                 {"#track 1\nt[min] x[m]\n0 1\n", ":2: column t has the unit \"min\", expected s"},
                 {"#track 1\nt[s] rz[rad]\n0 1\n", ":2: column rz has the unit \"rad\", expected deg"},
                 {"#track 1\nt[s] foo[m]\n0 1\n",
                  ":2: no column of a motion, expected at least one of x y z rx ry rz"},
                 {"#loads 1\nt x\n1 2\n", "track"}};
    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        fl_track tr = {0};
        fl_err err = {0};
        const char *path = test_file("track", wrong[k].text, strlen(wrong[k].text));
        assert_int_equal(fl_track_read(&tr, path, 1, &err), -1);
        assert_int_equal(err.code, FL_INPUT);
        if (!strstr(err.text, wrong[k].message)) fail_msg("%s", err.text);
        assert_null(tr.t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cubic_is_kept), cmocka_unit_test(velocity_and_acceleration_are_continuous_at_rows),
        cmocka_unit_test(straight_pairs_and_single_rows), cmocka_unit_test(invalid_tracks_are_refused)};
    return cmocka_run_group_tests_name("prescribed_track", tests, NULL, NULL);
}
