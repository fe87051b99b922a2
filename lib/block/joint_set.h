/* SPDX-License-Identifier: GPL-3.0-or-later */
/* joint_set.h -- sets of joints in rock and their planes.
 *
 * A set has a dip below the horizontal, a dip direction clockwise from north (x east, y north, z up) and a
 * spacing:
 *     n = (sin dip sin dd, sin dip cos dd, cos dip),     n.x = n.origin + k spacing,     k whole.
 * With a number N, k = 0 .. N-1 (3DEC centres them about the origin); without one all k that meet the model.
 *
 * Scatter of a plane: its normal by Fisher's law about n with concentration K, density ~ exp(K cos t); the
 * spacing before it normal or log-normal with a given deviation over mean.  Both depend on seed, set and k
 * alone.
 *
 * Persistence p < 1 is meant in one of two ways.  skip: a block that a plane meets is cut with probability p.
 * glue: all are cut, and each pair of faces is a joint with probability p, intact rock otherwise.  A disc of
 * a radius about the origin cuts all blocks as well and leaves pairs of faces outside intact. */
#ifndef FL_BLOCK_JOINT_SET_H
#define FL_BLOCK_JOINT_SET_H
#include <stdint.h>
#include "base/err.h"
#include "geom/aabb.h"

enum { FL_JOINT_NAME = 40 };
enum fl_persistence { FL_PERSISTENCE_SKIP, FL_PERSISTENCE_GLUE };

typedef struct {
    char name[FL_JOINT_NAME];
    double dip, direction; /* [degrees] */
    double spacing;        /* [m]; 0: one plane */
    fl_vec3 origin;        /* [m] */
    int32_t number;        /* 0: all that meet the model */
    double persistence;    /* 0 to 1 */
    int meaning;           /* enum fl_persistence */
    double radius;         /* of a disc [m]; 0: without end */
    double fisher;         /* K; 0: no scatter */
    double deviation;      /* of the spacing, over its mean; 0: none */
    int log_normal;        /* of the spacing */
    int32_t place;         /* position in the order in which they were given */
} fl_joint_set;

/* A plane n.x = c of set `set`, or of the surface of a model or region (set -1). */
typedef struct {
    fl_vec3 n;
    double c; /* [m] */
    int32_t set, number;
} fl_joint_plane;

typedef struct {
    int32_t n, cap;
    fl_joint_set *set;
} fl_joint_sets;

/* Adds a set from "key=value ..." with the keys dip, dd, spacing, origin=X,Y,Z, n, persistence,
 * meaning=skip|glue, radius, fisher, deviation, law=normal|log-normal and name ("joint" and its place without
 * one).  `where` stands before the message.  -1 with FL_INPUT or FL_SYSTEM. */
int fl_joint_sets_add(fl_joint_sets *s, const char *text, const char *where, fl_err *err);

/* Adds the sets of a file: "#joints 1", then one set a row. */
int fl_joint_sets_read(fl_joint_sets *s, const char *path, fl_err *err);

/* Puts the sets into an order that does not depend on the one given: by orientation, spacing, origin, name.
 * */
void fl_joint_sets_sort(fl_joint_sets *s);
void fl_joint_sets_free(fl_joint_sets *s);

/* Unit normal of a set, upward; exact for multiples of 90 degrees. */
fl_vec3 fl_joint_set_normal(const fl_joint_set *s);

/* Plane k of the set with number `set` in the sorted order. */
fl_joint_plane fl_joint_set_plane(const fl_joint_set *s, int32_t set, int32_t k, uint64_t seed);

/* The smallest and largest k whose planes may meet a box, scatter included; first > last: none. */
void fl_joint_set_range(const fl_joint_set *s, int32_t set, fl_aabb box, uint64_t seed, int32_t *first,
                        int32_t *last);

#endif
