/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_packing.h -- an ice sheet of equal spheres in close packing, and which of them touch.
 *
 * Each layer has  columns x rows  spheres of diameter D over a field A x B:
 *     columns = [A / D],     rows = 1 + [(B - D) / (D sqrt(3) / 2)]     (hcp, hex)
 *                            rows = [B / D]                             (square)
 * [] being the whole part: as many columns as a row alone has room for, as many rows as a layer alone has
 * room for.  Rows and layers in between have as many, though they stand D/2 or D sqrt(3)/6 aside; the whole
 * is centred on the field and may stand out of it by D/4 at an end.  This is the count behind published
 * fields:
 *     212 x 184 x 3 = 117 024 spheres of 0.094 m on 20 m x 15 m,
 *     400 x 415 x 2 = 332 000 spheres of 0.25 m on 100 m x 90 m.
 *
 *     hcp     hexagonal layers, each in the hollows of the one below, every second one in the same place:
 *             D sqrt(2/3) apart, 12 neighbours inside
 *     hex     hexagonal layers straight above each other, D apart, 8 neighbours inside
 *     square  a cubic lattice, D apart, 6 neighbours inside
 *
 * Source: Conway & Sloane, Sphere Packings, Lattices and Groups, 3rd ed. (1999), ch. 1. */
#ifndef FL_ICE_SPHERE_PACKING_H
#define FL_ICE_SPHERE_PACKING_H
#include <stdint.h>
#include "base/err.h"
#include "geom/polygon.h"
#include "geom/vec3.h"

enum fl_packing_kind { FL_PACKING_HCP, FL_PACKING_HEX, FL_PACKING_SQUARE };

/* A / D and its like count as whole when they are so to this part: 0.3 / 0.1 is 3. */
#define FL_PACKING_WHOLE_TOL 1e-12

/* Sphere (layer k, row r, column c) has the number (k rows + r) columns + c; layer 0 is the lowest. */
typedef struct {
    int32_t n, columns, rows, layers;
    double diameter,
        layer_spacing; /* of the layers                                                           [m] */
    fl_vec3 *x;        /* [n] centres, those of layer 0 at z = D / 2                              [m] */
    int32_t pairs;
    int32_t (*pair)[2]; /* [pairs] spheres that touch, the lower number first, ascending              */
} fl_sphere_packing;

/* Build it over the field lo .. hi.  diameter > 0, layers >= 1.
 * Returns 0, or -1 with FL_INPUT (no sphere fits, or too many to be counted: 2^27) or FL_SYSTEM; out is
 * untouched then. */
int fl_sphere_packing_make(fl_sphere_packing *out, enum fl_packing_kind kind, double diameter, int32_t layers,
                           fl_vec2 lo, fl_vec2 hi, fl_err *err);

/* Volume of the part of a ball of radius r that lies below a height t over its lowest point: 0 for t <= 0,
 * pi t^2 (r - t/3), the whole for t >= 2 r [m3]. */
double fl_spherical_cap_volume(double r, double t);

/* Height of the still water over the lowest point of the sheet when it floats as one body and the spheres
 * displace  ratio  of their volume, 0 < ratio < 1 [m].  Bisected to the last bit. */
double fl_sphere_packing_draft(const fl_sphere_packing *a, double ratio);

void fl_sphere_packing_free(fl_sphere_packing *a); /* accepts a zeroed struct, leaves one */

#endif
