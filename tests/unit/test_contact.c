/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every contact mode with its length and area, the angles at which modes change, and the overlap of
 * outlines. */
#include "support/near.h"
#include <math.h>
#include <string.h>
#include "geom/quat.h"
#include "narrow/contact.h"
#include "narrow/overlap.h"
#include "support/convex_pairs.h"

static fl_mat3 rotation_of(fl_vec3 r) { return q_matrix(q_of_vector(r)); }

static fl_poly box(double x, double y, double z)
{
    fl_poly p;
    fl_err err = {0};
    assert_int_equal(fl_poly_box(&p, v3(x / 2, y / 2, z / 2), &err), 0);
    return p;
}

static fl_poly segment(fl_vec3 p, fl_vec3 q)
{
    fl_poly s;
    fl_err err = {0};
    const fl_vec3 v[2] = {p, q};
    const int32_t first = 0;
    assert_int_equal(fl_poly_make(&s, 2, v, 0, &first, NULL, &err), 0);
    return s;
}

static fl_poly point(void)
{
    fl_poly s;
    fl_err err = {0};
    const fl_vec3 v = {0, 0, 0};
    const int32_t first = 0;
    assert_int_equal(fl_poly_make(&s, 1, &v, 0, &first, NULL, &err), 0);
    return s;
}

/* The contact of shape p at o, rotated by r, above shape q at the origin; radii 0.1 and 0.2. Body a is p. The
 * pair is also evaluated in reverse order, and a million metres away. */
static fl_contact contact_of(fl_poly p, fl_vec3 o, fl_vec3 r, fl_poly q, fl_mode before)
{
    pair_case c;
    fl_contact out, back, far;
    assert_int_equal(pair_take(&c, p, q), 0);
    pair_place(&c, 0, o, rotation_of(r));
    c.a.r = 0.1;
    c.b.r = 0.2;
    fl_contact_find(&c.a, &c.b, before, NULL, NULL, &out);
    fl_contact_find(&c.b, &c.a, before, NULL, NULL, &back);
    assert_int_equal(out.mode, back.mode);
    assert_near_of(back.gap, out.gap, 1e-15, 10.0);
    assert_near_of(v3_norm(v3_add(back.n, out.n)), 0.0, 1e-14, 1.0);
    assert_near_of(v3_norm(v3_sub(back.p, out.p)), 0.0, 1e-13, 10.0);
    assert_near_of(back.length, out.length, 1e-14, 10.0);
    assert_near_of(back.area, out.area, 1e-14, 100.0);
    const fl_vec3 away = {1e6, -1e6, 5e5};
    pair_place(&c, 0, v3_add(o, away), rotation_of(r));
    pair_place(&c, 1, away, rotation_of(v3(0, 0, 0)));
    c.a.r = 0.1;
    c.b.r = 0.2;
    fl_contact_find(&c.a, &c.b, before, NULL, NULL, &far);
    assert_int_equal(out.mode, far.mode);
    assert_near_of(far.gap, out.gap, 1e-9, 1.0);
    assert_near_of(v3_norm(v3_sub(v3_sub(far.p, away), out.p)), 0.0, 1e-8, 1.0);
    assert_near_of(far.area, out.area, 1e-8, 1.0);
    pair_free(&c);
    return out;
}

static const fl_vec3 straight = {0, 0, 0};
/* A cube that stands on its corner: the diagonal (1, 1, 1) is rotated to z. */
static fl_vec3 rotation_to_corner(void)
{
    const double a = acos(1.0 / sqrt(3.0));
    return v3_scale(a, v3_unit(v3(1, -1, 0)));
}

static void faces_share_an_area(void **state)
{
    (void)state;
    /* 2 x 2 on 4 x 4, all inside; then sliding off one side; then a quarter over a corner. */
    fl_contact c = contact_of(box(2, 2, 2), v3(0.3, 0.2, 3.0), straight, box(4, 4, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_FF);
    assert_near(c.area, 4.0, 1e-14);
    assert_near(c.d, 1.0, 1e-15);
    assert_near(c.gap, 0.7, 1e-15);
    assert_near(c.n.z, 1.0, 1e-15);
    assert_near(c.p.x, 0.3, 1e-13);
    assert_near(c.p.y, 0.2, 1e-13);
    assert_near(c.p.z, 0.5 * (2.0 - 0.1 + 1.0 + 0.2), 1e-15);
    c = contact_of(box(2, 2, 2), v3(2.5, 0.0, 3.0), straight, box(4, 4, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_FF);
    assert_near(c.area, 0.5 * 2.0, 1e-14);
    assert_near(c.p.x, 1.75, 1e-13);
    c = contact_of(box(2, 2, 2), v3(2.5, -2.25, 3.0), straight, box(4, 4, 2), FL_MODE_NONE);
    assert_near(c.area, 0.5 * 0.75, 1e-14);
    assert_near(c.p.y, -1.625, 1e-13);
    /* The same square turned by 45 degrees over itself: a regular octagon, 8 (sqrt 2 - 1) / 4 of the side
     * squared. */
    c = contact_of(box(2, 2, 2), v3(0, 0, 3.0), v3(0, 0, atan(1.0)), box(2, 2, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_FF);
    assert_near(c.area, 8.0 * (sqrt(2.0) - 1.0), 1e-14);
    /* Equal boxes, all edges over each other. */
    c = contact_of(box(2, 2, 2), v3(0, 0, 2.0 + 1e-9), straight, box(2, 2, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_FF);
    assert_near(c.area, 4.0, 1e-14);
}

static void edges_lie_on_faces(void **state)
{
    (void)state;
    /* A box that stands on its edge along y, 2 long, over a face 4 x 4. */
    fl_contact c = contact_of(box(2, 2, 2), v3(0, 0.5, 3.0), v3(0, atan(1.0), 0), box(4, 4, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_EF);
    assert_near(c.length, 2.0, 1e-14);
    assert_near(c.d, 2.0 - sqrt(2.0), 1e-14);
    assert_near(c.p.y, 0.5, 1e-13);
    /* Half of it beyond the border. */
    c = contact_of(box(2, 2, 2), v3(0, 2.0, 3.0), v3(0, atan(1.0), 0), box(4, 4, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_EF);
    assert_near(c.length, 1.0, 1e-14);
    assert_near(c.p.y, 1.5, 1e-13);
    /* A capsule along the diagonal. */
    c = contact_of(segment(v3(-1, -1, 0), v3(1, 1, 0)), v3(0, 0, 1.5), straight, box(4, 4, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_EF);
    assert_near(c.length, 2.0 * sqrt(2.0), 1e-14);
    /* A segment longer than the face: only the part inside counts. */
    c = contact_of(segment(v3(-9, 0, 0), v3(5, 0, 0)), v3(0, 0, 1.5), straight, box(4, 4, 2), FL_MODE_NONE);
    assert_near(c.length, 4.0, 1e-14);
}

static void parallel_edges_share_a_length(void **state)
{
    (void)state;
    /* Two boxes on their edges, side by side along y, 1.5 of the 2 in common. */
    fl_contact c =
        contact_of(segment(v3(0, -1, 0), v3(0, 1, 0)), v3(3, 0.5, 3), straight, box(2, 2, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_EP);
    assert_near(c.length, 1.5, 1e-14);
    assert_near(c.d, 2.0 * sqrt(2.0), 1e-14);
    assert_near(c.p.y, 0.25, 1e-13);
    c = contact_of(box(2, 2, 2), v3(3.0, 0.0, 4.0), straight, box(2, 2, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_EP);
    assert_near(c.length, 2.0, 1e-14);
    assert_near(c.d, sqrt(1.0 + 4.0), 1e-14);
}

static void points_have_no_extent(void **state)
{
    (void)state;
    fl_contact c = contact_of(point(), v3(3, 3, 3), straight, box(2, 2, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_VV);
    assert_near(c.d, sqrt(12.0), 1e-15);
    c = contact_of(point(), v3(3, 0.5, 3), straight, box(2, 2, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_VE);
    assert_near(c.d, sqrt(8.0), 1e-15);
    c = contact_of(point(), v3(0.1, 0.5, 3), straight, box(2, 2, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_VF);
    assert_near(c.d, 2.0, 1e-15);
    assert_near(c.p.z, 0.5 * (3.0 - 0.1 + 1.0 + 0.2), 1e-15);
    c = contact_of(box(2, 2, 2), v3(0.1, 0.2, 3.0), rotation_to_corner(), box(4, 4, 2), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_VF);
    assert_near(c.d, 2.0 - sqrt(3.0), 1e-14);
    assert_true(c.length == 0.0 && c.area == 0.0);
    /* Crossed edges. */
    c = contact_of(segment(v3(0, -1, 0), v3(0, 1, 0)), v3(0.2, 0, 2), straight,
                   segment(v3(-1, 0, 0), v3(1, 0, 0)), FL_MODE_NONE);
    assert_int_equal(c.mode, FL_EE);
    assert_near(c.d, 2.0, 1e-15);
    assert_near(c.p.x, 0.2, 1e-14);
    assert_true(c.length == 0.0 && c.area == 0.0);
}

static fl_mode tilted_mode(double angle, fl_mode before)
{
    /* Tilted about x, so that the edge along x stays the lowest. */
    return contact_of(box(2, 2, 2), v3(0, 0, 3), v3(angle, 0, 0), box(4, 4, 2), before).mode;
}

static void modes_change_with_hysteresis(void **state)
{
    (void)state;
    for (double t = 1e-16; t < 0.9e-3; t *= 7.0) {
        assert_int_equal(tilted_mode(t, FL_MODE_NONE), FL_FF);
        assert_int_equal(tilted_mode(-t, FL_FF), FL_FF);
        assert_int_equal(tilted_mode(t, FL_EF), FL_FF);
    }
    assert_int_equal(tilted_mode(0.999e-3, FL_MODE_NONE), FL_FF);
    assert_int_equal(tilted_mode(1.001e-3, FL_MODE_NONE), FL_EF);
    assert_int_equal(tilted_mode(1.001e-3, FL_EF), FL_EF);
    assert_int_equal(tilted_mode(1.001e-3, FL_FF), FL_FF);
    assert_int_equal(tilted_mode(1.999e-3, FL_FF), FL_FF);
    assert_int_equal(tilted_mode(2.001e-3, FL_FF), FL_EF);
    for (double t = 3e-3; t < 0.7; t *= 3.0) assert_int_equal(tilted_mode(t, FL_FF), FL_EF);
    /* Nearly parallel edges (H15): parallel up to the angle, crossed beyond; the distance is exact
     * throughout. */
    for (double t = 1e-12; t < 0.1; t *= 10.0) {
        const fl_contact c = contact_of(segment(v3(0, -1, 0), v3(0, 1, 0)), v3(0, 0, 2), v3(0, 0, t),
                                        segment(v3(0, -1, 0), v3(0, 1, 0)), FL_MODE_NONE);
        assert_int_equal(c.mode, t < 1e-3 ? FL_EP : FL_EE);
        assert_near(c.d, 2.0, 1e-15);
    }
}

static void depth_continues_where_distance_ends(void **state)
{
    (void)state;
    /* From gap to overlap in steps: area, direction and point stay at each. */
    for (int k = -8; k <= 8; k++) {
        const double gap = k < 0 ? -pow(10.0, -2.0 * (9 + k)) : k > 0 ? pow(10.0, -2.0 * (9 - k)) : 0.0;
        const fl_contact c =
            contact_of(box(2, 2, 2), v3(0.5, 0, 2.0 + gap), straight, box(2, 2, 2), FL_MODE_NONE);
        assert_int_equal(c.mode, FL_FF);
        assert_near_of(c.d, gap, 1e-15, 2.0);
        assert_near(c.n.z, 1.0, 1e-15);
        assert_near(c.area, 3.0, 1e-13);
        assert_near(c.p.x, 0.25, 1e-13);
        assert_int_equal(c.overlap, gap <= 0.0 || (gap < 1e-14 && c.overlap));
    }
}

/* Two quadrilaterals that share corners, sides or nothing, at any angle: the sweep takes no decision by a
 * sign alone. */
static void outlines_overlap(void **state)
{
    (void)state;
    static const int32_t loop[4] = {0, 1, 2, 3}, other[4] = {3, 2, 1, 0};
    for (int k = 0; k < 360; k++) {
        const fl_mat3 r = rotation_of(v3(0, 0, 0.0174532925 * k));
        const struct {
            double x, y, w, h, area, cx, cy;
        } expected[] = {
            {0, 0, 1, 1, 1, .5, .5},    {1, 0, 1, 1, 0, 0, 0},           {1, 1, 1, 1, 0, 0, 0},
            {.5, 0, 1, 1, .5, .75, .5}, {.25, .25, .5, .5, .25, .5, .5}, {.5, .5, 3, 3, .25, .75, .75},
            {-1, -1, 3, 3, 1, .5, .5},  {0, 0, .5, 2, .5, .25, .5},      {5, 5, 1, 1, 0, 0, 0}};
        for (size_t c = 0; c < sizeof expected / sizeof *expected; c++) {
            fl_vec3 a[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, b[4];
            for (int i = 0; i < 4; i++) {
                b[i] = m3_mul(r, v3(expected[c].x + expected[c].w * a[i].x,
                                    expected[c].y + expected[c].h * a[i].y, 7.0));
                a[i] = m3_mul(r, a[i]);
            }
            const fl_plane_axes t = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
            const fl_projected_overlap o = fl_overlap_area(&t, (fl_loop){a, loop, 4}, (fl_loop){b, other, 4});
            assert_near_of(o.size, expected[c].area, 4e-15, 1.0);
            if (expected[c].area > 0.0) {
                const fl_vec3 m = m3_mul(r, v3(expected[c].cx, expected[c].cy, 0));
                assert_near_of(o.x, m.x, 1e-14, 1.0);
                assert_near_of(o.y, m.y, 1e-14, 1.0);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(faces_share_an_area),
                                       cmocka_unit_test(edges_lie_on_faces),
                                       cmocka_unit_test(parallel_edges_share_a_length),
                                       cmocka_unit_test(points_have_no_extent),
                                       cmocka_unit_test(modes_change_with_hysteresis),
                                       cmocka_unit_test(depth_continues_where_distance_ends),
                                       cmocka_unit_test(outlines_overlap)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
