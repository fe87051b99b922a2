/* SPDX-License-Identifier: GPL-3.0-or-later */
/* facet_drag.h -- drag on each part of the wetted (or the dry) surface of a solid.
 *
 * A piece of surface of area a and outward normal n that goes with u through the fluid feels
 *     skin   -1/2 rho C_s a |u_t| u_t,          u_t = u - (u.n) n
 *     form   -1/2 rho C_f a (u.n)^2 n           where it goes ahead, u.n > 0
 * together -D(u) u with D = 1/2 rho a (C_s |u_t| (1 - n n^T) + C_f max(u.n, 0) n n^T), which is symmetric and
 * never negative.  With y = (v, w) of the body, u = J y - U at each piece, J y = v + w x r,
 *     M dy/dt = - sum J^T D(u) (J y - U).
 * The step is implicit in y and frozen in D:
 *     (M + h K) y' = M y + h sum J^T D U,   K = sum J^T D J.
 * K is positive semidefinite, so for any h and any coefficient the kinetic energy seen from the fluid falls
 * and no motion along one direction turns round; and where one speed counts, y' = y / (1 + h kappa |y|), it
 * is the exact decay.  That is the reason for it: an explicit step would throw thin floes back, an exact one
 * there is not, and a symmetric one (Crank and Nicolson) does not keep the sign.  Order 1 where several
 * directions meet, exact along one.  Source: Hoerner, Fluid-Dynamic Drag (1965), for the two parts; the step
 * is derived here. */
#ifndef FL_WATER_FACET_DRAG_H
#define FL_WATER_FACET_DRAG_H
#include "water/buoyancy.h"

/* A piece of surface, in the body's axes. */
typedef struct {
    double area;  /* [m2]  */
    fl_vec3 n, r; /* outward normal; place from the centre of mass [m] */
    fl_vec3 flow; /* velocity U of the fluid there, seen as v is seen [m/s] */
} fl_skin_piece;

/* How many pieces a hull can have: three for each corner of a face and two more corners. */
int32_t fl_skin_most(const fl_hull *h);

/* The pieces of the surface below the plane up.x = level (above it with dry): each face, or what is left of
 * it, is a fan of triangles about its centroid, with a piece at the middle of each of their sides; exact for
 * what is quadratic in place.  Leaves flow alone.
 *   out   [fl_skin_most()]
 * Returns their number. */
int32_t fl_skin_pieces(const fl_hull *h, fl_vec3 up, double level, int dry, fl_skin_piece *out);

/* One step h of the decay above.
 *   n, piece       the pieces
 *   skin, form     1/2 rho C_s, 1/2 rho C_f   [kg/m3]
 *   mass, inertia  of the body along and about its axes, with the water it moves [kg], [kg m2]
 *   v, w           in, out: velocity and angular velocity, body axes [m/s], [rad/s] */
void fl_facet_drag(int32_t n, const fl_skin_piece *piece, double skin, double form, fl_vec3 mass,
                   fl_vec3 inertia, double h, fl_vec3 *v, fl_vec3 *w);

#endif
