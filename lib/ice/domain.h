/* SPDX-License-Identifier: GPL-3.0-or-later */
/* domain.h -- water that ice may cover: the inside of an outline, convex or not, less what is kept out of it
 * (islands, leads, structures), and cells cut down to it. */
#ifndef FL_ICE_DOMAIN_H
#define FL_ICE_DOMAIN_H
#include <stdint.h>
#include "base/err.h"
#include "broad/bvh.h"
#include "geom/polygon.h"
#include "ice/power_cells.h"

/* A side of the domain that runs no deeper into a cell than this part of the domain's size does not cut it:
 * it lies on a side of the cell already, to rounding. */
#define FL_DOMAIN_TOUCH_TOL 1e-10

/* Ring r has the corners first[r] .. first[r + 1).  Ring 0 is the outline, counter-clockwise; the others are
 * kept out, clockwise, and may overlap each other and the outline.  A point is inside when all rings together
 * wind round it once: once by the outline, and by no other. */
typedef struct {
    int32_t rings, corners;
    int32_t *first; /* [rings + 1]    */
    fl_vec2 *v;     /* [corners]  [m] */
    fl_vec2 lo, hi; /* box of ring 0 [m] */
    int32_t first_cap, v_cap;
    fl_aabb *box; /* [corners] of the side from each corner, in v */
    fl_bvh tree;
} fl_domain;

/* Add a ring, in either direction; the first one is the outline.  Returns 0, or -1 with FL_INPUT (fewer than
 * three corners, one that crosses or touches itself, no area) or FL_SYSTEM. */
int fl_domain_add(fl_domain *d, int32_t n, const fl_vec2 *v, fl_err *err);

/* To be called when all rings are there, before what follows.  0, or -1 with FL_SYSTEM. */
int fl_domain_build(fl_domain *d, fl_err *err);

/* 1 when it is one convex ring. */
int fl_domain_is_convex(const fl_domain *d);

/* 1 when p is inside, 0 when not, -1 with FL_SYSTEM. */
int fl_domain_contains(const fl_domain *d, fl_vec2 p, fl_err *err);

/* Site i of a seed, uniform in the domain: the first of its random points in the box that is inside.
 * Returns 0, or -1 with FL_INPUT (less than FL_DOMAIN_MIN_SHARE of the box is inside) or FL_SYSTEM. */
#define FL_DOMAIN_MIN_SHARE 1e-4
int fl_domain_sites(int32_t n, uint64_t seed, const fl_domain *d, fl_vec2 *site, fl_err *err);

/* What cutting left: convex pieces, and how much of the domain the pieces that were dropped have. */
typedef struct {
    fl_power_cells cells; /* the pieces                                                       */
    int32_t *parent;      /* [cells.n] the cell that a piece was cut from                     */
    int32_t largest;      /* pieces 0 .. whole are the largest ones of their cells, ascending */
    double area;          /* of the domain, dropped pieces included                      [m2] */
    double dropped_area;  /* of the dropped pieces                                       [m2] */
    int32_t dropped;
} fl_pieces;

/* Cut cells, which cover the domain, down to it.  A cell is divided along the side of the domain that runs
 * through it for the longest way, and so on, until none runs through a piece; pieces outside are dropped, and
 * those whose inscribed circle has a radius below `least` [m] are dropped as slivers.
 * Returns 0, or -1 with FL_SYSTEM; out is untouched then. */
int fl_domain_cut(fl_pieces *out, const fl_power_cells *cells, const fl_domain *d, double least, fl_err *err);

void fl_pieces_free(fl_pieces *p); /* both accept a zeroed struct and leave one */
void fl_domain_free(fl_domain *d);

#endif
