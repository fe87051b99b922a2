/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time steps chosen from an error budget (run.error): twenty scenes, each compared with itself at a
 * sixteenth of the step. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/pi.h"
#include "scene/scene_check.h"
#include "support/small_world.h"
#include "support/verify.h"
#include "sim/error_budget.h"
#include "sim/critical_step.h"
#include "sim/step.h"
#include "world/access.h"

/* --- the scenes --------------------------------------------------------------------------------------- */

static const fl_vec3 NONE = {0, 0, 0};

static void floe(lab *l, fl_vec3 x, double half, double turn, fl_vec3 v)
{
    lab_box(l, x, v3(half, half, 0.3), 0.05, q_about_axis(2, turn), v, NONE);
}

static void plate(lab *l) { lab_wall(l, v3(-4, -4, -1), v3(4, 4, 0), 1); }
static void post(lab *l, double x, double y, double r)
{
    lab_cone(l, (fl_cone){v3(x, y, -3), v3(x, y, 3), r, r});
}
static void slope(lab *l, double x, double y) { lab_cone(l, (fl_cone){v3(x, y, -2), v3(x, y, 2), 2.0, 0.5}); }

static void dry(lab *l, double friction, double restitution)
{
    lab_setf(l, "contact.friction=%g", friction);
    lab_setf(l, "contact.restitution=%g", restitution);
}

static void heavy(lab *l, double friction, double restitution)
{
    dry(l, friction, restitution);
    lab_set(l, "run.gravity=9.81");
    plate(l);
}

static void wet(lab *l, double speed, double friction, double restitution)
{
    dry(l, friction, restitution);
    lab_set(l, "run.gravity=9.81");
    lab_setf(l, "water.current=%g 0 0", speed);
}

static void ball_drops(lab *l) { heavy(l, 0, 1), lab_sphere(l, v3(0, 0, 0.54), 0.5, v3(0, 0, -0.3), NONE); }
static void ball_drops_dead(lab *l)
{
    heavy(l, 0.3, 0.3), lab_sphere(l, v3(0, 0, 0.55), 0.5, v3(0.5, 0, -0.3), NONE);
}
static void box_drops_flat(lab *l) { heavy(l, 0.3, 0.5), floe(l, v3(0, 0, 0.33), 0.8, 0, v3(0, 0, -0.2)); }
static void box_drops_on_edge(lab *l)
{
    heavy(l, 0.3, 0.4);
    lab_box(l, v3(0, 0, 0.7), v3(0.5, 0.6, 0.3), 0.05, q_of_vector(v3(0, 0.5, 0.1)), v3(0.2, 0, -0.5), NONE);
}
static void box_slides(lab *l) { heavy(l, 0.2, 0.3), floe(l, v3(-1, 0, 0.3), 0.8, 0.2, v3(0.6, 0.1, 0)); }
static void ball_rolls(lab *l)
{
    heavy(l, 0.2, 0.3), lab_sphere(l, v3(-1, 0, 0.5), 0.5, v3(0.8, 0, 0), v3(0, 0, 1));
}
static void head_on(lab *l) { dry(l, 0, 1), post(l, 2, 0, 1), floe(l, v3(-0.13, 0, 0), 1, 0, v3(1, 0, 0)); }
static void off_centre(lab *l)
{
    dry(l, 0.3, 0.3), post(l, 2, 0.5, 1), floe(l, v3(-0.1, 0, 0), 1, 0.3, v3(1, 0.1, 0));
}
static void two_in_line(lab *l)
{
    dry(l, 0.2, 0.6), lab_wall(l, v3(2, -4, -2), v3(3, 4, 2), 1);
    floe(l, v3(0.92, 0, 0), 1, 0, NONE), floe(l, v3(-1.2, 0.2, 0), 1, 0, v3(0.8, 0, 0));
}
static void three_in_line(lab *l)
{
    dry(l, 0, 0.8), post(l, 2, 0, 0.9);
    for (int k = 0; k < 3; k++) floe(l, v3(-2.1 * k, 0.1 * k, 0), 1, 0.05 * k, v3(k == 2 ? 1.5 : 0, 0, 0));
}
static void against_slope(lab *l)
{
    dry(l, 0.1, 0.4), slope(l, 2, 0.2), floe(l, v3(-0.6, 0, 0), 0.9, 0.4, v3(0.8, 0, 0));
}
static void hook(lab *l)
{
    const fl_vec3 xy[6] = {v3(0, 0, 0), v3(3, 0, 0), v3(3, 1, 0), v3(1, 1, 0), v3(1, 3, 0), v3(0, 3, 0)};
    lab_prism(l, 6, xy, -2, 2);
}
static void corner_in_hook(lab *l)
{
    dry(l, 0.3, 0.3), hook(l), floe(l, v3(2.03, 2.12, 0), 0.8, 0.3, v3(-0.5, -0.6, 0));
}
static void ball_in_hook(lab *l)
{
    dry(l, 0.1, 0.7), hook(l), lab_sphere(l, v3(1.7, 1.9, 0), 0.6, v3(-0.7, -1.0, 0), NONE);
}
static void balls_on_slope(lab *l)
{
    dry(l, 0.1, 0.9), slope(l, 2.5, 0);
    lab_sphere(l, v3(0.3, 0.5, 0), 0.5, v3(1, 0, 0), NONE),
        lab_sphere(l, v3(0.2, -0.6, 0.3), 0.5, v3(1.2, 0, 0), NONE);
}
static void pinched(lab *l)
{
    dry(l, 0.3, 0.2), post(l, 2, 1.5, 0.8), post(l, 2, -1.5, 0.8);
    floe(l, v3(0.7, 0.02, 0), 1, 0.785, v3(1, 0, 0));
}
static void pressed(lab *l)
{
    wet(l, 1, 0.1, 0.3), post(l, 2, 0, 1), floe(l, v3(-0.22, 0.1, -0.02), 1, 0.2, v3(0.3, 0, 0));
}
static void pressed_flat(lab *l)
{
    wet(l, 0.8, 0.3, 0.3), lab_wall(l, v3(1, -4, -2), v3(2, 4, 2), 1);
    floe(l, v3(-0.22, 0, -0.03), 1.2, 0.02, v3(0.4, 0, 0));
}
static void four_on_slope(lab *l)
{
    wet(l, 0.8, 0.1, 0.3), slope(l, 3, 0);
    for (int k = 0; k < 4; k++)
        floe(l, v3(0.7 - 1.9 * (k / 2), 0.95 - 1.9 * (k % 2), -0.03), 0.9, 0.02 * k, v3(0.6, 0, 0));
}
static void two_legs(lab *l)
{
    wet(l, 1, 0.2, 0.5), post(l, 2, 1, 0.5), post(l, 2, -1, 0.5);
    floe(l, v3(0, 0.1, -0.03), 1.4, 0.1, v3(0.8, 0.1, 0));
}
static void field(lab *l)
{
    wet(l, 1, 0.2, 0.3), post(l, 3, 0.1, 0.8);
    lab_set(l, "boundary.min=none -3.1 none"), lab_set(l, "boundary.max=none 3.1 none");
    for (int k = 0; k < 9; k++)
        floe(l, v3(1.1 - 2.05 * (k / 3), 2.05 * (k % 3 - 1), -0.03), 0.95, 0.04 * (k % 4), v3(0.7, 0, 0));
}

typedef struct {
    const char *name;
    void (*build)(lab *l);
    double seconds;
} scene;

static const scene SCENE[] = {
    {"a ball drops, elastic", ball_drops, 0.4}, {"a ball drops and slips", ball_drops_dead, 0.4},
    {"a box drops flat", box_drops_flat, 0.4},  {"a box drops on its edge", box_drops_on_edge, 0.5},
    {"a box slides", box_slides, 0.4},          {"a ball slips and rolls", ball_rolls, 0.4},
    {"head on, elastic", head_on, 0.4},         {"off the centre", off_centre, 0.4},
    {"two in line, a wall", two_in_line, 0.6},  {"three in line, a post", three_in_line, 0.6},
    {"against a slope", against_slope, 0.6},    {"a corner in a hook", corner_in_hook, 0.6},
    {"a ball in a hook", ball_in_hook, 0.6},    {"two balls, a slope", balls_on_slope, 0.6},
    {"between two posts", pinched, 0.6},        {"current, a post", pressed, 0.6},
    {"current, a wall", pressed_flat, 0.6},     {"current, four floes, a slope", four_on_slope, 0.5},
    {"current, two legs", two_legs, 0.6},       {"current, nine floes, a post", field, 0.5}};
enum { SCENES = sizeof SCENE / sizeof *SCENE, PARTS = 2 };

/* --- a run -------------------------------------------------------------------------------------------- */

static const double EVERY = 0.02;

typedef struct {
    fl_vec3 J[PARTS];
    double peak[PARTS];
    double spent; /* trial steps over steps of the run */
    double shortest, estimate;
    double whole, since; /* results of the companion run */
    int32_t least;
} result;

/* One row of output in the steps of the budget, with the companion run. */
static int row_of(lab *l, fl_error_budget *g, result *r)
{
    fl_err err = {0};
    const int64_t m = lround(EVERY / l->w.dt);
    for (int64_t k = 0; k < m; k++) {
        if (lab_run(l, 1)) return -1;
        if (fl_error_budget_follow(g, &l->w, &err)) exit(1);
    }
    for (int32_t p = 0; p < l->w.parts; p++) {
        r->J[p] = v3_add(r->J[p], l->w.part_impulse[p]);
        r->peak[p] = fmax(r->peak[p], l->w.part_peak[p]);
        l->w.part_impulse[p] = l->w.part_moment[p] = v3(0, 0, 0);
        l->w.part_peak[p] = 0.0;
    }
    return 0;
}

/* With m steps per row; m = 0: with the steps that the budget chooses. */
static result run(const scene *s, double goal, const char *of, int64_t m)
{
    lab l;
    fl_error_budget g = {0};
    fl_err err = {0};
    result r = {0};
    lab_start(&l);
    lab_set(&l, "contact.stiffness_factor=0.1");
    lab_setf(&l, "output.loads_every=%.17g", EVERY);
    if (m == 0) lab_setf(&l, "run.error=%.17g", goal), lab_setf(&l, "run.error_of=%s", of);
    lab_setf(&l, "run.duration=%g", s->seconds);
    s->build(&l);
    if (m == 0) {
        lab_set(&l, "structure.file=lab"); /* the same options as lab_make() sets */
        if (fl_scene_check(&l.scene, &err) ||
            fl_error_budget_make(&g, &l.scene, &l.field, &l.field, &l.surface, NULL, &err))
            exit(1);
        r.least = (int32_t)lround(g.row_interval / fl_error_budget_first_step(&g));
    }
    lab_make(&l, m ? EVERY / (double)m : fl_error_budget_first_step(&g));
    for (int64_t row = 0; row < (int64_t)lround(s->seconds / EVERY); row++) {
        if (m == 0 && fl_error_budget_update(&g, &l.w, row, &err)) exit(1);
        if (m == 0 ? row_of(&l, &g, &r) : lab_run(&l, m)) break;
    }
    for (int32_t p = 0; m && p < l.w.parts; p++) r.J[p] = l.w.part_impulse[p], r.peak[p] = l.w.part_peak[p];
    if (m == 0) {
        double apart;
        r.whole = fl_error_budget_run_error(&g, &apart);
        r.since = g.companion.exceeded_since;
        r.spent = (double)g.trial_steps / (double)l.w.step;
        r.shortest = g.min_dt;
        r.estimate = fl_error_budget_estimate(&g, l.w.dt);
    }
    fl_error_budget_free(&g);
    lab_free(&l);
    return r;
}

static double error_of(const char *of, const result *a, const result *truth)
{
    double off = 0.0, size = 0.0;
    const int peak = strcmp(of, "peak") == 0;
    for (int p = 0; p < PARTS; p++) {
        const double d = peak ? fabs(a->peak[p] - truth->peak[p]) : v3_norm(v3_sub(a->J[p], truth->J[p]));
        const double all = peak ? truth->peak[p] : v3_norm(truth->J[p]);
        off = peak ? fmax(off, d) : off + d;
        size = peak ? fmax(size, all) : size + all;
    }
    return off / size;
}

/* One scene.  Returns bits: 1 the error is within the budget, 2 the step is long enough, 4 the companion
 * run doubts the result. */
static int verify_scene(const scene *s, double goal, const char *of)
{
    const result chosen = run(s, goal, of, 0);
    const int64_t m = lround(EVERY / chosen.shortest);
    const result truth = run(s, goal, of, 16 * m);
    const double e = error_of(of, &chosen, &truth);
    /* The largest sufficient step: from the finest upwards, the last one before one that fails. */
    int64_t best = 4 * m;
    for (double k = 4.0 * (double)m; k > 0.999 * chosen.least; k /= sqrt(sqrt(2.0))) {
        const int64_t mk = lround(k);
        const result it = run(s, goal, of, mk);
        if (error_of(of, &it, &truth) > goal) break;
        best = mk;
    }
    const double share = (double)best / (double)m;
    verify_note("%-30s step %8.3g s  estimate %7.2g  whole run %7.2g  true %7.2g  over the largest %5.2f  "
                "cost %5.2f %s%s%s",
                s->name, chosen.shortest, chosen.estimate, chosen.whole, e, share, chosen.spent,
                e <= goal ? "" : " OVER", share >= 0.5 ? "" : " SHORT", m == chosen.least ? " (cap)" : "");
    return (e <= goal) | (share >= 0.5) << 1 | (chosen.since >= 0.0) << 2;
}

/* Floes crowd between two walls about a post.  The error grows from collision to collision, which the
 * windows of the step search do not see. */
static void crowded_floes(void)
{
    const scene s = {"a crowd", field, 8.0};
    const double goal = 1e-3;
    const result chosen = run(&s, goal, "impulse", 0);
    const int64_t m = lround(EVERY / chosen.shortest);
    const result truth = run(&s, goal, "impulse", 8 * m), half = run(&s, goal, "impulse", 4 * m);
    const double e = error_of("impulse", &chosen, &truth);
    verify_note("nine floes for %g s: estimate %7.2g  whole run %7.2g from %.3g s on  true %7.2g; 4 and 8 "
                "times as many steps are %7.2g apart",
                s.seconds, chosen.estimate, chosen.whole, chosen.since, e,
                error_of("impulse", &half, &truth));
    verify_row("E12", "error of the whole run, crowded, over the reported one, log2", log2(e / chosen.whole),
               0.0, 3.0, VERIFY_ABS);
    verify_true("E12", "the report says that it exceeds the budget", chosen.since >= 0.0);
}

/* --- the order ---------------------------------------------------------------------------------------- */

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Impulses with 48 and with 192 steps per row against 12288: damping and friction, sticking and sliding, in
 * contacts that begin and end.  At these steps the order is not yet hidden by the moment within a step at
 * which contacts begin.  A face that lands flat has errors of rounding only and is left out. */
static void order_of_impulse(void)
{
    double order[SCENES];
    double all = 0.0, all_then = 0.0;
    int n = 0;
    for (size_t k = 0; k < SCENES; k += verify_quick() ? 3 : 1) {
        const result truth = run(&SCENE[k], 0.01, "impulse", 12288),
                     coarse = run(&SCENE[k], 0.01, "impulse", 48),
                     fine = run(&SCENE[k], 0.01, "impulse", 192);
        const double at = error_of("impulse", &coarse, &truth), then = error_of("impulse", &fine, &truth);
        if (!(at > 1e-10)) continue;
        order[n++] = 0.5 * log2(at / then);
        all += at, all_then += then;
        verify_note("%-30s error %7.1e, and %7.1e with a quarter of the step: order %.2f", SCENE[k].name, at,
                    then, order[n - 1]);
    }
    qsort(order, (size_t)n, sizeof *order, by_value);
    verify_row("E10", "order of the impulse in the step, median of the scenes", order[n / 2], 2.0, 0.25,
               VERIFY_ABS);
    verify_row("E10", "order of the sum over all scenes", 0.5 * log2(all / all_then), 2.0, 0.4, VERIFY_ABS);
}

/* --- without a budget --------------------------------------------------------------------------------- */

/* The error that the report gives for the automatic step, at no cost, against steps of a sixteenth.
 * Returns bits: 1 the peak error is at most 1.6 times the reported one, 2 the impulse is within its bound.
 * share: true peak error over the reported one. */
static int verify_reported_error(const scene *s, double *share)
{
    result r[2] = {0};
    double peak = 0.0, impulse = 0.0;
    for (int fine = 0; fine < 2; fine++) {
        lab l;
        lab_start(&l);
        lab_set(&l, "contact.stiffness_factor=0.1");
        lab_setf(&l, "run.duration=%g", s->seconds);
        s->build(&l);
        lab_make(&l, 0);
        const int64_t m = (int64_t)ceil(s->seconds / l.w.dt) * (fine ? 16 : 1);
        fl_step_set_size(&l.w, s->seconds / (double)m, 0.0);
        if (lab_run(&l, m)) exit(1);
        for (int32_t p = 0; p < l.w.parts; p++)
            r[fine].J[p] = l.w.part_impulse[p], r[fine].peak[p] = l.w.part_peak[p];
        if (!fine) peak = fl_peak_error(&l.w), impulse = fl_impulse_error(&l.w);
        lab_free(&l);
    }
    const double is = error_of("peak", &r[0], &r[1]), was = error_of("impulse", &r[0], &r[1]);
    verify_note("%-30s peak: reported %7.2g  true %7.2g   impulse: reported %7.2g  true %7.2g", s->name, peak,
                is, impulse, was);
    *share = is / peak;
    return (is <= 1.6 * peak) | (was <= impulse) << 1;
}

/* n by n bonded floes or spheres of half width `half` that run into the structure at x = 0.  No bond
 * breaks: the moment of breaking, and all that follows, depends on the step. */
static void bonded_sheet(lab *l, int n, double half, int round)
{
    fl_err err = {0};
    lab_set(l, "bond.on=true");
    lab_set(l, "bond.normal_strength=none"), lab_set(l, "bond.shear_strength=none");
    for (int k = 0; k < n * n; k++) {
        const fl_vec3 x = v3(-0.85 - (2 * (k / n) + 1) * half, (2 * (k % n) + 1 - n) * half, 0);
        if (round) lab_sphere(l, x, half, v3(0.5, 0, 0), NONE);
        else lab_box(l, x, v3(half, half, 0.3), 0.05, q_one(), v3(0.5, 0, 0), NONE);
    }
    const double area = round ? 0.25 * PI * half * half : 1.2 * half;
    for (int k = 0; k < n * n; k++) {
        const double x = -0.85 - (2 * (k / n) + 1) * half, y = (2 * (k % n) + 1 - n) * half;
        if ((k % n < n - 1 &&
             fl_ice_field_add_bond(&l->field, k, k + 1, area, 2 * half, v3(x, y + half, 0), &err)) ||
            (k / n < n - 1 &&
             fl_ice_field_add_bond(&l->field, k, k + n, area, 2 * half, v3(x - half, y, 0), &err)))
            exit(1);
    }
}
static void sheet_at_post(lab *l) { dry(l, 0.3, 0.3), post(l, 0, 0.1, 0.8), bonded_sheet(l, 4, 0.5, 0); }
static void sheet_at_post_damped(lab *l) { sheet_at_post(l), lab_set(l, "bond.damping=0.3"); }
static void sheet_at_post_elastic(lab *l) { dry(l, 0, 1), post(l, 0, 0.1, 0.8), bonded_sheet(l, 4, 0.5, 0); }
static void sheet_at_post_soft(lab *l) { sheet_at_post(l), lab_set(l, "bond.young=10 MPa"); }
static void balls_at_post(lab *l) { dry(l, 0.3, 0.3), post(l, 0, 0.1, 0.8), bonded_sheet(l, 6, 0.3, 1); }
static void balls_at_post_dead(lab *l)
{
    dry(l, 0.3, 0.05), post(l, 0, 0.1, 0.8), bonded_sheet(l, 6, 0.3, 1);
}
static void balls_at_post_damped(lab *l) { balls_at_post(l), lab_set(l, "bond.damping=0.1"); }
static void balls_at_slope(lab *l) { dry(l, 0.1, 0.5), slope(l, 0.8, 0.1), bonded_sheet(l, 6, 0.3, 1); }
static void balls_by_core(lab *l) { balls_at_post(l), lab_set(l, "contact.law=core"); }
enum { SHEETS = 9 };
static const scene BONDED[SHEETS] = {
    {"a sheet hits a post", sheet_at_post, 0.8},
    {"with damped bonds", sheet_at_post_damped, 0.8},
    {"without damping", sheet_at_post_elastic, 0.8},
    {"with soft bonds", sheet_at_post_soft, 0.8},
    {"one of balls", balls_at_post, 0.8},
    {"without restitution", balls_at_post_dead, 0.8},
    {"with damped bonds", balls_at_post_damped, 0.8},
    {"against a slope", balls_at_slope, 0.8},
    {"under core", balls_by_core, 0.8},
};

/* As report_of_automatic_step(), where bonds are much stiffer than contacts and set the step. */
static void report_with_bonds(void)
{
    double share[SHEETS];
    int n = 0, worse = 0, over = 0;
    for (size_t k = 0; k < SHEETS; k += verify_quick() ? 2 : 1, n++) {
        const int ok = verify_reported_error(&BONDED[k], &share[n]);
        worse += !(ok & 1), over += !(ok & 2);
    }
    qsort(share, (size_t)n, sizeof *share, by_value);
    verify_row("E05", "bonded: peak errors above 1.6 times the reported one", worse, 0, 0, VERIFY_ABS);
    verify_below("E05", "reported over true peak error, median", 1.0 / share[n / 2], 20.0);
    verify_row("E05", "impulse errors above the reported one", over, 0, 0, VERIFY_ABS);
}

static void report_of_automatic_step(void)
{
    double share[SCENES];
    int n = 0, worse = 0, over = 0;
    verify_note("reported error of the automatic step");
    for (size_t k = 0; k < SCENES; k += verify_quick() ? 4 : 1, n++) {
        const int ok = verify_reported_error(&SCENE[k], &share[n]);
        worse += !(ok & 1), over += !(ok & 2);
    }
    qsort(share, (size_t)n, sizeof *share, by_value);
    verify_row("E05", "peak errors above 1.6 times the reported one", worse, 0, 0, VERIFY_ABS);
    verify_below("E05", "reported over true peak error, median", 1.0 / share[n / 2], 20.0);
    verify_row("E05", "impulse errors above the reported one", over, 0, 0, VERIFY_ABS);
}

/* --- horizon of prediction ---------------------------------------------------------------------------- */

/* Elastic square floes that collide about a post between walls: neighbouring trajectories diverge. */
static void billiards(lab *l)
{
    dry(l, 0, 1), post(l, 0, 0, 0.7);
    lab_set(l, "boundary.min=-4.2 -4.2 none"), lab_set(l, "boundary.max=4.2 4.2 none");
    for (int k = 0; k < 9; k++)
        if (k != 4)
            floe(l, v3(2.6 * (k % 3 - 1), 2.6 * (k / 3 - 1), 0), 0.9, 0.2 * k,
                 v3(2.0 - 0.7 * (k % 4), 1.5 - 0.9 * (k % 3), 0));
}

static void make_billiards(lab *l, int neighbour, double seconds, double error)
{
    lab_start(l);
    lab_setf(l, "contact.stiffness_factor=%g", 0.01 * (1.0 + 0.02 * neighbour));
    lab_setf(l, "output.loads_every=%.17g", EVERY);
    lab_setf(l, "run.duration=%g", seconds);
    if (error > 0.0) lab_setf(l, "run.error=%g", error);
    billiards(l);
}

/* --- contacts of little effect, and interrupted searches ---------------------------------------------- */

/* Two floes that graze one another at 0.1 mm/s, beside one that tumbles through the water: a world at t = 0
 * and its error budget. */
static void make_grazing_floes(lab *l, fl_error_budget *g)
{
    fl_err err = {0};
    lab_start(l);
    lab_set(l, "output.loads_every=0.1"), lab_set(l, "run.duration=2"), lab_set(l, "run.error=0.01");
    lab_set(l, "run.gravity=9.81"), lab_set(l, "water.drag=facet");
    lab_set(l, "material.ice.young=2e7");
    post(l, 30, 0, 1);
    for (int k = 0; k < 2; k++)
        lab_box(l, v3(1.100001 * k, 0, 0), v3(0.55, 0.55, 0.25), 0.05, q_about_axis(2, 0),
                v3(k ? 0 : 1e-4, 0, 0), NONE);
    lab_box(l, v3(0, 6, 1), v3(0.55, 0.55, 0.25), 0.05, q_about_axis(2, 0), v3(1, 0, 0), v3(0.7, 0.3, 0.2));
    lab_set(l, "structure.file=lab");
    if (fl_scene_check(&l->scene, &err) ||
        fl_error_budget_make(g, &l->scene, &l->field, &l->field, &l->surface, NULL, &err))
        exit(1);
    lab_make(l, fl_error_budget_first_step(g));
}

/* The error of the tumbling floe must not be taken for that of the grazing contact; it made the step 100
 * times shorter. */
static void error_of_grazing_contact(void)
{
    lab l;
    fl_error_budget g = {0};
    fl_err err = {0};
    make_grazing_floes(&l, &g);
    for (int64_t row = 0; row < 20; row++) {
        if (fl_error_budget_update(&g, &l.w, row, &err)) exit(1);
        if (lab_run(&l, lround(0.1 / l.w.dt))) exit(1);
    }
    verify_true("E08", "the floes touch", l.w.impulse_sum > 0.0);
    verify_below("E08", "trial steps over steps of a run at the largest step, grazing floes",
                 (double)g.trial_steps / (2.0 / fl_error_budget_first_step(&g)), 20.0);
    verify_row("E08", "shortest step over the largest allowed one", g.min_dt / fl_error_budget_first_step(&g),
               1.0, 0.5, VERIFY_ABS);
    fl_error_budget_free(&g), lab_free(&l);
}

/* The state of the budget and the current step, as text that the caller frees. */
static char *full_state(const fl_error_budget *g, const fl_world *w)
{
    char *text = NULL;
    size_t n;
    FILE *f = open_memstream(&text, &n);
    if (!f) exit(1);
    fl_error_budget_write(f, g);
    fprintf(f, "%a\n", w->dt);
    if (fclose(f)) exit(1);
    return text;
}

/* Step searches that are interrupted and repeated, against searches that are not.  The first is interrupted
 * in its second trial, after it has begun a window, the others at once. */
static void interrupted_searches(void)
{
    volatile sig_atomic_t stop = 1;
    lab l[2];
    fl_error_budget g[2] = {{0}};
    fl_err err = {0};
    char *text[2];
    int kept = 1;
    for (int k = 0; k < 2; k++) make_grazing_floes(&l[k], &g[k]);
    for (int64_t row = 0; row < 20; row++) {
        for (int k = 0; k < 2; k++) {
            stop = 1;
            if (k) {
                g[k].stop = row ? &stop : &g[k].windows;
                char *before = full_state(&g[k], &l[k].w);
                if (fl_error_budget_update(&g[k], &l[k].w, row, &err)) exit(1);
                char *after = full_state(&g[k], &l[k].w);
                kept &= strcmp(before, after) == 0;
                free(before), free(after);
            }
            stop = 0;
            g[k].stop = &stop;
            if (fl_error_budget_update(&g[k], &l[k].w, row, &err)) exit(1);
            text[k] = full_state(&g[k], &l[k].w);
            if (lab_run(&l[k], lround(0.1 / l[k].w.dt))) exit(1);
        }
        kept &= strcmp(text[0], text[1]) == 0;
        free(text[0]), free(text[1]);
    }
    verify_true("E09", "there were trials to interrupt", g[0].trial_steps > 0);
    verify_true("E09", "interrupted searches leave the state as it was", kept);
    for (int k = 0; k < 2; k++) fl_error_budget_free(&g[k]), lab_free(&l[k]);
}

/* Root mean square distance of the floes of two worlds. */
static double distance(const fl_world *a, const fl_world *b)
{
    double sum = 0.0;
    for (int32_t i = 0; i < a->n; i++) sum += v3_norm2(v3_sub(a->b.x[i], b->b.x[i]));
    return sqrt(sum / a->n);
}

/* Time until two runs that differ slightly at `from` are `far` apart. */
static double separation_time(int neighbour, double from, double seconds, double dt, double far)
{
    lab a, b;
    double t = 0.0;
    make_billiards(&a, neighbour, seconds, 0.0), make_billiards(&b, neighbour, seconds, 0.0);
    lab_make(&a, dt), lab_make(&b, dt);
    if (lab_run(&a, (int64_t)(from / dt)) || lab_run(&b, (int64_t)(from / dt))) exit(1);
    for (int32_t i = 0; i < b.w.n; i++) b.w.b.x[i].x = nextafter(b.w.b.x[i].x, INFINITY);
    while (t < seconds && distance(&a.w, &b.w) < far) {
        if (lab_run(&a, 16) || lab_run(&b, 16)) break;
        t = fl_world_time(&a.w) - from;
    }
    lab_free(&a), lab_free(&b);
    return t;
}

/* The horizon that a run reports; its budget stays in g. */
static double reported_horizon(fl_error_budget *g, int neighbour, double seconds, double goal)
{
    lab l;
    fl_err err = {0};
    make_billiards(&l, neighbour, seconds, goal);
    lab_set(&l, "structure.file=lab");
    if (fl_scene_check(&l.scene, &err) ||
        fl_error_budget_make(g, &l.scene, &l.field, &l.field, &l.surface, NULL, &err))
        exit(1);
    lab_make(&l, fl_error_budget_first_step(g));
    for (int64_t row = 0; row < (int64_t)lround(seconds / EVERY); row++) {
        if (fl_error_budget_update(g, &l.w, row, &err)) exit(1);
        if (lab_run(&l, (int64_t)lround(EVERY / l.w.dt))) break;
    }
    verify_note("elastic floes about a post: divergence rate %.3g /s, horizon %.3g s, windows of %.3g s",
                g->divergence_rate, fl_error_budget_horizon(g), g->row_interval * g->window_rows);
    lab_free(&l);
    return fl_error_budget_horizon(g);
}

/* One run is one sample of the divergence, so the mean over several neighbouring runs is taken. */
static void horizon_of_prediction(void)
{
    const double goal = 0.01, seconds = verify_quick() ? 12.0 : 60.0;
    fl_error_budget g = {0};
    double horizon = 0.0, off = 0.0;
    const int many = verify_quick() ? 1 : 5;
    for (int k = 0; k < many; k++) {
        double found = 0.0;
        fl_error_budget_free(&g);
        const double one = reported_horizon(&g, k, seconds, goal);
        horizon += one / many;
        for (int start = 0; start < 2 && !verify_quick(); start++)
            found += 0.5 * separation_time(k, 0.5 * start * seconds, seconds,
                                           2.0 * fl_error_budget_first_step(&g) / 3.0, goal);
        if (verify_quick()) continue;
        verify_note("two runs that differ in the last bit are %g m apart after %.3g s in the mean", goal,
                    found);
        off += log2(one / found) / many;
    }
    if (!verify_quick())
        verify_row("E04", "log2 of reported over measured horizon, mean of five", off, 0.0, 1.0, VERIFY_ABS);
    verify_true("E04", "whole runs are reported as undetermined", horizon < 60.0);
    verify_below("E04", "length of windows times the divergence rate",
                 g.divergence_rate * g.row_interval * g.window_rows, 1.0);
    fl_error_budget_free(&g);
}

int main(void)
{
    static const struct {
        const char *id, *of;
        double goal;
        double over;     /* scenes that may exceed their budget */
        double short_of; /* steps that may be shorter than half of the largest sufficient one */
    } TABLE[] = {{"E01", "impulse", 0.01, 1, 1},
                 {"E02", "impulse", 0.003, 1, 1},
                 {"E03", "peak", 0.01, 1, 1},
                 {"E06", "impulse", 0.001, 1, 1},
                 {"E07", "impulse", 0.0005, 1, 1}};
    int vain = 0, tried = 0;
    verify_begin("a step from an error budget");
    for (size_t t = 0; t < sizeof TABLE / sizeof *TABLE; t++) {
        int within = 0, longest = 0, n = 0;
        verify_note("run.error = %g of the %s; (cap): limited by stability", TABLE[t].goal, TABLE[t].of);
        for (size_t k = 0; k < SCENES; k += verify_quick() ? 4 : 1) {
            const int ok = verify_scene(&SCENE[k], TABLE[t].goal, TABLE[t].of);
            within += ok & 1;
            longest += ok >> 1 & 1;
            vain += (ok & 5) == 5;
            tried++;
            n++;
        }
        verify_row(TABLE[t].id, "scenes within the budget, of all", within, n, TABLE[t].over, VERIFY_ABS);
        verify_row(TABLE[t].id, "steps of at least half the largest sufficient one", longest, n,
                   TABLE[t].short_of, VERIFY_ABS);
        if (verify_quick()) break;
    }
    verify_note("%d scenes of %d were within the budget, and the companion run doubted them", vain, tried);
    verify_row("E11", "percentage of scenes doubted without need", 100.0 * vain / tried, 0.0, 5.0,
               VERIFY_ABS);
    crowded_floes();
    order_of_impulse();
    error_of_grazing_contact();
    interrupted_searches();
    report_of_automatic_step();
    report_with_bonds();
    horizon_of_prediction();
    return verify_end();
}
