/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pack_passage.h -- passages of a region that a body cannot pass.
 *
 * A body of radius r moves where the distance g(x) from the complement is r at least. Where that set falls
 * apart although the region does not, a passage is too narrow. On a grid of spacing h points are taken in
 * descending order of g, and neighbours are joined: two sets with room for a body each that join below
 *     g < r - sqrt(D) h/2
 * are parts of the region with a passage of the width 2 g between them, to about sqrt(D) h. Parts that hang
 * together in {g >= r} are always found to, so that no region is refused for its grid.
 * h = r/FINE, coarser for large regions; a region that needs more than NODES points at r/COARSE is not
 * examined. A narrow tip without room for a body at its end is no passage. Boxes, cylinders and spheres have
 * none. */
#ifndef FL_PACK_PACK_PASSAGE_H
#define FL_PACK_PACK_PASSAGE_H
#include "pack/pack_region.h"

typedef struct {
    int found;
    double width; /* of the narrowest one [m] */
    fl_vec3 at;   /* a point in it [m] */
} fl_passage;

/* -1 with FL_SYSTEM. */
int fl_passage_find(fl_passage *out, const fl_pack_region *r, double radius, fl_err *err);

#endif
