/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_under_face_sum.h -- which features of a mesh lie under a plane face F, and the sums over them of
 * mesh_under_face.h: triangles that are whole under F, edges and corners, four at a time.  Faces that s = 0
 * or a side of F cuts are in mesh_under_face_clip.h.
 *
 * Coordinates in the plane of F are x, y; the height h is over F, against its normal n.  s = R - h;
 * s = R - h/c for the part of F over a face f of the mesh, c = -n.n_f. */
#ifndef FL_PATCH_MESH_UNDER_FACE_SUM_H
#define FL_PATCH_MESH_UNDER_FACE_SUM_H
#include "base/simd.h"
#include "geom/vec3.h"

/* A side of F in its plane: a point and the inward unit normal. */
typedef struct {
    double x, y, nx, ny;
} fl_under_face_side;

/* A vertex under F: position, height and least distance within a side of F, negative outside [m]. */
typedef struct {
    double x, y, h, clear;
} fl_under_face_vertex;

/* F and the vertices under it; arrays by vertex, padded to full registers [m]. */
typedef struct {
    fl_vec3 o, x, y, n; /* origin, axes */
    double R, rim;      /* reach, width of the fading rim [m] */
    const fl_under_face_side *side;
    int32_t sides, vertices;
    fl_under_face_vertex *vertex;
    double *within; /* distance of vertex v within side c: within[(c/4 vertices + v) 4 + c%4] */
} fl_under_face;

/* Distances of vertex v within side c and the sides after it, up to the fourth of its group. */
FL_SIMD_INLINE double *fl_under_face_inset(const fl_under_face *g, int32_t c, int32_t v)
{
    return g->within + ((int64_t)(c / FL_SIMD_WIDTH) * g->vertices + v) * FL_SIMD_WIDTH + c % FL_SIMD_WIDTH;
}

/* Fraction of the rim width of F: a corner nearer to a side is not assigned to either side of it. */
#define FL_UNDER_FACE_TOL 1e-6
/* The same for edges and corners, which the neighbour of F tests separately.  An edge that crosses a side and
 * whose ends are farther off than this is cut at the same point by both faces, within 1e-11 of its length. */
#define FL_UNDER_FACE_EDGE_TOL 1e-3

/* Status of a feature: left to face_integral.h and edge_integral.h. */
enum { FL_UNDER_FACE_SKIPPED = 1 };

/* Face f of the mesh; its corners corner[first .. first + n); the pairs of F over f and of f over F in the
 * list, -1 where not listed. */
typedef struct {
    int32_t f, first, n, pair[2];
} fl_under_face_facet;

/* Four facets: their normals by axes; corner k of the four at first + 4 k.  A facet with fewer corners than
 * `most`, or a missing one, repeats its first. */
typedef struct {
    double n[3][FL_SIMD_WIDTH];
    int32_t first, most;
} fl_under_face_facet_four;

/* An edge: its ends, its pair in the list, fl_edge_integral_factor(). */
typedef struct {
    int32_t v[2], pair;
    double factor;
} fl_under_face_edge;

/* The part lo to hi, in [0, 1], of an edge. */
typedef struct {
    int32_t v[2];
    double factor, lo, hi;
} fl_under_face_edge_part;

/* A corner of the mesh: its vertex, its pair in the list, the factor of s^5 in U. */
typedef struct {
    int32_t v, pair;
    double factor;
} fl_under_face_corner;

/* A facet that is cut, and the sides of F that it may lie over, at most two. */
typedef struct {
    int32_t facet, sides, side[2];
} fl_under_face_cut;

/* Sums by lanes: of u, du and ddu; of f = du, or du/c where F is over f, and of f times s, x, y, xx, xy, yy;
 * the couple along x and y. */
typedef struct {
    fl_simd u, du, ddu, f, s, x, y, xx, xy, yy, couple[2];
} fl_under_face_sums;

/* Facets with a part under F. */
typedef struct {
    int32_t *whole;         /* [wholes] triangles entirely under F, with s > 0 for both integrals */
    fl_under_face_cut *cut; /* [cuts] facets that are cut, or have more corners */
    int32_t wholes, cuts;
    double most; /* rises to the largest s of the triangles */
} fl_under_face_sorted;

/* Fills g->vertex and g->within.  x: coordinates of the vertices by fours: x, y, z. */
void fl_under_face_project(const fl_under_face *g, const double *x);

/* Sorts facet[0 .. count), which are four[0 .. (count + 3)/4), into out, which has space for all.
 *   status[count]   out: FL_UNDER_FACE_SKIPPED or 0
 * Returns 1 if any is skipped. */
int fl_under_face_sort(const fl_under_face *g, const fl_under_face_facet *facet,
                       const fl_under_face_facet_four *four, const int32_t *corner, int32_t count,
                       fl_under_face_sorted *out, uint8_t *status);

/* Finds the parts of edges under F with s > 0; out has space for all.
 *   end    by fours: the first ends of four edges, then their second ones; the last edge is repeated
 * Returns 1 if any is skipped. */
int fl_under_face_sort_edges(const fl_under_face *g, const fl_under_face_edge *edge, const int32_t *end,
                             int32_t count, fl_under_face_edge_part *out, int32_t *parts, uint8_t *status);

/* Adds triangles facet[list[k]], k < count, that are whole under F.  normal: of the faces of the mesh. */
void fl_under_face_sum_whole(const fl_under_face *g, const fl_under_face_facet *facet, const int32_t *corner,
                             const fl_vec3 *normal, const int32_t *list, int32_t count,
                             fl_under_face_sums *sum);

/* Adds parts of edges.  *most rises to the largest s. */
void fl_under_face_sum_edges(const fl_under_face *g, const fl_under_face_edge_part *part, int32_t count,
                             fl_under_face_sums *sum, double *most);

/* Adds corners corner[list[k]], which have s > 0.  *most as above. */
void fl_under_face_sum_corners(const fl_under_face *g, const fl_under_face_corner *corner,
                               const int32_t *list, int32_t count, fl_under_face_sums *sum, double *most);

#endif
