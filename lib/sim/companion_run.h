/* SPDX-License-Identifier: GPL-3.0-or-later */
/* companion_run.h -- the error of a run as a whole: the same run once more, with other steps.
 *
 * Windows (error_budget.h) show the error of a step as long as states have no time to diverge.
 * Afterwards it grows.  Two floes whose sides meet flat for a time T leave with a velocity that differs
 * by d/T if one of them arrives a distance d too late; until the next impact, t later, that becomes
 * d t/T: a thousand times d in crowded ice.  No window shows that.  So a second world makes the same run
 * with r times the step, row by row of the loads.  With X the load of the run until now and X' that of
 * the other,
 *     D = sum |X' - X| / sum |X|,      error e = D/|r^p - 1|                        (Richardson)
 * with p the order found by windows, and r = sqrt(2) as nearly as whole steps in a row allow.  So e = D
 * for p = 2; where the two have diverged D says no more than that.  It costs 0.7 of the run.  Errors of
 * twenty short scenes were 0.2 to 4 times e (verify_budget, E01 and E02), so e is compared with three
 * times the goal. */
#ifndef FL_SIM_COMPANION_RUN_H
#define FL_SIM_COMPANION_RUN_H
#include <stdio.h>
#include "base/text.h"
#include "scene/scene.h"
#include "world/world.h"

#define FL_COMPANION_TOLERANCE 3.0

/* The load on a part since the start. */
typedef struct {
    fl_vec3 impulse, moment; /* [N s], [N m s] */
    double peak;             /* [N] */
} fl_total_load;

/* The component `of` of a load, enum fl_error_of. */
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
    double step_ratio; /* r; of all rows the one that separates the errors least; 0: no row yet */
    double
        exceeded_since;   /* e is above FL_COMPANION_TOLERANCE times the goal since then [s]; -1: it is not */
    double last_row_time; /* end of the last row [s] */
    int32_t started;      /* the companion run has started: members below are set */
    int32_t ended;        /* its step was above the critical one: it does not continue */
} fl_companion;

/* Build the second world of the scene, which has not started.  -1 as fl_world_make_with_inflow(). */
int fl_companion_make(fl_companion *s, const fl_scene *scene, const fl_ice_field *field,
                      const fl_ice_field *feed, const fl_surface *surface, const fl_member_model *members,
                      fl_err *err);
void fl_companion_free(fl_companion *s); /* accepts a zeroed struct, leaves one */

/* After a step of the run w, before the loads of its row are cleared: follow in whole steps, and compare
 * at the end of a row.
 *   every     length of a row [s]
 *   of, goal  component of the load and its allowed relative error
 *   p         order of the error
 * -1 with FL_SYSTEM. */
int fl_companion_follow(fl_companion *s, const fl_world *w, double every, int32_t of, double goal, double p,
                        fl_err *err);

/* D of the rows until now; 0 without any load or row. */
double fl_companion_difference(const fl_companion *s, int32_t of);

/* e from D. */
double fl_companion_error(const fl_companion *s, double difference, double p);

/* Write (f) or read (in) what is remembered beside the world, from one list of members.  The world itself
 * is a snapshot of its own if fl_companion_is_active().  Not 0 as putc(), or with FL_INPUT. */
int fl_companion_state_io(FILE *f, fl_text *in, fl_companion *s, fl_err *err);
static inline int fl_companion_is_active(const fl_companion *s) { return s->started && !s->ended; }

#endif
