/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "stat/pressure.h"

/* Relative tolerance of distances: a neighbour one diameter away lies on the opposite rim and counts. */
static const double RIM_TOLERANCE = 1e-12;

/* End of an arc of centres: at this angle a force enters or leaves the disc. */
struct fl_arc_end {
    double angle, force;
    int32_t change; /* +1, -1 */
};

static int compare_angles(const void *a, const void *b)
{
    const struct fl_arc_end *p = a, *q = b;
    if (p->angle != q->angle) return p->angle < q->angle ? -1 : 1;
    return q->change - p->change; /* entering before leaving: the rim belongs to the disc */
}

static double force_inside(const fl_contact_event *c, double area, double r)
{
    double share = 1.0;
    if (c->area > area) share = area / c->area;
    if (c->length > 2.0 * r) share = fmin(share, 2.0 * r / c->length);
    return share * c->normal_force;
}

static int is_loaded(const fl_contact_event *c, int32_t part)
{
    return c->part == part && c->normal_force > 0.0;
}

static void add_arc_end(fl_window_work *w, int32_t *n, double angle, double force, int32_t change)
{
    w->arc_end[(*n)++] = (struct fl_arc_end){angle, force, change};
}

/* The best of all discs with contact i on their rim. */
static void sweep_around(int32_t n, const fl_contact_event *event, int32_t i, int32_t part, double area,
                         fl_window *best, fl_window_work *w)
{
    const double r = sqrt(area / PI);
    const fl_vec3 e1 = v3_normal_to(event[i].n), e2 = v3_cross(event[i].n, e1);
    double force = force_inside(&event[i], area, r), at = 0.0;
    int32_t ends = 0, always = 1;
    for (int32_t j = 0; j < n; j++) {
        if (j == i || !is_loaded(&event[j], part) || !(v3_dot(event[i].n, event[j].n) > 0.0)) continue;
        const fl_vec3 d = v3_sub(event[j].p, event[i].p);
        const double far = v3_norm(d), f = force_inside(&event[j], area, r);
        if (far > 2.0 * r * (1.0 + RIM_TOLERANCE)) continue;
        if (far <= RIM_TOLERANCE * r) { /* same point, always inside */
            force += f;
            always++;
            continue;
        }
        const double to = atan2(v3_dot(d, e2), v3_dot(d, e1)), half = acos(fmin(far / (2.0 * r), 1.0));
        double from = to - half, end = to + half;
        add_arc_end(w, &ends, from, f, 1);
        add_arc_end(w, &ends, end, f, -1);
        /* An arc that crosses -pi or pi is repeated one revolution earlier or later. */
        const double shift = from < -PI ? 2.0 * PI : end > PI ? -2.0 * PI : 0.0;
        if (shift != 0.0) {
            add_arc_end(w, &ends, from + shift, f, 1);
            add_arc_end(w, &ends, end + shift, f, -1);
        }
    }
    qsort(w->arc_end, (size_t)ends, sizeof *w->arc_end, compare_angles);
    double most = force;
    int32_t inside = always, held = always;
    for (int32_t k = 0; k < ends; k++) {
        force += w->arc_end[k].change * w->arc_end[k].force;
        inside += w->arc_end[k].change;
        if (!(force > most)) continue;
        most = force;
        held = inside;
        at = w->arc_end[k].angle;
    }
    if (!(most > best->force)) return;
    const int alone = held == always; /* no neighbour inside: centre the window on the contact */
    best->force = most;
    best->contacts = held;
    best->centre = alone ? event[i].p : v3_madd(v3_madd(event[i].p, r * cos(at), e1), r * sin(at), e2);
}

int fl_largest_load_window(int32_t n, const fl_contact_event *event, int32_t part, double area,
                           fl_window *best, fl_window_work *w, fl_err *err)
{
    *best = (fl_window){0};
    if (fl_grow(&w->arc_end, &w->cap, 4 * (int64_t)n + 4, sizeof *w->arc_end, err)) return -1;
    for (int32_t i = 0; i < n; i++)
        if (is_loaded(&event[i], part)) sweep_around(n, event, i, part, area, best, w);
    return 0;
}

void fl_window_work_free(fl_window_work *w)
{
    free(w->arc_end);
    *w = (fl_window_work){0};
}

double fl_pressure_iso19906(double area) { return area > 10.0 ? 1.48e6 : 7.40e6 * pow(area, -0.70); }

int32_t fl_pressure_fit(int32_t n, const double *area, const double *p, double *c, double *k)
{
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    int32_t m = 0;
    for (int32_t j = 0; j < n; j++) {
        if (!(p[j] > 0.0)) continue;
        sx += log(area[j]);
        sy += log(p[j]);
        m++;
    }
    *c = *k = NAN;
    for (int32_t j = 0; j < n; j++) {
        if (!(p[j] > 0.0)) continue;
        const double x = log(area[j]) - sx / m;
        sxx += x * x;
        sxy += x * (log(p[j]) - sy / m);
    }
    if (m < 2 || !(sxx > 0.0)) return m;
    *k = -sxy / sxx;
    *c = exp(sy / m + *k * sx / m);
    return m;
}
