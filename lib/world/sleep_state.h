/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sleep_state.h -- which bodies sleep (sim/sleep.h decides). */
#ifndef FL_WORLD_SLEEP_STATE_H
#define FL_WORLD_SLEEP_STATE_H
#include <stdint.h>
#include "geom/vec3.h"

/* FL_BALLISTIC: no contact, skips steps.  FL_RESTING: at rest against its neighbours, skips steps.
 * FL_WAKING: ballistic until now, takes the skipped time in this step.  FL_CANDIDATE: scratch of the search
 * for bodies at rest. */
enum fl_sleep_phase { FL_AWAKE, FL_BALLISTIC, FL_RESTING, FL_WAKING, FL_CANDIDATE };

typedef struct {
    int64_t since_step;          /* step in which the body fell asleep or woke */
    double path_bound;           /* bound of the path of a ballistic body until it wakes, in its odometer
                                  * already; of a candidate, its path in the rest window [m] */
    double window_odometer;      /* odometer at the start of the rest window [m]; -1: none */
    double drag_rate;            /* rate at which drag changed its speed last [m/s2] */
    double max_error, sum_error; /* of all skips: largest error over the radius, and the sum */
    fl_vec3 acceleration, angular_acceleration; /* at the begin of the step that ends */
    int64_t ballistic_steps, resting_steps;     /* steps skipped so far */
    int64_t n_skips;                            /* ballistic skips so far */
    int32_t next_skip;                          /* steps that the next skip may have */
} fl_sleep_state;

typedef struct fl_sleep_saved fl_sleep_saved;

/* state = NULL where run.sleep is 0. */
typedef struct {
    double tol;            /* run.sleep */
    fl_sleep_state *state; /* [n] */
    uint8_t *phase;        /* [n] enum fl_sleep_phase */
    int64_t *phase_end;    /* [n] step in which it wakes; awake: first step in which it may sleep */
    fl_sleep_saved *saved; /* [n] */
    int32_t *stack;        /* [n] */
    uint8_t *pair_due;     /* [n_pair] 1: to be evaluated in this step */
    int32_t n_resting, pair_due_cap;
    double surface_speed, surface_slope; /* bounds of speed [m/s] and slope [-] of the surface of the waves */
} fl_sleep;

#endif
