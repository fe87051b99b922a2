/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_sesam.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/decimal.h"
#include "mesh/beam_deck.h"
#include "mesh/sesam_element.h"

enum { COLUMN = 16, NAME_COLUMNS = 8 };

/* What GELREF1 says of an element. */
typedef struct {
    int64_t material, section, hinge, offset, axis; /* -1: a list */
    int32_t list, lists;                            /* in the pool of numbers */
    int known;
} sesam_reference;

typedef struct {
    fl_beam_deck k;
    char name[NAME_COLUMNS + 1]; /* of the current record */
    double *x;                   /* [n] its numbers */
    int32_t n, x_cap, line;
    fl_id_map section_id, offset_id, axis_id, material_id, hinge_id, member_id, set_id, concept_id, mesh_id;
    fl_vec3 *offset, *axis;
    fl_frame_material *material;
    unsigned *hinge;            /* [hinge_id.n] released rotations, -1u: a release of another kind */
    sesam_reference *reference; /* [member_id.n] by internal number */
    int32_t *set, *concept_set, *mesh_concept;
    int64_t *pool;
    int32_t *ready; /* [ready_id.n] sections made of a pair of geometry and material */
    fl_id_map ready_id;
    int32_t offset_cap, axis_cap, material_cap, hinge_cap, reference_cap, set_cap, concept_cap, mesh_cap,
        pool_cap, pooled, ready_cap;
    int32_t superelements, superelement_line, elements;
} sesam_reader;

/* --- records -------------------------------------------------------------------------------------------- */

/* Column k of a line as a number: 1, 0 if it is blank or beyond the line, -1. */
static int column_number(char *line, int32_t len, int k, double *x)
{
    char text[COLUMN + 1];
    const int32_t from = NAME_COLUMNS + COLUMN * k, n = len - from < COLUMN ? len - from : COLUMN;
    if (n <= 0) return 0;
    memcpy(text, line + from, (size_t)n);
    text[n] = '\0';
    const char *trimmed = fl_deck_trim(text), *end;
    if (!*trimmed) return 0;
    end = fl_decimal_read(trimmed, x);
    if (end && !*end && isfinite(*x)) return 1;
    return fl_deck_real(trimmed, x) ? -1 : 1;
}

int fl_sesam_is(const fl_bytes *b)
{
    static const char *const NAME[] = {"GNODE   ", "GCOORD  ", "GELMNT1 ", "GELMNT2 "};
    for (char *p = b->data; *p; p += strcspn(p, "\n"), p += *p == '\n')
        for (int k = 0; *p == 'G' && k < 4; k++) {
            double x;
            if (strncmp(p, NAME[k], NAME_COLUMNS) == 0 &&
                column_number(p, (int32_t)strcspn(p, "\r\n"), 0, &x) == 1)
                return 1;
        }
    return 0;
}

static int keep_columns(sesam_reader *r, fl_err *err)
{
    for (int k = 0; k < 4; k++) {
        double x = 0.0;
        if (NAME_COLUMNS + COLUMN * k >= r->k.d.len) return 0;
        if (column_number(r->k.d.line, r->k.d.len, k, &x) < 0)
            return fl_deck_fail(&r->k.d, err, "columns %d to %d of %s are no number",
                                NAME_COLUMNS + COLUMN * k + 1, NAME_COLUMNS + COLUMN * (k + 1), r->name);
        if (fl_grow(&r->x, &r->x_cap, (int64_t)r->n + 1, sizeof *r->x, err)) return -1;
        r->x[r->n++] = x;
    }
    return 0;
}

/* Same; a record that is not read may hold text, and loses its numbers. */
static int keep_readable(sesam_reader *r, fl_err *err)
{
    if (keep_columns(r, err) == 0) return 0;
    if (strchr("GMT", r->name[0]) || err->code == FL_SYSTEM) return -1;
    *err = (fl_err){0};
    r->n = 0;
    return 0;
}

static int is_blank_name(const fl_deck *d)
{
    for (int k = 0; k < NAME_COLUMNS; k++) {
        if (k >= d->len) return d->len > 0;
        if (!fl_bytes_blank(d->line[k])) return 0;
    }
    return 1;
}

static double field(const sesam_reader *r, int32_t k) { return k < r->n ? r->x[k] : 0.0; }

static int64_t whole(const sesam_reader *r, int32_t k)
{
    const double x = field(r, k);
    return x > -9e15 && x < 9e15 ? (int64_t)x : 0;
}

/* Reads text lines of a record; the first is kept in text, trimmed to `columns` characters. */
static int read_text(sesam_reader *r, int64_t lines, int64_t columns, char text[FL_BEAM_NAME], fl_err *err)
{
    for (int64_t k = 0; k < lines; k++) {
        const int more = fl_deck_line(&r->k.d, err);
        if (more <= 0) return more;
        if (k > 0 || !text || r->k.d.len <= NAME_COLUMNS) continue;
        int32_t n = r->k.d.len - NAME_COLUMNS;
        if (columns > 0 && n > columns) n = (int32_t)columns;
        if (n >= FL_BEAM_NAME) n = FL_BEAM_NAME - 1;
        memcpy(text, r->k.d.line + NAME_COLUMNS, (size_t)n);
        text[n] = '\0';
        memmove(text, fl_deck_trim(text), strlen(fl_deck_trim(text)) + 1);
    }
    return 1;
}

/* Reads a record with its further lines: 1, 0 at the end, -1.  text: of a TD record. */
static int next_sesam(sesam_reader *r, char text[FL_BEAM_NAME], fl_err *err)
{
    int more;
    text[0] = '\0';
    r->n = 0;
    do {
        if ((more = fl_deck_line(&r->k.d, err)) <= 0) return more;
    } while (is_blank_name(&r->k.d) || r->k.d.len == 0);
    r->line = r->k.e.line;
    snprintf(r->name, sizeof r->name, "%.8s", r->k.d.line);
    memmove(r->name, fl_deck_trim(r->name), strlen(fl_deck_trim(r->name)) + 1);
    const int titled = strncmp(r->name, "TD", 2) == 0;
    const int dated = strcmp(r->name, "DATE") == 0 || strcmp(r->name, "TEXT") == 0;
    const int known = titled || dated || strchr("GBMSU", r->name[0]) != NULL;
    if (!known) return 1;
    if (keep_readable(r, err)) return -1;
    if (dated) return read_text(r, whole(r, 2), 0, NULL, err) < 0 ? -1 : 1;
    if (titled) {
        const int64_t name = whole(r, 2), words = whole(r, 3);
        if (read_text(r, name / 100, name % 100, text, err) < 0) return -1;
        return read_text(r, words / 100, 0, NULL, err) < 0 ? -1 : 1;
    }
    while ((more = fl_deck_line(&r->k.d, err)) > 0) {
        if (!is_blank_name(&r->k.d)) {
            fl_deck_unread(&r->k.d);
            break;
        }
        if (keep_readable(r, err)) return -1;
    }
    r->k.e.line = r->line;
    return more < 0 ? -1 : 1;
}

/* --- elements ------------------------------------------------------------------------------------------- */

/* Part of plates or solids of no set. */
static int32_t shape_part(sesam_reader *r, enum fl_shape shape, fl_err *err)
{
    return fl_string_table_add(&r->k.e.parts, fl_shape_faces(shape) ? "solids" : "plates", err);
}

static int sesam_element(sesam_reader *r, fl_err *err)
{
    const fl_sesam_type *t = fl_sesam_type_of((int)whole(r, 2));
    int64_t node[FL_SESAM_NODES];
    char kind[40];
    r->elements++;
    if (!t) {
        snprintf(kind, sizeof kind, "type %d", (int)whole(r, 2));
        return fl_beam_deck_skip(&r->k, kind, err);
    }
    if (whole(r, 1) < 1)
        return fl_deck_fail(&r->k.d, err, "element %lld of GELMNT1 has no internal number",
                            (long long)whole(r, 0));
    for (int k = 0; k < fl_shape_nodes(t->shape); k++) node[k] = whole(r, 4 + t->order[k]);
    if (fl_shape_corners(t->shape) > 2) {
        const int32_t part = shape_part(r, t->shape, err);
        return part < 0 || fl_elements_add(&r->k.e, 0, whole(r, 1), t->shape, part, node, err) < 0 ? -1 : 0;
    }
    fl_beam b = {.id = whole(r, 1), .part = -1, .truss = t->truss};
    for (int k = 0; k < fl_shape_nodes(t->shape); k++) b.node[k] = node[k];
    if (b.node[0] < 1 || b.node[1] < 1)
        return fl_deck_fail(&r->k.d, err, "element %lld of GELMNT1 has fewer than two nodes",
                            (long long)whole(r, 0));
    return fl_beam_deck_add(&r->k, &b, err) < 0 ? -1 : 0;
}

static int sesam_reference_row(sesam_reader *r, fl_err *err)
{
    const int32_t at = fl_id_map_add(&r->member_id, 0, whole(r, 0), err);
    if (at < 0 || fl_grow(&r->reference, &r->reference_cap, (int64_t)at + 1, sizeof *r->reference, err))
        return -1;
    sesam_reference *f = &r->reference[at];
    *f = (sesam_reference){whole(r, 1),
                           whole(r, 8),
                           whole(r, 9),
                           whole(r, 10),
                           whole(r, 11),
                           r->pooled,
                           r->n > 12 ? r->n - 12 : 0,
                           1};
    if (f->section != -1 && f->hinge != -1 && f->offset != -1 && f->axis != -1) f->lists = 0;
    for (int32_t k = 0; k < f->lists; k++) {
        if (fl_grow(&r->pool, &r->pool_cap, (int64_t)r->pooled + 1, sizeof *r->pool, err)) return -1;
        r->pool[r->pooled++] = whole(r, 12 + k);
    }
    return 0;
}

/* A number for each node, or one for all: the value at node k of n.  Lists stand in the order section, hinge,
 * offset, axis; only those that are -1. */
static int64_t listed_value(const sesam_reader *r, const sesam_reference *f, int which, int k, int n)
{
    const int64_t given[4] = {f->section, f->hinge, f->offset, f->axis};
    int lists = 0, before = 0;
    if (given[which] != -1) return given[which] > 0 ? given[which] : 0;
    for (int i = 0; i < 4; i++) {
        lists += given[i] == -1;
        before += i < which && given[i] == -1;
    }
    const int32_t each = f->lists >= lists * n ? n : f->lists / lists;
    if (k >= each) return 0;
    const int64_t v = r->pool[f->list + before * each + k];
    return v > 0 ? v : 0;
}

/* --- sections ------------------------------------------------------------------------------------------- */

/* Index of section GEONO in k.section, added if new; -1. */
static int32_t geometry_of(sesam_reader *r, int64_t id, fl_err *err)
{
    const int32_t had = r->section_id.n, at = fl_id_map_add(&r->section_id, 0, id, err);
    fl_beam_section s = {.form = FL_FRAME_NONE, .kind = "section without a form"};
    if (at < 0 || at < had) return at;
    snprintf(s.name, sizeof s.name, "g%lld", (long long)id);
    return fl_beam_deck_section(&r->k, &s, err) < 0 ? -1 : at;
}

static int sesam_pipe(sesam_reader *r, fl_err *err)
{
    const int32_t at = geometry_of(r, whole(r, 0), err);
    if (at < 0) return -1;
    fl_beam_section *s = &r->k.section[at];
    const double inner = field(r, 1), outer = field(r, 2), wall = field(r, 3);
    s->form = FL_FRAME_PIPE;
    s->size[0] = outer > 0.0 ? outer : outer < 0.0 ? outer : inner + 2.0 * wall;
    s->wall[0] = wall > 0.0 ? wall : 0.5 * (s->size[0] - inner);
    if (s->size[0] > 0.0) return 0;
    return fl_deck_fail(&r->k.d, err, "GPIPE %lld has the diameter %g, a length above 0 is expected",
                        (long long)whole(r, 0), s->size[0]);
}

static int sesam_box(sesam_reader *r, fl_err *err)
{
    const int hollow = strcmp(r->name, "GBOX") == 0;
    const int32_t at = geometry_of(r, whole(r, 0), err);
    if (at < 0) return -1;
    fl_beam_section *s = &r->k.section[at];
    s->form = FL_FRAME_RECTANGLE;
    s->size[1] = field(r, 1);
    s->size[0] = hollow ? field(r, 5) : fmax(field(r, 2), field(r, 3));
    s->wall[0] = hollow ? field(r, 2) : 0.0;
    s->wall[1] = hollow ? 0.5 * (field(r, 3) + field(r, 4)) : 0.0;
    if (s->size[0] > 0.0 && s->size[1] > 0.0) return 0;
    return fl_deck_fail(&r->k.d, err, "%s %lld has the sides %g and %g, lengths above 0 are expected",
                        r->name, (long long)whole(r, 0), s->size[0], s->size[1]);
}

/* GBEAMG GEONO, void, area, Ix, Iy, Iz, ...: constants, which stand beside every section. */
static int sesam_constants(sesam_reader *r, fl_err *err)
{
    const int32_t at = geometry_of(r, whole(r, 0), err);
    if (at < 0) return -1;
    fl_beam_section *s = &r->k.section[at];
    s->a = field(r, 2), s->j = field(r, 3), s->iy = field(r, 4), s->iz = field(r, 5);
    if (s->form == FL_FRAME_NONE) {
        s->form = FL_FRAME_GENERAL;
        if (strncmp(s->kind, "section", 7) == 0) snprintf(s->kind, sizeof s->kind, "GBEAMG");
    }
    return 0;
}

static int sesam_profile(sesam_reader *r, fl_err *err)
{
    const int32_t at = geometry_of(r, whole(r, 0), err);
    if (at < 0) return -1;
    snprintf(r->k.section[at].kind, FL_BEAM_NAME, "%s", r->name);
    return 0;
}

/* --- tables --------------------------------------------------------------------------------------------- */

static int sesam_vector(sesam_reader *r, fl_id_map *ids, fl_vec3 **list, int32_t *cap, fl_err *err)
{
    const int32_t at = fl_id_map_add(ids, 0, whole(r, 0), err);
    if (at < 0 || fl_grow(list, cap, (int64_t)at + 1, sizeof **list, err)) return -1;
    (*list)[at] = v3(field(r, 1), field(r, 2), field(r, 3));
    return 0;
}

static int sesam_material(sesam_reader *r, fl_err *err)
{
    const int32_t at = fl_id_map_add(&r->material_id, 0, whole(r, 0), err);
    if (at < 0 || fl_grow(&r->material, &r->material_cap, (int64_t)at + 1, sizeof *r->material, err))
        return -1;
    r->material[at] = (fl_frame_material){.e = field(r, 1), .nu = field(r, 2), .rho = field(r, 3)};
    return 0;
}

static int sesam_support(sesam_reader *r, fl_err *err)
{
    int fixed = 0;
    for (int k = 0; k < 6; k++) fixed |= (field(r, 2 + k) == 1.0) << k;
    return whole(r, 0) < 1 ? 0 : fl_beam_deck_hold(&r->k, whole(r, 0), fixed, err);
}

/* BELFIX FIXNO, OPT, TRANO, void, A1 .. A6: 0 releases, 1 transmits. */
static int sesam_hinge(sesam_reader *r, fl_err *err)
{
    const int32_t at = fl_id_map_add(&r->hinge_id, 0, whole(r, 0), err);
    if (at < 0 || fl_grow(&r->hinge, &r->hinge_cap, (int64_t)at + 1, sizeof *r->hinge, err)) return -1;
    r->hinge[at] = 0;
    for (int k = 0; k < 3; k++) r->hinge[at] |= (unsigned)(field(r, 7 + k) == 0.0) << k;
    for (int k = 0; k < 3; k++)
        if (field(r, 4 + k) == 0.0) r->hinge[at] = ~0u;
    return 0;
}

static int sesam_set_name(sesam_reader *r, const char *text, fl_err *err)
{
    const int32_t at = fl_id_map_add(&r->set_id, 0, whole(r, 1), err);
    char name[FL_BEAM_NAME];
    if (at < 0 || fl_grow(&r->set, &r->set_cap, (int64_t)at + 1, sizeof *r->set, err)) return -1;
    if (*text) snprintf(name, sizeof name, "%s", text);
    else snprintf(name, sizeof name, "set_%lld", (long long)whole(r, 1));
    r->set[at] = fl_beam_deck_set(&r->k, name, 0, err);
    return r->set[at] < 0 ? -1 : 0;
}

static int sesam_set_members(sesam_reader *r, fl_err *err)
{
    char none[FL_BEAM_NAME] = "";
    int32_t at = fl_id_map_find(&r->set_id, 0, whole(r, 1));
    if (whole(r, 3) != 2) return 0; /* nodes */
    if (at < 0) {
        if (sesam_set_name(r, none, err)) return -1;
        at = fl_id_map_find(&r->set_id, 0, whole(r, 1));
    }
    r->k.set_is_part[r->set[at]] = 1;
    const int64_t n = whole(r, 0) - 5;
    for (int64_t k = 0; k < n && 5 + k < r->n; k++) {
        const int64_t id = whole(r, (int32_t)(5 + k));
        if (id > 0 && fl_beam_deck_set_add(&r->k, r->set[at], id, err)) return -1;
    }
    return 0;
}

/* Numbers of one kind to those of another, by growing arrays. */
static int keep_pair(fl_id_map *ids, int32_t **list, int32_t *cap, int64_t id, int32_t value, fl_err *err)
{
    const int32_t at = fl_id_map_add(ids, 0, id, err);
    if (at < 0 || fl_grow(list, cap, (int64_t)at + 1, sizeof **list, err)) return -1;
    (*list)[at] = value;
    return 0;
}

static int sesam_concept(sesam_reader *r, const char *text, fl_err *err)
{
    const int64_t id = whole(r, 1);
    if (strcmp(r->name, "TDSCONC") == 0) {
        const int32_t set = *text ? fl_beam_deck_set(&r->k, text, 0, err) : -2;
        if (set == -1) return -1;
        return set < 0 ? 0 : keep_pair(&r->concept_id, &r->concept_set, &r->concept_cap, id, set, err);
    }
    if (strcmp(r->name, "SCONCEPT") == 0) {
        const int32_t at = fl_id_map_find(&r->concept_id, 0, whole(r, 4));
        return at < 0 ? 0
                      : keep_pair(&r->mesh_id, &r->mesh_concept, &r->mesh_cap, id, r->concept_set[at], err);
    }
    const int32_t at = fl_id_map_find(&r->mesh_id, 0, id);
    const int64_t n = at < 0 ? 0 : whole(r, 4);
    for (int64_t k = 0; k < n && 5 + k < r->n; k++) {
        const int64_t element = whole(r, (int32_t)(5 + k));
        if (element > 0 && fl_beam_deck_set_add(&r->k, r->mesh_concept[at], element, err)) return -1;
    }
    return 0;
}

/* --- all records ---------------------------------------------------------------------------------------- */

static int is_profile(const char *name)
{
    static const char *const WORD[] = {"GIORH", "GUSYI",  "GCHAN",  "GLSEC", "GTONP",
                                       "GDOBO", "GIORHR", "GCHANR", "GLSECR"};
    for (size_t k = 0; k < sizeof WORD / sizeof *WORD; k++)
        if (strcmp(name, WORD[k]) == 0) return 1;
    return 0;
}

static int sesam_node(sesam_reader *r, fl_err *err)
{
    if (whole(r, 0) < 1) return fl_deck_fail(&r->k.d, err, "GCOORD has no number of a node");
    return fl_elements_add_node(&r->k.e, 0, whole(r, 0), v3(field(r, 1), field(r, 2), field(r, 3)), err) < 0
               ? -1
               : 0;
}

/* Of a frame a record that is not read is counted, but for those that say nothing of the structure. */
static void count_record(sesam_reader *r)
{
    static const char *const SILENT[] = {"IDENT", "DATE",  "TEXT",   "IEND",
                                         "GNODE", "UNITS", "TDSECT", "TDMATER"};
    for (size_t k = 0; k < sizeof SILENT / sizeof *SILENT; k++)
        if (strcmp(r->name, SILENT[k]) == 0) return;
    if (r->k.frame) fl_frame_count_skipped(r->k.frame, "%s", r->name);
}

static int sesam_record(sesam_reader *r, const char *text, fl_err *err)
{
    const char *name = r->name;
    if (strcmp(name, "GCOORD") == 0) return sesam_node(r, err);
    if (strcmp(name, "GELMNT1") == 0) return sesam_element(r, err);
    if (strcmp(name, "GELREF1") == 0) return sesam_reference_row(r, err);
    if (strcmp(name, "GPIPE") == 0) return sesam_pipe(r, err);
    if (strcmp(name, "GBOX") == 0 || strcmp(name, "GBARM") == 0) return sesam_box(r, err);
    if (strcmp(name, "GBEAMG") == 0) return sesam_constants(r, err);
    if (is_profile(name)) return sesam_profile(r, err);
    if (strcmp(name, "GECCEN") == 0) return sesam_vector(r, &r->offset_id, &r->offset, &r->offset_cap, err);
    if (strcmp(name, "GUNIVEC") == 0) return sesam_vector(r, &r->axis_id, &r->axis, &r->axis_cap, err);
    if (strcmp(name, "MISOSEL") == 0) return sesam_material(r, err);
    if (strcmp(name, "BNBCD") == 0) return sesam_support(r, err);
    if (strcmp(name, "BELFIX") == 0) return sesam_hinge(r, err);
    if (strcmp(name, "TDSETNAM") == 0) return sesam_set_name(r, text, err);
    if (strcmp(name, "GSETMEMB") == 0) return sesam_set_members(r, err);
    if (strcmp(name, "TDSCONC") == 0 || strcmp(name, "SCONCEPT") == 0 || strcmp(name, "SCONMESH") == 0)
        return sesam_concept(r, text, err);
    if (strcmp(name, "UNITS") == 0 && field(r, 1) > 0.0 && field(r, 1) != 1.0)
        fl_bytes_note(r->k.b, "UNITS says that a length is %g m: --scale %g", field(r, 1), field(r, 1));
    if (strcmp(name, "GELMNT2") == 0) {
        if (r->superelements++ == 0) r->superelement_line = r->line;
    } else {
        count_record(r);
    }
    return 0;
}

/* The section of GEONO with a material: sections of the same form and of two materials are two. */
static int32_t section_with(sesam_reader *r, int32_t geometry, int64_t material, fl_err *err)
{
    const int32_t m = fl_id_map_find(&r->material_id, 0, material);
    const int32_t had = r->ready_id.n, at = fl_id_map_add(&r->ready_id, geometry, m < 0 ? 0 : material, err);
    if (at < 0 || fl_grow(&r->ready, &r->ready_cap, (int64_t)at + 1, sizeof *r->ready, err)) return -1;
    if (at < had) return r->ready[at];
    fl_beam_section s = r->k.section[geometry];
    if (m >= 0) {
        s.material = r->material[m];
        snprintf(s.name, sizeof s.name, "%.30s_m%lld", r->k.section[geometry].name, (long long)material);
    }
    return r->ready[at] = fl_beam_deck_section(&r->k, &s, err);
}

/* Sections, offsets, hinges and axes of a member, from its GELREF1. */
static int find_reference(sesam_reader *r, int32_t i, fl_err *err)
{
    fl_beam *b = &r->k.beam[i];
    const int32_t at = fl_id_map_find(&r->member_id, 0, b->id);
    const int nodes = b->node[2] > 0 ? 3 : 2, node[2] = {0, nodes - 1};
    if (at < 0)
        return fl_elements_fail(&r->k.e, b->file, b->line, err, "element %lld has no GELREF1",
                                (long long)b->id);
    const sesam_reference *f = &r->reference[at];
    for (int s = 0; s < 2; s++) {
        const int64_t id = listed_value(r, f, 0, node[s], nodes);
        const int32_t g = fl_id_map_find(&r->section_id, 0, id);
        if (g < 0)
            return fl_elements_fail(&r->k.e, b->file, b->line, err,
                                    "element %lld has section %lld, which is not defined", (long long)b->id,
                                    (long long)id);
        if ((b->section[s] = section_with(r, g, f->material, err)) < 0) return -1;
        const int64_t offset = listed_value(r, f, 2, node[s], nodes),
                      hinge = listed_value(r, f, 1, node[s], nodes);
        const int32_t o = fl_id_map_find(&r->offset_id, 0, offset),
                      h = fl_id_map_find(&r->hinge_id, 0, hinge);
        if (offset > 0 && o < 0)
            return fl_elements_fail(&r->k.e, b->file, b->line, err,
                                    "element %lld has GECCEN %lld, which is not defined", (long long)b->id,
                                    (long long)offset);
        if (o >= 0) b->offset[s] = r->offset[o];
        if (h >= 0 && r->hinge[h] != ~0u) b->pins[s] = r->hinge[h];
        else if (h >= 0 && r->k.frame) fl_frame_count_skipped(r->k.frame, "releases of forces (BELFIX)");
    }
    const int32_t a = fl_id_map_find(&r->axis_id, 0, listed_value(r, f, 3, 0, nodes));
    if (a >= 0) b->across = r->axis[a];
    if (r->k.section[b->section[0]].form != r->k.section[b->section[1]].form) b->section[1] = b->section[0];
    return 0;
}

/* Names of sections become sets to ask for. */
static int add_section_sets(sesam_reader *r, const fl_string_table *names, const int64_t *geometry,
                            fl_err *err)
{
    int32_t *set_of = fl_alloc(r->section_id.n, sizeof *set_of, err);
    int rc = set_of ? 0 : -1;
    for (int32_t k = 0; rc == 0 && k < r->section_id.n; k++) set_of[k] = -1;
    for (int32_t k = 0; rc == 0 && k < names->n; k++) {
        const int32_t g = fl_id_map_find(&r->section_id, 0, geometry[k]);
        if (g >= 0 && (set_of[g] = fl_beam_deck_set(&r->k, names->name[k], 0, err)) < 0) rc = -1;
    }
    for (int32_t i = 0; rc == 0 && i < r->k.beams; i++) {
        const int32_t at = fl_id_map_find(&r->member_id, 0, r->k.beam[i].id);
        const int nodes = r->k.beam[i].node[2] > 0 ? 3 : 2;
        const int32_t g = fl_id_map_find(&r->section_id, 0, listed_value(r, &r->reference[at], 0, 0, nodes));
        if (set_of[g] >= 0) rc = fl_beam_deck_set_add(&r->k, set_of[g], r->k.beam[i].id, err);
    }
    free(set_of);
    return rc;
}

static void free_reader(sesam_reader *r)
{
    fl_id_map *const map[] = {&r->section_id, &r->offset_id, &r->axis_id,    &r->material_id, &r->hinge_id,
                              &r->member_id,  &r->set_id,    &r->concept_id, &r->mesh_id,     &r->ready_id};
    for (size_t k = 0; k < sizeof map / sizeof *map; k++) fl_id_map_free(map[k]);
    fl_beam_deck_free(&r->k);
    free(r->x), free(r->offset), free(r->axis), free(r->material), free(r->hinge), free(r->reference);
    free(r->set), free(r->concept_set), free(r->mesh_concept), free(r->pool), free(r->ready);
}

static int finish_sesam(sesam_reader *r, const fl_string_table *names, const int64_t *geometry, fl_surface *s,
                        fl_err *err)
{
    if (r->superelements && !r->elements)
        return fl_elements_fail(&r->k.e, 0, r->superelement_line, err,
                                "an assembly of superelements (GELMNT2): read its first-level files T1.FEM, "
                                "T2.FEM ... one by one");
    if (r->superelements)
        fl_bytes_note(r->k.b, "%d superelements (GELMNT2) are not in this file: read theirs",
                      r->superelements);
    for (int32_t i = 0; i < r->k.beams; i++)
        if (find_reference(r, i, err)) return -1;
    return add_section_sets(r, names, geometry, err) ? -1 : fl_beam_deck_finish(&r->k, s, err);
}

int fl_sesam_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    sesam_reader r = {0};
    fl_string_table names = {0}; /* of sections */
    int64_t *geometry = NULL;
    int32_t geometry_cap = 0;
    char text[FL_BEAM_NAME];
    int rc = -1, more;
    (void)name; /* members know their parts */
    if (fl_beam_deck_start(&r.k, b, opt, err)) return -1;
    while ((more = next_sesam(&r, text, err)) > 0) {
        if (sesam_record(&r, text, err)) goto done;
        if (strcmp(r.name, "TDSECT") == 0 && *text) {
            const int32_t at = fl_string_table_add(&names, text, err);
            if (at < 0 || fl_grow(&geometry, &geometry_cap, names.n, sizeof *geometry, err)) goto done;
            geometry[at] = whole(&r, 1);
        }
    }
    if (more == 0) rc = finish_sesam(&r, &names, geometry, s, err);
done:
    free(geometry);
    fl_string_table_free(&names);
    free_reader(&r);
    return rc;
}
