/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_damping.h -- damping of a pair: its factor chi, the share of a sustained load, and damping that does
 * not oscillate from step to step (law/damping.h). */
#ifndef FL_CONTACT_PAIR_DAMPING_H
#define FL_CONTACT_PAIR_DAMPING_H
#include "contact/pair_kinematics.h"

/* Damping factor of all points of a pair,
 *     chi = D / max(v_touch, c sqrt(2 W / M)),
 * with v_touch the largest approach speed of this contact, `now` the present one, and sqrt(2 W/M) the speed
 * of the stored energy W, c of fl_damping_slow_factor().  In an impact v_touch is the larger one and D sets
 * the restitution.  In a contact that began without an impact the damping ratio stays below D/(2 c). */
double fl_pair_damping_factor(fl_pair *p, double now, double mass);

/* True if the other body is a piece of the structure that may have several faces, which bodies pass. */
int fl_pair_is_on_facets(const fl_world *w, const fl_pair *p);

/* lambda of law/damping.h; updates the sustained load and spin.
 *   load, slope, mass   sum of the pressures, its stiffness, effective mass
 *   u, spin             sliding speed of the cores and spin, both across the normal
 *   sigma2              variance of the approach speeds */
double fl_pair_sustained_share(const fl_world *w, fl_pair *p, double load, double slope, double mass,
                               fl_vec3 u, fl_vec3 spin, double sigma2);

/* Replaces the damping of p by fl_stabilised_damping(), while its force is still the elastic one.
 * pressure: sum of the pressures. */
void fl_pair_stabilise_damping(fl_pair *p, double total_pressure, double chi, const fl_relative_pose *r,
                               const fl_pair_prediction *a);

#endif
