/* SPDX-License-Identifier: GPL-3.0-or-later */
/* load_map.h -- loads by place on a structure: local pressures of windows, or loads of panels. */
#ifndef LOADSTATS_LOAD_MAP_H
#define LOADSTATS_LOAD_MAP_H
#include <stdint.h>
#include "base/err.h"
#include "stat/pressure.h"
#include "stat/waterline.h"
#include "settings.h"

/* Load against time at one place. */
typedef struct {
    double sum, now; /* sum over the times; at the time being read */
    double max, t_max;
    double loaded; /* number of times, or seconds, with a load */
} panel_load_stats;

/* Local pressures of one part, by area [areas]. */
typedef struct {
    int32_t part;
    panel_load_stats p[AREAS_MAX]; /* [Pa] */
    fl_window best[AREAS_MAX];     /* the window of the largest one */
} part_pressure;

/* A panel: of a grid along the waterline and upward, or of the table panels. */
typedef struct {
    char *name;                   /* of the table panels; NULL in a grid */
    double from, to, bottom, top; /* [m] along the waterline and upward; NAN in the table panels */
    fl_vec3 middle;
    double area;
    panel_load_stats load; /* force on it [N] */
} load_panel;

typedef struct load_map {
    const struct options *o;
    char *history, *run_lines; /* of the table; NULL: none */
    double weight;             /* number of times, or seconds: a mean is sum / weight */
    part_pressure *part;
    int32_t parts, part_cap;
    fl_waterline line;
    load_panel *panel; /* also the sections of a line load, of height and area 1 */
    int32_t panels, panel_cap;
    int32_t across; /* panels side by side in a grid, 0 for none */
    int32_t only;   /* the part of the waterline, 0 for none yet */
} load_map;

/* Read contacts or panels, as o->table needs them.  0, or -1 with err; p is to be freed either way. */
int load_map_read(load_map *p, const struct options *o, fl_err *err);

/* Name of a part of the structure, -1 for the first, by a line "#part NUMBER NAME" of the table; the number
 * where there is none.  Returns text. */
enum { PART_TEXT = 100 };
const char *load_map_part(const load_map *p, int32_t part, char text[PART_TEXT]);

/* Fit c A^-k to the largest pressures of a part. */
void fit_pressure_area(const load_map *p, const part_pressure *part, double *c, double *k);

/* Accepts a zeroed struct and leaves one. */
void load_map_free(load_map *p);

#endif
