/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/string_table.h"
#include "base/number_text.h"
#include "geom/facet.h"
#include "mesh/read_ply.h"

typedef enum { I8, U8, I16, U16, I32, U32, F32, F64, TYPES } ply_type;

static const char *const TYPE_NAME[TYPES][2] = {
    {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
    {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
static const int TYPE_SIZE[TYPES] = {1, 1, 2, 2, 4, 4, 4, 8};

/* Use of a property. */
typedef enum { UNUSED, X, Y, Z, PART, CORNERS } property_use;

typedef struct {
    ply_type of, count; /* type of the value; of the length of a list */
    int list;
    property_use is;
} ply_property;

typedef enum { OTHER, VERTEX, FACE } element_kind;

typedef struct {
    element_kind is;
    int64_t n;
    int32_t first, last; /* its properties are first .. last - 1 */
} ply_element;

typedef struct {
    fl_bytes *b;
    int binary, swap; /* swap: the byte order is not that of this machine */
    ply_element *el;
    ply_property *pr;
    int32_t els, prs, el_cap, pr_cap;
    int32_t *loop, loop_cap, loop_n;
    int64_t row;           /* current row of an element, for messages on binary data */
    fl_string_table names; /* of parts, from comments of the header */
    double *number;        /* [names.n] their numbers */
    double *of;            /* [triangles] part of each, if faces have that property */
    int32_t number_cap, of_cap;
} ply_reader;

int fl_ply_is(const fl_bytes *b)
{
    return strncmp(b->data, "ply", 3) == 0 && (b->data[3] == '\n' || b->data[3] == '\r' || b->data[3] == ' ');
}

/* --- header --------------------------------------------------------------------------------------------- */

static int read_type(const fl_bytes *b, int32_t k, ply_type *t, fl_err *err)
{
    const char *word = k < b->words ? b->field[k] : "";
    for (int i = 0; i < TYPES; i++)
        if (strcmp(word, TYPE_NAME[i][0]) == 0 || strcmp(word, TYPE_NAME[i][1]) == 0) {
            *t = (ply_type)i;
            return 0;
        }
    return fl_bytes_fail(b, err, "\"%.40s\" is not a type of PLY 1.0", word);
}

static int read_format(ply_reader *p, fl_err *err)
{
    const fl_bytes *b = p->b;
    const char *word = b->words > 1 ? b->field[1] : "";
    const uint16_t probe = 1;
    const int little = *(const unsigned char *)&probe == 1;
    if (strcmp(word, "ascii") == 0) return 0;
    p->binary = 1;
    if (strcmp(word, "binary_little_endian") == 0) p->swap = !little;
    else if (strcmp(word, "binary_big_endian") == 0) p->swap = little;
    else return fl_bytes_fail(b, err, "format \"%.40s\" is not one of PLY 1.0", word);
    return 0;
}

static int read_element(ply_reader *p, fl_err *err)
{
    const fl_bytes *b = p->b;
    uint64_t n = 0;
    ply_element e = {OTHER, 0, p->prs, p->prs};
    if (b->words != 3 || fl_number_u64(b->field[2], &n) || n > INT64_MAX)
        return fl_bytes_fail(b, err, "\"element NAME COUNT\" is expected");
    e.n = (int64_t)n;
    if (strcmp(b->field[1], "vertex") == 0) e.is = VERTEX;
    if (strcmp(b->field[1], "face") == 0) e.is = FACE;
    if (fl_grow(&p->el, &p->el_cap, (int64_t)p->els + 1, sizeof *p->el, err)) return -1;
    p->el[p->els++] = e;
    return 0;
}

static int read_property(ply_reader *p, fl_err *err)
{
    const fl_bytes *b = p->b;
    const int list = b->words > 1 && strcmp(b->field[1], "list") == 0;
    const char *name = b->field[b->words - 1];
    ply_element *e = p->els ? &p->el[p->els - 1] : NULL;
    ply_property q = {.list = list};
    if (!e) return fl_bytes_fail(b, err, "a property stands before the first element");
    if (b->words != (list ? 5 : 3))
        return fl_bytes_fail(b, err,
                             "\"property TYPE NAME\" or \"property list TYPE TYPE NAME\" is expected");
    if (list && read_type(b, 2, &q.count, err)) return -1;
    if (read_type(b, list ? 3 : 1, &q.of, err)) return -1;
    if (e->is == VERTEX && !list && strlen(name) == 1 && *name >= 'x' && *name <= 'z')
        q.is = *name == 'x' ? X : *name == 'y' ? Y : Z;
    if (e->is == FACE && !list && q.of < F32 && strcmp(name, "part") == 0) q.is = PART;
    if (e->is == FACE && list && (strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0))
        q.is = CORNERS;
    if ((list && q.count >= F32) || (q.is == CORNERS && q.of >= F32))
        return fl_bytes_fail(b, err,
                             "a list is counted, and its vertices are numbered, by a floating-point type");
    if (fl_grow(&p->pr, &p->pr_cap, (int64_t)p->prs + 1, sizeof *p->pr, err)) return -1;
    p->pr[p->prs++] = q;
    e->last = p->prs;
    return 0;
}

/* Each property may be used once, and vertices must precede the faces that refer to them. */
static int check_header(const ply_reader *p, fl_err *err)
{
    int seen[CORNERS + 1] = {0}, elements[FACE + 1] = {0};
    for (int32_t k = 0; k < p->prs; k++) seen[p->pr[k].is]++;
    for (int32_t k = 0; k < p->els; k++) {
        elements[p->el[k].is]++;
        if (p->el[k].is == FACE && !elements[VERTEX])
            return fl_bytes_fail(p->b, err, "the faces stand before the vertices");
    }
    if (elements[VERTEX] != 1 || seen[X] != 1 || seen[Y] != 1 || seen[Z] != 1)
        return fl_bytes_fail(p->b, err, "one element \"vertex\" with properties x, y and z is expected");
    if (seen[PART] > 1) return fl_bytes_fail(p->b, err, "the property part comes twice");
    if (elements[FACE] != 1 || seen[CORNERS] != 1)
        return fl_bytes_fail(p->b, err, "one element \"face\" with one list vertex_indices is expected");
    return 0;
}

/* "comment part NUMBER NAME", as fl_ply_write() writes it; other comments are ignored. */
static int read_comment(ply_reader *p, fl_err *err)
{
    const fl_bytes *b = p->b;
    const int32_t had = p->names.n;
    double x;
    int32_t k;
    if (b->words != 4 || strcmp(b->field[1], "part") != 0 || fl_number_f64(b->field[2], &x)) return 0;
    k = fl_string_table_add(&p->names, b->field[3], err);
    if (k < 0 || fl_grow(&p->number, &p->number_cap, p->names.n, sizeof *p->number, err)) return -1;
    if (k >= had) p->number[k] = x;
    return 0;
}

static int read_header(ply_reader *p, fl_err *err)
{
    fl_bytes *b = p->b;
    int formats = 0, more;
    while ((more = fl_bytes_row(b, err)) > 0) {
        const char *word = b->field[0];
        if (strcmp(word, "end_header") == 0) {
            if (formats != 1)
                return fl_bytes_fail(b, err, "%d format rows in the header, one is expected", formats);
            b->next = b->words;
            return check_header(p, err);
        }
        if (strcmp(word, "format") == 0) {
            formats++;
            if (read_format(p, err)) return -1;
        } else if (strcmp(word, "element") == 0) {
            if (read_element(p, err)) return -1;
        } else if (strcmp(word, "property") == 0) {
            if (read_property(p, err)) return -1;
        } else if (strcmp(word, "comment") == 0) {
            if (read_comment(p, err)) return -1;
        } else if (strcmp(word, "ply") != 0 && strcmp(word, "obj_info") != 0) {
            return fl_bytes_fail(b, err, "\"%.40s\" has no place in a PLY header", word);
        }
    }
    if (more == 0) fl_bytes_fail(b, err, "the file ends inside the header");
    return -1;
}

/* --- data ----------------------------------------------------------------------------------------------- */

static int read_binary(ply_reader *p, ply_type t, double *x, fl_err *err)
{
    const int size = TYPE_SIZE[t];
    const unsigned char *at;
    unsigned char raw[8];
    int more;
    union {
        int8_t i8;
        uint8_t u8;
        int16_t i16;
        uint16_t u16;
        int32_t i32;
        uint32_t u32;
        float f32;
        double f64;
    } u;
    more = fl_bytes_read(p->b, size, &at, err);
    if (more == 0) fl_bytes_fail(p->b, err, "the file ends inside the data");
    if (more <= 0) return -1;
    for (int k = 0; k < size; k++) raw[k] = at[p->swap ? size - 1 - k : k];
    memcpy(&u, raw, (size_t)size);
    switch (t) {
    case I8: *x = u.i8; break;
    case U8: *x = u.u8; break;
    case I16: *x = u.i16; break;
    case U16: *x = u.u16; break;
    case I32: *x = u.i32; break;
    case U32: *x = u.u32; break;
    case F32: *x = (double)u.f32; break;
    default: *x = u.f64; break;
    }
    return 0;
}

/* Read a number of either kind of file; an unused one may be nan. */
static int read_number(ply_reader *p, ply_type t, int used, double *x, fl_err *err)
{
    const char *word = "";
    int more;
    if (p->binary) return read_binary(p, t, x, err);
    if (used) return fl_bytes_f64(p->b, "number", x, err);
    *x = 0.0;
    more = fl_bytes_word(p->b, &word, err);
    if (more == 0) fl_bytes_fail(p->b, err, "the file ends inside the data");
    return more > 0 ? 0 : -1;
}

static int read_list(ply_reader *p, const ply_property *q, const fl_part *part, fl_err *err)
{
    double n = 0.0, v = 0.0;
    if (read_number(p, q->count, 1, &n, err)) return -1;
    if (!(n >= 0.0) || n != floor(n) || (q->is == CORNERS && n > FL_FACET_CORNERS))
        return fl_bytes_fail(p->b, err, "row %lld has a list of %g entries, 0 to %d are expected",
                             (long long)p->row, n, FL_FACET_CORNERS);
    if (q->is == CORNERS && fl_grow(&p->loop, &p->loop_cap, (int64_t)n, sizeof *p->loop, err)) return -1;
    for (double k = 0.0; k < n; k += 1.0) {
        if (read_number(p, q->of, q->is == CORNERS, &v, err)) return -1;
        if (q->is != CORNERS) continue;
        if (!(v >= 0.0 && v < part->nv) || v != floor(v))
            return fl_bytes_fail(p->b, err, "face %lld refers to vertex %g, 0 to %d is expected",
                                 (long long)p->row, v, part->nv - 1);
        p->loop[(int32_t)k] = (int32_t)v;
    }
    if (q->is == CORNERS) p->loop_n = (int32_t)n;
    return 0;
}

/* Read one row of an element. */
static int read_one(ply_reader *p, const ply_element *e, fl_part *part, fl_err *err)
{
    fl_vec3 x = {0};
    double of = 0.0;
    const int32_t had = part->nt;
    p->loop_n = 0;
    for (int32_t k = e->first; k < e->last; k++) {
        const ply_property *q = &p->pr[k];
        double value = 0.0;
        if (q->list ? read_list(p, q, part, err) : read_number(p, q->of, q->is != UNUSED, &value, err))
            return -1;
        if (q->is == X) x.x = value;
        if (q->is == Y) x.y = value;
        if (q->is == Z) x.z = value;
        if (q->is == PART) of = value;
    }
    if (e->is == FACE) {
        if (p->loop_n >= 3 && fl_facet_polygon(part, p->loop_n, p->loop, err)) return -1;
        if (fl_grow(&p->of, &p->of_cap, part->nt, sizeof *p->of, err)) return -1;
        for (int32_t t = had; t < part->nt; t++) p->of[t] = of;
        return 0;
    }
    if (e->is != VERTEX) return 0;
    if (!isfinite(x.x) || !isfinite(x.y) || !isfinite(x.z))
        return fl_bytes_fail(p->b, err, "vertex %lld is %g %g %g, finite numbers are expected",
                             (long long)p->row, x.x, x.y, x.z);
    return fl_surface_vertex(part, x, err);
}

/* --- parts ---------------------------------------------------------------------------------------------- */

enum { MOST = 1000000000 }; /* leaves room for ids of further parts */

typedef struct {
    double of;
    int32_t t;
} part_triangle;

static int by_part(const void *pa, const void *pb)
{
    const part_triangle *a = pa, *b = pb;
    if (a->of != b->of) return a->of < b->of ? -1 : 1;
    return a->t < b->t ? -1 : a->t > b->t;
}

static int by_index(const void *pa, const void *pb)
{
    const int32_t a = *(const int32_t *)pa, b = *(const int32_t *)pb;
    return a < b ? -1 : a > b;
}

/* Add an empty part for the faces of that number. */
static int32_t open_part(const ply_reader *p, fl_surface *s, double of, int keep, fl_err *err)
{
    char text[40];
    const char *name = text;
    int32_t i;
    snprintf(text, sizeof text, "part_%.0f", of);
    for (int32_t k = 0; k < p->names.n; k++)
        if (p->number[k] == of) {
            name = p->names.name[k];
            break;
        }
    i = fl_surface_add(s, name, strlen(name), err);
    if (i >= 0 && keep) s->part[i].id = (int32_t)of;
    return i;
}

/* Fill a part with the triangles d[0 .. n) and the vertices they use, in their order in the file. */
static int fill_part(fl_part *to, const fl_part *all, const part_triangle *d, int32_t n, int32_t *local,
                     fl_err *err)
{
    int32_t *used = fl_alloc(3 * (int64_t)n, sizeof *used, err);
    int rc = -1;
    if (!used) return -1;
    for (int32_t k = 0; k < n; k++)
        for (int c = 0; c < 3; c++) used[3 * (int64_t)k + c] = all->t[d[k].t].v[c];
    qsort(used, 3 * (size_t)n, sizeof *used, by_index);
    for (int64_t k = 0; k < 3 * (int64_t)n; k++) {
        if (k && used[k] == used[k - 1]) continue;
        local[used[k]] = to->nv;
        if (fl_surface_vertex(to, all->v[used[k]], err)) goto done;
    }
    for (int32_t k = 0; k < n; k++) {
        const int32_t *v = all->t[d[k].t].v;
        if (fl_surface_triangle(to, local[v[0]], local[v[1]], local[v[2]], err)) goto done;
    }
    rc = 0;
done:
    free(used);
    return rc;
}

/* Distribute the triangles to the parts that their faces name. */
static int assign_parts(const ply_reader *p, fl_surface *s, fl_part *all, fl_err *err)
{
    part_triangle *d = fl_alloc(all->nt, sizeof *d, err);
    int32_t *local = fl_alloc(all->nv, sizeof *local, err), i;
    int rc = -1;
    if (!d || !local) goto done;
    for (int32_t t = 0; t < all->nt; t++) d[t] = (part_triangle){p->of[t], t};
    qsort(d, (size_t)all->nt, sizeof *d, by_part);
    /* keep the numbers as ids of the parts if all are valid */
    const int keep = all->nt && d[0].of >= 0.0 && d[all->nt - 1].of < MOST;
    for (int32_t from = 0, to; from < all->nt; from = to) {
        for (to = from + 1; to < all->nt && d[to].of == d[from].of; to++) {}
        i = open_part(p, s, d[from].of, keep, err);
        if (i < 0 || fill_part(&s->part[i], all, d + from, to - from, local, err)) goto done;
    }
    rc = 0;
done:
    free(d);
    free(local);
    return rc;
}

/* True if faces have a property with their part. */
static int has_parts(const ply_reader *p)
{
    for (int32_t k = 0; k < p->prs; k++)
        if (p->pr[k].is == PART) return 1;
    return 0;
}

int fl_ply_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    ply_reader p = {.b = b};
    fl_part all = {0};
    int32_t i;
    int rc = -1;
    (void)opt; /* fl_mesh_read() selects parts */
    if (read_header(&p, err)) goto done;
    if (p.binary) b->line = 0;
    for (int32_t e = 0; e < p.els; e++) {
        if (p.el[e].first == p.el[e].last)
            continue; /* a row without properties has no data, however many rows there are */
        for (p.row = 0; p.row < p.el[e].n; p.row++)
            if (read_one(&p, &p.el[e], &all, err)) goto done;
    }
    if (has_parts(&p)) {
        rc = assign_parts(&p, s, &all, err);
        goto done;
    }
    i = fl_surface_add(s, name, strlen(name), err);
    if (i < 0) goto done;
    all.name = s->part[i].name;
    all.id = s->part[i].id;
    s->part[i] = all;
    all = (fl_part){0};
    rc = 0;
done:
    fl_part_free(&all);
    fl_string_table_free(&p.names);
    free(p.number);
    free(p.of);
    free(p.el);
    free(p.pr);
    free(p.loop);
    return rc;
}
