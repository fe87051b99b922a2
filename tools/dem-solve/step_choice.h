/* SPDX-License-Identifier: GPL-3.0-or-later */
/* step_choice.h -- the step of a run, the number of its steps, and names of bodies for messages. */
#ifndef DEM_SOLVE_STEP_CHOICE_H
#define DEM_SOLVE_STEP_CHOICE_H
#include "run_context.h"

/* Relative difference of two times that are equal but for rounding. */
#define TIME_ROUNDING 1e-12

/* Choose the step: that of the scene, or the automatic one, a little smaller so that it divides the
 * interval of the loads.  Sets r->w->dt, critical, step_body, step_by and steps. */
void choose_step(struct run *r);

/* After fl_step_start(), which may have shortened the automatic step: counts the steps anew and says so.
 * `chosen` is the step of choose_step(). -1 with FL_INPUT if there are too many. */
int update_chosen_step(struct run *r, double chosen, fl_err *err);

/* First step at or after time t; a step that differs from t by rounding alone counts as at t. */
int64_t step_at(const fl_world *w, double t);

/* Set r->steps from the step of the world. */
void count_steps(struct run *r);

/* -1 with FL_INPUT if the run has more steps than a double can count. */
int check_step_count(const struct run *r, fl_err *err);

/* "body 7"; the part or structure of a mover (k >= b.total); "a floe that has left" (-1). */
const char *body_name(const fl_world *w, int32_t k, char name[64]);

#endif
