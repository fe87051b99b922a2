/* SPDX-License-Identifier: GPL-3.0-or-later */
/* raise_deck.h -- a deck on a hull that is open at the waterline.
 *
 * Panels of hydrodynamics end at the water.  The rims at the top of a surface, edges of one triangle of which
 * both ends lie within FL_DECK_FLAT of the box below its highest point, are raised by H: walls H high, and a
 * flat deck on them.  A rim within a rim is a hole in the deck (a moonpool), one within that a deck again.
 * Where the top is at z = 0, triangles that lie there, lids of the waterline, are left out first.  Other
 * open edges stay. The volume added is H times the area within the rims, that of the holes taken off. */
#ifndef FL_GEOM_RAISE_DECK_H
#define FL_GEOM_RAISE_DECK_H
#include "geom/surface.h"

#define FL_DECK_FLAT 1e-4

typedef struct {
    int32_t rims, holes, edges; /* raised; of them holes; their edges */
    int32_t lids;               /* triangles left out */
    int32_t chains;             /* open edges at the top that close no rim and stay */
    double top;                 /* height of the rims [m] */
} fl_deck_counts;

/* Counts the rims of p, which is welded, without a change. */
int fl_part_rims(const fl_part *p, fl_deck_counts *did, fl_err *err);

/* Raises a deck by height > 0 [m].  p is welded and its patches are coherent (mesh_patch.h); a part without a
 * rim is unchanged, with did->rims 0.  Returns 0, or -1 with FL_SYSTEM.
 * Source: a hole is joined to its rim by a cut between two corners that see each other, Eberly, Triangulation
 * by Ear Clipping (2002). */
int fl_part_raise_deck(fl_part *p, double height, fl_deck_counts *did, fl_err *err);

#endif
