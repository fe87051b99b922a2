/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elements of ice that creep, load and break, and the walls that they are in front of. */
#include "failure/strip.h"
#include "support/near.h"
#include <math.h>
#include "base/pi.h"
#include "failure/strip_lanes.h"
#include "failure/strip_wall.h"
#include "sim/energy_balance.h"
#include "sim/strip_setup.h"
#include "support/small_world.h"

static const fl_strip_law LAW = {2.5, 5e-3, 10e-3, 3, 0.2, 2.0, 7};
static const fl_vec3 ZERO = {0, 0, 0};

/* In contact the work of the mean force is the change of the stores, creep and the delayed part. */
static void work_is_store_creep_and_delay(void **state)
{
    const double dt = 4e-3, h = 0.5 * dt;
    const fl_strip_step step = fl_strip_step_of(&LAW, dt);
    fl_strip_element s = {1e-4, 0.0, 0};
    (void)state;
    for (int k = 0; k < 60; k++) {
        const fl_strip_element old = s;
        const double z0 = fl_strip_deflection(&s), dq = (k < 40 ? 0.02 : -0.01) * dt,
                     store = fl_strip_store(&LAW, &s);
        assert_int_equal(fl_strip_advance(&step, &s, dq, (fl_strip_id){0, 0, 0}), 0);
        const double z1 = fl_strip_deflection(&s), mean = 0.5 * (z0 + z1), du = s.u - old.u, rate = du / dt;
        const double creep = mean * h * 10e-3 * (pow(z0 / 5e-3, 3) + pow(z1 / 5e-3, 3)),
                     delay = 0.2 * 2.0 * rate * rate * dt;
        if (z1 == 0.0) break; /* contact ends */
        assert_near_of(mean * dq - (fl_strip_store(&LAW, &s) - store), creep + delay, 1e-10, 5e-3 * 5e-3);
        assert_true(creep >= 0.0 && delay >= 0.0);
    }
}

/* Below v_t the load rests at delta (w/v_t)^(1/n). */
static void slow_ice_creeps(void **state)
{
    const fl_strip_law law = {2.5, 5e-3, 10e-3, 3, 0.0, 1.0, 1};
    const fl_strip_step step = fl_strip_step_of(&law, 0.01);
    fl_strip_element s = {0};
    (void)state;
    for (int k = 0; k < 20000; k++) fl_strip_advance(&step, &s, 0.01 * 2e-3, (fl_strip_id){0, 0, 0});
    assert_int_equal(s.count, 0);
    assert_near(fl_strip_deflection(&s), 5e-3 * cbrt(0.2), 1e-12);
}

/* Four at a time: the same bits, through contact, breaks, retreats and gaps, for both exponents. */
static void lanes_have_the_bits_of_one_element(void **state)
{
    const fl_strip_law laws[2] = {LAW, {2.5, 5e-3, 10e-3, 1, 0.0, 1.0, 7}};
    (void)state;
    for (int l = 0; l < 2; l++) {
        const fl_strip_step step = fl_strip_step_of(&laws[l], 4e-3);
        fl_strip_element one[4] = {{1e-4, 0, 0}, {-3e-3, 0, 0}, {4.9e-3, 0, 0}, {-1.0, 0, 0}};
        int32_t broken = 0;
        for (int k = 0; k < 3000; k++) {
            fl_simd e = {one[0].e, one[1].e, one[2].e, one[3].e},
                    u = {one[0].u, one[1].u, one[2].u, one[3].u}, dq, rest;
            fl_simd_mask breaks;
            const fl_simd_mask in = {-1, -1, -1, k % 3 ? -1 : 0};
            for (int j = 0; j < 4; j++) dq[j] = 4e-3 * (0.03 + 0.01 * j + 0.08 * sin(0.01 * k * (j + 1)));
            const fl_simd way = dq;
            fl_strip_lanes_advance(&step, &in, &way, &e, &u, &breaks, &rest);
            for (int j = 0; j < 4; j++) {
                const fl_strip_id id = {0, 0, j};
                fl_strip_element lane = {e[j], u[j], one[j].count};
                if (breaks[j]) fl_strip_break(&laws[l], &lane, rest[j], id);
                if (in[j]) broken += fl_strip_advance(&step, &one[j], dq[j], id);
                assert_true(lane.e == one[j].e && lane.u == one[j].u && lane.count == one[j].count);
            }
        }
        assert_true(broken > 100);
    }
}

/* Gaps are functions of seed and element, uniform up to (R - 2) delta. */
static void gaps_are_uniform(void **state)
{
    double sum = 0.0, square = 0.0;
    (void)state;
    for (int k = 0; k < 20000; k++) {
        const double r = fl_strip_gap(&LAW, fl_rng_entity4(3, 1, k % 50, k / 50)) / 2.5e-3;
        assert_true(r >= 0.0 && r < 1.0);
        sum += r, square += r * r;
    }
    assert_near(sum / 20000, 0.5, 4 * 0.0041 / 0.5); /* 4 standard errors */
    assert_near(square / 20000, 1.0 / 3, 4 * 0.0063);
    assert_true(fl_strip_gap(&LAW, fl_rng_entity4(3, 1, 4, 5)) ==
                fl_strip_gap(&LAW, fl_rng_entity4(3, 1, 4, 5)));
}

static void strength_has_its_deviation(void **state)
{
    fl_strip_strength s = {.node = -1};
    double sum = 0.0, square = 0.0;
    const int n = 200000;
    (void)state;
    for (int k = 0; k < n; k++) {
        const double f = fl_strip_strength_at(&s, &LAW, 0.2, 0.15, 0.01 * k, 0, 0) - 1.0;
        sum += f / n, square += f * f / n;
    }
    /* linear between nodes: variance (2 + exp(-1/4))/3 of that at nodes; cut off at 0.1 hardly ever */
    assert_near_of(sum, 0.0, 0.01, 1.0);
    assert_near(sqrt(square), 0.2 * sqrt((2 + exp(-0.25)) / 3), 0.03);
}

static void speeds_of_lock_in_are_those_of_the_formulas(void **state)
{
    const fl_strip_law a = {2.5, 5e-3, 10e-3, 1, 0.0, 1.0, 1};
    (void)state;
    assert_near(fl_strip_negative_damping(&a), 0.002667, 2e-4);
    assert_near(fl_strip_negative_damping(&LAW), 0.005333, 1e-4);
    assert_near(fl_strip_lock_in_speed(2e6, fl_strip_negative_damping(&LAW), 0.02, 4 * PI, 2.533e6), 0.0915,
                1e-3);
}

static void a_cone_has_a_ring_of_sectors(void **state)
{
    fl_piece piece = {0};
    fl_wall wall;
    fl_err err = {0};
    fl_vec3 sum = ZERO;
    double seen = 0.0;
    (void)state;
    assert_int_equal(fl_cone_piece(&piece, &(fl_cone){v3(1, 2, -3), v3(1, 2, 5), 5, 5}, &err), 0);
    assert_int_equal(fl_wall_make(&wall, &piece, v3(0, 0, 1), v3(0, 0, 3), 1.0, 16, &err), 0);
    assert_int_equal(wall.n, 32);
    for (int32_t k = 0; k < wall.n; k++) {
        const fl_wall_sector *s = &wall.sector[k];
        sum = v3_madd(sum, s->width, s->n);
        seen += s->width * fmax(0.0, s->n.x);
        assert_near(s->from, -3.0, 1e-12);
        assert_near(s->to, 5.0, 1e-12);
        assert_near_of(v3_norm(v3_sub(wall.sector[s->right].x, v3_madd(s->x, s->width, s->along))), 0.0, 0.15,
                       s->width);
        assert_int_equal(wall.sector[s->right].left, k);
    }
    assert_near_of(v3_norm(sum), 0.0, 1e-12, 1.0);
    assert_near(seen, 10.0, 0.01); /* the width of the pile */
    fl_wall_free(&wall);
    /* a cone of 20 degrees is no wall */
    fl_piece_free(&piece);
    piece = (fl_piece){0};
    assert_int_equal(
        fl_cone_piece(&piece, &(fl_cone){v3(0, 0, -3), v3(0, 0, 5), 5, 5 - 8 * tan(PI / 9)}, &err), 0);
    assert_int_equal(fl_wall_make(&wall, &piece, v3(0, 0, 1), v3(0, 0, 3), 1.0, 16, &err), 0);
    assert_int_equal(wall.n, 0);
    fl_piece_free(&piece);
}

/* A square pile is cut at its corners. */
static void a_prism_has_columns(void **state)
{
    lab l;
    (void)state;
    lab_start(&l);
    lab_set(&l, "failure.crushing=structure");
    lab_set(&l, "failure.crushing_law=rate");
    lab_set(&l, "failure.element_width=0.7");
    lab_wall(&l, v3(-1, -2, -3), v3(1, 2, 3), 1);
    lab_box(&l, v3(-20, 0, 0), v3(5, 5, 0.25), 0.05, q_one(), ZERO, ZERO);
    lab_make(&l, 1e-3);
    const fl_wall *wall = &l.w.strips.wall[0];
    assert_int_equal(wall->n, 2 * 3 + 2 * 6); /* ceil(2/.7), ceil(4/.7) */
    assert_int_equal(wall->is_round, 0);
    for (int32_t k = 0; k < wall->n; k++) {
        const fl_wall_sector *s = &wall->sector[k];
        assert_near(fmax(fabs(s->n.x), fabs(s->n.y)), 1.0, 1e-12);
        assert_near(s->to - s->from, 6.0, 1e-12);
        assert_int_equal(wall->sector[s->right].left, k);
    }
    lab_free(&l);
}

/* A free floe runs against a wall that moves in two modes: what it loses is booked. */
static void the_ledger_closes(void **state)
{
    lab l;
    (void)state;
    lab_start(&l);
    lab_set(&l, "failure.crushing=structure");
    lab_set(&l, "failure.crushing_law=rate");
    lab_set(&l, "failure.pressure=50 kPa");
    lab_set(&l, "failure.scatter=0.3");
    lab_set(&l, "mode a.frequency=1");
    lab_set(&l, "mode a.mass=40e3");
    lab_set(&l, "mode b.frequency=3");
    lab_set(&l, "mode b.mass=9e3");
    lab_set(&l, "mode b.direction=xy");
    lab_cone(&l, (fl_cone){v3(0, 0, -2), v3(0, 0, 2), 1, 1});
    lab_box(&l, v3(-9.0001, 0.4, 0), v3(8, 7, 0.25), 0.05, q_one(), v3(0.4, 0, 0), v3(0, 0, 0.01));
    lab_make(&l, 5e-4);
    assert_int_equal(lab_run(&l, 12000), 0);
    fl_energy_update(&l.w);
    const fl_ledger *g = &l.w.ledger;
    assert_true(g->crushing > 500.0 && l.w.strips.part_breaks[0] > 20);
    assert_true(fabs(g->residual) < 2e-4 * g->throughput);
    lab_free(&l);
}

static void fast_ice_ends_the_run(void **state)
{
    lab l;
    (void)state;
    lab_start(&l);
    lab_set(&l, "failure.crushing=structure");
    lab_set(&l, "failure.crushing_law=rate");
    lab_cone(&l, (fl_cone){v3(0, 0, -2), v3(0, 0, 2), 1, 1});
    lab_box(&l, v3(-9.0001, 0.4, 0), v3(8, 7, 0.25), 0.05, q_one(), v3(0.9, 0, 0), ZERO);
    lab_make(&l, 1e-3);
    l.w.b.v[0].x = 2.0; /* it was 0.9, or the run would not have begun */
    assert_int_equal(lab_run(&l, 50), FL_NUMERIC);
    lab_free(&l);
}

/* A floe that is moved against a pile of 1 m, and its edge along y. */
static void start_moved(lab *l, int wears)
{
    lab_start(l);
    lab_set(l, "boundary.type=free");
    lab_set(l, "boundary.drive_width=1000");
    lab_set(l, "boundary.drive_edge=-x");
    lab_set(l, "boundary.drive_fixed=x y z rx ry rz");
    lab_set(l, "boundary.drive=0.4");
    lab_set(l, "failure.crushing=structure");
    lab_set(l, "failure.crushing_law=rate");
    lab_set(l, "failure.pressure=50 kPa");
    lab_set(l, "failure.element_width=0.1");
    lab_set(l, wears ? "failure.wear=true" : "failure.wear=false");
    lab_cone(l, (fl_cone){v3(0, 0, -2), v3(0, 0, 2), 1, 1});
    lab_box(l, v3(-9.0001, 0, 0), v3(8, 7, 0.25), 0.05, q_one(), v3(0.4, 0, 0), ZERO);
    lab_make(l, 1e-3);
}

/* What is crushed while the floe moves by (x, y) at 0.4 m/s. */
static double crushed_by(lab *l, double x, double y)
{
    const double before = l->w.ledger.crushing, way = hypot(x, y);
    l->w.b.v[0] = v3(0.4 * x / way, 0.4 * y / way, 0.0);
    assert_int_equal(lab_run(l, (int64_t)(way / 0.4e-3 + 0.5)), 0);
    return l->w.ledger.crushing - before;
}

static void a_floe_keeps_its_dent(void **state)
{
    /* segment of a circle of 1 m, 0.6 m deep */
    const double d = 0.6, chord = 2.0 * sqrt(2.0 * d - d * d), area = acos(1.0 - d) - (1.0 - d) * 0.5 * chord;
    (void)state;
    lab l;
    start_moved(&l, 1);
    const double first = crushed_by(&l, 0.6, 0), back = crushed_by(&l, -1.0, 0);
    assert_true(first > 0.25 * 50e3 * chord * d * 0.5 && back < 0.01 * first);
    const fl_floe_dents *kept = l.w.crushing.dents[0];
    assert_non_null(kept);
    assert_int_equal(kept->n, 1);
    const fl_dent *t = &kept->dent[0];
    assert_near(v3_norm(t->offset), d, 0.03);
    assert_near(t->half_width, 0.5 * chord, 0.1);
    assert_near(2.0 * t->half_width * v3_norm(t->offset) * t->stiffening / (1.0 + t->stiffening), area, 0.05);
    /* in again: nothing but the front, where gaps are drawn anew; deeper, as if it had never been out */
    const double again = crushed_by(&l, 1.0, 0), deeper = crushed_by(&l, 0.2, 0);
    assert_true(again < 0.04 * first);
    assert_true(deeper > 0.8 * first * 0.2 / 0.6);
    crushed_by(&l, -1.2, 0);
    assert_int_equal(kept->n, 1); /* the same, deeper */
    assert_near(v3_norm(t->offset), 0.8, 0.03);
    /* beside it the ice is whole */
    crushed_by(&l, 0.0, 3.0);
    assert_near(crushed_by(&l, 1.0, 0.0), first, 0.05);
    crushed_by(&l, -1.2, 0);
    assert_int_equal(kept->n, 2);
    lab_free(&l);
    start_moved(&l, 0); /* worn ice forgotten */
    const double whole = crushed_by(&l, 0.6, 0);
    assert_near(whole, first, 1e-12);
    crushed_by(&l, -1.0, 0);
    assert_null(l.w.crushing.dents[0]);
    assert_near(crushed_by(&l, 1.0, 0), first, 0.05);
    lab_free(&l);
}

/* The automatic step of a floe before a wall goes with the root of delta over the pressure. */
static void the_step_is_that_of_the_ice(void **state)
{
    double step[3];
    (void)state;
    for (int k = 0; k < 3; k++) {
        lab l;
        lab_start(&l);
        lab_set(&l, "failure.crushing=structure");
        lab_set(&l, "failure.crushing_law=rate");
        lab_set(&l, "failure.pressure_exponent=0");
        lab_setf(&l, "failure.pressure=%g", k == 1 ? 4e5 : 1e5);
        lab_setf(&l, "failure.break_deflection=%g", k == 2 ? 0.02 : 0.005);
        lab_set(&l, "output.loads_every=1");
        lab_wall(&l, v3(0, -2, -3), v3(1, 2, 3), 1);
        lab_box(&l, v3(-20, 0, 0), v3(5, 5, 0.25), 0.05, q_one(), ZERO, ZERO);
        lab_make(&l, 0.0);
        /* R p/delta over all of the wall, 2 (4 + 1) m by 0.5 m */
        assert_near(fl_strips_stiffness(&l.w, 0), 2.5 * (k == 1 ? 4e5 : 1e5) * 5.0 / (k == 2 ? 0.02 : 0.005),
                    1e-9);
        step[k] = l.w.dt;
        lab_free(&l);
    }
    assert_near(step[1], 0.5 * step[0], 1e-9);
    assert_near(step[2], 2.0 * step[0], 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(work_is_store_creep_and_delay),
                                       cmocka_unit_test(slow_ice_creeps),
                                       cmocka_unit_test(lanes_have_the_bits_of_one_element),
                                       cmocka_unit_test(gaps_are_uniform),
                                       cmocka_unit_test(strength_has_its_deviation),
                                       cmocka_unit_test(speeds_of_lock_in_are_those_of_the_formulas),
                                       cmocka_unit_test(a_cone_has_a_ring_of_sectors),
                                       cmocka_unit_test(a_prism_has_columns),
                                       cmocka_unit_test(the_ledger_closes),
                                       cmocka_unit_test(fast_ice_ends_the_run),
                                       cmocka_unit_test(the_step_is_that_of_the_ice),
                                       cmocka_unit_test(a_floe_keeps_its_dent)};
    return cmocka_run_group_tests_name("strip", tests, NULL, NULL);
}
