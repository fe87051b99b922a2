/* SPDX-License-Identifier: GPL-3.0-or-later */
/* warnings.h -- warnings about a scene that can be run but is likely wrong. */
#ifndef DEM_SOLVE_WARNINGS_H
#define DEM_SOLVE_WARNINGS_H
#include "run_context.h"

/* To f before the first step, and after the run, failed: it ended with an error. */
void warn_at_start(const struct run *r, FILE *f);
void warn_at_end(const struct run *r, int failed, FILE *f);

/* At a row of the loads, time t, to standard error. */
void warn_at_row(struct run *r, double t);

#endif
