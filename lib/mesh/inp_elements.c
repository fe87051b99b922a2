/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include "mesh/inp_elements.h"
#include "mesh/inp_type.h"

enum {
    NODES = 64, /* per element, more than any type has */
    FULL = 16   /* numbers on a full line */
};

/* Add the element to the set that its own line names. */
static int add_to_set(fl_inp_model *r, int32_t set, int32_t element, int implied, fl_err *err)
{
    const fl_set_entry run = {.first = element,
                              .last = element,
                              .set = -1,
                              .instance = -1,
                              .file = r->e.file,
                              .line = r->e.line,
                              .face = FL_PICK_WHOLE,
                              .implied = (int8_t)implied};
    return set < 0 ? 0 : fl_element_sets_add_entry(&r->sets, set, run, err);
}

/* Part of the elements in this set (-1 for none) of the current store.  In the store of part definitions it
 * is called like the set alone, which may be "". */
static int32_t part_of_set(fl_inp_model *r, int32_t set, fl_err *err)
{
    const char *own = set < 0 ? "" : r->sets.words.name[r->sets.set[set].name];
    const char *place = r->instance > 0 ? r->sets.words.name[r->sets.instance[r->instance].name] : "";
    char name[2 * FL_SET_NAME_MAX];
    if (r->store == &r->part_defs) return fl_string_table_add(&r->part_defs.parts, own, err);
    if (r->instance == 0) return fl_string_table_add(&r->e.parts, set < 0 ? r->name : own, err);
    snprintf(name, sizeof name, "%s%s%s", place, set < 0 ? "" : ".", own);
    return fl_string_table_add(&r->e.parts, name, err);
}

/* Fails with the line of an element that ends there. */
static int fail_short(fl_inp_model *r, int32_t line, int64_t id, int nodes, int least, fl_err *err)
{
    r->e.line = line;
    return fl_deck_fail(&r->line.deck, err, "element %lld has %d nodes, %d are expected", (long long)id,
                        nodes, least);
}

/* Read the numbers of one element, over as many lines as needed: its own and at least `least` nodes, up to
 * `most` where a line announces more.  Numbers behind these on a line that holds the whole element are
 * ignored and counted, as in CalculiX; on any other line they show that the type is wrong.  Returns their
 * count, 0 at the end of the data, or -1. */
static int read_element_row(fl_inp_model *r, int least, int most, int64_t *id, fl_err *err)
{
    int32_t line = 0, first_line = 0;
    int n = 0, first_nodes = 0, ends = 0; /* of the first line: nodes, and it ends without a comma */
    for (;;) {
        const int more = fl_inp_next_data(&r->line, err), first = n == 0;
        int wide = 0;
        if (more < 0) return -1;
        if (!more) break;
        line = r->e.line;
        if (first) first_line = line, first_nodes = r->line.fields - 1, ends = !r->line.more;
        for (int k = 0; k < r->line.fields; k++) {
            if (n > most && (first || r->line.field[k][0] == '\0')) {
                wide |= r->line.field[k][0] != '\0';
                continue;
            }
            if (n > most && ends && first_nodes < least)
                return fail_short(r, first_line, id[0], first_nodes, least, err);
            if (n > most)
                return fl_deck_fail(&r->line.deck, err, "element %lld has more than %d nodes",
                                    (long long)id[0], most);
            if (n == 0 ? fl_inp_id(&r->line, k, &id[0], err) : fl_inp_integer(&r->line, k, 0, &id[n], err))
                return -1;
            n++;
        }
        r->extra_nodes += wide;
        /* a comma behind a full line announces more; behind a complete element it means nothing */
        if (n > least && !(r->line.more && r->line.fields == FULL && n <= most)) return n;
    }
    if (n == 0) return 0;
    return ends ? fail_short(r, first_line, id[0], first_nodes, least, err)
                : fail_short(r, line, id[0], n - 1, least, err);
}

/* Count the elements of a type without a surface. */
static int skip_elements(fl_inp_model *r, const char *type, fl_err *err)
{
    int more, going = 0;
    while ((more = fl_inp_next_data(&r->line, err)) > 0) {
        if (!going && fl_elements_skip(&r->e, type, err)) return -1;
        going = r->line.more;
    }
    return more;
}

int fl_inp_element(fl_inp_model *r, fl_err *err)
{
    const char *type = fl_inp_required(&r->line, "TYPE", err), *set_name = fl_inp_param(&r->line, "ELSET");
    char type_name[32];
    fl_inp_type t;
    int32_t set = -1, part;
    int n;
    if (!type) return -1;
    snprintf(type_name, sizeof type_name, "%s", type);
    if (set_name && *set_name) {
        set = fl_element_sets_get(&r->sets, FL_SET_ELEMENTS, r->scope, set_name, err);
        if (set < 0) return -1;
    }
    if (fl_inp_follow_input(r, err)) return -1;
    if (!fl_inp_type_of(type_name, &t)) return skip_elements(r, type_name, err);
    part = part_of_set(r, set, err);
    if (part < 0) return -1;
    for (;;) {
        int64_t id[NODES];
        int32_t k;
        n = read_element_row(r, t.nodes, t.nodes + t.optional, id, err);
        if (n <= 0) return n;
        if (t.middle) { /* Abaqus puts the middle node second */
            const int64_t mid = id[2];
            id[2] = id[3];
            id[3] = mid;
        }
        if (fl_inp_set_location(r, err)) return -1;
        k = fl_elements_add(r->store, r->scope, id[0], t.shape, part, id + 1, err);
        if (k < 0 || add_to_set(r, set, k, 1, err)) return -1;
    }
}

/* One line of *ELGEN: a row of n[0] elements from the master on, n[1] such rows, n[2] layers of rows. */
static int generate_elements(fl_inp_model *r, int32_t set, fl_err *err)
{
    int64_t id, n[3], node[3], step[3], total = 1, number_of[20];
    int32_t master;
    fl_element el;
    if (fl_inp_id(&r->line, 0, &id, err) || fl_inp_set_location(r, err)) return -1;
    for (int k = 0; k < 3; k++) {
        if (fl_inp_integer(&r->line, 3 * k + 1, 1, &n[k], err) ||
            fl_inp_integer(&r->line, 3 * k + 2, 1, &node[k], err) ||
            fl_inp_integer(&r->line, 3 * k + 3, 1, &step[k], err))
            return -1;
        if (n[k] == 0) n[k] = 1;
        if (n[k] < 0 || llabs(node[k]) > 1000000000 || llabs(step[k]) > 1000000000)
            return fl_deck_fail(&r->line.deck, err,
                                "counts of 1 or more and steps of up to 1e9 are expected");
        if (n[k] > FL_INP_GENERATED_MAX)
            n[k] = FL_INP_GENERATED_MAX; /* fl_inp_count_generated() rejects it below */
        total *= n[k];
        if (total > FL_INP_GENERATED_MAX) total = (int64_t)FL_INP_GENERATED_MAX + 1;
    }
    master = fl_id_map_find(&r->store->element_id, r->scope, id);
    if (master < 0 && r->e.skipped.n) return 0; /* the master may be a skipped element */
    if (master < 0)
        return fl_deck_fail(&r->line.deck, err, "*ELGEN refers to element %lld, which is not defined yet",
                            (long long)id);
    if (fl_inp_count_generated(r, total, err) || add_to_set(r, set, master, 0, err)) return -1;
    el = r->store->element[master];
    for (int64_t k = 1; k < total; k++) {
        const int64_t i = k % n[0], j = k / n[0] % n[1], l = k / n[0] / n[1];
        const int64_t move = i * node[0] + j * node[1] + l * node[2];
        const int64_t next = id + i * step[0] + j * step[1] + l * step[2];
        int32_t new;
        if (next < 1)
            return fl_deck_fail(&r->line.deck, err,
                                "this makes element %lld, numbers of 1 or more are expected",
                                (long long)next);
        for (int c = 0; c < fl_shape_nodes((enum fl_shape)el.shape); c++) {
            const int32_t v = r->store->connectivity[el.first + c];
            number_of[c] = v < 0 ? 0 : r->store->node_id.id[v] + move;
        }
        new = fl_elements_add(r->store, r->scope, next, (enum fl_shape)el.shape, el.part, number_of, err);
        if (new < 0 || add_to_set(r, set, new, 0, err)) return -1;
    }
    return 0;
}

int fl_inp_elgen(fl_inp_model *r, fl_err *err)
{
    const char *name = fl_inp_param(&r->line, "ELSET");
    int32_t set = -1;
    int more;
    if (name && *name) {
        set = fl_element_sets_get(&r->sets, FL_SET_ELEMENTS, r->scope, name, err);
        if (set < 0) return -1;
    }
    while ((more = fl_inp_next_data(&r->line, err)) > 0)
        if (generate_elements(r, set, err)) return -1;
    return more;
}
