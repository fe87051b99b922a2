/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include "base/mem.h"
#include "mesh/inp_assembly.h"

static int32_t part_called(const fl_inp_model *r, const char *name)
{
    for (int32_t k = 0; k < r->parts; k++)
        if (strcasecmp(r->roster.words.name[r->part[k].name], name) == 0) return k;
    return -1;
}

int fl_inp_part_line(fl_inp_model *r, fl_err *err)
{
    const char *name = fl_inp_wanted(&r->at, "NAME", err);
    fl_inp_part *p;
    if (!name) return -1;
    if (r->store == &r->defs || r->place)
        return fl_inp_fail(&r->at, err, "*PART stands inside a part or an instance", "");
    if (part_called(r, name) >= 0) return fl_inp_fail(&r->at, err, "there is another part ", name);
    if (fl_grow(&r->part, &r->part_cap, (int64_t)r->parts + 1, sizeof *r->part, err)) return -1;
    p = &r->part[r->parts];
    *p = (fl_inp_part){.name = fl_names_add(&r->roster.words, name, err), .room = ++r->rooms};
    if (p->name < 0) return -1;
    p->node[0] = p->node[1] = r->defs.node.n;
    p->element[0] = p->element[1] = r->defs.number.n;
    r->parts++;
    r->store = &r->defs;
    r->room = p->room;
    r->system = fl_similar_one();
    return 0;
}

static void part_ends(fl_inp_model *r)
{
    if (r->store != &r->defs) return;
    r->part[r->parts - 1].node[1] = r->defs.node.n;
    r->part[r->parts - 1].element[1] = r->defs.number.n;
    fl_inp_outside(r);
}

/* Put a part where the instance at hand is. */
static int copy(fl_inp_model *r, fl_inp_part *p, fl_err *err)
{
    const fl_elements *d = &r->defs;
    int32_t *part = fl_alloc(d->parts.n, sizeof *part, err); /* of e, plus one */
    const int32_t file = r->e.file, line = r->e.line;
    const char *place = r->roster.words.name[r->roster.place[r->place].name];
    int rc = -1;
    if (!part) return -1;
    for (int32_t k = p->node[0]; k < p->node[1]; k++)
        if (!isnan(d->x[k].x) &&
            fl_elements_node(&r->e, r->room, d->node.id[k], fl_inp_apply(&r->moved, d->x[k]), err) < 0)
            goto done;
    for (int32_t k = p->element[0]; k < p->element[1]; k++) {
        const fl_element *el = &d->element[k];
        int64_t id[20];
        if (!part[el->part]) {
            const char *own = d->parts.name[el->part];
            char name[2 * FL_ROSTER_NAME];
            snprintf(name, sizeof name, "%s%s%s", place, *own ? "." : "", own);
            part[el->part] = fl_names_add(&r->e.parts, name, err) + 1;
            if (!part[el->part]) goto done;
        }
        for (int c = 0; c < fl_shape_nodes((enum fl_shape)el->shape); c++) {
            const int32_t v = d->corner[el->first + c];
            id[c] = v < 0 ? 0 : d->node.id[v];
        }
        r->e.file = el->file;
        r->e.line = el->line;
        if (fl_elements_add(&r->e, r->room, d->number.id[k], (enum fl_shape)el->shape, part[el->part] - 1, id,
                            err) < 0)
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

/* Open an instance of a part (NULL for none) where r->moved says. */
static int place_part(fl_inp_model *r, int32_t name, fl_inp_part *p, fl_err *err)
{
    const fl_place at = {name, ++r->rooms, p ? p->room : -1, p ? p->element[0] : 0, r->e.number.n};
    r->place = fl_roster_place(&r->roster, at, err);
    if (r->place < 0) return -1;
    r->room = at.room;
    return p ? copy(r, p, err) : 0;
}

int fl_inp_instance(fl_inp_model *r, fl_err *err)
{
    const char *name = fl_inp_wanted(&r->at, "NAME", err), *part = fl_inp_param(&r->at, "PART");
    fl_vec3 move, a, b;
    double degrees;
    int32_t word, k = -1;
    int more;
    if (!name) return -1;
    if (r->store == &r->defs || r->place)
        return fl_inp_fail(&r->at, err, "*INSTANCE stands inside a part or an instance", "");
    if (fl_inp_param(&r->at, "LIBRARY") || fl_inp_param(&r->at, "INSTANCE"))
        return fl_inp_fail(&r->at, err,
                           "*INSTANCE from an earlier analysis is not read: export the assembly with its "
                           "parts written out",
                           "");
    if (fl_roster_find_place(&r->roster, name) >= 0)
        return fl_inp_fail(&r->at, err, "there is another instance ", name);
    if (part && *part && (k = part_called(r, part)) < 0)
        return fl_inp_fail(&r->at, err, "there is no part ", part);
    word = fl_names_add(&r->roster.words, name, err);
    if (word < 0) return -1;
    r->moved = r->system = fl_similar_one();
    more = fl_inp_data(&r->at, err);
    if (more > 0) {
        if (fl_inp_point(&r->at, 0, &move, err)) return -1;
        r->moved.t = move;
        more = fl_inp_data(&r->at, err);
    }
    if (more > 0) {
        if (fl_inp_point(&r->at, 0, &a, err) || fl_inp_point(&r->at, 3, &b, err) ||
            fl_inp_real(&r->at, 6, &degrees, err))
            return -1;
        if (!(v3_norm(v3_sub(b, a)) > 0.0))
            return fl_inp_fail(&r->at, err, "the axis of the instance has no length", "");
        r->moved.q = fl_similar_rotation(v3_sub(b, a), degrees);
        r->moved.t = v3_add(a, m3_mul(r->moved.q, v3_sub(move, a))); /* moved first, then turned about a */
        more = fl_inp_data(&r->at, err);
        if (more > 0) return fl_inp_fail(&r->at, err, "an instance has two lines of data at most", "");
    }
    return more < 0 ? -1 : place_part(r, word, k >= 0 ? &r->part[k] : NULL, err);
}

/* Parts that nobody placed: all of them where they are when there is no assembly, none when there is. */
int fl_inp_place_rest(fl_inp_model *r, fl_err *err)
{
    const int alone = r->roster.places == 1;
    int32_t left = 0;
    for (int32_t k = 0; k < r->parts; k++) {
        if (r->part[k].used) continue;
        left += r->part[k].element[1] > r->part[k].element[0];
        if (alone && place_part(r, r->part[k].name, &r->part[k], err)) return -1;
    }
    fl_inp_outside(r);
    if (left && alone)
        fl_bytes_note(r->at.deck.base, "no *INSTANCE: %d parts were taken where they are defined", left);
    else if (left) fl_bytes_note(r->at.deck.base, "%d parts have no *INSTANCE and were passed over", left);
    return 0;
}

int fl_inp_assembly(fl_inp_model *r, fl_err *err)
{
    if (r->store == &r->defs) return fl_inp_fail(&r->at, err, "*ASSEMBLY stands inside a part", "");
    return 0;
}

int fl_inp_end_part(fl_inp_model *r, fl_err *err)
{
    if (r->store != &r->defs) return fl_inp_fail(&r->at, err, "*END PART without *PART", "");
    part_ends(r);
    return 0;
}

int fl_inp_end_instance(fl_inp_model *r, fl_err *err)
{
    if (!r->place) return fl_inp_fail(&r->at, err, "*END INSTANCE without *INSTANCE", "");
    fl_inp_outside(r);
    return 0;
}
