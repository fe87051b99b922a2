/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Searches for a step that keeps run.error where there is none, and memory that the companion run must not
 * use. */
#include <math.h>
#include <stdlib.h>
#include "scene/scene_check.h"
#include "sim/error_budget.h"
#include "contact/panel_load.h"
#include "support/small_world.h"
#include "support/verify.h"

static const fl_vec3 NONE = {0, 0, 0};

static void post(lab *l, double x, double r) { lab_cone(l, (fl_cone){v3(x, 0, -3), v3(x, 0, 3), r, r}); }

/* Reads the scene into an error budget and makes its world at t = 0. */
static void make_world(lab *l, fl_error_budget *g)
{
    fl_err err = {0};
    lab_set(l, "structure.file=lab");
    *g = (fl_error_budget){0};
    if (fl_scene_check(&l->scene, &err) ||
        fl_error_budget_make(g, &l->scene, &l->field, &l->field, &l->surface, NULL, &err))
        exit(1);
    lab_make(l, fl_error_budget_first_step(g));
}

static void search_step(lab *l, fl_error_budget *g, int64_t row)
{
    fl_err err = {0};
    if (fl_error_budget_update(g, &l->w, row, &err)) exit(1);
}

/* Trial steps over those of a window with the largest step. */
static double trial_windows(const fl_error_budget *g)
{
    return (double)g->trial_steps * fl_error_budget_first_step(g) / (g->row_interval * g->window_rows);
}

/* Two blocks meet, ten thousand times too soft, by a law without a potential.  Any step gains energy, and a
 * search for a better step must end soon. */
static void no_potential_search(void)
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
    make_world(&l, &g), search_step(&l, &g, 0);
    verify_true("E13", "no step was found for it", !isfinite(fl_error_budget_estimate(&g, l.w.dt)));
    verify_below("E13", "trial steps over steps of the largest window", trial_windows(&g), 250.0);
    fl_error_budget_free(&g), lab_free(&l);
}

/* Elastic spheres in a cage collide so often within a window that no step predicts their positions at its
 * end. */
static void spheres_in_cage(void)
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
    make_world(&l, &g), search_step(&l, &g, 0);
    verify_note("spheres in a cage: estimated error %.2g of the impulse",
                fl_error_budget_estimate(&g, l.w.dt));
    verify_true("E15", "no step was found for them", fl_error_budget_estimate(&g, l.w.dt) > 1e-3);
    verify_below("E15", "trial steps over steps of the largest window", trial_windows(&g), 1500.0);
    fl_error_budget_free(&g), lab_free(&l);
}

/* The companion run keeps no events, for nobody writes them and their number grows without limit. */
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
    make_world(&l, &g);
    for (int64_t row = 0; row < ROWS; row++) {
        search_step(&l, &g, row);
        for (int64_t k = lround(g.row_interval / l.w.dt); k > 0; k--)
            if (lab_run(&l, 1) || fl_error_budget_follow(&g, &l.w, &err)) exit(1);
        touched |= l.w.panel_load.events > 0;
        kept += g.companion.world.panel_load.events;
        fl_events_end_interval(&l.w);
    }
    verify_true("E14", "there are events", touched);
    verify_row("E14", "of which the companion run keeps", kept, 0.0, 0.0, VERIFY_ABS);
    fl_error_budget_free(&g), lab_free(&l);
}

int main(void)
{
    verify_begin("search for a step where none is sufficient");
    no_potential_search();
    spheres_in_cage();
    no_events();
    return verify_end();
}
