/* SPDX-License-Identifier: GPL-3.0-or-later */
/* factor.h -- the factor of safety by reduction of strength: dem-solve --factor KEY. */
#ifndef DEM_SOLVE_FACTOR_H
#define DEM_SOLVE_FACTOR_H
#include "run_context.h"

/* What is divided by the factor: friction (tan phi of all joints), strength (that, cohesion and tension), or
 * one key of one joint as joint.NAME.friction, .cohesion or .tension. */

/* Makes the world anew for each trial. `with` is the caller's. -1 with err. */
typedef int factor_make_world(void *with, fl_world *w, fl_err *err);

/* Bisection: for each factor the model comes to rest with joints that cannot fail, then the strengths divided
 * by it hold, and it comes to rest again, or it does not within run.duration or moves by more than a fiftieth
 * of the size of a body. Writes a table to r->loads_path: factor, state, force ratio, largest displacement,
 * time; and the interval at the end. -1 with FL_USAGE (an unknown key), FL_NO (no factor from 0.01 to 100
 * stands, or all do). */
int factor_search(struct run *r, const char *key, factor_make_world *make, void *with, fl_err *err);

#endif
