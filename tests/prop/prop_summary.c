/* SPDX-License-Identifier: GPL-3.0-or-later */
/* prop_summary.c -- summaries of runs may be merged in any order and in any groups, through files or not,
 * and give the bytes of one pass over all runs.  The summary of one run agrees with its whole record. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/number_text.h"
#include "base/rng.h"
#include "stat/descriptive_stats.h"
#include "stat/peaks.h"
#include "stat/rainflow.h"
#include "stat/run_summary.h"
#include "stat/sample.h"
#include "stat/series.h"
#include "stat/summary_file.h"
#include "support/near.h"

enum { RUNS = 7, TEXT = 1 << 20 };

static fl_err err;
static long current_case;

static void check_result(int rc)
{
    if (rc == 0) return;
    print_error("seed %llu case %ld: %s\n", (unsigned long long)test_seed(), current_case, err.text);
    fail();
}

/* A record of one or two parts, with equal or unequal intervals, runs of zeros and of equal values, and
 * magnitudes that differ by many powers of ten. */
static const char *write_record(fl_rng *g, int run)
{
    char name[40], buf[2][FL_NUMBER_LEN];
    snprintf(name, sizeof name, "run%d", run);
    const char *path = test_path(name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    const int loads = fl_rng_unit(g) < 0.7, rows = 1 + (int)fl_rng_in(g, 0.0, 300.0),
              even = fl_rng_unit(g) < 0.5;
    const int parts = loads && fl_rng_unit(g) < 0.5 ? 2 : 1;
    const double size = pow(10.0, fl_rng_in(g, -6.0, 9.0)), mean = fl_rng_in(g, -3.0, 3.0) * size;
    double t = 0.0;
    fprintf(f, "#%s 1\n#by test 1 --seed %d\nt[s]\t%sfx[N]\n", loads ? "loads" : "other", run,
            loads ? "part\t" : "");
    for (int k = 0; k < rows; k++) {
        t += even ? 0.01 : fl_rng_in(g, 0.001, 0.1);
        for (int p = 0; p < parts; p++) {
            double x = fl_rng_unit(g) < 0.3 ? 0.0 : mean + size * fl_rng_normal(g);
            if (fl_rng_unit(g) < 0.1) x = floor(x);
            fprintf(f, "%s\t%s%s\n", fl_number_text(t, buf[0]), loads ? (p ? "b\t" : "a\t") : "",
                    fl_number_text(x, buf[1]));
        }
    }
    assert_int_equal(fclose(f), 0);
    return path;
}

static void reduce(fl_summary *s, const char *path, const fl_record_selection *ask,
                   const fl_summary_settings *how)
{
    fl_run r = {0};
    int more;
    check_result(fl_run_open(&r, path, ask, how, &err));
    while ((more = fl_run_next(&r, &err)) > 0) {}
    check_result(more);
    check_result(fl_run_finish(&r, "#by loadstats --summary\n", &err));
    check_result(fl_summary_merge(s, &r.sum, path, &err));
    fl_run_close(&r);
}

static void text_of(fl_summary *s, char *text)
{
    FILE *f = fmemopen(text, TEXT, "w");
    assert_non_null(f);
    check_result(fl_summary_write(f, s, &err));
    assert_true(ftell(f) < TEXT - 1);
    fclose(f);
}

/* Merges the runs from lo on in a tree of random shape, some of its nodes through a file. */
static void merge_randomly(fl_rng *g, fl_summary *s, const fl_summary *run, const int *order, int lo, int hi)
{
    static char text[TEXT];
    if (hi - lo == 1) {
        check_result(fl_summary_merge(s, &run[order[lo]], "run", &err));
    } else {
        const int cut = lo + 1 + (int)fl_rng_in(g, 0.0, hi - lo - 1.0);
        fl_summary a = {0}, b = {0};
        merge_randomly(g, &a, run, order, lo, cut);
        merge_randomly(g, &b, run, order, cut, hi);
        check_result(fl_summary_merge(&a, &b, "b", &err));
        if (fl_rng_unit(g) < 0.5) {
            text_of(&a, text);
            const char *path = test_file("node", text, strlen(text));
            fl_summary_free(&a);
            check_result(fl_summary_read(&a, path, &err));
            unlink(path);
        }
        check_result(fl_summary_merge(s, &a, "a", &err));
        fl_summary_free(&a);
        fl_summary_free(&b);
    }
}

static void any_merge_order_gives_the_same_bytes(void **state)
{
    static char first[TEXT], other[TEXT];
    const fl_record_selection ask = {
        .signal = (const char *const[]){"fx"}, .signals = 1, .from = -INFINITY, .to = INFINITY};
    (void)state;
    for (current_case = 0; current_case < test_times(20); current_case++) {
        fl_rng g = fl_rng_of(test_seed(), current_case, FL_RNG_TEST);
        const fl_summary_settings how = {
            .separation = 0.5, .block = current_case % 2 ? 0.35 : 0.0, .rule = (int)(current_case % 3 == 1)};
        fl_summary run[RUNS], all = {0};
        memset(run, 0, sizeof run);
        int order[RUNS];
        for (int k = 0; k < RUNS; k++) {
            const char *path = write_record(&g, k);
            order[k] = k;
            reduce(&run[k], path, &ask, &how);
            reduce(&all, path, &ask, &how); /* one pass over all, run by run */
            unlink(path);
        }
        text_of(&all, first);
        for (int again = 0; again < 4; again++) {
            fl_summary s = {0};
            for (int k = RUNS - 1; k > 0; k--) {
                const int j = (int)fl_rng_in(&g, 0.0, k + 1.0), swap = order[k];
                order[k] = order[j];
                order[j] = swap;
            }
            merge_randomly(&g, &s, run, order, 0, RUNS);
            text_of(&s, other);
            if (strcmp(first, other) != 0) {
                print_error("seed %llu case %ld: order %d gives another summary\n",
                            (unsigned long long)test_seed(), current_case, again);
                fail();
            }
            fl_summary_free(&s);
        }
        for (int k = 0; k < RUNS; k++) fl_summary_free(&run[k]);
        fl_summary_free(&all);
    }
}

static int64_t half_cycles(const fl_rainflow *f)
{
    int64_t n = 0;
    for (int32_t k = 0; k < f->cycles; k++) n += f->cycle[k].count < 0.75 ? 1 : 2;
    return n;
}

/* The same record whole in memory. */
static void a_summary_agrees_with_the_record(void **state)
{
    (void)state;
    for (current_case = 0; current_case < test_times(100); current_case++) {
        fl_rng g = fl_rng_of(test_seed() + 1, current_case, FL_RNG_TEST);
        const char *const fx[] = {"fx"};
        fl_record_selection ask = {.signal = fx, .signals = 1, .from = -INFINITY, .to = INFINITY};
        const fl_summary_settings how = {
            .separation = 0.5, .threshold = current_case % 2 ? 1.0 : 0.0, .block = 0.2};
        const char *path = write_record(&g, 0);
        fl_summary sum = {0};
        fl_series s = {0};
        if (current_case % 3 == 1) ask.from = 0.5;
        if (current_case % 4 == 1) ask.to = 1.5;
        if (fl_series_read(&s, path, &ask, &err)) { /* a record too short for the filter */
            assert_int_equal(err.code, FL_INPUT);
            fl_run r = {0};
            fl_err refusal = {0};
            assert_int_equal(fl_run_open(&r, path, &ask, &how, &refusal), 0);
            assert_int_equal(fl_run_next(&r, &refusal), 0);
            assert_int_equal(fl_run_finish(&r, "", &refusal), -1);
            assert_int_equal(refusal.code, FL_INPUT);
            fl_run_close(&r);
            err = (fl_err){0};
            unlink(path);
            continue;
        }
        reduce(&sum, path, &ask, &how);
        unlink(path);
        assert_int_equal(sum.n, s.parts);
        for (int32_t p = 0; p < s.parts; p++) {
            const fl_summary_signal *t = &sum.entry[p];
            const double *x = s.x[p];
            double w[400], moment[4], q;
            fl_descriptive_stats d;
            fl_peaks peaks = {0};
            fl_rainflow rain = {0};
            fl_log_bin *sorted = NULL;
            for (int32_t k = 0; k < s.n; k++) w[k] = s.edge[k + 1] - s.edge[k];
            assert_string_equal(t->part, s.part[p]);
            assert_int_equal(t->rows, s.n);
            assert_true(t->from == s.edge[0] && t->to == s.edge[s.n]);
            fl_compute_moments(s.n, x, w, &d);
            fl_summary_moments(t, moment);
            const double large = fmax(fabs(d.min), fabs(d.max));
            assert_near_of(moment[0], d.mean, 1e-14, large);
            assert_near_of(moment[1], d.std, 1e-13, large);
            if (d.std > 1e-3 * large) assert_near_of(moment[3], d.kurtosis, 1e-9, 3.0 + fabs(d.kurtosis));
            assert_true(t->min == d.min && t->max == d.max && t->t_min == s.t[d.at_min] &&
                        t->t_max == s.t[d.at_max]);
            check_result(fl_peaks_rayleigh(s.n, x, how.separation, how.threshold, &peaks, &err));
            double sum_of_peaks = 0.0;
            for (int32_t k = 0; k < peaks.n; k++) sum_of_peaks += x[peaks.row[k]];
            assert_int_equal(t->peaks, peaks.n);
            assert_near_of(fl_exact_value(&t->peak_sum), sum_of_peaks, 1e-13, peaks.n * large);
            check_result(fl_rainflow_count(&rain, how.rule, how.residue, s.n, x, &err));
            int64_t n = 0;
            for (int32_t k = 0; k < t->cycle.cap; k++) n += t->cycle.slot[k].n;
            assert_int_equal(n, half_cycles(&rain));
            check_result(fl_sample_block_maxima(s.n, x, s.edge, how.block, &peaks, NULL, &err));
            assert_int_equal(fl_multiset_size(&t->block), peaks.n);
            double highest = -INFINITY, found = -INFINITY;
            for (int32_t k = 0; k < peaks.n; k++) highest = fmax(highest, x[peaks.row[k]]);
            for (int32_t k = 0; k < t->block.n; k++) found = fmax(found, t->block.v[k].x);
            assert_true(highest == found);
            /* The quantile lies in the class of the value of that rank, or in the next one. */
            check_result(fl_log_histogram_sort(&t->level, &sorted, &err));
            q = fl_log_histogram_quantile(t->level.n, sorted, 0.5, t->min, t->max);
            double below = 0.0, above = 0.0, total = 0.0;
            const double slack = fabs(q) / 100;
            for (int32_t k = 0; k < s.n; k++) {
                if (x[k] <= q + slack) below += w[k];
                if (x[k] >= q - slack) above += w[k];
                total += w[k];
            }
            assert_true(below >= 0.4999 * total && above >= 0.4999 * total);
            free(sorted);
            fl_peaks_free(&peaks);
            fl_rainflow_free(&rain);
        }
        fl_series_free(&s);
        fl_summary_free(&sum);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(any_merge_order_gives_the_same_bytes),
                                       cmocka_unit_test(a_summary_agrees_with_the_record)};
    return cmocka_run_group_tests_name("summary", tests, NULL, NULL);
}
