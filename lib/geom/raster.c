/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "geom/raster.h"

static const double VISIBLE_TOL = 2.0; /* [pixels] an edge lies within one of its faces */
static const double RADIANS = 0.01745329251994329577;

int fl_raster_start(fl_raster *r, fl_view_axes axes, int32_t w, int32_t h, double u0, double v0, double pixel,
                    fl_err *err)
{
    const int64_t n = (int64_t)w * h;
    *r = (fl_raster){.axes = axes, .w = w, .h = h, .u0 = u0, .v0 = v0, .pixel = pixel};
    r->part = fl_alloc(n, sizeof *r->part, err);
    r->depth = r->part ? fl_alloc(n, sizeof *r->depth, err) : NULL;
    r->light = r->depth ? fl_alloc(n, sizeof *r->light, err) : NULL;
    if (!r->light) {
        fl_raster_free(r);
        return -1;
    }
    for (int64_t k = 0; k < n; k++) {
        r->part[k] = FL_RASTER_NONE;
        r->depth[k] = -INFINITY;
    }
    return 0;
}

void fl_raster_free(fl_raster *r)
{
    free(r->part);
    free(r->depth);
    free(r->light);
    *r = (fl_raster){0};
}

/* [pixels] coincident faces differ by rounding and would be drawn in specks of both */
static const double TIE = 1e-6;

static double component_of(fl_vec3 x, int axis) { return axis == 0 ? x.x : axis == 1 ? x.y : x.z; }

/* Converts to pixels, depth included: pixel centres have integer coordinates. */
static fl_vec3 to_pixels(const fl_raster *r, fl_vec3 x)
{
    return v3((component_of(x, r->axes.right) - r->u0) / r->pixel - 0.5,
              (component_of(x, r->axes.up) - r->v0) / r->pixel - 0.5,
              r->axes.side * component_of(x, r->axes.toward) / r->pixel);
}

static int32_t clamp_pixel(double x, int32_t n) { return x < 0.0 ? 0 : x > n - 1.0 ? n - 1 : (int32_t)x; }

/* Twice the area of a, b, (u, v) in the picture plane. */
static double twice_area(fl_vec3 a, fl_vec3 b, double u, double v)
{
    return (b.x - a.x) * (v - a.y) - (b.y - a.y) * (u - a.x);
}

static void fill_triangle(fl_raster *r, int32_t part, fl_vec3 a, fl_vec3 b, fl_vec3 c)
{
    const fl_vec3 n = v3_unit(v3_cross(v3_sub(b, a), v3_sub(c, a)));
    const float light = (float)(fabs(0.35 * n.x + 0.45 * n.y) + 0.82 * fabs(n.z));
    const double area = twice_area(a, b, c.x, c.y);
    const int32_t u1 = clamp_pixel(floor(fmax(a.x, fmax(b.x, c.x))), r->w),
                  v1 = clamp_pixel(floor(fmax(a.y, fmax(b.y, c.y))), r->h);
    if (area == 0.0) return;
    for (int32_t v = clamp_pixel(ceil(fmin(a.y, fmin(b.y, c.y))), r->h); v <= v1; v++)
        for (int32_t u = clamp_pixel(ceil(fmin(a.x, fmin(b.x, c.x))), r->w); u <= u1; u++) {
            const double p = twice_area(b, c, u, v) / area, q = twice_area(c, a, u, v) / area,
                         s = 1.0 - p - q;
            const int64_t k = (int64_t)v * r->w + u;
            const double depth = (p * a.z + q * b.z + s * c.z) * r->pixel;
            if (p < 0.0 || q < 0.0 || s < 0.0 || !(depth > r->depth[k] + TIE * r->pixel)) continue;
            r->depth[k] = depth;
            r->part[k] = part;
            r->light[k] = light < 1.0f ? light : 1.0f;
        }
}

void fl_raster_fill(fl_raster *r, const fl_surface *s)
{
    for (int32_t i = 0; i < s->n; i++)
        for (int32_t t = 0; t < s->part[i].nt; t++) {
            const fl_part *p = &s->part[i];
            const int32_t *v = p->t[t].v;
            fill_triangle(r, i, to_pixels(r, p->v[v[0]]), to_pixels(r, p->v[v[1]]), to_pixels(r, p->v[v[2]]));
        }
}

/* --- edges ---------------------------------------------------------------------------------------------- */

typedef struct {
    int32_t lo, hi, t;
} edge_record;

static int compare_ends(const void *x, const void *y)
{
    const edge_record *a = x, *b = y;
    if (a->lo != b->lo) return a->lo < b->lo ? -1 : 1;
    if (a->hi != b->hi) return a->hi < b->hi ? -1 : 1;
    return a->t < b->t ? -1 : a->t > b->t;
}

static void draw_line(fl_raster *r, fl_vec3 a, fl_vec3 b)
{
    const double length = fmax(fabs(b.x - a.x), fabs(b.y - a.y));
    const int64_t n = length < 4.0 * (r->w + r->h) ? (int64_t)ceil(length) : 4 * ((int64_t)r->w + r->h);
    for (int64_t k = 0; k <= n; k++) {
        const fl_vec3 x = v3_lerp(a, b, n ? (double)k / (double)n : 0.0);
        const double u = floor(x.x + 0.5), v = floor(x.y + 0.5);
        if (!(u >= 0.0 && u < r->w && v >= 0.0 && v < r->h)) continue;
        const int64_t at = (int64_t)v * r->w + (int64_t)u;
        if (x.z < r->depth[at] / r->pixel - VISIBLE_TOL) continue;
        r->part[at] = FL_RASTER_LINE; /* the depth is kept: edges do not hide each other */
    }
}

static fl_vec3 triangle_normal(const fl_part *p, int32_t t)
{
    const int32_t *v = p->t[t].v;
    return v3_unit(v3_cross(v3_sub(p->v[v[1]], p->v[v[0]]), v3_sub(p->v[v[2]], p->v[v[0]])));
}

static int draw_part_lines(fl_raster *r, const fl_part *p, double flat, fl_err *err)
{
    int64_t n = 0;
    edge_record *s = fl_alloc(3 * (int64_t)p->nt, sizeof *s, err);
    if (!s) return -1;
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 0; k < 3; k++) {
            const int32_t a = p->t[t].v[k], b = p->t[t].v[(k + 1) % 3];
            s[n++] = a < b ? (edge_record){a, b, t} : (edge_record){b, a, t};
        }
    qsort(s, (size_t)n, sizeof *s, compare_ends);
    for (int64_t from = 0, to; from < n; from = to) {
        for (to = from + 1; to < n && s[to].lo == s[from].lo && s[to].hi == s[from].hi;) to++;
        if (to - from == 2 &&
            fabs(v3_dot(triangle_normal(p, s[from].t), triangle_normal(p, s[from + 1].t))) > flat)
            continue;
        draw_line(r, to_pixels(r, p->v[s[from].lo]), to_pixels(r, p->v[s[from].hi]));
    }
    free(s);
    return 0;
}

int fl_raster_lines(fl_raster *r, const fl_surface *s, double bend, fl_err *err)
{
    const double flat = cos(bend * RADIANS);
    for (int32_t i = 0; i < s->n; i++)
        if (draw_part_lines(r, &s->part[i], flat, err)) return -1;
    return 0;
}
