/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/array.h"
#include "geom/clip.h"
#include "geom/mass.h"
#include "support/near.h"
#include "support/shapes.h"

static double volume(const fl_poly *p)
{
    fl_err err = {0};
    fl_mass m;
    assert_int_equal(fl_mass_of(&m, p, 0.0, &err), 0);
    return m.volume;
}

static void box(fl_poly *p, double x, double y, double z)
{
    fl_err err = {0};
    assert_int_equal(fl_poly_box(p, v3(x, y, z), &err), 0);
}

static void planes_that_miss_the_body(void **state)
{
    (void)state;
    fl_err err = {0};
    fl_poly p;
    box(&p, 0.5, 0.5, 0.5);
    const void *at = p.v;
    assert_int_equal(fl_poly_cut(&p, v3(0, 0, 1), 0.7, &err), 0);
    assert_int_equal(fl_poly_cut(&p, v3(0, 0, 1), 0.5, &err), 0); /* along a face */
    assert_int_equal(fl_poly_cut(&p, v3(0, 0, 1), 0.5 - 4e-13, &err), 0);
    assert_ptr_equal(p.v, at);
    assert_int_equal(fl_poly_cut(&p, v3(0, 0, 1), -0.5, &err), 0); /* leaves only the lower face */
    assert_int_equal(p.nv, 0);
    assert_null(p.v);
    box(&p, 0.5, 0.5, 0.5);
    assert_int_equal(fl_poly_cut(&p, v3_unit(v3(1, 1, 1)), -0.8660254037844386, &err), 0); /* one corner */
    assert_int_equal(p.nv, 0);
    box(&p, 0.5, 0.5, 0.5);
    assert_int_equal(fl_poly_cut(&p, v3(1, 0, 0), -2.0, &err), 0);
    assert_int_equal(p.nv, 0);
    assert_int_equal(err.code, 0);
}

static void planes_through_vertices_and_edges(void **state)
{
    (void)state;
    fl_err err = {0};
    fl_poly p;
    box(&p, 0.5, 0.5, 0.5);
    /* through the ends of four parallel edges: two triangles and a rectangle */
    assert_int_equal(fl_poly_cut(&p, v3_unit(v3(1, 1, 0)), 0.0, &err), 0);
    assert_int_equal(p.nv, 6);
    assert_int_equal(p.nf, 5);
    assert_near(volume(&p), 0.5, 1e-15);
    assert_near(v3_norm(fl_poly_face_area_vector(&p, 4)), 1.4142135623730951, 1e-15);
    fl_poly_free(&p);
    box(&p, 0.5, 0.5, 0.5);
    /* through three vertices */
    assert_int_equal(fl_poly_cut(&p, v3_unit(v3(1, 1, 1)), 0.5 / 1.7320508075688772, &err), 0);
    assert_int_equal(p.nv, 7);
    assert_int_equal(p.nf, 7);
    assert_near(volume(&p), 5.0 / 6.0, 1e-15);
    fl_poly_free(&p);
    box(&p, 0.5, 0.5, 0.5);
    assert_int_equal(fl_poly_cut(&p, v3_unit(v3(-1, -1, -1)), -0.5 / 1.7320508075688772, &err), 0);
    assert_int_equal(p.nv, 4);
    assert_near(volume(&p), 1.0 / 6.0, 1e-15);
    fl_poly_free(&p);
}

static void flat_and_thin_cores(void **state)
{
    (void)state;
    const fl_vec3 v[4] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    const int32_t first[3] = {0, 4, 8}, loop[8] = {0, 1, 2, 3, 3, 2, 1, 0};
    fl_err err = {0};
    fl_poly p;
    assert_int_equal(fl_poly_make(&p, 4, v, 2, first, loop, &err), 0);
    assert_int_equal(fl_poly_cut(&p, v3(0.6, 0, 0.8), 0.15, &err), 0);
    assert_int_equal(p.nv, 4);
    assert_int_equal(p.nf, 2);
    assert_near(v3_norm(fl_poly_face_area_vector(&p, 0)), 2.5, 1e-15);
    assert_int_equal(fl_poly_cut(&p, v3(0, 0, 1), 0.0, &err), 0); /* lies in the plane: stays */
    assert_int_equal(p.nv, 4);
    assert_int_equal(fl_poly_cut(&p, v3(0, 0, 1), -0.1, &err), 0);
    assert_int_equal(p.nv, 0);
    assert_int_equal(fl_poly_make(&p, 2, v, 0, NULL, NULL, &err), 0);
    assert_int_equal(fl_poly_cut(&p, v3(1, 0, 0), 0.5, &err), 0);
    assert_near(p.v[1].x, 0.5, 1e-15);
    assert_int_equal(fl_poly_cut(&p, v3(1, 0, 0), -0.99999999995, &err), 0); /* short, but a segment */
    assert_int_equal(p.nv, 2);
    assert_int_equal(fl_poly_cut(&p, v3(1, 0, 0), -1.0, &err), 0);
    assert_int_equal(p.nv, 0);
    assert_int_equal(fl_poly_make(&p, 1, v, 0, NULL, NULL, &err), 0);
    assert_int_equal(fl_poly_cut(&p, v3(1, 0, 0), -1.0, &err), 0);
    assert_int_equal(p.nv, 1);
    assert_int_equal(fl_poly_cut(&p, v3(1, 0, 0), -1.1, &err), 0);
    assert_int_equal(p.nv, 0);
}

static void box_moves_its_faces(void **state)
{
    (void)state;
    fl_err err = {0};
    fl_poly p, q, r;
    box(&p, 5, 5, 0.5);
    assert_int_equal(fl_poly_offset(&q, &p, -0.05, &err), 0);
    assert_near(volume(&q), 9.9 * 9.9 * 0.9, 1e-15);
    assert_int_equal(q.nv, 8);
    assert_int_equal(fl_poly_offset(&r, &q, 0.05, &err), 0);
    for (int k = 0; k < 8; k++) assert_near_of(v3_norm(v3_sub(r.v[k], p.v[k])), 0.0, 1e-16, 10.0);
    fl_poly_free(&q);
    fl_poly_free(&r);
    assert_int_equal(fl_poly_offset(&q, &p, -0.5, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text, "moving the faces inward by 0.5 m leaves nothing");
    err = (fl_err){0};
    assert_int_equal(fl_poly_offset(&q, &p, -0.6, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    err = (fl_err){0};
    assert_int_equal(fl_poly_offset(&q, &p, NAN, &err), -1);
    err = (fl_err){0};
    assert_int_equal(fl_poly_offset(&q, &p, 0.0, &err), 0);
    assert_near(volume(&q), 100.0, 1e-15);
    fl_poly_free(&q);
    fl_poly_free(&p);
}

/* A prism whose polygon has a short side loses that side when its faces move inward. A box with a chipped
 * corner loses the chip's edges when its faces move outward. */
static void faces_vanish(void **state)
{
    (void)state;
    const fl_vec3 xy[5] = {{0, 0, 0}, {4, 0, 0}, {4, 3.9, 0}, {3.9, 4, 0}, {0, 4, 0}};
    fl_err err = {0};
    fl_poly p, q;
    assert_int_equal(fl_poly_prism(&p, 5, xy, 0.0, 3.0, &err), 0);
    /* the short side, 0.1 sqrt 2, shrinks by 2 d tan(pi/8): gone at d = 0.1707 */
    assert_int_equal(fl_poly_offset(&q, &p, -0.17, &err), 0);
    assert_int_equal(q.nf, 7);
    fl_poly_free(&q);
    assert_int_equal(fl_poly_offset(&q, &p, -0.172, &err), 0);
    assert_int_equal(q.nf, 6);
    assert_int_equal(q.nv, 8);
    assert_near(volume(&q), (4 - 0.344) * (4 - 0.344) * (3 - 0.344), 1e-14);
    assert_near(q.n[0].z, -1.0, 0.0); /* faces keep their order */
    assert_near(q.n[1].z, 1.0, 0.0);
    fl_poly_free(&q);
    fl_poly_free(&p);
    box(&p, 1, 1, 1);
    assert_int_equal(fl_poly_cut(&p, v3_unit(v3(1, 1, 1)), 1.7, &err), 0);
    assert_int_equal(p.nf, 7);
    /* the chip's plane is 0.0320 behind the corner; moving inward by 0.05 moves the corner, sqrt 3 times as
     * fast, behind it */
    assert_int_equal(fl_poly_offset(&q, &p, -0.05, &err), 0);
    assert_int_equal(q.nf, 6);
    assert_near(volume(&q), 1.9 * 1.9 * 1.9, 1e-14);
    fl_poly_free(&q);
    fl_poly_free(&p);
}

/* At the apex of a pyramid more than three faces meet. On a regular pyramid they still do after the move; on
 * an irregular one they separate and a ridge appears. */
static void apexes_may_split(void **state)
{
    (void)state;
    fl_err err = {0};
    fl_poly p, q, r;
    shape_regular(&p, 8, 1.0);
    assert_int_equal(fl_poly_offset(&q, &p, 0.25, &err), 0);
    assert_int_equal(q.nv, 6);
    assert_near(q.v[0].x, 1.0 + 0.25 * 1.7320508075688772, 1e-15);
    fl_poly_free(&q);
    fl_vec3 v[6];
    for (int k = 0; k < 6; k++) v[k] = p.v[k];
    v[5].z = -0.5;
    v[4].z = 1.7;
    v[4].x = 0.1;
    v[0].x = 1.3;
    v[2].y = 0.8;
    assert_int_equal(fl_poly_make(&r, 6, v, 8, p.first, p.loop, &err), 0);
    assert_int_equal(fl_poly_offset(&q, &r, -0.05, &err), 0);
    assert_int_equal(q.nf, 8);
    assert_true(q.nv > 6);
    for (int f = 0; f < 8; f++) {
        assert_near_of(v3_norm(v3_sub(q.n[f], r.n[f])), 0.0, 1e-13, 1.0);
        assert_near_of(q.c[f], r.c[f] - 0.05, 1e-14, 1.0);
    }
    fl_poly_free(&q);
    fl_poly_free(&r);
    fl_poly_free(&p);
}

static void cores_without_height(void **state)
{
    (void)state;
    const fl_vec3 v[4] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    const int32_t first[3] = {0, 4, 8}, loop[8] = {0, 1, 2, 3, 3, 2, 1, 0};
    fl_err err = {0};
    fl_poly p, q;
    assert_int_equal(fl_poly_make(&p, 4, v, 2, first, loop, &err), 0);
    assert_int_equal(fl_poly_offset(&q, &p, 0.5, &err), 0);
    assert_near(volume(&q), 9.0, 1e-14);
    fl_poly_free(&q);
    assert_int_equal(fl_poly_offset(&q, &p, -0.5, &err), -1);
    assert_string_equal(err.text, "moving the faces of a flat core inward by 0.5 m leaves nothing");
    fl_poly_free(&p);
    for (int nv = 1; nv <= 2; nv++) {
        err = (fl_err){0};
        assert_int_equal(fl_poly_make(&p, nv, v, 0, NULL, NULL, &err), 0);
        assert_int_equal(fl_poly_offset(&q, &p, 0.5, &err), -1);
        assert_string_equal(err.text,
                            nv == 1 ? "a point has no faces to move" : "a segment has no faces to move");
        fl_poly_free(&p);
    }
    /* a blade: its edge moves out to r / sin(half the angle) */
    const fl_vec3 blade[3] = {{0, 0, 0}, {1, -1e-6, 0}, {1, 1e-6, 0}};
    err = (fl_err){0};
    assert_int_equal(fl_poly_prism(&p, 3, blade, 0.0, 1e-6, &err), 0);
    assert_int_equal(fl_poly_offset(&q, &p, 1e-3, &err), 0);
    assert_near(q.v[0].x, -1e-3 * sqrt(1.0 + 1e12), 1e-6);
    fl_poly_free(&q);
    fl_poly_free(&p);
}

/* The limit is the same whether the faces stay or are intersected with each other. */
static void corners_may_move_only_so_far(void **state)
{
    (void)state;
    const fl_vec3 wedge[3] = {{0, 0, 0}, {1, -5e-7, 0}, {1, 5e-7, 0}};
    const fl_vec3 needle[4] = {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-7, 0}, {0.5, 0, 1e-7}};
    const int32_t first[5] = {0, 3, 6, 9, 12}, loop[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    fl_err err = {0};
    fl_poly p, q;
    assert_int_equal(fl_poly_prism(&p, 3, wedge, 0.0, 0.4, &err), 0);
    assert_int_equal(fl_poly_offset(&q, &p, 0.004, &err), 0); /* 8 km */
    fl_poly_free(&q);
    assert_int_equal(fl_poly_offset(&q, &p, 0.05, &err), -1); /* 100 km */
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text,
                        "a corner is so sharp that moving the faces by 0.05 m moves it beyond 10500 m");
    fl_poly_free(&p);
    err = (fl_err){0};
    assert_int_equal(fl_poly_make(&p, 4, needle, 4, first, loop, &err), 0);
    assert_int_equal(fl_poly_offset(&q, &p, 1.0, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    fl_poly_free(&p);
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    for (int what = 0; what < 3; what++)
        for (int after = 0;; after++) {
            fl_err err = {0};
            fl_poly p, q = {0};
            box(&p, 1, 1, 1);
            if (what == 2) assert_int_equal(fl_poly_cut(&p, v3_unit(v3(1, 1, 1)), 1.7, &err), 0);
            fl_alloc_fail_after(after);
            const int rc =
                what == 0 ? fl_poly_cut(&p, v3(0.6, 0, 0.8), 0.3, &err) : fl_poly_offset(&q, &p, -0.05, &err);
            fl_alloc_fail_after(-1);
            fl_poly_free(&p);
            fl_poly_free(&q);
            if (rc == 0) {
                assert_true(after > 2);
                break;
            }
            assert_int_equal(err.code, FL_SYSTEM);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_that_miss_the_body),
        cmocka_unit_test(planes_through_vertices_and_edges),
        cmocka_unit_test(flat_and_thin_cores),
        cmocka_unit_test(box_moves_its_faces),
        cmocka_unit_test(faces_vanish),
        cmocka_unit_test(apexes_may_split),
        cmocka_unit_test(cores_without_height),
        cmocka_unit_test(corners_may_move_only_so_far),
        cmocka_unit_test(allocation_failure_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
