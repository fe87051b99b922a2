/* SPDX-License-Identifier: GPL-3.0-or-later */
/* point_force.h -- contact laws whose force acts at points: springs at closest points, and the laws of the
 * manual. */
#ifndef FL_CONTACT_POINT_FORCE_H
#define FL_CONTACT_POINT_FORCE_H
#include "contact/pair_kinematics.h"
#include "contact/point_kernel.h"
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

/* What a contact at one point remembers, and its forces, between fl_pair and point_kernel.h. */
fl_point_memory fl_pair_memory(const fl_pair *p);
fl_point_forces fl_pair_forces(const fl_pair *p);
void fl_pair_set_point(fl_pair *p, const fl_point_memory *m, const fl_point_forces *f);

/* Bounds omega^2 of such a contact.
 *   n, aj    normal, and the point from the centre of B, world axes
 *   off      from the centre of A to that of B [m]
 *   normal   normal force [N] */
void fl_pair_bound_single_point(const fl_world *w, fl_pair *p, fl_vec3 n, fl_vec3 aj, fl_vec3 off,
                                double normal);

#endif
