/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack/packing.h"
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "base/pi.h"
#include "base/rng.h"
#include "broad/bvh.h"
#include "geom/clip.h"
#include "geom/dilate.h"

/* --- shapes ------------------------------------------------------------------------------------- */

static double middle_of(double a, double b, double c) { return fmax(fmin(a, b), fmin(fmax(a, b), c)); }

/* Scale core and radius to size 1, in the principal axes of the outer shape about its centroid. */
static int add_shape(fl_pack_shapes *s, const fl_poly *core, double radius, fl_err *err)
{
    fl_poly outer = {0};
    fl_pack_shape t = {.radius = 0.0};
    fl_mass mass;
    const int solid = core->nf > 0;
    int rc = -1;
    if (fl_grow(&s->shape, &s->cap, (int64_t)s->n + 1, sizeof *s->shape, err)) return -1;
    if (solid && (radius > 0.0 ? fl_poly_offset(&outer, core, radius, err) : fl_poly_copy(&outer, core, err)))
        goto done;
    if (fl_mass_of(&mass, solid ? &outer : core, solid ? 0.0 : radius, err)) goto done;
    const fl_poly *from = solid ? &outer : core;
    double half[3] = {0};
    for (int32_t v = 0; v < from->nv; v++) {
        const fl_vec3 d = m3_tmul(mass.axes, v3_sub(from->v[v], mass.centre));
        half[0] = fmax(half[0], fabs(d.x)), half[1] = fmax(half[1], fabs(d.y)),
        half[2] = fmax(half[2], fabs(d.z));
    }
    for (int k = 0; k < 3; k++) half[k] += solid ? 0.0 : radius;
    const double scale = 0.5 / middle_of(half[0], half[1], half[2]);
    fl_vec3 *v = fl_alloc(core->nv, sizeof *v, err);
    if (!v) goto done;
    for (int32_t k = 0; k < core->nv; k++) {
        v[k] = v3_scale(scale, m3_tmul(mass.axes, v3_sub(core->v[k], mass.centre)));
        t.bound = fmax(t.bound, v3_norm(v[k]));
    }
    rc = fl_poly_make(&t.core, core->nv, v, core->nf, core->first, core->loop, err);
    free(v);
    if (rc) goto done;
    t.radius = scale * radius;
    t.bound += t.radius;
    t.volume = scale * scale * scale * mass.volume;
    t.rounded = fl_dilate_volume(&t.core, t.radius);
    t.half = v3(scale * half[0], scale * half[1], scale * half[2]);
    s->shape[s->n++] = t;
done:
    fl_poly_free(&outer);
    return rc;
}

static int read_shapes(fl_pack_shapes *s, const char *path, fl_err *err)
{
    fl_ice_field field = {0};
    int rc = fl_ice_field_read(&field, path, err);
    if (rc == 0 && field.n == 0) rc = fl_fail(err, FL_INPUT, "%s: no body, one at least is expected", path);
    for (int32_t k = 0; rc == 0 && k < field.n; k++) {
        fl_err why = {0};
        if (add_shape(s, &field.core[k], field.radius[k], &why))
            rc = fl_fail(err, why.code, "%s:%d: body %d: %s", path, field.record_line[k], field.id[k],
                         why.text);
    }
    fl_ice_field_free(&field);
    return rc;
}

int fl_pack_shapes_make(fl_pack_shapes *s, const char *text, fl_err *err)
{
    const int capsule = strncmp(text, "capsule:", 8) == 0;
    int rc = 0;
    *s = (fl_pack_shapes){0};
    if (capsule || strcmp(text, "sphere") == 0) {
        double ratio = 1.0;
        if (capsule && (fl_number_f64(text + 8, &ratio) || !(ratio > 1.0 && ratio <= 100.0)))
            return fl_fail(
                err, FL_USAGE,
                "--shapes is \"%.60s\", expected capsule:R with length over diameter R above 1, to 100",
                text);
        const fl_vec3 v[2] = {v3(0.5 * (1.0 - ratio), 0, 0), v3(0.5 * (ratio - 1.0), 0, 0)}, o = v3(0, 0, 0);
        fl_poly core = {0};
        rc = fl_poly_make(&core, capsule ? 2 : 1, capsule ? v : &o, 0, NULL, NULL, err) ||
                     add_shape(s, &core, 0.5, err)
                 ? -1
                 : 0;
        fl_poly_free(&core);
    } else {
        rc = read_shapes(s, text, err);
    }
    if (rc) fl_pack_shapes_free(s);
    return rc;
}

int fl_pack_shapes_are_round(const fl_pack_shapes *s)
{
    for (int32_t k = 0; k < s->n; k++)
        if (s->shape[k].core.nv != 1) return 0;
    return 1;
}

void fl_pack_shapes_free(fl_pack_shapes *s)
{
    for (int32_t k = 0; k < s->n; k++) fl_poly_free(&s->shape[k].core);
    free(s->shape);
    *s = (fl_pack_shapes){0};
}

/* --- bodies ------------------------------------------------------------------------------------- */

/* Uniform over all rotations.  Source: Shoemake, Graphics Gems III (1992). */
static fl_quat random_rotation(fl_rng *g)
{
    const double u = fl_rng_unit(g), a = 2.0 * PI * fl_rng_unit(g), b = 2.0 * PI * fl_rng_unit(g);
    const double p = sqrt(1.0 - u), q = sqrt(u);
    return (fl_quat){q * cos(b), p * sin(a), p * cos(a), q * sin(b)};
}

int fl_packing_make(fl_packing *p, int dim, int32_t n, const double *size, const fl_pack_shapes *shapes,
                    uint64_t seed, fl_err *err)
{
    const int round = fl_pack_shapes_are_round(shapes);
    *p = (fl_packing){.dim = dim, .n = n, .shapes = shapes, .s = 1.0};
    p->x = fl_alloc(n, sizeof *p->x, err);
    p->size = fl_alloc(n, sizeof *p->size, err);
    p->radius = fl_alloc(n, sizeof *p->radius, err);
    p->bound = fl_alloc(n, sizeof *p->bound, err);
    if (!round) {
        p->q = fl_alloc(n, sizeof *p->q, err);
        p->shape = fl_alloc(n, sizeof *p->shape, err);
    }
    if (err->code) {
        fl_packing_free(p);
        return -1;
    }
    for (int32_t i = 0; i < n; i++) {
        fl_rng g = fl_rng_of(seed, i, FL_RNG_ORIENTATION);
        /* neighbours in the order of sizes get different shapes */
        const int32_t k = i % shapes->n;
        const fl_pack_shape *t = &shapes->shape[k];
        p->size[i] = size[i];
        p->radius[i] = size[i] * t->radius;
        p->bound[i] = size[i] * t->bound;
        if (round) continue;
        p->shape[i] = k;
        p->q[i] = random_rotation(&g);
    }
    return 0;
}

/* Moves the elements of an array of doubles or larger things into an order. */
static void reorder(void *array, size_t size, int32_t n, const int32_t *order, char *scratch)
{
    if (!array) return;
    for (int32_t k = 0; k < n; k++)
        memcpy(scratch + (size_t)k * size, (char *)array + (size_t)order[k] * size, size);
    memcpy(array, scratch, (size_t)n * size);
}

int fl_packing_sort(fl_packing *p, fl_err *err)
{
    fl_bvh tree = {0};
    fl_aabb *box = fl_alloc(p->n, sizeof *box, err);
    char *scratch = fl_alloc(p->n, sizeof(fl_quat), err);
    int rc = -1;
    if (!box || !scratch) goto done;
    for (int32_t i = 0; i < p->n; i++) box[i] = (fl_aabb){p->x[i], p->x[i]};
    if (fl_bvh_build(&tree, box, p->n, err)) goto done;
    reorder(p->x, sizeof *p->x, p->n, tree.order, scratch);
    reorder(p->q, sizeof *p->q, p->n, tree.order, scratch);
    reorder(p->shape, sizeof *p->shape, p->n, tree.order, scratch);
    reorder(p->size, sizeof *p->size, p->n, tree.order, scratch);
    reorder(p->radius, sizeof *p->radius, p->n, tree.order, scratch);
    reorder(p->bound, sizeof *p->bound, p->n, tree.order, scratch);
    rc = 0;
done:
    fl_bvh_free(&tree);
    free(box), free(scratch);
    return rc;
}

static const fl_pack_shape *shape_of(const fl_packing *p, int32_t i)
{
    return &p->shapes->shape[p->shape ? p->shape[i] : 0];
}

/* At s = 1. */
static double volume_of(const fl_packing *p, int32_t i, int rounded)
{
    const double d = p->size[i], r = p->radius[i];
    return p->dim == 2 ? PI * r * r
                       : d * d * d * (rounded ? shape_of(p, i)->rounded : shape_of(p, i)->volume);
}

double fl_packing_body_volume(const fl_packing *p, int32_t i, double s, int rounded)
{
    return volume_of(p, i, rounded) * (p->dim == 2 ? s * s : s * s * s);
}

double fl_packing_volume(const fl_packing *p, double s, int rounded)
{
    double sum = 0.0;
    for (int32_t i = 0; i < p->n; i++) sum += volume_of(p, i, rounded);
    return sum * (p->dim == 2 ? s * s : s * s * s);
}

void fl_packing_corners(const fl_packing *p, int32_t i, fl_vec3 *v)
{
    const fl_poly *core = &shape_of(p, i)->core;
    const double scale = p->s * p->size[i];
    if (core->nv == 1) {
        v[0] = p->x[i];
        return;
    }
    const fl_mat3 axes = q_matrix(p->q[i]);
    for (int32_t k = 0; k < core->nv; k++) v[k] = v3_madd(p->x[i], scale, m3_mul(axes, core->v[k]));
}

double fl_packing_least(const fl_packing *p)
{
    double r = INFINITY;
    for (int32_t i = 0; i < p->n; i++) r = fmin(r, p->bound[i]);
    return r;
}

double fl_packing_most(const fl_packing *p)
{
    double r = 0.0;
    for (int32_t i = 0; i < p->n; i++) r = fmax(r, p->bound[i]);
    return r;
}

int fl_packing_field(const fl_packing *p, const char *material, const char *group, fl_ice_field *out,
                     fl_err *err)
{
    int32_t most = 1;
    for (int32_t k = 0; k < p->shapes->n; k++)
        if (p->shapes->shape[k].core.nv > most) most = p->shapes->shape[k].core.nv;
    fl_vec3 *v = fl_alloc(most, sizeof *v, err);
    int rc = v ? 0 : -1;
    for (int32_t i = 0; rc == 0 && i < p->n; i++) {
        const fl_poly *t = &shape_of(p, i)->core;
        fl_poly core = {0};
        fl_packing_corners(p, i, v);
        rc = fl_poly_make(&core, t->nv, v, t->nf, t->first, t->loop, err) ||
                     fl_ice_field_add(out, i, p->s * p->radius[i], &core, material, group, v3(0, 0, 0),
                                      v3(0, 0, 0), err)
                 ? -1
                 : 0;
        if (rc) fl_poly_free(&core);
    }
    free(v);
    return rc;
}

void fl_packing_free(fl_packing *p)
{
    free(p->x), free(p->q), free(p->shape), free(p->size), free(p->radius), free(p->bound);
    *p = (fl_packing){0};
}
