/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The law `quick`: force and torque are the gradient of its energy, for bodies of every kind in every pose;
 * it does not depend on which body is A, nor on the list of features. */
#include "support/near.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/pi.h"
#include "geom/quat.h"
#include "narrow/gjk.h"
#include "patch/patch_law.h"
#include "patch/quick_law.h"
#include "support/shapes.h"

enum { POSES = 20000, SHAPES = 24 };

typedef struct {
    fl_poly p;
    fl_quick_shape s;
} body;

/* Octagons, boxes, other prisms, polytopes and slivers with inexact planes. */
static void make_body(body *b, int k)
{
    fl_rng g = fl_rng_of(test_seed(), 100 + k, FL_RNG_TEST);
    fl_err err = {0};
    if (k % 4 == 0) shape_random_prism(&b->p, &g);
    else if (k % 4 == 1) shape_random_box(&b->p, &g, -0.4, 0.2);
    else if (k % 4 == 2) shape_random_polytope(&b->p, &g, 6);
    else if (k % 8 == 3) shape_regular(&b->p, 20, 0.8);
    else shape_random_prism(&b->p, &g);
    assert_int_equal(fl_quick_shape_make(&b->s, &b->p, fl_rng_in(&g, 0.03, 0.1), &err), 0);
}

typedef struct {
    fl_quick_scratch w;
    fl_quick_list l;
    fl_vec3 *va, *na;
    double depth;
} tool;

/* sqrt(U) and its gradient for A at q, x in the frame of B, by a list for this pose alone. */
static double evaluate(tool *t, const body *a, const body *b, fl_quat q, fl_vec3 x, fl_quick_sums *sums)
{
    const fl_mat3 M = q_matrix(q);
    const double ra = a->s.radius, rb = b->s.radius;
    t->va = realloc(t->va, (size_t)a->p.nv * sizeof *t->va),
    t->na = realloc(t->na, (size_t)a->p.nf * sizeof *t->na);
    for (int32_t v = 0; v < a->p.nv; v++) t->va[v] = v3_add(m3_mul(M, a->p.v[v]), x);
    for (int32_t f = 0; f < a->p.nf; f++) t->na[f] = m3_mul(M, a->p.n[f]);
    fl_gap gap;
    fl_penetration deep = {0};
    fl_gjk((fl_core){t->va, a->p.nv, &a->p}, (fl_core){b->p.v, b->p.nv, &b->p}, NULL, &gap);
    if (gap.overlap) {
        const fl_solid A = {&a->p, t->va, t->na, 0.0}, B = {&b->p, b->p.v, b->p.n, 0.0};
        fl_penetration_find(&A, &B, NULL, &deep);
    }
    t->depth = deep.depth;
    assert_int_equal(fl_quick_list_build(&t->l, &a->s, &b->s, ra, rb, ra + rb + deep.depth, M,
                                         v3_madd(x, deep.depth, deep.n), 0.0),
                     0);
    assert_int_equal(fl_quick_evaluate(&t->w, &a->s, &b->s, ra, rb, M, x, &deep, &t->l, sums), 0);
    return sqrt(sums->u);
}

/* A pose in which the two overlap by a share of R; returns 0 if they miss.  kind 1: nearly parallel. */
static int find_pose(tool *t, const body *a, const body *b, fl_rng *g, int kind, double depth, fl_quat *q,
                     fl_vec3 *x)
{
    const double R = a->s.radius + b->s.radius, far = a->s.bound + b->s.bound + R;
    const double tilt = kind == 0 ? 3.0 : kind == 1 ? pow(10.0, fl_rng_in(g, -5.0, -1.0)) : 0.2;
    *q = kind == 0 ? shape_rotation(g) : q_of_vector(v3_scale(tilt, shape_direction(g)));
    fl_vec3 dir = shape_direction(g);
    if (kind) dir = v3_unit(v3_madd(b->s.face[fl_rng_u64(g) % (uint64_t)b->s.faces].n, 0.4, dir));
    const fl_vec3 aside = v3_scale(fl_rng_in(g, 0.0, 0.5) * b->s.bound, shape_direction(g));
    double lo = 0.0, hi = 2.0 * far;
    fl_quick_sums sums;
    for (int c = 0; c < 50; c++) {
        const double mid = 0.5 * (lo + hi);
        if (evaluate(t, a, b, *q, v3_madd(aside, mid, dir), &sums) > 0.0) lo = mid;
        else hi = mid;
    }
    *x = v3_madd(aside, lo - depth * R, dir);
    return evaluate(t, a, b, *q, *x, &sums) > 0.0 && lo > 0.0;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double component(fl_vec3 a, int k) { return k == 0 ? a.x : k == 1 ? a.y : a.z; }

/* Largest error of the gradient of sqrt(U) over displacements and turns of A, over the force. */
static double gradient_error(tool *t, const body *a, const body *b, fl_quat q, fl_vec3 x, double h, int *deep)
{
    fl_quick_sums sums, side;
    const double W = evaluate(t, a, b, q, x, &sums), scale = 0.5 / W, arm = b->s.bound + a->s.bound;
    const double size = scale * v3_norm(sums.gradient.f);
    double worst = 0.0;
    *deep = t->depth > 0.0;
    for (int k = 0; k < 6; k++) {
        const fl_vec3 e = v3(k % 3 == 0, k % 3 == 1, k % 3 == 2);
        double at[2];
        for (int way = 0; way < 2; way++) {
            const double step = (way ? h : -h) / (k < 3 ? 1.0 : arm);
            const fl_quat turn = q_of_vector(v3_scale(step, e));
            at[way] = k < 3 ? evaluate(t, a, b, q, v3_madd(x, step, e), &side)
                            : evaluate(t, a, b, q_mul(turn, q), q_rotate(turn, x), &side);
        }
        const double slope = (at[1] - at[0]) / (2.0 * h) * (k < 3 ? 1.0 : arm);
        const double is = -scale * component(k < 3 ? sums.gradient.f : sums.gradient.m, k % 3);
        worst = fmax(worst, fabs(slope - is) / (size * (k < 3 ? 1.0 : arm)));
    }
    return worst;
}

static body bodies[SHAPES];

static void check_gradient(double depth, const char *what, double median_tol, double most_tol)
{
    tool t = {0};
    const int n = (int)test_times(POSES);
    double *const error = malloc((size_t)n * sizeof *error);
    int found = 0, off = 0, over = 0;
    for (int k = 0; found < n && k < 4 * n; k++) {
        fl_rng g = fl_rng_of(test_seed(), 10000 + k, FL_RNG_TEST);
        const body *a = &bodies[fl_rng_u64(&g) % SHAPES], *b = &bodies[fl_rng_u64(&g) % SHAPES];
        fl_quat q;
        fl_vec3 x;
        int deep;
        const double R = a->s.radius + b->s.radius;
        if (!find_pose(&t, a, b, &g, k % 3, depth * fl_rng_in(&g, 0.05, 1.0), &q, &x)) continue;
        double e = gradient_error(&t, a, b, q, x, 1e-6 * R, &deep);
        over += deep;
        if (e > most_tol) e = fmin(e, gradient_error(&t, a, b, q, x, 1e-7 * R, &deep));
        if (e > most_tol) e = fmin(e, gradient_error(&t, a, b, q, x, 1e-5 * R, &deep));
        error[found++] = e;
        if (e > most_tol && off++ < 12)
            print_error("seed %llu case %d: gradient off by %.1e%s\n", (unsigned long long)test_seed(), k, e,
                        deep ? ", deep" : "");
    }
    qsort(error, (size_t)found, sizeof *error, compare_doubles);
    printf("%s: %d poses, %d of overlapping cores: gradient median %.1e, 99 %% %.1e, largest %.1e\n", what,
           found, over, error[found / 2], error[found * 99 / 100], error[found - 1]);
    assert_int_equal(found, n);
    assert_true(error[found / 2] < median_tol);
    assert_true(error[found - 1] < most_tol);
    free(error), free(t.va), free(t.na);
    fl_quick_list_free(&t.l), fl_quick_scratch_free(&t.w);
}

static void force_is_the_gradient(void **state)
{
    (void)state;
    check_gradient(0.5, "quick", 1e-8, 1e-5);
}

static void force_is_the_gradient_of_overlapping_cores(void **state)
{
    (void)state;
    check_gradient(2.5, "quick, deep", 1e-7, 1e-4);
}

/* Sums of the pair seen from either body, and by a list that was built elsewhere. */
static void a_and_b_may_be_exchanged(void **state)
{
    tool t = {0};
    double worst = 0.0;
    (void)state;
    for (int k = 0; k < test_times(3000); k++) {
        fl_rng g = fl_rng_of(test_seed(), 900000 + k, FL_RNG_TEST);
        const body *a = &bodies[fl_rng_u64(&g) % SHAPES], *b = &bodies[fl_rng_u64(&g) % SHAPES];
        fl_quat q;
        fl_vec3 x;
        if (!find_pose(&t, a, b, &g, k % 3, 0.3 * fl_rng_in(&g, 0.05, 1.0), &q, &x)) continue;
        fl_quick_sums one, two, three;
        evaluate(&t, a, b, q, x, &one);
        if (t.depth > 0.0) continue;
        const fl_quat back = q_conj(q);
        evaluate(&t, b, a, back, v3_neg(q_rotate(back, x)), &two);
        const fl_vec3 f = v3_neg(q_rotate(q, two.gradient.f));
        worst = fmax(worst, fabs(one.u / two.u - 1.0));
        worst = fmax(worst, v3_norm(v3_sub(f, one.gradient.f)) / v3_norm(f));
        worst = fmax(worst, fabs(one.pressure / two.pressure - 1.0));
        const double R = a->s.radius + b->s.radius, margin = 0.3 * R;
        const fl_mat3 M = q_matrix(q),
                      M0 = q_matrix(q_mul(
                          q_of_vector(v3_scale(0.1 * margin / (a->s.bound + R), shape_direction(&g))), q));
        const fl_vec3 o0 = v3_madd(x, 0.49 * margin, shape_direction(&g));
        assert_int_equal(fl_quick_list_build(&t.l, &a->s, &b->s, a->s.radius, b->s.radius, R, M0, o0, margin),
                         0);
        assert_true(fl_quick_list_valid(&t.l, &M, x));
        assert_int_equal(fl_quick_evaluate(&t.w, &a->s, &b->s, a->s.radius, b->s.radius, M, x,
                                           &(fl_penetration){0}, &t.l, &three),
                         0);
        if (memcmp(&one, &three, sizeof one))
            print_error("seed %llu case %d: the list changes %.17g to %.17g\n",
                        (unsigned long long)test_seed(), k, one.u, three.u);
        assert_memory_equal(&one, &three, sizeof one);
    }
    printf("exchange of the bodies: %.1e\n", worst);
    assert_true(worst < 1e-9);
    free(t.va), free(t.na);
    fl_quick_list_free(&t.l), fl_quick_scratch_free(&t.w);
}

/* A box with its half sides, of the radius rho. */
static void make_box(body *b, fl_vec3 half, double rho)
{
    fl_err err = {0};
    assert_int_equal(fl_poly_box(&b->p, half, &err), 0);
    assert_int_equal(fl_quick_shape_make(&b->s, &b->p, rho, &err), 0);
}

static void free_body(body *b)
{
    fl_quick_shape_free(&b->s);
    fl_poly_free(&b->p);
}

/* At 0.1 rad g is 1 - 4e-5. */
#define ALMOST_PARALLEL 1e-4

/* Two edges that cross at any angle are crossed cylinders, and a corner on a face is a sphere on a plane:
 * W = (8/15) E* sqrt(r) s^(5/2) of Hertz, with r = rho/sin of the angle for cylinders of radius rho.  So
 * U = L (2 pi/5) r s^5.  That leaves out the mild dependence of the elliptic
 * contact on the angle. */
static void edges_that_cross_and_corners_are_hertz(void **state)
{
    const double rho = 0.05, s = 0.002, R = 2.0 * rho,
                 one = FL_PATCH_ROUND_FACTOR * 0.4 * PI * rho * pow(s, 5.0);
    tool t = {0};
    body a = {.s = {0}}, b = {.s = {0}};
    fl_quick_sums sums;
    (void)state;
    make_box(&a, v3(0.5, 0.1, 0.1), rho), make_box(&b, v3(0.5, 0.1, 0.1), rho);
    for (int k = 0; k <= 8; k++) {
        const double angle = 0.1 + 0.18 * k, high = 2.0 * 0.1 * sqrt(2.0);
        const fl_quat edge = q_of_vector(v3(PI / 4, 0, 0)),
                      q = q_mul(q_conj(edge), q_mul(q_of_vector(v3(0, 0, angle)), edge));
        evaluate(&t, &a, &b, q, q_rotate(q_conj(edge), v3(0.02, 0, high + R - s)), &sums);
        assert_near(sums.u, one / sin(angle), k ? 1e-9 : ALMOST_PARALLEL);
    }
    free_body(&a), free_body(&b);
    make_box(&a, v3(0.4, 0.4, 0.4), rho), make_box(&b, v3(3, 3, 0.5), rho);
    const fl_vec3 down = v3_unit(v3(1, 1, 1)), axis = v3_cross(down, v3(0, 0, -1));
    const fl_quat q = q_of_vector(v3_scale(acos(-down.z) / v3_norm(axis), axis));
    evaluate(&t, &a, &b, q, v3(0.1, 0.2, 0.5 + 0.4 * sqrt(3.0) + R - s), &sums);
    assert_near(sums.u, one, 1e-9);
    free_body(&a), free_body(&b);
    free(t.va), free(t.na);
    fl_quick_list_free(&t.l), fl_quick_scratch_free(&t.w);
}

/* A face on a larger one is the flat punch of its area, less the inset of the larger one's terms. */
static void a_face_is_the_flat_punch(void **state)
{
    const double rho = 0.05, s = 0.001, R = 2.0 * rho, side = 2.0, in = side - 2.0 * FL_QUICK_INSET * rho;
    tool t = {0};
    body a = {.s = {0}}, b = {.s = {0}};
    fl_quick_sums sums;
    (void)state;
    make_box(&a, v3(1, 1, 0.2), rho), make_box(&b, v3(3, 3, 0.5), rho);
    evaluate(&t, &a, &b, q_one(), v3(0.1, 0.2, 0.7 + R - s), &sums);
    const double corners = 4.0 * FL_PATCH_ROUND_FACTOR * 0.4 * PI * rho * pow(s, 5.0),
                 area = 0.5 * (side * side + in * in) * pow(s, 4.0);
    assert_near(sums.u, area + corners, 1e-9);
    assert_near(sums.pressure, (4.0 * area + 5.0 * corners) / s, 1e-9);
    free_body(&a), free_body(&b);
    free(t.va), free(t.na);
    fl_quick_list_free(&t.l), fl_quick_scratch_free(&t.w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(force_is_the_gradient), cmocka_unit_test(force_is_the_gradient_of_overlapping_cores),
        cmocka_unit_test(a_and_b_may_be_exchanged), cmocka_unit_test(edges_that_cross_and_corners_are_hertz),
        cmocka_unit_test(a_face_is_the_flat_punch)};
    for (int k = 0; k < SHAPES; k++) make_body(&bodies[k], k);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    for (int k = 0; k < SHAPES; k++) fl_quick_shape_free(&bodies[k].s), fl_poly_free(&bodies[k].p);
    return failed;
}
