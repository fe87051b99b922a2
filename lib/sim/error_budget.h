/* SPDX-License-Identifier: GPL-3.0-or-later */
/* error_budget.h -- the largest step that keeps a load within an error: run.error.
 *
 * The step is looked after at ends of rows of the loads, where whole steps end.  A look takes the state, puts
 * it into a second world made from the same scene, and moves that through a window of some rows with steps
 * h, h/2 and h/4.  With X the load of the window and d = |X(h) - X(h/2)|, d' = |X(h/2) - X(h/4)|,
 *     order    p = log2(d/d'), kept in [1, 2],
 *     error    e = |X(h) - X(h/4)| + d'/(2^p - 1),       e(h') = e (h'/h)^p            (Richardson)
 * Where another step must be tried the order is known, h and h/2 do, and e = d/(1 - 2^-p).
 * The step is the largest, among those that divide a row, for which all windows looked at together stay
 * within the goal,
 *     max(|sum s(h)|, sqrt(sum e(h)^2)) <= 0.9 goal sum |X|,
 * with s the part of the error along X, for errors of either sign cancel and those of one add up; of peaks
 * it is the largest error against the largest peak, and 0.65.  Because what goes wrong between floes reaches
 * the structure later, the momenta of the floes at the end of the window must be right, too, to the goal (of
 * a peak, half of it) of the impulses they took: of contacts, or of all there is, where that is more, for a
 * floe that water turns while another one is grazed owes nothing to that touch.  The step that is taken has
 * been tried itself, or is shorter: by other laws than `patch` what is shaken across on an edge is stable up
 * to fl_lateral_share() of the largest that is tried, and a window may see nothing of that.
 *
 * It is looked at the start; before two things may meet whose kind of meeting has not been seen with nearly
 * that momentum (floe and floe, floe and each part of the structure, floe and wall); and again after ten
 * times as many steps as the last look took.  Where things meet in a window it is made ten times as long, and
 * looked at after eight and after ten of them, of which the larger error counts: what an impact is off by,
 * others may add to or take back, as a floe that comes to rest in the end has given all its momentum whatever
 * became of the first impact.
 *
 * How far ahead a state tells anything is measured, after a time and again after twice of it, by two windows
 * T whose floes differ by a small shift s, and by s/T in speed: rate = ln(distance at the end / that of free
 * flight) / T, averaged, where the distance is of positions and of speeds times T.  Windows stay shorter than
 * 1/rate.  All of it follows from the states alone: same bits on any number of threads, and after a stop.
 * Source: Richardson, Phil. Trans. A 226 (1927) 299. */
#ifndef FL_SIM_ERROR_BUDGET_H
#define FL_SIM_ERROR_BUDGET_H
#include <signal.h>
#include <stdio.h>
#include "sim/companion_run.h"
#include "sim/critical_step.h"

enum { FL_ERROR_WINDOWS = 32 }; /* the latest that are kept */

/* What one window told. */
typedef struct {
    double h;                  /* step [s] */
    double error, order, size; /* e, p and |X| of the load that is asked for */
    double signed_error;       /* s */
    double momentum_error, momentum_order,
        impulse; /* the same of the momenta of floes, what they took [N s] */
} fl_error_window;

/* All of an end of a window, of one trial. */
typedef struct {
    fl_total_load *load;          /* [looks][parts] */
    fl_vec3 *momentum, *position; /* [n] */
    double contact_impulse;       /* impulses of all contacts [N s] */
    double momentum_change;       /* half of what the momenta changed by, summed over floes [N s] */
    int failed;                   /* the step was above the critical one */
} fl_window_end;

typedef struct {
    double goal;              /* run.error */
    int32_t load;             /* run.error_of: impulse, peak, fx, fy, fz, mx, my, mz */
    double row_interval;      /* interval of the loads, which steps divide [s] */
    fl_predicted_limit limit; /* what bounds the step of a trial */
    double lateral_share;     /* and so much of that one that is taken */
    int32_t min_row_steps;    /* steps in it with the largest step a trial may have */
    int32_t window_rows;      /* rows in a window */
    fl_error_window window[FL_ERROR_WINDOWS];
    int32_t windows, latest_window;        /* how many there are, and where the last one is */
    int64_t n_searches;                    /* made so far */
    int64_t last_search_step;              /* step of the last, -1: none */
    int64_t trial_steps, last_search_cost; /* steps made in trials, and those of the last look */
    double *known_momentum; /* [2 + parts] momentum of the hardest meeting seen, by kind; -1: none [N s] */
    double *trial_momentum; /* [2 + parts] of the trial under way */
    double divergence_rate; /* at which near states part [1/s] */
    double growth_log_sum, growth_time; /* sum of the logarithms, and of the windows they are of [s] */
    double next_rate_time;              /* when that is measured again [s] */
    double min_dt, max_dt;              /* steps taken so far [s] */
    fl_companion companion;             /* what the run comes to as a whole */
    fl_world trial;
    fl_window_end end[3];
    char *state_text; /* the state looked at */
    size_t state_bytes;
    const volatile sig_atomic_t *stop; /* when that is not 0 a look is broken off; NULL: never */
} fl_error_budget;

/* A second world of the scene, and no window yet.  -1 as fl_world_make_with_inflow(). */
int fl_error_budget_make(fl_error_budget *g, const fl_scene *scene, const fl_ice_field *field,
                         const fl_ice_field *feed, const fl_surface *surface, fl_err *err);
void fl_error_budget_free(fl_error_budget *g); /* accepts a zeroed struct, leaves one */

/* The step to start with [s]: the largest there may be. */
double fl_error_budget_first_step(const fl_error_budget *g);

/* Look, if there is reason to, at w, which is at the end of a row, at t = row * every; sets its step for the
 * rows to come.  w has begun; calling twice in one step does nothing more.  One that was broken off leaves g
 * and the step as if it had not begun, and the run is to end there.  -1 with FL_SYSTEM. */
int fl_error_budget_update(fl_error_budget *g, fl_world *w, int64_t row, fl_err *err);

/* Behind each step of w and before its row is told: the run beside it comes after.  -1 with FL_SYSTEM. */
int fl_error_budget_follow(fl_error_budget *g, const fl_world *w, fl_err *err);

/* Error of the load of the run as a whole, over its size, up to g->beside.until, and by how much the run
 * beside it differs: companion_run.h. */
double fl_error_budget_run_error(const fl_error_budget *g, double *apart);

/* Error of the load by the windows so far, over its size, were all steps h; 0 before the first. */
double fl_error_budget_estimate(const fl_error_budget *g, double h);

/* When states that differ by a bit differ by the goal [s]; INFINITY: they do not part. */
double fl_error_budget_horizon(const fl_error_budget *g);

/* What it remembers, as rows of text, and back into what fl_error_budget_make() made.  -1 with FL_INPUT. */
void fl_error_budget_write(FILE *f, const fl_error_budget *g);
int fl_error_budget_read(fl_error_budget *g, fl_text *in, fl_err *err);

#endif
