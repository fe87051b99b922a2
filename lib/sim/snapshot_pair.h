/* SPDX-License-Identifier: GPL-3.0-or-later */
/* snapshot_pair.h -- the rows of a snapshot for pairs: their memory, and the forces of the last
 * evaluation. */
#ifndef FL_SIM_SNAPSHOT_PAIR_H
#define FL_SIM_SNAPSHOT_PAIR_H
#include "out/state_io.h"
#include "world/world.h"

/* Write or read pair c of the neighbour list.  When reading, it is zeroed before, and the pairs before it
 * are read. */
void fl_snapshot_pair(fl_state_io *t, fl_world *w, int32_t c);

/* Write sphere contact c, or wall contact ~c; or read one and append it to the list.  last: i and j of
 * the row before, then of this one; both rows must be in order. */
void fl_snapshot_sphere_contact(fl_state_io *t, fl_world *w, int32_t c, int32_t last[2]);

#endif
