/* SPDX-License-Identifier: GPL-3.0-or-later */
/* calm.h -- water and wind on a few bodies side by side: what sea.h says, to the bit, of bodies that nothing
 * holds: drag, and buoyancy where the water is still or waves are held in this step. */
#ifndef FL_WATER_CALM_H
#define FL_WATER_CALM_H
#include "body/few.h"
#include "water/sea.h"

/* Whether a sea that there is lifts them. */
static inline int fl_calm_lifts(const fl_sea *s) { return !s->waves || (s->held && !s->looks); }

/* fl_sea_drag() of half a step of each.  water: what moves with them, and then R is wanted; or NULL. */
void fl_calm_drag(fl_sea *s, const fl_bodies *b, fl_few *a, const fl_few_water *water, int back);

/* fl_sea_book() of a kick that took each from v and w to its speeds of now. */
void fl_calm_book(fl_sea *s, const fl_few *a, double (*v)[FL_FEW], double (*w)[FL_FEW]);

/* fl_sea_force() of those that float as right prisms do (prism.h), added to a->f and a->t.
 *   left  out, [FL_FEW]: which of them, 0 the first, do not; their f and t have lost all sense
 * Returns how many those are. */
int32_t fl_calm_force(fl_sea *s, const fl_bodies *b, fl_few *a, int32_t left[FL_FEW]);

#endif
