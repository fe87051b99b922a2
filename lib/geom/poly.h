/* SPDX-License-Identifier: GPL-3.0-or-later */
/* poly.h -- convex polyhedra: vertices, faces, edges, planes.  Degenerate cases: a point (nv = 1), a segment
 * (nv = 2), a flat polygon (two faces of opposite orientation). */
#ifndef FL_GEOM_POLY_H
#define FL_GEOM_POLY_H
#include <stdint.h>
#include "base/err.h"
#include "geom/aabb.h"
#include "geom/mat3.h"
#include "geom/vec3.h"

typedef struct {
    int32_t a, b;        /* vertices, a < b */
    int32_t left, right; /* faces: a to b runs counter-clockwise about left; -1 for the edge of a segment */
} fl_edge;

/* bend     angle between the outward normals of the two faces of an edge
 * defect   2 pi less the angles of the faces at the vertex (Gauss); 2 pi for the end of a segment, 4 pi for a
 *          point
 * concave_face[k]: for the side that begins at loop[k], if the two faces bend inward by less than 60 degrees
 * saddle[k]: for the edge to neighbour[k].  Both borrowed; nonconvex surfaces only
 * (structure/structure.h). */
typedef struct {
    int32_t nv, nf, ne;
    int16_t shared;      /* first, loop, edge, neighbour_first and neighbour are borrowed (topology.h) */
    int16_t kept_angles; /* number of angles stored where bend and defect are NULL */
    fl_vec3 *v;          /* [nv] vertices; start of the block that holds all arrays that are not shared [m] */
    fl_vec3 *n;          /* [nf] outward unit normals */
    double *c;           /* [nf] plane offsets, n.x = c, largest over the face's vertices [m]; or NULL */
    int32_t *first;      /* [nf + 1] offsets into loop */
    int32_t *loop;       /* [first[nf]] vertices of each face, counter-clockwise from outside */
    fl_edge *edge;       /* [ne] sorted by (a, b) */
    double *bend;        /* [ne] exterior dihedral angle, 0 .. pi; 2 pi for a segment [rad]; or NULL */
    double *defect;      /* [nv] solid angle of the normal cone, the angle defect [sr]; NULL if bend is */
    int32_t *neighbour_first; /* [nv + 1] offsets into neighbour */
    int32_t *neighbour;       /* [neighbour_first[nv]] other ends of the edges of each vertex, ascending */
    double size;              /* largest side of the bounding box [m] */
    int32_t *concave_face;    /* [first[nf]] the face across a concave side, or -1; NULL: none */
    uint8_t *saddle;          /* [neighbour_first[nv]] 1: a convex edge at a nonconvex vertex; NULL: none */
} fl_poly;

/* Builds a polyhedron from copied input; derives planes, edges and size.  The tolerance is 1e-9 size, and at
 * least the rounding of doubles at that distance from the origin.  Checks:
 *   - every face has three distinct vertices and an area, is flat and convex, and faces outward
 *   - edges pair up, once in each direction (closed); every vertex is used
 *   - one surface of the topology of a sphere (V - E + F = 2) that covers its body once
 *   - convexity: no vertex lies outside any face by more than the tolerance
 * Above 65536 vertex-face pairs convexity is tested edge by edge: no edge is concave by more than the
 * tolerance, an inner point lies behind every face, and a ray from it leaves through one face only.  For
 * exact planes this proves convexity in linear time (Mehlhorn et al., Computational Geometry 12, 1999).  With
 * the tolerance, a vertex may lie outside a distant face by as many tolerances as there are faces between.
 * Adjacent faces may share a plane, and corners may be straight.  nv = 1 and nv = 2 require nf = 0, first and
 * loop are not read; a flat polygon has two faces.
 *   v[nv]                            [m]
 *   first[nf + 1], loop[first[nf]]   as in fl_poly
 * Returns 0, or -1 with FL_SYSTEM, or FL_INPUT and a message ("face 3 is turned inside out", "vertex 5 lies
 * 0.02 m outside face 2: the core is not convex", ...); p is untouched on failure. */
int fl_poly_make(fl_poly *p, int32_t nv, const fl_vec3 *v, int32_t nf, const int32_t *first,
                 const int32_t *loop, fl_err *err);

/* The box |x| <= h.x, |y| <= h.y, |z| <= h.z; h > 0. */
int fl_poly_box(fl_poly *p, fl_vec3 h, fl_err *err);

/* The prism over a convex polygon xy[n] (counter-clockwise; z ignored) between z0 < z1.  Vertices 0 .. n-1
 * are the lower ones, n .. 2n-1 the upper.  Face 0 is the bottom, face 1 the top, face 2 + k stands on the
 * side from corner k to k + 1.  Fails as fl_poly_make(). */
int fl_poly_prism(fl_poly *p, int32_t n, const fl_vec3 *xy, double z0, double z1, fl_err *err);

/* A deep copy; to is overwritten, not freed.  -1 with FL_SYSTEM, to untouched. */
int fl_poly_copy(fl_poly *to, const fl_poly *from, fl_err *err);

/* Frees all but v, first and loop, the contents of a file, at a third of the memory.  Then ne is 0, the other
 * arrays are NULL and size stays.  -1 with FL_SYSTEM, p untouched. */
int fl_poly_strip(fl_poly *p, fl_err *err);

/* Area vector of face f: area times outward normal [m^2]; unaffected by large offsets. */
fl_vec3 fl_poly_face_area_vector(const fl_poly *p, int32_t f);

/* Area of the largest face, 0 without faces [m^2]. */
double fl_poly_largest_face_area(const fl_poly *p);

/* Computes bend, defect, neighbour_first and neighbour from the rest.  On nonconvex surfaces bend is negative
 * for concave edges, and pi for edges with one face. */
void fl_poly_angles(fl_poly *p);

/* bend[e], computed from the planes. */
double fl_poly_compute_bend(const fl_poly *p, int32_t e);

/* Changes the frame in place: x becomes transpose(axes) (x - o).  o becomes the origin; the columns of axes,
 * which must be a rotation, become the axes. */
void fl_poly_to_frame(fl_poly *p, fl_vec3 o, fl_mat3 axes);

/* Contact depends on the angle of blunt edges and vertices.  All with larger angles than these count
 * alike. */
#define FL_POLY_BLUNT_EDGE 0.25  /* [rad] */
#define FL_POLY_BLUNT_CORNER 0.5 /* [sr]  */

/* The angle of edge k, or of vertex k - ne, among the few stored behind n (angles first, then their numbers);
 * `sharp` if it is not stored. */
static inline double fl_poly_kept_angle(const fl_poly *p, int32_t k, double sharp)
{
    const double *angle = (const double *)(const void *)(p->n + p->nf);
    const int32_t *of = (const int32_t *)(const void *)(angle + p->kept_angles);
    for (int32_t c = 0; c < p->kept_angles; c++)
        if (of[c] == k) return angle[c];
    return sharp;
}

/* bend[e], or a value of at least FL_POLY_BLUNT_EDGE if bend[e] is not smaller. */
static inline double fl_poly_edge_angle(const fl_poly *p, int32_t e)
{
    return p->bend ? p->bend[e] : fl_poly_kept_angle(p, e, FL_POLY_BLUNT_EDGE);
}

/* defect[v], or a value of at least FL_POLY_BLUNT_CORNER if defect[v] is not smaller. */
static inline double fl_poly_corner_angle(const fl_poly *p, int32_t v)
{
    return p->defect ? p->defect[v] : fl_poly_kept_angle(p, p->ne + v, FL_POLY_BLUNT_CORNER);
}

/* Memory of the arrays [bytes]. */
double fl_poly_bytes(const fl_poly *p);

fl_aabb fl_poly_aabb(const fl_poly *p);
void fl_poly_free(fl_poly *p); /* accepts a zeroed struct, leaves one */

#endif
