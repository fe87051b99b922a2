/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inflow_state.h -- floes that leave the domain and floes that come in (sim/inflow.h moves them).
 *
 * Every floe has a place in the arrays, [0, n).  The place of a floe that has left is reused for one that
 * comes in, so memory is bounded by the number of floes in the domain at a time.
 *
 * The inflow is a field of ice that is copied again and again against the drift: an endless sheet that moves
 * at one speed.  Copy m of floe k is due when its foremost point reaches the bound, at
 *     t = (lag[k] + m pitch) / speed.
 * The floe is then guided until its last point is inside: x, y and the rotation about z are fixed, so that it
 * drifts with the sheet whatever is in its way.  Bonded spheres are guided in all degrees of freedom. */
#ifndef FL_WORLD_INFLOW_STATE_H
#define FL_WORLD_INFLOW_STATE_H
#include <stdint.h>
#include "scene/ice_field.h"
#include "world/disc_state.h"

/* A floe that the sheet has `by` away, in the same copy or in the next one. */
typedef struct {
    int32_t floe;
    fl_vec3 by; /* [m] */
} fl_inflow_partner;

/* Bonds of spheres that come in: sim/inflow_bonds.h.  All is NULL without them. */
typedef struct {
    int64_t *first;             /* [feed->n + 1] offsets into partner */
    fl_inflow_partner *partner; /* those that floe k is bonded to */
    int32_t *newest;            /* [feed->n] place of the latest copy of floe k, -1 none */
    fl_disc_birth *birth;       /* [births] bonds to be made at the end of this step */
    int32_t births, birth_cap;
} fl_inflow_join;

typedef struct {
    uint8_t *absent;     /* [n] the place is empty; NULL: no bound is free, and nothing else here is set */
    int32_t places;      /* end of the places that have held a floe so far */
    int32_t floes;       /* in the domain now */
    int leaves;          /* some bound is free; else places are for fragments alone */
    fl_vec3 lo, hi;      /* free bounds; a floe that is wholly beyond one leaves [m]; infinite: not free */
    int64_t *entry_step; /* [n] step in which the floe came in */
    int64_t n_left, n_entered;               /* floes that left and came in so far */
    double mass_left, mass_entered;          /* [kg] */
    fl_vec3 momentum_left, momentum_entered; /* [kg m/s] */
    const fl_ice_field *feed; /* borrowed: the field that is copied; NULL: there is no inflow */
    const fl_ice_field *ice;  /* borrowed: the ice of the start; NULL: there is no inflow */
    int axis;                 /* of the drift: 0 x, 1 y */
    double sign, entry;     /* +1: drift to larger coordinates; sign times the coordinate of the bound [m] */
    double speed, pitch;    /* of the sheet [m/s]; length of a copy along the drift [m] */
    double *lag;            /* [feed->n] distance behind the front of the field [m] */
    int64_t *next_copy;     /* [feed->n] m of the copy that comes next */
    int32_t *source_floe;   /* [n] floe of `feed`; -1: a floe of the ice file */
    uint8_t *guided;        /* [n] */
    uint8_t *own_fixed_dof; /* [n] degrees of freedom that stay fixed after the guidance ends */
    int32_t next_id;
    fl_inflow_join join;
    int64_t n_blocked, n_dropped; /* floes whose place was taken when due; floes dropped a pitch later */
} fl_inflow_state;

#endif
