/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure/plan_polygon.h"
#include <math.h>

/* Twice the area of the triangle o, a, b. */
static double cross_of(fl_vec2 o, fl_vec2 a, fl_vec2 b)
{
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/* Inserts a point into the list, sorted by x, then y. */
static void insert_point(fl_vec2 *v, int32_t n, fl_vec2 p)
{
    int32_t k = n;
    while (k > 0 && (v[k - 1].x > p.x || (v[k - 1].x == p.x && v[k - 1].y > p.y))) v[k] = v[k - 1], k--;
    v[k] = p;
}

/* Convex hull of sorted points (Andrew 1979); points within `same` of a side are left out. */
static int32_t hull_of(const fl_vec2 *v, int32_t n, double same, fl_vec2 *out)
{
    int32_t m = 0;
    for (int pass = 0; pass < 2; pass++) {
        const int32_t start = m;
        for (int32_t k = 0; k < n; k++) {
            const fl_vec2 p = pass ? v[n - 1 - k] : v[k];
            while (m - start >= 2 && cross_of(out[m - 2], out[m - 1], p) <=
                                         same * hypot(p.x - out[m - 2].x, p.y - out[m - 2].y))
                m--;
            out[m++] = p;
        }
        m--; /* the last point is the first of the other half */
    }
    return m;
}

void fl_plan_of(fl_plan *q, const fl_poly *p, fl_vec3 x, fl_vec3 y, fl_vec3 up)
{
    fl_vec2 v[2 * FL_PLAN_CORNERS], out[4 * FL_PLAN_CORNERS + 2];
    double low = INFINITY, high = -INFINITY;
    *q = (fl_plan){.n = 0};
    if (p->nv > 2 * FL_PLAN_CORNERS || p->nf == 0) return;
    for (int32_t k = 0; k < p->nv; k++) {
        insert_point(v, k, (fl_vec2){v3_dot(x, p->v[k]), v3_dot(y, p->v[k])});
        low = fmin(low, v3_dot(up, p->v[k])), high = fmax(high, v3_dot(up, p->v[k]));
    }
    const int32_t n = hull_of(v, p->nv, 1e-9 * p->size, out);
    if (n < 3 || n > FL_PLAN_CORNERS || !(high > low)) return;
    q->n = n;
    for (int32_t k = 0; k < n; k++) q->p[k] = out[k];
    q->thickness = high - low;
    q->bottom = low;
}

/* Adds the integrals over the triangle (0, a, b), signed. */
static void add_triangle(fl_plan_moments *m, fl_vec2 a, fl_vec2 b)
{
    const double twice = a.x * b.y - a.y * b.x, sx = a.x + b.x, sy = a.y + b.y;
    m->area += 0.5 * twice;
    m->x += twice / 6.0 * sx;
    m->y += twice / 6.0 * sy;
    m->xx += twice / 24.0 * (sx * sx + a.x * a.x + b.x * b.x);
    m->yy += twice / 24.0 * (sy * sy + a.y * a.y + b.y * b.y);
    m->xy += twice / 24.0 * (sx * sy + a.x * a.y + b.x * b.y);
}

/* Corners of the part e.x <= c. */
static int32_t clip_plan(const fl_plan *q, double ex, double ey, double c, fl_vec2 *out)
{
    int32_t m = 0;
    for (int32_t k = 0; k < q->n; k++) {
        const fl_vec2 a = q->p[k], b = q->p[(k + 1) % q->n];
        const double da = ex * a.x + ey * a.y - c, db = ex * b.x + ey * b.y - c;
        if (da <= 0.0) out[m++] = a;
        if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
            const double t = da / (da - db);
            out[m++] = (fl_vec2){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
        }
    }
    return m;
}

fl_plan_moments fl_plan_part(const fl_plan *q, double ex, double ey, double c)
{
    fl_vec2 v[2 * FL_PLAN_CORNERS];
    fl_plan_moments m = {0};
    const int32_t n = clip_plan(q, ex, ey, c, v);
    for (int32_t k = 0; k < n && n > 2; k++) add_triangle(&m, v[k], v[(k + 1) % n]);
    return m;
}

double fl_plan_width(const fl_plan *q, double ex, double ey, double c, fl_vec2 *middle)
{
    double from = INFINITY, to = -INFINITY;
    for (int32_t k = 0; k < q->n; k++) {
        const fl_vec2 a = q->p[k], b = q->p[(k + 1) % q->n];
        const double da = ex * a.x + ey * a.y - c, db = ex * b.x + ey * b.y - c;
        if ((da > 0.0) == (db > 0.0)) continue;
        const double t = da / (da - db), s = -ey * (a.x + t * (b.x - a.x)) + ex * (a.y + t * (b.y - a.y));
        from = fmin(from, s), to = fmax(to, s);
    }
    const double s = 0.5 * (from + to);
    if (!(to > from)) return 0.0;
    *middle = (fl_vec2){c * ex - s * ey, c * ey + s * ex};
    return to - from;
}

void fl_plan_extent(const fl_plan *q, double ex, double ey, double *from, double *to)
{
    *from = INFINITY, *to = -INFINITY;
    for (int32_t k = 0; k < q->n; k++) {
        const double s = ex * q->p[k].x + ey * q->p[k].y;
        *from = fmin(*from, s), *to = fmax(*to, s);
    }
}
