/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/first_half.h"
#include "base/simd.h"
#include "sim/body_step.h"
#include "sim/half_kick_batch.h"
#include "sphere/contact_force.h"
#include "sphere/floating_batch.h"

static fl_velocity_change velocities_of(const fl_bodies *b, int32_t k)
{
    return (fl_velocity_change){b->v[k], b->w[k]};
}

static fl_velocity_change batch_velocities(const fl_body_batch *s, int32_t k)
{
    return (fl_velocity_change){v3(s->v[0][k], s->v[1][k], s->v[2][k]),
                                v3(s->w[0][k], s->w[1][k], s->w[2][k])};
}

/* Store the change by the first half of a step: by drag from `before` to `after`, then by the kick. */
static void store_predicted_change(fl_world *w, int32_t k, fl_velocity_change before,
                                   fl_velocity_change after, fl_velocity_change change)
{
    fl_set_predicted_change(w, k, v3_add(change.v, v3_sub(after.v, before.v)),
                            v3_add(change.w, v3_sub(after.w, before.w)));
}

/* Store the change by drag in the first half of a step, which sphere contacts need. */
static void store_drag_change(fl_world *w, int32_t k, fl_velocity_change before, fl_velocity_change after)
{
    if (w->drag_change)
        w->drag_change[k] = (fl_velocity_change){v3_sub(after.v, before.v), v3_sub(after.w, before.w)};
}

/* First half for the bodies of a batch, which is empty afterwards. */
static void begin_batch(fl_world *w, fl_batch_list *c, double h)
{
    fl_bodies *b = &w->b;
    fl_environment *sea = &w->sea;
    const int kicks = b->added_mass || sea->waves;
    const int32_t *previous = w->previous_sums.slot, *at = c->at, n = c->n;
    int32_t busy[FL_BODY_BATCH], n_busy = 0, any = 0;
    fl_velocity_change before[FL_BODY_BATCH];
    double g[6][FL_BODY_BATCH];
    fl_body_batch_water water_batch, *water;
    fl_body_batch s;
    if (n == 0) return;
    for (int32_t k = 0; k < n; k++) any |= previous[at[k]];
    for (int32_t k = 0; k < n && any; k++) {
        busy[n_busy] = k;
        n_busy += previous[at[k]] != 0;
    }
    for (int32_t k = 0; k < n_busy; k++) before[k] = velocities_of(b, at[busy[k]]);
    fl_batch_list_load(w, &s, c, h);
    c->n = 0;
    fl_body_batch_load_forces(&s, b);
    fl_body_batch_load_pose(&s, b);
    water = fl_batch_load_water(w, &s, &water_batch);
    if (n_busy || kicks || sea->drag_surface) fl_body_batch_update_axes(&s);
    if (sea->n) fl_still_water_batch_drag(sea, b, &s, water, 0);
    if (n_busy) fl_body_batch_velocity_change(&s, water, g);
    for (int32_t k = 0; k < n_busy; k++) {
        const int32_t i = at[busy[k]];
        const fl_velocity_change change = fl_batch_kick_change(g, busy[k]);
        *fl_kick_change(w, i) = change;
        store_predicted_change(w, i, before[k], batch_velocities(&s, busy[k]), change);
    }
    if (kicks) fl_batch_kick(w, &s, water);
    else fl_body_batch_kick_momentum(&s);
    const int done = fl_body_batch_drift(&s, water);
    fl_body_batch_store_velocities(&s, b);
    if (done) fl_body_batch_store_pose(&s, b);
    if (done && water) fl_body_batch_store_water(&s, water, b);
    for (int32_t k = 0; k < n && !done; k++) fl_drift(b, at[k], 2.0 * s.h[k]);
}

static void begin_spheres(fl_world *w, int32_t from, int32_t to, double h)
{
    for (int32_t k = from; k < to && (w->sea.n || w->n_touching); k++) {
        const fl_velocity_change before = velocities_of(&w->b, k);
        if (w->sea.n) fl_environment_drag(&w->sea, &w->b, k, h, 0);
        store_drag_change(w, k, before, velocities_of(&w->b, k));
        store_predicted_change(w, k, before, velocities_of(&w->b, k), fl_sphere_kick_change(&w->b, k, h));
    }
    fl_kick_drift_isotropic(&w->b, from, to, h, 2.0 * h);
}

static void begin_body(fl_world *w, int32_t k, double h)
{
    if (fl_body_absent(w, k) || fl_sleep_phase_of(w, k) != FL_AWAKE) return;
    fl_velocity_change change, *const stored = fl_kick_change(w, k);
    const fl_velocity_change before = velocities_of(&w->b, k);
    if (w->sea.n) fl_environment_drag(&w->sea, &w->b, k, h, 0);
    const fl_velocity_change after = velocities_of(&w->b, k);
    if (w->b.is_isotropic[k]) store_drag_change(w, k, before, after);
    fl_body_kick_stored(w, k, h, stored ? stored : &change);
    if (stored) store_predicted_change(w, k, before, after, *stored);
    fl_drift(&w->b, k, 2.0 * h);
}

/* Bodies [from, to); the last of them may still be in the batch on return. */
static void begin_bodies(fl_world *w, int32_t from, int32_t to, double h, fl_batch_list *c)
{
    int32_t end;
    const int floating = fl_floating_batch_applies(w);
    for (int32_t k = from; k < to; k = end) {
        end = floating ? fl_floating_run_end(w, k, k + FL_BODY_BLOCK < to ? k + FL_BODY_BLOCK : to, 0) : k;
        if (end > k) {
            fl_floating_batch_begin(w, k, end, h);
            continue;
        }
        end = fl_simple_run_end(w, k, to);
        if (end == k) begin_body(w, end++, h);
        else if (w->b.is_isotropic[k]) begin_spheres(w, k, end, h);
        else
            while (k < end) {
                k = fl_batch_list_add(c, k, end);
                if (c->n == FL_BODY_BATCH) begin_batch(w, c, h);
            }
    }
}

/* The same for those of them that are awake. */
static void begin_awake_bodies(fl_world *w, int32_t from, int32_t to, double h, fl_batch_list *c)
{
    int32_t active[FL_BLOCKS_AT_ONCE * FL_BODY_BLOCK];
    const int32_t n = fl_sleep_list_active(w, from, to, active);
    for (int32_t i = 0; i < n; i++) {
        const int32_t k = active[i], end = w->b.is_isotropic[k] ? fl_simple_run_end(w, k, to) : k;
        if (end > k) begin_spheres(w, k, end, h), i += end - k - 1; /* spheres never sleep */
        else if (w->sleep.phase[k] != FL_AWAKE || !fl_body_is_simple(w, k)) begin_body(w, k, h);
        else c->at[c->n++] = k;
        if (c->n == FL_BODY_BATCH) begin_batch(w, c, h);
    }
}

/* The two largest paths since the last search: of each lane, then of all. */
FL_SIMD_VERSIONS static void find_largest_moves(int32_t n, const double *restrict now,
                                                const double *restrict found, double *restrict moved)
{
    fl_simd one = {0}, two = {0};
    double first[2] = {0.0, 0.0};
    int32_t k = 0;
    for (; k + FL_SIMD_WIDTH <= n; k += FL_SIMD_WIDTH) {
        const fl_simd move = FL_SIMD_LOAD(&now[k]) - FL_SIMD_LOAD(&found[k]);
        const fl_simd_mask longer = move > one;
        const fl_simd less = FL_SIMD_SELECT(longer, one, move);
        one = FL_SIMD_SELECT(longer, move, one);
        two = FL_SIMD_SELECT(less > two, less, two);
    }
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++)
        fl_update_two_largest(first, one[l]), fl_update_two_largest(first, two[l]);
    for (; k < n; k++) fl_update_two_largest(first, now[k] - found[k]);
    moved[0] = first[0], moved[1] = first[1];
}

void fl_blocks_first_half(fl_world *w, int32_t g, int32_t last, double h)
{
    const int32_t first = g * FL_BODY_BLOCK, all = fl_block_end(w, last - 1);
    fl_batch_list c = {.n = 0};
    if (w->sleep.state) begin_awake_bodies(w, first, all, h, &c);
    else begin_bodies(w, first, all, h, &c);
    begin_batch(w, &c, h);
    for (int32_t k = g; k < last; k++) {
        const int32_t from = k * FL_BODY_BLOCK, to = fl_block_end(w, k);
        if (w->spheres.bodies) fl_sphere_block_update(w, from, to, h);
        find_largest_moves(to - from, w->b.odometer + from, w->odometer_at_search + from,
                           w->blocks[k].largest_moves);
    }
}

/* First half of the long step of a body that wakes; its path is in the odometer already. */
static void wake_body(fl_world *w, int32_t k)
{
    const double odometer = w->b.odometer[k];
    fl_body_first_half(w, k, fl_sleep_duration(w, k));
    w->b.odometer[k] = odometer;
}

static void wake_batch(fl_world *w, fl_batch_list *c)
{
    const int32_t n = c->n;
    double odometer[FL_BODY_BATCH];
    for (int32_t k = 0; k < n; k++) odometer[k] = w->b.odometer[c->at[k]];
    begin_batch(w, c, 0.0);
    for (int32_t k = 0; k < n; k++) w->b.odometer[c->at[k]] = odometer[k];
}

void fl_blocks_wake(fl_world *w, int32_t g, int32_t last)
{
    int32_t active[FL_BLOCKS_AT_ONCE * FL_BODY_BLOCK];
    const int32_t n = fl_sleep_list_active(w, g * FL_BODY_BLOCK, fl_block_end(w, last - 1), active);
    fl_batch_list c = {.n = 0};
    for (int32_t i = 0; i < n; i++) {
        const int32_t k = active[i];
        if (w->sleep.phase[k] != FL_WAKING) continue;
        fl_sleep_first_half(w, k);
        if (!fl_body_is_simple(w, k)) wake_body(w, k);
        else c.at[c.n++] = k;
        if (c.n == FL_BODY_BATCH) wake_batch(w, &c);
    }
    wake_batch(w, &c);
}

void fl_bodies_first_half(fl_world *w, const int32_t *body, int32_t n, double h)
{
    fl_batch_list c = {.n = 0};
    for (int32_t k = 0; k < n; k++) begin_bodies(w, body[k], body[k] + 1, h, &c);
    begin_batch(w, &c, h);
}
