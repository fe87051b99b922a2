/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "mesh/cdb_block.h"
#include "mesh/fixed_columns.h"

enum {
    SOLID_HEAD = 11, /* columns of a row of EBLOCK,,SOLID before the nodes */
    BARE_HEAD = 5    /* the same without SOLID */
};

/* --- rows ----------------------------------------------------------------------------------------------- */

static int read_format(fl_cdb *c, fl_columns *f, fl_err *err)
{
    const int more = fl_deck_line(&c->d, err);
    if (more < 0) return -1;
    if (more == 0) return fl_deck_fail(&c->d, err, "the file ends where a format line is expected");
    if (fl_columns_parse(f, c->d.line) == 0) return 0;
    return fl_deck_fail(&c->d, err, "\"%.60s\" was found, a format like (3i9,6e21.13) is expected",
                        c->d.line);
}

static int integer_at(fl_cdb *c, const fl_columns *f, int k, int64_t *x, fl_err *err)
{
    char text[FL_COLUMN_WIDTH];
    if (fl_columns_integer(f, k, c->d.line, c->d.len, x) == 0) return 0;
    return fl_deck_fail(&c->d, err, "column %d is \"%.40s\", a whole number is expected", k + 1,
                        fl_columns_text(f, k, c->d.line, c->d.len, text));
}

static int real_at(fl_cdb *c, const fl_columns *f, int k, double *x, fl_err *err)
{
    char text[FL_COLUMN_WIDTH];
    if (fl_columns_real(f, k, c->d.line, c->d.len, x) == 0) return 0;
    return fl_deck_fail(&c->d, err, "column %d is \"%.40s\", a finite number is expected", k + 1,
                        fl_columns_text(f, k, c->d.line, c->d.len, text));
}

/* True if column k is blank or beyond the end of the row. */
static int is_blank(const fl_cdb *c, const fl_columns *f, int k)
{
    char text[FL_COLUMN_WIDTH];
    return *fl_columns_text(f, k, c->d.line, c->d.len, text) == '\0';
}

/* Advance to the next row of a block.  Returns 1, or 0 at its end: a row of -1, or the next command, which is
 * left for later unless it is the N,R5.3,LOC,-1 that ends an NBLOCK.  A block that ends with the file is
 * truncated. */
static int block_row(fl_cdb *c, const char *block, fl_err *err)
{
    for (;;) {
        const char *p;
        const int more = fl_deck_line(&c->d, err);
        if (more < 0) return -1;
        if (more == 0) return fl_deck_fail(&c->d, err, "the file ends inside %s, which -1 was to end", block);
        p = c->d.line + strspn(c->d.line, " \t\f\v");
        if (*p == '\0') continue;
        if (strcmp(p, "-1") == 0) return 0;
        if (strchr("0123456789+-.", *p)) return 1;
        if (strncasecmp(p, "N,", 2) != 0) fl_deck_unread(&c->d);
        return 0;
    }
}

/* Advance to the next row of a block without an end mark: 1, or 0 at the next command or the end of the file.
 */
static int open_row(fl_cdb *c, fl_err *err)
{
    for (;;) {
        const int more = fl_deck_line(&c->d, err);
        const char *p = more > 0 ? c->d.line + strspn(c->d.line, " \t\f\v") : "";
        if (more <= 0) return more;
        if (*p == '\0') continue;
        if (strchr("0123456789+-.", *p)) return 1;
        fl_deck_unread(&c->d);
        return 0;
    }
}

/* --- elements ------------------------------------------------------------------------------------------- */

int fl_cdb_set_type(fl_cdb *c, int64_t slot, int32_t routine, int32_t key, fl_err *err)
{
    const int32_t k = fl_id_map_add(&c->slot, 0, slot, err);
    if (k < 0 || fl_grow(&c->type, &c->type_cap, c->slot.n, sizeof *c->type, err)) return -1;
    c->type[k] = (fl_cdb_type){routine, key, fl_cdb_family_of(routine, key)};
    return 0;
}

int fl_cdb_add_element(fl_cdb *c, int64_t id, int64_t type, int64_t section, int64_t real, fl_err *err)
{
    const int32_t slot = fl_id_map_find(&c->slot, 0, type);
    const fl_cdb_type *t = slot < 0 ? NULL : &c->type[slot];
    const int n = c->nodes;
    int32_t k;
    int shape;
    if (!t)
        return fl_deck_fail(&c->d, err, "element %lld is of type %lld, which no ET or ETBLOCK defines",
                            (long long)id, (long long)type);
    if (c->frame &&
        fl_frame_cdb_element(c->frame, id, t->routine, c->material, section, real, n, c->node, err))
        return -1;
    if (t->family == FL_CDB_NONE) {
        char name[32];
        snprintf(name, sizeof name, "routine %d", t->routine);
        return fl_elements_skip(&c->e, name, err);
    }
    shape = fl_cdb_shape_of(t->family, n, c->node);
    if (shape < 0)
        return fl_deck_fail(&c->d, err, "element %lld of routine %d has %d nodes, more are expected",
                            (long long)id, t->routine, n);
    for (int i = n; i < FL_CDB_NODES; i++) c->node[i] = 0;
    k = fl_elements_add(&c->e, 0, id, (enum fl_shape)shape, c->part, c->node, err);
    if (k < 0) return -1;
    if (t->family != FL_CDB_LINE && t->family != FL_CDB_CURVE) return 0;
    return fl_cdb_section_line(&c->sections, (fl_cdb_line){k, t->routine, section, real}, err);
}

/* --- blocks --------------------------------------------------------------------------------------------- */

/* Add a remark if the block does not hold the number of entries announced. */
static void check_count(fl_cdb *c, const char *block, const char *promise, int64_t n)
{
    int64_t x;
    if (fl_deck_integer(promise, &x) == 0 && x > 0 && x != n)
        fl_bytes_note(c->d.base, "%s announces %lld entries and has %lld", block, (long long)x, (long long)n);
}

int fl_cdb_nblock(fl_cdb *c, fl_err *err)
{
    const char *promise = c->word[4];
    fl_columns f;
    int64_t n = 0;
    int more;
    if (read_format(c, &f, err)) return -1;
    if (f.integers < 1 || f.integers == f.n)
        return fl_deck_fail(&c->d, err, "a format of whole numbers and then reals is expected for nodes");
    while ((more = block_row(c, "NBLOCK", err)) > 0) {
        int64_t id;
        fl_vec3 x;
        if (integer_at(c, &f, 0, &id, err) || real_at(c, &f, f.integers, &x.x, err) ||
            real_at(c, &f, f.integers + 1, &x.y, err) || real_at(c, &f, f.integers + 2, &x.z, err))
            return -1;
        if (id == -1) break;
        if (id < 1)
            return fl_deck_fail(&c->d, err, "node %lld was found, a number of 1 or more is expected",
                                (long long)id);
        if (fl_elements_add_node(&c->e, 0, id, x, err) < 0) return -1;
        n++;
    }
    if (more < 0) return -1;
    check_count(c, "NBLOCK", promise, n);
    return 0;
}

/* Read nodes from column `from` on, until the element has `want` of them, or up to the first blank column
 * when want < 0. */
static int read_nodes(fl_cdb *c, const fl_columns *f, int from, int64_t want, fl_err *err)
{
    for (int k = from; k < f->n && (want < 0 || c->nodes < want); k++) {
        if (want < 0 && is_blank(c, f, k)) break;
        if (c->nodes == FL_CDB_NODES)
            return fl_deck_fail(&c->d, err, "more than %d nodes in an element", FL_CDB_NODES);
        if (integer_at(c, f, k, &c->node[c->nodes], err)) return -1;
        c->nodes++;
    }
    return 0;
}

/* Read the remaining nodes of an element from the rows that follow. */
static int read_more_nodes(fl_cdb *c, const fl_columns *f, int64_t id, int64_t want, fl_err *err)
{
    while (c->nodes < want) {
        const int more = fl_deck_line(&c->d, err);
        const char *p = more > 0 ? c->d.line + strspn(c->d.line, " \t") : "";
        if (more < 0) return -1;
        if (more == 0 || (*p && !strchr("0123456789+-", *p)))
            return fl_deck_fail(&c->d, err, "element %lld ends after %d of its %lld nodes", (long long)id,
                                c->nodes, (long long)want);
        if (read_nodes(c, f, 0, want, err)) return -1;
    }
    return 0;
}

static int read_solid_row(fl_cdb *c, const fl_columns *f, fl_err *err)
{
    int64_t col[SOLID_HEAD];
    int32_t line;
    for (int k = 0; k < SOLID_HEAD; k++)
        if (integer_at(c, f, k, &col[k], err)) return -1;
    if (col[8] < 1 || col[8] > FL_CDB_NODES || col[10] < 1)
        return fl_deck_fail(&c->d, err,
                            "element %lld of %lld nodes was found, a number of 1 or more and 1 to %d nodes "
                            "are expected",
                            (long long)col[10], (long long)col[8], FL_CDB_NODES);
    line = c->e.line;
    if (read_nodes(c, f, SOLID_HEAD, col[8], err) || read_more_nodes(c, f, col[10], col[8], err)) return -1;
    c->e.line = line;
    c->material = col[0];
    return fl_cdb_add_element(c, col[10], col[1], col[3], col[2], err);
}

/* Without the key SOLID no column holds the number of nodes: they are those of one row, for a brick of 20
 * nodes also those of the next. */
static int read_bare_row(fl_cdb *c, const fl_columns *f, fl_err *err)
{
    int64_t col[BARE_HEAD];
    int32_t slot, line;
    for (int k = 0; k < BARE_HEAD; k++)
        if (integer_at(c, f, k, &col[k], err)) return -1;
    if (col[0] < 1)
        return fl_deck_fail(&c->d, err, "element %lld was found, a number of 1 or more is expected",
                            (long long)col[0]);
    line = c->e.line;
    slot = fl_id_map_find(&c->slot, 0, col[1]);
    if (read_nodes(c, f, BARE_HEAD, -1, err)) return -1;
    if (slot >= 0 && c->type[slot].family == FL_CDB_BRICK && read_more_nodes(c, f, col[0], 20, err))
        return -1;
    c->e.line = line;
    c->material = col[3];
    return fl_cdb_add_element(c, col[0], col[1], col[1], col[2], err);
}

int fl_cdb_eblock(fl_cdb *c, fl_err *err)
{
    const int solid = strcasecmp(c->word[2], "SOLID") == 0;
    const char *promise = c->word[4];
    fl_columns f;
    int64_t n = 0;
    int more;
    if (read_format(c, &f, err)) return -1;
    if (f.integers != f.n || f.n <= (solid ? SOLID_HEAD : BARE_HEAD))
        return fl_deck_fail(&c->d, err, "a format of more than %d whole numbers is expected for elements",
                            solid ? SOLID_HEAD : BARE_HEAD);
    while ((more = block_row(c, "EBLOCK", err)) > 0) {
        int64_t first;
        if (integer_at(c, &f, 0, &first, err)) return -1;
        if (first == -1) break;
        c->nodes = 0;
        if (solid ? read_solid_row(c, &f, err) : read_bare_row(c, &f, err)) return -1;
        n++;
    }
    if (more < 0) return -1;
    c->nodes = 0; /* no EMORE may continue this element */
    check_count(c, "EBLOCK", promise, n);
    return 0;
}

int fl_cdb_etblock(fl_cdb *c, fl_err *err)
{
    fl_columns f;
    int more;
    if (read_format(c, &f, err)) return -1;
    if (f.integers < 2)
        return fl_deck_fail(&c->d, err, "a format of whole numbers is expected for element types");
    while ((more = block_row(c, "ETBLOCK", err)) > 0) {
        char text[FL_COLUMN_WIDTH];
        int64_t slot, routine, key = 0;
        if (integer_at(c, &f, 0, &slot, err)) return -1;
        if (slot == -1) break;
        if (integer_at(c, &f, 1, &routine, err)) return -1;
        if (f.n > 2 && fl_deck_integer(fl_columns_text(&f, 2, c->d.line, c->d.len, text), &key))
            key = 0; /* a text column may hold a word */
        if (slot < 1 || routine < 0 || routine > INT16_MAX || key < 0 || key > INT16_MAX)
            return fl_deck_fail(&c->d, err, "type %lld of routine %lld was found", (long long)slot,
                                (long long)routine);
        if (fl_cdb_set_type(c, slot, (int32_t)routine, (int32_t)key, err)) return -1;
    }
    return more < 0 ? -1 : 0;
}

/* Real constants: number, count and up to six values per row, seven in continuation rows. */
int fl_cdb_rlblock(fl_cdb *c, fl_err *err)
{
    fl_columns head, tail;
    int more;
    if (read_format(c, &head, err)) return -1;
    if (head.integers != 2 || head.n < 3)
        return fl_deck_fail(&c->d, err, "a format like (2i8,6g16.9) is expected for real constants");
    if (read_format(c, &tail, err)) return -1;
    while ((more = open_row(c, err)) > 0) {
        int64_t id, n;
        double first;
        if (integer_at(c, &head, 0, &id, err) || integer_at(c, &head, 1, &n, err) ||
            real_at(c, &head, 2, &first, err) || fl_cdb_section_real(&c->sections, id, first, err))
            return -1;
        for (int k = 2; c->frame && k < head.n && k < 2 + n; k++) {
            double x;
            if (real_at(c, &head, k, &x, err) || fl_frame_cdb_constant(c->frame, id, k - 2, x, err))
                return -1;
        }
        int at = head.n - 2;
        for (n -= head.n - 2; n > 0; n -= tail.n) {
            more = open_row(c, err);
            if (more < 0) return -1;
            if (more == 0)
                return fl_deck_fail(&c->d, err, "real constants %lld end with %lld values missing",
                                    (long long)id, (long long)n);
            for (int k = 0; c->frame && k < tail.n && k < n; k++) {
                double x;
                if (real_at(c, &tail, k, &x, err) || fl_frame_cdb_constant(c->frame, id, at++, x, err))
                    return -1;
            }
        }
    }
    return more;
}

/* A component of key points, lines, areas or volumes: the format line and rows of numbers. */
static int skip_component(fl_cdb *c, fl_err *err)
{
    int more = fl_deck_line(&c->d, err);
    c->other_sets++;
    if (more > 0 && c->d.line[strspn(c->d.line, " \t")] != '(') fl_deck_unread(&c->d);
    while (more > 0) more = open_row(c, err);
    return more;
}

int fl_cdb_cmblock(fl_cdb *c, fl_err *err)
{
    const int elements = strncasecmp(c->word[2], "ELEM", 4) == 0;
    const char *promise = c->word[3], *name = c->word[1];
    int64_t last = 0, n = 0, x;
    int32_t set = -1;
    fl_columns f;
    int more;
    if (!elements && strncasecmp(c->word[2], "NODE", 4) != 0) return skip_component(c, err);
    if (*name == '\0') return fl_deck_fail(&c->d, err, "the component has no name");
    c->node_sets += !elements;
    if (elements && (set = fl_string_table_add(&c->e.sets, name, err)) < 0) return -1;
    if (read_format(c, &f, err)) return -1;
    if (f.integers != f.n)
        return fl_deck_fail(&c->d, err, "a format of whole numbers is expected for a component");
    while ((more = open_row(c, err)) > 0) {
        for (int k = 0; k < f.n; k++) {
            if (is_blank(c, &f, k)) break;
            if (integer_at(c, &f, k, &x, err)) return -1;
            if (x == 0 || (x < 0 && (last <= 0 || -x < last)))
                return fl_deck_fail(&c->d, err,
                                    "%lld was found after %lld, a number above 0 or the end of a "
                                    "range is expected",
                                    (long long)x, (long long)last);
            n++;
            if (elements && x > 0 && fl_cdb_component_add(&c->components, set, x, x, err)) return -1;
            if (elements && x < 0) c->components.range[c->components.n - 1].hi = -x;
            last = x;
        }
    }
    if (more < 0) return -1;
    check_count(c, "CMBLOCK", promise, n);
    return 0;
}
