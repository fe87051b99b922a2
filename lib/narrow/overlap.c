/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/overlap.h"
#include <math.h>

typedef struct {
    double x, y;
} spot;

static spot seen(const fl_plane_axes *t, fl_vec3 p)
{
    const fl_vec3 d = v3_sub(p, t->o);
    return (spot){v3_dot(t->x, d), v3_dot(t->y, d)};
}

fl_plane_axes fl_plane_axes_of(fl_vec3 o, fl_vec3 n)
{
    const fl_vec3 x = v3_normal_to(n);
    return (fl_plane_axes){o, x, v3_cross(n, x)};
}

/* One of the two outlines from the leftmost corner to the rightmost: the edge from p to q that is under x. */
typedef struct {
    int32_t at, step, left;
    spot p, q;
} outline;

static spot corner(const fl_plane_axes *t, const fl_loop *a, int32_t k) { return seen(t, a->v[a->loop[k]]); }

static int32_t leftmost(const fl_plane_axes *t, const fl_loop *a, double *lo, double *hi)
{
    int32_t at = 0;
    *lo = *hi = corner(t, a, 0).x;
    for (int32_t k = 1; k < a->n; k++) {
        const double x = corner(t, a, k).x;
        *hi = x > *hi ? x : *hi;
        if (x < *lo) {
            *lo = x;
            at = k;
        }
    }
    return at;
}

/* Go on to the edge that reaches beyond x. */
static void go_on(const fl_plane_axes *t, const fl_loop *a, outline *e, double x)
{
    while (e->q.x <= x && e->left > 0) {
        e->left--;
        e->at = (e->at + e->step + a->n) % a->n;
        e->p = e->q;
        e->q = corner(t, a, (e->at + e->step + a->n) % a->n);
    }
}

static outline begin(const fl_plane_axes *t, const fl_loop *a, int32_t at, int32_t step)
{
    const int32_t next = (at + step + a->n) % a->n;
    return (outline){at, step, a->n - 1, corner(t, a, at), corner(t, a, next)};
}

static double height_at(const outline *e, double x)
{
    const double w = e->q.x - e->p.x, s = w > 0.0 ? (x - e->p.x) / w : 1.0;
    return s <= 0.0 ? e->p.y : s >= 1.0 ? e->q.y : (1.0 - s) * e->p.y + s * e->q.y;
}

/* Straight upper and lower bounds over one stretch, at its two ends. */
typedef struct {
    double x[2], u[2], l[2];
} stretch;

typedef struct {
    double a, x, y; /* area and first moments */
} sums;

static double between(const double *v, double s) { return (1.0 - s) * v[0] + s * v[1]; }

static stretch cut(const stretch *t, double s0, double s1)
{
    return (stretch){{between(t->x, s0), between(t->x, s1)},
                     {between(t->u, s0), between(t->u, s1)},
                     {between(t->l, s0), between(t->l, s1)}};
}

static void add_stretch(sums *sum, stretch t)
{
    double h0 = t.u[0] - t.l[0], h1 = t.u[1] - t.l[1];
    if (h0 <= 0.0 && h1 <= 0.0) return;
    if (h0 < 0.0 || h1 < 0.0) { /* the bounds cross: only the open side counts */
        const double s = h0 / (h0 - h1);
        t = h0 < 0.0 ? cut(&t, s, 1.0) : cut(&t, 0.0, s);
        h0 = h0 < 0.0 ? 0.0 : h0;
        h1 = h1 < 0.0 ? 0.0 : h1;
    }
    const double w = t.x[1] - t.x[0], m0 = 0.5 * (t.u[0] + t.l[0]), m1 = 0.5 * (t.u[1] + t.l[1]);
    sum->a += 0.5 * w * (h0 + h1);
    sum->x += w / 6.0 * (t.x[0] * (2.0 * h0 + h1) + t.x[1] * (h0 + 2.0 * h1));
    sum->y += w / 6.0 * (m0 * (2.0 * h0 + h1) + m1 * (h0 + 2.0 * h1));
}

/* Where the difference d[0] .. d[1] of two straight lines is zero inside the stretch, or 0. */
static double crossing(const double *p, const double *q)
{
    const double d0 = p[0] - q[0], d1 = p[1] - q[1];
    return (d0 < 0.0 && d1 > 0.0) || (d0 > 0.0 && d1 < 0.0) ? d0 / (d0 - d1) : 0.0;
}

static void add_strip(sums *sum, double x0, double x1, const double *ua, const double *la, const double *ub,
                      const double *lb)
{
    double s[4] = {0.0, crossing(ua, ub), crossing(la, lb), 1.0};
    if (s[1] > s[2]) {
        const double swap = s[1];
        s[1] = s[2];
        s[2] = swap;
    }
    for (int k = 0; k < 3; k++) {
        if (!(s[k + 1] > s[k])) continue;
        stretch t;
        for (int e = 0; e < 2; e++) {
            const double at = s[k + e];
            t.x[e] = between((const double[2]){x0, x1}, at);
            t.u[e] = fmin(between(ua, at), between(ub, at));
            t.l[e] = fmax(between(la, at), between(lb, at));
        }
        add_stretch(sum, t);
    }
}

fl_projected_overlap fl_overlap_area(const fl_plane_axes *t, fl_loop a, fl_loop b)
{
    double la, ha, lb, hb;
    const int32_t ia = leftmost(t, &a, &la, &ha), ib = leftmost(t, &b, &lb, &hb);
    const double end = fmin(ha, hb);
    double x = fmax(la, lb);
    sums sum = {0};
    outline e[4] = {begin(t, &a, ia, 1), begin(t, &a, ia, -1), begin(t, &b, ib, 1), begin(t, &b, ib, -1)};
    while (x < end) {
        double next = end, u[4][2];
        for (int k = 0; k < 4; k++) {
            go_on(t, k < 2 ? &a : &b, &e[k], x);
            if (e[k].q.x > x && e[k].q.x < next) next = e[k].q.x;
        }
        for (int k = 0; k < 4; k++) {
            u[k][0] = height_at(&e[k], x);
            u[k][1] = height_at(&e[k], next);
        }
        /* Which outline of a polygon is the upper one is the same over the whole strip. */
        const int ta = u[0][0] + u[0][1] >= u[1][0] + u[1][1] ? 0 : 1,
                  tb = u[2][0] + u[2][1] >= u[3][0] + u[3][1] ? 2 : 3;
        add_strip(&sum, x, next, u[ta], u[1 - ta], u[tb], u[5 - tb]);
        x = next;
    }
    if (!(sum.a > 0.0)) return (fl_projected_overlap){0};
    return (fl_projected_overlap){sum.a, sum.x / sum.a, sum.y / sum.a};
}

fl_projected_overlap fl_overlap_length(const fl_plane_axes *t, fl_vec3 p, fl_vec3 q, fl_loop a, double tol)
{
    const spot s = seen(t, p), e = seen(t, q);
    double area = 0.0, t0 = 0.0, t1 = 1.0;
    const spot o = corner(t, &a, 0);
    for (int32_t k = 1; k + 1 < a.n; k++) {
        const spot g = corner(t, &a, k), h = corner(t, &a, k + 1);
        area += (g.x - o.x) * (h.y - o.y) - (g.y - o.y) * (h.x - o.x);
    }
    const double turn = area < 0.0 ? -1.0 : 1.0;
    for (int32_t k = 0; k < a.n; k++) {
        const spot g = corner(t, &a, k), h = corner(t, &a, (k + 1) % a.n);
        const double dx = turn * (h.x - g.x), dy = turn * (h.y - g.y), len = sqrt(dx * dx + dy * dy);
        if (!(len > 0.0)) continue;
        /* Distances inside the edge. */
        const double ds = ((s.y - g.y) * dx - (s.x - g.x) * dy) / len,
                     de = ((e.y - g.y) * dx - (e.x - g.x) * dy) / len;
        if (ds >= -tol && de >= -tol) continue;
        if (ds <= 0.0 && de <= 0.0) return (fl_projected_overlap){0};
        const double at = ds / (ds - de);
        if (ds < de && at > t0) t0 = at;
        if (ds > de && at < t1) t1 = at;
    }
    if (!(t1 > t0)) return (fl_projected_overlap){0};
    const double dx = e.x - s.x, dy = e.y - s.y, m = 0.5 * (t0 + t1);
    return (fl_projected_overlap){(t1 - t0) * sqrt(dx * dx + dy * dy), s.x + m * dx, s.y + m * dy};
}
