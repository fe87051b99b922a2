/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quick_list.h -- which features of two cores may have a term in the law `quick` (quick_law.h) while no point
 * has moved by more than a margin.
 *
 * A list may hold features without a term; terms are summed in the order of the features, so no bit of a
 * result depends on when the list was built. */
#ifndef FL_PATCH_QUICK_LIST_H
#define FL_PATCH_QUICK_LIST_H
#include "geom/mat3.h"
#include "patch/list_range.h"
#include "patch/quick_shape.h"

#define FL_QUICK_SEGMENT 16.0 /* longest part of an edge that four points stand for, over rho */

#define FL_QUICK_ALONG 0.01 /* sine of the angle of edges up to which they do not cross at all */

/* For direction 0 (features of A over B) and 1 (of B over A):
 *     vertex    own vertices
 *     segment   own edge, part of it, number of parts; edges with a term in the order of edges
 *     pair      own face, other face
 *     face, edge  of the other core, from which the distance is taken
 * and once: crossing, edge of A and edge of B. */
enum fl_quick_section {
    FL_QUICK_VERTEX,
    FL_QUICK_SEGMENTS,
    FL_QUICK_PAIR,
    FL_QUICK_FACE,
    FL_QUICK_EDGE,
    FL_QUICK_KINDS,
    FL_QUICK_CROSSING = 2 * FL_QUICK_KINDS,
    FL_QUICK_SECTIONS
};

/* Zeroed to start: no list. */
typedef struct {
    int32_t *index;                       /* all sections, one behind the other */
    int32_t first[FL_QUICK_SECTIONS + 1]; /* where they begin in index */
    int32_t n, cap;
    fl_mat3 M; /* pose of A when the list was built */
    fl_vec3 o;
    /* valid while |o - o0|^2 < max_shift2 [m2] and |M - M0|^2 < max_turn2; 0: invalid */
    double max_shift2, max_turn2;
    double margin;     /* [m] */
    int64_t uses;      /* evaluations since it was built */
    uint8_t separated; /* set by the caller: the cores do not overlap while the list is valid */
} fl_quick_list;

static inline const int32_t *fl_quick_section_of(const fl_quick_list *l, int section, int32_t *n)
{
    *n = l->first[section + 1] - l->first[section];
    return l->index + l->first[section];
}

/* rho: radius of a feature of a core of dilation radius r against one of radius `other` [m], and the number
 * of segments of an edge. */
static inline double fl_quick_feature_radius(double r, double other) { return r > 0.0 ? r : other; }
static inline int32_t fl_quick_segments(const fl_quick_edge *e, double rho)
{
    const double n = ceil(e->length / (FL_QUICK_SEGMENT * rho));
    return n > 1.0 ? (int32_t)n : 1;
}

/* Margin of the next list [m], as fl_feature_pairs_margin(). */
double fl_quick_list_margin(const fl_quick_list *l, double R);

/* Builds the list of two cores within reach R in the pose M, o of A.  -1 when memory runs out. */
int fl_quick_list_build(fl_quick_list *l, const fl_quick_shape *a, const fl_quick_shape *b, double ra,
                        double rb, double R, fl_mat3 M, fl_vec3 o, double margin);

/* True if the list is valid in the pose M, o; counts an evaluation. */
static inline int fl_quick_list_valid(fl_quick_list *l, const fl_mat3 *M, fl_vec3 o)
{
    if (!fl_pose_in_range(M, o, &l->M, l->o, l->max_shift2, l->max_turn2)) return 0;
    l->uses++;
    return 1;
}

double fl_quick_list_bytes(const fl_quick_list *l);
void fl_quick_list_free(fl_quick_list *l); /* accepts a zeroed struct */

#endif
