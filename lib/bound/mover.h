/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mover.h -- rigid things that carry pieces of a structure: moved as told, or by springs and what presses on
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
#ifndef FL_BOUND_MOVER_H
#define FL_BOUND_MOVER_H
#include "body/body.h"
#include "bound/track.h"

/* What a mover is. */
typedef struct {
    fl_vec3 reference;      /* in the pose of the file [m] */
    fl_vec3 velocity, spin; /* told, where there is no track [m/s], [rad/s] */
    fl_track track;         /* n = 0: none */
    unsigned free;          /* FL_HOLD_X | ...: directions left to forces; 0: all is told */
    double mass;            /* [kg] */
    fl_vec3 inertia;        /* [kg m2] */
    double K[6][6];         /* symmetric, x y z rx ry rz */
    fl_vec3 c, ct;          /* dashpots along x y z [N s/m], about the own axes [N m s] */
} fl_motion;

typedef struct {
    int32_t n, cap;
    fl_motion *motion; /* [n] owned, with their tracks */
    fl_bodies b;       /* [n] pose, velocity, forces; mass 0 where all is told */
    /* [n] each */
    fl_vec3 *anchor, *pull;    /* d(t), and its velocity over the step in progress [m], [m/s] */
    fl_vec3 *spring, *twist;   /* force and torque of K, of the last evaluation [N], [N m] */
    double *stored;            /* y.K y/2 [J] */
    double *damped;            /* taken out by dampers so far [J] */
    double *given;             /* put in so far by what is told of a mover with free directions [J] */
    fl_vec3 *fade, *fade_turn; /* exp(-c h/m) of half a step, fl_movers_ready() */
} fl_movers;

/* Add one: m is taken over.  Index, or -1 with FL_SYSTEM. */
int32_t fl_movers_add(fl_movers *v, fl_motion *m, fl_err *err);

/* All movers added: arrays, and the pose and velocity of time t.  No track of a mover with free directions
 * turns.  -1 with FL_SYSTEM. */
int fl_movers_start(fl_movers *v, double t, fl_err *err);

/* The factors of the dampers for a step of dt.  Cannot fail. */
void fl_movers_ready(fl_movers *v, double dt);

/* From t to t + dt: dampers h, kick h, drift dt.  v and w are those of the middle of the step then. */
void fl_mover_out(fl_movers *v, int32_t k, double t, double dt);

/* Springs at the pose of now: adds to b.f and b.t, which hold what presses on it. */
void fl_mover_pull(fl_movers *v, int32_t k);

/* Kick h; told velocities become those of time t. */
void fl_mover_back(fl_movers *v, int32_t k, double t, double h);

/* Dampers h. */
void fl_mover_damp(fl_movers *v, int32_t k);

/* Kinetic energy of a mover with free directions, 0 of one that is told [J]. */
double fl_mover_kinetic(const fl_movers *v, int32_t k);

/* Acceleration of the reference and of the turn at time t, of the forces in b.f and b.t and of the dampers,
 * or as it is told [m/s2], [rad/s2]. */
void fl_mover_acceleration(const fl_movers *v, int32_t k, double t, fl_vec3 *a, fl_vec3 *turn);

/* A bound of omega^2 of its springs by the rows of M^-1/2 K M^-1/2 [1/s2], and of the compliance of a point
 * at distance arm, 1/m + arm^2/I [1/kg]; 0 and 0 where all is told. */
double fl_motion_stiff(const fl_motion *m);
double fl_motion_soft(const fl_motion *m, double arm);

/* Accepts a zeroed struct and leaves one. */
void fl_movers_free(fl_movers *v);

#endif
