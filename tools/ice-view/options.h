/* SPDX-License-Identifier: GPL-3.0-or-later */
/* options.h -- the command line of ice-view. */
#ifndef ICE_VIEW_OPTIONS_H
#define ICE_VIEW_OPTIONS_H
#include "base/err.h"
#include "base/tool.h"
#include "view/look.h"

enum { PICTURES_MAX = 8 };

struct options {
    const char *in;
    double at, from, to, fps, times; /* NAN: not given */
    const char *movie, *html, *vtk, *text, *packed;
    const char *ice, *structure, *table, *loads, *contacts, *bonds, *scene, *panels;
    const char *component, *part, *save_look;
    int points, info, keys, window;
    int32_t every;
    double bound_x, bound_q;
    fl_look look;
    const char *out;
    int gzip, quiet, verbose, ended;
    int32_t threads;
};

int options_parse(struct options *o, int argc, char **argv, fl_err *err);

/* History line of this run. */
void options_by(const struct options *o, fl_history_line *by);

#endif
