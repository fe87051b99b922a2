/* SPDX-License-Identifier: GPL-3.0-or-later */
/* prescribed_areas.h -- power cells and floes of prescribed areas.
 *
 * For any sites and any areas t_i > 0 whose sum is the area of the outline there are weights w, unique up
 * to a constant, for which the cells of the power diagram have these areas: the cells transport the
 * uniform measure to the sites at the least cost (semi-discrete optimal transport).  Newton's method
 * solves
 *    A_i(w) = t_i,    dA_i/dw_j = -l_ij / (2 |x_i - x_j|),    sum_j dA_i/dw_j = 0,
 * where l_ij is the length of the common side of cells i and j.  Steps are limited so that no cell falls
 * below half of its present and its prescribed area.  Source: Aurenhammer, Hoffmann & Aronov, Algorithmica
 * 20 (1998) 61; Kitagawa, Merigot & Thibert, J. Eur.  Math.  Soc.  21 (2019) 2603. */
#ifndef FL_ICE_PRESCRIBED_AREAS_H
#define FL_ICE_PRESCRIBED_AREAS_H
#include <stdint.h>
#include "base/err.h"
#include "ice/power_cells.h"
#include "ice/floes.h"

/* Sites and initial weights.  Discs with FL_SITE_DISC_COVER of the areas area[n] are placed in the
 * outline, the largest first, each at the first of its random points where it meets no other disc; the
 * weight is the square of the radius.  A disc that finds no place shrinks.  No cell is empty, since it
 * contains its disc.  Returns 0, or -1 with FL_SYSTEM. */
#define FL_SITE_DISC_COVER 0.36
int fl_prescribed_areas_sites(int32_t n, uint64_t seed, const double *area, const fl_outline *in,
                              fl_vec2 *site, double *weight, fl_err *err);

/* Change weight[n], for which no cell may be empty, until the cells of site[n] have the areas area[n] to a
 * relative tolerance tol.  The sum of area is that of the outline, to rounding.  Returns 0; 1 if a cell is
 * empty initially; or -1 with FL_NUMERIC (no convergence; the message gives the largest error) or
 * FL_SYSTEM. out, freed by the caller, is unchanged unless 0. */
int fl_prescribed_areas_solve(fl_power_cells *out, int32_t n, const fl_vec2 *site, double *weight,
                              const double *area, const fl_outline *in, double tol, fl_err *err);

/* Floes whose outer polygons have the areas area[n]: sites, `smooth` steps of Lloyd's method with new
 * weights in each, then the areas of the cells are adjusted until fl_floes_make() gives the requested
 * areas.  The result is that of the best round.
 *    area           the sum is the concentration times the area of the outline                     [m2]
 *    *off           out: largest |achieved - requested| / requested
 * Returns 0, or -1 with FL_INPUT (a requested floe is too small for the radius, or an error of
 * fl_floes_make()), FL_NUMERIC or FL_SYSTEM; cells and floes are unchanged then. */
int fl_prescribed_areas_floes(fl_power_cells *cells, fl_floes *floes, int32_t n, uint64_t seed,
                              const double *area, const fl_outline *in, int32_t smooth, double concentration,
                              double radius, fl_vec2 shift, double *off, fl_err *err);

/* Cells that have the areas area[n] to a relative 1e-9; the sum is the area of the outline.  Sites and
 * `smooth` steps of Lloyd's method with new weights in each.  Returns 0, or -1 with FL_NUMERIC or
 * FL_SYSTEM; cells is unchanged then. */
int fl_prescribed_areas_cells(fl_power_cells *cells, int32_t n, uint64_t seed, const double *area,
                              const fl_outline *in, int32_t smooth, fl_err *err);

#endif
