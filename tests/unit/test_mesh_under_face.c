/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh under a face is summed separately, with the same result. */
#include <math.h>
#include "base/pi.h"
#include "base/rng.h"
#include "patch/patch_law.h"
#include "patch/plane_distances.h"
#include "structure/mesh_contact.h"
#include "support/near.h"

#define RADIUS 0.05

/* A sheet of n by n cells on 2 m with curvatures 1/8 1/m and 1/5 1/m, convex or hollow, with roughness
 * `rough`; its seams are inclined by `incline`. */
static void make_sheet(fl_surface *s, int n, double hollow, double rough, double incline)
{
    fl_err err = {0};
    assert_true(fl_surface_add(s, "sheet", 5, &err) == 0);
    fl_part *p = &s->part[0];
    for (int j = 0; j <= n; j++) {
        for (int i = 0; i <= n; i++) {
            fl_rng g = fl_rng_of(test_seed(), j * (n + 1) + i, FL_RNG_TEST);
            const double x = 2.0 * i / n - 1.0 + incline * j / n, y = 2.0 * j / n - 1.0;
            const double z = -hollow * (x * x / 16.0 + y * y / 10.0) + fl_rng_in(&g, -rough, rough);
            assert_int_equal(fl_surface_vertex(p, v3(x, y, z), &err), 0);
        }
    }
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            const int32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            assert_int_equal(fl_surface_triangle(p, a, b, c, &err) || fl_surface_triangle(p, a, c, d, &err),
                             0);
        }
    }
}

typedef struct {
    double u, du, ddu;
    fl_vec3 f, m;
} sums;

static sums sums_of(const fl_patch_points *w)
{
    sums q = {.m = w->couple};
    for (int32_t k = 0; k < w->n; k++) {
        const fl_patch_point *p = &w->point[k];
        q.u += p->u;
        q.du += p->u > 0.0 ? p->du : 0.0;
        q.ddu += p->ddu;
        q.f = v3_madd(q.f, p->du, p->n);
        q.m = v3_madd(q.m, p->du, v3_cross(p->p, p->n));
    }
    return q;
}

static void sums_under_a_face_are_the_same(void **state)
{
    (void)state;
    static const struct {
        int n;
        double hollow, rough, incline;
    } CASE[5] = {{40, 1.0, 0.0, 0.07},
                 {60, 1.0, 1e-3, 0.07},
                 {40, -0.3, 0.0, 0.07},
                 {25, 0.0, 2e-3, 0.07},
                 {40, 1.0, 0.0, 0.0}}; /* the sides of a face are seams, and the corners are corners */
    fl_patch_points w = {0};
    fl_mesh_contact_work near = {0};
    fl_err err = {0};
    int saved = 0;
    for (int c = 0; c < 5; c++) {
        fl_surface surface = {0};
        fl_structure st = {0};
        const int on_seams = CASE[c].incline == 0.0;
        make_sheet(&surface, CASE[c].n, CASE[c].hollow, CASE[c].rough, CASE[c].incline);
        assert_int_equal(fl_structure_build(&st, &surface, &err), 0);
        const fl_piece *piece = &st.piece[0];
        assert_int_equal(piece->kind, FL_PIECE_MESH);
        for (int k = 0; k < 40; k++) {
            fl_rng g = fl_rng_of(test_seed(), 1000 * c + k, FL_RNG_TEST);
            fl_poly box = {0};
            fl_feature_pairs l = {0};
            double distance;
            /* on a side, and on an edge of it; some so thin that faces lie over all its sides */
            const double wide = on_seams ? 0.05 * (4 + k % 9) : fl_rng_in(&g, 0.2, 0.6), deep = on_seams ? 0.4
                                                                                                : k % 5 == 4
                                                                                                    ? 0.012
                                                                                                    : 0.4;
            assert_int_equal(fl_poly_box(&box, v3(wide, deep, 0.3), &err), 0);
            const double tilt = k % 4 == 3 ? 0.25 : 0.03;
            const fl_quat q = on_seams ? q_of_vector(v3(0, 0, 0))
                                       : q_of_vector(v3(fl_rng_in(&g, -tilt, tilt),
                                                        fl_rng_in(&g, -tilt, tilt), fl_rng_in(&g, -3, 3)));
            const double low = k % 4 == 3 && !on_seams ? wide * fabs(2.0 * (q.w * q.y - q.x * q.z)) +
                                                             deep * fabs(2.0 * (q.w * q.x + q.y * q.z))
                                                       : 0.0;
            const fl_vec3 at = on_seams ? v3(0.05 * (k % 3), 0.05 * (k % 2), 0.3 + fl_rng_in(&g, 0, 0.04))
                                        : v3(fl_rng_in(&g, -0.3, 0.3), fl_rng_in(&g, -0.3, 0.3),
                                             0.3 + low + fl_rng_in(&g, 0, 0.04));
            assert_int_equal(fl_patch_points_transform(&w, &box, q_matrix(q), v3_sub(at, piece->x)), 0);
            w.keep_features = k % 2;
            assert_int_equal(
                fl_mesh_contact_points(&w, &near, &box, piece, RADIUS, 2.0 * RADIUS, &l, &distance), 0);
            const sums fast = sums_of(&w);
            const int32_t points = w.n;
            double shares = 0.0;
            for (int32_t i = 0; i < w.features; i++) {
                shares += w.feature[i].force;
                assert_in_range(w.feature[i].first_point, 0, w.n - 3);
                assert_int_equal(w.point[w.feature[i].first_point].group_size, 3);
            }
            if (w.keep_features && w.features) {
                double all = 0.0;
                for (int32_t i = 0; i < w.n; i++)
                    for (int32_t s = 0; s < w.features; s++)
                        if (w.feature[s].first_point == i && (s == 0 || w.feature[s - 1].first_point != i))
                            all += 3.0 * w.point[i].du * v3_norm(w.point[i].n);
                assert_near(shares, all, 1e-12);
            }
            /* none behind the surface, or both would have its points */
            if (l.candidates == 0) {
                const fl_patch_core A = {&box, w.va, w.na, RADIUS, 1.0},
                                    B = {&piece->core, piece->core.v, piece->core.n, 0.0, -1.0};
                w.n = 0;
                w.couple = v3(0, 0, 0);
                assert_int_equal(
                    fl_feature_pairs_evaluate(&w, &l, &A, &B, RADIUS, 0.0, FL_PATCH_RIM_WIDTH * RADIUS, 0.0),
                    0);
                const sums slow = sums_of(&w);
                /* on rough sheets some pairs of triangles are flat only within 1e-6 of the size, so that a
                 * face is not quite the plane assumed */
                const double same = CASE[c].rough > 0.0 ? 1e-3 : 1e-12;
                /* s is known to the rounding of coordinates of metres */
                const double off = same * v3_norm(slow.f) + 1e-15 * slow.ddu;
                assert_near_of(fast.u, slow.u, 1.0, same * slow.u + 1e-15 * slow.du);
                assert_near_of(v3_norm(v3_sub(fast.f, slow.f)), 0.0, 1.0, off);
                assert_near_of(v3_norm(v3_sub(fast.m, slow.m)), 0.0, 1.0, off);
                saved += w.n - points;
            }
            fl_mesh_under_face_free_pairs(&l);
            fl_poly_free(&box);
        }
        fl_structure_free(&st);
        fl_surface_free(&surface);
    }
    assert_true(saved > 40000);
    fl_patch_points_free(&w);
    fl_mesh_contact_work_free(&near);
}

/* Evaluated with a list made for another pose, and with one made for this pose: every bit is the same. */
static void old_lists_change_no_bit(void **state)
{
    (void)state;
    fl_patch_points w = {0};
    fl_mesh_contact_work near = {0};
    fl_surface surface = {0};
    fl_structure st = {0};
    fl_poly box = {0};
    fl_err err = {0};
    int moved = 0;
    make_sheet(&surface, 40, 1.0, 0.0, 0.07);
    assert_int_equal(fl_structure_build(&st, &surface, &err), 0);
    assert_int_equal(fl_poly_box(&box, v3(0.5, 0.3, 0.3), &err), 0);
    const fl_piece *piece = &st.piece[0];
    for (int k = 0; k < test_times(60); k++) {
        fl_rng g = fl_rng_of(test_seed(), 7000 + k, FL_RNG_TEST);
        fl_feature_pairs old = {0}, new = {0};
        const fl_quat q =
            q_of_vector(v3(fl_rng_in(&g, -0.03, 0.03), fl_rng_in(&g, -0.03, 0.03), fl_rng_in(&g, -3, 3)));
        const fl_vec3 at = v3_sub(
            v3(fl_rng_in(&g, -0.3, 0.3), fl_rng_in(&g, -0.3, 0.3), 0.3 + fl_rng_in(&g, 0, 0.04)), piece->x);
        sums seen[2];
        int32_t points[2];
        double distance;
        for (int way = 0; way < 3;
             way++) { /* the other body elsewhere, with the same list, and here again with another */
            fl_feature_pairs *l = way < 2 ? &old : &new;
            const fl_vec3 x = way ? at : v3_add(at, v3(4e-4, -3e-4, 2e-4));
            assert_int_equal(fl_patch_points_transform(&w, &box, q_matrix(q), x), 0);
            assert_int_equal(
                fl_mesh_contact_points(&w, &near, &box, piece, RADIUS, 2.0 * RADIUS, l, &distance), 0);
            if (way) seen[way - 1] = sums_of(&w), points[way - 1] = w.n;
        }
        moved += old.n != new.n;
        assert_int_equal(points[0], points[1]);
        assert_memory_equal(&seen[0], &seen[1], sizeof seen[0]);
        fl_mesh_under_face_free_pairs(&old);
        fl_mesh_under_face_free_pairs(&new);
    }
    assert_true(moved > 0); /* otherwise nothing has been shown */
    fl_poly_free(&box);
    fl_structure_free(&st);
    fl_surface_free(&surface);
    fl_patch_points_free(&w);
    fl_mesh_contact_work_free(&near);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sums_under_a_face_are_the_same),
                                       cmocka_unit_test(old_lists_change_no_bit)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
