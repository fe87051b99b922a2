/* SPDX-License-Identifier: GPL-3.0-or-later */
/* zone_law.h -- stress of the material of deformable blocks: elastic, and Mohr-Coulomb with tension cut-off.
 *
 * Tension is positive here.  With the rotation R of the deformation gradient F = R U (polar decomposition),
 *     e = U - 1,   s = lambda tr(e - e_p) 1 + 2 mu (e - e_p) + s_0,   P = R s
 * P (first Piola-Kirchhoff) is the derivative of the stored energy
 *     w = lambda/2 tr(e - e_p)^2 + mu |e - e_p|^2 + s_0 : e,
 * so that elastic zones conserve energy, and a rotation alone makes no stress.  Strains are meant to be
 * small, rotations may be large.
 *
 * Mohr-Coulomb, principal stresses s1 >= s2 >= s3, N = (1 + sin phi)/(1 - sin phi):
 *     s1 (1 + sin phi) - s3 (1 - sin phi) <= 2 c cos phi,   s1 <= T
 * flow by the same with psi in place of phi, and along s1 (tension).  The return to the surface is exact in
 * principal stresses: the first set of one, two or three of the planes (13), (23), (12) and s1, s2, s3 = T
 * that gives positive multipliers and no stress beyond any plane.  Perfectly plastic.
 * Sources: Sifakis & Barbic, FEM simulation of 3D deformable solids (2012), ch. 3; de Souza Neto, Peric &
 * Owen, Computational Methods for Plasticity (2008), ch. 8. */
#ifndef FL_ZONE_ZONE_LAW_H
#define FL_ZONE_ZONE_LAW_H
#include "geom/mat3.h"
#include "geom/sym3.h"

enum fl_zone_law_kind { FL_ZONE_ELASTIC, FL_ZONE_MOHR_COULOMB };

typedef struct {
    enum fl_zone_law_kind law;
    double density;           /* [kg/m3] */
    double lambda, mu;        /* [Pa] */
    double cohesion, tension; /* c, T; T at most c/tan phi [Pa] */
    double sin_phi, cos_phi;  /* friction angle */
    double sin_psi;           /* dilation angle */
    fl_sym3 initial_stress;   /* s_0, tension positive [Pa] */
} fl_zone_material;

/* Angles in degrees; tension INFINITY: none but the apex of the cone. */
fl_zone_material fl_zone_material_of(double density, double young, double poisson);
void fl_zone_material_set_strength(fl_zone_material *m, double cohesion, double friction_angle,
                                   double tension, double dilation);

/* The rotation R of F; 0 if F turns a zone inside out. */
int fl_zone_rotation(const fl_mat3 *F, fl_mat3 *R);

/* R^T F - 1, which is symmetric. */
fl_sym3 fl_zone_strain(const fl_mat3 *F, const fl_mat3 *R);

/* The stress at a strain; e_p, the plastic strain, follows.  NULL: elastic.  *lost grows by the plastic work
 * per volume [J/m3]. */
fl_sym3 fl_zone_stress(const fl_zone_material *m, fl_sym3 strain, fl_sym3 *plastic, double *lost);

/* Energy stored at a strain [J/m3]. */
double fl_zone_energy(const fl_zone_material *m, fl_sym3 strain, const fl_sym3 *plastic);

/* Eigenvalues, descending; columns of axes: eigenvectors. */
fl_vec3 fl_zone_principal(fl_sym3 s, fl_mat3 *axes);

#endif
