/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "mesh/deck_lines.h"
#include "mesh/element_surface.h"
#include "mesh/read_msh.h"

enum { NODES = 125, TYPES = 94, DIMS = 4 };

/* Element types of Gmsh: dimension, shape, number of nodes, and the order of the nodes of that shape; NULL if
 * they are the first ones in order. */
static const struct {
    int8_t dim, shape;
    uint8_t nodes;
    const int8_t *at;
} TYPE[TYPES] = {
#define AT(...)                                                                                              \
    (const int8_t[]) { __VA_ARGS__ }
    [1] = {1, FL_LINE2, 2, NULL},
    [2] = {2, FL_TRI3, 3, NULL},
    [3] = {2, FL_QUAD4, 4, NULL},
    [4] = {3, FL_TET4, 4, NULL},
    [5] = {3, FL_HEX8, 8, NULL},
    [6] = {3, FL_WEDGE6, 6, NULL},
    [7] = {3, FL_PYRAMID5, 5, NULL},
    [8] = {1, FL_LINE3, 3, NULL},
    [9] = {2, FL_TRI6, 6, NULL},
    [10] = {2, FL_QUAD9, 9, NULL},
    [11] = {3, FL_TET10, 10, AT(0, 1, 2, 3, 4, 5, 6, 7, 9, 8)},
    [12] = {3, FL_HEX20, 27, AT(0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15)},
    [13] = {3, FL_WEDGE15, 18, AT(0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11)},
    [14] = {3, FL_PYRAMID13, 14, AT(0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12)},
    [15] = {0, FL_SHAPES, 1, NULL},
    [16] = {2, FL_QUAD8, 8, NULL},
    [17] = {3, FL_HEX20, 20, AT(0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15)},
    [18] = {3, FL_WEDGE15, 15, AT(0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11)},
    [19] = {3, FL_PYRAMID13, 13, AT(0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12)},
    [20] = {2, FL_TRI3, 9, NULL},
    [21] = {2, FL_TRI3, 10, NULL},
    [22] = {2, FL_TRI3, 12, NULL},
    [23] = {2, FL_TRI3, 15, NULL},
    [24] = {2, FL_TRI3, 15, NULL},
    [25] = {2, FL_TRI3, 21, NULL},
    [26] = {1, FL_LINE2, 4, NULL},
    [27] = {1, FL_LINE2, 5, NULL},
    [28] = {1, FL_LINE2, 6, NULL},
    [29] = {3, FL_TET4, 20, NULL},
    [30] = {3, FL_TET4, 35, NULL},
    [31] = {3, FL_TET4, 56, NULL},
    [36] = {2, FL_QUAD4, 16, NULL},
    [37] = {2, FL_QUAD4, 25, NULL},
    [38] = {2, FL_QUAD4, 36, NULL},
    [92] = {3, FL_HEX8, 64, NULL},
    [93] = {3, FL_HEX8, 125, NULL},
#undef AT
};

/* An entry of a list of physical groups, and the index of the next entry plus one. */
typedef struct {
    int32_t group, next;
} group_entry;

typedef struct {
    fl_bytes *b;
    fl_elements e;
    int version, binary, swap, wide; /* wide: bytes of a size_t */
    fl_id_map group;                 /* (dimension, physical tag) */
    int32_t *name;                   /* [group.n] index in names, -1 for none */
    fl_string_table names;
    fl_id_map entity; /* (dimension, tag) */
    int32_t *member;  /* [entity.n] index of its first group entry, plus one */
    int32_t *single;  /* [group.n] list of this group alone, as an index plus one; 0 until needed */
    group_entry *in;  /* [members] */
    int32_t *of;      /* [e.element_id.n] list of the groups of an element; 0 for none */
    int64_t *tag;     /* of the nodes of a block */
    int32_t members, coarse;
    int32_t element_line, split_end; /* ASCII: line of the element being read; last line of the one before, if
                                      * it has several */
    int32_t name_cap, member_cap, single_cap, in_cap, of_cap, tag_cap;
} msh_reader;

static const char *skip_space(const fl_bytes *b) { return b->data + strspn(b->data, " \t\r\n"); }

/* The first line that is not blank behind the line at p. */
static const char *second_line(const char *p)
{
    p += strcspn(p, "\r\n");
    return p + strspn(p, " \t\r\n");
}

/* "$NODES" may also be a comment of a Nastran deck: the word alone on its line and what follows it decide. */
int fl_msh_is(const fl_bytes *b)
{
    static const char *const section[] = {"$MeshFormat", "$NOD", "$PhysicalNames"};
    const char *p = skip_space(b), *next = second_line(p);
    const size_t n = strcspn(p, " \t\r\n"), end = n + strspn(p + n, " \t");
    if (p[end] != '\0' && p[end] != '\r' && p[end] != '\n') return 0;
    if (n == 9 && strncmp(p, "$Comments", n) == 0) return strstr(next, "$EndComments") != NULL;
    for (size_t k = 0; k < sizeof section / sizeof section[0]; k++)
        if (n == strlen(section[k]) && strncmp(p, section[k], n) == 0)
            return *next == '\0' || (*next >= '0' && *next <= '9');
    return 0;
}

/* --- numbers, ASCII or binary --------------------------------------------------------------------------- */

static int fail_at_position(const msh_reader *m, fl_err *err, const char *fmt, ...)
    __attribute__((format(printf, 3, 4)));

static int fail_at_position(const msh_reader *m, fl_err *err, const char *fmt, ...)
{
    char what[300];
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(what, sizeof what, fmt, ap);
    va_end(ap);
    if (m->b->line) return fl_bytes_fail(m->b, err, "%s", what);
    return fl_bytes_fail(m->b, err, "byte %lld: %s", (long long)fl_bytes_offset(m->b), what);
}

/* The number of n bytes at p, in the byte order of the file. */
static uint64_t number_at(const msh_reader *m, const unsigned char *p, int n)
{
    uint64_t eight = 0;
    uint32_t four = 0;
    if (n == 8) {
        memcpy(&eight, p, sizeof eight);
        return m->swap ? __builtin_bswap64(eight) : eight;
    }
    memcpy(&four, p, sizeof four);
    return m->swap ? __builtin_bswap32(four) : four;
}

static int check_read(const msh_reader *m, int more, fl_err *err)
{
    return more > 0 ? 0 : more < 0 ? -1 : fail_at_position(m, err, "the file ends inside the data");
}

static int read_bits(msh_reader *m, int n, uint64_t *bits, fl_err *err)
{
    const unsigned char *p = NULL;
    if (check_read(m, fl_bytes_read(m->b, n, &p, err), err)) return -1;
    *bits = number_at(m, p, n);
    return 0;
}

static int read_word(msh_reader *m, const char *what, const char **w, fl_err *err)
{
    const int more = fl_bytes_word(m->b, w, err);
    if (more < 0) return -1;
    return more ? 0 : fail_at_position(m, err, "the file ends where %s is expected", what);
}

/* Read an integer: an int, or with size set a size_t. */
static int read_integer(msh_reader *m, int size, const char *what, int64_t *x, fl_err *err)
{
    const char *w = "";
    uint64_t bits = 0;
    if (m->binary) {
        const int n = size ? m->wide : 4;
        if (read_bits(m, n, &bits, err)) return -1;
        if (n == 4 && !size) *x = (int32_t)(uint32_t)bits;
        else if (bits > INT64_MAX)
            return fail_at_position(m, err, "%s is %llu", what, (unsigned long long)bits);
        else *x = (int64_t)bits;
        return 0;
    }
    if (read_word(m, what, &w, err)) return -1;
    if (fl_deck_integer(w, x) == 0) return 0;
    return fail_at_position(m, err, "%s is \"%.40s\", a whole number is expected", what, w);
}

static int read_int(msh_reader *m, const char *what, int64_t *x, fl_err *err)
{
    return read_integer(m, 0, what, x, err);
}
static int read_size(msh_reader *m, const char *what, int64_t *x, fl_err *err)
{
    return read_integer(m, 1, what, x, err);
}

static int read_real(msh_reader *m, const char *what, double *x, fl_err *err)
{
    uint64_t bits = 0;
    if (!m->binary) return fl_bytes_f64(m->b, what, x, err);
    if (read_bits(m, 8, &bits, err)) return -1;
    memcpy(x, &bits, sizeof *x);
    return 0;
}

/* Skip n numbers. */
static int skip_numbers(msh_reader *m, int is_real, int64_t n, fl_err *err)
{
    int64_t i;
    const char *w = "";
    if (m->binary) {
        const int size = is_real ? 8 : 4;
        if (n < 0 || n > INT64_MAX / size) return fail_at_position(m, err, "the file ends inside the data");
        return check_read(m, fl_bytes_skip(m->b, n * size, err), err);
    }
    for (i = 0; i < n; i++)
        if (read_word(m, "a number", &w, err)) return -1;
    return 0;
}

/* --- groups --------------------------------------------------------------------------------------------- */

static int32_t group_index(msh_reader *m, int dim, int64_t tag, fl_err *err)
{
    const int32_t had = m->group.n, k = fl_id_map_add(&m->group, dim, tag, err);
    if (k < 0 || fl_grow(&m->name, &m->name_cap, m->group.n, sizeof *m->name, err) ||
        fl_grow(&m->single, &m->single_cap, m->group.n, sizeof *m->single, err))
        return -1;
    if (k >= had) m->name[k] = -1;
    if (k >= had) m->single[k] = 0;
    return k;
}

/* Append a group to the list that begins at *first, unless it is in it. */
static int append_group(msh_reader *m, int32_t *first, int32_t group, fl_err *err)
{
    int32_t last = 0;
    if (fl_grow(&m->in, &m->in_cap, (int64_t)m->members + 1, sizeof *m->in, err)) return -1;
    for (int32_t k = *first; k; k = m->in[k - 1].next) {
        if (m->in[k - 1].group == group) return 0;
        last = k;
    }
    m->in[m->members++] = (group_entry){group, 0};
    if (last) m->in[last - 1].next = m->members;
    else *first = m->members;
    return 0;
}

/* Rows: dimension tag "name", in a binary file too. */
static int read_names(msh_reader *m, fl_err *err)
{
    int64_t n = 0;
    const char *w = "";
    if (read_word(m, "the number of names", &w, err)) return -1;
    if (fl_deck_integer(w, &n) || n < 0)
        return fail_at_position(m, err, "\"%.40s\" names were found, a whole number is expected", w);
    for (int64_t i = 0; i < n; i++) {
        char *p, *end;
        long dim, tag;
        int32_t k, len;
        do {
            const int more = fl_bytes_line(m->b, &p, &len, err);
            if (more < 0) return -1;
            if (more == 0) return fail_at_position(m, err, "the file ends after %lld names", (long long)i);
            p = fl_deck_trim(p);
        } while (*p == '\0');
        dim = strtol(p, &end, 10);
        if (end == p || dim < 0 || dim >= DIMS) goto wrong;
        tag = strtol(end, &p, 10);
        if (p == end) goto wrong;
        p = fl_deck_trim(p);
        if (*p++ != '"' || !(end = strrchr(p, '"'))) goto wrong;
        *end = '\0';
        k = group_index(m, (int)dim, tag, err);
        if (k < 0) return -1;
        m->name[k] = *p ? fl_string_table_add(&m->names, p, err) : -1;
        if (*p && m->name[k] < 0) return -1;
        continue;
wrong:
        return fail_at_position(
            m, err, "a physical name of \"%.40s\" was found, DIMENSION TAG \"NAME\" is expected", p);
    }
    return 0;
}

static int add_member(msh_reader *m, int dim, int64_t tag, int64_t physical, fl_err *err)
{
    const int32_t had = m->entity.n, k = fl_id_map_add(&m->entity, dim, tag, err);
    /* the sign may give the orientation */
    const int32_t g = group_index(m, dim, physical < 0 ? -physical : physical, err);
    if (k < 0 || g < 0 || fl_grow(&m->member, &m->member_cap, m->entity.n, sizeof *m->member, err)) return -1;
    if (k >= had) m->member[k] = 0;
    return append_group(m, &m->member[k], g, err);
}

/* Read one point, curve, surface or volume. */
static int read_entity(msh_reader *m, int dim, int partitioned, fl_err *err)
{
    int64_t tag, n, x;
    if (read_int(m, "the tag of an entity", &tag, err)) return -1;
    if (partitioned) {
        if (skip_numbers(m, 0, 2, err) || read_size(m, "the number of partitions", &n, err) ||
            skip_numbers(m, 0, n, err))
            return -1;
    }
    if (skip_numbers(m, 1, dim ? 6 : 3, err) || read_size(m, "the number of physical tags", &n, err))
        return -1;
    for (int64_t i = 0; i < n; i++)
        if (read_int(m, "a physical tag", &x, err) || add_member(m, dim, tag, x, err)) return -1;
    if (dim == 0) return 0;
    if (read_size(m, "the number of bounding entities", &n, err)) return -1;
    return skip_numbers(m, 0, n, err);
}

static int read_entities(msh_reader *m, int partitioned, fl_err *err)
{
    int64_t n[DIMS], x;
    if (m->version != 4) return fail_at_position(m, err, "$Entities belongs to version 4.1");
    if (partitioned) {
        if (read_size(m, "the number of partitions", &x, err) ||
            read_size(m, "the number of ghosts", &x, err) || x > INT32_MAX || skip_numbers(m, 0, 2 * x, err))
            return err->code ? -1 : fail_at_position(m, err, "%lld ghosts", (long long)x);
    }
    for (int d = 0; d < DIMS; d++)
        if (read_size(m, "the number of entities", &n[d], err)) return -1;
    for (int d = 0; d < DIMS; d++)
        for (int64_t i = 0; i < n[d]; i++)
            if (read_entity(m, d, partitioned, err)) return -1;
    return 0;
}

/* --- nodes and elements --------------------------------------------------------------------------------- */

static int read_node(msh_reader *m, int64_t tag, fl_err *err)
{
    fl_vec3 x;
    if (read_real(m, "x", &x.x, err) || read_real(m, "y", &x.y, err) || read_real(m, "z", &x.z, err))
        return -1;
    if (tag < 1)
        return fail_at_position(m, err, "node %lld was found, a tag of 1 or more is expected",
                                (long long)tag);
    if (!isfinite(x.x) || !isfinite(x.y) || !isfinite(x.z))
        return fail_at_position(m, err, "node %lld is at %g %g %g, finite coordinates are expected",
                                (long long)tag, x.x, x.y, x.z);
    return fl_elements_add_node(&m->e, 0, tag, x, err) < 0 ? -1 : 0;
}

/* A block of nodes of an entity: all tags, then all coordinates, followed by one parameter for each dimension
 * if parametric. */
static int read_node_block(msh_reader *m, fl_err *err)
{
    int64_t dim, tag, parametric, n;
    if (read_int(m, "a dimension", &dim, err) || read_int(m, "an entity", &tag, err) ||
        read_int(m, "0 or 1", &parametric, err) || read_size(m, "the number of nodes", &n, err))
        return -1;
    if (dim < 0 || dim >= DIMS || parametric < 0 || parametric > 1)
        return fail_at_position(m, err, "a block of dimension %lld, parametric %lld was found",
                                (long long)dim, (long long)parametric);
    for (int64_t i = 0; i < n; i++)
        if (fl_grow(&m->tag, &m->tag_cap, i + 1, sizeof *m->tag, err) ||
            read_size(m, "the tag of a node", &m->tag[i], err))
            return -1;
    for (int64_t i = 0; i < n; i++)
        if (read_node(m, m->tag[i], err) || skip_numbers(m, 1, parametric * dim, err)) return -1;
    return 0;
}

/* $ParametricNodes of version 2: number, x y z, dimension and tag of the entity, and its parameters: one on a
 * curve, two on a surface. */
static int read_parametric_nodes(msh_reader *m, fl_err *err)
{
    int64_t tag, dim, entity;
    if (m->version != 2) return fail_at_position(m, err, "$ParametricNodes belongs to version 2");
    for (int64_t i = 0; i < m->tag[0]; i++) {
        if (read_int(m, "the number of a node", &tag, err) || read_node(m, tag, err) ||
            read_int(m, "a dimension", &dim, err) || read_int(m, "an entity", &entity, err))
            return -1;
        if (dim < 0 || dim >= DIMS)
            return fail_at_position(m, err, "node %lld lies on an entity of dimension %lld", (long long)tag,
                                    (long long)dim);
        if (skip_numbers(m, 1, dim < 3 ? dim : 0, err)) return -1;
    }
    return 0;
}

static int read_nodes(msh_reader *m, fl_err *err)
{
    int64_t blocks, n, x, tag;
    if (m->version == 4) {
        if (read_size(m, "the number of blocks", &blocks, err) ||
            read_size(m, "the number of nodes", &n, err) || read_size(m, "the lowest tag", &x, err) ||
            read_size(m, "the highest tag", &x, err))
            return -1;
        for (int64_t i = 0; i < blocks; i++)
            if (read_node_block(m, err)) return -1;
        return 0;
    }
    for (int64_t i = 0; i < m->tag[0]; i++)
        if (read_int(m, "the number of a node", &tag, err) || read_node(m, tag, err)) return -1;
    return 0;
}

static int check_type(const msh_reader *m, int64_t type, fl_err *err)
{
    if (type > 0 && type < TYPES && TYPE[type].nodes) return 0;
    return fail_at_position(m, err, "element type %lld is not known: save the mesh with order 1 or 2",
                            (long long)type);
}

/* Number of a node of an element; 0 for an omitted one. */
static int64_t number_of(const msh_reader *m, int32_t node) { return node < 0 ? 0 : m->e.node_id.id[node]; }

/* True if the element repeats the last one.  In version 2 an element in several groups is listed once for
 * each, consecutively, each time with another number. */
static int repeats_last(const msh_reader *m, int type, const int64_t *node)
{
    const int32_t k = m->e.element_id.n - 1;
    const int n = fl_shape_nodes((enum fl_shape)TYPE[type].shape);
    if (m->version != 2 || k < 0 || m->e.element[k].shape != TYPE[type].shape) return 0;
    for (int i = 0; i < n; i++)
        if (number_of(m, m->e.connectivity[m->e.element[k].first + i]) != (node[i] < 1 ? 0 : node[i]))
            return 0;
    return 1;
}

/* Add the groups of another list to those of the last element. */
static int add_groups(msh_reader *m, int32_t of, fl_err *err)
{
    int32_t *mine = &m->of[m->e.element_id.n - 1], copy = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int32_t k = pass ? of : *mine; k; k = m->in[k - 1].next)
            if (append_group(m, &copy, m->in[k - 1].group, err)) return -1;
    *mine = copy;
    return 0;
}

/* Fails because of an element without all of its nodes. */
static int fail_short(msh_reader *m, int type, int64_t id, fl_err *err)
{
    m->b->line = m->element_line;
    return fail_at_position(m, err, "element %lld of type %d has fewer than %d nodes on its line",
                            (long long)id, type, TYPE[type].nodes);
}

/* Read the number of an element.  Writers put an element on a line of its own; of one that goes on where the
 * next line has more than its nodes, some are missing. */
static int read_element_id(msh_reader *m, int64_t *id, fl_err *err)
{
    const int32_t before = m->element_line;
    if (m->version == 4 ? read_size(m, "the tag of an element", id, err) : read_int(m, "an element", id, err))
        return -1;
    if (!m->binary && m->split_end && m->b->line == m->split_end) {
        m->b->line = before;
        return fail_at_position(m, err, "this element has fewer nodes on its line than its type");
    }
    m->element_line = m->b->line;
    m->split_end = 0;
    return 0;
}

/* Read the nodes of an element and add it; `of` is the list of its groups. */
static int read_element(msh_reader *m, int type, int64_t id, int32_t of, fl_err *err)
{
    int64_t node[NODES], mine[20];
    int32_t k;
    for (int i = 0; i < TYPE[type].nodes; i++)
        if (m->version == 4 ? read_size(m, "a node", &node[i], err) : read_int(m, "a node", &node[i], err)) {
            if (m->binary || err->code != FL_INPUT || m->b->line == m->element_line) return -1;
            *err = (fl_err){0};
            return fail_short(m, type, id, err);
        }
    if (!m->binary && m->b->line != m->element_line) m->split_end = m->b->line;
    if (type == 15) return fl_elements_skip(&m->e, "point", err);
    for (int i = 0; i < fl_shape_nodes((enum fl_shape)TYPE[type].shape); i++) {
        mine[i] = node[TYPE[type].at ? TYPE[type].at[i] : i];
        if (mine[i] < 1 && i < fl_shape_corners((enum fl_shape)TYPE[type].shape))
            return fail_at_position(m, err, "element %lld has node %lld, a tag of 1 or more is expected",
                                    (long long)id, (long long)mine[i]);
    }
    if (repeats_last(m, type, mine)) return add_groups(m, of, err);
    m->coarse += type >= 20;
    m->e.line = m->b->line;
    k = fl_elements_add(&m->e, 0, -1, (enum fl_shape)TYPE[type].shape, 0, mine, err);
    if (k < 0 || fl_grow(&m->of, &m->of_cap, (int64_t)k + 1, sizeof *m->of, err)) return -1;
    m->of[k] = of;
    return 0;
}

static int read_element_block(msh_reader *m, fl_err *err)
{
    int64_t dim, tag, type, n, id;
    int32_t entity, of = 0;
    if (read_int(m, "a dimension", &dim, err) || read_int(m, "an entity", &tag, err) ||
        read_int(m, "an element type", &type, err) || read_size(m, "the number of elements", &n, err) ||
        check_type(m, type, err))
        return -1;
    if (dim != TYPE[type].dim)
        return fail_at_position(m, err, "elements of type %lld are in an entity of dimension %lld",
                                (long long)type, (long long)dim);
    entity = fl_id_map_find(&m->entity, (int32_t)dim, tag);
    if (entity >= 0) of = m->member[entity];
    for (int64_t i = 0; i < n; i++)
        if (read_element_id(m, &id, err) || read_element(m, (int)type, id, of, err)) return -1;
    return 0;
}

/* Version 2: number, then tags of which the first is the physical group, then nodes. */
static int read_tagged(msh_reader *m, int64_t type, int64_t tags, int64_t id, fl_err *err)
{
    int64_t physical = 0;
    int32_t group, none = 0, *of = &none;
    if (tags < 0 || (tags > 0 && read_int(m, "a physical tag", &physical, err)) ||
        skip_numbers(m, 0, tags - (tags > 0), err))
        return err->code
                   ? -1
                   : fail_at_position(m, err, "element %lld has %lld tags", (long long)id, (long long)tags);
    if (physical) {
        group = group_index(m, TYPE[type].dim, physical < 0 ? -physical : physical, err);
        if (group < 0) return -1;
        of = &m->single[group];
        if (*of == 0 && append_group(m, of, group, err)) return -1;
    }
    return read_element(m, (int)type, id, *of, err);
}

static int read_elements(msh_reader *m, fl_err *err)
{
    int64_t blocks, n, x, id, type, tags;
    if (m->version == 4) {
        if (read_size(m, "the number of blocks", &blocks, err) ||
            read_size(m, "the number of elements", &n, err) || read_size(m, "the lowest tag", &x, err) ||
            read_size(m, "the highest tag", &x, err))
            return -1;
        for (int64_t i = 0; i < blocks; i++)
            if (read_element_block(m, err)) return -1;
        return 0;
    }
    for (int64_t i = 0; i < m->tag[0];) {
        if (!m->binary) {
            if (read_element_id(m, &id, err) || read_int(m, "an element type", &type, err) ||
                read_int(m, "the number of tags", &tags, err) || check_type(m, type, err) ||
                read_tagged(m, type, tags, id, err))
                return -1;
            i++;
            continue;
        }
        if (read_int(m, "an element type", &type, err) || read_int(m, "the number of elements", &n, err) ||
            read_int(m, "the number of tags", &tags, err) || check_type(m, type, err))
            return -1;
        if (n < 1) return fail_at_position(m, err, "%lld elements in a row were found", (long long)n);
        for (; n > 0; n--, i++)
            if (read_element_id(m, &id, err) || read_tagged(m, type, tags, id, err)) return -1;
    }
    return 0;
}

/* --- sections ------------------------------------------------------------------------------------------- */

static int read_format(msh_reader *m, fl_err *err)
{
    const fl_bytes *b = m->b;
    const int more = fl_bytes_row(m->b, err);
    const char *v = more > 0 ? b->field[0] : "";
    uint64_t one = 0;
    if (more < 0) return -1;
    if (more == 0 || b->words < 3) return fail_at_position(m, err, "VERSION FILE-TYPE DATA-SIZE is expected");
    if (strcmp(v, "4.1") == 0) m->version = 4;
    else if (v[0] == '2' && (v[1] == '.' || v[1] == '\0')) m->version = 2;
    else return fail_at_position(m, err, "version %.20s of the format is not read: save as 2.2 or 4.1", v);
    if (strcmp(b->field[1], "0") != 0 && strcmp(b->field[1], "1") != 0)
        return fail_at_position(m, err, "file type \"%.20s\" was found, 0 or 1 is expected", b->field[1]);
    if (strcmp(b->field[2], "8") != 0 && strcmp(b->field[2], "4") != 0)
        return fail_at_position(m, err, "data size \"%.20s\" was found, 8 or 4 is expected", b->field[2]);
    m->wide = b->field[2][0] - '0';
    m->binary = b->field[1][0] == '1';
    m->b->next = m->b->words;
    if (!m->binary) return 0;
    m->b->line = 0;
    if (read_bits(m, 4, &one, err)) return -1;
    if (one == 1) return 0;
    m->swap = 1;
    if (one == 0x01000000) return 0;
    return fail_at_position(m, err, "%llu was found, the number 1 in either byte order is expected",
                            (unsigned long long)one);
}

/* Skip the rest of a section with its $End.. line. */
static int skip_section(msh_reader *m, const char *section, fl_err *err)
{
    char mark[64];
    snprintf(mark, sizeof mark, "$End%.50s", section + 1);
    const int more = fl_bytes_seek(m->b, mark, err);
    if (more < 0) return -1;
    if (more == 0) return fail_at_position(m, err, "the file ends inside %.50s", section);
    if (fl_bytes_row(m->b, err) < 0) return -1;
    m->b->next = m->b->words;
    if (m->binary) m->b->line = 0;
    return 0;
}

/* Read the $End.. line, which must follow. */
static int read_section_end(msh_reader *m, const char *section, fl_err *err)
{
    char mark[64];
    int more;
    snprintf(mark, sizeof mark, "$End%.50s", section + 1);
    if (m->b->next < m->b->words)
        return fail_at_position(m, err, "\"%.40s\" was found, %s is expected", m->b->field[m->b->next], mark);
    more = fl_bytes_row(m->b, err);
    if (more < 0) return -1;
    if (more == 0) return fail_at_position(m, err, "the file ends where %s is expected", mark);
    if (strcmp(m->b->field[0], mark) != 0)
        return fail_at_position(m, err, "\"%.40s\" was found, %s is expected", m->b->field[0], mark);
    m->b->next = m->b->words;
    if (m->binary) m->b->line = 0;
    return 0;
}

/* Version 2 gives the number of nodes or elements in a line of text. */
static int read_count(msh_reader *m, fl_err *err)
{
    const char *w = "";
    if (m->version == 4) return 0;
    if (fl_grow(&m->tag, &m->tag_cap, 1, sizeof *m->tag, err) || read_word(m, "a count", &w, err)) return -1;
    if (fl_deck_integer(w, &m->tag[0]) || m->tag[0] < 0)
        return fail_at_position(m, err, "a count of \"%.40s\" was found", w);
    if (m->binary) m->b->line = 0;
    return 0;
}

static int read_section(msh_reader *m, const char *section, fl_err *err)
{
    if (strcmp(section, "$MeshFormat") == 0)
        return read_format(m, err) || read_section_end(m, section, err) ? -1 : 0;
    if (strcmp(section, "$NOD") == 0 || strcmp(section, "$ELM") == 0)
        return fail_at_position(m, err, "version 1 of the format is not read: save as 2.2 or 4.1");
    if (strcmp(section, "$PhysicalNames") == 0)
        return read_names(m, err) || read_section_end(m, section, err) ? -1 : 0;
    if (strcmp(section, "$Comments") != 0 && !m->version)
        return fail_at_position(m, err, "%.40s stands before $MeshFormat", section);
    if (strcmp(section, "$Entities") == 0)
        return read_entities(m, 0, err) || read_section_end(m, section, err) ? -1 : 0;
    if (strcmp(section, "$PartitionedEntities") == 0)
        return read_entities(m, 1, err) || read_section_end(m, section, err) ? -1 : 0;
    if (strcmp(section, "$Nodes") == 0)
        return read_count(m, err) || read_nodes(m, err) || read_section_end(m, section, err) ? -1 : 0;
    if (strcmp(section, "$ParametricNodes") == 0)
        return read_count(m, err) || read_parametric_nodes(m, err) || read_section_end(m, section, err) ? -1
                                                                                                        : 0;
    if (strcmp(section, "$Elements") == 0)
        return read_count(m, err) || read_elements(m, err) || read_section_end(m, section, err) ? -1 : 0;
    return skip_section(m, section, err);
}

static int read_sections(msh_reader *m, fl_err *err)
{
    int more;
    while ((more = fl_bytes_row(m->b, err)) > 0) {
        char section[64];
        if (m->binary) m->b->line = 0;
        if (m->b->field[0][0] != '$' || strncmp(m->b->field[0], "$End", 4) == 0)
            return fail_at_position(m, err, "\"%.40s\" was found, a section like $Nodes is expected",
                                    m->b->field[0]);
        snprintf(section, sizeof section, "%s", m->b->field[0]);
        m->b->next = m->b->words;
        if (read_section(m, section, err)) return -1;
    }
    return more;
}

/* --- parts ---------------------------------------------------------------------------------------------- */

static int32_t add_group_name(const msh_reader *m, int32_t group, fl_string_table *list, fl_err *err)
{
    static const char *const kind[DIMS] = {"point", "curve", "surface", "volume"};
    char text[40];
    if (m->name[group] >= 0) return fl_string_table_add(list, m->names.name[m->name[group]], err);
    snprintf(text, sizeof text, "%s_%lld", kind[m->group.scope[group]], (long long)m->group.id[group]);
    return fl_string_table_add(list, text, err);
}

/* Assign parts in the order of the elements; further groups of an element become sets. */
static int assign_parts(msh_reader *m, int picks, fl_err *err)
{
    for (int32_t i = 0; i < m->e.element_id.n; i++)
        for (int32_t k = m->of[i]; k; k = m->in[k - 1].next) {
            fl_string_table *list = k == m->of[i] ? &m->e.parts : &m->e.sets;
            const int32_t at = add_group_name(m, m->in[k - 1].group, list, err);
            if (at < 0) return -1;
            if (k == m->of[i]) m->e.element[i].part = at;
            else if (picks && fl_elements_pick(&m->e, (fl_pick){i, at, FL_PICK_WHOLE, 0}, err)) return -1;
        }
    return 0;
}

int fl_msh_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    msh_reader m = {.b = b};
    int rc = -1;
    if (fl_elements_start(&m.e, fl_in_name(b->in), err)) return -1;
    if (fl_string_table_add(&m.e.parts, name, err) < 0 || read_sections(&m, err) ||
        assign_parts(&m, fl_import_by_name(opt), err))
        goto done;
    if (m.e.element_id.n == 0) {
        b->line = 0;
        fl_bytes_fail(b, err,
                      "no elements: put the parts to import into a physical group, or save all elements");
        goto done;
    }
    if (m.coarse) fl_bytes_note(b, "%d elements of order 3 or more were reduced to their corners", m.coarse);
    rc = fl_elements_surface(&m.e, s, b, opt, err);
done:
    fl_elements_free(&m.e);
    fl_id_map_free(&m.group);
    fl_id_map_free(&m.entity);
    fl_string_table_free(&m.names);
    free(m.name);
    free(m.member);
    free(m.single);
    free(m.in);
    free(m.of);
    free(m.tag);
    return rc;
}
