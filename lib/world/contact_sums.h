/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact_sums.h -- damping and friction summed over the contacts of a body, for the energy ledger.
 *
 * sim/energy_ledger.h computes the works from these sums; sphere pairs have their own sums
 * (sphere_contacts.h). */
#ifndef FL_WORLD_CONTACT_SUMS_H
#define FL_WORLD_CONTACT_SUMS_H
#include "world/pair.h"

/* Forces and torques of damping and of friction on one body: world axes, torques about its centre. */
typedef struct {
    fl_vec3 damping, damping_torque, friction, friction_torque; /* [N], [N m] */
    int32_t contacts;                                           /* 0: all members are 0 */
} fl_contact_sum;

/* The sums of all bodies.  Body k uses sum[slot[k]]; sum[0] stays 0 and serves bodies without contacts.
 * Few bodies touch at a time, so only these have a slot of their own.  With bonds or resting bodies every
 * body has one: slot[k] = k + 1. */
typedef struct {
    int32_t *slot;       /* [total] */
    fl_contact_sum *sum; /* [cap] */
    int32_t cap;
    int one_each; /* every body has its own slot */
} fl_contact_sums;

/* Change of velocity and angular velocity of a body by a kick, world axes. */
typedef struct {
    fl_vec3 v, w; /* [m/s], [rad/s] */
} fl_velocity_change;

/* Add damping and friction of pair p to the sum of its body i (is_i = 1) or j (is_i = 0). */
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
