/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/pi.h"
#include "base/rng.h"
#include "geom/merge_coplanar.h"
#include "support/near.h"

/* A flat mesh. */
enum { MOST = 4000 };
typedef struct {
    int32_t nv, nt;
    fl_vec3 v[MOST];
    fl_tri t[MOST];
    int32_t region[MOST], across[3 * MOST];
} flat_mesh;

static flat_mesh m;
static const fl_vec3 UP = {0, 0, 1};

static void link_sides(void)
{
    for (int32_t h = 0; h < 3 * m.nt; h++) {
        m.across[h] = -1;
        const int32_t a = m.t[h / 3].v[h % 3], b = m.t[h / 3].v[(h % 3 + 1) % 3];
        for (int32_t g = 0; g < 3 * m.nt && m.across[h] < 0; g++)
            if (m.t[g / 3].v[g % 3] == b && m.t[g / 3].v[(g % 3 + 1) % 3] == a) m.across[h] = g / 3;
    }
}

/* n by n cells of [0, 1]^2; keep() selects the cells that exist. */
static void make_cells(int n, int (*keep)(double x, double y))
{
    m.nv = m.nt = 0;
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= n; i++) m.v[m.nv++] = v3((double)i / n, (double)j / n, 0.0);
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            const int32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            if (keep && !keep((i + 0.5) / n, (j + 0.5) / n)) continue;
            const fl_tri pair[2][2] = {{{{a, b, c}}, {{a, c, d}}}, {{{a, b, d}}, {{b, c, d}}}};
            for (int k = 0; k < 2; k++) {
                m.region[m.nt] = 0;
                m.t[m.nt++] = pair[(i + j) % 2][k];
            }
        }
    }
    link_sides();
}

static double twice_area(int32_t a, int32_t b, int32_t c)
{
    return v3_cross(v3_sub(m.v[b], m.v[a]), v3_sub(m.v[c], m.v[a])).z;
}

/* Polygons are convex, have together the area of the triangles, and every triangle lies in its own. */
static fl_merged_faces merge_mesh(double tol)
{
    fl_merged_faces o = {0};
    fl_err err = {0};
    double tiles = 0.0, all = 0.0;
    assert_int_equal(fl_merge_coplanar(&o, m.nv, m.v, m.nt, m.t, m.region, &UP, m.across, tol, &err), 0);
    for (int32_t k = 0; k < o.n; k++) {
        const int32_t *loop = o.loop + o.first[k], n = o.first[k + 1] - o.first[k];
        assert_true(n >= 3 && n <= FL_MERGED_SIDES_MAX);
        for (int32_t c = 0; c < n; c++) {
            tiles += twice_area(loop[0], loop[c], loop[(c + 1) % n]);
            assert_true(twice_area(loop[c], loop[(c + 1) % n], loop[(c + 2) % n]) > 0.0);
        }
    }
    for (int32_t t = 0; t < m.nt; t++) {
        all += twice_area(m.t[t].v[0], m.t[t].v[1], m.t[t].v[2]);
        assert_in_range(o.face_of_tri[t], 0, o.n - 1);
    }
    assert_near(tiles, all, 1e-12);
    return o;
}

static void a_square_becomes_one_polygon_in_any_order(void **state)
{
    (void)state;
    int32_t first[4] = {0};
    for (int turn = 0; turn < 4; turn++) {
        make_cells(12, NULL);
        for (int32_t t = m.nt - 1; t > 0 && turn; t--) {
            fl_rng g = fl_rng_of(test_seed(), 100 * turn + t, FL_RNG_TEST);
            const int32_t u = (int32_t)fl_rng_in(&g, 0.0, t + 0.999);
            const fl_tri swap = m.t[t];
            m.t[t] = m.t[u], m.t[u] = swap;
        }
        link_sides();
        fl_merged_faces o = merge_mesh(1e-9);
        assert_int_equal(o.n, 1);
        assert_int_equal(o.first[1], 4);
        if (!turn) memcpy(first, o.loop, sizeof first);
        assert_memory_equal(first, o.loop, sizeof first);
        assert_int_equal(o.straight_corners[6], 1);
        fl_merged_faces_free(&o);
    }
}

static int l_shape(double x, double y) { return x < 0.5 || y < 0.5; }
static int frame(double x, double y) { return fabs(x - 0.5) > 0.2 || fabs(y - 0.5) > 0.2; }
static int checkerboard(double x, double y) { return ((int)(4 * x) + (int)(4 * y)) % 2; }

/* At most 4 times as many as needed would be 8 and 16 without inner vertices. */
static void a_non_convex_face_becomes_few_polygons(void **state)
{
    (void)state;
    make_cells(20, l_shape);
    fl_merged_faces o = merge_mesh(1e-9);
    assert_in_range(o.n, 2, 40);
    fl_merged_faces_free(&o);
    make_cells(20, frame);
    o = merge_mesh(1e-9);
    assert_in_range(o.n, 4, 60);
    fl_merged_faces_free(&o);
    /* squares that share only corners, as eight regions of one number */
    make_cells(20, checkerboard);
    o = merge_mesh(1e-9);
    assert_in_range(o.n, 8, 60);
    fl_merged_faces_free(&o);
}

static void a_disc_is_divided_by_chords(void **state)
{
    (void)state;
    const int32_t n = 200;
    m.nv = m.nt = 0;
    for (int32_t k = 0; k < n; k++) m.v[m.nv++] = v3(cos(2 * PI * k / n), sin(2 * PI * k / n), 0);
    m.v[m.nv++] = v3(0.1, 0.2, 0);
    for (int32_t k = 0; k < n; k++) {
        m.region[m.nt] = 0;
        m.t[m.nt++] = (fl_tri){{k, (k + 1) % n, n}};
    }
    link_sides();
    fl_merged_faces o = merge_mesh(1e-9);
    assert_int_equal(o.n, 4); /* 198 triangles of corners, 62 per polygon */
    fl_merged_faces_free(&o);
}

/* As coordinates from a file of 32-bit floats: corners of the rim are off by less than the tolerance. */
static void rounded_corners_are_straight(void **state)
{
    (void)state;
    make_cells(12, NULL);
    for (int32_t v = 0; v < m.nv; v++) {
        fl_rng g = fl_rng_of(test_seed(), v, FL_RNG_TEST);
        m.v[v] = v3_add(m.v[v], v3(fl_rng_in(&g, -1e-7, 1e-7), fl_rng_in(&g, -1e-7, 1e-7), 0));
    }
    fl_merged_faces o = {0};
    fl_err err = {0};
    assert_int_equal(fl_merge_coplanar(&o, m.nv, m.v, m.nt, m.t, m.region, &UP, m.across, 1e-6, &err), 0);
    assert_int_equal(o.n, 1);
    assert_int_equal(o.first[1], 4);
    fl_merged_faces_free(&o);
}

static void regions_are_not_merged(void **state)
{
    (void)state;
    const fl_vec3 up[2] = {UP, UP};
    make_cells(8, NULL);
    for (int32_t t = 0; t < m.nt; t++) m.region[t] = m.v[m.t[t].v[0]].x + m.v[m.t[t].v[1]].x >= 1.0 ? 1 : 0;
    m.region[0] = -1;
    fl_merged_faces o = {0};
    fl_err err = {0};
    assert_int_equal(fl_merge_coplanar(&o, m.nv, m.v, m.nt, m.t, m.region, up, m.across, 1e-9, &err), 0);
    assert_int_equal(o.face_of_tri[0], -1);
    for (int32_t t = 1; t < m.nt; t++) assert_int_equal(o.region[o.face_of_tri[t]], m.region[t]);
    fl_merged_faces_free(&o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_square_becomes_one_polygon_in_any_order),
        cmocka_unit_test(a_non_convex_face_becomes_few_polygons),
        cmocka_unit_test(a_disc_is_divided_by_chords),
        cmocka_unit_test(rounded_corners_are_straight),
        cmocka_unit_test(regions_are_not_merged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
