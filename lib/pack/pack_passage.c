/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack/pack_passage.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"

enum { NODES = 1000000 };

static const double FINE = 4.0, COARSE = 2.0;

/* A point of the grid with its distance from the complement. */
typedef struct {
    double g;
    int32_t at;
} grid_point;

typedef struct {
    int32_t size[3];
    double h;
    fl_vec3 lo;
    int32_t *parent; /* -1: not taken yet */
    double *peak;    /* of the set of a root: its largest g */
} point_sets;

static int by_falling_distance(const void *a, const void *b)
{
    const grid_point *x = a, *y = b;
    if (x->g != y->g) return (x->g < y->g) - (x->g > y->g);
    return (x->at > y->at) - (x->at < y->at);
}

static int32_t root_of(int32_t *parent, int32_t k)
{
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
}

static fl_vec3 place_of(const point_sets *s, int32_t at)
{
    const int32_t i = at % s->size[0], j = at / s->size[0] % s->size[1], k = at / s->size[0] / s->size[1];
    return v3_madd(s->lo, s->h, v3(i, j, k));
}

/* The finest spacing that the number of points allows, 0 for none. */
static double spacing_of(const fl_pack_region *r, double radius)
{
    const fl_vec3 size = v3_sub(r->hi, r->lo);
    for (double f = FINE; f >= COARSE; f *= 0.9) {
        const double h = radius / f,
                     n = (size.x / h + 2.0) * (size.y / h + 2.0) * (r->dim == 3 ? size.z / h + 2.0 : 1.0);
        if (n <= NODES) return h;
    }
    return 0.0;
}

/* Joins point p with the neighbours that are taken already, and notes a passage. */
static void take_point(point_sets *s, const grid_point *p, double radius, double slack, fl_passage *out)
{
    const int32_t nx = s->size[0], ny = s->size[1], nz = s->size[2];
    const int32_t i = p->at % nx, j = p->at / nx % ny, k = p->at / nx / ny;
    s->parent[p->at] = p->at;
    s->peak[p->at] = p->g;
    for (int32_t c = 0; c < 27; c++) {
        const int32_t a = i + c % 3 - 1, b = j + c / 3 % 3 - 1, d = k + c / 9 - 1;
        if (a < 0 || b < 0 || d < 0 || a >= nx || b >= ny || d >= nz) continue;
        const int32_t other = a + nx * (b + ny * d);
        if (s->parent[other] < 0) continue;
        const int32_t x = root_of(s->parent, p->at), y = root_of(s->parent, other);
        if (x == y) continue;
        if (s->peak[x] >= radius && s->peak[y] >= radius && p->g < radius - slack)
            *out = (fl_passage){1, 2.0 * p->g, place_of(s, p->at)};
        s->parent[y] = x;
        s->peak[x] = fmax(s->peak[x], s->peak[y]);
    }
}

int fl_passage_find(fl_passage *out, const fl_pack_region *r, double radius, fl_err *err)
{
    *out = (fl_passage){0};
    point_sets s = {.lo = r->lo};
    const fl_vec3 size = v3_sub(r->hi, r->lo);
    if (r->kind != FL_REGION_FEATURES || (s.h = spacing_of(r, radius)) == 0.0) return 0;
    for (int k = 0; k < 3; k++) s.size[k] = k < r->dim ? (int32_t)ceil(v3_at(size, k) / s.h) + 1 : 1;
    const int32_t n = s.size[0] * s.size[1] * s.size[2];
    int32_t taken = 0;
    grid_point *point = fl_alloc(n, sizeof *point, err);
    s.parent = fl_alloc(n, sizeof *s.parent, err);
    s.peak = fl_alloc(n, sizeof *s.peak, err);
    if (point && s.parent && s.peak) {
        for (int32_t k = 0; k < n; k++) {
            const double g = fl_region_distance(r, place_of(&s, k), INFINITY);
            s.parent[k] = -1;
            if (g > 0.0) point[taken++] = (grid_point){g, k};
        }
        qsort(point, (size_t)taken, sizeof *point, by_falling_distance);
        for (int32_t k = 0; k < taken; k++) take_point(&s, &point[k], radius, 0.5 * sqrt(r->dim) * s.h, out);
    }
    free(point), free(s.parent), free(s.peak);
    return err->code ? -1 : 0;
}
