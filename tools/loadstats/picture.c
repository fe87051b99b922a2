/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/gnuplot.h"
#include "base/stream.h"
#include "picture.h"

enum { WIDTH = 1000, PANEL = 200, HEAD = 66 };

/* --- names and units ------------------------------------------------------------------------------------ */

static const char *title_of(const char *signal)
{
    static const char *const known[][2] = {
        {"fx", "Force in x"},         {"fy", "Force in y"},     {"fz", "Force in z"},
        {"fh", "Horizontal force"},   {"f", "Force"},           {"mx", "Moment about x"},
        {"mh", "Overturning moment"}, {"my", "Moment about y"}, {"mz", "Moment about z"},
        {"fpeak", "Largest force"},   {"contacts", "Contacts"}, {"resistance", "Resistance"}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strcmp(signal, known[k][0]) == 0) return known[k][1];
    return signal;
}

plot_scale plot_scale_of(const char *unit, double large)
{
    if ((unit[0] != 'N' && strcmp(unit, "Pa") != 0) || large < 1e3) return (plot_scale){1.0, ""};
    return large < 1e6 ? (plot_scale){1e-3, "k"} : (plot_scale){1e-6, "M"};
}

static double largest_of(const picture *p, int32_t s)
{
    const fl_descriptive_stats *d = &find_view(p->r, p->part, s, 0)->stats;
    return fmax(fabs(d->min), fabs(d->max));
}

plot_scale plot_scale_of_signal(const picture *p, int32_t s)
{
    return plot_scale_of(p->r->series->unit[s], largest_of(p, s));
}

void plot_quoted(FILE *f, const char *text)
{
    putc('\'', f);
    for (; *text; text++) {
        if (*text == '\'') putc('\'', f);
        putc(*text, f);
    }
    putc('\'', f);
}

void plot_axis_label(char *label, size_t size, const char *signal, const char *unit, double large)
{
    const char *title = title_of(signal);
    if (unit[0]) snprintf(label, size, "%.200s  [%s%.60s]", title, plot_scale_of(unit, large).prefix, unit);
    else snprintf(label, size, "%.200s", title);
}

void plot_signal_label(const picture *p, int32_t s, char *label, size_t size)
{
    plot_axis_label(label, size, p->r->series->signal[s], p->r->series->unit[s], largest_of(p, s));
}

/* gnuplot places the title of a vertical axis beside its longest number; a label at a fixed x aligns the
 * titles. */
void plot_left_title(const picture *p, const char *text, double x)
{
    fputs("set label 2 ", p->script);
    plot_quoted(p->script, text);
    fprintf(p->script, " at screen %.4f, graph 0.5 center rotate\n", x);
}

/* A part may have any name.  Other characters become _, and the number of the part then distinguishes the
 * file. */
static void make_stem(picture *p)
{
    const char *name = p->r->series->part[p->part];
    int plain = strlen(name) < 40 && name[0] != '\0', n;
    n = snprintf(p->stem, sizeof p->stem, "%s-%.40s", p->name, strcmp(name, "-") == 0 ? "all" : name);
    for (char *c = p->stem; *c; c++) {
        if (strchr("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.", *c)) continue;
        *c = '_';
        plain = 0;
    }
    if (!plain) snprintf(p->stem + n, sizeof p->stem - (size_t)n, "+%d", p->part);
}

/* --- data ----------------------------------------------------------------------------------------------- */

void plot_block(picture *p)
{
    if (p->blocks++) fputs("\n\n", p->data);
}

void plot_label(const picture *p, int32_t s, int w)
{
    const char *unit = p->r->series->unit[s];
    fprintf(p->data, "%s\t%s\t%s", p->r->series->signal[s], unit[0] ? unit : "-", view_name(w));
}

void plot_columns(const picture *p, int n, const double *x)
{
    for (int k = 0; k < n; k++) {
        putc('\t', p->data);
        write_number(p->data, x[k]);
    }
    putc('\n', p->data);
}

/* --- scripts -------------------------------------------------------------------------------------------- */

/* Line styles: 1 raw beside filtered, thin and light; 2 filtered; 3 raw alone. */
static const char *const STYLES = "set style line 1 lc rgb '#85bcdb' lw 1.0 pt 6 ps 0.6\n"
                                  "set style line 2 lc rgb '#08519c' lw 2.0 pt 7 ps 0.5\n"
                                  "set style line 3 lc rgb '#2171b5' lw 1.2 pt 7 ps 0.5\n"
                                  "set style line 9 lc rgb '#dddddd' lw 0.8\n"
                                  "set border 3 lc rgb '#444444' lw 1\n"
                                  "set tics nomirror out scale 0.6 textcolor rgb '#222222'\n"
                                  "set grid back ls 9\n";

void plot_open(FILE *f, const char *stem, const char *format, int width, int height)
{
    fprintf(f, "# gnuplot %s.gp draws %s.%s from %s.tsv\n", stem, stem, format, stem);
    fprintf(f, "if (!exists(\"out\")) out = '%s.%s'\n", stem, format);
    if (strcmp(format, "png") == 0)
        fprintf(f, "set terminal pngcairo noenhanced size %d,%d font 'Sans,11' background '#ffffff'\n", width,
                height);
    else if (strcmp(format, "pdf") == 0) /* in inches, 96 pixels each */
        fprintf(f, "set terminal pdfcairo noenhanced size %.4g,%.4g font 'Sans,11' background '#ffffff'\n",
                width / 96.0, height / 96.0);
    else
        fprintf(f,
                "set terminal svg noenhanced size %d,%d dynamic font 'sans-serif,14' background '#ffffff'\n",
                width, height);
    fprintf(f, "set encoding utf8\nset output out\ndata = '%s.tsv'\n", stem);
}

int plot_head_size(const char *format) { return strcmp(format, "svg") == 0 ? 18 : 14; }

static int height_of(const picture *p)
{
    return HEAD + p->panels * PANEL + (p->panels - 1) * p->gap + PLOT_FOOT;
}

int plot_signal_varies(const picture *p, int32_t s)
{
    const fl_signal_view *v = find_view(p->r, p->part, s, 0);
    return v && v->stats.max > v->stats.min;
}

int plot_part_varies(const picture *p, fl_err *err)
{
    (void)err;
    for (int32_t s = 0; s < p->r->series->signals; s++)
        if (plot_signal_varies(p, s)) return 1;
    return 0;
}

int picture_of_sum(const picture *p)
{
    const fl_series *s = p->r->series;
    return s->parts <= 2 || p->part == s->parts - 1 || strcmp(s->part[s->parts - 1], "total") != 0;
}

int plot_is_loads(const picture *p) { return strcmp(p->r->series->kind, "loads") == 0; }

void plot_start(const picture *p, const char *heading)
{
    FILE *f = p->script;
    const int height = height_of(p);
    char title[200];
    plot_open(f, p->stem, p->o->format, WIDTH, height);
    fprintf(f, "%sset multiplot\n", STYLES);
    snprintf(title, sizeof title, "%s, %.100s", heading,
             strcmp(p->r->series->part[p->part], "-") == 0 ? p->r->series->kind
                                                           : p->r->series->part[p->part]);
    fputs("set label 1 ", f);
    plot_quoted(f, title);
    fprintf(f, " at screen 0.5, screen %.4f center font ',%d' textcolor rgb '#111111'\n", 1.0 - 24.0 / height,
            plot_head_size(p->o->format));
    fprintf(f, "set key at screen 0.975, screen %.4f right top horizontal Left reverse samplen 2\n",
            1.0 - 40.0 / height);
}

/* All panels have the same margins, so that axes are aligned. */
void plot_set_margins(picture *p, int k, double left, double right)
{
    const double height = height_of(p), top = HEAD + k * (PANEL + p->gap);
    fprintf(p->script, "set lmargin at screen %.4f\nset rmargin at screen %.4f\n", left, right);
    fprintf(p->script, "set tmargin at screen %.4f\nset bmargin at screen %.4f\n", 1.0 - top / height,
            1.0 - (top + PANEL) / height);
    p->curves = 0;
}

void plot_curve(picture *p)
{
    fprintf(p->script, "%sdata index %d ", p->curves++ ? ", \\\n     " : "plot ", p->blocks);
}

/* Title and key stand on the first panel only. */
void plot_end_panel(const picture *p) { fputs("\nunset key\nunset label 1\n", p->script); }

/* 1, 2 or 5 times a power of ten. */
double plot_tics(double range)
{
    const double unit = pow(10.0, floor(log10(range / 3.0))), k = range / 3.0 / unit;
    return unit * (k >= 5.0 ? 5.0 : k >= 2.0 ? 2.0 : 1.0);
}

/* --- files ---------------------------------------------------------------------------------------------- */

int plot_path(char path[PLOT_PATH_LEN], const char *dir, const char *stem, const char *end, fl_err *err)
{
    if (snprintf(path, PLOT_PATH_LEN, "%s/%s.%s", dir, stem, end) < PLOT_PATH_LEN) return 0;
    return fl_fail(err, FL_SYSTEM, "the name of a picture in %.100s is too long", dir);
}

int plot_draw(const char *dir, const char *stem, const char *format, fl_err *err)
{
    return fl_gnuplot_draw(dir, stem, format, err);
}

int make_picture(const picture *plan, int (*fill)(picture *, fl_err *), fl_err *err)
{
    picture p = *plan;
    fl_out data = {0}, script = {0};
    char path[PLOT_PATH_LEN];
    int rc = -1;
    make_stem(&p);
    if (plot_path(path, p.o->plot, p.stem, "tsv", err) || fl_out_open(&data, path, 0, err)) goto done;
    if (plot_path(path, p.o->plot, p.stem, "gp", err) || fl_out_open(&script, path, 0, err)) goto done;
    p.data = data.f;
    p.script = script.f;
    fl_write_file_header(p.data, p.name, 1, p.r->series->history, p.by);
    if (fill(&p, err)) goto done;
    fputs("unset multiplot\nset output\n", p.script);
    if (fl_out_close(&data, err) || fl_out_close(&script, err)) goto done;
    rc = plot_draw(p.o->plot, p.stem, p.o->format, err);
done:
    fl_out_abort(&data);
    fl_out_abort(&script);
    return rc;
}
