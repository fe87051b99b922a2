/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "base/number_text.h"
#include "mesh/element_surface.h"
#include "mesh/cdb_block.h"
#include "mesh/cdb_routine.h"
#include "mesh/read_cdb.h"

typedef struct {
    fl_cdb k;                  /* state shared with the blocks */
    fl_string_table parameter; /* of *SET */
    int64_t *value;            /* [parameter.n] */
    int64_t type, real, section,
        constants; /* constants: those that RMORE continues; current values of TYPE, REAL and SECNUM */
    int64_t made;  /* number of the element that EMORE would continue */
    int32_t made_line, system, unread, value_cap;
} cdb_reader;

static int command_at(const char *p, const char *word)
{
    const size_t n = strlen(word);
    p += strspn(p, " \t");
    return strncasecmp(p, word, n) == 0 && (p[n] == ',' || p[n] == ' ' || p[n] == '\t');
}

int fl_cdb_is(const fl_bytes *b)
{
    for (const char *p = b->data; *p;) {
        const int block = command_at(p, "NBLOCK") || command_at(p, "EBLOCK");
        p += strcspn(p, "\r\n");
        p += strspn(p, "\r\n");
        if (block && strchr("(0123456789", p[strspn(p, " \t")])) return 1; /* or the end of the file */
    }
    return 0;
}

/* --- words ---------------------------------------------------------------------------------------------- */

static int set_parameter(cdb_reader *c, const char *name, const char *text, fl_err *err)
{
    int64_t x;
    int32_t k;
    if (*name == '\0' || fl_deck_integer(text, &x)) return 0; /* only integers can stand for a number */
    k = fl_string_table_add(&c->parameter, name, err);
    if (k < 0 || fl_grow(&c->value, &c->value_cap, c->parameter.n, sizeof *c->value, err)) return -1;
    c->value[k] = x;
    return 0;
}

/* A word as a number, or as the value of the parameter of that name.  0, or -1. */
static int parse_number(const cdb_reader *c, const char *word, int64_t *x)
{
    double y;
    int32_t k;
    if (fl_deck_integer(word, x) == 0) return 0;
    if (fl_deck_real(word, &y) == 0 && y >= 0.0 && y < 1e9 && (double)(int64_t)y == y) {
        *x = (int64_t)y; /* "1." is an integer too */
        return 0;
    }
    k = fl_string_table_find(&c->parameter, word);
    if (k < 0) return -1;
    *x = c->value[k];
    return 0;
}

/* --- commands ------------------------------------------------------------------------------------------- */

/* ET,slot,routine, with the routine as a number or as a name that ends in it. */
static int read_et(cdb_reader *c, fl_err *err)
{
    const char *r = c->k.word[2] + strcspn(c->k.word[2], "0123456789");
    int64_t slot;
    int32_t routine;
    if (parse_number(c, c->k.word[1], &slot) || slot < 1) {
        c->unread++;
        return 0;
    }
    if (*c->k.word[2] == '\0' || strcmp(c->k.word[2], "0") == 0) return 0; /* the type is deleted */
    if (fl_number_i32(r, 0, INT16_MAX, &routine))
        return fl_deck_fail(&c->k.d, err, "element type \"%.40s\" was found, a routine like 185 is expected",
                            c->k.word[2]);
    return fl_cdb_set_type(&c->k, slot, routine, 0, err);
}

static int read_keyopt(cdb_reader *c, fl_err *err)
{
    int64_t slot, which, value;
    if (parse_number(c, c->k.word[1], &slot) || parse_number(c, c->k.word[2], &which) ||
        parse_number(c, c->k.word[3], &value))
        return 0;
    const int32_t k = fl_id_map_find(&c->k.slot, 0, slot);
    if (k < 0 || which != 1 || value < 0 || value >= INT16_MAX) return 0;
    return fl_cdb_set_type(&c->k, slot, c->k.type[k].routine, (int32_t)value, err);
}

static int read_sectype(cdb_reader *c)
{
    int64_t id;
    if (parse_number(c, c->k.word[1], &id)) id = 0;
    fl_cdb_section_open(&c->k.sections, id, c->k.word[2], c->k.word[3]);
    return 0;
}

static int read_secdata(cdb_reader *c, fl_err *err)
{
    const fl_cdb_sections *s = &c->k.sections;
    if (c->k.frame && fl_frame_cdb_section(c->k.frame, s->current, s->type, s->subtype, c->k.word, err))
        return -1;
    double x[2] = {0.0, 0.0};
    for (int k = 0; k < 2; k++)
        if (*c->k.word[k + 1] && fl_deck_real(c->k.word[k + 1], &x[k])) return 0;
    return fl_cdb_section_data(&c->k.sections, x, err);
}

static int read_r(cdb_reader *c, fl_err *err)
{
    int64_t id;
    double x = 0.0;
    if (parse_number(c, c->k.word[1], &id) || (*c->k.word[2] && fl_deck_real(c->k.word[2], &x))) return 0;
    c->constants = id;
    for (int k = 0; c->k.frame && k < 6; k++)
        if (*c->k.word[k + 2] && fl_deck_real(c->k.word[k + 2], &x) == 0 &&
            fl_frame_cdb_constant(c->k.frame, id, k, x, err))
            return -1;
    if (fl_deck_real(c->k.word[2], &x)) x = 0.0;
    return fl_cdb_section_real(&c->k.sections, id, x, err);
}

static int reject_unblocked(cdb_reader *c, fl_err *err)
{
    return fl_deck_fail(&c->k.d, err,
                        "%s,%.20s is of the unblocked format: write the archive with CDWRITE,DB,,,,,,BLOCKED",
                        c->k.word[0], c->k.word[1]);
}

/* N,R5.3,LOC,-1 and EN,R5.5,ATTR,-1 end the block before them in archives of some releases. */
static int is_end_mark(const cdb_reader *c) { return strcmp(c->k.word[3], "-1") == 0; }

static int read_n(cdb_reader *c, fl_err *err)
{
    int64_t id;
    fl_vec3 x = {0};
    double *const at[3] = {&x.x, &x.y, &x.z};
    if (strncasecmp(c->k.word[1], "R5", 2) == 0) {
        if (is_end_mark(c)) return 0;
        return reject_unblocked(c, err);
    }
    if (parse_number(c, c->k.word[1], &id) || id < 1) {
        c->unread++;
        return 0;
    }
    for (int k = 0; k < 3; k++)
        if (*c->k.word[k + 2] && fl_deck_real(c->k.word[k + 2], at[k])) {
            c->unread++;
            return 0;
        }
    if (c->system)
        return fl_deck_fail(&c->k.d, err, "node %lld is in coordinate system %d: write the nodes as NBLOCK",
                            (long long)id, c->system);
    return fl_elements_add_node(&c->k.e, 0, id, x, err) < 0 ? -1 : 0;
}

/* Add the element whose nodes E, EN and EMORE have collected. */
static int finish_element(cdb_reader *c, fl_err *err)
{
    const int32_t line = c->k.e.line;
    int rc;
    if (c->k.nodes == 0) return 0;
    c->k.e.line = c->made_line;
    rc = fl_cdb_add_element(&c->k, c->made, c->type, c->section, c->real, err);
    c->k.e.line = line;
    c->k.nodes = 0;
    return rc;
}

static int read_e(cdb_reader *c, int numbered, fl_err *err)
{
    const int from = numbered ? 2 : 1;
    int64_t id = -1;
    if (numbered && strncasecmp(c->k.word[1], "R5", 2) == 0)
        return is_end_mark(c) ? 0 : reject_unblocked(c, err);
    if (numbered && (parse_number(c, c->k.word[1], &id) || id < 1)) {
        c->unread++;
        return 0;
    }
    for (int k = from; k < from + 8 && *c->k.word[k]; k++)
        if (parse_number(c, c->k.word[k], &c->k.node[c->k.nodes++])) {
            c->k.nodes = 0;
            c->unread++;
            return 0;
        }
    c->made = id;
    c->made_line = c->k.e.line;
    return 0;
}

static int read_emore(cdb_reader *c, fl_err *err)
{
    if (c->k.nodes == 0) return 0; /* continues a skipped element */
    while (c->k.nodes % 8) c->k.node[c->k.nodes++] = 0;
    for (int k = 1; k <= 8 && *c->k.word[k]; k++) {
        if (c->k.nodes == FL_CDB_NODES)
            return fl_deck_fail(&c->k.d, err, "more than %d nodes in an element", FL_CDB_NODES);
        if (parse_number(c, c->k.word[k], &c->k.node[c->k.nodes++]))
            return fl_deck_fail(&c->k.d, err, "node \"%.40s\" was found, a number is expected", c->k.word[k]);
    }
    return 0;
}

/* Split the line at its commas; missing words are empty. */
static void split_command(cdb_reader *c)
{
    static char none[1];
    char *p = c->k.d.line, *end = strchr(p, '!');
    int n = 0;
    if (end) *end = '\0';
    for (; p && n < FL_CDB_WORDS; p = end) {
        end = strchr(p, ',');
        if (end) *end++ = '\0';
        c->k.word[n++] = fl_deck_trim(p);
    }
    while (n < FL_CDB_WORDS) c->k.word[n++] = none;
}

/* True if the command is `word`, in full or abbreviated to four letters or more: CDWRITE itself writes KEYOP.
 */
static int is_command(const cdb_reader *c, const char *word)
{
    const size_t n = strlen(c->k.word[0]), full = strlen(word);
    return (n == full || (n >= 4 && n < full)) && strncasecmp(c->k.word[0], word, n) == 0;
}

static int set_current(cdb_reader *c, int64_t *x, int k)
{
    if (parse_number(c, c->k.word[k], x)) c->unread++;
    return 0;
}

/* /INPUT,NAME,EXTENSION,FOLDER: the lines of another file. */
static int read_input(cdb_reader *c, fl_err *err)
{
    const char *name = c->k.word[1], *extension = c->k.word[2], *folder = c->k.word[3];
    char path[600];
    if (!*name) return fl_deck_fail(&c->k.d, err, "/INPUT names no file");
    const int n = snprintf(path, sizeof path, "%s%s%s%s%s", folder, *folder ? "/" : "", name,
                           *extension ? "." : "", extension);
    if (n < 0 || n >= (int)sizeof path) return fl_deck_fail(&c->k.d, err, "/INPUT has too long a name");
    return fl_deck_include(&c->k.d, path, err);
}

static int run_command(cdb_reader *c, fl_err *err)
{
    char *equals;
    if (!is_command(c, "EMORE") && finish_element(c, err)) return -1;
    if (is_command(c, "NBLOCK")) return fl_cdb_nblock(&c->k, err);
    if (is_command(c, "EBLOCK")) return fl_cdb_eblock(&c->k, err);
    if (is_command(c, "CMBLOCK")) return fl_cdb_cmblock(&c->k, err);
    if (is_command(c, "ETBLOCK")) return fl_cdb_etblock(&c->k, err);
    if (is_command(c, "RLBLOCK")) return fl_cdb_rlblock(&c->k, err);
    if (is_command(c, "ET")) return read_et(c, err);
    if (is_command(c, "KEYOPT")) return read_keyopt(c, err);
    if (is_command(c, "R")) return read_r(c, err);
    if (is_command(c, "SECTYPE")) return read_sectype(c);
    if (is_command(c, "SECDATA")) return read_secdata(c, err);
    if (is_command(c, "TYPE")) return set_current(c, &c->type, 1);
    if (is_command(c, "REAL")) return set_current(c, &c->real, 1);
    if (is_command(c, "SECNUM")) return set_current(c, &c->section, 1);
    if (is_command(c, "N")) return read_n(c, err);
    if (is_command(c, "E")) return read_e(c, 0, err);
    if (is_command(c, "EN")) return read_e(c, 1, err);
    if (is_command(c, "EMORE")) return read_emore(c, err);
    if (is_command(c, "*SET")) return set_parameter(c, c->k.word[1], c->k.word[2], err);
    if (is_command(c, "/INPUT")) return read_input(c, err);
    if (is_command(c, "CSYS") || is_command(c, "LOCAL")) {
        int64_t k = 1;
        c->system =
            parse_number(c, c->k.word[1], &k) || k != 0 ? (int32_t)(k > 0 && k < INT32_MAX ? k : 1) : 0;
    }
    if (c->k.frame && is_command(c, "MAT")) return set_current(c, &c->k.material, 1);
    if (c->k.frame && strchr(c->k.word[0], '=') == NULL)
        return fl_frame_cdb_command(c->k.frame, c->k.word, c->constants, err);
    equals = strchr(c->k.word[0], '=');
    if (equals) {
        *equals = '\0';
        return set_parameter(c, fl_deck_trim(c->k.word[0]), fl_deck_trim(equals + 1), err);
    }
    return 0;
}

/* --- the archive ---------------------------------------------------------------------------------------- */

static int read_commands(cdb_reader *c, fl_err *err)
{
    int more;
    while ((more = fl_deck_line(&c->k.d, err)) > 0) {
        split_command(c);
        if (c->k.word[0][0] == '\0') continue;
        if (run_command(c, err)) return -1;
    }
    return more < 0 || finish_element(c, err) ? -1 : 0;
}

int fl_cdb_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    cdb_reader c = {.type = 1, .real = 1, .section = 1};
    fl_cdb *k = &c.k;
    fl_frame_cdb frame = {.model = opt ? opt->frame : NULL};
    int rc = -1;
    k->material = 1;
    if (frame.model) k->frame = &frame;
    if (fl_elements_start(&k->e, fl_in_name(b->in), err)) return -1;
    fl_deck_start(&k->d, &k->e, b);
    k->part = fl_string_table_add(&k->e.parts, name, err);
    if (k->part < 0 || read_commands(&c, err)) goto done;
    if (k->frame) {
        for (int32_t v = 0; v < frame.model->node_id.n; v++) {
            const int32_t at = fl_id_map_find(&k->e.node_id, 0, frame.model->node_id.id[v]);
            if (at < 0 || k->e.x[at].x != k->e.x[at].x) continue;
            frame.model->node[v].x = k->e.x[at];
            frame.model->node[v].defined = 1;
        }
        rc = fl_frame_cdb_finish(&frame, err);
        goto done;
    }
    if (fl_cdb_section_apply(&k->sections, &k->e, err) ||
        fl_cdb_component_assign(&k->components, &k->e, fl_import_by_name(opt), err))
        goto done;
    if (k->other_sets)
        fl_bytes_note(b, "%d components of key points, lines, areas or volumes were skipped", k->other_sets);
    if (k->node_sets) fl_bytes_note(b, "%d components of nodes were skipped", k->node_sets);
    if (c.unread) fl_bytes_note(b, "%d commands with parameters that are not numbers were skipped", c.unread);
    rc = fl_elements_surface(&k->e, s, b, opt, err);
done:
    fl_frame_cdb_free(&frame);
    fl_deck_free(&k->d);
    fl_elements_free(&k->e);
    fl_id_map_free(&k->slot);
    fl_cdb_section_free(&k->sections);
    fl_cdb_component_free(&k->components);
    free(k->type);
    fl_string_table_free(&c.parameter);
    free(c.value);
    return rc;
}
