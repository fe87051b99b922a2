/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_contact.h -- the places where a dilated convex core touches a surface that is not convex.
 *
 * The potential is that of patch_points.h, summed over the prisms over all faces, the wedges over the edges that
 * bend outward and the cones over the corners: seams between coplanar triangles are not there.  Where the
 * surface bends inward by less than 60 degrees points and edges count over the nearer of its faces
 * (feature_pairs.c); in a sharper inner corner every wall bears for itself.  Vertices behind the surface have one
 * distance, to the nearest face of all; what is nearest to the rim of an open surface is beside it, not
 * behind.  An open surface has one side: what has come round it to its back is as deep in it as it is far
 * from it.  Balls have a law of their own (persistence_contact.h). */
#ifndef FL_STRUCTURE_MESH_CONTACT_H
#define FL_STRUCTURE_MESH_CONTACT_H
#include "structure/structure.h"
#include "patch/mesh_under_face.h"
#include "narrow/gjk.h"

/* Scratch for the faces and edges in reach, and for what lies under a face. */
typedef struct {
    fl_feature_set of_shell, of_core;
    fl_persistence_work persistence;
    fl_mesh_under_face_work under_face;
} fl_mesh_contact_work;

/* All places of core a (radius ra) on the shell of piece b, as fl_patch_points_find();
 * after fl_patch_points_transform().  *distance is a lower bound of the distance of the core from the surface: reach
 * when no face comes that near, else ra.
 *   reach   how far to look, >= ra [m]
 *   l       the matches of the pair, as fl_patch_points_find() wants them
 * -1 when memory runs out. */
int fl_mesh_contact_points(fl_patch_points *w, fl_mesh_contact_work *near, const fl_poly *a,
                           const fl_piece *b, double ra, double reach, fl_feature_pairs *l, double *distance);

/* The same of a core that is a point, for laws that are not `patch`: the walls that it touches, for which
 * passes must have been made (persistence_contact.h).  *distance is that of the point, where nothing touches. */
int fl_mesh_contact_sphere(fl_patch_points *w, fl_mesh_contact_work *near, const fl_piece *b, double ra,
                           fl_feature_pairs *l, double *distance);

/* The point, in the frame of b, lies behind a surface that has no rim. */
int fl_mesh_contact_contains(const fl_piece *b, fl_vec3 x);

/* How far any point of the core may move before a wall that bears little or nothing bears more: until the
 * core is in it by part^2 of the largest overlap, or by `part` deeper than it was; ra at the most [m].  The
 * vertices v are those of core a in the frame of b.  -1 when memory runs out. */
double fl_mesh_contact_free_travel(fl_mesh_contact_work *near, const fl_vec3 *v, const fl_poly *a,
                                   const fl_piece *b, double ra, double overlap, double part);

/* The gap between the hull of the vertices v of core a, in the frame of b, and the surface: 1 where it is
 * below `within`, overlap set where a face of the surface cuts the core; else 0.  What is held has its
 * distance with the other sign, and n looks out.  -1 when memory runs out. */
int fl_mesh_contact_gap(fl_mesh_contact_work *near, const fl_vec3 *v, const fl_poly *a, const fl_piece *b,
                        double within, fl_gap *out);

void fl_mesh_contact_work_free(fl_mesh_contact_work *near);

#endif
