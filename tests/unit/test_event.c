/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/rng.h"
#include "stat/event.h"
#include "support/near.h"

static void make_peaks(int32_t n, const double *x, fl_peaks *p)
{
    fl_err err = {0};
    assert_int_equal(fl_peaks_rayleigh(n, x, 0.5, 0.0, p, &err), 0);
}

/* 0 2 4 6 8 10 5 0: at 1 s a row the rise takes 5 s, the fall 2 s. */
static void triangle_by_hand(void **state)
{
    const double x[] = {0, 2, 4, 6, 8, 10, 5, 0}, edge[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    fl_peaks p = {0};
    (void)state;
    make_peaks(8, x, &p);
    assert_int_equal(p.n, 1);
    const fl_event e = fl_event_of(8, x, edge, &p, 0, 0.5);
    assert_int_equal(e.first, 0);
    assert_int_equal(e.peak, 5);
    assert_int_equal(e.last, 7);
    assert_near(e.rise, 4.0, 1e-15);     /* 0.8 of 5 s */
    assert_near(e.fall, 1.6, 1e-15);     /* 0.8 of 2 s */
    assert_near(e.duration, 3.5, 1e-15); /* from 2.5 s before to 1 s after */
    assert_near(e.impulse, 35.0, 1e-15);
    assert_near(fl_event_impulse(8, x, edge), 35.0, 1e-15);
    assert_near(fl_event_time_above(8, x, edge, 5.0), 3.0, 1e-15); /* 5 is not above 5 */
    fl_peaks_free(&p);
}

/* Two peaks over a trough of 2, and values below 0, which do not count as a foot. */
static void trough_and_foot_by_hand(void **state)
{
    const double x[] = {-4, 6, 2, 2, 10, -10}, edge[] = {0, 2, 4, 6, 8, 10, 12};
    fl_peaks p = {0};
    (void)state;
    make_peaks(6, x, &p);
    assert_int_equal(p.n, 2);
    const fl_event a = fl_event_of(6, x, edge, &p, 0, 0.5), b = fl_event_of(6, x, edge, &p, 1, 0.5);
    assert_int_equal(a.last, 2);
    assert_int_equal(b.first, 3);
    assert_near(a.rise, 2.0 * 0.8 * 6.0 / 10.0, 1e-14); /* from 0.6 to 5.4 on a line of 10 in 2 s */
    assert_near(a.fall, 2.0 * 0.8, 1e-14);              /* from 5.6 to 2.4 on a line of 4 in 2 s */
    assert_near(b.rise, 2.0 * 0.8, 1e-14);              /* from 2.8 to 9.2 on a line of 8 in 2 s */
    assert_near(b.fall, 2.0 * 0.8 * 10.0 / 20.0, 1e-14);
    assert_near(a.duration, 2.0 * (3.0 / 10.0 + 3.0 / 4.0), 1e-14);
    assert_near(b.duration, 2.0 * (5.0 / 8.0 + 5.0 / 20.0), 1e-14);
    /* The first peak does not fall to a tenth of its height: it counts to the end of the event. */
    const fl_event c = fl_event_of(6, x, edge, &p, 0, 0.1);
    assert_near(c.duration, 6.0 - (3.0 - 2.0 * 5.4 / 10.0), 1e-14);
    fl_peaks_free(&p);
}

/* Every row is in one event, impulses add up, times follow the time scale and do not depend on the load
 * scale. */
static void random_records_are_covered_by_events(void **state)
{
    enum { N = 200 };
    (void)state;
    for (int trial = 0; trial < test_times(200); trial++) {
        fl_rng g = fl_rng_of(test_seed(), trial, FL_RNG_TEST);
        double x[N], y[N], edge[N + 1], twice[N + 1], sum = 0.0, size = 0.0;
        const double factor = exp(fl_rng_in(&g, -20.0, 20.0)), level = fl_rng_in(&g, 0.01, 0.99);
        fl_peaks p = {0};
        edge[0] = twice[0] = 0.0;
        for (int k = 0; k < N; k++) {
            x[k] = fl_rng_unit(&g) < 0.3 ? 0.0 : fl_rng_in(&g, -1.0, 3.0);
            y[k] = factor * x[k];
            edge[k + 1] = edge[k] + fl_rng_in(&g, 0.5, 1.5);
            twice[k + 1] = 2.0 * edge[k + 1];
            size += fabs(x[k]) * (edge[k + 1] - edge[k]);
        }
        make_peaks(N, x, &p);
        int32_t next = 0;
        for (int32_t k = 0; k < p.n; k++) {
            const fl_event e = fl_event_of(N, x, edge, &p, k, level),
                           h = fl_event_of(N, y, twice, &p, k, level);
            assert_int_equal(e.first, next);
            assert_true(e.first <= e.peak && e.peak <= e.last);
            assert_true(e.rise > 0.0 && e.fall > 0.0 && e.duration > 0.0);
            assert_near(h.rise, 2.0 * e.rise, 1e-9);
            assert_near(h.fall, 2.0 * e.fall, 1e-9);
            assert_near(h.duration, 2.0 * e.duration, 1e-9);
            next = e.last + 1;
            sum += e.impulse;
        }
        if (p.n > 0) {
            assert_int_equal(next, N);
            assert_near_of(sum, fl_event_impulse(N, x, edge), 1e-13, size);
        }
        fl_peaks_free(&p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(triangle_by_hand),
                                       cmocka_unit_test(trough_and_foot_by_hand),
                                       cmocka_unit_test(random_records_are_covered_by_events)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
