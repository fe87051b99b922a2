/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_parse.c -- speed of reading a table of decimal text, with the error of the numbers, and `wc -l` on
 * the same file in the same run.  The table is a loads table of 10 columns whose numbers have 15 to 17
 * digits.  Rates are of text over elapsed time, the best of a few rounds; compare them within one
 * run only. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include "base/decimal.h"
#include "base/number_text.h"
#include "base/rng.h"
#include "base/table.h"
#include "stat/run_summary.h"

enum { ROWS = 400000, ROUNDS = 5, COLUMNS = 10, WAYS = 5 };

static double wall_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int write_table(const char *path)
{
    FILE *f = fopen(path, "w");
    char text[FL_NUMBER_LEN];
    if (!f) return -1;
    fputs("#loads 1\nt[s]\tpart\tfx[N]\tfy[N]\tfz[N]\tmx[N.m]\tmy[N.m]\tmz[N.m]\tfpeak[N]\tcontacts\n", f);
    for (int k = 0; k < ROWS; k++) {
        fl_rng g = fl_rng_of(1, k, FL_RNG_TEST);
        fprintf(f, "%s\tleg", fl_number_text(0.01 * (k + 1), text));
        for (int c = 0; c < 7; c++) fprintf(f, "\t%s", fl_number_text(1e4 * fl_rng_normal(&g), text));
        fprintf(f, "\t%d\n", k % 20);
    }
    return fclose(f);
}

/* Seconds of one pass over the table; sum uses every number. */
static double read_table(const char *path, int numbers, double *sum)
{
    fl_err err = {0};
    fl_table t;
    const double start = wall_time();
    int more = fl_table_open(&t, path, "loads", 1, &err);
    *sum = 0.0;
    while (more >= 0 && (more = fl_table_row(&t, &err)) > 0)
        for (int32_t c = 0; numbers && c < t.n; c++) {
            double x;
            if (c == 1) continue;
            if (fl_table_f64(&t, c, &x, &err)) more = -1;
            *sum += x;
        }
    fl_table_close(&t);
    if (more < 0) fprintf(stderr, "bench_parse: %s\n", err.text);
    return more < 0 ? NAN : wall_time() - start;
}

/* Seconds of the statistics of some columns in constant memory; sum is the mean of the first. */
static double time_statistics(const char *path, int columns, double *sum)
{
    static const char *const name[] = {"fx", "fy", "fz", "fh"};
    const fl_record_selection ask = {.signal = name, .signals = columns, .from = -INFINITY, .to = INFINITY};
    const fl_summary_settings how = {.separation = 0.5};
    fl_err err = {0};
    fl_run r = {0};
    double moment[4] = {NAN};
    const double start = wall_time();
    int more = fl_run_open(&r, path, &ask, &how, &err);
    while (more >= 0 && (more = fl_run_next(&r, &err)) > 0) {}
    if (more == 0) more = fl_run_finish(&r, "", &err);
    if (more == 0) fl_summary_moments(&r.sum.entry[0], moment);
    const double seconds = wall_time() - start;
    fl_run_close(&r);
    if (more < 0) fprintf(stderr, "bench_parse: %s\n", err.text);
    *sum = moment[0];
    return more < 0 ? NAN : seconds;
}

static double count_lines(const char *path, long *lines)
{
    char command[400];
    const double start = wall_time();
    snprintf(command, sizeof command, "wc -l <'%s'", path);
    FILE *f = popen(command, "r");
    if (!f || fscanf(f, "%ld", lines) != 1) *lines = -1;
    if (f) pclose(f);
    return wall_time() - start;
}

/* Numbers of the table whose bits differ from those of strtod(), and the time to read all of them. */
static long differences(const char *path, long *numbers, double *ours, double *theirs)
{
    fl_err err = {0};
    fl_table t;
    long bad = 0;
    double sum = 0.0;
    *numbers = 0;
    *ours = *theirs = 0.0;
    if (fl_table_open(&t, path, "loads", 1, &err)) return -1;
    enum { BATCH = 1000 };
    static char text[BATCH * COLUMNS][FL_NUMBER_LEN];
    for (int done = 0, n; !done;) {
        for (n = 0; n + COLUMNS <= BATCH * COLUMNS;) {
            if (fl_table_row(&t, &err) <= 0) {
                done = 1;
                break;
            }
            for (int32_t c = 0; c < t.n; c++)
                if (c != 1) snprintf(text[n++], FL_NUMBER_LEN, "%s", fl_table_word(&t, c));
        }
        const double a = wall_time();
        for (int k = 0; k < n; k++) {
            double x = 0.0;
            fl_decimal_read(text[k], &x);
            sum += x;
        }
        const double b = wall_time();
        for (int k = 0; k < n; k++) sum -= strtod(text[k], NULL);
        *ours += b - a;
        *theirs += wall_time() - b;
        for (int k = 0; k < n; k++) {
            double x = NAN, y = strtod(text[k], NULL);
            bad += !fl_decimal_read(text[k], &x) || memcmp(&x, &y, sizeof x) != 0;
        }
        *numbers += n;
    }
    fl_table_close(&t);
    return isfinite(sum) ? bad : -1;
}

/* Error of a mean of fx against that in long double, over the standard deviation of the values, 1e4. */
static double mean_error(const char *path, double mean)
{
    fl_err err = {0};
    fl_table t;
    long double sum = 0.0L, time = 0.0L, before = 0.0L;
    if (fl_table_open(&t, path, "loads", 1, &err)) return NAN;
    while (fl_table_row(&t, &err) > 0) {
        const double now_at = strtod(fl_table_word(&t, 0), NULL), x = strtod(fl_table_word(&t, 2), NULL);
        sum += ((long double)now_at - before) * x;
        time += (long double)now_at - before;
        before = now_at;
    }
    fl_table_close(&t);
    return fabs((double)((long double)mean - sum / time)) / 1e4;
}

int main(void)
{
    char path[300];
    const char *tmp = getenv("TMPDIR");
    double best[WAYS], sum, mean = 0.0, ours, theirs;
    long lines = 0, numbers, bad;
    snprintf(path, sizeof path, "%.200s/floe-parse-%ld", tmp ? tmp : "/tmp", (long)getpid());
    if (write_table(path)) return 4;
    FILE *f = fopen(path, "r");
    if (!f || fseek(f, 0, SEEK_END)) return 4;
    const double mb = 1e-6 * (double)ftell(f);
    fclose(f);
    for (int k = 0; k < WAYS; k++) best[k] = INFINITY;
    for (int k = 0; k < ROUNDS; k++) {
        best[0] = fmin(best[0], count_lines(path, &lines));
        best[1] = fmin(best[1], read_table(path, 0, &sum));
        best[2] = fmin(best[2], read_table(path, 1, &sum));
        best[3] = fmin(best[3], time_statistics(path, 1, &mean));
        best[4] = fmin(best[4], time_statistics(path, 4, &mean));
    }
    const double wrong = mean_error(path, mean);
    bad = differences(path, &numbers, &ours, &theirs);
    unlink(path);
    printf("reading a loads table of %.0f MB, %d rows, one thread\n", mb, ROWS);
    printf("%-34s %10s %14s\n", "", "MB/s", "of wc -l");
    static const char *const what[] = {"wc -l", "rows cut into fields", "all fields as numbers",
                                       "statistics of fx, constant memory", "of fx fy fz fh"};
    for (int k = 0; k < WAYS; k++) printf("%-34s %10.0f %13.2f\n", what[k], mb / best[k], best[0] / best[k]);
    printf("number alone: %.1f ns, strtod() %.1f ns; %ld of %ld numbers differ from strtod()\n",
           1e9 * ours / (double)numbers, 1e9 * theirs / (double)numbers, bad, numbers);
    printf("mean of fx: error %.1e of the deviation\n", wrong);
    const int sound = bad == 0 && lines == ROWS + 2 && wrong < 1e-15;
    printf("%d passed, %d failed\n", sound, !sound);
    return !sound;
}
