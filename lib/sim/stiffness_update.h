/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stiffness_update.h -- the critical step 2/omega by the contacts and bonds that act, updated every few
 * steps.
 *
 * omega^2 of a body is bounded by its contacts.  A motion u of two bodies has the approach g u - g' u',
 * and
 *     (g u - g' u')^2 <= (1 + c) (g u)^2 + (1 + 1/c) (g' u')^2        for any c > 0,
 * which separates the two.  So omega^2 is at most the largest sum of (1 + c) K over the contacts of a
 * body, with K the omega^2 of one contact while the other body is fixed.  With c = sqrt(K'/K) a light
 * body is not slowed by a heavy one: (1 + c) K = K + sqrt(K K').  Movers use c = 1 (moving_structure.h). */
#ifndef FL_SIM_STIFFNESS_UPDATE_H
#define FL_SIM_STIFFNESS_UPDATE_H
#include "world/world.h"

/* 1 if the stiffnesses are due for an update in this step; contacts then compute theirs. */
int fl_stiffness_due(const fl_world *w, int64_t step);

/* Lower w->dt_critical, w->dt_critical_contacts and set w->critical_body by the contacts of this step.
 * Of equal values the first body counts. */
void fl_stiffness_update(fl_world *w);

#endif
