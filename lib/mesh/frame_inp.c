/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/frame_inp.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"

static void upper_case(char *to, size_t size, const char *from)
{
    size_t n = 0;
    for (; from[n] && n + 1 < size; n++) to[n] = (char)toupper((unsigned char)from[n]);
    to[n] = '\0';
}

static int32_t nset_of(fl_frame_inp *f, const char *name, fl_err *err)
{
    char word[FL_SET_NAME_MAX];
    upper_case(word, sizeof word, name);
    return fl_string_table_add(&f->nset, word, err);
}

/* --- sections and materials -------------------------------------------------------------------- */

static int read_numbers(fl_inp_model *r, int n, double *x, fl_err *err)
{
    for (int k = 0; k < n; k++)
        if (fl_inp_real(&r->line, k, &x[k], err)) return -1;
    return 0;
}

/* The profile from its name and dimensions; FL_FRAME_NONE where it is not known. */
static fl_frame_section profile_of(const char *kind, const double *x)
{
    fl_frame_section s = {.material = -1};
    if (strcasecmp(kind, "CIRC") == 0) return fl_frame_section_rod(x[0]);
    if (strcasecmp(kind, "PIPE") == 0 || strcasecmp(kind, "THICKPIPE") == 0)
        s = (fl_frame_section){.form = FL_FRAME_PIPE, .material = -1, .size = {2.0 * x[0], x[1]}};
    else if (strcasecmp(kind, "RECT") == 0) /* a along n1, which is y here */
        s = (fl_frame_section){.form = FL_FRAME_RECTANGLE, .material = -1, .size = {x[0], x[1]}};
    else if (strcasecmp(kind, "BOX") == 0 && x[2] == x[4] && x[3] == x[5]) { /* a along n1: turned round */
        s = fl_frame_section_box(x[1], x[0], x[2], x[3]);
    } else if (strcasecmp(kind, "I") == 0) { /* h along n2, which is z here */
        s = fl_frame_section_i(x[1], x[2], x[3], x[6], x[4], x[5]);
        const double keep = s.iy;
        s.iy = s.iz;
        s.iz = keep;
    }
    return s;
}

static int read_section(fl_inp_model *r, fl_err *err)
{
    fl_frame_inp *f = r->frame;
    const int solid = strcmp(r->line.word, "SOLIDSECTION") == 0,
              general = strcmp(r->line.word, "BEAMGENERALSECTION") == 0;
    const char *set = fl_inp_required(&r->line, "ELSET", err), *kind = fl_inp_param(&r->line, "SECTION"),
               *material = fl_inp_param(&r->line, "MATERIAL"), *density = fl_inp_param(&r->line, "DENSITY");
    char name[FL_SET_NAME_MAX + 40], profile[24];
    double x[7] = {0};
    if (!set) return -1;
    if (fl_grow(&f->section, &f->section_cap, (int64_t)f->sections + 1, sizeof *f->section, err)) return -1;
    fl_frame_inp_section *s = &f->section[f->sections];
    *s = (fl_frame_inp_section){.scope = r->scope, .truss = solid};
    snprintf(profile, sizeof profile, "%s", kind ? kind : "GENERAL");
    snprintf(name, sizeof name, "%d.%s", (int)f->sections, set);
    s->section = fl_frame_section_of(f->model, name, err);
    s->set = fl_string_table_add(&r->sets.words, set, err);
    fl_frame_section made = {.material = -1};
    fl_frame_material own = {0};
    if (s->section < 0 || s->set < 0) return -1;
    if (material && (made.material = fl_frame_material_of(f->model, material, err)) < 0) return -1;
    if (density && fl_deck_real(density, &own.rho)) own.rho = 0.0;
    const int32_t its = made.material;
    int more = fl_inp_next_data(&r->line, err);
    if (more > 0 && read_numbers(r, 7, x, err)) return -1;
    if (more < 0) return -1;
    if (solid) {
        made.form = x[0] > 0.0 ? FL_FRAME_GENERAL : FL_FRAME_NONE;
        made.a = x[0];
    } else if (general && strcasecmp(profile, "GENERAL") == 0) {
        made = (fl_frame_section){.form = FL_FRAME_GENERAL, .a = x[0], .iy = x[1], .iz = x[3], .j = x[4]};
        if (x[2] != 0.0 && fl_frame_count_skipped(f->model, "*BEAM GENERAL SECTION: I12")) return -1;
    } else {
        made = profile_of(profile, x);
        if (made.form == FL_FRAME_NONE &&
            fl_frame_count_skipped(f->model, "*%s, SECTION=%s: its elements have no section",
                                   general ? "BEAM GENERAL SECTION" : "BEAM SECTION", profile))
            return -1;
    }
    made.material = its;
    if (more > 0 && !solid) {
        more = fl_inp_next_data(&r->line, err);
        if (more > 0 && fl_inp_point(&r->line, 0, &s->n1, err)) return -1;
        s->has_n1 = more > 0 && v3_nonzero(s->n1);
        if (more > 0 && general) {
            more = fl_inp_next_data(&r->line, err);
            if (more > 0 && (fl_inp_real(&r->line, 0, &own.e, err) || fl_inp_real(&r->line, 1, &own.g, err)))
                return -1;
        }
    }
    if (more < 0) return -1;
    if (own.e > 0.0) { /* a material of its own */
        if ((made.material = fl_frame_material_of(f->model, name, err)) < 0) return -1;
        f->model->material[made.material] = own;
    }
    f->model->section[s->section] = made;
    f->sections++;
    return fl_inp_skip_data(r, err);
}

static int read_material(fl_inp_model *r, fl_err *err)
{
    const char *name = fl_inp_required(&r->line, "NAME", err);
    if (!name) return -1;
    r->frame->material = fl_frame_material_of(r->frame->model, name, err) + 1;
    return r->frame->material < 1 ? -1 : fl_inp_skip_data(r, err);
}

static int read_constants(fl_inp_model *r, fl_err *err)
{
    fl_frame_inp *f = r->frame;
    const int elastic = strcmp(r->line.word, "ELASTIC") == 0;
    if (elastic && fl_inp_param(&r->line, "TYPE") && !fl_inp_param_is(&r->line, "TYPE", "ISOTROPIC") &&
        fl_frame_count_skipped(f->model, "*ELASTIC that is not isotropic"))
        return -1;
    const int more = fl_inp_next_data(&r->line, err);
    if (more > 0 && f->material > 0) {
        fl_frame_material *m = &f->model->material[f->material - 1];
        if (elastic ? fl_inp_real(&r->line, 0, &m->e, err) || fl_inp_real(&r->line, 1, &m->nu, err)
                    : fl_inp_real(&r->line, 0, &m->rho, err))
            return -1;
    }
    return more < 0 ? -1 : fl_inp_skip_data(r, err);
}

/* --- nodes ------------------------------------------------------------------------------------- */

/* Scope in which numbers of the current keyword are looked up. */
static int32_t scope_of(const fl_inp_model *r)
{
    const char *name = fl_inp_param(&r->line, "INSTANCE");
    const int32_t at = name && r->sets.instances > 1 ? fl_element_sets_find_instance(&r->sets, name) : -1;
    return at >= 0 ? r->sets.instance[at].scope : r->scope;
}

static int add_nodes(fl_frame_inp *f, fl_frame_inp_nodes n, fl_err *err)
{
    if (fl_grow(&f->nodes, &f->nodes_cap, (int64_t)f->entries + 1, sizeof *f->nodes, err)) return -1;
    f->nodes[f->entries++] = n;
    return 0;
}

static int read_nset(fl_inp_model *r, fl_err *err)
{
    fl_frame_inp *f = r->frame;
    const char *name = fl_inp_required(&r->line, "NSET", err);
    const int generate = fl_inp_param(&r->line, "GENERATE") != NULL;
    const int32_t scope = scope_of(r);
    int more;
    if (!name) return -1;
    const int32_t set = nset_of(f, name, err);
    if (set < 0) return -1;
    while ((more = fl_inp_next_data(&r->line, err)) > 0) {
        fl_frame_inp_nodes n = {.set = set, .scope = scope, .step = 1};
        if (generate) {
            if (fl_inp_id(&r->line, 0, &n.first, err) || fl_inp_integer(&r->line, 1, n.first, &n.last, err) ||
                fl_inp_integer(&r->line, 2, 1, &n.step, err) || add_nodes(f, n, err))
                return -1;
            continue;
        }
        for (int k = 0; k < r->line.fields; k++) {
            const char *word = r->line.field[k];
            if (*word == '\0') continue;
            if (fl_deck_integer(word, &n.first)) { /* another set: -1 - its number */
                const int32_t other = nset_of(f, word, err);
                if (other < 0) return -1;
                n.first = -1 - (int64_t)other;
            }
            n.last = n.first;
            if (add_nodes(f, n, err)) return -1;
        }
    }
    return more;
}

/* The node or set that a data line begins with; "instance.12" too. */
static int read_target(fl_inp_model *r, fl_frame_inp_support *s, fl_err *err)
{
    const char *word = r->line.field[0], *dot = strrchr(word, '.');
    char instance[FL_SET_NAME_MAX];
    s->scope = r->scope;
    s->set = -1;
    if (fl_deck_integer(word, &s->node) == 0) return 0;
    if (dot) {
        snprintf(instance, sizeof instance, "%.*s", (int)(dot - word), word);
        const int32_t at = fl_element_sets_find_instance(&r->sets, instance);
        if (at >= 0 && fl_deck_integer(dot + 1, &s->node) == 0) {
            s->scope = r->sets.instance[at].scope;
            return 0;
        }
        if (at >= 0) word = dot + 1;
    }
    s->set = nset_of(r->frame, word, err);
    return s->set < 0 ? -1 : 0;
}

static int add_support(fl_frame_inp *f, const fl_frame_inp_support *s, fl_err *err)
{
    if (fl_grow(&f->support, &f->support_cap, (int64_t)f->supports + 1, sizeof *f->support, err)) return -1;
    f->support[f->supports++] = *s;
    return 0;
}

static int read_boundary(fl_inp_model *r, fl_err *err)
{
    static const struct {
        const char *name;
        int bits;
    } named[] = {{"ENCASTRE", 63},
                 {"PINNED", 7},
                 {"XSYMM", 1 | 16 | 32},
                 {"YSYMM", 2 | 8 | 32},
                 {"ZSYMM", 4 | 8 | 16}};
    int more;
    while ((more = fl_inp_next_data(&r->line, err)) > 0) {
        fl_frame_inp_support s = {0};
        int64_t first = 0, last = 0;
        double moved = 0.0;
        if (read_target(r, &s, err)) return -1;
        const char *word = r->line.fields > 1 ? r->line.field[1] : "";
        for (size_t k = 0; k < sizeof named / sizeof *named; k++)
            if (strcasecmp(word, named[k].name) == 0) s.bits = named[k].bits;
        if (!s.bits) {
            if (fl_inp_integer(&r->line, 1, 0, &first, err) ||
                fl_inp_integer(&r->line, 2, first, &last, err) ||
                (r->line.fields > 3 && fl_inp_real(&r->line, 3, &moved, err)))
                return -1;
            for (int64_t d = first; d <= last && d <= 6; d++)
                if (d >= 1) s.bits |= 1 << (d - 1);
            if (moved != 0.0 &&
                fl_frame_count_skipped(r->frame->model,
                                       "*BOUNDARY: enforced displacements; the freedom is held"))
                return -1;
        }
        if (s.bits && add_support(r->frame, &s, err)) return -1;
    }
    return more;
}

static int read_cload(fl_inp_model *r, fl_err *err)
{
    int more;
    while ((more = fl_inp_next_data(&r->line, err)) > 0) {
        fl_frame_inp_support s = {0};
        int64_t d;
        double x;
        if (read_target(r, &s, err) || fl_inp_integer(&r->line, 1, 0, &d, err) ||
            fl_inp_real(&r->line, 2, &x, err))
            return -1;
        double *const to[] = {&s.force.x, &s.force.y, &s.force.z, &s.moment.x, &s.moment.y, &s.moment.z};
        if (d < 1 || d > 6) continue;
        *to[d - 1] = x;
        if (add_support(r->frame, &s, err)) return -1;
    }
    return more;
}

/* element or set, S1 or S2, then M1, M2, T, as M1-M2, or ALLM. */
static int read_release(fl_inp_model *r, fl_err *err)
{
    fl_frame_inp *f = r->frame;
    int more;
    while ((more = fl_inp_next_data(&r->line, err)) > 0) {
        fl_frame_inp_release e = {.set = -1, .scope = r->scope};
        char word[40];
        if (r->line.fields < 3) continue;
        if (fl_deck_integer(r->line.field[0], &e.element) &&
            (e.set = fl_string_table_add(&r->sets.words, r->line.field[0], err)) < 0)
            return -1;
        e.end = strcasecmp(r->line.field[1], "S2") == 0;
        upper_case(word, sizeof word, r->line.field[2]);
        if (strcmp(word, "ALLM") == 0) e.pins = 7;
        if (strstr(word, "M1")) e.pins |= 2;
        if (strstr(word, "M2")) e.pins |= 4;
        if (strchr(word, 'T')) e.pins |= 1;
        if (fl_grow(&f->release, &f->release_cap, (int64_t)f->releases + 1, sizeof *f->release, err))
            return -1;
        f->release[f->releases++] = e;
    }
    return more;
}

/* --- keywords ---------------------------------------------------------------------------------- */

static const struct {
    const char *word;
    int (*read)(fl_inp_model *r, fl_err *err);
} KEYWORD[] = {
    {"BEAMSECTION", read_section}, {"BEAMGENERALSECTION", read_section}, {"SOLIDSECTION", read_section},
    {"MATERIAL", read_material},   {"ELASTIC", read_constants},          {"DENSITY", read_constants},
    {"NSET", read_nset},           {"BOUNDARY", read_boundary},          {"CLOAD", read_cload},
    {"RELEASE", read_release}};

int fl_frame_inp_keyword(fl_inp_model *r, fl_err *err)
{
    for (size_t k = 0; k < sizeof KEYWORD / sizeof *KEYWORD; k++)
        if (strcmp(r->line.word, KEYWORD[k].word) == 0) return KEYWORD[k].read(r, err) ? -1 : 1;
    /* nodes and elements may name sets of nodes */
    if (strcmp(r->line.word, "NODE") == 0 && fl_inp_param(&r->line, "NSET") &&
        fl_frame_count_skipped(r->frame->model, "*NODE, NSET=: its set has no nodes here; write *NSET"))
        return -1;
    return 0;
}

int fl_frame_inp_count_skipped(fl_inp_model *r)
{
    static const char *const no[] = {"HEADING",    "PREPRINT",      "STEP",      "ENDSTEP",
                                     "STATIC",     "OUTPUT",        "NODEPRINT", "NODEFILE",
                                     "ELPRINT",    "ELFILE",        "RESTART",   "ENDASSEMBLY",
                                     "NODEOUTPUT", "ELEMENTOUTPUT", "FREQUENCY", "PHYSICALCONSTANTS"};
    for (size_t k = 0; k < sizeof no / sizeof *no; k++)
        if (strcmp(r->line.word, no[k]) == 0) return 0;
    return fl_frame_count_skipped(r->frame->model, "*%s", r->line.word);
}

/* --- the end ----------------------------------------------------------------------------------- */

/* Frame node of node k of the mesh. */
static int32_t node_of(fl_inp_model *r, int32_t k, fl_err *err)
{
    fl_frame_model *f = r->frame->model;
    const int32_t at = fl_frame_node_of(f, r->e.node_id.scope[k], r->e.node_id.id[k], err);
    if (at >= 0) {
        f->node[at].x = r->e.x[k];
        f->node[at].defined = r->e.x[k].x == r->e.x[k].x;
    }
    return at;
}

typedef struct {
    fl_inp_model *r;
    const fl_frame_inp_section *section;
    int end;
    unsigned pins;
} visit_context;

static int set_section(void *context, fl_pick pick, fl_err *err)
{
    const visit_context *v = context;
    fl_inp_model *r = v->r;
    const fl_element *el = &r->e.element[pick.element];
    fl_frame_model *f = r->frame->model;
    if (el->shape != FL_LINE2 && el->shape != FL_LINE3) return 0;
    const int32_t k =
        fl_frame_element_of(f, r->e.element_id.scope[pick.element], r->e.element_id.id[pick.element], err);
    if (k < 0) return -1;
    fl_frame_element *e = &f->element[k];
    e->section = v->section->section;
    e->truss = v->section->truss;
    e->has_y = v->section->has_n1 || !v->section->truss;
    e->across = v->section->has_n1 ? v->section->n1 : v3(0, 0, -1);
    return 0;
}

static int set_pins(void *context, fl_pick pick, fl_err *err)
{
    const visit_context *v = context;
    fl_frame_model *f = v->r->frame->model;
    (void)err;
    const int32_t k = fl_id_map_find(&f->element_id, v->r->e.element_id.scope[pick.element],
                                     v->r->e.element_id.id[pick.element]);
    if (k >= 0) f->element[k].pins[v->end] |= v->pins;
    return 0;
}

/* Calls each() for the elements of a set in all instances where its scope is seen. */
static int visit_set(fl_inp_model *r, int32_t word, int32_t scope, fl_element_visitor *each, visit_context *c,
                     fl_err *err)
{
    for (int32_t p = 0; p < r->sets.instances; p++) {
        int32_t at = p;
        if (r->sets.instance[p].scope != scope && r->sets.instance[p].part_scope != scope) continue;
        const int32_t set = fl_element_sets_find(&r->sets, FL_SET_ELEMENTS, &at, r->sets.words.name[word]);
        if (set >= 0 && fl_element_sets_visit(&r->sets, &r->e, set, at, each, c, err)) return -1;
    }
    return 0;
}

static int add_lines(fl_inp_model *r, fl_err *err)
{
    fl_frame_model *f = r->frame->model;
    for (int32_t k = 0; k < r->e.element_id.n; k++) {
        const fl_element *el = &r->e.element[k];
        if (el->shape != FL_LINE2 && el->shape != FL_LINE3) {
            if (fl_frame_count_skipped(f, "shells and solids")) return -1;
            continue;
        }
        const int32_t at = fl_frame_element_of(f, r->e.element_id.scope[k], r->e.element_id.id[k], err);
        if (at < 0) return -1;
        for (int s = 0; s < 2; s++)
            if ((f->element[at].node[s] = node_of(r, r->e.connectivity[el->first + s], err)) < 0) return -1;
        const char *part = el->part >= 0 ? r->e.parts.name[el->part] : "";
        if ((f->element[at].part = fl_frame_part_of(f, *part ? part : "members", err)) < 0) return -1;
        if (el->shape == FL_LINE3 && fl_frame_count_skipped(f, "middle nodes of beams of three nodes"))
            return -1;
    }
    return 0;
}

/* Applies a support or load to one node, in each instance where its scope is seen. */
static int load_node(fl_inp_model *r, const fl_frame_inp_support *s, int32_t scope, int64_t id)
{
    fl_frame_model *f = r->frame->model;
    for (int32_t p = 0; p < r->sets.instances; p++) {
        if (r->sets.instance[p].scope != scope && r->sets.instance[p].part_scope != scope) continue;
        const int32_t k = fl_id_map_find(&f->node_id, r->sets.instance[p].scope, id);
        if (k < 0) continue;
        f->node[k].fixed |= s->bits;
        f->node[k].force = v3_add(f->node[k].force, s->force);
        f->node[k].moment = v3_add(f->node[k].moment, s->moment);
    }
    return 0;
}

static int load_set(fl_inp_model *r, const fl_frame_inp_support *s, int32_t set, int depth, fl_err *err)
{
    const fl_frame_inp *f = r->frame;
    enum { DEEPEST = 20, MOST = 10000000 };
    if (depth > DEEPEST)
        return fl_inp_fail(&r->line, err,
                           "sets of nodes contain one another more than 20 deep: ", f->nset.name[set]);
    for (int32_t k = 0; k < f->entries; k++) {
        const fl_frame_inp_nodes *n = &f->nodes[k];
        if (n->set != set) continue;
        if (n->first < 0) {
            if (load_set(r, s, (int32_t)(-1 - n->first), depth + 1, err)) return -1;
            continue;
        }
        if (n->step < 1 || (n->last - n->first) / n->step > MOST) continue;
        for (int64_t id = n->first; id <= n->last; id += n->step) load_node(r, s, n->scope, id);
    }
    return 0;
}

int fl_frame_inp_finish(fl_inp_model *r, fl_err *err)
{
    fl_frame_inp *f = r->frame;
    if (add_lines(r, err)) return -1;
    for (int32_t k = 0; k < f->sections; k++) {
        visit_context c = {.r = r, .section = &f->section[k]};
        if (visit_set(r, f->section[k].set, f->section[k].scope, set_section, &c, err)) return -1;
    }
    for (int32_t k = 0; k < f->releases; k++) {
        const fl_frame_inp_release *e = &f->release[k];
        visit_context c = {.r = r, .end = e->end, .pins = e->pins};
        const int32_t at = e->set < 0 ? fl_id_map_find(&f->model->element_id, e->scope, e->element) : -1;
        if (at >= 0) f->model->element[at].pins[e->end] |= e->pins;
        if (e->set >= 0 && visit_set(r, e->set, e->scope, set_pins, &c, err)) return -1;
    }
    for (int32_t k = 0; k < f->supports; k++) {
        const fl_frame_inp_support *s = &f->support[k];
        if (s->set < 0 ? load_node(r, s, s->scope, s->node) : load_set(r, s, s->set, 0, err)) return -1;
    }
    for (int32_t k = 0; k < r->e.skipped.n; k++)
        for (int32_t c = 0; c < r->e.skip_count[k]; c++)
            if (fl_frame_count_skipped(f->model, "elements %s", r->e.skipped.name[k])) return -1;
    return 0;
}

void fl_frame_inp_free(fl_frame_inp *f)
{
    fl_string_table_free(&f->nset);
    free(f->section), free(f->nodes), free(f->support), free(f->release);
}
