/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strip_state.h -- crushing by failure.crushing_law = rate: its law, the walls, and the memory of a contact
 * (contact/strip_contact.h). */
#ifndef FL_WORLD_STRIP_STATE_H
#define FL_WORLD_STRIP_STATE_H
#include "failure/pressure_area.h"
#include "failure/strip.h"
#include "failure/strip_wall.h"

/* An element, in front of the sector of the same number. */
typedef struct {
    fl_strip_element ice;
    double area;   /* of wall in the ice [m2]; 0: the sector is outside of the floe */
    double middle; /* height of its centre, as s of fl_wall_sector [m] */
    double load;   /* force at the end of the last step [N] */
    double e, u;   /* of `ice` before it was passed on [m] */
} fl_strip_cell;

typedef struct {
    int32_t n;
    double largest_area; /* |sum of area vectors| of this contact, at most [m2] */
    double k;            /* of the last step [N/m3] */
    double store;        /* energy at its end [J] */
    double work;         /* what the step crushed [J] */
    fl_vec3 slid,
        turned;        /* motion since ice was last passed on along the wall, frame of the piece [m], [rad] */
    fl_vec3 near_area; /* sum of the area vectors of the ice near the wall [m2] */
    int32_t near_known; /* 0: it has to be summed anew */
    double way;         /* of the ice against the wall [m] */
    double farthest;    /* largest so far */
    double known_until; /* areas hold while the odometers of the two are below this [m] */
    fl_strip_strength strength;
    double closing; /* speed of the ice against the wall along the load [m/s] */
    int32_t breaks; /* in the step */
    fl_strip_cell cell[];
} fl_strip;

/* wall NULL: crushing_law is not rate, and nothing else is used. */
typedef struct {
    fl_wall *wall; /* [pieces] */
    int32_t pieces;
    fl_strip_law law;
    fl_pressure_area pressure;
    double scatter, scatter_length;
    double *part_closing, *part_seconds; /* [parts] integral of closing, and its time, since the last row */
    int64_t *part_breaks;                /* [parts] */
    double too_fast; /* most that a wall closed in a step beyond what is allowed [m]; 0: none */
} fl_strips;

#endif
