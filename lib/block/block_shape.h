/* SPDX-License-Identifier: GPL-3.0-or-later */
/* block_shape.h -- a convex block whose faces remember the plane that made them, and its split by a plane.
 *
 * fl_poly_cut() keeps one side.  A split keeps both, and the corners of the cut have the same bits on both
 * sides and in every block that has the same edge: the ends of an edge are put in order before the division.
 * */
#ifndef FL_BLOCK_BLOCK_SHAPE_H
#define FL_BLOCK_BLOCK_SHAPE_H
#include <stdint.h>
#include "geom/aabb.h"
#include "geom/poly.h"

typedef struct {
    int32_t nv, nf;
    int32_t group; /* index of its group, -1: none */
    uint64_t key;  /* of the planes that made it and its side of each; independent of their order */
    fl_aabb box;
    fl_vec3 *v;     /* [nv] corners; start of the memory of all arrays [m] */
    int32_t *first; /* [nf + 1] offsets into loop */
    int32_t *tag;   /* [nf] 2 plane + side, side 1: the block lies where n.x > c; -1: surface of the model */
    int32_t *loop;  /* [first[nf]] corners of each face, counter-clockwise from outside */
} fl_block_shape;

/* The box lo .. hi; all tags -1. */
int fl_block_shape_box(fl_block_shape *s, fl_vec3 lo, fl_vec3 hi, fl_err *err);

/* Splits a by the plane n.x = c with that number.  Corners within tol of it lie on it.
 *   part[2]  out, if split: where n.x < c, and where n.x > c.  Faces keep their order, the cut is the last
 * Returns 1, 0 if all of a lies on one side (nothing is made), or -1 with FL_SYSTEM, or FL_NUMERIC where the
 * cut does not close. */
int fl_block_shape_split(const fl_block_shape *a, fl_vec3 n, double c, int32_t plane, double tol,
                         fl_block_shape part[2], fl_err *err);

/* Outward unit normal and offset of face f, from its area vector. */
fl_vec3 fl_block_face_normal(const fl_block_shape *s, int32_t f, double *c);
double fl_block_face_area(const fl_block_shape *s, int32_t f);

/* Volume [m3]; *centre: the centroid, may be NULL. */
double fl_block_shape_volume(const fl_block_shape *s, fl_vec3 *centre);

/* The least distance between a face and the corner farthest from it: the width of the block, at most a little
 * less where two edges face each other [m]. */
double fl_block_shape_width(const fl_block_shape *s);

/* The block as a polyhedron, faces in their order.  Corners closer than fl_poly_make() can tell apart are
 * merged and faces that vanish are left out; face[nf] (may be NULL): the number of each face in out, -1 if it
 * vanished. Returns 1, 0 if the block is too thin for a polyhedron, or -1 with FL_SYSTEM. */
int fl_block_shape_poly(const fl_block_shape *s, fl_poly *out, int32_t *face, fl_err *err);

void fl_block_shape_free(fl_block_shape *s); /* accepts a zeroed struct, leaves one */

/* Memory for a shape of that size; arrays are set, contents are not. */
int fl_block_shape_alloc(fl_block_shape *s, int64_t nv, int64_t nf, int64_t loops, fl_err *err);

/* Sets the bounding box from the corners. */
void fl_block_shape_bound(fl_block_shape *s);

/* A mixing of 64 bits, for keys. */
static inline uint64_t fl_block_mix(uint64_t x)
{
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

#endif
