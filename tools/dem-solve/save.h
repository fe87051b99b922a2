/* SPDX-License-Identifier: GPL-3.0-or-later */
/* save.h -- checkpoints of a run: write, read, resume.  Format: checkpoint(5).
 *
 * A checkpoint is written between two steps, after the rows of the step and before a last, shorter row of
 * the loads.  It holds everything: scene, ice, structure, state, the next row of every table and the
 * position in its file. */
#ifndef DEM_SOLVE_SAVE_H
#define DEM_SOLVE_SAVE_H
#include "outputs.h"
#include "run_context.h"
#include "scene/ice_field.h"

/* The inputs of a new run as texts for its checkpoints; the caller frees each .text.
 *   members  NULL: the structure is the surface
 *   feed     the field of inflow_file; empty: none */
int save_inputs_as_text(fl_restart_part text[INPUT_TEXTS], const fl_ice_field *field,
                        const fl_surface *surface, const fl_member_model *members, const fl_ice_field *feed,
                        const fl_history_line *by, fl_err *err);

/* Write the checkpoint of the scene, after flushing the tables to the disk.  -1 with FL_SYSTEM: the last
 * checkpoint then stays. */
int save_write(struct run *r, struct outputs *u, fl_err *err);

/* Read from a checkpoint: the scene with the changes of the command line, the ice and the structure.  -1 with
 * FL_INPUT, FL_USAGE (--set of a key that would change the run) or FL_SYSTEM. */
int save_read_inputs(const fl_restart *saved, const struct options *o, fl_scene *scene, fl_ice_field *field,
                     fl_ice_field *feed, fl_surface *surface, fl_member_model *members, fl_err *err);

/* Read the histories: the lines of the inputs into *history (owned by the caller), the run's own into by. */
int save_read_history(const fl_restart *saved, char **history, fl_history_line *by, fl_err *err);

/* Restore state and tables from r->resumed: world, timers and open files are those of the run at that
 * step.  No file is changed unless all tables exist.  -1 with FL_INPUT, FL_USAGE or FL_SYSTEM. */
int save_restore(struct run *r, struct outputs *u, fl_err *err);

#endif
