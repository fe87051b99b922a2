/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strip_state.h -- crushing by failure.crushing_law = rate: its law, the walls, and the memory of a contact
 * (contact/strip_contact.h). */
#ifndef FL_WORLD_STRIP_STATE_H
#define FL_WORLD_STRIP_STATE_H
#include "failure/pressure_area.h"
#include "failure/strip.h"
#include "failure/strip_wall.h"

/* Of the elements of a strip, one array each; element k is in front of sector k of the wall. Vectors have
 * three arrays, in the frame of the piece. */
enum fl_strip_column {
    FL_STRIP_E,                            /* as of fl_strip_element [m] */
    FL_STRIP_U,                            /* [m] */
    FL_STRIP_AREA,                         /* of wall in the ice [m2]; 0: the sector is outside of the floe */
    FL_STRIP_MIDDLE,                       /* height of its centre, as s of fl_wall_sector [m] */
    FL_STRIP_LOAD,                         /* force at the end of the last step [N] */
    FL_STRIP_OLD_E,                        /* before ice was passed on [m] */
    FL_STRIP_OLD_U,                        /* [m] */
    FL_STRIP_NORMAL,                       /* of the wall */
    FL_STRIP_CENTRE = FL_STRIP_NORMAL + 3, /* of the area [m] */
    FL_STRIP_ARM = FL_STRIP_CENTRE + 3,    /* centre x normal [m] */
    FL_STRIP_LEFT = FL_STRIP_ARM + 3,      /* -e with which it left the floe [m]; 0: it did not */
    FL_STRIP_LEFT_AT,                      /* where, and the normal of the wall, axes of the floe */
    FL_STRIP_LEFT_ALONG = FL_STRIP_LEFT_AT + 3,
    FL_STRIP_COLUMNS = FL_STRIP_LEFT_ALONG + 3
};

typedef struct {
    int32_t n, lanes;    /* elements; whole registers */
    double largest_area; /* |sum of area vectors| of this contact, at most [m2] */
    double pressure;     /* p at that area [Pa]; 0: not yet known */
    double k;            /* of the last step [N/m3] */
    double store;        /* energy at its end [J] */
    double work;         /* what the step crushed [J] */
    fl_vec3 slid,
        turned;        /* motion since ice was last passed on along the wall, frame of the piece [m], [rad] */
    fl_vec3 near_area; /* sum of the area vectors of the ice near the wall [m2] */
    int32_t near_known; /* 0: it has to be summed anew */
    int32_t apart;      /* no sector is in the floe */
    double way;         /* of the ice against the wall [m] */
    double farthest;    /* largest so far */
    double known_until; /* areas hold while the odometers of the two are below this [m] */
    fl_strip_strength strength;
    double closing; /* speed of the ice against the wall along the load [m/s] */
    int32_t breaks; /* in the step */
    int32_t *count; /* [lanes] breaks of an element so far */
    double data[];  /* [FL_STRIP_COLUMNS][lanes], then count */
} fl_strip;

static inline double *fl_strip_column(fl_strip *q, int column) { return q->data + column * q->lanes; }

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
