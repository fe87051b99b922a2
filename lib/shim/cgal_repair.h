/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_repair.h -- repairs a triangle soup with CGAL's Polygon Mesh Processing. */
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
    int32_t duplicates; /* triangles on the same three vertices as an earlier one, dropped */
    int32_t stitched;   /* pairs of coincident boundary edges, joined */
    int32_t degenerate; /* triangles of collinear corners, removed without opening a hole */
    int32_t stuck;      /* same, but not removable */
    int32_t holes;      /* boundary cycles closed by new triangles */
    int32_t patched;    /* number of these triangles */
    int32_t bounding;   /* 1: all patches are closed, none intersect, and they bound a volume */
} fl_repair;

/* Repairs s in place: drops duplicate triangles, orients patches, stitches boundaries, removes triangles of
 * collinear corners, fills holes, and orients closed surfaces that do not intersect so that they bound a
 * volume (cavities face inward).  Predicates are exact.  Where more than two triangles meet in an edge, the
 * surface is cut there into manifold pieces, whose vertices have equal coordinates: weld with tolerance 0
 * afterwards to restore the edge.
 *   s      x and t from malloc() or fl_alloc(); replaced
 *   holes  boundary cycles of at most this many edges are filled; 0 for none
 *   size   and cycles whose box has a diagonal of at most this [m]; 0 for none
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM, and s valid.
 * Source: CGAL 5.5 User and Reference Manual, Polygon Mesh Processing (Loriot et al.). */
int fl_cgal_repair(fl_soup *s, int32_t holes, double size, fl_repair *did, fl_err *err);

void fl_soup_free(fl_soup *s); /* accepts a zeroed struct, leaves one */

#endif
