/* SPDX-License-Identifier: GPL-3.0-or-later */
/* prescribed_areas.h -- cells and floes of prescribed areas.
 *
 * For any sites and any areas t_i > 0 that add up to the area of the outline there are weights w, unique up
 * to a constant, for which the cells of the power diagram have these areas: the cells carry the uniform
 * measure to the sites at the least cost (semi-discrete optimal transport).  Found by Newton's method on
 *     A_i(w) = t_i,    dA_i/dw_j = -l_ij / (2 |x_i - x_j|),    sum_j dA_i/dw_j = 0,
 * l_ij being the length of the side that cells i and j share, with steps cut so that no cell falls below half
 * of what it has and needs.  Source: Aurenhammer, Hoffmann & Aronov, Algorithmica 20 (1998) 61; Kitagawa,
 * Merigot & Thibert, J. Eur. Math. Soc. 21 (2019) 2603. */
#ifndef FL_ICE_PRESCRIBED_AREAS_H
#define FL_ICE_PRESCRIBED_AREAS_H
#include <stdint.h>
#include "base/err.h"
#include "ice/power_cells.h"
#include "ice/floes.h"

/* Sites and first weights: discs with FL_SITE_DISC_COVER of the areas area[n] are thrown into the outline, the
 * largest first, each to the first place in its sequence of random ones where it meets none before; w is the
 * square of the radius.  A disc that finds no place shrinks.  No cell is empty then: it holds its disc.
 * Returns 0, or -1 with FL_SYSTEM. */
#define FL_SITE_DISC_COVER 0.36
int fl_prescribed_areas_sites(int32_t n, uint64_t seed, const double *area, const fl_outline *in,
                              fl_vec2 *site, double *weight, fl_err *err);

/* Change weight[n], for which no cell is empty, until the cells of site[n] have the areas area[n] to a part
 * tol of each; area adds up to that of the outline, to rounding.
 * Returns 0, 1 when a cell is empty to begin with, or -1 with FL_NUMERIC (the steps came to an end; the
 * largest error is told) or FL_SYSTEM.  out, freed by the caller, is untouched unless 0. */
int fl_prescribed_areas_solve(fl_power_cells *out, int32_t n, const fl_vec2 *site, double *weight,
                              const double *area, const fl_outline *in, double tol, fl_err *err);

/* Floes whose outer polygons have the areas area[n]: place, smooth steps of Lloyd's method, each with the
 * weights found anew, then the areas of the cells are changed until fl_floes_make() leaves what was asked.
 * The best round is the one that counts.
 *   area           adds up to the concentration times the area of the outline                     [m2]
 *   *off           out: largest |achieved - asked| / asked
 * Returns 0, or -1 with FL_INPUT: a floe is asked for that is too small for the radius, or fl_floes_make()
 * says why there are none; FL_NUMERIC, FL_SYSTEM.  cells and floes are untouched then. */
int fl_prescribed_areas_floes(fl_power_cells *cells, fl_floes *floes, int32_t n, uint64_t seed,
                              const double *area, const fl_outline *in, int32_t smooth, double concentration,
                              double radius, fl_vec2 shift, double *off, fl_err *err);

/* Cells that have the areas area[n] to 1e-9 of each, which add up to that of the outline: place, and smooth
 * steps of Lloyd's method, each with the weights found anew.
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM; cells is untouched then. */
int fl_prescribed_areas_cells(fl_power_cells *cells, int32_t n, uint64_t seed, const double *area,
                              const fl_outline *in, int32_t smooth, fl_err *err);

#endif
