/* SPDX-License-Identifier: GPL-3.0-or-later */
/* elastic_walls.h -- walls on an elastic foundation.
 *
 * A foundation of springs and dashpots loads the part of a body that is behind the wall.  Its pressure, that
 * of Winkler, is p = k_A d with d the depth behind the wall.  A heavy fluid of specific weight k_A has the
 * same pressure.  So force, moment and energy are those of buoyancy: exact for any orientation, and from one
 * potential. */
#ifndef FL_WORLD_ELASTIC_WALLS_H
#define FL_WORLD_ELASTIC_WALLS_H
#include "geom/poly.h"
#include "water/buoyancy.h"

typedef struct {
    double stiffness, damping; /* k_A [N/m3], c_A [N s/m3] */
    fl_poly *outer;            /* [n] sharp outer shapes, body frames; empty where the core is round */
    fl_hull *hull;             /* [n]; NULL: no wall is elastic */
} fl_elastic_walls;

#endif
