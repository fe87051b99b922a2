/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include <string.h>
#include "base/decimal.h"
#include "out/frame_text.h"

enum { FACE_MAX = 4096, WORD_MAX = 16 };
/* |q|^2 may differ from 1 by this: seven digits of a number are enough. */
#define UNIT_TOLERANCE 1e-5

/* --- fields ------------------------------------------------------------------------------------ */

/* A line under reading; its end is a newline, so no number runs beyond it. */
struct cursor {
    const char *at, *end, *name;
    int64_t line;
    fl_err *err;
};

static void skip_blanks(struct cursor *c)
{
    while (c->at < c->end && (*c->at == ' ' || *c->at == '\t' || *c->at == '\r')) c->at++;
}

static int fail_at(const struct cursor *c, const char *what)
{
    return fl_fail(c->err, FL_INPUT, "%s:%" PRId64 ": %s", c->name, c->line, what);
}

static int read_real(struct cursor *c, const char *what, double most, double *x)
{
    skip_blanks(c);
    const char *next = c->at < c->end ? fl_decimal_read(c->at, x) : NULL;
    if (!next || next > c->end || (next < c->end && *next != ' ' && *next != '\t' && *next != '\r') ||
        !(fabs(*x) <= most))
        return fl_fail(c->err, FL_INPUT, "%s:%" PRId64 ": %s is missing, no number, or beyond %g", c->name,
                       c->line, what, most);
    c->at = next;
    return 0;
}

static int read_whole(struct cursor *c, const char *what, int32_t lo, int32_t hi, int32_t *n)
{
    int64_t k = 0;
    skip_blanks(c);
    const char *p = c->at;
    while (p < c->end && *p >= '0' && *p <= '9' && k <= hi) k = 10 * k + (*p++ - '0');
    if (p == c->at || k < lo || k > hi || (p < c->end && *p != ' ' && *p != '\t' && *p != '\r'))
        return fl_fail(c->err, FL_INPUT, "%s:%" PRId64 ": %s is missing, or no whole number from %d to %d",
                       c->name, c->line, what, lo, hi);
    c->at = p;
    *n = (int32_t)k;
    return 0;
}

static int read_point(struct cursor *c, const char *what, fl_vec3 *x)
{
    return read_real(c, what, FL_FRAME_MAX_COORD, &x->x) || read_real(c, what, FL_FRAME_MAX_COORD, &x->y) ||
           read_real(c, what, FL_FRAME_MAX_COORD, &x->z);
}

static int read_turn(struct cursor *c, fl_quat *q)
{
    return read_real(c, "the rotation", 2.0, &q->w) || read_real(c, "the rotation", 2.0, &q->x) ||
           read_real(c, "the rotation", 2.0, &q->y) || read_real(c, "the rotation", 2.0, &q->z);
}

static int read_end(struct cursor *c)
{
    skip_blanks(c);
    return c->at < c->end && *c->at != '#' ? fail_at(c, "more fields than the record has") : 0;
}

/* --- the first pass ---------------------------------------------------------------------------- */

static fl_part *last_part(fl_frame_text *s) { return &s->d->structure.part[s->d->structure.n - 1]; }

static int same_shape(const fl_frame_data *d, const fl_frame_shape *a, const fl_frame_shape *b)
{
    if (a->radius != b->radius || a->nv != b->nv || a->nf != b->nf ||
        memcmp(d->vertex + a->v, d->vertex + b->v, (size_t)a->nv * sizeof *d->vertex) != 0)
        return 0;
    for (int32_t f = 0; f <= a->nf && a->nf; f++)
        if (d->face[a->f + f] - d->face[a->f] != d->face[b->f + f] - d->face[b->f]) return 0;
    return !a->nf || memcmp(d->loop + d->face[a->f], d->loop + d->face[b->f],
                            (size_t)(d->face[a->f + a->nf] - d->face[a->f]) * sizeof *d->loop) == 0;
}

/* Drops the last shape where it repeats what its number has already, as in the next file of a split run. */
static void drop_repeated(fl_frame_data *d)
{
    const fl_frame_shape *s = &d->shape[d->shapes - 1];
    const int32_t row = fl_frame_data_row(d, s->id);
    int32_t before = d->row_shape[row];
    if (before == d->shapes - 1) return;
    while (d->shape[before].next != d->shapes - 1) before = d->shape[before].next;
    if (!same_shape(d, s, &d->shape[before])) return;
    d->vertices = s->v;
    d->faces = s->f;
    d->loops = d->face[s->f];
    d->shape[before].next = -1;
    d->shapes--;
}

/* Before a record that cannot belong to the shape under way. */
static int end_shape(fl_frame_text *s, struct cursor *c)
{
    if (!s->in_shape) return 0;
    const fl_frame_shape *const shape = &s->d->shape[s->d->shapes - 1];
    if (s->vertices_due || s->faces_due)
        return fl_fail(c->err, FL_INPUT,
                       "%s:%d: shape %d lacks %d vertices and %d faces of those it announces", s->name,
                       shape->line, shape->id, s->vertices_due, s->faces_due);
    s->in_shape = 0;
    drop_repeated(s->d);
    return 0;
}

static void end_frame(fl_frame_text *s, int64_t offset)
{
    if (s->in_frame) {
        fl_frame_entry *e = &s->d->frame[s->d->frames - 1];
        e->size = offset - e->at;
    }
    s->in_frame = 0;
}

static int on_shape(fl_frame_text *s, struct cursor *c)
{
    int32_t id, nv, nf;
    double radius;
    if (read_whole(c, "the number of the shape", 0, INT32_MAX, &id) ||
        read_real(c, "the radius", FL_FRAME_MAX_COORD, &radius) ||
        read_whole(c, "the number of vertices", 1, INT32_MAX, &nv) ||
        read_whole(c, "the number of faces", 0, INT32_MAX, &nf) || read_end(c))
        return -1;
    if (radius < 0.0) return fail_at(c, "the radius is below 0");
    if (nv > 2 && nf == 0) return fail_at(c, "a shape of more than two vertices needs faces");
    s->in_part = 0;
    s->in_shape = 1;
    s->vertices_due = nv;
    s->faces_due = nf;
    return fl_frame_data_add_shape(s->d, id, radius, s->line < INT32_MAX ? (int32_t)s->line : 0, c->err);
}

static int on_vertex(fl_frame_text *s, struct cursor *c)
{
    fl_vec3 x;
    if (read_point(c, "a coordinate", &x) || read_end(c)) return -1;
    if (s->in_part) return s->known_part ? 0 : fl_surface_vertex(last_part(s), x, c->err);
    if (!s->in_shape || !s->vertices_due) return fail_at(c, "a vertex that no shape announces");
    s->vertices_due--;
    return fl_frame_data_add_vertex(s->d, x, c->err);
}

static int on_face(fl_frame_text *s, struct cursor *c)
{
    int32_t v[FACE_MAX], n;
    if (!s->in_shape || !s->faces_due || s->vertices_due) return fail_at(c, "a face that no shape announces");
    if (read_whole(c, "the number of corners", 3, FACE_MAX, &n)) return -1;
    for (int32_t k = 0; k < n; k++)
        if (read_whole(c, "a corner", 0, s->d->shape[s->d->shapes - 1].nv - 1, &v[k])) return -1;
    if (read_end(c)) return -1;
    s->faces_due--;
    return fl_frame_data_add_face(s->d, v, n, c->err);
}

static int on_part(fl_frame_text *s, struct cursor *c)
{
    int32_t id;
    if (read_whole(c, "the number of the part", 0, INT32_MAX, &id)) return -1;
    skip_blanks(c);
    const char *word = c->at;
    while (c->at < c->end && *c->at != ' ' && *c->at != '\t' && *c->at != '\r') c->at++;
    if (c->at == word) return fail_at(c, "the name of the part is missing");
    s->in_part = 1;
    s->known_part = 0;
    for (int32_t p = 0; p < s->d->structure.n; p++)
        if (s->d->structure.part[p].id == id) s->known_part = 1;
    if (s->known_part) return 0;
    const int32_t p = fl_surface_add(&s->d->structure, word, (size_t)(c->at - word), c->err);
    if (p < 0) return -1;
    s->d->structure.part[p].id = id;
    return 0;
}

static int on_triangle(fl_frame_text *s, struct cursor *c)
{
    int32_t v[3];
    if (!s->in_part) return fail_at(c, "a triangle outside a part");
    const int32_t most = s->known_part ? INT32_MAX : last_part(s)->nv - 1;
    if (most < 0) return fail_at(c, "a triangle before the vertices of its part");
    for (int k = 0; k < 3; k++)
        if (read_whole(c, "a corner", 0, most, &v[k])) return -1;
    if (read_end(c)) return -1;
    return s->known_part ? 0 : fl_surface_triangle(last_part(s), v[0], v[1], v[2], c->err);
}

static int on_cone(fl_frame_text *s, struct cursor *c)
{
    fl_cone k;
    if (!s->in_part) return fail_at(c, "a cone outside a part");
    if (read_point(c, "a coordinate", &k.p0) || read_real(c, "a radius", FL_FRAME_MAX_COORD, &k.r0) ||
        read_point(c, "a coordinate", &k.p1) || read_real(c, "a radius", FL_FRAME_MAX_COORD, &k.r1) ||
        read_end(c))
        return -1;
    if (k.r0 < 0.0 || k.r1 < 0.0 || v3_norm2(v3_sub(k.p1, k.p0)) == 0.0)
        return fail_at(c, "a cone that has no extent");
    return s->known_part ? 0 : fl_surface_cone(last_part(s), k, c->err);
}

static int on_frame(fl_frame_text *s, struct cursor *c, int64_t offset)
{
    fl_frame_data *const d = s->d;
    fl_frame_entry e = {.at = offset, .line = s->line, .bodies = -1, .piece = s->piece};
    if (read_real(c, "the time", 1e15, &e.t) || read_end(c)) return -1;
    if (d->frames && e.t <= d->frame[d->frames - 1].t)
        return fl_fail(c->err, FL_INPUT, "%s:%" PRId64 ": time %g s does not follow %g s", s->name, s->line,
                       e.t, d->frame[d->frames - 1].t);
    s->in_part = 0;
    s->in_frame = 1;
    return fl_frame_data_add_frame(d, e, c->err);
}

static int on_packed(fl_frame_text *s, struct cursor *c)
{
    if (s->d->frames && s->d->frame[s->d->frames - 1].piece == s->piece)
        return fail_at(c, "the line \"packed\" stands after frames");
    if (read_real(c, "the bound of places", 1e6, &s->bound_x) ||
        read_real(c, "the bound of rotations", 0.1, &s->bound_q) ||
        read_whole(c, "the number of frames between keys", 1, 1 << 20, &s->key_every) || read_end(c))
        return -1;
    if (!(s->bound_x > 1e-12) || !(s->bound_q > 1e-8))
        return fail_at(c, "a bound of packed poses is too small");
    s->packed = 1;
    return 0;
}

/* One row for each record; longer words first. */
static int is_word(const char *at, const char *end, const char *word)
{
    const size_t n = strlen(word);
    return (size_t)(end - at) > n && memcmp(at, word, n) == 0 && (at[n] == ' ' || at[n] == '\t');
}

static int on_body(fl_frame_text *s, struct cursor *c)
{
    if (!s->in_frame) return fail_at(c, "a pose before the first frame");
    fl_frame_entry *e = &s->d->frame[s->d->frames - 1];
    if (e->bodies < 0) {
        e->bodies = 0;
        e->ice = s->d->frames - 1;
    }
    e->bodies++;
    return 0;
}

int fl_frame_text_line(fl_frame_text *s, const char *at, const char *end, int64_t offset, fl_err *err)
{
    struct cursor c = {at, end, s->name, ++s->line, err};
    if (at < end && at[0] == 'b' && is_word(at, end, "body")) return on_body(s, &c);
    skip_blanks(&c);
    if (c.at == c.end || *c.at == '#') return 0;
    const char *word = c.at;
    while (c.at < c.end && *c.at != ' ' && *c.at != '\t' && *c.at != '\r') c.at++;
    const size_t n = (size_t)(c.at - word);
    if (n == 1 && *word == 'v') return on_vertex(s, &c);
    if (n == 1 && *word == 'f') return on_face(s, &c);
    if (n == 1 && *word == 't') return on_triangle(s, &c);
    if (n == 4 && memcmp(word, "cone", 4) == 0) return on_cone(s, &c);
    if (n == 4 && memcmp(word, "body", 4) == 0) return on_body(s, &c);
    if ((n == 5 && memcmp(word, "moved", 5) == 0) || (n == 9 && memcmp(word, "structure", 9) == 0))
        return s->in_frame ? 0 : fail_at(&c, "a pose before the first frame");
    if (end_shape(s, &c)) return -1;
    if (n == 5 && memcmp(word, "shape", 5) == 0) {
        end_frame(s, offset);
        return on_shape(s, &c);
    }
    if (n == 4 && memcmp(word, "part", 4) == 0) {
        end_frame(s, offset);
        return on_part(s, &c);
    }
    if (n == 5 && memcmp(word, "frame", 5) == 0) {
        end_frame(s, offset);
        return on_frame(s, &c, offset);
    }
    if (n == 6 && memcmp(word, "packed", 6) == 0) return on_packed(s, &c);
    return fl_fail(err, FL_INPUT, "%s:%" PRId64 ": \"%.*s\" is no record of an animation", s->name, s->line,
                   n < WORD_MAX ? (int)n : WORD_MAX, word);
}

int fl_frame_text_end(fl_frame_text *s, int64_t offset, fl_err *err)
{
    struct cursor c = {NULL, NULL, s->name, s->line, err};
    if (end_shape(s, &c)) return -1;
    end_frame(s, offset);
    s->in_part = 0;
    return 0;
}

/* --- the poses of a frame ---------------------------------------------------------------------- */

static int fail_pose(const char *name, int64_t line, double t, const char *thing, int32_t id,
                     const char *what, fl_err *err)
{
    if (line) return fl_fail(err, FL_INPUT, "%s:%" PRId64 ": %s %d %s", name, line, thing, id, what);
    return fl_fail(err, FL_INPUT, "%s: frame of %g s: %s %d %s", name, t, thing, id, what);
}

static int check_pose(fl_vec3 x, fl_quat *q)
{
    const double n2 = q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z;
    if (!v3_finite(x) || !(fabs(n2 - 1.0) <= UNIT_TOLERANCE)) return -1;
    *q = q_unit(*q);
    return 0;
}

int fl_frame_set_pose(const fl_frame_data *d, const char *name, int64_t line, int32_t row, fl_vec3 x,
                      fl_quat q, fl_frame *out, fl_err *err)
{
    const int32_t id = d->shape[d->row_shape[row]].id;
    if (out->there[row]) return fail_pose(name, line, out->t, "body", id, "stands twice in the frame", err);
    if (check_pose(x, &q))
        return fail_pose(name, line, out->t, "body", id, "has no rotation of length 1", err);
    out->there[row] = 1;
    out->x[row] = x;
    out->q[row] = q;
    return 0;
}

int fl_frame_set_part(const fl_frame_data *d, const char *name, int64_t line, int32_t id, fl_vec3 x,
                      fl_quat q, fl_frame *out, fl_err *err)
{
    int found = id < 0;
    if (check_pose(x, &q))
        return fail_pose(name, line, out->t, "part", id, "has no rotation of length 1", err);
    for (int32_t p = 0; p < out->parts; p++) {
        if (id >= 0 && d->structure.part[p].id != id) continue;
        out->part_x[p] = x;
        out->part_q[p] = q;
        found = 1;
    }
    return found ? 0 : fail_pose(name, line, out->t, "part", id, "is not in the file", err);
}

static int read_body(const fl_frame_data *d, struct cursor *c, int32_t *guess, fl_frame *out)
{
    int32_t id;
    fl_vec3 x;
    fl_quat q;
    if (read_whole(c, "the number of the body", 0, INT32_MAX, &id) || read_point(c, "a coordinate", &x) ||
        read_turn(c, &q) || read_end(c))
        return -1;
    int32_t row =
        *guess < d->rows && d->shape[d->row_shape[*guess]].id == id ? *guess : fl_frame_data_row(d, id);
    if (row < 0 || d->shape[d->row_shape[row]].from > out->k)
        return fail_pose(c->name, c->line, out->t, "body", id, "has no shape before this frame", c->err);
    *guess = row + 1;
    return fl_frame_set_pose(d, c->name, c->line, row, x, q, out, c->err);
}

static int read_part(const fl_frame_data *d, struct cursor *c, int moved, fl_frame *out)
{
    int32_t id = -1;
    fl_vec3 x;
    fl_quat q = q_one();
    if ((moved && read_whole(c, "the number of the part", 0, INT32_MAX, &id)) ||
        read_point(c, "a coordinate", &x) || (moved && read_turn(c, &q)) || read_end(c))
        return -1;
    return fl_frame_set_part(d, c->name, c->line, id, x, q, out, c->err);
}

int fl_frame_text_read(const fl_frame_data *d, const fl_frame_entry *e, const char *name, const char *bytes,
                       int bodies, int parts, fl_frame *out, fl_err *err)
{
    const char *at = bytes, *const end = bytes + e->size;
    int64_t line = e->line;
    int32_t guess = 0;
    for (; at < end; line++) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        if (!stop) break;
        struct cursor c = {at, stop, name, line, err};
        skip_blanks(&c);
        const char *word = c.at;
        while (c.at < c.end && *c.at != ' ' && *c.at != '\t') c.at++;
        const size_t n = (size_t)(c.at - word);
        if (n == 4 && memcmp(word, "body", 4) == 0) {
            if (bodies && read_body(d, &c, &guess, out)) return -1;
        } else if (parts && ((n == 5 && memcmp(word, "moved", 5) == 0) ||
                             (n == 9 && memcmp(word, "structure", 9) == 0))) {
            if (read_part(d, &c, n == 5, out)) return -1;
        }
        at = stop + 1;
    }
    return 0;
}
