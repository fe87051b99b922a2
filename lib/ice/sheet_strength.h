/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sheet_strength.h -- strength and stiffness of a bonded sheet of spheres over those of its bonds.
 *
 * A sheet does not show the strength c of its bonds (bond/disc.h; c = sigma_t = cohesion).  The ratios below
 * are measured on virtual samples with bonds of G/E = 0.385, beta = 1, no internal friction and a scatter of
 * 15 %:
 *     flexural     sigma_f/c: largest load of a beam on two rollers with a third in its middle, span 10 h,
 *                  sigma_f = 3 P L/(2 b h^2) with the nominal h = layers x spacing of layers
 *     compressive  sigma_c/c: largest mean stress of 10 x 10 x 12 spheres pressed in the plane of the
 *                  sheet, whatever its layers; 0 for a cubic lattice, whose bonds are pressed alone: it does
 *                  not fail
 *     young        E/E_b in bending
 * Rows along the stress carry like columns and are stronger; so the direction of the rows counts.  The
 * example calibrate makes the numbers again. */
#ifndef FL_ICE_SHEET_STRENGTH_H
#define FL_ICE_SHEET_STRENGTH_H
#include <stdint.h>
#include "ice/sphere_packing.h"

typedef struct {
    double flexural, compressive, young;
    double flexural_spread, compressive_spread; /* deviation over mean of samples with other scatter */
} fl_sheet_strength;

/* The ratios for stress along x.  across: rows of the lattice are across x; a square lattice has the same
 * both ways.  layers >= 1; more than measured have the ratios of the thickest sample. */
fl_sheet_strength fl_sheet_strength_of(enum fl_packing_kind kind, int32_t layers, int across);

/* Ratio k_s/k_n and scatter that these hold for. */
#define FL_SHEET_POISSON 0.3
#define FL_SHEET_SCATTER 0.15

#endif
