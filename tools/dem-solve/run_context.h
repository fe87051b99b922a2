/* SPDX-License-Identifier: GPL-3.0-or-later */
/* run_context.h -- what all parts of dem-solve know of a run. */
#ifndef DEM_SOLVE_RUN_CONTEXT_H
#define DEM_SOLVE_RUN_CONTEXT_H
#include "options.h"
#include "out/restart.h"
#include "scene/plausibility.h"
#include "sim/device_step.h"
#include "sim/error_budget.h"

/* Number of inputs that a checkpoint carries as texts: ice, structure, inflow. */
enum { INPUT_TEXTS = 3 };

struct run {
    const struct options *o;
    const fl_scene *scene;
    fl_floe_extent floes;             /* of the ice file; none in a run that is resumed */
    const int32_t *order;             /* [n] index in the world of the k-th body of the ice file */
    const fl_surface *surface;        /* NULL: none */
    const fl_surface *frames_surface; /* the same, or of members each piece of the chain as a part */
    const fl_member_model *members;   /* NULL: none */
    const char *history;              /* of the inputs; NULL: none */
    const fl_history_line *by;
    const fl_restart *resumed;         /* the checkpoint that the run continues; NULL: a new run */
    const fl_restart_part *input_text; /* [INPUT_TEXTS] for checkpoints */
    fl_world *w;
    fl_error_budget *budget; /* NULL without run.error */
    const char *loads_path;
    int gzip; /* the loads are compressed */

    double critical;             /* 2/omega by prediction [s] */
    int32_t step_body;           /* body that sets the automatic step, -1: none */
    char device[FL_DEVICE_NOTE]; /* who runs the spheres, and why */
    char step_by[160];           /* what sets the step, for --plan and the report */
    int64_t steps;               /* of the whole run */

    int64_t first_step; /* of this program, its time [s] and the contact-steps until then */
    double first_time;
    int64_t first_contact_steps;
    int64_t body_steps; /* of floes in the domain, by this program */

    double step_wall;      /* time in steps [s] */
    double cpu_time;       /* of all threads, in all of the run [s] */
    double budget_wall;    /* time for run.error [s] */
    double save_wall;      /* time for checkpoints [s] */
    int64_t saves;         /* checkpoints written */
    int64_t saved_step;    /* step of the last one */
    char step_change[120]; /* a resumed run has another step: from when on; "" otherwise */
    int refused;           /* the start is refused: no table stays */
    int started;           /* there is something to report */
    int warned_fast;       /* the warning of a body that moves by its thickness in a step was given */
    const int32_t *group;  /* [n] of each body, an index into groups; -1: none; for stages */
    const fl_string_table *groups;
    int settles, settled; /* 1: the run may come to rest, or has */
    int stopped;          /* number of the signal that ended the run, 0: none */
};

#endif
