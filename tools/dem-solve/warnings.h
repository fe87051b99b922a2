/* SPDX-License-Identifier: GPL-3.0-or-later */
/* warnings.h -- warnings about a scene that can be run but is likely wrong. */
#ifndef DEM_SOLVE_WARNINGS_H
#define DEM_SOLVE_WARNINGS_H
#include "run_context.h"

/* To f before the first step, and after the run, failed: it ended with an error. */
void warn_at_start(const struct run *r, FILE *f);
void warn_at_end(const struct run *r, int failed, FILE *f);

/* After the start, before the first step: -1 with FL_INPUT where ice in water overlaps or lies inside the
 * structure, without --force. */
int check_start(const struct run *r, fl_err *err);

/* What an id of fl_world_id stands for: a body, a part of the structure by its name, or a wall. */
enum { NAME_OF_ID = 80 };
const char *name_of_id(const struct run *r, int32_t id, char name[NAME_OF_ID]);

/* At a row of the loads, time t, to standard error. */
void warn_at_row(struct run *r, double t);

#endif
