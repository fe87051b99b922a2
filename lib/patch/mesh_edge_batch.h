/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_edge_batch.h -- edges of a core A over triangles and edges of a surface B, and edges of B over edges of A: the
 * places of edge_integral.h, four matches at a time.
 *
 * Heights over the planes, what of an edge is beyond all of them, and its foot on the other edge are found
 * by registers; a match that is left with something has its places as in edge_integral.h.  Each has them by itself
 * and in the order of the list: not a bit depends on what else is listed. */
#ifndef FL_PATCH_MESH_EDGE_BATCH_H
#define FL_PATCH_MESH_EDGE_BATCH_H
#include "patch/feature_pairs.h"

typedef struct fl_mesh_edge_four fl_mesh_edge_four;

/* Zeroed to start. */
typedef struct {
    fl_mesh_edge_four *four;
    int32_t n, cap;
} fl_mesh_edge_batch;

/* Take out of the matches l of A and B, whose rows begin at row[l->n], those of these kinds: taken[l->n] is
 * set to `mark` where it was 0.  -1 when memory runs out. */
int fl_mesh_edge_batch_list(fl_mesh_edge_batch *h, const fl_feature_pairs *l, const int32_t *row,
                            const fl_patch_core *A, const fl_patch_core *B, uint8_t *taken, uint8_t mark);

/* Their places now, added to w, where A has been entered; `behind` as in feature_pairs.h.  -1 when memory runs out.
 */
int fl_mesh_edge_batch_evaluate(const fl_mesh_edge_batch *h, fl_patch_points *w, const fl_patch_core *A,
                                const fl_patch_core *B, double R, double behind);

void fl_mesh_edge_batch_free(fl_mesh_edge_batch *h);

#endif
