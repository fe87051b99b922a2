/* SPDX-License-Identifier: GPL-3.0-or-later */
/* load_map.h -- what table_pressure.c finds, as plot_pressure.c draws it. */
#ifndef LOADSTATS_LOAD_MAP_H
#define LOADSTATS_LOAD_MAP_H
#include <stdint.h>
#include <stdio.h>
#include "stat/pressure.h"
#include "stat/waterline.h"
#include "options.h"

/* A load at one place against time: mean, largest value, how long there is any. */
typedef struct {
    double sum, now; /* over the times; of the time being read */
    double max, t_max;
    double loaded; /* the times, or seconds, with a load */
} panel_load_stats;

/* Local pressures of one part, by area [areas]. */
typedef struct {
    int32_t part;
    panel_load_stats p[AREAS_MAX]; /* [Pa] */
    fl_window best[AREAS_MAX];     /* the window of the largest one */
} place_part;

/* A panel: of a grid along the waterline and upward, or of the table panels. */
typedef struct {
    char *name;                   /* of the table panels; NULL in a grid */
    double from, to, bottom, top; /* [m] along the waterline and upward; NAN in the table panels */
    fl_vec3 middle;
    double area;
    panel_load_stats load; /* force on it [N] */
} load_panel;

typedef struct {
    const struct options *o;
    char *history;
    double weight; /* how many times, or seconds, there are: a mean is sum / weight */
    place_part *part;
    int32_t parts, part_cap;
    fl_waterline line;
    load_panel *panel; /* the places of a line load too: then height and area are 1 */
    int32_t panels, panel_cap;
    int32_t across; /* panels side by side in a grid, 0 for none */
    int32_t only;   /* the part that a waterline belongs to, 0 for none yet */
} place;

/* c A^-k through the largest pressures of a part. */
void fit_pressure_area(const place *p, const place_part *part, double *c, double *k);

/* Write the table. */
void load_map_write(FILE *f, const place *p, const fl_history_line *by);

/* Draw o->table into o->plot, made if need be.  0, or -1 with FL_SYSTEM in err. */
int plot_load_map(const place *p, const struct options *o, const fl_history_line *by, fl_err *err);

#endif
