/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/array.h"
#include "stat/rainflow.h"
#include "stat/run_summary.h"
#include "support/near.h"

static fl_err err;
static const fl_record_selection FX = {
    .signal = (const char *const[]){"fx"}, .signals = 1, .from = -INFINITY, .to = INFINITY};
static const fl_summary_settings HOW = {.separation = 0.5};

/* A loads table of one part, equal intervals of 0.5 s, from the values of fx. */
static const char *write_record(const char *name, int n, const double *fx)
{
    char *text = malloc((size_t)(40 * n + 100));
    int len = sprintf(text, "#loads 1\n#by test 1\nt part fx[N]\n");
    for (int k = 0; k < n; k++) len += sprintf(text + len, "%g leg %.17g\n", 0.5 * (k + 1), fx[k]);
    const char *path = test_file(name, text, (size_t)len);
    free(text);
    return path;
}

static void run_to_end(fl_run *r, const char *path, const fl_record_selection *selection,
                       const fl_summary_settings *how)
{
    int more;
    err = (fl_err){0};
    assert_int_equal(fl_run_open(r, path, selection, how, &err), 0);
    while ((more = fl_run_next(r, &err)) > 0) {}
    assert_int_equal(more, 0);
    assert_int_equal(fl_run_finish(r, "#by loadstats --summary\n", &err), 0);
    unlink(path);
}

/* number of half cycles with a range in the bin of x */
static int64_t cycles_in_bin(const fl_summary_signal *s, double x)
{
    for (int32_t k = 0; k < s->cycle.cap; k++)
        if (s->cycle.slot[k].n && s->cycle.slot[k].key == fl_log_bin_key(x)) return s->cycle.slot[k].n;
    return 0;
}

/* The sequence of ASTM E1049: ranges 3, 4, 6, 8, 9 are counted 0.5, 1.5, 0.5, 1, 0.5 times. */
static void cycles(void **state)
{
    const double fx[] = {-2, 1, -3, 5, -1, 3, -4, 4, -2}, range[] = {3, 4, 6, 8, 9};
    const int64_t astm[] = {1, 3, 1, 2, 1};
    fl_run r = {0};
    (void)state;
    run_to_end(&r, write_record("astm", 9, fx), &FX, &HOW);
    assert_int_equal(r.sum.entry[0].cycle.n, 5);
    for (int k = 0; k < 5; k++) assert_int_equal(cycles_in_bin(&r.sum.entry[0], range[k]), astm[k]);
    fl_run_close(&r);
    /* Four points, the residue left out: one cycle of range 4. */
    const fl_summary_settings four = {
        .separation = 0.5, .rule = FL_RAINFLOW_FOUR_POINT, .residue = FL_RESIDUE_NONE};
    run_to_end(&r, write_record("iso", 9, fx), &FX, &four);
    assert_int_equal(r.sum.entry[0].cycle.n, 1);
    assert_int_equal(cycles_in_bin(&r.sum.entry[0], 4.0), 2);
    fl_run_close(&r);
}

static void blocks_and_extremes(void **state)
{
    const double fx[] = {1, 5, 2, 2, -7, -3, 9, 9, 4, 8};
    const fl_summary_settings how = {.separation = 0.5, .block = 2.0};
    fl_run r = {0};
    (void)state;
    run_to_end(&r, write_record("blocks", 10, fx), &FX, &how);
    assert_int_equal(r.sum.n, 2); /* leg, and the total, which is the same */
    for (int k = 0; k < 2; k++) {
        fl_summary_signal *s = &r.sum.entry[k];
        double moment[4];
        assert_string_equal(s->part, k ? "total" : "leg");
        assert_int_equal(s->rows, 10);
        assert_true(s->from == 0.0 && s->to == 5.0);
        assert_true(s->min == -7.0 && s->t_min == 2.5 && s->max == 9.0 && s->t_max == 3.5);
        fl_multiset_sort(&s->block); /* 5, 9; the half block at the end is none */
        assert_int_equal(s->block.n, 2);
        assert_true(s->block.v[0].x == 5.0 && s->block.v[1].x == 9.0);
        assert_int_equal(s->peaks, 2); /* 5 and the 9 */
        assert_true(fl_exact_value(&s->peak_sum) == 14.0);
        fl_summary_moments(s, moment);
        assert_true(moment[0] == 3.0);
        assert_true(s->run[FL_RUN_MEAN].v[0].x == 3.0 && s->run[FL_RUN_MAX].v[0].x == 9.0);
    }
    assert_string_equal(r.sum.history, "#by test 1\n#by loadstats --summary\n");
    fl_run_close(&r);
    /* A selected interval, where blocks start at its beginning. */
    fl_record_selection selection = FX;
    selection.from = 1.0;
    selection.to = 4.0;
    run_to_end(&r, write_record("cut", 10, fx), &selection, &how);
    assert_int_equal(r.sum.entry[0].rows, 6);
    assert_int_equal(fl_multiset_size(&r.sum.entry[0].block), 1);
    assert_true(r.sum.entry[0].block.v[0].x == 2.0);
    fl_run_close(&r);
}

static void errors_are_reported(void **state)
{
    const double fx[] = {1, 2, 3};
    fl_record_selection selection = FX;
    fl_run r = {0};
    char expected[900];
    (void)state;
    selection.from = 10.0;
    const char *path = write_record("late", 3, fx);
    err = (fl_err){0};
    assert_int_equal(fl_run_open(&r, path, &selection, &HOW, &err), 0);
    assert_int_equal(fl_run_next(&r, &err), 0);
    assert_int_equal(fl_run_finish(&r, "", &err), -1);
    snprintf(expected, sizeof expected, "%s: the cut leaves no row, the record ends at 1.5 s", path);
    assert_string_equal(err.text, expected);
    fl_run_close(&r);
    unlink(path);
    const char text[] = "#other 1\nt fx\n0 1\n1e14 2\n3e14 1\n";
    path = test_file("long", text, sizeof text - 1);
    err = (fl_err){0};
    assert_int_equal(fl_run_open(&r, path, &FX, &HOW, &err), 0);
    assert_int_equal(fl_run_next(&r, &err), -1);
    snprintf(expected, sizeof expected, "%s: a row lasts for 1e+14 s, at most 1.09951e+12 s can be summed up",
             path);
    assert_string_equal(err.text, expected);
    assert_int_equal(err.code, FL_INPUT);
    fl_run_close(&r);
    unlink(path);
}

/* Once all values have occurred, further rows allocate nothing: memory does not grow with the record. */
static void memory_is_constant(void **state)
{
    enum { PERIOD = 500, FIRST = 5000, ROWS = 100000 };
    double *fx = malloc(ROWS * sizeof *fx);
    fl_run r = {0};
    int more;
    (void)state;
    for (int k = 0; k < ROWS; k++) {
        const int i = k % PERIOD;
        fx[k] = 1e4 * sin(0.37 * i) * sin(0.011 * i * i);
    }
    const char *path = write_record("rows", ROWS, fx);
    err = (fl_err){0};
    assert_int_equal(fl_run_open(&r, path, &FX, &HOW, &err), 0);
    for (int k = 0; k < FIRST; k++) assert_int_equal(fl_run_next(&r, &err), 1);
    fl_alloc_fail_after(0);
    while ((more = fl_run_next(&r, &err)) > 0) {}
    fl_alloc_fail_after(-1);
    assert_string_equal(err.text, "");
    assert_int_equal(more, 0);
    assert_int_equal(fl_run_finish(&r, "", &err), 0);
    assert_int_equal(r.sum.entry[0].rows, ROWS);
    fl_run_close(&r);
    unlink(path);
    free(fx);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(cycles), cmocka_unit_test(blocks_and_extremes),
                                       cmocka_unit_test(errors_are_reported),
                                       cmocka_unit_test(memory_is_constant)};
    return cmocka_run_group_tests_name("run_summary", tests, NULL, NULL);
}
