/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/mem.h"
#include "base/wide.h"
#include "body/few.h"
#include "body/integrate.h"
#include "step/balls.h"
#include "step/frozen.h"
#include "step/group.h"
#include "step/plain.h"
#include "step/sleep.h"
#include "step/step.h"
#include "step/works.h"
#include "water/calm.h"

static int32_t end_of(const fl_world *w, int32_t g)
{
    const int32_t end = (g + 1) * FL_BALLS_GROUP;
    return end < w->n ? end : w->n;
}

/* Behind the last of a[k], a[k + 1], ... that is x; eight at a time as long as they are. */
static int32_t run_of(const uint8_t *a, uint8_t x, int32_t k, int32_t to)
{
    const uint64_t all = UINT64_C(0x0101010101010101) * x;
    for (; k + 8 <= to; k += 8) {
        uint64_t eight;
        memcpy(&eight, &a[k], sizeof eight);
        if (eight != all) break;
    }
    while (k < to && a[k] == x) k++;
    return k;
}

/* Behind the last of those from k on with which nothing more is to be done than to kick them and let them
 * drift, and that are balls as k is; k itself where it is none of those. */
static int32_t alike(const fl_world *w, int32_t k, int32_t to)
{
    if (w->b.added || w->sea.waves) return k;
    to = run_of(w->b.ball, w->b.ball[k], k, run_of(w->b.hold, 0, k, to));
    if (w->traffic.away) to = run_of(w->traffic.away, 0, k, to);
    return w->sleep.kind ? run_of(w->sleep.kind, FL_AWAKE, k, to) : to;
}

/* Something may press on it now.  Which spheres met another is not written down. */
static int presses(const fl_world *w, int32_t k)
{
    return w->met[k] || w->balls.bodies || fl_frozen_at(w, k);
}

/* What a kick by h gives to a ball that is unbound; */
static fl_gain gain_of(const fl_bodies *b, int32_t k, double h)
{
    return (fl_gain){v3_scale(h * b->invm[k], b->f[k]), v3_scale(h * b->invI[k].x, b->t[k])};
}

/* to another body that is. */
static fl_gain gain_free(const fl_bodies *b, int32_t k, double h)
{
    return (fl_gain){v3_scale(h * b->invm[k], b->f[k]), fl_body_turn(b, k, v3_scale(h, b->t[k]))};
}

/* w may be the mean of a step before a kick, which is no gain of it. */
static void kick(fl_world *w, int32_t k, double h, fl_gain *gain)
{
    const fl_vec3 v = w->b.v[k], spin = w->b.w[k];
    const int turns = !(w->b.hold[k] & (FL_HOLD_RX | FL_HOLD_RY | FL_HOLD_RZ));
    *gain = gain_free(&w->b, k, h);
    fl_step_kick(w, k, h);
    if (!fl_body_free(&w->b, k)) gain->v = v3_sub(w->b.v[k], v);
    if (!turns) gain->w = v3_sub(w->b.w[k], spin);
}

/* --- the first half ---------------------------------------------------------------------------- */

/* At most FL_FEW floes that are unbound. */
static void begin_few(fl_world *w, int32_t from, int32_t n, double h, double dt)
{
    fl_bodies *b = &w->b;
    fl_sea *sea = &w->sea;
    const int calm = sea->n && fl_calm_goes(sea);
    fl_few s;
    for (int32_t k = from; k < from + n && sea->n && !calm; k++) fl_sea_drag(sea, b, k, h, 0);
    fl_few_take(&s, b, from, n);
    fl_few_take_forces(&s, b);
    fl_few_take_pose(&s, b);
    if (calm) fl_calm_drag(sea, b, &s, h, 0);
    const int32_t *was = w->was.place + from;
    for (int32_t k = 0; k < n; k++)
        if (was[k]) w->gain[was[k]] = gain_free(b, from + k, h);
    fl_few_push(&s, h);
    const int done = fl_few_drift(&s, dt);
    fl_few_put_speeds(&s, b);
    if (done) fl_few_put_pose(&s, b);
    for (int32_t k = from; k < from + n && !done; k++) fl_drift(b, k, dt);
}

static void begin_balls(fl_world *w, int32_t from, int32_t to, double h, double dt)
{
    for (int32_t k = from; k < to && w->sea.n; k++) fl_sea_drag(&w->sea, &w->b, k, h, 0);
    fl_move_balls(&w->b, from, to, h, dt);
}

static void begin_one(fl_world *w, int32_t k, double h, double dt)
{
    if (fl_world_away(w, k) || fl_sleep_kind(w, k) != FL_AWAKE) return;
    if (w->sea.n) fl_sea_drag(&w->sea, &w->b, k, h, 0);
    fl_gain gain, *const kept = fl_works_gain(w, k);
    kick(w, k, h, kept ? kept : &gain);
    fl_drift(&w->b, k, dt);
}

static void begin(fl_world *w, int32_t from, int32_t to, double h, double dt)
{
    int32_t end;
    for (int32_t k = from; k < to; k = end) {
        end = alike(w, k, to);
        if (end == k) begin_one(w, end++, h, dt);
        else if (w->b.ball[k]) begin_balls(w, k, end, h, dt);
        else
            for (int32_t i = k; i < end; i += FL_FEW)
                begin_few(w, i, end - i < FL_FEW ? end - i : FL_FEW, h, dt);
    }
}

/* The longest way and the next: of each lane, then of all. */
FL_WIDE_VERSIONS static void farthest(int32_t n, const double *restrict now, const double *restrict found,
                                      double *restrict moved)
{
    fl_wide one = {0}, two = {0};
    double first[2] = {0.0, 0.0};
    int32_t k = 0;
    for (; k + FL_LANES <= n; k += FL_LANES) {
        const fl_wide way = FL_FOUR(&now[k]) - FL_FOUR(&found[k]);
        const fl_wide_mask longer = way > one;
        const fl_wide less = FL_WIDE_CHOOSE(longer, one, way);
        one = FL_WIDE_CHOOSE(longer, way, one);
        two = FL_WIDE_CHOOSE(less > two, less, two);
    }
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) fl_longest(first, one[l]), fl_longest(first, two[l]);
    for (; k < n; k++) fl_longest(first, now[k] - found[k]);
    moved[0] = first[0], moved[1] = first[1];
}

void fl_group_begin(fl_world *w, int32_t g, double h, double dt)
{
    const int32_t from = g * FL_BALLS_GROUP, to = end_of(w, g);
    if (!fl_sleep_all(w, from, to)) begin(w, from, to, h, dt);
    if (w->balls.bodies) fl_balls_show(w, from, to);
    farthest(to - from, w->b.odometer + from, w->odometer_found + from, w->group[g].moved);
}

/* --- the second -------------------------------------------------------------------------------- */

/* What contacts push body i < n with. */
static fl_vec3 pushed(const fl_world *w, int32_t i)
{
    double drawn = 0.0;
    fl_vec3 f = w->b.f[i];
    const double k = w->row.n ? fl_world_spring(w, i, &drawn) : 0.0;
    if (w->row.n) f.z += k * drawn;
    f = v3_madd(f, -w->b.m[i], w->gravity);
    return w->sea.water ? v3_sub(f, fl_sea_push(&w->sea, i)) : f;
}

/* What nothing presses has no works of contacts, and its push is 0. */
static void push(const fl_world *w, int32_t k, fl_group *own)
{
    if (presses(w, k)) own->pushed = v3_add(own->pushed, pushed(w, k));
}

/* Body by body in their order, whichever way they go: the sum has the same bits. */
static void book(fl_group *own, fl_works q)
{
    own->damped += q.damping;
    own->rubbed += q.friction;
}

static void book_plain(fl_group *own, const fl_plain_works *q, int32_t n)
{
    for (int32_t k = 0; k < n; k++) own->damped += q->damped[k], own->rubbed += q->rubbed[k];
}

/* Which of a few have more to do than what the water asks, 0 the first: something presses on them, or has
 * left them something to forget. */
static int32_t find_busy(const fl_world *w, int32_t from, int32_t n, int32_t busy[FL_FEW])
{
    const int all = w->frozen.n > 0;
    const uint8_t *met = w->met + from;
    const int32_t *sink = w->sink.place + from, *was = w->was.place + from;
    int32_t many = 0;
    if (!w->sink.all && !w->was.all) {
        for (int32_t k = 0; k < n; k++)
            if (sink[k] | was[k]) busy[many++] = k;
        return many;
    }
    for (int32_t k = 0; k < n; k++)
        if (all || met[k] || w->sink.at[sink[k]].n || w->was.at[was[k]].n) busy[many++] = k;
    return many;
}

/* What acts on a few but their contacts, in the arrays of the bodies and in their own. */
static void find_forces(fl_world *w, fl_few *s)
{
    int32_t left[FL_FEW], others = 0;
    if (w->row.n || (w->sea.water && (w->sea.held || !fl_calm_goes(&w->sea)))) {
        for (int32_t k = 0; k < s->n; k++) left[others++] = k;
    } else {
        fl_few_weigh(s, w->gravity);
        if (w->sea.water) others = fl_calm_force(&w->sea, &w->b, s, left);
        fl_few_put_forces(s, &w->b);
    }
    for (int32_t k = 0; k < others; k++) {
        fl_step_soft(w, s->from + left[k]);
        fl_few_take_force(s, &w->b, left[k]);
    }
}

static void end_few(fl_world *w, int32_t from, int32_t n, double h, fl_group *own)
{
    fl_bodies *b = &w->b;
    fl_sea *sea = &w->sea;
    const int calm = sea->n && fl_calm_goes(sea);
    int32_t busy[FL_FEW];
    const int32_t many = find_busy(w, from, n, busy);
    fl_few s;
    fl_few_take(&s, b, from, n);
    fl_few_axes(&s);
    find_forces(w, &s);
    for (int32_t k = 0; k < many; k++) {
        fl_step_press(w, from + busy[k]);
        fl_few_take_force(&s, b, busy[k]);
    }
    fl_few_kick(&s, h);
    if (calm) fl_calm_drag(sea, b, &s, h, 1);
    fl_few_put_speeds(&s, b);
    for (int32_t k = from; k < from + n && sea->n && !calm; k++) fl_sea_drag(sea, b, k, h, 1);
    for (int32_t k = 0; k < many; k++) {
        const int32_t i = from + busy[k];
        const fl_gain back = gain_free(b, i, h);
        push(w, i, own);
        book(own, fl_works_take(w, i, fl_works_gain(w, i), &back));
    }
}

/* Of a ball the first kick is known from the forces that it had. */
static void end_balls(fl_world *w, int32_t from, int32_t to, double h, fl_group *own)
{
    fl_bodies *b = &w->b;
    fl_gain first[FL_BALLS_GROUP];
    for (int32_t k = from; k < to; k++) {
        first[k - from] = gain_of(b, k, h);
        fl_step_gather(w, k);
    }
    fl_move_balls(b, from, to, h, 0.0);
    for (int32_t k = from; k < to; k++) {
        const fl_gain back = gain_of(b, k, h);
        if (w->sea.n) fl_sea_drag(&w->sea, b, k, h, 1);
        push(w, k, own);
        book(own, fl_works_take(w, k, &first[k - from], &back));
    }
}

/* What the first kick gave to body k, before forces are those of the end of the step.  Of spheres it is asked
 * for whoever presses on them, and nobody has kept it where only spheres do. */
static fl_gain first_of(const fl_world *w, int32_t k, double h)
{
    const fl_gain *const kept = fl_works_gain(w, k);
    fl_gain g = {0};
    if (kept) return *kept;
    if (!w->balls.bodies || !w->b.ball[k]) return g;
    fl_body_rates(&w->b, k, &g.v, &g.w);
    return (fl_gain){v3_scale(h, g.v), v3_scale(h, g.w)};
}

static void end_one(fl_world *w, int32_t k, double h, fl_group *own)
{
    const enum fl_nap_kind kind = fl_sleep_kind(w, k);
    const fl_gain first = first_of(w, k, h);
    fl_gain back = {0};
    if (fl_sleeps(w, k)) {
        if (fl_works_now(w, k)->n || fl_works_was(w, k)->n)
            *fl_works_now(w, k) = *fl_works_was(w, k); /* what presses stays */
    } else if (kind == FL_ENDS) fl_sleep_end(w, k);
    else fl_step_gather(w, k);
    if (fl_world_away(w, k) || kind == FL_COASTS) return;
    push(w, k, own);
    if (!(h > 0.0) || kind == FL_RESTS) { return; }
    if (kind == FL_ENDS) {
        fl_sleep_ended(w, k);
    } else {
        kick(w, k, h, &back);
        if (w->sea.n) fl_sea_drag(&w->sea, &w->b, k, h, 1);
    }
    book(own, fl_works_take(w, k, &first, &back));
}

/* Spheres that plain.h knows, from k on; behind the last. */
static int32_t end_plain(fl_world *w, int32_t k, int32_t to, double h, fl_group *own, int *finite)
{
    fl_plain_works works;
    int32_t end = k;
    while (h > 0.0 && end < to && fl_plain_is(w, end)) end++;
    for (int32_t i = k; i < end && w->sink.all; i++) fl_works_clear(w, i);
    if (end > k && !fl_plain_end(w, k, end, h, &works)) *finite = 0;
    book_plain(own, &works, end - k);
    for (int32_t i = k; i < end; i++)
        own->pushed = v3_add(own->pushed, v3_madd(w->b.f[i], -w->b.m[i], w->gravity));
    return end;
}

/* A group that is of spheres alone, dry, on which nothing but spheres and walls presses or did; 0 where it is
 * not. */
static int end_spheres(fl_world *w, int32_t from, int32_t to, double h, fl_group *own, int *finite)
{
    const int32_t *sink = w->sink.place, *was = w->was.place;
    fl_plain_works works;
    int32_t pressed = 0;
    if (!w->balls.bodies || !w->b.ball[from] || w->sea.n || w->row.n || w->sink.all || !(h > 0.0)) return 0;
    for (int32_t k = from; k < to; k++) pressed |= sink[k] | was[k];
    if (pressed || alike(w, from, to) < to) return 0;
    *finite = fl_plain_end(w, from, to, h, &works);
    book_plain(own, &works, to - from);
    for (int32_t k = from; k < to; k++)
        own->pushed = v3_add(own->pushed, v3_madd(w->b.f[k], -w->b.m[k], w->gravity));
    return 1;
}

/* Of balls [k, to), k none that plain.h knows, the first that it does. */
static int32_t before_plain(const fl_world *w, int32_t k, int32_t to)
{
    while (++k < to && !fl_plain_is(w, k)) {}
    return k;
}

/* Whether n numbers of each of four arrays are finite: 0 x is 0 where x is.  What overflows only in the sum
 * of four is told as well, and looked at again. */
FL_WIDE_VERSIONS static int all_finite(const double *restrict a, const double *restrict b,
                                       const double *restrict c, const double *restrict d,
                                       const double *restrict e, int32_t n)
{
    double zero = 0.0;
#pragma omp simd reduction(+ : zero)
    for (int32_t k = 0; k < n; k++) zero += 0.0 * (((a[k] + b[k]) + (c[k] + d[k])) + e[k]);
    return zero == 0.0;
}

/* The first of bodies [from, to) that has a number which is not finite, or -1. */
static int32_t first_lost(const fl_bodies *b, int32_t from, int32_t to)
{
    if (all_finite(&b->f[from].x, &b->t[from].x, &b->x[from].x, &b->v[from].x, &b->w[from].x,
                   3 * (to - from)))
        return -1;
    for (int32_t k = from; k < to; k++)
        if (!v3_finite(b->f[k]) || !v3_finite(b->t[k]) || !v3_finite(b->x[k]) || !v3_finite(b->v[k]) ||
            !v3_finite(b->w[k]))
            return k;
    return -1;
}

void fl_group_end(fl_world *w, int32_t g, double h)
{
    const int32_t from = g * FL_BALLS_GROUP, to = end_of(w, g);
    fl_group *own = &w->group[g];
    int32_t end, many = 0;
    int finite = 1;
    *own = (fl_group){.lost = -1};
    if (fl_sleep_all(w, from, to)) return;
    if (w->balls.bodies) {
        fl_fetch(&w->balls.was[to], FL_BALLS_GROUP * sizeof *w->balls.was); /* of the group behind it */
        fl_balls_collect(w, from, to);
    }
    if (end_spheres(w, from, to, h, own, &finite)) {
        if (!finite) own->lost = first_lost(&w->b, from, to);
        return;
    }
    for (int32_t k = from; k < to; k = end) {
        end = end_plain(w, k, to, h, own, &finite);
        many += end - k;
        if (end > k) continue;
        end = h > 0.0 ? alike(w, k, to) : k;
        if (end > k && w->b.ball[k]) end = before_plain(w, k, end);
        if (end == k) end_one(w, end++, h, own);
        else if (w->b.ball[k]) end_balls(w, k, end, h, own);
        else
            for (int32_t i = k; i < end; i += FL_FEW)
                end_few(w, i, end - i < FL_FEW ? end - i : FL_FEW, h, own);
    }
    if (!finite || many < to - from) own->lost = first_lost(&w->b, from, to);
}
