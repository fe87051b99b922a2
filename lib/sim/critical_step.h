/* SPDX-License-Identifier: GPL-3.0-or-later */
/* critical_step.h -- bounds of the stable step before anything touches, the automatic step, and estimates
 * of the error of a step without another run.
 *
 * Symbols: 2/omega critical step of an undamped contact; D = chi v_impact damping of a contact; a contact
 * is "late" if its damping uses the velocity of half a step ago: laws other than `patch`, spheres in
 * concave edges, contacts with movers that have free directions.  Numbers S.. and E.. are rows of the
 * verify programs. */
#ifndef FL_SIM_CRITICAL_STEP_H
#define FL_SIM_CRITICAL_STEP_H
#include "world/world.h"

/* The automatic step [s]; *body: the body that sets it.
 *
 * omega^2 of a body is bounded by the stiffest face that it can meet, at its most compliant vertex, or by ice
 * that crushes by its speed, fl_strips_stiffness(), where it meets walls.  The step is run.safety times
 * 2/omega, lowered for damping to
 *     half of the share that damping of one late contact leaves,
 *     0.8 of the share that an impact leaves (law `patch`),
 *     the share that damping leaves among many contacts (S20 to S25 of verify_stable_step_packed,
 *     verify_step).
 * With run.error it is the longest step at which windows can be trusted: half of 2/omega, and a quarter
 * of the share that an impact leaves, or up to 0.8 of it where that is below 0.12 of 2/omega or damping
 * is weak.
 *
 * Bonds, whose omega^2 has all bonds that a body ever has, use run.safety and half of the share that
 * their dashpots leave; with run.error 0.8 of it, at most half of 2/omega.  With c and b the shares of
 * contacts and bonds and C, B their omega^2,
 *     dt = 2/sqrt(C/c^2 + B/b^2)                                  (S34, S35 of verify_stable_step_packed).
 * So rubble needs no shorter step than if it had never been bonded. */
double fl_automatic_step(const fl_world *w, int32_t *body);

/* The predicted limits of the step. */
typedef struct {
    double critical;      /* 2/omega [s] */
    double contact_share; /* c */
    double
        bond_relief; /* 1/dt^2 if bonds used c, less 1/dt^2 of fl_automatic_step() [1/s2]; 0 without bonds */
} fl_predicted_limit;
fl_predicted_limit fl_predict_step_limit(const fl_world *w);

/* The longest step if the smallest 2/omega seen in a run is `seen` [s]: contacts are stiffer than
 * predicted; c times that without bonds.  INFINITY if it is not below the prediction: fl_automatic_step()
 * limits then. */
double fl_longest_step(const fl_predicted_limit *f, double seen);

/* Shorten w->dt, an automatic step, to the longest step for the contacts that there are at the start, rounded
 * so that rows of the loads are whole steps apart. Needs the stiffnesses of the present contacts,
 * w->dt_critical. A scene whose bodies overlap by more than an impact would, or that are at rest with nothing
 * to drive them, has stiffer contacts than predicted. Returns 1 if the step changed. */
int fl_shorten_step_at_start(fl_world *w);

/* Plan area of the smallest fragment of floe i, of thickness h, that w->dt bears [m2]: a square plate of that
 * area A, held by two whole faces, has
 *     omega^2 = 4 K 1.25/(rho h A),   K = 2 c sqrt(max(A, h sqrt(A)))
 * with the largest c that it meets, 1.25/m being the compliance of a plate near its corner. dt is the share
 * of 2/omega that damping leaves, FL_DAMPED_SHARE_MIN at most. */
double fl_least_fragment_area(const fl_world *w, int32_t i, double h);

/* 2/omega by prediction, without damping [s]. */
double fl_critical_step(const fl_world *w);

/* The share of 2/omega that the strongest damping of one contact leaves: fl_damping_impact_share(); for late
 * contacts with damping ratio z it is sqrt(1 + z^2) - z, also tangentially for rough spheres. */
double fl_damped_share(const fl_world *w);

/* The smallest share of 2/omega that damping by fl_damping_end_speed() leaves to bodies in lasting
 * contact, one contact or many, for any damping: 0.70 was found (S08 to S24 of verify_step,
 * verify_stable_step_packed). */
#define FL_DAMPED_SHARE_MIN 0.7

/* The share of fl_damped_share() that remains for tangential vibration of rough bodies that stand on an
 * end or an edge, and of spheres between others.  `core` with strong damping: 0.55 for boxes, 0.7 for
 * spheres.  `patch`: 1, but not for spheres in concave edges or with parts that move freely.  Automatic
 * steps are below it. */
double fl_lateral_share(const fl_world *w);

/* Check that water.every samples the waves often enough: 20 times in the shortest period of any body in
 * heave, roll and pitch, and of the waves with 95 % of the energy.  Needs w->dt.  The extrapolation
 * between samples (environment.h) then is off by 0.04 of itself, and grows by 0.005 e omega.  0, or -1
 * with FL_INPUT. */
int fl_check_wave_sampling(const fl_world *w, fl_err *err);

/* Estimated relative error of steps of w->dt, without another run; 0 before the first contact.  With r =
 * dt over the smallest critical step of contacts alone seen so far
 *     peak of an impact   0.35 D r/(1 + D/2) + min(0.15 + 0.2 D'^2, max(0.95, 0.15 + 0.05 D')) r^2,
 *     impulse             at most min(1.5 r^2, 0.3 r); 0.3 r if D > 0.
 * A half wave sampled at intervals dt is low by up to (omega dt/2)^2/2; damping and friction are of order
 * 2, too. D' is that of the most damped contacts; where D' >> 1 the load of an impact rises and falls within
 * 1/(omega sqrt(D')), so that the share of r^2 grows with D' (restitutions of 0.02 to 0.1: sheets of
 * verify_budget at six steps, free and bonded, had at most 2.2, 1.6, 0.2).  D is that of the most damped late
 * contacts, of order 1: half a step changes the velocity by up to omega v dt/2 = r v, a share D r of the
 * force for small D. Bonds are late, too; of their D the fraction r/(dt over the critical step of all)
 * counts, as what bonds are stiffer than contacts moves with the impact.  The error of the time at which
 * bonds fail is not included. The numbers are fitted to the 20 scenes of verify_budget.  The impulse is a
 * bound: errors were 0.6 r^2 where friction decided, 1e-7 r^2 where all came to rest. */
double fl_peak_error(const fl_world *w);
double fl_impulse_error(const fl_world *w);

#endif
