/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack/pack_layers.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"

enum { POINTS = 1 << 17 };

/* Less of the region than that in no layer is the error of the points. */
static const double NOTHING = 1e-3;

int fl_pack_layers_add(fl_pack_layers *l, const char *text, int dim, int linear, fl_err *err)
{
    char name[1000];
    const char *const law = strrchr(text, '=');
    fl_err why = {0};
    if (l->n == FL_PACK_LAYERS_MAX)
        return fl_fail(err, FL_USAGE, "--layer stands more than %d times", FL_PACK_LAYERS_MAX);
    if (!law || law == text || !law[1] || (size_t)(law - text) >= sizeof name)
        return fl_fail(err, FL_USAGE, "--layer is \"%.60s\", expected REGION=GRADING", text);
    memcpy(name, text, (size_t)(law - text));
    name[law - text] = '\0';
    fl_grading *const g = &l->grading[l->n];
    *g = (fl_grading){0};
    const int known = fl_grading_law(g, law + 1, dim, &why);
    if (known < 0 || (known == 0 && fl_grading_read(g, law + 1, linear, &why)))
        return fl_fail(err, why.code, "--layer %.200s: %s", text, why.text);
    if (g->n || fl_region_make(&l->region[l->n], name, dim, "", &why)) {
        const int listed = g->n > 0;
        fl_grading_free(g);
        if (listed)
            return fl_fail(err, FL_INPUT, "--layer %.200s: a list of sizes, a curve is expected", text);
        return fl_fail(err, why.code, "--layer %.200s: %s", text, why.text);
    }
    l->n++;
    return 0;
}

/* The digits of k in base b, mirrored at the point. */
static double halton(int32_t k, int32_t b)
{
    double x = 0.0;
    for (double digit = 1.0 / b; k > 0; k /= b, digit /= b) x += digit * (k % b);
    return x;
}

int32_t fl_pack_layers_find(const fl_pack_layers *l, fl_vec3 x)
{
    int32_t k = 0;
    while (k < l->n && fl_region_distance(&l->region[k], x, INFINITY) < 0.0) k++;
    return k;
}

static int add_weighted(fl_grading *all, const fl_grading *g, double part, fl_err *err)
{
    for (int32_t k = 0; k < g->pieces; k++) {
        if (fl_grow(&all->piece, &all->piece_cap, (int64_t)all->pieces + 1, sizeof *all->piece, err))
            return -1;
        all->piece[all->pieces] = g->piece[k];
        all->piece[all->pieces++].share *= part;
    }
    return 0;
}

static int copy_rest(fl_pack_layers *l, const fl_grading *rest, fl_err *err)
{
    l->grading[l->n] = (fl_grading){0};
    return rest ? add_weighted(&l->grading[l->n], rest, 1.0, err) : 0;
}

int fl_pack_layers_measure(fl_pack_layers *l, const fl_pack_region *r, const fl_grading *rest,
                           fl_grading *all, fl_err *err)
{
    int64_t inside = 0;
    const fl_vec3 size = v3_sub(r->hi, r->lo);
    int64_t count[FL_PACK_LAYERS_MAX + 1] = {0};
    *all = (fl_grading){0};
    for (int32_t k = 1; k <= POINTS; k++) {
        const fl_vec3 x = v3(r->lo.x + size.x * halton(k, 2), r->lo.y + size.y * halton(k, 3),
                             r->lo.z + size.z * halton(k, 5));
        if (fl_region_distance(r, x, INFINITY) < 0.0) continue;
        inside++;
        count[fl_pack_layers_find(l, x)]++;
    }
    for (int32_t k = 0; k <= l->n; k++) l->part[k] = inside ? (double)count[k] / (double)inside : 0.0;
    for (int32_t k = 0; k < l->n; k++)
        if (count[k] == 0)
            return fl_fail(err, FL_INPUT, "layer %d has no part of the region that no layer before it has",
                           k + 1);
    if (!rest && l->part[l->n] > NOTHING)
        return fl_fail(err, FL_INPUT, "%.3g of the region is in no layer: --grading for the rest is expected",
                       l->part[l->n]);
    if (copy_rest(l, rest, err)) return -1;
    for (int32_t k = 0; k <= l->n; k++)
        if (add_weighted(all, &l->grading[k], l->part[k], err)) return -1;
    return 0;
}

/* --- the draw ----------------------------------------------------------------------------------- */

typedef struct {
    double size;
    int32_t layer;
} drawn;

/* Of equal sizes the first layer first. */
static int by_falling_size(const void *a, const void *b)
{
    const drawn *x = a, *y = b;
    if (x->size != y->size) return (x->size < y->size) - (x->size > y->size);
    return (x->layer > y->layer) - (x->layer < y->layer);
}

int fl_pack_layers_draw(fl_pack_layers *l, int dim, double v, double volume, double **size, int32_t *n,
                        int32_t *empty, fl_err *err)
{
    drawn *all = NULL;
    int32_t cap = 0;
    int rc = 0;
    *size = NULL;
    *n = *empty = 0;
    for (int32_t k = 0; k <= l->n && rc == 0; k++) {
        double *of_layer = NULL;
        int32_t m = 0, none = 0;
        if (l->grading[k].pieces == 0 || l->part[k] == 0.0) continue;
        rc = fl_grading_draw(&l->grading[k], dim, v, volume * l->part[k], 0, &of_layer, &m, &none, err) ||
                     fl_grow(&all, &cap, (int64_t)*n + m, sizeof *all, err)
                 ? -1
                 : 0;
        for (int32_t i = 0; i < m && rc == 0; i++) all[(*n)++] = (drawn){of_layer[i], k};
        *empty += none;
        free(of_layer);
    }
    if (rc == 0) {
        qsort(all, (size_t)*n, sizeof *all, by_falling_size);
        *size = fl_alloc(*n, sizeof **size, err);
        l->of = fl_alloc(*n, sizeof *l->of, err);
        rc = *size && l->of ? 0 : -1;
    }
    for (int32_t i = 0; i < *n && rc == 0; i++) (*size)[i] = all[i].size, l->of[i] = all[i].layer;
    if (rc) {
        free(*size);
        *size = NULL;
    }
    free(all);
    return rc;
}

void fl_pack_layers_free(fl_pack_layers *l)
{
    for (int32_t k = 0; k < l->n; k++) fl_region_free(&l->region[k]);
    for (int32_t k = 0; k <= l->n; k++) fl_grading_free(&l->grading[k]);
    free(l->of);
    *l = (fl_pack_layers){0};
}
