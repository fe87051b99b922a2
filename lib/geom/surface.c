/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "geom/surface.h"

/* Names appear in tables that are split at blanks and where '#' opens a comment.  Other bytes stay. */
static char clean_char(const char *name, size_t k)
{
    return (unsigned char)name[k] <= ' ' || name[k] == 0x7f || (k == 0 && name[k] == '#') ? '_' : name[k];
}

static int name_matches(const char *cleaned, const char *name, size_t len)
{
    for (size_t k = 0; k < len; k++)
        if (cleaned[k] == '\0' || cleaned[k] != clean_char(name, k)) return 0;
    return cleaned[len] == '\0';
}

enum { SHORT_NAME = 256 }; /* bytes that hold most names */

/* Index of the part with that name; part i is tried first. */
static int32_t find_part(const fl_surface *s, int32_t i, const char *name, size_t len)
{
    if (i < s->n && name_matches(s->part[i].name, name, len)) return i;
    for (i = 0; i < s->n; i++)
        if (name_matches(s->part[i].name, name, len)) return i;
    return -1;
}

int32_t fl_surface_find(const fl_surface *s, const char *name, size_t len)
{
    char few[SHORT_NAME], *word = len < SHORT_NAME ? few : malloc(len + 1);
    int32_t k;
    if (!word || s->given_names.n == 0) { /* parts named in another way */
        if (word != few) free(word);
        return find_part(s, 0, name, len);
    }
    for (size_t i = 0; i < len; i++) word[i] = clean_char(name, i);
    word[len] = '\0';
    k = fl_string_table_find(&s->given_names, word);
    if (word != few) free(word);
    return k < 0 ? -1 : find_part(s, s->given_index[k], name, len);
}

/* The smallest id above all ids in use. */
static int32_t next_free_id(fl_surface *s)
{
    if (s->n != s->n_after_add)
        s->ids_counted = s->next_id = 0; /* parts were removed, and others may have taken their places */
    for (; s->ids_counted < s->n; s->ids_counted++) {
        const int32_t id = s->part[s->ids_counted].id;
        if (id >= s->next_id && id < INT32_MAX) s->next_id = id + 1;
    }
    return s->next_id;
}

/* Records the index of the part with a name. */
static int record_name(fl_surface *s, const char *word, int32_t i, fl_err *err)
{
    const int64_t n = (int64_t)s->given_names.n + 1;
    int32_t k;
    if (fl_grow(&s->given_index, &s->given_cap, n, sizeof *s->given_index, err) ||
        fl_grow(&s->next_suffix, &s->suffix_cap, n, sizeof *s->next_suffix, err))
        return -1;
    if (fl_string_table_find(&s->given_names, word) < 0) s->next_suffix[n - 1] = 0;
    k = fl_string_table_add(&s->given_names, word, err);
    if (k >= 0) s->given_index[k] = i;
    return k < 0 ? -1 : 0;
}

/* Appends "_2", "_3", ... to a word of length len until the name is free.  After the first few numbers the
 * search continues where it last ended, since thousands of parts may have the same name. */
static void make_unique(fl_surface *s, char *word, size_t len)
{
    enum { FIRST = 2, LAST = 9 };
    const int32_t base = s->given_names.n ? fl_string_table_find(&s->given_names, word) : -1;
    for (int32_t k = FIRST; fl_surface_find(s, word, strlen(word)) >= 0; k++) {
        if (k > LAST && base >= 0 && k < s->next_suffix[base]) k = s->next_suffix[base];
        snprintf(word + len, 16, "_%d", k);
        if (base >= 0 && k > s->next_suffix[base]) s->next_suffix[base] = k;
    }
}

int32_t fl_surface_add(fl_surface *s, const char *name, size_t len, fl_err *err)
{
    const size_t room = len + 16; /* for "part" or the longest "_N" */
    char *word = fl_alloc((int64_t)room, 1, err);
    if (!word || fl_grow(&s->part, &s->cap, s->n + 1, sizeof *s->part, err)) goto failed;
    for (size_t k = 0; k < len; k++) word[k] = clean_char(name, k);
    if (len == 0) {
        memcpy(word, "part", 4);
        len = 4;
    }
    make_unique(s, word, len);
    if (record_name(s, word, s->n, err)) goto failed;
    s->part[s->n] = (fl_part){.name = word, .id = next_free_id(s)};
    s->n_after_add = ++s->n;
    return s->n - 1;
failed:
    free(word);
    return -1;
}

int fl_surface_vertex(fl_part *p, fl_vec3 x, fl_err *err)
{
    if (fl_grow(&p->v, &p->v_cap, (int64_t)p->nv + 1, sizeof *p->v, err)) return -1;
    p->v[p->nv++] = x;
    return 0;
}

int fl_surface_triangle(fl_part *p, int32_t a, int32_t b, int32_t c, fl_err *err)
{
    if (fl_grow(&p->t, &p->t_cap, (int64_t)p->nt + 1, sizeof *p->t, err)) return -1;
    p->t[p->nt++] = (fl_tri){{a, b, c}};
    return 0;
}

int fl_surface_cone(fl_part *p, fl_cone c, fl_err *err)
{
    if (fl_grow(&p->cone, &p->c_cap, (int64_t)p->nc + 1, sizeof *p->cone, err)) return -1;
    p->cone[p->nc++] = c;
    return 0;
}

/* A disc of radius r and unit normal a extends r sqrt(1 - a_k^2) along axis k. */
fl_aabb fl_cone_aabb(const fl_cone *c)
{
    const fl_vec3 a = v3_unit(v3_sub(c->p1, c->p0));
    const fl_vec3 reach = v3(hypot(a.y, a.z), hypot(a.z, a.x), hypot(a.x, a.y));
    fl_aabb b = aabb_empty();
    b = aabb_add(aabb_add(b, v3_madd(c->p0, -c->r0, reach)), v3_madd(c->p0, c->r0, reach));
    return aabb_add(aabb_add(b, v3_madd(c->p1, -c->r1, reach)), v3_madd(c->p1, c->r1, reach));
}

/* Same as aabb_add(), without calls to the C library: millions of corners pass through here. */
static inline void extend_box(fl_aabb *b, fl_vec3 x)
{
    b->lo.x = x.x < b->lo.x ? x.x : b->lo.x;
    b->lo.y = x.y < b->lo.y ? x.y : b->lo.y;
    b->lo.z = x.z < b->lo.z ? x.z : b->lo.z;
    b->hi.x = x.x > b->hi.x ? x.x : b->hi.x;
    b->hi.y = x.y > b->hi.y ? x.y : b->hi.y;
    b->hi.z = x.z > b->hi.z ? x.z : b->hi.z;
}

fl_aabb fl_part_aabb(const fl_part *p)
{
    fl_aabb b = aabb_empty();
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 0; k < 3; k++) extend_box(&b, p->v[p->t[t].v[k]]);
    for (int32_t c = 0; c < p->nc; c++) b = aabb_join(b, fl_cone_aabb(&p->cone[c]));
    return b;
}

fl_aabb fl_surface_aabb(const fl_surface *s)
{
    fl_aabb b = aabb_empty();
    for (int32_t i = 0; i < s->n; i++) {
        const fl_aabb part = fl_part_aabb(&s->part[i]);
        if (part.lo.x <= part.hi.x) b = aabb_join(b, part);
    }
    return b;
}

void fl_part_free(fl_part *p)
{
    free(p->name);
    free(p->v);
    free(p->t);
    free(p->cone);
    *p = (fl_part){0};
}

void fl_surface_free(fl_surface *s)
{
    for (int32_t i = 0; i < s->n; i++) fl_part_free(&s->part[i]);
    free(s->part);
    free(s->history);
    fl_string_table_free(&s->given_names);
    free(s->given_index);
    free(s->next_suffix);
    *s = (fl_surface){0};
}
