/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stirring_flow.h -- an ice field of 80 % concentration in a flow of eddies, which stirs it until floes
 * touch everywhere. */
#ifndef FL_TESTS_STIRRING_FLOW_H
#define FL_TESTS_STIRRING_FLOW_H
#include "support/small_world.h"

/* n floes made like those of voronoi-ice, in the order of dem-solve, without water; softened contacts,
 * friction and restitution.  Keys may still be set before lab_make().  Half-way between two eddies the
 * floes have `speed` [m/s].  They are 2 to 5 m wide, so there is a contact for every four floes after a
 * path of a metre.  Failures end the program with a message. */
void stirring_flow_start(lab *l, int32_t n, double speed);

#endif
