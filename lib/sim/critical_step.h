/* SPDX-License-Identifier: GPL-3.0-or-later */
/* critical_step.h -- how long a step may be: bounds of the critical one before anything touches, and what a step
 * costs in accuracy without a look at any other. */
#ifndef FL_SIM_CRITICAL_STEP_H
#define FL_SIM_CRITICAL_STEP_H
#include "world/world.h"

/* The automatic step [s], and the body that sets it: safety * 2/omega, omega^2 bounded per body by the
 * stiffest face it can meet, at its most compliant vertex, lowered for damping: to half of what that of one
 * contact leaves, or 0.8 of it where an impact is all that it leaves less for, or to what it leaves where
 * bodies are held between many (S20 to S25 of verify_stable_step_packed, _step).  Under run.error the longest that windows
 * can be trusted at: half of 2/omega, and of what an impact leaves a quarter, or up to 0.8 of it where that
 * is below 0.12 of 2/omega or little is damped.
 *
 * All that is of contacts.  Bonds, of which omega^2 has all that a body ever has, keep to safety, to half of
 * what their own dashpots leave, and by run.error to 0.8 of that, half of 2/omega at the most; with c and b
 * the shares that contacts and bonds so keep to and C, B their omega^2,
 *     dt = 2/sqrt(C/c^2 + B/b^2)                                              (S34, S35 of verify_stable_step_packed).
 * So what has broken to rubble takes no longer step than if it had never been frozen together. */
double fl_automatic_step(const fl_world *w, int32_t *body);

/* What is foreseen: 2/omega [s], c, and by how much 1/dt^2 of fl_automatic_step() is less than if bonds kept to c
 * as well [1/s2], 0 where there are none. */
typedef struct {
    double critical, contact_share, bond_relief;
} fl_predicted_limit;
fl_predicted_limit fl_predict_step_limit(const fl_world *w);

/* The longest step where 2/omega is seen to be that, what is stiffer than foreseen being contacts: without
 * bonds c times as much.  INFINITY: nothing is, and it is fl_automatic_step() that bounds the step. */
double fl_longest_step(const fl_predicted_limit *f, double seen);

/* What it is a part of: 2/omega, without damping [s]. */
double fl_critical_step(const fl_world *w);

/* The share of that which the most damping that a contact can have leaves: fl_damping_impact_share(); of what goes
 * by the speed half a step ago sqrt(1 + z^2) - z of its ratio z, what is round and rough across, too. */
double fl_damped_share(const fl_world *w);

/* What damping by fl_damping_end_speed() leaves of 2/omega of what does not run into each other, at least, of
 * one contact or many, whatever their damping: 0.70 was found (S08 to S24 of verify_step, _heaps). */
#define FL_DAMPED_SHARE_MIN 0.7

/* What is left of that where all that is rough is shaken across, standing on its end or an edge, and balls
 * are held between others: of `core`, if damping is strong, 0.55 for boxes and 0.7 for balls; 1 for `patch`,
 * but for balls in grooves and with parts of a structure that move by themselves.  Automatic steps are below
 * it. */
double fl_lateral_share(const fl_world *w);

/* Whether the looks that water.every leaves of the waves are enough: a twentieth apart of the shortest period
 * of any body in heave, roll and pitch, and of the waves that 95 % of the energy is in, which w->dt has to be
 * known for.  What is carried on between looks (environment.h) then is off by 0.04 of itself, and grows by 0.005 e
 * omega.  0, or -1 with FL_INPUT. */
int fl_check_wave_sampling(const fl_world *w, fl_err *err);

/* What steps of dt are off by, without a look at any other step; 0 before the first contact.  With r = dt
 * over the smallest critical step of contacts alone that was seen
 *     peak of a hit   0.35 D r/(1 + D/2) + min(0.15 + 0.2 D'^2, 0.95) r^2,
 *     impulse         1.5 r^2 at the most, and no more than 0.3 r; where D > 0 that.
 * A half-wave seen at intervals of dt is low by up to (omega dt/2)^2/2, and damping and friction are of order
 * 2 as well; D' = chi v_impact is that of the most damped contacts.  D is that of those for which they are
 * not: balls in grooves and other laws go by the speed half a step ago, and in a spring that is struck this
 * differs by up to omega v dt/2 = r v, a share D r of the force where D is small.  So do bonds, but what they
 * are stiffer than contacts moves along with the blow: of their D the part that r is of dt over the critical
 * step of all counts.  When bonds end is not in it.  The numbers are fitted to the 20 scenes of
 * verify_budget.  Of the impulse it is a bound: it was off by 0.6 r^2 where friction decided on the way, and
 * by 1e-7 r^2 where all came to rest.
 */
double fl_peak_error(const fl_world *w);
double fl_impulse_error(const fl_world *w);

#endif
