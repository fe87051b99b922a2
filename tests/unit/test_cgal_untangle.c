/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Crossings, their repair, simplification and remeshing, and the distance by which the results are
 * checked. */
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "geom/enclosed_volume.h"
#include "geom/facet.h"
#include "geom/mesh_patch.h"
#include "geom/connected_parts.h"
#include "geom/weld.h"
#include "shim/cgal_crossing.h"
#include "shim/cgal_distance.h"
#include "shim/cgal_remesh.h"
#include "shim/cgal_simplify.h"
#include "shim/cgal_untangle.h"
#include "support/near.h"

static fl_err err;

static fl_soup soup_of(const fl_part *p)
{
    fl_soup s = {.nv = p->nv, .nt = p->nt};
    s.x = fl_alloc(3 * (int64_t)p->nv, sizeof *s.x, &err);
    s.t = fl_alloc(3 * (int64_t)p->nt, sizeof *s.t, &err);
    for (int32_t v = 0; v < p->nv; v++) memcpy(s.x + 3 * v, &p->v[v].x, 3 * sizeof *s.x);
    for (int32_t t = 0; t < p->nt; t++) memcpy(s.t + 3 * t, p->t[t].v, 3 * sizeof *s.t);
    return s;
}

static void set_part(fl_part *p, fl_soup *s)
{
    fl_weld w;
    p->nv = p->nt = 0;
    for (int32_t v = 0; v < s->nv; v++)
        fl_surface_vertex(p, v3(s->x[3 * v], s->x[3 * v + 1], s->x[3 * v + 2]), &err);
    for (int32_t t = 0; t < s->nt; t++)
        fl_surface_triangle(p, s->t[3 * t], s->t[3 * t + 1], s->t[3 * t + 2], &err);
    fl_soup_free(s);
    if (fl_part_weld(p, 0.0, &w, &err)) fail_msg("%s", err.text);
}

static int untangle(fl_soup *s, fl_untangle *did, fl_err *why)
{
    const fl_part p = {.nv = s->nv, .nt = s->nt, .v = (fl_vec3 *)s->x, .t = (fl_tri *)s->t};
    int32_t *shell = fl_alloc(p.nt, sizeof *shell, why), *group = fl_alloc(p.nt, sizeof *group, why);
    int32_t odd_edges;
    const int rc =
        fl_part_connected(&p, shell, &odd_edges, why) || fl_cgal_untangle(s, shell, group, did, why);
    free(shell);
    free(group);
    return rc ? -1 : 0;
}

static fl_mesh_quality measure_part(const fl_part *p)
{
    fl_mesh_quality q;
    assert_int_equal(fl_part_measure(p, &q, &err), 0);
    return q;
}

static fl_crossing count_crossings(const fl_part *p)
{
    fl_soup s = soup_of(p);
    fl_crossing c;
    if (fl_cgal_crossings(&s, &c, &err)) fail_msg("%s", err.text);
    fl_soup_free(&s);
    return c;
}

static fl_part triangle_part(fl_vec3 a, fl_vec3 b, fl_vec3 c)
{
    fl_part p = {0};
    fl_surface_vertex(&p, a, &err);
    fl_surface_vertex(&p, b, &err);
    fl_surface_vertex(&p, c, &err);
    fl_surface_triangle(&p, 0, 1, 2, &err);
    return p;
}

/* The triangle (0 0 0) (1 0 0) (0 1 0) and another one: crossings and touches. */
static void check_pair(fl_vec3 a, fl_vec3 b, fl_vec3 c, int crossings, int touching)
{
    static const int order[3][3] = {{0, 1, 2}, {2, 0, 1}, {1, 0, 2}};
    const fl_vec3 x[3] = {a, b, c};
    for (int k = 0; k < 3; k++) { /* for every order of corners and of triangles */
        fl_part p = triangle_part(v3(0, 0, 0), v3(1, 0, 0), v3(0, 1, 0));
        fl_crossing m;
        for (int i = 0; i < 3; i++) fl_surface_vertex(&p, x[order[k][i]], &err);
        fl_surface_triangle(&p, 3, 4, 5, &err);
        if (k) {
            const fl_tri keep = p.t[0];
            p.t[0] = p.t[1];
            p.t[1] = keep;
        }
        m = count_crossings(&p);
        assert_int_equal(m.crossings, crossings);
        assert_int_equal(m.touching, touching);
        fl_part_free(&p);
    }
}

static void every_kind_of_intersection_is_classified(void **state)
{
    (void)state;
    check_pair(v3(0, 0, 1), v3(1, 0, 1), v3(0, 1, 1), 0, 0);           /* apart */
    check_pair(v3(.2, .2, -1), v3(.2, .2, 1), v3(.4, .2, 1), 1, 0);    /* through the middle */
    check_pair(v3(.2, .2, 0), v3(.2, .2, 1), v3(.4, .2, 1), 0, 1);     /* a corner on the face */
    check_pair(v3(.1, .2, 0), v3(.3, .2, 0), v3(.2, .2, 1), 0, 1);     /* an edge on the face */
    check_pair(v3(.2, 0, 0), v3(.6, 0, 0), v3(.4, -1, 0), 0, 1);       /* a T-junction in one plane */
    check_pair(v3(.2, 0, 0), v3(.6, 0, 0), v3(.4, -1, 1), 0, 1);       /* and bent */
    check_pair(v3(1, 0, 0), v3(0, 1, 0), v3(1, 1, 0), 0, 0);           /* neighbours in one plane */
    check_pair(v3(1, 0, 0), v3(0, 1, 0), v3(.1, .1, 0), 1, 0);         /* folded on each other */
    check_pair(v3(1, 0, 0), v3(0, 1, 0), v3(0, 0, 1), 0, 0);           /* neighbours at an angle */
    check_pair(v3(0, 0, 0), v3(-1, 0, 0), v3(0, -1, 1), 0, 0);         /* a common corner */
    check_pair(v3(0, 0, 0), v3(1, 1, 1), v3(1, 1, -1), 1, 0);          /* a common corner, and crossing */
    check_pair(v3(0, 0, 0), v3(1, 0, 0), v3(0, 1, 0), 1, 0);           /* the same triangle */
    check_pair(v3(-.1, -.1, 0), v3(.5, -.1, 0), v3(-.1, .5, 0), 1, 0); /* covered in part */
    check_pair(v3(1, 1, 0), v3(2, 1, 0), v3(1, 2, 0), 0, 0);           /* apart in one plane */
    check_pair(v3(.25, .25, 0), v3(.5, .25, -1), v3(-1, .25, 2), 1,
               0);                                                 /* crossing, with a corner on the face */
    check_pair(v3(.5, -1, -1), v3(.5, -1, 1), v3(.5, 0, 0), 0, 1); /* a corner on an edge */
    check_pair(v3(.5, -1, -1), v3(.5, 1, 1), v3(2, 0, 0), 0, 1);   /* through an edge, along it */
    check_pair(v3(.5, -1, -1), v3(.5, 1, 1), v3(.4, 1, -1), 1, 0); /* through an edge, and into the face */
}

static void crossing_boxes_become_their_union(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) { /* second: a third body, which only the second one reaches */
        fl_part p = {0};
        fl_soup s;
        fl_untangle did;
        fl_mesh_quality q;
        fl_facet_box(&p, v3(0, 0, 0), v3(1, 1, 1), &err);
        fl_facet_box(&p, v3(.5, .25, .25), v3(2, .75, .75), &err);
        if (k) fl_facet_box(&p, v3(1.75, 0, 0), v3(3, 1, 1), &err);
        s = soup_of(&p);
        if (untangle(&s, &did, &err)) fail_msg("%s", err.text);
        set_part(&p, &s);
        q = measure_part(&p);
        assert_int_equal(did.joined, 1 + k);
        assert_int_equal(did.failed + did.rebuilt, 0);
        assert_int_equal(q.open + q.branched + q.incoherent, 0);
        assert_int_equal(q.patches, 1);
        assert_near(q.volume, k ? 1.0 + .1875 + 1.25 : 1.25, 1e-14);
        assert_int_equal(count_crossings(&p).crossings, 0);
        fl_part_free(&p);
    }
}

/* A two-sided plate on an edge of a box encloses nothing: plate and box stay unchanged. */
static void a_two_sided_plate_encloses_nothing(void **state)
{
    (void)state;
    fl_part p = {0};
    fl_weld w;
    fl_soup s;
    fl_untangle did;
    fl_facet_box(&p, v3(0, 0, 0), v3(1, 1, 1), &err);
    const int32_t a = p.nv;
    fl_surface_vertex(&p, v3(1, 0, 0), &err);
    fl_surface_vertex(&p, v3(1, 0, 1), &err);
    fl_surface_vertex(&p, v3(2, .5, 0), &err);
    fl_surface_triangle(&p, a, a + 1, a + 2, &err);
    fl_surface_triangle(&p, a, a + 2, a + 1, &err);
    assert_int_equal(fl_part_weld(&p, 0.0, &w, &err), 0);
    s = soup_of(&p);
    if (untangle(&s, &did, &err)) fail_msg("%s", err.text);
    assert_int_equal(did.joined + did.rebuilt, 0);
    assert_int_equal(s.nt, 14);
    fl_soup_free(&s);
    fl_part_free(&p);
}

/* A leg of sixteen sides and braces of eight, all through one point of its axis. Their ends share corners and
 * edges, and many corners lie within rounding of others' faces. The leg hides the inner end of each
 * brace, so the volume shows that all of them were joined. */
static void joints_of_tubes_become_one(void **state)
{
    (void)state;
    for (int braces = 2; braces < 7; braces++) {
        fl_part p = {0};
        fl_soup s;
        fl_weld w;
        fl_untangle did;
        fl_mesh_quality q, leg;
        fl_facet_cone(&p, &(fl_cone){v3(0, 0, -3), v3(0, 0, 3), .5, .5}, 16, &err);
        leg = measure_part(&p);
        for (int k = 0; k < braces; k++) {
            const double a = PI * (k % 4) / 2, z = k < 4 ? 2 : -2;
            fl_facet_cone(&p, &(fl_cone){v3(0, 0, 0), v3(3 * cos(a), 3 * sin(a), z), .3, .3}, 16, &err);
        }
        assert_int_equal(fl_part_weld(&p, 1e-9, &w, &err), 0);
        s = soup_of(&p);
        if (untangle(&s, &did, &err)) fail_msg("%s", err.text);
        set_part(&p, &s);
        q = measure_part(&p);
        assert_int_equal(did.joined, braces);
        assert_int_equal(did.failed + did.rebuilt, 0);
        assert_int_equal(q.open + q.branched + q.incoherent + q.degenerate, 0);
        assert_int_equal(q.patches, 1);
        assert_int_equal(count_crossings(&p).crossings, 0);
        assert_true(q.volume > leg.volume + braces * 0.8 && q.volume < leg.volume + braces * 0.95);
        fl_part_free(&p);
    }
}

/* A roof whose ridge was pushed through its floor. */
static void a_self_intersecting_patch_is_rebuilt(void **state)
{
    fl_part p = {0};
    fl_soup s;
    fl_untangle did;
    fl_mesh_quality q;
    (void)state;
    fl_facet_cone(&p, &(fl_cone){v3(0, 0, 0), v3(0, 0, 4), 1.0, 1.0}, 24, &err);
    fl_surface_vertex(&p, v3(0, 0, 0), &err);
    p.v[24] = v3(-1.5, 0.05, 2); /* a corner of the top goes through the opposite side */
    assert_true(count_crossings(&p).crossings > 0);
    s = soup_of(&p);
    if (untangle(&s, &did, &err)) fail_msg("%s", err.text);
    set_part(&p, &s);
    q = measure_part(&p);
    assert_int_equal(did.rebuilt, 1);
    assert_int_equal(count_crossings(&p).crossings, 0);
    assert_int_equal(q.open + q.branched, 0);
    assert_true(q.volume > 6.0 && q.volume < 4.0 * 3.1415926536);
    fl_part_free(&p);
}

static void distance_of(const fl_part *a, const fl_part *b, double *lower, double *upper)
{
    fl_soup s = soup_of(a), t = soup_of(b);
    if (fl_cgal_distance(&s, &t, 1e-9, lower, upper, &err)) fail_msg("%s", err.text);
    fl_soup_free(&s);
    fl_soup_free(&t);
}

static void distances_have_lower_and_upper_bounds(void **state)
{
    fl_part a = triangle_part(v3(0, 0, 0), v3(4, 0, 0), v3(0, 4, 0)), b = {0}, c = {0};
    double lower, upper;
    (void)state;
    /* the same plane in other triangles: 0 to rounding in both directions */
    for (int i = 0; i < 7; i++)
        for (int j = 0; j < 7; j++) {
            const double h = 4.0 / 7.0, x = h * i, y = h * j;
            if (i + j < 7) {
                fl_part t = triangle_part(v3(x, y, 0), v3(x + h, y, 0), v3(x, y + h, 0));
                for (int k = 0; k < 3; k++) fl_surface_vertex(&b, t.v[k], &err);
                fl_surface_triangle(&b, b.nv - 3, b.nv - 2, b.nv - 1, &err);
                fl_part_free(&t);
            }
            if (i + j < 6) {
                fl_surface_vertex(&b, v3(x + h, y, 0), &err);
                fl_surface_vertex(&b, v3(x + h, y + h, 0), &err);
                fl_surface_vertex(&b, v3(x, y + h, 0), &err);
                fl_surface_triangle(&b, b.nv - 3, b.nv - 2, b.nv - 1, &err);
            }
        }
    distance_of(&a, &b, &lower, &upper);
    assert_true(upper < 1e-8);
    distance_of(&b, &a, &lower, &upper);
    assert_true(upper < 1e-12);
    /* one corner lifted by 0.25, another moved out by 3: found to a hundredth */
    a.v[0].z = 0.25;
    distance_of(&a, &b, &lower, &upper);
    assert_true(lower <= 0.25 + 1e-12 && upper >= 0.25 && upper <= 0.2526);
    a.v[0].z = 0.0;
    a.v[1].x = 7.0;
    distance_of(&a, &b, &lower, &upper);
    assert_true(lower <= 3.0 + 1e-12 && upper >= 3.0 && upper <= 3.031);
    distance_of(&b, &a, &lower, &upper);
    assert_true(upper < 1e-8);
    /* the centre of a square is farthest from its boundary: the largest distance is not at a corner */
    fl_facet_box(&c, v3(0, 0, 0), v3(2, 2, 2), &err);
    a.nt = a.nv = 0;
    for (int k = 0; k < 4; k++) fl_surface_vertex(&a, v3(k & 1 ? 2 : 0, k & 2 ? 2 : 0, 1), &err);
    fl_surface_triangle(&a, 0, 1, 3, &err);
    fl_surface_triangle(&a, 0, 3, 2, &err);
    distance_of(&a, &c, &lower, &upper);
    assert_true(lower <= 1.0 + 1e-12 && upper >= 1.0 && upper <= 1.011);
    /* a strip along the axis of a tube is equally far from many long triangles, which cuts along them reduce
     * only slowly */
    a.nt = a.nv = c.nt = c.nv = 0;
    for (int k = 0; k < 4; k++) fl_surface_vertex(&a, v3(k & 1 ? 0.01 : -0.01, 0, k & 2 ? 9 : 1), &err);
    fl_surface_triangle(&a, 0, 1, 3, &err);
    fl_surface_triangle(&a, 0, 3, 2, &err);
    fl_facet_cone(&c, &(fl_cone){v3(0, 0, 0), v3(0, 0, 10), 0.5, 0.5}, 360, &err);
    distance_of(&a, &c, &lower, &upper);
    assert_true(upper >= lower && upper <= 1.02 * lower && fabs(lower - 0.5) < 1e-3);
    fl_part_free(&a);
    fl_part_free(&b);
    fl_part_free(&c);
}

static void simplification_stays_within_the_distance(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        const double within = k ? 0.1 : 0.02;
        fl_part p = {0}, q = {0};
        fl_soup s, t;
        int32_t gone;
        double lower, upper;
        fl_facet_cone(&p, &(fl_cone){v3(0, 0, 0), v3(0, 0, 3), 1.0, 1.0}, 60, &err);
        s = soup_of(&p);
        if (fl_cgal_simplify(&s, within, &gone, &err)) fail_msg("%s", err.text);
        assert_int_equal(s.nt, p.nt - gone);
        assert_true(gone > 60);
        t = soup_of(&p);
        assert_int_equal(fl_cgal_distance(&s, &t, 1e-9, &lower, &upper, &err), 0);
        assert_true(upper <= 1.02 * within);
        fl_soup_free(&t);
        set_part(&q, &s);
        assert_int_equal(measure_part(&q).open + measure_part(&q).branched, 0);
        fl_part_free(&p);
        fl_part_free(&q);
    }
}

static void remeshing_evens_edges_and_keeps_the_surface(void **state)
{
    fl_part p = {0}, q = {0};
    fl_soup s, t;
    double lower, upper;
    fl_mesh_quality m;
    (void)state;
    fl_facet_box(&p, v3(0, 0, 0), v3(1, 2, 3), &err);
    s = soup_of(&p);
    t = soup_of(&p);
    if (fl_cgal_remesh(&s, 0.25, &err)) fail_msg("%s", err.text);
    assert_int_equal(fl_cgal_distance(&s, &t, 1e-9, &lower, &upper, &err), 0);
    assert_true(upper < 1e-8);
    assert_int_equal(fl_cgal_distance(&t, &s, 1e-9, &lower, &upper, &err), 0);
    assert_true(upper < 1e-8);
    set_part(&q, &s);
    m = measure_part(&q);
    assert_int_equal(m.open + m.branched + m.degenerate, 0);
    assert_near(m.volume, 6.0, 1e-13);
    assert_near(m.area, 22.0, 1e-13);
    assert_true(m.triangles > 22.0 / (0.25 * 0.25 * 0.75) && m.triangles < 22.0 / (0.25 * 0.25 * 0.2));
    assert_true(m.shortest_edge > 0.25 / 4.0);
    fl_soup_free(&t);
    fl_part_free(&p);
    fl_part_free(&q);
}

/* Triangles on any three of a few points: no crash, failures are FL_NUMERIC, and the output is sound. */
static void no_triangle_soup_crashes(void **state)
{
    (void)state;
    for (long k = 0; k < test_times(60); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const int32_t nv = 4 + (int32_t)fl_rng_in(&g, 0, 12), nt = 1 + (int32_t)fl_rng_in(&g, 0, 30);
        fl_part p = {0};
        for (int32_t v = 0; v < nv; v++) {
            const fl_vec3 x = v3(fl_rng_in(&g, 0, 4), fl_rng_in(&g, 0, 4), fl_rng_in(&g, 0, k % 2 ? 4 : 1));
            fl_surface_vertex(&p, k % 3 ? x : v3(floor(x.x), floor(x.y), floor(x.z)), &err);
        }
        while (p.nt < nt) {
            const int32_t a = (int32_t)fl_rng_in(&g, 0, nv), b = (int32_t)fl_rng_in(&g, 0, nv),
                          c = (int32_t)fl_rng_in(&g, 0, nv);
            if (a != b && b != c && c != a) fl_surface_triangle(&p, a, b, c, &err);
        }
        for (int what = 0; what < 4; what++) {
            fl_soup s = soup_of(&p), t = soup_of(&p);
            fl_err e = {0};
            fl_crossing c;
            fl_untangle did;
            fl_repair repair;
            int32_t gone;
            int rc = fl_cgal_repair(&s, 0, 0.0, &repair, &e);
            if (rc == 0 && what == 0) rc = fl_cgal_crossings(&s, &c, &e);
            if (rc == 0 && what == 1) rc = untangle(&s, &did, &e);
            if (rc == 0 && what == 2) rc = fl_cgal_simplify(&s, 0.1, &gone, &e);
            if (rc == 0 && what == 3) rc = fl_cgal_remesh(&s, 0.5, &e);
            if (rc && e.code != FL_NUMERIC)
                print_error("seed %llu case %ld\n", (unsigned long long)test_seed(), k);
            assert_true(rc == 0 || e.code == FL_NUMERIC);
            assert_null(strstr(e.text, "CGAL ERROR"));
            for (int32_t m = 0; m < 3 * s.nt; m++) assert_true(s.t[m] >= 0 && s.t[m] < s.nv);
            for (int32_t m = 0; m < 3 * s.nv; m++) assert_true(isfinite(s.x[m]));
            if (s.nt && t.nt) {
                double lower, upper;
                assert_int_equal(fl_cgal_distance(&s, &t, 1e-6, &lower, &upper, &e), 0);
                assert_true(lower >= 0.0 && upper >= lower && upper < 10.0);
            }
            fl_soup_free(&s);
            fl_soup_free(&t);
        }
        fl_part_free(&p);
    }
}

/* Whether the surfaces of two boxes have a point in common. */
static int surfaces_meet(const fl_aabb *a, const fl_aabb *b)
{
    const double x[2][6] = {{a->lo.x, a->lo.y, a->lo.z, a->hi.x, a->hi.y, a->hi.z},
                            {b->lo.x, b->lo.y, b->lo.z, b->hi.x, b->hi.y, b->hi.z}};
    int inside[2] = {1, 1};
    for (int k = 0; k < 3; k++) {
        if (x[0][k] > x[1][k + 3] || x[1][k] > x[0][k + 3]) return 0;
        for (int i = 0; i < 2; i++) inside[i] &= x[1 - i][k] < x[i][k] && x[i][k + 3] < x[1 - i][k + 3];
    }
    return !inside[0] && !inside[1];
}

enum { BOXES = 3, GRID = 5 };

/* Volume of the boxes on the grid: those that meet are solid together, others may be cavities. */
static double volume_of_boxes(const fl_aabb *b)
{
    int group[BOXES];
    double sum = 0.0;
    for (int i = 0; i < BOXES; i++) group[i] = i;
    for (int pass = 0; pass < BOXES; pass++)
        for (int i = 0; i < BOXES; i++)
            for (int j = 0; j < BOXES; j++)
                if (surfaces_meet(&b[i], &b[j]) && group[j] < group[i]) group[i] = group[j];
    for (int c = 0; c < GRID * GRID * GRID; c++) {
        const fl_vec3 x = v3(c % GRID + 0.5, c / GRID % GRID + 0.5, c / GRID / GRID + 0.5);
        int in[BOXES] = {0}, groups = 0;
        for (int i = 0; i < BOXES; i++)
            in[group[i]] |= x.x > b[i].lo.x && x.x < b[i].hi.x && x.y > b[i].lo.y && x.y < b[i].hi.y &&
                            x.z > b[i].lo.z && x.z < b[i].hi.z;
        for (int i = 0; i < BOXES; i++) groups += in[i];
        sum += groups % 2;
    }
    return sum;
}

/* The boxes in this order become their union, of the volume `want`, and the sum along lines says the same. */
static void unite_boxes(const fl_aabb *b, const int *order, double want)
{
    int32_t shell[12 * BOXES], group[12 * BOXES];
    fl_part p = {0}, source;
    fl_untangle did;
    fl_repair mended;
    fl_volume_check c;
    fl_soup s;
    for (int i = 0; i < BOXES; i++) {
        fl_facet_box(&p, b[order[i]].lo, b[order[i]].hi, &err);
        for (int t = 0; t < 12; t++) shell[12 * i + t] = i;
    }
    source = p;
    s = soup_of(&p);
    if (fl_cgal_untangle(&s, shell, group, &did, &err) || fl_cgal_repair(&s, 0, 0.0, &mended, &err))
        fail_msg("%s", err.text);
    p = (fl_part){0};
    set_part(&p, &s);
    assert_int_equal(did.failed, 0);
    assert_near(measure_part(&p).volume, want, 1e-4);
    assert_int_equal(fl_check_volume(&source, shell, group, &p, &c, &err), 0);
    assert_int_equal(c.bodies, 0);
    assert_near(c.result, c.source, 1e-3);
    fl_part_free(&source);
    fl_part_free(&p);
}

/* Boxes that cross, touch, coincide in part and lie in each other. */
static void unions_do_not_depend_on_the_order(void **state)
{
    static const int order[6][BOXES] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    (void)state;
    for (int trial = 0; trial < 6; trial++) {
        fl_rng g = fl_rng_of(11, trial, FL_RNG_TEST);
        fl_aabb b[BOXES];
        for (int i = 0; i < BOXES; i++) {
            double lo[3], hi[3];
            for (int k = 0; k < 3; k++) {
                const int from = (int)fl_rng_in(&g, 0.0, GRID) % GRID;
                lo[k] = from;
                hi[k] = from + 1 + (int)fl_rng_in(&g, 0.0, GRID - from) % (GRID - from);
            }
            b[i] = (fl_aabb){v3(lo[0], lo[1], lo[2]), v3(hi[0], hi[1], hi[2])};
        }
        for (int k = 0; k < 6; k++) unite_boxes(b, order[k], volume_of_boxes(b));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_kind_of_intersection_is_classified),
                                       cmocka_unit_test(crossing_boxes_become_their_union),
                                       cmocka_unit_test(a_two_sided_plate_encloses_nothing),
                                       cmocka_unit_test(joints_of_tubes_become_one),
                                       cmocka_unit_test(a_self_intersecting_patch_is_rebuilt),
                                       cmocka_unit_test(distances_have_lower_and_upper_bounds),
                                       cmocka_unit_test(simplification_stays_within_the_distance),
                                       cmocka_unit_test(remeshing_evens_edges_and_keeps_the_surface),
                                       cmocka_unit_test(unions_do_not_depend_on_the_order),
                                       cmocka_unit_test(no_triangle_soup_crashes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
