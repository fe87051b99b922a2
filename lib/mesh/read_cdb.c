/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/mem.h"
#include "base/num.h"
#include "mesh/deck.h"
#include "mesh/elements.h"
#include "mesh/read_cdb.h"

enum {
    FIELDS = 64, /* columns of a row, words of a command */
    WIDTH = 80,  /* characters of a column */
    NODES = 40,  /* of an element, those that have no meaning for its shape with it */
    BODY = 11,   /* columns of a row of EBLOCK,,SOLID before the nodes */
    BARE = 5     /* the same without SOLID */
};

/* What a routine makes of its nodes. */
typedef enum { NONE, SOLID, BRICK, SHELL, LINE, CURVE, MESH } family; /* BRICK: always of 20 nodes */

static const struct {
    int16_t routine;
    uint8_t is;
} ROUTINE[] = {
    {1, LINE},    {2, SHELL},   {3, LINE},    {4, LINE},    {5, SOLID},   {8, LINE},    {9, LINE},
    {10, LINE},   {13, SHELL},  {16, LINE},   {20, LINE},   {23, LINE},   {24, LINE},   {25, SHELL},
    {28, SHELL},  {35, SHELL},  {41, SHELL},  {42, SHELL},  {43, SHELL},  {44, LINE},   {45, SOLID},
    {46, SOLID},  {55, SHELL},  {57, SHELL},  {59, LINE},   {62, SOLID},  {63, SHELL},  {64, SOLID},
    {65, SOLID},  {69, SOLID},  {70, SOLID},  {72, SOLID},  {73, SOLID},  {75, SHELL},  {77, SHELL},
    {78, SHELL},  {82, SHELL},  {83, SHELL},  {87, SOLID},  {90, BRICK},  {91, SHELL},  {92, SOLID},
    {93, SHELL},  {95, BRICK},  {96, SOLID},  {97, SOLID},  {98, SOLID},  {99, SHELL},  {122, BRICK},
    {123, SOLID}, {127, SOLID}, {128, BRICK}, {131, SHELL}, {132, SHELL}, {143, SHELL}, {147, BRICK},
    {148, SOLID}, {150, SHELL}, {157, SHELL}, {164, SOLID}, {163, SHELL}, {168, SOLID}, {180, LINE},
    {181, SHELL}, {182, SHELL}, {183, SHELL}, {185, SOLID}, {186, BRICK}, {187, SOLID}, {188, LINE},
    {189, CURVE}, {190, SOLID}, {191, BRICK}, {200, MESH},  {223, SHELL}, {226, BRICK}, {227, SOLID},
    {231, BRICK}, {232, SOLID}, {236, BRICK}, {237, SOLID}, {239, BRICK}, {240, SOLID}, {278, SOLID},
    {279, BRICK}, {281, SHELL}, {285, SOLID}, {288, LINE},  {289, CURVE}, {290, CURVE}, {291, SOLID},
};

/* MESH200 is what its first key option says. */
static const uint8_t MESH200[] = {LINE,  CURVE, LINE,  CURVE, SHELL, SHELL,
                                  SHELL, SHELL, SOLID, SOLID, SOLID, SOLID};

/* The columns of a FORTRAN format. */
typedef struct {
    int n, start[FIELDS], width[FIELDS];
    char real[FIELDS];
    int whole; /* whole numbers before the first real one */
} format;

/* Something of an element that later commands may yet define. */
typedef struct {
    int32_t element;
    int32_t routine;
    int64_t section, real;
} line_element;

typedef struct {
    int64_t lo, hi;
    int32_t set;
} range;

typedef struct {
    fl_elements e;
    fl_deck d;
    int32_t part;           /* of what is in no component */
    fl_numbers slot;        /* of element types */
    int32_t *routine, *key; /* [slot.n] */
    fl_numbers radius_of;   /* scope 0: sections, 1: real constants */
    double *radius;         /* [radius_of.n] 0 for none */
    fl_names parameter;     /* of *SET */
    int64_t *value;         /* [parameter.n] */
    line_element *line;     /* [lines] */
    range *in;              /* [ranges] of components of elements */
    char *word[FIELDS];     /* of the command at hand, none NULL */
    char of_type[WIDTH];    /* type and subtype of the section at hand */
    char of_subtype[WIDTH];
    int64_t type, real, section, of; /* what TYPE, REAL, SECNUM and SECTYPE said last */
    int64_t node[NODES], made;       /* nodes, and number, of the element that EMORE would go on with */
    int32_t nodes, made_line, system;
    int32_t lines, ranges, node_sets, unread;
    int32_t routine_cap, key_cap, radius_cap, value_cap, line_cap, range_cap;
} cdb;

static int command_at(const char *p, const char *word)
{
    const size_t n = strlen(word);
    p += strspn(p, " \t");
    return strncasecmp(p, word, n) == 0 && (p[n] == ',' || p[n] == ' ' || p[n] == '\t');
}

int fl_cdb_is(const fl_bytes *b)
{
    for (const char *p = b->data; *p;) {
        if (command_at(p, "NBLOCK") || command_at(p, "EBLOCK")) return 1;
        p += strcspn(p, "\r\n");
        p += strspn(p, "\r\n");
    }
    return 0;
}

/* --- columns -------------------------------------------------------------------------------------------- */

/* Read "(3i9,6e21.13e3)": so many columns of that width, each. */
static int read_format(cdb *c, format *f, fl_err *err)
{
    const char *p;
    int at = 0;
    *f = (format){0};
    const int more = fl_deck_line(&c->d, err);
    if (more < 0) return -1;
    if (more == 0) return fl_deck_fail(&c->d, err, "the file ends where a format line was wanted");
    p = c->d.line + strspn(c->d.line, " \t");
    if (*p++ != '(') goto bad;
    while (*p && *p != ')') {
        char *end;
        long count = 1, width;
        char kind;
        p += strspn(p, " \t,");
        if (*p >= '0' && *p <= '9') {
            count = strtol(p, &end, 10);
            p = end;
        }
        kind = (char)(*p | 32);
        if (!*p || !strchr("iefdgax", kind)) goto bad;
        p++;
        if (kind == 'x') {
            if (count < 1 || count > WIDTH) goto bad;
            at += (int)count;
            continue;
        }
        if (*p < '1' || *p > '9') goto bad;
        width = strtol(p, &end, 10);
        p = end + strspn(end, ".0123456789eE");
        if (count < 1 || count > FIELDS - f->n || width >= WIDTH) goto bad;
        for (long k = 0; k < count; k++, at += (int)width) {
            if (kind == 'i' && f->whole == f->n) f->whole++;
            f->real[f->n] = kind != 'i';
            f->start[f->n] = at;
            f->width[f->n++] = (int)width;
        }
        p += strspn(p, " \t,");
    }
    if (f->n && *p == ')') return 0;
bad:
    return fl_deck_fail(&c->d, err, "\"%.60s\" was found, a format like (3i9,6e21.13) was wanted", c->d.line);
}

/* Column k of the line, without the blanks about it; "" when the line is too short. */
static const char *column(const cdb *c, const format *f, int k, char text[WIDTH])
{
    const size_t len = strlen(c->d.line), start = (size_t)f->start[k];
    size_t n = (size_t)f->width[k];
    if (start >= len) return "";
    if (n > len - start) n = len - start;
    memcpy(text, c->d.line + start, n);
    text[n] = '\0';
    return fl_deck_trim(text);
}

static int whole_at(cdb *c, const format *f, int k, int64_t *x, fl_err *err)
{
    char text[WIDTH];
    const char *p = column(c, f, k, text);
    *x = 0;
    if (*p == '\0' || fl_deck_whole(p, x) == 0) return 0;
    return fl_deck_fail(&c->d, err, "column %d is \"%.40s\", a whole number was wanted", k + 1, p);
}

static int real_at(cdb *c, const format *f, int k, double *x, fl_err *err)
{
    char text[WIDTH];
    const char *p = k < f->n ? column(c, f, k, text) : "";
    *x = 0.0;
    if (*p == '\0' || fl_deck_real(p, x) == 0) return 0;
    return fl_deck_fail(&c->d, err, "column %d is \"%.40s\", a finite number was wanted", k + 1, p);
}

/* Next row of a block: 1, or 0 at its end, which is a row of -1 or any command; that is left for later unless
 * it is the N,R5.3,LOC,-1 that ends an NBLOCK.  A block that just stops was cut off. */
static int block_row(cdb *c, const char *block, fl_err *err)
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
        if (strncasecmp(p, "N,", 2) != 0) fl_deck_hold(&c->d);
        return 0;
    }
}

/* --- what stays for later ------------------------------------------------------------------------------- */

static int set_type(cdb *c, int64_t slot, int32_t routine, fl_err *err)
{
    const int32_t k = fl_numbers_add(&c->slot, 0, slot, err);
    if (k < 0 || fl_grow(&c->routine, &c->routine_cap, c->slot.n, sizeof *c->routine, err) ||
        fl_grow(&c->key, &c->key_cap, c->slot.n, sizeof *c->key, err))
        return -1;
    c->routine[k] = routine;
    c->key[k] = 0;
    return 0;
}

static int set_radius(cdb *c, int32_t scope, int64_t id, double r, fl_err *err)
{
    const int32_t k = fl_numbers_add(&c->radius_of, scope, id, err);
    if (k < 0 || fl_grow(&c->radius, &c->radius_cap, c->radius_of.n, sizeof *c->radius, err)) return -1;
    c->radius[k] = r > 0.0 ? r : 0.0;
    return 0;
}

static int set_parameter(cdb *c, const char *name, const char *text, fl_err *err)
{
    int64_t x;
    int32_t k;
    if (*name == '\0' || fl_deck_whole(text, &x))
        return 0; /* not a number that could stand for another one */
    k = fl_names_add(&c->parameter, name, err);
    if (k < 0 || fl_grow(&c->value, &c->value_cap, c->parameter.n, sizeof *c->value, err)) return -1;
    c->value[k] = x;
    return 0;
}

/* A word as a number, or as the parameter of that name.  0, or -1. */
static int number(const cdb *c, const char *word, int64_t *x)
{
    double y;
    int32_t k;
    if (fl_deck_whole(word, x) == 0) return 0;
    if (fl_deck_real(word, &y) == 0 && y >= 0.0 && y < 1e9 && (double)(int64_t)y == y) {
        *x = (int64_t)y; /* "1.": a whole number all the same */
        return 0;
    }
    k = fl_names_find(&c->parameter, word);
    if (k < 0) return -1;
    *x = c->value[k];
    return 0;
}

/* --- elements ------------------------------------------------------------------------------------------- */

/* The shape of n nodes that make a solid or a shell, -1 for none.  Nodes that are left out at the end are
 * those in the middle of edges. */
static int solid_of(int n)
{
    if (n == 4) return FL_TET4;
    if (n == 5) return FL_PYRAMID5;
    if (n == 6) return FL_WEDGE6;
    if (n == 8) return FL_HEX8;
    if (n == 10) return FL_TET10;
    if (n == 13) return FL_PYRAMID13;
    if (n == 15) return FL_WEDGE15;
    return n > 8 ? FL_HEX20 : -1;
}

static int shell_of(int n)
{
    if (n == 3) return FL_TRI3;
    if (n == 4) return FL_QUAD4;
    if (n == 6) return FL_TRI6;
    return n > 4 ? FL_QUAD8 : -1;
}

static family family_of(int32_t routine, int32_t key)
{
    for (size_t k = 0; k < sizeof ROUTINE / sizeof ROUTINE[0]; k++)
        if (ROUTINE[k].routine == routine) {
            if (ROUTINE[k].is != MESH) return (family)ROUTINE[k].is;
            return key >= 0 && key < (int32_t)sizeof MESH200 ? (family)MESH200[key] : NONE;
        }
    return NONE;
}

static int remember_line(cdb *c, int32_t element, int32_t routine, int64_t section, int64_t real, fl_err *err)
{
    if (fl_grow(&c->line, &c->line_cap, (int64_t)c->lines + 1, sizeof *c->line, err)) return -1;
    c->line[c->lines++] = (line_element){element, routine, section, real};
    return 0;
}

/* Add the element of c->node[0 .. c->nodes). */
static int add(cdb *c, int64_t id, int64_t type, int64_t section, int64_t real, fl_err *err)
{
    const int32_t slot = fl_numbers_find(&c->slot, 0, type);
    const int n = c->nodes;
    char name[32];
    family is;
    int shape = -1;
    int32_t k;
    if (slot < 0)
        return fl_deck_fail(&c->d, err, "element %lld is of type %lld, which no ET or ETBLOCK defines",
                            (long long)id, (long long)type);
    is = family_of(c->routine[slot], c->key[slot]);
    if (is == NONE) {
        snprintf(name, sizeof name, "routine %d", c->routine[slot]);
        return fl_elements_skip(&c->e, name, err);
    }
    if (is == SOLID || is == BRICK) shape = solid_of(n);
    if (is == SHELL) shape = shell_of(n);
    if (is == LINE && n >= 2) shape = FL_LINE2;
    if (is == CURVE && n >= 2) shape = n > 2 ? FL_LINE3 : FL_LINE2;
    if (shape < 0)
        return fl_deck_fail(&c->d, err, "element %lld of routine %d has %d nodes, more were wanted",
                            (long long)id, c->routine[slot], n);
    for (int i = n; i < NODES; i++) c->node[i] = 0;
    k = fl_elements_add(&c->e, 0, id, (enum fl_shape)shape, c->part, c->node, err);
    if (k < 0) return -1;
    return is == LINE || is == CURVE ? remember_line(c, k, c->routine[slot], section, real, err) : 0;
}

/* --- blocks --------------------------------------------------------------------------------------------- */

/* Say so when a block does not hold what its head promised. */
static void compare(cdb *c, const char *block, const char *promise, int64_t n)
{
    int64_t x;
    if (fl_deck_whole(promise, &x) == 0 && x > 0 && x != n)
        fl_bytes_note(c->d.base, "%s is to hold %lld entries, and has %lld", block, (long long)x,
                      (long long)n);
}

static int read_nblock(cdb *c, fl_err *err)
{
    const char *promise = c->word[4];
    format f;
    int64_t n = 0;
    int more;
    if (read_format(c, &f, err)) return -1;
    if (f.whole < 1 || f.whole == f.n)
        return fl_deck_fail(&c->d, err, "a format of whole numbers and then reals was wanted for nodes");
    while ((more = block_row(c, "NBLOCK", err)) > 0) {
        int64_t id;
        fl_vec3 x;
        if (whole_at(c, &f, 0, &id, err) || real_at(c, &f, f.whole, &x.x, err) ||
            real_at(c, &f, f.whole + 1, &x.y, err) || real_at(c, &f, f.whole + 2, &x.z, err))
            return -1;
        if (id == -1) break;
        if (id < 1)
            return fl_deck_fail(&c->d, err, "node %lld was found, a number of 1 or more was wanted",
                                (long long)id);
        if (fl_elements_node(&c->e, 0, id, x, err) < 0) return -1;
        n++;
    }
    if (more < 0) return -1;
    compare(c, "NBLOCK", promise, n);
    return 0;
}

/* The nodes of a row from column `from` on, as many as are wanted (as are there, when want < 0). */
static int take_nodes(cdb *c, const format *f, int from, int64_t want, fl_err *err)
{
    char text[WIDTH];
    for (int k = from; k < f->n && (want < 0 || c->nodes < want); k++) {
        if (want < 0 && *column(c, f, k, text) == '\0') break;
        if (c->nodes == NODES) return fl_deck_fail(&c->d, err, "more than %d nodes in an element", NODES);
        if (whole_at(c, f, k, &c->node[c->nodes], err)) return -1;
        c->nodes++;
    }
    return 0;
}

/* Go on with the nodes of an element in the rows that follow. */
static int more_nodes(cdb *c, const format *f, int64_t id, int64_t want, fl_err *err)
{
    while (c->nodes < want) {
        const int more = fl_deck_line(&c->d, err);
        const char *p = more > 0 ? c->d.line + strspn(c->d.line, " \t") : "";
        if (more < 0) return -1;
        if (more == 0 || (*p && !strchr("0123456789+-", *p)))
            return fl_deck_fail(&c->d, err, "element %lld ends after %d of its %lld nodes", (long long)id,
                                c->nodes, (long long)want);
        if (take_nodes(c, f, 0, want, err)) return -1;
    }
    return 0;
}

static int read_solid_row(cdb *c, const format *f, fl_err *err)
{
    int64_t col[BODY];
    int32_t line;
    for (int k = 0; k < BODY; k++)
        if (whole_at(c, f, k, &col[k], err)) return -1;
    if (col[8] < 1 || col[8] > NODES || col[10] < 1)
        return fl_deck_fail(&c->d, err,
                            "element %lld of %lld nodes was found, a number of 1 or more and 1 to %d nodes "
                            "were wanted",
                            (long long)col[10], (long long)col[8], NODES);
    line = c->e.line;
    if (take_nodes(c, f, BODY, col[8], err) || more_nodes(c, f, col[10], col[8], err)) return -1;
    c->e.line = line;
    return add(c, col[10], col[1], col[3], col[2], err);
}

/* Without the key SOLID nothing says how many nodes there are: those of a row, and of the next one for a
 * brick of 20. */
static int read_bare_row(cdb *c, const format *f, fl_err *err)
{
    int64_t col[BARE];
    int32_t slot, line;
    for (int k = 0; k < BARE; k++)
        if (whole_at(c, f, k, &col[k], err)) return -1;
    if (col[0] < 1)
        return fl_deck_fail(&c->d, err, "element %lld was found, a number of 1 or more was wanted",
                            (long long)col[0]);
    line = c->e.line;
    slot = fl_numbers_find(&c->slot, 0, col[1]);
    if (take_nodes(c, f, BARE, -1, err)) return -1;
    if (slot >= 0 && family_of(c->routine[slot], c->key[slot]) == BRICK && more_nodes(c, f, col[0], 20, err))
        return -1;
    c->e.line = line;
    return add(c, col[0], col[1], col[1], col[2], err);
}

static int read_eblock(cdb *c, fl_err *err)
{
    const int solid = strcasecmp(c->word[2], "SOLID") == 0;
    const char *promise = c->word[4];
    format f;
    int64_t n = 0;
    int more;
    if (read_format(c, &f, err)) return -1;
    if (f.whole != f.n || f.n <= (solid ? BODY : BARE))
        return fl_deck_fail(&c->d, err, "a format of more than %d whole numbers was wanted for elements",
                            solid ? BODY : BARE);
    while ((more = block_row(c, "EBLOCK", err)) > 0) {
        int64_t first;
        if (whole_at(c, &f, 0, &first, err)) return -1;
        if (first == -1) break;
        c->nodes = 0;
        if (solid ? read_solid_row(c, &f, err) : read_bare_row(c, &f, err)) return -1;
        n++;
    }
    if (more < 0) return -1;
    c->nodes = 0; /* no EMORE goes on with these */
    compare(c, "EBLOCK", promise, n);
    return 0;
}

static int read_etblock(cdb *c, fl_err *err)
{
    format f;
    int more;
    if (read_format(c, &f, err)) return -1;
    if (f.whole < 2)
        return fl_deck_fail(&c->d, err, "a format of whole numbers was wanted for element types");
    while ((more = block_row(c, "ETBLOCK", err)) > 0) {
        char text[WIDTH];
        int64_t slot, routine, key = 0;
        if (whole_at(c, &f, 0, &slot, err)) return -1;
        if (slot == -1) break;
        if (whole_at(c, &f, 1, &routine, err)) return -1;
        if (f.n > 2 && fl_deck_whole(column(c, &f, 2, text), &key))
            key = 0; /* text columns: it may be a word */
        if (slot < 1 || routine < 0 || routine > INT16_MAX || key < 0 || key > INT16_MAX)
            return fl_deck_fail(&c->d, err, "type %lld of routine %lld was found", (long long)slot,
                                (long long)routine);
        if (set_type(c, slot, (int32_t)routine, err)) return -1;
        c->key[fl_numbers_find(&c->slot, 0, slot)] = (int32_t)key;
    }
    return more < 0 ? -1 : 0;
}

/* Rows of numbers without an end mark: 1, or 0 at the next command or the end of the file. */
static int free_row(cdb *c, fl_err *err)
{
    for (;;) {
        const int more = fl_deck_line(&c->d, err);
        const char *p = more > 0 ? c->d.line + strspn(c->d.line, " \t\f\v") : "";
        if (more <= 0) return more;
        if (*p == '\0') continue;
        if (strchr("0123456789+-.", *p)) return 1;
        fl_deck_hold(&c->d);
        return 0;
    }
}

/* Real constants: number, count and up to six values; seven in the rows that follow. */
static int read_rlblock(cdb *c, fl_err *err)
{
    format head, tail;
    int more;
    if (read_format(c, &head, err)) return -1;
    if (head.whole != 2 || head.n < 3)
        return fl_deck_fail(&c->d, err, "a format like (2i8,6g16.9) was wanted for real constants");
    if (read_format(c, &tail, err)) return -1;
    while ((more = free_row(c, err)) > 0) {
        int64_t id, n;
        double first;
        if (whole_at(c, &head, 0, &id, err) || whole_at(c, &head, 1, &n, err) ||
            real_at(c, &head, 2, &first, err) || set_radius(c, 1, id, 0.5 * first, err))
            return -1;
        for (n -= head.n - 2; n > 0; n -= tail.n) {
            more = free_row(c, err);
            if (more < 0) return -1;
            if (more == 0)
                return fl_deck_fail(&c->d, err, "real constants %lld end with %lld values missing",
                                    (long long)id, (long long)n);
        }
    }
    return more;
}

static int add_range(cdb *c, int32_t set, int64_t lo, int64_t hi, fl_err *err)
{
    if (fl_grow(&c->in, &c->range_cap, (int64_t)c->ranges + 1, sizeof *c->in, err)) return -1;
    c->in[c->ranges++] = (range){lo, hi, set};
    return 0;
}

/* A component: numbers, of which a negative one ends the range that the one before began. */
static int read_cmblock(cdb *c, fl_err *err)
{
    const int elements = strncasecmp(c->word[2], "ELEM", 4) == 0;
    const char *promise = c->word[3], *name = c->word[1];
    int64_t last = 0, n = 0, x;
    int32_t set = -1;
    format f;
    int more;
    if (!elements && strncasecmp(c->word[2], "NODE", 4) != 0)
        return fl_deck_fail(&c->d, err, "a component of \"%.40s\" was found, ELEM or NODE was wanted",
                            c->word[2]);
    if (*name == '\0') return fl_deck_fail(&c->d, err, "the component has no name");
    c->node_sets += !elements;
    if (elements && (set = fl_names_add(&c->e.sets, name, err)) < 0) return -1;
    if (read_format(c, &f, err)) return -1;
    if (f.whole != f.n)
        return fl_deck_fail(&c->d, err, "a format of whole numbers was wanted for a component");
    while ((more = free_row(c, err)) > 0) {
        char text[WIDTH];
        for (int k = 0; k < f.n; k++) {
            if (*column(c, &f, k, text) == '\0') break;
            if (whole_at(c, &f, k, &x, err)) return -1;
            if (x == 0 || (x < 0 && (last <= 0 || -x < last)))
                return fl_deck_fail(&c->d, err,
                                    "%lld was found after %lld, a number above 0 or the end of a "
                                    "range was wanted",
                                    (long long)x, (long long)last);
            n++;
            if (elements && x > 0 && add_range(c, set, x, x, err)) return -1;
            if (elements && x < 0) c->in[c->ranges - 1].hi = -x;
            last = x;
        }
    }
    if (more < 0) return -1;
    compare(c, "CMBLOCK", promise, n);
    return 0;
}

/* --- commands ------------------------------------------------------------------------------------------- */

/* ET,slot,routine with the routine as a number or as a name that ends in it. */
static int read_et(cdb *c, fl_err *err)
{
    const char *r = c->word[2] + strcspn(c->word[2], "0123456789");
    int64_t slot;
    int32_t routine;
    if (number(c, c->word[1], &slot) || slot < 1) {
        c->unread++;
        return 0;
    }
    if (*c->word[2] == '\0' || strcmp(c->word[2], "0") == 0) return 0; /* the type is taken back */
    if (fl_num_i32(r, 0, INT16_MAX, &routine))
        return fl_deck_fail(&c->d, err, "element type \"%.40s\" was found, a routine like 185 was wanted",
                            c->word[2]);
    return set_type(c, slot, routine, err);
}

static void read_keyopt(cdb *c)
{
    int64_t slot, which, value;
    if (number(c, c->word[1], &slot) || number(c, c->word[2], &which) || number(c, c->word[3], &value))
        return;
    const int32_t k = fl_numbers_find(&c->slot, 0, slot);
    if (k >= 0 && which == 1 && value >= 0 && value < INT16_MAX) c->key[k] = (int32_t)value;
}

static int read_sectype(cdb *c)
{
    if (number(c, c->word[1], &c->of)) c->of = 0;
    snprintf(c->of_type, sizeof c->of_type, "%s", c->word[2]);
    snprintf(c->of_subtype, sizeof c->of_subtype, "%s", c->word[3]);
    return 0;
}

/* SECDATA of a pipe is its outer diameter and wall, of a tube its radii, of a rod its radius. */
static int read_secdata(cdb *c, fl_err *err)
{
    double x[2] = {0.0, 0.0};
    for (int k = 0; k < 2; k++)
        if (*c->word[k + 1] && fl_deck_real(c->word[k + 1], &x[k])) return 0;
    if (c->of < 1) return 0;
    if (strncasecmp(c->of_type, "PIPE", 4) == 0) return set_radius(c, 0, c->of, 0.5 * x[0], err);
    if (strncasecmp(c->of_type, "BEAM", 4) != 0) return 0;
    if (strncasecmp(c->of_subtype, "CTUB", 4) == 0) return set_radius(c, 0, c->of, x[1], err);
    if (strncasecmp(c->of_subtype, "CSOL", 4) == 0) return set_radius(c, 0, c->of, x[0], err);
    return 0;
}

static int read_r(cdb *c, fl_err *err)
{
    int64_t id;
    double x = 0.0;
    if (number(c, c->word[1], &id) || (*c->word[2] && fl_deck_real(c->word[2], &x))) return 0;
    return set_radius(c, 1, id, 0.5 * x, err);
}

static int unblocked(cdb *c, fl_err *err)
{
    return fl_deck_fail(&c->d, err,
                        "%s,%.20s is of the unblocked format: write the archive with CDWRITE,DB,,,,,,BLOCKED",
                        c->word[0], c->word[1]);
}

static int read_n(cdb *c, fl_err *err)
{
    int64_t id;
    fl_vec3 x = {0};
    double *const at[3] = {&x.x, &x.y, &x.z};
    if (strncasecmp(c->word[1], "R5", 2) == 0) {
        if (strcmp(c->word[3], "-1") == 0) return 0; /* it ends the NBLOCK before */
        return unblocked(c, err);
    }
    if (number(c, c->word[1], &id) || id < 1) {
        c->unread++;
        return 0;
    }
    for (int k = 0; k < 3; k++)
        if (*c->word[k + 2] && fl_deck_real(c->word[k + 2], at[k])) {
            c->unread++;
            return 0;
        }
    if (c->system)
        return fl_deck_fail(&c->d, err, "node %lld is in coordinate system %d: write the nodes as NBLOCK",
                            (long long)id, c->system);
    return fl_elements_node(&c->e, 0, id, x, err) < 0 ? -1 : 0;
}

/* The element that E, EN and EMORE have been giving nodes to is complete. */
static int finish(cdb *c, fl_err *err)
{
    const int32_t line = c->e.line;
    int rc;
    if (c->nodes == 0) return 0;
    c->e.line = c->made_line;
    rc = add(c, c->made, c->type, c->section, c->real, err);
    c->e.line = line;
    c->nodes = 0;
    return rc;
}

static int read_e(cdb *c, int numbered, fl_err *err)
{
    const int from = numbered ? 2 : 1;
    int64_t id = -1;
    if (numbered && strncasecmp(c->word[1], "R5", 2) == 0) return unblocked(c, err);
    if (numbered && (number(c, c->word[1], &id) || id < 1)) {
        c->unread++;
        return 0;
    }
    for (int k = from; k < from + 8 && *c->word[k]; k++)
        if (number(c, c->word[k], &c->node[c->nodes++])) {
            c->nodes = 0;
            c->unread++;
            return 0;
        }
    c->made = id;
    c->made_line = c->e.line;
    return 0;
}

static int read_emore(cdb *c, fl_err *err)
{
    if (c->nodes == 0) return 0; /* goes on with an element that was passed over */
    while (c->nodes % 8) c->node[c->nodes++] = 0;
    for (int k = 1; k <= 8 && *c->word[k]; k++) {
        if (c->nodes == NODES) return fl_deck_fail(&c->d, err, "more than %d nodes in an element", NODES);
        if (number(c, c->word[k], &c->node[c->nodes++]))
            return fl_deck_fail(&c->d, err, "node \"%.40s\" was found, a number was wanted", c->word[k]);
    }
    return 0;
}

/* Cut the line at its commas; the words that are missing are empty. */
static void cut(cdb *c)
{
    static char none[1];
    char *p = c->d.line, *end = strchr(p, '!');
    int n = 0;
    if (end) *end = '\0';
    for (; p && n < FIELDS; p = end) {
        end = strchr(p, ',');
        if (end) *end++ = '\0';
        c->word[n++] = fl_deck_trim(p);
    }
    while (n < FIELDS) c->word[n++] = none;
}

static int is(const cdb *c, const char *word) { return strcasecmp(c->word[0], word) == 0; }

static int remember(cdb *c, int64_t *x, int k)
{
    if (number(c, c->word[k], x)) c->unread++;
    return 0;
}

static int obey(cdb *c, fl_err *err)
{
    char *equals;
    if (!is(c, "EMORE") && finish(c, err)) return -1;
    if (is(c, "NBLOCK")) return read_nblock(c, err);
    if (is(c, "EBLOCK")) return read_eblock(c, err);
    if (is(c, "CMBLOCK")) return read_cmblock(c, err);
    if (is(c, "ETBLOCK")) return read_etblock(c, err);
    if (is(c, "RLBLOCK")) return read_rlblock(c, err);
    if (is(c, "ET")) return read_et(c, err);
    if (is(c, "R")) return read_r(c, err);
    if (is(c, "SECTYPE")) return read_sectype(c);
    if (is(c, "SECDATA")) return read_secdata(c, err);
    if (is(c, "TYPE")) return remember(c, &c->type, 1);
    if (is(c, "REAL")) return remember(c, &c->real, 1);
    if (is(c, "SECNUM")) return remember(c, &c->section, 1);
    if (is(c, "N")) return read_n(c, err);
    if (is(c, "E")) return read_e(c, 0, err);
    if (is(c, "EN")) return read_e(c, 1, err);
    if (is(c, "EMORE")) return read_emore(c, err);
    if (is(c, "*SET")) return set_parameter(c, c->word[1], c->word[2], err);
    if (is(c, "/INPUT"))
        return fl_deck_fail(&c->d, err, "/INPUT is not followed: put \"%.60s\" into the archive", c->word[1]);
    if (is(c, "KEYOPT")) read_keyopt(c);
    if (is(c, "CSYS") || is(c, "LOCAL")) {
        int64_t k = 1;
        c->system = number(c, c->word[1], &k) || k != 0 ? (int32_t)(k > 0 && k < INT32_MAX ? k : 1) : 0;
    }
    equals = strchr(c->word[0], '=');
    if (equals) {
        *equals = '\0';
        return set_parameter(c, fl_deck_trim(c->word[0]), fl_deck_trim(equals + 1), err);
    }
    return 0;
}

/* --- the end -------------------------------------------------------------------------------------------- */

static int give_radii(cdb *c, fl_err *err)
{
    for (int32_t i = 0; i < c->lines; i++) {
        const line_element *l = &c->line[i];
        const int by_real = l->routine == 16 || l->routine == 20 || l->routine == 59;
        const int32_t k = fl_numbers_find(&c->radius_of, by_real, by_real ? l->real : l->section);
        const int sectioned =
            l->routine == 188 || l->routine == 189 || (l->routine >= 288 && l->routine <= 290);
        if (k < 0 || !(by_real || sectioned) || !(c->radius[k] > 0.0)) continue;
        if (fl_elements_radius(&c->e, l->element, c->radius[k], c->radius[k], err)) return -1;
    }
    return 0;
}

static int by_set(const void *pa, const void *pb)
{
    const range *a = pa, *b = pb;
    if (a->set != b->set) return a->set < b->set ? -1 : 1;
    if (a->lo != b->lo) return a->lo < b->lo ? -1 : 1;
    return a->hi < b->hi ? -1 : a->hi > b->hi;
}

typedef struct {
    int64_t id;
    int32_t element;
} numbered;

static int by_id(const void *pa, const void *pb)
{
    const numbered *a = pa, *b = pb;
    return a->id < b->id ? -1 : a->id > b->id;
}

/* Ranges of one component that overlap become one, so that it holds an element once. */
static void merge_ranges(cdb *c)
{
    int32_t n = 0;
    if (c->ranges == 0) return;
    qsort(c->in, (size_t)c->ranges, sizeof *c->in, by_set);
    for (int32_t i = 1; i < c->ranges; i++) {
        range *last = &c->in[n];
        if (c->in[i].set == last->set && c->in[i].lo <= last->hi + 1) {
            if (c->in[i].hi > last->hi) last->hi = c->in[i].hi;
        } else {
            c->in[++n] = c->in[i];
        }
    }
    c->ranges = n + 1;
}

/* First of the sorted numbers that is not below id. */
static int32_t lower(const numbered *at, int32_t n, int64_t id)
{
    int32_t lo = 0, hi = n;
    while (lo < hi) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (at[mid].id < id) lo = mid + 1;
        else hi = mid;
    }
    return lo;
}

/* Give each element to the smallest component that holds it, the first of equals; with picks, let each
 * component be a set too. */
static int share_out(cdb *c, const numbered *at, int32_t n, int picks, fl_err *err)
{
    const int32_t sets = c->e.sets.n;
    int64_t *size = fl_alloc(sets, sizeof *size, err);
    int32_t *best = fl_alloc(c->e.number.n, sizeof *best, err); /* set plus one */
    int rc = -1;
    if (!size || !best) goto done;
    for (int pass = 0; pass < 2; pass++)
        for (int32_t i = 0; i < c->ranges; i++) {
            const range *r = &c->in[i];
            for (int32_t k = lower(at, n, r->lo); k < n && at[k].id <= r->hi; k++) {
                int32_t *b = &best[at[k].element];
                if (pass == 0) size[r->set]++;
                else if (*b == 0 || size[r->set] < size[*b - 1]) *b = r->set + 1;
                if (pass && picks &&
                    fl_elements_pick(&c->e, (fl_pick){at[k].element, r->set, FL_PICK_WHOLE, 0}, err))
                    goto done;
            }
        }
    for (int32_t i = 0; i < c->e.number.n; i++) {
        int32_t part;
        if (best[i] == 0) continue;
        part = fl_names_add(&c->e.parts, c->e.sets.name[best[i] - 1], err);
        if (part < 0) goto done;
        c->e.element[i].part = part;
    }
    rc = 0;
done:
    free(size);
    free(best);
    return rc;
}

static int components(cdb *c, int picks, fl_err *err)
{
    numbered *at;
    int32_t n = 0;
    int rc;
    if (c->ranges == 0) return 0;
    at = fl_alloc(c->e.number.n, sizeof *at, err);
    if (!at) return -1;
    merge_ranges(c);
    for (int32_t i = 0; i < c->e.number.n; i++)
        if (c->e.number.scope[i] == 0) at[n++] = (numbered){c->e.number.id[i], i};
    qsort(at, (size_t)n, sizeof *at, by_id);
    rc = share_out(c, at, n, picks, err);
    free(at);
    return rc;
}

static int read_all(cdb *c, fl_err *err)
{
    int more;
    while ((more = fl_deck_line(&c->d, err)) > 0) {
        cut(c);
        if (c->word[0][0] == '\0') continue;
        if (obey(c, err)) return -1;
    }
    return more < 0 || finish(c, err) ? -1 : 0;
}

int fl_cdb_read(fl_surface *s, fl_bytes *b, const char *name, fl_wish *w, fl_err *err)
{
    cdb c = {.type = 1, .real = 1, .section = 1};
    int rc = -1;
    if (fl_elements_start(&c.e, fl_in_name(b->in), err)) return -1;
    fl_deck_start(&c.d, &c.e, b);
    c.part = fl_names_add(&c.e.parts, name, err);
    if (c.part < 0 || read_all(&c, err) || give_radii(&c, err) || components(&c, fl_wish_chooses(w), err))
        goto done;
    if (c.node_sets) fl_bytes_note(b, "%d components of nodes were passed over", c.node_sets);
    if (c.unread)
        fl_bytes_note(b, "%d commands with parameters that are not numbers were passed over", c.unread);
    rc = fl_elements_surface(&c.e, s, b, w, err);
done:
    fl_deck_end(&c.d);
    fl_elements_free(&c.e);
    fl_numbers_free(&c.slot);
    fl_numbers_free(&c.radius_of);
    fl_names_free(&c.parameter);
    free(c.routine);
    free(c.key);
    free(c.radius);
    free(c.value);
    free(c.line);
    free(c.in);
    return rc;
}
