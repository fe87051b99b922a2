/* SPDX-License-Identifier: GPL-3.0-or-later */
/* disc_types.h -- the numbers of a disc between two spheres; disc.h has their meaning. */
#ifndef FL_BOND_DISC_TYPES_H
#define FL_BOND_DISC_TYPES_H
#include <stdint.h>
#include "geom/vec3.h"

/* Strength and friction of all discs of a run. */
typedef struct {
    double tension, cohesion; /* sigma_t, c; INFINITY: unlimited [Pa] */
    double internal_friction; /* mu_i */
    double friction;          /* mu */
    double moment_factor;     /* beta */
} fl_disc_law;

/* Discs of one size and stiffness: consecutive doubles, which lanes load by their number. */
typedef struct {
    double length;      /* l [m] */
    double kn;          /* [N/m] */
    double shear_ratio; /* k_s/k_n = G/E */
    double radius;      /* R [m] */
    double share;       /* a */
    double damping;     /* h [s] */
    double weakening;   /* factor of both strengths */
    double ductility;   /* f */
} fl_disc_class;
enum { FL_DISC_CLASS_NUMBERS = 8 };

/* State of a disc, kept from step to step. */
typedef struct {
    fl_vec3 S, M;                             /* before damage [N], [N m] */
    double lambda;                            /* L; at most 1 while the disc is whole */
    fl_vec3 damping_force;                    /* of the last step [N] */
    fl_vec3 damping_couple;                   /* [N m] */
    double damped, dissipated, friction_loss; /* energy taken by dashpots, damage and friction so far [J] */
} fl_disc_memory;

/* Position and motion of the two spheres, relative to each other. */
typedef struct {
    fl_vec3 d;      /* from the centre of i to that of j [m] */
    fl_vec3 vi, vj; /* mean velocities of the step [m/s] */
    fl_vec3 wi, wj; /* [rad/s] */
} fl_disc_pose;

/* Force and couple on i, and the couple on j; the force on j is opposite to that on i. */
typedef struct {
    fl_vec3 force, couple_i, couple_j;
} fl_disc_wrench;

#endif
