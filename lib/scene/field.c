/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/mem.h"
#include "base/num.h"
#include "base/text.h"
#include "scene/field.h"

/* Make room for one more body in every array; cap moves only when all have it. */
static int grow(fl_field *a, fl_err *err)
{
    const int64_t want = (int64_t)a->n + 1;
    int32_t cap[8];
    for (int k = 0; k < 8; k++) cap[k] = a->cap;
    if (want <= a->cap) return 0;
    if (fl_grow(&a->id, &cap[0], want, sizeof *a->id, err) ||
        fl_grow(&a->line, &cap[1], want, sizeof *a->line, err) ||
        fl_grow(&a->material, &cap[2], want, sizeof *a->material, err) ||
        fl_grow(&a->group, &cap[3], want, sizeof *a->group, err) ||
        fl_grow(&a->radius, &cap[4], want, sizeof *a->radius, err) ||
        fl_grow(&a->core, &cap[5], want, sizeof *a->core, err) ||
        fl_grow(&a->vel, &cap[6], want, sizeof *a->vel, err) ||
        fl_grow(&a->spin, &cap[7], want, sizeof *a->spin, err))
        return -1;
    a->cap = cap[0];
    return 0;
}

int fl_field_add(fl_field *a, int32_t id, double radius, fl_poly *core, const char *material,
                 const char *group, fl_vec3 vel, fl_vec3 spin, fl_err *err)
{
    const int32_t i = a->n;
    int32_t m = -1, g = -1;
    if (grow(a, err)) return -1;
    if (material && (m = fl_names_add(&a->materials, material, err)) < 0) return -1;
    if (group && (g = fl_names_add(&a->groups, group, err)) < 0) return -1;
    a->id[i] = id;
    a->line[i] = 0;
    a->material[i] = m;
    a->group[i] = g;
    a->radius[i] = radius;
    a->core[i] = *core;
    a->vel[i] = vel;
    a->spin[i] = spin;
    *core = (fl_poly){0};
    a->n++;
    return 0;
}

void fl_field_free(fl_field *a)
{
    for (int32_t i = 0; i < a->n; i++) fl_poly_free(&a->core[i]);
    free(a->id);
    free(a->line);
    free(a->material);
    free(a->group);
    free(a->radius);
    free(a->core);
    free(a->vel);
    free(a->spin);
    free(a->history);
    fl_names_free(&a->materials);
    fl_names_free(&a->groups);
    *a = (fl_field){0};
}

/* --- read ----------------------------------------------------------------------------------------------- */

/* The record under way. */
struct body {
    int32_t line, id, nv, nf;                  /* as the poly row announced them */
    int32_t has_v, has_f, v_cap, f_cap, l_cap; /* as they arrive */
    int open, has_vel, material_given, group_given;
    int32_t material, group;
    double radius;
    fl_vec3 vel, spin;
    fl_vec3 *v;
    int32_t *first, *loop;
};

static int fail_at(const fl_text *in, int32_t line, fl_err *err, const char *sentence)
{
    fl_text there = *in;
    there.number = line;
    return fl_text_fail(&there, err, "%s", sentence);
}

/* The record is complete when its vertices and faces are there; then it becomes a body. */
static int close_body(fl_field *a, struct body *b, const fl_text *in, fl_err *err)
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
    if (fl_poly_make(&core, b->nv, b->v, b->nf, b->first, b->loop, &why)) {
        if (why.code != FL_INPUT) return fl_fail(err, why.code, "%s", why.text);
        snprintf(what, sizeof what, "body %d: %.350s", b->id, why.text);
        return fail_at(in, b->line, err, what);
    }
    if (fl_field_add(a, b->id, b->radius, &core, NULL, NULL, b->vel, b->spin, err)) {
        fl_poly_free(&core);
        return -1;
    }
    a->line[a->n - 1] = b->line;
    a->material[a->n - 1] = b->material;
    a->group[a->n - 1] = b->group;
    return 0;
}

static int read_key(fl_field *a, struct body *b, fl_text *in, fl_err *err)
{
    static const char *const keys[] = {"material", "group"};
    const char *word = "";
    const char *value;
    char key[40];
    int is_group, *given;
    if (fl_text_word(in, "key=value", &word, err)) return -1;
    value = strchr(word, '=');
    if (!value || value == word || !value[1])
        return fl_text_fail(in, err, "\"%.40s\" found, key=value was wanted", word);
    snprintf(key, sizeof key, "%.*s", (int)(value - word < 39 ? value - word : 39), word);
    is_group = strcmp(key, "group") == 0;
    if (!is_group && strcmp(key, "material") != 0)
        return fl_text_fail(in, err, "unknown key \"%s\", the nearest is \"%s\"", key,
                            fl_text_nearest(key, keys, 2));
    given = is_group ? &b->group_given : &b->material_given;
    if (*given) return fl_text_fail(in, err, "%s is given twice", key);
    *given = 1;
    if (is_group) return (b->group = fl_names_add(&a->groups, value + 1, err)) < 0 ? -1 : 0;
    return (b->material = fl_names_add(&a->materials, value + 1, err)) < 0 ? -1 : 0;
}

static int read_poly(fl_field *a, struct body *b, fl_text *in, fl_err *err)
{
    const int32_t most = INT32_MAX - 1;
    if (close_body(a, b, in, err)) return -1;
    b->line = (int32_t)in->number;
    b->has_v = b->has_f = b->has_vel = b->material_given = b->group_given = 0;
    b->material = b->group = -1;
    b->vel = b->spin = v3(0, 0, 0);
    if (fl_text_i32(in, "id", 0, INT32_MAX, &b->id, err) || fl_text_f64(in, "radius", &b->radius, err) ||
        fl_text_i32(in, "number of vertices", 1, most, &b->nv, err) ||
        fl_text_i32(in, "number of faces", 0, most, &b->nf, err))
        return -1;
    if (b->radius < 0.0 || b->radius > FL_FIELD_FAR)
        return fl_text_fail(in, err, "body %d has radius %g m, 0 to %g m was wanted", b->id, b->radius,
                            FL_FIELD_FAR);
    if (b->nv <= 2 && b->nf != 0)
        return fl_text_fail(in, err, "body %d has %d vertices and %d faces, no face was wanted", b->id, b->nv,
                            b->nf);
    if (b->nv > 2 && b->nf < 2)
        return fl_text_fail(in, err, "body %d has %d vertices and %d faces, faces that close it were wanted",
                            b->id, b->nv, b->nf);
    if (b->nf <= 2 && b->radius == 0.0)
        return fl_text_fail(
            in, err, "body %d is a %s of radius 0 and has no volume, a radius above 0 was wanted", b->id,
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
        fl_text_f64(in, "z", &x.z, err) || fl_text_end(in, err))
        return -1;
    if (fabs(x.x) > FL_FIELD_FAR || fabs(x.y) > FL_FIELD_FAR || fabs(x.z) > FL_FIELD_FAR)
        return fl_text_fail(in, err, "vertex (%g, %g, %g) m is farther than %g m", x.x, x.y, x.z,
                            FL_FIELD_FAR);
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
    return fl_text_end(in, err);
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
    return fl_text_end(in, err);
}

static int read_record(fl_field *a, struct body *b, fl_text *in, fl_err *err)
{
    static const char *const records[] = {"poly", "v", "f", "vel"};
    const char *word = "";
    if (fl_text_word(in, "record", &word, err)) return -1;
    if (strcmp(word, "poly") == 0) return read_poly(a, b, in, err);
    if (strcmp(word, "v") != 0 && strcmp(word, "f") != 0 && strcmp(word, "vel") != 0)
        return fl_text_fail(in, err, "unknown record \"%.40s\", the nearest is \"%s\"", word,
                            fl_text_nearest(word, records, 4));
    if (!b->open) return fl_text_fail(in, err, "%s found before the first poly", word);
    return word[0] == 'f' ? read_face(b, in, err) : word[1] ? read_vel(b, in, err) : read_vertex(b, in, err);
}

struct id_line {
    int32_t id, line;
};

static int by_id(const void *a, const void *b)
{
    const struct id_line *p = a, *q = b;
    return p->id != q->id ? (p->id > q->id) - (p->id < q->id) : (p->line > q->line) - (p->line < q->line);
}

/* Sorted once at the end: one id that comes twice is found in n log n, whatever the order of the file. */
static int check_ids(const fl_field *a, const fl_text *in, fl_err *err)
{
    struct id_line *s = fl_alloc(a->n, sizeof *s, err);
    int32_t at = -1;
    char what[120];
    if (!s) return -1;
    for (int32_t i = 0; i < a->n; i++) s[i] = (struct id_line){a->id[i], a->line[i]};
    qsort(s, (size_t)a->n, sizeof *s, by_id);
    for (int32_t k = 1; k < a->n; k++)
        if (s[k].id == s[k - 1].id && (at < 0 || s[k].line < s[at].line)) at = k;
    if (at >= 0) {
        snprintf(what, sizeof what, "body %d is already on line %d, another id was wanted", s[at].id,
                 s[at - 1].line);
        fail_at(in, s[at].line, err, what);
    }
    free(s);
    return at >= 0 ? -1 : 0;
}

int fl_field_read(fl_field *out, const char *path, fl_err *err)
{
    fl_text in = {0};
    fl_field a = {0};
    struct body b = {0};
    int rc = -1, more;
    if (fl_text_open(&in, path, err) || fl_text_magic(&in, "g-polys", FL_FIELD_VERSION, err)) goto done;
    while ((more = fl_text_row(&in, err)) > 0)
        if (read_record(&a, &b, &in, err)) goto done;
    if (more < 0 || close_body(&a, &b, &in, err)) goto done;
    if (a.n == 0) {
        fl_text_fail(&in, err, "the file ends without a body, a poly record was wanted");
        goto done;
    }
    if (check_ids(&a, &in, err)) goto done;
    a.history = in.history;
    in.history = NULL;
    *out = a;
    a = (fl_field){0};
    rc = 0;
done:
    free(b.v);
    free(b.first);
    free(b.loop);
    fl_field_free(&a);
    fl_text_close(&in);
    return rc;
}

/* --- write ---------------------------------------------------------------------------------------------- */

static int moves(fl_vec3 v) { return v.x != 0.0 || v.y != 0.0 || v.z != 0.0; }

static void write_vec3(FILE *f, fl_vec3 x)
{
    char t[3][FL_NUM_LEN];
    fprintf(f, " %s %s %s", fl_num_text(x.x, t[0]), fl_num_text(x.y, t[1]), fl_num_text(x.z, t[2]));
}

void fl_field_write(FILE *f, const fl_field *a, const fl_by *by)
{
    char num[FL_NUM_LEN];
    fl_by_header(f, "g-polys", FL_FIELD_VERSION, a->history, by);
    for (int32_t i = 0; i < a->n; i++) {
        const fl_poly *p = &a->core[i];
        fprintf(f, "poly %d %s %d %d", a->id[i], fl_num_text(a->radius[i], num), p->nv, p->nf);
        if (a->material[i] >= 0) fprintf(f, " material=%s", a->materials.name[a->material[i]]);
        if (a->group[i] >= 0) fprintf(f, " group=%s", a->groups.name[a->group[i]]);
        fputc('\n', f);
        for (int32_t v = 0; v < p->nv; v++) {
            fputc('v', f);
            write_vec3(f, p->v[v]);
            fputc('\n', f);
        }
        for (int32_t k = 0; k < p->nf; k++) {
            fprintf(f, "f %d", p->first[k + 1] - p->first[k]);
            for (int32_t e = p->first[k]; e < p->first[k + 1]; e++) fprintf(f, " %d", p->loop[e]);
            fputc('\n', f);
        }
        if (moves(a->vel[i]) || moves(a->spin[i])) {
            fputs("vel", f);
            write_vec3(f, a->vel[i]);
            write_vec3(f, a->spin[i]);
            fputc('\n', f);
        }
    }
}
