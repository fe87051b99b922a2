/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The critical step that a run monitors, against the highest frequency of its contacts. */
#include <math.h>
#include <stdlib.h>
#include "base/rng.h"
#include "law/damping.h"
#include "sim/energy_balance.h"
#include "sphere/contact_list.h"
#include "sim/critical_step.h"
#include "support/small_world.h"
#include "support/shapes.h"
#include "support/verify.h"
#include "world/access.h"

/* A motion of all floes: displacement and small rotation of each. */
typedef struct {
    fl_vec3 *shift, *turn;
} motion;

static motion motion_of(int32_t n)
{
    motion u = {calloc((size_t)n, sizeof *u.shift), calloc((size_t)n, sizeof *u.turn)};
    if (!u.shift || !u.turn) exit(1);
    return u;
}

static void motion_free(motion *u) { free(u->shift), free(u->turn); }

/* Accelerations at the poses x, q displaced by e u, into a. */
static void accelerations(fl_world *w, const fl_vec3 *x, const fl_quat *q, double e, const motion *u,
                          motion *a)
{
    fl_err err = {0};
    for (int32_t i = 0; i < w->n; i++)
        lab_pose(w, i, v3_madd(x[i], e, u->shift[i]), q_mul(q_of_vector(v3_scale(e, u->turn[i])), q[i]));
    for (int32_t i = 0; i < w->n; i++) fl_body_update_spin(&w->b, i);
    w->last_search_step = -1;
    if (fl_step_start(w, &err)) exit(1);
    for (int32_t i = 0; i < w->n; i++) {
        a->shift[i] = v3_scale(w->b.invm[i], w->b.f[i]);
        a->turn[i] = fl_body_apply_inverse_inertia(&w->b, i, w->b.t[i]);
    }
}

/* Squared norm in the metric of the masses. */
static double metric_norm(const fl_world *w, const motion *u)
{
    double sum = 0.0;
    for (int32_t i = 0; i < w->n; i++) {
        const fl_vec3 t = m3_tmul(fl_body_axes(&w->b, i), u->turn[i]), I = w->b.I[i];
        sum += w->b.m[i] * v3_norm2(u->shift[i]) + I.x * t.x * t.x + I.y * t.y * t.y + I.z * t.z * t.z;
    }
    return sum;
}

/* Highest frequency of the present contacts, by power iteration on M^-1 K; K from differences of the
 * forces. */
static double highest_frequency(fl_world *w, double size)
{
    motion u = motion_of(w->n), plus = motion_of(w->n), minus = motion_of(w->n);
    fl_vec3 *x = calloc((size_t)w->n, sizeof *x);
    fl_quat *q = calloc((size_t)w->n, sizeof *q);
    double omega2 = 0.0;
    if (!x || !q) exit(1);
    for (int32_t i = 0; i < w->n; i++) {
        fl_rng g = fl_rng_of(7, i, FL_RNG_TEST);
        x[i] = w->b.x[i], q[i] = w->b.q[i];
        u.shift[i] = v3(fl_rng_normal(&g), fl_rng_normal(&g), fl_rng_normal(&g));
        u.turn[i] = v3(fl_rng_normal(&g), fl_rng_normal(&g), fl_rng_normal(&g));
    }
    for (int k = 0; k < 200; k++) {
        const double length = sqrt(metric_norm(w, &u) / w->b.m[0]), e = 1e-6 * size / length, was = omega2;
        accelerations(w, x, q, e, &u, &plus);
        accelerations(w, x, q, -e, &u, &minus);
        for (int32_t i = 0; i < w->n; i++) {
            u.shift[i] = v3_scale(-0.5 / e / length, v3_sub(plus.shift[i], minus.shift[i]));
            u.turn[i] = v3_scale(-0.5 / e / length, v3_sub(plus.turn[i], minus.turn[i]));
        }
        omega2 = sqrt(metric_norm(w, &u) / w->b.m[0]);
        if (k > 20 && fabs(omega2 - was) < 1e-7 * omega2) break;
    }
    for (int32_t i = 0; i < w->n; i++) u.shift[i] = u.turn[i] = v3(0, 0, 0);
    w->dt_critical = INFINITY; /* and the frequency of the contacts at the poses themselves */
    accelerations(w, x, q, 0.0, &u, &plus);
    motion_free(&u), motion_free(&plus), motion_free(&minus);
    free(x), free(q);
    return sqrt(omega2);
}

/* The bound must lie above the frequency, but not too far: a step that is too short costs time. */
static void verify_bound(const char *id, lab *l, double size, double share)
{
    const double omega = highest_frequency(&l->w, size), bound = 2.0 / l->w.dt_critical;
    verify_below(id, "highest frequency over the bound of the step", omega / bound, 1.0 + 1e-6);
    verify_below(id, "the bound over the highest frequency", bound / omega, share);
}

static void two_spheres(void)
{
    lab l;
    lab_start(&l);
    lab_sphere(&l, v3(0, 0, 0), 0.5, v3(0, 0, 0), v3(0, 0, 0));
    lab_sphere(&l, v3(0.99, 0, 0), 0.5, v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 1e-9);
    const double k = 1.5 * lab_pair(&l, 0).k * sqrt(0.01); /* Hertz at 10 mm */
    verify_note("two spheres overlapping by 10 mm, with one spring between them: 2/omega, omega^2 = 2 k/m");
    verify_row("S01", "critical step [s]", l.w.dt_critical, 2.0 / sqrt(2.0 * k / l.w.b.m[0]), 1e-10,
               VERIFY_REL);
    verify_bound("S01", &l, 0.01, 1.0 + 1e-4);
    for (int above = 0; above < 2; above++) {
        fl_err err = {0};
        l.w.dt = (above ? 1.001 : 0.999) * l.w.dt_critical;
        l.w.last_search_step = -1;
        const int rc = fl_step_start(&l.w, &err);
        if (above) verify_note("%s", err.text);
        verify_true("S01",
                    above ? "a step a thousandth above it is refused"
                          : "a step a thousandth below it is taken",
                    above ? rc != 0 && err.code == FL_NUMERIC : rc == 0);
    }
    lab_free(&l);
}

/* Boxes on a wall, each overlapping the one below by `overlap`. */
static void stack_of_boxes(const char *id, int32_t n, double overlap)
{
    lab l;
    lab_start(&l);
    lab_set(&l, "boundary.min=none none 0");
    for (int32_t k = 0; k < n; k++)
        lab_box(&l, v3(0.02 * (k % 2), 0, (0.4 - overlap) * (k + 1) - 0.2), v3(0.5, 0.4, 0.2), 0.05, q_one(),
                v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 1e-9);
    verify_note("%d boxes in a stack on a wall, each overlapping the next by %g mm", n, 1e3 * overlap);
    verify_bound(id, &l, overlap, 4.0);
    lab_free(&l);
}

/* Bodies of all shapes in a heap, each with many contacts. */
static void heap_of_bodies(const char *id, int32_t side, double squeeze)
{
    lab l;
    int64_t touching = 0;
    lab_start(&l);
    for (int32_t k = 0; k < side * side * side; k++) {
        fl_rng g = fl_rng_of(3, k, FL_RNG_TEST);
        const double middle = 0.5 * (side - 1);
        const fl_vec3 cell = v3(k % side - middle, k / side % side - middle, k / (side * side) - middle);
        const fl_vec3 turn = v3(0.04 * fl_rng_normal(&g), 0.04 * fl_rng_normal(&g), 0.04 * fl_rng_normal(&g));
        if (k % 3)
            lab_box(&l, v3_scale(squeeze, cell), v3(0.5, 0.5, 0.5), 0.1, q_of_vector(turn), v3(0, 0, 0),
                    v3(0, 0, 0));
        else lab_sphere(&l, v3_scale(squeeze, cell), 0.5, v3(0, 0, 0), v3(0, 0, 0));
    }
    lab_make(&l, 1e-9);
    fl_pair_iterator at = {.w = &l.w};
    for (const fl_pair *p; (p = fl_pair_next(&at)) != NULL;) touching += p->touching > 0;
    verify_note("%d boxes and spheres in a heap, %lld contacts", l.w.n, (long long)touching);
    verify_bound(id, &l, 1e-3, 4.0);
    lab_free(&l);
}

/* A capsule between two blocks that touch a share of its length at one end: the initial estimate of the
 * step. */
static void pinched_capsule(const char *id, double half, double share)
{
    const double r = 0.1, gap = 0.7 * r, from = half - 2.0 * half * share, to = half + 3.0 * r;
    lab l;
    lab_start(&l);
    lab_capsule(&l, v3(0, 0, 0), v3(half, 0, 0), r);
    lab_wall(&l, v3(from, -to, gap), v3(to, to, gap + 1.0), 1);
    lab_wall(&l, v3(from, -to, -gap - 1.0), v3(to, to, -gap), 1);
    lab_make(&l, 1e-9);
    const double stable = 2.0 / highest_frequency(&l.w, r), bound = fl_critical_step(&l.w);
    lab_free(&l);
    verify_note("a capsule %g times as long as thick, touched on %g of its length: stable up to %.3g of the "
                "initial estimate",
                half / r + 1.0, share, stable / bound);
    verify_below(id, "initial estimate over the largest stable step", bound / stable, 1.0);
    verify_below(id, "largest stable step over the initial estimate", stable / bound, 4.0);
}

/* --- with damping ------------------------------------------------------------------------------------- */

/* A body at rest on a wall: a sphere or a box.  A box that is rotated about y leans on another wall, or on
 * a step. */
typedef struct {
    const char *name;
    fl_vec3 half; /* 0: a sphere */
    double leans; /* [rad] */
    int step;
} resting_body;

static const resting_body BALL = {.name = "ball"}, SLAB = {"box", {0.5, 0.4, 0.2}, 0.0, 0},
                          UPRIGHT = {"box on its end", {0.2, 0.4, 0.5}, 0.0, 0},
                          CUBE = {"cube", {0.5, 0.5, 0.5}, 0.0, 0},
                          PILLAR = {"pillar on its end", {0.25, 0.25, 1.0}, 0.0, 0},
                          POST = {"pillar that leans", {0.25, 0.25, 1.0}, 0.6, 0},
                          PLATE = {"plate that leans", {0.1, 1.0, 1.0}, 0.3, 0},
                          EDGE = {"cube with an edge on a step", {0.5, 0.5, 0.5}, 0.3, 1};

static double largest_speed(const fl_bodies *b) { return v3_norm(b->v[0]) + v3_norm(b->w[0]); }

/* To rest, without an approach before. */
static void settle_to_rest(lab *l)
{
    for (int k = 0; k < 60000 && (k < 100 || largest_speed(&l->w.b) > 1e-11); k += 100) {
        const double dt = fmin(2e-4, 0.02 * l->w.dt_critical); /* a contact is soft when it begins */
        if (isfinite(l->w.dt_critical)) fl_step_set_size(&l->w, dt, fl_world_time(&l->w));
        if (lab_run(l, 100)) exit(1);
    }
    for (int64_t k = 0; k < l->w.n_pair; k++)
        if (l->w.pair[k].touching) l->w.pair[k].contact->max_approach_speed = 0.0;
}

/* At rest under its weight, damped for the restitution e; with friction if it is perturbed across. */
static void make_resting(lab *l, const resting_body *s, int across, double e)
{
    const double r = 0.05, x = s->half.x - r, z = s->half.z - r, c = cos(s->leans), d = sin(s->leans);
    const fl_vec3 centre = v3(x * c + z * d + r, 0, x * d + z * c + r);
    lab_start(l);
    lab_set(l, "run.gravity=9.81");
    lab_set(l, s->leans > 0.0 && !s->step ? "boundary.min=0 none 0" : "boundary.min=none none 0");
    lab_setf(l, "contact.restitution=%g", e);
    lab_set(l, "contact.stiffness=5e6");
    lab_setf(l, "contact.friction=%g", across ? 0.9 : 0.0);
    if (s->half.x > 0.0)
        lab_box(l, s->leans > 0.0 ? centre : v3(0, 0, s->half.z), s->half, r, q_about_axis(1, -s->leans),
                v3(0, 0, 0), v3(0, 0, 0));
    else lab_sphere(l, v3(0, 0, 0.499), 0.5, v3(0, 0, 0), v3(0, 0, 0));
    if (s->step) { /* its edge just under the face, at nine tenths of that */
        const double at = 0.8 * x, up = -(z + r);
        const fl_vec3 edge = v3(centre.x + at * c - up * d, 0, centre.z + at * d + up * c);
        lab_wall(l, v3(edge.x, -3, -1), v3(edge.x + 2, 3, edge.z), 1);
    }
    lab_make(l, 1e-9);
    settle_to_rest(l);
}

/* True if a perturbation, normal to the wall or across, decays in steps of dt. */
static int perturbation_decays(lab *l, int across, double share)
{
    double most = 0.0;
    const double push = 1e-9;
    *(across ? &l->w.b.v[0].x : &l->w.b.v[0].z) += push;
    fl_step_set_size(&l->w, share * l->w.dt_critical, fl_world_time(&l->w));
    for (int k = 0; k < 400 && most < 1e3 * push; k++) {
        if (lab_run(l, 10)) exit(1);
        most = fmax(most, largest_speed(&l->w.b));
    }
    settle_to_rest(l);
    return most < 1e3 * push;
}

/* The largest share of 2/omega that is stable. */
static double largest_stable_share(lab *l, int across)
{
    double lo = 0.02, hi = 1.0;
    while (hi > 1.002 * lo) {
        const double mid = sqrt(lo * hi);
        if (perturbation_decays(l, across, mid)) lo = mid;
        else hi = mid;
    }
    return lo;
}

static void damped_contact(const char *id, const resting_body *s, int across, double e)
{
    lab l;
    make_resting(&l, s, across, e);
    const double bound = FL_DAMPED_SHARE_MIN, stable = largest_stable_share(&l, across);
    lab_free(&l);
    verify_note("a %s at rest, e = %g, pushed %s: stable up to %.3g of 2/omega, the bound says %.3g", s->name,
                e, across ? "across" : "down", stable, bound);
    verify_below(id, "bound of the damped step over the largest stable step", bound / stable, 1.002);
    verify_below(id, "largest stable step over the bound", stable / bound, 2.3);
}

/* Share of 2/omega that runs use, with run.error and without. */
static double share_used_by_run(lab *l, int measured)
{
    int32_t body;
    lab_set(l, measured ? "run.error=0.01" : "run.safety=1");
    const double share = fl_automatic_step(&l->w, &body) / fl_critical_step(&l->w);
    return measured ? share * fl_lateral_share(&l->w) : share;
}

static void damped_contact_in_runs(const char *id, const resting_body *s, double e)
{
    lab l;
    make_resting(&l, s, 1, e);
    const double half = share_used_by_run(&l, 0), most = share_used_by_run(&l, 1),
                 stable = largest_stable_share(&l, 1);
    lab_free(&l);
    verify_note("a %s at rest, e = %g, pushed across: stable up to %.3g of 2/omega; runs use %.3g, those "
                "with run.error to %.3g",
                s->name, e, stable, half, most);
    verify_below(id, "step of runs over the largest stable step", half / stable, 1.0);
    verify_below(id, "with run.error over the largest stable step", most / stable, 1.0);
    verify_below(id, "damped step over the largest stable step", FL_DAMPED_SHARE_MIN / stable, 1.0);
    verify_below(id, "largest stable step over that", stable / FL_DAMPED_SHARE_MIN, 1.5);
}

/* A box runs flat into a wall, in steps of a share of 2/omega: its restitution. */
static double restitution_at_step(double e, double share, double *critical)
{
    const fl_vec3 half = {0.5, 0.4, 0.2};
    lab l;
    lab_start(&l);
    lab_set(&l, "boundary.min=none none 0");
    lab_setf(&l, "contact.restitution=%g", e);
    lab_set(&l, "contact.friction=0");
    lab_set(&l, "contact.stiffness=5e6");
    lab_box(&l, v3(0, 0, half.z + 1e-4), half, 0.05, q_one(), v3(0, 0, -1), v3(0, 0, 0));
    lab_make(&l, *critical > 0.0 ? share * *critical : 1e-5);
    for (int k = 0; k < 100000 && l.w.b.v[0].z < 1.0 && (l.w.b.v[0].z < 0.0 || l.w.b.x[0].z < half.z); k++)
        if (lab_run(&l, 1)) exit(1);
    *critical = l.w.dt_critical;
    const double came = l.w.b.v[0].z;
    lab_free(&l);
    return came;
}

/* Up to the largest step of runs, the impact has the prescribed restitution. */
static void box_into_wall(const char *id, double e)
{
    const double left = fl_damping_impact_share(fl_damping_hunt_crossley(e));
    double limit = 0.0;
    restitution_at_step(e, 0.0, &limit);
    for (double part = 0.8; part > 0.05; part *= 0.5) {
        const double critical = limit;
        double again = limit;
        const double share = part * left,
                     off = fabs(restitution_at_step(e, share, &again) - fmax(e, FL_MIN_RESTITUTION));
        verify_note("a box runs into a wall, e = %g, in steps of %.3g of 2/omega = %.3g s: error %.2g", e,
                    share, critical, off);
        verify_below(id, "restitution off by", off, 0.2 * share * share);
    }
}

/* The largest stable step of an impact, where 1 + D u and D s are stiffness and damping: K dt^2 + 2 C dt =
 * 4. */
static void impact_bound(const char *id, double e)
{
    const double D = fl_damping_hunt_crossley(e), bound = fl_hunt_crossley_stable_share(D, 1.0);
    double least = INFINITY;
    for (int k = 0; k <= 1000; k++) { /* s^2 from u du/(1 + D u) = -s ds */
        const double u = 1e-3 * k, s2 = 2.0 * ((1.0 - u) - log((1.0 + D) / (1.0 + D * u)) / D) / D;
        const double C = D * sqrt(fmax(s2, 0.0)), K = 1.0 + D * u;
        least = fmin(least, 0.5 * (sqrt(C * C + 4.0 * K) - C) / K);
    }
    verify_note("an impact, e = %g: stable up to %.3g of 2/omega, the bound says %.3g", e, least, bound);
    verify_below(id, "bound of the damped step over the least of an impact", bound / least, 1.0 + 1e-3);
    verify_below(id, "least step of an impact over the bound", least / bound, 2.3);
}

/* A box bounces on a block at rest that carries a number of others: its speed after a while. */
static double speed_beside_others(int others)
{
    const fl_vec3 half = {0.5, 0.4, 0.2};
    lab l;
    lab_start(&l);
    lab_set(&l, "run.gravity=9.81");
    lab_set(&l, "contact.restitution=0.3");
    lab_set(&l, "contact.friction=0.5");
    lab_set(&l, "contact.stiffness=5e6");
    lab_wall(&l, v3(-100, -3, -1), v3(100, 3, 0), 1);
    lab_box(&l, v3(0, 0, half.z + 0.01), half, 0.05, q_about_axis(1, 0.01), v3(0.2, 0, -0.3), v3(0, 0, 0));
    for (int k = 0; k < others; k++)
        lab_box(&l, v3(3.0 * (k + 1), 0, half.z - 1e-4), half, 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 2e-4);
    if (lab_run(&l, 800)) exit(1);
    const double v = l.w.b.v[0].z;
    lab_free(&l);
    return v;
}

/* A box between two walls of one part, overlapping each by half a millimetre, moves a little at random, in
 * the longest automatic steps: largest energy over that at the start. */
static double energy_in_slot(double e, double friction, int seed)
{
    const fl_vec3 half = {0.4, 0.6, 0.3};
    const double to = half.x - 5e-4, level = 1e-3;
    const fl_vec3 xy[8] = {v3(-2, -3, 0),   v3(2, -3, 0),     v3(2, 3, 0),   v3(to, 3, 0),
                           v3(to, -2.5, 0), v3(-to, -2.5, 0), v3(-to, 3, 0), v3(-2, 3, 0)};
    fl_rng g = fl_rng_of(11, seed, FL_RNG_TEST);
    double r[9], most = 0.0;
    int32_t body;
    lab l;
    for (int k = 0; k < 9; k++) r[k] = fl_rng_normal(&g);
    lab_start(&l);
    lab_set(&l, "run.safety=1");
    lab_setf(&l, "contact.restitution=%g", e);
    lab_setf(&l, "contact.friction=%g", friction);
    lab_set(&l, "contact.stiffness=5e6");
    lab_prism(&l, 8, xy, -2, 2);
    lab_box(&l, v3(1e-5 * r[0], 0, 0), half, 0.05, q_of_vector(v3(0, 1e-5 * r[1], 1e-5 * r[2])),
            v3(level * r[3], level * r[4], level * r[5]), v3(level * r[6], level * r[7], level * r[8]));
    lab_make(&l, 1e-6);
    fl_step_set_size(&l.w, fl_automatic_step(&l.w, &body), 0.0);
    const fl_ledger *at = &l.w.ledger;
    fl_energy_update(&l.w);
    const double start = at->kinetic + at->elastic;
    for (int k = 0; k < 2000; k++) {
        if (lab_run(&l, 1)) exit(1);
        fl_energy_update(&l.w);
        most = fmax(most, (at->kinetic + at->elastic) / start);
    }
    lab_free(&l);
    return most;
}

static void box_in_slot(const char *id)
{
    static const double E[] = {0.0, 0.2, 0.5, 0.8};
    for (size_t k = 0; k < sizeof E / sizeof *E; k++)
        for (int rough = 0; rough < 2; rough++) {
            double most = 0.0;
            for (int seed = 0; seed < 10; seed++) most = fmax(most, energy_in_slot(E[k], 0.3 * rough, seed));
            verify_note("a box in a slot, e = %g, friction %g: at most %.6g of its energy at the start", E[k],
                        0.3 * rough, most);
            verify_below(id, "largest energy over that at the start", most, 1.02);
        }
}

/* --- accuracy, beside stability ----------------------------------------------------------------------- */

/* Spheres with friction in close packing between walls settle under their weight.  Returns the impulse on
 * the floor in each tenth of the time, for a number of steps [N s]. */
enum { TENTHS = 10 };
static void settle_packing(int32_t steps, double time, double bore[TENTHS])
{
    enum { SIDE = 5, LAYERS = 8 };
    const double r = 0.125, d = 2.0 * r, row = sqrt(0.75) * d, up = sqrt(2.0 / 3.0) * d;
    lab l;
    lab_start(&l);
    lab_set(&l, "material.ice.young=10 MPa");
    lab_set(&l, "contact.friction=0.3");
    lab_set(&l, "contact.restitution=0.3");
    lab_set(&l, "run.gravity=9.81");
    lab_setf(&l, "boundary.min=%.17g %.17g 0", -r, -r);
    lab_setf(&l, "boundary.max=%.17g %.17g none", SIDE * d, (SIDE - 1) * row + row / 3.0 + r);
    for (int k = 0; k < SIDE * SIDE * LAYERS; k++) {
        const int x = k % SIDE, y = k / SIDE % SIDE, z = k / (SIDE * SIDE);
        lab_sphere(&l, v3(d * x + r * ((y + z) % 2), row * (y + z % 2 / 3.0), r + up * z), r, v3(0, 0, 0),
                   v3(0, 0, 0));
    }
    lab_make(&l, time / TENTHS / steps);
    int32_t floor = -1; /* the wall with its normal upwards */
    for (int32_t j = l.w.n; j < l.w.b.total; j++)
        if (m3_col(fl_body_axes(&l.w.b, j), 2).z > 0.9) floor = j;
    for (int tenth = 0; tenth < TENTHS; tenth++) {
        bore[tenth] = 0.0;
        for (int32_t s = 0; s < steps; s++) {
            bore[tenth] -= 0.5 * l.w.dt * l.w.b.f[floor].z;
            if (lab_run(&l, 1)) exit(1);
            bore[tenth] -= 0.5 * l.w.dt * l.w.b.f[floor].z;
        }
    }
    lab_free(&l);
}

static void settling_packing(const char *id)
{
    static const int32_t STEPS[] = {24, 48, 96};
    double critical, truth[TENTHS], off[3], tenth[3];
    lab l;
    lab_start(&l);
    lab_set(&l, "material.ice.young=10 MPa");
    lab_set(&l, "contact.friction=0.3");
    lab_set(&l, "run.gravity=9.81");
    for (int k = 0; k < 3; k++) lab_sphere(&l, v3(k, 0, 0), 0.125, v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 1e-6);
    critical = fl_critical_step(&l.w);
    lab_free(&l);
    const double time = 0.12 * critical * STEPS[0] * TENTHS;
    settle_packing(1536, time, truth);
    for (int k = 0; k < 3; k++) {
        double bore[TENTHS], all = 0.0, most = 0.0, largest_stable_share = 0.0;
        settle_packing(STEPS[k], time, bore);
        for (int t = 0; t < TENTHS; t++) {
            all += truth[t], off[k] = t ? off[k] : 0.0;
            off[k] += bore[t] - truth[t];
            most = fmax(most, fabs(bore[t] - truth[t])),
            largest_stable_share = fmax(largest_stable_share, truth[t]);
        }
        off[k] = fabs(off[k]) / all, tenth[k] = most / largest_stable_share;
        verify_note("a packing settles in steps of %.3g of 2/omega: error of the impulse on the floor "
                    "%.1e, in a tenth of the time %.1e of the largest",
                    0.12 * STEPS[0] / STEPS[k], off[k], most / largest_stable_share);
        if (k == 0) verify_below(id, "error of the impulse on the floor", off[k], 1e-3);
        if (k == 0) verify_below(id, "in any tenth of the time, over the largest", tenth[k], 5e-3);
    }
    verify_below(id, "the same at a quarter of the step", tenth[2] / tenth[0], 0.1);
}

/* Two spheres collide once.  Counts the runs, which begin at different parts of a step, that report a step
 * over the critical one. */
static void single_impact(const char *id, double safety)
{
    enum { RUNS = 32 };
    int reported = 0;
    char what[80];
    for (int k = 0; k < RUNS; k++) {
        lab l;
        lab_start(&l);
        lab_setf(&l, "run.safety=%g", safety);
        lab_sphere(&l, v3(-0.501 - 1e-4 * k, 0, 0), 0.5, v3(1, 0, 0), v3(0, 0, 0));
        lab_sphere(&l, v3(0.501, 0, 0), 0.5, v3(-1, 0, 0), v3(0, 0, 0));
        lab_make(&l, 0.0);
        const int rc = lab_run(&l, (int64_t)(0.03 / l.w.dt));
        reported += rc == 0 && l.w.b.v[0].x < 0.0 && l.w.dt > 0.5 * safety * l.w.dt_critical;
        lab_free(&l);
    }
    snprintf(what, sizeof what, "safety %g: runs of one impact that report it", safety);
    verify_row(id, what, reported, RUNS, 0.0, VERIFY_ABS);
}

int main(void)
{
    verify_begin("the largest stable step");
    for (int k = 1; k <= 4; k *= 2) single_impact("S33", 0.2 * k);
    two_spheres();
    stack_of_boxes("S02", 1, 1e-3);
    stack_of_boxes("S03", 2, 1e-3);
    stack_of_boxes("S04", 8, 2e-3);
    heap_of_bodies("S05", 3, 0.98);
    if (!verify_quick()) heap_of_bodies("S06", 5, 0.97);
    pinched_capsule("S19", 0.1, 0.02);
    pinched_capsule("S19", 0.4, 0.02);
    pinched_capsule("S19", 1.6, 0.02);
    pinched_capsule("S19", 1.6, 0.25);
    static const double E[] = {0.0, 0.05, 0.2};
    for (size_t k = 0; k < sizeof E / sizeof *E; k++) {
        impact_bound("S07", E[k]);
        damped_contact("S08", &BALL, 0, E[k]);
        damped_contact("S09", &SLAB, 0, E[k]);
        damped_contact("S10", &BALL, 1, E[k]);
        damped_contact("S11", &SLAB, 1, E[k]);
        damped_contact_in_runs("S12", &SLAB, E[k]);
        damped_contact_in_runs("S13", &UPRIGHT, E[k]);
        damped_contact_in_runs("S14", &CUBE, E[k]);
        damped_contact_in_runs("S15", &PILLAR, E[k]);
    }
    static const double BOUNCES[] = {0.0, 0.05, 0.2, 0.4, 0.6, 0.8};
    for (size_t k = 0; k < sizeof BOUNCES / sizeof *BOUNCES; k++) box_into_wall("S25", BOUNCES[k]);
    box_in_slot("S26");
    verify_row("S27", "speed of a box on a block with thirty others there [m/s]", speed_beside_others(30),
               speed_beside_others(0), 0.0, VERIFY_ABS);
    settling_packing("S28");
    if (!verify_quick()) {
        damped_contact_in_runs("S16", &POST, 0.0);
        damped_contact_in_runs("S17", &PLATE, 0.0);
        damped_contact_in_runs("S18", &EDGE, 0.0);
    }
    return verify_end();
}
