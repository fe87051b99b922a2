/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "support/near.h"
#include "support/shapes.h"

/* The unit cube as input, to be damaged. */
static const fl_vec3 cube_v[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
static const int32_t cube_first[7] = {0, 4, 8, 12, 16, 20, 24};
static const int32_t cube_loop[24] = {3, 2, 1, 0, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};

static void expect_refusal(int32_t nv, const fl_vec3 *v, int32_t nf, const int32_t *first,
                           const int32_t *loop, const char *sentence)
{
    fl_err err = {0};
    fl_poly p = {.nv = 77};
    assert_int_equal(fl_poly_make(&p, nv, v, nf, first, loop, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text, sentence);
    assert_int_equal(p.nv, 77);
}

static void cube_has_its_parts(void **state)
{
    (void)state;
    fl_err err = {0};
    fl_poly p;
    assert_int_equal(fl_poly_make(&p, 8, cube_v, 6, cube_first, cube_loop, &err), 0);
    assert_int_equal(p.nv, 8);
    assert_int_equal(p.nf, 6);
    assert_int_equal(p.ne, 12);
    assert_near(p.size, 1.0, 0.0);
    for (int32_t e = 0; e < p.ne; e++) {
        const fl_edge s = p.edge[e];
        assert_true(s.a < s.b);
        if (e) assert_true(p.edge[e - 1].a < s.a || (p.edge[e - 1].a == s.a && p.edge[e - 1].b < s.b));
        /* a to b has its loop on the left, b to a on the right */
        int found = 0;
        for (int side = 0; side < 2; side++) {
            const int32_t f = side ? s.right : s.left, from = side ? s.b : s.a, to = side ? s.a : s.b;
            for (int32_t k = p.first[f]; k < p.first[f + 1]; k++)
                found += p.loop[k] == from && p.loop[k + 1 < p.first[f + 1] ? k + 1 : p.first[f]] == to;
        }
        assert_int_equal(found, 2);
        assert_near(fl_poly_compute_bend(&p, e), 1.5707963267948966, 1e-15);
    }
    const fl_vec3 n[6] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    const double c[6] = {0, 1, 0, 1, 1, 0};
    for (int f = 0; f < 6; f++) {
        assert_near_of(v3_norm(v3_sub(p.n[f], n[f])), 0.0, 1e-15, 1.0);
        assert_near_of(p.c[f], c[f], 1e-15, 1.0);
        assert_near(v3_dot(fl_poly_face_area_vector(&p, f), n[f]), 1.0, 1e-15);
    }
    fl_poly_free(&p);
    assert_null(p.v);
    fl_poly_free(&p);
}

static void points_segments_polygons(void **state)
{
    (void)state;
    fl_err err = {0};
    fl_poly p;
    const fl_vec3 v[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const int32_t first[3] = {0, 4, 8}, loop[8] = {0, 1, 2, 3, 3, 2, 1, 0};
    assert_int_equal(fl_poly_make(&p, 1, v, 0, NULL, NULL, &err), 0);
    assert_int_equal(p.ne, 0);
    assert_near(p.size, 0.0, 0.0);
    fl_poly_free(&p);
    assert_int_equal(fl_poly_make(&p, 2, v, 0, NULL, NULL, &err), 0);
    assert_int_equal(p.ne, 1);
    assert_int_equal(p.edge[0].left, -1);
    assert_near(fl_poly_compute_bend(&p, 0), 6.283185307179586, 0.0);
    fl_poly_free(&p);
    assert_int_equal(fl_poly_make(&p, 4, v, 2, first, loop, &err), 0);
    assert_int_equal(p.ne, 4);
    for (int e = 0; e < 4; e++) assert_near(fl_poly_compute_bend(&p, e), PI, 1e-15);
    fl_poly_free(&p);
    expect_refusal(2, (fl_vec3[2]){{1, 2, 3}, {1, 2, 3}}, 0, NULL, NULL,
                   "vertices 0 and 1 coincide: a sphere has one vertex");
    expect_refusal(3, v, 0, NULL, NULL, "a core of 3 vertices needs at least 2 faces, 0 given");
    expect_refusal(1, v, 1, first, loop, "a core of 1 vertex has no faces, 1 given");
    expect_refusal(2, v, 2, first, loop, "a core of 2 vertices has no faces, 2 given");
    expect_refusal(0, v, 0, NULL, NULL, "a core needs a vertex");
    expect_refusal(4, v, -1, NULL, NULL, "-1 faces are not possible");
}

static void each_fault_has_its_message(void **state)
{
    (void)state;
    fl_vec3 v[9];
    int32_t loop[24], first[7];
    for (int fault = 0; fault < 14; fault++) {
        int32_t nv = 8, nf = 6;
        const char *message = "";
        memcpy(v, cube_v, sizeof cube_v);
        memcpy(loop, cube_loop, sizeof loop);
        memcpy(first, cube_first, sizeof first);
        switch (fault) {
        case 0:
            memcpy(loop + 12, (int32_t[4]){5, 6, 2, 1}, 4 * sizeof *loop);
            message = "face 3 is turned inside out";
            break;
        case 1:
            for (int k = 0; k < 24; k++) loop[k] = cube_loop[k / 4 * 4 + 3 - k % 4];
            message = "face 0 is turned inside out";
            break;
        case 2:
            v[6] = v3(0.5, 0.5, 0.5);
            message = "face 1 is not flat: its vertices span 0.384900179459751 m across its plane";
            break;
        case 3:
            v[1].x = NAN;
            message = "vertex 1 is not finite";
            break;
        case 4:
            loop[3] = 8;
            message = "face 0 names vertex 8, but there are 8 (0 to 7)";
            break;
        case 5:
            loop[3] = -1;
            message = "face 0 names vertex -1, but there are 8 (0 to 7)";
            break;
        case 6:
            nf = 5;
            message = "the edge of vertices 0 and 3, on face 0, has no second face: the core is not closed";
            break;
        case 7:
            nv = 9;
            v[8] = v3(0.5, 0.5, 0.5);
            message = "vertex 8 belongs to no face";
            break;
        case 8:
            loop[1] = loop[0];
            message = "face 0 names vertex 3 twice";
            break;
        case 9:
            v[2] = v[1];
            message = "vertices 2 and 1 coincide: they are 0 m apart";
            break;
        case 10:
            first[3] = first[2] + 2;
            message = "face 2 has 2 vertices, at least 3 are wanted";
            break;
        case 11:
            first[0] = 1;
            message = "face 0 starts at 1 of the index list, not at 0";
            break;
        case 12:
            v[0].y = 1e200;
            message = "a vertex lies 1e+200 m away";
            break;
        case 13:
            first[4] = INT32_MIN;
            message = "face 3 has -2147483660 vertices, at least 3 are wanted";
            break;
        }
        if (fault == 2) { /* the digits are not compared */
            fl_err err = {0};
            fl_poly p;
            assert_int_equal(fl_poly_make(&p, nv, v, nf, first, loop, &err), -1);
            assert_memory_equal(err.text, message, 32);
            continue;
        }
        expect_refusal(nv, v, nf, first, loop, message);
    }
}

static void concave_bodies_are_refused(void **state)
{
    (void)state;
    /* an L-shaped prism: flat convex faces fail first on the L itself */
    const fl_vec3 ell[6] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
    fl_err err = {0};
    fl_poly p;
    assert_int_equal(fl_poly_prism(&p, 6, ell, 0.0, 1.0, &err), -1);
    assert_string_equal(err.text, "face 0 is not convex at vertex 3");
    /* a cube with a pyramid pressed into its top */
    fl_vec3 v[9];
    memcpy(v, cube_v, sizeof cube_v);
    v[8] = v3(0.5, 0.5, 0.75);
    const int32_t first[10] = {0, 4, 8, 12, 16, 20, 23, 26, 29, 32};
    const int32_t loop[32] = {3, 2, 1, 0, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6,
                              3, 0, 4, 7, 4, 5, 8, 5, 6, 8, 6, 7, 8, 7, 4, 8};
    err = (fl_err){0};
    assert_int_equal(fl_poly_make(&p, 9, v, 9, first, loop, &err), -1);
    assert_string_equal(err.text, "vertex 6 lies 0.447214 m outside face 5: the core is not convex");
    /* the same pulled out is convex */
    v[8].z = 1.25;
    err = (fl_err){0};
    assert_int_equal(fl_poly_make(&p, 9, v, 9, first, loop, &err), 0);
    fl_poly_free(&p);
    /* a star that turns left at every corner */
    fl_vec3 star[5];
    for (int k = 0; k < 5; k++) star[k] = v3(cos(2.513274122871834 * k), sin(2.513274122871834 * k), 0.0);
    assert_int_equal(fl_poly_prism(&p, 5, star, 0.0, 1.0, &err), -1);
    assert_string_equal(err.text, "face 0 winds round more than once");
    /* a spike */
    const fl_vec3 spike[4] = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {0.5, 1, 0}};
    err = (fl_err){0};
    assert_int_equal(fl_poly_prism(&p, 4, spike, 0.0, 1.0, &err), -1);
    assert_non_null(strstr(err.text, "face 0 is not convex at vertex 2"));
    /* clockwise */
    const fl_vec3 square[4] = {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}};
    err = (fl_err){0};
    assert_int_equal(fl_poly_prism(&p, 4, square, 0.0, 1.0, &err), -1);
    assert_non_null(strstr(err.text, "turned inside out"));
    err = (fl_err){0};
    assert_int_equal(fl_poly_prism(&p, 4, square, 1.0, 1.0, &err), -1);
    err = (fl_err){0};
    assert_int_equal(fl_poly_prism(&p, 2, square, 0.0, 1.0, &err), -1);
    err = (fl_err){0};
    assert_int_equal(fl_poly_box(&p, v3(1, NAN, 1), &err), -1);
}

static void flat_bodies_with_many_faces_are_refused(void **state)
{
    (void)state;
    /* a tetrahedron of no height: two triangles above, two below */
    const fl_vec3 v[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const int32_t first[5] = {0, 3, 6, 9, 12}, loop[12] = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
    expect_refusal(4, v, 4, first, loop,
                   "the core is flat and has 4 faces: a flat core has two, one each way");
    /* a needle: all vertices on a line */
    const fl_vec3 w[4] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    expect_refusal(4, w, 4, first, loop, "face 0 has no area: its vertices lie on a line");
}

static void two_bodies_are_not_one(void **state)
{
    (void)state;
    /* a small cube inside a big one: every vertex behind every face of neither */
    fl_vec3 v[16];
    int32_t first[13], loop[48];
    for (int k = 0; k < 8; k++) {
        v[k] = cube_v[k];
        v[8 + k] = cube_v[k];
    }
    for (int k = 0; k < 24; k++) {
        loop[k] = cube_loop[k];
        loop[24 + k] = 8 + cube_loop[k];
    }
    for (int k = 0; k < 13; k++) first[k] = 4 * k;
    expect_refusal(16, v, 12, first, loop, "the faces form 2 separate surfaces, one is wanted");
    /* one cube, its top face given twice */
    memcpy(loop, cube_loop, sizeof cube_loop);
    memcpy(loop + 24, cube_loop + 4, 4 * sizeof *loop);
    expect_refusal(8, v, 7, first, loop,
                   "the edge of vertices 4 and 5, on face 6, belongs to more than two faces");
    /* corners repeated for each face: closed only in appearance */
    for (int k = 0; k < 24; k++) loop[k] = cube_loop[k];
    loop[4] = 8 + 4;
    v[12] = v[4];
    expect_refusal(
        13, (fl_vec3[13]){v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[4], v[4], v[4], v[4], v[4]}, 6,
        first, loop, "vertex 8 belongs to no face");
    memcpy(v + 8, v + 4, sizeof *v);
    loop[4] = 8;
    expect_refusal(
        9, v, 6, first, loop,
        "the edge of vertices 5 and 4, on face 2, has no second face: the core is not closed (some "
        "vertices coincide)");
}

static void straight_corners_and_coplanar_faces_are_accepted(void **state)
{
    (void)state;
    /* a cube whose top is two triangles and whose edge 0-1 has a vertex in the middle */
    fl_vec3 v[9];
    memcpy(v, cube_v, sizeof cube_v);
    v[8] = v3(0.5, 0, 0);
    const int32_t first[8] = {0, 5, 8, 11, 16, 20, 24, 28};
    const int32_t loop[28] = {3, 2, 1, 8, 0, 4, 5, 6, 4, 6, 7, 0, 8, 1,
                              5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    fl_err err = {0};
    fl_poly p;
    assert_int_equal(fl_poly_make(&p, 9, v, 7, first, loop, &err), 0);
    assert_int_equal(p.ne, 14);
    double smallest = 9.0;
    for (int e = 0; e < p.ne; e++) smallest = fmin(smallest, fl_poly_compute_bend(&p, e));
    assert_near_of(smallest, 0.0, 1e-15, 1.0);
    fl_poly_free(&p);
}

static void large_prisms_are_checked_fast(void **state)
{
    (void)state;
    const int n = 5000;
    fl_err err = {0};
    fl_vec3 *xy = fl_alloc(n, sizeof *xy, &err);
    fl_poly p, q;
    assert_non_null(xy);
    for (int k = 0; k < n; k++)
        xy[k] = v3(10.0 * cos(6.283185307179586 * k / n), 10.0 * sin(6.283185307179586 * k / n), 0.0);
    assert_int_equal(fl_poly_prism(&p, n, xy, -1.0, 1.0, &err), 0);
    assert_int_equal(p.ne, 3 * n);
    /* a face reversed, a corner pushed in */
    int32_t *loop = fl_alloc(p.first[p.nf], sizeof *loop, &err);
    assert_non_null(loop);
    memcpy(loop, p.loop, (size_t)p.first[p.nf] * sizeof *loop);
    const int32_t a = p.first[100];
    for (int k = 0; k < 4; k++) loop[a + k] = p.loop[a + 3 - k];
    assert_int_equal(fl_poly_make(&q, p.nv, p.v, p.nf, p.first, loop, &err), -1);
    assert_string_equal(err.text, "face 100 is turned inside out");
    err = (fl_err){0};
    xy[7] = v3_scale(0.999, xy[7]);
    assert_int_equal(fl_poly_prism(&q, n, xy, -1.0, 1.0, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    /* roof: with triangulated ends the faces would not show the dent, so the edges must */
    int32_t *first = fl_alloc(2 * n + 1, sizeof *first, &err), *tri = fl_alloc(6 * n, sizeof *tri, &err);
    fl_vec3 *v = fl_alloc(n + 2, sizeof *v, &err);
    assert_true(first && tri && v);
    for (int k = 0; k < n; k++) {
        v[k] = xy[k];
        const int32_t m = (k + 1) % n;
        memcpy(tri + 6 * k, (int32_t[6]){k, m, n, m, k, n + 1}, 6 * sizeof *tri);
        first[2 * k + 1] = 6 * k + 3;
        first[2 * k + 2] = 6 * k + 6;
    }
    v[n] = v3(0, 0, 3);
    v[n + 1] = v3(0, 0, -3);
    err = (fl_err){0};
    assert_int_equal(fl_poly_make(&q, n + 2, v, 2 * n, first, tri, &err), -1);
    assert_non_null(strstr(err.text, "the core is not convex"));
    v[7] = v3_scale(1.0 / 0.999, v[7]);
    err = (fl_err){0};
    assert_int_equal(fl_poly_make(&q, n + 2, v, 2 * n, first, tri, &err), 0);
    fl_poly_free(&q);
    fl_poly_free(&p);
    free(xy);
    free(loop);
    free(first);
    free(tri);
    free(v);
}

static void copies_and_frames(void **state)
{
    (void)state;
    for (int k = 0; k < 200; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_err err = {0};
        fl_poly p, q;
        shape_random(&p, &g);
        assert_int_equal(fl_poly_copy(&q, &p, &err), 0);
        assert_memory_equal(q.loop, p.loop, (size_t)p.first[p.nf] * sizeof *p.loop);
        assert_memory_equal(q.edge, p.edge, (size_t)p.ne * sizeof *p.edge);
        const fl_quat r = shape_rotation(&g);
        const fl_vec3 d = v3_scale(10.0, shape_direction(&g));
        shape_move(&q, r, d);
        for (int32_t v = 0; v < p.nv; v++)
            assert_near_of(v3_norm(v3_sub(q.v[v], v3_add(d, q_rotate(r, p.v[v])))), 0.0, 1e-14, 10.0);
        for (int32_t f = 0; f < p.nf; f++) {
            assert_near_of(v3_norm(v3_sub(q.n[f], q_rotate(r, p.n[f]))), 0.0, 1e-14, 1.0);
            assert_near_of(q.c[f], p.c[f] + v3_dot(q.n[f], d), 1e-13, 10.0);
            for (int32_t e = q.first[f]; e < q.first[f + 1]; e++)
                assert_true(v3_dot(q.n[f], q.v[q.loop[e]]) <= q.c[f]);
        }
        const fl_aabb b = fl_poly_aabb(&q);
        for (int32_t v = 0; v < q.nv; v++) {
            assert_true(q.v[v].x >= b.lo.x && q.v[v].x <= b.hi.x);
            assert_true(q.v[v].z >= b.lo.z && q.v[v].z <= b.hi.z);
        }
        fl_poly_free(&p);
        fl_poly_free(&q);
    }
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    for (int after = 0; after < 3; after++) {
        fl_err err = {0};
        fl_poly p = {.nv = 5};
        fl_alloc_fail_after(after);
        const int rc = fl_poly_make(&p, 8, cube_v, 6, cube_first, cube_loop, &err);
        fl_alloc_fail_after(-1);
        if (rc == 0) {
            assert_int_equal(after, 2);
            fl_poly_free(&p);
            continue;
        }
        assert_int_equal(err.code, FL_SYSTEM);
        assert_int_equal(p.nv, 5);
    }
}

static void a_compact_polyhedron_has_corners_and_faces(void **state)
{
    (void)state;
    const fl_vec3 xy[5] = {{0, 0, 0}, {4, 0, 0}, {5, 3, 0}, {2, 5, 0}, {-1, 3, 0}};
    fl_poly p = {0}, q = {0}, r = {0};
    fl_err err = {0};
    assert_int_equal(fl_poly_prism(&p, 5, xy, -1.0, 2.0, &err), 0);
    assert_int_equal(fl_poly_copy(&q, &p, &err), 0);
    fl_alloc_fail_after(0);
    assert_int_equal(fl_poly_strip(&q, &err), -1);
    fl_alloc_fail_after(-1);
    assert_int_equal(err.code, FL_SYSTEM);
    assert_int_equal(q.ne, p.ne);
    err = (fl_err){0};
    assert_int_equal(fl_poly_strip(&q, &err), 0);
    assert_int_equal(q.ne, 0);
    assert_null(q.edge);
    assert_near(q.size, p.size, 0.0);
    /* the remaining data restore the whole */
    assert_int_equal(fl_poly_make(&r, q.nv, q.v, q.nf, q.first, q.loop, &err), 0);
    assert_int_equal(r.ne, p.ne);
    assert_memory_equal(r.v, p.v, (size_t)p.nv * sizeof *p.v);
    assert_memory_equal(r.n, p.n, (size_t)p.nf * sizeof *p.n);
    assert_memory_equal(r.edge, p.edge, (size_t)p.ne * sizeof *p.edge);
    fl_poly_free(&p);
    fl_poly_free(&q);
    fl_poly_free(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cube_has_its_parts),
        cmocka_unit_test(points_segments_polygons),
        cmocka_unit_test(each_fault_has_its_message),
        cmocka_unit_test(concave_bodies_are_refused),
        cmocka_unit_test(flat_bodies_with_many_faces_are_refused),
        cmocka_unit_test(two_bodies_are_not_one),
        cmocka_unit_test(straight_corners_and_coplanar_faces_are_accepted),
        cmocka_unit_test(large_prisms_are_checked_fast),
        cmocka_unit_test(copies_and_frames),
        cmocka_unit_test(a_compact_polyhedron_has_corners_and_faces),
        cmocka_unit_test(allocation_failure_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
