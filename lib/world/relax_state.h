/* SPDX-License-Identifier: GPL-3.0-or-later */
/* relax_state.h -- damping that brings a run to rest (sim/relaxed_run.h). */
#ifndef FL_WORLD_RELAX_STATE_H
#define FL_WORLD_RELAX_STATE_H
#include "body/relaxation.h"
#include "geom/vec3.h"

typedef struct {
    int kind;              /* enum fl_relax of scene_types.h; 0: none */
    double rate;           /* of adaptive damping: force over mass and velocity [1/s] */
    fl_relaxation r;       /* of kinetic and adaptive damping */
    int settled;           /* 1: at rest by the last look of relaxed_run.h */
    fl_vec3 (*damping)[2]; /* [n] force and torque of damping on each floe in the last step [N], [N m] */
    /* forces on each floe and on each node of the zones without that damping, of the last step; adaptive
     * alone [N] */
    fl_vec3 *force, *node_force;
} fl_relax_state;

#endif
