/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <math.h>
#include <stdalign.h>
#include <stddef.h>
#include <string.h>
#include "base/mem.h"
#include "base/wide.h"
#include "body/integrate.h"
#include "law/damping.h"
#include "law/sphere.h"
#include "sphere/contact_force.h"
#include "sphere/sphere_pair.h"
#include "step/balls.h"
#include "step/lead.h"
#include "step/leans.h"
#include "step/rolls.h"
#include "step/stiff.h"
#include "step/works.h"

enum {
    AHEAD = 64,   /* rows whose bodies j are on their way */
    ON_WAY = 24,  /* rows that are so themselves */
    PASSED_ON = 8 /* slots */
};

/* Touching rows are worked on when there are so many. */
enum { BLOCK = 16 };
static_assert(BLOCK + FL_LANES <= FL_SPHERES_MOST,
              "what four rows add has room behind what is not a block yet");

typedef struct {
    fl_spheres at;
    double d[FL_SPHERES_MOST][FL_LANES]; /* D and something, as they are found */
    int32_t row[FL_SPHERES_MOST];        /* filled to the end of a register */
    int32_t law[FL_SPHERES_MOST];        /* whose numbers stand there */
    double rest2[FL_SPHERES_MOST];
    int32_t m;
} batch;

/* Those of the rows from c on that have begun to touch or ended it, bit by bit: one that ends forgets. */
static void turn_over(fl_balls *s, int32_t c, uint32_t turned)
{
    for (; turned; turned >>= 1, c++) {
        if (!(turned & 1)) continue;
        if (s->hit[c]) s->row[c] = (fl_ball_row){.k = s->row[c].k};
        if (s->hit[c] && s->roll) s->roll[c] = (fl_roll){.k = 0.0};
        s->hit[c] ^= 1;
        fl_balls_turn(s, s->i[c], s->hit[c] ? 1 : -1), fl_balls_turn(s, s->j[c], s->hit[c] ? 1 : -1);
    }
}

/* Row c by itself: whether |D|^2 < (r_i + r_j)^2, and D to the end of the batch. */
static int look_one(const fl_world *w, batch *t, int32_t c)
{
    const fl_vec3 d = fl_balls_between(w, c);
    const double R = w->b.radius[w->balls.i[c]] + w->b.radius[w->balls.j[c]];
    t->row[t->m] = c;
    t->d[t->m][0] = d.x, t->d[t->m][1] = d.y, t->d[t->m][2] = d.z;
    return v3_norm2(d) - R * R < 0.0;
}

/* What adds to 1/M of contacts of body k in whatever direction; NAN where they differ. */
static double plainly(const fl_bodies *b, int32_t k)
{
    if (fl_body_stands(b, k)) return NAN;
    return b->added ? 1.0 / (b->m[k] + b->added[k].x) : b->invm[k];
}

/* What the second half of a step changes of the speeds of body k, as far as it does what the first did. */
static fl_gain lead_of(const fl_world *w, int32_t k, double h)
{
    const fl_bodies *b = &w->b;
    fl_vec3 a, turn;
    if (fl_body_plain(b, k)) a = v3_scale(b->invm[k], b->f[k]), turn = v3_scale(b->invI[k].x, b->t[k]);
    else fl_body_rates(b, k, &a, &turn);
    const fl_gain kick = {v3_scale(h, a), v3_scale(h, turn)};
    return w->drag ? (fl_gain){v3_add(kick.v, w->drag[k].v), v3_add(kick.w, w->drag[k].w)} : kick;
}

/* Of one velocity of the rim for an impulse there, r^2/I, where anything lets it turn. */
static double turns_of(const fl_bodies *b, int32_t k)
{
    const int held = FL_HOLD_RX | FL_HOLD_RY | FL_HOLD_RZ;
    return (b->hold[k] & held) == held ? 0.0 : b->radius[k] * b->radius[k] * b->invI[k].x;
}

/* So many contacts in one line damp a motion as n all round a sphere do, of which two are in line: 3.4 for
 * six, 5.5 for twelve, or less (crowd() of critical.c). */
static double all_round(int32_t n) { return n > 2 ? 2.0 + 0.35 * (n - 2) : n; }

void fl_balls_show(fl_world *w, int32_t from, int32_t to, double h)
{
    const fl_bodies *b = &w->b;
    fl_ball_seen *const seen = w->balls.seen;
    for (int32_t k = from; k < to; k++) {
        const fl_gain lead = lead_of(w, k, h);
        const int32_t rows = w->balls.touched[k] = w->balls.touching[k];
        const double n = all_round(rows + fl_works_was(w, k)->n), r = b->radius[k],
                     crowd = n > 1.0 ? (n - 1.0) * fl_body_lightness(b, k) : 0.0;
        seen[k] = (fl_ball_seen){b->x[k], r,      b->v[k], plainly(b, k),       b->w[k],
                                 r,       lead.v, crowd,   v3_scale(r, lead.w), turns_of(b, k)};
    }
}

/* The difference a - b of vectors, and the sum of the numbers behind them. */
FL_WIDE_PART void compare_two(fl_wide *d, const void *a, const void *b)
{
    *d = __builtin_shufflevector(FL_FOUR(a) - FL_FOUR(b), FL_FOUR(a) + FL_FOUR(b), 0, 1, 2, 7);
}

/* What the loop below reads and writes. */
typedef struct {
    fl_world *w;
    const int32_t *i, *j;
    const fl_ball_way *way;
    const uint8_t *by, *hit;
    const fl_ball_seen *seen;
    const fl_ball_row *row;
    int32_t n; /* rows there are */
} seeker;

/* Rows [c, to), four at a time, until the batch is a block or less than four are left: behind the last.
 * Whether a row touches is nothing that could be foreseen, so nothing here branches on it: it is written down
 * behind the last that does, and counts or does not.  That it begins to, or ends, is rare.  What comes is
 * sent for: with 100 000 spheres all that is not is waited for. */
FL_FOUR_VERSIONS static int32_t look(const seeker *restrict s, batch *restrict t, int32_t c, int32_t to)
{
    const int32_t *bi = s->i, *bj = s->j;
    const fl_ball_seen *seen = s->seen;
    const uint8_t *hit = s->hit, *by = s->by;
    const fl_ball_way *way = s->way;
    int32_t m = t->m;
    for (; c + FL_LANES <= to && m < BLOCK; c += FL_LANES) {
        fl_wide v[FL_LANES];
        uint32_t turned = 0;
        const int32_t *far = &bj[c + AHEAD + FL_LANES <= s->n ? c + AHEAD : c];
        fl_fetch(&s->row[c + ON_WAY + FL_LANES <= s->n ? c + ON_WAY : c], FL_LANES * sizeof *s->row);
        FL_WIDE_UNROLL for (int32_t l = 0; l < FL_LANES; l++)
        {
            const int32_t i = bi[c + l], j = bj[c + l];
            compare_two(&v[l], &seen[i].x, &seen[j].x);
            v[l] -= FL_FOUR(&way[by[c + l]]);
            fl_fetch(&seen[far[l]], sizeof *seen);
        }
        fl_wide d[] = {v[0], v[1], v[2], v[3]};
        fl_wide_transpose(d);
        const fl_wide gap = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - d[3] * d[3];
        const fl_wide_mask touches = gap < 0.0;
        FL_WIDE_UNROLL for (int32_t l = 0; l < FL_LANES; l++)
        {
            const uint32_t one = (uint32_t)touches[l] & 1;
            t->row[m] = c + l;
            FL_FOUR_INTO(t->d[m]) = v[l];
            m += (int32_t)one;
            turned |= (one ^ hit[c + l]) << l;
        }
        if (turned) turn_over(&s->w->balls, c, turned);
    }
    t->m = m;
    return c;
}

/* What the batch needs to be placed again, */
static void load_forces(const fl_world *w, batch *t)
{
    const fl_balls *s = &w->balls;
    fl_spheres *a = &t->at;
    for (int32_t m = 0; m < t->m; m++) {
        const int32_t c = t->row[m];
        const fl_ball_row *r = &s->row[c];
        for (int axis = 0; axis < 3; axis++) a->d[axis][m] = t->d[m][axis];
        a->ri[m] = w->b.radius[s->i[c]];
        a->rj[m] = w->b.radius[s->j[c]];
        a->k[m] = r->k;
        a->rub[0][m] = r->rub.x;
        a->rub[1][m] = r->rub.y;
        a->rub[2][m] = r->rub.z;
        a->damped[m] = r->damped;
    }
}

/* and to be evaluated. */
typedef struct {
    const int32_t *i, *j;
    const fl_ball_row *row;
    const fl_ball_seen *seen;
} source;

FL_FOUR_VERSIONS static int load(const source *restrict s, batch *restrict t)
{
    static_assert(offsetof(fl_ball_row, stiff) == sizeof(fl_vec3), "a spring is a register of four");
    static_assert(offsetof(fl_ball_row, k) == offsetof(fl_ball_row, touch) + sizeof(double), "one of two");
    const int32_t *bi = s->i, *bj = s->j;
    const fl_ball_row *row = s->row;
    const fl_ball_seen *seen = s->seen;
    const int32_t n = t->m;
    fl_spheres *a = &t->at;
    const fl_wide zero = {0.0, 0.0, 0.0, 0.0};
    fl_wide all = zero;
    for (int32_t k = n; k % FL_LANES; k++) t->row[k] = t->row[n - 1];
    for (int32_t m = 0; m < n; m += FL_LANES) {
        fl_wide d[] = {FL_FOUR(t->d[m]), FL_FOUR(t->d[m + 1]), FL_FOUR(t->d[m + 2]), FL_FOUR(t->d[m + 3])};
        fl_wide u[FL_LANES], p[FL_LANES], q[FL_LANES], h[FL_LANES], f[FL_LANES], du[FL_LANES], dw[FL_LANES];
        fl_two last[FL_LANES];
        FL_WIDE_UNROLL for (int32_t l = 0; l < FL_LANES; l++)
        {
            const int32_t c = t->row[m + l], i = bi[c], j = bj[c];
            const fl_ball_row *r = &row[c];
            compare_two(&u[l], &seen[i].v, &seen[j].v);
            p[l] = FL_FOUR(&seen[i].w);
            q[l] = FL_FOUR(&seen[j].w);
            h[l] = FL_FOUR(&r->slip);
            f[l] = FL_FOUR(&r->rub);
            compare_two(&du[l], &seen[i].dv, &seen[j].dv);
            dw[l] = FL_FOUR(&seen[i].rdw) + FL_FOUR(&seen[j].rdw);
            last[l] = *(const fl_two *)(const void *)&r->touch;
        }
        const fl_wide even = __builtin_shufflevector(last[0], last[2], 0, 1, 2, 3),
                      odd = __builtin_shufflevector(last[1], last[3], 0, 1, 2, 3);
        FL_FOUR_INTO(&a->touch[m]) = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
        FL_FOUR_INTO(&a->k[m]) = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
        fl_wide_transpose(d);
        fl_wide_transpose(u);
        fl_wide_transpose(p);
        fl_wide_transpose(q);
        fl_wide_transpose(h);
        fl_wide_transpose(f);
        fl_wide_transpose(du);
        fl_wide_transpose(dw);
        FL_WIDE_UNROLL for (int axis = 0; axis < 3; axis++)
        {
            FL_FOUR_INTO(&a->rub[axis][m]) = f[axis];
            FL_FOUR_INTO(&a->du[axis][m]) = du[axis];
            FL_FOUR_INTO(&a->rdw[axis][m]) = dw[axis];
            FL_FOUR_INTO(&a->d[axis][m]) = d[axis];
            FL_FOUR_INTO(&a->u[axis][m]) = u[axis];
            FL_FOUR_INTO(&a->wi[axis][m]) = p[axis];
            FL_FOUR_INTO(&a->wj[axis][m]) = q[axis];
            FL_FOUR_INTO(&a->slip[axis][m]) = h[axis];
        }
        FL_FOUR_INTO(&a->stiff[m]) = h[3];
        FL_FOUR_INTO(&a->damped[m]) = f[3];
        FL_FOUR_INTO(&a->many[m]) = FL_WIDE_CHOOSE(u[3] > 0.0, 1.0 + du[3] / u[3], 1.0 + zero);
        FL_FOUR_INTO(&a->turns[m]) = dw[3];
        FL_FOUR_INTO(&a->yields[m]) = u[3];
        FL_FOUR_INTO(&a->across[m]) = u[3];
        FL_FOUR_INTO(&a->invm[m]) = FL_FOUR(&t->rest2[m]) * u[3]; /* for nothing but the stored energy */
        FL_FOUR_INTO(&a->ri[m]) = p[3];
        FL_FOUR_INTO(&a->rj[m]) = q[3];
        all += u[3];
    }
    const double sum = fl_wide_sum(&all);
    return sum == sum;
}

/* Of those that depend on the direction. */
static void load_masses(const fl_world *w, batch *t)
{
    const fl_bodies *b = &w->b;
    for (int32_t m = 0; m < t->m; m++) {
        const int32_t i = w->balls.i[t->row[m]], j = w->balls.j[t->row[m]];
        if (t->at.invm[m] == t->at.invm[m]) continue;
        const fl_vec3 n = v3_unit(v3(t->d[m][0], t->d[m][1], t->d[m][2]));
        t->at.yields[m] = fl_body_yields(b, i, n) + fl_body_yields(b, j, n);
        t->at.across[m] = fl_body_lightness(b, i) + fl_body_lightness(b, j);
        t->at.many[m] = fl_damping_among(w->balls.seen[i].crowd, w->balls.seen[j].crowd, t->at.across[m]);
        t->at.invm[m] = t->rest2[m] * t->at.yields[m];
    }
}

static void load_law(const fl_world *w, batch *t, int32_t m, int32_t l)
{
    const fl_touching *law = &w->law[l];
    t->law[m] = l;
    t->at.friction[m] = law->friction;
    t->at.tangential[m] = law->tangential;
    t->at.chi[m] = law->chi;
    t->rest2[m] = law->rest * law->rest;
}

/* Where there is not one law for all, most often the numbers stand there from the contacts before. */
static void load_laws(const fl_world *w, batch *t)
{
    const int32_t *law = w->balls.law;
    for (int32_t m = 0; m < t->m; m++)
        if (law[t->row[m]] != t->law[m]) load_law(w, t, m, law[t->row[m]]);
}

FL_FOUR_VERSIONS static void save(fl_ball_row *restrict row, const batch *restrict t)
{
    static_assert(offsetof(fl_ball_row, damped) == offsetof(fl_ball_row, rub) + sizeof(fl_vec3),
                  "see ball.h");
    const fl_spheres *a = &t->at;
    const int32_t n = t->m;
    for (int32_t m = 0; m < n; m += FL_LANES) {
        fl_wide h[] = {FL_FOUR(&a->slip[0][m]), FL_FOUR(&a->slip[1][m]), FL_FOUR(&a->slip[2][m]),
                       FL_FOUR(&a->stiff[m])};
        fl_wide f[] = {FL_FOUR(&a->rub[0][m]), FL_FOUR(&a->rub[1][m]), FL_FOUR(&a->rub[2][m]),
                       FL_FOUR(&a->damped[m])};
        fl_wide_transpose(h);
        fl_wide_transpose(f);
        FL_WIDE_UNROLL for (int32_t l = 0; l < FL_LANES; l++)
        {
            if (m + l >= n) break;
            fl_ball_row *r = &row[t->row[m + l]];
            FL_FOUR_INTO(&r->slip) = h[l];
            FL_FOUR_INTO(&r->rub) = f[l];
            r->touch = a->touch[m + l];
        }
    }
}

/* A sum is three registers of four. */
enum { PARTS = 3 };
static_assert(sizeof(fl_ball_sum) == PARTS * sizeof(fl_wide), "a sum is twelve doubles");

/* Without the string instruction that a compiler makes of it, which takes longer than all else here. */
FL_FOUR_VERSIONS static void clear(fl_ball_sum *s, int32_t n)
{
    const fl_wide zero = {0.0, 0.0, 0.0, 0.0};
    for (int32_t k = 0; k < n; k++) {
        volatile fl_wide *sum = (volatile fl_wide *)&s[k];
        sum[0] = sum[1] = sum[2] = zero;
    }
}

/* What four contacts do, each a row: to i and j alike but for the sign, and to either. */
typedef struct {
    fl_wide one[FL_LANES], two[FL_LANES], on_i[FL_LANES], on_j[FL_LANES];
} wrenches;

FL_WIDE_PART void find_wrenches(wrenches *q, const fl_spheres *a, int32_t m)
{
    q->one[0] = FL_FOUR(&a->push[0][m]), q->one[1] = FL_FOUR(&a->push[1][m]);
    q->one[2] = FL_FOUR(&a->push[2][m]), q->one[3] = FL_FOUR(&a->damping[0][m]);
    q->two[0] = FL_FOUR(&a->damping[1][m]), q->two[1] = FL_FOUR(&a->damping[2][m]);
    q->two[2] = FL_FOUR(&a->rub[0][m]), q->two[3] = FL_FOUR(&a->rub[1][m]);
    q->on_i[0] = FL_FOUR(&a->rub[2][m]), q->on_i[1] = FL_FOUR(&a->ti[0][m]);
    q->on_i[2] = FL_FOUR(&a->ti[1][m]), q->on_i[3] = FL_FOUR(&a->ti[2][m]);
    q->on_j[0] = -q->on_i[0], q->on_j[1] = FL_FOUR(&a->tj[0][m]);
    q->on_j[2] = FL_FOUR(&a->tj[1][m]), q->on_j[3] = FL_FOUR(&a->tj[2][m]);
    fl_wide_transpose(q->one);
    fl_wide_transpose(q->two);
    fl_wide_transpose(q->on_i);
    fl_wide_transpose(q->on_j);
}

/* The l-th of them to the sum of i, and to that of j or to a slot.  Which of the two cannot be foreseen, so
 * nothing branches on it. */
FL_WIDE_PART void hand_one(fl_ball_sum *sums, fl_ball_sum *slots, int32_t i, int32_t to, const wrenches *q,
                           int32_t l)
{
    const int32_t beyond = to < 0 ? -1 : 0;
    const uintptr_t which = ((uintptr_t)sums ^ (uintptr_t)slots) & (uintptr_t)(intptr_t)beyond;
    fl_wide *on = (fl_wide *)&sums[i],
            *off = (fl_wide *)&((fl_ball_sum *)((uintptr_t)sums ^ which))[to ^ beyond];
    on[0] += q->one[l], on[1] += q->two[l], on[2] += q->on_i[l];
    off[0] -= q->one[l], off[1] -= q->two[l], off[2] += q->on_j[l];
}

/* The wrenches of the batch. */
FL_FOUR_VERSIONS static void hand_out(const fl_balls *restrict s, const batch *restrict t)
{
    const int32_t *bi = s->i, *bto = s->to, *row = t->row, n = t->m;
    fl_ball_sum *sums = s->sum, *slots = s->slot;
    int32_t m = 0;
    for (; m + FL_LANES <= n; m += FL_LANES) {
        wrenches q;
        find_wrenches(&q, &t->at, m);
        FL_WIDE_UNROLL for (int32_t l = 0; l < FL_LANES; l++)
            hand_one(sums, slots, bi[row[m + l]], bto[row[m + l]], &q, l);
    }
    if (m < n) {
        wrenches q;
        find_wrenches(&q, &t->at, m);
        for (int32_t l = 0; m + l < n; l++) hand_one(sums, slots, bi[row[m + l]], bto[row[m + l]], &q, l);
    }
}

FL_FOUR_VERSIONS static void collect(fl_ball_sum *restrict sums, const fl_ball_sum *restrict slot,
                                     const int32_t *restrict slots, const int32_t *restrict into,
                                     int32_t from, int32_t to)
{
    for (int32_t k = from; k < to; k++) {
        fl_wide *sum = (fl_wide *)&sums[k], a = sum[0], b = sum[1], c = sum[2];
        if (into[k] == into[k + 1]) continue;
        for (int32_t at = into[k]; at < into[k + 1]; at++) {
            fl_fetch(&slot[slots[at + PASSED_ON < into[to] ? at + PASSED_ON : at]], sizeof *slot);
            const fl_wide *in = (const fl_wide *)&slot[slots[at]];
            a += in[0], b += in[1], c += in[2];
        }
        sum[0] = a, sum[1] = b, sum[2] = c;
    }
}

/* Whether one of the first m, or of those that fill the register behind them, is deeper than so much of the
 * sum of the radii. */
FL_WIDE_VERSIONS static int deeper(const fl_spheres *a, int32_t m, double most)
{
    int any = 0;
#pragma omp simd reduction(| : any)
    for (int32_t k = 0; k < m; k++) any |= a->overlap[k] > most * (a->ri[k] + a->rj[k]);
    return any;
}

/* Of the first m, lane by lane. */
FL_FOUR_VERSIONS static double all_sizes(const fl_spheres *a, int32_t m)
{
    fl_wide sum = {0.0, 0.0, 0.0, 0.0};
    double rest = 0.0;
    int32_t k = 0;
    for (; k + FL_LANES <= m; k += FL_LANES) sum += FL_FOUR(&a->size[k]);
    for (; k < m; k++) rest += a->size[k];
    return fl_wide_sum(&sum) + rest;
}

static void count(const batch *t, fl_ball_tally *tally)
{
    const fl_spheres *a = &t->at;
    tally->force += all_sizes(a, t->m);
    tally->touching += t->m;
    if (!deeper(a, t->m, tally->worst)) return;
    for (int32_t m = 0; m < t->m; m++) {
        const double both = a->ri[m] + a->rj[m];
        if (!(a->overlap[m] > tally->worst * both)) continue;
        tally->worst = a->overlap[m] / both;
        tally->worst_row = t->row[m];
    }
}

/* As share_of() of step.c says. */
static void survey_batch(fl_world *w, const batch *t)
{
    fl_balls *s = &w->balls;
    const fl_spheres *a = &t->at;
    for (int32_t m = 0; m < t->m; m++) {
        const int32_t c = t->row[m], i = s->i[c], j = s->j[c], to = s->to[c];
        const double half = 0.5 * a->overlap[m];
        const double rolls = s->roll ? fl_rolls_stiff(&s->roll[c]) : 0.0,
                     ki = fl_stiff_point(&w->b, i, a->slope[m], a->stiff[m], a->ri[m] - half, rolls),
                     kj = fl_stiff_point(&w->b, j, a->slope[m], a->stiff[m], a->rj[m] - half, rolls),
                     both = sqrt(ki * kj);
        s->stiff[i] += ki + both;
        if (to >= 0) s->stiff[j] += kj + both;
        else s->stiff_slot[~to] = kj + both;
    }
}

/* What keeps those of the batch from rolling. */
static void roll(const fl_world *w, batch *t, double dt)
{
    const fl_balls *s = &w->balls;
    fl_rolls_row row[FL_SPHERES_MOST];
    for (int32_t m = 0; m < t->m; m++) {
        const int32_t c = t->row[m];
        row[m] = (fl_rolls_row){&w->law[s->law[c]], &s->roll[c], s->i[c], s->j[c]};
    }
    fl_rolls_meet(w, &t->at, row, t->m, dt);
}

/* What is done with the batch, which then is empty. */
static void finish(fl_world *w, int32_t a, batch *t, double dt, int survey)
{
    fl_balls *s = &w->balls;
    if (dt < 0.0) {
        load_forces(w, t);
        fl_spheres_place(&t->at, t->m);
    } else {
        const source from = {s->i, s->j, s->row, s->seen};
        if (s->one_law < 0) load_laws(w, t);
        if (!load(&from, t)) load_masses(w, t);
        fl_spheres_meet(&t->at, t->m, dt, fl_lead_span(w, dt).half);
        save(s->row, t);
    }
    if (s->roll) roll(w, t, dt);
    hand_out(s, t);
    count(t, &s->tally[a]);
    if (survey) survey_batch(w, t);
    t->m = 0;
}

/* And of the first BLOCK of it; the others move up. */
static void finish_block(fl_world *w, int32_t a, batch *t, double dt, int survey)
{
    const int32_t more = t->m - BLOCK;
    if (more < 0) return;
    t->m = BLOCK;
    finish(w, a, t, dt, survey);
    memcpy(t->d, t->d[BLOCK], (size_t)more * sizeof *t->d);
    memcpy(t->row, &t->row[BLOCK], (size_t)more * sizeof *t->row);
    t->m = more;
}

void fl_balls_touch(fl_world *w, int32_t a, double dt, int survey)
{
    fl_balls *s = &w->balls;
    const int32_t begin = a * FL_BALLS_CHUNK, end = fl_balls_last(s, a), to = s->first[end],
                  cross = s->cross[a];
    const seeker by = {w, s->i, s->j, s->way, s->by, s->hit, s->seen, s->row, s->n};
    const int wide = dt >= 0.0 && s->ways;
    batch t;
    memset(t.law, -1, sizeof t.law);
    for (int32_t m = 0; s->one_law >= 0 && m < FL_SPHERES_MOST; m++) load_law(w, &t, m, s->one_law);
    t.m = 0;
    s->tally[a] = (fl_ball_tally){.worst_row = -1};
    clear(&s->sum[begin], end - begin);
    clear(&s->slot[cross], s->cross[a + 1] - cross);
    if (survey) {
        memset(&s->stiff[begin], 0, (size_t)(end - begin) * sizeof *s->stiff);
        memset(&s->stiff_slot[cross], 0, (size_t)(s->cross[a + 1] - cross) * sizeof *s->stiff_slot);
    }
    for (int32_t c = s->first[begin]; c < to;) {
        if (wide) c = look(&by, &t, c, to);
        for (; c < to && t.m < BLOCK && (!wide || to - c < FL_LANES); c++) {
            const uint8_t touches = (uint8_t)look_one(w, &t, c);
            if (dt >= 0.0 && touches != s->hit[c]) turn_over(s, c, 1);
            t.m += s->hit[c];
        }
        finish_block(w, a, &t, dt, survey);
    }
    if (t.m) finish(w, a, &t, dt, survey);
    if (s->leans) fl_leans_touch(w, a, dt, survey);
}

void fl_balls_collect(fl_world *w, int32_t from, int32_t to)
{
    collect(w->balls.sum, w->balls.slot, w->balls.slots, w->balls.into, from, to);
}

int32_t fl_balls_share(const fl_world *w, int t, int parts)
{
    const fl_balls *s = &w->balls;
    const int64_t all = (int64_t)s->n + s->bodies;
    int32_t lo = 0, hi = s->chunks; /* the first with as many rows and bodies before it as belong to others */
    while (lo < hi) {
        const int32_t a = (lo + hi) / 2, k = a * FL_BALLS_CHUNK;
        if (((int64_t)s->first[k] + k) * parts < all * t) lo = a + 1;
        else hi = a;
    }
    return lo;
}
