/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "block_export.h"
#include <stdlib.h>
#include "base/array.h"
#include "base/stream.h"
#include "geom/clip.h"
#include "scene/ice_field.h"

/* Normals of a face before and after the offset agree to rounding. */
static const double SAME_NORMAL = 1e-6;

/* Numbers of the faces of a core: face[f] for face f of the block, -1 if it has none. */
static void match_faces(const fl_block_shape *s, const fl_poly *core, int32_t *face)
{
    for (int32_t f = 0; f < s->nf; f++) {
        double c;
        const fl_vec3 n = fl_block_face_normal(s, f, &c);
        face[f] = -1;
        for (int32_t g = 0; g < core->nf && face[f] < 0; g++)
            if (v3_norm(v3_sub(n, core->n[g])) < SAME_NORMAL) face[f] = g;
    }
}

/* The core of block k.  1, 0 if it is too thin for one, -1. */
static int make_core(const fl_block_shape *s, double radius, fl_poly *core, int32_t *face, fl_err *err)
{
    fl_poly sharp = {0};
    fl_err why = {0};
    const int rc = fl_block_shape_poly(s, radius > 0.0 ? &sharp : core, face, err);
    if (rc != 1 || !(radius > 0.0)) return rc;
    const int bad = fl_poly_offset(core, &sharp, -radius, &why);
    const int32_t faces = sharp.nf;
    fl_poly_free(&sharp);
    if (bad) return why.code == FL_SYSTEM ? fl_fail(err, FL_SYSTEM, "%s", why.text) : 0;
    if (core->nf != faces || faces != s->nf) match_faces(s, core, face);
    return 1;
}

static int make_cores(const struct result *r, fl_poly *core, const int64_t *first, int32_t *face, fl_err *err)
{
    int failed = 0;
#pragma omp parallel for schedule(static)
    for (int32_t k = 0; k < r->model.n; k++) {
        fl_err why = {0};
        fl_vec3 x;
        const int made = make_core(&r->model.block[k], r->radius, &core[k], face + first[k], &why);
        if (made == 1) continue;
        fl_block_shape_volume(&r->model.block[k], &x);
        if (made == 0)
            fl_fail(&why, FL_INPUT,
                    "the block at (%.6g, %.6g, %.6g) is too sharp for a core with radius %g m: a smaller "
                    "--radius, or a "
                    "larger --min-thickness",
                    x.x, x.y, x.z, r->radius);
#pragma omp critical(block_cores)
        if (!failed) {
            failed = 1;
            *err = why;
        }
    }
    return failed ? -1 : 0;
}

static int add_joints(struct result *r, fl_ice_field *field, const int64_t *first, const int32_t *face,
                      fl_err *err)
{
    for (int32_t k = 0; k < r->pairs.n; k++) {
        const fl_face_pair *p = &r->pairs.pair[k];
        const int32_t fi = face[first[p->i] + p->fi], fj = face[first[p->j] + p->fj],
                      set = r->model.plane[p->plane].set;
        if (fi < 0 || fj < 0) {
            r->lost_joints++;
            r->lost_area += p->area;
            continue;
        }
        if (fl_ice_field_add_joint(field, p->i, p->j, fi, fj, p->intact ? "intact" : r->sets.set[set].name,
                                   err))
            return -1;
        r->joints++;
    }
    return 0;
}

int block_export(const struct options *o, struct result *r, const fl_history_line *by, fl_err *err)
{
    const fl_block_model *m = &r->model;
    fl_ice_field field = {0};
    fl_out out = {0};
    fl_poly *core = fl_alloc(m->n, sizeof *core, err);
    int64_t *first = fl_alloc((int64_t)m->n + 1, sizeof *first, err);
    int32_t *face = NULL;
    int rc = -1;
    if (!core || !first) goto done;
    for (int32_t k = 0; k < m->n; k++) first[k + 1] = first[k] + m->block[k].nf;
    if (!(face = fl_alloc(first[m->n], sizeof *face, err)) || make_cores(r, core, first, face, err))
        goto done;
    for (int32_t k = 0; k < m->n; k++) {
        const int32_t g = m->block[k].group;
        if (fl_ice_field_add(&field, k, r->radius, &core[k], o->material,
                             g >= 0 ? m->groups.name[g] : o->group, v3(0, 0, 0), v3(0, 0, 0), err))
            goto done;
    }
    if (add_joints(r, &field, first, face, err) || fl_out_open(&out, o->out, o->gzip, err)) goto done;
    fl_ice_field_write(out.f, &field, by);
    rc = fl_out_close(&out, err);
done:
    for (int32_t k = 0; core && k < m->n; k++) fl_poly_free(&core[k]);
    free(core), free(first), free(face);
    fl_out_abort(&out);
    fl_ice_field_free(&field);
    return rc;
}
