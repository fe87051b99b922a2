/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack/packing_certificate.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"

enum { CONTACTS = 4000 };

/* Overlaps up to this part of the radius, which the search for a packing without force leaves, are no
 * contacts. */
static const double TOUCH = 2e-6;

/* Distances from the complement beyond this many radii are not measured. */
static const double FAR = 1.5;

typedef struct {
    int32_t i, j; /* j < 0: the boundary */
    fl_vec3 n;
} contact;

typedef struct {
    const fl_packing *p;
    contact *c;
    int32_t n, cap, walls;
    int failed;
} contact_list;

static void collect(void *with, int32_t i, int32_t j, fl_vec3 n, double delta)
{
    contact_list *l = with;
    if (delta <= TOUCH * l->p->s * l->p->bound[i]) return;
    if (l->failed || fl_grow_quiet(&l->c, &l->cap, (int64_t)l->n + 1, sizeof *l->c)) {
        l->failed = 1;
        return;
    }
    l->c[l->n++] = (contact){i, j, n};
    l->walls += j < 0;
}

/* --- grading ------------------------------------------------------------------------------------ */

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int compare_grading(fl_packing_certificate *c, const fl_packing *p, const fl_grading *g, fl_err *err)
{
    double *d = fl_alloc(p->n, sizeof *d, err), sum = 0.0, all = 0.0;
    if (!d) return -1;
    memcpy(d, p->size, (size_t)p->n * sizeof *d);
    qsort(d, (size_t)p->n, sizeof *d, by_size);
    for (int32_t k = 0; k < p->n; k++) all += pow(d[k], p->dim);
    c->least = p->s * d[0];
    c->most = p->s * d[p->n - 1];
    c->largest_share = pow(d[p->n - 1], p->dim) / all;
    for (int32_t k = 0; g && k < p->n; k++) {
        const double mass = fl_grading_mass(g, p->dim, d[k]), count = fl_grading_count(g, p->dim, d[k]);
        const double before = sum / all;
        sum += pow(d[k], p->dim);
        if (k + 1 < p->n && d[k + 1] == d[k]) continue;
        if (g->n || fl_grading_least(g) == fl_grading_most(g)) continue;
        c->mass_gap = fmax(c->mass_gap, fmax(fabs(sum / all - mass), fabs(before - mass)));
        c->count_gap =
            fmax(c->count_gap, fmax(fabs((k + 1.0) / p->n - count), fabs((double)k / p->n - count)));
    }
    free(d);
    return 0;
}

int fl_packing_layer_measure(fl_packing_layer *out, const fl_packing *p, const fl_pack_layers *l, int32_t k,
                             fl_err *err)
{
    double *d = fl_alloc(p->n, sizeof *d, err), sum = 0.0, all = 0.0;
    *out = (fl_packing_layer){0};
    if (!d) return -1;
    for (int32_t i = 0; i < p->n; i++) {
        if (fl_pack_layers_find(l, p->x[i]) != k) continue;
        out->volume += fl_packing_body_volume(p, i, p->s, 0);
        all += pow(p->size[i], p->dim);
        d[out->bodies++] = p->size[i];
    }
    qsort(d, (size_t)out->bodies, sizeof *d, by_size);
    if (out->bodies) out->least = p->s * d[0], out->most = p->s * d[out->bodies - 1];
    const int one_size = fl_grading_least(&l->grading[k]) == fl_grading_most(&l->grading[k]);
    for (int32_t i = 0; i < out->bodies && !one_size; i++) {
        const double mass = fl_grading_mass(&l->grading[k], p->dim, d[i]), before = sum / all;
        sum += pow(d[i], p->dim);
        if (i + 1 < out->bodies && d[i + 1] == d[i]) continue;
        out->mass_gap = fmax(out->mass_gap, fmax(fabs(sum / all - mass), fabs(before - mass)));
    }
    free(d);
    return 0;
}

/* --- contacts ----------------------------------------------------------------------------------- */

/* Takes rattlers out until none is left. */
static int count_rattlers(fl_packing_certificate *c, const fl_packing *p, const contact_list *l, fl_err *err)
{
    int32_t *held = fl_alloc(p->n, sizeof *held, err);
    uint8_t *out = fl_alloc(p->n, 1, err);
    int more = 1;
    if (!held || !out) {
        free(held), free(out);
        return -1;
    }
    while (more) {
        int64_t twice = 0;
        more = 0;
        memset(held, 0, (size_t)p->n * sizeof *held);
        for (int32_t k = 0; k < l->n; k++) {
            const int32_t i = l->c[k].i, j = l->c[k].j;
            if (out[i] || (j >= 0 && out[j])) continue;
            held[i]++, twice++;
            if (j >= 0) held[j]++, twice++;
        }
        for (int32_t i = 0; i < p->n; i++)
            if (!out[i] && held[i] < p->dim + 1) out[i] = 1, c->rattlers++, more = 1;
        if (!more) c->without_rattlers = c->rattlers < p->n ? (double)twice / (p->n - c->rattlers) : 0.0;
    }
    free(held), free(out);
    return 0;
}

static void find_fabric(fl_packing_certificate *c, const fl_packing *p, const contact_list *l)
{
    fl_mat3 f = {{{0}}}, axes;
    int32_t n = 0;
    for (int32_t k = 0; k < l->n; k++) {
        const double d[3] = {l->c[k].n.x, l->c[k].n.y, l->c[k].n.z};
        if (l->c[k].j < 0) continue;
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) f.m[a][b] += d[a] * d[b];
        n++;
    }
    if (n == 0) return;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) f.m[a][b] /= n;
    fl_mass_principal(&f, c->fabric, &axes);
    (void)p;
}

static double legendre6(double x)
{
    const double y = x * x;
    return (((231.0 * y - 315.0) * y + 105.0) * y - 5.0) / 16.0;
}

static double order_of(const contact_list *l)
{
    const int32_t each = l->n / CONTACTS + 1;
    double sum = 0.0;
    int32_t n = 0;
    for (int32_t a = 0; a < l->n; a += each) {
        if (l->c[a].j < 0) continue;
        n++;
        for (int32_t b = 0; b < l->n; b += each)
            if (l->c[b].j >= 0) sum += legendre6(v3_dot(l->c[a].n, l->c[b].n));
    }
    return n ? sqrt(fmax(sum, 0.0)) / n : 0.0;
}

/* --- boundary ----------------------------------------------------------------------------------- */

static void find_room(fl_packing_certificate *c, const fl_overlaps *o)
{
    const fl_packing *p = o->p;
    c->room = FAR;
    for (int32_t i = 0; i < p->n; i++) {
        const int32_t from = p->q ? o->corner_first[i] : i, to = p->q ? o->corner_first[i + 1] : i + 1;
        const double r = p->s * p->radius[i], bound = p->s * p->bound[i];
        double least = INFINITY;
        for (int32_t v = from; v < to; v++)
            least =
                fmin(least, fl_region_distance(o->region, p->q ? o->corner[v] : p->x[i], FAR * bound) - r);
        c->room = fmin(c->room, 1.0 + least / bound);
        c->outside += least < -1e-3 * bound;
    }
}

int fl_packing_certify(fl_packing_certificate *c, fl_overlaps *o, const fl_grading *g, fl_err *err)
{
    const fl_packing *p = o->p;
    contact_list l = {.p = o->p};
    *c = (fl_packing_certificate){.solid = fl_packing_volume(p, p->s, 0) / o->region->volume,
                                  .rounded = fl_packing_volume(p, p->s, 1) / o->region->volume};
    if (compare_grading(c, p, g, err)) return -1;
    fl_overlaps_each(o, collect, &l);
    int rc = l.failed ? fl_fail(err, FL_SYSTEM, "out of memory: contacts") : count_rattlers(c, p, &l, err);
    if (rc == 0) {
        c->max_overlap = o->now.max_overlap;
        c->contacts = l.n;
        c->wall_contacts = l.walls;
        c->mean_overlap = l.n ? o->now.overlap_sum / (double)o->now.contacts : 0.0;
        c->unbalanced = c->mean_overlap > 0.0 ? o->now.max_force / c->mean_overlap : 0.0;
        c->coordination = (2.0 * (double)(c->contacts - c->wall_contacts) + (double)c->wall_contacts) / p->n;
        find_fabric(c, p, &l);
        if (p->dim == 3) c->q6 = order_of(&l);
        find_room(c, o);
    }
    free(l.c);
    return rc;
}

typedef struct {
    double *share;
    int dim;
    int64_t n;
} rose;

static void add_direction(void *with, int32_t i, int32_t j, fl_vec3 n, double delta)
{
    rose *r = with;
    (void)i, (void)delta;
    if (j < 0) return;
    double a = atan2(r->dim == 2 ? n.y : n.z, n.x);
    if (a < 0.0) a += PI;
    int bin = (int)(a / PI * FL_ROSE_BINS);
    if (bin >= FL_ROSE_BINS) bin = 0;
    r->share[bin] += 1.0;
    r->n++;
}

void fl_packing_rose(const fl_overlaps *o, double share[FL_ROSE_BINS])
{
    rose r = {share, o->p->dim, 0};
    for (int k = 0; k < FL_ROSE_BINS; k++) share[k] = 0.0;
    fl_overlaps_each(o, add_direction, &r);
    for (int k = 0; k < FL_ROSE_BINS && r.n; k++) share[k] /= (double)r.n;
}
