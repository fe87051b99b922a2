/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rigid bodies: free rotation, the heavy top, impacts of boxes, sliding, standing, rocking, and the energy
 * ledger. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "base/rng.h"
#include "body/integrate.h"
#include "law/material.h"
#include "sim/energy_balance.h"
#include "support/small_world.h"
#include "support/shapes.h"
#include "support/verify.h"

#define G 9.81

static const char *label(const char *what, double number)
{
    static char line[120];
    snprintf(line, sizeof line, what, number);
    return line;
}

static const char *label_of(const char *what, const char *word)
{
    static char line[120];
    snprintf(line, sizeof line, what, word);
    return line;
}

/* --- no contacts: floor `body` alone ------------------------------------------------------------------ */

static int one_body(fl_bodies *b, fl_vec3 I, fl_vec3 w, double m)
{
    fl_err err = {0};
    if (fl_bodies_alloc(b, 1, 1, &err)) return -1;
    fl_body_set_inertia(b, 0, I);
    b->m[0] = m;
    b->invm[0] = 1.0 / m;
    fl_body_set_spin(b, 0, w);
    return 0;
}

static fl_vec3 body_spin(const fl_bodies *b) { return m3_tmul(fl_body_axes(b, 0), b->w[0]); }

/* A step without forces: fl_drift() leaves the mean spin of the step; the kick restores the spin of L. */
static void free_step(fl_bodies *b, double dt)
{
    fl_drift(b, 0, dt);
    fl_body_update_spin(b, 0);
}

static double relative_difference(fl_vec3 a, fl_vec3 b) { return v3_norm(v3_sub(a, b)); }

/* I of a 10 x 6 x 1 box over its mass, rotating about its middle axis, which is unstable. */
static const fl_vec3 BOX_I = {37.0 / 12.0, 101.0 / 12.0, 136.0 / 12.0}, BOX_W = {0.02, 1.0, 0.02};

static void unstable_spin(void)
{
    const fl_vec3 want = v3(-0.127746288, 0.991717936, 0.091210881);
    const fl_quat turn = {-0.773822665, 0.049757280, -0.630892571, -0.026405680};
    double h[4], error[4];
    for (int k = 0; k < 4; k++) {
        fl_bodies b;
        if (one_body(&b, BOX_I, BOX_W, 1.0)) exit(1);
        const fl_vec3 L0 = b.L[0];
        const int steps = 2000 << k;
        h[k] = 100.0 / steps;
        for (int s = 0; s < steps; s++) free_step(&b, h[k]);
        const fl_vec3 w = body_spin(&b);
        error[k] = relative_difference(w, want);
        if (k == 2) { /* dt = 0.0125 s */
            const fl_quat q = b.q[0];
            const double sign = q.w * turn.w + q.x * turn.x + q.y * turn.y + q.z * turn.z < 0.0 ? -1.0 : 1.0;
            verify_row("V15", "omega_x(100 s), dt = 0.0125 s [rad/s]", w.x, want.x, 1e-4, VERIFY_ABS);
            verify_row("V15", "omega_y [rad/s]", w.y, want.y, 1e-4, VERIFY_ABS);
            verify_row("V15", "omega_z [rad/s]", w.z, want.z, 1e-4, VERIFY_ABS);
            verify_row("V15", "q_w(100 s)", sign * q.w, turn.w, 1e-4, VERIFY_ABS);
            verify_row("V15", "q_x", sign * q.x, turn.x, 1e-4, VERIFY_ABS);
            verify_row("V15", "q_y", sign * q.y, turn.y, 1e-4, VERIFY_ABS);
            verify_row("V15", "q_z", sign * q.z, turn.z, 1e-4, VERIFY_ABS);
        }
        /* the spin of the body computed from its angular momentum, not the stored one */
        const fl_vec3 wi = body_spin(&b), L = m3_mul(fl_body_axes(&b, 0), v3_mul(b.I[0], wi));
        verify_below("V15", "|dL|/L", relative_difference(L, L0) / v3_norm(L0), 1e-12);
        fl_bodies_free(&b);
    }
    verify_order("V15", "omega(100 s) against the step [s]", h, error, 4, 2.0, 0.1);

    /* Spin that contacts use within a step: rotation of the step over its time. */
    for (int k = 0; k < 4; k++) {
        fl_bodies c;
        if (one_body(&c, BOX_I, BOX_W, 1.0)) exit(1);
        error[k] = 0.0;
        for (int s = 0; s * h[k] < 20.0; s++) {
            const fl_quat from = c.q[0];
            fl_drift(&c, 0, h[k]);
            const fl_quat d = q_mul(c.q[0], q_conj(from));
            const double sine = sqrt(d.x * d.x + d.y * d.y + d.z * d.z),
                         each = 2.0 * asin(sine) / sine / h[k];
            error[k] = fmax(error[k], relative_difference(c.w[0], v3(each * d.x, each * d.y, each * d.z)));
        }
        fl_bodies_free(&c);
    }
    verify_order("V15", "mean spin of a step against its rotation [rad/s]", h, error, 4, 2.0, 0.1);

    /* The period of omega, 4 K(k^2)/omega_p: from the times at which omega_x passes through 0 upwards. */
    fl_bodies b;
    if (one_body(&b, BOX_I, BOX_W, 1.0)) exit(1);
    const double dt = 0.0025;
    double before = body_spin(&b).x, first = 0.0, last = 0.0;
    int periods = -1;
    for (int s = 1; s <= 40000; s++) {
        free_step(&b, dt);
        const double x = body_spin(&b).x;
        if (before < 0.0 && x >= 0.0) {
            last = dt * (s - x / (x - before));
            if (++periods == 0) first = last;
        }
        before = x;
    }
    verify_row("V15", "period of omega [s]", (last - first) / periods, 31.6198215, 1e-4, VERIFY_REL);
    fl_bodies_free(&b);
}

static void long_spin(void)
{
    const int64_t steps = verify_quick() ? 1000000 : 10000000;
    fl_bodies b;
    if (one_body(&b, BOX_I, BOX_W, 1.0)) exit(1);
    const fl_vec3 L0 = b.L[0];
    const double E0 = fl_body_kinetic_energy(&b, 0);
    double worst = 0.0;
    for (int64_t s = 0; s < steps; s++) {
        free_step(&b, 0.02);
        worst = fmax(worst, fabs(fl_body_kinetic_energy(&b, 0) / E0 - 1.0));
    }
    const fl_quat q = b.q[0];
    const fl_vec3 L = m3_mul(fl_body_axes(&b, 0), v3_mul(b.I[0], body_spin(&b)));
    verify_note("%lld steps of 0.02 s", (long long)steps);
    verify_below("V16", "largest |dE|/E during the run", worst, 1e-5);
    verify_below("V16", "|dE|/E at the end", fabs(fl_body_kinetic_energy(&b, 0) / E0 - 1.0), 1e-5);
    verify_below("V16", "|dL|/L at the end", relative_difference(L, L0) / v3_norm(L0), 1e-10);
    verify_row("V16", "|q| at the end", sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z), 1.0, 1e-14,
               VERIFY_REL);
    fl_bodies_free(&b);
}

/* A heavy top with moments (1, 1, 1/2) and the potential 2 z.e3.  Body axes are sorted by ascending moment:
 * e3 of the top is x of the body, e1 is y, e2 is z. */
static void heavy_top(void)
{
    const double end = 10.0;
    const fl_vec3 want = v3(-0.226660905, -0.240728253, 8.0);
    double h[4], error[4];
    for (int k = 0; k < 4; k++) {
        fl_bodies b;
        if (one_body(&b, v3(0.5, 1, 1), v3(0, 0, 0), 1.0)) exit(1);
        const double tilt = 0.3;
        const int steps = 2500 << k;
        h[k] = end / steps;
        const fl_vec3 e1 = v3(1, 0, 0), e2 = v3(0, cos(tilt), sin(tilt)), e3 = v3(0, -sin(tilt), cos(tilt));
        b.q[0] = q_of_matrix((fl_mat3){{{e3.x, e1.x, e2.x}, {e3.y, e1.y, e2.y}, {e3.z, e1.z, e2.z}}});
        fl_body_update_spin(&b, 0);
        fl_body_set_spin(&b, 0, v3_madd(v3_scale(0.3, e1), 8.0, e3));
        const double E0 = fl_body_kinetic_energy(&b, 0) + 2.0 * e3.z;
        double worst = 0.0;
        b.t[0] = v3_scale(-2.0, v3_cross(e3, v3(0, 0, 1)));
        for (int s = 0; s < steps; s++) {
            fl_kick(&b, 0, 0.5 * h[k]);
            free_step(&b, h[k]);
            b.t[0] = v3_scale(-2.0, v3_cross(m3_col(fl_body_axes(&b, 0), 0), v3(0, 0, 1)));
            fl_kick(&b, 0, 0.5 * h[k]);
            worst = fmax(
                worst,
                fabs((fl_body_kinetic_energy(&b, 0) + 2.0 * m3_col(fl_body_axes(&b, 0), 0).z) / E0 - 1.0));
        }
        const fl_vec3 s = body_spin(&b), w = v3(s.y, s.z, s.x);
        error[k] = relative_difference(w, want);
        if (k == 2) { /* dt = 0.001 s */
            verify_row("V18", "omega_1(10 s) of the top, dt = 0.001 s [rad/s]", w.x, want.x, 1e-5,
                       VERIFY_ABS);
            verify_row("V18", "omega_2 [rad/s]", w.y, want.y, 1e-5, VERIFY_ABS);
            verify_row("V18", "omega_3 [rad/s]", w.z, want.z, 1e-5, VERIFY_ABS);
            verify_below("V18", "largest |dE|/E", worst, 1e-6);
        }
        fl_bodies_free(&b);
    }
    verify_order("V18", "omega(10 s) against the step [s]", h, error, 4, 2.0, 0.1);
}

/* --- box against box ---------------------------------------------------------------------------------- */

static void total_momenta(const lab *l, fl_vec3 *p, fl_vec3 *J, double *ps, double *Js)
{
    const fl_bodies *b = &l->w.b;
    *p = *J = v3(0, 0, 0);
    *ps = *Js = 0.0;
    for (int32_t i = 0; i < b->n; i++) {
        const fl_vec3 mv = v3_scale(b->m[i], b->v[i]), orbit = v3_cross(b->x[i], mv);
        *p = v3_add(*p, mv);
        *J = v3_add(*J, v3_add(b->L[i], orbit));
        *ps += v3_norm(mv);
        *Js += v3_norm(b->L[i]) + v3_norm(orbit);
    }
}

/* Two boxes that fly towards one another with random rotation and spin; k numbers the case. */
static void two_boxes(lab *l, int k, const char *law)
{
    fl_rng g = fl_rng_of(7, k, FL_RNG_TEST);
    const double y = 0.3 * fl_rng_normal(&g), z = 0.3 * fl_rng_normal(&g);
    const fl_quat qa = shape_rotation(&g), qb = shape_rotation(&g);
    fl_vec3 w[2];
    for (int c = 0; c < 2; c++) {
        w[c].x = fl_rng_normal(&g);
        w[c].y = fl_rng_normal(&g);
        w[c].z = fl_rng_normal(&g);
    }
    lab_start(l);
    lab_setf(l, "contact.law=%s", law);
    lab_set(l, "material.ice.young=10 MPa");
    lab_box(l, v3(-1.6, 0, 0), v3(1, .5, .5), 0.1, qa, v3(1, 0, 0), w[0]);
    lab_box(l, v3(1.6, y, z), v3(1, .5, .5), 0.1, qb, v3(-1, 0, 0), w[1]);
}

static void box_impacts(void)
{
    enum { LEVELS = 4 };
    const int hits = verify_quick() ? 40 : 200, levels = verify_quick() ? 3 : LEVELS;
    double h[LEVELS], mean[LEVELS] = {0}, worst[LEVELS] = {0}, dp = 0.0, dJ = 0.0;
    int touched = 0;
    for (int k = 0; k < hits; k++) {
        for (int d = 0; d < levels; d++) {
            lab l;
            fl_vec3 p0, J0, p, J;
            double ps, Js;
            two_boxes(&l, k, "patch");
            lab_make(&l, 0);
            l.w.dt *= 4.0 / (1 << d); /* from 0.4 of the critical step downwards */
            total_momenta(&l, &p0, &J0, &ps, &Js);
            const double E0 = lab_energy(&l);
            h[d] = 0.4 / (1 << d); /* run.safety: the fraction of the critical step */
            if (lab_run(&l, (int64_t)(2.0 / l.w.dt))) exit(1);
            const double e = fabs(lab_energy(&l) / E0 - 1.0);
            mean[d] += e / hits;
            worst[d] = fmax(worst[d], e);
            total_momenta(&l, &p, &J, &ps, &Js);
            dp = fmax(dp, relative_difference(p, p0) / ps);
            dJ = fmax(dJ, relative_difference(J, J0) / Js);
            touched += d == 0 && l.w.contact_steps > 0;
            lab_free(&l);
        }
    }
    verify_note("%d pairs of boxes, %d of them meet; run.safety, mean and worst |dE|/E:", hits, touched);
    for (int d = 0; d < levels; d++) verify_note("  %6.3f %12.3e %12.3e", h[d], mean[d], worst[d]);
    verify_true("V22", "at least three quarters of them meet", 4 * touched >= 3 * hits);
    /* a vertex contact starts as s^(3/2), which gives an error of h^(5/2) in its first step */
    verify_order("V22", "mean |dE|/E against run.safety", h, mean, levels, 2.5, 0.3);
    verify_below("V23", "largest |dp| over the sum of |p|", dp, 1e-12);
    verify_below("V23", "largest |dJ| over the sum of |J|", dJ, 1e-12);
}

/* --- block on an incline ------------------------------------------------------------------------------ */

/* A block rests on the plane z = 0 under a gravity that is inclined by `slope`.  It starts at its
 * equilibrium overlap. */
static void on_slope(lab *l, fl_vec3 half, double radius, double slope, double friction, double restitution)
{
    lab_start(l);
    lab_set(l, "boundary.min=none none 0");
    lab_set(l, "material.ice.young=100 MPa");
    lab_setf(l, "run.gravity=%.17g 0 %.17g", G * sin(slope), -G * cos(slope));
    lab_setf(l, "contact.friction=%.17g", friction);
    lab_setf(l, "contact.restitution=%.17g", restitution);
    const double area = 4.0 * (half.x - radius) * (half.y - radius),
                 weight = 8.0 * half.x * half.y * half.z * 900.0 * G * cos(slope),
                 modulus = fl_material_modulus((fl_elastic_constants){100e6, 0.3},
                                               (fl_elastic_constants){INFINITY, 0.0}),
                 overlap = weight / fl_material_punch(modulus, area);
    lab_box(l, v3(0, 0, half.z - overlap), half, radius, q_one(), v3(0, 0, 0), v3(0, 0, 0));
}

static void slide_down_slope(void)
{
    lab l;
    on_slope(&l, v3(0.5, 0.5, 0.25), 0.05, PI / 6.0, 0.3, 0.3);
    lab_make(&l, 0);
    const int64_t steps = (int64_t)ceil(1.0 / l.w.dt);
    l.w.dt = 1.0 / (double)steps;
    if (lab_run(&l, steps)) exit(1);
    verify_row("V24", "path in 1 s at mu = 0.3 down 30 degrees [m]", l.w.b.x[0].x, 1.178144, 1e-3,
               VERIFY_REL);
    verify_row("V24", "speed after 1 s [m/s]", l.w.b.v[0].x, 2.35629, 1e-3, VERIFY_REL);
    verify_row("V24", "way aside over way", l.w.b.x[0].y / l.w.b.x[0].x, 0.0, 1e-9, VERIFY_ABS);
    lab_free(&l);
}

/* Position of the middle of the base along the slope. */
static double base_position(const lab *l, double height, fl_vec3 down)
{
    return l->w.b.x[0].x + height * m3_mul(fl_body_axes(&l->w.b, 0), down).x;
}

/* sudden: the slope is there from the start without deflection of the tangential springs, so that the block
 * starts to oscillate.  Otherwise the plane is tilted from level within a second. */
static void stand_on_slope(int sudden, double end)
{
    const double slope = PI / 6.0, height = 0.1, mu = 0.6;
    lab l;
    on_slope(&l, v3(0.5, 0.5, height), 0.05, sudden ? slope : 0.0, mu, 0.3);
    lab_make(&l, 0);
    const fl_vec3 down = m3_tmul(fl_body_axes(&l.w.b, 0), v3(0, 0, -1));
    const double kt = 0.824 * 2.0 * l.w.pair[0].contact->k * 0.9, most = mu * l.w.b.m[0] * G / kt,
                 swing = G * sin(slope) * sqrt(l.w.b.m[0] / kt), start = base_position(&l, height, down);
    const int64_t tilting = sudden ? 0 : (int64_t)(1.0 / l.w.dt), half = (int64_t)(0.5 * end / l.w.dt);
    for (int64_t k = 1; k <= tilting; k++) {
        const double a = slope * (double)k / (double)tilting;
        l.w.gravity = v3(G * sin(a), 0, -G * cos(a));
        if (lab_run(&l, 1)) exit(1);
    }
    if (lab_run(&l, half)) exit(1);
    const fl_vec3 middle = l.w.b.x[0];
    if (lab_run(&l, half)) exit(1);
    const char *how = sudden ? "sudden" : "tilted";
    verify_note("%s, %g s, %lld steps; mu m g/kt = %.3e m, oscillation on the springs alone at %.2e m/s", how,
                end, (long long)l.w.step, most, swing);
    const double creep = base_position(&l, height, down) - start;
    if (sudden)
        verify_note("sudden: the base stops after %.3e m, of which %.3e m is in the springs", creep,
                    sin(slope) / mu * most);
    else verify_below("V25", "creep of the base, mu = 0.6 at 30 degrees [m]", fabs(creep), most);
    verify_below("V25", label_of("%s: creep in the second half over mu m g/kt", how),
                 relative_difference(l.w.b.x[0], middle) / most, 1e-6);
    verify_below("V25", label_of("%s: speed at the end over that of the springs", how),
                 v3_norm(l.w.b.v[0]) / swing, 1e-6);
    lab_free(&l);
}

static void stand_on_slopes(void)
{
    stand_on_slope(0, verify_quick() ? 6.0 : 60.0);
    stand_on_slope(1, verify_quick() ? 6.0 : 60.0);
}

/* --- rocking ------------------------------------------------------------------------------------------ */

/* A block of 2b x 2h = 0.5 x 2 m, tilted about its right foot at x = 0; depth 0.5 m.
 *     bars  it stands on two bars with its outermost 2 mm, not on a plane.  Housner's landing is an
 *           impulse at the other foot; a base that closes over its whole width is hit along all of it, and
 *           loses less */
static void rocking(lab *l, double tilt, double restitution, int bars)
{
    const double b = 0.25, h = 1.0, r = 1e-4, foot = 2e-3;
    const fl_quat q = q_of_vector(v3(0, tilt, 0));
    /* the lowest core corner stands a radius above the plane */
    const fl_vec3 corner = q_rotate(q, v3(b - r, 0, -(h - r)));
    lab_start(l);
    if (bars) {
        lab_wall(l, v3(-foot, -1, -0.1), v3(0.1, 1, 0), 1);
        lab_wall(l, v3(-2.0 * b - 0.1, -1, -0.1), v3(-2.0 * (b - r) + foot, 1, 0), 1);
    } else {
        lab_set(l, "boundary.min=none none 0");
    }
    lab_set(l, "material.ice.young=1 GPa");
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "contact.friction=1000");
    lab_setf(l, "contact.restitution=%.17g", restitution);
    lab_box(l, v3(-corner.x, 0, r - corner.z), v3(b, b, h), r, q, v3(0, 0, 0), v3(0, 0, 0));
}

static double tilt_of(const fl_bodies *b, const fl_vec3 up) /* about y, of the axis that was up */
{
    const fl_vec3 a = m3_mul(fl_body_axes(b, 0), up);
    return atan2(a.x, a.z);
}

/* Kinetic and potential energy less that of the block at rest upright: the energy of its rotation. */
static double rotation_energy(lab *l, double upright) { return lab_energy(l) - upright; }

/* The block falls from a tilt until it stands upright.  Returns the time of that; *falling is the energy of
 * its rotation half-way there, which is its energy before it lands. */
static double fall_upright(lab *l, double tilt, int bars, fl_vec3 *up, double *upright, double *falling)
{
    rocking(l, tilt, 0.01, bars);
    lab_make(l, 0);
    *up = m3_tmul(fl_body_axes(&l->w.b, 0), q_rotate(q_of_vector(v3(0, tilt, 0)), v3(0, 0, 1)));
    *upright = l->w.b.m[0] * G * 1.0; /* its centre at half of 2 m */
    double before = tilt, now = tilt;
    while (now > 0.0) {
        before = now;
        if (lab_run(l, 1)) exit(1);
        now = tilt_of(&l->w.b, *up);
        if (before > 0.5 * tilt && now <= 0.5 * tilt) *falling = rotation_energy(l, *upright);
    }
    return l->w.dt * ((double)l->w.step - now / (now - before));
}

static void rocking_block(void)
{
    const double ratio[] = {0.5, 0.2, 0.8}, period[] = {1.97174, 1.03777, 3.43221}, alpha = 0.244979;
    for (int k = 0; k < (verify_quick() ? 1 : 3); k++) {
        for (int bars = 0; bars < 2; bars++) {
            lab l;
            fl_vec3 up;
            double upright, falling = 0.0;
            const double t = fall_upright(&l, ratio[k] * alpha, bars, &up, &upright, &falling);
            if (!bars)
                verify_row("V19", label("period of rocking from %.1f alpha [s]", ratio[k]), 4.0 * t,
                           period[k], 0.01, VERIFY_REL);
            /* V20: the other foot lands and takes (1 - (1 - 3/2 sin^2 alpha)^2) of the energy.  Speeds
             * before and after follow from the energy of rotation, which the weight does not change. */
            if (lab_run(&l, (int64_t)(0.05 / l.w.dt))) exit(1);
            const double kept = sqrt(rotation_energy(&l, upright) / falling);
            if (bars)
                verify_row("V20", label("speed after over before landing, from %.1f alpha", ratio[k]), kept,
                           0.911765, 0.02, VERIFY_REL);
            else verify_note("on a plane, not on bars, the speed after over before landing is %.4f", kept);
            lab_free(&l);
        }
    }
}

/* --- the ledger --------------------------------------------------------------------------------------- */

/* A box falls on a plane with spin, bounces and slides to rest: largest residual on the way over the
 * initial energy.  `fine` divides the automatic step. */
static double ledger_residual(double fine, double end, double *step)
{
    lab l;
    lab_start(&l);
    lab_set(&l, "boundary.min=none none 0");
    lab_set(&l, "material.ice.young=10 MPa");
    lab_set(&l, "run.gravity=9.81");
    lab_set(&l, "contact.friction=0.3");
    lab_set(&l, "contact.restitution=0.5");
    lab_box(&l, v3(0, 0, 0.8), v3(0.5, 0.4, 0.3), 0.05, q_of_vector(v3(0.3, 0.2, 0.1)), v3(2, 0.5, 0),
            v3(1, 2, 3));
    lab_make(&l, 0);
    *step = l.w.dt /= fine;
    double most = 0.0;
    const int64_t every = (int64_t)(end / l.w.dt / 500);
    for (int k = 0; k < 500; k++) {
        if (lab_run(&l, every)) exit(1);
        fl_energy_update(&l.w);
        most = fmax(most, fabs(l.w.ledger.residual));
    }
    const fl_ledger *g = &l.w.ledger;
    verify_note(
        "step %.2e s: of %.0f J friction took %.2f, damping %.2f; %.2f potential, %.1e kinetic are left",
        *step, g->start, g->friction_now, g->damping_now, g->gravity + g->elastic, g->kinetic);
    const double r = most / fabs(g->start);
    lab_free(&l);
    return r;
}

static void ledger_of_bounces(void)
{
    enum { LEVELS = 4 };
    double h[LEVELS], r[LEVELS];
    for (int k = 0; k < LEVELS; k++) r[k] = ledger_residual(2 << k, 2.0, &h[k]);
    /* the paths of a bouncing body diverge at any change of the step, so the errors scatter about their
     * order */
    verify_order("V29", "largest residual of the ledger against the step [s]", h, r, LEVELS, 2.0, 0.5);
    verify_below("V29", "largest residual over the input energy", r[LEVELS - 1], 1e-6);
}

int main(void)
{
    verify_begin("rigid bodies");
    unstable_spin();
    long_spin();
    heavy_top();
    rocking_block();
    box_impacts();
    slide_down_slope();
    stand_on_slopes();
    ledger_of_bounces();
    return verify_end();
}
