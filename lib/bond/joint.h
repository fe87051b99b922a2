/* SPDX-License-Identifier: GPL-3.0-or-later */
/* joint.h -- a joint of rock: two faces that touch over an area that changes with their motion.
 *
 * A joint is a bonded face (bond.h) with stiffness per area, the same 3 x 3 points and the same kinematics,
 * and with three differences.
 *
 * Area.  The common part of the two faces is clipped in the mid-plane as they move, and the tractions act on
 * its present area A_c.  Points are laid on it by its second moments.  They are laid anew when A_c has
 * changed by 2 %, or the sides have moved over each other by 2 % of the smaller half side: shear stress,
 * offset and slip go over as linear fields by least squares, strength and direction from the nearest point.
 * So a small block on a long bed keeps its area, and off the edge the area falls to 0.
 *
 * Three points across are exact for a closed face; one that opens from an edge is stiffer than a bed of
 * springs.  A block of width b and height h topples where its middle point opens, at
 * tan a = b/h - 12 N/(k_n b^2), N per length of the edge, in place of
 * (2/h)(b/2 - 1.5 (2 h N/(9 k_n))^(1/3)).  Both tend to b/h as k_n grows.
 *
 * Law.  A point has a law of joint_law.h.  It may fail and close again any number of times.
 *
 * End.  The joint ends where nothing is left of the common part, or the faces have turned by 60 degrees.  Its
 * bodies are then a pair like any other.
 *
 * Energy: work of the tractions over a step, mean of both ends times the separation, less the change of the
 * stored energy.  What slip loses goes to friction, the rest (drops of strength, area that comes or goes, new
 * points) to `dissipated` of the bond.  Water pressure has the potential -p A s_n, part of the stored energy.
 * */
#ifndef FL_BOND_JOINT_H
#define FL_BOND_JOINT_H
#include "bond/bond.h"
#include "bond/joint_law.h"

typedef struct {
    int32_t material; /* index of its fl_joint_material */
    int32_t first, ni,
        nj; /* corners first .. first + ni of the face of i, then nj of that of j, in the pool */
    int32_t slips, opens; /* numbers of points that slip, that are open, at the last evaluation */
    double laid_area;     /* A_c when the points were laid [m2] */
    double clipped[2];    /* slip of the centre when A_c was clipped, from where the points were laid [m] */
    double friction_loss; /* by slip so far [J] */
    double sigma[FL_BOND_POINTS]; /* normal traction with water at the last evaluation [Pa] */
    fl_joint_point point[FL_BOND_POINTS];
} fl_joint;

/* Where a joint finds its corners and law. */
typedef struct {
    const fl_vec3 *corner; /* counter-clockwise from outside, frames of the bodies [m] */
    const fl_joint_material *material;
} fl_joint_pool;

/* Corners in 2 faces of a joint, at most. */
enum { FL_JOINT_CORNERS = 128 };

/* Lays the points on the common part of the two faces at the present poses and starts them with the stress
 * tensor S (xx yy zz xy yz zx, compression positive [Pa]).  c has i, j, ni, nj of its faces set.
 * Returns 1, or 0 if the faces have no common part. */
int fl_joint_start(fl_bond *c, fl_joint *q, fl_joint_pool pool, const fl_bodies *b, fl_vec3 way,
                   const double S[6]);

/* As fl_bond_force(). */
int fl_joint_force(fl_bond *c, fl_joint *q, fl_joint_pool pool, const fl_bodies *b, fl_vec3 way);

#endif
