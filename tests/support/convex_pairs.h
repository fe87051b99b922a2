/* SPDX-License-Identifier: GPL-3.0-or-later */
/* convex_pairs.h -- pairs of convex bodies at all distances, for tests of lib/narrow: ordinary ones and
 * adversarial ones. */
#ifndef FL_TESTS_CONVEX_PAIRS_H
#define FL_TESTS_CONVEX_PAIRS_H
#include <stdint.h>
#include "narrow/penetration.h"

typedef struct {
    fl_poly p[2];
    fl_vec3 *v[2], *n[2]; /* world vertices and normals */
    fl_solid a, b;
    double size;  /* sum of the largest sides of the two bounding boxes [m] */
    double sharp; /* shortest edge of either body over the size of its body */
} pair_case;

enum pair_kind { PAIR_ORDINARY, PAIR_HOSTILE, PAIR_DEEP, PAIR_LARGE };

/* Case k of a seed.
 * ORDINARY: boxes, prisms, frusta, tetrahedra, octahedra, polygons, segments, points of proportions up to
 * 1:10, in random orientations, with b at a gap of 1e-9 to 1e+3 sizes (or a penetration) along a random
 * direction or a face normal of a.
 * HOSTILE: shapes on an integer lattice with faces, edges and vertices that coincide or are parallel;
 * tilted by 0 or 1e-16 to 1e-3; plates and needles 100:1 to 1000:1; edges of 1e-9; the same body twice;
 * both translated by 1e6 sizes; exact contact.
 * DEEP: ordinary shapes that penetrate, their origins up to a fifth of the size apart.
 * LARGE: ellipsoids and prisms of 4 to 10 000 vertices, plates 100:1 and needles among them, near and far
 * as the ordinary ones, some flush, some 1e6 sizes from the origin.
 * Tests of pairs that once failed refer to cases by number, so a new shape is a new kind.  Returns 0; -1
 * when memory ran out or the shape was refused (message on stderr). */
int pair_make(pair_case *q, uint64_t seed, int64_t k, enum pair_kind kind);
void pair_free(pair_case *q);

/* A pair of two given shapes in their own axes; takes ownership of the shapes.  -1 when memory ran out. */
int pair_take(pair_case *q, fl_poly a, fl_poly b);

/* An ellipsoid of half axes axis: poles on z, and rings of corners between them.  Returns as pair_make(). */
int pair_ellipsoid(fl_poly *p, int32_t rings, int32_t around, fl_vec3 axis);

/* Sets the world pose of body k (0 or 1): x = o + R v, at unit scale. */
void pair_place(pair_case *q, int k, fl_vec3 o, fl_mat3 r);

#endif
