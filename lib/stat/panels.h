/* SPDX-License-Identifier: GPL-3.0-or-later */
/* panels.h -- reads the load on panels, the table of panels(5), one time after the other. */
#ifndef FL_STAT_PANELS_H
#define FL_STAT_PANELS_H
#include "base/table.h"
#include "geom/vec3.h"

typedef struct {
    char *name;
    fl_vec3 middle; /* [m] */
    double area;    /* > 0 [m^2] */
    fl_vec3 force;  /* on it, the mean over the interval that was read last [N] */
} fl_panel;

typedef struct {
    fl_table table;
    int32_t col[9];
    fl_panel *panel; /* [n] panels of the first time, in its order; all of them are present at every time */
    int32_t n, cap;
    double t, edge[2]; /* the time as written, and the interval it ends [s] */
    double next;       /* the time of the row in the table, when it is pending */
    int pending;
    int64_t times; /* read so far */
} fl_panels;

/* Open a table.  0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int fl_panels_open(fl_panels *p, const char *path, fl_err *err);

/* The next time.  1, 0 at the end, or -1 with err: FL_INPUT for no row at all, a panel missing, new or out of
 * order, time that does not rise, an area not above 0, a field that is not a number. */
int fl_panels_next(fl_panels *p, fl_err *err);

/* Accepts a zeroed struct and leaves one. */
void fl_panels_close(fl_panels *p);

#endif
