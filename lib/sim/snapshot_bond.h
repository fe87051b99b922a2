/* SPDX-License-Identifier: GPL-3.0-or-later */
/* snapshot_bond.h -- the rows of a snapshot for bonds of floes, joints, and bonds of spheres
 * (sim/snapshot.h). */
#ifndef FL_SIM_SNAPSHOT_BOND_H
#define FL_SIM_SNAPSHOT_BOND_H
#include "out/state_io.h"
#include "world/world.h"

/* Write or read the bonds of faces and the joints; none is no row. */
void fl_snapshot_bonds(fl_state_io *t, fl_world *w);

/* The same for bonds of spheres. */
void fl_snapshot_discs(fl_state_io *t, fl_world *w);

#endif
