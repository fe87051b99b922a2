/* SPDX-License-Identifier: GPL-3.0-or-later */
/* edges.h -- which triangles of a part meet in each of its edges. */
#ifndef FL_GEOM_EDGES_H
#define FL_GEOM_EDGES_H
#include "geom/surface.h"

/* One side of a triangle.  An edge has two ends, told apart by their indices: the lower is the bucket in
 * which the side lies. */
typedef struct {
    int32_t hi, t; /* the higher end, and the triangle            */
    int8_t k, up;  /* side k of it; 1: it runs up from the lower end */
} fl_half_edge;

typedef struct {
    int64_t *first;     /* [nv + 1] sides first[v] .. first[v + 1) have vertex v as their lower end */
    fl_half_edge *side; /* [3 nt]; those of an edge one behind the other, in the order of triangles */
} fl_edges;

/* Of all triangles but those that repeat an index.  Return 0, or -1 with FL_SYSTEM and nothing to free. */
int fl_edges_make(fl_edges *e, const fl_part *p, fl_err *err);
void fl_edges_free(fl_edges *e); /* accepts a zeroed struct, leaves one */

/* Where the edge of side[from] ends: side[from .. to) are its sides.  v: its lower end. */
static inline int64_t fl_edge_end(const fl_edges *e, int32_t v, int64_t from)
{
    int64_t to = from + 1;
    while (to < e->first[v + 1] && e->side[to].hi == e->side[from].hi) to++;
    return to;
}

static inline int fl_tri_repeats_vertex(const fl_tri *t)
{
    return t->v[0] == t->v[1] || t->v[1] == t->v[2] || t->v[2] == t->v[0];
}

#endif
