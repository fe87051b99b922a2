/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/mem.h"
#include "geom/similar.h"
#include "mesh/inp_line.h"
#include "mesh/inp_type.h"
#include "mesh/read_inp.h"
#include "mesh/roster.h"

enum {
    NODES = 64, /* of an element, and more than any has */
    FULL = 16   /* numbers on a line */
};

static const double PI = 3.14159265358979323846;

/* The radius of the lines of a set. */
typedef struct {
    int32_t set, room; /* set: of words */
    double radius;
} section;

/* A part, as it is defined; parts are never placed twice in one room. */
typedef struct {
    int32_t name, room; /* name: of words */
    int32_t node[2], element[2];
    int32_t used;
} definition;

typedef struct {
    fl_elements e, defs; /* what is in its place; parts that wait for their instances */
    fl_roster roster;
    definition *part;
    section *section;
    int32_t parts, part_cap, sections, section_cap, rooms, made;
    const char *name; /* of elements without a set */
    /* where what comes next goes */
    fl_elements *store;
    int32_t room, place;
    fl_similar moved, system; /* of the instance; of *SYSTEM */
    fl_inp_line at;
} reader;

int fl_inp_is(const fl_bytes *b)
{
    const char *p = b->data;
    for (;;) {
        p += strspn(p, " \t\r\n\f\v");
        if (p[0] != '*' || p[1] != '*') break;
        p += strcspn(p, "\r\n");
    }
    return p[0] == '*' && isalpha((unsigned char)p[1 + strspn(p + 1, " \t")]);
}

/* Let the store that is filled know where the line stands. */
static int here(reader *r, fl_err *err)
{
    if (r->store == &r->e) return 0;
    while (r->defs.files.n <= r->e.file)
        if (fl_elements_file(&r->defs, r->e.files.name[r->defs.files.n], err)) return -1;
    r->defs.file = r->e.file;
    r->defs.line = r->e.line;
    return 0;
}

static fl_vec3 apply(const fl_similar *m, fl_vec3 x) { return v3_add(m3_mul(m->q, x), m->t); }

/* --- nodes ---------------------------------------------------------------------------------------------- */

/* INPUT=: the data stand in a file. */
static int input(reader *r, fl_err *err)
{
    const char *path = fl_inp_param(&r->at, "INPUT");
    return path ? fl_deck_include(&r->at.deck, path, err) : 0;
}

static int node_lines(reader *r, fl_err *err)
{
    const int round = fl_inp_param_is(&r->at, "SYSTEM", "C");
    int more;
    if (!round && fl_inp_param(&r->at, "SYSTEM") && !fl_inp_param_is(&r->at, "SYSTEM", "R"))
        return fl_inp_fail(&r->at, err,
                           "*NODE with SYSTEM= other than R and C is not read: export the nodes in "
                           "rectangular coordinates",
                           "");
    if (input(r, err)) return -1;
    while ((more = fl_inp_data(&r->at, err)) > 0) {
        int64_t id;
        fl_vec3 x;
        if (fl_inp_number(&r->at, 0, &id, err) || fl_inp_point(&r->at, 1, &x, err) || here(r, err)) return -1;
        if (round) {
            const fl_mat3 q = fl_similar_rotation(v3(0, 0, 1), x.y);
            x = v3_add(m3_mul(q, v3(x.x, 0, 0)), v3(0, 0, x.z));
        }
        if (fl_elements_node(r->store, r->room, id, apply(&r->moved, apply(&r->system, x)), err) < 0)
            return -1;
    }
    return more;
}

/* One or two lines: the origin and a point on the first axis, a point beside it; nothing ends it. */
static int system_lines(reader *r, fl_err *err)
{
    fl_vec3 a, b, c, x, z = v3(0, 0, 1);
    int more = fl_inp_data(&r->at, err), given;
    r->system = fl_similar_one();
    if (more <= 0) return more;
    if (fl_inp_point(&r->at, 0, &a, err) || fl_inp_point(&r->at, 3, &b, err)) return -1;
    given = r->at.fields > 3;
    r->system.t = a;
    more = fl_inp_data(&r->at, err);
    if (more < 0 || !given) return more < 0 ? -1 : 0;
    x = v3_sub(b, a);
    if (more) {
        if (fl_inp_point(&r->at, 0, &c, err)) return -1;
        z = v3_cross(x, v3_sub(c, a));
    } else {
        x.z = 0.0; /* the third axis stays, the first one is projected */
    }
    x = v3_unit(x);
    z = v3_unit(z);
    if (!(v3_norm(x) > 0.5) || !(v3_norm(z) > 0.5))
        return fl_inp_fail(&r->at, err, "the points of *SYSTEM lie on one line", "");
    const fl_vec3 y = v3_cross(z, x);
    r->system.q = (fl_mat3){{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
    return 0;
}

/* May n more be made from a line?  A deck is read within what its bytes allow. */
static int make(reader *r, int64_t n, fl_err *err)
{
    if (n > FL_INP_MADE - r->made)
        return fl_deck_fail(&r->at.deck, err,
                            "more than %d nodes and elements are generated: export them all", FL_INP_MADE);
    r->made += (int32_t)n;
    return 0;
}

static int place_of(reader *r, int64_t id, fl_vec3 *x, fl_err *err)
{
    const int32_t k = fl_numbers_find(&r->store->node, r->room, id);
    if (k < 0 || isnan(r->store->x[k].x))
        return fl_deck_fail(&r->at.deck, err, "*NGEN wants node %lld, which is not defined yet",
                            (long long)id);
    *x = r->store->x[k];
    return 0;
}

static int ngen_lines(reader *r, fl_err *err)
{
    int more;
    if (fl_inp_param(&r->at, "LINE") ||
        (fl_inp_param(&r->at, "SYSTEM") && !fl_inp_param_is(&r->at, "SYSTEM", "RC")))
        return fl_inp_fail(&r->at, err,
                           "*NGEN on arcs and parabolas is not read: export the deck with all nodes written "
                           "out",
                           "");
    while ((more = fl_inp_data(&r->at, err)) > 0) {
        int64_t first, last, step, n;
        fl_vec3 a, b;
        if (fl_inp_number(&r->at, 0, &first, err) || fl_inp_number(&r->at, 1, &last, err) ||
            fl_inp_whole(&r->at, 2, 1, &step, err))
            return -1;
        if (step == 0) step = 1;
        if (step < 0 || last < first || (last - first) % step)
            return fl_deck_fail(&r->at.deck, err,
                                "nodes %lld to %lld by %lld: steps that end there were wanted",
                                (long long)first, (long long)last, (long long)step);
        n = (last - first) / step;
        if (here(r, err) || place_of(r, first, &a, err) || place_of(r, last, &b, err) || make(r, n, err))
            return -1;
        for (int64_t k = 1; k < n; k++)
            if (fl_elements_node(r->store, r->room, first + k * step,
                                 v3_madd(a, (double)k / (double)n, v3_sub(b, a)), err) < 0)
                return -1;
    }
    return more;
}

/* --- elements ------------------------------------------------------------------------------------------- */

/* Put the element into the set that its own line names. */
static int join_set(reader *r, int32_t set, int32_t element, int implied, fl_err *err)
{
    const fl_entry run = {.first = element,
                          .last = element,
                          .set = -1,
                          .place = -1,
                          .file = r->e.file,
                          .line = r->e.line,
                          .face = FL_PICK_WHOLE,
                          .implied = (int8_t)implied};
    return set < 0 ? 0 : fl_roster_add(&r->roster, set, run, err);
}

/* The part of elements in this set (-1 for none) of the store at hand: in the store of parts the name of the
 * set alone, which may be "". */
static int32_t part_of(reader *r, int32_t set, fl_err *err)
{
    const char *own = set < 0 ? "" : r->roster.words.name[r->roster.set[set].shown];
    const char *place = r->place > 0 ? r->roster.words.name[r->roster.place[r->place].name] : "";
    char name[2 * FL_ROSTER_NAME];
    if (r->store == &r->defs) return fl_names_add(&r->defs.parts, own, err);
    if (r->place == 0) return fl_names_add(&r->e.parts, set < 0 ? r->name : own, err);
    snprintf(name, sizeof name, "%s%s%s", place, set < 0 ? "" : ".", own);
    return fl_names_add(&r->e.parts, name, err);
}

/* The numbers of one element: at least `least` of them and its own, over as many lines as it takes; more
 * where the line says that more come, up to `most`.  How many, 0 at the end of the data, -1. */
static int element_row(reader *r, int least, int most, int64_t *id, fl_err *err)
{
    int32_t line = 0;
    int n = 0;
    for (;;) {
        const int more = fl_inp_data(&r->at, err);
        if (more < 0) return -1;
        if (!more) break;
        line = r->e.line;
        for (int k = 0; k < r->at.fields; k++) {
            if (n > most && r->at.field[k][0] == '\0') continue;
            if (n > most)
                return fl_deck_fail(&r->at.deck, err, "element %lld has more than %d nodes", (long long)id[0],
                                    most);
            if (n == 0 ? fl_inp_number(&r->at, k, &id[0], err) : fl_inp_whole(&r->at, k, 0, &id[n], err))
                return -1;
            n++;
        }
        /* a comma behind a full line says that more come; behind a complete element it says nothing */
        if (n > least && !(r->at.more && r->at.fields == FULL && n <= most)) return n;
    }
    if (n == 0) return 0;
    r->e.line = line; /* that of the element, not of what comes behind it */
    return fl_deck_fail(&r->at.deck, err, "element %lld has %d nodes, %d were wanted", (long long)id[0],
                        n - 1, least);
}

/* Elements of a type without a surface: counted. */
static int skip_elements(reader *r, const char *type, fl_err *err)
{
    int more, going = 0;
    while ((more = fl_inp_data(&r->at, err)) > 0) {
        if (!going && fl_elements_skip(&r->e, type, err)) return -1;
        going = r->at.more;
    }
    return more;
}

static int element_lines(reader *r, fl_err *err)
{
    const char *type = fl_inp_wanted(&r->at, "TYPE", err), *set_name = fl_inp_param(&r->at, "ELSET");
    char type_name[32];
    fl_inp_type t;
    int32_t set = -1, part;
    int n;
    if (!type) return -1;
    snprintf(type_name, sizeof type_name, "%s", type);
    if (set_name && *set_name) {
        set = fl_roster_set_of(&r->roster, FL_ROSTER_SET, r->room, set_name, err);
        if (set < 0) return -1;
    }
    if (input(r, err)) return -1;
    if (!fl_inp_type_of(type_name, &t)) return skip_elements(r, type_name, err);
    part = part_of(r, set, err);
    if (part < 0) return -1;
    for (;;) {
        int64_t id[NODES];
        int32_t k;
        n = element_row(r, t.nodes, t.nodes + t.spare, id, err);
        if (n <= 0) return n;
        if (t.middle) { /* the second of three is that in the middle */
            const int64_t mid = id[2];
            id[2] = id[3];
            id[3] = mid;
        }
        if (here(r, err)) return -1;
        k = fl_elements_add(r->store, r->room, id[0], t.shape, part, id + 1, err);
        if (k < 0 || join_set(r, set, k, 1, err)) return -1;
    }
}

/* One line of *ELGEN: a row of n[0] elements from the master on, n[1] such rows, n[2] layers of them. */
static int elgen_line(reader *r, int32_t set, fl_err *err)
{
    int64_t id, n[3], node[3], step[3], total = 1, number_of[20];
    int32_t master;
    fl_element el;
    if (fl_inp_number(&r->at, 0, &id, err) || here(r, err)) return -1;
    for (int k = 0; k < 3; k++) {
        if (fl_inp_whole(&r->at, 3 * k + 1, 1, &n[k], err) ||
            fl_inp_whole(&r->at, 3 * k + 2, 1, &node[k], err) ||
            fl_inp_whole(&r->at, 3 * k + 3, 1, &step[k], err))
            return -1;
        if (n[k] == 0) n[k] = 1;
        if (n[k] < 0 || llabs(node[k]) > 1000000000 || llabs(step[k]) > 1000000000)
            return fl_deck_fail(&r->at.deck, err, "counts of 1 or more and steps of up to 1e9 were wanted");
        if (n[k] > FL_INP_MADE) n[k] = FL_INP_MADE; /* make() refuses it below */
        total *= n[k];
        if (total > FL_INP_MADE) total = (int64_t)FL_INP_MADE + 1;
    }
    master = fl_numbers_find(&r->store->number, r->room, id);
    if (master < 0 && r->e.skipped.n) return 0; /* it may be one of those */
    if (master < 0)
        return fl_deck_fail(&r->at.deck, err, "*ELGEN wants element %lld, which is not defined yet",
                            (long long)id);
    if (make(r, total, err) || join_set(r, set, master, 0, err)) return -1;
    el = r->store->element[master];
    for (int64_t k = 1; k < total; k++) {
        const int64_t i = k % n[0], j = k / n[0] % n[1], l = k / n[0] / n[1];
        const int64_t move = i * node[0] + j * node[1] + l * node[2];
        const int64_t next = id + i * step[0] + j * step[1] + l * step[2];
        int32_t new;
        if (next < 1)
            return fl_deck_fail(&r->at.deck, err, "this makes element %lld, numbers of 1 or more were wanted",
                                (long long)next);
        for (int c = 0; c < fl_shape_nodes((enum fl_shape)el.shape); c++) {
            const int32_t v = r->store->corner[el.first + c];
            number_of[c] = v < 0 ? 0 : r->store->node.id[v] + move;
        }
        new = fl_elements_add(r->store, r->room, next, (enum fl_shape)el.shape, el.part, number_of, err);
        if (new < 0 || join_set(r, set, new, 0, err)) return -1;
    }
    return 0;
}

static int elgen_lines(reader *r, fl_err *err)
{
    const char *name = fl_inp_param(&r->at, "ELSET");
    int32_t set = -1;
    int more;
    if (name && *name) {
        set = fl_roster_set_of(&r->roster, FL_ROSTER_SET, r->room, name, err);
        if (set < 0) return -1;
    }
    while ((more = fl_inp_data(&r->at, err)) > 0)
        if (elgen_line(r, set, err)) return -1;
    return more;
}

/* --- sets, surfaces, sections --------------------------------------------------------------------------- */

/* The place that INSTANCE= names, -1 for none. */
static int instance_of(reader *r, int32_t *place, fl_err *err)
{
    const char *name = fl_inp_param(&r->at, "INSTANCE");
    *place = -1;
    if (!name) return 0;
    *place = fl_roster_find_place(&r->roster, name);
    return *place >= 0 ? 0 : fl_inp_fail(&r->at, err, "there is no instance ", name);
}

/* A word of a data line as an entry: a number, or the name of a set; "instance.12" is number 12 of it. */
static int entry_of(reader *r, const char *word, fl_entry *n, fl_err *err)
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

static int elset_lines(reader *r, fl_err *err)
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

/* Data that are of no use here. */
static int pass_over(reader *r, fl_err *err)
{
    int more;
    while ((more = fl_inp_next(&r->at, err)) == 2) {}
    if (more == 1) fl_deck_hold(&r->at.deck);
    return more < 0 ? -1 : 0;
}

static int surface_lines(reader *r, fl_err *err)
{
    const char *name = fl_inp_wanted(&r->at, "NAME", err);
    const int union_of = fl_inp_param(&r->at, "COMBINE") != NULL;
    int32_t set, place, edges = 0;
    int more;
    if (!name || instance_of(r, &place, err)) return -1;
    if (union_of && !fl_inp_param_is(&r->at, "COMBINE", "UNION")) {
        fl_bytes_note(r->at.deck.base,
                      "surface \"%.60s\" is a difference or an intersection and was passed over", name);
        return pass_over(r, err);
    }
    if (fl_inp_param(&r->at, "TYPE") && !fl_inp_param_is(&r->at, "TYPE", "ELEMENT"))
        return pass_over(r, err); /* nodes, analytical */
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
static int section_lines(reader *r, fl_err *err)
{
    const int solid = strcmp(r->at.word, "SOLIDSECTION") == 0;
    const int is_round = fl_inp_param_is(&r->at, "SECTION", "CIRC") ||
                         fl_inp_param_is(&r->at, "SECTION", "PIPE") ||
                         fl_inp_param_is(&r->at, "SECTION", "THICKPIPE");
    const char *name = fl_inp_param(&r->at, "ELSET");
    section *s = NULL;
    double x;
    int more;
    if (!name || (!solid && !is_round)) return pass_over(r, err);
    if (fl_grow(&r->section, &r->section_cap, (int64_t)r->sections + 1, sizeof *r->section, err)) return -1;
    s = &r->section[r->sections];
    s->room = r->room;
    s->set = fl_names_add(&r->roster.words, name, err);
    if (s->set < 0) return -1;
    more = fl_inp_data(&r->at, err);
    if (more <= 0) return more;
    if (solid &&
        (r->at.fields == 0 || r->at.field[0][0] == '\0' || fl_deck_real(r->at.field[0], &x) || !(x > 0.0)))
        return pass_over(r, err);
    if (fl_inp_real(&r->at, 0, &x, err)) return -1;
    if (x < 0.0) return fl_deck_fail(&r->at.deck, err, "a radius of %g, 0 or more was wanted", x);
    s->radius = solid ? sqrt(x / PI) : x;
    r->sections++;
    return pass_over(r, err);
}

/* --- parts and instances -------------------------------------------------------------------------------- */

/* From here on, elements and nodes belong to the deck. */
static void outside(reader *r)
{
    r->store = &r->e;
    r->room = r->place = 0;
    r->moved = r->system = fl_similar_one();
}

static int32_t part_called(const reader *r, const char *name)
{
    for (int32_t k = 0; k < r->parts; k++)
        if (strcasecmp(r->roster.words.name[r->part[k].name], name) == 0) return k;
    return -1;
}

static int part_line(reader *r, fl_err *err)
{
    const char *name = fl_inp_wanted(&r->at, "NAME", err);
    definition *p;
    if (!name) return -1;
    if (r->store == &r->defs || r->place)
        return fl_inp_fail(&r->at, err, "*PART stands inside a part or an instance", "");
    if (part_called(r, name) >= 0) return fl_inp_fail(&r->at, err, "there is another part ", name);
    if (fl_grow(&r->part, &r->part_cap, (int64_t)r->parts + 1, sizeof *r->part, err)) return -1;
    p = &r->part[r->parts];
    *p = (definition){.name = fl_names_add(&r->roster.words, name, err), .room = ++r->rooms};
    if (p->name < 0) return -1;
    p->node[0] = p->node[1] = r->defs.node.n;
    p->element[0] = p->element[1] = r->defs.number.n;
    r->parts++;
    r->store = &r->defs;
    r->room = p->room;
    r->system = fl_similar_one();
    return 0;
}

static void part_ends(reader *r)
{
    if (r->store != &r->defs) return;
    r->part[r->parts - 1].node[1] = r->defs.node.n;
    r->part[r->parts - 1].element[1] = r->defs.number.n;
    outside(r);
}

/* Put a part where the instance at hand is. */
static int copy(reader *r, definition *p, fl_err *err)
{
    const fl_elements *d = &r->defs;
    int32_t *part = fl_alloc(d->parts.n, sizeof *part, err); /* of e, plus one */
    const int32_t file = r->e.file, line = r->e.line;
    const char *place = r->roster.words.name[r->roster.place[r->place].name];
    int rc = -1;
    if (!part) return -1;
    for (int32_t k = p->node[0]; k < p->node[1]; k++)
        if (!isnan(d->x[k].x) &&
            fl_elements_node(&r->e, r->room, d->node.id[k], apply(&r->moved, d->x[k]), err) < 0)
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
static int place_part(reader *r, int32_t name, definition *p, fl_err *err)
{
    const fl_place at = {name, ++r->rooms, p ? p->room : -1, p ? p->element[0] : 0, r->e.number.n};
    r->place = fl_roster_place(&r->roster, at, err);
    if (r->place < 0) return -1;
    r->room = at.room;
    return p ? copy(r, p, err) : 0;
}

static int instance_line(reader *r, fl_err *err)
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
static int place_rest(reader *r, fl_err *err)
{
    const int alone = r->roster.places == 1;
    int32_t left = 0;
    for (int32_t k = 0; k < r->parts; k++) {
        if (r->part[k].used) continue;
        left += r->part[k].element[1] > r->part[k].element[0];
        if (alone && place_part(r, r->part[k].name, &r->part[k], err)) return -1;
    }
    outside(r);
    if (left && alone)
        fl_bytes_note(r->at.deck.base, "no *INSTANCE: %d parts were taken where they are defined", left);
    else if (left) fl_bytes_note(r->at.deck.base, "%d parts have no *INSTANCE and were passed over", left);
    return 0;
}

/* --- all of it ------------------------------------------------------------------------------------------ */

static int refuse(reader *r, fl_err *err)
{
    return fl_deck_fail(&r->at.deck, err,
                        "*%s is not read: export the deck with all nodes and elements written out",
                        r->at.word);
}

static int assembly_line(reader *r, fl_err *err)
{
    if (r->store == &r->defs) return fl_inp_fail(&r->at, err, "*ASSEMBLY stands inside a part", "");
    return 0;
}

static int end_part(reader *r, fl_err *err)
{
    if (r->store != &r->defs) return fl_inp_fail(&r->at, err, "*END PART without *PART", "");
    part_ends(r);
    return 0;
}

static int end_instance(reader *r, fl_err *err)
{
    if (!r->place) return fl_inp_fail(&r->at, err, "*END INSTANCE without *INSTANCE", "");
    outside(r);
    return 0;
}

static int ls_dyna(reader *r, fl_err *err)
{
    return fl_inp_fail(&r->at, err,
                       "a deck of LS-DYNA is not read: export it as Abaqus, Nastran, Ansys or STL", "");
}

static const struct {
    const char *word;
    int (*read)(reader *r, fl_err *err);
} KEYWORD[] = {{"NODE", node_lines},
               {"ELEMENT", element_lines},
               {"ELSET", elset_lines},
               {"SURFACE", surface_lines},
               {"SYSTEM", system_lines},
               {"NGEN", ngen_lines},
               {"ELGEN", elgen_lines},
               {"BEAMSECTION", section_lines},
               {"BEAMGENERALSECTION", section_lines},
               {"FRAMESECTION", section_lines},
               {"SOLIDSECTION", section_lines},
               {"PART", part_line},
               {"ENDPART", end_part},
               {"ASSEMBLY", assembly_line},
               {"INSTANCE", instance_line},
               {"ENDINSTANCE", end_instance},
               {"NCOPY", refuse},
               {"ELCOPY", refuse},
               {"NFILL", refuse},
               {"NMAP", refuse},
               {"PARAMETER", refuse},
               {"SYMMETRICMODELGENERATION", refuse},
               {"IMPORT", refuse},
               {"KEYWORD", ls_dyna}};

static int read_keywords(reader *r, fl_err *err)
{
    int kind;
    while ((kind = fl_inp_next(&r->at, err)) > 0) {
        size_t k = 0;
        if (kind == 2) continue; /* data of a keyword that was passed over */
        if (fl_inp_keyword(&r->at, err)) return -1;
        while (k < sizeof KEYWORD / sizeof *KEYWORD && strcmp(r->at.word, KEYWORD[k].word) != 0) k++;
        if (k < sizeof KEYWORD / sizeof *KEYWORD && KEYWORD[k].read(r, err)) return -1;
    }
    if (kind == 0 && r->store == &r->defs) return fl_inp_fail(&r->at, err, "the deck ends inside a part", "");
    return kind;
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

static int give_radii(reader *r, fl_err *err)
{
    for (int32_t k = 0; k < r->sections; k++) {
        const section *s = &r->section[k];
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

static void end(reader *r)
{
    fl_inp_end(&r->at);
    fl_elements_free(&r->e);
    fl_elements_free(&r->defs);
    fl_roster_free(&r->roster);
    free(r->part);
    free(r->section);
}

int fl_inp_read(fl_surface *s, fl_bytes *b, const char *name, fl_wish *w, fl_err *err)
{
    reader r = {.name = name};
    const char *path = fl_in_name(b->in);
    int rc = -1;
    outside(&r);
    if (fl_elements_start(&r.e, path, err) || fl_elements_start(&r.defs, path, err) ||
        fl_roster_place(&r.roster, (fl_place){-1, 0, -1, 0, 0}, err) < 0)
        goto done;
    fl_deck_start(&r.at.deck, &r.e, b);
    if (read_keywords(&r, err) || place_rest(&r, err)) goto done;
    fl_elements_free(&r.defs); /* a large deck is not wanted three times over */
    free(b->data);
    b->data = NULL;
    b->n = b->cap = 0;
    if (give_radii(&r, err) || fl_roster_tell(&r.roster, &r.e, w, err)) goto done;
    rc = fl_elements_surface(&r.e, s, b, w, err);
done:
    end(&r);
    return rc;
}
