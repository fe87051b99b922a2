/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bvh.h -- a tree of boxes over n boxes: which of them meet a given box.  Works alike for any ratio of
 * sizes, since a large box sits high in the tree and is not copied into small cells. */
#ifndef FL_BROAD_BVH_H
#define FL_BROAD_BVH_H
#include <stdint.h>
#include "base/err.h"
#include "geom/aabb.h"

typedef struct {
    fl_aabb box;
    int32_t first,
        count; /* leaf: order[first .. first + count); inner node: count = 0, children first, first + 1 */
} fl_bvh_node;

typedef struct {
    fl_bvh_node *node;
    int32_t *order; /* [n] */
    int32_t n, nodes, node_cap, order_cap;
} fl_bvh;

/* (Re)build over box[n].  Splits the boxes of a node in two halves at the median of their centres along the
 * longest side, ties by index: the tree is a function of the boxes alone.  O(n log n).
 * Returns 0, or -1 with FL_SYSTEM in err. */
int fl_bvh_build(fl_bvh *t, const fl_aabb *box, int32_t n, fl_err *err);

/* The same without the boxes k < m where absent[k] is not 0; absent NULL: with all. */
int fl_bvh_build_present(fl_bvh *t, const fl_aabb *box, int32_t n, int32_t m, const uint8_t *absent,
                         fl_err *err);

/* Indices k with box[k] meeting q (touching counts), in no particular order, into out[0 .. room); returns how
 * many there are, which may exceed room: then the caller makes room and asks again.  Cannot fail. */
int32_t fl_bvh_query(const fl_bvh *t, const fl_aabb *box, fl_aabb q, int32_t *out, int32_t room);

/* A walk over the boxes about a point, the nearer half of each node first. */
enum { FL_BVH_STACK = 64 };
typedef struct {
    const fl_bvh *tree;
    const fl_aabb *box;
    fl_vec3 x;
    int32_t at, end; /* of the leaf */
    int32_t top, stack[FL_BVH_STACK];
} fl_bvh_walk;

fl_bvh_walk fl_bvh_walk_from(const fl_bvh *t, const fl_aabb *box, fl_vec3 x);

/* The next one no farther from the point than that, each once, or -1.  Who looks for the nearest thing lets
 * the distance fall from call to call; INFINITY: any. */
int32_t fl_bvh_walk_next(fl_bvh_walk *w, double within);

void fl_bvh_free(fl_bvh *t);

#endif
