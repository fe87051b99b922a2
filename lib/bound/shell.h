/* SPDX-License-Identifier: GPL-3.0-or-later */
/* shell.h -- the places where a dilated convex core touches a surface that is not convex.
 *
 * The potential is that of places.h, summed over the prisms over all faces, the wedges over the edges that
 * bend outward and the cones over the corners: seams between coplanar triangles are not there.  Where the
 * surface bends inward by less than 60 degrees points and edges count over the nearer of its faces
 * (matches.c); in a sharper inner corner every wall bears for itself.  Vertices behind the surface have one
 * distance, to the nearest face of all; what is nearest to the rim of an open surface is beside it, not
 * behind.  An open surface has one side: what has come round it to its back is as deep in it as it is far
 * from it.  Balls have a law of their own (passes.h). */
#ifndef FL_BOUND_SHELL_H
#define FL_BOUND_SHELL_H
#include "bound/structure.h"
#include "narrow/footing.h"
#include "narrow/gjk.h"

/* Scratch for the faces and edges in reach, and for what lies under a face. */
typedef struct {
    fl_reach of_shell, of_core;
    fl_passes_work passes;
    fl_footing_work footing;
} fl_shell_near;

/* All places of core a (radius ra) on the shell of piece b, as fl_places_find();
 * after fl_places_enter().  *distance is a lower bound of the distance of the core from the surface: reach
 * when no face comes that near, else ra.
 *   reach   how far to look, >= ra [m]
 *   l       the matches of the pair, as fl_places_find() wants them
 * -1 when memory runs out. */
int fl_shell_places(fl_places *w, fl_shell_near *near, const fl_poly *a, const fl_piece *b, double ra,
                    double reach, fl_matches *l, double *distance);

/* The same of a core that is a point, for laws that are not `patch`: the walls that it touches, for which
 * passes must have been made (passes.h).  *distance is that of the point, where nothing touches. */
int fl_shell_point(fl_places *w, fl_shell_near *near, const fl_piece *b, double ra, fl_matches *l,
                   double *distance);

/* The point, in the frame of b, lies behind a surface that has no rim. */
int fl_shell_holds(const fl_piece *b, fl_vec3 x);

/* How far any point of the core may move before a wall that bears little or nothing bears more: until the
 * core is in it by part^2 of the largest overlap, or by `part` deeper than it was; ra at the most [m].  The
 * vertices v are those of core a in the frame of b.  -1 when memory runs out. */
double fl_shell_room(fl_shell_near *near, const fl_vec3 *v, const fl_poly *a, const fl_piece *b, double ra,
                     double overlap, double part);

/* The gap between the hull of the vertices v of core a, in the frame of b, and the surface: 1 where it is
 * below `within`, overlap set where a face of the surface cuts the core; else 0.  What is held has its
 * distance with the other sign, and n looks out.  -1 when memory runs out. */
int fl_shell_gap(fl_shell_near *near, const fl_vec3 *v, const fl_poly *a, const fl_piece *b, double within,
                 fl_gap *out);

void fl_shell_near_free(fl_shell_near *near);

#endif
