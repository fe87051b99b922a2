/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_ice.c -- time to make an ice field, stage by stage, for a thousand to a million floes, with its
 * errors.  All stages of voronoi-ice with its defaults: sites, cells, two steps of smoothing, floes of
 * concentration 0.8, the certificate with exact predicates, prisms, and the file.  No stage may grow faster
 * than the number of floes, so the time per floe is constant: "of first" is that time over the one of a
 * thousand floes, within one run.  Times are processor times over all threads, the least of three rounds
 * through all rows, since other load only adds to them.  Errors are those of the areas: cells that fill the
 * rectangle, floes that cover 0.8 of it.  BENCH_ICE=N sets the largest number; default a million. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "ice/power_cells.h"
#include "ice/certificate.h"
#include "ice/floes.h"
#include "scene/ice_field.h"

#define CONCENTRATION 0.8
#define RADIUS 0.05

enum { ROWS = 4, STAGES = 6, SMOOTH = 2, ROUNDS = 3, LARGE = 200000 };

struct row {
    int32_t n;
    double stage[STAGES]; /* s */
    double cells, floes;  /* relative errors of areas */
    double bytes, peak;
    int64_t wrong; /* overlaps and floes that are not convex */
};

static double processor_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double lap_time(double *since)
{
    const double before = *since;
    *since = processor_time();
    return *since - before;
}

/* As in voronoi-ice: prisms are checked, and only the data of the file are kept. */
static int add_bodies(fl_ice_field *field, const fl_floes *a, fl_err *err)
{
    fl_poly *core = fl_alloc(a->n, sizeof *core, err);
    int bad = !core;
#pragma omp parallel for schedule(static) reduction(| : bad)
    for (int32_t i = 0; i < a->n; i++) {
        const int32_t n = a->first[i + 1] - a->first[i];
        fl_vec3 *xy = fl_alloc(n, sizeof *xy, &(fl_err){0});
        for (int32_t k = 0; k < n && xy; k++)
            xy[k] = v3(a->core[a->first[i] + k].x, a->core[a->first[i] + k].y, 0.0);
        bad |= bad || !xy || fl_poly_prism(&core[i], n, xy, -0.4, 0.0, &(fl_err){0}) ||
               fl_poly_strip(&core[i], &(fl_err){0});
        free(xy);
    }
    for (int32_t i = 0; i < a->n && !bad; i++)
        bad = fl_ice_field_add(field, i, RADIUS, &core[i], "ice", NULL, v3(0, 0, 0), v3(0, 0, 0), err);
    for (int32_t i = 0; i < a->n && core; i++) fl_poly_free(&core[i]);
    free(core);
    return bad ? fl_fail(err, FL_NUMERIC, "a floe is no prism") : 0;
}

static int write_file(const fl_ice_field *field, double *bytes, fl_err *err)
{
    char path[300];
    const char *tmp = getenv("TMPDIR");
    fl_history_line by;
    FILE *f;
    snprintf(path, sizeof path, "%.200s/floe-bench-ice-%ld", tmp ? tmp : "/tmp", (long)getpid());
    f = fopen(path, "w");
    if (!f) return fl_fail(err, FL_SYSTEM, "%s cannot be written", path);
    fl_history_line_start(&by, "bench_ice");
    fl_ice_field_write(f, field, &by);
    *bytes = (double)ftell(f);
    const int bad = fclose(f);
    unlink(path);
    return bad ? fl_fail(err, FL_SYSTEM, "%s could not be written", path) : 0;
}

static double sum_of_cells(const fl_power_cells *c, fl_err *err)
{
    double *area = fl_alloc(c->n, sizeof *area, err), total_time = NAN;
    if (area) {
        fl_power_cells_areas(c, area);
        total_time = fl_parallel_sum(area, c->n);
    }
    free(area);
    return total_time;
}

static int make_field(struct row *r, uint64_t seed, fl_err *err)
{
    const double side = 4.0 * sqrt(r->n), total = side * side;
    const fl_vec2 lo = {-0.5 * side, -0.5 * side}, hi = {0.5 * side, 0.5 * side};
    fl_vec2 *site = fl_alloc(r->n, sizeof *site, err);
    fl_power_cells c = {0};
    fl_floes a = {0};
    fl_ice_field field = {0};
    fl_certificate t = {0};
    double at = processor_time(), bytes = 0.0;
    int rc = -1;
    if (!site) return -1;
    fl_random_sites(r->n, seed, lo, hi, site);
    if (fl_power_cells_build(&c, r->n, site, lo, hi, err)) goto done;
    r->stage[0] += lap_time(&at);
    for (int k = 0; k < SMOOTH; k++) {
        fl_power_cells_centroids(&c, site);
        fl_power_cells_free(&c);
        if (fl_power_cells_build(&c, r->n, site, lo, hi, err)) goto done;
    }
    r->stage[1] += lap_time(&at);
    if (fl_floes_make(&a, &c, CONCENTRATION, RADIUS, (fl_vec2){0, 0}, err)) goto done;
    r->stage[2] += lap_time(&at);
    if (fl_certificate_make(&t, &a, err)) goto done;
    r->stage[3] += lap_time(&at);
    r->cells = fmax(r->cells, fabs(sum_of_cells(&c, err) / total - 1.0));
    fl_power_cells_free(&c);
    if (add_bodies(&field, &a, err)) goto done;
    r->stage[4] += lap_time(&at);
    if (write_file(&field, &bytes, err)) goto done;
    r->stage[5] += lap_time(&at);
    r->floes = fmax(r->floes, fabs(t.total_area / (CONCENTRATION * total) - 1.0));
    r->wrong += t.overlaps + t.nonconvex;
    r->bytes += bytes;
    rc = 0;
done:
    free(site);
    fl_ice_field_free(&field);
    fl_floes_free(&a);
    fl_power_cells_free(&c);
    return rc;
}

/* The average over as many fields as have the floes of a large one. */
static int average(struct row *r, fl_err *err)
{
    const int times = r->n < LARGE ? LARGE / r->n : 1;
    for (int k = 0; k < times; k++)
        if (make_field(r, (uint64_t)k, err)) return -1;
    for (int k = 0; k < STAGES; k++) r->stage[k] /= (double)r->n * times;
    r->bytes /= times;
    return 0;
}

static double memory(void)
{
    struct rusage u;
    return getrusage(RUSAGE_SELF, &u) == 0 ? 1024.0 * (double)u.ru_maxrss : NAN;
}

/* Adds the results of a round to those of a row. */
static void keep_best(struct row *best, const struct row *r, int round)
{
    for (int k = 0; k < STAGES; k++)
        if (round == 0 || r->stage[k] < best->stage[k]) best->stage[k] = r->stage[k];
    best->cells = fmax(best->cells, r->cells);
    best->floes = fmax(best->floes, r->floes);
    best->wrong += r->wrong;
    best->bytes = r->bytes;
    if (round == 0) best->peak = memory(); /* rows grow, so the peak is that of this row */
}

static double total_time(const struct row *r)
{
    double s = 0.0;
    for (int k = 0; k < STAGES; k++) s += r->stage[k];
    return s;
}

int main(int argc, char **argv)
{
    static const char *const name[STAGES] = {"cells", "smooth", "floes", "certify", "prisms", "write"};
    static const int32_t number[ROWS] = {1000, 10000, 100000, 1000000};
    struct row row[ROWS] = {{0}};
    const char *most = getenv("BENCH_ICE");
    int32_t largest = 1000000;
    fl_err err = {0};
    int rows = 0, ok = 1;
    (void)argc;
    fl_parallel_limit_spin(argv);
    if (most && fl_number_i32(most, 1000, 1000000, &largest)) largest = 1000;
    while (rows < ROWS && number[rows] <= largest) rows++;
    for (int round = 0; round < ROUNDS; round++)
        for (int k = 0; k < rows && ok; k++) {
            struct row r = {.n = number[k]};
            ok = average(&r, &err) == 0;
            row[k].n = r.n;
            keep_best(&row[k], &r, round);
            ok &= r.cells < 1e-12 && r.floes < 1e-12 && r.wrong == 0;
        }
    printf("microseconds of processor for one floe, stage by stage, least of %d rounds\n%8s", ROUNDS,
           "floes");
    for (int k = 0; k < STAGES; k++) printf(" %7s", name[k]);
    printf(" %7s %8s %8s %8s %10s %10s %6s\n", "all", "of first", "MB file", "MB peak", "cells off",
           "floes off", "wrong");
    for (int j = 0; j < rows; j++) {
        const struct row *r = &row[j];
        printf("%8d", r->n);
        for (int k = 0; k < STAGES; k++) printf(" %7.2f", 1e6 * r->stage[k]);
        printf(" %7.2f %8.2f %8.1f %8.0f %10.1e %10.1e %6lld\n", 1e6 * total_time(r),
               total_time(r) / total_time(&row[0]), 1e-6 * r->bytes, 1e-6 * r->peak, r->cells, r->floes,
               (long long)r->wrong);
    }
    if (!ok)
        fprintf(stderr, "bench_ice: %s\n", err.code ? err.text : "a field does not meet its specification");
    printf("%d passed, %d failed\n", ok, !ok);
    return !ok;
}
