/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/near.h"
#include <math.h>
#include "base/pi.h"
#include "base/rng.h"
#include "support/shapes.h"
#include "water/wave_nodes.h"

#define G 9.81

static void make_prism(fl_poly *p, fl_hull *h, int sides, double R, double thickness, uint64_t seed)
{
    fl_vec3 v[2 * 12];
    int32_t first[12 + 3] = {0}, loop[6 * 12], n = 0;
    fl_err err = {0};
    fl_rng g = fl_rng_of(seed, sides, FL_RNG_TEST);
    for (int s = 0; s < sides; s++) {
        const double a = 2 * PI * (s + 0.6 * fl_rng_unit(&g)) / sides;
        v[s] = v3(R * cos(a), R * sin(a), -0.5 * thickness);
        v[sides + s] = v3(R * cos(a), R * sin(a), 0.5 * thickness);
    }
    for (int s = sides - 1; s >= 0; s--) loop[n++] = s;
    first[1] = n;
    for (int s = 0; s < sides; s++) loop[n++] = sides + s;
    first[2] = n;
    for (int s = 0; s < sides; s++) {
        const int t = (s + 1) % sides;
        loop[n++] = s, loop[n++] = t, loop[n++] = sides + t, loop[n++] = sides + s;
        first[3 + s] = n;
    }
    assert_int_equal(fl_poly_make(p, 2 * sides, v, sides + 2, first, loop, &err), 0);
    assert_int_equal(fl_hull_make(h, p, 0, &err), 0);
}

/* Weights are positive; area, first and second moments are those of the section. */
static void columns_have_the_moments_of_the_section(void **state)
{
    fl_waves w;
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_waves_jonswap(&w, 1, 6, 3.3, 100, 3, 0, INFINITY, G, &err), 0);
    for (int sides = 3; sides <= 9; sides++)
        for (int size = 0; size < 3; size++) {
            fl_poly p;
            fl_hull h;
            fl_wave_nodes a = {0};
            const double R = size == 0 ? 2.0 : size == 1 ? 9.0 : 40.0;
            make_prism(&p, &h, sides, R, 0.8, 5);
            assert_int_equal(fl_wave_nodes_make(&a, &h, &w, 0.003, &err), 0);
            assert_int_equal(a.kind, FL_WAVE_COLUMNS);
            const fl_vec3 b = v3_cross(h.prism.e, h.prism.a);
            double sum[6] = {0};
            for (int32_t k = 0; k < a.n; k++) {
                const fl_vec3 r = v3_sub(a.x[k], h.prism.o);
                const double x = v3_dot(h.prism.a, r), y = v3_dot(b, r);
                assert_true(a.w[k] > 0.0);
                sum[0] += a.w[k], sum[1] += a.w[k] * x, sum[2] += a.w[k] * y;
                sum[3] += a.w[k] * x * x, sum[4] += a.w[k] * x * y, sum[5] += a.w[k] * y * y;
            }
            const double A = h.prism.area;
            assert_near(sum[0], A, 1e-9);
            assert_true(fabs(sum[1]) < 1e-9 * A * R && fabs(sum[2]) < 1e-9 * A * R);
            assert_true(fabs(sum[3] - h.prism.jaa) < 1e-9 * A * R * R);
            assert_true(fabs(sum[4] - h.prism.jab) < 1e-9 * A * R * R);
            assert_true(fabs(sum[5] - h.prism.jbb) < 1e-9 * A * R * R);
            if (size == 0) assert_true(a.n <= 15); /* few for a small floe */
            fl_wave_nodes_free(&a);
            fl_hull_free(&h);
            fl_poly_free(&p);
        }
    fl_waves_free(&w);
}

/* The area vectors of a closed surface add up to 0, their moments to the volume. */
static void faces_close_the_surface(void **state)
{
    fl_waves w;
    fl_err err = {0};
    fl_poly p;
    fl_hull h;
    fl_wave_nodes a = {0};
    fl_rng g = fl_rng_of(4, 4, FL_RNG_TEST);
    (void)state;
    assert_int_equal(fl_waves_jonswap(&w, 1, 6, 3.3, 100, 3, 0, INFINITY, G, &err), 0);
    shape_random_polytope(&p, &g, 30);
    assert_int_equal(fl_hull_make(&h, &p, 0, &err), 0);
    assert_int_equal(fl_wave_nodes_make(&a, &h, &w, 0.003, &err), 0);
    assert_int_equal(a.kind, FL_WAVE_FACES);
    fl_vec3 sum = v3(0, 0, 0);
    double volume = 0;
    for (int32_t k = 0; k < a.n; k++) sum = v3_add(sum, a.area[k]), volume += v3_dot(a.x[k], a.area[k]) / 3;
    assert_true(v3_norm(sum) < 1e-10 * h.surface_area);
    assert_near(volume, h.volume, 0.01); /* merged parts bend a little */
    fl_wave_nodes_free(&a);
    fl_hull_free(&h);
    fl_poly_free(&p);
    fl_waves_free(&w);
}

/* More degrees for larger floes, shorter waves and a smaller error. */
static void the_degree_follows_size_and_error(void **state)
{
    fl_waves w;
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_waves_airy(&w, 1, 4, 0, INFINITY, G, &err), 0); /* 25 m */
    assert_int_equal(fl_wave_nodes_degree(&w, 0.5, 0.003, 1), 2);
    assert_true(fl_wave_nodes_degree(&w, 10, 0.003, 1) > fl_wave_nodes_degree(&w, 5, 0.003, 1));
    assert_true(fl_wave_nodes_degree(&w, 5, 0.0003, 1) > fl_wave_nodes_degree(&w, 5, 0.003, 1));
    assert_int_equal(fl_wave_nodes_degree(&w, 100, 0.003, 1), 13); /* in parts */
    fl_waves_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_have_the_moments_of_the_section),
        cmocka_unit_test(faces_close_the_surface),
        cmocka_unit_test(the_degree_follows_size_and_error),
    };
    return cmocka_run_group_tests_name("wave_nodes", tests, NULL, NULL);
}
