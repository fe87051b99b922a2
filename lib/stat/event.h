/* SPDX-License-Identifier: GPL-3.0-or-later */
/* event.h -- loading events: rise, fall, duration and impulse of each peak.
 *
 * The event of a peak reaches from the trough before it to the trough after it.  A trough is the first
 * smallest value between two peaks and belongs to the event that it ends.  The first event begins with the
 * record, the last one ends with it.  So every row belongs to one event, and the impulses of all events add
 * up to the impulse of the record. */
#ifndef FL_STAT_EVENT_H
#define FL_STAT_EVENT_H
#include <stdint.h>
#include "stat/peaks.h"

/* One event, with the signal linear between the middles of its rows.  P is the peak, B the smallest value of
 * the event before the peak, but not below 0:
 *     rise      between the last crossings of B + 0.1 (P - B) and B + 0.9 (P - B) before the peak
 *     fall      the same backward in time, after the peak
 *     duration  between the last crossing of level P before the peak and the first one after it; an event
 *               that begins or ends above this level counts from its own ends
 *     impulse   sum of x w over its rows, w the duration of a row
 * A front of one row rises within the interval of the rows: this limits the resolution of the rise time.
 * Source: IEEE Std 181-2011 for the 10 % and 90 % points of a transition. */
typedef struct {
    int32_t first, peak, last;   /* rows */
    double rise, fall, duration; /* [s] */
    double impulse;              /* [unit of x times s] */
} fl_event;

/* Event k of a record.
 *   n, x[n], edge[n + 1]   row i holds x for edge[i] .. edge[i + 1] [s]
 *   p                      its peaks, 0 <= k < p->n, all above 0
 *   level                  0 < level < 1
 * The cost is proportional to the rows between the neighbours of the peak.  Cannot fail. */
fl_event fl_event_of(int32_t n, const double *x, const double *edge, const fl_peaks *p, int32_t k,
                     double level);

/* Time above a level, the sum of w over rows with x > level [s], and the impulse, the sum of x w. */
double fl_event_time_above(int32_t n, const double *x, const double *edge, double level);
double fl_event_impulse(int32_t n, const double *x, const double *edge);

#endif
