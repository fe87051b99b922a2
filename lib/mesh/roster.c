/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/mem.h"
#include "mesh/roster.h"

void fl_roster_free(fl_roster *r)
{
    fl_names_free(&r->key);
    fl_names_free(&r->words);
    free(r->set);
    free(r->entry);
    free(r->place);
    *r = (fl_roster){0};
}

enum { KEY = FL_ROSTER_NAME + 16, DEEPEST = 1000 };

/* "12ENAME": room, kind and the name in upper case. */
static void key_of(char key[KEY], enum fl_roster_kind kind, int32_t room, const char *name)
{
    int k = snprintf(key, KEY, "%d%c", room, kind);
    for (int i = 0; name[i] && i < FL_ROSTER_NAME - 1; i++) key[k++] = (char)toupper((unsigned char)name[i]);
    key[k] = '\0';
}

int32_t fl_roster_set_of(fl_roster *r, enum fl_roster_kind kind, int32_t room, const char *name, fl_err *err)
{
    const int32_t had = r->key.n;
    char key[KEY];
    int32_t shown, k = -1;
    key_of(key, kind, room, name);
    if (fl_grow(&r->set, &r->set_cap, (int64_t)had + 1, sizeof *r->set, err) == 0 &&
        (shown = fl_names_add(&r->words, name, err)) >= 0 && (k = fl_names_add(&r->key, key, err)) == had)
        r->set[k] =
            (fl_roster_set){.shown = shown, .room = room, .head = -1, .tail = -1, .kind = (int8_t)kind};
    return k;
}

int fl_roster_add(fl_roster *r, int32_t set, fl_entry entry, fl_err *err)
{
    fl_roster_set *s = &r->set[set];
    fl_entry *last = s->tail >= 0 ? &r->entry[s->tail] : NULL;
    s->own |= !entry.implied;
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

int32_t fl_roster_place(fl_roster *r, fl_place place, fl_err *err)
{
    if (fl_grow(&r->place, &r->place_cap, (int64_t)r->places + 1, sizeof *r->place, err)) return -1;
    r->place[r->places] = place;
    return r->places++;
}

static int same_word(const char *a, const char *b, size_t n)
{
    for (size_t k = 0; k < n; k++)
        if (toupper((unsigned char)a[k]) != toupper((unsigned char)b[k])) return 0;
    return b[n] == '\0';
}

static int32_t place_called(const fl_roster *r, const char *name, size_t n)
{
    for (int32_t k = 1; k < r->places; k++)
        if (strlen(r->words.name[r->place[k].name]) == n &&
            same_word(name, r->words.name[r->place[k].name], n))
            return k;
    return -1;
}

int32_t fl_roster_find_place(const fl_roster *r, const char *name)
{
    return place_called(r, name, strlen(name));
}

static int32_t find_in(const fl_roster *r, enum fl_roster_kind kind, int32_t room, const char *name)
{
    char key[KEY];
    key_of(key, kind, room, name);
    return room < 0 ? -1 : fl_names_find(&r->key, key);
}

int32_t fl_roster_find(const fl_roster *r, enum fl_roster_kind kind, int32_t *place, const char *name)
{
    const fl_place *p = &r->place[*place];
    const char *dot;
    int32_t k = find_in(r, kind, p->room, name);
    if (k < 0) k = find_in(r, kind, p->part, name);
    if (k >= 0 || *place != 0) return k;
    for (dot = strchr(name, '.'); dot && k < 0; dot = strchr(dot + 1, '.')) {
        int32_t at = place_called(r, name, (size_t)(dot - name));
        if (at < 0) continue;
        k = fl_roster_find(r, kind, &at, dot + 1);
        if (k >= 0) *place = at;
    }
    return k;
}

/* --- walking -------------------------------------------------------------------------------------------- */

typedef struct {
    fl_roster *r;
    const fl_elements *e;
    fl_roster_each *each;
    void *context;
} walk;

/* A face that the set named inside an entry is asked for, or that of the entry itself. */
static fl_pick pick_of(const fl_entry *n, const fl_entry *above)
{
    const fl_entry *f = above ? above : n;
    return (fl_pick){.face = f->face, .behind = f->behind};
}

static int numbers(const walk *w, const fl_entry *n, const fl_place *p, fl_pick pick, fl_err *err)
{
    const fl_elements *e = w->e;
    if (n->step == 0) {
        for (int64_t k = n->first; k <= n->last; k++) {
            pick.element = (int32_t)(p->part >= 0 ? k - p->from + p->to : k);
            if (w->each(w->context, pick, err)) return -1;
        }
        return 0;
    }
    if ((n->last - n->first) / n->step < e->number.n) {
        for (int64_t id = n->first; id <= n->last; id += n->step) {
            pick.element = fl_numbers_find(&e->number, p->room, id);
            if (pick.element >= 0 && w->each(w->context, pick, err)) return -1;
        }
        return 0;
    }
    for (int32_t k = 0; k < e->number.n; k++) { /* fewer elements than numbers */
        const int64_t id = e->number.id[k];
        pick.element = k;
        if (e->number.scope[k] == p->room && id >= n->first && id <= n->last &&
            (id - n->first) % n->step == 0 && w->each(w->context, pick, err))
            return -1;
    }
    return 0;
}

/* Sets that name sets many times over take no time: a set that was met under the same entry of a surface is
 * done, and so is a surface that was met in the same walk.
 *   above   the entry that asks for this set with a face of its own, NULL for none */
static int visit(const walk *w, int32_t set, int32_t place, const fl_entry *above, int depth, fl_err *err)
{
    fl_roster *r = w->r;
    fl_roster_set *s = &r->set[set];
    const int surface = s->kind == FL_ROSTER_SURFACE;
    if (s->stamp == (surface ? r->walk : r->stamp) && s->stamp_place == place) return 0;
    s->stamp = surface ? r->walk : r->stamp;
    s->stamp_place = place;
    s->open = 1;
    for (int32_t k = s->head; k >= 0; k = r->entry[k].next) {
        const fl_entry *n = &r->entry[k];
        int32_t at = n->place >= 0 ? n->place : place, inner;
        if (n->set < 0) {
            /* runs of a part are of the part's store; what the instance adds itself is in that of the place
             */
            fl_place p = r->place[at];
            if (s->room == p.room) p.part = -1;
            if (numbers(w, n, &p, pick_of(n, above), err)) return -1;
            continue;
        }
        inner = fl_roster_find(r, (enum fl_roster_kind)n->kind, &at, r->words.name[n->set]);
        if (inner < 0)
            return fl_elements_fail(w->e, n->file, n->line, err,
                                    "\"%.60s\" wants \"%.60s\", which is defined nowhere",
                                    r->words.name[s->shown], r->words.name[n->set]);
        if (r->set[inner].open)
            return fl_elements_fail(w->e, n->file, n->line, err, "\"%.60s\" contains itself",
                                    r->words.name[r->set[inner].shown]);
        if (depth == DEEPEST)
            return fl_elements_fail(w->e, n->file, n->line, err, "sets are named by sets more than %d deep",
                                    DEEPEST);
        if (surface) r->stamp++; /* each line of a surface has its face */
        if (visit(w, inner, at, surface && n->kind == FL_ROSTER_SET ? n : above, depth + 1, err)) return -1;
    }
    s->open = 0;
    return 0;
}

int fl_roster_walk(fl_roster *r, const fl_elements *e, int32_t set, int32_t place, fl_roster_each *each,
                   void *context, fl_err *err)
{
    const walk w = {r, e, each, context};
    r->walk = ++r->stamp;
    return visit(&w, set, place, NULL, 0, err);
}

/* --- telling -------------------------------------------------------------------------------------------- */

typedef struct {
    fl_elements *e;
    int32_t set;
} picking;

static int pick_one(void *context, fl_pick pick, fl_err *err)
{
    const picking *p = context;
    pick.set = p->set;
    return fl_elements_pick(p->e, pick, err);
}

static int tell_one(fl_roster *r, int32_t set, int32_t place, fl_elements *e, fl_wish *w, fl_err *err)
{
    const char *own = r->words.name[r->set[set].shown];
    char name[2 * FL_ROSTER_NAME];
    picking p = {e, -1};
    int wanted = 0;
    if (place > 0)
        snprintf(name, sizeof name, "%.*s.%.*s", FL_ROSTER_NAME - 1, r->words.name[r->place[place].name],
                 FL_ROSTER_NAME - 1, own);
    else snprintf(name, sizeof name, "%.*s", FL_ROSTER_NAME - 1, own);
    p.set = fl_names_add(&e->sets, name, err);
    if (p.set < 0) return -1;
    if (fl_wish_chooses(w)) wanted = fl_wish_takes(w, name, err);
    if (wanted < 0) return -1;
    return wanted ? fl_roster_walk(r, e, set, place, pick_one, &p, err) : 0;
}

int fl_roster_tell(fl_roster *r, fl_elements *e, fl_wish *w, fl_err *err)
{
    for (int32_t k = 0; k < r->key.n; k++)
        for (int32_t at = 0; r->set[k].own && at < r->places; at++)
            if ((r->place[at].room == r->set[k].room || r->place[at].part == r->set[k].room) &&
                tell_one(r, k, at, e, w, err))
                return -1;
    return 0;
}
