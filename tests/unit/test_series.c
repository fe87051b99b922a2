/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/pi.h"
#include "base/rng.h"
#include "stat/resample.h"
#include "stat/series.h"
#include "stat/signal_view.h"
#include "support/near.h"

static fl_err err;
static const fl_record_selection ALL = {.from = -INFINITY, .to = INFINITY};

static int read_text(fl_series *s, const fl_record_selection *selection, const char *data)
{
    err = (fl_err){0};
    return fl_series_read(s, test_file("series", data, strlen(data)), selection, &err);
}

static void expect_message(int code, int line, const char *message)
{
    char expected[1200];
    if (line) snprintf(expected, sizeof expected, "%s:%d: %s", test_path("series"), line, message);
    else snprintf(expected, sizeof expected, "%s: %s", test_path("series"), message);
    assert_int_equal(err.code, code);
    assert_string_equal(err.text, expected);
}

#define HEAD "#loads 1\n#by dem-solve 0.1.0 a.scene\nt[s] part fx[N] fy[N] fz[N] fpeak[N] contacts\n"

static const char TWO[] = HEAD "1 a 3 4 12 20 1\n1 b 0 0 0 0 0\n"
                               "3 b 6 8 0 11 2\n3 a 0 0 0 1 0\n" /* the order of the parts may change */
                               "4 a 1 -2 2 4 1\n4 b -1 2 -2 4 1\n";

static void parts_add_up_to_the_total(void **state)
{
    fl_series s;
    (void)state;
    assert_int_equal(read_text(&s, &ALL, TWO), 0);
    assert_int_equal(s.n, 3);
    assert_int_equal(s.parts, 3);
    assert_int_equal(s.signals, 4);
    assert_string_equal(s.part[2], "total");
    assert_string_equal(s.signal[3], "fh");
    assert_string_equal(s.unit[3], "N");
    assert_string_equal(s.history, "#by dem-solve 0.1.0 a.scene\n");
    assert_memory_equal(s.edge, ((double[]){0, 1, 3, 4}), 4 * sizeof(double));
    assert_memory_equal(s.x[0 * 4 + 3], ((double[]){5, 0, sqrt(5.0)}), 3 * sizeof(double));
    assert_memory_equal(s.x[1 * 4 + 0], ((double[]){0, 6, -1}), 3 * sizeof(double));
    assert_memory_equal(s.x[2 * 4 + 0], ((double[]){3, 6, 0}), 3 * sizeof(double));
    /* the resultant of the sums, not the sum of the resultants */
    assert_memory_equal(s.x[2 * 4 + 3], ((double[]){5, 10, 0}), 3 * sizeof(double));
    fl_series_free(&s);
    assert_null(s.x);
    fl_series_free(&s);
}

static void signals_are_selected(void **state)
{
    const char *const force[] = {"f"}, *const peak[] = {"fpeak", "contacts"}, *const wrong[] = {"fpeek"};
    fl_series s;
    fl_record_selection selection = ALL;
    (void)state;
    selection.part = "b";
    selection.signal = force;
    selection.signals = 1;
    assert_int_equal(read_text(&s, &selection, TWO), 0);
    assert_int_equal(s.parts, 1);
    assert_string_equal(s.part[0], "b");
    assert_memory_equal(s.x[0], ((double[]){0, 10, 3}), 3 * sizeof(double));
    fl_series_free(&s);
    selection.part = "total";
    assert_int_equal(read_text(&s, &selection, TWO), 0);
    assert_int_equal(s.parts, 1);
    assert_memory_equal(s.x[0], ((double[]){13, 10, 0}), 3 * sizeof(double));
    fl_series_free(&s);
    selection.part = NULL;
    selection.signal = peak;
    selection.signals = 2;
    assert_int_equal(read_text(&s, &selection, TWO), 0);
    assert_int_equal(s.parts, 3);
    assert_null(s.x[2 * 2]); /* largest forces of different times do not add up */
    assert_memory_equal(s.x[2 * 2 + 1], ((double[]){1, 2, 2}), 3 * sizeof(double));
    fl_series_free(&s);
    selection.part = "total";
    assert_int_equal(read_text(&s, &selection, TWO), -1);
    assert_int_equal(err.code, FL_USAGE);
    assert_string_equal(err.text, "fpeak has no total: its sum over the parts is meaningless");
    selection.part = NULL;
    selection.signal = wrong;
    selection.signals = 1;
    assert_int_equal(read_text(&s, &selection, TWO), -1);
    expect_message(FL_INPUT, 3, "no column fpeek in this loads table, the nearest is fpeak");
    selection = ALL;
    selection.part = "bb";
    assert_int_equal(read_text(&s, &selection, TWO), -1);
    expect_message(FL_INPUT, 0, "no part bb, the nearest is b");
}

static void selected_intervals(void **state)
{
    fl_series s;
    fl_record_selection selection = ALL;
    (void)state;
    selection.from = 1.0;
    selection.to = 3.0;
    assert_int_equal(read_text(&s, &selection, TWO), 0);
    assert_int_equal(s.n, 1);
    assert_memory_equal(s.edge, ((double[]){1, 3}), 2 * sizeof(double));
    assert_near(s.x[2 * 4][0], 6.0, 0.0);
    fl_series_free(&s);
    selection = ALL;
    selection.last = 3.0;
    assert_int_equal(read_text(&s, &selection, TWO), 0);
    assert_int_equal(s.n, 2);
    fl_series_free(&s);
    selection.last = 0.5; /* no whole interval lies in the last half second */
    assert_int_equal(read_text(&s, &selection, TWO), -1);
    expect_message(FL_INPUT, 0, "no row lies between 3.5 s and 4 s, the record is from 0 s to 4 s");
}

/* A sample represents the time closer to it than to its neighbours. */
static void samples_of_another_table(void **state)
{
    const char *const column[] = {"kinetic"}, *const x[] = {"x"};
    fl_series s;
    fl_record_selection selection = ALL;
    (void)state;
    assert_int_equal(read_text(&s, &selection, "#energy 1\nt[s] kinetic[J]\n0 1\n"), -1);
    expect_message(FL_USAGE, 0, "a column of this energy table must be chosen, it is not loads");
    selection.signal = column;
    selection.signals = 1;
    assert_int_equal(read_text(&s, &selection, "#energy 1\nt[s] kinetic[J]\n0 1\n2 5\n6 7\n"), 0);
    assert_int_equal(s.parts, 1);
    assert_string_equal(s.part[0], "-");
    assert_memory_equal(s.edge, ((double[]){-1, 1, 4, 8}), 4 * sizeof(double));
    fl_series_free(&s);
    assert_int_equal(read_text(&s, &selection, "#energy 1\nt[s] kinetic[J]\n5 1\n"), 0);
    assert_memory_equal(s.edge, ((double[]){4.5, 5.5}), 2 * sizeof(double));
    fl_series_free(&s);
    selection.signal = x;
    selection.part = "7";
    assert_int_equal(read_text(&s, &selection, "#state 1\nt body x[m]\n0 6 1\n0 7 2\n1 6 3\n1 7 4\n"), 0);
    assert_int_equal(s.parts, 1);
    assert_memory_equal(s.x[0], ((double[]){2, 4}), 2 * sizeof(double));
    fl_series_free(&s);
}

static const char TOUCH[] = "#contacts 1\nt[s] i j fn[N] gap[m]\n0 1 2 10 -1\n0 1 -1 30 -2\n"
                            "1 5 2 7 0.5\n"
                            "3 1 2 1 -1\n3 2 4 2 -3\n3 4 -1 4 -2\n";

/* Rows of one time are reduced to one, or selected by a filter. */
static void rows_of_one_time_are_reduced(void **state)
{
    static const double expected[FL_REDUCTIONS][3] = {{0},        {40, 7, 7}, {20, 7, 7.0 / 3.0},
                                                      {10, 7, 1}, {30, 7, 4}, {2, 1, 3}};
    const char *const fn[] = {"fn"}, *const leg[] = {"j=-1"}, *const both[] = {"j=2", "i=1"},
                      *const none[] = {"i=9"}, *const wrong[] = {"i9"};
    fl_series s;
    (void)state;
    fl_record_selection selection = {.signal = fn, .signals = 1, .from = -INFINITY, .to = INFINITY};
    assert_int_equal(read_text(&s, &selection, TOUCH), -1);
    expect_message(FL_INPUT, 4, "several rows at 0 s, and no column part or body tells them apart");
    for (selection.reduction = FL_REDUCE_SUM; selection.reduction < FL_REDUCTIONS; selection.reduction++) {
        assert_int_equal(read_text(&s, &selection, TOUCH), 0);
        assert_int_equal(s.n, 3);
        assert_int_equal(s.parts, 1);
        assert_string_equal(s.part[0], "-");
        assert_string_equal(s.unit[0], selection.reduction == FL_REDUCE_COUNT ? "" : "N");
        assert_memory_equal(s.t, ((double[]){0, 1, 3}), 3 * sizeof(double));
        assert_memory_equal(s.x[0], expected[selection.reduction], 3 * sizeof(double));
        fl_series_free(&s);
    }
    selection.reduction = FL_REDUCE_NONE;
    selection.wheres = 1;
    selection.where = leg;
    assert_int_equal(read_text(&s, &selection, TOUCH), 0);
    assert_memory_equal(s.t, ((double[]){0, 3}), 2 * sizeof(double));
    assert_memory_equal(s.x[0], ((double[]){30, 4}), 2 * sizeof(double));
    fl_series_free(&s);
    selection.wheres = 2;
    selection.where = both;
    assert_int_equal(read_text(&s, &selection, TOUCH), 0);
    assert_memory_equal(s.x[0], ((double[]){10, 1}), 2 * sizeof(double));
    fl_series_free(&s);
    selection.wheres = 1;
    selection.where = none;
    assert_int_equal(read_text(&s, &selection, TOUCH), -1);
    expect_message(FL_INPUT, 8, "the contacts table ends here without a row that meets the conditions");
    selection.where = wrong;
    assert_int_equal(read_text(&s, &selection, TOUCH), -1);
    assert_int_equal(err.code, FL_USAGE);
    /* For a loads table too: then it has no total in addition. */
    selection = (fl_record_selection){.from = -INFINITY, .to = INFINITY, .reduction = FL_REDUCE_MAX};
    assert_int_equal(read_text(&s, &selection, TWO), 0);
    assert_int_equal(s.parts, 1);
    assert_memory_equal(s.x[0], ((double[]){3, 6, 1}), 3 * sizeof(double));
    fl_series_free(&s);
}

static void errors_are_reported(void **state)
{
    static const struct {
        const char *data;
        int line;
        const char *message;
    } bad[] = {
        {HEAD, 3, "the loads table ends here without a row"},
        {HEAD "0 a 1 1 1 1 1\n", 4, "time 0 s does not follow 0 s, where the record starts"},
        {"#loads 1\n#start 5\nt part fx fy fz\n5 a 1 1 1\n", 4,
         "time 5 s does not follow 5 s, where the record starts"},
        {HEAD "1 a 1 1 1 1 1\n2 a 1 1 1 1 1\n1.5 a 1 1 1 1 1\n", 6, "time 1.5 s does not follow 2 s"},
        {HEAD "1 a 1 1 1 1 1\n1 a 1 1 1 1 1\n", 0, "a has two rows at 1 s"},
        {HEAD "1 a 1 1 1 1 1\n2 a 1 1 1 1 1\n2 a 1 1 1 1 1\n", 6, "a has two rows at 2 s"},
        {HEAD "1 a 1 1 1 1 1\n1 b 1 1 1 1 1\n2 a 1 1 1 1 1\n", 6, "b has no row at 2 s"},
        {HEAD "1 a 1 1 1 1 1\n2 a 1 1 1 1 1\n2 b 1 1 1 1 1\n", 6, "b was not there at 1 s"},
        {HEAD "1 a nan 1 1 1 1\n", 4, "fx is \"nan\", a finite number is expected"},
        {HEAD "1 a 1e101 1 1 1 1\n", 4, "fx is 1e+101, expected at most 1e+100"},
        {HEAD "inf a 1 1 1 1 1\n", 4, "t is \"inf\", a finite number is expected"},
        {HEAD "1 a 1 1\n", 4, "4 fields, expected 7, one for each column"},
        {HEAD "1 a 1 1 1 1 1\n1 total 1 1 1 1 1\n", 0,
         "a part is called total, the name of the sum over the parts"},
        {"#loads 1\nt part fx fz\n1 a 1 1\n", 2, "no column fy in this loads table, the nearest is fx"},
        {"#loads 1\nt fx fy fz\n1 1 1 1\n", 2, "no column part in this loads table, the nearest is t"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        fl_series s;
        assert_int_equal(read_text(&s, &ALL, bad[k].data), -1);
        expect_message(FL_INPUT, bad[k].line, bad[k].message);
        assert_null(s.x);
    }
}

static void one_part_called_total_is_the_total(void **state)
{
    fl_series s;
    (void)state;
    assert_int_equal(read_text(&s, &ALL, HEAD "1 total 3 4 0 0 0\n"), 0);
    assert_int_equal(s.parts, 1);
    assert_string_equal(s.part[0], "total");
    assert_near(s.x[3][0], 5.0, 1e-15);
    fl_series_free(&s);
}

/* Unequal intervals onto equal ones: the impulse, and so the mean, is what it was, and a constant is a
 * constant. */
static void resampling_keeps_the_impulse(void **state)
{
    enum { N = 200, M = 373 };
    double edge[N + 1] = {3.0}, x[N], even[M + 1], y[M], before = 0.0, after = 0.0;
    (void)state;
    for (int run = 0; run < 50; run++) {
        fl_rng g = fl_rng_of(test_seed(), run, FL_RNG_TEST);
        const int m = 1 + (int)fl_rng_in(&g, 0.0, M - 1);
        for (int k = 0; k < N; k++) {
            edge[k + 1] = edge[k] + pow(10.0, fl_rng_in(&g, -3.0, 0.0));
            x[k] = fl_rng_in(&g, -1.0, 1.0);
        }
        fl_resample_means(N, edge, x, m, even, y);
        before = after = 0.0;
        for (int k = 0; k < N; k++) before += x[k] * (edge[k + 1] - edge[k]);
        for (int k = 0; k < m; k++) after += y[k] * (even[k + 1] - even[k]);
        assert_near_of(after, before, 1e-13, edge[N]);
        assert_near(even[m], edge[N], 0.0);
        for (int k = 0; k < N; k++) x[k] = 0.3;
        fl_resample_means(N, edge, x, m, even, y);
        for (int k = 0; k < m; k++) assert_near(y[k], 0.3, 1e-14);
    }
    fl_resample_means(3, (double[]){0, 1, 3, 4}, (double[]){3, 6, 0}, 2, even, y);
    assert_memory_equal(y, ((double[]){4.5, 3}), 2 * sizeof(double));
    assert_near(fl_resample_common_interval(3, (double[]){0, 1, 3, 4}), 0.0, 0.0);
    assert_near(fl_resample_common_interval(3, (double[]){1, 1.5, 2, 2.5}), 0.5, 1e-15);
}

/* The filtered view of a record of unequal intervals has the mean and the slow wave of the record. */
static void filtered_view(void **state)
{
    enum { N = 4000 };
    char *data = malloc(N * 80);
    const double p[] = {0.5}, w = 2.0 * PI * 0.2;
    const char *const column[] = {"fx"};
    int n = sprintf(data, "#loads 1\nt[s] part fx[N]\n");
    double t = 0.0;
    fl_series s;
    fl_signal_view raw, slow;
    fl_record_selection selection = ALL;
    fl_signal_view_settings how = {.filter = 2.0, .order = 4, .ratio = 0.5, .quantiles = 1, .p = p};
    (void)state;
    for (int k = 0; k < N; k++) {
        const double dt = k % 3 ? 0.01 : 0.02, mean = (cos(w * t) - cos(w * (t + dt))) / (w * dt);
        t += dt;
        n += sprintf(data + n, "%.17g a %.17g\n", t, 10.0 + mean + (k % 2 ? 0.5 : -0.5));
    }
    selection.signal = column;
    selection.signals = 1;
    assert_int_equal(read_text(&s, &selection, data), 0);
    free(data);
    assert_int_equal(fl_signal_view_make(&slow, &s, 0, 0, &how, &err), 0);
    how.filter = 0.0;
    assert_int_equal(fl_signal_view_make(&raw, &s, 0, 0, &how, &err), 0);
    assert_ptr_equal(raw.x, s.x[0]);
    assert_near_of(slow.stats.mean, raw.stats.mean, 2e-3, 10.0);
    for (int32_t k = N / 4; k < 3 * N / 4; k++) {
        const double middle = 0.5 * (slow.edge[k] + slow.edge[k + 1]);
        assert_near_of(slow.x[k], 10.0 + sin(w * middle), 0.01, 1.0);
    }
    assert_near(slow.t[N - 1], slow.edge[N], 0.0);
    assert_near(slow.peak_value[0], 11.0, 2e-3);
    fl_signal_view_free(&raw);
    how.filter = 60.0;
    fl_signal_view_free(&slow);
    assert_int_equal(fl_signal_view_make(&slow, &s, 0, 0, &how, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    fl_signal_view_free(&slow);
    fl_series_free(&s);
}

static int remove_files(void **state)
{
    (void)state;
    unlink(test_path("series"));
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(parts_add_up_to_the_total),
                                       cmocka_unit_test(signals_are_selected),
                                       cmocka_unit_test(selected_intervals),
                                       cmocka_unit_test(samples_of_another_table),
                                       cmocka_unit_test(rows_of_one_time_are_reduced),
                                       cmocka_unit_test(errors_are_reported),
                                       cmocka_unit_test(one_part_called_total_is_the_total),
                                       cmocka_unit_test(resampling_keeps_the_impulse),
                                       cmocka_unit_test(filtered_view)};
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
