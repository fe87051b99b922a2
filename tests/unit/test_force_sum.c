/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums over the points of a contact in batches of four equal those over single points. */
#include <math.h>
#include "base/array.h"
#include "base/rng.h"
#include "patch/force_sum.h"
#include "patch/patch_points.h"
#include "support/near.h"

static fl_vec3 random_vector(fl_rng *g) { return v3(fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g)); }

static fl_quat random_rotation(fl_rng *g)
{
    return q_unit((fl_quat){fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g)});
}

/* n points; every fifth has the negative weight of a rim. */
static void fill_points(fl_patch_points *s, int32_t n, fl_rng *g)
{
    s->n = n;
    assert_int_equal(fl_reserve(&s->point, &s->point_cap, n, sizeof *s->point), 0);
    for (int32_t k = 0; k < n; k++)
        s->point[k] = (fl_patch_point){.overlap = fl_rng_unit(g),
                                       .u = k % 5 == 4 ? 0.0 : fl_rng_unit(g),
                                       .du = fl_rng_unit(g),
                                       .ddu = fl_rng_unit(g),
                                       .n = random_vector(g),
                                       .unit_normal = v3_unit(random_vector(g)),
                                       .p = random_vector(g)};
}

static void the_stiffness_sum_matches_single_points(void **state)
{
    (void)state;
    fl_rng g = fl_rng_of(test_seed(), 0, 1);
    fl_bodies b;
    fl_patch_points s = {0};
    fl_err err = {0};
    assert_int_equal(fl_bodies_alloc(&b, 2, 3, &err), 0);
    for (int32_t i = 0; i < 2; i++) {
        b.m[i] = 3.0 + i, b.invm[i] = 1.0 / b.m[i], fl_body_set_inertia(&b, i, v3(0.5, 1.5 + i, 2.0)),
        b.q[i] = random_rotation(&g);
        fl_body_update_spin(&b, i);
    }
    for (int32_t n = 1; n < 14; n++) {
        const fl_mat3 R = q_matrix(random_rotation(&g));
        const fl_vec3 a = random_vector(&g);
        fl_force_sum q;
        fill_points(&s, n, &g);
        fl_spring_sums springs;
        assert_int_equal(fl_force_sum_elastic(&s, &q), 0);
        fl_force_sum_springs(&s, &springs);
        for (int32_t i = 0; i < 3; i++) {
            fl_stiffness K = {0}, L = {0};
            double largest = 0.0;
            fl_stiffness_add_springs(&K, &b, i, 2.5, &springs, R, a);
            for (int32_t k = 0; k < n; k++) {
                const fl_patch_point *p = &s.point[k];
                const fl_vec3 f = m3_mul(R, p->unit_normal), r = m3_mul(R, v3_sub(p->p, s.point[0].p));
                if (p->u > 0.0) fl_stiffness_add_force(&L, &b, i, 2.5 * p->ddu, f, v3_cross(v3_add(r, a), f));
            }
            for (int r = 0; r < 6; r++) largest = fmax(largest, L.a[r][r]);
            assert_true(i < 2 ? largest > 0.0 : largest == 0.0); /* fixed directions have none */
            for (int r = 0; r < 6; r++)
                for (int c = 0; c < 8; c++) assert_near_of(K.a[r][c], L.a[r][c], 1e-14, largest);
        }
    }
    fl_patch_points_free(&s);
    fl_bodies_free(&b);
}

static void the_force_sum_matches_single_points(void **state)
{
    (void)state;
    fl_rng g = fl_rng_of(test_seed(), 0, 2);
    fl_patch_points s = {0};
    for (int32_t n = 1; n < 14; n++) {
        const fl_vec3 v = random_vector(&g), turn = random_vector(&g);
        const double chi = 0.3;
        double u = 0.0, compressed = 0.0, normal = 0.0, size = 0.0;
        fl_vec3 f = v3(0, 0, 0), m = f, more = f;
        fl_force_sum q;
        fill_points(&s, n, &g);
        assert_int_equal(fl_force_sum_elastic(&s, &q), 0);
        assert_int_equal(fl_force_sum_motion(&s, v, turn, &q), 0);
        fl_force_sum_damping(&s, chi, 0.0, &q);
        for (int32_t k = 0; k < n; k++) {
            const fl_patch_point *p = &s.point[k];
            const fl_vec3 arm = v3_sub(p->p, s.point[0].p), pull = v3_scale(p->du, p->n);
            const double closing = -v3_dot(p->unit_normal, v3_add(v, v3_cross(turn, arm))),
                         e = p->u > 0.0 ? v3_dot(pull, p->unit_normal) : 0.0,
                         now = fmax(0.0, e * (1.0 + chi * closing));
            assert_near_of(fl_force_sum_approach_speed(&s, k), closing, 1e-14,
                           1.0 + fabs(closing) + v3_norm(arm));
            f = v3_add(f, pull), m = v3_add(m, v3_cross(arm, pull));
            more = v3_madd(more, now - e, p->unit_normal);
            u += p->u, compressed += p->u > 0.0 ? p->du : 0.0, normal += now;
            size += (1.0 + v3_norm(arm)) * v3_norm(pull) * (1.0 + fabs(closing));
        }
        assert_near(q.u, u, 1e-14);
        assert_near(q.du, compressed, 1e-14);
        assert_near_of(q.damped_pressure, normal, 1e-14, size);
        assert_near_of(v3_norm(v3_sub(q.gradient.f, f)), 0.0, 1e-14, size);
        assert_near_of(v3_norm(v3_sub(q.gradient.m, m)), 0.0, 1e-14, size);
        assert_near_of(v3_norm(v3_sub(q.damping.f, more)), 0.0, 1e-14, size);
    }
    fl_patch_points_free(&s);
}

/* The area of a pressure e about `mid` in the plane of x and y, represented by three points that start at an
 * angle. */
static void add_area(fl_patch_points *s, double e, fl_vec3 mid, fl_vec3 x, fl_vec3 y, double angle)
{
    const fl_vec3 n = v3_unit(v3_cross(x, y));
    for (int k = 0; k < 3; k++) {
        const double a = angle + 2.0943951023931953 * k;
        s->point[s->n++] =
            (fl_patch_point){.group_size = 3,
                             .u = e,
                             .du = e / 3.0,
                             .n = n,
                             .unit_normal = n,
                             .p = v3_madd(v3_madd(mid, sqrt(2.0) * cos(a), x), sqrt(2.0) * sin(a), y)};
    }
}

static void the_choice_of_points_in_an_area_does_not_matter(void **state)
{
    (void)state;
    fl_rng g = fl_rng_of(test_seed(), 0, 3);
    fl_patch_points s = {0};
    int32_t parts = 0;
    for (int32_t t = 0; t < 3000; t++) {
        const int32_t areas = 1 + t % 3, others = 1 + t % 7;
        const fl_vec3 v = random_vector(&g), turn = random_vector(&g);
        fl_vec3 at[3][3];
        fl_force_sum q[2];
        double e[3];
        for (int a = 0; a < areas; a++) {
            e[a] = fl_rng_unit(&g);
            for (int c = 0; c < 3; c++) at[a][c] = random_vector(&g);
        }
        fill_points(&s, others, &g);
        assert_int_equal(fl_reserve(&s.point, &s.point_cap, others + 3 * areas, sizeof *s.point), 0);
        for (int way = 0; way < 2; way++) {
            s.n = others;
            for (int a = 0; a < areas; a++)
                add_area(&s, e[a], at[a][0], at[a][1], at[a][2], 6.0 * fl_rng_unit(&g));
            assert_int_equal(fl_force_sum_elastic(&s, &q[way]), 0);
            assert_int_equal(fl_force_sum_motion(&s, v, turn, &q[way]), 0);
            fl_force_sum_damping(&s, 0.3, 0.0, &q[way]);
        }
        double size = 1.0;
        for (int32_t k = 0; k < s.n; k++) {
            const double c = fl_force_sum_approach_speed(&s, k),
                         arm = 1.0 + v3_norm(v3_sub(s.point[k].p, s.point[0].p));
            size += (1.0 + fabs(c)) * arm * arm;
            parts += 1.0 + 0.3 * c < 0.0;
        }
        const fl_force_sum *a = &q[0], *b = &q[1];
        assert_near_of(a->du_approach, b->du_approach, 1e-14, size);
        assert_near_of(a->damped_pressure, b->damped_pressure, 1e-14, size);
        const double *const of = &a->second.xx, *const to = &b->second.xx;
        for (int m = 0; m < 6; m++) assert_near_of(of[m], to[m], 1e-14, size);
        assert_near_of(v3_norm(v3_sub(a->direction, b->direction)), 0.0, 1e-14, size);
        assert_near_of(v3_norm(v3_sub(a->damped_moment, b->damped_moment)), 0.0, 1e-14, size);
        assert_near_of(v3_norm(v3_sub(a->damping.f, b->damping.f)), 0.0, 1e-14, size);
        assert_near_of(v3_norm(v3_sub(a->damping.m, b->damping.m)), 0.0, 1e-14, size);
    }
    assert_true(parts > 1000);
    fl_patch_points_free(&s);
}

/* A disc of radius 1 that sinks and rocks: sum and moment of the compressive pressure, 1 + chi times the
 * closing speed where that is positive, against the integrals over the disc. They agree while no point would
 * be in tension. */
static void a_uniform_pressure_is_limited_as_a_whole(void **state)
{
    (void)state;
    const fl_vec3 x = v3(0.5, 0, 0), y = v3(0, 0.5, 0); /* radii of gyration */
    fl_patch_points s = {0};
    fl_force_sum q;
    assert_int_equal(fl_reserve(&s.point, &s.point_cap, 3, sizeof *s.point), 0);
    for (double rate = 0.0; rate < 20.0; rate += 0.25)
        for (double sink = -2.0; sink < 8.0; sink += 0.25) {
            double all = 0.0, moment = 0.0;
            const int32_t n = 2000;
            for (int32_t k = 0; k < n; k++) {
                const double h = -1.0 + (k + 0.5) * 2.0 / n, f = fmax(0.0, 1.0 + sink + rate * h);
                all += f * sqrt(1.0 - h * h) * 4.0 / (n * 3.14159265358979);
                moment += f * h * sqrt(1.0 - h * h) * 4.0 / (n * 3.14159265358979);
            }
            s.n = 0;
            add_area(&s, 1.0, v3(0, 0, 0), x, y, 0.1 + sink + rate);
            const fl_vec3 v = v3(0, 0, -sink - rate * s.point[0].p.x);
            assert_int_equal(fl_force_sum_elastic(&s, &q), 0);
            assert_int_equal(fl_force_sum_motion(&s, v, v3(0, rate, 0), &q), 0);
            fl_force_sum_damping(&s, 1.0, 0.0, &q);
            const fl_vec3 m = v3_add(q.damped_moment, v3_scale(q.damped_pressure, s.point[0].p));
            const double size = 1.0 + sink + rate > 0.0 ? fabs(1.0 + sink) + rate : 1.0;
            assert_near_of(q.damped_pressure, all, rate < 1.0 + sink ? 1e-4 : 0.05, size);
            assert_near_of(m.x, moment, rate < 1.0 + sink ? 1e-4 : 0.05, size);
            assert_near_of(m.y, 0.0, 1e-14, size);
        }
    fl_patch_points_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_force_sum_matches_single_points),
                                       cmocka_unit_test(the_choice_of_points_in_an_area_does_not_matter),
                                       cmocka_unit_test(a_uniform_pressure_is_limited_as_a_whole),
                                       cmocka_unit_test(the_stiffness_sum_matches_single_points)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
