/* SPDX-License-Identifier: GPL-3.0-or-later */
/* moving_parts.h -- parts of the structure that move (sim/moving_structure.h moves them).
 *
 * A mover is a rigid body with prescribed or free directions (structure/rigid_motion.h).  Pieces of its parts
 * follow it.  Or the structure is of members (structure/member_motion.h): piece k is its cylinder k. */
#ifndef FL_WORLD_MOVING_PARTS_H
#define FL_WORLD_MOVING_PARTS_H
#include "structure/hydrostatics.h"
#include "structure/member_motion.h"
#include "structure/rigid_motion.h"

/* movers.n = 0 and no memory where the structure stands still. */
typedef struct {
    fl_rigid_motions movers;
    int32_t *mover_of_part;        /* [parts] -1: the part stands still */
    int32_t *mover_of_piece;       /* [pieces + walls] -1: stands still */
    fl_vec3 *arm;                  /* [pieces + walls] from reference point to piece, axes of the mover [m] */
    fl_quat *rotation;             /* [pieces + walls] axes of the piece in the axes of the mover */
    double *contact_omega2;        /* [movers] omega^2 by contacts, at the last stiffness update [1/s2] */
    fl_hydrostatics *hydrostatics; /* [movers] volume 0 where the scene has no `hydrostatic` */
    fl_member_motion members;      /* cylinders = 0 and no memory where there are none */
    double max_speed;              /* bound of the speeds of all prescribed motions [m/s] */
} fl_moving_structure;

#endif
