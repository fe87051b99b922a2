/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_usfos.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "mesh/beam_deck.h"

typedef struct {
    fl_beam_deck k;
    char *text; /* [used] words of the record, each with its zero byte */
    int32_t *at, at_cap, text_cap, used, words;
    int32_t line; /* of the keyword */
    fl_id_map section_id, material_id, vector_id, offset_id, group_id;
    fl_frame_material *material; /* [material_id.n] */
    fl_vec3 *vector, *offset;    /* [vector_id.n], [offset_id.n] */
    int32_t *group;              /* [group_id.n] set of the deck */
    fl_id_map ready_id;          /* pairs of geometry and material */
    int32_t *ready;              /* [2 ready_id.n] their sections */
    int32_t *end_two; /* [sections] section of the second end of a pipe, the same without a taper */
    int32_t material_cap, vector_cap, offset_cap, group_cap, end_cap, ready_cap;
    struct usfos_refs {
        int64_t material, vector, offset[2], geometry;
    } * refs; /* [beams] */
    int32_t refs_cap;
} usfos_reader;

/* --- recognition ---------------------------------------------------------------------------------------- */

/* True if the line at p is NODE, an integer and three numbers. */
static int is_node_line(const char *p)
{
    char word[64];
    p += strspn(p, " \t");
    if (strncasecmp(p, "NODE", 4) != 0 || !fl_bytes_blank(p[4])) return 0;
    p += 4;
    for (int k = 0; k < 4; k++) {
        double x;
        int64_t id;
        p += strspn(p, " \t");
        const size_t n = strcspn(p, " \t\r\n");
        if (n == 0 || n >= sizeof word) return 0;
        memcpy(word, p, n);
        word[n] = '\0';
        if (k == 0 ? fl_deck_integer(word, &id) : fl_deck_real(word, &x)) return 0;
        p += n;
    }
    return 1;
}

static int is_element_line(const char *p)
{
    static const char *const WORD[] = {"BEAM", "QUADSHEL", "TRISHELL"};
    p += strspn(p, " \t");
    for (int k = 0; k < 3; k++) {
        const size_t n = strlen(WORD[k]);
        if (strncasecmp(p, WORD[k], n) || !fl_bytes_blank(p[n])) continue;
        p += n + strspn(p + n, " \t");
        return *p >= '0' && *p <= '9';
    }
    return 0;
}

int fl_usfos_is(const fl_bytes *b)
{
    int node = 0, element = 0;
    for (const char *p = b->data; *p && !(node && element); p += strcspn(p, "\n"), p += *p == '\n') {
        node = node || is_node_line(p);
        element = element || is_element_line(p);
    }
    return node && element;
}

/* --- records -------------------------------------------------------------------------------------------- */

static int keep_word(usfos_reader *r, const char *p, size_t n, fl_err *err)
{
    if (fl_grow(&r->at, &r->at_cap, (int64_t)r->words + 1, sizeof *r->at, err) ||
        fl_grow(&r->text, &r->text_cap, (int64_t)r->used + (int64_t)n + 1, 1, err))
        return -1;
    memcpy(r->text + r->used, p, n);
    r->text[r->used + (int32_t)n] = '\0';
    r->at[r->words++] = r->used;
    r->used += (int32_t)n + 1;
    return 0;
}

static int keep_words(usfos_reader *r, fl_err *err)
{
    char *p = r->k.d.line, *comment = strchr(p, '\'');
    if (comment) *comment = '\0';
    for (;;) {
        p += strspn(p, " \t");
        const size_t n = strcspn(p, " \t");
        if (n == 0) return 0;
        if (keep_word(r, p, n, err)) return -1;
        p += n;
    }
}

static int begins_with_number(const char *p)
{
    p += strspn(p, " \t");
    p += *p == '-' || *p == '+';
    p += *p == '.';
    return *p >= '0' && *p <= '9';
}

/* Reads a record with its further lines: 1, 0 at the end, -1. */
static int next_record(usfos_reader *r, fl_err *err)
{
    int more;
    r->words = r->used = 0;
    while ((more = fl_deck_line(&r->k.d, err)) > 0) {
        if (r->words && !begins_with_number(r->k.d.line)) {
            const char *p = r->k.d.line + strspn(r->k.d.line, " \t");
            if (!*p || *p == '\'') continue; /* a comment between the lines of a record */
            fl_deck_unread(&r->k.d);
            break;
        }
        if (r->words == 0) r->line = r->k.e.line;
        if (keep_words(r, err)) return -1;
    }
    if (more < 0) return -1;
    r->k.e.line = r->line;
    return r->words > 0;
}

static const char *word_at(const usfos_reader *r, int32_t k)
{
    return k < r->words ? r->text + r->at[k] : "";
}

static int real_at(usfos_reader *r, int32_t k, double *x, fl_err *err)
{
    if (fl_deck_real(word_at(r, k), x) == 0) return 0;
    return fl_deck_fail(&r->k.d, err, "word %d of %.20s is \"%.40s\", a number is expected", (int)k + 1,
                        word_at(r, 0), word_at(r, k));
}

static int id_at(usfos_reader *r, int32_t k, int64_t least, int64_t *x, fl_err *err)
{
    if (fl_deck_integer(word_at(r, k), x) == 0 && *x >= least) return 0;
    return fl_deck_fail(&r->k.d, err, "word %d of %.20s is \"%.40s\", a number of %d or more is expected",
                        (int)k + 1, word_at(r, 0), word_at(r, k), (int)least);
}

static int reals_at(usfos_reader *r, int32_t k, int n, double *x, fl_err *err)
{
    for (int i = 0; i < n; i++)
        if (real_at(r, k + i, &x[i], err)) return -1;
    return 0;
}

/* --- the records that are read -------------------------------------------------------------------------- */

static int usfos_node(usfos_reader *r, fl_err *err)
{
    int64_t id;
    double x[3];
    int fixed = 0;
    if (id_at(r, 1, 1, &id, err) || reals_at(r, 2, 3, x, err)) return -1;
    for (int c = 0; c < 6 && 5 + c < r->words; c++) fixed |= (strcmp(word_at(r, 5 + c), "1") == 0) << c;
    if (fl_elements_add_node(&r->k.e, 0, id, v3(x[0], x[1], x[2]), err) < 0) return -1;
    return fl_beam_deck_hold(&r->k, id, fixed, err);
}

static int usfos_beam(usfos_reader *r, fl_err *err)
{
    fl_beam b = {.part = -1};
    struct usfos_refs refs = {0};
    if (id_at(r, 1, 1, &b.id, err) || id_at(r, 2, 1, &b.node[0], err) || id_at(r, 3, 1, &b.node[1], err) ||
        id_at(r, 4, 0, &refs.material, err) || id_at(r, 5, 1, &refs.geometry, err))
        return -1;
    int64_t *const more[3] = {&refs.vector, &refs.offset[0], &refs.offset[1]};
    for (int k = 0; k < 3 && 6 + k < r->words; k++)
        if (id_at(r, 6 + k, 0, more[k], err)) return -1;
    const int32_t at = fl_beam_deck_add(&r->k, &b, err);
    if (at < 0 || fl_grow(&r->refs, &r->refs_cap, (int64_t)at + 1, sizeof *r->refs, err)) return -1;
    r->refs[at] = refs;
    return 0;
}

static int usfos_plate(usfos_reader *r, int corners, fl_err *err)
{
    int64_t id, node[4];
    const int32_t part = fl_string_table_add(&r->k.e.parts, "plates", err);
    if (part < 0 || id_at(r, 1, 1, &id, err)) return -1;
    for (int k = 0; k < corners; k++)
        if (id_at(r, 2 + k, 1, &node[k], err)) return -1;
    return fl_elements_add(&r->k.e, 0, id, corners == 3 ? FL_TRI3 : FL_QUAD4, part, node, err) < 0 ? -1 : 0;
}

/* Adds a section of that number; a second one of a taper has no number. */
static int usfos_section(usfos_reader *r, int64_t id, const fl_beam_section *s, double second, fl_err *err)
{
    const int32_t had = r->section_id.n, at = fl_id_map_add(&r->section_id, 0, id, err);
    if (at < 0) return -1;
    if (at < had) return fl_deck_fail(&r->k.d, err, "geometry %lld is defined a second time", (long long)id);
    const int32_t k = fl_beam_deck_section(&r->k, s, err);
    int32_t last = k;
    if (k >= 0 && second > 0.0 && second != s->size[0]) {
        fl_beam_section end = *s;
        end.size[0] = second;
        snprintf(end.name, sizeof end.name, "g%lld_end", (long long)id);
        last = fl_beam_deck_section(&r->k, &end, err);
    }
    if (k < 0 || last < 0 ||
        fl_grow(&r->end_two, &r->end_cap, 2 * ((int64_t)at + 1), sizeof *r->end_two, err))
        return -1;
    r->end_two[2 * at] = k;
    r->end_two[2 * at + 1] = last;
    return 0;
}

static int usfos_pipe(usfos_reader *r, fl_err *err)
{
    fl_beam_section s = {.form = FL_FRAME_PIPE};
    int64_t id;
    double second = 0.0;
    if (id_at(r, 1, 1, &id, err) || real_at(r, 2, &s.size[0], err) || real_at(r, 3, &s.wall[0], err) ||
        (r->words > 6 && real_at(r, 6, &second, err)))
        return -1;
    if (!(s.size[0] > 0.0))
        return fl_deck_fail(&r->k.d, err, "PIPE %lld has the diameter %g, a length above 0 is expected",
                            (long long)id, s.size[0]);
    snprintf(s.name, sizeof s.name, "g%lld", (long long)id);
    return usfos_section(r, id, &s, second, err);
}

static int usfos_box(usfos_reader *r, fl_err *err)
{
    fl_beam_section s = {.form = FL_FRAME_RECTANGLE};
    int64_t id;
    double x[5];
    if (id_at(r, 1, 1, &id, err) || reals_at(r, 2, 5, x, err)) return -1;
    if (!(x[0] > 0.0) || !(x[4] > 0.0))
        return fl_deck_fail(&r->k.d, err, "BOX %lld has the sides %g and %g, lengths above 0 are expected",
                            (long long)id, x[0], x[4]);
    s.size[0] = x[4];
    s.size[1] = x[0];
    s.wall[0] = x[1];
    s.wall[1] = 0.5 * (x[2] + x[3]);
    snprintf(s.name, sizeof s.name, "g%lld", (long long)id);
    return usfos_section(r, id, &s, 0.0, err);
}

/* Profiles of I have no outline that ice meets; of a frame the height is along z. */
static int usfos_profile(usfos_reader *r, fl_err *err)
{
    fl_beam_section s = {.form = FL_FRAME_GENERAL, .kind = "IHPROFIL"};
    int64_t id;
    double x[6];
    if (id_at(r, 1, 1, &id, err) || reals_at(r, 2, 6, x, err)) return -1;
    const fl_frame_section i = fl_frame_section_i(x[0], x[4], x[2], x[1], x[5], x[3]);
    s.a = i.a, s.iy = i.iz, s.iz = i.iy, s.j = i.j;
    snprintf(s.name, sizeof s.name, "g%lld", (long long)id);
    return usfos_section(r, id, &s, 0.0, err);
}

static int usfos_general(usfos_reader *r, fl_err *err)
{
    fl_beam_section s = {.form = FL_FRAME_GENERAL, .kind = "GENBEAM"};
    int64_t id;
    double x[4];
    if (id_at(r, 1, 1, &id, err) || reals_at(r, 2, 4, x, err)) return -1;
    s.a = x[0], s.j = x[1], s.iy = x[2], s.iz = x[3];
    snprintf(s.name, sizeof s.name, "g%lld", (long long)id);
    return usfos_section(r, id, &s, 0.0, err);
}

/* MISOIEP id E nu fy rho; MATERIAL id Elastic E nu fy rho. */
static int usfos_material(usfos_reader *r, fl_err *err)
{
    const int worded = strcasecmp(word_at(r, 0), "MATERIAL") == 0, at_e = 2 + worded;
    int64_t id;
    double x[4] = {0};
    if (worded && strcasecmp(word_at(r, 2), "Elastic") != 0) return 0;
    if (id_at(r, 1, 1, &id, err) || reals_at(r, at_e, r->words > 3 + at_e ? 4 : 2, x, err)) return -1;
    const int32_t at = fl_id_map_add(&r->material_id, 0, id, err);
    if (at < 0 || fl_grow(&r->material, &r->material_cap, (int64_t)at + 1, sizeof *r->material, err))
        return -1;
    r->material[at] = (fl_frame_material){.e = x[0], .nu = x[1], .rho = x[3]};
    return 0;
}

static int usfos_vector(usfos_reader *r, fl_id_map *ids, fl_vec3 **list, int32_t *cap, fl_err *err)
{
    int64_t id;
    double x[3];
    if (id_at(r, 1, 1, &id, err) || reals_at(r, 2, 3, x, err)) return -1;
    const int32_t at = fl_id_map_add(ids, 0, id, err);
    if (at < 0 || fl_grow(list, cap, (int64_t)at + 1, sizeof **list, err)) return -1;
    (*list)[at] = v3(x[0], x[1], x[2]);
    return 0;
}

static int usfos_mass(usfos_reader *r, fl_err *err)
{
    int64_t id;
    double mass;
    if (id_at(r, 1, 1, &id, err) || real_at(r, 2, &mass, err)) return -1;
    return fl_beam_deck_mass(&r->k, id, mass, err);
}

/* Set of a group; `name` renames it, NULL leaves it. */
static int32_t usfos_group(usfos_reader *r, int64_t id, const char *name, fl_err *err)
{
    char text[FL_BEAM_NAME];
    const int32_t had = r->group_id.n, at = fl_id_map_add(&r->group_id, 0, id, err);
    if (at < 0 || fl_grow(&r->group, &r->group_cap, (int64_t)at + 1, sizeof *r->group, err)) return -1;
    if (at < had) return r->group[at];
    snprintf(text, sizeof text, "group_%lld", (long long)id);
    r->group[at] = fl_beam_deck_set(&r->k, name ? name : text, 1, err);
    return r->group[at];
}

static int usfos_name(usfos_reader *r, fl_err *err)
{
    char text[FL_BEAM_NAME] = "";
    int64_t id;
    if (strcasecmp(word_at(r, 1), "Group") != 0) return 0;
    if (id_at(r, 2, 1, &id, err)) return -1;
    for (int32_t k = 3; k < r->words && strlen(text) + strlen(word_at(r, k)) + 2 < sizeof text; k++) {
        if (k > 3) strcat(text, "_");
        strcat(text, word_at(r, k));
    }
    return usfos_group(r, id, text[0] ? text : NULL, err) < 0 ? -1 : 0;
}

static int usfos_members_of(usfos_reader *r, fl_err *err)
{
    int64_t id, element;
    if (id_at(r, 1, 1, &id, err)) return -1;
    if (strcasecmp(word_at(r, 2), "Elem") != 0) return 0;
    const int32_t set = usfos_group(r, id, NULL, err);
    if (set < 0) return -1;
    for (int32_t k = 3; k < r->words; k++)
        if (id_at(r, k, 1, &element, err) || fl_beam_deck_set_add(&r->k, set, element, err)) return -1;
    return 0;
}

static int usfos_triangle(usfos_reader *r, fl_err *err) { return usfos_plate(r, 3, err); }
static int usfos_quad(usfos_reader *r, fl_err *err) { return usfos_plate(r, 4, err); }
static int usfos_unitvec(usfos_reader *r, fl_err *err)
{
    return usfos_vector(r, &r->vector_id, &r->vector, &r->vector_cap, err);
}
static int usfos_eccent(usfos_reader *r, fl_err *err)
{
    return usfos_vector(r, &r->offset_id, &r->offset, &r->offset_cap, err);
}

static const struct {
    const char *word;
    int (*read)(usfos_reader *r, fl_err *err);
} RECORD[] = {{"NODE", usfos_node},       {"BEAM", usfos_beam},         {"PIPE", usfos_pipe},
              {"BOX", usfos_box},         {"IHPROFIL", usfos_profile},  {"GENBEAM", usfos_general},
              {"QUADSHEL", usfos_quad},   {"TRISHELL", usfos_triangle}, {"ECCENT", usfos_eccent},
              {"UNITVEC", usfos_unitvec}, {"MISOIEP", usfos_material},  {"MATERIAL", usfos_material},
              {"NODEMASS", usfos_mass},   {"Name", usfos_name},         {"GroupDef", usfos_members_of}};

/* --- references ----------------------------------------------------------------------------------------- */

/* The sections of both ends of geometry g with a material: each pair of the two is made once. */
static int sections_with(usfos_reader *r, int32_t g, int64_t geometry, int64_t material, int32_t section[2],
                         fl_err *err)
{
    const int32_t m = fl_id_map_find(&r->material_id, 0, material);
    const int32_t had = r->ready_id.n, at = fl_id_map_add(&r->ready_id, g, m < 0 ? 0 : material, err);
    if (at < 0 || fl_grow(&r->ready, &r->ready_cap, 2 * ((int64_t)at + 1), sizeof *r->ready, err)) return -1;
    for (int s = 0; at == had && s < 2; s++) {
        fl_beam_section made = r->k.section[r->end_two[2 * g + s]];
        if (m >= 0) {
            made.material = r->material[m];
            snprintf(made.name, sizeof made.name, "g%lld_m%lld%s", (long long)geometry, (long long)material,
                     s && r->end_two[2 * g] != r->end_two[2 * g + 1] ? "_end" : "");
        }
        r->ready[2 * at + s] = s && r->end_two[2 * g] == r->end_two[2 * g + 1]
                                   ? r->ready[2 * at]
                                   : fl_beam_deck_section(&r->k, &made, err);
        if (r->ready[2 * at + s] < 0) return -1;
    }
    section[0] = r->ready[2 * at];
    section[1] = r->ready[2 * at + 1];
    return 0;
}

static int find_refs(usfos_reader *r, int32_t i, fl_err *err)
{
    fl_beam *b = &r->k.beam[i];
    const struct usfos_refs *refs = &r->refs[i];
    const int32_t g = fl_id_map_find(&r->section_id, 0, refs->geometry);
    if (g < 0)
        return fl_elements_fail(&r->k.e, b->file, b->line, err,
                                "member %lld has geometry %lld, which is not defined", (long long)b->id,
                                (long long)refs->geometry);
    if (sections_with(r, g, refs->geometry, refs->material, b->section, err)) return -1;
    const int32_t v = fl_id_map_find(&r->vector_id, 0, refs->vector);
    if (v >= 0) b->across = r->vector[v];
    for (int s = 0; s < 2; s++) {
        const int32_t o = fl_id_map_find(&r->offset_id, 0, refs->offset[s]);
        if (refs->offset[s] > 0 && o < 0)
            return fl_elements_fail(&r->k.e, b->file, b->line, err,
                                    "member %lld has eccentricity %lld, which is not defined",
                                    (long long)b->id, (long long)refs->offset[s]);
        if (o >= 0) b->offset[s] = r->offset[o];
    }
    return 0;
}

int fl_usfos_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    usfos_reader r = {0};
    int rc = -1, more;
    (void)name; /* members know their parts */
    if (fl_beam_deck_start(&r.k, b, opt, err)) return -1;
    while ((more = next_record(&r, err)) > 0) {
        size_t k = 0;
        while (k < sizeof RECORD / sizeof *RECORD && strcasecmp(RECORD[k].word, word_at(&r, 0)) != 0) k++;
        if (k < sizeof RECORD / sizeof *RECORD && RECORD[k].read(&r, err)) goto done;
        if (k == sizeof RECORD / sizeof *RECORD && r.k.frame)
            fl_frame_count_skipped(r.k.frame, "%.30s", word_at(&r, 0));
    }
    if (more < 0) goto done;
    for (int32_t i = 0; i < r.k.beams; i++)
        if (find_refs(&r, i, err)) goto done;
    rc = fl_beam_deck_finish(&r.k, s, err);
done:
    fl_beam_deck_free(&r.k);
    fl_id_map_free(&r.section_id);
    fl_id_map_free(&r.material_id);
    fl_id_map_free(&r.vector_id);
    fl_id_map_free(&r.offset_id);
    fl_id_map_free(&r.group_id);
    fl_id_map_free(&r.ready_id);
    free(r.text), free(r.at), free(r.material), free(r.vector), free(r.offset), free(r.group);
    free(r.end_two), free(r.refs), free(r.ready);
    return rc;
}
