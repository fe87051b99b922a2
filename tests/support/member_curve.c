/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/member_curve.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- models as text, paths as arrays ------------------------------------------------------------ */

static char text[200000];
static size_t used;

void model_line(const char *fmt, ...)
{
    va_list list;
    va_start(list, fmt);
    used += (size_t)vsnprintf(text + used, sizeof text - used, fmt, list);
    va_end(list);
}

void model_begin(void)
{
    used = 0;
    model_line("#members 1\n");
}

void curve_fatal(const fl_err *err)
{
    fprintf(stderr, "%s\n", err->text);
    exit(1);
}

int32_t curve_node(const fl_member_model *m, const char *name)
{
    const int32_t k = fl_string_table_find(&m->node_name, name);
    if (k < 0) exit(1);
    return k;
}

void curve_chain(fl_member_model *m, fl_member_chain *c, double dt)
{
    fl_text in = {0};
    fl_err err = {0};
    if (fl_text_open_bytes(&in, "model", text, (int64_t)used, &err) ||
        fl_member_model_read_text(m, &in, &err) || fl_member_chain_make(c, m, dt, &err))
        curve_fatal(&err);
    fl_text_close(&in);
}

fl_path_options curve_options(enum fl_relaxation_kind damping, double first, double resolution)
{
    fl_path_options o = fl_path_defaults();
    o.damping = damping;
    o.first = first;
    o.resolution = resolution;
    return o;
}

/* Follows the path of the model in `text` until the displacement along the load is `until`, or watch[0]
 * beyond `until0` where that is not 0. */
void curve_follow(curve *out, const fl_path_options *o, double until, double until0, const watched *watch)
{
    fl_member_model m = {0};
    fl_member_chain c = {0};
    fl_path p = {0};
    fl_err err = {0};
    int32_t node[WATCH] = {0};
    curve_chain(&m, &c, 1.0);
    for (int k = 0; k < WATCH; k++)
        if (watch && watch[k].node) node[k] = curve_node(&m, watch[k].node);
    if (fl_path_start(&p, &c, o, &err)) curve_fatal(&err);
    *out = (curve){.n = 1};
    while (out->n < POINTS) {
        if (fl_path_next(&p, &err)) {
            if (err.code != FL_NO) curve_fatal(&err);
            break;
        }
        const int n = out->n++;
        out->s[n] = p.point.arc;
        out->lambda[n] = p.point.lambda;
        out->along[n] = p.point.along;
        for (int k = 0; k < WATCH; k++)
            if (watch && watch[k].node) out->watch[k][n] = v3_at(c.ball[node[k]].d, watch[k].axis);
        out->balance[n] = p.point.balance;
        if (n > 3) out->largest = fmax(out->largest, fabs(out->balance[n]));
        if ((p.point.hint & (FL_PATH_HINT_MAXIMUM | FL_PATH_HINT_MINIMUM)) && out->limits < 20) {
            out->limit[out->limits] = p.point.limit;
            out->limit_s[out->limits++] = p.point.limit_arc;
        }
        if (until > 0.0 ? p.point.along >= until : until < 0.0 && p.point.along <= until) break;
        if (until0 > 0.0 ? out->watch[0][n] >= until0 : until0 < 0.0 && out->watch[0][n] <= until0) break;
    }
    out->steps = p.total_steps;
    fl_path_free(&p);
    fl_member_chain_free(&c);
    fl_member_model_free(&m);
}

/* Cubic through the four points about the interval [k, k + 1] of y. */
static double near_point(const curve *c, const double *y, int k, double s)
{
    int from = k - 1;
    if (from < 0) from = 0;
    int n = c->n - from < 4 ? c->n - from : 4;
    if (n < 4 && from > 0) {
        from = c->n > 4 ? c->n - 4 : 0;
        n = c->n - from < 4 ? c->n - from : 4;
    }
    return fl_arc_polynomial(n, c->s + from, y + from, s);
}

/* y where x first passes `at` after the arc s0. */
double curve_value(const curve *c, const double *y, const double *x, double at, double s0)
{
    for (int k = 0; k + 1 < c->n; k++) {
        if (c->s[k + 1] <= s0 || !((x[k] - at) * (x[k + 1] - at) <= 0.0)) continue;
        double lo = c->s[k], hi = c->s[k + 1];
        const double sign = x[k + 1] > x[k] ? 1.0 : -1.0;
        for (int n = 0; n < 60; n++) {
            const double mid = 0.5 * (lo + hi);
            if (sign * (near_point(c, x, k, mid) - at) < 0.0) lo = mid;
            else hi = mid;
        }
        return near_point(c, y, k, lo);
    }
    return NAN;
}

/* Value of y at the arc s. */
double curve_at_arc(const curve *c, const double *y, double s)
{
    int k = 0;
    while (k + 2 < c->n && c->s[k + 1] < s) k++;
    return near_point(c, y, k, s);
}
