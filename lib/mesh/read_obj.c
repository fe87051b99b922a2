/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/string_table.h"
#include "base/number_text.h"
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
    if (!fl_bytes_is_text(b)) return 0;
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

/* Words that may open a part.  Which of them do is known at the end of the file: until then each change of
 * one of them begins a run of triangles. */
enum { OBJECT, GROUP, MATERIAL, WORDS };
static const char *const opening[WORDS] = {"o", "g", "usemtl"};

typedef struct {
    int32_t t;    /* triangles of the pool before it */
    int32_t name; /* of names; -1 for that of the file */
    int8_t word;  /* that changed */
} run;

typedef struct {
    fl_part pool;            /* all vertices and triangles of the file */
    int32_t *owner;          /* [pool.nv] part that saw the vertex last, plus one; 0 for none */
    int32_t *local;          /* [pool.nv] its index there */
    int32_t *loop, loop_cap; /* corners of the current face */
    fl_string_table names;
    run *runs; /* [n] */
    int32_t n, run_cap;
    int32_t seen[WORDS];
    int32_t skipped;
} state;

static void state_free(state *o)
{
    fl_part_free(&o->pool);
    fl_string_table_free(&o->names);
    free(o->owner);
    free(o->local);
    free(o->loop);
    free(o->runs);
}

static int read_vertex(state *o, const fl_bytes *b, fl_err *err)
{
    fl_vec3 x = {0};
    if (fl_bytes_f64_at(b, 1, "x", &x.x, err) || fl_bytes_f64_at(b, 2, "y", &x.y, err) ||
        fl_bytes_f64_at(b, 3, "z", &x.z, err))
        return -1;
    return fl_surface_vertex(&o->pool, x, err);
}

/* "7", "7/2", "7//3", "-1/...": the vertex, counted from 0. */
static int corner(const state *o, const fl_bytes *b, char *word, int32_t *v, fl_err *err)
{
    int32_t i = 0;
    char *slash = strchr(word, '/');
    if (slash) *slash = '\0';
    if (fl_number_i32(word, -INT32_MAX, INT32_MAX, &i) || i == 0)
        return fl_bytes_fail(
            b, err, "vertex index \"%.40s\" was found, a whole number other than 0 is expected", word);
    *v = i > 0 ? i - 1 : o->pool.nv + i;
    if (*v < 0 || *v >= o->pool.nv)
        return fl_bytes_fail(b, err, "the face wants vertex %d, but there are %d so far", i, o->pool.nv);
    return 0;
}

/* A face is cut up under the numbers of the file, which decide on ties, and not under those of a part. */
static int read_face(state *o, fl_bytes *b, fl_err *err)
{
    const int32_t n = b->words - 1;
    if (n < 3) return fl_bytes_fail(b, err, "a face of %d corners, at least 3 are expected", n);
    if (n > FL_FACET_CORNERS)
        return fl_bytes_fail(b, err, "a face of %d corners, at most %d are expected", n, FL_FACET_CORNERS);
    if (fl_grow(&o->loop, &o->loop_cap, n, sizeof *o->loop, err)) return -1;
    for (int32_t k = 0; k < n; k++)
        if (corner(o, b, b->field[k + 1], &o->loop[k], err)) return -1;
    return fl_facet_polygon(&o->pool, n, o->loop, err);
}

static int open_run(state *o, fl_bytes *b, int word, fl_err *err)
{
    run r = {o->pool.nt, -1, (int8_t)word};
    if (fl_grow(&o->runs, &o->run_cap, (int64_t)o->n + 1, sizeof *o->runs, err)) return -1;
    if (b->words > 1) { /* words lie one behind the other */
        char *name = b->field[1], *end = b->field[b->words - 1];
        end += strlen(end);
        for (char *c = name; c < end; c++)
            if (*c == '\0') *c = '_';
        r.name = fl_string_table_add(&o->names, name, err);
        if (r.name < 0) return -1;
    }
    o->runs[o->n++] = r;
    o->seen[word]++;
    return 0;
}

static int read_row(state *o, fl_bytes *b, fl_err *err)
{
    const char *word = b->field[0];
    if (strcmp(word, "v") == 0) return read_vertex(o, b, err);
    if (strcmp(word, "f") == 0) return read_face(o, b, err);
    for (int k = 0; k < WORDS; k++)
        if (strcmp(word, opening[k]) == 0) return open_run(o, b, k, err);
    for (int k = 0; k < KNOWN; k++)
        if (strcmp(word, known[k]) == 0) return 0;
    o->skipped++;
    return 0;
}

/* --- parts ---------------------------------------------------------------------------------------------- */

/* The part called so, which is added when new. */
static int32_t part_called(fl_surface *s, const char *name, fl_err *err)
{
    const int32_t i = fl_surface_find(s, name, strlen(name));
    return i >= 0 ? i : fl_surface_add(s, name, strlen(name), err);
}

/* Give triangles from .. to of the pool to a part.  One that comes back gets its vertices twice: welding
 * mends that. */
static int bring(state *o, fl_surface *s, int32_t part, int32_t from, int32_t to, fl_err *err)
{
    fl_part *p = &s->part[part];
    for (int32_t t = from; t < to; t++) {
        int32_t w[3];
        for (int k = 0; k < 3; k++) {
            const int32_t v = o->pool.t[t].v[k];
            if (o->owner[v] != part + 1) {
                o->owner[v] = part + 1;
                o->local[v] = p->nv;
                if (fl_surface_vertex(p, o->pool.v[v], err)) return -1;
            }
            w[k] = o->local[v];
        }
        if (fl_surface_triangle(p, w[0], w[1], w[2], err)) return -1;
    }
    return 0;
}

/* Deal the triangles out to the parts.  A file of one part is that part. */
static int deal(state *o, fl_surface *s, const char *name, fl_err *err)
{
    const int word = o->seen[OBJECT] >= 2 ? OBJECT
                     : o->seen[GROUP]     ? GROUP
                     : o->seen[OBJECT]    ? OBJECT
                                          : MATERIAL;
    int32_t part = -1, from = 0;
    o->owner = fl_alloc(o->pool.nv, sizeof *o->owner, err);
    o->local = o->owner ? fl_alloc(o->pool.nv, sizeof *o->local, err) : NULL;
    if (!o->local) return -1;
    for (int32_t k = 0; k <= o->n; k++) {
        const run *r = &o->runs[k];
        const int32_t to = k < o->n ? r->t : o->pool.nt;
        if (k < o->n && r->word != word) continue;
        if (to > from) {
            if (part < 0 && (part = part_called(s, name, err)) < 0) return -1;
            if (bring(o, s, part, from, to, err)) return -1;
        }
        from = to;
        if (k == o->n) break;
        part = part_called(s, r->name < 0 ? name : o->names.name[r->name], err);
        if (part < 0) return -1;
    }
    return 0;
}

int fl_obj_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    state o = {0};
    int more;
    (void)opt; /* fl_mesh_read() selects parts */
    b->comment = '#';
    while ((more = fl_bytes_row(b, err)) > 0)
        if (read_row(&o, b, err)) {
            more = -1;
            break;
        }
    if (more == 0 && o.skipped) fl_bytes_note(b, "%d rows of unknown words were passed over", o.skipped);
    if (more == 0) more = deal(&o, s, name, err);
    state_free(&o);
    return more;
}
