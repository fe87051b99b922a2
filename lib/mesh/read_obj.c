/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/string_table.h"
#include "base/number_text.h"
#include "geom/facet.h"
#include "mesh/read_obj.h"

/* Words of OBJ; those without a surface are ignored.  "v" and "f" come first: they are checked separately. */
static const char *const KNOWN_WORDS[] = {
    "v",  "f",  "g",     "o",   "s",        "vt",       "vn",     "usemtl", "mtllib",     "p",        "l",
    "vp", "mg", "bevel", "lod", "c_interp", "d_interp", "maplib", "usemap", "shadow_obj", "trace_obj"};
enum { KNOWN = sizeof KNOWN_WORDS / sizeof KNOWN_WORDS[0] };

/* True if the line at p begins with this word. */
static int starts_with(const char *p, const char *word)
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
        if (starts_with(p, "v") || starts_with(p, "f")) return 1;
        for (int k = 0; k < KNOWN && !found; k++) found = starts_with(p, KNOWN_WORDS[k]);
        if (!found) return 0;
    }
    return 0;
}

/* Words that may open a part.  Which of them do is known at the end of the file; until then each of them
 * begins a run of triangles. */
enum { OPENS_OBJECT, OPENS_GROUP, OPENS_MATERIAL, OPENING_WORDS };
static const char *const OPENING[OPENING_WORDS] = {"o", "g", "usemtl"};

typedef struct {
    int32_t t;    /* number of triangles before it */
    int32_t name; /* index in names; -1 for the name of the file */
    int8_t word;  /* that begins the run */
} part_run;

typedef struct {
    fl_part pool;            /* all vertices and triangles of the file */
    int32_t *owner;          /* [pool.nv] last part that used the vertex, plus one; 0 for none */
    int32_t *local;          /* [pool.nv] its index there */
    int32_t *loop, loop_cap; /* corners of the current face */
    fl_string_table names;
    part_run *runs; /* [n] */
    int32_t n, run_cap;
    int32_t seen[OPENING_WORDS];
    int32_t skipped;
} obj_reader;

static void free_reader(obj_reader *o)
{
    fl_part_free(&o->pool);
    fl_string_table_free(&o->names);
    free(o->owner);
    free(o->local);
    free(o->loop);
    free(o->runs);
}

static int read_vertex(obj_reader *o, const fl_bytes *b, fl_err *err)
{
    fl_vec3 x = {0};
    if (fl_bytes_f64_at(b, 1, "x", &x.x, err) || fl_bytes_f64_at(b, 2, "y", &x.y, err) ||
        fl_bytes_f64_at(b, 3, "z", &x.z, err))
        return -1;
    return fl_surface_vertex(&o->pool, x, err);
}

/* Parse "7", "7/2", "7//3", "-1/...": the vertex, counted from 0. */
static int parse_corner(const obj_reader *o, const fl_bytes *b, char *word, int32_t *v, fl_err *err)
{
    int32_t i = 0;
    char *slash = strchr(word, '/');
    if (slash) *slash = '\0';
    if (fl_number_i32(word, -INT32_MAX, INT32_MAX, &i) || i == 0)
        return fl_bytes_fail(
            b, err, "vertex index \"%.40s\" was found, a whole number other than 0 is expected", word);
    *v = i > 0 ? i - 1 : o->pool.nv + i;
    if (*v < 0 || *v >= o->pool.nv)
        return fl_bytes_fail(b, err, "the face refers to vertex %d, but there are %d so far", i, o->pool.nv);
    return 0;
}

/* Add a face.  It is triangulated with the vertex indices of the file, which decide ties, not with those of a
 * part. */
static int read_face(obj_reader *o, fl_bytes *b, fl_err *err)
{
    const int32_t n = b->words - 1;
    if (n < 3) return fl_bytes_fail(b, err, "a face of %d corners, at least 3 are expected", n);
    if (n > FL_FACET_CORNERS)
        return fl_bytes_fail(b, err, "a face of %d corners, at most %d are expected", n, FL_FACET_CORNERS);
    if (fl_grow(&o->loop, &o->loop_cap, n, sizeof *o->loop, err)) return -1;
    for (int32_t k = 0; k < n; k++)
        if (parse_corner(o, b, b->field[k + 1], &o->loop[k], err)) return -1;
    return fl_facet_polygon(&o->pool, n, o->loop, err);
}

static int open_run(obj_reader *o, fl_bytes *b, int word, fl_err *err)
{
    part_run r = {o->pool.nt, -1, (int8_t)word};
    if (fl_grow(&o->runs, &o->run_cap, (int64_t)o->n + 1, sizeof *o->runs, err)) return -1;
    if (b->words > 1) { /* the words are adjacent in memory */
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

static int read_row(obj_reader *o, fl_bytes *b, fl_err *err)
{
    const char *word = b->field[0];
    if (strcmp(word, "v") == 0) return read_vertex(o, b, err);
    if (strcmp(word, "f") == 0) return read_face(o, b, err);
    for (int k = 0; k < OPENING_WORDS; k++)
        if (strcmp(word, OPENING[k]) == 0) return open_run(o, b, k, err);
    for (int k = 0; k < KNOWN; k++)
        if (strcmp(word, KNOWN_WORDS[k]) == 0) return 0;
    o->skipped++;
    return 0;
}

/* --- parts ---------------------------------------------------------------------------------------------- */

/* Index of the part of that name, which is added if new. */
static int32_t get_part(fl_surface *s, const char *name, fl_err *err)
{
    const int32_t i = fl_surface_find(s, name, strlen(name));
    return i >= 0 ? i : fl_surface_add(s, name, strlen(name), err);
}

/* Copy triangles from .. to of the pool to a part.  A part that is opened twice gets its vertices twice;
 * welding joins them. */
static int copy_triangles(obj_reader *o, fl_surface *s, int32_t part, int32_t from, int32_t to, fl_err *err)
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

/* Distribute the triangles to the parts. */
static int assign_parts(obj_reader *o, fl_surface *s, const char *name, fl_err *err)
{
    const int word = o->seen[OPENS_OBJECT] >= 2 ? OPENS_OBJECT
                     : o->seen[OPENS_GROUP]     ? OPENS_GROUP
                     : o->seen[OPENS_OBJECT]    ? OPENS_OBJECT
                                                : OPENS_MATERIAL;
    int32_t part = -1, from = 0;
    o->owner = fl_alloc(o->pool.nv, sizeof *o->owner, err);
    o->local = o->owner ? fl_alloc(o->pool.nv, sizeof *o->local, err) : NULL;
    if (!o->local) return -1;
    for (int32_t k = 0; k <= o->n; k++) {
        const part_run *r = &o->runs[k];
        const int32_t to = k < o->n ? r->t : o->pool.nt;
        if (k < o->n && r->word != word) continue;
        if (to > from) {
            if (part < 0 && (part = get_part(s, name, err)) < 0) return -1;
            if (copy_triangles(o, s, part, from, to, err)) return -1;
        }
        from = to;
        if (k == o->n) break;
        part = get_part(s, r->name < 0 ? name : o->names.name[r->name], err);
        if (part < 0) return -1;
    }
    return 0;
}

int fl_obj_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    obj_reader o = {0};
    int more;
    (void)opt; /* fl_mesh_read() selects parts */
    b->comment = '#';
    while ((more = fl_bytes_row(b, err)) > 0)
        if (read_row(&o, b, err)) {
            more = -1;
            break;
        }
    if (more == 0 && o.skipped) fl_bytes_note(b, "%d rows of unknown words were skipped", o.skipped);
    if (more == 0) more = assign_parts(&o, s, name, err);
    free_reader(&o);
    return more;
}
