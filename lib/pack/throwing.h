/* SPDX-License-Identifier: GPL-3.0-or-later */
/* throwing.h -- bodies at random places of a region, before they grow.
 *
 * Rejection (random sequential addition): the largest body first, each at random places of the region until
 * its bounding ball, at scale s, is inside and overlaps none before it; TRIES places inside the region at
 * most.  Then s is halved and all begins again.  Half radii fill 0.21 (discs) and 0.08 (spheres), random
 * sequential addition goes to 0.547 and 0.384: with them it does not fail.
 *
 * Poisson: independent places inside the region.  Half radii do not separate such bodies; the mean number of
 * overlapping neighbours at scale s is (2 s)^D phi.
 *
 * With layers (pack_layers.h) a place is one whose layer is that of the body. */
#ifndef FL_PACK_THROWING_H
#define FL_PACK_THROWING_H
#include "pack/pack_layers.h"
#include "pack/packing.h"

enum fl_throw { FL_THROW_REJECTION, FL_THROW_POISSON };

/* Sets p->x and p->s, which is 1/2 or less on return.  Bodies must be in descending order of size.
 *   layers  NULL: none
 *   halved  out: how often s was halved beyond 1/2
 * 0, or -1 with FL_INPUT (a body that does not fit into the region even so small) or FL_SYSTEM. */
int fl_throw_bodies(fl_packing *p, const fl_pack_region *r, const fl_pack_layers *layers, enum fl_throw how,
                    uint64_t seed, int *halved, fl_err *err);

#endif
