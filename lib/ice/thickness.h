/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thickness.h -- distributions of the thickness of floes, and the thickness drawn for a floe.
 *
 *    H                    constant                                                     [m]
 *    uniform:A,B          uniform from A to B                                          [m]
 *    lognormal:MEAN,CV    mean [m], coefficient of variation
 *    FILE                 rows "h" or "h count", h [m], with the probability of the count; a first row "h[m]"
 *                         or "h[m] count" may name the columns */
#ifndef FL_ICE_THICKNESS_H
#define FL_ICE_THICKNESS_H
#include <stdint.h>
#include "base/err.h"

enum fl_thickness_kind {
    FL_THICKNESS_CONSTANT,
    FL_THICKNESS_UNIFORM,
    FL_THICKNESS_LOGNORMAL,
    FL_THICKNESS_TABLE
};

typedef struct {
    enum fl_thickness_kind kind;
    double a, b; /* CONSTANT: a = H; UNIFORM: from a to b; LOGNORMAL: mean, coefficient of variation */
    int32_t n;   /* TABLE                                                                   */
    double *h;   /* [n] ascending, all different [m]                                        */
    double *p;   /* [n + 1] ascending from 0 to 1: h[k] has the probability p[k + 1] - p[k] */
} fl_thickness;

/* Least thickness of a core over two dilation radii; a thinner floe draws again. */
#define FL_THICKNESS_MIN_CORE 0.05

/* Parse the name of a law; any other text is a file, which is read.  Returns 0, or -1 with FL_USAGE (what
 * was found and what is expected), FL_INPUT (the file) or FL_SYSTEM; out is unchanged then. */
int fl_thickness_parse(fl_thickness *out, const char *text, fl_err *err);
int fl_thickness_read(fl_thickness *out, const char *path, fl_err *err);

/* Thickness of floe id: the first of its random numbers above `least` [m], that is the law under this
 * condition.
 *    *again  out: number of draws that were too small
 * Returns the thickness [m], or 0 after a thousand draws that were too small. */
double fl_thickness_draw(const fl_thickness *t, uint64_t seed, int32_t id, double least, int32_t *again);

/* Cumulative distribution under the condition of a thickness above `least`: fraction of floes with at most
 * h. */
double fl_thickness_cdf(const fl_thickness *t, double least, double h);

/* Kolmogorov-Smirnov distance between the law above `least` and ascending thicknesses h[n]. */
double fl_thickness_ks_distance(const fl_thickness *t, double least, int32_t n, const double *h);

void fl_thickness_free(fl_thickness *t); /* accepts a zeroed struct, leaves a zeroed one */

#endif
