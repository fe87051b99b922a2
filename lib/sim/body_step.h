/* SPDX-License-Identifier: GPL-3.0-or-later */
/* body_step.h -- parts of a step of one body: its forces, kick and drift. */
#ifndef FL_SIM_BODY_STEP_H
#define FL_SIM_BODY_STEP_H
#include "world/world.h"

/* Force and torque on thing k into b.f[k], b.t[k]: weight, water, then its pairs in the order of the list,
 * whichever thread takes it. */
void fl_body_sum_forces(fl_world *w, int32_t k);

/* Parts of a step, of floe k alone: drag s/2, kick s/2, drift s; force and torque of weight, water and
 * springs; those of its pairs besides (1 when it touches anything, with what damping and friction do in
 * sink[k]); a kick of h. */
void fl_body_first_half(fl_world *w, int32_t k, double s);
void fl_body_external_force(fl_world *w, int32_t k);
int fl_body_contact_force(fl_world *w, int32_t k);
void fl_body_kick(fl_world *w, int32_t k, double h);

#endif
