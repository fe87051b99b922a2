/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_pressure.h -- pictures of loads by place: pressure against area, load along the waterline, map of
 * panels. */
#ifndef LOADSTATS_PLOT_PRESSURE_H
#define LOADSTATS_PLOT_PRESSURE_H
#include <stdio.h>
#include "base/err.h"
#include "base/tool.h"
#include "load_map.h"

/* Data, script of gnuplot and height [pixels] of a picture. */
struct load_picture {
    void (*data)(FILE *f, const load_map *p);
    void (*script)(FILE *f, const load_map *p);
    int height;
};
extern const struct load_picture pressure_picture, line_picture, map_picture;

/* Draw the picture of the table into o->plot, created if needed.  0, or -1 with FL_SYSTEM in err. */
int plot_load_map(const load_map *p, const struct options *o, const fl_history_line *by, fl_err *err);

#endif
