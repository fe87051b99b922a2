/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact_sums.h -- sums of damping and friction over the contacts of a body. */
#ifndef FL_WORLD_CONTACT_SUMS_H
#define FL_WORLD_CONTACT_SUMS_H
#include "world/pair.h"

/* What damping and friction of its contacts do to a thing: forces and torques about its centre, world axes.
 */
typedef struct {
    fl_vec3 damping, damping_torque, friction, friction_torque;
    int32_t contacts; /* with 0 all is 0 */
} fl_contact_sum;

/* Those of all that are pressed.  A body has the sink at[place[k]]; at[0] is of all that nothing presses on,
 * and stays 0.  Few touch at a time: only they have one of their own, but where faces are frozen together or
 * somebody sleeps; then place[k] = k + 1.  What rows do to spheres is in their own sums, sphere_contacts.h. */
typedef struct {
    int32_t *slot;       /* [total] */
    fl_contact_sum *sum; /* [cap] */
    int32_t cap;
    int one_each; /* every body has one */
} fl_contact_sums;

/* How its velocities change in a kick. */
typedef struct {
    fl_vec3 v, w;
} fl_velocity_change;

/* Add what damping and friction of pair p do to one of its two. */
static inline void fl_contact_sum_add(fl_contact_sum *s, const fl_pair *p, int is_i)
{
    const double sign = is_i ? 1.0 : -1.0;
    s->contacts++;
    s->damping = v3_madd(s->damping, sign, p->force_damping);
    s->damping_torque = v3_add(s->damping_torque, is_i ? p->torque_i_damping : p->torque_j_damping);
    s->friction = v3_madd(s->friction, sign, p->force_friction);
    s->friction_torque = v3_add(s->friction_torque, is_i ? p->torque_i_friction : p->torque_j_friction);
}

#endif
