/* SPDX-License-Identifier: GPL-3.0-or-later */
/* relax_state.h -- damping that brings a run to rest (sim/relaxed_run.h). */
#ifndef FL_WORLD_RELAX_STATE_H
#define FL_WORLD_RELAX_STATE_H
#include "body/relaxation.h"
#include "geom/vec3.h"

typedef struct {
    int kind;        /* enum fl_relax of scene_types.h; 0: none */
    double rate;     /* of adaptive damping: force over mass and velocity [1/s] */
    fl_relaxation r; /* of kinetic and adaptive damping */
    fl_vec3 *force;  /* [n] force on each floe without that damping, of the last step; adaptive alone [N] */
} fl_relax_state;

#endif
