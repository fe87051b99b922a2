/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "support/near.h"
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "ice/domain.h"
#include "ice/domain_read.h"
#include "ice/faces.h"
#include "ice/waterplane_cut.h"
#include "mesh/gstruct.h"

/* A star of n corners about c, with random radii between a and b. */
static void make_star(fl_domain *d, fl_rng *g, int32_t n, fl_vec2 c, double a, double b)
{
    fl_vec2 v[64];
    fl_err err = {0};
    for (int32_t k = 0; k < n; k++) {
        const double r = fl_rng_in(g, a, b), t = 2.0 * PI * k / n;
        v[k] = (fl_vec2){c.x + r * cos(t), c.y + r * sin(t)};
    }
    assert_int_equal(fl_domain_add(d, n, v, &err), 0);
}

static double ring_area(const fl_domain *d, int32_t r)
{
    return fl_polygon_area(d->first[r + 1] - d->first[r], d->v + d->first[r]);
}

static void cut_cells(fl_pieces *p, const fl_domain *d, int32_t n, uint64_t seed, double min_share)
{
    fl_vec2 site[300];
    fl_power_cells c = {0};
    fl_err err = {0};
    assert_true(n <= 300);
    assert_int_equal(fl_domain_sites(n, seed, d, site, &err), 0);
    assert_int_equal(fl_power_cells_build(&c, n, site, (fl_vec2){d->lo.x - 1, d->lo.y - 1},
                                          (fl_vec2){d->hi.x + 1, d->hi.y + 1}, &err),
                     0);
    assert_int_equal(fl_domain_cut(p, &c, d, min_share, &err), 0);
    fl_power_cells_free(&c);
}

/* Stars with star-shaped islands inside. The pieces have the area of the outline less the islands, are
 * convex, do not overlap, and have their centroids inside. */
static void pieces_fill_the_water_and_no_more(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 60; seed++) {
        fl_rng g = fl_rng_of(test_seed(), (int64_t)seed, FL_RNG_TEST);
        const int32_t islands = (int32_t)(seed % 4), n = 1 + (int32_t)(seed * 5 % 150);
        fl_domain d = {0};
        fl_pieces p = {0};
        fl_faces f = {0};
        fl_err err = {0};
        double expected, sum = 0.0;
        make_star(&d, &g, 3 + (int32_t)(seed % 30), (fl_vec2){0, 0}, 10.0, 14.0);
        for (int32_t k = 0; k < islands; k++)
            make_star(&d, &g, 3 + k, (fl_vec2){2.0 * cos(2.1 * k), 2.0 * sin(2.1 * k)}, 0.3, 1.2);
        expected = ring_area(&d, 0);
        assert_true(expected > 0.0);
        for (int32_t k = 0; k < islands; k++) expected += ring_area(&d, 1 + k); /* clockwise: negative */
        assert_int_equal(fl_domain_build(&d, &err), 0);
        cut_cells(&p, &d, n, seed, 0.0);
        assert_near(p.area, expected, 1e-11);
        assert_true(p.dropped_area == 0.0 && p.dropped == 0);
        for (int32_t i = 0; i < p.cells.n; i++) {
            const int32_t m = p.cells.first[i + 1] - p.cells.first[i];
            const fl_vec2 *v = p.cells.v + p.cells.first[i];
            sum += fl_polygon_area(m, v);
            assert_int_equal(fl_domain_contains(&d, fl_polygon_centroid(m, v), &err), 1);
            for (int32_t k = 0; k < m; k++) {
                const fl_vec2 a = v[k], b = v[(k + 1) % m], c = v[(k + 2) % m];
                assert_true((b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) > -1e-9);
            }
            if (i > 0 && i < p.largest) assert_true(p.parent[i] > p.parent[i - 1]);
        }
        assert_near(sum, expected, 1e-11);
        {
            const fl_floes as = {.n = p.cells.n, .first = p.cells.first, .outer = p.cells.v};
            assert_int_equal(fl_faces_find(&f, &as, &err), 0);
            assert_true(f.max_overlap <= f.tolerance);
        }
        fl_faces_free(&f);
        fl_pieces_free(&p);
        fl_domain_free(&d);
    }
}

static void slivers_are_reported(void **state)
{
    (void)state;
    const fl_vec2 box[4] = {{0, 0}, {0, 5}, {10, 5}, {10, 0}}, strip[4] = {{4, -1}, {6, -1}, {6, 6}, {4, 6}};
    fl_domain d = {0};
    fl_pieces all = {0}, some = {0};
    fl_err err = {0};
    assert_int_equal(fl_domain_add(&d, 4, box, &err), 0);
    assert_int_equal(fl_domain_add(&d, 4, strip, &err), 0);
    assert_int_equal(fl_domain_build(&d, &err), 0);
    assert_int_equal(fl_domain_is_convex(&d), 0);
    cut_cells(&all, &d, 100, 1, 0.0);
    cut_cells(&some, &d, 100, 1, 0.2);
    assert_near(all.area, 40.0, 1e-13);
    assert_near(some.area, 40.0, 1e-13);
    assert_true(some.dropped > 0 && some.dropped_area > 0.0);
    assert_int_equal(some.cells.n + some.dropped, all.cells.n);
    fl_pieces_free(&all);
    fl_pieces_free(&some);
    fl_domain_free(&d);
    assert_int_equal(fl_domain_add(&d, 4, box, &err), 0);
    assert_int_equal(fl_domain_is_convex(&d), 1);
    fl_domain_free(&d);
}

static void islands_may_overlap(void **state)
{
    (void)state;
    const fl_vec2 box[4] = {{0, 0}, {10, 0}, {10, 10}, {0, 10}}, a[4] = {{2, 2}, {6, 2}, {6, 6}, {2, 6}},
                  b[4] = {{4, 4}, {4, 8}, {8, 8}, {8, 4}}, over[4] = {{9, 9}, {12, 9}, {12, 12}, {9, 12}};
    fl_domain d = {0};
    fl_pieces p = {0};
    fl_err err = {0};
    assert_int_equal(fl_domain_add(&d, 4, box, &err) | fl_domain_add(&d, 4, a, &err) |
                         fl_domain_add(&d, 4, b, &err) | fl_domain_add(&d, 4, over, &err) |
                         fl_domain_build(&d, &err),
                     0);
    cut_cells(&p, &d, 40, 3, 0.0);
    assert_near(p.area, 100.0 - 28.0 - 1.0, 1e-13);
    assert_int_equal(fl_domain_contains(&d, (fl_vec2){5, 5}, &err), 0);
    assert_int_equal(fl_domain_contains(&d, (fl_vec2){1, 1}, &err), 1);
    assert_int_equal(fl_domain_contains(&d, (fl_vec2){-1, 1}, &err), 0);
    assert_int_equal(fl_domain_contains(&d, (fl_vec2){11, 11}, &err), 0);
    fl_pieces_free(&p);
    fl_domain_free(&d);
}

static void invalid_rings_are_reported(void **state)
{
    (void)state;
    const fl_vec2 cross[4] = {{0, 0}, {1, 1}, {1, 0}, {0, 1}}, thin[3] = {{0, 0}, {1, 0}, {1e-6, 1e-6}},
                  hole[4] = {{-1, -1}, {2, -1}, {2, 2}, {-1, 2}};
    fl_domain d = {0};
    fl_vec2 site;
    fl_err err = {0};
    assert_int_equal(fl_domain_add(&d, 2, cross, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    err = (fl_err){0};
    assert_int_equal(fl_domain_add(&d, 4, cross, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_int_equal(d.rings, 0);
    err = (fl_err){0};
    assert_int_equal(
        fl_domain_add(&d, 3, thin, &err) | fl_domain_add(&d, 4, hole, &err) | fl_domain_build(&d, &err), 0);
    assert_int_equal(fl_domain_sites(1, 1, &d, &site, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    fl_domain_free(&d);
}

/* The section that a structure takes between two levels: a cube in two meshes, a cone, and one beyond the
 * levels. */
static void structures_are_cut_out(void **state)
{
    (void)state;
    static const char text[] =
        "#g_struct 1\npart 0 a\ncone 3 3 -10 2  3 3 10 1\n"
        "cone -5 0 1 1  -5 0 2 1\npart 1 b\nv -5 -5 -1\nv -3 -5 -1\nv -3 -3 -1\nv -4 -4 3\n"
        "t 0 2 1\nt 0 1 3\nt 1 2 3\nt 2 0 3\n";
    const fl_vec2 box[4] = {{-10, -10}, {10, -10}, {10, 10}, {-10, 10}};
    fl_domain d = {0};
    fl_surface s = {0};
    fl_err err = {0};
    int32_t kept = 0;
    double far = 0.0;
    assert_int_equal(fl_gstruct_read(&s, test_file("s.dat", text, sizeof text - 1), &err), 0);
    assert_int_equal(fl_domain_add(&d, 4, box, &err), 0);
    assert_int_equal(fl_waterplane_keep_out(&d, &s, -0.5, 0.5, 0.25, 0.01, &kept, &err), 0);
    assert_int_equal(kept, 2);
    assert_int_equal(d.rings, 3);
    /* the cone is widest at the lower level: 1.525 there, and the polygon is larger by 0.01 and rounding */
    for (int32_t k = d.first[1]; k < d.first[2]; k++) far = fmax(far, hypot(d.v[k].x - 3.0, d.v[k].y - 3.0));
    assert_true(far >= 1.525 + 0.25 && far <= 1.525 + 0.25 + 0.011);
    assert_true(-ring_area(&d, 1) >= PI * 1.775 * 1.775);
    /* the tetrahedron at the lower level, z = -0.5: its base shrunk by an eighth towards the apex (-4, -4) */
    assert_int_equal(fl_domain_build(&d, &err), 0);
    assert_int_equal(fl_domain_contains(&d, (fl_vec2){-4.875 + 0.001, -4.875 + 0.0005}, &err), 0);
    assert_int_equal(fl_domain_contains(&d, (fl_vec2){-4.875 - 0.4, -4.875 - 0.4}, &err), 1);
    fl_domain_free(&d);
    fl_surface_free(&s);
}

/* A prism on the ring v[n], from z = -8 to 3; without lid and floor, which no level between crosses. */
static void make_prism(fl_surface *s, int32_t n, const fl_vec2 *v)
{
    fl_err err = {0};
    const int32_t at = fl_surface_add(s, "part", 4, &err);
    fl_part *p = &s->part[at];
    for (int32_t k = 0; k < 2 * n; k++)
        assert_int_equal(fl_surface_vertex(p, v3(v[k % n].x, v[k % n].y, k < n ? -8.0 : 3.0), &err), 0);
    for (int32_t k = 0; k < n; k++) {
        const int32_t next = (k + 1) % n;
        assert_int_equal(fl_surface_triangle(p, k, next, n + next, &err), 0);
        assert_int_equal(fl_surface_triangle(p, k, n + next, n + k, &err), 0);
    }
}

/* The water along the outline of a wharf in the form of an L stays open to ice, as does none within the
 * margin; a column of 64 sides has fewer, none inside of it; a part whose wall has a gap is surrounded. */
static void holes_follow_the_outline(void **state)
{
    (void)state;
    const fl_vec2 box[4] = {{-50, -50}, {50, -50}, {50, 50}, {-50, 50}};
    const fl_vec2 wharf[6] = {{-40, -20}, {20, -20}, {20, -5}, {-25, -5}, {-25, 25}, {-40, 25}};
    fl_vec2 column[64];
    fl_domain d = {0};
    fl_surface s = {0};
    fl_err err = {0};
    int32_t kept = 0;
    for (int32_t k = 0; k < 64; k++)
        column[k] = (fl_vec2){30.0 + 5.0 * cos(2.0 * PI * k / 64), 30.0 + 5.0 * sin(2.0 * PI * k / 64)};
    make_prism(&s, 6, wharf);
    make_prism(&s, 64, column);
    make_prism(&s, 6, wharf);
    s.part[2].nt--;
    assert_int_equal(fl_domain_add(&d, 4, box, &err), 0);
    assert_int_equal(fl_waterplane_keep_out(&d, &s, -0.9, 0.1, 0.5, 0.8, &kept, &err), 0);
    assert_int_equal(kept, 3);
    assert_int_equal(d.first[2] - d.first[1], 6);
    /* 60 x 15 and 15 x 30, and a margin of 0.5 along a perimeter of 210, with 5 corners outward and 1 inward
     * */
    assert_near(-ring_area(&d, 1), 60.0 * 15 + 15 * 30 + 0.5 * 210 + 4 * 0.25, 1e-12);
    assert_true(d.first[3] - d.first[2] <= 16);
    assert_true(-ring_area(&d, 2) >= PI * 5.5 * 5.5 && -ring_area(&d, 2) <= PI * 7.0 * 7.0);
    for (int32_t k = d.first[2]; k < d.first[3]; k++) {
        const fl_vec2 a = d.v[k], b = d.v[k + 1 < d.first[3] ? k + 1 : d.first[2]];
        const double l = hypot(b.x - a.x, b.y - a.y);
        assert_true(((a.x - 30.0) * (b.y - a.y) - (a.y - 30.0) * (b.x - a.x)) / l <= -5.5 + 0.01);
    }
    assert_true(-ring_area(&d, 3) > 60.0 * 45.0 - 0.5 * 45.0 * 30.0); /* no notch */
    fl_domain_free(&d);
    fl_surface_free(&s);
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    const fl_vec2 box[4] = {{0, 0}, {10, 0}, {10, 10}, {0, 10}}, a[4] = {{2, 2}, {6, 2}, {6, 6}, {2, 6}},
                  site[3] = {{1, 1}, {9, 8}, {3, 9}};
    int rc = -1;
    for (long k = 0; rc; k++) {
        fl_domain d = {0};
        fl_pieces p = {0};
        fl_power_cells c = {0};
        fl_err err = {0};
        assert_int_equal(fl_power_cells_build(&c, 3, site, (fl_vec2){-1, -1}, (fl_vec2){11, 11}, &err), 0);
        fl_alloc_fail_after(k);
        rc = fl_domain_add(&d, 4, box, &err) || fl_domain_add(&d, 4, a, &err) || fl_domain_build(&d, &err) ||
             fl_domain_cut(&p, &c, &d, 0.0, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
        fl_pieces_free(&p);
        fl_power_cells_free(&c);
        fl_domain_free(&d);
        assert_true(k < 1000);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pieces_fill_the_water_and_no_more),
                                       cmocka_unit_test(slivers_are_reported),
                                       cmocka_unit_test(islands_may_overlap),
                                       cmocka_unit_test(invalid_rings_are_reported),
                                       cmocka_unit_test(structures_are_cut_out),
                                       cmocka_unit_test(holes_follow_the_outline),
                                       cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
