/* SPDX-License-Identifier: GPL-3.0-or-later */
/* blocks.h -- a pile of ice blocks: Voronoi cells of random sites in a convex region of space, with a
 * convex block inside each cell.
 *
 * Sails, keels and rubble consist of such blocks. */
#ifndef FL_ICE_BLOCKS_H
#define FL_ICE_BLOCKS_H
#include <stdint.h>
#include "base/err.h"
#include "geom/poly.h"

/* Least distance of the outer corners of a block from the faces of its cell, over the inset. */
#define FL_BLOCKS_CLEARANCE 0.5

typedef struct {
    int32_t n;            /* cells                                                               */
    fl_vec3 *site;        /* [n]                                                             [m] */
    fl_poly *cell;        /* [n]                                                             [m] */
    fl_poly *core;        /* [n] nv = 0: no room for a block in the cell         [m] */
    double *volume;       /* [n] of the outer sharp block, 0 where there is none [m3] */
    double region_volume; /* volume of the region [m3] */
    double cells_volume;  /* volume of all cells, equal to that of the region to rounding [m3] */
    double solid_volume;  /* volume of all blocks [m3] */
    double inset;         /* of the faces of a cell, half the gap between two blocks [m] */
    int32_t blockless;    /* cells without a block */
} fl_blocks;

/* Make the cells of n sites.  The sites are uniform in the region; `smooth` times they move to the
 * centroids of their cells.  Site i uses the random numbers of entity first + i of the seed.  A cell is
 * the region cut by the bisector planes to the neighbouring sites, nearest first, until the next site is
 * more than twice as far away as the farthest corner of the cell (Rycroft, Chaos 19 (2009) 041111).  A
 * grid of the sites makes the work proportional to n.  Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM; out
 * is unchanged then. */
int fl_blocks_cells(fl_blocks *out, const fl_poly *region, int32_t n, uint64_t seed, int64_t first,
                    int smooth, fl_err *err);

/* Shrink the cells to blocks.  The outer sharp block is the cell with its faces moved inward by the inset;
 * the core lies inside it by the dilation radius.  Where faces vanish on the way to the core, moving the
 * others outward again gives sharper corners; such a block moves farther inward until its corners are
 * clear.  The inset is found such that the blocks fill the fraction `solid` (above 0, below 1) of the
 * region.  A cell whose core would be a sheet has no block.  Returns 0, or -1 with FL_INPUT (the fraction
 * is out of reach with this radius; the message gives the reachable one), FL_NUMERIC or FL_SYSTEM. */
int fl_blocks_shrink(fl_blocks *b, double solid, double radius, fl_err *err);

/* Count the pairs of outer blocks that no plane across the line of their sites separates.  The count is 0
 * if the cells are correct, since each block stays in its cell.  Returns 0, or -1 with FL_SYSTEM. */
int fl_blocks_overlaps(const fl_blocks *b, double radius, int64_t *pairs, fl_err *err);

double fl_blocks_volume(const fl_poly *p); /* volume of a sharp polyhedron [m3] */

void fl_blocks_free(fl_blocks *b); /* accepts a zeroed struct, leaves a zeroed one */

#endif
