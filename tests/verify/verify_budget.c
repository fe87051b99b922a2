/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step chosen from an error budget: twenty scenes, each against itself at a sixteenth of the step. */
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

/* --- the scenes -------------------------------------------------------------------------------- */

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

/* --- a run ------------------------------------------------------------------------------------- */

static const double EVERY = 0.02;

typedef struct {
    fl_vec3 J[PARTS];
    double peak[PARTS];
    double spent; /* steps of trials over those of the run */
    double shortest, estimate;
    double whole, since; /* what the run beside it tells */
    int32_t least;
} result;

/* A row in the steps of the budget, and the run beside it. */
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

/* With m steps a row, or, m = 0, those that the budget chooses. */
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
        lab_set(&l, "structure.file=lab"); /* as lab_make() will */
        if (fl_scene_check(&l.scene, &err) ||
            fl_error_budget_make(&g, &l.scene, &l.field, &l.field, &l.surface, &err))
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

/* One scene: 1 bit within the budget, 2 bit the step is long enough, 4 bit the run beside it doubts that. */
static int try(const scene *s, double goal, const char *of)
{
    const result chosen = run(s, goal, of, 0);
    const int64_t m = lround(EVERY / chosen.shortest);
    const result truth = run(s, goal, of, 16 * m);
    const double e = error_of(of, &chosen, &truth);
    /* The largest step that would have done: from the finest upwards, the last before one that fails. */
    int64_t best = 4 * m;
    for (double k = 4.0 * (double)m; k > 0.999 * chosen.least; k /= sqrt(sqrt(2.0))) {
        const int64_t mk = lround(k);
        const result it = run(s, goal, of, mk);
        if (error_of(of, &it, &truth) > goal) break;
        best = mk;
    }
    const double share = (double)best / (double)m;
    verify_note("%-30s step %8.3g s  estimate %7.2g  as a whole %7.2g  true %7.2g  over the largest %5.2f  "
                "cost %5.2f %s%s%s",
                s->name, chosen.shortest, chosen.estimate, chosen.whole, e, share, chosen.spent,
                e <= goal ? "" : " OVER", share >= 0.5 ? "" : " SHORT", m == chosen.least ? " (cap)" : "");
    return (e <= goal) | (share >= 0.5) << 1 | (chosen.since >= 0.0) << 2;
}

/* Floes that crowd between two walls about a post: what a step is off by grows from hit to hit, which windows
 * do not see. */
static void crowd(void)
{
    const scene s = {"a crowd", field, verify_quick() ? 4.0 : 8.0};
    const double goal = 1e-3;
    const result chosen = run(&s, goal, "impulse", 0);
    const int64_t m = lround(EVERY / chosen.shortest);
    const result truth = run(&s, goal, "impulse", 8 * m), half = run(&s, goal, "impulse", 4 * m);
    const double e = error_of("impulse", &chosen, &truth);
    verify_note("nine floes for %g s: estimate %7.2g  as a whole %7.2g from %.3g s on  true %7.2g; 4 and 8 "
                "times as many steps are %7.2g apart",
                s.seconds, chosen.estimate, chosen.whole, chosen.since, e,
                error_of("impulse", &half, &truth));
    verify_row("E12", "error as a whole, of a crowd, over what is told, log2", log2(e / chosen.whole), 0.0,
               3.0, VERIFY_ABS);
    verify_true("E12", "it is told to be more than was asked for", chosen.since >= 0.0);
}

/* --- the order ----------------------------------------------------------------------------------- */

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Impulses with 48 and with 192 steps a row against 12288: damping and friction, sticking and sliding, in
 * contacts that begin and end, at steps for which they are not hidden yet by when in a step contacts begin.
 * What falls flat is off by rounding. */
static void orders(void)
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
        verify_note("%-30s off by %7.1e, and %7.1e with a quarter of the step: order %.2f", SCENE[k].name, at,
                    then, order[n - 1]);
    }
    qsort(order, (size_t)n, sizeof *order, compare);
    verify_row("E10", "order of the impulse in the step, median of the scenes", order[n / 2], 2.0, 0.25,
               VERIFY_ABS);
    verify_row("E10", "order of the sum of all", 0.5 * log2(all / all_then), 2.0, 0.4, VERIFY_ABS);
}

/* --- without a budget -------------------------------------------------------------------------- */

/* What is told of the automatic step, which costs nothing, against steps of a sixteenth: 1 bit the peak is no
 * worse than 1.6 times it, 2 bit the impulse is within its bound; share: of the peak's error in what is told.
 */
static int told(const scene *s, double *share)
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
    verify_note("%-30s peak: told %7.2g  true %7.2g   impulse: told %7.2g  true %7.2g", s->name, peak, is,
                impulse, was);
    *share = is / peak;
    return (is <= 1.6 * peak) | (was <= impulse) << 1;
}

/* n by n floes or balls, a half wide, frozen together, that run into what stands at x = 0.  No bond ends: by
 * the size of a step nobody can say when, and what comes of that. */
static void sheet(lab *l, int n, double half, int round)
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
static void sheet_at_post(lab *l) { dry(l, 0.3, 0.3), post(l, 0, 0.1, 0.8), sheet(l, 4, 0.5, 0); }
static void sheet_at_post_damped(lab *l) { sheet_at_post(l), lab_set(l, "bond.damping=0.3"); }
static void sheet_at_post_elastic(lab *l) { dry(l, 0, 1), post(l, 0, 0.1, 0.8), sheet(l, 4, 0.5, 0); }
static void sheet_at_post_soft(lab *l) { sheet_at_post(l), lab_set(l, "bond.young=10 MPa"); }
static void balls_at_post(lab *l) { dry(l, 0.3, 0.3), post(l, 0, 0.1, 0.8), sheet(l, 6, 0.3, 1); }
static void balls_at_post_dead(lab *l) { dry(l, 0.3, 0.05), post(l, 0, 0.1, 0.8), sheet(l, 6, 0.3, 1); }
static void balls_at_post_damped(lab *l) { balls_at_post(l), lab_set(l, "bond.damping=0.1"); }
static void balls_at_slope(lab *l) { dry(l, 0.1, 0.5), slope(l, 0.8, 0.1), sheet(l, 6, 0.3, 1); }
static void balls_by_core(lab *l) { balls_at_post(l), lab_set(l, "contact.law=core"); }
enum { SHEETS = 9 };
static const scene FROZEN[SHEETS] = {
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

/* As without(), where bonds are much stiffer than contacts, and set the step. */
static void without_bonds_ending(void)
{
    double share[SHEETS];
    int n = 0, worse = 0, over = 0;
    for (size_t k = 0; k < SHEETS; k += verify_quick() ? 2 : 1, n++) {
        const int ok = told(&FROZEN[k], &share[n]);
        worse += !(ok & 1), over += !(ok & 2);
    }
    qsort(share, (size_t)n, sizeof *share, compare);
    verify_row("E05", "frozen together: peaks off by more than 1.6 of what is told", worse, 0, 0, VERIFY_ABS);
    verify_below("E05", "what is told over what peaks are off by, median", 1.0 / share[n / 2], 20.0);
    verify_row("E05", "impulses off by more than what is told", over, 0, 0, VERIFY_ABS);
}

static void without(void)
{
    double share[SCENES];
    int n = 0, worse = 0, over = 0;
    verify_note("what the report tells of the automatic step");
    for (size_t k = 0; k < SCENES; k += verify_quick() ? 4 : 1, n++) {
        const int ok = told(&SCENE[k], &share[n]);
        worse += !(ok & 1), over += !(ok & 2);
    }
    qsort(share, (size_t)n, sizeof *share, compare);
    verify_row("E05", "peaks off by more than 1.6 of what is told", worse, 0, 0, VERIFY_ABS);
    verify_below("E05", "what is told over what peaks are off by, median", 1.0 / share[n / 2], 20.0);
    verify_row("E05", "impulses off by more than what is told", over, 0, 0, VERIFY_ABS);
}

/* --- how far ahead a state tells anything ------------------------------------------------------ */

/* Square floes that fly about a post between walls, elastic: what is near parts. */
static void billiards(lab *l)
{
    dry(l, 0, 1), post(l, 0, 0, 0.7);
    lab_set(l, "boundary.min=-4.2 -4.2 none"), lab_set(l, "boundary.max=4.2 4.2 none");
    for (int k = 0; k < 9; k++)
        if (k != 4)
            floe(l, v3(2.6 * (k % 3 - 1), 2.6 * (k / 3 - 1), 0), 0.9, 0.2 * k,
                 v3(2.0 - 0.7 * (k % 4), 1.5 - 0.9 * (k % 3), 0));
}

static void billiards_made(lab *l, int neighbour, double seconds, double error)
{
    lab_start(l);
    lab_setf(l, "contact.stiffness_factor=%g", 0.01 * (1.0 + 0.02 * neighbour));
    lab_setf(l, "output.loads_every=%.17g", EVERY);
    lab_setf(l, "run.duration=%g", seconds);
    if (error > 0.0) lab_setf(l, "run.error=%g", error);
    billiards(l);
}

/* --- touches that hardly matter, and looks broken off ------------------------------------------ */

/* Two floes that graze one another at 0.1 mm/s, beside one that tumbles through the water; a world and what
 * looks after its step, at t = 0. */
static void grazed_made(lab *l, fl_error_budget *g)
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
        fl_error_budget_make(g, &l->scene, &l->field, &l->field, &l->surface, &err))
        exit(1);
    lab_make(l, fl_error_budget_first_step(g));
}

/* What the tumbling one is off by is no error of the touch: the step was 100 times shorter for it. */
static void grazed(void)
{
    lab l;
    fl_error_budget g = {0};
    fl_err err = {0};
    grazed_made(&l, &g);
    for (int64_t row = 0; row < 20; row++) {
        if (fl_error_budget_update(&g, &l.w, row, &err)) exit(1);
        if (lab_run(&l, lround(0.1 / l.w.dt))) exit(1);
    }
    verify_true("E08", "the floes touch", l.w.impulse_sum > 0.0);
    verify_below("E08", "steps of trials over those of a run with the largest step, floes that graze",
                 (double)g.trial_steps / (2.0 / fl_error_budget_first_step(&g)), 20.0);
    verify_row("E08", "shortest step over the largest there may be",
               g.min_dt / fl_error_budget_first_step(&g), 1.0, 0.5, VERIFY_ABS);
    fl_error_budget_free(&g), lab_free(&l);
}

/* What a budget remembers and the step that is taken: to be freed. */
static char *all_of(const fl_error_budget *g, const fl_world *w)
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

/* Looks that are broken off and made again, and looks that are not.  The first is broken off in its second
 * trial, when it has begun a window, the others at once. */
static void broken_off(void)
{
    volatile sig_atomic_t stop = 1;
    lab l[2];
    fl_error_budget g[2] = {{0}};
    fl_err err = {0};
    char *text[2];
    int kept = 1;
    for (int k = 0; k < 2; k++) grazed_made(&l[k], &g[k]);
    for (int64_t row = 0; row < 20; row++) {
        for (int k = 0; k < 2; k++) {
            stop = 1;
            if (k) {
                g[k].stop = row ? &stop : &g[k].windows;
                char *before = all_of(&g[k], &l[k].w);
                if (fl_error_budget_update(&g[k], &l[k].w, row, &err)) exit(1);
                char *after = all_of(&g[k], &l[k].w);
                kept &= strcmp(before, after) == 0;
                free(before), free(after);
            }
            stop = 0;
            g[k].stop = &stop;
            if (fl_error_budget_update(&g[k], &l[k].w, row, &err)) exit(1);
            text[k] = all_of(&g[k], &l[k].w);
            if (lab_run(&l[k], lround(0.1 / l[k].w.dt))) exit(1);
        }
        kept &= strcmp(text[0], text[1]) == 0;
        free(text[0]), free(text[1]);
    }
    verify_true("E09", "trials were made, or nothing could be broken off", g[0].trial_steps > 0);
    verify_true("E09", "looks that are broken off leave nothing behind, and can be made again", kept);
    for (int k = 0; k < 2; k++) fl_error_budget_free(&g[k]), lab_free(&l[k]);
}

/* Root of the mean square distance of the floes of two worlds. */
static double distance(const fl_world *a, const fl_world *b)
{
    double sum = 0.0;
    for (int32_t i = 0; i < a->n; i++) sum += v3_norm2(v3_sub(a->b.x[i], b->b.x[i]));
    return sqrt(sum / a->n);
}

/* How long two runs that are a bit apart at `from` take until they are `far` from one another. */
static double parted(int neighbour, double from, double seconds, double dt, double far)
{
    lab a, b;
    double t = 0.0;
    billiards_made(&a, neighbour, seconds, 0.0), billiards_made(&b, neighbour, seconds, 0.0);
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

/* What a run tells of itself, which stays in g. */
static double told_horizon(fl_error_budget *g, int neighbour, double seconds, double goal)
{
    lab l;
    fl_err err = {0};
    billiards_made(&l, neighbour, seconds, goal);
    lab_set(&l, "structure.file=lab");
    if (fl_scene_check(&l.scene, &err) ||
        fl_error_budget_make(g, &l.scene, &l.field, &l.field, &l.surface, &err))
        exit(1);
    lab_make(&l, fl_error_budget_first_step(g));
    for (int64_t row = 0; row < (int64_t)lround(seconds / EVERY); row++) {
        if (fl_error_budget_update(g, &l.w, row, &err)) exit(1);
        if (lab_run(&l, (int64_t)lround(EVERY / l.w.dt))) break;
    }
    verify_note("elastic floes about a post: states part at %.3g /s, horizon %.3g s, windows of %.3g s",
                g->divergence_rate, fl_error_budget_horizon(g), g->row_interval * g->window_rows);
    lab_free(&l);
    return fl_error_budget_horizon(g);
}

/* One run is one sample of how states part: so the mean of several that are hardly different. */
static void parting(void)
{
    const double goal = 0.01, seconds = verify_quick() ? 12.0 : 60.0;
    fl_error_budget g = {0};
    double horizon = 0.0, off = 0.0;
    const int many = verify_quick() ? 1 : 5;
    for (int k = 0; k < many; k++) {
        double found = 0.0;
        fl_error_budget_free(&g);
        const double one = told_horizon(&g, k, seconds, goal);
        horizon += one / many;
        for (int start = 0; start < 2 && !verify_quick(); start++)
            found += 0.5 * parted(k, 0.5 * start * seconds, seconds,
                                  2.0 * fl_error_budget_first_step(&g) / 3.0, goal);
        if (verify_quick()) continue;
        verify_note("two runs a bit apart are %g m apart %.3g s later in the mean", goal, found);
        off += log2(one / found) / many;
    }
    if (!verify_quick())
        verify_row("E04", "log2 of the horizon over that of two runs a bit apart, mean of five", off, 0.0,
                   1.0, VERIFY_ABS);
    verify_true("E04", "runs as a whole are told to be undetermined", horizon < 60.0);
    verify_below("E04", "length of windows times the rate",
                 g.divergence_rate * g.row_interval * g.window_rows, 1.0);
    fl_error_budget_free(&g);
}

int main(void)
{
    static const struct {
        const char *id, *of;
        double goal;
        double over;     /* scenes that may be over their budget */
        double short_of; /* steps that may be less than half of the largest that would do */
    } TABLE[] = {{"E01", "impulse", 0.01, 1, 1},
                 {"E02", "impulse", 0.003, 1, 1},
                 {"E03", "peak", 0.01, 1, 1},
                 {"E06", "impulse", 0.001, 1, 1},
                 {"E07", "impulse", 0.0005, 1, 1}};
    int vain = 0, tried = 0;
    verify_begin("a step from an error budget");
    for (size_t t = 0; t < sizeof TABLE / sizeof *TABLE; t++) {
        int within = 0, longest = 0, n = 0;
        verify_note("run.error = %g of the %s; (cap): no longer step is known to be stable beforehand",
                    TABLE[t].goal, TABLE[t].of);
        for (size_t k = 0; k < SCENES; k += verify_quick() ? 4 : 1) {
            const int ok = try(&SCENE[k], TABLE[t].goal, TABLE[t].of);
            within += ok & 1;
            longest += ok >> 1 & 1;
            vain += (ok & 5) == 5;
            tried++;
            n++;
        }
        verify_row(TABLE[t].id, "scenes within the budget, of all", within, n, TABLE[t].over, VERIFY_ABS);
        verify_row(TABLE[t].id, "steps at least half the largest that would do", longest, n,
                   TABLE[t].short_of, VERIFY_ABS);
        if (verify_quick()) break;
    }
    verify_note("%d scenes of %d were within the budget, and the run beside them said otherwise", vain,
                tried);
    verify_row("E11", "of 100 scenes, those doubted without need", 100.0 * vain / tried, 0.0, 5.0,
               VERIFY_ABS);
    crowd();
    orders();
    grazed();
    broken_off();
    without();
    without_bonds_ending();
    parting();
    return verify_end();
}
