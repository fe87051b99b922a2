/* SPDX-License-Identifier: GPL-3.0-or-later */
/* area_vector.h -- the nominal area of a contact: the area vector of the other body's surface inside a floe.
 *
 *     S = int n dA over the surface of B inside the outer sharp shape of A
 *
 * V being the volume of the overlap, dV = S.dx for a displacement dx of A, so int p dV is the work of a
 * pressure p on it, and S depends neither on how B is divided into faces nor on what A looks like elsewhere.
 * The faces of B are clipped by the half-spaces of A (Sutherland, Hodgman 1974); cones: cone_area.h.
 *
 * Limits.  All faces of B count, also where they form several separate contacts with A, of which each alone
 * would be stronger by 2^e (pressure_area.h).  The end discs of a cone do not count. */
#ifndef FL_FAILURE_AREA_VECTOR_H
#define FL_FAILURE_AREA_VECTOR_H
#include "failure/half_spaces.h"
#include "structure/structure.h"

/* S of a piece of the structure in its own frame: of the part of its surface that faces `facing`, of all of
 * it if that is 0.  When a moves along -facing, S.facing is what crushes: behind a pile is the channel that
 * it has left. */
fl_vec3 fl_area_vector_of_piece(const fl_half_spaces *a, const fl_piece *piece, fl_vec3 facing);

/* 1 if the piece goes through a: its surface inside a is there and closed but for a part along `across`, the
 * direction of the thickness of a, so that no push of a sideways is resisted; 0 on a floor.
 * A mesh that goes through a at one place and ends in it at another is not found. */
int fl_area_is_closed(const fl_half_spaces *a, const fl_piece *piece, fl_vec3 across);

/* S of what faces `facing`, a unit vector, of another convex body, in one frame. */
fl_vec3 fl_area_vector_of_body(const fl_half_spaces *a, const fl_half_spaces *b, fl_vec3 facing);

#endif
