/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sleep.h -- skip steps of inactive floes: run.sleep = tol.
 *
 * Ballistic floes.  A floe without contacts feels smooth forces only.  It takes one long step of the same
 * integrator over the time s since it fell asleep.  Its path until then is bounded by
 *     path = s (|v| + r w) + s^2 (|a| + r e)/2 + s^2 d,     w = |L|/I_min,  e = |T|/I_min,
 * with r the radius of its core, a and T by the forces at the begin of that step, and d the rate at which
 * drag changed the speed of its points last.  Drag slows down, so twice that is a bound.  The path is
 * added to the odometer at once: a pair is skipped only while the two cannot touch anywhere on their
 * paths (fl_pair.free_travel).  Where that ends, or the time does, the floe is advanced to the time of
 * now before the pair is evaluated.  A contact that begins then gives the impulse of one ordinary step.
 * The error of the long step is estimated from what acts at its end,
 *     error = s^2/12 (|a1 - a0| + r |e1 - e0| + |d1 - d0|) + r (w s)^3/12.
 * s is chosen to keep it below tol times the radius of the floe.  s at most doubles, and ends when the
 * next neighbour may be reached.  A floe that could skip a few steps only stays awake, and is tested
 * again after as many.
 *
 * Resting floes.  Floes that touch each other rest if each of them moved by a path p of at most tol R/4
 * in the last 64 steps, and together they are no faster at the end than in the mean of these steps.
 * (What begins to fall off an edge is faster.)  They stay where they are for 64 sqrt(tol R/p) steps, in
 * which the acceleration that explains p would move them by tol R.  All floes of such an island rest
 * together, or none does.  A new contact with one of them wakes all.  Their pairs are not evaluated; the
 * forces stay.
 *
 * Always awake: spheres, guided floes, floes of radius 0, and floes that touch what moves, or a structure
 * whose panel loads are written.  Floes that waves reach, or that are held at a speed, do not rest.
 * Threads, stops and tables change no bit; the skin does, as it decides when a pair is evaluated. */
#ifndef FL_SIM_SLEEP_H
#define FL_SIM_SLEEP_H
#include <string.h>
#include "world/access.h"

/* Build w->sleep, empty without run.sleep.  -1 with FL_SYSTEM. */
int fl_sleep_make(fl_world *w, fl_err *err);

/* Its memory [B]. */
double fl_sleep_bytes(const fl_world *w);
void fl_sleep_free(fl_sleep *s);

/* 1 if body k is skipped in this step. */
static inline int fl_is_asleep(const fl_world *w, int32_t k)
{
    const enum fl_sleep_phase phase = fl_sleep_phase_of(w, k);
    return phase == FL_BALLISTIC || phase == FL_RESTING;
}

/* List the bodies of [from, to) that are not ballistic in active[]; returns their number.  Eight
 * ballistic ones are skipped at a time; the rest is listed without branches, which would be mispredicted. */
static inline int32_t fl_sleep_list_active(const fl_world *w, int32_t from, int32_t to, int32_t *active)
{
    const uint8_t *phase = w->sleep.phase;
    int32_t n = 0;
    for (int32_t k = from, end; k < to; k = end) {
        uint64_t eight = 0;
        end = k + 8 < to ? k + 8 : to;
        if (end == k + 8) memcpy(&eight, &phase[k], sizeof eight);
        if (eight == UINT64_C(0x0101010101010101) * FL_BALLISTIC) continue;
        for (int32_t i = k; i < end; i++) {
            active[n] = i;
            n += phase[i] != FL_BALLISTIC;
        }
    }
    return n;
}

/* Time at which body k fell asleep [s]. */
static inline double fl_sleep_start_time(const fl_world *w, int32_t k)
{
    return w->t0 + (double)(w->sleep.state[k].since_step - w->step0) * w->dt;
}

/* Time since then [s]. */
static inline double fl_sleep_duration(const fl_world *w, int32_t k)
{
    return (double)(w->step - w->sleep.state[k].since_step) * w->dt;
}

/* Find the ballistic bodies that wake in this step (FL_WAKING): their time has come, a neighbour has come
 * near, or they may have left the domain.  Marks the near pairs to evaluate, sleep.pair_due.  Called by
 * every thread of the team; complete after a barrier. */
void fl_sleep_find_waking(fl_world *w, int thread, int threads);

/* Store what the error estimate needs, before the first half of the long step of body k, which is
 * FL_WAKING. */
void fl_sleep_first_half(fl_world *w, int32_t k);

/* Second half of that step, and the error estimate. */
void fl_sleep_second_half(fl_world *w, int32_t k);

/* The error estimate alone, after another function has made the second half of body k, which has no
 * contact.  v, spin: its velocities before the last drag. */
void fl_sleep_finish_skip(fl_world *w, int32_t k, fl_vec3 v, fl_vec3 spin);

/* Body k is awake after that. */
static inline void fl_sleep_set_awake(fl_world *w, int32_t k) { w->sleep.phase[k] = FL_AWAKE; }

/* After the contacts: wake the islands of resting bodies that touch a body which does not rest. */
void fl_sleep_wake_touched(fl_world *w);

/* At the end of a step: wake bodies whose time has come, and let bodies fall asleep. */
void fl_sleep_update(fl_world *w);

/* After a state has been read: an older program may have let two neighbours sleep longer. */
void fl_sleep_after_read(fl_world *w);

/* Wake all resting bodies, as when a floe has left. */
void fl_sleep_wake_resting(fl_world *w);

/* Place i has a new floe, which is awake. */
void fl_sleep_reset_body(fl_world *w, int32_t i);

/* Advance all ballistic bodies to the time of now, for output; and take that back. */
void fl_sleep_advance_to_now(fl_world *w);
void fl_sleep_restore(fl_world *w);

/* Totals so far: steps skipped by ballistic and by resting bodies, number of ballistic skips; as
 * fractions of the radius the largest error of one skip, and the largest sum of errors of one floe. */
typedef struct {
    int64_t ballistic_steps, resting_steps, n_skips;
    double max_error, max_error_sum;
} fl_sleep_totals;
fl_sleep_totals fl_sleep_sum_totals(const fl_world *w);

#endif
