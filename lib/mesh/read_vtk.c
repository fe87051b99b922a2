/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "base/number_text.h"
#include "mesh/element_surface.h"
#include "mesh/read_vtk.h"
#include "mesh/vtk_cells.h"

enum { WORDS = 8, WORD_MAX = 80 };

/* In the order in which cells of POLYDATA are numbered, then those of an UNSTRUCTURED_GRID. */
enum list_index { VERTICES, LINES, POLYGONS, STRIPS, CELLS, LISTS };
static const char *const LIST_NAME[LISTS] = {"VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS", "CELLS"};
static const int CELL_TYPE_OF[LISTS] = {2, 4, 7, 6, 0};

typedef struct {
    fl_vtk_array corner, offset;
} cell_list;

typedef struct {
    fl_bytes *b;
    int binary;
    int words;
    char word[WORDS][WORD_MAX]; /* words of the current line */
    fl_vtk_grid g;
    cell_list list[LISTS];
    fl_vtk_array types;
    int of_cells; /* the following arrays are cell data */
    int rank;     /* of the part array that is kept */
} vtk_reader;

typedef struct {
    const char *name;
    int bytes; /* 0: bits */
    int kind;  /* of the value: 'i' signed, 'u' unsigned, 'f' */
} number_type;

static const number_type TYPE[] = {
    {"bit", 0, 'u'},           {"char", 1, 'i'},           {"unsigned_char", 1, 'u'},
    {"short", 2, 'i'},         {"unsigned_short", 2, 'u'}, {"int", 4, 'i'},
    {"unsigned_int", 4, 'u'},  {"long", 8, 'i'},           {"unsigned_long", 8, 'u'},
    {"long_long", 8, 'i'},     {"vtktypeint64", 8, 'i'},   {"vtktypeuint64", 8, 'u'},
    {"vtktypeint32", 4, 'i'},  {"vtktypeuint32", 4, 'u'},  {"vtktypeint16", 2, 'i'},
    {"vtktypeuint16", 2, 'u'}, {"vtktypeint8", 1, 'i'},    {"vtktypeuint8", 1, 'u'},
    {"signed_char", 1, 'i'},   {"vtkIdType", 4, 'i'},      {"float", 4, 'f'},
    {"double", 8, 'f'},
};

int fl_vtk_is(const fl_bytes *b) { return strncasecmp(b->data, "# vtk DataFile", 14) == 0; }

static int fail_at_position(const vtk_reader *v, fl_err *err, const char *fmt, ...)
    __attribute__((format(printf, 3, 4)));

static int fail_at_position(const vtk_reader *v, fl_err *err, const char *fmt, ...)
{
    char what[300];
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(what, sizeof what, fmt, ap);
    va_end(ap);
    if (v->binary) return fl_bytes_fail(v->b, err, "byte %lld: %s", (long long)fl_bytes_offset(v->b), what);
    return fl_bytes_fail(v->b, err, "%s", what);
}

/* --- lines and numbers ---------------------------------------------------------------------------------- */

/* Read the next line that is not empty and split it into words.  Returns 1, 0 at the end, -1. */
static int read_line(vtk_reader *v, fl_err *err)
{
    v->words = 0;
    while (v->words == 0) {
        char *p;
        int32_t n;
        const int more = fl_bytes_line(v->b, &p, &n, err);
        if (more <= 0) return more;
        while (v->words < WORDS) {
            size_t k = 0;
            while (*p == ' ' || *p == '\t') p++;
            if (*p == '\0') break;
            for (; *p && *p != ' ' && *p != '\t'; p++)
                if (k < WORD_MAX - 1) v->word[v->words][k++] = *p;
            v->word[v->words++][k] = '\0';
        }
    }
    for (int k = v->words; k < WORDS; k++) v->word[k][0] = '\0';
    return 1;
}

/* Read the next line that is not empty, which must be there. */
static int read_required_line(vtk_reader *v, const char *inside, fl_err *err)
{
    const int more = read_line(v, err);
    return more > 0 ? 0 : more < 0 ? -1 : fail_at_position(v, err, "the file ends inside %s", inside);
}

/* Skip a line.  Returns 0 if it is empty or at the end of the file. */
static int skip_line(vtk_reader *v, fl_err *err)
{
    char *p;
    int32_t n;
    const int more = fl_bytes_line(v->b, &p, &n, err);
    return more <= 0 ? more : n > 0;
}

/* METADATA extends to an empty line. */
static int skip_metadata(vtk_reader *v, fl_err *err)
{
    int more;
    while ((more = skip_line(v, err)) > 0) {}
    return more;
}

/* True if the next line that is not empty begins with this word.  Binary data may follow, so nothing is
 * consumed. */
static int next_line_is(vtk_reader *v, const char *word, fl_err *err)
{
    enum { LOOK_AHEAD = 400 }; /* blanks and empty lines before the word */
    const size_t len = strlen(word);
    const char *p;
    const int32_t n = fl_bytes_peek(v->b, LOOK_AHEAD, &p, err);
    if (n < 0) return -1;
    const char *const end = p + n;
    while (p < end && strchr(" \t\r\n", *p) && *p) p++;
    return (size_t)(end - p) >= len && strncasecmp(p, word, len) == 0;
}

static int is_keyword(const vtk_reader *v, const char *word) { return strcasecmp(v->word[0], word) == 0; }

static int parse_count(const vtk_reader *v, int k, int64_t *n, fl_err *err)
{
    uint64_t u = 0;
    *n = 0;
    if (fl_number_u64(v->word[k], &u) || u > INT32_MAX)
        return fail_at_position(v, err, "\"%.40s\" was found behind %.40s, a count is expected", v->word[k],
                                v->word[0]);
    *n = (int64_t)u;
    return 0;
}

static const number_type *type_of(const char *word)
{
    for (size_t k = 0; k < sizeof TYPE / sizeof TYPE[0]; k++)
        if (strcasecmp(TYPE[k].name, word) == 0) return &TYPE[k];
    return NULL;
}

/* A big-endian number. */
static double binary_number(const unsigned char *p, const number_type *t)
{
    uint64_t u = 0;
    float single;
    double x;
    uint32_t half;
    for (int k = 0; k < t->bytes; k++) u = u << 8 | p[k];
    if (t->kind == 'u') return (double)u;
    if (t->kind == 'i') {
        if (t->bytes < 8 && u >> (8 * t->bytes - 1)) u |= ~(uint64_t)0 << 8 * t->bytes;
        return (double)(int64_t)u;
    }
    if (t->bytes == 4) {
        half = (uint32_t)u;
        memcpy(&single, &half, sizeof single);
        return (double)single;
    }
    memcpy(&x, &u, sizeof x);
    return x;
}

/* Reserve memory for n more numbers. */
static int reserve_numbers(fl_vtk_array *a, int64_t n, fl_err *err)
{
    return fl_grow(&a->x, &a->cap, a->n + n, sizeof *a->x, err);
}

static int read_binary(vtk_reader *v, const number_type *t, int64_t n, fl_vtk_array *a, fl_err *err)
{
    enum { AT_ONCE = 4096 };
    const unsigned char *p = NULL;
    int more = 1;
    if (!a || t->bytes == 0) {
        more = fl_bytes_skip(v->b, t->bytes ? n * t->bytes : (n + 7) / 8, err);
        return more > 0 ? 0 : more < 0 ? -1 : fail_at_position(v, err, "the file ends inside the data");
    }
    while (n > 0) {
        const int32_t k = n < AT_ONCE ? (int32_t)n : AT_ONCE;
        more = fl_bytes_read(v->b, k * t->bytes, &p, err);
        if (more < 0) return -1;
        if (more == 0) return fail_at_position(v, err, "the file ends inside the data");
        if (reserve_numbers(a, k, err)) return -1;
        for (int32_t i = 0; i < k; i++) a->x[a->n++] = binary_number(p + (ptrdiff_t)i * t->bytes, t);
        n -= k;
    }
    return 0;
}

/* Read n numbers into a (NULL: skip them).  Memory grows only as they are read. */
static int read_numbers(vtk_reader *v, const number_type *t, int64_t n, fl_vtk_array *a, fl_err *err)
{
    if (v->binary) return read_binary(v, t, n, a, err);
    if (n == 0) return 0;
    v->b->line++; /* the data begin on the next line */
    for (int64_t k = 0; k < n; k++) {
        double x;
        /* skipped values may be nan */
        const int more = fl_bytes_real(v->b, a == NULL, &x, err);
        if (more < 0 || (a && more && a->n == a->cap && reserve_numbers(a, 1, err))) return -1;
        if (more == 0) return fail_at_position(v, err, "the file ends inside the data");
        if (a) a->x[a->n++] = x;
    }
    if (skip_line(v, err) < 0) return -1; /* the rest of the last line, */
    v->b->line--;                         /* which is counted */
    return 0;
}

/* --- data sets ------------------------------------------------------------------------------------------ */

static int check_first(const vtk_reader *v, const fl_vtk_array *a, fl_err *err)
{
    return a->x ? fail_at_position(v, err, "%.40s comes twice", v->word[0]) : 0;
}

static int read_points(vtk_reader *v, fl_err *err)
{
    const number_type *t = type_of(v->word[2]);
    int64_t n;
    if (parse_count(v, 1, &n, err) || check_first(v, &v->g.point, err)) return -1;
    if (!t) return fail_at_position(v, err, "points of type \"%.40s\" were found", v->word[2]);
    return read_numbers(v, t, 3 * n, &v->g.point, err);
}

/* Convert "n c0 c1 ..." of each cell to offsets and corners, in place. */
static int split_counts(vtk_reader *v, cell_list *c, int64_t n, fl_err *err)
{
    double *x = c->corner.x;
    const int64_t all = c->corner.n;
    int64_t k = 0, to = 0;
    if (n > all)
        return fail_at_position(v, err, "%lld cells do not fit into %lld numbers", (long long)n,
                                (long long)all);
    c->offset.x = fl_alloc(n, sizeof *c->offset.x, err);
    if (!c->offset.x) return -1;
    for (int64_t i = 0; i < n; i++) {
        const double m = k < all ? x[k++] : -1.0;
        if (!(m >= 0.0 && m <= (double)(all - k)) || m != floor(m))
            return fail_at_position(v, err,
                                    "cell %lld of %lld does not fit into the %lld numbers of all cells",
                                    (long long)i, (long long)n, (long long)all);
        for (int64_t j = 0; j < (int64_t)m; j++) x[to++] = x[k++];
        c->offset.x[i] = (double)to;
    }
    if (k != all)
        return fail_at_position(v, err, "%lld numbers are left behind the last cell", (long long)(all - k));
    c->offset.n = n;
    c->corner.n = to;
    return 0;
}

/* Since version 5.1: OFFSETS, of which the first is 0, and CONNECTIVITY. */
static int read_offsets(vtk_reader *v, cell_list *c, int64_t n, int64_t size, fl_err *err)
{
    const number_type *t = type_of(v->word[1]);
    if (!t || n < 1)
        return fail_at_position(v, err, "%lld offsets of type \"%.40s\" were found", (long long)n,
                                v->word[1]);
    if (read_numbers(v, t, n, &c->offset, err)) return -1;
    if (c->offset.x[0] != 0.0)
        return fail_at_position(v, err, "the first offset is %g, 0 is expected", c->offset.x[0]);
    memmove(c->offset.x, c->offset.x + 1, (size_t)--c->offset.n * sizeof *c->offset.x);
    if (read_line(v, err) <= 0 || !is_keyword(v, "CONNECTIVITY"))
        return err->code ? -1 : fail_at_position(v, err, "CONNECTIVITY is expected behind OFFSETS");
    t = type_of(v->word[1]);
    if (!t) return fail_at_position(v, err, "connectivity of type \"%.40s\" was found", v->word[1]);
    return read_numbers(v, t, size, &c->corner, err);
}

static int read_cells(vtk_reader *v, cell_list *c, fl_err *err)
{
    int64_t n, size;
    int has_offsets;
    if (parse_count(v, 1, &n, err) || parse_count(v, 2, &size, err) || check_first(v, &c->offset, err))
        return -1;
    has_offsets = next_line_is(v, "OFFSETS", err);
    if (has_offsets) return has_offsets < 0 || read_line(v, err) < 0 ? -1 : read_offsets(v, c, n, size, err);
    return read_numbers(v, type_of("int"), size, &c->corner, err) || split_counts(v, c, n, err) ? -1 : 0;
}

static int read_types(vtk_reader *v, fl_err *err)
{
    int64_t n;
    if (parse_count(v, 1, &n, err) || check_first(v, &v->types, err)) return -1;
    return read_numbers(v, type_of("int"), n, &v->types, err);
}

/* Skip the strings of a field.  In binary data each follows its length; the two highest bits of the first
 * byte give the number of its bytes (3: one, 2: two, 1: four, 0: eight). */
static int skip_strings(vtk_reader *v, int64_t n, fl_err *err)
{
    int more = 1;
    for (int64_t k = 0; more > 0 && k < n; k++) {
        const unsigned char *p = NULL;
        char *text;
        int32_t len;
        uint64_t length;
        if (!v->binary) {
            more = fl_bytes_line(v->b, &text, &len, err);
            continue;
        }
        more = fl_bytes_read(v->b, 1, &p, err);
        if (more <= 0) break;
        length = p[0] & 0x3f;
        len = (8 >> (p[0] >> 6)) - 1;
        more = fl_bytes_read(v->b, len, &p, err);
        for (int32_t i = 0; more > 0 && i < len; i++) length = length << 8 | p[i];
        if (more > 0) more = length > INT64_MAX ? 0 : fl_bytes_skip(v->b, (int64_t)length, err);
    }
    return more > 0 ? 0 : more < 0 ? -1 : fail_at_position(v, err, "the file ends inside a string");
}

/* Read an array of n rows of m columns.  It is kept if it identifies parts of cells and ranks before the one
 * kept so far. */
static int read_array(vtk_reader *v, const char *name, const char *type, int64_t m, int64_t n, fl_err *err)
{
    const number_type *t = type_of(type);
    const int rank = v->of_cells && m == 1 ? fl_vtk_part_rank(name) : -1;
    if (m > 0 && n > INT32_MAX / m)
        return fail_at_position(v, err, "%lld times %lld values", (long long)n, (long long)m);
    if (strcasecmp(type, "string") == 0) return skip_strings(v, n * m, err);
    if (!t) return fail_at_position(v, err, "\"%.40s\" is of type \"%.40s\"", name, type);
    if (rank < 0 || t->kind == 'f' || (v->rank >= 0 && v->rank <= rank))
        return read_numbers(v, t, n * m, NULL, err);
    free(v->g.part.x);
    v->g.part = (fl_vtk_array){0};
    v->rank = rank;
    snprintf(v->g.part_word, sizeof v->g.part_word, "%.39s", name);
    return read_numbers(v, t, n, &v->g.part, err);
}

static int read_field(vtk_reader *v, fl_err *err)
{
    int64_t arrays, m, n;
    if (parse_count(v, 2, &arrays, err)) return -1;
    for (int64_t k = 0; k < arrays; k++) {
        char name[WORD_MAX], type[WORD_MAX];
        if (read_required_line(v, "a field", err)) return -1;
        if (is_keyword(v, "METADATA")) {
            if (skip_metadata(v, err)) return -1;
            k--;
            continue;
        }
        memcpy(name, v->word[0], sizeof name);
        memcpy(type, v->word[3], sizeof type);
        if (parse_count(v, 1, &m, err) || parse_count(v, 2, &n, err) || read_array(v, name, type, m, n, err))
            return -1;
    }
    return 0;
}

/* SCALARS, VECTORS and the like, for n points or cells. */
static int read_attribute(vtk_reader *v, int64_t n, fl_err *err)
{
    static const struct {
        const char *word;
        int columns;
    } plain[] = {{"VECTORS", 3},    {"NORMALS", 3},      {"TENSORS", 9},   {"TENSORS6", 6},
                 {"GLOBAL_IDS", 1}, {"PEDIGREE_IDS", 1}, {"EDGE_FLAGS", 1}};
    char name[WORD_MAX], type[WORD_MAX];
    int64_t m = 1;
    memcpy(name, v->word[1], sizeof name);
    memcpy(type, v->word[2], sizeof type);
    if (is_keyword(v, "SCALARS")) {
        if (v->words > 3 && parse_count(v, 3, &m, err)) return -1;
        const int table = next_line_is(v, "LOOKUP_TABLE", err); /* it may be absent */
        if (table && (table < 0 || read_line(v, err) < 0)) return -1;
        return read_array(v, name, type, m, n, err);
    }
    if (is_keyword(v, "TEXTURE_COORDINATES")) {
        if (parse_count(v, 2, &m, err)) return -1;
        memcpy(type, v->word[3], sizeof type);
        return read_array(v, name, type, m, n, err);
    }
    if (is_keyword(v, "COLOR_SCALARS")) {
        if (parse_count(v, 2, &m, err)) return -1;
        return read_array(v, name, v->binary ? "unsigned_char" : "float", m, n, err);
    }
    if (is_keyword(v, "LOOKUP_TABLE")) {
        if (parse_count(v, 2, &n, err)) return -1;
        return read_array(v, name, v->binary ? "unsigned_char" : "float", 4, n, err);
    }
    for (size_t k = 0; k < sizeof plain / sizeof plain[0]; k++)
        if (is_keyword(v, plain[k].word)) return read_array(v, name, type, plain[k].columns, n, err);
    return fail_at_position(v, err, "\"%.40s\" has no place in a VTK file", v->word[0]);
}

static int read_head(vtk_reader *v, fl_err *err)
{
    if (skip_line(v, err) < 0 || skip_line(v, err) < 0 || read_required_line(v, "its head", err)) return -1;
    if (is_keyword(v, "BINARY")) v->binary = 1;
    else if (!is_keyword(v, "ASCII"))
        return fail_at_position(v, err, "\"%.40s\" was found, ASCII or BINARY is expected", v->word[0]);
    return 0;
}

static int read_set(vtk_reader *v, int *grid, fl_err *err)
{
    *grid = strcasecmp(v->word[1], "UNSTRUCTURED_GRID") == 0;
    if (*grid || strcasecmp(v->word[1], "POLYDATA") == 0) return 0;
    return fail_at_position(
        v, err, "a data set of kind \"%.40s\" has no surface of its own: save its surface as POLYDATA",
        v->word[1]);
}

static int read_all(vtk_reader *v, fl_err *err)
{
    int64_t n = 0;
    int grid = 0, sets = 0, more;
    if (read_head(v, err)) return -1;
    while ((more = read_line(v, err)) > 0) {
        int k = 0;
        if (is_keyword(v, "METADATA")) {
            if (skip_metadata(v, err)) return -1;
            continue;
        }
        while (k < LISTS && !is_keyword(v, LIST_NAME[k])) k++;
        if (is_keyword(v, "DATASET")) {
            sets++;
            if (read_set(v, &grid, err)) return -1;
        } else if (is_keyword(v, "FIELD")) {
            if (read_field(v, err)) return -1;
        } else if (sets != 1) {
            return fail_at_position(v, err, "\"%.40s\" was found, one DATASET is expected", v->word[0]);
        } else if (is_keyword(v, "POINTS")) {
            if (read_points(v, err)) return -1;
        } else if (is_keyword(v, "CELL_TYPES")) {
            if (read_types(v, err)) return -1;
        } else if (k < LISTS) {
            if (grid != (k == CELLS))
                return fail_at_position(v, err, "%s do not belong to a data set of this kind", LIST_NAME[k]);
            if (read_cells(v, &v->list[k], err)) return -1;
        } else if (is_keyword(v, "CELL_DATA") || is_keyword(v, "POINT_DATA")) {
            v->of_cells = is_keyword(v, "CELL_DATA");
            if (parse_count(v, 1, &n, err)) return -1;
        } else if (read_attribute(v, n, err)) {
            return -1;
        }
    }
    if (more < 0) return -1;
    return v->g.point.x ? 0 : fail_at_position(v, err, "no POINTS");
}

/* Concatenate the lists; a single one is moved. */
static int join_lists(vtk_reader *v, fl_err *err)
{
    int64_t n = 0, corners = 0;
    int some = 0;
    for (int k = 0; k < LISTS; k++) {
        n += v->list[k].offset.n;
        corners += v->list[k].corner.n;
        some += v->list[k].offset.n > 0;
    }
    v->g.type.x = fl_alloc(n, sizeof *v->g.type.x, err);
    if (!v->g.type.x) return -1;
    if (some != 1) {
        v->g.corner.x = fl_alloc(corners, sizeof *v->g.corner.x, err);
        v->g.offset.x = fl_alloc(n, sizeof *v->g.offset.x, err);
        if (!v->g.corner.x || !v->g.offset.x) return -1;
    }
    for (int k = 0; k < LISTS; k++) {
        cell_list *c = &v->list[k];
        for (int64_t i = 0; i < c->offset.n; i++) v->g.type.x[v->g.type.n++] = (double)CELL_TYPE_OF[k];
        if (c->offset.n == 0) continue;
        if (some == 1) {
            v->g.corner = c->corner;
            v->g.offset = c->offset;
            c->corner.x = c->offset.x = NULL;
            continue;
        }
        for (int64_t i = 0; i < c->offset.n; i++)
            v->g.offset.x[v->g.offset.n++] = (double)v->g.corner.n + c->offset.x[i];
        if (c->corner.n)
            memcpy(v->g.corner.x + v->g.corner.n, c->corner.x, (size_t)c->corner.n * sizeof(double));
        v->g.corner.n += c->corner.n;
    }
    if (v->list[CELLS].offset.n == 0) return 0;
    if (v->types.n != n)
        return fail_at_position(v, err, "%lld cells have %lld types", (long long)n, (long long)v->types.n);
    memcpy(v->g.type.x, v->types.x, (size_t)n * sizeof(double));
    return 0;
}

/* Move the polyhedra of a legacy file to the face arrays.  Their corners are the number of faces, then each
 * face with its number of corners. */
static int extract_polyhedra(vtk_reader *v, fl_err *err)
{
    fl_vtk_grid *g = &v->g;
    int64_t n = 0, from = 0;
    for (int64_t c = 0; c < g->type.n; c++) n += g->type.x[c] == 42.0;
    if (n == 0) return 0;
    g->face.x = fl_alloc(g->corner.n, sizeof *g->face.x, err);
    g->face_last.x = fl_alloc(g->type.n, sizeof *g->face_last.x, err);
    if (!g->face.x || !g->face_last.x) return -1;
    g->face_last.n = g->type.n;
    for (int64_t c = 0, to = 0; c < g->type.n; c++) {
        const double last = g->offset.x[c];
        const int64_t begin = to;
        if (!(last >= (double)from && last <= (double)g->corner.n) || last != floor(last))
            return fail_at_position(v, err, "cell %lld ends at place %g", (long long)c, last);
        g->face_last.x[c] = -1.0;
        for (int64_t k = from; k < (int64_t)last; k++) {
            if (g->type.x[c] == 42.0) g->face.x[g->face.n++] = g->corner.x[k];
            else g->corner.x[to++] = g->corner.x[k];
        }
        if (g->type.x[c] == 42.0) g->face_last.x[c] = (double)g->face.n;
        from = (int64_t)last;
        g->offset.x[c] = (double)(g->type.x[c] == 42.0 ? begin : to);
    }
    return 0;
}

int fl_vtk_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    vtk_reader v = {.b = b, .rank = -1};
    fl_vtk_names names = {0};
    fl_elements e;
    int32_t coarse = 0;
    int rc = -1;
    if (fl_elements_start(&e, fl_in_name(b->in), err)) return -1;
    if (read_all(&v, err) || join_lists(&v, err) || extract_polyhedra(&v, err) ||
        fl_vtk_add_cells(&e, &v.g, 0, &names, name, &coarse, err))
        goto done;
    if (coarse) fl_bytes_note(b, "%d cells of higher order were reduced to their corners", coarse);
    fl_vtk_grid_free(&v.g); /* the elements hold all of it */
    rc = fl_elements_surface(&e, s, b, opt, err);
done:
    for (int k = 0; k < LISTS; k++) {
        free(v.list[k].corner.x);
        free(v.list[k].offset.x);
    }
    free(v.types.x);
    fl_vtk_grid_free(&v.g);
    fl_vtk_names_free(&names);
    fl_elements_free(&e);
    return rc;
}
