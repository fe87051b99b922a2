/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_motion.h -- the cylinders of a structure of members, which ice meets, and the chain that carries
 * them.
 *
 * A member whose section has a radius has one cylinder from end to end, or as many of equal length as its
 * word `cylinders` says. A cylinder is rigid: it rides on one piece of the chain, that of its range which
 * is nearest to the surface of the water, or at its middle where no piece reaches it. With the ends x_i and
 * x_j of that piece, at its balls i and j or on arms that turn with them,
 *     c = (x_i + x_j)/2,    e = (x_j - x_i)/l,
 * the cylinder keeps its place in the axes of the piece, turned so that the first is along e. A force F and a
 * torque T about c go to the balls as what moves c and e does,
 *     on i: F/2 + e x T/l,    on j: F/2 - e x T/l,
 * with the moment of an arm about its ball, and the torque along e as moments, half to each ball that
 * transmits moments; a bar takes none. Velocities are v = (v_i + v_j)/2 and w = e x (v_j - v_i)/l +
 * e (e.w_ball), so that the work of ice on cylinder and chain is the same. Limits: a cylinder stays straight,
 * and ice far from its piece bends the chain as a couple would; nodes at the edges of the ice belt, or more
 * cylinders, bring it nearer. */
#ifndef FL_STRUCTURE_MEMBER_MOTION_H
#define FL_STRUCTURE_MEMBER_MOTION_H
#include "geom/surface.h"
#include "member/member_dynamics.h"

/* A cylinder and the piece that carries it. */
typedef struct {
    int32_t member, contact;
    fl_vec3 p0, p1; /* in the pose of the file [m] */
    double radius;  /* [m] */
    fl_vec3 arm;    /* from c to p0, in the axes of the piece at the start [m] */
    fl_quat turn;   /* axes of the cylinder in those of the piece at the start */
} fl_member_cylinder;

typedef struct {
    const fl_member_model *model; /* borrowed */
    fl_member_dynamics dynamics;
    int32_t cylinders;
    fl_member_cylinder *cylinder; /* part by part, member by member */
    int32_t *watched;             /* [parts] ball whose motion is that of the part: its highest free node */
    double *contact_stiffness;    /* [balls] of the contacts at cylinders that use the ball [N/m] */
} fl_member_motion;

/* Makes a surface of the parts and the cylinders of their members. waterline: height at which the piece of a
 * cylinder is chosen [m]. -1 with FL_INPUT (no section has a radius) or FL_SYSTEM. */
int fl_member_motion_surface(fl_surface *s, const fl_member_model *m, double waterline, fl_err *err);

/* Makes a surface of the pieces of the chain, a part with a cylinder each, in the order of the contacts, for
 * animations. thin: radius of pieces whose section has none, 0 for no cylinder. */
int fl_member_motion_frames_surface(fl_surface *s, const fl_member_model *m, double thin, fl_err *err);

int fl_member_motion_make(fl_member_motion *v, const fl_member_model *m, double waterline, double ratio,
                          fl_err *err);
void fl_member_motion_free(fl_member_motion *v); /* accepts a zeroed struct, leaves one */

/* Place of the first end of cylinder k and its axes, the third along it, from those at the start, q0. */
void fl_member_motion_pose(const fl_member_motion *v, int32_t k, fl_vec3 *x, fl_quat *q);

/* Pose change of piece `contact` of the chain: a point p of the file is at x + R(q) p. */
void fl_member_motion_chain_pose(const fl_member_chain *c, int32_t contact, fl_vec3 *x, fl_quat *q);
void fl_member_motion_piece_pose(const fl_member_motion *v, int32_t contact, fl_vec3 *x, fl_quat *q);

/* Velocity of point x of cylinder k, and angular velocity, from velocities of the balls. */
void fl_member_motion_velocity(const fl_member_motion *v, int32_t k, fl_vec3 x, fl_vec3 *speed,
                               fl_vec3 *spin);

/* Acceleration and angular acceleration at x by the forces on the balls alone. */
void fl_member_motion_acceleration(const fl_member_motion *v, int32_t k, fl_vec3 x, fl_vec3 *a,
                                   fl_vec3 *turn);

/* Sets the forces on the balls to 0; adds force f at x and torque t about x on cylinder k. */
void fl_member_motion_clear(fl_member_motion *v);
void fl_member_motion_load(fl_member_motion *v, int32_t k, fl_vec3 x, fl_vec3 f, fl_vec3 t);

/* Middle of the piece that carries cylinder k, c. */
fl_vec3 fl_member_motion_middle(const fl_member_motion *v, int32_t k);

/* Inverse mass of cylinder k for a force at distance `arm` from the middle of its piece [1/kg]. */
double fl_member_motion_compliance(const fl_member_motion *v, int32_t k, double arm);

#endif
