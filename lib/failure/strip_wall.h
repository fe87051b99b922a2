/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strip_wall.h -- the walls of a piece of the structure, divided into sectors: one for each element of a
 * strip.
 *
 * The outline of the piece at the height of the ice is cut into lengths of about the same width b: round a
 * cone, along the sides of a polyhedron or a mesh. It is cut anew at bends of more than 20 degrees. A sector
 * stands for the wall above and below its middle; its normal is the mean over its width, so that the area
 * vector of all sectors is that of the outline.
 *
 * Only walls within 15 degrees of the vertical have sectors; the rest of a piece bears no ice where it has
 * some. Limits: a wall has the height of the one face at the ice; a joined piece of free cones is its facets.
 * */
#ifndef FL_FAILURE_STRIP_WALL_H
#define FL_FAILURE_STRIP_WALL_H
#include "structure/structure.h"

/* In the frame of the piece. */
typedef struct {
    fl_vec3 x;           /* on the wall, at the height of the ice, in the middle of the sector [m] */
    fl_vec3 n;           /* unit normal, outward */
    fl_vec3 along, up;   /* unit: along the outline; up the wall, at right angles to n */
    double width;        /* at x [m] */
    double taper;        /* change of width with height */
    double from, to;     /* the wall reaches over x + s up, from <= s <= to [m] */
    int32_t left, right; /* neighbours against and along `along`; -1: none */
} fl_wall_sector;

typedef struct {
    int32_t n;
    fl_wall_sector *sector; /* [n] */
    int is_round;           /* a ring, without sharp bends */
} fl_wall;

/* up: unit vector of the vertical; x: a point at the height of the ice, both in the frame of the piece.
 *   width  of a sector at most [m]
 *   ring   sectors on the outline at least, of which half are on a front; 0: as many as width gives
 * Without a wall there n is 0.  -1 with FL_SYSTEM. */
int fl_wall_make(fl_wall *out, const fl_piece *piece, fl_vec3 up, fl_vec3 x, double width, int32_t ring,
                 fl_err *err);
void fl_wall_free(fl_wall *w);

#endif
