/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "stat/event.h"

static const double LOW = 0.1, HIGH = 0.9;

/* The first row with the smallest value in a .. b. */
static int32_t find_trough(const double *x, int32_t a, int32_t b)
{
    int32_t at = a;
    for (int32_t k = a; k <= b; k++)
        if (x[k] < x[at]) at = k;
    return at;
}

static double middle_of(const double *edge, int32_t k) { return edge[k] + 0.5 * (edge[k + 1] - edge[k]); }

/* The time nearest to the peak at which x crosses a level between the peak and row end.  Where x stays above,
 * the outer edge of that row. */
static double crossing_time(const double *x, const double *edge, int32_t peak, int32_t end, double level)
{
    const int32_t step = end < peak ? -1 : 1;
    for (int32_t k = peak; k != end; k += step) {
        const int32_t next = k + step;
        if (!(x[next] <= level)) continue;
        const double share = (x[k] - level) / (x[k] - x[next]); /* x[k] > level >= x[next] */
        return middle_of(edge, k) + share * (middle_of(edge, next) - middle_of(edge, k));
    }
    return step < 0 ? edge[end] : edge[end + 1];
}

/* Time from 0.1 to 0.9 of the height, between the peak and row end. */
static double front_duration(const double *x, const double *edge, int32_t peak, int32_t end)
{
    const int32_t foot = end < peak ? find_trough(x, end, peak) : find_trough(x, peak, end);
    const double low = fmax(x[foot], 0.0), height = x[peak] - low;
    return fabs(crossing_time(x, edge, peak, foot, low + HIGH * height) -
                crossing_time(x, edge, peak, foot, low + LOW * height));
}

double fl_event_impulse(int32_t n, const double *x, const double *edge)
{
    double sum = 0.0;
    for (int32_t k = 0; k < n; k++) sum += x[k] * (edge[k + 1] - edge[k]);
    return sum;
}

double fl_event_time_above(int32_t n, const double *x, const double *edge, double level)
{
    double sum = 0.0;
    for (int32_t k = 0; k < n; k++)
        if (x[k] > level) sum += edge[k + 1] - edge[k];
    return sum;
}

fl_event fl_event_of(int32_t n, const double *x, const double *edge, const fl_peaks *p, int32_t k,
                     double level)
{
    const int32_t at = p->row[k];
    fl_event e = {.first = 0, .peak = at, .last = n - 1};
    if (k > 0) e.first = find_trough(x, p->row[k - 1], at) + 1;
    if (k + 1 < p->n) e.last = find_trough(x, at, p->row[k + 1]);
    /* The trough that ends the previous event is the foot of this one. */
    const int32_t foot = k > 0 ? e.first - 1 : 0;
    e.rise = front_duration(x, edge, at, foot);
    e.fall = front_duration(x, edge, at, e.last);
    e.duration =
        crossing_time(x, edge, at, e.last, level * x[at]) - crossing_time(x, edge, at, foot, level * x[at]);
    e.impulse = fl_event_impulse(e.last - e.first + 1, x + e.first, edge + e.first);
    return e;
}
