/* SPDX-License-Identifier: GPL-3.0-or-later */
/* body_step.h -- forces, kick and drift of one body: the scalar form of first_half.h and second_half.h. */
#ifndef FL_SIM_BODY_STEP_H
#define FL_SIM_BODY_STEP_H
#include "world/world.h"

/* b.f[k], b.t[k] = external and contact forces on thing k.  0 for a floe that is absent. */
void fl_body_sum_forces(fl_world *w, int32_t k);

/* First half of a step of s seconds of floe k: drag s/2, kick s/2, drift s. */
void fl_body_first_half(fl_world *w, int32_t k, double s);

/* b.f[k], b.t[k] = weight, water, wind and heave spring of floe k. */
void fl_body_external_force(fl_world *w, int32_t k);

/* Add the contact forces on thing k to b.f[k], b.t[k], in the order of the lists, and set its contact sum.
 * Returns 1 if that sum has contacts. */
int fl_body_contact_force(fl_world *w, int32_t k);

/* Kick floe k by h; in waves the work of the water is booked with it. */
void fl_body_kick(fl_world *w, int32_t k, double h);

#endif
