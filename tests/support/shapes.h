/* SPDX-License-Identifier: GPL-3.0-or-later */
/* shapes.h -- random convex bodies for property tests; the same generator state gives the same body. */
#ifndef FL_TESTS_SHAPES_H
#define FL_TESTS_SHAPES_H
#include "base/rng.h"
#include "geom/poly.h"
#include "geom/quat.h"

/* Every maker fills a fl_poly that the caller frees; it ends the program with a message where it cannot. */

/* Half sides 10^u, u uniform in [lo, hi]. */
void shape_random_box(fl_poly *p, fl_rng *g, double lo, double hi);

/* An upright prism over a convex polygon of 3 to 8 corners on an ellipse: radius in [0.5, 2] m, height
 * 0.02 to 1 times that. */
void shape_random_prism(fl_poly *p, fl_rng *g);

/* A box of random sides in [0.5, 2] m cut by up to `cuts` random planes that keep its middle. */
void shape_random_polytope(fl_poly *p, fl_rng *g, int cuts);

/* A thin one: a plate or a needle, side ratio 10 to 1000, with a corner or two cut off. */
void shape_random_sliver(fl_poly *p, fl_rng *g);

/* One of the above at random. */
void shape_random(fl_poly *p, fl_rng *g);

/* A regular tetrahedron, octahedron (4, 8 faces) or icosahedron (20) with vertices at distance r. */
void shape_regular(fl_poly *p, int faces, double r);

/* Uniform over all directions, and over all rotations. */
fl_vec3 shape_direction(fl_rng *g);
fl_quat shape_rotation(fl_rng *g);

/* Rotates by q, then translates by d. */
void shape_move(fl_poly *p, fl_quat q, fl_vec3 d);

/* q applied to x, scaled by s, translated by d, as a new polyhedron made from scratch. */
void shape_copy_moved(fl_poly *to, const fl_poly *from, double s, fl_quat q, fl_vec3 d);

#endif
