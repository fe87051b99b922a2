/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/gnuplot.h"
#include "base/array.h"
#include "base/number_text.h"
#include "base/pi.h"
#include "base/stream.h"
#include "field_plot.h"

enum { WIDTH = 1000, CLASSES = 40, LAW_POINTS = 200, PATH_LEN = 4096 };

struct picture {
    const struct recipe *o;
    const fl_floes *floes;
    const struct floe_sizing *sizing;
    double *diameter; /* [floes.n] */
    FILE *data, *script;
};

static void write_number(FILE *f, double x)
{
    char text[FL_NUMBER_LEN];
    fputs(fl_number_text(x, text), f);
}

static void write_row(FILE *f, double x, double y)
{
    write_number(f, x);
    putc('\t', f);
    write_number(f, y);
    putc('\n', f);
}

/* --- scripts -------------------------------------------------------------------------------------------- */

static void begin_script(const struct picture *p, const char *stem, int height)
{
    FILE *f = p->script;
    fprintf(f, "# gnuplot %s.gp draws %s.%s from %s.tsv\n", stem, stem, p->o->format, stem);
    fprintf(f, "if (!exists(\"out\")) out = '%s.%s'\n", stem, p->o->format);
    if (strcmp(p->o->format, "png") == 0)
        fprintf(f, "set terminal pngcairo noenhanced size %d,%d font 'Sans,11' background '#ffffff'\n", WIDTH,
                height);
    else
        fprintf(f,
                "set terminal svg noenhanced size %d,%d dynamic font 'sans-serif,14' background '#ffffff'\n",
                WIDTH, height);
    fprintf(f,
            "set encoding utf8\nset output out\ndata = '%s.tsv'\n"
            "set border lc rgb '#444444' lw 1\n"
            "set tics nomirror out scale 0.6 textcolor rgb '#222222'\n",
            stem);
}

/* 1 if a logarithmic axis has a mark at k times a power of ten: few k for a wide range. */
static int is_mark(int k, double ratio)
{
    if (ratio > 1e3) return k == 1;
    if (ratio > 10.0) return k == 1 || k == 2 || k == 5;
    return ratio < 4.0 || k < 4 || k == 5 || k == 7;
}

/* gnuplot marks powers of ten only; a range of sizes may contain one or none. */
static void write_tics(FILE *f, const char *axis, double lo, double hi)
{
    const double end[3] = {lo, sqrt(lo * hi), hi};
    int marks = 0;
    fprintf(f, "set %stics (", axis);
    for (int e = (int)floor(log10(lo)); e <= (int)ceil(log10(hi)); e++)
        for (int k = 1; k < 10; k++) {
            const double x = k * pow(10.0, e);
            if (x >= lo && x <= hi && is_mark(k, hi / lo)) fprintf(f, "%s'%g' %g", marks++ ? ", " : "", x, x);
        }
    const int few = marks < 2, narrow = hi / lo < 1.01; /* three labels would overlap there */
    for (int k = narrow; few && k < 3 - narrow; k++)
        fprintf(f, "%s'%.4g' %.9g", marks++ ? ", " : "", end[k], end[k]);
    fputs(")\n", f);
}

/* --- the plan ------------------------------------------------------------------------------------------- */

/* The shown part of the field. */
static void plan_window(const struct picture *p, fl_vec2 *lo, fl_vec2 *hi)
{
    const struct recipe *o = p->o;
    const double part = p->floes->n > PLOT_FLOES ? sqrt((double)PLOT_FLOES / p->floes->n) : 1.0;
    *lo =
        (fl_vec2){o->origin.x + 0.5 * (1.0 - part) * o->size.x, o->origin.y + 0.5 * (1.0 - part) * o->size.y};
    *hi = (fl_vec2){lo->x + part * o->size.x, lo->y + part * o->size.y};
}

static int is_in_window(const struct picture *p, int32_t i, fl_vec2 lo, fl_vec2 hi)
{
    const fl_vec2 c = fl_polygon_centroid(p->floes->first[i + 1] - p->floes->first[i],
                                          p->floes->outer + p->floes->first[i]);
    return p->floes->n <= PLOT_FLOES || (c.x >= lo.x && c.x <= hi.x && c.y >= lo.y && c.y <= hi.y);
}

/* Write the closed outlines of the floes of size class k, separated by blank lines.  Returns 0 if there
 * are none. */
static int write_class(const struct picture *p, const int *class, int k, int first)
{
    int some = 0;
    for (int32_t i = 0; i < p->floes->n; i++) {
        const fl_vec2 *v = p->floes->outer + p->floes->first[i];
        const int32_t n = p->floes->first[i + 1] - p->floes->first[i];
        if (class[i] != k) continue;
        if (!some && !first) fputs("\n\n", p->data);
        else if (some) putc('\n', p->data);
        some = 1;
        for (int32_t e = 0; e <= n; e++) write_row(p->data, v[e % n].x, v[e % n].y);
    }
    return some;
}

static int write_plan(struct picture *p, fl_err *err)
{
    double least = INFINITY, most = 0.0;
    fl_vec2 lo, hi;
    int *class = fl_alloc(p->floes->n, sizeof *class, err), blocks = 0;
    if (!class) return -1;
    plan_window(p, &lo, &hi);
    for (int32_t i = 0; i < p->floes->n; i++) {
        least = fmin(least, p->diameter[i]);
        most = fmax(most, p->diameter[i]);
    }
    for (int32_t i = 0; i < p->floes->n; i++) {
        const double at = most > least ? log(p->diameter[i] / least) / log(most / least) : 0.0;
        class[i] = !is_in_window(p, i, lo, hi) ? -1 : at >= 1.0 ? CLASSES - 1 : (int)(at * CLASSES);
    }
    const double height = WIDTH * 0.78 * (hi.y - lo.y) / (hi.x - lo.x) + 150.0;
    begin_script(p, "plan", height < 300.0 ? 300 : height > 3000.0 ? 3000 : (int)height);
    fprintf(p->script,
            "set palette defined (0 '#440154', 1 '#443983', 2 '#31688e', 3 '#21918c', 4 '#35b779', "
            "5 '#90d743', 6 '#fde725')\n");
    fprintf(p->script, "set size ratio -1\nset xlabel 'x  [m]'\nset ylabel 'y  [m]'\nunset key\n");
    fprintf(p->script, "set xrange [%.10g:%.10g]\nset yrange [%.10g:%.10g]\n", lo.x, hi.x, lo.y, hi.y);
    fprintf(p->script, "set logscale cb\nset cbrange [%.6g:%.6g]\nset cblabel 'Diameter  [m]' offset 1.5\n",
            least * (1.0 - 1e-3), most * (1.0 + 1e-3));
    write_tics(p->script, "cb", least, most);
    fprintf(p->script, "set title '%d floes%s'\n", p->floes->n,
            p->floes->n > PLOT_FLOES ? ", the middle of the field" : "");
    fprintf(p->script, "set object 1 rectangle from graph 0,0 to graph 1,1 behind fc rgb '#dfe9f0' fs solid "
                       "noborder\nplot ");
    for (int k = 0; k < CLASSES; k++) {
        const double d = least * pow(most / least, (k + 0.5) / CLASSES);
        if (!write_class(p, class, k, blocks == 0)) continue;
        fprintf(p->script,
                "%sdata index %d using 1:2 with filledcurves closed fs solid border lc rgb '#222222' "
                "fc palette cb %.6g",
                blocks ? ", \\\n     " : "", blocks, d);
        blocks++;
    }
    fputs("\nset output\n", p->script);
    free(class);
    return 0;
}

/* --- the sizes ------------------------------------------------------------------------------------------ */

static int by_falling_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

static int write_sizes(struct picture *p, fl_err *err)
{
    const int32_t n = p->floes->n;
    const struct floe_sizing *s = p->sizing;
    (void)err;
    qsort(p->diameter, (size_t)n, sizeof *p->diameter, by_falling_size);
    for (int32_t k = 0; k < n; k = k < PLOT_RANKS ? k + 1 : k + k / (PLOT_RANKS / 2))
        write_row(p->data, p->diameter[k], k + 1.0);
    begin_script(p, "sizes", 620);
    fprintf(p->script,
            "set border 3\nset grid back lc rgb '#dddddd' lw 0.8\nset logscale xy\n"
            "set xlabel 'Diameter  [m]'\nset ylabel 'Floes of this diameter or larger'\n"
            "set yrange [0.7:%.6g]\nset xrange [%.6g:%.6g]\nset key top right Left reverse samplen 2\n",
            2.0 * n, 0.8 * p->diameter[n - 1], 1.25 * p->diameter[0]);
    write_tics(p->script, "x", p->diameter[n - 1], p->diameter[0]);
    fprintf(p->script, "plot data index 0 using 1:2 with steps lw 2 lc rgb '#6baed6' title 'achieved'");
    if (s) {
        const double lo = 0.8 * p->diameter[n - 1], hi = 1.25 * p->diameter[0];
        fputs("\n\n", p->data);
        for (int k = 0; k <= LAW_POINTS; k++) {
            const double d = lo * pow(hi / lo, (double)k / LAW_POINTS);
            const double above = p->o->floes * (1.0 - fl_sizes_cdf(&s->law, s->mean, 0.25 * PI * d * d));
            if (above > 0.0) write_row(p->data, d, above);
        }
        fprintf(p->script,
                ", \\\n     data index 1 using 1:2 with lines lw 1.2 lc rgb '#d94801' title 'asked: ");
        for (const char *c = p->o->sizes; *c; c++) fputs(*c == '\'' ? "''" : (char[]){*c, '\0'}, p->script);
        putc('\'', p->script);
    }
    fputs("\nset output\n", p->script);
    return 0;
}

/* --- files ---------------------------------------------------------------------------------------------- */

static int draw_picture(struct picture *p, const char *stem, int (*write)(struct picture *, fl_err *),
                        const fl_history_line *by, fl_err *err)
{
    char path[PATH_LEN];
    fl_out data = {0}, script = {0};
    int rc = -1;
    if (strlen(p->o->plot) > PATH_LEN - 40)
        return fl_fail(err, FL_SYSTEM, "the name of a picture in %.100s is too long", p->o->plot);
    snprintf(path, sizeof path, "%s/%s.tsv", p->o->plot, stem);
    if (fl_out_open(&data, path, 0, err)) goto done;
    snprintf(path, sizeof path, "%s/%s.gp", p->o->plot, stem);
    if (fl_out_open(&script, path, 0, err)) goto done;
    p->data = data.f;
    p->script = script.f;
    fl_write_file_header(data.f, stem, 1, NULL, by);
    fputs(write == write_plan ? "x[m]\ty[m]\n" : "d[m]\tfloes\n", data.f);
    if (write(p, err) || fl_out_close(&data, err) || fl_out_close(&script, err)) goto done;
    rc = fl_gnuplot_draw(p->o->plot, stem, p->o->format, err);
done:
    fl_out_abort(&data);
    fl_out_abort(&script);
    return rc;
}

int plot_field(const struct recipe *o, const fl_floes *floes, const struct floe_sizing *sizing,
               const fl_history_line *by, fl_err *err)
{
    struct picture p = {.o = o, .floes = floes, .sizing = sizing};
    int rc = -1;
    if (mkdir(o->plot, 0777) != 0 && errno != EEXIST)
        return fl_fail(err, FL_SYSTEM, "%s: %s", o->plot, strerror(errno));
    p.diameter = fl_alloc(floes->n, sizeof *p.diameter, err);
    if (!p.diameter) return -1;
    for (int32_t i = 0; i < floes->n; i++)
        p.diameter[i] =
            sqrt(4.0 / PI *
                 fl_polygon_area(floes->first[i + 1] - floes->first[i], floes->outer + floes->first[i]));
    rc = draw_picture(&p, "plan", write_plan, by, err) || draw_picture(&p, "sizes", write_sizes, by, err) ? -1
                                                                                                          : 0;
    free(p.diameter);
    return rc;
}
