/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/mem.h"
#include "body/integrate.h"
#include "step/frozen.h"
#include "step/group.h"
#include "step/works.h"

static double power(fl_vec3 f, fl_vec3 t, fl_vec3 v, fl_vec3 w) { return v3_dot(f, v) + v3_dot(t, w); }

/* Zeroed room for `want` elements where there is none for n; what is there stays.  -1 when memory runs out.
 */
static int room(void *array, int32_t *cap, int32_t n, int32_t want, size_t size)
{
    fl_err lost = {0};
    void *old;
    if (n <= *cap) return 0;
    void *const fresh = fl_alloc(want, size, &lost);
    if (!fresh) return -1;
    memcpy(&old, array, sizeof old); /* array is the address of a T*, of any T */
    if (old) memcpy(fresh, old, (size_t)*cap * size);
    free(old);
    memcpy(array, &fresh, sizeof fresh);
    *cap = want;
    return 0;
}

static int grow_gains(fl_world *w, int32_t n, int32_t want)
{
    int32_t had = w->gain_cap;
    return room(&w->lead, &had, n, want, sizeof *w->lead) ||
                   room(&w->gain, &w->gain_cap, n, want, sizeof *w->gain)
               ? -1
               : 0;
}

/* Sinks 0 to n, and gains; of some an eighth more, as they come and go. */
static int more(fl_world *w, fl_sinks *s, int32_t n)
{
    const int32_t want = n < w->b.total ? 1 + n + n / 8 : 1 + n;
    return room(&s->at, &s->cap, n + 1, want, sizeof *s->at) || grow_gains(w, n + 1, want) ? -1 : 0;
}

int fl_works_make(fl_world *w, fl_err *err)
{
    const int32_t total = w->b.total;
    w->sink.place = fl_alloc(total, sizeof *w->sink.place, err);
    w->was.place = fl_alloc(total, sizeof *w->was.place, err);
    if (!w->sink.place || !w->was.place) return -1;
    return more(w, &w->sink, 0) || more(w, &w->was, 0) ? fl_fail(err, FL_SYSTEM, "out of memory") : 0;
}

void fl_works_free(fl_world *w)
{
    free(w->sink.place), free(w->was.place), free(w->sink.at), free(w->was.at);
    free(w->gain), free(w->lead);
}

/* Those that touch, in their order; not by their pairs, which are far apart in memory.  Few do: eight that do
 * not are passed over at a time. */
static int32_t place_some(const fl_world *w, int32_t *place)
{
    const uint8_t *const met = w->met;
    const int32_t total = w->b.total;
    int32_t n = 0;
    for (int32_t k = 0; k < total;) {
        const int32_t end = k + 8 < total ? k + 8 : total;
        uint64_t eight = 1;
        if (end == k + 8) memcpy(&eight, &met[k], sizeof eight);
        if (eight == 0) memset(&place[k], 0, 8 * sizeof *place);
        for (; k < end && eight; k++) {
            n += met[k];
            place[k] = met[k] ? n : 0;
        }
        k = end;
    }
    return n;
}

static int all_have_one(const fl_world *w) { return w->frozen.n || w->sleep.resting; }

void fl_works_place(fl_world *w)
{
    fl_sinks *s = &w->sink;
    const int all = all_have_one(w);
    const int32_t total = w->b.total;
    if (all && s->all) return;
    if (more(w, s, all ? total : place_some(w, s->place))) {
        memset(s->place, 0, (size_t)total * sizeof *s->place);
        w->failed = 1;
        return;
    }
    for (int32_t k = 0; k < total && all; k++) s->place[k] = k + 1;
    if (all) memset(s->at, 0, (size_t)s->cap * sizeof *s->at);
    s->all = all;
}

void fl_works_sum(fl_world *w, int32_t k)
{
    fl_sink s = {0};
    for (int64_t c = w->inc_first[k]; c < w->inc_first[k + 1]; c++) {
        if (!w->hit[w->inc[c]]) continue;
        const fl_pair *p = w->pair[w->inc[c]].full;
        fl_works_add(&s, p, p->i == k);
    }
    if (fl_frozen_at(w, k)) fl_frozen_sink(w, k, &s);
    if (s.n) *fl_works_now(w, k) = s;
    else fl_works_clear(w, k);
}

/* The works above of spheres, those of damping and of friction; nothing presses on them but what they meet.
 */
static void take_balls(const fl_world *w, int32_t k, const fl_gain *first, const fl_gain *back, fl_works *q)
{
    const fl_ball_sum *f0 = &w->balls.was[k], *f1 = &w->balls.sum[k];
    const fl_vec3 v = w->b.v[k], spin = w->b.w[k];
    const double sixth = w->dt / 6.0;
    q->damping -= w->dt * v3_dot(f1->damping, v) +
                  sixth * (v3_dot(f1->damping, first->v) - v3_dot(f0->damping, back->v));
    q->friction -= w->dt * power(f1->friction, f1->torque, v, spin) +
                   sixth * (power(f1->friction, f1->torque, first->v, first->w) -
                            power(f0->friction, f0->torque, back->v, back->w));
}

fl_works fl_works_take(const fl_world *w, int32_t k, const fl_gain *first, const fl_gain *back)
{
    const fl_sink *f0 = fl_works_was(w, k), *f1 = fl_works_now(w, k);
    static const fl_gain none = {{0, 0, 0}, {0, 0, 0}};
    fl_works q = {0};
    if (!first) first = &none;
    if (f1->n) {
        const fl_vec3 v = w->b.v[k], spin = w->b.w[k];
        q.damping -= w->dt * power(f1->damping, f1->damping_turn, v, spin);
        q.friction -= w->dt * power(f1->friction, f1->friction_turn, v, spin);
    }
    /* Where nothing pressed at the begin of the step F0 is 0, and a0 small against what F1 gives. */
    if (f0->n) {
        const double sixth = w->dt / 6.0; /* dt^2/12 over the dt/2 in which a kick gains */
        q.damping -= sixth * (power(f1->damping, f1->damping_turn, first->v, first->w) -
                              power(f0->damping, f0->damping_turn, back->v, back->w));
        q.friction -= sixth * (power(f1->friction, f1->friction_turn, first->v, first->w) -
                               power(f0->friction, f0->friction_turn, back->v, back->w));
    }
    if (w->balls.bodies && k < w->n) take_balls(w, k, first, back, &q);
    return q;
}

/* Accelerations by the forces of now.  What is told to move has none that would follow a contact. */
static fl_gain rate_of(const fl_world *w, int32_t k)
{
    fl_gain g = {0};
    if (k < w->n) {
        fl_body_rates(&w->b, k, &g.v, &g.w);
    } else if (w->ride.m.n) {
        const fl_bodies *mb = &w->ride.m.b;
        const int32_t m = w->ride.of[k - w->n];
        if (m < 0 || !w->ride.m.motion[m].free) return g;
        fl_body_rates(mb, m, &g.v, &g.w);
        g.v = v3_add(g.v, v3_cross(g.w, v3_sub(w->b.x[k], mb->x[m])));
    }
    return g;
}

static fl_gain gain_of(const fl_world *w, int32_t k)
{
    const fl_gain g = rate_of(w, k);
    return (fl_gain){v3_scale(0.5 * w->dt, g.v), v3_scale(0.5 * w->dt, g.w)};
}

void fl_works_begin(fl_world *w)
{
    const fl_sinks was = w->was;
    w->was = w->sink;
    w->sink = was;
    fl_ball_sum *sum = w->balls.was;
    w->balls.was = w->balls.sum;
    w->balls.sum = sum;
    memset(w->lead, 0, (size_t)w->gain_cap * sizeof *w->lead);
    for (int32_t k = w->n; k < w->b.total && w->ride.m.n; k++) {
        fl_gain *const gain = fl_works_gain(w, k);
        if (gain) *gain = gain_of(w, k);
    }
}

/* Of what is told to move; what moves by itself has its own books, ride.h. */
static double drive_power(const fl_world *w)
{
    double sum = 0.0;
    if (w->ride.m.n == 0) return 0.0;
    for (int32_t k = 0; k < w->pieces; k++) {
        const int32_t j = w->n + k, m = w->ride.of[k];
        if (m < 0 || w->ride.m.motion[m].free) continue;
        sum -= power(w->b.f[j], w->b.t[j], w->b.v[j], w->b.w[j]);
    }
    return sum;
}

void fl_works_book(fl_world *w)
{
    fl_ledger *g = &w->ledger;
    fl_works sum = {0};
    for (int32_t k = 0; k < fl_groups(w); k++)
        sum.damping += w->group[k].damped, sum.friction += w->group[k].rubbed;
    for (int32_t k = w->n; k < w->b.total && w->ride.m.n; k++) {
        const fl_gain back = gain_of(w, k);
        const fl_works q = fl_works_take(w, k, fl_works_gain(w, k), &back);
        sum.damping += q.damping, sum.friction += q.friction;
    }
    g->damping += sum.damping;
    g->friction += sum.friction;
    g->drive += w->dt * drive_power(w);
}

fl_works fl_works_ahead(const fl_world *w)
{
    const double h = 0.5 * w->dt, sixth = w->dt * w->dt / 6.0;
    fl_works sum = {.drive = h * drive_power(w)};
    for (int32_t k = 0; k < w->b.total; k++) {
        const fl_sink *s = fl_works_now(w, k);
        const int meets = w->balls.bodies && k < w->n;
        if (s->n == 0 && !meets) continue;
        const fl_vec3 v = w->b.v[k], spin = w->b.w[k];
        const fl_gain a = rate_of(w, k);
        if (meets) {
            const fl_ball_sum *q = &w->balls.sum[k];
            sum.damping -= h * v3_dot(q->damping, v) + sixth * v3_dot(q->damping, a.v);
            sum.friction -=
                h * power(q->friction, q->torque, v, spin) + sixth * power(q->friction, q->torque, a.v, a.w);
        }
        if (s->n == 0) continue;
        sum.damping -= h * power(s->damping, s->damping_turn, v, spin) +
                       sixth * power(s->damping, s->damping_turn, a.v, a.w);
        sum.friction -= h * power(s->friction, s->friction_turn, v, spin) +
                        sixth * power(s->friction, s->friction_turn, a.v, a.w);
    }
    return sum;
}
