/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "base/text.h"
#include "scene/ice_field.h"

/* Make room for one more body in every array; cap changes only if all have it. */
static int grow_arrays(fl_ice_field *a, fl_err *err)
{
    const int64_t want = (int64_t)a->n + 1;
    int32_t cap[8];
    for (int k = 0; k < 8; k++) cap[k] = a->cap;
    if (want <= a->cap) return 0;
    if (fl_grow(&a->id, &cap[0], want, sizeof *a->id, err) ||
        fl_grow(&a->record_line, &cap[1], want, sizeof *a->record_line, err) ||
        fl_grow(&a->material, &cap[2], want, sizeof *a->material, err) ||
        fl_grow(&a->group, &cap[3], want, sizeof *a->group, err) ||
        fl_grow(&a->radius, &cap[4], want, sizeof *a->radius, err) ||
        fl_grow(&a->core, &cap[5], want, sizeof *a->core, err) ||
        fl_grow(&a->velocity, &cap[6], want, sizeof *a->velocity, err) ||
        fl_grow(&a->spin, &cap[7], want, sizeof *a->spin, err))
        return -1;
    a->cap = cap[0];
    return 0;
}

int fl_ice_field_add(fl_ice_field *a, int32_t id, double radius, fl_poly *core, const char *material,
                     const char *group, fl_vec3 vel, fl_vec3 spin, fl_err *err)
{
    const int32_t i = a->n;
    int32_t m = -1, g = -1;
    if (grow_arrays(a, err)) return -1;
    if (material && (m = fl_string_table_add(&a->materials, material, err)) < 0) return -1;
    if (group && (g = fl_string_table_add(&a->groups, group, err)) < 0) return -1;
    a->id[i] = id;
    a->record_line[i] = 0;
    a->material[i] = m;
    a->group[i] = g;
    a->radius[i] = radius;
    a->core[i] = *core;
    a->velocity[i] = vel;
    a->spin[i] = spin;
    *core = (fl_poly){0};
    a->n++;
    return 0;
}

int fl_ice_field_add_bond(fl_ice_field *a, int32_t i, int32_t j, double area, double length, fl_vec3 x,
                          fl_err *err)
{
    if (fl_grow(&a->bond, &a->bond_cap, (int64_t)a->bonds + 1, sizeof *a->bond, err)) return -1;
    a->bond[a->bonds++] = (fl_ice_field_bond){i < j ? i : j, i < j ? j : i, area, length, x};
    return 0;
}

int fl_ice_field_add_joint(fl_ice_field *a, int32_t i, int32_t j, int32_t fi, int32_t fj, const char *name,
                           fl_err *err)
{
    const int32_t k = fl_string_table_add(&a->joint_names, name, err);
    if (k < 0 || fl_grow(&a->joint, &a->joint_cap, (int64_t)a->joints + 1, sizeof *a->joint, err)) return -1;
    a->joint[a->joints++] =
        i < j ? (fl_ice_field_joint){i, j, fi, fj, k} : (fl_ice_field_joint){j, i, fj, fi, k};
    return 0;
}

void fl_ice_field_free(fl_ice_field *a)
{
    for (int32_t i = 0; i < a->n; i++) fl_poly_free(&a->core[i]);
    free(a->id);
    free(a->record_line);
    free(a->material);
    free(a->group);
    free(a->radius);
    free(a->core);
    free(a->velocity);
    free(a->spin);
    free(a->bond);
    free(a->joint);
    free(a->history);
    fl_string_table_free(&a->joint_names);
    fl_string_table_free(&a->materials);
    fl_string_table_free(&a->groups);
    *a = (fl_ice_field){0};
}

/* --- read ----------------------------------------------------------------------------------------------- */

/* The current record. */
struct body {
    int32_t line, id, nv, nf;                  /* as announced by the poly row */
    int32_t has_v, has_f, v_cap, f_cap, l_cap; /* as read so far */
    int open, has_vel, material_given, group_given;
    int32_t material, group;
    double radius;
    fl_vec3 vel, spin;
    fl_vec3 *v;
    int32_t *first, *loop;
    int32_t *bond_line; /* [bonds] */
    int32_t bond_line_cap;
    int32_t *joint_line; /* [joints] */
    int32_t joint_line_cap;
};

static int fail_at(const fl_text *in, int32_t line, fl_err *err, const char *sentence)
{
    fl_text there = *in;
    there.line_number = line;
    return fl_text_fail(&there, err, "%s", sentence);
}

typedef struct {
    fl_vec3 x;
    int32_t k;
} indexed_point;

static int by_position(const void *a, const void *b)
{
    const indexed_point *s = a, *t = b;
    if (s->x.x < t->x.x || s->x.x > t->x.x) return s->x.x < t->x.x ? -1 : 1;
    if (s->x.y < t->x.y || s->x.y > t->x.y) return s->x.y < t->x.y ? -1 : 1;
    if (s->x.z < t->x.z || s->x.z > t->x.z) return s->x.z < t->x.z ? -1 : 1;
    return (s->k > t->k) - (s->k < t->k);
}

/* Merge corners of a solid that coincide, at the first of them; drop faces with fewer than three corners
 * left. */
static int merge_corners(struct body *b, fl_err *err)
{
    int32_t corners = 0, faces = 0, sides = 0;
    indexed_point *s = fl_alloc(b->nv, sizeof *s, err);
    int32_t *to = fl_alloc(b->nv, sizeof *to, err);
    if (!s || !to) {
        free(s), free(to);
        return -1;
    }
    for (int32_t k = 0; k < b->nv; k++) s[k] = (indexed_point){b->v[k], k};
    qsort(s, (size_t)b->nv, sizeof *s, by_position);
    for (int32_t k = 0, first = 0; k < b->nv; k++) {
        const fl_vec3 p = s[k].x, q = s[first].x;
        if (p.x != q.x || p.y != q.y || p.z != q.z) first = k;
        to[s[k].k] = s[first].k; /* never a later index */
    }
    for (int32_t k = 0; k < b->nv; k++) {
        if (to[k] == k) b->v[corners] = b->v[k], to[k] = corners++;
        else to[k] = to[to[k]];
    }
    for (int32_t f = 0, begin = 0; f < b->nf && corners < b->nv; f++) {
        const int32_t end = b->first[f + 1], from = sides;
        for (int32_t k = begin; k < end; k++) {
            const int32_t c = to[b->loop[k]];
            if (sides == from || b->loop[sides - 1] != c) b->loop[sides++] = c;
        }
        if (sides - from > 1 && b->loop[sides - 1] == b->loop[from]) sides--;
        begin = end;
        if (sides - from < 3) sides = from;
        else b->first[++faces] = sides;
    }
    if (corners < b->nv) b->nv = corners, b->nf = faces;
    free(s), free(to);
    return 0;
}

/* Append the complete record as a body. */
static int finish_body(fl_ice_field *a, struct body *b, const fl_text *in, fl_err *err)
{
    fl_poly core = {0};
    fl_err why = {0};
    char what[400];
    if (!b->open) return 0;
    b->open = 0;
    if (b->has_v < b->nv || b->has_f < b->nf) {
        snprintf(what, sizeof what, "body %d announces %d vertices and %d faces, %d and %d follow", b->id,
                 b->nv, b->nf, b->has_v, b->has_f);
        return fail_at(in, b->line, err, what);
    }
    if (b->nf > 0 && merge_corners(b, err)) return -1;
    if (fl_poly_make(&core, b->nv, b->v, b->nf, b->first, b->loop, &why)) {
        if (why.code != FL_INPUT) return fl_fail(err, why.code, "%s", why.text);
        snprintf(what, sizeof what, "body %d: %.350s", b->id, why.text);
        return fail_at(in, b->line, err, what);
    }
    if (fl_ice_field_add(a, b->id, b->radius, &core, NULL, NULL, b->vel, b->spin, err)) {
        fl_poly_free(&core);
        return -1;
    }
    a->record_line[a->n - 1] = b->line;
    a->material[a->n - 1] = b->material;
    a->group[a->n - 1] = b->group;
    return 0;
}

static int read_key(fl_ice_field *a, struct body *b, fl_text *in, fl_err *err)
{
    static const char *const keys[] = {"material", "group"};
    const char *word = "";
    const char *value;
    char key[40];
    int is_group, *given;
    if (fl_text_word(in, "key=value", &word, err)) return -1;
    value = strchr(word, '=');
    if (!value || value == word || !value[1])
        return fl_text_fail(in, err, "\"%.40s\" found, key=value is expected", word);
    snprintf(key, sizeof key, "%.*s", (int)(value - word < 39 ? value - word : 39), word);
    is_group = strcmp(key, "group") == 0;
    if (!is_group && strcmp(key, "material") != 0)
        return fl_text_fail(in, err, "unknown key \"%s\", the nearest is \"%s\"", key,
                            fl_text_nearest(key, keys, 2));
    given = is_group ? &b->group_given : &b->material_given;
    if (*given) return fl_text_fail(in, err, "%s is given twice", key);
    *given = 1;
    if (is_group) return (b->group = fl_string_table_add(&a->groups, value + 1, err)) < 0 ? -1 : 0;
    return (b->material = fl_string_table_add(&a->materials, value + 1, err)) < 0 ? -1 : 0;
}

static int read_poly(fl_ice_field *a, struct body *b, fl_text *in, fl_err *err)
{
    const int32_t most = INT32_MAX - 1;
    if (finish_body(a, b, in, err)) return -1;
    b->line = (int32_t)in->line_number;
    b->has_v = b->has_f = b->has_vel = b->material_given = b->group_given = 0;
    b->material = b->group = -1;
    b->vel = b->spin = v3(0, 0, 0);
    if (fl_text_i32(in, "id", 0, INT32_MAX, &b->id, err) || fl_text_f64(in, "radius", &b->radius, err) ||
        fl_text_i32(in, "number of vertices", 1, most, &b->nv, err) ||
        fl_text_i32(in, "number of faces", 0, most, &b->nf, err))
        return -1;
    if (b->radius < 0.0 || b->radius > FL_ICE_FIELD_MAX_COORD)
        return fl_text_fail(in, err, "body %d has radius %g m, 0 to %g m is expected", b->id, b->radius,
                            FL_ICE_FIELD_MAX_COORD);
    if (b->nv <= 2 && b->nf != 0)
        return fl_text_fail(in, err, "body %d has %d vertices and %d faces, no face is expected", b->id,
                            b->nv, b->nf);
    if (b->nv > 2 && b->nf < 2)
        return fl_text_fail(in, err, "body %d has %d vertices and %d faces, faces that close it are expected",
                            b->id, b->nv, b->nf);
    if (b->nf <= 2 && b->radius == 0.0)
        return fl_text_fail(
            in, err, "body %d is a %s of radius 0 and has no volume, a radius above 0 is expected", b->id,
            b->nv == 1   ? "point"
            : b->nv == 2 ? "segment"
                         : "flat polygon");
    while (in->next < in->n)
        if (read_key(a, b, in, err)) return -1;
    if (fl_grow(&b->first, &b->f_cap, 1, sizeof *b->first, err)) return -1;
    b->first[0] = 0;
    b->open = 1;
    return 0;
}

static int read_vertex(struct body *b, fl_text *in, fl_err *err)
{
    fl_vec3 x = {0};
    if (b->has_v == b->nv)
        return fl_text_fail(in, err, "body %d has its %d vertices, another one follows", b->id, b->nv);
    if (fl_text_f64(in, "x", &x.x, err) || fl_text_f64(in, "y", &x.y, err) ||
        fl_text_f64(in, "z", &x.z, err) || fl_text_no_more(in, err))
        return -1;
    if (fabs(x.x) > FL_ICE_FIELD_MAX_COORD || fabs(x.y) > FL_ICE_FIELD_MAX_COORD ||
        fabs(x.z) > FL_ICE_FIELD_MAX_COORD)
        return fl_text_fail(in, err, "vertex (%g, %g, %g) m is farther than %g m", x.x, x.y, x.z,
                            FL_ICE_FIELD_MAX_COORD);
    if (fl_grow(&b->v, &b->v_cap, (int64_t)b->has_v + 1, sizeof *b->v, err)) return -1;
    b->v[b->has_v++] = x;
    return 0;
}

static int read_face(struct body *b, fl_text *in, fl_err *err)
{
    int32_t k, at;
    if (b->has_v < b->nv)
        return fl_text_fail(in, err, "body %d announces %d vertices, a face follows after %d", b->id, b->nv,
                            b->has_v);
    if (b->has_f == b->nf)
        return fl_text_fail(in, err, "body %d has its %d faces, another one follows", b->id, b->nf);
    if (fl_text_i32(in, "number of corners", 3, b->nv, &k, err)) return -1;
    if (fl_grow(&b->first, &b->f_cap, (int64_t)b->has_f + 2, sizeof *b->first, err)) return -1;
    at = b->first[b->has_f];
    for (; k > 0; k--) {
        if (fl_grow(&b->loop, &b->l_cap, (int64_t)at + 1, sizeof *b->loop, err) ||
            fl_text_i32(in, "vertex of the face", 0, b->nv - 1, &b->loop[at], err))
            return -1;
        at++;
    }
    b->first[++b->has_f] = at;
    return fl_text_no_more(in, err);
}

static int read_vel(struct body *b, fl_text *in, fl_err *err)
{
    double x[6];
    static const char *const what[6] = {"vx", "vy", "vz", "wx", "wy", "wz"};
    if (b->has_v < b->nv || b->has_f < b->nf)
        return fl_text_fail(in, err, "vel comes before the last vertex and face of body %d", b->id);
    if (b->has_vel) return fl_text_fail(in, err, "body %d has two vel records", b->id);
    for (int k = 0; k < 6; k++)
        if (fl_text_f64(in, what[k], &x[k], err)) return -1;
    b->vel = v3(x[0], x[1], x[2]);
    b->spin = v3(x[3], x[4], x[5]);
    b->has_vel = 1;
    return fl_text_no_more(in, err);
}

/* Read a bond; i and j are ids until all bodies are known. */
static int read_bond(fl_ice_field *a, struct body *b, fl_text *in, fl_err *err)
{
    fl_ice_field_bond d = {0};
    if (in->version < 2)
        return fl_text_fail(in, err, "a bond is of g-polys 2, the file says g-polys %d", in->version);
    if (finish_body(a, b, in, err)) return -1;
    if (fl_text_i32(in, "id", 0, INT32_MAX, &d.i, err) || fl_text_i32(in, "id", 0, INT32_MAX, &d.j, err) ||
        fl_text_f64(in, "area", &d.area, err) || fl_text_f64(in, "length", &d.length, err) ||
        fl_text_f64(in, "x", &d.x.x, err) || fl_text_f64(in, "y", &d.x.y, err) ||
        fl_text_f64(in, "z", &d.x.z, err) || fl_text_no_more(in, err))
        return -1;
    if (d.i == d.j) return fl_text_fail(in, err, "body %d is bonded to itself, two bodies are expected", d.i);
    if (!(d.area > 0.0 && d.length > 0.0 && d.area <= FL_ICE_FIELD_MAX_COORD * FL_ICE_FIELD_MAX_COORD &&
          d.length <= FL_ICE_FIELD_MAX_COORD))
        return fl_text_fail(in, err, "the bond has area %g m2 and length %g m, more than 0 is expected",
                            d.area, d.length);
    if (fabs(d.x.x) > FL_ICE_FIELD_MAX_COORD || fabs(d.x.y) > FL_ICE_FIELD_MAX_COORD ||
        fabs(d.x.z) > FL_ICE_FIELD_MAX_COORD)
        return fl_text_fail(in, err, "centroid (%g, %g, %g) m is farther than %g m", d.x.x, d.x.y, d.x.z,
                            FL_ICE_FIELD_MAX_COORD);
    if (fl_grow(&b->bond_line, &b->bond_line_cap, (int64_t)a->bonds + 1, sizeof *b->bond_line, err))
        return -1;
    b->bond_line[a->bonds] = (int32_t)in->line_number;
    return fl_ice_field_add_bond(a, d.i, d.j, d.area, d.length, d.x, err);
}

/* Read a joint; i and j are ids and in the order of the row until all bodies are known. */
static int read_joint(fl_ice_field *a, struct body *b, fl_text *in, fl_err *err)
{
    fl_ice_field_joint d = {0};
    const char *name = "";
    if (in->version < 3)
        return fl_text_fail(in, err, "a joint is of g-polys 3, the file says g-polys %d", in->version);
    if (finish_body(a, b, in, err)) return -1;
    if (fl_text_i32(in, "id", 0, INT32_MAX, &d.i, err) || fl_text_i32(in, "id", 0, INT32_MAX, &d.j, err) ||
        fl_text_i32(in, "face", 0, INT32_MAX, &d.fi, err) ||
        fl_text_i32(in, "face", 0, INT32_MAX, &d.fj, err) ||
        fl_text_word(in, "name of the joint", &name, err) || fl_text_no_more(in, err))
        return -1;
    if (d.i == d.j)
        return fl_text_fail(in, err, "body %d has a joint with itself, two bodies are expected", d.i);
    if ((d.name = fl_string_table_add(&a->joint_names, name, err)) < 0) return -1;
    if (fl_grow(&b->joint_line, &b->joint_line_cap, (int64_t)a->joints + 1, sizeof *b->joint_line, err) ||
        fl_grow(&a->joint, &a->joint_cap, (int64_t)a->joints + 1, sizeof *a->joint, err))
        return -1;
    b->joint_line[a->joints] = (int32_t)in->line_number;
    a->joint[a->joints++] = d;
    return 0;
}

static int read_record(fl_ice_field *a, struct body *b, fl_text *in, fl_err *err)
{
    static const char *const records[] = {"poly", "v", "f", "vel", "bond", "joint"};
    const char *word = "";
    if (fl_text_word(in, "record", &word, err)) return -1;
    if (strcmp(word, "poly") == 0) return read_poly(a, b, in, err);
    if (strcmp(word, "bond") == 0) return read_bond(a, b, in, err);
    if (strcmp(word, "joint") == 0) return read_joint(a, b, in, err);
    if (strcmp(word, "v") != 0 && strcmp(word, "f") != 0 && strcmp(word, "vel") != 0)
        return fl_text_fail(in, err, "unknown record \"%.40s\", the nearest is \"%s\"", word,
                            fl_text_nearest(word, records, 3 + in->version));
    if (!b->open)
        return fl_text_fail(in, err,
                            a->bonds || a->joints ? "%s found behind a bond or joint"
                                                  : "%s found before the first poly",
                            word);
    return word[0] == 'f' ? read_face(b, in, err) : word[1] ? read_vel(b, in, err) : read_vertex(b, in, err);
}

struct id_line {
    int32_t id, line, body;
};

static int by_id(const void *a, const void *b)
{
    const struct id_line *p = a, *q = b;
    return p->id != q->id ? (p->id > q->id) - (p->id < q->id) : (p->line > q->line) - (p->line < q->line);
}

/* --- bonds, when all bodies are known ------------------------------------------------------------------- */

/* Position of the body with that id in the sorted list, -1 if there is none. */
static int32_t find_id(const struct id_line *s, int32_t n, int32_t id)
{
    int32_t lo = 0, hi = n;
    while (lo < hi) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (s[mid].id < id) lo = mid + 1;
        else hi = mid;
    }
    return lo < n && s[lo].id == id ? lo : -1;
}

struct bond_line {
    fl_ice_field_bond bond;
    int32_t line;
};

static int by_pair(const void *a, const void *b)
{
    const struct bond_line *p = a, *q = b;
    if (p->bond.i != q->bond.i) return (p->bond.i > q->bond.i) - (p->bond.i < q->bond.i);
    if (p->bond.j != q->bond.j) return (p->bond.j > q->bond.j) - (p->bond.j < q->bond.j);
    return (p->line > q->line) - (p->line < q->line);
}

/* Replace ids by indices, then sort; s has the ids ascending. */
static int resolve_bonds(fl_ice_field *a, const struct id_line *s, const int32_t *line, const fl_text *in,
                         fl_err *err)
{
    struct bond_line *t = fl_alloc(a->bonds, sizeof *t, err);
    int32_t twice = -1;
    char what[120];
    if (!t) return -1;
    for (int32_t k = 0; k < a->bonds; k++) {
        const int32_t id[2] = {a->bond[k].i, a->bond[k].j};
        int32_t at[2];
        for (int e = 0; e < 2; e++) {
            const int32_t p = find_id(s, a->n, id[e]);
            if (p < 0) {
                snprintf(what, sizeof what, "the bond names body %d, which is not in the file", id[e]);
                free(t);
                return fail_at(in, line[k], err, what);
            }
            at[e] = s[p].body;
        }
        t[k].bond = a->bond[k];
        t[k].bond.i = at[0] < at[1] ? at[0] : at[1];
        t[k].bond.j = at[0] < at[1] ? at[1] : at[0];
        t[k].line = line[k];
    }
    qsort(t, (size_t)a->bonds, sizeof *t, by_pair);
    for (int32_t k = 0; k < a->bonds; k++) {
        a->bond[k] = t[k].bond;
        if (k && t[k].bond.i == t[k - 1].bond.i && t[k].bond.j == t[k - 1].bond.j &&
            (twice < 0 || t[k].line < t[twice].line))
            twice = k;
    }
    if (twice >= 0) {
        snprintf(what, sizeof what, "bodies %d and %d are bonded on line %d already", a->id[t[twice].bond.i],
                 a->id[t[twice].bond.j], t[twice - 1].line);
        fail_at(in, t[twice].line, err, what);
    }
    free(t);
    return twice >= 0 ? -1 : 0;
}

struct joint_line {
    fl_ice_field_joint joint;
    int32_t line;
};

static int by_joined_pair(const void *a, const void *b)
{
    const struct joint_line *p = a, *q = b;
    if (p->joint.i != q->joint.i) return (p->joint.i > q->joint.i) - (p->joint.i < q->joint.i);
    if (p->joint.j != q->joint.j) return (p->joint.j > q->joint.j) - (p->joint.j < q->joint.j);
    return (p->line > q->line) - (p->line < q->line);
}

/* Replace the ids of a joint by indices, ascending; -1 with a sentence in what. */
static int resolve_joint(const fl_ice_field *a, const struct id_line *s, fl_ice_field_joint *d, char *what,
                         size_t room)
{
    const int32_t id[2] = {d->i, d->j}, face[2] = {d->fi, d->fj};
    int32_t at[2];
    for (int e = 0; e < 2; e++) {
        const int32_t p = find_id(s, a->n, id[e]);
        if (p < 0) {
            snprintf(what, room, "the joint names body %d, which is not in the file", id[e]);
            return -1;
        }
        at[e] = s[p].body;
        if (face[e] >= a->core[at[e]].nf) {
            snprintf(what, room, "the joint names face %d of body %d, which has %d", face[e], id[e],
                     a->core[at[e]].nf);
            return -1;
        }
    }
    const int turn = at[0] > at[1];
    *d = (fl_ice_field_joint){at[turn], at[!turn], face[turn], face[!turn], d->name};
    return 0;
}

/* The same for joints. */
static int resolve_joints(fl_ice_field *a, const struct id_line *s, const int32_t *line, const fl_text *in,
                          fl_err *err)
{
    struct joint_line *t = fl_alloc(a->joints, sizeof *t, err);
    char what[120];
    int rc = t ? 0 : -1;
    for (int32_t k = 0; k < a->joints && rc == 0; k++) {
        t[k] = (struct joint_line){a->joint[k], line[k]};
        if (resolve_joint(a, s, &t[k].joint, what, sizeof what)) rc = fail_at(in, line[k], err, what);
    }
    if (rc == 0) qsort(t, (size_t)a->joints, sizeof *t, by_joined_pair);
    for (int32_t k = 0; k < a->joints && rc == 0; k++) {
        a->joint[k] = t[k].joint;
        if (k == 0 || t[k].joint.i != t[k - 1].joint.i || t[k].joint.j != t[k - 1].joint.j) continue;
        snprintf(what, sizeof what, "bodies %d and %d have a joint on line %d already", a->id[t[k].joint.i],
                 a->id[t[k].joint.j], t[k - 1].line);
        rc = fail_at(in, t[k].line, err, what);
    }
    free(t);
    return rc;
}

/* Check that ids differ, by one sort at the end: n log n for any order of the file. */
static int check_ids(fl_ice_field *a, const struct body *b, const fl_text *in, fl_err *err)
{
    struct id_line *s = fl_alloc(a->n, sizeof *s, err);
    int32_t at = -1;
    char what[120];
    int rc;
    if (!s) return -1;
    for (int32_t i = 0; i < a->n; i++) s[i] = (struct id_line){a->id[i], a->record_line[i], i};
    qsort(s, (size_t)a->n, sizeof *s, by_id);
    for (int32_t k = 1; k < a->n; k++)
        if (s[k].id == s[k - 1].id && (at < 0 || s[k].line < s[at].line)) at = k;
    if (at >= 0) {
        snprintf(what, sizeof what, "body %d is already on line %d, another id is expected", s[at].id,
                 s[at - 1].line);
        fail_at(in, s[at].line, err, what);
    }
    rc = at >= 0 || resolve_bonds(a, s, b->bond_line, in, err) || resolve_joints(a, s, b->joint_line, in, err)
             ? -1
             : 0;
    free(s);
    return rc;
}

int fl_ice_field_read_text(fl_ice_field *out, fl_text *in, fl_err *err)
{
    fl_ice_field a = {0};
    struct body b = {0};
    int rc = -1, more;
    if (fl_text_magic(in, "g-polys", FL_ICE_FIELD_VERSION, err)) goto done;
    while ((more = fl_text_row(in, err)) > 0)
        if (read_record(&a, &b, in, err)) goto done;
    if (more < 0 || finish_body(&a, &b, in, err)) goto done;
    if (a.n == 0) {
        fl_text_fail(in, err, "the file ends without a body, a poly record is expected");
        goto done;
    }
    if (check_ids(&a, &b, in, err)) goto done;
    a.history = in->history;
    in->history = NULL;
    *out = a;
    a = (fl_ice_field){0};
    rc = 0;
done:
    free(b.v);
    free(b.first);
    free(b.loop);
    free(b.bond_line);
    free(b.joint_line);
    fl_ice_field_free(&a);
    fl_text_close(in);
    return rc;
}

int fl_ice_field_read(fl_ice_field *out, const char *path, fl_err *err)
{
    fl_text in = {0};
    return fl_text_open(&in, path, err) ? -1 : fl_ice_field_read_text(out, &in, err);
}

/* --- write ---------------------------------------------------------------------------------------------- */

/* Own output buffer: a call of the C library for each number would cost as much as its conversion. */
enum { BUFFER = 1 << 16 };

struct writer {
    FILE *f;
    int n, z_len;
    double z; /* the number in z_text: a prism has two heights for all its corners */
    char z_text[FL_NUMBER_LEN];
    char text[BUFFER];
};

static void flush_buffer(struct writer *o)
{
    fwrite(o->text, 1, (size_t)o->n, o->f);
    o->n = 0;
}

static void put_text(struct writer *o, const char *text, int len)
{
    if (o->n + len > BUFFER) flush_buffer(o);
    if (len > BUFFER) {
        fwrite(text, 1, (size_t)len, o->f);
        return;
    }
    memcpy(o->text + o->n, text, (size_t)len);
    o->n += len;
}

static void put_char(struct writer *o, char c) { put_text(o, &c, 1); }

static void put_int(struct writer *o, int32_t x)
{
    char text[12];
    int at = 12;
    for (; x > 9; x /= 10) text[--at] = (char)('0' + x % 10);
    text[--at] = (char)('0' + x);
    put_text(o, text + at, 12 - at);
}

static void put_f64(struct writer *o, double x)
{
    char text[FL_NUMBER_LEN];
    fl_number_text(x, text);
    put_text(o, text, (int)strlen(text));
}

static void put_vec3(struct writer *o, fl_vec3 x)
{
    put_char(o, ' ');
    put_f64(o, x.x);
    put_char(o, ' ');
    put_f64(o, x.y);
    put_char(o, ' ');
    if (o->z_len == 0 || memcmp(&x.z, &o->z, sizeof x.z) != 0) {
        fl_number_text(o->z = x.z, o->z_text);
        o->z_len = (int)strlen(o->z_text);
    }
    put_text(o, o->z_text, o->z_len);
}

static void put_name(struct writer *o, const char *key, const char *name)
{
    put_text(o, key, (int)strlen(key));
    put_text(o, name, (int)strlen(name));
}

static void put_body(struct writer *o, const fl_ice_field *a, int32_t i)
{
    const fl_poly *p = &a->core[i];
    put_text(o, "poly ", 5);
    put_int(o, a->id[i]);
    put_char(o, ' ');
    put_f64(o, a->radius[i]);
    put_char(o, ' ');
    put_int(o, p->nv);
    put_char(o, ' ');
    put_int(o, p->nf);
    if (a->material[i] >= 0) put_name(o, " material=", a->materials.name[a->material[i]]);
    if (a->group[i] >= 0) put_name(o, " group=", a->groups.name[a->group[i]]);
    put_char(o, '\n');
    for (int32_t v = 0; v < p->nv; v++) {
        put_char(o, 'v');
        put_vec3(o, p->v[v]);
        put_char(o, '\n');
    }
    for (int32_t k = 0; k < p->nf; k++) {
        put_text(o, "f ", 2);
        put_int(o, p->first[k + 1] - p->first[k]);
        for (int32_t e = p->first[k]; e < p->first[k + 1]; e++) {
            put_char(o, ' ');
            put_int(o, p->loop[e]);
        }
        put_char(o, '\n');
    }
    if (v3_nonzero(a->velocity[i]) || v3_nonzero(a->spin[i])) {
        put_text(o, "vel", 3);
        put_vec3(o, a->velocity[i]);
        put_vec3(o, a->spin[i]);
        put_char(o, '\n');
    }
}

void fl_ice_field_write(FILE *f, const fl_ice_field *a, const fl_history_line *by)
{
    struct writer o;
    o.f = f;
    o.n = o.z_len = 0;
    fl_write_file_header(f, "g-polys", a->joints ? 3 : a->bonds ? 2 : 1, a->history, by);
    for (int32_t i = 0; i < a->n; i++) put_body(&o, a, i);
    for (int32_t k = 0; k < a->bonds; k++) {
        const fl_ice_field_bond *d = &a->bond[k];
        put_text(&o, "bond ", 5);
        put_int(&o, a->id[d->i]);
        put_char(&o, ' ');
        put_int(&o, a->id[d->j]);
        put_char(&o, ' ');
        put_f64(&o, d->area);
        put_char(&o, ' ');
        put_f64(&o, d->length);
        put_vec3(&o, d->x);
        put_char(&o, '\n');
    }
    for (int32_t k = 0; k < a->joints; k++) {
        const fl_ice_field_joint *d = &a->joint[k];
        const int32_t number[4] = {a->id[d->i], a->id[d->j], d->fi, d->fj};
        put_text(&o, "joint", 5);
        for (int e = 0; e < 4; e++) put_char(&o, ' '), put_int(&o, number[e]);
        put_name(&o, " ", a->joint_names.name[d->name]);
        put_char(&o, '\n');
    }
    flush_buffer(&o);
}

uint64_t fl_ice_field_hash(const fl_ice_field *a)
{
    uint64_t h = FL_HASH_START;
    h = fl_hash(h, a->id, (int64_t)a->n * (int64_t)sizeof *a->id);
    h = fl_hash(h, a->radius, (int64_t)a->n * (int64_t)sizeof *a->radius);
    h = fl_hash(h, a->velocity, (int64_t)a->n * (int64_t)sizeof *a->velocity);
    h = fl_hash(h, a->spin, (int64_t)a->n * (int64_t)sizeof *a->spin);
    for (int32_t i = 0; i < a->n; i++) {
        const fl_poly *p = &a->core[i];
        const int32_t size[2] = {p->nv, p->nf};
        h = fl_hash(h, size, sizeof size);
        h = fl_hash(h, p->v, (int64_t)p->nv * (int64_t)sizeof *p->v);
        if (p->nf == 0) continue;
        h = fl_hash(h, p->first, ((int64_t)p->nf + 1) * (int64_t)sizeof *p->first);
        h = fl_hash(h, p->loop, (int64_t)p->first[p->nf] * (int64_t)sizeof *p->loop);
    }
    for (int32_t k = 0; k < a->bonds; k++) {
        const fl_ice_field_bond *d = &a->bond[k];
        const int32_t end[2] = {d->i, d->j};
        const double x[5] = {d->area, d->length, d->x.x, d->x.y, d->x.z};
        h = fl_hash(h, end, sizeof end);
        h = fl_hash(h, x, sizeof x);
    }
    for (int32_t k = 0; k < a->joints; k++) {
        const fl_ice_field_joint *d = &a->joint[k];
        const int32_t number[4] = {d->i, d->j, d->fi, d->fj};
        h = fl_hash(h, number, sizeof number);
    }
    return h;
}
