/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "stat/rainflow.h"

const char *fl_rainflow_rule_name(int rule)
{
    static const char *const name[FL_RAINFLOW_RULES] = {"astm", "iso"};
    return name[rule];
}

const char *fl_residue_name(int residue)
{
    static const char *const name[FL_RESIDUES] = {"half", "repeat", "none"};
    return name[residue];
}

static int close_cycle(fl_rainflow *f, double a, double b, double count, fl_err *err)
{
    if (fl_grow(&f->cycle, &f->cycle_cap, (int64_t)f->cycles + 1, sizeof *f->cycle, err)) return -1;
    f->cycle[f->cycles++] = (fl_cycle){fabs(b - a), 0.5 * a + 0.5 * b, count};
    return 0;
}

/* Remove the two points before the last one. */
static void drop_inner_points(fl_rainflow *f)
{
    f->point[f->n - 3] = f->point[f->n - 1];
    f->n -= 2;
}

/* Close the cycles that the last point, now a confirmed turning point, completes. */
static int reduce_astm(fl_rainflow *f, fl_err *err)
{
    while (f->n >= 3) {
        const double *p = f->point + f->n - 3, X = fabs(p[2] - p[1]), Y = fabs(p[1] - p[0]);
        if (X < Y) break;
        /* With three points left, the range contains the start; otherwise another range precedes it. */
        if (f->n == 3) {
            if (close_cycle(f, p[0], p[1], 0.5, err)) return -1;
            f->point[0] = f->point[1];
            f->point[1] = f->point[2];
            f->n = 2;
        } else {
            if (close_cycle(f, p[0], p[1], 1.0, err)) return -1;
            drop_inner_points(f);
        }
    }
    return 0;
}

static int reduce_four_points(fl_rainflow *f, fl_err *err)
{
    while (f->n >= 4) {
        const double *p = f->point + f->n - 4, inner = fabs(p[2] - p[1]);
        if (inner > fabs(p[1] - p[0]) || inner > fabs(p[3] - p[2])) break;
        if (close_cycle(f, p[1], p[2], 1.0, err)) return -1;
        drop_inner_points(f);
    }
    return 0;
}

static int close_complete_cycles(fl_rainflow *f, fl_err *err)
{
    return f->rule == FL_RAINFLOW_ASTM ? reduce_astm(f, err) : reduce_four_points(f, err);
}

int fl_rainflow_push(fl_rainflow *f, double x, fl_err *err)
{
    const int32_t n = f->n;
    if (n && x == f->point[n - 1]) return 0;
    if (n >= 2 && (x > f->point[n - 1]) == (f->point[n - 1] > f->point[n - 2])) {
        f->point[n - 1] = x; /* same direction: the last point was not a turning point */
        return 0;
    }
    if (n >= 2 && close_complete_cycles(f, err)) return -1;
    if (fl_grow(&f->point, &f->cap, (int64_t)f->n + 1, sizeof *f->point, err)) return -1;
    f->point[f->n++] = x;
    return 0;
}

int fl_rainflow_end(fl_rainflow *f, int residue, fl_err *err)
{
    if (f->n && close_complete_cycles(f, err)) return -1;
    if (f->rule == FL_RAINFLOW_FOUR_POINT && residue == FL_RESIDUE_REPEAT && f->n > 1) {
        const int32_t n = f->n;
        double *copy = fl_alloc(n, sizeof *copy, err);
        int rc = copy ? 0 : -1;
        for (int32_t k = 0; rc == 0 && k < n; k++) copy[k] = f->point[k];
        for (int32_t k = 0; rc == 0 && k < n; k++) rc = fl_rainflow_push(f, copy[k], err);
        free(copy);
        /* The residue of the doubled residue is the residue itself: it is not counted. */
        if (rc || close_complete_cycles(f, err)) return -1;
    }
    if (f->rule == FL_RAINFLOW_ASTM || residue == FL_RESIDUE_HALF) {
        for (int32_t k = 0; k + 1 < f->n; k++)
            if (close_cycle(f, f->point[k], f->point[k + 1], 0.5, err)) return -1;
    }
    f->n = 0;
    return 0;
}

int fl_rainflow_count(fl_rainflow *f, int rule, int residue, int32_t n, const double *x, fl_err *err)
{
    f->rule = rule;
    f->n = f->cycles = 0;
    for (int32_t k = 0; k < n; k++)
        if (fl_rainflow_push(f, x[k], err)) return -1;
    return fl_rainflow_end(f, residue, err);
}

void fl_rainflow_free(fl_rainflow *f)
{
    free(f->point);
    free(f->cycle);
    *f = (fl_rainflow){0};
}

double fl_sn_damage(const fl_sn_curve *sn, double range, double count)
{
    if (!(range > 0.0)) return 0.0;
    if (range >= sn->knee) return count * pow(range, sn->m) / sn->a;
    if (isinf(sn->m2)) return 0.0;
    return count * pow(sn->knee, sn->m) / sn->a * pow(range / sn->knee, sn->m2);
}

double fl_rainflow_equivalent(int32_t n, const fl_cycle *cycle, double m)
{
    double large = 0.0, sum = 0.0, count = 0.0;
    for (int32_t k = 0; k < n; k++) large = fmax(large, cycle[k].range);
    /* In units of the largest range, so that no power overflows. */
    for (int32_t k = 0; k < n; k++) {
        sum += cycle[k].count * pow(cycle[k].range / large, m);
        count += cycle[k].count;
    }
    return count > 0.0 ? large * pow(sum / count, 1.0 / m) : 0.0;
}
