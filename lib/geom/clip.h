/* SPDX-License-Identifier: GPL-3.0-or-later */
/* clip.h -- clips convex polyhedra by half-spaces and offsets their faces. */
#ifndef FL_GEOM_CLIP_H
#define FL_GEOM_CLIP_H
#include "geom/poly.h"

/* Keeps the part of p where n.x <= c.  Faces keep their order, vanished faces are dropped, and the cut is the
 * last face (none is made if p is flat).
 *   p    any core; replaced                                      [m]
 *   n    outward unit normal of the half-space
 *   c    offset of its plane                                     [m]
 * Vertices within 1e-12 size of the plane lie on it: they are neither cut off nor split.  Corners of the
 * result closer than 2e-10 size are merged, since fl_poly_make() could not distinguish them.  Where a face
 * would become too narrow for it, vertices within 5e-10 size count as on the plane.
 * Returns 0.  If only points of the plane or a slice without volume are left, p is freed and zeroed (nv = 0).
 * -1, p untouched, with FL_SYSTEM, or with FL_NUMERIC if the rest is too thin to have faces. */
int fl_poly_cut(fl_poly *p, fl_vec3 n, double c, fl_err *err);

/* The intersection of the half-spaces n_f.x <= c_f + r of the faces of in: each face moves outward by r > 0
 * or inward by -r > 0.  With the dilation radius r this turns a core into its outer sharp shape, and with -r
 * the outer shape into its core; the two are inverse as long as no face vanishes.  Where the faces at a
 * corner allow it, the corner moves as one, and vertices, faces and their order stay.  Otherwise the
 * half-spaces are intersected, vanished faces are dropped and faces in a common plane become one.  A flat
 * polygon also moves its edges outward in its plane, as a prism of no height would.
 *   out  overwritten, not freed; must not be in                    [m]
 *   in   a solid, or a flat polygon with r > 0                     [m]
 *   r    offset                                                    [m]
 * Returns 0, or -1: FL_INPUT if nothing is left, for a point or a segment, and if a sharp corner moves beyond
 * 1e4 (size + r); FL_NUMERIC and FL_SYSTEM as above. */
int fl_poly_offset(fl_poly *out, const fl_poly *in, double r, fl_err *err);

#endif
