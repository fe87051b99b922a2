/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_fft_halfcomplex.h>
#include <gsl/gsl_fft_real.h>
#include "base/array.h"
#include "base/pi.h"
#include "stat/power_spectrum.h"

const char *fl_taper_name(int taper)
{
    static const char *const name[FL_TAPERS] = {"hann", "hamming", "blackman", "none"};
    return name[taper];
}

static double window_value(int taper, int32_t j, int32_t length)
{
    const double u = 2.0 * PI * j / length;
    switch (taper) {
    case FL_TAPER_HANN: return 0.5 - 0.5 * cos(u);
    case FL_TAPER_HAMMING: return 0.54 - 0.46 * cos(u);
    case FL_TAPER_BLACKMAN: return 0.42 - 0.5 * cos(u) + 0.08 * cos(2.0 * u);
    default: return 1.0;
    }
}

int32_t fl_spectrum_segment_length(int32_t n)
{
    const int64_t most = 2 * (int64_t)n / (FL_SPECTRUM_SEGMENTS + 1);
    int64_t best = 0;
    for (int64_t two = 2; two <= most; two *= 2)
        for (int64_t three = two; three <= most; three *= 3)
            for (int64_t five = three; five <= most; five *= 5)
                if (five > best) best = five;
    return best < FL_SPECTRUM_SHORTEST_SEGMENT ? n : (int32_t)best;
}

/* Add |X_k|^2 of one segment to psd. */
static void add_segment(fl_power_spectrum *s, const double *x, double mean, const double *w, double *y,
                        const gsl_fft_real_wavetable *table, gsl_fft_real_workspace *work)
{
    const int32_t L = s->length;
    for (int32_t j = 0; j < L; j++) y[j] = w[j] * (x[j] - mean);
    gsl_fft_real_transform(y, 1, (size_t)L, table, work);
    /* Half-complex order: re0 re1 im1 re2 im2 ..., and re(L/2) last where L is even. */
    s->psd[0] += y[0] * y[0];
    for (int32_t k = 1; 2 * k < L; k++) s->psd[k] += y[2 * k - 1] * y[2 * k - 1] + y[2 * k] * y[2 * k];
    if (L % 2 == 0) s->psd[L / 2] += y[L - 1] * y[L - 1];
}

/* Degrees of freedom, from the overlap of the windows of neighbouring segments. */
static double degrees_of_freedom(const fl_power_spectrum *s, const double *w, double square)
{
    double sum = 0.0;
    for (int32_t j = 1; j < s->segments && (int64_t)j * s->step < s->length; j++) {
        double r = 0.0;
        for (int32_t i = 0; i + j * s->step < s->length; i++) r += w[i] * w[i + j * s->step];
        r /= square;
        sum += (1.0 - (double)j / s->segments) * r * r;
    }
    return 2.0 * s->segments / (1.0 + 2.0 * sum);
}

static int average_segments(fl_power_spectrum *s, int32_t n, const double *x, fl_err *err)
{
    const int32_t L = s->length;
    double *w = fl_alloc(2 * (int64_t)L, sizeof *w, err), *y = w + L, sum = 0.0, square = 0.0, mean = 0.0;
    gsl_fft_real_wavetable *table = NULL;
    gsl_fft_real_workspace *work = NULL;
    int rc = -1;
    if (!w) return -1;
    gsl_set_error_handler_off(); /* it would abort without memory */
    table = gsl_fft_real_wavetable_alloc((size_t)L);
    work = gsl_fft_real_workspace_alloc((size_t)L);
    if (!table || !work) {
        fl_fail(err, FL_SYSTEM, "out of memory");
        goto done;
    }
    for (int32_t k = 0; k < n; k++) mean += (x[k] - mean) / (k + 1.0);
    for (int32_t j = 0; j < L; j++) {
        w[j] = window_value(s->taper, j, L);
        sum += w[j];
        square += w[j] * w[j];
    }
    for (int32_t j = 0; j < s->segments; j++)
        add_segment(s, x + (int64_t)j * s->step, mean, w, y, table, work);
    const double scale = 1.0 / (s->fs * square * s->segments);
    for (int32_t k = 0; k < s->n; k++) s->psd[k] *= k == 0 || 2 * k == L ? scale : 2.0 * scale;
    s->enbw = s->fs * square / (sum * sum);
    s->dof = degrees_of_freedom(s, w, square);
    rc = 0;
done:
    if (table) gsl_fft_real_wavetable_free(table);
    if (work) gsl_fft_real_workspace_free(work);
    free(w);
    return rc;
}

int fl_power_spectrum_make(fl_power_spectrum *s, int32_t n, const double *x, double fs, int32_t length,
                           int taper, fl_err *err)
{
    *s = (fl_power_spectrum){.taper = taper, .length = length, .fs = fs};
    if (length < FL_SPECTRUM_SHORTEST_SEGMENT || length > n)
        return fl_fail(err, FL_INPUT, "a segment of %d rows, expected %d to all %d of the record", length,
                       FL_SPECTRUM_SHORTEST_SEGMENT, n);
    s->step = length - length / 2;
    s->segments = 1 + (n - length) / s->step;
    s->n = length / 2 + 1;
    s->df = fs / length;
    s->psd = fl_alloc(s->n, sizeof *s->psd, err);
    if (s->psd && average_segments(s, n, x, err) == 0) return 0;
    fl_power_spectrum_free(s);
    return -1;
}

double fl_power_spectrum_variance(const fl_power_spectrum *s)
{
    double sum = 0.0;
    for (int32_t k = 0; k < s->n; k++) sum += s->psd[k];
    return sum * s->df;
}

void fl_power_spectrum_interval(const fl_power_spectrum *s, int32_t k, double *low, double *high)
{
    const double nu = k == 0 || 2 * k == s->length ? 0.5 * s->dof : s->dof;
    *low = nu * s->psd[k] / gsl_cdf_chisq_Pinv(0.975, nu);
    *high = nu * s->psd[k] / gsl_cdf_chisq_Pinv(0.025, nu);
}

double fl_power_spectrum_dominant(const fl_power_spectrum *s, int32_t *at)
{
    int32_t best = -1;
    for (int32_t k = 2; k + 1 < s->n; k++)
        if (s->psd[k] > s->psd[k - 1] && s->psd[k] > s->psd[k + 1] && (best < 0 || s->psd[k] > s->psd[best]))
            best = k;
    if (at) *at = best;
    if (best < 0) return NAN;
    const double a = s->psd[best - 1], b = s->psd[best], c = s->psd[best + 1];
    /* A neighbour below the rounding of the peak carries no information on its position. */
    if (!(a > 1e-15 * b && c > 1e-15 * b)) return best * s->df;
    const double l = log(a / b), r = log(c / b);
    return (best + 0.5 * (l - r) / (l + r)) * s->df;
}

double fl_power_spectrum_share(const fl_power_spectrum *s, int32_t k)
{
    enum { LOBE = 2 };
    double near = 0.0, all = 0.0;
    for (int32_t j = 0; j < s->n; j++) {
        all += s->psd[j];
        if (abs(j - k) <= LOBE) near += s->psd[j];
    }
    return near / all;
}

double fl_power_spectrum_crossing_rate(const fl_power_spectrum *s)
{
    double zero = 0.0, two = 0.0;
    for (int32_t k = 0; k < s->n; k++) {
        zero += s->psd[k];
        two += (double)k * k * s->psd[k];
    }
    return zero > 0.0 ? sqrt(two / zero) * s->df : NAN;
}

void fl_power_spectrum_free(fl_power_spectrum *s)
{
    free(s->psd);
    *s = (fl_power_spectrum){0};
}
