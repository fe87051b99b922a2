/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Growth and its parts on configurations with a known answer: the pressure of a row of discs, its jamming
 * scale, the gradient of the energy, FIRE on a quadratic valley. */
#include <math.h>
#include <stdlib.h>
#include "support/near.h"
#include "base/rng.h"
#include "pack/growth.h"

typedef struct {
    fl_pack_region region;
    fl_pack_shapes shapes;
    fl_packing p;
    fl_overlaps o;
} sample;

static void make_sample(sample *s, const char *in, int dim, int32_t n, double d, const char *shape)
{
    fl_err err = {0};
    double *size = malloc((size_t)n * sizeof *size);
    for (int32_t k = 0; k < n; k++) size[k] = d;
    assert_int_equal(fl_region_make(&s->region, in, dim, "", &err), 0);
    assert_int_equal(fl_pack_shapes_make(&s->shapes, shape, &err), 0);
    assert_int_equal(fl_packing_make(&s->p, dim, n, size, &s->shapes, 1, &err), 0);
    assert_int_equal(fl_overlaps_make(&s->o, &s->p, &s->region, &err), 0);
    free(size);
}

static void free_sample(sample *s)
{
    fl_overlaps_free(&s->o);
    fl_packing_free(&s->p);
    fl_pack_shapes_free(&s->shapes);
    fl_region_free(&s->region);
}

/* E of a one-dimensional valley k x^2/2: FIRE ends at the bottom. */
static void fire_finds_the_bottom(void **state)
{
    (void)state;
    double x[2] = {1.0, -0.7}, v[2] = {0.0, 0.0};
    const double k[2] = {4.0, 0.05};
    fl_fire r = fl_fire_start(0.5);
    int steps = 0;
    for (; steps < 2000; steps++) {
        double power = 0.0, f2 = 0.0, v2 = 0.0;
        for (int a = 0; a < 2; a++) {
            const double f = -k[a] * x[a];
            power += f * v[a], f2 += f * f, v2 += v[a] * v[a];
        }
        if (f2 < 1e-20) break;
        const fl_fire_step s = fl_fire_next(&r, power, f2, v2);
        for (int a = 0; a < 2; a++) {
            const double f = -k[a] * x[a], back = s.back * v[a];
            v[a] = s.keep * v[a] + s.push * s.dt * f;
            x[a] += s.dt * v[a] - back;
        }
    }
    assert_true(steps < 1000);
    assert_near_of(x[0], 0.0, 1e-8, 1.0);
    assert_near_of(x[1], 0.0, 1e-7, 1.0);
}

/* Three discs in a row in a box that is 0.3 too short: all four contacts are pressed in by 0.075 each. */
static void a_row_of_discs_shares_its_overlap(void **state)
{
    (void)state;
    sample s = {0};
    fl_err err = {0};
    make_sample(&s, "box:0,0,0,2.7,1.2,0", 2, 3, 1.0, "sphere");
    s.p.x[0] = v3(0.5, 0.6, 0), s.p.x[1] = v3(1.3, 0.6, 0), s.p.x[2] = v3(2.2, 0.6, 0);
    const int state_of = fl_overlaps_relax(&s.o, 0.0, 1e-9, 20000, &err);
    assert_int_equal(state_of, FL_RELAXED_JAMMED);
    assert_int_equal(s.o.now.contacts, 4);
    assert_near(s.o.now.energy, 4.0 * 0.5 * 0.075 * 0.075, 1e-7);
    assert_near(s.o.wall_force[0], 0.075, 1e-7);
    assert_near(s.o.wall_force[2], 0.0, 0.0);
    /* and jams where the three fill the length: s_J = 0.9 */
    const fl_growth_options opt = fl_growth_defaults();
    fl_growth g = fl_growth_start(&opt);
    g.phase = FL_GROWTH_DENSEST;
    for (int k = 0; k < 60 && g.phase == FL_GROWTH_DENSEST; k++)
        assert_int_equal(fl_growth_stage(&g, &s.o, &opt, &err), 0);
    assert_near(g.jam_scale, 0.9, 1e-5);
    free_sample(&s);
}

/* Force and torque are minus the gradient of the energy, by central differences, of spheres and of
 * capsules. */
static void forces_are_the_gradient_of_the_energy(void **state)
{
    (void)state;
    static const char *const SHAPE[] = {"sphere", "capsule:1.7"};
    for (int c = 0; c < 2; c++) {
        sample s = {0};
        fl_err err = {0};
        make_sample(&s, "box:0,0,0,2,2,2", 3, 12, 0.8, SHAPE[c]);
        fl_rng g = fl_rng_of(1, c, FL_RNG_TEST);
        for (int32_t i = 0; i < s.p.n; i++)
            s.p.x[i] = v3(fl_rng_in(&g, 0.4, 1.6), fl_rng_in(&g, 0.4, 1.6), fl_rng_in(&g, 0.4, 1.6));
        assert_int_equal(fl_overlaps_evaluate(&s.o, &err), 0);
        fl_vec3 force[12];
        for (int32_t i = 0; i < 12; i++) force[i] = s.o.force[i];
        for (int32_t i = 0; i < 12; i++) {
            const double h = 1e-6, x = s.p.x[i].x;
            s.p.x[i].x = x + h;
            assert_int_equal(fl_overlaps_evaluate(&s.o, &err), 0);
            const double up = s.o.now.energy;
            s.p.x[i].x = x - h;
            assert_int_equal(fl_overlaps_evaluate(&s.o, &err), 0);
            assert_near(force[i].x, -(up - s.o.now.energy) / (2.0 * h), 2e-6);
            s.p.x[i].x = x;
        }
        free_sample(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fire_finds_the_bottom),
        cmocka_unit_test(a_row_of_discs_shares_its_overlap),
        cmocka_unit_test(forces_are_the_gradient_of_the_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
