/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rounded_mesh.h -- triangles of a dilated shape, the Minkowski sum of a convex core and a ball of radius
 * r: faces moved out, strips of cylinders along edges, spherical polygons at vertices, without a crack
 * between them.
 *
 * A vertex of the mesh is v + r n, v a vertex of the core and n a unit normal, which is also its normal
 * for light.  An arc between two face normals is cut into `cuts` parts; chords lie inside, so that the
 * volume is below that of fl_dilate_volume() and converges with cuts^2.  cuts = 0: faces alone, with gaps
 * at the edges. */
#ifndef FL_VIEW_ROUNDED_MESH_H
#define FL_VIEW_ROUNDED_MESH_H
#include "out/frame_data.h"

typedef struct {
    float x[3], n[3];
} fl_mesh_vertex;

typedef struct {
    fl_mesh_vertex *v;
    int32_t nv, v_cap;
    uint32_t *t; /* [3 nt] vertices, counter-clockwise from outside */
    int32_t nt, t_cap;
} fl_rounded_mesh;

/* Appends the triangles of a shape: polyhedron, flat polygon, capsule (two vertices) or sphere (one).
 * Faces that do not close are drawn as they are.  -1 with FL_SYSTEM. */
int fl_rounded_mesh_shape(fl_rounded_mesh *m, const fl_frame_data *d, const fl_frame_shape *s, int cuts,
                          fl_err *err);

/* Appends a part of the structure: triangles, with normals shared where they meet below 30 degrees; cones as
 * polygons of so many sides that the chord differs from the arc by `chord` [m], with their ends. */
int fl_rounded_mesh_part(fl_rounded_mesh *m, const fl_part *p, double chord, fl_err *err);

/* Volume that the triangles enclose [m3]. */
double fl_rounded_mesh_volume(const fl_rounded_mesh *m);

void fl_rounded_mesh_free(fl_rounded_mesh *m); /* accepts a zeroed struct, leaves one */

#endif
