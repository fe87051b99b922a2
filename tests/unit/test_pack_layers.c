/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Layers of a region: their parts by hand, the sizes drawn in each, and where bodies are thrown. */
#include <math.h>
#include <stdlib.h>
#include "support/near.h"
#include "base/pi.h"
#include "pack/throwing.h"

typedef struct {
    fl_pack_region region;
    fl_pack_layers layers;
    fl_grading rest, all;
} sample;

static void make_sample(sample *s)
{
    fl_err err = {0};
    *s = (sample){0};
    assert_int_equal(fl_region_make(&s->region, "box:0,0,0,4,3,5", 3, "", &err), 0);
    assert_int_equal(fl_grading_law(&s->rest, "single:0.5", 3, &err), 1);
    /* a ball, and the part of a slab of 2 m that it leaves */
    assert_int_equal(fl_pack_layers_add(&s->layers, "sphere:1,2,1.5,1=single:0.2", 3, 0, &err), 0);
    assert_int_equal(fl_pack_layers_add(&s->layers, "box:-9,-9,-9,9,9,2=uniform:0.2,0.4", 3, 0, &err), 0);
    assert_int_equal(fl_pack_layers_measure(&s->layers, &s->region, &s->rest, &s->all, &err), 0);
}

static void free_sample(sample *s)
{
    fl_pack_layers_free(&s->layers);
    fl_grading_free(&s->rest);
    fl_grading_free(&s->all);
    fl_region_free(&s->region);
}

static void parts_are_those_of_the_volume(void **state)
{
    (void)state;
    sample s;
    make_sample(&s);
    const double ball = 4.0 / 3.0 * PI / 60.0;
    assert_near_of(s.layers.part[0], ball, 3e-4, 1.0);
    assert_near_of(s.layers.part[1], 0.4 - ball, 3e-4, 1.0);
    assert_near(s.layers.part[0] + s.layers.part[1] + s.layers.part[2], 1.0, 1e-14);
    assert_int_equal(fl_pack_layers_find(&s.layers, v3(2, 1.5, 1.9)), 0);
    assert_int_equal(fl_pack_layers_find(&s.layers, v3(0.5, 0.5, 1.9)), 1);
    assert_int_equal(fl_pack_layers_find(&s.layers, v3(2, 1.5, 2.1)), 2);
    /* the curve of all: 0.2 m from both, 0.5 m from the rest */
    assert_near(fl_grading_mass(&s.all, 3, 0.45), s.layers.part[0] + s.layers.part[1], 1e-14);
    free_sample(&s);
}

static void each_layer_has_its_sizes_and_its_volume(void **state)
{
    (void)state;
    sample s;
    fl_err err = {0};
    double *d, volume[3] = {0};
    int32_t n, empty;
    const double v = PI / 6.0;
    make_sample(&s);
    assert_int_equal(fl_pack_layers_draw(&s.layers, 3, v, 0.3 * 60.0, &d, &n, &empty, &err), 0);
    for (int32_t i = 0; i < n; i++) {
        const int32_t k = s.layers.of[i];
        volume[k] += v * pow(d[i], 3);
        assert_true(i == 0 || d[i] <= d[i - 1]);
        assert_true(k == 1 ? d[i] > 0.199 && d[i] < 0.401 : fabs(d[i] - (k == 0 ? 0.2 : 0.5)) < 2e-3);
    }
    for (int k = 0; k < 3; k++) assert_near(volume[k] / 18.0, s.layers.part[k], 1e-12);
    /* and is thrown there */
    fl_pack_shapes shapes;
    fl_packing p;
    int halved;
    assert_int_equal(fl_pack_shapes_make(&shapes, "sphere", &err), 0);
    assert_int_equal(fl_packing_make(&p, 3, n, d, &shapes, 1, &err), 0);
    assert_int_equal(fl_throw_bodies(&p, &s.region, &s.layers, FL_THROW_REJECTION, 1, &halved, &err), 0);
    for (int32_t i = 0; i < n; i++) assert_int_equal(fl_pack_layers_find(&s.layers, p.x[i]), s.layers.of[i]);
    free(d);
    fl_packing_free(&p);
    fl_pack_shapes_free(&shapes);
    free_sample(&s);
}

static void a_layer_that_holds_nothing_is_refused(void **state)
{
    (void)state;
    sample s;
    fl_err err = {0};
    fl_grading all;
    make_sample(&s);
    assert_int_equal(fl_pack_layers_measure(&s.layers, &s.region, NULL, &all, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    fl_grading_free(&all);
    err = (fl_err){0};
    assert_int_equal(fl_pack_layers_add(&s.layers, "box:1,1,0,2,2,1=single:0.2", 3, 0, &err), 0);
    assert_int_equal(fl_pack_layers_measure(&s.layers, &s.region, &s.rest, &all, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    fl_grading_free(&all);
    static const char *const BAD[] = {"box:0,0,0,1,1,1", "=single:1", "box:0,0,0,1,1,1=single:0",
                                      "box:0,0,0,1,1=single:1"};
    for (int k = 0; k < 4; k++) {
        err = (fl_err){0};
        assert_int_equal(fl_pack_layers_add(&s.layers, BAD[k], 3, 0, &err), -1);
        assert_int_equal(err.code, FL_USAGE);
    }
    free_sample(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_are_those_of_the_volume),
        cmocka_unit_test(each_layer_has_its_sizes_and_its_volume),
        cmocka_unit_test(a_layer_that_holds_nothing_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
