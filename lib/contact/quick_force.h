/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quick_force.h -- force of the law `quick`, W = k sqrt(U), by the sums of patch/quick_law.h. */
#ifndef FL_CONTACT_QUICK_FORCE_H
#define FL_CONTACT_QUICK_FORCE_H
#include "contact/pair_kinematics.h"
#include "patch/quick_law.h"
#include "patch/surrogate.h"

/* Evaluates the law `quick`; t as in fl_pair_update_surrogate().  1 when they touch, 0 when they do not, -1
 * when memory runs out. */
int fl_pair_evaluate_quick(fl_world *w, fl_pair *p, int32_t thread, const fl_quick_sums *q,
                           const fl_surrogate_value *t, const fl_relative_pose *r,
                           const fl_pair_prediction *a, int survey);

#endif
