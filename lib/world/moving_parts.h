/* SPDX-License-Identifier: GPL-3.0-or-later */
/* moving_parts.h -- parts of the structure that move. */
#ifndef FL_WORLD_MOVING_PARTS_H
#define FL_WORLD_MOVING_PARTS_H
#include "structure/hydrostatics.h"
#include "structure/rigid_motion.h"

/* What of the structure moves, see moving_structure.h; m.n = 0 and no memory where nothing does. */
typedef struct {
    fl_rigid_motions movers;
    int32_t *mover_of_part;  /* [parts] its mover, -1: stands still */
    int32_t *mover_of_piece; /* [pieces + walls] the same */
    fl_vec3 *arm;            /* [pieces + walls] from the reference to the piece, axes of the mover [m] */
    fl_quat *rotation;       /* [pieces + walls] axes of the piece in those of the mover */
    double *contact_omega2;  /* [movers] of the contacts, for the survey [1/s2] */
    fl_hydrostatics *hydrostatics; /* [movers] volume 0 where the sea was not asked */
    double max_speed;              /* bound of the told speeds [m/s] */
} fl_moving_structure;

#endif
