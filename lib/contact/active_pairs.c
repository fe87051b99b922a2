/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <omp.h>
#include <string.h>
#include "base/array.h"
#include "contact/active_pairs.h"
#include "contact/pair_store.h"
#include "contact/pair_force.h"
#include "contact/pair_geometry.h"
#include "contact/surrogate_batch.h"
#include "world/access.h"

/* So many near pairs are taken at a time, of which one or so is awake; and where somebody may sleep.
 *
 * Tried and left: to fetch what the pairs to come need (contact, list, cores, 5 KB each) while the present
 * one is computed.  With 2 000, 20 000 and, when a contact took 5 us in place of 6, 100 000 floes it changed
 * the time of contacts by less than 0.5 %. */
enum { BLOCK = 16, MANY = 64 };

void fl_share_active_pairs(fl_world *w)
{
    const int64_t live = w->n_touching;
    const int32_t team = w->team.n;
    for (int32_t t = 0; t < team; t++) {
        w->pair_share[t].next = t == 0     ? 0
                                : live > 0 ? w->touching_pairs[live * t / team]
                                           : (int32_t)((int64_t)w->n_pair * t / team);
        if (t > 0) w->pair_share[t - 1].end = w->pair_share[t].next;
    }
    w->pair_share[team - 1].end = w->n_pair;
    memset(w->body_touches, 0, (size_t)w->b.total);
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
    fl_pair *pair[FL_SURROGATE_BATCH];
    int n;
} carried;

/* What one thread has in hand. */
typedef struct {
    carried told;
    int32_t thread;
    double dt;
    int survey;
} hand;

void fl_evaluate_neighbour_pair(fl_world *w, int32_t c, int32_t thread, const fl_surrogate_value *t,
                                double dt, int survey)
{
    fl_neighbour_pair *q = &w->pair[c];
    fl_pair made, *p = q->contact;
    if (fl_pair_still_apart(w, q)) {
        if (p) fl_neighbour_pair_store(w, q, p); /* what has no room of its own needs none */
        return;
    }
    if (!p) fl_neighbour_pair_expand(w, q, p = &made);
    p->index = c;
    fl_pair_evaluate_exact(w, p, thread, t, dt, survey);
    if (fl_neighbour_pair_store(w, q, p)) {
#pragma omp atomic write
        w->failed = 1;
    }
}

static void by_look(fl_world *w, const hand *h, int32_t c, const fl_surrogate_value *t)
{
    const fl_neighbour_pair *const p = &w->pair[c];
    fl_evaluate_neighbour_pair(w, c, h->thread, t, h->dt, h->survey);
    fl_set_next_check(w, c);
    w->pair_touches[c] = p->touching;
    if (p->touching) meet(&w->body_touches[p->i]), meet(&w->body_touches[p->j]);
}

/* Tell of those in hand, and look at those that have gone too far for it. */
static void tell(fl_world *w, hand *h)
{
    carried *const q = &h->told;
    uint8_t done[FL_SURROGATE_BATCH];
    fl_surrogate_value t[FL_SURROGATE_BATCH];
    if (q->n) fl_surrogate_batch_evaluate(w, q->pair, q->n, h->dt, h->survey, done, t);
    for (int k = 0; k < q->n; k++) {
        const fl_pair *const p = q->pair[k];
        if (!done[k]) by_look(w, h, p->index, &t[k]);
        else
            w->surrogate_counts[h->thread].hits++, meet(&w->body_touches[p->i]), meet(&w->body_touches[p->j]);
    }
    q->n = 0;
}

/* Pair c is due.  Contacts that may be told of are gathered. */
static void look_at(fl_world *w, hand *h, int32_t c)
{
    const fl_neighbour_pair *const p = &w->pair[c];
    if (fl_pair_is_resting(w, p)) {
        meet(&w->body_touches[p->i]), meet(&w->body_touches[p->j]); /* forces stay */
    } else if (p->contact && fl_surrogate_applies(w, p->contact)) {
        p->contact->index = c;
        h->told.pair[h->told.n++] = p->contact;
        if (h->told.n == FL_SURROGATE_BATCH) tell(w, h);
    } else {
        by_look(w, h, c, NULL);
    }
}

/* Others are apart, and did not touch before. */
static void look(fl_world *w, hand *h, int32_t from, int32_t to)
{
    for (int32_t c = from; c < to; c++)
        if (!fl_next_check_pending(w, c)) look_at(w, h, c);
}

/* Where somebody may sleep it is known who is due: eight that are not are passed over at a time. */
static void look_due(fl_world *w, hand *h, int32_t from, int32_t to)
{
    uint8_t *const due = w->sleep.pair_due;
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

void fl_evaluate_active_pairs(fl_world *w, double dt, int survey)
{
    const int32_t thread = omp_get_thread_num();
    hand h; /* large: not cleared */
    const int32_t block = w->sleep.state ? MANY : BLOCK;
    h.thread = thread, h.dt = dt, h.survey = survey, h.told.n = 0;
    for (int32_t k = 0; k < w->team.n; k++) {
        fl_work_share *const s = &w->pair_share[(thread + k) % w->team.n];
        for (int32_t c = fl_work_share_take(s, block); c < s->end; c = fl_work_share_take(s, block))
            (w->sleep.state ? look_due : look)(w, &h, c, s->end < c + block ? s->end : c + block);
    }
    tell(w, &h);
}

/* Few touch: eight are passed over at a time. */
void fl_collect_touching(fl_world *w)
{
    const uint8_t *const hit = w->pair_touches;
    const int32_t all = w->n_pair;
    int32_t n = 0, c = 0;
    for (; c + 8 <= all; c += 8) {
        uint64_t eight;
        memcpy(&eight, &hit[c], sizeof eight);
        if (eight == 0) continue;
        if (fl_reserve(&w->touching_pairs, &w->touching_pairs_cap, (int64_t)n + 8, sizeof *w->touching_pairs))
            break;
        for (int32_t k = c; k < c + 8; k++) {
            w->touching_pairs[n] = k;
            n += hit[k];
        }
    }
    for (; c < all; c++) {
        if (!hit[c]) continue;
        if (fl_reserve(&w->touching_pairs, &w->touching_pairs_cap, (int64_t)n + 1,
                       sizeof *w->touching_pairs)) {
            w->failed = 1;
            break;
        }
        w->touching_pairs[n++] = c;
    }
    w->n_touching = n;
}
