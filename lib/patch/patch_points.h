/* SPDX-License-Identifier: GPL-3.0-or-later */
/* patch_points.h -- finds the patch points of two dilated convex cores, or of a core and a plane.
 *
 * It lists the feature pairs that may contribute (feature_pairs.h), keeps that list for many steps, and
 * evaluates the listed pairs: faces by face_integral.h, edges by edge_integral.h, vertices by patch_law.h. */
#ifndef FL_PATCH_PATCH_POINTS_H
#define FL_PATCH_PATCH_POINTS_H
#include "narrow/penetration.h"
#include "patch/patch_law.h"
#include "patch/patch_types.h"

/* Transforms the vertices and normals of A to the frame of B: va = M v + o, na = M n.  -1 when memory runs
 * out. */
int fl_patch_points_transform(fl_patch_points *w, const fl_poly *a, fl_mat3 M, fl_vec3 o);

/* Finds all patch points of two cores, in a fixed order, after fl_patch_points_transform(). a, b    cores in
 * their own frames ra, rb  dilation radii [m] n       unit vector from B to A in the frame of B.  It only
 * excludes features: the points do not depend
 *           on it.  Fast where it separates the cores by nearly their distance.
 * deep    penetration of the cores, depth 0 where they do not overlap; n is its direction then l
 * feature pairs of this contact, rebuilt when they are out of date Cores that penetrate by D are evaluated as
 * if A were shifted by D n, with s = R + D - d.  The derivatives of D and of n add points of their own.  -1
 * when memory runs out. */
int fl_patch_points_find(fl_patch_points *w, const fl_poly *a, const fl_poly *b, double ra, double rb,
                         fl_vec3 n, const fl_penetration *deep, fl_feature_pairs *l);

/* The same for a valid list l with l->separated set; A is transformed here, by M and o. */
int fl_patch_points_find_listed(fl_patch_points *w, const fl_poly *a, const fl_poly *b, double ra, double rb,
                                fl_mat3 M, fl_vec3 o, const fl_feature_pairs *l);

/* Finds all patch points of A on the half-space z < 0 of the frame of B.  *distance: least z of A's core. */
int fl_patch_points_on_plane(fl_patch_points *w, const fl_poly *a, double ra, double *distance);

void fl_patch_points_free(fl_patch_points *w);

#endif
