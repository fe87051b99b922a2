/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>
#include "base/array.h"
#include "base/parallel.h"
#include "body/integrate.h"
#include "sim/body_step.h"
#include "sim/energy_balance.h"
#include "sphere/contact_force.h"
#include "contact/active_pairs.h"
#include "sphere/contact_list.h"
#include "sim/critical_step.h"
#include "contact/bond_list.h"
#include "sim/half_kicks.h"
#include "sphere/wall_contact.h"
#include "contact/panel_load.h"
#include "sim/moving_structure.h"
#include "sim/neighbour_list.h"
#include "sim/sleep.h"
#include "sim/step.h"
#include "sim/inflow.h"
#include "sim/energy_ledger.h"
#include "world/access.h"

/* Steps between two looks at the stiffness that is active. A contact lasts for many steps of the default
 * size; one that a longer step throws apart would be missed in between, so that these look more often, and
 * those four times as long always; but for steps that are short against what contacts have turned out to be.
 * Half a period takes pi/2 of the critical step: a tenth of it has fifteen steps in that, of which every
 * fourth is looked at. */
enum { SURVEY = 16, SOME = 4, WATCH = 16 };
#define CAREFUL 0.2 /* of the critical step that any contact may have: the default */

/* Held things of which a thread adds up the contacts at a time. */
enum { HELD = 8 };

/* Contacts that are on their way to the processor while another is booked, which takes far less time. */
enum { ON_WAY = 8 };

static int surveyed(const fl_world *w, int64_t step)
{
    /* what few contacts there are may all lie in between */
    if (w->contact_steps && !isfinite(w->dt_critical)) return 1;
    const double over = w->dt > w->dt_safe ? w->dt / w->dt_safe : 1.0;
    const double seen = isfinite(w->dt_critical) ? 0.1 * SOME * w->dt_critical / w->dt : 0.0;
    const int64_t every = (int64_t)fmax(SURVEY / (over * over), fmin(seen, SOME));
    return every < 2 || step % every == 0;
}

/* Each pair writes its own result. */
static void contacts_of_pairs(fl_world *w, double dt, int survey)
{
#pragma omp for schedule(static) nowait
    for (int32_t k = 0; k < w->bonds.n; k += FL_BOND_LIST_RUN)
        fl_bond_list_evaluate(w, k, k + FL_BOND_LIST_RUN < w->bonds.n ? k + FL_BOND_LIST_RUN : w->bonds.n);
    fl_evaluate_active_pairs(w, dt, survey);
}

/* --- a step by a team of threads ---------------------------------------------------------------- */

/* A step in work. */
typedef struct {
    fl_world *w;
    double dt;
    int survey;
    int out;    /* it begins with the first half of the motion, not with contacts of bodies as they stand */
    int parted; /* after which the team has parted, for what comes next has teams of its own */
    int bad;
    fl_err *err;
} stride;

/* Bodies are where the step takes them. */
static void out_there(fl_world *w)
{
    const int rides = w->moving.movers.n > 0;
    for (int32_t k = w->n; k < w->b.total; k++)
        if (!rides || w->moving.mover_of_piece[k - w->n] < 0) fl_drift(&w->b, k, w->dt);
    w->step++;
    w->sea.time = fl_world_time(w);
    w->sea.sample_now = w->sea.sample_every < 2 || w->step % w->sea.sample_every == 0;
}

static void after_out(void *arg)
{
    stride *const q = arg;
    out_there(q->w);
    q->parted = fl_neighbour_list_due(q->w);
    if (!q->parted) fl_share_active_pairs(q->w);
}

/* Where pairs have touched, and where they press when that is asked. */
static void after_touch(void *arg)
{
    stride *const q = arg;
    fl_world *const w = q->w;
    fl_work_share_split(w->block_share, w->team.n, fl_block_count(w));
    fl_collect_touching(w);
    fl_contact_sums_assign(w);
    if (w->bonds.ended) { /* there is a pair to be found */
        w->last_search_step = -1;
        w->bonds.ended = 0;
    }
    if (w->panel_load.panels && fl_panels_sort(w, q->err)) q->bad = 1;
    if (w->sleep.n_resting) fl_sleep_wake_touched(w);
}

static_assert(FL_SPHERE_CHUNK % FL_BODY_BLOCK == 0 && FL_SPHERE_CHUNK / FL_BODY_BLOCK <= FL_BLOCKS_AT_ONCE,
              "a chunk is made of groups");

static void end_chunk(fl_world *w, int32_t a, double h)
{
    const int32_t each = FL_SPHERE_CHUNK / FL_BODY_BLOCK, all = fl_block_count(w), from = a * each;
    if (from < all) fl_blocks_second_half(w, from, from + each < all ? from + each : all, h);
}

/* Rows of a chunk lead to it and to those behind it.  So, when a thread takes a run of chunks in their order,
 * a chunk to which no row from before the run leads can end its step at once, with all that belongs to it
 * still at hand; the others do when all have been touched.  Rows look at what they were shown, not at bodies
 * that have gone on already. */
static void chunks(stride *q, int thread, int threads)
{
    fl_world *const w = q->w;
    const fl_sphere_contacts *s = &w->spheres;
    const int32_t from = fl_sphere_chunk_share(w, thread, threads),
                  to = fl_sphere_chunk_share(w, thread + 1, threads);
    for (int32_t a = from; a < to; a++) {
        fl_sphere_chunk_evaluate(w, a, q->dt, q->survey);
        s->finished[a] = s->first_source[a] >= from;
        if (s->finished[a]) end_chunk(w, a, 0.5 * q->dt);
    }
    fl_barrier_wait(&w->barrier, threads, NULL, NULL);
    for (int32_t a = from; a < to; a++)
        if (!s->finished[a]) end_chunk(w, a, 0.5 * q->dt);
}

/* Either half of the motion. */
static void groups(stride *q, int thread, int end)
{
    fl_world *const w = q->w;
    const double h = 0.5 * q->dt;
    const int32_t each = fl_blocks_per_turn(w);
    for (int32_t k = 0; k < w->team.n; k++) {
        fl_work_share *const s = &w->block_share[(thread + k) % w->team.n];
        for (int32_t g = fl_work_share_take(s, each); g < s->end; g = fl_work_share_take(s, each)) {
            const int32_t last = g + each < s->end ? g + each : s->end;
            if (end) fl_blocks_second_half(w, g, last, h);
            else fl_blocks_first_half(w, g, last, h);
        }
    }
}

/* Who must not sleep on has made the first half of its step. */
static void rouse(fl_world *w, int thread, int threads)
{
    const int32_t all = fl_block_count(w);
    fl_sleep_find_waking(w, thread, threads);
    fl_barrier_wait(&w->barrier, threads, NULL, NULL);
#pragma omp for schedule(static, 1) nowait
    for (int32_t g = 0; g < all; g += FL_BLOCKS_AT_ONCE)
        fl_blocks_wake(w, g, g + FL_BLOCKS_AT_ONCE < all ? g + FL_BLOCKS_AT_ONCE : all);
    fl_barrier_wait(&w->barrier, threads, NULL, NULL);
}

/* By every thread of the team, which meets after each part: the first half of the motion; contacts; the
 * second half, and what held things feel. */
static void go(stride *q)
{
    fl_world *const w = q->w;
    const int thread = omp_get_thread_num(), threads = omp_get_num_threads();
    const int by_chunks = w->spheres.bodies && !w->sleep.state && !w->panel_load.panels;
    if (q->out) {
        groups(q, thread, 0);
        fl_barrier_wait(&w->barrier, threads, after_out, q);
        if (q->parted) return;
    }
    if (w->sleep.state) rouse(w, thread, threads); /* no sphere, which rows would have to see */
    if (!by_chunks && w->spheres.chunks) {
#pragma omp for schedule(dynamic) nowait
        for (int32_t a = 0; a < w->spheres.chunks; a++) fl_sphere_chunk_evaluate(w, a, q->dt, q->survey);
    }
    contacts_of_pairs(w, q->dt, q->survey);
    fl_barrier_wait(&w->barrier, threads, after_touch, q);
    if (q->bad) return;
    if (by_chunks) chunks(q, thread, threads);
    else groups(q, thread, 1);
#pragma omp for schedule(static, HELD) nowait
    for (int32_t k = w->n; k < w->b.total; k++) fl_body_sum_forces(w, k);
    fl_barrier_wait(&w->barrier, threads, NULL,
                    NULL); /* watched, where the end of the region would send to sleep */
}

/* To call up a team of one takes as long as three floes do for a step. */
static int stride_on(stride *q)
{
    const int32_t team = q->w->team.n;
    fl_work_share_split(q->w->block_share, team, fl_block_count(q->w));
    if (!q->out) fl_share_active_pairs(q->w);
    if (team == 1) {
        go(q);
    } else {
#pragma omp parallel num_threads(team)
        go(q);
    }
    return q->bad ? -1 : 0;
}

/* omega^2 of all contacts together from those of each for each of its two bodies.  With g u the approach that
 * a motion u of a body makes, (g u - g' u')^2 <= (1 + c) (g u)^2 + (1 + 1/c) (g' u')^2 for any c > 0, and so
 * the bodies come apart: omega^2 is at most the largest sum of (1 + c) K over the contacts of a body.  Taken
 * is c = sqrt(K'/K), for what is light is not held back by what is heavy: (1 + c) K = K + sqrt(K K').  A
 * mover has books of its own, moving_structure.h, with c = 1. */
static double share_of(const fl_world *w, const fl_pair *p, int32_t i)
{
    if (p->j >= w->n) return w->b.invm[p->j] > 0.0 ? 2.0 * p->omega2_i : p->omega2_i;
    const double own = p->i == i ? p->omega2_i : p->omega2_j;
    return own + sqrt(p->omega2_i * p->omega2_j);
}

static int touched(const fl_world *w, int32_t i)
{
    return w->body_touches[i] || w->spheres.bodies || fl_body_has_bonds(w, i);
}

/* 2/omega [s] by the contacts of the last survey, and by these and all bonds. */
typedef struct {
    double touching, all;
} limits;

static double limit_of(double omega2) { return omega2 > 0.0 ? 2.0 / sqrt(omega2) : INFINITY; }

static limits limits_of(const fl_world *w, int32_t i)
{
    double sum = w->spheres.bodies ? fl_sphere_omega2(w, i) : 0.0;
    for (int64_t c = w->first_pair_of_body[i]; c < w->first_pair_of_body[i + 1]; c++) {
        const fl_neighbour_pair *q = &w->pair[w->pairs_of_body[c]];
        if (q->touching) sum += share_of(w, q->contact, i);
    }
    return (limits){limit_of(sum), limit_of(sum + fl_bond_list_omega2(w, i))};
}

/* The least limits below those, and whose. */
static void survey_bodies(const fl_world *w, limits *least, int32_t *body)
{
    limits own = {w->dt_critical_contacts, w->dt_critical};
    int32_t i_own = INT32_MAX;
#pragma omp for schedule(static) nowait
    for (int32_t i = 0; i < w->n; i++) {
        if (!touched(w, i)) continue;
        const limits it = limits_of(w, i);
        if (it.touching < own.touching) own.touching = it.touching;
        if (it.all < own.all) own.all = it.all, i_own = i;
    }
#pragma omp critical(fl_step_survey)
    {
        if (own.touching < least->touching) least->touching = own.touching;
        if (own.all < least->all || (own.all == least->all && i_own < *body))
            least->all = own.all, *body = i_own;
    }
}

/* The largest omega^2 of a body bounds the step from above; of equal ones the first body tells it. */
static void survey_stiffness(fl_world *w)
{
    limits least = {w->dt_critical_contacts, w->dt_critical};
    int32_t body = INT32_MAX;
    if (w->team.n == 1) {
        survey_bodies(w, &least, &body);
    } else {
#pragma omp parallel num_threads(w->team.n)
        survey_bodies(w, &least, &body);
    }
    w->dt_critical_contacts = least.touching;
    if (body < INT32_MAX) {
        w->dt_critical = least.all;
        w->critical_body = body;
    }
    if (w->moving.movers.n) fl_moving_structure_limit(w);
}

static int check(fl_world *w, int survey, fl_err *err)
{
    if (w->failed) return fl_fail(err, FL_SYSTEM, "out of memory in step %lld", (long long)w->step);
    for (int32_t g = 0; g < fl_block_count(w); g++)
        if (w->blocks[g].not_finite >= 0)
            return fl_fail(err, FL_NUMERIC, "body %d: not a finite number in step %lld (t = %g s)",
                           w->id[w->blocks[g].not_finite], (long long)w->step, fl_world_time(w));
    if (survey && w->dt > w->dt_critical) {
        const int32_t i = w->critical_body;
        char who[64];
        if (i >= w->b.total) snprintf(who, sizeof who, "%s", fl_mover_name(w, i - w->b.total));
        else snprintf(who, sizeof who, "body %d", w->id[i]);
        return fl_fail(err, FL_NUMERIC,
                       "%s: the step of %g s is above the critical %g s of its contacts in step %lld (t = %g "
                       "s); set a smaller run.dt or run.safety",
                       who, w->dt, w->dt_critical, (long long)w->step, fl_world_time(w));
    }
    for (int32_t k = 0; k < w->moving.movers.n; k++)
        if (!v3_finite(w->moving.movers.b.x[k]) || !v3_finite(w->moving.movers.b.f[k]) ||
            !v3_finite(w->moving.movers.b.t[k]))
            return fl_fail(err, FL_NUMERIC, "%s: not a finite number in step %lld (t = %g s)",
                           fl_mover_name(w, k), (long long)w->step, fl_world_time(w));
    return 0;
}

/* What the held things feel goes to their parts: half of it before, half after. */
static void load_parts(fl_world *w, double h)
{
    const fl_bodies *b = &w->b;
    for (int32_t p = 0; p < w->parts; p++) w->part_force[p] = w->part_torque[p] = v3(0, 0, 0);
    for (int32_t k = 0; k < w->pieces; k++) {
        const int32_t j = w->n + k, p = w->structure.piece[k].part;
        w->part_force[p] = v3_add(w->part_force[p], b->f[j]);
        w->part_torque[p] = v3_add(w->part_torque[p],
                                   v3_add(b->t[j], v3_cross(v3_sub(b->x[j], w->part_reference[p]), b->f[j])));
    }
    for (int32_t p = 0; p < w->parts; p++) {
        const double size = v3_norm(w->part_force[p]);
        if (size > w->part_peak[p]) w->part_peak[p] = size;
        w->part_impulse[p] = v3_madd(w->part_impulse[p], h, w->part_force[p]);
        w->part_moment[p] = v3_madd(w->part_moment[p], h, w->part_torque[p]);
    }
}

/* Let what lies ahead be booked, or not. */
static void ahead(fl_world *w, double sign)
{
    const fl_work a = fl_work_ahead(w);
    w->ledger.damping += sign * a.damping;
    w->ledger.friction += sign * a.friction;
    w->ledger.drive += sign * a.drive;
}

/* The deepest overlap of a step, over the radii, and whose. */
typedef struct {
    double overlap;
    int32_t i, j;
} deepest;

/* Overlaps, counts, and whether action is reaction. */
static void account(fl_world *w, double dt, deepest *d)
{
    const fl_bodies *b = &w->b;
    fl_vec3 balance = v3(0, 0, 0);
    *d = (deepest){.i = -1, .j = -1};
    for (int32_t c = 0; c < w->n_touching; c++) {
        if (c + 2 * ON_WAY < w->n_touching)
            __builtin_prefetch(&w->pair[w->touching_pairs[c + 2 * ON_WAY]].contact);
        if (c + ON_WAY < w->n_touching) {
            const fl_pair *next = w->pair[w->touching_pairs[c + ON_WAY]].contact;
            __builtin_prefetch(&next->force), __builtin_prefetch(&next->overlap);
        }
        const fl_pair *p = w->pair[w->touching_pairs[c]].contact;
        const double R = b->radius[p->i] + b->radius[p->j], deep = R > 0.0 ? p->overlap / R : 0.0;
        if (deep > d->overlap) *d = (deepest){deep, fl_world_id(w, p->i), fl_world_id(w, p->j)};
        w->impulse_sum += dt * v3_norm(p->force);
        w->contact_steps++;
    }
    if (w->spheres.bodies) {
        const fl_sphere_totals all = fl_contact_list_totals(w);
        if (all.max_overlap > d->overlap)
            *d = (deepest){all.max_overlap, fl_world_id(w, all.i), fl_world_id(w, all.j)};
        w->impulse_sum += dt * all.force_sum;
        w->contact_steps += all.touching;
    }
    for (int32_t k = 0; k < w->bonds.n; k++) w->impulse_sum += dt * v3_norm(w->bonds.bond[k].force);
    if (d->overlap > w->max_overlap) {
        w->max_overlap = d->overlap;
        w->max_overlap_i = d->i;
        w->max_overlap_j = d->j;
        w->max_overlap_time = fl_world_time(w);
    }
    if (d->overlap > FL_DEEP_OVERLAP && !w->deep_overlap_steps++) {
        w->deep_overlap_i = d->i;
        w->deep_overlap_j = d->j;
        w->deep_overlap_time = fl_world_time(w);
    }
    for (int32_t g = 0; g < fl_block_count(w); g++) balance = v3_add(balance, w->blocks[g].contact_force);
    for (int32_t k = w->n; k < b->total; k++) balance = v3_add(balance, b->f[k]);
    w->imbalance = v3_madd(w->imbalance, dt, balance);
}

/* From the first such overlap on the books are looked at every WATCH steps. */
static int watch(fl_world *w, fl_err *err)
{
    return w->deep_overlap_steps && w->step % WATCH == 0 ? fl_energy_check(w, err) : 0;
}

int fl_step_start(fl_world *w, fl_err *err)
{
    int32_t body;
    if (fl_check_wave_sampling(w, err)) return -1;
    w->dt_safe = fmin(fl_automatic_step(w, &body), CAREFUL * fl_critical_step(w));
    w->sea.time = fl_world_time(w);
    if (fl_neighbour_list_update(w, err)) return -1;
    if (w->panel_load.panels) fl_panels_clear(w);
    stride q = {.w = w, .survey = 1, .err = err};
    if (stride_on(&q)) return -1;
    if (w->moving.movers.n) {
        fl_moving_structure_set_step(w);
        fl_moving_structure_second_half(w, 0.0, 0.0);
    }
    survey_stiffness(w);
    if (check(w, 1, err)) return -1;
    ahead(w, 1.0);
    fl_energy_update(w);
    w->ledger.start = w->ledger.kinetic + w->ledger.gravity + w->ledger.elastic + w->ledger.hydrostatic +
                      w->ledger.structure + w->ledger.spring + w->ledger.bond;
    fl_energy_update(w);
    return 0;
}

int fl_step(fl_world *w, fl_err *err)
{
    const double dt = w->dt, h = 0.5 * dt;
    const int rides = w->moving.movers.n > 0, survey = surveyed(w, w->step + 1);
    deepest deep;

    fl_thread_count_begin(&w->team);
    load_parts(w, h);
    if (w->panel_load.panels && fl_panels_accumulate(w, h, err)) return -1;
    fl_ledger_begin_step(w);
    if (rides) fl_moving_structure_first_half(w, fl_world_time(w));
    if (w->panel_load.panels) fl_panels_clear(w);
    stride q = {.w = w, .dt = dt, .survey = survey, .out = 1, .err = err};
    if (stride_on(&q)) return -1;
    if (q.parted) {
        if (fl_neighbour_list_from_blocks(w, err)) return -1;
        q.out = 0;
        if (stride_on(&q)) return -1;
    }
    if (rides) fl_moving_structure_second_half(w, fl_world_time(w), h);
    fl_ledger_book_step(w);
    account(w, dt, &deep);
    load_parts(w, h);
    if (w->panel_load.panels && fl_panels_accumulate(w, h, err)) return -1;
    if (survey) survey_stiffness(w);
    if (check(w, survey, err) || watch(w, err)) return -1;
    w->sea.sample_now = 1; /* whoever is put anywhere between two steps is looked at */
    if (w->inflow.absent && fl_inflow_step(w, err)) return -1;
    if (w->sleep.state) fl_sleep_update(w);
    fl_thread_count_end(&w->team);
    return 0;
}

/* What lies ahead is booked already, and gets another length. */
void fl_step_set_size(fl_world *w, double dt, double t)
{
    ahead(w, -1.0);
    w->t0 = t;
    w->step0 = w->step;
    w->dt = dt;
    ahead(w, 1.0);
    if (w->moving.movers.n) fl_moving_structure_set_step(w);
}
