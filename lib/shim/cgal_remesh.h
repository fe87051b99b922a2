/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_remesh.h -- isotropic remeshing of a surface. */
#ifndef FL_SHIM_CGAL_REMESH_H
#define FL_SHIM_CGAL_REMESH_H
#include "shim/cgal_repair.h"

/* Remeshes s with edges of about `length`: edges longer than 4/3 of it are split, shorter than 4/5 collapsed,
 * edges flipped towards valence six, vertices relaxed along the surface and projected back to it, five times.
 * Boundaries, branched edges and edges where the surface bends by 30 degrees or more are kept, and only
 * split; so are points whose angles miss a full turn by as much (the tip of a cone).  Measure the deviation
 * of the result with fl_cgal_distance().
 *   s        x and t from malloc() or fl_alloc(); replaced
 *   length   > 0                                            [m]
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM, and s unchanged.
 * Source: Botsch & Kobbelt, Symp. Geometry Processing 2004, as of CGAL 5.5. */
int fl_cgal_remesh(fl_soup *s, double length, fl_err *err);

#endif
