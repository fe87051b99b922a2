/* SPDX-License-Identifier: GPL-3.0-or-later */
/* edges.h -- the triangles of a part that meet in each of its edges. */
#ifndef FL_GEOM_EDGES_H
#define FL_GEOM_EDGES_H
#include "geom/surface.h"

/* A side of a triangle.  The ends of an edge are ordered by index; the half-edge lies in the bucket of the
 * lower end. */
typedef struct {
    int32_t hi, t; /* the higher end, and the triangle */
    int8_t k, up;  /* side k of the triangle; up = 1: it runs from the lower end */
} fl_half_edge;

typedef struct {
    int64_t *first;     /* [nv + 1] half-edges first[v] .. first[v + 1) have the lower end v */
    fl_half_edge *side; /* [3 nt]; those of an edge are consecutive, in the order of triangles */
} fl_edges;

/* Builds the edges of all triangles without a repeated index.  0, or -1 with FL_SYSTEM and nothing to
 * free. */
int fl_edges_make(fl_edges *e, const fl_part *p, fl_err *err);
void fl_edges_free(fl_edges *e); /* accepts a zeroed struct, leaves one */

/* End of the edge of side[from]: side[from .. to) are its half-edges.  v is its lower end. */
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
