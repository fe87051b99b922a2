/* SPDX-License-Identifier: GPL-3.0-or-later */
/* patch_force.h -- force of the patch law, W = k sqrt(U), by the sums of patch/force_sum.h. */
#ifndef FL_CONTACT_PATCH_FORCE_H
#define FL_CONTACT_PATCH_FORCE_H
#include "contact/pair_kinematics.h"
#include "patch/surrogate.h"

/* Evaluates a patch, W = k sqrt(U), each point with its share of dW/dU; t as in fl_pair_update_surrogate().
 * The points are those of w->scratch[thread].  1 when they touch, 0 when they do not, -1 when memory runs
 * out. */
int fl_pair_evaluate_patch(fl_world *w, fl_pair *p, int32_t thread, const fl_surrogate_value *t,
                           const fl_relative_pose *r, const fl_pair_prediction *a, int survey);

#endif
