/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/table.h"
#include "structure/prescribed_track.h"

/* Larger values are no plausible motion; the square of this one is finite [m, deg, s]. */
#define MAX_VALUE 1e15

static const char *const NAME[6] = {"x", "y", "z", "rx", "ry", "rz"};

static double *component_of(fl_pose6 *p, int k)
{
    double *const of[6] = {&p->x.x, &p->x.y, &p->x.z, &p->r.x, &p->r.y, &p->r.z};
    return of[k];
}

static double component_value(const fl_pose6 *p, int k)
{
    const double of[6] = {p->x.x, p->x.y, p->x.z, p->r.x, p->r.y, p->r.z};
    return of[k];
}

/* Slope at row `end` of the parabola through it and the next two rows inward. */
static double end_slope(const fl_track *tr, int k, int32_t end, int32_t inward)
{
    const int32_t a = end, b = end + inward, c = end + 2 * inward;
    const double h = tr->t[b] - tr->t[a], g = tr->t[c] - tr->t[b];
    const double first = (component_value(&tr->value[b], k) - component_value(&tr->value[a], k)) / h,
                 next = (component_value(&tr->value[c], k) - component_value(&tr->value[b], k)) / g;
    return first + (first - next) * h / (h + g);
}

/* Sets slopes that make the second derivatives continuous at the inner rows: with h, g the intervals before
 * and after row i,
 *     g s[i-1] + 2 (h + g) s[i] + h s[i+1] = 3 (g d[before] + h d[after]),
 * by elimination; the matrix is diagonally dominant, so no pivoting is needed. */
static int make_slopes(fl_track *tr, fl_err *err)
{
    const int32_t n = tr->n;
    double *upper = fl_alloc(n, sizeof *upper, err);
    tr->slope = fl_alloc(n, sizeof *tr->slope, err);
    if (!upper || !tr->slope) {
        free(upper);
        return -1;
    }
    for (int k = 0; k < 6 && n > 1; k++) {
        if (n == 2) {
            const double s = (component_value(&tr->value[1], k) - component_value(&tr->value[0], k)) /
                             (tr->t[1] - tr->t[0]);
            *component_of(&tr->slope[0], k) = *component_of(&tr->slope[1], k) = s;
            continue;
        }
        *component_of(&tr->slope[0], k) = end_slope(tr, k, 0, 1);
        *component_of(&tr->slope[n - 1], k) = end_slope(tr, k, n - 1, -1);
        upper[0] = 0.0;
        for (int32_t i = 1; i < n - 1; i++) {
            const double h = tr->t[i] - tr->t[i - 1], g = tr->t[i + 1] - tr->t[i];
            const double before =
                             (component_value(&tr->value[i], k) - component_value(&tr->value[i - 1], k)) / h,
                         behind =
                             (component_value(&tr->value[i + 1], k) - component_value(&tr->value[i], k)) / g;
            const double pivot = 2.0 * (h + g) - g * upper[i - 1];
            upper[i] = h / pivot;
            *component_of(&tr->slope[i], k) =
                (3.0 * (g * before + h * behind) - g * component_value(&tr->slope[i - 1], k)) / pivot;
        }
        for (int32_t i = n - 2; i > 0; i--)
            *component_of(&tr->slope[i], k) -= upper[i] * component_value(&tr->slope[i + 1], k);
    }
    free(upper);
    return 0;
}

/* Finds the columns, -1 for those missing, and checks their units: a table in other units, or without a
 * motion, is an error and not a structure at rest. */
static int find_columns(const fl_table *in, int32_t *time, int32_t col[6], fl_err *err)
{
    int there = 0;
    if (fl_table_require(in, "t", time, err)) return -1;
    for (int k = -1; k < 6; k++) {
        const int32_t c = k < 0 ? *time : (col[k] = fl_table_column(in, NAME[k]));
        const char *unit = k < 0 ? "s" : k < 3 ? "m" : "deg";
        there += k >= 0 && c >= 0;
        if (c >= 0 && in->unit[c][0] && strcmp(in->unit[c], unit) != 0)
            return fl_text_fail(&in->text, err, "column %s has the unit \"%.40s\", expected %s", in->name[c],
                                in->unit[c], unit);
    }
    if (there) return 0;
    return fl_text_fail(&in->text, err, "no column of a motion, expected at least one of x y z rx ry rz");
}

int fl_track_read(fl_track *out, const char *path, int cubic, fl_err *err)
{
    fl_table in = {0};
    fl_track tr = {0};
    int32_t time, col[6], t_cap = 0, at_cap = 0;
    int rc = -1, more;
    if (fl_table_open(&in, path, "track", 1, err) || find_columns(&in, &time, col, err)) goto done;
    while ((more = fl_table_row(&in, err)) > 0) {
        fl_pose6 at = {0};
        double t;
        if (fl_table_f64_bounded(&in, time, MAX_VALUE, &t, err)) goto done;
        if (tr.n && t <= tr.t[tr.n - 1]) {
            fl_text_fail(&in.text, err, "time %.10g s does not follow %.10g s", t, tr.t[tr.n - 1]);
            goto done;
        }
        for (int k = 0; k < 6; k++) {
            double x = 0.0;
            if (col[k] >= 0 && fl_table_f64_bounded(&in, col[k], MAX_VALUE, &x, err)) goto done;
            *component_of(&at, k) = k < 3 ? x : fl_radians(x);
        }
        if (fl_grow(&tr.t, &t_cap, (int64_t)tr.n + 1, sizeof *tr.t, err) ||
            fl_grow(&tr.value, &at_cap, (int64_t)tr.n + 1, sizeof *tr.value, err))
            goto done;
        tr.t[tr.n] = t;
        tr.value[tr.n++] = at;
    }
    if (more < 0) goto done;
    if (tr.n == 0) {
        fl_text_fail(&in.text, err, "this track has no rows");
        goto done;
    }
    if (cubic && make_slopes(&tr, err)) goto done;
    *out = tr;
    tr = (fl_track){0};
    rc = 0;
done:
    fl_track_free(&tr);
    fl_table_close(&in);
    return rc;
}

/* Row at or before t, such that row + 1 exists; n > 1. */
static int32_t row_before(const fl_track *tr, double t)
{
    int32_t low = 0, high = tr->n - 1;
    while (high - low > 1) {
        const int32_t middle = low + (high - low) / 2;
        if (tr->t[middle] <= t) low = middle;
        else high = middle;
    }
    return low;
}

void fl_track_evaluate(const fl_track *tr, double t, fl_pose6 *x, fl_pose6 *rate, fl_pose6 *second)
{
    *rate = *second = (fl_pose6){0};
    *x = tr->value[0];
    if (tr->n == 1) return;
    const int32_t i = row_before(tr, t);
    const double h = tr->t[i + 1] - tr->t[i], last = tr->t[tr->n - 1];
    const double inside = t < tr->t[0] ? tr->t[0] : t > last ? last : t;
    const double u = (inside - tr->t[i]) / h, beyond = t - inside;
    for (int k = 0; k < 6; k++) {
        const double a = component_value(&tr->value[i], k), d = component_value(&tr->value[i + 1], k) - a;
        double value = a + u * d, slope = d / h, bend = 0.0;
        if (tr->slope) { /* a + h s0 u + (3 d - h (2 s0 + s1)) u^2 + (h (s0 + s1) - 2 d) u^3 */
            const double p = h * component_value(&tr->slope[i], k),
                         q = h * component_value(&tr->slope[i + 1], k);
            const double c2 = 3.0 * d - 2.0 * p - q, c3 = p + q - 2.0 * d;
            value = a + u * (p + u * (c2 + u * c3));
            slope = (p + u * (2.0 * c2 + 3.0 * u * c3)) / h;
            bend = beyond == 0.0 ? (2.0 * c2 + 6.0 * u * c3) / (h * h) : 0.0;
        }
        *component_of(x, k) = value + beyond * slope;
        *component_of(rate, k) = slope;
        *component_of(second, k) = bend;
    }
}

void fl_track_free(fl_track *tr)
{
    free(tr->t), free(tr->value), free(tr->slope);
    *tr = (fl_track){0};
}
