/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cone_side.h -- sums near the slant side of a cone (cone.h), where d = nr (rho - r0) + nz z and the
 * direction is (nr er, nz): over a row of points of a face at one height, and over an edge.  Gauss' rule of
 * FL_LINE10_NODES nodes, several at a time. */
#ifndef FL_PATCH_CONE_SIDE_H
#define FL_PATCH_CONE_SIDE_H

/* A row from y = lo to hi, with rho^2 = h2 + y^2 and q = 1/rho: s = s0 - nr rho, c = c0 - ck q; area: of the
 * row over its length. */
typedef struct {
    double h2, s0, nr, c0, ck, lo, hi, area;
} fl_cone_side_row;

/* Sums over it, times the area: of m s^4, d = 4 m s^3 and 12 m s^2; of d times s, y, y^2, q, q y; of
 * k = 16 c (4 c^2 - 3) s^4 times 1, q, q y, q^3 y, q^3 y^2, q^3 y^3; the largest s. */
typedef struct {
    double u, du, ddu, ds, dy, dyy, dq, dqy, k, kq, kqy, ky, kyy, kyyy, most;
} fl_cone_side_row_sums;

void fl_cone_side_sum_row(const fl_cone_side_row *p, fl_cone_side_row_sums *out);

/* The part of an edge a + t u over the side: rho^2 = a + 2 b t + g t^2, s = s0 + s1 t - nr rho.  Nodes:
 * t = from + width (c1 v + c2 v^2 + c3 v^3) for v in [0, 1].  middle: origin of t in the sums. */
typedef struct {
    double a, b, g, s0, s1, nr, from, width, middle, factor, c[3];
} fl_cone_side_edge;

/* Sums over it, with g = s^(5/2): of g s^2, d = 9/2 g s and 63/4 g; of d times s, t, t^2, q, q t, q t^2, t
 * from the middle and q = 1/rho; the largest s. */
typedef struct {
    double u, du, ddu, ds, dt, dtt, dq, dqt, dqtt, most;
} fl_cone_side_edge_sums;

void fl_cone_side_sum_edge(const fl_cone_side_edge *p, fl_cone_side_edge_sums *out);

#endif
