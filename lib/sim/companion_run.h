/* SPDX-License-Identifier: GPL-3.0-or-later */
/* companion_run.h -- what a step comes to in a run as a whole: the run once more beside it, with other steps.
 *
 * Windows (error_budget.h) tell what a step is off by as long as states have no time to part.  What it is off by
 * grows afterwards: where sides of floes meet flat for a time T, what they leave with differs by d/T where
 * one comes by a way d too late, and by the next hit, t later, that has made d t/T of d: a thousand times as
 * much among floes that crowd.  No window sees that.  So a second world makes the same run with r times the
 * step, row of the loads by row.  With X the load of the run until now and X' of the other,
 *     D = sum |X' - X| / sum |X|,      error e = D/|r^p - 1|                        (Richardson)
 * with p the order that the windows found, and r = sqrt(2), as nearly as whole steps in a row let it be: so e
 * is D where p is 2, and where the two have parted, which is all that D tells then.  It takes 0.7 of what the
 * run does.  Twenty short scenes were off by 0.2 to 4 times e (verify_budget, E01 and E02), so e is not held
 * against the goal itself but against three times that. */
#ifndef FL_SIM_COMPANION_RUN_H
#define FL_SIM_COMPANION_RUN_H
#include <stdio.h>
#include "base/text.h"
#include "scene/scene.h"
#include "world/world.h"

#define FL_COMPANION_TOLERANCE 3.0

/* What a part has borne from the start on. */
typedef struct {
    fl_vec3 impulse, moment; /* [N s], [N m s] */
    double peak;             /* [N] */
} fl_total_load;

/* The load that is asked for, enum fl_error_of. */
static inline fl_vec3 fl_load_component(int32_t of, fl_total_load b)
{
    switch (of) {
    case FL_ERROR_OF_IMPULSE: return b.impulse;
    case FL_ERROR_OF_PEAK: return v3(b.peak, 0, 0);
    case FL_ERROR_OF_FX: return v3(b.impulse.x, 0, 0);
    case FL_ERROR_OF_FY: return v3(b.impulse.y, 0, 0);
    case FL_ERROR_OF_FZ: return v3(b.impulse.z, 0, 0);
    case FL_ERROR_OF_MX: return v3(b.moment.x, 0, 0);
    case FL_ERROR_OF_MY: return v3(b.moment.y, 0, 0);
    default: return v3(b.moment.z, 0, 0);
    }
}

typedef struct {
    fl_world world;
    fl_total_load *run_load, *own_load; /* [parts] of the run and of this world, up to the last row */
    double step_ratio;                  /* r, of all rows that which tells the least; 0: no row yet */
    double
        exceeded_since; /* e has been above FL_COMPANION_TOLERANCE times the goal from there on [s]; -1: it is not */
    double last_row_time; /* end of the last row [s] */
    int32_t started;      /* it has: what follows is of this world */
    int32_t ended;        /* its steps were above the critical one: nothing is told of what comes */
} fl_companion;

/* A second world of the scene, which has not begun.  -1 as fl_world_make_with_inflow(). */
int fl_companion_make(fl_companion *s, const fl_scene *scene, const fl_ice_field *field,
                      const fl_ice_field *feed, const fl_surface *surface, fl_err *err);
void fl_companion_free(fl_companion *s); /* accepts a zeroed struct, leaves one */

/* Behind a step of the run w, before what its parts bear in this row is forgotten: come after it as far as
 * that is whole steps, and at the end of a row compare.  every: a row [s]; of, goal: the load that is asked
 * for and what it may be off by; p: its order.  -1 with FL_SYSTEM. */
int fl_companion_follow(fl_companion *s, const fl_world *w, double every, int32_t of, double goal, double p,
                        fl_err *err);

/* D of the rows until now; 0 where the parts bore nothing, or no row was. */
double fl_companion_difference(const fl_companion *s, int32_t of);

/* e for D. */
double fl_companion_error(const fl_companion *s, double apart, double p);

/* What it remembers beside its world, as rows of text, and back into what fl_companion_make() made: one list
 * for both ways, f or in.  The world is one that fl_snapshot_write() takes, where it has started and not
 * ended (fl_companion_is_active()).  Not 0 as putc(), or with FL_INPUT. */
int fl_companion_state_io(FILE *f, fl_text *in, fl_companion *s, fl_err *err);
static inline int fl_companion_is_active(const fl_companion *s) { return s->started && !s->ended; }

#endif
