/* SPDX-License-Identifier: GPL-3.0-or-later */
/* calm.h -- still water, and wind, on a few bodies side by side: what sea.h says, to the bit, of bodies that
 * fl_body_free(), where there are no waves and drag goes by the manual's laws. */
#ifndef FL_WATER_CALM_H
#define FL_WATER_CALM_H
#include "body/few.h"
#include "water/sea.h"

/* Whether a sea that there is, is of that kind. */
static inline int fl_calm_goes(const fl_sea *s) { return !s->waves && !s->skin; }

/* fl_sea_drag() of half a step of each. */
void fl_calm_drag(fl_sea *s, const fl_bodies *b, fl_few *a, int back);

/* fl_sea_force() of those that float as right prisms do (prism.h), added to a->f and a->t.
 *   left  out, [FL_FEW]: which of them, 0 the first, do not; their f and t have lost all sense
 * Returns how many those are. */
int32_t fl_calm_force(fl_sea *s, const fl_bodies *b, fl_few *a, int32_t left[FL_FEW]);

#endif
