/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sleep_state.h -- which bodies sleep. */
#ifndef FL_WORLD_SLEEP_STATE_H
#define FL_WORLD_SLEEP_STATE_H
#include <stdint.h>
#include "geom/vec3.h"

/* Who is awake and who sleeps, see sleep.h; nap NULL where nobody does. */
enum fl_sleep_phase { FL_AWAKE, FL_BALLISTIC, FL_RESTING, FL_WAKING, FL_CANDIDATE };

typedef struct {
    int64_t since_step;     /* step in which it fell asleep, or woke */
    double path_bound;      /* bound of its path in between, in the odometer already; of who is quiet, that
                              * of the window [m]                                              */
    double window_odometer; /* odometer when the window of rest began, -1: there is none  [m] */
    double drag_rate;       /* rate at which drag changed the speed of its points last [m/s2] */
    double max_error, sum_error; /* largest error of a step over the radius so far, and all of it  */
    fl_vec3 acceleration,
        angular_acceleration; /* accelerations at the begin of the step that ends               */
    int64_t ballistic_steps,
        resting_steps; /* steps so far                                                   */
    int64_t n_skips;   /* how often it has coasted                                       */
    int32_t next_skip; /* steps that it may coast next                                   */
} fl_sleep_state;

typedef struct fl_sleep_saved fl_sleep_saved;

typedef struct {
    double tol;
    fl_sleep_state *state; /* [n] */
    uint8_t *phase;        /* [n] enum fl_sleep_phase */
    int64_t *phase_end;    /* [n] step in which it wakes; of who is awake, in which it may fall asleep at the
                          * earliest */
    fl_sleep_saved *saved; /* [n] */
    int32_t *stack;        /* [n] */
    uint8_t *pair_due;     /* [n_pair] is to be looked at: 1 until it has been */
    int32_t n_resting, pair_due_cap;
    double surface_speed,
        surface_slope; /* bounds of the speed and of the slope of the waves' surface [m/s] */
} fl_sleep;

#endif
