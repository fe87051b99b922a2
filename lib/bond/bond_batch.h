/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bond_batch.h -- fl_bond_force() of intact bonds several at a time, with the same bits. */
#ifndef FL_BOND_BOND_BATCH_H
#define FL_BOND_BOND_BATCH_H
#include "bond/bond.h"
#include "geom/lanes.h"

/* n <= FL_LANE_COUNT bonds that are FL_BOND_INTACT and without wear; way of each as in bond.h.
 *   done  out: 1 if the bond has its forces; 0 if a point may have reached its strength, or the sides have
 *         turned too far: the bond is unchanged, and the caller evaluates it by fl_bond_force() */
void fl_bond_batch_force(fl_bond *const *c, const fl_vec3 *way, int n, const fl_bodies *b, uint8_t *done);

#endif
