/* SPDX-License-Identifier: GPL-3.0-or-later */
/* driven_floes.h -- the driven row of floes at the edge of the ice: boundary.drive. */
#ifndef FL_WORLD_DRIVEN_FLOES_H
#define FL_WORLD_DRIVEN_FLOES_H
#include <stdint.h>
#include "structure/prescribed_track.h"

/* A driven floe has a prescribed velocity.  Where its heave is free, a spring of stiffness k pulls it to
 * rest_height. */
typedef struct {
    int32_t n;           /* floes of the ice file; 0: no floe is driven */
    uint8_t *is_driven;  /* [n] */
    double *k;           /* [n] stiffness of the spring in heave [N/m] */
    double *rest_height; /* [n] height at which that spring has no force [m] */
    fl_track track;      /* n = 0: constant velocity */
} fl_driven_floes;

#endif
