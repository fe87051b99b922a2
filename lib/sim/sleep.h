/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sleep.h -- bodies to which nothing happens, taken over many steps at once: run.sleep = tol.
 *
 * A floe that touches nothing COASTS: what acts on it is smooth, and it takes one step of the same integrator
 * over the time s since it fell asleep.  Nothing is foreseen but a bound of its path until then,
 *     way = s (|v| + r w) + s^2 (|a| + r e)/2 + s^2 d,     w = |L|/I_min,  e = |T|/I_min,
 * with r the reach of its core, a and T of the forces that the whole of that step begins with, and d the rate
 * at which drag changed the speed of its points last: drag slows down, so twice that bounds it.  The way goes
 * to the odometer at once; so a pair sleeps on only as long as the two cannot touch wherever in that time
 * they are (fl_pair.asleep), and where that ends, or the time does, the floe is brought to the time of now
 * before the pair is looked at.  A contact that begins then gives the impulse of one ordinary step.  What the
 * longer step is off by is told by what acts at its end,
 *     off = s^2/12 (|a1 - a0| + r |e1 - e0| + |d1 - d0|) + r (w s)^3/12,
 * and s is chosen so that it stays below tol times the radius of the floe: at most doubled, and no longer
 * than that or the next neighbour allows.  Who could coast for a few steps only stays awake, and is asked
 * again after as many.
 *
 * Floes that touch each other REST when all of them went a path p, in the last WINDOW steps, of no more than
 * a quarter of tol R, and together go no faster at the end than in the mean of these, as what begins to fall
 * off an edge does: they are left where they are for WINDOW sqrt(tol R/p) steps, in which they would go tol
 * R at the acceleration that explains p.  All that touch rest together, or none does; what comes to touch one
 * of them wakes them all.  Nothing of their pairs is computed, and the forces of those stay.
 *
 * Awake stay: spheres, guided floes, floes of radius 0, and those that touch what moves, or a structure whose
 * panels are told; who lies still where waves reach it, or is held at a speed, does not rest.  Threads, stops
 * and tables change no bit; the skin does, as it decides when a pair is looked at. */
#ifndef FL_SIM_SLEEP_H
#define FL_SIM_SLEEP_H
#include <string.h>
#include "world/access.h"

/* -1 with FL_SYSTEM. */
int fl_sleep_make(fl_world *w, fl_err *err);
/* What it takes of memory. */
double fl_sleep_bytes(const fl_world *w);
void fl_sleep_free(fl_sleep *s);

/* Whether k takes no part in this step. */
static inline int fl_is_asleep(const fl_world *w, int32_t k)
{
    const enum fl_sleep_phase kind = fl_sleep_phase_of(w, k);
    return kind == FL_BALLISTIC || kind == FL_RESTING;
}

/* Those of [from, to) that do not coast, to up[]; how many.  Eight that do are passed over at a time; who of
 * others does looks random, and to ask one after the other costs more than to write all down. */
static inline int32_t fl_sleep_list_active(const fl_world *w, int32_t from, int32_t to, int32_t *up)
{
    const uint8_t *kind = w->sleep.phase;
    int32_t n = 0;
    for (int32_t k = from, end; k < to; k = end) {
        uint64_t eight = 0;
        end = k + 8 < to ? k + 8 : to;
        if (end == k + 8) memcpy(&eight, &kind[k], sizeof eight);
        if (eight == UINT64_C(0x0101010101010101) * FL_BALLISTIC) continue;
        for (int32_t i = k; i < end; i++) {
            up[n] = i;
            n += kind[i] != FL_BALLISTIC;
        }
    }
    return n;
}

/* When k fell asleep [s]. */
static inline double fl_sleep_start_time(const fl_world *w, int32_t k)
{
    return w->t0 + (double)(w->sleep.state[k].since_step - w->step0) * w->dt;
}

/* How long k has slept [s]. */
static inline double fl_sleep_duration(const fl_world *w, int32_t k)
{
    return (double)(w->step - w->sleep.state[k].since_step) * w->dt;
}

/* By every thread of a team, of which this is one: who of those that coast are FL_WAKING in this step, because
 * their time has come, a neighbour has, or they may have left; and which near pairs are to be looked at,
 * sleep.due.  All of it is known when all are back. */
void fl_sleep_find_waking(fl_world *w, int thread, int threads);

/* k, which is FL_WAKING, is about to make the first half of its step. */
void fl_sleep_first_half(fl_world *w, int32_t k);

/* The second half of the step of k, which is FL_WAKING, by itself; */
void fl_sleep_second_half(fl_world *w, int32_t k);

/* or what is to be kept of it when others have made it, nothing pressing on k: its speeds were v and spin
 * before the drag; */
void fl_sleep_finish_skip(fl_world *w, int32_t k, fl_vec3 v, fl_vec3 spin);

/* and that it is awake then. */
static inline void fl_sleep_set_awake(fl_world *w, int32_t k) { w->sleep.phase[k] = FL_AWAKE; }

/* After the contacts: who rests and is touched by one who does not is awake, and all that touch him. */
void fl_sleep_wake_touched(fl_world *w);

/* At the end of a step: who wakes, and who falls asleep. */
void fl_sleep_update(fl_world *w);

/* After a state has been read, which may be of a program that told of neighbours who slept later. */
void fl_sleep_after_read(fl_world *w);

/* All who rest are awake: something has left. */
void fl_sleep_wake_resting(fl_world *w);

/* Place i has another floe, awake. */
void fl_sleep_reset_body(fl_world *w, int32_t i);

/* Bring those who coast to the time of now to be looked at, and back to where they fell asleep. */
void fl_sleep_advance_to_now(fl_world *w);
void fl_sleep_restore(fl_world *w);

/* What it came to so far: steps of bodies that coasted and rested, how often one has coasted; over the
 * radius, the largest error of one coasting, and the largest sum of those of a floe. */
typedef struct {
    int64_t ballistic_steps, resting_steps, n_skips;
    double max_error, max_error_sum;
} fl_sleep_totals;
fl_sleep_totals fl_sleep_sum_totals(const fl_world *w);

#endif
