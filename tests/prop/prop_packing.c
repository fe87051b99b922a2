/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Packings of random regions and gradings: nobody outside, no overlap below jamming, the solid part asked,
 * the same bits for any number of threads and after a state was written and read. */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "support/near.h"
#include "base/parallel.h"
#include "base/pi.h"
#include "base/rng.h"
#include "pack/packing_certificate.h"
#include "pack/packing_state.h"
#include "pack/throwing.h"

typedef struct {
    fl_pack_region region;
    fl_pack_shapes shapes;
    fl_packing p;
    fl_overlaps o;
    fl_growth g;
} sample;

static void make_sample(sample *s, uint64_t k, const char *shape)
{
    const fl_growth_options opt = fl_growth_defaults();
    fl_rng r = fl_rng_of(test_seed(), (int64_t)k, FL_RNG_TEST);
    const int dim = strcmp(shape, "sphere") == 0 && k % 2 ? 2 : 3;
    const double a = fl_rng_in(&r, 2.0, 3.0), b = fl_rng_in(&r, 2.0, 3.0), c = fl_rng_in(&r, 2.0, 3.0);
    const double solid = dim == 2 ? fl_rng_in(&r, 0.5, 0.75) : fl_rng_in(&r, 0.25, 0.4);
    const double v = dim == 2 ? PI / 4.0 : PI / 6.0;
    char in[200], law[100];
    fl_grading g = {0};
    fl_err err = {0};
    double *d;
    int32_t n, empty;
    int halved;
    if (k % 3 == 0) snprintf(in, sizeof in, "cylinder:%.17g,0,%.17g,1,2", 0.5 * a, b);
    else if (k % 3 == 1) snprintf(in, sizeof in, "box:0,0,0,%.17g,%.17g,%.17g", a, b, c);
    else snprintf(in, sizeof in, "sphere:%.17g,0,0,0", 0.5 * a);
    snprintf(law, sizeof law, "uniform:%.17g,%.17g", dim == 2 ? 0.2 : 0.5, dim == 2 ? 0.4 : 0.7);
    assert_int_equal(fl_region_make(&s->region, in, dim, "", &err), 0);
    assert_int_equal(fl_pack_shapes_make(&s->shapes, shape, &err), 0);
    assert_int_equal(fl_grading_law(&g, law, dim, &err), 1);
    const double unit = dim == 2 ? v : s->shapes.shape[0].volume;
    assert_int_equal(fl_grading_draw(&g, dim, unit, solid * s->region.volume, 0, &d, &n, &empty, &err), 0);
    assert_int_equal(fl_packing_make(&s->p, dim, n, d, &s->shapes, k, &err), 0);
    assert_int_equal(fl_throw_bodies(&s->p, &s->region, NULL, FL_THROW_REJECTION, k, &halved, &err), 0);
    assert_int_equal(fl_packing_sort(&s->p, &err), 0);
    assert_int_equal(fl_overlaps_make(&s->o, &s->p, &s->region, &err), 0);
    s->g = fl_growth_start(&opt);
    assert_true(fabs(fl_packing_volume(&s->p, 1.0, 0) / s->region.volume - solid) < 1e-9);
    free(d);
    fl_grading_free(&g);
}

static void grow_sample(sample *s)
{
    const fl_growth_options opt = fl_growth_defaults();
    fl_err err = {0};
    while (s->g.phase != FL_GROWTH_DONE) assert_int_equal(fl_growth_stage(&s->g, &s->o, &opt, &err), 0);
}

static uint64_t hash_sample(const sample *s)
{
    uint64_t h = fl_hash(FL_HASH_START, s->p.x, (int64_t)s->p.n * (int64_t)sizeof *s->p.x);
    if (s->p.q) h = fl_hash(h, s->p.q, (int64_t)s->p.n * (int64_t)sizeof *s->p.q);
    return fl_hash(h, &s->p.s, sizeof s->p.s);
}

static void free_sample(sample *s)
{
    fl_overlaps_free(&s->o);
    fl_packing_free(&s->p);
    fl_pack_shapes_free(&s->shapes);
    fl_region_free(&s->region);
}

static void nobody_is_outside_or_overlaps(void **state)
{
    (void)state;
    for (uint64_t k = 0; k < 9; k++) {
        sample s = {0};
        fl_packing_certificate c;
        fl_err err = {0};
        make_sample(&s, k, k < 6 ? "sphere" : "capsule:1.5");
        grow_sample(&s);
        assert_int_equal(fl_packing_certify(&c, &s.o, NULL, &err), 0);
        if (s.g.jammed) printf("case %d jams at %.4f\n", (int)k, c.solid);
        assert_true(c.room > 1.0 - 1e-3);
        assert_int_equal(c.outside, 0);
        if (!(c.max_overlap < (s.g.jammed ? 1e-2 : 1e-6)))
            printf("case %d: overlap %g\n", (int)k, c.max_overlap);
        assert_true(c.max_overlap < (s.g.jammed ? 1e-2 : 1e-6));
        /* by brute force: no two spheres overlap */
        for (int32_t i = 0; !s.p.q && i < s.p.n; i++)
            for (int32_t j = 0; j < i; j++) {
                const double gap = v3_norm(fl_region_wrap(&s.region, v3_sub(s.p.x[i], s.p.x[j]))) -
                                   s.p.s * (s.p.radius[i] + s.p.radius[j]);
                assert_true(gap > -1e-2 * s.p.radius[i]);
                if (!s.g.jammed) assert_true(gap > -1e-6 * s.p.radius[i]);
            }
        free_sample(&s);
    }
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    for (int shape = 0; shape < 2; shape++) {
        uint64_t first = 0;
        for (int t = 1; t <= 3; t++) {
            sample s = {0};
            omp_set_num_threads(t);
            make_sample(&s, 4, shape ? "capsule:1.5" : "sphere");
            grow_sample(&s);
            if (t == 1) first = hash_sample(&s);
            assert_true(hash_sample(&s) == first);
            free_sample(&s);
        }
    }
    omp_set_num_threads(1);
}

static void a_state_goes_on_to_the_same_bits(void **state)
{
    (void)state;
    const fl_growth_options opt = fl_growth_defaults();
    const char *path = test_path("packing.state");
    fl_err err = {0};
    sample whole = {0};
    make_sample(&whole, 7, "capsule:2");
    grow_sample(&whole);
    for (int stages = 0; stages < 70; stages += 31) {
        sample part = {0}, rest = {0};
        make_sample(&part, 7, "capsule:2");
        for (int k = 0; k < stages; k++) assert_int_equal(fl_growth_stage(&part.g, &part.o, &opt, &err), 0);
        assert_int_equal(fl_packing_state_write(&part.p, &part.g, 5, path, &err), 0);
        make_sample(&rest, 7, "capsule:2");
        assert_int_equal(fl_packing_state_read(&rest.p, &rest.g, 6, path, &err), -1);
        err = (fl_err){0};
        assert_int_equal(fl_packing_state_read(&rest.p, &rest.g, 5, path, &err), 0);
        grow_sample(&rest);
        assert_true(hash_sample(&rest) == hash_sample(&whole));
        free_sample(&part);
        free_sample(&rest);
    }
    free_sample(&whole);
    remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nobody_is_outside_or_overlaps),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(a_state_goes_on_to_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
