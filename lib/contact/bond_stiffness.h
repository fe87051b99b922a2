/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bond_stiffness.h -- bounds of omega^2 that the bonds of a world, of faces or of discs, give them.
 *
 * With K_i and K_j, the bounds by bond k alone of its two bodies, the bond adds K_i + sqrt(K_i K_j) to
 * omega^2 of body i, and K_j + sqrt(K_i K_j) to that of j: the shares that contacts have, too
 * (patch/stiffness_bound.h). */
#ifndef FL_CONTACT_BOND_STIFFNESS_H
#define FL_CONTACT_BOND_STIFFNESS_H
#include "patch/stiffness_bound.h"
#include "world/world.h"

/* Adds `share` times the springs of bond k to the stiffness of its body i (end 0) or j (end 1), and returns
 * the number of that body. */
typedef int32_t fl_bond_springs(const fl_world *w, int32_t k, int end, double share, fl_stiffness *out);

/* Allocates and fills omega2[2 n], of bonds [0, n) and their two bodies, and max_omega2[w->n], of each body
 * by all of its bonds [1/s2].  -1 with FL_SYSTEM; both arrays stay with the caller then, too. */
int fl_bond_stiffness_bound(const fl_world *w, int32_t n, fl_bond_springs *springs, double **omega2,
                            double **max_omega2, fl_err *err);

#endif
