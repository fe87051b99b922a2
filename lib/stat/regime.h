/* SPDX-License-Identifier: GPL-3.0-or-later */
/* regime.h -- regimes of ice-induced vibration, window by window.
 *
 * Along the mean horizontal load of the record, with v the speed of the ice, x the displacement of the
 * waterline and x' its velocity, a window has
 *     beta = sqrt(2) rms(x' - mean x')/v,    v_p = mean of the largest x' of each cycle over v,
 *     f the frequency at which the spectrum of x' is largest,
 * and is
 *     creep         no element of ice breaks
 *     continuous    beta below 0.5
 *     lock-in       beta from 0.5 to 1.6, and f within 10 % of a natural frequency
 *     intermittent  the rest
 * For a harmonic motion beta is the largest velocity over that of the ice.
 *
 * The spectrum is that of the window times Hann's taper, at steps of a quarter of its resolution, and refined
 * by a parabola through the logarithms of the largest three.
 * Limits: a window should be longer than three periods of the lowest mode that is to be found; rows shorter
 * than a tenth of the period of the highest.
 * Source: ISO 19906:2019, 8.2.4; Hendrikse & Nord, Mar. Struct. 65 (2019) 336. */
#ifndef FL_STAT_REGIME_H
#define FL_STAT_REGIME_H
#include <stdint.h>
#include "base/err.h"

enum fl_regime {
    FL_REGIME_CREEP,
    FL_REGIME_INTERMITTENT,
    FL_REGIME_LOCK_IN,
    FL_REGIME_CONTINUOUS,
    FL_REGIMES
};

/* "creep", "intermittent", "lock-in", "continuous". */
const char *fl_regime_name(int regime);

/* Rows of equal length dt [s]: load [N], x [m], x' [m/s], speed of the ice [m/s], breaks (NULL: unknown, and
 * then no window creeps). */
typedef struct {
    int32_t n;
    double dt;
    const double *load, *x, *v, *ice, *breaks;
} fl_regime_rows;

typedef struct {
    int regime;
    int32_t mode;       /* of lock-in: index of the natural frequency; else -1 */
    double speed, beta; /* of the ice [m/s] */
    double peak;        /* v_p */
    double frequency;   /* [Hz]; NAN where x' is 0 */
    double load, load_std, load_max, x_mean, x_std, breaks;
} fl_regime_window;

/* Classifies rows from .. to - 1; mode[modes]: natural frequencies [Hz]. -1 with FL_SYSTEM. */
int fl_regime_classify(fl_regime_window *out, const fl_regime_rows *r, int32_t from, int32_t to,
                       const double *mode, int32_t modes, fl_err *err);

#endif
