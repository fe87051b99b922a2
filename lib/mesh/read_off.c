/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "geom/facet.h"
#include "mesh/read_off.h"

/* Length of a header word, [ST][C][N][4][n]OFF, before a blank or a line end; 0 if p holds none. */
static size_t header_word(const char *p)
{
    const char *q = p;
    if (strncmp(q, "ST", 2) == 0) q += 2;
    for (const char *letter = "CN4n"; *letter; letter++)
        if (*q == *letter) q++;
    if (strncmp(q, "OFF", 3) != 0) return 0;
    q += 3;
    return *q == '\0' || strchr(" \t\r\n", *q) ? (size_t)(q - p) : 0;
}

/* First byte that is neither blank nor comment. */
static const char *first_word(const char *p)
{
    for (p += strspn(p, " \t\r\n"); *p == '#'; p += strspn(p, " \t\r\n")) p += strcspn(p, "\r\n");
    return p;
}

int fl_off_is(const fl_bytes *b)
{
    const char *p = first_word(b->data);
    if (!fl_bytes_is_text(b)) return 0;
    if (header_word(p)) return 1;
    for (int k = 0; k < 3; k++) {
        const size_t digits = strspn(p, "0123456789");
        if (digits == 0) return 0;
        p += digits;
        p += strspn(p, " \t");
    }
    return *p == '\r' || *p == '\n' || *p == '#' || *p == '\0';
}

static int read_count(fl_bytes *b, const char *what, int32_t *n, fl_err *err)
{
    const char *word = "";
    const int more = fl_bytes_word(b, &word, err);
    if (more < 0) return -1;
    if (more == 0) return fl_bytes_fail(b, err, "the file ends where the number of %s is expected", what);
    if (fl_number_i32(word, 0, INT32_MAX, n))
        return fl_bytes_fail(b, err, "the number of %s is \"%.40s\", a whole number >= 0 is expected", what,
                             word);
    return 0;
}

/* Read the next word of vertex or face number k of n, which may stand on several lines. */
static int read_item(fl_bytes *b, const char *what, int32_t k, int32_t n, const char **word, fl_err *err)
{
    const int more = fl_bytes_word(b, word, err);
    if (more == 0) fl_bytes_fail(b, err, "the file ends after %d of %d %s", k, n, what);
    return more > 0 ? 0 : -1;
}

static int read_vertex(fl_bytes *b, fl_part *p, int32_t v, int32_t n, int homogeneous, fl_err *err)
{
    static const char *const name[] = {"x", "y", "z", "w"};
    double x[4] = {0.0, 0.0, 0.0, 1.0};
    const char *word = "";
    for (int k = 0; k < 3 + homogeneous; k++) {
        if (read_item(b, "vertices", v, n, &word, err)) return -1;
        if (fl_number_f64(word, &x[k]))
            return fl_bytes_fail(b, err, "%s is \"%.40s\", a finite number is expected", name[k], word);
    }
    const fl_vec3 at = v3(x[0] / x[3], x[1] / x[3], x[2] / x[3]);
    if (!isfinite(at.x) || !isfinite(at.y) || !isfinite(at.z))
        return fl_bytes_fail(b, err, "the vertex lies at infinity (w is %g)", x[3]);
    return fl_surface_vertex(p, at, err);
}

static int read_face(fl_bytes *b, fl_part *p, int32_t f, int32_t faces, int32_t **loop, int32_t *cap,
                     fl_err *err)
{
    const char *word = "";
    int32_t n = 0;
    if (read_item(b, "faces", f, faces, &word, err)) return -1;
    if (fl_number_i32(word, 0, INT32_MAX, &n))
        return fl_bytes_fail(b, err, "the number of corners is \"%.40s\", a whole number >= 0 is expected",
                             word);
    if (n > FL_FACET_CORNERS)
        return fl_bytes_fail(b, err, "a face of %d corners, at most %d are expected", n, FL_FACET_CORNERS);
    if (n < 3) return 0; /* a point or an edge */
    if (fl_grow(loop, cap, n, sizeof **loop, err)) return -1;
    for (int32_t k = 0; k < n; k++) {
        if (read_item(b, "faces", f, faces, &word, err)) return -1;
        if (fl_number_i32(word, 0, p->nv - 1, &(*loop)[k]))
            return fl_bytes_fail(b, err, "vertex index \"%.40s\" was found, 0 to %d is expected", word,
                                 p->nv - 1);
    }
    return fl_facet_polygon(p, n, *loop, err);
}

/* Read the header word and the counts. */
static int read_head(fl_bytes *b, int *homogeneous, int32_t n[2], fl_err *err)
{
    const char *word = "";
    if (fl_bytes_word(b, &word, err) < 0) return -1;
    if (header_word(word)) {
        const char *after = b->next < b->words ? b->field[b->next] : "";
        *homogeneous = strchr(word, '4') != NULL;
        if (strchr(word, 'n'))
            return fl_bytes_fail(b, err, "%s has any number of dimensions: three are expected", word);
        if (strcmp(after, "BINARY") == 0)
            return fl_bytes_fail(b, err, "a binary OFF file, an ASCII one is expected");
    } else {
        b->next = 0; /* no header word: the row starts with the counts */
    }
    /* the number of edges is not needed; it is sometimes absent and often wrong */
    return read_count(b, "vertices", &n[0], err) || read_count(b, "faces", &n[1], err) ? -1 : 0;
}

/* Ignore the rest of the row: colours and normals. */
static void skip_rest(fl_bytes *b) { b->next = b->words; }

int fl_off_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    int32_t n[2] = {0}, *loop = NULL, cap = 0, i;
    int homogeneous = 0, rc = -1;
    (void)opt; /* fl_mesh_read() selects parts */
    b->comment = '#';
    if (read_head(b, &homogeneous, n, err)) return -1;
    i = fl_surface_add(s, name, strlen(name), err);
    if (i < 0) return -1;
    skip_rest(b); /* the number of edges */
    for (int32_t v = 0; v < n[0]; v++, skip_rest(b))
        if (read_vertex(b, &s->part[i], v, n[0], homogeneous, err)) goto done;
    for (int32_t f = 0; f < n[1]; f++, skip_rest(b))
        if (read_face(b, &s->part[i], f, n[1], &loop, &cap, err)) goto done;
    rc = fl_bytes_row(b, err); /* rows left over by a wrong count must not be lost silently */
    if (rc > 0) rc = fl_bytes_fail(b, err, "a row follows the last of %d faces", n[1]);
done:
    free(loop);
    return rc;
}
