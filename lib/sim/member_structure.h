/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_structure.h -- a structure of members in a run: its pieces follow the chain, and their contacts
 * load the chain.  structure/member_motion.h has the equations; sim/moving_structure.h calls this. */
#ifndef FL_SIM_MEMBER_STRUCTURE_H
#define FL_SIM_MEMBER_STRUCTURE_H
#include "out/tables.h"
#include "world/access.h"

/* Makes the chain of model m, which is borrowed, in equilibrium under its loads; the pieces of the structure
 * are its cylinders. -1 as
 * fl_member_dynamics_make(). */
int fl_member_structure_make(fl_world *w, const fl_member_model *m, fl_err *err);

/* The halves of a step, as in moving_structure.h. */
void fl_member_structure_first_half(fl_world *w);
void fl_member_structure_second_half(fl_world *w, double h);

/* Smallest 2/omega of a ball under the present contacts, with its bare mass; INFINITY without any [s]. */
double fl_member_structure_critical_step(const fl_world *w);

/* Bound of omega^2 before the run: contacts of stiffness k at the lightest piece [1/s2]. */
double fl_member_structure_omega2(const fl_world *w, double k);

/* Motion of the highest node of a part. */
void fl_member_structure_part_motion(const fl_world *w, int32_t part, fl_loads_motion *out);

/* Evaluates contact and internal forces of the chain after its state was read. */
void fl_member_structure_refresh(fl_world *w);

/* -1 with FL_NUMERIC: a number is not finite, or a piece is turned by more than 1 rad. */
int fl_member_structure_check(const fl_world *w, fl_err *err);

/* The row of piece `contact` of the chain in the table of output.members. */
fl_member_forces_row fl_member_structure_row(const fl_world *w, int32_t contact);

#endif
