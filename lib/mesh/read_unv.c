/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_unv.h"
#include <stdio.h>
#include <string.h>
#include "mesh/beam_deck.h"
#include "mesh/sesam_element.h"

enum { UNV_WORDS = 12, UNV_NODES = 24 };

typedef struct {
    fl_beam_deck k;
    char *word[UNV_WORDS];
    int words;
    int32_t part; /* of elements in no group */
} unv_reader;

/* Types of 2412 as those of SESAM, whose nodes go round in the same way. */
static const struct {
    int unv, sesam, nodes;
} UNV_TYPE[] = {{41, 25, 3},  {51, 25, 3},  {61, 25, 3},   {74, 25, 3},   {91, 25, 3},
                {42, 6, 6},   {92, 6, 6},   {44, 24, 4},   {54, 24, 4},   {64, 24, 4},
                {71, 24, 4},  {94, 24, 4},  {45, 8, 8},    {95, 8, 8},    {111, 33, 4},
                {112, 32, 6}, {115, 21, 8}, {118, 31, 10}, {113, 30, 15}, {116, 20, 20}};

static int is_beam_type(int64_t type) { return type == 11 || (type >= 21 && type <= 24); }

/* True if the line at p is -1 alone. */
static int is_end_mark(const char *p)
{
    p += strspn(p, " \t");
    return p[0] == '-' && p[1] == '1' && strchr(" \t\r\n", p[2]) && p[2 + strspn(p + 2, " \t")] < ' ';
}

static const char *line_after(const char *p)
{
    p += strcspn(p, "\n");
    return *p ? p + 1 : p;
}

static int64_t number_in_line(const char *p)
{
    int64_t x = 0;
    p += strspn(p, " \t");
    for (int k = 0; k < 9 && *p >= '0' && *p <= '9'; k++) x = 10 * x + *p++ - '0';
    return x;
}

int fl_unv_is(const fl_bytes *b)
{
    const char *p = b->data + strspn(b->data, " \t\r\n");
    while (p > b->data && p[-1] != '\n') p--;
    if (!is_end_mark(p)) return 0;
    for (; *p; p = line_after(p))
        if (is_end_mark(p)) {
            const int64_t set = number_in_line(line_after(p));
            if (set == 2411 || set == 2412) return 1;
        }
    return 0;
}

/* Next line, in words: 1, 0 at the end of the dataset or of the file, -1. */
static int next_unv(unv_reader *r, fl_err *err)
{
    const int more = fl_deck_line(&r->k.d, err);
    if (more <= 0) return more;
    if (is_end_mark(r->k.d.line)) return 0;
    char *p = r->k.d.line;
    for (r->words = 0; r->words < UNV_WORDS; r->words++) {
        p += strspn(p, " \t");
        if (!*p) break;
        r->word[r->words] = p;
        p += strcspn(p, " \t");
        if (*p) *p++ = '\0';
    }
    return 1;
}

static int unv_integer(unv_reader *r, int k, int64_t *x, fl_err *err)
{
    if (k < r->words && fl_deck_integer(r->word[k], x) == 0) return 0;
    return fl_deck_fail(&r->k.d, err, "word %d is \"%.40s\", a whole number is expected", k + 1,
                        k < r->words ? r->word[k] : "");
}

static int cut_short(unv_reader *r, int more, fl_err *err)
{
    return more < 0 ? -1 : fl_deck_fail(&r->k.d, err, "the dataset ends within a record");
}

static int unv_node(unv_reader *r, fl_err *err)
{
    int64_t id;
    double x[3];
    if (unv_integer(r, 0, &id, err)) return -1;
    const int more = next_unv(r, err);
    if (more <= 0) return cut_short(r, more, err);
    for (int c = 0; c < 3; c++)
        if (c >= r->words || fl_deck_real(r->word[c], &x[c]))
            return fl_deck_fail(&r->k.d, err, "a coordinate of node %lld is \"%.40s\", a number is expected",
                                (long long)id, c < r->words ? r->word[c] : "");
    return fl_elements_add_node(&r->k.e, 0, id, v3(x[0], x[1], x[2]), err) < 0 ? -1 : 0;
}

/* Shape of a type with so many nodes, NULL: none. */
static const fl_sesam_type *shape_of_type(int64_t type, int64_t nodes)
{
    for (size_t k = 0; k < sizeof UNV_TYPE / sizeof *UNV_TYPE; k++)
        if (UNV_TYPE[k].unv == type && UNV_TYPE[k].nodes == nodes) return fl_sesam_type_of(UNV_TYPE[k].sesam);
    return NULL;
}

static int unv_element(unv_reader *r, fl_err *err)
{
    int64_t id, type, nodes, node[UNV_NODES] = {0}, ordered[FL_SESAM_NODES];
    int more;
    const int32_t line = r->k.e.line;
    if (unv_integer(r, 0, &id, err) || unv_integer(r, 1, &type, err) || unv_integer(r, 5, &nodes, err))
        return -1;
    if (nodes < 1 || nodes > UNV_NODES)
        return fl_deck_fail(&r->k.d, err, "element %lld has %lld nodes, 1 to %d are expected", (long long)id,
                            (long long)nodes, UNV_NODES);
    if (is_beam_type(type) && (more = next_unv(r, err)) <= 0) return cut_short(r, more, err);
    for (int64_t k = 0; k < nodes;) {
        if ((more = next_unv(r, err)) <= 0) return cut_short(r, more, err);
        if (r->words == 0) return cut_short(r, 0, err);
        for (int c = 0; c < r->words && k < nodes; c++)
            if (unv_integer(r, c, &node[k++], err)) return -1;
    }
    const fl_sesam_type *t = shape_of_type(type, nodes);
    if (!t) {
        char kind[40];
        snprintf(kind, sizeof kind, "%s %lld", is_beam_type(type) ? "beam type" : "type", (long long)type);
        return fl_beam_deck_skip(&r->k, kind, err);
    }
    for (int k = 0; k < fl_shape_nodes(t->shape); k++) ordered[k] = node[t->order[k]];
    r->k.e.line = line;
    return fl_elements_add(&r->k.e, 0, id, t->shape, r->part, ordered, err) < 0 ? -1 : 0;
}

/* A group: its number ... count of entities; name; pairs of type and number, of four words each. */
static int unv_group(unv_reader *r, fl_err *err)
{
    char name[FL_BEAM_NAME];
    int64_t group, count, kind, tag;
    int more;
    if (unv_integer(r, 0, &group, err) || unv_integer(r, 7, &count, err)) return -1;
    if ((more = fl_deck_line(&r->k.d, err)) <= 0) return cut_short(r, more, err);
    snprintf(name, sizeof name, "%.60s", fl_deck_trim(r->k.d.line));
    if (!name[0]) snprintf(name, sizeof name, "group_%lld", (long long)group);
    const int32_t set = fl_beam_deck_set(&r->k, name, 1, err);
    if (set < 0) return -1;
    for (int64_t k = 0; k < count;) {
        if ((more = next_unv(r, err)) <= 0) return cut_short(r, more, err);
        if (r->words == 0) return cut_short(r, 0, err);
        for (int c = 0; c + 1 < r->words && k < count; c += 4, k++) {
            if (unv_integer(r, c, &kind, err) || unv_integer(r, c + 1, &tag, err)) return -1;
            if (kind == 8 && fl_beam_deck_set_add(&r->k, set, tag, err)) return -1;
        }
    }
    return 0;
}

/* 164: a code of units, 1 for metres. */
static void hint_unv_units(unv_reader *r)
{
    static const struct {
        int64_t code;
        const char *unit;
    } UNIT[] = {{2, "ft"}, {4, "ft"}, {5, "mm"}, {6, "cm"}, {7, "in"}, {8, "mm"}, {10, "mm"}};
    int64_t code;
    if (r->words < 1 || fl_deck_integer(r->word[0], &code) || (r->k.opt && r->k.opt->has_unit)) return;
    for (size_t k = 0; k < sizeof UNIT / sizeof *UNIT; k++)
        if (UNIT[k].code == code)
            fl_bytes_note(r->k.b, "dataset 164 speaks of a length of %s: --unit %s", UNIT[k].unit,
                          UNIT[k].unit);
}

static int read_dataset(unv_reader *r, int64_t set, fl_err *err)
{
    const int groups = set == 2467 || set == 2477 || set == 2452 || set == 2435;
    int more, first = 1;
    while ((more = next_unv(r, err)) > 0) {
        int bad = 0;
        if (set == 164 && first) hint_unv_units(r);
        first = 0;
        if (r->words == 0) continue;
        if (set == 2411) bad = unv_node(r, err);
        else if (set == 2412) bad = unv_element(r, err);
        else if (groups) bad = unv_group(r, err);
        if (bad) return -1;
    }
    return more;
}

int fl_unv_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    unv_reader r = {0};
    int rc = -1, more;
    if (fl_beam_deck_start(&r.k, b, opt, err)) return -1;
    r.part = fl_string_table_add(&r.k.e.parts, name, err);
    if (r.part < 0) goto done;
    while ((more = fl_deck_line(&r.k.d, err)) > 0) {
        if (!is_end_mark(r.k.d.line)) continue;
        if ((more = fl_deck_line(&r.k.d, err)) <= 0) break;
        if (read_dataset(&r, number_in_line(r.k.d.line), err)) goto done;
    }
    if (more == 0) rc = fl_beam_deck_finish(&r.k, s, err);
done:
    fl_beam_deck_free(&r.k);
    return rc;
}
