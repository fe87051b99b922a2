/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "geom/facet.h"
#include "mesh/read_stl.h"

enum { HEADER_BYTES = 84, RECORD_BYTES = 50 };

/* --- binary --------------------------------------------------------------------------------------------- */

static uint32_t u32_at(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static double f32_at(const unsigned char *p)
{
    const uint32_t bits = u32_at(p);
    float x;
    memcpy(&x, &bits, sizeof x);
    return (double)x;
}

/* Number of triangles in the header, -1 if there is no header. */
static int64_t header_count(const fl_bytes *b)
{
    return b->n < HEADER_BYTES ? -1 : (int64_t)u32_at((const unsigned char *)b->data + 80);
}

static int is_binary(const fl_bytes *b)
{
    const int64_t n = header_count(b);
    if (n < 0) return 0;
    if (!b->ended)
        return memchr(b->data, '\0', (size_t)b->n) && (n == 0 || HEADER_BYTES + RECORD_BYTES * n > b->n);
    return b->n == HEADER_BYTES + RECORD_BYTES * n ||
           (n == 0 && b->n > HEADER_BYTES && (b->n - HEADER_BYTES) % RECORD_BYTES == 0);
}

static int read_record(fl_bytes *b, const unsigned char *at, int32_t t, fl_part *p, fl_err *err)
{
    at += 12; /* behind the normal */
    for (int k = 0; k < 3; k++, at += 12) {
        const fl_vec3 x = v3(f32_at(at), f32_at(at + 4), f32_at(at + 8));
        if (!isfinite(x.x) || !isfinite(x.y) || !isfinite(x.z))
            return fl_bytes_fail(b, err, "triangle %d has the corner %g %g %g, finite numbers are expected",
                                 t, x.x, x.y, x.z);
        if (fl_surface_vertex(p, x, err)) return -1;
    }
    return fl_surface_triangle(p, 3 * t, 3 * t + 1, 3 * t + 2, err);
}

static int read_binary(fl_surface *s, fl_bytes *b, const char *name, fl_err *err)
{
    const int64_t want = header_count(b);
    const int32_t i = fl_surface_add(s, name, strlen(name), err);
    const unsigned char *at;
    int32_t n = 0;
    int more;
    if (i < 0) return -1;
    b->pos = HEADER_BYTES;
    while ((more = fl_bytes_read(b, RECORD_BYTES, &at, err)) > 0) {
        if (n == INT32_MAX / 3) return fl_bytes_fail(b, err, "more than %d triangles", n);
        if (read_record(b, at, n, &s->part[i], err)) return -1;
        n++;
    }
    if (more < 0) return -1;
    if (b->pos < b->n || (want > 0 && n != want))
        return fl_bytes_fail(
            b, err,
            "a binary STL of %lld triangles is expected, of 84 + 50 n bytes: %d and %d bytes were "
            "found",
            (long long)want, n, b->n - b->pos);
    if (n > 0 && want == 0)
        fl_bytes_note(b, "the header says 0 triangles, the size of the file %d: these were read", n);
    return 0;
}

/* --- ASCII ---------------------------------------------------------------------------------------------- */

/* Read the next word, which must be `want`. */
static int read_expected(fl_bytes *b, const char *want, fl_err *err)
{
    const char *word = "";
    const int more = fl_bytes_word(b, &word, err);
    if (more < 0) return -1;
    if (more == 0) return fl_bytes_fail(b, err, "the file ends where \"%s\" is expected", want);
    if (strcasecmp(word, want) != 0)
        return fl_bytes_fail(b, err, "\"%.40s\" was found, \"%s\" is expected", word, want);
    return 0;
}

/* Read one facet, behind its first word. */
static int read_facet(fl_bytes *b, fl_part *p, int32_t **loop, int32_t *cap, fl_err *err)
{
    const char *word = "";
    int32_t n = 0;
    int more = 1;
    if (read_expected(b, "normal", err)) return -1;
    for (int k = 0; k < 3 && more > 0; k++)
        more = fl_bytes_word(b, &word, err); /* ignored: it may be nan or wrong */
    if (more < 0 || read_expected(b, "outer", err) || read_expected(b, "loop", err)) return -1;
    for (;;) {
        fl_vec3 x = {0};
        more = fl_bytes_word(b, &word, err);
        if (more < 0) return -1;
        if (more == 0 || strcasecmp(word, "vertex") != 0) break;
        if (n == FL_FACET_CORNERS)
            return fl_bytes_fail(b, err, "a loop of more than %d corners", FL_FACET_CORNERS);
        if (fl_bytes_f64(b, "x", &x.x, err) || fl_bytes_f64(b, "y", &x.y, err) ||
            fl_bytes_f64(b, "z", &x.z, err) || fl_surface_vertex(p, x, err) ||
            fl_grow(loop, cap, (int64_t)n + 1, sizeof **loop, err))
            return -1;
        (*loop)[n++] = p->nv - 1;
    }
    if (more == 0) return fl_bytes_fail(b, err, "the file ends inside a loop");
    if (strcasecmp(word, "endloop") != 0)
        return fl_bytes_fail(b, err, "\"%.40s\" was found, \"vertex\" or \"endloop\" is expected", word);
    if (n < 3) return fl_bytes_fail(b, err, "a loop of %d corners, at least 3 are expected", n);
    if (read_expected(b, "endfacet", err)) return -1;
    return fl_facet_polygon(p, n, *loop, err);
}

/* Add the part of a solid, whose name is the rest of the row.  Its words are adjacent in memory;
 * fl_surface_add() replaces what separates them. */
static int32_t open_solid(fl_surface *s, fl_bytes *b, const char *name, fl_err *err)
{
    const char *last = b->next < b->words ? b->field[b->words - 1] : NULL;
    const char *first = last ? b->field[b->next] : NULL;
    b->next = b->words;
    if (!last) return fl_surface_add(s, name, strlen(name), err);
    return fl_surface_add(s, first, (size_t)(last - first) + strlen(last), err);
}

static int read_ascii(fl_surface *s, fl_bytes *b, const char *name, fl_err *err)
{
    const char *word = "";
    int32_t *loop = NULL, cap = 0, i = -1; /* i: part of the open solid */
    int rc = -1, more;
    while ((more = fl_bytes_word(b, &word, err)) > 0) {
        if (i < 0 && strcasecmp(word, "solid") == 0) {
            i = open_solid(s, b, name, err);
            if (i < 0) goto done;
        } else if (i >= 0 && strcasecmp(word, "facet") == 0) {
            if (read_facet(b, &s->part[i], &loop, &cap, err)) goto done;
        } else if (i >= 0 && strcasecmp(word, "endsolid") == 0) {
            b->next = b->words; /* its name, repeated */
            i = -1;
        } else {
            fl_bytes_fail(b, err, "\"%.40s\" was found, %s is expected", word,
                          i < 0 ? "\"solid\"" : "\"facet\" or \"endsolid\"");
            goto done;
        }
    }
    if (more < 0) goto done;
    if (i >= 0) {
        fl_bytes_fail(b, err, "the file ends inside solid \"%.60s\"", s->part[i].name);
        goto done;
    }
    rc = 0;
done:
    free(loop);
    return rc;
}

/* --- either kind ---------------------------------------------------------------------------------------- */

static int is_ascii(const fl_bytes *b)
{
    const char *p = b->data + strspn(b->data, " \t\r\n");
    return fl_bytes_is_text(b) && strncasecmp(p, "solid", 5) == 0;
}

int fl_stl_is(const fl_bytes *b) { return is_binary(b) || is_ascii(b); }

int fl_stl_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    (void)opt; /* fl_mesh_read() selects parts */
    return is_binary(b) ? read_binary(s, b, name, err) : read_ascii(s, b, name, err);
}
