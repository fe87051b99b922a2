/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_contact.h -- contact of a dilated convex core with a surface that is not convex.
 *
 * The potential is that of patch_points.h, summed over the prisms over all faces, the wedges over convex
 * edges and the cones over the corners; seams between coplanar triangles do not count. At a concave edge of
 * less than 60 degrees, points and edges count over the nearer of its faces (feature_pairs.c). In a sharper
 * inner corner every wall acts independently. A vertex behind the surface has one distance, to the nearest
 * face. A point whose nearest point lies on the rim of an open surface is beside it, not behind. An open
 * surface is one-sided: a vertex is behind it if the surface lies between it and the middle of the core. One
 * that has come round the rim, or from the back, is not. A sheet with two sides (region.h) is a thin closed
 * surface; a vertex is beyond it if the sheet lies between it and the middle of the core. Spheres have a law
 * of their own (persistence_contact.h). */
#ifndef FL_STRUCTURE_MESH_CONTACT_H
#define FL_STRUCTURE_MESH_CONTACT_H
#include "structure/structure.h"
#include "patch/mesh_under_face.h"
#include "narrow/gjk.h"

/* Scratch: faces and edges in reach, and what lies under a face. */
typedef struct {
    fl_feature_set of_mesh, of_core;
    fl_persistence_work persistence;
    fl_mesh_under_face_work under_face;
    uint8_t *is_free; /* set by the caller: 1 for the cones of a joined piece that do not count as facets */
    int32_t free_cap;
} fl_mesh_contact_work;

/* Contact points of core a (radius ra) on the mesh of piece b, as fl_patch_points_find(), after
 * fl_patch_points_transform(). *distance is a lower bound of the distance of the core from the surface: reach
 * if no face is that near, else ra.
 *   reach   search distance, >= ra [m]
 *   l       feature pairs of the pair, as in fl_patch_points_find()
 * Returns -1 when memory runs out. */
int fl_mesh_contact_points(fl_patch_points *w, fl_mesh_contact_work *near, const fl_poly *a,
                           const fl_piece *b, double ra, double reach, fl_feature_pairs *l, double *distance);

/* Adds the points of a part of a joined piece with cones to those of w: of the facets of cone `only`, or with
 * only = -1 of all but the facets of cones marked in near->is_free.  l: of the pair, which keeps a list for
 * each part. Returns -1 when memory runs out. */
int fl_mesh_contact_add_points(fl_patch_points *w, fl_mesh_contact_work *near, const fl_poly *a,
                               const fl_piece *b, double ra, int32_t only, fl_feature_pairs *l);

/* Reserves near->is_free[n].  Returns -1 when memory runs out. */
int fl_mesh_contact_reserve_cones(fl_mesh_contact_work *near, int32_t n);

/* Sets *distance to reach if nothing of the piece is within reach. */
void fl_mesh_contact_bound(const fl_patch_points *w, const fl_poly *a, const fl_piece *b, double reach,
                           double *distance);

/* The same for a core that is a point, for laws other than `patch`: the walls that the sphere touches. Needs
 * the seams of persistence_contact.h. *distance is that of the point if nothing touches. */
int fl_mesh_contact_sphere(fl_patch_points *w, fl_mesh_contact_work *near, const fl_piece *b, double ra,
                           fl_feature_pairs *l, double *distance);

/* Lists in l->candidate the faces that may be the nearest of a sphere about x, in the frame of b, until it
 * has moved by `way` [m].  Returns 1 if it can touch a single wall until then, or nothing; 0 if not; -1 when
 * memory runs out. */
int fl_mesh_contact_single_wall(fl_mesh_contact_work *near, const fl_piece *b, fl_vec3 x, double ra,
                                double way, fl_feature_pairs *l);

/* The largest distance of facets that fl_mesh_contact_sphere() gives as it is for a sphere that has no list
 * yet; of a larger one it takes off what facets may be off [m]. */
double fl_mesh_contact_known_distance(const fl_piece *b, double ra);

/* True if the point, in the frame of b, lies behind a surface without a rim. */
int fl_mesh_contact_contains(const fl_piece *b, fl_vec3 x);

/* How far any point of the core may move before a wall with little or no load bears more: until it overlaps
 * the core by part^2 of the largest overlap, or by `part` more than now; at most ra [m]. v: the vertices of
 * core a in the frame of b. Returns -1 when memory runs out. */
double fl_mesh_contact_free_travel(fl_mesh_contact_work *near, const fl_vec3 *v, const fl_poly *a,
                                   const fl_piece *b, double ra, double overlap, double part);

/* Gap between the hull of the vertices v of core a, in the frame of b, and the surface. Returns 1 if it is
 * below `within`, with overlap set if a face of the surface cuts the core; else 0. A core enclosed by the
 * surface has a negative distance, and n points out. Returns -1 when memory runs out. */
int fl_mesh_contact_gap(fl_mesh_contact_work *near, const fl_vec3 *v, const fl_poly *a, const fl_piece *b,
                        double within, fl_gap *out);

void fl_mesh_contact_work_free(fl_mesh_contact_work *near);

#endif
