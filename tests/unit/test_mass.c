/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/pi.h"
#include "geom/dilate.h"
#include "geom/mass.h"
#include "support/near.h"
#include "support/shapes.h"

static void box_is_exact(void **state)
{
    (void)state;
    fl_err err = {0};
    fl_poly p;
    fl_mass m;
    assert_int_equal(fl_poly_box(&p, v3(1, 3, 2), &err), 0);
    assert_int_equal(fl_mass_of(&m, &p, 0.0, &err), 0);
    assert_near(m.volume, 48.0, 1e-15);
    assert_near_of(v3_norm(m.centre), 0.0, 1e-15, 1.0);
    /* V/12 (b^2 + c^2), ascending: about y, z, x */
    assert_near(m.inertia.x, 48.0 / 12 * (4 + 16), 1e-14);
    assert_near(m.inertia.y, 48.0 / 12 * (4 + 36), 1e-14);
    assert_near(m.inertia.z, 48.0 / 12 * (16 + 36), 1e-14);
    assert_near(m.axes.m[1][0], 1.0, 0.0);
    assert_near(m.axes.m[2][1], 1.0, 0.0);
    assert_near(m.axes.m[0][2], 1.0, 0.0);
    fl_poly_free(&p);
}

static void square_floe_keeps_its_axes(void **state)
{
    (void)state;
    fl_err err = {0};
    fl_poly p;
    fl_mass m;
    assert_int_equal(fl_poly_box(&p, v3(5, 5, 0.3), &err), 0);
    assert_int_equal(fl_mass_of(&m, &p, 0.05, &err), 0);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) assert_near(m.axes.m[i][j], i == j, 0.0);
    assert_true(m.inertia.x <= m.inertia.y && m.inertia.y <= m.inertia.z);
    fl_poly_free(&p);
}

static void sphere_and_capsule(void **state)
{
    (void)state;
    const fl_vec3 v[2] = {{1e6, -2, 3}, {1e6, 1, 7}};
    const double r = 2.0, l = 5.0;
    fl_err err = {0};
    fl_poly p;
    fl_mass m;
    assert_int_equal(fl_poly_make(&p, 1, v, 0, NULL, NULL, &err), 0);
    assert_int_equal(fl_mass_of(&m, &p, r, &err), 0);
    assert_near(m.volume, 4.0 / 3 * PI * r * r * r, 1e-15);
    assert_near(m.inertia.x, 8.0 / 15 * PI * pow(r, 5), 1e-15);
    assert_near(m.inertia.z, 8.0 / 15 * PI * pow(r, 5), 1e-15);
    assert_near(v3_norm(v3_sub(m.centre, v[0])), 0.0, 0.0);
    fl_poly_free(&p);
    assert_int_equal(fl_poly_make(&p, 2, v, 0, NULL, NULL, &err), 0);
    assert_int_equal(fl_mass_of(&m, &p, r, &err), 0);
    const double cyl = PI * r * r * l, sphere_volume = 4.0 / 3 * PI * r * r * r;
    assert_near(m.volume, cyl + sphere_volume, 1e-14);
    assert_near(m.inertia.x, cyl * r * r / 2 + sphere_volume * 0.4 * r * r, 1e-14);
    assert_near(m.inertia.y,
                cyl * (l * l / 12 + r * r / 4) + sphere_volume * (0.4 * r * r + l * l / 4 + 0.375 * l * r),
                1e-14);
    assert_near(m.inertia.z, m.inertia.y, 1e-14);
    assert_near(fabs(v3_dot(m3_col(m.axes, 0), v3(0, 0.6, 0.8))), 1.0, 1e-15);
    fl_poly_free(&p);
}

/* A regular polygon of many sides is nearly a disc: P + B(r) is then a disc with a rounded rim, the volume
 * and moments of which are integrals over the half circle. */
static void flat_core_is_a_pancake(void **state)
{
    (void)state;
    enum { N = 4000 };
    static fl_vec3 v[N];
    static int32_t loop[2 * N];
    const int32_t first[3] = {0, N, 2 * N};
    const double a = 3.0, r = 0.25;
    fl_err err = {0};
    fl_poly p;
    fl_mass m;
    for (int k = 0; k < N; k++) {
        v[k] = v3(a * cos(2 * PI * k / N), a * sin(2 * PI * k / N), 0.0);
        loop[k] = k;
        loop[N + k] = N - 1 - k;
    }
    assert_int_equal(fl_poly_make(&p, N, v, 2, first, loop, &err), 0);
    assert_int_equal(fl_mass_of(&m, &p, r, &err), 0);
    double vol = 0, axial = 0, across = 0;
    for (int k = 0; k < 20000; k++) { /* midpoint rule in the angle: smooth, so good to 1e-9 */
        const double t = PI * ((k + 0.5) / 20000 - 0.5), z = r * sin(t), w = a + r * cos(t),
                     dz = r * cos(t) * PI / 20000;
        vol += PI * w * w * dz;
        axial += 0.5 * PI * w * w * w * w * dz;
        across += (0.25 * PI * w * w * w * w + PI * w * w * z * z) * dz;
    }
    const double rim =
        4.0 * PI * PI / (3.0 * N * N); /* the polygon is smaller than the circle by this area */
    assert_near(m.volume, vol, rim);
    assert_near(m.inertia.z, axial, 2 * rim);
    assert_near(m.inertia.x, across, 2 * rim);
    assert_near(fl_dilate_volume(&p, r), m.volume, 1e-12);
    fl_poly_free(&p);
    fl_err no = {0};
    assert_int_equal(fl_poly_make(&p, N, v, 2, first, loop, &no), 0);
    assert_int_equal(fl_mass_of(&m, &p, 0.0, &no), -1);
    assert_int_equal(no.code, FL_INPUT);
    assert_string_equal(no.text, "a body without volume has no mass");
    fl_poly_free(&p);
}

/* The moments of P + B(r), counted on a grid fine enough for three digits: an independent check of the corner
 * formulae. */
static void round_moments_match_a_count(void **state)
{
    (void)state;
    for (int faces = 4; faces <= 20; faces += faces == 4 ? 4 : 12) {
        fl_rng g = fl_rng_of(test_seed(), faces, FL_RNG_TEST);
        const double r = 0.4, step = 0.03;
        fl_err err = {0};
        fl_poly p;
        fl_mass m;
        shape_regular(&p, faces, 1.0);
        /* unequal, so that no moment is right by symmetry */
        fl_poly q;
        fl_vec3 v[12];
        for (int32_t k = 0; k < p.nv; k++)
            v[k] = v3(1.3 * p.v[k].x + 0.2 * p.v[k].y, p.v[k].y, 0.6 * p.v[k].z);
        assert_int_equal(fl_poly_make(&q, p.nv, v, p.nf, p.first, p.loop, &err), 0);
        assert_int_equal(fl_mass_of(&m, &q, r, &err), 0);
        double n = 0, xx[6] = {0};
        fl_vec3 s = {0};
        for (double x = -2.1; x < 2.1; x += step)
            for (double y = -1.8; y < 1.8; y += step)
                for (double z = -1.2; z < 1.2; z += step) {
                    const fl_vec3 c = v3(x + step * fl_rng_unit(&g), y + step * fl_rng_unit(&g),
                                         z + step * fl_rng_unit(&g));
                    /* distance to q: by its triangles, unless inside */
                    double best = INFINITY;
                    int inside = 1;
                    for (int32_t f = 0; f < q.nf && best > 0.0; f++) {
                        const double d = v3_dot(q.n[f], c) - q.c[f];
                        if (d <= 0.0) continue;
                        inside = 0;
                        if (d >= r) {
                            best = INFINITY;
                            break;
                        }
                        const fl_vec3 *t[3] = {&q.v[q.loop[3 * f]], &q.v[q.loop[3 * f + 1]],
                                               &q.v[q.loop[3 * f + 2]]};
                        int over = 1;
                        for (int k = 0; k < 3; k++) {
                            const fl_vec3 a = *t[k], ab = v3_sub(*t[(k + 1) % 3], a), ac = v3_sub(c, a);
                            if (v3_dot(v3_cross(ab, ac), q.n[f]) < 0.0) over = 0;
                            const double u = fmin(1.0, fmax(0.0, v3_dot(ab, ac) / v3_norm2(ab)));
                            best = fmin(best, v3_norm(v3_madd(ac, -u, ab)));
                        }
                        if (over) best = fmin(best, d);
                    }
                    if (!inside && best > r) continue;
                    n += 1;
                    s = v3_add(s, c);
                    const fl_vec3 e = v3_sub(c, m.centre);
                    xx[0] += e.x * e.x;
                    xx[1] += e.y * e.y;
                    xx[2] += e.z * e.z;
                    xx[3] += e.x * e.y;
                    xx[4] += e.x * e.z;
                    xx[5] += e.y * e.z;
                }
        const double cell = step * step * step, tol = 4e-3;
        assert_near(n * cell, m.volume, tol);
        assert_near_of(v3_norm(v3_sub(v3_scale(1 / n, s), m.centre)), 0.0, tol, 1.0);
        const double expected[6] = {m.second.m[0][0], m.second.m[1][1], m.second.m[2][2],
                                    m.second.m[0][1], m.second.m[0][2], m.second.m[1][2]};
        for (int k = 0; k < 6; k++) assert_near_of(xx[k] * cell, expected[k], tol, m.second.m[0][0]);
        fl_poly_free(&p);
        fl_poly_free(&q);
    }
}

/* A cube of side s: V(r) = s^3 + 6 s^2 r + 3 pi s r^2 + (4/3) pi r^3, at any scale. */
static void cube_volume_follows_steiner(void **state)
{
    (void)state;
    for (int k = 0; k < 1000; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_err err = {0};
        const double s = pow(10.0, fl_rng_in(&g, -3.0, 4.0)), r = s * fl_rng_in(&g, 0.0, 2.0);
        fl_poly p;
        fl_mass m;
        assert_int_equal(fl_poly_box(&p, v3(s / 2, s / 2, s / 2), &err), 0);
        const double expected = s * s * s + 6 * s * s * r + 3 * PI * s * r * r + 4 * PI * r * r * r / 3;
        assert_near(fl_dilate_volume(&p, r), expected, 1e-14);
        assert_near(fl_dilate_area(&p, r), 6 * s * s + 6 * PI * s * r + 4 * PI * r * r, 1e-14);
        assert_int_equal(fl_mass_of(&m, &p, r, &err), 0);
        assert_near(m.volume, expected, 1e-14);
        fl_poly_free(&p);
    }
}

static void principal_axes_rebuild_the_tensor(void **state)
{
    (void)state;
    for (int k = 0; k < 2000; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const fl_mat3 r = q_matrix(shape_rotation(&g));
        const double d[3] = {1.0, pow(10.0, fl_rng_in(&g, -6.0, 0.0)),
                             k % 3 ? pow(10.0, fl_rng_in(&g, -6.0, 0.0)) : 1.0};
        fl_mat3 a = {{{0}}}, e;
        double v[3];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                for (int l = 0; l < 3; l++) a.m[i][j] += d[l] * (r.m[i][l] * r.m[j][l]);
        fl_mass_principal(&a, v, &e);
        assert_true(v[0] >= v[1] && v[1] >= v[2]);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                double sum = 0.0, one = 0.0;
                for (int l = 0; l < 3; l++) {
                    sum += v[l] * e.m[i][l] * e.m[j][l];
                    one += e.m[l][i] * e.m[l][j];
                }
                assert_near_of(sum, a.m[i][j], 1e-14, 1.0);
                assert_near_of(one, i == j, 1e-15, 4.0);
            }
        assert_near(v3_dot(v3_cross(m3_col(e, 0), m3_col(e, 1)), m3_col(e, 2)), 1.0, 1e-14);
    }
}

static void far_from_the_origin(void **state)
{
    (void)state;
    for (int k = 0; k < 200; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_err err = {0};
        fl_poly p, q;
        fl_mass m, n;
        shape_random_polytope(&p, &g, 6);
        const double r = fl_rng_in(&g, 0.0, 0.3);
        /* a shift by a power of two moves the vertices almost without rounding */
        shape_copy_moved(&q, &p, 1.0, q_one(), v3(1048576, -1048576, 524288));
        assert_int_equal(fl_mass_of(&m, &p, r, &err), 0);
        assert_int_equal(fl_mass_of(&n, &q, r, &err), 0);
        assert_near(n.volume, m.volume, 1e-9);
        assert_near(n.inertia.x, m.inertia.x, 1e-8);
        assert_near(n.inertia.z, m.inertia.z, 1e-8);
        assert_near(fl_dilate_volume(&q, r), fl_dilate_volume(&p, r), 1e-9);
        fl_poly_free(&p);
        fl_poly_free(&q);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(box_is_exact),
        cmocka_unit_test(square_floe_keeps_its_axes),
        cmocka_unit_test(sphere_and_capsule),
        cmocka_unit_test(flat_core_is_a_pancake),
        cmocka_unit_test(round_moments_match_a_count),
        cmocka_unit_test(cube_volume_follows_steiner),
        cmocka_unit_test(principal_axes_rebuild_the_tensor),
        cmocka_unit_test(far_from_the_origin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
