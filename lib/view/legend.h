/* SPDX-License-Identifier: GPL-3.0-or-later */
/* legend.h -- annotations of a picture: colour bar with its unit, time, load curve with a cursor.  Sizes
 * follow the height of the picture. */
#ifndef FL_VIEW_LEGEND_H
#define FL_VIEW_LEGEND_H
#include "view/colour_map.h"

/* Draws the bar, at the lower right; bottom: pixels below it that are taken. */
void fl_legend_bar(fl_picture *p, const char *title, int map, double from, double to, int bottom);

/* Draws names with their colours, fl_colour_of_number(), at the lower right; of many the first ones. */
void fl_legend_names(fl_picture *p, const char *const *name, int n, int bottom);

/* Draws the time, at the lower left. */
void fl_legend_time(fl_picture *p, double t, int bottom);

/* Draws a line of text at the upper left. */
void fl_legend_note(fl_picture *p, const char *text);

/* Draws a curve y of n points over time, as a strip of `high` rows at the picture's lower edge;
 * fl_legend_curve_height(): what suits it.  The extent of time is [t0, t1], the cursor stands at t. */
typedef struct {
    const double *t, *y;
    int64_t n;
    double t0, t1;
    const char *title; /* with its unit */
} fl_curve;
int fl_legend_curve_height(const fl_picture *p);
void fl_legend_curve(fl_picture *p, const fl_curve *c, int high, double t);

#endif
