/* SPDX-License-Identifier: GPL-3.0-or-later */
/* snapshot_pair.h -- the rows of a snapshot that are of pairs: what each remembers, and what acts in it. */
#ifndef FL_SIM_SNAPSHOT_PAIR_H
#define FL_SIM_SNAPSHOT_PAIR_H
#include "out/state_io.h"
#include "world/world.h"

/* Pair c of the list; on the way in it has been zeroed, and those before it have been read. */
void fl_snapshot_pair(fl_state_io *t, fl_world *w, int32_t c);

/* A row of two spheres, c of the list, or of one and wall ~c.  On the way in it is added to the list, and
 * last has the two of the row before, and then of this one. */
void fl_snapshot_sphere_contact(fl_state_io *t, fl_world *w, int32_t c, int32_t last[2]);

#endif
