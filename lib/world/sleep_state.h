/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sleep_state.h -- which bodies sleep. */
#ifndef FL_WORLD_SLEEP_STATE_H
#define FL_WORLD_SLEEP_STATE_H
#include <stdint.h>
#include "geom/vec3.h"

/* Who is awake and who sleeps, see sleep.h; nap NULL where nobody does. */
enum fl_nap_kind { FL_AWAKE, FL_COASTS, FL_RESTS, FL_ENDS, FL_QUIET };

typedef struct {
    int64_t since;           /* step in which it fell asleep, or woke */
    double way;              /* bound of its path in between, in the odometer already; of who is quiet, that
                              * of the window [m]                                              */
    double mark;             /* odometer when the window of rest began, -1: there is none  [m] */
    double drag;             /* rate at which drag changed the speed of its points last [m/s2] */
    double off, summed;      /* largest error of a step over the radius so far, and all of it  */
    fl_vec3 a, turn;         /* accelerations at the begin of the step that ends               */
    int64_t coasted, rested; /* steps so far                                                   */
    int64_t naps;            /* how often it has coasted                                       */
    int32_t span;            /* steps that it may coast next                                   */
} fl_nap;

typedef struct fl_nap_image fl_nap_image;

typedef struct {
    double tol;
    fl_nap *nap;         /* [n] */
    uint8_t *kind;       /* [n] enum fl_nap_kind */
    int64_t *until;      /* [n] step in which it wakes; of who is awake, in which it may fall asleep at the
                          * earliest */
    fl_nap_image *image; /* [n] */
    int32_t *stack;      /* [n] */
    uint8_t *due;        /* [n_pair] is to be looked at: 1 until it has been */
    int32_t resting, due_cap;
    double rise, slope; /* bounds of the speed and of the slope of the waves' surface [m/s] */
} fl_sleep;

#endif
