/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beside.h -- what a step comes to in a run as a whole: the run once more beside it, with other steps.
 *
 * Windows (budget.h) tell what a step is off by as long as states have no time to part.  What it is off by
 * grows afterwards: where sides of floes meet flat for a time T, what they leave with differs by d/T where
 * one comes by a way d too late, and by the next hit, t later, that has made d t/T of d: a thousand times as
 * much among floes that crowd.  No window sees that.  So a second world makes the same run with r times the
 * step, row of the loads by row.  With X the load of the run until now and X' of the other,
 *     D = sum |X' - X| / sum |X|,      error e = D/|r^p - 1|                        (Richardson)
 * with p the order that the windows found, and r = sqrt(2), as nearly as whole steps in a row let it be: so e
 * is D where p is 2, and where the two have parted, which is all that D tells then.  It takes 0.7 of what the
 * run does.  Twenty short scenes were off by 0.2 to 4 times e (verify_budget, E01 and E02), so e is not held
 * against the goal itself but against three times that. */
#ifndef FL_STEP_BESIDE_H
#define FL_STEP_BESIDE_H
#include <stdio.h>
#include "base/text.h"
#include "scene/scene.h"
#include "world/world.h"

#define FL_DOUBT 3.0

/* What a part has borne from the start on. */
typedef struct {
    fl_vec3 impulse, moment; /* [N s], [N m s] */
    double peak;             /* [N] */
} fl_borne;

/* The load that is asked for, enum fl_error_of. */
static inline fl_vec3 fl_borne_load(int32_t of, fl_borne b)
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
    fl_world w;
    fl_borne *run, *other; /* [parts] of the run and of this world, up to the last row */
    double ratio;          /* r, of all rows that which tells the least; 0: no row yet */
    double since;          /* e has been above FL_DOUBT times the goal from there on [s]; -1: it is not */
    double until;          /* end of the last row [s] */
    int32_t started;       /* it has: what follows is of this world */
    int32_t ended;         /* its steps were above the critical one: nothing is told of what comes */
} fl_beside;

/* A second world of the scene, which has not begun.  -1 as fl_world_make_fed(). */
int fl_beside_make(fl_beside *s, const fl_scene *scene, const fl_field *field, const fl_field *feed,
                   const fl_surface *surface, fl_err *err);
void fl_beside_free(fl_beside *s); /* accepts a zeroed struct, leaves one */

/* Behind a step of the run w, before what its parts bear in this row is forgotten: come after it as far as
 * that is whole steps, and at the end of a row compare.  every: a row [s]; of, goal: the load that is asked
 * for and what it may be off by; p: its order.  -1 with FL_SYSTEM. */
int fl_beside_follow(fl_beside *s, const fl_world *w, double every, int32_t of, double goal, double p,
                     fl_err *err);

/* D of the rows until now; 0 where the parts bore nothing, or no row was. */
double fl_beside_apart(const fl_beside *s, int32_t of);

/* e for D. */
double fl_beside_off(const fl_beside *s, double apart, double p);

/* What it remembers beside its world, as rows of text, and back into what fl_beside_make() made: one list
 * for both ways, f or in.  The world is one that fl_snapshot_write() takes, where it has started and not
 * ended (fl_beside_goes()).  Not 0 as putc(), or with FL_INPUT. */
int fl_beside_exchange(FILE *f, fl_text *in, fl_beside *s, fl_err *err);
static inline int fl_beside_goes(const fl_beside *s) { return s->started && !s->ended; }

#endif
