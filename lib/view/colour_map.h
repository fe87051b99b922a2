/* SPDX-License-Identifier: GPL-3.0-or-later */
/* colour_map.h -- a colour for a value between 0 and 1.
 *
 * viridis, cividis and magma rise evenly in lightness and are readable to the colour-blind; `manual` is
 * the blue to red of the DilatedDEM manual, `grey` from dark to light.  Eleven points each, linear between
 * them. Sources: van der Walt & Smith, matplotlib (2015); Nunez, Anderton & Renslow, PLoS ONE 13 (2018)
 * e0199239. */
#ifndef FL_VIEW_COLOUR_MAP_H
#define FL_VIEW_COLOUR_MAP_H
#include "view/picture_rgba.h"

enum fl_colour_map { FL_MAP_VIRIDIS, FL_MAP_CIVIDIS, FL_MAP_MAGMA, FL_MAP_MANUAL, FL_MAP_GREY, FL_MAPS };
extern const char *const fl_colour_map_name[FL_MAPS + 1]; /* ends with NULL */

/* x outside [0, 1] takes the colour of the end; not a number: grey. */
fl_rgb fl_colour_map_at(int map, double x);

/* A colour of its own for a number, as of a group or part. */
fl_rgb fl_colour_of_number(int32_t k);

/* "#rrggbb", "rrggbb" or three numbers from 0 to 1 with commas.  0, or -1. */
int fl_colour_read(const char *text, fl_rgb *c);

#endif
