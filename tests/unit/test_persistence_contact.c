/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A ball on a surface that is not convex: which walls bear, and that nothing about it jumps. */
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

static void ready(bench *b)
{
    fl_err err = {0};
    assert_int_equal(fl_structure_build(&b->st, &b->surface, &err), 0);
    assert_int_equal(fl_structure_prepare_spheres(&b->st, &err), 0);
    assert_int_equal(b->st.n, 1);
    b->piece = &b->st.piece[0];
    assert_int_equal(b->piece->kind, FL_PIECE_MESH);
}

static void end(bench *b)
{
    fl_surface_free(&b->surface);
    fl_structure_free(&b->st);
    fl_patch_points_free(&b->w);
    fl_mesh_contact_work_free(&b->near);
    fl_mesh_under_face_free_pairs(&b->l);
    fl_poly_free(&b->point);
}

static int32_t vertex(fl_part *p, double x, double y, double z)
{
    fl_err err = {0};
    assert_int_equal(fl_surface_vertex(p, v3(x, y, z), &err), 0);
    return p->nv - 1;
}

static void triangle(fl_part *p, int32_t a, int32_t b, int32_t c)
{
    fl_err err = {0};
    assert_int_equal(fl_surface_triangle(p, a, b, c, &err), 0);
}

/* A sheet over [-1, 1]^2, n by n cells, of height h. */
static void sheet(fl_part *p, int n, double (*h)(double x, double y))
{
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= n; i++) {
            const double x = 2.0 * i / n - 1.0, y = 2.0 * j / n - 1.0;
            vertex(p, x, y, h(x, y));
        }
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            const int32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            triangle(p, a, b, c);
            triangle(p, a, c, d);
        }
}

/* Walls as they are met, without a factor: W = s^(5/2). */
typedef struct {
    double W;
    fl_vec3 F; /* -dW/dx */
    int walls, passes;
    double steep; /* sum of all slopes, whatever their sign */
} met;

static met look(bench *b, fl_vec3 x, int again)
{
    met m = {0};
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

static double hertz(double d) { return d < R ? pow(R - d, 2.5) : 0.0; }

/* --- grooves ------------------------------------------------------------------------------------ */

static double bend; /* of each wall of the groove, upwards [rad] */
static double groove(double x, double y)
{
    (void)y;
    return fabs(x) * tan(bend);
}

/* Two walls that bear, and what is taken off: that of the bottom of the groove. */
static void a_groove_fills_up(void **state)
{
    (void)state;
    static const double BEND[] = {1e-3, 0.01, 0.1, 0.3, 0.7, 1.2};
    for (size_t k = 0; k < sizeof BEND / sizeof *BEND; k++) {
        bench b;
        bend = BEND[k];
        sheet(part_of(&b), 8, groove);
        ready(&b);
        for (int c = 0; c < 400; c++) {
            fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
            const double x = fl_rng_in(&g, -0.15, 0.15),
                         z = fabs(x) * tan(bend) + fl_rng_in(&g, 0.01, 0.13) / cos(bend);
            double want = 0.0, d[2];
            int over[2];
            for (int s = 0; s < 2; s++) { /* the right wall, the left */
                const double ux = s ? -cos(bend) : cos(bend), uz = sin(bend), along = x * ux + z * uz;
                over[s] = along > 0.0;
                d[s] = over[s] ? fabs(z * ux - x * uz) : hypot(x, z);
            }
            const double pass = fmax(hypot(x, z), fmax(d[0], d[1]));
            want = hertz(d[0]) + hertz(d[1]) - hertz(pass);
            const met m = look(&b, v3(x, fl_rng_in(&g, -0.5, 0.5), z), c & 1);
            assert_near(m.W, want, 1e-9);
        }
        /* halfway up, both alike */
        const met m = look(&b, v3(0, 0.1, 0.95 * R / cos(bend)), 1);
        assert_true(fabs(m.F.x) <= 1e-12 * m.steep);
        if (0.95 * R / cos(bend) > R) assert_near(m.W, 2.0 * hertz(0.95 * R), 1e-12);
        end(&b);
    }
}

static double corner(double x, double y) { return 1.2 * (x > 0.0 ? x : 0.0) + 1.2 * (y > 0.0 ? y : 0.0); }

/* Boxes without a lid: three walls in a corner, however these are cut into triangles. */
static void corners_of_a_box(void **state)
{
    (void)state;
    bench b;
    fl_part *p = part_of(&b);
    for (int k = 0; k < 8; k++) vertex(p, k & 1, k >> 1 & 1, k >> 2);
    const int32_t in[5][4] = {
        {0, 1, 3, 2}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}; /* seen from within */
    for (int k = 0; k < 5; k++) {
        const int32_t *f = in[k];
        triangle(p, f[0], f[1], f[2]);
        triangle(p, f[0], f[2], f[3]);
    }
    ready(&b);
    const double d = 0.9 * R;
    const met m = look(&b, v3(d, d, d), 1);
    assert_int_equal(m.walls, 3);
    assert_int_equal(m.passes, 0);
    assert_near(m.W, 3.0 * hertz(d), 1e-14);
    assert_near(m.F.x, 2.5 * pow(R - d, 1.5), 1e-14);
    assert_near(m.F.z, m.F.x, 1e-14);
    assert_int_equal(look(&b, v3(d, d, 0.5), 1).walls, 2);
    assert_int_equal(look(&b, v3(d, 0.5, 0.5), 1).walls, 1);
    assert_int_equal(look(&b, v3(0.5, 0.5, 0.5), 1).walls, 0);
    end(&b);
}

/* --- how it is cut up --------------------------------------------------------------------------- */

static double step_of(double x, double y) { return x < -0.2 ? 0.0 : x > 0.2 ? 0.4 : (x + 0.2) + 0.0 * y; }

/* The same three strips, each of its own triangles that share no vertex with those of the next. */
static void strips(fl_part *p, int cuts[3])
{
    const double x[4] = {-1.0, -0.2, 0.2, 1.0};
    for (int s = 0; s < 3; s++) {
        const int n = cuts[s];
        int32_t last[2] = {-1, -1};
        for (int j = 0; j <= n; j++) {
            const double y = 2.0 * j / n - 1.0;
            const int32_t a = vertex(p, x[s], y, step_of(x[s], y)),
                          b = vertex(p, x[s + 1], y, step_of(x[s + 1], y));
            if (j) triangle(p, last[0], last[1], b), triangle(p, last[0], b, a);
            last[0] = a, last[1] = b;
        }
    }
}

static void seams_are_not_there(void **state)
{
    (void)state;
    int one[3] = {1, 1, 1}, many[3] = {3, 7, 5};
    bench b[3];
    strips(part_of(&b[0]), one);
    strips(part_of(&b[1]), many);
    sheet(part_of(&b[2]), 10, step_of);
    for (int k = 0; k < 3; k++) ready(&b[k]);
    for (int c = 0; c < 2000; c++) {
        fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
        const double x = fl_rng_in(&g, -0.5, 0.5), y = fl_rng_in(&g, -0.8, 0.8);
        const fl_vec3 at = v3(x, y, step_of(x, y) + fl_rng_in(&g, 0.005, 0.12));
        met m[3];
        for (int k = 0; k < 3; k++) m[k] = look(&b[k], at, 1);
        for (int k = 1; k < 3; k++) {
            assert_true(fabs(m[k].W - m[0].W) <= 1e-12 * m[0].steep);
            assert_true(v3_norm(v3_sub(m[k].F, m[0].F)) <= 1e-10 * m[0].steep);
        }
    }
    for (int k = 0; k < 3; k++) end(&b[k]);
}

/* --- nothing jumps ------------------------------------------------------------------------------ */

static double rough(double x, double y)
{
    fl_rng g =
        fl_rng_of(test_seed(), (int64_t)(1e3 * (x + 2.0)) * 10007 + (int64_t)(1e3 * (y + 2.0)), FL_RNG_TEST);
    return fl_rng_in(&g, -0.06, 0.06);
}
static double bowl(double x, double y) { return 0.6 * (x * x + y * y); }
static double waves(double x, double y) { return 0.05 * sin(7.0 * x) * cos(9.0 * y); }
static double saddles(double x, double y)
{
    const double a = x < 0.0 ? -x : 0.3 * x, b = y < 0.0 ? -y : 0.5 * y;
    return 0.7 * a - 0.9 * b;
}
static double notch(double x, double y) { return x > 0.1 && fabs(y) < 0.15 ? -0.4 : 0.0; }

/* Along straight ways W changes by no more than its slopes allow, the force is its gradient, and a list made
 * at another time is the same to the last bit. */
static void nothing_jumps(void **state)
{
    (void)state;
    static const struct {
        double (*h)(double, double);
        int n;
    } IT[] = {{groove, 6}, {corner, 6},  {rough, 20},  {rough, 60}, {bowl, 24},
              {waves, 40}, {saddles, 2}, {saddles, 8}, {notch, 20}, {step_of, 10}};
    bend = 0.4;
    for (size_t k = 0; k < sizeof IT / sizeof *IT; k++) {
        bench b;
        int wrong = 0, seen = 0, several = 0;
        sheet(part_of(&b), IT[k].n, IT[k].h);
        ready(&b);
        for (int c = 0; c < 300; c++) {
            fl_rng g = fl_rng_of(test_seed(), 1000 * (int64_t)k + c, FL_RNG_TEST);
            const double x0 = fl_rng_in(&g, -0.6, 0.6), y0 = fl_rng_in(&g, -0.6, 0.6);
            const fl_vec3 way = v3_unit(v3(fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1)));
            fl_vec3 x = v3(x0, y0, IT[k].h(x0, y0) + fl_rng_in(&g, 0.03, 0.1));
            const double h = 1e-5;
            met was = look(&b, x, 1);
            for (int s = 0; s < 60; s++) {
                x = v3_madd(x, h, way);
                const met now = look(&b, x, s % 7 == 0), anew = look(&b, x, 1);
                assert_true(now.W == anew.W && now.F.x == anew.F.x && now.F.y == anew.F.y &&
                            now.F.z == anew.F.z);
                if (b.w.n && b.w.point[0].overlap > 0.999 * R) break; /* its centre goes through a wall */
                /* the mean of the slopes at both ends; where walls come and go slopes bend */
                const double change = now.W - was.W, told = -0.5 * h * v3_dot(v3_add(now.F, was.F), way);
                assert_true(fabs(change) <= h * fmax(now.steep, was.steep) * 1.0001 + 1e-16);
                if (now.steep > 0.0) {
                    seen++, several += now.walls > 1;
                    wrong += fabs(change - told) > 1e-3 * h * now.steep;
                }
                was = now;
            }
        }
        assert_true(seen > 2000);
        assert_true(several > 200);
        assert_true(1000 * wrong < seen); /* where passes are alike the force may bend at once */
        end(&b);
    }
}

/* A box on a box, flush with it, crossing it, or beside it: what lies on each other bears once. */
static void tiles_on_each_other(void **state)
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
                vertex(p, (v & 1) + box * SHIFT[k][0], (v >> 1 & 1) + box * SHIFT[k][1],
                       (v >> 2) - 1.0 + box * SHIFT[k][2]);
            for (int s = 0; s < 6; s++) {
                triangle(p, o + f[s][0], o + f[s][1], o + f[s][2]);
                triangle(p, o + f[s][0], o + f[s][2], o + f[s][3]);
            }
        }
        ready(&b);
        for (int c = 0; c < 500; c++) {
            fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
            const double x = fl_rng_in(&g, 0.2, 1.6), z = fl_rng_in(&g, 0.01, 0.11);
            const met m = look(&b, v3(x, 0.5, z + (k == 1 && x > 0.8 ? 0.3 : 0.0)), 1);
            if (k == 1 && fabs(x - 0.8) < 1.1 * R) continue;
            assert_near(m.W, hertz(z), 1e-9);
        }
        end(&b);
    }
}

/* The tip of a cone of many triangles is made in the square of their number. */
static void a_tip_of_many(void **state)
{
    (void)state;
    bench b;
    fl_part *p = part_of(&b);
    const int n = 600;
    const int32_t low = vertex(p, 0, 0, -1), high = vertex(p, 0, 0, 0);
    for (int k = 0; k < n; k++) vertex(p, cos(2.0 * PI * k / n), sin(2.0 * PI * k / n), -0.4);
    for (int k = 0; k < n; k++) {
        const int32_t u = 2 + k, v = 2 + (k + 1) % n;
        triangle(p, high, u, v);
        triangle(p, low, v, u);
    }
    vertex(p, 3, 0, 0), vertex(p, 4, 0, 0), vertex(p, 3, 1, 0);
    triangle(p, p->nv - 3, p->nv - 2, p->nv - 1); /* else it were a solid */
    ready(&b);
    assert_true(b.piece->mesh.seams.n < 100 * n);
    const met m = look(&b, v3(0, 0, 0.06), 1);
    assert_int_equal(m.walls, 1);
    assert_near(m.W, hertz(0.06), 1e-12);
    end(&b);
}

/* What is convex is met once, and by its nearest point. */
static double roof(double x, double y) { return -0.3 * fabs(x) - 0.2 * fabs(y) - 0.1 * x * x; }
static void once_on_what_is_convex(void **state)
{
    (void)state;
    bench b;
    int lone = 0;
    sheet(part_of(&b), 10, roof);
    ready(&b);
    for (int c = 0; c < 1000; c++) {
        fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
        const double x = fl_rng_in(&g, -0.7, 0.7), y = fl_rng_in(&g, -0.7, 0.7);
        const met m = look(&b, v3(x, y, roof(x, y) + fl_rng_in(&g, 0.0, 0.1)), 1);
        assert_true(m.walls <= 1);
        lone += b.l.single_wall;
    }
    assert_true(lone > 950);
    end(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_groove_fills_up),      cmocka_unit_test(corners_of_a_box),
        cmocka_unit_test(seams_are_not_there),    cmocka_unit_test(nothing_jumps),
        cmocka_unit_test(once_on_what_is_convex), cmocka_unit_test(tiles_on_each_other),
        cmocka_unit_test(a_tip_of_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
