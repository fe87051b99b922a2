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

enum {
    FL_KEEP_ANGLES = 1, /* those that are sharp go where eight at most are not: fl_poly_edge_angle() and
                         * fl_poly_corner_angle() tell them all; without, nobody may ask for an angle */
    FL_KEEP_OFFSETS = 2 /* else c becomes NULL */
};

/* Let p have first, loop, edge, begin and beside of t, which has to outlive it, and give back its own.
 *   keep  FL_KEEP_..., of what there is
 * -1 with FL_SYSTEM, p as it was. */
int fl_topologies_share(fl_topologies *t, fl_poly *p, unsigned keep, fl_err *err);

/* What they take of memory. */
double fl_topologies_bytes(const fl_topologies *t);

void fl_topologies_free(fl_topologies *t);

#endif
