/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact_events.h -- reads contacts of the ice with a structure, one time after the other.
 *
 * Only contacts with the structure count, j < 0, see contacts(5).  A table of contacts has no row for a time
 * without contacts.  Such times are reconstructed: times are assumed to be equally spaced, by the median of
 * their differences, and missing ones count as times without contacts. */
#ifndef FL_STAT_CONTACT_EVENTS_H
#define FL_STAT_CONTACT_EVENTS_H
#include "base/table.h"
#include "geom/vec3.h"
#include "stat/row_filter.h"

typedef struct {
    int32_t part;        /* j, below 0 */
    fl_vec3 p, n;        /* point [m]; unit normal from the structure to the ice */
    double length, area; /* of the contact, 0 for none [m, m^2] */
    double normal_force; /* > 0 for compression [N] */
    fl_vec3 force;       /* total force on the structure [N] */
} fl_contact_event;

/* Rows to read: times from <= t <= to; conditions as in row_filter.h; the part j, or 0 for all below 0. */
typedef struct {
    double from, to;
    const char *const *where;
    int32_t wheres, part;
} fl_contact_selection;

typedef struct {
    fl_table table;
    fl_contact_selection selection;
    fl_row_filter filter;
    int32_t col[17];
    double t;                /* the time that was read [s] */
    int32_t n, cap;          /* its contacts */
    fl_contact_event *event; /* [n] in the order of the table */
    int32_t times;           /* number of times read so far, with and without contacts of the structure */
    int32_t time_cap;
    double *time; /* [times] */
    int pending;  /* the row in the table belongs to the next time */
} fl_contact_events;

/* Open a table of contacts.  0, or -1 with FL_INPUT, FL_USAGE or FL_SYSTEM in err. */
int fl_contact_events_open(fl_contact_events *h, const char *path, const fl_contact_selection *selection,
                           fl_err *err);

/* The next time: n, event, t.  1, 0 at the end, or -1 with err: a field that is not a number, decreasing
 * time, a normal that is not a unit vector, no time at all. */
int fl_contact_events_next(fl_contact_events *h, fl_err *err);

/* At the end: the number of times the table represents, missing ones included, and their interval [s]; 1 and
 * 0 for a single time.  They cover selection.from to selection.to where these are finite, else from the
 * first to the last time of the table.  0, or -1 with FL_SYSTEM in err. */
int fl_contact_events_span(const fl_contact_events *h, int64_t *times, double *step, fl_err *err);

/* Accepts a zeroed struct and leaves one. */
void fl_contact_events_close(fl_contact_events *h);

#endif
