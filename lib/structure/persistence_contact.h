/* SPDX-License-Identifier: GPL-3.0-or-later */
/* persistence_contact.h -- the walls that a ball touches of a surface that is not convex, and how often each bears.
 *
 * On a convex surface the nearest point bears, and nothing else.  In a groove two walls bear, and a groove
 * that is filled up little by little goes over into a flat, on which one does: neither "the nearest" nor "all
 * of them" is right, and whatever counts them changes at once somewhere.  Here a ball about x of radius R,
 * whose energy on a wall at the distance d is H(R - d), counts the pieces that a smaller ball cuts out of the
 * surface S:
 *
 *     W(x) = int pieces(S, x, r) dH(R - r)  =  sum over minima H(R - d) - sum over passes H(R - d),
 *
 * pieces being the number of connected parts of S within r of x.  A piece begins at a minimum of the distance
 * from x, and two become one at the pass between them, the lowest saddle of that distance: the walls of a
 * groove meet at its bottom.  Where one wall ends, its minimum and the pass coincide and what is added and
 * what is taken off cancel, to the first order; so W is continuous wherever x goes in front of the surface,
 * and the force, its gradient, but where two passes are alike.  (W is a sum over the diagram of persistence
 * of the distance, which moves by no more than x does: Cohen-Steiner, Edelsbrunner and Harer, Discrete Comput
 * Geom 37 (2007) 103.)  What follows:
 *   - one minimum, on all that is convex: Hertz' contact, exactly;
 *   - walls that meet farther away than R bear each for itself: in a corner of a box W = H + H + H;
 *   - how a surface is cut into tiles is nothing that it could know.
 * A hollow that is meshed more coarsely than the ball overlaps it is a polyhedron, and more than one facet
 * bears; sheets that lie behind one another, nearer than the overlap, bear each, and so do both sides of a
 * gap that is wider than tol.  Where x is behind the surface the nearest point bears alone.
 * Tiles are convex, so the distance from x has one minimum in each, and the pieces are those of the graph of
 * tiles that are nearer than r and of segments where two of them meet: its minimum spanning forest has the
 * passes.  What stands behind a tile sees its rim alone. */
#ifndef FL_STRUCTURE_PERSISTENCE_CONTACT_H
#define FL_STRUCTURE_PERSISTENCE_CONTACT_H
#include "broad/bvh.h"
#include "geom/poly.h"
#include "narrow/closest_point.h"
#include "patch/patch_points.h"

/* Tiles i < j meet from a to b. */
typedef struct {
    int32_t j;
    int32_t inward; /* the surface bends inward there, or in no way that could be told */
    fl_vec3 a, b;
} fl_tile_seam;

/* Of a surface.  Zeroed: not made. */
typedef struct {
    int32_t *begin; /* [tiles + 1] offsets into pass, by i */
    fl_tile_seam *seam;
    uint8_t *rim; /* [sides] over this side of a tile, or a part of it, there is no other */
    int32_t n, cap;
    double tol;      /* nearer than that two tiles meet [m] */
    double rounding; /* and that is rounding of distances */
} fl_tile_seams;

/* Find them for the tiles of a core; tree: over their boxes.  A seam need not share its vertices.  -1 with
 * FL_SYSTEM, *s untouched. */
int fl_tile_seams_make(fl_tile_seams *s, const fl_poly *core, const fl_bvh *tree, const fl_aabb *box,
                       fl_err *err);
void fl_tile_seams_free(fl_tile_seams *s);

/* Scratch. */
typedef struct {
    int32_t tile;   /* the tile */
    int32_t parent; /* towards the one that its piece is told by */
    fl_closest_point nearest;
} fl_persistence_tile;

typedef struct {
    double d; /* at which i and j, numbers in the scratch, become one */
    int32_t i, j, seam;
} fl_persistence_link;

typedef struct {
    fl_persistence_tile *tile;
    fl_persistence_link *link;
    int32_t *list;
    int32_t tiles, links, tile_cap, link_cap, list_cap;
} fl_persistence_work;

void fl_persistence_work_free(fl_persistence_work *w);

/* Some tiles, ascending. */
typedef struct {
    const int32_t *tile;
    int32_t n;
} fl_near_tiles;

/* Whether a ball of a smaller radius within one of radius r about x can touch one wall only, as far as can be
 * told without computing: 1, 0, or -1 when memory runs out.  near: all tiles nearer than r, and maybe
 * others. */
int fl_persistence_is_single(const fl_tile_seams *s, fl_persistence_work *k, const fl_poly *core,
                             const fl_near_tiles *near, fl_vec3 x, double r);

/* The places of a ball on the surface, by fl_patch_points_add_plain(), their du 1 for minima and -1 for passes; the
 * first is q, the nearest point of all with its sign, which lies in tile `of`.  near: all tiles nearer than
 * the radius, and maybe others.  -1 when memory runs out. */
int fl_persistence_points(const fl_tile_seams *s, fl_persistence_work *k, fl_patch_points *w,
                          const fl_poly *core, const fl_near_tiles *near, fl_vec3 x, double radius,
                          const fl_closest_point *q, int32_t of);

#endif
