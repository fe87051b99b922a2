/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quick_shape.h -- what the law `quick` (quick_law.h) reads of a core, computed once: planes, inset faces,
 * edges and weights.
 *
 * Each face has a plane n.x = height with the axes t1, t2, and sides with outward normals q in that plane,
 * q.x <= c on the face.  The inset face ends at q.x <= c - inset: its border lies FL_QUICK_INSET radii of the
 * own body inside, or a quarter of what the shortest side allows, as the fading rim of `patch` does on
 * average. */
#ifndef FL_PATCH_QUICK_SHAPE_H
#define FL_PATCH_QUICK_SHAPE_H
#include "geom/poly.h"

#define FL_QUICK_INSET 0.1 /* over the dilation radius */
#define FL_QUICK_INSET_SHARE                                                                                 \
    0.25 /* most, of l/(tan a + tan b) of a side l, a and b half its exterior angles */

typedef struct {
    fl_vec3 n, t1, t2;
    double height;        /* n.x on the plane      [m]  */
    double area;          /*                       [m2] */
    int32_t first, sides; /* into loop and side; side k runs from loop[first + k] to the next corner */
} fl_quick_face;

typedef struct {
    fl_vec3 q;
    double qx, qy;     /* q in t1, t2 */
    double c, inset_c; /* q.x on the side, and on that of the inset face [m] */
} fl_quick_side;

typedef struct {
    fl_vec3 a, d;  /* one end and unit vector to the other */
    double length; /* [m] */
    double weight; /* 1, less for a blunt edge */
    int32_t face[2];
    int32_t end[2]; /* vertices */
} fl_quick_edge;

typedef struct {
    int32_t vertices, edges, faces, loops;
    double radius; /* dilation radius [m] */
    double bound;  /* largest distance of a vertex from the origin [m] */
    fl_vec3 *vertex;
    double *weight; /* [vertices] 1, less for a blunt corner */
    fl_quick_edge *edge;
    fl_quick_face *face;
    int32_t planes;   /* faces, rounded up to whole registers */
    double *plane[4]; /* [planes] of each face n and height, at infinite height those that fill up */
    int32_t *loop;
    double *corner[3]; /* [loops + 4] coordinates of the corners, the other way round within each face */
    fl_quick_side *side;
    void *block; /* owns all arrays */
} fl_quick_shape;

/* Makes the table of a core with faces.  -1 with FL_SYSTEM. */
int fl_quick_shape_make(fl_quick_shape *s, const fl_poly *p, double radius, fl_err *err);
double fl_quick_shape_bytes(const fl_quick_shape *s);
void fl_quick_shape_free(fl_quick_shape *s); /* accepts a zeroed struct */

#endif
