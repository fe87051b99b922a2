/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "geom/facet.h"
#include "geom/mesh_patch.h"
#include "geom/mirror_half.h"
#include "geom/raise_deck.h"
#include "geom/weld.h"

static fl_err err;
static const double PI_HERE = 3.14159265358979323846;

/* Walls of a prism of n sides about (x, y) from z = -depth to 0; inward ones face the axis. */
static void add_ring(fl_part *p, double x, double y, double radius, int n, double depth, int inward)
{
    const int32_t o = p->nv;
    for (int k = 0; k < 2 * n; k++) {
        const double t = 2.0 * PI_HERE * (k / 2 + 0.25) / n;
        fl_surface_vertex(p, v3(x + radius * cos(t), y + radius * sin(t), k % 2 ? 0.0 : -depth), &err);
    }
    for (int k = 0; k < n; k++) {
        const int32_t a = o + 2 * k, b = o + 2 * ((k + 1) % n);
        const int32_t out[4] = {a, b, b + 1, a + 1}, in[4] = {b, a, a + 1, b + 1};
        fl_facet_polygon(p, 4, inward ? in : out, &err);
    }
}

static double disc(double radius, int n) { return 0.5 * n * radius * radius * sin(2.0 * PI_HERE / n); }

/* A flat bottom at z = -depth is the deck of the same rings turned over: raised there by almost nothing. */
static fl_mesh_quality measure(fl_part *p)
{
    fl_mesh_quality q;
    fl_weld w;
    fl_orient_counts turned;
    assert_int_equal(fl_part_weld(p, -1.0, &w, &err), 0);
    assert_int_equal(fl_part_orient(p, &q, &turned, &err), 0);
    assert_int_equal(fl_part_measure(p, &q, &err), 0);
    return q;
}

static void close_bottom(fl_part *p, double depth)
{
    fl_deck_counts did;
    for (int32_t v = 0; v < p->nv; v++) p->v[v] = v3(p->v[v].x, -p->v[v].y, -p->v[v].z + 0.5);
    assert_int_equal(fl_part_raise_deck(p, depth, &did, &err), 0);
    for (int32_t v = 0; v < p->nv; v++) p->v[v] = v3(p->v[v].x, -p->v[v].y, -p->v[v].z + 0.5);
}

static void a_hull_gets_walls_and_a_deck(void **state)
{
    (void)state;
    fl_part p = {0};
    fl_deck_counts did;
    add_ring(&p, 3, 1, 2.0, 7, 1.5, 0);
    close_bottom(&p, 0.5);
    fl_mesh_quality q = measure(&p);
    assert_int_equal(q.open, 7);
    assert_int_equal(fl_part_raise_deck(&p, 0.75, &did, &err), 0);
    assert_int_equal(did.rims, 1);
    assert_int_equal(did.edges, 7);
    assert_int_equal(did.chains, 0);
    q = measure(&p);
    assert_true(q.closed && q.open == 0);
    assert_true(fabs(q.volume - disc(2.0, 7) * (1.5 + 0.5 + 0.75)) < 1e-12 * q.volume);
    fl_part_free(&p);
}

/* A barge with a moonpool, four wells for legs, and a column that stands in the moonpool. */
static void rims_in_rims_are_holes_and_decks_in_them(void **state)
{
    (void)state;
    fl_part p = {0};
    fl_deck_counts did;
    add_ring(&p, 0, 0, 20.0, 31, 2.0, 0);
    add_ring(&p, 0, 0, 6.0, 16, 2.0, 1);
    add_ring(&p, 0, 0, 2.0, 9, 2.0, 0);
    for (int k = 0; k < 4; k++) add_ring(&p, k % 2 ? 11 : -11, k / 2 ? 5 : -5, 2.0, 12, 2.0, 1);
    close_bottom(&p, 1.0);
    fl_mesh_quality q = measure(&p);
    assert_int_equal(q.open, 31 + 16 + 9 + 48);
    assert_int_equal(fl_part_raise_deck(&p, 3.0, &did, &err), 0);
    assert_int_equal(did.rims, 7);
    assert_int_equal(did.holes, 5);
    q = measure(&p);
    const double area = disc(20.0, 31) - disc(6.0, 16) + disc(2.0, 9) - 4.0 * disc(2.0, 12);
    assert_true(q.closed && q.open == 0 && q.branched == 0 && q.incoherent == 0);
    assert_true(fabs(q.volume - area * 6.0) < 1e-11 * q.volume);
    fl_part_free(&p);
}

/* A lid of the waterline is left out; without an open rim nothing changes. */
static void lids_are_left_out(void **state)
{
    (void)state;
    fl_part p = {0}, high = {0};
    fl_deck_counts did;
    fl_facet_box(&p, v3(-1, -1, -1), v3(1, 1, 0), &err);
    fl_facet_box(&high, v3(-1, -1, -1), v3(1, 1, 2), &err);
    assert_int_equal(fl_part_raise_deck(&p, 0.5, &did, &err), 0);
    assert_int_equal(did.lids, 2);
    fl_mesh_quality q = measure(&p);
    assert_true(q.closed && fabs(q.volume - 6.0) < 1e-14);
    assert_int_equal(fl_part_raise_deck(&high, 0.5, &did, &err), 0);
    assert_int_equal(did.rims, 0);
    assert_int_equal(high.nt, 12);
    /* a rim that is broken off stays */
    fl_part_free(&p);
    fl_facet_box(&p, v3(-1, -1, -1), v3(1, 1, 0), &err);
    int32_t kept = 0; /* without the side x = 1 */
    for (int32_t t = 0; t < p.nt; t++)
        if (p.v[p.t[t].v[0]].x + p.v[p.t[t].v[1]].x + p.v[p.t[t].v[2]].x < 2.5) p.t[kept++] = p.t[t];
    p.nt = kept;
    assert_int_equal(fl_part_raise_deck(&p, 0.5, &did, &err), 0);
    assert_int_equal(did.rims, 0);
    assert_true(did.chains > 0);
    fl_part_free(&p);
    fl_part_free(&high);
}

static void halves_are_mirrored(void **state)
{
    (void)state;
    fl_part p = {0};
    int32_t crosses;
    fl_facet_box(&p, v3(0, -1, -1), v3(2, 1, 1), &err);
    fl_surface_cone(&p, (fl_cone){v3(1, 0, 0), v3(1, 0, 5), 1, 2}, &err);
    fl_surface_cone(&p, (fl_cone){v3(0, 0, 0), v3(0, 0, 5), 1, 2}, &err);
    assert_int_equal(fl_part_mirror_half(&p, 0, 1e-9, &crosses, &err), 0);
    assert_int_equal(crosses, -1);
    assert_int_equal(p.nt, 22); /* two triangles in the plane have no twin */
    assert_int_equal(p.nc, 3);
    assert_true(p.cone[2].p0.x == -1.0 && p.cone[2].r1 == 2.0);
    const fl_mesh_quality q = measure(&p);
    assert_true(q.box.lo.x == -2.0 || q.box.lo.x < -2.0);
    assert_int_equal(fl_part_mirror_half(&p, 0, 1e-9, &crosses, &err), 0);
    assert_true(crosses >= 0); /* both halves are there */
    assert_int_equal(p.nt, 22);
    assert_int_equal(fl_part_mirror_half(&p, 1, 1e-9, &crosses, &err), 0);
    assert_true(crosses >= 0);
    fl_part_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hull_gets_walls_and_a_deck),
        cmocka_unit_test(rims_in_rims_are_holes_and_decks_in_them),
        cmocka_unit_test(lids_are_left_out),
        cmocka_unit_test(halves_are_mirrored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
