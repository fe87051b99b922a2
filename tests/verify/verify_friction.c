/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Friction of faces that slide and spin, beside Coulomb's law over an even pressure and beside the law of
 * law/tangent.h in steady motion: plates on a floor, the limit of sticking, and floes along walls. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "patch/patch_result.h"
#include "sim/energy_balance.h"
#include "support/exact_friction.h"
#include "support/small_world.h"
#include "support/verify.h"
#include "world/access.h"

#define G 9.81
#define MU 0.3
#define RADIUS 0.005 /* of the plates [m] */
#define HEIGHT 0.05

enum { MOST_CORNERS = 48 };

typedef struct {
    int n;
    fl_vec3 corner[MOST_CORNERS];
} outline;

static outline regular_outline(int n, double circumradius)
{
    outline o = {.n = n};
    for (int k = 0; k < n; k++) {
        const double a = 2.0 * PI * (k + 0.5) / n;
        o.corner[k] = v3(circumradius * cos(a), circumradius * sin(a), 0.0);
    }
    return o;
}

static outline rectangle_outline(double a, double b)
{
    return (outline){4, {{-0.5 * a, -0.5 * b, 0}, {0.5 * a, -0.5 * b, 0}, {0.5 * a, 0.5 * b, 0}, {-0.5 * a, 0.5 * b, 0}}};
}

/* --- plates on a floor -------------------------------------------------------------------------------- */

typedef struct {
    const char *id, *name;
    outline face; /* of the core, which is the flat face */
    double radius, height;
    fl_vec3 v;
    double w, look; /* motion at the start; time at which the motion is compared */
} plate;

static flat_wrench exact_of(const void *context, fl_vec3 v, double w)
{
    const outline *o = context;
    return exact_polygon_friction(o->n, o->corner, v, w);
}

static flat_wrench law_of(const void *context, fl_vec3 v, double w)
{
    const outline *o = context;
    fl_vec3 centre;
    return law_friction(polygon_second_moments(o->n, o->corner, &centre), v, w);
}

static void make_prism(const outline *o, double height, fl_poly *p)
{
    fl_err err = {0};
    fl_vec3 v[2 * MOST_CORNERS];
    int32_t first[MOST_CORNERS + 3] = {0}, loop[6 * MOST_CORNERS], n = 0;
    for (int k = 0; k < o->n; k++) {
        v[k] = v3(o->corner[k].x, o->corner[k].y, 0.0);
        v[o->n + k] = v3(o->corner[k].x, o->corner[k].y, height);
    }
    for (int k = 0; k < o->n; k++) loop[n++] = o->n - 1 - k;
    first[1] = n;
    for (int k = 0; k < o->n; k++) loop[n++] = o->n + k;
    first[2] = n;
    for (int k = 0; k < o->n; k++) {
        const int next = (k + 1) % o->n;
        loop[n++] = k, loop[n++] = next, loop[n++] = o->n + next, loop[n++] = o->n + k;
        first[3 + k] = n;
    }
    if (fl_poly_make(p, 2 * o->n, v, o->n + 2, first, loop, &err)) {
        printf("%s\n", err.text);
        exit(1);
    }
}

/* The overlap at which body 0 carries its weight on the floor [m]. */
static double resting_overlap(lab *l)
{
    const double z = l->w.b.x[0].z, load = l->w.b.m[0] * G;
    double s = 1e-4;
    for (int k = 0; k < 40; k++) {
        l->w.b.x[0].z = z - s;
        s *= load / v3_norm(lab_evaluate_pair(&l->w, 0, 1).force);
    }
    l->w.b.x[0].z = z;
    return s;
}

/* I/m about z, the axis of the plate. */
static double gyration2_of(const fl_bodies *b)
{
    const fl_vec3 z = m3_tmul(fl_body_axes(b, 0), v3(0, 0, 1));
    return v3_dot(v3_mul(z, z), b->I[0]) / b->m[0];
}

/* The plate at rest on the floor, about to move.  -1: the plate moves as p says; else its own motion. */
static void start_plate(lab *l, const plate *p, double safety)
{
    fl_poly core = {0};
    lab_start(l);
    lab_set(l, "run.gravity=9.81");
    lab_setf(l, "contact.friction=%g", MU);
    lab_set(l, "contact.restitution=0.3");
    lab_setf(l, "run.safety=%g", safety);
    make_prism(&p->face, p->height - 2.0 * p->radius, &core);
    fl_poly_to_frame(&core, v3(0, 0, -p->radius), q_matrix(q_one()));
    lab_poly(l, &core, p->radius, p->v, v3(0, 0, p->w));
    lab_wall(l, v3(-4, -4, -1), v3(4, 4, 0), 1);
    lab_make(l, 0.0);
    l->w.b.x[0].z -= resting_overlap(l);
}

#define RATIO_AT 0.004 /* speed over that at the start at which v/w is noted */

typedef struct {
    plate_stop stop;
    double gyration2, residual;
} plate_run;

/* Runs until the plate stops: its speed is a thousandth, and less than a step takes. */
static plate_run run_plate(const plate *p, double safety)
{
    lab l;
    plate_run r = {.gyration2 = 0.0};
    start_plate(&l, p, safety);
    const fl_bodies *b = &l.w.b;
    const fl_vec3 from = b->x[0];
    r.gyration2 = gyration2_of(b);
    double angle = 0.0;
    const double start = sqrt(v3_norm2(p->v) + r.gyration2 * p->w * p->w);
    fl_energy_update(&l.w);
    for (int64_t s = 0; s < 10000000; s++) {
        const double t = fl_world_time(&l.w);
        if (lab_run(&l, 1)) exit(1);
        angle += l.w.dt * b->w[0].z;
        const double v = hypot(b->v[0].x, b->v[0].y), w = fabs(b->w[0].z);
        if (t < p->look && t + l.w.dt >= p->look) r.stop.v = b->v[0], r.stop.w = b->w[0].z;
        if (sqrt(v * v + r.gyration2 * w * w) < 1e-3 * start) break;
        if (sqrt(v * v + r.gyration2 * w * w) > RATIO_AT * start) r.stop.ratio = v / w;
    }
    fl_energy_update(&l.w);
    r.residual = l.w.ledger.residual / (0.5 * b->m[0] * start * start);
    r.stop.time = fl_world_time(&l.w), r.stop.angle = angle;
    r.stop.x = v3_sub(b->x[0], from);
    lab_free(&l);
    return r;
}

/* One quantity: program, exact Coulomb, and the law in steady motion. */
static void compare(const char *id, const char *what, double value, double exact, double law, double tol)
{
    char line[80];
    snprintf(line, sizeof line, "%s (law %.4f)", what, law);
    verify_row(id, line, value, exact, tol, VERIFY_REL);
}

static void slide_plate(const plate *p, double tol)
{
    const plate_run r = run_plate(p, verify_quick() ? 0.4 : 0.1);
    const plate_stop exact = stop_of_plate(exact_of, &p->face, MU * G, r.gyration2, p->v, p->w, p->look, 1e-4),
                     law = stop_of_plate(law_of, &p->face, MU * G, r.gyration2, p->v, p->w, p->look, 1e-4);
    verify_note("%s: %s", p->id, p->name);
    compare(p->id, "time of the stop [s]", r.stop.time, exact.time, law.time, tol);
    if (v3_norm(p->v) > 0.0)
        compare(p->id, "way [m]", hypot(r.stop.x.x, r.stop.x.y), v3_norm(exact.x), v3_norm(law.x), tol);
    if (p->look > 0.0) {
        compare(p->id, "speed at 0.3 s [m/s]", hypot(r.stop.v.x, r.stop.v.y), v3_norm(exact.v), v3_norm(law.v), tol);
        compare(p->id, "spin at 0.3 s [rad/s]", r.stop.w, exact.w, law.w, tol);
    }
    if (p->face.n != 48 || v3_norm(p->v) == 0.0)
        compare(p->id, "angle at the stop [rad]", r.stop.angle, exact.angle, law.angle, tol);
    verify_below(p->id, "energy residual over the kinetic energy", fabs(r.residual), 1e-5);
}

static void slide_beam(const plate *p)
{
    const plate_run r = run_plate(p, verify_quick() ? 0.4 : 0.1);
    const plate_stop exact = stop_of_plate(exact_of, &p->face, MU * G, r.gyration2, p->v, p->w, 0.0, 1e-4),
                     law = stop_of_plate(law_of, &p->face, MU * G, r.gyration2, p->v, p->w, 0.0, 1e-4);
    verify_note("%s: %s", p->id, p->name);
    if (v3_norm(p->v) == 0.0) {
        compare(p->id, "time of the stop [s]", r.stop.time, exact.time, law.time, 0.005);
        return;
    }
    compare(p->id, "time of the stop [s]", r.stop.time, exact.time, law.time, 0.03);
    verify_note("law: at (%.4f, %.4f)", law.x.x, law.x.y);
    verify_row(p->id, "way along the beam [m]", r.stop.x.x, exact.x.x, 0.008, VERIFY_ABS);
    verify_row(p->id, "way across it [m]", r.stop.x.y, exact.x.y, 0.008, VERIFY_ABS);
}

static void last_ratio(const plate *p, double radius)
{
    const plate_run r = run_plate(p, verify_quick() ? 0.4 : 0.1);
    double lo = 0.1, hi = 1.0; /* F/muN = 2 e M/(muN R) for I = m R^2/2 */
    for (int k = 0; k < 60; k++) {
        const double e = 0.5 * (lo + hi);
        double F, M;
        exact_disc_friction(e, &F, &M);
        if (F < 2.0 * e * M) lo = e;
        else hi = e;
    }
    const double at = RATIO_AT * sqrt(v3_norm2(p->v) + r.gyration2 * p->w * p->w);
    const plate_stop exact = stop_of_plate(exact_of, &p->face, MU * G, r.gyration2, p->v, p->w, 0.0, at),
                     law = stop_of_plate(law_of, &p->face, MU * G, r.gyration2, p->v, p->w, 0.0, at);
    verify_note("%s: %s; v/(w R) tends to %.4f, the root of F = 2 e M", p->id, p->name, lo);
    compare(p->id, "v/(w R) at 0.004 of the speed", r.stop.ratio / radius, exact.ratio / radius,
            law.ratio / radius, 0.03);
}

static void plates(void)
{
    const double R = 1.0;
    const plate fr1 = {"FR1", "a round plate of 48 sides, 1 m, 1 m/s, 2 rad/s", regular_outline(48, R - RADIUS),
                       RADIUS, HEIGHT, {1, 0, 0}, 2.0, 0.3};
    slide_plate(&fr1, 0.01);
    const double side = 1.0 - 2.0 * RADIUS;
    const plate fr2 = {"FR2", "a square plate of 1 m, 1 m/s, 3 rad/s", rectangle_outline(side, side),
                       RADIUS, HEIGHT, {1, 0, 0}, 3.0, 0.0};
    slide_plate(&fr2, 0.01);
    plate fr3 = {"FR3", "a beam of 1 m, 1 m/s across it, 4 rad/s", rectangle_outline(0.998, 0.018),
                 0.001, 0.004, {0, 1, 0}, 4.0, 0.0};
    slide_beam(&fr3);
    fr3.v = v3(0, 0, 0), fr3.name = "the same, 4 rad/s alone";
    slide_beam(&fr3);
    plate fr4 = fr1;
    fr4.id = "FR4", fr4.name = "the round plate, 3 rad/s alone", fr4.v = v3(0, 0, 0), fr4.w = 3.0, fr4.look = 0.0;
    slide_plate(&fr4, 0.005);
    plate fr6 = fr1;
    fr6.id = "FR6", fr6.name = "the round plate, 1 m/s, 2 rad/s", fr6.look = 0.0;
    last_ratio(&fr6, R - RADIUS);
    fr6.w = 0.2, fr6.name = "the same, 0.2 rad/s";
    last_ratio(&fr6, R - RADIUS);
}

/* --- the limit of sticking ---------------------------------------------------------------------------- */

/* F over mu N along x at which a face slips, pushed along x at the distance f from its centre: the motion is
 * (1, 0) with the spin w for which M = f F. */
static double slip_limit(flat_wrench (*friction)(const void *, fl_vec3, double), const outline *o, double f)
{
    double lo = 0.0, hi = 1e3;
    for (int k = 0; k < 200; k++) {
        const double w = 0.5 * (lo + hi);
        const flat_wrench q = friction(o, v3(1, 0, 0), w);
        if (q.m < f * q.x) lo = w;
        else hi = w;
    }
    return friction(o, v3(1, 0, 0), lo).x;
}

/* The same of the step: slip and spin grow slowly in the ratio that keeps M = f F. */
static double slip_of_step(const outline *o, double f)
{
    fl_vec3 centre;
    const fl_pressure_shape s =
        fl_pressure_shape_of(polygon_second_moments(o->n, o->corner, &centre), v3(0, 0, 1));
    const fl_friction_contact c = {.n = v3(0, 0, 1), .k = 1e6, .limit = 1.0, .arm = s.arm, .elongation = s.elongation};
    fl_friction_springs springs = {.k = c.k, .k_turn = c.k * s.arm * s.arm};
    double F = 0.0, w = 0.0, M = 0.0;
    for (int k = 0; k < 40000; k++) { /* to thirty times the elastic slip */
        w += 0.01 * (f * F - M) / (s.arm * s.arm) + (k == 0 ? 1.0 : 0.0);
        w = w > 0.0 ? w : 0.0;
        const fl_friction_motion by = {.v = v3(-1, 0, 0), .v_end = v3(-1, 0, 0), .spin = -w, .spin_end = -w};
        const fl_friction_result r = fl_tangent_step(springs, c, by, 1e-9);
        springs = r.springs, F = r.force.x, M = r.moment;
    }
    return fabs(M - f * F) < 1e-4 ? F : NAN;
}

static void off_centre_push(void)
{
    static const double AT[3] = {0.25, 0.5, 1.0};
    outline disc = regular_outline(48, sqrt(2.0 * PI / 48.0 / sin(2.0 * PI / 48.0))), square = rectangle_outline(1, 1);
    verify_note("slip under a push f off the centre: the disc (48 sides of its area), then a square along a side");
    for (int k = 0; k < 6; k++) {
        const outline *o = k < 3 ? &disc : &square;
        char what[80];
        snprintf(what, sizeof what, "%s, f = %g m: F/(mu N) (law %.4f)", k < 3 ? "disc 1 m" : "square 1 m", AT[k % 3],
                 slip_limit(law_of, o, AT[k % 3]));
        verify_row("FR5", what, slip_of_step(o, AT[k % 3]), slip_limit(exact_of, o, AT[k % 3]), 0.01, VERIFY_REL);
    }
}

int main(void)
{
    verify_begin("friction of faces");
    plates();
    off_centre_push();
    return verify_end();
}
