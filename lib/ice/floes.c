/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "base/parallel.h"
#include "ice/floe_sides.h"
#include "ice/floes.h"

enum { ROUNDS = 40, NEWTON = 60 };

/* --- the inset ------------------------------------------------------------------------------------------ */

/* Area of the outer polygons minus target at inset d.  *fall: its rate of decrease with d, the sum of the
 * perimeters of floes that are not limited. raw: with all sides that remain of the cells. */
static double excess_area(fl_floe_sides *f, int raw, double d, double target, double *fall)
{
    const int32_t n = f->cells->n;
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < n; i++) {
        const int32_t first = f->cells->first[i];
        const double di = fl_floe_sides_inset(f, i, d);
        fl_polygon_side *left = fl_floe_sides_scratch(f)->kept;
        fl_vec2 *v = fl_floe_sides_scratch(f)->corner;
        int32_t m = f->count[i];
        if (raw) {
            double depth;
            m = f->cells->first[i + 1] - first;
            memcpy(v, f->cells->v + first, (size_t)m * sizeof *v);
            memcpy(left, f->cells->side + first, (size_t)m * sizeof *left);
            m = fl_polygon_inset(m, v, left, di, &depth);
        } else {
            fl_polygon_corners(m, f->side + first, di, v);
        }
        f->area[i] = fl_polygon_area(m, v);
        f->perimeter[i] = d < f->max_inset[i] ? fl_polygon_perimeter(m, v) : 0.0;
    }
    *fall = fl_parallel_sum(f->perimeter, n);
    return fl_parallel_sum(f->area, n) - target;
}

/* Root of excess_area(), which decreases and is convex: Newton's step from the left stays left of the root
 * and converges; a bracket handles rounding and a start from the right.  The iteration ends after three
 * steps without improvement, which is at the rounding of the sum.
 *    *d  in: initial value.  out: the root
 * Returns 0, or -1 if there is none in [0, hi]. */
static int solve_inset(fl_floe_sides *f, int raw, double target, double hi, double *d)
{
    double lo = 0.0, x = *d, best = INFINITY;
    int idle = 0;
    for (int step = 0; step < NEWTON && idle < 3; step++) {
        double fall;
        const double over = excess_area(f, raw, x, target, &fall);
        if (fabs(over) < best) {
            best = fabs(over);
            *d = x;
            idle = 0;
        } else {
            idle++;
        }
        if (over == 0.0) break;
        if (over > 0.0) lo = x;
        else hi = x;
        x = fall > 0.0 ? x + over / fall : hi;
        if (!(x >= lo && x <= hi)) x = 0.5 * (lo + hi);
    }
    return best <= 1e-9 * target ? 0 : -1;
}

/* Measure the inscribed circles; the smallest cell must have room for a core. */
static int measure_cells(fl_floe_sides *f, double *total, double *hi, fl_err *err)
{
    const fl_power_cells *c = f->cells;
    int32_t tight = 0;
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < c->n; i++) {
        const int32_t first = c->first[i], m = c->first[i + 1] - first;
        const fl_floe_scratch *s = fl_floe_sides_scratch(f);
        memcpy(s->corner, c->v + first, (size_t)m * sizeof *s->corner);
        memcpy(s->kept, c->side + first, (size_t)m * sizeof *s->kept);
        fl_polygon_inset(m, s->corner, s->kept, INFINITY, &f->inradius[i]);
        f->max_inset[i] = (1.0 - FL_FLOES_MIN_CORE) * (f->inradius[i] - f->radius);
        f->area[i] = fl_polygon_area(m, c->v + first);
    }
    *hi = 0.0;
    for (int32_t i = 0; i < c->n; i++) {
        if (f->inradius[i] < f->inradius[tight]) tight = i;
        if (f->max_inset[i] > *hi) *hi = f->max_inset[i];
    }
    *total = fl_parallel_sum(f->area, c->n);
    /* a core below a thousandth of its cell would have sides too short for any contact */
    if (f->inradius[tight] * (1.0 - 1e-3) > f->radius) return 0;
    return fl_fail(err, FL_INPUT,
                   "the cell of floe %d has an inscribed radius of %.4g m, too little for a core inside a "
                   "dilation radius of %.4g m: a smaller radius, fewer floes or more smoothing is needed",
                   tight, f->inradius[tight], f->radius);
}

static int fail_no_room(const fl_floe_sides *f, int32_t i, fl_err *err)
{
    return fl_fail(err, FL_INPUT,
                   "the cell of floe %d, inscribed radius %.4g m, leaves no room for a core inside a "
                   "dilation radius of %.4g m: a smaller radius, fewer floes or more smoothing is needed",
                   i, f->inradius[i], f->radius);
}

/* Alternate between sides and inset until the sides are valid at the resulting inset.  The floes cover
 * `lost` [m2] more than requested, since their corners will be cut; total and hi are those of
 * measure_cells(). */
static int fit_sides(fl_floe_sides *f, double concentration, double total, double hi, double lost, double *d,
                     fl_err *err)
{
    const int32_t n = f->cells->n;
    const double target = concentration * total + lost;
    double fall, over;
    over = excess_area(f, 1, hi, target, &fall);
    if (over > 0.0)
        return fl_fail(
            err, FL_INPUT,
            "floes of dilation radius %.4g m in these cells cover %.4g of the area at least, %.10g is "
            "requested: a smaller radius or fewer floes is needed",
            f->radius, concentration + over / total, concentration);
    *d = 0.0;
    if (solve_inset(f, 1, target, hi, d))
        return fl_fail(err, FL_NUMERIC, "no inset gives a concentration of %.17g", concentration);
    for (int round = 0; round < ROUNDS; round++) {
        int32_t changed = 0, bad = INT32_MAX;
#pragma omp parallel for schedule(static) reduction(+ : changed) reduction(min : bad)
        for (int32_t i = 0; i < n; i++) {
            if (round && fl_floe_sides_are_valid(f, i, *d)) continue;
            changed++;
            if (fl_floe_sides_choose(f, i, *d) && i < bad) bad = i;
        }
        if (bad < INT32_MAX) return fail_no_room(f, bad, err);
        if (changed == 0) return 0;
        over = excess_area(f, 0, 0.0, target, &fall);
        if (over < 0.0)
            return fl_fail(
                err, FL_INPUT,
                "floes of dilation radius %.4g m in these cells cover about %.10g of the area at most, "
                "%.10g is requested: a smaller radius or more smoothing is needed",
                f->radius, concentration + over / total, concentration);
        if (solve_inset(f, 0, target, hi, d)) break;
    }
    return fl_fail(err, FL_NUMERIC, "sides and inset of %d floes do not converge at a concentration of %.17g",
                   n, concentration);
}

/* --- sharp corners -------------------------------------------------------------------------------------- */

/* Distance from corner k of the core of floe i, along its two sides, at which the corner is cut; 0: it
 * stays.  The new side has FL_FLOES_MIN_SIDE times the radius rho of the inscribed circle, unless the
 * corner is so sharp that this would take more than a quarter of a side.  *lost is the triangle that the
 * outer polygon loses.  With the angle t its corner is r / sin(t / 2) from that of the core, and the new
 * side r; so it is cut at the depth h + r (1 / sin(t / 2) - 1) if the core is cut at h, for any inset. */
static double blunt_length(const fl_floe_sides *f, int32_t n, const fl_polygon_side *side,
                           const fl_vec2 *core, int32_t k, double rho, double *lost)
{
    const int32_t before = k ? k - 1 : n - 1;
    /* the sides turn by pi - t, and tan((pi - t) / 2) = cot(t / 2) */
    const double cot = fl_polygon_side_half_tan(side[before], side[k]),
                 quarter =
                     0.25 * fmin(fl_polygon_side_length(n, core, before), fl_polygon_side_length(n, core, k));
    const double sine = 1.0 / hypot(1.0, cot); /* of t / 2 */
    double along, depth;
    *lost = 0.0;
    if (!(f->sharp_cot > 0.0 && cot > f->sharp_cot)) return 0.0;
    along = 0.5 * f->min_side * rho / sine;
    if (!(along < quarter)) along = quarter;
    depth = along * cot * sine + f->radius * (1.0 / sine - 1.0);
    *lost = depth * depth / cot;
    return along;
}

static double core_inradius(const fl_floe_sides *f, int32_t i, double d)
{
    return f->inradius[i] - fl_floe_sides_inset(f, i, d) - f->radius;
}

/* Total lost area at inset d, and the number of cut corners. */
static double lost_area(fl_floe_sides *f, double d, int32_t *corners)
{
    int32_t all = 0;
#pragma omp parallel for schedule(static) reduction(+ : all)
    for (int32_t i = 0; i < f->cells->n; i++) {
        const int32_t first = f->cells->first[i], n = f->count[i];
        fl_vec2 *corner = fl_floe_sides_scratch(f)->corner;
        double lost;
        fl_polygon_corners(n, f->side + first, fl_floe_sides_inset(f, i, d) + f->radius, corner);
        f->area[i] = 0.0;
        for (int32_t k = 0; k < n; k++) {
            all += blunt_length(f, n, f->side + first, corner, k, core_inradius(f, i, d), &lost) > 0.0;
            f->area[i] += lost;
        }
    }
    *corners = all;
    return fl_parallel_sum(f->area, f->cells->n);
}

/* Alternate between sides with inset and the lost area, which changes little with the inset. */
static int fit_blunted(fl_floe_sides *f, double concentration, double *d, fl_err *err)
{
    double lost = 0.0, total, hi;
    if (measure_cells(f, &total, &hi, err)) return -1;
    for (int round = 0; round < ROUNDS; round++) {
        double next;
        int32_t corners;
        if (fit_sides(f, concentration, total, hi, lost, d, err)) return -1;
        next = lost_area(f, *d, &corners);
        if (corners == f->blunted_corners && fabs(next - lost) <= 1e-12 * lost) return 0;
        f->blunted_corners = corners;
        lost = next;
    }
    return fl_fail(err, FL_NUMERIC,
                   "corners and inset of %d floes do not converge at a concentration of %.17g", f->cells->n,
                   concentration);
}

/* --- the floes ------------------------------------------------------------------------------------------ */

/* Corners of the core of floe i at inset d, about the origin; v has room for twice its sides.  Returns
 * their number. */
static int32_t core_of(const fl_floe_sides *f, int32_t i, double d, fl_vec2 *v)
{
    const fl_polygon_side *side = f->side + f->cells->first[i];
    const int32_t n = f->count[i];
    fl_vec2 *core = fl_floe_sides_scratch(f)->corner;
    int32_t m = 0;
    fl_polygon_corners(n, side, fl_floe_sides_inset(f, i, d) + f->radius, core);
    for (int32_t k = 0; k < n; k++) {
        double lost;
        const double along = blunt_length(f, n, side, core, k, core_inradius(f, i, d), &lost);
        const fl_polygon_side a = side[k ? k - 1 : n - 1], b = side[k];
        if (!(along > 0.0)) {
            v[m++] = core[k];
            continue;
        }
        /* side a has the direction (-ny, nx) and ends here; b starts here */
        v[m++] = (fl_vec2){core[k].x + along * a.ny, core[k].y - along * a.nx};
        v[m++] = (fl_vec2){core[k].x - along * b.ny, core[k].y + along * b.nx};
    }
    return m;
}

static int collect_floes(const fl_floe_sides *f, double d, fl_vec2 shift, fl_floes *a, fl_err *err)
{
    const fl_power_cells *c = f->cells;
    const int64_t room = (int64_t)c->first[c->n] + f->blunted_corners;
    a->n = c->n;
    a->inset = d;
    a->blunted_corners = f->blunted_corners;
    a->first = fl_alloc((int64_t)c->n + 1, sizeof *a->first, err);
    a->core = fl_alloc(room, sizeof *a->core, err);
    a->outer = fl_alloc(room, sizeof *a->outer, err);
    if (!a->first || !a->core || !a->outer) return -1;
    for (int32_t i = 0; i < c->n; i++) {
        const fl_polygon_side *side = f->side + c->first[i];
        fl_vec2 *core = a->core + a->first[i];
        const int32_t m = core_of(f, i, d, core);
        a->first[i + 1] = a->first[i] + m;
        for (int32_t k = 0; k < m; k++) {
            core[k].x += shift.x;
            core[k].y += shift.y;
        }
        for (int32_t k = 0; k < f->count[i]; k++)
            a->shifted_sides += side[k].c < c->side[c->first[i] + side[k].tag].c;
        fl_polygon_outset(m, core, f->radius, a->outer + a->first[i]);
        a->limited += f->own_inset ? f->max_inset[i] <= f->own_inset[i] : f->max_inset[i] < d;
        a->dropped_sides += c->first[i + 1] - c->first[i] - f->count[i];
    }
    return 0;
}

int fl_floes_make(fl_floes *out, const fl_power_cells *cells, double concentration, double radius,
                  fl_vec2 shift, fl_err *err)
{
    fl_floe_sides f = {.cells = cells,
                       .radius = radius,
                       .short_side = FL_FLOES_SHORT_SIDE,
                       .min_side = FL_FLOES_MIN_SIDE,
                       .sharp_cot = 1.0 / tan(0.5 * FL_FLOES_SHARP_ANGLE)};
    fl_floes a = {0};
    double d = 0.0;
    int rc = -1;
    if (fl_floe_sides_alloc(&f, err) || fit_blunted(&f, concentration, &d, err) ||
        collect_floes(&f, d, shift, &a, err))
        goto done;
    *out = a;
    a = (fl_floes){0};
    rc = 0;
done:
    fl_floes_free(&a);
    fl_floe_sides_free(&f);
    return rc;
}

/* --- each its own --------------------------------------------------------------------------------------- */

/* Area of floe i at inset d, with the selected sides or, raw, with all sides that remain of its cell. */
static double area_of(fl_floe_sides *f, int raw, int32_t i, double d, double *outline)
{
    const int32_t first = f->cells->first[i];
    fl_polygon_side *left = fl_floe_sides_scratch(f)->kept;
    fl_vec2 *v = fl_floe_sides_scratch(f)->corner;
    int32_t m = f->count[i];
    double depth;
    if (raw) {
        m = f->cells->first[i + 1] - first;
        memcpy(v, f->cells->v + first, (size_t)m * sizeof *v);
        memcpy(left, f->cells->side + first, (size_t)m * sizeof *left);
        m = fl_polygon_inset(m, v, left, d, &depth);
    } else {
        fl_polygon_corners(m, f->side + first, d, v);
    }
    *outline = fl_polygon_perimeter(m, v);
    return fl_polygon_area(m, v);
}

/* Newton's method from inset 0, where the area is largest: the area decreases and is convex, so the
 * iterates approach from the left.  Returns -1 if the floe is too small without an inset. */
static int solve_floe_inset(fl_floe_sides *f, int raw, int32_t i, double target, double *d)
{
    double x = 0.0, best = INFINITY;
    for (int step = 0, idle = 0; step < NEWTON && idle < 2; step++) {
        double outline;
        const double over = area_of(f, raw, i, x, &outline) - target;
        if (step == 0 && over < -1e-12 * target) return -1;
        idle = fabs(over) < best ? 0 : idle + 1;
        if (fabs(over) < best) {
            best = fabs(over);
            *d = x;
        }
        if (over == 0.0 || !(outline > 0.0)) break;
        x = fmax(0.0, fmin(x + over / outline, f->max_inset[i]));
    }
    return 0;
}

/* Alternate between sides and inset of floe i.  Returns 0; 1: no room; 2: the target is too large. */
static int fit_floe(fl_floe_sides *f, double *own, int32_t i, double target)
{
    if (solve_floe_inset(f, 1, i, target, &own[i])) return 2;
    for (int round = 0; round < ROUNDS; round++) {
        if (round && fl_floe_sides_are_valid(f, i, own[i])) return 0;
        if (fl_floe_sides_choose(f, i, own[i])) return 1;
        if (solve_floe_inset(f, 0, i, target, &own[i])) return 2;
    }
    return 1;
}

static int fit_all_floes(fl_floe_sides *f, double *own, const double *part, double factor, fl_err *err)
{
    int32_t bad = INT32_MAX, much = INT32_MAX;
#pragma omp parallel for schedule(static) reduction(min : bad, much)
    for (int32_t i = 0; i < f->cells->n; i++) {
        const int32_t first = f->cells->first[i], m = f->cells->first[i + 1] - first;
        const double cell = fl_polygon_area(m, f->cells->v + first), p = factor * part[i];
        const int rc = p < 1.0 ? fit_floe(f, own, i, p * cell) : 2;
        double outline;
        if (rc == 1 && i < bad) bad = i;
        if (rc == 2 && i < much) much = i;
        if (rc == 0) f->area[i] = area_of(f, 0, i, fl_floe_sides_inset(f, i, 0.0), &outline);
    }
    if (bad < INT32_MAX) return fail_no_room(f, bad, err);
    if (much == INT32_MAX) return 0;
    return fl_fail(err, FL_INPUT, "floe %d cannot cover %.6g of its cell: a smaller radius or less is needed",
                   much, factor * part[much]);
}

/* Find the insets; the other floes compensate the excess of limited floes. */
static int fit_graded(fl_floe_sides *f, double *own, const double *part, double *off, fl_err *err)
{
    const int32_t n = f->cells->n;
    double total, hi, *requested = fl_alloc(n, sizeof *requested, err),
                      *free_part = fl_alloc(n, sizeof *requested, err);
    double *limited_area = fl_alloc(n, sizeof *limited_area, err), factor = 1.0, last = 0.0;
    int rc = -1;
    if (!requested || !free_part || !limited_area || measure_cells(f, &total, &hi, err)) goto done;
    for (int32_t i = 0; i < n; i++) {
        limited_area[i] = f->area[i]; /* area of the cell, as measured */
        requested[i] = part[i] * limited_area[i];
    }
    total = fl_parallel_sum(requested, n);
    for (int round = 0; round < ROUNDS && fabs(factor - last) > 1e-15; round++) {
        if (fit_all_floes(f, own, part, factor, err)) goto done;
        *off = 0.0;
        for (int32_t i = 0; i < n; i++) {
            const int is = own[i] >= f->max_inset[i];
            if (!is) *off = fmax(*off, part[i] * fabs(f->area[i] / requested[i] - 1.0));
            free_part[i] = is ? 0.0 : requested[i];
            limited_area[i] = is ? f->area[i] : 0.0;
        }
        last = factor;
        factor = (total - fl_parallel_sum(limited_area, n)) / fl_parallel_sum(free_part, n);
        if (factor > 0.0) continue;
        fl_fail(err, FL_INPUT, "floes of dilation radius %.4g m cannot cover so little of these cells",
                f->radius);
        goto done;
    }
    rc = 0;
done:
    free(requested);
    free(free_part);
    free(limited_area);
    return rc;
}

int fl_floes_make_graded(fl_floes *out, const fl_power_cells *cells, const double *part, double radius,
                         fl_vec2 shift, double *off, fl_err *err)
{
    fl_floe_sides f = {
        .cells = cells, .radius = radius, .short_side = FL_FLOES_SHORT_SIDE, .min_side = FL_FLOES_MIN_SIDE};
    double *own = fl_alloc(cells->n, sizeof *own, err);
    fl_floes a = {0};
    int rc = -1;
    f.own_inset = own;
    if (!own || fl_floe_sides_alloc(&f, err) || fit_graded(&f, own, part, off, err) ||
        collect_floes(&f, 0.0, shift, &a, err))
        goto done;
    a.inset = fl_parallel_sum(own, cells->n) / cells->n;
    *out = a;
    a = (fl_floes){0};
    rc = 0;
done:
    fl_floes_free(&a);
    fl_floe_sides_free(&f);
    free(own);
    return rc;
}

int fl_floes_fill(fl_floes *out, const fl_power_cells *cells, double radius, fl_vec2 shift, fl_err *err)
{
    fl_floe_sides f = {
        .cells = cells, .radius = radius, .short_side = FL_FLOES_FILL_SIDE, .min_side = FL_FLOES_FILL_SIDE};
    fl_floes a = {0};
    double total, hi;
    int32_t bad = INT32_MAX;
    int rc = -1;
    if (fl_floe_sides_alloc(&f, err) || measure_cells(&f, &total, &hi, err)) goto done;
#pragma omp parallel for schedule(static) reduction(min : bad)
    for (int32_t i = 0; i < cells->n; i++)
        if (fl_floe_sides_choose(&f, i, 0.0) && i < bad) bad = i;
    if (bad < INT32_MAX) fail_no_room(&f, bad, err);
    else if (collect_floes(&f, 0.0, shift, &a, err) == 0) {
        *out = a;
        a = (fl_floes){0};
        rc = 0;
    }
done:
    fl_floes_free(&a);
    fl_floe_sides_free(&f);
    return rc;
}

void fl_floes_remove(fl_floes *a, const char *gone, int32_t *name)
{
    int32_t n = 0, at = 0;
    for (int32_t i = 0; i < a->n; i++) {
        const int32_t from = a->first[i], m = a->first[i + 1] - from;
        if (gone[i]) continue;
        memmove(a->core + at, a->core + from, (size_t)m * sizeof *a->core);
        memmove(a->outer + at, a->outer + from, (size_t)m * sizeof *a->outer);
        a->first[n] = at; /* n <= i: first[i + 1] is read later */
        name[n++] = name[i];
        at += m;
    }
    a->first[n] = at;
    a->n = n;
}

void fl_floes_free(fl_floes *a)
{
    free(a->first);
    free(a->core);
    free(a->outer);
    *a = (fl_floes){0};
}
