/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/fast_math.h"
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "water/wave.h"

/* k d from which on the water is deep: 1 - tanh 20 = 2 e^-40 = 8e-18 is below the rounding of 1. */
#define DEEP_KD 20.0
/* Newton's step that is rounding: 2^-53 of x. */
#define NEWTON_TOL 1e-16
/* Reflection by the bottom, of the amplitude, that has no effect: far below SERIES_TOL. */
#define MIRROR_TOL 1e-12
/* Trains have equal energy: this part of them in ascending k is this part of the energy. */
#define ENERGY_PART 0.95

/* Largest relative error of a truncated series of one train. */
#define SERIES_TOL 1e-5

/* Solves x tanh x = y by Newton from above; the function is convex there, so the iterates decrease. */
double fl_wave_number(double omega, double depth, double gravity)
{
    const double deep = omega * omega / gravity, y = deep * depth;
    if (!(y < DEEP_KD)) return deep;
    double x = fmax(y, sqrt(y)) * 1.2;
    for (int k = 0; k < 50; k++) {
        const double t = tanh(x), step = (x * t - y) / (t + x * (1.0 - t * t));
        x -= step;
        if (fabs(step) <= NEWTON_TOL * x) break;
    }
    return x / depth;
}

static void fill_train(const fl_waves *w, fl_wave_train *t, double omega, double a, double phase)
{
    const double kd2 = 2.0 * fl_wave_number(omega, w->depth, w->gravity) * w->depth;
    *t = (fl_wave_train){.k = fl_wave_number(omega, w->depth, w->gravity),
                         .omega = omega,
                         .a = a,
                         .phase = phase,
                         .mirror = kd2 < 2.0 * DEEP_KD ? exp(-kd2) : 0.0};
    t->velocity_factor = w->gravity * t->k / omega;
    t->norm = 1.0 / (1.0 + t->mirror);
    t->power[0] = 1.0;
    for (int m = 1; m < FL_WAVE_TERMS; m++) t->power[m] = t->power[m - 1] * t->k / m;
}

static int begin_waves(fl_waves *w, int32_t n, double direction, double depth, double gravity, fl_err *err)
{
    const double a = fl_radians(direction);
    *w = (fl_waves){.n = n, .direction = v3(cos(a), sin(a), 0), .depth = depth, .gravity = gravity};
    w->train = fl_alloc(n, sizeof *w->train, err);
    return w->train ? 0 : -1;
}

static void finish_waves(fl_waves *w)
{
    w->max_k = w->train[w->n - 1].k;
    w->k95 = w->train[(int32_t)(ENERGY_PART * (w->n - 1))].k;
    double sum = 0.0;
    for (int32_t j = 0; j < w->n; j++) {
        w->max_crest += w->train[j].a;
        sum += 0.5 * w->train[j].a * w->train[j].a;
    }
    w->four_sigma = fmin(w->max_crest, 4.0 * sqrt(sum));
}

int fl_waves_airy(fl_waves *w, double height, double period, double direction, double depth, double gravity,
                  fl_err *err)
{
    if (begin_waves(w, 1, direction, depth, gravity, err)) return -1;
    fill_train(w, w->train, 2.0 * PI / period, 0.5 * height, 0.0);
    finish_waves(w);
    return 0;
}

double fl_jonswap_spectrum(double f, double Hs, double Tp, double gamma)
{
    const double fp = 1.0 / Tp, x = f / fp, sigma = x <= 1.0 ? 0.07 : 0.09, off = (x - 1.0) / sigma;
    if (!(f > 0.0)) return 0.0;
    return 0.3125 * Hs * Hs / (fp * pow(x, 5)) * exp(-1.25 / (x * x * x * x)) *
           pow(gamma, exp(-0.5 * off * off)) * (1.0 - 0.287 * log(gamma));
}

/* The spectrum is used between these parts of the peak frequency: 1e-67 and 0.4 % of the energy lie outside.
 */
#define LOW_FREQUENCY 0.3
#define HIGH_FREQUENCY 4.0
enum { CELLS = 8192 };

int fl_waves_jonswap(fl_waves *w, double Hs, double Tp, double gamma, int32_t n, uint64_t seed,
                     double direction, double depth, double gravity, fl_err *err)
{
    const double a = 0.25 * Hs * sqrt(2.0 / n), df = (HIGH_FREQUENCY - LOW_FREQUENCY) / Tp / CELLS;
    double *sum = fl_alloc(CELLS + 1, sizeof *sum, err); /* energy below the edge of each cell */
    if (!sum || begin_waves(w, n, direction, depth, gravity, err)) {
        free(sum);
        return -1;
    }
    for (int c = 0; c < CELLS; c++)
        sum[c + 1] = sum[c] + df * fl_jonswap_spectrum(LOW_FREQUENCY / Tp + (c + 0.5) * df, Hs, Tp, gamma);
    int c = 0;
    for (int32_t j = 0; j < n; j++) {
        fl_rng g = fl_rng_of(seed, j, FL_RNG_WAVE);
        const double x = fl_rng_unit(&g), phase = 2.0 * PI * fl_rng_unit(&g);
        const double want = (j + x) / n * sum[CELLS];
        while (c < CELLS - 1 && sum[c + 1] < want) c++;
        const double f = LOW_FREQUENCY / Tp + df * (c + (want - sum[c]) / (sum[c + 1] - sum[c]));
        fill_train(w, &w->train[j], 2.0 * PI * f, a, phase);
    }
    finish_waves(w);
    free(sum);
    return 0;
}

/* --- the field around a place ------------------------------------------------------------------ */

/* Terms that a train needs within the radius: until k^m r^m / m! is below SERIES_TOL. */
static int terms_of(const fl_wave_train *t, double radius)
{
    const double x = t->k * radius;
    double size = 1.0;
    int m = 0;
    while (m < FL_WAVE_TERMS && (size > SERIES_TOL || m < x)) {
        m++;
        size *= x / m;
    }
    return m < 2 ? 2 : m;
}

static void add_series(const double *restrict power, int terms, double re, double im, fl_wave_series *a)
{
    double *restrict x = a->re, *restrict y = a->im;
#pragma omp simd
    for (int m = 0; m < terms; m++) {
        x[m] += power[m] * re;
        y[m] += power[m] * im;
    }
}

/* f_m += (-1)^m conj(h_m) */
static void add_reflected(fl_wave_series *f, const fl_wave_series *h, int terms)
{
    for (int m = 0; m < terms; m++) {
        const double sign = m & 1 ? -1.0 : 1.0;
        f->re[m] += sign * h->re[m];
        f->im[m] -= sign * h->im[m];
    }
}

void fl_wave_expand(const fl_waves *w, double s, double z, double radius, double t, fl_wave_expansion *near)
{
    near->s = s;
    near->z = z;
    near->terms = terms_of(&w->train[w->n - 1], radius);
    const int wall = w->train[0].mirror > MIRROR_TOL; /* 1: the bottom has an effect */
    fl_wave_series h, v;
    fl_wave_series *const all[4] = {&near->f, &near->u, &h, &v};
    for (int k = 0; k < (wall ? 4 : 2); k++)
        for (int m = 0; m < near->terms; m++) all[k]->re[m] = all[k]->im[m] = 0.0;
    for (int32_t j = 0; j < w->n; j++) {
        const fl_wave_train *train = &w->train[j];
        const int terms = terms_of(train, radius);
        double c, d;
        fl_cos_sin(train->k * s - train->omega * t + train->phase, &c, &d);
        const double down = z < 0.0 ? fl_exp(train->k * z) : 1.0, a = train->a * train->norm;
        add_series(train->power, terms, a * down * c, a * down * d, &near->f);
        add_series(train->power, terms, a * down * train->velocity_factor * c,
                   a * down * train->velocity_factor * d, &near->u);
        if (!wall) continue;
        const double b = a * train->mirror * (z < 0.0 ? fl_exp(-train->k * z) : 1.0);
        add_series(train->power, terms, b * c, b * d, &h);
        add_series(train->power, terms, b * train->velocity_factor * c, b * train->velocity_factor * d, &v);
    }
    if (wall) add_reflected(&near->f, &h, near->terms), add_reflected(&near->u, &v, near->terms);
    /* on zeta = 0: the real part of f_m (i s)^m; i^m is 1, i, -1, -i */
    for (int m = 0; m < near->terms; m++) {
        const double sign = m & 2 ? -1.0 : 1.0;
        near->eta[m] = m & 1 ? -sign * near->f.im[m] : sign * near->f.re[m];
    }
}

double fl_wave_elevation(const fl_wave_expansion *near, double s, double *slope)
{
    const double x = s - near->s;
    double y = 0.0, dy = 0.0;
    for (int m = near->terms - 1; m >= 0; m--) {
        if (slope) dy = dy * x + y;
        y = y * x + near->eta[m];
    }
    if (slope) *slope = dy;
    return y;
}

double fl_wave_stretch(const fl_waves *w, double z, double eta)
{
    if (z >= eta) return 0.0;
    return w->depth < INFINITY ? (z - eta) * w->depth / (w->depth + eta) : z - eta;
}

/* sum a_m (x + i y)^m, and its derivative by x + i y (may be NULL). */
static void evaluate_series(const fl_wave_series *a, int terms, double x, double y, double value[2],
                            double slope[2])
{
    double re = 0.0, im = 0.0, dre = 0.0, dim = 0.0;
    for (int m = terms - 1; m >= 0; m--) {
        if (slope) {
            const double d = dre * x - dim * y + re;
            dim = dre * y + dim * x + im;
            dre = d;
        }
        const double r = re * x - im * y + a->re[m];
        im = re * y + im * x + a->im[m];
        re = r;
    }
    value[0] = re, value[1] = im;
    if (slope) slope[0] = dre, slope[1] = dim;
}

double fl_wave_pressure(const fl_wave_expansion *near, double s, double zeta)
{
    double f[2];
    evaluate_series(&near->f, near->terms, zeta - near->z, s - near->s, f, NULL);
    return f[0];
}

void fl_wave_kinematics(const fl_waves *w, const fl_wave_expansion *near, double s, double zeta,
                        double velocity[2], double acceleration[2])
{
    const double x = zeta - near->z, y = s - near->s;
    double f[2], df[2];
    evaluate_series(&near->f, near->terms, x, y, f, df);
    evaluate_series(&near->u, near->terms, x, y, velocity, NULL);
    acceleration[0] = w->gravity * df[1]; /* dc/ds = i */
    acceleration[1] = -w->gravity * df[0];
}

double fl_wave_steepness(double height, double period, double depth, double gravity, double *breaking)
{
    const double k = fl_wave_number(2.0 * PI / period, depth, gravity);
    *breaking = 0.142 * (depth < INFINITY ? tanh(k * depth) : 1.0);
    return height * k / (2.0 * PI);
}

void fl_waves_free(fl_waves *w)
{
    free(w->train);
    *w = (fl_waves){0};
}
