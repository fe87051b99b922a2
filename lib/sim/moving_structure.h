/* SPDX-License-Identifier: GPL-3.0-or-later */
/* moving_structure.h -- what of the structure moves, and the pieces that ride on it.
 *
 * [structure] makes one mover of all parts that have no [part NAME] of their own, and each of those one of
 * its part, where the scene moves it at all.  What stands still has no mover, and then w->ride.m.n is 0 and
 * nothing here is called. */
#ifndef FL_SIM_MOVING_STRUCTURE_H
#define FL_SIM_MOVING_STRUCTURE_H
#include "out/tables.h"
#include "world/access.h"

/* Build w->ride from the scene, after the pieces have been placed; take them to the pose of t = 0.  Sets
 * w->part_about too.  -1 with FL_INPUT (a part that is not there, a track that cannot be read, a mesh that
 * does not float) or FL_SYSTEM. */
int fl_moving_structure_make(fl_world *w, const fl_surface *surface, fl_err *err);
void fl_moving_structure_free(fl_moving_structure *r);

/* Ready for steps of w->dt: the factors of the dampers, and where the reference points are. */
void fl_moving_structure_set_step(fl_world *w);

/* The first half of a step from time t: movers and pieces are at the end of it, with the velocities of its
 * middle. */
void fl_moving_structure_first_half(fl_world *w, double t);

/* The second half, to time t: what presses on the pieces and the springs kick the movers by h, then
 * the dampers; h = 0 only renews the forces.  Velocities are those of time t: the two half kicks that a force
 * gives lie on either side of them, which makes the works that are booked with them of order 2. */
void fl_moving_structure_second_half(fl_world *w, double t, double h);

/* The smallest 2/omega of the movers by the contacts and springs of now, into w->dt_critical; the body that
 * sets it is then w->b.total + mover. */
void fl_moving_structure_limit(fl_world *w);

/* A bound of omega^2 before the run: mover k under one floe on the stiffest place [N/m]. */
double fl_mover_omega2(const fl_world *w, int32_t k, double stiffest);

/* Kinetic energy, energy of springs, work of dampers, and work put in by what is told of movers with free
 * directions [J]. */
typedef struct {
    double kinetic, spring, damper_work, drive_work;
} fl_moving_energy;
fl_moving_energy fl_moving_structure_energy(const fl_world *w);

/* Which columns of motion the loads have, and what they are of a part at time t. */
enum fl_loads_motion_kind fl_motion_columns(const fl_world *w);
void fl_part_motion(const fl_world *w, int32_t part, double t, fl_loads_motion *out);

/* Where a point of a part that moves is now; x in the pose of the file. */
fl_vec3 fl_part_point(const fl_world *w, int32_t part, fl_vec3 x);

/* Does something of the structure move by itself? */
int fl_structure_moves_freely(const fl_world *w);

/* Name of mover k for messages: of its part, or "structure". */
const char *fl_mover_name(const fl_world *w, int32_t k);

#endif
