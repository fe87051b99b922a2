/* SPDX-License-Identifier: GPL-3.0-or-later */
/* element_surface.h -- the outer surface of a finite element mesh. */
#ifndef FL_MESH_ELEMENT_SURFACE_H
#define FL_MESH_ELEMENT_SURFACE_H
#include "mesh/elements.h"

/* Add the surface of the mesh to s, a part for each part (and each set) that is wanted and holds something:
 *   solids   their faces that no other solid among the wanted ones has (by their corner nodes), outward
 *            whatever way the element is numbered
 *   shells   as they are: the normal follows the order of the nodes
 *   lines    solid truncated cones with the radii of their section; without one they are counted in a remark
 * With wishes, a set that is like one takes its elements out of their parts, the first such set in the order
 * of the file; picked faces become triangles of the set and no longer of the solid's part.  A set that has
 * the name of a part goes on with it.
 * A face comes once, whatever lies on it: fl_resolve_shared_faces() says who brings it.
 * Quadrilaterals are split by fl_facet_polygon() with the numbers of the nodes deciding on ties.  Mid-side
 * nodes are dropped, and the largest sagitta (distance of the middle node from the chord) told in a remark;
 * or with w->subdivide a triangle becomes 4, a quadrilateral 6, one with a centre node 8.
 *   b   takes the remarks: what came in, what was passed over
 *   w   NULL wants everything
 * Returns 0, or -1 with FL_INPUT (a node that is nowhere defined, named with the line of the element) or
 * FL_SYSTEM. */
int fl_elements_surface(fl_elements *e, fl_surface *s, fl_bytes *b, fl_import_options *opt, fl_err *err);

#endif
