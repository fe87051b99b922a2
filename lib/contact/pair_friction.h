/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_friction.h -- adds friction at the centre of pressure (law/tangent.h) and rolling resistance to a
 * pair. */
#ifndef FL_CONTACT_PAIR_FRICTION_H
#define FL_CONTACT_PAIR_FRICTION_H
#include "contact/pair_kinematics.h"
#include "patch/patch_result.h"

/* Sums over contact points, of which the result of a law of points is made. */
typedef struct {
    fl_patch_result result; /* centre: a contact point */
    fl_vec3 moment;         /* sum of F (p - centre)                            [N m] */
    fl_sym3 second;         /* sum of F (p - centre) (p - centre)^T            [N m2] */
} fl_point_sum;

/* Adds a contact point at `arm` from the first one.
 *   elastic, normal  pressure without and with damping [N]
 *   n                unit normal */
void fl_point_sum_add(fl_point_sum *s, double elastic, double normal, fl_vec3 n, fl_vec3 arm);

/* The result of n points. */
fl_patch_result fl_point_sum_result(const fl_point_sum *s, int32_t n);

/* Compliance at the contact, as in fl_friction_contact. */
typedef struct {
    fl_sym3 matrix;
    double turn;
} fl_contact_compliance;

/* Adds friction to p and updates its springs.
 *   q    result of the normal forces
 *   chi  damping factor, fl_pair_damping_factor()
 *   at   compliance at the centre of pressure */
void fl_pair_add_friction(fl_world *w, fl_pair *p, const fl_patch_result *q, double chi,
                          const fl_contact_compliance *at, const fl_relative_pose *r,
                          const fl_pair_prediction *a);

/* Adds the rolling resistance of a sphere, a moment on both, if its law has one.  -1 when memory runs out. */
int fl_pair_add_rolling(fl_world *w, fl_pair *p, const fl_patch_result *q, double chi,
                        const fl_pair_prediction *a);

#endif
