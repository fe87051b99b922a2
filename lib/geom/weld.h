/* SPDX-License-Identifier: GPL-3.0-or-later */
/* weld.h -- merges coincident vertices. */
#ifndef FL_GEOM_WELD_H
#define FL_GEOM_WELD_H
#include "geom/surface.h"

typedef struct {
    int32_t merged;    /* vertices merged into another one */
    int32_t unused;    /* unused vertices, dropped */
    int32_t collapsed; /* triangles with a repeated index, dropped       */
    double tol;        /* tolerance used                             [m] */
    double moved;      /* largest displacement of a vertex           [m] */
} fl_weld;

/* Merges vertices: first those with equal coordinates, then, in order of first use, each with the nearest
 * earlier one within tol.  Afterwards vertices are in the order in which the triangles first use them, so
 * that the same triangles give the same arrays whatever file they came from.
 *   tol   [m]; 0 merges equal coordinates only; < 0 selects 1e-6 of the diagonal of the bounding box, or half
 *         the shortest edge if that is less (rounding of float32 coordinates near the origin is 6e-8 of the
 *         diagonal).  Below 1e-15 of the diagonal it counts as 0.
 * Returns 0, or -1 with FL_INPUT if tol > 0 exceeds the shortest edge that is not zero, or if the box is too
 * large to measure (1e150 m), or with FL_SYSTEM.  On failure only the order of p's vertices may have
 * changed. */
int fl_part_weld(fl_part *p, double tol, fl_weld *w, fl_err *err);

#endif
