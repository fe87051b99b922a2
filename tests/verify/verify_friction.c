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
    return (outline){
        4, {{-0.5 * a, -0.5 * b, 0}, {0.5 * a, -0.5 * b, 0}, {0.5 * a, 0.5 * b, 0}, {-0.5 * a, 0.5 * b, 0}}};
}

/* --- plates on a floor -------------------------------------------------------------------------------- */

typedef struct {
    const char *id, *name;
    outline face; /* of the core, which is the flat face */
    double radius, height;
    fl_vec3 v;
    double w, look; /* motion at the start; time at which the motion is compared */
    double surrogate;
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
    lab_setf(l, "contact.surrogate=%g", p->surrogate);
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
    const plate_stop exact =
                         stop_of_plate(exact_of, &p->face, MU * G, r.gyration2, p->v, p->w, p->look, 1e-4),
                     law = stop_of_plate(law_of, &p->face, MU * G, r.gyration2, p->v, p->w, p->look, 1e-4);
    verify_note("%s: %s", p->id, p->name);
    compare(p->id, "time of the stop [s]", r.stop.time, exact.time, law.time, tol);
    if (v3_norm(p->v) > 0.0)
        compare(p->id, "way [m]", hypot(r.stop.x.x, r.stop.x.y), v3_norm(exact.x), v3_norm(law.x), tol);
    if (p->look > 0.0) {
        verify_note("aside of its path: %.2e m", r.stop.x.y);
        compare(p->id, "speed at 0.3 s [m/s]", hypot(r.stop.v.x, r.stop.v.y), v3_norm(exact.v),
                v3_norm(law.v), tol);
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
    const plate fr1 = {"FR1",
                       "a round plate of 48 sides, 1 m, 1 m/s, 2 rad/s",
                       regular_outline(48, R - RADIUS),
                       RADIUS,
                       HEIGHT,
                       {1, 0, 0},
                       2.0,
                       0.3,
                       0.0};
    slide_plate(&fr1, 0.01);
    const double side = 1.0 - 2.0 * RADIUS;
    const plate fr2 = {"FR2",
                       "a square plate of 1 m, 1 m/s, 3 rad/s",
                       rectangle_outline(side, side),
                       RADIUS,
                       HEIGHT,
                       {1, 0, 0},
                       3.0,
                       0.0,
                       0.0};
    slide_plate(&fr2, 0.01);
    plate replaced = fr2;
    replaced.name = "the same by surrogates of 1e-3", replaced.surrogate = 1e-3;
    slide_plate(&replaced, 0.01);
    plate fr3 = {"FR3",
                 "a beam of 1 m, 1 m/s across it, 4 rad/s",
                 rectangle_outline(0.998, 0.018),
                 0.001,
                 0.004,
                 {0, 1, 0},
                 4.0,
                 0.0,
                 0.0};
    slide_beam(&fr3);
    fr3.v = v3(0, 0, 0), fr3.name = "the same, 4 rad/s alone";
    slide_beam(&fr3);
    plate fr4 = fr1;
    fr4.id = "FR4", fr4.name = "the round plate, 3 rad/s alone", fr4.v = v3(0, 0, 0), fr4.w = 3.0,
    fr4.look = 0.0;
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
    const fl_friction_contact c = {
        .n = v3(0, 0, 1), .k = 1e6, .limit = 1.0, .arm = s.arm, .elongation = s.elongation};
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
    outline disc = regular_outline(48, sqrt(2.0 * PI / 48.0 / sin(2.0 * PI / 48.0))),
            square = rectangle_outline(1, 1);
    verify_note(
        "slip under a push f off the centre: the disc (48 sides of its area), then a square along a side");
    for (int k = 0; k < 6; k++) {
        const outline *o = k < 3 ? &disc : &square;
        char what[80];
        snprintf(what, sizeof what, "%s, f = %g m: F/(mu N) (law %.4f)", k < 3 ? "disc 1 m" : "square 1 m",
                 AT[k % 3], slip_limit(law_of, o, AT[k % 3]));
        verify_row("FR5", what, slip_of_step(o, AT[k % 3]), slip_limit(exact_of, o, AT[k % 3]), 0.01,
                   VERIFY_REL);
    }
}

/* --- corners of meshes -------------------------------------------------------------------------------- */

/* A ball of 0.3 m rolls in half a pipe of 2 m of n flat facets, from 45 degrees to where it turns round.
 * Every corner takes the speed across the next facet, m (v dphi)^2/2. */
static void trough(int n, double restitution, double most)
{
    const double R = 2.0, r = 0.3, dphi = PI / n;
    enum { MOST = 1000 };
    static fl_vec3 outline_of[MOST + 5];
    lab l;
    char what[80];
    int m = 0;
    lab_start(&l);
    lab_set(&l, "run.gravity=0 -9.81 0");
    lab_set(&l, "contact.friction=0.3");
    lab_setf(&l, "contact.restitution=%g", restitution);
    lab_set(&l, "material.ice.young=1 GPa");
    lab_set(&l, "material.steel.young=1 GPa");
    lab_set(&l, "run.safety=0.2");
    outline_of[m++] = v3(-R - 0.5, 0, 0), outline_of[m++] = v3(-R - 0.5, -R - 0.5, 0);
    outline_of[m++] = v3(R + 0.5, -R - 0.5, 0), outline_of[m++] = v3(R + 0.5, 0, 0);
    for (int k = n; k >= 0; k--) outline_of[m++] = v3(-R * cos(k * dphi), -R * sin(k * dphi), 0);
    lab_prism(&l, m, outline_of, -2, 2);
    int facet = n / 4;
    const double middle = (facet + 0.5) * dphi, away = R * cos(0.5 * dphi) - r;
    lab_sphere(&l, v3(-away * cos(middle), -away * sin(middle), 0), r, v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 0.0);
    const fl_bodies *b = &l.w.b;
    const double start = b->m[0] * G * (b->x[0].y + R - r);
    double corners = 0.0;
    for (;;) {
        if (lab_run(&l, 1)) exit(1);
        const fl_vec3 x = b->x[0], v = b->v[0];
        const double at = atan2(-x.y, -x.x);
        const int now = (int)floor(at / dphi);
        if (now != facet) corners += 0.5 * b->m[0] * v3_norm2(v) * dphi * dphi * abs(now - facet);
        facet = now;
        if (at > 0.5 * PI && v.x * sin(at) - v.y * cos(at) < 0.0) break;
    }
    fl_energy_update(&l.w);
    snprintf(what, sizeof what, "%d facets, restitution %g: loss (corners %.4f)", n, restitution,
             corners / start);
    verify_below("FR7", what, l.w.ledger.damping / start, most * corners / start);
    lab_free(&l);
}

/* A box of 1 m slides without friction over plates of 2 m that bend up by dphi each.  While it bridges a bend
 * it pitches by v dphi/a: its front edge takes up (1/3) m (v dphi)^2/2 as it meets the next plate, and as
 * much as its rear edge follows. */
static void bent_plating(double dphi, double surrogate, double most)
{
    enum { PLATES = 7 };
    const double length = 2.0;
    fl_vec3 top[PLATES + 1], all[PLATES + 3];
    lab l;
    char what[80];
    lab_start(&l);
    lab_set(&l, "run.gravity=0 -9.81 0");
    lab_set(&l, "contact.restitution=0.3");
    lab_set(&l, "material.ice.young=1 GPa");
    lab_set(&l, "material.steel.young=1 GPa");
    lab_set(&l, "run.safety=0.4");
    lab_setf(&l, "contact.surrogate=%g", surrogate);
    double slope = -0.5 * (PLATES - 1) * dphi;
    const fl_vec3 t = v3(cos(slope), sin(slope), 0), n = v3(-sin(slope), cos(slope), 0);
    top[0] = v3(0, 0, 0);
    for (int k = 0; k < PLATES; k++, slope += dphi)
        top[k + 1] = v3_madd(top[k], length, v3(cos(slope), sin(slope), 0));
    all[0] = v3(top[0].x, -2, 0), all[1] = v3(top[PLATES].x, -2, 0);
    for (int k = 0; k <= PLATES; k++) all[2 + k] = top[PLATES - k];
    lab_prism(&l, PLATES + 3, all, -2, 2);
    lab_box(&l, v3_madd(v3_scale(0.75 * length, t), 0.1, n), v3(0.5, 0.1, 0.5), 0.02,
            q_of_vector(v3(0, 0, -0.5 * (PLATES - 1) * dphi)), v3_scale(3.0, t), v3(0, 0, 0));
    lab_make(&l, 0.0);
    const fl_bodies *b = &l.w.b;
    const double start = 0.5 * b->m[0] * 9.0;
    double corners = 0.0;
    for (int at = 0; at < PLATES - 1 || b->x[0].x < top[PLATES - 1].x + 0.45 * length;) {
        if (lab_run(&l, 1)) exit(1);
        if (b->x[0].x <= top[at + 1].x) continue;
        corners += b->m[0] * v3_norm2(b->v[0]) * dphi * dphi / 3.0;
        at++;
    }
    fl_energy_update(&l.w);
    snprintf(what, sizeof what, "box over bends of %g rad%s: loss (corners %.4f)", dphi,
             surrogate > 0.0 ? ", surrogates" : "", corners / start);
    verify_below("FR8", what, l.w.ledger.damping / start, most * corners / start);
    lab_free(&l);
}

/* --- floes along a wall and hulls ---------------------------------------------------------------------- */

typedef struct {
    int facets;
    double length, bend;              /* of a facet [m]; from one to the next, > 0: hollow [rad] */
    int from;                         /* facet on whose middle the floe starts */
    double yaw, speed, spin;          /* of the floe against it */
    double friction, duration, young; /* of ice and steel [GPa] */
} voyage;

typedef struct {
    fl_vec3 x;
    double heading, loss, corners; /* corners: what the edges of the floe take at hollow bends */
} arrival;

/* A floe 20 x 10 x 0.6 m is pushed with 0.5 m/s2 on a faceted hull along which it drags and yaws. */
static arrival sail(const voyage *c, double step)
{
    enum { MOST = 20 };
    const double a = 20.0, b = 10.0;
    fl_vec3 top[MOST + 1], all[MOST + 3];
    double slope = -0.5 * (c->facets - 1) * c->bend;
    lab l;
    lab_start(&l);
    lab_set(&l, "run.gravity=0 -0.5 0");
    lab_setf(&l, "contact.friction=%g", c->friction);
    lab_set(&l, "contact.restitution=0.3");
    lab_setf(&l, "material.ice.young=%g GPa", c->young);
    lab_setf(&l, "material.steel.young=%g GPa", c->young);
    lab_set(&l, "run.safety=0.4");
    top[0] = v3(0, 0, 0);
    for (int k = 0; k < c->facets; k++, slope += c->bend)
        top[k + 1] = v3_madd(top[k], c->length, v3(cos(slope), sin(slope), 0));
    all[0] = v3(top[0].x, -20, 0), all[1] = v3(top[c->facets].x, -20, 0);
    for (int k = 0; k <= c->facets; k++) all[2 + k] = top[c->facets - k];
    lab_prism(&l, c->facets + 3, all, -3, 3);
    slope = (c->from - 0.5 * (c->facets - 1)) * c->bend;
    const fl_vec3 t = v3(cos(slope), sin(slope), 0), n = v3(-sin(slope), cos(slope), 0);
    const fl_vec3 x = v3_madd(v3_lerp(top[c->from], top[c->from + 1], 0.5),
                              0.5 * (b * cos(c->yaw) + a * sin(fabs(c->yaw))), n);
    lab_box(&l, x, v3(0.5 * a, 0.5 * b, 0.3), 0.1, q_of_vector(v3(0, 0, slope + c->yaw)),
            v3_scale(c->speed, t), v3(0, 0, c->spin));
    lab_make(&l, 0.0);
    l.w.dt *= step;
    const fl_bodies *o = &l.w.b;
    arrival r = {.heading = c->yaw};
    /* (1/4 + k^2/a^2) m (v dphi)^2/2 as the front edge meets a facet and as the rear edge leaves the last */
    const double each = 0.5 * o->m[0] * c->bend * c->bend * (0.25 + gyration2_of(o) / (a * a));
    int front = -1, rear = -1;
    for (int64_t s = (int64_t)(c->duration / l.w.dt + 0.5); s > 0; s--) {
        if (lab_run(&l, 1)) exit(1);
        r.heading += l.w.dt * o->w[0].z;
        int now[2] = {0, 0};
        for (int k = 1; k < c->facets; k++)
            now[0] += o->x[0].x + 0.5 * a > top[k].x, now[1] += o->x[0].x - 0.5 * a > top[k].x;
        if (front >= 0) r.corners += each * v3_norm2(o->v[0]) * (now[0] - front + now[1] - rear);
        front = now[0], rear = now[1];
    }
    fl_energy_update(&l.w);
    r.x = o->x[0];
    r.loss = l.w.ledger.damping / (0.5 * o->m[0] * c->speed * c->speed);
    r.corners /= 0.5 * o->m[0] * c->speed * c->speed;
    lab_free(&l);
    return r;
}

static void floes_along_hulls(void)
{
    const voyage wall = {1, 90.0, 0.0, 0, 0.1, 2.0, 0.1, 0.3, 3.0, 1.0},
                 hull = {14, 6.0, -0.03, 3, 0.0, 3.0, 0.0, 0.1, 8.0, 1.0},
                 hollow = {6, 30.0, 0.05, 0, 0.0, 3.0, 0.0, 0.0, 40.0, 10.0};
    verify_note("a floe 20 x 10 m drags and yaws along a wall, then over a hull of 14 facets: step halved");
    for (int k = 0; k < (verify_quick() ? 1 : 2); k++) {
        const voyage *c = k ? &hull : &wall;
        const arrival one = sail(c, 1.0), half = sail(c, 0.5);
        verify_row("FR9", "heading [rad]", one.heading, half.heading, 1e-4, VERIFY_ABS);
        verify_row("FR9", "way [m]", one.x.x, half.x.x, 1e-3, VERIFY_ABS);
    }
    if (verify_quick()) return;
    voyage soft = hollow;
    soft.young = 1.0;
    const arrival r = sail(&hollow, 1.0), s = sail(&soft, 1.0);
    char what[80];
    snprintf(what, sizeof what, "along a hollow hull, 0.05 rad, 10 GPa: loss (corners %.4f)", r.corners);
    verify_below("FR9", what, r.loss, 1.2 * r.corners);
    verify_note("ice of 1 GPa sinks in at its edges as it leaves a face: its weight is laid down there anew");
    snprintf(what, sizeof what, "the same, 1 GPa: loss (corners %.4f)", s.corners);
    verify_below("FR9", what, s.loss, 1.5 * s.corners);
}

static void corners_of_meshes(void)
{
    static const int FACETS[] = {60, 120, 240, 480, 30, 960};
    verify_note("a ball in a trough of flat facets: at most 1.2 times what its corners take");
    for (int k = 0; k < (verify_quick() ? 3 : 6); k++) trough(FACETS[k], 0.1, 1.2);
    if (!verify_quick()) trough(120, 0.3, 1.2);
    verify_note("a box on plating, the first touch included");
    bent_plating(0.05, 0.0, 1.2);
    bent_plating(0.05, 1e-3, 1.2);
    if (!verify_quick()) bent_plating(0.1, 0.0, 1.2), bent_plating(0.02, 0.0, 1.2);
}

int main(void)
{
    verify_begin("friction of faces");
    plates();
    off_centre_push();
    corners_of_meshes();
    floes_along_hulls();
    return verify_end();
}
