/* SPDX-License-Identifier: GPL-3.0-or-later */
/* feature_filter.h -- which features of one core can lie in the Voronoi region of which features of the
 * other, and within reach of it.
 *
 * The region of a face, an edge or a vertex is bounded by planes (feature_pairs.h).  A feature of the own
 * core is rejected by the distances of its vertices from these planes:
 *   - a vertex that is below one of the planes,
 *   - a face that has no corner above one of the planes,
 *   - an edge that has no point above all planes.
 * Each distance is tested with a margin, by which points may move until the next test.  Planes that all
 * vertices of a feature clear by more than a second margin need not be tested until then: they are marked. */
#ifndef FL_PATCH_FEATURE_FILTER_H
#define FL_PATCH_FEATURE_FILTER_H
#include "patch/patch_types.h"

/* Features of `own` are tested against features of `other`. */
typedef struct {
    const fl_patch_core *own, *other;
    double R;           /* reach [m] */
    double prism_depth; /* how far below a face its prism extends [m] */
    double margin;      /* [m] */
    double max_cosine;  /* face pairs with a larger n_own.n_other are rejected */
    /* A vertex beyond a side plane by more than side_margin stays beyond it [m]; < 0: nothing is marked.
     * Farther than margin_radius from `centre` the margin grows in proportion to the distance. */
    double side_margin;
    double margin_radius; /* [m] */
    fl_vec3 centre;
} fl_feature_query;

/* Result and scratch.  Zeroed to start; grows as needed.
 *
 * hit[o * others + k] is for own feature o (vertices, edges, faces, numbered as in `mine`) and feature k of
 * `near` (faces, edges, vertices).  Own faces are tested against faces alone.  0: rejected; else bit 0, and
 * bit 1 + i where side plane i need not be tested, i < 31.  Side planes count in this order: sides of a face;
 * ends, left and right of an edge; edges of a vertex. */
typedef struct {
    uint32_t *hit;
    int32_t others;
    /* scratch: vertices of the own features, their coordinates by axes, distances, margins, planes */
    int32_t *vertex, *at, *corner, *first;
    double *x, *h, *room;
    struct fl_filter_plane *plane;
    int32_t hit_cap, vertex_cap, at_cap, corner_cap, first_cap, x_cap, h_cap, room_cap, plane_cap;
} fl_feature_filter;

/* True if side plane i need not be tested. */
static inline int fl_feature_side_redundant(uint32_t hit, int32_t i) { return i < 31 && (hit >> 1 >> i & 1); }

/* Tests every feature of `mine` against every feature of `near`.  -1 when memory runs out. */
int fl_feature_filter_find(fl_feature_filter *w, const fl_feature_query *s, const fl_feature_set *mine,
                           const fl_feature_set *near);

void fl_feature_filter_free(fl_feature_filter *w);

#endif
