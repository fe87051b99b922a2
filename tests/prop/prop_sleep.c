/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sleeping floes, ballistic and resting: their error, detection of every contact, waking, and equal bits
 * for any threads, stops and evaluations in between. */
#define _GNU_SOURCE /* open_memstream */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "sim/energy_balance.h"
#include "support/near.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "narrow/gjk.h"
#include "sim/sleep.h"
#include "sim/snapshot.h"
#include "support/small_world.h"

#define RADIUS 0.03

enum { SIDE = 6, FLOES = SIDE * SIDE };

static int threads = 1;

enum sea { DRY, STILL, FACETS, WAVES, MASSES };

/* Square floes of 1 m on a grid, each with its own velocity, spin, tilt and height. */
static void make_floes(lab *l, enum sea sea, double pitch, double speed, uint64_t seed, double sleep)
{
    lab_start(l);
    lab_setf(l, "run.threads=%d", threads);
    if (sleep > 0.0) lab_setf(l, "run.sleep=%.17g", sleep);
    lab_set(l, "contact.stiffness_factor=0.001");
    lab_set(l, "contact.friction=0.2");
    lab_set(l, "contact.restitution=0.5");
    if (sea != DRY) {
        lab_set(l, "run.gravity=9.81");
        lab_set(l, "water.current=0.2 0.1 0");
    }
    if (sea == FACETS) {
        lab_set(l, "water.drag=facet");
        lab_set(l, "wind.velocity=8 3 0");
        lab_set(l, "wind.drag=facet");
    }
    if (sea == WAVES) {
        lab_set(l, "water.wave=airy");
        lab_set(l, "water.height=0.2");
        lab_set(l, "water.period=4");
        lab_set(l, "water.depth=20");
    }
    if (sea == MASSES) {
        lab_set(l, "water.added_mass=0.1 0.1 0.6");
        lab_set(l, "boundary.type=free periodic free");
        lab_setf(l, "boundary.min=none %g none", -0.5 * pitch);
        lab_setf(l, "boundary.max=none %g none", (SIDE - 0.5) * pitch);
    }
    for (int32_t k = 0; k < FLOES; k++) {
        fl_rng g = fl_rng_of(seed, k, FL_RNG_TEST);
        const fl_vec3 x =
            v3(pitch * (k % SIDE), pitch * (k / SIDE), sea == DRY ? 0 : fl_rng_in(&g, -0.03, 0.01));
        const fl_vec3 v = v3(fl_rng_in(&g, -speed, speed), fl_rng_in(&g, -speed, speed), 0);
        const fl_vec3 tilt = v3(fl_rng_in(&g, -0.03, 0.03), fl_rng_in(&g, -0.03, 0.03), fl_rng_in(&g, -1, 1));
        const double turn = sea == DRY ? 1.0 : 0.2;
        const fl_vec3 spin = v3(0.1 * turn, fl_rng_in(&g, -turn, turn), fl_rng_in(&g, -turn, turn));
        lab_box(l, x, v3(0.5, 0.4, 0.12), RADIUS, q_of_vector(tilt), v, spin);
    }
    lab_make(l, 0);
}

static double largest_distance(const lab *a, const lab *b)
{
    double most = 0.0;
    for (int32_t k = 0; k < FLOES; k++) {
        const fl_quat d = q_mul(a->w.b.q[k], q_conj(b->w.b.q[k]));
        const double turned = 2.0 * sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        most = fmax(most, v3_norm(v3_sub(a->w.b.x[k], b->w.b.x[k])) + 0.6 * turned);
    }
    return most;
}

/* Without contacts the error of each step is below the tolerance, and that of a floe below the sum over its
 * steps, each propagated by all later ones. */
static void errors_stay_below_the_tolerance(void **state)
{
    enum { STEPS = 500 };
    const double tol[] = {1e-4, 1e-5};
    (void)state;
    for (int sea = DRY; sea <= MASSES; sea++) {
        lab off;
        make_floes(&off, (enum sea)sea, 4.0, 0.05, test_seed(), 0.0);
        assert_int_equal(lab_run(&off, STEPS), 0);
        assert_int_equal(off.w.contact_steps, 0);
        for (int k = 0; k < 2; k++) {
            lab on;
            make_floes(&on, (enum sea)sea, 4.0, 0.05, test_seed(), tol[k]);
            assert_int_equal(lab_run(&on, STEPS), 0);
            const fl_sleep_totals c = fl_sleep_sum_totals(&on.w);
            const double naps = (double)c.n_skips / FLOES;
            fl_sleep_advance_to_now(&on.w);
            if (k == 0) assert_true((double)c.ballistic_steps > 0.9 * STEPS * FLOES && naps < STEPS / 4.0);
            assert_true(c.max_error <= tol[k] &&
                        largest_distance(&on, &off) <= RADIUS * (naps * c.max_error_sum + tol[k]));
            lab_free(&on);
        }
        lab_free(&off);
    }
}

/* The distance of cores i and j in one cell. */
static double core_distance(const fl_world *w, int32_t i, int32_t j)
{
    const fl_bodies *b = &w->b;
    fl_vec3 a[16], c[16];
    fl_gap gap;
    for (int32_t v = 0; v < b->core[i].nv; v++) a[v] = m3_mul(fl_body_axes(b, i), b->core[i].v[v]);
    for (int32_t v = 0; v < b->core[j].nv; v++)
        c[v] = v3_add(v3_sub(b->x[j], b->x[i]), m3_mul(fl_body_axes(b, j), b->core[j].v[v]));
    fl_gjk((fl_core){a, b->core[i].nv, NULL}, (fl_core){c, b->core[j].nv, NULL}, NULL, &gap);
    return gap.overlap ? 0.0 : gap.d;
}

/* All pairs of all floes, checked repeatedly: pairs that overlap are in the list of touching pairs. */
static void every_contact_is_detected(void **state)
{
    int64_t touched = 0;
    (void)state;
    for (int sea = DRY; sea <= WAVES; sea += 1 + (sea == STILL)) {
        lab l;
        make_floes(&l, (enum sea)sea, 1.2, 0.5, test_seed() + (uint64_t)sea, 1e-4);
        for (int sample = 0; sample < 24; sample++) {
            uint8_t live[FLOES][FLOES] = {{0}};
            assert_int_equal(lab_run(&l, 41), 0);
            for (int32_t c = 0; c < l.w.n_touching; c++) {
                const fl_pair *p = l.w.pair[l.w.touching_pairs[c]].contact;
                live[p->i][p->j] = 1;
                touched++;
            }
            const uint64_t before = fl_state_hash(&l.w);
            fl_sleep_advance_to_now(&l.w);
            for (int32_t i = 0; i < FLOES; i++)
                for (int32_t j = i + 1; j < FLOES; j++)
                    if (core_distance(&l.w, i, j) < 2.0 * RADIUS * (1.0 - 1e-9)) assert_true(live[i][j]);
            fl_sleep_restore(&l.w);
            assert_true(fl_state_hash(&l.w) == before);
        }
        assert_true(fl_sleep_sum_totals(&l.w).ballistic_steps > 1000);
        lab_free(&l);
    }
    assert_true(touched > 100);
}

/* Five blocks on a floor, and one that slides into them when they are at rest. */
static void make_heap(lab *l, double sleep)
{
    lab_start(l);
    if (sleep > 0.0) lab_setf(l, "run.sleep=%.17g", sleep);
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "contact.stiffness_factor=0.02");
    lab_set(l, "contact.friction=0.4");
    lab_set(l, "contact.restitution=0.1");
    lab_set(l, "boundary.type=free free rigid");
    lab_set(l, "boundary.min=none none 0");
    for (int k = 0; k < 5; k++)
        lab_box(l, v3(1.2 * (k % 3), 0, 0.25 + 0.5 * (k / 3)), v3(0.5, 0.5, 0.25), RADIUS, q_one(),
                v3(0, 0, 0), v3(0, 0, 0));
    lab_box(l, v3(4.6, 0, 0.25), v3(0.5, 0.5, 0.25), RADIUS, q_one(), v3(-5, 0, 0), v3(0, 0, 0));
    lab_make(l, 0);
}

static void rest_and_wake(void **state)
{
    const double tol = 1e-3;
    lab off, on;
    int32_t most = 0, woken = 0;
    (void)state;
    make_heap(&off, 0.0);
    make_heap(&on, tol);
    for (int k = 0; k < 300; k++) {
        const int32_t before = on.w.sleep.n_resting;
        assert_int_equal(lab_run(&off, 16), 0);
        assert_int_equal(lab_run(&on, 16), 0);
        fl_sleep_advance_to_now(&on.w);
        for (int32_t i = 0; i < 5 && woken == 0; i++)
            assert_true(v3_norm(v3_sub(on.w.b.x[i], off.w.b.x[i])) < 4.0 * tol * RADIUS);
        fl_sleep_restore(&on.w);
        for (int32_t i = 0; i < on.w.n;
             i++) /* bodies that are awake are checked again soon, also after a rest */
            assert_true(on.w.sleep.phase[i] != FL_AWAKE || on.w.sleep.phase_end[i] <= on.w.step + 100);
        most = on.w.sleep.n_resting > most ? on.w.sleep.n_resting : most;
        woken += on.w.sleep.n_resting == 0 && before >= 3;
    }
    const fl_sleep_totals c = fl_sleep_sum_totals(&on.w);
    assert_true(most >= 3 && woken > 0 && c.resting_steps > 1000);
    assert_true(on.w.b.x[2].x < 2.4 - 0.01 && fabs(on.w.b.x[2].x - off.w.b.x[2].x) < 0.1);
    lab_free(&on);
    lab_free(&off);
}

enum { LEVELS = 5 };

/* Blocks on one another, numbered so that changes propagate along the list of pairs neither upward nor
 * downward. */
static void make_stack(lab *l)
{
    lab_start(l);
    lab_set(l, "run.sleep=1e-3");
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "contact.stiffness_factor=0.02");
    lab_set(l, "contact.friction=0.4");
    lab_set(l, "contact.restitution=0.1");
    lab_set(l, "boundary.type=free free rigid");
    lab_set(l, "boundary.min=none none 0");
    static const int LEVEL[LEVELS] = {0, 1, 4, 3, 2};
    for (int k = 0; k < LEVELS; k++)
        lab_box(l, v3(0, 0, 0.25 + 0.5 * LEVEL[k]), v3(0.5, 0.5, 0.25), RADIUS, q_one(), v3(0, 0, 0),
                v3(0, 0, 0));
    lab_make(l, 0);
}

/* A body that touches one awake for less than a window waits for it, and is ready then.  Formerly each
 * waited for the other in turn. */
static void a_stack_comes_to_rest_in_any_order(void **state)
{
    (void)state;
    for (int late = 0; late < LEVELS; late++) {
        lab l;
        make_stack(&l);
        for (int k = 0; k < 500 && l.w.sleep.n_resting < LEVELS; k++) assert_int_equal(lab_run(&l, 64), 0);
        assert_int_equal(l.w.sleep.n_resting, LEVELS);
        fl_sleep_wake_resting(&l.w);
        assert_int_equal(lab_run(&l, 64), 0);
        l.w.sleep.state[late].window_odometer = -1.0;
        for (int k = 0; k < 20 && l.w.sleep.n_resting < LEVELS; k++) assert_int_equal(lab_run(&l, 64), 0);
        assert_int_equal(l.w.sleep.n_resting, LEVELS);
        lab_free(&l);
    }
}

/* Impulse on a shelf in two periods of a wave, over weight and time, from a block that lies on it at that
 * height. */
static double impulse_on_shelf(double top, double sleep, int64_t *rested)
{
    lab l;
    lab_start(&l);
    if (sleep > 0.0) lab_setf(&l, "run.sleep=%.17g", sleep);
    lab_set(&l, "run.gravity=9.81");
    lab_set(&l, "material.ice.young=10 MPa");
    lab_set(&l, "contact.restitution=0.1");
    lab_set(&l, "contact.friction=0.3");
    lab_set(&l, "boundary.type=free");
    lab_set(&l, "water.wave=airy");
    lab_set(&l, "water.height=1");
    lab_set(&l, "water.period=6");
    lab_wall(&l, v3(-3, -3, -3), v3(3, 3, top), 1);
    lab_box(&l, v3(0, 0, top + 0.3), v3(0.5, 0.5, 0.3), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 0);
    while (fl_world_time(&l.w) < 12.0) assert_int_equal(lab_run(&l, 10), 0);
    const double bears = -l.w.part_impulse[0].z / (l.w.b.m[0] * 9.81 * fl_world_time(&l.w));
    *rested = fl_sleep_sum_totals(&l.w).resting_steps;
    lab_free(&l);
    return bears;
}

/* The load of a block that waves reach follows them; above the waves it rests. */
static void waves_wake_wet_floes(void **state)
{
    int64_t none, some;
    (void)state;
    const double wet = impulse_on_shelf(0.1, 0.0, &none);
    assert_true(wet < 0.9);
    assert_near(impulse_on_shelf(0.1, 1e-5, &some), wet, 1e-3);
    assert_near(impulse_on_shelf(1.5, 1e-4, &some), impulse_on_shelf(1.5, 0.0, &none), 1e-3);
    assert_true(none == 0 && some > 0);
}

/* A block with a prescribed velocity that pushes another one keeps that velocity, however slow. */
static void bodies_of_prescribed_speed_do_not_rest(void **state)
{
    const double speed = 1e-4;
    fl_poly core = {0};
    fl_err err = {0};
    lab l;
    (void)state;
    lab_start(&l);
    lab_set(&l, "run.sleep=1e-3");
    lab_set(&l, "run.gravity=9.81");
    lab_set(&l, "material.ice.young=100 MPa");
    lab_set(&l, "contact.friction=0.3");
    lab_set(&l, "contact.restitution=0.1");
    lab_set(&l, "boundary.type=free free rigid");
    lab_set(&l, "boundary.min=none none 0");
    lab_set(&l, "group.push.fixed=x y rx ry rz");
    lab_setf(&l, "group.push.velocity=%g 0 0", speed);
    assert_int_equal(fl_poly_box(&core, v3(0.47, 0.47, 0.22), &err), 0);
    fl_poly_to_frame(&core, v3(0, 0, -0.25), q_matrix(q_one()));
    assert_int_equal(
        fl_ice_field_add(&l.field, 1, RADIUS, &core, NULL, "push", v3(speed, 0, 0), v3(0, 0, 0), &err), 0);
    lab_box(&l, v3(1, 0, 0.25), v3(0.5, 0.5, 0.25), RADIUS, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 0);
    assert_int_equal(lab_run(&l, (int64_t)(2.0 / l.w.dt)), 0);
    fl_sleep_advance_to_now(&l.w);
    assert_near(l.w.b.x[0].x, speed * fl_world_time(&l.w), 1e-6);
    lab_free(&l);
}

/* Time at which a thin box has fallen that stands on its rounded lower edge with an initial tilt [s]. */
static double time_of_fall(double tilt, double sleep)
{
    lab l;
    lab_start(&l);
    if (sleep > 0.0) lab_setf(&l, "run.sleep=%.17g", sleep);
    lab_set(&l, "run.gravity=9.81");
    lab_set(&l, "run.safety=0.2");
    lab_set(&l, "material.ice.young=100 MPa");
    lab_set(&l, "contact.friction=0.5");
    lab_set(&l, "contact.restitution=0.3");
    lab_set(&l, "boundary.type=free free rigid");
    lab_set(&l, "boundary.min=none none 0");
    const fl_vec3 none = v3(0, 0, 0);
    lab_box(&l, v3(0, 0, 0.5 - 2e-6), v3(0.5, 0.0501, 0.5), 0.05, q_about_axis(0, tilt), none, none);
    lab_make(&l, 0);
    while (l.w.b.x[0].z > 0.25 && fl_world_time(&l.w) < 60.0) assert_int_equal(lab_run(&l, 10), 0);
    const double t = fl_world_time(&l.w);
    lab_free(&l);
    return t;
}

/* A falling body does not rest on its way, though it starts so slowly that its displacement in a window is
 * very small: it fell at 6.5 s instead of 4.0. */
static void falling_bodies_do_not_rest(void **state)
{
    (void)state;
    const double t = time_of_fall(1e-6, 0.0), late = time_of_fall(1e-6, 1e-5);
    assert_true(t > 3.0 && t < 6.0);
    assert_true(late < 1.1 * t);
}

/* All state of a world: odometers, ledger and contact history.  It also contains a row that records whether
 * the ledger was queried in between; without: leave out that row. */
static uint64_t hash_of_all_state(fl_world *w, int without)
{
    char *text = NULL;
    size_t n = 0;
    FILE *f = open_memstream(&text, &n);
    assert_non_null(f);
    fl_snapshot_write(f, w);
    assert_int_equal(fclose(f), 0);
    char *const books = strstr(text, "\nbooks ") + 1, *const behind = strchr(books, '\n');
    const uint64_t before = fl_hash(FL_HASH_START, text, without ? books - text : behind - text),
                   h = fl_hash(before, behind, text + n - behind);
    free(text);
    return h;
}

/* One thread against two with stops, one of the runs queried all the time. */
static void threads_stops_and_queries_keep_the_bits(void **state)
{
    (void)state;
    for (int sea = DRY; sea <= MASSES + 1; sea++) {
        uint64_t first[2] = {0};
        for (int way = 0; way < 3; way++) {
            lab l, m;
            fl_err err = {0};
            fl_text in = {0};
            char *text = NULL;
            size_t n = 0;
            threads = way ? 2 : 1;
            for (int part = 0; part < 2; part++) {
                if (sea > MASSES) make_heap(part ? &m : &l, 1e-3);
                else make_floes(part ? &m : &l, (enum sea)sea, 1.2, 0.5, test_seed(), 1e-4);
            }

            const int64_t stop = sea > MASSES ? 901 : 251;
            for (int64_t k = 0; k < stop; k += 10) {
                assert_int_equal(lab_run(&l, k + 10 < stop ? 10 : stop - k), 0);
                if (way != 2) continue;
                fl_sleep_advance_to_now(&l.w);
                fl_energy_update(&l.w);
                fl_sleep_restore(&l.w);
            }
            FILE *f = open_memstream(&text, &n);
            assert_non_null(f);
            fl_snapshot_write(f, &l.w);
            assert_int_equal(fclose(f), 0);
            assert_int_equal(fl_text_open_bytes(&in, "snapshot", text, (int64_t)n, &err), 0);
            assert_int_equal(fl_snapshot_read(&m.w, &in, &err), 0);
            fl_text_close(&in);
            free(text);
            assert_true(hash_of_all_state(&m.w, 0) == hash_of_all_state(&l.w, 0));
            const fl_sleep_totals c = fl_sleep_sum_totals(&l.w);
            assert_true(sea > MASSES ? c.resting_steps > 0 : c.ballistic_steps > 0);
            fl_world *go = way == 1 ? &m.w : &l.w;
            for (int k = 0; k < 150; k++) assert_int_equal(fl_step(go, &err), 0);
            for (int without = 0; without < 2 && way == 0; without++)
                first[without] = hash_of_all_state(go, without);
            assert_true(hash_of_all_state(go, way == 2) == first[way == 2]);
            lab_free(&l);
            lab_free(&m);
        }
    }
    threads = 1;
}

int main(int argc, char **argv)
{
    (void)argc;
    fl_parallel_limit_spin(argv); /* two threads, and concurrent tests */
    const struct CMUnitTest tests[] = {cmocka_unit_test(errors_stay_below_the_tolerance),
                                       cmocka_unit_test(every_contact_is_detected),
                                       cmocka_unit_test(rest_and_wake),
                                       cmocka_unit_test(a_stack_comes_to_rest_in_any_order),
                                       cmocka_unit_test(falling_bodies_do_not_rest),
                                       cmocka_unit_test(waves_wake_wet_floes),
                                       cmocka_unit_test(bodies_of_prescribed_speed_do_not_rest),
                                       cmocka_unit_test(threads_stops_and_queries_keep_the_bits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
