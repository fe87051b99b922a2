/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes of rounded shapes: closed, outward, with the volume of Steiner's formula in the limit. */
#include <stdlib.h>
#include "base/pi.h"
#include "geom/dilate.h"
#include "support/near.h"
#include "view/rounded_mesh.h"

static fl_err err;

static void shape_of_poly(fl_frame_data *d, const fl_poly *p, double radius)
{
    assert_int_equal(fl_frame_data_add_shape(d, 1, radius, 0, &err), 0);
    for (int32_t v = 0; v < p->nv; v++) assert_int_equal(fl_frame_data_add_vertex(d, p->v[v], &err), 0);
    for (int32_t f = 0; f < p->nf; f++)
        assert_int_equal(
            fl_frame_data_add_face(d, p->loop + p->first[f], p->first[f + 1] - p->first[f], &err), 0);
}

static int compare_sides(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Every side is met once in each direction.  Vertices are compared by their place, since rings share no
 * vertices. */
static int open_sides(const fl_rounded_mesh *m)
{
    uint32_t *same = malloc((size_t)m->nv * sizeof *same);
    uint64_t *side = malloc(3 * (size_t)m->nt * sizeof *side);
    int n = 0, open = 0;
    for (int32_t v = 0; v < m->nv; v++) {
        same[v] = (uint32_t)v;
        for (int32_t u = 0; u < v; u++) {
            const float *a = m->v[u].x, *b = m->v[v].x;
            if (fabsf(a[0] - b[0]) + fabsf(a[1] - b[1]) + fabsf(a[2] - b[2]) < 1e-5f) {
                same[v] = same[u];
                break;
            }
        }
    }
    for (int32_t t = 0; t < m->nt; t++)
        for (int k = 0; k < 3; k++) {
            const uint64_t a = same[m->t[3 * t + k]], b = same[m->t[3 * t + (k + 1) % 3]];
            if (a != b) side[n++] = a << 32 | b;
        }
    qsort(side, (size_t)n, sizeof *side, compare_sides);
    for (int k = 0; k < n; k++) {
        const uint64_t other = side[k] << 32 | side[k] >> 32;
        open += !bsearch(&other, side, (size_t)n, sizeof *side, compare_sides);
    }
    free(same);
    free(side);
    return open;
}

static double volume_at(const fl_frame_data *d, int cuts, int *open)
{
    fl_rounded_mesh m = {0};
    assert_int_equal(fl_rounded_mesh_shape(&m, d, &d->shape[0], cuts, &err), 0);
    for (int32_t v = 0; v < m.nv; v++) {
        const float *n = m.v[v].n;
        assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0f) < 1e-5f);
    }
    *open = open_sides(&m);
    const double volume = fl_rounded_mesh_volume(&m);
    fl_rounded_mesh_free(&m);
    return volume;
}

/* The error of chords falls with the square of the cuts: from 3 to 6 by 4, within a fifth. */
static void volumes_converge_to_steiner(void **state)
{
    (void)state;
    fl_poly p[2] = {{0}};
    const fl_vec3 corner[5] = {{-1, -1, 0}, {1, -0.8, 0}, {1.4, 0.5, 0}, {0.2, 1.3, 0}, {-1.1, 0.7, 0}};
    assert_int_equal(fl_poly_box(&p[0], v3(1, 0.7, 0.3), &err), 0);
    assert_int_equal(fl_poly_prism(&p[1], 5, corner, -0.2, 0.3, &err), 0);
    for (int k = 0; k < 2; k++) {
        fl_frame_data d = {0};
        double miss[2];
        int open;
        shape_of_poly(&d, &p[k], 0.25);
        const double exact = fl_dilate_volume(&p[k], 0.25);
        const double coarse = volume_at(&d, 1, &open);
        assert_int_equal(open, 0);
        assert_true(coarse < exact && coarse > 0.9 * exact);
        for (int j = 0; j < 2; j++) {
            miss[j] = exact - volume_at(&d, j ? 6 : 3, &open);
            assert_int_equal(open, 0);
            assert_true(miss[j] > 0.0);
        }
        assert_true(miss[0] / miss[1] > 3.2 && miss[0] / miss[1] < 4.8);
        fl_frame_data_free(&d);
        fl_poly_free(&p[k]);
    }
}

/* A sphere and a capsule; their meshes have 14 rings at 6 cuts, so that chords take 2 to 3 per cent. */
static void round_bodies_are_closed(void **state)
{
    (void)state;
    for (int nv = 1; nv <= 2; nv++) {
        fl_frame_data d = {0};
        int open;
        const double r = 0.5, l = nv == 2 ? 3.0 : 0.0;
        assert_int_equal(fl_frame_data_add_shape(&d, 1, r, 0, &err), 0);
        for (int k = 0; k < nv; k++)
            assert_int_equal(fl_frame_data_add_vertex(&d, v3(k ? l : 0, 0, 0), &err), 0);
        const double exact = 4.0 / 3.0 * PI * r * r * r + PI * r * r * l, v = volume_at(&d, 6, &open);
        assert_int_equal(open, 0);
        assert_true(v < exact && v > 0.96 * exact);
        fl_frame_data_free(&d);
    }
}

/* A cone of the structure: volume within its chord, and closed. */
static void cones_are_closed(void **state)
{
    (void)state;
    fl_surface s = {0};
    fl_rounded_mesh m = {0};
    assert_int_equal(fl_surface_add(&s, "leg", 3, &err), 0);
    assert_int_equal(fl_surface_cone(&s.part[0], (fl_cone){v3(0, 0, -1), v3(0, 0, 2), 2.0, 0.5}, &err), 0);
    assert_int_equal(fl_rounded_mesh_part(&m, &s.part[0], 1e-3, &err), 0);
    const double exact = PI * 3.0 / 3.0 * (4.0 + 1.0 + 0.25), v = fl_rounded_mesh_volume(&m);
    assert_int_equal(open_sides(&m), 0);
    assert_true(v < exact && v > exact * (1 - 4 * 1e-3));
    fl_rounded_mesh_free(&m);
    fl_surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(volumes_converge_to_steiner),
        cmocka_unit_test(round_bodies_are_closed),
        cmocka_unit_test(cones_are_closed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
