/* SPDX-License-Identifier: GPL-3.0-or-later */
/* run.h -- from a built world to the end of the scene: steps, tables, report. */
#ifndef DEM_SOLVE_RUN_H
#define DEM_SOLVE_RUN_H
#include "base/stream.h"
#include "options.h"
#include "out/restart.h"
#include "sim/error_budget.h"

/* Texts that a checkpoint carries on. */
enum { KEPT = 3 };

/* What a run has in its hands. */
struct run {
    const struct options *o;
    const fl_scene *scene;
    const int32_t *at;         /* where the k-th body of the ice file is in the world */
    const fl_surface *surface; /* NULL: none */
    const char *history;       /* of the inputs; NULL: none */
    const fl_history_line *by;
    const fl_restart *saved;     /* the run goes on from here; NULL: it begins */
    const fl_restart_part *kept; /* [KEPT] ice, structure and inflow as texts, for checkpoints */
    fl_world *w;
    fl_error_budget *budget; /* NULL: the step is given or a fraction of the critical one */
    const char *out;         /* where the loads go */
    int gzip;                /* they are compressed */
    double limit;            /* the critical step known before the run, 2/omega [s] */
    int32_t step_body;       /* the body that set the automatic step, -1 */
    char step_by[160];       /* what the step comes from */
    int64_t steps;
    int64_t begun; /* the step this program began with, its time [s], and the contact-steps until then */
    double begun_time;
    int64_t begun_touching;
    int64_t moved;    /* steps of floes that were there, of this program */
    double wall;      /* [s] spent in steps */
    double busy;      /* [s] of processors, all threads: steps, looks, checkpoints and tables */
    double look_wall; /* [s] spent in looking after the error budget */
    int64_t saves;    /* checkpoints written */
    int64_t saved_at; /* step of the last */
    double save_wall; /* [s] spent in them */
    int going;        /* it has begun, or gone on: there is something to report */
    int swift;        /* a body that moves by its thickness in a step was told of */
    int stopped;      /* number of the signal that ended the run, 0: none */
};

/* Row k is due at the first step at or after k every. */
struct timer {
    double every;
    int64_t k, due;
};

enum {
    AT_LOADS,
    AT_STATE,
    AT_ENERGY,
    AT_CONTACTS,
    AT_HASH,
    AT_FRAMES,
    AT_PANELS, /* these two have the times of the loads */
    AT_EVENTS,
    AT_BONDS,
    TABLES,
    AT_ICE = TABLES,
    AT_SAVE,
    TIMERS
};

/* The tables and when they are due. */
struct outputs {
    fl_out table[TABLES]; /* f is NULL where the scene has none */
    struct timer at[TIMERS];
    int32_t frame_file; /* number of the one that is open */
    double last_row;    /* of the loads [s] */
};

/* Choose the step: the scene's, or the automatic one, then a little smaller so that it divides the interval
 * of the loads. */
void run_step_size(struct run *r);

/* Steps until the end of the scene, from the step size that the world has. */
void run_steps(struct run *r);

/* -1 with FL_INPUT where these are more than can be counted. */
int run_countable(const struct run *r, fl_err *err);

/* Set a timer to its row k. */
void run_timer(struct timer *t, int64_t k, const fl_world *w);

/* File number u->frame_file of the frames: the name itself, or NAME.k when there are several. */
void run_frames_path(const struct run *r, const struct outputs *u, char path[FL_SCENE_PATH + 16]);

/* What table k begins with. */
void run_header(struct run *r, struct outputs *u, int k);

/* The whole run. -1 as fl_step(), or FL_SYSTEM when an output cannot be written; what was written until then
 * is complete and carries its name. */
int run_scene(struct run *r, fl_err *err);

/* warn.c: what is wrong with a scene that can be run, on standard error: before its first step, at a row of
 * the loads, and when it has ended. */
void warn_at_start(const struct run *r);
void warn_at_row(struct run *r, double t);
void warn_at_end(const struct run *r, int failed);

/* report.c */
void report_write(const struct run *r, FILE *f);

/* A line about bonds that are too long for their fracture energy; nothing where none is. */
void report_bonds(const fl_world *w, FILE *f);

/* plan_probe.c: --plan and --probe */
int look_plan(struct run *r, FILE *f, fl_err *err);
int look_probe(struct run *r, FILE *f, fl_err *err);

/* "body 7", or for a number behind all of them the part or structure that moves, or of a floe
 * that has left (-1), into name. */
const char *run_body(const fl_world *w, int32_t k, char name[64]);

/* Seconds of a clock that only goes forward. */
double run_clock(void);

/* Seconds that processors have worked for this program, of all threads together. */
double run_processor(void);

#endif
