/* SPDX-License-Identifier: GPL-3.0-or-later */
/* merge_coplanar.h -- flat regions of triangles joined into few convex polygons. */
#ifndef FL_GEOM_MERGE_COPLANAR_H
#define FL_GEOM_MERGE_COPLANAR_H
#include <stdint.h>
#include "base/err.h"
#include "geom/surface.h"
#include "geom/vec3.h"

enum { FL_MERGED_SIDES_MAX = 64 }; /* of one tile at most: what meets it looks at all of them */

typedef struct {
    int32_t n;
    int32_t *first;       /* [n + 1] offsets into loop */
    int32_t *loop;        /* [first[n]] vertices of each tile, counter-clockwise about its normal */
    int32_t *region;      /* [n] of which it is a part */
    int32_t *face_of_tri; /* [nt] tile of each triangle, -1 for those of no region */
    int32_t
        *straight_corners; /* [nv] of how many tiles a vertex was a corner of 180 degrees, left out of loop */
} fl_merged_faces;

/* Tiles cover each region once.  A region whose rim is one convex line becomes one tile, whatever its
 * triangles are; of any other, neighbours are joined while their union is convex (Hertel and Mehlhorn, FCT
 * 1983, LNCS 158, 207: without inner vertices at most four times as many as need be).  A tile of more than
 * FL_MERGED_SIDES_MAX sides is cut by chords.  Corners are convex, or straight, within tol. nv, v          vertices
 * [m] nt, t          triangles region[nt]     connected over `across`; -1 for none normal[]       unit normal
 * of each region across[3 nt]   triangle over side k of triangle t at 3 t + k, side k from corner k to the
 * next; it must have the same region, or it is taken as the region's rim; -1 for none tol            distance
 * below which a corner is straight                           [m] Time O(nt log nt), and the square of the
 * corners of a rim.  -1 with FL_SYSTEM, out untouched. */
int fl_merge_coplanar(fl_merged_faces *out, int32_t nv, const fl_vec3 *v, int32_t nt, const fl_tri *t,
                      const int32_t *region, const fl_vec3 *normal, const int32_t *across, double tol,
                      fl_err *err);
void fl_merged_faces_free(fl_merged_faces *tiles);

#endif
