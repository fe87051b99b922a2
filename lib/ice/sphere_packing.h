/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_packing.h -- an ice sheet of equal spheres in close packing, and the pairs that touch.
 *
 * Each layer has columns x rows spheres of diameter D over a field A x B:
 *    columns = [A / D],     rows = 1 + [(B - D) / (D sqrt(3) / 2)]     (hcp, hex)
 *                           rows = [B / D]                             (square)
 * where [] is the integer part: the number of columns that fit in one row, and of rows that fit in one
 * layer.  All rows and layers have the same numbers, though some are offset by D/2 or D sqrt(3)/6.  The
 * sheet is centred on the field and may extend beyond it by D/4 at an end.  This is the count of published
 * fields:
 *    212 x 184 x 3 = 117 024 spheres of 0.094 m on 20 m x 15 m,
 *    400 x 415 x 2 = 332 000 spheres of 0.25 m on 100 m x 90 m.
 *
 *    hcp     hexagonal layers in the hollows of the layer below, every second one at the same place:
 *            D sqrt(2/3) apart, 12 neighbours inside
 *    hex     hexagonal layers straight above each other, D apart, 8 neighbours inside
 *    square  a cubic lattice, D apart, 6 neighbours inside
 *
 * Source: Conway & Sloane, Sphere Packings, Lattices and Groups, 3rd ed. (1999), ch.  1. */
#ifndef FL_ICE_SPHERE_PACKING_H
#define FL_ICE_SPHERE_PACKING_H
#include <stdint.h>
#include "base/err.h"
#include "geom/polygon.h"
#include "geom/vec3.h"

enum fl_packing_kind { FL_PACKING_HCP, FL_PACKING_HEX, FL_PACKING_SQUARE };

/* Relative tolerance within which A / D and similar ratios count as integers: 0.3 / 0.1 is 3. */
#define FL_PACKING_WHOLE_TOL 1e-12

/* Sphere (layer k, row r, column c) has the index (k rows + r) columns + c; layer 0 is the lowest. */
typedef struct {
    int32_t n, columns, rows, layers;
    double diameter, layer_spacing; /* distance of layers [m] */
    fl_vec3 *x;                     /* [n] centres, layer 0 at z = D / 2 [m] */
    int32_t pairs;
    int32_t (*pair)[2]; /* [pairs] touching spheres, lower index first, ascending */
} fl_sphere_packing;

/* Build the packing over the field lo .. hi; diameter > 0, layers >= 1.  Returns 0, or -1 with FL_INPUT
 * (no sphere fits, or more than 2^27) or FL_SYSTEM; out is unchanged then. */
int fl_sphere_packing_make(fl_sphere_packing *out, enum fl_packing_kind kind, double diameter, int32_t layers,
                           fl_vec2 lo, fl_vec2 hi, fl_err *err);

/* Volume of the part of a ball of radius r below the height t above its lowest point: 0 for t <= 0, pi t^2
 * (r - t/3), the whole ball for t >= 2 r [m3]. */
double fl_spherical_cap_volume(double r, double t);

/* Height of the still water above the lowest point of the sheet, if it floats as one body and the spheres
 * displace `ratio` of their volume, 0 < ratio < 1 [m].  Bisection to the last bit. */
double fl_sphere_packing_draft(const fl_sphere_packing *a, double ratio);

void fl_sphere_packing_free(fl_sphere_packing *a); /* accepts a zeroed struct, leaves a zeroed one */

#endif
