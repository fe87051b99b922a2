/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/mem.h"
#include "base/num.h"
#include "geom/facet.h"
#include "mesh/read_obj.h"

/* Words that carry no surface: passed over in silence.  "v" and "f" come first: they are looked for alone. */
static const char *const known[] = {
    "v",  "f",  "g",     "o",   "s",        "vt",       "vn",     "usemtl", "mtllib",     "p",        "l",
    "vp", "mg", "bevel", "lod", "c_interp", "d_interp", "maplib", "usemap", "shadow_obj", "trace_obj"};
enum { KNOWN = sizeof known / sizeof known[0] };

/* Does the line at p start with this word? */
static int starts(const char *p, const char *word)
{
    const size_t k = strlen(word);
    return strncmp(p, word, k) == 0 &&
           (p[k] == ' ' || p[k] == '\t' || p[k] == '\r' || p[k] == '\n' || p[k] == '\0');
}

/* Start of the line after p, NULL at the end. */
static const char *next_line(const char *p)
{
    p += strcspn(p, "\r\n");
    return *p ? p + 1 : NULL;
}

static const char *skip_blanks(const char *p) { return p + strspn(p, " \t"); }

int fl_obj_is(const fl_bytes *b)
{
    for (const char *p = b->data; p; p = next_line(p)) {
        int found = 0;
        p = skip_blanks(p);
        if (*p == '\r' || *p == '\n' || *p == '#') continue;
        if (starts(p, "v") || starts(p, "f")) return 1;
        for (int k = 0; k < KNOWN && !found; k++) found = starts(p, known[k]);
        if (!found) return 0;
    }
    return 0;
}

/* The word that opens a part in this file. */
static const char *part_word(const fl_bytes *b)
{
    int objects = 0, groups = 0;
    for (const char *p = b->data; p; p = next_line(p)) {
        p = skip_blanks(p);
        objects += starts(p, "o") && objects < 2;
        groups += starts(p, "g") && groups < 1;
    }
    return objects >= 2 ? "o" : groups ? "g" : objects ? "o" : "usemtl";
}

typedef struct {
    fl_part pool;   /* all vertices of the file */
    int32_t *owner; /* [pool.nv] part that saw the vertex last, plus one; 0 for none */
    int32_t *local; /* [pool.nv] its index there */
    int32_t owner_cap, local_cap;
    int32_t *loop, loop_cap; /* corners of the current face */
    int32_t part;            /* current one, -1 before the first face */
    int32_t skipped;
} state;

static void state_free(state *o)
{
    fl_part_free(&o->pool);
    free(o->owner);
    free(o->local);
    free(o->loop);
}

static int read_vertex(state *o, const fl_bytes *b, fl_err *err)
{
    fl_vec3 x = {0};
    if (fl_bytes_f64_at(b, 1, "x", &x.x, err) || fl_bytes_f64_at(b, 2, "y", &x.y, err) ||
        fl_bytes_f64_at(b, 3, "z", &x.z, err) ||
        fl_grow(&o->owner, &o->owner_cap, (int64_t)o->pool.nv + 1, sizeof *o->owner, err) ||
        fl_grow(&o->local, &o->local_cap, (int64_t)o->pool.nv + 1, sizeof *o->local, err))
        return -1;
    o->owner[o->pool.nv] = 0;
    return fl_surface_vertex(&o->pool, x, err);
}

/* "7", "7/2", "7//3", "-1/...": the vertex, counted from 0. */
static int corner(const state *o, const fl_bytes *b, char *word, int32_t *v, fl_err *err)
{
    int32_t i = 0;
    word[strcspn(word, "/")] = '\0';
    if (fl_num_i32(word, -INT32_MAX, INT32_MAX, &i) || i == 0)
        return fl_bytes_fail(
            b, err, "vertex index \"%.40s\" was found, a whole number other than 0 was wanted", word);
    *v = i > 0 ? i - 1 : o->pool.nv + i;
    if (*v < 0 || *v >= o->pool.nv)
        return fl_bytes_fail(b, err, "the face wants vertex %d, but there are %d so far", i, o->pool.nv);
    return 0;
}

/* See that the part has vertex v.  A part that comes back gets it twice: welding mends that. */
static int bring(state *o, fl_part *p, int32_t v, fl_err *err)
{
    if (o->owner[v] == o->part + 1) return 0;
    o->owner[v] = o->part + 1;
    o->local[v] = p->nv;
    return fl_surface_vertex(p, o->pool.v[v], err);
}

static int read_face(state *o, fl_surface *s, fl_bytes *b, fl_err *err)
{
    const int32_t n = b->words - 1;
    fl_part *p = &s->part[o->part];
    if (n < 3) return fl_bytes_fail(b, err, "a face of %d corners, at least 3 were wanted", n);
    if (n > FL_FACET_CORNERS)
        return fl_bytes_fail(b, err, "a face of %d corners, at most %d were wanted", n, FL_FACET_CORNERS);
    if (fl_grow(&o->loop, &o->loop_cap, n, sizeof *o->loop, err)) return -1;
    for (int32_t k = 0; k < n; k++)
        if (corner(o, b, b->field[k + 1], &o->loop[k], err)) return -1;
    /* Cut up under the numbers of the file, which decide on ties, and not under those of the part. */
    o->pool.nt = 0;
    if (fl_facet_polygon(&o->pool, n, o->loop, err)) return -1;
    for (int32_t t = 0; t < o->pool.nt; t++) {
        const int32_t *v = o->pool.t[t].v;
        for (int k = 0; k < 3; k++)
            if (bring(o, p, v[k], err)) return -1;
        if (fl_surface_triangle(p, o->local[v[0]], o->local[v[1]], o->local[v[2]], err)) return -1;
    }
    return 0;
}

/* Open or reopen the part that the row names. */
static int open_part(state *o, fl_surface *s, const fl_bytes *b, const char *name, fl_err *err)
{
    size_t len = strlen(name);
    if (b && b->words > 1) { /* words lie one behind the other */
        name = b->field[1];
        len = (size_t)(b->field[b->words - 1] - name) + strlen(b->field[b->words - 1]);
    }
    o->part = fl_surface_find(s, name, len);
    if (o->part < 0) o->part = fl_surface_add(s, name, len, err);
    return o->part < 0 ? -1 : 0;
}

static int read_row(state *o, fl_surface *s, fl_bytes *b, const char *opens, const char *name, fl_err *err)
{
    const char *word = b->field[0];
    if (strcmp(word, "v") == 0) return read_vertex(o, b, err);
    if (strcmp(word, "f") == 0) {
        if (o->part < 0 && open_part(o, s, NULL, name, err)) return -1;
        return read_face(o, s, b, err);
    }
    if (strcmp(word, opens) == 0) return open_part(o, s, b, name, err);
    for (int k = 0; k < KNOWN; k++)
        if (strcmp(word, known[k]) == 0) return 0;
    o->skipped++;
    return 0;
}

int fl_obj_read(fl_surface *s, fl_bytes *b, const char *name, fl_err *err)
{
    const char *opens = part_word(b);
    state o = {.part = -1};
    int more;
    b->comment = '#';
    while ((more = fl_bytes_row(b, err)) > 0)
        if (read_row(&o, s, b, opens, name, err)) {
            more = -1;
            break;
        }
    if (more == 0 && o.skipped) fl_bytes_note(b, "%d rows of unknown words were passed over", o.skipped);
    state_free(&o);
    return more;
}
