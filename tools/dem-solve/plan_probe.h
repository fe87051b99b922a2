/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plan_probe.h -- the options --plan and --probe. */
#ifndef DEM_SOLVE_PLAN_PROBE_H
#define DEM_SOLVE_PLAN_PROBE_H
#include "run_context.h"

/* Print bodies, pairs, stages, step, memory and the expected time, from half a second of the run. */
int print_plan(struct run *r, FILE *f, fl_err *err);

/* Print the contacts of all pairs nearer than r->o->probe at the start. */
int print_probe(struct run *r, FILE *f, fl_err *err);

#endif
