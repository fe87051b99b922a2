/* SPDX-License-Identifier: GPL-3.0-or-later */
/* driven_floes.h -- the edge row of ice that is driven. */
#ifndef FL_WORLD_DRIVEN_FLOES_H
#define FL_WORLD_DRIVEN_FLOES_H
#include <stdint.h>

/* The edge row of ice that is driven: held at a velocity, and on a spring in heave where that is free. */
typedef struct {
    int32_t n;           /* floes of the ice file, or 0: nobody is driven */
    uint8_t *is_driven;  /* [n] is driven */
    double *k;           /* [n] spring [N/m]            */
    double *rest_height; /* [n] the height it pulls to [m] */
} fl_driven_floes;

#endif
