/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "bond/common_face.h"
#include "geom/polygon.h"

/* Relative distance and angle of planes that are one face. File coordinates have sixteen digits and faces of
 * cells are flat to 1e-9 of their size, so faces cut alike agree far better; others are not bonded. */
#define FACE_TOL 1e-6
/* Least difference of the principal moments, relative to their mean. They are sums of some 10 terms, right to
 * 1e-15, so that a smaller difference is rounding. */
#define MOMENT_TOL 1e-12

/* The plane of the face, with x as origin. */
typedef struct {
    fl_vec3 x, n, e, d;
} face_plane;

static fl_vec2 to_plane(const face_plane *s, fl_vec3 v)
{
    const fl_vec3 r = v3_sub(v, s->x);
    return (fl_vec2){v3_dot(r, s->e), v3_dot(r, s->d)};
}

/* Corners of face f moved by way, counter-clockwise about s->n; back: the face has the opposite normal. */
static int32_t corners_in_plane(const face_plane *s, const fl_poly *p, int32_t f, fl_vec3 way, int back,
                                fl_vec2 *out)
{
    const int32_t n = p->first[f + 1] - p->first[f];
    for (int32_t k = 0; k < n; k++) {
        const int32_t at = p->first[f] + (back ? n - 1 - k : k);
        out[k] = to_plane(s, v3_add(p->v[p->loop[at]], way));
    }
    return n;
}

static fl_polygon_side side_of(fl_vec2 a, fl_vec2 b)
{
    const double dx = b.x - a.x, dy = b.y - a.y, l = sqrt(dx * dx + dy * dy);
    fl_polygon_side s = {dy / l, -dx / l, 0.0, 0};
    s.c = s.nx * a.x + s.ny * a.y;
    return s;
}

/* Cuts v[n] by all sides of cut[m] in place; returns what is left. */
static int32_t clip_polygon(int32_t n, fl_vec2 *v, fl_polygon_side *sides, int32_t m, const fl_vec2 *cut)
{
    for (int32_t k = 0; k < n; k++) sides[k] = side_of(v[k], v[(k + 1) % n]);
    for (int32_t k = 0; k < m && n > 0; k++)
        n = fl_polygon_cut(n, v, sides, side_of(cut[k], cut[(k + 1) % m]));
    return n;
}

/* Sets the principal axes and half sides from the second moments about the centroid. */
static void set_moments(const face_plane *s, int32_t n, const fl_vec2 *v, fl_common_face *out)
{
    const fl_vec2 c = fl_polygon_centroid(n, v);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    out->area = fl_polygon_area(n, v);
    for (int32_t k = 0; k < n; k++) { /* triangles to the centroid: sums over the mid-sides */
        const fl_vec2 p = {v[k].x - c.x, v[k].y - c.y}, q = {v[(k + 1) % n].x - c.x, v[(k + 1) % n].y - c.y};
        const double w = 0.5 * (p.x * q.y - p.y * q.x) / 3.0 / 4.0;
        const double mx = p.x + q.x, my = p.y + q.y;
        xx += w * (p.x * p.x + q.x * q.x + mx * mx);
        xy += w * (p.x * p.y + q.x * q.y + mx * my);
        yy += w * (p.y * p.y + q.y * q.y + my * my);
    }
    const double mean = 0.5 * (xx + yy), half = 0.5 * (xx - yy), off = sqrt(half * half + xy * xy);
    fl_vec2 less = {xy, -half - off}; /* of the smaller moment: (xx - mean + off) x + xy y = 0 */
    if (half < 0.0) less = (fl_vec2){half - off, xy};
    double size = sqrt(less.x * less.x + less.y * less.y);
    if (!(size > MOMENT_TOL * mean)) less = (fl_vec2){1.0, 0.0}, size = 1.0; /* all directions are equal */
    const fl_vec3 a = v3_add(v3_scale(less.x / size, s->e), v3_scale(less.y / size, s->d));
    const double small = mean - off > 0.0 ? mean - off : 0.0;
    out->n = s->n;
    out->x = v3_add(s->x, v3_add(v3_scale(c.x, s->e), v3_scale(c.y, s->d)));
    out->a = v3_scale(sqrt(3.0 * small / out->area), a);
    out->b = v3_scale(sqrt(3.0 * (mean + off) / out->area), v3_cross(s->n, a));
}

/* Stores the common part of face f of p and face g of q if it is larger than that of out. */
static void common_part(const fl_poly *p, int32_t f, const fl_poly *q, int32_t g, fl_vec3 way, fl_vec3 x,
                        fl_vec2 *v, fl_polygon_side *sides, fl_common_face *out)
{
    const fl_vec3 n = p->n[f], e = v3_normal_to(n);
    const face_plane s = {x, n, e, v3_cross(n, e)};
    fl_vec2 *cut = v + (p->first[f + 1] - p->first[f]) + (q->first[g + 1] - q->first[g]) + 1;
    int32_t k = corners_in_plane(&s, p, f, v3(0, 0, 0), 0, v);
    k = clip_polygon(k, v, sides, corners_in_plane(&s, q, g, way, 1, cut), cut);
    if (k < 3 || !(fl_polygon_area(k, v) > out->area)) return;
    set_moments(&s, k, v, out);
}

static int32_t max_corners(const fl_poly *p)
{
    int32_t n = 0;
    for (int32_t f = 0; f < p->nf; f++)
        if (p->first[f + 1] - p->first[f] > n) n = p->first[f + 1] - p->first[f];
    return n;
}

int fl_common_face_find(const fl_poly *p, const fl_poly *q, fl_vec3 way, fl_vec3 x, fl_common_face *out,
                        fl_err *err)
{
    const int64_t n_corners = (int64_t)max_corners(p) + max_corners(q) + 1;
    const double near = FACE_TOL * (p->size < q->size ? p->size : q->size);
    fl_vec2 *v = fl_alloc(2 * n_corners, sizeof *v, err);
    fl_polygon_side *sides = fl_alloc(n_corners, sizeof *sides, err);
    fl_common_face best = {0};
    if (!v || !sides) {
        free(v), free(sides);
        return -1;
    }
    for (int32_t f = 0; f < p->nf; f++) {
        if (fabs(v3_dot(p->n[f], v3_sub(x, p->v[p->loop[p->first[f]]]))) > near) continue;
        for (int32_t g = 0; g < q->nf; g++) {
            const fl_vec3 corner = v3_add(q->v[q->loop[q->first[g]]], way);
            if (v3_norm(v3_add(p->n[f], q->n[g])) > FACE_TOL) continue;
            if (fabs(v3_dot(p->n[f], v3_sub(x, corner))) > near) continue;
            common_part(p, f, q, g, way, x, v, sides, &best);
        }
    }
    free(v), free(sides);
    /* a sliver has no meaningful second moment */
    if (!(v3_norm(best.a) > FACE_TOL * v3_norm(best.b))) return 0;
    *out = best;
    return 1;
}

void fl_common_face_disc(double area, fl_vec3 x, fl_vec3 n, fl_common_face *out)
{
    const double half = sqrt(0.75 * area / PI);
    const fl_vec3 e = v3_normal_to(n);
    *out = (fl_common_face){x, n, v3_scale(half, e), v3_scale(half, v3_cross(n, e)), area};
}
