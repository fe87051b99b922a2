/* SPDX-License-Identifier: GPL-3.0-or-later */
/* weld.h -- vertices that are one point become one vertex. */
#ifndef FL_GEOM_WELD_H
#define FL_GEOM_WELD_H
#include "geom/surface.h"

typedef struct {
    int32_t merged;    /* vertices that became another one               */
    int32_t unused;    /* vertices of no triangle, dropped               */
    int32_t collapsed; /* triangles with a repeated index, dropped       */
    double tol;        /* the tolerance that was used                [m] */
    double moved;      /* largest distance a vertex moved            [m] */
} fl_weld;

/* Merge vertices: first those with the same coordinates, then, in order of first use, each with the nearest
 * earlier one within tol.  Afterwards vertices stand in the order in which the triangles first use them, so
 * that the same triangles give the same arrays whatever file they came from.
 *   tol   [m]; 0 merges equal coordinates only; < 0 takes 1e-6 of the diagonal of the box of all vertices,
 *         or half the shortest edge where that is less (float32 coordinates near the origin blur 6e-8 of it).
 *         Below 1e-15 of the diagonal it is taken as 0.
 * Returns 0, or -1 with FL_INPUT when tol > 0 is above the shortest edge that is not zero, or when the box is
 * too large to measure (1e150 m), or with FL_SYSTEM; then p is what it was but for
 * the order of its vertices. */
int fl_part_weld(fl_part *p, double tol, fl_weld *w, fl_err *err);

#endif
