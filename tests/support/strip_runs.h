/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strip_runs.h -- worlds in which ice crushes by its speed, what their runs record, and rows of several runs
 * with their confidence limits. Forces are over STRIP_F0, the mean of fast crushing. */
#ifndef FL_TESTS_STRIP_RUNS_H
#define FL_TESTS_STRIP_RUNS_H
#include "support/small_world.h"
#include "support/verify.h"

#define STRIP_F0 2e6 /* [N] */

/* The floe reaches so far into the wall at the start, where its elements stand at gaps [m]. */
#define STRIP_FRONT 6e-3

/* A floe 0.5 m thick is driven at v along x against a wall 10 m wide with 20 columns, ring = 0, or a pile of
 * radius 5 in it of so many sectors. Ready for more keys and lab_make(). */
void strip_start(lab *l, double v, int seed, int ring);

/* One mode of 2 Hz, 2533 t at the waterline, damping ratio 0.02. */
void strip_add_oscillator(lab *l);

typedef struct {
    double n, f, ff, g, gg, v, vv, x, xx; /* f, g: force along x and y; v, x of the first mover along x */
} strip_record;

void strip_record_add(strip_record *s, const fl_world *w);
double strip_deviation(double n, double sum, double square);
/* sqrt 2 times the deviation of the velocity of the structure, over the speed v of the ice. */
double strip_beta(const strip_record *s, double v);

/* Runs to time t; from `since` on records are added. Ends the program if the run fails. */
void strip_run_until(lab *l, double t, double since, strip_record *s);

/* A quantity of several runs. */
typedef struct {
    double n, sum, square;
} strip_values;

void strip_values_add(strip_values *s, double x);

/* A row for their mean, with the number of runs and the half-width of the limits that hold it with a
 * probability of 95 % (Student). */
void strip_row(const char *id, const char *what, const strip_values *s, double expected, double tol,
               enum verify_kind kind);

#endif
