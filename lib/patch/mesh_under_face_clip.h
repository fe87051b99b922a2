/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_under_face_clip.h -- faces of a surface that s = 0 or a side of F cuts (mesh_under_face_sum.h): the
 * parts of them that count, as triangles, and sums over those, four triangles at a time. */
#ifndef FL_PATCH_MESH_UNDER_FACE_CLIP_H
#define FL_PATCH_MESH_UNDER_FACE_CLIP_H
#include "patch/mesh_under_face_sum.h"

/* Force on F of what moves with its sides, and the moment about the origin, along x, y and n. */
typedef struct {
    fl_vec3 f, m;
} fl_under_face_side_force;

/* Faces list[k], k < count, of which a part may count; normal: of the surface.  *most rises to the largest s.
 */
void fl_under_face_sum_clipped(const fl_under_face *g, const fl_under_face_facet *tile, const int32_t *corner,
                               const fl_vec3 *normal, const fl_under_face_cut *list, int32_t count,
                               fl_under_face_sums *sum, fl_under_face_side_force *pull, double *most);

#endif
