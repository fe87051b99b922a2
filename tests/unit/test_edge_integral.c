/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Edges over lines and points, against the same integrals by many quadrature points. */
#include "support/near.h"
#include <math.h>
#include <stdio.h>
#include "geom/quadrature_rules.h"
#include "patch/edge_integral.h"
#include "patch/patch_points.h"
#include "support/shapes.h"

enum { CASES = 4000 };

/* U, its derivative with s, force and moment about the origin, without the factor. */
typedef struct {
    double u, du;
    fl_vec3 f, m;
} sums;

typedef struct {
    fl_vec3 x0, u, c, e;
    double R;
} edge_case;

static void add_to_sums(sums *q, double u, double du, fl_vec3 f, fl_vec3 at)
{
    q->u += u, q->du += du;
    q->f = v3_add(q->f, f), q->m = v3_add(q->m, v3_cross(at, f));
}

static fl_vec3 nearest_on_axis(const edge_case *w, double t, fl_vec3 *way)
{
    const fl_vec3 r = v3_sub(v3_madd(w->x0, t, w->u), w->c), at = v3_madd(w->c, v3_dot(r, w->e), w->e);
    *way = v3_madd(r, -v3_dot(r, w->e), w->e);
    return at;
}

static double overlap_at(const edge_case *w, double t)
{
    fl_vec3 way;
    nearest_on_axis(w, t, &way);
    return w->R - v3_norm(way);
}

static void integrate_piece(const edge_case *w, double lo, double hi, sums *q)
{
    for (int k = 0; k < FL_LINE10_NODES; k++) {
        fl_vec3 way;
        const double t = lo + (hi - lo) * FL_LINE10_NODE[k];
        const fl_vec3 at = nearest_on_axis(w, t, &way);
        const double d = v3_norm(way), s = w->R - d, c = (hi - lo) * FL_LINE10_WEIGHT[k];
        if (!(s > 0.0 && d > 0.0)) continue;
        const double root = sqrt(s), pull = 4.5 * c * s * s * s * root;
        add_to_sums(q, c * s * s * s * s * root, pull, v3_scale(pull / d, way), at);
    }
}

/* From a, where the integrand is singular, to b: intervals that double in length. */
static void integrate_from_singular(const edge_case *w, double a, double b, sums *q)
{
    double lo = 0.0;
    for (double hi = 1e-14; lo < 1.0; lo = hi, hi = 2.0 * hi < 1.0 ? 2.0 * hi : 1.0)
        integrate_piece(w, a < b ? a + lo * (b - a) : a + hi * (b - a),
                        a < b ? a + hi * (b - a) : a + lo * (b - a), q);
}

/* From m, where the distance d is smallest, to t: the part with s > 0, halved, since both ends are
 * singular. */
static void integrate_one_way(const edge_case *w, double m, double t, sums *q)
{
    double in = m, out = t;
    if (overlap_at(w, m) <= 0.0 || t == m) return;
    if (overlap_at(w, t) <= 0.0)
        for (int k = 0; k < 200; k++) {
            const double mid = 0.5 * (in + out);
            *(overlap_at(w, mid) > 0.0 ? &in : &out) = mid;
        }
    const double mid = 0.5 * (m + out);
    integrate_from_singular(w, m, mid, q);
    integrate_from_singular(w, out, mid, q);
}

static void edges_over_lines_and_points(void **state)
{
    (void)state;
    fl_patch_points w = {0};
    fl_poly core = {0};
    fl_err err = {0};
    double worst = 0.0;
    int some = 0;
    assert_int_equal(fl_poly_box(&core, v3(1, 1, 1), &err), 0);
    for (int c = 0; c < CASES; c++) {
        fl_rng g = fl_rng_of(5, c, 0);
        const double R = 0.1,
                     over = c % 3 == 0 ? fl_rng_in(&g, 0.0, 1.0) : pow(10.0, -fl_rng_in(&g, 0.0, 6.0));
        const double d = c % 2 ? R * (1.0 - over) : R * over;
        const fl_vec3 e = shape_direction(&g), n = v3_unit(v3_cross(e, shape_direction(&g)));
        const double angle =
            c % 4 == 0 ? pow(10.0, -fl_rng_in(&g, 0.0, 17.0)) : fl_rng_in(&g, 0.0, 1.5707963);
        const fl_vec3 u = v3_madd(v3_scale(cos(angle), e), sin(angle), v3_cross(n, e));
        const double m = fl_rng_in(&g, -0.3, 1.3);
        edge_case q = {.u = v3_scale(fl_rng_in(&g, 0.1, 3.0), u), .e = c % 5 ? e : v3(0, 0, 0), .R = R};
        q.x0 = v3_madd(v3_scale(d, n), -m, q.u);
        double a = fl_rng_unit(&g), b = fl_rng_unit(&g);
        const fl_edge_span t = {a < b ? a : b, a < b ? b : a};
        const fl_patch_core own = {.p = &core, .r = 0.05, .side = 1.0};
        const fl_edge_line line = {&w, &own, q.x0, q.u, 1.0};
        w.n = 0;
        assert_int_equal(fl_edge_integral_begin(&w), 0);
        assert_int_equal(fl_edge_queue_over_point(&line, t, q.c, c % 5 ? &e : NULL, 1e-13), 0);
        assert_int_equal(fl_edge_integral_finish(&w, R), 0);
        sums got = {0}, expected = {0};
        for (int k = 0; k < w.n; k++)
            add_to_sums(&got, w.point[k].u, w.point[k].du, v3_scale(w.point[k].du, w.point[k].n),
                        w.point[k].p);
        const fl_vec3 across = v3_madd(q.u, -v3_dot(q.u, q.e), q.e),
                      r = v3_madd(q.x0, -v3_dot(q.x0, q.e), q.e);
        const double uu = v3_norm2(across), foot = uu > 0.0 ? -v3_dot(r, across) / uu : t.lo;
        const double nearest = foot > t.lo ? (foot < t.hi ? foot : t.hi) : t.lo;
        integrate_one_way(&q, nearest, t.lo, &expected);
        integrate_one_way(&q, nearest, t.hi, &expected);
        if (!(expected.u > 1e-30)) continue;
        some++;
        worst = fmax(worst, fabs(got.u - expected.u) / expected.u);
        worst = fmax(worst, fabs(got.du - expected.du) / expected.du);
        worst = fmax(worst, v3_norm(v3_sub(got.f, expected.f)) / expected.du);
        worst = fmax(worst, v3_norm(v3_sub(got.m, expected.m)) / (expected.du * (v3_norm(q.u) + R)));
    }
    printf("%d edges over lines and points: off by %.1e\n", some, worst);
    fl_patch_points_free(&w);
    fl_poly_free(&core);
    assert_true(some > CASES / 3);
    assert_true(worst < 2e-8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(edges_over_lines_and_points)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
