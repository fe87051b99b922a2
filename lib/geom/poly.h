/* SPDX-License-Identifier: GPL-3.0-or-later */
/* poly.h -- convex polyhedra: vertices, faces, edges, planes.  A point (nv = 1), a segment (nv = 2) and a
 * flat polygon (two faces, one the other turned round) are polyhedra too. */
#ifndef FL_GEOM_POLY_H
#define FL_GEOM_POLY_H
#include <stdint.h>
#include "base/err.h"
#include "geom/aabb.h"
#include "geom/mat3.h"
#include "geom/vec3.h"

typedef struct {
    int32_t a, b;        /* vertices, a < b */
    int32_t left, right; /* faces: a to b runs counter-clockwise round left; -1 for the edge of a segment */
} fl_edge;

typedef struct {
    int32_t nv, nf, ne;
    int16_t shared;      /* first, loop, edge, begin and beside are borrowed (topology.h) */
    int16_t kept_angles; /* angles that are kept where bend and defect are NULL            */
    fl_vec3 *v;     /* [nv] vertices; the block that they begin holds all arrays that are not shared [m] */
    fl_vec3 *n;     /* [nf] outward unit normals                                    */
    double *c;      /* [nf] plane offsets, n.x = c, largest over the face's vertices [m]; or NULL */
    int32_t *first; /* [nf + 1] offsets into loop                                   */
    int32_t *loop;  /* [first[nf]] vertices of each face, counter-clockwise from outside */
    fl_edge *edge;  /* [ne], sorted by (a, b)                                       */
    double *bend;   /* [ne] angle between the outward normals of the two faces, in [0, pi]; 2 pi round a
                      * segment                                                    [rad]; or NULL */
    double *defect; /* [nv] solid angle of the outward directions at the vertex: 2 pi less the angles of its
                      * faces there (Gauss), 2 pi for the end of a segment, 4 pi for a point [sr]; NULL: so */
    int32_t *neighbour_first; /* [nv + 1] offsets into beside                                 */
    int32_t *neighbour;       /* [begin[nv]] the other ends of the edges of each vertex, ascending */
    double size;              /* largest side of the bounding box                          [m] */
    int32_t *
        concave_face; /* of a surface that is not convex (structure/structure.h), borrowed: [first[nf]] the face
                      * over the side that begins in loop[k], where the two bend inward by less than 60
                      * degrees, or -1; NULL: nowhere */
    uint8_t *saddle; /* of such, borrowed: [begin[nv]] 1 where the edge to beside[k] bends outward and its
                      * vertex is not convex; NULL: nowhere */
} fl_poly;

/* Build from copied input; derives planes, edges and size.  The tolerance is 1e-9 size, and never below what
 * doubles so far from the origin can hold.  Checked: every face has three distinct vertices and an area, is
 * flat and convex; faces look outward; edges pair up, once each way (closed); every vertex is used; one
 * surface, of the kind of a sphere (V - E + F = 2), that covers its body once; and the whole is convex: no
 * vertex stands outside any face by more than the tolerance.  Above 65536 vertex-face pairs that is shown
 * edge by edge instead: no edge bends inward by more than the tolerance, an inner point lies behind every
 * face, and a ray from it leaves through one face only.  For exact planes that proves convexity, in linear
 * time (Mehlhorn et al., Computational Geometry 12, 1999); with the tolerance, a vertex may stand out of a
 * distant face by as many tolerances as there are faces between.
 * Neighbouring faces may share a plane and corners may be straight.  nv = 1 and nv = 2 take nf = 0, and first
 * and loop are not read; a flat polygon takes two faces.
 *   v[nv]                            [m]
 *   first[nf + 1], loop[first[nf]]   as in fl_poly
 * Returns 0, or -1 with FL_SYSTEM, or FL_INPUT and a sentence ("face 3 is turned inside out", "vertex 5 lies
 * 0.02 m outside face 2: the core is not convex", ...); p is untouched on failure. */
int fl_poly_make(fl_poly *p, int32_t nv, const fl_vec3 *v, int32_t nf, const int32_t *first,
                 const int32_t *loop, fl_err *err);

/* The box |x| <= h.x, |y| <= h.y, |z| <= h.z; h > 0. */
int fl_poly_box(fl_poly *p, fl_vec3 h, fl_err *err);

/* The prism over a convex polygon xy[n] (counter-clockwise; z ignored) between z0 < z1.  Vertices 0 .. n-1
 * are the lower ones, n .. 2n-1 the upper; face 0 looks down, face 1 up, face 2 + k stands on the side from
 * corner k to k + 1.  Fails as fl_poly_make(). */
int fl_poly_prism(fl_poly *p, int32_t n, const fl_vec3 *xy, double z0, double z1, fl_err *err);

/* A copy of its own; to is overwritten, not freed.  -1 with FL_SYSTEM, to untouched. */
int fl_poly_copy(fl_poly *to, const fl_poly *from, fl_err *err);

/* Let go of all but corners and faces, v, first and loop: what a file holds, at a third of the memory.  ne is
 * 0 then, the other arrays are NULL and size stays.  -1 with FL_SYSTEM, p untouched. */
int fl_poly_strip(fl_poly *p, fl_err *err);

/* The area vector of face f, area times outward normal [m^2]; exact under far offsets of the whole. */
fl_vec3 fl_poly_face_area_vector(const fl_poly *p, int32_t f);

/* The area of the largest face, 0 without any [m^2]. */
double fl_poly_largest_face_area(const fl_poly *p);

/* Fill bend, defect, begin and beside from the rest; bend is negative for edges that bend inward, which only
 * surfaces that are not convex have, and pi for those with one face. */
void fl_poly_angles(fl_poly *p);

/* bend[e], computed anew. */
double fl_poly_compute_bend(const fl_poly *p, int32_t e);

/* Move and turn in place: x becomes transpose(axes) (x - o), so that o becomes the origin and the columns of
 * axes, which must be a rotation, become the axes. */
void fl_poly_to_frame(fl_poly *p, fl_vec3 o, fl_mat3 axes);

/* Contact asks how blunt an edge or a vertex is, and counts all alike that are sharper than so much. */
#define FL_POLY_BLUNT_EDGE 0.25  /* [rad] */
#define FL_POLY_BLUNT_CORNER 0.5 /* [sr]  */

/* The angle of edge k, or of vertex k - ne, one of a few that are kept behind n, the numbers behind them; or
 * `sharp` where it is none of those. */
static inline double fl_poly_kept_angle(const fl_poly *p, int32_t k, double sharp)
{
    const double *angle = (const double *)(const void *)(p->n + p->nf);
    const int32_t *of = (const int32_t *)(const void *)(angle + p->kept_angles);
    for (int32_t c = 0; c < p->kept_angles; c++)
        if (of[c] == k) return angle[c];
    return sharp;
}

/* bend[e], or at least FL_POLY_BLUNT_EDGE where it is no less. */
static inline double fl_poly_edge_angle(const fl_poly *p, int32_t e)
{
    return p->bend ? p->bend[e] : fl_poly_kept_angle(p, e, FL_POLY_BLUNT_EDGE);
}

/* defect[v], or at least FL_POLY_BLUNT_CORNER where it is no less. */
static inline double fl_poly_corner_angle(const fl_poly *p, int32_t v)
{
    return p->defect ? p->defect[v] : fl_poly_kept_angle(p, p->ne + v, FL_POLY_BLUNT_CORNER);
}

/* What its arrays take of memory. */
double fl_poly_bytes(const fl_poly *p);

fl_aabb fl_poly_aabb(const fl_poly *p);
void fl_poly_free(fl_poly *p); /* accepts a zeroed struct, leaves one */

#endif
