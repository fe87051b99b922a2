/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walls inside a surface: which side of the skin is outward, and the bodies of which it was assembled. */
#include <math.h>
#include "base/array.h"
#include "base/rng.h"
#include "geom/facet.h"
#include "geom/mat3.h"
#include "geom/outer_skin.h"
#include "geom/mesh_patch.h"
#include "geom/quat.h"
#include "geom/connected_parts.h"
#include "geom/inner_walls.h"
#include "geom/weld.h"
#include "support/near.h"

static fl_err err;

enum { N = 4 }; /* vertices along a side of the honeycomb */

static int32_t vertex_index(int i, int j, int k) { return (i * N + j) * N + k; }

static void add_square(fl_part *p, const int32_t v[4], fl_rng *g)
{
    for (int h = 0; h < 2; h++) {
        const int32_t a = v[0], b = v[1 + h], c = v[2 + h];
        if (fl_rng_in(g, 0, 1) < 0.5) fl_surface_triangle(p, a, b, c, &err);
        else fl_surface_triangle(p, a, c, b, &err);
    }
}

/* All walls of 3 x 3 x 3 cells, with random winding: each triangle, or each wall as a whole. */
static fl_part honeycomb(fl_rng *g)
{
    fl_part p = {0};
    for (int v = 0; v < N * N * N; v++)
        fl_surface_vertex(&p, v3(v / (N * N), v / N % N, 0.5 * (v % N)), &err);
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N - 1; j++)
            for (int k = 0; k < N - 1; k++) {
                add_square(&p,
                           (int32_t[]){vertex_index(i, j, k), vertex_index(i, j + 1, k),
                                       vertex_index(i, j + 1, k + 1), vertex_index(i, j, k + 1)},
                           g);
                add_square(&p,
                           (int32_t[]){vertex_index(j, i, k), vertex_index(j + 1, i, k),
                                       vertex_index(j + 1, i, k + 1), vertex_index(j, i, k + 1)},
                           g);
                add_square(&p,
                           (int32_t[]){vertex_index(j, k, i), vertex_index(j + 1, k, i),
                                       vertex_index(j + 1, k + 1, i), vertex_index(j, k + 1, i)},
                           g);
            }
    return p;
}

/* Outward direction of the honeycomb before rotation, at the centroid of a triangle of its skin; 0 inside. */
static fl_vec3 outward_of(const fl_vec3 x[3])
{
    const fl_vec3 c = v3_scale(1.0 / 3.0, v3_add(x[0], v3_add(x[1], x[2])));
    const double upper = N - 1, o = 1e-9;
    return v3((c.x > upper - o) - (c.x < o), (c.y > upper - o) - (c.y < o),
              (c.z > 0.5 * upper - o) - (c.z < o));
}

static void the_skin_of_a_honeycomb_is_oriented_outward(void **state)
{
    (void)state;
    for (int64_t k = 0; k < 50; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_part p = honeycomb(&g), was = honeycomb(&g);
        const fl_mat3 R = q_matrix(
            q_unit((fl_quat){fl_rng_normal(&g), fl_rng_normal(&g), fl_rng_normal(&g), fl_rng_normal(&g)}));
        const fl_vec3 far = k % 3 ? v3(0, 0, 0) : v3(1e6, -1e6, 3e5);
        fl_mesh_quality q;
        fl_orient_counts o;
        int32_t gone;
        for (int32_t v = 0; v < p.nv; v++) p.v[v] = v3_add(far, m3_mul(R, p.v[v]));
        assert_int_equal(fl_part_orient(&p, &q, &o, &err), 0);
        assert_int_equal(o.kept_side + o.one_sided, 0);
        for (int32_t t = 0; t < p.nt; t++) {
            fl_vec3 x[3], y[3];
            for (int c = 0; c < 3; c++) x[c] = was.v[p.t[t].v[c]], y[c] = p.v[p.t[t].v[c]];
            const fl_vec3 out = outward_of(x), n = v3_cross(v3_sub(y[1], y[0]), v3_sub(y[2], y[0]));
            if (v3_norm(out) > 0.0) assert_true(v3_dot(n, m3_mul(R, out)) > 0.0);
        }
        assert_int_equal(fl_part_drop_inner_walls(&p, &gone, &err), 0);
        assert_int_equal(gone, 6 * (N - 1) * (N - 1) * (N - 2));
        assert_int_equal(fl_part_measure(&p, &q, &err), 0);
        assert_int_equal(q.open + q.branched + q.incoherent, 0);
        assert_near(q.volume, 0.5 * (N - 1) * (N - 1) * (N - 1), k % 3 ? 1e-13 : 1e-8);
        fl_part_free(&p), fl_part_free(&was);
    }
}

/* A box next to the first one of p, without the wall between them. */
static void add_open_box(fl_part *p)
{
    int32_t kept = 12;
    fl_facet_box(p, v3(1, 0, 0), v3(2, 1, 1), &err);
    for (int32_t t = 12; t < 24; t++) {
        const int32_t *v = p->t[t].v;
        if (p->v[v[0]].x + p->v[v[1]].x + p->v[v[2]].x > 3.5) p->t[kept++] = p->t[t];
    }
    p->nt = kept;
}

/* Two boxes side by side, the second inverted, and a fin on the first. */
static void boxes_that_share_a_wall(void **state)
{
    (void)state;
    for (int fin = 0; fin < 2; fin++) {
        fl_part p = {0};
        fl_weld w;
        fl_mesh_quality q;
        fl_orient_counts o;
        int32_t gone;
        fl_facet_box(&p, v3(0, 0, 0), v3(1, 1, 1), &err);
        add_open_box(&p);
        for (int32_t t = 12; t < 22; t++) {
            const int32_t keep = p.t[t].v[1];
            p.t[t].v[1] = p.t[t].v[2];
            p.t[t].v[2] = keep;
        }
        if (fin) { /* up from the edge of the first box at y = 0, z = 1 */
            const int32_t a = p.nv;
            fl_surface_vertex(&p, v3(0, 0, 1), &err);
            fl_surface_vertex(&p, v3(1, 0, 1), &err);
            fl_surface_vertex(&p, v3(0.5, 0, 2), &err);
            fl_surface_triangle(&p, a, a + 1, a + 2, &err);
        }
        assert_int_equal(fl_part_weld(&p, 0.0, &w, &err), 0);
        assert_int_equal(fl_part_orient(&p, &q, &o, &err), 0);
        assert_int_equal(o.kept_side, fin);
        assert_int_equal(fl_part_drop_inner_walls(&p, &gone, &err), 0);
        assert_int_equal(gone, 2);
        assert_int_equal(fl_part_measure(&p, &q, &err), 0);
        assert_int_equal(q.branched, fin);
        assert_near(q.volume, 2.0 + fin / 12.0, 1e-14); /* the cone from the centre over the fin */
        fl_part_free(&p);
    }
}

/* A two-sided plate is no wall, alone or on a box. Two boxes end to end are one, though another body passes
 * through both and shares a corner with each. */
static void double_walls_go_and_plates_stay(void **state)
{
    fl_part p = {0};
    fl_weld w;
    fl_mesh_quality q;
    int32_t gone;
    (void)state;
    for (int k = 0; k < 2; k++) {
        const int32_t a = p.nv;
        fl_surface_vertex(&p, v3(0, 0, k), &err);
        fl_surface_vertex(&p, v3(1, 0, k), &err);
        fl_surface_vertex(&p, v3(1, 0, k + 1), &err);
        fl_surface_vertex(&p, v3(0, 0, k + 1), &err);
        fl_surface_triangle(&p, a, a + 1, a + 2, &err);
        fl_surface_triangle(&p, a, a + 2, a + 3, &err);
        fl_surface_triangle(&p, a, a + 2, a + 1, &err);
        fl_surface_triangle(&p, a, a + 3, a + 2, &err);
        if (k) fl_facet_box(&p, v3(0, 0, 0), v3(1, 1, 1), &err); /* the second stands on its edge */
        assert_int_equal(fl_part_weld(&p, 0.0, &w, &err), 0);
        assert_int_equal(fl_part_drop_inner_walls(&p, &gone, &err), 0);
        assert_int_equal(gone, 0);
    }
    fl_part_free(&p);
    p = (fl_part){0};
    fl_facet_box(&p, v3(0, 0, 0), v3(1, 1, 1), &err);
    fl_facet_box(&p, v3(1, 0, 0), v3(2, 1, 1), &err);
    fl_facet_cone(&p, &(fl_cone){v3(1, .5, -1), v3(1, .5, 2), .3, .3}, 8, &err);
    p.v[p.t[24].v[0]] = v3(0, 0, 0), p.v[p.t[24].v[1]] = v3(1, 0, 0); /* shares an edge with the first */
    assert_int_equal(fl_part_weld(&p, 0.0, &w, &err), 0);
    assert_int_equal(fl_part_drop_inner_walls(&p, &gone, &err), 0);
    assert_int_equal(gone, 4);
    assert_int_equal(fl_part_measure(&p, &q, &err), 0);
    assert_int_equal(q.branched, 1);
    assert_int_equal(q.open, 0);
    fl_part_free(&p);
}

/* A two-sided plate alone, on a box, and on a box without its lid: on other bodies both sides are removed,
 * and closed bodies stay closed. */
static void fins_are_removed_on_both_sides(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        fl_part p = {0};
        fl_weld w;
        fl_mesh_quality was, q;
        int32_t gone;
        if (k) fl_facet_box(&p, v3(0, 0, 0), v3(1, 1, 1), &err);
        if (k == 2) p.nt -= 2;
        const int32_t a = p.nv, body = p.nt;
        fl_surface_vertex(&p, v3(0, 0, 1), &err);
        fl_surface_vertex(&p, v3(1, 0, 1), &err);
        fl_surface_vertex(&p, v3(1, 0, 2), &err);
        fl_surface_vertex(&p, v3(0, 0, 2), &err);
        fl_surface_triangle(&p, a, a + 1, a + 2, &err);
        fl_surface_triangle(&p, a, a + 2, a + 3, &err);
        fl_surface_triangle(&p, a, a + 2, a + 1, &err);
        fl_surface_triangle(&p, a, a + 3, a + 2, &err);
        assert_int_equal(fl_part_weld(&p, 0.0, &w, &err), 0);
        assert_int_equal(fl_part_measure(&p, &was, &err), 0);
        assert_int_equal(fl_part_drop_fins(&p, &gone, &err), 0);
        assert_int_equal(gone, k ? 4 : 0);
        assert_int_equal(fl_part_measure(&p, &q, &err), 0);
        assert_int_equal(q.triangles, k ? body : 4);
        assert_int_equal(q.closed, was.closed);
        assert_int_equal(q.branched, k == 0);
        if (k == 1) assert_near(q.volume, 1.0, 1e-14);
        fl_part_free(&p);
    }
}

/* Separate bodies are judged separately: a box inside another that has a wall, and two that overlap in part
 * of a face and share an edge, which must stay unchanged. */
static void separate_bodies_stay_unchanged(void **state)
{
    fl_part p = {0};
    fl_edges e;
    fl_weld w;
    uint8_t side[36];
    (void)state;
    fl_facet_box(&p, v3(0, 0, 0), v3(1, 1, 1), &err);
    add_open_box(&p);
    fl_facet_box(&p, v3(.25, .25, .25), v3(.75, .75, .75), &err);
    assert_int_equal(fl_part_weld(&p, 0.0, &w, &err), 0);
    assert_int_equal(fl_edges_make(&e, &p, &err), 0);
    assert_int_equal(fl_part_outer_sides(&p, &e, side, &err), 0);
    for (int32_t t = 0; t < 22; t++)
        assert_int_equal(side[t],
                         p.v[p.t[t].v[0]].x == 1 && p.v[p.t[t].v[1]].x == 1 && p.v[p.t[t].v[2]].x == 1
                             ? FL_OUTER_NONE
                             : FL_OUTER_FRONT);
    for (int32_t t = 22; t < 34; t++) assert_int_equal(side[t], FL_OUTER_BOTH); /* found by its volume */
    fl_edges_free(&e);
    fl_part_free(&p);
    p = (fl_part){0};
    fl_mesh_quality q;
    fl_orient_counts o;
    fl_facet_box(&p, v3(0, 1, 0), v3(2, 2, 2), &err);
    fl_facet_box(&p, v3(0, 0, 0), v3(2, 2, 2), &err);
    assert_int_equal(fl_part_weld(&p, 0.0, &w, &err), 0);
    assert_int_equal(fl_part_orient(&p, &q, &o, &err), 0);
    assert_int_equal(o.triangles + o.patches, 0);
    fl_part_free(&p);
}

static void bodies_that_share_edges_stay_separate(void **state)
{
    fl_part p = {0};
    fl_weld w;
    int32_t shell[36], odd_edges;
    (void)state;
    fl_facet_box(&p, v3(0, 0, 0), v3(1, 1, 1), &err);
    fl_facet_box(&p, v3(1, 1, 0), v3(2, 2, 1), &err);
    fl_facet_box(&p, v3(0, 1, 0), v3(1, 3, 1), &err); /* walls of both, a wall of the first, and edges */
    assert_int_equal(fl_part_weld(&p, 0.0, &w, &err), 0);
    assert_int_equal(fl_part_connected(&p, shell, &odd_edges, &err), 0);
    assert_int_equal(odd_edges, 0);
    for (int32_t t = 0; t < 36; t++) assert_int_equal(shell[t], t / 12 * 12);
    fl_part_free(&p);
}

/* Triangles that occur twice, in either winding: one of each two is the skin. */
static void one_of_two_coincident_triangles_is_skin(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 7, FL_RNG_TEST);
    (void)state;
    for (int k = 0; k < 200; k++) {
        fl_part p = {0};
        fl_edges e;
        uint8_t side[24];
        int skin = 0;
        fl_facet_box(&p, v3(0, 0, 0), v3(1, 1, 1), &err);
        for (int32_t t = 0; t < 12; t++) {
            const int32_t *v = p.t[t].v;
            const double chance = fl_rng_in(&g, 0, 3);
            if (chance < 1) fl_surface_triangle(&p, v[1], v[2], v[0], &err);
            else if (chance < 2) fl_surface_triangle(&p, v[0], v[2], v[1], &err);
        }
        if (p.nt == 24) p.nt--; /* two boxes, each closed, would not show it */
        assert_int_equal(fl_edges_make(&e, &p, &err), 0);
        assert_int_equal(fl_part_outer_sides(&p, &e, side, &err), 0);
        for (int32_t t = 0; t < p.nt; t++) {
            assert_int_not_equal(side[t], FL_OUTER_BOTH);
            skin += side[t] != FL_OUTER_NONE;
        }
        assert_int_equal(skin, 12);
        fl_edges_free(&e);
        fl_part_free(&p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_skin_of_a_honeycomb_is_oriented_outward),
        cmocka_unit_test(boxes_that_share_a_wall),
        cmocka_unit_test(double_walls_go_and_plates_stay),
        cmocka_unit_test(fins_are_removed_on_both_sides),
        cmocka_unit_test(separate_bodies_stay_unchanged),
        cmocka_unit_test(one_of_two_coincident_triangles_is_skin),
        cmocka_unit_test(bodies_that_share_edges_stay_separate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
