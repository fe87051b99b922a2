/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_edge_batch.h -- edge pairs of a core A and a mesh B, evaluated four at a time: edges of A over
 * triangles and edges of B, edges of B over edges of A.
 *
 * The distances from the planes of a pair, the part of the edge beyond all of them and its foot on the other
 * edge are computed in SIMD registers, one pair a lane.  Pairs with a remaining part get their points from
 * edge_integral.h.  The points of a pair do not depend on the other pairs, and they come in the order of the
 * list. */
#ifndef FL_PATCH_MESH_EDGE_BATCH_H
#define FL_PATCH_MESH_EDGE_BATCH_H
#include "patch/feature_pairs.h"

typedef struct fl_mesh_edge_four fl_mesh_edge_four;

/* Zeroed to start. */
typedef struct {
    fl_mesh_edge_four *four;
    int32_t n, cap;
} fl_mesh_edge_batch;

/* Lists the pairs of these kinds in l.
 *   row[l->n]    where the rows of l begin
 *   taken[l->n]  in: pairs with a value other than 0 are left out; out: set to `mark` for those listed here
 * -1 when memory runs out. */
int fl_mesh_edge_batch_list(fl_mesh_edge_batch *h, const fl_feature_pairs *l, const int32_t *row,
                            const fl_patch_core *A, const fl_patch_core *B, uint8_t *taken, uint8_t mark);

/* Adds the points of the listed pairs to w, after A has been transformed.  R, prism_depth: as in
 * plane_distances.h.  -1 when memory runs out. */
int fl_mesh_edge_batch_evaluate(const fl_mesh_edge_batch *h, fl_patch_points *w, const fl_patch_core *A,
                                const fl_patch_core *B, double R, double prism_depth);

void fl_mesh_edge_batch_free(fl_mesh_edge_batch *h);

#endif
