/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strip_setup.h -- walls and law of failure.crushing_law = rate, and what strips add to a step. */
#ifndef FL_SIM_STRIP_SETUP_H
#define FL_SIM_STRIP_SETUP_H
#include "world/access.h"

/* Fills w->strips if the scene has that law, after the pieces and floes have been placed.  -1 with FL_INPUT
 * (no vertical wall at the height of the ice, spheres or bonded floes) or FL_SYSTEM. */
int fl_strips_make(fl_world *w, fl_err *err);
void fl_strips_free(fl_strips *s);

/* After the contacts of a step of dt, by one thread: books what was crushed, and the closing speeds of the
 * parts, and gives floes their dents. -1 with FL_SYSTEM. */
int fl_strips_book(fl_world *w, double dt, fl_err *err);

/* -1 with FL_NUMERIC: a wall closed by more than a fifth of break_deflection in a step. */
int fl_strips_check(const fl_world *w, fl_err *err);

/* Before the first step: -1 with FL_INPUT if run.dt lets ice close by more than that at its speed then, or at
 * the largest of the drive. */
int fl_strips_check_start(const fl_world *w, fl_err *err);

/* Longest step that the speeds at the start, of the ice, the drive and the current, allow, a quarter of it if
 * the structure can swing against them; INFINITY without strips [s]. */
double fl_strips_max_step(const fl_world *w);

/* Bound of the stiffness of ice in front of a piece with a wall, for ice of the largest thickness all around,
 * at its greatest strength [N/m]. */
double fl_strips_stiffness(const fl_world *w, int32_t piece);

/* Speed below which mode k of the structure (fl_structure_mode) locks in by estimate:
 * fl_strip_lock_in_speed() of the mean force on the walls of its part, seen along the mode, in ice of the
 * largest thickness. 0: no wall; INFINITY: no damping [m/s]. */
double fl_strips_lock_in_speed(const fl_world *w, int32_t k);

#endif
