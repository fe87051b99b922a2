/* SPDX-License-Identifier: GPL-3.0-or-later */
/* feature_filter.h -- which features of one core can come to lie over which of the other, and within reach of it.
 *
 * Over a face, an edge or a vertex is where some planes say so (feature_pairs.h), so that the heights of a few
 * vertices over a few planes tell it of all features at once: of a vertex none may be below, of a face one
 * corner must be above each, of an edge a point must be above all of them.  Each height has room for a
 * margin, by which points may move.  The same heights tell what stays above a plane while they do: nobody has
 * to ask for that again. */
#ifndef FL_PATCH_FEATURE_FILTER_H
#define FL_PATCH_FEATURE_FILTER_H
#include "patch/patch_types.h"

/* What is asked: features of `own`, with the reach R above the other's, `behind` below its faces, and the
 * margin [m]; faces whose normals meet by an angle whose cosine is not above `turned`. */
typedef struct {
    const fl_patch_core *own, *other;
    double R, prism_depth, margin, max_cosine;
    double
        side_margin; /* what is farther beyond a side stays beyond it; < 0: of a surface, where nothing does [m] */
    double
        margin_radius; /* from `centre`: what is beyond it by so many times may move by so many times the room */
    fl_vec3 centre;
} fl_feature_query;

/* Zeroed to start; grows as it must.  hit[o * others + k]: own feature o, vertices first, then edges, then
 * faces, as they are numbered in `mine`, may come over feature k of `near`, faces first, then edges, then
 * vertices.  Faces are asked about faces alone.  0: it does not; 1: it may; and 2 << i: all of it stays
 * beyond side i, one of the first 31, in the order of the sides of a face, of the ends, the left and the
 * right of an edge, or of the edges of a vertex. */
typedef struct {
    uint32_t *hit;
    int32_t others;
    /* in work: vertices of the own features, their coordinates one after the other, and heights */
    int32_t *vertex, *at, *corner, *first;
    double *x, *h, *room;
    struct fl_bound *bound;
    int32_t hit_cap, vertex_cap, at_cap, corner_cap, first_cap, x_cap, h_cap, room_cap, bound_cap;
} fl_feature_filter;

/* Side i of what was hit is one that all of it stays beyond. */
static inline int fl_feature_side_redundant(uint32_t hit, int32_t i) { return i < 31 && (hit >> 1 >> i & 1); }

/* -1 when memory runs out. */
int fl_feature_filter_find(fl_feature_filter *w, const fl_feature_query *s, const fl_feature_set *mine,
                           const fl_feature_set *near);

void fl_feature_filter_free(fl_feature_filter *w);

#endif
