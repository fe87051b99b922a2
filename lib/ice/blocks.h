/* SPDX-License-Identifier: GPL-3.0-or-later */
/* blocks.h -- a pile of ice blocks: a convex region of space cut into the Voronoi cells of random sites, and
 * a convex block inside each cell.  Sails, keels and rubble are made of such. */
#ifndef FL_ICE_BLOCKS_H
#define FL_ICE_BLOCKS_H
#include <stdint.h>
#include "base/err.h"
#include "geom/poly.h"

/* Outer corners of a block stay clear of the faces of its cell by this part of the gap at least. */
#define FL_BLOCKS_CLEARANCE 0.5

typedef struct {
    int32_t n;            /* cells                                                               */
    fl_vec3 *site;        /* [n]                                                             [m] */
    fl_poly *cell;        /* [n]                                                             [m] */
    fl_poly *core;        /* [n] nv = 0: the cell has no room for a block                    [m] */
    double *volume;       /* [n] of the outer sharp block, 0 where there is none            [m3] */
    double region_volume; /* volume of the region                                           [m3] */
    double cells_volume;  /* of all cells together, the same to rounding                    [m3] */
    double solid_volume;  /* of all blocks                                                  [m3] */
    double inset;         /* by which the faces of a cell move inward, half the way between blocks [m] */
    int32_t blockless;    /* cells without a block                                               */
} fl_blocks;

/* Cells of n sites, uniform in the region and then moved to the centroids of their cells `smooth` times.
 * Site i of the entities first, first + 1, ... of the seed.  A cell is the region cut by the planes half-way
 * to the sites round its own, nearest first, until the next one is twice as far away as its farthest corner
 * (Rycroft, Chaos 19 (2009) 041111); sites lie in a grid, so that the work grows with n.
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM; out is untouched then. */
int fl_blocks_cells(fl_blocks *out, const fl_poly *region, int32_t n, uint64_t seed, int64_t first,
                    int smooth, fl_err *err);

/* Shrink the cells: the outer sharp block is the cell with its faces moved inward by the gap, and its core
 * lies inside that by the dilation radius.  Where faces vanish on the way to the core, what comes of moving
 * the others outward again has sharper corners: then the block moves in farther until they are clear.  The
 * gap is found such that the blocks fill the part  solid  of the region. solid  above 0 and below 1 A block
 * whose core would be a sheet is none. Returns 0, or -1 with FL_INPUT (so much, or so little, cannot be
 * filled with such a radius; what can is told), FL_NUMERIC or FL_SYSTEM. */
int fl_blocks_shrink(fl_blocks *b, double solid, double radius, fl_err *err);

/* Pairs of outer blocks that the plane half-way between their sites does not separate: 0, since each stays in
 * its cell, when nothing has gone wrong.  Returns 0, or -1 with FL_SYSTEM. */
int fl_blocks_overlaps(const fl_blocks *b, double radius, int64_t *pairs, fl_err *err);

double fl_blocks_volume(const fl_poly *p); /* of a sharp polyhedron [m3] */

void fl_blocks_free(fl_blocks *b); /* accepts a zeroed struct, leaves one */

#endif
