/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "support/near.h"
#include "base/pi.h"
#include "base/rng.h"
#include "law/damping.h"
#include "law/manual.h"
#include "law/material.h"
#include "law/normal.h"
#include "law/tangent.h"
#include "support/exact_friction.h"
#include "support/shapes.h"

static fl_vec3 friction_force(fl_friction_springs *s, const fl_friction_contact *c, fl_vec3 v, double spin,
                              double twist, double dt, double *moment)
{
    const fl_friction_motion by = {
        .v = v, .v_end = v, .spin = spin, .spin_end = spin, .mean_spin = twist, .half_step = 0.5 * dt};
    const fl_friction_result r = fl_tangent_step(*s, *c, by, dt);
    *s = r.springs;
    *moment = r.moment;
    return r.force;
}

/* --- damping ----------------------------------------------------------------------------------------------
 */

static void damping_is_that_of_the_table(void **state)
{
    static const struct {
        double e, zeta, alpha, D;
    } row[] = {
        {0.9, 0.03427, 0.07662, 0.16648}, {0.8, 0.07436, 0.16626, 0.37315}, {0.7, 0.12221, 0.27328, 0.63483},
        {0.6, 0.18086, 0.40441, 0.97487}, {0.5, 0.25528, 0.57081, 1.43275}, {0.4, 0.35451, 0.79270, 2.08250},
        {0.3, 0.49724, 1.11186, 3.08708}, {0.2, 0.73125, 1.63512, 4.91917}, {0.1, 1.24319, 2.77985, 9.99816}};
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        assert_near_of(fl_damping_linear(row[k].e), row[k].zeta, 5.01e-6,
                       1.0); /* half a digit of the table */
        assert_near_of(fl_damping_hunt_crossley(row[k].e), row[k].D, 5.01e-6, 1.0);
        assert_near(fl_damping_tsuji(row[k].e), row[k].alpha, 2e-3); /* accuracy of the fit */
    }
}

static void damping_of_every_restitution_is_finite(void **state)
{
    double zeta = INFINITY, alpha = INFINITY, D = INFINITY;
    (void)state;
    for (int k = 0; k <= 1000; k++) {
        const double e = 0.001 * k, z = fl_damping_linear(e), a = fl_damping_tsuji(e),
                     d = fl_damping_hunt_crossley(e);
        assert_true(isfinite(z) && isfinite(a) && isfinite(d));
        assert_true(z >= 0.0 && a >= 0.0 && d >= 0.0);
        if (e > FL_MIN_RESTITUTION) assert_true(z < zeta && a < alpha && d < D); /* falls with e */
        zeta = z, alpha = a, D = d;
    }
    assert_near_of(zeta, 0.0, 1e-15, 1.0);
    assert_near_of(alpha, 0.0, 1e-15, 1.0);
    assert_near_of(D, 0.0, 1e-15, 1.0);
    assert_near(fl_damping_hunt_crossley(0.0), fl_damping_hunt_crossley(FL_MIN_RESTITUTION), 1e-15);
    assert_near(fl_damping_linear(-1.0), fl_damping_linear(FL_MIN_RESTITUTION), 1e-15);
}

/* A mass on n equal contacts, each of which knows only its own share; forces act at the ends of steps. */
typedef struct {
    double x, v, E, D; /* energy E and damping D of one contact */
} damped_mass;

static void step_damped_mass(damped_mass *s, double omega, double C, int n, double dt, double *foreseen)
{
    const double before = -(s->E + s->D) * n, k = omega * omega / n;
    s->v += 0.5 * dt * before, s->x += dt * s->v;
    const double E = -k * -s->x, lead = 0.5 * dt * before; /* of mass 1, pushed towards -x */
    const double d = fl_damping_end_speed(s->v + lead, C, 0.5 * dt, n, E - s->E, s->D, 0.0);
    s->E = E, s->D = C * d;
    s->v -= 0.5 * dt * n * (s->E + s->D);
    *foreseen = d;
}

static void damping_of_one_contact_uses_the_speed_at_the_end(void **state)
{
    (void)state;
    for (int k = 0; k < test_times(50); k++) {
        fl_rng g = fl_rng_of(test_seed(), 900 + k, FL_RNG_TEST);
        const double omega = 3.0, dt = fl_rng_in(&g, 0.01, 0.6), C = exp(fl_rng_in(&g, -3, 8));
        damped_mass s = {.x = 0.0, .v = 1.0};
        for (int i = 0; i < 40; i++) {
            double d;
            step_damped_mass(&s, omega, C, 1, dt, &d);
            assert_near_of(d, s.v, 1e-11, 1.0);
        }
    }
}

/* Up to 0.7 of 2/omega, for any damping and any number of contacts: S08 to S24 of verify_step and
 * verify_stable_step_packed. */
static void damping_of_many_is_stable(void **state)
{
    static const int N[] = {1, 2, 3, 6, 12, 100};
    (void)state;
    for (size_t k = 0; k < sizeof N / sizeof *N; k++)
        for (double C = 0.01; C < 1e5; C *= 1.5) {
            damped_mass s = {.x = 0.0, .v = 1.0};
            double d, largest = 0.0;
            for (int i = 0; i < 4000; i++) {
                step_damped_mass(&s, 2.0, C / N[k], N[k], 0.7, &d);
                largest = fmax(largest, fabs(s.v));
            }
            assert_true(largest < 30.0 && fabs(s.v) <= 1.0);
        }
}

/* A load that rests is not damped anew where a body moves along steadily: each factor of lambda alone, and
 * the approach of the whole, whose product with the mean is never negative. */
static void a_sustained_load_is_not_damped(void **state)
{
    (void)state;
    assert_near(fl_damping_sustained_share(0.0, 5.0), 0.0, 0.0);   /* an impact */
    assert_near(fl_damping_sustained_share(5.0, 20.0), 0.25, 0.0); /* on top of a load */
    assert_near(fl_damping_sustained_share(7.0, 5.0), 1.0, 0.0);
    assert_near(fl_damping_passing_share(0.0, 1.0), 0.0, 0.0);             /* rocks on the spot */
    assert_near(fl_damping_passing_share(1.0, 0.2 * 0.2), 0.5, 1e-15);     /* over bends of some 0.4 */
    assert_near(fl_damping_passing_share(9.0, 0.0), 1.0, 0.0);             /* slides on a plane */
    assert_near(fl_damping_steady_share(0.0, 0.0, 0.0), 1.0, 0.0);         /* does not spin */
    assert_near(fl_damping_steady_share(-3.0, 9.0, 1.0), 0.0, 0.0);        /* swings back */
    assert_near(fl_damping_steady_share(6.0, 9.0, 4.0), 2.0 / 3.0, 1e-15); /* spins up */
    for (int k = 0; k < 100; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const double mean = fl_rng_normal(&g), rate = fl_rng_normal(&g),
                     C = fl_damping_whole_approach(mean, rate);
        assert_true(C * mean >= 0.0 && fabs(C) <= fabs(mean));
        assert_true(C == 0.0 || C == mean || C == rate);
    }
}

/* y of the low pass of cos 3t at t = 1, in n steps; r = 5. */
static double filtered_cosine(int n)
{
    const double dt = 1.0 / n, r = 5.0, omega = r * FL_SUSTAINED_PERIODS;
    double y = 0.0, gradient = r;
    for (int k = 1; k <= n; k++) {
        const fl_low_pass f = fl_damping_low_pass(dt, omega * omega);
        y = fl_low_pass_after(&f, y, gradient, cos(3.0 * k * dt), dt);
        gradient = f.rate * (cos(3.0 * k * dt) - y);
    }
    return y;
}

/* The low pass against its solution, order 2; over a long stretch it ends at the load. */
static void low_pass_has_order_two(void **state)
{
    (void)state;
    const double c = 5.0 * 5.0 / 34.0, s = 5.0 * 3.0 / 34.0, /* y = c cos 3t + s sin 3t - c e^(-5t) */
        exact = c * cos(3.0) + s * sin(3.0) - c * exp(-5.0);
    const double coarse = fabs(filtered_cosine(50) - exact), fine = fabs(filtered_cosine(100) - exact);
    assert_true(coarse < 1e-3);
    assert_near(log2(coarse / fine), 2.0, 0.02);
    const fl_low_pass rest = fl_damping_low_pass(0.0, 100.0), far = fl_damping_low_pass(1e9, 100.0);
    assert_near(fl_low_pass_after(&rest, 2.0, 7.0, 3.0, 0.0), 2.0, 0.0);
    assert_near(fl_low_pass_after(&far, 2.0, 7.0, 3.0, 1e9), 3.0, 1e-8);
}

static void damping_solves_its_equation(void **state)
{
    (void)state;
    for (int k = 1; k < 100; k++) {
        const double e = 0.01 * k, D = fl_damping_hunt_crossley(e);
        /* without the logarithm, the argument of which loses all digits for small e */
        assert_near_of((1.0 + D) * exp(-D * (1.0 + e)), 1.0 - e * D, 1e-14, 1.0);
        assert_true(D > 0.0 && e * D < 1.0);
        assert_near(fl_damping_linear_restitution(fl_damping_linear(e)), e, 1e-13);
    }
    /* both sides of zeta = 1 and the point itself */
    assert_near(fl_damping_linear_restitution(1.0), exp(-2.0), 1e-15);
    assert_near(fl_damping_linear_restitution(1.0 - 1e-8), exp(-2.0), 1e-6);
    assert_near(fl_damping_linear_restitution(1.0 + 1e-8), exp(-2.0), 1e-6);
}

/* An impact of unit speed on a spring, du/ds = -s (1 + D u)/u, stores the energy of the closed form. The
 * lower bound for slow contacts never reduces it, and leaves the stated ratio. */
static void a_slow_contact_is_damped_at_most_as_an_impact(void **state)
{
    (void)state;
    for (int k = 0; k <= 100; k++) {
        const double e = 0.01 * k, D = fl_damping_hunt_crossley(e), c = fl_damping_slow_factor(D),
                     at = fl_damping_stored_speed(D);
        double s = 0.0, u = 1.0;
        const double h = 2e-4 / (1.0 + D);
        while (u > 0.0) { /* midpoint rule in time */
            const double us = u - 0.5 * h * s * (1.0 + D * u), ss = s + 0.5 * h * u;
            s += h * us;
            u -= h * ss * (1.0 + D * us);
        }
        assert_near(at, s, 1e-6);
        assert_true(c >= 1.0 && c * at <= 1.0 + 1e-15);
        assert_near(0.5 * D / c, fmin(0.5 * D, fmax(2.5, 0.5 * D * at)), 1e-14);
        if (e >= 0.2) assert_true(c == 1.0);
        assert_true(fl_hunt_crossley_stable_share(D, 1.0) <= fl_damping_stable_share(0.5 * D / c));
        assert_true(fl_hunt_crossley_stable_share(D, 1.0) > 0.9 * fl_damping_stable_share(0.5 * D / c));
    }
    assert_near(fl_damping_stored_speed(0.0), 1.0, 0.0);
    assert_near(fl_damping_stored_speed(0.9999e-4), fl_damping_stored_speed(1.0001e-4), 1e-8);
}

/* --- material, normal
 * --------------------------------------------------------------------------------------- */

static void material_gives_hertz_and_flat_punch(void **state)
{
    (void)state;
    const fl_elastic_constants ice = {1e9, 0.3}, rigid = {INFINITY, 0.0};
    const double same = fl_material_modulus(ice, ice), half = fl_material_modulus(ice, rigid);
    assert_near(same, 1e9 / (2.0 * 0.91), 1e-15);
    assert_near(half, 1e9 / 0.91, 1e-15);
    assert_near(fl_material_modulus(rigid, ice), half, 0.0);
    assert_near(fl_material_radius(0.1, 0.1), 0.05, 1e-15);
    assert_near(fl_material_radius(0.1, 0.3), 0.075, 1e-15);
    assert_near(fl_material_radius(0.1, 0.0), 0.1, 0.0);
    assert_near(fl_material_radius(0.0, 0.3), 0.3, 0.0);
    assert_near(fl_material_hertz(same, 0.05), 4.0 / 3.0 * same * sqrt(0.05), 1e-15);
    /* six points represent the punch: 2 E* a, a the radius of the circle of that area, times beta */
    assert_near(fl_material_punch(same, PI * 4.0), 2.0 * same * 1.02 * 2.0, 1e-15);
}

/* phi' = s^n and (s^n)' = slope, by central differences at the optimal width cbrt(eps): error 4e-11. */
static void normal_powers_are_derivatives_of_one_another(void **state)
{
    const double exponent[] = {1.0, 1.5}, h = 6e-6;
    (void)state;
    for (int c = 0; c < 2; c++) {
        const double n = exponent[c];
        for (int k = -6; k <= 2; k++) {
            const double s = pow(10.0, k), d = h * s;
            assert_near(fl_normal_power(s, n), pow(s, n), 1e-15);
            assert_near(fl_normal_phi(s, n), pow(s, n + 1.0) / (n + 1.0), 1e-15);
            assert_near((fl_normal_phi(s + d, n) - fl_normal_phi(s - d, n)) / (2.0 * d),
                        fl_normal_power(s, n), 1e-9);
            assert_near((fl_normal_power(s + d, n) - fl_normal_power(s - d, n)) / (2.0 * d),
                        fl_normal_slope(s, n), 1e-9);
        }
    }
    assert_near(fl_normal_damped_force(10.0, 0.5, 1.0), 15.0, 1e-15);
    assert_near(fl_normal_damped_force(10.0, 0.5, -3.0), 0.0, 0.0); /* never pulls */
}

/* --- the manual
 * --------------------------------------------------------------------------------------------- */

/* The table of mode jumps: E = 1 GPa, nu = 0.3, R = 0.1 m on both, L = 5 m, A = 12.5 m2. */
static void manual_modes_are_those_of_the_table(void **state)
{
    static const double overlap[] = {1e-4, 1e-3, 1e-2};
    static const double expected[][6] = {/* VV, VF, EP literal, EP si, EF literal, FF [N] */
                                         {164, 232, 819, 216e3, 1.16e3, 224e3},
                                         {5.18e3, 7.33e3, 25.9e3, 2.16e6, 36.6e3, 2.24e6},
                                         {164e3, 232e3, 819e3, 21.6e6, 1.16e6, 22.4e6}};
    static const struct {
        fl_manual_kind touch;
        int si;
    } mode[] = {{FL_MANUAL_VV, 0}, {FL_MANUAL_VF, 0}, {FL_MANUAL_EP, 0},
                {FL_MANUAL_EP, 1}, {FL_MANUAL_EF, 0}, {FL_MANUAL_FF, 0}};
    const double modulus =
        fl_material_modulus((fl_elastic_constants){1e9, 0.3}, (fl_elastic_constants){1e9, 0.3});
    (void)state;
    for (int s = 0; s < 3; s++) {
        for (int m = 0; m < 6; m++) {
            const fl_manual_contact c = {
                .kind = mode[m].touch, .length = 5.0, .area = 12.5, .r_low = 0.1, .r_high = 0.1, .edge = 5.0};
            double n;
            const double k = fl_manual_stiffness(&c, modulus, overlap[s], mode[m].si, 0, &n);
            assert_near(k * fl_normal_power(overlap[s], n), expected[s][m],
                        5e-3); /* three digits are printed */
        }
    }
}

/* Crossed cylinders: R~ = sqrt(Ra Rb)/sin; as printed, twice that; bounded where edges become parallel. */
static void manual_crossed_edges(void **state)
{
    const double modulus = 1e9, overlap = 1e-4;
    double n;
    (void)state;
    for (int k = 1; k <= 9; k++) {
        const double angle = k * PI / 18.0;
        const fl_manual_contact c = {
            .kind = FL_MANUAL_EE, .sine = sin(angle), .r_low = 0.1, .r_high = 0.3, .edge = 5.0};
        const double R = sqrt(0.03) / sin(angle), expected = fl_material_hertz(modulus, R);
        assert_near(fl_manual_stiffness(&c, modulus, overlap, 0, 0, &n), expected, 1e-12);
        assert_near(n, 1.5, 0.0);
        assert_near(fl_manual_stiffness(&c, modulus, overlap, 0, 1, &n), expected * sqrt(2.0), 1e-12);
    }
    fl_manual_contact c = {.kind = FL_MANUAL_EE, .r_low = 0.1, .r_high = 0.1, .edge = 5.0};
    /* parallel: half the radius in one direction, edge^2/(4 s) in the other. With the angle the first grows
     * by sin^2/4 at most. */
    const double parallel = fl_manual_stiffness(&c, modulus, overlap, 0, 0, &n);
    assert_near(parallel, fl_material_hertz(modulus, sqrt(0.05 * 25.0 / (4.0 * overlap))), 1e-12);
    double before = parallel;
    for (double sine = 1e-12; sine < 0.5; sine *= 10.0) {
        c.sine = sine;
        const double k = fl_manual_stiffness(&c, modulus, overlap, 0, 0, &n);
        assert_true(k > 0.0 && k <= before * (1.0 + 0.25 * sine * sine));
        before = k;
    }
    assert_true(before < 0.2 * parallel);
}

static void manual_sharp_sides_are_finite(void **state)
{
    (void)state;
    for (int t = FL_MANUAL_VV; t <= FL_MANUAL_FF; t++) {
        for (int side = 0; side < 2; side++) {
            const fl_manual_contact c = {.kind = (fl_manual_kind)t,
                                         .length = 1,
                                         .area = 1,
                                         .sine = 0.5,
                                         .edge = 1,
                                         .r_low = side ? 0.1 : 0.0,
                                         .r_high = side ? 0.0 : 0.1};
            double n = 0.0;
            const double k = fl_manual_stiffness(&c, 1e9, 1e-3, 0, 0, &n);
            assert_true(isfinite(k) && k > 0.0);
            assert_true(n == 1.0 || n == 1.5);
        }
    }
}

static void manual_damping_by_its_exponent(void **state)
{
    (void)state;
    assert_near(fl_manual_damping(100.0, 1.0, 0.3, 4.0, 0.25, 9.0, 2.0), 2.0 * 0.25 * 20.0 * 2.0, 1e-15);
    assert_near(fl_manual_damping(100.0, 1.5, 0.0625, 4.0, 9.0, 0.25, 2.0), 0.25 * 20.0 * 0.5 * 2.0, 1e-15);
}

/* --- friction
 * ------------------------------------------------------------------------------------------------ */

/* A sliding point. */
static fl_vec3 slide_point(fl_friction_springs *s, fl_vec3 n, fl_vec3 v, double twist, double dt, double k,
                           double g, double limit)
{
    const fl_friction_contact c = {.n = n, .k = k, .g = g, .limit = limit};
    double moment;
    return friction_force(s, &c, v, 0.0, twist, dt, &moment);
}

static void friction_sticks_slides_and_comes_back(void **state)
{
    const fl_vec3 n = v3(0, 0, 1), v = v3(1, 0, 0.7); /* the normal part is dropped */
    const double k = 1000.0, dt = 1e-3, limit = 5.0;
    fl_friction_springs s = {.k = k};
    fl_vec3 f = v3(0, 0, 0);
    (void)state;
    for (int i = 1; i <= 5; i++) {
        f = slide_point(&s, n, v, 0.0, dt, k, 0.0, limit);
        assert_near(f.x, -k * dt * i, 1e-14);
        assert_near_of(f.z, 0.0, 1e-15, limit);
    }
    for (int i = 0; i < 5; i++) f = slide_point(&s, n, v, 0.0, dt, k, 0.0, limit);
    assert_near(f.x, -limit, 1e-14);
    assert_near(s.energy, 0.5 * limit * limit / k, 1e-14);
    f = slide_point(&s, n, v3_neg(v), 0.0, dt, k, 0.0, limit); /* torsion about it slides at once */
    assert_near(f.x, -limit + k * dt, 1e-14);
    f = slide_point(&s, n, v3(0, 0, 0), 0.0, dt, k, 0.0, 0.0); /* no load, no friction */
    assert_near(v3_norm(f), 0.0, 0.0);
    s = (fl_friction_springs){.force = v3(1, 0, 0), .k = k};
    f = slide_point(&s, n, v, 0.0, dt, 0.0, 0.0, limit); /* no stiffness, no force */
    assert_near(v3_norm(f), 0.0, 0.0);
    assert_near(s.energy, 0.0, 0.0);
}

/* The stored vector rotates with the normal and with the pair about it, and keeps its length. */
static void friction_memory_rotates_with_the_contact(void **state)
{
    fl_friction_springs s = {.force = v3(3, 0, 0), .k = 1000.0};
    const int turns = 1000;
    (void)state;
    for (int i = 1; i <= turns; i++) {
        const double a = 0.5 * PI * i / turns;
        const fl_vec3 f = slide_point(&s, v3(-sin(a), 0, cos(a)), v3(0, 0, 0), 0.0, 1e-3, 1000.0, 0.0, 100.0);
        assert_near(v3_norm(f), 3.0, 1e-13);
    }
    assert_near_of(s.force.z, 3.0, 1e-6, 3.0);
    for (int i = 0; i < turns; i++) /* a quarter turn about n = -x */
        slide_point(&s, v3(-1, 0, 0), v3(0, 0, 0), 0.5 * PI, 1.0 / turns, 1000.0, 0.0, 100.0);
    assert_near(v3_norm(s.force), 3.0, 1e-12);
    /* each turn is made along the tangent: error (pi/2)^3/(3 N^2) */
    assert_near_of(s.force.y, 3.0, 2e-6, 3.0);
}

static void friction_damping_stays_within_the_limit(void **state)
{
    fl_friction_springs s = {.k = 1000.0};
    const fl_vec3 n = v3(0, 0, 1);
    (void)state;
    fl_vec3 f = slide_point(&s, n, v3(1, 0, 0), 0.0, 1e-3, 1000.0, 2.0, 5.0);
    assert_near(f.x, -1.0 - 2.0, 1e-14);
    assert_near(s.force.x, -1.0, 1e-14); /* the spring does not store the damping force */
    f = slide_point(&s, n, v3(1, 0, 0), 0.0, 1e-3, 1000.0, 1e6, 5.0);
    assert_near(f.x, -5.0, 1e-14);
    assert_near(s.force.x, -2.0, 1e-14);
}

/* n.K n of K = 1 + one one^T + two two^T. */
static double projected_matrix(fl_vec3 n, fl_vec3 one, fl_vec3 two)
{
    const double a = v3_dot(n, one), b = v3_dot(n, two);
    return 1.0 + a * a + b * b;
}

/* In the tangent plane the sum of the moving mass, the springs and the damping satisfies the equation of
 * fl_tangent_damping(), checked with the projected matrix. */
static void friction_damping_solves_its_equation(void **state)
{
    (void)state;
    for (int k = 0; k < test_times(200); k++) {
        fl_rng g = fl_rng_of(test_seed(), 1100 + k, FL_RNG_TEST);
        double r[12];
        for (int m = 0; m < 12; m++) r[m] = fl_rng_normal(&g);
        const fl_vec3 n = v3_unit(v3(r[0], r[1], r[2])), one = v3(r[3], r[4], r[5]),
                      two = v3(r[6], r[7], r[8]);
        fl_vec3 v = v3(r[9], r[10], r[11]), way = v3(r[3], r[7], r[11]), old = v3(r[10], r[6], r[2]);
        v = v3_madd(v, -v3_dot(v, n), n), way = v3_madd(way, -v3_dot(way, n), n);
        const double dt = 0.01, many = 1 + k % 4, coef = exp(fl_rng_in(&g, -2, 8)), turn = 0.7, arm = 0.4;
        const fl_friction_contact c = {
            .n = n,
            .g = coef,
            .arm = arm,
            .compliance = {1 + one.x * one.x + two.x * two.x, one.x * one.y + two.x * two.y,
                           one.x * one.z + two.x * two.z, 1 + one.y * one.y + two.y * two.y,
                           one.y * one.z + two.y * two.z, 1 + one.z * one.z + two.z * two.z},
            .turn_compliance = turn,
            .contact_count = many};
        const fl_friction_wrench x =
            fl_tangent_damping(c, (fl_friction_wrench){v, r[0]}, (fl_friction_wrench){way, r[1]},
                               (fl_friction_wrench){old, r[2]}, 0.5 * dt, 0.0);
        /* the point then moves with this velocity, and the contact represents `count` of them */
        const double across = 0.5 * (3.0 + v3_norm2(one) + v3_norm2(two) - projected_matrix(n, one, two)),
                     all = fl_damping_implicit_weight(0.5 * dt * coef * across, many, 2.0 * many);
        const fl_vec3 rhs = v3_madd(v3_scale(all, v3_sub(x.f, old)), 1.0, way);
        const fl_vec3 product = v3_madd(v3_madd(rhs, v3_dot(one, rhs), one), v3_dot(two, rhs), two);
        fl_vec3 then = v3_madd(v, 0.5 * dt, product);
        /* of the old force, which is not tangential, only the tangential part */
        const fl_vec3 flat = v3_madd(old, -v3_dot(old, n), n), off = v3_sub(flat, old),
                      more = v3_scale(all, off),
                      less = v3_madd(v3_madd(more, v3_dot(one, more), one), v3_dot(two, more), two);
        then = v3_madd(then, -0.5 * dt, less);
        then = v3_madd(then, -v3_dot(then, n), n);
        const double size = v3_norm(x.f) + coef * v3_norm(v);
        assert_near_of(v3_norm(v3_madd(x.f, coef, then)), 0.0, 1e-10, size);
        assert_near_of(v3_dot(x.f, n), 0.0, 1e-12, size);
        const double spin = r[0] + 0.5 * dt * turn * arm * arm * (r[1] + all * (x.m - r[2]));
        assert_near_of(x.m, -coef * spin, 1e-12, coef);
    }
}

/* For any history of slip, load and stiffness with slip returning to its start, friction has dissipated
 * energy: the force on A does the work -f.v dt against the slip. Trapezoids, as for the spring's own
 * energy. */
static void friction_creates_no_energy(void **state)
{
    (void)state;
    for (long c = 0; c < test_times(200); c++) {
        fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
        const double dt = 1e-3, base = 1000.0, a1 = fl_rng_in(&g, 1, 20), a2 = fl_rng_in(&g, 1, 20),
                     b = fl_rng_in(&g, 1, 20), mu = fl_rng_in(&g, 0.05, 5), damp = fl_rng_in(&g, 0, 3);
        fl_friction_springs s = {0};
        double dissipated = 0.0, moved = 0.0;
        fl_vec3 before = v3(0, 0, 0);
        const fl_vec3 n = v3(0, 0, 1);
        for (int i = 1; i <= 20000; i++) {
            const double t = i * dt, depth = 0.5 * (1.0 - cos(b * t)), k = base * sqrt(depth);
            const fl_vec3 v = v3(sin(a1 * t), cos(a2 * t), 0);
            const fl_vec3 f = slide_point(&s, n, v, 0.0, dt, k, damp, mu * base * depth * sqrt(depth));
            assert_true(v3_norm(f) <= mu * base * depth * sqrt(depth) * (1.0 + 1e-15));
            dissipated -= 0.5 * dt * v3_dot(v3_add(f, before), v);
            moved += dt * v3_norm(v);
            before = f;
            /* energy returned so far never exceeds the energy put in; the rule's error is of order dt of the
             * work */
            if (dissipated - s.energy < -2.0 * dt * base * moved) {
                print_error("seed %llu case %ld\n", (unsigned long long)test_seed(), c);
                assert_true(0);
            }
        }
        assert_true(dissipated > s.energy);
    }
}

/* The closed path on which a plain incremental spring gains energy: load, slip, unload, slip back. Loaded by
 * k1 and unloaded by k2 < k1, the plain force k1 x would be opposed by k2 only. */
static void friction_unloads_along_its_stiffness(void **state)
{
    const fl_vec3 n = v3(0, 0, 1), there = v3(1, 0, 0), still = v3(0, 0, 0);
    const double k1 = 1000.0, k2 = 250.0, dt = 1e-4, far = 1e9;
    fl_friction_springs s = {.k = k1};
    (void)state;
    for (int i = 0; i < 100; i++) slide_point(&s, n, there, 0.0, dt, k1, 0.0, far);
    const double stored = s.energy;
    assert_near(s.force.x, -k1 * 100 * dt, 1e-12);
    slide_point(&s, n, still, 0.0, dt, k2, 0.0, far);
    assert_near(s.force.x, -k2 * 100 * dt, 1e-12);
    assert_near(s.energy, stored * k2 / k1, 1e-12);
    for (int i = 0; i < 100; i++) slide_point(&s, n, v3_neg(there), 0.0, dt, k2, 0.0, far);
    assert_near_of(s.force.x, 0.0, 1e-12, k1 * 100 * dt);
    /* stiffer again, the force stays: incremental */
    s = (fl_friction_springs){.force = v3(-7, 0, 0), .k = k2};
    slide_point(&s, n, still, 0.0, dt, k1, 0.0, far);
    assert_near(s.force.x, -7.0, 1e-15);
    assert_true(s.energy < 49.0 / (2.0 * k2));
}

/* A falling stiffness reduces the force in proportion, also where the fall is found later. A stiffness that
 * was only overestimated keeps its energy, one that was underestimated keeps its force. */
static void a_corrected_stiffness_creates_no_energy(void **state)
{
    const fl_vec3 n = v3(0, 0, 1), rest = v3(0, 0, 0);
    const double dt = 1e-3, limit = 500.0;
    fl_friction_springs s = {.k = 1000.0};
    (void)state;
    slide_point(&s, n, v3(1, 0, 0), 0.0, dt, 1000.0, 0.0, limit);
    fl_friction_springs fallen = s;
    assert_near(slide_point(&fallen, n, rest, 0.0, dt, 900.0, 0.0, limit).x, -0.9, 1e-14);
    const double stored = s.energy;
    fallen = s;
    fl_tangent_rescale(&fallen, 0.95, 1); /* predicted to fall to 1000, it fell to 950 */
    assert_near(slide_point(&fallen, n, rest, 0.0, dt, 950.0, 0.0, limit).x, -0.95, 1e-14);
    fallen = s;
    fl_tangent_rescale(&fallen, 1.05, 1);
    assert_near(slide_point(&fallen, n, rest, 0.0, dt, 1050.0, 0.0, limit).x, -1.05, 1e-14);
    fl_tangent_rescale(&s, 0.9, 0);
    assert_near(s.energy, stored, 1e-14);
    assert_near(slide_point(&s, n, rest, 0.0, dt, 900.0, 0.0, limit).x, -sqrt(0.9), 1e-14);
    assert_near(s.k, 900.0, 1e-14);
    fl_tangent_rescale(&s, 1.1, 0);
    assert_near(slide_point(&s, n, rest, 0.0, dt, 990.0, 0.0, limit).x, -sqrt(0.9), 1e-14);
}

/* The force is continuous where a spring begins to slide, for every direction of slip: against its force, or
 * with it while its limit falls. */
static void friction_is_continuous_where_it_begins_to_slide(void **state)
{
    const fl_vec3 n = v3(0, 0, 1), v = v3(0.1, 0, 0);
    const double dt = 1e-9, k = 1000.0, g = 30.0, f = 10.0;
    (void)state;
    for (int way = -1; way <= 1; way += 2)
        for (int e = -1; e <= 1; e++) {
            fl_friction_springs s = {.force = v3(f, 0, 0), .k = k};
            assert_near(slide_point(&s, n, v3_scale(way, v), 0.0, dt, k, g, f * (1.0 + 1e-6 * e)).x, f, 3e-5);
        }
    /* and far from the limit damping is complete */
    fl_friction_springs s = {.force = v3(f, 0, 0), .k = k};
    assert_near(slide_point(&s, n, v, 0.0, dt, k, g, 2.0 * f).x, f - g * v.x, 1e-6);
}

/* A spring with a stiffness that rises and falls again: k = t (2 - t), v = cos 3t, F = -int k v dt up to t =
 * 1, and F/k = F(1) - int v dt after it. Half the step leaves a quarter of the error. */
static void friction_springs_are_of_order_two(void **state)
{
    const fl_vec3 n = v3(0, 0, 1);
    const double end = 1.9, at1 = 2.0 / 9.0 - sin(3.0) * 11.0 / 27.0, /* int t (2 - t) cos 3t, t = 0 to 1 */
        truth = end * (2.0 - end) * (at1 - (sin(3.0 * end) - sin(3.0)) / 3.0);
    double off[2];
    (void)state;
    for (int fine = 0; fine < 2; fine++) {
        const int steps = 190 << fine;
        const double dt = end / steps;
        fl_friction_springs s = {0};
        fl_vec3 f = v3(0, 0, 0);
        for (int i = 1; i <= steps; i++) {
            const double t = i * dt;
            f = slide_point(&s, n, v3(cos(3.0 * (t - 0.5 * dt)), 0, 0), 0.0, dt, t * (2.0 - t), 0.0, 100.0);
        }
        off[fine] = fabs(f.x - truth);
    }
    assert_true(off[0] < 1e-4);
    assert_near_of(off[0] / off[1], 4.0, 0.1, 4.0);
}

/* Sliding follows e' = -(k/limit)(v - (v.e) e). With v rotating at constant rate, from a perpendicular start,
 * it is compared with steps a hundredth as long. In the end e lags behind -v by the angle with sine Omega
 * limit/(k |v|), for every step; the step of the last row is a hundred times the time constant. */
static void sliding_follows_the_path_to_order_two(void **state)
{
    static const struct {
        double k, dt;
    } row[] = {{2.0, 0.05}, {2.0, 0.025}, {2.0, 0.0125}, {1000.0, 0.1}};
    const double limit = 1.0, omega = 0.5;
    double off[3];
    (void)state;
    for (int r = 0; r < 4; r++) {
        fl_vec3 e[2];
        double lag = 0.0;
        for (int fine = 0; fine < 2; fine++) {
            const double dt = fine ? 0.01 * row[r].dt : row[r].dt;
            const fl_friction_contact c = {.n = v3(0, 0, 1), .k = row[r].k, .limit = limit};
            fl_friction_springs s = {.force = v3(0, limit, 0), .k = row[r].k};
            for (int i = 1; i * dt < (r < 3 ? 1.0 : 20.0) + 0.5 * dt; i++) {
                const double mid = omega * (i - 0.5) * dt, at = omega * i * dt;
                const fl_friction_motion by = {.v = v3(cos(mid), sin(mid), 0),
                                               .v_end = v3(cos(at), sin(at), 0)};
                s = fl_tangent_step(s, c, by, dt).springs;
                lag = v3_cross(by.v_end, s.force).z;
            }
            e[fine] = s.force;
            assert_near(v3_norm(e[fine]), limit, 1e-14);
        }
        if (r < 3) off[r] = v3_norm(v3_sub(e[0], e[1]));
        else assert_near(lag, omega * limit / row[r].k, 0.02);
    }
    assert_true(off[0] < 1.1e-3);
    assert_near_of(off[0] / off[1], 4.0, 0.2, 4.0);
    assert_near_of(off[1] / off[2], 4.0, 0.1, 4.0);
}

/* Rotation on the spot: a torsional spring of a k rho^2 about the normal up to sqrt(a) rho L; with slip the
 * two share the limit. */
static void torsion_and_sliding_share_the_limit(void **state)
{
    const double k = 1000.0, dt = 1e-3, arm = 0.2, limit = 5.0, spin = 3.0, a = 0.885;
    const fl_friction_contact c = {.n = v3(0, 0, 1), .k = k, .limit = limit, .arm = arm};
    fl_friction_springs s = {.k = k, .k_turn = k * arm * arm};
    double m = 0.0, dissipated = 0.0, before = 0.0;
    (void)state;
    friction_force(&s, &c, v3(0, 0, 0), spin, 0.0, dt, &m);
    assert_near(m, -a * k * arm * arm * spin * dt, 1e-14);
    for (int i = 0; i < 100; i++) friction_force(&s, &c, v3(0, 0, 0), spin, 0.0, dt, &m);
    assert_near(m, -sqrt(a) * limit * arm, 1e-14);
    assert_near(s.energy, 0.5 * limit * limit / k, 1e-14);
    /* steady slip and spin: the wrench is that of the potential */
    fl_vec3 f = v3(0, 0, 0);
    for (int i = 0; i < 20000; i++) f = friction_force(&s, &c, v3(spin * arm, 0, 0), spin, 0.0, dt, &m);
    const flat_wrench steady =
        law_friction((fl_sym3){.xx = 0.5 * arm * arm, .yy = 0.5 * arm * arm}, v3(spin * arm, 0, 0), spin);
    assert_near(f.x, -limit * steady.x, 1e-6);
    assert_near(m, -limit * steady.m, 1e-6);
    /* work is always dissipated */
    s = (fl_friction_springs){0};
    for (int i = 1; i <= 20000; i++) {
        const double t = i * dt, w = 2.0 * sin(3.0 * t);
        const fl_vec3 v = v3(cos(5.0 * t), sin(2.0 * t), 0);
        f = friction_force(&s, &c, v, w, 0.0, dt, &m);
        const double power = -(v3_dot(f, v) + m * w);
        dissipated += 0.5 * dt * (power + before);
        before = power;
        assert_true(dissipated - s.energy > -2.0 * dt * k * dt * i);
    }
    assert_true(dissipated > s.energy);
    const fl_friction_contact point = {.n = v3(0, 0, 1), .k = k, .limit = limit};
    friction_force(&s, &point, v3(1, 0, 0), spin, 0.0, dt, &m); /* a point has no torsion */
    assert_near(m, 0.0, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damping_is_that_of_the_table),
        cmocka_unit_test(damping_of_every_restitution_is_finite),
        cmocka_unit_test(damping_of_one_contact_uses_the_speed_at_the_end),
        cmocka_unit_test(damping_of_many_is_stable),
        cmocka_unit_test(a_sustained_load_is_not_damped),
        cmocka_unit_test(low_pass_has_order_two),
        cmocka_unit_test(damping_solves_its_equation),
        cmocka_unit_test(a_slow_contact_is_damped_at_most_as_an_impact),
        cmocka_unit_test(material_gives_hertz_and_flat_punch),
        cmocka_unit_test(normal_powers_are_derivatives_of_one_another),
        cmocka_unit_test(manual_modes_are_those_of_the_table),
        cmocka_unit_test(manual_crossed_edges),
        cmocka_unit_test(manual_sharp_sides_are_finite),
        cmocka_unit_test(manual_damping_by_its_exponent),
        cmocka_unit_test(friction_sticks_slides_and_comes_back),
        cmocka_unit_test(friction_memory_rotates_with_the_contact),
        cmocka_unit_test(friction_damping_stays_within_the_limit),
        cmocka_unit_test(friction_damping_solves_its_equation),
        cmocka_unit_test(friction_creates_no_energy),
        cmocka_unit_test(a_corrected_stiffness_creates_no_energy),
        cmocka_unit_test(friction_is_continuous_where_it_begins_to_slide),
        cmocka_unit_test(friction_springs_are_of_order_two),
        cmocka_unit_test(sliding_follows_the_path_to_order_two),
        cmocka_unit_test(torsion_and_sliding_share_the_limit),
        cmocka_unit_test(friction_unloads_along_its_stiffness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
