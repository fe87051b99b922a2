/* SPDX-License-Identifier: GPL-3.0-or-later */
/* snapshot_failure.h -- the rows of a snapshot for floes that crush and break (sim/snapshot.h). */
#ifndef FL_SIM_SNAPSHOT_FAILURE_H
#define FL_SIM_SNAPSHOT_FAILURE_H
#include "out/state_io.h"
#include "world/world.h"

/* The core of a floe that has been cut, in the axes of the ice file, and its body made of it. */
void fl_snapshot_shape(fl_state_io *t, fl_world *w, int32_t i);

/* What is crushed so far, and the dents of the floes. */
void fl_snapshot_crushing(fl_state_io *t, fl_world *w);

/* Loads at the last checks, what broke so far, and failures that are not yet in the table. */
void fl_snapshot_breaking(fl_state_io *t, fl_world *w);

#endif
