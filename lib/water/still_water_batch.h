/* SPDX-License-Identifier: GPL-3.0-or-later */
/* still_water_batch.h -- water and wind on a few bodies side by side: what environment.h says, to the bit, of bodies that nothing
 * holds: drag, and buoyancy where the water is still or waves are held in this step. */
#ifndef FL_WATER_STILL_WATER_BATCH_H
#define FL_WATER_STILL_WATER_BATCH_H
#include "body/body_batch.h"
#include "water/environment.h"

/* Whether a sea that there is lifts them. */
static inline int fl_still_water_batch_applies(const fl_environment *s)
{
    return !s->waves || (s->sample && !s->sample_now);
}

/* fl_environment_drag() of half a step of each.  water: what moves with them, and then R is wanted; or NULL. */
void fl_still_water_batch_drag(fl_environment *s, const fl_bodies *b, fl_body_batch *a,
                               const fl_body_batch_water *water, int back);

/* fl_environment_add_work() of a kick that took each from v and w to its speeds of now. */
void fl_still_water_batch_add_work(fl_environment *s, const fl_body_batch *a, double (*v)[FL_BODY_BATCH],
                                   double (*w)[FL_BODY_BATCH]);

/* fl_environment_force() of those that float as right prisms do (prism_buoyancy.h), added to a->f and a->t.
 *   left  out, [FL_BODY_BATCH]: which of them, 0 the first, do not; their f and t have lost all sense
 * Returns how many those are. */
int32_t fl_still_water_batch_force(fl_environment *s, const fl_bodies *b, fl_body_batch *a,
                                   int32_t left[FL_BODY_BATCH]);

#endif
