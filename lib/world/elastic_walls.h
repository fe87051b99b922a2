/* SPDX-License-Identifier: GPL-3.0-or-later */
/* elastic_walls.h -- walls on an elastic foundation. */
#ifndef FL_WORLD_ELASTIC_WALLS_H
#define FL_WORLD_ELASTIC_WALLS_H
#include "geom/poly.h"
#include "water/buoyancy.h"

/* Elastic walls: a foundation of springs and dashpots, which a body presses by what of it is behind the wall.
 * Winkler's pressure k_A x depth is that of a heavy fluid of specific weight k_A, so force, moment and energy
 * are those of buoyancy, exact for any attitude and one potential. */
typedef struct {
    double stiffness, damping; /* k_A [N/m3], c_A [N s/m3] */
    fl_poly *outer;            /* [n] sharp outer shapes, body frames; empty where the core is round */
    fl_hull *hull;             /* [n]; NULL: no wall is elastic */
} fl_elastic_walls;

#endif
