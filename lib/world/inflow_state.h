/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inflow_state.h -- floes that leave the domain and floes that come in. */
#ifndef FL_WORLD_INFLOW_STATE_H
#define FL_WORLD_INFLOW_STATE_H
#include <stdint.h>
#include "scene/ice_field.h"

/* Floes that leave, and floes that come in.  Every floe has a place in the arrays, [0, n); that of one that
 * has left is empty and is taken again by one that comes, so memory is bounded by what is there at a time.
 *
 * What comes in is a field, copied again and again against the drift: an endless sheet that moves at one
 * speed.  Copy m of floe k is due when its foremost point reaches the bound, at t = (lag[k] + m pitch) /
 * speed. It is then given its place, and is guided: held in x, y and about z, so that it drifts as the sheet
 * does whatever is in its way, until the last of it is inside. */
typedef struct {
    uint8_t
        *absent;    /* [n] nobody is in this place; NULL: nobody leaves or comes, and the rest is not there */
    fl_vec3 lo, hi; /* who is wholly beyond leaves [m]; infinite where nobody does */
    int64_t *entry_step; /* [n] the step in which it came                               */
    int64_t n_left, n_entered;
    double mass_left, mass_entered;          /* [kg]    */
    fl_vec3 momentum_left, momentum_entered; /* [kg m/s] */
    const fl_ice_field *feed,
        *ice; /* borrowed: what comes in, and what stood there at first; NULL: nobody comes */
    int axis; /* of the drift: 0 x, 1 y */
    double sign, entry, speed, pitch; /* +1: upwards; the bound, times sign [m]; [m/s]; [m] */
    double *lag;                      /* [feed->n] [m] */
    int64_t *next_copy;               /* [feed->n] m of the copy that is next */
    int32_t *source_floe;             /* [n] which of feed; -1: one of the ice file */
    uint8_t *guided, *own_fixed_dof;  /* [n] whether; what else holds it afterwards */
    int32_t next_id;
    int64_t n_blocked, n_dropped; /* floes whose place was taken; that had to be given up a pitch later */
} fl_inflow_state;

#endif
