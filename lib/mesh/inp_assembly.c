/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include "base/array.h"
#include "mesh/inp_assembly.h"

static int32_t find_part(const fl_inp_model *r, const char *name)
{
    for (int32_t k = 0; k < r->parts; k++)
        if (strcasecmp(r->sets.words.name[r->part[k].name], name) == 0) return k;
    return -1;
}

int fl_inp_begin_part(fl_inp_model *r, fl_err *err)
{
    const char *name = fl_inp_required(&r->line, "NAME", err);
    fl_inp_part *p;
    if (!name) return -1;
    if (r->store == &r->part_defs || r->instance)
        return fl_inp_fail(&r->line, err, "*PART stands inside a part or an instance", "");
    if (find_part(r, name) >= 0) return fl_inp_fail(&r->line, err, "there is another part ", name);
    if (fl_grow(&r->part, &r->part_cap, (int64_t)r->parts + 1, sizeof *r->part, err)) return -1;
    p = &r->part[r->parts];
    *p = (fl_inp_part){.name = fl_string_table_add(&r->sets.words, name, err), .scope = ++r->scopes};
    if (p->name < 0) return -1;
    p->node[0] = p->node[1] = r->part_defs.node_id.n;
    p->element[0] = p->element[1] = r->part_defs.element_id.n;
    r->parts++;
    r->store = &r->part_defs;
    r->scope = p->scope;
    r->system = fl_affine_identity();
    return 0;
}

static void close_part(fl_inp_model *r)
{
    if (r->store != &r->part_defs) return;
    r->part[r->parts - 1].node[1] = r->part_defs.node_id.n;
    r->part[r->parts - 1].element[1] = r->part_defs.element_id.n;
    fl_inp_leave_part(r);
}

/* Copy a part to the current instance. */
static int copy_part(fl_inp_model *r, fl_inp_part *p, fl_err *err)
{
    const fl_elements *d = &r->part_defs;
    int32_t *part = fl_alloc(d->parts.n, sizeof *part, err); /* index in e, plus one */
    const int32_t file = r->e.file, line = r->e.line;
    const char *place = r->sets.words.name[r->sets.instance[r->instance].name];
    int rc = -1;
    if (!part) return -1;
    for (int32_t k = p->node[0]; k < p->node[1]; k++)
        if (!isnan(d->x[k].x) && fl_elements_add_node(&r->e, r->scope, d->node_id.id[k],
                                                      fl_inp_transform(&r->transform, d->x[k]), err) < 0)
            goto done;
    for (int32_t k = p->element[0]; k < p->element[1]; k++) {
        const fl_element *el = &d->element[k];
        int64_t id[20];
        if (!part[el->part]) {
            const char *own = d->parts.name[el->part];
            char name[2 * FL_SET_NAME_MAX];
            snprintf(name, sizeof name, "%s%s%s", place, *own ? "." : "", own);
            part[el->part] = fl_string_table_add(&r->e.parts, name, err) + 1;
            if (!part[el->part]) goto done;
        }
        for (int c = 0; c < fl_shape_nodes((enum fl_shape)el->shape); c++) {
            const int32_t v = d->connectivity[el->first + c];
            id[c] = v < 0 ? 0 : d->node_id.id[v];
        }
        r->e.file = el->file;
        r->e.line = el->line;
        if (fl_elements_add(&r->e, r->scope, d->element_id.id[k], (enum fl_shape)el->shape,
                            part[el->part] - 1, id, err) < 0)
            goto done;
    }
    p->used = 1;
    rc = 0;
done:
    r->e.file = file;
    r->e.line = line;
    free(part);
    return rc;
}

/* Begin an instance of a part (NULL for none), placed by r->transform. */
static int add_instance(fl_inp_model *r, int32_t name, fl_inp_part *p, fl_err *err)
{
    const fl_instance at = {name, ++r->scopes, p ? p->scope : -1, p ? p->element[0] : 0, r->e.element_id.n};
    r->instance = fl_element_sets_add_instance(&r->sets, at, err);
    if (r->instance < 0) return -1;
    r->scope = at.scope;
    return p ? copy_part(r, p, err) : 0;
}

int fl_inp_instance(fl_inp_model *r, fl_err *err)
{
    const char *name = fl_inp_required(&r->line, "NAME", err), *part = fl_inp_param(&r->line, "PART");
    fl_vec3 move, a, b;
    double degrees;
    int32_t word, k = -1;
    int more;
    if (!name) return -1;
    if (r->store == &r->part_defs || r->instance)
        return fl_inp_fail(&r->line, err, "*INSTANCE stands inside a part or an instance", "");
    if (fl_inp_param(&r->line, "LIBRARY") || fl_inp_param(&r->line, "INSTANCE"))
        return fl_inp_fail(&r->line, err,
                           "*INSTANCE from an earlier analysis is not read: export the assembly with its "
                           "parts written out",
                           "");
    if (fl_element_sets_find_instance(&r->sets, name) >= 0)
        return fl_inp_fail(&r->line, err, "there is another instance ", name);
    if (part && *part && (k = find_part(r, part)) < 0)
        return fl_inp_fail(&r->line, err, "there is no part ", part);
    word = fl_string_table_add(&r->sets.words, name, err);
    if (word < 0) return -1;
    r->transform = r->system = fl_affine_identity();
    more = fl_inp_next_data(&r->line, err);
    if (more > 0) {
        if (fl_inp_point(&r->line, 0, &move, err)) return -1;
        r->transform.t = move;
        more = fl_inp_next_data(&r->line, err);
    }
    if (more > 0) {
        if (fl_inp_point(&r->line, 0, &a, err) || fl_inp_point(&r->line, 3, &b, err) ||
            fl_inp_real(&r->line, 6, &degrees, err))
            return -1;
        if (!(v3_norm(v3_sub(b, a)) > 0.0))
            return fl_inp_fail(&r->line, err, "the axis of the instance has no length", "");
        r->transform.q = fl_affine_rotation(v3_sub(b, a), degrees);
        r->transform.t =
            v3_add(a, m3_mul(r->transform.q, v3_sub(move, a))); /* translated first, then rotated about a */
        more = fl_inp_next_data(&r->line, err);
        if (more > 0) return fl_inp_fail(&r->line, err, "an instance has two lines of data at most", "");
    }
    return more < 0 ? -1 : add_instance(r, word, k >= 0 ? &r->part[k] : NULL, err);
}

int fl_inp_place_unused_parts(fl_inp_model *r, fl_err *err)
{
    const int alone = r->sets.instances == 1;
    int32_t left = 0;
    for (int32_t k = 0; k < r->parts; k++) {
        if (r->part[k].used) continue;
        left += r->part[k].element[1] > r->part[k].element[0];
        if (alone && add_instance(r, r->part[k].name, &r->part[k], err)) return -1;
    }
    fl_inp_leave_part(r);
    if (left && alone)
        fl_bytes_note(r->line.deck.base, "no *INSTANCE: %d parts were taken where they are defined", left);
    else if (left) fl_bytes_note(r->line.deck.base, "%d parts have no *INSTANCE and were skipped", left);
    return 0;
}

int fl_inp_assembly(fl_inp_model *r, fl_err *err)
{
    if (r->store == &r->part_defs) return fl_inp_fail(&r->line, err, "*ASSEMBLY stands inside a part", "");
    return 0;
}

int fl_inp_end_part(fl_inp_model *r, fl_err *err)
{
    if (r->store != &r->part_defs) return fl_inp_fail(&r->line, err, "*END PART without *PART", "");
    close_part(r);
    return 0;
}

int fl_inp_end_instance(fl_inp_model *r, fl_err *err)
{
    if (!r->instance) return fl_inp_fail(&r->line, err, "*END INSTANCE without *INSTANCE", "");
    fl_inp_leave_part(r);
    return 0;
}
