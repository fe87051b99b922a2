/* SPDX-License-Identifier: GPL-3.0-or-later */
/* persistence_contact.h -- contact of a sphere with a surface that is not convex, by persistent homology.
 *
 * On a convex surface the nearest point alone bears load. In a groove two walls do, and a groove that is
 * filled up gradually turns into a plane, on which one does. Neither holds in between, and any rule that
 * counts walls makes the force jump. Here the energy of a sphere about x of radius R sums over r <= R the
 * number n(x, r) of connected components of the surface S inside the sphere of radius r about x. With the
 * energy H(R - d) of one wall at distance d,
 *
 *     W(x) = int n(x, r) dH(R - r)  =  sum over minima H(R - d) - sum over saddles H(R - d).
 *
 * A component begins at a minimum of the distance from x. Two components join at the saddle between them,
 * the lowest point of the way from one to the other: the walls of a groove join at its bottom. Where a
 * wall ends, its minimum and the saddle coincide, and the two terms cancel to first order. So W is
 * continuous wherever x moves in front of the surface. So is the force, its gradient, unless two saddles
 * are equal. W is a sum over the persistence diagram of the distance, which moves by no more than x does:
 * Cohen-Steiner, Edelsbrunner and Harer, Discrete Comput Geom 37 (2007) 103.
 * Consequences:
 *   - a convex surface has one minimum: exactly Hertz' contact;
 *   - walls that meet farther away than R act independently: in a corner of a box W = H + H + H;
 *   - the division of the surface into tiles has no effect.
 *
 * Limits. A hollow whose facets are longer than the overlap acts as a polyhedron: several facets bear
 * load. Sheets one behind another, nearer than the overlap, bear load each, as do both sides of a gap
 * wider than tol. If x is behind the surface, the nearest point alone bears load.
 *
 * Tiles are convex, so the distance from x has one minimum in each. The components are those of a graph:
 * tiles nearer than r, and the seams where two of them meet. Its minimum spanning forest contains the
 * saddles. A tile seen from behind counts by its rim only. */
#ifndef FL_STRUCTURE_PERSISTENCE_CONTACT_H
#define FL_STRUCTURE_PERSISTENCE_CONTACT_H
#include "broad/bvh.h"
#include "geom/poly.h"
#include "narrow/closest_point.h"
#include "patch/patch_points.h"

/* A seam: tiles i < j meet from a to b. */
typedef struct {
    int32_t j;
    int32_t concave; /* the surface is concave there, or it could not be decided */
    fl_vec3 a, b;
} fl_tile_seam;

/* The seams of a surface. Zeroed: not made. */
typedef struct {
    int32_t *begin; /* [tiles + 1] offsets into seam, by i */
    fl_tile_seam *seam;
    uint8_t *rim; /* [sides] 1: no other tile over this side of a tile, or over a part of it */
    int32_t n, cap;
    double tol;      /* distance up to which two tiles meet [m] */
    double rounding; /* rounding of distances [m] */
} fl_tile_seams;

/* Finds the seams between the tiles of a core; tree: over their boxes. Tiles at a seam need not share
 * vertices. Returns -1 with FL_SYSTEM, *s untouched. */
int fl_tile_seams_make(fl_tile_seams *s, const fl_poly *core, const fl_bvh *tree, const fl_aabb *box,
                       fl_err *err);
void fl_tile_seams_free(fl_tile_seams *s);

/* A tile within reach; scratch. */
typedef struct {
    int32_t tile;   /* tile */
    int32_t parent; /* parent in the union-find forest of components, an index into the scratch */
    fl_closest_point nearest;
} fl_persistence_tile;

typedef struct {
    double d; /* distance of the saddle that joins i and j, indices into the scratch */
    int32_t i, j, seam;
} fl_persistence_link;

typedef struct {
    fl_persistence_tile *tile;
    fl_persistence_link *link;
    int32_t *list;
    int32_t tiles, links, tile_cap, link_cap, list_cap;
} fl_persistence_work;

void fl_persistence_work_free(fl_persistence_work *w);

/* A list of tiles, ascending. */
typedef struct {
    const int32_t *tile;
    int32_t n;
} fl_near_tiles;

/* How many walls a sphere of at most the radius r about x can touch, without computing the points. 1: at most
 * one wall can touch; 0: more may; -1: out of memory. near: all tiles nearer than r, and possibly others. */
int fl_persistence_is_single(const fl_tile_seams *s, fl_persistence_work *k, const fl_poly *core,
                             const fl_near_tiles *near, fl_vec3 x, double r);

/* Contact points of a sphere on the surface, by fl_patch_points_add_plain(); their du is 1 for minima and -1
 * for saddles. point[0] is q, the nearest of all, in tile `of`; its distance is negative behind the surface.
 * near: all tiles nearer than the radius, and possibly others. Returns -1 when memory runs out. */
int fl_persistence_points(const fl_tile_seams *s, fl_persistence_work *k, fl_patch_points *w,
                          const fl_poly *core, const fl_near_tiles *near, fl_vec3 x, double radius,
                          const fl_closest_point *q, int32_t of);

#endif
