/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/cone_sum.h"
#include <math.h>

/* Bisections to the end of a zone, the length of a double; intervals of a line that are sampled. */
enum { BISECTIONS = 45, SAMPLES = 2 };

/* An end with less than this part of the largest overlap counts as s = 0. */
#define NEARLY_ZERO 0.3

void fl_cone_sum_add(fl_cone_sums *q, fl_vec3 at, fl_vec3 n, double s, double u, double du, double ddu)
{
    const fl_vec3 r = v3_sub(at, q->o), f = v3_scale(du, n);
    const double x = v3_dot(q->x, r), y = v3_dot(q->y, r);
    q->u += u, q->du += du, q->ddu += ddu;
    q->most = s > q->most ? s : q->most;
    q->ds += du * s;
    q->sx += du * x, q->sy += du * y;
    q->sxx += du * x * x, q->sxy += du * x * y, q->syy += du * y * y;
    q->f = v3_add(q->f, f);
    q->m = v3_add(q->m, v3_cross(r, f));
}

int fl_cone_sum_to_points(fl_patch_points *w, const fl_cone_sums *q, int n, double ra)
{
    static const double COS[3] = {1.0, -0.5, -0.5}, SIN[3] = {0.0, 0.86602540378443865, -0.86602540378443865};
    const double size = v3_norm(q->f);
    if (!(q->du > 0.0) || !(size > 0.0)) return 0;
    const double x = q->sx / q->du, y = q->sy / q->du, s = q->ds / q->du;
    const double xx = q->sxx / q->du - x * x, xy = q->sxy / q->du - x * y, yy = q->syy / q->du - y * y;
    const double a = xx > 0.0 ? sqrt((n == 3 ? 2.0 : 1.0) * xx) : 0.0,
                 b = a > 0.0 && n == 3 ? 2.0 * xy / a : 0.0;
    const double c2 = n == 3 ? 2.0 * yy - b * b : 0.0, c = c2 > 0.0 ? sqrt(c2) : 0.0;
    const fl_vec3 across = v3_scale(1.0 / size, q->f);
    const fl_vec3 middle = v3_add(q->o, v3_add(v3_scale(x, q->x), v3_scale(y, q->y)));
    const fl_vec3 at = v3_madd(middle, 0.5 * s - ra, across); /* on the line of the force */
    for (int k = 0; k < n; k++) {
        const double dx = n == 3 ? a * COS[k] : k ? -a : a, dy = n == 3 ? b * COS[k] + c * SIN[k] : 0.0;
        if (fl_patch_points_add(
                w, (fl_patch_point){.group_size = n,
                                    .overlap = q->most,
                                    .u = q->u / n,
                                    .du = q->du / n,
                                    .ddu = q->ddu / n,
                                    .n = v3_scale(1.0 / q->du, q->f),
                                    .unit_normal = across,
                                    .p = v3_add(at, v3_add(v3_scale(dx, q->x), v3_scale(dy, q->y)))}))
            return -1;
    }
    w->couple = v3_add(w->couple, v3_add(q->couple, v3_sub(q->m, v3_cross(v3_sub(middle, q->o), q->f))));
    return 0;
}

void fl_cone_split_interval(fl_cone_intervals *out, int (*zone)(const void *, double), const void *what,
                            double lo, double hi)
{
    double t = lo, in = lo;
    int at = zone(what, lo);
    out->n = 0;
    for (int k = 1; k <= SAMPLES; k++) {
        const double to = lo + (hi - lo) * k / SAMPLES;
        const int then = zone(what, to);
        while (then != at && out->n + 2 < FL_CONE_INTERVALS) {
            double beyond = to;
            for (int m = 0; m < BISECTIONS; m++) {
                const double mid = 0.5 * (in + beyond);
                if (zone(what, mid) == at) in = mid;
                else beyond = mid;
            }
            if (beyond > t) out->s[out->n++] = (fl_cone_interval){t, beyond, at};
            t = in = beyond;
            at = zone(what, beyond);
        }
        in = to;
    }
    if (hi > t) out->s[out->n++] = (fl_cone_interval){t, hi, at};
}

double fl_cone_cluster_node(double u, const int zero[2], double *t)
{
    if (zero[0] && zero[1]) {
        *t = u * u * (3.0 - 2.0 * u);
        return 6.0 * u * (1.0 - u);
    }
    if (zero[0]) {
        *t = u * u;
        return 2.0 * u;
    }
    if (zero[1]) {
        *t = u * (2.0 - u);
        return 2.0 * (1.0 - u);
    }
    *t = u;
    return 1.0;
}

void fl_cone_mark_zero_ends(const double s[3], int zero[2])
{
    const double most = fmax(s[1], fmax(s[0], s[2]));
    zero[0] |= s[0] < NEARLY_ZERO * most;
    zero[1] |= s[2] < NEARLY_ZERO * most;
}

void fl_cone_sort_ascending(double *x, int32_t n)
{
    for (int32_t k = 1; k < n; k++)
        for (int32_t j = k; j > 0 && x[j] < x[j - 1]; j--) {
            const double swap = x[j];
            x[j] = x[j - 1], x[j - 1] = swap;
        }
}
