/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_repair.h -- mending a triangle soup by CGAL's polygon mesh processing. */
#ifndef FL_SHIM_CGAL_REPAIR_H
#define FL_SHIM_CGAL_REPAIR_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    int32_t nv, nt;
    double *x;  /* [3 nv] coordinates                  [m] */
    int32_t *t; /* [3 nt] vertices of the triangles, three different ones each */
} fl_soup;

typedef struct {
    int32_t duplicates; /* triangles on the same three vertices as an earlier one, dropped             */
    int32_t stitched;   /* pairs of rim edges in the same place, joined                                */
    int32_t degenerate; /* triangles of collinear corners that were taken out without opening a hole   */
    int32_t stuck;      /* the same, which could not be taken out                                      */
    int32_t holes;      /* rims closed by new triangles                                                */
    int32_t patched;    /* those triangles                                                             */
    int32_t bounding;   /* 1: all is closed and no two patches meet, and each was turned so that the
                              whole bounds a volume: cavities look inward */
} fl_repair;

/* Mend s in place: drop duplicate triangles, orient what can be oriented, stitch rims, take out triangles of
 * collinear corners, close rims, and turn closed surfaces that do not meet so that they bound a volume.
 * Predicates are exact.  Where more than two triangles meet in an edge, the surface is cut along it into
 * manifold pieces, whose vertices there have equal coordinates: weld with tolerance 0 afterwards, and the
 * edge is what it was.
 *   s      x and t from malloc() or fl_alloc(); replaced
 *   holes  rims of at most so many edges are closed; 0 for none
 *   size   and so are rims whose box has a diagonal of at most this [m]; 0 for none
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM in err, and s sound.
 * Source: CGAL 5.5 User and Reference Manual, Polygon Mesh Processing (Loriot et al.). */
int fl_cgal_repair(fl_soup *s, int32_t holes, double size, fl_repair *did, fl_err *err);

void fl_soup_free(fl_soup *s); /* accepts a zeroed struct, leaves one */

#endif
