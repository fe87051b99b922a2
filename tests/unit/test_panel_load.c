/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Panels and events add up to the load of their part, for every position and contact law. */
#include "support/near.h"
#include <math.h>
#include <stdio.h>
#include "contact/panel_load.h"
#include "support/small_world.h"
#include "support/scenes.h"

static const fl_vec3 ZERO = {0, 0, 0};

static fl_vec3 panel_impulse(const fl_world *w, int32_t part)
{
    fl_vec3 sum = ZERO;
    for (int32_t k = w->panel_load.first[part]; k < w->panel_load.first[part + 1]; k++)
        sum = v3_add(sum, w->panel_load.impulse[k]);
    return sum;
}

static fl_vec3 event_impulse(const fl_world *w, int32_t part)
{
    fl_vec3 sum = ZERO;
    for (int32_t k = 0; k < w->panel_load.events; k++)
        if (w->panel_load.event[k].part == part) sum = v3_add(sum, w->panel_load.event[k].impulse);
    return sum;
}

static void panel_sums_are_the_part_load(void **state)
{
    static const char *const LAW[] = {"patch", "core", "manual", "manual-si"};
    (void)state;
    for (int law = 0; law < 4; law++) {
        lab l;
        double largest = 0.0;
        scene_of_everything(&l, 3, LAW[law]);
        lab_set(&l, "output.panels=panels");
        lab_set(&l, "output.events=events");
        lab_make(&l, 0);
        assert_int_equal(lab_run(&l, 200), 0);
        for (int32_t p = 0; p < l.w.parts; p++) largest = fmax(largest, v3_norm(l.w.part_impulse[p]));
        assert_true(largest > 0.0);
        for (int32_t p = 0; p < l.w.parts; p++) {
            const fl_vec3 load = l.w.part_impulse[p];
            assert_near_of(v3_norm(v3_sub(panel_impulse(&l.w, p), load)), 0.0, 1e-12, largest);
            assert_near_of(v3_norm(v3_sub(event_impulse(&l.w, p), load)), 0.0, 1e-12, largest);
        }
        fl_panels_end_interval(&l.w);
        fl_events_end_interval(&l.w);
        assert_near(v3_norm(panel_impulse(&l.w, 0)), 0.0, 0);
        assert_int_equal(l.w.panel_load.events, 0);
        lab_free(&l);
    }
}

/* A sphere on a face of 2 n^2 triangles loads the triangle below it, also after the face has moved. */
static void the_nearest_triangle_takes_the_load(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        enum { N = 5 };
        lab l;
        lab_start(&l);
        lab_sphere(&l, v3(0.37, 0.81, 0.09), 0.1, ZERO, ZERO);
        lab_wall(&l, v3(-3, -3, -2), v3(2, 2, 0), N);
        if (kind == 2) l.surface.part[0].nt -= 1; /* no longer closed: a shell */
        lab_set(&l, "output.panels=panels");
        if (kind == 1) lab_set(&l, "structure.velocity=1 0 0");
        lab_make(&l, 1e-4);
        assert_int_equal(lab_run(&l, kind == 1 ? 10 : 1), 0);
        int32_t loaded = -1, count = 0;
        for (int32_t k = 0; k < l.w.panel_load.panels; k++)
            if (v3_norm(l.w.panel_load.impulse[k]) > 0.0) loaded = k, count++;
        assert_int_equal(count, 1);
        const fl_load_panel *p = &l.w.panel_load.panel[loaded];
        assert_near(p->area, 0.5, 1e-14);
        for (int c = 0; c < 3; c++) { /* the cell from (0, 0) to (1, 1), its upper half */
            const fl_vec3 v = l.w.panel_load.triangle[loaded].v[c];
            assert_true(v.x > -1e-9 && v.x < 1 + 1e-9 && v.y > -1e-9 && v.y < 1 + 1e-9);
            assert_near(v.z, 0, 0);
        }
        assert_true(p->centroid.y > p->centroid.x);
        assert_near(v3_norm(v3_sub(l.w.panel_load.impulse[loaded], l.w.part_impulse[0])), 0.0, 0);
        lab_free(&l);
    }
}

/* A face that lies flat on many triangles loads all triangles under it, and no other. */
static void a_face_is_spread_over_triangles(void **state)
{
    enum { N = 20 };
    lab l;
    double mean = 0.0, under = 0.0, smallest = INFINITY, largest = 0.0;
    fl_vec3 middle = ZERO;
    (void)state;
    lab_start(&l);
    lab_box(&l, v3(0.1, -0.05, 0.299), v3(0.91, 0.61, 0.3), 0.01, q_one(), ZERO, ZERO);
    lab_wall(&l, v3(-2, -2, -2), v3(2, 2, 0), N); /* triangles of 0.2 m, the face from -0.8, -0.65 on */
    lab_set(&l, "output.panels=panels");
    lab_make(&l, 1e-5);
    assert_int_equal(lab_run(&l, 1), 0);
    for (int32_t k = 0; k < l.w.panel_load.panels; k++) {
        const fl_load_panel *p = &l.w.panel_load.panel[k];
        const double pressure = l.w.panel_load.impulse[k].z / p->area;
        mean += l.w.panel_load.impulse[k].z;
        middle = v3_madd(middle, l.w.panel_load.impulse[k].z, p->centroid);
        const double dx = fabs(p->centroid.x - 0.1), dy = fabs(p->centroid.y + 0.05);
        if (p->centroid.z < 0.0 || dx > 0.9 + 0.3 || dy > 0.6 + 0.3) assert_near(pressure, 0, 0);
        else if (dx < 0.9 - 0.3 && dy < 0.6 - 0.3) {
            under += p->area;
            smallest = fmin(smallest, -pressure);
            largest = fmax(largest, -pressure);
        }
    }
    assert_true(under > 0.5);
    assert_near(smallest, largest, 1e-9); /* uniform */
    assert_near(mean, l.w.part_impulse[0].z, 1e-12);
    assert_near_of(middle.x / mean, 0.1, 0.02, 1.0);
    assert_near_of(middle.y / mean, -0.05, 0.02, 1.0);
    lab_free(&l);
}

/* A flat contact has the area of its face; a cone is one panel. */
static void an_event_has_its_area(void **state)
{
    lab l;
    (void)state;
    lab_start(&l);
    lab_box(&l, v3(0, 0, 0.299), v3(0.6, 0.4, 0.3), 0.01, q_one(), ZERO, ZERO);
    lab_sphere(&l, v3(4.46, 0, 0), 0.1, ZERO, ZERO);
    lab_wall(&l, v3(-3, -3, -2), v3(3, 3, 0), 3);
    lab_cone(&l, (fl_cone){v3(4, 0, -1), v3(4, 0, 1), 0.5, 0.25});
    lab_set(&l, "output.events=events");
    lab_make(&l, 1e-5);
    assert_int_equal(lab_run(&l, 1), 0);
    assert_int_equal(l.w.panel_load.events, 2);
    const fl_load_event *e = &l.w.panel_load.event[0];
    assert_int_equal(e->id, 1);
    assert_int_equal(e->part, 0);
    assert_near(e->impulse_area / e->impulse_sum, 1.18 * 0.78, 0.1);
    assert_near_of(e->impulse_point.x / e->impulse_sum, 0.0, 1e-9, 1.0);
    assert_near(e->max_overlap, 1e-3, 2e-2);
    const fl_load_panel *cone = &l.w.panel_load.panel[l.w.panel_load.first[1]];
    assert_int_equal(l.w.panel_load.first[2] - l.w.panel_load.first[1], 1);
    assert_near(cone->area, 3.14159265358979 * (0.75 * sqrt(4 + 0.0625) + 0.25 + 0.0625), 1e-13);
    lab_free(&l);
}

/* A floe lies on a dome of triangles of 0.1 m. Each triangle is loaded at its position, so that panels
 * together have the moment of the load, to the size of a panel. */
static void a_dome_is_loaded_triangle_by_triangle(void **state)
{
    enum { N = 40 };
    (void)state;
    lab l;
    fl_err err = {0};
    lab_start(&l);
    lab_box(&l, v3(0.13, -0.05, 0.297), v3(1, 0.8, 0.3), 0.05, q_of_vector(v3(0.02, 0.01, 0)), ZERO, ZERO);
    assert_true(fl_surface_add(&l.surface, "dome", 4, &err) == 0);
    fl_part *part = &l.surface.part[0];
    for (int j = 0; j <= N; j++) {
        for (int i = 0; i <= N; i++) {
            const double x = 4.0 * i / N - 2.0 + 0.07 * j / N, y = 4.0 * j / N - 2.0;
            assert_int_equal(fl_surface_vertex(part, v3(x, y, -x * x / 16.0 - y * y / 10.0), &err), 0);
        }
    }
    for (int j = 0; j < N; j++) {
        for (int i = 0; i < N; i++) {
            const int32_t a = j * (N + 1) + i, b = a + 1, c = b + N + 1, d = a + N + 1;
            assert_int_equal(
                fl_surface_triangle(part, a, b, c, &err) || fl_surface_triangle(part, a, c, d, &err), 0);
        }
    }
    lab_set(&l, "output.panels=panels");
    lab_make(&l, 1e-6);
    assert_int_equal(lab_run(&l, 1), 0);
    fl_vec3 moment = ZERO;
    int loaded = 0;
    for (int32_t k = 0; k < l.w.panel_load.panels; k++) {
        moment = v3_add(moment, v3_cross(l.w.panel_load.panel[k].centroid, l.w.panel_load.impulse[k]));
        loaded += l.w.panel_load.impulse[k].z < 0.0;
    }
    const fl_vec3 load = l.w.part_impulse[0];
    assert_near_of(v3_norm(v3_sub(panel_impulse(&l.w, 0), load)), 0.0, 1e-12, v3_norm(load));
    assert_near_of(v3_norm(v3_sub(moment, l.w.part_moment[0])), 0.0, 0.01, v3_norm(load));
    assert_in_range(loaded, 20, 200);
    lab_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(panel_sums_are_the_part_load), cmocka_unit_test(the_nearest_triangle_takes_the_load),
        cmocka_unit_test(a_face_is_spread_over_triangles), cmocka_unit_test(an_event_has_its_area),
        cmocka_unit_test(a_dome_is_loaded_triangle_by_triangle)};
    return cmocka_run_group_tests_name("panel_load", tests, NULL, NULL);
}
