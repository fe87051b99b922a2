/* SPDX-License-Identifier: GPL-3.0-or-later */
/* zone_state.h -- the deformable blocks of a world (sim/zone_step.h moves them). */
#ifndef FL_WORLD_ZONE_STATE_H
#define FL_WORLD_ZONE_STATE_H
#include "zone/zone_joint.h"

/* set.blocks = 0 and no memory without [zones]. */
typedef struct {
    fl_zone_set set;
    fl_zone_joint_list joints;
    int32_t *block_of;    /* [floes] block of a floe, -1: it is rigid */
    int32_t *joint_of;    /* [joints of the bond list] in `joints`, -1: both sides are rigid */
    fl_vec3 *drag, *push; /* [nodes] forces of damping and dashpots; of waves put in; NULL without them [N] */
    double dt;            /* of the step now; 0 at the start [s] */
    double dt_critical;   /* 2/omega of the nodes [s] */
    int32_t stiffest;     /* node that gives it */
    double damping, drive; /* works so far: sink, source [J] */
} fl_zone_state;

#endif
