/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stat/regime.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"

#define STILL 0.5     /* beta below which crushing is continuous */
#define LOCKED 1.6    /* and above which a motion is not locked in */
#define NEAR_MODE 0.1 /* relative distance from a natural frequency */
#define BAND 1.5      /* the spectrum reaches to so many times the highest natural frequency */
enum { FINER = 4 };   /* steps of the spectrum in one of its resolution */

const char *fl_regime_name(int regime)
{
    static const char *const name[FL_REGIMES] = {"creep", "intermittent", "lock-in", "continuous"};
    return name[regime];
}

typedef struct {
    double mean, std, max;
} moments;

static moments moments_of(const double *x, int32_t n)
{
    moments m = {.max = -INFINITY};
    double square = 0.0;
    for (int32_t k = 0; k < n; k++) m.mean += x[k] / n, m.max = fmax(m.max, x[k]);
    for (int32_t k = 0; k < n; k++) square += (x[k] - m.mean) * (x[k] - m.mean) / n;
    m.std = sqrt(square);
    return m;
}

/* Power of y, already tapered, at frequency f: by the recurrence of Goertzel. */
static double power_at(const double *y, int32_t n, double dt, double f)
{
    const double turn = 2.0 * cos(2.0 * PI * f * dt);
    double s1 = 0.0, s2 = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const double s = y[k] + turn * s1 - s2;
        s2 = s1, s1 = s;
    }
    return fmax(0.0, s1 * s1 + s2 * s2 - turn * s1 * s2);
}

/* Frequency of the largest power up to `most`; NAN without any motion. */
static double dominant_frequency(const double *v, int32_t n, double dt, double mean, double most, fl_err *err)
{
    double *y = fl_alloc(n, sizeof *y, err), best = 0.0, below = 0.0, above = 0.0, last = 0.0;
    const double step = 1.0 / (FINER * n * dt);
    int32_t at = -1, steps = (int32_t)(fmin(most, 0.5 / dt) / step);
    if (!y) return NAN;
    for (int32_t k = 0; k < n; k++) y[k] = (v[k] - mean) * (0.5 - 0.5 * cos(2.0 * PI * (k + 0.5) / n));
    for (int32_t k = FINER / 2; k <= steps; k++) {
        const double p = power_at(y, n, dt, k * step);
        if (at == k - 1) above = p;
        if (p > best) best = p, at = k, below = last, above = 0.0;
        last = p;
    }
    free(y);
    if (at < 0) return NAN;
    const double a = log(fmax(below, 1e-300)), b = log(best), c = log(fmax(above, 1e-300)),
                 bend = a - 2.0 * b + c;
    const double shift = below > 0.0 && above > 0.0 && bend < 0.0 ? 0.5 * (a - c) / bend : 0.0;
    return (at + fmax(-1.0, fmin(1.0, shift))) * step;
}

/* Mean of the largest velocity between two rises of v through its mean; 0 without two of them. */
static double mean_peak(const double *v, int32_t n, double mean)
{
    double sum = 0.0, most = 0.0;
    int32_t cycles = -1;
    for (int32_t k = 1; k < n; k++) {
        if (v[k - 1] < mean && v[k] >= mean) {
            if (cycles >= 0) sum += most;
            cycles++;
            most = 0.0;
        }
        most = fmax(most, v[k] - mean);
    }
    return cycles > 0 ? sum / cycles : 0.0;
}

int fl_regime_classify(fl_regime_window *out, const fl_regime_rows *r, int32_t from, int32_t to,
                       const double *mode, int32_t modes, fl_err *err)
{
    const int32_t n = to - from;
    const moments F = moments_of(r->load + from, n), x = moments_of(r->x + from, n),
                  v = moments_of(r->v + from, n), ice = moments_of(r->ice + from, n);
    double highest = 0.0, breaks = 0.0;
    for (int32_t k = 0; k < modes; k++) highest = fmax(highest, mode[k]);
    for (int32_t k = from; r->breaks && k < to; k++) breaks += r->breaks[k];
    *out = (fl_regime_window){.mode = -1,
                              .speed = ice.mean,
                              .beta = sqrt(2.0) * v.std / fabs(ice.mean),
                              .peak = mean_peak(r->v + from, n, v.mean) / fabs(ice.mean),
                              .frequency =
                                  dominant_frequency(r->v + from, n, r->dt, v.mean, BAND * highest, err),
                              .load = F.mean,
                              .load_std = F.std,
                              .load_max = F.max,
                              .x_mean = x.mean,
                              .x_std = x.std,
                              .breaks = breaks};
    if (err->code) return -1;
    for (int32_t k = 0; k < modes; k++)
        if (fabs(out->frequency - mode[k]) <= NEAR_MODE * mode[k] &&
            (out->mode < 0 || fabs(out->frequency - mode[k]) < fabs(out->frequency - mode[out->mode])))
            out->mode = k;
    out->regime = r->breaks && breaks == 0.0              ? FL_REGIME_CREEP
                  : out->beta < STILL                     ? FL_REGIME_CONTINUOUS
                  : out->beta <= LOCKED && out->mode >= 0 ? FL_REGIME_LOCK_IN
                                                          : FL_REGIME_INTERMITTENT;
    if (out->regime != FL_REGIME_LOCK_IN) out->mode = -1;
    return 0;
}
