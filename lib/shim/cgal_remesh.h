/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_remesh.h -- the same surface from triangles of an even size. */
#ifndef FL_SHIM_CGAL_REMESH_H
#define FL_SHIM_CGAL_REMESH_H
#include "shim/cgal_repair.h"

/* Triangles with edges of about `length` on the surface of s: edges longer than 4/3 of it are split, shorter
 * than 4/5 collapsed, flipped towards six neighbours a vertex, and vertices moved along the surface and put
 * back on it, five times over.  Rims, branched edges and edges at which the surface bends by 30 degrees or
 * more are kept, and only cut; so are points where its angles miss a full turn by as much (the tip of a
 * cone).  How far the result strays is to be measured: fl_cgal_distance().
 *   s        x and t from malloc() or fl_alloc(); replaced
 *   length   > 0                                            [m]
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM in err, and s as it was.
 * Source: Botsch & Kobbelt, Symp. Geometry Processing 2004, as of CGAL 5.5. */
int fl_cgal_remesh(fl_soup *s, double length, fl_err *err);

#endif
