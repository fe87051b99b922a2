/* SPDX-License-Identifier: GPL-3.0-or-later */
/* concentration_gradient.h -- a concentration that changes along one direction. */
#ifndef FL_ICE_CONCENTRATION_GRADIENT_H
#define FL_ICE_CONCENTRATION_GRADIENT_H
#include <stdint.h>
#include "base/err.h"
#include "geom/polygon.h"

/* c(s) with s = x cos a + y sin a: linear between the rows of a table, constant beyond its ends. */
typedef struct {
    double angle; /* a, [rad] */
    int32_t n;    /* >= 1     */
    double *s;    /* [n] ascending [m] */
    double *c;    /* [n] between 0 and 1   */
} fl_concentration_gradient;

double fl_concentration_at(const fl_concentration_gradient *g, fl_vec2 p);

/* Linear change from c0 to c1 over the extent of the box lo .. hi in the direction.  Returns 0, or -1 with
 * FL_SYSTEM; out is unchanged then. */
int fl_concentration_linear(fl_concentration_gradient *out, double angle, double c0, double c1, fl_vec2 lo,
                            fl_vec2 hi, fl_err *err);

/* Read a table with rows "s c": s [m] ascending, 0 < c < 1; a first row "s[m] c" may name the columns.
 * Returns 0, or -1 with FL_INPUT (file and line) or FL_SYSTEM; out is unchanged then. */
int fl_concentration_read(fl_concentration_gradient *out, double angle, const char *path, fl_err *err);

void fl_concentration_free(fl_concentration_gradient *g); /* accepts a zeroed struct, leaves a zeroed one */

#endif
