/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "structure/region_cone.h"
#include <string.h>
#include "base/array.h"
#include "narrow/closest_point.h"
#include "structure/region_cut.h"

/* A point of the pose of the file in the frame of a piece. */
static fl_vec3 in_frame(const fl_piece *p, fl_vec3 x) { return q_rotate(q_conj(p->q), v3_sub(x, p->x)); }

static fl_vec3 on_axis(const fl_piece *p, double z) { return v3_add(p->x, q_rotate(p->q, v3(0, 0, z))); }

int fl_cones_unite(fl_piece *both, const fl_piece *a, const fl_piece *b, double tol, fl_err *err)
{
    const double slope = (a->r1 - a->r0) / a->h;
    double z[2];
    for (int end = 0; end < 2; end++) {
        const fl_vec3 at = in_frame(a, on_axis(b, end ? b->h : 0.0));
        z[end] = at.z;
        if (sqrt(at.x * at.x + at.y * at.y) > tol) return 0;
        if (fabs(a->r0 + slope * at.z - (end ? b->r1 : b->r0)) > tol) return 0;
    }
    const double low = fmin(z[0], z[1]), high = fmax(z[0], z[1]);
    if (low > a->h + tol || high < -tol) return 0;
    const double from = fmin(low, 0.0), to = fmax(high, a->h);
    const fl_cone cone = {on_axis(a, from), on_axis(a, to),
                          from < 0.0 ? (z[0] < z[1] ? b->r0 : b->r1) : a->r0,
                          to > a->h ? (z[0] < z[1] ? b->r1 : b->r0) : a->r1};
    *both = (fl_piece){.q = q_one(), .cone = -1, .part = a->part};
    return fl_cone_piece(both, &cone, err) ? -1 : 1;
}

/* Clips a polygon to a half-space n.x <= c; returns the number of corners.  out has room for n + 1. */
static int32_t clip_below(const fl_vec3 *v, int32_t n, fl_vec3 normal, double c, fl_vec3 *out)
{
    int32_t m = 0;
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 a = v[k], b = v[(k + 1) % n];
        const double h = c - v3_dot(normal, a), g = c - v3_dot(normal, b);
        if (h >= 0.0) out[m++] = a;
        if ((h < 0.0) != (g < 0.0)) out[m++] = v3_lerp(a, b, h / (h - g));
    }
    return m;
}

/* Appends the interval of z over which face f of piece p enters or touches the cone.  room: two arrays. */
static int add_touched(fl_free_cone *out, int32_t *n, int32_t *cap, const fl_piece *cone, const fl_piece *p,
                       int32_t f, fl_vec3 *room[2], double tol, fl_err *err)
{
    const fl_poly *core = &p->core;
    int32_t m = core->first[f + 1] - core->first[f];
    double low = INFINITY, high = -INFINITY;
    for (int32_t k = 0; k < m; k++)
        room[0][k] = in_frame(cone, v3_add(p->x, q_rotate(p->q, core->v[core->loop[core->first[f] + k]])));
    for (int32_t g = 0; g < cone->core.nf && m > 0; g++) {
        m = clip_below(room[0], m, cone->core.n[g], cone->core.c[g] + 2.0 * tol, room[1]);
        fl_vec3 *was = room[0];
        room[0] = room[1], room[1] = was;
    }
    for (int32_t k = 0; k < m; k++) low = fmin(low, room[0][k].z), high = fmax(high, room[0][k].z);
    if (m == 0) return 0;
    if (fl_grow(&out->free, cap, (int64_t)*n + 1, sizeof *out->free, err)) return -1;
    out->free[(*n)++] = (fl_interval){low, high};
    return 0;
}

static int compare_intervals(const void *a, const void *b)
{
    const fl_interval *x = a, *y = b;
    return (x->from > y->from) - (x->from < y->from);
}

/* True if the side of the cone at height z lies in another piece. */
static int is_hidden(int32_t n, const fl_piece *const *piece, int32_t k, double z)
{
    const fl_piece *cone = piece[k];
    const double r = cone->r0 + (cone->r1 - cone->r0) * z / cone->h;
    const fl_vec3 x = v3_add(cone->x, q_rotate(cone->q, v3(r, 0, z)));
    for (int32_t j = 0; j < n; j++)
        if (j != k && fl_piece_contains(piece[j], x)) return 1;
    return 0;
}

int fl_cone_find_free(fl_free_cone *out, int32_t n, const fl_piece *const *piece, int32_t k, double tol,
                      fl_err *err)
{
    const fl_piece *cone = piece[k];
    int32_t touched = 0, cap = 0, most = 0, rc = 0;
    fl_aabb box = aabb_grow(fl_piece_box(cone), 2.0 * tol);
    *out = (fl_free_cone){.x = cone->x, .q = cone->q, .r0 = cone->r0, .r1 = cone->r1, .h = cone->h};
    for (int32_t j = 0; j < n; j++)
        for (int32_t f = 0; f < piece[j]->core.nf; f++) {
            const int32_t m = piece[j]->core.first[f + 1] - piece[j]->core.first[f];
            if (m > most) most = m;
        }
    fl_vec3 *room[2];
    for (int c = 0; c < 2; c++) room[c] = fl_alloc((int64_t)most + cone->core.nf + 1, sizeof *room[c], err);
    if (!room[0] || !room[1]) rc = -1;
    for (int32_t j = 0; j < n && rc == 0; j++)
        for (int32_t f = 0; f < piece[j]->core.nf && rc == 0 && j != k; f++)
            if (aabb_overlap(fl_piece_face_box(piece[j], f), box))
                rc = add_touched(out, &touched, &cap, cone, piece[j], f, room, tol, err);
    free(room[0]), free(room[1]);
    if (rc || fl_grow(&out->free, &cap, (int64_t)touched + 1, sizeof *out->free, err)) return -1;
    if (touched > 1) qsort(out->free, (size_t)touched, sizeof *out->free, compare_intervals);
    /* what lies between them is free; the list is overwritten from its start */
    double from = 0.0;
    out->free[touched] = (fl_interval){cone->h, cone->h};
    for (int32_t c = 0; c <= touched; c++) {
        const fl_interval at = out->free[c];
        if (at.from > from && !is_hidden(n, piece, k, 0.5 * (from + at.from)))
            out->free[out->n++] = (fl_interval){from, at.from};
        from = fmax(from, at.to);
    }
    return 0;
}
