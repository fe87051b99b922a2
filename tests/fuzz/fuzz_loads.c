/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "stat/uniform_step.h"
#include "stat/oscillator.h"
#include "stat/rainflow_matrix.h"
#include "stat/signal_view.h"
#include "stat/power_spectrum.h"
#include "support/fuzz.h"

/* A record that was read has statistics: raw, and filtered where the record has a filter. */
static int check_views(const fl_series *s, fl_err *err)
{
    const double p[] = {0.0, 0.5, 1.0};
    for (int32_t k = 0; k < s->parts * s->signals; k++) {
        fl_signal_view_settings ask = {.order = 2, .ratio = 0.5, .quantiles = 3, .p = p};
        fl_signal_view v = {0};
        if (!s->x[k]) continue;
        if (fl_signal_view_make(&v, s, k / s->signals, k % s->signals, &ask, err)) return -1;
        const int sound = isfinite(v.stats.mean) && isfinite(v.stats.std) && v.quantile[0] == v.stats.min &&
                          v.quantile[2] == v.stats.max;
        fl_signal_view_free(&v);
        if (!sound) return FUZZ_BROKEN;
        ask.filter = 0.4 * s->n / (s->edge[s->n] - s->edge[0]);
        fl_err own = {0};
        if (fl_signal_view_make(&v, s, k / s->signals, k % s->signals, &ask, &own) && own.code == FL_SYSTEM) {
            *err = own;
            return -1;
        }
        fl_signal_view_free(&v);
    }
    return 0;
}

/* Filters, cycles, spectrum and response of a signal: finite, or refused. */
static int check_signals(const fl_series *s, const double *x, fl_err *err)
{
    const double span = s->edge[s->n] - s->edge[0];
    const double p[] = {0.5};
    double low, high, sum = 0.0;
    fl_rainflow cycles = {0};
    fl_rainflow_matrix m = {0};
    fl_power_spectrum w = {0};
    fl_response r;
    fl_err own = {0};
    int rc = FUZZ_BROKEN;
    for (int pass = 0; pass < FL_FILTER_KINDS; pass++) {
        const double f = pass == FL_FILTER_MEAN ? span / 3.0 : 0.2 * s->n / span;
        const fl_signal_view_settings ask = {
            .filter = f, .upper = 2.0 * f, .kind = pass, .order = 3, .ratio = 0.5, .quantiles = 1, .p = p};
        fl_signal_view v = {0};
        const fl_series one = {
            .n = s->n, .t = s->t, .edge = s->edge, .parts = 1, .signals = 1, .x = (double *[]){(double *)x}};
        own = (fl_err){0};
        if (fl_signal_view_make(&v, &one, 0, 0, &ask, &own) == 0) sum += v.stats.std;
        fl_signal_view_free(&v);
        if (own.code == FL_SYSTEM) goto done;
    }
    for (int rule = 0; rule < FL_RAINFLOW_RULES; rule++) {
        double largest = 0.0, lo = INFINITY, hi = -INFINITY;
        if (fl_rainflow_count(&cycles, rule, FL_RESIDUE_REPEAT, s->n, x, &own)) goto done;
        for (int32_t k = 0; k < cycles.cycles; k++) {
            largest = fmax(largest, cycles.cycle[k].range);
            lo = fmin(lo, cycles.cycle[k].mean);
            hi = fmax(hi, cycles.cycle[k].mean);
        }
        fl_rainflow_matrix_free(&m);
        if (fl_rainflow_matrix_make(&m, 7, largest, lo, hi, cycles.cycles, cycles.cycle, &own)) goto done;
        for (int32_t k = 0; k < m.cells; k++) {
            const int sound =
                m.cell[k].range >= 0 && m.cell[k].range < 7 && m.cell[k].mean >= 0 && m.cell[k].mean < 7;
            if (!sound || !(m.cell[k].cycles > 0.0)) goto done;
        }
        sum += fl_rainflow_equivalent(cycles.cycles, cycles.cycle, 5.0);
    }
    if (s->n >= FL_SPECTRUM_SHORTEST_SEGMENT) {
        if (fl_power_spectrum_make(&w, s->n, x, s->n / span, fl_spectrum_segment_length(s->n), FL_TAPER_HANN,
                                   &own))
            goto done;
        fl_power_spectrum_interval(&w, w.n / 2, &low, &high);
        if (!(low <= high)) goto done;
        sum += fl_power_spectrum_variance(&w);
        if (isfinite(fl_power_spectrum_dominant(&w, NULL)) && !(fl_power_spectrum_dominant(&w, NULL) < w.fs))
            goto done;
    }
    double longest = 0.0; /* a few steps to a row: intervals of a damaged file may differ by any factor */
    for (int32_t k = 0; k < s->n; k++) longest = fmax(longest, s->edge[k + 1] - s->edge[k]);
    const fl_oscillator o = {.frequency = 0.1 / longest, .damping = 0.02};
    fl_oscillator_integrate(&o, s->n, s->edge, x, 20.0, 1, &r, NULL);
    sum += r.largest;
    rc = isfinite(sum) ? 0 : FUZZ_BROKEN;
done:
    if (own.code == FL_SYSTEM) {
        *err = own;
        rc = -1;
    }
    fl_power_spectrum_free(&w);
    fl_rainflow_matrix_free(&m);
    fl_rainflow_free(&cycles);
    return rc;
}

static int check_steps(fl_series *s, fl_err *err)
{
    fl_err own = {0};
    const double span = s->edge[s->n] - s->edge[0];
    if (fl_resample_uniform(s, span / 5.0, NULL, &own) == 0) return s->n == 5 || s->n == 4 ? 0 : FUZZ_BROKEN;
    if (own.code != FL_SYSTEM) return 0;
    *err = own;
    return -1;
}

static int fuzz_one(const unsigned char *data, size_t n)
{
    const fl_record_selection ask = {.from = -INFINITY, .to = INFINITY};
    fl_err err = {0};
    fl_series s = {0};
    int rc = fl_series_read(&s, fuzz_file(data, n), &ask, &err);
    if (rc == 0) rc = check_views(&s, &err);
    for (int32_t k = 0; rc == 0 && k < s.parts * s.signals; k++)
        if (s.x[k]) rc = check_signals(&s, s.x[k], &err);
    if (rc == 0) rc = check_steps(&s, &err);
    fl_series_free(&s);
    return rc == FUZZ_BROKEN ? FUZZ_BROKEN : fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "loads", fuzz_one); }
