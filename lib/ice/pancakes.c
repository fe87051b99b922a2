/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/parallel.h"
#include "base/pi.h"
#include "ice/pancakes.h"

/* Iterations until the bracket has the width of rounding: every second one at least halves it. */
enum { STEPS = 120 };

/* Least relative spare radius of a cell; below, a core would have sides too short for any contact. */
#define ROOM 1e-3

struct pancakes {
    const fl_power_cells *cells;
    int32_t sides;
    double radius, reach;  /* R, and R / cos(2 pi / S) */
    double *rho;           /* [n] */
    double *area;          /* [n] of the outer polygons */
    fl_vec2 *v, *outer;    /* scratch: corners of the cell, and `sides` for each floe */
    fl_polygon_side *side; /* scratch */
    fl_vec2 *core;         /* [n sides] */
};

static double inset_of(const struct pancakes *p, int32_t i, double d)
{
    const double most = (1.0 - FL_FLOES_MIN_CORE) * (p->rho[i] - p->reach);
    return d < most ? d : most;
}

/* Phase of the normals of floe i, by the golden section: neighbours have different phases for any number
 * of floes. */
static double phase_of(int32_t i)
{
    const double x = 0.61803398874989485 * i;
    return x - floor(x);
}

static double make_pancake(struct pancakes *p, int32_t i, double d)
{
    const int32_t first = p->cells->first[i], m = p->cells->first[i + 1] - first, s = p->sides;
    const double near = inset_of(p, i, d) + p->reach, r = FL_PANCAKES_ROUNDNESS * (p->rho[i] - near);
    fl_vec2 *v = p->v + first, *core = p->core + (int64_t)s * i, *outer = p->outer + (int64_t)s * i;
    double depth;
    int32_t n;
    memcpy(v, p->cells->v + first, (size_t)m * sizeof *v);
    memcpy(p->side + first, p->cells->side + first, (size_t)m * sizeof *p->side);
    n = fl_polygon_inset(m, v, p->side + first, near + r, &depth);
    for (int32_t k = 0, at = -1; k < s; k++) {
        const double t = 2.0 * PI * (k + phase_of(i)) / s, ux = cos(t), uy = sin(t);
        if (at < 0) { /* farthest corner: once over all corners, then counter-clockwise from the last one */
            at = 0;
            for (int32_t e = 1; e < n; e++)
                if (ux * (v[e].x - v[at].x) + uy * (v[e].y - v[at].y) > 0.0) at = e;
        }
        for (int32_t e = 0; e < n; e++) {
            const int32_t next = at + 1 < n ? at + 1 : 0;
            if (!(ux * (v[next].x - v[at].x) + uy * (v[next].y - v[at].y) > 0.0)) break;
            at = next;
        }
        core[k] = (fl_vec2){v[at].x + r * ux, v[at].y + r * uy};
    }
    fl_polygon_outset(s, core, p->radius, outer);
    return fl_polygon_area(s, outer);
}

static double make_pancakes(struct pancakes *p, double d)
{
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < p->cells->n; i++) p->area[i] = make_pancake(p, i, d);
    return fl_parallel_sum(p->area, p->cells->n);
}

/* The covered area decreases with d: regula falsi and bisection in turn. */
static double solve_inset(struct pancakes *p, double target, double lo, double hi, double over_lo,
                          double over_hi)
{
    double best = INFINITY, d = lo;
    for (int step = 0; step < STEPS && hi > lo; step++) {
        const double x = step % 2 ? 0.5 * (lo + hi) : lo + (hi - lo) * (over_lo / (over_lo - over_hi));
        const double at = x > lo && x < hi ? x : 0.5 * (lo + hi), over = make_pancakes(p, at) - target;
        if (fabs(over) < best) {
            best = fabs(over);
            d = at;
        }
        if (over == 0.0 || at <= lo || at >= hi) break;
        if (over > 0.0) {
            lo = at;
            over_lo = over;
        } else {
            hi = at;
            over_hi = over;
        }
    }
    return d;
}

static int measure_cells(struct pancakes *p, double *total, double *most, fl_err *err)
{
    const fl_power_cells *c = p->cells;
    int32_t tight = 0;
    *most = 0.0;
    for (int32_t i = 0; i < c->n; i++) {
        const int32_t first = c->first[i], m = c->first[i + 1] - first;
        memcpy(p->v + first, c->v + first, (size_t)m * sizeof *p->v);
        memcpy(p->side + first, c->side + first, (size_t)m * sizeof *p->side);
        fl_polygon_inset(m, p->v + first, p->side + first, INFINITY, &p->rho[i]);
        p->area[i] = fl_polygon_area(m, c->v + first);
        if (p->rho[i] < p->rho[tight]) tight = i;
        *most = fmax(*most, p->rho[i]);
    }
    *total = fl_parallel_sum(p->area, c->n);
    if (p->rho[tight] * (1.0 - ROOM) > p->reach) return 0;
    return fl_fail(
        err, FL_INPUT,
        "the cell of floe %d has an inscribed radius of %.4g m, too little for a round core inside a "
        "dilation radius of %.4g m: a smaller radius, fewer floes or more smoothing is needed",
        tight, p->rho[tight], p->radius);
}

static int move_to_floes(struct pancakes *p, double d, fl_vec2 shift, fl_floes *a, fl_err *err)
{
    const int32_t n = p->cells->n;
    a->n = n;
    a->inset = d;
    a->first = fl_alloc((int64_t)n + 1, sizeof *a->first, err);
    if (!a->first) return -1;
    for (int32_t i = 0; i < n; i++) {
        a->first[i + 1] = a->first[i] + p->sides;
        a->limited += inset_of(p, i, d) < d;
        for (int32_t k = a->first[i]; k < a->first[i + 1]; k++) {
            p->core[k].x += shift.x;
            p->core[k].y += shift.y;
        }
        fl_polygon_outset(p->sides, p->core + a->first[i], p->radius, p->outer + a->first[i]);
    }
    a->core = p->core;
    a->outer = p->outer;
    p->core = p->outer = NULL;
    return 0;
}

int fl_pancakes_make(fl_floes *out, const fl_power_cells *cells, int32_t sides, double concentration,
                     double radius, fl_vec2 shift, fl_err *err)
{
    const int32_t n = cells->n;
    struct pancakes p = {.cells = cells, .sides = sides, .radius = radius};
    fl_floes a = {0};
    double total, most, lo, hi, d;
    int rc = -1;
    p.reach = radius / cos(2.0 * PI / sides);
    if ((int64_t)n * sides > INT32_MAX)
        return fl_fail(err, FL_INPUT, "%d floes of %d sides are too many, fewer are expected", n, sides);
    if (!(p.rho = fl_alloc(n, sizeof *p.rho, err)) || !(p.area = fl_alloc(n, sizeof *p.area, err)) ||
        !(p.v = fl_alloc(cells->first[n], sizeof *p.v, err)) ||
        !(p.side = fl_alloc(cells->first[n], sizeof *p.side, err)) ||
        !(p.core = fl_alloc((int64_t)n * sides, sizeof *p.core, err)) ||
        !(p.outer = fl_alloc((int64_t)n * sides, sizeof *p.outer, err)) ||
        measure_cells(&p, &total, &most, err))
        goto done;
    lo = make_pancakes(&p, 0.0) - concentration * total;
    hi = make_pancakes(&p, most) - concentration * total;
    if (lo < 0.0 || hi > 0.0) {
        fl_fail(err, FL_INPUT,
                "round floes in these cells cover %.4g to %.4g of the area, %.10g is requested",
                concentration + hi / total, concentration + lo / total, concentration);
        goto done;
    }
    d = solve_inset(&p, concentration * total, 0.0, most, lo, hi);
    make_pancakes(&p, d);
    if (move_to_floes(&p, d, shift, &a, err)) goto done;
    *out = a;
    a = (fl_floes){0};
    rc = 0;
done:
    fl_floes_free(&a);
    free(p.rho);
    free(p.area);
    free(p.v);
    free(p.side);
    free(p.core);
    free(p.outer);
    return rc;
}

double fl_pancakes_circularity(const fl_floes *a)
{
    double sum = 0.0;
    for (int32_t i = 0; i < a->n; i++) {
        const int32_t n = a->first[i + 1] - a->first[i];
        const double l = fl_polygon_perimeter(n, a->outer + a->first[i]);
        sum += 4.0 * PI * fl_polygon_area(n, a->outer + a->first[i]) / (l * l);
    }
    return sum / a->n;
}
