/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sweeps.h -- continuity of a quantity along a path. */
#ifndef FL_TESTS_SWEEPS_H
#define FL_TESTS_SWEEPS_H

/* The largest change(what, s, t) over steps t - s of at most `fine` on [from, to].  Of 400 steps the one
 * with the largest change is divided into ten, the worst of these again, and so on.  A jump survives this
 * refinement; a slope shrinks with the step. */
double sweep_largest(double (*change)(void *what, double s, double t), void *what, double from, double to,
                     double fine);

#endif
