/* SPDX-License-Identifier: GPL-3.0-or-later */
/* domain.h -- the water that ice may cover: the inside of an outline, convex or not, without islands,
 * leads and structures; and cells cut to it. */
#ifndef FL_ICE_DOMAIN_H
#define FL_ICE_DOMAIN_H
#include <stdint.h>
#include "base/err.h"
#include "broad/bvh.h"
#include "geom/polygon.h"
#include "ice/power_cells.h"

/* A side of the domain does not cut a cell if its depth in the cell is below this fraction of the size of
 * the domain: to rounding it lies on a side of the cell. */
#define FL_DOMAIN_TOUCH_TOL 1e-10

/* Ring r has the corners first[r] .. first[r + 1).  Ring 0 is the outline, counter-clockwise.  The other
 * rings are holes, clockwise; they may overlap each other and the outline.  A point is inside if the
 * winding number of all rings together is 1. */
typedef struct {
    int32_t rings, corners;
    int32_t *first; /* [rings + 1]    */
    fl_vec2 *v;     /* [corners]  [m] */
    fl_vec2 lo, hi; /* box of ring 0 [m] */
    int32_t first_cap, v_cap;
    fl_aabb *box; /* [corners] box of the side from each corner, in v */
    fl_bvh tree;
} fl_domain;

/* Add a ring, of either orientation; the first ring is the outline.  Returns 0, or -1 with FL_INPUT (fewer
 * than three corners, a ring that crosses or touches itself, no area) or FL_SYSTEM. */
int fl_domain_add(fl_domain *d, int32_t n, const fl_vec2 *v, fl_err *err);

/* Build the search tree after all rings are added and before the functions below.  Returns 0, or -1 with
 * FL_SYSTEM. */
int fl_domain_build(fl_domain *d, fl_err *err);

/* 1 if the domain is one convex ring. */
int fl_domain_is_convex(const fl_domain *d);

/* Returns 1 if p is inside, 0 if not, -1 with FL_SYSTEM. */
int fl_domain_contains(const fl_domain *d, fl_vec2 p, fl_err *err);

/* Site i of a seed, uniform in the domain: the first of its random points in the box that is inside.
 * Returns 0, or -1 with FL_INPUT (less than FL_DOMAIN_MIN_SHARE of the box is inside) or FL_SYSTEM. */
#define FL_DOMAIN_MIN_SHARE 1e-4
int fl_domain_sites(int32_t n, uint64_t seed, const fl_domain *d, fl_vec2 *site, fl_err *err);

/* Result of the cut: convex pieces, and the area of the dropped ones. */
typedef struct {
    fl_power_cells cells; /* the pieces                                                       */
    int32_t *parent;      /* [cells.n] the cell from which a piece was cut */
    int32_t largest;      /* pieces that are the largest ones of their cells; they come first, by cell */
    double area;          /* of the domain, including dropped pieces [m2] */
    double dropped_area;  /* area of the dropped pieces [m2] */
    int32_t dropped;
} fl_pieces;

/* Cut cells, which cover the domain, to the domain.  A cell is divided along the side of the domain that
 * has the greatest length inside it, and so on, until no side crosses a piece.  Pieces outside are
 * dropped; so are slivers, whose inscribed circle has a radius below `least` [m].  Returns 0, or -1 with
 * FL_SYSTEM; out is unchanged then. */
int fl_domain_cut(fl_pieces *out, const fl_power_cells *cells, const fl_domain *d, double least, fl_err *err);

void fl_pieces_free(fl_pieces *p); /* both accept a zeroed struct and leave a zeroed one */
void fl_domain_free(fl_domain *d);

#endif
