/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "geom/topology.h"
#include "support/near.h"

static void prism(fl_poly *p, int n, double size)
{
    fl_vec3 xy[200];
    fl_err err = {0};
    for (int k = 0; k < n; k++) {
        const double t = 2.0 * PI * k / n;
        xy[k] = v3(size * cos(t), size * sin(t), 0);
    }
    assert_int_equal(fl_poly_prism(p, n, xy, -size, size, &err), 0);
}

static void assert_same(const fl_poly *p, const fl_poly *q)
{
    const size_t nv = (size_t)p->nv, nf = (size_t)p->nf, ne = (size_t)p->ne;
    assert_int_equal(p->nv, q->nv);
    assert_int_equal(p->nf, q->nf);
    assert_int_equal(p->ne, q->ne);
    assert_memory_equal(p->v, q->v, nv * sizeof *p->v);
    if (nf) assert_memory_equal(p->n, q->n, nf * sizeof *p->n);
    if (nf) assert_memory_equal(p->c, q->c, nf * sizeof *p->c);
    assert_memory_equal(p->first, q->first, (nf + 1) * sizeof *p->first);
    if (nf) assert_memory_equal(p->loop, q->loop, (size_t)p->first[nf] * sizeof *p->loop);
    if (ne) assert_memory_equal(p->edge, q->edge, ne * sizeof *p->edge);
    for (int32_t e = 0; e < p->ne; e++)
        assert_true(fmin(fl_poly_edge_angle(p, e), FL_POLY_BLUNT_EDGE) ==
                    fmin(fl_poly_edge_angle(q, e), FL_POLY_BLUNT_EDGE));
    for (int32_t v = 0; v < p->nv; v++)
        assert_true(fmin(fl_poly_corner_angle(p, v), FL_POLY_BLUNT_CORNER) ==
                    fmin(fl_poly_corner_angle(q, v), FL_POLY_BLUNT_CORNER));
    assert_memory_equal(p->neighbour_first, q->neighbour_first, (nv + 1) * sizeof *p->neighbour_first);
    if (ne) assert_memory_equal(p->neighbour, q->neighbour, 2 * ne * sizeof *p->neighbour);
}

/* Of 3 to 190 corners, each three times: more kinds than the table begins with. */
static void equal_shapes_are_shared_unchanged(void **state)
{
    (void)state;
    enum { KINDS = 188, TIMES = 3, N = KINDS * TIMES };
    static fl_poly p[N], q[N];
    fl_topologies t = {0};
    fl_err err = {0};
    double separate_bytes = 0.0, shared_bytes = 0.0;
    for (int k = 0; k < N; k++) {
        prism(&p[k], 3 + k % KINDS, 1.0 + k);
        assert_int_equal(fl_poly_copy(&q[k], &p[k], &err), 0);
        separate_bytes += fl_poly_bytes(&q[k]);
        assert_int_equal(fl_topologies_share(&t, &q[k], FL_KEEP_ANGLES | FL_KEEP_OFFSETS, &err), 0);
        assert_same(&p[k], &q[k]);
        shared_bytes += fl_poly_bytes(&q[k]);
    }
    assert_int_equal(t.n, KINDS);
    for (int k = KINDS; k < N; k++) assert_ptr_equal(q[k].loop, q[k - KINDS].loop);
    assert_true(shared_bytes + fl_topologies_bytes(&t) < 0.75 * separate_bytes);
    for (int k = 0; k < N; k++) {
        fl_poly r = {0};
        assert_same(&p[k], &q[k]); /* independent of later additions */
        assert_int_equal(fl_poly_copy(&r, &q[k], &err), 0);
        assert_same(&p[k], &r);
        fl_poly_free(&p[k]), fl_poly_free(&q[k]), fl_poly_free(&r);
    }
    fl_topologies_free(&t);
}

/* Without angles: a copy has them again. */
static void points_segments_and_outer_shapes_are_shared(void **state)
{
    (void)state;
    const fl_vec3 v[2] = {{1, 2, 3}, {4, 5, 6}};
    fl_topologies t = {0};
    fl_err err = {0};
    for (int nv = 1; nv <= 3; nv++) {
        fl_poly p = {0}, q = {0}, r = {0};
        if (nv < 3) assert_int_equal(fl_poly_make(&p, nv, v, 0, NULL, NULL, &err), 0);
        else prism(&p, 5, 2.0);
        assert_int_equal(fl_poly_copy(&q, &p, &err), 0);
        assert_int_equal(fl_topologies_share(&t, &q, FL_KEEP_OFFSETS, &err), 0);
        assert_null(q.bend);
        assert_null(q.defect);
        assert_int_equal(fl_poly_copy(&r, &q, &err), 0);
        assert_same(&p, &r);
        fl_poly_free(&p), fl_poly_free(&q), fl_poly_free(&r);
    }
    assert_int_equal(t.n, 3);
    fl_topologies_free(&t);
}

/* A prism with sharp angles only, one with four others, and one that has too many. */
static void only_some_angles_are_stored(void **state)
{
    (void)state;
    const double turn[3] = {1.0, 0.3, 0.2};
    fl_topologies t = {0};
    fl_err err = {0};
    for (int way = 0; way < 4; way++) {
        fl_poly p = {0}, q = {0};
        if (way < 3) { /* a kite: its edge turns by this much across a corner */
            const double a = turn[way], b = (2.0 * PI - a) / 3.0;
            fl_vec3 xy[4] = {{0, 0, 0}, {1, 0, 0}};
            double at = 0.0;
            for (int k = 1; k < 3; k++) {
                at += k == 1 ? a : b;
                xy[k + 1] = v3_madd(xy[k], k == 1 ? 1.0 : 1.2, v3(cos(at), sin(at), 0));
            }
            assert_int_equal(fl_poly_prism(&p, 4, xy, -0.5, 0.5, &err), 0);
        } else prism(&p, 20, 1.0);
        assert_int_equal(fl_poly_copy(&q, &p, &err), 0);
        assert_int_equal(fl_topologies_share(&t, &q, FL_KEEP_ANGLES | FL_KEEP_OFFSETS, &err), 0);
        int blunt = 0;
        for (int32_t e = 0; e < p.ne; e++) blunt += p.bend[e] < FL_POLY_BLUNT_EDGE;
        for (int32_t v = 0; v < p.nv; v++) blunt += p.defect[v] < FL_POLY_BLUNT_CORNER;
        assert_int_equal(blunt, way == 3 ? 40 : way == 2 ? 3 : way == 1 ? 2 : 0);
        assert_int_equal(q.kept_angles, way == 3 ? 0 : blunt);
        assert_true(!q.bend == (way < 3) && !q.defect == (way < 3));
        assert_same(&p, &q);
        fl_poly r = {0};
        assert_int_equal(fl_poly_copy(&r, &q, &err), 0);
        assert_same(&p, &r);
        fl_poly_free(&q), fl_poly_free(&r);
        assert_int_equal(fl_poly_copy(&q, &p, &err), 0);
        assert_int_equal(fl_topologies_share(&t, &q, FL_KEEP_ANGLES, &err), 0); /* and without offsets */
        assert_null(q.c);
        assert_int_equal(fl_poly_copy(&r, &q, &err), 0);
        assert_same(&p, &r);
        fl_poly_free(&p), fl_poly_free(&q), fl_poly_free(&r);
    }
    fl_topologies_free(&t);
}

static void allocation_failure_changes_nothing(void **state)
{
    (void)state;
    fl_topologies t = {0};
    fl_poly p = {0}, q = {0};
    fl_err err = {0};
    int refused = 0;
    prism(&p, 6, 1.0), prism(&q, 6, 1.0);
    for (long k = 0; k < 10; k++) {
        fl_err lost = {0};
        fl_alloc_fail_after(k);
        const int rc = fl_topologies_share(&t, &q, FL_KEEP_ANGLES | FL_KEEP_OFFSETS, &lost);
        fl_alloc_fail_after(-1);
        assert_same(&p, &q);
        if (rc == 0) break;
        assert_int_equal(lost.code, FL_SYSTEM);
        refused++;
    }
    assert_true(refused >= 2);
    assert_int_equal(q.shared, 1);
    assert_int_equal(fl_topologies_share(&t, &q, FL_KEEP_ANGLES | FL_KEEP_OFFSETS, &err), 0); /* again */
    assert_same(&p, &q);
    fl_poly_free(&p), fl_poly_free(&q);
    fl_topologies_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(equal_shapes_are_shared_unchanged),
                                       cmocka_unit_test(points_segments_and_outer_shapes_are_shared),
                                       cmocka_unit_test(only_some_angles_are_stored),
                                       cmocka_unit_test(allocation_failure_changes_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
