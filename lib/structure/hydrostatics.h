/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hydrostatics.h -- hydrostatic stiffness of a floating hull, exact, from its closed mesh.
 *
 * Let S be the wet part of the surface, z <= 0 at still water, and n outward. By the divergence theorem,
 * integrals over the body and over its water plane become integrals over S, since the fields (0, 0, z), (0,
 * 0, x z), ... vanish on the water plane:
 *     V = int z nz,   V (xB, yB) = int (x, y) z nz,   V zB = int z^2/2 nz,
 *     int_A f(x, y) dA = - int f nz,                  each over S.
 * A triangle is cut at the water plane and integrated exactly; no section is traced. */
#ifndef FL_STRUCTURE_HYDROSTATICS_H
#define FL_STRUCTURE_HYDROSTATICS_H
#include "geom/surface.h"

typedef struct {
    double volume;           /* displaced [m3] */
    fl_vec3 buoyancy_centre; /* centre of buoyancy, about the reference as all below [m] */
    double area;             /* of the water plane [m2] */
    double x, y, xx, yy, xy; /* its moments: int x dA, ... [m3], [m4] */
} fl_hydrostatics;

/* Adds a part to f, which starts zeroed; end with fl_hydrostatics_finish().
 *   level      z of the water [m]
 *   reference  origin of the positions [m]
 * Returns -1 with FL_INPUT if the triangles do not close or the part has cones, or FL_SYSTEM. */
int fl_hydrostatics_add(fl_hydrostatics *f, const fl_part *p, double level, fl_vec3 reference, fl_err *err);

/* Turns integrals into centres. Returns -1 with FL_INPUT if nothing is under water or the mesh is inside out.
 */
int fl_hydrostatics_finish(fl_hydrostatics *f, double level, fl_vec3 reference, fl_err *err);

/* Adds the stiffness matrix about the reference, the centre of mass, of a hull of mass rho V to K:
 *     C33 = w A,  C34 = w int y,  C35 = -w int x,  C45 = -w int xy,
 *     C44 = w (int y^2 + V zB),  C55 = w (int x^2 + V zB),         w = rho g.
 * Source: Faltinsen, Sea Loads on Ships and Offshore Structures (1990), (3.20). */
void fl_hydrostatics_stiffness(const fl_hydrostatics *f, double weight, double K[6][6]);

#endif
