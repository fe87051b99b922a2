/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <omp.h>
#include <string.h>
#include "base/mem.h"
#include "step/awake.h"
#include "contact/pair_store.h"
#include "step/interact.h"
#include "step/stance.h"
#include "step/told.h"
#include "world/access.h"

/* So many near pairs are taken at a time, of which one or so is awake; and where somebody may sleep.
 *
 * Tried and left: to fetch what the pairs to come need (contact, list, cores, 5 KB each) while the present
 * one is computed.  With 2 000, 20 000 and, when a contact took 5 us in place of 6, 100 000 floes it changed
 * the time of contacts by less than 0.5 %. */
enum { BLOCK = 16, MANY = 64 };

void fl_awake_share(fl_world *w)
{
    const int64_t live = w->n_live;
    const int32_t team = w->team.n;
    for (int32_t t = 0; t < team; t++) {
        w->share[t].next = t == 0     ? 0
                           : live > 0 ? w->live[live * t / team]
                                      : (int32_t)((int64_t)w->n_pair * t / team);
        if (t > 0) w->share[t - 1].end = w->share[t].next;
    }
    w->share[team - 1].end = w->n_pair;
    memset(w->met, 0, (size_t)w->b.total);
}

/* Several threads may have a body in hand, and a wall most of the time. */
static void meet(uint8_t *met)
{
    uint8_t has;
#pragma omp atomic read
    has = *met;
    if (has) return;
#pragma omp atomic write
    *met = 1;
}

/* Contacts that may be told of, until there are enough for all lanes. */
typedef struct {
    fl_pair *pair[FL_TOLD];
    int n;
} carried;

/* What one thread has in hand. */
typedef struct {
    carried told;
    int32_t thread;
    double dt;
    int survey;
} hand;

void fl_near_awake(fl_world *w, int32_t c, int32_t thread, const fl_told *t, double dt, int survey)
{
    fl_near *q = &w->pair[c];
    fl_pair made, *p = q->full;
    if (fl_stance_apart(w, q)) {
        if (p) fl_near_keep(w, q, p); /* what has no room of its own needs none */
        return;
    }
    if (!p) fl_near_pair(w, q, p = &made);
    p->at = c;
    fl_interact_look(w, p, thread, t, dt, survey);
    if (fl_near_keep(w, q, p)) {
#pragma omp atomic write
        w->failed = 1;
    }
}

static void by_look(fl_world *w, const hand *h, int32_t c, const fl_told *t)
{
    const fl_near *const p = &w->pair[c];
    fl_near_awake(w, c, h->thread, t, h->dt, h->survey);
    fl_world_watch(w, c);
    w->hit[c] = p->n;
    if (p->n) meet(&w->met[p->i]), meet(&w->met[p->j]);
}

/* Tell of those in hand, and look at those that have gone too far for it. */
static void tell(fl_world *w, hand *h)
{
    carried *const q = &h->told;
    uint8_t done[FL_TOLD];
    fl_told t[FL_TOLD];
    if (q->n) fl_told_touch(w, q->pair, q->n, h->dt, h->survey, done, t);
    for (int k = 0; k < q->n; k++) {
        const fl_pair *const p = q->pair[k];
        if (!done[k]) by_look(w, h, p->at, &t[k]);
        else w->told[h->thread].told++, meet(&w->met[p->i]), meet(&w->met[p->j]);
    }
    q->n = 0;
}

/* Pair c is due.  Contacts that may be told of are gathered. */
static void look_at(fl_world *w, hand *h, int32_t c)
{
    const fl_near *const p = &w->pair[c];
    if (fl_sleep_frozen(w, p)) {
        meet(&w->met[p->i]), meet(&w->met[p->j]); /* forces stay */
    } else if (p->full && fl_told_of(w, p->full)) {
        p->full->at = c;
        h->told.pair[h->told.n++] = p->full;
        if (h->told.n == FL_TOLD) tell(w, h);
    } else {
        by_look(w, h, c, NULL);
    }
}

/* Others are apart, and did not touch before. */
static void look(fl_world *w, hand *h, int32_t from, int32_t to)
{
    for (int32_t c = from; c < to; c++)
        if (!fl_world_apart(w, c)) look_at(w, h, c);
}

/* Where somebody may sleep it is known who is due: eight that are not are passed over at a time. */
static void look_due(fl_world *w, hand *h, int32_t from, int32_t to)
{
    uint8_t *const due = w->sleep.due;
    for (int32_t c = from; c < to;) {
        uint64_t eight = 1;
        if (c + 8 <= to) memcpy(&eight, &due[c], sizeof eight);
        const int32_t end = eight == 0 || c + 8 <= to ? c + 8 : to;
        for (; eight && c < end; c++) {
            if (!due[c]) continue;
            due[c] = 0;
            look_at(w, h, c);
        }
        c = end;
    }
}

void fl_awake_look(fl_world *w, double dt, int survey)
{
    const int32_t thread = omp_get_thread_num();
    hand h; /* large: not cleared */
    const int32_t block = w->sleep.nap ? MANY : BLOCK;
    h.thread = thread, h.dt = dt, h.survey = survey, h.told.n = 0;
    for (int32_t k = 0; k < w->team.n; k++) {
        fl_portion *const s = &w->share[(thread + k) % w->team.n];
        for (int32_t c = fl_portion_take(s, block); c < s->end; c = fl_portion_take(s, block))
            (w->sleep.nap ? look_due : look)(w, &h, c, s->end < c + block ? s->end : c + block);
    }
    tell(w, &h);
}

/* Few touch: eight are passed over at a time. */
void fl_awake_told(fl_world *w)
{
    const uint8_t *const hit = w->hit;
    const int32_t all = w->n_pair;
    int32_t n = 0, c = 0;
    for (; c + 8 <= all; c += 8) {
        uint64_t eight;
        memcpy(&eight, &hit[c], sizeof eight);
        if (eight == 0) continue;
        if (fl_room(&w->live, &w->live_cap, (int64_t)n + 8, sizeof *w->live)) break;
        for (int32_t k = c; k < c + 8; k++) {
            w->live[n] = k;
            n += hit[k];
        }
    }
    for (; c < all; c++) {
        if (!hit[c]) continue;
        if (fl_room(&w->live, &w->live_cap, (int64_t)n + 1, sizeof *w->live)) {
            w->failed = 1;
            break;
        }
        w->live[n++] = c;
    }
    w->n_live = n;
}
