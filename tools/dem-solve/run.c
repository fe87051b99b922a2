/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run.h"
#include <signal.h>
#include <unistd.h>
#include "clocks.h"
#include "final_ice.h"
#include "outputs.h"
#include "run_record.h"
#include "save.h"
#include "sim/device_step.h"
#include "sim/energy_balance.h"
#include "sim/inflow.h"
#include "sim/sleep.h"
#include "sim/stage.h"
#include "sim/step.h"
#include "step_choice.h"
#include "warnings.h"

/* --- signals ----------------------------------------------------------------------------------- */

static volatile sig_atomic_t stop_signal, save_signal, pipe_signal;

static void on_signal(int number)
{
    if (number == SIGUSR1) save_signal = 1;
    else if (number == SIGPIPE) pipe_signal = 1;
    else stop_signal = number;
}

/* SIGTERM, SIGINT and SIGHUP end the run after the step under way; a second one ends the program at
 * once.  After SIGPIPE the run ends when a row has failed. */
static void catch_signals(const struct run *r)
{
    static const int STOP[] = {SIGTERM, SIGINT, SIGHUP};
    struct sigaction act = {.sa_handler = on_signal, .sa_flags = SA_RESTART}, was;
    if (r->scene->output.checkpoint[0]) sigaction(SIGUSR1, &act, NULL);
    if (sigaction(SIGPIPE, NULL, &was) == 0 && was.sa_handler != SIG_IGN) sigaction(SIGPIPE, &act, NULL);
    act.sa_flags |= (int)SA_RESETHAND;
    for (size_t k = 0; k < sizeof STOP / sizeof *STOP; k++)
        if (sigaction(STOP[k], NULL, &was) == 0 && was.sa_handler != SIG_IGN) sigaction(STOP[k], &act, NULL);
}

/* --- between two steps ------------------------------------------------------------------------- */

/* Write a checkpoint if the interval, a signal or the end of the run requires one. */
static int save_if_due(struct run *r, struct outputs *u, int last, fl_err *err)
{
    struct timer *const timer = &u->timer[TIMER_SAVE];
    if (!r->scene->output.checkpoint[0]) return 0;
    const int due = r->w->step >= timer->due;
    if (!due && !save_signal && !stop_signal && !last) return 0;
    if (r->saves && r->saved_step == r->w->step) return 0;
    save_signal = 0;
    if (fl_device_refresh(r->w, err)) return -1;
    while (r->w->step >= timer->due) set_timer(r, u, TIMER_SAVE, timer->k + 1);
    return save_write(r, u, err);
}

/* 1 if all numbers are finite: a step that failed because it was too long leaves a valid state. */
static int is_finite_state(const fl_world *w)
{
    for (int32_t i = 0; i < w->n; i++) {
        const fl_vec3 all[] = {w->b.x[i], w->b.v[i], w->b.L[i], w->b.f[i], w->b.t[i]};
        for (int k = 0; k < 5; k++)
            if (!isfinite(all[k].x) || !isfinite(all[k].y) || !isfinite(all[k].z)) return 0;
    }
    return 1;
}

static void show_progress(const struct run *r, double begun, int last)
{
    const double t = fl_world_time(r->w), wall = wall_clock() - begun, end = r->scene->run.duration;
    const double left = t > 0.0 ? wall / t * (end - t) : 0.0;
    fprintf(stderr, "\r%8.2f s of %g s   %6.2f x real time   %5.0f s left ", t, end,
            wall > 0.0 ? t / wall : 0.0, left);
    if (last) fputc('\n', stderr);
    fflush(stderr);
}

/* At the end of a row of the loads run.error may change the step, and with it the steps at which rows are
 * due. */
static int update_step(struct run *r, struct outputs *u, fl_err *err)
{
    const struct timer *const loads = &u->timer[TABLE_LOADS];
    const int64_t row = loads->k - 1;
    const double dt = r->w->dt, begun = wall_clock();
    if (!r->budget || step_at(r->w, (double)row * loads->every) != r->w->step) return 0;
    if (fl_error_budget_update(r->budget, r->w, row, err)) return -1;
    if (r->w->dt != dt) {
        reschedule(r, u);
        count_steps(r);
    }
    r->budget_wall += wall_clock() - begun;
    return 0;
}

/* Let the companion run of run.error follow, before the row of this step is written. */
static int follow_run(struct run *r, fl_err *err)
{
    const double begun = wall_clock();
    if (fl_error_budget_follow(r->budget, r->w, err)) return -1;
    r->budget_wall += wall_clock() - begun;
    return 0;
}

/* --- the run ------------------------------------------------------------------------------------ */

static int start_run(struct run *r, struct outputs *u, fl_err *err)
{
    const double chosen = r->w->dt;
    const int bad = fl_step_start(r->w, err);
    if (!bad && check_start(r, err)) {
        r->refused = 1;
        return -1;
    }
    /* A warning may explain why the step is too long. */
    if ((!bad || err->code == FL_NUMERIC) && record_start(r, u, err)) return -1;
    if (bad || update_chosen_step(r, chosen, err)) return -1;
    warn_at_row(r, 0.0);
    return write_due(r, u, err);
}

/* Stages, and whether the run has come to rest. */
static int update_stage(struct run *r, fl_err *err)
{
    const int32_t before = r->w->next_stage;
    const int settled =
        fl_stage_update(r->w, r->group, (const char *const *)r->groups->name, r->groups->n, err);
    if (r->w->next_stage > before && !r->o->quiet)
        fprintf(stderr, "dem-solve: stage %s begins at %.6g s\n", r->scene->stage[before].name,
                fl_world_time(r->w));
    return settled;
}

static int run_steps(struct run *r, struct outputs *u, int show, double begun, fl_err *err)
{
    fl_world *w = r->w;
    double shown = begun;
    r->started = 1;
    if (!r->resumed && start_run(r, u, err)) return -1;
    while (w->step < r->steps && !stop_signal) {
        if (update_step(r, u, err)) return -1;
        if (stop_signal) break; /* an abandoned search is repeated when the run is resumed */
        r->body_steps += w->inflow.absent ? fl_floes_in_domain(w) : w->n;
        if (r->settles && (r->settled = update_stage(r, err)) != 0) break;
        if (fl_step(w, err) || (r->budget && follow_run(r, err)) || write_due(r, u, err) ||
            save_if_due(r, u, 0, err))
            return -1;
        if (show && w->step % 64 == 0) {
            const double now = wall_clock();
            if (now - shown >= 0.5) show_progress(r, begun, 0), shown = now;
        }
    }
    if (r->settled < 0) return -1;
    r->stopped = w->step < r->steps && !r->settled ? stop_signal : 0;
    if (r->stopped) return save_if_due(r, u, 0, err); /* the signal may have come before the first step */
    /* A longer run would have no shorter last row and no energy check here, so the checkpoint that it
     * could resume comes before them. */
    if (save_if_due(r, u, 1, err) || fl_device_refresh(w, err) || fl_energy_check(w, err)) return -1;
    return write_last_loads(r, u, err);
}

int run_scene(struct run *r, fl_err *err)
{
    struct outputs u = {0};
    const int show = r->o->verbose || (!r->o->quiet && isatty(STDERR_FILENO));
    if (r->resumed ? save_restore(r, &u, err) : open_outputs(r, &u, err)) {
        abort_outputs(&u);
        return -1;
    }
    keep_outputs(&u);
    catch_signals(r);
    if (r->budget) r->budget->stop = &stop_signal;
    const double begun = wall_clock(), cpu_begun = cpu_clock();
    const int rc = run_steps(r, &u, show, begun, err);
    if (r->refused) {
        r->started = 0;
        discard_outputs(&u);
        return -1;
    }
    fl_err gone = {0}; /* with the card went the state of the run */
    if (fl_device_refresh(r->w, &gone) && !rc) *err = gone;
    if (rc && !gone.code && err->code == FL_NUMERIC && r->w->step > 0 && r->scene->output.checkpoint[0] &&
        is_finite_state(r->w)) {
        fl_err why = {0}; /* the failure of the run is reported, not this one */
        save_write(r, &u, &why);
    }
    r->step_wall = wall_clock() - begun - r->save_wall - r->budget_wall;
    r->cpu_time = cpu_clock() - cpu_begun;
    if (show) show_progress(r, begun, 1);
    fl_sleep_advance_to_now(r->w);
    if (!gone.code) fl_energy_update(r->w);
    /* After SIGPIPE a row could not be written. */
    const int ended_by = rc && pipe_signal && err->code == FL_SYSTEM ? SIGPIPE : r->stopped;
    const fl_err why = *err;
    const int lost = record_end(r, &u, &why, ended_by, err);
    /* Also after a failed run: the rows until then are good, and the tables keep their names. */
    if (!close_outputs(&u, err) && !rc && !lost && !gone.code)
        return r->stopped ? 0 : write_final_ice(r, err);
    if (!pipe_signal || err->code != FL_SYSTEM) return -1;
    r->stopped = SIGPIPE;
    *err = (fl_err){0};
    return 0;
}
