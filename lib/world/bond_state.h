/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bond_state.h -- the bonds of a world (contact/bond_list.h computes with them).
 *
 * Indices: k bonds in the order of (i, j); bonds_of[first[b] .. first[b + 1]) are the bonds of body b. */
#ifndef FL_WORLD_BOND_STATE_H
#define FL_WORLD_BOND_STATE_H
#include "bond/joint.h"

/* n = 0 and no memory where no faces are bonded. */
typedef struct {
    int32_t n;
    fl_bond *bond;         /* [n] sorted by (i, j) */
    int32_t *image;        /* [3 n] periodic image of j: offset in lengths of the cell */
    double *radius_factor; /* [n] radius_factor of the pair that an ended bond leaves; 0: not computed yet */
    double *omega2;        /* [2 n] contribution of bond k to omega^2 of i and of j [1/s2] */
    double *max_omega2;    /* [bodies] omega^2 by all bonds of a body while they are whole [1/s2] */
    int64_t *first;        /* [bodies + 1] offsets into `of` */
    int32_t *of;           /* [2 n] bonds of each body, ascending */
    int ended;             /* a bond ended in this step */
    /* joints are the bonds [faces, n); joint_list.h */
    int32_t faces, corners;
    fl_joint *joint;                   /* [n - faces] material -1: a bonded face without limit */
    fl_vec3 *corner;                   /* [corners] of their faces, frames of the bodies [m] */
    fl_joint_material *joint_material; /* [joint sections of the scene] */
} fl_bond_list;

#endif
