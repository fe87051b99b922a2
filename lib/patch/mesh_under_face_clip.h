/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_under_face_clip.h -- facets of a mesh that s = 0 or a side of F cuts (mesh_under_face_sum.h).  The
 * parts that count are split into triangles and integrated four at a time. */
#ifndef FL_PATCH_MESH_UNDER_FACE_CLIP_H
#define FL_PATCH_MESH_UNDER_FACE_CLIP_H
#include "patch/mesh_under_face_sum.h"

/* Force on F from the motion of its sides over du (mesh_under_face.h), and its moment about the origin of F,
 * along x, y and n. */
typedef struct {
    fl_vec3 f, m;
} fl_under_face_side_force;

/* Adds the parts of facets list[k], k < count.  normal: of the faces of the mesh.  *most rises to the largest
 * s. */
void fl_under_face_sum_clipped(const fl_under_face *g, const fl_under_face_facet *facet,
                               const int32_t *corner, const fl_vec3 *normal, const fl_under_face_cut *list,
                               int32_t count, fl_under_face_sums *sum, fl_under_face_side_force *pull,
                               double *most);

#endif
