/* SPDX-License-Identifier: GPL-3.0-or-later */
/* options.h -- the command line of arc-path. */
#ifndef ARC_PATH_OPTIONS_H
#define ARC_PATH_OPTIONS_H
#include "base/tool.h"
#include "member/member_path.h"

enum { WATCH_MAX = 64, UNTIL_MAX = 16, SHAPES_MAX = 64 };

/* --until NAME=VALUE: ends the path at the first point where the column is VALUE or beyond. */
struct until {
    char name[220];
    double value;
};

struct options {
    const char *model; /* borrowed from argv */
    fl_path_options path;
    const char *control;           /* freedom of --control, NULL: none */
    int constraint, predictor;     /* as numbers of the choices; path has them too */
    int32_t load_steps, max_steps; /* the same */
    char *watch[WATCH_MAX];
    int watches, untils;
    struct until until[UNTIL_MAX];
    int32_t points;            /* at most */
    double scatter, amplitude; /* imperfections */
    const char *shape;         /* file of the imperfection, NULL: none */
    uint64_t seed;
    const char *plot, *reference, *format;
    int32_t shape_at[SHAPES_MAX]; /* points whose shape is written */
    int shapes;
    const char *frames; /* of all points, for ice-view; NULL: none */
    const char *checkpoint, *resume;
    int32_t modes; /* number of modes, in place of the path; 0: the path */
    double ratio;  /* damping ratio of their table */
    const char *out;
    int gzip, quiet, verbose, threads;
    int ended;
};

/* Answers --help and --version itself.  -1 with FL_USAGE. */
int options_parse(struct options *o, int argc, char **argv, fl_err *err);

void options_free(struct options *o);

/* What bears on the result, for the history. */
void options_by(const struct options *o, fl_history_line *by);

#endif
