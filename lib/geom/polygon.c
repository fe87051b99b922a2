/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "geom/polygon.h"

static fl_vec2 sub(fl_vec2 a, fl_vec2 b) { return (fl_vec2){a.x - b.x, a.y - b.y}; }
static double cross(fl_vec2 a, fl_vec2 b) { return a.x * b.y - a.y * b.x; }
static double dot(fl_vec2 a, fl_vec2 b) { return a.x * b.x + a.y * b.y; }

double fl_polygon_area(int32_t n, const fl_vec2 *v)
{
    double twice = 0.0;
    for (int32_t k = 1; k + 1 < n; k++) twice += cross(sub(v[k], v[0]), sub(v[k + 1], v[0]));
    return 0.5 * twice;
}

double fl_polygon_perimeter(int32_t n, const fl_vec2 *v)
{
    double sum = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const fl_vec2 e = sub(v[k + 1 < n ? k + 1 : 0], v[k]);
        sum += sqrt(dot(e, e));
    }
    return sum;
}

double fl_polygon_side_length(int32_t n, const fl_vec2 *v, int32_t k)
{
    const fl_vec2 a = v[k], b = v[k + 1 < n ? k + 1 : 0];
    return hypot(b.x - a.x, b.y - a.y);
}

fl_vec2 fl_polygon_centroid(int32_t n, const fl_vec2 *v)
{
    double twice = 0.0;
    fl_vec2 m = {0.0, 0.0};
    for (int32_t k = 1; k + 1 < n; k++) {
        const fl_vec2 a = sub(v[k], v[0]), b = sub(v[k + 1], v[0]);
        const double w = cross(a, b);
        twice += w;
        m.x += w * (a.x + b.x);
        m.y += w * (a.y + b.y);
    }
    return (fl_vec2){v[0].x + m.x / (3.0 * twice), v[0].y + m.y / (3.0 * twice)};
}

void fl_polygon_rectangle(fl_vec2 lo, fl_vec2 hi, fl_vec2 *v, fl_polygon_side *side)
{
    v[0] = (fl_vec2){lo.x, hi.y};
    v[1] = lo;
    v[2] = (fl_vec2){hi.x, lo.y};
    v[3] = hi;
    side[0] = (fl_polygon_side){-1.0, 0.0, -lo.x, -1};
    side[1] = (fl_polygon_side){0.0, -1.0, -lo.y, -2};
    side[2] = (fl_polygon_side){1.0, 0.0, hi.x, -3};
    side[3] = (fl_polygon_side){0.0, 1.0, hi.y, -4};
}

static void reverse_range(fl_vec2 *v, fl_polygon_side *side, int32_t a, int32_t b)
{
    for (; a < b; a++, b--) {
        const fl_vec2 p = v[a];
        const fl_polygon_side s = side[a];
        v[a] = v[b];
        side[a] = side[b];
        v[b] = p;
        side[b] = s;
    }
}

/* Rotates the arrays so that entry k comes first. */
static void rotate_to_front(int32_t n, fl_vec2 *v, fl_polygon_side *side, int32_t k)
{
    if (k == 0) return;
    reverse_range(v, side, 0, k - 1);
    reverse_range(v, side, k, n - 1);
    reverse_range(v, side, 0, n - 1);
}

static fl_vec2 line_crossing(fl_vec2 a, fl_vec2 b, double beyond_a, double beyond_b)
{
    const double t = beyond_a / (beyond_a - beyond_b);
    return (fl_vec2){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}

int32_t fl_polygon_cut(int32_t n, fl_vec2 *v, fl_polygon_side *side, fl_polygon_side h)
{
    int32_t in = -1, m = 0;
    fl_vec2 last, first;
    fl_polygon_side closing_side;
    double s_in, s_out, s_last, s_first;
    for (int32_t k = 0; k < n; k++) {
        const int inside = fl_polygon_side_distance(h, v[k]) <= 0.0;
        m += inside;
        if (inside && fl_polygon_side_distance(h, v[k ? k - 1 : n - 1]) > 0.0) in = k;
    }
    if (m == n || m == 0 || in < 0) return m;
    /* The corners inside come first, [0, m); those beyond the line follow. */
    rotate_to_front(n, v, side, in);
    s_in = fl_polygon_side_distance(h, v[m - 1]);
    s_out = fl_polygon_side_distance(h, v[m]);
    last = v[n - 1];
    closing_side = side[n - 1];
    first = v[0];
    s_last = fl_polygon_side_distance(h, last);
    s_first = fl_polygon_side_distance(h, first);
    /* A corner on the line itself serves as the end of the new side: no side of length zero is made. */
    if (s_in < 0.0) {
        v[m] = line_crossing(v[m - 1], v[m], s_in, s_out);
        m++;
    }
    side[m - 1] = h;
    if (s_first < 0.0) {
        v[m] = line_crossing(last, first, s_last, s_first);
        side[m++] = closing_side;
    }
    return m >= 3 ? m : 0;
}

fl_vec2 fl_polygon_side_intersect(fl_polygon_side a, fl_polygon_side b, double d)
{
    const double s = 1.0 / fl_polygon_side_sin(a, b), ca = a.c - d, cb = b.c - d;
    return (fl_vec2){s * (ca * b.ny - cb * a.ny), s * (a.nx * cb - b.nx * ca)};
}

void fl_polygon_corners(int32_t n, const fl_polygon_side *side, double d, fl_vec2 *v)
{
    for (int32_t k = 0; k < n; k++) v[k] = fl_polygon_side_intersect(side[k ? k - 1 : n - 1], side[k], d);
}

int32_t fl_polygon_inset(int32_t n, fl_vec2 *v, fl_polygon_side *side, double d, double *depth)
{
    double t = 0.0;
    while (n >= 3) {
        int32_t vanishing = 0;
        double next_event = INFINITY;
        for (int32_t k = 0; k < n; k++) {
            const fl_polygon_side before = side[k ? k - 1 : n - 1], after = side[k + 1 < n ? k + 1 : 0];
            const fl_vec2 e = sub(v[k + 1 < n ? k + 1 : 0], v[k]);
            const double length = e.y * side[k].nx - e.x * side[k].ny;
            const double left = length / (fl_polygon_side_half_tan(before, side[k]) +
                                          fl_polygon_side_half_tan(side[k], after));
            if (left < next_event) {
                next_event = left;
                vanishing = k;
            }
        }
        if (next_event > d - t) {
            fl_polygon_corners(n, side, d, v);
            *depth = d;
            return n;
        }
        if (next_event > 0.0) t += next_event; /* rounding may make the length of a side slightly negative */
        n--;
        for (int32_t k = vanishing; k < n; k++) side[k] = side[k + 1];
        /* The neighbours are parallel, or the corner has passed them: nothing is left between. */
        if (n < 3 || fl_polygon_side_sin(side[vanishing ? vanishing - 1 : n - 1],
                                         side[vanishing < n ? vanishing : 0]) <= 0.0)
            break;
        fl_polygon_corners(n, side, t, v);
    }
    *depth = t;
    return 0;
}

void fl_polygon_outset(int32_t n, const fl_vec2 *v, double r, fl_vec2 *out)
{
    for (int32_t k = 0; k < n; k++) {
        /* Corner k moves by r (na + nb) / (1 + na.nb), which is r along each of the two normals. */
        const fl_vec2 a = sub(v[k], v[k ? k - 1 : n - 1]), b = sub(v[k + 1 < n ? k + 1 : 0], v[k]);
        const double la = sqrt(dot(a, a)), lb = sqrt(dot(b, b));
        const fl_vec2 na = {a.y / la, -a.x / la}, nb = {b.y / lb, -b.x / lb};
        const double s = r / (1.0 + dot(na, nb));
        out[k] = (fl_vec2){v[k].x + s * (na.x + nb.x), v[k].y + s * (na.y + nb.y)};
    }
}

/* Vector from the nearest point of the segment to p. */
static fl_vec2 vector_to_segment(fl_vec2 p, fl_vec2 a, fl_vec2 b)
{
    const fl_vec2 e = sub(b, a), w = sub(p, a);
    double t = dot(w, e) / dot(e, e);
    t = t > 0.0 ? t < 1.0 ? t : 1.0 : 0.0;
    return (fl_vec2){w.x - t * e.x, w.y - t * e.y};
}

static double distance_to_segment(fl_vec2 p, fl_vec2 a, fl_vec2 b)
{
    const fl_vec2 d = vector_to_segment(p, a, b);
    return hypot(d.x, d.y);
}

double fl_polygon_point_distance(int32_t n, const fl_vec2 *v, fl_vec2 p)
{
    double least = INFINITY;
    int inside = 1;
    for (int32_t k = 0; k < n; k++) {
        const fl_vec2 a = v[k], b = v[k + 1 < n ? k + 1 : 0];
        const double d = distance_to_segment(p, a, b);
        if (cross(sub(b, a), sub(p, a)) < 0.0) inside = 0;
        if (d < least) least = d;
    }
    return inside ? 0.0 : least;
}

static int side_separates(int32_t m, const fl_vec2 *a, int32_t n, const fl_vec2 *b)
{
    for (int32_t k = 0; k < m; k++) {
        const fl_vec2 e = sub(a[k + 1 < m ? k + 1 : 0], a[k]);
        int32_t j = 0;
        while (j < n && cross(e, sub(b[j], a[k])) < 0.0) j++;
        if (j == n) return 1;
    }
    return 0;
}

int fl_polygon_is_apart(int32_t m, const fl_vec2 *a, int32_t n, const fl_vec2 *b)
{
    return side_separates(m, a, n, b) || side_separates(n, b, m, a);
}

/* Squares are compared; the root is taken of the smallest only. */
double fl_polygon_distance(int32_t m, const fl_vec2 *a, int32_t n, const fl_vec2 *b)
{
    double least = INFINITY;
    fl_vec2 nearest = {INFINITY, INFINITY};
    for (int32_t i = 0; i < m; i++) {
        const fl_vec2 a1 = a[i + 1 < m ? i + 1 : 0];
        for (int32_t j = 0; j < n; j++) {
            const fl_vec2 b1 = b[j + 1 < n ? j + 1 : 0];
            const fl_vec2 d = vector_to_segment(a[i], b[j], b1), e = vector_to_segment(b[j], a[i], a1);
            const double dd = dot(d, d), ee = dot(e, e);
            if (dd < least) {
                least = dd;
                nearest = d;
            }
            if (ee < least) {
                least = ee;
                nearest = e;
            }
        }
    }
    return hypot(nearest.x, nearest.y);
}
