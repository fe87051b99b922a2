/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_side.h -- which side of a mesh a point is on whose nearest point is a corner of it.
 *
 * Let x be the point, q its nearest point, r = x - q. Where one or two planes meet in q, the plane that x is
 * farther from decides. Where more do, that fails: the deck over a raked bow has x deep under its plane, yet
 * x is in front of the stem. There the sum over the faces f that meet in q, each with its angle a_f at q,
 *
 *     N = sum_f a_f n_f
 *
 * decides: N.r > 0 in front, N.r < 0 behind (the sectors a_f n_f / 2 and the part of the unit ball in the
 * solid close a surface, so N.r is minus twice the integral of r.u over the directions u into the solid, of
 * which all have r.u <= 0 if x is outside, and no others have r.u > 0 if it is inside). If N.r is small, or q
 * is so near to a corner without being in it that the tolerance of the planes leaves open which faces meet
 * there, the winding number of a closed mesh decides,
 *
 *     w = (1 / 4 pi) sum_t Omega_t(x) ,   Omega_t the solid angle of triangle t,
 *
 * which takes all its faces. Sources: Baerentzen & Aanaes, IEEE TVCG 11 (2005) 243; van Oosterom & Strackee,
 * IEEE Trans. Biomed. Eng. 30 (1983) 125. */
#ifndef FL_STRUCTURE_MESH_SIDE_H
#define FL_STRUCTURE_MESH_SIDE_H
#include "structure/structure.h"

/* Positive if x is in front of the mesh, negative if behind.
 *   q    nearest point of the mesh, not on a rim   [m]
 *   tol  faces within this of q meet in it         [m] */
double fl_mesh_side(const fl_poly *p, const fl_piece_mesh *mesh, fl_vec3 x, fl_vec3 q, double tol);

/* Winding number of the mesh about x: 1 inside a closed surface with outward normals, -1 with inward ones. */
double fl_mesh_winding_number(const fl_poly *p, fl_vec3 x);

#endif
