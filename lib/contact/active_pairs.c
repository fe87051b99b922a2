/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <omp.h>
#include <string.h>
#include "base/array.h"
#include "contact/active_pairs.h"
#include "contact/pair_force.h"
#include "contact/pair_gap.h"
#include "contact/pair_geometry.h"
#include "contact/pair_store.h"
#include "contact/surrogate_batch.h"
#include "world/access.h"

/* Near pairs that a thread takes at a time; about one of 16 is due.  More with sleep, where fewer are due. */
enum { PAIRS_AT_A_TIME = 16, PAIRS_AT_A_TIME_WITH_SLEEP = 64 };

void fl_share_active_pairs(fl_world *w)
{
    const int64_t touching = w->n_touching;
    const int32_t team = w->team.n;
    for (int32_t t = 0; t < team; t++) {
        w->pair_share[t].next = t == 0         ? 0
                                : touching > 0 ? w->touching_pairs[touching * t / team]
                                               : (int32_t)((int64_t)w->n_pair * t / team);
        if (t > 0) w->pair_share[t - 1].end = w->pair_share[t].next;
    }
    w->pair_share[team - 1].end = w->n_pair;
    memset(w->body_touches, 0, (size_t)w->b.total);
}

/* Sets a flag.  The flag of a wall is set by many threads: read before writing. */
static void set_flag(uint8_t *flag)
{
    uint8_t is_set;
#pragma omp atomic read
    is_set = *flag;
    if (is_set) return;
#pragma omp atomic write
    *flag = 1;
}

/* Contacts to be evaluated by their surrogates, gathered until they fill all lanes. */
typedef struct {
    fl_pair *pair[FL_SURROGATE_BATCH];
    int n;
} surrogate_queue;

/* Work of one thread. */
typedef struct {
    surrogate_queue queue;
    int32_t thread;
    double dt;
    int survey;
} thread_work;

void fl_evaluate_neighbour_pair(fl_world *w, int32_t c, int32_t thread, const fl_surrogate_value *t,
                                double dt, int survey)
{
    fl_neighbour_pair *q = &w->pair[c];
    fl_pair made, *p = q->contact;
    if (fl_pair_still_apart(w, q)) {
        if (p) fl_neighbour_pair_put_back(w, q, p);
        fl_pair_store_gap(w, q);
        return;
    }
    if (!p) fl_neighbour_pair_expand(w, q, p = &made);
    p->index = c;
    fl_pair_evaluate_exact(w, p, thread, t, dt, survey);
    if (fl_neighbour_pair_put_back(w, q, p)) {
#pragma omp atomic write
        w->failed = 1;
    }
    fl_pair_store_gap(w, q);
}

/* Evaluates pair c exactly and sets its flags. */
static void evaluate_exactly(fl_world *w, const thread_work *work, int32_t c, const fl_surrogate_value *t)
{
    const fl_neighbour_pair *const p = &w->pair[c];
    fl_evaluate_neighbour_pair(w, c, work->thread, t, work->dt, work->survey);
    fl_set_next_check(w, c);
    w->pair_touches[c] = p->touching;
    if (p->touching) set_flag(&w->body_touches[p->i]), set_flag(&w->body_touches[p->j]);
}

/* Evaluates the queue by surrogates, and exactly those that have moved too far. */
static void evaluate_queue(fl_world *w, thread_work *work)
{
    surrogate_queue *const q = &work->queue;
    uint8_t done[FL_SURROGATE_BATCH];
    fl_surrogate_value t[FL_SURROGATE_BATCH];
    if (q->n) fl_surrogate_batch_evaluate(w, q->pair, q->n, work->dt, work->survey, done, t);
    for (int k = 0; k < q->n; k++) {
        const fl_pair *const p = q->pair[k];
        if (!done[k]) evaluate_exactly(w, work, p->index, &t[k]);
        else
            w->surrogate_counts[work->thread].hits++, set_flag(&w->body_touches[p->i]),
                set_flag(&w->body_touches[p->j]);
    }
    q->n = 0;
}

/* Evaluates pair c, which is due, or appends it to the queue. */
static void process_pair(fl_world *w, thread_work *work, int32_t c)
{
    const fl_neighbour_pair *const p = &w->pair[c];
    if (fl_pair_is_resting(w, p)) {
        set_flag(&w->body_touches[p->i]), set_flag(&w->body_touches[p->j]); /* the forces do not change */
    } else if (p->contact && fl_surrogate_applies(w, p->contact)) {
        p->contact->index = c;
        work->queue.pair[work->queue.n++] = p->contact;
        if (work->queue.n == FL_SURROGATE_BATCH) evaluate_queue(w, work);
    } else {
        evaluate_exactly(w, work, c, NULL);
    }
}

/* Processes the due pairs of [from, to); the others did not touch and still cannot. */
static void process_range(fl_world *w, thread_work *work, int32_t from, int32_t to)
{
    for (int32_t c = from; c < to; c++)
        if (fl_pair_may_touch(w, c) && !(fl_gap_is_known(&w->pair[c].gap) && fl_pair_keeps_gap(w, c)))
            process_pair(w, work, c);
}

/* With sleep: pair_due marks the due pairs; eight unmarked ones are skipped at a time. */
static void process_flagged(fl_world *w, thread_work *work, int32_t from, int32_t to)
{
    uint8_t *const due = w->sleep.pair_due;
    for (int32_t c = from; c < to;) {
        uint64_t eight = 1;
        if (c + 8 <= to) memcpy(&eight, &due[c], sizeof eight);
        const int32_t end = eight == 0 || c + 8 <= to ? c + 8 : to;
        for (; eight && c < end; c++) {
            if (!due[c]) continue;
            due[c] = 0;
            process_pair(w, work, c);
        }
        c = end;
    }
}

void fl_evaluate_active_pairs(fl_world *w, double dt, int survey)
{
    const int32_t thread = omp_get_thread_num();
    thread_work work; /* large: not cleared */
    const int32_t pairs = w->sleep.state ? PAIRS_AT_A_TIME_WITH_SLEEP : PAIRS_AT_A_TIME;
    work.thread = thread, work.dt = dt, work.survey = survey, work.queue.n = 0;
    for (int32_t k = 0; k < w->team.n; k++) {
        fl_work_share *const s = &w->pair_share[(thread + k) % w->team.n];
        for (int32_t c = fl_work_share_take(s, pairs); c < s->end; c = fl_work_share_take(s, pairs))
            (w->sleep.state ? process_flagged : process_range)(w, &work, c,
                                                               s->end < c + pairs ? s->end : c + pairs);
    }
    evaluate_queue(w, &work);
}

/* Few pairs touch: eight that do not are skipped at a time. */
void fl_collect_touching(fl_world *w)
{
    const uint8_t *const touches = w->pair_touches;
    const int32_t all = w->n_pair;
    int32_t n = 0, c = 0;
    for (; c + 8 <= all; c += 8) {
        uint64_t eight;
        memcpy(&eight, &touches[c], sizeof eight);
        if (eight == 0) continue;
        if (fl_reserve(&w->touching_pairs, &w->touching_pairs_cap, (int64_t)n + 8, sizeof *w->touching_pairs))
            break;
        for (int32_t k = c; k < c + 8; k++) {
            w->touching_pairs[n] = k;
            n += touches[k];
        }
    }
    for (; c < all; c++) {
        if (!touches[c]) continue;
        if (fl_reserve(&w->touching_pairs, &w->touching_pairs_cap, (int64_t)n + 1,
                       sizeof *w->touching_pairs)) {
            w->failed = 1;
            break;
        }
        w->touching_pairs[n++] = c;
    }
    w->n_touching = n;
}
