/* SPDX-License-Identifier: GPL-3.0-or-later */
/* moving_structure.h -- the motion of the parts of the structure, and of the pieces that belong to them.
 *
 * Section [structure] gives one mover to all parts without a [part NAME] of their own, and each [part NAME]
 * gives one to its part; a section without any motion gives none.  Or the structure is one of members
 * (member_structure.h).  Where fl_structure_moves() is 0, no other function of this header is called. */
#ifndef FL_SIM_MOVING_STRUCTURE_H
#define FL_SIM_MOVING_STRUCTURE_H
#include "out/tables.h"
#include "world/access.h"

/* The mover of each part, mover[surface->n]; -1: it stands still.  Names without a part are skipped. */
void fl_mover_of_parts(const fl_scene *s, const fl_surface *surface, int32_t *mover);

/* Build w->moving from the scene and from the model of members, NULL: none, after the pieces have been
 * placed, and move the pieces to the pose of t = 0. Sets w->part_reference too.  -1 with FL_INPUT (a part
 * that does not exist, a track that cannot be read, a mesh that does not float) or FL_SYSTEM. */
int fl_moving_structure_make(fl_world *w, const fl_surface *surface, const fl_member_model *members,
                             fl_err *err);
void fl_moving_structure_free(fl_moving_structure *r);

/* Prepare for steps of w->dt: factors of the dampers, positions of the reference points. */
void fl_moving_structure_set_step(fl_world *w);

/* First half of a step from time t: moves movers and pieces to its end; pieces get the mean velocities of the
 * step. */
void fl_moving_structure_first_half(fl_world *w, double t);

/* Second half, to time t: forces on the pieces and springs kick the movers by h, then the dampers act.  h = 0
 * only computes the forces.  The velocities are those of time t, between the two half kicks of a force: the
 * works booked with them are of order 2. */
void fl_moving_structure_second_half(fl_world *w, double t, double h);

/* Lower w->dt_critical by the smallest 2/omega of the movers under the contacts and springs of now; if it is
 * lowered, w->critical_body becomes w->b.total + mover. */
void fl_moving_structure_limit(fl_world *w);

/* Bound of omega^2 of mover k before the run: one floe on the stiffest contact point [N/m]. */
double fl_mover_omega2(const fl_world *w, int32_t k, double stiffest);

/* Energies of all movers [J].  drive_work: work of the prescribed motions of movers with free directions;
 * waves, drag: work of the water on hulls, and what its drag has removed. */
typedef struct {
    double kinetic, spring, damper_work, drive_work, plastic_work, waves, drag;
} fl_moving_energy;
fl_moving_energy fl_moving_structure_energy(const fl_world *w);

/* The columns of motion that the table of loads has; the motion of a part at time t. */
enum fl_loads_motion_kind fl_motion_columns(const fl_world *w);
void fl_part_motion(const fl_world *w, int32_t part, double t, fl_loads_motion *out);

/* Position now of a point x of a moving part, given in the pose of the file. */
fl_vec3 fl_part_point(const fl_world *w, int32_t part, fl_vec3 x);

/* Number of modes of all movers, and the k-th of them with its mover (NULL: not asked). */
int32_t fl_structure_modes(const fl_world *w);
const fl_modal_dof *fl_structure_mode(const fl_world *w, int32_t k, int32_t *mover);

/* 1 if a mover has free directions. */
int fl_structure_moves_freely(const fl_world *w);

/* Name of mover k for messages: of its part, or "structure"; "structure" of members. */
const char *fl_mover_name(const fl_world *w, int32_t k);

#endif
