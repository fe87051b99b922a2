/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bond_state.h -- the bonds of a world. */
#ifndef FL_WORLD_BOND_STATE_H
#define FL_WORLD_BOND_STATE_H
#include "bond/bond.h"

/* Faces frozen together, see bond_list.h; n = 0 and no memory where nothing is. */
typedef struct {
    int32_t n;
    fl_bond *bond;         /* [n] by (i, j) */
    int32_t *image;        /* [3 n] j is where it is, moved by so many lengths of the cell */
    double *radius_factor; /* [n] of the pair that an ended bond leaves, see there; 0: not looked at yet */
    double *omega2;        /* [2 n] shares of omega^2 of i and of j [1/s2] */
    double *max_omega2;    /* [bodies] omega^2 by all its bonds [1/s2] */
    int64_t *first;        /* [bodies + 1] */
    int32_t *of;           /* [2 n] bonds of each body, ascending */
    int ended;             /* a bond ended in this step */
} fl_bond_list;

#endif
