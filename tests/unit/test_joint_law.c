/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "support/near.h"
#include "base/pi.h"
#include "bond/joint_law.h"

static const double NONE[2] = {0, 0};

/* J1: 1 MPa on the joint, slid to 2 mm and back. */
static fl_joint_material rough_joint(void)
{
    const double t = tan(30.0 * PI / 180.0);
    return (fl_joint_material){.law = FL_JOINT_COULOMB,
                               .kn = 1e10,
                               .ks = 1e9,
                               .friction = t,
                               .residual_friction = t,
                               .cohesion = 0.2e6,
                               .tension = 0.1e6,
                               .dilation_slip = INFINITY};
}

/* Moves a point along x by `way` in n steps at the opening s_n; adds work, friction. */
typedef struct {
    double work, friction, stored;
} energies;

static void slide(const fl_joint_material *m, fl_joint_point *p, double s_n, double way, int n, energies *e)
{
    const double ds[2] = {way / n, 0.0};
    for (int k = 0; k < n; k++) {
        const double before = p->tau[0];
        const fl_joint_point_result r = fl_joint_laws[m->law].step(m, p, s_n, ds);
        if (!e) continue;
        e->work += 0.5 * (before + p->tau[0]) * ds[0], e->friction += r.friction, e->stored = r.stored;
    }
}

static void a_joint_with_cohesion_peaks_and_falls_to_friction(void **state)
{
    (void)state;
    const fl_joint_material m = rough_joint();
    const double peak = 0.7773503e6, rest = 0.5773503e6, closed = 0.5e12 / 1e10;
    fl_joint_point p;
    energies e = {0};
    fl_joint_point_start(&m, &p, 1e6, NONE);
    slide(&m, &p, 0.0, 0.7773e-3, 7773, &e);
    assert_near(p.tau[0], 0.7773e6, 1e-9);
    assert_false(p.failed);
    slide(&m, &p, 0.0, 0.0002e-3, 2, &e);
    assert_true(p.failed);
    assert_near(p.tau[0], rest, 1e-6);
    slide(&m, &p, 0.0, 2e-3 - 0.7775e-3, 12225, &e);
    assert_near(p.tau[0], rest, 1e-6);
    assert_near(e.work, 1008.034, 1e-3); /* the peak is cut by a step */
    assert_near(e.friction, 705.897, 1e-3);
    assert_near(e.stored - closed, 166.667, 1e-5);
    assert_near(e.work - e.friction - (e.stored - closed), 135.470, 1e-2);
    (void)peak;
    /* back: elastic until the other side of the friction */
    slide(&m, &p, 0.0, 0.8453e-3 - 2e-3, 11547, NULL);
    assert_near(p.tau[0], rest - 1e9 * (2e-3 - 0.8453e-3), 1e-6);
    slide(&m, &p, 0.0, -0.3e-3, 300, NULL);
    assert_near(p.tau[0], -rest, 1e-6);
}

static void tension_opens_a_joint_for_good(void **state)
{
    (void)state;
    const fl_joint_material m = rough_joint();
    fl_joint_point p;
    fl_joint_point_start(&m, &p, 0.0, NONE);
    fl_joint_coulomb_step(&m, &p, 0.0099e-3, NONE);
    assert_near(p.sigma, -0.099e6, 1e-9);
    fl_joint_coulomb_step(&m, &p, 0.0101e-3, NONE);
    assert_true(p.sigma == 0.0 && p.open);
    fl_joint_coulomb_step(&m, &p, 0.005e-3, (const double[]){1e-3, 0});
    assert_true(p.sigma == 0.0 && p.tau[0] == 0.0);
    /* pressed again it has friction alone */
    fl_joint_coulomb_step(&m, &p, -1e-4, (const double[]){2e-3, 0});
    assert_near(p.sigma, 1e6, 1e-9);
    assert_near(p.tau[0], 0.5773503e6, 1e-6);
}

/* J2: held at its opening, a joint with dilation gains pressure. */
static void a_held_joint_with_dilation_gains_pressure(void **state)
{
    (void)state;
    fl_joint_material m = rough_joint();
    m.cohesion = m.tension = 0.0;
    m.dilation = tan(5.0 * PI / 180.0);
    fl_joint_point p;
    fl_joint_point_start(&m, &p, 1e6, NONE);
    slide(&m, &p, 0.0, 2e-3, 20000, NULL);
    assert_near(p.slip, 0.945209e-3, 1e-6);
    assert_near(p.sigma, 1.826951e6, 1e-6);
    assert_near(p.tau[0], 1.054791e6, 1e-6);
    m.dilation_slip = 0.5e-3;
    fl_joint_point_start(&m, &p, 1e6, NONE);
    slide(&m, &p, 0.0, 4e-3, 40000, NULL);
    assert_near(p.sigma, 1e6 + 1e10 * m.dilation * 0.5e-3, 1e-3);
}

/* Slip is along the trial stress, in any direction of the plane, and energy is exact. */
static void slip_follows_the_shear_stress(void **state)
{
    (void)state;
    fl_joint_material m = rough_joint();
    m.cohesion = 0.0, m.dilation = 0.1;
    fl_joint_point p;
    double work = 0.0, friction = 0.0;
    fl_joint_point_start(&m, &p, 1e6, NONE);
    const double first = 0.5 * 1e12 / 1e10;
    double stored = first, s_n = 0.0;
    for (int k = 0; k < 4000; k++) {
        const double a = 0.002 * k, ds[2] = {1e-6 * cos(a), 1e-6 * sin(a)}, open = 5e-9 * sin(0.05 * k);
        const double s0 = p.sigma, t0[2] = {p.tau[0], p.tau[1]};
        const fl_joint_point_result r = fl_joint_coulomb_step(&m, &p, s_n + open, ds);
        work +=
            0.5 * (t0[0] + p.tau[0]) * ds[0] + 0.5 * (t0[1] + p.tau[1]) * ds[1] - 0.5 * (s0 + p.sigma) * open;
        s_n += open;
        friction += r.friction, stored = r.stored;
        assert_true(sqrt(p.tau[0] * p.tau[0] + p.tau[1] * p.tau[1]) <= (1.0 + 1e-12) * p.sigma * m.friction);
    }
    assert_near_of(work, stored - first + friction, 1e-12, work);
}

static fl_joint_material yielding_joint(double stress_factor, double first, double last, double roughness)
{
    return (fl_joint_material){.law = FL_JOINT_YIELDING,
                               .kn = 1e10,
                               .ks = stress_factor,
                               .shear_exponent = 1.0,
                               .kn_most = INFINITY,
                               .ks_most = INFINITY,
                               .angle = last * PI / 180.0,
                               .initial_angle = first * PI / 180.0,
                               .roughness = roughness};
}

/* CY-1: monotonic to 12 mm, computed with an integrator of order 5 to 1e-11. */
static void a_yielding_joint_peaks_and_softens(void **state)
{
    (void)state;
    static const double CURVE[][3] = {{1, 6.69024, 48.4117},  {2, 9.05411, 45.2120}, {3, 9.28019, 41.9143},
                                      {4, 8.70777, 39.1470},  {5, 8.02073, 37.0024}, {6, 7.45118, 35.3764},
                                      {7, 7.02641, 34.1429},  {8, 6.71675, 33.2016}, {9, 6.48957, 32.4793},
                                      {10, 6.32072, 31.9227}, {12, 6.09735, 31.1597}};
    const fl_joint_material m = yielding_joint(1e3, 50.0, 30.0, 4e-3);
    fl_joint_point p;
    double at = 0.0, peak = 0.0;
    fl_joint_point_start(&m, &p, 10e6, NONE);
    for (size_t k = 0; k < sizeof CURVE / sizeof *CURVE; k++) {
        for (int e = 0; e < 1000; e++) {
            slide(&m, &p, 0.0, (CURVE[k][0] - at) * 1e-6, 1, NULL);
            peak = fmax(peak, p.tau[0]);
        }
        at = CURVE[k][0];
        assert_near(p.tau[0], CURVE[k][1] * 1e6, 1e-4);
        assert_near(p.angle * 180.0 / PI, CURVE[k][2], 1e-4);
    }
    assert_near(peak, 9.345613e6, 1e-4);
}

/* CY-3: to 3 mm, back to 2.7, on to 5, back to 0. */
static void a_yielding_joint_under_cyclic_slip(void **state)
{
    (void)state;
    static const struct {
        double u, tau, angle;
    } CURVE[] = {{0.6, .450164, 0},      {1.2, .688670, 0},  {1.8, .802352, 0},        {2.4, .843705, 0},
                 {3, .845699, 39.74925}, {2.88, .729886, 0}, {2.7, .570932, 39.70017}, {3.16, .780565, 0},
                 {3.62, .798467, 0},     {4.08, .782546, 0}, {5, .744361, 36.33969},   {4, .017019, 0},
                 {3, -.349560, 0},       {2, -.526173, 0},   {0, -.632685, 33.07172}};
    const fl_joint_material m = yielding_joint(1e3, 45.0, 30.0, 5e-3);
    fl_joint_point p;
    double at = 0.0;
    fl_joint_point_start(&m, &p, 1e6, NONE);
    for (size_t k = 0; k < sizeof CURVE / sizeof *CURVE; k++) {
        slide(&m, &p, 0.0, (CURVE[k].u - at) * 1e-3, 2000, NULL);
        at = CURVE[k].u;
        assert_near_of(p.tau[0], CURVE[k].tau * 1e6, 1e-4, 1e6);
        if (CURVE[k].angle > 0.0) assert_near(p.angle * 180.0 / PI, CURVE[k].angle, 1e-4);
    }
}

/* One long step gives what many short ones give: steps are divided. */
static void long_steps_are_divided(void **state)
{
    (void)state;
    const fl_joint_material m = yielding_joint(1e3, 50.0, 30.0, 4e-3);
    fl_joint_point p;
    fl_joint_point_start(&m, &p, 10e6, NONE);
    slide(&m, &p, 0.0, 2e-3, 1, NULL);
    assert_near(p.tau[0], 9.05411e6, 2e-4);
}

static void closure_is_integrated_exactly(void **state)
{
    (void)state;
    double stored, u;
    fl_joint_material m = {.law = FL_JOINT_YIELDING, .kn = 1e4, .normal_exponent = 1.0, .kn_most = INFINITY};
    u = fl_joint_closure(&m, 0.1e6);
    assert_near(fl_joint_closing_stress(&m, u, &stored), 0.1e6, 1e-12);
    assert_near(fl_joint_closing_stress(&m, u + 1e-4, &stored), 0.271828e6, 1e-5);
    assert_near(fl_joint_closing_stress(&m, u + 2e-4, &stored), 0.738906e6, 1e-5);
    m.kn = 1e8, m.normal_exponent = 0.5;
    u = fl_joint_closure(&m, 0.1e6);
    assert_near(fl_joint_closing_stress(&m, u + 1e-4, &stored), 28.2623e6, 1e-5);
    /* the energy is the integral of the stress */
    double a, b, s0 = fl_joint_closing_stress(&m, u, &a), s1 = fl_joint_closing_stress(&m, u + 1e-8, &b);
    assert_near(b - a, 0.5 * (s0 + s1) * 1e-8, 1e-6);
    /* above the cap it is linear */
    m.kn_most = 1e12;
    u = fl_joint_closure(&m, 2e8);
    s0 = fl_joint_closing_stress(&m, u, &a), s1 = fl_joint_closing_stress(&m, u + 1e-6, &b);
    assert_near(s1 - s0, 1e6, 1e-6);
    assert_near(b - a, 0.5 * (s0 + s1) * 1e-6, 1e-6);
    assert_true(fl_joint_closing_stress(&m, -1e-5, &stored) == 0.0 && stored == 0.0);
}

int main(void)
{
    const struct CMUnitTest test[] = {
        cmocka_unit_test(a_joint_with_cohesion_peaks_and_falls_to_friction),
        cmocka_unit_test(tension_opens_a_joint_for_good),
        cmocka_unit_test(a_held_joint_with_dilation_gains_pressure),
        cmocka_unit_test(slip_follows_the_shear_stress),
        cmocka_unit_test(a_yielding_joint_peaks_and_softens),
        cmocka_unit_test(a_yielding_joint_under_cyclic_slip),
        cmocka_unit_test(long_steps_are_divided),
        cmocka_unit_test(closure_is_integrated_exactly),
    };
    return cmocka_run_group_tests(test, NULL, NULL);
}
