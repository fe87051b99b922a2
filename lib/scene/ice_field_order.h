/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ice_field_order.h -- the bodies of a field in an order of their own. */
#ifndef FL_SCENE_ICE_FIELD_ORDER_H
#define FL_SCENE_ICE_FIELD_ORDER_H
#include "scene/ice_field.h"

/* Sort the bodies by where they are and what they are (mean of the vertices of the core: place on Hilbert's
 * curve over the plane where there are more than 4096 bodies, so that neighbours lie near in memory, then x,
 * y, z; radius; vertices), and only where two are the same in all of it by id.  Sums over bodies and pairs
 * then run in an order that neither ids nor places in the file have a part in: a field whose bodies are
 * listed or numbered otherwise makes the same steps to the last bit. at[n]  out: where the body is now that
 * was the k-th 0, or -1 with FL_SYSTEM: the field is then as it was. */
int fl_ice_field_order(fl_ice_field *a, int32_t *at, fl_err *err);

#endif
