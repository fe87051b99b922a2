/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "plot_spectrum.h"
#include "table_spectrum.h"

/* Range of the axis below the highest density. */
static const double DECADES = 4.5;

/* Frequencies are drawn one by one up to this number, above it as means over 1 / ALL of the frequency; on a
 * page fewer of them. */
enum { ALL = 400, ALL_OF_PAGE = 60 };

static void write_spectrum_block(picture *p, int32_t s, int w, const fl_power_spectrum *a)
{
    const int32_t all = p->o->report_page ? ALL_OF_PAGE : ALL;
    plot_block(p);
    for (int32_t k = 1, next; k < a->n; k = next) {
        double psd = 0.0, low = 0.0, high = 0.0;
        next = k < all ? k + 1 : k + k / all;
        if (next > a->n) next = a->n;
        for (int32_t i = k; i < next; i++) {
            double lo, hi;
            fl_power_spectrum_interval(a, i, &lo, &hi);
            psd += a->psd[i] / (next - k);
            low += lo / (next - k);
            high += hi / (next - k);
        }
        plot_label(p, s, w);
        plot_columns(p, 4, (double[]){0.5 * (k + next - 1) * a->df, psd, low, high});
    }
}

static void write_curves(picture *p, int32_t s, const fl_power_spectrum a[2])
{
    const double factor = pow(plot_scale_of_signal(p, s).factor, 2.0);
    FILE *f = p->script;
    char text[120];
    for (int w = 0; w < p->r->view_count; w++) {
        if (w == 0) {
            plot_curve(p);
            fprintf(
                f,
                "using 4:($6*%g):($7*%g) with filledcurves fs solid 0.35 lc rgb '#9ecae1' title '95 %%', \\\n"
                "     ",
                factor, factor);
            fprintf(f, "'' index %d using 4:($5*%g) with lines ls %d title '%s'", p->blocks, factor,
                    p->r->view_count > 1 ? 1 : 3, view_name(w));
        } else {
            settings_filter_text(p->o, text, sizeof text);
            plot_curve(p);
            fprintf(f, "using 4:($5*%g) with lines ls 2 title '%s, %s'", factor, view_name(w), text);
        }
        write_spectrum_block(p, s, w, &a[w]);
    }
}

static int write_spectrum_panel(picture *p, int k, int32_t s, fl_err *err)
{
    const plot_scale c = plot_scale_of_signal(p, s);
    const char *unit = p->r->series->unit[s];
    FILE *f = p->script;
    fl_power_spectrum a[2] = {{0}, {0}};
    double most = 0.0;
    char text[300];
    int rc = 0;
    for (int w = 0; w < p->r->view_count && rc == 0; w++)
        rc = spectrum_make(&a[w], p->r, p->o, p->part, s, w, err);
    if (rc) goto done;
    for (int32_t j = 1; j < a[0].n; j++) most = fmax(most, c.factor * c.factor * a[0].psd[j]);
    plot_set_margins(p, k, 0.095, 0.97);
    snprintf(text, sizeof text, "%.80s  [%s%.60s²/Hz]", p->r->series->signal[s], c.prefix,
             unit[0] ? unit : "");
    plot_left_title(p, text, 0.015);
    fprintf(f, "set logscale xy\nset xrange [%.6g:%.6g]\n", a[0].df, a[0].fs / 2.0);
    fprintf(f, "set yrange [%.3g:%.3g]\nset format y '%%g'\n", most * pow(10.0, -DECADES), 4.0 * most);
    fputs("set ytics 10\n", f);
    if (k + 1 == p->panels) fputs("set xlabel 'Frequency  [Hz]'\nset format x '%g'\n", f);
    else fputs("set format x ''\n", f);
    const double dominant = fl_power_spectrum_dominant(&a[0], NULL);
    fputs("unset arrow 1\nunset label 3\n", f);
    if (isfinite(dominant)) {
        fprintf(f, "set arrow 1 from %.6g, graph 0 to %.6g, graph 1 nohead dt 2 lc rgb '#c8642d'\n", dominant,
                dominant);
        fprintf(f, "set label 3 '%.3g Hz' at %.6g, graph 0.93 offset 0.6,0 textcolor rgb '#c8642d'\n",
                dominant, dominant);
    }
    write_curves(p, s, a);
    plot_end_panel(p);
done:
    fl_power_spectrum_free(&a[0]);
    fl_power_spectrum_free(&a[1]);
    return rc;
}

static int fill_spectrum(picture *p, fl_err *err)
{
    char heading[80];
    int k = 0;
    p->gap = 26;
    for (int32_t s = 0; s < p->r->series->signals; s++) p->panels += plot_signal_varies(p, s);
    fputs("signal\tunit\tview\tf[Hz]\tpsd\tpsd_low\tpsd_high\n", p->data);
    snprintf(heading, sizeof heading, "Spectrum (%s)", fl_taper_name(p->o->taper));
    plot_start(p, heading);
    for (int32_t s = 0; s < p->r->series->signals; s++)
        if (plot_signal_varies(p, s) && write_spectrum_panel(p, k++, s, err)) return -1;
    return 0;
}

const struct picture_kind spectrum_picture = {
    .name = "spectrum", .drawable = plot_part_varies, .fill = fill_spectrum};
