/* SPDX-License-Identifier: GPL-3.0-or-later */
/* uniform_step.h -- a record in steps of a length that is asked for, and what that takes from it. */
#ifndef FL_STAT_UNIFORM_STEP_H
#define FL_STAT_UNIFORM_STEP_H
#include "stat/series.h"

/* What one signal loses: the difference between the record and its means over the steps, x(t) - y(t).  The
 * means are the projection of the record on functions that are constant in each step, so that rms^2 = mean
 * square of x - mean square of y.  */
typedef struct {
    double rms, largest; /* of x - y over time [unit] */
} fl_resampling_loss;

/* Replace the rows of s by means over steps of the given length [s], counted from the first edge, by
 * fl_resample_means(): the mean over any whole number of steps stays what it was.  What is left at the end,
 * less than one step, is left out.  The time of a row is then the end of its step in a loads table and the
 * middle in another. loss[parts * signals]   out; may be NULL 0, or -1 with FL_INPUT (a step longer than the
 * record, or too short for it) or FL_SYSTEM in err; s is then as it was. */
int fl_resample_uniform(fl_series *s, double step, fl_resampling_loss *loss, fl_err *err);

#endif
