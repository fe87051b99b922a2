/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/array.h"
#include "geom/facet.h"
#include "geom/raster.h"
#include "support/near.h"

static fl_err err;

static void triangle(fl_surface *s, fl_vec3 a, fl_vec3 b, fl_vec3 c)
{
    const int32_t i = fl_surface_add(s, "t", 1, &err);
    const fl_vec3 x[3] = {a, b, c};
    for (int k = 0; k < 3; k++) fl_surface_vertex(&s->part[i], x[k], &err);
    fl_surface_triangle(&s->part[i], 0, 1, 2, &err);
}

static int32_t part_at(const fl_raster *r, double u, double v)
{
    return r->part[(int64_t)((v - r->v0) / r->pixel) * r->w + (int64_t)((u - r->u0) / r->pixel)];
}

/* A box of 2 x 3 x 4 covers as many pixels as its face has, from each side, with the depth of that face. */
static void a_box_shows_its_faces(void **state)
{
    static const double size[3] = {2, 3, 4};
    fl_surface s = {0};
    (void)state;
    fl_surface_add(&s, "box", 3, &err);
    fl_facet_box(&s.part[0], v3(0, 0, 0), v3(2, 3, 4), &err);
    for (int toward = 0; toward < 3; toward++)
        for (int side = -1; side <= 1; side += 2) {
            const fl_view_axes axes = {(toward + 1) % 3, (toward + 2) % 3, toward, side};
            fl_raster r;
            int64_t seen = 0;
            assert_int_equal(fl_raster_start(&r, axes, 50, 60, -0.5, -0.5, 0.1, &err), 0);
            fl_raster_fill(&r, &s);
            for (int64_t k = 0; k < 50 * 60; k++) {
                seen += r.part[k] == 0;
                if (r.part[k] == 0) assert_near_of(r.depth[k], side > 0 ? size[toward] : 0.0, 1e-12, 4.0);
                else assert_true(r.depth[k] < 0.0 && isinf(r.depth[k]));
            }
            assert_int_equal(seen, lround(100 * size[axes.right] * size[axes.up]));
            assert_int_equal(fl_raster_lines(&r, &s, 25.0, &err), 0);
            assert_true(part_at(&r, 0.01, 1.05) == FL_RASTER_LINE ||
                        part_at(&r, -0.01, 1.05) == FL_RASTER_LINE);
            assert_int_equal(part_at(&r, 1.05, 1.05), 0); /* the diagonal of a face is no edge */
            fl_raster_free(&r);
            fl_raster_free(&r);
        }
    fl_surface_free(&s);
}

/* Three beams, each over the next: no drawing order is right, yet each pixel is. */
static void a_ring_of_beams_is_occluded_correctly(void **state)
{
    (void)state;
    for (int first = 0; first < 3; first++) {
        fl_surface s = {0};
        fl_raster r;
        for (int i = 0; i < 3; i++) { /* from its low start, over the next one's, at 120 degrees */
            const double a = 2.0943951023931953 * ((i + first) % 3), c = cos(a), n = sin(a);
            const fl_vec3 p[3] = {v3(-2, -1.2, -1), v3(2.5, -1.0, 1), v3(-2, -0.8, -1)};
            fl_vec3 q[3];
            for (int k = 0; k < 3; k++) q[k] = v3(c * p[k].x - n * p[k].y, n * p[k].x + c * p[k].y, p[k].z);
            triangle(&s, q[0], q[1], q[2]);
        }
        assert_int_equal(fl_raster_start(&r, (fl_view_axes){0, 1, 2, 1}, 600, 600, -3, -3, 0.01, &err), 0);
        fl_raster_fill(&r, &s);
        for (int i = 0; i < 3; i++) {
            const double a = 2.0943951023931953 * ((i + first) % 3), c = cos(a), n = sin(a);
            /* where the centre lines of two beams cross: the one near its high end is seen */
            const fl_vec3 x = v3(sqrt(3.0), -1.0, 0);
            assert_int_equal(part_at(&r, c * x.x - n * x.y, n * x.x + c * x.y), i);
        }
        fl_raster_free(&r);
        fl_surface_free(&s);
    }
}

static fl_vec3 plane_at(double x, double y) { return v3(x, y, 0.1 / 3 + 0.0731 * x + 0.0377 * y); }

/* Two faces in one plane that differ by rounding: the first one is seen everywhere. */
static void the_first_of_coincident_faces_is_seen(void **state)
{
    fl_surface s = {0};
    fl_raster r;
    int64_t seen[2] = {0};
    (void)state;
    triangle(&s, plane_at(-1.1, -0.9), plane_at(1.3, -0.7), plane_at(0.3, 1.7));
    for (int k = 0; k < 2; k++) {
        assert_int_equal(fl_raster_start(&r, (fl_view_axes){0, 1, 2, 1}, 400, 400, -2, -2, 0.01, &err), 0);
        fl_raster_fill(&r, &s);
        for (int i = 0; i < 400 * 400; i++) seen[k] += r.part[i] == 0;
        fl_raster_free(&r);
        triangle(&s, plane_at(-2.1, -2.7), plane_at(2.9, -1.3), plane_at(-0.2, 2.9));
    }
    assert_true(seen[0] > 10000);
    assert_int_equal(seen[1], seen[0]);
    fl_surface_free(&s);
}

/* Two faces that cross are both seen where they are in front; an edge behind a face is not drawn. */
static void hidden_parts_are_not_drawn(void **state)
{
    fl_surface s = {0};
    fl_raster r;
    (void)state;
    triangle(&s, v3(0, 0, 0), v3(4, 0, 1), v3(0, 4, 0));
    triangle(&s, v3(0, 0, 0.5), v3(4, 0, 0.5), v3(0, 4, 0.5));
    triangle(&s, v3(0.5, 0.5, -3), v3(1, 0.5, -3), v3(0.5, 1, -3));
    assert_int_equal(fl_raster_start(&r, (fl_view_axes){0, 1, 2, 1}, 100, 100, -0.5, -0.5, 0.05, &err), 0);
    fl_raster_fill(&r, &s);
    assert_int_equal(part_at(&r, 1.8, 1), 1); /* z = x / 4 crosses z = 1/2 at x = 2 */
    assert_int_equal(part_at(&r, 2.2, 1), 0);
    assert_int_equal(part_at(&r, 0.6, 0.6), 1);
    assert_int_equal(fl_raster_lines(&r, &s, 25.0, &err), 0);
    assert_int_equal(part_at(&r, 0.76, 0.74), 1); /* on the hidden one's longest side */
    assert_int_equal(part_at(&r, 0.01, 1), FL_RASTER_LINE);
    fl_raster_free(&r);
    fl_alloc_fail_after(1);
    assert_int_equal(fl_raster_start(&r, (fl_view_axes){0, 1, 2, 1}, 9, 9, 0, 0, 1, &err), -1);
    fl_alloc_fail_after(-1);
    fl_surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_first_of_coincident_faces_is_seen),
                                       cmocka_unit_test(a_box_shows_its_faces),
                                       cmocka_unit_test(a_ring_of_beams_is_occluded_correctly),
                                       cmocka_unit_test(hidden_parts_are_not_drawn)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
