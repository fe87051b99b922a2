/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Looks for a step that keeps run.error, where there is none; and what the run beside it does not keep. */
#include <math.h>
#include <stdlib.h>
#include "scene/scene_check.h"
#include "sim/error_budget.h"
#include "contact/panel_load.h"
#include "support/small_world.h"
#include "support/verify.h"

static const fl_vec3 NONE = {0, 0, 0};

static void post(lab *l, double x, double r) { lab_cone(l, (fl_cone){v3(x, 0, -3), v3(x, 0, 3), r, r}); }

/* What the scene is known for goes into a budget, and the world stands at t = 0. */
static void make(lab *l, fl_error_budget *g)
{
    fl_err err = {0};
    lab_set(l, "structure.file=lab");
    *g = (fl_error_budget){0};
    if (fl_scene_check(&l->scene, &err) ||
        fl_error_budget_make(g, &l->scene, &l->field, &l->field, &l->surface, &err))
        exit(1);
    lab_make(l, fl_error_budget_first_step(g));
}

static void look(lab *l, fl_error_budget *g, int64_t row)
{
    fl_err err = {0};
    if (fl_error_budget_update(g, &l->w, row, &err)) exit(1);
}

/* Steps of trials over those of a window with the largest step. */
static double windows(const fl_error_budget *g)
{
    return (double)g->trial_steps * fl_error_budget_first_step(g) / (g->row_interval * g->window_rows);
}

/* Two blocks meet ten thousand times too softly, by a law that has no potential: energy is made there by any
 * step, and looks for one that would do end soon. */
static void futile(void)
{
    lab l;
    fl_error_budget g;
    lab_start(&l);
    lab_set(&l, "output.loads_every=0.1"), lab_set(&l, "run.duration=0.6"), lab_set(&l, "run.error=0.01");
    lab_set(&l, "contact.law=manual-si"), lab_set(&l, "contact.stiffness_factor=1e-4");
    post(&l, 30, 1);
    for (int k = 0; k < 2; k++)
        lab_box(&l, v3(1.5 * k, 0.3 * k, 0.2 * k), v3(0.55, 0.55, 0.55), 0.05, q_one(), v3(k ? 0 : 5, 0, 0),
                NONE);
    make(&l, &g), look(&l, &g, 0);
    verify_true("E13", "no step was found for it", !isfinite(fl_error_budget_estimate(&g, l.w.dt)));
    verify_below("E13", "steps of trials over those of the largest window", windows(&g), 250.0);
    fl_error_budget_free(&g), lab_free(&l);
}

/* Elastic balls in a cage meet so often within a window that no step tells where they are at its end. */
static void caged(void)
{
    lab l;
    fl_error_budget g;
    lab_start(&l);
    lab_set(&l, "output.loads_every=0.5"), lab_set(&l, "run.duration=5"), lab_set(&l, "run.error=1e-4");
    lab_set(&l, "material.ice.young=1e6"), lab_set(&l, "contact.restitution=1");
    lab_set(&l, "boundary.min=-1 -1 -1"), lab_set(&l, "boundary.max=1 1 1");
    post(&l, 0, 0.2);
    for (int k = 0; k < 8; k++)
        lab_sphere(&l, v3(k & 1 ? 0.6 : -0.6, k & 2 ? 0.55 : -0.6, k & 4 ? 0.6 : -0.5), 0.3,
                   v3(2 - 0.7 * k, 1.5 - k % 3, 0.4 * k - 1), NONE);
    make(&l, &g), look(&l, &g, 0);
    verify_note("balls in a cage are off by %.2g of the impulse by estimate",
                fl_error_budget_estimate(&g, l.w.dt));
    verify_true("E15", "no step was found for them", fl_error_budget_estimate(&g, l.w.dt) > 1e-3);
    verify_below("E15", "steps of trials over those of the largest window", windows(&g), 1500.0);
    fl_error_budget_free(&g), lab_free(&l);
}

/* The run beside it keeps no events, which nobody would write: they would be more and more. */
static void no_events(void)
{
    enum { ROWS = 10 };
    lab l;
    fl_error_budget g;
    fl_err err = {0};
    int touched = 0;
    int32_t kept = 0;
    lab_start(&l);
    lab_set(&l, "output.loads_every=0.05"), lab_set(&l, "run.duration=0.5"), lab_set(&l, "run.error=0.01");
    lab_set(&l, "output.events=events.dat");
    lab_set(&l, "contact.stiffness_factor=0.1"), lab_set(&l, "contact.restitution=1");
    post(&l, 2, 1), lab_box(&l, v3(-0.13, 0, 0), v3(1, 1, 0.3), 0.05, q_one(), v3(1, 0, 0), NONE);
    make(&l, &g);
    for (int64_t row = 0; row < ROWS; row++) {
        look(&l, &g, row);
        for (int64_t k = lround(g.row_interval / l.w.dt); k > 0; k--)
            if (lab_run(&l, 1) || fl_error_budget_follow(&g, &l.w, &err)) exit(1);
        touched |= l.w.panel_load.events > 0;
        kept += g.companion.world.panel_load.events;
        fl_events_end_interval(&l.w);
    }
    verify_true("E14", "there are events", touched);
    verify_row("E14", "of which the run beside keeps", kept, 0.0, 0.0, VERIFY_ABS);
    fl_error_budget_free(&g), lab_free(&l);
}

int main(void)
{
    verify_begin("looks for a step where there is none");
    futile();
    caged();
    no_events();
    return verify_end();
}
