/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "support/near.h"
#include "base/pi.h"
#include "bond/joint_law.h"

static const double NONE[2] = {0, 0};

/* Slip is along the trial stress, in any direction of the plane, and energy is exact. */
static void slip_follows_the_shear_stress(void **state)
{
    (void)state;
    const double t = tan(30.0 * PI / 180.0);
    const fl_joint_material m = {.law = FL_JOINT_COULOMB,
                                 .kn = 1e10,
                                 .ks = 1e9,
                                 .friction = t,
                                 .residual_friction = t,
                                 .tension = 0.1e6,
                                 .dilation = 0.1,
                                 .dilation_slip = INFINITY};
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

static void the_energy_of_closure_is_the_integral_of_the_stress(void **state)
{
    (void)state;
    double stored;
    fl_joint_material m = {.law = FL_JOINT_YIELDING, .kn = 1e8, .normal_exponent = 0.5, .kn_most = INFINITY};
    double u = fl_joint_closure(&m, 0.1e6);
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
        cmocka_unit_test(slip_follows_the_shear_stress),
        cmocka_unit_test(the_energy_of_closure_is_the_integral_of_the_stress),
    };
    return cmocka_run_group_tests(test, NULL, NULL);
}
