/* SPDX-License-Identifier: GPL-3.0-or-later */
/* still_water_batch.h -- water and wind on the bodies of a batch, with the same bits as environment.h.
 *
 * The bodies have no fixed degree of freedom. Drag is computed always, buoyancy in still water or in a step
 * between two samples of the waves. */
#ifndef FL_WATER_STILL_WATER_BATCH_H
#define FL_WATER_STILL_WATER_BATCH_H
#include "body/body_batch.h"
#include "water/environment.h"

/* True if the batch can compute the buoyancy in this step. */
static inline int fl_still_water_batch_applies(const fl_environment *s)
{
    return !s->waves || (s->sample && !s->sample_now);
}

/* fl_environment_drag() over half the step of each. water: added mass, which needs R; or NULL. */
void fl_still_water_batch_drag(fl_environment *s, fl_bodies *b, fl_body_batch *a,
                               const fl_body_batch_water *water, int back);

/* fl_environment_add_work() of a kick from v and w to the present velocities. */
void fl_still_water_batch_add_work(fl_environment *s, const fl_body_batch *a, double (*v)[FL_BODY_BATCH],
                                   double (*w)[FL_BODY_BATCH]);

/* fl_environment_force() of the bodies that float as right prisms (prism_buoyancy.h), added to a->f and a->t.
 *   left  out, [FL_BODY_BATCH]: lanes of the other bodies; their f and t are undefined
 * Returns the number of those. */
int32_t fl_still_water_batch_force(fl_environment *s, const fl_bodies *b, fl_body_batch *a,
                                   int32_t left[FL_BODY_BATCH]);

#endif
