/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sphere on a non-convex surface: which walls carry load, and that energy and force are continuous. */
#include <math.h>
#include "base/pi.h"
#include "base/rng.h"
#include "structure/mesh_contact.h"
#include "support/near.h"

#define R 0.1

typedef struct {
    fl_surface surface;
    fl_structure st;
    const fl_piece *piece;
    fl_patch_points w;
    fl_mesh_contact_work near;
    fl_feature_pairs l;
    fl_poly point;
} bench;

static fl_part *part_of(bench *b)
{
    fl_err err = {0};
    *b = (bench){0};
    const fl_vec3 zero = v3(0, 0, 0);
    assert_int_equal(fl_poly_make(&b->point, 1, &zero, 0, NULL, NULL, &err), 0);
    assert_int_equal(fl_surface_add(&b->surface, "it", 2, &err), 0);
    return &b->surface.part[0];
}

static void prepare(bench *b)
{
    fl_err err = {0};
    assert_int_equal(fl_structure_build(&b->st, &b->surface, &err), 0);
    assert_int_equal(fl_structure_prepare_spheres(&b->st, &err), 0);
    assert_int_equal(b->st.n, 1);
    b->piece = &b->st.piece[0];
    assert_int_equal(b->piece->kind, FL_PIECE_MESH);
}

static void free_bench(bench *b)
{
    fl_surface_free(&b->surface);
    fl_structure_free(&b->st);
    fl_patch_points_free(&b->w);
    fl_mesh_contact_work_free(&b->near);
    fl_mesh_under_face_free_pairs(&b->l);
    fl_poly_free(&b->point);
}

static int32_t add_vertex(fl_part *p, double x, double y, double z)
{
    fl_err err = {0};
    assert_int_equal(fl_surface_vertex(p, v3(x, y, z), &err), 0);
    return p->nv - 1;
}

static void add_triangle(fl_part *p, int32_t a, int32_t b, int32_t c)
{
    fl_err err = {0};
    assert_int_equal(fl_surface_triangle(p, a, b, c, &err), 0);
}

/* A sheet over [-1, 1]^2, n by n cells, of height h. */
static void add_sheet(fl_part *p, int n, double (*h)(double x, double y))
{
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= n; i++) {
            const double x = 2.0 * i / n - 1.0, y = 2.0 * j / n - 1.0;
            add_vertex(p, x, y, h(x, y));
        }
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            const int32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            add_triangle(p, a, b, c);
            add_triangle(p, a, c, d);
        }
}

/* Contributions of the walls without a factor: W = s^(5/2). */
typedef struct {
    double W;
    fl_vec3 F; /* -dW/dx */
    int walls, passes;
    double steep; /* sum of all slopes in absolute value */
} evaluation;

static evaluation evaluate(bench *b, fl_vec3 x, int again)
{
    evaluation m = {0};
    double distance;
    if (again) b->l.max_shift2 = 0.0;
    const fl_mat3 same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    assert_int_equal(fl_patch_points_transform(&b->w, &b->point, same, v3_sub(x, b->piece->x)), 0);
    assert_int_equal(fl_mesh_contact_sphere(&b->w, &b->near, b->piece, R, &b->l, &distance), 0);
    for (int32_t k = 0; k < b->w.n; k++) {
        const fl_patch_point *q = &b->w.point[k];
        const double s = q->overlap;
        assert_true(s > 0.0 && (q->du == 1.0 || q->du == -1.0));
        m.W += q->du * s * s * sqrt(s);
        m.F = v3_madd(m.F, q->du * 2.5 * s * sqrt(s), q->n);
        m.steep += 2.5 * s * sqrt(s);
        m.walls += q->du > 0.0;
        m.passes += q->du < 0.0;
    }
    assert_true(b->w.n == 0 || b->w.point[0].du == 1.0);
    assert_true(m.passes < m.walls || b->w.n == 0);
    return m;
}

static double hertz_energy(double d) { return d < R ? pow(R - d, 2.5) : 0.0; }

/* --- grooves ------------------------------------------------------------------------------------ */

static double bend; /* inclination of each wall of the groove [rad] */
static double groove_height(double x, double y)
{
    (void)y;
    return fabs(x) * tan(bend);
}

/* The two loaded walls, and the part subtracted for the bottom of the groove. */
static void walls_merge_as_a_groove_closes(void **state)
{
    (void)state;
    static const double BEND[] = {1e-3, 0.01, 0.1, 0.3, 0.7, 1.2};
    for (size_t k = 0; k < sizeof BEND / sizeof *BEND; k++) {
        bench b;
        bend = BEND[k];
        add_sheet(part_of(&b), 8, groove_height);
        prepare(&b);
        for (int c = 0; c < 400; c++) {
            fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
            const double x = fl_rng_in(&g, -0.15, 0.15),
                         z = fabs(x) * tan(bend) + fl_rng_in(&g, 0.01, 0.13) / cos(bend);
            double expected = 0.0, d[2];
            int over[2];
            for (int s = 0; s < 2; s++) { /* the right wall, the left */
                const double ux = s ? -cos(bend) : cos(bend), uz = sin(bend), along = x * ux + z * uz;
                over[s] = along > 0.0;
                d[s] = over[s] ? fabs(z * ux - x * uz) : hypot(x, z);
            }
            const double pass = fmax(hypot(x, z), fmax(d[0], d[1]));
            expected = hertz_energy(d[0]) + hertz_energy(d[1]) - hertz_energy(pass);
            const evaluation m = evaluate(&b, v3(x, fl_rng_in(&g, -0.5, 0.5), z), c & 1);
            assert_near(m.W, expected, 1e-9);
        }
        /* halfway up, both equal */
        const evaluation m = evaluate(&b, v3(0, 0.1, 0.95 * R / cos(bend)), 1);
        assert_true(fabs(m.F.x) <= 1e-12 * m.steep);
        if (0.95 * R / cos(bend) > R) assert_near(m.W, 2.0 * hertz_energy(0.95 * R), 1e-12);
        free_bench(&b);
    }
}

static double corner_height(double x, double y)
{
    return 1.2 * (x > 0.0 ? x : 0.0) + 1.2 * (y > 0.0 ? y : 0.0);
}

/* Boxes without a lid: three walls in a corner, for any division into triangles. */
static void corners_of_a_box_have_three_walls(void **state)
{
    (void)state;
    bench b;
    fl_part *p = part_of(&b);
    for (int k = 0; k < 8; k++) add_vertex(p, k & 1, k >> 1 & 1, k >> 2);
    const int32_t in[5][4] = {
        {0, 1, 3, 2}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}; /* seen from inside */
    for (int k = 0; k < 5; k++) {
        const int32_t *f = in[k];
        add_triangle(p, f[0], f[1], f[2]);
        add_triangle(p, f[0], f[2], f[3]);
    }
    prepare(&b);
    const double d = 0.9 * R;
    const evaluation m = evaluate(&b, v3(d, d, d), 1);
    assert_int_equal(m.walls, 3);
    assert_int_equal(m.passes, 0);
    assert_near(m.W, 3.0 * hertz_energy(d), 1e-14);
    assert_near(m.F.x, 2.5 * pow(R - d, 1.5), 1e-14);
    assert_near(m.F.z, m.F.x, 1e-14);
    assert_int_equal(evaluate(&b, v3(d, d, 0.5), 1).walls, 2);
    assert_int_equal(evaluate(&b, v3(d, 0.5, 0.5), 1).walls, 1);
    assert_int_equal(evaluate(&b, v3(0.5, 0.5, 0.5), 1).walls, 0);
    free_bench(&b);
}

/* --- division into triangles -------------------------------------------------------------------- */

static double step_height(double x, double y) { return x < -0.2 ? 0.0 : x > 0.2 ? 0.4 : (x + 0.2) + 0.0 * y; }

/* The same three strips, each of its own triangles that share no vertex with those of the next. */
static void make_strips(fl_part *p, int cuts[3])
{
    const double x[4] = {-1.0, -0.2, 0.2, 1.0};
    for (int s = 0; s < 3; s++) {
        const int n = cuts[s];
        int32_t last[2] = {-1, -1};
        for (int j = 0; j <= n; j++) {
            const double y = 2.0 * j / n - 1.0;
            const int32_t a = add_vertex(p, x[s], y, step_height(x[s], y)),
                          b = add_vertex(p, x[s + 1], y, step_height(x[s + 1], y));
            if (j) add_triangle(p, last[0], last[1], b), add_triangle(p, last[0], b, a);
            last[0] = a, last[1] = b;
        }
    }
}

static void seams_of_a_mesh_change_nothing(void **state)
{
    (void)state;
    int one[3] = {1, 1, 1}, many[3] = {3, 7, 5};
    bench b[3];
    make_strips(part_of(&b[0]), one);
    make_strips(part_of(&b[1]), many);
    add_sheet(part_of(&b[2]), 10, step_height);
    for (int k = 0; k < 3; k++) prepare(&b[k]);
    for (int c = 0; c < 2000; c++) {
        fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
        const double x = fl_rng_in(&g, -0.5, 0.5), y = fl_rng_in(&g, -0.8, 0.8);
        const fl_vec3 at = v3(x, y, step_height(x, y) + fl_rng_in(&g, 0.005, 0.12));
        evaluation m[3];
        for (int k = 0; k < 3; k++) m[k] = evaluate(&b[k], at, 1);
        for (int k = 1; k < 3; k++) {
            assert_true(fabs(m[k].W - m[0].W) <= 1e-12 * m[0].steep);
            assert_true(v3_norm(v3_sub(m[k].F, m[0].F)) <= 1e-10 * m[0].steep);
        }
    }
    for (int k = 0; k < 3; k++) free_bench(&b[k]);
}

/* --- continuity --------------------------------------------------------------------------------- */

static double rough_height(double x, double y)
{
    fl_rng g =
        fl_rng_of(test_seed(), (int64_t)(1e3 * (x + 2.0)) * 10007 + (int64_t)(1e3 * (y + 2.0)), FL_RNG_TEST);
    return fl_rng_in(&g, -0.06, 0.06);
}
static double bowl_height(double x, double y) { return 0.6 * (x * x + y * y); }
static double wave_height(double x, double y) { return 0.05 * sin(7.0 * x) * cos(9.0 * y); }
static double saddle_height(double x, double y)
{
    const double a = x < 0.0 ? -x : 0.3 * x, b = y < 0.0 ? -y : 0.5 * y;
    return 0.7 * a - 0.9 * b;
}
static double notch_height(double x, double y) { return x > 0.1 && fabs(y) < 0.15 ? -0.4 : 0.0; }

/* Along straight paths W changes by no more than its slopes allow, the force is its gradient, and a list made
 * at another pose gives the same bits. */
static void energy_and_force_are_continuous(void **state)
{
    (void)state;
    static const struct {
        double (*h)(double, double);
        int n;
    } IT[] = {{groove_height, 6}, {corner_height, 6}, {rough_height, 20}, {rough_height, 60},
              {bowl_height, 24},  {wave_height, 40},  {saddle_height, 2}, {saddle_height, 8},
              {notch_height, 20}, {step_height, 10}};
    bend = 0.4;
    for (size_t k = 0; k < sizeof IT / sizeof *IT; k++) {
        bench b;
        int wrong = 0, seen = 0, several = 0;
        add_sheet(part_of(&b), IT[k].n, IT[k].h);
        prepare(&b);
        for (int c = 0; c < 300; c++) {
            fl_rng g = fl_rng_of(test_seed(), 1000 * (int64_t)k + c, FL_RNG_TEST);
            const double x0 = fl_rng_in(&g, -0.6, 0.6), y0 = fl_rng_in(&g, -0.6, 0.6);
            const fl_vec3 way = v3_unit(v3(fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1)));
            fl_vec3 x = v3(x0, y0, IT[k].h(x0, y0) + fl_rng_in(&g, 0.03, 0.1));
            const double h = 1e-5;
            evaluation was = evaluate(&b, x, 1);
            for (int s = 0; s < 60; s++) {
                x = v3_madd(x, h, way);
                const evaluation now = evaluate(&b, x, s % 7 == 0), refreshed = evaluate(&b, x, 1);
                assert_true(now.W == refreshed.W && now.F.x == refreshed.F.x && now.F.y == refreshed.F.y &&
                            now.F.z == refreshed.F.z);
                if (b.w.n && b.w.point[0].overlap > 0.999 * R) break; /* the centre crosses a wall */
                /* the mean of the slopes at both ends; slopes change where walls start or stop
                 * contributing */
                const double change = now.W - was.W, predicted = -0.5 * h * v3_dot(v3_add(now.F, was.F), way);
                assert_true(fabs(change) <= h * fmax(now.steep, was.steep) * 1.0001 + 1e-16);
                if (now.steep > 0.0) {
                    seen++, several += now.walls > 1;
                    wrong += fabs(change - predicted) > 1e-3 * h * now.steep;
                }
                was = now;
            }
        }
        assert_true(seen > 2000);
        assert_true(several > 200);
        assert_true(1000 * wrong < seen); /* where two passes are equal, the force may change slope at once */
        free_bench(&b);
    }
}

/* A box on a box, flush with it, crossing it, or next to it: coincident faces carry load once. */
static void coincident_boxes_count_once(void **state)
{
    (void)state;
    static const double SHIFT[3][3] = {{0.8, 0.1, 0}, {0.8, 0.1, 0.3}, {1.0, 0, 0}};
    for (int k = 0; k < 3; k++) {
        bench b;
        fl_part *p = part_of(&b);
        for (int box = 0; box < 2; box++) {
            const int32_t f[6][4] = {{0, 2, 3, 1}, {0, 1, 5, 4}, {2, 6, 7, 3},
                                     {0, 4, 6, 2}, {1, 3, 7, 5}, {4, 5, 7, 6}};
            const int32_t o = p->nv;
            for (int v = 0; v < 8; v++)
                add_vertex(p, (v & 1) + box * SHIFT[k][0], (v >> 1 & 1) + box * SHIFT[k][1],
                           (v >> 2) - 1.0 + box * SHIFT[k][2]);
            for (int s = 0; s < 6; s++) {
                add_triangle(p, o + f[s][0], o + f[s][1], o + f[s][2]);
                add_triangle(p, o + f[s][0], o + f[s][2], o + f[s][3]);
            }
        }
        prepare(&b);
        for (int c = 0; c < 500; c++) {
            fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
            const double x = fl_rng_in(&g, 0.2, 1.6), z = fl_rng_in(&g, 0.01, 0.11);
            const evaluation m = evaluate(&b, v3(x, 0.5, z + (k == 1 && x > 0.8 ? 0.3 : 0.0)), 1);
            if (k == 1 && fabs(x - 0.8) < 1.1 * R) continue;
            assert_near(m.W, hertz_energy(z), 1e-9);
        }
        free_bench(&b);
    }
}

/* The tip of a cone of many triangles takes time of the square of their number. */
static void a_cone_tip_of_many_triangles(void **state)
{
    (void)state;
    bench b;
    fl_part *p = part_of(&b);
    const int n = 600;
    const int32_t low = add_vertex(p, 0, 0, -1), high = add_vertex(p, 0, 0, 0);
    for (int k = 0; k < n; k++) add_vertex(p, cos(2.0 * PI * k / n), sin(2.0 * PI * k / n), -0.4);
    for (int k = 0; k < n; k++) {
        const int32_t u = 2 + k, v = 2 + (k + 1) % n;
        add_triangle(p, high, u, v);
        add_triangle(p, low, v, u);
    }
    add_vertex(p, 3, 0, 0), add_vertex(p, 4, 0, 0), add_vertex(p, 3, 1, 0);
    add_triangle(p, p->nv - 3, p->nv - 2, p->nv - 1); /* otherwise it were a solid */
    prepare(&b);
    assert_true(b.piece->mesh.seams.n < 100 * n);
    const evaluation m = evaluate(&b, v3(0, 0, 0.06), 1);
    assert_int_equal(m.walls, 1);
    assert_near(m.W, hertz_energy(0.06), 1e-12);
    free_bench(&b);
}

/* A convex body has one contact, at its closest point. */
static double roof_height(double x, double y) { return -0.3 * fabs(x) - 0.2 * fabs(y) - 0.1 * x * x; }
static void a_convex_body_has_one_contact(void **state)
{
    (void)state;
    bench b;
    int single = 0;
    add_sheet(part_of(&b), 10, roof_height);
    prepare(&b);
    for (int c = 0; c < 1000; c++) {
        fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
        const double x = fl_rng_in(&g, -0.7, 0.7), y = fl_rng_in(&g, -0.7, 0.7);
        const evaluation m = evaluate(&b, v3(x, y, roof_height(x, y) + fl_rng_in(&g, 0.0, 0.1)), 1);
        assert_true(m.walls <= 1);
        single += b.l.single_wall;
    }
    assert_true(single > 950);
    free_bench(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walls_merge_as_a_groove_closes), cmocka_unit_test(corners_of_a_box_have_three_walls),
        cmocka_unit_test(seams_of_a_mesh_change_nothing), cmocka_unit_test(energy_and_force_are_continuous),
        cmocka_unit_test(a_convex_body_has_one_contact),  cmocka_unit_test(coincident_boxes_count_once),
        cmocka_unit_test(a_cone_tip_of_many_triangles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
