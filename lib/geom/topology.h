/* SPDX-License-Identifier: GPL-3.0-or-later */
/* topology.h -- which vertices make edges and faces, kept once for all polyhedra that are alike in it: prisms
 * over polygons of as many corners, boxes, points. */
#ifndef FL_GEOM_TOPOLOGY_H
#define FL_GEOM_TOPOLOGY_H
#include "geom/poly.h"

/* One of them: edge, first, loop, begin and beside of a polyhedron, one behind the other. */
typedef struct {
    uint64_t key;
    int32_t nv, nf, ne, bytes;
    void *mem;
} fl_topology;

/* Zeroed to start. */
typedef struct {
    fl_topology *kind; /* [n] */
    int32_t *slot;     /* [slots] 1 + a kind, at its key or behind it; 0: none */
    int32_t n, slots, kind_cap;
} fl_topologies;

/* Let p have first, loop, edge, begin and beside of t, which has to outlive it, and give back its own.
 *   angles  0: bend and defect as well, which become NULL, and nobody may ask for an angle; 1: those of them
 *           that are not blunt, where eight at most are: fl_poly_edge() and fl_poly_corner() tell them all
 * -1 with FL_SYSTEM, p as it was. */
int fl_topologies_share(fl_topologies *t, fl_poly *p, int angles, fl_err *err);

/* What they take of memory. */
double fl_topologies_bytes(const fl_topologies *t);

void fl_topologies_free(fl_topologies *t);

#endif
