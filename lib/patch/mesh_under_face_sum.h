/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_under_face_sum.h -- what of a surface lies under a plane face F, and sums over it, as
 * mesh_under_face.h has them: faces that are whole under F, edges and corners, four at a time.  What s = 0 or
 * a side of F cuts is in mesh_under_face_clip.h.
 *
 * Heights h are over F, against its normal n; x and y are places in its plane.  s = R - h, and s = R - h/c
 * for what of F lies over a face f, c = -n.n_f. */
#ifndef FL_PATCH_MESH_UNDER_FACE_SUM_H
#define FL_PATCH_MESH_UNDER_FACE_SUM_H
#include "base/simd.h"
#include "geom/vec3.h"

/* A side of F in its plane: a point and the inward unit normal. */
typedef struct {
    double x, y, nx, ny;
} fl_under_face_side;

/* A vertex under F: where it is, its height, and how far it is within the side that it is least within [m].
 */
typedef struct {
    double x, y, h, clear;
} fl_under_face_vertex;

/* F, and what is known of the vertices under it: arrays by their numbers, padded to full registers [m]. */
typedef struct {
    fl_vec3 o, x, y, n; /* origin, axes */
    double R, rim;      /* reach, width of the fading rim [m] */
    const fl_under_face_side *side;
    int32_t sides, vertices;
    fl_under_face_vertex *vertex;
    double *within; /* how far within side c vertex v is: within[(c/4 vertices + v) 4 + c%4] */
} fl_under_face;

/* How far within side c and those after it, up to four. */
FL_SIMD_INLINE double *fl_under_face_inset(const fl_under_face *g, int32_t c, int32_t v)
{
    return g->within + ((int64_t)(c / FL_SIMD_WIDTH) * g->vertices + v) * FL_SIMD_WIDTH + c % FL_SIMD_WIDTH;
}

/* Of the width of the rim of F: what is nearer to a side than that is not told to be on one side of it. */
#define FL_UNDER_FACE_TOL 1e-6
/* The same where the neighbour of F asks by itself, edges and corners: an edge that crosses a side between
 * two ends so far off it is cut by both within 1e-11 of its length in the same place. */
#define FL_UNDER_FACE_EDGE_TOL 1e-3

/* Bits of is[], what has been made of a feature: it must be left to face_integral.h and edge_integral.h. */
enum { FL_UNDER_FACE_SKIPPED = 1 };

/* A face f of the surface: its number, its corners corner[first .. first + n), and the matches of F over f
 * and of f over F, -1 where they are not listed. */
typedef struct {
    int32_t f, first, n, match[2];
} fl_under_face_facet;

/* Four of those in a row: their normals, by axes, and the numbers of their corners, corner k of the four at
 * first + 4 k; a face with fewer than `most`, and one that is not there, has its first again. */
typedef struct {
    double n[3][FL_SIMD_WIDTH];
    int32_t first, most;
} fl_under_face_facet_four;

/* An edge: the numbers of its ends, its match, and fl_edge_integral_factor(). */
typedef struct {
    int32_t v[2], match;
    double factor;
} fl_under_face_edge;

/* A part of one, from lo to hi of its length. */
typedef struct {
    int32_t v[2];
    double factor, lo, hi;
} fl_under_face_edge_part;

/* A corner of the surface: its number, its match, and what s^5 is multiplied by. */
typedef struct {
    int32_t v, match;
    double factor;
} fl_under_face_corner;

/* A face that is cut: its number, and the sides of F that it may be over, at most two. */
typedef struct {
    int32_t tile, sides, side[2];
} fl_under_face_cut;

/* By lanes: of u, du and its derivative; of f = du, or du/c where F is over f, and of f times s, x, y, xx,
 * xy, yy; and the couple along x and y. */
typedef struct {
    fl_simd u, du, ddu, f, s, x, y, xx, xy, yy, couple[2];
} fl_under_face_sums;

/* Faces with something under F: numbers of triangles that are whole under it, with s > 0 both ways, and
 * faces that are cut or have more corners; most: the largest s of the triangles, where that is more. */
typedef struct {
    int32_t *whole;
    fl_under_face_cut *cut;
    int32_t wholes, cuts;
    double most;
} fl_under_face_sorted;

/* Fill the arrays; x: coordinates of the vertices, x, y and z of a register's worth, and so on. */
void fl_under_face_project(const fl_under_face *g, const double *x);

/* Sort tile[0 .. count), which are four[0 .. (count + 3)/4), into out, which has room for them; is[count]:
 * what has been made of each.  Returns whether any is left. */
int fl_under_face_sort(const fl_under_face *g, const fl_under_face_facet *tile,
                       const fl_under_face_facet_four *four, const int32_t *corner, int32_t count,
                       fl_under_face_sorted *out, uint8_t *is);

/* Numbers of what of edges is under F, with s > 0, into out, which has room for all; end: of the edges, the
 * first ends of four and their second ones, and so on, the last again where there are no more. */
int fl_under_face_sort_edges(const fl_under_face *g, const fl_under_face_edge *edge, const int32_t *end,
                             int32_t count, fl_under_face_edge_part *out, int32_t *pieces, uint8_t *is);

/* Triangles tile[list[k]], k < count, that are whole under F; normal: of the surface. */
void fl_under_face_sum_whole(const fl_under_face *g, const fl_under_face_facet *tile, const int32_t *corner,
                             const fl_vec3 *normal, const int32_t *list, int32_t count,
                             fl_under_face_sums *sum);

/* Parts of edges.  *most rises to the largest s. */
void fl_under_face_sum_edges(const fl_under_face *g, const fl_under_face_edge_part *piece, int32_t count,
                             fl_under_face_sums *sum, double *most);

/* Corners corner[list[k]], with s > 0. */
void fl_under_face_sum_corners(const fl_under_face *g, const fl_under_face_corner *corner,
                               const int32_t *list, int32_t count, fl_under_face_sums *sum, double *most);

#endif
