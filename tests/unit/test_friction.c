/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Friction of faces: the closed forms of Coulomb's law, the law of law/tangent.h beside them, its limit and
 * its dissipation. */
#include <math.h>
#include "base/pi.h"
#include "base/rng.h"
#include "law/tangent.h"
#include "patch/patch_result.h"
#include "support/exact_friction.h"
#include "support/near.h"

static void make_regular(int n, double r, fl_vec3 *corner)
{
    for (int k = 0; k < n; k++) corner[k] = v3(r * cos(2.0 * PI * k / n), r * sin(2.0 * PI * k / n), 0.0);
}

static void make_rectangle(double a, double b, fl_vec3 corner[4])
{
    corner[0] = v3(-0.5 * a, -0.5 * b, 0), corner[1] = v3(0.5 * a, -0.5 * b, 0);
    corner[2] = v3(0.5 * a, 0.5 * b, 0), corner[3] = v3(-0.5 * a, 0.5 * b, 0);
}

/* The disc of a polygon of n sides has the same area: its friction differs by some 1/n^4. */
static void a_polygon_of_many_sides_is_a_disc(void **state)
{
    enum { N = 1000 };
    static fl_vec3 c[N];
    (void)state;
    make_regular(N, sqrt(2.0 * PI / N / sin(2.0 * PI / N)), c);
    for (double e = 1.0 / 64.0; e < 100.0; e *= 2.0) {
        double F, M;
        exact_disc_friction(e, &F, &M);
        const flat_wrench q = exact_polygon_friction(N, c, v3(e, 0, 0), 1.0);
        assert_near_of(q.x, F, 1e-6, 1.0);
        assert_near_of(q.y, 0.0, 1e-6, 1.0);
        assert_near_of(q.m, M, 1e-6, 1.0);
    }
    assert_near(polygon_mean_distance(N, c), 2.0 / 3.0, 1e-5);
}

/* Midpoint rule over a rectangle and a triangle, (F, M) as the gradient of P, and the mean distances. */
static void a_polygon_is_its_integral(void **state)
{
    enum { N = 1000 };
    fl_vec3 c[4];
    (void)state;
    make_rectangle(1.0, 1.0, c);
    assert_near(polygon_mean_distance(4, c), 0.38259785823, 1e-10);
    make_rectangle(3.0, 1.0, c);
    assert_near(polygon_mean_distance(4, c), 0.823146, 1e-6);
    for (int k = 0; k < 3; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const fl_vec3 v = v3(fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1), 0.0);
        const double w = fl_rng_in(&g, -2, 2);
        const flat_wrench q = exact_polygon_friction(4, c, v, w);
        flat_wrench sum = {0, 0, 0};
        for (int i = 0; i < 3 * N; i++)
            for (int j = 0; j < N; j++) {
                const double x = (i + 0.5) / N - 1.5, y = (j + 0.5) / N - 0.5, ux = v.x - w * y,
                             uy = v.y + w * x, each = 1.0 / (sqrt(ux * ux + uy * uy) * 3.0 * N * N);
                sum.x += each * ux, sum.y += each * uy, sum.m += each * (x * uy - y * ux);
            }
        assert_near_of(q.x, sum.x, 1e-5, 1.0);
        assert_near_of(q.y, sum.y, 1e-5, 1.0);
        assert_near_of(q.m, sum.m, 1e-5, 1.0);
    }
}

/* Worst errors of the law, of F over mu N and of M over its largest value, over ratios of v and rho w from
 * 1/40 to 40 and all directions, about the centre. */
static void worst_errors(int n, const fl_vec3 *corner, double *force, double *moment)
{
    fl_vec3 centre, c[8];
    const fl_sym3 C = polygon_second_moments(n, corner, &centre);
    const double rho = sqrt(C.xx + C.yy);
    for (int k = 0; k < n; k++) c[k] = v3_sub(corner[k], centre);
    const double most = polygon_mean_distance(n, c);
    *force = *moment = 0.0;
    for (int r = 0; r <= 60; r++)
        for (int d = 0; d < 72; d++) {
            const double v = rho * 0.025 * pow(1600.0, r / 60.0), a = 2.0 * PI * d / 72;
            const fl_vec3 way = v3(v * cos(a), v * sin(a), 0.0);
            const flat_wrench exact = exact_polygon_friction(n, c, way, 1.0), law = law_friction(C, way, 1.0);
            *force = fmax(*force, hypot(law.x - exact.x, law.y - exact.y));
            *moment = fmax(*moment, fabs(law.m - exact.m) / most);
        }
}

/* The law under an even pressure: the figures of law/tangent.h. */
static void the_law_is_near_coulombs(void **state)
{
    fl_vec3 c[4];
    double f, m;
    (void)state;
    make_rectangle(1.0, 1.0, c);
    worst_errors(4, c, &f, &m);
    assert_true(f < 0.023 && m < 0.024);
    make_rectangle(3.0, 1.0, c);
    worst_errors(4, c, &f, &m);
    assert_true(f < 0.042 && m < 0.055);
    make_regular(3, 1.0, c);
    worst_errors(3, c, &f, &m);
    assert_true(f < 0.065 && m < 0.062);
    for (double e = 1.0 / 40.0; e < 40.0; e *= 1.1) { /* disc, e = v/(w R), rho = R/sqrt(2) */
        double F, M;
        exact_disc_friction(e, &F, &M);
        const flat_wrench q = law_friction((fl_sym3){.xx = 0.25, .yy = 0.25}, v3(e, 0, 0), 1.0);
        assert_near_of(q.x, F, 0.0085, 1.0);
        assert_near_of(q.m, M, 0.012, 2.0 / 3.0);
    }
    /* a line: L/4 of a quarter of its length */
    const flat_wrench line = law_friction((fl_sym3){.xx = 1.0 / 12.0}, v3(0, 0, 0), 1.0);
    assert_near(line.m, 0.25, 1e-14);
}

/* A random shape of the pressure across a random normal: from a line to a disc. */
static fl_friction_contact random_contact(fl_rng *g)
{
    fl_friction_contact c = {.n = v3_unit(v3(fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g)))};
    const double thin = fl_rng_in(g, 0, 1) < 0.2 ? 0.0 : fl_rng_in(g, 0, 1);
    const fl_vec3 x = v3_normal_to(c.n), y = v3_cross(c.n, x);
    const double a = fl_rng_in(g, 0, 2.0 * PI), arm = exp(fl_rng_in(g, -4, 2));
    const fl_vec3 u = v3_madd(v3_scale(cos(a), x), sin(a), y), t = v3_cross(c.n, u);
    const fl_sym3 along = {u.x * u.x, u.x * u.y, u.x * u.z, u.y * u.y, u.y * u.z, u.z * u.z},
                  aside = {t.x * t.x, t.x * t.y, t.x * t.z, t.y * t.y, t.y * t.z, t.z * t.z};
    const fl_pressure_shape s =
        fl_pressure_shape_of(s3_add(s3_times(arm * arm, along), s3_times(thin * arm * arm, aside)), c.n);
    assert_near(s.arm, arm * sqrt(1.0 + thin), 1e-12);
    assert_near_of(v3_norm2(s.elongation), (1.0 - thin) / (1.0 + thin), 1e-12, 1.0);
    assert_near_of(fabs(v3_dot(s.elongation, t)), v3_norm(s.elongation), 1e-7,
                   1.0); /* Theta: turned by 90 degrees */
    c.arm = s.arm, c.elongation = s.elongation;
    c.k = exp(fl_rng_in(g, 0, 10)), c.limit = exp(fl_rng_in(g, -3, 6)), c.g = exp(fl_rng_in(g, -8, 8));
    c.contact_count = 1.0;
    return c;
}

static double value_of(const fl_friction_contact *c, fl_friction_wrench z)
{
    const fl_friction_shape s = fl_friction_shape_of(c->elongation);
    return sqrt(fl_friction_potential_of(&s, z).p2);
}

static fl_friction_wrench random_slip(fl_rng *g, const fl_friction_contact *c, double size)
{
    const fl_vec3 x = v3_normal_to(c->n), y = v3_cross(c->n, x);
    return (fl_friction_wrench){
        v3_add(v3_scale(size * fl_rng_normal(g), x), v3_scale(size * fl_rng_normal(g), y)),
        size * fl_rng_normal(g)};
}

/* Steps of random slip between contacts of random shape, stiffness, damping and limit: the wrench is inside
 * the limit surface, F.v + M w <= L P(v, rho w) for all motions; the springs never hold more than they held
 * and than the slip has put in, so what is lost is not negative. */
static void no_step_creates_energy_or_leaves_the_limit(void **state)
{
    const long cases = test_times(2000);
    (void)state;
    for (long k = 0; k < cases; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_friction_contact c = random_contact(&g);
        fl_friction_springs s = {.k = c.k, .k_turn = c.k * c.arm * c.arm};
        for (int i = 0; i < 500; i++) {
            const double old_k = s.k, held = s.energy, dt = 1e-3;
            const int new_shape = i % 7 == 0;
            if (new_shape) {
                const fl_vec3 n = c.n;
                c = random_contact(&g);
                c.n = n;
                const fl_vec3 e = c.elongation;
                c.elongation = v3_madd(e, -v3_dot(e, n), n);
            } else {
                c.limit *= exp(fl_rng_in(&g, -0.2, 0.2));
            }
            const fl_friction_wrench way = random_slip(&g, &c, c.limit / c.k * exp(fl_rng_in(&g, -4, 2)));
            const fl_vec3 v = v3_scale(1.0 / dt, way.f);
            const double spin = way.m / (dt * c.arm);
            const fl_friction_motion by = {.v = v,
                                           .v_end = v,
                                           .spin = spin,
                                           .spin_end = spin,
                                           .mean_spin = fl_rng_in(&g, -3, 3),
                                           .half_step = 0.5 * dt};
            const fl_friction_springs was = s;
            const fl_friction_result r = fl_tangent_step(s, c, by, dt);
            s = r.springs;
            const fl_friction_wrench z = {s.force, s.moment / c.arm}, total = {r.force, r.moment / c.arm};
            assert_true(value_of(&c, z) <= c.limit * (1.0 + 1e-12));
            for (int m = 0; m < 4; m++) {
                const fl_friction_wrench u = random_slip(&g, &c, 1.0);
                assert_true(fl_friction_wrench_dot(total, u) <= c.limit * value_of(&c, u) * (1.0 + 1e-12));
            }
            /* the springs at rest in the new contact, then the slip along them */
            const fl_friction_motion rest = {.mean_spin = by.mean_spin, .half_step = 0.5 * dt};
            fl_friction_contact free = c;
            free.limit = 1e300, free.g = 0.0;
            const fl_friction_springs laid = fl_tangent_step(was, free, rest, dt).springs;
            assert_true(laid.energy <= held * (1.0 + 1e-12));
            const double k_mean = c.k < old_k ? c.k : 0.5 * (c.k + old_k), turn = c.k * c.arm * c.arm,
                         turn_mean = turn < was.k_turn ? turn : 0.5 * (turn + was.k_turn);
            const fl_friction_wrench from = {laid.force, laid.moment / c.arm},
                                     to = {v3_madd(from.f, -k_mean, way.f),
                                           from.m - turn_mean / (c.arm * c.arm) * way.m};
            const double most = 0.5 * value_of(&c, to) * value_of(&c, to) / c.k;
            assert_true(s.energy <= most * (1.0 + 1e-9));
        }
    }
}

/* A face of no extent is a point to the last bit. */
static void a_face_of_no_extent_is_a_point(void **state)
{
    (void)state;
    for (int k = 0; k < 200; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_friction_contact c = random_contact(&g);
        c.arm = 0.0, c.elongation = v3(0, 0, 0), c.g = 0.0;
        fl_friction_springs s = {.k = c.k};
        fl_vec3 f = v3(0, 0, 0);
        double size = 0.0;
        for (int i = 0; i < 20; i++) {
            const fl_vec3 v = random_slip(&g, &c, c.limit / c.k * 300.0).f;
            const fl_friction_motion by = {
                .v = v, .v_end = v, .spin = 3.0, .spin_end = 3.0, .half_step = 5e-4};
            /* the law of spheres */
            const fl_tangent_spring point = {.k = c.k, .limit = c.limit, .contact_count = 1.0};
            const fl_friction_forces p =
                fl_tangent_point_step(s.force, s.force, s.k, point, v3_madd(v, -v3_dot(v, c.n), c.n),
                                      v3_madd(v, -v3_dot(v, c.n), c.n), v3(0, 0, 0), 1e-3, 5e-4, 0.0);
            const fl_friction_result r = fl_tangent_step(s, c, by, 1e-3);
            s = r.springs, f = r.force, size = fmax(size, v3_norm(f));
            assert_near_of(v3_norm(v3_sub(f, p.elastic.f)), 0.0, 1e-13, c.limit);
            assert_true(r.moment == 0.0 && s.force.x == f.x && s.force.y == f.y && s.force.z == f.z);
        }
        assert_true(size <= c.limit * (1.0 + 1e-14));
    }
}

/* Half the step leaves a quarter of the error where a contact slides and turns under changing motion. */
static void sliding_with_spin_is_of_order_two(void **state)
{
    fl_friction_contact c = {
        .n = v3(0, 0, 1), .k = 100.0, .limit = 1.0, .arm = 0.4, .elongation = v3(0.5, 0.3, 0)};
    double off[3], f[4][3];
    (void)state;
    for (int fine = 0; fine < 4; fine++) {
        const int steps = fine < 3 ? 50 << fine : 6400;
        const double dt = 0.2 / steps;
        fl_friction_springs s = {
            .force = v3(0.6, -0.2, 0), .k = c.k, .k_turn = c.k * c.arm * c.arm, .moment = 0.1};
        s.energy = 1.0;
        for (int i = 0; i < steps; i++) {
            const double mid = (i + 0.5) * dt, end = (i + 1) * dt;
            const fl_friction_motion by = {.v = v3(cos(8 * mid), sin(5 * mid), 0),
                                           .v_end = v3(cos(8 * end), sin(5 * end), 0),
                                           .spin = 2 * cos(9 * mid),
                                           .spin_end = 2 * cos(9 * end)};
            const fl_friction_result r = fl_tangent_step(s, c, by, dt);
            s = r.springs;
            f[fine][0] = r.force.x, f[fine][1] = r.force.y, f[fine][2] = r.moment;
        }
    }
    for (int k = 0; k < 3; k++)
        off[k] = sqrt(pow(f[k][0] - f[3][0], 2) + pow(f[k][1] - f[3][1], 2) + pow(f[k][2] - f[3][2], 2));
    assert_true(off[0] < 5e-2);
    assert_near_of(off[0] / off[1], 4.0, 0.8, 4.0);
    assert_near_of(off[1] / off[2], 4.0, 0.5, 4.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_polygon_of_many_sides_is_a_disc),
        cmocka_unit_test(a_polygon_is_its_integral),
        cmocka_unit_test(the_law_is_near_coulombs),
        cmocka_unit_test(no_step_creates_energy_or_leaves_the_limit),
        cmocka_unit_test(a_face_of_no_extent_is_a_point),
        cmocka_unit_test(sliding_with_spin_is_of_order_two),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
