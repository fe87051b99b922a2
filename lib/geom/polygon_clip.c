/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geom/polygon_clip.h"
#include <string.h>

static double left_of(fl_vec2 o, fl_vec2 d, fl_vec2 p) { return d.x * (p.y - o.y) - d.y * (p.x - o.x); }

int32_t fl_polygon_keep_left(int32_t n, fl_vec2 *v, fl_vec2 o, fl_vec2 d)
{
    int32_t in = -1, m = 0;
    for (int32_t k = 0; k < n && in < 0; k++)
        if (left_of(o, d, v[k]) >= 0.0 && left_of(o, d, v[k ? k - 1 : n - 1]) < 0.0) in = k;
    if (in < 0) return n > 0 && left_of(o, d, v[0]) >= 0.0 ? n : 0;
    /* the corners that stay come first */
    for (int32_t turn = 0; turn < in; turn++) {
        const fl_vec2 first = v[0];
        memmove(v, v + 1, (size_t)(n - 1) * sizeof *v);
        v[n - 1] = first;
    }
    while (m < n && left_of(o, d, v[m]) >= 0.0) m++;
    const fl_vec2 a = v[m - 1], b = v[m], y = v[n - 1], z = v[0];
    const double sa = left_of(o, d, a), sb = left_of(o, d, b), sy = left_of(o, d, y), sz = left_of(o, d, z);
    const double t = sa / (sa - sb), u = sz / (sz - sy);
    if (sa > 0.0) v[m++] = (fl_vec2){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
    if (sz > 0.0) v[m++] = (fl_vec2){z.x + u * (y.x - z.x), z.y + u * (y.y - z.y)};
    return m >= 3 ? m : 0;
}

int32_t fl_polygon_common(int32_t n, const fl_vec2 *a, int32_t m, const fl_vec2 *b, fl_vec2 *out)
{
    if (out != a) memcpy(out, a, (size_t)n * sizeof *a);
    for (int32_t k = 0; k < m && n > 0; k++) {
        const fl_vec2 o = b[k], e = b[k + 1 < m ? k + 1 : 0];
        n = fl_polygon_keep_left(n, out, o, (fl_vec2){e.x - o.x, e.y - o.y});
    }
    return n;
}

fl_polygon_moments fl_polygon_moments_of(int32_t n, const fl_vec2 *v)
{
    fl_polygon_moments s = {0};
    double x = 0.0, y = 0.0;
    if (n < 1) return s;
    s.centre = v[0];
    for (int32_t k = 1; k + 1 < n; k++) {
        const double ax = v[k].x - v[0].x, ay = v[k].y - v[0].y, bx = v[k + 1].x - v[0].x,
                     by = v[k + 1].y - v[0].y;
        const double w = 0.5 * (ax * by - ay * bx), mx = ax + bx, my = ay + by;
        s.area += w;
        x += w * mx / 3.0, y += w * my / 3.0;
        s.xx += w / 12.0 * (ax * ax + bx * bx + mx * mx);
        s.xy += w / 12.0 * (ax * ay + bx * by + mx * my);
        s.yy += w / 12.0 * (ay * ay + by * by + my * my);
    }
    if (!(s.area > 0.0)) return s;
    x /= s.area, y /= s.area;
    s.centre = (fl_vec2){v[0].x + x, v[0].y + y};
    s.xx -= s.area * x * x, s.xy -= s.area * x * y, s.yy -= s.area * y * y;
    return s;
}
