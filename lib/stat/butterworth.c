/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "stat/butterworth.h"

/* Least relative width of a band.  The poles of a narrower one round to the unit circle. */
static const double NARROWEST = 1e-6;

static int check_design(int order, double fc, double fs, fl_err *err)
{
    if (order < 1 || order > FL_BUTTERWORTH_ORDER_MAX)
        return fl_fail(err, FL_INPUT, "filter of order %d, expected 1 to %d", order,
                       FL_BUTTERWORTH_ORDER_MAX);
    if (!(fc > 0.0) || !(fc < 0.5 * fs))
        return fl_fail(err, FL_INPUT,
                       "filter at %g Hz, expected more than 0 and less than %g Hz, half the sampling rate",
                       fc, 0.5 * fs);
    return 0;
}

/* The damping q of pair k = 1 .. order / 2. */
static double pair_damping(int order, int k) { return 2.0 * sin(PI * (2 * k - 1) / (2.0 * order)); }

int fl_butterworth_low(fl_butterworth *f, int order, double fc, double fs, fl_err *err)
{
    if (check_design(order, fc, fs, err)) return -1;
    const double K = tan(PI * fc / fs);
    *f = (fl_butterworth){
        .order = order, .degree = order, .fc = fc, .fs = fs, .decay_frequency = fc, .dc_gain = 1.0};
    if (order % 2) {
        const double a1 = (K - 1.0) / (1.0 + K), b = 0.5 * (1.0 + a1);
        f->s[f->n++] = (fl_biquad){.b0 = b, .b1 = b, .a1 = a1};
    }
    for (int k = order / 2; k >= 1; k--) {
        const double q = pair_damping(order, k), a0 = 1.0 + q * K + K * K;
        const double a1 = 2.0 * (K - 1.0) * (K + 1.0) / a0, a2 = (1.0 - q * K + K * K) / a0;
        /* K^2 / a0, computed from the rounded a1 and a2: then the gain at zero frequency is one even where
         * K^2 is close to the rounding of a1. */
        const double b = 0.25 * (1.0 + a1 + a2);
        f->s[f->n++] = (fl_biquad){.b0 = b, .b1 = 2.0 * b, .b2 = b, .a1 = a1, .a2 = a2};
    }
    return 0;
}

int fl_butterworth_high(fl_butterworth *f, int order, double fc, double fs, fl_err *err)
{
    if (check_design(order, fc, fs, err)) return -1;
    const double K = tan(PI * fc / fs);
    *f = (fl_butterworth){.order = order, .degree = order, .fc = fc, .fs = fs, .decay_frequency = fc};
    if (order % 2) {
        const double a1 = (K - 1.0) / (1.0 + K), b = 0.5 * (1.0 - a1);
        f->s[f->n++] = (fl_biquad){.b0 = b, .b1 = -b, .a1 = a1};
    }
    for (int k = order / 2; k >= 1; k--) {
        const double q = pair_damping(order, k), a0 = 1.0 + q * K + K * K;
        const double a1 = 2.0 * (K - 1.0) * (K + 1.0) / a0, a2 = (1.0 - q * K + K * K) / a0;
        const double b = 0.25 * (1.0 - a1 + a2); /* gain one at half the sampling rate */
        f->s[f->n++] = (fl_biquad){.b0 = b, .b1 = -2.0 * b, .b2 = b, .a1 = a1, .a2 = a2};
    }
    return 0;
}

/* Add the section with the denominator s^2 + c1 s + c0: a pole and its conjugate, or two real poles.  Its
 * gain is one at W, where s = i W gives B s / (s^2 + c1 s + c0), so the gain of all sections together is one
 * there. */
static void add_band_section(fl_butterworth *f, double c1, double c0, double W)
{
    const double a0 = 1.0 + c1 + c0, a1 = 2.0 * (c0 - 1.0) / a0, a2 = (1.0 - c1 + c0) / a0;
    const double b = hypot(c0 - W * W, c1 * W) / (W * a0);
    f->s[f->n++] = (fl_biquad){.b0 = b, .b2 = -b, .a1 = a1, .a2 = a2};
}

int fl_butterworth_band(fl_butterworth *f, int order, double f1, double f2, double fs, fl_err *err)
{
    if (check_design(order, f1, fs, err) || check_design(order, f2, fs, err)) return -1;
    if (!(f2 - f1 > NARROWEST * f2))
        return fl_fail(err, FL_INPUT, "filter from %g Hz to %g Hz, expected the second above the first", f1,
                       f2);
    const double K1 = tan(PI * f1 / fs), K2 = tan(PI * f2 / fs), W = sqrt(K1 * K2);
    /* tan a - tan b without cancellation */
    const double B = sin(PI * (f2 - f1) / fs) / (cos(PI * f1 / fs) * cos(PI * f2 / fs));
    *f = (fl_butterworth){.order = order,
                          .degree = 2 * order,
                          .fc = f1,
                          .fs = fs,
                          .decay_frequency = fmin(f1, 0.5 * (f2 - f1))};
    if (order % 2) add_band_section(f, B, W * W, W); /* the pole -1 */
    for (int k = order / 2; k >= 1; k--) {
        const double q = pair_damping(order, k);
        /* p = -q/2 + i sqrt(1 - q^2/4); the roots of s^2 - p B s + W^2 belong to two sections, each with the
         * conjugate of the root. */
        const double complex h = 0.5 * B * (-0.5 * q + I * sqrt(1.0 - 0.25 * q * q)),
                             root = csqrt(h * h - W * W);
        for (int j = 0; j < 2; j++) {
            const double complex s = j ? h - root : h + root;
            add_band_section(f, -2.0 * creal(s), creal(s) * creal(s) + cimag(s) * cimag(s), W);
        }
    }
    return 0;
}

double fl_butterworth_gain(const fl_butterworth *f, double freq)
{
    const double w = 2.0 * PI * freq / f->fs;
    const double complex z1 = cos(w) - I * sin(w), z2 = z1 * z1;
    double gain = 1.0;
    for (int k = 0; k < f->n; k++) {
        const fl_biquad *s = &f->s[k];
        gain *= cabs(s->b0 + s->b1 * z1 + s->b2 * z2) / cabs(1.0 + s->a1 * z1 + s->a2 * z2);
    }
    return gain;
}

/* Multiply p[0 .. degree] by c0 + c1 x + c2 x^2 in place; p has memory for two more terms. */
static void multiply_polynomial(double *p, int degree, double c0, double c1, double c2)
{
    p[degree + 1] = p[degree + 2] = 0.0;
    for (int k = degree + 2; k >= 0; k--)
        p[k] = c0 * p[k] + (k > 0 ? c1 * p[k - 1] : 0.0) + (k > 1 ? c2 * p[k - 2] : 0.0);
}

void fl_butterworth_polynomials(const fl_butterworth *f, double *b, double *a)
{
    double pb[2 * FL_BUTTERWORTH_ORDER_MAX + 4] = {1.0}, pa[2 * FL_BUTTERWORTH_ORDER_MAX + 4] = {1.0};
    for (int k = 0; k < f->n; k++) {
        multiply_polynomial(pb, 2 * k, f->s[k].b0, f->s[k].b1, f->s[k].b2);
        multiply_polynomial(pa, 2 * k, 1.0, f->s[k].a1, f->s[k].a2);
    }
    for (int k = 0; k <= f->degree; k++) {
        b[k] = pb[k];
        a[k] = pa[k];
    }
}

double fl_butterworth_pad(const fl_butterworth *f)
{
    return ceil(3.0 * f->order * f->fs / f->decay_frequency);
}

/* Apply a section to y[0 .. n) in steps of +1, or from the end in steps of -1 (transposed direct form II). */
static void apply_section(const fl_biquad *s, double dc, int64_t n, double *y, int step)
{
    double *p = step > 0 ? y : y + n - 1;
    /* Steady state of a constant input of the first value: output = dc * input. */
    double u2 = (s->b2 - dc * s->a2) * p[0], u1 = (dc - s->b0) * p[0];
    for (int64_t k = 0; k < n; k++, p += step) {
        const double in = *p, out = s->b0 * in + u1;
        u1 = s->b1 * in - s->a1 * out + u2;
        u2 = s->b2 * in - s->a2 * out;
        *p = out;
    }
}

int fl_butterworth_zero_phase(const fl_butterworth *f, int32_t n, const double *x, double *y, fl_err *err)
{
    const double need = fl_butterworth_pad(f);
    if (!(need < n))
        return fl_fail(err, FL_INPUT,
                       "the record of %d rows is too short for a filter of order %d at %g Hz, which needs "
                       "more than %.0f",
                       n, f->order, f->decay_frequency, need);
    const int64_t pad = (int64_t)need, all = n + 2 * pad;
    double *ext = fl_alloc(all, sizeof *ext, err);
    if (!ext) return -1;
    for (int64_t k = 0; k < pad; k++) {
        ext[k] = 2.0 * x[0] - x[pad - k];
        ext[pad + n + k] = 2.0 * x[n - 1] - x[n - 2 - k];
    }
    for (int32_t k = 0; k < n; k++) ext[pad + k] = x[k];
    for (int k = 0; k < f->n; k++) apply_section(&f->s[k], f->dc_gain, all, ext, 1);
    for (int k = 0; k < f->n; k++) apply_section(&f->s[k], f->dc_gain, all, ext, -1);
    for (int32_t k = 0; k < n; k++) y[k] = ext[pad + k];
    free(ext);
    return 0;
}
