/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>
#include "geom/clip.h"
#include "geom/mass.h"
#include "zone/zone_law.h"
#include "zone/zone_set.h"

static double volume_of(const fl_zone_mesh *m, double *least)
{
    double sum = 0.0;
    *least = INFINITY;
    for (int32_t k = 0; k < m->zones; k++) {
        const int32_t *t = m->zone[k];
        const fl_vec3 a = v3_sub(m->x[t[1]], m->x[t[0]]), b = v3_sub(m->x[t[2]], m->x[t[0]]),
                      c = v3_sub(m->x[t[3]], m->x[t[0]]);
        const double V = v3_dot(a, v3_cross(b, c)) / 6.0;
        sum += V, *least = fmin(*least, V);
    }
    return sum;
}

/* Sum of the area vectors of the boundary: 0 for a closed surface; area of each face of p. */
static void check_boundary(const fl_zone_mesh *m, const fl_poly *p)
{
    fl_vec3 all = v3(0, 0, 0);
    double area[32] = {0};
    for (int32_t k = 0; k < m->triangles; k++) {
        const int32_t *t = m->triangle[k];
        const fl_vec3 A =
            v3_scale(0.5, v3_cross(v3_sub(m->x[t[1]], m->x[t[0]]), v3_sub(m->x[t[2]], m->x[t[0]])));
        all = v3_add(all, A);
        area[m->face[k]] += v3_dot(A, p->n[m->face[k]]);
    }
    assert_true(v3_norm(all) < 1e-12);
    for (int32_t f = 0; f < p->nf; f++)
        assert_true(fabs(area[f] - v3_norm(fl_poly_face_area_vector(p, f))) < 1e-9);
}

static void check_mesh(const fl_poly *p, double size, double longest)
{
    fl_err err = {0};
    fl_zone_mesh m;
    fl_mass mass;
    double least;
    assert_int_equal(fl_zone_mesh_make(&m, p, size, &err), 0);
    assert_int_equal(fl_mass_of(&mass, p, 0.0, &err), 0);
    assert_true(fabs(volume_of(&m, &least) - mass.volume) < 1e-12 * mass.volume);
    assert_true(least > 0.0);
    check_boundary(&m, p);
    for (int32_t k = 0; k < m.zones; k++)
        for (int a = 0; a < 4; a++)
            for (int b = 0; b < a; b++)
                assert_true(v3_norm(v3_sub(m.x[m.zone[k][a]], m.x[m.zone[k][b]])) < longest * (1.0 + 1e-9));
    fl_zone_mesh_free(&m);
}

static void a_box_becomes_a_grid(void **state)
{
    (void)state;
    fl_err err = {0};
    fl_poly p = {0};
    fl_zone_mesh m;
    assert_int_equal(fl_poly_box(&p, v3(1, 0.5, 0.75), &err), 0);
    check_mesh(&p, 0.5, 0.5 * sqrt(2.0));
    assert_int_equal(fl_zone_mesh_make(&m, &p, 0.5, &err), 0);
    assert_int_equal(m.zones, 4 * 2 * 3 * 5);
    assert_int_equal(m.nodes, 5 * 3 * 4);
    assert_true(fabs(fl_zone_mesh_thickness(&p) - 1.0) < 1e-12);
    fl_zone_mesh_free(&m), fl_poly_free(&p);
}

static void any_convex_block_is_filled(void **state)
{
    (void)state;
    fl_err err = {0};
    fl_poly p = {0};
    assert_int_equal(fl_poly_box(&p, v3(1, 1, 1), &err), 0);
    assert_int_equal(fl_poly_cut(&p, v3_unit(v3(1, 2, 3)), 0.9, &err), 0);
    assert_int_equal(fl_poly_cut(&p, v3_unit(v3(-2, 1, 1)), 0.8, &err), 0);
    check_mesh(&p, 0.4, 0.4 * sqrt(2.0));
    fl_poly_free(&p);
}

/* The forces of elastic zones are the gradient of their energy, at large turns and moderate strains. */
static void forces_are_the_gradient_of_the_energy(void **state)
{
    (void)state;
    fl_err err = {0};
    fl_poly p = {0};
    fl_zone_mesh m;
    fl_zone_set s = {0};
    const fl_zone_material a = fl_zone_material_of(1000.0, 1e3, 0.3);
    const double h = 1e-6;
    assert_int_equal(fl_poly_box(&p, v3(1, 1, 1), &err), 0);
    assert_int_equal(fl_poly_cut(&p, v3_unit(v3(1, 1, 2)), 1.0, &err), 0);
    assert_int_equal(fl_zone_mesh_make(&m, &p, 1.0, &err), 0);
    assert_int_equal(fl_zone_set_add_material(&s, &a, &err), 0);
    assert_int_equal(fl_zone_set_add(&s, &m, 0, 0, &err), 0);
    assert_int_equal(fl_zone_set_finish(&s, 0.35, &err), 0);
    const fl_quat q = q_of_vector(v3(0.7, -0.9, 0.4));
    for (int32_t n = 0; n < s.nodes; n++) {
        const fl_vec3 x = s.rest[n];
        s.x[n] = q_rotate(q, v3_add(x, v3(0.05 * x.y * x.z, 0.04 * x.x * x.x, -0.06 * x.y)));
    }
    fl_zone_deform(&s, 0, s.zone_chunks), fl_zone_average(&s, 0, s.node_chunks);
    fl_zone_corner_forces(&s, 0, s.zone_chunks);
    fl_vec3 sum = v3(0, 0, 0);
    double most = 0.0;
    for (int32_t n = 0; n < s.nodes; n++) {
        const fl_vec3 f = fl_zone_node_force(&s, n);
        sum = v3_add(sum, f), most = fmax(most, v3_norm(f));
    }
    for (int32_t n = 0; n < s.nodes; n += 3) {
        const fl_vec3 f = fl_zone_node_force(&s, n);
        const double y = s.x[n].y;
        s.x[n].y = y + h;
        const double up = fl_zone_set_energies(&s).stored;
        s.x[n].y = y - h;
        const double down = fl_zone_set_energies(&s).stored;
        s.x[n].y = y;
        assert_true(fabs(f.y + (up - down) / (2.0 * h)) < 1e-5 * most);
    }
    assert_true(v3_norm(sum) < 1e-12 * most);
    fl_zone_set_free(&s), fl_zone_mesh_free(&m), fl_poly_free(&p);
}

/* Random trial stresses return onto the surface, and stay where they are when they return again. */
static void stress_returns_to_the_surface(void **state)
{
    (void)state;
    uint32_t seed = 3;
    fl_zone_material m = fl_zone_material_of(1000.0, 1e9, 0.2);
    fl_zone_material_set_strength(&m, 1e5, 35.0, 4e4, 12.0);
    for (int k = 0; k < 2000; k++) {
        double e[6], lost = 0.0, again = 0.0;
        for (int c = 0; c < 6; c++)
            seed = seed * 1664525u + 1013904223u, e[c] = 2e-3 * ((double)seed / 4294967296.0 - 0.5);
        const fl_sym3 strain = {e[0], e[1], e[2], e[3], e[4], e[5]};
        fl_sym3 plastic = {0};
        fl_mat3 axes;
        const fl_vec3 s = fl_zone_principal(fl_zone_stress(&m, strain, &plastic, &lost), &axes);
        const double over = s.x * (1.0 + m.sin_phi) - s.z * (1.0 - m.sin_phi) - 2.0 * m.cohesion * m.cos_phi;
        assert_true(over < 1.0 && s.x < m.tension + 1.0);
        assert_true(lost > -1e-9);
        const fl_sym3 was = plastic;
        fl_zone_stress(&m, strain, &plastic, &again);
        assert_true(fabs(plastic.xx - was.xx) + fabs(plastic.xy - was.xy) < 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_box_becomes_a_grid),
                                       cmocka_unit_test(any_convex_block_is_filled),
                                       cmocka_unit_test(forces_are_the_gradient_of_the_energy),
                                       cmocka_unit_test(stress_returns_to_the_surface)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
