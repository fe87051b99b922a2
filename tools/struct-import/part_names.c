/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "part_names.h"
#include "mesh/merge_cylinders.h"

int selection_start(struct selection *c, const struct options *o, fl_err *err)
{
    *c = (struct selection){.opt = {.pattern = o->part,
                                    .patterns = o->parts,
                                    .has_unit = o->unit != NULL,
                                    .subdivide = o->subdivide}};
    c->opt.available = &c->available;
    c->opt.matched = fl_alloc(o->parts, 1, err);
    return c->opt.matched ? 0 : -1;
}

void selection_free(struct selection *c)
{
    fl_string_table_free(&c->available);
    free(c->opt.matched);
    *c = (struct selection){0};
}

/* A list like "a, b, c, ...", as long as a message allows. */
static void add_name(char text[300], const char *name)
{
    const size_t len = strlen(text), more = strlen(name) + 2;
    if (len + more + 8 < 300) sprintf(text + len, "%s%s", len ? ", " : "", name);
    else if (len < 4 || strcmp(text + len - 3, "...") != 0) strcpy(text + len, ", ...");
}

int selection_check(const struct selection *c, fl_err *err)
{
    char names[300] = "";
    for (int32_t k = 0; k < c->available.n; k++) add_name(names, c->available.name[k]);
    for (int32_t k = 0; k < c->opt.patterns; k++)
        if (!c->opt.matched[k])
            return fl_fail(err, FL_INPUT, "--part %.100s: no part or set matches; there are %s",
                           c->opt.pattern[k], names[0] ? names : "none");
    return 0;
}

/* Append q to p. */
static int append_part(fl_part *p, const fl_part *q, fl_err *err)
{
    const int32_t had = p->nv;
    if ((int64_t)p->nv + q->nv > INT32_MAX || (int64_t)p->nt + q->nt > INT32_MAX)
        return fl_fail(err, FL_SYSTEM, "part \"%.60s\": more than %d vertices or triangles", p->name,
                       INT32_MAX);
    for (int32_t v = 0; v < q->nv; v++)
        if (fl_surface_vertex(p, q->v[v], err)) return -1;
    for (int32_t t = 0; t < q->nt; t++) {
        const int32_t *c = q->t[t].v;
        if (fl_surface_triangle(p, had + c[0], had + c[1], had + c[2], err)) return -1;
    }
    for (int32_t c = 0; c < q->nc; c++)
        if (fl_surface_cone(p, q->cone[c], err)) return -1;
    return 0;
}

static const struct alias *alias_of(const struct options *o, const char *name)
{
    for (int32_t k = 0; k < o->aliases; k++)
        if (fl_pattern_matches(o->alias[k].old, name)) return &o->alias[k];
    return NULL;
}

static int check_patterns(const struct options *o, const fl_surface *s, fl_err *err)
{
    char names[300] = "";
    for (int32_t i = 0; i < s->n; i++) add_name(names, s->part[i].name);
    for (int32_t k = 0; k < o->aliases; k++) {
        int matched = 0;
        for (int32_t i = 0; !matched && i < s->n; i++)
            matched = fl_pattern_matches(o->alias[k].old, s->part[i].name);
        if (!matched)
            return fl_fail(err, FL_INPUT, "--rename %.100s: no part matches; there are %s", o->alias[k].text,
                           names[0] ? names : "none");
    }
    return 0;
}

int rename_all(const struct options *o, fl_surface *s, fl_err *err)
{
    fl_surface to = {0};
    fl_merged_cylinders merged = {0};
    int rc = -1;
    if (o->aliases == 0) return 0;
    if (check_patterns(o, s, err)) return -1;
    for (int32_t i = 0; i < s->n; i++) {
        const struct alias *a = alias_of(o, s->part[i].name);
        const char *name = a ? a->name : s->part[i].name;
        int32_t at = fl_surface_find(&to, name, strlen(name));
        if (at >= 0) {
            if (append_part(&to.part[at], &s->part[i], err)) goto done;
            fl_part_free(&s->part[i]);
            continue;
        }
        at = fl_surface_add(&to, name, strlen(name), err);
        if (at < 0) goto done;
        free(s->part[i].name);
        s->part[i].name = to.part[at].name;
        to.part[at] = s->part[i];
        s->part[i] = (fl_part){0};
    }
    /* a leg that came as several parts is one cylinder again */
    for (int32_t i = 0; i < to.n && to.n < s->n; i++)
        if (fl_part_merge_cylinders(&to.part[i], &merged, err)) goto done;
    to.history = s->history;
    s->history = NULL;
    fl_surface_free(s);
    *s = to;
    to = (fl_surface){0};
    rc = 0;
done:
    fl_surface_free(&to);
    return rc;
}
