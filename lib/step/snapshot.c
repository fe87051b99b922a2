/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/mem.h"
#include "base/par.h"
#include "out/relay.h"
#include "sim/setup.h"
#include "step/balls.h"
#include "step/frozen.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "step/press.h"
#include "step/ride.h"
#include "step/search.h"
#include "step/sleep.h"
#include "step/snapshot.h"
#include "step/snapshot_pair.h"
#include "step/traffic.h"
#include "step/works.h"

static void books(fl_relay *t, fl_world *w)
{
    fl_ledger *g = &w->ledger;
    fl_relay_open(t, "books");
    fl_relay_real(t, &g->start);
    fl_relay_real(t, &g->residual);
    fl_relay_real(t, &g->throughput);
    fl_relay_real(t, &g->friction);
    fl_relay_real(t, &g->damping);
    fl_relay_real(t, &g->drive);
    fl_relay_real(t, &g->carried);
    fl_relay_vec3(t, &w->imbalance);
    fl_relay_real(t, &w->impulse_size);
    fl_relay_real(t, &w->worst_overlap);
    fl_relay_whole(t, -1, INT32_MAX, &w->worst_i);
    fl_relay_whole(t, -INT32_MAX, INT32_MAX, &w->worst_j);
    fl_relay_real(t, &w->worst_time);
    fl_relay_count(t, &w->half_steps);
    fl_relay_whole(t, -INT32_MAX, INT32_MAX, &w->half_i);
    fl_relay_whole(t, -INT32_MAX, INT32_MAX, &w->half_j);
    fl_relay_real(t, &w->half_time);
    fl_relay_count(t, &w->touching_steps);
    fl_relay_count(t, &w->searches);
    fl_relay_count(t, &w->deep_pairs);
    fl_relay_count(t, &w->deep_count.asked);
    fl_relay_count(t, &w->deep_count.none);
    fl_relay_count(t, &w->deep_count.poor);
    fl_relay_count(t, &w->deep_count.capped);
    fl_relay_close(t);
}

static void told(fl_relay *t, fl_world *w)
{
    fl_surrogate_count all = fl_surrogate_sum(w->told, w->threads);
    fl_relay_open(t, "told");
    fl_relay_count(t, &all.told);
    fl_relay_count(t, &all.looked);
    fl_relay_count(t, &all.off);
    fl_relay_real(t, &all.worst);
    fl_relay_close(t);
    if (!t->in || t->err->code) return;
    for (int32_t k = 0; k < w->threads; k++) w->told[k] = (fl_surrogate_count){0};
    w->told[0] = all;
}

/* Who has come and gone, and who stands in which place: a floe that came in is made again before its body is
 * read. */
static void coming(fl_relay *t, fl_world *w)
{
    fl_traffic *c = &w->traffic;
    const int32_t feed = c->feed ? c->feed->n : 0;
    fl_relay_open(t, "traffic");
    fl_relay_count(t, &c->left);
    fl_relay_count(t, &c->entered);
    fl_relay_real(t, &c->mass_left);
    fl_relay_real(t, &c->mass_entered);
    fl_relay_vec3(t, &c->momentum_left);
    fl_relay_vec3(t, &c->momentum_entered);
    fl_relay_whole(t, 0, INT32_MAX, &c->next_id);
    fl_relay_count(t, &c->waited);
    fl_relay_count(t, &c->missed);
    fl_relay_close(t);
    for (int32_t k = 0; k < feed && !t->err->code; k++) {
        fl_relay_open(t, "next");
        fl_relay_count(t, &c->tile[k]);
        fl_relay_close(t);
    }
    for (int32_t i = 0; i < w->n && !t->err->code; i++) {
        int32_t floe = c->floe[i], id = w->id[i];
        uint8_t guided = c->guided[i];
        fl_relay_open(t, "place");
        fl_relay_byte(t, 1, &c->away[i]);
        fl_relay_whole(t, -1, feed - 1, &floe);
        fl_relay_whole(t, 0, INT32_MAX, &id);
        fl_relay_count(t, &c->born[i]);
        fl_relay_byte(t, 1, &guided);
        fl_relay_close(t);
        if (t->f || t->err->code) continue;
        if (floe != c->floe[i] && (!c->feed || (floe < 0 && i >= c->ice->n))) {
            fl_text_fail(t->in, t->err, "place %d has no floe of its own", i);
            continue;
        }
        const int other = floe != c->floe[i];
        fl_traffic_guide(w, i, 0); /* who was in a state before */
        c->floe[i] = floe;
        if (other && fl_world_put(w, i, floe < 0 ? c->ice : c->feed, floe < 0 ? i : floe, t->err)) continue;
        w->id[i] = id;
        fl_traffic_guide(w, i, guided);
    }
}

/* What moves it, to the last bit: the spin is not always what L and q give. */
static void motion(fl_relay *t, fl_bodies *b, int32_t k)
{
    fl_relay_vec3(t, &b->x[k]);
    fl_relay_vec3(t, &b->v[k]);
    fl_relay_vec3(t, &b->L[k]);
    fl_relay_quat(t, &b->q[k]);
    fl_relay_vec3(t, &b->w[k]);
    fl_relay_vec3(t, &b->f[k]);
    fl_relay_vec3(t, &b->t[k]);
    fl_relay_real(t, &b->held[k]);
}

static void body(fl_relay *t, fl_world *w, int32_t k)
{
    fl_bodies *b = &w->b;
    fl_relay_open(t, "body");
    motion(t, b, k);
    if (b->added) fl_relay_real(t, &b->carried[k]);
    fl_relay_real(t, &b->odometer[k]);
    fl_relay_real(t, &w->odometer_found[k]);
    fl_relay_close(t);
}

/* The table of the current is not kept, but it must be the one that the run had. */
static void table_of(fl_relay *t, const fl_current *c)
{
    const uint64_t bits = fl_hash(FL_HASH_START, c->z, c->n * (int64_t)sizeof *c->z);
    fl_relay_open(t, "current");
    if (fl_relay_hash(t, fl_hash(bits, c->u, c->n * (int64_t)sizeof *c->u)))
        fl_text_fail(t->in, t->err, "the rows of water.profile_file are not those that the run had");
    fl_relay_close(t);
}

/* Who sleeps, and since when. */
static void nap(fl_relay *t, fl_world *w, int32_t k)
{
    fl_nap *n = &w->sleep.nap[k];
    fl_relay_open(t, "nap");
    fl_relay_byte(t, FL_RESTS, &w->sleep.kind[k]);
    fl_relay_count(t, &n->since);
    fl_relay_count(t, &w->sleep.until[k]);
    fl_relay_real(t, &n->way);
    fl_relay_real(t, &n->mark);
    fl_relay_real(t, &n->drag);
    fl_relay_real(t, &n->off);
    fl_relay_real(t, &n->summed);
    fl_relay_count(t, &n->coasted);
    fl_relay_count(t, &n->rested);
    fl_relay_count(t, &n->naps);
    fl_relay_whole(t, 1, INT32_MAX, &n->span);
    fl_relay_close(t);
    if (t->in && !t->err->code && (n->since > w->step || n->way < 0.0))
        fl_text_fail(t->in, t->err, "body %d sleeps since step %g of %g", w->id[k], (double)n->since,
                     (double)w->step);
}

static void sea(fl_relay *t, fl_sea *s, const fl_bodies *b, int32_t i)
{
    double energy = s->water && !s->waves ? fl_sea_energy(s, b, i) : 0.0,
           none = 0.0; /* told, and not needed */
    fl_relay_open(t, "sea");
    fl_relay_real(t, &s->wetted[i]);
    fl_relay_real(t, &s->lift[i]);
    fl_relay_real(t, &energy);
    fl_relay_real(t, &s->drained[i]);
    fl_relay_real(t, s->blown ? &s->blown[i] : &none);
    if (s->waves) fl_relay_real(t, &s->waved[i]);
    if (s->held) {
        fl_sea_held *h = &s->held[i];
        fl_relay_vec3(t, &h->df), fl_relay_vec3(t, &h->dt), fl_relay_vec3(t, &h->dflow);
        fl_relay_real(t, &h->dz), fl_relay_real(t, &h->dslope);
        fl_relay_pose(t, &h->x, &h->q);
        fl_relay_real(t, &h->when);
    }
    fl_relay_close(t);
}

/* The track is read again from its file, so its hash stands for it. */
static void mover(fl_relay *t, fl_world *w, int32_t k)
{
    fl_movers *m = &w->ride.m;
    fl_bodies *b = &m->b;
    const fl_track *tr = &m->motion[k].track;
    uint64_t bits = FL_HASH_START;
    if (tr->n)
        bits = fl_hash(fl_hash(bits, tr->t, tr->n * (int64_t)sizeof *tr->t), tr->at,
                       tr->n * (int64_t)sizeof *tr->at);
    fl_relay_open(t, "mover");
    if (fl_relay_hash(t, bits))
        fl_text_fail(t->in, t->err, "the rows of the track of %s are not those that the run had",
                     fl_ride_name(w, k));
    motion(t, b, k);
    fl_relay_vec3(t, &m->anchor[k]);
    fl_relay_vec3(t, &m->pull[k]);
    fl_relay_vec3(t, &m->spring[k]);
    fl_relay_vec3(t, &m->twist[k]);
    fl_relay_real(t, &m->stored[k]);
    fl_relay_real(t, &m->damped[k]);
    fl_relay_real(t, &m->given[k]);
    fl_relay_close(t);
}

/* Where the ice pressed last, and what the panels and events of the interval have so far. */
static void mark(fl_relay *t, fl_world *w, fl_press_mark *m)
{
    fl_relay_open(t, "mark");
    fl_relay_whole(t, 0, w->n - 1, &m->i);
    fl_relay_whole(t, 0, w->parts - 1, &m->part);
    fl_relay_whole(t, 0, w->press.panels - 1, &m->panel);
    fl_relay_vec3(t, &m->f);
    fl_relay_vec3(t, &m->n);
    fl_relay_vec3(t, &m->at);
    fl_relay_real(t, &m->normal);
    fl_relay_real(t, &m->area);
    fl_relay_real(t, &m->overlap);
    fl_relay_close(t);
}

static void event(fl_relay *t, fl_world *w, fl_press_event *e)
{
    fl_relay_open(t, "event");
    fl_relay_whole(t, INT32_MIN, INT32_MAX, &e->id);
    fl_relay_whole(t, 0, w->parts - 1, &e->part);
    fl_relay_vec3(t, &e->impulse);
    fl_relay_vec3(t, &e->across);
    fl_relay_vec3(t, &e->at);
    fl_relay_real(t, &e->weight);
    fl_relay_real(t, &e->area);
    fl_relay_real(t, &e->overlap);
    fl_relay_close(t);
}

static void pressed(fl_relay *t, fl_world *w)
{
    fl_press *s = &w->press;
    int32_t panels = s->panels, loaded = 0;
    for (int32_t k = 0; k < s->panels; k++) loaded += v3_norm2(s->impulse[k]) > 0.0;
    fl_relay_open(t, "pressed");
    fl_relay_whole(t, s->panels, s->panels, &panels);
    fl_relay_whole(t, 0, s->panels, &loaded);
    fl_relay_whole(t, 0, INT32_MAX, &s->n_now);
    fl_relay_whole(t, 0, INT32_MAX, &s->events);
    fl_relay_close(t);
    const int32_t marks = s->n_now, events = s->events;
    if (t->in) s->n_now = s->events = 0;
    if (t->in && !t->err->code) fl_press_panels_end(w);
    for (int32_t c = 0, k = -1; c < loaded && !t->err->code; c++) {
        if (t->f) do
                k++;
            while (!(v3_norm2(s->impulse[k]) > 0.0));
        fl_relay_open(t, "panel");
        fl_relay_whole(t, k < 0 ? 0 : k, s->panels - 1, &k);
        if (!t->err->code) fl_relay_vec3(t, &s->impulse[k]);
        fl_relay_close(t);
    }
    for (int32_t k = 0; k < marks && !t->err->code; k++) { /* the numbers are hints: room comes as rows do */
        if (t->in && fl_grow(&s->now, &s->now_cap, (int64_t)k + 1, sizeof *s->now, t->err)) return;
        if (t->in) s->now[k] = (fl_press_mark){0};
        mark(t, w, &s->now[k]);
        s->n_now = k + 1;
    }
    for (int32_t k = 0; k < events && !t->err->code; k++) {
        if (t->in && fl_grow(&s->event, &s->event_cap, (int64_t)k + 1, sizeof *s->event, t->err)) return;
        if (t->in) s->event[k] = (fl_press_event){0};
        event(t, w, &s->event[k]);
        s->events = k + 1;
    }
}

/* A bond: its past, and what acts of it.  Separations follow from where the bodies are; the face and its law
 * from the scene. */
static void bond(fl_relay *t, fl_world *w, int32_t k)
{
    fl_bond *c = &w->frozen.bond[k];
    fl_vec3 *const all[] = {&c->f, &c->ti, &c->tj, &c->fd, &c->di, &c->dj, &c->fs, &c->si, &c->sj};
    fl_relay_open(t, "bond");
    fl_relay_whole(t, FL_BOND_WHOLE, FL_BOND_ENDED, &c->state);
    fl_relay_real(t, &c->held);
    fl_relay_real(t, &c->worn);
    fl_relay_real(t, &c->spent);
    fl_relay_real(t, &c->handed);
    fl_relay_real(t, &c->store);
    fl_relay_real(t, &c->spring);
    fl_relay_real(t, &w->frozen.keep[k]);
    for (int e = 0; e < 9; e++) fl_relay_vec3(t, all[e]);
    for (int e = 0; e < FL_BOND_POINTS; e++) {
        fl_bond_point *p = &c->point[e];
        if (t->in) *p = (fl_bond_point){0};
        if (c->state == FL_BOND_WHOLE || t->err->code) continue;
        fl_relay_real(t, &p->d);
        fl_relay_real(t, &p->first);
        fl_relay_real(t, &p->last);
        fl_relay_real(t, &p->slip[0]);
        fl_relay_real(t, &p->slip[1]);
        if (t->in && !t->err->code && !(p->d >= 0.0 && p->d <= 1.0 && p->first >= 0.0 && p->last >= p->first))
            fl_text_fail(t->in, t->err, "damage %g between %g and %g is none of a bond", p->d, p->first,
                         p->last);
    }
    fl_relay_close(t);
}

/* Everything but the pairs, whose number the first row tells. */
static int32_t all_but_pairs(fl_relay *t, fl_world *w, int32_t *balls)
{
    int32_t parts = w->parts, total = w->b.total, n_sea = w->sea.n, pairs = w->n_pair;
    *balls = fl_balls_rows(w);
    fl_relay_open(t, "world");
    fl_relay_count(t, &w->step);
    fl_relay_count(t, &w->found_at);
    fl_relay_real(t, &w->dt);
    fl_relay_real(t, &w->t0);
    fl_relay_count(t, &w->step0);
    fl_relay_real(t, &w->sea.time);
    fl_relay_real(t, &w->skin);
    fl_relay_real(t, &w->dt_critical);
    fl_relay_real(t, &w->dt_touching);
    fl_relay_whole(t, -1, w->b.total + w->ride.m.n - 1, &w->critical_body);
    fl_relay_real(t, &w->dt_safe);
    fl_relay_whole(t, w->parts, w->parts, &parts);
    fl_relay_whole(t, w->b.total, w->b.total, &total);
    fl_relay_whole(t, w->sea.n, w->sea.n, &n_sea);
    fl_relay_whole(t, 0, INT32_MAX, &pairs);
    fl_relay_whole(t, 0, INT32_MAX, balls);
    fl_relay_close(t);
    if (t->in && !t->err->code &&
        !(w->step >= 0 && w->dt > 0.0 && isfinite(w->dt) && w->skin >= 0.0 && w->t0 >= 0.0 &&
          isfinite(w->t0) && w->step0 >= 0 && w->step0 <= w->step &&
          fabs(w->sea.time - fl_world_time(w)) < 0.5 * w->dt)) /* a new step may begin a rounding before */
        fl_text_fail(t->in, t->err, "step %g of %g s is no state of a run", (double)w->step, w->dt);
    books(t, w);
    if (w->told) told(t, w);
    for (int32_t p = 0; p < w->parts && !t->err->code; p++) {
        fl_relay_open(t, "part");
        fl_relay_vec3(t, &w->part_impulse[p]);
        fl_relay_vec3(t, &w->part_moment[p]);
        fl_relay_real(t, &w->part_peak[p]);
        fl_relay_close(t);
    }
    if (w->traffic.away && !t->err->code) coming(t, w);
    for (int32_t k = 0; k < w->b.total && !t->err->code; k++) body(t, w, k);
    if (t->in) w->sleep.resting = 0;
    for (int32_t k = 0; k < w->n && w->sleep.nap && !t->err->code; k++) {
        nap(t, w, k);
        if (t->in) w->sleep.resting += w->sleep.kind[k] == FL_RESTS;
    }
    for (int32_t k = 0; k < w->ride.m.n && !t->err->code; k++) mover(t, w, k);
    for (int32_t k = 0; k < w->frozen.n && !t->err->code; k++) bond(t, w, k);
    if (t->in && !t->err->code) fl_frozen_look(w);
    if (w->press.panels && !t->err->code) pressed(t, w);
    const double seen = w->sea.time;
    if (w->sea.current.n) table_of(t, &w->sea.current);
    for (int32_t i = 0; i < w->sea.n && !t->err->code; i++) {
        sea(t, &w->sea, &w->b, i);
        if (t->in && !t->err->code && w->sea.held && !fl_world_away(w, i) && !(w->sea.held[i].when <= seen))
            fl_text_fail(t->in, t->err, "a look at the water at %g s is none that has been",
                         w->sea.held[i].when);
        if (!t->in || t->err->code || fl_world_away(w, i)) continue;
        if (fl_sleep_kind(w, i) != FL_AWAKE) /* what it meets is of then */
            w->sea.time = fl_sleep_since(w, i);
        fl_sea_renew(&w->sea, &w->b, i);
        w->sea.time = seen;
    }
    return pairs;
}

void fl_snapshot_write(FILE *f, fl_world *w)
{
    fl_err none = {0};
    fl_relay t = {.f = f, .err = &none};
    int32_t balls;
    all_but_pairs(&t, w, &balls);
    for (int32_t c = 0; c < w->n_pair; c++) fl_snapshot_pair(&t, w, c);
    fl_ball_walk at = {0};
    for (int32_t c = 0; c < balls; c++) fl_snapshot_ball(&t, w, fl_ball_next(w, &at), NULL);
}

int fl_snapshot_read(fl_world *w, fl_text *in, fl_err *err)
{
    fl_relay t = {.in = in, .err = err};
    int32_t cap = 0, balls, last[2] = {-1, -1};
    const int32_t pairs = all_but_pairs(&t, w, &balls);
    fl_near_free(w);
    /* The number is a hint: room comes as rows do. */
    for (int32_t c = 0; c < pairs && !err->code; c++) {
        if (fl_grow(&w->pair, &cap, (int64_t)c + 1, sizeof *w->pair, err)) return -1;
        w->pair[c] = (fl_near){0};
        fl_snapshot_pair(&t, w, c);
        w->n_pair = c + 1;
    }
    w->balls.n = w->balls.leans = 0;
    for (int32_t c = 0; c < balls && !err->code; c++) fl_snapshot_ball(&t, w, c, last);
    if (err->code) return -1;
    const int more = fl_text_row(in, err);
    if (more > 0) fl_text_fail(in, err, "\"%.40s\" behind the last pair was not expected", in->field[0]);
    if (more) return -1;
    if (w->ride.m.n) fl_ride_ready(w);
    if ((fl_balls_rows(w) || w->balls.bodies) && fl_balls_index(w, err)) return -1;
    if (fl_search_index(w, err)) return -1;
    fl_sleep_resume(w);
    for (int32_t k = 0; k < w->b.total; k++) fl_works_sum(w, k);
    return 0;
}
