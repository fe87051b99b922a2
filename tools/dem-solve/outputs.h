/* SPDX-License-Identifier: GPL-3.0-or-later */
/* outputs.h -- the tables of a run: which there are, when their rows are due, their files.
 *
 * A table is one line of enum table_id and one row of TABLE in outputs.c: name, path and interval in the
 * scene, header, rows.  Opening, timing, checkpoints and the check of file names follow from that row. */
#ifndef DEM_SOLVE_OUTPUTS_H
#define DEM_SOLVE_OUTPUTS_H
#include "base/stream.h"
#include "out/packed_frames.h"
#include "run_context.h"

/* The order is that of a checkpoint(5). */
enum table_id {
    TABLE_LOADS,
    TABLE_STATE,
    TABLE_ENERGY,
    TABLE_CONTACTS,
    TABLE_HASH,
    TABLE_FRAMES,
    TABLE_PANELS,
    TABLE_EVENTS,
    TABLE_BONDS,
    TABLE_MEMBERS,
    TABLE_ZONES,
    TABLE_FAILURES,
    TABLES,
    TIMER_ICE = TABLES, /* frames with ice */
    TIMER_SAVE,         /* checkpoints */
    TIMERS
};

/* Row k is due at the first step at or after time k every. */
struct timer {
    double every; /* [s] */
    int64_t k, due;
};

struct outputs {
    fl_out table[TABLES]; /* f is NULL for a table that the scene does not write */
    struct timer timer[TIMERS];
    int32_t frame_file;      /* number of the open file of frames */
    double last_row;         /* of the loads [s] */
    fl_packed_writer packed; /* of frames, output.frames_form = packed */
};

/* Name of a table, as in its key output.NAME. */
const char *table_name(int table);

/* Path of a table now, "" if it is not written; frames over several files: NAME.k. */
void table_path(const struct run *r, const struct outputs *u, int table, char path[FL_SCENE_PATH + 16]);

/* Path of a table in the scene; the loads are not in it: "". */
const char *scene_path(const fl_scene *s, int table);

/* Set timer k of u to its row, with the interval of the scene. */
void set_timer(struct run *r, struct outputs *u, int timer, int64_t row);

/* Write the header of a table.  -1 with FL_SYSTEM. */
int write_header(struct run *r, struct outputs *u, int table, fl_err *err);

/* Open all tables of a new run.  -1 with FL_SYSTEM. */
int open_outputs(struct run *r, struct outputs *u, fl_err *err);

/* From now on an incomplete table keeps its rows and its name. */
void keep_outputs(struct outputs *u);

/* Write what is due at this step; or the last, shorter row of the loads at the end of the run.  -1 with
 * FL_SYSTEM. */
int write_due(struct run *r, struct outputs *u, fl_err *err);
int write_last_loads(struct run *r, struct outputs *u, fl_err *err);

/* Recompute when rows are due after the step has changed. */
void reschedule(struct run *r, struct outputs *u);

int close_outputs(struct outputs *u, fl_err *err);
void abort_outputs(struct outputs *u);
void discard_outputs(struct outputs *u); /* also those that would be kept */

#endif
