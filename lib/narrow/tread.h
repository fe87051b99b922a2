/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tread.h -- sums over what of a surface lies under a plane face F, as footing.h has them: faces that are
 * whole under F, faces that s = 0 or a side of F cuts, and edges, four at a time.
 *
 * Heights h are over F, against its normal n; x and y are places in its plane.  s = R - h, and s = R - h/c
 * for what of F lies over a face f, c = -n.n_f. */
#ifndef FL_NARROW_TREAD_H
#define FL_NARROW_TREAD_H
#include "base/wide.h"
#include "geom/vec3.h"

/* A side of F in its plane: a point and the inward unit normal. */
typedef struct {
    double x, y, nx, ny;
} fl_tread_side;

/* F, and what is known of the vertices under it: arrays by their numbers, padded to full registers [m]. */
typedef struct {
    fl_vec3 o, x, y, n; /* origin, axes */
    double R, rim;      /* reach, width of the fading rim [m] */
    const fl_tread_side *side;
    int32_t sides, vertices;
    double *X, *Y, *h;
    double *within; /* how far within side c vertex v is: within[c vertices + v] */
    double *clear;  /* the least of those */
} fl_tread;

/* A face f of the surface: its number, its corners corner[first .. first + n), and the matches of F over f
 * and of f over F, -1 where they are not listed. */
typedef struct {
    int32_t f, first, n, match[2];
} fl_tread_tile;

/* An edge: the numbers of its ends, its match, and fl_strips_factor(). */
typedef struct {
    int32_t v[2], match;
    double factor;
} fl_tread_edge;

/* A face that is cut: its number, and the sides of F that it may be over, at most two. */
typedef struct {
    int32_t tile, sides, side[2];
} fl_tread_cut;

/* By lanes: of u, du and its derivative; of f = du, or du/c where F is over f, and of f times s, x, y, xx,
 * xy, yy; and the couple along x and y. */
typedef struct {
    fl_wide u, du, ddu, f, s, x, y, xx, xy, yy, couple[2];
} fl_tread_sums;

/* Force on F of what moves with its sides, and the moment about the origin, along x, y and n. */
typedef struct {
    fl_vec3 f, m;
} fl_tread_pull;

/* Fill the arrays; x: coordinates of the vertices, x, y and z of a register's worth, and so on. */
void fl_tread_survey(const fl_tread *g, const double *x);

/* Triangles tile[list[k]], k < count, that are whole under F, with s > 0 both ways; normal: of the surface.
 */
void fl_tread_whole(const fl_tread *g, const fl_tread_tile *tile, const int32_t *corner,
                    const fl_vec3 *normal, const int32_t *list, int32_t count, fl_tread_sums *sum);

/* Faces of which a part may count.  *most rises to the largest s. */
void fl_tread_parts(const fl_tread *g, const fl_tread_tile *tile, const int32_t *corner,
                    const fl_vec3 *normal, const fl_tread_cut *list, int32_t count, fl_tread_sums *sum,
                    fl_tread_pull *pull, double *most);

/* Edges edge[list[k]] with s > 0 at both ends, whole under F. */
void fl_tread_edges(const fl_tread *g, const fl_tread_edge *edge, const int32_t *list, int32_t count,
                    fl_tread_sums *sum);

/* The parts span[2 k] to span[2 k + 1] of edges edge[list[k]], s >= 0. */
void fl_tread_pieces(const fl_tread *g, const fl_tread_edge *edge, const int32_t *list, const double *span,
                     int32_t count, fl_tread_sums *sum);

#endif
