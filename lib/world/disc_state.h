/* SPDX-License-Identifier: GPL-3.0-or-later */
/* disc_state.h -- the bonds between spheres of a world (bond/disc.h; contact/disc_list.h computes with them).
 *
 * Bond k, in the order of (i, j).  Those with body b as i are [first_i[b], first_i[b + 1]); those with b as j
 * are of[first_j[b] .. first_j[b + 1]). */
#ifndef FL_WORLD_DISC_STATE_H
#define FL_WORLD_DISC_STATE_H
#include "bond/disc_batch.h"

/* After the end of a bond its pair is not in the neighbour list yet, or is. */
enum fl_disc_end { FL_DISC_STANDS, FL_DISC_JUST_ENDED, FL_DISC_ENDED };

/* A bond to be made of i < j, `length` long, with that image of j (0 without a periodic cell). */
typedef struct {
    int32_t i, j;
    double length; /* [m] */
    int32_t image[3];
} fl_disc_birth;

/* Bonds that have been removed with a sphere that left. */
typedef struct {
    int32_t broken, left;                     /* broken before; not broken */
    double area;                              /* of those that were broken [m2] */
    double dissipated, damped, friction_loss; /* [J] */
} fl_disc_past;

/* n = 0 and no memory where no spheres are bonded. */
typedef struct {
    int32_t n, damaged; /* damaged: ever, with those that have ended */
    fl_disc_law law;
    fl_disc_class *classes; /* [n_class] */
    int32_t n_class, class_cap;
    fl_disc_arrays at;  /* [n], and more up to whole lanes */
    fl_vec3 *shift;     /* [n] offset that brings j beside i; NULL without a periodic cell [m] */
    int32_t *image;     /* [3 n] the same in lengths of the cell; NULL likewise */
    uint8_t *has_ended; /* [n] enum fl_disc_end */
    double *pending;    /* [n] energy of the contact that a bond of this step leaves [J] */
    double *omega2;     /* [2 n] contribution of bond k to omega^2 of i and of j [1/s2] */
    double *max_omega2; /* [bodies] omega^2 by all bonds of a body while they are whole [1/s2] */
    double largest_omega2, largest_max_omega2; /* of the field [1/s2] */
    int limits_known;                          /* the critical step has the bonds of all bodies in it */
    fl_disc_past past;
    int is_renewed; /* the list is not that of the ice field any more */
    int64_t *first_i, *first_j;
    int32_t *of;       /* [n] bonds of each body j, ascending */
    double *force_sum; /* [n / FL_DISC_RUN + 1] sum of |F| */
    int32_t ended;     /* bonds that ended since the neighbour list was made */
} fl_disc_list;

enum { FL_DISC_RUN = 64 }; /* bonds that a thread takes at a time */

#endif
