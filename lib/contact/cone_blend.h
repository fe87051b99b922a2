/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cone_blend.h -- contact points of a polyhedron with a cone, part exact and part those of its frustum.
 *
 * Near its ends a cone is a frustum (structure/structure.h).  With the weight w of free_cone.h,
 *     U = (1 - w) U_frustum + w U_cone ,
 * and since w depends on the pose, a force along the axis and a couple besides, so that W is a potential.
 * In a joined piece (structure/region.h) that holds for each cone where it is free, and the rest of the
 * mesh counts as it is. */
#ifndef FL_CONTACT_CONE_BLEND_H
#define FL_CONTACT_CONE_BLEND_H
#include "patch/patch_types.h"
#include "structure/free_cone.h"
#include "structure/mesh_contact.h"

/* Weight of the exact cone, and the derivatives by the height of the centre of A [1/m] and by a rotation of A
 * [1/rad]. */
typedef struct {
    double weight, slope;
    fl_vec3 turn;
} fl_cone_blend;

/* Weight of a cone that is a piece by itself; M, o: pose of A in the frame of the cone, R its radius [m]. */
fl_cone_blend fl_cone_blend_of(const fl_piece *cone, const fl_poly *a, const fl_mat3 *M, fl_vec3 o, double R);

/* Blends the points from `exact` on, of the cone, with those from `first` on, of the polyhedron, and
 * s->couple, of the cone, with `couple`, of the polyhedron.  centre: of A.  All in the frame of the cone.
 * -1 when memory runs out. */
int fl_cone_blend_points(fl_patch_points *s, int32_t first, int32_t exact, fl_vec3 couple,
                         const fl_cone_blend *of, fl_vec3 centre);

/* Finds the points on a joined piece with cones, as fl_mesh_contact_points().
 *   M, o   pose of A in the frame of the piece
 *   size   bounding radius of A [m] */
int fl_joined_find_points(fl_patch_points *s, fl_mesh_contact_work *near, const fl_poly *a,
                          const fl_piece *piece, const fl_mat3 *M, fl_vec3 o, double size, double ra,
                          double reach, fl_feature_pairs *l, double *distance);

#endif
