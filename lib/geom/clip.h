/* SPDX-License-Identifier: GPL-3.0-or-later */
/* clip.h -- convex polyhedra cut by half-spaces, and with their faces moved. */
#ifndef FL_GEOM_CLIP_H
#define FL_GEOM_CLIP_H
#include "geom/poly.h"

/* Keep the part of p where n.x <= c.  Faces keep their order, those that vanish drop out, and the cut is the
 * last face (none is made where p is flat).
 *   p    any core; replaced                                      [m]
 *   n    unit normal of the half-space, pointing out of it
 *   c    offset of its plane                                     [m]
 * Vertices within 1e-12 size of the plane count as on it: they are neither cut off nor split.  Corners of the
 * result closer than 2e-10 size are drawn together, since fl_poly_make() could not tell them apart, and where
 * a face would come out too narrow for it vertices within 5e-10 size count as on the plane.
 * Returns 0; when no more is left than points of the plane, or a slice that has no volume after this, p is
 * freed and zeroed (nv = 0).  -1, p untouched, with FL_SYSTEM, or with FL_NUMERIC when what is left is too
 * thin to have faces and yet does not vanish. */
int fl_poly_cut(fl_poly *p, fl_vec3 n, double c, fl_err *err);

/* The intersection of the half-spaces n_f.x <= c_f + r of the faces of in: every face moved outward by r > 0
 * or inward by -r > 0.  With r the dilation radius this is the outer sharp shape of a core, and with -r the
 * core of an outer shape (they undo each other as long as no face vanishes).  Where the faces at a corner
 * allow it the corner moves as a corner and vertices, faces and their order stay; else the half-spaces are
 * cut with each other, faces that vanish drop out and faces in a common plane become one.  A flat polygon
 * moves its edges outward in its plane too, as a prism of no height would.
 *   out  overwritten, not freed; may not be in                     [m]
 *   in   a solid, or a flat polygon with r > 0                     [m]
 *   r                                                              [m]
 * Returns 0, or -1: FL_INPUT when nothing is left inside, for a point or a segment, and when a corner is so
 * sharp that it flies off beyond 1e4 (size + r); FL_NUMERIC and FL_SYSTEM as above. */
int fl_poly_offset(fl_poly *out, const fl_poly *in, double r, fl_err *err);

#endif
