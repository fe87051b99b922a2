/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/energy_ledger.h"
#include <string.h>
#include "base/array.h"
#include "body/integrate.h"
#include "contact/bond_list.h"
#include "sim/ice_push.h"
#include "sim/relaxed_run.h"

static double power_of(fl_vec3 f, fl_vec3 t, fl_vec3 v, fl_vec3 w) { return v3_dot(f, v) + v3_dot(t, w); }

/* Grow an array to `want` elements if it has fewer than n; the new ones are 0.  -1 if memory runs out. */
static int grow_zeroed(void *array, int32_t *cap, int32_t n, int32_t want, size_t size)
{
    fl_err unused = {0};
    void *old;
    if (n <= *cap) return 0;
    void *const fresh = fl_alloc(want, size, &unused);
    if (!fresh) return -1;
    memcpy(&old, array, sizeof old); /* array is the address of a T*, of any T */
    if (old) memcpy(fresh, old, (size_t)*cap * size);
    free(old);
    memcpy(array, &fresh, sizeof fresh);
    *cap = want;
    return 0;
}

static int grow_changes(fl_world *w, int32_t n, int32_t want)
{
    int32_t had = w->change_cap;
    return grow_zeroed(&w->predicted_change, &had, n, want, sizeof *w->predicted_change) ||
                   grow_zeroed(&w->kick_change, &w->change_cap, n, want, sizeof *w->kick_change)
               ? -1
               : 0;
}

/* Room for the sums 0 to n and the velocity changes; an eighth more where not all bodies have one. */
static int grow_sums(fl_world *w, fl_contact_sums *s, int32_t n)
{
    const int32_t want = n < w->b.total ? 1 + n + n / 8 : 1 + n;
    return grow_zeroed(&s->sum, &s->cap, n + 1, want, sizeof *s->sum) || grow_changes(w, n + 1, want) ? -1
                                                                                                      : 0;
}

int fl_contact_sums_make(fl_world *w, fl_err *err)
{
    const int32_t total = w->b.total;
    w->contact_sums.slot = fl_alloc(total, sizeof *w->contact_sums.slot, err);
    w->previous_sums.slot = fl_alloc(total, sizeof *w->previous_sums.slot, err);
    if (!w->contact_sums.slot || !w->previous_sums.slot) return -1;
    return grow_sums(w, &w->contact_sums, 0) || grow_sums(w, &w->previous_sums, 0)
               ? fl_fail(err, FL_SYSTEM, "out of memory")
               : 0;
}

void fl_contact_sums_free(fl_world *w)
{
    free(w->contact_sums.slot), free(w->previous_sums.slot), free(w->contact_sums.sum),
        free(w->previous_sums.sum);
    free(w->kick_change), free(w->predicted_change);
}

/* Number the bodies that touch from 1 on, 0 for all others; returns how many touch.  Few do, so eight that do
 * not are skipped at a time.  Reading the pairs instead is slower: they are far apart in memory. */
static int32_t number_touching(const fl_world *w, int32_t *slot)
{
    const uint8_t *const touches = w->body_touches;
    const int32_t total = w->b.total;
    int32_t n = 0;
    for (int32_t k = 0; k < total;) {
        const int32_t end = k + 8 < total ? k + 8 : total;
        uint64_t eight = 1;
        if (end == k + 8) memcpy(&eight, &touches[k], sizeof eight);
        if (eight == 0) memset(&slot[k], 0, 8 * sizeof *slot);
        for (; k < end && eight; k++) {
            n += touches[k];
            slot[k] = touches[k] ? n : 0;
        }
        k = end;
    }
    return n;
}

static int needs_all_slots(const fl_world *w) { return w->bonds.n || w->sleep.n_resting || w->relax.kind; }

void fl_contact_sums_assign(fl_world *w)
{
    fl_contact_sums *s = &w->contact_sums;
    const int all = needs_all_slots(w);
    const int32_t total = w->b.total;
    if (all && s->one_each) return;
    if (grow_sums(w, s, all ? total : number_touching(w, s->slot))) {
        memset(s->slot, 0, (size_t)total * sizeof *s->slot);
        w->failed = 1;
        return;
    }
    for (int32_t k = 0; k < total && all; k++) s->slot[k] = k + 1;
    if (all) memset(s->sum, 0, (size_t)s->cap * sizeof *s->sum);
    s->one_each = all;
}

void fl_contact_sums_recompute(fl_world *w, int32_t k)
{
    fl_contact_sum s = {0};
    for (int64_t c = w->first_pair_of_body[k]; c < w->first_pair_of_body[k + 1]; c++) {
        if (!w->pair_touches[w->pairs_of_body[c]]) continue;
        const fl_pair *p = w->pair[w->pairs_of_body[c]].contact;
        fl_contact_sum_add(&s, p, p->i == k);
    }
    if (fl_body_has_bonds(w, k)) fl_bond_list_add_sums(w, k, &s);
    if (w->relax.kind && k < w->n) fl_relaxed_run_add_sum(w, k, &s);
    if (s.contacts) *fl_sums_now(w, k) = s;
    else fl_sums_clear(w, k);
}

/* Add the works on sphere k by its sphere and wall contacts. */
static void add_sphere_works(const fl_world *w, int32_t k, const fl_velocity_change *first,
                             const fl_velocity_change *back, fl_work *q)
{
    const fl_sphere_sum *f0 = &w->spheres.previous_sum[k], *f1 = &w->spheres.sum[k];
    const fl_vec3 v = w->b.v[k], spin = w->b.w[k];
    const double sixth = w->dt / 6.0;
    q->damping -= w->dt * v3_dot(f1->damping, v) +
                  sixth * (v3_dot(f1->damping, first->v) - v3_dot(f0->damping, back->v));
    q->friction -= w->dt * power_of(f1->friction, f1->torque, v, spin) +
                   sixth * (power_of(f1->friction, f1->torque, first->v, first->w) -
                            power_of(f0->friction, f0->torque, back->v, back->w));
}

fl_work fl_work_of_step(const fl_world *w, int32_t k, const fl_velocity_change *first,
                        const fl_velocity_change *back)
{
    const fl_contact_sum *f0 = fl_sums_before(w, k), *f1 = fl_sums_now(w, k);
    static const fl_velocity_change none = {{0, 0, 0}, {0, 0, 0}};
    fl_work q = {0};
    if (!first) first = &none;
    if (f1->contacts) {
        const fl_vec3 v = w->b.v[k], spin = w->b.w[k];
        q.damping -= w->dt * power_of(f1->damping, f1->damping_torque, v, spin);
        q.friction -= w->dt * power_of(f1->friction, f1->friction_torque, v, spin);
    }
    /* Without contacts at the begin of the step F0 is 0, and a0 is small against the acceleration by F1. */
    if (f0->contacts) {
        const double sixth = w->dt / 6.0; /* dt^2/12 over the dt/2 of a kick */
        q.damping -= sixth * (power_of(f1->damping, f1->damping_torque, first->v, first->w) -
                              power_of(f0->damping, f0->damping_torque, back->v, back->w));
        q.friction -= sixth * (power_of(f1->friction, f1->friction_torque, first->v, first->w) -
                               power_of(f0->friction, f0->friction_torque, back->v, back->w));
    }
    if (w->spheres.bodies && k < w->n) add_sphere_works(w, k, first, back, &q);
    return q;
}

/* Accelerations by the forces of now; 0 for a prescribed motion, which no contact changes. */
static fl_velocity_change acceleration_of(const fl_world *w, int32_t k)
{
    fl_velocity_change g = {0};
    if (k == w->push.wall && w->push.of) {
        const double a = w->push.sign * fl_ice_push_acceleration(w);
        g.v = w->push.axis ? v3(0, a, 0) : v3(a, 0, 0);
    } else if (k < w->n) {
        fl_body_accelerations(&w->b, k, &g.v, &g.w);
    } else if (fl_structure_has_members(w)) {
        if (fl_piece_moves(w, k))
            fl_member_motion_acceleration(&w->moving.members, k - w->n, w->b.x[k], &g.v, &g.w);
    } else if (w->moving.movers.n) {
        const fl_bodies *mb = &w->moving.movers.b;
        const int32_t m = w->moving.mover_of_piece[k - w->n];
        if (m < 0 || !w->moving.movers.motion[m].free_dof) return g;
        fl_body_accelerations(mb, m, &g.v, &g.w);
        g.v = v3_add(g.v, v3_cross(g.w, v3_sub(w->b.x[k], mb->x[m])));
    }
    return g;
}

/* 1 if pieces or walls move. */
static int things_move(const fl_world *w) { return fl_structure_moves(w) || w->push.of == FL_PUSH_WALL; }

static fl_velocity_change change_of(const fl_world *w, int32_t k)
{
    const fl_velocity_change g = acceleration_of(w, k);
    return (fl_velocity_change){v3_scale(0.5 * w->dt, g.v), v3_scale(0.5 * w->dt, g.w)};
}

void fl_ledger_begin_step(fl_world *w)
{
    const fl_contact_sums previous = w->previous_sums;
    w->previous_sums = w->contact_sums;
    w->contact_sums = previous;
    fl_sphere_sum *sum = w->spheres.previous_sum;
    w->spheres.previous_sum = w->spheres.sum;
    w->spheres.sum = sum;
    memset(w->predicted_change, 0, (size_t)w->change_cap * sizeof *w->predicted_change);
    for (int32_t k = w->n; k < w->b.total && things_move(w); k++) {
        fl_velocity_change *const change = fl_kick_change(w, k);
        if (change) *change = change_of(w, k);
    }
}

/* Power of the prescribed motions; free motions have their own energies, moving_structure.h. */
static double drive_power(const fl_world *w)
{
    double sum = 0.0;
    if (w->push.of == FL_PUSH_WALL) sum -= v3_dot(w->b.f[w->push.wall], w->b.v[w->push.wall]);
    if (w->moving.movers.n == 0) return sum;
    for (int32_t k = 0; k < w->pieces; k++) {
        const int32_t j = w->n + k, m = w->moving.mover_of_piece[k];
        if (m < 0 || w->moving.movers.motion[m].free_dof) continue;
        sum -= power_of(w->b.f[j], w->b.t[j], w->b.v[j], w->b.w[j]);
    }
    return sum;
}

void fl_ledger_book_step(fl_world *w)
{
    fl_ledger *g = &w->ledger;
    fl_work sum = {0};
    for (int32_t k = 0; k < fl_block_count(w); k++)
        sum.damping += w->blocks[k].damping_work, sum.friction += w->blocks[k].friction_work;
    for (int32_t k = w->n; k < w->b.total && things_move(w); k++) {
        const fl_velocity_change back = change_of(w, k);
        const fl_work q = fl_work_of_step(w, k, fl_kick_change(w, k), &back);
        sum.damping += q.damping, sum.friction += q.friction;
    }
    g->damping += sum.damping;
    g->friction += sum.friction;
    g->drive += w->dt * drive_power(w);
}

void fl_work_ahead_add(const fl_world *w, int32_t k, fl_work *sum)
{
    const double h = 0.5 * w->dt, sixth = w->dt * w->dt / 6.0;
    const fl_contact_sum *s = fl_sums_now(w, k);
    const int has_sphere_sum = w->spheres.bodies && k < w->n;
    if (s->contacts == 0 && !has_sphere_sum) return;
    const fl_vec3 v = w->b.v[k], spin = w->b.w[k];
    const fl_velocity_change a = acceleration_of(w, k);
    if (has_sphere_sum) {
        const fl_sphere_sum *q = &w->spheres.sum[k];
        sum->damping -= h * v3_dot(q->damping, v) + sixth * v3_dot(q->damping, a.v);
        sum->friction -= h * power_of(q->friction, q->torque, v, spin) +
                         sixth * power_of(q->friction, q->torque, a.v, a.w);
    }
    if (s->contacts == 0) return;
    sum->damping -= h * power_of(s->damping, s->damping_torque, v, spin) +
                    sixth * power_of(s->damping, s->damping_torque, a.v, a.w);
    sum->friction -= h * power_of(s->friction, s->friction_torque, v, spin) +
                     sixth * power_of(s->friction, s->friction_torque, a.v, a.w);
}

fl_work fl_work_ahead(const fl_world *w)
{
    fl_work sum = {.drive = 0.5 * w->dt * drive_power(w)};
    for (int32_t k = 0; k < w->b.total; k++) fl_work_ahead_add(w, k, &sum);
    return sum;
}
