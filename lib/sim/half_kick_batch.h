/* SPDX-License-Identifier: GPL-3.0-or-later */
/* half_kick_batch.h -- what both halves of a step share (first_half.h, second_half.h): which consecutive
 * bodies need the same operations, lists of bodies for a batch (body_batch.h), and kicks that keep their
 * changes. */
#ifndef FL_SIM_HALF_KICK_BATCH_H
#define FL_SIM_HALF_KICK_BATCH_H
#include <string.h>
#include "body/body_batch.h"
#include "body/integrate.h"
#include "sim/body_step.h"
#include "sim/sleep.h"
#include "water/still_water_batch.h"
#include "world/access.h"

/* End of block g. */
static inline int32_t fl_block_end(const fl_world *w, int32_t g)
{
    const int32_t end = (g + 1) * FL_BODY_BLOCK, all = fl_places_end(w);
    return end < all ? end : all;
}

/* End of the run of values x that starts at a[k]; compares eight values at a time. */
static inline int32_t fl_byte_run_end(const uint8_t *a, uint8_t x, int32_t k, int32_t to)
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

/* End of the run of bodies from k on that only need kick and drift, and that are spheres if k is one.
 * Returns k if k is not such a body. */
static inline int32_t fl_simple_run_end(const fl_world *w, int32_t k, int32_t to)
{
    if (fl_body_absent(w, k)) return k;
    if (w->b.is_isotropic[k] && (w->b.added_mass || w->b.heave_mass || w->sea.waves)) return k;
    to = fl_byte_run_end(w->b.is_isotropic, w->b.is_isotropic[k], k,
                         fl_byte_run_end(w->b.fixed_dof, 0, k, to));
    return w->inflow.absent ? fl_byte_run_end(w->inflow.absent, 0, k, to) : to;
}

/* 1 if body k only needs kick and drift and is no sphere. */
static inline int fl_body_is_simple(const fl_world *w, int32_t k)
{
    return !(w->b.is_isotropic[k] || w->b.fixed_dof[k] || fl_body_absent(w, k));
}

/* Indices of bodies that go into the next batch. */
typedef struct {
    int32_t n, at[FL_BODY_BATCH];
} fl_batch_list;

/* Add bodies from [k, end) until the batch is full; returns the end of the bodies added. */
static inline int32_t fl_batch_list_add(fl_batch_list *c, int32_t k, int32_t end)
{
    if (c->n == 0 && k + FL_BODY_BATCH <= end) {
        for (int32_t i = 0; i < FL_BODY_BATCH; i++) c->at[i] = k + i;
        c->n = FL_BODY_BATCH;
        return k + FL_BODY_BATCH;
    }
    while (k < end && c->n < FL_BODY_BATCH) c->at[c->n++] = k++;
    return k;
}

/* Half of the step of body k, which is longer if it wakes. */
static inline double fl_half_step_of(const fl_world *w, int32_t k, double h)
{
    return fl_sleep_phase_of(w, k) == FL_WAKING ? 0.5 * fl_sleep_duration(w, k) : h;
}

static inline void fl_batch_list_load(const fl_world *w, fl_body_batch *s, fl_batch_list *c, double h)
{
    fl_body_batch_load(s, &w->b, c->at, c->n, h);
    for (int32_t k = 0; k < s->lanes && w->sleep.state; k++) s->h[k] = fl_half_step_of(w, s->index[k], h);
}

/* NULL without added mass. */
static inline fl_body_batch_water *fl_batch_load_water(const fl_world *w, const fl_body_batch *s,
                                                       fl_body_batch_water *a)
{
    if (!w->b.added_mass) return NULL;
    fl_body_batch_load_water(a, &w->b, s);
    return a;
}

/* Kick a batch, whose axes are up to date; in waves the work of the water is booked with it. */
static inline void fl_batch_kick(fl_world *w, fl_body_batch *s, const fl_body_batch_water *water)
{
    double v[3][FL_BODY_BATCH], spin[3][FL_BODY_BATCH];
    if (w->sea.waves) memcpy(v, s->v, sizeof v), memcpy(spin, s->w, sizeof spin);
    fl_body_batch_kick(s, water);
    if (w->sea.waves) fl_still_water_batch_add_work(&w->sea, s, v, spin);
}

/* Velocity change of a free sphere by a kick of h. */
static inline fl_velocity_change fl_sphere_kick_change(const fl_bodies *b, int32_t k, double h)
{
    return (fl_velocity_change){v3_scale(h * b->invm[k], b->f[k]), v3_scale(h * b->invI[k].x, b->t[k])};
}

/* The same of any other free body. */
static inline fl_velocity_change fl_body_kick_change(const fl_bodies *b, int32_t k, double h)
{
    const fl_vec3 f = b->f[k], turn = fl_body_apply_inverse_inertia(b, k, v3_scale(h, b->t[k]));
    return (fl_velocity_change){b->added_mass || b->heave_mass
                                    ? v3_scale(h, fl_body_velocity_of_momentum(b, k, f))
                                    : v3_scale(h * b->invm[k], f),
                                turn};
}

/* The same of body k of a batch, from fl_body_batch_velocity_change(). */
static inline fl_velocity_change fl_batch_kick_change(double (*g)[FL_BODY_BATCH], int32_t k)
{
    return (fl_velocity_change){v3(g[0][k], g[1][k], g[2][k]), v3(g[3][k], g[4][k], g[5][k])};
}

/* Kick body k and store the change.  Before the kick w may be the mean of a step: for free rotations the
 * change is not taken from w. */
static inline void fl_body_kick_stored(fl_world *w, int32_t k, double h, fl_velocity_change *change)
{
    const fl_vec3 v = w->b.v[k], spin = w->b.w[k];
    const int turns = !(w->b.fixed_dof[k] & (FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ));
    *change = fl_body_kick_change(&w->b, k, h);
    fl_body_kick(w, k, h);
    if (w->b.fixed_dof[k]) change->v = v3_sub(w->b.v[k], v);
    if (!turns) change->w = v3_sub(w->b.w[k], spin);
}

#endif
