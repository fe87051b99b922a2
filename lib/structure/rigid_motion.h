/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rigid_motion.h -- rigid bodies that carry pieces of a structure: prescribed motion, or springs and dampers
 * under the contact forces.
 *
 * A mover is a reference point with axes, those of the world in the pose of the file. Prescribed is the
 * displacement d(t) of the reference, and for a mover without free directions also the rotation: an angular
 * velocity, or the rotation vector of a track. In its free directions a mover obeys
 *     M y'' = F - K y - C y',     y = (x - x0 - d(t), s),     s = 2 (qx, qy, qz) of its quaternion,
 * with M the mass and the inertia about the reference, its centre of mass. The other directions follow the
 * prescribed motion. s is the rotation vector up to its third power, and W = y.K y/2 is a potential of the
 * pose for rotations of any size: with g = dW/ds the torque is -(qw g + q x g). So energy is conserved
 * without transcendental functions. Weight and buoyancy at rest are in balance; only changes act.
 *
 * Or a mover has modes (modal_motion.h): then its reference has the displacement of their sum, it does not
 * rotate, and M, K and C are not used.
 *
 * In waves a mover may have a hull (water/floating_hull.h), whose load is one more force, with a drag; added
 * mass is along its own axes.
 *
 * A step is symmetric: dampers h, kick h by forces and springs, drift dt, kick h, dampers h, h = dt/2. Kick
 * and drift are those of a floe, so that two-way coupling conserves momentum to rounding. Dampers are exact,
 *     v <- vd + (v - vd) exp(-c h/m)   along x y z,     L <- L exp(-c h/I)   about the own axes,
 * stable and monotone for any c and h. Springs are kicks: order 2, symplectic, stable for omega dt < 2. */
#ifndef FL_STRUCTURE_RIGID_MOTION_H
#define FL_STRUCTURE_RIGID_MOTION_H
#include "body/body.h"
#include "structure/modal_motion.h"
#include "structure/prescribed_track.h"
#include "water/floating_hull.h"

/* Parameters of a mover. */
typedef struct {
    fl_vec3 reference;      /* in the pose of the file [m] */
    fl_vec3 velocity, spin; /* prescribed, without a track [m/s], [rad/s] */
    fl_track track;         /* n = 0: none */
    unsigned free_dof;      /* FL_DOF_X | ...: free directions; 0: all is prescribed */
    double mass;            /* [kg]; with modes that of their compliance, 1/fl_modes_compliance() */
    fl_vec3 inertia;        /* [kg m2] */
    double K[6][6];         /* symmetric, x y z rx ry rz */
    double water_K[6][6];   /* hydrostatic stiffness that hulls hold, not in K */
    fl_vec3 added_mass;     /* [kg] */
    fl_vec3 c, ct;          /* dashpots along x y z [N s/m], about the own axes [N m s] */
    int32_t modes;          /* 0: none */
    fl_modal_dof *mode;     /* [modes] owned, with their state */
} fl_rigid_motion;

typedef struct {
    int32_t n, cap;
    fl_rigid_motion *motion; /* [n] owned, with their tracks */
    fl_bodies b;             /* [n] pose, velocity, forces; mass 0 if all is prescribed */
    /* [n] each */
    fl_vec3 *prescribed, *prescribed_velocity; /* d(t), and its velocity over the present step [m], [m/s] */
    fl_vec3 *spring_force, *spring_torque;     /* force and torque of K at the last evaluation [N], [N m] */
    double *spring_energy;                     /* y.K y/2 [J] */
    double *damper_loss;                       /* energy removed by dampers so far [J] */
    /* work of the prescribed part of movers with free directions so far [J] */
    double *prescribed_work;
    fl_vec3 *decay, *angular_decay; /* exp(-c h/m) of half a step, by fl_rigid_motions_set_step() */
    fl_floating_hulls hulls;        /* waves on movers; n = 0: none */
} fl_rigid_motions;

/* Adds a mover; m is taken over. Returns its index, or -1 with FL_SYSTEM. */
int32_t fl_rigid_motions_add(fl_rigid_motions *v, fl_rigid_motion *m, fl_err *err);

/* Call after all movers are added: allocates arrays, sets pose and velocity of time t. No track of a mover
 * with free directions rotates. Returns -1 with FL_SYSTEM. */
int fl_rigid_motions_start(fl_rigid_motions *v, double t, fl_err *err);

/* Sets the decay factors of the dampers for a step of dt. Cannot fail. */
void fl_rigid_motions_set_step(fl_rigid_motions *v, double dt);

/* From t to t + dt: dampers h, kick h, drift dt. Then v and w are those of the middle of the step. */
void fl_rigid_motion_first_half(fl_rigid_motions *v, int32_t k, double t, double dt);

/* Adds the springs and then the water at the present pose to b.f and b.t, which hold the contact forces. */
void fl_rigid_motion_add_springs(fl_rigid_motions *v, int32_t k);

/* Kick h; prescribed velocities become those of time t. */
void fl_rigid_motion_second_kick(fl_rigid_motions *v, int32_t k, double t, double h);

/* Dampers over half a step, then the drag of the water over h seconds. */
void fl_rigid_motion_damp(fl_rigid_motions *v, int32_t k, double h);

/* Energy of its springs, and what its dampers have removed so far [J]. */
double fl_rigid_motion_spring_energy(const fl_rigid_motions *v, int32_t k);
double fl_rigid_motion_damper_loss(const fl_rigid_motions *v, int32_t k);

/* Kinetic energy of a mover with free directions, 0 of a prescribed one [J]. */
double fl_rigid_motion_kinetic_energy(const fl_rigid_motions *v, int32_t k);

/* Acceleration of the reference and of the rotation at time t, by the forces in b.f and b.t and the dampers,
 * or as prescribed [m/s2], [rad/s2]. */
void fl_rigid_motion_acceleration(const fl_rigid_motions *v, int32_t k, double t, fl_vec3 *a, fl_vec3 *turn);

/* Bound of omega^2 of the springs by the rows of M^-1/2 K M^-1/2 [1/s2], and compliance of a point at
 * distance arm, 1/m + arm^2/I [1/kg]; 0 if all is prescribed. */
double fl_rigid_motion_max_omega2(const fl_rigid_motion *m);
double fl_rigid_motion_compliance(const fl_rigid_motion *m, double arm);

/* Accepts a zeroed struct and leaves one. */
void fl_rigid_motions_free(fl_rigid_motions *v);

#endif
