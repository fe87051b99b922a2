/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "mesh/element_sets.h"

void fl_element_sets_free(fl_element_sets *r)
{
    fl_string_table_free(&r->key);
    fl_string_table_free(&r->words);
    free(r->set);
    free(r->entry);
    free(r->instance);
    *r = (fl_element_sets){0};
}

enum { KEY_MAX = FL_SET_NAME_MAX + 16, MAX_DEPTH = 1000 };

/* "12ENAME": scope, kind and the name in upper case. */
static void make_key(char key[KEY_MAX], enum fl_set_kind kind, int32_t room, const char *name)
{
    int k = snprintf(key, KEY_MAX, "%d%c", room, kind);
    for (int i = 0; name[i] && i < FL_SET_NAME_MAX - 1; i++) key[k++] = (char)toupper((unsigned char)name[i]);
    key[k] = '\0';
}

int32_t fl_element_sets_get(fl_element_sets *r, enum fl_set_kind kind, int32_t room, const char *name,
                            fl_err *err)
{
    const int32_t had = r->key.n;
    char key[KEY_MAX];
    int32_t shown, k = -1;
    make_key(key, kind, room, name);
    if (fl_grow(&r->set, &r->set_cap, (int64_t)had + 1, sizeof *r->set, err) == 0 &&
        (shown = fl_string_table_add(&r->words, name, err)) >= 0 &&
        (k = fl_string_table_add(&r->key, key, err)) == had)
        r->set[k] =
            (fl_element_set){.name = shown, .scope = room, .head = -1, .tail = -1, .kind = (int8_t)kind};
    return k;
}

int fl_element_sets_add_entry(fl_element_sets *r, int32_t set, fl_set_entry entry, fl_err *err)
{
    fl_element_set *s = &r->set[set];
    fl_set_entry *last = s->tail >= 0 ? &r->entry[s->tail] : NULL;
    s->is_explicit |= !entry.implied;
    if (last && entry.set < 0 && entry.step == 0 && last->set < 0 && last->step == 0 &&
        last->last + 1 == entry.first && last->face == entry.face && last->implied == entry.implied) {
        last->last = entry.last;
        return 0;
    }
    if (fl_grow(&r->entry, &r->entry_cap, (int64_t)r->entries + 1, sizeof *r->entry, err)) return -1;
    entry.next = -1;
    r->entry[r->entries] = entry;
    if (s->tail >= 0) r->entry[s->tail].next = r->entries;
    else s->head = r->entries;
    s->tail = r->entries++;
    return 0;
}

int32_t fl_element_sets_add_instance(fl_element_sets *r, fl_instance place, fl_err *err)
{
    if (fl_grow(&r->instance, &r->instance_cap, (int64_t)r->instances + 1, sizeof *r->instance, err))
        return -1;
    r->instance[r->instances] = place;
    return r->instances++;
}

static int equals_no_case(const char *a, const char *b, size_t n)
{
    for (size_t k = 0; k < n; k++)
        if (toupper((unsigned char)a[k]) != toupper((unsigned char)b[k])) return 0;
    return b[n] == '\0';
}

static int32_t find_instance(const fl_element_sets *r, const char *name, size_t n)
{
    for (int32_t k = 1; k < r->instances; k++)
        if (strlen(r->words.name[r->instance[k].name]) == n &&
            equals_no_case(name, r->words.name[r->instance[k].name], n))
            return k;
    return -1;
}

int32_t fl_element_sets_find_instance(const fl_element_sets *r, const char *name)
{
    return find_instance(r, name, strlen(name));
}

static int32_t find_in_scope(const fl_element_sets *r, enum fl_set_kind kind, int32_t room, const char *name)
{
    char key[KEY_MAX];
    make_key(key, kind, room, name);
    return room < 0 ? -1 : fl_string_table_find(&r->key, key);
}

int32_t fl_element_sets_find(const fl_element_sets *r, enum fl_set_kind kind, int32_t *place,
                             const char *name)
{
    const fl_instance *p = &r->instance[*place];
    const char *dot;
    int32_t k = find_in_scope(r, kind, p->scope, name);
    if (k < 0) k = find_in_scope(r, kind, p->part_scope, name);
    if (k >= 0 || *place != 0) return k;
    for (dot = strchr(name, '.'); dot && k < 0; dot = strchr(dot + 1, '.')) {
        int32_t at = find_instance(r, name, (size_t)(dot - name));
        if (at < 0) continue;
        k = fl_element_sets_find(r, kind, &at, dot + 1);
        if (k >= 0) *place = at;
    }
    return k;
}

/* --- visits --------------------------------------------------------------------------------------------- */

typedef struct {
    fl_element_sets *r;
    const fl_elements *e;
    fl_element_visitor *each;
    void *context;
} visit_context;

/* The face that the surface entry `above` asks for, or that of the entry itself. */
static fl_pick pick_of(const fl_set_entry *n, const fl_set_entry *above)
{
    const fl_set_entry *f = above ? above : n;
    return (fl_pick){.face = f->face, .reversed = f->reversed};
}

static int visit_numbers(const visit_context *w, const fl_set_entry *n, const fl_instance *p, fl_pick pick,
                         fl_err *err)
{
    const fl_elements *e = w->e;
    if (n->step == 0) {
        for (int64_t k = n->first; k <= n->last; k++) {
            pick.element = (int32_t)(p->part_scope >= 0 ? k - p->part_first + p->mesh_first : k);
            if (w->each(w->context, pick, err)) return -1;
        }
        return 0;
    }
    if ((n->last - n->first) / n->step < e->element_id.n) {
        for (int64_t id = n->first; id <= n->last; id += n->step) {
            pick.element = fl_id_map_find(&e->element_id, p->scope, id);
            if (pick.element >= 0 && w->each(w->context, pick, err)) return -1;
        }
        return 0;
    }
    for (int32_t k = 0; k < e->element_id.n;
         k++) { /* faster where the mesh has fewer elements than the range */
        const int64_t id = e->element_id.id[k];
        pick.element = k;
        if (e->element_id.scope[k] == p->scope && id >= n->first && id <= n->last &&
            (id - n->first) % n->step == 0 && w->each(w->context, pick, err))
            return -1;
    }
    return 0;
}

/* Visit the elements of a set.  Sets that repeat one another cost no time: a set is visited once for each
 * entry of a surface, a surface once for each visit.
 *   above   the entry of a surface that asks for this set with a face of its own, NULL for none */
static int visit_set(const visit_context *w, int32_t set, int32_t place, const fl_set_entry *above, int depth,
                     fl_err *err)
{
    fl_element_sets *r = w->r;
    fl_element_set *s = &r->set[set];
    const int surface = s->kind == FL_SET_SURFACE;
    if (s->stamp == (surface ? r->surface_stamp : r->stamp) && s->stamp_instance == place) return 0;
    s->stamp = surface ? r->surface_stamp : r->stamp;
    s->stamp_instance = place;
    s->visiting = 1;
    for (int32_t k = s->head; k >= 0; k = r->entry[k].next) {
        const fl_set_entry *n = &r->entry[k];
        int32_t at = n->instance >= 0 ? n->instance : place, inner;
        if (n->set < 0) {
            /* indices of a part refer to the part store; elements that the instance adds itself are in its
             * own */
            fl_instance p = r->instance[at];
            if (s->scope == p.scope) p.part_scope = -1;
            if (visit_numbers(w, n, &p, pick_of(n, above), err)) return -1;
            continue;
        }
        inner = fl_element_sets_find(r, (enum fl_set_kind)n->kind, &at, r->words.name[n->set]);
        if (inner < 0)
            return fl_elements_fail(w->e, n->file, n->line, err,
                                    "\"%.60s\" refers to \"%.60s\", which is not defined",
                                    r->words.name[s->name], r->words.name[n->set]);
        if (r->set[inner].visiting)
            return fl_elements_fail(w->e, n->file, n->line, err, "\"%.60s\" contains itself",
                                    r->words.name[r->set[inner].name]);
        if (depth == MAX_DEPTH)
            return fl_elements_fail(w->e, n->file, n->line, err, "sets are named by sets more than %d deep",
                                    MAX_DEPTH);
        if (surface) r->stamp++; /* each entry of a surface has its own face */
        if (visit_set(w, inner, at, surface && n->kind == FL_SET_ELEMENTS ? n : above, depth + 1, err))
            return -1;
    }
    s->visiting = 0;
    return 0;
}

int fl_element_sets_visit(fl_element_sets *r, const fl_elements *e, int32_t set, int32_t place,
                          fl_element_visitor *each, void *context, fl_err *err)
{
    const visit_context w = {r, e, each, context};
    r->surface_stamp = ++r->stamp;
    return visit_set(&w, set, place, NULL, 0, err);
}

/* --- export --------------------------------------------------------------------------------------------- */

typedef struct {
    fl_elements *e;
    int32_t set;
} set_pick;

static int pick_element(void *context, fl_pick pick, fl_err *err)
{
    const set_pick *p = context;
    pick.set = p->set;
    return fl_elements_pick(p->e, pick, err);
}

static int export_set(fl_element_sets *r, int32_t set, int32_t place, fl_elements *e, fl_import_options *opt,
                      fl_err *err)
{
    const char *own = r->words.name[r->set[set].name];
    char name[2 * FL_SET_NAME_MAX];
    set_pick p = {e, -1};
    int wanted = 0;
    if (place > 0)
        snprintf(name, sizeof name, "%.*s.%.*s", FL_SET_NAME_MAX - 1, r->words.name[r->instance[place].name],
                 FL_SET_NAME_MAX - 1, own);
    else snprintf(name, sizeof name, "%.*s", FL_SET_NAME_MAX - 1, own);
    p.set = fl_string_table_add(&e->sets, name, err);
    if (p.set < 0) return -1;
    if (fl_import_by_name(opt)) wanted = fl_import_selects(opt, name, err);
    if (wanted < 0) return -1;
    return wanted ? fl_element_sets_visit(r, e, set, place, pick_element, &p, err) : 0;
}

int fl_element_sets_export(fl_element_sets *r, fl_elements *e, fl_import_options *opt, fl_err *err)
{
    for (int32_t k = 0; k < r->key.n; k++)
        for (int32_t at = 0; r->set[k].is_explicit && at < r->instances; at++)
            if ((r->instance[at].scope == r->set[k].scope || r->instance[at].part_scope == r->set[k].scope) &&
                export_set(r, k, at, e, opt, err))
                return -1;
    return 0;
}
