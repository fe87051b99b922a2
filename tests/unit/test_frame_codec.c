/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Packed frames: bounds of errors, orders, keys. */
#include <string.h>
#include "base/rng.h"
#include "out/frame_codec.h"
#include "support/near.h"

enum { N = 40, FRAMES = 50, KEY_EVERY = 16 };
static fl_err err;

static fl_quat random_turn(fl_rng *g)
{
    return q_unit((fl_quat){fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g)});
}

/* Angle of the rotation from a to b. */
static double angle_between(fl_quat a, fl_quat b)
{
    const fl_quat d = q_mul(a, q_conj(b));
    return 2.0 * atan2(v3_norm(v3(d.x, d.y, d.z)), fabs(d.w));
}

/* Encodes a frame, hands its planes to a reader of its own, and returns the largest errors. */
static void through(fl_frame_codec *w, fl_frame_codec *r, int32_t n, const int32_t *id, const fl_vec3 *x,
                    const fl_quat *q, double *dx, double *dq, int *order)
{
    assert_int_equal(fl_frame_codec_encode(w, n, id, x, q, KEY_EVERY, order, &err), 0);
    const int is_key = w->since_key == 1;
    assert_int_equal(w->planes_len, fl_frame_codec_size(n, is_key));
    assert_int_equal(fl_frame_codec_room(r, n, &err), 0);
    memcpy(r->planes, w->planes, (size_t)w->planes_len);
    assert_int_equal(fl_frame_codec_decode(r, n, is_key, *order), 0);
    for (int32_t i = 0; i < n; i++) {
        const fl_vec3 d = v3_sub(fl_frame_codec_place(r, i), x[i]);
        *dx = fmax(*dx, fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z))));
        *dq = fmax(*dq, angle_between(fl_frame_codec_rotation(r, i), q[i]));
        assert_int_equal(r->id[i], id[i]);
    }
}

/* Bodies that drift and spin; at each bound the errors stay below it, and come near it. */
static void errors_stay_below_the_bounds(void **state)
{
    (void)state;
    const double bound[3] = {1e-6, 1e-5, 1e-3};
    for (int b = 0; b < 3; b++) {
        fl_frame_codec w = {.bound_x = bound[b], .bound_q = bound[b]}, r = w;
        fl_rng g = fl_rng_of(test_seed(), b, FL_RNG_TEST);
        int32_t id[N];
        fl_vec3 x[N], v[N], spin[N];
        fl_quat q[N];
        double dx = 0.0, dq = 0.0;
        int order, keys = 0, seconds = 0;
        for (int i = 0; i < N; i++) {
            id[i] = 7 * ((i * 13) % N) + 3; /* in no order */
            x[i] = v3(fl_rng_in(&g, -50, 50), fl_rng_in(&g, -50, 50), fl_rng_in(&g, -1, 1));
            v[i] = v3(fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1), 0);
            spin[i] = v3(fl_rng_normal(&g), fl_rng_normal(&g), fl_rng_normal(&g));
            q[i] = random_turn(&g);
        }
        for (int k = 0; k < FRAMES; k++) {
            through(&w, &r, N, id, x, q, &dx, &dq, &order);
            keys += order == 0;
            seconds += order == 2;
            for (int i = 0; i < N; i++) {
                x[i] = v3_madd(x[i], 0.1, v[i]);
                q[i] = q_unit(q_mul(q_of_vector(v3_scale(0.1, spin[i])), q[i]));
            }
        }
        /* A double of 50 m has a rounding of 7e-15 m. */
        assert_true(dx <= bound[b] * (1 + 1e-8) && dx > 0.9 * bound[b]);
        assert_true(dq <= bound[b] && dq > 0.3 * bound[b]);
        assert_int_equal(keys, (FRAMES + KEY_EVERY - 1) / KEY_EVERY);
        assert_true(seconds > FRAMES / 2);
        fl_frame_codec_free(&w);
        fl_frame_codec_free(&r);
    }
}

/* Another set of bodies, another order of them: a key. */
static void other_bodies_make_a_key(void **state)
{
    (void)state;
    fl_frame_codec w = {.bound_x = 1e-5, .bound_q = 1e-5}, r = w;
    int32_t id[3] = {1, 2, 5};
    const fl_vec3 x[3] = {{0, 0, 0}, {1, 2, 3}, {-4, 5, 6}};
    const fl_quat q[3] = {{1, 0, 0, 0}, {0, -1, 0, 0}, {0.5, -0.5, 0.5, -0.5}};
    double dx = 0, dq = 0;
    int order;
    through(&w, &r, 3, id, x, q, &dx, &dq, &order);
    assert_int_equal(order, 0);
    through(&w, &r, 3, id, x, q, &dx, &dq, &order);
    assert_int_equal(order, 1);
    through(&w, &r, 2, id, x, q, &dx, &dq, &order);
    assert_int_equal(order, 0);
    id[0] = 2;
    id[1] = 1;
    through(&w, &r, 2, id, x, q, &dx, &dq, &order);
    assert_int_equal(order, 0);
    w.since_key = 0; /* after a checkpoint */
    through(&w, &r, 2, id, x, q, &dx, &dq, &order);
    assert_int_equal(order, 0);
    through(&w, &r, 0, id, x, q, &dx, &dq, &order);
    assert_int_equal(order, 0);
    fl_frame_codec_free(&w);
    fl_frame_codec_free(&r);
}

/* What lies beyond 32 bits is refused by name, as is an order that nothing is before. */
static void what_does_not_fit_is_refused(void **state)
{
    (void)state;
    fl_frame_codec w = {.bound_x = 1e-5, .bound_q = 1e-5};
    const int32_t id[1] = {77};
    const fl_vec3 far[1] = {{43000, 0, 0}};
    const fl_quat q[1] = {{1, 0, 0, 0}};
    fl_err e = {0};
    int order;
    assert_int_equal(fl_frame_codec_encode(&w, 1, id, far, q, KEY_EVERY, &order, &e), -1);
    assert_non_null(strstr(e.text, "body 77 is beyond 42949.7 m"));
    assert_int_equal(fl_frame_codec_room(&w, 1, &err), 0);
    assert_int_equal(fl_frame_codec_decode(&w, 1, 0, 1), -1);
    assert_int_equal(fl_frame_codec_decode(&w, 1, 1, 2), -1);
    fl_frame_codec_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_stay_below_the_bounds),
        cmocka_unit_test(other_bodies_make_a_key),
        cmocka_unit_test(what_does_not_fit_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
