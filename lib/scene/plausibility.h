/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plausibility.h -- values outside what exists on earth, for ice that floats.
 *
 * A scene with [water] whose ice.material has a name that begins with ice is held against two ranges of each
 * value: outside the wide one it is refused, outside the narrow one it is warned of.  A refusal names the
 * unit that was likely meant, the first of a short list whose factor brings the value into the wide range.
 * Other scenes, such as rock, packings and dry blocks, and other materials have other bounds and are not
 * looked at.
 *
 *     value                                   wide                     narrow
 *     density of ice [kg/m3]                  500 to 950, below water  800 to 930
 *     density of water [kg/m3]                990 to 1050              998 to 1030
 *     Young's modulus of ice [Pa]             1e6 to 12e9              1e8 to 1e10
 *     Poisson's ratio of ice                  0 to 0.45                0.2 to 0.4
 *     friction; restitution                   to 2; to 1               to 0.6; to 0.6
 *     thickness; length of a floe [m]         0.005 to 60; 0.02 to 5e4 to 5; to 5e3
 *     current; structure; wind [m/s]          to 5; to 20; to 75       to 2; to 10; to 40
 *     drag of water; air; form of an edge     to 0.1; to 0.05; to 3    to 0.035; to 0.01; to 1.2
 *     strength of bonds [Pa]                  1e4 to 15e6              1e5 to 5e6
 *
 * Of spheres that stand for a sheet (ice.slab) modulus, density and strength make that sheet what it is, and
 * are held against the wide ranges alone.
 *
 * Sources: Timco & Frederking (1996) for density; Timco & Weeks (2010) for modulus and strength; Sukhorukov &
 * Loset (2013) for friction; ice-scenes(7) for all. */
#ifndef FL_SCENE_PLAUSIBILITY_H
#define FL_SCENE_PLAUSIBILITY_H
#include <stdio.h>
#include "scene/ice_field.h"
#include "scene/scene.h"

/* Thickness and length of the floes of a field: the vertical and the longer horizontal side of their boxes
 * [m], and the bodies that have them.  Spheres, capsules and bodies of another
 * material than ice do not count. */
typedef struct {
    int32_t n;
    double thinnest, thickest, shortest, longest;
    int32_t thinnest_id, thickest_id, shortest_id, longest_id;
    int32_t blocks; /* bodies shorter than thick */
} fl_floe_extent;

fl_floe_extent fl_floe_extent_of(const fl_ice_field *field);

/* -1 with FL_INPUT for the first value outside its wide range; FL_USAGE for one of --set. */
int fl_scene_check_plausible(const fl_scene *s, const fl_floe_extent *floes, fl_err *err);

/* A line to f for each value outside its narrow range, that begins with `before`. */
void fl_scene_warn_implausible(const fl_scene *s, const fl_floe_extent *floes, const char *before, FILE *f);

#endif
