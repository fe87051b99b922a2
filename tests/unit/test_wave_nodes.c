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

/* Mean over all directions of |int e^(ikx) dA|^2 / A^2 over the section of a prism, by its edges:
 * k^2 int e^(ikx) dA = -i sum (k.n) L e^(ikm) sin(k.t L/2)/(k.t L/2), m the middle of an edge. */
static double mean_transfer2(const fl_poly *p, const fl_hull *h, double k)
{
    enum { DIRECTIONS = 720 };
    const fl_vec3 e = h->prism.e;
    double sum = 0;
    int32_t cap = 0;
    for (int32_t f = 1; f < p->nf; f++)
        if (v3_dot(p->n[f], e) > v3_dot(p->n[cap], e)) cap = f;
    for (int d = 0; d < DIRECTIONS; d++) {
        const double angle = 2 * PI * (d + 0.5) / DIRECTIONS;
        const fl_vec3 way = v3_scale(k, v3(cos(angle), sin(angle), 0));
        double re = 0, im = 0;
        for (int32_t c = p->first[cap]; c < p->first[cap + 1]; c++) {
            const int32_t next = c + 1 < p->first[cap + 1] ? c + 1 : p->first[cap];
            const fl_vec3 a = p->v[p->loop[c]], b = p->v[p->loop[next]], side = v3_sub(b, a);
            const double across = v3_dot(way, v3_cross(side, e)), x = 0.5 * v3_dot(way, side),
                         at = v3_dot(way, v3_lerp(a, b, 0.5)),
                         part = across * (fabs(x) > 1e-6 ? sin(x) / x : 1);
            re += part * cos(at), im += part * sin(at);
        }
        sum += (re * re + im * im) / (k * k * k * k);
    }
    return sum / DIRECTIONS / (h->prism.area * h->prism.area);
}

/* What a band leaves out is below 0.4 of the error asked for; one band less would leave out more. */
static void the_band_holds_the_waves_that_move_a_floe(void **state)
{
    fl_waves w;
    fl_err err = {0};
    int bands[FL_WAVE_BANDS] = {0}, kinds = 0;
    (void)state;
    assert_int_equal(fl_waves_jonswap(&w, 1, 4, 3.3, 1000, 3, 0, INFINITY, G, &err), 0);
    for (int size = 0; size < 5; size++) {
        fl_poly p;
        fl_hull h;
        fl_wave_nodes a = {0};
        double all = 0, left[2] = {0};
        make_prism(&p, &h, 7, 1.5 * pow(2, size), 0.8, 5);
        assert_int_equal(fl_wave_nodes_make(&a, &h, &w, 0.003, &err), 0);
        const int32_t n = fl_waves_of_band(&w, a.band).n, fewer = fl_waves_of_band(&w, a.band + 1).n;
        for (int32_t j = 0; j < w.n; j++) {
            const double a2 = w.train[j].a * w.train[j].a;
            all += a2;
            if (j >= fewer) left[1] += a2 * mean_transfer2(&p, &h, w.train[j].k);
            if (j >= n) left[0] += a2 * mean_transfer2(&p, &h, w.train[j].k);
        }
        /* the band is chosen by the transfer of short waves */
        assert_true(sqrt(left[0] / all) < 1.15 * 0.4 * 0.003);
        assert_true(a.band + 1 == FL_WAVE_BANDS || sqrt(left[1] / all) > 0.95 * 0.4 * 0.003);
        kinds += bands[a.band]++ == 0;
        fl_wave_nodes_free(&a);
        fl_hull_free(&h);
        fl_poly_free(&p);
    }
    assert_true(kinds >= 3);
    fl_waves_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_have_the_moments_of_the_section),
        cmocka_unit_test(faces_close_the_surface),
        cmocka_unit_test(the_band_holds_the_waves_that_move_a_floe),
        cmocka_unit_test(the_degree_follows_size_and_error),
    };
    return cmocka_run_group_tests_name("wave_nodes", tests, NULL, NULL);
}
