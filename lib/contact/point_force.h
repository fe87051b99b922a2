/* SPDX-License-Identifier: GPL-3.0-or-later */
/* point_force.h -- contact laws whose force acts at points: springs at closest points, and the laws of the
 * manual. */
#ifndef FL_CONTACT_POINT_FORCE_H
#define FL_CONTACT_POINT_FORCE_H
#include "contact/pair_kinematics.h"
#include "patch/patch_types.h"

/* Evaluates springs at closest points: W = k sum of phi(s), mostly of one point.  The previous force of a
 * point is known only of a single point that is the same as a step ago.  Other points are damped by the
 * speed of half a step ago.  1 when they touch, -1 when memory runs out. */
int fl_pair_evaluate_points(fl_world *w, fl_pair *p, const fl_patch_points *s, const fl_relative_pose *r,
                            const fl_pair_prediction *by, int survey);

/* Evaluates the laws of the manual: one contact, by the kind of the closest features.  *distance is that of
 * the cores; p->touching tells whether they touch.  -1 when memory runs out. */
int fl_pair_evaluate_features(fl_world *w, fl_pair *p, int32_t thread, const fl_relative_pose *r,
                              const fl_pair_prediction *a, int survey, double *distance);

#endif
