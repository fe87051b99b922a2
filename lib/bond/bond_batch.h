/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bond_batch.h -- whole bonds several at a time: what fl_bond_force() does, to the bit. */
#ifndef FL_BOND_BOND_BATCH_H
#define FL_BOND_BOND_BATCH_H
#include "bond/bond.h"
#include "geom/lanes.h"

/* n <= FL_LANE_COUNT bonds that are FL_BOND_INTACT and not worn; way of each as in bond.h.
 *   done  out: 1 where the bond has its forces; 0 where some point may have reached its strength, or the
 *         sides have turned too far: nothing is changed, and fl_bond_force() is to be asked */
void fl_bond_batch_force(fl_bond *const *c, const fl_vec3 *way, int n, const fl_bodies *b, uint8_t *done);

#endif
