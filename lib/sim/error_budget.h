/* SPDX-License-Identifier: GPL-3.0-or-later */
/* error_budget.h -- the largest step that keeps the error of a load within a goal: run.error.
 *
 * The step is chosen at ends of rows of the loads, where whole steps end.  A search writes the state,
 * reads it into a second world of the same scene, and runs that through a window of some rows with steps
 * h, h/2 and h/4. With X the load of the window, d = |X(h) - X(h/2)| and d' = |X(h/2) - X(h/4)|,
 *     order    p = log2(d/d'), limited to [1, 2],
 *     error    e = |X(h) - X(h/4)| + d'/(2^p - 1),       e(h') = e (h'/h)^p            (Richardson)
 * Once the order is known, a further step needs h and h/2 only, and e = d/(1 - 2^-p). The result is the
 * largest step, among those that divide a row, for which all windows together stay within
 *     max(|sum s(h)|, sqrt(sum e(h)^2)) <= 0.92 goal sum |X|,
 * with s the part of the error along X: errors of either sign cancel, those of one sign add up.  For
 * peaks the largest error is compared with the largest peak, and the factor is 0.65.
 *
 * What goes wrong between floes reaches the structure later.  So the momenta of the floes at the end of
 * the window must be right, too: to the goal, or half of it for a peak, relative to the impulses that
 * they took. These are the impulses of contacts, or of all forces where that is more: a floe that water
 * turns while another one is grazed does not owe its momentum to that contact.
 *
 * The step used has been tried itself or is shorter: with laws other than `patch`, bodies that rock on an
 * edge are stable up to fl_lateral_share() of the largest step tried, and a window may not show that.
 *
 * A search runs at the start; before two things may meet whose kind of contact has not been seen with
 * nearly that momentum (floe and floe, floe and each part of the structure, floe and wall); and again
 * after ten times as many steps as the last search took.  Where things meet in a window it becomes ten
 * times as long.  Its load is compared after eight and after ten of these, and the larger error counts:
 * later contacts may add to the error of an impact or cancel it, as a floe that comes to rest in the end
 * has given all its momentum.
 *
 * Divergence of nearby states is measured after some time, and again after twice that, by two windows of
 * length T whose floes differ by a small shift s, and by s/T in speed:
 *     rate = ln(distance at the end / that of free flight) / T, averaged,
 * with the distance of positions and of speeds times T.  Windows stay shorter than 1/rate. All of it
 * depends on the states alone: same bits for any number of threads, and after a stop. Source: Richardson,
 * Phil. Trans. A 226 (1927) 299. */
#ifndef FL_SIM_ERROR_BUDGET_H
#define FL_SIM_ERROR_BUDGET_H
#include <signal.h>
#include <stdio.h>
#include "sim/companion_run.h"
#include "sim/critical_step.h"

enum { FL_ERROR_WINDOWS = 32 }; /* the latest that are kept */

/* The result of one window. */
typedef struct {
    double h;                              /* step [s] */
    double error, order, size;             /* e, p and |X| of the load of the goal */
    double signed_error;                   /* s */
    double momentum_error, momentum_order; /* the same of the momenta of the floes */
    double impulse;                        /* that the floes took [N s] */
} fl_error_window;

/* The end of a window, of one trial. */
typedef struct {
    fl_total_load *load;          /* [2][parts] at the two rows that are compared */
    fl_vec3 *momentum, *position; /* [n] */
    double contact_impulse;       /* impulses of all contacts [N s] */
    double momentum_change;       /* half of the sum over floes of |change of momentum| [N s] */
    int failed;                   /* the step was above the critical one */
} fl_window_end;

typedef struct {
    double goal;              /* run.error */
    int32_t load;             /* run.error_of: impulse, peak, fx, fy, fz, mx, my, mz */
    double row_interval;      /* interval of the loads, a multiple of the step [s] */
    fl_predicted_limit limit; /* limits the step of a trial */
    double lateral_share;     /* share of that which is used */
    int32_t min_row_steps;    /* steps in a row with the largest step of a trial */
    int32_t window_rows;      /* rows in a window */
    fl_error_window window[FL_ERROR_WINDOWS];
    int32_t windows, latest_window;        /* number kept, index of the last one */
    int64_t n_searches;                    /* made so far */
    int64_t last_search_step;              /* -1: none */
    int64_t trial_steps, last_search_cost; /* steps in trials, and those of the last search */
    double *known_momentum;                /* [2 + parts] largest seen, by kind of contact; -1: none [N s] */
    double *trial_momentum;                /* [2 + parts] of the trial that runs */
    double divergence_rate;                /* of nearby states [1/s] */
    double growth_log_sum, growth_time; /* sums of the logarithms and of the lengths of their windows [s] */
    double next_rate_time;              /* when it is measured again [s] */
    double min_dt, max_dt;              /* steps used so far [s] */
    fl_companion companion;             /* for the error of the run as a whole */
    fl_world trial;
    fl_window_end end[3];
    char *state_text; /* the state from which trials start */
    size_t state_bytes;
    const volatile sig_atomic_t *stop; /* a search is abandoned when it is not 0; NULL: never */
} fl_error_budget;

/* Build the second world of the scene; no window yet.  -1 as fl_world_make_with_inflow(). */
int fl_error_budget_make(fl_error_budget *g, const fl_scene *scene, const fl_ice_field *field,
                         const fl_ice_field *feed, const fl_surface *surface, const fl_member_model *members,
                         fl_err *err);
void fl_error_budget_free(fl_error_budget *g); /* accepts a zeroed struct, leaves one */

/* The step to start with: the largest allowed [s]. */
double fl_error_budget_first_step(const fl_error_budget *g);

/* Run a search if one is due, for w at the end of a row, t = row * row_interval; sets the step of w for
 * the next rows.  w has started; a second call in one step does nothing.  An abandoned search leaves g
 * and the step as if it had not begun; the run must end there.  -1 with FL_SYSTEM. */
int fl_error_budget_update(fl_error_budget *g, fl_world *w, int64_t row, fl_err *err);

/* After each step of w, before its row is written: let the companion run follow.  -1 with FL_SYSTEM. */
int fl_error_budget_follow(fl_error_budget *g, const fl_world *w, fl_err *err);

/* Relative error of the load of the run as a whole, up to companion.last_row_time; *difference: of the
 * companion run (companion_run.h). */
double fl_error_budget_run_error(const fl_error_budget *g, double *difference);

/* Relative error of the load by the windows so far, if all steps were h; 0 before the first window. */
double fl_error_budget_estimate(const fl_error_budget *g, double h);

/* Time after which states that differ by one bit differ by the goal [s]; INFINITY: they do not diverge. */
double fl_error_budget_horizon(const fl_error_budget *g);

/* Write the memory of g as rows of text; read it into what fl_error_budget_make() made.  -1 with FL_INPUT. */
void fl_error_budget_write(FILE *f, const fl_error_budget *g);
int fl_error_budget_read(fl_error_budget *g, fl_text *in, fl_err *err);

#endif
