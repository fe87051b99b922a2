/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/number_text.h"
#include "stat/extreme.h"
#include "stat/histogram.h"
#include "table_rainflow.h"
#include "table_fits.h"
#include "table_parts.h"
#include "table_spectrum.h"
#include "table_stats.h"
#include "table_response.h"

const char *view_name(int w) { return w ? "filtered" : "raw"; }

const fl_signal_view *view_of(const struct result *r, int32_t part, int32_t signal, int w)
{
    const fl_signal_view *v = &r->views[((int64_t)part * r->s->signals + signal) * r->each + w];
    return v->n ? v : NULL;
}

void put_number(FILE *f, double x)
{
    char buf[FL_NUMBER_LEN];
    fputs(isfinite(x) ? fl_number_text(x, buf) : "-", f);
}

void write_cell(FILE *f, double x)
{
    putc('\t', f);
    put_number(f, x);
}

void write_labels(FILE *f, const struct result *r, int32_t p, int32_t s, int w)
{
    const char *unit = r->s->unit[s];
    fprintf(f, "%s\t%s\t%s\t%s", r->s->part[p], r->s->signal[s], unit[0] ? unit : "-", view_name(w));
}

static void stats_row(FILE *f, const fl_signal_view *v, const struct options *o)
{
    const fl_descriptive_stats *d = &v->stats;
    const int32_t n = v->peaks.n;
    write_cell(f, v->edge[0]);
    write_cell(f, v->edge[v->n]);
    fprintf(f, "\t%d", v->n);
    write_cell(f, d->mean);
    write_cell(f, d->std);
    write_cell(f, d->skew);
    write_cell(f, d->kurtosis);
    write_cell(f, d->min);
    write_cell(f, d->max);
    write_cell(f, v->t[d->at_max]);
    for (int32_t k = 0; k < o->quantiles; k++) write_cell(f, v->quantile[k]);
    fprintf(f, "\t%d", n);
    write_cell(f, n ? fl_mean_of_highest(n, v->peak_value, 1.0) : NAN);
    write_cell(f, n ? fl_mean_of_highest(n, v->peak_value, 1.0 / 3.0) : NAN);
    write_cell(f, n ? fl_mean_of_highest(n, v->peak_value, 0.1) : NAN);
    putc('\n', f);
}

static void peaks_rows(FILE *f, const struct result *r, int32_t p, int32_t s, int w, const fl_signal_view *v)
{
    for (int32_t k = 0; k < v->peaks.n; k++) {
        write_labels(f, r, p, s, w);
        write_cell(f, v->t[v->peaks.row[k]]);
        write_cell(f, v->x[v->peaks.row[k]]);
        putc('\n', f);
    }
}

static void exceedance_rows(FILE *f, const struct result *r, int32_t p, int32_t s, int w,
                            const fl_signal_view *v)
{
    for (int32_t k = 0; k < v->peaks.n; k++) {
        write_labels(f, r, p, s, w);
        fprintf(f, "\t%d", k + 1);
        write_cell(f, v->peak_value[k]);
        write_cell(f, fl_plotting_position(k + 1, v->peaks.n));
        putc('\n', f);
    }
}

/* Raw and filtered share their classes, so that they can be compared line by line. */
static int histogram_rows(FILE *f, const struct result *r, const struct options *o, int32_t p, int32_t s,
                          fl_err *err)
{
    double lo = INFINITY, hi = -INFINITY;
    int rc = 0;
    for (int w = 0; w < r->each; w++) {
        const fl_signal_view *v = view_of(r, p, s, w);
        lo = fmin(lo, v->stats.min);
        hi = fmax(hi, v->stats.max);
    }
    for (int w = 0; w < r->each && rc == 0; w++) {
        const fl_signal_view *v = view_of(r, p, s, w);
        fl_histogram time = {0}, peaks = {0};
        rc = fl_histogram_make(&time, o->bins, lo, hi, err) ? -1
                                                            : fl_histogram_make(&peaks, o->bins, lo, hi, err);
        for (int32_t k = 0; rc == 0 && k < v->n; k++)
            fl_histogram_add(&time, v->x[k], v->edge[k + 1] - v->edge[k]);
        for (int32_t k = 0; rc == 0 && k < v->peaks.n; k++) fl_histogram_add(&peaks, v->peak_value[k], 1.0);
        for (int32_t k = 0; rc == 0 && k < o->bins; k++) {
            write_labels(f, r, p, s, w);
            write_cell(f, time.range[k]);
            write_cell(f, time.range[k + 1]);
            write_cell(f, time.bin[k]);
            write_cell(f, time.bin[k] / v->stats.time);
            write_cell(f, peaks.bin[k]);
            putc('\n', f);
        }
        fl_histogram_free(&time);
        fl_histogram_free(&peaks);
    }
    return rc;
}

void stats_header(FILE *f, const struct options *o)
{
    char buf[FL_NUMBER_LEN];
    fputs("part\tsignal\tunit\tview", f);
    switch (o->table) {
    case TABLE_STATS:
        fputs("\tfrom[s]\tto[s]\trows\tmean\tstd\tskew\tkurtosis\tmin\tmax\tt_max[s]", f);
        for (int32_t k = 0; k < o->quantiles; k++) fprintf(f, "\tq%s", fl_number_text(o->quantile[k], buf));
        fputs("\tpeaks\tpeak_mean\tpeak_third\tpeak_tenth\n", f);
        break;
    case TABLE_PEAKS: fputs("\tt[s]\tpeak\n", f); break;
    case TABLE_HISTOGRAM: fputs("\tfrom\tto\ttime[s]\tshare\tpeaks\n", f); break;
    case TABLE_EXCEEDANCE: fputs("\trank\tpeak\tP\n", f); break;
    case TABLE_FITS:
    case TABLE_LEVELS: fits_header(f, o); break;
    case TABLE_LEGS:
    case TABLE_EVENTS: parts_header(f, o); break;
    case TABLE_RAINFLOW:
    case TABLE_DAMAGE: rainflow_header(f, o); break;
    case TABLE_SPECTRUM:
    case TABLE_FREQUENCY: spectrum_header(f, o); break;
    case TABLE_RESPONSE:
    case TABLE_MOTION: response_header(f, o); break;
    case TABLE_PRESSURE:
    case TABLE_LINE:
    case TABLE_MAP: /* table_pressure.h */
    case TABLE_SUMMARY:
    case TABLE_ENSEMBLE:
    case TABLE_CYCLES: break; /* table_summary.h */
    }
}

/* What the steps took from the record stands above the names of the columns. */
static void put_loss(FILE *f, const struct result *r, const struct options *o)
{
    for (int32_t p = 0; r->loss && p < r->s->parts; p++) {
        for (int32_t s = 0; s < r->s->signals; s++) {
            const fl_resampling_loss *l = &r->loss[(int64_t)p * r->s->signals + s];
            if (!view_of(r, p, s, 0)) continue;
            fprintf(f, "# steps of %g s: %s of %s loses %.6g rms, %.6g at most\n", o->step, r->s->signal[s],
                    r->s->part[p], l->rms, l->largest);
        }
    }
}

int table_write(FILE *f, const struct result *r, const struct options *o, const fl_history_line *by,
                fl_err *err)
{
    fl_write_file_header(f, options_table(o->table), 1, r->s->history, by);
    put_loss(f, r, o);
    stats_header(f, o);
    if (o->table == TABLE_LEGS || o->table == TABLE_EVENTS) {
        parts_write(f, r, o);
        return 0;
    }
    for (int32_t p = 0; p < r->s->parts; p++) {
        for (int32_t s = 0; s < r->s->signals; s++) {
            if (!view_of(r, p, s, 0)) continue;
            if (o->table == TABLE_HISTOGRAM && histogram_rows(f, r, o, p, s, err)) return -1;
            const int cycles = o->table == TABLE_RAINFLOW || o->table == TABLE_DAMAGE;
            if (cycles && rainflow_write(f, r, o, p, s, err)) return -1;
            for (int w = 0; w < r->each && o->table != TABLE_HISTOGRAM; w++) {
                const fl_signal_view *v = view_of(r, p, s, w);
                const int fit = o->table == TABLE_FITS || o->table == TABLE_LEVELS;
                const int spectra = o->table == TABLE_SPECTRUM || o->table == TABLE_FREQUENCY;
                const int sway = o->table == TABLE_RESPONSE || o->table == TABLE_MOTION;
                if (sway && response_write(f, r, o, p, s, w, err)) return -1;
                if (spectra && spectrum_write(f, r, o, p, s, w, err)) return -1;
                if (fit && fits_write(f, r, o, p, s, w, err)) return -1;
                if (o->table == TABLE_PEAKS) peaks_rows(f, r, p, s, w, v);
                if (o->table == TABLE_EXCEEDANCE) exceedance_rows(f, r, p, s, w, v);
                if (o->table != TABLE_STATS) continue;
                write_labels(f, r, p, s, w);
                stats_row(f, v, o);
            }
        }
    }
    return 0;
}
