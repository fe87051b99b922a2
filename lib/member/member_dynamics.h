/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_dynamics.h -- a chain of balls with its real masses under forces that vary in time.
 *
 *     M a = P + F(t) - f(d, q) - C v
 * f: internal force of the contacts, member_contact.h; P: loads of the model, which do not vary; F: forces on
 * the balls, by ice. The start is the equilibrium under P. C is that of the modes s_i of frequency omega_i
 * (member_modes.h) at damping ratio zeta,
 *     C = M sum_i 2 zeta omega_i s_i s_i^T M + 2 zeta omega_n (M - M sum_i s_i s_i^T M),
 * so that the n lowest modes have this ratio, and higher ones zeta omega_n/omega.
 *
 * A step dt is symmetric: damping dt/2, kick dt/2 by F, substeps of the chain under its own forces, kick dt/2
 * by the new F, damping dt/2. Damping is exact: v loses 1 - exp(-c dt/2) of what it has along each mode.
 * Each of N substeps is one of Stoermer and Verlet; N keeps them below SUBSTEP_SHARE of the stable step,
 * 2/omega with the largest omega of a single contact with its share of the masses (Rayleigh). F acts once a
 * step, so that the step of the ice, not of the steel, decides what a run costs.
 * Source: Tuckerman, Berne & Martyna, J. Chem. Phys. 97 (1992) 1990 (impulses of slow forces). */
#ifndef FL_MEMBER_MEMBER_DYNAMICS_H
#define FL_MEMBER_MEMBER_DYNAMICS_H
#include "member/member_modes.h"

enum { FL_MEMBER_DAMPED_MODES = 24 };

typedef struct {
    fl_member_chain chain;   /* over_m, over_i of the real masses */
    double *mass, *inertia;  /* [balls] */
    fl_vec3 *force, *moment; /* [balls] F */
    fl_vec3 *equilibrium;    /* [balls] displacement at the start */
    fl_member_modes modes;   /* n = 0 without damping */
    double *decay;           /* [modes + 1] exp(-c dt/2) - 1; the last is of the rest */
    double ratio;            /* zeta */
    double largest_omega;    /* bound, of the chain [1/s] */
    double dt;               /* [s] */
    int substeps;            /* in dt */
    double energy_at_start;  /* of strain and loads in equilibrium */
    double damped;           /* energy that damping has removed */
    double plastic_at_start; /* dissipated by yielding in the equilibrium of the start */
    int32_t ruptured;        /* pieces that have ruptured */
    int over_rotated;        /* a piece is turned by more than FL_MEMBER_ROTATION_MAX */
} fl_member_dynamics;

/* Makes the chain of a model, at rest in equilibrium under its loads. -1 with FL_INPUT: a mechanism, no mass,
 * an imposed displacement, loads beyond a limit load; FL_SYSTEM, FL_NUMERIC. */
int fl_member_dynamics_make(fl_member_dynamics *d, const fl_member_model *m, double ratio, fl_err *err);
void fl_member_dynamics_free(fl_member_dynamics *d); /* accepts a zeroed struct, leaves one */

/* Sets substeps and damping for steps of dt. */
void fl_member_dynamics_set_step(fl_member_dynamics *d, double dt);

/* Damping and kick of half a step by force and moment. */
void fl_member_dynamics_damp(fl_member_dynamics *d);
void fl_member_dynamics_kick(fl_member_dynamics *d, double h);

/* The substeps of dt. */
void fl_member_dynamics_drift(fl_member_dynamics *d);

/* Energy of strain and of the loads P, 0 at the start; energy of motion. */
double fl_member_dynamics_energy(const fl_member_dynamics *d);
double fl_member_dynamics_kinetic(const fl_member_dynamics *d);

/* Evaluates the internal forces of the present state; needed after a state was read. */
void fl_member_dynamics_refresh(fl_member_dynamics *d);

/* Acceleration of a ball by all forces and by damping. */
fl_vec3 fl_member_dynamics_acceleration(const fl_member_dynamics *d, int32_t ball);

/* Section forces at the middle of a piece, along its axes: (N, Qy, Qz), N positive in tension, and (T, My,
 * Mz). On the cut with the outward normal e1 they are force and moment that the far part exerts. */
void fl_member_section_forces(const fl_member_chain *c, int32_t contact, fl_vec3 *force, fl_vec3 *moment);

#endif
