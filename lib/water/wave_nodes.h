/* SPDX-License-Identifier: GPL-3.0-or-later */
/* wave_nodes.h -- points of a floating body at which the waves are evaluated.
 *
 * A right prism (a floe) has columns along its long edges: a rule of quadrature over the cross-section, exact
 * for polynomials of degree p, with at most (p + 1)(p + 2)/2 points of positive weight. It starts from
 * products of Gauss rules over the triangles of a fan. Points are then dropped one by one along null vectors
 * of the moments, while all weights stay positive (Tchakaloff 1957; Caratheodory 1911), by the pivots of the
 * simplex method. A wave train over a section of radius R is a sum of polynomials of degree m with amplitude
 * 2 J_m(kR), so p is the least degree with
 *     sum_n a_n^2 (2 sum_(m>p) J_m(k_n r)^2) <= N (0.7 e)^2 sum_n a_n^2,
 * e being the error asked for and N the number of points, as the mean over the radii r of a disc of radius R.
 * Where that is above 12 the section is halved across its longest direction.
 *
 * Any other solid has points on its faces, each with its part of the area vector. Parts within lambda/12,
 * lambda of k95, whose normals are within about 10 degrees, are merged: a hull of 50 000 triangles has a few
 * thousand points. A sphere or capsule has none. */
#ifndef FL_WATER_WAVE_NODES_H
#define FL_WATER_WAVE_NODES_H
#include "water/buoyancy.h"
#include "water/wave.h"

enum fl_wave_body_kind { FL_WAVE_ROUND, FL_WAVE_COLUMNS, FL_WAVE_FACES, FL_WAVE_MESH };

typedef struct {
    enum fl_wave_body_kind kind;
    int32_t n;
    fl_vec3 *x;      /* [n] body axes; of columns the lower end [m] */
    double *w;       /* [n] columns: area of the section [m2] */
    double *half;    /* [n] columns: half the side of a square of that area [m] */
    fl_vec3 *area;   /* [n] faces and mesh: area vector, outward [m2] */
    fl_mat3 *spread; /* [n] mesh: mean of (x - centroid)(x - centroid)^T over the part [m2] */
    fl_vec3 along;   /* columns: unit vector of the long edges */
    double length;   /* columns: length of the long edges [m] */
    double section; /* columns: area of the section; faces: largest of the three projections; round: pi r^2 */
} fl_wave_nodes;

/* Makes the nodes of a hull. error: asked for, e. Frees a first. Returns -1 with FL_SYSTEM, or FL_INPUT if
 * the points are too many. */
int fl_wave_nodes_make(fl_wave_nodes *a, const fl_hull *hull, const fl_waves *w, double error, fl_err *err);

/* Makes the nodes of a closed mesh of n triangles v[3 n], its largest side being `size` [m]. Its parts are
 * pieces of its triangles within cells of lambda/4, in axes of the body, and 20 degrees of their normals.
 * They are cut at the limits of the cells: what is wet of a part is taken from its spread. A part carries the
 * mean pressure over it to second order,
 *     p + 1/2 (S_ss - S_zz) d2p/ds2 + S_sz d2p/ds dz,   S = spread,
 * P being harmonic, and the moment of its gradient. What is left is (k l)^4/1920 of a wave, l being the size
 * of the part. Below an error of 0.003 the size falls as the square root of the error, since waves shorter
 * than lambda act at the ends. */
int fl_wave_nodes_make_mesh(fl_wave_nodes *a, const fl_vec3 *v, int32_t n, double size, const fl_waves *w,
                            double error, fl_err *err);
void fl_wave_nodes_free(fl_wave_nodes *a); /* accepts a zeroed struct, leaves one */

/* The degree p for a section of radius R, one of `parts`; 13 if it is above 12. */
int fl_wave_nodes_degree(const fl_waves *w, double R, double error, double parts);

#endif
