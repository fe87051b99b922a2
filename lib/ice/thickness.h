/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thickness.h -- how thick each floe is: laws of thickness, and the number that a floe draws from one.
 *
 *     H                    all the same                                                 [m]
 *     uniform:A,B          every thickness from A to B as probable as the other         [m]
 *     lognormal:MEAN,CV    mean [m], standard deviation over mean
 *     FILE                 "h" or "h count" a row, h [m]: each as probable as its count; a first row "h[m]"
 *                          or "h[m] count" may name the columns */
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
    double a, b; /* SAME: a = H; UNIFORM: from a to b; LOGNORMAL: mean, deviation over mean */
    int32_t n;   /* TABLE                                                                   */
    double *h;   /* [n] ascending, all different [m]                                        */
    double *p;   /* [n + 1] rising from 0 to 1: h[k] has the part p[k + 1] - p[k]           */
} fl_thickness;

/* A floe whose thickness leaves less than this part of two dilation radii for a core draws again. */
#define FL_THICKNESS_MIN_CORE 0.05

/* Read the name of a law; a text that names none is taken for a file, which is read.
 * Returns 0, or -1 with FL_USAGE (what was found and what is expected), FL_INPUT (the file) or FL_SYSTEM; out
 * is untouched then. */
int fl_thickness_parse(fl_thickness *out, const char *text, fl_err *err);
int fl_thickness_read(fl_thickness *out, const char *path, fl_err *err);

/* The thickness of floe id: the first of its random numbers above `least` [m], which is the law given that.
 *   *again  out: how many were too small
 * Returns it [m], or 0 when a thousand were. */
double fl_thickness_draw(const fl_thickness *t, uint64_t seed, int32_t id, double least, int32_t *again);

/* The part of all floes that are thicker than `least` and at most h thick. */
double fl_thickness_cdf(const fl_thickness *t, double least, double h);

/* Kolmogorov-Smirnov distance between the law above `least` and ascending thicknesses h[n]. */
double fl_thickness_ks_distance(const fl_thickness *t, double least, int32_t n, const double *h);

void fl_thickness_free(fl_thickness *t); /* accepts a zeroed struct, leaves one */

#endif
