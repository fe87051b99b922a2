/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stirring_flow.h -- a field of floes at 80 % in eddies, which stir it until they touch everywhere. */
#ifndef FL_TESTS_STIRRING_FLOW_H
#define FL_TESTS_STIRRING_FLOW_H
#include "support/small_world.h"

/* n floes as voronoi-ice makes them and in the order that dem-solve gives them, no water; softened contacts,
 * friction and restitution.  Keys may still be set; then lab_make().  In the middle between two eddies the
 * floes have `speed` [m/s]; they are 2 to 5 m wide, so a contact for four floes is there when they have come
 * a metre.  Failures end the program with the sentence. */
void eddies_start(lab *l, int32_t n, double speed);

#endif
