/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "stat/pressure.h"
#include "support/near.h"

static fl_contact_event event_at(double x, double y, double z, double normal_load)
{
    return (fl_contact_event){.part = -1, .p = v3(x, y, z), .n = v3(1, 0, 0), .normal_force = normal_load};
}

static fl_window best_window(int32_t n, const fl_contact_event *touch_event, double area)
{
    fl_window_work w = {0};
    fl_window best;
    fl_err err = {0};
    assert_int_equal(fl_largest_load_window(n, touch_event, -1, area, &best, &w, &err), 0);
    fl_window_work_free(&w);
    return best;
}

/* Three contacts on a wall, 1 m apart on a line: a disc smaller than 1 m holds one, of 1 m two. */
static void a_window_holds_the_contacts_that_fit(void **state)
{
    const fl_contact_event touch_event[] = {event_at(0, 0, 0, 5), event_at(0, 1, 0, 4), event_at(0, 2, 0, 8)};
    (void)state;
    fl_window b = best_window(3, touch_event, PI * 0.499 * 0.499);
    assert_near(b.force, 8.0, 1e-15);
    assert_int_equal(b.contacts, 1);
    assert_near(b.centre.y, 2.0, 1e-12);
    b = best_window(3, touch_event, PI * 0.501 * 0.501);
    assert_near(b.force, 12.0, 1e-15);
    assert_int_equal(b.contacts, 2);
    assert_true(b.centre.y > 1.4 && b.centre.y < 1.6 && fabs(b.centre.z) < 0.05);
    b = best_window(3, touch_event, PI * 1.001 * 1.001);
    assert_near(b.force, 17.0, 1e-15);
    assert_int_equal(best_window(0, touch_event, 1.0).contacts, 0);
}

/* A contact spread over an area or along a line gives a small window its share. A tensile contact gives none,
 * nor do another part and the other side of a thin wall. */
static void shares_and_sides(void **state)
{
    fl_contact_event touch_event[] = {event_at(0, 0, 0, 10), event_at(0, 0.1, 0, 6), event_at(0, 0, 0.1, -3),
                                      event_at(0, 0, 0, 7), event_at(0.01, 0, 0, 9)};
    (void)state;
    touch_event[0].area = 4.0;
    touch_event[1].length = 2.0;
    touch_event[3].part = -2;
    touch_event[4].n = v3(-1, 0, 0);
    const double area = PI * 0.25; /* 1 m across */
    assert_near(best_window(2, touch_event, area).force, 10.0 * area / 4.0 + 3.0, 1e-15);
    assert_near(best_window(5, touch_event, area).force, 9.0, 1e-15); /* the other side has a larger load */
    touch_event[4].normal_force = 1.0;
    assert_near(best_window(5, touch_event, area).force, 10.0 * area / 4.0 + 3.0, 1e-15);
    assert_near(best_window(3, touch_event, 100.0).force, 16.0, 1e-15);
}

/* On random walls no disc of a fine grid of centres has a larger load than the window, and the window has
 * that load. */
static void no_disc_has_a_larger_load(void **state)
{
    enum { N = 12, GRID = 60 };
    (void)state;
    for (int trial = 0; trial < test_times(40); trial++) {
        fl_rng g = fl_rng_of(test_seed(), trial, FL_RNG_TEST);
        const fl_vec3 n = v3_unit(v3(fl_rng_normal(&g), fl_rng_normal(&g), fl_rng_normal(&g)));
        const fl_vec3 e = v3_normal_to(n), f = v3_cross(n, e);
        const double r = fl_rng_in(&g, 0.05, 0.6);
        double u[N], v[N], largest = 0.0, inside = 0.0;
        fl_contact_event touch_event[N];
        for (int k = 0; k < N; k++) {
            u[k] = fl_rng_unit(&g);
            v[k] = fl_rng_unit(&g);
            touch_event[k] = (fl_contact_event){.part = -1, .n = n, .normal_force = fl_rng_in(&g, 0.5, 2.0)};
            touch_event[k].p = v3_add(v3_scale(u[k], e), v3_scale(v[k], f));
        }
        const fl_window b = best_window(N, touch_event, PI * r * r);
        for (int i = -GRID / 4; i <= GRID * 5 / 4; i++) {
            for (int j = -GRID / 4; j <= GRID * 5 / 4; j++) {
                double sum = 0.0;
                for (int k = 0; k < N; k++)
                    if (hypot(u[k] - (double)i / GRID, v[k] - (double)j / GRID) <= r)
                        sum += touch_event[k].normal_force;
                largest = fmax(largest, sum);
            }
        }
        for (int k = 0; k < N; k++)
            if (v3_norm(v3_sub(touch_event[k].p, b.centre)) <= r * (1.0 + 1e-9))
                inside += touch_event[k].normal_force;
        assert_true(b.force >= largest * (1.0 - 1e-12));
        assert_near(inside, b.force, 1e-9);
    }
}

static void fits_and_reference(void **state)
{
    const double area[] = {0.1, 1.0, 10.0, 100.0},
                 p[] = {3e6 * pow(0.1, -0.7), 3e6, 3e6 * pow(10.0, -0.7), 0.0};
    double c, k;
    (void)state;
    assert_int_equal(fl_pressure_fit(4, area, p, &c, &k), 3);
    assert_near(c, 3e6, 1e-12);
    assert_near(k, 0.7, 1e-12);
    assert_int_equal(fl_pressure_fit(1, area, p, &c, &k), 1);
    assert_true(isnan(c) && isnan(k));
    assert_near(fl_pressure_iso19906(1.0), 7.4e6, 1e-15);
    assert_near(fl_pressure_iso19906(10.0), 1.4765e6, 1e-4);
    assert_near(fl_pressure_iso19906(11.0), 1.48e6, 1e-15);
}

static const char HEAD[] = "#contacts 1\nt[s] i j mode gap[m] nx ny nz px[m] py[m] pz[m] length[m] area[m2] "
                           "fn[N] fsx[N] fsy[N] fsz[N]\n";

static int read_all(const char *rows, const fl_contact_selection *selection, fl_contact_events *h,
                    int32_t *touch_events, fl_err *err)
{
    char text[4000];
    int more;
    snprintf(text, sizeof text, "%s%s", HEAD, rows);
    *touch_events = 0;
    if (fl_contact_events_open(h, test_file("touch.contacts", text, strlen(text)), selection, err)) return -1;
    while ((more = fl_contact_events_next(h, err)) > 0) *touch_events += h->n;
    return more;
}

/* Times without contact are missing in the table, but are counted. */
static void contact_tables_are_read(void **state)
{
    static const char rows[] =
        "0.1 1 2 FF 0 1 0 0 0 0 0 0 0 9 0 0 0\n0.2 1 -1 FF 0 1 0 0 1 2 3 0 0.5 9 0 -2 1\n"
        "0.2 2 -2 VF 0 0 1 0 1 2 3 0 0 4 0 0 0\n0.5 1 -1 VF 0 1 0 0 1 2 3 0 0 9 0 0 0\n"
        "0.6 3 4 VF 0 1 0 0 1 2 3 0 0 9 0 0 0\n";
    fl_contact_selection selection = {.from = -INFINITY, .to = INFINITY};
    fl_contact_events h = {0};
    fl_err err = {0};
    int64_t times;
    int32_t touch_events;
    double step;
    (void)state;
    assert_int_equal(read_all(rows, &selection, &h, &touch_events, &err), 0);
    assert_int_equal(touch_events, 3);
    assert_int_equal(h.times, 4);
    assert_int_equal(fl_contact_events_span(&h, &times, &step, &err), 0);
    assert_int_equal(times, 6);
    assert_near(step, 0.1, 1e-12);
    fl_contact_events_close(&h);
    selection = (fl_contact_selection){.from = 0.15, .to = 0.25, .part = -1};
    assert_int_equal(fl_contact_events_open(&h, test_path("touch.contacts"), &selection, &err), 0);
    assert_int_equal(fl_contact_events_next(&h, &err), 1);
    assert_int_equal(h.n, 1);
    assert_near(h.event[0].normal_force, 9.0, 0.0);
    assert_near(h.event[0].force.x, -9.0, 0.0); /* on the structure, against the normal */
    assert_near(h.event[0].force.y, 2.0, 0.0);
    assert_near(h.event[0].area, 0.5, 0.0);
    assert_int_equal(fl_contact_events_next(&h, &err), 0);
    fl_contact_events_close(&h);
}

static void bad_contacts_are_refused(void **state)
{
    static const char *const rows[] = {
        "0.2 1 -1 FF 0 1 0 0 1 2 3 0 0 9 0 0 0\n0.1 1 -1 FF 0 1 0 0 1 2 3 0 0 9 0 0 0\n",
        "0.2 1 -1 FF 0 2 0 0 1 2 3 0 0 9 0 0 0\n", "0.2 1 -1 FF 0 1 0 0 1 2 3 0 -1 9 0 0 0\n",
        "0.2 1 -1 FF 0 1 0 0 1 2 3 0 0 1e200 0 0 0\n", ""};
    static const char *const message[] = {"time 0.1 s comes after 0.2 s", "the normal has the length 2",
                                          "expected not below 0", "at most 1e+100 is expected",
                                          "no row lies"};
    const fl_contact_selection selection = {.from = -INFINITY, .to = INFINITY};
    (void)state;
    for (int k = 0; k < 5; k++) {
        fl_contact_events h = {0};
        fl_err err = {0};
        int32_t touch_events;
        assert_int_equal(read_all(rows[k], &selection, &h, &touch_events, &err), -1);
        assert_int_equal(err.code, FL_INPUT);
        assert_non_null(strstr(err.text, message[k]));
        fl_contact_events_close(&h);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_window_holds_the_contacts_that_fit),
                                       cmocka_unit_test(shares_and_sides),
                                       cmocka_unit_test(no_disc_has_a_larger_load),
                                       cmocka_unit_test(fits_and_reference),
                                       cmocka_unit_test(contact_tables_are_read),
                                       cmocka_unit_test(bad_contacts_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
