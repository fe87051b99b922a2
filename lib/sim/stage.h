/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stage.h -- stages of a run: [stage NAME] sections, one after the other.
 *
 * A stage begins at its time, or when the run has come to rest (relaxed_run.h), and takes the bodies of a
 * group out. What they stored and weighed is in the column carried of energy(5). A run that comes to rest
 * behind its last stage is settled. */
#ifndef FL_SIM_STAGE_H
#define FL_SIM_STAGE_H
#include "world/world.h"

/* Between two steps. group[n]: group of each body, an index into name, -1: none.
 * Returns 1 if the run is settled, 0 if not, -1 with FL_INPUT or FL_SYSTEM. */
int fl_stage_update(fl_world *w, const int32_t *group, const char *const *name, int32_t names, fl_err *err);

#endif
