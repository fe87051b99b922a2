/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plane_distances.h -- evaluates listed feature pairs: the patch points that they have in the present pose.
 *
 * It tabulates the distances of the listed vertices from the listed planes, one table for features of A over
 * features of B and one for the converse.  The part of a feature that lies on the right side of all planes of
 * its pair goes to patch_law.h (vertex), edge_integral.h (edge) or face_integral.h (face). */
#ifndef FL_PATCH_PLANE_DISTANCES_H
#define FL_PATCH_PLANE_DISTANCES_H
#include "patch/feature_pairs.h"

/* Adds the patch points of all listed pairs to w, after A has been transformed (fl_patch_points_transform(),
 * fl_feature_pairs_transform()).
 *   R             reach: sum of the dilation radii and the penetration [m]
 *   prism_depth   how far below a face its prism extends [m]
 *   rim_a, rim_b  widths of the fading rims of the faces of A and of B [m]
 * -1 when memory runs out. */
int fl_feature_pairs_evaluate(fl_patch_points *w, const fl_feature_pairs *l, const fl_patch_core *A,
                              const fl_patch_core *B, double R, double prism_depth, double rim_a,
                              double rim_b);

#endif
