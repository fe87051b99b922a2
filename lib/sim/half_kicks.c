/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "base/simd.h"
#include "body/body_batch.h"
#include "body/integrate.h"
#include "sim/body_step.h"
#include "sphere/contact_force.h"
#include "sphere/contact_list.h"
#include "contact/bond_list.h"
#include "sim/half_kicks.h"
#include "sphere/free_batch.h"
#include "sim/sleep.h"
#include "sim/energy_ledger.h"
#include "water/still_water_batch.h"

static int32_t end_of(const fl_world *w, int32_t g)
{
    const int32_t end = (g + 1) * FL_BODY_BLOCK;
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
    if (w->b.is_isotropic[k] && (w->b.added_mass || w->sea.waves)) return k;
    to = run_of(w->b.is_isotropic, w->b.is_isotropic[k], k, run_of(w->b.fixed_dof, 0, k, to));
    return w->inflow.absent ? run_of(w->inflow.absent, 0, k, to) : to;
}

/* Whether that holds for k by itself, and it is no ball. */
static int alone(const fl_world *w, int32_t k)
{
    return !(w->b.is_isotropic[k] || w->b.fixed_dof[k] || fl_body_absent(w, k));
}

/* Those of them that are no balls go FL_BODY_BATCH at a time. */
typedef struct {
    int32_t n, at[FL_BODY_BATCH];
} crew;

/* Of bodies [k, end) as many as there is room for; behind the last of them. */
static int32_t join(crew *c, int32_t k, int32_t end)
{
    if (c->n == 0 && k + FL_BODY_BATCH <= end) {
        for (int32_t i = 0; i < FL_BODY_BATCH; i++) c->at[i] = k + i;
        c->n = FL_BODY_BATCH;
        return k + FL_BODY_BATCH;
    }
    while (k < end && c->n < FL_BODY_BATCH) c->at[c->n++] = k++;
    return k;
}

/* Half of the step that body k is in. */
static double half_of(const fl_world *w, int32_t k, double h)
{
    return fl_sleep_phase_of(w, k) == FL_WAKING ? 0.5 * fl_sleep_duration(w, k) : h;
}

static void take(const fl_world *w, fl_body_batch *s, crew *c, double h)
{
    fl_body_batch_load(s, &w->b, c->at, c->n, h);
    for (int32_t k = 0; k < s->lanes && w->sleep.state; k++) s->h[k] = half_of(w, s->index[k], h);
}

/* Something presses on it now.  Not whether there are rows at all: that hangs on when pairs were found. */
static int presses(const fl_world *w, int32_t k)
{
    return w->body_touches[k] || (w->spheres.bodies && w->spheres.contact_count[k]) ||
           fl_body_has_bonds(w, k);
}

/* Where bodies move water with them. */
static fl_body_batch_water *take_water(const fl_world *w, const fl_body_batch *s, fl_body_batch_water *a)
{
    if (!w->b.added_mass) return NULL;
    fl_body_batch_load_water(a, &w->b, s);
    return a;
}

/* A kick of all of it, which wants R; in waves the work of the water is booked with it. */
static void kick_few(fl_world *w, fl_body_batch *s, const fl_body_batch_water *water)
{
    double v[3][FL_BODY_BATCH], spin[3][FL_BODY_BATCH];
    if (w->sea.waves) memcpy(v, s->v, sizeof v), memcpy(spin, s->w, sizeof spin);
    fl_body_batch_kick(s, water);
    if (w->sea.waves) fl_still_water_batch_add_work(&w->sea, s, v, spin);
}

/* What a kick by h gives to a ball that is unbound; */
static fl_velocity_change gain_of(const fl_bodies *b, int32_t k, double h)
{
    return (fl_velocity_change){v3_scale(h * b->invm[k], b->f[k]), v3_scale(h * b->invI[k].x, b->t[k])};
}

/* to another body that is; */
static fl_velocity_change gain_free(const fl_bodies *b, int32_t k, double h)
{
    const fl_vec3 f = b->f[k], turn = fl_body_apply_inverse_inertia(b, k, v3_scale(h, b->t[k]));
    return (fl_velocity_change){b->added_mass ? v3_scale(h, fl_body_velocity_of_momentum(b, k, f))
                                              : v3_scale(h * b->invm[k], f),
                                turn};
}

/* to the k-th of a few. */
static fl_velocity_change gain_few(double (*g)[FL_BODY_BATCH], int32_t k)
{
    return (fl_velocity_change){v3(g[0][k], g[1][k], g[2][k]), v3(g[3][k], g[4][k], g[5][k])};
}

/* Its speeds. */
static fl_velocity_change speeds_of(const fl_bodies *b, int32_t k)
{
    return (fl_velocity_change){b->v[k], b->w[k]};
}

static fl_velocity_change speeds_few(const fl_body_batch *s, int32_t k)
{
    return (fl_velocity_change){v3(s->v[0][k], s->v[1][k], s->v[2][k]),
                                v3(s->w[0][k], s->w[1][k], s->w[2][k])};
}

/* The first half of a step: from `before` to `after` by drag, and gain by the kick. */
static void set_lead(fl_world *w, int32_t k, fl_velocity_change before, fl_velocity_change after,
                     fl_velocity_change gain)
{
    fl_set_predicted_change(w, k, v3_add(gain.v, v3_sub(after.v, before.v)),
                            v3_add(gain.w, v3_sub(after.w, before.w)));
}

/* Drag has taken it from `before` to `after`, in the first half of a step; rows of spheres will ask. */
static void set_drag(fl_world *w, int32_t k, fl_velocity_change before, fl_velocity_change after)
{
    if (w->drag_change)
        w->drag_change[k] = (fl_velocity_change){v3_sub(after.v, before.v), v3_sub(after.w, before.w)};
}

/* w may be the mean of a step before a kick, which is no gain of it. */
static void kick(fl_world *w, int32_t k, double h, fl_velocity_change *gain)
{
    const fl_vec3 v = w->b.v[k], spin = w->b.w[k];
    const int turns = !(w->b.fixed_dof[k] & (FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ));
    *gain = gain_free(&w->b, k, h);
    fl_body_kick(w, k, h);
    if (w->b.fixed_dof[k]) gain->v = v3_sub(w->b.v[k], v);
    if (!turns) gain->w = v3_sub(w->b.w[k], spin);
}

/* --- the first half ---------------------------------------------------------------------------- */

/* Nobody is left in the crew. */
static void begin_few(fl_world *w, crew *c, double h)
{
    fl_bodies *b = &w->b;
    fl_environment *sea = &w->sea;
    const int kicks = b->added_mass || sea->waves;
    const int32_t *was = w->previous_sums.slot, *at = c->at, n = c->n;
    int32_t busy[FL_BODY_BATCH], many = 0, any = 0;
    fl_velocity_change before[FL_BODY_BATCH];
    double g[6][FL_BODY_BATCH];
    fl_body_batch_water along, *water;
    fl_body_batch s;
    if (n == 0) return;
    for (int32_t k = 0; k < n; k++) any |= was[at[k]];
    for (int32_t k = 0; k < n && any; k++) {
        busy[many] = k;
        many += was[at[k]] != 0;
    }
    for (int32_t k = 0; k < many; k++) before[k] = speeds_of(b, at[busy[k]]);
    take(w, &s, c, h);
    c->n = 0;
    fl_body_batch_load_forces(&s, b);
    fl_body_batch_load_pose(&s, b);
    water = take_water(w, &s, &along);
    if (many || kicks || sea->drag_surface) fl_body_batch_update_axes(&s);
    if (sea->n) fl_still_water_batch_drag(sea, b, &s, water, 0);
    if (many) fl_body_batch_velocity_change(&s, water, g);
    for (int32_t k = 0; k < many; k++) {
        const int32_t i = at[busy[k]];
        const fl_velocity_change gain = gain_few(g, busy[k]);
        *fl_kick_change(w, i) = gain;
        set_lead(w, i, before[k], speeds_few(&s, busy[k]), gain);
    }
    if (kicks) kick_few(w, &s, water);
    else fl_body_batch_kick_momentum(&s);
    const int done = fl_body_batch_drift(&s, water);
    fl_body_batch_store_velocities(&s, b);
    if (done) fl_body_batch_store_pose(&s, b);
    if (done && water) fl_body_batch_store_water(&s, water, b);
    for (int32_t k = 0; k < n && !done; k++) fl_drift(b, at[k], 2.0 * s.h[k]);
}

static void begin_balls(fl_world *w, int32_t from, int32_t to, double h)
{
    for (int32_t k = from; k < to && (w->sea.n || w->n_touching); k++) {
        const fl_velocity_change before = speeds_of(&w->b, k);
        if (w->sea.n) fl_environment_drag(&w->sea, &w->b, k, h, 0);
        set_drag(w, k, before, speeds_of(&w->b, k));
        set_lead(w, k, before, speeds_of(&w->b, k), gain_of(&w->b, k, h));
    }
    fl_kick_drift_isotropic(&w->b, from, to, h, 2.0 * h);
}

static void begin_one(fl_world *w, int32_t k, double h)
{
    if (fl_body_absent(w, k) || fl_sleep_phase_of(w, k) != FL_AWAKE) return;
    fl_velocity_change gain, *const kept = fl_kick_change(w, k);
    const fl_velocity_change before = speeds_of(&w->b, k);
    if (w->sea.n) fl_environment_drag(&w->sea, &w->b, k, h, 0);
    const fl_velocity_change after = speeds_of(&w->b, k);
    if (w->b.is_isotropic[k]) set_drag(w, k, before, after);
    kick(w, k, h, kept ? kept : &gain);
    if (kept) set_lead(w, k, before, after, *kept);
    fl_drift(&w->b, k, 2.0 * h);
}

/* Bodies [from, to); some of them may be in the crew when it returns. */
static void begin(fl_world *w, int32_t from, int32_t to, double h, crew *c)
{
    int32_t end;
    for (int32_t k = from; k < to; k = end) {
        end = alike(w, k, to);
        if (end == k) begin_one(w, end++, h);
        else if (w->b.is_isotropic[k]) begin_balls(w, k, end, h);
        else
            while (k < end) {
                k = join(c, k, end);
                if (c->n == FL_BODY_BATCH) begin_few(w, c, h);
            }
    }
}

/* Those of them that are awake. */
static void begin_awake(fl_world *w, int32_t from, int32_t to, double h, crew *c)
{
    int32_t up[FL_BLOCKS_AT_ONCE * FL_BODY_BLOCK];
    const int32_t n = fl_sleep_list_active(w, from, to, up);
    for (int32_t i = 0; i < n; i++) {
        const int32_t k = up[i], end = w->b.is_isotropic[k] ? alike(w, k, to) : k;
        if (end > k) begin_balls(w, k, end, h), i += end - k - 1; /* none of them sleeps */
        else if (w->sleep.phase[k] != FL_AWAKE || !alone(w, k)) begin_one(w, k, h);
        else c->at[c->n++] = k;
        if (c->n == FL_BODY_BATCH) begin_few(w, c, h);
    }
}

/* The longest way and the next: of each lane, then of all. */
FL_SIMD_VERSIONS static void farthest(int32_t n, const double *restrict now, const double *restrict found,
                                      double *restrict moved)
{
    fl_simd one = {0}, two = {0};
    double first[2] = {0.0, 0.0};
    int32_t k = 0;
    for (; k + FL_SIMD_WIDTH <= n; k += FL_SIMD_WIDTH) {
        const fl_simd way = FL_SIMD_LOAD(&now[k]) - FL_SIMD_LOAD(&found[k]);
        const fl_simd_mask longer = way > one;
        const fl_simd less = FL_SIMD_SELECT(longer, one, way);
        one = FL_SIMD_SELECT(longer, way, one);
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
    const int32_t first = g * FL_BODY_BLOCK, all = end_of(w, last - 1);
    crew c = {.n = 0};
    if (w->sleep.state) begin_awake(w, first, all, h, &c);
    else begin(w, first, all, h, &c);
    begin_few(w, &c, h);
    for (int32_t k = g; k < last; k++) {
        const int32_t from = k * FL_BODY_BLOCK, to = end_of(w, k);
        if (w->spheres.bodies) fl_sphere_states_update(w, from, to, h);
        farthest(to - from, w->b.odometer + from, w->odometer_at_search + from, w->blocks[k].largest_moves);
    }
}

/* The longer step of one whose sleep ends; the way of all of it is in the odometer. */
static void rouse_one(fl_world *w, int32_t k)
{
    const double odometer = w->b.odometer[k];
    fl_body_first_half(w, k, fl_sleep_duration(w, k));
    w->b.odometer[k] = odometer;
}

static void rouse_few(fl_world *w, crew *c)
{
    const int32_t n = c->n;
    double odometer[FL_BODY_BATCH];
    for (int32_t k = 0; k < n; k++) odometer[k] = w->b.odometer[c->at[k]];
    begin_few(w, c, 0.0);
    for (int32_t k = 0; k < n; k++) w->b.odometer[c->at[k]] = odometer[k];
}

void fl_blocks_wake(fl_world *w, int32_t g, int32_t last)
{
    int32_t up[FL_BLOCKS_AT_ONCE * FL_BODY_BLOCK];
    const int32_t n = fl_sleep_list_active(w, g * FL_BODY_BLOCK, end_of(w, last - 1), up);
    crew c = {.n = 0};
    for (int32_t i = 0; i < n; i++) {
        const int32_t k = up[i];
        if (w->sleep.phase[k] != FL_WAKING) continue;
        fl_sleep_first_half(w, k);
        if (!alone(w, k)) rouse_one(w, k);
        else c.at[c.n++] = k;
        if (c.n == FL_BODY_BATCH) rouse_few(w, &c);
    }
    rouse_few(w, &c);
}

/* --- the second -------------------------------------------------------------------------------- */

/* What contacts push body i < n with. */
static fl_vec3 pushed(const fl_world *w, int32_t i)
{
    double drawn = 0.0;
    fl_vec3 f = w->b.f[i];
    const double k = w->driven_floes.n ? fl_driven_floe_spring(w, i, &drawn) : 0.0;
    if (w->driven_floes.n) f.z += k * drawn;
    f = v3_madd(f, -w->b.m[i], w->gravity);
    return w->sea.water ? v3_sub(f, fl_environment_water_force(&w->sea, i)) : f;
}

static fl_body_block *group_of(const fl_world *w, int32_t k) { return &w->blocks[k / FL_BODY_BLOCK]; }

/* What nothing presses has no works of contacts, and its push is 0. */
static void push(const fl_world *w, int32_t k, fl_body_block *own)
{
    if (presses(w, k)) own->contact_force = v3_add(own->contact_force, pushed(w, k));
}

/* Body by body in their order, whichever way they go: the sum has the same bits. */
static void book(fl_body_block *own, fl_work q)
{
    own->damping_work += q.damping;
    own->friction_work += q.friction;
}

static void book_plain(fl_body_block *own, const fl_free_batch_work *q, int32_t n)
{
    for (int32_t k = 0; k < n; k++) own->damping_work += q->damping[k], own->friction_work += q->friction[k];
}

/* Which of a few have more to do than what the water asks, 0 the first: something presses on them, or has
 * left them something to forget. */
static int32_t find_busy(const fl_world *w, const crew *c, int32_t busy[FL_BODY_BATCH])
{
    const int32_t *at = c->at, n = c->n;
    const int all = w->bonds.n > 0;
    const int32_t *sink = w->contact_sums.slot, *was = w->previous_sums.slot;
    int32_t many = 0, any = 0;
    if (!w->contact_sums.one_each && !w->previous_sums.one_each) {
        for (int32_t k = 0; k < n; k++) any |= sink[at[k]] | was[at[k]];
        for (int32_t k = 0; k < n && any; k++) {
            busy[many] = k;
            many += (sink[at[k]] | was[at[k]]) != 0;
        }
        return many;
    }
    for (int32_t k = 0; k < n; k++)
        if (all || w->body_touches[at[k]] || w->contact_sums.sum[sink[at[k]]].contacts ||
            w->previous_sums.sum[was[at[k]]].contacts)
            busy[many++] = k;
    return many;
}

/* What acts on a few but their contacts, in the arrays of the bodies and in their own. */
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

/* Those of a few whose sleep ends with this step, and their speeds before the drag of it. */
typedef struct {
    int32_t n, which[FL_BODY_BATCH];
    fl_vec3 v[FL_BODY_BATCH], spin[FL_BODY_BATCH];
} enders;

static void find_enders(const fl_world *w, const fl_body_batch *s, enders *e)
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

/* Nobody is left in the crew. */
static void end_few(fl_world *w, crew *c, double h)
{
    fl_bodies *b = &w->b;
    fl_environment *sea = &w->sea;
    const int32_t *at = c->at, n = c->n;
    int32_t busy[FL_BODY_BATCH];
    const int32_t many = find_busy(w, c, busy);
    double g[6][FL_BODY_BATCH];
    fl_body_batch_water along, *water;
    enders e;
    fl_body_batch s;
    if (n == 0) return;
    take(w, &s, c, h);
    c->n = 0;
    fl_body_batch_update_axes(&s);
    find_forces(w, &s);
    for (int32_t k = 0; k < many; k++) {
        fl_body_contact_force(w, at[busy[k]]);
        fl_body_batch_load_force(&s, b, busy[k]);
    }
    water = take_water(w, &s, &along);
    kick_few(w, &s, water);
    find_enders(w, &s, &e);
    if (sea->n) fl_still_water_batch_drag(sea, b, &s, water, 1);
    fl_body_batch_store_velocities(&s, b);
    for (int32_t k = 0; k < e.n; k++) {
        fl_sleep_finish_skip(w, at[e.which[k]], e.v[k], e.spin[k]);
        fl_sleep_set_awake(w, at[e.which[k]]);
    }
    if (many) fl_body_batch_velocity_change(&s, water, g);
    for (int32_t k = 0; k < many; k++) {
        const int32_t i = at[busy[k]];
        const fl_velocity_change back = gain_few(g, busy[k]);
        push(w, i, group_of(w, i));
        book(group_of(w, i), fl_work_of_step(w, i, fl_kick_change(w, i), &back));
    }
}

/* Of a ball the first kick is known from the forces that it had. */
static void end_balls(fl_world *w, int32_t from, int32_t to, double h, fl_body_block *own)
{
    fl_bodies *b = &w->b;
    fl_velocity_change first[FL_BODY_BLOCK];
    for (int32_t k = from; k < to; k++) {
        first[k - from] = gain_of(b, k, h);
        fl_body_sum_forces(w, k);
    }
    fl_kick_drift_isotropic(b, from, to, h, 0.0);
    for (int32_t k = from; k < to; k++) {
        const fl_velocity_change back = gain_of(b, k, h);
        if (w->sea.n) fl_environment_drag(&w->sea, b, k, h, 1);
        push(w, k, own);
        book(own, fl_work_of_step(w, k, &first[k - from], &back));
    }
}

/* What the first kick gave to body k, before forces are those of the end of the step.  Of spheres it is asked
 * for whoever presses on them, and nobody has kept it where only spheres do. */
static fl_velocity_change first_of(const fl_world *w, int32_t k, double h)
{
    const fl_velocity_change *const kept = fl_kick_change(w, k);
    fl_velocity_change g = {0};
    if (kept) return *kept;
    if (!w->spheres.bodies || !w->b.is_isotropic[k]) return g;
    fl_body_accelerations(&w->b, k, &g.v, &g.w);
    return (fl_velocity_change){v3_scale(h, g.v), v3_scale(h, g.w)};
}

static void end_one(fl_world *w, int32_t k, double h, fl_body_block *own)
{
    const enum fl_sleep_phase kind = fl_sleep_phase_of(w, k);
    const fl_velocity_change first = first_of(w, k, h);
    fl_velocity_change back = {0};
    if (fl_is_asleep(w, k)) {
        if (fl_sums_now(w, k)->contacts || fl_sums_before(w, k)->contacts)
            *fl_sums_now(w, k) = *fl_sums_before(w, k); /* what presses stays */
    } else if (kind == FL_WAKING) fl_sleep_second_half(w, k);
    else fl_body_sum_forces(w, k);
    if (fl_body_absent(w, k) || kind == FL_BALLISTIC) return;
    push(w, k, own);
    if (!(h > 0.0) || kind == FL_RESTING) { return; }
    if (kind == FL_WAKING) {
        fl_sleep_set_awake(w, k);
    } else {
        kick(w, k, h, &back);
        if (w->sea.n) fl_environment_drag(&w->sea, &w->b, k, h, 1);
    }
    book(own, fl_work_of_step(w, k, &first, &back));
}

/* Spheres that free_batch.h knows, from k on; behind the last. */
static int32_t end_plain(fl_world *w, int32_t k, int32_t to, double h, fl_body_block *own, int *finite)
{
    fl_free_batch_work works;
    int32_t end = k;
    while (h > 0.0 && end < to && fl_is_free_sphere(w, end)) end++;
    for (int32_t i = k; i < end && w->contact_sums.one_each; i++) fl_sums_clear(w, i);
    if (end > k && !fl_free_batch_end_step(w, k, end, h, &works)) *finite = 0;
    book_plain(own, &works, end - k);
    for (int32_t i = k; i < end; i++)
        own->contact_force = v3_add(own->contact_force, v3_madd(w->b.f[i], -w->b.m[i], w->gravity));
    return end;
}

/* A group that is of spheres alone, dry, on which nothing but spheres and walls presses or did; 0 where it is
 * not. */
static int end_spheres(fl_world *w, int32_t from, int32_t to, double h, fl_body_block *own, int *finite)
{
    const int32_t *sink = w->contact_sums.slot, *was = w->previous_sums.slot;
    fl_free_batch_work works;
    int32_t pressed = 0;
    if (!w->spheres.bodies || !w->b.is_isotropic[from] || w->sea.n || w->driven_floes.n ||
        w->contact_sums.one_each || !(h > 0.0))
        return 0;
    for (int32_t k = from; k < to; k++) pressed |= sink[k] | was[k];
    if (pressed || alike(w, from, to) < to) return 0;
    *finite = fl_free_batch_end_step(w, from, to, h, &works);
    book_plain(own, &works, to - from);
    for (int32_t k = from; k < to; k++)
        own->contact_force = v3_add(own->contact_force, v3_madd(w->b.f[k], -w->b.m[k], w->gravity));
    return 1;
}

/* Of balls [k, to), k none that free_batch.h knows, the first that it does. */
static int32_t before_plain(const fl_world *w, int32_t k, int32_t to)
{
    while (++k < to && !fl_is_free_sphere(w, k)) {}
    return k;
}

/* Whether n numbers of each of four arrays are finite: 0 x is 0 where x is.  What overflows only in the sum
 * of four is told as well, and looked at again. */
FL_SIMD_VERSIONS static int all_finite(const double *restrict a, const double *restrict b,
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

/* Nothing is told of group g, and what rows do to its bodies is known. */
static void start_group(fl_world *w, int32_t g)
{
    const int32_t from = g * FL_BODY_BLOCK, to = end_of(w, g);
    w->blocks[g] = (fl_body_block){.not_finite = -1};
    if (!w->spheres.bodies) return;
    fl_prefetch(&w->spheres.previous_sum[to],
                FL_BODY_BLOCK * sizeof *w->spheres.previous_sum); /* of the group behind it */
    fl_sphere_sums_collect(w, from, to);
}

/* From k on, which is a ball, those that go as it does, [k, to) being of one group; behind the last.  finite:
 * 0 where they are not known to be. */
static int32_t end_ball(fl_world *w, int32_t k, int32_t to, double h, int *finite)
{
    fl_body_block *own = group_of(w, k);
    int32_t end = end_plain(w, k, to, h, own, finite);
    if (end > k) return end;
    *finite = 0;
    end = h > 0.0 ? alike(w, k, to) : k;
    if (end == k) {
        end_one(w, k, h, own);
        return k + 1;
    }
    end = before_plain(w, k, end);
    end_balls(w, k, end, h, own);
    return end;
}

/* Group g; whether it may have lost a number, as far as that is known. */
static int end_group(fl_world *w, int32_t g, double h, crew *c)
{
    const int32_t from = g * FL_BODY_BLOCK, to = end_of(w, g);
    int finite = 1;
    start_group(w, g);
    if (end_spheres(w, from, to, h, &w->blocks[g], &finite)) return !finite;
    for (int32_t k = from, end; k < to; k = end) {
        if (w->b.is_isotropic[k]) {
            end_few(w, c, h); /* sums are in the order of the bodies */
            end = end_ball(w, k, to, h, &finite);
            continue;
        }
        finite = 0;
        end = h > 0.0 ? alike(w, k, to) : k;
        if (end == k) {
            end_few(w, c, h);
            end_one(w, end++, h, &w->blocks[g]);
            continue;
        }
        while (k < end) {
            k = join(c, k, end);
            if (c->n == FL_BODY_BATCH) end_few(w, c, h);
        }
    }
    return !finite;
}

/* Of groups [g, last) those that do not coast; lost: as above.  Whoever wakes and is touched is pressed by
 * itself, see fl_sleep_second_half(). */
static void end_awake(fl_world *w, int32_t g, int32_t last, double h, crew *c, int lost[FL_BLOCKS_AT_ONCE])
{
    int32_t up[FL_BLOCKS_AT_ONCE * FL_BODY_BLOCK];
    const int32_t n = fl_sleep_list_active(w, g * FL_BODY_BLOCK, end_of(w, last - 1), up);
    for (int32_t i = 0; i < n; i++) {
        const int32_t k = up[i];
        int finite = 1;
        lost[k / FL_BODY_BLOCK - g] = 1;
        if (w->b.is_isotropic[k]) { /* none of them sleeps */
            end_few(w, c, h);
            i += end_ball(w, k, end_of(w, k / FL_BODY_BLOCK), h, &finite) - k - 1;
            continue;
        }
        const uint8_t kind = w->sleep.phase[k];
        const int goes = kind == FL_AWAKE || (kind == FL_WAKING && !w->body_touches[k]);
        if (goes && h > 0.0 && alone(w, k)) {
            c->at[c->n++] = k;
            if (c->n == FL_BODY_BATCH) end_few(w, c, h);
        } else {
            end_few(w, c, h);
            end_one(w, k, h, group_of(w, k));
        }
    }
}

void fl_blocks_second_half(fl_world *w, int32_t g, int32_t last, double h)
{
    crew c = {.n = 0};
    int lost[FL_BLOCKS_AT_ONCE];
    if (w->sleep.state) {
        for (int32_t k = g; k < last; k++) start_group(w, k), lost[k - g] = 0;
        end_awake(w, g, last, h, &c, lost);
    } else {
        for (int32_t k = g; k < last; k++) lost[k - g] = end_group(w, k, h, &c);
    }
    end_few(w, &c, h);
    for (int32_t k = g; k < last; k++)
        if (lost[k - g]) w->blocks[k].not_finite = first_lost(&w->b, k * FL_BODY_BLOCK, end_of(w, k));
}
