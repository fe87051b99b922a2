/* SPDX-License-Identifier: GPL-3.0-or-later */
/* merge_coplanar.h -- merges the triangles of flat regions into few convex polygons. */
#ifndef FL_GEOM_MERGE_COPLANAR_H
#define FL_GEOM_MERGE_COPLANAR_H
#include <stdint.h>
#include "base/err.h"
#include "geom/surface.h"
#include "geom/vec3.h"

enum { FL_MERGED_SIDES_MAX = 64 }; /* sides of a face: a contact test examines all of them */

typedef struct {
    int32_t n;
    int32_t *first;            /* [n + 1] offsets into loop */
    int32_t *loop;             /* [first[n]] vertices of each face, counter-clockwise about its normal */
    int32_t *region;           /* [n] region of each face */
    int32_t *face_of_tri;      /* [nt] face of each triangle, -1 outside all regions */
    int32_t *straight_corners; /* [nv] faces with a corner of 180 degrees here, left out of loop */
} fl_merged_faces;

/* Makes convex faces that cover each region once.  A region with one convex boundary becomes one face,
 * whatever its triangles.  In other regions neighbours are joined while their union is convex; without inner
 * vertices this gives at most four times the minimum number.  A face of more than FL_MERGED_SIDES_MAX sides
 * is cut by chords.  Corners are convex, or straight, within tol.
 *   nv, v         vertices                                                              [m]
 *   nt, t         triangles
 *   region[nt]    region of each triangle, connected over `across`; -1 for none
 *   normal[]      unit normal of each region
 *   across[3 nt]  triangle across side k of triangle t at 3 t + k, -1 for none; side k runs from corner k to
 *                 the next.  A neighbour of another region counts as none
 *   tol           distance below which a corner is straight                             [m]
 * Time O(nt log nt), plus the square of the number of corners of a boundary.  0, or -1 with FL_SYSTEM, out
 * untouched.  Source: Hertel & Mehlhorn, FCT 1983, LNCS 158, 207. */
int fl_merge_coplanar(fl_merged_faces *out, int32_t nv, const fl_vec3 *v, int32_t nt, const fl_tri *t,
                      const int32_t *region, const fl_vec3 *normal, const int32_t *across, double tol,
                      fl_err *err);
void fl_merged_faces_free(fl_merged_faces *faces);

#endif
