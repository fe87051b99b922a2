/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "broad/bvh.h"

/* Halving n < 2^31 ends after 30 levels, each of which leaves one node on the stack. */
_Static_assert(FL_BVH_STACK > 32, "room for a way down");

enum {
    LEAF_MAX = 4,
    TASK_MIN = 4096 /* fewest boxes of a task */
};

static double twice_centre(const fl_aabb *b, int axis)
{
    return axis == 0 ? b->lo.x + b->hi.x : axis == 1 ? b->lo.y + b->hi.y : b->lo.z + b->hi.z;
}

static int centre_before(const fl_aabb *box, int axis, int32_t a, int32_t b)
{
    const double ca = twice_centre(&box[a], axis), cb = twice_centre(&box[b], axis);
    return ca < cb || (ca == cb && a < b);
}

/* Hoare's selection: moves the element of rank mid of order[lo .. hi) to its place. */
static void select_median(const fl_aabb *box, int axis, int32_t *order, int32_t lo, int32_t mid, int32_t hi)
{
    while (hi - lo > 1) {
        const int32_t pivot = order[lo + (hi - lo) / 2];
        int32_t i = lo, j = hi - 1;
        while (i <= j) {
            while (centre_before(box, axis, order[i], pivot)) i++;
            while (centre_before(box, axis, pivot, order[j])) j--;
            if (i <= j) {
                const int32_t swap = order[i];
                order[i++] = order[j];
                order[j--] = swap;
            }
        }
        if (mid <= j) hi = j + 1;
        else if (mid >= i) lo = i;
        else return;
    }
}

/* Number of nodes below a node of n boxes; *other is that of n + 1 boxes.  The halves of n differ by at most
 * one, so each level needs only these two numbers. */
static int32_t nodes_below(int32_t n, int32_t *other)
{
    int32_t less, more; /* of n / 2 and n / 2 + 1 boxes */
    if (n < LEAF_MAX) { /* also n + 1 <= LEAF_MAX */
        *other = 0;
        return 0;
    }
    less = nodes_below(n / 2, &more);
    *other = 2 + (n % 2 ? 2 * more : less + more);
    return n <= LEAF_MAX ? 0 : 2 + (n % 2 ? less + more : 2 * less);
}

/* Splits a node.  Large halves become tasks; the position of a node follows from the numbers of boxes. */
static void split_node(fl_bvh *t, const fl_aabb *box, int32_t at, int32_t first, int32_t count, int32_t child)
{
    fl_aabb all = aabb_empty(), mids = aabb_empty();
    for (int32_t k = first; k < first + count; k++) {
        const fl_aabb *b = &box[t->order[k]];
        all = aabb_join(all, *b);
        mids = aabb_add(mids, v3(twice_centre(b, 0), twice_centre(b, 1), twice_centre(b, 2)));
    }
    t->node[at] = (fl_bvh_node){all, first, count};
    if (count <= LEAF_MAX) return;
    const fl_vec3 side = v3_sub(mids.hi, mids.lo);
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    const int32_t half = count / 2;
    int32_t more;
    const int32_t next = child + 2 + nodes_below(half, &more);
    select_median(box, axis, t->order, first, first + half, first + count);
    t->node[at].first = child;
    t->node[at].count = 0;
#pragma omp task if (count > TASK_MIN)
    split_node(t, box, child, first, half, child + 2);
    split_node(t, box, child + 1, first + half, count - half, next);
}

int fl_bvh_build(fl_bvh *t, const fl_aabb *box, int32_t n, fl_err *err)
{
    return fl_bvh_build_present(t, box, n, 0, NULL, err);
}

int fl_bvh_build_present(fl_bvh *t, const fl_aabb *box, int32_t n, int32_t m, const uint8_t *absent,
                         fl_err *err)
{
    int32_t present = 0;
    if (fl_grow(&t->order, &t->order_cap, n, sizeof *t->order, err)) return -1;
    for (int32_t k = 0; k < n; k++)
        if (!absent || k >= m || !absent[k]) t->order[present++] = k;
    t->n = present;
    int32_t more;
    const int32_t nodes = present > 0 ? 1 + nodes_below(present, &more) : 0;
    t->nodes = 0;
    if (fl_grow(&t->node, &t->node_cap, nodes, sizeof *t->node, err)) return -1;
    t->nodes = nodes;
    if (present == 0) return 0;
#pragma omp parallel if (present > TASK_MIN)
#pragma omp single
    split_node(t, box, 0, 0, present, 1);
    return 0;
}

int32_t fl_bvh_query(const fl_bvh *t, const fl_aabb *box, fl_aabb q, int32_t *out, int32_t room)
{
    int32_t stack[FL_BVH_STACK], top = 0, found = 0;
    if (t->nodes) stack[top++] = 0;
    while (top > 0) {
        const fl_bvh_node *node = &t->node[stack[--top]];
        if (!aabb_overlap(node->box, q)) continue;
        if (node->count == 0) {
            stack[top++] = node->first;
            stack[top++] = node->first + 1;
            continue;
        }
        for (int32_t k = node->first; k < node->first + node->count; k++) {
            if (!aabb_overlap(box[t->order[k]], q)) continue;
            if (found < room) out[found] = t->order[k];
            found++;
        }
    }
    return found;
}

int fl_bvh_meets(const fl_bvh *t, const fl_aabb *box, fl_aabb q)
{
    int32_t stack[FL_BVH_STACK], top = 0;
    if (t->nodes) stack[top++] = 0;
    while (top > 0) {
        const fl_bvh_node *node = &t->node[stack[--top]];
        if (!aabb_overlap(node->box, q)) continue;
        for (int32_t k = node->first; k < node->first + node->count; k++)
            if (aabb_overlap(box[t->order[k]], q)) return 1;
        if (node->count == 0) {
            stack[top++] = node->first;
            stack[top++] = node->first + 1;
        }
    }
    return 0;
}

fl_bvh_walk fl_bvh_walk_from(const fl_bvh *t, const fl_aabb *box, fl_vec3 x)
{
    fl_bvh_walk w;
    w.tree = t, w.box = box, w.x = x;
    w.at = w.end = w.top = 0;
    if (t->nodes) w.stack[w.top++] = 0;
    return w;
}

int32_t fl_bvh_walk_next(fl_bvh_walk *w, double within)
{
    const fl_bvh *t = w->tree;
    const double far2 = within * within;
    for (;;) {
        while (w->at < w->end) {
            const int32_t k = t->order[w->at++];
            if (aabb_distance2(w->box[k], w->x) <= far2) return k;
        }
        if (w->top == 0) return -1;
        const fl_bvh_node *node = &t->node[w->stack[--w->top]];
        if (aabb_distance2(node->box, w->x) > far2) continue;
        if (node->count) {
            w->at = node->first, w->end = node->first + node->count;
            continue;
        }
        const int32_t one = node->first;
        const int second =
            aabb_distance2(t->node[one + 1].box, w->x) < aabb_distance2(t->node[one].box, w->x);
        w->stack[w->top++] = second ? one : one + 1;
        w->stack[w->top++] = second ? one + 1 : one;
    }
}

void fl_bvh_free(fl_bvh *t)
{
    free(t->node);
    free(t->order);
    *t = (fl_bvh){0};
}
