/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "geom/aabb.h"
#include "geom/hilbert_order.h"
#include "scene/ice_field_order.h"

struct sort_key {
    fl_vec3 mean;
    const fl_poly *core;
    double radius;
    uint32_t curve;
    int32_t id, from;
};

/* A smaller field fits the caches in any order. */
enum { LARGE = 4096 };

static int by_number(double a, double b) { return (a > b) - (a < b); }

static int by_point(fl_vec3 a, fl_vec3 b)
{
    int c = by_number(a.x, b.x);
    if (c == 0) c = by_number(a.y, b.y);
    return c ? c : by_number(a.z, b.z);
}

static int by_position(const void *x, const void *y)
{
    const struct sort_key *a = x, *b = y;
    int c = (a->curve > b->curve) - (a->curve < b->curve);
    if (c == 0) c = by_point(a->mean, b->mean);
    if (c == 0) c = by_number(a->radius, b->radius);
    if (c == 0) c = (a->core->nv > b->core->nv) - (a->core->nv < b->core->nv);
    for (int32_t v = 0; c == 0 && v < a->core->nv; v++) c = by_point(a->core->v[v], b->core->v[v]);
    return c ? c : (a->id > b->id) - (a->id < b->id);
}

static int by_pair(const void *x, const void *y)
{
    const fl_ice_field_bond *a = x, *b = y;
    if (a->i != b->i) return (a->i > b->i) - (a->i < b->i);
    return (a->j > b->j) - (a->j < b->j);
}

static int by_joint(const void *x, const void *y)
{
    const fl_ice_field_joint *a = x, *b = y;
    if (a->i != b->i) return (a->i > b->i) - (a->i < b->i);
    return (a->j > b->j) - (a->j < b->j);
}

/* array[k] = array[from of s[k]]; spare has room for one array. */
static void permute(void *array, size_t size, const struct sort_key *s, int32_t n, void *spare)
{
    memcpy(spare, array, (size_t)n * size);
    for (int32_t k = 0; k < n; k++)
        memcpy((char *)array + (size_t)k * size, (char *)spare + (size_t)s[k].from * size, size);
}

/* Positions of the means on a Hilbert curve over the plane. */
static void set_curve_positions(struct sort_key *s, int32_t n)
{
    fl_aabb all = aabb_empty();
    for (int32_t i = 0; i < n; i++) all = aabb_add(all, s[i].mean);
    const double wide = fmax(all.hi.x - all.lo.x, all.hi.y - all.lo.y);
    const double scale = wide > 0.0 ? 65535.5 / wide : 0.0; /* just below 2^16 squares */
    for (int32_t i = 0; i < n; i++)
        s[i].curve = fl_hilbert_index((uint32_t)(scale * (s[i].mean.x - all.lo.x)),
                                      (uint32_t)(scale * (s[i].mean.y - all.lo.y)));
}

int fl_ice_field_order(fl_ice_field *a, int32_t *at, fl_err *err)
{
    struct sort_key *s = fl_alloc(a->n, sizeof *s, err);
    void *spare = fl_alloc(a->n, sizeof(fl_poly) > sizeof(fl_vec3) ? sizeof(fl_poly) : sizeof(fl_vec3), err);
    if (!s || !spare) {
        free(s);
        free(spare);
        return -1;
    }
    for (int32_t i = 0; i < a->n; i++) {
        const fl_poly *p = &a->core[i];
        fl_vec3 sum = v3(0, 0, 0);
        for (int32_t v = 0; v < p->nv; v++) sum = v3_add(sum, p->v[v]);
        s[i] = (struct sort_key){v3_scale(1.0 / p->nv, sum), p, a->radius[i], 0, a->id[i], i};
    }
    if (a->n > LARGE) set_curve_positions(s, a->n);
    qsort(s, (size_t)a->n, sizeof *s, by_position);
    for (int32_t k = 0; k < a->n; k++) at[s[k].from] = k;
    permute(a->id, sizeof *a->id, s, a->n, spare);
    permute(a->record_line, sizeof *a->record_line, s, a->n, spare);
    permute(a->material, sizeof *a->material, s, a->n, spare);
    permute(a->group, sizeof *a->group, s, a->n, spare);
    permute(a->radius, sizeof *a->radius, s, a->n, spare);
    permute(a->core, sizeof *a->core, s, a->n, spare);
    permute(a->velocity, sizeof *a->velocity, s, a->n, spare);
    permute(a->spin, sizeof *a->spin, s, a->n, spare);
    for (int32_t k = 0; k < a->bonds; k++) {
        const int32_t i = at[a->bond[k].i], j = at[a->bond[k].j];
        a->bond[k].i = i < j ? i : j;
        a->bond[k].j = i < j ? j : i;
    }
    if (a->bonds) qsort(a->bond, (size_t)a->bonds, sizeof *a->bond, by_pair);
    for (int32_t k = 0; k < a->joints; k++) {
        fl_ice_field_joint *d = &a->joint[k];
        const int32_t i = at[d->i], j = at[d->j], fi = d->fi, fj = d->fj;
        *d =
            i < j ? (fl_ice_field_joint){i, j, fi, fj, d->name} : (fl_ice_field_joint){j, i, fj, fi, d->name};
    }
    if (a->joints) qsort(a->joint, (size_t)a->joints, sizeof *a->joint, by_joint);
    free(s);
    free(spare);
    return 0;
}
