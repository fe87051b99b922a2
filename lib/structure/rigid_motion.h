/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rigid_motion.h -- rigid things that carry pieces of a structure: moved as told, or by springs and what presses on
 * them.
 *
 * A mover is a point, the reference, and axes, those of the world in the pose of the file.  What is told is
 * the way d(t) of the reference, and for a mover without free directions a turn: a spin, or the rotation
 * vector of a track.  A mover with free directions obeys M y'' = F - K y - C y' ,     y = (x - x0 - d(t), s),
 * s = 2 (qx, qy, qz) of its quaternion, in those, M the mass and the inertia about the reference, which is
 * its centre of mass; the other directions follow what is told.  s is the rotation vector up to its third
 * power, and W = y.K y/2 a potential of the pose for turns of any size: with g = dW/ds the torque is -(qw g +
 * q x g), so that energy is kept without any transcendental function.  Weight and buoyancy at rest are in
 * balance, and only what changes acts.
 *
 * A step is symmetric: dampers h, kick h by forces and springs, drift dt, kick h, dampers h, h = dt/2.  Kick
 * and drift are those of a floe, so that two-way coupling keeps momentum to rounding; dampers are solved
 * exactly, v <- vd + (v - vd) exp(-c h/m)   along x y z,     L <- L exp(-c h/I)   about its own axes, stable
 * and monotone for any c and h.  Springs are kicks: order 2, symplectic, stable for omega dt < 2. */
#ifndef FL_STRUCTURE_RIGID_MOTION_H
#define FL_STRUCTURE_RIGID_MOTION_H
#include "body/body.h"
#include "structure/prescribed_track.h"

/* What a mover is. */
typedef struct {
    fl_vec3 reference;      /* in the pose of the file [m] */
    fl_vec3 velocity, spin; /* told, where there is no track [m/s], [rad/s] */
    fl_track track;         /* n = 0: none */
    unsigned free_dof;      /* FL_DOF_X | ...: directions left to forces; 0: all is told */
    double mass;            /* [kg] */
    fl_vec3 inertia;        /* [kg m2] */
    double K[6][6];         /* symmetric, x y z rx ry rz */
    fl_vec3 c, ct;          /* dashpots along x y z [N s/m], about the own axes [N m s] */
} fl_rigid_motion;

typedef struct {
    int32_t n, cap;
    fl_rigid_motion *motion; /* [n] owned, with their tracks */
    fl_bodies b;             /* [n] pose, velocity, forces; mass 0 where all is told */
    /* [n] each */
    fl_vec3 *prescribed,
        *prescribed_velocity;              /* d(t), and its velocity over the step in progress [m], [m/s] */
    fl_vec3 *spring_force, *spring_torque; /* force and torque of K, of the last evaluation [N], [N m] */
    double *spring_energy;                 /* y.K y/2 [J] */
    double *damper_loss;                   /* taken out by dampers so far [J] */
    double *prescribed_work;        /* put in so far by what is told of a mover with free directions [J] */
    fl_vec3 *decay, *angular_decay; /* exp(-c h/m) of half a step, fl_rigid_motions_set_step() */
} fl_rigid_motions;

/* Add one: m is taken over.  Index, or -1 with FL_SYSTEM. */
int32_t fl_rigid_motions_add(fl_rigid_motions *v, fl_rigid_motion *m, fl_err *err);

/* All movers added: arrays, and the pose and velocity of time t.  No track of a mover with free directions
 * turns.  -1 with FL_SYSTEM. */
int fl_rigid_motions_start(fl_rigid_motions *v, double t, fl_err *err);

/* The factors of the dampers for a step of dt.  Cannot fail. */
void fl_rigid_motions_set_step(fl_rigid_motions *v, double dt);

/* From t to t + dt: dampers h, kick h, drift dt.  v and w are those of the middle of the step then. */
void fl_rigid_motion_first_half(fl_rigid_motions *v, int32_t k, double t, double dt);

/* Springs at the pose of now: adds to b.f and b.t, which hold what presses on it. */
void fl_rigid_motion_add_springs(fl_rigid_motions *v, int32_t k);

/* Kick h; told velocities become those of time t. */
void fl_rigid_motion_second_kick(fl_rigid_motions *v, int32_t k, double t, double h);

/* Dampers h. */
void fl_rigid_motion_damp(fl_rigid_motions *v, int32_t k);

/* Kinetic energy of a mover with free directions, 0 of one that is told [J]. */
double fl_rigid_motion_kinetic_energy(const fl_rigid_motions *v, int32_t k);

/* Acceleration of the reference and of the turn at time t, of the forces in b.f and b.t and of the dampers,
 * or as it is told [m/s2], [rad/s2]. */
void fl_rigid_motion_acceleration(const fl_rigid_motions *v, int32_t k, double t, fl_vec3 *a, fl_vec3 *turn);

/* A bound of omega^2 of its springs by the rows of M^-1/2 K M^-1/2 [1/s2], and of the compliance of a point
 * at distance arm, 1/m + arm^2/I [1/kg]; 0 and 0 where all is told. */
double fl_rigid_motion_max_omega2(const fl_rigid_motion *m);
double fl_rigid_motion_compliance(const fl_rigid_motion *m, double arm);

/* Accepts a zeroed struct and leaves one. */
void fl_rigid_motions_free(fl_rigid_motions *v);

#endif
