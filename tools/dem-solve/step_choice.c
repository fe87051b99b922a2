/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "step_choice.h"
#include <string.h>
#include "sim/critical_step.h"
#include "sim/moving_structure.h"
#include "sim/strip_setup.h"

const char *body_name(const fl_world *w, int32_t k, char name[64])
{
    if (k >= w->b.total) snprintf(name, 64, "%s", fl_mover_name(w, k - w->b.total));
    else if (k >= 0) snprintf(name, 64, "body %d", w->id[k]);
    else snprintf(name, 64, "a floe that has left");
    return name;
}

/* More steps than a run can have, see check_step_count(). */
#define NEVER (INT64_C(1) << 60)

int64_t step_at(const fl_world *w, double t)
{
    const double n = ceil((t - w->t0 - TIME_ROUNDING * t) / w->dt);
    return n < (double)NEVER ? w->step0 + (int64_t)n : NEVER;
}

void count_steps(struct run *r) { r->steps = step_at(r->w, r->scene->run.duration); }

int check_step_count(const struct run *r, fl_err *err)
{
    const double limit = 9007199254740992.0, n = r->scene->run.duration / r->w->dt; /* 2^53 */
    if (n < limit) return 0;
    return fl_scene_fail(r->scene, "run.duration", err,
                         "run.duration of %g s in steps of %g s: %.3g steps, at most %.3g expected",
                         r->scene->run.duration, r->w->dt, n, limit);
}

/* The step is half of the critical one, or what one damped contact leaves or 0.8 of it, or less by many
 * damped contacts. */
static void describe_damped_step(char *to, size_t n, double share, double left, double critical)
{
    const double part = share / left;
    if (fabs(share - 0.5) < 1e-3)
        snprintf(to, n, "half of the critical %.4g s, the largest without run.dt", critical);
    else if (fabs(part - 0.5) < 1e-3 || fabs(part - 0.8) < 1e-3)
        snprintf(to, n, "damping, %.2g of the %.3g that it leaves of the critical %.4g s", part, left,
                 critical);
    else snprintf(to, n, "damping by many contacts, %.3g of the critical %.4g s", share, critical);
}

static void describe_step(struct run *r, double automatic)
{
    const fl_scene_run *s = &r->scene->run;
    const double left = fl_damped_share(r->w), every = r->scene->output.loads_every;
    char name[64], *to = r->step_by;
    const size_t n = sizeof r->step_by;
    if (r->budget)
        snprintf(to, n, "run.error, up to %.3g of the critical %.4g s",
                 r->budget->lateral_share * automatic / r->critical, r->critical);
    else if (s->dt > 0.0) snprintf(to, n, "run.dt");
    else if (fl_strips_max_step(r->w) < fmin(automatic, fmin(every, s->duration)))
        snprintf(to, n, "failure.break_deflection, a fifth of it closes in a step");
    else if (automatic >= fmin(every, s->duration))
        snprintf(to, n, every <= s->duration ? "output.loads_every" : "run.duration");
    else if (fl_world_bonds(r->w) &&
             automatic / r->critical > fl_predict_step_limit(r->w).contact_share * (1.0 + TIME_ROUNDING))
        snprintf(to, n, "bonds and contacts, %.3g of the critical %.4g s", automatic / r->critical,
                 r->critical);
    else if (automatic / r->critical < s->safety * (1.0 - TIME_ROUNDING))
        describe_damped_step(to, n, automatic / r->critical, left, r->critical);
    else snprintf(to, n, "run.safety, %.3g of the critical %.4g s", s->safety, r->critical);
    if (s->dt > 0.0 || r->step_body < 0 ||
        automatic >= fmin(fl_strips_max_step(r->w), fmin(every, s->duration)))
        return;
    const size_t used = strlen(to);
    snprintf(to + used, n - used, " of %s", body_name(r->w, r->step_body, name));
}

void choose_step(struct run *r)
{
    const double every = r->scene->output.loads_every;
    const double automatic = fl_automatic_step(r->w, &r->step_body);
    double dt = r->scene->run.dt;
    r->critical = fl_critical_step(r->w);
    describe_step(r, automatic);
    if (r->budget) {
        dt = fl_error_budget_first_step(r->budget);
    } else if (dt <= 0.0) {
        dt = fmin(fmin(automatic, fl_strips_max_step(r->w)), fmin(every, r->scene->run.duration));
        dt = every / ceil(every / dt * (1.0 - 1e-12));
    }
    r->w->dt = dt;
    r->w->automatic_dt = !r->budget && r->scene->run.dt <= 0.0;
    count_steps(r);
}

int update_chosen_step(struct run *r, double chosen, fl_err *err)
{
    const fl_world *w = r->w;
    char name[64];
    if (w->dt == chosen) return 0;
    snprintf(r->step_by, sizeof r->step_by, "overlaps at the start, %.3g of the critical %.4g s of %s",
             w->dt / w->dt_critical, w->dt_critical, body_name(w, w->critical_body, name));
    r->step_body = w->critical_body;
    r->critical = w->dt_critical;
    count_steps(r);
    return check_step_count(r, err);
}
