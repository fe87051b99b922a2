/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mass.h -- volume, centroid and second moments of a convex polyhedron, sharp or dilated by a ball. */
#ifndef FL_GEOM_MASS_H
#define FL_GEOM_MASS_H
#include "geom/poly.h"

/* For density one.  With density rho: mass rho volume, moments of inertia rho inertia. */
typedef struct {
    double volume;   /* V                                                              [m^3] */
    fl_vec3 centre;  /* centroid                                                         [m] */
    fl_mat3 second;  /* S = int (x - centre)(x - centre)^T dV; the inertia tensor is tr(S) 1 - S  [m^5] */
    fl_vec3 inertia; /* principal moments of inertia, ascending: I_0 <= I_1 <= I_2          [m^5] */
    fl_mat3 axes;    /* columns: the principal axes of these, right-handed */
} fl_mass;

/* Volume, centroid and moments of P + B(r), the core dilated by a ball of radius r; r = 0 is the sharp body.
 * The sum is exact, over the pieces of Steiner's formula: the core, a slab of thickness r on each face, a
 * circular sector of angle t_e along each edge, a spherical sector on the normal cone of each vertex.  For
 * the cone of solid angle Omega at a vertex with edges along d_e (unit, leaving it) and with q_e = int u ds
 * over the arc between the normals of the edge's faces,
 *     Omega            = 2 pi - sum of the face angles at the vertex
 *     int u dOmega     = -1/2 sum_e t_e d_e
 *     int u u^T dOmega = Omega/3 1 - 1/6 sum_e (d_e q_e^T + q_e d_e^T),
 * by Stokes' theorem on the sphere, where u and u u^T - 1/3 are eigenfunctions (-2, -6) of the Laplacian.
 * Sums are taken about the body's own centre, to keep precision far from the origin.
 *   p   a point (sphere), segment (capsule), flat polygon or solid, as fl_poly_make() leaves it   [m]
 *   r   r >= 0                                                                                   [m]
 * Returns 0, or -1 with FL_INPUT and m untouched if the body has no volume (r = 0 on anything but a solid) or
 * moments beyond the range of double.  Source: Schneider, Convex Bodies (2014), ch. 4; the moments are
 * derived here. */
int fl_mass_of(fl_mass *m, const fl_poly *p, double r, fl_err *err);

/* Eigenvalues, descending, and eigenvectors of the symmetric matrix a = sum_k value[k] axis_k axis_k^T, where
 * axis_k are the columns of axes.  Cyclic Jacobi rotations; the same bits for the same input.  Off-diagonal
 * elements below 1e-15 of the trace count as zero, and eigenvalues within 1e-14 of it as equal, so that a
 * square body along the axes keeps them.  The largest component of axes 0 and 1 is positive; axis 2 is their
 * cross product. */
void fl_mass_principal(const fl_mat3 *a, double value[3], fl_mat3 *axes);

#endif
