/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <zlib.h>
#include "base/decimal.h"
#include "base/array.h"
#include "base/number_text.h"
#include "mesh/element_surface.h"
#include "mesh/read_vtk_xml.h"
#include "mesh/vtk_cells.h"

enum { WORD_MAX = 80, CHUNK = 1 << 16 };

/* Section in which an array stands. */
typedef enum { ELSEWHERE, FIELD_DATA, CELL_DATA, POINTS, VERTS, LINES, STRIPS, POLYS, CELLS } section_kind;

static const struct {
    const char *tag;
    section_kind is;
} SECTION[] = {{"FieldData", FIELD_DATA}, {"CellData", CELL_DATA}, {"PointData", ELSEWHERE},
               {"Points", POINTS},        {"Verts", VERTS},        {"Lines", LINES},
               {"Strips", STRIPS},        {"Polys", POLYS},        {"Cells", CELLS}};

/* Attributes of an array. */
typedef struct {
    char name[WORD_MAX], type[WORD_MAX], format[WORD_MAX];
    int64_t offset;
    int32_t from, to; /* its text, begin and end */
    int32_t tag;      /* position of the tag, for messages */
    section_kind in;
    int32_t piece;
} xml_array;

typedef struct {
    fl_bytes *b;
    int big, wide, packed; /* byte order big-endian; headers of 8 bytes; zlib */
    int poly;              /* PolyData */
    xml_array *a;
    int32_t arrays, cap, pieces;
    int32_t appended; /* begin of the appended data, -1 for none */
    int base64;       /* the appended data are base64 */
} vtk_xml_reader;

/* Bytes of an array: raw, or decoded from base64. */
typedef struct {
    const vtk_xml_reader *v;
    const xml_array *a;
    int32_t pos, end;
    int base64, have, next; /* of out: the bytes of one group of four characters */
    unsigned char out[3];
} byte_source;

int fl_vtk_xml_is(const fl_bytes *b)
{
    const char *p = b->data + strspn(b->data, " \t\r\n");
    return strncmp(p, "<?xml", 5) == 0 || strncmp(p, "<VTKFile", 8) == 0 || strncmp(p, "<!--", 4) == 0;
}

static int fail_at(const vtk_xml_reader *v, int32_t at, fl_err *err, const char *fmt, ...)
    __attribute__((format(printf, 4, 5)));

/* Fail with the line of a position in the text. */
static int fail_at(const vtk_xml_reader *v, int32_t at, fl_err *err, const char *fmt, ...)
{
    char what[300];
    va_list ap;
    v->b->line = 1;
    for (int32_t k = 0; k < at && k < v->b->n; k++) v->b->line += v->b->data[k] == '\n';
    va_start(ap, fmt);
    vsnprintf(what, sizeof what, fmt, ap);
    va_end(ap);
    return fl_bytes_fail(v->b, err, "%s", what);
}

/* --- tags ----------------------------------------------------------------------------------------------- */

/* Copy the value of an attribute of the tag at p[0 .. n); "" if it has none. */
static void get_attribute(const char *p, size_t n, const char *key, char value[WORD_MAX])
{
    const size_t len = strlen(key);
    value[0] = '\0';
    for (size_t k = 1; k + len + 2 < n; k++) {
        size_t to = 0, at = k + len;
        char quote;
        if (!strchr(" \t\r\n", p[k - 1]) || strncmp(p + k, key, len) != 0) continue;
        while (at < n && strchr(" \t\r\n", p[at])) at++;
        if (at >= n || p[at++] != '=') continue;
        while (at < n && strchr(" \t\r\n", p[at])) at++;
        if (at >= n || (p[at] != '"' && p[at] != '\'')) continue;
        for (quote = p[at++]; at < n && p[at] != quote && to < WORD_MAX - 1; at++) value[to++] = p[at];
        value[to] = '\0';
        return;
    }
}

static int read_file_tag(vtk_xml_reader *v, int32_t at, const char *p, size_t n, fl_err *err)
{
    char type[WORD_MAX], order[WORD_MAX], header[WORD_MAX], packing[WORD_MAX];
    get_attribute(p, n, "type", type);
    get_attribute(p, n, "byte_order", order);
    get_attribute(p, n, "header_type", header);
    get_attribute(p, n, "compressor", packing);
    v->poly = strcmp(type, "PolyData") == 0;
    if (!v->poly && strcmp(type, "UnstructuredGrid") != 0)
        return fail_at(
            v, at, err,
            "a VTK file of type \"%.40s\" was found: PolyData or UnstructuredGrid in one file is expected",
            type);
    if (*packing && strcmp(packing, "vtkZLibDataCompressor") != 0)
        return fail_at(v, at, err, "packed by %.40s: write the file with zlib or not packed", packing);
    v->packed = *packing != '\0';
    v->big = strcasecmp(order, "BigEndian") == 0;
    v->wide = strcasecmp(header, "UInt64") == 0;
    return 0;
}

static int add_array(vtk_xml_reader *v, int32_t at, const char *p, size_t n, int closed, section_kind in,
                     fl_err *err)
{
    xml_array a = {.in = in, .piece = v->pieces - 1, .tag = at, .from = at + (int32_t)n + 1};
    char offset[WORD_MAX];
    const char *end;
    uint64_t u = 0;
    get_attribute(p, n, "Name", a.name);
    get_attribute(p, n, "type", a.type);
    get_attribute(p, n, "format", a.format);
    get_attribute(p, n, "offset", offset);
    if (*offset && (fl_number_u64(offset, &u) || u > INT32_MAX))
        return fail_at(v, at, err, "an offset of \"%.40s\" was found", offset);
    a.offset = (int64_t)u;
    a.to = a.from;
    if (!closed) {
        end = strchr(v->b->data + a.from, '<');
        if (!end) return fail_at(v, at, err, "the file ends inside the array \"%.40s\"", a.name);
        a.to = (int32_t)(end - v->b->data);
    }
    if (fl_grow(&v->a, &v->cap, (int64_t)v->arrays + 1, sizeof *v->a, err)) return -1;
    v->a[v->arrays++] = a;
    return 0;
}

/* Process a tag.  Returns 1 at the tag behind which the appended data begin. */
static int process_tag(vtk_xml_reader *v, int32_t at, const char *p, size_t n, section_kind *in, int *opened,
                       fl_err *err)
{
    const int closed = n > 0 && p[n - 1] == '/';
    const size_t word = strcspn(p, " \t\r\n/>");
    const int section_end = p[0] == '/';
    for (size_t k = 0; k < sizeof SECTION / sizeof SECTION[0]; k++) {
        const size_t len = strlen(SECTION[k].tag);
        if (word == len && strncmp(p, SECTION[k].tag, len) == 0) *in = SECTION[k].is;
        if (section_end && strncmp(p + 1, SECTION[k].tag, len) == 0) *in = ELSEWHERE;
    }
    if (section_end) return 0;
    if (word == 7 && strncmp(p, "VTKFile", 7) == 0) {
        *opened = 1;
        return read_file_tag(v, at, p, n, err);
    }
    if (!*opened)
        return fail_at(v, at, err, "<%.*s> was found, <VTKFile> is expected", (int)(word < 40 ? word : 40),
                       p);
    if (word == 5 && strncmp(p, "Piece", 5) == 0) v->pieces++;
    if ((word == 9 && strncmp(p, "DataArray", 9) == 0) || (word == 5 && strncmp(p, "Array", 5) == 0))
        return add_array(v, at, p, n, closed, *in, err);
    if (word == 12 && strncmp(p, "AppendedData", 12) == 0) {
        char encoding[WORD_MAX];
        const char *mark = strchr(p + n, '_');
        get_attribute(p, n, "encoding", encoding);
        v->base64 = strcmp(encoding, "base64") == 0;
        if (!v->base64 && strcmp(encoding, "raw") != 0)
            return fail_at(v, at, err, "appended data are encoded as \"%.40s\", raw or base64 is expected",
                           encoding);
        if (!mark) return fail_at(v, at, err, "the file ends before the appended data");
        v->appended = (int32_t)(mark + 1 - v->b->data);
        return 1;
    }
    return 0;
}

/* Process all tags up to the appended data. */
static int read_tags(vtk_xml_reader *v, fl_err *err)
{
    const char *data = v->b->data, *p = data;
    section_kind in = ELSEWHERE;
    int opened = 0, done = 0, closed = 0;
    while (!done && (p = strchr(p, '<')) != NULL) {
        const int32_t at = (int32_t)(p + 1 - data);
        const char *end;
        if (strncmp(p, "<!--", 4) == 0) {
            end = strstr(p, "-->");
            if (!end) return fail_at(v, at, err, "the file ends inside a comment");
            p = end + 3;
            continue;
        }
        end = strchr(p, '>');
        if (!end) return fail_at(v, at, err, "the file ends inside a tag");
        if (p[1] != '?' && p[1] != '!') {
            done = process_tag(v, at, p + 1, (size_t)(end - p - 1), &in, &opened, err);
            if (done < 0) return -1;
            closed |= strncmp(p, "</VTKFile", 9) == 0;
        }
        p = end + 1;
    }
    if (!opened) return fail_at(v, 0, err, "XML without <VTKFile>");
    if (!done && !closed) return fail_at(v, v->b->n, err, "the file ends before </VTKFile>");
    return 0;
}

/* --- bytes of an array ---------------------------------------------------------------------------------- */

static int fail_in(const byte_source *s, fl_err *err, const char *what)
{
    if (s->v->appended >= 0 && s->pos >= s->v->appended) {
        s->v->b->line = 0;
        return fl_bytes_fail(s->v->b, err, "byte %d, in the array \"%.40s\": %s", s->pos, s->a->name, what);
    }
    return fail_at(s->v, s->a->tag, err, "in the array \"%.40s\": %s", s->a->name, what);
}

static int base64_value(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : c == '=' ? 64 : -1;
}

/* Decode four characters to up to three bytes.  Fewer than three end one encoded text; another may follow, as
 * the data behind their header. */
static int decode_group(byte_source *s, fl_err *err)
{
    uint32_t bits = 0;
    int n = 0, pads = 0;
    while (n < 4) {
        int k;
        if (s->pos >= s->end) return fail_in(s, err, "the data end too early");
        k = base64_value(s->v->b->data[s->pos]);
        if (k < 0 && !strchr(" \t\r\n", s->v->b->data[s->pos])) {
            return fail_in(s, err,
                           s->v->b->data[s->pos] == '<' ? "the data end too early"
                                                        : "a letter that is none of base64");
        }
        s->pos++;
        if (k < 0) continue;
        if (k < 64 && pads) return fail_in(s, err, "base64 goes on behind its end");
        pads += k == 64;
        bits = bits << 6 | (uint32_t)(k & 63);
        n++;
    }
    if (pads > 2) return fail_in(s, err, "base64 with three ends");
    for (int k = 0; k < 3; k++) s->out[k] = (unsigned char)(bits >> (16 - 8 * k) & 0xff);
    s->next = 0;
    s->have = 3 - pads;
    return 0;
}

static int read_bytes(byte_source *s, unsigned char *to, int64_t n, fl_err *err)
{
    if (!s->base64) {
        if (n > s->end - s->pos) return fail_in(s, err, "the data end too early");
        memcpy(to, s->v->b->data + s->pos, (size_t)n);
        s->pos += (int32_t)n;
        return 0;
    }
    for (int64_t k = 0; k < n; k++) {
        if (s->next == s->have && decode_group(s, err)) return -1;
        to[k] = s->out[s->next++];
    }
    return 0;
}

static uint64_t bits_of(const vtk_xml_reader *v, const unsigned char *p, int n)
{
    uint64_t u = 0;
    for (int k = 0; k < n; k++) u = u << 8 | p[v->big ? k : n - 1 - k];
    return u;
}

static int read_header(byte_source *s, uint64_t *u, fl_err *err)
{
    unsigned char byte[8];
    const int n = s->v->wide ? 8 : 4;
    if (read_bytes(s, byte, n, err)) return -1;
    *u = bits_of(s->v, byte, n);
    return 0;
}

typedef struct {
    unsigned char *byte;
    int32_t n, cap;
} buffer;

/* Read n bytes; memory grows only as they are read. */
static int read_plain(byte_source *s, buffer *out, uint64_t n, fl_err *err)
{
    if (n > INT32_MAX) return fail_in(s, err, "more than 2 GiB in one array");
    while ((uint64_t)out->n < n) {
        const int64_t left = (int64_t)n - out->n, part = left < CHUNK ? left : CHUNK;
        if (fl_grow(&out->byte, &out->cap, out->n + part, 1, err) ||
            read_bytes(s, out->byte + out->n, part, err))
            return -1;
        out->n += (int32_t)part;
    }
    return 0;
}

static int inflate_block(byte_source *s, buffer *out, const buffer *in, uint64_t size, fl_err *err)
{
    z_stream z = {0};
    const int32_t begin = out->n;
    int rc = Z_OK;
    z.next_in = in->byte;
    z.avail_in = (uInt)in->n;
    if (inflateInit(&z) != Z_OK) return fl_fail(err, FL_SYSTEM, "out of memory for zlib");
    while (rc == Z_OK && (uint64_t)(out->n - begin) <= size) {
        if (fl_grow(&out->byte, &out->cap, (int64_t)out->n + CHUNK, 1, err)) {
            inflateEnd(&z);
            return -1;
        }
        z.next_out = out->byte + out->n;
        z.avail_out = CHUNK;
        rc = inflate(&z, Z_NO_FLUSH);
        if (rc != Z_OK && rc != Z_STREAM_END) break;
        out->n += (int32_t)(CHUNK - z.avail_out);
        if (rc == Z_OK && z.avail_out == CHUNK && z.avail_in == 0) break; /* truncated */
    }
    inflateEnd(&z);
    if (rc == Z_MEM_ERROR) return fl_fail(err, FL_SYSTEM, "out of memory for zlib");
    if (rc != Z_STREAM_END || (uint64_t)(out->n - begin) != size)
        return fail_in(s, err, "a packed block is damaged");
    return 0;
}

/* Compressed data: the number of blocks, the size of each and of the last (0 if full), their compressed
 * sizes; then the blocks. */
static int read_compressed(byte_source *s, buffer *out, fl_err *err)
{
    uint64_t blocks, size, last, u;
    buffer in = {0};
    uint64_t *length = NULL;
    int32_t cap = 0;
    int rc = -1;
    if (read_header(s, &blocks, err) || read_header(s, &size, err) || read_header(s, &last, err)) return -1;
    if (size > INT32_MAX || last > size) return fail_in(s, err, "blocks of a size that cannot be");
    for (uint64_t k = 0; k < blocks; k++) {
        if (read_header(s, &u, err)) goto done;
        if (k >= INT32_MAX || fl_grow(&length, &cap, (int64_t)k + 1, sizeof *length, err)) goto done;
        length[k] = u;
    }
    for (uint64_t k = 0; k < blocks; k++) {
        in.n = 0;
        if (read_plain(s, &in, length[k], err) ||
            inflate_block(s, out, &in, k + 1 == blocks && last ? last : size, err))
            goto done;
    }
    rc = 0;
done:
    free(length);
    free(in.byte);
    return rc;
}

static int array_bytes(const vtk_xml_reader *v, const xml_array *a, buffer *out, fl_err *err)
{
    byte_source s = {.v = v, .a = a, .pos = a->from, .end = a->to, .base64 = 1};
    uint64_t n;
    if (strcmp(a->format, "appended") == 0) {
        if (v->appended < 0 || a->offset > v->b->n - v->appended)
            return fail_at(v, a->tag, err, "the array \"%.40s\" is appended at %lld, where nothing is",
                           a->name, (long long)a->offset);
        s.pos = v->appended + (int32_t)a->offset;
        s.end = v->b->n;
        s.base64 = v->base64;
    }
    if (v->packed) return read_compressed(&s, out, err);
    if (read_header(&s, &n, err)) return -1;
    return read_plain(&s, out, n, err);
}

/* --- numbers -------------------------------------------------------------------------------------------- */

static double decode_number(const vtk_xml_reader *v, const unsigned char *p, int bytes, char kind)
{
    uint64_t u = bits_of(v, p, bytes);
    float single;
    double x;
    uint32_t half;
    if (kind == 'u') return (double)u;
    if (kind == 'i') {
        if (bytes < 8 && u >> (8 * bytes - 1)) u |= ~(uint64_t)0 << 8 * bytes;
        return (double)(int64_t)u;
    }
    if (bytes == 4) {
        half = (uint32_t)u;
        memcpy(&single, &half, sizeof single);
        return (double)single;
    }
    memcpy(&x, &u, sizeof x);
    return x;
}

/* Size and kind of a type: "Int32" has 4 bytes and kind 'i'. */
static int type_of(const vtk_xml_reader *v, const xml_array *a, int *bytes, char *kind, fl_err *err)
{
    static const struct {
        const char *name;
        int bytes;
        char kind;
    } type[] = {{"Int8", 1, 'i'},    {"UInt8", 1, 'u'},   {"Int16", 2, 'i'}, {"UInt16", 2, 'u'},
                {"Int32", 4, 'i'},   {"UInt32", 4, 'u'},  {"Int64", 8, 'i'}, {"UInt64", 8, 'u'},
                {"Float32", 4, 'f'}, {"Float64", 8, 'f'}, {"String", 1, 'u'}};
    for (size_t k = 0; k < sizeof type / sizeof type[0]; k++)
        if (strcmp(type[k].name, a->type) == 0) {
            *bytes = type[k].bytes;
            *kind = type[k].kind;
            return 0;
        }
    return fail_at(v, a->tag, err, "the array \"%.40s\" is of type \"%.40s\"", a->name, a->type);
}

static int parse_text(const vtk_xml_reader *v, const xml_array *a, fl_vtk_array *out, fl_err *err)
{
    const char *p = v->b->data + a->from, *const end = v->b->data + a->to;
    int32_t cap = 0, n = 0;
    for (;;) {
        const char *next;
        while (p < end && strchr(" \t\r\n\f\v", *p)) p++;
        if (p >= end) break;
        if (fl_grow(&out->x, &cap, (int64_t)n + 1, sizeof *out->x, err)) return -1;
        next = fl_decimal_read(p, &out->x[n]);
        if (!next || !strchr(" \t\r\n\f\v<", *next)) {
            const size_t k = strcspn(p, " \t\r\n\f\v<");
            return fail_at(v, (int32_t)(p - v->b->data), err, "\"%.*s\" was found, a number is expected",
                           (int)(k < 40 ? k : 40), p);
        }
        n++;
        p = next;
    }
    out->n = n;
    return 0;
}

static int read_values(const vtk_xml_reader *v, const xml_array *a, fl_vtk_array *out, fl_err *err)
{
    buffer raw = {0};
    int bytes = 1, rc = -1;
    char kind = 'u';
    free(out->x);
    *out = (fl_vtk_array){0};
    if (type_of(v, a, &bytes, &kind, err)) return -1;
    if (strcmp(a->format, "ascii") == 0) return parse_text(v, a, out, err);
    if (strcmp(a->format, "binary") != 0 && strcmp(a->format, "appended") != 0)
        return fail_at(v, a->tag, err, "the array \"%.40s\" has the format \"%.40s\"", a->name, a->format);
    if (array_bytes(v, a, &raw, err)) goto done;
    if (raw.n % bytes) {
        fail_at(v, a->tag, err, "the array \"%.40s\" has %d bytes, which are no numbers of %d", a->name,
                raw.n, bytes);
        goto done;
    }
    out->x = fl_alloc(raw.n / bytes, sizeof *out->x, err);
    if (!out->x) goto done;
    for (; out->n < raw.n / bytes; out->n++)
        out->x[out->n] = decode_number(v, raw.byte + out->n * bytes, bytes, kind);
    rc = 0;
done:
    free(raw.byte);
    return rc;
}

/* --- pieces --------------------------------------------------------------------------------------------- */

static const xml_array *find_array(const vtk_xml_reader *v, int32_t piece, section_kind in, const char *name)
{
    for (int32_t k = 0; k < v->arrays; k++)
        if (v->a[k].in == in && v->a[k].piece == piece && (!name || strcmp(v->a[k].name, name) == 0))
            return &v->a[k];
    return NULL;
}

/* Names of parts (bytes, each name ended by a zero) and their numbers. */
static int read_names(const vtk_xml_reader *v, fl_vtk_names *names, fl_err *err)
{
    const xml_array *text = NULL, *id = NULL;
    fl_vtk_array t = {0}, n = {0};
    char word[256];
    size_t len = 0;
    int64_t k = 0;
    int rc = -1;
    for (int32_t i = 0; i < v->arrays; i++) {
        if (v->a[i].in != FIELD_DATA) continue;
        if (strcmp(v->a[i].name, "part_name") == 0) text = &v->a[i];
        if (strcmp(v->a[i].name, "part_id") == 0) id = &v->a[i];
    }
    if (!text || !id) return 0;
    if (read_values(v, text, &t, err) || read_values(v, id, &n, err)) goto done;
    for (int64_t i = 0; i < t.n; i++) {
        const int c = t.x[i] > 0.0 && t.x[i] < 256.0 ? (int)t.x[i] : 0;
        if (c && len < sizeof word - 1) word[len++] = (char)c;
        if (c) continue;
        word[len] = '\0';
        len = 0;
        if (k < n.n && fabs(n.x[k]) < 1e15 && fl_vtk_names_add(names, (int64_t)n.x[k], word, err)) goto done;
        k++;
    }
    rc = 0;
done:
    free(t.x);
    free(n.x);
    return rc;
}

static int append_numbers(fl_vtk_array *to, const fl_vtk_array *from, double add, fl_err *err)
{
    double *x = fl_alloc(to->n + from->n, sizeof *x, err);
    if (!x) return -1;
    if (to->n) memcpy(x, to->x, (size_t)to->n * sizeof *x);
    for (int64_t k = 0; k < from->n; k++) x[to->n + k] = from->x[k] + add;
    free(to->x);
    to->x = x;
    to->n += from->n;
    return 0;
}

/* Verts, Lines, Strips and Polys, in the order in which VTK numbers their cells: verts, lines, polys, strips.
 */
static int read_lists(const vtk_xml_reader *v, int32_t piece, fl_vtk_grid *g, fl_err *err)
{
    static const section_kind order[] = {VERTS, LINES, POLYS, STRIPS};
    static const int type[] = {2, 4, 7, 6};
    for (int k = 0; k < 4; k++) {
        const xml_array *c = find_array(v, piece, order[k], "connectivity"),
                        *o = find_array(v, piece, order[k], "offsets");
        fl_vtk_array corner = {0}, offset = {0};
        int rc = 0;
        if (!c || !o) continue;
        if (read_values(v, c, &corner, err) || read_values(v, o, &offset, err) ||
            append_numbers(&g->offset, &offset, (double)g->corner.n, err) ||
            append_numbers(&g->corner, &corner, 0.0, err))
            rc = -1;
        for (int64_t i = 0; rc == 0 && i < offset.n; i++) offset.x[i] = type[k];
        if (rc == 0) rc = append_numbers(&g->type, &offset, 0.0, err);
        free(corner.x);
        free(offset.x);
        if (rc) return -1;
    }
    return 0;
}

static int read_cells(const vtk_xml_reader *v, int32_t piece, fl_vtk_grid *g, fl_err *err)
{
    const xml_array *c = find_array(v, piece, CELLS, "connectivity"),
                    *o = find_array(v, piece, CELLS, "offsets");
    const xml_array *t = find_array(v, piece, CELLS, "types"), *f = find_array(v, piece, CELLS, "faces");
    const xml_array *l = find_array(v, piece, CELLS, "faceoffsets");
    if (!c || !o || !t)
        return fail_at(v, v->b->n, err, "piece %d lacks connectivity, offsets or types", piece + 1);
    if (read_values(v, c, &g->corner, err) || read_values(v, o, &g->offset, err) ||
        read_values(v, t, &g->type, err))
        return -1;
    if (!f || !l) return 0;
    return read_values(v, f, &g->face, err) || read_values(v, l, &g->face_last, err) ? -1 : 0;
}

static int read_piece(const vtk_xml_reader *v, int32_t piece, fl_elements *e, const fl_vtk_names *names,
                      const char *name, int32_t *coarse, fl_err *err)
{
    fl_vtk_grid g = {0};
    const xml_array *x = find_array(v, piece, POINTS, NULL), *part = NULL;
    int best = -1, rc = -1;
    if (!x) return 0; /* an empty piece */
    for (int32_t k = 0; k < v->arrays; k++) {
        const xml_array *a = &v->a[k];
        const int rank = a->in == CELL_DATA && a->piece == piece ? fl_vtk_part_rank(a->name) : -1;
        if (rank < 0 || (best >= 0 && best <= rank) || strstr(a->type, "Float")) continue;
        best = rank;
        part = a;
    }
    if (read_values(v, x, &g.point, err)) goto done;
    if (v->poly ? read_lists(v, piece, &g, err) : read_cells(v, piece, &g, err)) goto done;
    if (part && read_values(v, part, &g.part, err)) goto done;
    if (part) snprintf(g.part_word, sizeof g.part_word, "%.39s", part->name);
    rc = fl_vtk_add_cells(e, &g, piece, names, name, coarse, err);
done:
    fl_vtk_grid_free(&g);
    return rc;
}

int fl_vtk_xml_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    vtk_xml_reader v = {.b = b, .appended = -1};
    fl_vtk_names names = {0};
    fl_elements e;
    int32_t coarse = 0;
    int rc = -1;
    if (fl_elements_start(&e, fl_in_name(b->in), err)) return -1;
    if (read_tags(&v, err) || read_names(&v, &names, err)) goto done;
    for (int32_t k = 0; k < v.pieces; k++)
        if (read_piece(&v, k, &e, &names, name, &coarse, err)) goto done;
    b->line = 0;
    if (coarse) fl_bytes_note(b, "%d cells of higher order were reduced to their corners", coarse);
    rc = fl_elements_surface(&e, s, b, opt, err);
done:
    free(v.a);
    fl_vtk_names_free(&names);
    fl_elements_free(&e);
    return rc;
}
