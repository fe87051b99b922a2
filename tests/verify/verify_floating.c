/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Floating bodies in the solver against closed forms. */
#include <math.h>
#include <stdio.h>
#include "base/pi.h"
#include "sim/energy_balance.h"
#include "support/small_world.h"
#include "support/near.h"
#include "support/verify.h"

#define ZERO v3(0, 0, 0)
#define G 9.81
#define DRAFT (900.0 / 1025.0)    /* of 10 x 10 x 1 m of ice */
#define WETTED (100 + 40 * DRAFT) /* [m2]                    */
#define REST (0.5 - DRAFT)        /* its centre at rest [m]  */

/* The floe of V48: 10 x 10 x 1 m, ice of 900 in water of 1025 kg/m3; no drag unless a key sets it. */
static void make_floe(lab *l, double z, fl_quat q, fl_vec3 v, fl_vec3 spin)
{
    lab_start(l);
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "water.density=1025");
    lab_set(l, "water.drag_force_coef=0");
    lab_set(l, "water.drag_moment_coef=0");
    lab_box(l, v3(0, 0, z), v3(5, 5, 0.5), 0.05, q, v, spin);
}

/* Mean period of y about 0 over `cycles` cycles: times of upward crossings, interpolated linearly between
 * steps. */
static double mean_period(lab *l, int cycles, double (*y)(const fl_world *))
{
    double first = NAN, before = y(&l->w);
    for (int seen = -1;;) {
        if (lab_run(l, 1)) return NAN;
        const double now = y(&l->w);
        if (before < 0.0 && now >= 0.0) {
            const double t = l->w.dt * ((double)l->w.step - now / (now - before));
            if (++seen == 0) first = t;
            if (seen == cycles) return (t - first) / cycles;
        }
        before = now;
    }
}

static double heave(const fl_world *w) { return w->b.x[0].z - REST; }
static double pitch(const fl_world *w) { return fl_body_axes(&w->b, 0).m[0][2]; }
static double roll(const fl_world *w) { return fl_body_axes(&w->b, 0).m[2][1]; }

static void equilibrium_draft(void)
{
    const fl_vec3 o = v3(0, 0, 0);
    const double omega = sqrt(G / DRAFT), dt = 2.0 * sin(PI / 1000) / omega;
    lab l;
    make_floe(&l, REST, q_one(), o, o);
    lab_make(&l, 1e-3);
    lab_run(&l, 10000);
    verify_row("V48", "draft after 1e4 steps, started at it [m]", 0.5 - l.w.b.x[0].z, DRAFT, 1e-9,
               VERIFY_ABS);
    verify_row("V48", "freeboard [m]", 0.5 + l.w.b.x[0].z, 0.1219512195121951, 1e-9, VERIFY_ABS);
    verify_row("V48", "lift over weight", l.w.sea.buoyancy[0] / (90000 * G), 1.0, 1e-13, VERIFY_ABS);
    lab_free(&l);

    verify_note("released 1 mm and 0.1 m above: with this step the period of Verlet's method is 1000 steps");
    for (int k = 0; k < 2; k++) {
        double sum = 0.0;
        make_floe(&l, REST + (k ? 0.1 : 1e-3), q_one(), o, o);
        lab_make(&l, dt);
        for (int s = 0; s < 3000; s++) {
            lab_run(&l, 1);
            sum += l.w.b.x[0].z;
        }
        verify_row("V48", "mean draft over 3 periods [m]", 0.5 - sum / 3000, DRAFT, 1e-9, VERIFY_ABS);
        lab_free(&l);
    }
}

static void heave_period(void)
{
    const fl_vec3 o = v3(0, 0, 0);
    const double T = 2 * PI * sqrt(DRAFT / G);
    double h[4], late[4], energy[4];
    lab l;
    make_floe(&l, REST + 0.05, q_one(), o, o);
    lab_make(&l, T / 200);
    verify_row("V49", "period of heave, no added mass [s]", mean_period(&l, 10, heave), T, 1e-3, VERIFY_REL);
    lab_free(&l);
    for (int k = 0; k < 4; k++) {
        const int steps = 20 << k;
        h[k] = T / steps;
        make_floe(&l, REST + 0.05, q_one(), o, o);
        lab_make(&l, h[k]);
        const double start = lab_energy(&l);
        energy[k] = 0.0;
        for (int s = 0; s < 3 * steps; s++) { /* to a time of largest speed */
            lab_run(&l, 1);
            energy[k] = fmax(energy[k], fabs(lab_energy(&l) - start));
        }
        for (int s = 0; s < steps / 4; s++) lab_run(&l, 1);
        late[k] = fabs(heave(&l.w)) / 0.05;
        energy[k] /= 0.5 * 1025 * G * 100 * 0.05 * 0.05;
        lab_free(&l);
    }
    verify_order("V49", "heave after 3.25 periods over the amplitude", h, late, 4, 2.0, 0.1);
    verify_order("V29", "energy, largest error over the initial energy", h, energy, 4, 2.0, 0.1);
}

static void added_mass(void)
{
    static const double Ca[2] = {0.5, 1.0}, listed[2] = {2.302239, 2.658396};
    for (int k = 0; k < 2; k++) {
        lab l;
        const double T = 2 * PI * sqrt(DRAFT * (1 + Ca[k]) / G);
        make_floe(&l, REST + 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
        lab_setf(&l, "water.added_mass=0 0 %g", Ca[k]);
        lab_make(&l, T / 400);
        const double lift = l.w.sea.buoyancy[0], got = mean_period(&l, 10, heave);
        verify_row("V49", k ? "added mass 1: period of heave [s]" : "added mass 0.5: period of heave [s]",
                   got, T, 1e-4, VERIFY_REL);
        verify_row("V49", "  as listed", got, listed[k], 1e-3, VERIFY_REL);
        verify_row("V49", "  weight and buoyancy are unchanged", lift + l.w.b.m[0] * -G,
                   1025 * G * 100 * (DRAFT - 0.05) - 90000 * G, 1e-12 * lift, VERIFY_ABS);
        lab_free(&l);
    }
    lab l;
    make_floe(&l, REST, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_set(&l, "water.added_mass=auto");
    lab_set(&l, "water.added_inertia=auto");
    lab_make(&l, 0.01);
    const double a = 10 / sqrt(PI);
    verify_row("V49", "auto: heave over the displaced mass, 4/3pi a/d", l.w.b.added_mass[0].z / 90000,
               4 / (3 * PI) * a / DRAFT, 1e-12, VERIFY_REL);
    verify_row("V49", "auto: surge", l.w.b.added_mass[0].x / 90000, 0.1, 1e-12, VERIFY_REL);
    verify_row("V50", "auto: roll, 8/45 rho a^5 [kg m2]", l.w.b.I[0].x - 90000 * 101 / 12.0,
               8 / 45.0 * 1025 * pow(a, 5), 1e-9, VERIFY_REL);
    lab_free(&l);
}

/* A block that is higher than it is wide: no horizontal direction is preferred. */
static void added_mass_of_upright_block(void)
{
    double along = 0.0, up = 0.0, roll = 0.0;
    for (int k = 0; k < 4; k++) {
        lab l;
        lab_start(&l);
        lab_set(&l, "water.added_mass=auto");
        lab_set(&l, "water.added_inertia=auto");
        lab_box(&l, ZERO, v3(0.5, 0.5, 0.6), 0.05, q_of_vector(v3(0, 0, 0.37 * k)), ZERO, ZERO);
        lab_make(&l, 0.01);
        const fl_bodies *b = &l.w.b;
        const double a = sqrt(1 / PI), angle = 0.7 * k;
        const fl_vec3 e = v3(cos(angle), sin(angle), 0), z = v3(0, 0, 1);
        along = fmax(along, fabs(v3_dot(e, fl_body_momentum(b, 0, e)) / (1.1 * b->m[0]) - 1));
        up = fmax(up,
                  fabs((v3_dot(z, fl_body_momentum(b, 0, z)) - b->m[0]) / (4 / 3.0 * 1025 * a * a * a) - 1));
        const double own = b->m[0] * (1 + 1.44) / 12, water = 8 / 45.0 * 1025 * pow(a, 5);
        roll = fmax(roll, fabs(1 / v3_dot(e, fl_body_apply_inverse_inertia(b, 0, e)) / (own + water) - 1));
        lab_free(&l);
    }
    verify_below("V49", "auto, a block of 1 x 1 x 1.2 m turned about z: surge, error in any direction", along,
                 1e-12);
    verify_below("V49", "  heave, 4/3 rho a^3", up, 1e-12);
    verify_below("V50", "  roll, 8/45 rho a^5, about any axis along the water", roll, 1e-12);
}

/* A box far from all others, with added mass. */
static void make_free_body(lab *l, fl_quat q, fl_vec3 v, fl_vec3 spin, const char *current)
{
    lab_start(l);
    lab_set(l, "water.drag_force_coef=0");
    lab_set(l, "water.drag_moment_coef=0");
    lab_set(l, "water.added_mass=0.1 0.3 1.5");
    lab_setf(l, "water.current=%s", current);
    lab_box(l, v3(0, 0, -50), v3(5, 3, 0.5), 0.05, q, v, spin);
}

/* Kirchhoff's equations: free motion of a body whose mass differs by direction. */
static void kirchhoff_motion(void)
{
    const fl_quat q = q_of_vector(v3(0.3, -0.5, 0.2));
    const fl_vec3 v = v3(1, 0.4, -0.6), spin = v3(0.02, 0.05, -0.04);
    double h[4], off[4], energy[4], worst_P = 0.0, worst_J = 0.0;
    fl_vec3 at[5];
    for (int k = 4; k >= 0; k--) { /* the finest step first: the reference for the others */
        lab l;
        const double dt = k < 4 ? 0.1 / (1 << k) : 0.1 / 128;
        make_free_body(&l, q, v, spin, "0 0 0");
        lab_make(&l, dt);
        const fl_bodies *b = &l.w.b;
        const fl_vec3 P = fl_body_momentum(b, 0, b->v[0]), J = v3_add(b->L[0], v3_cross(b->x[0], P));
        const double start = fl_body_kinetic_energy(b, 0);
        double far = 0.0;
        for (int s = 0; s < (int)(40 / dt + 0.5); s++) {
            lab_run(&l, 1);
            const fl_vec3 p = fl_body_momentum(b, 0, b->v[0]);
            far = fmax(far, fabs(fl_body_kinetic_energy(b, 0) - start) / start);
            worst_P = fmax(worst_P, v3_norm(v3_sub(p, P)) / v3_norm(P));
            worst_J = fmax(worst_J, v3_norm(v3_sub(v3_add(b->L[0], v3_cross(b->x[0], p)), J)) / v3_norm(J));
        }
        at[k] = b->x[0];
        if (k < 4) {
            h[k] = dt;
            energy[k] = far;
            off[k] = v3_norm(v3_sub(at[k], at[4]));
        }
        lab_free(&l);
    }
    verify_note(
        "a free box with added mass 0.1, 0.3, 1.5 of the displaced, 40 s: it tumbles (Munk's moment)");
    /* one rounding per step: 2^-52 of it at most */
    const double rounding = 2.2e-16 * 40 / (0.1 / 128);
    verify_below("K01", "momentum of body and water, largest change", worst_P, rounding);
    verify_below("K01", "angular momentum about the origin", worst_J, rounding);
    verify_order("K01", "energy, largest change", h, energy, 4, 2.0, 0.2);
    verify_order("K01", "position after 40 s [m]", h, off, 4, 2.0, 0.2);

    verify_note("moving broadside it oscillates: w^2 = P^2 (1/M_a - 1/M_b) / I about the direction of P");
    lab l;
    make_free_body(&l, q_one(), v3(0, 0, 2), v3(0, 1e-5, 0), "0 0 0");
    lab_make(&l, 0.01);
    const double m = 900 * 60.0, P = (m + 1.5 * m) * 2, I = l.w.b.I[0].y;
    const double swing = sqrt(P * P * (1 / (m + 0.1 * m) - 1 / (m + 1.5 * m)) / I);
    verify_row("K02", "period of the swing [s]", mean_period(&l, 5, pitch), 2 * PI / swing, 1e-5, VERIFY_REL);
    lab_free(&l);

    verify_note("in a steady current the motion is that in still water, in the frame of the current");
    lab still, moving;
    make_free_body(&still, q, v, spin, "0 0 0");
    make_free_body(&moving, q, v3_add(v, v3(0.7, -0.3, 0)), spin, "0.7 -0.3 0");
    lab_make(&still, 0.02);
    lab_make(&moving, 0.02);
    lab_run(&still, 2000);
    lab_run(&moving, 2000);
    const fl_vec3 skin_and_form_drag = v3_scale(40, v3(0.7, -0.3, 0));
    verify_below("K03", "apart after 40 s [m]",
                 v3_norm(v3_sub(v3_sub(moving.w.b.x[0], skin_and_form_drag), still.w.b.x[0])), 1e-9);
    fl_energy_update(&moving.w);
    fl_energy_update(&still.w);
    verify_row("K03", "energy residual [J]", moving.w.ledger.residual, still.w.ledger.residual,
               1e-9 * moving.w.ledger.throughput, VERIFY_ABS);
    lab_free(&still);
    lab_free(&moving);
}

static void roll_period(void)
{
    const double tilt = 1e-3, T = 1.895243, GM = 9.429765;
    lab l;
    make_floe(&l, REST, q_of_vector(v3(1e-6, 0, 0)), v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 1e-3);
    verify_row("V50", "GM from the moment at 1e-6 rad [m]", -l.w.b.t[0].x / (90000 * G * 1e-6), GM, 1e-6,
               VERIFY_REL);
    lab_free(&l);
    make_floe(&l, REST, q_of_vector(v3(tilt, 0, 0)), v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, T / 200);
    verify_row("V50", "period of roll, no added inertia [s]", mean_period(&l, 10, roll), T, 2e-3, VERIFY_REL);
    lab_free(&l);
}

/* Large heave and roll together: the residual must fall with the step. */
static void energy_of_tumbling(void)
{
    double h[4], residual[4];
    for (int k = 0; k < 4; k++) {
        lab l;
        h[k] = 0.04 / (1 << k);
        make_floe(&l, REST + 0.3, q_of_vector(v3(0.3, 0.2, 0)), v3(0, 0, 0), v3(0.2, 0, 0.1));
        lab_make(&l, h[k]);
        residual[k] = 0.0;
        for (int s = 0; s < 500 << k; s++) {
            lab_run(&l, 1);
            fl_energy_update(&l.w);
            residual[k] = fmax(residual[k], fabs(l.w.ledger.residual));
        }
        residual[k] /= l.w.ledger.throughput;
        lab_free(&l);
    }
    verify_order("V29", "tumbling 20 s undamped: residual over throughput", h, residual, 4, 2.0, 0.3);
}

static void skin_and_form_drag(void)
{
    const double U = 0.5;
    const struct {
        const char *coef, *v_of, *x_of, *half_of;
        double kappa, t, v, x, half;
    } cases[2] = {{"water.drag_force_coef=0.005", "(a) v(1000 s) [m/s]", "(a) x(1000 s) [m]",
                   "(a) t at half speed [s]", 3.847222e-3, 1000, 0.32898, 221.144, 519.86},
                  {NULL, "(b) v(100 s) [m/s]", "(b) x(100 s) [m]", "(b) t at half speed [s]", 0.05, 100,
                   0.357143, NAN, 40}};
    for (int k = 0; k < 2; k++) {
        lab l;
        char coef[64];
        const double t = cases[k].t;
        /* (b) has form drag, C = 1, on the side of 8.7805 m2; equation (8) has one area, the wetted one */
        snprintf(coef, sizeof coef, "water.drag_force_coef=%.17g", 10 * DRAFT / WETTED);
        const double C = k ? 10 * DRAFT / WETTED : 0.005, kappa = 0.5 * C * 1025 * WETTED / 90000;
        make_floe(&l, REST, q_one(), v3(0, 0, 0), v3(0, 0, 0));
        lab_set(&l, cases[k].coef ? cases[k].coef : coef);
        lab_set(&l, "water.current=0.5 0 0");
        lab_make(&l, t / 10000);
        double half = NAN, before = 0.0; /* half: time when half the speed is reached */
        for (int s = 0; s < 10000; s++) {
            lab_run(&l, 1);
            const double v = l.w.b.v[0].x;
            if (v >= 0.5 * U && isnan(half))
                half = l.w.dt * ((double)l.w.step - (v - 0.5 * U) / (v - before));
            before = v;
        }
        verify_row("V54", k ? "(b) kappa [1/m]" : "(a) kappa [1/m]", kappa, cases[k].kappa, 1e-6, VERIFY_REL);
        verify_row("V54", cases[k].v_of, l.w.b.v[0].x, U - U / (1 + kappa * U * t), 1e-6, VERIFY_REL);
        verify_row("V54", cases[k].x_of, l.w.b.x[0].x, U * t - log(1 + kappa * U * t) / kappa, 1e-6,
                   VERIFY_REL);
        verify_row("V54", cases[k].half_of, half, 1 / (kappa * U), 1e-6, VERIFY_REL);
        verify_row("V54", "  to the digits of the reference table", half, cases[k].half, 1e-5, VERIFY_REL);
        verify_row("V54", "  v as listed", l.w.b.v[0].x, cases[k].v, 1e-5, VERIFY_ABS);
        if (isfinite(cases[k].x))
            verify_row("V54", "  x as listed", l.w.b.x[0].x, cases[k].x, 1e-3, VERIFY_ABS);
        lab_free(&l);
    }
}

/* Skin and form drag of each facet against closed forms. */
static void facet_drag(void)
{
    static const struct {
        const char *what, *skin, *form;
        double kappa, t;
    } cases[3] = {
        {"skin, bottom and two sides: v(1000 s) [m/s]", "0.005", "0",
         0.5 * 0.005 * 1025 * (100 + 20 * DRAFT) / 90000, 1000},
        {"form, (b): v(100 s) [m/s]", "0", "1", 0.5 * 1025 * 10 * DRAFT / 90000, 100},
        {"both: v(100 s) [m/s]", "0.005", "1", 0.5 * 1025 * (0.005 * (100 + 20 * DRAFT) + 10 * DRAFT) / 90000,
         100},
    };
    verify_note("drag = facet, form and skin; it acts below the centre, and tilts the floe");
    for (int k = 0; k < 3; k++) {
        lab l;
        const double U = 0.5, t = cases[k].t, kappa = cases[k].kappa;
        make_floe(&l, REST, q_one(), v3(0, 0, 0), v3(0, 0, 0));
        lab_set(&l, "water.drag=facet");
        lab_setf(&l, "water.skin_coef=%s", cases[k].skin);
        lab_setf(&l, "water.form_coef=%s", cases[k].form);
        lab_set(&l, "water.current=0.5 0 0");
        lab_make(&l, 0.1);
        lab_run(&l, (int64_t)(10 * t));
        verify_row("V54", cases[k].what, l.w.b.v[0].x, U - U / (1 + kappa * U * t), 1e-4, VERIFY_REL);
        if (k == 1) verify_row("V54", "  as listed", l.w.b.v[0].x, 0.357143, 1e-5, VERIFY_ABS);
        lab_free(&l);
    }

    /* wind on the dry sides, water on the wet ones, skin and form: u in the water, 20 - v in the air */
    const double S = 0.5 * 1025 * (0.0055 * (100 + 20 * DRAFT) + 0.5 * 10 * DRAFT),
                 A = 0.5 * 1.293 * (0.0015 * (100 + 20 * (1 - DRAFT)) + 0.5 * 10 * (1 - DRAFT)),
                 r = sqrt(A / S);
    lab l;
    make_floe(&l, REST, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_set(&l, "water.drag=facet");
    lab_set(&l, "water.skin_coef=0.0055");
    lab_set(&l, "wind.drag=facet");
    lab_set(&l, "wind.velocity=20 0 0");
    lab_make(&l, 0.1);
    lab_run(&l, 20000);
    verify_row("V55", "facets: drift in wind [m/s]", l.w.b.v[0].x, 20 * r / (1 + r), 1e-3, VERIFY_REL);
    lab_free(&l);

    /* Spin of a disc of 64 sides, radius 5, 0.5 thick, half in the water: skin drag of the bottom, 1/2 C
     * rho pi R^2 (2/5) R^3, and of the rim, 1/2 C rho 2 pi R d R^3. */
    enum { SIDES = 64 };
    fl_vec3 xy[SIDES];
    fl_poly p = {0};
    fl_err err = {0};
    for (int k = 0; k < SIDES; k++)
        xy[k] = v3(4.95 * cos(2 * PI * k / SIDES), 4.95 * sin(2 * PI * k / SIDES), 0);
    lab_start(&l);
    lab_set(&l, "run.gravity=9.81");
    lab_set(&l, "water.density=1000");
    lab_set(&l, "material.ice.density=500");
    lab_set(&l, "water.drag=facet");
    lab_set(&l, "water.form_coef=0");
    if (fl_poly_prism(&p, SIDES, xy, -0.2, 0.2, &err)) verify_true("V56", err.text, 0);
    lab_poly(&l, &p, 0.05, v3(0, 0, 0), v3(0, 0, 0.1));
    lab_make(&l, 0.1);
    lab_run(&l, 1000);
    const double R = 5,
                 c = 0.5 * 0.005 * 1000 * (PI * R * R * 0.4 * R * R * R + 2 * PI * R * 0.25 * R * R * R),
                 I = 500 * PI * R * R * 0.5 * 0.5 * R * R;
    verify_row("V56", "facets: disc, spin after 100 s [rad/s]", l.w.b.w[0].z, 0.1 / (1 + c / I * 0.1 * 100),
               0.02, VERIFY_REL);
    lab_free(&l);

    /* obliquely through the water, with added mass: order; the energy relative to the water never rises */
    double h[4], off[4];
    fl_vec3 at[5];
    int falls = 1;
    for (int k = 4; k >= 0; k--) {
        const double dt = k < 4 ? 0.05 / (1 << k) : 0.05 / 64;
        make_floe(&l, REST, q_one(), v3(2, 1, 0), v3(0, 0, 0.3));
        lab_set(&l, "run.gravity=0");
        lab_set(&l, "water.drag=facet");
        lab_set(&l, "water.skin_coef=0.05");
        lab_set(&l, "water.form_coef=2");
        lab_set(&l, "water.added_mass=0.1 0.3 1");
        lab_make(&l, dt);
        double last = fl_body_kinetic_energy(&l.w.b, 0);
        for (int s = 0; s < (int)(10 / dt + 0.5); s++) {
            lab_run(&l, 1);
            falls &= fl_body_kinetic_energy(&l.w.b, 0) <= last * (1 + 1e-3 * dt * dt);
            last = fl_body_kinetic_energy(&l.w.b, 0);
        }
        at[k] = l.w.b.x[0];
        if (k < 4) {
            h[k] = dt;
            off[k] = v3_norm(v3_sub(at[k], at[4]));
        }
        lab_free(&l);
    }
    verify_true("V54", "a floe in oblique motion with spin only loses energy", falls);
    verify_order("V54", "  position after 10 s [m]", h, off, 4, 1.0, 0.2);
}

/* A current that varies with depth carries a floe at its speed at the submerged centre. */
static void sheared_current(void)
{
    static const char *const SET[3][3] = {
        {"water.profile=power", "water.depth=10", "water.current=0.5 0 0"},
        {"water.profile=linear", "water.profile_depth=10", "water.current=0.5 0 0"},
        {"water.profile=table", NULL, NULL},
    };
    const double part = 1 - 0.5 * DRAFT / 10, kappa = 0.5 * 0.005 * 1025 * WETTED / 90000;
    const double U[3] = {0.5 * pow(part, 1.0 / 7), 0.5 * part, 0.5 - 0.5 * DRAFT * 0.1};
    const char *what[3] = {"power law over 10 m: v(1000 s) [m/s]", "linear over 10 m", "table"};
    const char *file = test_file("rows", "#current 1\n0 0.5 0\n-5 0 0\n", 26);
    for (int k = 0; k < 3; k++) {
        lab l;
        make_floe(&l, REST, q_one(), v3(0, 0, 0), v3(0, 0, 0));
        for (int j = 0; j < 3; j++)
            if (SET[k][j]) lab_set(&l, SET[k][j]);
        if (k == 2) lab_setf(&l, "water.profile_file=%s", file);
        lab_set(&l, "water.drag_force_coef=0.005");
        lab_make(&l, 0.1);
        lab_run(&l, 10000);
        verify_row("V54", what[k], l.w.b.v[0].x, U[k] - U[k] / (1 + kappa * U[k] * 1000), 1e-6, VERIFY_REL);
        lab_free(&l);
    }
}

/* Speed of a floe of that density after t in the wind; `strong` multiplies the drag coefficients. */
static double wind_speed_of_floe(double density, double strong, double t, double dt)
{
    lab l;
    char set[64];
    make_floe(&l, 0.5 - density / 1025, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    snprintf(set, sizeof set, "material.ice.density=%.17g", density);
    lab_set(&l, set);
    snprintf(set, sizeof set, "water.drag_force_coef=%.17g", 0.0055 * strong);
    lab_set(&l, set);
    lab_set(&l, "wind.velocity=20 0 0");
    lab_set(&l, "wind.density=1.293");
    snprintf(set, sizeof set, "wind.drag_coef=%.17g", 0.0015 * strong);
    lab_set(&l, set);
    lab_make(&l, dt);
    lab_run(&l, (int64_t)(t / dt));
    const double v = l.w.b.v[0].x;
    lab_free(&l);
    return v;
}

static void wind_drift(void)
{
    const double ratio = sqrt(1.293 * 1.5e-3 / (1025 * 5.5e-3));
    verify_note("ice of 512.5 kg/m3 floats half out: equal areas in wind and water");
    verify_row("V55", "free drift in wind, equal areas [m/s]", wind_speed_of_floe(512.5, 1, 6000, 0.1),
               0.364208, 1e-4, VERIFY_REL);
    const double r = ratio * sqrt((240 - WETTED) / WETTED);
    verify_row("V55", "ice of 900 kg/m3, its own areas [m/s]", wind_speed_of_floe(900, 1, 6000, 0.1),
               20 * r / (1 + r), 1e-4, VERIFY_REL);
    const double h[3] = {0.4, 0.2, 0.1};
    double off[3];
    for (int k = 0; k < 3; k++) off[k] = fabs(wind_speed_of_floe(900, 100, 400, h[k]) - 20 * r / (1 + r));
    verify_order("V55", "error of the drift, coefficients 100 times larger", h, off, 3, 2.0, 0.2);
}

static void spin_decay(void)
{
    lab l;
    make_floe(&l, REST, q_one(), v3(0, 0, 0), v3(0, 0, 0.1));
    lab_set(&l, "water.drag_moment_coef=0.005");
    lab_make(&l, 0.05);
    lab_run(&l, 2000);
    verify_row("V56", "spin after 100 s [rad/s]", l.w.b.w[0].z, 0.054877, 1e-4, VERIFY_REL);
    verify_row("V56", "  r_eff [m]", l.w.sea.drag_radius[0], 7.088723, 1e-6, VERIFY_REL);
    lab_free(&l);
}

static void resting_floe(void)
{
    const int64_t steps = verify_quick() ? 100000 : 1000000;
    for (int k = 0; k < 2; k++) {
        lab l;
        make_floe(&l, REST, q_one(), v3(0, 0, 0), v3(0, 0, 0));
        if (k) {
            lab_set(&l, "water.drag_force_coef=0.005");
            lab_set(&l, "water.drag_moment_coef=0.005");
        }
        lab_make(&l, 1e-3);
        lab_run(&l, steps);
        verify_note("%ld steps at rest, %s", (long)steps, k ? "drag of 0.005" : "no drag");
        verify_below("V60", "speed [m/s]", v3_norm(l.w.b.v[0]), 1e-9);
        verify_below("V60", "spin [rad/s]", v3_norm(l.w.b.w[0]), 1e-9);
        verify_below("V60", "moved [m]", v3_norm(v3_sub(l.w.b.x[0], v3(0, 0, REST))), 1e-9);
        lab_free(&l);
    }
}

/* For any coefficient and step, drag reduces the velocity and never reverses it. */
static void extreme_drag(int facet)
{
    int monotone = 1;
    double last = 0.0;
    for (int k = 0; k < 40; k++) {
        lab l;
        char set[64];
        make_floe(&l, REST, q_one(), v3(10, 0, 0), v3(0, 0, 3));
        snprintf(set, sizeof set, "water.drag_force_coef=%g", pow(10, k - 20));
        lab_set(&l, set);
        snprintf(set, sizeof set, "water.drag_moment_coef=%g", pow(10, k - 20));
        lab_set(&l, set);
        if (facet) {
            lab_set(&l, "water.drag=facet");
            lab_setf(&l, "water.skin_coef=%g", pow(10, k - 20));
            lab_setf(&l, "water.form_coef=%g", pow(10, 19 - k));
        }
        lab_make(&l, k % 2 ? 0.5 : 1e-3);
        for (int s = 0; s < 100; s++) {
            const double v = l.w.b.v[0].x, w = l.w.b.w[0].z;
            lab_run(&l, 1);
            /* apart from rounding of the other forces */
            const double eps = 1e-15 * 3;
            if (!(l.w.b.v[0].x >= -eps && l.w.b.v[0].x <= v + eps && l.w.b.w[0].z >= -eps &&
                  l.w.b.w[0].z <= w + eps))
                monotone = 0;
        }
        last = l.w.b.v[0].x;
        lab_free(&l);
    }
    verify_true("H38",
                facet ? "facets, skin 1e-20 .. 1e19, form 1e19 .. 1e-20: the same"
                      : "C = 1e-20 .. 1e19: speed and spin fall, never reverse",
                monotone);
    verify_below("H38", "  speed left with C = 1e19 [m/s]", last, 1e-15);
}

/* A square prism of half the density of water is unstable upright: GM = -1/12 m, I = m/6, so a tilt grows
 * as cosh(t sqrt(g/2)). */
static void unstable_prism(void)
{
    const double rate = sqrt(G / 2);
    for (int k = 0; k < 2; k++) {
        const double tilt = k ? 1e-12 : 0.0;
        lab l;
        lab_start(&l);
        lab_set(&l, "run.gravity=9.81");
        lab_set(&l, "water.density=1000");
        lab_set(&l, "water.drag_force_coef=0");
        lab_set(&l, "water.drag_moment_coef=0");
        lab_set(&l, "material.ice.density=500");
        lab_box(&l, v3(0, 0, 0), v3(5, 0.5, 0.5), 0.05, q_of_vector(v3(tilt, 0, 0)), v3(0, 0, 0),
                v3(0, 0, 0));
        lab_make(&l, 1e-3);
        lab_run(&l, 6000);
        const double theta = fabs(fl_body_axes(&l.w.b, 0).m[2][1]);
        if (k)
            verify_row("H25", "growth of a tilt of 1e-12 rad [1/s]", acosh(theta / tilt) / 6, rate, 1e-2,
                       VERIFY_REL);
        else verify_row("H25", "tilt of an upright unstable prism after 6 s", theta, 0.0, 1e-10, VERIFY_ABS);
        if (k) {
            lab_run(&l, 9000);
            verify_true("H25", "  and then it falls", fabs(fl_body_axes(&l.w.b, 0).m[2][1]) > 0.1);
        }
        lab_free(&l);
    }
}

int main(void)
{
    verify_begin("floating bodies");
    equilibrium_draft();
    heave_period();
    added_mass();
    added_mass_of_upright_block();
    kirchhoff_motion();
    roll_period();
    energy_of_tumbling();
    skin_and_form_drag();
    sheared_current();
    facet_drag();
    wind_drift();
    spin_decay();
    resting_floe();
    extreme_drag(0);
    extreme_drag(1);
    unstable_prism();
    return verify_end();
}
