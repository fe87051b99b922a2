/* SPDX-License-Identifier: GPL-3.0-or-later */
/* element_surface.h -- the outer surface of a finite element mesh. */
#ifndef FL_MESH_ELEMENT_SURFACE_H
#define FL_MESH_ELEMENT_SURFACE_H
#include "mesh/elements.h"

/* Add the surface of the mesh to s, with one part for each part and set that is selected and not empty:
 *   solids   faces that no other selected solid has (by corner nodes), oriented outward whatever the
 *            numbering of the element
 *   shells   as they are: the normal follows the order of the nodes
 *   lines    solid truncated cones with the radii of their section; lines without a section are counted in a
 *            remark
 * If sets are selected by name, a set takes its elements out of their parts, the first such set in the order
 * of the file; a picked face becomes part of the set instead of the part of its solid.  A set with the name
 * of a selected part is merged with it.  A face is added once, however many elements share it;
 * fl_resolve_shared_faces() decides to which part.
 * Quadrilaterals are split by fl_facet_polygon(); node numbers decide ties.  Mid-side nodes are dropped, and
 * a remark gives the largest sagitta (distance of the mid-side node from the chord).  With opt->subdivide
 * they are kept: a triangle becomes 4, a quadrilateral 6, one with a centre node 8 triangles.
 *   b     takes the remarks on what was read and what was skipped
 *   opt   NULL selects everything
 * Returns 0, or -1 with FL_INPUT (an undefined node; the message names the line of the element) or FL_SYSTEM.
 */
int fl_elements_surface(fl_elements *e, fl_surface *s, fl_bytes *b, fl_import_options *opt, fl_err *err);

#endif
