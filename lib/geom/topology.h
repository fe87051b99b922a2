/* SPDX-License-Identifier: GPL-3.0-or-later */
/* topology.h -- shared storage of the edges and faces of polyhedra with equal topology: boxes, prisms over
 * polygons with equal numbers of corners, points. */
#ifndef FL_GEOM_TOPOLOGY_H
#define FL_GEOM_TOPOLOGY_H
#include "geom/poly.h"

/* The arrays edge, first, loop, neighbour_first and neighbour of a polyhedron, in one block. */
typedef struct {
    uint64_t key;
    int32_t nv, nf, ne, bytes;
    void *mem;
} fl_topology;

/* Zero-initialised. */
typedef struct {
    fl_topology *kind; /* [n] */
    int32_t *slot;     /* [slots] 1 + index of a topology, at its key or after it; 0: free */
    int32_t n, slots, kind_cap;
} fl_topologies;

enum {
    FL_KEEP_ANGLES = 1, /* the blunt angles if at most eight, else all; without it no angle may be used */
    FL_KEEP_OFFSETS = 2 /* c, which else becomes NULL */
};

/* Replaces first, loop, edge, neighbour_first and neighbour of p by those of t, which must outlive p.
 *   keep  FL_KEEP_...: what to keep.  fl_poly_edge_angle() and fl_poly_corner_angle() read the kept angles
 * -1 with FL_SYSTEM, p unchanged. */
int fl_topologies_share(fl_topologies *t, fl_poly *p, unsigned keep, fl_err *err);

/* Memory of the shared arrays [bytes]. */
double fl_topologies_bytes(const fl_topologies *t);

void fl_topologies_free(fl_topologies *t);

#endif
