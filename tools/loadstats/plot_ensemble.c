/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/array.h"
#include "base/stream.h"
#include "stat/mean_interval.h"
#include "cell.h"
#include "picture.h"
#include "plot_ensemble.h"

enum { PATH_LEN = 4096, PICTURES_MAX = 48 };

/* The data of one signal. */
static int write_data(FILE *f, const ensemble *e, int32_t k, fl_err *err)
{
    double *mean = fl_alloc(2 * (int64_t)e->runs, sizeof *mean, err), *max = mean + e->runs,
           largest = -INFINITY;
    if (!mean) return -1;
    for (int32_t n = 0; n < e->runs; n++) {
        mean[n] = e->x[ENSEMBLE_VALUES * ((int64_t)n * e->signals + k)];
        max[n] = e->x[ENSEMBLE_VALUES * ((int64_t)n * e->signals + k) + 1];
        const fl_mean_interval a = fl_mean_interval_of(n + 1, mean), b = fl_mean_interval_of(n + 1, max);
        largest = fmax(largest, max[n]);
        fprintf(f, "%d", n + 1);
        write_cell(f, a.mean);
        write_cell(f, a.low);
        write_cell(f, a.high);
        write_cell(f, b.mean);
        write_cell(f, b.low);
        write_cell(f, b.high);
        write_cell(f, largest);
        putc('\n', f);
    }
    free(mean);
    return 0;
}

/* Mean and largest values with their intervals against the number of runs. */
static const char SCRIPT[] =
    "set border 3 lc rgb '#444444'\n"
    "set tics nomirror out scale 0.6 textcolor rgb '#222222'\n"
    "set datafile missing '-'\nset encoding utf8\nset multiplot\nset yrange [*:*]\nset xlabel 'Runs'\n"
    "set key at graph 0.98, 0.98 right top samplen 2\n";

static void write_panel(FILE *f, const char *title, int first, double left, double right, int largest)
{
    fprintf(f, "set lmargin at screen %g\nset rmargin at screen %g\nset tmargin at screen 0.86\n", left,
            right);
    fprintf(f, "set bmargin at screen 0.2\nset title '%s'\n", title);
    fprintf(
        f,
        "plot data using 1:(factor*$%d):(factor*$%d) with filledcurves lc rgb '#c6dbef' title '95 %%', \\\n",
        first + 1, first + 2);
    fprintf(f, "     '' using 1:(factor*$%d) with lines lw 2 lc rgb '#08519c' title 'mean of the runs'",
            first);
    if (largest)
        fputs(", \\\n     '' using 1:(factor*$8) with steps lw 1.5 lc rgb '#c8642d' title 'largest of all'",
              f);
    fputs("\n", f);
}

static int draw_signal(const struct run_set *m, int32_t k, const struct options *o, const fl_history_line *by,
                       fl_err *err)
{
    const fl_summary_signal *s = &m->all.entry[k];
    const int newton = s->unit[0] == 'N';
    const double large = fmax(fabs(s->min), fabs(s->max));
    const char *prefix = !newton || large < 1e3 ? "" : large < 1e6 ? "k" : "M";
    char stem[60], path[PATH_LEN];
    fl_out out = {0};
    int rc = -1;
    snprintf(stem, sizeof stem, "ensemble-%d", k + 1);
    if (snprintf(path, sizeof path, "%s/%s.tsv", o->plot, stem) >= PATH_LEN)
        return fl_fail(err, FL_SYSTEM, "the name of a picture in %.100s is too long", o->plot);
    if (fl_out_open(&out, path, 0, err)) goto done;
    fl_write_file_header(out.f, "ensemble", 1, m->all.history, by);
    fputs("runs\tmean\tmean_low\tmean_high\tmax\tmax_low\tmax_high\tlargest\n", out.f);
    if (write_data(out.f, &m->e, k, err) || fl_out_close(&out, err)) goto done;
    snprintf(path, sizeof path, "%.4000s/%s.gp", o->plot, stem);
    if (fl_out_open(&out, path, 0, err)) goto done;
    plot_open(out.f, stem, o->format, 1000, 380);
    fprintf(out.f, "factor = %s\n%s", prefix[0] == 'k' ? "1e-3" : prefix[0] == 'M' ? "1e-6" : "1", SCRIPT);
    /* The intervals of the first few runs are wide and would dominate the axis. */
    fprintf(out.f, "set xrange [%d:%d]\nset ylabel ", m->e.runs > 8 ? 4 : 1, m->e.runs > 1 ? m->e.runs : 2);
    char text[300];
    snprintf(text, sizeof text, "%.80s, %.80s  %s%s%.60s%s", s->signal, s->part, s->unit[0] ? "[" : "",
             prefix, s->unit, s->unit[0] ? "]" : "");
    plot_quoted(out.f, text);
    putc('\n', out.f);
    write_panel(out.f, "Mean of a run", 2, 0.085, 0.48, 0);
    fputs("unset ylabel\nset key at graph 0.98, 0.75\n",
          out.f); /* key between the largest values and the means */
    write_panel(out.f, "Largest value of a run", 5, 0.575, 0.97, 1);
    fputs("unset multiplot\nset output\n", out.f);
    if (fl_out_close(&out, err)) goto done;
    rc = plot_draw(o->plot, stem, o->format, err);
done:
    fl_out_abort(&out);
    return rc;
}

int plot_ensemble(const struct run_set *m, const struct options *o, const fl_history_line *by, fl_err *err)
{
    if (mkdir(o->plot, 0777) != 0 && errno != EEXIST)
        return fl_fail(err, FL_SYSTEM, "%s: %s", o->plot, strerror(errno));
    if (m->all.n > PICTURES_MAX)
        return fl_fail(err, FL_USAGE, "at most %d signals are drawn, here are %d: select some", PICTURES_MAX,
                       m->all.n);
    for (int32_t k = 0; k < m->all.n; k++)
        if (draw_signal(m, k, o, by, err)) return -1;
    return 0;
}
