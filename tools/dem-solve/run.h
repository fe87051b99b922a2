/* SPDX-License-Identifier: GPL-3.0-or-later */
/* run.h -- from a built world to the end of the scene: steps, tables, report. */
#ifndef DEM_SOLVE_RUN_H
#define DEM_SOLVE_RUN_H
#include "options.h"
#include "step/world.h"

/* What a run has in its hands. */
struct run {
    const struct options *o;
    const fl_scene *scene;
    const fl_surface *surface; /* NULL: none */
    const char *history;       /* of the inputs; NULL: none */
    const fl_by *by;
    fl_world *w;
    double limit;      /* the critical step known before the run, 2/omega [s] */
    int32_t step_body; /* the body that set the automatic step, -1 */
    int64_t steps;
    double wall; /* [s] spent in steps */
};

/* Choose the step: the scene's, or the automatic one, then a little smaller so that it divides the interval
 * of the loads. */
void run_step_size(struct run *r);

/* The whole run. -1 as fl_step(), or FL_SYSTEM when an output cannot be written; what was written until then
 * is complete and carries its name. */
int run_scene(struct run *r, fl_err *err);

/* report.c */
void report_write(const struct run *r, FILE *f);

/* look.c: --plan and --probe */
int look_plan(struct run *r, FILE *f, fl_err *err);
int look_probe(struct run *r, FILE *f, fl_err *err);

/* Number by which the contacts table calls partner j: its id, or -1 - part of the structure, walls after
 * those. */
int32_t run_partner(const fl_world *w, int32_t j);

/* Seconds of a clock that only goes forward. */
double run_clock(void);

#endif
