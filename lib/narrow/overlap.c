/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/overlap.h"
#include <math.h>

typedef struct {
    double x, y;
} plane_point;

static plane_point project_point(const fl_plane_axes *t, fl_vec3 p)
{
    const fl_vec3 d = v3_sub(p, t->o);
    return (plane_point){v3_dot(t->x, d), v3_dot(t->y, d)};
}

fl_plane_axes fl_plane_axes_of(fl_vec3 o, fl_vec3 n)
{
    const fl_vec3 x = v3_normal_to(n);
    return (fl_plane_axes){o, x, v3_cross(n, x)};
}

/* One of the two outlines from the leftmost corner to the rightmost: the edge from p to q that is at x. */
typedef struct {
    int32_t at, step, left;
    plane_point p, q;
} outline;

static plane_point project_corner(const fl_plane_axes *t, const fl_loop *a, int32_t k)
{
    return project_point(t, a->v[a->loop[k]]);
}

static int32_t find_leftmost(const fl_plane_axes *t, const fl_loop *a, double *lo, double *hi)
{
    int32_t at = 0;
    *lo = *hi = project_corner(t, a, 0).x;
    for (int32_t k = 1; k < a->n; k++) {
        const double x = project_corner(t, a, k).x;
        *hi = x > *hi ? x : *hi;
        if (x < *lo) {
            *lo = x;
            at = k;
        }
    }
    return at;
}

/* Advances to the edge that extends beyond x. */
static void advance_outline(const fl_plane_axes *t, const fl_loop *a, outline *e, double x)
{
    while (e->q.x <= x && e->left > 0) {
        e->left--;
        e->at = (e->at + e->step + a->n) % a->n;
        e->p = e->q;
        e->q = project_corner(t, a, (e->at + e->step + a->n) % a->n);
    }
}

static outline start_outline(const fl_plane_axes *t, const fl_loop *a, int32_t at, int32_t step)
{
    const int32_t next = (at + step + a->n) % a->n;
    return (outline){at, step, a->n - 1, project_corner(t, a, at), project_corner(t, a, next)};
}

static double height_at(const outline *e, double x)
{
    const double w = e->q.x - e->p.x, s = w > 0.0 ? (x - e->p.x) / w : 1.0;
    return s <= 0.0 ? e->p.y : s >= 1.0 ? e->q.y : (1.0 - s) * e->p.y + s * e->q.y;
}

/* Straight upper and lower bounds over one strip, at its two ends. */
typedef struct {
    double x[2], u[2], l[2];
} strip;

typedef struct {
    double a, x, y; /* area and first moments */
} moments;

static double interpolate_linear(const double *v, double s) { return (1.0 - s) * v[0] + s * v[1]; }

static strip cut_strip(const strip *t, double s0, double s1)
{
    return (strip){{interpolate_linear(t->x, s0), interpolate_linear(t->x, s1)},
                   {interpolate_linear(t->u, s0), interpolate_linear(t->u, s1)},
                   {interpolate_linear(t->l, s0), interpolate_linear(t->l, s1)}};
}

static void add_open_strip(moments *sum, strip t)
{
    double h0 = t.u[0] - t.l[0], h1 = t.u[1] - t.l[1];
    if (h0 <= 0.0 && h1 <= 0.0) return;
    if (h0 < 0.0 || h1 < 0.0) { /* the bounds cross: only the open side counts */
        const double s = h0 / (h0 - h1);
        t = h0 < 0.0 ? cut_strip(&t, s, 1.0) : cut_strip(&t, 0.0, s);
        h0 = h0 < 0.0 ? 0.0 : h0;
        h1 = h1 < 0.0 ? 0.0 : h1;
    }
    const double w = t.x[1] - t.x[0], m0 = 0.5 * (t.u[0] + t.l[0]), m1 = 0.5 * (t.u[1] + t.l[1]);
    sum->a += 0.5 * w * (h0 + h1);
    sum->x += w / 6.0 * (t.x[0] * (2.0 * h0 + h1) + t.x[1] * (h0 + 2.0 * h1));
    sum->y += w / 6.0 * (m0 * (2.0 * h0 + h1) + m1 * (h0 + 2.0 * h1));
}

/* Where the difference of two straight lines is zero inside the strip, or 0. */
static double crossing_of(const double *p, const double *q)
{
    const double d0 = p[0] - q[0], d1 = p[1] - q[1];
    return (d0 < 0.0 && d1 > 0.0) || (d0 > 0.0 && d1 < 0.0) ? d0 / (d0 - d1) : 0.0;
}

static void add_strip(moments *sum, double x0, double x1, const double *ua, const double *la,
                      const double *ub, const double *lb)
{
    double s[4] = {0.0, crossing_of(ua, ub), crossing_of(la, lb), 1.0};
    if (s[1] > s[2]) {
        const double swap = s[1];
        s[1] = s[2];
        s[2] = swap;
    }
    for (int k = 0; k < 3; k++) {
        if (!(s[k + 1] > s[k])) continue;
        strip t;
        for (int e = 0; e < 2; e++) {
            const double at = s[k + e];
            t.x[e] = interpolate_linear((const double[2]){x0, x1}, at);
            t.u[e] = fmin(interpolate_linear(ua, at), interpolate_linear(ub, at));
            t.l[e] = fmax(interpolate_linear(la, at), interpolate_linear(lb, at));
        }
        add_open_strip(sum, t);
    }
}

fl_projected_overlap fl_overlap_area(const fl_plane_axes *t, fl_loop a, fl_loop b)
{
    double la, ha, lb, hb;
    const int32_t ia = find_leftmost(t, &a, &la, &ha), ib = find_leftmost(t, &b, &lb, &hb);
    const double end = fmin(ha, hb);
    double x = fmax(la, lb);
    moments sum = {0};
    outline e[4] = {start_outline(t, &a, ia, 1), start_outline(t, &a, ia, -1), start_outline(t, &b, ib, 1),
                    start_outline(t, &b, ib, -1)};
    while (x < end) {
        double next = end, u[4][2];
        for (int k = 0; k < 4; k++) {
            advance_outline(t, k < 2 ? &a : &b, &e[k], x);
            if (e[k].q.x > x && e[k].q.x < next) next = e[k].q.x;
        }
        for (int k = 0; k < 4; k++) {
            u[k][0] = height_at(&e[k], x);
            u[k][1] = height_at(&e[k], next);
        }
        /* Which outline of a polygon is the upper one does not change within a strip. */
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
    const plane_point s = project_point(t, p), e = project_point(t, q);
    double area = 0.0, t0 = 0.0, t1 = 1.0;
    const plane_point o = project_corner(t, &a, 0);
    for (int32_t k = 1; k + 1 < a.n; k++) {
        const plane_point g = project_corner(t, &a, k), h = project_corner(t, &a, k + 1);
        area += (g.x - o.x) * (h.y - o.y) - (g.y - o.y) * (h.x - o.x);
    }
    const double turn = area < 0.0 ? -1.0 : 1.0;
    for (int32_t k = 0; k < a.n; k++) {
        const plane_point g = project_corner(t, &a, k), h = project_corner(t, &a, (k + 1) % a.n);
        const double dx = turn * (h.x - g.x), dy = turn * (h.y - g.y), len = sqrt(dx * dx + dy * dy);
        if (!(len > 0.0)) continue;
        /* distances inside the edge */
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
