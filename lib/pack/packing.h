/* SPDX-License-Identifier: GPL-3.0-or-later */
/* packing.h -- bodies of a packing: centres, orientations, sizes, and the scale that grows.
 *
 * Body i is its shape times size[i] times the scale s, about its centre: of a sphere a ball of radius
 * s radius[i]; of another shape the core s size[i] v, dilated by s radius[i].  In two dimensions bodies are
 * discs of thickness 1 m, all z are 0.
 *
 * The size of a shape is that of the smallest square hole that it passes: its second largest extent along the
 * principal axes of its outer shape.  Of a capsule of length L and diameter d that is d, of a cube its side.
 * Limit: a body passes a slightly smaller hole in another orientation than along its axes. */
#ifndef FL_PACK_PACKING_H
#define FL_PACK_PACKING_H
#include "geom/mass.h"
#include "geom/poly.h"
#include "geom/quat.h"
#include "scene/ice_field.h"

/* A shape of size 1: core about its centroid, in principal axes. */
typedef struct {
    fl_poly core;
    double radius;  /* dilation radius over the size */
    double bound;   /* bounding radius, with the dilation */
    double volume;  /* of the outer sharp shape; round for spheres and capsules */
    double rounded; /* volume by Steiner's formula */
    fl_vec3 half;   /* half extents along the principal axes */
} fl_pack_shape;

typedef struct {
    int32_t n, cap;
    fl_pack_shape *shape;
} fl_pack_shapes;

/* Shapes of the argument of --shapes: "sphere", "capsule:L/D" (total length over diameter, above 1), or a
 * g-polys file, each body of which is a shape.  -1 with FL_USAGE, FL_INPUT (not convex, no volume) or
 * FL_SYSTEM; s is then freed. */
int fl_pack_shapes_make(fl_pack_shapes *s, const char *text, fl_err *err);
int fl_pack_shapes_are_round(const fl_pack_shapes *s); /* all are spheres */
void fl_pack_shapes_free(fl_pack_shapes *s);

typedef struct {
    int dim;
    int32_t n;
    const fl_pack_shapes *shapes; /* borrowed */
    fl_vec3 *x;                   /* [n] [m] */
    fl_quat *q;                   /* [n] of shape to world; NULL where all are spheres */
    int32_t *shape;               /* [n]; NULL where all are spheres */
    double *size;                 /* [n] sieve size at s = 1 [m] */
    double *radius;               /* [n] dilation radius at s = 1 [m] */
    double *bound;                /* [n] bounding radius at s = 1 [m] */
    double s;
} fl_packing;

/* Allocate n bodies of the given sizes, which are copied, with shapes in turn and orientations by the seed.
 * 0, or -1 with FL_SYSTEM. */
int fl_packing_make(fl_packing *p, int dim, int32_t n, const double *size, const fl_pack_shapes *shapes,
                    uint64_t seed, fl_err *err);

/* Put the bodies in an order in which neighbours in space are near each other in memory.  -1 with
 * FL_SYSTEM. */
int fl_packing_sort(fl_packing *p, fl_err *err);

/* Volume of body i at scale s, as below. */
double fl_packing_body_volume(const fl_packing *p, int32_t i, double s, int rounded);

/* Solid volume at scale s [m3], in two dimensions the area [m2]; rounded: by Steiner's formula. */
double fl_packing_volume(const fl_packing *p, double s, int rounded);

/* Corners of the core of body i in the world: room for its shape->core.nv [m]. */
void fl_packing_corners(const fl_packing *p, int32_t i, fl_vec3 *v);

double fl_packing_least(const fl_packing *p); /* smallest and largest bounding radius at s = 1 [m] */
double fl_packing_most(const fl_packing *p);

/* The bodies as an ice field, numbered from 0.  material and group may be NULL.  -1 with FL_SYSTEM. */
int fl_packing_field(const fl_packing *p, const char *material, const char *group, fl_ice_field *out,
                     fl_err *err);

void fl_packing_free(fl_packing *p); /* accepts a zeroed struct, leaves one */

#endif
