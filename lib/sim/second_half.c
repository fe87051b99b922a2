/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/second_half.h"
#include "base/array.h"
#include "base/simd.h"
#include "contact/bond_list.h"
#include "sim/body_step.h"
#include "sim/energy_ledger.h"
#include "sim/half_kick_batch.h"
#include "sphere/contact_force.h"
#include "sphere/contact_list.h"
#include "sphere/floating_batch.h"
#include "sphere/free_batch.h"

/* 1 if body k has a contact that touches.  Listed pairs do not count: they depend on the last search. */
static int has_contact(const fl_world *w, int32_t k)
{
    return w->body_touches[k] || (w->spheres.bodies && w->spheres.contact_count[k]) ||
           fl_body_has_bonds(w, k);
}

/* Contact force on floe i. */
static fl_vec3 contact_force_on(const fl_world *w, int32_t i)
{
    fl_vec3 f = w->b.f[i];
    if (w->driven_floes.n) f.z += fl_driven_floe_force(w, i);
    f = v3_madd(f, -w->b.m[i], w->gravity);
    if (w->relax.kind) f = v3_sub(f, fl_sums_now(w, i)->damping); /* dashpots cancel in the sum over bodies */
    return w->sea.water ? v3_sub(f, fl_environment_water_force(&w->sea, i)) : f;
}

static fl_body_block *block_of(const fl_world *w, int32_t k) { return &w->blocks[k / FL_BODY_BLOCK]; }

/* Add the contact force on floe k to its block; it is 0 without contacts. */
static void add_contact_force(const fl_world *w, int32_t k, fl_body_block *own)
{
    if (has_contact(w, k)) own->contact_force = v3_add(own->contact_force, contact_force_on(w, k));
}

/* Works are added in the order of the bodies, in a batch or not: the sum has the same bits. */
static void add_works(fl_body_block *own, fl_work q)
{
    own->damping_work += q.damping;
    own->friction_work += q.friction;
}

static void add_sphere_works(fl_body_block *own, const fl_free_batch_work *q, int32_t n)
{
    for (int32_t k = 0; k < n; k++) own->damping_work += q->damping[k], own->friction_work += q->friction[k];
}

/* Find the bodies of a batch that have contacts now or had some in the step before; returns how many. */
static int32_t find_touching(const fl_world *w, const fl_batch_list *c, int32_t busy[FL_BODY_BATCH])
{
    const int32_t *at = c->at, n = c->n;
    const int all = w->bonds.n > 0 || w->relax.kind;
    const int32_t *slot = w->contact_sums.slot, *previous = w->previous_sums.slot;
    int32_t n_busy = 0, any = 0;
    if (!w->contact_sums.one_each && !w->previous_sums.one_each) {
        for (int32_t k = 0; k < n; k++) any |= slot[at[k]] | previous[at[k]];
        for (int32_t k = 0; k < n && any; k++) {
            busy[n_busy] = k;
            n_busy += (slot[at[k]] | previous[at[k]]) != 0;
        }
        return n_busy;
    }
    for (int32_t k = 0; k < n; k++)
        if (all || w->body_touches[at[k]] || w->contact_sums.sum[slot[at[k]]].contacts ||
            w->previous_sums.sum[previous[at[k]]].contacts)
            busy[n_busy++] = k;
    return n_busy;
}

/* External forces on a batch, into the arrays of the bodies and of the batch. */
static void find_forces(fl_world *w, fl_body_batch *s)
{
    int32_t left[FL_BODY_BATCH], others = 0;
    if (w->driven_floes.n || (w->sea.water && !fl_still_water_batch_applies(&w->sea))) {
        for (int32_t k = 0; k < s->n; k++) left[others++] = k;
    } else {
        fl_body_batch_set_weight(s, w->gravity);
        if (w->sea.water) others = fl_still_water_batch_force(&w->sea, &w->b, s, left);
        fl_body_batch_store_forces(s, &w->b);
    }
    for (int32_t k = 0; k < others; k++) {
        fl_body_external_force(w, s->index[left[k]]);
        fl_body_batch_load_force(s, &w->b, left[k]);
    }
}

/* The bodies of a batch that wake in this step, and their velocities before its last drag. */
typedef struct {
    int32_t n, which[FL_BODY_BATCH];
    fl_vec3 v[FL_BODY_BATCH], spin[FL_BODY_BATCH];
} waking_list;

static void find_waking(const fl_world *w, const fl_body_batch *s, waking_list *e)
{
    e->n = 0;
    if (!w->sleep.state) return;
    for (int32_t k = 0; k < s->n; k++) {
        e->which[e->n] = k;
        e->n += w->sleep.phase[s->index[k]] == FL_WAKING;
    }
    for (int32_t i = 0; i < e->n; i++) {
        const int32_t k = e->which[i];
        e->v[i] = v3(s->v[0][k], s->v[1][k], s->v[2][k]);
        e->spin[i] = v3(s->w[0][k], s->w[1][k], s->w[2][k]);
    }
}

/* Second half for the bodies of a batch, which is empty afterwards. */
static void end_batch(fl_world *w, fl_batch_list *c, double h)
{
    fl_bodies *b = &w->b;
    fl_environment *sea = &w->sea;
    const int32_t *at = c->at, n = c->n;
    int32_t busy[FL_BODY_BATCH];
    const int32_t n_busy = find_touching(w, c, busy);
    double g[6][FL_BODY_BATCH];
    fl_body_batch_water water_batch, *water;
    waking_list e;
    fl_body_batch s;
    if (n == 0) return;
    fl_batch_list_load(w, &s, c, h);
    c->n = 0;
    fl_body_batch_update_axes(&s);
    find_forces(w, &s);
    for (int32_t k = 0; k < n_busy; k++) {
        fl_body_contact_force(w, at[busy[k]]);
        fl_body_batch_load_force(&s, b, busy[k]);
    }
    water = fl_batch_load_water(w, &s, &water_batch);
    fl_batch_kick(w, &s, water);
    find_waking(w, &s, &e);
    if (sea->n) fl_still_water_batch_drag(sea, b, &s, water, 1);
    fl_body_batch_store_velocities(&s, b);
    for (int32_t k = 0; k < e.n; k++) {
        fl_sleep_finish_skip(w, at[e.which[k]], e.v[k], e.spin[k]);
        fl_sleep_set_awake(w, at[e.which[k]]);
    }
    if (n_busy) fl_body_batch_velocity_change(&s, water, g);
    for (int32_t k = 0; k < n_busy; k++) {
        const int32_t i = at[busy[k]];
        const fl_velocity_change back = fl_batch_kick_change(g, busy[k]);
        add_contact_force(w, i, block_of(w, i));
        add_works(block_of(w, i), fl_work_of_step(w, i, fl_kick_change(w, i), &back));
    }
}

/* Second half for free spheres; their first kick follows from the forces before. */
static void end_free_spheres(fl_world *w, int32_t from, int32_t to, double h, fl_body_block *own)
{
    fl_bodies *b = &w->b;
    fl_velocity_change first[FL_BODY_BLOCK];
    for (int32_t k = from; k < to; k++) {
        first[k - from] = fl_sphere_kick_change(b, k, h);
        fl_body_sum_forces(w, k);
    }
    fl_kick_drift_isotropic(b, from, to, h, 0.0);
    for (int32_t k = from; k < to; k++) {
        const fl_velocity_change back = fl_sphere_kick_change(b, k, h);
        if (w->sea.n) fl_environment_drag(&w->sea, b, k, h, 1);
        add_contact_force(w, k, own);
        add_works(own, fl_work_of_step(w, k, &first[k - from], &back));
    }
}

/* Velocity change of body k by the first kick, computed before the forces are updated.  For a sphere that
 * only touches spheres it was not stored. */
static fl_velocity_change first_change_of(const fl_world *w, int32_t k, double h)
{
    const fl_velocity_change *const stored = fl_kick_change(w, k);
    fl_velocity_change g = {0};
    if (stored) return *stored;
    if (!w->spheres.bodies || !w->b.is_isotropic[k]) return g;
    fl_body_accelerations(&w->b, k, &g.v, &g.w);
    return (fl_velocity_change){v3_scale(h, g.v), v3_scale(h, g.w)};
}

static void end_body(fl_world *w, int32_t k, double h, fl_body_block *own)
{
    if (fl_body_absent(w, k)) { /* its forces are 0 since it left */
        fl_sums_clear(w, k);
        return;
    }
    const enum fl_sleep_phase kind = fl_sleep_phase_of(w, k);
    const fl_velocity_change first = first_change_of(w, k, h);
    fl_velocity_change back = {0};
    if (fl_is_asleep(w, k)) {
        if (fl_sums_now(w, k)->contacts || fl_sums_before(w, k)->contacts)
            *fl_sums_now(w, k) = *fl_sums_before(w, k); /* forces on resting bodies stay */
    } else if (kind == FL_WAKING) fl_sleep_second_half(w, k);
    else fl_body_sum_forces(w, k);
    if (kind == FL_BALLISTIC) return;
    add_contact_force(w, k, own);
    if (!(h > 0.0) || kind == FL_RESTING) { return; }
    if (kind == FL_WAKING) {
        fl_sleep_set_awake(w, k);
    } else {
        fl_body_kick_stored(w, k, h, &back);
        if (w->sea.n) fl_environment_drag(&w->sea, &w->b, k, h, 1);
    }
    add_works(own, fl_work_of_step(w, k, &first, &back));
}

/* Second half for the run of spheres from k on that free_batch.h handles; returns its end. */
static int32_t end_batched_spheres(fl_world *w, int32_t k, int32_t to, double h, fl_body_block *own,
                                   int *finite)
{
    fl_free_batch_work works;
    int32_t end = k;
    while (h > 0.0 && end < to && fl_is_free_sphere(w, end)) end++;
    for (int32_t i = k; i < end && w->contact_sums.one_each; i++) fl_sums_clear(w, i);
    if (end > k && !fl_free_batch_end_step(w, k, end, h, &works)) *finite = 0;
    add_sphere_works(own, &works, end - k);
    for (int32_t i = k; i < end; i++)
        own->contact_force = v3_add(own->contact_force, v3_madd(w->b.f[i], -w->b.m[i], w->gravity));
    return end;
}

/* Second half for a block of dry spheres alone that only touch spheres and walls, now and before.
 * Returns 0 if the block is not such a block. */
static int end_sphere_block(fl_world *w, int32_t from, int32_t to, double h, fl_body_block *own, int *finite)
{
    const int32_t *slot = w->contact_sums.slot, *previous = w->previous_sums.slot;
    fl_free_batch_work works;
    int32_t touched = 0;
    if (!w->spheres.bodies || !w->b.is_isotropic[from] || w->sea.n || w->driven_floes.n || w->discs.n ||
        w->contact_sums.one_each || !(h > 0.0))
        return 0;
    for (int32_t k = from; k < to; k++) touched |= slot[k] | previous[k];
    if (touched || fl_simple_run_end(w, from, to) < to) return 0;
    *finite = fl_free_batch_end_step(w, from, to, h, &works);
    add_sphere_works(own, &works, to - from);
    for (int32_t k = from; k < to; k++)
        own->contact_force = v3_add(own->contact_force, v3_madd(w->b.f[k], -w->b.m[k], w->gravity));
    return 1;
}

/* First of the spheres [k, to) that free_batch.h handles; k is none. */
static int32_t next_batched_sphere(const fl_world *w, int32_t k, int32_t to)
{
    while (++k < to && !fl_is_free_sphere(w, k)) {}
    return k;
}

/* 1 if n numbers of each of five arrays are finite: 0 x is 0 for a finite x.  A sum that overflows gives
 * 0, too; first_not_finite() then tests each number. */
FL_SIMD_VERSIONS static int all_finite(const double *restrict a, const double *restrict b,
                                       const double *restrict c, const double *restrict d,
                                       const double *restrict e, int32_t n)
{
    double zero = 0.0;
#pragma omp simd reduction(+ : zero)
    for (int32_t k = 0; k < n; k++) zero += 0.0 * (((a[k] + b[k]) + (c[k] + d[k])) + e[k]);
    return zero == 0.0;
}

/* First of bodies [from, to) with a number that is not finite, or -1. */
static int32_t first_not_finite(const fl_bodies *b, int32_t from, int32_t to)
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

/* Clear the results of block g, and collect the sphere sums of its bodies. */
static void start_block(fl_world *w, int32_t g)
{
    const int32_t from = g * FL_BODY_BLOCK, to = fl_block_end(w, g);
    w->blocks[g] = (fl_body_block){.not_finite = -1};
    if (!w->spheres.bodies || !w->spheres.is_listed[g]) return;
    fl_prefetch(&w->spheres.previous_sum[to],
                FL_BODY_BLOCK * sizeof *w->spheres.previous_sum); /* of the next block */
    fl_sphere_sums_collect(w, from, to);
}

/* Second half for the run of spheres from k on that floating_batch.h handles; returns its end. */
static int32_t end_floating_spheres(fl_world *w, int32_t k, int32_t to, double h, fl_body_block *own)
{
    fl_floating_result r;
    const int32_t end = h > 0.0 && fl_floating_batch_applies(w) ? fl_floating_run_end(w, k, to, 1) : k;
    if (end == k) return k;
    fl_floating_batch_end(w, k, end, h, &r);
    for (int32_t i = k; i < end; i++) {
        const int32_t at = i - k;
        if (has_contact(w, i)) own->contact_force = v3_add(own->contact_force, r.contact_force[at]);
        if (!w->spheres.bodies || !(w->spheres.contact_count[i] | w->spheres.previous_contact_count[i]))
            continue;
        const fl_velocity_change first = {r.first_dv[at], r.first_dw[at]},
                                 second = {r.second_dv[at], r.second_dw[at]};
        add_works(own, fl_work_of_step(w, i, &first, &second));
    }
    return end;
}

/* Second half for the run of spheres from k on that need the same operations, within one block [k, to);
 * returns its end.  *finite = 0 unless their numbers are known to be finite. */
static int32_t end_sphere_run(fl_world *w, int32_t k, int32_t to, double h, int *finite)
{
    fl_body_block *own = block_of(w, k);
    int32_t end = end_batched_spheres(w, k, to, h, own, finite);
    if (end > k) return end;
    *finite = 0;
    end = end_floating_spheres(w, k, to, h, own);
    if (end > k) return end;
    end = h > 0.0 ? fl_simple_run_end(w, k, to) : k;
    if (end == k) {
        end_body(w, k, h, own);
        return k + 1;
    }
    end = next_batched_sphere(w, k, end);
    end_free_spheres(w, k, end, h, own);
    return end;
}

/* Second half for block g; returns 1 if a number may not be finite. */
static int end_block(fl_world *w, int32_t g, double h, fl_batch_list *c)
{
    const int32_t from = g * FL_BODY_BLOCK, to = fl_block_end(w, g);
    int finite = 1;
    start_block(w, g);
    if (end_sphere_block(w, from, to, h, &w->blocks[g], &finite)) return !finite;
    for (int32_t k = from, end; k < to; k = end) {
        if (w->b.is_isotropic[k]) {
            end_batch(w, c, h); /* sums follow the order of the bodies */
            end = end_sphere_run(w, k, to, h, &finite);
            continue;
        }
        finite = 0;
        end = h > 0.0 ? fl_simple_run_end(w, k, to) : k;
        if (end == k) {
            end_batch(w, c, h);
            end_body(w, end++, h, &w->blocks[g]);
            continue;
        }
        while (k < end) {
            k = fl_batch_list_add(c, k, end);
            if (c->n == FL_BODY_BATCH) end_batch(w, c, h);
        }
    }
    return !finite;
}

/* Second half for the bodies of blocks [g, last) that are not ballistic.  suspect: 1 if a number may not be
 * finite. A body that wakes and is touched is handled alone, see fl_sleep_second_half(). */
static void end_awake_bodies(fl_world *w, int32_t g, int32_t last, double h, fl_batch_list *c,
                             int suspect[FL_BLOCKS_AT_ONCE])
{
    int32_t active[FL_BLOCKS_AT_ONCE * FL_BODY_BLOCK];
    const int32_t n = fl_sleep_list_active(w, g * FL_BODY_BLOCK, fl_block_end(w, last - 1), active);
    for (int32_t i = 0; i < n; i++) {
        const int32_t k = active[i];
        int finite = 1;
        suspect[k / FL_BODY_BLOCK - g] = 1;
        if (w->b.is_isotropic[k]) { /* spheres never sleep */
            end_batch(w, c, h);
            i += end_sphere_run(w, k, fl_block_end(w, k / FL_BODY_BLOCK), h, &finite) - k - 1;
            continue;
        }
        const uint8_t kind = w->sleep.phase[k];
        const int goes = kind == FL_AWAKE || (kind == FL_WAKING && !w->body_touches[k]);
        if (goes && h > 0.0 && fl_body_is_simple(w, k)) {
            c->at[c->n++] = k;
            if (c->n == FL_BODY_BATCH) end_batch(w, c, h);
        } else {
            end_batch(w, c, h);
            end_body(w, k, h, block_of(w, k));
        }
    }
}

void fl_blocks_second_half(fl_world *w, int32_t g, int32_t last, double h)
{
    fl_batch_list c = {.n = 0};
    int suspect[FL_BLOCKS_AT_ONCE];
    if (w->sleep.state) {
        for (int32_t k = g; k < last; k++) start_block(w, k), suspect[k - g] = 0;
        end_awake_bodies(w, g, last, h, &c, suspect);
    } else {
        for (int32_t k = g; k < last; k++) suspect[k - g] = end_block(w, k, h, &c);
    }
    end_batch(w, &c, h);
    for (int32_t k = g; k < last; k++)
        if (suspect[k - g])
            w->blocks[k].not_finite = first_not_finite(&w->b, k * FL_BODY_BLOCK, fl_block_end(w, k));
}

fl_body_block fl_body_second_half(fl_world *w, int32_t k, double h)
{
    fl_body_block *const own = block_of(w, k);
    fl_batch_list c = {.n = 0};
    int finite = 1;
    *own = (fl_body_block){.not_finite = -1};
    if (w->b.is_isotropic[k]) end_sphere_run(w, k, k + 1, h, &finite);
    else if (fl_body_is_simple(w, k)) c.at[c.n++] = k;
    else end_body(w, k, h, own);
    end_batch(w, &c, h);
    own->not_finite = first_not_finite(&w->b, k, k + 1);
    return *own;
}
