/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ice_field_order.h -- sorting of the bodies of a field. */
#ifndef FL_SCENE_ICE_FIELD_ORDER_H
#define FL_SCENE_ICE_FIELD_ORDER_H
#include "scene/ice_field.h"

/* Sort the bodies by position and shape: position on a Hilbert curve over the plane, if there are more
 * than 4096 bodies, so that neighbours are near in memory; then x, y, z of the mean of the vertices of the
 * core; radius; vertices.  Only bodies equal in all of these are sorted by id.  Sums over bodies and pairs
 * then have an order that is independent of ids and of the order in the file: a field with other numbers
 * or another order makes the same steps to the last bit.
 *    at[n]  out: the new index of body k
 * Returns 0, or -1 with FL_SYSTEM; the field is unchanged then. */
int fl_ice_field_order(fl_ice_field *a, int32_t *at, fl_err *err);

#endif
