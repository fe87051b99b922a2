/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/stream.h"
#include "comparison.h"
#include "plot_parts.h"

enum { HEAD = 74, PANEL = 230 };

/* The data: one block per signal, one row per part. */
static void write_data(FILE *f, const struct record_views *r, int32_t s)
{
    const comparison c = compare_parts(r, s, 0);
    fputs("\n\n", f); /* two blank lines separate blocks; the first block is the column names */
    for (int32_t p = 0; p < r->series->parts; p++) {
        const fl_signal_view *v = find_view(r, p, s, 0);
        if (!v) continue;
        fprintf(f, "%s\t%s", r->series->part[p], r->series->signal[s]);
        write_cell(f, v->stats.mean);
        write_cell(f, v->peaks.n ? fl_mean_of_highest(v->peaks.n, v->peak_value, 1.0 / 3.0) : NAN);
        write_cell(f, v->stats.max);
        write_cell(f, fmin(v->stats.min, 0.0));
        write_cell(f, c.at >= 0 && p != c.total ? v->x[c.at] : (double)NAN);
        putc('\n', f);
    }
}

static void write_panel(FILE *f, const struct record_views *r, int32_t s, int index, int panels, int height)
{
    double large = 0.0;
    int32_t bars = 0;
    char text[300];
    for (int32_t p = 0; p < r->series->parts; p++) {
        const fl_signal_view *v = find_view(r, p, s, 0);
        if (!v) continue;
        large = fmax(large, fmax(fabs(v->stats.min), fabs(v->stats.max)));
        bars++;
    }
    const plot_scale c = plot_scale_of(r->series->unit[s], large);
    plot_axis_label(text, sizeof text, r->series->signal[s], r->series->unit[s], large);
    const double top = (double)HEAD + index * PANEL, bottom = top + PANEL - 60.0;
    fprintf(f, "set tmargin at screen %.4f\nset bmargin at screen %.4f\nset xrange [-0.6:%g]\nset ylabel ",
            1.0 - top / height, 1.0 - bottom / height, bars - 0.4);
    plot_quoted(f, text);
    fprintf(f, "\nfactor = %g\nblock = %d\n", c.factor, index + 1);
    fputs("plot data index block using ($0-0.24):(factor*$3):(0.22) with boxes ls 1 title 'mean', \\\n"
          "     '' index block using 0:(factor*$4):(0.22):xtic(1) with boxes ls 2 title 'third of the "
          "peaks', \\\n"
          "     '' index block using ($0+0.24):(factor*$5):(0.22) with boxes ls 3 title 'extremes', \\\n"
          "     '' index block using ($0+0.24):(factor*$6):(0.22) with boxes ls 3 notitle, \\\n"
          "     '' index block using 0:(factor*$7) with points ls 4 title 'at largest total'\n",
          f);
    if (index == 0) fputs("unset key\nunset label 1\n", f);
    if (index + 1 == panels) fputs("unset multiplot\nset output\n", f);
}

static void write_script(FILE *f, const struct record_views *r, const struct options *o, int panels)
{
    const int height = HEAD + panels * PANEL;
    int index = 0;
    plot_open(f, "legs", o->format, 1000, height);
    fputs("set style line 1 lc rgb '#9ecae1'\nset style line 2 lc rgb '#4292c6'\nset style line 3 lc rgb "
          "'#08519c'\nset style line 4 lc rgb '#c8642d' pt 7 ps 0.9\nset style fill solid 1.0 noborder\n"
          "set border 3 lc rgb '#444444' lw 1\nset tics nomirror out scale 0.6 textcolor rgb '#222222'\nset "
          "datafile separator '\\t'\nset datafile missing '-'\nset multiplot\nset lmargin at screen 0.095\n"
          "set rmargin at screen 0.97\nset xtics scale 0\nset xzeroaxis lc rgb '#444444' lw 1\nset grid "
          "ytics back lc rgb '#dddddd' lw 0.8\n",
          f);
    fprintf(f, "set label 1 'Parts side by side' at screen 0.095, screen %.4f left font ',%d'\n",
            1.0 - 24.0 / height, plot_head_size(o->format));
    fprintf(f,
            "set key at screen 0.975, screen %.4f right top horizontal Left reverse samplen 1 width -3 "
            "maxrows 1\n",
            1.0 - 34.0 / height);
    for (int32_t s = 0; s < r->series->signals; s++)
        if (find_view(r, 0, s, 0)) write_panel(f, r, s, index++, panels, height);
}

static int draw_parts(const struct record_views *r, const struct options *o, const fl_history_line *by,
                      fl_err *err)
{
    char path[PLOT_PATH_LEN];
    fl_out out = {0};
    int panels = 0, rc = -1;
    if (plot_path(path, o->plot, "legs", "tsv", err) || fl_out_open(&out, path, 0, err)) goto done;
    fl_write_file_header(out.f, "legs", 1, r->series->history, by);
    fputs("part\tsignal\tmean\tpeak_third\tmax\tmin\tat_total\n", out.f);
    for (int32_t s = 0; s < r->series->signals; s++) {
        if (!find_view(r, 0, s, 0)) continue;
        write_data(out.f, r, s);
        panels++;
    }
    if (fl_out_close(&out, err)) goto done;
    if (plot_path(path, o->plot, "legs", "gp", err) || fl_out_open(&out, path, 0, err)) goto done;
    write_script(out.f, r, o, panels);
    if (fl_out_close(&out, err)) goto done;
    rc = plot_draw(o->plot, "legs", o->format, err);
done:
    fl_out_abort(&out);
    return rc;
}

const struct picture_kind parts_picture = {.name = "legs", .draw_all_parts = draw_parts};
