/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/relaxed_run.h"
#include "sim/first_half.h"
#include "sim/second_half.h"
#include "sim/step.h"
#include <assert.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>
#include "base/array.h"
#include "base/parallel.h"
#include "body/integrate.h"
#include "contact/active_pairs.h"
#include "contact/bond_list.h"
#include "contact/crushing.h"
#include "contact/joint_list.h"
#include "contact/panel_load.h"
#include "sim/body_step.h"
#include "sim/breaking.h"
#include "sim/critical_step.h"
#include "sim/device_step.h"
#include "sim/drive_track.h"
#include "sim/energy_balance.h"
#include "sim/energy_ledger.h"
#include "sim/ice_push.h"
#include "sim/inflow.h"
#include "sim/member_structure.h"
#include "sim/moving_structure.h"
#include "sim/neighbour_list.h"
#include "sim/sleep.h"
#include "sim/stiffness_update.h"
#include "sim/strip_setup.h"
#include "sim/zone_step.h"
#include "sphere/contact_force.h"
#include "sphere/contact_list.h"
#include "world/access.h"

/* dt_safe is at most this share of the predicted critical step; equal to the default of run.safety. */
#define SAFE_SHARE 0.2

enum {
    CHECK_INTERVAL = 16,   /* steps between two checks of the energy balance after a deep overlap */
    THINGS_AT_ONCE = 8,    /* pieces and walls whose forces a thread sums at a time */
    PREFETCH_DISTANCE = 8, /* contacts to prefetch ahead of the one being summed, which takes far less time */
};

/* --- a step by a team of threads ---------------------------------------------------------------- */

typedef struct {
    fl_world *w;
    double dt;
    int update_stiffness;
    int first_half;   /* run the first half kick and the drift before the contacts */
    int needs_search; /* the team stopped after the drift: the neighbour list must be updated first */
    int failed;
    fl_err *err;
} step_context;

/* End of the drift: move pieces and walls without a mover, count the step, set the time of the water. */
static void advance_time(fl_world *w)
{
    for (int32_t k = w->n; k < w->b.total; k++)
        if (!fl_piece_moves(w, k)) fl_drift(&w->b, k, w->dt);
    w->step++;
    w->sea.time = fl_world_time(w);
    w->sea.sample_now = w->sea.sample_every < 2 || w->step % w->sea.sample_every == 0;
}

static void after_drift(void *arg)
{
    step_context *const q = arg;
    advance_time(q->w);
    q->needs_search = fl_neighbour_list_due(q->w);
    if (!q->needs_search) fl_share_active_pairs(q->w);
}

/* Collect the pairs that touch, and what depends on them. */
static void after_contacts(void *arg)
{
    step_context *const q = arg;
    fl_world *const w = q->w;
    fl_work_share_split(w->block_share, w->team.n, fl_block_count(w));
    fl_collect_touching(w);
    fl_contact_sums_assign(w);
    if (w->bonds.ended) { /* the neighbour list must take up the pair of an ended bond */
        w->last_search_step = -1;
        w->bonds.ended = 0;
    }
    if (w->panel_load.all && fl_panels_sort(w, q->err)) q->failed = 1;
    if (w->sleep.n_resting) fl_sleep_wake_touched(w);
}

/* First or second half of the motion of the floes, block by block. */
static void move_blocks(step_context *q, int thread, int second)
{
    fl_world *const w = q->w;
    const double h = 0.5 * q->dt;
    const int32_t each = fl_blocks_per_turn(w);
    for (int32_t k = 0; k < w->team.n; k++) {
        fl_work_share *const s = &w->block_share[(thread + k) % w->team.n];
        for (int32_t g = fl_work_share_take(s, each); g < s->end; g = fl_work_share_take(s, each)) {
            const int32_t last = g + each < s->end ? g + each : s->end;
            if (second) fl_blocks_second_half(w, g, last, h);
            else fl_blocks_first_half(w, g, last, h);
        }
    }
}

/* Wake the bodies that have to leave sleep, and run the first half of their long step. */
static void wake_bodies(fl_world *w, int thread, int threads)
{
    const int32_t all = fl_block_count(w);
    fl_sleep_find_waking(w, thread, threads);
    fl_barrier_wait(&w->barrier, threads, NULL, NULL);
#pragma omp for schedule(static, 1) nowait
    for (int32_t g = 0; g < all; g += FL_BLOCKS_AT_ONCE)
        fl_blocks_wake(w, g, g + FL_BLOCKS_AT_ONCE < all ? g + FL_BLOCKS_AT_ONCE : all);
    fl_barrier_wait(&w->barrier, threads, NULL, NULL);
}

/* Bonds, then all other near pairs.  Contacts are independent: each writes only its own record. */
static void evaluate_pairs(fl_world *w, double dt, int update_stiffness)
{
    const int32_t discs = w->device.gpu && dt > 0.0 ? 0 : w->discs.n; /* else the device has them */
#pragma omp for schedule(static) nowait
    for (int32_t k = 0; k < w->bonds.n; k += FL_BOND_LIST_RUN)
        fl_bond_list_evaluate(w, k, k + FL_BOND_LIST_RUN < w->bonds.n ? k + FL_BOND_LIST_RUN : w->bonds.n);
#pragma omp for schedule(static) nowait
    for (int32_t k = 0; k < discs; k += FL_DISC_RUN)
        fl_disc_list_evaluate(w, k, k + FL_DISC_RUN < discs ? k + FL_DISC_RUN : discs, dt);
    fl_evaluate_active_pairs(w, dt, update_stiffness);
}

static_assert(FL_SPHERE_CHUNK % FL_BODY_BLOCK == 0 && FL_SPHERE_CHUNK / FL_BODY_BLOCK <= FL_BLOCKS_AT_ONCE,
              "a chunk consists of whole blocks");

static void finish_chunk(fl_world *w, int32_t a, double h)
{
    const int32_t each = FL_SPHERE_CHUNK / FL_BODY_BLOCK, all = fl_block_count(w), from = a * each;
    if (from < all) fl_blocks_second_half(w, from, from + each < all ? from + each : all, h);
}

/* Sphere contacts of chunk a refer to bodies of chunk a or of later chunks.  A thread works on consecutive
 * chunks.  If no earlier chunk refers to a, the forces on a are complete, and its second half kick can run at
 * once, while its data are in the cache.  The other chunks follow after a barrier.  Contacts read copies of
 * the bodies (fl_sphere_state), so a chunk that has moved on does not disturb them. */
static void sphere_chunks(step_context *q, int thread, int threads)
{
    fl_world *const w = q->w;
    const fl_sphere_contacts *s = &w->spheres;
    const int32_t from = fl_sphere_chunk_share(w, thread, threads),
                  to = fl_sphere_chunk_share(w, thread + 1, threads);
    for (int32_t a = from; a < to; a++) {
        fl_sphere_chunk_evaluate(w, a, q->dt, q->update_stiffness);
        s->finished[a] = s->first_source[a] >= from;
        if (s->finished[a]) finish_chunk(w, a, 0.5 * q->dt);
    }
    fl_barrier_wait(&w->barrier, threads, NULL, NULL);
    for (int32_t a = from; a < to; a++)
        if (!s->finished[a]) finish_chunk(w, a, 0.5 * q->dt);
}

/* The part of a step that every thread of the team runs, with a barrier after each stage. */
static void run_step_in_team(step_context *q)
{
    fl_world *const w = q->w;
    const int thread = omp_get_thread_num(), threads = omp_get_num_threads();
    const int by_chunks = w->spheres.bodies && !w->sleep.state && !w->panel_load.panels;

    /* bodies: drag h, kick h, drift dt */
    if (q->first_half) {
        move_blocks(q, thread, 0);
        if (w->zones.set.blocks) {
            fl_barrier_wait(&w->barrier, threads, NULL, NULL);
            fl_zones_first_half(w, 0.5 * q->dt);
        }
        fl_barrier_wait(&w->barrier, threads, after_drift, q);
        if (q->needs_search) return;
    }
    /* sleep: wake bodies; spheres never sleep */
    if (w->sleep.state) wake_bodies(w, thread, threads);

    /* contacts: spheres, unless they run by chunks below; bonds; all other pairs */
    if (!by_chunks && w->spheres.chunks) {
#pragma omp for schedule(dynamic) nowait
        for (int32_t a = 0; a < w->spheres.chunks; a++)
            fl_sphere_chunk_evaluate(w, a, q->dt, q->update_stiffness);
    }
    evaluate_pairs(w, q->dt, q->update_stiffness);
    if (w->zones.set.blocks) fl_zones_stress(w);
    fl_barrier_wait(&w->barrier, threads, after_contacts, q);
    if (q->failed) return;

    /* bodies: external and contact forces, kick h, drag h */
    if (by_chunks) sphere_chunks(q, thread, threads);
    else move_blocks(q, thread, 1);

        /* pieces and walls: contact forces */
#pragma omp for schedule(static, THINGS_AT_ONCE) nowait
    for (int32_t k = w->n; k < w->b.total; k++) fl_body_sum_forces(w, k);

    /* this barrier spins; that at the end of the parallel region would put threads to sleep */
    fl_barrier_wait(&w->barrier, threads, NULL, NULL);
    if (w->zones.set.blocks) fl_zones_second_half(w, 0.5 * q->dt);
}

/* Tables of the waves for time t. */
static int prepare_waves(fl_world *w, double t, fl_err *err)
{
    return fl_environment_prepare(&w->sea, &w->b, w->inflow.absent, t, w->team.n, err);
}

/* The pairs that are not of spheres. */
static void evaluate_guests_pairs(fl_world *w, double dt, int update_stiffness)
{
    fl_share_active_pairs(w);
    if (w->team.n == 1) {
        evaluate_pairs(w, dt, update_stiffness);
    } else {
#pragma omp parallel num_threads(w->team.n)
        evaluate_pairs(w, dt, update_stiffness);
    }
}

/* The same step where a device runs the spheres. */
static int run_device_step(step_context *q)
{
    fl_world *const w = q->w;
    const double h = 0.5 * q->dt;
    if (q->first_half) {
        if (fl_device_first_half(w, h, q->err)) return -1;
        advance_time(w);
        q->needs_search = fl_neighbour_list_due(w);
        if (q->needs_search) return fl_device_before_search(w, q->err);
    } else if (fl_device_take_lists(w, q->err)) {
        return -1;
    }
    if (fl_device_contacts(w, q->err)) return -1;
    evaluate_guests_pairs(w, q->dt, q->update_stiffness);
    if (fl_device_sums(w, q->err)) return -1;
    after_contacts(q);
    if (q->failed || fl_device_second_half(w, h, q->update_stiffness, q->err)) return -1;
    for (int32_t k = w->n; k < w->b.total; k++) fl_body_sum_forces(w, k);
    return 0;
}

/* A parallel region costs as much as a step of three floes, so a team of one runs without it. */
static int run_step(step_context *q)
{
    const int32_t team = q->w->team.n;
    if (q->w->device.gpu && q->dt > 0.0) return run_device_step(q);
    fl_work_share_split(q->w->block_share, team, fl_block_count(q->w));
    q->w->zones.dt = q->dt;
    if (!q->first_half) fl_share_active_pairs(q->w);
    if (team == 1) {
        run_step_in_team(q);
    } else {
#pragma omp parallel num_threads(team)
        run_step_in_team(q);
    }
    return q->failed ? -1 : 0;
}

/* --- checks and sums after a step ---------------------------------------------------------------- */

static int check_state(fl_world *w, int update_stiffness, fl_err *err)
{
    if (w->failed) return fl_fail(err, FL_SYSTEM, "out of memory in step %lld", (long long)w->step);
    if (w->zones.set.blocks && w->zones.set.inside_out >= 0) return fl_zones_fail(w, err);
    for (int32_t g = 0; g < fl_block_count(w); g++)
        if (w->blocks[g].not_finite >= 0)
            return fl_fail(err, FL_NUMERIC, "body %d: not a finite number in step %lld (t = %g s)",
                           w->id[w->blocks[g].not_finite], (long long)w->step, fl_world_time(w));
    if (update_stiffness && w->dt > w->dt_critical) {
        const int32_t i = w->critical_body;
        char name[64];
        if (i >= w->b.total) snprintf(name, sizeof name, "%s", fl_mover_name(w, i - w->b.total));
        else snprintf(name, sizeof name, "body %d", w->id[i]);
        return fl_fail(err, FL_NUMERIC,
                       "%s: the step of %g s is above the critical %g s of its contacts in step %lld (t = %g "
                       "s); set a smaller run.dt or run.safety%s",
                       name, w->dt, w->dt_critical, (long long)w->step, fl_world_time(w),
                       w->breaking.on ? ", or a larger failure.fragment_min" : "");
    }
    for (int32_t k = 0; k < w->moving.movers.n; k++)
        if (!v3_finite(w->moving.movers.b.x[k]) || !v3_finite(w->moving.movers.b.f[k]) ||
            !v3_finite(w->moving.movers.b.t[k]))
            return fl_fail(err, FL_NUMERIC, "%s: not a finite number in step %lld (t = %g s)",
                           fl_mover_name(w, k), (long long)w->step, fl_world_time(w));
    return fl_structure_has_members(w) ? fl_member_structure_check(w, err) : 0;
}

/* Adds a force and a torque about the origin of piece or wall j to part p. */
static void load_part(fl_world *w, int32_t p, int32_t j, fl_vec3 force, fl_vec3 torque)
{
    const fl_vec3 arm = v3_sub(w->b.x[j], w->part_reference[p]);
    w->part_force[p] = v3_add(w->part_force[p], force);
    w->part_torque[p] = v3_add(w->part_torque[p], v3_add(torque, v3_cross(arm, force)));
}

/* Adds the contacts with a piece of several parts that one of them bears. */
static void load_joined_parts(fl_world *w, int32_t j)
{
    for (int64_t c = w->first_pair_of_body[j]; c < w->first_pair_of_body[j + 1]; c++) {
        const int32_t k = w->pairs_of_body[c];
        const fl_pair *p = w->pair_touches[k] ? w->pair[k].contact : NULL;
        if (p && p->load_part >= 0) load_part(w, p->load_part, j, v3_neg(p->force), p->torque_j);
    }
}

/* Forces on the pieces summed per part; their impulses over the time h. */
static void load_parts(fl_world *w, double h)
{
    const fl_bodies *b = &w->b;
    for (int32_t p = 0; p < w->parts; p++) w->part_force[p] = w->part_torque[p] = v3(0, 0, 0);
    for (int32_t k = 0; k < w->pieces; k++) {
        const fl_piece *piece = &w->structure.piece[k];
        if (piece->several_parts) load_joined_parts(w, w->n + k);
        else load_part(w, piece->part, w->n + k, b->f[w->n + k], b->t[w->n + k]);
    }
    for (int32_t k = 0; k < w->panel_load.shares; k++) {
        const fl_load_share *s = &w->panel_load.share[k];
        load_part(w, s->part, s->j, s->force, s->torque);
    }
    for (int32_t p = 0; p < w->parts; p++) {
        const double size = v3_norm(w->part_force[p]);
        if (size > w->part_peak[p]) w->part_peak[p] = size;
        w->part_impulse[p] = v3_madd(w->part_impulse[p], h, w->part_force[p]);
        w->part_moment[p] = v3_madd(w->part_moment[p], h, w->part_torque[p]);
    }
}

/* Loads of now, over the time h, on parts and panels. */
static int add_loads(fl_world *w, double h, fl_err *err)
{
    load_parts(w, h);
    return w->panel_load.panels && fl_panels_accumulate(w, h, err) ? -1 : 0;
}

/* Works of the next half kick are booked ahead (fl_work_ahead()); when dt changes they are taken out and
 * booked anew.  sign: 1 to book, -1 to take out. */
static void book_work_ahead(fl_world *w, double sign)
{
    const fl_work a = fl_work_ahead(w);
    w->ledger.damping += sign * a.damping;
    w->ledger.friction += sign * a.friction;
    w->ledger.drive += sign * a.drive;
}

/* Largest overlap of a step over the sum of the radii, and the ids of the two. */
typedef struct {
    double overlap;
    int32_t i, j;
} deepest;

static void record_deepest(fl_world *w, const deepest *d)
{
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
}

/* Overlaps, contact counts, and the balance of momentum. */
static void gather_overlaps(fl_world *w, double dt)
{
    const fl_bodies *b = &w->b;
    fl_vec3 balance = v3(0, 0, 0);
    deepest d = {.i = -1, .j = -1};
    for (int32_t c = 0; c < w->n_touching; c++) {
        if (c + 2 * PREFETCH_DISTANCE < w->n_touching)
            __builtin_prefetch(&w->pair[w->touching_pairs[c + 2 * PREFETCH_DISTANCE]].contact);
        if (c + PREFETCH_DISTANCE < w->n_touching) {
            const fl_pair *next = w->pair[w->touching_pairs[c + PREFETCH_DISTANCE]].contact;
            __builtin_prefetch(&next->force), __builtin_prefetch(&next->overlap);
        }
        const fl_pair *p = w->pair[w->touching_pairs[c]].contact;
        const double R = b->radius[p->i] + b->radius[p->j], deep = R > 0.0 ? p->overlap / R : 0.0;
        if (deep > d.overlap) d = (deepest){deep, fl_world_id(w, p->i), fl_world_id(w, p->j)};
        w->impulse_sum += dt * v3_norm(p->force);
        w->contact_steps++;
    }
    if (w->spheres.bodies) {
        const fl_sphere_totals all = fl_contact_list_totals(w);
        if (all.max_overlap > d.overlap)
            d = (deepest){all.max_overlap, fl_world_id(w, all.i), fl_world_id(w, all.j)};
        w->impulse_sum += dt * all.force_sum;
        w->contact_steps += all.touching;
    }
    for (int32_t k = 0; k < w->bonds.n; k++) w->impulse_sum += dt * v3_norm(w->bonds.bond[k].force);
    if (w->discs.n) w->impulse_sum += dt * fl_disc_list_force_sum(w);
    record_deepest(w, &d);
    for (int32_t g = 0; g < fl_block_count(w); g++) balance = v3_add(balance, w->blocks[g].contact_force);
    for (int32_t k = w->n; k < b->total; k++) balance = v3_add(balance, b->f[k]);
    w->imbalance = v3_madd(w->imbalance, dt, balance);
}

/* After the first deep overlap the energy balance is checked every CHECK_INTERVAL steps. */
static int check_energy_after_overlap(fl_world *w, fl_err *err)
{
    if (!w->deep_overlap_steps || w->step % CHECK_INTERVAL) return 0;
    return fl_device_refresh(w, err) || fl_energy_check(w, err) ? -1 : 0;
}

/* --- the step ----------------------------------------------------------------------------------- */

int fl_step_start(fl_world *w, fl_err *err)
{
    int32_t body;
    if (fl_check_wave_sampling(w, err)) return -1;
    if (w->strips.wall && fl_strips_check_start(w, err)) return -1;
    w->dt_safe = fmin(fl_automatic_step(w, &body), SAFE_SHARE * fl_critical_step(w));
    w->sea.time = fl_world_time(w);
    if (prepare_waves(w, w->sea.time, err)) return -1;

    /* neighbour list, contacts and forces */
    if (fl_neighbour_list_update(w, err)) return -1;
    if (w->panel_load.all) fl_panels_clear(w);
    step_context q = {.w = w, .update_stiffness = 1, .err = err};
    if (run_step(&q)) return -1;
    if (fl_structure_moves(w)) {
        fl_moving_structure_set_step(w);
        fl_moving_structure_second_half(w, 0.0, 0.0);
    }
    /* critical step */
    fl_stiffness_update(w);
    if (w->automatic_dt && fl_shorten_step_at_start(w)) { /* damping and friction depend on the step */
        if (w->panel_load.all) fl_panels_clear(w);
        if (run_step(&q)) return -1;
        if (fl_structure_moves(w)) {
            fl_moving_structure_set_step(w);
            fl_moving_structure_second_half(w, 0.0, 0.0);
        }
        fl_stiffness_update(w);
    }
    if (check_state(w, 1, err)) return -1;

    /* reference of the energy ledger */
    book_work_ahead(w, 1.0);
    fl_energy_update(w);
    w->ledger.start = w->ledger.kinetic + w->ledger.gravity + w->ledger.elastic + w->ledger.hydrostatic +
                      w->ledger.structure + w->ledger.spring + w->ledger.bond + w->ledger.zones +
                      w->ledger.fracture +
                      fl_joint_list_friction_loss(w); /* of joints that begin beyond their strength */
    fl_energy_update(w);
    return 0;
}

int fl_step(fl_world *w, fl_err *err)
{
    const double dt = w->dt, h = 0.5 * dt;
    const int moves = fl_structure_moves(w), update_stiffness = fl_stiffness_due(w, w->step + 1);

    /* loads: half a step of the present forces on the structure */
    fl_thread_count_begin(&w->team);
    if (add_loads(w, h, err)) return -1;

    /* moving structure: first half */
    fl_ledger_begin_step(w);
    if (w->push.of) fl_ice_push_first_half(w, fl_world_time(w));
    else if (w->driven_floes.track.n) fl_drive_track_begin_step(w, fl_world_time(w));
    if (moves) fl_moving_structure_first_half(w, fl_world_time(w));

    /* tables of the waves */
    if (w->sea.by_blocks && prepare_waves(w, w->t0 + (double)(w->step + 1 - w->step0) * dt, err)) return -1;

    /* bodies: first half; contacts; bodies: second half */
    if (w->panel_load.all) fl_panels_clear(w);
    step_context q = {.w = w, .dt = dt, .update_stiffness = update_stiffness, .first_half = 1, .err = err};
    if (run_step(&q)) return -1;
    if (q.needs_search) { /* the skin is used up: update the neighbour list, then the contacts */
        if (fl_neighbour_list_from_blocks(w, err)) return -1;
        q.first_half = 0;
        if (run_step(&q)) return -1;
    }
    /* moving structure: second half */
    if (moves) fl_moving_structure_second_half(w, fl_world_time(w), h);
    if (w->push.of) fl_ice_push_second_half(w);

    /* energy ledger, overlaps, momentum */
    fl_ledger_book_step(w);
    if (w->strips.wall && fl_strips_book(w, dt, err)) return -1;
    if (w->zones.set.blocks) fl_zones_book(w);
    if (w->relax.kind) fl_relaxed_run_end_step(w);
    gather_overlaps(w, dt);
    if (w->crushing.of != FL_CRUSHING_NONE && fl_crushing_book(w, err)) return -1;

    /* loads: half a step of the new forces */
    if (add_loads(w, h, err)) return -1;

    /* critical step and checks */
    if (update_stiffness) fl_stiffness_update(w);
    if (w->strips.wall && fl_strips_check(w, err)) return -1;
    if (check_state(w, update_stiffness, err) || check_energy_after_overlap(w, err)) return -1;

    /* floes that break; outflow and inflow; a floe placed between two steps samples the water */
    w->sea.sample_now = 1;
    if (w->breaking.on && fl_breaking_step(w, err)) return -1;
    if (w->inflow.absent && fl_inflow_step(w, err)) return -1;

    /* sleep */
    if (w->sleep.state) fl_sleep_update(w);

    /* number of threads of the next step */
    fl_thread_count_end(&w->team);
    return 0;
}

/* The works of the next half kick, booked ahead, are taken out and booked anew with the new dt. */
void fl_step_set_size(fl_world *w, double dt, double t)
{
    book_work_ahead(w, -1.0);
    w->t0 = t;
    w->step0 = w->step;
    w->dt = dt;
    book_work_ahead(w, 1.0);
    if (fl_structure_moves(w)) fl_moving_structure_set_step(w);
}
