/* SPDX-License-Identifier: GPL-3.0-or-later */
/* buoyancy.h -- what still water does to one body: submerged volume, wetted surface, water plane.
 *
 * Everything is computed in the body's own axes about its own origin (its centre of mass), where the water
 * plane is up.x = level: up is the world's z axis seen from the body, transpose(R) e_z, and level the height
 * of the water over the body's origin.  So no vertex is turned, and nothing is lost far from the world's.
 *
 * A polyhedron is the sum of cones over its wetted faces to one apex a on the water plane, inside the body:
 *     V      = 1/3 sum_f A_f h_f,             h_f = c_f - n_f.a >= 0
 *     V x_B  = 1/3 sum_f A_f h_f (a + 3/4 (g_f - a))
 * with A_f and g_f area and centroid of the wetted part of face f.  The cap that the water plane cuts holds
 * the apex, so its cone is flat and it is never built.  All terms are positive: nothing cancels.  Its area
 * follows from sum A n = 0 over a closed surface:
 *     A_w    = - sum_f A_f (n_f.up)
 * A right prism that floats with both caps clear of the water has closed formulae (prism_buoyancy.h).
 * Source: the divergence theorem. */
#ifndef FL_WATER_BUOYANCY_H
#define FL_WATER_BUOYANCY_H
#include "geom/mass.h"
#include "geom/poly.h"
#include "water/prism_buoyancy.h"

/* One shape that can float, read-only once made. */
typedef struct {
    const fl_poly *shape; /* borrowed; origin at the body's centre of mass [m] */
    double radius;  /* of a sphere or capsule (p->nv <= 2); how far the shape's faces stand out from those of
                       * p, after fl_hull_borrow_core(); else 0            [m] */
    double volume;  /* whole                                       [m^3] */
    fl_vec3 centre; /* its centroid                                  [m] */
    double surface_area; /* whole                                       [m^2] */
    double *
        face_area; /* [4 nf] area of each face, and 3 numbers each of its centroid; NULL of a sphere or capsule
                      * and after fl_hull_borrow_core()            [m^2], [m] */
    fl_prism prism; /* the same as a right prism, if it is one */
} fl_hull;

/* [nf] centroids of the faces [m]. */
static inline fl_vec3 *fl_hull_face_centroids(const fl_hull *h)
{
    return (fl_vec3 *)(void *)(h->face_area + h->shape->nf);
}

/* A solid (its sharp surface floats, radius is not used), or with radius > 0 a sphere (nv = 1) or a capsule
 * (nv = 2).  0, or -1 and h untouched, with FL_INPUT (a flat polygon; a sphere or capsule without radius) or
 * FL_SYSTEM. */
int fl_hull_make(fl_hull *h, const fl_poly *p, double radius, fl_err *err);
void fl_hull_free(fl_hull *h); /* accepts a zeroed struct, leaves one */

/* Let h, the hull of a right prism, know its corners from those of the core that it was made from by faces r
 * further out: a corner of the core is moved by
 *     r (n_cap + (n_1 + n_2) / (1 + n_1.n_2)),
 * n_1 and n_2 being the normals of its two sides.  h borrows core instead of its shape, which may go then.
 * Returns 1; or 0, and h is as it was, where the two are not alike in their faces, where there are more than
 * 64 corners, or where one of them would be off by more than 1e-12 of the size. */
int fl_hull_borrow_core(fl_hull *h, const fl_poly *core, double r);

/* The submerged part, in the body's axes. */
typedef struct fl_submerged {
    double volume;          /* V                                     [m^3] */
    fl_vec3 centre;         /* centre of buoyancy x_B; 0 when dry      [m] */
    double wetted_area;     /* wetted surface                        [m^2] */
    double waterplane_area; /* area of the cut                       [m^2] */
} fl_submerged;

/* Submerged part of the hull below up.x = level.
 *   up      unit vector, the world's z in body axes
 *   level   height of the water over the body's origin   [m]
 * Wholly dry and wholly wet hulls return at once.  A solid is exact to rounding and V, x_B are continuous in
 * up and level, also where the plane holds a vertex, an edge or a face; wetted steps only where a whole face
 * goes under at once.  A sphere is the exact cap; a capsule is two half balls in closed form and a cylinder
 * by quadrature that leaves rounding only: 1e-12 of the whole.
 * Cannot fail, allocates nothing. */
void fl_hull_submerged(const fl_hull *h, fl_vec3 up, double level, fl_submerged *wet);

/* The water plane of a solid: area, centroid c, and the tensor T = int (x - c)(x - c)^T dA.  Tilting about a
 * horizontal axis works against I = t.T t, t being the horizontal direction at right angles to that axis: the
 * metacentre stands I / V over the centre of buoyancy.  Zero for a body wholly dry or wet. */
typedef struct {
    double area;    /* [m^2] */
    fl_vec3 centre; /* body axes [m] */
    fl_mat3 second; /* body axes [m^4] */
} fl_waterplane;
void fl_hull_waterplane(const fl_hull *h, fl_vec3 up, double level, fl_waterplane *w);

/* Force on the body and moment about its origin, in body axes, and the energy of the displaced water,
 *     F = rho g V up,   M = x_B x F,   U = -rho g V z_B,   z_B = up.x_B - level <= 0.
 * F and M are the exact gradient of -U: raising the body by dz raises every wet point, and the points that
 * enter or leave do so at z = 0, so d(int z dV) = V dz; turning it by dphi moves the points by dphi x x, and
 * d(int z dV) = V up.(dphi x x_B) = dphi.(x_B x V up).
 *   weight   rho g of the water   [N/m^3]
 * force [N], moment [N.m]; returns U [J]. */
double fl_buoyancy_force(const fl_submerged *wet, fl_vec3 up, double level, double weight, fl_vec3 *force,
                         fl_vec3 *moment);

#endif
