/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include "base/mem.h"
#include "base/pi.h"
#include "mesh/inp_sets.h"

/* The place that INSTANCE= names, -1 for none. */
static int instance_of(fl_inp_model *r, int32_t *place, fl_err *err)
{
    const char *name = fl_inp_param(&r->at, "INSTANCE");
    *place = -1;
    /* a deck that was flattened may still name instances which it has no more */
    if (!name || r->roster.places == 1) return 0;
    *place = fl_roster_find_place(&r->roster, name);
    return *place >= 0 ? 0 : fl_inp_fail(&r->at, err, "there is no instance ", name);
}

/* A word of a data line as an entry: a number, or the name of a set; "instance.12" is number 12 of it. */
static int entry_of(fl_inp_model *r, const char *word, fl_entry *n, fl_err *err)
{
    const char *dot = strrchr(word, '.');
    n->file = r->e.file;
    n->line = r->e.line;
    n->set = -1;
    n->step = 1;
    if (fl_deck_whole(word, &n->first) == 0) {
        n->last = n->first;
        return 0;
    }
    if (dot && fl_deck_whole(dot + 1, &n->first) == 0 && n->place < 0) {
        char place[FL_ROSTER_NAME];
        snprintf(place, sizeof place, "%.*s", (int)(dot - word), word);
        n->place = fl_roster_find_place(&r->roster, place);
        n->last = n->first;
        if (n->place >= 0) return 0;
    }
    n->set = fl_names_add(&r->roster.words, word, err);
    return n->set < 0 ? -1 : 0;
}

int fl_inp_elset(fl_inp_model *r, fl_err *err)
{
    const char *name = fl_inp_wanted(&r->at, "ELSET", err);
    const int generate = fl_inp_param(&r->at, "GENERATE") != NULL;
    fl_entry n = {.kind = FL_ROSTER_SET, .face = FL_PICK_WHOLE};
    int32_t set, place;
    int more;
    if (!name || instance_of(r, &place, err)) return -1;
    set = fl_roster_set_of(&r->roster, FL_ROSTER_SET, r->room, name, err);
    if (set < 0) return -1;
    r->roster.set[set].own = 1;
    while ((more = fl_inp_data(&r->at, err)) > 0) {
        for (int k = 0; !generate && k < r->at.fields; k++) {
            n.place = place;
            if (r->at.field[k][0] == '\0') continue;
            if (entry_of(r, r->at.field[k], &n, err) || fl_roster_add(&r->roster, set, n, err)) return -1;
        }
        if (!generate) continue;
        n.place = place;
        n.set = -1;
        if (fl_inp_number(&r->at, 0, &n.first, err) || fl_inp_whole(&r->at, 1, n.first, &n.last, err) ||
            fl_inp_whole(&r->at, 2, 1, &n.step, err))
            return -1;
        if (n.step == 0) n.step = 1;
        if (n.step < 0 || n.last < n.first)
            return fl_deck_fail(&r->at.deck, err, "from %lld to %lld by %lld: a rising range was wanted",
                                (long long)n.first, (long long)n.last, (long long)n.step);
        if (fl_roster_add(&r->roster, set, n, err)) return -1;
    }
    return more;
}

/* The face that a word names: S1 .. S6, SPOS, SNEG, nothing.  0 when it has no triangles (edges, ends). */
static int face_of(const char *word, fl_entry *n)
{
    n->face = FL_PICK_FREE;
    n->behind = 0;
    if (*word == '\0' || strcasecmp(word, "SPOS") == 0) return 1;
    if (strcasecmp(word, "SNEG") == 0) return n->behind = 1;
    if (toupper((unsigned char)word[0]) != 'S' || word[1] < '1' || word[1] > '6' || word[2]) return 0;
    n->face = (int8_t)(word[1] - '1');
    return 1;
}

int fl_inp_surface(fl_inp_model *r, fl_err *err)
{
    const char *name = fl_inp_wanted(&r->at, "NAME", err);
    const int union_of = fl_inp_param(&r->at, "COMBINE") != NULL;
    int32_t set, place, edges = 0;
    int more;
    if (!name || instance_of(r, &place, err)) return -1;
    if (union_of && !fl_inp_param_is(&r->at, "COMBINE", "UNION")) {
        fl_bytes_note(r->at.deck.base,
                      "surface \"%.60s\" is a difference or an intersection and was passed over", name);
        return fl_inp_pass_over(r, err);
    }
    if (fl_inp_param(&r->at, "TYPE") && !fl_inp_param_is(&r->at, "TYPE", "ELEMENT"))
        return fl_inp_pass_over(r, err); /* nodes, analytical */
    set = fl_roster_set_of(&r->roster, FL_ROSTER_SURFACE, r->room, name, err);
    if (set < 0) return -1;
    r->roster.set[set].own = 1;
    while ((more = fl_inp_data(&r->at, err)) > 0) {
        fl_entry n = {.kind = union_of ? FL_ROSTER_SURFACE : FL_ROSTER_SET, .place = place};
        if (r->at.field[0][0] == '\0') continue; /* all of the outside, for contact */
        if (!face_of(r->at.fields > 1 && !union_of ? r->at.field[1] : "", &n)) {
            edges++;
            continue;
        }
        if (entry_of(r, r->at.field[0], &n, err) || fl_roster_add(&r->roster, set, n, err)) return -1;
    }
    if (edges) fl_bytes_note(r->at.deck.base, "%d lines of surfaces name edges and were passed over", edges);
    return more;
}

/* The radius of round sections; others have none. */
int fl_inp_section_of(fl_inp_model *r, fl_err *err)
{
    const int solid = strcmp(r->at.word, "SOLIDSECTION") == 0;
    const int is_round = fl_inp_param_is(&r->at, "SECTION", "CIRC") ||
                         fl_inp_param_is(&r->at, "SECTION", "PIPE") ||
                         fl_inp_param_is(&r->at, "SECTION", "THICKPIPE");
    const char *name = fl_inp_param(&r->at, "ELSET");
    fl_inp_section *s = NULL;
    double x;
    int more;
    if (!name || (!solid && !is_round)) return fl_inp_pass_over(r, err);
    if (fl_grow(&r->section, &r->section_cap, (int64_t)r->sections + 1, sizeof *r->section, err)) return -1;
    s = &r->section[r->sections];
    s->room = r->room;
    s->set = fl_names_add(&r->roster.words, name, err);
    if (s->set < 0) return -1;
    more = fl_inp_data(&r->at, err);
    if (more <= 0) return more;
    if (solid &&
        (r->at.fields == 0 || r->at.field[0][0] == '\0' || fl_deck_real(r->at.field[0], &x) || !(x > 0.0)))
        return fl_inp_pass_over(r, err);
    if (fl_inp_real(&r->at, 0, &x, err)) return -1;
    if (x < 0.0) return fl_deck_fail(&r->at.deck, err, "a radius of %g, 0 or more was wanted", x);
    s->radius = solid ? sqrt(x / PI) : x;
    r->sections++;
    return fl_inp_pass_over(r, err);
}

typedef struct {
    fl_elements *e;
    double radius;
} radius_of;

static int set_radius(void *context, fl_pick pick, fl_err *err)
{
    const radius_of *c = context;
    const enum fl_shape shape = (enum fl_shape)c->e->element[pick.element].shape;
    if (shape != FL_LINE2 && shape != FL_LINE3) return 0;
    return fl_elements_radius(c->e, pick.element, c->radius, c->radius, err);
}

int fl_inp_radii(fl_inp_model *r, fl_err *err)
{
    for (int32_t k = 0; k < r->sections; k++) {
        const fl_inp_section *s = &r->section[k];
        radius_of c = {&r->e, s->radius};
        for (int32_t p = 0; p < r->roster.places; p++) {
            int32_t at = p, set;
            if (r->roster.place[p].room != s->room && r->roster.place[p].part != s->room) continue;
            set = fl_roster_find(&r->roster, FL_ROSTER_SET, &at, r->roster.words.name[s->set]);
            if (set >= 0 && fl_roster_walk(&r->roster, &r->e, set, at, set_radius, &c, err)) return -1;
        }
    }
    return 0;
}
