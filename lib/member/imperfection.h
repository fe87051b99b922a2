/* SPDX-License-Identifier: GPL-3.0-or-later */
/* imperfection.h -- offsets of nodes without stress, which decide the branch that a path takes past a
 * bifurcation. */
#ifndef FL_MEMBER_IMPERFECTION_H
#define FL_MEMBER_IMPERFECTION_H
#include <stdio.h>
#include "member/member_chain.h"

/* Adds to the offset of each node, along its free translations, a times numbers of the standard normal
 * distribution; they are a function of seed and number of the node. */
void fl_member_scatter(fl_member_model *m, double a, uint64_t seed);

/* Adds the displacements of a table of kind `shape`, columns node, dx, dy, dz, scaled so that the largest
 * has length |a|; a < 0 turns them round.  -1 with FL_INPUT: a node that is not there, or no displacement. */
int fl_member_add_shape(fl_member_model *m, const char *path, double a, fl_err *err);

/* Writes such a table of the present state of a chain. */
void fl_member_write_shape(FILE *f, const fl_member_model *m, const fl_member_chain *c);

#endif
