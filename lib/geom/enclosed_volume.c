/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "geom/enclosed_volume.h"

enum {
    LINES = 20000,  /* of the volumes: their difference is known to about 1e-4 of the box */
    BODIES = 1000,  /* whose own lines are compared */
    MAX_CELLS = 512 /* of the grid along either side */
};
static const double CLOSE_CALL = 1e-11; /* of the box: distance from an edge at which a line is left out */
static const double DIFFERS = 0.1;      /* of the length of a body on its line */

double fl_part_winding(const fl_part *p, fl_vec3 x)
{
    double sum = 0.0;
    for (int32_t t = 0; t < p->nt; t++) {
        const fl_vec3 a = v3_sub(p->v[p->t[t].v[0]], x), b = v3_sub(p->v[p->t[t].v[1]], x),
                      c = v3_sub(p->v[p->t[t].v[2]], x);
        const double la = v3_norm(a), lb = v3_norm(b), lc = v3_norm(c);
        sum += atan2(v3_dot(a, v3_cross(b, c)),
                     la * lb * lc + v3_dot(a, b) * lc + v3_dot(b, c) * la + v3_dot(c, a) * lb);
    }
    return sum / (2.0 * PI);
}

/* Triangles by the cells of a grid across the lines. */
typedef struct {
    const fl_part *p;
    const int32_t *body, *group; /* NULL: all are one */
    int u, v, s;                 /* axes across and along the lines */
    double lo[2], per[2];
    int cells;
    int64_t *first; /* [cells^2 + 1] */
    int32_t *list;
} line_grid;

/* A triangle on a line. */
typedef struct {
    double s;
    int32_t body, group;
    int enters;
} crossing_point;

typedef struct {
    crossing_point *at;
    int32_t n, cap;
    int32_t *count; /* winding numbers of the bodies on the line, scratch beside `at` */
    int32_t count_cap;
} line_hits;

static double coordinate(fl_vec3 x, int axis) { return axis == 0 ? x.x : axis == 1 ? x.y : x.z; }

static int cell_of(const line_grid *g, int side, double x)
{
    const double c = (x - g->lo[side]) * g->per[side];
    return !(c > 0.0) ? 0 : c < g->cells - 1 ? (int)c : g->cells - 1;
}

/* Cells of the box of a triangle. */
static void cells_of(const line_grid *g, int32_t t, int from[2], int to[2])
{
    for (int side = 0; side < 2; side++) {
        double lo = INFINITY, hi = -INFINITY;
        for (int k = 0; k < 3; k++) {
            const double x = coordinate(g->p->v[g->p->t[t].v[k]], side ? g->v : g->u);
            lo = fmin(lo, x);
            hi = fmax(hi, x);
        }
        from[side] = cell_of(g, side, lo);
        to[side] = cell_of(g, side, hi);
    }
}

static int grid_make(line_grid *g, const fl_part *p, fl_aabb box, int along, fl_err *err)
{
    int64_t cells;
    int from[2], to[2];
    g->p = p;
    g->s = along;
    g->u = (along + 1) % 3;
    g->v = (along + 2) % 3;
    g->cells = (int)fmin(MAX_CELLS, 1.0 + sqrt((double)p->nt));
    for (int side = 0; side < 2; side++) {
        const int axis = side ? g->v : g->u;
        g->lo[side] = coordinate(box.lo, axis);
        g->per[side] = g->cells / fmax(coordinate(box.hi, axis) - g->lo[side], 1e-300);
    }
    cells = (int64_t)g->cells * g->cells;
    g->first = fl_alloc(cells + 2, sizeof *g->first, err);
    if (!g->first) return -1;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t t = 0; t < p->nt; t++) {
            cells_of(g, t, from, to);
            for (int i = from[0]; i <= to[0]; i++)
                for (int j = from[1]; j <= to[1]; j++) {
                    int64_t *const at = &g->first[(int64_t)i * g->cells + j + 1];
                    if (pass == 0) at[1]++;
                    else g->list[(*at)++] = t;
                }
        }
        if (pass) break;
        for (int64_t k = 1; k <= cells; k++) g->first[k + 1] += g->first[k];
        g->list = fl_alloc(g->first[cells + 1], sizeof *g->list, err);
        if (!g->list) return -1;
    }
    return 0;
}

static void grid_free(line_grid *g)
{
    free(g->first);
    free(g->list);
}

static int by_place(const void *pa, const void *pb)
{
    const crossing_point *a = pa, *b = pb;
    if (a->s != b->s) return a->s < b->s ? -1 : 1;
    return b->enters - a->enters; /* what is left where another begins does not gape */
}

/* The triangles on a line, in their order along it.  Returns 1, 0 where one of them is not sure, or -1. */
static int find_hits(const line_grid *g, double u, double v, line_hits *h, fl_err *err)
{
    const int64_t cell = (int64_t)cell_of(g, 0, u) * g->cells + cell_of(g, 1, v);
    h->n = 0;
    for (int64_t k = g->first[cell]; k < g->first[cell + 1]; k++) {
        const int32_t t = g->list[k];
        double x[3], y[3], area[3], size = 0.0;
        int ahead = 0, behind = 0;
        for (int i = 0; i < 3; i++) {
            const fl_vec3 c = g->p->v[g->p->t[t].v[i]];
            x[i] = coordinate(c, g->u) - u;
            y[i] = coordinate(c, g->v) - v;
        }
        for (int i = 0; i < 3; i++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3;
            area[i] = x[a] * y[b] - x[b] * y[a];
            size = fmax(size, hypot(x[b] - x[a], y[b] - y[a]));
            ahead += area[i] > 0.0;
            behind += area[i] < 0.0;
        }
        if (ahead && behind) continue;
        const double least = CLOSE_CALL * size / fmin(g->per[0], g->per[1]) * g->cells;
        for (int i = 0; i < 3; i++)
            if (fabs(area[i]) <= least) return 0;
        if (fl_grow(&h->at, &h->cap, (int64_t)h->n + 1, sizeof *h->at, err)) return -1;
        const double sum = area[0] + area[1] + area[2];
        double s = 0.0;
        for (int i = 0; i < 3; i++) s += area[i] / sum * coordinate(g->p->v[g->p->t[t].v[i]], g->s);
        h->at[h->n++] = (crossing_point){s, g->body ? g->body[t] : 0, g->group ? g->group[t] : 0, sum < 0.0};
    }
    if (h->n) qsort(h->at, (size_t)h->n, sizeof *h->at, by_place);
    return 1;
}

/* Index of the first crossing of the same body, or group, as crossing k. */
static int32_t first_of(const crossing_point *at, int32_t k, int of_group)
{
    int32_t i = 0;
    while (of_group ? at[i].group != at[k].group : at[i].body != at[k].body) i++;
    return i;
}

/* Length inside along the line of the hits, and that inside one body (own, if >= 0).  Returns 1, 0 where a
 * body does not end, or -1. */
static int line_length(line_hits *h, int32_t own, double *length, double *own_length, fl_err *err)
{
    int32_t *inside, *in_group, groups = 0;
    *length = *own_length = 0.0;
    if (h->n == 0) return 1;
    if (fl_grow(&h->count, &h->count_cap, 2 * (int64_t)h->n, sizeof *h->count, err)) return -1;
    inside = h->count;
    in_group = inside + h->n;
    memset(inside, 0, 2 * (size_t)h->n * sizeof *inside);
    for (int32_t k = 0; k < h->n; k++) {
        const crossing_point *c = &h->at[k];
        int32_t *const w = &inside[first_of(h->at, k, 0)], *const n = &in_group[first_of(h->at, k, 1)];
        const int was = *w != 0, was_group = *n > 0;
        *w += c->enters ? 1 : -1;
        *n += (*w != 0) - was;
        groups += (*n > 0) - was_group;
        if (k + 1 == h->n) break;
        const double step = h->at[k + 1].s - c->s;
        if (groups % 2) *length += step;
        for (int32_t i = 0; i < h->n && own >= 0; i++)
            if (h->at[i].body == own) {
                if (inside[i]) *own_length += step;
                break;
            }
    }
    for (int32_t k = 0; k < h->n; k++)
        if (inside[k]) return 0;
    return 1;
}

/* Lengths of source and result on a line.  Returns 1, 0 where one of them is not sure, or -1. */
static int compare_line(const line_grid g[2], double u, double v, int32_t own, line_hits *h, double length[2],
                        double *own_length, fl_err *err)
{
    double none;
    for (int k = 0; k < 2; k++) {
        int sure = find_hits(&g[k], u, v, h, err);
        if (sure > 0) sure = line_length(h, k ? -1 : own, &length[k], k ? &none : own_length, err);
        if (sure <= 0) return sure;
    }
    return 1;
}

static int sum_lines(const line_grid g[2], fl_aabb box, fl_volume_check *c, line_hits *h, fl_err *err)
{
    static const double STEP[2] = {0.7548776662466927, 0.5698402909980532};
    const double size[2] = {coordinate(box.hi, g->u) - g->lo[0], coordinate(box.hi, g->v) - g->lo[1]};
    double sum[2] = {0.0, 0.0}, length[2], none, at[2] = {0.5, 0.5};
    int32_t n = 0;
    for (int32_t k = 0; k < LINES; k++) {
        for (int i = 0; i < 2; i++) at[i] += STEP[i], at[i] -= floor(at[i]);
        const int sure = compare_line(g, g->lo[0] + at[0] * size[0], g->lo[1] + at[1] * size[1], -1, h,
                                      length, &none, err);
        if (sure < 0) return -1;
        if (!sure) continue;
        n++;
        for (int i = 0; i < 2; i++) sum[i] += length[i];
    }
    c->source = n ? sum[0] / n * size[0] * size[1] : 0.0;
    c->result = n ? sum[1] / n * size[0] * size[1] : 0.0;
    return 0;
}

/* Three triangles of a body, the largest as seen along the lines. */
typedef struct {
    int32_t body, t[3];
    double area[3];
} body_lines;

static double seen_area(const line_grid *g, int32_t t)
{
    const fl_vec3 a = g->p->v[g->p->t[t].v[0]], ab = v3_sub(g->p->v[g->p->t[t].v[1]], a),
                  ac = v3_sub(g->p->v[g->p->t[t].v[2]], a);
    return fabs(coordinate(v3_cross(ab, ac), g->s));
}

static int by_body(const void *pa, const void *pb)
{
    const int32_t *a = pa, *b = pb;
    return a[0] != b[0] ? (a[0] < b[0] ? -1 : 1) : (a[1] > b[1]) - (a[1] < b[1]);
}

/* 1 if most lines through the body have another length in the result. */
static int body_differs(const line_grid g[2], const body_lines *b, line_hits *h, fl_err *err)
{
    static const double WEIGHT[3] = {0.31, 0.27, 0.42}; /* a place that no symmetry of a mesh has */
    int sure = 0, differ = 0;
    for (int i = 0; i < 3; i++) {
        double length[2], own, x[2] = {0.0, 0.0};
        if (b->t[i] < 0) continue;
        for (int k = 0; k < 3; k++) {
            const fl_vec3 c = g->p->v[g->p->t[b->t[i]].v[k]];
            x[0] += WEIGHT[k] * coordinate(c, g->u);
            x[1] += WEIGHT[k] * coordinate(c, g->v);
        }
        const int known = compare_line(g, x[0], x[1], b->body, h, length, &own, err);
        if (known < 0) return -1;
        sure += known;
        differ += known && fabs(length[1] - length[0]) > DIFFERS * own;
    }
    return sure && 2 * differ > sure;
}

static int compare_bodies(const line_grid g[2], fl_volume_check *c, line_hits *h, fl_err *err)
{
    const int32_t nt = g->p->nt;
    int32_t *order = fl_alloc(2 * (int64_t)nt, sizeof *order, err), bodies = 0;
    int rc = order ? 0 : -1;
    for (int32_t t = 0; rc == 0 && t < nt; t++) order[2 * t] = g->body[t], order[2 * t + 1] = t;
    if (rc == 0 && nt) qsort(order, (size_t)nt, 2 * sizeof *order, by_body);
    for (int32_t from = 0, to; rc == 0 && from < nt && bodies < BODIES; from = to, bodies++) {
        body_lines b = {order[2 * from], {-1, -1, -1}, {0.0, 0.0, 0.0}};
        for (to = from; to < nt && order[2 * to] == b.body; to++) {
            double area = seen_area(g, order[2 * to + 1]);
            int32_t t = order[2 * to + 1];
            for (int i = 0; i < 3; i++)
                if (area > b.area[i]) {
                    const double keep = b.area[i];
                    const int32_t kept = b.t[i];
                    b.area[i] = area, b.t[i] = t;
                    area = keep, t = kept;
                }
        }
        const int differs = body_differs(g, &b, h, err);
        if (differs < 0) rc = -1;
        else c->bodies += differs;
    }
    free(order);
    return rc;
}

int fl_check_volume(const fl_part *source, const int32_t *body, const int32_t *group, const fl_part *result,
                    fl_volume_check *c, fl_err *err)
{
    line_grid g[2] = {{.body = body, .group = group}, {0}};
    line_hits h = {0};
    const fl_aabb box = aabb_join(fl_part_aabb(source), fl_part_aabb(result));
    const fl_vec3 side = v3_sub(box.hi, box.lo);
    const int along = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    int rc = -1;
    *c = (fl_volume_check){0};
    if (grid_make(&g[0], source, box, along, err) == 0 && grid_make(&g[1], result, box, along, err) == 0 &&
        sum_lines(g, box, c, &h, err) == 0)
        rc = compare_bodies(g, c, &h, err);
    grid_free(&g[0]);
    grid_free(&g[1]);
    free(h.at);
    free(h.count);
    return rc;
}
