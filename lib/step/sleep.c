/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <omp.h>
#include "base/mem.h"
#include "body/integrate.h"
#include "sim/body_step.h"
#include "step/sleep.h"
#include "step/step.h"
#include "step/works.h"

enum {
    WINDOW = 64,    /* steps over which it is seen whether a floe rests */
    LEAST = 4,      /* steps: a shorter sleep is not worth while, and who cannot sleep is not asked before */
    SELDOM = 64,    /* steps: and not much later */
    MOST = 1 << 14, /* steps: doubling ends here */
    LONGEST = 1 << 20 /* windows of rest */
};

/* What fl_sleep_look() changes of a floe. */
struct fl_nap_image {
    fl_vec3 x, v, L, w, f, t;
    fl_quat q;
    double held, odometer, carried, drained, blown, waved;
    fl_nap nap;
};

int fl_sleep_make(fl_world *w, fl_err *err)
{
    fl_sleep *s = &w->sleep;
    if (!(w->scene->run.sleep > 0.0)) return 0;
    s->tol = w->scene->run.sleep;
    s->nap = fl_alloc(w->n, sizeof *s->nap, err);
    s->kind = fl_alloc(w->n, sizeof *s->kind, err);
    s->until = fl_alloc(w->n, sizeof *s->until, err);
    s->image = fl_alloc(w->n, sizeof *s->image, err);
    s->stack = fl_alloc(w->n, sizeof *s->stack, err);
    if (!s->nap || !s->kind || !s->until || !s->image || !s->stack) return -1;
    for (int32_t j = 0; j < w->sea.wave.n; j++) {
        s->rise += w->sea.wave.train[j].a * w->sea.wave.train[j].omega;
        s->slope += w->sea.wave.train[j].a * w->sea.wave.train[j].k;
    }
    for (int32_t k = 0; k < w->n; k++) fl_sleep_new(w, k);
    return 0;
}

void fl_sleep_new(fl_world *w, int32_t i)
{
    if (!w->sleep.nap) return;
    fl_nap *nap = &w->sleep.nap[i];
    *nap = (fl_nap){.since = w->step,
                    .span = LEAST,
                    .mark = -1.0,
                    .off = nap->off,
                    .summed = nap->summed,
                    .coasted = nap->coasted,
                    .naps = nap->naps,
                    .rested = nap->rested};
    w->sleep.kind[i] = FL_AWAKE;
    w->sleep.until[i] = 0;
}

double fl_sleep_bytes(const fl_world *w)
{
    const fl_sleep *s = &w->sleep;
    return s->nap ? (double)w->n * (double)(sizeof *s->nap + sizeof *s->image + sizeof *s->kind +
                                            sizeof *s->until + sizeof *s->stack) +
                        (double)s->due_cap * (double)sizeof *s->due
                  : 0.0;
}

void fl_sleep_free(fl_sleep *s)
{
    free(s->nap), free(s->kind), free(s->until), free(s->image), free(s->stack), free(s->due);
    *s = (fl_sleep){0};
}

/* --- who coasts -------------------------------------------------------------------------------- */

/* The floe k over s seconds by what acts at the begin: weight, water, springs, wind.  First half ... */
void fl_sleep_begin(fl_world *w, int32_t k)
{
    fl_nap *nap = &w->sleep.nap[k];
    fl_body_rates(&w->b, k, &nap->a, &nap->turn);
}

static void out(fl_world *w, int32_t k, double s)
{
    fl_sleep_begin(w, k);
    fl_step_out(w, k, s);
}

/* What a step of s seconds is off by, when it has been made: the forces of now are those that stay, and v and
 * spin what the speeds were before the last drag [m]. */
static double off_by(fl_world *w, int32_t k, double s, fl_vec3 v, fl_vec3 spin)
{
    fl_nap *nap = &w->sleep.nap[k];
    const fl_bodies *b = &w->b;
    const double slowed = nap->drag, r = b->bound[k], turned = v3_norm(spin) * s;
    fl_vec3 a, turn;
    fl_body_rates(b, k, &a, &turn);
    nap->drag = (v3_norm(v3_sub(b->v[k], v)) + r * v3_norm(v3_sub(b->w[k], spin))) / (0.5 * s);
    return s * s / 12.0 *
               (v3_norm(v3_sub(a, nap->a)) + r * v3_norm(v3_sub(turn, nap->turn)) +
                fabs(nap->drag - slowed)) +
           r * turned * turned * turned / 12.0;
}

/* ... and second; returns what it is off by [m]. */
static double back(fl_world *w, int32_t k, double s)
{
    const fl_bodies *b = &w->b;
    fl_step_kick(w, k, 0.5 * s);
    const fl_vec3 v = b->v[k], spin = b->w[k];
    if (w->sea.n) fl_sea_drag(&w->sea, &w->b, k, 0.5 * s, 1);
    return off_by(w, k, s, v, spin);
}

/* How a floe goes: bounds of the speeds of its points and of what changes these [m/s], [m/s2]. */
typedef struct {
    double speed, turn;     /* of the centre; about it [1/s]       */
    double faster, turning; /* the same by what acts, drag apart; [1/s2] */
} pace;

static pace pace_of(const fl_world *w, int32_t k)
{
    const fl_bodies *b = &w->b;
    const double ease = fl_body_ease(b, k);
    fl_vec3 a, turn;
    fl_body_rates(b, k, &a, &turn);
    double torque = v3_norm(b->t[k]);
    if (b->added) {
        const fl_vec3 u = v3_sub(b->v[k], b->flow[k]);
        torque += v3_norm(fl_body_momentum(b, k, u)) * v3_norm(u);
    }
    return (pace){v3_norm(b->v[k]), v3_norm(b->L[k]) * ease, v3_norm(a), torque * ease};
}

/* The bound of the path of floe k over s seconds from now on. */
static double way_of(const fl_world *w, int32_t k, const pace *p, double s)
{
    const double r = w->b.bound[k];
    return s * (p->speed + r * p->turn) + s * s * (0.5 * (p->faster + r * p->turning) + w->sleep.nap[k].drag);
}

/* It may be beyond the bounds of the domain by now. */
static int may_have_left(const fl_world *w, int32_t k)
{
    const fl_traffic *t = &w->traffic;
    const fl_vec3 x = w->b.x[k];
    const double r = w->b.bound[k] + w->b.radius[k] - w->sleep.nap[k].way;
    return t->away && (x.x + r < t->lo.x || x.x - r > t->hi.x || x.y + r < t->lo.y || x.y - r > t->hi.y ||
                       x.z + r < t->lo.z || x.z - r > t->hi.z);
}

/* Several threads may have a body in hand. */
static void end_sleep(uint8_t *kind)
{
    uint8_t is;
#pragma omp atomic read
    is = *kind;
    if (is != FL_COASTS) return;
#pragma omp atomic write
    *kind = FL_ENDS;
}

/* The pairs of thing k that have to be looked at. */
static void call_pairs(fl_world *w, int32_t k)
{
    fl_sleep *s = &w->sleep;
    for (int64_t i = w->inc_first[k]; i < w->inc_first[k + 1]; i++) {
        const int32_t c = w->inc[i];
        if (fl_world_apart(w, c)) continue;
#pragma omp atomic write
        s->due[c] = 1;
        end_sleep(&s->kind[w->watch[c].i]);
        if (w->watch[c].j < w->n) end_sleep(&s->kind[w->watch[c].j]);
    }
}

/* Only who moves can have come too near to another: ways of those that coast are in the odometers already,
 * and to wake somebody brings no pair nearer.  Of pairs that have just been found nothing is known. */
void fl_sleep_call(fl_world *w, int thread, int threads)
{
    fl_sleep *s = &w->sleep;
    const int32_t end = (int32_t)((int64_t)w->n * (thread + 1) / threads);
    const int found = w->found_at == w->step;
    for (int32_t k = (int32_t)((int64_t)w->n * thread / threads); k < end; k++) {
        uint8_t kind;
#pragma omp atomic read
        kind = s->kind[k];
        if (kind == FL_COASTS) {
            if (w->step >= s->until[k] || (w->traffic.away && may_have_left(w, k))) end_sleep(&s->kind[k]);
            else if (!found) continue;
        }
        call_pairs(w, k);
    }
    for (int32_t k = w->n + thread; k < w->b.total && w->ride.m.n; k += threads)
        if (w->ride.of[k - w->n] >= 0) call_pairs(w, k);
}

/* A sleep of floe k over s seconds has ended, off by that.  What it is off by goes with the third power of s.
 */
static void slept(fl_world *w, int32_t k, double off)
{
    fl_sleep *all = &w->sleep;
    fl_nap *nap = &all->nap[k];
    const double most = all->tol * w->b.radius[k];
    const int32_t steps = (int32_t)(w->step - nap->since);
    const int32_t span = off <= 0.0625 * most ? 2 * steps : off <= 0.5 * most ? steps : steps / 2;
    nap->off = fmax(nap->off, off / w->b.radius[k]);
    nap->summed += off / w->b.radius[k];
    if (w->step >= all->until[k] || span < nap->span)
        nap->span = span < LEAST ? LEAST : span > MOST ? MOST : span;
    nap->coasted += steps;
    nap->naps++;
    all->until[k] = nap->since = w->step;
}

void fl_sleep_book(fl_world *w, int32_t k, fl_vec3 v, fl_vec3 spin)
{
    slept(w, k, off_by(w, k, fl_sleep_seconds(w, k), v, spin));
}

void fl_sleep_end(fl_world *w, int32_t k)
{
    fl_step_soft(w, k);
    slept(w, k, back(w, k, fl_sleep_seconds(w, k)));
    /* what came to touch it in the last step presses for that */
    if (!fl_step_press(w, k)) return;
    const fl_vec3 f = w->b.f[k], t = w->b.t[k];
    fl_step_soft(w, k);
    w->b.f[k] = v3_sub(f, w->b.f[k]);
    w->b.t[k] = v3_sub(t, w->b.t[k]);
    fl_kick(&w->b, k, 0.5 * w->dt);
    w->b.f[k] = f;
    w->b.t[k] = t;
}

/* How many of `left` steps of floe k stay within the tolerance together, whatever it meets.  What acts
 * smoothly pulls a point back with no more than omega^2 = rho g A (1/m + r^2/2I), A the largest area that the
 * water cuts out of it, at most half of its surface, and springs; so it changes by no more than omega^2 times
 * the way of its points against the surface of the water, at a speed u that grows by their acceleration a: s
 * seconds are off by up to s^3/12 omega^2 (u + s a).  Three quarters of the tolerance for that, a quarter for
 * turns. */
static int32_t within(const fl_world *w, int32_t k, const pace *p, int32_t left)
{
    const fl_bodies *b = &w->b;
    const double r = b->bound[k] + b->radius[k], most = w->sleep.tol * b->radius[k];
    const fl_vec3 v = b->v[k], spin = b->w[k];
    double drawn, stiff = fl_world_spring(w, k, &drawn) * b->invm[k];
    if (w->sea.water)
        stiff +=
            0.5 * w->sea.weight * w->sea.hull[k].surface * (b->invm[k] + 0.5 * r * r * fl_body_ease(b, k));
    const double u = fabs(v.z) + r * sqrt(spin.x * spin.x + spin.y * spin.y) + w->sleep.rise +
                     w->sleep.slope * sqrt(v.x * v.x + v.y * v.y),
                 faster = p->faster + r * p->turning, turn3 = p->turn * p->turn * p->turn;
    for (; left >= LEAST; left -= (left + 3) / 4) {
        const double s = left * w->dt, s3 = s * s * s;
        if (s3 * stiff * (u + s * faster) <= 9.0 * most && s3 * r * turn3 <= 3.0 * most) break;
    }
    return left;
}

/* How long, in steps, floe k may coast from now on before it could touch a neighbour that goes on as it does.
 * One that is so far that it had to be three times as fast is not asked how fast it is. */
static double time_left(const fl_world *w, int32_t k, double left, double speed)
{
    const fl_bodies *b = &w->b;
    for (int64_t c = w->inc_first[k]; c < w->inc_first[k + 1]; c++) {
        const fl_watch p = w->watch[w->inc[c]];
        const int32_t o = p.i == k ? p.j : p.i;
        const double gap = p.until - b->odometer[p.i] - b->odometer[p.j], step = gap / w->dt;
        if (gap <= 0.0) return 0.0;
        if (4.0 * speed * left <= step) continue;
        const double both = speed + v3_norm(b->v[o]) + b->bound[o] * v3_norm(b->w[o]);
        if (both * left > step) left = step / both;
    }
    return left;
}

static int may_sleep(const fl_world *w, int32_t k)
{
    const fl_traffic *t = &w->traffic;
    if (w->b.added && w->sea.waves) return 0; /* the drift is of order 1 in a flow that changes */
    return !fl_world_away(w, k) && !w->b.ball[k] && w->b.radius[k] > 0.0 &&
           !(t->away && t->feed && t->guided[k]);
}

/* Floe k, which is awake, coasts from now on, if there is something to be gained: of so many steps, else 0.
 * Its way is known, but not yet in its odometer, by which others are asked as well. */
static int32_t span_of(fl_world *w, int32_t k)
{
    if (w->met[k] || fl_works_now(w, k)->n || fl_works_was(w, k)->n || !may_sleep(w, k)) return 0;
    const pace p = pace_of(w, k);
    const int32_t steps = within(w, k, &p, w->sleep.nap[k].span);
    if (steps < LEAST) return 0;
    const double s = steps * w->dt, left = time_left(w, k, steps, way_of(w, k, &p, s) / s);
    if (left < LEAST) return 0;
    w->sleep.nap[k].way = way_of(w, k, &p, (int32_t)left * w->dt) * (1.0 + 1e-9);
    return (int32_t)left;
}

static void let_coast(fl_world *w, int32_t k)
{
    fl_nap *nap = &w->sleep.nap[k];
    w->sleep.kind[k] = FL_COASTS;
    nap->since = w->step;
    nap->mark = -1.0;
    w->b.odometer[k] += nap->way;
}

/* --- looked at -------------------------------------------------------------------------------- */

void fl_sleep_look(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    const fl_bodies *b = &w->b;
    if (!s->nap) return;
#pragma omp parallel for schedule(dynamic, 16) num_threads(w->threads) /* each has cells of the sea */
    for (int32_t k = 0; k < w->n; k++) {
        if (s->kind[k] != FL_COASTS) continue;
        s->image[k] = (fl_nap_image){.x = b->x[k],
                                     .v = b->v[k],
                                     .L = b->L[k],
                                     .w = b->w[k],
                                     .f = b->f[k],
                                     .t = b->t[k],
                                     .q = b->q[k],
                                     .held = b->held[k],
                                     .odometer = b->odometer[k],
                                     .carried = b->added ? b->carried[k] : 0.0,
                                     .drained = w->sea.n ? w->sea.drained[k] : 0.0,
                                     .blown = w->sea.blown ? w->sea.blown[k] : 0.0,
                                     .waved = w->sea.waves ? w->sea.waved[k] : 0.0,
                                     .nap = s->nap[k]};
        const double t = fl_sleep_seconds(w, k);
        if (t == 0.0) continue;
        out(w, k, t);
        fl_step_soft(w, k);
        back(w, k, t);
    }
}

void fl_sleep_back(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    fl_bodies *b = &w->b;
    const double now = w->sea.time;
    for (int32_t k = 0; k < w->n && s->nap; k++) {
        const fl_nap_image *m = &s->image[k];
        if (s->kind[k] != FL_COASTS) continue;
        b->x[k] = m->x, b->v[k] = m->v, b->L[k] = m->L, b->w[k] = m->w, b->f[k] = m->f, b->t[k] = m->t;
        b->q[k] = m->q, b->held[k] = m->held, b->odometer[k] = m->odometer;
        s->nap[k] = m->nap;
        if (b->added) b->carried[k] = m->carried;
        if (!w->sea.n) continue;
        w->sea.drained[k] = m->drained;
        if (w->sea.blown) w->sea.blown[k] = m->blown;
        if (w->sea.waves) w->sea.waved[k] = m->waved;
        w->sea.time = fl_sleep_since(w, k);
        fl_sea_renew(&w->sea, b, k);
    }
    w->sea.time = now;
}

/* --- who rests --------------------------------------------------------------------------------- */

static void rise(fl_world *w, int32_t k)
{
    fl_sleep *s = &w->sleep;
    fl_nap *nap = &s->nap[k];
    if (s->kind[k] == FL_RESTS) { /* who was only about to has been awake */
        s->resting--;
        nap->rested += w->step - nap->since;
        nap->mark = -1.0;
        fl_gain *const gain = fl_works_gain(w, k); /* it did not move in the first half of a step */
        if (gain) *gain = (fl_gain){0};
    }
    s->kind[k] = FL_AWAKE;
    s->until[k] = nap->since = w->step;
}

/* From the n on the stack to all that touch them and are of that kind: they are awake. */
static void spread(fl_world *w, int32_t n, enum fl_nap_kind kind)
{
    fl_sleep *s = &w->sleep;
    while (n > 0) {
        const int32_t k = s->stack[--n];
        for (int64_t c = w->inc_first[k]; c < w->inc_first[k + 1]; c++) {
            const fl_near *p = &w->pair[w->inc[c]];
            const int32_t o = p->i == k ? p->j : p->i;
            if (!p->n || o >= w->n || s->kind[o] != (uint8_t)kind) continue;
            rise(w, o);
            s->stack[n++] = o;
        }
    }
}

/* The island of k, which rests. */
static void wake(fl_world *w, int32_t k)
{
    rise(w, k);
    w->sleep.stack[0] = k;
    spread(w, 1, FL_RESTS);
}

void fl_sleep_disturb(fl_world *w)
{
    for (int32_t c = 0; c < w->n_live && w->sleep.resting; c++) {
        const fl_near *p = &w->pair[w->live[c]];
        const int rests = fl_sleep_kind(w, p->i) == FL_RESTS;
        if (p->j < w->n && rests != (fl_sleep_kind(w, p->j) == FL_RESTS)) wake(w, rests ? p->i : p->j);
        else if (rests && p->j >= w->n && !fl_thing_is_still(w, p->j)) wake(w, p->i);
    }
}

void fl_sleep_wake(fl_world *w)
{
    for (int32_t k = 0; k < w->n && w->sleep.nap; k++)
        if (w->sleep.kind[k] == FL_RESTS) rise(w, k);
}

/* A wave may reach k, which lies still: what it presses with changes all the same. */
static int lapped(const fl_world *w, int32_t k)
{
    const fl_bodies *b = &w->b;
    return w->sea.waves && b->x[k].z - b->bound[k] - b->radius[k] < w->sea.level + w->sea.wave.crest;
}

/* It is held at a speed, and goes however slow that is. */
static int led(const fl_world *w, int32_t k)
{
    const unsigned hold = w->b.hold[k];
    const fl_vec3 v = w->b.v[k];
    return (hold & FL_HOLD_X && v.x != 0.0) || (hold & FL_HOLD_Y && v.y != 0.0) ||
           (hold & FL_HOLD_Z && v.z != 0.0);
}

/* What acts on it stays as it is while it lies still. */
static int may_rest(const fl_world *w, int32_t k)
{
    return may_sleep(w, k) && fl_works_now(w, k)->n > 0 && !lapped(w, k) && !led(w, k);
}

/* Who has been quiet for a window is FL_QUIET until it is known whether all are that touch it. */
static void find_quiet(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    for (int32_t k = 0; k < w->n; k++) {
        fl_nap *nap = &s->nap[k];
        if (s->kind[k] != FL_AWAKE) continue;
        const double path = w->b.odometer[k] - nap->mark, most = s->tol * w->b.radius[k];
        const int seen = nap->mark >= 0.0;
        nap->mark = w->b.odometer[k];
        if (!seen || path > 0.25 * most || !may_rest(w, k)) continue;
        const double windows = path > 0.0 ? sqrt(most / path) : LONGEST;
        nap->way = path;
        nap->since = w->step;
        s->until[k] = w->step + WINDOW * (int64_t)(windows < LONGEST ? windows : LONGEST);
        s->kind[k] = FL_QUIET;
    }
}

/* The island of k, who are quiet: they rest, unless they go faster now than in the mean of the window.  What
 * begins to fall off an edge does, and of that the path of a window foretells nothing, for it grows by a
 * factor in a time. */
static void settle(fl_world *w, int32_t k)
{
    fl_sleep *s = &w->sleep;
    const fl_bodies *b = &w->b;
    const double window = WINDOW * w->dt;
    double gained = 0.0;
    int32_t n = 0;
    s->kind[k] = FL_RESTS;
    s->stack[n++] = k;
    for (int32_t head = 0; head < n; head++) {
        const int32_t i = s->stack[head];
        gained += window * (v3_norm(b->v[i]) + b->bound[i] * v3_norm(b->w[i])) - s->nap[i].way;
        for (int64_t c = w->inc_first[i]; c < w->inc_first[i + 1]; c++) {
            const fl_near *p = &w->pair[w->inc[c]];
            const int32_t o = p->i == i ? p->j : p->i;
            if (!p->n || o >= w->n || s->kind[o] != FL_QUIET) continue;
            s->kind[o] = FL_RESTS;
            s->stack[n++] = o;
        }
    }
    s->resting += n;
    for (int32_t i = 0; i < n && gained > 0.0; i++) {
        s->resting--;
        s->kind[s->stack[i]] = FL_AWAKE;
        s->until[s->stack[i]] = w->step;
    }
}

static void let_rest(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    int32_t n = 0;
    find_quiet(w);
    for (int32_t c = 0; c < w->n_live; c++) {
        const fl_near *p = &w->pair[w->live[c]];
        const int32_t ends[2] = {p->i, p->j};
        for (int e = 0; e < 2; e++) {
            const int32_t k = ends[e], o = ends[1 - e];
            if (k >= w->n || s->kind[k] != FL_QUIET) continue;
            if (o >= w->n ? fl_thing_is_still(w, o) : s->kind[o] != FL_AWAKE) continue;
            s->kind[k] = FL_AWAKE;
            s->until[k] = s->nap[k].since = w->step;
            s->stack[n++] = k;
        }
    }
    spread(w, n, FL_QUIET);
    for (int32_t k = 0; k < w->n; k++)
        if (s->kind[k] == FL_QUIET) settle(w, k);
}

fl_sleep_count fl_sleep_counted(const fl_world *w)
{
    fl_sleep_count all = {0};
    for (int32_t k = 0; k < w->n && w->sleep.nap; k++) {
        const fl_nap *nap = &w->sleep.nap[k];
        const int64_t now = fl_sleeps(w, k) ? w->step - nap->since : 0;
        all.coasted += nap->coasted + (w->sleep.kind[k] == FL_COASTS ? now : 0);
        all.rested += nap->rested + (w->sleep.kind[k] == FL_RESTS ? now : 0);
        all.naps += nap->naps;
        all.off = fmax(all.off, nap->off);
        all.summed = fmax(all.summed, nap->summed);
    }
    return all;
}

/* --- both -------------------------------------------------------------------------------------- */

/* Steps after which a floe that is awake is asked again: the longer it has been so, the later. */
static int32_t patience(const fl_world *w, int32_t k)
{
    const int64_t awake = w->step - w->sleep.nap[k].since;
    return LEAST + (int32_t)(awake < 8 * SELDOM ? awake / 8 : SELDOM);
}

/* Of floes [from, to) that are awake those that are asked, then of these who may: how many, to the begin of
 * their part of the stack. */
static int32_t find_spans(fl_world *w, int32_t from, int32_t to)
{
    fl_sleep *s = &w->sleep;
    int32_t *const list = s->stack + from, n = 0;
    const int32_t up = fl_sleep_list(w, from, to, list);
    for (int32_t i = 0; i < up; i++) {
        const int32_t k = list[i];
        if (s->kind[k] != FL_AWAKE || w->step < s->until[k]) continue;
        const int32_t span = span_of(w, k);
        s->until[k] = w->step + (span ? span : patience(w, k));
        list[n] = k;
        n += span != 0;
    }
    return n;
}

static void fall_asleep(fl_world *w, int32_t from, int32_t n)
{
    for (int32_t i = 0; i < n; i++) let_coast(w, w->sleep.stack[from + i]);
}

/* Who met another that fell asleep with him does so for a step alone. */
static void look_round(fl_world *w, int32_t k)
{
    for (int64_t c = w->inc_first[k]; c < w->inc_first[k + 1]; c++)
        if (!fl_world_apart(w, w->inc[c])) w->sleep.until[k] = w->step + 1;
}

static void look_round_all(fl_world *w, int32_t from, int32_t n)
{
    for (int32_t i = 0; i < n; i++) look_round(w, w->sleep.stack[from + i]);
}

void fl_sleep_resume(fl_world *w)
{
    for (int32_t k = 0; k < w->n && w->sleep.nap; k++)
        if (w->sleep.kind[k] == FL_COASTS) look_round(w, k);
}

/* All of them, by the same odometers. */
static void lull_all(fl_world *w)
{
    if (w->team.n == 1) { /* a team of one takes its time */
        const int32_t n = find_spans(w, 0, w->n);
        fall_asleep(w, 0, n);
        look_round_all(w, 0, n);
        return;
    }
#pragma omp parallel num_threads(w->team.n)
    {
        const int thread = omp_get_thread_num(), threads = omp_get_num_threads();
        const int32_t from = (int32_t)((int64_t)w->n * thread / threads),
                      n = find_spans(w, from, (int32_t)((int64_t)w->n * (thread + 1) / threads));
#pragma omp barrier
        fall_asleep(w, from, n);
#pragma omp barrier
        look_round_all(w, from, n);
    }
}

void fl_sleep_lull(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    for (int32_t k = 0; k < w->n && s->resting; k++)
        if (s->kind[k] == FL_RESTS && w->step >= s->until[k]) wake(w, k);
    lull_all(w);
    if (w->step % WINDOW == 0) let_rest(w);
}
