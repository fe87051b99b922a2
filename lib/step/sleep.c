/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/mem.h"
#include "body/integrate.h"
#include "step/sleep.h"
#include "step/step.h"
#include "step/works.h"

enum {
    WINDOW = 64,      /* steps over which it is seen whether a floe rests */
    LEAST = 4,        /* steps: a shorter sleep is not worth while */
    MOST = 1 << 14,   /* steps: doubling ends here */
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
    s->image = fl_alloc(w->n, sizeof *s->image, err);
    s->stack = fl_alloc(w->n, sizeof *s->stack, err);
    if (!s->nap || !s->kind || !s->image || !s->stack) return -1;
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
    *nap = (fl_nap){.span = LEAST,
                    .mark = -1.0,
                    .off = nap->off,
                    .summed = nap->summed,
                    .coasted = nap->coasted,
                    .naps = nap->naps,
                    .rested = nap->rested};
    w->sleep.kind[i] = FL_AWAKE;
}

double fl_sleep_bytes(const fl_world *w)
{
    const fl_sleep *s = &w->sleep;
    return s->nap ? (double)w->n *
                        (double)(sizeof *s->nap + sizeof *s->image + sizeof *s->kind + sizeof *s->stack)
                  : 0.0;
}

void fl_sleep_free(fl_sleep *s)
{
    free(s->nap), free(s->kind), free(s->image), free(s->stack);
    *s = (fl_sleep){0};
}

/* --- who coasts -------------------------------------------------------------------------------- */

/* The floe k over s seconds by what acts at the begin: weight, water, springs, wind.  First half ... */
static void out(fl_world *w, int32_t k, double s)
{
    fl_nap *nap = &w->sleep.nap[k];
    fl_body_rates(&w->b, k, &nap->a, &nap->turn);
    fl_step_out(w, k, s);
}

/* How far drag of h seconds changes the speed of a point of floe k, over h. */
static double drag(fl_world *w, int32_t k, double h)
{
    const fl_bodies *b = &w->b;
    const fl_vec3 v = b->v[k], spin = b->w[k];
    if (!w->sea.n) return 0.0;
    fl_sea_drag(&w->sea, &w->b, k, h, 1);
    return (v3_norm(v3_sub(b->v[k], v)) + b->bound[k] * v3_norm(v3_sub(b->w[k], spin))) / h;
}

/* ... and second, where forces of now are those that stay; returns what it is off by [m]. */
static double back(fl_world *w, int32_t k, double s)
{
    fl_nap *nap = &w->sleep.nap[k];
    fl_bodies *b = &w->b;
    fl_vec3 a, turn;
    fl_body_rates(b, k, &a, &turn);
    fl_step_kick(w, k, 0.5 * s);
    const double slowed = nap->drag, r = b->bound[k], turned = v3_norm(b->w[k]) * s;
    nap->drag = drag(w, k, 0.5 * s);
    return s * s / 12.0 *
               (v3_norm(v3_sub(a, nap->a)) + r * v3_norm(v3_sub(turn, nap->turn)) +
                fabs(nap->drag - slowed)) +
           r * turned * turned * turned / 12.0;
}

/* The bound of the path of floe k over s seconds from now on. */
static double way_of(const fl_world *w, int32_t k, double s)
{
    const fl_bodies *b = &w->b;
    const double r = b->bound[k], least = 1.0 / fl_body_ease(b, k);
    fl_vec3 a, turn;
    fl_body_rates(b, k, &a, &turn);
    double torque = v3_norm(b->t[k]);
    if (b->added) {
        const fl_vec3 u = v3_sub(b->v[k], b->flow[k]);
        torque += v3_norm(fl_body_momentum(b, k, u)) * v3_norm(u);
    }
    return s * (v3_norm(b->v[k]) + r * v3_norm(b->L[k]) / least) +
           s * s * (0.5 * (v3_norm(a) + r * torque / least) + w->sleep.nap[k].drag);
}

static double seconds(const fl_world *w, int32_t k)
{
    return (double)(w->step - w->sleep.nap[k].since) * w->dt;
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

static int may_touch(const fl_world *w, int32_t k)
{
    for (int64_t c = w->inc_first[k]; c < w->inc_first[k + 1]; c++) {
        if (!fl_world_apart(w, &w->pair[w->inc[c]])) return 1;
    }
    return 0;
}

void fl_sleep_rouse(fl_world *w)
{
    fl_sleep *s = &w->sleep;
#pragma omp parallel for schedule(static)
    for (int32_t k = 0; k < w->n; k++)
        if (s->kind[k] == FL_COASTS && (w->step >= s->nap[k].until || may_touch(w, k) || may_have_left(w, k)))
            s->kind[k] = FL_ENDS;
            /* only now: a way that is gone is for a moment twice in the odometer, which others have looked at
             */
#pragma omp parallel for schedule(dynamic, 16)
    for (int32_t k = 0; k < w->n; k++) {
        if (s->kind[k] != FL_ENDS) continue;
        const double odometer = w->b.odometer[k];
        out(w, k, seconds(w, k));
        w->b.odometer[k] = odometer; /* the way of all of it is in it */
    }
}

void fl_sleep_end(fl_world *w, int32_t k)
{
    fl_nap *nap = &w->sleep.nap[k];
    const double s = seconds(w, k), most = w->sleep.tol * w->b.radius[k];
    const int whole = w->step >= nap->until;
    fl_step_soft(w, k);
    const double off = back(w, k, s);
    nap->off = fmax(nap->off, off / w->b.radius[k]);
    nap->summed += off / w->b.radius[k];
    const double ratio = off > 0.0 ? cbrt(0.5 * most / off) : 2.0; /* off goes with the third power of s */
    const double span = (double)(w->step - nap->since) * (ratio < 2.0 ? ratio : 2.0);
    if (whole || span < nap->span) nap->span = span < LEAST ? LEAST : span > MOST ? MOST : (int32_t)span;
    nap->coasted += w->step - nap->since;
    nap->naps++;
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

/* The time for which a step of floe k stays within the tolerance whatever it meets [s].  What acts smoothly
 * pulls a point back with no more than omega^2 = rho g A (1/m + r^2/2I), A the largest area that the water
 * cuts out of it, at most half of its surface, and springs; so it changes by no more than omega^2 times the
 * way of its points against the surface of the water, at a speed u that grows by their acceleration a: the
 * step is off by up to s^3/12 omega^2 (u + s a).  Three quarters of the tolerance for that, a quarter for
 * turns. */
static double within(const fl_world *w, int32_t k)
{
    const fl_bodies *b = &w->b;
    const double r = b->bound[k] + b->radius[k], most = w->sleep.tol * b->radius[k],
                 least = 1.0 / fl_body_ease(b, k);
    const fl_vec3 v = b->v[k], spin = b->w[k];
    double drawn, stiff = fl_world_spring(w, k, &drawn) * b->invm[k], s = INFINITY;
    if (w->sea.water)
        stiff += 0.5 * w->sea.weight * w->sea.hull[k].surface * (b->invm[k] + 0.5 * r * r / least);
    fl_vec3 a, turn;
    fl_body_rates(b, k, &a, &turn);
    const double u = fabs(v.z) + r * hypot(spin.x, spin.y) + w->sleep.rise + w->sleep.slope * hypot(v.x, v.y),
                 faster = v3_norm(a) + r * v3_norm(b->t[k]) / least, turned = v3_norm(b->L[k]) / least;
    if (stiff > 0.0) {
        const double c = 9.0 * most / stiff;
        if (u > 0.0) s = cbrt(c / u);
        if (faster > 0.0) s = fmin(s, sqrt(sqrt(c / faster)));
        if (s < INFINITY) s = cbrt(c / (u + s * faster)); /* by one that is too long: not too long */
    }
    if (turned > 0.0) s = fmin(s, cbrt(3.0 * most / r) / turned);
    return s;
}

/* How long, in steps, floe k may coast from now on before it could touch a neighbour that goes on as it does.
 */
static double time_left(const fl_world *w, int32_t k, double left, double speed)
{
    const fl_bodies *b = &w->b;
    for (int64_t c = w->inc_first[k]; c < w->inc_first[k + 1]; c++) {
        const fl_near *p = &w->pair[w->inc[c]];
        const int32_t o = p->i == k ? p->j : p->i;
        const double other = v3_norm(b->v[o]) + b->bound[o] * v3_norm(b->w[o]),
                     gap = p->asleep - b->odometer[p->i] - b->odometer[p->j];
        if (p->n || gap <= 0.0) return 0.0;
        if ((speed + other) * w->dt * left > gap) left = gap / ((speed + other) * w->dt);
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

/* Steps that floe k may coast from now on; 0: none. */
static int32_t span_of(const fl_world *w, int32_t k)
{
    if (w->sleep.kind[k] != FL_AWAKE || fl_works_now(w, k)->n || fl_works_was(w, k)->n || !may_sleep(w, k))
        return 0;
    double left = fmin(w->sleep.nap[k].span, within(w, k) / w->dt);
    if (left < LEAST) return 0;
    left = time_left(w, k, left, way_of(w, k, left * w->dt) / (left * w->dt));
    return left < LEAST ? 0 : (int32_t)left;
}

static void let_coast(fl_world *w, int32_t k, int32_t span)
{
    fl_nap *nap = &w->sleep.nap[k];
    w->sleep.kind[k] = FL_COASTS;
    nap->since = w->step;
    nap->until = w->step + span;
    nap->way = way_of(w, k, span * w->dt) * (1.0 + 1e-9);
    nap->mark = -1.0;
    w->b.odometer[k] += nap->way;
}

/* --- looked at -------------------------------------------------------------------------------- */

void fl_sleep_look(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    const fl_bodies *b = &w->b;
    if (!s->nap) return;
#pragma omp parallel for schedule(dynamic, 16)
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
        const double t = seconds(w, k);
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

static int still(const fl_world *w, int32_t j)
{
    return j >= w->n && (w->ride.m.n == 0 || w->ride.of[j - w->n] < 0) &&
           !(w->press.panels && j < w->n + w->pieces);
}

int fl_sleep_frozen(const fl_world *w, const fl_near *p)
{
    if (p->n == 0 || fl_sleep_kind(w, p->i) != FL_RESTS) return 0;
    return p->j >= w->n ? still(w, p->j) : fl_sleep_kind(w, p->j) == FL_RESTS;
}

static void rise(fl_world *w, int32_t k)
{
    fl_sleep *s = &w->sleep;
    fl_nap *nap = &s->nap[k];
    if (s->kind[k] == FL_RESTS) {
        s->resting--;
        nap->rested += w->step - nap->since;
    }
    s->kind[k] = FL_AWAKE;
    nap->mark = -1.0;
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
        else if (rests && p->j >= w->n && !still(w, p->j)) wake(w, p->i);
    }
}

void fl_sleep_wake(fl_world *w)
{
    for (int32_t k = 0; k < w->n && w->sleep.nap; k++)
        if (w->sleep.kind[k] == FL_RESTS) rise(w, k);
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
        if (!seen || path > 0.25 * most || !may_sleep(w, k) || fl_works_now(w, k)->n == 0) continue;
        const double windows = path > 0.0 ? sqrt(most / path) : LONGEST;
        nap->since = w->step;
        nap->until = w->step + WINDOW * (int64_t)(windows < LONGEST ? windows : LONGEST);
        s->kind[k] = FL_QUIET;
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
            if (o >= w->n ? still(w, o) : s->kind[o] != FL_AWAKE) continue;
            s->kind[k] = FL_AWAKE;
            s->stack[n++] = k;
        }
    }
    spread(w, n, FL_QUIET);
    for (int32_t k = 0; k < w->n; k++) {
        if (s->kind[k] != FL_QUIET) continue;
        s->kind[k] = FL_RESTS;
        s->resting++;
    }
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

void fl_sleep_lull(fl_world *w)
{
    fl_sleep *s = &w->sleep;
    for (int32_t k = 0; k < w->n && s->resting; k++)
        if (s->kind[k] == FL_RESTS && w->step >= s->nap[k].until) wake(w, k);
#pragma omp parallel for schedule(static)
    for (int32_t k = 0; k < w->n; k++) s->stack[k] = span_of(w, k); /* all by the same odometers */
#pragma omp parallel for schedule(static)
    for (int32_t k = 0; k < w->n; k++)
        if (s->stack[k]) let_coast(w, k, s->stack[k]);
    if (w->step % WINDOW == 0) let_rest(w);
}
