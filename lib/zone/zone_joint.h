/* SPDX-License-Identifier: GPL-3.0-or-later */
/* zone_joint.h -- a joint with a deformable block on one or both sides: contact by points.
 *
 * The points lie on the triangles of one side, the deformable one or the one with the smaller face, and stay
 * there.  At the start these triangles are cut by those of the other side, and each piece is integrated by
 * three points, exact for products of linear fields: the meshes of the two faces need not match, and a block
 * under a constant stress has exactly that stress.  Parts that the other face does not cover get points as
 * well, which bear nothing until they come over it.
 *
 * A point at x_s is projected along the normal n onto the other side, which has x_m there:
 *     opening  n.(x_s - x_m),   slip  d(x_s - x_m) with the old place on the other side, along the joint
 * Its law is that of joint_law.h.  The force acts on both sides at the two places, on a rigid one as force
 * and torque; off the edge of the other face the point is open, so that the area falls point by point.
 *
 * Energy as in joint.h.  Dashpots work at the rates of the points; what they take is `damped`. */
#ifndef FL_ZONE_ZONE_JOINT_H
#define FL_ZONE_ZONE_JOINT_H
#include "bond/joint.h"
#include "zone/zone_set.h"

typedef struct {
    int32_t node[3];    /* of the side with the points */
    double share[3];    /* where in that triangle */
    int32_t triangle;   /* of the other side, -1: rigid */
    double other[3];    /* shares in that triangle; or the place in the frame of the rigid body [m] */
    double area;        /* [m2] */
    double opening;     /* at the last evaluation [m] */
    double sigma;       /* normal traction with water at the last evaluation [Pa] */
    fl_vec3 apart;      /* x_s - x_m there [m] */
    fl_vec3 force;      /* on the side with the points [N] */
    int32_t off;        /* 1: beside the other face */
    fl_joint_point law; /* state */
} fl_zone_point;

typedef struct {
    int32_t bond;        /* its record, with the sums */
    int32_t own, other;  /* block with the points; the other one, or -1 - its body if it is rigid */
    int32_t points_on_i; /* 1: they are on body i of the bond */
    int32_t point, point_end;
    int32_t triangle, triangle_end; /* of the other face, in `triangle` of the list */
    int32_t corner, corners;        /* of the other face in the pool, if it is rigid */
    fl_vec3 along, normal; /* in the frame of the other body: a direction of the joint, outward normal */
    double rate;           /* dashpots: stiffness times this time [s] */
    double damped;         /* [J] */
} fl_zone_joint;

typedef struct {
    int32_t n, points, triangles;
    fl_zone_joint *joint;
    fl_zone_point *point;
    int32_t *triangle;
    int32_t *first, *of; /* joints of each block: of[first[k] .. first[k + 1]) */
    double *area;        /* [nodes] scratch while joints are made [m2] */
    int32_t cap_joint, cap_point, cap_triangle;
} fl_zone_joint_list;

/* One side of a joint: its block (-1: rigid), body, face of the block, and corners in the frame of the
 * body. */
typedef struct {
    int32_t block, body, face, corner, corners;
    double area;
} fl_zone_side;

/* Makes the points of the joint c, q, whose bond is started (fl_joint_start()); S: stress at the start as
 * there; damping: fraction of the critical.  Adds stiffness to the nodes.  -1 with FL_SYSTEM. */
int fl_zone_joint_make(fl_zone_joint_list *l, fl_zone_set *s, fl_bond *c, fl_joint *q, fl_joint_pool pool,
                       const fl_bodies *b, int32_t bond, const fl_zone_side side[2], const double S[6],
                       double damping, fl_err *err);
/* The joints of each block, once all are there. */
int fl_zone_joint_list_finish(fl_zone_joint_list *l, const fl_zone_set *s, fl_err *err);
void fl_zone_joint_list_free(fl_zone_joint_list *l);

/* Forces of the points over a step of dt, and the sums of c and q.  Returns 1 if nothing bears any more. */
int fl_zone_joint_force(fl_zone_joint_list *l, int32_t k, const fl_zone_set *s, fl_bond *c, fl_joint *q,
                        fl_joint_pool pool, const fl_bodies *b, double dt);

/* Adds the forces of joint k to the nodes of a block. */
void fl_zone_joint_add(const fl_zone_joint_list *l, int32_t k, int32_t block, fl_zone_set *s);

#endif
