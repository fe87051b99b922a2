/* SPDX-License-Identifier: GPL-3.0-or-later */
/* picture.h -- common parts of all pictures by gnuplot: names, data, panels, and the run of gnuplot. */
#ifndef LOADSTATS_PICTURE_H
#define LOADSTATS_PICTURE_H
#include <stdio.h>
#include "base/err.h"
#include "base/tool.h"
#include "cell.h"
#include "settings.h"

enum { PLOT_STEM_LEN = 80, PLOT_FOOT = 70 };

/* A factor and the prefix of the unit: newtons and pascals in thousands or millions, so that the axis of
 * values up to magnitude `large` has short numbers. */
typedef struct {
    double factor;
    const char *prefix;
} plot_scale;
plot_scale plot_scale_of(const char *unit, double large);

/* "Horizontal force  [kN]" for "fh", "N" and values up to magnitude large; unit may be "". */
void plot_axis_label(char *label, size_t size, const char *signal, const char *unit, double large);

/* Start a script: its use, terminal, size in pixels, output, data = the name of its data. */
void plot_open(FILE *f, const char *stem, const char *format, int width, int height);

/* Size of the font of a title: points in svg, those of the screen in the others. */
int plot_head_size(const char *format);

/* DIR/STEM.END.  0, or -1 with FL_SYSTEM in err when it is too long. */
enum { PLOT_PATH_LEN = 4096 };
int plot_path(char path[PLOT_PATH_LEN], const char *dir, const char *stem, const char *end, fl_err *err);

/* Print a text of a gnuplot script between single quotes. */
void plot_quoted(FILE *f, const char *text);

/* Run gnuplot on DIR/STEM.gp, which must write to the file named in the variable out, and rename the complete
 * picture to DIR/STEM.FORMAT.  0, or -1 with FL_SYSTEM in err. */
int plot_draw(const char *dir, const char *stem, const char *format, fl_err *err);

/* A picture of one part, panels one below the other, with its data and its script. */
typedef struct {
    const struct record_views *r;
    const struct options *o;
    const fl_history_line *by;
    int32_t part;
    const char *name;         /* "history", "peaks" */
    char stem[PLOT_STEM_LEN]; /* "history-tower" */
    int panels;
    FILE *data, *script;
    int gap;    /* between panels [pixels], for the labels below each */
    int blocks; /* blocks of the data file so far: the index of gnuplot */
    int curves; /* curves of the panel so far */
} picture;

/* A kind of picture: of each part by fill(), or of all parts by draw_all_parts(). */
struct picture_kind {
    const char *name;
    /* 1 where there is something to draw, 0, or -1 with err; NULL: always. */
    int (*drawable)(const picture *p, fl_err *err);
    /* Write data and script for make_picture().  0, or -1 with FL_INPUT or FL_SYSTEM in err. */
    int (*fill)(picture *p, fl_err *err);
    /* Draw into the folder o->plot, which exists.  0, or -1 with FL_SYSTEM in err. */
    int (*draw_all_parts)(const struct record_views *r, const struct options *o, const fl_history_line *by,
                          fl_err *err);
};

/* Make the picture plan->name: open data and script, let fill() write into both, run gnuplot.  0, or -1 with
 * the errors of fill() or FL_SYSTEM in err. */
int make_picture(const picture *plan, int (*fill)(picture *, fl_err *), fl_err *err);

/* The first lines of the script, when the number of panels is known; the part is added to the heading. */
void plot_start(const picture *p, const char *heading);

/* Begin panel k, between two fractions of the width, 0 .. 1; end it, after which title and key are off. */
void plot_set_margins(picture *p, int k, double left, double right);
void plot_end_panel(const picture *p);

/* "plot data index K " for the next curve of the panel.  The caller adds its columns, and its data as a
 * block that begins with plot_block(). */
void plot_curve(picture *p);
void plot_block(picture *p);

/* A row of data: signal, unit and view; then n numbers, which end it. */
void plot_label(const picture *p, int32_t s, int w);
void plot_columns(const picture *p, int n, const double *x);

/* For signal s of the part: scale and label of an axis, by its largest value; title of a vertical axis at the
 * fraction x of the width; step of tics that divides a range into three to six. */
plot_scale plot_scale_of_signal(const picture *p, int32_t s);
void plot_signal_label(const picture *p, int32_t s, char *label, size_t size);
void plot_left_title(const picture *p, const char *text, double x);
double plot_tics(double range);

/* True if signal s of the part exists and is not constant; the second one for any signal, as drawable(). */
int plot_signal_varies(const picture *p, int32_t s);
int plot_part_varies(const picture *p, fl_err *err);

/* True if the picture is of the sum over the parts, or of the only part. */
int picture_of_sum(const picture *p);

/* True for a loads table, whose rows are means. */
int plot_is_loads(const picture *p);

#endif
