/* SPDX-License-Identifier: GPL-3.0-or-later */
/* save.h -- checkpoints of a run: written, read, gone on from.  Format: checkpoint(5).
 *
 * A checkpoint is taken between two steps, when the rows of the step are written and before a last, shorter
 * row of the loads.  It holds everything: scene, ice, structure, state, the next row of every table and the
 * place in its file. */
#ifndef DEM_SOLVE_SAVE_H
#define DEM_SOLVE_SAVE_H
#include "run.h"
#include "scene/ice_field.h"

/* The inputs of a run that begins, as the texts r->kept for its checkpoints; the caller frees each .text.
 *   feed  the field of another file that comes in; empty: none */
int save_keep(fl_restart_part kept[KEPT], const fl_ice_field *field, const fl_surface *surface,
              const fl_ice_field *feed, const fl_history_line *by, fl_err *err);

/* Write the checkpoint that the scene asks for; the tables are brought to the disk before.  -1 with
 * FL_SYSTEM: the last checkpoint is then as it was. */
int save_write(struct run *r, struct outputs *u, fl_err *err);

/* From a checkpoint: the scene with what the command line changes of it, the ice and the structure.
 * -1 with FL_INPUT, FL_USAGE (--set of a key that would change the run) or FL_SYSTEM. */
int save_inputs(const fl_restart *saved, const struct options *o, fl_scene *scene, fl_ice_field *field,
                fl_ice_field *feed, fl_surface *surface, fl_err *err);

/* Histories: the lines of the inputs into *history (owned by the caller), the run's own into by. */
int save_history(const fl_restart *saved, char **history, fl_history_line *by, fl_err *err);

/* State and tables of r->saved: world, timers and open files are those of the run at that step.  Nothing is
 * changed on the disk unless all tables are there.  -1 with FL_INPUT, FL_USAGE or FL_SYSTEM. */
int save_restore(struct run *r, struct outputs *u, fl_err *err);

#endif
