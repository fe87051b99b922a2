/* SPDX-License-Identifier: GPL-3.0-or-later */
/* breaking_state.h -- floes that bend and split: room for fragments, their shapes, and what happened
 * (sim/breaking.h). */
#ifndef FL_WORLD_BREAKING_STATE_H
#define FL_WORLD_BREAKING_STATE_H
#include <stdint.h>
#include "geom/poly.h"

/* How a floe broke. */
enum fl_failure_mode { FL_FAILURE_BEND, FL_FAILURE_SPLIT, FL_FAILURE_CUSP };

/* A row of failures(5). */
typedef struct {
    double time;
    int32_t mode;          /* enum fl_failure_mode */
    int32_t parent, child; /* ids; the parent keeps the larger part */
    fl_vec3 x, n;          /* a point of the cut and its unit normal, out of the child */
    double length;         /* of the cut in plan [m] */
    double load;           /* size of the force that broke it [N] */
    double ratio;          /* stress over strength, or K_I over K_IC */
    double mass, child_mass;
    double energy; /* bending energy at hand, or that of the crack [J]; information */
} fl_failure_event;

typedef struct {
    int on;            /* floes may bend or split; else nothing below is used */
    int32_t room;      /* places for fragments */
    double least_area; /* of a fragment in plan; 0: auto [m2] */
    fl_poly **shape;   /* [n] core of a floe that is a fragment, axes of the ice file; NULL: not cut so far */
    double *last_load; /* [n] size of the loads at the last check [N] */
    double *bend_gate; /* [n] vertical load below which it is not checked for bending, 0: not known [N] */
    double *split_gate; /* [n] load below which it is not checked for splitting [N] */
    int64_t checks, bent, split, cusps;
    int64_t too_small, no_room, buckled; /* breaks that did not take place */
    double lost;                         /* elastic energy of contacts lost by cuts [J] */
    fl_failure_event *event;             /* [events] since the last row */
    int32_t events, event_cap;
} fl_breaking_state;

#endif
