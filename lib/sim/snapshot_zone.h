/* SPDX-License-Identifier: GPL-3.0-or-later */
/* snapshot_zone.h -- the rows of deformable blocks in a checkpoint. */
#ifndef FL_SIM_SNAPSHOT_ZONE_H
#define FL_SIM_SNAPSHOT_ZONE_H
#include "out/state_io.h"
#include "world/world.h"

/* Nodes, plastic strain, points of joints, works.  Zones follow from the scene and the ice. */
void fl_snapshot_zones(fl_state_io *t, fl_world *w);

#endif
