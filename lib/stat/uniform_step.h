/* SPDX-License-Identifier: GPL-3.0-or-later */
/* uniform_step.h -- resample a record to a uniform time step, and the information this loses. */
#ifndef FL_STAT_UNIFORM_STEP_H
#define FL_STAT_UNIFORM_STEP_H
#include "stat/series.h"

/* Loss of one signal: the difference between the record x(t) and its means y(t) over the steps.  The means
 * are the projection on functions that are constant in each step, so
 *     rms^2 = mean square of x - mean square of y. */
typedef struct {
    double rms, largest; /* of x - y over time [unit] */
} fl_resampling_loss;

/* Replace the rows of s by means over steps of the given length [s], counted from the first edge, with
 * fl_resample_means().  The mean over any whole number of steps is preserved.  The remainder at the end, less
 * than one step, is dropped.  The time of a row is the end of its step in a loads table and the middle in any
 * other.
 *   loss[parts * signals]   out; may be NULL
 * 0, or -1 with FL_INPUT (a step longer than the record, or too short for it) or FL_SYSTEM in err; s is then
 * unchanged. */
int fl_resample_uniform(fl_series *s, double step, fl_resampling_loss *loss, fl_err *err);

#endif
