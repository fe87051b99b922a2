/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bvh.h -- bounding volume hierarchy over n boxes: finds those that overlap a given box.  The ratio of box
 * sizes does not matter, since a large box lies high in the tree and is not copied into small cells. */
#ifndef FL_BROAD_BVH_H
#define FL_BROAD_BVH_H
#include <stdint.h>
#include "base/err.h"
#include "geom/aabb.h"

typedef struct {
    fl_aabb box;
    int32_t first,
        count; /* leaf: order[first .. first + count); inner node: count = 0, children first and first + 1 */
} fl_bvh_node;

typedef struct {
    fl_bvh_node *node;
    int32_t *order; /* [n] */
    int32_t n, nodes, node_cap, order_cap;
} fl_bvh;

/* (Re)builds the tree over box[n].  A node is split in two halves at the median of its box centres along the
 * longest side, ties by index, so the tree is a function of the boxes alone.  O(n log n).
 * Returns 0, or -1 with FL_SYSTEM. */
int fl_bvh_build(fl_bvh *t, const fl_aabb *box, int32_t n, fl_err *err);

/* Same without the boxes k < m where absent[k] is not 0; absent NULL: all boxes. */
int fl_bvh_build_present(fl_bvh *t, const fl_aabb *box, int32_t n, int32_t m, const uint8_t *absent,
                         fl_err *err);

/* Writes the indices k with box[k] overlapping q (touching counts) to out[0 .. room), in no particular order.
 * Returns their number, which may exceed room; the caller then enlarges out and repeats.  Cannot fail. */
int32_t fl_bvh_query(const fl_bvh *t, const fl_aabb *box, fl_aabb q, int32_t *out, int32_t room);

/* True if some box[k] overlaps q. */
int fl_bvh_meets(const fl_bvh *t, const fl_aabb *box, fl_aabb q);

/* Traversal of the boxes about a point, the nearer half of each node first. */
enum { FL_BVH_STACK = 64 };
typedef struct {
    const fl_bvh *tree;
    const fl_aabb *box;
    fl_vec3 x;
    int32_t at, end; /* range of the leaf */
    int32_t top, stack[FL_BVH_STACK];
} fl_bvh_walk;

fl_bvh_walk fl_bvh_walk_from(const fl_bvh *t, const fl_aabb *box, fl_vec3 x);

/* The next box within the given distance of the point, each once, or -1.  For the nearest object, reduce
 * `within` from call to call; INFINITY accepts any. */
int32_t fl_bvh_walk_next(fl_bvh_walk *w, double within);

void fl_bvh_free(fl_bvh *t);

#endif
