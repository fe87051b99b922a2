/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include <string.h>
#include "base/mem.h"
#include "base/par.h"
#include "step/balls.h"
#include "step/frozen.h"
#include "step/interact.h"
#include "step/pairing.h"
#include "step/press.h"
#include "step/ride.h"
#include "step/search.h"
#include "step/sleep.h"
#include "step/snapshot.h"
#include "step/works.h"

/* A state on its way out (f) or in (in): one list of members serves both, so that they cannot differ. */
typedef struct {
    FILE *f;
    fl_text *in;
    fl_err *err;
} traffic;

static int hex(const char *word, uint64_t *bits)
{
    *bits = 0;
    for (int k = 0; word[k]; k++) {
        const char c = word[k];
        const int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
        if (digit < 0 || k == 16) return -1;
        *bits = *bits << 4 | (uint64_t)digit;
    }
    return 0;
}

static void real(traffic *t, double *x)
{
    uint64_t bits;
    const char *word = "";
    if (t->f) {
        char text[18], *p = text + sizeof text;
        memcpy(&bits, x, sizeof bits);
        *--p = '\0';
        do *--p = "0123456789abcdef"[bits & 15];
        while (bits >>= 4);
        *--p = ' ';
        fputs(p, t->f);
        return;
    }
    if (t->err->code || fl_text_word(t->in, "number", &word, t->err)) return;
    if (hex(word, &bits))
        fl_text_fail(t->in, t->err, "\"%.40s\" found, the digits of a double were wanted", word);
    else memcpy(x, &bits, sizeof bits);
    if (isnan(*x)) fl_text_fail(t->in, t->err, "not a number");
}

static void whole(traffic *t, int32_t lo, int32_t hi, int32_t *x)
{
    if (t->f) fprintf(t->f, " %" PRId32, *x);
    else if (!t->err->code) fl_text_i32(t->in, "whole number", lo, hi, x, t->err);
}

static void count(traffic *t, int64_t *x)
{
    const char *word = "";
    char *end;
    if (t->f) {
        fprintf(t->f, " %" PRId64, *x);
        return;
    }
    if (t->err->code || fl_text_word(t->in, "count", &word, t->err)) return;
    const long long n = strtoll(word, &end, 10);
    if (*end || n < -1 || n > INT64_C(1) << 62)
        fl_text_fail(t->in, t->err, "\"%.40s\" found, a count was wanted", word);
    else *x = n;
}

static void vec3(traffic *t, fl_vec3 *x)
{
    real(t, &x->x);
    real(t, &x->y);
    real(t, &x->z);
}

static void open_row(traffic *t, const char *name)
{
    const char *word = "";
    if (t->f) {
        fputs(name, t->f);
        return;
    }
    if (t->err->code) return;
    const int more = fl_text_row(t->in, t->err);
    if (more < 0) return;
    if (!more) fl_text_fail(t->in, t->err, "the state ends early, %s was wanted", name);
    else if (fl_text_word(t->in, "name of the row", &word, t->err) == 0 && strcmp(word, name) != 0)
        fl_text_fail(t->in, t->err, "\"%.40s\" found, %s was wanted", word, name);
}

static void close_row(traffic *t)
{
    if (t->f) putc('\n', t->f);
    else if (!t->err->code) fl_text_end(t->in, t->err);
}

/* --- the rows ---------------------------------------------------------------------------------- */

static void books(traffic *t, fl_world *w)
{
    fl_ledger *g = &w->ledger;
    open_row(t, "books");
    real(t, &g->start);
    real(t, &g->residual);
    real(t, &g->throughput);
    real(t, &g->friction);
    real(t, &g->damping);
    real(t, &g->drive);
    real(t, &g->carried);
    vec3(t, &w->imbalance);
    real(t, &w->impulse_size);
    real(t, &w->worst_overlap);
    whole(t, -1, INT32_MAX, &w->worst_i);
    whole(t, -INT32_MAX, INT32_MAX, &w->worst_j);
    real(t, &w->worst_time);
    count(t, &w->half_steps);
    whole(t, -INT32_MAX, INT32_MAX, &w->half_i);
    whole(t, -INT32_MAX, INT32_MAX, &w->half_j);
    real(t, &w->half_time);
    count(t, &w->touching_steps);
    count(t, &w->searches);
    count(t, &w->deep_pairs);
    count(t, &w->deep_count.asked);
    count(t, &w->deep_count.none);
    count(t, &w->deep_count.poor);
    count(t, &w->deep_count.capped);
    close_row(t);
}

static void told(traffic *t, fl_world *w)
{
    fl_surrogate_count all = fl_surrogate_sum(w->told, w->threads);
    open_row(t, "told");
    count(t, &all.told);
    count(t, &all.looked);
    count(t, &all.off);
    real(t, &all.worst);
    close_row(t);
    if (!t->in || t->err->code) return;
    for (int32_t k = 0; k < w->threads; k++) w->told[k] = (fl_surrogate_count){0};
    w->told[0] = all;
}

static void byte(traffic *t, uint8_t hi, uint8_t *x)
{
    int32_t whole_one = *x;
    whole(t, 0, hi, &whole_one);
    *x = (uint8_t)whole_one;
}

/* Who has come and gone, and who stands in which place: a floe that came in is made again before its body is
 * read. */
static void coming(traffic *t, fl_world *w)
{
    fl_traffic *c = &w->traffic;
    const int32_t feed = c->feed ? c->feed->n : 0;
    open_row(t, "traffic");
    count(t, &c->left);
    count(t, &c->entered);
    real(t, &c->mass_left);
    real(t, &c->mass_entered);
    vec3(t, &c->momentum_left);
    vec3(t, &c->momentum_entered);
    whole(t, 0, INT32_MAX, &c->next_id);
    count(t, &c->waited);
    count(t, &c->missed);
    close_row(t);
    for (int32_t k = 0; k < feed && !t->err->code; k++) {
        open_row(t, "next");
        count(t, &c->tile[k]);
        close_row(t);
    }
    for (int32_t i = 0; i < w->n && !t->err->code; i++) {
        int32_t floe = c->floe[i], id = w->id[i];
        open_row(t, "place");
        byte(t, 1, &c->away[i]);
        whole(t, -1, feed - 1, &floe);
        whole(t, 0, INT32_MAX, &id);
        count(t, &c->born[i]);
        byte(t, 1, &c->guided[i]);
        close_row(t);
        if (t->f || t->err->code) continue;
        if (floe != c->floe[i] && (!c->feed || (floe < 0 && i >= c->ice->n))) {
            fl_text_fail(t->in, t->err, "place %d has no floe of its own", i);
            continue;
        }
        const int other = floe != c->floe[i];
        c->floe[i] = floe;
        if (other && fl_world_put(w, i, floe < 0 ? c->ice : c->feed, floe < 0 ? i : floe, t->err)) continue;
        w->id[i] = id;
        c->hold[i] = w->b.hold[i];
        if (c->guided[i]) w->b.hold[i] = FL_HOLD_X | FL_HOLD_Y | FL_HOLD_RZ;
    }
}

/* Where something stands; a state that was told holds a turn, to rounding. */
static void pose(traffic *t, fl_vec3 *x, fl_quat *q)
{
    vec3(t, x);
    real(t, &q->w);
    real(t, &q->x);
    real(t, &q->y);
    real(t, &q->z);
    const double size = q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z;
    if (t->in && !t->err->code && !(v3_finite(*x) && fabs(size - 1.0) < 1e-9))
        fl_text_fail(t->in, t->err, "a place or a turn that is none");
}

static void body(traffic *t, fl_world *w, int32_t k)
{
    fl_bodies *b = &w->b;
    open_row(t, "body");
    vec3(t, &b->x[k]);
    vec3(t, &b->v[k]);
    vec3(t, &b->L[k]);
    real(t, &b->q[k].w);
    real(t, &b->q[k].x);
    real(t, &b->q[k].y);
    real(t, &b->q[k].z);
    vec3(t, &b->w[k]); /* to the last bit not always what L and q give */
    vec3(t, &b->f[k]);
    vec3(t, &b->t[k]);
    real(t, &b->held[k]);
    if (b->added) real(t, &b->carried[k]);
    real(t, &b->odometer[k]);
    real(t, &w->odometer_found[k]);
    close_row(t);
}

/* The table of the current is not kept, but it must be the one that the run had. */
static void table_of(traffic *t, const fl_current *c)
{
    uint64_t bits = fl_hash(fl_hash(FL_HASH_START, c->z, c->n * (int64_t)sizeof *c->z), c->u,
                            c->n * (int64_t)sizeof *c->u);
    const uint64_t now = bits;
    const char *word = "";
    open_row(t, "current");
    if (t->f) fprintf(t->f, " %" PRIx64, bits);
    else if (!t->err->code && fl_text_word(t->in, "hash", &word, t->err) == 0 &&
             (hex(word, &bits) || bits != now))
        fl_text_fail(t->in, t->err, "the rows of water.profile_file are not those that the run had");
    close_row(t);
}

/* Who sleeps, and since when. */
static void nap(traffic *t, fl_world *w, int32_t k)
{
    fl_nap *n = &w->sleep.nap[k];
    open_row(t, "nap");
    byte(t, FL_RESTS, &w->sleep.kind[k]);
    count(t, &n->since);
    count(t, &w->sleep.until[k]);
    real(t, &n->way);
    real(t, &n->mark);
    real(t, &n->drag);
    real(t, &n->off);
    real(t, &n->summed);
    count(t, &n->coasted);
    count(t, &n->rested);
    count(t, &n->naps);
    whole(t, 1, INT32_MAX, &n->span);
    close_row(t);
    if (t->in && !t->err->code && (n->since > w->step || n->way < 0.0))
        fl_text_fail(t->in, t->err, "body %d sleeps since step %g of %g", w->id[k], (double)n->since,
                     (double)w->step);
}

static void sea(traffic *t, fl_sea *s, const fl_bodies *b, int32_t i)
{
    double energy = s->water && !s->waves ? fl_sea_energy(s, b, i) : 0.0,
           none = 0.0; /* told, and not needed */
    open_row(t, "sea");
    real(t, &s->wetted[i]);
    real(t, &s->lift[i]);
    real(t, &energy);
    real(t, &s->drained[i]);
    real(t, s->blown ? &s->blown[i] : &none);
    if (s->waves) real(t, &s->waved[i]);
    if (s->held) {
        fl_sea_held *h = &s->held[i];
        vec3(t, &h->df), vec3(t, &h->dt), vec3(t, &h->dflow);
        real(t, &h->dz), real(t, &h->dslope);
        pose(t, &h->x, &h->q);
        real(t, &h->when);
    }
    close_row(t);
}

/* The track is read again from its file, so its hash stands for it. */
static void mover(traffic *t, fl_world *w, int32_t k)
{
    fl_movers *m = &w->ride.m;
    fl_bodies *b = &m->b;
    const fl_track *tr = &m->motion[k].track;
    uint64_t bits = FL_HASH_START;
    if (tr->n)
        bits = fl_hash(fl_hash(bits, tr->t, tr->n * (int64_t)sizeof *tr->t), tr->at,
                       tr->n * (int64_t)sizeof *tr->at);
    const uint64_t now = bits;
    const char *word = "";
    open_row(t, "mover");
    if (t->f) fprintf(t->f, " %" PRIx64, bits);
    else if (!t->err->code && fl_text_word(t->in, "hash", &word, t->err) == 0 &&
             (hex(word, &bits) || bits != now))
        fl_text_fail(t->in, t->err, "the rows of the track of %s are not those that the run had",
                     fl_ride_name(w, k));
    vec3(t, &b->x[k]);
    vec3(t, &b->v[k]);
    vec3(t, &b->L[k]);
    real(t, &b->q[k].w);
    real(t, &b->q[k].x);
    real(t, &b->q[k].y);
    real(t, &b->q[k].z);
    vec3(t, &b->w[k]);
    vec3(t, &b->f[k]);
    vec3(t, &b->t[k]);
    real(t, &b->held[k]);
    vec3(t, &m->anchor[k]);
    vec3(t, &m->pull[k]);
    vec3(t, &m->spring[k]);
    vec3(t, &m->twist[k]);
    real(t, &m->stored[k]);
    real(t, &m->damped[k]);
    real(t, &m->given[k]);
    close_row(t);
}

/* Where the ice pressed last, and what the panels and events of the interval have so far. */
static void mark(traffic *t, fl_world *w, fl_press_mark *m)
{
    open_row(t, "mark");
    whole(t, 0, w->n - 1, &m->i);
    whole(t, 0, w->parts - 1, &m->part);
    whole(t, 0, w->press.panels - 1, &m->panel);
    vec3(t, &m->f);
    vec3(t, &m->n);
    vec3(t, &m->at);
    real(t, &m->normal);
    real(t, &m->area);
    real(t, &m->overlap);
    close_row(t);
}

static void event(traffic *t, fl_world *w, fl_press_event *e)
{
    open_row(t, "event");
    whole(t, INT32_MIN, INT32_MAX, &e->id);
    whole(t, 0, w->parts - 1, &e->part);
    vec3(t, &e->impulse);
    vec3(t, &e->across);
    vec3(t, &e->at);
    real(t, &e->weight);
    real(t, &e->area);
    real(t, &e->overlap);
    close_row(t);
}

static void pressed(traffic *t, fl_world *w)
{
    fl_press *s = &w->press;
    int32_t panels = s->panels, loaded = 0;
    for (int32_t k = 0; k < s->panels; k++) loaded += v3_norm2(s->impulse[k]) > 0.0;
    open_row(t, "pressed");
    whole(t, s->panels, s->panels, &panels);
    whole(t, 0, s->panels, &loaded);
    whole(t, 0, INT32_MAX, &s->n_now);
    whole(t, 0, INT32_MAX, &s->events);
    close_row(t);
    const int32_t marks = s->n_now, events = s->events;
    if (t->in) s->n_now = s->events = 0;
    if (t->in && !t->err->code) fl_press_panels_end(w);
    for (int32_t c = 0, k = -1; c < loaded && !t->err->code; c++) {
        if (t->f) do
                k++;
            while (!(v3_norm2(s->impulse[k]) > 0.0));
        open_row(t, "panel");
        whole(t, k < 0 ? 0 : k, s->panels - 1, &k);
        if (!t->err->code) vec3(t, &s->impulse[k]);
        close_row(t);
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

/* Rows at right angles, of length 1. */
static int turns(const fl_mat3 *M)
{
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
            double sum = k == l ? -1.0 : 0.0;
            for (int m = 0; m < 3; m++) sum += M->m[k][m] * M->m[l][m];
            if (!(fabs(sum) < 1e-9)) return 0;
        }
    return 1;
}

/* What a pair remembers of its past. */
static void memory(traffic *t, fl_pair *p)
{
    int32_t mode = (int32_t)p->mode;
    whole(t, FL_MODE_NONE, FL_FF, &mode);
    p->mode = (fl_mode)mode;
    whole(t, 0, 1, &p->deep);
    whole(t, 0, 1, &p->has_axis);
    vec3(t, &p->axis);
    whole(t, 0, 4, &p->cache.n);
    for (int k = 0; k < p->cache.n && !t->err->code; k++) {
        whole(t, 0, INT32_MAX, &p->cache.a[k]);
        whole(t, 0, INT32_MAX, &p->cache.b[k]);
    }
    real(t, &p->asleep);
    real(t, &p->touch);
    vec3(t, &p->slip.force);
    real(t, &p->slip.k);
    real(t, &p->slip.moment);
    real(t, &p->slip.k_turn);
}

/* What its last evaluation found. */
static void forces(traffic *t, fl_pair *p)
{
    fl_vec3 *const all[] = {&p->f, &p->ti, &p->tj, &p->fd, &p->di, &p->dj, &p->fs, &p->si, &p->sj};
    for (int k = 0; k < 9; k++) vec3(t, all[k]);
    real(t, &p->energy);
    real(t, &p->spring);
    real(t, &p->overlap);
    real(t, &p->stiff_i);
    real(t, &p->stiff_j);
}

/* Unit or nothing. */
static int points(const double e[6])
{
    double sum = 0.0;
    for (int k = 0; k < 6; k++) sum += e[k] * e[k];
    return sum == 0.0 || fabs(sum - 1.0) < 1e-9;
}

/* What was learnt of the way can be. */
static int learnt(const fl_surrogate *s)
{
    double zero = 0.0 * (s->before.energy + s->steeper + s->back + s->owed + s->spreads + s->leans);
    for (int k = 0; k < 6; k++) zero += 0.0 * (s->third[k] + s->before.slope[k] + s->before.way[k]);
    return zero == 0.0 && points(s->along) && s->before.energy >= 0.0 && s->spreads >= 0.0 && s->leans >= 0.0;
}

/* What a contact remembers of its last look; all else follows from how the two stood then. */
static void look(traffic *t, const fl_pair *p, fl_surrogate *s)
{
    whole(t, 0, p->exponent == 0.0, &s->live);
    if (!s->live) return;
    whole(t, 0, 1, &s->used);
    for (int k = 0; k < 9; k++) real(t, &s->M.m[k / 3][k % 3]);
    vec3(t, &s->o);
    vec3(t, &s->own);
    real(t, &s->arm);
    real(t, &s->reach);
    real(t, &s->stiff_i);
    real(t, &s->stiff_j);
    for (int r = 0; r < 6; r++)
        for (int k = r; k < 6; k++) {
            real(t, &s->learnt[r][k]);
            s->learnt[k][r] = s->learnt[r][k];
        }
    for (int k = 0; k < 6; k++) {
        real(t, &s->along[k]);
        real(t, &s->third[k]);
        real(t, &s->before.slope[k]);
        real(t, &s->before.way[k]);
    }
    real(t, &s->before.energy);
    real(t, &s->steeper);
    real(t, &s->back);
    real(t, &s->owed);
    real(t, &s->spreads);
    real(t, &s->leans);
    if (t->in && !t->err->code &&
        !(turns(&s->M) && s->arm > 0.0 && s->reach > 0.0 && s->reach <= FL_SURROGATE_MOST && learnt(s)))
        fl_text_fail(t->in, t->err, "a look at a contact that is none");
}

/* The surrogate that was read gets what it looked at. */
static void look_again(fl_world *w, fl_pair *p, const fl_surrogate *seen, fl_err *err)
{
    p->surrogate = fl_alloc(1, sizeof *p->surrogate, err);
    if (!p->surrogate) return;
    *p->surrogate = *seen;
    p->surrogate->live = 0;
    p->surrogate->less = fl_surrogate_less(p->law->surrogate);
    if (fl_interact_again(w, p, &seen->M, seen->o))
        fl_fail(err, FL_SYSTEM, "out of memory for pair %d and %d", p->i, p->j);
    p->surrogate->used = seen->used;
}

static void pair(traffic *t, fl_world *w, int32_t c)
{
    fl_near *near = &w->pair[c];
    fl_pair made = {0}, *p = near->full ? near->full : &made;
    if (t->f && p == &made) fl_near_pair(w, near, p);
    int32_t i = p->i, j = p->j;
    open_row(t, "pair");
    whole(t, 0, w->n - 1, &i);
    whole(t, 0, w->b.total - 1, &j);
    if (t->in) {
        const fl_near *q = c > 0 ? near - 1 : NULL;
        if (t->err->code) return;
        if (i >= j || (q && (q->i > i || (q->i == i && (w->cell.wraps ? q->j > j : q->j >= j))))) {
            fl_text_fail(t->in, t->err, "pair %d and %d found, pairs in rising order were wanted", i, j);
            return;
        }
        if (fl_balls_are(w, i, j)) {
            fl_text_fail(t->in, t->err, "pair %d and %d is of spheres, a row \"ball\" was wanted", i, j);
            return;
        }
        fl_pair_start(w, p, i, j);
    }
    for (int axis = 0; w->cell.wraps && axis < 3; axis++) whole(t, -INT32_MAX, INT32_MAX, &p->image[axis]);
    if (t->in && !t->err->code && fl_frozen_stands(w, i, j, p->image))
        fl_text_fail(t->in, t->err, "pair %d and %d found, and their bond stands", i, j);
    if (t->in && !t->err->code) fl_frozen_enter(w, p);
    whole(t, 0, 1, &p->n);
    memory(t, p);
    if (p->n) forces(t, p);
    fl_surrogate seen = {0};
    if (t->f && p->surrogate) seen = *p->surrogate;
    if (p->n && p->law->surrogate > 0.0) look(t, p, &seen);
    close_row(t);
    if (!t->in || t->err->code) return;
    fl_near_start(near, i, j, p->image);
    if (fl_near_keep(w, near, p)) fl_fail(t->err, FL_SYSTEM, "out of memory for pair %d and %d", i, j);
    else if (seen.live) look_again(w, near->full, &seen, t->err);
}

/* A bond: its past, and what acts of it.  Separations follow from where the bodies are; the face and its law
 * from the scene. */
static void bond(traffic *t, fl_world *w, int32_t k)
{
    fl_bond *c = &w->frozen.bond[k];
    fl_vec3 *const all[] = {&c->f, &c->ti, &c->tj, &c->fd, &c->di, &c->dj, &c->fs, &c->si, &c->sj};
    open_row(t, "bond");
    whole(t, FL_BOND_WHOLE, FL_BOND_ENDED, &c->state);
    real(t, &c->held);
    real(t, &c->worn);
    real(t, &c->spent);
    real(t, &c->handed);
    real(t, &c->store);
    real(t, &c->spring);
    real(t, &w->frozen.keep[k]);
    for (int e = 0; e < 9; e++) vec3(t, all[e]);
    for (int e = 0; e < FL_BOND_POINTS; e++) {
        fl_bond_point *p = &c->point[e];
        if (t->in) *p = (fl_bond_point){0};
        if (c->state == FL_BOND_WHOLE || t->err->code) continue;
        real(t, &p->d);
        real(t, &p->first);
        real(t, &p->last);
        real(t, &p->slip[0]);
        real(t, &p->slip[1]);
        if (t->in && !t->err->code && !(p->d >= 0.0 && p->d <= 1.0 && p->first >= 0.0 && p->last >= p->first))
            fl_text_fail(t->in, t->err, "damage %g between %g and %g is none of a bond", p->d, p->first,
                         p->last);
    }
    close_row(t);
}

/* A row of two spheres, or of one and wall ~c; in gives them back. */
static void ball(traffic *t, fl_world *w, int32_t c, int32_t last[2])
{
    const fl_balls *s = &w->balls;
    fl_ball_row r = {0};
    int32_t i = 0, j = 0, hit = 0, image[3] = {0};
    double n;
    if (t->f && c < 0) {
        const fl_ball_lean *const l = &s->lean[~c];
        i = l->i, j = l->j, hit = l->hit, r = l->row;
    } else if (t->f) {
        i = s->i[c], j = s->j[c], hit = s->hit[c], r = s->row[c];
        if (s->image) memcpy(image, &s->image[3 * c], sizeof image);
    }
    open_row(t, "ball");
    whole(t, 0, w->n - 1, &i);
    whole(t, 0, w->b.total - 1, &j);
    for (int axis = 0; w->cell.wraps && axis < 3; axis++) whole(t, -INT32_MAX, INT32_MAX, &image[axis]);
    whole(t, 0, 1, &hit);
    real(t, &r.touch);
    vec3(t, &r.slip);
    real(t, &r.stiff);
    vec3(t, &r.rub);
    real(t, &r.damped);
    close_row(t);
    if (t->f || t->err->code) return;
    if (i >= j || i < last[0] || (i == last[0] && (w->cell.wraps ? j < last[1] : j <= last[1])) ||
        !fl_balls_are(w, i, j)) {
        fl_text_fail(t->in, t->err, "spheres %d and %d found, pairs of spheres in rising order were wanted",
                     i, j);
        return;
    }
    last[0] = i, last[1] = j;
    r.k = fl_pairing_stiffness(w, i, j, &n);
    fl_balls_push(w, i, j, image, hit, &r, t->err);
}

/* Everything but the pairs, whose number the first row tells. */
static int32_t all_but_pairs(traffic *t, fl_world *w, int32_t *balls)
{
    int32_t parts = w->parts, total = w->b.total, n_sea = w->sea.n, pairs = w->n_pair;
    *balls = fl_balls_rows(w);
    open_row(t, "world");
    count(t, &w->step);
    count(t, &w->found_at);
    real(t, &w->dt);
    real(t, &w->t0);
    count(t, &w->step0);
    real(t, &w->skin);
    real(t, &w->dt_critical);
    whole(t, -1, w->b.total + w->ride.m.n - 1, &w->critical_body);
    real(t, &w->dt_safe);
    whole(t, w->parts, w->parts, &parts);
    whole(t, w->b.total, w->b.total, &total);
    whole(t, w->sea.n, w->sea.n, &n_sea);
    whole(t, 0, INT32_MAX, &pairs);
    whole(t, 0, INT32_MAX, balls);
    close_row(t);
    if (t->in && !t->err->code &&
        !(w->step >= 0 && w->dt > 0.0 && isfinite(w->dt) && w->skin >= 0.0 && w->t0 >= 0.0 &&
          isfinite(w->t0) && w->step0 >= 0 && w->step0 <= w->step))
        fl_text_fail(t->in, t->err, "step %g of %g s is no state of a run", (double)w->step, w->dt);
    books(t, w);
    if (w->told) told(t, w);
    for (int32_t p = 0; p < w->parts && !t->err->code; p++) {
        open_row(t, "part");
        vec3(t, &w->part_impulse[p]);
        vec3(t, &w->part_moment[p]);
        real(t, &w->part_peak[p]);
        close_row(t);
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
    w->sea.time = fl_world_time(w);
    if (w->sea.current.n) table_of(t, &w->sea.current);
    for (int32_t i = 0; i < w->sea.n && !t->err->code; i++) {
        sea(t, &w->sea, &w->b, i);
        if (t->in && !t->err->code && w->sea.held && !fl_world_away(w, i) &&
            !(w->sea.held[i].when < w->sea.time + 0.5 * w->dt)) /* a new step may begin a rounding before */
            fl_text_fail(t->in, t->err, "a look at the water at %g s is none that has been",
                         w->sea.held[i].when);
        if (!t->in || t->err->code || fl_world_away(w, i)) continue;
        if (fl_sleep_kind(w, i) != FL_AWAKE) /* what it meets is of then */
            w->sea.time = fl_sleep_since(w, i);
        fl_sea_renew(&w->sea, &w->b, i);
        w->sea.time = fl_world_time(w);
    }
    return pairs;
}

void fl_snapshot_write(FILE *f, fl_world *w)
{
    fl_err none = {0};
    traffic t = {.f = f, .err = &none};
    int32_t balls;
    all_but_pairs(&t, w, &balls);
    for (int32_t c = 0; c < w->n_pair; c++) pair(&t, w, c);
    fl_ball_walk at = {0};
    for (int32_t c = 0; c < balls; c++) ball(&t, w, fl_ball_next(w, &at), NULL);
}

int fl_snapshot_read(fl_world *w, fl_text *in, fl_err *err)
{
    traffic t = {.in = in, .err = err};
    int32_t cap = 0, balls, last[2] = {-1, -1};
    const int32_t pairs = all_but_pairs(&t, w, &balls);
    fl_near_free(w);
    /* The number is a hint: room comes as rows do. */
    for (int32_t c = 0; c < pairs && !err->code; c++) {
        if (fl_grow(&w->pair, &cap, (int64_t)c + 1, sizeof *w->pair, err)) return -1;
        w->pair[c] = (fl_near){0};
        pair(&t, w, c);
        w->n_pair = c + 1;
    }
    w->balls.n = w->balls.leans = 0;
    for (int32_t c = 0; c < balls && !err->code; c++) ball(&t, w, c, last);
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
