/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/number_text.h"
#include "base/text.h"
#include "mesh/gstruct.h"

static const char *const record[] = {"part", "v", "t", "cone"};

static int read_vec3(fl_text *in, fl_vec3 *x, fl_err *err)
{
    return fl_text_f64(in, "x", &x->x, err) || fl_text_f64(in, "y", &x->y, err) ||
                   fl_text_f64(in, "z", &x->z, err)
               ? -1
               : 0;
}

static int read_part(fl_text *in, fl_surface *s, fl_err *err)
{
    const char *name = "";
    int32_t id = 0, k;
    if (fl_text_i32(in, "part id", 0, 999999999, &id, err) || fl_text_word(in, "part name", &name, err) ||
        fl_text_no_more(in, err))
        return -1;
    for (k = 0; k < s->n; k++)
        if (s->part[k].id == id) return fl_text_fail(in, err, "part id %d is used a second time", id);
    if (fl_surface_find(s, name, strlen(name)) >= 0)
        return fl_text_fail(in, err, "part name \"%.60s\" is used a second time", name);
    if (strcmp(name, FL_GSTRUCT_TOTAL) == 0)
        return fl_text_fail(in, err,
                            "a part is called " FL_GSTRUCT_TOTAL
                            ", as loads call the sum over the parts: another name is expected");
    k = fl_surface_add(s, name, strlen(name), err);
    if (k < 0) return -1;
    s->part[k].id = id;
    return 0;
}

static int read_triangle(fl_text *in, fl_part *p, fl_err *err)
{
    int32_t v[3] = {0};
    for (int k = 0; k < 3; k++) {
        if (fl_text_i32(in, "vertex index", 0, INT32_MAX, &v[k], err)) return -1;
        if (v[k] >= p->nv)
            return fl_text_fail(in, err, "triangle %d refers to vertex %d, but part \"%.60s\" has %d so far",
                                p->nt, v[k], p->name, p->nv);
    }
    if (fl_text_no_more(in, err)) return -1;
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
        return fl_text_fail(in, err, "triangle %d %d %d repeats a vertex", v[0], v[1], v[2]);
    if (p->nt == 0) p->line = (int32_t)in->line_number;
    p->last_line = (int32_t)in->line_number;
    return fl_surface_triangle(p, v[0], v[1], v[2], err);
}

static int read_cone(fl_text *in, fl_part *p, fl_err *err)
{
    fl_cone c = {0};
    if (read_vec3(in, &c.p0, err) || fl_text_f64(in, "first radius", &c.r0, err) ||
        read_vec3(in, &c.p1, err) || fl_text_f64(in, "second radius", &c.r1, err) || fl_text_no_more(in, err))
        return -1;
    if (c.r0 < 0 || c.r1 < 0)
        return fl_text_fail(in, err, "cone radius %g is negative", c.r0 < 0 ? c.r0 : c.r1);
    if (c.r0 == 0 && c.r1 == 0) return fl_text_fail(in, err, "both radii of the cone are 0");
    if (!(v3_norm(v3_sub(c.p1, c.p0)) > 0)) return fl_text_fail(in, err, "the cone has no length");
    return fl_surface_cone(p, c, err);
}

static int read_row(fl_text *in, fl_surface *s, fl_err *err)
{
    fl_part *p = s->n ? &s->part[s->n - 1] : NULL;
    const char *word = "";
    fl_vec3 x = {0};
    if (fl_text_word(in, "record", &word, err)) return -1;
    if (strcmp(word, "part") == 0) return read_part(in, s, err);
    if (!p && (strcmp(word, "v") == 0 || strcmp(word, "t") == 0 || strcmp(word, "cone") == 0))
        return fl_text_fail(in, err, "\"%s\" stands before the first part", word);
    if (strcmp(word, "v") == 0) {
        if (read_vec3(in, &x, err) || fl_text_no_more(in, err)) return -1;
        return fl_surface_vertex(p, x, err);
    }
    if (strcmp(word, "t") == 0) return read_triangle(in, p, err);
    if (strcmp(word, "cone") == 0) return read_cone(in, p, err);
    return fl_text_fail(in, err, "unknown record \"%.40s\", the nearest is \"%s\"", word,
                        fl_text_nearest(word, record, 4));
}

static int is_empty(const fl_part *p) { return p->nt == 0 && p->nc == 0; }

int fl_gstruct_read_text(fl_surface *s, fl_text *in, fl_err *err)
{
    fl_surface got = {0};
    int32_t opened = 0; /* line of the latest part */
    int rc = -1, more;

    if (fl_text_magic(in, "g_struct", FL_GSTRUCT_VERSION, err)) goto done;
    while ((more = fl_text_row(in, err)) > 0) {
        if (strcmp(in->field[0], "part") == 0) {
            if (got.n && is_empty(&got.part[got.n - 1])) break;
            opened = (int32_t)in->line_number;
        }
        if (read_row(in, &got, err)) goto done;
    }
    if (more < 0) goto done;
    if (got.n == 0) {
        fl_fail(err, FL_INPUT, "%s: no part, at least one with triangles or cones is expected",
                fl_in_name(in->in));
        goto done;
    }
    if (is_empty(&got.part[got.n - 1])) {
        fl_fail(err, FL_INPUT, "%s:%d: part \"%.60s\" has neither triangles nor cones", fl_in_name(in->in),
                opened, got.part[got.n - 1].name);
        goto done;
    }
    got.history = in->history;
    in->history = NULL;
    *s = got;
    got = (fl_surface){0};
    rc = 0;
done:
    fl_surface_free(&got);
    fl_text_close(in);
    return rc;
}

int fl_gstruct_read(fl_surface *s, const char *path, fl_err *err)
{
    fl_text in = {0};
    return fl_text_open(&in, path, err) ? -1 : fl_gstruct_read_text(s, &in, err);
}

int fl_gstruct_is(const fl_bytes *b)
{
    return strncasecmp(b->data + strspn(b->data, " \t\r\n"), "#g_struct", 9) == 0;
}

int fl_gstruct_read_bytes(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    fl_text text = {.in = b->in, .chunk = b->data, .chunk_len = b->n};
    (void)name;
    (void)opt;
    b->in = NULL;
    b->data = NULL;
    return fl_gstruct_read_text(s, &text, err);
}

static void put_number(FILE *f, const char *before, double x)
{
    char text[FL_NUMBER_LEN];
    fprintf(f, "%s%s", before, fl_number_text(x, text));
}

static void put_disc(FILE *f, fl_vec3 p, double r)
{
    put_number(f, " ", p.x);
    put_number(f, " ", p.y);
    put_number(f, " ", p.z);
    put_number(f, " ", r);
}

/* Vertices and triangles may be millions: all threads format blocks of rows, which are written in order. */
enum { ROW = 2 + 3 * FL_NUMBER_LEN, ROWS = 512, BLOCKS = 64 };
typedef char *put_row(char *to, const fl_part *p, int32_t k);

static char *put_vertex(char *to, const fl_part *p, int32_t k)
{
    const double c[3] = {p->v[k].x, p->v[k].y, p->v[k].z};
    *to++ = 'v';
    for (int i = 0; i < 3; i++) {
        *to++ = ' ';
        to += strlen(fl_number_text(c[i], to));
    }
    *to++ = '\n';
    return to;
}

static char *put_triangle(char *to, const fl_part *p, int32_t k)
{
    *to++ = 't';
    for (int i = 0; i < 3; i++) {
        char digit[10];
        uint32_t n = (uint32_t)p->t[k].v[i];
        int m = 0;
        do digit[m++] = (char)('0' + n % 10);
        while ((n /= 10) > 0);
        *to++ = ' ';
        while (m > 0) *to++ = digit[--m];
    }
    *to++ = '\n';
    return to;
}

/* Format rows from .. to of a part into a block; returns its length. */
static size_t format_rows(char *block, put_row *row, const fl_part *p, int32_t from, int32_t to)
{
    char *end = block;
    for (int32_t k = from; k < to; k++) end = row(end, p, k);
    return (size_t)(end - block);
}

static void put_rows(FILE *f, put_row *row, const fl_part *p, int32_t n)
{
    char one[ROWS * ROW], *many = n > ROWS ? malloc((size_t)BLOCKS * ROWS * ROW) : NULL;
    char *const block = many ? many : one; /* without memory, one block at a time */
    const int32_t blocks = many ? BLOCKS : 1;
    size_t length[BLOCKS];
    for (int64_t from = 0; from < n; from += (int64_t)blocks * ROWS) {
        const int64_t left = (n - from + ROWS - 1) / ROWS;
        const int32_t now = left < blocks ? (int32_t)left : blocks;
#pragma omp parallel for schedule(static) if (now > 1)
        for (int32_t b = 0; b < now; b++) {
            const int64_t first = from + (int64_t)b * ROWS, last = first + ROWS < n ? first + ROWS : n;
            length[b] = format_rows(block + (size_t)b * ROWS * ROW, row, p, (int32_t)first, (int32_t)last);
        }
        for (int32_t b = 0; b < now; b++) fwrite(block + (size_t)b * ROWS * ROW, 1, length[b], f);
    }
    free(many);
}

void fl_gstruct_write(FILE *f, const fl_surface *s, const fl_history_line *by)
{
    fl_write_file_header(f, "g_struct", FL_GSTRUCT_VERSION, s->history, by);
    for (int32_t i = 0; i < s->n; i++) {
        const fl_part *p = &s->part[i];
        fprintf(f, "part %d %s\n", p->id, p->name);
        put_rows(f, put_vertex, p, p->nv);
        put_rows(f, put_triangle, p, p->nt);
        for (int32_t c = 0; c < p->nc; c++) {
            fputs("cone", f);
            put_disc(f, p->cone[c].p0, p->cone[c].r0);
            fputc(' ', f);
            put_disc(f, p->cone[c].p1, p->cone[c].r1);
            fputc('\n', f);
        }
    }
}
