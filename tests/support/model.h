/* SPDX-License-Identifier: GPL-3.0-or-later */
/* model.h -- a small finite-element body that can be written in every format; and its surface, found by
 * comparing every face with every other one. */
#ifndef FL_TESTS_MODEL_H
#define FL_TESTS_MODEL_H
#include <stdint.h>
#include "geom/surface.h"
#include "mesh/elements.h"

enum { MODEL_NODES = 200, MODEL_ELEMENTS = 80, MODEL_PARTS = 2 };

typedef struct {
    enum fl_shape shape;
    int32_t part;
    int64_t id;
    int64_t node[20]; /* numbers, in the order of mesh/elements.h */
} model_element;

typedef struct {
    int32_t nodes, elements;
    int64_t id[MODEL_NODES]; /* sparse, not in order */
    fl_vec3 x[MODEL_NODES];
    model_element e[MODEL_ELEMENTS];
    const char *part[MODEL_PARTS]; /* "leg", "deck" */
} model;

/* A leg and a deck in the shape of an L with a sheared, uneven grid, of
 *     FL_HEX8 FL_WEDGE6 FL_TET4 FL_PYRAMID5 FL_HEX20 FL_WEDGE15 FL_TET10   solids
 *     FL_QUAD4 FL_TRI3                                             the shells of its surface, outward
 * Coordinates are multiples of 1/16, so that any format holds them. */
void model_make(model *m, enum fl_shape shape);

/* The surface of the model: one part for each of its parts, of those faces of solids that no other solid
 * has, outward.  Quadrilaterals are split by fl_facet_polygon(), mid-side nodes dropped. */
void model_surface(const model *m, fl_surface *s);

/* True if two surfaces have the same triangles in parts of the same names.  Triangles are compared by the
 * coordinates of their corners, in any order and from any first corner, with the same winding. */
int model_same(const fl_surface *a, const fl_surface *b);

#endif
