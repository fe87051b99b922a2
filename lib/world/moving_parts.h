/* SPDX-License-Identifier: GPL-3.0-or-later */
/* moving_parts.h -- parts of the structure that move. */
#ifndef FL_WORLD_MOVING_PARTS_H
#define FL_WORLD_MOVING_PARTS_H
#include "bound/flotation.h"
#include "bound/mover.h"

/* What of the structure moves, see ride.h; m.n = 0 and no memory where nothing does. */
typedef struct {
    fl_movers m;
    int32_t *part;        /* [parts] its mover, -1: stands still */
    int32_t *of;          /* [pieces + walls] the same */
    fl_vec3 *arm;         /* [pieces + walls] from the reference to the piece, axes of the mover [m] */
    fl_quat *turn;        /* [pieces + walls] axes of the piece in those of the mover */
    double *slope;        /* [movers] of the contacts, for the survey [1/s2] */
    fl_flotation *afloat; /* [movers] volume 0 where the sea was not asked */
    double fastest;       /* bound of the told speeds [m/s] */
} fl_ride;

#endif
