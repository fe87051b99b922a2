/* SPDX-License-Identifier: GPL-3.0-or-later */
/* buoyancy.h -- hydrostatics of one body in still water: submerged volume, wetted surface, water plane.
 *
 * All is in body axes about the body's origin, its centre of mass. There the water plane is up.x = level: up
 * is the world's z axis in body axes, transpose(R) e_z, and level the height of the water above the origin
 * [m]. So no vertex is rotated, and no digits are lost far from the origin of the world.
 *
 * A polyhedron is the sum of cones from its wetted faces to one apex a on the water plane, inside the body:
 *     V      = 1/3 sum_f A_f h_f,             h_f = c_f - n_f.a >= 0
 *     V x_B  = 1/3 sum_f A_f h_f (a + 3/4 (g_f - a))
 * with A_f and g_f area and centroid of the wetted part of face f. The water plane section contains the apex,
 * so its cone has no volume and is never built. All terms are positive, so nothing cancels. The area of the
 * section follows from sum A n = 0 over a closed surface:
 *     A_w    = - sum_f A_f (n_f.up)
 * A right prism that floats with both caps clear of the water has closed formulae (prism_buoyancy.h). Source:
 * the divergence theorem. */
#ifndef FL_WATER_BUOYANCY_H
#define FL_WATER_BUOYANCY_H
#include "geom/mass.h"
#include "geom/poly.h"
#include "water/prism_buoyancy.h"
#include "water/submerged.h"

/* A shape that can float; read-only after fl_hull_make(). */
typedef struct {
    const fl_poly *shape; /* borrowed; origin at the body's centre of mass [m] */
    /* of a sphere or capsule (shape->nv <= 2); after fl_hull_borrow_core() the offset of the floating shape's
     * faces from those of shape; else 0 [m] */
    double radius;
    double volume;       /* total [m^3] */
    fl_vec3 centre;      /* centroid [m] */
    double surface_area; /* total [m^2] */
    /* [4 nf] area of each face, then 3 numbers of each centroid; NULL for a sphere or capsule and after
     * fl_hull_borrow_core() [m^2], [m] */
    double *face_area;
    double fill;    /* of a sphere: the volume it stands for over its own, fl_hull_fill(); else 1 */
    fl_prism prism; /* the shape as a right prism, if it is one */
} fl_hull;

/* [nf] centroids of the faces [m]. */
static inline fl_vec3 *fl_hull_face_centroids(const fl_hull *h)
{
    return (fl_vec3 *)(void *)(h->face_area + h->shape->nf);
}

/* Makes a hull from a solid (its sharp surface floats, radius is unused), a sphere (nv = 1) or a capsule (nv
 * = 2), both with radius > 0. Returns 0; or -1 and h untouched, with FL_INPUT (a flat polygon; a sphere or
 * capsule without radius) or FL_SYSTEM. */
int fl_hull_make(fl_hull *h, const fl_poly *p, double radius, fl_err *err);
/* Multiplies volume, wetted surface and water plane of a sphere. */
void fl_hull_fill(fl_hull *h, double fill);
void fl_hull_free(fl_hull *h); /* accepts a zeroed struct, leaves one */

/* Lets the hull of a right prism compute its corners from a core whose faces lie r further in: a corner of
 * the core is moved by
 *     r (n_cap + (n_1 + n_2) / (1 + n_1.n_2)),
 * n_1 and n_2 being the normals of its two sides. h then borrows core instead of its shape, which may be
 * freed. Returns 1; or 0 and h unchanged, if the faces of the two differ, if there are more than 64 corners,
 * or if a corner would be off by more than 1e-12 of the size. */
int fl_hull_borrow_core(fl_hull *h, const fl_poly *core, double r);

/* Submerged part of the hull below up.x = level.
 *   up      unit vector, the world's z in body axes
 *   level   height of the water above the body's origin   [m]
 * Wholly dry and wholly wet hulls return at once. A solid is exact to rounding. V and x_B are continuous in
 * up and level, also where the plane contains a vertex, an edge or a face; wetted_area jumps only where a
 * whole face submerges at once. A sphere is the exact cap. A capsule is two half balls in closed form and a
 * cylinder by a quadrature with an error of rounding only, 1e-12 of the whole. Cannot fail, allocates
 * nothing. */
void fl_hull_submerged(const fl_hull *h, fl_vec3 up, double level, fl_submerged *wet);

/* Water plane of a solid: area, centroid c, and the tensor T = int (x - c)(x - c)^T dA. Tilting about a
 * horizontal axis has the second moment I = t.T t, t being the horizontal unit vector normal to that axis:
 * the metacentre is I / V above the centre of buoyancy. Zero for a body wholly dry or wet. */
typedef struct {
    double area;    /* [m^2] */
    fl_vec3 centre; /* body axes [m] */
    fl_mat3 second; /* body axes [m^4] */
} fl_waterplane;
void fl_hull_waterplane(const fl_hull *h, fl_vec3 up, double level, fl_waterplane *w);

/* Buoyancy force and moment about the origin, in body axes, and the energy of the displaced water,
 *     F = rho g V up,   M = x_B x F,   U = -rho g V z_B,   z_B = up.x_B - level <= 0.
 * F and M are the exact gradient of -U. Raising the body by dz raises every wet point, and points enter or
 * leave at z = 0, so d(int z dV) = V dz. Turning it by dphi moves the points by dphi x x, so d(int z dV) = V
 * up.(dphi x x_B) = dphi.(x_B x V up).
 *   weight   rho g of the water   [N/m^3]
 * force [N], moment [N m]; returns U [J]. */
double fl_buoyancy_force(const fl_submerged *wet, fl_vec3 up, double level, double weight, fl_vec3 *force,
                         fl_vec3 *moment);

#endif
