/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ice/floe_sides.h"
#include <math.h>
#include <omp.h>
#include <string.h>
#include "base/array.h"

enum { KEPT = 1, FIXED = 2 };

void fl_floe_sides_free(fl_floe_sides *f)
{
    free(f->inradius);
    free(f->max_inset);
    free(f->area);
    free(f->perimeter);
    free(f->count);
    free(f->side);
    for (int k = 0; k < f->threads && f->scratch; k++) {
        free(f->scratch[k].moved);
        free(f->scratch[k].kept);
        free(f->scratch[k].corner);
        free(f->scratch[k].state);
    }
    free(f->scratch);
}

static int scratch_alloc(fl_floe_sides *f, fl_err *err)
{
    int32_t most = 0;
    for (int32_t i = 0; i < f->cells->n; i++) {
        const int32_t m = f->cells->first[i + 1] - f->cells->first[i];
        if (m > most) most = m;
    }
    f->threads = omp_get_max_threads();
    if (!(f->scratch = fl_alloc(f->threads, sizeof *f->scratch, err))) return -1;
    for (int k = 0; k < f->threads; k++) {
        fl_floe_scratch *s = &f->scratch[k];
        if (!(s->moved = fl_alloc(most, sizeof *s->moved, err)) ||
            !(s->kept = fl_alloc(most, sizeof *s->kept, err)) ||
            !(s->corner = fl_alloc(most, sizeof *s->corner, err)) || !(s->state = fl_alloc(most, 1, err)))
            return -1;
    }
    return 0;
}

int fl_floe_sides_alloc(fl_floe_sides *f, fl_err *err)
{
    const int32_t n = f->cells->n;
    return (f->inradius = fl_alloc(n, sizeof(double), err)) &&
                   (f->max_inset = fl_alloc(n, sizeof(double), err)) &&
                   (f->area = fl_alloc(n, sizeof(double), err)) &&
                   (f->perimeter = fl_alloc(n, sizeof(double), err)) &&
                   (f->count = fl_alloc(n, sizeof(int32_t), err)) &&
                   (f->side = fl_alloc(f->cells->first[n], sizeof(fl_polygon_side), err))
               ? scratch_alloc(f, err)
               : -1;
}

const fl_floe_scratch *fl_floe_sides_scratch(const fl_floe_sides *f)
{
    return &f->scratch[omp_get_thread_num()];
}

double fl_floe_sides_inset(const fl_floe_sides *f, int32_t i, double d)
{
    if (f->own_inset) d = f->own_inset[i];
    return d < f->max_inset[i] ? d : f->max_inset[i];
}

/* Least length of side e, between sides a and b, on a core of inscribed radius rho.  The tangents from the
 * corner of a and b to the inscribed circle cut rho (tan + tan) at the depth of the circle; half of it
 * stays clear. */
static double least_side(const fl_floe_sides *f, fl_polygon_side a, fl_polygon_side e, fl_polygon_side b,
                         double rho)
{
    const double clear = 0.5 * (fl_polygon_side_half_tan(a, e) + fl_polygon_side_half_tan(e, b));
    return rho * (clear < f->min_side ? clear : f->min_side);
}

/* The outer corner of a and b at inset d has to be inside the cell by `spare`. Returns how far it is
 * beyond that, and the side of the cell between a and b that it violates most. */
static double max_excess(const fl_polygon_side *cell, int32_t m, fl_polygon_side a, fl_polygon_side b,
                         double d, double spare, int32_t *worst)
{
    const fl_vec2 w = fl_polygon_side_intersect(a, b, d);
    double most = -INFINITY;
    for (int32_t e = (a.tag + 1) % m; e != b.tag; e = (e + 1) % m) {
        const double x = fl_polygon_side_distance(cell[e], w) + spare;
        if (x > most) {
            most = x;
            *worst = e;
        }
    }
    return most;
}

/* Move side e inward between the sides a and b of the core until its own length is the least one. */
static void move_side(const fl_floe_sides *f, fl_polygon_side *line, unsigned char *state, int32_t e,
                      fl_polygon_side a, fl_polygon_side b, double inset, double rho)
{
    const fl_vec2 q = fl_polygon_side_intersect(a, b, inset);
    const fl_polygon_side s = line[e];
    const double per_depth = fl_polygon_side_cos(a, s) / fl_polygon_side_sin(a, s) +
                             fl_polygon_side_cos(s, b) / fl_polygon_side_sin(s, b);
    line[e].c = s.nx * q.x + s.ny * q.y - least_side(f, a, s, b, rho) / per_depth + inset;
    state[e] = KEPT | FIXED;
}

/* The core of the sides kept so far; sides that vanish are no longer kept. */
static int32_t core_of(const fl_polygon_side *line, unsigned char *state, int32_t m, double inset,
                       fl_polygon_side *left, fl_vec2 *corner)
{
    int32_t k = 0;
    double depth;
    for (int32_t e = 0; e < m; e++)
        if (state[e] & KEPT) left[k++] = line[e];
    fl_polygon_corners(k, left, 0.0, corner);
    k = fl_polygon_inset(k, corner, left, inset, &depth);
    for (int32_t e = 0; e < m; e++) state[e] &= (unsigned char)~KEPT;
    for (int32_t e = 0; e < k; e++) state[left[e].tag] |= KEPT;
    return k;
}

/* The shortest side that is too short, -1 if there is none: a side without a decision, or a fixed side
 * that its neighbours shortened by more than a quarter. */
static int32_t find_short_side(const fl_floe_sides *f, const unsigned char *state, int32_t n,
                               const fl_polygon_side *left, const fl_vec2 *corner, double rho)
{
    int32_t at = -1;
    double least = INFINITY;
    for (int32_t k = 0; k < n; k++) {
        const fl_polygon_side a = left[k ? k - 1 : n - 1], b = left[k + 1 < n ? k + 1 : 0];
        const double limit =
            state[left[k].tag] & FIXED ? 0.75 * least_side(f, a, left[k], b, rho) : f->short_side * rho;
        const double l = fl_polygon_side_length(n, corner, k);
        if (l < limit && l < least) {
            least = l;
            at = k;
        }
    }
    return at;
}

/* Decide on one short side: drop it, move it inward, or keep it.  Returns 0 if there was none. */
static int fix_short_side(const fl_floe_sides *f, const fl_polygon_side *cell, int32_t m,
                          fl_polygon_side *line, unsigned char *state, int32_t n, const fl_polygon_side *left,
                          const fl_vec2 *corner, double d, double rho)
{
    const int32_t at = find_short_side(f, state, n, left, corner, rho);
    int32_t e, worst = 0;
    fl_polygon_side a, b;
    if (at < 0) return 0;
    e = left[at].tag;
    a = left[at ? at - 1 : n - 1];
    b = left[at + 1 < n ? at + 1 : 0];
    if (n > 3 && fl_polygon_side_sin(a, b) > 0.0 && max_excess(cell, m, a, b, d, 0.5 * d, &worst) <= 0.0)
        state[e] &= (unsigned char)~KEPT;
    else if (fl_polygon_side_sin(a, b) > 0.0 &&
             fl_polygon_side_length(n, corner, at) < least_side(f, a, left[at], b, rho))
        move_side(f, line, state, e, a, b, d + f->radius, rho);
    else state[e] |= FIXED; /* it stays as it is; between sides that open outward it is short only here */
    return 1;
}

int fl_floe_sides_choose(fl_floe_sides *f, int32_t i, double d)
{
    const int32_t first = f->cells->first[i], m = f->cells->first[i + 1] - first;
    const fl_polygon_side *cell = f->cells->side + first;
    const fl_floe_scratch *s = fl_floe_sides_scratch(f);
    fl_polygon_side *line = s->moved, *left = s->kept;
    fl_vec2 *corner = s->corner;
    unsigned char *state = s->state;
    const double di = fl_floe_sides_inset(f, i, d), rho = f->inradius[i] - di - f->radius;
    for (int32_t e = 0; e < m; e++) {
        line[e] = cell[e];
        line[e].tag = e;
        state[e] = KEPT;
    }
    /* Each side is dropped once and moved a few times; a cell that needs more rounds has no room for a
     * floe. */
    for (int32_t round = 0; round < 8 * (m + 2); round++) {
        const int32_t n = core_of(line, state, m, di + f->radius, left, corner);
        int changed = 0;
        if (n == 0) return -1;
        for (int32_t k = 0; k < n; k++) {
            const fl_polygon_side a = left[k], b = left[k + 1 < n ? k + 1 : 0];
            int32_t e = 0;
            if (max_excess(cell, m, a, b, di, 0.5 * di, &e) > 0.0) {
                move_side(f, line, state, e, a, b, di + f->radius, rho);
                changed = 1;
            }
        }
        if (changed || fix_short_side(f, cell, m, line, state, n, left, corner, di, rho)) continue;
        memcpy(f->side + first, left, (size_t)n * sizeof *left);
        f->count[i] = n;
        return 0;
    }
    return -1;
}

/* Sides are valid while at least half of every margin is left. */
int fl_floe_sides_are_valid(fl_floe_sides *f, int32_t i, double d)
{
    const int32_t first = f->cells->first[i], m = f->cells->first[i + 1] - first, n = f->count[i];
    const fl_polygon_side *side = f->side + first;
    fl_vec2 *corner = fl_floe_sides_scratch(f)->corner;
    const double di = fl_floe_sides_inset(f, i, d), rho = f->inradius[i] - di - f->radius;
    fl_polygon_corners(n, side, di + f->radius, corner);
    for (int32_t k = 0; k < n; k++) {
        const fl_polygon_side a = side[k ? k - 1 : n - 1], b = side[k + 1 < n ? k + 1 : 0];
        const fl_vec2 p = corner[k], q = corner[k + 1 < n ? k + 1 : 0];
        int32_t e = 0;
        if ((q.y - p.y) * side[k].nx - (q.x - p.x) * side[k].ny < 0.5 * least_side(f, a, side[k], b, rho))
            return 0;
        if (max_excess(f->cells->side + first, m, side[k], b, di, 0.25 * di, &e) > 0.0) return 0;
    }
    return 1;
}
