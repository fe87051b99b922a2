/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "base/pi.h"
#include "mesh/inp_sets.h"

/* The instance that INSTANCE= names, -1 for none. */
static int parse_instance(fl_inp_model *r, int32_t *instance, fl_err *err)
{
    const char *name = fl_inp_param(&r->line, "INSTANCE");
    *instance = -1;
    /* a flattened deck may still name instances that no longer exist */
    if (!name || r->sets.instances == 1) return 0;
    *instance = fl_element_sets_find_instance(&r->sets, name);
    return *instance >= 0 ? 0 : fl_inp_fail(&r->line, err, "there is no instance ", name);
}

/* Parse a word of a data line as an entry: a number, "instance.12" for number 12 of an instance, or the name
 * of a set. */
static int parse_entry(fl_inp_model *r, const char *word, fl_set_entry *n, fl_err *err)
{
    const char *dot = strrchr(word, '.');
    n->file = r->e.file;
    n->line = r->e.line;
    n->set = -1;
    n->step = 1;
    if (fl_deck_integer(word, &n->first) == 0) {
        n->last = n->first;
        return 0;
    }
    if (dot && fl_deck_integer(dot + 1, &n->first) == 0 && n->instance < 0) {
        char instance[FL_SET_NAME_MAX];
        snprintf(instance, sizeof instance, "%.*s", (int)(dot - word), word);
        n->instance = fl_element_sets_find_instance(&r->sets, instance);
        n->last = n->first;
        if (n->instance >= 0) return 0;
    }
    n->set = fl_string_table_add(&r->sets.words, word, err);
    return n->set < 0 ? -1 : 0;
}

int fl_inp_elset(fl_inp_model *r, fl_err *err)
{
    const char *name = fl_inp_required(&r->line, "ELSET", err);
    const int generate = fl_inp_param(&r->line, "GENERATE") != NULL;
    fl_set_entry n = {.kind = FL_SET_ELEMENTS, .face = FL_PICK_WHOLE};
    int32_t set, instance;
    int more;
    if (!name || parse_instance(r, &instance, err)) return -1;
    set = fl_element_sets_get(&r->sets, FL_SET_ELEMENTS, r->scope, name, err);
    if (set < 0) return -1;
    r->sets.set[set].is_explicit = 1;
    while ((more = fl_inp_next_data(&r->line, err)) > 0) {
        for (int k = 0; !generate && k < r->line.fields; k++) {
            n.instance = instance;
            if (r->line.field[k][0] == '\0') continue;
            if (parse_entry(r, r->line.field[k], &n, err) || fl_element_sets_add_entry(&r->sets, set, n, err))
                return -1;
        }
        if (!generate) continue;
        n.instance = instance;
        n.set = -1;
        if (fl_inp_id(&r->line, 0, &n.first, err) || fl_inp_integer(&r->line, 1, n.first, &n.last, err) ||
            fl_inp_integer(&r->line, 2, 1, &n.step, err))
            return -1;
        if (n.step == 0) n.step = 1;
        if (n.step < 0 || n.last < n.first)
            return fl_deck_fail(&r->line.deck, err, "from %lld to %lld by %lld: a rising range is expected",
                                (long long)n.first, (long long)n.last, (long long)n.step);
        if (fl_element_sets_add_entry(&r->sets, set, n, err)) return -1;
    }
    return more;
}

/* Parse a face: S1 .. S6, SPOS, SNEG or nothing.  Returns 0 for one without triangles (edges, ends). */
static int parse_face(const char *word, fl_set_entry *n)
{
    n->face = FL_PICK_FREE;
    n->reversed = 0;
    if (*word == '\0' || strcasecmp(word, "SPOS") == 0) return 1;
    if (strcasecmp(word, "SNEG") == 0) return n->reversed = 1;
    if (toupper((unsigned char)word[0]) != 'S' || word[1] < '1' || word[1] > '6' || word[2]) return 0;
    n->face = (int8_t)(word[1] - '1');
    return 1;
}

int fl_inp_surface(fl_inp_model *r, fl_err *err)
{
    const char *name = fl_inp_required(&r->line, "NAME", err);
    const int union_of = fl_inp_param(&r->line, "COMBINE") != NULL;
    int32_t set, instance, edges = 0;
    int more;
    if (!name || parse_instance(r, &instance, err)) return -1;
    if (union_of && !fl_inp_param_is(&r->line, "COMBINE", "UNION")) {
        fl_bytes_note(r->line.deck.base,
                      "surface \"%.60s\" is a difference or an intersection and was skipped", name);
        return fl_inp_skip_data(r, err);
    }
    if (fl_inp_param(&r->line, "TYPE") && !fl_inp_param_is(&r->line, "TYPE", "ELEMENT"))
        return fl_inp_skip_data(r, err); /* nodes, analytical surfaces */
    set = fl_element_sets_get(&r->sets, FL_SET_SURFACE, r->scope, name, err);
    if (set < 0) return -1;
    r->sets.set[set].is_explicit = 1;
    while ((more = fl_inp_next_data(&r->line, err)) > 0) {
        fl_set_entry n = {.kind = union_of ? FL_SET_SURFACE : FL_SET_ELEMENTS, .instance = instance};
        if (r->line.field[0][0] == '\0') continue; /* the whole outside, for contact */
        if (!parse_face(r->line.fields > 1 && !union_of ? r->line.field[1] : "", &n)) {
            edges++;
            continue;
        }
        if (parse_entry(r, r->line.field[0], &n, err) || fl_element_sets_add_entry(&r->sets, set, n, err))
            return -1;
    }
    if (edges) fl_bytes_note(r->line.deck.base, "%d lines of surfaces name edges and were skipped", edges);
    return more;
}

/* Radius of a round section; others have none. */
int fl_inp_read_section(fl_inp_model *r, fl_err *err)
{
    const int solid = strcmp(r->line.word, "SOLIDSECTION") == 0;
    const int is_round = fl_inp_param_is(&r->line, "SECTION", "CIRC") ||
                         fl_inp_param_is(&r->line, "SECTION", "PIPE") ||
                         fl_inp_param_is(&r->line, "SECTION", "THICKPIPE");
    const char *name = fl_inp_param(&r->line, "ELSET");
    fl_inp_section *s = NULL;
    double x;
    int more;
    if (!name || (!solid && !is_round)) return fl_inp_skip_data(r, err);
    if (fl_grow(&r->section, &r->section_cap, (int64_t)r->sections + 1, sizeof *r->section, err)) return -1;
    s = &r->section[r->sections];
    s->scope = r->scope;
    s->set = fl_string_table_add(&r->sets.words, name, err);
    if (s->set < 0) return -1;
    more = fl_inp_next_data(&r->line, err);
    if (more <= 0) return more;
    if (solid && (r->line.fields == 0 || r->line.field[0][0] == '\0' || fl_deck_real(r->line.field[0], &x) ||
                  !(x > 0.0)))
        return fl_inp_skip_data(r, err);
    if (fl_inp_real(&r->line, 0, &x, err)) return -1;
    if (x < 0.0) return fl_deck_fail(&r->line.deck, err, "a radius of %g, 0 or more is expected", x);
    s->radius = solid ? sqrt(x / PI) : x;
    r->sections++;
    return fl_inp_skip_data(r, err);
}

typedef struct {
    fl_elements *e;
    double radius;
} radius_context;

static int set_radius(void *context, fl_pick pick, fl_err *err)
{
    const radius_context *c = context;
    const enum fl_shape shape = (enum fl_shape)c->e->element[pick.element].shape;
    if (shape != FL_LINE2 && shape != FL_LINE3) return 0;
    return fl_elements_set_radius(c->e, pick.element, c->radius, c->radius, err);
}

int fl_inp_apply_sections(fl_inp_model *r, fl_err *err)
{
    for (int32_t k = 0; k < r->sections; k++) {
        const fl_inp_section *s = &r->section[k];
        radius_context c = {&r->e, s->radius};
        for (int32_t p = 0; p < r->sets.instances; p++) {
            int32_t at = p, set;
            if (r->sets.instance[p].scope != s->scope && r->sets.instance[p].part_scope != s->scope) continue;
            set = fl_element_sets_find(&r->sets, FL_SET_ELEMENTS, &at, r->sets.words.name[s->set]);
            if (set >= 0 && fl_element_sets_visit(&r->sets, &r->e, set, at, set_radius, &c, err)) return -1;
        }
    }
    return 0;
}
