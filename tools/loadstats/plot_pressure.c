/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include "base/stream.h"
#include "cell.h"
#include "picture.h"
#include "load_map.h"
#include "plot_pressure.h"
#include "table_kind.h"

enum { WIDTH = 1000, PARTS_DRAWN = 6 };

static const char *const STYLES = "set border 3 lc rgb '#444444' lw 1\n"
                                  "set tics nomirror out scale 0.6 textcolor rgb '#222222'\n"
                                  "set datafile separator '\\t'\nset datafile missing '-'\n";

static const char *const COLOUR[PARTS_DRAWN] = {"#08519c", "#c8642d", "#3f8f5f",
                                                "#7b4fa3", "#b8860b", "#555555"};

static void write_title(FILE *f, const char *text) { fprintf(f, "set title '%s' offset 0,0.4\n", text); }

/* --- pressure against area ------------------------------------------------------------------------------ */

static void write_pressure_data(FILE *f, const load_map *p)
{
    fputs("part\tarea[m2]\tp_max[MPa]\tp_mean[MPa]\n", f);
    for (int32_t k = 0; k < p->parts && k < PARTS_DRAWN; k++) {
        fputs("\n\n", f);
        for (int32_t a = 0; a < p->o->areas; a++) {
            const panel_load_stats *l = &p->part[k].p[a];
            char name[PART_TEXT];
            fputs(load_map_part(p, p->part[k].part, name), f);
            write_cell(f, p->o->area[a]);
            write_cell(f, l->max > 0.0 ? 1e-6 * l->max : (double)NAN);
            write_cell(f, l->sum > 0.0 ? 1e-6 * l->sum / p->weight : (double)NAN);
            putc('\n', f);
        }
    }
}

static void write_pressure_script(FILE *f, const load_map *p)
{
    const int32_t parts = p->parts < PARTS_DRAWN ? p->parts : PARTS_DRAWN;
    double lo = INFINITY, hi = 0.0;
    for (int32_t a = 0; a < p->o->areas; a++) {
        lo = fmin(lo, p->o->area[a]);
        hi = fmax(hi, p->o->area[a]);
    }
    write_title(f, "Local pressure, largest at any time and place");
    fprintf(f,
            "set logscale xy\nset format '%%g'\nset xrange [%g:%g]\nset xlabel 'Area of the window  [m²]'\n"
            "set ylabel 'Pressure  [MPa]'\nset grid back lc rgb '#dddddd' lw 0.8\n"
            "set key outside right top Left reverse samplen 2\n",
            lo / 1.25, hi * 1.25);
    fputs("plot (x <= 10 ? 7.40 * x**-0.70 : 1.48) with lines lw 1.2 dt 2 lc rgb '#888888' title 'ISO 19906, "
          "massive ice'",
          f);
    for (int32_t k = 0; k < parts; k++) {
        double c, e;
        char name[PART_TEXT + 2] = "", part[PART_TEXT];
        if (parts > 1) snprintf(name, sizeof name, "%s, ", load_map_part(p, p->part[k].part, part));
        for (char *at = name; *at; at++)
            if (*at == '\'') *at = '_'; /* it would end the title */
        fit_pressure_area(p, &p->part[k], &c, &e);
        fprintf(f, ", \\\n     data index %d using 2:3 with points pt 7 ps 0.8 lc rgb '%s' title '%slargest'",
                k + 1, COLOUR[k], name);
        fprintf(
            f,
            ", \\\n     data index %d using 2:4 with points pt 6 ps 0.8 lc rgb '%s' title '%smean in time'",
            k + 1, COLOUR[k], name);
        if (isfinite(c))
            fprintf(f, ", \\\n     %g * x**%g with lines lw 1 lc rgb '%s' title '%.3g A^%.2f MPa'", 1e-6 * c,
                    -e, COLOUR[k], 1e-6 * c, -e);
    }
    putc('\n', f);
}

/* --- load along the waterline --------------------------------------------------------------------------- */

static void write_line_data(FILE *f, const load_map *p)
{
    fputs("s[m]\tq_mean\tq_max\twidth[m]\n\n\n", f);
    for (int32_t k = 0; k < p->panels; k++) {
        const load_panel *q = &p->panel[k];
        const double width = q->to - q->from;
        write_number(f, 0.5 * (q->from + q->to));
        write_cell(f, q->load.sum / p->weight / width);
        write_cell(f, q->load.max / width);
        write_cell(f, width);
        putc('\n', f);
    }
}

static void write_line_script(FILE *f, const load_map *p)
{
    const double width = p->line.length / p->across;
    double max = 0.0, mean = 0.0;
    for (int32_t k = 0; k < p->panels; k++) {
        max = fmax(max, p->panel[k].load.max / width);
        mean = fmax(mean, fabs(p->panel[k].load.sum / p->weight / width));
    }
    const plot_scale a = plot_scale_of("N/m", max), b = plot_scale_of("N/m", mean);
    write_title(f, "Load along the waterline");
    fprintf(
        f,
        "set multiplot\nset lmargin at screen 0.1\nset rmargin at screen 0.97\nset xrange [0:%g]\n"
        "set yrange [0:*]\nunset key\nset style fill solid 1 noborder\nset grid ytics back lc rgb '#dddddd'\n"
        "set tmargin at screen 0.89\nset bmargin at screen 0.56\nset format x ''\n"
        "set ylabel 'Largest  [%sN/m]'\nplot data index 1 using 1:(%g*$3):4 with boxes lc rgb '#08519c'\n"
        "unset title\nset tmargin at screen 0.49\nset bmargin at screen 0.16\nset format x '%%g'\n"
        "set xlabel 'Along the waterline  [m]'\nset ylabel 'Mean  [%sN/m]'\nset yrange [*:*]\n"
        "plot data index 1 using 1:(%g*$2):4 with boxes lc rgb '#6baed6'\nunset multiplot\n",
        p->line.length, a.prefix, a.factor, b.prefix, b.factor);
}

/* --- map ------------------------------------------------------------------------------------------------ */

/* The two axes along which panels without a waterline extend most. */
static void widest_axes(const load_map *p, int way[2])
{
    double wide[3];
    for (int d = 0; d < 3; d++) {
        double lo = INFINITY, hi = -INFINITY;
        for (int32_t k = 0; k < p->panels; k++) {
            const fl_vec3 x = p->panel[k].middle;
            const double v = d == 0 ? x.x : d == 1 ? x.y : x.z;
            lo = fmin(lo, v);
            hi = fmax(hi, v);
        }
        wide[d] = hi - lo;
    }
    const int out = wide[0] <= wide[1] && wide[0] <= wide[2] ? 0 : wide[1] <= wide[2] ? 1 : 2;
    way[0] = out == 0;
    way[1] = out == 2 ? 1 : 2;
}

/* Each panel as a rectangle: middle, half width and half height, pressures. */
static void write_map_data(FILE *f, const load_map *p)
{
    int way[2];
    widest_axes(p, way);
    fputs("across[m]\tup[m]\thalf_width[m]\thalf_height[m]\tp_mean\tp_max\n\n\n", f);
    for (int32_t k = 0; k < p->panels; k++) {
        const load_panel *q = &p->panel[k];
        const double at[3] = {q->middle.x, q->middle.y, q->middle.z}, side = 0.5 * sqrt(q->area);
        write_number(f, p->across ? 0.5 * (q->from + q->to) : at[way[0]]);
        write_cell(f, p->across ? 0.5 * (q->bottom + q->top) : at[way[1]]);
        write_cell(f, p->across ? 0.5 * (q->to - q->from) : side);
        write_cell(f, p->across ? 0.5 * (q->top - q->bottom) : side);
        write_cell(f, q->load.sum / p->weight / q->area);
        write_cell(f, q->load.max / q->area);
        putc('\n', f);
    }
}

/* One of the two maps: column of the data, its largest value. */
static void write_map_panel(FILE *f, const char *what, int column, double most)
{
    const plot_scale c = plot_scale_of("Pa", most);
    fprintf(f, "set cbrange [0:%.6g]\nset cbtics %.6g\nset cblabel '%s  [%sPa]'\n",
            most > 0.0 ? c.factor * most : 1.0, most > 0.0 ? plot_tics(c.factor * most) : 1.0, what,
            c.prefix);
    fprintf(f, "plot data index 1 using 1:2:3:4:(%g*$%d) with boxxyerror lc palette\n", c.factor, column);
}

static void write_map_script(FILE *f, const load_map *p)
{
    static const char *const name[] = {"x", "y", "z"};
    double max = 0.0, mean = 0.0;
    int way[2];
    for (int32_t k = 0; k < p->panels; k++) {
        max = fmax(max, p->panel[k].load.max / p->panel[k].area);
        mean = fmax(mean, p->panel[k].load.sum / p->weight / p->panel[k].area);
    }
    widest_axes(p, way);
    write_title(f, "Load on panels");
    fprintf(f,
            "set multiplot\nset lmargin at screen 0.09\nset rmargin at screen 0.86\nunset key\n"
            "set style fill solid 1 noborder\nset autoscale noextend\n"
            "set palette defined (0 '#f4f7fa', 0.15 '#c6dbef', 0.5 '#4292c6', 1 '#08306b')\n"
            "set tmargin at screen 0.89\nset bmargin at screen 0.58\nset format x ''\nset ylabel '%s  [m]'\n",
            p->across ? "z" : name[way[1]]);
    write_map_panel(f, "Largest", 6, max);
    fprintf(f,
            "unset title\nset tmargin at screen 0.49\nset bmargin at screen 0.18\nset format x '%%g'\n"
            "set xlabel '%s  [m]'\n",
            p->across ? "Along the waterline" : name[way[0]]);
    write_map_panel(f, "Mean", 5, mean);
    fputs("unset multiplot\n", f);
}

/* --- pictures ------------------------------------------------------------------------------------------- */

const struct load_picture pressure_picture = {write_pressure_data, write_pressure_script, 460};
const struct load_picture line_picture = {write_line_data, write_line_script, 480};
const struct load_picture map_picture = {write_map_data, write_map_script, 480};

int plot_load_map(const load_map *p, const struct options *o, const fl_history_line *by, fl_err *err)
{
    const struct load_picture *kind = p->o->table->contact_picture;
    const char *stem = p->o->table->name;
    char path[PLOT_PATH_LEN];
    fl_out out = {0};
    int rc = -1;
    if (p->parts == 0 && p->panels == 0) return 0;
    if (mkdir(o->plot, 0777) != 0 && errno != EEXIST)
        return fl_fail(err, FL_SYSTEM, "%s: %s", o->plot, strerror(errno));
    if (plot_path(path, o->plot, stem, "tsv", err) || fl_out_open(&out, path, 0, err)) goto done;
    fl_write_file_header(out.f, stem, 1, p->history, by);
    kind->data(out.f, p);
    if (fl_out_close(&out, err)) goto done;
    if (plot_path(path, o->plot, stem, "gp", err) || fl_out_open(&out, path, 0, err)) goto done;
    plot_open(out.f, stem, o->format, WIDTH, kind->height);
    fputs(STYLES, out.f);
    kind->script(out.f, p);
    fputs("set output\n", out.f);
    if (fl_out_close(&out, err)) goto done;
    rc = plot_draw(o->plot, stem, o->format, err);
    if (rc == 0 && !o->quiet) fprintf(stderr, "loadstats: 1 picture in %s\n", o->plot);
done:
    fl_out_abort(&out);
    return rc;
}
