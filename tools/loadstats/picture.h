/* SPDX-License-Identifier: GPL-3.0-or-later */
/* picture.h -- what all pictures by gnuplot have in common: names, data, panels, and the run of gnuplot. */
#ifndef LOADSTATS_PICTURE_H
#define LOADSTATS_PICTURE_H
#include "table_stats.h"

enum { PLOT_STEM_LEN = 80, PLOT_FOOT = 70 };

/* A factor and the prefix of the unit that goes with it: newtons and pascals in thousands or millions, so
 * that the axis of values up to `large` in size has short numbers. */
typedef struct {
    double factor;
    const char *prefix;
} plot_scale;
plot_scale plot_scale_of(const char *unit, double large);

/* "Horizontal force  [kN]" for "fh", "N" and values up to large in size; unit may be "". */
void plot_axis(char *label, size_t size, const char *signal, const char *unit, double large);

/* What a script begins with: how to run it, terminal, size in pixels, output, data = the name of its data. */
void plot_open(FILE *f, const char *stem, const char *format, int width, int height);

/* DIR/STEM.END.  0, or -1 with FL_SYSTEM in err when it is too long. */
enum { PLOT_PATH_LEN = 4096 };
int plot_path(char path[PLOT_PATH_LEN], const char *dir, const char *stem, const char *end, fl_err *err);

/* Print a text of a gnuplot script, between single quotes. */
void plot_quoted(FILE *f, const char *text);

/* Run gnuplot on DIR/STEM.gp, which must write to the file named in the variable out, and name what it drew
 * DIR/STEM.FORMAT when it is complete.  0, or -1 with FL_SYSTEM in err. */
int plot_draw(const char *dir, const char *stem, const char *format, fl_err *err);

/* A picture of one part, panels one below the other, with its data and its script. */
typedef struct {
    const struct result *r;
    const struct options *o;
    const fl_history_line *by;
    int32_t part;
    const char *what;         /* "history", "peaks" */
    char stem[PLOT_STEM_LEN]; /* "history-tower" */
    int panels;
    FILE *data, *script;
    int gap;    /* between panels [pixels]: room for what is written below each */
    int blocks; /* of the data file so far: what gnuplot calls its index */
    int curves; /* of the panel so far */
} picture;

/* Make the picture of plan->what: open data and script, let fill() write into both, run gnuplot.  0, or -1
 * with the errors of fill() or FL_SYSTEM in err. */
int plot_make(const picture *plan, int (*fill)(picture *, fl_err *), fl_err *err);

/* The first lines of the script, when the number of panels is known; the part is added to the heading. */
void plot_start(const picture *p, const char *heading);

/* Panel k between two places of the width, 0 .. 1; and its end, after which title and key are no more. */
void plot_place(picture *p, int k, double left, double right);
void plot_end_panel(const picture *p);

/* "plot data index K " for the next curve of the panel; then comes what it uses, and its data, a block that
 * begins with plot_block(). */
void plot_curve(picture *p);
void plot_block(picture *p);

/* Of a row of data: signal, unit and view; then n numbers, which end it. */
void plot_label(const picture *p, int32_t s, int w);
void plot_columns(const picture *p, int n, const double *x);

/* For signal s of the part: scale and title of an axis, by its largest value; a title of a vertical axis at
 * the place x of the width; a step of tics that cuts a range into three to six. */
plot_scale plot_scale_here(const picture *p, int32_t s);
void plot_axis_text(const picture *p, int32_t s, char *label, size_t size);
void plot_left_title(const picture *p, const char *text, double x);
double plot_tics(double range);

/* Is it a loads table, whose rows are means? */
int plot_is_loads(const picture *p);

#endif
