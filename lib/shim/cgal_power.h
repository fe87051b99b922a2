/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_power.h -- neighbours in a power diagram (Laguerre tessellation), decided exactly.  The cell of site i
 * contains the points x of least |x - x_i|^2 - w_i. */
#ifndef FL_SHIM_CGAL_POWER_H
#define FL_SHIM_CGAL_POWER_H
#include <stdint.h>
#include "base/err.h"
#include "geom/polygon.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The neighbours of each site in the regular triangulation, the dual of the power diagram: the cell of site i
 * is the intersection of all half-planes of less power to i than to a neighbour.  A site with an empty cell
 * has no neighbours, nor has a single site.
 *   site[n]      finite                                                              [m]
 *   weight[n]    finite; only differences matter                                    [m2]
 *   name[n]      distinct names of the sites
 *   empty[n]     out: 1 if the cell is empty
 *   first[n + 1] out: the neighbours of site i are (*near)[first[i] .. first[i + 1]), sorted by name
 *   near         out: freed with free()
 * Returns 0, or -1 with FL_SYSTEM or FL_NUMERIC.  O(n log n).
 * Source: Aurenhammer, SIAM J. Comput. 16 (1987) 78; CGAL, 2D Triangulations, Regular_triangulation_2. */
int fl_cgal_power_neighbours(int32_t n, const fl_vec2 *site, const double *weight, const int32_t *name,
                             char *empty, int32_t *first, int32_t **near, fl_err *err);

#ifdef __cplusplus
}
#endif
#endif
