/* SPDX-License-Identifier: GPL-3.0-or-later */
/* warnings.h -- warnings on standard error about a scene that can be run but is likely wrong. */
#ifndef DEM_SOLVE_WARNINGS_H
#define DEM_SOLVE_WARNINGS_H
#include "run_context.h"

/* Before the first step; at a row of the loads, time t; after the run, failed: it ended with an error. */
void warn_at_start(const struct run *r);
void warn_at_row(struct run *r, double t);
void warn_at_end(const struct run *r, int failed);

#endif
