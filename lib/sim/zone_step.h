/* SPDX-License-Identifier: GPL-3.0-or-later */
/* zone_step.h -- one time step of the deformable blocks, by the team of threads of step.c.
 *
 * Nodes move by the same velocity Verlet as bodies: half kick, drift, forces, half kick.  Forces on a node
 * are those of the stress of its zones, of the points of joints, dashpots of quiet sides, damping to rest
 * (relaxed_run.h), and its part of what acts on the block as a whole: weight, and contacts other than joints,
 * m (F/M + alpha x r) with J alpha = T.
 *
 * Work of a force over half a kick is h f.(v before + v after)/2, exactly the change of kinetic energy by
 * it. */
#ifndef FL_SIM_ZONE_STEP_H
#define FL_SIM_ZONE_STEP_H
#include "world/world.h"

/* Half kick and drift of the nodes, then the poses of their bodies. */
void fl_zones_first_half(fl_world *w, double h);

/* Forces of the stress at the present places. */
void fl_zones_stress(fl_world *w);

/* Sums of forces on the nodes, and the other half kick. */
void fl_zones_second_half(fl_world *w, double h);

/* After a step: works into the ledger. */
void fl_zones_book(fl_world *w);

/* After a zone was turned inside out: FL_NUMERIC with its place.  Returns -1. */
int fl_zones_fail(const fl_world *w, fl_err *err);

/* Largest force on a node that is not balanced, over the mean force of a zone on a node. */
double fl_zones_force_ratio(const fl_world *w);

/* Takes out the blocks whose bodies are absent. */
void fl_zones_drop_absent(fl_world *w);

/* Velocities of all nodes 0 in their free directions. */
void fl_zones_stop(fl_world *w);

#endif
